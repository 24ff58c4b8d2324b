//! A superposed rigid motion strains nothing, and the norm of a nodal quaternion turns nothing.
//!
//! Strains come from differences of positions, so a rod at the distance |c| from the origin carries |c| ε in them,
//! times Σ|N_i′|: that is what errors are measured against. Solved scenes keep positions relative to the rod.

use std::f64::consts::{PI, TAU};

use cosserat::element::{ElementForce, Stress, zero_tangent};
use cosserat::interpolation::{Interpolation, Pose, R12, Se3};
use cosserat::lagrange::basis_at_rule;
use cosserat::lanes::Plain;
use cosserat::quadrature::gauss_legendre;
use cosserat::rotation::{normalized, rotation_matrix};
use cosserat::scene::NodeSpacing;
use cosserat::state::State;
use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::derivatives::{STIFFNESS, reference_point};
use crate::formulas;
use crate::one_element::{internal_force, internal_tangent};
use crate::states::{ElementState, Generator, Worst, places};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "objectivity::rigid_motion",
            "r ↦ c + R r, A ↦ R A: strains and body moments stay, forces turn",
            rigid_motion,
        ),
        Case::new("objectivity::quaternion_norm", "eq. (5): A(αP) = A(P)", quaternion_norm),
    ]
}

/// Stress-carrying rows of an element and its strains.
struct Response<const N: usize> {
    strains: Vec<[Vector3<f64>; 2]>,
    force: ElementForce<N>,
    tangent: Vec<f64>,
}

fn response<const N: usize, I: Interpolation<N>>(
    poses: &[Pose; N],
) -> Result<Response<N>, Box<dyn std::error::Error>> {
    let rule = basis_at_rule(&places::<N>(NodeSpacing::GaussLobatto), &gauss_legendre(N - 1));
    let mut random = Generator::new(7);
    let reference: Vec<_> = rule.iter().map(|_| reference_point(&mut random)).collect();
    let mut stresses = vec![Stress::default(); rule.len()];
    let mut force = ElementForce::default();
    internal_force::<N, I>(Plain, poses, &rule, &reference, &STIFFNESS, &mut stresses, &mut force)?;
    let mut tangent = zero_tangent::<N>();
    internal_tangent::<N, I>(Plain, poses, &rule, &reference, &STIFFNESS, &stresses, &mut tangent)?;
    let mut strains = Vec::new();
    for basis in &rule {
        let strain = I::strain(poses, basis)?;
        strains.push([strain.gamma, strain.kappa]);
    }
    Ok(Response {
        strains,
        force,
        tangent: tangent.iter().flatten().flat_map(|block| block.iter().copied()).collect(),
    })
}

fn rigid_motion(checks: &mut Checks) -> Outcome {
    moved::<2, R12>(checks, "R12, p = 1")?;
    moved::<3, R12>(checks, "R12, p = 2")?;
    moved::<4, R12>(checks, "R12, p = 3")?;
    moved::<9, R12>(checks, "R12, p = 8")?;
    moved::<2, Se3>(checks, "SE(3)")
}

/// Every angle, half and whole turns and their neighbours among them; translations up to 10⁶ lengths.
fn moved<const N: usize, I: Interpolation<N>>(checks: &mut Checks, name: &str) -> Outcome {
    let places = places::<N>(NodeSpacing::GaussLobatto);
    let state = ElementState::<N>::new(&places, 1.2, 21);
    let still = state.poses();
    let reference = response::<N, I>(&still)?;
    let mut random = Generator::new(22);
    let [mut strains, mut rows, mut tangents] = [Worst::default(); 3];
    let angles = [1e-9, 0.5, 2.0, PI - 1e-8, PI, PI + 1e-8, 4.5, TAU - 1e-8, TAU, TAU + 1e-8, 20.0];
    for angle in angles {
        for distance in [0.0, 1.0, 1e3, 1e6] {
            let axis = random.axis();
            // Taken from sine and cosine, exact at any angle (Rodrigues' formula).
            let cross = formulas::tilde(&axis);
            let turn = Matrix3::identity() + cross * angle.sin() + cross * cross * (1.0 - angle.cos());
            let shift = distance * random.axis();
            let there: [Pose; N] = std::array::from_fn(|i| Pose {
                position: shift + turn * still[i].position,
                rotation: turn * still[i].rotation,
            });
            let response = response::<N, I>(&there)?;
            // Coordinates of the nodes, with their rounding; the element is about 1.3 long.
            let size = 3.0 + distance;
            for (a, b) in response.strains.iter().zip(&reference.strains) {
                let scale = [size, 1.0];
                for k in 0..2 {
                    strains.compare_against(a[k].iter().copied(), b[k].iter().copied(), scale[k] * SLOPES);
                }
            }
            let (a, b) = (&response.force, &reference.force);
            let peak = |scale: &[f64; N]| scale.iter().copied().fold(0.0, f64::max);
            for i in 0..N {
                let exact = turn * b.force[i];
                rows.compare_against(
                    a.force[i].iter().copied(),
                    exact.iter().copied(),
                    size * peak(&b.force_scale),
                );
                let exact = b.moment[i];
                rows.compare_against(
                    a.moment[i].iter().copied(),
                    exact.iter().copied(),
                    size * peak(&b.moment_scale),
                );
            }
            // Turned back: blocks (R, 1) K (Rᵀ, 1).
            let biggest = reference.tangent.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let exact = turned_tangent::<N>(&reference.tangent, &turn);
            tangents.compare_against(response.tangent, exact, size * biggest);
        }
    }
    let reason = "450 ε: a coordinate of size |c| + |r| carries ε, Σ|N′| and the stiffness add the rest, both in the scale";
    for (quantity, worst) in [("strains", strains), ("rows", rows), ("tangent", tangents)] {
        checks.below(Kind::Invariant, format!("{quantity}, {name}"), worst.0, 1e-13, reason);
    }
    Ok(())
}

/// Σ|N_i′| of the coarsest element.
const SLOPES: f64 = 2.0;

fn turned_tangent<const N: usize>(tangent: &[f64], turn: &Matrix3<f64>) -> Vec<f64> {
    let mut frame = Matrix6::identity();
    frame.fixed_view_mut::<3, 3>(0, 0).copy_from(turn);
    tangent
        .chunks_exact(36)
        .flat_map(|block| {
            let block = Matrix6::from_column_slice(block);
            (frame * block * frame.transpose()).iter().copied().collect::<Vec<_>>()
        })
        .collect()
}

fn quaternion_norm(checks: &mut Checks) -> Outcome {
    scaled::<2, R12>(checks, "R12, p = 1")?;
    scaled::<3, R12>(checks, "R12, p = 2")?;
    scaled::<6, R12>(checks, "R12, p = 5")?;
    scaled::<2, Se3>(checks, "SE(3)")
}

/// Norms between 1e-100 and 1e100, another one at every node.
fn scaled<const N: usize, I: Interpolation<N>>(checks: &mut Checks, name: &str) -> Outcome {
    let places = places::<N>(NodeSpacing::GaussLobatto);
    let [mut strains, mut rows, mut tangents, mut after] = [Worst::default(); 4];
    for seed in 0..10 {
        let state = ElementState::<N>::new(&places, 1.4, seed);
        let reference = response::<N, I>(&state.poses())?;
        let mut random = Generator::new(200 + seed);
        let mut nodes = State::default();
        for i in 0..N {
            let factor = 10f64.powf(100.0 * random.number());
            nodes.push(state.positions[i], state.quaternions[i] * factor);
        }
        let before: [Pose; N] = std::array::from_fn(|i| nodes.poses()[i]);
        let response = response::<N, I>(&before)?;
        for (a, b) in response.strains.iter().zip(&reference.strains) {
            strains.compare(a.iter().flatten().copied(), b.iter().flatten().copied());
        }
        let (a, b) = (&response.force, &reference.force);
        rows.compare(a.force.iter().flatten().copied(), b.force.iter().flatten().copied());
        rows.compare(a.moment.iter().flatten().copied(), b.moment.iter().flatten().copied());
        tangents.compare(response.tangent, reference.tangent);
        nodes.normalize();
        for (pose, (quaternion, exact)) in nodes.poses().iter().zip(nodes.quaternions().iter().zip(&before)) {
            after.compare(pose.rotation.iter().copied(), exact.rotation.iter().copied());
            after.compare_against([quaternion.norm()], [1.0], 1.0);
            let again = rotation_matrix(&(normalized(quaternion) * -3.0));
            after.compare(again.iter().copied(), exact.rotation.iter().copied());
        }
    }
    let reason =
        "450 ε: the factor rounds each component once, which the strains multiply by Σ|N′| and J/|γ|";
    for (quantity, worst) in
        [("strains", strains), ("rows", rows), ("tangent", tangents), ("after normalising", after)]
    {
        checks.below(Kind::Invariant, format!("{quantity}, {name}"), worst.0, 1e-13, reason);
    }
    Ok(())
}
