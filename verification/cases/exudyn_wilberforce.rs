//! The Wilberforce pendulum of Harsch & Eugster, section 4.2, with the inertia of the wire, against Exudyn's geometrically
//! exact beam elements and its rigid bob.
//!
//! The scene is the shipped one with its nodes exactly on the helix. Both programs are extrapolated: Exudyn in space and
//! time (see `scripts/references/exudyn_wilberforce.py`), ours in time on a mesh that twice as many elements confirm.

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use cosserat::scene::{Dynamics, Reference, Scene};
use cosserat::solution::Row;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::placement::{Placement, placements};
use crate::references::Table;
use crate::steps::{distance, run};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let case = Case::new(
        "exudyn_wilberforce::motion",
        "Exudyn, ObjectBeamGeometricallyExact, steps and meshes extrapolated",
        motion,
    );
    vec![case.reads(&["exudyn/wilberforce.csv"]).slow()]
}

const FILE: &str = "exudyn/wilberforce.csv";
const END: f64 = 2.0;
const STEPS: [f64; 3] = [5e-3, 2.5e-3, 1.25e-3];
const ELEMENTS: usize = 18;

/// x, y, z of the bob's centre, and its angles α of R_x(γ) R_y(β) R_z(α) and yaw of R_z(yaw) R_y R_x.
type State = [f64; 5];
/// Time, state, estimated errors of position and angles.
type Stored = (f64, State, [f64; 2]);

/// Times and states.
type Motion = Vec<(f64, State)>;

fn swing(elements: usize, end: f64, step: f64, placement: &Placement) -> Result<Motion, Box<dyn Error>> {
    let mut scene =
        Scene::from_file(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join("wilberforce.toml"))?;
    scene.rod[0].elements = elements;
    scene.rod[0].degree = 4;
    scene.rod[0].reference = Reference::Nodes;
    scene.dynamics = Some(Dynamics::new(end, step));
    let solution = run(&placement.apply(&scene))?;
    let mut last = [0.0; 2];
    Ok(solution.rows.iter().map(|row| (row.parameter, state(row, placement, &mut last))).collect())
}

/// Both angles as entries of the rotation matrix give them, nearest to the last ones.
fn state(row: &Row, placement: &Placement, last: &mut [f64; 2]) -> State {
    let bob = &row.probes[0];
    let position = placement.undo_position(Vector3::from(bob.position));
    let [w, x, y, z] = placement.undo_quaternion(bob.quaternion);
    let cosine = 1.0 - 2.0 * (y * y + z * z);
    let angles = [2.0 * (w * z - x * y), 2.0 * (w * z + x * y)].map(|sine| sine.atan2(cosine));
    for (last, angle) in last.iter_mut().zip(angles) {
        *last = angle + TAU * ((*last - angle) / TAU).round();
    }
    [position.x, position.y, position.z, last[0], last[1]]
}

/// The states at these times, multiples of the step.
fn at(motion: &Motion, times: &[f64]) -> Vec<State> {
    let step = motion[1].0;
    times.iter().map(|time| motion[(time / step).round() as usize].1).collect()
}

/// (4 fine − coarse)/3.
fn extrapolated(coarse: &[State], fine: &[State]) -> Vec<State> {
    let one = |coarse: &State, fine: &State| std::array::from_fn(|k| (4.0 * fine[k] - coarse[k]) / 3.0);
    coarse.iter().zip(fine).map(|(coarse, fine)| one(coarse, fine)).collect()
}

/// Distance of the positions [m], and of the worse angle [rad].
fn apart(a: &State, b: &State) -> [f64; 2] {
    [distance(&a[..3], &b[..3]), (a[3] - b[3]).abs().max((a[4] - b[4]).abs())]
}

/// One run of the table, or its limit: times, states, estimated errors.
fn stored(table: &Table, run: &str) -> Result<Vec<Stored>, Box<dyn Error>> {
    table
        .select(&[("run", run)])?
        .iter()
        .map(|row| {
            let state = row.numbers("x y z alpha yaw")?;
            Ok((row.number("time")?, state, row.numbers("position_error angle_error")?))
        })
        .collect()
}

const QUANTITIES: [&str; 2] = ["position [m]", "angles [rad]"];

fn motion(checks: &mut Checks) -> Outcome {
    let table = checks.reference(FILE)?;
    let limit = stored(&table, "limit")?;
    let times: Vec<f64> = limit.iter().map(|row| row.0).collect();
    let place = &placements(0.1)[0];
    let runs: Vec<Motion> =
        STEPS.iter().map(|step| swing(ELEMENTS, END, *step, place)).collect::<Result<_, _>>()?;
    let found: Vec<Vec<State>> = runs.iter().map(|run| at(run, &times)).collect();
    let first = extrapolated(&found[0], &found[1]);
    let ours = extrapolated(&found[1], &found[2]);
    let finer = at(&swing(2 * ELEMENTS, END, STEPS[0], place)?, &times);
    for (from, to) in [(0.0, 0.5), (0.5, 1.0), (1.0, 1.5), (1.5, END)] {
        // The reference's error, the last change of our extrapolation, what a finer mesh changes, and the distance.
        let mut most = [[0.0_f64; 2]; 4];
        for (k, (time, state, error)) in limit.iter().enumerate() {
            if *time > from && *time <= to {
                let here = [
                    *error,
                    apart(&first[k], &ours[k]),
                    apart(&found[0][k], &finer[k]),
                    apart(&ours[k], state),
                ];
                for (most, here) in most.iter_mut().zip(here) {
                    *most = [most[0].max(here[0]), most[1].max(here[1])];
                }
            }
        }
        let [theirs, in_time, mesh, error] = most;
        for (what, (((error, theirs), in_time), mesh)) in
            QUANTITIES.iter().zip(error.into_iter().zip(theirs).zip(in_time).zip(mesh))
        {
            let what = format!("{what}, worst from {from} to {to} s");
            let reason = "Exudyn's estimated error, a seventh of what our last extrapolation in time changed (after \
                          h² comes h³), and what twice as many elements change";
            checks.below(Kind::CrossCode, what.clone(), error, theirs + in_time / 7.0 + mesh, reason);
            let reason = "a third of Exudyn's: the comparison is no better than the worse of both";
            checks.below(
                Kind::Invariant,
                format!("{what}, ours alone"),
                in_time / 7.0 + mesh,
                theirs / 3.0,
                reason,
            );
        }
    }
    both_halved(checks, &table, &ours)?;
    pictures(checks, &runs[0], &limit);
    placed(checks, &runs[0])
}

/// Exudyn's elements and its integrator have order 2: with elements and step halved at once it comes four times nearer to
/// our converged motion.
fn both_halved(checks: &mut Checks, table: &Table, ours: &[State]) -> Outcome {
    let mut errors = [Vec::new(), Vec::new()];
    for run in ["24 elements, 2.5 ms", "48 elements, 1.25 ms"] {
        let mut most = [0.0_f64; 2];
        for ((time, state, _), ours) in stored(table, run)?.iter().zip(ours) {
            if *time <= 1.0 {
                let here = apart(state, ours);
                most = [most[0].max(here[0]), most[1].max(here[1])];
            }
        }
        errors[0].push(most[0]);
        errors[1].push(most[1]);
    }
    for (what, errors) in QUANTITIES.iter().zip(errors) {
        let reason = "order 2 in both; a term of third order in time as large as the second at ω h = 1, for 54 rad/s, \
                      changes the order by log₂[(1 + 0.135)/(1 + 0.068)] = 0.09; twice that";
        let what = format!("{what} to 1 s, Exudyn's runs against ours");
        checks.order(what, &[24, 48], &errors, (2.0, 0.18), reason);
    }
    Ok(())
}

fn pictures(checks: &mut Checks, ours: &Motion, limit: &[(f64, State, [f64; 2])]) {
    let figures = [
        ("Wilberforce pendulum: height of the bob", ["time [s]", "z [m]"], 2),
        ("Wilberforce pendulum: rotation of the bob", ["time [s]", "α [rad]"], 3),
    ];
    for (title, axes, k) in figures {
        checks.trajectory(Trajectory {
            title: title.to_string(),
            axes,
            measured: ours.iter().step_by(2).map(|(time, state)| [*time, state[k]]).collect(),
            source: "Exudyn, extrapolated",
            reference: limit.iter().map(|(time, state, _)| [*time, state[k]]).collect(),
        });
    }
}

/// The same motion elsewhere, for a shorter time.
fn placed(checks: &mut Checks, as_is: &Motion) -> Outcome {
    for placement in &placements(0.1)[1..] {
        let moved = swing(ELEMENTS, 0.5, STEPS[0], placement)?;
        let end = moved.len() - 1;
        let [position, angle] = apart(&moved[end].1, &as_is[end].1);
        let reason = "100 steps, each solved to 1e-9 of what it travels, 5e-3 m and 0.1 rad at most";
        let name = placement.name;
        checks.below(Kind::Invariant, format!("position at 0.5 s, {name} [m]"), position, 1e-9, reason);
        checks.below(Kind::Invariant, format!("angles at 0.5 s, {name} [rad]"), angle, 2e-8, reason);
    }
    Ok(())
}
