//! What the program does when it solves, and when it cannot.

use std::path::Path;

use tempfile::TempDir;

use crate::{cosserat, text};

const SPRING: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/helical_spring.toml");

/// Runs a scene with overrides; returns the exit code, stderr and the folder of the results.
fn run(scene: &str, overrides: &[&str]) -> (Option<i32>, String, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let mut arguments = vec!["run", scene, "--out", text(folder.path())];
    arguments.extend(overrides.iter().flat_map(|entry| ["--set", entry]));
    let ended = cosserat(&arguments);
    (ended.code, ended.stderr, folder)
}

fn read(folder: &TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join(name)).unwrap()
}

/// The rows of a table, every entry a finite number.
fn rows(folder: &TempDir, name: &str) -> Vec<Vec<f64>> {
    let table = read(folder, name);
    let numbers = |line: &str| line.split(',').map(|entry| entry.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let rows: Vec<_> = table.lines().skip(1).map(numbers).collect();
    assert!(
        rows.iter().flatten().all(|number| number.is_finite()),
        "{name} holds a number that is not finite"
    );
    rows
}

/// No result file holds a number that is not one.
fn no_nan(folder: &TempDir) {
    for entry in std::fs::read_dir(folder.path()).unwrap() {
        let path = entry.unwrap().path();
        let content = std::fs::read_to_string(&path).unwrap();
        let words = content.split(|c: char| !c.is_alphanumeric());
        assert!(words.clone().all(|word| !word.eq_ignore_ascii_case("nan")), "{} holds NaN", path.display());
    }
}

#[test]
fn a_load_beyond_the_spring_stops_early_and_keeps_what_converged() {
    let automatic = "statics={}";
    for overrides in
        [&["load.0.value=[0,0,1e9]", automatic][..], &["load.0.value=[0,0,1e9]"], &["statics.increments=1"]]
    {
        let (code, stderr, folder) = run(SPRING, overrides);
        assert_eq!(code, Some(3), "{overrides:?}: {stderr}");
        for word in ["load factor", "iterations", "residual", "tolerance"] {
            assert!(stderr.contains(word), "{stderr}");
        }
        let summary: serde_json::Value = serde_json::from_str(&read(&folder, "summary.json")).unwrap();
        assert_eq!(summary["status"], "stopped");
        assert!(stderr.contains(summary["message"].as_str().unwrap()));
        let increments = summary["increments"].as_u64().unwrap() as usize;
        assert_eq!(rows(&folder, "probes.csv").len(), 1 + increments);
        assert_eq!(rows(&folder, "reactions.csv").len(), 1 + increments);
        if overrides.contains(&automatic) {
            assert!(increments > 10, "only {increments} increments converged");
        }
        no_nan(&folder);
    }
}

#[test]
fn numbers_that_overflow_are_not_an_equilibrium() {
    for force in ["1e300", "1e308"] {
        let (code, stderr, folder) = run(SPRING, &[&format!("load.0.value=[0,0,{force}]"), "statics={}"]);
        assert_eq!(code, Some(3), "{stderr}");
        no_nan(&folder);
    }
    let (code, stderr, _) = run(SPRING, &["rod.0.section.diameter=1e-100"]);
    assert_eq!(code, Some(2));
    assert!(stderr.contains("rod.0.section") && stderr.contains("stiffness"), "{stderr}");
}

#[test]
fn results_are_the_same_bit_for_bit() {
    let overrides = ["statics.increments=200", "load.0.value=[0,0,20]"];
    let (code, stderr, first) = run(SPRING, &overrides);
    assert_eq!(code, Some(0), "{stderr}");
    let (_, _, second) = run(SPRING, &overrides);
    for name in ["probes.csv", "reactions.csv", "plot.svg", "scene.toml"] {
        assert_eq!(read(&first, name), read(&second, name), "{name}");
    }
    // The scene that was written solves to the same.
    let written = first.path().join("scene.toml");
    let (_, _, third) = run(text(&written), &[]);
    assert_eq!(read(&first, "probes.csv"), read(&third, "probes.csv"));
}

#[test]
fn a_mesh_too_coarse_for_its_solution_is_named() {
    let (code, _, folder) = run(SPRING, &["load.0.value=[0,0,1e4]", "statics={}"]);
    assert_eq!(code, Some(0));
    let summary: serde_json::Value = serde_json::from_str(&read(&folder, "summary.json")).unwrap();
    let warning = summary["warnings"][0].as_str().unwrap();
    assert!(warning.contains("spring") && warning.contains("too coarse"), "{warning}");
}

/// A refusal: exit code 2 and words of the message.
fn refused(overrides: &[&str], words: &[&str]) {
    let (code, stderr, folder) = run(SPRING, overrides);
    assert_eq!(code, Some(2), "{overrides:?}: {stderr}");
    for word in words {
        assert!(stderr.contains(word), "`{word}` is not in: {stderr}");
    }
    assert!(!Path::new(folder.path()).join("probes.csv").exists());
}

#[test]
fn what_only_the_model_can_see_is_refused() {
    refused(&["load.0.on=\"spring@0.3333\""], &["load.0.on", "no node", "nearest"]);
    refused(&["joint.0.between=[\"ground\", \"spring@0.123\"]"], &["joint.0.between.1", "no node"]);
    refused(&["joint=[]"], &["spring", "translation"]);
    refused(&["joint.0.kind=\"spherical\""], &["spring", "rotation about the axis"]);
    refused(
        &["joint.0={ kind = \"revolute\", between = [\"ground\", \"spring@0\"], axis = [0, 0, 1] }"],
        &["spring", "rotation about the axis [0, 0, 1]"],
    );
    refused(
        &["rod.0.interpolation=\"se3\"", "rod.0.degree=1", "rod.0.elements=20"],
        &["rod.0.elements", "half a turn", "elements"],
    );
    refused(&["rod.0.elements=4"], &["rod.0.elements", "half a turn"]);
    refused(&["rod.0.reference.samples=150"], &["samples", "151"]);
}

#[test]
fn given_poses_are_read_and_fitted() {
    let folder = tempfile::tempdir().unwrap();
    let poses = folder.path().join("poses.csv");
    let curve = format!("rod.0.curve={{ kind = \"poses\", file = {:?} }}", text(&poses));
    let overrides =
        [curve.as_str(), "rod.0.reference={ kind = \"nodes\" }", "rod.0.elements=2", "statics={}"];
    assert_eq!(run(SPRING, &overrides).0, Some(4), "a file that is not there");

    let write = |rows: &str| std::fs::write(&poses, format!("x,y,z,qw,qx,qy,qz\n{rows}")).unwrap();
    write("0,0,0,1,0,0,0\n1,0,0,one,0,0,0\n");
    refused(&overrides, &["rod.0.curve.file", "malformed", "header"]);
    write("0,0,0,1,0,0,0\n1,0,0,0,0,0,0\n");
    refused(&overrides, &["line 3", "zero quaternion"]);
    write("0,0,0,1,0,0,0\n1,0,0,1,0,0,0\n");
    refused(&overrides, &["fits 5 nodes to 2 samples", "at least 5 samples"]);
    let straight: String = (0..9).map(|k| format!("0,0,{},2,0,-2,0\n", 0.01 * k as f64)).collect();
    write(&straight);
    let (code, stderr, results) = run(SPRING, &overrides);
    assert_eq!(code, Some(0), "{stderr}");
    let first = &rows(&results, "probes.csv")[0];
    assert!((first[3] - 0.08).abs() < 1e-12, "{first:?}");
}
