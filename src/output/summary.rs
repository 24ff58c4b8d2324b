//! `summary.json`: how it ended and what it took.

use std::path::Path;

use serde::Serialize;

use super::{Outcome, Results, cannot_write, write_text};
use crate::accuracy::Report;
use crate::error::Error;
use crate::scene::{Analysis, Scene};
use crate::solution::Mode;

#[derive(Serialize)]
struct Summary<'a> {
    status: &'static str,
    message: String,
    title: Option<&'a str>,
    analysis: &'static str,
    unknowns: usize,
    increments: usize,
    rejected: usize,
    newton_iterations: usize,
    most_iterations: usize,
    factorizations: usize,
    residual: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<&'a Report>,
    seconds: Seconds,
    version: &'static str,
    warnings: &'a [String],
}

#[derive(Serialize)]
struct Seconds {
    setup: f64,
    solve: f64,
    output: f64,
}

/// Writes the summary; `output_seconds` is the time the other files took.
pub(super) fn write(dir: &Path, scene: &Scene, outcome: &Outcome, output_seconds: f64) -> Result<(), Error> {
    let solution = &outcome.solution;
    let results = Results { scene, solution };
    let statistics = &solution.statistics;
    let (status, message) = match outcome.stopped() {
        None => ("solved", reached(results)),
        Some(message) => ("stopped", message),
    };
    let summary = Summary {
        status,
        message,
        title: scene.title.as_deref(),
        analysis: results.analysis(),
        unknowns: solution.unknowns,
        increments: statistics.increments,
        rejected: statistics.rejected,
        newton_iterations: statistics.newton_iterations,
        most_iterations: statistics.most_iterations,
        factorizations: statistics.factorizations,
        residual: statistics.residual,
        accuracy: outcome.accuracy.as_ref(),
        seconds: Seconds {
            setup: outcome.setup_seconds,
            solve: outcome.solve_seconds,
            output: output_seconds,
        },
        version: env!("CARGO_PKG_VERSION"),
        warnings: &solution.warnings,
    };
    let path = dir.join("summary.json");
    let mut text =
        serde_json::to_string_pretty(&summary).map_err(|error| cannot_write(&path, error.into()))?;
    text.push('\n');
    write_text(path, &text)
}

/// What a solve that ended well has reached.
fn reached(results: Results) -> String {
    match results.scene.analysis() {
        Some(Analysis::Dynamics(_)) => "the end time is reached".to_owned(),
        Some(Analysis::Modes(_)) => modes_found(&results.solution.modes),
        Some(Analysis::Statics(_)) | None => "the whole load is carried".to_owned(),
    }
}

fn modes_found(modes: &[Mode]) -> String {
    let found = match modes.len() {
        1 => "1 mode found".to_owned(),
        count => format!("{count} modes found"),
    };
    match modes.iter().filter(|mode| mode.angular_frequency < 0.0).count() {
        0 => found,
        unstable => format!("{found}, {unstable} unstable"),
    }
}
