//! One element: internal force (11) and its tangent, line loads (12) and theirs.
//!
//! Forces are the sum of what acts *on* the nodes, f = fⁱⁿᵗ + fᵉˣᵗ as in eq. (16), rows (translation inertial,
//! rotation body); tangents are −∂f/∂q for nodal increments (δr, δφ), so that a Newton step solves K δq = f.
//! The force is no gradient and K is unsymmetric (Petrov–Galerkin).

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::interpolation::{HalfTurn, Increment, Interpolation, Pose};
use crate::lagrange::Basis;
use crate::lanes::{Columns, Processor, lanes, product, times, vector};
use crate::linear_solver::NODE;

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
#[inline(always)]
pub fn internal_force<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    nodes: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    stresses: &mut [Stress],
    result: &mut ElementForce<N>,
) -> Result<(), HalfTurn> {
    for ((basis, reference), stress) in rule.iter().zip(reference).zip(stresses) {
        let (strain, _) = I::point(processor, nodes, basis)?;
        *stress = stiffness.stress(&vector(&strain.gamma), &vector(&strain.kappa), reference);
        let force = vector(&strain.rotation.times_vector(processor, &lanes(&stress.force)));
        let couple = vector(&strain.gamma).cross(&stress.force) + vector(&strain.kappa).cross(&stress.moment);
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

/// Writes the tangent of the internal force; the geometric part is built from the given `stresses`.
///
/// With δn = K_γ δγ̄/J, δm = K_κ δκ̄/J:
/// −δf_r,i = ∫ N_i′ (A δn + δA n), −δf_φ,i = ∫ N_i′ δm − N_i (γ̄ × δn − n × δγ̄ + κ̄ × δm − m × δκ̄).
///
/// With ∂γ̄/∂δr_j = N_j′ G, Γ_j = ∂γ̄/∂δφ_j, X_j = ∂κ̄/∂δφ_j, U = ñ − γ̄~ K_γ/J, V = m̃ − κ̄~ K_κ/J that is at a point
///
/// ```text
/// K_ij = ⎛ N_i′ N_j′ A K_γ/J G   N_i′ (A K_γ/J Γ_j + ∂(A n)/∂φ_j)        ⎞
///        ⎝ N_i  N_j′ U G         N_i′ K_κ/J X_j + N_i (U Γ_j + V X_j)    ⎠
/// ```
#[inline(always)]
pub fn internal_tangent<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    nodes: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    stresses: &[Stress],
    tangent: &mut ElementTangent<N>,
) -> Result<(), HalfTurn> {
    let mut first = true;
    for ((basis, reference), stress) in rule.iter().zip(reference).zip(stresses) {
        let (strain, point) = I::point(processor, nodes, basis)?;
        let scale = basis.weight / reference.jacobian;
        let (force_stiffness, moment_stiffness) = (stiffness.force * scale, stiffness.moment * scale);
        let force = lanes(&(stress.force * basis.weight));
        let moment = lanes(&(stress.moment * basis.weight));
        let rotated_stiffness = strain.rotation.times_diagonal(&force_stiffness);
        let from_gamma = Columns::skew(&force).plus_scaled(
            processor,
            -1.0,
            &Columns::skew(&strain.gamma).times_diagonal(&force_stiffness),
        );
        let from_kappa = Columns::skew(&moment).plus_scaled(
            processor,
            -1.0,
            &Columns::skew(&strain.kappa).times_diagonal(&moment_stiffness),
        );
        let moment_stiffness = lanes(&moment_stiffness);
        let force_r = rotated_stiffness.times(processor, &strain.gamma_translation);
        let couple_r = from_gamma.times(processor, &strain.gamma_translation);
        let by_translation = stacked(&force_r, &couple_r);
        for j in 0..N {
            let node = (j, &nodes[j], basis);
            let kappa = I::kappa_rotation(processor, &point, node);
            let [force_phi, couple_phi] =
                I::gamma_rotation(processor, &point, node, [&rotated_stiffness, &from_gamma]);
            let force_phi =
                force_phi.plus_scaled(processor, 1.0, &I::turned(processor, &point, node, &force));
            let p = stacked(&force_phi, &kappa.diagonal_times(&moment_stiffness));
            let couple_phi = couple_phi.plus_product(processor, &from_kappa, &kappa);
            let q = stacked(&couple_phi, &couple_phi);
            // Not N_i′ N_j′ first: its rounding, the same in every element, would hold a long rod like springs.
            let mut translation = by_translation;
            for column in &mut translation {
                *column = times(basis.derivative[j], column);
            }
            for i in 0..N {
                let (value, slope) = (basis.value[i], basis.derivative[i]);
                let by_row = [slope, slope, slope, value, value, value];
                let lower = [0.0, 0.0, 0.0, value, value, value];
                let block = columns(&mut tangent[i][j]);
                for c in 0..3 {
                    if first {
                        block[c] = product(&by_row, &translation[c]);
                        block[3 + c] = times(slope, &p[c]);
                    } else {
                        processor.add_products6(&mut block[c], &by_row, &translation[c]);
                        processor.add_scaled6(&mut block[3 + c], slope, &p[c]);
                    }
                    processor.add_products6(&mut block[3 + c], &lower, &q[c]);
                }
            }
        }
        first = false;
    }
    Ok(())
}

/// Three columns of a block from its upper and its lower half.
#[inline(always)]
fn stacked(upper: &Columns, lower: &Columns) -> [[f64; NODE]; 3] {
    let mut result = [[0.0; NODE]; 3];
    for c in 0..3 {
        let (u, l) = (&upper.0[c], &lower.0[c]);
        result[c] = [u[0], u[1], u[2], l[0], l[1], l[2]];
    }
    result
}

/// The columns of a block.
#[inline(always)]
pub(crate) fn columns(block: &mut Matrix6<f64>) -> &mut [[f64; NODE]; NODE] {
    &mut block.data.0
}

/// Adds a 3×3 matrix to a 6×6 block.
#[inline]
fn add(block: &mut Matrix6<f64>, row: usize, column: usize, part: &Matrix3<f64>) {
    let mut view = block.fixed_view_mut::<3, 3>(row, column);
    view += part;
}

/// s ← ŝ(q) + C ε′(q) δq: the stress iterate of the mixed iteration after a step, with the old q.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
pub fn advance_stress<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
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
        let (gamma, kappa) = I::strain_increment(processor, nodes, basis, increments)?;
        let inverse = 1.0 / reference.jacobian;
        stress.force = constitutive.force + stiffness.force.component_mul(&(vector(&gamma) * inverse));
        stress.moment = constitutive.moment + stiffness.moment.component_mul(&(vector(&kappa) * inverse));
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
