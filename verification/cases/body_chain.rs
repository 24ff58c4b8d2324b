//! Three bodies on a ball joint, an oblique hinge and a ball joint, in space.
//!
//! The references are Kane's equations in seven coordinates: poses good to 1e-12, forces to 5e-12.

use std::error::Error;

use cosserat::scene::{Body, Dynamics, Joint, JointKind, Scene};
use cosserat::solution::Solution;
use nalgebra::{UnitQuaternion, Vector3};

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::probe;
use crate::placement::{Placement, placements};
use crate::steps::{
    body, check_second_order, check_vanishes, energy_error, force_at, halved_twice, joint, position_at,
    quaternion_at, rotation, run, violation,
};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let source = "Kane's equations in seven coordinates";
    vec![
        Case::new("body_chain::moving", source, |checks| order(checks, true)).reads(FILES),
        Case::new("body_chain::at_rest", source, |checks| order(checks, false)).reads(FILES),
        Case::new("body_chain::far_away", "objectivity", far_away),
        Case::new("body_chain::twice_the_same", "the same arithmetic", twice_the_same),
    ]
}

/// t, (position, quaternion) of the bodies, force of the ground on the first.
pub type Exact = (f64, [([f64; 3], [f64; 4]); 3], [f64; 3]);

/// Poses, and the force of the ground.
pub const FILES: &[&str] = &["rigid/chain.csv", "rigid/chain_force.csv"];

/// The reference at a time of the files.
pub fn exact(checks: &mut Checks, moving: bool, time: f64) -> Result<Exact, Box<dyn Error>> {
    let (start, at) = (if moving { "moving" } else { "at rest" }, format!("{time:?}"));
    let poses = checks.reference(FILES[0])?;
    let pose = |body: &str| -> Result<_, Box<dyn Error>> {
        let row = poses.row(&[("start", start), ("t", &at), ("body", body)])?;
        Ok((row.numbers("x y z")?, row.numbers("qw qx qy qz")?))
    };
    let forces = checks.reference(FILES[1])?;
    let force = forces.row(&[("start", start), ("t", &at)])?.numbers("fx fy fz")?;
    Ok((time, [pose("1")?, pose("2")?, pose("3")?], force))
}

const STEP: f64 = 2e-3;

/// The chain, moving or at rest.
pub fn scene(moving: bool, step: f64) -> Scene {
    let bodies = [
        Body {
            velocity: [0.0, 0.7, 0.35],
            angular_velocity: [0.5, -1.0, 2.0],
            ..body("body1", 1.2, [0.02, 0.03, 0.04], [0.3, 0.1, -0.2])
        },
        Body {
            orientation: [0.6, 0.0, 0.0, 0.8],
            velocity: [0.1, 2.0, 0.55],
            angular_velocity: [-0.28, -0.96, 3.0],
            ..body("body2", 0.8, [0.015, 0.01, 0.02], [0.7, 0.2, -0.6])
        },
        Body {
            orientation: [0.8, 0.0, 0.6, 0.0],
            velocity: [-0.9, 2.7, 0.35],
            angular_velocity: [-1.24, 2.0, -0.68],
            ..body("body3", 0.5, [0.006, 0.008, 0.004], [1.0, 0.6, -0.8])
        },
    ];
    let still = |body: Body| Body { velocity: [0.0; 3], angular_velocity: [0.0; 3], ..body };
    let hinge = joint("hinge", JointKind::Revolute, ["body1", "body2"], [0.5, 0.3, -0.4]);
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        body: bodies.into_iter().map(|body| if moving { body } else { still(body) }).collect(),
        joint: vec![
            joint("ball", JointKind::Spherical, ["ground", "body1"], [0.0; 3]),
            Joint { axis: Some([1.0, 2.0, 2.0]), ..hinge },
            joint("end", JointKind::Spherical, ["body2", "body3"], [0.9, 0.4, -0.7]),
        ],
        probe: ["body1", "body2", "body3"].map(|name| probe(name, name)).to_vec(),
        dynamics: Some(Dynamics::new(1.0, step)),
        ..Scene::default()
    }
}

fn order(checks: &mut Checks, moving: bool) -> Outcome {
    for placement in placements(1.0) {
        let runs = halved_twice(&placement.apply(&scene(moving, STEP)))?;
        for time in [0.5, 1.0] {
            let (_, bodies, force) = exact(checks, moving, time)?;
            for (index, (position, quaternion)) in bodies.into_iter().enumerate() {
                let label =
                    |what: &str| format!("{what} of body {} at {time} s, {}", index + 1, placement.name);
                let (mut x, mut q) = (Vec::new(), Vec::new());
                for run in &runs {
                    x.push(position_at(run, time, index, &placement)?);
                    q.push(quaternion_at(run, time, index, &placement, quaternion)?);
                }
                let slices = [x[0].as_slice(), x[1].as_slice(), x[2].as_slice()];
                check_second_order(checks, &label("position"), slices, &position);
                check_second_order(checks, &label("rotation"), [&q[0], &q[1], &q[2]], &quaternion);
            }
            let mut f = Vec::new();
            for run in &runs {
                f.push(force_at(run, time, 0, &placement)?);
            }
            let slices = [f[0].as_slice(), f[1].as_slice(), f[2].as_slice()];
            check_second_order(checks, &format!("force at {time} s, {}", placement.name), slices, &force);
        }
        if placement.name == "as is" {
            path(checks, moving, &runs[2])?;
        }
        let errors = [0, 1, 2].map(|k| energy_error(&runs[k]));
        check_vanishes(checks, &format!("energy, {}", placement.name), errors);
        for run in &runs {
            let label = format!("joints, {}", placement.name);
            let reason =
                "Newton's test: 1e-9 of the way in a step, at up to 10 m/s or 30 rad/s; and rounding";
            checks.below(Kind::Invariant, label, violation(run), 1e-9 * STEP * 30.0 + 1e-14, reason);
            let mean = run.statistics.newton_iterations as f64 / run.statistics.increments as f64;
            checks.below(Kind::Pinned, "iterations a step", mean, 3.0, "the first step starts from a = ẏ");
        }
    }
    Ok(())
}

/// The way of the last body, seen from the side.
fn path(checks: &mut Checks, moving: bool, run: &Solution) -> Outcome {
    let start = if moving { "moving" } else { "at rest" };
    let poses = checks.reference(FILES[0])?;
    checks.trajectory(Trajectory {
        title: format!("Chain of three bodies, {start}: centre of mass of the last"),
        axes: ["x [m]", "z [m]"],
        measured: run
            .rows
            .iter()
            .step_by(10)
            .map(|row| [row.probes[2].position[0], row.probes[2].position[2]])
            .collect(),
        source: "Kane's equations",
        reference: poses
            .select(&[("start", start), ("body", "3")])?
            .iter()
            .map(|row| row.numbers("x z"))
            .collect::<Result<_, _>>()?,
    });
    Ok(())
}

/// 1 km away and turned by more than half a turn.
fn far_away(checks: &mut Checks) -> Outcome {
    let near = &placements(1.0)[0];
    let far = Placement {
        name: "far",
        rotation: UnitQuaternion::from_scaled_axis(Vector3::new(2.1, -3.3, 1.7)),
        shift: 1e3 * Vector3::new(0.6, -0.64, 0.48),
    };
    let [here, there] = [near, &far].map(|placement| run(&placement.apply(&scene(true, STEP))));
    let (here, there) = (here?, there?);
    let reason = "the scene's numbers round to 1e-13 at 1 km; Newton stops within 1e-9 of the forces, which 60 m/s² over \
                  half the second's square make 3e-8";
    for time in [0.1, 0.5, 1.0] {
        for index in 0..3 {
            let pair = (position_at(&there, time, index, &far)?, position_at(&here, time, index, near)?);
            let label = format!("position of body {} at {time} s", index + 1);
            checks.vector(Kind::Invariant, label, (pair.0.into(), pair.1.into()), 3e-8, reason);
            let q = quaternion_at(&here, time, index, near, [1.0, 0.0, 0.0, 0.0])?;
            let turned = rotation(quaternion_at(&there, time, index, &far, q)?).angle_to(&rotation(q));
            let label = format!("rotation of body {} at {time} s", index + 1);
            checks.below(Kind::Invariant, label, turned, 3e-7, "the same at arms of 0.1 m and more");
        }
    }
    Ok(())
}

fn twice_the_same(checks: &mut Checks) -> Outcome {
    let [first, second] = [0, 1].map(|_| run(&scene(true, STEP)));
    let same = f64::from(u8::from(first? == second?));
    let reason = "no thread, no clock and no random number is in the way: bit for bit";
    checks.absolute(Kind::Invariant, "two runs are equal", (same, 1.0), 0.0, reason);
    Ok(())
}
