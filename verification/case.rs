//! A case: a problem, its source, and checks that each name a quantity, a reference, a bound and the bound's reason.

use std::error::Error;
use std::fmt::Write;

use serde::Serialize;

use crate::references::{self, Table};

/// What a case's function returns: an error stands for a problem that could not be solved at all.
pub type Outcome = Result<(), Box<dyn Error>>;

/// One named test.
pub struct Case {
    /// `problem::what`, the name to filter by.
    pub name: &'static str,
    /// Where problem and reference come from.
    pub source: &'static str,
    /// Solves and checks.
    pub run: fn(&mut Checks) -> Outcome,
    /// The files under `references/` that it reads, `source/name.csv`.
    pub reads: &'static [&'static str],
    /// Not in the fast part of the suite: it takes more than a second or two.
    pub slow: bool,
    /// What the solver cannot do yet and this case needs.
    pub awaits: Option<&'static str>,
}

impl Case {
    /// A fast case that reads no file.
    pub fn new(name: &'static str, source: &'static str, run: fn(&mut Checks) -> Outcome) -> Self {
        Self { name, source, run, reads: &[], slow: false, awaits: None }
    }

    /// The same, which reads these files.
    pub fn reads(self, reads: &'static [&'static str]) -> Self {
        Self { reads, ..self }
    }

    /// The same, in the full part of the suite only.
    pub fn slow(self) -> Self {
        Self { slow: true, ..self }
    }

    /// The same, of something that the solver refuses as not available yet. Once it is there the case fails until it
    /// no longer says so.
    pub fn awaits(self, feature: &'static str) -> Self {
        Self { awaits: Some(feature), ..self }
    }
}

/// What a reference is worth, strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A closed form, or the continuous equations solved without finite elements.
    ClosedForm,
    /// An order of convergence.
    Order,
    /// Something that must not change.
    Invariant,
    /// Another program's figure.
    CrossCode,
    /// A printed figure.
    Published,
    /// Our own figure, against regression only.
    Pinned,
}

/// The errors behind an order, for a plot.
#[derive(Clone, Debug, Serialize)]
pub struct Ladder {
    /// Numbers of elements or of time steps.
    pub sizes: Vec<usize>,
    pub errors: Vec<f64>,
}

/// One comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    pub kind: Kind,
    pub quantity: String,
    pub measured: f64,
    pub reference: f64,
    /// What is held against the bound.
    pub error: f64,
    pub bound: f64,
    /// Why the bound is what it is.
    pub reason: &'static str,
    /// What an order was taken from.
    pub ladder: Option<Ladder>,
}

impl Check {
    /// False for NaN as well.
    pub fn holds(&self) -> bool {
        self.error <= self.bound
    }
}

/// What was computed as a line, the reference as dots, for the report.
#[derive(Clone, Debug)]
pub struct Trajectory {
    pub title: String,
    /// Names of the axes, with units.
    pub axes: [&'static str; 2],
    pub measured: Vec<[f64; 2]>,
    /// Whose figures they are.
    pub source: &'static str,
    pub reference: Vec<[f64; 2]>,
}

/// The checks of a case.
#[derive(Default)]
pub struct Checks {
    list: Vec<Check>,
    trajectories: Vec<Trajectory>,
    /// What the case said it would read, and what it did read.
    declared: &'static [&'static str],
    read: Vec<(&'static str, Table)>,
}

impl Checks {
    /// None yet, for a case.
    pub fn of(case: &Case) -> Self {
        Self { declared: case.reads, ..Self::default() }
    }

    /// A file under `references/` that the case has declared, `source/name.csv`.
    ///
    /// # Errors
    /// It was not declared, is missing, or is not what its descriptor says.
    pub fn reference(&mut self, name: &str) -> Result<Table, Box<dyn Error>> {
        let declared = self.declared.iter().find(|declared| **declared == name);
        let declared = declared.ok_or_else(|| format!("the case does not say that it reads {name}"))?;
        let table = Table::read(&references::root(), declared)?;
        if !self.read.iter().any(|(read, _)| read == declared) {
            self.read.push((declared, table.clone()));
        }
        Ok(table)
    }

    /// What was declared and has not been read.
    pub fn unread(&self) -> Vec<&'static str> {
        let read = |name: &&&str| self.read.iter().any(|(read, _)| read == *name);
        self.declared.iter().filter(|name| !read(name)).copied().collect()
    }

    /// |measured − reference| ≤ bound.
    pub fn absolute(
        &mut self,
        kind: Kind,
        quantity: impl Into<String>,
        (measured, reference): (f64, f64),
        bound: f64,
        reason: &'static str,
    ) {
        let error = (measured - reference).abs();
        self.push(Check {
            kind,
            quantity: quantity.into(),
            measured,
            reference,
            error,
            bound,
            reason,
            ladder: None,
        });
    }

    /// |measured − reference| ≤ bound · |reference|.
    pub fn relative(
        &mut self,
        kind: Kind,
        quantity: impl Into<String>,
        (measured, reference): (f64, f64),
        bound: f64,
        reason: &'static str,
    ) {
        let error = ((measured - reference) / reference).abs();
        self.push(Check {
            kind,
            quantity: quantity.into(),
            measured,
            reference,
            error,
            bound,
            reason,
            ladder: None,
        });
    }

    /// |measured − reference| ≤ bound in the Euclidean norm; the table shows the norms.
    pub fn vector(
        &mut self,
        kind: Kind,
        quantity: impl Into<String>,
        (measured, reference): ([f64; 3], [f64; 3]),
        bound: f64,
        reason: &'static str,
    ) {
        let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let error = norm(std::array::from_fn(|k| measured[k] - reference[k]));
        let (measured, reference) = (norm(measured), norm(reference));
        self.push(Check {
            kind,
            quantity: quantity.into(),
            measured,
            reference,
            error,
            bound,
            reason,
            ladder: None,
        });
    }

    /// value ≤ bound, for an error that was measured already.
    pub fn below(
        &mut self,
        kind: Kind,
        quantity: impl Into<String>,
        value: f64,
        bound: f64,
        reason: &'static str,
    ) {
        let quantity = quantity.into();
        self.push(Check {
            kind,
            quantity,
            measured: value,
            reference: 0.0,
            error: value,
            bound,
            reason,
            ladder: None,
        });
    }

    /// value ≥ bound, for something that must be seen to be large.
    pub fn above(
        &mut self,
        kind: Kind,
        quantity: impl Into<String>,
        value: f64,
        bound: f64,
        reason: &'static str,
    ) {
        let quantity = format!("{} (at least {bound:.3e})", quantity.into());
        self.push(Check {
            kind,
            quantity,
            measured: value,
            reference: bound,
            error: bound - value,
            bound: 0.0,
            reason,
            ladder: None,
        });
    }

    /// The order ln(e₁/e₂)/ln(n₂/n₁) of the finest pair of meshes with n₁ < n₂ elements, against the expected one.
    pub fn order(
        &mut self,
        quantity: impl Into<String>,
        meshes: &[usize],
        errors: &[f64],
        (expected, tolerance): (f64, f64),
        reason: &'static str,
    ) {
        let last = meshes.len().min(errors.len());
        let measured = if last < 2 {
            f64::NAN
        } else {
            (errors[last - 2] / errors[last - 1]).ln()
                / (meshes[last - 1] as f64 / meshes[last - 2] as f64).ln()
        };
        let ladder = Some(Ladder { sizes: meshes.to_vec(), errors: errors.to_vec() });
        let errors: Vec<String> = errors.iter().map(|error| format!("{error:.3e}")).collect();
        let quantity = format!("{}: order on {meshes:?}, errors [{}]", quantity.into(), errors.join(", "));
        let error = (measured - expected).abs();
        let (kind, reference, bound) = (Kind::Order, expected, tolerance);
        self.push(Check { kind, quantity, measured, reference, error, bound, reason, ladder });
    }

    /// A picture beside the numbers; it checks nothing.
    pub fn trajectory(&mut self, trajectory: Trajectory) {
        self.trajectories.push(trajectory);
    }

    fn push(&mut self, check: Check) {
        self.list.push(check);
    }

    /// Whether there are checks and all of them hold.
    pub fn hold(&self) -> bool {
        !self.list.is_empty() && self.list.iter().all(Check::holds)
    }

    /// All of them, in the order they were made.
    pub fn list(&self) -> &[Check] {
        &self.list
    }

    /// The checks, the files that were read, and the pictures.
    pub fn into_parts(self) -> (Vec<Check>, Vec<(&'static str, Table)>, Vec<Trajectory>) {
        (self.list, self.read, self.trajectories)
    }
}

/// Checks as text, those that fail first.
pub fn table(checks: &[Check]) -> String {
    let mut sorted: Vec<&Check> = checks.iter().collect();
    sorted.sort_by_key(|check| check.holds());
    let mut text = String::new();
    for check in sorted {
        let verdict = if check.holds() { "ok    " } else { "FAILED" };
        let Check { kind, quantity, measured, reference, error, bound, reason, .. } = check;
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{verdict} {kind:?}: {quantity}: {measured:.12e}, reference {reference:.12e}, \
             error {error:.3e}, bound {bound:.3e} ({reason})"
        );
    }
    text
}
