//! The page: what the template needs, as text.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;

use minijinja::{Environment as Templates, context};
use serde::Serialize;

use super::{Record, Report, Verdict, plots};
use crate::case::{Check, Kind};
use crate::references::Resource;

const TEMPLATE: &str = include_str!("page.html");

impl Kind {
    /// For the eye.
    fn label(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed form",
            Self::Order => "order",
            Self::Invariant => "invariant",
            Self::CrossCode => "other program",
            Self::Published => "published",
            Self::Pinned => "pinned",
        }
    }
}

#[derive(Serialize)]
struct CheckRow {
    kind: &'static str,
    quantity: String,
    measured: String,
    reference: String,
    error: String,
    bound: String,
    reason: &'static str,
    /// Expected and observed, for orders.
    order: String,
    holds: bool,
    /// Error in parts of the bound.
    share: String,
}

#[derive(Serialize)]
struct CaseBlock<'a> {
    name: &'a str,
    source: &'a str,
    verdict: &'static str,
    message: &'a str,
    seconds: String,
    slow: bool,
    reads: &'a [&'static str],
    kinds: Vec<&'static str>,
    checks: Vec<CheckRow>,
    failed: usize,
    /// The largest error in parts of its bound.
    worst: String,
    plots: Vec<plots::Plot>,
}

#[derive(Serialize)]
struct Reference<'a> {
    name: &'a str,
    resource: ResourceRow<'a>,
    cases: Vec<&'a str>,
}

#[derive(Serialize)]
struct ResourceRow<'a> {
    title: &'a str,
    script: &'a str,
    tools: String,
    parameters: String,
    accuracy: &'a str,
    accuracy_method: &'a str,
    publication: String,
    licence: String,
    hash: &'a str,
}

/// A row of the summary: what a kind of source is held against how often.
#[derive(Serialize)]
struct Tally {
    name: String,
    cases: usize,
    checks: usize,
}

impl Report {
    /// The page.
    pub fn html(&self) -> Result<String, Box<dyn Error>> {
        let mut templates = Templates::new();
        templates.set_trim_blocks(true);
        templates.set_lstrip_blocks(true);
        templates.add_template("page.html", TEMPLATE)?;
        let cases: Vec<CaseBlock> = self.cases.iter().map(block).collect::<Result<_, _>>()?;
        let count = |verdict| self.counts.get(&verdict).copied().unwrap_or(0);
        Ok(templates.get_template("page.html")?.render(context! {
            verdict => self.verdict.name(),
            part => self.part,
            environment => self.environment,
            passed => count(Verdict::Passed),
            failed => count(Verdict::Failed),
            diverged => count(Verdict::Diverged),
            unsupported => count(Verdict::Unsupported),
            checks => self.cases.iter().map(|case| case.checks.len()).sum::<usize>(),
            seconds => format!("{:.0}", self.cases.iter().map(|case| case.seconds).sum::<f64>()),
            kinds => self.kinds(),
            sources => self.sources(),
            references => self.references(),
            cases => cases,
            not_run => self.not_run,
            left_out => crate::cases::LEFT_OUT,
        })?)
    }

    fn kinds(&self) -> Vec<Tally> {
        let mut tallies: BTreeMap<Kind, (BTreeSet<&str>, usize)> = BTreeMap::new();
        for case in &self.cases {
            for check in &case.checks {
                let tally = tallies.entry(check.kind).or_default();
                tally.0.insert(case.name);
                tally.1 += 1;
            }
        }
        let row = |(kind, (cases, checks)): (Kind, (BTreeSet<&str>, usize))| Tally {
            name: kind.label().to_string(),
            cases: cases.len(),
            checks,
        };
        tallies.into_iter().map(row).collect()
    }

    /// By folder of `references/`.
    fn sources(&self) -> Vec<Tally> {
        let mut tallies: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        for case in &self.cases {
            let folders: BTreeSet<&str> =
                case.reads.iter().filter_map(|name| Some(name.split_once('/')?.0)).collect();
            for folder in folders {
                let tally = tallies.entry(folder).or_default();
                tally.0 += 1;
                tally.1 += case.checks.len();
            }
        }
        let row =
            |(name, (cases, checks)): (&str, (usize, usize))| Tally { name: name.to_string(), cases, checks };
        tallies.into_iter().map(row).collect()
    }

    fn references(&self) -> Vec<Reference<'_>> {
        let mut found: BTreeMap<&str, (&Resource, Vec<&str>)> = BTreeMap::new();
        for case in &self.cases {
            for (name, resource) in case.reads.iter().zip(&case.resources) {
                found.entry(name).or_insert((resource, Vec::new())).1.push(case.name);
            }
        }
        let row = |(name, (resource, cases))| Reference { name, resource: described(resource), cases };
        found.into_iter().map(row).collect()
    }
}

fn described(resource: &Resource) -> ResourceRow<'_> {
    let mut tools: Vec<String> =
        resource.tools.iter().map(|(name, version)| format!("{name} {version}")).collect();
    tools.sort();
    let mut parameters: Vec<String> =
        resource.parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    parameters.sort();
    let publications: Vec<String> = resource
        .sources
        .iter()
        .map(|source| {
            format!("{}, table {}, page {}, grade {}", source.title, source.table, source.page, source.grade)
        })
        .collect();
    let licences: Vec<&str> = resource.licenses.iter().map(|licence| licence.name.as_str()).collect();
    ResourceRow {
        title: &resource.title,
        script: &resource.script,
        tools: tools.join(", "),
        parameters: parameters.join("; "),
        accuracy: &resource.accuracy,
        accuracy_method: &resource.accuracy_method,
        publication: publications.join("; "),
        licence: licences.join(", "),
        hash: &resource.hash,
    }
}

fn block(case: &Record) -> Result<CaseBlock<'_>, Box<dyn Error>> {
    let mut plots: Vec<plots::Plot> = plots::convergence(&case.checks)?.into_iter().collect();
    for trajectory in &case.trajectories {
        plots.extend(plots::trajectory(trajectory)?);
    }
    let kinds: BTreeSet<Kind> = case.checks.iter().map(|check| check.kind).collect();
    let worst = case
        .checks
        .iter()
        .map(share)
        .fold(0.0, |worst: f64, share| if share.is_nan() { f64::INFINITY } else { worst.max(share) });
    Ok(CaseBlock {
        name: case.name,
        source: case.source,
        verdict: case.verdict.name(),
        message: &case.message,
        seconds: format!("{:.2}", case.seconds),
        slow: case.slow,
        reads: &case.reads,
        kinds: kinds.into_iter().map(Kind::label).collect(),
        checks: case.checks.iter().map(row).collect(),
        failed: case.checks.iter().filter(|check| !check.holds()).count(),
        worst: format!("{worst:.2}"),
        plots,
    })
}

fn row(check: &Check) -> CheckRow {
    let is_order = check.kind == Kind::Order && check.ladder.is_some();
    CheckRow {
        kind: check.kind.label(),
        quantity: check.quantity.clone(),
        measured: digits(check.measured),
        reference: digits(check.reference),
        error: format!("{:.2e}", check.error),
        bound: format!("{:.2e}", check.bound),
        reason: check.reason,
        order: if is_order { format!("{} / {:.2}", check.reference, check.measured) } else { String::new() },
        holds: check.holds(),
        share: format!("{:.2}", share(check)),
    }
}

/// Error in parts of the bound; something that must be large enough has a negative error and none of it.
fn share(check: &Check) -> f64 {
    if check.error <= 0.0 { 0.0 } else { check.error / check.bound }
}

/// Twelve digits without the zeros that say nothing.
fn digits(value: f64) -> String {
    let text = format!("{value:.11e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => {
            let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
            if exponent == "0" { mantissa.to_string() } else { format!("{mantissa}e{exponent}") }
        }
        None => text,
    }
}
