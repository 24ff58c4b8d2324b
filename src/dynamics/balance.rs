//! Energy that comes from nowhere: the sign of a step too long for the motion, though every step converged, or of modes
//! of the mesh that grow in steps too short to damp them ([`super::generalized_alpha`]).

use crate::model::Model;
use crate::solution::{Energies, StopReason};

/// Kinetic and strain energy against the work of gravity and all loads, by the trapezoidal rule. What integration
/// makes of energy is small where the step resolves the motion; where it grows out of proportion the answer is none.
pub struct Balance {
    /// Power at the last time [W].
    power: f64,
    /// Kinetic and strain energy at the start, and what the loads have brought since [J].
    from_loads: f64,
    /// ∫ |power| dt and the energy of the start: what there was to go round [J].
    turnover: f64,
    /// The largest part of its turnover that a surplus has been, and that surplus and turnover [J].
    worst: (f64, f64, f64),
    /// The rounding floor is that of the shortest step so far [s].
    shortest: f64,
    floor: f64,
}

/// A surplus of this part of the turnover is worth a warning,
const SURPLUS: f64 = 0.1;
/// and of this one the end.
const RUNAWAY: f64 = 10.0;

impl Balance {
    /// From the power of the loads and the energies at the start.
    pub fn new(power: f64, energies: &Energies) -> Self {
        let energy = energies.kinetic + energies.strain;
        Self {
            power,
            from_loads: energy,
            turnover: energy,
            worst: (0.0, 0.0, 0.0),
            shortest: f64::INFINITY,
            floor: 0.0,
        }
    }

    /// After a step; an error where energy runs away.
    pub fn add(
        &mut self,
        model: &Model,
        length: f64,
        power: f64,
        energies: &Energies,
    ) -> Result<(), StopReason> {
        if length < self.shortest {
            (self.shortest, self.floor) = (length, floor(model, length));
        }
        self.from_loads += 0.5 * length * (self.power + power);
        self.turnover += 0.5 * length * (self.power.abs() + power.abs());
        self.power = power;
        let surplus = energies.kinetic + energies.strain - self.from_loads;
        // A free body that rests has no turnover, and no surplus either.
        let turnover = self.turnover + self.floor;
        let part = if surplus > 0.0 { surplus / turnover } else { 0.0 };
        if part > self.worst.0 {
            self.worst = (part, surplus, turnover);
        }
        if part > RUNAWAY { Err(StopReason::Energy) } else { Ok(()) }
    }

    /// What the user should know.
    pub fn warning(&self) -> Option<String> {
        let (part, surplus, turnover) = self.worst;
        (part > SURPLUS).then(|| {
            format!(
                "kinetic and strain energy exceed what gravity and the loads have brought by up to {surplus:.1e} J, \
                 where {turnover:.1e} J had gone round: the time step is too long for this motion, or, where shorter \
                 steps make it worse, the mesh too coarse"
            )
        })
    }
}

/// The energy of rounding, which a motion at rest has, too [J]: positions carry ε r, hence strains e = 8 ε r p²/J_e and
/// curvatures e/r, ½ L (C_γ e² + C_κ e²/r²), and velocities 8 ε r/h, ½ m (8 ε r/h)²; r is the size of a part.
fn floor(model: &Model, time_step: f64) -> f64 {
    let noise = 8.0 * f64::EPSILON;
    let moving = |mass: f64, size: f64| 0.5 * mass * (noise * size / time_step).powi(2);
    let rods = model.rods.iter().map(|rod| {
        let strain = noise * rod.length * (rod.degree * rod.degree) as f64 / rod.element_length;
        let stiffness = &rod.properties.stiffness;
        let stiff = stiffness.force.max() + stiffness.moment.max() / rod.length.powi(2);
        let inertia = rod.properties.inertia.as_ref();
        let mass = inertia.map_or(0.0, |inertia| inertia.section.mass_per_length * rod.length);
        0.5 * rod.length * stiff * strain * strain + moving(mass, rod.length)
    });
    let bodies = model.bodies.iter().map(|body| moving(body.mass.mass, body.reach.max(model.size)));
    rods.chain(bodies).sum()
}
