//! Figures of scenes of every kind, and of solutions with next to nothing in them.

mod motion;

use super::*;
use crate::solution::{ProbePose, Row, Shape};

/// A scene with one rod and what is appended.
fn scene(rest: &str) -> Scene {
    let rod = r#"
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
"#;
    Scene::from_toml(&format!("{rest}\n{rod}\n{LOAD}\n{TIP}\n[statics]\n")).unwrap()
}

const LOAD: &str = "[[load]]\nkind = \"force\"\non = \"rod@1\"\nvalue = [0, 0, 10]\n";
const TIP: &str = "[[probe]]\nname = \"tip\"\non = \"rod@1\"\n";

/// Rows at even load factors whose probe follows a function, and shapes that follow another.
fn solution(
    rows: usize,
    tip: impl Fn(f64) -> [f64; 3],
    shapes: usize,
    point: impl Fn(f64, f64) -> [f64; 3],
) -> Solution {
    let factor = |k: usize, count: usize| k as f64 / (count.max(2) - 1) as f64;
    let row = |k| Row {
        parameter: factor(k, rows),
        probes: vec![ProbePose {
            position: tip(factor(k, rows)),
            quaternion: [1.0, 0.0, 0.0, 0.0],
            angles: None,
        }],
        reactions: Vec::new(),
    };
    let shape = |k| Shape {
        parameter: factor(k, shapes),
        rods: vec![(0..=1000).map(|i| point(i as f64 / 1000.0, factor(k, shapes))).collect()],
    };
    Solution {
        rows: (0..rows).map(row).collect(),
        shapes: (0..shapes).map(shape).collect(),
        ..Solution::default()
    }
}

/// A spring with ten coils that is pulled to ten times its height.
fn spring(rows: usize) -> Solution {
    let height = |factor: f64| 0.05 + 0.5 * factor;
    let tip = |factor: f64| [0.0, 0.0, height(factor)];
    solution(rows, tip, 9, |xi, factor| {
        let (sine, cosine) = (xi * 20.0 * std::f64::consts::PI).sin_cos();
        [0.01 * sine, 0.01 * cosine, xi * height(factor)]
    })
}

fn cantilever(rows: usize) -> Solution {
    let tip = |factor: f64| [1.0, 0.0, 0.3 * factor];
    solution(rows, tip, 5, |xi, factor| [xi, 0.0, 0.3 * factor * xi * xi])
}

/// The document, after what holds for every one.
fn checked(scene: &Scene, solution: &Solution) -> String {
    let document = figure(scene, solution).unwrap();
    assert!(document.starts_with("<svg width=\""));
    assert!(document.ends_with("</svg>\n"));
    assert!(!document.contains("NaN") && !document.contains("inf"), "{document}");
    for line in document.lines() {
        let is_tag = line.starts_with('<') && line.ends_with('>') && line.matches('<').count() == 1;
        let is_text = !line.contains(['<', '>']) && line.chars().all(|c| !c.is_control());
        assert!(is_tag || is_text, "{line}");
        // Everything lies on the sheet: no number of a curve saturates.
        assert!(!line.contains("2147483647") && !line.contains("-2147483648"), "{line}");
    }
    let opened = document.matches("<text").count();
    assert_eq!(opened, document.matches("</text>").count());
    document
}

fn has_text(document: &str, text: &str) -> bool {
    document.lines().any(|line| line == text)
}

#[test]
fn a_single_force_is_drawn_over_its_displacement() {
    let document = checked(&scene(""), &cantilever(5));
    assert!(has_text(&document, "displacement in z [m]"));
    assert!(has_text(&document, "x [m]") && has_text(&document, "z [m]"));
    assert!(!document.contains("N/m"));
}

#[test]
fn the_slope_is_drawn_when_it_is_asked_for() {
    let with = checked(&scene("plot = { slope = 65.1 }"), &cantilever(5));
    assert!(has_text(&with, "65.1 N/m"));
    for slope in ["0.0", "-3.5", "1e300", "-1e-300"] {
        checked(&scene(&format!("plot = {{ slope = {slope} }}")), &cantilever(5));
    }
}

#[test]
fn other_loads_are_drawn_over_the_load_factor() {
    let mut turned = scene("");
    turned.load[0].basis = crate::scene::Basis::Body;
    let mut moment = scene("");
    moment.load[0].kind = crate::scene::LoadKind::Moment;
    let mut table = scene("");
    table.load[0].time = Some(crate::scene::LoadTime::Table(vec![[0.0, 0.0], [1.0, 1.0]]));
    let mut two = scene("");
    two.load.push(two.load[0].clone());
    let mut none = scene("");
    none.load.clear();
    for scene in [turned, moment, table, two, none] {
        let document = checked(&scene, &cantilever(5));
        assert!(has_text(&document, "load factor") && has_text(&document, "displacement [m]"));
        assert!(!has_text(&document, "force [N]"));
    }
}

#[test]
fn without_probes_there_are_only_the_shapes() {
    let mut scene = scene("");
    scene.probe.clear();
    let document = checked(&scene, &cantilever(5));
    assert!(document.starts_with("<svg width=\"580\""));
    assert!(has_text(&document, "x [m]") && !document.contains("displacement"));
}

#[test]
fn coils_stand_side_by_side_and_beams_do_not() {
    let document = checked(&scene(""), &spring(500));
    assert!(has_text(&document, "force [N], x–z plane to scale"));
    assert!(has_text(&document, "1.25") && has_text(&document, "8.75"));
    assert!(!has_text(&document, "x [m]"));
    assert!(!checked(&scene(""), &cantilever(500)).contains("to scale"));
    // Along x they stand one above the other.
    let mut lying = spring(500);
    for point in lying.shapes.iter_mut().flat_map(|shape| &mut shape.rods).flatten() {
        point.rotate_right(1);
    }
    let document = checked(&scene(""), &lying);
    assert!(document.contains("plane to scale") && has_text(&document, "x [m]"));
}

#[test]
fn many_rows_make_no_large_file() {
    let document = checked(&scene("title = \"spring\""), &spring(20_000));
    assert!(document.len() < 60_000, "{}", document.len());
}

#[test]
fn titles_and_names_are_escaped() {
    let mut scene = scene("");
    scene.title = Some("a < b & \"c\"\u{1}\u{ffff}\nd".to_owned());
    scene.plot = Some(crate::scene::Plot { slope: Some(1.0) });
    scene.probe[0].name = "<tip>".to_owned();
    let document = checked(&scene, &cantilever(5));
    assert!(document.contains("a &lt; b &amp; &quot;c&quot; "));
    assert!(has_text(&document, "&lt;tip&gt;"));
    scene.title = Some("long ".repeat(100));
    assert!(checked(&scene, &cantilever(5)).contains('…'));
}

#[test]
fn degenerate_solutions_have_a_figure() {
    let mut general = scene("plot = { slope = 2.0 }");
    general.load.clear();
    let line = |xi: f64, _: f64| [xi, 0.0, 0.0];
    let point = |_: f64, _: f64| [1e6, 0.0, -1e6];
    for solution in [
        Solution::default(),
        solution(1, |_| [1.0, 0.0, 0.0], 1, line),
        solution(9, |_| [1.0, 0.0, 0.0], 9, line),
        solution(9, |factor| [1.0, 1e-17 * factor, 0.0], 9, line),
        solution(2, |_| [1e6; 3], 3, point),
        solution(3, |_| [f64::NAN; 3], 3, |_, _| [f64::NAN; 3]),
        solution(3, |factor| [0.0, 0.0, 1e300 * factor], 3, |xi, _| [f64::INFINITY, xi, -1e300]),
        solution(3, |factor| [0.0, 0.0, 1e-300 * factor], 3, |xi, _| [1e-300 * xi; 3]),
        solution(40, |factor| [0.0, 0.0, -factor], 40, |xi, _| [0.0, 0.0, xi]),
        solution(3, |_| [0.0; 3], 0, line),
        solution(0, |_| [0.0; 3], 3, line),
    ] {
        checked(&scene("plot = { slope = 2.0 }"), &solution);
        checked(&general, &solution);
    }
}

#[test]
fn many_probes_do_not_overflow() {
    let mut scene = scene("");
    let mut solution = cantilever(5);
    for k in 0..40 {
        let name = format!("probe{k}");
        scene.probe.push(crate::scene::Probe { name, ..scene.probe[0].clone() });
        for row in &mut solution.rows {
            row.probes.push(row.probes[0].clone());
        }
    }
    checked(&scene, &solution);
    scene.load.clear();
    checked(&scene, &solution);
}

#[test]
fn a_folder_that_is_not_there_is_a_write_error() {
    let folder = tempfile::tempdir().unwrap();
    let absent = folder.path().join("absent");
    let error = plot(&absent, &scene(""), &cantilever(2)).unwrap_err();
    assert!(matches!(error, Error::File { action: "write", path, .. } if path.ends_with("absent/plot.svg")));
}
