//! The motion in time: M u̇ + fᵍʸʳ(u) = fⁱⁿᵗ(q) + fᵉˣᵗ(t, q) + Gᵀ(q) λ, q̇ = B(q) u, g(q) = 0, from the reference with
//! the velocities given, eq. (10) to (15). The gyroscopic force has the sign that conserves angular momentum.

mod accuracy;
mod balance;
mod generalized_alpha;
mod radau;
mod run;
mod start;
mod times;

use crate::assembly::{LoadLevel, Motion, Workspace};
use crate::inertia::Velocity;
use crate::linear_solver::NODE;
use crate::model::Model;
use crate::newton::{Converged, Newton, NotConverged};
use crate::scene::{Coordinates, Dynamics, Method};
use crate::solution::{Energies, Solution, SolveFailure, Statistics, StopReason};
use crate::state::State;
use accuracy::Leading;
use run::Run;

/// Joint forces with more relative rounding noise than this are worth a warning.
const NOISE: f64 = 1e-6;

/// Solves for the times from 0 to the end; `progress` hears of every step as the part of the time that is done.
///
/// # Errors
/// [`SolveFailure`] with the time, iterations and residual of the step that failed, and everything before it.
pub fn solve(
    model: &Model,
    options: &Dynamics,
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Solution, Box<SolveFailure>> {
    solve_through(model, options, &[], progress)
}

/// The same with a step that ends exactly at every one of `milestones` [s]; those that are not between the start and
/// the end do not count. Constant steps are then, between every two of them, the fewest equal ones that are no longer
/// than the time step.
///
/// # Errors
/// As [`solve`].
pub fn solve_through(
    model: &Model,
    options: &Dynamics,
    milestones: &[f64],
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Solution, Box<SolveFailure>> {
    let mut run = Run::new(model, options);
    let outcome = run.follow(options, milestones, progress);
    let mut solution = run.recorder.finish(model, &run.reached, run.statistics);
    let given = options.time_step().filter(|_| milestones.is_empty());
    let step = given.unwrap_or(run.shortest);
    solution.warnings.extend(joint_noise(model, options.method, step, &solution));
    solution.warnings.extend(run.balance.and_then(|balance| balance.warning()));
    match outcome {
        Ok(()) => Ok(solution),
        Err(error) => Err(Box::new(SolveFailure { error, partial: solution })),
    }
}

/// Where the motion is: state, velocities and accelerations at one time, and memory.
pub(crate) struct Moving<'a> {
    pub model: &'a Model,
    pub state: State,
    pub motion: Motion,
    pub work: Workspace,
}

impl<'a> Moving<'a> {
    pub(crate) fn new(model: &'a Model) -> Self {
        let velocities = model.initial_velocities();
        let accelerations = vec![Velocity::default(); velocities.len()];
        Self {
            model,
            state: model.reference.clone(),
            motion: Motion { velocities, accelerations },
            work: Workspace::new(model, Coordinates::Increments),
        }
    }

    /// Energies of what was evaluated last.
    fn energies(&self) -> Energies {
        let mut result = Energies::default();
        let poses = self.state.poses();
        for (rod, work) in self.model.rods.iter().zip(&self.work.rods) {
            let velocities = &self.motion.velocities[rod.range.clone()];
            result.kinetic += rod.kernel.kinetic_energy(&rod.properties, velocities);
            result.strain += rod.kernel.strain_energy(&rod.properties, &work.constitutive);
            for (weight, pose) in rod.weights.iter().zip(&poses[rod.range.clone()]) {
                result.gravity -= weight.dot(&(rod.origin + pose.position));
            }
        }
        for body in &self.model.bodies {
            result.kinetic += body.mass.kinetic_energy(&self.motion.velocities[body.node]);
            result.gravity -= body.weight.dot(&(body.origin + poses[body.node].position));
        }
        // All rows of every joint, also those that are not imposed.
        result.constraint = self.work.gaps.iter().fold(0.0, |largest, gap| gap.amax().max(largest));
        result
    }
}

/// The load level at a time.
pub(crate) fn level(time: f64) -> LoadLevel {
    LoadLevel { load_factor: time, preload: 1.0 }
}

/// A method that follows the motion in time.
trait Integrator {
    /// Moves on by `length` to `time`; everything of `moving` is evaluated there.
    fn step(
        &mut self,
        moving: &mut Moving,
        time: f64,
        length: f64,
        newton: &Newton,
        statistics: &mut Statistics,
    ) -> Result<Converged, NotConverged>;

    /// Begins anew at a time, for a step of a length, with accelerations that no step has led to.
    fn restart(&mut self, moving: &mut Moving, time: f64, length: f64) -> Result<(), StopReason>;

    /// Forgets the last step, converged or not, so that the next one starts where that one did.
    fn undo(&mut self);

    /// What is known of the error of a step.
    fn leading(&self) -> Leading;

    /// q^{(p+1)} of every node in the last step, which has led to `moving`: of its position, inertial, and of its
    /// rotation as an angle in its own basis.
    fn derivatives(&self, moving: &Moving, derivatives: &mut [Velocity]);
}

/// Positions carry the rounding error ε L, accelerations at position level ε L/h², joint forces m ε L/h².
fn joint_noise(model: &Model, method: Method, step: f64, solution: &Solution) -> Option<String> {
    if method != Method::GeneralizedAlpha {
        return None;
    }
    let mass = |node: usize| {
        let body = model.bodies.iter().find(|body| body.node == node);
        body.map_or(0.0, |body| body.mass.mass)
    };
    let inertia = model.couplings.iter().flat_map(|coupling| {
        coupling.nodes.into_iter().flatten().map(move |node| mass(node) * coupling.reach.max(model.size))
    });
    let noise = f64::EPSILON * inertia.fold(0.0, f64::max) / step.powi(2);
    let force = |row: &crate::solution::Row| {
        row.reactions.iter().map(|r| r[0].hypot(r[1]).hypot(r[2])).fold(0.0, f64::max)
    };
    let largest = solution.rows.iter().map(force).fold(0.0, f64::max);
    (largest > 0.0 && noise > NOISE * largest).then(|| {
        format!(
            "steps are so short that joint forces carry rounding noise of about {:.0e} of the largest; \
             positions and velocities do not",
            noise / largest
        )
    })
}

/// Six numbers a node for the linear system.
pub(crate) fn rows(velocity: &Velocity) -> [f64; NODE] {
    let (v, w) = (&velocity.translation, &velocity.rotation);
    [v.x, v.y, v.z, w.x, w.y, w.z]
}
