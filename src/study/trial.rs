//! One run of a variant: its path through the milestones, and what it costs.

use cpu_time::ThreadTime;
use thiserror::Error;

use crate::error::Error;
use crate::model::Model;
use crate::scene::{Analysis, Scene, Statics, Step};
use crate::solution::{Solution, SolveFailure, Statistics};
use crate::study::milestones::no_path;
use crate::study::{Milestones, Trajectory};
use crate::{dynamics, statics};

/// A run whose processor time is below this is repeated [s]: single milliseconds are the system's noise.
const SHORT: f64 = 0.05;
/// Most repetitions of a short run.
const MOST_REPEATS: usize = 5;

/// A run that arrived.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Where the probes are at the milestones.
    pub trajectory: Trajectory,
    /// Counted work of the run that passes through the milestones.
    pub statistics: Statistics,
    /// Its processor time, without the building of the model [s].
    pub seconds: f64,
    /// Number of scalar unknowns.
    pub unknowns: usize,
    /// What the solver has to say.
    pub warnings: Vec<String>,
}

/// Why a run has no result.
#[derive(Debug, Error)]
pub enum Stop {
    /// The variant is no scene that can be solved.
    #[error(transparent)]
    Setup(#[from] Error),
    /// The solver stopped early; with what it had done until then.
    #[error(transparent)]
    Solver(#[from] Box<SolveFailure>),
}

/// Solves a variant of a scene through the milestones; `progress` hears of every increment or step, as
/// [`statics::solve`] and [`dynamics::solve`] tell it.
///
/// # Errors
/// [`Stop::Setup`] if the variant is wrong or has no path, [`Stop::Solver`] if the solver stops early.
pub fn solve(
    scene: &Scene,
    milestones: &Milestones,
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Trial, Stop> {
    let model = Model::new(scene)?;
    let start = ThreadTime::now();
    let solution = run(scene, &model, &milestones.parameters(), progress)?;
    let seconds = start.elapsed().as_secs_f64();
    let trajectory = Trajectory::new(&model, milestones, &solution);
    let Solution { statistics, unknowns, warnings, .. } = solution;
    Ok(Trial { trajectory, statistics, seconds, unknowns, warnings })
}

/// What a plain run of a variant costs, one without milestones: counted work and processor time [s], the least of a
/// few runs where one is too short to be measured.
///
/// # Errors
/// As [`solve`].
pub fn time(scene: &Scene, progress: &mut dyn FnMut(f64, &Statistics)) -> Result<(Statistics, f64), Stop> {
    let model = Model::new(scene)?;
    let mut least = f64::INFINITY;
    let mut repeats = 0;
    loop {
        let start = ThreadTime::now();
        let solution = run(scene, &model, &[], progress)?;
        let seconds = start.elapsed().as_secs_f64();
        least = least.min(seconds);
        repeats += 1;
        if least >= SHORT || repeats >= MOST_REPEATS {
            return Ok((solution.statistics, least));
        }
    }
}

fn run(
    scene: &Scene,
    model: &Model,
    milestones: &[f64],
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Solution, Stop> {
    Ok(match scene.analysis() {
        Some(Analysis::Statics(options)) => statics::solve_through(model, options, milestones, progress),
        // A constant step divides the intervals between milestones.
        Some(Analysis::Dynamics(options)) => match options.step {
            Step::Constant(_) => dynamics::solve(model, options, progress),
            Step::Accuracy(_) => dynamics::solve_through(model, options, milestones, progress),
        },
        Some(Analysis::Modes(_)) => return Err(Stop::Setup(Error::Scene(no_path()))),
        None => statics::solve_through(model, &Statics::default(), milestones, progress),
    }?)
}
