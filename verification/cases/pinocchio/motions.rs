//! SE(3): exponential, logarithm and right tangents; poses of a free flyer: how a node is updated, and what the
//! two-node SE(3) element makes of two poses.

use cosserat::interpolation::{Increment, Interpolation, Pose, Se3};
use cosserat::lagrange::basis;
use cosserat::rotation::{
    Twist, TwistMap, exp_se3, log_se3, right_jacobian_inverse_se3, right_jacobian_se3, rotation_matrix,
};
use cosserat::state::State;
use nalgebra::{Matrix3, Vector4};

use super::{MATRIX, Quantity, Read, compare, condition, entries, matrix, smallness, vector};
use crate::case::{Case, Checks, Outcome};
use crate::references::Row;
use crate::strains::strain_derivative;

const SOURCE: &str = "Pinocchio 4.1.0 and mpmath, scripts/references/pinocchio_motions.py";

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("pinocchio::motion_exponential", SOURCE, exponential)
            .reads(&["pinocchio/motion_exponential.csv"]),
        Case::new("pinocchio::motion_logarithm", SOURCE, logarithm)
            .reads(&["pinocchio/motion_logarithm.csv"]),
        Case::new("pinocchio::motion_tangents", SOURCE, tangents).reads(&["pinocchio/motion_tangents.csv"]),
        Case::new("pinocchio::free_flyer", SOURCE, free_flyer).reads(&["pinocchio/free_flyer.csv"]),
        Case::new("pinocchio::free_flyer_tangents", SOURCE, free_flyer_tangents)
            .reads(&["pinocchio/free_flyer_tangents.csv"]),
    ]
}

const V: &str = "v_x v_y v_z";
const PSI: &str = "x y z";
const DIAGONAL: &str = "j11 j12 j13 j21 j22 j23 j31 j32 j33";
const COUPLING: &str = "k11 k12 k13 k21 k22 k23 k31 k32 k33";

fn twist(row: &Row) -> Read<Twist> {
    Ok(Twist { translation: vector(row, V)?, rotation: vector(row, PSI)? })
}

fn exponential(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/motion_exponential.csv")?;
    let quantities = [
        Quantity {
            name: "Exp θ, rotation over 1 + θ/4, off the diagonal over θ < 1",
            rounding: 10.0,
            reason: "10 ε: as exp of SO(3)",
        },
        Quantity {
            name: "Exp θ, translation over |v|",
            rounding: 12.0,
            reason: "12 ε: V(ψ) carries 8 ε an entry, as its transpose J_r, and a product with v is a sum of three",
        },
    ];
    compare(checks, table.rows(), "range", quantities, |row| {
        let twist = twist(row)?;
        let angle = twist.rotation.norm();
        let (rotation, position) = exp_se3(&twist);
        let turned = entries(&rotation, &matrix(row, MATRIX)?, smallness(row, angle)?);
        let moved = (position - vector(row, "r_x r_y r_z")?).norm();
        Ok((angle, [turned / (1.0 + 0.25 * angle), moved / twist.translation.norm()]))
    })
}

fn logarithm(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/motion_logarithm.csv")?;
    let quantities = [
        Quantity { name: "Log H, rotation over θ", rounding: 12.0, reason: "12 ε: as log of SO(3)" },
        Quantity {
            name: "Log H, translation over |r|",
            rounding: 20.0,
            reason: "20 ε: V⁻¹ carries 4 ε (1 + x²/sin² x), 14 ε at half a turn, and half of ψ's 12 ε turns r",
        },
    ];
    compare(checks, table.rows(), "range", quantities, |row| {
        let (r, reference) = (vector(row, "r_x r_y r_z")?, twist(row)?);
        let angle = reference.rotation.norm();
        let ours = log_se3(&matrix(row, MATRIX)?, &r).ok_or("no logarithm below half a turn")?;
        let size = angle.max(1.0) * smallness(row, angle)?;
        let turned = (ours.rotation - reference.rotation).norm() / size;
        Ok((angle, [turned, (ours.translation - reference.translation).norm() / r.norm()]))
    })
}

/// Errors of both blocks: the diagonal one over `size`, the coupling over `coupled`.
fn blocks(ours: &TwistMap, row: &Row, small: f64, [size, coupled]: [f64; 2]) -> Read<[f64; 2]> {
    let diagonal = entries(&ours.diagonal, &matrix(row, DIAGONAL)?, small) / size;
    Ok([diagonal, entries(&ours.coupling, &matrix(row, COUPLING)?, 1.0) / coupled])
}

const COUPLING_REASON: &str = "12 ε: five terms of up to |v|, b₁ and c₁ with up to 9 ε beyond θ = 1, where \
                               they are quotients of differences; turned by a matrix; roundings of either sign";

fn tangents(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/motion_tangents.csv")?;
    let quantities = [
        Quantity {
            name: "J_r(θ), diagonal block, off the diagonal over θ < 1",
            rounding: 8.0,
            reason: "8 ε: as J_r of SO(3)",
        },
        Quantity { name: "J_r(θ), coupling, over |v|", rounding: 12.0, reason: COUPLING_REASON },
    ];
    compare(checks, table.select(&[("map", "Jexp6")])?, "range", quantities, |row| {
        let twist = twist(row)?;
        let angle = twist.rotation.norm();
        let sizes = [1.0, twist.translation.norm()];
        Ok((angle, blocks(&right_jacobian_se3(&twist), row, smallness(row, angle)?, sizes)?))
    })?;
    let quantities = [
        Quantity {
            name: "J_r(θ)⁻¹, diagonal block, over 1 + x²/sin² x, x = θ/2, off the diagonal over θ < 1",
            rounding: 8.0,
            reason: "8 ε: as J_r⁻¹ of SO(3)",
        },
        Quantity {
            name: "J_r(θ)⁻¹, coupling, over |v| (1 + x³/|sin x|³)",
            rounding: 10.0,
            reason: "10 ε: the derivative of x cot x in ψ is x²/sin² x, its relative error 1.25 ε x/|sin x|; \
                     four terms of size |v| as in J_r",
        },
    ];
    compare(checks, table.select(&[("map", "Jlog6")])?, "range", quantities, |row| {
        let twist = twist(row)?;
        let angle = twist.rotation.norm();
        let x = condition(angle);
        let sizes = [1.0 + x.powi(2), twist.translation.norm() * (1.0 + x.powi(3))];
        Ok((angle, blocks(&right_jacobian_inverse_se3(&twist), row, smallness(row, angle)?, sizes)?))
    })
}

/// Position and quaternion of a free flyer.
fn place(row: &Row, index: usize) -> Read<(Pose, Vector4<f64>)> {
    let i = index;
    let quaternion = Vector4::from(row.numbers::<4>(&format!("q{i}_w q{i}_x q{i}_y q{i}_z"))?);
    let position = vector(row, &format!("r{i}_x r{i}_y r{i}_z"))?;
    Ok((Pose { position, rotation: rotation_matrix(&quaternion) }, quaternion))
}

/// Both nodes of an SE(3) element.
fn nodes(row: &Row) -> Read<[Pose; 2]> {
    Ok([place(row, 0)?.0, place(row, 1)?.0])
}

fn matrix_of(row: &Row, name: &str) -> Read<Matrix3<f64>> {
    matrix(row, &MATRIX.replace('a', name))
}

/// Positions count up to |r₀| + |r₁|, whose digits cancel in the difference.
fn reach(nodes: &[Pose; 2]) -> f64 {
    1.0 + nodes[0].position.norm() + nodes[1].position.norm()
}

fn free_flyer(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/free_flyer.csv")?;
    let reason = "20 ε: two matrices A(P), 3 ε an entry as their roundings have either sign, multiplied to sums of \
                  three, of which the logarithm makes π/2 at most; then an exponential and a product";
    let quantity = |name| Quantity { name, rounding: 20.0, reason };
    let quantities = [
        quantity("strain κ̄ = rotation of the difference"),
        quantity("strain γ̄ = its translation, over 1 + |r₀| + |r₁|"),
        quantity("SE(3) element, rotation between the nodes"),
        quantity("SE(3) element, point between them, over 1 + |r₀| + |r₁|"),
        quantity("P ∘ exp δφ as matrix"),
        quantity("r + A V(ψ) v, over 1 + |r|"),
        quantity("increment between two states, rotation"),
    ];
    compare(checks, table.rows(), "range", quantities, |row| {
        let (nodes, reference) = (nodes(row)?, twist(row)?);
        let size = reach(&nodes);
        let at = basis(&[0.0, 1.0], row.number("u")?, 1.0);
        let strain = Se3::strain(&nodes, &at)?;
        let pose = Se3::pose(&nodes, &at)?;

        let given = Twist { translation: vector(row, "g_x g_y g_z")?, rotation: vector(row, "h_x h_y h_z")? };
        let (position, [q0, q1]) = (nodes[0].position, [place(row, 0)?.1, place(row, 1)?.1]);
        let [mut state, mut end] = [State::default(), State::default()];
        state.push(position, q0);
        end.push(nodes[1].position, q1);
        let between = end.increment_since(&state, 0);
        let translation = nodes[0].rotation * exp_se3(&given).1;
        state.add(0, &Increment { translation, rotation: given.rotation });
        let updated = &state.poses()[0];
        Ok((
            reference.rotation.norm(),
            [
                (strain.kappa - reference.rotation).norm(),
                (strain.gamma - reference.translation).norm() / size,
                entries(&pose.rotation, &matrix_of(row, "u")?, 1.0),
                (pose.position - vector(row, "u_x u_y u_z")?).norm() / size,
                entries(&updated.rotation, &matrix_of(row, "e")?, 1.0),
                (updated.position - vector(row, "e_x e_y e_z")?).norm() / (1.0 + position.norm()),
                (between.rotation - reference.rotation).norm(),
            ],
        ))
    })
}

/// ∂(γ̄, κ̄)/∂η_j for body increments η_j = (A_jᵀ δr_j, δφ_j).
fn free_flyer_tangents(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/free_flyer_tangents.csv")?;
    let reason =
        "50 ε: the twist carries 20 ε and its tangent's derivative is at most 2; 10 ε of the tangent's own";
    for argument in [0, 1] {
        let quantities = [
            Quantity { name: "∂γ̄/∂δr_j A_j", rounding: 50.0, reason },
            Quantity { name: "∂γ̄/∂δφ_j, over 1 + |r₀| + |r₁|", rounding: 50.0, reason },
            Quantity { name: "∂κ̄/∂δφ_j", rounding: 50.0, reason },
        ];
        let rows = table.select(&[("argument", ["0", "1"][argument])])?;
        compare(checks, rows, "range", quantities, |row| {
            let nodes = nodes(row)?;
            let d = strain_derivative::<2, Se3>(&nodes, &basis(&[0.0, 1.0], 0.5, 1.0))?;
            let (diagonal, coupling) = (matrix(row, DIAGONAL)?, matrix(row, COUPLING)?);
            let moved = d.gamma_translation[argument] * nodes[argument].rotation;
            Ok((
                d.strain.kappa.norm(),
                [
                    entries(&moved, &diagonal, 1.0),
                    entries(&d.gamma_rotation[argument], &coupling, 1.0) / reach(&nodes),
                    entries(&d.kappa_rotation[argument], &diagonal, 1.0),
                ],
            ))
        })?;
    }
    Ok(())
}
