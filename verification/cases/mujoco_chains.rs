//! A long chain, a tree and a free pair of branches: rigid bodies on balls and oblique hinges, falling from a moving start.
//!
//! The references are MuJoCo's: joint coordinates and recursive sums where this solver has six coordinates a body and
//! multipliers. Poses are good to 1e-11, joint forces to 1e-9.

use std::error::Error;

use cosserat::scene::{Body, Dynamics, Joint, JointKind, Method, Scene};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::probe;
use crate::placement::{Placement, placements};
use crate::references::Table;
use crate::steps::{
    check_second_order, distance, force_at, halved_twice, joint, position_at, quaternion_at, row, run,
    with_step,
};

const BODIES: &str = "mujoco/chains_bodies.csv";
const JOINTS: &str = "mujoco/chains_joints.csv";
const MOTION: &str = "mujoco/chains_motion.csv";
const REACTIONS: &str = "mujoco/chains_reactions.csv";
const ENERGIES: &str = "mujoco/chains_energies.csv";

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let source = "MuJoCo, joint coordinates without multipliers";
    vec![
        Case::new("mujoco_chains::chain", source, |checks| motion(checks, "chain", [100, 200, 400]))
            .reads(&[BODIES, JOINTS, MOTION, REACTIONS, ENERGIES]),
        Case::new("mujoco_chains::tree", source, |checks| motion(checks, "tree", [100, 200, 400]))
            .reads(&[BODIES, JOINTS, MOTION, REACTIONS, ENERGIES]),
        Case::new("mujoco_chains::free", source, |checks| motion(checks, "free", [20, 40, 80]))
            .reads(&[BODIES, JOINTS, MOTION, REACTIONS, ENERGIES]),
        Case::new("mujoco_chains::order", source, order).reads(&[BODIES, JOINTS, MOTION, REACTIONS]),
    ]
}

/// The mechanism of this name, asked for `method`.
fn scene(checks: &mut Checks, name: &str, method: Method, step: f64) -> Result<Scene, Box<dyn Error>> {
    let (bodies, joints) = (checks.reference(BODIES)?, checks.reference(JOINTS)?);
    let mut scene = Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        dynamics: Some(Dynamics { method, ..Dynamics::new(1.0, step) }),
        ..Scene::default()
    };
    for row in bodies.select(&[("scene", name)])? {
        let body_name = row.word("body")?;
        scene.probe.push(probe(body_name, body_name));
        scene.body.push(Body {
            orientation: row.numbers("qw qx qy qz")?,
            velocity: row.numbers("vx vy vz")?,
            angular_velocity: row.numbers("wx wy wz")?,
            ..crate::steps::body(
                body_name,
                row.number("mass")?,
                row.numbers("ixx iyy izz")?,
                row.numbers("x y z")?,
            )
        });
    }
    for row in joints.select(&[("scene", name)])? {
        let kind = match row.word("kind")? {
            "revolute" => JointKind::Revolute,
            _ => JointKind::Spherical,
        };
        let axis = if kind == JointKind::Revolute { Some(row.numbers("ax ay az")?) } else { None };
        let (first, second) = (row.word("first")?, row.word("joint")?);
        let between = joint(second, kind, [first, second], row.numbers("x y z")?);
        scene.joint.push(Joint { axis, ..between });
    }
    Ok(scene)
}

/// Largest distance of all poses at all times of the table: positions [m], quaternions.
fn pose_errors(
    motion: &Table,
    scene: &Scene,
    name: &str,
    run: &Solution,
    placement: &Placement,
) -> Result<[f64; 2], Box<dyn Error>> {
    let mut errors = [0.0_f64; 2];
    for (index, body) in scene.body.iter().enumerate() {
        for row in motion.select(&[("scene", name), ("body", body.name.as_str())])? {
            let (time, q) = (row.number("time")?, row.numbers("qw qx qy qz")?);
            let x = position_at(run, time, index, placement)?;
            errors[0] = errors[0].max((x - Vector3::from(row.numbers::<3>("x y z")?)).norm());
            errors[1] = errors[1].max(distance(&quaternion_at(run, time, index, placement, q)?, &q));
        }
    }
    Ok(errors)
}

/// The same of all joints: forces [N], moments [N m].
fn reaction_errors(
    reactions: &Table,
    scene: &Scene,
    name: &str,
    run: &Solution,
    placement: &Placement,
) -> Result<[f64; 2], Box<dyn Error>> {
    let mut errors = [0.0_f64; 2];
    for (index, joint) in scene.joint.iter().enumerate() {
        let second = joint.between[1].as_str();
        for line in reactions.select(&[("scene", name), ("joint", second)])? {
            let [a, b, c, d, e, f] = run.rows[row(run, line.number("time")?)?].reactions[index];
            let pairs = [([a, b, c], "fx fy fz"), ([d, e, f], "mx my mz")];
            for (k, (measured, columns)) in pairs.into_iter().enumerate() {
                let measured = placement.undo_direction(Vector3::from(measured));
                let exact = Vector3::from(line.numbers::<3>(columns)?);
                errors[k] = errors[k].max((measured - exact).norm());
            }
        }
    }
    Ok(errors)
}

/// The same of the kinetic energy [J], which is the same in every place.
fn kinetic_error(energies: &Table, name: &str, run: &Solution) -> Result<f64, Box<dyn Error>> {
    let mut error = 0.0_f64;
    for line in energies.select(&[("scene", name)])? {
        let kinetic = run.energies[row(run, line.number("time")?)?].kinetic;
        error = error.max((kinetic - line.number("kinetic")?).abs());
    }
    Ok(error)
}

/// Of the reference.
const POSE: f64 = 1e-11;
const FORCE: f64 = 1e-9;
const ENERGY: f64 = 1e-10;

const ORDER: &str = "2s − 1 with s = 3 stages; the next term of the largest error is a tenth of it where the joints turn by \
                     0.3 rad a step";
const LAST: &str = "an error c h⁵ is 1/31 of the last difference, and no more than a tenth where the order is 3.5 or more; \
                    the reference's own accuracy";

/// Everything at all times by Radau's method in so many steps.
fn motion(checks: &mut Checks, name: &str, steps: [usize; 3]) -> Outcome {
    let plain = scene(checks, name, Method::Radau, 1.0)?;
    let (motion, reactions) = (checks.reference(MOTION)?, checks.reference(REACTIONS)?);
    let energies = checks.reference(ENERGIES)?;
    for placement in placements(1.0) {
        let placed = placement.apply(&plain);
        let runs: Vec<Solution> = steps
            .iter()
            .map(|count| run(&with_step(&placed, 1.0 / *count as f64)))
            .collect::<Result<_, _>>()?;
        let mut errors: [Vec<f64>; 5] = Default::default();
        for run in &runs {
            let [x, q] = pose_errors(&motion, &plain, name, run, &placement)?;
            let [f, m] = reaction_errors(&reactions, &plain, name, run, &placement)?;
            let t = kinetic_error(&energies, name, run)?;
            for (list, error) in errors.iter_mut().zip([x, q, f, m, t]) {
                list.push(error);
            }
        }
        let names = [
            ("position", POSE),
            ("quaternion", POSE),
            ("force", FORCE),
            ("moment", FORCE),
            ("kinetic energy", ENERGY),
        ];
        for ((what, accuracy), errors) in names.into_iter().zip(&errors) {
            let label = format!("{what}, {}", placement.name);
            checks.order(label.clone(), &steps, errors, (5.0, 0.5), ORDER);
            let last = 0.1 * (errors[1] - errors[2]) + accuracy;
            checks.below(Kind::CrossCode, format!("{label}, {} steps", steps[2]), errors[2], last, LAST);
        }
        if placement.name == "as is" {
            checks.trajectory(picture(&plain, name, &motion, &runs[2])?);
        }
    }
    Ok(())
}

/// The last body's way, seen from the front.
fn picture(scene: &Scene, name: &str, motion: &Table, run: &Solution) -> Result<Trajectory, Box<dyn Error>> {
    let (index, body) = scene.body.iter().enumerate().next_back().ok_or("no bodies")?;
    let mut reference = Vec::new();
    for row in motion.select(&[("scene", name), ("body", body.name.as_str())])? {
        reference.push(row.numbers("x z")?);
    }
    let measured = run.rows.iter().map(|row| {
        let [x, _, z] = row.probes[index].position;
        [x, z]
    });
    Ok(Trajectory {
        title: format!("Last body of the {name}"),
        axes: ["x [m]", "z [m]"],
        measured: measured.collect(),
        source: "MuJoCo",
        reference,
    })
}

/// The default method at its own order, in the last body and the first joint of the tree.
fn order(checks: &mut Checks) -> Outcome {
    let scene = scene(checks, "tree", Method::GeneralizedAlpha, 1e-3)?;
    let (motion, reactions) = (checks.reference(MOTION)?, checks.reference(REACTIONS)?);
    let place = &placements(1.0)[0];
    let runs = halved_twice(&scene)?;
    let index = scene.body.len() - 1;
    for time in ["0.5", "1.0"] {
        let line =
            motion.row(&[("scene", "tree"), ("time", time), ("body", scene.body[index].name.as_str())])?;
        let (t, q) = (line.number("time")?, line.numbers("qw qx qy qz")?);
        let (mut x, mut p, mut f) = (Vec::new(), Vec::new(), Vec::new());
        for run in &runs {
            x.push(position_at(run, t, index, place)?);
            p.push(quaternion_at(run, t, index, place, q)?);
            f.push(force_at(run, t, 0, place)?);
        }
        let slices = |v: &'_ [Vector3<f64>]| -> [[f64; 3]; 3] { [v[0].into(), v[1].into(), v[2].into()] };
        let [a, b, c] = slices(&x);
        check_second_order(checks, &format!("position at {t} s"), [&a, &b, &c], &line.numbers::<3>("x y z")?);
        check_second_order(checks, &format!("quaternion at {t} s"), [&p[0], &p[1], &p[2]], &q);
        let [a, b, c] = slices(&f);
        let first = scene.joint[0].between[1].as_str();
        let force = reactions.row(&[("scene", "tree"), ("time", time), ("joint", first)])?;
        check_second_order(
            checks,
            &format!("force at {t} s"),
            [&a, &b, &c],
            &force.numbers::<3>("fx fy fz")?,
        );
    }
    Ok(())
}
