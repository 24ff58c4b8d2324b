//! From step to step: what is checked, recorded and, where steps follow an accuracy, done again.

use super::accuracy::Accuracy;
use super::balance::Balance;
use super::generalized_alpha::GeneralizedAlpha;
use super::radau::Radau;
use super::{Integrator, Moving, level, start, times};
use crate::assembly::Motion;
use crate::element::Stress;
use crate::model::{JointModel, Model};
use crate::newton::{Converged, Newton, NotConverged, Test};
use crate::recorder::Recorder;
use crate::scene::{Dynamics, Method, Step};
use crate::solution::{Energies, Obstacle, SolveError, Statistics, StopReason};
use crate::state::State;

/// Most steps, accepted or rejected, as many as a scene may ask for with a constant step.
const MOST_STEPS: usize = 10_000_000;

/// A bend that follows a time this closely, as a part of the motion, is one with it: a jump.
const JUMP: f64 = 1e-12;

/// After a step this much shorter than the next one, between two milestones that nearly coincide, accelerations are too
/// noisy to go on with.
const NOISY: f64 = 100.0;

/// Where no step is given, this part of the motion stands in for it in the first accelerations of rods without mass.
const TYPICAL: f64 = 1e-3;

/// A constraint that is not imposed has departed when it is off by this part of the mechanism's size: far above what
/// rounding and the tolerance leave, far below what one sees.
const DEPARTED: f64 = 1e-6;

/// A motion on its way.
pub struct Run<'a> {
    motion: Moving<'a>,
    newton: Newton,
    pub statistics: Statistics,
    pub recorder: Recorder,
    /// The last time that was reached, and the state there: Newton's last iterate may be anywhere.
    time: f64,
    pub reached: State,
    /// What else a step is begun anew with: velocities, accelerations, and s of every rod.
    motion_reached: Motion,
    stresses: Vec<Vec<Stress>>,
    /// From the start on.
    pub balance: Option<Balance>,
    /// The shortest step so far [s].
    pub shortest: f64,
}

impl<'a> Run<'a> {
    /// At the start.
    pub fn new(model: &'a Model, options: &Dynamics) -> Self {
        let motion = Moving::new(model);
        Self {
            newton: Newton {
                kind: options.newton,
                test: options.tolerance.map_or(Test::Relative, Test::Absolute),
                max_iterations: options.max_iterations,
            },
            statistics: Statistics::default(),
            recorder: Recorder::new(model, options.end_time),
            time: 0.0,
            reached: model.reference.clone(),
            motion_reached: motion.motion.clone(),
            stresses: motion.work.rods.iter().map(|rod| rod.stresses.clone()).collect(),
            motion,
            balance: None,
            shortest: f64::INFINITY,
        }
    }

    /// To the end.
    pub fn follow(
        &mut self,
        options: &Dynamics,
        milestones: &[f64],
        progress: &mut dyn FnMut(f64, &Statistics),
    ) -> Result<(), SolveError> {
        let end = options.end_time;
        let milestones = times::sorted(milestones, end);
        let typical = options.time_step().unwrap_or(TYPICAL * end);
        let integrator = self.start(options, typical);
        let mut integrator = integrator.map_err(|reason| SolveError::InitialAcceleration { reason })?;
        let mut progress = |time: f64, statistics: &Statistics| progress(time / end, statistics);
        match options.step {
            Step::Constant(step) => {
                let mut before = f64::INFINITY;
                for time in times::constant(step, end, &milestones) {
                    let length = time - self.time;
                    if length > NOISY * before {
                        integrator.restart(&mut self.motion, self.time, length).map_err(|reason| {
                            self.error(time, &NotConverged { iterations: 0, residual: 0.0, reason })
                        })?;
                    }
                    before = length;
                    self.attempt(&mut *integrator, time)
                        .and_then(|converged| self.accept(time, converged))
                        .map_err(|stop| self.error(time, &stop))?;
                    progress(time, &self.statistics);
                }
                Ok(())
            }
            Step::Accuracy(accuracy) => {
                let control = Accuracy::new(accuracy, end, integrator.leading(), &self.motion);
                self.controlled(&mut *integrator, control, (&milestones, end), &mut progress)
            }
        }
    }

    /// Consistent accelerations, the first row, and the method.
    fn start(&mut self, options: &Dynamics, typical: f64) -> Result<Box<dyn Integrator>, StopReason> {
        start::accelerate(&mut self.motion, 0.0, start::MASSLESS * typical)?;
        // With the multipliers.
        self.reached.clone_from(&self.motion.state);
        let (power, energies) = (self.power(0.0)?, self.motion.energies());
        self.balance = Some(Balance::new(power, &energies));
        self.record(0.0, energies)?;
        Ok(match options.method {
            Method::GeneralizedAlpha => {
                Box::new(GeneralizedAlpha::new(options.spectral_radius, &mut self.motion)?)
            }
            Method::Radau => Box::new(Radau::new(&self.motion, options.time_step().is_some())),
        })
    }

    /// Steps as long as the accuracy allows.
    fn controlled(
        &mut self,
        integrator: &mut dyn Integrator,
        mut control: Accuracy,
        (milestones, end): (&[f64], f64),
        progress: &mut dyn FnMut(f64, &Statistics),
    ) -> Result<(), SolveError> {
        let (mut stop, mut bends) = self.next_stop(milestones, end);
        self.keep();
        while self.time < end {
            // Equal steps up to the stop rather than full ones and a remainder.
            let left = stop - self.time;
            let steps = (left / control.length()).ceil();
            let time = if steps > 1.0 { self.time + left / steps } else { stop };
            let length = time - self.time;
            let obstacle = match self.attempt(integrator, time) {
                Ok(converged) => {
                    let excess = control.judge(length, |d| integrator.derivatives(&self.motion, d));
                    if excess <= 1.0 {
                        self.accept(time, converged).map_err(|stop| self.error(time, &stop))?;
                        self.keep();
                        control.accept(length, excess);
                        progress(time, &self.statistics);
                        if time == stop {
                            if bends {
                                control.kink();
                            }
                            (stop, bends) = self.next_stop(milestones, end);
                        }
                        continue;
                    }
                    control.reject(length, excess);
                    Obstacle::Error { length, excess, shortest: control.shortest() }
                }
                Err(stop) => {
                    control.halve(length);
                    self.unsolved(length, control.shortest(), &stop)
                }
            };
            self.statistics.rejected += 1;
            let tried = self.statistics.increments + self.statistics.rejected;
            let obstacle = match obstacle {
                _ if length <= control.shortest() => Some(obstacle),
                _ if tried >= MOST_STEPS => Some(Obstacle::Steps { most: MOST_STEPS, length }),
                _ => None,
            };
            if let Some(obstacle) = obstacle {
                let (reached, steps) = (self.time, self.statistics.increments);
                return Err(SolveError::Accuracy { reached, steps, obstacle });
            }
            self.undo(integrator);
        }
        Ok(())
    }

    /// Where a step has to end next, and whether a load bends there.
    fn next_stop(&self, milestones: &[f64], end: f64) -> (f64, bool) {
        let model = self.motion.model;
        let bend = model.next_bend(self.time + JUMP * end).unwrap_or(f64::INFINITY);
        let milestone = milestones.get(milestones.partition_point(|time| *time <= self.time));
        let stop = bend.min(milestone.copied().unwrap_or(end)).min(end);
        (stop, stop == bend)
    }

    fn unsolved(&self, length: f64, shortest: f64, stop: &NotConverged) -> Obstacle {
        let NotConverged { iterations, residual, reason } = *stop;
        let tolerance = self.newton.test.tolerance();
        Obstacle::Newton { length, iterations, residual, tolerance, reason, shortest }
    }

    /// Moves on to a time.
    fn attempt(&mut self, integrator: &mut dyn Integrator, time: f64) -> Result<Converged, NotConverged> {
        integrator.step(&mut self.motion, time, time - self.time, &self.newton, &mut self.statistics)
    }

    /// Checks what a step that converged has led to, records it and counts it.
    fn accept(&mut self, time: f64, converged: Converged) -> Result<(), NotConverged> {
        let Converged { iterations, residual } = converged;
        self.check(time, time - self.time).map_err(|reason| NotConverged { iterations, residual, reason })?;
        self.shortest = self.shortest.min(time - self.time);
        self.time = time;
        self.reached.clone_from(&self.motion.state);
        self.statistics.increments += 1;
        self.statistics.most_iterations = self.statistics.most_iterations.max(iterations);
        self.statistics.residual = self.statistics.residual.max(residual);
        Ok(())
    }

    fn check(&mut self, time: f64, length: f64) -> Result<(), StopReason> {
        self.check_dependent()?;
        let (power, energies) = (self.power(time)?, self.motion.energies());
        if let Some(balance) = &mut self.balance {
            balance.add(self.motion.model, length, power, &energies)?;
        }
        self.record(time, energies)
    }

    /// Remembers beside the state what a step is begun anew with.
    fn keep(&mut self) {
        self.motion_reached.clone_from(&self.motion.motion);
        for (kept, rod) in self.stresses.iter_mut().zip(&self.motion.work.rods) {
            kept.copy_from_slice(&rod.stresses);
        }
    }

    /// Back to the last time that was reached.
    fn undo(&mut self, integrator: &mut dyn Integrator) {
        let Moving { state, motion, work, .. } = &mut self.motion;
        state.clone_from(&self.reached);
        motion.clone_from(&self.motion_reached);
        for (rod, kept) in work.rods.iter_mut().zip(&self.stresses) {
            rod.stresses.copy_from_slice(kept);
        }
        integrator.undo();
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
