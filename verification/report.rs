//! What a run of the suite leaves: `report.html` (one page that needs nothing else), `report.json` and `junit.xml`.

mod environment;
mod page;
mod plots;

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use cosserat::error::{Error as LibraryError, SceneError};
use cosserat::solution::SolveFailure;
use quick_junit::{NonSuccessKind, TestCase, TestCaseStatus, TestSuite};
use serde::Serialize;

use crate::case::{Case, Check, Checks, Outcome, Trajectory};
use crate::references::Resource;
pub use environment::Environment;

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// A check does not hold, or the case could not be carried out.
    Failed,
    /// The solver stopped early.
    Diverged,
    /// The solver says that it cannot do this yet.
    Unsupported,
    /// There are checks, and all of them hold.
    Passed,
}

impl Verdict {
    /// For the eye.
    pub fn name(self) -> &'static str {
        match self {
            Self::Failed => "failed",
            Self::Diverged => "diverged",
            Self::Unsupported => "unsupported",
            Self::Passed => "passed",
        }
    }
}

/// One case that was run.
#[derive(Clone, Debug, Serialize)]
pub struct Record {
    pub name: &'static str,
    pub source: &'static str,
    pub slow: bool,
    pub verdict: Verdict,
    /// What went wrong apart from the checks; empty if nothing did.
    pub message: String,
    pub seconds: f64,
    pub checks: Vec<Check>,
    /// Files under `references/`.
    pub reads: Vec<&'static str>,
    #[serde(skip)]
    pub resources: Vec<Resource>,
    #[serde(skip)]
    pub trajectories: Vec<Trajectory>,
}

impl Record {
    /// Judges what a case has returned.
    pub fn new(case: &Case, outcome: Outcome, checks: Checks, elapsed: Duration) -> Self {
        let unread = checks.unread();
        let (verdict, message) = match outcome {
            Err(error) => (verdict_of(error.as_ref()), error.to_string()),
            Ok(()) if checks.list().is_empty() => (Verdict::Failed, "it checks nothing".to_string()),
            Ok(()) if !unread.is_empty() => {
                (Verdict::Failed, format!("declared, and not read: {}", unread.join(", ")))
            }
            Ok(()) if checks.hold() => (Verdict::Passed, String::new()),
            Ok(()) => (Verdict::Failed, String::new()),
        };
        let (verdict, message) = match (case.awaits, verdict) {
            (None, Verdict::Unsupported) => (Verdict::Failed, message),
            (Some(feature), Verdict::Passed) => {
                (Verdict::Failed, format!("{feature} is there now, but the case still awaits it"))
            }
            _ => (verdict, message),
        };
        let (checks, read, trajectories) = checks.into_parts();
        let (reads, resources) = read.into_iter().map(|(name, table)| (name, table.resource)).unzip();
        Self {
            name: case.name,
            source: case.source,
            slow: case.slow,
            verdict,
            message,
            seconds: elapsed.as_secs_f64(),
            checks,
            reads,
            resources,
            trajectories,
        }
    }

    /// Whether the run may go on to pass.
    pub fn is_fine(&self) -> bool {
        matches!(self.verdict, Verdict::Passed | Verdict::Unsupported)
    }

    /// What a console shows of a case that failed.
    pub fn explanation(&self) -> String {
        format!(
            "{} {}\n{}source: {}",
            self.verdict.name(),
            self.message,
            crate::case::table(&self.checks),
            self.source
        )
    }
}

fn verdict_of(error: &(dyn Error + 'static)) -> Verdict {
    let scene = match error.downcast_ref::<LibraryError>() {
        Some(LibraryError::Scene(scene)) => Some(scene),
        _ => error.downcast_ref::<SceneError>(),
    };
    if scene.is_some_and(|scene| scene.problem.contains("not available yet")) {
        Verdict::Unsupported
    } else if error.is::<SolveFailure>() || error.is::<Box<SolveFailure>>() {
        Verdict::Diverged
    } else {
        Verdict::Failed
    }
}

/// A run of the suite, or of a part of it.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    pub verdict: Verdict,
    /// Number of cases by verdict.
    pub counts: BTreeMap<Verdict, usize>,
    /// Which part of the suite was run.
    pub part: String,
    pub environment: Environment,
    /// Those that failed first, then by name.
    pub cases: Vec<Record>,
    /// Cases that this run did not do.
    pub not_run: Vec<&'static str>,
}

impl Report {
    /// Sorts and counts.
    pub fn new(
        mut cases: Vec<Record>,
        not_run: Vec<&'static str>,
        part: String,
        environment: Environment,
    ) -> Self {
        cases.sort_by_key(|case| (case.verdict, case.name));
        let mut counts = BTreeMap::new();
        for case in &cases {
            *counts.entry(case.verdict).or_default() += 1;
        }
        let fine = !cases.is_empty() && cases.iter().all(Record::is_fine);
        let verdict = if fine { Verdict::Passed } else { Verdict::Failed };
        Self { verdict, counts, part, environment, cases, not_run }
    }

    /// Writes all three files.
    ///
    /// # Errors
    /// One of them cannot be written.
    pub fn write(&self) -> Result<PathBuf, Box<dyn Error>> {
        let folder = folder();
        fs::create_dir_all(&folder)?;
        fs::write(folder.join("report.json"), serde_json::to_string_pretty(self)? + "\n")?;
        fs::write(folder.join("junit.xml"), self.junit()?)?;
        let page = folder.join("report.html");
        fs::write(&page, self.html()?)?;
        Ok(page)
    }

    /// A suite for every problem.
    pub fn junit(&self) -> Result<String, quick_junit::SerializeError> {
        let mut suites: BTreeMap<&str, TestSuite> = BTreeMap::new();
        for case in &self.cases {
            let (problem, what) = case.name.split_once("::").unwrap_or((case.name, case.name));
            let status = match case.verdict {
                Verdict::Passed => TestCaseStatus::success(),
                Verdict::Unsupported => skipped(&case.message),
                Verdict::Failed | Verdict::Diverged => {
                    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                    status.set_message(case.verdict.name());
                    status.set_description(case.explanation());
                    status
                }
            };
            let mut test = TestCase::new(what, status);
            test.set_classname(problem);
            test.set_time(Duration::from_secs_f64(case.seconds));
            suites.entry(problem).or_insert_with(|| TestSuite::new(problem)).add_test_case(test);
        }
        for name in &self.not_run {
            let (problem, what) = name.split_once("::").unwrap_or((name, name));
            let mut test = TestCase::new(what, skipped("not in this run"));
            test.set_classname(problem);
            suites.entry(problem).or_insert_with(|| TestSuite::new(problem)).add_test_case(test);
        }
        let mut report = quick_junit::Report::new("verification");
        report.add_test_suites(suites.into_values());
        report.to_string()
    }
}

fn skipped(message: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::skipped();
    status.set_message(message);
    status
}

/// `verification` in the folder of what is built.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).with_file_name("verification")
}
