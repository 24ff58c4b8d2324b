//! One rod of the scene → its elements, nodes and reference.

use std::f64::consts::PI;

use nalgebra::Vector3;

use crate::curve::PlacedCurve;
use crate::element::{LineLoad, Stiffness};
use crate::error::SceneError;
use crate::interpolation::Pose;
use crate::load::Course;
use crate::model::RodModel;
use crate::rod::{Needs, RodElements, rod_elements};
use crate::scene::{Analysis, Basis, LoadKind, Reference, Rod, Scene};
use crate::section;
use crate::state::State;

/// Neighbouring nodes may be turned against each other by less than this: beyond half a turn the discrete rod would
/// be another one, and just below it nothing lies between them.
const MOST_TURN: f64 = 0.999 * PI;

/// Rod `index` with its nodes, which come after `first` others in the model.
pub fn build(
    scene: &Scene,
    index: usize,
    curve: PlacedCurve,
    first: usize,
) -> Result<(RodModel, State), SceneError> {
    let rod = &scene.rod[index];
    let key = |name: &str| format!("rod.{index}.{name}");
    let kernel = rod_elements(rod.elements, rod.degree, rod.node_spacing, rod.interpolation, rod.quadrature)
        .ok_or_else(|| SceneError::new(key("interpolation"), "has no such degree", "degree 1 for se3"))?;
    let stiffness = stiffness(rod, &key)?;
    let origin = curve.pose(0.0).position;
    let curve = curve.relative_to(&origin);
    let nodes = reference_nodes(rod, &*kernel, &curve, &key)?;
    let line_loads = line_loads(scene, rod);
    let moves = !matches!(scene.analysis(), Some(Analysis::Statics(_)) | None);
    let inertia = section::inertia(&rod.section, rod.material.as_ref()).filter(|_| moves && rod.inertia);
    let needs = Needs { line_loads: !line_loads.is_empty(), inertia };
    let properties = kernel.properties(nodes.poses(), stiffness, &needs).map_err(|e| {
        too_few(rod, &key, format!("is too coarse: element {e} is degenerate"), 2 * rod.elements)
    })?;
    let weights = match weight_per_length(scene, rod) {
        Some(weight) => kernel.nodal_lengths(&properties).iter().map(|length| weight * *length).collect(),
        None => Vec::new(),
    };
    let rule = kernel.weights();
    let lengths = properties
        .points
        .chunks_exact(rule.len())
        .map(|points| points.iter().zip(&rule).map(|(point, weight)| point.jacobian * weight).sum::<f64>());
    let (length, element_length) =
        lengths.fold((0.0, f64::INFINITY), |(sum, least), x| (sum + x, f64::min(least, x)));
    let model = RodModel {
        name: rod.name.clone(),
        elements: rod.elements,
        degree: rod.degree,
        nodes: nodes.poses().len(),
        length,
        origin,
        range: first..first + nodes.poses().len(),
        kernel,
        properties,
        supports: Vec::new(),
        point_loads: Vec::new(),
        line_loads,
        element_length,
        weights,
    };
    Ok((model, nodes))
}

/// Finite and positive, also where sizes and moduli are each but their products are not.
fn stiffness(rod: &Rod, key: &dyn Fn(&str) -> String) -> Result<Stiffness, SceneError> {
    let stiffness = section::stiffness(&rod.section, rod.material.as_ref())
        .ok_or_else(|| SceneError::new(key("material"), "is incomplete", "two of E, G and ν"))?;
    let all = stiffness.force.iter().chain(&stiffness.moment);
    if all.into_iter().all(|x| x.is_normal() && *x > 0.0) {
        return Ok(stiffness);
    }
    let (force, moment) = (stiffness.force.as_slice(), stiffness.moment.as_slice());
    Err(SceneError::new(
        key("section"),
        format!("has stiffnesses beyond all numbers: {force:?} N, {moment:?} N m²"),
        "sizes and moduli whose products are positive and finite",
    ))
}

fn too_few(rod: &Rod, key: &dyn Fn(&str) -> String, problem: String, enough: usize) -> SceneError {
    let expected = format!("at least {enough} elements of degree {}", rod.degree);
    SceneError::new(key("elements"), problem, expected)
}

/// Nodes on the curve, or fitted to it.
fn reference_nodes(
    rod: &Rod,
    kernel: &dyn RodElements,
    curve: &PlacedCurve,
    key: &dyn Fn(&str) -> String,
) -> Result<State, SceneError> {
    let positions = kernel.node_positions();
    let widest = positions.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let turn = widest * curve.total_turn();
    if turn > MOST_TURN {
        let enough = |angle: f64| (rod.elements as f64 * turn / angle).ceil();
        let (least, better) = (enough(MOST_TURN), enough(0.5 * PI));
        return Err(SceneError::new(
            key("elements"),
            format!("lets neighbouring nodes be {turn:.4?} rad apart, half a turn or more"),
            format!("at least {least:?}, better {better:?} elements of degree {}", rod.degree),
        ));
    }
    let mut nodes = State::from_poses(positions.iter().map(|&xi| curve.pose(xi)));
    let samples = match (curve.given_poses(), rod.reference) {
        (Some(poses), _) => poses,
        (None, Reference::Fit { samples }) => samples,
        (None, Reference::Nodes) => return Ok(nodes),
    };
    let key = key(if curve.given_poses().is_some() { "curve.file" } else { "reference" });
    let count = positions.len();
    if samples < count {
        let (residuals, unknowns) = (6 * samples, 6 * count);
        return Err(SceneError::new(
            key,
            format!("fits {count} nodes to {samples} samples, {residuals} residuals for {unknowns} unknowns"),
            format!("at least {count} samples, or fewer elements"),
        ));
    }
    let targets: Vec<Pose> = (0..samples).map(|j| curve.pose(j as f64 / (samples - 1) as f64)).collect();
    kernel.fit(&mut nodes, &targets).map_err(|error| {
        SceneError::new(key, format!("fit failed: {error}"), "more elements or smoother poses")
    })?;
    Ok(nodes)
}

/// Its weight per reference length, where it takes part in gravity [N/m].
fn weight_per_length(scene: &Scene, rod: &Rod) -> Option<Vector3<f64>> {
    let gravity = scene.gravity.filter(|gravity| rod.gravity && *gravity != [0.0; 3])?;
    Some(Vector3::from(gravity) * section::mass_per_length(&rod.section, rod.material.as_ref())?)
}

/// Gravity and the line loads on a rod.
fn line_loads(scene: &Scene, rod: &Rod) -> Vec<(LineLoad, Course)> {
    let mut result = Vec::new();
    if let Some(force) = weight_per_length(scene, rod) {
        result.push((LineLoad { force, ..LineLoad::default() }, Course::default_for(scene)));
    }
    for load in scene.load.iter().filter(|load| load.on == rod.name) {
        let value = Vector3::from(load.value);
        let mut line = LineLoad::default();
        match (load.kind, load.basis) {
            (LoadKind::LineForce, Basis::Inertial) => line.force = value,
            (LoadKind::LineForce, Basis::Body) => line.body_force = value,
            (LoadKind::LineMoment, Basis::Inertial) => line.moment = value,
            (LoadKind::LineMoment, Basis::Body) => line.body_moment = value,
            (LoadKind::Force | LoadKind::Moment, _) => continue,
        }
        result.push((line, Course::new(load.time.as_ref(), scene)));
    }
    result
}
