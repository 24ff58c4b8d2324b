//! Figures over time, and of frequencies.

use std::f64::consts::TAU;

use super::*;
use crate::scene::{Dynamics, EulerSequence, Modes, Probe};
use crate::solution::{Energies, Mode};

/// The scene in time instead of statics.
fn in_time(rest: &str) -> Scene {
    let mut scene = scene(rest);
    scene.statics = None;
    scene.dynamics = Some(Dynamics::new(8.0, 5e-3));
    scene
}

fn vibrating(rest: &str) -> Scene {
    let mut scene = scene(rest);
    scene.statics = None;
    scene.modes = Some(Modes { count: 6 });
    scene
}

/// What a probe does in time: position and angles.
type Course<'a> = &'a dyn Fn(f64) -> ([f64; 3], Option<[f64; 3]>);

/// Rows every so often whose probes follow functions, and energies that follow another.
fn motion(step: f64, end: f64, courses: &[Course], energies: impl Fn(f64) -> Energies) -> Solution {
    let times = (0..=(end / step).round() as usize).map(|k| k as f64 * step);
    let pose = |course: &Course, time: f64| {
        let (position, angles) = course(time);
        ProbePose { position, quaternion: [1.0, 0.0, 0.0, 0.0], angles }
    };
    let row = |time: f64| Row {
        parameter: time,
        probes: courses.iter().map(|course| pose(course, time)).collect(),
        reactions: Vec::new(),
    };
    Solution {
        rows: times.clone().map(row).collect(),
        energies: times.map(energies).collect(),
        ..Solution::default()
    }
}

/// Two modes of the Wilberforce pendulum as z(t) and α(t) that beat in 3.64 s, with the energy they would have.
fn wilberforce() -> (Scene, Solution) {
    let mut scene = in_time("title = \"Wilberforce pendulum\"");
    scene.probe[0].name = "bob".to_owned();
    scene.probe[0].angles = Some(EulerSequence::Zyx);
    let (slow, fast) = (14.62, 14.62 + TAU / 3.64);
    let height = |t: f64| -0.0632 + 0.0308 * (slow * t).cos() + 0.0119 * (fast * t).cos();
    let angle = |t: f64| 1.2 * ((slow * t).cos() - (fast * t).cos());
    let course = |t: f64| {
        let sway = 2e-3 * (9.29 * t).sin();
        ([sway, 0.4 * sway, height(t)], Some([angle(t), 0.02 * (40.0 * t).sin(), 0.01 * sway]))
    };
    let energies = |t: f64| {
        let rate = |of: &dyn Fn(f64) -> f64| (of(t + 1e-6) - of(t - 1e-6)) / 2e-6;
        let kinetic = 0.5 * 0.4697 * rate(&height).powi(2) + 0.5 * 1.2422e-4 * rate(&angle).powi(2);
        let gravity = 0.4697 * 9.81 * height(t);
        Energies {
            kinetic,
            gravity,
            strain: 0.4697 * 9.81 * height(0.0) - gravity - kinetic,
            constraint: 0.0,
        }
    };
    let mut solution = motion(5e-3, 8.0, &[&course], energies);
    let shape = |k: usize| {
        let bottom = 0.0185 + height(k as f64);
        let wire = (0..=1000).map(|i| i as f64 / 1000.0).map(|xi| {
            let (sine, cosine) = (TAU * 20.0 * xi).sin_cos();
            [0.016 * sine, 0.016 * cosine, bottom + xi * (3e-3 - bottom)]
        });
        Shape { parameter: k as f64, rods: vec![wire.collect()] }
    };
    solution.shapes = (0..9).map(shape).collect();
    (scene, solution)
}

#[test]
fn a_beat_is_drawn_with_its_envelope_and_its_times() {
    let (scene, solution) = wilberforce();
    let document = checked(&scene, &solution);
    for text in ["z of bob [m]", "α of bob [rad]", "time [s]", "Δ energy [J]", "kinetic", "strain", "total"]
    {
        assert!(has_text(&document, text), "{text}");
    }
    assert!(!has_text(&document, "x of bob [m]") && !document.contains("load factor"));
    // Half a beat and a beat, to the half period between two swings.
    for (name, wanted) in [("smallest", 1.82), ("largest", 3.64)] {
        let start = format!("{name} swing at ");
        let mut times = document.lines().filter_map(|line| line.strip_prefix(&start)?.strip_suffix(" s"));
        let time: f64 = times.next().unwrap().parse().unwrap();
        assert!((time - wanted).abs() < 0.11, "{name}: {time}");
    }
    assert_eq!(document.lines().filter(|line| line.contains("swing at")).count(), 4);
    assert!(document.len() < 200_000, "{}", document.len());
}

#[test]
fn without_rods_the_panels_stand_alone() {
    let mut scene = in_time("");
    scene.rod.clear();
    scene.probe[0].name = "upper".to_owned();
    scene.probe.push(Probe { name: "lower".to_owned(), ..scene.probe[0].clone() });
    let upper = |t: f64| ([0.5 * (3.0 * t).sin(), 0.0, -0.9 - 0.05 * (6.0 * t).cos()], None);
    let lower =
        |t: f64| ([0.9 * (3.0 * t).sin() + 0.2 * (7.3 * t).sin(), 0.0, -1.8 + 0.3 * (6.0 * t).cos()], None);
    let energies = |t: f64| {
        let kinetic = 1.0 - (6.0 * t).cos();
        Energies { kinetic, strain: 0.0, gravity: -20.0 - kinetic, constraint: 1e-14 }
    };
    let document = checked(&scene, &motion(0.01, 8.0, &[&upper, &lower], energies));
    assert!(document.starts_with("<svg width=\"780\""));
    for text in ["displacement [m]", "x of upper", "x of lower", "z of lower", "gravity"] {
        assert!(has_text(&document, text), "{text}");
    }
    assert!(!has_text(&document, "y of upper") && !document.contains("swing at"));
}

/// A beam that swings in its first mode, damped.
fn beam(step: f64, end: f64) -> Solution {
    let deflection = |t: f64| 0.1 * (-0.3 * t).exp() * (12.0 * t).sin();
    let course = |t: f64| ([1.0, 0.0, deflection(t)], None);
    let mut solution = motion(step, end, &[&course], |_| Energies::default());
    let shape = |k: usize| {
        let time = end * k as f64 / 8.0;
        let points = (0..=100).map(|i| i as f64 / 100.0);
        Shape {
            parameter: time,
            rods: vec![points.map(|xi| [xi, 0.0, deflection(time) * xi * xi]).collect()],
        }
    };
    solution.shapes = (0..9).map(shape).collect();
    solution
}

#[test]
fn one_signal_over_its_energies_stands_beside_the_shapes() {
    let document = checked(&in_time("title = \"beam\""), &beam(0.01, 5.0));
    assert!(document.starts_with("<svg width=\"980\""));
    assert!(has_text(&document, "z of tip [m]") && has_text(&document, "Δ energy [J]"));
    assert!(!document.contains("swing at"), "a decay is no beat");
}

#[test]
fn many_steps_make_no_large_file() {
    let document = checked(&in_time(""), &beam(1e-3, 400.0));
    assert!(document.len() < 250_000, "{}", document.len());
}

#[test]
fn many_probes_over_time_do_not_overflow() {
    let mut scene = in_time("");
    let mut solution = beam(0.01, 5.0);
    for k in 0..40 {
        let name = format!("a probe with a long name, number {k}");
        scene.probe.push(Probe { name, angles: Some(EulerSequence::Zyx), ..scene.probe[0].clone() });
        for row in &mut solution.rows {
            let mut pose = row.probes[0].clone();
            pose.angles = Some([k as f64 * row.parameter, 0.0, 0.0]);
            row.probes.push(pose);
        }
    }
    let document = checked(&scene, &solution);
    assert!(has_text(&document, "and 35 more, not drawn"));
}

#[test]
fn degenerate_motions_have_a_figure() {
    let still = |_: f64| ([1.0, 0.0, 0.0], Some([0.0; 3]));
    let wild = |t: f64| ([f64::NAN, 1e300 * t, f64::INFINITY], Some([f64::NAN; 3]));
    let tiny = |t: f64| ([1.0 + 1e-17 * t, 1e-200 * t, 0.0], None);
    let nothing = |_: f64| Energies::default();
    let nan =
        |_: f64| Energies { kinetic: f64::NAN, strain: f64::INFINITY, gravity: f64::NAN, constraint: 0.0 };
    let mut fewer = motion(0.1, 1.0, &[&still], nothing);
    fewer.energies.truncate(3);
    let mut none = motion(0.1, 1.0, &[], nothing);
    none.shapes = beam(0.1, 1.0).shapes;
    for mut solution in [
        Solution::default(),
        motion(1.0, 0.0, &[&still], nothing),
        motion(0.1, 1.0, &[&still], nothing),
        motion(0.1, 1.0, &[&wild], nan),
        motion(0.1, 1.0, &[&tiny], nothing),
        motion(1e-9, 2e-8, &[&still], nothing),
        beam(0.1, 1.0),
        fewer,
        none,
    ] {
        let mut scene = in_time("");
        checked(&scene, &solution);
        scene.probe.clear();
        checked(&scene, &solution);
        scene.rod.clear();
        solution.shapes.clear();
        solution.energies.clear();
        checked(&scene, &solution);
    }
}

fn modes(angular_frequencies: &[f64]) -> Solution {
    let mode =
        |angular_frequency: &f64| Mode { angular_frequency: *angular_frequency, shape: vec![[0.5; 6]] };
    Solution { modes: angular_frequencies.iter().map(mode).collect(), ..spring(5) }
}

#[test]
fn frequencies_are_stems_beside_the_equilibrium() {
    let title = "title = \"Wilberforce pendulum, small vibrations\"";
    let frequencies = [9.29042911, 9.29492582, 14.80498367, 16.15745086, 39.97342849, 39.99370383];
    let document = checked(&vibrating(title), &modes(&frequencies));
    for text in
        ["frequency [Hz]", "mode", "6", "1.4786", "1.4793", "2.3563", "load factor, x–z plane to scale"]
    {
        assert!(has_text(&document, text), "{text}");
    }
    assert!(!document.contains("unstable"));
    let unstable = checked(&vibrating(title), &modes(&[-5.0, 0.0, 3.0, 12.0]));
    assert!(document.len() < 60_000 && unstable.contains("unstable"));
}

#[test]
fn degenerate_modes_have_a_figure() {
    let many: Vec<f64> = (0..300).map(f64::from).collect();
    for frequencies in [&[][..], &[0.0], &[-1.0], &[-1.0, -0.5], &[1e9, 2e9], &[f64::NAN, 1.0], &many] {
        let mut solution = modes(frequencies);
        checked(&vibrating(""), &solution);
        solution.shapes.clear();
        solution.rows.clear();
        checked(&vibrating(""), &solution);
    }
}
