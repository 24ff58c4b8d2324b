//! Accelerations and multipliers that agree with the positions and velocities of the start.

use super::{Moving, level};
use crate::linear_solver::NODE;
use crate::rod::StepVelocity;
use crate::solution::StopReason;

/// Rods without mass have no equation for their acceleration; b² K with b this part of the time step stands in for
/// their mass matrix. Nothing acts on them at the start, so that they follow the others without inertia as b → 0.
const MASSLESS: f64 = 1e-4;

/// Makes velocities, accelerations and multipliers consistent:
///
/// ```text
/// ⎡M  −Gᵀ⎤ ⎡Δu⎤   ⎡  0 ⎤        ⎡M  −Gᵀ⎤ ⎡u̇⎤   ⎡f − fᵍʸʳ⎤
/// ⎣G   0 ⎦ ⎣ μ⎦ = ⎣−G u⎦        ⎣G   0 ⎦ ⎣λ⎦ = ⎣ −Ġ u   ⎦
/// ```
///
/// The first removes what rounding of the scene's numbers leaves of G u, at least kinetic energy; both have the same
/// matrix, which is that of a time step of no length.
pub fn accelerate(moving: &mut Moving, time_step: f64) -> Result<(), StopReason> {
    let model = moving.model;
    let nodes = moving.state.poses().len();
    let mut right = vec![0.0; NODE * nodes + moving.state.multipliers().len()];
    let massless = model.rods.iter().any(|rod| rod.properties.inertia.is_none());
    let b = if massless { MASSLESS * time_step } else { 0.0 };
    moving.work.evaluate(model, &moving.state, &level(0.0), Some(&moving.motion))?;
    moving.work.reset_stresses();
    let still = vec![Default::default(); nodes];
    let step = StepVelocity { velocities: &still, b };
    moving.work.factorize(model, &moving.state, &level(0.0), Some(&step))?;

    for coupling in &model.couplings {
        let [a, c] = coupling.poses(&moving.state);
        let parts = coupling.constraint.jacobian(a, c);
        for (k, &row) in coupling.rows.iter().enumerate() {
            let mut rate = 0.0;
            for (part, velocity) in parts.iter().zip(coupling.velocities(&moving.motion.velocities)) {
                rate += part.row(row).iter().zip(super::rows(&velocity)).map(|(g, u)| g * u).sum::<f64>();
            }
            right[NODE * nodes + coupling.first + k] = -rate;
        }
    }
    moving.work.solve_right(model, &mut right)?;
    for (velocity, change) in moving.motion.velocities.iter_mut().zip(right.chunks_exact(NODE)) {
        velocity.translation += nalgebra::Vector3::from_column_slice(&change[..3]);
        velocity.rotation += nalgebra::Vector3::from_column_slice(&change[3..]);
    }

    moving.work.evaluate(model, &moving.state, &level(0.0), Some(&moving.motion))?;
    for (node, row) in right.chunks_exact_mut(NODE).take(nodes).enumerate() {
        row[..3].copy_from_slice(moving.work.forces.force[node].as_slice());
        row[3..].copy_from_slice(moving.work.forces.moment[node].as_slice());
    }
    for rod in &model.rods {
        for support in &rod.supports {
            right[NODE * (rod.range.start + support.node)..][..NODE].fill(0.0);
        }
    }
    for coupling in &model.couplings {
        let [a, c] = coupling.poses(&moving.state);
        let [u_a, u_c] = coupling.velocities(&moving.motion.velocities);
        let rate = coupling.constraint.acceleration(a, c, &u_a, &u_c);
        for (k, &row) in coupling.rows.iter().enumerate() {
            right[NODE * nodes + coupling.first + k] = -rate[row];
        }
    }
    moving.work.solve_right(model, &mut right)?;
    for (acceleration, row) in moving.motion.accelerations.iter_mut().zip(right.chunks_exact(NODE)) {
        acceleration.translation = nalgebra::Vector3::from_column_slice(&row[..3]);
        acceleration.rotation = nalgebra::Vector3::from_column_slice(&row[3..]);
    }
    moving.state.multipliers_mut().copy_from_slice(&right[NODE * nodes..]);
    moving.work.evaluate(model, &moving.state, &level(0.0), Some(&moving.motion))
}
