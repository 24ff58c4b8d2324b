//! One element: internal force (11) and its tangent, line loads (12) and theirs.
//!
//! Forces are the sum of what acts *on* the nodes, f = fⁱⁿᵗ + fᵉˣᵗ as in eq. (16), rows (translation inertial,
//! rotation body); tangents are −∂f/∂q for nodal increments (δr, δφ), so that a Newton step solves K δq = f.
//! The force is no gradient and K is unsymmetric (Petrov–Galerkin).

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::interpolation::{HalfTurn, Increment, Interpolation, Pose};
use crate::lagrange::Basis;
use crate::rotation::skew;

/// Diagonal stiffness of a cross-section: K_γ = diag(EA, GA_y, GA_z) [N], K_κ = diag(GI_p, EI_y, EI_z) [N m²].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stiffness {
    /// Axial and shear stiffness [N].
    pub force: Vector3<f64>,
    /// Torsional and bending stiffness [N m²].
    pub moment: Vector3<f64>,
}

/// Stress resultants at a quadrature point, in the cross-section basis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stress {
    /// Contact force n [N].
    pub force: Vector3<f64>,
    /// Contact moment m [N m].
    pub moment: Vector3<f64>,
}

/// The undeformed rod at a quadrature point, from the discrete reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferencePoint {
    /// J = ‖r⁰′‖ per element coordinate [m].
    pub jacobian: f64,
    /// γ⁰.
    pub gamma: Vector3<f64>,
    /// κ⁰ [1/m].
    pub kappa: Vector3<f64>,
}

/// Nodal rows (force inertial [N], moment body [N m]) with the sums of absolute contributions before they cancel.
#[derive(Clone, Copy, Debug)]
pub struct ElementForce<const N: usize> {
    /// Force rows.
    pub force: [Vector3<f64>; N],
    /// Moment rows.
    pub moment: [Vector3<f64>; N],
    /// Σ |contribution| of the force rows.
    pub force_scale: [f64; N],
    /// Σ |contribution| of the moment rows.
    pub moment_scale: [f64; N],
}

impl<const N: usize> Default for ElementForce<N> {
    fn default() -> Self {
        Self {
            force: [Vector3::zeros(); N],
            moment: [Vector3::zeros(); N],
            force_scale: [0.0; N],
            moment_scale: [0.0; N],
        }
    }
}

/// Blocks K_ij = −∂f_i/∂(δr, δφ)_j.
pub type ElementTangent<const N: usize> = [[Matrix6<f64>; N]; N];

/// A tangent of zeros.
pub fn zero_tangent<const N: usize>() -> ElementTangent<N> {
    [[Matrix6::zeros(); N]; N]
}

impl Stiffness {
    /// n = K_γ (γ − γ⁰), m = K_κ (κ − κ⁰), eq. (18), from strains per element coordinate.
    #[inline]
    pub fn stress(&self, gamma: &Vector3<f64>, kappa: &Vector3<f64>, reference: &ReferencePoint) -> Stress {
        Stress {
            force: self.force.component_mul(&(gamma / reference.jacobian - reference.gamma)),
            moment: self.moment.component_mul(&(kappa / reference.jacobian - reference.kappa)),
        }
    }
}

/// Adds fⁱⁿᵗ, eq. (11): f_r,i = −∫ N_i′ A n dx, f_φ,i = −∫ N_i′ m − N_i (γ̄ × n + κ̄ × m) dx,
/// and writes the constitutive stress at every quadrature point.
#[inline]
pub fn internal_force<const N: usize, I: Interpolation<N>>(
    nodes: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    stresses: &mut [Stress],
    result: &mut ElementForce<N>,
) -> Result<(), HalfTurn> {
    for ((basis, reference), stress) in rule.iter().zip(reference).zip(stresses) {
        let strain = I::strain(nodes, basis)?;
        *stress = stiffness.stress(&strain.gamma, &strain.kappa, reference);
        let force = strain.rotation * stress.force;
        let couple = strain.gamma.cross(&stress.force) + strain.kappa.cross(&stress.moment);
        let (force_norm, moment_norm, couple_norm) = (force.norm(), stress.moment.norm(), couple.norm());
        for i in 0..N {
            let (value, slope) = (basis.weight * basis.value[i], basis.weight * basis.derivative[i]);
            result.force[i] -= slope * force;
            result.moment[i] += value * couple - slope * stress.moment;
            result.force_scale[i] += slope.abs() * force_norm;
            result.moment_scale[i] += slope.abs() * moment_norm + value.abs() * couple_norm;
        }
    }
    Ok(())
}

/// Adds the tangent of the internal force; the geometric part is built from the given `stresses`.
///
/// With δn = K_γ δγ̄/J, δm = K_κ δκ̄/J:
/// −δf_r,i = ∫ N_i′ (A δn + δA n), −δf_φ,i = ∫ N_i′ δm − N_i (γ̄ × δn − n × δγ̄ + κ̄ × δm − m × δκ̄).
#[inline]
pub fn internal_tangent<const N: usize, I: Interpolation<N>>(
    nodes: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    stresses: &[Stress],
    tangent: &mut ElementTangent<N>,
) -> Result<(), HalfTurn> {
    for ((basis, reference), stress) in rule.iter().zip(reference).zip(stresses) {
        let d = I::strain_derivative(nodes, basis)?;
        let turn = I::turn(nodes, basis)?;
        let scale = basis.weight / reference.jacobian;
        let force_stiffness = Matrix3::from_diagonal(&(stiffness.force * scale));
        let moment_stiffness = Matrix3::from_diagonal(&(stiffness.moment * scale));
        let rotated_stiffness = d.strain.rotation * force_stiffness;
        // Factors of N_i in the moment rows.
        let from_gamma = skew(&(stress.force * basis.weight)) - skew(&d.strain.gamma) * force_stiffness;
        let from_kappa = skew(&(stress.moment * basis.weight)) - skew(&d.strain.kappa) * moment_stiffness;
        let weighted_force = stress.force * basis.weight;
        for j in 0..N {
            let force_r = rotated_stiffness * d.gamma_translation[j];
            let force_phi = rotated_stiffness * d.gamma_rotation[j] + I::rotated(&turn, j, &weighted_force);
            let moment_phi = moment_stiffness * d.kappa_rotation[j];
            let couple_r = from_gamma * d.gamma_translation[j];
            let couple_phi = from_gamma * d.gamma_rotation[j] + from_kappa * d.kappa_rotation[j];
            for i in 0..N {
                let (value, slope) = (basis.value[i], basis.derivative[i]);
                let block = &mut tangent[i][j];
                add(block, 0, 0, &(force_r * slope));
                add(block, 0, 3, &(force_phi * slope));
                add(block, 3, 0, &(couple_r * value));
                add(block, 3, 3, &(moment_phi * slope + couple_phi * value));
            }
        }
    }
    Ok(())
}

/// Adds a 3×3 matrix to a 6×6 block.
#[inline]
fn add(block: &mut Matrix6<f64>, row: usize, column: usize, part: &Matrix3<f64>) {
    let mut view = block.fixed_view_mut::<3, 3>(row, column);
    view += part;
}

/// s ← ŝ(q) + C ε′(q) δq: the stress iterate of the mixed iteration after a step, with the old q.
#[inline]
pub fn advance_stress<const N: usize, I: Interpolation<N>>(
    nodes: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    increments: &[Increment; N],
    constitutive: &[Stress],
    stresses: &mut [Stress],
) -> Result<(), HalfTurn> {
    for (((basis, reference), constitutive), stress) in
        rule.iter().zip(reference).zip(constitutive).zip(stresses)
    {
        let (gamma, kappa) = I::strain_increment(nodes, basis, increments)?;
        stress.force = constitutive.force + stiffness.force.component_mul(&(gamma / reference.jacobian));
        stress.moment = constitutive.moment + stiffness.moment.component_mul(&(kappa / reference.jacobian));
    }
    Ok(())
}

/// Loads per reference length, in either basis; all constant along the rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineLoad {
    /// Force, inertial components [N/m].
    pub force: Vector3<f64>,
    /// Force, body components [N/m].
    pub body_force: Vector3<f64>,
    /// Moment, inertial components [N m/m].
    pub moment: Vector3<f64>,
    /// Moment, body components [N m/m].
    pub body_moment: Vector3<f64>,
}

impl LineLoad {
    /// Whether any part of it turns with the rod, or turns against it: then it has a tangent.
    pub fn turns(&self) -> bool {
        self.body_force != Vector3::zeros() || self.moment != Vector3::zeros()
    }
}

/// Adds fᵉˣᵗ, eq. (12): f_r,i = ∫ N_i (b + A b_K) J dx, f_φ,i = ∫ N_i (c_K + Aᵀ c) J dx.
///
/// `jacobians` holds J at the points of `rule`.
#[inline]
pub fn line_load_force<const N: usize, I: Interpolation<N>>(
    nodes: &[Pose; N],
    rule: &[Basis<N>],
    jacobians: &[f64],
    load: &LineLoad,
    result: &mut ElementForce<N>,
) -> Result<(), HalfTurn> {
    for (basis, jacobian) in rule.iter().zip(jacobians) {
        let rotation = I::strain(nodes, basis)?.rotation;
        let force = load.force + rotation * load.body_force;
        let moment = load.body_moment + rotation.tr_mul(&load.moment);
        let (force_norm, moment_norm) = (force.norm(), moment.norm());
        for i in 0..N {
            let value = basis.weight * jacobian * basis.value[i];
            result.force[i] += value * force;
            result.moment[i] += value * moment;
            result.force_scale[i] += value.abs() * force_norm;
            result.moment_scale[i] += value.abs() * moment_norm;
        }
    }
    Ok(())
}

/// Adds −∂fᵉˣᵗ/∂q; only what turns with the rod contributes.
#[inline]
pub fn line_load_tangent<const N: usize, I: Interpolation<N>>(
    nodes: &[Pose; N],
    rule: &[Basis<N>],
    jacobians: &[f64],
    load: &LineLoad,
    tangent: &mut ElementTangent<N>,
) -> Result<(), HalfTurn> {
    for (basis, jacobian) in rule.iter().zip(jacobians) {
        let turn = I::turn(nodes, basis)?;
        for j in 0..N {
            let force = I::rotated(&turn, j, &load.body_force);
            let moment = I::rotated_back(&turn, j, &load.moment);
            for i in 0..N {
                let value = -basis.weight * jacobian * basis.value[i];
                add(&mut tangent[i][j], 0, 3, &(force * value));
                add(&mut tangent[i][j], 3, 3, &(moment * value));
            }
        }
    }
    Ok(())
}
