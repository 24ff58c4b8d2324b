//! What one Newton iteration is made of, for every kind of element and every size of rod. What is covered: see README.md
//! beside this file; whole runs: solver.rs.

use std::env;
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

use cosserat::assembly::{Blocks, LoadLevel, Motion, Workspace};
use cosserat::inertia::Velocity;
use cosserat::rod::StepVelocity;
use cosserat::scene::{Coordinates, Reference};
use cosserat::state::State;
use cosserat::{Model, Scene};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};

/// Of the rods whose parts are measured: what they need fits into the second cache.
const ELEMENTS: usize = 64;
/// Of the rods of growing size.
const ITERATIONS: usize = 3;
/// Hands the rod of a million elements to the bench of sizes: it needs 4 GB and a minute.
const MILLION: &str = "COSSERAT_BENCH_MILLION";

/// A quarter circle, clamped, with a dead force at its end and so light a load that Newton's iteration stays near it.
fn arc(interpolation: &str, degree: usize, elements: usize) -> Model {
    let scene = Scene::from_toml(&format!(
        r#"
        [[rod]]
        name = "rod"
        curve = {{ kind = "arc", radius = 1.0, angle = 1.5707963267948966 }}
        section = {{ kind = "circle", diameter = 0.02 }}
        material = {{ young_modulus = 1e9, poisson_ratio = 0.3, density = 1000.0 }}
        elements = {elements}
        degree = {degree}
        interpolation = "{interpolation}"

        [[joint]]
        kind = "rigid"
        between = ["ground", "rod@0"]

        [[load]]
        kind = "force"
        on = "rod@1"
        value = [0.0, 0.0, 1.0]

        [dynamics]
        end_time = 1.0
        time_step = 1e-2
    "#
    ));
    Model::new(&scene.expect("a scene")).expect("a model")
}

/// One iteration of statics but for its convergence test.
fn iterate(work: &mut Workspace, model: &Model, state: &mut State, level: &LoadLevel) {
    work.evaluate(model, state, level, None).expect("regular");
    work.factorize(model, state, level, None).expect("regular");
    work.solve(model, state, 1.0).expect("regular");
    work.advance_stresses(model, state).expect("regular");
    work.update(model, state);
}

const FULL: LoadLevel = LoadLevel { load_factor: 1.0, preload: 1.0 };

/// The parts of an iteration in statics, for every kind of element, reported by the element.
fn parts(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("parts");
    group.warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
    group.throughput(Throughput::Elements(ELEMENTS as u64));
    for (interpolation, degree) in [("r12", 1), ("r12", 2), ("r12", 4), ("r12", 8), ("se3", 1)] {
        let model = arc(interpolation, degree, ELEMENTS);
        let mut work = Workspace::new(&model, Coordinates::Increments);
        let mut state = model.reference_state().clone();
        for _ in 0..2 {
            iterate(&mut work, &model, &mut state, &FULL);
        }
        work.evaluate(&model, &state, &FULL, None).expect("regular");
        let name = |part: &str| format!("{part}/{interpolation}_p{degree}");
        group.bench_function(name("force"), |bencher| {
            bencher.iter(|| work.evaluate(&model, black_box(&state), &FULL, None));
        });
        group.bench_function(name("tangent_and_elimination"), |bencher| {
            bencher.iter(|| work.factorize(&model, black_box(&state), &FULL, None));
        });
        group.bench_function(name("substitution"), |bencher| {
            bencher.iter(|| work.solve(&model, black_box(&state), 1.0));
        });
        group.bench_function(name("stresses"), |bencher| {
            bencher.iter(|| work.advance_stresses(&model, black_box(&state)));
        });
    }
    group.finish();
}

/// The same in motion, and the blocks of M, D and K without elimination, for two quadratic kinds of cost.
fn moving_parts(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("moving_parts");
    group.warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(2));
    group.throughput(Throughput::Elements(ELEMENTS as u64));
    for degree in [2, 4] {
        let model = arc("r12", degree, ELEMENTS);
        let mut work = Workspace::new(&model, Coordinates::Increments);
        let state = model.reference_state().clone();
        let mut blocks = Blocks::default();
        let velocity = Velocity { rotation: [0.1, 0.2, 0.3].into(), ..Velocity::default() };
        let velocities = vec![velocity; state.poses().len()];
        let motion = Motion { accelerations: velocities.clone(), velocities };
        let step = StepVelocity { velocities: &motion.velocities, b: 5e-3 };
        work.evaluate(&model, &state, &FULL, Some(&motion)).expect("regular");
        let name = |part: &str| format!("{part}/r12_p{degree}");
        group.bench_function(name("force"), |bencher| {
            bencher.iter(|| work.evaluate(&model, black_box(&state), &FULL, Some(&motion)));
        });
        group.bench_function(name("tangent_and_elimination"), |bencher| {
            bencher.iter(|| work.factorize(&model, black_box(&state), &FULL, Some(&step)));
        });
        group.bench_function(name("blocks"), |bencher| {
            bencher.iter(|| work.blocks(&model, black_box(&state), &FULL, &motion.velocities, &mut blocks));
        });
    }
    group.finish();
}

/// Residual, tangent, factorisation, solution, stress iterate: one Newton iteration of the paper's spring.
fn spring(criterion: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/helical_spring.toml");
    let mut scene = Scene::from_file(&path).expect("a scene of the repository");
    scene.rod[0].reference = Reference::Nodes;
    let model = Model::new(&scene).expect("a scene of the repository");
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

/// A fixed number of iterations from the reference, for rods of more and more quadratic elements, reported by the
/// element and iteration. The load is that of the rod's first iteration all the time: what an iteration costs does
/// not depend on where it leads.
fn scaling(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("scaling");
    group.sample_size(10).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(4));
    let mut sizes = vec![100, 1_000, 10_000, 100_000];
    if env::var_os(MILLION).is_some() {
        sizes.push(1_000_000);
    }
    for elements in sizes {
        group.throughput(Throughput::Elements((elements * ITERATIONS) as u64));
        group.bench_function(format!("{elements}_elements"), |bencher| {
            let model = arc("r12", 2, elements);
            let mut work = Workspace::new(&model, Coordinates::Increments);
            // A long rod of many elements is soft against rounding: the load is light enough for all sizes.
            let level = LoadLevel { load_factor: 1e-6, preload: 1.0 };
            bencher.iter_batched_ref(
                || model.reference_state().clone(),
                |state| {
                    work.reset_stresses();
                    for _ in 0..ITERATIONS {
                        iterate(&mut work, &model, state, &level);
                    }
                },
                BatchSize::PerIteration,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, parts, moving_parts, spring, scaling);
criterion_main!(benches);
