//! What can move without strain has no equilibrium, and what cannot start as it is told has no motion: refused, and
//! named.

use cosserat::Model;
use cosserat::scene::{Body, CurveShape, Dynamics, Joint, JointKind, Rod, Scene, Statics};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load};
use crate::pieces::UNEVEN_SECTION;
use crate::placement::placements;
use crate::steps::{body, joint};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("mechanisms::refused", "rigid kinematics", refused),
        Case::new("mechanisms::accepted", "rigid kinematics", accepted),
    ]
}

fn rod() -> Rod {
    let shape = CurveShape::Line {
        length: None,
        from: Some([0.0; 3]),
        to: Some([0.6, 0.8, 0.0]),
        normal: Some([0.0, 0.0, 1.0]),
    };
    Rod::new("wire", shape, UNEVEN_SECTION, None, 2, 2)
}

fn bob() -> Body {
    body("bob", 2.0, [1.0, 2.0, 2.5], [1.0, 0.5, 0.0])
}

fn join(kind: JointKind, between: [&str; 2], axis: Option<[f64; 3]>) -> Joint {
    Joint { name: None, kind, between: between.map(str::to_string), point: None, axis }
}

fn still(rods: Vec<Rod>, bodies: Vec<Body>, joints: Vec<Joint>) -> Scene {
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        rod: rods,
        body: bodies,
        joint: joints,
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn moving(rods: Vec<Rod>, bodies: Vec<Body>, joints: Vec<Joint>) -> Scene {
    let options = Dynamics::new(0.1, 0.01);
    Scene { statics: None, dynamics: Some(options), ..still(rods, bodies, joints) }
}

fn massless() -> Rod {
    Rod { inertia: false, gravity: false, ..rod() }
}

/// What, the scene, and what the refusal says.
type Refusal = (&'static str, Scene, &'static [&'static str]);

fn refusals() -> Vec<Refusal> {
    use JointKind::{Revolute, Rigid, Spherical};
    let ball = |between| join(Spherical, between, None);
    let wrong = Body { velocity: [0.0, 0.0, 1.0], ..bob() };
    let pushed = {
        let mut scene = still(vec![rod()], Vec::new(), Vec::new());
        scene.load = vec![load(cosserat::scene::LoadKind::Force, "wire@1", [0.0, 0.0, 1.0])];
        scene
    };
    vec![
        (
            "a free body",
            still(Vec::new(), vec![bob()], Vec::new()),
            &["body `bob`", "free to move without strain"],
        ),
        ("a free rod", pushed, &["rod `wire`", "free to move without strain"]),
        (
            "a body on a ball joint",
            still(Vec::new(), vec![bob()], vec![joint("pivot", Spherical, ["ground", "bob"], [0.0; 3])]),
            &["body `bob`", "rotation about the axis"],
        ),
        (
            "a body on a hinge",
            still(
                Vec::new(),
                vec![bob()],
                vec![Joint {
                    axis: Some([0.0, 0.0, 2.0]),
                    ..joint("pivot", Revolute, ["ground", "bob"], [0.0; 3])
                }],
            ),
            &["body `bob`", "rotation about the axis [0, 0, 1] through [0, 0, 0]"],
        ),
        (
            "a rod between two ball joints",
            still(vec![rod()], Vec::new(), vec![ball(["ground", "wire@0"]), ball(["wire@1", "ground"])]),
            &["rod `wire`", "rotation about the axis [0.6, 0.8, 0]"],
        ),
        (
            "a body that hangs on a clamped rod by a ball joint",
            still(vec![rod()], vec![bob()], vec![clamp("wire@0"), ball(["wire@1", "bob"])]),
            &["body `bob`", "rotation about the axis"],
        ),
        (
            "a rod without inertia that nothing holds, in motion",
            moving(vec![massless()], vec![bob()], Vec::new()),
            &["rod `wire`", "free to move without inertia"],
        ),
        (
            "a rod without inertia between two ball joints, in motion",
            moving(vec![massless()], vec![bob()], vec![ball(["ground", "wire@0"]), ball(["wire@1", "bob"])]),
            &["rod `wire`", "rotation about the axis [0.6, 0.8, 0]"],
        ),
        (
            "a velocity that a joint cannot have",
            moving(
                Vec::new(),
                vec![wrong.clone()],
                vec![joint("pivot", Spherical, ["ground", "bob"], [0.0; 3])],
            ),
            &["joint.0", "which the velocities at the start violate"],
        ),
        (
            "a velocity that leaves a rod at rest",
            moving(vec![rod()], vec![wrong], vec![clamp("wire@0"), join(Rigid, ["wire@1", "bob"], None)]),
            &["joint.1", "which the velocities at the start violate"],
        ),
        (
            "an angular velocity across a hinge",
            moving(
                Vec::new(),
                vec![Body { angular_velocity: [1.0, 0.0, 0.0], ..bob() }],
                vec![join(Revolute, ["ground", "bob"], Some([0.0, 0.0, 1.0]))],
            ),
            &["joint.0", "rad/s"],
        ),
        (
            "a spectral radius of 1 with a joint",
            {
                let mut scene = moving(
                    Vec::new(),
                    vec![bob()],
                    vec![joint("pivot", Spherical, ["ground", "bob"], [0.0; 3])],
                );
                if let Some(options) = &mut scene.dynamics {
                    options.spectral_radius = 1.0;
                }
                scene
            },
            &["dynamics.spectral_radius", "pivot"],
        ),
    ]
}

const EXACT: &str = "a scene is refused or not";

fn refused(checks: &mut Checks) -> Outcome {
    for (what, scene, words) in refusals() {
        let message = match Model::new(&scene) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        };
        for word in words {
            let said = f64::from(u8::from(message.contains(word)));
            let label = format!("{what} is refused with \"{word}\" in `{message}`");
            checks.absolute(Kind::Invariant, label, (said, 1.0), 0.0, EXACT);
        }
        // Elsewhere in space the axis has other components, but the scene is refused as well.
        for placement in &placements(1.0)[1..] {
            let refused = f64::from(u8::from(Model::new(&placement.apply(&scene)).is_err()));
            let label = format!("{what} is refused, {}", placement.name);
            checks.absolute(Kind::Invariant, label, (refused, 1.0), 0.0, EXACT);
        }
    }
    Ok(())
}

/// The neighbours of those above that can be solved.
fn accepted(checks: &mut Checks) -> Outcome {
    use JointKind::{Revolute, Rigid, Spherical};
    let ball = |between| join(Spherical, between, None);
    let turning = {
        let omega = Vector3::new(0.3, -0.7, 2.0);
        let velocity = omega.cross(&Vector3::from(bob().position));
        Body { velocity: velocity.into(), angular_velocity: omega.into(), ..bob() }
    };
    let mut free = moving(Vec::new(), vec![turning.clone()], Vec::new());
    if let Some(options) = &mut free.dynamics {
        options.spectral_radius = 1.0;
    }
    let scenes = [
        (
            "a rod on a ball joint and a hinge across it",
            still(
                vec![rod()],
                Vec::new(),
                vec![ball(["ground", "wire@0"]), join(Revolute, ["wire@1", "ground"], Some([0.0, 0.0, 1.0]))],
            ),
        ),
        (
            "a body on two ball joints and a rod",
            still(
                vec![rod()],
                vec![bob()],
                vec![
                    clamp("wire@0"),
                    join(Rigid, ["wire@1", "bob"], None),
                    joint("b", Spherical, ["ground", "bob"], [2.0, 0.0, 0.0]),
                ],
            ),
        ),
        (
            "a rod without inertia between the ground and a body",
            moving(
                vec![massless()],
                vec![bob()],
                vec![clamp("wire@0"), join(Rigid, ["wire@1", "bob"], None)],
            ),
        ),
        (
            "a velocity that agrees with the joint",
            moving(Vec::new(), vec![turning], vec![joint("pivot", Spherical, ["ground", "bob"], [0.0; 3])]),
        ),
        ("a free body with a spectral radius of 1", free),
    ];
    for (what, scene) in scenes {
        for placement in placements(1.0) {
            let accepted = Model::new(&placement.apply(&scene));
            let message = accepted.as_ref().err().map(ToString::to_string).unwrap_or_default();
            let label = format!("{what} is accepted, {} {message}", placement.name);
            checks.absolute(Kind::Invariant, label, (f64::from(u8::from(accepted.is_ok())), 1.0), 0.0, EXACT);
        }
    }
    Ok(())
}
