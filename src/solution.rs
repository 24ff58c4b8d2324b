//! What a solve returns: rows for every accepted increment, a few shapes, and counted work.

use thiserror::Error;

/// The pose of a probe.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbePose {
    /// Position in the inertial basis [m].
    pub position: [f64; 3],
    /// Unit quaternion `[w, x, y, z]`; w ≥ 0 in the first row, continuous along the rows.
    pub quaternion: [f64; 4],
    /// (α, β, γ) of A = R_x(γ) R_y(β) R_z(α), unwrapped along the rows [rad]; only where the probe asks.
    pub angles: Option<[f64; 3]>,
}

/// One accepted increment; the first row is the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The load factor, or the time [s].
    pub parameter: f64,
    /// One pose for every probe of the scene, in its order.
    pub probes: Vec<ProbePose>,
    /// For every joint (f, m) [N, N m], inertial, at its point, acting on the second of the pair.
    pub reactions: Vec<[f64; 6]>,
}

/// A deformed shape, for plots.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The load factor, or the time [s].
    pub parameter: f64,
    /// For every rod, points of its centreline from ξ = 0 to ξ = 1 [m].
    pub rods: Vec<Vec<[f64; 3]>>,
}

/// Energies and the joints' violation at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Of rods and bodies [J].
    pub kinetic: f64,
    /// ∫ W of the rods, eq. (18), by the quadrature of the internal forces [J].
    pub strain: f64,
    /// −Σ m g·r, zero at the inertial origin [J].
    pub gravity: f64,
    /// Largest position-level violation of a joint [m, rad].
    pub constraint: f64,
}

impl Energies {
    /// Kinetic + strain + gravity [J]; other loads have no share.
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.gravity
    }
}

/// A small free vibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// ω [rad/s]; −|ω| where ω² < 0: the equilibrium is unstable and the mode grows as e^{|ω| t}.
    pub angular_frequency: f64,
    /// For every probe the amplitudes of its displacement (inertial) and rotation vector (inertial); the largest
    /// is 1.
    pub shape: Vec<[f64; 6]>,
}

impl Mode {
    /// f = ω/2π [Hz].
    pub fn frequency(&self) -> f64 {
        self.angular_frequency / std::f64::consts::TAU
    }
}

/// Counted work; integers are the same from run to run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Accepted increments.
    pub increments: usize,
    /// Increments that failed and were retried with a smaller one.
    pub rejected: usize,
    /// Newton iterations, those of rejected increments included.
    pub newton_iterations: usize,
    /// Most Newton iterations in one accepted increment.
    pub most_iterations: usize,
    /// Factorisations of the tangent, those of rejected increments included.
    pub factorizations: usize,
    /// Largest residual that was accepted, in the units of the active test.
    pub residual: f64,
}

/// The solution, or as much of it as converged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solution {
    /// Number of scalar unknowns.
    pub unknowns: usize,
    /// The start and every accepted increment.
    pub rows: Vec<Row>,
    /// Dynamics: one a row; otherwise empty.
    pub energies: Vec<Energies>,
    /// Modes: from the lowest frequency; otherwise empty.
    pub modes: Vec<Mode>,
    /// The start, the end and a few shapes between them.
    pub shapes: Vec<Shape>,
    /// Counted work.
    pub statistics: Statistics,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Why a solve stopped early.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolveError {
    /// Newton's iteration did not reach the tolerance.
    #[error(
        "no equilibrium found at load factor {load_factor:?}: after {iterations} iterations the residual is {residual:.3e}, \
         the tolerance {tolerance:.3e} ({reason}); {increments} increments converged, up to load factor {reached:?}"
    )]
    NotConverged {
        /// The load factor that was tried.
        load_factor: f64,
        /// Iterations spent on it.
        iterations: usize,
        /// The last finite residual, in the units of the active test.
        residual: f64,
        /// What it was held against.
        tolerance: f64,
        /// What ended the iteration.
        reason: StopReason,
        /// Increments that had converged before.
        increments: usize,
        /// The largest load factor that converged.
        reached: f64,
    },
    /// A time step did not reach the tolerance.
    #[error(
        "the step to time {time:?} s failed: after {iterations} iterations the residual is {residual:.3e}, the \
         tolerance {tolerance:.3e} ({reason}); {steps} steps converged, up to time {reached:?} s; shorter steps may \
         pass, or more elements where shorter steps stop earlier"
    )]
    Step {
        /// The time that was tried [s].
        time: f64,
        /// Iterations spent on it.
        iterations: usize,
        /// The last finite residual, in the units of the active test.
        residual: f64,
        /// What it was held against.
        tolerance: f64,
        /// What ended the iteration.
        reason: StopReason,
        /// Steps that had converged before.
        steps: usize,
        /// The last time that converged [s].
        reached: f64,
    },
    /// No step is short enough for the accuracy.
    #[error(
        "no step on from time {reached:?} s was accepted: {obstacle}, after {steps} steps; a larger `accuracy` may \
         pass, or more elements"
    )]
    Accuracy {
        /// The last time that was reached [s].
        reached: f64,
        /// Steps that were accepted before.
        steps: usize,
        /// What is in the way.
        obstacle: Obstacle,
    },
    /// There are no accelerations and joint forces that agree with the start.
    #[error("no accelerations found that agree with the start: {reason}")]
    InitialAcceleration {
        /// What ended the search.
        reason: StopReason,
    },
    /// The frequencies about the equilibrium were not found.
    #[error("no frequencies found: {reason}")]
    Modes {
        /// What ended the search.
        reason: StopReason,
    },
    /// The loads that act at load factor 0 already could not be brought up.
    #[error(
        "no equilibrium found under the loads that act at load factor 0: after {iterations} iterations the residual is \
         {residual:.3e}, the tolerance {tolerance:.3e} ({reason})"
    )]
    Start {
        /// Iterations spent on the last attempt.
        iterations: usize,
        /// The last finite residual, in the units of the active test.
        residual: f64,
        /// What it was held against.
        tolerance: f64,
        /// What ended the iteration.
        reason: StopReason,
    },
}

/// What ended an iteration that did not converge.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum StopReason {
    /// Too many iterations.
    #[error("no more iterations are allowed")]
    Iterations,
    /// Too many automatic increments.
    #[error("automatic increments have become too small to arrive")]
    Increments,
    /// A number overflowed, or the tangent is singular.
    #[error("the tangent is singular or a number overflowed")]
    Singular,
    /// A constraint that followed from others at the start, and was not imposed, does so no longer.
    #[error(
        "a constraint of joint.{joint} followed from those of other joints at the start, was not imposed, and is now \
         violated"
    )]
    Departed {
        /// Index of the joint.
        joint: usize,
    },
    /// Energy appears that no load has brought.
    #[error("kinetic and strain energy exceed the work of all loads more than tenfold")]
    Energy,
    /// Neighbouring nodes are half a turn apart, where the relative rotation has no logarithm.
    #[error("element {element} of rod.{rod} is turned by half a turn between its nodes")]
    HalfTurn {
        /// Index of the rod.
        rod: usize,
        /// Index of the element.
        element: usize,
    },
}

/// Why no step that an accuracy asks for was accepted.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Obstacle {
    /// The estimated error is too large.
    #[error(
        "a step of {length:.3e} s has {excess:.3e} times the error that is allowed, and the shortest is {shortest:.3e} s"
    )]
    Error {
        /// The step that was tried [s].
        length: f64,
        /// Its error over what it may be.
        excess: f64,
        /// The shortest step that is tried [s].
        shortest: f64,
    },
    /// Newton's iteration did not reach the tolerance.
    #[error(
        "in a step of {length:.3e} s the residual after {iterations} iterations is {residual:.3e}, the tolerance \
         {tolerance:.3e} ({reason}), and the shortest is {shortest:.3e} s"
    )]
    Newton {
        /// The step that was tried [s].
        length: f64,
        /// Iterations spent on it.
        iterations: usize,
        /// The last finite residual, in the units of the active test.
        residual: f64,
        /// What it was held against.
        tolerance: f64,
        /// What ended the iteration.
        reason: StopReason,
        /// The shortest step that is tried [s].
        shortest: f64,
    },
    /// There is no end of them.
    #[error("more than {most} steps were tried, the last of {length:.3e} s")]
    Steps {
        /// Most steps, accepted or rejected.
        most: usize,
        /// The last one [s].
        length: f64,
    },
}

/// An early stop with what had converged before it.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{error}")]
pub struct SolveFailure {
    /// Why.
    pub error: SolveError,
    /// What had converged.
    pub partial: Solution,
}
