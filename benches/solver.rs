//! The paper's two experiments, the 45° bend, and frequencies. What is covered: see README.md beside this file.

use std::hint::black_box;
use std::path::Path;

use cosserat::assembly::{LoadLevel, Workspace};
use cosserat::scene::{Coordinates, Modes, Reference};
use cosserat::{Model, Scene, dynamics, modes, statics};
use criterion::{Criterion, criterion_group, criterion_main};

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

/// Residual, tangent, factorisation, solution, stress iterate: one Newton iteration of 75 quadratic elements.
fn iteration(criterion: &mut Criterion) {
    let mut scene = scene("helical_spring.toml");
    scene.rod[0].reference = Reference::Nodes;
    let model = model(&scene);
    let mut work = Workspace::new(&model, Coordinates::Increments);
    let state = model.reference_state().clone();
    let level = LoadLevel { load_factor: 1e-3, preload: 1.0 };
    criterion.bench_function("spring/iteration", |bencher| {
        bencher.iter(|| {
            work.evaluate(&model, &state, &level, None).expect("regular");
            black_box(work.residual(&model, &state, (1.0, 1.0), None));
            work.factorize(&model, &state, &level, None).expect("regular");
            work.solve(&model, &state, 1.0).expect("regular");
            work.advance_stresses(&model, &state).expect("regular");
            work.reset_stresses();
        });
    });
}

/// Whole solves, model included.
fn solves(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("solve");
    group.sample_size(10);
    let equal = scene("helical_spring.toml");
    let mut automatic = equal.clone();
    automatic.statics = Some(Default::default());
    for (name, scene) in [
        ("spring_500_increments", equal),
        ("spring_automatic", automatic),
        ("bend_45", scene("bend_45.toml")),
    ] {
        let options = scene.statics.clone().unwrap_or_default();
        group.bench_function(name, |bencher| {
            bencher.iter(|| statics::solve(&model(&scene), &options, &mut |_, _| ()).expect("solvable"));
        });
    }
    group.finish();
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

criterion_group!(benches, fit, iteration, solves, motions, frequencies);
criterion_main!(benches);
