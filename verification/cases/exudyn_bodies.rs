//! A torque-free nut that flips and the heavy top, against Exudyn over their whole course.
//!
//! The references are Exudyn's rotation-vector Lie-group node under the explicit RK67,
//! `scripts/references/exudyn_rigid_bodies.py`: rotations good to 3e-11 and 3e-10 rad, each row with its own figures.

use std::error::Error;

use cosserat::scene::{Body, Dynamics, Method, Scene};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use super::exudyn_chains::{Course, State, check_alpha, check_order, check_radau, kinetic, runs};
use super::heavy_top;
use crate::case::{Case, Checks, Outcome, Trajectory};
use crate::measure::probe;
use crate::placement::placements;
use crate::references::Table;
use crate::steps::{body, rotation};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let source = "Exudyn, Lie-group node and RK67, scripts/references/exudyn_rigid_bodies.py";
    let case = |name, function| Case::new(name, source, function).reads(&["exudyn/rigid_body_motion.csv"]);
    vec![case("exudyn_bodies::nut", nut), case("exudyn_bodies::heavy_top", top).slow()]
}

/// Of either body in the reference.
const TIMES: usize = 100;

/// Exudyn's course: rotations about the point that stays where it is; `arm` leads from there to the centre of mass.
fn reference(table: &Table, name: &str, inertia: [f64; 3], arm: [f64; 3]) -> Result<Course, Box<dyn Error>> {
    let mut found = Course { times: Vec::new(), states: Vec::new(), errors: [0.0; 5] };
    let arm = Vector3::from(arm);
    for row in table.select(&[("body", name)])? {
        let quaternion = row.numbers("qw qx qy qz")?;
        let [turn, spin] = row.numbers("rotation_error angular_velocity_error")?;
        // Nothing translates: the inertia is that about the fixed point.
        let rates = ([0.0; 3], row.numbers("wx wy wz")?);
        let (kinetic, error) = kinetic((0.0, inertia), rates, (0.0, spin));
        let position = rotation(quaternion) * arm;
        found.times.push(row.number("time")?);
        found.states.push(State {
            poses: vec![(position.into(), quaternion)],
            reactions: Vec::new(),
            kinetic,
        });
        let errors = [turn * arm.norm(), turn, error, 0.0, 0.0];
        found.errors = std::array::from_fn(|k| found.errors[k].max(errors[k]));
    }
    if found.states.len() == TIMES { Ok(found) } else { Err(format!("{name}: rows are missing").into()) }
}

const RADAU_REASON: &str = "2s − 1 with s = 3 stages; 0.3 for the next term of the error and for the \
                            reference, which is off by a tenth of the second error";

/// Both methods with steps h, h/2, h/4 from the largest of each [s].
fn follow(
    checks: &mut Checks,
    scene: &Scene,
    exact: &Course,
    [radau, alpha]: [f64; 2],
    view: &View,
) -> Outcome {
    let halved = |step: f64| [step, step / 2.0, step / 4.0];
    for placement in placements(1.0) {
        let name = placement.name;
        let (courses, finest) = runs(scene, (Method::Radau, &halved(radau)), &exact.times, &placement)?;
        check_radau(checks, name, &courses, exact);
        check_order(checks, &format!("Radau, {name}"), &courses[..2], exact, (5.0, 0.3), RADAU_REASON);
        if name == "as is" {
            checks.trajectory(view.picture(&finest, exact));
        }
    }
    let method = (Method::GeneralizedAlpha, halved(alpha));
    let (courses, _) = runs(scene, (method.0, &method.1), &exact.times, &placements(1.0)[0])?;
    check_alpha(checks, "as is", &courses, exact);
    Ok(())
}

/// What a picture shows of (time, position, quaternion).
struct View {
    title: &'static str,
    axes: [&'static str; 2],
    point: fn(f64, [f64; 3], [f64; 4]) -> [f64; 2],
}

impl View {
    /// At most 400 points of ours, all of the reference's.
    fn picture(&self, solution: &Solution, exact: &Course) -> Trajectory {
        let every = solution.rows.len().div_ceil(400);
        let ours = solution.rows.iter().step_by(every);
        let theirs = exact.times.iter().zip(&exact.states);
        Trajectory {
            title: self.title.to_string(),
            axes: self.axes,
            measured: ours
                .map(|row| (self.point)(row.parameter, row.probes[0].position, row.probes[0].quaternion))
                .collect(),
            source: "Exudyn",
            reference: theirs
                .map(|(&time, state)| (self.point)(time, state.poses[0].0, state.poses[0].1))
                .collect(),
        }
    }
}

fn nut(checks: &mut Checks) -> Outcome {
    const INERTIA: [f64; 3] = [1.0, 2.0, 3.0];
    let table = checks.reference("exudyn/rigid_body_motion.csv")?;
    let exact = reference(&table, "nut", INERTIA, [0.0; 3])?;
    let scene = Scene {
        body: vec![Body { angular_velocity: [0.01, 5.0, 0.02], ..body("nut", 1.0, INERTIA, [0.0; 3]) }],
        probe: vec![probe("nut", "nut")],
        dynamics: Some(Dynamics::new(10.0, 0.02)),
        ..Scene::default()
    };
    let view = View {
        title: "Flips of a nut: where its middle axis points",
        axes: ["t [s]", "e_y of the nut along y [1]"],
        point: |time, _, quaternion| [time, (rotation(quaternion) * Vector3::y()).y],
    };
    follow(checks, &scene, &exact, [0.02, 1e-3], &view)
}

fn top(checks: &mut Checks) -> Outcome {
    let table = checks.reference("exudyn/rigid_body_motion.csv")?;
    let exact = reference(&table, "top", [15.234375, 0.46875, 15.234375], [0.0, 1.0, 0.0])?;
    let view = View {
        title: "Heavy top: centre of mass from above",
        axes: ["x [m]", "y [m]"],
        point: |_, [x, y, _], _| [x, y],
    };
    let scene = heavy_top::scene(["ground", "top"]);
    follow(checks, &scene, &exact, [1e-3, 5e-4], &view)
}
