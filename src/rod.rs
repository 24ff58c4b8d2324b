//! The elements of one rod: loops over the kernels, with degree and interpolation fixed once per rod.

use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::Range;

use nalgebra::{Matrix6, Vector3, Vector4};

use crate::element::{
    ElementForce, ElementTangent, LineLoad, ReferencePoint, Stiffness, Stress, advance_stress,
    internal_force, internal_tangent, line_load_force, line_load_tangent, zero_tangent,
};
use crate::fit;
use crate::interpolation::{HalfTurn, Increment, Interpolation, Pose, R12, Se3};
use crate::joint::Support;
use crate::lagrange::{Basis, basis, basis_at_rule, element_nodes};
use crate::linear_solver::{Chain, NODE, Singular, Sparse};
use crate::quadrature::gauss_legendre;
use crate::rotation::rotation_from_quaternion_rate;
use crate::scene::{InterpolationKind, NodeSpacing, QuadratureKind};
use crate::state::State;

/// What does not change in a solve: the stiffness, the undeformed strains at the quadrature points of the internal
/// forces, and J at those of the line loads.
#[derive(Clone, Debug, PartialEq)]
pub struct RodProperties {
    /// The same all along the rod.
    pub stiffness: Stiffness,
    /// All points of element 0, then of element 1, ….
    pub points: Vec<ReferencePoint>,
    /// J at the points of the line-load rule, in the same order; empty where no line load acts.
    pub load_jacobians: Vec<f64>,
}

/// Sums over a rod's nodes.
#[derive(Clone, Debug, Default)]
pub struct NodalForces {
    /// Force rows, inertial [N].
    pub force: Vec<Vector3<f64>>,
    /// Moment rows, body [N m].
    pub moment: Vec<Vector3<f64>>,
    /// Σ |contribution| of the force rows.
    pub force_scale: Vec<f64>,
    /// Σ |contribution| of the moment rows.
    pub moment_scale: Vec<f64>,
}

impl NodalForces {
    /// Zeros for `nodes` nodes.
    pub fn new(nodes: usize) -> Self {
        Self {
            force: vec![Vector3::zeros(); nodes],
            moment: vec![Vector3::zeros(); nodes],
            force_scale: vec![0.0; nodes],
            moment_scale: vec![0.0; nodes],
        }
    }

    /// All zero again.
    pub fn clear(&mut self) {
        self.force.fill(Vector3::zeros());
        self.moment.fill(Vector3::zeros());
        self.force_scale.fill(0.0);
        self.moment_scale.fill(0.0);
    }

    /// Adds a load's rows to a node.
    pub fn add(&mut self, node: usize, force: &Vector3<f64>, moment: &Vector3<f64>) {
        self.force[node] += force;
        self.moment[node] += moment;
        self.force_scale[node] += force.norm();
        self.moment_scale[node] += moment.norm();
    }

    fn scatter<const N: usize>(&mut self, first: usize, element: &ElementForce<N>) {
        for i in 0..N {
            self.force[first + i] += element.force[i];
            self.moment[first + i] += element.moment[i];
            self.force_scale[first + i] += element.force_scale[i];
            self.moment_scale[first + i] += element.moment_scale[i];
        }
    }
}

/// What acts on a rod, for its tangent; both lists in ascending order of the nodes.
#[derive(Clone, Copy, Debug)]
pub struct Applied<'a> {
    /// The sum of the line loads.
    pub line_load: &'a LineLoad,
    /// −∂(load rows)/∂q.
    pub tangents: &'a [(usize, Matrix6<f64>)],
    /// Held nodes.
    pub supports: &'a [Support],
    /// Force rows at the nodes of the rod.
    pub force: &'a [Vector3<f64>],
}

/// Where the element tangents go.
pub enum Target<'a> {
    /// 6 unknowns a node.
    Chain(&'a mut Chain),
    /// 7 unknowns a node, rows of node i from 7 i + `first_row`: (r, P) and the unit constraint (17).
    Quaternions {
        /// The system of the whole model.
        system: &'a mut Sparse,
        /// First row of this rod.
        first_row: usize,
    },
}

/// |Δξ| within which a point counts as a node.
pub const NODE_TOLERANCE: f64 = 1e-9;

/// Unknowns and rows of a node with its quaternion.
pub const QUATERNION_NODE: usize = 7;

/// Why the tangent of a rod could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentError {
    /// An element is turned by half a turn.
    HalfTurn(usize),
    /// An element's interior is singular.
    Singular,
}

impl From<Singular> for TangentError {
    fn from(_: Singular) -> Self {
        Self::Singular
    }
}

/// One rod's elements; an `Err` names the element whose nodes are half a turn apart.
pub trait RodElements: Debug + Send + Sync {
    /// Weights of the quadrature points of the internal forces in an element.
    fn weights(&self) -> Vec<f64>;

    /// The discrete reference at given poses; with `line_loads`, J for them, too.
    fn properties(
        &self,
        poses: &[Pose],
        stiffness: Stiffness,
        line_loads: bool,
    ) -> Result<RodProperties, usize>;

    /// Adds internal forces and line loads; writes the constitutive stresses.
    fn add_forces(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        line_load: &LineLoad,
        constitutive: &mut [Stress],
        forces: &mut NodalForces,
    ) -> Result<(), usize>;

    /// Hands every element's tangent to the target.
    fn assemble_tangent(
        &self,
        state: &State,
        nodes: Range<usize>,
        properties: &RodProperties,
        stresses: &[Stress],
        applied: &Applied,
        target: &mut Target,
    ) -> Result<(), TangentError>;

    /// s ← ŝ(q) + C ε′(q) δq at every quadrature point.
    fn advance_stresses(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        increments: &[Increment],
        constitutive: &[Stress],
        stresses: &mut [Stress],
    ) -> Result<(), usize>;

    /// The pose at ξ ∈ [0, 1].
    fn pose(&self, poses: &[Pose], xi: f64) -> Result<Pose, HalfTurn>;

    /// The element with the smallest det A at a quadrature point, and that determinant: 1 for a rotation, less
    /// where the interpolated matrix has shrunk because the nodes are turned far against each other.
    fn smallest_determinant(&self, poses: &[Pose]) -> (usize, f64);

    /// The element with the smallest stretch γ₁ at a quadrature point, and that stretch: 1 for an unstrained rod.
    fn smallest_stretch(&self, poses: &[Pose], properties: &RodProperties) -> (usize, f64);

    /// ξ of every node.
    fn node_positions(&self) -> Vec<f64>;

    /// Moves the nodes to the least-squares fit (21) of poses at evenly spaced ξ.
    fn fit(&self, state: &mut State, samples: &[Pose]) -> Result<fit::FitReport, fit::FitError>;
}

/// Elements of N nodes with interpolation I.
#[derive(Debug)]
pub struct Elements<const N: usize, I> {
    elements: usize,
    nodes: [f64; N],
    rule: Vec<Basis<N>>,
    load_rule: Vec<Basis<N>>,
    interpolation: PhantomData<I>,
}

/// ⌈(p + 1)²/2⌉ Gauss points: full quadrature, and everything but the internal forces.
pub fn full_points(degree: usize) -> usize {
    ((degree + 1) * (degree + 1)).div_ceil(2)
}

/// The elements of a validated rod; `None` for a degree or an interpolation that does not exist.
pub fn rod_elements(
    elements: usize,
    degree: usize,
    spacing: NodeSpacing,
    interpolation: InterpolationKind,
    quadrature: QuadratureKind,
) -> Option<Box<dyn RodElements>> {
    macro_rules! build {
        ($n:literal, $interpolation:ty) => {
            Elements::<$n, $interpolation>::boxed(elements, spacing, quadrature)
        };
    }
    match (interpolation, degree) {
        (InterpolationKind::Se3, 1) => build!(2, Se3),
        (InterpolationKind::R12, 1) => build!(2, R12),
        (InterpolationKind::R12, 2) => build!(3, R12),
        (InterpolationKind::R12, 3) => build!(4, R12),
        (InterpolationKind::R12, 4) => build!(5, R12),
        (InterpolationKind::R12, 5) => build!(6, R12),
        (InterpolationKind::R12, 6) => build!(7, R12),
        (InterpolationKind::R12, 7) => build!(8, R12),
        (InterpolationKind::R12, 8) => build!(9, R12),
        _ => None,
    }
}

impl<const N: usize, I> Elements<N, I>
where
    I: Interpolation<N> + Debug + Send + Sync + 'static,
{
    fn boxed(
        elements: usize,
        spacing: NodeSpacing,
        quadrature: QuadratureKind,
    ) -> Option<Box<dyn RodElements>> {
        let degree = N - 1;
        let nodes: [f64; N] = element_nodes(degree, spacing).try_into().ok()?;
        let points = match quadrature {
            QuadratureKind::Reduced => degree,
            QuadratureKind::Full => full_points(degree),
        };
        Some(Box::new(Self {
            elements,
            nodes,
            rule: basis_at_rule(&nodes, &gauss_legendre(points)),
            load_rule: basis_at_rule(&nodes, &gauss_legendre(full_points(degree))),
            interpolation: PhantomData::<I>,
        }))
    }

    /// The nodes of element e among those of the rod.
    #[inline]
    fn of<'a, T>(&self, e: usize, all: &'a [T]) -> &'a [T; N] {
        let first = e * (N - 1);
        all[first..first + N].first_chunk().unwrap_or_else(|| unreachable!("a slice of N has a chunk of N"))
    }

    /// Element and local coordinate of ξ.
    pub(crate) fn locate(&self, xi: f64) -> (usize, f64) {
        let place = xi.clamp(0.0, 1.0) * self.elements as f64;
        let e = (place.floor() as usize).min(self.elements - 1);
        (e, place - e as f64)
    }

    pub(crate) fn basis_at(&self, x: f64) -> Basis<N> {
        basis(&self.nodes, x, 1.0)
    }

    pub(crate) fn count(&self) -> usize {
        self.elements
    }

    /// Adds what acts at the nodes of element e and reduces its held nodes. A node shared by two elements is
    /// owned by the first.
    fn add_nodal_terms(&self, e: usize, poses: &[Pose], applied: &Applied, tangent: &mut ElementTangent<N>) {
        let first = e * (N - 1);
        let owned = |node: usize| e == 0 || node > first;
        let start = applied.tangents.partition_point(|(node, _)| *node < first);
        for (node, block) in applied.tangents[start..].iter().take_while(|(node, _)| *node < first + N) {
            if owned(*node) {
                tangent[node - first][node - first] += block;
            }
        }
        let start = applied.supports.partition_point(|support| support.node < first);
        for support in applied.supports[start..].iter().take_while(|support| support.node < first + N) {
            let node = support.node;
            support.reduce(tangent, node - first, &poses[node].rotation, &applied.force[node], owned(node));
        }
    }
}

impl<const N: usize, I> RodElements for Elements<N, I>
where
    I: Interpolation<N> + Debug + Send + Sync + 'static,
{
    fn weights(&self) -> Vec<f64> {
        self.rule.iter().map(|basis| basis.weight).collect()
    }

    fn properties(
        &self,
        poses: &[Pose],
        stiffness: Stiffness,
        line_loads: bool,
    ) -> Result<RodProperties, usize> {
        let mut result = RodProperties { stiffness, points: Vec::new(), load_jacobians: Vec::new() };
        for e in 0..self.elements {
            let nodes = self.of(e, poses);
            for basis in &self.rule {
                let strain = I::strain(nodes, basis).map_err(|_| e)?;
                // ‖r⁰′‖ = ‖A⁻ᵀ γ̄‖: A is not quite orthogonal between the nodes.
                let inverse = strain.rotation.transpose().try_inverse().ok_or(e)?;
                let jacobian = (inverse * strain.gamma).norm();
                if !(strain.rotation.determinant() > 1e-3 && jacobian > 0.0) {
                    return Err(e);
                }
                let (gamma, kappa) = (strain.gamma / jacobian, strain.kappa / jacobian);
                result.points.push(ReferencePoint { jacobian, gamma, kappa });
            }
            for basis in self.load_rule.iter().filter(|_| line_loads) {
                let strain = I::strain(nodes, basis).map_err(|_| e)?;
                let inverse = strain.rotation.transpose().try_inverse().ok_or(e)?;
                result.load_jacobians.push((inverse * strain.gamma).norm());
            }
        }
        Ok(result)
    }

    fn add_forces(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        line_load: &LineLoad,
        constitutive: &mut [Stress],
        forces: &mut NodalForces,
    ) -> Result<(), usize> {
        let (q, lq) = (self.rule.len(), self.load_rule.len());
        let loaded = !properties.load_jacobians.is_empty();
        for e in 0..self.elements {
            let nodes = self.of(e, poses);
            let mut element = ElementForce::default();
            let (points, stresses) = (&properties.points[e * q..][..q], &mut constitutive[e * q..][..q]);
            internal_force::<N, I>(nodes, &self.rule, points, &properties.stiffness, stresses, &mut element)
                .map_err(|_| e)?;
            if loaded {
                let jacobians = &properties.load_jacobians[e * lq..][..lq];
                line_load_force::<N, I>(nodes, &self.load_rule, jacobians, line_load, &mut element)
                    .map_err(|_| e)?;
            }
            forces.scatter(e * (N - 1), &element);
        }
        Ok(())
    }

    fn assemble_tangent(
        &self,
        state: &State,
        range: Range<usize>,
        properties: &RodProperties,
        stresses: &[Stress],
        applied: &Applied,
        target: &mut Target,
    ) -> Result<(), TangentError> {
        let (q, lq) = (self.rule.len(), self.load_rule.len());
        let poses = &state.poses()[range.clone()];
        let loaded = !properties.load_jacobians.is_empty() && applied.line_load.turns();
        for e in 0..self.elements {
            let nodes = self.of(e, poses);
            let mut tangent = zero_tangent::<N>();
            let (points, stresses) = (&properties.points[e * q..][..q], &stresses[e * q..][..q]);
            internal_tangent::<N, I>(
                nodes,
                &self.rule,
                points,
                &properties.stiffness,
                stresses,
                &mut tangent,
            )
            .map_err(|_| TangentError::HalfTurn(e))?;
            if loaded {
                let jacobians = &properties.load_jacobians[e * lq..][..lq];
                line_load_tangent::<N, I>(nodes, &self.load_rule, jacobians, applied.line_load, &mut tangent)
                    .map_err(|_| TangentError::HalfTurn(e))?;
            }
            self.add_nodal_terms(e, poses, applied, &mut tangent);
            match target {
                Target::Chain(chain) => chain.add_element(e, &tangent)?,
                Target::Quaternions { system, first_row } => {
                    let first = e * (N - 1);
                    let quaternions = &state.quaternions()[range.clone()];
                    add_quaternion_element(system, *first_row + QUATERNION_NODE * first, &tangent, |i| {
                        &quaternions[first + i]
                    });
                }
            }
        }
        Ok(())
    }

    fn advance_stresses(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        increments: &[Increment],
        constitutive: &[Stress],
        stresses: &mut [Stress],
    ) -> Result<(), usize> {
        let q = self.rule.len();
        for e in 0..self.elements {
            let points = e * q..(e + 1) * q;
            advance_stress::<N, I>(
                self.of(e, poses),
                &self.rule,
                &properties.points[points.clone()],
                &properties.stiffness,
                self.of(e, increments),
                &constitutive[points.clone()],
                &mut stresses[points],
            )
            .map_err(|_| e)?;
        }
        Ok(())
    }

    fn pose(&self, poses: &[Pose], xi: f64) -> Result<Pose, HalfTurn> {
        let (e, x) = self.locate(xi);
        // At a node the pose is the node's own, to the last digit.
        if let Some(i) =
            self.nodes.iter().position(|node| (node - x).abs() <= NODE_TOLERANCE * self.elements as f64)
        {
            return Ok(poses[e * (N - 1) + i]);
        }
        I::pose(self.of(e, poses), &self.basis_at(x))
    }

    fn smallest_determinant(&self, poses: &[Pose]) -> (usize, f64) {
        let mut smallest = (0, 1.0);
        for e in 0..self.elements {
            for basis in &self.rule {
                let determinant =
                    I::strain(self.of(e, poses), basis).map_or(0.0, |s| s.rotation.determinant());
                if determinant < smallest.1 {
                    smallest = (e, determinant);
                }
            }
        }
        smallest
    }

    fn smallest_stretch(&self, poses: &[Pose], properties: &RodProperties) -> (usize, f64) {
        let mut smallest = (0, f64::INFINITY);
        for (e, points) in properties.points.chunks_exact(self.rule.len()).enumerate() {
            for (basis, reference) in self.rule.iter().zip(points) {
                let stretch =
                    I::strain(self.of(e, poses), basis).map_or(1.0, |s| s.gamma.x / reference.jacobian);
                if stretch < smallest.1 {
                    smallest = (e, stretch);
                }
            }
        }
        smallest
    }

    fn node_positions(&self) -> Vec<f64> {
        let last = self.elements * (N - 1);
        (0..=last)
            .map(|node| {
                let e = (node / (N - 1)).min(self.elements - 1);
                (e as f64 + self.nodes[node - e * (N - 1)]) / self.elements as f64
            })
            .collect()
    }

    fn fit(&self, state: &mut State, samples: &[Pose]) -> Result<fit::FitReport, fit::FitError> {
        fit::fit::<N, I>(self, state, samples)
    }
}

/// Columns (r, P) by δφ = T(P) δP, eq. (10); rows as they are. The unit constraint is added per node elsewhere.
fn add_quaternion_element<'a, const N: usize>(
    system: &mut Sparse,
    first: usize,
    tangent: &ElementTangent<N>,
    quaternion: impl Fn(usize) -> &'a Vector4<f64>,
) {
    for j in 0..N {
        let rate = rotation_from_quaternion_rate(quaternion(j));
        for (i, row) in tangent.iter().enumerate() {
            let turned = row[j].fixed_view::<6, 3>(0, 3) * rate;
            for r in 0..NODE {
                let row_index = first + QUATERNION_NODE * i + r;
                let column = first + QUATERNION_NODE * j;
                for c in 0..3 {
                    system.add(row_index, column + c, row[j][(r, c)]);
                }
                for c in 0..4 {
                    system.add(row_index, column + 3 + c, turned[(r, c)]);
                }
            }
        }
    }
}
