//! Every map of rotations and motions that the solver uses, and one free rigid body, sample by sample: against
//! Pinocchio, and against mpmath with 50 digits and more (`scripts/references/pinocchio_*.py`).
//!
//! Both compare with the digits of the same inputs. Our error is held in units of what rounding explains: of an entry
//! of a matrix near 1 that is min(1, θ) off the diagonal, and where a map is ill-conditioned its condition, which every
//! comparison states. A logarithm is not ill-conditioned at half a turn (J_r⁻¹ has norm π/2 there), only formulas that
//! divide by sin θ are; J_r⁻¹ is at a full turn, like θ/(2π − θ). Pinocchio's rows are good to 1e-12 and are left out
//! where it loses digits.

mod bodies;
mod motions;
mod rotations;

use std::error::Error;

use nalgebra::{Matrix3, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::references::Row;

/// The cases of this folder.
pub fn all() -> Vec<Case> {
    [rotations::all(), motions::all(), bodies::all()].into_iter().flatten().collect()
}

/// What Pinocchio's rows are good for.
const PINOCCHIO: f64 = 1e-12;
const PINOCCHIO_REASON: &str =
    "Pinocchio's rows are within 1e-12 of 50 digits; where it loses more they are left out";

/// The columns of a matrix by rows.
const MATRIX: &str = "a11 a12 a13 a21 a22 a23 a31 a32 a33";

type Read<T> = Result<T, Box<dyn Error>>;

/// What is compared, and how many ε rounding may make of its scale.
struct Quantity {
    name: &'static str,
    rounding: f64,
    reason: &'static str,
}

/// The largest error in units of its scale, and the row's angle there.
#[derive(Clone, Copy, Default)]
struct Worst {
    error: f64,
    at: f64,
}

/// One check for each quantity, each program and each range of `label`; `measure` returns the row's angle [rad] (or
/// what else names it) and the errors in units of their scale.
fn compare<'a, const N: usize>(
    checks: &mut Checks,
    rows: impl IntoIterator<Item = Row<'a>>,
    label: &str,
    quantities: [Quantity; N],
    measure: impl Fn(&Row) -> Read<(f64, [f64; N])>,
) -> Outcome {
    let mut groups: Vec<(&str, bool, [Worst; N])> = Vec::new();
    for row in rows {
        let (name, theirs) = (row.word(label)?, from_pinocchio(&row)?);
        let place = groups.iter().position(|group| (group.0, group.1) == (name, theirs));
        let place = place.unwrap_or_else(|| {
            groups.push((name, theirs, [Worst::default(); N]));
            groups.len() - 1
        });
        let (at, errors) = measure(&row)?;
        for (worst, error) in groups[place].2.iter_mut().zip(errors) {
            if error.is_nan() || error > worst.error {
                *worst = Worst { error, at };
            }
        }
    }
    for (name, theirs, worst) in groups {
        for (Quantity { name: what, rounding, reason }, Worst { error, at }) in quantities.iter().zip(worst) {
            let (kind, program, bound, reason) = if theirs {
                (Kind::CrossCode, "Pinocchio", PINOCCHIO, PINOCCHIO_REASON)
            } else {
                (Kind::ClosedForm, "mpmath", rounding * f64::EPSILON, *reason)
            };
            checks.below(
                kind,
                format!("{what}, {label} {name}, {program}: worst at {at:.9e}"),
                error,
                bound,
                reason,
            );
        }
    }
    Ok(())
}

/// Whether a row is Pinocchio's.
fn from_pinocchio(row: &Row) -> Read<bool> {
    match row.word("by")? {
        "pinocchio" => Ok(true),
        "mpmath" => Ok(false),
        other => Err(format!("rows of {other} are not known here").into()),
    }
}

fn vector(row: &Row, columns: &str) -> Read<Vector3<f64>> {
    Ok(Vector3::from(row.numbers::<3>(columns)?))
}

fn matrix(row: &Row, columns: &str) -> Read<Matrix3<f64>> {
    Ok(Matrix3::from_row_slice(&row.numbers::<9>(columns)?))
}

/// What small angles are small against: θ itself for the digits of mpmath, nothing for Pinocchio's.
fn smallness(row: &Row, angle: f64) -> Read<f64> {
    Ok(if from_pinocchio(row)? { 1.0 } else { angle.min(1.0) })
}

/// Largest error of an entry, off the diagonal in units of `small`.
fn entries(ours: &Matrix3<f64>, reference: &Matrix3<f64>, small: f64) -> f64 {
    let mut worst: f64 = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            let error = (ours[(i, j)] - reference[(i, j)]).abs() / if i == j { 1.0 } else { small };
            worst = if error.is_nan() || error > worst { error } else { worst };
        }
    }
    worst
}

/// x/|sin x| for x = θ/2, the condition of J_r⁻¹: its entries are 1, x and 1 − x cot x.
fn condition(angle: f64) -> f64 {
    let half = 0.5 * angle;
    half / half.sin().abs()
}
