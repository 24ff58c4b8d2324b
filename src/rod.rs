//! The elements of one rod, with degree and interpolation chosen once per rod; what they are given and what they fill.

mod elements;
mod quaternions;

use std::fmt::Debug;
use std::ops::Range;

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::element::{ElementForce, LineLoad, ReferencePoint, Stiffness, Stress};
use crate::fit;
use crate::inertia::Velocity;
use crate::interpolation::{HalfTurn, Increment, Pose, R12, Se3};
use crate::joint::Support;
use crate::linear_solver::{Condensed, Singular, Sparse};
use crate::scene::{InterpolationKind, NodeSpacing, QuadratureKind};
use crate::section::SectionInertia;
use crate::state::State;
pub use elements::Elements;

/// What does not change in a solve: the stiffness, the undeformed strains at the quadrature points of the internal
/// forces, and J at those of the line loads.
#[derive(Clone, Debug, PartialEq)]
pub struct RodProperties {
    /// The same all along the rod.
    pub stiffness: Stiffness,
    /// All points of element 0, then of element 1, ….
    pub points: Vec<ReferencePoint>,
    /// J at the points of the full rule, in the same order; empty where neither line loads nor inertia need it.
    pub full_jacobians: Vec<f64>,
    /// Mass and rotary inertia with m_ij of every element, N² numbers each; absent where none is needed.
    pub inertia: Option<RodInertia>,
}

/// The inertia of a rod, eq. (13).
#[derive(Clone, Debug, PartialEq)]
pub struct RodInertia {
    /// The same all along the rod.
    pub section: SectionInertia,
    /// m_ij = ∫ N_i N_j J dx of element 0, row by row, then of element 1, … [m].
    pub coefficients: Vec<f64>,
}

/// What a rod is asked to hold beside its stiffness.
#[derive(Clone, Copy, Debug, Default)]
pub struct Needs {
    /// J for line loads.
    pub line_loads: bool,
    /// The mass matrix.
    pub inertia: Option<SectionInertia>,
}

/// Sums over the nodes.
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

    pub(crate) fn scatter<const N: usize>(&mut self, first: usize, element: &ElementForce<N>) {
        for i in 0..N {
            self.force[first + i] += element.force[i];
            self.moment[first + i] += element.moment[i];
            self.force_scale[first + i] += element.force_scale[i];
            self.moment_scale[first + i] += element.moment_scale[i];
        }
    }
}

/// The velocity of nodes at the end of a step, and b = ∂u/∂u̇ of the step.
#[derive(Clone, Copy, Debug)]
pub struct StepVelocity<'a> {
    /// u.
    pub velocities: &'a [Velocity],
    /// b [s]; the pose increments are (δr, δφ) = b² diag(1, Y) δu̇.
    pub b: f64,
}

/// What acts on a rod, for its tangent; both lists in ascending order of the nodes.
#[derive(Clone, Copy, Debug)]
pub struct Applied<'a> {
    /// The sum of the line loads.
    pub line_load: &'a LineLoad,
    /// Whether any line load acts.
    pub line_loaded: bool,
    /// −∂(load rows)/∂q.
    pub tangents: &'a [(usize, Matrix6<f64>)],
    /// Held nodes.
    pub supports: &'a [Support],
    /// Force rows at the nodes of the rod.
    pub force: &'a [Vector3<f64>],
    /// In a time step the tangent is b² K + (M + b D) diag(1, Y⁻¹).
    pub step: Option<StepVelocity<'a>>,
}

/// Where the element tangents go.
pub enum Target<'a> {
    /// 6 unknowns a node.
    Chain(&'a mut Condensed),
    /// 7 unknowns a node, rows of node i from 7 i + `first_row`: (r, P) and the unit constraint (17).
    Quaternions {
        /// The system of the whole model.
        system: &'a mut Sparse,
        /// First row of this rod.
        first_row: usize,
    },
    /// Every element's blocks as they are, row by row.
    Blocks(&'a mut Vec<Matrix6<f64>>),
}

/// Takes m_ij [m] and ∫ N_i N_j ω J dx [m/s] of the nodes i and j of a rod.
pub type InertiaVisitor<'a> = dyn FnMut([usize; 2], f64, &Vector3<f64>) + 'a;

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

    /// The discrete reference at given poses, and what else is needed.
    fn properties(&self, poses: &[Pose], stiffness: Stiffness, needs: &Needs)
    -> Result<RodProperties, usize>;

    /// Adds internal forces and line loads to the rows from the node `first` on; writes the constitutive stresses.
    fn add_forces(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        line_load: Option<&LineLoad>,
        constitutive: &mut [Stress],
        first: usize,
        forces: &mut NodalForces,
    ) -> Result<(), usize>;

    /// Adds −M u̇ − fᵍʸʳ(u) of a rod with inertia to the rows from the node `first` on.
    fn add_inertia(
        &self,
        properties: &RodProperties,
        velocities: &[Velocity],
        accelerations: &[Velocity],
        first: usize,
        forces: &mut NodalForces,
    );

    /// Calls `visit` with m_ij [m] and ∫ N_i N_j ω J dx [m/s], of which M_ij and D_ij are made, for every pair of nodes
    /// of every element in the order of [`Target::Blocks`]; not at all without inertia.
    fn visit_inertia(&self, properties: &RodProperties, velocities: &[Velocity], visit: &mut InertiaVisitor);

    /// Σ f·u of the line loads [W].
    fn line_load_power(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        line_load: &LineLoad,
        velocities: &[Velocity],
    ) -> Result<f64, usize>;

    /// ½ uᵀ M u [J].
    fn kinetic_energy(&self, properties: &RodProperties, velocities: &[Velocity]) -> f64;

    /// ∫ W dξ, eq. (18), at given constitutive stresses [J].
    fn strain_energy(&self, properties: &RodProperties, constitutive: &[Stress]) -> f64;

    /// ∫ N_i J dx of every node [m].
    fn nodal_lengths(&self, properties: &RodProperties) -> Vec<f64>;

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

    /// The position at ξ ∈ [0, 1].
    fn position(&self, poses: &[Pose], xi: f64) -> Result<Vector3<f64>, HalfTurn>;

    /// At ξ ∈ [0, 1] the rotation, and δr (inertial) and δφ (body basis) for given increments of the nodes.
    fn pose_increment(
        &self,
        poses: &[Pose],
        increments: &[Increment],
        xi: f64,
    ) -> Result<(Matrix3<f64>, Increment), HalfTurn>;

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
