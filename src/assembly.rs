//! Residual and tangent of a model, and the workspace that both write to.

mod blocks;
mod coupled;
mod power;
mod residual;

use nalgebra::{Matrix6, Vector3, Vector4, Vector6};

use crate::element::{LineLoad, Stress};
use crate::fit::increment_of;
use crate::inertia::Velocity;
use crate::interpolation::Increment;
use crate::linear_solver::{NODE, Singular, Sparse};
use crate::load::Course;
use crate::model::{Model, RodModel};
use crate::rod::{Applied, NodalForces, QUATERNION_NODE, StepVelocity, TangentError, Target};
use crate::rotation::rotation_from_quaternion_rate;
use crate::scene::Coordinates;
use crate::solution::StopReason;
use crate::state::State;
pub use blocks::{Block, Blocks, ConstraintRow};
use coupled::{Chains, factorize_chains};
pub use residual::{RELATIVE_TOLERANCE, Residual};

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
