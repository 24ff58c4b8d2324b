//! The program as its users meet it: exit codes, messages and files.

mod accuracy;
mod mistakes;
mod moving;
mod solver;
mod study;

use std::path::{Path, PathBuf};
use std::process::Command;

use mistakes::{FORMS, GOOD, Mistake, STUDY, TYPOS, UNAVAILABLE, VALUES};
use tempfile::TempDir;

struct Ended {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

fn cosserat(arguments: &[&str]) -> Ended {
    let output = Command::new(env!("CARGO_BIN_EXE_cosserat")).args(arguments).output().unwrap();
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

fn write_scene(folder: &TempDir, text: &str) -> PathBuf {
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    path
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The line, counted from 1, on which `marker` starts.
fn line_of(scene: &str, marker: &str) -> usize {
    let offset = scene.find(marker).unwrap_or_else(|| panic!("`{marker}` is not in the scene"));
    1 + scene[..offset].matches('\n').count()
}

/// Runs all cases and reports all that fail, so that one slip does not hide the others.
fn refuses(good: &str, mistakes: &[Mistake]) {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for case in mistakes {
        assert!(good.contains(case.from), "`{}` is not in the scene", case.from);
        let scene = good.replacen(case.from, case.to, 1);
        let path = write_scene(&folder, &scene);
        let line = line_of(&scene, case.at);
        let place = format!("{}:{line}: `{}`: ", path.display(), case.key);
        let ended = cosserat(&["check", text(&path)]);
        let right = ended.code == Some(2)
            && ended.stderr.starts_with("error: ")
            && ended.stderr.contains(&place)
            && ended.stderr.contains("; expected ")
            && ended.stderr.contains(case.words);
        if !right {
            wrong.push(format!(
                "{:?} -> {:?}: wanted {place}… {}\n  code {:?}: {}",
                case.from, case.to, case.words, ended.code, ended.stderr
            ));
        }
    }
    let count = mistakes.len();
    assert!(wrong.is_empty(), "{} of {count} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn typos_are_refused_in_every_table() {
    refuses(GOOD, TYPOS);
}

#[test]
fn wrong_forms_are_refused() {
    refuses(GOOD, FORMS);
}

#[test]
fn impossible_values_are_refused() {
    refuses(GOOD, VALUES);
}

#[test]
fn wrong_lists_of_a_study_are_refused() {
    refuses(GOOD, STUDY);
}

#[test]
fn what_is_not_available_yet_is_refused() {
    refuses(GOOD, UNAVAILABLE);
}

#[test]
fn a_rod_without_mass_is_refused_only_if_it_has_weight() {
    let folder = tempfile::tempdir().unwrap();
    let massless = GOOD.replacen("mass_per_length = 0.5\n", "", 1);
    let ended = cosserat(&["check", text(&write_scene(&folder, &massless))]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let heavy = massless.replacen("gravity = false\n", "", 1);
    let ended = cosserat(&["check", text(&write_scene(&folder, &heavy))]);
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("`rod.1.section.mass_per_length`: is missing"));
}

#[test]
fn the_scene_of_these_tests_is_good() {
    let folder = tempfile::tempdir().unwrap();
    let ended = cosserat(&["check", text(&write_scene(&folder, GOOD))]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(ended.stdout.contains("spring"), "{}", ended.stdout);
    assert!(ended.stdout.contains("8 elements of degree 2"), "{}", ended.stdout);
    assert!(ended.stderr.is_empty());
}

#[test]
fn a_scene_without_rods_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for scene in ["", "[statics]\n"] {
        let ended = cosserat(&["check", text(&write_scene(&folder, scene))]);
        assert_eq!(ended.code, Some(2));
        assert!(ended.stderr.contains("scene.toml:1: `rod`: is missing"), "{}", ended.stderr);
    }
}

#[test]
fn overrides_replace_and_add_entries() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, &GOOD.replacen("[plot]\nslope = 65.1\n", "", 1));
    for (set, shown) in [
        ("rod.0.elements=12", "12 elements"),
        (" rod.0.elements = 12 ", "12 elements"),
        ("rod.1.name=\"beam\"", "rod beam"),
        ("plot.slope=3.5", ""),
        ("statics.increments=7", ""),
        ("gravity.2=-1.6", ""),
        ("load.0.time=[[0, 0], [1, 2]]", ""),
        ("rod.0.section={kind=\"rectangle\", width=1e-3, height=2e-3}", ""),
        ("rod.1.gravity=false", ""),
        ("rod.1.curve.normal.0=1", ""),
    ] {
        let ended = cosserat(&["check", text(&path), "--set", set]);
        assert_eq!(ended.code, Some(0), "{set}: {}", ended.stderr);
        assert!(ended.stdout.contains(shown), "{set}: {}", ended.stdout);
    }
    let ended = cosserat(&["check", text(&path), "--set", "rod.0.elements=9", "--set", "rod.0.elements=10"]);
    assert!(ended.stdout.contains("10 elements"), "{}", ended.stdout);
}

#[test]
fn an_override_adds_an_absent_table() {
    let folder = tempfile::tempdir().unwrap();
    let scene = GOOD.split("[statics]").next().unwrap();
    let path = write_scene(&folder, scene);
    assert_eq!(cosserat(&["check", text(&path)]).code, Some(2));
    let ended = cosserat(&["check", text(&path), "--set", "statics.increments=5"]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
}

#[test]
fn wrong_overrides_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, GOOD);
    for (set, words) in [
        ("rod.0.elements", "expected KEY=VALUE"),
        ("rod.0.elements=", "has no value"),
        ("=3", "a dotted path"),
        ("rod..elements=3", "a dotted path"),
        ("rod.0.name=x", "strings need quotes: --set 'rod.0.name=\"x\"'"),
        ("rod.2.elements=3", "an index from 0 to 1"),
        ("rod.spring.elements=3", "an index from 0 to 1"),
        ("gravity.3=1", "an index from 0 to 2"),
        ("title.0=1", "neither a table nor an array"),
        ("body.0.mass=1", "is absent"),
        ("statics.increment=6", "did you mean `increments`"),
        ("rod.0.elements=0", "`rod.0.elements`: is 0; expected at least 1"),
        ("rod.0.elements=\"x\"", "a whole number"),
        ("rod.0.elemnts=3", "did you mean `elements`"),
        ("rod.0.section={kind=\"circle\"}", "`rod.0.section.diameter`: is missing"),
        ("rod.0.section.diameter=-1", "a positive diameter"),
        ("gravity.0=nan", "a finite number"),
        ("load.0.value=[0, 0, inf]", "`load.0.value.2`: is inf"),
        ("dynamics.time_step=1e-3", "`dynamics`: is given beside `[statics]`"),
        ("dynamics.accuracy=1e-3", "`dynamics`: is given beside `[statics]`"),
        ("modes.count=6", "only one of `[statics]`, `[dynamics]` and `[modes]`"),
        ("rod.0.interpolation=\"quaternion\"", "not available yet"),
    ] {
        let ended = cosserat(&["check", text(&path), "--set", set]);
        assert_eq!(ended.code, Some(2), "{set}: {}", ended.stderr);
        let place = format!("error: --set {set}: ");
        assert!(ended.stderr.starts_with(&place), "{set}: {}", ended.stderr);
        assert!(ended.stderr.contains(words), "{set}: {}", ended.stderr);
    }
}

#[test]
fn wrong_commands_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, GOOD);
    for arguments in [
        &[][..],
        &["fly"],
        &["run"],
        &["run", text(&path)],
        &["check"],
        &["check", text(&path), "--fast"],
        &["check", text(&path), "--set"],
    ] {
        assert_eq!(cosserat(arguments).code, Some(2), "{arguments:?}");
    }
    for arguments in [&["--help"][..], &["--version"], &["run", "--help"]] {
        assert_eq!(cosserat(arguments).code, Some(0), "{arguments:?}");
    }
    let version = cosserat(&["--version"]).stdout;
    assert!(version.contains(env!("CARGO_PKG_VERSION")), "{version}");
}

#[test]
fn missing_files_and_folders_that_cannot_be_made_end_with_4() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, GOOD);
    let missing = folder.path().join("absent.toml");
    for arguments in [
        &["check", text(&missing)][..],
        &["run", text(&missing), "--out", "out"],
        &["check", text(folder.path())],
        &["run", text(&path), "--out", text(&path)],
    ] {
        let ended = cosserat(arguments);
        assert_eq!(ended.code, Some(4), "{arguments:?}: {}", ended.stderr);
        assert!(ended.stderr.starts_with("error: cannot "), "{}", ended.stderr);
    }
    let ended = cosserat(&["check", text(&missing)]);
    assert!(ended.stderr.contains("absent.toml"), "{}", ended.stderr);
}

/// The results hold the scene with its defaults under that name.
#[test]
fn results_never_replace_the_scene_that_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, GOOD);
    let ended = cosserat(&["run", text(&path), "--out", text(folder.path())]);
    assert_eq!(ended.code, Some(2), "{}", ended.stderr);
    assert!(ended.stderr.starts_with("error: "), "{}", ended.stderr);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), GOOD);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_wrong_scene_leaves_no_results() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, &GOOD.replacen("elements = 8", "elements = 0", 1));
    let out = folder.path().join("out");
    let ended = cosserat(&["run", text(&path), "--out", text(&out)]);
    assert_eq!(ended.code, Some(2));
    assert!(!out.exists());
}

#[test]
fn a_run_writes_what_the_contract_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = write_scene(&folder, BEAM);
    let out = folder.path().join("results").join("beam");
    let ended = cosserat(&["run", text(&path), "--out", text(&out)]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(ended.stderr.is_empty(), "no progress without a terminal: {}", ended.stderr);
    let header = |name: &str| {
        let table = std::fs::read_to_string(out.join(name)).unwrap();
        table.lines().next().unwrap().to_owned()
    };
    assert_eq!(
        header("probes.csv"),
        "load_factor,tip.x,tip.y,tip.z,tip.qw,tip.qx,tip.qy,tip.qz,tip.alpha,tip.beta,tip.gamma,\
         root.x,root.y,root.z,root.qw,root.qx,root.qy,root.qz"
    );
    assert_eq!(
        header("reactions.csv"),
        "load_factor,joint1.fx,joint1.fy,joint1.fz,joint1.mx,joint1.my,joint1.mz"
    );
    let summary = std::fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["status"], "solved");
    assert_eq!(summary["title"], "beam");
    assert_eq!(summary["analysis"], "statics");
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert!(summary["warnings"].is_array() && summary["message"].is_string());
    for key in ["unknowns", "increments", "rejected", "newton_iterations", "factorizations"] {
        assert!(summary[key].is_u64(), "{key}: {}", summary[key]);
    }
    assert!(summary["residual"].is_number());
    for key in ["setup", "solve", "output"] {
        assert!(summary["seconds"][key].is_number(), "{key}");
    }
    let again = cosserat(&["check", text(&out.join("scene.toml"))]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);
}

/// A cantilever that any solver manages.
const BEAM: &str = r#"title = "beam"
[[rod]]
name = "beam"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 0.05 }
material = { young_modulus = 2e11, poisson_ratio = 0.3 }
elements = 2
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "beam@0"]
[[load]]
kind = "force"
on = "beam@1"
value = [0, 0, 1.0]
[[probe]]
name = "tip"
on = "beam@1"
angles = "zyx"
[[probe]]
name = "root"
on = "beam@0"
[statics]
"#;
