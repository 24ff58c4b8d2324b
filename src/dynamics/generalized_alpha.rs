//! The first-order generalized-α method (Jansen, Whiting & Hulbert 2000; for constraints at position level in the form
//! of Arnold & Brüls 2007), on positions and velocities alike.
//!
//! ```text
//! (1 − α_m) a₊ + α_m a = (1 − α_f) ẏ₊ + α_f ẏ,   y₊ = y + h [(1 − γ) a + γ a₊],   y = q and y = u
//! α_m = (3ρ − 1)/(2 (1 + ρ)),  α_f = ρ/(1 + ρ),  γ = ½ + α_f − α_m,  ρ the spectral radius at infinity
//! ```
//!
//! with q̇ = B(q) u, and equilibrium and g(q₊) = 0 at the new time. With b = h γ (1 − α_f)/(1 − α_m) and
//! y* = y + h (1 − γ) a + h γ (α_f ẏ − α_m a)/(1 − α_m), both known before the step,
//!
//! ```text
//! u₊ = u* + b u̇₊,   r₊ = r* + b v₊,   P₊ = P* + b Q(P₊) ω₊  ⇒  P₊ = P* ∘ (1, y)/(1 + |y|²),  y = b ω₊/2
//! ```
//!
//! so that accelerations and multipliers are the unknowns, and the step's equations are
//! [[M + b D + b² K, −Gᵀ], [G, 0]] for the increments (δr, δφ) = b² diag(1, Y) δu̇ and b² δλ: well conditioned as
//! h → 0.
//!
//! a stands for ẏ at t + (α_m − α_f) h. Begun with a = ẏ alone, positions are second order all the same, but they leave
//! g(q₊) = 0 by an error of order h² that the first multipliers have to make good: divided by b² it is of order one
//! and takes some forty steps to fade. Hence q's part of the first a has (α_m − α_f) h B(q) u̇ more, with the u̇ that the
//! joints alone ask for, M u̇ = Gᵀ μ, G u̇ = −Ġ u: nothing where the motion starts from rest. (Arnold, Brüls & Cardona
//! 2015 trace the same error; what remains in the first multipliers is of order h.)
//!
//! # Steps of different length
//! With δ = α_m − α_f, a has to stand δ h' after the time that was reached when the next step has the length h':
//!
//! ```text
//! a ← a + δ (h' − h) ÿ,     ÿ ≈ (ẏ₊ − ẏ)/h
//! ```
//!
//! The difference is off by ½ h y⃛, a by O(h²) and y by O(h³) in a step: order 2 remains whatever the lengths, which
//! without the correction would be lost, and joints' forces keep an error of order h where lengths change at random.
//! (Brüls & Arnold 2008 have the same in terms of a multistep method.) At the start h = 0 and ÿ is the above u̇.
//!
//! # The error of a step
//! With a = ẏ + δ h ÿ + E h² y⃛ the recursion gives ½ (1 − α_f) = (1 − α_m)(½ + δ) + E, so E = δ (α_m − ½) = 2 δ²; with
//! γ = ½ − δ a step ends off by
//!
//! ```text
//! C h³ y⃛,     C = E + γ (½ + δ) − 1/6 = 1/12 + δ²
//! ```
//!
//! the trapezoidal rule's for ρ = 1 and that of BDF 2, 1/3, for ρ = 0. For y = P it turns by
//! 2 P̄ ∘ P⃛ = ω̈ + ½ ω × ω̇ − ¼ |ω|² ω, from Ṗ = ½ P ∘ (0, ω). After a kink, where ÿ jumps by Δ, a is off by −δ h Δ and
//! then by −α_m/(1 − α_m) of that from step to step: y by δ h² Δ [1 − α_m − γ] = δ² h² Δ in all, up to the sign.
//!
//! # What grows
//! K is unsymmetric, and a mesh that is coarse for the curvature of its rods has fast modes with ω² < 0 or complex, which
//! [`crate::modes`] names. Such a mode grows like e^{λt}, λ > 0 where ω² = −λ². The step multiplies it by R(λh), which for
//! long steps tends to −ρ. On y' = λ y R = −1 makes the two equations (2 α_m − 1) a = (2 α_f − 1) λ y and −2 y =
//! h (1 − 2γ) a, so
//!
//! ```text
//! |R| < 1  ⇔  λ h > 2 (1 − 2α_m)/((1 − 2γ)(2α_f − 1)) = 4 (1 + ρ)/(1 − ρ)
//! ```
//!
//! 36 for ρ = 0.8: shorter steps than that of the slowest such mode let it grow, until Newton's iteration or the balance
//! of energy stops the run. The remedy is the mesh, not the step.
//!
//! P₊ keeps no norm by itself; after the step it is normalised and its part of a scaled by the same factor:
//! (10) is linear in P, so this turns nothing.

use nalgebra::{Vector3, Vector4};

use super::accuracy::Leading;
use super::{Integrator, Moving, level, start};
use crate::assembly::Residual;
use crate::inertia::{Velocity, spin_from_turn};
use crate::newton::{Converged, Equations, Newton, NotConverged};
use crate::rod::StepVelocity;
use crate::rotation::{quaternion_product, quaternion_rate};
use crate::scene::NewtonKind;
use crate::solution::{Statistics, StopReason};

/// Lengths of steps that differ by less than this part are the same: they are differences of times.
const SAME: f64 = 1e-9;

/// A node's part of y: (r, P) and (v, ω), or one of its rates.
#[derive(Clone, Copy, Debug)]
struct Coordinates {
    position: Vector3<f64>,
    quaternion: Vector4<f64>,
    velocity: Velocity,
}

impl Coordinates {
    /// Σ c_k y_k.
    fn combine<const K: usize>(terms: [(f64, &Self); K]) -> Self {
        let mut sum =
            Self { position: Vector3::zeros(), quaternion: Vector4::zeros(), velocity: Velocity::default() };
        for (factor, term) in terms {
            sum.position += term.position * factor;
            sum.quaternion += term.quaternion * factor;
            sum.velocity.translation += term.velocity.translation * factor;
            sum.velocity.rotation += term.velocity.rotation * factor;
        }
        sum
    }
}

/// The method with its memory.
pub struct GeneralizedAlpha {
    alpha_m: f64,
    alpha_f: f64,
    gamma: f64,
    memory: Memory,
    /// At the start of the last step.
    before: Memory,
    /// ẏ at the start of the step, and y*.
    rates: Vec<Coordinates>,
    known: Vec<Coordinates>,
}

/// What one step leaves to the next.
#[derive(Clone, Debug)]
struct Memory {
    /// a of every node.
    averages: Vec<Coordinates>,
    /// ÿ.
    slopes: Vec<Coordinates>,
    /// a stands (α_m − α_f) times this length after the time that was reached.
    length: f64,
}

impl Memory {
    fn copy_from(&mut self, other: &Self) {
        self.averages.copy_from_slice(&other.averages);
        self.slopes.copy_from_slice(&other.slopes);
        self.length = other.length;
    }
}

impl Memory {
    /// Where no step has led to.
    fn new(start: &mut Moving) -> Result<Self, StopReason> {
        let centripetal = start::centripetal(start)?;
        let slopes = centripetal.iter().zip(start.state.quaternions()).map(|(u, quaternion)| Coordinates {
            position: u.translation,
            quaternion: quaternion_rate(quaternion) * u.rotation,
            velocity: Velocity::default(),
        });
        Ok(Self { averages: rates(start), slopes: slopes.collect(), length: 0.0 })
    }
}

impl GeneralizedAlpha {
    /// From a consistent start.
    pub fn new(spectral_radius: f64, start: &mut Moving) -> Result<Self, StopReason> {
        let rho = spectral_radius;
        let (alpha_m, alpha_f) = ((3.0 * rho - 1.0) / (2.0 * (1.0 + rho)), rho / (1.0 + rho));
        let memory = Memory::new(start)?;
        let rates = rates(start);
        let gamma = 0.5 + alpha_f - alpha_m;
        Ok(Self { alpha_m, alpha_f, gamma, before: memory.clone(), memory, known: rates.clone(), rates })
    }
}

impl Integrator for GeneralizedAlpha {
    fn step(
        &mut self,
        moving: &mut Moving,
        time: f64,
        length: f64,
        newton: &Newton,
        statistics: &mut Statistics,
    ) -> Result<Converged, NotConverged> {
        let Self { alpha_m, alpha_f, gamma, .. } = *self;
        let weight = length * gamma / (1.0 - alpha_m);
        let b = weight * (1.0 - alpha_f);
        self.before.copy_from(&self.memory);
        let Memory { averages, slopes, length: old } = &mut self.memory;
        if (length - *old).abs() > SAME * length {
            let ahead = (alpha_m - alpha_f) * (length - *old);
            for (a, slope) in averages.iter_mut().zip(&*slopes) {
                *a = Coordinates::combine([(1.0, a), (ahead, slope)]);
            }
        }
        *old = length;
        self.rates = rates(moving);
        let now = coordinates(moving);
        for (((known, y), rate), a) in self.known.iter_mut().zip(&now).zip(&self.rates).zip(&*averages) {
            let of_average = length * (1.0 - gamma) - weight * alpha_m;
            *known = Coordinates::combine([(1.0, y), (of_average, a), (weight * alpha_f, rate)]);
        }
        let mut step = Step { moving, known: &self.known, time, length, b };
        let converged = newton.solve(&mut step, statistics)?;

        let after = rates(moving);
        let rates = self.rates.iter().zip(&after);
        for (((a, slope), (before, after)), node) in averages.iter_mut().zip(slopes).zip(rates).zip(0..) {
            let scale = 1.0 / (1.0 - alpha_m);
            *a = Coordinates::combine([
                ((1.0 - alpha_f) * scale, after),
                (alpha_f * scale, before),
                (-alpha_m * scale, a),
            ]);
            *slope = Coordinates::combine([(1.0 / length, after), (-1.0 / length, before)]);
            let norm = moving.state.quaternions()[node].norm();
            a.quaternion /= norm;
            slope.quaternion /= norm;
        }
        moving.state.normalize();
        Ok(converged)
    }

    fn restart(&mut self, moving: &mut Moving, time: f64, length: f64) -> Result<(), StopReason> {
        // Rods without mass are in motion: b as long as the step, as in the step itself.
        start::accelerate(moving, time, length)?;
        self.memory = Memory::new(moving)?;
        Ok(())
    }

    fn undo(&mut self) {
        std::mem::swap(&mut self.memory, &mut self.before);
    }

    fn leading(&self) -> Leading {
        let lag = self.alpha_f - self.alpha_m;
        Leading { order: 2, constant: 1.0 / 12.0 + lag * lag, kink: lag * lag }
    }

    fn derivatives(&self, moving: &Moving, derivatives: &mut [Velocity]) {
        let (slopes, h) = (&self.memory.slopes, self.memory.length);
        for (node, d) in derivatives.iter_mut().enumerate() {
            let jerk = &slopes[node].velocity;
            let (before, after) = (&self.rates[node].velocity, &moving.motion.accelerations[node]);
            let acceleration = (before.rotation + after.rotation) * 0.5;
            let omega = moving.motion.velocities[node].rotation - acceleration * (0.5 * h);
            d.translation = jerk.translation;
            d.rotation =
                jerk.rotation + omega.cross(&acceleration) * 0.5 - omega * (0.25 * omega.norm_squared());
        }
    }
}

/// y.
fn coordinates(moving: &Moving) -> Vec<Coordinates> {
    let nodes = moving.state.poses().iter().zip(moving.state.quaternions()).zip(&moving.motion.velocities);
    nodes
        .map(|((pose, quaternion), velocity)| Coordinates {
            position: pose.position,
            quaternion: *quaternion,
            velocity: *velocity,
        })
        .collect()
}

/// ẏ = (B(q) u, u̇).
fn rates(moving: &Moving) -> Vec<Coordinates> {
    let motion = &moving.motion;
    let nodes = moving.state.quaternions().iter().zip(&motion.velocities).zip(&motion.accelerations);
    nodes
        .map(|((quaternion, velocity), acceleration)| Coordinates {
            position: velocity.translation,
            quaternion: quaternion_rate(quaternion) * velocity.rotation,
            velocity: *acceleration,
        })
        .collect()
}

/// The equations of one step; the iterate is u̇₊ with λ₊, everything else follows.
struct Step<'a, 'm> {
    moving: &'a mut Moving<'m>,
    known: &'a [Coordinates],
    time: f64,
    length: f64,
    b: f64,
}

impl Equations for Step<'_, '_> {
    fn evaluate(&mut self) -> Result<Residual, StopReason> {
        let (b, h) = (self.b, self.length);
        let Moving { model, state, motion, work } = &mut *self.moving;
        // How far nodes and bodies go in the step, for the test of the joints.
        let mut travel = (0.0_f64, 0.0_f64);
        for (node, known) in self.known.iter().enumerate() {
            let (u, rate) = (&mut motion.velocities[node], &motion.accelerations[node]);
            u.translation = known.velocity.translation + rate.translation * b;
            u.rotation = known.velocity.rotation + rate.rotation * b;
            state.set_position(node, known.position + u.translation * b);
            let y = u.rotation * (0.5 * b);
            let turn = Vector4::new(1.0, y.x, y.y, y.z) / (1.0 + y.norm_squared());
            state.set_quaternion(node, quaternion_product(&known.quaternion, &turn));
            travel.0 = travel.0.max(h * u.translation.amax());
            travel.1 = travel.1.max(h * u.rotation.amax());
        }
        work.evaluate(model, state, &level(self.time), Some(motion))?;
        let step = StepVelocity { velocities: &motion.velocities, b };
        Ok(work.residual(model, state, travel, Some(&step)))
    }

    fn step(&mut self, kind: NewtonKind) -> Result<(), StopReason> {
        let b = self.b;
        let Moving { model, state, motion, work } = &mut *self.moving;
        if kind == NewtonKind::Displacement {
            work.reset_stresses();
        }
        let step = StepVelocity { velocities: &motion.velocities, b };
        work.factorize(model, state, &level(self.time), Some(&step))?;
        work.solve(model, state, b * b)?;
        if kind == NewtonKind::Mixed {
            work.advance_stresses(model, state)?;
        }
        for (node, increment) in work.increments.iter().enumerate() {
            let turn = spin_from_turn(&motion.velocities[node].rotation, b);
            let rate = &mut motion.accelerations[node];
            rate.translation += increment.translation / (b * b);
            rate.rotation += turn * increment.rotation / (b * b);
        }
        let multipliers = state.multipliers_mut().iter_mut().zip(&work.multiplier_increments);
        multipliers.for_each(|(multiplier, increment)| *multiplier += increment);
        Ok(())
    }
}
