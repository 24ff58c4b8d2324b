//! The heavy top of Géradin & Cardona: a body on a ball joint that spins at 150 rad/s.
//!
//! The references are Euler's equations about the fixed point by Taylor series, good to all digits.

use std::error::Error;

use cosserat::scene::{Body, Dynamics, JointKind, Scene};
use cosserat::solution::Solution;

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::probe;
use crate::placement::{Placement, placements};
use crate::steps::{
    body, check_second_order, check_vanishes, energy_error, force_at, halved_twice, joint, position_at,
    quaternion_at, violation,
};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("heavy_top::order", "Euler's equations by Taylor series; Géradin & Cardona 2001", order)
            .reads(&[FILE]),
        Case::new("heavy_top::reversed_pair", "the same joint written the other way round", reversed_pair),
    ]
}

/// t, centre of mass, quaternion, force of the joint on the top.
pub type Exact = (f64, [f64; 3], [f64; 4], [f64; 3]);

/// By Taylor series.
pub const FILE: &str = "rigid/heavy_top.csv";
/// Where the motion is compared [s].
const TIMES: [f64; 3] = [0.5, 1.0, 2.0];

/// The reference at a time of the file.
pub fn exact(checks: &mut Checks, time: f64) -> Result<Exact, Box<dyn Error>> {
    let table = checks.reference(FILE)?;
    let row = table.row(&[("t", &format!("{time:?}"))])?;
    Ok((time, row.numbers("x y z")?, row.numbers("qw qx qy qz")?, row.numbers("fx fy fz")?))
}

/// Largest of the three steps [s]: the top turns by 0.075 rad in it.
const STEP: f64 = 5e-4;

/// The top, its joint between the two in this order.
pub fn scene(between: [&str; 2]) -> Scene {
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        body: vec![Body {
            velocity: [4.61538, 0.0, 0.0],
            angular_velocity: [0.0, 150.0, -4.61538],
            ..body("top", 15.0, [0.234375, 0.46875, 0.234375], [0.0, 1.0, 0.0])
        }],
        joint: vec![joint("pivot", JointKind::Spherical, between, [0.0; 3])],
        probe: vec![probe("top", "top")],
        dynamics: Some(Dynamics::new(2.0, STEP)),
        ..Scene::default()
    }
}

fn order(checks: &mut Checks) -> Outcome {
    for placement in placements(1.0) {
        let runs = halved_twice(&placement.apply(&scene(["ground", "top"])))?;
        for time in TIMES {
            let exact = exact(checks, time)?;
            check_at(checks, &runs, exact, &placement)?;
        }
        if placement.name == "as is" {
            path(checks, &runs[2])?;
        }
        let errors = [0, 1, 2].map(|k| energy_error(&runs[k]));
        check_vanishes(checks, &format!("energy, {}", placement.name), errors);
        for run in &runs {
            checks.below(
                Kind::Invariant,
                format!("joint, {}", placement.name),
                violation(run),
                1e-9 * STEP * 5.0 + 1e-14,
                "Newton's test: 1e-9 of the way in a step, at 4.6 m/s and 42 m/s²; and rounding",
            );
            let iterations = run.statistics.newton_iterations as f64 / run.statistics.increments as f64;
            checks.below(
                Kind::Pinned,
                "iterations a step",
                iterations,
                3.0,
                "the first step starts from a = ẏ",
            );
        }
    }
    Ok(())
}

/// The way of the centre of mass, seen from above.
fn path(checks: &mut Checks, run: &Solution) -> Outcome {
    let table = checks.reference(FILE)?;
    checks.trajectory(Trajectory {
        title: "Heavy top: centre of mass from above".to_string(),
        axes: ["x [m]", "y [m]"],
        measured: run
            .rows
            .iter()
            .step_by(40)
            .map(|row| [row.probes[0].position[0], row.probes[0].position[1]])
            .collect(),
        source: "Taylor series",
        reference: table.rows().map(|row| row.numbers("x y")).collect::<Result<_, _>>()?,
    });
    Ok(())
}

fn check_at(
    checks: &mut Checks,
    runs: &[Solution; 3],
    (time, position, quaternion, force): Exact,
    placement: &Placement,
) -> Outcome {
    let label = |what: &str| format!("{what} at {time} s, {}", placement.name);
    let (mut x, mut q, mut f) = (Vec::new(), Vec::new(), Vec::new());
    for run in runs {
        x.push(position_at(run, time, 0, placement)?);
        q.push(quaternion_at(run, time, 0, placement, quaternion)?);
        f.push(force_at(run, time, 0, placement)?);
    }
    let slices = [x[0].as_slice(), x[1].as_slice(), x[2].as_slice()];
    check_second_order(checks, &label("centre"), slices, &position);
    check_second_order(checks, &label("rotation"), [&q[0], &q[1], &q[2]], &quaternion);
    let slices = [f[0].as_slice(), f[1].as_slice(), f[2].as_slice()];
    check_second_order(checks, &label("force"), slices, &force);
    Ok(())
}

/// The constraint, its multipliers and the sign of the reaction change sides; the motion must not notice.
fn reversed_pair(checks: &mut Checks) -> Outcome {
    let [forward, backward] =
        [["ground", "top"], ["top", "ground"]].map(|between| crate::steps::run(&scene(between)));
    let (forward, backward) = (forward?, backward?);
    let as_is = &placements(1.0)[0];
    for time in TIMES {
        let pair = [&forward, &backward].map(|run| position_at(run, time, 0, as_is));
        let [a, b] = pair;
        checks.vector(
            Kind::Invariant,
            format!("centre at {time} s"),
            (a?.into(), b?.into()),
            1e-9,
            "Newton stops within 1e-9 of the forces, 690 N on 15 kg: ½ · 1e-9 · 46 m/s² · (0.2 s)², as the \
             nutation bounds it",
        );
        let [a, b] = [&forward, &backward].map(|run| force_at(run, time, 0, as_is));
        checks.vector(
            Kind::Invariant,
            format!("force at {time} s"),
            (a?.into(), (-b?).into()),
            1e-5,
            "1e-8 of the force: positions within 1e-9 on a circle of 1 m, and Newton's 1e-9",
        );
    }
    Ok(())
}
