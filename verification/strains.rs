//! The strains at a point with their derivatives as plain matrices.

use cosserat::interpolation::{HalfTurn, Interpolation, Pose, Strain};
use cosserat::lagrange::Basis;
use cosserat::lanes::{Columns, Plain, vector};
use nalgebra::Matrix3;

/// What a kernel builds its tangent from.
pub struct StrainDerivative<const N: usize> {
    pub strain: Strain,
    /// ∂γ̄/∂δr_j.
    pub gamma_translation: [Matrix3<f64>; N],
    /// ∂γ̄/∂δφ_j.
    pub gamma_rotation: [Matrix3<f64>; N],
    /// ∂κ̄/∂δφ_j.
    pub kappa_rotation: [Matrix3<f64>; N],
}

pub fn strain_derivative<const N: usize, I: Interpolation<N>>(
    nodes: &[Pose; N],
    basis: &Basis<N>,
) -> Result<StrainDerivative<N>, HalfTurn> {
    let (strain, point) = I::point(Plain, nodes, basis)?;
    let one = Columns::from(&Matrix3::identity());
    let node = |j: usize| (j, &nodes[j], basis);
    Ok(StrainDerivative {
        strain: Strain {
            rotation: strain.rotation.into(),
            gamma: vector(&strain.gamma),
            kappa: vector(&strain.kappa),
        },
        gamma_translation: std::array::from_fn(|j| {
            Matrix3::from(strain.gamma_translation) * basis.derivative[j]
        }),
        gamma_rotation: std::array::from_fn(|j| I::gamma_rotation(Plain, &point, node(j), [&one])[0].into()),
        kappa_rotation: std::array::from_fn(|j| I::kappa_rotation(Plain, &point, node(j)).into()),
    })
}
