//! Newton's iteration, mixed or plain, and the equilibrium (16) at one load level as its first user.
//!
//! The mixed iteration (Magisano, Leonetti & Garcea 2017) keeps a stress resultant s per quadrature point as an
//! iterate of its own: the geometric tangent is built from s, the residual from the constitutive ŝ(q), and after a
//! step s ← ŝ(q) + C ε′(q) δq with the old q. It is the mixed Hellinger–Reissner form with the stresses condensed
//! out point by point; the solution is the same.

use crate::assembly::{LoadLevel, RELATIVE_TOLERANCE, Residual, Workspace};
use crate::model::Model;
use crate::scene::NewtonKind;
use crate::solution::{Statistics, StopReason};
use crate::state::State;

/// The convergence test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Test {
    /// max |residual| below a number, in mixed units.
    Absolute(f64),
    /// Forces and moments against their own scale and rounding floor, τ = 1e-9.
    Relative,
}

impl Test {
    /// The residual in the units of the test.
    pub fn measure(&self, residual: &Residual) -> f64 {
        match self {
            Self::Absolute(_) => residual.absolute,
            Self::Relative => residual.relative,
        }
    }

    /// What it is held against.
    pub fn tolerance(&self) -> f64 {
        match self {
            Self::Absolute(tolerance) => *tolerance,
            Self::Relative => RELATIVE_TOLERANCE,
        }
    }
}

/// Settings of one iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newton {
    /// Mixed or plain.
    pub kind: NewtonKind,
    /// When to stop.
    pub test: Test,
    /// Largest number of steps.
    pub max_iterations: usize,
}

/// An iteration that converged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converged {
    /// Steps taken.
    pub iterations: usize,
    /// The accepted residual, in the units of the test.
    pub residual: f64,
}

/// An iteration that did not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotConverged {
    /// Steps taken.
    pub iterations: usize,
    /// The last finite residual, in the units of the test.
    pub residual: f64,
    /// What ended it.
    pub reason: StopReason,
}

/// What Newton's iteration solves.
pub trait Equations {
    /// Evaluates the residual where the iterate is.
    fn evaluate(&mut self) -> Result<Residual, StopReason>;

    /// Solves with the tangent there and moves the iterate.
    fn step(&mut self, kind: NewtonKind) -> Result<(), StopReason>;
}

impl Newton {
    /// Moves the iterate to a solution.
    pub fn solve(
        &self,
        equations: &mut dyn Equations,
        statistics: &mut Statistics,
    ) -> Result<Converged, NotConverged> {
        let mut residual = f64::INFINITY;
        let mut iterations = 0;
        let stop = |reason, iterations, residual| NotConverged { iterations, residual, reason };
        loop {
            let now = equations.evaluate().map_err(|reason| stop(reason, iterations, residual))?;
            let now = self.test.measure(&now);
            if !now.is_finite() {
                return Err(stop(StopReason::Singular, iterations, residual));
            }
            residual = now;
            // A small load on a stiff rod may lie below the test's floor before anything has moved: one step at least.
            let untouched = iterations == 0 && residual > 0.0;
            if residual <= self.test.tolerance() && !untouched {
                return Ok(Converged { iterations, residual });
            }
            if iterations == self.max_iterations {
                return Err(stop(StopReason::Iterations, iterations, residual));
            }
            iterations += 1;
            statistics.newton_iterations += 1;
            statistics.factorizations += 1;
            equations.step(self.kind).map_err(|reason| stop(reason, iterations, residual))?;
        }
    }
}

/// The equilibrium (16) at one load level.
pub struct Equilibrium<'a> {
    /// The model.
    pub model: &'a Model,
    /// How much of the loads acts.
    pub level: LoadLevel,
    /// The iterate, with the stresses in the workspace.
    pub state: &'a mut State,
    /// Memory.
    pub work: &'a mut Workspace,
}

impl Equations for Equilibrium<'_> {
    fn evaluate(&mut self) -> Result<Residual, StopReason> {
        self.work.evaluate(self.model, self.state, &self.level, None)?;
        // Joints close to τ of the model's size, and of a radian.
        Ok(self.work.residual(self.model, self.state, (self.model.size, 1.0), None))
    }

    fn step(&mut self, kind: NewtonKind) -> Result<(), StopReason> {
        if kind == NewtonKind::Displacement {
            self.work.reset_stresses();
        }
        self.work.factorize(self.model, self.state, &self.level, None)?;
        self.work.solve(self.model, self.state, 1.0)?;
        if kind == NewtonKind::Mixed {
            self.work.advance_stresses(self.model, self.state)?;
        }
        self.work.update(self.model, self.state);
        Ok(())
    }
}
