//! What a run costs, and that it costs and finds the same every time.

use super::{Pendulum, paper_steps, steps};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("wilberforce::iterations", "own counts; the authors' program: 4.65 a step", iterations),
        Case::new("wilberforce::repeatable", "the same arithmetic in the same order", repeatable),
    ]
}

const SAME: &str = "one figure of the step count; a residual within rounding of the tolerance may cost one iteration \
                    more or less on another machine: a step in a hundred";

fn iterations(checks: &mut Checks) -> Outcome {
    let swing = Pendulum::paper().swing_as_is(&paper_steps(8.0))?;
    let work = &swing.solution.statistics;
    let (increments, iterations) = (work.increments as f64, work.newton_iterations as f64);
    let exactly = "8 s in steps of 5 ms";
    checks.absolute(Kind::ClosedForm, "steps", (increments, 1600.0), 0.0, exactly);
    checks.absolute(Kind::ClosedForm, "rejected", (work.rejected as f64, 0.0), 0.0, exactly);
    let reason = "the authors' program needs 4.65 a step and 6 at most for the same equations and tolerance";
    checks.below(Kind::CrossCode, "iterations a step", iterations / increments, 5.0, reason);
    checks.below(Kind::CrossCode, "most iterations", work.most_iterations as f64, 7.0, reason);
    checks.absolute(Kind::Pinned, "iterations of 1600 steps", (iterations, 4734.0), 16.0, SAME);
    checks.below(Kind::Invariant, "largest residual", work.residual, 1e-8, "the tolerance");
    let factorizations = (work.factorizations as f64, iterations);
    checks.absolute(Kind::Invariant, "factorisations", factorizations, 0.0, "one an iteration");
    let gap = swing.solution.energies.iter().map(|energies| energies.constraint).fold(0.0, f64::max);
    let reason = "joints are closed at position level: the tolerance at most";
    checks.below(Kind::Invariant, "largest gap of a joint [m, rad]", gap, 1e-8, reason);

    let swing = Pendulum::new(18, 4).swing_as_is(&steps(2.0, 2.5e-3))?;
    let work = &swing.solution.statistics;
    let each = work.newton_iterations as f64 / work.increments as f64;
    let reason = "a step half as long starts from a prediction four times as good";
    checks.below(Kind::Invariant, "iterations a step, unit-free test, p = 4", each, 5.0, reason);
    Ok(())
}

fn repeatable(checks: &mut Checks) -> Outcome {
    let once = Pendulum::paper().swing_as_is(&paper_steps(2.0))?.solution;
    let again = Pendulum::paper().swing_as_is(&paper_steps(2.0))?.solution;
    let bits = |solution: &cosserat::Solution| -> Vec<u64> {
        let row = |row: &cosserat::solution::Row| {
            let probe = &row.probes[0];
            let numbers = probe.position.into_iter().chain(probe.quaternion);
            numbers.chain(row.reactions.iter().flatten().copied()).map(f64::to_bits).collect::<Vec<_>>()
        };
        solution.rows.iter().flat_map(row).collect()
    };
    let (once_bits, again_bits) = (bits(&once), bits(&again));
    let different = once_bits.iter().zip(&again_bits).filter(|(a, b)| a != b).count();
    let missing = once_bits.len().abs_diff(again_bits.len());
    let reason = "no threads, no clock, no hash order";
    checks.below(
        Kind::Invariant,
        "numbers that differ between two runs",
        (different + missing) as f64,
        0.0,
        reason,
    );
    let least = 401.0 * 19.0;
    checks.above(
        Kind::Invariant,
        "numbers compared",
        once_bits.len() as f64,
        least,
        "seven and twelve for every row",
    );
    let same = once.statistics == again.statistics && once.energies == again.energies;
    checks.below(Kind::Invariant, "counts or energies that differ", f64::from(u8::from(!same)), 0.0, reason);
    Ok(())
}
