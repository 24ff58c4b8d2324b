//! What the spring costs: counted work, which is the same on every machine.

use cosserat::scene::Statics;
use cosserat::solution::Statistics;
use nalgebra::Vector3;

use super::spring::{Spring, WIRE_END, places, wire_end};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::displacement;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "spring_work::paper",
            "Harsch & Eugster, section 4.1: 500 increments, tolerance 1e-8",
            paper,
        )
        .slow(),
        Case::new(
            "spring_work::accurate_tip",
            "continuous rod equations, scripts/references/static_rods.py",
            accurate_tip,
        )
        .reads(&[WIRE_END]),
    ]
}

fn at_most(checks: &mut Checks, quantity: String, value: usize, bound: usize, reason: &'static str) {
    checks.below(Kind::Pinned, quantity, value as f64, bound as f64, reason);
}

fn statistics(
    elements: usize,
    increments: Option<usize>,
    place: usize,
) -> Result<Statistics, Box<dyn std::error::Error>> {
    let spring = Spring {
        statics: Statics { increments, tolerance: Some(1e-8), ..Statics::default() },
        ..Spring::new(100.0, elements, 2)
    };
    Ok(spring.solve(&places()[place])?.statistics)
}

/// To 100 N with the paper's tolerance, in its 500 increments and in automatic ones.
fn paper(checks: &mut Checks) -> Outcome {
    for (place, placement) in places().iter().enumerate() {
        let name = placement.name;
        let equal = statistics(75, Some(500), place)?;
        at_most(
            checks,
            format!("75 elements, 500 increments: iterations, {name}"),
            equal.newton_iterations,
            2000,
            "required: the mixed iteration of a prototype took 1879, the plain one 3181",
        );
        at_most(
            checks,
            format!("most in one increment, {name}"),
            equal.most_iterations,
            6,
            "required: the prototype took 5; the plain iteration 38",
        );
        let automatic = statistics(75, None, place)?;
        at_most(
            checks,
            format!("automatic increments: iterations, rejected increments included, {name}"),
            automatic.newton_iterations,
            400,
            "required: the prototype took 337",
        );
        let finer = statistics(150, Some(500), place)?;
        checks.absolute(
            Kind::Pinned,
            format!("150 elements: increments that converged of 500, {name}"),
            (finer.increments as f64, 500.0),
            0.0,
            "a count",
        );
    }
    Ok(())
}

/// 10 N to 1e-5 mm with 181 nodes in 60 iterations from zero.
fn accurate_tip(checks: &mut Checks) -> Outcome {
    let loads = wire_end(checks)?;
    let load = loads.iter().find(|load| load.force == 10.0).ok_or("the file has no 10 N")?;
    let (force, exact) = (load.force, load.exact);
    for placement in places() {
        let spring = Spring::new(force, 30, 6);
        let solution = spring.solve(&placement)?;
        let error = displacement(&solution, 0, &placement)? - Vector3::from(exact);
        checks.below(
            Kind::ClosedForm,
            format!("30 elements, p = 6 (181 nodes), 10 N: distance of the tip [m], {}", placement.name),
            error.norm(),
            1e-8,
            "required; the mesh's own error is 5.0e-9 m, the solver's 1e-10 m",
        );
        at_most(
            checks,
            format!("iterations from zero, {}", placement.name),
            solution.statistics.newton_iterations,
            60,
            "required; prototypes took 46 to 59 on every mesh and degree",
        );
    }
    Ok(())
}
