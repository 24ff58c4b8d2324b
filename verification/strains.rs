//! The strains at a point with their derivatives as plain matrices.

use cosserat::interpolation::{HalfTurn, Increment, Increments, Interpolation, Nodes, Pose, Strain};
use cosserat::lagrange::Basis;
use cosserat::lanes::{LANES, Matrix, Plain, scatter};
use nalgebra::{Matrix3, Vector3};

use crate::one_element::LANE;

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
    let nodes = Nodes::new([nodes; LANES]);
    let (strains, point) = I::point(Plain, &nodes, basis).map_err(|_| HalfTurn)?;
    let identity = Matrix3::identity();
    let one = Matrix::gather(|_| &identity);
    let node = |j: usize| (j, &nodes, basis);
    Ok(StrainDerivative {
        strain: Strain {
            rotation: strains.rotation.scatter(LANE),
            gamma: scatter(&strains.gamma, LANE),
            kappa: scatter(&strains.kappa, LANE),
        },
        gamma_translation: std::array::from_fn(|j| {
            strains.gamma_translation.scatter(LANE) * basis.derivative[j]
        }),
        gamma_rotation: std::array::from_fn(|j| {
            I::gamma_rotation(Plain, &point, node(j), [&one])[0].scatter(LANE)
        }),
        kappa_rotation: std::array::from_fn(|j| I::kappa_rotation(Plain, &point, node(j)).scatter(LANE)),
    })
}

/// (δγ̄, δκ̄).
pub fn strain_increment<const N: usize, I: Interpolation<N>>(
    nodes: &[Pose; N],
    basis: &Basis<N>,
    increments: &[Increment; N],
) -> Result<[Vector3<f64>; 2], HalfTurn> {
    let (nodes, increments) = (Nodes::new([nodes; LANES]), Increments::new([increments; LANES]));
    let (gamma, kappa) = I::strain_increment(Plain, &nodes, basis, &increments).map_err(|_| HalfTurn)?;
    Ok([gamma, kappa].map(|v| scatter(&v, LANE)))
}
