//! The motion in time: M u̇ + fᵍʸʳ(u) = fⁱⁿᵗ(q) + fᵉˣᵗ(t, q) + Gᵀ(q) λ, q̇ = B(q) u, g(q) = 0, from the reference with
//! the velocities given, eq. (10) to (15). The gyroscopic force has the sign that conserves angular momentum.

mod balance;
mod generalized_alpha;
mod radau;
mod start;

use crate::assembly::{LoadLevel, Motion, Workspace};
use crate::inertia::Velocity;
use crate::linear_solver::NODE;
use crate::model::{JointModel, Model};
use crate::newton::{Converged, Newton, NotConverged, Test};
use crate::recorder::Recorder;
use crate::scene::{Coordinates, Dynamics, Method};
use crate::solution::{Energies, Solution, SolveError, SolveFailure, Statistics, StopReason};
use crate::state::State;
use balance::Balance;
use generalized_alpha::GeneralizedAlpha;
use radau::Radau;

/// A last step that is shorter than this part of the others is merged with the one before it.
const SHORTEST_STEP: f64 = 1e-6;

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
    let mut run = Run {
        motion: Moving::new(model),
        newton: Newton {
            kind: options.newton,
            test: options.tolerance.map_or(Test::Relative, Test::Absolute),
            max_iterations: options.max_iterations,
        },
        statistics: Statistics::default(),
        recorder: Recorder::new(model, options.end_time),
        time: 0.0,
        reached: model.reference.clone(),
        balance: None,
    };
    let outcome = run.follow(options, progress);
    let mut solution = run.recorder.finish(model, &run.reached, run.statistics);
    solution.warnings.extend(joint_noise(model, options, &solution));
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
}

struct Run<'a> {
    motion: Moving<'a>,
    newton: Newton,
    statistics: Statistics,
    recorder: Recorder,
    /// The last time that was reached, and the state there: Newton's last iterate may be anywhere.
    time: f64,
    reached: State,
    /// From the start on.
    balance: Option<Balance>,
}

impl Run<'_> {
    fn follow(
        &mut self,
        options: &Dynamics,
        progress: &mut dyn FnMut(f64, &Statistics),
    ) -> Result<(), SolveError> {
        let step = options.time_step;
        let started = start::accelerate(&mut self.motion, 0.0, step);
        let recorded = started.and_then(|()| {
            let (power, energies) = (self.power(0.0)?, self.motion.energies());
            self.balance = Some(Balance::new(self.motion.model, step, power, &energies));
            self.record(0.0, energies)
        });
        recorded.map_err(|reason| SolveError::InitialAcceleration { reason })?;
        let mut integrator: Box<dyn Integrator> = match options.method {
            Method::GeneralizedAlpha => {
                let method = GeneralizedAlpha::new(options.spectral_radius, step, &mut self.motion);
                Box::new(method.map_err(|reason| SolveError::InitialAcceleration { reason })?)
            }
            Method::Radau => Box::new(Radau::new(&self.motion)),
        };
        let mut index = 0;
        while self.time < options.end_time {
            index += 1;
            let next = index as f64 * step;
            let last = options.end_time - next < SHORTEST_STEP * step;
            let time = if last { options.end_time } else { next };
            let length = time - self.time;
            let converged = integrator
                .step(&mut self.motion, time, length, &self.newton, &mut self.statistics)
                .and_then(|converged| {
                    let Converged { iterations, residual } = converged;
                    self.accept(time, length).map_err(|reason| NotConverged {
                        iterations,
                        residual,
                        reason,
                    })?;
                    Ok(converged)
                })
                .map_err(|stop| self.error(time, &stop))?;
            self.time = time;
            self.reached.clone_from(&self.motion.state);
            self.statistics.increments += 1;
            self.statistics.most_iterations = self.statistics.most_iterations.max(converged.iterations);
            self.statistics.residual = self.statistics.residual.max(converged.residual);
            progress(time / options.end_time, &self.statistics);
        }
        Ok(())
    }

    /// Checks what a step that converged has led to, and records it.
    fn accept(&mut self, time: f64, length: f64) -> Result<(), StopReason> {
        self.check_dependent()?;
        let (power, energies) = (self.power(time)?, self.motion.energies());
        if let Some(balance) = &mut self.balance {
            balance.add(length, power, &energies)?;
        }
        self.record(time, energies)
    }

    fn power(&self, time: f64) -> Result<f64, StopReason> {
        let Moving { model, state, motion, work } = &self.motion;
        work.load_power(model, state, &level(time), &motion.velocities)
    }

    fn record(&mut self, time: f64, energies: Energies) -> Result<(), StopReason> {
        self.recorder.record(self.motion.model, time, &self.motion.state, &self.motion.work)?;
        self.recorder.record_energies(energies);
        Ok(())
    }

    /// A constraint that followed from others at the start and is not imposed must go on following.
    fn check_dependent(&self) -> Result<(), StopReason> {
        let model = self.motion.model;
        for (index, (coupling, gap)) in model.couplings.iter().zip(&self.motion.work.gaps).enumerate() {
            for row in (0..coupling.constraint.rows()).filter(|row| !coupling.rows.contains(row)) {
                let size = if row < 3 { coupling.reach.max(model.size) } else { 1.0 };
                if gap[row].abs() > DEPARTED * size {
                    let is_it = |joint: &JointModel| matches!(joint, JointModel::Coupled(i) if *i == index);
                    let joint = model.joints.iter().position(is_it).unwrap_or(index);
                    return Err(StopReason::Departed { joint });
                }
            }
        }
        Ok(())
    }

    fn error(&self, time: f64, stop: &NotConverged) -> SolveError {
        let NotConverged { iterations, residual, reason } = *stop;
        SolveError::Step {
            time,
            iterations,
            residual,
            tolerance: self.newton.test.tolerance(),
            reason,
            steps: self.statistics.increments,
            reached: self.time,
        }
    }
}

/// A constraint that is not imposed has departed when it is off by this part of the mechanism's size: far above what
/// rounding and the tolerance leave, far below what one sees.
const DEPARTED: f64 = 1e-6;

/// Positions carry the rounding error ε L, accelerations at position level ε L/h², joint forces m ε L/h².
fn joint_noise(model: &Model, options: &Dynamics, solution: &Solution) -> Option<String> {
    if options.method != Method::GeneralizedAlpha {
        return None;
    }
    let mass = |node: usize| {
        let body = model.bodies.iter().find(|body| body.node == node);
        body.map_or(0.0, |body| body.mass.mass)
    };
    let inertia = model.couplings.iter().flat_map(|coupling| {
        coupling.nodes.into_iter().flatten().map(move |node| mass(node) * coupling.reach.max(model.size))
    });
    let noise = f64::EPSILON * inertia.fold(0.0, f64::max) / options.time_step.powi(2);
    let force = |row: &crate::solution::Row| {
        row.reactions.iter().map(|r| r[0].hypot(r[1]).hypot(r[2])).fold(0.0, f64::max)
    };
    let largest = solution.rows.iter().map(force).fold(0.0, f64::max);
    (largest > 0.0 && noise > NOISE * largest).then(|| {
        format!(
            "the time step is so short that joint forces carry rounding noise of about {:.0e} of the largest; \
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
