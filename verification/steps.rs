//! Motions in time: scenes of rigid bodies, runs with smaller and smaller steps, and what is read from them.

use std::error::Error;

use cosserat::scene::{Body, Dynamics, Joint, JointKind, Scene, Step};
use cosserat::solution::Solution;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::case::{Checks, Kind};
pub use crate::motion::follow as run;
use crate::placement::Placement;

/// A body by mass and principal inertia, at rest and unturned; change what differs.
pub fn body(name: &str, mass: f64, inertia: [f64; 3], position: [f64; 3]) -> Body {
    Body {
        name: name.to_string(),
        shape: None,
        density: None,
        mass: Some(mass),
        inertia: Some(inertia),
        position,
        orientation: [1.0, 0.0, 0.0, 0.0],
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    }
}

/// A joint at a point; a revolute one needs its axis set.
pub fn joint(name: &str, kind: JointKind, between: [&str; 2], point: [f64; 3]) -> Joint {
    Joint {
        name: Some(name.to_string()),
        kind,
        between: between.map(str::to_string),
        point: Some(point),
        axis: None,
    }
}

/// The scene with another step.
pub fn with_step(scene: &Scene, step: f64) -> Scene {
    let mut scene = scene.clone();
    if let Some(options) = &mut scene.dynamics {
        options.step = Step::Constant(step);
    }
    scene
}

/// Runs with the scene's step, half and a quarter of it.
pub fn halved_twice(scene: &Scene) -> Result<[Solution; 3], Box<dyn Error>> {
    let step = scene.dynamics.as_ref().and_then(Dynamics::time_step).ok_or("no constant step")?;
    let solve = |part: f64| run(&with_step(scene, step * part));
    Ok([solve(1.0)?, solve(0.5)?, solve(0.25)?])
}

/// Index of the row of a time that is a multiple of the step.
pub fn row(solution: &Solution, time: f64) -> Result<usize, Box<dyn Error>> {
    let near = |row: &cosserat::solution::Row| (row.parameter - time).abs() <= 1e-9 * time.max(1.0);
    Ok(solution.rows.iter().position(near).ok_or_else(|| format!("no row at {time} s"))?)
}

/// Position of probe `index` in the scene before it was placed.
pub fn position_at(
    solution: &Solution,
    time: f64,
    index: usize,
    placement: &Placement,
) -> Result<Vector3<f64>, Box<dyn Error>> {
    let pose = &solution.rows[row(solution, time)?].probes[index];
    Ok(placement.undo_position(Vector3::from(pose.position)))
}

/// Quaternion of probe `index` there, with the sign that is nearer to `like`.
pub fn quaternion_at(
    solution: &Solution,
    time: f64,
    index: usize,
    placement: &Placement,
    like: [f64; 4],
) -> Result<[f64; 4], Box<dyn Error>> {
    let q = placement.undo_quaternion(solution.rows[row(solution, time)?].probes[index].quaternion);
    let same = q.iter().zip(like).map(|(a, b)| a * b).sum::<f64>() >= 0.0;
    Ok(if same { q } else { q.map(|x| -x) })
}

/// Force of joint `index` there.
pub fn force_at(
    solution: &Solution,
    time: f64,
    index: usize,
    placement: &Placement,
) -> Result<Vector3<f64>, Box<dyn Error>> {
    let [x, y, z, ..] = solution.rows[row(solution, time)?].reactions[index];
    Ok(placement.undo_direction(Vector3::new(x, y, z)))
}

/// A unit quaternion as a rotation.
pub fn rotation([w, x, y, z]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

/// Euclidean distance.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

const ORDER: &str = "halving the step divides the error by 3.6 to 4.4: it is c h², and what follows h² is below a \
                     tenth of it";
const RICHARDSON: &str = "an error c h² is a third of the last difference, and less than 0.4 of it if what \
                          follows h² is below a tenth";

/// Three runs, each with half the step of the one before, against the exact values: order 2, and an error no larger
/// than the runs themselves foretell.
pub fn check_second_order(checks: &mut Checks, what: &str, runs: [&[f64]; 3], exact: &[f64]) {
    let errors = runs.map(|run| distance(run, exact));
    checks.order(what, &[1, 2, 4], &errors, (2.0, 0.15), ORDER);
    let foretold = errors[2] / distance(runs[1], runs[2]);
    checks.below(Kind::Order, format!("{what}: error over last difference"), foretold, 0.4, RICHARDSON);
}

const VANISHES: &str =
    "the method has order 2, so what it does not conserve goes at least as h²; 0.15 for the next term";

/// Three errors that vanish with order 2 or faster.
pub fn check_vanishes(checks: &mut Checks, what: &str, errors: [f64; 3]) {
    let order = (errors[1] / errors[2]).log2();
    let [a, b, c] = errors;
    let label = format!("{what}: order, errors [{a:.3e}, {b:.3e}, {c:.3e}]");
    checks.above(Kind::Order, label, order, 1.85, VANISHES);
}

/// Largest change of the total energy from the start [J].
pub fn energy_error(solution: &Solution) -> f64 {
    let start = solution.energies.first().map_or(f64::NAN, |energies| energies.total());
    solution.energies.iter().fold(0.0, |error: f64, now| error.max((now.total() - start).abs()))
}

/// Largest violation of a joint over all steps [m, rad].
pub fn violation(solution: &Solution) -> f64 {
    solution.energies.iter().fold(0.0, |worst, energies| energies.constraint.max(worst))
}
