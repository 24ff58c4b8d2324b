//! Inertia of one element: mass matrix (13), gyroscopic forces (14), kinetic energy, and the tangent of an implicit
//! time step; what rods and rigid bodies share of it.
//!
//! Velocities are interpolated by the basis of the virtual displacements, eq. (9), so that M is constant. Its blocks
//! are M_ij = m_ij diag(A_ρ0 1, I_ρ0) with one number m_ij = ∫ N_i N_j J dx for every pair of nodes, and an element
//! stores no more than these.

use nalgebra::{Matrix3, Vector3};

use crate::element::{ElementForce, Tangents};
use crate::lagrange::Basis;
use crate::lanes::{LANES, Matrix, Processor, Vector, Wide, gather, plus_scaled, product, sum, times};
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

/// J at the points of the rule and m_ij of an element.
#[derive(Clone, Copy, Debug)]
pub struct ElementMass<'a, const N: usize> {
    /// J [m].
    pub jacobians: &'a [f64],
    /// m_ij [m].
    pub coefficients: &'a [[f64; N]; N],
}

/// Turns the tangents K of the forces on four elements into those of an implicit step, times b²:
/// b² K + (M + b D) diag(1, Y_j⁻¹), D_ij = ∂fᵍʸʳ_i/∂ω_j = ∫ N_i N_j (ω̃ I_ρ0 − (I_ρ0 ω)~) J dx.
///
/// The step ties accelerations and velocities to the new pose: δu̇ = δu/b, δv_j = δr_j/b, δω_j = Y_j⁻¹ δφ_j/b (see
/// [`spin_from_turn`]); `b` is in seconds. The matrix under the integral is linear in ω (see [`gyroscopic_tangent`]),
/// so that the vector ∫ N_i N_j ω J dx of a pair of nodes is all that has to be summed over the points.
#[inline(always)]
pub fn inertia_tangents<const N: usize>(
    processor: impl Processor,
    rule: &[Basis<N>],
    masses: &[ElementMass<N>; LANES],
    section: &SectionInertia,
    velocities: [&[Velocity; N]; LANES],
    b: f64,
    tangents: &mut Tangents<N>,
) {
    let omega: [Vector; N] = std::array::from_fn(|j| gather(|lane| &velocities[lane][j].rotation));
    // For i ≤ j only: it is symmetric.
    let mut spins = [[Vector::default(); N]; N];
    for (q, basis) in rule.iter().enumerate() {
        let jacobian = Wide::gather(|lane| masses[lane].jacobians[q]);
        let mut spin = times(processor, basis.value[0], &omega[0]);
        for j in 1..N {
            spin = plus_scaled(processor, &spin, basis.value[j], &omega[j]);
        }
        let spin = product(processor, &spin, &[processor.scale(basis.weight * b, jacobian); 3]);
        for i in 0..N {
            let weighted = times(processor, basis.value[i], &spin);
            for j in i..N {
                spins[i][j] = plus_scaled(processor, &spins[i][j], basis.value[j], &weighted);
            }
        }
    }
    let rotary = [section.rotary.x, section.rotary.y, section.rotary.z];
    let differences = [rotary[2] - rotary[1], rotary[0] - rotary[2], rotary[1] - rotary[0]];
    for j in 0..N {
        let turn = turn_by_spin(processor, &omega[j], b);
        for i in 0..N {
            let mass = Wide::gather(|lane| masses[lane].coefficients[i][j]);
            let [x, y, z] = spins[i.min(j)][i.max(j)];
            let [dx, dy, dz] = differences;
            let gyroscopic = Matrix([
                [processor.scale(rotary[0], mass), processor.scale(dy, z), processor.scale(dz, y)],
                [processor.scale(dx, z), processor.scale(rotary[1], mass), processor.scale(dz, x)],
                [processor.scale(dx, y), processor.scale(dy, x), processor.scale(rotary[2], mass)],
            ]);
            let change = gyroscopic.times(processor, &turn);
            let block = &mut tangents[i][j];
            for column in block.iter_mut() {
                for x in column {
                    *x = processor.scale(b * b, *x);
                }
            }
            for k in 0..3 {
                let density = Wide::splat(section.mass_per_length);
                block[k][k] = processor.multiply_add(density, mass, block[k][k]);
                for row in 0..3 {
                    block[3 + k][3 + row] = processor.add(block[3 + k][3 + row], change.0[k][row]);
                }
            }
        }
    }
}

/// [`spin_from_turn`] of four nodes.
#[inline(always)]
fn turn_by_spin(processor: impl Processor, omega: &Vector, b: f64) -> Matrix {
    let y = times(processor, 0.5 * b, omega);
    let mut turn = Matrix::skew(processor, &y);
    for k in 0..3 {
        turn.0[k][k] = Wide::splat(1.0);
        turn.0[k] = sum(processor, &turn.0[k], &product(processor, &y, &[y[k]; 3]));
    }
    turn
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
