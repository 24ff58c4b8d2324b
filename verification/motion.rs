//! Scenes that vibrate or move, and what the integrator makes of a single degree of freedom.

use std::error::Error;

use cosserat::scene::{Joint, JointKind, Scene};
use cosserat::solution::Solution;
use cosserat::{Model, dynamics, modes};
use nalgebra::Vector3;

/// Builds a scene with `[modes]` and solves it.
pub fn vibrate(scene: &Scene) -> Result<Solution, Box<dyn Error>> {
    let options = scene.modes.clone().ok_or("the scene asks for no modes")?;
    Ok(modes::solve(&Model::new(scene)?, &options, &mut |_, _| ())?)
}

/// The angular frequencies of a scene with `[modes]`.
pub fn frequencies(scene: &Scene) -> Result<Vec<f64>, Box<dyn Error>> {
    Ok(vibrate(scene)?.modes.iter().map(|mode| mode.angular_frequency).collect())
}

/// Builds a scene with `[dynamics]` and solves it.
pub fn follow(scene: &Scene) -> Result<Solution, Box<dyn Error>> {
    let options = scene.dynamics.clone().ok_or("the scene asks for no motion")?;
    Ok(dynamics::solve(&Model::new(scene)?, &options, &mut |_, _| ())?)
}

/// A joint between two parts.
pub fn joint(kind: JointKind, first: &str, second: &str, axis: Option<[f64; 3]>) -> Joint {
    Joint { name: None, kind, between: [first.to_string(), second.to_string()], point: None, axis }
}

/// Where probe `index` is in row `row`.
pub fn place(solution: &Solution, row: usize, index: usize) -> Vector3<f64> {
    Vector3::from(solution.rows[row].probes[index].position)
}

/// The first-order generalized-α method on q̇ = u, u̇ + ω² q = f, written down once more: the recursion that a modal
/// amplitude, or with ω = 0 a centre of mass, follows exactly.
#[derive(Clone, Copy, Debug)]
pub struct Recursion {
    alpha_m: f64,
    alpha_f: f64,
    gamma: f64,
    stiffness: f64,
    /// q.
    pub position: f64,
    velocity: f64,
    acceleration: f64,
    average_velocity: f64,
    average_acceleration: f64,
}

impl Recursion {
    /// At rest in q = 0, with ω² and f at the start.
    pub fn new(spectral_radius: f64, stiffness: f64, force: f64) -> Self {
        let rho = spectral_radius;
        let (alpha_m, alpha_f) = ((3.0 * rho - 1.0) / (2.0 * (1.0 + rho)), rho / (1.0 + rho));
        Self {
            alpha_m,
            alpha_f,
            gamma: 0.5 + alpha_f - alpha_m,
            stiffness,
            position: 0.0,
            velocity: 0.0,
            acceleration: force,
            average_velocity: 0.0,
            average_acceleration: force,
        }
    }

    /// One step of length h to where the force is f; returns q.
    pub fn step(&mut self, h: f64, force: f64) -> f64 {
        let Self { alpha_m, alpha_f, gamma, .. } = *self;
        // a₊ = known + c ẏ₊
        let c = (1.0 - alpha_f) / (1.0 - alpha_m);
        let known = |rate: f64, average: f64| (alpha_f * rate - alpha_m * average) / (1.0 - alpha_m);
        let known_velocity = known(self.velocity, self.average_velocity);
        let known_acceleration = known(self.acceleration, self.average_acceleration);
        // u₊ = u* + b u̇₊, q₊ = q* + b u₊
        let b = h * gamma * c;
        let u = self.velocity + h * ((1.0 - gamma) * self.average_acceleration + gamma * known_acceleration);
        let q = self.position + h * ((1.0 - gamma) * self.average_velocity + gamma * known_velocity);
        self.acceleration = (force - self.stiffness * (q + b * u)) / (1.0 + b * b * self.stiffness);
        self.average_acceleration = known_acceleration + c * self.acceleration;
        self.velocity = u + b * self.acceleration;
        self.average_velocity = known_velocity + c * self.velocity;
        self.position = q + b * self.velocity;
        self.position
    }
}
