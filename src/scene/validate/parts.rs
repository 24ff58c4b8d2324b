//! Joints, loads and probes: what they refer to, and their entries.

use super::check::{Check, fail, finite_number, known, listed, non_zero};
use crate::rod::NODE_TOLERANCE;
use crate::scene::read::hint;
use crate::scene::{JointKind, LoadKind, LoadTime, Part, Scene, parse_point};

pub(super) fn joint(scene: &Scene, index: usize) -> Check {
    let joint = &scene.joint[index];
    let key = format!("joint.{index}");
    let between = format!("{key}.between");
    for (end, text) in joint.between.iter().enumerate() {
        place(scene, text, &format!("{between}.{end}"), true)?;
    }
    if let Some([first, second]) = scene.parts(index)
        && first.coincides(&second)
    {
        let what = match first {
            Part::Ground => {
                return fail(
                    between,
                    "joins the ground to itself",
                    "the ground and a body or a point \"rod@ξ\"",
                );
            }
            Part::Body(body) => format!("joins the body {:?} to itself", scene.body[body].name),
            Part::Rod { index, .. } => {
                format!("joins a node of the rod {:?} to itself", scene.rod[index].name)
            }
        };
        return fail(between, what, "two different parts");
    }
    let axis = format!("{key}.axis");
    match (joint.kind, &joint.axis) {
        (JointKind::Revolute, None) => fail(axis, "is missing", "the axis `[x, y, z]` of the revolute joint"),
        (JointKind::Revolute, Some(direction)) => non_zero(&axis, direction, "a direction other than zero"),
        (_, Some(_)) => {
            fail(axis, "is given, but the joint is not revolute", "an axis for revolute joints only")
        }
        (_, None) => Ok(()),
    }
}

pub(super) fn load(scene: &Scene, index: usize) -> Check {
    let load = &scene.load[index];
    let key = format!("load.{index}");
    let on = format!("{key}.on");
    match load.kind {
        LoadKind::Force | LoadKind::Moment => place(scene, &load.on, &on, false)?,
        LoadKind::LineForce | LoadKind::LineMoment => whole_rod(scene, &load.on, &on)?,
    }
    if load.offset.is_some() && load.kind != LoadKind::Force {
        return fail(
            format!("{key}.offset"),
            "is given, but the load is not a force",
            "a lever for loads of kind \"force\" only",
        );
    }
    match &load.time {
        Some(LoadTime::Table(rows)) => time_table(rows, &format!("{key}.time")),
        _ => Ok(()),
    }
}

pub(super) fn probe(scene: &Scene, index: usize) -> Check {
    place(scene, &scene.probe[index].on, &format!("probe.{index}.on"), false)
}

/// A body, a point of a rod or, for joints, the ground.
fn place(scene: &Scene, on: &str, key: &str, ground: bool) -> Check {
    match scene.part(on) {
        Some(Part::Body(_)) => Ok(()),
        Some(Part::Ground) if ground => Ok(()),
        Some(Part::Ground) => {
            fail(key, "is \"ground\", which nothing moves", expected_place(scene, on, ground))
        }
        // As near to an end as a node may be to its ξ.
        Some(Part::Rod { xi, .. }) if (-NODE_TOLERANCE..=1.0 + NODE_TOLERANCE).contains(&xi) => Ok(()),
        Some(Part::Rod { .. }) => {
            fail(key, format!("is {on:?}, beyond the ends of the rod"), "ξ from 0 to 1")
        }
        None => unknown_place(scene, on, key, ground),
    }
}

/// Why a name refers to nothing.
fn unknown_place(scene: &Scene, on: &str, key: &str, ground: bool) -> Check {
    let name = on.rsplit_once('@').map(|(name, _)| name);
    if let Some(name) = name {
        let without_points = match name {
            "ground" if ground => Some("the ground"),
            _ => scene.body.iter().any(|body| body.name == name).then_some("a body"),
        };
        if let Some(what) = without_points {
            return fail(
                key,
                format!("is {on:?}, but {what} has no points"),
                format!("the name alone, {name:?}"),
            );
        }
    }
    if let Some((name, _)) = parse_point(on)
        && !scene.rod.is_empty()
    {
        return known(key, name, &rod_names(scene), &on[name.len()..]);
    }
    let whole = scene.rod.iter().any(|rod| rod.name == on);
    let problem = match (whole, scene.rod.is_empty(), scene.body.is_empty()) {
        (true, ..) => "which is a rod and no point of it",
        (_, false, true) => "which is no point of a rod",
        (_, false, false) => "which is no body and no point of a rod",
        (_, true, _) => "which is no body",
    };
    let mut candidates: Vec<_> = scene.body.iter().map(|body| body.name.clone()).collect();
    candidates.extend(ground.then(|| "ground".to_owned()));
    let hint = if whole { String::new() } else { hint(on, &candidates, '"') };
    fail(key, format!("is {on:?}, {problem}{hint}"), expected_place(scene, on, ground))
}

/// What joints, or loads and probes, may refer to in this scene.
fn expected_place(scene: &Scene, on: &str, ground: bool) -> String {
    let rod = scene.rod.iter().find(|rod| rod.name == on).or(scene.rod.first());
    let point = rod.map(|rod| format!("a rod and ξ from 0 to 1, such as \"{}@1\"", rod.name));
    let names: Vec<_> = scene.body.iter().map(|body| body.name.clone()).collect();
    let bodies = (!names.is_empty()).then(|| listed(&names, "the body", "bodies"));
    let ground = ground.then(|| "\"ground\"".to_owned());
    let all: Vec<_> = point.into_iter().chain(bodies).chain(ground).collect();
    all.join(", or ")
}

/// The name of a rod, for loads along it.
fn whole_rod(scene: &Scene, on: &str, key: &str) -> Check {
    if let Some((name, _)) = on.rsplit_once('@')
        && scene.rod.iter().any(|rod| rod.name == name)
    {
        return fail(
            key,
            format!("is the point {on:?}, but a line load acts along the rod"),
            format!("the rod's name alone, {name:?}"),
        );
    }
    if scene.body.iter().any(|body| body.name == on) {
        return fail(
            key,
            format!("is the body {on:?}, but a line load acts along a rod"),
            "the name of a rod, or the kind \"force\" or \"moment\" for a body",
        );
    }
    known(key, on, &rod_names(scene), "")
}

fn rod_names(scene: &Scene) -> Vec<String> {
    scene.rod.iter().map(|rod| rod.name.clone()).collect()
}

fn time_table(rows: &[[f64; 2]], key: &str) -> Check {
    if rows.is_empty() {
        return fail(key, "is empty", "at least one row `[t, factor]`");
    }
    for (index, pair) in rows.windows(2).enumerate() {
        let ([before, _], [time, _]) = (pair[0], pair[1]);
        if time <= before {
            return fail(
                format!("{key}.{}.0", index + 1),
                format!("is {}, after {}", finite_number(time), finite_number(before)),
                "times that increase from row to row",
            );
        }
    }
    Ok(())
}
