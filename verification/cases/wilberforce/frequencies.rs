//! Small vibrations about the unloaded shape and about the shape stretched by the weight.

use std::error::Error;

use super::{Pendulum, places};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "wilberforce::frequencies",
            "shooting and Chebyshev collocation of the continuous equations, 1e-11 relative",
            values,
        )
        .reads(&[FILE]),
        Case::new(
            "wilberforce::frequency_order",
            "shooting and Chebyshev collocation; order 2p of the discretisation",
            order,
        )
        .reads(&[FILE]),
    ]
}

/// By shooting and Chebyshev collocation.
pub const FILE: &str = "continuous/wilberforce_frequencies.csv";

/// Angular frequencies [rad/s] about the `unloaded` or `stretched` shape, of a `massless` wire or with its `inertia`.
pub fn exact(checks: &mut Checks, shape: &str, wire: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    let table = checks.reference(FILE)?;
    let rows = table.select(&[("shape", shape), ("wire", wire)])?;
    rows.iter().map(|row| row.number("omega")).collect()
}

const BOUND: f64 = 1e-7;
const REASON: &str = "between neighbouring nodes the wire is EA p²/h = 4e8 N/m stiff in tension, 4e6 times as stiff as \
                      the spring: rounding enters ω² with 4e6 ε = 9e-10 at each of a hundred nodes, 9e-8 if all have \
                      one sign; the equilibrium is solved to 1e-9; a mesh of order 16 leaves (π/2)¹⁶/16! = 7e-11; 1e-11 \
                      in the reference";

fn values(checks: &mut Checks) -> Outcome {
    for (shape, wire) in [
        ("unloaded", "massless"),
        ("stretched", "massless"),
        ("unloaded", "inertia"),
        ("stretched", "inertia"),
    ] {
        let exact = exact(checks, shape, wire)?;
        let (weight, inertia) = (shape == "stretched", wire == "inertia");
        for placement in places() {
            let pendulum = Pendulum { weight, inertia, ..Pendulum::new(12, 8) };
            let (found, solution) = pendulum.modes(&placement, exact.len())?;
            let name = format!("{shape}, wire: {wire}, {}", placement.name);
            for (k, (&found, &exact)) in found.iter().zip(&exact).enumerate() {
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
fn errors(exact: &[f64], elements: usize, degree: usize) -> Result<(Vec<f64>, usize), Box<dyn Error>> {
    let (found, solution) = Pendulum::new(elements, degree).modes(&places()[0], 6)?;
    let sum = |values: &[f64], group: &[usize]| group.iter().map(|&k| values[k].powi(2)).sum::<f64>();
    let error = |group: &&[usize]| (sum(&found, group) / sum(exact, group) - 1.0).abs();
    Ok((GROUPS.iter().map(error).collect(), solution.warnings.len()))
}

fn order(checks: &mut Checks) -> Outcome {
    let exact = exact(checks, "stretched", "inertia")?;
    let problems = [(1, [144, 288, 576], 2.0), (2, [36, 72, 144], 4.0), (3, [18, 24, 36], 6.0)];
    for (degree, meshes, expected) in problems {
        let mut table = Vec::new();
        for elements in meshes {
            let (errors, complex) = errors(&exact, elements, degree)?;
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
