//! The analysis: exactly one, its settings, and what they ask of the rest of the scene.

use super::check::{Check, MOST, at_least_one, fail, finite_number, positive};
use crate::load::Course;
use crate::scene::{Analysis, Coordinates, Dynamics, Method, Modes, Rod, Scene, Statics, Step, parse_point};

const TABLES: [&str; 3] = ["statics", "dynamics", "modes"];

/// Exactly one of `[statics]`, `[dynamics]` and `[modes]`, given which of them there are.
pub(in crate::scene) fn one_analysis(present: [bool; 3]) -> Check {
    let mut given = TABLES.iter().zip(present).filter(|(_, present)| *present).map(|(table, _)| *table);
    match (given.next(), given.next()) {
        (None, _) => fail(
            "statics",
            "is missing, so the scene asks for nothing",
            "one of the tables `[statics]`, which may be empty, `[dynamics]` and `[modes]`",
        ),
        (Some(_), None) => Ok(()),
        (Some(first), Some(second)) => fail(
            second,
            format!("is given beside `[{first}]`"),
            "only one of `[statics]`, `[dynamics]` and `[modes]`",
        ),
    }
}

pub(super) fn analysis(scene: &Scene) -> Check {
    match scene.analysis() {
        Some(Analysis::Statics(options)) => statics(scene, options),
        Some(Analysis::Dynamics(options)) => dynamics(scene, options),
        Some(Analysis::Modes(options)) => modes(options),
        None => Ok(()),
    }
}

fn statics(scene: &Scene, options: &Statics) -> Check {
    if let Some(increments) = options.increments {
        at_least_one("statics.increments", increments, "increments")?;
    }
    if let Some(tolerance) = options.tolerance {
        positive("statics.tolerance", tolerance, "a positive tolerance [N, N m]")?;
    }
    at_least_one("statics.max_iterations", options.max_iterations, "iterations")?;
    if options.coordinates == Coordinates::Increments {
        return Ok(());
    }
    let what = match (scene.body.first(), first_multiplied(scene)) {
        (Some(body), _) => format!("bodies, such as {:?}", body.name),
        (None, Some(joint)) => format!("joints that need multipliers, such as {joint:?}"),
        (None, None) => return Ok(()),
    };
    fail(
        "statics.coordinates",
        format!("is \"quaternions\", which is not available yet for {what}"),
        "\"increments\"",
    )
}

fn dynamics(scene: &Scene, options: &Dynamics) -> Check {
    positive("dynamics.end_time", options.end_time, "a positive time [s]")?;
    match options.step {
        Step::Constant(time_step) => constant_step(options.end_time, time_step)?,
        Step::Accuracy(accuracy) => positive("dynamics.accuracy", accuracy, ACCURACY)?,
    }
    if let Some(tolerance) = options.tolerance {
        positive("dynamics.tolerance", tolerance, "a positive tolerance [N, N m; m, rad for joints]")?;
    }
    at_least_one("dynamics.max_iterations", options.max_iterations, "iterations")?;
    spectral_radius(scene, options)?;
    let mut massless = scene.rod.iter().enumerate().filter(|(_, rod)| !rod.inertia);
    if options.method == Method::Radau
        && let Some((index, _)) = massless.clone().next()
    {
        return fail(
            format!("rod.{index}.inertia"),
            "is false, but the method \"radau\" needs inertia of every rod",
            "true, or the method \"generalized-alpha\"",
        );
    }
    massless.try_for_each(|(index, rod)| unloaded_start(scene, rod, index))
}

const ACCURACY: &str = "a positive part of the rods' length, and angle [rad]";

fn constant_step(end_time: f64, time_step: f64) -> Check {
    positive("dynamics.time_step", time_step, "a positive time step [s]")?;
    if time_step > end_time {
        return fail(
            "dynamics.time_step",
            format!("is {}, longer than the whole motion", finite_number(time_step)),
            format!("at most the end time, {} [s]", finite_number(end_time)),
        );
    }
    let steps = end_time / time_step;
    if steps > MOST as f64 {
        return fail(
            "dynamics.time_step",
            format!("is {}, which makes {steps:.3e} steps up to the end time", finite_number(time_step)),
            format!("a time step that makes at most {MOST} steps"),
        );
    }
    Ok(())
}

/// Exactly one of the two, given what the table has.
pub(in crate::scene) fn one_step(time_step: bool, accuracy: bool) -> Check {
    match (time_step, accuracy) {
        (false, false) => fail(
            "dynamics.time_step",
            "is missing, and so is `accuracy`",
            format!("either a positive time step [s], or `accuracy`: {ACCURACY}"),
        ),
        (true, true) => fail(
            "dynamics.accuracy",
            "is given beside `time_step`",
            "either a constant `time_step` [s], or the `accuracy` that the steps are chosen by",
        ),
        _ => Ok(()),
    }
}

/// What acts at once on a rod without inertia would move it at once: from the unstressed start there is no motion.
fn unloaded_start(scene: &Scene, rod: &Rod, index: usize) -> Check {
    if rod.gravity && scene.gravity.is_some_and(|gravity| gravity != [0.0; 3]) {
        return fail(
            format!("rod.{index}.gravity"),
            "is true, but a rod without inertia that weighs something has no motion from the unstressed start",
            "`gravity = false`, or `inertia = true`",
        );
    }
    for (index, load) in scene.load.iter().enumerate() {
        let name = parse_point(&load.on).map_or(load.on.as_str(), |(name, _)| name);
        let acts = Course::new(load.time.as_ref(), scene).factor(0.0) != 0.0 && load.value != [0.0; 3];
        if name == rod.name && acts {
            return fail(
                format!("load.{index}.time"),
                format!(
                    "lets the load act at once on the rod {:?}, which has no inertia and so no motion from the \
                     unstressed start",
                    rod.name
                ),
                "a table that starts from 0, such as `[[0, 0], [0.1, 1]]`, or a rod with `inertia = true`",
            );
        }
    }
    Ok(())
}

/// In [0, 1]; 1 only without position-level constraints, whose multipliers it would let grow.
fn spectral_radius(scene: &Scene, options: &Dynamics) -> Check {
    let radius = options.spectral_radius;
    let key = "dynamics.spectral_radius";
    if !(0.0..=1.0).contains(&radius) {
        return fail(key, format!("is {}", finite_number(radius)), "a spectral radius from 0 to 1");
    }
    if radius < 1.0 || options.method != Method::GeneralizedAlpha {
        return Ok(());
    }
    if let Some(rod) = scene.rod.iter().find(|rod| !rod.inertia) {
        return fail(
            key,
            format!("is 1, which never calms the velocities of the rod {:?}, which has no inertia", rod.name),
            "a spectral radius from 0 to below 1",
        );
    }
    match first_multiplied(scene) {
        None => Ok(()),
        Some(joint) => fail(
            key,
            format!("is 1, which lets the forces of joints such as {joint:?} grow from step to step"),
            "a spectral radius from 0 to below 1, or only rods clamped to the ground and free bodies",
        ),
    }
}

fn first_multiplied(scene: &Scene) -> Option<String> {
    let index = (0..scene.joint.len()).find(|&index| scene.multiplied(index))?;
    Some(scene.joint_name(index))
}

fn modes(options: &Modes) -> Check {
    at_least_one("modes.count", options.count, "modes")
}
