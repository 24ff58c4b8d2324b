//! The verification suite: every number of the solver held against something it did not compute.
//!
//! `cargo test --release --test verification` runs all of it, `… -- spring` what has "spring" in its name,
//! `… -- --nocapture` prints every check with its numbers.

mod case;
mod cases;
mod continuous;
mod discrete_rod;
mod formulas;
mod harness;
mod measure;
mod motion;
mod pieces;
mod placement;
mod references;
mod states;
mod steps;
mod tip;

use libtest_mimic::{Arguments, Failed, Trial};

use case::{Case, Checks};

fn main() {
    let arguments = Arguments::from_args();
    let show = arguments.nocapture;
    let trials = cases::all().into_iter().chain(harness::all()).map(|case| trial(case, show)).collect();
    libtest_mimic::run(&arguments, trials).exit();
}

/// A case passes if it has checks and every one of them holds.
fn trial(case: Case, show: bool) -> Trial {
    Trial::test(case.name, move || {
        let mut checks = Checks::of(&case);
        (case.run)(&mut checks).map_err(|error| Failed::from(format!("{}\n{}", error, checks.table())))?;
        if show {
            eprintln!("{}\n{}", case.name, checks.table());
        }
        if !checks.unread().is_empty() {
            Err(format!("declared, and not read: {:?}", checks.unread()).into())
        } else if checks.hold() {
            Ok(())
        } else {
            Err(format!("{}\nsource: {}", checks.table(), case.source).into())
        }
    })
}
