//! The harness itself is tested to fail: a check that cannot fail is worth nothing.

use crate::case::{Case, Checks, Kind, Outcome};

/// Cases about the harness.
pub fn all() -> Vec<Case> {
    vec![Case::new("harness::wrong_references_fail", "this harness", wrong_references_fail)]
}

/// What is tried, whether it should pass, and the checks.
type Attempt = (&'static str, bool, fn(&mut Checks));

const REASON: &str = "made up for this test";

fn wrong_references_fail(checks: &mut Checks) -> Outcome {
    let attempts: [Attempt; 10] = [
        ("no checks at all", false, |_| ()),
        ("a right value", true, |c| c.relative(Kind::ClosedForm, "", (1.0, 1.0 + 1e-9), 1e-8, REASON)),
        ("a wrong value", false, |c| c.relative(Kind::ClosedForm, "", (1.0, 1.1), 1e-8, REASON)),
        ("not a number", false, |c| c.absolute(Kind::ClosedForm, "", (f64::NAN, 1.0), 1e300, REASON)),
        ("a wrong vector", false, |c| {
            c.vector(Kind::ClosedForm, "", ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), 1.0, REASON)
        }),
        ("a right order", true, |c| c.order("", &[1, 2, 4], &[1.0, 0.25, 0.0625], (2.0, 0.1), REASON)),
        ("a wrong order", false, |c| c.order("", &[1, 2, 4], &[1.0, 0.25, 0.0625], (3.0, 0.5), REASON)),
        ("an order of one mesh", false, |c| c.order("", &[1], &[1.0], (2.0, 9.0), REASON)),
        ("too small", false, |c| c.above(Kind::Order, "", 1.0, 2.0, REASON)),
        ("one of two wrong", false, |c| {
            c.below(Kind::Invariant, "", 0.0, 1.0, REASON);
            c.below(Kind::Invariant, "", 2.0, 1.0, REASON);
        }),
    ];
    for (name, expected, run) in attempts {
        let mut inner = Checks::default();
        run(&mut inner);
        let verdict = f64::from(u8::from(inner.hold()));
        checks.absolute(
            Kind::Invariant,
            name,
            (verdict, f64::from(u8::from(expected))),
            0.0,
            "a verdict is exact",
        );
    }
    Ok(())
}
