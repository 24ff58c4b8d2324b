//! `run --accuracy`: the estimate of the error against the error, for rods and motions that are known without finite
//! elements and without time steps.
//!
//! What is asked of an estimate: where the error is above 1e-9 of the length (or of a radian) it is not below it by more
//! than a factor of two, nor above it by more than fifty, for positions and rotations apart. What stops the refinement is
//! the estimate, so no error is larger than twice what was asked for.

mod motions;
mod problems;

use std::error::Error;

use cosserat::accuracy::{Accurate, solve_to};
use cosserat::scene::Scene;
use cosserat::study::{Errors, Milestones, Trajectory, compare, solve};

use crate::case::{Case, Checks, Kind, Outcome};
use problems::Problem;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str =
        "the continuous equations, by shooting here and by scripts/references/static_rods.py";
    const BODIES: &str = "equations of motion in closed form or minimal coordinates";
    const RODS: &str = "a boundary-value problem at every instant; three ordinary equations by symmetry";
    vec![
        Case::new("run_accuracy::small_bends", SOURCE, small_bends),
        Case::new("run_accuracy::arcs", SOURCE, arcs),
        Case::new("run_accuracy::turns", SOURCE, turns).slow(),
        Case::new("run_accuracy::inner_probes", SOURCE, inner_probes).slow(),
        Case::new("run_accuracy::loads", SOURCE, loads).reads(&problems::LOADS).slow(),
        Case::new("run_accuracy::pulled_coils", SOURCE, pulled_coils).reads(&problems::COILS).slow(),
        Case::new("run_accuracy::springs", SOURCE, springs).reads(&problems::SPRINGS).slow(),
        Case::new("run_accuracy::other_elements", SOURCE, other_elements).reads(&[problems::LOADS[0]]).slow(),
        Case::new("run_accuracy::bodies", BODIES, bodies).reads(&motions::BODIES).slow(),
        Case::new("run_accuracy::moving_rods", RODS, moving_rods).reads(&motions::RODS).slow(),
    ]
}

/// Accuracies that are asked for.
const STATIC: [f64; 7] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// Order 2 goes less far.
const LINEAR: [f64; 3] = [1e-2, 1e-4, 1e-6];
const MOVING: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// Below this an error is not looked at: what Newton's iteration leaves, and the digits of the references.
const LEAST: f64 = 1e-9;
/// Bounds of the estimate over the error.
const BAND: [f64; 2] = [0.5, 50.0];
const WANTED: &str = "asked of the estimate: at least half of the error and at most fifty times it";
const ENOUGH: &str = "the estimate is below what was asked, and the error at most twice the estimate";

/// The errors of the path that was found, at the milestones that the reference has.
fn error(found: &Accurate, exact: &Trajectory) -> Result<Errors, Box<dyn Error>> {
    let milestones = match &found.scene.dynamics {
        Some(options) => Milestones::in_time(options.end_time, &[options.end_time / 100.0]),
        None => Milestones::on_path(&[]),
    };
    let trial = solve(&found.scene, &milestones, &mut |_, _| ())?;
    Ok(compare(&trial.trajectory, exact).ok_or("no milestones in common")?)
}

fn check(checks: &mut Checks, problems: &[Problem], accuracies: &[f64]) -> Outcome {
    for Problem { name, scene, exact } in problems {
        for &accuracy in accuracies {
            check_one(checks, &format!("{name}, {accuracy:e}"), (scene, exact), accuracy)?;
        }
    }
    Ok(())
}

fn check_one(
    checks: &mut Checks,
    name: &str,
    (scene, exact): (&Scene, &Trajectory),
    accuracy: f64,
) -> Outcome {
    let found = solve_to(scene, accuracy, &mut |_, _, _| ())?;
    if let Some(shortfall) = &found.report.shortfall {
        return Err(format!("{name}: {shortfall}").into());
    }
    let estimate = found.report.estimate.ok_or("no estimate")?;
    let error = error(&found, exact)?;
    let name = format!("{name}, {}, {} runs", found.report.settings, found.report.runs);
    for (what, estimate, error) in
        [("position", estimate.position, error.position), ("rotation", estimate.rotation, error.rotation)]
    {
        checks.below(Kind::ClosedForm, format!("{what}, {name}: error"), error, 2.0 * accuracy, ENOUGH);
        if error > LEAST {
            let label = format!("{what}, {name}: estimate {estimate:.2e} over error {error:.2e}");
            checks.above(Kind::ClosedForm, label.clone(), estimate / error, BAND[0], WANTED);
            checks.below(Kind::ClosedForm, label, estimate / error, BAND[1], WANTED);
        }
    }
    Ok(())
}

const TIP: problems::Stations = (1, &[1]);
/// Not at ends of elements: 37 is more than a mesh is made of for the sake of probes.
const INNER: problems::Stations = (37, &[5, 14, 26]);
/// At ends of elements, for meshes are chosen that way.
const SEVENTHS: problems::Stations = (7, &[1, 2, 3, 4, 5, 6, 7]);

fn small_bends(checks: &mut Checks) -> Outcome {
    let mut all = Vec::new();
    for alpha_squared in [10.0 / 9.0, 5.0, 10.0] {
        all.push(problems::cantilever(alpha_squared, TIP)?);
    }
    for slenderness in [1e2, 1e4] {
        all.push(problems::quarter_turn(slenderness, TIP)?);
    }
    for degrees in [30.0, 45.0, 90.0] {
        all.push(problems::princeton(degrees)?);
    }
    all.push(problems::cantilever(5.0, SEVENTHS)?);
    check(checks, &all, &STATIC)
}

/// The loads, the torsion constants and the slendernesses of the 45° bend.
fn arcs(checks: &mut Checks) -> Outcome {
    let mut all = Vec::new();
    for force in [300.0, 450.0, 600.0] {
        all.push(problems::bend((1.0, 1.0 / 6.0, force), TIP)?);
    }
    all.push(problems::bend((1.0, 0.141, 600.0), TIP)?);
    for width in [10.0_f64, 0.1, 0.01] {
        let fourth = width.powi(4);
        all.push(problems::bend((width, fourth / 6.0, 600.0 * fourth), TIP)?);
    }
    check(checks, &all, &STATIC)
}

fn turns(checks: &mut Checks) -> Outcome {
    let mut all = Vec::new();
    for turns in [0.125, 1.0, 2.25] {
        all.push(problems::roll_up(turns, TIP)?);
    }
    for slenderness in [1e1, 1e2, 1e3, 1e4] {
        all.push(problems::two_coils(slenderness)?);
    }
    check(checks, &all, &STATIC)
}

fn inner_probes(checks: &mut Checks) -> Outcome {
    let all = [
        problems::cantilever(10.0, INNER)?,
        problems::bend((1.0, 1.0 / 6.0, 600.0), (37, &[14]))?,
        problems::roll_up(2.25, INNER)?,
        problems::quarter_turn(1e2, INNER)?,
    ];
    check(checks, &all, &STATIC)
}

/// Every kind of load, the tip along the path and the shape at its end.
fn loads(checks: &mut Checks) -> Outcome {
    let mut read = |name: &str| checks.reference(name);
    let mut all = problems::loads(&mut read)?;
    all.extend(problems::shapes(&mut read)?);
    check(checks, &all, &STATIC)
}

fn pulled_coils(checks: &mut Checks) -> Outcome {
    let mut read = |name: &str| checks.reference(name);
    let mut all = Vec::new();
    for (words, slenderness) in [("100.0", 1e2), ("10000.0", 1e4)] {
        all.push(problems::pulled_coils(words, slenderness, &mut read)?);
    }
    check(checks, &all, &STATIC)
}

fn springs(checks: &mut Checks) -> Outcome {
    let mut read = |name: &str| checks.reference(name);
    let mut all = Vec::new();
    for on_axis in [false, true] {
        for force in [10.0, 100.0] {
            all.push(problems::spring(force, on_axis, &mut read)?);
        }
    }
    check(checks, &all, &[1e-2, 1e-4, 1e-6, 1e-8])
}

/// Two-node SE(3) elements, even node spacing, fitted references, full quadrature: other orders.
fn other_elements(checks: &mut Checks) -> Outcome {
    let mut read = |name: &str| checks.reference(name);
    let mut all = vec![
        problems::cantilever(5.0, TIP)?,
        problems::bend((1.0, 1.0 / 6.0, 600.0), TIP)?,
        problems::roll_up(1.0, TIP)?,
        problems::two_coils(1e2)?,
        problems::quarter_turn(1e2, TIP)?,
        problems::princeton(45.0)?,
    ];
    all.extend(problems::loads(&mut read)?);
    let se3: Vec<Problem> = all.iter().map(Problem::se3).collect();
    check(checks, &se3, &LINEAR)?;
    for change in [Problem::evenly_spaced, Problem::fitted, Problem::fully_integrated] {
        let changed: Vec<Problem> = all.iter().map(change).collect();
        check(checks, &changed, &LINEAR)?;
    }
    Ok(())
}

fn bodies(checks: &mut Checks) -> Outcome {
    let mut read = |name: &str| checks.reference(name);
    let all = motions::bodies(&mut read)?;
    check(checks, &all, &MOVING)
}

fn moving_rods(checks: &mut Checks) -> Outcome {
    let mut read = |name: &str| checks.reference(name);
    let all = motions::rods(&mut read)?;
    check(checks, &all, &MOVING)
}
