//! The lists of a study.

use super::check::{Check, MOST, at_least_one, fail, finite_number, positive};
use crate::scene::study::{Increments, Study, Tolerance};
use crate::scene::{Analysis, Scene};

/// More runs than this are a slip of the keyboard.
const MOST_RUNS: usize = 1000;

pub(super) fn study(scene: &Scene) -> Check {
    let Some(study) = &scene.study else { return Ok(()) };
    beside_its_analysis(scene, study)?;
    of_rods(scene, study)?;
    let runs = [
        entries("degree", &study.degree, |key, degree| match degree {
            1..=8 => Ok(()),
            _ => fail(key, format!("is {degree}"), "a degree from 1 to 8"),
        })?,
        entries("elements", &study.elements, |key, count| at_least_one(key, *count, "elements"))?,
        entries("interpolation", &study.interpolation, |_, _| Ok(()))?,
        entries("increments", &study.increments, |key, increments| match increments {
            Increments::Equal(count) => at_least_one(key, *count, "increments"),
            Increments::Automatic => Ok(()),
        })?,
        entries("time_step", &study.time_step, |key, step| time_step(scene, key, *step))?,
        entries("tolerance", &study.tolerance, |key, tolerance| match tolerance {
            Tolerance::Absolute(tolerance) => positive(key, *tolerance, "a positive tolerance [N, N m]"),
            Tolerance::Relative => Ok(()),
        })?,
    ];
    entries("accuracies", &study.accuracies, |key, accuracy| {
        positive(key, *accuracy, "a positive accuracy, relative to the rods' length and in radians")
    })?;
    let runs = runs.iter().fold(1_usize, |product, count| product.saturating_mul(*count));
    if runs > MOST_RUNS {
        let expected = format!("lists whose lengths multiply to at most {MOST_RUNS}");
        return fail("study", format!("asks for {runs} combinations"), expected);
    }
    Ok(())
}

/// Modes have no path to take errors over, and increments and time steps one analysis each.
fn beside_its_analysis(scene: &Scene, study: &Study) -> Check {
    let beside = |key: &str, analysis: &str, only: &str| {
        fail(
            format!("study.{key}"),
            format!("is given beside `[{analysis}]`"),
            format!("it only beside `[{only}]`"),
        )
    };
    match scene.analysis() {
        Some(Analysis::Modes(_)) => fail(
            "study",
            "is given beside `[modes]`, which have no path on which runs could be compared",
            "`[statics]` or `[dynamics]` beside it",
        ),
        Some(Analysis::Dynamics(_)) if study.increments.is_some() => {
            beside("increments", "dynamics", "statics")
        }
        Some(Analysis::Statics(_)) if study.time_step.is_some() => beside("time_step", "statics", "dynamics"),
        _ => Ok(()),
    }
}

/// Without rods there is nothing to mesh.
fn of_rods(scene: &Scene, study: &Study) -> Check {
    let lists = [
        ("degree", study.degree.is_some()),
        ("elements", study.elements.is_some()),
        ("interpolation", study.interpolation.is_some()),
    ];
    match lists.into_iter().find(|(_, given)| *given) {
        Some((name, _)) if scene.rod.is_empty() => {
            fail(format!("study.{name}"), "is given, but the scene has no rod", "it only beside `[[rod]]`")
        }
        _ => Ok(()),
    }
}

/// As [`super::analysis`] has it for the scene's own.
fn time_step(scene: &Scene, key: &str, step: f64) -> Check {
    positive(key, step, "a positive time step [s]")?;
    let Some(options) = &scene.dynamics else { return Ok(()) };
    let steps = options.end_time / step;
    if steps < 1.0 || steps > MOST as f64 {
        return fail(
            key,
            format!("is {}, which makes {steps:.3e} steps up to the end time", finite_number(step)),
            format!("a time step that makes at least 1 and at most {MOST} steps"),
        );
    }
    Ok(())
}

/// Checks the entries of a list and returns how many different settings it stands for.
fn entries<T: PartialEq>(
    name: &str,
    list: &Option<Vec<T>>,
    check: impl Fn(&str, &T) -> Check,
) -> Result<usize, crate::error::SceneError> {
    let Some(list) = list else { return Ok(1) };
    let key = format!("study.{name}");
    if list.is_empty() {
        fail(key.as_str(), "is empty", "at least one entry, or no such list")?;
    }
    for (index, entry) in list.iter().enumerate() {
        let key = format!("{key}.{index}");
        check(&key, entry)?;
        if list[..index].contains(entry) {
            fail(key, "is listed before", "every entry only once")?;
        }
    }
    Ok(list.len())
}
