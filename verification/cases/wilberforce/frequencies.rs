//! Small vibrations about the unloaded shape and about the shape stretched by the weight.

use std::error::Error;

use super::{Pendulum, places};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "wilberforce::frequencies",
            "scripts/wilberforce.py: shooting and Chebyshev collocation, 1e-11 relative",
            values,
        ),
        Case::new(
            "wilberforce::frequency_order",
            "scripts/wilberforce.py; order 2p of the discretisation",
            order,
        ),
    ]
}

/// Angular frequencies [rad/s] with a massless wire.
pub const UNLOADED_MASSLESS: [f64; 6] =
    [9.290429107497, 9.294925815816, 14.804983666863, 16.157450861205, 39.973428490412, 39.993703831421];
pub const STRETCHED_MASSLESS: [f64; 6] =
    [13.154403091613, 13.253228466808, 14.856256910180, 16.574105425118, 52.846911881299, 53.846779278813];
/// With the inertia of the wire.
pub const UNLOADED: [f64; 12] = [
    9.289278251145,
    9.293614370552,
    14.795062654911,
    16.146787529035,
    39.890676645235,
    39.923856639279,
    715.9363680505,
    794.7516006501,
    994.7090033624,
    1033.586714437,
    1038.653404663,
    1126.859255995,
];
pub const STRETCHED: [f64; 12] = [
    13.150559158515,
    13.249651001766,
    14.846872477809,
    16.563689902162,
    52.750598360869,
    53.725704297844,
    722.0788826807,
    796.5397373208,
    989.1961361816,
    1049.581000861,
    1273.538979528,
    1366.395617067,
];

const BOUND: f64 = 1e-7;
const REASON: &str = "between neighbouring nodes the wire is EA p²/h = 4e8 N/m stiff in tension, 4e6 times as stiff as \
                      the spring: rounding enters ω² with 4e6 ε = 9e-10 at each of a hundred nodes, 9e-8 if all have \
                      one sign; the equilibrium is solved to 1e-9; a mesh of order 16 leaves (π/2)¹⁶/16! = 7e-11; 1e-11 \
                      in the reference";

fn values(checks: &mut Checks) -> Outcome {
    let problems: [(&str, bool, bool, &[f64]); 4] = [
        ("unloaded, massless wire", false, false, &UNLOADED_MASSLESS),
        ("stretched, massless wire", true, false, &STRETCHED_MASSLESS),
        ("unloaded", false, true, &UNLOADED),
        ("stretched", true, true, &STRETCHED),
    ];
    for (name, weight, inertia, exact) in problems {
        for placement in places() {
            let pendulum = Pendulum { weight, inertia, ..Pendulum::new(12, 8) };
            let (found, solution) = pendulum.modes(&placement, exact.len())?;
            let name = format!("{name}, {}", placement.name);
            for (k, (&found, &exact)) in found.iter().zip(exact).enumerate() {
                let label = format!("ω{} [rad/s], {name}", k + 1);
                checks.relative(Kind::ClosedForm, label, (found, exact), BOUND, REASON);
            }
            let reason = "as many as were asked for; a pair that turned complex would be reported";
            let missing = exact.len().abs_diff(found.len()) + solution.warnings.len();
            checks.below(Kind::Invariant, format!("missing or complex, {name}"), missing as f64, 0.0, reason);
        }
    }
    Ok(())
}

/// Modes that lie close together share the error of the mesh, which turns their plane; the sum of their ω² does not
/// see that.
const GROUPS: [&[usize]; 4] = [&[0, 1], &[2], &[3], &[4, 5]];

/// Relative errors of Σ ω² of each group about the stretched shape, and the number of complex pairs.
fn errors(elements: usize, degree: usize) -> Result<(Vec<f64>, usize), Box<dyn Error>> {
    let (found, solution) = Pendulum::new(elements, degree).modes(&places()[0], 6)?;
    let sum = |values: &[f64], group: &[usize]| group.iter().map(|&k| values[k].powi(2)).sum::<f64>();
    let error = |group: &&[usize]| (sum(&found, group) / sum(&STRETCHED, group) - 1.0).abs();
    Ok((GROUPS.iter().map(error).collect(), solution.warnings.len()))
}

fn order(checks: &mut Checks) -> Outcome {
    let problems = [(1, [144, 288, 576], 2.0), (2, [36, 72, 144], 4.0), (3, [18, 24, 36], 6.0)];
    for (degree, meshes, expected) in problems {
        let mut table = Vec::new();
        for elements in meshes {
            let (errors, complex) = errors(elements, degree)?;
            table.push(errors);
            let name = format!("complex pairs, p = {degree}, {elements} elements");
            let reason =
                "the asymmetry of K, of the same order as the error, is far below the distance of the modes";
            checks.below(Kind::Invariant, name, complex as f64, 0.0, reason);
        }
        for (k, group) in GROUPS.iter().enumerate() {
            let errors: Vec<f64> = table.iter().map(|errors| errors[k]).collect();
            checks.order(
                format!("Σ ω² of modes {group:?} from 0, stretched, p = {degree}"),
                &meshes,
                &errors,
                (expected, 0.3),
                "2p; on the meshes before the finest an element spans 15° to 45°, and the next term, two orders higher \
                 with a constant of one, changes the order by 0.25 from 30° to 15° and by 0.2 from 45° to 30°",
            );
        }
    }
    Ok(())
}
