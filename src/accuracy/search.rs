//! The runs that lead to an accuracy.

use cpu_time::ThreadTime;

use super::estimate::{Sequence, Verdict};
use super::level::{Level, Plan, Refined};
use super::{Accurate, Chosen, Estimate, Reached, Reason, Report, Shortfall};
use crate::error::Error;
use crate::model::Model;
use crate::scene::{Analysis, Scene, Statics};
use crate::solution::{Solution, SolveFailure, Statistics};
use crate::study::{Errors, Stop, Trajectory, Trial, compare, solve};
use crate::{dynamics, statics};

/// Most work of all runs together, Newton iterations times unknowns: about half an hour of one core.
pub(super) const MOST_WORK: f64 = 5e9;
/// Most unknowns of one run: about a gigabyte.
pub(super) const MOST_UNKNOWNS: f64 = 1e6;
/// Most runs in succession that may fail for a mesh or a step that is too coarse; each has twice as many elements or
/// steps as the one before.
const MOST_FAILURES: usize = 8;
/// Below this estimate what Newton's iteration leaves may be a part of the error: 1e-9 of the loads, times the angle by
/// which they turn the rods.
const CLOSE: f64 = 1e-6;
/// Load factors of a second path to the same equilibria.
const SECOND_PATH: usize = 20;
/// With a time error below this the motion is near enough to the true one to say what mesh it needs.
const RESOLVED: f64 = 1e-2;

/// Where a sequence of refinements has ended.
pub(super) struct Climb {
    /// The finest that arrived, or if none did the finest that was tried.
    level: Level,
    /// Its path.
    trajectory: Option<Trajectory>,
    /// Its error.
    estimate: Option<Errors>,
    /// What kept it from its goal.
    halt: Option<Halt>,
}

/// Why a sequence ended before its goal.
enum Halt {
    Reason(Reason),
    /// No run arrived, or could even be set up.
    Stop(Stop),
}

/// Runs of one scene, and what they cost.
pub(super) struct Search<'a> {
    plan: Plan,
    accuracy: f64,
    runs: usize,
    total: Statistics,
    seconds: f64,
    /// Newton iterations times unknowns of all runs.
    work: f64,
    /// Newton iterations of the last run, for the steps between milestones that it had.
    iterations: f64,
    progress: &'a mut dyn FnMut(usize, f64, &Statistics),
}

impl<'a> Search<'a> {
    pub(super) fn new(
        plan: Plan,
        accuracy: f64,
        progress: &'a mut dyn FnMut(usize, f64, &Statistics),
    ) -> Self {
        let total = Statistics::default();
        Self { plan, accuracy, runs: 0, total, seconds: 0.0, work: 0.0, iterations: 0.0, progress }
    }

    /// Looks for the level that reaches the accuracy.
    pub(super) fn refine(&mut self) -> Result<Climb, Error> {
        let first = self.plan.first()?;
        let accuracy = self.accuracy;
        let enough = |errors: &Errors| errors.largest() <= accuracy;
        Ok(match self.plan.scene().analysis() {
            Some(Analysis::Dynamics(_)) if self.plan.scene().rod.is_empty() => {
                self.climb(Refined::Step, first, None, &enough)
            }
            Some(Analysis::Dynamics(_)) => self.follow(first),
            _ => {
                let climb = self.climb(Refined::Mesh, first, None, &enough);
                self.settled(climb)
            }
        })
    }

    /// What Newton's iteration leaves at the milestones is much the same on every mesh, for the increments are, and
    /// the distance of two meshes does not show it. A path with other increments on the same mesh does.
    fn settled(&mut self, climb: Climb) -> Climb {
        let (Some(estimate), Some(trajectory), None) = (climb.estimate, &climb.trajectory, &climb.halt)
        else {
            return climb;
        };
        if estimate.largest() > CLOSE {
            return climb;
        }
        let Some(apart) = self.second_path(&climb.level).and_then(|second| compare(&second, trajectory))
        else {
            return Climb { halt: Some(Halt::Reason(Reason::Failures)), ..climb };
        };
        let estimate = larger(estimate, apart);
        let halt = (estimate.largest() > self.accuracy).then_some(Halt::Reason(Reason::Noise));
        Climb { estimate: Some(estimate), halt, ..climb }
    }

    fn second_path(&mut self, level: &Level) -> Option<Trajectory> {
        let variant = self.plan.variant(level).ok()?;
        let model = Model::new(&variant).ok()?;
        let options = variant.statics.clone().unwrap_or_default();
        let factors: Vec<f64> = (1..=SECOND_PATH).map(|k| k as f64 / SECOND_PATH as f64).collect();
        self.runs += 1;
        let (number, progress) = (self.runs, &mut self.progress);
        let start = ThreadTime::now();
        let solution = statics::solve_through(&model, &options, &factors, &mut |done, work| {
            progress(number, done, work);
        });
        let solution = solution.ok()?;
        self.count(&solution.statistics, level, start);
        Some(Trajectory::new(&model, self.plan.milestones(), &solution))
    }

    /// First the step that resolves the motion, on the coarsest mesh; with that step the mesh, to half of the accuracy;
    /// then the step on that mesh, to what is left of it.
    fn follow(&mut self, first: Level) -> Climb {
        let accuracy = self.accuracy;
        let half = |errors: &Errors| errors.largest() <= 0.5 * accuracy;
        let resolved = |errors: &Errors| errors.largest() <= RESOLVED.max(0.5 * accuracy);
        let coarse = self.climb(Refined::Step, first, None, &resolved);
        let (None, Some(in_time)) = (&coarse.halt, coarse.estimate) else {
            // The error of the mesh is not known.
            return Climb { estimate: None, ..coarse };
        };
        let meshed = self.climb(Refined::Mesh, coarse.level, coarse.trajectory, &half);
        let (None, Some(in_space)) = (&meshed.halt, meshed.estimate) else {
            return Climb { estimate: meshed.estimate.map(|in_space| sum(in_space, in_time)), ..meshed };
        };
        if half(&in_time) {
            return Climb { estimate: Some(sum(in_space, in_time)), ..meshed };
        }
        let enough = |errors: &Errors| sum(*errors, in_space).largest() <= accuracy;
        let fine = self.climb(Refined::Step, meshed.level, meshed.trajectory, &enough);
        Climb { estimate: fine.estimate.map(|in_time| sum(in_space, in_time)), ..fine }
    }

    /// Refines until the goal is met; `known` is the path of the first level where it has been found already.
    fn climb(
        &mut self,
        refined: Refined,
        first: Level,
        known: Option<Trajectory>,
        goal: &dyn Fn(&Errors) -> bool,
    ) -> Climb {
        let mut sequence = Sequence::new(self.plan.belief(refined));
        let mut next = first.clone();
        if let Some(trajectory) = known.clone() {
            sequence.push(first.size(refined), trajectory);
            next = self.plan.finer(&first, refined);
        }
        let mut climb = Climb { level: first, trajectory: known, estimate: None, halt: None };
        let mut failures = 0;
        loop {
            if let Some(reason) = self.beyond(&next) {
                return Climb { halt: Some(Halt::Reason(reason)), ..climb };
            }
            match self.run(&next) {
                Ok(Trial { trajectory, .. }) => {
                    failures = 0;
                    sequence.push(next.size(refined), trajectory.clone());
                    climb = Climb { level: next, trajectory: Some(trajectory), estimate: None, halt: None };
                    let noise = match sequence.verdict() {
                        Verdict::Open => false,
                        Verdict::Converging(estimate) => {
                            climb.estimate = Some(estimate);
                            false
                        }
                        Verdict::Noise(estimate) => {
                            climb.estimate = Some(estimate);
                            true
                        }
                    };
                    if climb.estimate.is_some_and(|estimate| goal(&estimate)) {
                        return climb;
                    }
                    if noise {
                        return Climb { halt: Some(Halt::Reason(Reason::Noise)), ..climb };
                    }
                    next = self.plan.finer(&climb.level, refined);
                }
                Err(Stop::Setup(error)) if climb.trajectory.is_some() => {
                    return Climb { halt: Some(Halt::Reason(Reason::Limit(error.to_string()))), ..climb };
                }
                Err(stop) => {
                    sequence.clear();
                    failures += 1;
                    if failures == MOST_FAILURES {
                        let arrived = climb.trajectory.is_some();
                        let halt = if arrived { Halt::Reason(Reason::Failures) } else { Halt::Stop(stop) };
                        let level = if arrived { climb.level } else { next };
                        return Climb { level, halt: Some(halt), ..climb };
                    }
                    next = self.plan.doubled(&next, refined);
                }
            }
        }
    }

    /// Why a level is not to be run.
    fn beyond(&self, level: &Level) -> Option<Reason> {
        let unknowns = self.plan.unknowns(level);
        if unknowns > MOST_UNKNOWNS {
            return Some(Reason::Size);
        }
        let work = self.iterations * level.steps() * unknowns;
        (self.work + work > MOST_WORK).then_some(Reason::Work)
    }

    /// One run through the milestones.
    fn run(&mut self, level: &Level) -> Result<Trial, Stop> {
        let variant = self.plan.variant(level).map_err(|error| Stop::Setup(error.into()))?;
        self.runs += 1;
        let (number, progress) = (self.runs, &mut self.progress);
        let start = ThreadTime::now();
        let trial = solve(&variant, self.plan.milestones(), &mut |done, work| progress(number, done, work));
        let spent = match &trial {
            Ok(trial) => trial.statistics.clone(),
            // With the step or the increment that failed.
            Err(Stop::Solver(failure)) => failure.partial.statistics.clone(),
            Err(Stop::Setup(_)) => Statistics::default(),
        };
        self.count(&spent, level, start);
        trial
    }

    fn count(&mut self, spent: &Statistics, level: &Level, start: ThreadTime) {
        self.seconds += start.elapsed().as_secs_f64();
        self.total.newton_iterations += spent.newton_iterations;
        self.total.factorizations += spent.factorizations;
        self.iterations = spent.newton_iterations as f64 / level.steps();
        self.work += spent.newton_iterations as f64 * self.plan.unknowns(level);
    }

    /// Solves the level that was found as the program's user would, and says what is known of it; `scene` is what the
    /// search began with.
    pub(super) fn conclude(mut self, scene: &Scene, climb: Result<Climb, Error>) -> Result<Accurate, Error> {
        let Climb { level, trajectory, estimate, halt } = climb?;
        if let Some(Halt::Stop(Stop::Setup(error))) = halt {
            return Err(error);
        }
        let variant = self.plan.variant(&level)?;
        let model = Model::new(&variant)?;
        self.runs += 1;
        let start = ThreadTime::now();
        let (mut solution, failure) = match self.plain(&variant, &model) {
            Ok(solution) => (solution, None),
            Err(stopped) => (stopped.partial, Some(stopped.error)),
        };
        let spent = solution.statistics.clone();
        self.count(&spent, &level, start);
        // Newton's iteration may have found another of several equilibria on another path.
        let path = Trajectory::new(&model, self.plan.milestones(), &solution);
        let apart = trajectory.and_then(|trajectory| compare(&path, &trajectory)).unwrap_or_default();
        let estimate = estimate.map(|estimate| larger(estimate, apart));
        let reason = match halt {
            Some(Halt::Reason(reason)) => Some(reason),
            _ if apart.largest() > self.accuracy => Some(Reason::Paths),
            _ => None,
        };
        for row in &mut solution.rows {
            row.probes.truncate(scene.probe.len());
        }
        let scene = Scene { probe: scene.probe.clone(), ..variant };
        let settings = Chosen::of(&scene);
        let accuracy = |reason| Shortfall::Accuracy {
            asked: self.accuracy,
            runs: self.runs,
            settings: settings.clone(),
            reason,
            reached: Reached(estimate),
        };
        let shortfall = failure.map(Shortfall::Solver).or(reason.map(accuracy));
        let report = Report {
            asked: self.accuracy,
            reached: shortfall.is_none(),
            shortfall,
            estimate: estimate.map(|Errors { position, rotation }| Estimate { position, rotation }),
            runs: self.runs,
            newton_iterations: self.total.newton_iterations,
            factorizations: self.total.factorizations,
            seconds: self.seconds,
            settings,
        };
        Ok(Accurate { scene, solution, report })
    }

    fn plain(&mut self, scene: &Scene, model: &Model) -> Result<Solution, Box<SolveFailure>> {
        let (number, progress) = (self.runs, &mut self.progress);
        let mut progress = |done: f64, work: &Statistics| progress(number, done, work);
        match scene.analysis() {
            Some(Analysis::Dynamics(options)) => dynamics::solve(model, options, &mut progress),
            Some(Analysis::Statics(options)) => statics::solve(model, options, &mut progress),
            Some(Analysis::Modes(_)) | None => statics::solve(model, &Statics::default(), &mut progress),
        }
    }
}

/// Errors of two kinds may add up.
fn sum(a: Errors, b: Errors) -> Errors {
    Errors { position: a.position + b.position, rotation: a.rotation + b.rotation }
}

/// The larger of either part.
fn larger(a: Errors, b: Errors) -> Errors {
    Errors { position: a.position.max(b.position), rotation: a.rotation.max(b.rotation) }
}
