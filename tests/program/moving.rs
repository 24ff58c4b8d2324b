//! Scenes with bodies, multiplied joints, dynamics and modes: what is accepted and what is refused.

use cosserat::Scene;

use crate::mistakes::GOOD;
use crate::mistakes::moving::{ANALYSES, BODIES, FORMS, MOVING, PARTS};
use crate::{cosserat, refuses, text, write_scene};

#[test]
fn wrong_forms_of_moving_parts_are_refused() {
    refuses(MOVING, FORMS);
}

#[test]
fn impossible_bodies_are_refused() {
    refuses(MOVING, BODIES);
}

#[test]
fn parts_that_are_not_there_are_refused() {
    refuses(MOVING, PARTS);
}

#[test]
fn impossible_analyses_are_refused() {
    refuses(MOVING, ANALYSES);
}

/// `MOVING` after several changes at once.
fn moving(changes: &[(&str, &str)]) -> Result<Scene, String> {
    let scene = changes.iter().fold(MOVING.to_owned(), |scene, (from, to)| {
        assert!(scene.contains(from), "`{from}` is not in the scene");
        scene.replacen(from, to, 1)
    });
    Scene::from_toml(&scene).map_err(|error| error.to_string())
}

#[test]
fn moving_parts_are_accepted() {
    let whole_analysis = &MOVING[MOVING.find("[dynamics]").unwrap()..];
    let joints =
        &MOVING[MOVING.find("[[joint]]\nkind = \"spherical\"").unwrap()..MOVING.find("[[load]]").unwrap()];
    let rods = &MOVING[MOVING.find("[[rod]]").unwrap()..MOVING.find("[[body]]").unwrap()];
    let along =
        &MOVING[MOVING.find("[[load]]\nkind = \"line_force\"").unwrap()..MOVING.find("[[probe]]").unwrap()];
    let middle =
        &MOVING[MOVING.find("[[probe]]\nname = \"middle\"").unwrap()..MOVING.find("[dynamics]").unwrap()];
    let clamp =
        &MOVING[MOVING.find("[[joint]]").unwrap()..MOVING.find("[[joint]]\nkind = \"spherical\"").unwrap()];
    for changes in [
        &[][..],
        &[(whole_analysis, "[modes]\ncount = 3\n")],
        &[(whole_analysis, "[statics]\n")],
        // The flat plate, with the digits that fit on a page.
        &[("inertia = [1.0, 2.0, 3.0]", "inertia = [0.33333333, 0.33333333, 0.66666667]")],
        // Nothing but a clamp is left, which needs no multipliers.
        &[(joints, ""), ("spectral_radius = 0.8", "spectral_radius = 1")],
        &[("spectral_radius = 0.8", "spectral_radius = 0")],
        &[
            ("inertia = true", "inertia = false\ngravity = false"),
            ("time = \"constant\"", "time = [[0, 0], [1, 1]]"),
        ],
        &[
            ("inertia = true", "inertia = false\ngravity = false"),
            ("time = \"constant\"", "time = \"ramp\""),
            (", density = 1200", ""),
        ],
        &[
            ("gravity = false", "inertia = false\ngravity = false"),
            ("rotary_inertia = [1e-6, 2e-6, 3e-6]", ""),
        ],
        &[("time_step = 1e-2", "time_step = 2")],
        &[("time_step = 1e-2", "accuracy = 1e-5")],
        &[("time_step = 1e-2", "accuracy = 1e-5"), ("\"generalized-alpha\"", "\"radau\"")],
        &[("\"generalized-alpha\"", "\"radau\"")],
        // A scene of bodies alone.
        &[(rods, ""), (joints, ""), (clamp, ""), (along, ""), (middle, "")],
    ] {
        if let Err(error) = moving(changes) {
            panic!("{changes:?}: {error}");
        }
    }
}

#[test]
fn combinations_of_moving_parts_are_refused() {
    for (changes, words) in [
        (
            &[("\"generalized-alpha\"", "\"radau\""), ("inertia = true", "inertia = false")][..],
            "`rod.0.inertia`: is false, but the method \"radau\" needs inertia of every rod; expected true, or",
        ),
        (
            &[("inertia = true", "inertia = false"), (", density = 1200", "")],
            "`rod.0.material.density`: is missing, but the rod takes part in gravity; expected the density [kg/m³], \
             or `gravity = false` for this rod",
        ),
        (
            &[("inertia = true", "gravity = false"), (", density = 1200", "")],
            "is missing, but the rod has inertia in `[dynamics]`; expected the density [kg/m³], or `inertia = false`",
        ),
        (
            &[
                ("name = \"clamp\"\nkind = \"rigid\"", "kind = \"spherical\""),
                ("spectral_radius = 0.8", "spectral_radius = 1.0"),
            ],
            "of joints such as \"joint1\" grow",
        ),
    ] {
        let error = moving(changes).unwrap_err();
        assert!(error.contains(words), "{changes:?}: {error}");
    }
}

#[test]
fn quaternions_are_refused_with_joints_that_need_multipliers() {
    let folder = tempfile::tempdir().unwrap();
    let scene = GOOD.replacen("[\"ground\", \"beam@1\"]", "[\"spring@1\", \"beam@1\"]", 1).replacen(
        "increments = 5",
        "coordinates = \"quaternions\"",
        1,
    );
    let ended = cosserat(&["check", text(&write_scene(&folder, &scene))]);
    assert_eq!(ended.code, Some(2));
    let words = "`statics.coordinates`: is \"quaternions\", which is not available yet for joints that need \
                 multipliers, such as \"joint3\"; expected \"increments\"";
    assert!(ended.stderr.contains(words), "{}", ended.stderr);
}
