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
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// Where the motion ends; it starts at 0 [s].
    pub end_time: f64,
    /// Constant time step; the last one is shorter where it does not divide the end time [s].
    pub time_step: f64,
    /// The integrator.
    #[serde(default)]
    pub method: Method,
    /// ρ∞ of the generalized-α method: 1 damps nothing, 0 removes what a step cannot resolve. In [0, 1), without
    /// joints that need multipliers also 1.
    #[serde(default = "default_spectral_radius")]
    pub spectral_radius: f64,
    /// Absolute max-norm of the residual [N, N m; m, rad for joints]; absent: the unit-free test.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The iteration.
    #[serde(default)]
    pub newton: NewtonKind,
    /// Largest number of iterations in one step.
    #[serde(default = "default_max_iterations")]
    pub max_iterations: usize,
}

impl Dynamics {
    /// The settings of a scene file that gives only the two times [s].
    pub fn new(end_time: f64, time_step: f64) -> Self {
        Self {
            end_time,
            time_step,
            method: Method::default(),
            spectral_radius: default_spectral_radius(),
            tolerance: None,
            newton: NewtonKind::default(),
            max_iterations: default_max_iterations(),
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
