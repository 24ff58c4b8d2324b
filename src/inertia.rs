//! Inertia of one element: mass matrix (13), gyroscopic forces (14), kinetic energy, and the tangent of an implicit
//! time step; what rods and rigid bodies share of it.
//!
//! Velocities are interpolated by the basis of the virtual displacements, eq. (9), so that M is constant. Its blocks
//! are M_ij = m_ij diag(A_ρ0 1, I_ρ0) with one number m_ij = ∫ N_i N_j J dx for every pair of nodes, and an element
//! stores no more than these.

use nalgebra::{Matrix3, Vector3};

use crate::element::{ElementForce, ElementTangent};
use crate::lagrange::Basis;
use crate::rotation::skew;
use crate::section::SectionInertia;

/// Velocity of a node or a body, or its time derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// v = ṙ [m/s], or v̇ [m/s²]; inertial basis.
    pub translation: Vector3<f64>,
    /// ω [rad/s], or ω̇ [rad/s²]; body basis.
    pub rotation: Vector3<f64>,
}

/// Y⁻¹ = 1 + ỹ + y yᵀ, y = b ω/2: turns the rotation δφ of an implicit step into the velocity's change,
/// δω = Y⁻¹ δφ/b.
///
/// The step ends where P₊ = P* + b Ṗ₊ up to a factor, and Ṗ₊ = ½ P₊ ∘ (0, ω) is eq. (10), so P₊ ∘ (1, −y) ∝ P*, and
/// multiplied from the right by the conjugate (1, y), P₊ ∝ P* ∘ (1, y). With P* fixed only (1, y) turns:
///
/// ```text
/// δφ = T((1, y)) (0, δy) = 2 (1 − ỹ) δy/(1 + |y|²) = b Y δω     Y = (1 − ỹ)/(1 + |y|²)     T of eq. (10)
/// (1 − ỹ)(1 + ỹ + y yᵀ) = 1 + y yᵀ − ỹ² = 1 + |y|²              ỹ y = 0, ỹ² = y yᵀ − |y|² 1
/// ```
#[inline(always)]
pub fn spin_from_turn(omega: &Vector3<f64>, b: f64) -> Matrix3<f64> {
    let y = omega * (0.5 * b);
    Matrix3::identity() + skew(&y) + y * y.transpose()
}

/// ω × (I ω) for I = diag(I₁, I₂, I₃).
#[inline(always)]
pub fn gyroscopic_moment(inertia: &Vector3<f64>, omega: &Vector3<f64>) -> Vector3<f64> {
    omega.cross(&inertia.component_mul(omega))
}

/// ∂(ω × I ω)/∂ω = ω̃ I − (I ω)~, multiplied out for I = diag(I₁, I₂, I₃).
///
/// Each entry has a difference of two inertias as its factor, as Euler's equations do; it is linear in ω.
///
/// ```text
///     ⎛     0        (I₃ − I₂) ω₃  (I₃ − I₂) ω₂ ⎞
///     ⎜ (I₁ − I₃) ω₃      0        (I₁ − I₃) ω₁ ⎟
///     ⎝ (I₂ − I₁) ω₂ (I₂ − I₁) ω₁       0       ⎠
/// ```
#[inline(always)]
pub fn gyroscopic_tangent(inertia: &Vector3<f64>, omega: &Vector3<f64>) -> Matrix3<f64> {
    let (x, y, z) = (inertia.z - inertia.y, inertia.x - inertia.z, inertia.y - inertia.x);
    Matrix3::new(0.0, x * omega.z, x * omega.y, y * omega.z, 0.0, y * omega.x, z * omega.y, z * omega.x, 0.0)
}

/// m_ij = ∫ N_i N_j J dx [m], symmetric; `jacobians` holds J at the points of `rule`.
#[inline]
pub fn mass_coefficients<const N: usize>(rule: &[Basis<N>], jacobians: &[f64]) -> [[f64; N]; N] {
    let mut mass = [[0.0; N]; N];
    for (basis, jacobian) in rule.iter().zip(jacobians) {
        for i in 0..N {
            let weighted = basis.weight * jacobian * basis.value[i];
            for j in 0..N {
                mass[i][j] += weighted * basis.value[j];
            }
        }
    }
    mass
}

/// ω(x) = Σ N_j ω_j, eq. (9).
#[inline(always)]
fn spin<const N: usize>(basis: &Basis<N>, velocities: &[Velocity; N]) -> Vector3<f64> {
    let mut sum = velocities[0].rotation * basis.value[0];
    for j in 1..N {
        sum += velocities[j].rotation * basis.value[j];
    }
    sum
}

/// Adds −M u̇ − fᵍʸʳ(u), eq. (13), (14), what the inertia does to the nodes:
/// f_r,i = −Σ m_ij A_ρ0 v̇_j, f_φ,i = −Σ m_ij I_ρ0 ω̇_j − ∫ N_i ω × (I_ρ0 ω) J dx.
///
/// The gyroscopic force stands on the side of M u̇: the sign printed in eq. (15) would not conserve the angular
/// momentum of a free rod.
#[inline(always)]
pub fn inertia_force<const N: usize>(
    rule: &[Basis<N>],
    jacobians: &[f64],
    mass: &[[f64; N]; N],
    section: &SectionInertia,
    velocities: &[Velocity; N],
    accelerations: &[Velocity; N],
    result: &mut ElementForce<N>,
) {
    for j in 0..N {
        let force = accelerations[j].translation * section.mass_per_length;
        let moment = section.rotary.component_mul(&accelerations[j].rotation);
        let (force_norm, moment_norm) = (force.norm(), moment.norm());
        for i in 0..N {
            result.force[i] -= mass[i][j] * force;
            result.moment[i] -= mass[i][j] * moment;
            result.force_scale[i] += mass[i][j].abs() * force_norm;
            result.moment_scale[i] += mass[i][j].abs() * moment_norm;
        }
    }
    for (basis, jacobian) in rule.iter().zip(jacobians) {
        let moment = gyroscopic_moment(&section.rotary, &spin(basis, velocities));
        let moment_norm = moment.norm();
        for i in 0..N {
            let value = basis.weight * jacobian * basis.value[i];
            result.moment[i] -= value * moment;
            result.moment_scale[i] += value.abs() * moment_norm;
        }
    }
}

/// Turns the tangent K of the forces into that of an implicit step, times b²:
/// b² K + (M + b D) diag(1, Y_j⁻¹), D_ij = ∂fᵍʸʳ_i/∂ω_j = ∫ N_i N_j (ω̃ I_ρ0 − (I_ρ0 ω)~) J dx.
///
/// The step ties accelerations and velocities to the new pose: δu̇ = δu/b, δv_j = δr_j/b, δω_j = Y_j⁻¹ δφ_j/b (see
/// [`spin_from_turn`]); `b` is in seconds. The matrix under the integral is linear in ω (see [`gyroscopic_tangent`]),
/// so that the vector ∫ N_i N_j ω J dx of a pair of nodes is all that has to be summed over the points.
#[inline(always)]
pub fn inertia_tangent<const N: usize>(
    rule: &[Basis<N>],
    jacobians: &[f64],
    mass: &[[f64; N]; N],
    section: &SectionInertia,
    velocities: &[Velocity; N],
    b: f64,
    tangent: &mut ElementTangent<N>,
) {
    // For i ≤ j only: it is symmetric.
    let mut spins = [[Vector3::zeros(); N]; N];
    for (basis, jacobian) in rule.iter().zip(jacobians) {
        let omega = spin(basis, velocities) * (basis.weight * jacobian * b);
        for i in 0..N {
            let weighted = omega * basis.value[i];
            for j in i..N {
                spins[i][j] += weighted * basis.value[j];
            }
        }
    }
    let square = b * b;
    for j in 0..N {
        let turn = spin_from_turn(&velocities[j].rotation, b);
        for i in 0..N {
            let mut rotary = gyroscopic_tangent(&section.rotary, &spins[i.min(j)][i.max(j)]);
            for k in 0..3 {
                rotary[(k, k)] += mass[i][j] * section.rotary[k];
            }
            let block = &mut tangent[i][j];
            *block *= square;
            for k in 0..3 {
                block[(k, k)] += mass[i][j] * section.mass_per_length;
            }
            let mut view = block.fixed_view_mut::<3, 3>(3, 3);
            view += rotary * turn;
        }
    }
}

/// ½ uᵀ M u [J] = ½ Σ m_ij (A_ρ0 v_i·v_j + ω_i·I_ρ0 ω_j).
#[inline]
pub fn kinetic_energy<const N: usize>(
    mass: &[[f64; N]; N],
    section: &SectionInertia,
    velocities: &[Velocity; N],
) -> f64 {
    let mut twice = 0.0;
    for j in 0..N {
        let momentum = velocities[j].translation * section.mass_per_length;
        let spin = section.rotary.component_mul(&velocities[j].rotation);
        for i in 0..N {
            let product = velocities[i].translation.dot(&momentum) + velocities[i].rotation.dot(&spin);
            twice += mass[i][j] * product;
        }
    }
    0.5 * twice
}
