//! The verification suite: every number of the solver held against something it did not compute.
//!
//! `cargo test --release --test verification` runs all of it and leaves `target/verification/report.html`, `… -- spring`
//! runs what has "spring" in its name, `… -- --nocapture` prints every check with its numbers. `VERIFY=fast` in the
//! environment leaves the slow cases out, `VERIFY=slow` the others.

mod case;
mod cases;
mod continuous;
mod discrete_rod;
mod formulas;
mod harness;
mod measure;
mod motion;
mod one_element;
mod pieces;
mod placement;
mod references;
mod report;
mod states;
mod steps;
mod strains;
mod tip;

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use libtest_mimic::{Arguments, Trial};

use case::{Case, Checks, Outcome};
use report::{Environment, Record, Report};

/// What has been run, in any order.
type Records = Arc<Mutex<Vec<Record>>>;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let part = std::env::var("VERIFY").unwrap_or_else(|_| "full".to_string());
    let wanted: fn(&Case) -> bool = match part.as_str() {
        "full" => |_| true,
        "fast" => |case| !case.slow,
        "slow" => |case| case.slow,
        other => {
            eprintln!("VERIFY is \"{other}\"; expected \"full\", \"fast\" or \"slow\"");
            return ExitCode::from(2);
        }
    };
    let cases: Vec<Case> = cases::all().into_iter().chain(harness::all()).collect();
    let names: BTreeSet<&'static str> = cases.iter().map(|case| case.name).collect();
    let records = Records::default();
    let show = arguments.nocapture;
    let trials = cases.into_iter().map(|case| trial(case, wanted, show, Arc::clone(&records))).collect();
    let conclusion = libtest_mimic::run(&arguments, trials);
    if !arguments.list {
        let records = std::mem::take(&mut *records.lock().unwrap_or_else(PoisonError::into_inner));
        let run: BTreeSet<&str> = records.iter().map(|record| record.name).collect();
        let not_run = names.into_iter().filter(|name| !run.contains(name)).collect();
        let part = if arguments.filter.is_some() { format!("{part}, filtered") } else { part };
        match Report::new(records, not_run, part, Environment::find()).write() {
            Ok(page) => eprintln!("report: {}", page.display()),
            Err(error) => {
                eprintln!("the report cannot be written: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
    conclusion.exit_code()
}

fn trial(case: Case, wanted: fn(&Case) -> bool, show: bool, records: Records) -> Trial {
    let (ignored, kind) = (!wanted(&case), if case.slow { "slow" } else { "" });
    Trial::test(case.name, move || {
        let mut checks = Checks::of(&case);
        let start = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| (case.run)(&mut checks)));
        let outcome: Outcome = outcome.unwrap_or_else(|_| Err("the case panicked".into()));
        let record = Record::new(&case, outcome, checks, start.elapsed());
        let verdict = if record.is_fine() { Ok(()) } else { Err(record.explanation().into()) };
        if show {
            eprintln!("{}\n{}", case.name, case::table(&record.checks));
        }
        records.lock().unwrap_or_else(PoisonError::into_inner).push(record);
        verdict
    })
    .with_kind(kind)
    .with_ignored_flag(ignored)
}
