//! What the Petrov–Galerkin projection gives up, and at which order: (11) is not the gradient of the energy.
//!
//! Let ω(x) = Π (x − x_i) be the node polynomial of an element and h its length. With u_i = x − x_i,
//! N_i u_i = c_i ω. The consistent δγ̄, δκ̄ of an interpolation differ from those of the test functions (8), seen
//! from node i (A_iᵀA = exp(h u_i κ̃) + …), by
//!   h² N_i u_i (κ × γ)~ δφ_i  and  −½ h κ̃ (N_i u_i)′ δφ_i + O(h²)(½ N_i′u_i² − N_i u_i),
//! and by the interpolation error of A, h^{p+1} ω. Each is h² ω times something smooth after integration by parts
//! against smooth stress resultants. Gauss–Lobatto nodes (p ≥ 2) make ω orthogonal to all polynomials of degree
//! p − 2, and the p-point rule integrates that exactly; so a moment row is wrong by h^{p+1} at first, against
//! resultants of size one. For p = 1 and for SE(3) the parts h² of neighbouring elements cancel but at the two end
//! rows, where they stay: again order p + 1. On smooth fields δφ the weights combine, Σ δφ(x_i) N_i u_i being the
//! interpolation error −h^p δφ^{(p)} ω/p!, and integration against ω gains h^p more: energy, angular momentum and
//! reciprocity hold to order 2p. The force rows use δγ̄ = Aᵀ δr′ exactly and are exact.
//!
//! An entry of the tangent sees a single basis function in place of a smooth field. Between rotations the first-order
//! part falls out still, ∫ (N_i u_i)′ N_j′ = −c_i ∫ ω N_j″ = 0 since N_j″ has degree p − 2, and −½ h κ̃ (N_i u_i)′
//! against itself is of order 2; between a translation and a rotation h² N_i u_i (κ × γ)~ against h N_i γ̃ is of
//! order 1. SE(3) has h²/12 (κ̃² …)(N_i′) in the place of both: the same orders, and 2 between translations.

use std::f64::consts::TAU;

use cosserat::element::Stiffness;
use cosserat::interpolation::{Interpolation, Pose, R12, Se3};
use cosserat::scene::NodeSpacing;
use nalgebra::{DVector, Matrix3, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::discrete_rod::{DiscreteRod, node_places};
use crate::formulas;
use crate::states::{ElementState, places};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "petrov_galerkin::energy_gradient",
            "eq. (8), (11) against the gradient of Σ w J W; orders derived in this file",
            energy_gradient,
        ),
        Case::new("petrov_galerkin::momentum", "eq. (11): Σ N_i′ = 0; orders derived in this file", momentum),
        Case::new(
            "petrov_galerkin::tangent",
            "reciprocity (Betti) for the stress-free rod; orders derived in this file",
            tangent,
        ),
    ]
}

/// Within a factor of three, so that no row drowns in another.
const STIFFNESS: Stiffness =
    Stiffness { force: Vector3::new(3.0, 1.2, 1.6), moment: Vector3::new(1.0, 1.3, 1.9) };

/// One coil of a helix of radius 1 with its Serret–Frenet frame.
fn helix(xi: f64, radius: f64, slope: f64, angle: f64) -> Pose {
    let (sin, cos) = (angle * xi).sin_cos();
    let stretch = 1.0_f64.hypot(slope);
    Pose {
        position: radius * Vector3::new(sin, -cos, slope * angle * xi),
        rotation: Matrix3::from_columns(&[
            Vector3::new(cos, sin, slope) / stretch,
            Vector3::new(-sin, cos, 0.0),
            Vector3::new(-slope * cos, -slope * sin, 1.0) / stretch,
        ]),
    }
}

fn undeformed(xi: f64) -> Pose {
    helix(xi, 1.0, 0.2, TAU)
}

/// Another helix, whose sections are turned smoothly besides: all six strains, none of them constant.
fn deformed(xi: f64) -> Pose {
    let pose = helix(xi, 1.1, 0.35, 0.85 * TAU);
    let turn = 0.15 * Vector3::new((2.0 * xi).sin() + 0.3, (3.0 * xi).cos(), (1.0 + 2.5 * xi).sin());
    Pose {
        position: pose.position + 0.1 * Vector3::new((2.0 * xi).cos(), xi * xi, (3.0 * xi).sin()),
        rotation: pose.rotation * formulas::exp(&turn),
    }
}

/// A smooth virtual displacement (inertial) and rotation (body) along the rod.
fn field(xi: f64, k: f64) -> (Vector3<f64>, Vector3<f64>) {
    (
        Vector3::new((k * xi).sin(), (2.0 * xi + k).cos(), xi * xi - k * xi),
        Vector3::new((1.0 + k * xi).cos(), (k * xi + 0.4).sin(), (2.0 * xi - k).cos()),
    )
}

const SE3: &str = "SE(3)";
const MESHES: [usize; 3] = [10, 20, 40];

/// How far the finest pair of meshes can still be from its limit.
const TOLERANCE: f64 = 0.25;
const TOLERANCE_REASON: &str = "the next term, one order higher with a constant of one, changes the order by \
                                log₂[(1 + 2π/20)/(1 + 2π/40)] = 0.18 at 40 elements a coil";

fn rod<const N: usize, I: Interpolation<N>>(
    elements: usize,
    shape: fn(f64) -> Pose,
) -> Result<(DiscreteRod<N>, Vec<Pose>), Box<dyn std::error::Error>> {
    let xi = node_places::<N>(elements);
    let reference: Vec<Pose> = xi.iter().map(|&xi| undeformed(xi)).collect();
    let rod = DiscreteRod::new::<I>(&reference, STIFFNESS)?;
    Ok((rod, xi.iter().map(|&xi| shape(xi)).collect()))
}

fn energy_gradient(checks: &mut Checks) -> Outcome {
    gradient::<2, R12>(checks, "R12, p = 1")?;
    gradient::<3, R12>(checks, "R12, p = 2")?;
    gradient::<4, R12>(checks, "R12, p = 3")?;
    gradient::<2, Se3>(checks, SE3)
}

/// max |f + ∂E/∂q| over the nodes, against the largest nodal sum of absolute contributions, force and moment rows
/// apart; and the work of the difference on a smooth field, against the same.
fn gradient<const N: usize, I: Interpolation<N>>(checks: &mut Checks, name: &str) -> Outcome {
    let p = N - 1;
    let (mut translations, mut rotations, mut work) = (Vec::new(), Vec::new(), Vec::new());
    for elements in MESHES {
        let (rod, poses) = rod::<N, I>(elements, deformed)?;
        let discrete = rod.internal::<I>(&poses)?;
        let [force, moment] = rod.energy_gradient::<I>(&poses)?;
        let off = |a: &[Vector3<f64>], b: &[Vector3<f64>]| {
            a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
        };
        translations.push(off(&discrete.force, &force) / discrete.force_scale);
        rotations.push(off(&discrete.moment, &moment) / discrete.moment_scale);
        let sum: f64 = node_places::<N>(elements)
            .into_iter()
            .zip(discrete.moment.iter().zip(&moment))
            .map(|(xi, (a, b))| field(xi, 1.7).1.dot(&(a - b)))
            .sum();
        work.push(sum.abs() / discrete.moment_scale);
    }
    if name == SE3 {
        falls(checks, format!("force rows, {name}"), &MESHES, &translations, p + 1);
    } else {
        exact(checks, format!("force rows, {name}"), &translations);
    }
    falls(checks, format!("moment rows, {name}"), &MESHES, &rotations, p + 1);
    falls(checks, format!("work on a smooth rotation, {name}"), &MESHES, &work, 2 * p);
    Ok(())
}

/// An order, and an absolute cap.
fn falls(checks: &mut Checks, quantity: String, meshes: &[usize], errors: &[f64], order: usize) {
    let cap = 3.0 * (TAU / meshes[meshes.len() - 1] as f64).powi(order as i32);
    let last = errors.last().copied().unwrap_or(f64::NAN);
    checks.order(quantity.clone(), meshes, errors, (order as f64, TOLERANCE), TOLERANCE_REASON);
    checks.below(
        Kind::Order,
        format!("{quantity}, finest"),
        last,
        cap,
        "3 (κh)^order: means of ω and 1/p! are below one, the ratio of the stiffnesses below three",
    );
}

fn exact(checks: &mut Checks, quantity: String, errors: &[f64]) {
    let reason = "450 ε: the same products in another order, a few dozen of them, against their absolute sum";
    for error in errors {
        checks.below(Kind::Invariant, quantity.clone(), *error, 1e-13, reason);
    }
}

fn momentum(checks: &mut Checks) -> Outcome {
    linear::<2, R12>(checks, "R12, p = 1")?;
    linear::<3, R12>(checks, "R12, p = 2")?;
    linear::<6, R12>(checks, "R12, p = 5")?;
    linear::<2, Se3>(checks, SE3)?;
    angular::<2, R12>(checks, "R12, p = 1")?;
    angular::<3, R12>(checks, "R12, p = 2")?;
    angular::<4, R12>(checks, "R12, p = 3")?;
    angular::<2, Se3>(checks, SE3)
}

/// Σ f = 0 on any state, here one with nothing smooth about it.
fn linear<const N: usize, I: Interpolation<N>>(checks: &mut Checks, name: &str) -> Outcome {
    let places = places::<N>(NodeSpacing::GaussLobatto);
    for (seed, angle) in [(1, 0.01), (2, 1.0), (3, 2.9)] {
        let undeformed = ElementState::<N>::new(&places, 0.5, 40 + seed).poses();
        let rod = DiscreteRod::new::<I>(&undeformed, STIFFNESS)?;
        let rows = rod.internal::<I>(&ElementState::<N>::new(&places, angle, seed).poses())?;
        checks.below(
            Kind::Invariant,
            format!("Σ f, {name}, turned by {angle}"),
            rows.force.iter().sum::<Vector3<f64>>().norm() / rows.force_scale,
            1e-13,
            "450 ε: Σ N_i′ = 0 to p² ε, summed over p + 1 nodes and p points",
        );
    }
    Ok(())
}

/// Σ (r × f + A m) about the origin, against the largest nodal moment contribution.
fn angular<const N: usize, I: Interpolation<N>>(checks: &mut Checks, name: &str) -> Outcome {
    let mut errors = Vec::new();
    for elements in MESHES {
        let (rod, poses) = rod::<N, I>(elements, deformed)?;
        let rows = rod.internal::<I>(&poses)?;
        let sum: Vector3<f64> = poses
            .iter()
            .zip(rows.force.iter().zip(&rows.moment))
            .map(|(pose, (f, m))| pose.position.cross(f) + pose.rotation * m)
            .sum();
        errors.push(sum.norm() / rows.moment_scale);
    }
    falls(checks, format!("Σ r × f + A m, {name}"), &MESHES, &errors, 2 * (N - 1));
    Ok(())
}

fn tangent(checks: &mut Checks) -> Outcome {
    entries::<2, R12>(checks, &[40, 80, 160], "R12, p = 1")?;
    entries::<3, R12>(checks, &[20, 40, 80], "R12, p = 2")?;
    entries::<4, R12>(checks, &[20, 40, 80], "R12, p = 3")?;
    entries::<2, Se3>(checks, &[40, 80, 160], SE3)?;
    reciprocity::<2, R12>(checks, "R12, p = 1")?;
    reciprocity::<3, R12>(checks, "R12, p = 2")?;
    reciprocity::<4, R12>(checks, "R12, p = 3")?;
    reciprocity::<2, Se3>(checks, SE3)
}

/// Without stress: max |K − Kᵀ| against max |K|, by blocks, which have different units.
fn entries<const N: usize, I: Interpolation<N>>(
    checks: &mut Checks,
    meshes: &[usize],
    name: &str,
) -> Outcome {
    let mut errors: [Vec<f64>; 3] = Default::default();
    for &elements in meshes {
        let (rod, poses) = rod::<N, I>(elements, undeformed)?;
        let k = rod.tangent::<I>(&poses)?;
        let (mut off, mut size) = ([0.0_f64; 3], [0.0_f64; 3]);
        for (i, j) in (0..k.nrows()).flat_map(|i| (0..i).map(move |j| (i, j))) {
            // Translations, mixed, rotations.
            let block = usize::from(i % 6 >= 3) + usize::from(j % 6 >= 3);
            size[block] = size[block].max(k[(i, j)].abs());
            off[block] = off[block].max((k[(i, j)] - k[(j, i)]).abs());
        }
        for block in 0..3 {
            errors[block].push(off[block] / size[block]);
        }
    }
    let [translations, mixed, rotations] = errors;
    if name == SE3 {
        falls(checks, format!("K − Kᵀ, translations, {name}"), meshes, &translations, 2);
    } else {
        exact(checks, format!("K − Kᵀ, translations, {name}"), &translations);
    }
    falls(checks, format!("K − Kᵀ, mixed, {name}"), meshes, &mixed, 1);
    falls(checks, format!("K − Kᵀ, rotations, {name}"), meshes, &rotations, 2);
    Ok(())
}

/// Betti: a·Kb = b·Ka for smooth fields, against √(a·Ka b·Kb).
fn reciprocity<const N: usize, I: Interpolation<N>>(checks: &mut Checks, name: &str) -> Outcome {
    let mut errors = Vec::new();
    for elements in MESHES {
        let (rod, poses) = rod::<N, I>(elements, undeformed)?;
        let k = rod.tangent::<I>(&poses)?;
        let sample = |wave: f64| {
            let fields = node_places::<N>(elements).into_iter().map(|xi| field(xi, wave));
            DVector::from_vec(fields.flat_map(|(r, phi)| [r.x, r.y, r.z, phi.x, phi.y, phi.z]).collect())
        };
        let (a, b) = (sample(1.3), sample(2.1));
        let (ka, kb) = (&k * &a, &k * &b);
        errors.push((a.dot(&kb) - b.dot(&ka)).abs() / (a.dot(&ka) * b.dot(&kb)).sqrt());
    }
    falls(checks, format!("reciprocity, {name}"), &MESHES, &errors, 2 * (N - 1));
    Ok(())
}
