//! The 6×6 stiffness that the bob feels at its centre of mass, from small forces and moments on it.
//!
//! (force, moment about S) = K (displacement of S, rotation), inertial. The columns of K⁻¹ are central differences of
//! nonlinear equilibria under dead forces ±e, ±2e, combined such that the cubic terms drop out.

use std::error::Error;

use cosserat::rotation::{quaternion_product, rotation_vector};
use cosserat::scene::{LoadKind, Statics};
use nalgebra::{Matrix6, Vector3, Vector4, Vector6};

use super::{Pendulum, places};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{load, solve};
use crate::placement::Placement;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let source = "flexibility of the helix in closed form; linearised equations about the stretched shape";
    vec![
        Case::new("wilberforce::stiffness", source, stiffness).reads(&[FILE]),
        Case::new(
            "wilberforce::reciprocity",
            "Betti: K is symmetric; order 2p of the discretisation, see petrov_galerkin.rs",
            reciprocity,
        ),
    ]
}

/// e [N], and as a moment at the lever of the coil's radius.
const FORCE: f64 = 0.03;
const LEVER: f64 = 16e-3;

/// Flexibility of the helix in closed form, and the linearised equations about the stretched shape.
pub const FILE: &str = "continuous/wilberforce_stiffness.csv";

/// K about the `unloaded` or `stretched` shape.
pub fn exact(checks: &mut Checks, shape: &str) -> Result<Matrix6<f64>, Box<dyn Error>> {
    let table = checks.reference(FILE)?;
    let rows = table.select(&[("shape", shape)])?;
    let entries: Vec<f64> = rows.iter().map(|row| row.number("k")).collect::<Result<_, _>>()?;
    if entries.len() != 36 {
        return Err(format!("{} entries of K", entries.len()).into());
    }
    Ok(Matrix6::from_row_slice(&entries))
}

/// Pose of the bob under a force or moment.
fn pose(
    pendulum: &Pendulum,
    kind: LoadKind,
    value: Vector3<f64>,
    placement: &Placement,
) -> Result<(Vector3<f64>, Vector4<f64>), Box<dyn Error>> {
    let mut scene = pendulum.statics(Statics::default());
    scene.load.push(load(kind, "bob", value.into()));
    let solution = solve(&placement.apply(&scene))?;
    let probe = solution.rows.last().ok_or("no rows")?.probes[0].clone();
    Ok((placement.undo_position(probe.position.into()), probe.quaternion.into()))
}

/// (displacement, rotation) by which a load ±`size` along an axis moves the bob, per 2 `size`.
fn difference(
    pendulum: &Pendulum,
    column: usize,
    size: f64,
    placement: &Placement,
) -> Result<Vector6<f64>, Box<dyn Error>> {
    let (kind, size) = if column < 3 { (LoadKind::Force, size) } else { (LoadKind::Moment, size * LEVER) };
    let axis = Vector3::ith(column % 3, size);
    let (r, p) = pose(pendulum, kind, axis, placement)?;
    let (s, q) = pose(pendulum, kind, -axis, placement)?;
    // A_p A_qᵀ, inertial.
    let turn = rotation_vector(&quaternion_product(&p, &Vector4::new(q[0], -q[1], -q[2], -q[3])));
    let turn = placement.undo_direction(turn);
    let shift = r - s;
    Ok(Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z) / (2.0 * size))
}

pub fn measured(pendulum: &Pendulum, placement: &Placement) -> Result<Matrix6<f64>, Box<dyn Error>> {
    let mut compliance = Matrix6::zeros();
    for column in 0..6 {
        let once = difference(pendulum, column, FORCE, placement)?;
        let twice = difference(pendulum, column, 2.0 * FORCE, placement)?;
        compliance.set_column(column, &((4.0 * once - twice) / 3.0));
    }
    Ok(compliance.try_inverse().ok_or("no stiffness")?)
}

const BOUND: f64 = 1e-6;
const REASON: &str = "of √(K_ii K_jj): 0.06 N move the bob by 6e-4 m or 1/26 of the coil's radius, whose fourth power is \
                      2e-6, and the formula leaves 4/5 of 1/16 of it: 1e-7; residuals of 1e-9 of some 10 N in a \
                      difference of 0.06 N, four times, half of them by chance: 3e-7; a mesh of order 16";

fn stiffness(checks: &mut Checks) -> Outcome {
    for (shape, weight) in [("unloaded", false), ("stretched", true)] {
        let exact = exact(checks, shape)?;
        for placement in places() {
            let found = measured(&Pendulum { weight, ..Pendulum::new(12, 8) }, &placement)?;
            for i in 0..6 {
                for j in 0..6 {
                    let bound = BOUND * (found[(i, i)] * found[(j, j)]).sqrt();
                    let name = format!("K[{i}, {j}], {shape}, {}", placement.name);
                    let pair = (found[(i, j)], exact[(i, j)]);
                    checks.absolute(Kind::ClosedForm, name, pair, bound, REASON);
                }
            }
        }
    }
    Ok(())
}

/// max |K_ij − K_ji|/√(K_ii K_jj), about the stretched shape.
fn asymmetry(elements: usize, degree: usize) -> Result<f64, Box<dyn Error>> {
    let k = measured(&Pendulum::new(elements, degree), &places()[0])?;
    let pairs = (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
    Ok(pairs.map(|(i, j)| (k[(i, j)] - k[(j, i)]).abs() / (k[(i, i)] * k[(j, j)]).sqrt()).fold(0.0, f64::max))
}

fn reciprocity(checks: &mut Checks) -> Outcome {
    let meshes = [18, 36, 72];
    let mut errors = Vec::new();
    for elements in meshes {
        errors.push(asymmetry(elements, 2)?);
    }
    let reason = "2p = 4; at 36 elements an element spans 30°, and the next term, two orders higher with a constant of \
                  one, changes the order by log₂[(1 + (π/6)²)/(1 + (π/12)²)] = 0.25";
    checks.order("asymmetry of K, p = 2", &meshes, &errors, (4.0, 0.3), reason);
    checks.below(
        Kind::Invariant,
        "asymmetry of K, p = 8, 12 elements",
        asymmetry(12, 8)?,
        2.0 * BOUND,
        REASON,
    );
    Ok(())
}
