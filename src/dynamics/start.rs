//! Velocities, accelerations and multipliers that agree with the positions: at the start, and after steps that impose
//! less.

use nalgebra::{Vector3, Vector6};

use super::{Moving, level};
use crate::inertia::Velocity;
use crate::linear_solver::NODE;
use crate::model::Coupling;
use crate::rod::StepVelocity;
use crate::solution::StopReason;
use crate::state::State;

/// Rods without mass have no equation for their acceleration; b² K with b this part of the time step stands in for
/// their mass matrix. Nothing acts on them at the start, so that they follow the others without inertia as b → 0.
pub const MASSLESS: f64 = 1e-4;

/// Makes velocities, accelerations and multipliers at a time consistent with the positions:
///
/// ```text
/// ⎡M  −Gᵀ⎤ ⎡Δu⎤   ⎡  0 ⎤        ⎡M  −Gᵀ⎤ ⎡u̇⎤   ⎡f − fᵍʸʳ⎤
/// ⎣G   0 ⎦ ⎣ μ⎦ = ⎣−G u⎦        ⎣G   0 ⎦ ⎣λ⎦ = ⎣ −Ġ u   ⎦
/// ```
///
/// At the start the first removes what rounding of the scene's numbers leaves of G u, at least kinetic energy; both
/// have the same matrix, which is that of a time step of no length, or where there are rods without mass of the given b.
pub fn accelerate(moving: &mut Moving, time: f64, b: f64) -> Result<(), StopReason> {
    let model = moving.model;
    let nodes = moving.state.poses().len();
    let mut right = vec![0.0; NODE * nodes + moving.state.multipliers().len()];
    let massless = model.rods.iter().any(|rod| rod.properties.inertia.is_none());
    let b = if massless { b } else { 0.0 };
    moving.motion.accelerations.fill(Velocity::default());
    moving.state.multipliers_mut().fill(0.0);
    moving.work.evaluate(model, &moving.state, &level(time), Some(&moving.motion))?;
    factorize(moving, time, b)?;

    for coupling in &model.couplings {
        let rate = gap_rate(coupling, &moving.state, &moving.motion.velocities);
        for (k, &row) in coupling.rows.iter().enumerate() {
            right[NODE * nodes + coupling.first + k] = -rate[row];
        }
    }
    moving.work.solve_right(model, &mut right)?;
    for (u, change) in moving.motion.velocities.iter_mut().zip(right.chunks_exact(NODE).map(velocity)) {
        u.translation += change.translation;
        u.rotation += change.rotation;
    }

    moving.work.evaluate(model, &moving.state, &level(time), Some(&moving.motion))?;
    for (node, row) in right.chunks_exact_mut(NODE).take(nodes).enumerate() {
        row[..3].copy_from_slice(moving.work.forces.force[node].as_slice());
        row[3..].copy_from_slice(moving.work.forces.moment[node].as_slice());
    }
    for rod in &model.rods {
        for support in &rod.supports {
            right[NODE * (rod.range.start + support.node)..][..NODE].fill(0.0);
        }
    }
    set_centripetal(moving, &mut right);
    moving.work.solve_right(model, &mut right)?;
    for (acceleration, row) in moving.motion.accelerations.iter_mut().zip(right.chunks_exact(NODE)) {
        *acceleration = velocity(row);
    }
    moving.state.multipliers_mut().copy_from_slice(&right[NODE * nodes..]);
    moving.work.evaluate(model, &moving.state, &level(time), Some(&moving.motion))
}

/// The part of the accelerations that the joints alone ask for where [`accelerate`] has just been: M u̇ = Gᵀ μ,
/// G u̇ = −Ġ u. Zero at rest.
pub fn centripetal(moving: &mut Moving) -> Result<Vec<Velocity>, StopReason> {
    let nodes = moving.state.poses().len();
    let mut right = vec![0.0; NODE * nodes + moving.state.multipliers().len()];
    set_centripetal(moving, &mut right);
    moving.work.solve_right(moving.model, &mut right)?;
    Ok(right.chunks_exact(NODE).take(nodes).map(velocity).collect())
}

/// Writes −Ġ u to the rows of the joints.
fn set_centripetal(moving: &Moving, right: &mut [f64]) {
    let first = NODE * moving.state.poses().len();
    for coupling in &moving.model.couplings {
        let [a, c] = coupling.poses(&moving.state);
        let [u_a, u_c] = coupling.velocities(&moving.motion.velocities);
        let rate = coupling.constraint.acceleration(a, c, &u_a, &u_c);
        for (k, &row) in coupling.rows.iter().enumerate() {
            right[first + coupling.first + k] = -rate[row];
        }
    }
}

/// From six entries.
fn velocity(row: &[f64]) -> Velocity {
    Velocity {
        translation: Vector3::from_column_slice(&row[..3]),
        rotation: Vector3::from_column_slice(&row[3..]),
    }
}

/// Factorises [[M, −Gᵀ], [G, 0]], with b² K for what has no mass, where the motion was evaluated last.
pub fn factorize(moving: &mut Moving, time: f64, b: f64) -> Result<(), StopReason> {
    let Moving { model, state, work, .. } = moving;
    work.reset_stresses();
    let still = vec![Velocity::default(); state.poses().len()];
    work.factorize(model, state, &level(time), Some(&StepVelocity { velocities: &still, b }))
}

/// G u of a joint; also of its rows that are not imposed.
pub fn gap_rate(coupling: &Coupling, state: &State, velocities: &[Velocity]) -> Vector6<f64> {
    let [a, b] = coupling.poses(state);
    let [u_a, u_b] = coupling.velocities(velocities).map(|u| Vector6::from(super::rows(&u)));
    let [of_a, of_b] = coupling.constraint.jacobian(a, b);
    of_a * u_a + of_b * u_b
}
