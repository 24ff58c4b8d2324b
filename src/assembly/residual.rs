//! How far a state is from equilibrium, and when that is near enough.

use nalgebra::{Vector3, Vector4};

use super::{LinearSystem, Workspace};
use crate::interpolation::Pose;
use crate::model::{BodyModel, Model, RodModel};
use crate::rod::{NodalForces, StepVelocity};
use crate::state::State;

/// The residual of a state in the two ways of measuring it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// max |f| and |g| over all free rows [N, N m; m, rad], mixed: the paper's test.
    pub absolute: f64,
    /// max over rods and bodies of |R_f|/(F + F₀/τ) and |R_m|/(M + M₀/τ), and over joints of |g| against what their
    /// parts travel, to be held against τ.
    pub relative: f64,
}

/// τ of the unit-free test.
pub const RELATIVE_TOLERANCE: f64 = 1e-9;

impl Workspace {
    /// The residual of what was evaluated last; NaN if a number overflowed. `travel` is what joints may be off by,
    /// (displacement [m], rotation [rad]) times τ; `step` is given in a time step.
    pub fn residual(
        &self,
        model: &Model,
        state: &State,
        travel: (f64, f64),
        step: Option<&StepVelocity>,
    ) -> Residual {
        let mut result = Residual::default();
        if let LinearSystem::Quaternions(_) = self.system {
            // Eq. (17), a pure number in either test.
            let constraint = |sum, p: &Vector4<f64>| largest(sum, (p.norm_squared() - 1.0).abs());
            result.absolute = state.quaternions().iter().fold(0.0, constraint);
            result.relative = result.absolute;
        }
        let mut add = |force, moment, scales: (f64, f64)| {
            result.absolute = largest(result.absolute, largest(force, moment));
            let relative = largest(ratio(force, scales.0), ratio(moment, scales.1));
            result.relative = largest(result.relative, relative);
        };
        for rod in &model.rods {
            let poses = &state.poses()[rod.range.clone()];
            let (mut force, mut moment) = (0.0, 0.0);
            let mut supports = rod.supports.iter().peekable();
            for (node, pose) in poses.iter().enumerate() {
                let index = rod.range.start + node;
                let (f, m) = (&self.forces.force[index], &self.forces.moment[index]);
                if let Some(support) = supports.next_if(|support| support.node == node) {
                    moment = largest(moment, max_norm(&support.free_moment(&pose.rotation, f, m)));
                } else {
                    force = largest(force, max_norm(f));
                    moment = largest(moment, max_norm(m));
                }
            }
            add(force, moment, tolerance_scales(rod, &self.forces, poses));
        }
        for body in &model.bodies {
            let forces = &self.forces;
            let scales = (forces.force_scale[body.node], forces.moment_scale[body.node]);
            let floor = body_floor(body, scales.0, step);
            let (force, moment) = (max_norm(&forces.force[body.node]), max_norm(&forces.moment[body.node]));
            add(
                force,
                moment,
                (scales.0 + floor.0 / RELATIVE_TOLERANCE, scales.1 + floor.1 / RELATIVE_TOLERANCE),
            );
        }
        for (coupling, gap) in model.couplings.iter().zip(&self.gaps) {
            let reach = coupling.poses(state).iter().map(|pose| pose.position.amax()).fold(0.0, f64::max);
            let floor = 8.0 * f64::EPSILON / RELATIVE_TOLERANCE;
            let (mut translation, mut rotation) = (0.0, 0.0);
            for &row in &coupling.rows {
                let side = if row < 3 { &mut translation } else { &mut rotation };
                *side = largest(*side, gap[row].abs());
            }
            add(translation, rotation, (travel.0 + floor * (reach + coupling.reach), travel.1 + floor));
        }
        result
    }
}

/// The larger, or NaN if one is.
fn largest(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// max |v_k|, or NaN if one is (`amax` would pass over it).
fn max_norm(v: &Vector3<f64>) -> f64 {
    largest(v.x.abs(), largest(v.y.abs(), v.z.abs()))
}

/// a/b for a residual and its scale; an unloaded, unstrained rod has 0/0 = 0, and a scale that overflowed
/// (a/∞ = 0 would look converged) gives NaN.
fn ratio(a: f64, b: f64) -> f64 {
    if !b.is_finite() {
        f64::NAN
    } else if a == 0.0 {
        0.0
    } else {
        a / b
    }
}

/// (F₀, M₀) of a body: a moment may vanish to rounding where a force has a lever, and an acceleration is known to
/// ε |u|/b, where u stands for the speeds of the whole body: one that only spins has no velocity to compare with.
fn body_floor(body: &BodyModel, force_scale: f64, step: Option<&StepVelocity>) -> (f64, f64) {
    let noise = 8.0 * f64::EPSILON;
    let lever = noise * force_scale * body.reach;
    let Some(step) = step else { return (0.0, lever) };
    let (u, inertia) = (&step.velocities[body.node], body.mass.inertia.max());
    let size = (inertia / body.mass.mass).sqrt();
    let speed = u.translation.norm() + u.rotation.norm() * size;
    (noise * body.mass.mass * speed / step.b, lever + noise * inertia * speed / (size * step.b))
}

/// (F + F₀/τ, M + M₀/τ): the largest nodal sums of absolute contributions, and the rounding floors.
///
/// A position carries the error ε|r|, a strain 1/J_e · p² times that, hence F₀ = 8 ε C_γ |r| p²/J_e. A matrix
/// entry carries ε, hence 8 ε C_κ p²/J_e in the moments, and γ̄ × n adds J_e F₀.
fn tolerance_scales(rod: &RodModel, forces: &NodalForces, poses: &[Pose]) -> (f64, f64) {
    let largest_of = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let reach = poses.iter().map(|pose| pose.position.amax()).fold(0.0, f64::max);
    let amplification = 8.0 * f64::EPSILON * (rod.degree * rod.degree) as f64 / rod.element_length;
    let force_floor = amplification * rod.properties.stiffness.force.max() * reach;
    let moment_floor =
        amplification * rod.properties.stiffness.moment.max() + force_floor * rod.element_length;
    (
        largest_of(&forces.force_scale[rod.range.clone()]) + force_floor / RELATIVE_TOLERANCE,
        largest_of(&forces.moment_scale[rod.range.clone()]) + moment_floor / RELATIVE_TOLERANCE,
    )
}
