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
    let source = "scripts/wilberforce.py: flexibility of the helix in closed form; linearised equations about the \
                  stretched shape";
    vec![
        Case::new("wilberforce::stiffness", source, stiffness),
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

/// Of the unloaded shape; entries that vanish up to the small pitch are left out.
const UNLOADED: [(usize, usize, f64); 10] = [
    (0, 0, 251.5678288630),
    (1, 1, 251.4912026075),
    (2, 2, 102.968678319),
    (3, 3, 0.1296820290833),
    (4, 4, 0.1297128150874),
    (5, 5, 0.0324294362114),
    (0, 2, 2.501170237),
    (0, 4, 5.031356577),
    (1, 3, -5.029824052),
    (2, 5, -3.767864753e-3),
];

/// Of the shape stretched by the weight.
const STRETCHED: [[f64; 6]; 6] = [
    [177.2226657361, -0.2551283849, 16.9112536103, 0.0926586259, 5.1476563640, 0.0171186632],
    [-0.2551283849, 178.8093648259, 0.9773200454, -5.1805321029, -0.0549031764, -0.0414179839],
    [16.9112536103, 0.9773200454, 112.5338821906, -0.0083582740, 0.7405435828, 0.1883510948],
    [0.0926586259, -5.1805321029, -0.0083582740, 0.2983747815, 0.0058541398, 0.0044487757],
    [5.1476563640, -0.0549031764, 0.7405435828, 0.0058541398, 0.2973725006, 0.0009419567],
    [0.0171186632, -0.0414179839, 0.1883510948, 0.0044487757, 0.0009419567, 0.0322605028],
];

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
    for placement in places() {
        let fine = Pendulum::new(12, 8);
        let unloaded = measured(&Pendulum { weight: false, ..fine.clone() }, &placement)?;
        for (i, j, exact) in UNLOADED {
            let bound = BOUND * (unloaded[(i, i)] * unloaded[(j, j)]).sqrt();
            let name = format!("K[{i}, {j}], unloaded, {}", placement.name);
            checks.absolute(Kind::ClosedForm, name, (unloaded[(i, j)], exact), bound, REASON);
        }
        let stretched = measured(&fine, &placement)?;
        for i in 0..6 {
            for j in 0..6 {
                let bound = BOUND * (stretched[(i, i)] * stretched[(j, j)]).sqrt();
                let name = format!("K[{i}, {j}], stretched, {}", placement.name);
                let pair = (stretched[(i, j)], STRETCHED[i][j]);
                checks.absolute(Kind::ClosedForm, name, pair, bound, REASON);
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
