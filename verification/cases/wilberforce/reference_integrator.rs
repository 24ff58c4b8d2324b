//! The pendulum by the reference integrator: another method, the same motion.

use std::error::Error;

use cosserat::scene::{Dynamics, Method};
use nalgebra::Vector3;

use super::swing::Swing;
use super::{Pendulum, steps};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "wilberforce::radau",
            "generalized-alpha, extrapolated to no step",
            limit_of_generalized_alpha,
        ),
        Case::new("wilberforce::radau_halves", "the same motion with half the step", halves).slow(),
    ]
}

/// The position of the bob's centre of mass at the end.
fn end(
    elements: usize,
    method: Method,
    time: f64,
    step: f64,
) -> Result<(Vector3<f64>, Swing), Box<dyn Error>> {
    let options = Dynamics { method, ..steps(time, step) };
    let swing = Pendulum::new(elements, 2).swing_as_is(&options)?;
    let position = *swing.positions.last().ok_or("no rows")?;
    Ok((position, swing))
}

/// On one mesh both methods solve the same equations in time.
fn limit_of_generalized_alpha(checks: &mut Checks) -> Outcome {
    let time = 0.5;
    let (radau, swing) = end(18, Method::Radau, time, 2.5e-3)?;
    let mut alpha = Vec::new();
    for step in [2e-3, 1e-3, 5e-4] {
        alpha.push(end(18, Method::GeneralizedAlpha, time, step)?.0);
    }
    let extrapolated = |k: usize| (4.0 * alpha[k + 1] - alpha[k]) / 3.0;
    checks.below(
        Kind::CrossCode,
        "distance of the bob from the extrapolated one [m]",
        (radau - extrapolated(1)).norm(),
        (extrapolated(1) - extrapolated(0)).norm(),
        "extrapolated values improve faster than they still change: by 2³ or more a halving",
    );
    let steps_taken = swing.solution.statistics.increments as f64;
    checks.absolute(Kind::Pinned, "steps", (steps_taken, 200.0), 0.0, "0.5 s by 2.5 ms");
    Ok(())
}

/// Where the stages of a long step are not found it is done in halves: a longer way to the same place.
fn halves(checks: &mut Checks) -> Outcome {
    let time = 1.1;
    let (whole, long) = end(18, Method::Radau, time, 5e-3)?;
    let (fine, short) = end(18, Method::Radau, time, 2.5e-3)?;
    checks.above(
        Kind::Pinned,
        "steps that were halved",
        long.solution.statistics.rejected as f64,
        0.5,
        "at 5 ms some steps do not converge; without halves the run would have stopped",
    );
    checks.absolute(
        Kind::Pinned,
        "rows",
        (long.times.len() as f64, short.times.len().div_ceil(2) as f64),
        0.0,
        "one row a step, halved or not",
    );
    checks.below(
        Kind::Invariant,
        "distance of the two [m]",
        (whole - fine).norm(),
        // Error per period T of a swing: (ωh)⁶/7200 of the phase a step, T/h steps, of 40 mm; ω = 2π/0.4 s.
        1.1 / 5e-3 * (16.0 * 5e-3_f64).powi(4) * 40e-3 / 72.0,
        "stage order 3: what stiff modes leave of the order, (ω h)⁴/72 a step of a swing of 40 mm",
    );
    Ok(())
}
