//! The continuous static rod equations solved without finite elements: an independent reference.
//!
//! A cantilever with a dead tip force F and a tip moment, all else free of load: n is the same everywhere, and
//! m + r × F is the same everywhere (inertial components). What is left is an initial value problem in the
//! reference arc length s,
//!
//! ```text
//! r′ = A γ,           γ = e_x + K_γ⁻¹ Aᵀ F,
//! P′ = ½ P ∘ (0, κ),  κ = κ⁰ + K_κ⁻¹ Aᵀ m,   m = m₀ − (r − r₀) × F,
//! ```
//!
//! and three equations m(L) = M for the clamp moment m₀ (Antman, Nonlinear Problems of Elasticity, ch. VIII).
//! It is integrated by Gauss collocation with three stages (order 6; Hairer, Nørsett & Wanner II, table 5.2), which
//! keeps |P| = 1 exactly, and shot at by Newton's method with the load brought up in steps.

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// A rod with e_x along its centreline, constant κ⁰, clamped at s = 0 and loaded at s = L.
#[derive(Clone, Debug)]
pub struct Cantilever {
    /// Length L [m].
    pub length: f64,
    /// diag K_γ = (EA, GA_y, GA_z) [N].
    pub force_stiffness: [f64; 3],
    /// diag K_κ = (GI_t, EI_y, EI_z) [N m²].
    pub moment_stiffness: [f64; 3],
    /// κ⁰ in the cross-section basis [1/m].
    pub reference_curvature: [f64; 3],
    /// Pose of the clamp.
    pub clamp: Station,
    /// Dead tip force, inertial [N].
    pub force: [f64; 3],
    /// Tip moment in the basis of the last cross-section [N m].
    pub body_moment: [f64; 3],
}

/// A pose of the rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// r [m].
    pub position: Vector3<f64>,
    /// A_IK as a quaternion.
    pub rotation: UnitQuaternion<f64>,
}

impl Default for Station {
    fn default() -> Self {
        Self { position: Vector3::zeros(), rotation: UnitQuaternion::identity() }
    }
}

/// A solution and how far it is from that with half as many steps.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Poses at s = k L/intervals, k = 0 … intervals.
    pub stations: Vec<Station>,
    /// Largest change of a position by the second resolution, relative to L.
    pub position_change: f64,
    /// Largest change of a rotation by the second resolution [rad].
    pub rotation_change: f64,
}

/// No clamp moment was found.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("the continuous rod has no solution at load factor {load_factor}: residual {residual:.3e}")]
pub struct NoSolution {
    pub load_factor: f64,
    /// |m(L) − M| over the scale of the moments; 0 where only another equilibrium was found.
    pub residual: f64,
}

/// Least number of steps of the coarser of the two final resolutions, for every [`TURN`] of the reference.
const STEPS: usize = 300;
/// Steps while the load is brought up, for every [`TURN`] of the reference.
const COARSE_STEPS: usize = 60;
/// Angle of the reference that calls for as many steps again [rad].
const TURN: f64 = 20.0;
/// Newton is done when its step is below this share of the scale of the moments: rounding of some hundred steps.
const SMALL: f64 = 1e-12;
/// Newton iterations of a load step that is not too large.
const PATIENCE: usize = 8;
/// How far from its guess such a step may end, relative to the scale of the moments under the full load.
const NEAR: f64 = 0.02;
/// Least share of the load in a step.
const SMALLEST_LOAD: f64 = 1e-5;

impl Cantilever {
    /// Solves and reports the poses at the ends of equal intervals.
    pub fn solve(&self, intervals: usize) -> Result<Shape, NoSolution> {
        let turns = 1 + (Vector3::from(self.reference_curvature).norm() * self.length / TURN) as usize;
        let guess = self.bring_up(turns * COARSE_STEPS)?;
        let steps = (turns * STEPS).div_ceil(intervals);
        let (_, coarse) = self.shoot(1.0, guess, (intervals, steps), 2 * PATIENCE)?;
        let (_, stations) = self.shoot(1.0, guess, (intervals, 2 * steps), 2 * PATIENCE)?;
        let (mut position_change, mut rotation_change) = (0.0_f64, 0.0_f64);
        for (a, b) in coarse.iter().zip(&stations) {
            position_change = position_change.max((a.position - b.position).norm() / self.length);
            rotation_change = rotation_change.max(angle(&a.rotation, &b.rotation));
        }
        Ok(Shape { stations, position_change, rotation_change })
    }

    /// The clamp moment on a coarse resolution, along the path from no load: a slender rod has other equilibria,
    /// so a step counts only if Newton gets there at once and near the extrapolated guess; otherwise it is halved.
    fn bring_up(&self, steps: usize) -> Result<Vector3<f64>, NoSolution> {
        let (mut last, mut before) = ((0.0, Vector3::zeros()), None);
        let mut step: f64 = 0.02;
        while last.0 < 1.0 {
            let factor = (last.0 + step).min(1.0);
            let guess = match before {
                Some((f, m)) => last.1 + (last.1 - m) * ((factor - last.0) / (last.0 - f)),
                None => last.1,
            };
            match self.shoot(factor, guess, (1, steps), PATIENCE) {
                Ok((moment, _)) if (moment - guess).norm() <= NEAR * self.scale(1.0) => {
                    before = Some(last);
                    last = (factor, moment);
                    step *= 1.4;
                }
                found if step < SMALLEST_LOAD => {
                    let residual = found.map_or_else(|failure| failure.residual, |_| 0.0);
                    return Err(NoSolution { load_factor: factor, residual });
                }
                _ => step *= 0.5,
            }
        }
        Ok(last.1)
    }

    /// Of the moments at a load factor.
    fn scale(&self, factor: f64) -> f64 {
        factor * (Vector3::from(self.body_moment).norm() + Vector3::from(self.force).norm() * self.length)
    }

    /// Newton for m₀ with a one-sided difference Jacobian; its error only slows the convergence.
    fn shoot(
        &self,
        factor: f64,
        guess: Vector3<f64>,
        (intervals, steps): (usize, usize),
        max_iterations: usize,
    ) -> Result<(Vector3<f64>, Vec<Station>), NoSolution> {
        let scale = self.scale(factor);
        let mut moment = guess;
        let mut residual = f64::INFINITY;
        for _ in 0..max_iterations {
            let (stations, miss) = self.integrate(factor, &moment, intervals, steps);
            residual = miss.norm() / scale;
            let mut jacobian = Matrix3::zeros();
            for k in 0..3 {
                let mut nearby = moment;
                nearby[k] += 1e-7 * scale;
                let (_, other) = self.integrate(factor, &nearby, 1, intervals * steps);
                jacobian.set_column(k, &((other - miss) / (1e-7 * scale)));
            }
            let step = jacobian.lu().solve(&miss);
            let Some(change) = step.filter(|step| step.iter().all(|x| x.is_finite())) else {
                break;
            };
            if change.norm() <= SMALL * scale {
                return Ok((moment, stations));
            }
            moment -= change;
        }
        Err(NoSolution { load_factor: factor, residual })
    }

    /// The poses for a clamp moment, and Aᵀ m(L) − M.
    fn integrate(
        &self,
        factor: f64,
        clamp_moment: &Vector3<f64>,
        intervals: usize,
        steps: usize,
    ) -> (Vec<Station>, Vector3<f64>) {
        let rod = Loaded {
            cantilever: self,
            force: Vector3::from(self.force) * factor,
            clamp_moment: *clamp_moment,
        };
        let h = self.length / (intervals * steps) as f64;
        let mut now = Point { position: self.clamp.position, quaternion: self.clamp.rotation.into_inner() };
        let station = |point: &Point| Station {
            position: point.position,
            rotation: UnitQuaternion::from_quaternion(point.quaternion),
        };
        let mut stations = vec![station(&now)];
        for _ in 0..intervals {
            for _ in 0..steps {
                now = rod.step(&now, h);
            }
            stations.push(station(&now));
        }
        let end = station(&now);
        let tip = end.rotation.inverse() * rod.moment(&end.position);
        (stations, tip - Vector3::from(self.body_moment) * factor)
    }
}

/// Angle of the rotation from one orientation to another [rad]; through the vector part, exact when small.
pub fn angle(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>) -> f64 {
    let relative = a.inverse() * b;
    2.0 * relative.imag().norm().atan2(relative.w.abs())
}

/// The unknowns (r, P), or their derivative.
#[derive(Clone, Copy)]
struct Point {
    position: Vector3<f64>,
    quaternion: Quaternion<f64>,
}

struct Loaded<'a> {
    cantilever: &'a Cantilever,
    force: Vector3<f64>,
    clamp_moment: Vector3<f64>,
}

impl Loaded<'_> {
    /// m, inertial.
    fn moment(&self, position: &Vector3<f64>) -> Vector3<f64> {
        self.clamp_moment - (position - self.cantilever.clamp.position).cross(&self.force)
    }

    /// (r′, P′).
    fn slope(&self, point: &Point) -> Point {
        let rod = self.cantilever;
        let rotation = UnitQuaternion::from_quaternion(point.quaternion);
        let force = rotation.inverse() * self.force;
        let moment = rotation.inverse() * self.moment(&point.position);
        let gamma = Vector3::x() + force.component_div(&Vector3::from(rod.force_stiffness));
        let kappa = Vector3::from(rod.reference_curvature)
            + moment.component_div(&Vector3::from(rod.moment_stiffness));
        Point {
            position: rotation * gamma,
            quaternion: point.quaternion * Quaternion::from_imag(kappa) * 0.5,
        }
    }

    /// One Gauss step, its stages by fixed-point iteration (a step turns by a small angle only).
    fn step(&self, start: &Point, h: f64) -> Point {
        let root = 15.0_f64.sqrt();
        let a = [
            [5.0 / 36.0, 2.0 / 9.0 - root / 15.0, 5.0 / 36.0 - root / 30.0],
            [5.0 / 36.0 + root / 24.0, 2.0 / 9.0, 5.0 / 36.0 - root / 24.0],
            [5.0 / 36.0 + root / 30.0, 2.0 / 9.0 + root / 15.0, 5.0 / 36.0],
        ];
        let b = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
        let combine = |slopes: &[Point; 3], weights: &[f64; 3]| {
            let mut sum = *start;
            for (slope, weight) in slopes.iter().zip(weights) {
                sum.position += slope.position * (h * weight);
                sum.quaternion += slope.quaternion * (h * weight);
            }
            sum
        };
        let mut slopes = [self.slope(start); 3];
        for _ in 0..60 {
            let next: [Point; 3] = std::array::from_fn(|i| self.slope(&combine(&slopes, &a[i])));
            // By how much the poses would still move, lengths relative to L.
            let change = (0..3).fold(0.0_f64, |change, i| {
                let turn = (next[i].quaternion - slopes[i].quaternion).norm();
                let shift = (next[i].position - slopes[i].position).norm() / self.cantilever.length;
                change.max(h * turn).max(h * shift)
            });
            slopes = next;
            if change < 1e-16 {
                break;
            }
        }
        combine(&slopes, &b)
    }
}
