//! The study of speed against accuracy: its table, what it says, and how it goes on after it was interrupted.

use std::path::Path;

use tempfile::TempDir;

use crate::{Ended, cosserat, text, write_scene};

const HEADER: &str = "degree,elements,interpolation,increments,time_step,tolerance,position_error,rotation_error,seconds,\
                      newton_iterations,factorizations,status";

const ARC: &str = r#"
title = "arc"
[[rod]]
name = "arc"
curve = { kind = "arc", radius = 1.0, angle = 1.0 }
section = { kind = "circle", diameter = 0.05 }
material = { young_modulus = 1e7, poisson_ratio = 0.3, density = 1000 }
elements = 4
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "arc@0"]
[[load]]
kind = "force"
on = "arc@1"
value = [0, 0, 5]
"#;

const STATICS: &str = "[statics]\n[study]\nelements = [4, 8, 16]\naccuracies = [1e-3, 1e-6, 1e-30]\n";

/// Runs a study with a scene in one folder and its results in another.
fn study(scene: &str, out: &Path, overrides: &[&str]) -> Ended {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, scene);
    let mut arguments = vec!["study", text(&path), "--out", text(out)];
    arguments.extend(overrides.iter().flat_map(|entry| ["--set", entry]));
    cosserat(&arguments)
}

fn read(out: &Path, name: &str) -> String {
    std::fs::read_to_string(out.join(name)).unwrap()
}

/// The rows of study.csv as text, column by column.
fn rows(out: &Path) -> Vec<Vec<String>> {
    let table = read(out, "study.csv");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>().join(","), HEADER);
    reader.records().map(|record| record.unwrap().iter().map(str::to_owned).collect()).collect()
}

fn number(row: &[String], column: usize) -> f64 {
    row[column].parse().unwrap()
}

const POSITION: usize = 6;
const ROTATION: usize = 7;
const SECONDS: usize = 8;
const COUNTS: usize = 9;
const STATUS: usize = 11;

/// Without what a clock says.
fn timeless(rows: &[Vec<String>]) -> Vec<Vec<String>> {
    let without = |row: &Vec<String>| {
        let mut row = row.clone();
        row[SECONDS].clear();
        row
    };
    rows.iter().map(without).collect()
}

#[test]
fn a_study_shows_the_order_and_advises() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new").join("study");
    let ended = study(&format!("{ARC}{STATICS}"), &out, &[]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert_eq!(ended.stderr, "");
    let rows = rows(&out);
    let settings: Vec<_> = rows.iter().map(|row| row[..6].join(",")).collect();
    assert_eq!(settings, ["2,4,r12,,,", "2,8,r12,,,", "2,16,r12,,,"]);
    // The end of the rod has order 2p = 4; half an order for what is not asymptotic yet.
    for column in [POSITION, ROTATION] {
        let order = (number(&rows[1], column) / number(&rows[2], column)).log2();
        assert!((order - 4.0).abs() < 0.5, "{order}");
    }
    for row in &rows {
        assert_eq!(row[STATUS], "solved");
        assert!(number(row, SECONDS) > 0.0 && number(row, 9) > 0.0 && number(row, 10) > 0.0);
    }
    let lines: Vec<&str> = ended.stdout.lines().collect();
    let line = |start: &str| *lines.iter().find(|line| line.starts_with(start)).unwrap();
    assert!(line("reference: degree 4, ").contains("own error is about"), "{}", ended.stdout);
    assert_eq!(lines[1], "3 runs");
    assert!(line("for 1e-3: degree 2, ").ends_with('s'), "{}", ended.stdout);
    assert!(line("for 1e-30: ").contains("unknown"), "{}", ended.stdout);
    let picture = read(&out, "study.svg");
    // Which of the runs are on it is a matter of time, the most accurate one always.
    assert!(picture.contains("Pareto front") && picture.contains("p 2 × 16") && picture.contains(">\narc\n"));
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 3, "study.csv, study.json, study.svg");
}

#[test]
fn an_interrupted_study_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let scene = format!("{ARC}{STATICS}");
    assert_eq!(study(&scene, out, &[]).code, Some(0));
    let whole = rows(out);
    let table = read(out, "study.csv");
    let lines: Vec<&str> = table.lines().collect();
    // In the middle of a row, between two, before the end of a line, and behind its status all but one letter.
    let second = lines[..2].iter().map(|line| line.len() + 1).sum::<usize>();
    for (cut, kept) in [
        (second + 7, 1),
        (second, 1),
        (second + lines[2].len(), 1),
        (table.len() - 2, 2),
        (table.len(), 3),
        (lines[0].len() + 1, 0),
        (4, 0),
    ] {
        std::fs::write(out.join("study.csv"), &table[..cut]).unwrap();
        let ended = study(&scene, out, &[]);
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        let first = ended.stdout.lines().next().unwrap_or_default();
        assert_eq!(first, format!("{kept} of 3 runs are there already"), "cut at {cut}");
        let again = rows(out);
        assert_eq!(timeless(&again), timeless(&whole), "cut at {cut}");
        assert_eq!(again[..kept], whole[..kept], "cut at {cut}");
    }
    // A study that was stopped on the way to its reference begins anew.
    std::fs::remove_file(out.join("study.json")).unwrap();
    assert_eq!(study(&scene, out, &[]).code, Some(0));
    assert_eq!(timeless(&rows(out)), timeless(&whole));
}

/// What no run has written is done again.
#[test]
fn a_broken_table_is_made_whole() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let scene = format!("{ARC}{STATICS}");
    assert_eq!(study(&scene, out, &[]).code, Some(0));
    let whole = rows(out);
    let table = read(out, "study.csv");
    let error = whole[1][POSITION].as_str();
    for (wrong, kept) in [("NaN", 2), ("-1e-3", 2), ("inf", 2), ("one", 2), (error, 3)] {
        std::fs::write(out.join("study.csv"), table.replace(error, wrong)).unwrap();
        let ended = study(&scene, out, &[]);
        assert!(ended.stdout.starts_with(&format!("{kept} of 3 runs")), "{wrong}: {}", ended.stdout);
        assert_eq!(timeless(&rows(out)), timeless(&whole), "{wrong}");
    }
    // A line of bytes that are no text costs no more than itself.
    let bytes = [table.as_bytes(), b"\xff\xfe\n"].concat();
    std::fs::write(out.join("study.csv"), bytes).unwrap();
    assert!(study(&scene, out, &[]).stdout.starts_with("3 of 3 runs"));
}

#[test]
fn a_study_of_something_else_is_not_mixed_in() {
    let folder = tempfile::tempdir().unwrap();
    let scene = format!("{ARC}{STATICS}");
    assert_eq!(study(&scene, folder.path(), &[]).code, Some(0));
    let table = read(folder.path(), "study.csv");
    for entry in ["load.0.value=[0,0,6]", "study.elements=[4,8]", "study.accuracies=[1e-4]"] {
        let ended = study(&scene, folder.path(), &[entry]);
        assert_eq!(ended.code, Some(2), "{entry}");
        assert!(ended.stderr.contains("another scene or of other settings"), "{}", ended.stderr);
        assert!(ended.stderr.contains("study.json removed"), "{}", ended.stderr);
    }
    std::fs::write(folder.path().join("study.json"), "{}").unwrap();
    let ended = study(&scene, folder.path(), &[]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("not of this program"), "{}", ended.stderr);
    assert_eq!(read(folder.path(), "study.csv"), table);
    // A title and a line in the plot change no run.
    std::fs::remove_file(folder.path().join("study.json")).unwrap();
    assert_eq!(study(&scene, folder.path(), &[]).code, Some(0));
    let ended = study(&scene, folder.path(), &["title=\"another\"", "plot.slope=1.0"]);
    assert!(ended.stdout.starts_with("3 of 3 runs are there already"), "{}{}", ended.stdout, ended.stderr);
}

/// Three elements have no node in the middle, and degree 2 is none of SE(3)'s.
#[test]
fn what_cannot_be_run_is_a_row() {
    let folder = tempfile::tempdir().unwrap();
    let lists =
        "[statics]\n[study]\nelements = [3, 4]\ndegree = [1, 2]\ninterpolation = [\"r12\", \"se3\"]\n";
    let ended = study(&format!("{ARC}{lists}"), folder.path(), &["load.0.on=\"arc@0.5\""]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let rows = rows(folder.path());
    let settings: Vec<_> = rows.iter().map(|row| row[..3].join(",")).collect();
    assert_eq!(settings, ["1,3,r12", "1,4,r12", "2,3,r12", "2,4,r12", "1,3,se3", "1,4,se3"]);
    for (index, row) in rows.iter().enumerate() {
        // With degree 2 the middle of three elements is a node inside the second.
        if row[1] == "4" || row[0] == "2" {
            assert_eq!(row[STATUS], "solved", "row {index}");
            continue;
        }
        assert!(row[STATUS].contains("`load.0.on`: is no node"), "row {index}: {}", row[STATUS]);
        assert!(row[POSITION..STATUS].iter().all(String::is_empty), "row {index}");
    }
    assert!(ended.stdout.contains("6 runs, 2 of which failed"), "{}", ended.stdout);
}

/// A solver that stops is a row as well, here the coil that three linear elements cannot follow.
#[test]
fn what_does_not_converge_is_a_row() {
    let folder = tempfile::tempdir().unwrap();
    let lists = "[statics]\nincrements = 10\n[study]\nincrements = [10, \"automatic\"]\n";
    let ended = study(&format!("{ARC}{lists}"), folder.path(), &["load.0.value=[0,0,5e4]"]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let rows = rows(folder.path());
    assert_eq!((rows[0][3].as_str(), rows[1][3].as_str()), ("10", ""));
    assert!(rows[0][STATUS].starts_with("no equilibrium found at load factor"), "{}", rows[0][STATUS]);
    assert!(rows[0][POSITION..COUNTS].iter().all(String::is_empty), "{:?}", rows[0]);
    // What it cost is known all the same: an iteration has one factorisation.
    assert!(number(&rows[0], COUNTS) > 0.0 && rows[0][COUNTS] == rows[0][COUNTS + 1], "{:?}", rows[0]);
    assert_eq!(rows[1][STATUS], "solved");
}

#[test]
fn a_motion_is_studied_over_its_steps() {
    let folder = tempfile::tempdir().unwrap();
    let lists = "[dynamics]\nend_time = 0.4\ntime_step = 0.02\n[study]\ndegree = [4]\ntime_step = [0.02, 0.01, 0.005]\n";
    let smooth = "load.0.time=[[0, 0], [0.2, 0.3], [0.4, 1]]";
    let ended = study(&format!("{ARC}{lists}"), folder.path(), &[smooth]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let rows = rows(folder.path());
    assert_eq!(rows.iter().map(|row| row[4].as_str()).collect::<Vec<_>>(), ["0.02", "0.01", "0.005"]);
    let errors: Vec<f64> = rows.iter().map(|row| number(row, POSITION)).collect();
    assert!(errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1], "{errors:?}");
    assert!(ended.stdout.contains("step"), "{}", ended.stdout);
}

#[test]
fn a_study_without_lists_tries_a_selection() {
    let folder = tempfile::tempdir().unwrap();
    let ended = study(&format!("{ARC}[statics]\n"), folder.path(), &[]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let rows = rows(folder.path());
    assert!((15..=30).contains(&rows.len()), "{} runs", rows.len());
    // The scene itself, other degrees, SE(3), and equal increments.
    assert_eq!(rows[0][..4], ["2", "4", "r12", ""]);
    for wanted in ["1", "2", "3", "4", "6"] {
        assert!(rows.iter().any(|row| row[0] == wanted), "degree {wanted}");
    }
    assert!(rows.iter().any(|row| row[2] == "se3") && rows.iter().any(|row| row[3] == "50"));
    let distinct: std::collections::BTreeSet<_> = rows.iter().map(|row| row[..6].join(",")).collect();
    assert_eq!(distinct.len(), rows.len());
}

#[test]
fn what_has_no_path_or_no_reference_has_no_study() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let ended = study(&format!("{ARC}[modes]\ncount = 2\n"), &out, &[]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("`modes`: have no path"), "{}", ended.stderr);
    let ended = study(&format!("{ARC}[modes]\ncount = 2\n[study]\ndegree = [1]\n"), &out, &[]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("scene.toml:19: `study`: is given beside `[modes]`"), "{}", ended.stderr);
    // (1 − 1/√5)/2 is a node of one element of degree 3 only.
    let inside = ["rod.0.elements=1", "rod.0.degree=3", "load.0.on=\"arc@0.27639320225002106\""];
    let ended = study(&format!("{ARC}[statics]\n"), &out, &inside);
    assert_eq!(ended.code, Some(2));
    assert!(
        ended.stderr.contains("`load.0.on`: is on a node that meshes of other sizes"),
        "{}",
        ended.stderr
    );
    assert!(!out.exists());
    let ended = study(&format!("{ARC}[statics]\n"), &out, &["load.0.value=[0,0,1e300]"]);
    assert_eq!(ended.code, Some(3));
    assert!(
        ended.stderr.starts_with("error: the reference that all runs would be held against"),
        "{}",
        ended.stderr
    );
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 0);
}

#[test]
fn quiet_studies_say_the_same() {
    let scenes: TempDir = tempfile::tempdir().unwrap();
    let path = write_scene(&scenes, &format!("{ARC}{STATICS}"));
    let out = scenes.path().join("out");
    let ended = cosserat(&["study", text(&path), "--out", text(&out), "--quiet"]);
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert!(ended.stdout.contains("for 1e-3: degree 2"), "{}", ended.stdout);
    // A file where the folder should be.
    let ended = cosserat(&["study", text(&path), "--out", text(&path)]);
    assert_eq!(ended.code, Some(4), "{}", ended.stderr);
}
