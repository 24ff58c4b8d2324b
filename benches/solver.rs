//! Whole runs: the paper's two experiments, the 45° bend, a swinging cantilever, frequencies, many scenes on threads. What
//! is covered: see README.md beside this file; what one iteration is made of: iteration.rs.

use std::hint::black_box;
use std::path::Path;
use std::thread;

use cosserat::scene::{Modes, Reference, Statics};
use cosserat::{Model, Scene, dynamics, modes, statics};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    Scene::from_file(&path).expect("a scene of the repository")
}

fn model(scene: &Scene) -> Model {
    Model::new(scene).expect("a scene of the repository")
}

/// Setup with the fit (21) of 151 nodes to 301 samples.
fn fit(criterion: &mut Criterion) {
    let scene = scene("helical_spring.toml");
    criterion.bench_function("spring/fit_301", |bencher| bencher.iter(|| model(black_box(&scene))));
}

/// Whole solves, model included.
fn solves(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("solve");
    group.sample_size(10);
    let equal = scene("helical_spring.toml");
    let mut automatic = equal.clone();
    automatic.statics = Some(Statics::default());
    for (name, scene) in [
        ("spring_500_increments", equal),
        ("spring_automatic", automatic),
        ("spring_to_0.161_mm", exact_spring(4, 21)),
        ("spring_to_1e-6_mm", exact_spring(6, 62)),
        ("bend_45", scene("bend_45.toml")),
        ("bend_45_to_1e-5", exact_bend(4, 4)),
    ] {
        let options = scene.statics.clone().unwrap_or_default();
        group.bench_function(name, |bencher| {
            bencher.iter(|| statics::solve(&model(&scene), &options, &mut |_, _| ()).expect("solvable"));
        });
    }
    group.finish();
}

/// Tip of the spring under 100 N less its start [m], and of the bend under 600: references/continuous.
const SPRING_TIP: [f64; 3] = [0.005730260972898743, 0.005313272581177347, 0.5725982310726363];
const BEND_TIP: [f64; 3] = [47.150438573629025, 15.684800534038759, 53.47485879182515];

/// The cheapest settings found for an error of the tip below 0.161 mm (degree 4, 21 elements: 0.132 mm) and 1e-6 mm
/// (degree 6, 62 elements: 9.3e-7 mm): nodes on the curve, automatic increments.
fn exact_spring(degree: usize, elements: usize) -> Scene {
    let mut scene = scene("helical_spring.toml");
    scene.rod[0].reference = Reference::Nodes;
    (scene.rod[0].degree, scene.rod[0].elements) = (degree, elements);
    scene.statics = Some(Statics::default());
    let start = [0.0, -10e-3, 50e-3];
    let bound = if degree == 4 { 0.161e-3 } else { 1e-9 };
    assert!(error(&scene, &start, &SPRING_TIP) <= bound);
    scene
}

/// The same for 1e-5 (1.7e-6): the whole load in one increment.
fn exact_bend(degree: usize, elements: usize) -> Scene {
    let mut scene = scene("bend_45.toml");
    (scene.rod[0].degree, scene.rod[0].elements) = (degree, elements);
    scene.statics = Some(Statics { increments: Some(1), ..Statics::default() });
    assert!(error(&scene, &[0.0; 3], &BEND_TIP) <= 1e-5);
    scene
}

/// Distance of the first probe's last place less `start` from the exact one.
fn error(scene: &Scene, start: &[f64; 3], exact: &[f64; 3]) -> f64 {
    let options = scene.statics.clone().unwrap_or_default();
    let solution = statics::solve(&model(scene), &options, &mut |_, _| ()).expect("solvable");
    let tip = solution.rows.last().expect("a row").probes[0].position;
    (0..3).map(|k| (tip[k] - start[k] - exact[k]).powi(2)).sum::<f64>().sqrt()
}

/// The Wilberforce pendulum: consistent start and one step, and the paper's eight seconds.
fn motions(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("wilberforce");
    group.sample_size(10);
    let scene = scene("wilberforce.toml");
    let model = model(&scene);
    for (name, end_time) in [("start_and_one_step", 5e-3), ("8_seconds", 8.0)] {
        let Some(mut options) = scene.dynamics.clone() else { continue };
        options.end_time = end_time;
        group.bench_function(name, |bencher| {
            bencher.iter(|| dynamics::solve(&model, &options, &mut |_, _| ()).expect("solvable"));
        });
    }
    group.finish();
}

/// A soft cantilever of 75 quadratic elements (151 nodes) falls from rest: 100 steps, reported by the step.
fn cantilever(criterion: &mut Criterion) {
    const STEPS: u64 = 100;
    let scene = Scene::from_toml(
        r#"
        gravity = [0.0, 0.0, -9.81]

        [[rod]]
        name = "rod"
        curve = { kind = "line", length = 1.0 }
        section = { kind = "circle", diameter = 0.02 }
        material = { young_modulus = 1.225e8, poisson_ratio = 0.3, density = 1000.0 }
        elements = 75
        degree = 2

        [[joint]]
        kind = "rigid"
        between = ["ground", "rod@0"]

        [dynamics]
        end_time = 0.1
        time_step = 1e-3
    "#,
    )
    .expect("a scene");
    let Some(options) = scene.dynamics.clone() else { return };
    let model = model(&scene);
    let mut group = criterion.benchmark_group("cantilever_151_nodes");
    group.sample_size(10).throughput(Throughput::Elements(STEPS));
    group.bench_function("100_steps", |bencher| {
        bencher.iter(|| {
            let solution = dynamics::solve(&model, &options, &mut |_, _| ()).expect("solvable");
            assert_eq!(solution.statistics.increments as u64, STEPS);
        });
    });
    group.finish();
}

/// 200 Wilberforce pendulums with bobs of different density, 20 steps each with their models, on one and two threads.
fn sweep(criterion: &mut Criterion) {
    const PENDULUMS: usize = 200;
    let original = scene("wilberforce.toml");
    let scenes: Vec<Scene> = (0..PENDULUMS)
        .map(|k| {
            let mut scene = original.clone();
            scene.body[0].density = scene.body[0].density.map(|density| density * (1.0 + 1e-3 * k as f64));
            if let Some(dynamics) = &mut scene.dynamics {
                dynamics.end_time = 0.1;
            }
            scene
        })
        .collect();
    let swing = |scene: &Scene| {
        let Some(options) = &scene.dynamics else { return };
        black_box(dynamics::solve(&model(scene), options, &mut |_, _| ()).expect("solvable"));
    };
    let mut group = criterion.benchmark_group("200_pendulums");
    group.sample_size(10).throughput(Throughput::Elements(PENDULUMS as u64));
    for threads in [1, 2] {
        group.bench_function(format!("{threads}_threads"), |bencher| {
            bencher.iter(|| {
                thread::scope(|scope| {
                    for part in scenes.chunks(PENDULUMS / threads) {
                        scope.spawn(|| part.iter().for_each(swing));
                    }
                });
            });
        });
    }
    group.finish();
}

/// Six modes of the pendulum about the shape stretched by the weight.
fn frequencies(criterion: &mut Criterion) {
    let mut scene = scene("wilberforce.toml");
    scene.dynamics = None;
    let options = Modes { count: 6 };
    scene.modes = Some(options.clone());
    let model = model(&scene);
    criterion.bench_function("wilberforce/six_modes", |bencher| {
        bencher.iter(|| modes::solve(&model, &options, &mut |_, _| ()).expect("solvable"));
    });
}

criterion_group!(benches, fit, solves, motions, cantilever, sweep, frequencies);
criterion_main!(benches);
