//! Residual and tangent of a model, and the workspace that both write to.

mod blocks;

use nalgebra::{Matrix6, Vector3, Vector4, Vector6};

use crate::element::{LineLoad, Stress};
use crate::fit::increment_of;
use crate::inertia::Velocity;
use crate::interpolation::{Increment, Pose};
use crate::linear_solver::{Chain, Coupled, NODE, Singular, Sparse};
use crate::load::Course;
use crate::model::{BodyModel, Model, RodModel};
use crate::rod::{Applied, NodalForces, QUATERNION_NODE, StepVelocity, TangentError, Target};
use crate::rotation::rotation_from_quaternion_rate;
use crate::scene::Coordinates;
use crate::solution::StopReason;
use crate::state::State;
pub use blocks::{Block, Blocks, ConstraintRow};

/// How much of every load acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadLevel {
    /// The load factor λ.
    pub load_factor: f64,
    /// Factor on everything; below 1 only while loads that act at λ = 0 already are brought up.
    pub preload: f64,
}

impl LoadLevel {
    fn factor(&self, course: &Course) -> f64 {
        self.preload * course.factor(self.load_factor)
    }
}

/// The residual of a state in the two ways of measuring it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// max |f| and |g| over all free rows [N, N m; m, rad], mixed: the paper's test.
    pub absolute: f64,
    /// max over rods and bodies of |R_f|/(F + F₀/τ) and |R_m|/(M + M₀/τ), and over joints of |g| against what their
    /// parts travel, to be held against τ.
    pub relative: f64,
}

/// τ of the unit-free test.
pub const RELATIVE_TOLERANCE: f64 = 1e-9;

/// What belongs to one rod.
#[derive(Clone, Debug)]
pub struct RodWork {
    /// ŝ(q).
    pub constitutive: Vec<Stress>,
    /// s, from which the geometric tangent is built.
    pub stresses: Vec<Stress>,
    load_tangents: Vec<(usize, Matrix6<f64>)>,
    line_load: LineLoad,
}

/// Velocities and accelerations of all nodes; what moves has inertia.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// u.
    pub velocities: Vec<Velocity>,
    /// u̇.
    pub accelerations: Vec<Velocity>,
}

/// The linear system, in the coordinates the user chose.
enum LinearSystem {
    /// One chain a rod, six unknowns a node, and what couples them.
    Chains(Box<Chains>),
    /// The paper's system (16)+(17) of all rods, seven unknowns a node.
    Quaternions(Box<Sparse>),
}

/// Chains, and the system of their kept nodes, of the bodies and of the multipliers.
struct Chains {
    chains: Vec<Chain>,
    coupled: Coupled,
    /// First row of every coupled node in that system; `None` for the chains' own.
    places: Vec<Option<usize>>,
    /// The coupled nodes in the order of their rows.
    nodes: Vec<usize>,
    right: Vec<f64>,
}

impl Chains {
    fn new(model: &Model) -> Self {
        let joined = || model.couplings.iter().flat_map(|coupling| coupling.nodes.into_iter().flatten());
        let chain = |rod: &RodModel| {
            let own = joined().filter(|node| rod.range.contains(node));
            let kept: Vec<usize> = own.map(|node| node - rod.range.start).collect();
            Chain::new(rod.elements, rod.degree, &kept)
        };
        let chains: Vec<Chain> = model.rods.iter().map(chain).collect();
        let of_rods = model.rods.iter().zip(&chains);
        let kept = of_rods.flat_map(|(rod, chain)| chain.kept().iter().map(|node| rod.range.start + node));
        let nodes: Vec<usize> = kept.chain(model.bodies.iter().map(|body| body.node)).collect();
        let mut places = vec![None; model.reference.poses().len()];
        for (index, &node) in nodes.iter().enumerate() {
            places[node] = Some(NODE * index);
        }
        let size = NODE * nodes.len() + model.reference.multipliers().len();
        Self { chains, coupled: Coupled::new(size), places, nodes, right: vec![0.0; size] }
    }

    /// Adds a block to the coupled system, by nodes of the model.
    fn add(&mut self, row: usize, column: usize, block: &Matrix6<f64>) {
        if let (Some(row), Some(column)) = (self.places[row], self.places[column]) {
            self.coupled.add_block(row, column, block);
        }
    }

    /// b ← K⁻¹ b: six entries a node, then the multipliers.
    fn solve(&mut self, model: &Model, b: &mut [f64]) -> Result<(), Singular> {
        for (rod, chain) in model.rods.iter().zip(&self.chains) {
            chain.forward(&mut b[NODE * rod.range.start..NODE * rod.range.end]);
        }
        let nodal = NODE * self.nodes.len();
        for (&node, right) in self.nodes.iter().zip(self.right.chunks_exact_mut(NODE)) {
            right.copy_from_slice(&b[NODE * node..][..NODE]);
        }
        let multipliers = NODE * self.places.len();
        self.right[nodal..].copy_from_slice(&b[multipliers..]);
        self.coupled.solve(&mut self.right)?;
        for (&node, right) in self.nodes.iter().zip(self.right.chunks_exact(NODE)) {
            b[NODE * node..][..NODE].copy_from_slice(right);
        }
        b[multipliers..].copy_from_slice(&self.right[nodal..]);
        for (rod, chain) in model.rods.iter().zip(&self.chains) {
            chain.backward(&mut b[NODE * rod.range.start..NODE * rod.range.end]);
        }
        Ok(())
    }
}

/// Memory of a solve. Nothing is allocated in an iteration, but by the sparse alternatives.
pub struct Workspace {
    /// One a rod.
    pub rods: Vec<RodWork>,
    /// f = fⁱⁿᵗ + fᵉˣᵗ + Gᵀ λ, in motion less M u̇ + fᵍʸʳ, on every node of the model.
    pub forces: NodalForces,
    /// g of every coupling.
    pub gaps: Vec<Vector6<f64>>,
    /// The last Newton step: (δr, δφ) of every node.
    pub increments: Vec<Increment>,
    /// The last Newton step: δλ.
    pub multiplier_increments: Vec<f64>,
    system: LinearSystem,
    right: Vec<f64>,
}

impl Workspace {
    /// For a model.
    pub fn new(model: &Model, coordinates: Coordinates) -> Self {
        let nodes = model.reference.poses().len();
        let multipliers = model.reference.multipliers().len();
        let (system, size) = match coordinates {
            Coordinates::Increments => {
                (LinearSystem::Chains(Box::new(Chains::new(model))), NODE * nodes + multipliers)
            }
            Coordinates::Quaternions => {
                let size = QUATERNION_NODE * nodes;
                (LinearSystem::Quaternions(Box::new(Sparse::new(size))), size)
            }
        };
        let work = |rod: &RodModel| RodWork {
            constitutive: vec![Stress::default(); rod.properties.points.len()],
            stresses: vec![Stress::default(); rod.properties.points.len()],
            load_tangents: rod.point_loads.iter().map(|load| (load.node, Matrix6::zeros())).collect(),
            line_load: LineLoad::default(),
        };
        Self {
            rods: model.rods.iter().map(work).collect(),
            forces: NodalForces::new(nodes),
            gaps: vec![Vector6::zeros(); model.couplings.len()],
            increments: vec![Increment::default(); nodes],
            multiplier_increments: vec![0.0; multipliers],
            system,
            right: vec![0.0; size],
        }
    }

    /// f, g and ŝ at a state and load level; with a motion, inertia, too.
    pub fn evaluate(
        &mut self,
        model: &Model,
        state: &State,
        level: &LoadLevel,
        motion: Option<&Motion>,
    ) -> Result<(), StopReason> {
        self.forces.clear();
        for (index, (rod, work)) in model.rods.iter().zip(&mut self.rods).enumerate() {
            let (range, first) = (rod.range.clone(), rod.range.start);
            let poses = &state.poses()[range.clone()];
            work.line_load = line_load(rod, level);
            let line_load = (!rod.line_loads.is_empty()).then_some(&work.line_load);
            rod.kernel
                .add_forces(
                    poses,
                    &rod.properties,
                    line_load,
                    &mut work.constitutive,
                    first,
                    &mut self.forces,
                )
                .map_err(|element| StopReason::HalfTurn { rod: index, element })?;
            if let Some(motion) = motion {
                let (u, a) = (&motion.velocities[range.clone()], &motion.accelerations[range]);
                rod.kernel.add_inertia(&rod.properties, u, a, first, &mut self.forces);
            }
            for load in &rod.point_loads {
                let (force, moment) = load.rows(&poses[load.node], level.factor(&load.course));
                self.forces.add(first + load.node, &force, &moment);
            }
        }
        for body in &model.bodies {
            for load in &body.loads {
                let (force, moment) = load.rows(&state.poses()[body.node], level.factor(&load.course));
                self.forces.add(body.node, &force, &moment);
            }
            if let Some(motion) = motion {
                let (u, a) = (&motion.velocities[body.node], &motion.accelerations[body.node]);
                let (force, moment) = body.mass.inertia_force(u, a);
                self.forces.add(body.node, &force, &moment);
            }
        }
        for (coupling, gap) in model.couplings.iter().zip(&mut self.gaps) {
            let [a, b] = coupling.poses(state);
            *gap = coupling.constraint.gap(a, b);
            let forces = coupling.constraint.forces(a, b, &coupling.multipliers(state));
            for (node, force) in coupling.nodes.iter().zip(&forces) {
                if let Some(node) = *node {
                    let (force, moment) = (force.fixed_rows::<3>(0), force.fixed_rows::<3>(3));
                    self.forces.add(node, &force.into_owned(), &moment.into_owned());
                }
            }
        }
        Ok(())
    }

    /// f = −M u̇ − fᵍʸʳ(u) alone.
    pub fn inertia_forces(&mut self, model: &Model, motion: &Motion) {
        self.forces.clear();
        for rod in &model.rods {
            let (range, first) = (rod.range.clone(), rod.range.start);
            let (u, a) = (&motion.velocities[range.clone()], &motion.accelerations[range]);
            rod.kernel.add_inertia(&rod.properties, u, a, first, &mut self.forces);
        }
        for body in &model.bodies {
            let (u, a) = (&motion.velocities[body.node], &motion.accelerations[body.node]);
            let (force, moment) = body.mass.inertia_force(u, a);
            self.forces.add(body.node, &force, &moment);
        }
    }

    /// The residual of what was evaluated last; NaN if a number overflowed. `travel` is what joints may be off by,
    /// (displacement [m], rotation [rad]) times τ; `step` is given in a time step.
    pub fn residual(
        &self,
        model: &Model,
        state: &State,
        travel: (f64, f64),
        step: Option<&StepVelocity>,
    ) -> Residual {
        let mut result = Residual::default();
        if let LinearSystem::Quaternions(_) = self.system {
            // Eq. (17), a pure number in either test.
            let constraint = |sum, p: &Vector4<f64>| largest(sum, (p.norm_squared() - 1.0).abs());
            result.absolute = state.quaternions().iter().fold(0.0, constraint);
            result.relative = result.absolute;
        }
        let mut add = |force, moment, scales: (f64, f64)| {
            result.absolute = largest(result.absolute, largest(force, moment));
            let relative = largest(ratio(force, scales.0), ratio(moment, scales.1));
            result.relative = largest(result.relative, relative);
        };
        for rod in &model.rods {
            let poses = &state.poses()[rod.range.clone()];
            let (mut force, mut moment) = (0.0, 0.0);
            let mut supports = rod.supports.iter().peekable();
            for (node, pose) in poses.iter().enumerate() {
                let index = rod.range.start + node;
                let (f, m) = (&self.forces.force[index], &self.forces.moment[index]);
                if let Some(support) = supports.next_if(|support| support.node == node) {
                    moment = largest(moment, max_norm(&support.free_moment(&pose.rotation, f, m)));
                } else {
                    force = largest(force, max_norm(f));
                    moment = largest(moment, max_norm(m));
                }
            }
            add(force, moment, tolerance_scales(rod, &self.forces, poses));
        }
        for body in &model.bodies {
            let forces = &self.forces;
            let scales = (forces.force_scale[body.node], forces.moment_scale[body.node]);
            let floor = body_floor(body, scales.0, step);
            let (force, moment) = (max_norm(&forces.force[body.node]), max_norm(&forces.moment[body.node]));
            add(
                force,
                moment,
                (scales.0 + floor.0 / RELATIVE_TOLERANCE, scales.1 + floor.1 / RELATIVE_TOLERANCE),
            );
        }
        for (coupling, gap) in model.couplings.iter().zip(&self.gaps) {
            let reach = coupling.poses(state).iter().map(|pose| pose.position.amax()).fold(0.0, f64::max);
            let floor = 8.0 * f64::EPSILON / RELATIVE_TOLERANCE;
            let (mut translation, mut rotation) = (0.0, 0.0);
            for &row in &coupling.rows {
                let side = if row < 3 { &mut translation } else { &mut rotation };
                *side = largest(*side, gap[row].abs());
            }
            add(translation, rotation, (travel.0 + floor * (reach + coupling.reach), travel.1 + floor));
        }
        result
    }

    /// Builds and factorises the tangent at the state and level that were evaluated last. In a time step that is
    /// [[M + b D + b² K, −Gᵀ], [G, 0]] for the increments (δr, δφ) and b² δλ, rows of forces times b².
    pub fn factorize(
        &mut self,
        model: &Model,
        state: &State,
        level: &LoadLevel,
        step: Option<&StepVelocity>,
    ) -> Result<(), StopReason> {
        if let LinearSystem::Quaternions(system) = &mut self.system {
            system.clear();
            add_unit_constraints(system, state);
        }
        for (index, (rod, work)) in model.rods.iter().zip(&mut self.rods).enumerate() {
            let poses = &state.poses()[rod.range.clone()];
            for (load, tangent) in rod.point_loads.iter().zip(&mut work.load_tangents) {
                tangent.1 = load.tangent(&poses[load.node], level.factor(&load.course));
            }
            let applied = Applied {
                line_load: &work.line_load,
                line_loaded: !rod.line_loads.is_empty(),
                tangents: &work.load_tangents,
                supports: &rod.supports,
                force: &self.forces.force[rod.range.clone()],
                step: step
                    .map(|step| StepVelocity { velocities: &step.velocities[rod.range.clone()], b: step.b }),
            };
            let mut target = match &mut self.system {
                LinearSystem::Chains(system) => Target::Chain(&mut system.chains[index]),
                LinearSystem::Quaternions(system) => {
                    Target::Quaternions { system, first_row: QUATERNION_NODE * rod.range.start }
                }
            };
            rod.kernel
                .assemble_tangent(
                    state,
                    rod.range.clone(),
                    &rod.properties,
                    &work.stresses,
                    &applied,
                    &mut target,
                )
                .map_err(|error| match error {
                    TangentError::HalfTurn(element) => StopReason::HalfTurn { rod: index, element },
                    TangentError::Singular => StopReason::Singular,
                })?;
        }
        let factorized = match &mut self.system {
            LinearSystem::Chains(system) => factorize_chains(system, model, state, level, step),
            LinearSystem::Quaternions(system) => system.factorize(),
        };
        factorized.map_err(|Singular| StopReason::Singular)
    }

    /// Solves with the last factors for (δq, δλ): K δq − Gᵀ δλ = f, G δq = −g; `scale` is the factor b² on the rows
    /// of forces, 1 in statics. Writes the increments.
    pub fn solve(&mut self, model: &Model, state: &State, scale: f64) -> Result<(), StopReason> {
        self.fill_right(model, state, scale);
        match &mut self.system {
            LinearSystem::Chains(system) => system.solve(model, &mut self.right),
            LinearSystem::Quaternions(system) => system.solve(&mut self.right),
        }
        .map_err(|Singular| StopReason::Singular)?;
        if !self.right.iter().all(|x| x.is_finite()) {
            return Err(StopReason::Singular);
        }
        self.read_increments(model, state);
        let first = self.right.len() - self.multiplier_increments.len();
        for (increment, x) in self.multiplier_increments.iter_mut().zip(&self.right[first..]) {
            *increment = x / scale;
        }
        Ok(())
    }

    /// b ← K⁻¹ b with the last factors: six entries a node, then the multipliers (only without quaternion unknowns).
    /// Entries of held nodes must be zero.
    pub fn solve_right(&mut self, model: &Model, right: &mut [f64]) -> Result<(), StopReason> {
        let LinearSystem::Chains(system) = &mut self.system else { return Err(StopReason::Singular) };
        system.solve(model, right).map_err(|Singular| StopReason::Singular)?;
        if right.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(StopReason::Singular) }
    }

    /// s ← ŝ(q) + C ε′(q) δq, before the state is updated.
    pub fn advance_stresses(&mut self, model: &Model, state: &State) -> Result<(), StopReason> {
        for (index, (rod, work)) in model.rods.iter().zip(&mut self.rods).enumerate() {
            let poses = &state.poses()[rod.range.clone()];
            rod.kernel
                .advance_stresses(
                    poses,
                    &rod.properties,
                    &self.increments[rod.range.clone()],
                    &work.constitutive,
                    &mut work.stresses,
                )
                .map_err(|element| StopReason::HalfTurn { rod: index, element })?;
        }
        Ok(())
    }

    /// s ← ŝ(q): the plain iteration, and the start of the mixed one.
    pub fn reset_stresses(&mut self) {
        for work in &mut self.rods {
            work.stresses.copy_from_slice(&work.constitutive);
        }
    }

    /// q ← q + δq, λ ← λ + δλ; a held node's position follows from its rotation.
    pub fn update(&self, model: &Model, state: &mut State) {
        for (node, increment) in self.increments.iter().enumerate() {
            match self.system {
                LinearSystem::Chains(_) => state.add(node, increment),
                LinearSystem::Quaternions(_) => {
                    let step = &self.right[QUATERNION_NODE * node..][..QUATERNION_NODE];
                    let change = Vector4::new(step[3], step[4], step[5], step[6]);
                    state.set_position(node, state.poses()[node].position + increment.translation);
                    state.set_quaternion(node, state.quaternions()[node] + change);
                }
            }
        }
        for (multiplier, increment) in state.multipliers_mut().iter_mut().zip(&self.multiplier_increments) {
            *multiplier += increment;
        }
        for rod in &model.rods {
            place_supports(rod, state);
        }
    }

    fn fill_right(&mut self, model: &Model, state: &State, scale: f64) {
        let stride = match self.system {
            LinearSystem::Chains(_) => NODE,
            LinearSystem::Quaternions(_) => QUATERNION_NODE,
        };
        let nodes = state.poses().len();
        for (node, row) in self.right.chunks_exact_mut(stride).take(nodes).enumerate() {
            let (force, moment) = (self.forces.force[node] * scale, self.forces.moment[node] * scale);
            row[..3].copy_from_slice(force.as_slice());
            row[3..6].copy_from_slice(moment.as_slice());
            if stride == QUATERNION_NODE {
                row[6] = 1.0 - state.quaternions()[node].norm_squared();
            }
        }
        for rod in &model.rods {
            for support in &rod.supports {
                let node = rod.range.start + support.node;
                let (force, moment) = (&self.forces.force[node], &self.forces.moment[node]);
                let free = support.free_moment(&state.poses()[node].rotation, force, moment) * scale;
                let row = &mut self.right[stride * node..];
                row[..3].fill(0.0);
                row[3..6].copy_from_slice(free.as_slice());
            }
        }
        for (coupling, gap) in model.couplings.iter().zip(&self.gaps) {
            for (k, &row) in coupling.rows.iter().enumerate() {
                self.right[stride * nodes + coupling.first + k] = -gap[row];
            }
        }
    }

    /// (δr, δφ) at every node from the solution of the linear system.
    fn read_increments(&mut self, model: &Model, state: &State) {
        for (node, increment) in self.increments.iter_mut().enumerate() {
            match self.system {
                LinearSystem::Chains(_) => *increment = increment_of(&self.right[NODE * node..][..NODE]),
                LinearSystem::Quaternions(_) => {
                    let step = &self.right[QUATERNION_NODE * node..][..QUATERNION_NODE];
                    let change = Vector4::new(step[3], step[4], step[5], step[6]);
                    increment.translation = Vector3::new(step[0], step[1], step[2]);
                    increment.rotation = rotation_from_quaternion_rate(&state.quaternions()[node]) * change;
                }
            }
        }
        for rod in &model.rods {
            for support in &rod.supports {
                let node = rod.range.start + support.node;
                let rotation = &state.poses()[node].rotation;
                self.increments[node] = support.increment(rotation, &self.increments[node].rotation);
            }
        }
    }
}

/// Bodies, joints and what is left of the chains, after every chain has its elements.
fn factorize_chains(
    system: &mut Chains,
    model: &Model,
    state: &State,
    level: &LoadLevel,
    step: Option<&StepVelocity>,
) -> Result<(), Singular> {
    system.coupled.clear();
    for (index, rod) in model.rods.iter().enumerate() {
        system.chains[index].factorize()?;
        let first = rod.range.start;
        for (row, column, block) in system.chains[index].remainder() {
            if let (Some(row), Some(column)) = (system.places[first + row], system.places[first + column]) {
                system.coupled.add_block(row, column, block);
            }
        }
    }
    let scale = step.map_or(1.0, |step| step.b * step.b);
    for body in &model.bodies {
        let mut block = Matrix6::zeros();
        for load in &body.loads {
            block += load.tangent(&state.poses()[body.node], level.factor(&load.course)) * scale;
        }
        if let Some(step) = step {
            block += body.mass.inertia_tangent(&step.velocities[body.node], step.b);
        }
        system.add(body.node, body.node, &block);
    }
    let first = NODE * system.nodes.len();
    for coupling in &model.couplings {
        let [a, b] = coupling.poses(state);
        let tangent = coupling.constraint.tangent(a, b, &coupling.multipliers(state));
        let jacobian = coupling.constraint.jacobian(a, b);
        for (i, row_node) in coupling.nodes.iter().enumerate() {
            let Some(row_node) = *row_node else { continue };
            for (j, column_node) in coupling.nodes.iter().enumerate() {
                if let Some(column_node) = *column_node {
                    system.add(row_node, column_node, &(tangent[i][j] * scale));
                }
            }
            let Some(place) = system.places[row_node] else { continue };
            for (k, &row) in coupling.rows.iter().enumerate() {
                let multiplier = first + coupling.first + k;
                for c in 0..NODE {
                    system.coupled.add(multiplier, place + c, jacobian[i][(row, c)]);
                    system.coupled.add(place + c, multiplier, -jacobian[i][(row, c)]);
                }
            }
        }
    }
    system.coupled.factorize()
}

/// Puts held nodes where their rotation asks for.
pub fn place_supports(rod: &RodModel, state: &mut State) {
    for support in &rod.supports {
        let node = rod.range.start + support.node;
        state.set_position(node, support.position(&state.poses()[node].rotation));
    }
}

/// The sum of a rod's line loads at a level.
fn line_load(rod: &RodModel, level: &LoadLevel) -> LineLoad {
    let mut sum = LineLoad::default();
    for (load, course) in &rod.line_loads {
        let factor = level.factor(course);
        sum.force += load.force * factor;
        sum.body_force += load.body_force * factor;
        sum.moment += load.moment * factor;
        sum.body_moment += load.body_moment * factor;
    }
    sum
}

/// Rows ‖P‖² = 1 of eq. (17), linearised: 2 Pᵀ δP = 1 − ‖P‖².
fn add_unit_constraints(system: &mut Sparse, state: &State) {
    for (node, quaternion) in state.quaternions().iter().enumerate() {
        for (k, component) in quaternion.iter().enumerate() {
            system.add(QUATERNION_NODE * node + 6, QUATERNION_NODE * node + 3 + k, 2.0 * component);
        }
    }
}

/// The larger, or NaN if one is.
fn largest(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// max |v_k|, or NaN if one is (`amax` would pass over it).
fn max_norm(v: &Vector3<f64>) -> f64 {
    largest(v.x.abs(), largest(v.y.abs(), v.z.abs()))
}

/// a/b for a residual and its scale; an unloaded, unstrained rod has 0/0 = 0, and a scale that overflowed
/// (a/∞ = 0 would look converged) gives NaN.
fn ratio(a: f64, b: f64) -> f64 {
    if !b.is_finite() {
        f64::NAN
    } else if a == 0.0 {
        0.0
    } else {
        a / b
    }
}

/// (F₀, M₀) of a body: a moment may vanish to rounding where a force has a lever, and an acceleration is known to
/// ε |u|/b, where u stands for the speeds of the whole body: one that only spins has no velocity to compare with.
fn body_floor(body: &BodyModel, force_scale: f64, step: Option<&StepVelocity>) -> (f64, f64) {
    let noise = 8.0 * f64::EPSILON;
    let lever = noise * force_scale * body.reach;
    let Some(step) = step else { return (0.0, lever) };
    let (u, inertia) = (&step.velocities[body.node], body.mass.inertia.max());
    let size = (inertia / body.mass.mass).sqrt();
    let speed = u.translation.norm() + u.rotation.norm() * size;
    (noise * body.mass.mass * speed / step.b, lever + noise * inertia * speed / (size * step.b))
}

/// (F + F₀/τ, M + M₀/τ): the largest nodal sums of absolute contributions, and the rounding floors.
///
/// A position carries the error ε|r|, a strain 1/J_e · p² times that, hence F₀ = 8 ε C_γ |r| p²/J_e. A matrix
/// entry carries ε, hence 8 ε C_κ p²/J_e in the moments, and γ̄ × n adds J_e F₀.
fn tolerance_scales(rod: &RodModel, forces: &NodalForces, poses: &[Pose]) -> (f64, f64) {
    let largest_of = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let reach = poses.iter().map(|pose| pose.position.amax()).fold(0.0, f64::max);
    let amplification = 8.0 * f64::EPSILON * (rod.degree * rod.degree) as f64 / rod.element_length;
    let force_floor = amplification * rod.properties.stiffness.force.max() * reach;
    let moment_floor =
        amplification * rod.properties.stiffness.moment.max() + force_floor * rod.element_length;
    (
        largest_of(&forces.force_scale[rod.range.clone()]) + force_floor / RELATIVE_TOLERANCE,
        largest_of(&forces.moment_scale[rod.range.clone()]) + moment_floor / RELATIVE_TOLERANCE,
    )
}
