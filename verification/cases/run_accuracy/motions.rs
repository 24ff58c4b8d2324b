//! Motions that are known by equations without finite elements and without time steps.

use std::error::Error;

use cosserat::Model;
use cosserat::scene::{Body, Dynamics, Scene, Step};
use cosserat::solution::{ProbePose, Solution};
use cosserat::study::{Milestones, Trajectory};
use nalgebra::{UnitQuaternion, Vector3};

use super::problems::{Problem, Read};
use crate::measure::probe;
use crate::references::Row;
use crate::steps::body;

/// The files under `references/` of [`bodies`] and of [`rods`].
pub const BODIES: [&str; 5] = [
    "rigid/heavy_top.csv",
    "rigid/free_asymmetric_body.csv",
    "rigid/free_symmetric_body.csv",
    "rigid/chain.csv",
    "rigid/four_bar.csv",
];
pub const RODS: [&str; 2] = ["continuous/wilberforce_motion.csv", "continuous/spun_ring.csv"];

/// Milestones of a motion.
const MILESTONES: usize = 100;

/// Poses of a file, put to those of the hundred milestones that it has.
struct Motion {
    problem: Problem,
    end: f64,
}

impl Motion {
    fn new(name: &str, scene: Scene, end: f64) -> Result<Self, Box<dyn Error>> {
        // The step that is written is not the one that is used.
        let dynamics = scene.dynamics.clone().unwrap_or_else(|| Dynamics::new(end, end));
        let scene = Scene {
            dynamics: Some(Dynamics { end_time: end, step: Step::Constant(end), ..dynamics }),
            ..scene
        };
        let milestones = Milestones::in_time(end, &[end]);
        // What lengths are relative to.
        let Trajectory { size, .. } =
            Trajectory::new(&Model::new(&scene)?, &milestones, &Solution::default());
        let exact = Trajectory { rows: Vec::new(), size };
        Ok(Self { problem: Problem { name: name.to_string(), scene, exact }, end })
    }

    /// Adds the poses of one time, those of several probes in order, if it is that of a milestone.
    fn add(&mut self, time: f64, pose: ProbePose) {
        let place = MILESTONES as f64 * time / self.end;
        let index = place.round() as usize;
        if (place - place.round()).abs() > 1e-6 || index == 0 || index > MILESTONES {
            return;
        }
        match self.problem.exact.rows.last_mut() {
            Some((last, poses)) if *last == index => poses.push(pose),
            _ => self.problem.exact.rows.push((index, vec![pose])),
        }
    }
}

fn pose(row: &Row, position: [f64; 3]) -> Result<ProbePose, Box<dyn Error>> {
    Ok(ProbePose { position, quaternion: row.numbers("qw qx qy qz")?, angles: None })
}

/// Rigid bodies: the time step is all there is to choose.
pub fn bodies(read: Read) -> Result<Vec<Problem>, Box<dyn Error>> {
    let mut top = Motion::new("heavy top", crate::cases::heavy_top::scene(["ground", "top"]), 1.0)?;
    for row in read(BODIES[0])?.rows() {
        top.add(row.number("t")?, pose(&row, row.numbers("x y z")?)?);
    }
    let mut motions = vec![top];
    for (name, file, inertia, turns) in [
        ("free asymmetric body", BODIES[1], [1.0, 2.0, 3.0], [0.01, 5.0, 0.02]),
        ("free symmetric body", BODIES[2], [2.0, 2.0, 3.0], [1.0, 0.0, 10.0]),
    ] {
        let scene = Scene {
            body: vec![Body { angular_velocity: turns, ..body("nut", 1.0, inertia, [0.0; 3]) }],
            probe: vec![probe("nut", "nut")],
            ..Scene::default()
        };
        let mut motion = Motion::new(name, scene, 5.0)?;
        for row in read(file)?.rows() {
            motion.add(row.number("t")?, pose(&row, [0.0; 3])?);
        }
        motions.push(motion);
    }
    let chain = read(BODIES[3])?;
    for (start, moving) in [("moving", true), ("at rest", false)] {
        let scene = crate::cases::body_chain::scene(moving, 1e-2);
        let mut motion = Motion::new(&format!("chain, {start}"), scene, 1.0)?;
        for row in chain.select(&[("start", start)])? {
            motion.add(row.number("t")?, pose(&row, row.numbers("x y z")?)?);
        }
        motions.push(motion);
    }
    // The file has the coupler.
    let mut scene = crate::cases::four_bar::scene([0, 1, 2, 3]);
    scene.probe = vec![probe("coupler", "bar2")];
    let mut loop_of_bars = Motion::new("four-bar loop", scene, 2.0)?;
    for row in read(BODIES[4])?.rows() {
        loop_of_bars.add(row.number("t")?, pose(&row, row.numbers("x y z")?)?);
    }
    motions.push(loop_of_bars);
    Ok(motions.into_iter().map(|motion| motion.problem).collect())
}

/// A body on a massless wire for a short time, and a ring that is spun up: mesh and step.
pub fn rods(read: Read) -> Result<Vec<Problem>, Box<dyn Error>> {
    let mut pendulum = Motion::new("Wilberforce, massless wire", crate::cases::wilberforce::massless(), 0.5)?;
    for row in read(RODS[0])?.rows() {
        pendulum.add(row.number("t")?, pose(&row, row.numbers("x y z")?)?);
    }
    let mut scene = crate::cases::spun_ring::scene(1e-2, 4, 5);
    scene.probe.truncate(1);
    let mut ring = Motion::new("spun ring", scene, 1.0)?;
    for row in read(RODS[1])?.rows() {
        let [turn, x, y] = row.numbers("section x y")?;
        let q = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn).into_inner();
        let pose = ProbePose { position: [x, y, 0.0], quaternion: [q.w, q.i, q.j, q.k], angles: None };
        ring.add(row.number("t")?, pose);
    }
    Ok(vec![pendulum.problem, ring.problem])
}
