//! Bodies that nothing holds: Euler's closed forms, the flips of a nut, and ten thousand revolutions.
//!
//! The references are Jacobi's elliptic functions and, for the symmetric body, two rotations one after the other: good
//! to all digits. The method conserves neither energy nor angular momentum by itself.

use cosserat::scene::{Body, Dynamics, Probe, Scene};
use cosserat::solution::Solution;
use nalgebra::{Vector3, Vector4};

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::probe;
use crate::placement::placements;
use crate::references::Table;
use crate::steps::{
    body, check_second_order, check_vanishes, energy_error, halved_twice, quaternion_at, rotation, run,
    with_step,
};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("free_bodies::dzhanibekov", "Jacobi's closed form", dzhanibekov).reads(&[NUT_FILE]),
        Case::new("free_bodies::flips", "zeros of sn", flips).reads(&[FLIPS_FILE]),
        Case::new("free_bodies::symmetric", "closed form", symmetric).reads(&[TOP_FILE]),
        Case::new("free_bodies::ten_thousand_turns", "conservation laws", ten_thousand_turns),
        Case::new("free_bodies::straight_on", "Newton's first law", straight_on),
    ]
}

const NUT: [f64; 3] = [1.0, 2.0, 3.0];
const NUT_TURNS: [f64; 3] = [0.01, 5.0, 0.02];

const TOP: [f64; 3] = [2.0, 2.0, 3.0];
const TOP_TURNS: [f64; 3] = [1.0, 0.0, 10.0];

/// Jacobi's closed form and a Taylor series, the zeros of sn, and the closed form of the symmetric body.
const NUT_FILE: &str = "rigid/free_asymmetric_body.csv";
const FLIPS_FILE: &str = "rigid/free_asymmetric_body_flips.csv";
const TOP_FILE: &str = "rigid/free_symmetric_body.csv";

fn scene(inertia: [f64; 3], turns: [f64; 3], end_time: f64, step: f64, spectral_radius: f64) -> Scene {
    Scene {
        body: vec![Body { angular_velocity: turns, ..body("nut", 1.0, inertia, [0.0; 3]) }],
        probe: vec![probe("nut", "nut")],
        dynamics: Some(Dynamics { spectral_radius, ..Dynamics::new(end_time, step) }),
        ..Scene::default()
    }
}

/// Spectral radii: without joints 1 is allowed, too.
const RADII: [f64; 2] = [0.8, 1.0];

/// Quaternions of a file at some times, and a picture of it all.
fn check_table(checks: &mut Checks, scene: &Scene, file: &str, times: &[f64], what: &str) -> Outcome {
    let table = checks.reference(file)?;
    let mut exact = Vec::new();
    for &time in times {
        let row = table.row(&[("t", &format!("{time:?}"))])?;
        exact.push((time, row.numbers::<4>("qw qx qy qz")?));
    }
    for placement in placements(1.0) {
        let runs = halved_twice(&placement.apply(scene))?;
        for &(time, exact) in &exact {
            let mut q = Vec::new();
            for run in &runs {
                q.push(quaternion_at(run, time, 0, &placement, exact)?);
            }
            let label = format!("rotation at {time} s, {what}, {}", placement.name);
            check_second_order(checks, &label, [&q[0], &q[1], &q[2]], &exact);
        }
        if placement.name == "as is" {
            axis(checks, &runs[2], &table, what)?;
        }
    }
    Ok(())
}

/// Where the body's third axis points, along e_z: 1 − 2 (q_x² + q_y²).
fn axis(checks: &mut Checks, run: &Solution, table: &Table, what: &str) -> Outcome {
    let along = |[_, x, y, _]: [f64; 4]| 1.0 - 2.0 * (x * x + y * y);
    let end = run.rows.last().ok_or("no rows")?.parameter;
    let every = run.rows.len() / 250 + 1;
    let mut reference = Vec::new();
    for row in table.rows() {
        let t = row.number("t")?;
        if t <= end {
            reference.push([t, along(row.numbers("qw qx qy qz")?)]);
        }
    }
    checks.trajectory(Trajectory {
        title: format!("Free body, {what}: third axis along e_z"),
        axes: ["t [s]", "cosine"],
        measured: run
            .rows
            .iter()
            .step_by(every)
            .map(|row| [row.parameter, along(row.probes[0].quaternion)])
            .collect(),
        source: "closed form",
        reference,
    });
    Ok(())
}

/// Θ ω in space about row `index`: A from the rows, ω by differences of order 8.
fn angular_momentum(solution: &Solution, inertia: [f64; 3], index: usize) -> Vector3<f64> {
    const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let quaternion = |row: usize| Vector4::from(solution.rows[row].probes[0].quaternion);
    let step = solution.rows[index + 1].parameter - solution.rows[index].parameter;
    let difference = |k: usize| (quaternion(index + k) - quaternion(index - k)) * WEIGHTS[k - 1];
    let rate = (1..=4).map(difference).sum::<Vector4<f64>>() / step;
    let q = quaternion(index);
    let (p, w) = (Vector3::new(q[1], q[2], q[3]), Vector3::new(rate[1], rate[2], rate[3]));
    // ω = 2 Im(q̄ ∘ q̇).
    let spin = 2.0 * (q[0] * w - rate[0] * p - p.cross(&w));
    rotation(q.into()) * Vector3::from(inertia).component_mul(&spin)
}

/// Largest departure of the angular momentum from its start, relative.
fn momentum_error(solution: &Solution, inertia: [f64; 3], turns: [f64; 3], every: usize) -> f64 {
    let start = Vector3::from(inertia).component_mul(&Vector3::from(turns));
    let last = solution.rows.len() - 5;
    let indices = (4..last).step_by(every).chain([last]);
    indices.fold(0.0, |worst: f64, index| {
        worst.max((angular_momentum(solution, inertia, index) - start).norm() / start.norm())
    })
}

fn dzhanibekov(checks: &mut Checks) -> Outcome {
    for radius in RADII {
        let what = format!("ρ∞ = {radius}");
        let scene = scene(NUT, NUT_TURNS, 5.0, 2e-3, radius);
        check_table(checks, &scene, NUT_FILE, &[1.0, 2.0, 3.0, 5.0], &what)?;
        let runs = halved_twice(&scene)?;
        let energy = [0, 1, 2].map(|k| energy_error(&runs[k]));
        check_vanishes(checks, &format!("energy, {what}"), energy);
        let momentum = [0, 1, 2].map(|k| momentum_error(&runs[k], NUT, NUT_TURNS, 1));
        check_vanishes(checks, &format!("angular momentum, {what}"), momentum);
        let iterations = runs[0].statistics.most_iterations as f64;
        checks.below(
            Kind::Pinned,
            "iterations in a step",
            iterations,
            3.0,
            "quadratic convergence from 1e-2 of a step",
        );
    }
    Ok(())
}

/// Times at which L·(A e_y) = I₂ ω₂ changes its sign, by a cubic through four rows.
fn flip_times(solution: &Solution) -> Vec<f64> {
    let momentum = Vector3::from(NUT).component_mul(&Vector3::from(NUT_TURNS));
    let along = |row: usize| {
        let axis = rotation(solution.rows[row].probes[0].quaternion) * Vector3::y();
        momentum.dot(&axis)
    };
    let mut times = Vec::new();
    for row in 1..solution.rows.len() - 2 {
        if along(row) * along(row + 1) >= 0.0 {
            continue;
        }
        let values = [row - 1, row, row + 1, row + 2].map(along);
        // Lagrange's cubic at −1, 0, 1, 2, its root in [0, 1] by bisection.
        let cubic = |s: f64| {
            let [a, b, c, d] = values;
            -a * s * (s - 1.0) * (s - 2.0) / 6.0 + b * (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0
                - c * (s + 1.0) * s * (s - 2.0) / 2.0
                + d * (s + 1.0) * s * (s - 1.0) / 6.0
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if cubic(low) * cubic(middle) <= 0.0 { high = middle } else { low = middle }
        }
        let step = solution.rows[row + 1].parameter - solution.rows[row].parameter;
        times.push(solution.rows[row].parameter + low * step);
    }
    times
}

fn flips(checks: &mut Checks) -> Outcome {
    let table = checks.reference(FLIPS_FILE)?;
    let exact = table.rows().map(|row| row.number("t")).collect::<Result<Vec<f64>, _>>()?;
    let runs = halved_twice(&scene(NUT, NUT_TURNS, 22.0, 2e-3, 1.0))?;
    let times: [Vec<f64>; 3] = [0, 1, 2].map(|k| flip_times(&runs[k]));
    for times in &times {
        let reason = "at 2.32 s and every 4.44 s after, the last of them 1.9 s before the end";
        checks.absolute(
            Kind::ClosedForm,
            "number of flips in 22 s",
            (times.len() as f64, exact.len() as f64),
            0.0,
            reason,
        );
    }
    for (k, (name, exact)) in ["first", "second"].into_iter().zip(exact).enumerate() {
        let found = [0, 1, 2].map(|run| [times[run].get(k).copied().unwrap_or(f64::NAN)]);
        check_second_order(checks, &format!("{name} flip [s]"), [&found[0], &found[1], &found[2]], &[exact]);
    }
    Ok(())
}

fn symmetric(checks: &mut Checks) -> Outcome {
    for radius in RADII {
        let what = format!("symmetric body, ρ∞ = {radius}");
        let scene = scene(TOP, TOP_TURNS, 5.0, 4e-3, radius);
        check_table(checks, &scene, TOP_FILE, &[1.0, 2.0, 5.0], &what)?;
        let runs = halved_twice(&scene)?;
        let momentum = [0, 1, 2].map(|k| momentum_error(&runs[k], TOP, TOP_TURNS, 1));
        check_vanishes(checks, &format!("angular momentum, {what}"), momentum);
    }
    Ok(())
}

/// A body that turns about no axis of its own, ten thousand times at 10 rad/s. With ρ∞ = 1 nothing is damped: what
/// energy and angular momentum do is the method's error, which does not grow with the number of turns.
fn ten_thousand_turns(checks: &mut Checks) -> Outcome {
    const INERTIA: [f64; 3] = [2.0, 2.5, 3.0];
    const TURNS: [f64; 3] = [1.0, 1.5, 10.0];
    /// A whole number of steps, a little more than 2π · 10⁴/10.
    const END: f64 = 6284.0;
    const STEP: f64 = 0.04;
    let mut scene = scene(INERTIA, TURNS, END, STEP, 1.0);
    let tip = |name: &str, offset| Probe { offset: Some(offset), ..probe(name, "nut") };
    scene.probe.extend([tip("x", [1.0, 0.0, 0.0]), tip("y", [0.0, 1.0, 0.0]), tip("z", [0.0, 0.0, 1.0])]);
    let long = run(&scene)?;
    let mut worst = 0.0_f64;
    for row in &long.rows {
        let column = |k: usize| Vector3::from(row.probes[k].position);
        let a = nalgebra::Matrix3::from_columns(&[column(1), column(2), column(3)]);
        worst = worst.max((a.tr_mul(&a) - nalgebra::Matrix3::identity()).amax());
    }
    let reason = "a matrix of unit columns to a few roundings of 1, whatever happened before";
    checks.below(Kind::Invariant, "AᵀA − 1 in all rows", worst, 1e-14, reason);
    let still =
        long.rows.iter().fold(0.0_f64, |worst, row| worst.max(Vector3::from(row.probes[0].position).amax()));
    checks.below(
        Kind::Invariant,
        "way of the centre of mass",
        still,
        0.0,
        "no force acts, and it starts at rest",
    );

    let early = |solution: &Solution| {
        let mut start = solution.clone();
        start.rows.truncate(solution.rows.len() / 100);
        start.energies.truncate(solution.energies.len() / 100);
        start
    };
    scene.probe.truncate(1);
    let halved = run(&with_step(&scene, 0.5 * STEP))?;
    let start = halved.energies[0].total();
    for (name, error) in [
        ("kinetic energy", [&long, &halved].map(|run| energy_error(run) / start)),
        ("angular momentum", [&long, &halved].map(|run| momentum_error(run, INERTIA, TURNS, 97))),
    ] {
        let order = (error[0] / error[1]).log2();
        let label =
            format!("{name}: order of the error over all turns, {:.3e} and {:.3e}", error[0], error[1]);
        let reason = "constant steps and order 2: h² or better, 0.15 for the next term";
        checks.above(Kind::Order, label, order, 1.85, reason);
    }
    let first = early(&halved);
    let reason = "a symmetric method (ρ∞ = 1) on a periodic motion has no secular drift: the hundredfold time \
                  must not double it";
    let growth = energy_error(&halved) / energy_error(&first);
    checks.below(Kind::Invariant, "energy error after 10000 turns over that after 100", growth, 2.0, reason);
    let of = |solution: &Solution| momentum_error(solution, INERTIA, TURNS, 97);
    let growth = of(&halved) / of(&first);
    checks.below(
        Kind::Invariant,
        "momentum error after 10000 turns over that after 100",
        growth,
        2.0,
        reason,
    );
    Ok(())
}

/// The centre of mass moves on straight, whatever the body's rotation does.
fn straight_on(checks: &mut Checks) -> Outcome {
    const VELOCITY: [f64; 3] = [0.3, -1.7, 0.9];
    const START: [f64; 3] = [2.0, 0.5, -1.0];
    for radius in [0.0, 0.8, 1.0] {
        let mut scene = scene(NUT, NUT_TURNS, 20.0, 2e-3, radius);
        scene.body[0].velocity = VELOCITY;
        scene.body[0].position = START;
        for placement in placements(3.0) {
            let solution = run(&placement.apply(&scene))?;
            let mut worst = 0.0_f64;
            for row in &solution.rows {
                let position = placement.undo_position(Vector3::from(row.probes[0].position));
                let exact = Vector3::from(START) + Vector3::from(VELOCITY) * row.parameter;
                worst = worst.max((position - exact).amax());
            }
            // 10⁴ additions at up to 35 m.
            let bound = 1e4 * f64::EPSILON * 35.0;
            let label = format!("centre of mass off the line, ρ∞ = {radius}, {}", placement.name);
            checks.below(
                Kind::ClosedForm,
                label,
                worst,
                bound,
                "one rounding a step of a coordinate of up to 35 m",
            );
        }
    }
    Ok(())
}
