//! Loops over the elements of one rod, for N nodes an element and one interpolation.

use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::Range;

use nalgebra::{Matrix3, Matrix6, Vector3};

use super::quaternions::add_quaternion_element;
use super::{
    Applied, InertiaVisitor, NODE_TOLERANCE, Needs, NodalForces, QUATERNION_NODE, RodElements, RodInertia,
    RodProperties, StepVelocity, TangentError, Target, full_points,
};
use crate::element::{
    ElementForce, ElementTangent, LineLoad, ReferencePoint, Stiffness, Stress, TangentScratch, Tangents,
    advance_stress, internal_force, internal_tangent, line_load_force, line_load_tangent,
    set_tangent_of_lane, tangent_of_lane, zero_tangents,
};
use crate::fit;
use crate::inertia::{
    ElementMass, Velocity, inertia_force, inertia_tangents, kinetic_energy, mass_coefficients,
};
use crate::interpolation::{HalfTurn, HalfTurnIn, Increment, Increments, Interpolation, Nodes, Pose};
use crate::joint::Support;
use crate::lagrange::{Basis, basis, basis_at_rule, element_nodes};
use crate::lanes::{LANES, Processor, scatter, widest};
use crate::quadrature::gauss_legendre;
use crate::scene::{NodeSpacing, QuadratureKind};
use crate::state::State;

/// Elements of N nodes with interpolation I.
#[derive(Debug)]
pub struct Elements<const N: usize, I> {
    elements: usize,
    nodes: [f64; N],
    rule: Vec<Basis<N>>,
    full_rule: Vec<Basis<N>>,
    interpolation: PhantomData<I>,
}

impl<const N: usize, I> Elements<N, I>
where
    I: Interpolation<N> + Debug + Send + Sync + 'static,
{
    pub(super) fn boxed(
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
            full_rule: basis_at_rule(&nodes, &gauss_legendre(full_points(degree))),
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

    /// The node of the rod that lies at x of element e.
    fn node_at(&self, e: usize, x: f64) -> Option<usize> {
        let near = |node: &f64| (node - x).abs() <= NODE_TOLERANCE * self.elements as f64;
        Some(e * (N - 1) + self.nodes.iter().position(near)?)
    }

    /// J at the full rule's points of element e and m_ij.
    fn mass_of<'a>(
        &self,
        e: usize,
        properties: &'a RodProperties,
        inertia: &'a RodInertia,
    ) -> ElementMass<'a, N> {
        let points = self.full_rule.len();
        let rows = inertia.coefficients[e * N * N..][..N * N].as_chunks::<N>().0;
        let coefficients = rows.first_chunk().unwrap_or_else(|| unreachable!("N rows of N"));
        ElementMass { jacobians: &properties.full_jacobians[e * points..][..points], coefficients }
    }

    /// The elements of a group of four, in order; the last group repeats the last element.
    fn group(&self, group: usize) -> [usize; LANES] {
        std::array::from_fn(|lane| (group * LANES + lane).min(self.elements - 1))
    }

    /// Lanes of a group that are elements of their own.
    fn lanes(&self, group: usize) -> usize {
        (self.elements - group * LANES).min(LANES)
    }

    /// A node shared by two elements is owned by the first.
    fn owned(e: usize, node: usize) -> bool {
        e == 0 || node > e * (N - 1)
    }

    /// Adds the tangents of the loads at the nodes of element e.
    fn add_loads(&self, e: usize, applied: &Applied, tangent: &mut ElementTangent<N>) {
        let first = e * (N - 1);
        for (node, block) in loaded(applied, first, N) {
            if Self::owned(e, *node) {
                tangent[node - first][node - first] += block;
            }
        }
    }

    /// Reduces the held nodes of element e.
    fn hold(&self, e: usize, poses: &[Pose], applied: &Applied, tangent: &mut ElementTangent<N>) {
        let first = e * (N - 1);
        for support in held(applied, first, N) {
            let node = support.node;
            let owner = Self::owned(e, node);
            support.reduce(tangent, node - first, &poses[node].rotation, &applied.force[node], owner);
        }
    }

    /// K → b² K + (M + b D) diag(1, Y⁻¹); without inertia b² K.
    #[inline(always)]
    fn add_step(
        &self,
        processor: impl Processor,
        elements: &[usize; LANES],
        properties: &RodProperties,
        step: &StepVelocity,
        tangents: &mut Tangents<N>,
    ) {
        let Some(inertia) = &properties.inertia else {
            for column in tangents.iter_mut().flatten().flatten() {
                for x in column {
                    *x = processor.scale(step.b * step.b, *x);
                }
            }
            return;
        };
        inertia_tangents::<N>(
            processor,
            &self.full_rule,
            &elements.map(|e| self.mass_of(e, properties, inertia)),
            &inertia.section,
            elements.map(|e| self.of(e, step.velocities)),
            step.b,
            tangents,
        );
    }

    /// The tangents of four elements with all that acts on them.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    fn tangents_of(
        &self,
        processor: impl Processor,
        elements: &[usize; LANES],
        poses: &[Pose],
        properties: &RodProperties,
        stresses: &[Stress],
        applied: &Applied,
        scratch: &mut TangentScratch<N, I::Point>,
        tangents: &mut Tangents<N>,
    ) -> Result<(), TangentError> {
        internal_tangent::<N, I>(
            processor,
            &Nodes::new(elements.map(|e| self.of(e, poses))),
            &self.rule,
            (&properties.points, &elements.map(|e| e * self.rule.len())),
            &properties.stiffness,
            stresses,
            scratch,
            tangents,
        )
        .map_err(|HalfTurnIn(lane)| TangentError::HalfTurn(elements[lane]))?;
        // Loads come before the step's inertia, supports after it.
        let turning = applied.line_loaded && applied.line_load.turns();
        for (lane, &e) in elements.iter().enumerate() {
            if turning || loaded(applied, e * (N - 1), N).next().is_some() {
                self.load_lane(lane, e, poses, properties, applied, tangents)?;
            }
        }
        if let Some(step) = &applied.step {
            self.add_step(processor, elements, properties, step, tangents);
        }
        for (lane, &e) in elements.iter().enumerate() {
            if held(applied, e * (N - 1), N).next().is_some() {
                let mut tangent = tangent_of_lane(tangents, lane);
                self.hold(e, poses, applied, &mut tangent);
                set_tangent_of_lane(tangents, lane, &tangent);
            }
        }
        Ok(())
    }

    /// Adds the tangents of the loads on the element of a lane.
    #[inline(never)]
    fn load_lane(
        &self,
        lane: usize,
        e: usize,
        poses: &[Pose],
        properties: &RodProperties,
        applied: &Applied,
        tangents: &mut Tangents<N>,
    ) -> Result<(), TangentError> {
        let mut tangent = tangent_of_lane(tangents, lane);
        if applied.line_loaded && applied.line_load.turns() {
            let points = self.full_rule.len();
            let jacobians = &properties.full_jacobians[e * points..][..points];
            line_load_tangent::<N, I>(
                self.of(e, poses),
                &self.full_rule,
                jacobians,
                applied.line_load,
                &mut tangent,
            )
            .map_err(|_| TangentError::HalfTurn(e))?;
        }
        self.add_loads(e, applied, &mut tangent);
        set_tangent_of_lane(tangents, lane, &tangent);
        Ok(())
    }

    /// [`RodElements::assemble_tangent`].
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    fn assemble_tangent_by(
        &self,
        processor: impl Processor,
        state: &State,
        range: Range<usize>,
        properties: &RodProperties,
        stresses: &[Stress],
        applied: &Applied,
        target: &mut Target,
    ) -> Result<(), TangentError> {
        let poses = &state.poses()[range.clone()];
        let mut tangents = zero_tangents::<N>();
        let mut scratch = TangentScratch::default();
        if let Target::Chain(chain) = target {
            chain.begin();
        }
        let mut group = 0;
        while group * LANES < self.elements {
            let elements = match target {
                Target::Chain(chain) => chain.group(group),
                Target::Quaternions { .. } | Target::Blocks(_) => self.group(group),
            };
            self.tangents_of(
                processor,
                &elements,
                poses,
                properties,
                stresses,
                applied,
                &mut scratch,
                &mut tangents,
            )?;
            match target {
                Target::Chain(chain) => {
                    if !chain.add(processor, group, &mut tangents)? {
                        group = 0;
                        continue;
                    }
                }
                Target::Quaternions { system, first_row } => {
                    let quaternions = &state.quaternions()[range.clone()];
                    for (lane, &e) in elements.iter().enumerate().take(self.lanes(group)) {
                        let first = e * (N - 1);
                        let tangent = tangent_of_lane(&tangents, lane);
                        let row = *first_row + QUATERNION_NODE * first;
                        add_quaternion_element(system, row, &tangent, |i| &quaternions[first + i]);
                    }
                }
                Target::Blocks(blocks) => {
                    for lane in 0..self.lanes(group) {
                        blocks.extend(tangent_of_lane(&tangents, lane).iter().flatten());
                    }
                }
            }
            group += 1;
        }
        Ok(())
    }

    /// [`RodElements::add_forces`].
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    fn add_forces_by(
        &self,
        processor: impl Processor,
        poses: &[Pose],
        properties: &RodProperties,
        line_load: Option<&LineLoad>,
        constitutive: &mut [Stress],
        first: usize,
        forces: &mut NodalForces,
    ) -> Result<(), usize> {
        let points = self.full_rule.len();
        for group in 0..self.elements.div_ceil(LANES) {
            let elements = self.group(group);
            let rows = internal_force::<N, I>(
                processor,
                &Nodes::new(elements.map(|e| self.of(e, poses))),
                &self.rule,
                (&properties.points, &elements.map(|e| e * self.rule.len())),
                &properties.stiffness,
                constitutive,
            )
            .map_err(|HalfTurnIn(lane)| elements[lane])?;
            for (lane, &e) in elements.iter().enumerate().take(self.lanes(group)) {
                let mut element = rows.of_lane(lane);
                if let Some(line_load) = line_load {
                    let jacobians = &properties.full_jacobians[e * points..][..points];
                    let nodes = self.of(e, poses);
                    line_load_force::<N, I>(nodes, &self.full_rule, jacobians, line_load, &mut element)
                        .map_err(|_| e)?;
                }
                forces.scatter(first + e * (N - 1), &element);
            }
        }
        Ok(())
    }

    /// [`RodElements::advance_stresses`].
    #[inline(always)]
    fn advance_stresses_by(
        &self,
        processor: impl Processor,
        poses: &[Pose],
        properties: &RodProperties,
        increments: &[Increment],
        constitutive: &[Stress],
        stresses: &mut [Stress],
    ) -> Result<(), usize> {
        for group in 0..self.elements.div_ceil(LANES) {
            let elements = self.group(group);
            advance_stress::<N, I>(
                processor,
                &Nodes::new(elements.map(|e| self.of(e, poses))),
                &self.rule,
                (&properties.points, &elements.map(|e| e * self.rule.len())),
                &properties.stiffness,
                &Increments::new(elements.map(|e| self.of(e, increments))),
                constitutive,
                stresses,
            )
            .map_err(|HalfTurnIn(lane)| elements[lane])?;
        }
        Ok(())
    }

    /// [`RodElements::add_inertia`].
    #[inline(always)]
    fn add_inertia_by(
        &self,
        properties: &RodProperties,
        velocities: &[Velocity],
        accelerations: &[Velocity],
        first: usize,
        forces: &mut NodalForces,
    ) {
        let Some(inertia) = &properties.inertia else { return };
        for e in 0..self.elements {
            let mass = self.mass_of(e, properties, inertia);
            let mut element = ElementForce::default();
            inertia_force::<N>(
                &self.full_rule,
                mass.jacobians,
                mass.coefficients,
                &inertia.section,
                self.of(e, velocities),
                self.of(e, accelerations),
                &mut element,
            );
            forces.scatter(first + e * (N - 1), &element);
        }
    }
}

/// Tangents of loads on the nodes from `first` on, so many.
fn loaded<'a>(
    applied: &'a Applied,
    first: usize,
    count: usize,
) -> impl Iterator<Item = &'a (usize, Matrix6<f64>)> {
    let start = applied.tangents.partition_point(|(node, _)| *node < first);
    applied.tangents[start..].iter().take_while(move |(node, _)| *node < first + count)
}

/// Supports of the nodes from `first` on, so many.
fn held<'a>(applied: &'a Applied, first: usize, count: usize) -> impl Iterator<Item = &'a Support> {
    let start = applied.supports.partition_point(|support| support.node < first);
    applied.supports[start..].iter().take_while(move |support| support.node < first + count)
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
        needs: &Needs,
    ) -> Result<RodProperties, usize> {
        let mut result =
            RodProperties { stiffness, points: Vec::new(), full_jacobians: Vec::new(), inertia: None };
        let full = needs.line_loads || needs.inertia.is_some();
        for e in 0..self.elements {
            let nodes = self.of(e, poses);
            let side_by_side = Nodes::new([nodes; LANES]);
            for basis in &self.rule {
                // As the forces compute it: strains at rest are zero, not rounding.
                let (strain, _) =
                    widest!(processor => I::point(processor, &side_by_side, basis)).map_err(|_| e)?;
                let (rotation, gamma) = (strain.rotation.scatter(0), scatter(&strain.gamma, 0));
                // ‖r⁰′‖ = ‖A⁻ᵀ γ̄‖: A is not quite orthogonal between the nodes.
                let inverse = rotation.transpose().try_inverse().ok_or(e)?;
                let jacobian = (inverse * gamma).norm();
                if !(rotation.determinant() > 1e-3 && jacobian > 0.0) {
                    return Err(e);
                }
                let (gamma, kappa) = (gamma / jacobian, scatter(&strain.kappa, 0) / jacobian);
                result.points.push(ReferencePoint { jacobian, gamma, kappa });
            }
            for basis in self.full_rule.iter().filter(|_| full) {
                let strain = I::strain(nodes, basis).map_err(|_| e)?;
                let inverse = strain.rotation.transpose().try_inverse().ok_or(e)?;
                result.full_jacobians.push((inverse * strain.gamma).norm());
            }
        }
        if let Some(section) = needs.inertia {
            let jacobians = result.full_jacobians.chunks_exact(self.full_rule.len());
            let coefficients = jacobians.flat_map(|jacobians| {
                mass_coefficients::<N>(&self.full_rule, jacobians).into_iter().flatten()
            });
            result.inertia = Some(RodInertia { section, coefficients: coefficients.collect() });
        }
        Ok(result)
    }

    fn add_forces(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        line_load: Option<&LineLoad>,
        constitutive: &mut [Stress],
        first: usize,
        forces: &mut NodalForces,
    ) -> Result<(), usize> {
        widest!(processor => self.add_forces_by(processor, poses, properties, line_load, constitutive, first, forces))
    }

    fn add_inertia(
        &self,
        properties: &RodProperties,
        velocities: &[Velocity],
        accelerations: &[Velocity],
        first: usize,
        forces: &mut NodalForces,
    ) {
        widest!(_processor => self.add_inertia_by(properties, velocities, accelerations, first, forces));
    }

    fn visit_inertia(&self, properties: &RodProperties, velocities: &[Velocity], visit: &mut InertiaVisitor) {
        let Some(inertia) = &properties.inertia else { return };
        for e in 0..self.elements {
            let ElementMass { jacobians, coefficients: mass } = self.mass_of(e, properties, inertia);
            let velocities = self.of(e, velocities);
            let mut spins = [[Vector3::zeros(); N]; N];
            for (basis, jacobian) in self.full_rule.iter().zip(jacobians) {
                let nodes = basis.value.iter().zip(velocities);
                let omega: Vector3<f64> = nodes.map(|(value, u)| u.rotation * *value).sum();
                let weighted = omega * (basis.weight * jacobian);
                for i in 0..N {
                    for j in 0..N {
                        spins[i][j] += weighted * (basis.value[i] * basis.value[j]);
                    }
                }
            }
            let first = e * (N - 1);
            for i in 0..N {
                for j in 0..N {
                    visit([first + i, first + j], mass[i][j], &spins[i][j]);
                }
            }
        }
    }

    fn line_load_power(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        line_load: &LineLoad,
        velocities: &[Velocity],
    ) -> Result<f64, usize> {
        let points = self.full_rule.len();
        let mut power = 0.0;
        for (e, jacobians) in properties.full_jacobians.chunks_exact(points).enumerate() {
            let mut element = ElementForce::default();
            line_load_force::<N, I>(self.of(e, poses), &self.full_rule, jacobians, line_load, &mut element)
                .map_err(|_| e)?;
            for (i, u) in self.of(e, velocities).iter().enumerate() {
                power += element.force[i].dot(&u.translation) + element.moment[i].dot(&u.rotation);
            }
        }
        Ok(power)
    }

    fn kinetic_energy(&self, properties: &RodProperties, velocities: &[Velocity]) -> f64 {
        let Some(inertia) = &properties.inertia else { return 0.0 };
        let of_element = |e| {
            let mass = self.mass_of(e, properties, inertia).coefficients;
            kinetic_energy::<N>(mass, &inertia.section, self.of(e, velocities))
        };
        (0..self.elements).map(of_element).sum()
    }

    fn strain_energy(&self, properties: &RodProperties, constitutive: &[Stress]) -> f64 {
        let stiffness = &properties.stiffness;
        let weights = self.rule.iter().map(|basis| basis.weight).cycle();
        let density = |stress: &Stress| {
            0.5 * (stress.force.dot(&stress.force.component_div(&stiffness.force))
                + stress.moment.dot(&stress.moment.component_div(&stiffness.moment)))
        };
        let points = properties.points.iter().zip(constitutive).zip(weights);
        points.map(|((point, stress), weight)| weight * point.jacobian * density(stress)).sum()
    }

    fn nodal_lengths(&self, properties: &RodProperties) -> Vec<f64> {
        let mut lengths = vec![0.0; self.elements * (N - 1) + 1];
        for (e, jacobians) in properties.full_jacobians.chunks_exact(self.full_rule.len()).enumerate() {
            for (basis, jacobian) in self.full_rule.iter().zip(jacobians) {
                for (length, value) in lengths[e * (N - 1)..].iter_mut().zip(&basis.value) {
                    *length += basis.weight * jacobian * value;
                }
            }
        }
        lengths
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
        widest!(processor => self.assemble_tangent_by(processor, state, range, properties, stresses, applied, target))
    }

    fn advance_stresses(
        &self,
        poses: &[Pose],
        properties: &RodProperties,
        increments: &[Increment],
        constitutive: &[Stress],
        stresses: &mut [Stress],
    ) -> Result<(), usize> {
        widest!(processor => self.advance_stresses_by(processor, poses, properties, increments, constitutive, stresses))
    }

    fn pose(&self, poses: &[Pose], xi: f64) -> Result<Pose, HalfTurn> {
        let (e, x) = self.locate(xi);
        // At a node the pose is the node's own, to the last digit.
        match self.node_at(e, x) {
            Some(node) => Ok(poses[node]),
            None => I::pose(self.of(e, poses), &self.basis_at(x)),
        }
    }

    fn position(&self, poses: &[Pose], xi: f64) -> Result<Vector3<f64>, HalfTurn> {
        let (e, x) = self.locate(xi);
        I::position(self.of(e, poses), &self.basis_at(x))
    }

    fn pose_increment(
        &self,
        poses: &[Pose],
        increments: &[Increment],
        xi: f64,
    ) -> Result<(Matrix3<f64>, Increment), HalfTurn> {
        let (e, x) = self.locate(xi);
        if let Some(node) = self.node_at(e, x) {
            return Ok((poses[node].rotation, increments[node]));
        }
        let d = I::pose_derivative(self.of(e, poses), &self.basis_at(x))?;
        let mut sum = Increment::default();
        for (j, increment) in self.of(e, increments).iter().enumerate() {
            sum.translation += d.position_translation[j] * increment.translation
                + d.position_rotation[j] * increment.rotation;
            sum.rotation += d.rotation_rotation[j] * increment.rotation;
        }
        Ok((d.pose.rotation, sum))
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
