//! Nodes held by the ground: the residual on the manifold r = c − A s, δφ = P z, differentiated as a whole, against
//! the reduction Tᵀ K T with its geometric term.

use cosserat::element::{ElementForce, ElementTangent, ReferencePoint, Stress, zero_tangent};
use cosserat::interpolation::{Increment, Pose, R12};
use cosserat::joint::Support;
use cosserat::lagrange::basis_at_rule;
use cosserat::lanes::Plain;
use cosserat::quadrature::gauss_legendre;
use cosserat::rotation::rotation_matrix;
use cosserat::scene::{JointKind, NodeSpacing};
use nalgebra::{Matrix3, Vector3};
use num_dual::Dual64;

use super::forces::{STIFFNESS, compare_blocks, reference_point, stresses};
use super::{ROUNDING, ROUNDING_REASON};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{self, Ansatz, Rows, lift};
use crate::one_element::{internal_force, internal_tangent};
use crate::states::{ElementState, Generator, Worst, places};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new(
        "derivatives::support",
        "Tᵀ f on the held node's manifold, r = c − A s, δφ = P z",
        support,
    )]
}

/// Nodes of the quadratic element.
const N: usize = 3;

/// One element with a node that has turned since the start by what its joint leaves free.
struct HeldElement {
    state: ElementState<N>,
    held: usize,
    lever: Vector3<f64>,
    anchor: Vector3<f64>,
    /// P.
    free: Matrix3<f64>,
    reference: Vec<ReferencePoint>,
    support: Support,
}

impl HeldElement {
    fn new(kind: JointKind, held: usize, seed: u64) -> Self {
        let mut random = Generator::new(seed);
        let mut state = ElementState::<N>::new(&places(NodeSpacing::GaussLobatto), 1.1, seed);
        let (axis, lever) = (random.axis(), random.vector());
        let turned = rotation_matrix(&state.quaternions[held]);
        let (back, free) = match kind {
            JointKind::Rigid => (Matrix3::identity(), Matrix3::zeros()),
            JointKind::Spherical => (formulas::exp(&random.vector()), Matrix3::identity()),
            JointKind::Revolute => (formulas::exp(&(0.8 * axis)), axis * axis.transpose()),
        };
        let start = Pose { position: state.positions[held], rotation: turned * back };
        let anchor = start.position + start.rotation * lever;
        state.positions[held] = anchor - turned * lever;
        Self {
            state,
            held,
            lever,
            anchor,
            free,
            reference: [(); N - 1].map(|()| reference_point(&mut random)).to_vec(),
            // The axis of a joint may have any length.
            support: Support::new(held, kind, &start, anchor, 3.0 * (start.rotation * axis)),
        }
    }

    /// The residual on the manifold; what is held is written as the equation z = 0.
    fn residual(&self, increments: [Increment; N]) -> Rows<Dual64> {
        let (held, z) = (self.held, increments[self.held]);
        let mut allowed = increments;
        allowed[held] = Increment { translation: Vector3::zeros(), rotation: self.free * z.rotation };
        let mut nodes = self.state.moved(&allowed);
        nodes[held].position = lift(&self.anchor) - nodes[held].rotation * lift(&self.lever);
        let places = places::<N>(NodeSpacing::GaussLobatto);
        let quadrature = gauss_legendre(N - 1);
        let rule: Vec<(f64, f64)> = quadrature.points.into_iter().zip(quadrature.weights).collect();
        let at = |&(x, _): &(f64, f64)| formulas::point(Ansatz::Matrices, &places, &nodes, x);
        let points: Vec<_> = rule.iter().map(at).collect();
        let stresses = stresses(&points, &self.reference);
        let mut rows = formulas::internal_force(&places, &rule, &points, &stresses);
        let [f, m] = [0, 3].map(|k| Vector3::from_fn(|i, _| rows[held][k + i]));
        // Tᵀ f: the moment of f about the held point, whose arm −A s is taken in the inertial basis.
        let a = nodes[held].rotation;
        let arm = -(a * lift::<Dual64>(&self.lever));
        let moment = self.free.map(Dual64::from_re) * (m + a.transpose() * arm.cross(&f));
        let kept = z.rotation - self.free * z.rotation;
        for k in 0..3 {
            rows[held][k] = Dual64::new(0.0, -z.translation[k]);
            rows[held][3 + k] = moment[k] - Dual64::new(0.0, kept[k]);
        }
        rows
    }

    /// Force and tangent of the library before the reduction.
    fn internal(&self) -> Result<(ElementForce<N>, ElementTangent<N>), Box<dyn std::error::Error>> {
        let rule = basis_at_rule(&places::<N>(NodeSpacing::GaussLobatto), &gauss_legendre(N - 1));
        let (poses, reference) = (self.state.poses(), &self.reference);
        let mut stress = vec![Stress::default(); rule.len()];
        let (mut force, mut tangent) = (ElementForce::default(), zero_tangent::<N>());
        internal_force::<N, R12>(Plain, &poses, &rule, reference, &STIFFNESS, &mut stress, &mut force)?;
        internal_tangent::<N, R12>(Plain, &poses, &rule, reference, &STIFFNESS, &stress, &mut tangent)?;
        Ok((force, tangent))
    }

    /// r and δr for z, δφ = P z.
    fn compare_increment(&self, worst: &mut Worst, z: &Vector3<f64>) {
        let rotation = self.state.poses()[self.held].rotation;
        let step = self.support.increment(&rotation, z);
        let spun = self.state.moved(&std::array::from_fn(|_| Increment {
            translation: Vector3::zeros(),
            rotation: self.free * z,
        }));
        let place = lift(&self.anchor) - spun[self.held].rotation * lift::<Dual64>(&self.lever);
        worst.compare_against(step.translation.iter().copied(), place.iter().map(|x| x.eps), 1.0);
        worst.compare_against(step.rotation.iter().copied(), (self.free * z).iter().copied(), 1.0);
        let position = self.support.position(&rotation);
        worst.compare_against(position.iter().copied(), place.iter().map(|x| x.re), 1.0);
    }
}

fn support(checks: &mut Checks) -> Outcome {
    for kind in [JointKind::Rigid, JointKind::Spherical, JointKind::Revolute] {
        let [mut slopes, mut shared, mut free, mut increment] = [Worst::default(); 4];
        for (held, seed) in (0..N).flat_map(|held| (0..4).map(move |k| (held, 100 + k))) {
            let element = HeldElement::new(kind, held, seed);
            let support = &element.support;
            let (force, before) = element.internal()?;
            let rotation = element.state.poses()[held].rotation;
            let mut tangent = before;
            support.reduce(&mut tangent, held, &rotation, &force.force[held], true);
            compare_blocks(&mut slopes, &tangent, |increments| element.residual(increments));
            // A node shared by two elements: the second adds no term of the node itself.
            let (mut second, mut own) = (before, zero_tangent::<N>());
            support.reduce(&mut second, held, &rotation, &force.force[held], false);
            support.reduce(&mut own, held, &rotation, &force.force[held], true);
            let list = |k: &ElementTangent<N>| k.iter().flatten().flatten().copied().collect::<Vec<f64>>();
            let sum = list(&second).into_iter().zip(list(&own)).map(|(a, b)| a + b);
            shared.compare(sum, list(&tangent));
            let ours = support.free_moment(&rotation, &force.force[held], &force.moment[held]);
            let exact = element.residual([Increment::default(); N])[held];
            let scale = force.moment_scale[held] + force.force_scale[held];
            free.compare_against(ours.iter().copied(), [3, 4, 5].map(|k| exact[k].re), scale);
            element.compare_increment(&mut increment, &Generator::new(seed + 10).vector());
        }
        for (quantity, worst) in [
            ("tangent", slopes),
            ("tangent of a shared node", shared),
            ("equilibrium of what is free", free),
            ("compatible increment", increment),
        ] {
            let quantity = format!("{quantity}, {kind:?}");
            checks.below(Kind::Invariant, quantity, worst.0, ROUNDING, ROUNDING_REASON);
        }
    }
    Ok(())
}
