//! Tables and summaries of the three analyses.

use std::f64::consts::TAU;

use super::*;
use crate::scene::{Dynamics, EulerSequence, Modes, Probe};
use crate::solution::{Energies, Mode, ProbePose, Row, Statistics, StopReason};

fn statics() -> Scene {
    let mut scene = Scene::from_toml(
        r#"
[[rod]]
name = "rod"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 0.01 }
material = { young_modulus = 1e9, poisson_ratio = 0.3 }
elements = 2
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "rod@0"]
[[probe]]
name = "tip"
on = "rod@1"
angles = "zyx"
[statics]
"#,
    )
    .unwrap();
    scene.probe.push(Probe { name: "middle".to_owned(), angles: None, ..scene.probe[0].clone() });
    assert_eq!(scene.probe[0].angles, Some(EulerSequence::Zyx));
    scene
}

fn dynamics() -> Scene {
    Scene { statics: None, dynamics: Some(Dynamics::new(1.0, 0.25)), ..statics() }
}

fn modes() -> Scene {
    Scene { statics: None, modes: Some(Modes { count: 2 }), ..statics() }
}

/// Five rows, energies for each and two modes; all of them are more than any one analysis has.
fn outcome() -> Outcome {
    let pose = |angles| ProbePose { position: [1.0, -0.0, 1e-3], quaternion: [1.0, 0.0, 0.0, 0.0], angles };
    let row = |k: usize| Row {
        parameter: 0.25 * k as f64,
        probes: vec![pose(Some([0.1, 0.2, 0.3])), pose(None)],
        reactions: vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]],
    };
    let energy =
        |k: usize| Energies { kinetic: 0.5 * k as f64, strain: 1.0, gravity: -4.0, constraint: 1e-12 };
    let mode = |angular_frequency| Mode { angular_frequency, shape: vec![[1.0, 0.0, 0.0, 0.0, 0.5, 0.0]; 2] };
    let solution = Solution {
        unknowns: 24,
        rows: (0..5).map(row).collect(),
        energies: (0..5).map(energy).collect(),
        modes: vec![mode(-TAU), mode(2.0 * TAU)],
        statistics: Statistics { increments: 4, newton_iterations: 12, ..Statistics::default() },
        ..Solution::default()
    };
    Outcome { solution, failure: None, accuracy: None, setup_seconds: 0.1, solve_seconds: 0.2 }
}

fn lines(folder: &tempfile::TempDir, name: &str) -> Vec<String> {
    let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    text.lines().map(str::to_owned).collect()
}

fn summary(folder: &tempfile::TempDir) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(folder.path().join("summary.json")).unwrap()).unwrap()
}

fn names(folder: &tempfile::TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

const PROBES: &str = ",tip.x,tip.y,tip.z,tip.qw,tip.qx,tip.qy,tip.qz,tip.alpha,tip.beta,tip.gamma,\
                      middle.x,middle.y,middle.z,middle.qw,middle.qx,middle.qy,middle.qz";
const REACTIONS: &str = ",joint1.fx,joint1.fy,joint1.fz,joint1.mx,joint1.my,joint1.mz";

#[test]
fn rows_follow_the_load_factor_or_the_time() {
    for (scene, parameter) in [(statics(), "load_factor"), (dynamics(), "time"), (modes(), "load_factor")] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), &scene, &outcome()).unwrap();
        let (probes, reactions) = (lines(&folder, "probes.csv"), lines(&folder, "reactions.csv"));
        assert_eq!((probes.len(), reactions.len()), (6, 6));
        assert_eq!(probes[0], format!("{parameter}{PROBES}"));
        assert_eq!(probes[2], "0.25,1.0,0.0,0.001,1.0,0.0,0.0,0.0,0.1,0.2,0.3,1.0,0.0,0.001,1.0,0.0,0.0,0.0");
        assert_eq!(reactions[0], format!("{parameter}{REACTIONS}"));
        assert_eq!(reactions[5], "1.0,1.0,2.0,3.0,4.0,5.0,6.0");
    }
}

#[test]
fn energies_have_a_row_for_every_time() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &dynamics(), &outcome()).unwrap();
    let table = lines(&folder, "energies.csv");
    assert_eq!(table.len(), 6);
    assert_eq!(table[0], "time,kinetic,strain,gravity,total,constraint");
    assert_eq!(table[3], "0.5,1.0,1.0,-4.0,-2.0,1e-12");
}

#[test]
fn modes_are_counted_from_one() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &modes(), &outcome()).unwrap();
    let table = lines(&folder, "modes.csv");
    assert_eq!(table.len(), 3);
    assert_eq!(
        table[0],
        "mode,frequency_hz,angular_frequency,tip.x,tip.y,tip.z,tip.rx,tip.ry,tip.rz,\
         middle.x,middle.y,middle.z,middle.rx,middle.ry,middle.rz"
    );
    assert!(table[1].starts_with("1,-1.0,-6.283185307179586,1.0,0.0,"), "{}", table[1]);
    assert!(table[2].starts_with("2,2.0,12.566370614359172,1.0,0.0,"), "{}", table[2]);
}

#[test]
fn tables_of_an_earlier_run_do_not_stay() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("notes.txt"), "mine").unwrap();
    let always = ["notes.txt", "plot.svg", "probes.csv", "reactions.csv", "scene.toml", "summary.json"];
    for (scene, own) in [
        (dynamics(), Some("energies.csv")),
        (modes(), Some("modes.csv")),
        (statics(), None),
        (dynamics(), Some("energies.csv")),
    ] {
        write(folder.path(), &scene, &outcome()).unwrap();
        let mut wanted: Vec<&str> = always.into_iter().chain(own).collect();
        wanted.sort_unstable();
        assert_eq!(names(&folder), wanted);
    }
    let mut free = dynamics();
    free.joint.clear();
    write(folder.path(), &free, &outcome()).unwrap();
    assert!(!names(&folder).contains(&"reactions.csv".to_owned()));
}

#[test]
fn a_table_that_cannot_be_removed_is_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("modes.csv")).unwrap();
    let error = write(folder.path(), &statics(), &outcome()).unwrap_err();
    assert!(matches!(error, Error::File { action: "remove", path, .. } if path.ends_with("modes.csv")));
}

#[test]
fn what_is_no_number_is_left_out() {
    let mut outcome = outcome();
    outcome.solution.rows[1].probes[0].position[0] = f64::NAN;
    outcome.solution.rows[1].reactions[0][0] = f64::INFINITY;
    outcome.solution.energies[1].kinetic = f64::NAN;
    outcome.solution.modes[0].angular_frequency = f64::NAN;
    for (scene, name, row) in [
        (dynamics(), "probes.csv", "0.25,,0.0,"),
        (dynamics(), "reactions.csv", "0.25,,2.0,"),
        (dynamics(), "energies.csv", "0.25,,1.0,-4.0,,"),
        (modes(), "modes.csv", "1,,,1.0,"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), &scene, &outcome).unwrap();
        assert!(lines(&folder, name).iter().any(|line| line.starts_with(row)), "{name}");
    }
}

#[test]
fn the_summary_names_the_analysis_and_how_it_ended() {
    for (scene, analysis, message) in [
        (statics(), "statics", "the whole load is carried"),
        (dynamics(), "dynamics", "the end time is reached"),
        (modes(), "modes", "2 modes found, 1 unstable"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), &scene, &outcome()).unwrap();
        let summary = summary(&folder);
        assert_eq!(summary["status"], "solved");
        assert_eq!(summary["analysis"], analysis);
        assert_eq!(summary["message"], message);
        assert_eq!((&summary["increments"], &summary["newton_iterations"]), (&4.into(), &12.into()));
    }
    let folder = tempfile::tempdir().unwrap();
    let failure = SolveError::InitialAcceleration { reason: StopReason::Singular };
    let stopped = Outcome { failure: Some(failure.clone()), solution: Solution::default(), ..outcome() };
    write(folder.path(), &dynamics(), &stopped).unwrap();
    let summary = summary(&folder);
    assert_eq!(summary["status"], "stopped");
    assert_eq!(summary["message"], failure.to_string());
    for name in ["probes.csv", "reactions.csv", "energies.csv"] {
        assert_eq!(lines(&folder, name).len(), 1, "{name}");
    }
}
