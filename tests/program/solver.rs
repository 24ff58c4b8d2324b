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

/// A clamped straight rod with a transverse tip force; change what differs.
const BEAM: &str = r#"
[[rod]]
name = "r"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 10e-3 }
material = { young_modulus = 1e11, poisson_ratio = 0.2 }
elements = 10
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "r@0"]
[[load]]
kind = "force"
on = "r@1"
value = [0, 0, 1]
[[probe]]
name = "tip"
on = "r@1"
[statics]
"#;

/// Runs the beam, or another scene given as text.
fn run_text(scene: &str, overrides: &[&str]) -> (Option<i32>, String, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    run(text(&path), overrides)
}

/// The last row of a table of a solved scene.
fn solved(scene: &str, overrides: &[&str], table: &str) -> Vec<f64> {
    let (code, stderr, folder) = run_text(scene, overrides);
    assert_eq!(code, Some(0), "{overrides:?}: {stderr}");
    rows(&folder, table).pop().unwrap()
}

/// A load may be so small, or a mesh so fine, that it drowns in the rounding of the stiffness: it is carried all the same.
#[test]
fn small_loads_are_carried_in_full() {
    for (overrides, load, deflection) in [
        (&["rod.0.curve.length=1000", "rod.0.elements=1000", "load.0.value=[0,0,3e-5]"][..], 3e-5, 195.65),
        (&["rod.0.section.diameter=1e-4", "rod.0.elements=1000", "load.0.value=[0,0,3e-9]"], 3e-9, 2.037e-3),
        (&["rod.0.section.diameter=1e-6", "rod.0.elements=40", "load.0.value=[0,0,3e-14]"], 3e-14, 0.74744),
        (&["load.0.value=[0,0,1e-7]"], 1e-7, 6.7909e-10),
    ] {
        let tip = solved(BEAM, overrides, "probes.csv")[3];
        assert!((tip / deflection - 1.0).abs() < 2e-4, "{overrides:?}: {tip}");
        let reaction = solved(BEAM, overrides, "reactions.csv")[3];
        assert!((reaction / load + 1.0).abs() < 1e-3, "{overrides:?}: {reaction}");
    }
}

#[test]
fn directions_may_have_any_length() {
    let held = [
        r#"joint=[{ kind = "revolute", between = ["ground", "r@0"], axis = AXIS },
                  { kind = "spherical", between = ["ground", "r@1"] }]"#,
        "load.0.on=\"r@0.5\"",
        "probe.0.on=\"r@0.5\"",
    ];
    let with = |axis: &str| {
        let joints = held[0].replace("AXIS", axis).replace('\n', " ");
        solved(BEAM, &[joints.as_str(), held[1], held[2]], "probes.csv")
    };
    let expected = with("[0, 1, 0]");
    for axis in ["[0, 1e200, 0]", "[0, 1e-200, 0]", "[0, -3, 0]"] {
        assert_eq!(with(axis), expected, "{axis}");
    }
    let section = "rod.0.section={ kind = \"rectangle\", width = 0.01, height = 0.02 }";
    let tip = |normal: &str| {
        let curve =
            format!("rod.0.curve={{ kind = \"line\", from = [0,0,0], to = [1,0,0], normal = {normal} }}");
        solved(BEAM, &[section, &curve], "probes.csv")[3]
    };
    assert_eq!(tip("[0, 0, 1e200]"), tip("[0, 0, 1]"));
    assert!(tip("[0, 0, 1]") > 3.9 * tip("[0, 1, 0]"), "four times as stiff about the other axis");
}

/// Rods know nothing of one another nor of the inertial origin: far away each is as exact as at home.
#[test]
fn rods_far_away_lose_no_digits() {
    let home = solved(BEAM, &[], "reactions.csv");
    let body = BEAM.split("[statics]").next().unwrap();
    let second = body.replace("\"r\"", "\"s\"").replace("r@", "s@").replace("\"tip\"", "\"far tip\"");
    for origin in ["1e6", "1e8"] {
        let moved = second.replace("length = 1.0", &format!("length = 1.0, origin = [{origin}, 0, 0]"));
        let both = solved(&format!("{body}{moved}[statics]\n"), &[], "reactions.csv");
        assert_eq!(both[1..7], home[1..7]);
        assert_eq!(both[7..13], home[1..7], "{origin}");
    }
    // A support far from its rod still holds it, and one that is hardly a number is no endless search.
    let joint = |point: &str| format!("joint.0.point=[{point}, 0, 0]");
    assert_eq!(run_text(BEAM, &[&joint("1e10")]).0, Some(0));
    assert!(run_text(BEAM, &[&joint("1e308")]).0.is_some());
}

#[test]
fn load_tables_are_followed_from_bend_to_bend() {
    let time = "load.0.time=[[0, 0], [0.3, 100], [0.6, -100], [1, 0]]";
    let (code, stderr, folder) = run_text(BEAM, &[time]);
    assert_eq!(code, Some(0), "{stderr}");
    let rows = rows(&folder, "probes.csv");
    for (bend, sign) in [(0.3, 1.0), (0.6, -1.0)] {
        let row = rows.iter().find(|row| row[0] == bend).expect("a row at every bend");
        assert!(sign * row[3] > 0.4, "{row:?}");
    }
    assert!(rows.last().unwrap()[3].abs() < 1e-9);
}

#[test]
fn loads_that_act_at_once_are_brought_up_before_the_first_row() {
    let constant = "load.0.time=\"constant\"";
    let (code, stderr, folder) = run_text(BEAM, &[constant, "load.0.value=[0,0,100]"]);
    assert_eq!(code, Some(0), "{stderr}");
    let table = rows(&folder, "probes.csv");
    assert!(table[0][0] == 0.0 && (table[0][3] - table.last().unwrap()[3]).abs() < 1e-9 && table[0][3] > 0.3);
    let (code, stderr, folder) = run_text(BEAM, &[constant, "load.0.value=[0,0,1e12]"]);
    assert_eq!(code, Some(3), "{stderr}");
    assert!(stderr.contains("act at load factor 0"), "{stderr}");
    assert_eq!(rows(&folder, "probes.csv").len(), 1);
    no_nan(&folder);
}

#[test]
fn a_rod_pushed_through_itself_is_named() {
    let (code, _, folder) = run_text(BEAM, &["load.0.value=[-1e7,0,0]"]);
    assert_eq!(code, Some(0));
    assert!(read(&folder, "summary.json").contains("pushed through itself"));
}

#[test]
fn ends_are_nodes_within_the_tolerance_of_nodes() {
    let exact = solved(BEAM, &[], "probes.csv");
    assert_eq!(solved(BEAM, &["load.0.on=\"r@1.0000000005\""], "probes.csv"), exact);
    assert_eq!(run_text(BEAM, &["load.0.on=\"r@1.000001\""]).0, Some(2));
}

/// Vector registers change the order of rounding, nothing else.
#[test]
fn plain_arithmetic_gives_the_same_answer() {
    let tip = |plain: bool| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, BEAM).unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_cosserat"));
        command
            .args(["run", text(&path), "--quiet", "--set", "load.0.value=[0,500,1000]", "--out"])
            .arg(folder.path().join("out"));
        if plain {
            command.env("COSSERAT_PLAIN", "1");
        }
        assert!(command.output().unwrap().status.success());
        let probes = std::fs::read_to_string(folder.path().join("out/probes.csv")).unwrap();
        let last = probes.lines().last().unwrap();
        last.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()
    };
    let (vectors, plain) = (tip(false), tip(true));
    // The default test leaves 1e-9 of the largest forces, EA/L against 3 EI/L³ a few thousand times that.
    for (a, b) in vectors.iter().zip(&plain) {
        assert!((a - b).abs() < 1e-8, "{vectors:?} {plain:?}");
    }
    assert_eq!(plain, tip(true));
}
