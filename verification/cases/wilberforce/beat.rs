//! The beat: Berg & Marshall's closed form for the unloaded spring, the spring stretched by the weight, and the motion.

use std::f64::consts::TAU;

use super::authors::ENVELOPE_Z;
use super::frequencies;
use super::stiffness;
use super::swing::{envelope, extrema, peak};
use super::{
    COILS, DIAMETER, POISSON, Pendulum, RADIUS, SHEAR, bob_mass, bob_spin_inertia, paper_steps, places, slope,
};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "wilberforce::beat",
            "Berg & Marshall 1991; shooting and Chebyshev collocation; the authors' program",
            beat,
        )
        .reads(&[frequencies::FILE, stiffness::FILE, ENVELOPE_Z]),
    ]
}

/// ω² = ½ [ω_θ² + ω_z² ± √((ω_θ² − ω_z²)² + ε²/(m I))], k = G d⁴/(64 n R³), δ = k R² (1 + ν cos² α) and
/// ε = k R ν sin 2α.
fn berg_marshall() -> [f64; 2] {
    let k = SHEAR * DIAMETER.powi(4) / (64.0 * COILS * RADIUS.powi(3));
    let angle = slope().atan();
    let delta = k * RADIUS * RADIUS * (1.0 + POISSON * angle.cos().powi(2));
    let epsilon = k * RADIUS * POISSON * (2.0 * angle).sin();
    let (z, theta) = (k / bob_mass(), delta / bob_spin_inertia());
    let root = (theta - z).hypot(epsilon / (bob_mass() * bob_spin_inertia()).sqrt());
    [(0.5 * (theta + z - root)).sqrt(), (0.5 * (theta + z + root)).sqrt()]
}

/// 2π/(ω₂ − ω₁).
fn period([slow, fast]: [f64; 2]) -> f64 {
    TAU / (fast - slow)
}

/// What the closed form leaves out, relative to ω: d²/8R² of shear and tan² α of pitch, halved by the root; and the
/// modes in which the bob swings like a pendulum, which repel that of z: K_xz²/(m² (ω_z² − ω_x²)) of ω_z², halved.
fn left_out(coupling: f64, unloaded: &[f64]) -> f64 {
    let coupling = coupling / bob_mass();
    let (z, x) = (unloaded[2].powi(2), unloaded[0].powi(2));
    0.5 * (0.125 * (DIAMETER / RADIUS).powi(2) + slope().powi(2)) + 0.5 * coupling * coupling / (z * (z - x))
}

fn beat(checks: &mut Checks) -> Outcome {
    let formula = berg_marshall();
    let place = &places()[0];
    let digits = "half a unit of the last printed digit";
    checks.absolute(Kind::Published, "beat of the formula [s]", (period(formula), 4.66), 0.005, digits);

    let exact = frequencies::exact(checks, "unloaded", "massless")?;
    let left_out = left_out(stiffness::exact(checks, "unloaded")?[(0, 2)], &exact);
    let exact_unloaded = period([exact[2], exact[3]]);
    let massless = Pendulum { weight: false, inertia: false, ..Pendulum::new(12, 8) };
    let (unloaded, _) = massless.modes(place, 6)?;
    let unloaded = [unloaded[2], unloaded[3]];
    let reason =
        "what the formula leaves out: shear, the pitch in second order, the modes of the bob as a pendulum";
    for (found, closed) in unloaded.into_iter().zip(formula) {
        let pair = (found, closed);
        checks.relative(Kind::Published, "ω of the pair, unloaded [rad/s]", pair, left_out, reason);
    }
    let spread = left_out * (formula[0] + formula[1]) / (formula[1] - formula[0]);
    let pair = (period(unloaded), period(formula));
    checks.relative(Kind::Published, "beat, unloaded, against the formula [s]", pair, spread, reason);
    let digits = "1e-8 in either frequency is 2.3e-7 of their difference";
    checks.relative(Kind::ClosedForm, "beat, unloaded [s]", (period(unloaded), exact_unloaded), 3e-7, digits);

    let (stretched, _) = Pendulum::new(12, 8).modes(place, 4)?;
    let stretched = period([stretched[2], stretched[3]]);
    let exact = frequencies::exact(checks, "stretched", "inertia")?;
    let exact = period([exact[2], exact[3]]);
    checks.relative(Kind::ClosedForm, "beat, stretched [s]", (stretched, exact), 3e-7, digits);

    // The motion's first revival belongs to the stretched spring, not to the unloaded one.
    let swing = Pendulum::paper().swing_as_is(&paper_steps(4.8))?;
    let points = envelope(&extrema(&swing.times, &swing.z()));
    let revival = peak(&points, (2.7, 4.5), 1.0).0;
    let table = checks.reference(ENVELOPE_Z)?;
    let [printed, digit] = table.row(&[("which", "largest")])?.numbers("time time_half_digit")?;
    let reason = "their wire is stiffer by 1e-3 to 3e-3 (authors.rs), and times differ by half of that at most; half a \
                  unit of the last digit";
    let bound = 0.5 * 3e-3 * printed + digit;
    checks.absolute(Kind::CrossCode, "first revival of z [s]", (revival, printed), bound, reason);
    let reason = "the envelope has a point every half period of z, 0.206 s: half of that either way, and the first swing \
                  is no small vibration";
    checks.absolute(Kind::ClosedForm, "revival against the linear beat [s]", (revival, exact), 0.103, reason);
    let distance = (revival - period(formula)).abs();
    let reason =
        "the formula's beat is 27 % longer than the stretched spring's: the two must not be mixed up";
    checks.above(Kind::Published, "revival from the formula's beat [s]", distance, 0.8, reason);
    Ok(())
}
