//! The tangent of the internal force of four elements.

use super::{Block, ReferencePoint, Starts, Stiffness, Stress, Tangents, reference_at, splat, stress_at};
use crate::interpolation::{HalfTurnIn, Interpolation, Nodes, Strains};
use crate::lagrange::Basis;
use crate::lanes::{Matrix, Processor, Vector, Wide, product, times};

/// What the tangent takes from a point.
#[derive(Clone, Copy, Debug, Default)]
struct TangentPoint<P> {
    point: P,
    /// w n.
    force: Vector,
    /// w A K_γ/J.
    rotated_stiffness: Matrix,
    /// w U.
    from_gamma: Matrix,
    /// w V.
    from_kappa: Matrix,
    /// w K_κ/J.
    moment_stiffness: Vector,
    /// w A K_γ/J G.
    force_by_translation: Matrix,
    /// w U G.
    couple_by_translation: Matrix,
}

/// What a node j contributes at a point to the blocks K_ij of all i: rows by N_i′ and by N_i.
#[derive(Clone, Copy, Debug, Default)]
struct TangentColumns {
    /// N_j′ w A K_γ/J G.
    force_by_translation: Matrix,
    /// N_j′ w U G.
    couple_by_translation: Matrix,
    /// w (A K_γ/J Γ_j + ∂(A n)/∂φ_j).
    force_by_rotation: Matrix,
    /// w K_κ/J X_j.
    moment_by_rotation: Matrix,
    /// w (U Γ_j + V X_j).
    couple_by_rotation: Matrix,
}

/// Memory for [`internal_tangent`], for N points at a time.
#[derive(Clone, Debug)]
pub struct TangentScratch<const N: usize, P> {
    points: [TangentPoint<P>; N],
    columns: [TangentColumns; N],
}

impl<const N: usize, P: Copy + Default> Default for TangentScratch<N, P> {
    fn default() -> Self {
        Self { points: [TangentPoint::default(); N], columns: [TangentColumns::default(); N] }
    }
}

/// Writes the tangents of the internal force of four elements; the geometric part is built from the given `stresses`.
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
#[allow(clippy::too_many_arguments)]
#[inline(always)]
pub fn internal_tangent<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    nodes: &Nodes<N>,
    rule: &[Basis<N>],
    (reference, starts): (&[ReferencePoint], &Starts),
    stiffness: &Stiffness,
    stresses: &[Stress],
    scratch: &mut TangentScratch<N, I::Point>,
    tangents: &mut Tangents<N>,
) -> Result<(), HalfTurnIn> {
    for (pass, rule) in rule.chunks(N).enumerate() {
        for (q, (basis, place)) in rule.iter().zip(&mut scratch.points).enumerate() {
            let (strains, point) = I::point(processor, nodes, basis)?;
            let (jacobian, ..) = reference_at(reference, starts, pass * N + q);
            let stress = stress_at(stresses, starts, pass * N + q);
            write_point(processor, (&strains, point), basis.weight, jacobian, stiffness, &stress, place);
        }
        for j in 0..N {
            for ((basis, point), columns) in rule.iter().zip(&scratch.points).zip(&mut scratch.columns) {
                write_columns::<N, I>(processor, point, (j, nodes, basis), columns);
            }
            for i in 0..N {
                add_block(processor, i, rule, &scratch.columns, pass == 0, &mut tangents[i][j]);
            }
        }
    }
    Ok(())
}

/// s̃ − ε̃ diag(C).
#[inline(always)]
fn skew_less_stiffness(processor: impl Processor, s: &Vector, strain: &Vector, stiffness: &Vector) -> Matrix {
    let stiff = Matrix::skew(processor, strain).times_diagonal(processor, stiffness);
    Matrix::skew(processor, s).plus_scaled(processor, -1.0, &stiff)
}

// The large parts are written where they are kept: moved, they would be copied.

#[inline(always)]
fn write_point<P>(
    processor: impl Processor,
    (strains, point): (&Strains, P),
    weight: f64,
    jacobian: Wide,
    stiffness: &Stiffness,
    (n, m): &(Vector, Vector),
    at: &mut TangentPoint<P>,
) {
    let scale = processor.divide(Wide::splat(weight), jacobian);
    let force_stiffness = product(processor, &splat(&stiffness.force), &[scale; 3]);
    let moment_stiffness = product(processor, &splat(&stiffness.moment), &[scale; 3]);
    let (force, moment) = (times(processor, weight, n), times(processor, weight, m));
    let rotated_stiffness = strains.rotation.times_diagonal(processor, &force_stiffness);
    let from_gamma = skew_less_stiffness(processor, &force, &strains.gamma, &force_stiffness);
    at.point = point;
    at.force = force;
    at.moment_stiffness = moment_stiffness;
    at.force_by_translation = rotated_stiffness.times(processor, &strains.gamma_translation);
    at.couple_by_translation = from_gamma.times(processor, &strains.gamma_translation);
    at.rotated_stiffness = rotated_stiffness;
    at.from_gamma = from_gamma;
    at.from_kappa = skew_less_stiffness(processor, &moment, &strains.kappa, &moment_stiffness);
}

#[inline(always)]
fn write_columns<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    at: &TangentPoint<I::Point>,
    node: (usize, &Nodes<N>, &Basis<N>),
    columns: &mut TangentColumns,
) {
    let (j, _, basis) = node;
    // Not N_i′ N_j′ first: its rounding, the same in every element, would hold a long rod like springs.
    columns.force_by_translation = at.force_by_translation.scaled(processor, basis.derivative[j]);
    columns.couple_by_translation = at.couple_by_translation.scaled(processor, basis.derivative[j]);
    let kappa = I::kappa_rotation(processor, &at.point, node);
    columns.moment_by_rotation = kappa.diagonal_times(processor, &at.moment_stiffness);
    let [force, couple] =
        I::gamma_rotation(processor, &at.point, node, [&at.rotated_stiffness, &at.from_gamma]);
    columns.couple_by_rotation = couple.plus_product(processor, &at.from_kappa, &kappa);
    let turned = I::turned(processor, &at.point, node, &at.force);
    columns.force_by_rotation = force.plus_scaled(processor, 1.0, &turned);
}

#[inline(always)]
fn multiply_onto(processor: impl Processor, sum: &mut Wide, a: Wide, b: Wide) {
    *sum = processor.multiply_add(a, b, *sum);
}

/// Sums one block over points; `first` writes.
#[inline(always)]
fn add_block<const N: usize>(
    processor: impl Processor,
    i: usize,
    rule: &[Basis<N>],
    columns: &[TangentColumns; N],
    first: bool,
    block: &mut Block,
) {
    for c in 0..3 {
        let (mut by_translation, mut by_rotation) =
            if first { Default::default() } else { (block[c], block[3 + c]) };
        for (basis, part) in rule.iter().zip(columns) {
            let (value, slope) = (Wide::splat(basis.value[i]), Wide::splat(basis.derivative[i]));
            for r in 0..3 {
                multiply_onto(processor, &mut by_translation[r], slope, part.force_by_translation.0[c][r]);
                multiply_onto(
                    processor,
                    &mut by_translation[3 + r],
                    value,
                    part.couple_by_translation.0[c][r],
                );
                multiply_onto(processor, &mut by_rotation[r], slope, part.force_by_rotation.0[c][r]);
                multiply_onto(processor, &mut by_rotation[3 + r], slope, part.moment_by_rotation.0[c][r]);
                multiply_onto(processor, &mut by_rotation[3 + r], value, part.couple_by_rotation.0[c][r]);
            }
        }
        (block[c], block[3 + c]) = (by_translation, by_rotation);
    }
}
