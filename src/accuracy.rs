//! A scene solved to an accuracy that is asked for, with an estimate of the error of what is returned.
//!
//! Degree, mesh, increments or time step and tolerance are chosen here; geometry, interpolation, node spacing,
//! quadrature, theory and integrator stay the user's. Runs of one sequence, each finer than the one before, are compared
//! over probes and milestones of the whole path, as in [`study`](crate::study). With d₁ and d₂ the distances of the last
//! three, whose sizes (elements, or steps) grow by g₁ and then g₂,
//!
//! ```text
//! q = ln(d₁/d₂)/ln g₁          the order that is observed                                              [–]
//! e = d₂/(g₂^q − 1)            the error of the finest, if the order goes on: e₂ = g₂^q e₃, d₂ = e₂ − e₃
//! ```
//!
//! and three times that is reported, the factor of safety of a grid convergence index (Roache, Verification and
//! Validation in Computational Science and Engineering, 1998, section 5.6). The order is observed because it is not
//! known: 2p at ends of elements on Gauss–Lobatto nodes, p + 1 inside, others for fits and equal spacing. Where nothing
//! like an order is observed the runs say nothing about the error yet, and another follows.
//!
//! The error of a motion is that of its mesh, estimated with one step, and that of its step, estimated on the finest
//! mesh.

mod estimate;
mod level;
mod search;

use std::fmt;

use serde::Serialize;
use thiserror::Error;

use crate::error::{Error, SceneError};
use crate::model::Model;
use crate::scene::{Analysis, Scene};
use crate::solution::{Solution, SolveError, Statistics};
use crate::study::{Errors, with_probes};
use level::Plan;
use search::{MOST_UNKNOWNS, MOST_WORK, Search};

/// A scene solved to an accuracy, or as near to it as it could be.
#[derive(Clone, Debug)]
pub struct Accurate {
    /// The scene with the settings that were chosen; solved as it is, it has the same solution.
    pub scene: Scene,
    /// Its solution.
    pub solution: Solution,
    /// What is known of its error, and what it took.
    pub report: Report,
}

/// What was asked, how large the error is, and what that took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The accuracy: relative to the length of all rods together, and radians.
    pub asked: f64,
    /// Whether the estimate is no larger.
    pub reached: bool,
    /// Why it is not.
    #[serde(skip)]
    pub shortfall: Option<Shortfall>,
    /// The estimated error, the largest over probes and milestones; absent where too few runs arrived.
    pub estimate: Option<Estimate>,
    /// Number of runs, the one that is returned included.
    pub runs: usize,
    /// Newton iterations of all of them.
    pub newton_iterations: usize,
    /// Factorisations of all of them.
    pub factorizations: usize,
    /// Processor time of all of them [s].
    pub seconds: f64,
    /// What was chosen.
    pub settings: Chosen,
}

/// The two parts of an estimated error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Relative to the length of all rods together [–].
    pub position: f64,
    /// Angle [rad].
    pub rotation: f64,
}

/// The settings that were chosen. Increments are automatic, and Newton's iteration has the unit-free test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chosen {
    /// One for every rod, in the scene's order.
    pub rods: Vec<ChosenMesh>,
    /// Dynamics: the constant step [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step: Option<f64>,
}

/// The mesh of one rod.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChosenMesh {
    /// The rod.
    pub name: String,
    /// Polynomial degree.
    pub degree: usize,
    /// Number of elements.
    pub elements: usize,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { asked, runs, newton_iterations, settings, estimate, .. } = self;
        write!(f, "accuracy {asked:e}: {settings}; estimated error ")?;
        match estimate {
            Some(Estimate { position, rotation }) => {
                write!(f, "{position:.1e} of the length, {rotation:.1e} rad")?
            }
            None => f.write_str("unknown")?,
        }
        write!(f, "; {runs} runs, {newton_iterations} Newton iterations in all")
    }
}

impl Chosen {
    /// What a scene has.
    fn of(scene: &Scene) -> Self {
        let mesh = |rod: &crate::scene::Rod| ChosenMesh {
            name: rod.name.clone(),
            degree: rod.degree,
            elements: rod.elements,
        };
        let time_step = match scene.analysis() {
            Some(Analysis::Dynamics(options)) => options.time_step(),
            _ => None,
        };
        Self { rods: scene.rod.iter().map(mesh).collect(), time_step }
    }
}

impl fmt::Display for Chosen {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut parts: Vec<String> = Vec::new();
        // One rod needs no name.
        for ChosenMesh { name, degree, elements } in &self.rods {
            let of = if self.rods.len() > 1 { format!("{name}: ") } else { String::new() };
            let plural = if *elements == 1 { "" } else { "s" };
            parts.push(format!("{of}{elements} element{plural} of degree {degree}"));
        }
        if let Some(step) = self.time_step {
            parts.push(format!("steps of {step:e} s"));
        }
        f.write_str(&parts.join(", "))
    }
}

/// Why the accuracy is not reached.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Shortfall {
    /// No run arrived.
    #[error(transparent)]
    Solver(#[from] SolveError),
    /// Runs arrived, but the estimate stays above what was asked.
    #[error(
        "the accuracy {asked:e} is not reached after {runs} runs, the finest with {settings}: {reason}; {reached}"
    )]
    Accuracy {
        /// What was asked.
        asked: f64,
        /// All runs.
        runs: usize,
        /// Those of the finest run.
        settings: Chosen,
        /// What ended the refinement.
        reason: Reason,
        /// Its estimate.
        reached: Reached,
    },
}

/// The estimate of the finest run, where there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached(pub Option<Errors>);

impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0 {
            Some(errors) => write!(f, "its error is estimated as {errors}"),
            None => write!(f, "its error cannot be estimated from the runs there are"),
        }
    }
}

/// What ended the refinement.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Reason {
    /// Of all runs together.
    #[error("another run would take the work beyond {MOST_WORK:e} Newton iterations times unknowns")]
    Work,
    /// Of one run.
    #[error("another run would have more than {MOST_UNKNOWNS:e} unknowns")]
    Size,
    /// Rounding, and what Newton's iteration leaves.
    #[error(
        "finer runs come no nearer to each other, down at rounding and the tolerance of Newton's iteration"
    )]
    Noise,
    /// A limit of the scene: nodes may not be more than samples to fit.
    #[error("the scene admits nothing finer: {0}")]
    Limit(String),
    /// Newton's iteration on them.
    #[error("runs with finer meshes or steps fail")]
    Failures,
    /// A path through the milestones, and the plain one.
    #[error("two paths to the whole load end apart, in different equilibria")]
    Paths,
}

/// Solves a scene so that its error, the largest over probes and path, relative to the rods' length for positions and in
/// radians for rotations, is estimated to be no larger than `accuracy`. A scene without probes is judged by its free
/// ends and bodies. `progress` hears the number of the run beside what [`statics::solve`](crate::statics::solve) and
/// [`dynamics::solve`](crate::dynamics::solve) tell.
///
/// Where that is not reached [`Report::shortfall`] says why; the solution is that of the finest run.
///
/// # Errors
/// [`Error`] if the accuracy is not in (0, 1), if the scene is wrong or asks for modes, and if a joint or a load sits on
/// a node that other meshes do not have.
pub fn solve_to(
    scene: &Scene,
    accuracy: f64,
    progress: &mut dyn FnMut(usize, f64, &Statistics),
) -> Result<Accurate, Error> {
    let plan = plan(scene, accuracy)?;
    let mut search = Search::new(plan, accuracy, progress);
    let climb = search.refine();
    search.conclude(scene, climb)
}

/// Whether [`solve_to`] can be asked for this.
///
/// # Errors
/// Those of [`solve_to`].
pub fn check(scene: &Scene, accuracy: f64) -> Result<(), Error> {
    plan(scene, accuracy).map(|_| ())
}

fn plan(scene: &Scene, accuracy: f64) -> Result<Plan, Error> {
    if !(accuracy > 0.0 && accuracy < 1.0) {
        let expected = "a number above 0 and below 1, relative to the rods' length and in radians";
        return Err(SceneError::new("--accuracy", format!("is {accuracy}"), expected).into());
    }
    if matches!(scene.analysis(), Some(Analysis::Modes(_))) {
        let expected = "a scene with `[statics]` or `[dynamics]`";
        return Err(SceneError::new("--accuracy", "is not available yet for frequencies", expected).into());
    }
    // What is wrong with the scene as it is written is said of that, not of a mesh that was chosen here.
    Model::new(scene)?;
    Plan::new(&with_probes(scene), accuracy)
}
