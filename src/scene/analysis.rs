//! The three analyses and their settings.

use serde::{Deserialize, Serialize};

use super::Scene;

/// What a scene asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Analysis<'a> {
    /// Static equilibrium along the load factor.
    Statics(&'a Statics),
    /// The motion in time.
    Dynamics(&'a Dynamics),
    /// Small vibrations about the static equilibrium.
    Modes(&'a Modes),
}

impl Scene {
    /// The analysis of a validated scene; `None` where there is none.
    pub fn analysis(&self) -> Option<Analysis<'_>> {
        let statics = self.statics.as_ref().map(Analysis::Statics);
        let dynamics = self.dynamics.as_ref().map(Analysis::Dynamics);
        statics.or(dynamics).or(self.modes.as_ref().map(Analysis::Modes))
    }
}

/// The static analysis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Statics {
    /// Number of equal load increments; absent: automatic.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub increments: Option<usize>,
    /// Absolute max-norm of the residual [N, N m]; absent: the unit-free test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The iteration.
    pub newton: NewtonKind,
    /// Largest number of iterations in one increment; an automatic one is retried, smaller, after twelve.
    pub max_iterations: usize,
    /// The unknowns of the linear systems.
    pub coordinates: Coordinates,
}

impl Default for Statics {
    fn default() -> Self {
        Self {
            increments: None,
            tolerance: None,
            newton: NewtonKind::Mixed,
            max_iterations: 50,
            coordinates: Coordinates::Increments,
        }
    }
}

/// The Newton iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NewtonKind {
    /// The stress of the geometric tangent is an iterate of its own (Magisano, Leonetti & Garcea 2017).
    #[default]
    Mixed,
    /// The plain iteration.
    Displacement,
}

/// The unknowns of the linear systems; the solution is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinates {
    /// 6 a node: (δr, δφ), the rotation updated by the exponential.
    #[default]
    Increments,
    /// 7 a node: (r, P) with the unit constraints, the paper's system (16) and (17).
    Quaternions,
}

/// The motion in time from the reference configuration, rods at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "DynamicsTable", into = "DynamicsTable")]
pub struct Dynamics {
    /// Where the motion ends; it starts at 0 [s].
    pub end_time: f64,
    /// How long the steps are: in a scene file exactly one of `time_step` and `accuracy`.
    pub step: Step,
    /// The integrator.
    pub method: Method,
    /// ρ∞ of the generalized-α method: 1 damps nothing, 0 removes what a step cannot resolve. In [0, 1), without
    /// joints that need multipliers also 1.
    pub spectral_radius: f64,
    /// Absolute max-norm of the residual [N, N m; m, rad for joints]; absent: the unit-free test.
    pub tolerance: Option<f64>,
    /// The iteration.
    pub newton: NewtonKind,
    /// Largest number of iterations in one step.
    pub max_iterations: usize,
}

/// How long the steps of a motion are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// `time_step`: all as long as this; the last one is shorter where it does not divide the end time [s].
    Constant(f64),
    /// `accuracy`: what the errors of the steps may sum up to over the whole motion, at the node where they are
    /// largest: of positions as a part of the length of the shortest rod (of the longest lever from a body to a joint
    /// where there is no rod, of 1 m where there is neither), of rotations in radians.
    ///
    /// Every step may have the part of it that it has of the end time, and is as long as that allows; none is longer
    /// than a hundredth of the end time. The error at the end is of this order, up to about three times as much, and
    /// proportional to it; motions that amplify errors have more. Joints' forces, and swings by less than half the
    /// accuracy that steps are too long for, are not held to it. With `radau` the error is estimated by a formula of
    /// order 3 and is much smaller than that.
    Accuracy(f64),
}

/// `[dynamics]` as it is written.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DynamicsTable {
    end_time: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    time_step: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    accuracy: Option<f64>,
    #[serde(default)]
    method: Method,
    #[serde(default = "default_spectral_radius")]
    spectral_radius: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    #[serde(default)]
    newton: NewtonKind,
    #[serde(default = "default_max_iterations")]
    max_iterations: usize,
}

/// Whether `time_step` and `accuracy` are given; `None` for what is no table of this kind otherwise.
pub(super) fn steps_given(table: &toml::Value) -> Option<[bool; 2]> {
    let table: DynamicsTable = table.clone().try_into().ok()?;
    Some([table.time_step.is_some(), table.accuracy.is_some()])
}

impl TryFrom<DynamicsTable> for Dynamics {
    type Error = &'static str;

    fn try_from(table: DynamicsTable) -> Result<Self, Self::Error> {
        let DynamicsTable { end_time, method, spectral_radius, tolerance, newton, max_iterations, .. } =
            table;
        let step = match (table.time_step, table.accuracy) {
            (Some(time_step), None) => Step::Constant(time_step),
            (None, Some(accuracy)) => Step::Accuracy(accuracy),
            _ => return Err("needs exactly one of `time_step` and `accuracy`"),
        };
        Ok(Self { end_time, step, method, spectral_radius, tolerance, newton, max_iterations })
    }
}

impl From<Dynamics> for DynamicsTable {
    fn from(options: Dynamics) -> Self {
        let Dynamics { end_time, step, method, spectral_radius, tolerance, newton, max_iterations } = options;
        let (time_step, accuracy) = match step {
            Step::Constant(time_step) => (Some(time_step), None),
            Step::Accuracy(accuracy) => (None, Some(accuracy)),
        };
        Self { end_time, time_step, accuracy, method, spectral_radius, tolerance, newton, max_iterations }
    }
}

impl Dynamics {
    /// The settings of a scene file that gives only the two times [s].
    pub fn new(end_time: f64, time_step: f64) -> Self {
        Self::with(end_time, Step::Constant(time_step))
    }

    /// The settings of a scene file that gives only the end time [s] and the accuracy.
    pub fn accurate(end_time: f64, accuracy: f64) -> Self {
        Self::with(end_time, Step::Accuracy(accuracy))
    }

    fn with(end_time: f64, step: Step) -> Self {
        Self {
            end_time,
            step,
            method: Method::default(),
            spectral_radius: default_spectral_radius(),
            tolerance: None,
            newton: NewtonKind::default(),
            max_iterations: default_max_iterations(),
        }
    }

    /// The constant time step [s]; `None` where the steps follow an accuracy.
    pub fn time_step(&self) -> Option<f64> {
        match self.step {
            Step::Constant(time_step) => Some(time_step),
            Step::Accuracy(_) => None,
        }
    }
}

fn default_spectral_radius() -> f64 {
    0.8
}

fn default_max_iterations() -> usize {
    50
}

/// The time integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// First-order generalized-α (Jansen, Whiting & Hulbert 2000) on positions and velocities, joints at position
    /// level; order 2.
    #[default]
    GeneralizedAlpha,
    /// Radau IIA with three stages, order 5: dear, for answers that tell the time error from the space error.
    Radau,
}

/// Small vibrations about the static equilibrium under the scene's loads and gravity, or about the reference
/// without any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Modes {
    /// Number of modes, from the lowest frequency.
    pub count: usize,
}
