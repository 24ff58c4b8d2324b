//! Chains of two and three bodies in space, from rest and moving, against Exudyn: ball joints, oblique hinges, and a
//! rigid joint between two bodies.
//!
//! The references are Exudyn's Euler-parameter bodies and generic joints under its trapezoidal rule, extrapolated,
//! `scripts/references/exudyn_chains.py`: positions good to 7e-10 m, forces to 5e-6 N, each row with its own figures.
//! Ours are held against them twice: Radau within the errors of both, and generalized-alpha for its order.

use std::error::Error;

use cosserat::scene::{Body, Dynamics, Joint, JointKind, Method, Scene};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::probe;
use crate::placement::{Placement, placements};
use crate::references::Table;
use crate::steps::{body, joint, rotation, row, run, with_step};

const FILES: &[&str] = &["exudyn/chain_motion.csv", "exudyn/chain_reactions.csv"];

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let source = "Exudyn, trapezoidal rule of index 2, scripts/references/exudyn_chains.py";
    let case = |name, function| Case::new(name, source, function).reads(FILES);
    vec![
        case("exudyn_chains::spherical", |checks| chain(checks, "spherical")),
        case("exudyn_chains::revolute", |checks| chain(checks, "revolute")),
        case("exudyn_chains::rigid", |checks| chain(checks, "rigid")),
    ]
}

const END: f64 = 1.5;
/// Of the reference, every 0.05 s.
const TIMES: usize = 30;
/// Of the two methods [s].
const RADAU_STEPS: [f64; 2] = [5e-3, 2.5e-3];
const ALPHA_STEPS: [f64; 3] = [2e-3, 1e-3, 5e-4];
/// Where a start with velocity has left the multipliers of generalized-alpha: 250 of the largest steps, of which each
/// damps what the start has excited by ρ∞ = 0.8 [s].
const SETTLED: f64 = 0.5;

const MASSES: [f64; 3] = [1.2, 0.8, 0.5];
const INERTIAS: [[f64; 3]; 3] = [[0.02, 0.03, 0.04], [0.03, 0.012, 0.02], [0.008, 0.006, 0.004]];
const POSITIONS: [[f64; 3]; 3] = [[0.25, 0.1, -0.15], [0.6, 0.35, -0.45], [1.0, 0.4, -0.7]];
const ORIENTATIONS: [[f64; 4]; 3] = [[0.8, 0.0, 0.6, 0.0], [0.6, 0.0, 0.64, 0.48], [0.5, 0.5, -0.5, 0.5]];

/// (velocity, angular velocity in the body basis) of the bodies where the chain starts moving.
fn speeds(chain: &str) -> &'static [([f64; 3], [f64; 3])] {
    match chain {
        "spherical" => &[
            ([-0.05, 0.575, 0.3], [-1.78, -1.0, 1.04]),
            ([-0.16, 0.575, 0.205], [1.6488, 0.68096, -0.84128]),
        ],
        "revolute" => {
            &[([-0.35, 0.8, -0.05], [-1.36, 1.0, 2.48]), ([-0.8, 2.05, 0.325], [-1.468, -0.8256, 2.1008])]
        }
        _ => &[
            ([-0.075, 0.525, 0.225], [-1.16, -0.5, 1.38]),
            ([-0.3, 1.35, 0.65], [-1.72, 0.076, 0.732]),
            ([0.05, 2.6, 1.1], [2.5, -3.0, 2.5]),
        ],
    }
}

fn joints(chain: &str) -> Vec<Joint> {
    use JointKind::{Revolute, Rigid, Spherical};
    let base = |kind| joint("1", kind, ["ground", "1"], [0.0; 3]);
    let middle = |kind| joint("2", kind, ["1", "2"], [0.45, 0.2, -0.25]);
    let hinge = |joint: Joint, axis| Joint { axis: Some(axis), ..joint };
    match chain {
        "spherical" => vec![base(Spherical), middle(Spherical)],
        "revolute" => vec![hinge(base(Revolute), [2.0, 1.0, 2.0]), hinge(middle(Revolute), [-1.0, 2.0, 2.0])],
        _ => vec![
            base(Spherical),
            middle(Rigid),
            hinge(joint("3", Revolute, ["2", "3"], [0.8, 0.5, -0.6]), [2.0, -2.0, 1.0]),
        ],
    }
}

fn scene(chain: &str, moving: bool) -> Scene {
    let bodies = speeds(chain).iter().enumerate().map(|(k, &(velocity, turns))| {
        let name = (k + 1).to_string();
        let still =
            Body { orientation: ORIENTATIONS[k], ..body(&name, MASSES[k], INERTIAS[k], POSITIONS[k]) };
        if moving { Body { velocity, angular_velocity: turns, ..still } } else { still }
    });
    let body: Vec<Body> = bodies.collect();
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        probe: body.iter().map(|body| probe(&body.name, &body.name)).collect(),
        body,
        joint: joints(chain),
        dynamics: Some(Dynamics::new(END, ALPHA_STEPS[0])),
        ..Scene::default()
    }
}

/// Bodies, joints and the kinetic energy at one time, before the scene was placed.
#[derive(Clone)]
pub struct State {
    pub poses: Vec<([f64; 3], [f64; 4])>,
    pub reactions: Vec<[[f64; 3]; 2]>,
    pub kinetic: f64,
}

/// What is compared; one error for each.
pub const QUANTITIES: [&str; 5] =
    ["position [m]", "rotation [rad]", "kinetic energy [J]", "force [N]", "moment [N m]"];

/// States at the times of a reference, and by how much they may be wrong.
pub struct Course {
    pub times: Vec<f64>,
    pub states: Vec<State>,
    pub errors: [f64; 5],
}

impl Course {
    /// From this time on.
    fn after(&self, time: f64) -> Self {
        let late = self.times.iter().zip(&self.states).filter(|(at, _)| **at >= time);
        let (times, states) = late.map(|(at, state)| (*at, state.clone())).unzip();
        Self { times, states, errors: self.errors }
    }
}

/// What a run says at these times.
pub fn course(
    solution: &Solution,
    times: &[f64],
    placement: &Placement,
) -> Result<Vec<State>, Box<dyn Error>> {
    let mut states = Vec::new();
    for &time in times {
        let index = row(solution, time)?;
        let found = &solution.rows[index];
        let turn = |v: &[f64]| placement.undo_direction(Vector3::new(v[0], v[1], v[2])).into();
        let poses = found.probes.iter().map(|pose| {
            let position = placement.undo_position(Vector3::from(pose.position));
            (position.into(), placement.undo_quaternion(pose.quaternion))
        });
        let reactions = found.reactions.iter().map(|both| [turn(&both[..3]), turn(&both[3..])]);
        let (poses, reactions) = (poses.collect(), reactions.collect());
        states.push(State { poses, reactions, kinetic: solution.energies[index].kinetic });
    }
    Ok(states)
}

/// The largest distances over all times, bodies and joints.
pub fn distances(a: &[State], b: &[State]) -> [f64; 5] {
    let mut worst = [0.0_f64; 5];
    let apart = |a: [f64; 3], b: [f64; 3]| (Vector3::from(a) - Vector3::from(b)).norm();
    for (a, b) in a.iter().zip(b) {
        let mut see = |quantity: usize, distance: f64| worst[quantity] = worst[quantity].max(distance);
        for (p, q) in a.poses.iter().zip(&b.poses) {
            see(0, apart(p.0, q.0));
            see(1, rotation(p.1).angle_to(&rotation(q.1)));
        }
        see(2, (a.kinetic - b.kinetic).abs());
        for (p, q) in a.reactions.iter().zip(&b.reactions) {
            see(3, apart(p[0], q[0]));
            see(4, apart(p[1], q[1]));
        }
    }
    worst
}

/// ½ m v² + ½ ω·Θω, and what errors of v and ω change of it.
pub fn kinetic(
    (mass, inertia): (f64, [f64; 3]),
    (velocity, turns): ([f64; 3], [f64; 3]),
    (velocity_error, turns_error): (f64, f64),
) -> (f64, f64) {
    let (v, w) = (Vector3::from(velocity), Vector3::from(turns));
    let spin = Vector3::from(inertia).component_mul(&w);
    let energy = 0.5 * mass * v.norm_squared() + 0.5 * w.dot(&spin);
    (energy, mass * v.norm() * velocity_error + spin.norm() * turns_error)
}

/// Exudyn's course of a chain, which has as many joints as bodies.
fn reference(motion: &Table, reactions: &Table, chain: &str, start: &str) -> Result<Course, Box<dyn Error>> {
    let count = speeds(chain).len();
    let mut found = Course { times: Vec::new(), states: Vec::new(), errors: [0.0; 5] };
    let (motion, reactions) = (
        motion.select(&[("chain", chain), ("start", start)])?,
        reactions.select(&[("chain", chain), ("start", start)])?,
    );
    for (bodies, joints) in motion.chunks(count).zip(reactions.chunks(count)) {
        let mut state = State { poses: Vec::new(), reactions: Vec::new(), kinetic: 0.0 };
        let mut errors = [0.0; 5];
        for (k, row) in bodies.iter().enumerate() {
            state.poses.push((row.numbers("x y z")?, row.numbers("qw qx qy qz")?));
            let [position, turn, speed, spin] =
                row.numbers("position_error rotation_error velocity_error angular_velocity_error")?;
            let rates = (row.numbers("vx vy vz")?, row.numbers("wx wy wz")?);
            let (energy, error) = kinetic((MASSES[k], INERTIAS[k]), rates, (speed, spin));
            state.kinetic += energy;
            (errors[0], errors[1], errors[2]) = (position, turn, errors[2] + error);
        }
        for row in joints {
            state.reactions.push([row.numbers("fx fy fz")?, row.numbers("mx my mz")?]);
            [errors[3], errors[4]] = row.numbers("force_error moment_error")?;
        }
        found.times.push(bodies[0].number("time")?);
        found.states.push(state);
        found.errors = std::array::from_fn(|k| found.errors[k].max(errors[k]));
    }
    if found.states.len() == TIMES {
        Ok(found)
    } else {
        Err(format!("{chain}, {start}: rows are missing").into())
    }
}

/// States of every run at the reference's times, and the last run as a whole.
type Runs = (Vec<Vec<State>>, Solution);

/// Runs with these steps.
pub fn runs(
    scene: &Scene,
    (method, steps): (Method, &[f64]),
    times: &[f64],
    placement: &Placement,
) -> Result<Runs, Box<dyn Error>> {
    let mut scene = placement.apply(scene);
    if let Some(dynamics) = &mut scene.dynamics {
        dynamics.method = method;
    }
    let (mut courses, mut finest) = (Vec::new(), Solution::default());
    for &step in steps {
        finest = run(&with_step(&scene, step))?;
        courses.push(course(&finest, times, placement)?);
    }
    Ok((courses, finest))
}

const BOTH: &str = "the reference's own error; a twentieth of what halving our step changes, of which order 5 leaves \
                    1/31; rounding of forces of order 10 to 100";
const ROUNDING: f64 = 1e-13;
const ALPHA_REASON: &str = "halving the step divides the error by 3.6 to 4.4: it is c h², and what follows h² is \
                            below a tenth of it";

/// The last of Radau's runs agrees with the reference within the errors of both.
pub fn check_radau(checks: &mut Checks, what: &str, runs: &[Vec<State>], exact: &Course) {
    let (before, finest) = (&runs[runs.len() - 2], &runs[runs.len() - 1]);
    let (errors, change) = (distances(finest, &exact.states), distances(before, finest));
    // Where the reference has no reactions, they are not compared.
    let known = if exact.states.iter().all(|state| state.reactions.is_empty()) { 3 } else { 5 };
    for (k, quantity) in QUANTITIES.iter().enumerate().take(known) {
        let bound = exact.errors[k] + change[k] / 20.0 + ROUNDING;
        checks.below(Kind::CrossCode, format!("{quantity}, {what}"), errors[k], bound, BOTH);
    }
}

/// Three runs, each with half the step of the one before, have this order in all that the reference knows of.
pub fn check_order(
    checks: &mut Checks,
    what: &str,
    runs: &[Vec<State>],
    exact: &Course,
    order: (f64, f64),
    reason: &'static str,
) {
    let errors: Vec<[f64; 5]> = runs.iter().map(|run| distances(run, &exact.states)).collect();
    for (k, quantity) in QUANTITIES.iter().enumerate().filter(|(k, _)| exact.errors[*k] > 0.0) {
        let errors: Vec<f64> = errors.iter().map(|error| error[k]).collect();
        checks.order(format!("{quantity}, {what}"), &[1, 2, 4][..errors.len()], &errors, order, reason);
    }
}

/// Generalized-alpha has order 2.
pub fn check_alpha(checks: &mut Checks, what: &str, runs: &[Vec<State>], exact: &Course) {
    check_order(checks, &format!("generalized-alpha, {what}"), runs, exact, (2.0, 0.15), ALPHA_REASON);
}

fn chain(checks: &mut Checks, chain: &str) -> Outcome {
    let motion = checks.reference("exudyn/chain_motion.csv")?;
    let reactions = checks.reference("exudyn/chain_reactions.csv")?;
    for start in ["rest", "moving"] {
        let exact = reference(&motion, &reactions, chain, start)?;
        let scene = scene(chain, start == "moving");
        for placement in placements(1.0) {
            let what = format!("{start}, {}", placement.name);
            let method = (Method::Radau, RADAU_STEPS.as_slice());
            let (courses, finest) = runs(&scene, method, &exact.times, &placement)?;
            check_radau(checks, &what, &courses, &exact);
            if placement.name == "as is" {
                checks.trajectory(picture(chain, start, &finest, &exact));
            }
        }
        let settled = exact.after(SETTLED);
        let method = (Method::GeneralizedAlpha, ALPHA_STEPS.as_slice());
        let (courses, _) = runs(&scene, method, &settled.times, &placements(1.0)[0])?;
        check_alpha(checks, start, &courses, &settled);
    }
    Ok(())
}

/// The path of the last body, seen from the side.
fn picture(chain: &str, start: &str, solution: &Solution, exact: &Course) -> Trajectory {
    let last = speeds(chain).len() - 1;
    let side = |[x, _, z]: [f64; 3]| [x, z];
    Trajectory {
        title: format!("Chain with {chain} joints, start: {start}, body {}", last + 1),
        axes: ["x [m]", "z [m]"],
        measured: solution.rows.iter().step_by(2).map(|row| side(row.probes[last].position)).collect(),
        source: "Exudyn",
        reference: exact.states.iter().map(|state| side(state.poses[last].0)).collect(),
    }
}
