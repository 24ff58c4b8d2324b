//! What the loads do to the motion.

use super::{LoadLevel, Workspace, line_load};
use crate::inertia::Velocity;
use crate::model::Model;
use crate::solution::StopReason;
use crate::state::State;

impl Workspace {
    /// The power Σ f·u of gravity and of all loads [W].
    pub fn load_power(
        &self,
        model: &Model,
        state: &State,
        level: &LoadLevel,
        velocities: &[Velocity],
    ) -> Result<f64, StopReason> {
        let mut power = 0.0;
        for (index, rod) in model.rods.iter().enumerate() {
            let (poses, u) = (&state.poses()[rod.range.clone()], &velocities[rod.range.clone()]);
            if !rod.line_loads.is_empty() {
                power += rod
                    .kernel
                    .line_load_power(poses, &rod.properties, &line_load(rod, level), u)
                    .map_err(|element| StopReason::HalfTurn { rod: index, element })?;
            }
            for load in &rod.point_loads {
                let (force, moment) = load.rows(&poses[load.node], level.factor(&load.course));
                power += force.dot(&u[load.node].translation) + moment.dot(&u[load.node].rotation);
            }
        }
        for body in &model.bodies {
            let u = &velocities[body.node];
            for load in &body.loads {
                let (force, moment) = load.rows(&state.poses()[body.node], level.factor(&load.course));
                power += force.dot(&u.translation) + moment.dot(&u.rotation);
            }
        }
        Ok(power)
    }
}
