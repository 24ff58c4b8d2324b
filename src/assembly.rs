//! Residual and tangent of a model, and the workspace that both write to.

use nalgebra::{Matrix6, Vector3, Vector4};

use crate::element::{LineLoad, Stress};
use crate::fit::increment_of;
use crate::interpolation::{Increment, Pose};
use crate::linear_solver::{Chain, NODE, Singular, Sparse};
use crate::load::Course;
use crate::model::{Model, RodModel};
use crate::rod::{Applied, NodalForces, QUATERNION_NODE, TangentError, Target};
use crate::rotation::rotation_from_quaternion_rate;
use crate::scene::Coordinates;
use crate::solution::StopReason;
use crate::state::State;

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
    /// max |f| over all free rows [N, N m], mixed: the paper's test.
    pub absolute: f64,
    /// max over rods of |R_f|/(F + F₀/τ) and |R_m|/(M + M₀/τ), to be held against τ.
    pub relative: f64,
}

/// τ of the unit-free test.
pub const RELATIVE_TOLERANCE: f64 = 1e-9;

/// What belongs to one rod.
#[derive(Clone, Debug)]
pub struct RodWork {
    /// f = fⁱⁿᵗ + fᵉˣᵗ.
    pub forces: NodalForces,
    /// ŝ(q).
    pub constitutive: Vec<Stress>,
    /// s, from which the geometric tangent is built.
    pub stresses: Vec<Stress>,
    /// The last Newton step.
    pub increments: Vec<Increment>,
    load_tangents: Vec<(usize, Matrix6<f64>)>,
    line_load: LineLoad,
}

/// The linear system, in the coordinates the user chose.
enum LinearSystem {
    /// One chain a rod, six unknowns a node.
    Chains(Vec<Chain>),
    /// The paper's system (16)+(17) of all rods, seven unknowns a node.
    Quaternions(Box<Sparse>),
}

/// Memory of a solve. Nothing is allocated in an iteration, but by the sparse alternative.
pub struct Workspace {
    /// One a rod.
    pub rods: Vec<RodWork>,
    system: LinearSystem,
    right: Vec<f64>,
}

impl Workspace {
    /// For a model.
    pub fn new(model: &Model, coordinates: Coordinates) -> Self {
        let nodes = model.reference.poses().len();
        let (system, size) = match coordinates {
            Coordinates::Increments => {
                let chains = model.rods.iter().map(|rod| Chain::new(rod.elements, rod.degree)).collect();
                (LinearSystem::Chains(chains), NODE * nodes)
            }
            Coordinates::Quaternions => {
                let size = QUATERNION_NODE * nodes;
                (LinearSystem::Quaternions(Box::new(Sparse::new(size))), size)
            }
        };
        let work = |rod: &RodModel| RodWork {
            forces: NodalForces::new(rod.nodes),
            constitutive: vec![Stress::default(); rod.properties.points.len()],
            stresses: vec![Stress::default(); rod.properties.points.len()],
            increments: vec![Increment::default(); rod.nodes],
            load_tangents: rod.point_loads.iter().map(|load| (load.node, Matrix6::zeros())).collect(),
            line_load: LineLoad::default(),
        };
        Self { rods: model.rods.iter().map(work).collect(), system, right: vec![0.0; size] }
    }

    /// f and ŝ at a state and load level.
    pub fn evaluate(&mut self, model: &Model, state: &State, level: &LoadLevel) -> Result<(), StopReason> {
        for (index, (rod, work)) in model.rods.iter().zip(&mut self.rods).enumerate() {
            let poses = &state.poses()[rod.range.clone()];
            work.forces.clear();
            work.line_load = line_load(rod, level);
            rod.kernel
                .add_forces(poses, &rod.properties, &work.line_load, &mut work.constitutive, &mut work.forces)
                .map_err(|element| StopReason::HalfTurn { rod: index, element })?;
            for load in &rod.point_loads {
                let (force, moment) = load.rows(&poses[load.node], level.factor(&load.course));
                work.forces.add(load.node, &force, &moment);
            }
        }
        Ok(())
    }

    /// The residual of what was evaluated last; NaN if a number overflowed.
    pub fn residual(&self, model: &Model, state: &State) -> Residual {
        let mut result = Residual::default();
        if let LinearSystem::Quaternions(_) = self.system {
            // Eq. (17), a pure number in either test.
            let constraint = |sum, p: &Vector4<f64>| largest(sum, (p.norm_squared() - 1.0).abs());
            result.absolute = state.quaternions().iter().fold(0.0, constraint);
            result.relative = result.absolute;
        }
        for (rod, work) in model.rods.iter().zip(&self.rods) {
            let poses = &state.poses()[rod.range.clone()];
            let (mut force, mut moment) = (0.0, 0.0);
            let mut supports = rod.supports.iter().peekable();
            for (node, pose) in poses.iter().enumerate() {
                let (f, m) = (&work.forces.force[node], &work.forces.moment[node]);
                if let Some(support) = supports.next_if(|support| support.node == node) {
                    moment = largest(moment, max_norm(&support.free_moment(&pose.rotation, f, m)));
                } else {
                    force = largest(force, max_norm(f));
                    moment = largest(moment, max_norm(m));
                }
            }
            let (force_scale, moment_scale) = tolerance_scales(rod, work, poses);
            result.absolute = largest(result.absolute, largest(force, moment));
            result.relative =
                largest(result.relative, largest(ratio(force, force_scale), ratio(moment, moment_scale)));
        }
        result
    }

    /// Builds and factorises the tangent at the state and level that were evaluated last.
    pub fn factorize(&mut self, model: &Model, state: &State, level: &LoadLevel) -> Result<(), StopReason> {
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
                tangents: &work.load_tangents,
                supports: &rod.supports,
                force: &work.forces.force,
            };
            let mut target = match &mut self.system {
                LinearSystem::Chains(chains) => Target::Chain(&mut chains[index]),
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
            LinearSystem::Chains(chains) => chains.iter_mut().try_for_each(Chain::factorize),
            LinearSystem::Quaternions(system) => system.factorize(),
        };
        factorized.map_err(|Singular| StopReason::Singular)
    }

    /// K δq = f with the last factors; writes the increments.
    pub fn solve(&mut self, model: &Model, state: &State) -> Result<(), StopReason> {
        self.fill_right(model, state);
        match &self.system {
            LinearSystem::Chains(chains) => {
                for (rod, chain) in model.rods.iter().zip(chains) {
                    chain.solve(&mut self.right[NODE * rod.range.start..NODE * rod.range.end]);
                }
            }
            LinearSystem::Quaternions(system) => {
                system.solve(&mut self.right).map_err(|Singular| StopReason::Singular)?;
            }
        }
        if !self.right.iter().all(|x| x.is_finite()) {
            return Err(StopReason::Singular);
        }
        self.read_increments(model, state);
        Ok(())
    }

    /// s ← ŝ(q) + C ε′(q) δq, before the state is updated.
    pub fn advance_stresses(&mut self, model: &Model, state: &State) -> Result<(), StopReason> {
        for (index, (rod, work)) in model.rods.iter().zip(&mut self.rods).enumerate() {
            let poses = &state.poses()[rod.range.clone()];
            rod.kernel
                .advance_stresses(
                    poses,
                    &rod.properties,
                    &work.increments,
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

    /// q ← q + δq; a held node's position follows from its rotation.
    pub fn update(&self, model: &Model, state: &mut State) {
        for (rod, work) in model.rods.iter().zip(&self.rods) {
            for (node, increment) in rod.range.clone().zip(&work.increments) {
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
            place_supports(rod, state);
        }
    }

    fn fill_right(&mut self, model: &Model, state: &State) {
        let stride = match self.system {
            LinearSystem::Chains(_) => NODE,
            LinearSystem::Quaternions(_) => QUATERNION_NODE,
        };
        for (rod, work) in model.rods.iter().zip(&self.rods) {
            let rows = &mut self.right[stride * rod.range.start..stride * rod.range.end];
            let quaternions = &state.quaternions()[rod.range.clone()];
            for (node, row) in rows.chunks_exact_mut(stride).enumerate() {
                row[..3].copy_from_slice(work.forces.force[node].as_slice());
                row[3..6].copy_from_slice(work.forces.moment[node].as_slice());
                if stride == QUATERNION_NODE {
                    row[6] = 1.0 - quaternions[node].norm_squared();
                }
            }
            for support in &rod.supports {
                let pose = &state.poses()[rod.range.start + support.node];
                let forces = &work.forces;
                let (force, moment) = (&forces.force[support.node], &forces.moment[support.node]);
                let row = &mut rows[stride * support.node..];
                row[..3].fill(0.0);
                row[3..6].copy_from_slice(support.free_moment(&pose.rotation, force, moment).as_slice());
            }
        }
    }

    /// (δr, δφ) at every node from the solution of the linear system.
    fn read_increments(&mut self, model: &Model, state: &State) {
        for (rod, work) in model.rods.iter().zip(&mut self.rods) {
            for (node, increment) in rod.range.clone().zip(&mut work.increments) {
                match self.system {
                    LinearSystem::Chains(_) => *increment = increment_of(&self.right[NODE * node..][..NODE]),
                    LinearSystem::Quaternions(_) => {
                        let step = &self.right[QUATERNION_NODE * node..][..QUATERNION_NODE];
                        let change = Vector4::new(step[3], step[4], step[5], step[6]);
                        increment.translation = Vector3::new(step[0], step[1], step[2]);
                        increment.rotation =
                            rotation_from_quaternion_rate(&state.quaternions()[node]) * change;
                    }
                }
            }
            for support in &rod.supports {
                let rotation = &state.poses()[rod.range.start + support.node].rotation;
                work.increments[support.node] =
                    support.increment(rotation, &work.increments[support.node].rotation);
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

/// (F + F₀/τ, M + M₀/τ): the largest nodal sums of absolute contributions, and the rounding floors.
///
/// A position carries the error ε|r|, a strain 1/J_e · p² times that, hence F₀ = 8 ε C_γ |r| p²/J_e. A matrix
/// entry carries ε, hence 8 ε C_κ p²/J_e in the moments, and γ̄ × n adds J_e F₀.
fn tolerance_scales(rod: &RodModel, work: &RodWork, poses: &[Pose]) -> (f64, f64) {
    let largest_of = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let reach = poses.iter().map(|pose| pose.position.amax()).fold(0.0, f64::max);
    let amplification = 8.0 * f64::EPSILON * (rod.degree * rod.degree) as f64 / rod.element_length;
    let force_floor = amplification * rod.properties.stiffness.force.max() * reach;
    let moment_floor =
        amplification * rod.properties.stiffness.moment.max() + force_floor * rod.element_length;
    (
        largest_of(&work.forces.force_scale) + force_floor / RELATIVE_TOLERANCE,
        largest_of(&work.forces.moment_scale) + moment_floor / RELATIVE_TOLERANCE,
    )
}
