//! Static equilibrium along the load factor: equal increments, or automatic ones that grow, shrink and retry.

use crate::assembly::{LoadLevel, Workspace, place_supports};
use crate::element::Stress;
use crate::interpolation::Increment;
use crate::model::Model;
use crate::newton::{Converged, Equilibrium, Newton, NotConverged, Test};
use crate::recorder::Recorder;
use crate::scene::Statics;
use crate::solution::{Solution, SolveError, SolveFailure, Statistics, StopReason};
use crate::state::State;

/// Solves for the load factors from 0 to 1; `progress` hears of every accepted increment.
pub fn solve(
    model: &Model,
    options: &Statics,
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Solution, Box<SolveFailure>> {
    equilibrium(model, options, progress).map(|(solution, _)| solution)
}

/// The same with an increment that ends at each of the milestones, ascending load factors in (0, 1], so that the
/// paths of different meshes and settings can be compared row by row.
///
/// Equal increments stay as they are: they meet those of the milestones that are multiples of 1/increments.
pub fn solve_through(
    model: &Model,
    options: &Statics,
    milestones: &[f64],
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Solution, Box<SolveFailure>> {
    trace(model, options, milestones, progress).map(|(solution, _)| solution)
}

/// The solution with the state at load factor 1.
pub(crate) fn equilibrium(
    model: &Model,
    options: &Statics,
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<(Solution, State), Box<SolveFailure>> {
    trace(model, options, &[], progress)
}

fn trace(
    model: &Model,
    options: &Statics,
    milestones: &[f64],
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<(Solution, State), Box<SolveFailure>> {
    let mut path = Path::new(model, options, progress);
    let outcome = path.follow(options.increments, milestones);
    let state = path.last.state;
    let solution = path.recorder.finish(model, &state, path.statistics);
    match outcome {
        Ok(()) => Ok((solution, state)),
        Err(error) => Err(Box::new(SolveFailure { error, partial: solution })),
    }
}

/// A converged point of the path.
#[derive(Clone)]
struct Point {
    place: f64,
    state: State,
    /// s of every rod.
    stresses: Vec<Vec<Stress>>,
}

/// The place on the path runs from −1 to 0 while loads that act at λ = 0 already are brought up, then with λ.
fn level(place: f64) -> LoadLevel {
    LoadLevel { load_factor: place.max(0.0), preload: (1.0 + place).min(1.0) }
}

/// Automatic increments: the first is chosen such that the linear answer turns nodes by this angle, or moves
/// them by this fraction of the rod's length.
const FIRST_ROTATION: f64 = 0.6;
/// The first increment where the linear answer is none.
const UNKNOWN_STEP: f64 = 1e-3;
/// Iterations an increment should need; fewer let the next one grow.
const WANTED_ITERATIONS: f64 = 7.0;
/// An increment that needs more is cheaper to retry with a quarter.
const PATIENCE: usize = 12;
/// Smallest increment, in first ones: the path has met a point that no increment of the load can pass.
const SMALLEST: f64 = 1e-6;
/// Milestones nearer than this are where the path is already: it may have got there as a bend of a load.
const SAME_PLACE: f64 = 1e-12;
/// Most increments, accepted or rejected: a path that still creeps after them leads nowhere in useful time.
const MOST_INCREMENTS: usize = 10_000;

struct Path<'a> {
    model: &'a Model,
    newton: Newton,
    work: Workspace,
    statistics: Statistics,
    /// The last converged point and the one before it.
    last: Point,
    before: Option<Point>,
    /// Small equal increments gain by it (a quarter fewer iterations on the spring); automatic ones, which grow
    /// until they are no longer small, do not.
    extrapolate: bool,
    recorder: Recorder,
    progress: &'a mut dyn FnMut(f64, &Statistics),
}

impl<'a> Path<'a> {
    fn new(model: &'a Model, options: &Statics, progress: &'a mut dyn FnMut(f64, &Statistics)) -> Self {
        let work = Workspace::new(model, options.coordinates);
        let stresses = work.rods.iter().map(|rod| rod.stresses.clone()).collect();
        Self {
            model,
            newton: Newton {
                kind: options.newton,
                test: options.tolerance.map_or(Test::Relative, Test::Absolute),
                max_iterations: options.max_iterations,
            },
            work,
            statistics: Statistics::default(),
            last: Point { place: 0.0, state: model.reference.clone(), stresses },
            before: None,
            extrapolate: false,
            recorder: Recorder::new(model, 1.0),
            progress,
        }
    }

    fn follow(&mut self, increments: Option<usize>, milestones: &[f64]) -> Result<(), SolveError> {
        let brought_up = if self.model.loaded_at_start() {
            self.last.place = -1.0;
            let reference = self.last.clone();
            let outcome = self.automatic(0.0, None).map(|_| ());
            self.before = None;
            self.statistics.increments = 0;
            if outcome.is_err() {
                self.last = reference;
            }
            outcome
        } else {
            Ok(())
        };
        // The first row is the start: the undeformed rods where the loads that act at once could not be brought up.
        let start = level(self.last.place);
        self.work
            .evaluate(self.model, &self.last.state, &start, None)
            .and_then(|()| self.recorder.record(self.model, 0.0, &self.last.state, &self.work))
            .map_err(|reason| self.error(0.0, &NotConverged { iterations: 0, residual: 0.0, reason }))?;
        brought_up?;
        match increments {
            Some(count) => self.equal(count),
            None => self.stages(milestones),
        }
    }

    fn equal(&mut self, count: usize) -> Result<(), SolveError> {
        self.extrapolate = true;
        for k in 1..=count {
            let place = k as f64 / count as f64;
            self.attempt(place, self.newton.max_iterations).map_err(|stop| self.error(place, &stop))?;
        }
        Ok(())
    }

    /// Automatic increments from bend to bend of the loads' courses, so that no peak is stepped over, and from
    /// milestone to milestone.
    fn stages(&mut self, milestones: &[f64]) -> Result<(), SolveError> {
        let mut step = None;
        while self.last.place < 1.0 {
            let here = self.last.place;
            let bend = self.model.next_bend(here).unwrap_or(1.0).min(1.0);
            let milestone = milestones.iter().copied().find(|milestone| *milestone > here + SAME_PLACE);
            let end = milestone.map_or(bend, |milestone| milestone.min(bend));
            let next = self.automatic(end, step)?;
            // Beyond a bend the loads grow at another rate: what has been learnt of it holds no more.
            step = (end < bend).then_some(next);
        }
        Ok(())
    }

    /// Goes on to `end` and returns the increment that seems right there; the first is `step`, or found anew.
    fn automatic(&mut self, end: f64, step: Option<f64>) -> Result<f64, SolveError> {
        let mut step = step.unwrap_or_else(|| self.first_step(end));
        let smallest = SMALLEST * step;
        while self.last.place < end {
            let left = end - self.last.place;
            // Two equal steps rather than a full one and a remainder.
            let place = if step >= left {
                end
            } else {
                self.last.place + if 2.0 * step > left { 0.5 * left } else { step }
            };
            match self.attempt(place, self.newton.max_iterations.min(PATIENCE)) {
                Ok(iterations) => step *= (WANTED_ITERATIONS / iterations.max(1) as f64).clamp(0.5, 2.0),
                Err(stop) => {
                    self.statistics.rejected += 1;
                    step = 0.25 * (place - self.last.place);
                    if step < smallest {
                        return Err(self.error(place, &stop));
                    }
                }
            }
            if self.statistics.increments + self.statistics.rejected >= MOST_INCREMENTS
                && self.last.place < end
            {
                let (iterations, residual) = (0, self.statistics.residual);
                return Err(
                    self.error(place, &NotConverged { iterations, residual, reason: StopReason::Increments })
                );
            }
        }
        Ok(step)
    }

    /// The share of the way to `end` on which the linear answer turns or moves no node too far.
    fn first_step(&mut self, end: f64) -> f64 {
        let whole = end - self.last.place;
        let target = level(end);
        let (work, state) = (&mut self.work, &self.last.state);
        self.statistics.newton_iterations += 1;
        self.statistics.factorizations += 1;
        let answered = work
            .evaluate(self.model, state, &target, None)
            .and_then(|()| work.factorize(self.model, state, &target, None))
            .and_then(|()| work.solve(self.model, state, 1.0));
        if answered.is_err() {
            return UNKNOWN_STEP * whole;
        }
        let mut size = 0.0_f64;
        for increment in &work.increments {
            // The largest component: its square may overflow where it does not.
            let moved = increment.translation.amax() / self.model.size;
            size = size.max(increment.rotation.amax()).max(moved);
        }
        if size.is_finite() { whole * (FIRST_ROTATION / size).min(1.0) } else { UNKNOWN_STEP * whole }
    }

    /// Solves at `place` from the last point and accepts, or leaves the last point as it was.
    fn attempt(&mut self, place: f64, max_iterations: usize) -> Result<usize, NotConverged> {
        let mut state = self.last.state.clone();
        for (rod, saved) in self.work.rods.iter_mut().zip(&self.last.stresses) {
            rod.stresses.copy_from_slice(saved);
        }
        if self.extrapolate {
            self.predict(place, &mut state);
        }
        let newton = Newton { max_iterations, ..self.newton };
        let mut equilibrium =
            Equilibrium { model: self.model, level: level(place), state: &mut state, work: &mut self.work };
        let converged = newton.solve(&mut equilibrium, &mut self.statistics)?;
        state.normalize();
        let Converged { iterations, residual } = converged;
        if place > 0.0 {
            self.recorder.record(self.model, place, &state, &self.work).map_err(|reason| NotConverged {
                iterations,
                residual,
                reason,
            })?;
        }
        if self.extrapolate {
            let stresses = self.work.rods.iter().map(|rod| rod.stresses.clone()).collect();
            self.before = Some(std::mem::replace(&mut self.last, Point { place, state, stresses }));
        } else {
            (self.last.place, self.last.state) = (place, state);
            for (saved, rod) in self.last.stresses.iter_mut().zip(&self.work.rods) {
                saved.copy_from_slice(&rod.stresses);
            }
        }
        self.statistics.increments += 1;
        self.statistics.most_iterations = self.statistics.most_iterations.max(iterations);
        self.statistics.residual = self.statistics.residual.max(residual);
        (self.progress)(place.max(0.0), &self.statistics);
        Ok(iterations)
    }

    /// Extrapolates state and stresses along the last increment.
    fn predict(&mut self, place: f64, state: &mut State) {
        let Some(before) = &self.before else { return };
        let factor = (place - self.last.place) / (self.last.place - before.place);
        for node in 0..state.poses().len() {
            let increment = self.last.state.increment_since(&before.state, node);
            state.add(
                node,
                &Increment {
                    translation: increment.translation * factor,
                    rotation: increment.rotation * factor,
                },
            );
        }
        let multipliers = self.last.state.multipliers().iter().zip(before.state.multipliers());
        for (multiplier, (last, before)) in state.multipliers_mut().iter_mut().zip(multipliers) {
            *multiplier = last + (last - before) * factor;
        }
        for rod in &self.model.rods {
            place_supports(rod, state);
        }
        let rods = self.work.rods.iter_mut().zip(&self.last.stresses).zip(&before.stresses);
        for ((rod, last), before) in rods {
            for ((stress, last), before) in rod.stresses.iter_mut().zip(last).zip(before) {
                stress.force = last.force + (last.force - before.force) * factor;
                stress.moment = last.moment + (last.moment - before.moment) * factor;
            }
        }
    }

    /// Places up to 0 belong to the loads that act at load factor 0.
    fn error(&self, place: f64, stop: &NotConverged) -> SolveError {
        let NotConverged { iterations, residual, reason } = *stop;
        let tolerance = self.newton.test.tolerance();
        if place <= 0.0 {
            return SolveError::Start { iterations, residual, tolerance, reason };
        }
        SolveError::NotConverged {
            load_factor: place,
            iterations,
            residual,
            tolerance,
            reason,
            increments: self.statistics.increments,
            reached: self.last.place,
        }
    }
}
