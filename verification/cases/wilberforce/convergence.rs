//! With the inertia of the wire: order in space and in time, the converged trajectory, a second program's extrema.

use std::error::Error;

use super::swing::{Swing, extrema, nearest};
use super::{Pendulum, steps};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("wilberforce::space_and_time", "order 2p in space, 2 in time; Richardson", space_and_time)
            .slow(),
        Case::new(
            "wilberforce::converged",
            "Exudyn, 48 two-node elements, h = 5 ms; p = 6 with extrapolation in time",
            converged,
        )
        .reads(&[EXUDYN_Z, EXUDYN_YAW])
        .slow(),
    ]
}

/// Where runs are compared, every so many seconds.
const SAMPLE: f64 = 0.02;

/// (z, α) at multiples of the sample time.
fn samples(swing: &Swing) -> Vec<(f64, f64)> {
    let (z, alpha) = (swing.z(), swing.alpha());
    let end = swing.times.last().copied().unwrap_or(0.0);
    let count = (end / SAMPLE).round() as usize;
    (1..=count).map(|k| swing.at(k as f64 * SAMPLE)).map(|row| (z[row], alpha[row])).collect()
}

fn run(pendulum: &Pendulum, end: f64, step: f64) -> Result<Vec<(f64, f64)>, Box<dyn Error>> {
    Ok(samples(&pendulum.swing_as_is(&steps(end, step))?))
}

/// Largest differences in z and α.
fn apart(a: &[(f64, f64)], b: &[(f64, f64)]) -> (f64, f64) {
    let largest =
        |f: fn(&(f64, f64)) -> f64| a.iter().zip(b).map(|(a, b)| (f(a) - f(b)).abs()).fold(0.0, f64::max);
    if a.len() == b.len() { (largest(|p| p.0), largest(|p| p.1)) } else { (f64::NAN, f64::NAN) }
}

fn extrapolated(coarse: &[(f64, f64)], fine: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let one = |c: f64, f: f64| (4.0 * f - c) / 3.0;
    coarse.iter().zip(fine).map(|(c, f)| (one(c.0, f.0), one(c.1, f.1))).collect()
}

fn space_and_time(checks: &mut Checks) -> Outcome {
    let end = 2.0;
    let meshes = [18, 36, 72];
    // Space alone: the same steps, a mesh that is converged.
    let step = 5e-3;
    let fine = run(&Pendulum::new(12, 6), end, step)?;
    let mut errors = (Vec::new(), Vec::new());
    for elements in meshes {
        let (z, alpha) = apart(&run(&Pendulum::new(elements, 2), end, step)?, &fine);
        errors.0.push(z);
        errors.1.push(alpha);
    }
    let reason = "2p = 4; at 36 elements an element spans 30°, and the next term, two orders higher with a constant of \
                  one, changes the order by log₂[(1 + (π/6)²)/(1 + (π/12)²)] = 0.25";
    checks.order("z, p = 2, same Δt", &meshes, &errors.0, (4.0, 0.3), reason);
    checks.order("α, p = 2, same Δt", &meshes, &errors.1, (4.0, 0.3), reason);

    // Time alone: the same mesh.
    let mesh = Pendulum::new(36, 2);
    let runs = [5e-3, 2.5e-3, 1.25e-3].map(|step| run(&mesh, end, step));
    let [coarse, middle, finest] = runs;
    let (coarse, middle, finest) = (coarse?, middle?, finest?);
    let limit = extrapolated(&middle, &finest);
    let differences = [apart(&coarse, &limit), apart(&middle, &limit), apart(&finest, &limit)];
    let inverse = [200, 400, 800];
    let reason = "order 2; a term of third order as large as the second at ω h = 1, for 54 rad/s, changes the order by \
                  log₂[(1 + 0.135)/(1 + 0.068)] = 0.09; twice that";
    checks.order("z, same mesh", &inverse, &differences.map(|d| d.0), (2.0, 0.18), reason);
    checks.order("α, same mesh", &inverse, &differences.map(|d| d.1), (2.0, 0.18), reason);

    // Both at once: 18, 36, 72 elements with 5, 2.5, 1 ms.
    let exact =
        extrapolated(&run(&Pendulum::new(12, 6), end, 2.5e-3)?, &run(&Pendulum::new(12, 6), end, 1.25e-3)?);
    let both = [(18, 5e-3), (36, 2.5e-3), (72, 1e-3)];
    let mut found = Vec::new();
    for (elements, step) in both {
        found.push(apart(&run(&Pendulum::new(elements, 2), end, step)?, &exact));
    }
    for (index, (elements, step)) in both.into_iter().enumerate() {
        let space = (errors.0[index], errors.1[index]);
        let scale = (step / 5e-3).powi(2) * 1.5;
        let reason = "the errors of space and time, measured apart, add up; half as much again for the steps beyond the \
                      second order and the interaction of both";
        let what = format!("z, {elements} elements, Δt = {} ms [m]", 1e3 * step);
        checks.below(Kind::Order, what, found[index].0, 1.5 * space.0 + scale * differences[0].0, reason);
        let what = format!("α, {elements} elements, Δt = {} ms [rad]", 1e3 * step);
        checks.below(Kind::Order, what, found[index].1, 1.5 * space.1 + scale * differences[0].1, reason);
    }
    Ok(())
}

/// Extrema of z and of α = atan2(A₂₁, A₁₁).
const EXUDYN_Z: &str = "published/exudyn_wilberforce_z.csv";
const EXUDYN_YAW: &str = "published/exudyn_wilberforce_yaw.csv";

fn converged(checks: &mut Checks) -> Outcome {
    let end = 8.0;
    let fine = Pendulum::new(9, 6);
    let coarse = fine.swing_as_is(&steps(end, 4e-3))?;
    let swing = fine.swing_as_is(&steps(end, 2e-3))?;
    let exact = extrapolated(&samples(&coarse), &samples(&swing));

    // Two-node elements of h = L/48 of a coil of curvature κ: stiffness (κh)²/12 off.
    let softer = (0.301_607_8_f64 / 48.0 / 16e-3).powi(2) / 12.0;
    let reason = "48 two-node elements of 0.39 rad are off by 0.39²/12 in the stiffness and half of that in the \
                  frequency; their 5 ms by (ωh)²/12 with 15.7 rad/s; ours of 2 ms by a sixth of that; digits";
    let late = |time: f64| time * (0.5 * softer + 1.2 * (15.7 * 5e-3_f64).powi(2) / 12.0);
    let value = "the stretch of 44 mm, twice, and 2.4 rad times the error of their stiffness; what the beat, of 1.72 \
                 rad/s, moves the envelope of 42 mm and 2.4 rad in the time by which they are early or late; digits";
    let (z, yaw) = (extrema(&swing.times, &swing.z()), extrema(&swing.times, &swing.yaw()));
    // Stretch and envelope, of z [m] and of the yaw [rad].
    for (what, file, found, stretch, envelope) in
        [("z", EXUDYN_Z, z, 44e-3, 42e-3), ("yaw", EXUDYN_YAW, yaw, 2.4, 2.4)]
    {
        for row in checks.reference(file)?.rows() {
            let [time, time_digit, expected, digit] =
                row.numbers("time time_half_digit value value_half_digit")?;
            let found = nearest(&found, time);
            let name = format!("extremum of {what} near {time} s [s]");
            checks.absolute(Kind::CrossCode, name, (found.0, time), late(time) + time_digit, reason);
            let bound = stretch * softer + 0.5 * 1.72 * envelope * (late(time) + time_digit) + digit;
            let name = format!("{what} near {time} s [m, rad]");
            checks.absolute(Kind::CrossCode, name, (found.1, expected), bound, value);
        }
    }

    // What the user gets for 1 ms, over 8 s.
    let reason = "half a millimetre of the 85 mm that z moves: the goal set for a run of 8 s";
    let cheap = run(&Pendulum::new(9, 4), end, 1e-3)?;
    checks.below(
        Kind::Order,
        "z to 8 s, 9 elements, p = 4, Δt = 1 ms [m]",
        apart(&cheap, &exact).0,
        0.5e-3,
        reason,
    );
    let reason = "one per cent of the 85 mm that z moves";
    let quadratic = run(&Pendulum::new(36, 2), end, 1e-3)?;
    let what = "z to 8 s, 36 elements, p = 2, Δt = 1 ms [m]";
    checks.below(Kind::Order, what, apart(&quadratic, &exact).0, 0.85e-3, reason);
    Ok(())
}
