//! A rod of equal elements at given nodal poses, without supports or loads: the kernels in a plain loop.

use cosserat::element::{ElementForce, ReferencePoint, Stiffness, Stress, zero_tangent};
use cosserat::interpolation::{HalfTurn, Interpolation, Pose};
use cosserat::lagrange::{Basis, basis_at_rule};
use cosserat::lanes::Plain;
use cosserat::quadrature::gauss_legendre;
use cosserat::scene::NodeSpacing;
use nalgebra::{DMatrix, Vector3};

use crate::one_element::{internal_force, internal_tangent};
use crate::states::places;
use crate::strains::strain_derivative;

/// Force and moment rows of every node with the largest sums of absolute contributions.
#[derive(Clone, Debug)]
pub struct NodeRows {
    pub force: Vec<Vector3<f64>>,
    pub moment: Vec<Vector3<f64>>,
    pub force_scale: f64,
    pub moment_scale: f64,
}

/// The mesh and the reference.
pub struct DiscreteRod<const N: usize> {
    pub elements: usize,
    pub rule: Vec<Basis<N>>,
    pub stiffness: Stiffness,
    reference: Vec<ReferencePoint>,
}

/// ξ of every node.
pub fn node_places<const N: usize>(elements: usize) -> Vec<f64> {
    let places = places::<N>(NodeSpacing::GaussLobatto);
    let inner = (0..elements).flat_map(|e| places[..N - 1].iter().map(move |x| e as f64 + x));
    inner.chain([elements as f64]).map(|x| x / elements as f64).collect()
}

impl<const N: usize> DiscreteRod<N> {
    /// With the p-point rule, undeformed at `poses`.
    pub fn new<I: Interpolation<N>>(poses: &[Pose], stiffness: Stiffness) -> Result<Self, HalfTurn> {
        let elements = (poses.len() - 1) / (N - 1);
        let rule = basis_at_rule(&places::<N>(NodeSpacing::GaussLobatto), &gauss_legendre(N - 1));
        let mut rod = Self { elements, rule, stiffness, reference: Vec::new() };
        for e in 0..elements {
            let nodes = rod.nodes(poses, e);
            for basis in &rod.rule {
                let strain = I::strain(&nodes, basis)?;
                // ‖r⁰′‖ from the centreline itself.
                let slope: Vector3<f64> = (0..N).map(|i| nodes[i].position * basis.derivative[i]).sum();
                let jacobian = slope.norm();
                rod.reference.push(ReferencePoint {
                    jacobian,
                    gamma: strain.gamma / jacobian,
                    kappa: strain.kappa / jacobian,
                });
            }
        }
        Ok(rod)
    }

    fn nodes(&self, poses: &[Pose], e: usize) -> [Pose; N] {
        std::array::from_fn(|i| poses[e * (N - 1) + i])
    }

    fn points(&self, e: usize) -> &[ReferencePoint] {
        &self.reference[e * self.rule.len()..][..self.rule.len()]
    }

    /// fⁱⁿᵗ, eq. (11).
    pub fn internal<I: Interpolation<N>>(&self, poses: &[Pose]) -> Result<NodeRows, HalfTurn> {
        let mut force = vec![Vector3::zeros(); poses.len()];
        let (mut moment, mut scales) = (force.clone(), vec![[0.0; 2]; poses.len()]);
        let mut stresses = vec![Stress::default(); self.rule.len()];
        for e in 0..self.elements {
            let nodes = self.nodes(poses, e);
            let mut rows = ElementForce::default();
            internal_force::<N, I>(
                Plain,
                &nodes,
                &self.rule,
                self.points(e),
                &self.stiffness,
                &mut stresses,
                &mut rows,
            )?;
            for i in 0..N {
                let node = e * (N - 1) + i;
                force[node] += rows.force[i];
                moment[node] += rows.moment[i];
                scales[node][0] += rows.force_scale[i];
                scales[node][1] += rows.moment_scale[i];
            }
        }
        let largest = |k: usize| scales.iter().map(|scale| scale[k]).fold(0.0, f64::max);
        Ok(NodeRows { force, moment, force_scale: largest(0), moment_scale: largest(1) })
    }

    /// −∂E/∂(δr, δφ) of the discrete energy E = Σ w J W.
    pub fn energy_gradient<I: Interpolation<N>>(
        &self,
        poses: &[Pose],
    ) -> Result<[Vec<Vector3<f64>>; 2], HalfTurn> {
        let mut force = vec![Vector3::zeros(); poses.len()];
        let mut moment = force.clone();
        for e in 0..self.elements {
            let nodes = self.nodes(poses, e);
            for (basis, reference) in self.rule.iter().zip(self.points(e)) {
                let d = strain_derivative::<N, I>(&nodes, basis)?;
                let stress = self.stiffness.stress(&d.strain.gamma, &d.strain.kappa, reference);
                for i in 0..N {
                    let node = e * (N - 1) + i;
                    force[node] -= d.gamma_translation[i].tr_mul(&stress.force) * basis.weight;
                    moment[node] -= (d.gamma_rotation[i].tr_mul(&stress.force)
                        + d.kappa_rotation[i].tr_mul(&stress.moment))
                        * basis.weight;
                }
            }
        }
        Ok([force, moment])
    }

    /// K = −∂fⁱⁿᵗ/∂(δr, δφ), six rows and columns a node.
    pub fn tangent<I: Interpolation<N>>(&self, poses: &[Pose]) -> Result<DMatrix<f64>, HalfTurn> {
        let mut result = DMatrix::zeros(6 * poses.len(), 6 * poses.len());
        let mut stresses = vec![Stress::default(); self.rule.len()];
        for e in 0..self.elements {
            let nodes = self.nodes(poses, e);
            let points = self.points(e);
            let mut unused = ElementForce::default();
            internal_force::<N, I>(
                Plain,
                &nodes,
                &self.rule,
                points,
                &self.stiffness,
                &mut stresses,
                &mut unused,
            )?;
            let mut tangent = zero_tangent::<N>();
            internal_tangent::<N, I>(
                Plain,
                &nodes,
                &self.rule,
                points,
                &self.stiffness,
                &stresses,
                &mut tangent,
            )?;
            for (i, row) in tangent.iter().enumerate() {
                for (j, block) in row.iter().enumerate() {
                    let place = [i, j].map(|node| 6 * (e * (N - 1) + node));
                    let mut view = result.fixed_view_mut::<6, 6>(place[0], place[1]);
                    view += block;
                }
            }
        }
        Ok(result)
    }
}
