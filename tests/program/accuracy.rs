//! `run --accuracy`.

use std::path::Path;

use serde_json::Value;

use crate::{BEAM, cosserat, text, write_scene};

/// A body that turns about no axis of its own.
const NUT: &str = r#"
[[body]]
name = "nut"
mass = 1.0
inertia = [1, 2, 3]
position = [0, 0, 0]
angular_velocity = [0.01, 5, 0.02]
[[probe]]
name = "nut"
on = "nut"
[dynamics]
end_time = 1.0
time_step = 0.5
"#;

fn summary(out: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(out.join("summary.json")).unwrap()).unwrap()
}

fn read(out: &Path, name: &str) -> String {
    std::fs::read_to_string(out.join(name)).unwrap()
}

#[test]
fn an_accuracy_is_a_number_between_0_and_1() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, BEAM);
    let out = folder.path().join("out");
    for (value, words) in [
        ("0", "`--accuracy`: is 0; expected a number above 0 and below 1"),
        ("-1e-4", "is -0.0001"),
        ("1", "is 1;"),
        ("nan", "is NaN"),
        ("inf", "is inf"),
        ("fine", "invalid value 'fine'"),
    ] {
        let ended = cosserat(&["run", text(&path), "--out", text(&out), "--accuracy", value]);
        assert_eq!(ended.code, Some(2), "{value}: {}", ended.stderr);
        assert!(ended.stderr.contains(words), "{value}: {}", ended.stderr);
        assert!(!out.exists(), "{value}");
    }
    for command in ["check", "study"] {
        let ended = cosserat(&[command, text(&path), "--out", text(&out), "--accuracy", "1e-4"]);
        assert_eq!(ended.code, Some(2), "{command}");
    }
}

#[test]
fn what_has_no_path_or_no_other_mesh_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let modes =
        BEAM.replacen("[statics]", "[modes]\ncount = 2", 1).replacen("0.3 }", "0.3, density = 7850 }", 1);
    // A Gauss–Lobatto point inside an element of degree 3: (1 − 1/√5)/2 of half a rod.
    let inside = BEAM.replacen("degree = 2", "degree = 3", 1).replacen(
        "on = \"beam@1\"\nvalue",
        "on = \"beam@0.13819660112501053\"\nvalue",
        1,
    );
    for (scene, words) in [
        (modes, "`--accuracy`: is not available yet for frequencies"),
        (inside, "scene.toml:14: `load.0.on`: is on a node that meshes of other sizes do not have"),
    ] {
        let path = write_scene(&folder, &scene);
        let ended = cosserat(&["run", text(&path), "--out", text(&out), "--accuracy", "1e-4"]);
        assert_eq!(ended.code, Some(2), "{words}: {}", ended.stderr);
        assert!(ended.stderr.contains(words), "{words}: {}", ended.stderr);
        assert!(!out.exists());
    }
}

/// The scene that is written has the settings that were chosen, and is solved to the same digits by itself.
#[test]
fn the_summary_tells_what_was_chosen_and_the_scene_repeats_it() {
    let folder = tempfile::tempdir().unwrap();
    for (name, scene) in [("beam", BEAM), ("nut", NUT)] {
        let path = write_scene(&folder, scene);
        let out = folder.path().join(name);
        let ended = cosserat(&["run", text(&path), "--out", text(&out), "--accuracy", "1e-4"]);
        assert_eq!(ended.code, Some(0), "{name}: {}", ended.stderr);
        assert!(ended.stderr.is_empty(), "{}", ended.stderr);
        assert!(ended.stdout.contains("accuracy 1e-4: "), "{}", ended.stdout);
        assert!(ended.stdout.contains("estimated error "), "{}", ended.stdout);

        let summary = summary(&out);
        assert_eq!(summary["status"], "solved");
        let accuracy = &summary["accuracy"];
        assert_eq!(accuracy["asked"], 1e-4);
        assert_eq!(accuracy["reached"], true);
        for part in ["position", "rotation"] {
            let estimate = accuracy["estimate"][part].as_f64().unwrap();
            assert!((0.0..=1e-4).contains(&estimate), "{name} {part}: {estimate}");
        }
        for key in ["runs", "newton_iterations", "factorizations"] {
            assert!(accuracy[key].as_u64().unwrap() >= 4, "{name} {key}: {accuracy}");
        }
        // All runs, beside the one that is returned.
        assert!(accuracy["newton_iterations"].as_u64() > summary["newton_iterations"].as_u64());
        assert!(accuracy["seconds"].as_f64().unwrap() >= 0.0);
        let rods = accuracy["settings"]["rods"].as_array().unwrap();
        assert_eq!(rods.len(), usize::from(name == "beam"));
        let written: toml::Table = read(&out, "scene.toml").parse().unwrap();
        for (index, rod) in rods.iter().enumerate() {
            let scene = &written["rod"][index];
            assert_eq!(rod["name"].as_str(), scene["name"].as_str());
            assert_eq!(rod["degree"].as_i64(), scene["degree"].as_integer());
            assert_eq!(rod["elements"].as_i64(), scene["elements"].as_integer());
        }
        if name == "nut" {
            let step = accuracy["settings"]["time_step"].as_f64();
            assert!(step.unwrap() < 0.5);
            assert_eq!(step, written["dynamics"]["time_step"].as_float());
        } else {
            assert!(accuracy["settings"].get("time_step").is_none());
        }

        let again = folder.path().join(format!("{name}-again"));
        let ended = cosserat(&["run", text(&out.join("scene.toml")), "--out", text(&again)]);
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        assert_eq!(read(&out, "probes.csv"), read(&again, "probes.csv"), "{name}");
        assert_eq!(read(&out, "scene.toml"), read(&again, "scene.toml"), "{name}");
        assert!(self::summary(&again).get("accuracy").is_none());
    }
}

/// Rounding and the tolerance of Newton's iteration leave more than that.
#[test]
fn an_accuracy_beyond_rounding_ends_with_3_and_the_finest_run() {
    let folder = tempfile::tempdir().unwrap();
    let bent = BEAM.replacen("value = [0, 0, 1.0]", "value = [0, 0, 1e5]", 1);
    let path = write_scene(&folder, &bent);
    let out = folder.path().join("out");
    let ended = cosserat(&["run", text(&path), "--out", text(&out), "--accuracy", "1e-17"]);
    assert_eq!(ended.code, Some(3), "{}", ended.stderr);
    assert!(ended.stderr.contains("the accuracy 1e-17 is not reached after "), "{}", ended.stderr);
    assert!(ended.stderr.contains("its error is estimated as "), "{}", ended.stderr);
    let summary = summary(&out);
    assert_eq!(summary["status"], "stopped");
    assert!(ended.stderr.contains(summary["message"].as_str().unwrap()));
    assert_eq!(summary["accuracy"]["reached"], false);
    assert!(summary["accuracy"]["estimate"]["position"].as_f64().unwrap() > 1e-17);
    // What is written is a whole run all the same.
    assert!(
        read(&out, "probes.csv").lines().last().unwrap().starts_with("1.0,"),
        "{}",
        read(&out, "probes.csv")
    );
}

/// No mesh carries it: the error is the solver's, and what converged is written.
#[test]
fn a_load_that_no_mesh_carries_ends_with_the_error_of_the_solver() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, &BEAM.replacen("value = [0, 0, 1.0]", "value = [0, 0, 1e300]", 1));
    let out = folder.path().join("out");
    let ended = cosserat(&["run", text(&path), "--out", text(&out), "--accuracy", "1e-3"]);
    assert_eq!(ended.code, Some(3), "{}", ended.stderr);
    assert!(ended.stderr.contains("load factor"), "{}", ended.stderr);
    let summary = summary(&out);
    assert_eq!(summary["status"], "stopped");
    assert_eq!(summary["accuracy"]["reached"], false);
    assert!(summary["accuracy"]["estimate"].is_null());
}

/// Free ends stand for probes, but no table has columns that nobody asked for.
#[test]
fn a_scene_without_probes_keeps_none() {
    let folder = tempfile::tempdir().unwrap();
    let (start, rest) = BEAM.split_once("[[probe]]").unwrap();
    let (_, analysis) = rest.rsplit_once("[statics]").unwrap();
    let path = write_scene(&folder, &format!("{start}[statics]{analysis}"));
    let out = folder.path().join("out");
    let ended = cosserat(&["run", text(&path), "--out", text(&out), "--accuracy", "1e-4"]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert_eq!(read(&out, "probes.csv").lines().next(), Some("load_factor"));
    assert!(!read(&out, "scene.toml").contains("[[probe]]"));
    assert!(summary(&out)["accuracy"]["estimate"]["position"].as_f64().unwrap() > 0.0);
}
