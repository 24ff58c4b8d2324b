//! From a scene to the numbers that are checked.

use std::error::Error;

use cosserat::scene::{Basis, Joint, JointKind, Load, LoadKind, Probe, Scene};
use cosserat::solution::{ProbePose, Solution};
use cosserat::{Model, statics};
use nalgebra::Vector3;

use crate::placement::Placement;

/// Builds and solves a static scene.
pub fn solve(scene: &Scene) -> Result<Solution, Box<dyn Error>> {
    let model = Model::new(scene)?;
    let options = scene.statics.clone().unwrap_or_default();
    Ok(statics::solve(&model, &options, &mut |_, _| ())?)
}

/// Displacement of probe `index` from the first row to the last, in the axes of the scene before it was placed.
pub fn displacement(
    solution: &Solution,
    index: usize,
    placement: &Placement,
) -> Result<Vector3<f64>, Box<dyn Error>> {
    let [first, last] = ends(solution, index)?;
    Ok(placement.undo_direction(Vector3::from(last.position) - Vector3::from(first.position)))
}

/// Last position of probe `index` in the scene before it was placed.
pub fn position(
    solution: &Solution,
    index: usize,
    placement: &Placement,
) -> Result<Vector3<f64>, Box<dyn Error>> {
    let [_, last] = ends(solution, index)?;
    Ok(placement.undo_position(Vector3::from(last.position)))
}

fn ends(solution: &Solution, index: usize) -> Result<[&ProbePose; 2], Box<dyn Error>> {
    let (Some(first), Some(last)) = (solution.rows.first(), solution.rows.last()) else {
        return Err("the solution has no rows".into());
    };
    Ok([first.probes.get(index).ok_or("no such probe")?, last.probes.get(index).ok_or("no such probe")?])
}

/// A clamp of `rod@ξ`.
pub fn clamp(on: &str) -> Joint {
    let between = ["ground".to_string(), on.to_string()];
    Joint { name: None, kind: JointKind::Rigid, between, point: None, axis: None }
}

/// A ramped dead load; change what differs.
pub fn load(kind: LoadKind, on: &str, value: [f64; 3]) -> Load {
    Load { kind, on: on.to_string(), value, basis: Basis::Inertial, offset: None, time: None }
}

/// A probe.
pub fn probe(name: &str, on: &str) -> Probe {
    Probe { name: name.to_string(), on: on.to_string(), offset: None, angles: None }
}
