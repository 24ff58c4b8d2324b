//! `cosserat study`: speed against accuracy on a scene.

use std::path::Path;

use cosserat::output::{self, study as files};
use cosserat::scene::{InterpolationKind, Scene};
use cosserat::solution::Statistics;
use cosserat::study::{Advice, Key, Plan, Reference, Row, SOLVED, Stop, advice};
use cosserat::{Error, SceneError};
use indicatif::ProgressBar;

use crate::{Failure, SceneArguments, load, progress_bar, say};

/// Runs what is not in the folder yet; every run is written at once.
pub fn study(arguments: &SceneArguments, out: &Path, quiet: bool) -> Result<(), Failure> {
    let (file, scene, _) = load(arguments)?;
    let plan = Plan::new(&scene).map_err(|error| Error::Scene(file.locate(error)))?;
    output::create(out)?;
    // Before a reference is looked for, which may take minutes.
    files::try_to_write(out)?;
    let stored = files::read(out, &plan).map_err(|error| match error {
        Error::Scene(error) => Error::Scene(SceneError { place: Some(out.display().to_string()), ..error }),
        other => other,
    })?;
    let bar = progress_bar(quiet);
    let outcome = complete(&plan, &scene, out, stored, &bar);
    bar.finish_and_clear();
    let (reference, rows) = outcome.map_err(|stop| match stop {
        Stop::Setup(Error::Scene(error)) => Failure::Library(Error::Scene(file.locate(error))),
        Stop::Setup(error) => Failure::Library(error),
        Stop::Solver(failure) => Failure::Reference(failure.error),
    })?;
    report(&plan, &scene, &reference, &rows);
    say(format_args!("results in {}", out.display()));
    Ok(())
}

fn complete(
    plan: &Plan,
    scene: &Scene,
    out: &Path,
    stored: Option<files::Stored>,
    bar: &ProgressBar,
) -> Result<(Reference, Vec<Row>), Stop> {
    let count = plan.keys().len();
    let (reference, mut known) = match stored {
        Some(files::Stored { reference, rows }) => {
            say(format_args!("{} of {count} runs are there already", rows.len()));
            (reference, rows)
        }
        None => {
            let reference = plan.reference(&mut |run, done, work| {
                show(
                    bar,
                    done,
                    &format!("reference, run {}, {} iterations", run + 1, work.newton_iterations),
                );
            })?;
            files::write_reference(out, plan, &reference)?;
            (reference, Vec::new())
        }
    };
    let title = scene.title.as_deref();
    files::write_rows(out, &known)?;
    for (index, key) in plan.keys().enumerate() {
        if known.get(index).is_some_and(|row| row.key == *key) {
            continue;
        }
        let name = describe(key, &Shown::all());
        let mut progress = |done: f64, _: &Statistics| {
            let done = (index as f64 + done) / count as f64;
            show(bar, done, &format!("run {} of {count}: {name}", index + 1));
        };
        progress(0.0, &Statistics::default());
        known.insert(index, plan.run(index, &reference, &mut progress));
        files::write_rows(out, &known)?;
        files::draw(out, title, &known, &reference.error)?;
    }
    files::draw(out, title, &known, &reference.error)?;
    Ok((reference, known))
}

/// A part of the whole, and what is being done.
fn show(bar: &ProgressBar, done: f64, message: &str) {
    bar.set_position((1000.0 * done.clamp(0.0, 1.0)) as u64);
    bar.set_message(message.to_owned());
}

fn report(plan: &Plan, scene: &Scene, reference: &Reference, rows: &[Row]) {
    let own = Key {
        degree: reference.degree,
        elements: reference.elements,
        time_step: reference.time_step,
        ..Key::default()
    };
    let name = describe(&own, &Shown { time_step: true, ..Shown::default() });
    let name = if name.is_empty() { String::new() } else { format!("{name}, ") };
    say(format_args!("reference: {name}its own error is about {}", reference.error));
    let failed = rows.iter().filter(|row| row.status != SOLVED).count();
    let runs = if rows.len() == 1 { "run" } else { "runs" };
    match failed {
        0 => say(format_args!("{} {runs}", rows.len())),
        _ => say(format_args!("{} {runs}, {failed} of which failed: study.csv says why", rows.len())),
    }
    let shown = Shown::of(rows);
    for &accuracy in plan.accuracies() {
        say(sentence(accuracy, rows, reference, &shown, scene));
    }
}

/// What is advised for an accuracy.
fn sentence(accuracy: f64, rows: &[Row], reference: &Reference, shown: &Shown, scene: &Scene) -> String {
    let accuracy_name = short(accuracy);
    match advice(rows, accuracy, &reference.error) {
        Advice::Take(row) => {
            let time = row.seconds.map(|seconds| format!(", {}", duration(seconds))).unwrap_or_default();
            format!("for {accuracy_name}: {}{time}", named(row, shown, scene))
        }
        Advice::Unreached(Some(row)) => {
            let error =
                row.errors.map(|errors| format!(", has {:.1e}", errors.largest())).unwrap_or_default();
            format!(
                "for {accuracy_name}: no run reaches it; the nearest, {}{error}",
                named(row, shown, scene)
            )
        }
        Advice::Unreached(None) => format!("for {accuracy_name}: no run arrived"),
        Advice::Unknown => format!("for {accuracy_name}: unknown, the reference itself is no better"),
    }
}

/// The settings of a run, or that they are those of the scene.
fn named(row: &Row, shown: &Shown, scene: &Scene) -> String {
    let own = if row.key == Key::of(scene) { " (as the scene has it)" } else { "" };
    match describe(&row.key, shown) {
        text if text.is_empty() => "the scene as it is".to_owned(),
        text => format!("{text}{own}"),
    }
}

/// Which settings are worth a word.
#[derive(Default)]
struct Shown {
    increments: bool,
    time_step: bool,
    tolerance: bool,
}

impl Shown {
    fn all() -> Self {
        Self { increments: true, time_step: true, tolerance: true }
    }

    /// Those that differ among the rows.
    fn of(rows: &[Row]) -> Self {
        let differ =
            |same: &dyn Fn(&Key, &Key) -> bool| rows.windows(2).any(|pair| !same(&pair[0].key, &pair[1].key));
        Self {
            increments: differ(&|a, b| a.increments == b.increments),
            time_step: differ(&|a, b| a.time_step == b.time_step),
            tolerance: differ(&|a, b| a.tolerance == b.tolerance),
        }
    }
}

/// "degree 3, 20 elements", and what else is shown.
fn describe(key: &Key, shown: &Shown) -> String {
    let mut parts = Vec::new();
    parts.extend(key.degree.map(|degree| format!("degree {degree}")));
    parts.extend(key.elements.map(|elements| match elements {
        1 => "1 element".to_owned(),
        _ => format!("{elements} elements"),
    }));
    match key.interpolation {
        Some(InterpolationKind::Se3) => parts.push("SE(3)".to_owned()),
        Some(InterpolationKind::Quaternion) => parts.push("quaternions".to_owned()),
        Some(InterpolationKind::R12) | None => {}
    }
    if shown.time_step {
        parts.extend(key.time_step.map(|step| format!("step {} s", short(step))));
    }
    if shown.increments {
        parts.extend(key.increments.map(|count| format!("{count} equal increments")));
    }
    if shown.tolerance {
        parts.extend(key.tolerance.map(|tolerance| format!("tolerance {}", short(tolerance))));
    }
    parts.join(", ")
}

/// Four digits, without the zeros that say nothing.
fn short(number: f64) -> String {
    let text = format!("{number:.3e}");
    let rounded: f64 = text.parse().unwrap_or(number);
    if (0.1..1e4).contains(&rounded) { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// In the unit that reads well.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.0} µs", 1e6 * s),
        s if s < 1e-2 => format!("{:.1} ms", 1e3 * s),
        s if s < 1.0 => format!("{:.0} ms", 1e3 * s),
        s if s < 10.0 => format!("{s:.2} s"),
        s => format!("{s:.0} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        for (number, wanted) in [
            (1e-2, "1e-2"),
            (1e-4, "1e-4"),
            (5e-3, "5e-3"),
            (1.0 / 3.0, "0.3333"),
            (0.5, "0.5"),
            (2.0, "2"),
            (1.25e-5, "1.25e-5"),
            (12345.0, "1.234e4"),
        ] {
            assert_eq!(short(number), wanted);
        }
        for (seconds, wanted) in
            [(2.34e-4, "234 µs"), (2.34e-3, "2.3 ms"), (0.0123, "12 ms"), (1.5, "1.50 s"), (75.0, "75 s")]
        {
            assert_eq!(duration(seconds), wanted);
        }
    }
}
