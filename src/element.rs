//! One element: internal force (11) and its tangent, line loads (12) and theirs.
//!
//! Forces are the sum of what acts *on* the nodes, f = fⁱⁿᵗ + fᵉˣᵗ as in eq. (16), rows (translation inertial,
//! rotation body); tangents are −∂f/∂q for nodal increments (δr, δφ), so that a Newton step solves K δq = f.
//! The force is no gradient and K is unsymmetric (Petrov–Galerkin).

mod tangent;

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::interpolation::{HalfTurn, HalfTurnIn, Increments, Interpolation, Nodes, Pose};
use crate::lagrange::Basis;
use crate::lanes::{LANES, Processor, Vector, Wide, cross, gather, norm, plus_scaled, scatter, sum};
use crate::linear_solver::NODE;
pub use tangent::{TangentScratch, internal_tangent};

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

/// The same of four elements, side by side.
#[derive(Clone, Copy, Debug)]
pub struct Forces<const N: usize> {
    /// Force rows.
    pub force: [Vector; N],
    /// Moment rows.
    pub moment: [Vector; N],
    /// Σ |contribution| of the force rows.
    pub force_scale: [Wide; N],
    /// Σ |contribution| of the moment rows.
    pub moment_scale: [Wide; N],
}

impl<const N: usize> Default for Forces<N> {
    fn default() -> Self {
        Self {
            force: [Vector::default(); N],
            moment: [Vector::default(); N],
            force_scale: [Wide::default(); N],
            moment_scale: [Wide::default(); N],
        }
    }
}

impl<const N: usize> Forces<N> {
    /// Those of a lane.
    #[inline(always)]
    pub fn of_lane(&self, lane: usize) -> ElementForce<N> {
        ElementForce {
            force: std::array::from_fn(|i| scatter(&self.force[i], lane)),
            moment: std::array::from_fn(|i| scatter(&self.moment[i], lane)),
            force_scale: self.force_scale.map(|x| x.0[lane]),
            moment_scale: self.moment_scale.map(|x| x.0[lane]),
        }
    }
}

/// Blocks K_ij = −∂f_i/∂(δr, δφ)_j.
pub type ElementTangent<const N: usize> = [[Matrix6<f64>; N]; N];

/// A tangent of zeros.
pub fn zero_tangent<const N: usize>() -> ElementTangent<N> {
    [[Matrix6::zeros(); N]; N]
}

/// A 6×6 matrix of four elements, column by column.
pub type Block = [[Wide; NODE]; NODE];

/// The tangents of four elements, side by side.
pub type Tangents<const N: usize> = [[Block; N]; N];

/// Tangents of zeros.
pub fn zero_tangents<const N: usize>() -> Tangents<N> {
    [[[[Wide::default(); NODE]; NODE]; N]; N]
}

/// Writes the block of a lane.
#[inline(always)]
pub fn write_lane_of_block(block: &Block, lane: usize, result: &mut Matrix6<f64>) {
    for (column, result) in block.iter().zip(&mut result.data.0) {
        for (x, result) in column.iter().zip(result) {
            *result = x.0[lane];
        }
    }
}

/// The tangent of a lane.
pub fn tangent_of_lane<const N: usize>(tangents: &Tangents<N>, lane: usize) -> ElementTangent<N> {
    let mut tangent = zero_tangent();
    for (block, result) in tangents.iter().flatten().zip(tangent.iter_mut().flatten()) {
        write_lane_of_block(block, lane, result);
    }
    tangent
}

/// Puts the tangent of a lane back.
pub fn set_tangent_of_lane<const N: usize>(
    tangents: &mut Tangents<N>,
    lane: usize,
    tangent: &ElementTangent<N>,
) {
    for (blocks, parts) in tangents.iter_mut().flatten().zip(tangent.iter().flatten()) {
        for (column, part) in blocks.iter_mut().zip(&parts.data.0) {
            for (x, part) in column.iter_mut().zip(part) {
                x.0[lane] = *part;
            }
        }
    }
}

/// Quadrature points of four elements: where those of each start among the points of the rod.
pub type Starts = [usize; LANES];

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

/// J, γ⁰, κ⁰ at a point of four elements.
#[inline(always)]
fn reference_at(points: &[ReferencePoint], starts: &Starts, q: usize) -> (Wide, Vector, Vector) {
    let of: [&ReferencePoint; LANES] = starts.map(|start| &points[start + q]);
    (Wide::gather(|lane| of[lane].jacobian), gather(|lane| &of[lane].gamma), gather(|lane| &of[lane].kappa))
}

/// n and m at a point of four elements.
#[inline(always)]
fn stress_at(stresses: &[Stress], starts: &Starts, q: usize) -> (Vector, Vector) {
    let of: [&Stress; LANES] = starts.map(|start| &stresses[start + q]);
    (gather(|lane| &of[lane].force), gather(|lane| &of[lane].moment))
}

#[inline(always)]
fn set_stress_at(stresses: &mut [Stress], starts: &Starts, q: usize, (force, moment): (&Vector, &Vector)) {
    for (lane, start) in starts.iter().enumerate() {
        stresses[start + q] = Stress { force: scatter(force, lane), moment: scatter(moment, lane) };
    }
}

/// The stiffnesses in all lanes.
#[inline(always)]
fn splat(stiffness: &Vector3<f64>) -> Vector {
    [stiffness.x, stiffness.y, stiffness.z].map(Wide::splat)
}

/// C (ε̄/J − ε⁰), eq. (18).
#[inline(always)]
fn law(
    processor: impl Processor,
    stiffness: &Vector,
    (strain, jacobian): (&Vector, Wide),
    reference: &Vector,
) -> Vector {
    let mut stress = *strain;
    for k in 0..3 {
        let strain = processor.divide(strain[k], jacobian);
        stress[k] = processor.multiply(stiffness[k], processor.subtract(strain, reference[k]));
    }
    stress
}

/// fⁱⁿᵗ, eq. (11), of four elements: f_r,i = −∫ N_i′ A n dx, f_φ,i = −∫ N_i′ m − N_i (γ̄ × n + κ̄ × m) dx;
/// writes the constitutive stress (18) at every quadrature point. `reference` and `stresses` are those of the rod.
#[inline(always)]
pub fn internal_force<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    nodes: &Nodes<N>,
    rule: &[Basis<N>],
    (reference, starts): (&[ReferencePoint], &Starts),
    stiffness: &Stiffness,
    stresses: &mut [Stress],
) -> Result<Forces<N>, HalfTurnIn> {
    let mut result = Forces::default();
    let [force_stiffness, moment_stiffness] = [&stiffness.force, &stiffness.moment].map(splat);
    for (q, basis) in rule.iter().enumerate() {
        let (strains, _) = I::point(processor, nodes, basis)?;
        let (jacobian, gamma, kappa) = reference_at(reference, starts, q);
        let n = law(processor, &force_stiffness, (&strains.gamma, jacobian), &gamma);
        let m = law(processor, &moment_stiffness, (&strains.kappa, jacobian), &kappa);
        set_stress_at(stresses, starts, q, (&n, &m));
        let force = strains.rotation.times_vector(processor, &n);
        let (by_force, by_moment) =
            (cross(processor, &strains.gamma, &n), cross(processor, &strains.kappa, &m));
        let couple = sum(processor, &by_force, &by_moment);
        let (force_norm, moment_norm) = (norm(processor, &force), norm(processor, &m));
        let couple_norm = norm(processor, &couple);
        for i in 0..N {
            let (value, slope) = (basis.weight * basis.value[i], basis.weight * basis.derivative[i]);
            result.force[i] = plus_scaled(processor, &result.force[i], -slope, &force);
            let moment = plus_scaled(processor, &result.moment[i], value, &couple);
            result.moment[i] = plus_scaled(processor, &moment, -slope, &m);
            let (value, slope) = (Wide::splat(value.abs()), Wide::splat(slope.abs()));
            result.force_scale[i] = processor.multiply_add(slope, force_norm, result.force_scale[i]);
            let scale = processor.multiply_add(slope, moment_norm, result.moment_scale[i]);
            result.moment_scale[i] = processor.multiply_add(value, couple_norm, scale);
        }
    }
    Ok(result)
}

/// s + C δε̄/J.
#[inline(always)]
fn advanced(
    processor: impl Processor,
    stress: &Vector,
    stiffness: &Vector,
    (change, jacobian): (&Vector, Wide),
) -> Vector {
    let mut result = *stress;
    for k in 0..3 {
        let change = processor.divide(change[k], jacobian);
        result[k] = processor.multiply_add(stiffness[k], change, stress[k]);
    }
    result
}

/// s ← ŝ(q) + C ε′(q) δq: the stress iterates of four elements after a step, with the old q.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
pub fn advance_stress<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    nodes: &Nodes<N>,
    rule: &[Basis<N>],
    (reference, starts): (&[ReferencePoint], &Starts),
    stiffness: &Stiffness,
    increments: &Increments<N>,
    constitutive: &[Stress],
    stresses: &mut [Stress],
) -> Result<(), HalfTurnIn> {
    let [force_stiffness, moment_stiffness] = [&stiffness.force, &stiffness.moment].map(splat);
    for (q, basis) in rule.iter().enumerate() {
        let (gamma, kappa) = I::strain_increment(processor, nodes, basis, increments)?;
        let (jacobian, ..) = reference_at(reference, starts, q);
        let (n, m) = stress_at(constitutive, starts, q);
        let n = advanced(processor, &n, &force_stiffness, (&gamma, jacobian));
        let m = advanced(processor, &m, &moment_stiffness, (&kappa, jacobian));
        set_stress_at(stresses, starts, q, (&n, &m));
    }
    Ok(())
}

/// Adds a 3×3 matrix to a 6×6 block.
#[inline]
fn add(block: &mut Matrix6<f64>, row: usize, column: usize, part: &Matrix3<f64>) {
    let mut view = block.fixed_view_mut::<3, 3>(row, column);
    view += part;
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
        let (mut force, mut moment) = (load.force, load.body_moment);
        if load.turns() {
            let rotation = I::strain(nodes, basis)?.rotation;
            force += rotation * load.body_force;
            moment += rotation.tr_mul(&load.moment);
        }
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
