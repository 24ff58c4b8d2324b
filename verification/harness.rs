//! The harness itself is tested to fail: a check that cannot fail is worth nothing.

mod data;
mod verdicts;

use crate::case::{Case, Checks, Kind, Outcome};

/// Cases about the harness.
pub fn all() -> Vec<Case> {
    let checks = Case::new("harness::wrong_references_fail", SOURCE, wrong_references_fail);
    [vec![checks], data::all(), verdicts::all()].into_iter().flatten().collect()
}

const SOURCE: &str = "this harness";

/// Whether something is as it should be.
fn is(checks: &mut Checks, what: impl Into<String>, holds: bool) {
    let measured = f64::from(u8::from(holds));
    checks.absolute(Kind::Invariant, what, (measured, 1.0), 0.0, "yes or no");
}

/// What is tried, whether it should pass, and the checks.
type Attempt = (&'static str, bool, fn(&mut Checks));

const REASON: &str = "made up for this test";
const FORM: Kind = Kind::ClosedForm;

fn wrong_references_fail(checks: &mut Checks) -> Outcome {
    let attempts: [Attempt; 26] = [
        ("no checks at all", false, |_| ()),
        ("a right value", true, |c| c.relative(FORM, "", (1.0, 1.0 + 1e-9), 1e-8, REASON)),
        ("a wrong value", false, |c| c.relative(FORM, "", (1.0, 1.1), 1e-8, REASON)),
        ("a value of the other sign", false, |c| c.relative(FORM, "", (1.0, -1.0), 1.9, REASON)),
        ("a relative error of nothing", false, |c| c.relative(FORM, "", (0.0, 0.0), 1e300, REASON)),
        ("a relative error of not a number", false, |c| c.relative(FORM, "", (f64::NAN, 1.0), 1e300, REASON)),
        ("a right difference", true, |c| c.absolute(FORM, "", (2.0, 2.1), 0.11, REASON)),
        ("a wrong difference", false, |c| c.absolute(FORM, "", (2.0, 2.1), 0.09, REASON)),
        ("a difference to not a number", false, |c| c.absolute(FORM, "", (1.0, f64::NAN), 1e300, REASON)),
        ("a difference to infinity", false, |c| c.absolute(FORM, "", (1.0, f64::INFINITY), 1e300, REASON)),
        ("a bound that is no number", false, |c| c.absolute(FORM, "", (1.0, 1.0), f64::NAN, REASON)),
        ("a right vector", true, |c| c.vector(FORM, "", ([1.0, 0.0, 0.0], [1.0, 0.0, 1e-3]), 1e-2, REASON)),
        ("a wrong vector of the right length", false, |c| {
            c.vector(FORM, "", ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), 1.0, REASON)
        }),
        ("a vector with one component that is no number", false, |c| {
            c.vector(FORM, "", ([1.0, f64::NAN, 0.0], [1.0, 0.0, 0.0]), 1e300, REASON)
        }),
        ("a right order", true, |c| c.order("", &[1, 2, 4], &[1.0, 0.25, 0.0625], (2.0, 0.1), REASON)),
        ("a wrong order", false, |c| c.order("", &[1, 2, 4], &[1.0, 0.25, 0.0625], (3.0, 0.5), REASON)),
        ("an order of one mesh", false, |c| c.order("", &[1], &[1.0], (2.0, 9.0), REASON)),
        ("an order of errors that do not fall", false, |c| {
            c.order("", &[1, 2, 4], &[1.0, 0.25, 0.25], (2.0, 0.5), REASON)
        }),
        ("an order of no error", false, |c| c.order("", &[1, 2], &[0.0, 0.0], (2.0, 9.0), REASON)),
        ("an order of not a number", false, |c| c.order("", &[1, 2], &[1.0, f64::NAN], (2.0, 9.0), REASON)),
        ("small enough", true, |c| c.below(Kind::Invariant, "", 1.0, 1.0, REASON)),
        ("too large", false, |c| c.below(Kind::Invariant, "", 1.1, 1.0, REASON)),
        ("large enough", true, |c| c.above(Kind::Order, "", 2.0, 2.0, REASON)),
        ("too small", false, |c| c.above(Kind::Order, "", 1.0, 2.0, REASON)),
        ("not a number, to be large", false, |c| c.above(Kind::Order, "", f64::NAN, 2.0, REASON)),
        ("one of two wrong", false, |c| {
            c.below(Kind::Invariant, "", 0.0, 1.0, REASON);
            c.below(Kind::Invariant, "", 2.0, 1.0, REASON);
        }),
    ];
    for (name, expected, run) in attempts {
        let mut inner = Checks::default();
        run(&mut inner);
        is(checks, format!("{name}: {}", if expected { "holds" } else { "fails" }), inner.hold() == expected);
    }
    Ok(())
}
