//! Steps of a nanosecond and of a tenth of a swing, steps that fail, and loads that vary in time.

use cosserat::scene::{Basis, Body, Dynamics, JointKind, Load, LoadKind, LoadTime, NamedTime, Scene};
use cosserat::solution::{Solution, SolveError};
use cosserat::{Model, dynamics};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::body_chain;
use crate::measure::{load, probe};
use crate::steps::{body, check_second_order, check_vanishes, halved_twice, joint, run};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("time_steps::nanoseconds", "Taylor's series of the motion", nanoseconds),
        Case::new("time_steps::tenth_of_a_swing", "the period of a pendulum", tenth_of_a_swing),
        Case::new("time_steps::failure", "what converged before is kept", failure),
        Case::new("time_steps::impulse", "the time integral of the load", impulse),
        Case::new("time_steps::turning_force", "closed form", turning_force),
    ]
}

const GRAVITY: f64 = 9.81;
const STEP: f64 = 1e-9;

/// A body at (1, 0, 0) with Θ₂ = 0.25; on a ball joint at the origin its inertia about e_y there is 1 + 0.25.
fn weight(held: bool, options: Dynamics) -> Scene {
    let pivot = joint("pivot", JointKind::Spherical, ["ground", "bob"], [0.0; 3]);
    Scene {
        gravity: Some([0.0, 0.0, -GRAVITY]),
        body: vec![body("bob", 1.0, [0.2, 0.25, 0.3], [1.0, 0.0, 0.0])],
        joint: if held { vec![pivot] } else { Vec::new() },
        probe: vec![probe("bob", "bob")],
        dynamics: Some(options),
        ..Scene::default()
    }
}

fn fall(solution: &Solution) -> f64 {
    solution.rows.last().map_or(f64::NAN, |row| row.probes[0].position[2])
}

fn nanoseconds(checks: &mut Checks) -> Outcome {
    let time = 100.0 * STEP;
    let solution = run(&weight(false, Dynamics::new(time, STEP)))?;
    let exact = -0.5 * GRAVITY * time * time;
    let reason = "order 2: an error of h² g from the start, where a = ẏ is the average of a step off by half of \
                  it, is (h/t)² of the way";
    let bound = (STEP / time).powi(2);
    checks.relative(
        Kind::ClosedForm,
        "way of a free fall from rest",
        (fall(&solution), exact),
        bound,
        reason,
    );
    let speed = (2.0 * solution.energies.last().ok_or("no energies")?.kinetic).sqrt();
    let reason = "a constant acceleration is summed exactly, but for a hundred roundings";
    checks.relative(Kind::ClosedForm, "its speed", (speed, GRAVITY * time), 100.0 * f64::EPSILON, reason);

    // θ̈ = −g/1.25 cos θ from θ̇ = −2: z = sin θ. The next term of the series is 1e-21.
    let mut pendulum = weight(true, Dynamics::new(time, STEP));
    pendulum.body[0].velocity = [0.0, 0.0, -2.0];
    pendulum.body[0].angular_velocity = [0.0, 2.0, 0.0];
    let solution = run(&pendulum)?;
    let angle = -2.0 * time - 0.5 * GRAVITY / 1.25 * time * time;
    let reason =
        "a position of 1 m is known to 2e-16 and joints close to 8 of these, in each of a hundred steps";
    let bound = 100.0 * 8.0 * f64::EPSILON;
    checks.absolute(Kind::ClosedForm, "way of the pendulum", (fall(&solution), angle), bound, reason);
    let x = solution.rows.last().ok_or("no rows")?.probes[0].position[0];
    checks.absolute(Kind::ClosedForm, "its distance", (x, 1.0 - 0.5 * angle * angle), bound, reason);
    let kinetic = solution.energies.last().ok_or("no energies")?.kinetic;
    let rate: f64 = 2.0 + GRAVITY / 1.25 * time;
    let reason = "8 roundings of 1 m in a step of 1 ns are 2e-6 m/s, twice that in the square, and damped from \
                  step to step";
    checks.relative(Kind::ClosedForm, "its energy", (kinetic, 0.5 * 1.25 * rate * rate), 4e-6, reason);
    Ok(())
}

fn tenth_of_a_swing(checks: &mut Checks) -> Outcome {
    // Small swings about the vertical: T = 2π √(1.25/g); the bob starts 0.02 rad beside it.
    const ANGLE: f64 = 0.02;
    let frequency = (GRAVITY / 1.25).sqrt();
    let period = std::f64::consts::TAU / frequency;
    let step = period / 10.0;
    let mut scene = weight(true, Dynamics::new(20.0 * period, step));
    scene.body[0].position = [ANGLE.sin(), 0.0, -ANGLE.cos()];
    let solution = run(&scene)?;
    let swing: Vec<f64> = solution.rows.iter().map(|row| row.probes[0].position[0]).collect();
    let rows = swing.len() as f64;
    let reason = "all 200 steps and the start";
    checks.absolute(Kind::Invariant, "rows", (rows, 201.0), 0.0, reason);
    let largest = swing.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let reason = "unconditionally stable on a linear oscillator: no swing is higher than the first, but for the start, where \
                  a = ẏ is the average of a step off by half of it: (ωh)² /8";
    let allowed = ANGLE.sin() * (1.0 + (frequency * step).powi(2) / 8.0);
    checks.below(Kind::Invariant, "highest swing", largest, allowed, reason);
    // The period, from the first and the last passage downwards through 0.
    let passages: Vec<f64> = (1..swing.len())
        .filter(|&k| swing[k - 1] > 0.0 && swing[k] <= 0.0)
        .map(|k| (k - 1) as f64 + swing[k - 1] / (swing[k - 1] - swing[k]))
        .collect();
    let count = passages.len().checked_sub(1).ok_or("the pendulum does not swing")?;
    let found = (passages[count] - passages[0]) * step / count as f64;
    let reason = "relative period error of a second-order method with ρ∞ in [0, 1]: (ωh)²/12 at best, (ωh)²/3 at \
                  worst";
    let bound = (frequency * step).powi(2) / 3.0;
    checks.relative(Kind::ClosedForm, "period", (found, period), bound, reason);
    Ok(())
}

/// Whether every number of the rows and energies is one.
fn finite(solution: &Solution) -> bool {
    let rows = solution.rows.iter().all(|row| {
        let probes = row.probes.iter().flat_map(|pose| pose.position.iter().chain(&pose.quaternion));
        probes.chain(row.reactions.iter().flatten()).all(|x| x.is_finite())
    });
    rows && solution
        .energies
        .iter()
        .all(|energies| energies.total().is_finite() && energies.constraint.is_finite())
}

fn check_failure(checks: &mut Checks, what: &str, scene: &Scene, iterations: usize) -> Outcome {
    let model = Model::new(scene)?;
    let options = scene.dynamics.as_ref().ok_or("no [dynamics]")?;
    let step = options.time_step().ok_or("no constant step")?;
    let Err(failure) = dynamics::solve(&model, options, &mut |_, _| ()) else {
        return Err(format!("{what} did not fail").into());
    };
    let SolveError::Step { time, iterations: spent, residual, tolerance, steps, reached, .. } = failure.error
    else {
        return Err(format!("{what} failed otherwise: {}", failure.error).into());
    };
    let partial = &failure.partial;
    let reason = "what the error says is what is kept: the start and a row for every step";
    let rows = partial.rows.len() as f64;
    checks.absolute(Kind::Invariant, format!("{what}: rows"), (rows, steps as f64 + 1.0), 0.0, reason);
    let energies = partial.energies.len() as f64;
    checks.absolute(Kind::Invariant, format!("{what}: energies"), (energies, rows), 0.0, reason);
    let last = partial.rows.last().map_or(f64::NAN, |row| row.parameter);
    checks.absolute(Kind::Invariant, format!("{what}: last time"), (last, reached), 0.0, reason);
    let reason = "steps are constant";
    checks.absolute(Kind::Invariant, format!("{what}: time tried"), (time - reached, step), 1e-12, reason);
    let reason = "no more than were allowed";
    checks.below(Kind::Invariant, format!("{what}: iterations"), spent as f64, iterations as f64, reason);
    let reason = "it was not accepted, and it is a number";
    checks.above(Kind::Invariant, format!("{what}: residual"), residual, tolerance, reason);
    let all = f64::from(u8::from(finite(partial) && residual.is_finite()));
    checks.absolute(Kind::Invariant, format!("{what}: numbers are finite"), (all, 1.0), 0.0, "none is NaN");
    Ok(())
}

fn failure(checks: &mut Checks) -> Outcome {
    // At rest, without gravity, until half a second: then a blow that one iteration does not follow.
    let mut blow = weight(true, Dynamics { max_iterations: 1, ..Dynamics::new(1.0, 1e-2) });
    blow.gravity = None;
    let course = LoadTime::Table(vec![[0.5, 0.0], [0.51, 1.0]]);
    blow.load.push(Load { time: Some(course), ..load(LoadKind::Force, "bob", [0.0, 300.0, 0.0]) });
    check_failure(checks, "one iteration", &blow, 1)?;
    let model = Model::new(&blow)?;
    let options = blow.dynamics.as_ref().ok_or("no [dynamics]")?;
    if let Err(failure) = dynamics::solve(&model, options, &mut |_, _| ()) {
        let reason = "0.5 s at rest are 50 steps; whether the 50th ends a rounding after the bend is open";
        let steps = failure.partial.statistics.increments as f64;
        checks.absolute(Kind::Invariant, "one iteration: steps before", (steps, 50.0), 1.0, reason);
    }
    // The chain of bodies turns several times in such a step: no iteration finds its end.
    let mut long = body_chain::scene(true, 5.0);
    if let Some(options) = &mut long.dynamics {
        options.end_time = 50.0;
        options.max_iterations = 12;
    }
    check_failure(checks, "a step of 5 s", &long, 12)
}

/// How the loads on a free body vary; every bend ends a step.
const COURSE: [[f64; 2]; 4] = [[0.0, 0.0], [0.4, 1.0], [0.8, -0.5], [1.2, 0.0]];

/// Inside the last piece: at its end, where the load and the bends that are left sum up to nothing, the error of
/// order 2 vanishes.
const LOADED: f64 = 1.0;

/// ∫ and ∬ of the course up to [`LOADED`], by its polynomials: h (a + b)/2 and h² (2a + b)/6 in each piece.
fn integrals() -> [f64; 2] {
    let (mut once, mut twice) = (0.0, 0.0);
    for [t, a, u, b] in [[0.0, 0.0, 0.4, 1.0], [0.4, 1.0, 0.8, -0.5], [0.8, -0.5, LOADED, -0.25]] {
        let h: f64 = u - t;
        twice += once * h + h * h * (2.0 * a + b) / 6.0;
        once += 0.5 * h * (a + b);
    }
    [once, twice]
}

const FORCE: [f64; 3] = [2.0, -1.0, 0.5];
const MOMENT: f64 = 3.0;
const MASS: f64 = 0.8;
const INERTIA: [f64; 3] = [0.2, 0.25, 0.3];

fn impulse(checks: &mut Checks) -> Outcome {
    let course = || Some(LoadTime::Table(COURSE.to_vec()));
    let mut force = Load { time: course(), ..load(LoadKind::Force, "bob", FORCE) };
    let moment =
        Load { time: course(), basis: Basis::Body, ..load(LoadKind::Moment, "bob", [0.0, 0.0, MOMENT]) };
    let scene = |loads: Vec<Load>| Scene {
        body: vec![body("bob", MASS, INERTIA, [0.0; 3])],
        load: loads,
        probe: vec![probe("bob", "bob")],
        dynamics: Some(Dynamics::new(LOADED, 0.04)),
        ..Scene::default()
    };
    let [once, twice] = integrals();
    let reason = "0.2 + 0.1 − 0.075 of the trapezoids";
    checks.absolute(Kind::ClosedForm, "integral of the course", (once, 0.225), 1e-15, reason);

    let runs = halved_twice(&scene(vec![force.clone()]))?;
    let ways: Vec<[f64; 3]> = runs.iter().map(|run| last_position(run).into()).collect();
    let exact = FORCE.map(|f| f * twice / MASS);
    check_second_order(checks, "way under the force", [&ways[0], &ways[1], &ways[2]], &exact);
    let speeds: Vec<[f64; 1]> = runs.iter().map(|run| [speed(run, MASS)]).collect();
    let exact = Vector3::from(FORCE).norm() * once / MASS;
    check_second_order(checks, "momentum over mass", [&speeds[0], &speeds[1], &speeds[2]], &[exact]);

    let runs = halved_twice(&scene(vec![moment]))?;
    let angles: Vec<[f64; 1]> = runs.iter().map(|run| [turn_about_z(run)]).collect();
    check_second_order(
        checks,
        "turn under the moment",
        [&angles[0], &angles[1], &angles[2]],
        &[MOMENT * twice / INERTIA[2]],
    );

    force.time = Some(LoadTime::Named(NamedTime::Ramp));
    let runs = halved_twice(&scene(vec![force]))?;
    let ways: Vec<[f64; 3]> = runs.iter().map(|run| last_position(run).into()).collect();
    let exact = FORCE.map(|f| f * LOADED * LOADED / (6.0 * MASS));
    check_second_order(checks, "way under a ramp to the end", [&ways[0], &ways[1], &ways[2]], &exact);
    Ok(())
}

fn last_position(solution: &Solution) -> Vector3<f64> {
    solution.rows.last().map_or(Vector3::repeat(f64::NAN), |row| Vector3::from(row.probes[0].position))
}

fn speed(solution: &Solution, mass: f64) -> f64 {
    solution.energies.last().map_or(f64::NAN, |energies| (2.0 * energies.kinetic / mass).sqrt())
}

/// The angle about e_z, continuous along the rows.
fn turn_about_z(solution: &Solution) -> f64 {
    let mut angle = 0.0_f64;
    for row in &solution.rows {
        let [w, .., z] = row.probes[0].quaternion;
        let now = 2.0 * z.atan2(w);
        angle = now + (2.0 * std::f64::consts::TAU) * ((angle - now) / (2.0 * std::f64::consts::TAU)).round();
    }
    angle
}

/// A force that turns with a body at a constant rate: v = (F/mω)(sin ωt, 1 − cos ωt), r by another integral.
fn turning_force(checks: &mut Checks) -> Outcome {
    const RATE: f64 = 4.0;
    const END: f64 = 1.5;
    let push = Load { basis: Basis::Body, ..load(LoadKind::Force, "bob", [3.0, 0.0, 0.0]) };
    let scene = Scene {
        body: vec![Body { angular_velocity: [0.0, 0.0, RATE], ..body("bob", MASS, INERTIA, [0.0; 3]) }],
        load: vec![push],
        probe: vec![probe("bob", "bob")],
        dynamics: Some(Dynamics::new(END, 0.01)),
        ..Scene::default()
    };
    let runs = halved_twice(&scene)?;
    let ways: Vec<[f64; 3]> = runs.iter().map(|run| last_position(run).into()).collect();
    let (scale, phase) = (3.0 / (MASS * RATE * RATE), RATE * END);
    let exact = [scale * (1.0 - phase.cos()), scale * (phase - phase.sin()), 0.0];
    check_second_order(checks, "way", [&ways[0], &ways[1], &ways[2]], &exact);
    let spin = 0.5 * INERTIA[2] * RATE * RATE;
    let errors = [0, 1, 2].map(|k| {
        let kinetic = runs[k].energies.last().map_or(f64::NAN, |energies| energies.kinetic);
        (kinetic - spin - MASS * (3.0 / (MASS * RATE)).powi(2) * (1.0 - phase.cos())).abs()
    });
    check_vanishes(checks, "kinetic energy", errors);
    Ok(())
}
