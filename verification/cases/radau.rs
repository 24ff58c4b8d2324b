//! Three-stage Radau IIA, the integrator for reference answers: its own order, in everything that a step returns.

use std::error::Error;

use cosserat::scene::{Method, Scene};
use cosserat::solution::Solution;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::{body_chain, heavy_top, spun_ring};
use crate::placement::placements;
use crate::steps::{distance, energy_error, force_at, position_at, quaternion_at, run, violation, with_step};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("radau::heavy_top", "Euler's equations by Taylor series; order 5 of the method", top)
            .reads(&[heavy_top::FILE]),
        Case::new("radau::chain", "Kane's equations in seven coordinates; order 5 of the method", chain)
            .reads(body_chain::FILES),
        Case::new("radau::ring", "order 5 of the method; generalized-alpha", ring),
    ]
}

/// The scene with this method up to `end`, by `steps` steps.
fn runs<const N: usize>(scene: &Scene, end: f64, steps: [usize; N]) -> Result<Vec<Solution>, Box<dyn Error>> {
    let mut scene = scene.clone();
    if let Some(dynamics) = &mut scene.dynamics {
        dynamics.method = Method::Radau;
        dynamics.end_time = end;
    }
    steps.iter().map(|count| run(&with_step(&scene, end / *count as f64))).collect()
}

/// Asymptotically 5; with ten to twenty steps a turn the next term of the error is a few per cent.
const ORDER: (f64, f64) = (5.0, 0.3);
const ORDER_REASON: &str = "2s − 1 with s = 3 stages, joints at velocity level and closed after the step";

fn top(checks: &mut Checks) -> Outcome {
    let steps = [500, 1000, 2000];
    let (time, position, quaternion, force) = heavy_top::exact(checks, 1.0)?;
    for placement in placements(1.0) {
        let runs = runs(&placement.apply(&heavy_top::scene(["ground", "top"])), time, steps)?;
        let (mut x, mut q, mut f, mut energy) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for run in &runs {
            x.push(distance(position_at(run, time, 0, &placement)?.as_slice(), &position));
            q.push(distance(&quaternion_at(run, time, 0, &placement, quaternion)?, &quaternion));
            f.push(distance(force_at(run, time, 0, &placement)?.as_slice(), &force));
            energy.push(energy_error(run));
            checks.below(
                Kind::Invariant,
                format!("joint, {}", placement.name),
                violation(run),
                1e-14,
                "closed after every step to the rounding of positions of order 1 to 10",
            );
        }
        let errors = [("centre", &x), ("rotation", &q), ("force", &f), ("energy", &energy)];
        for (what, errors) in errors {
            checks.order(format!("{what}, {}", placement.name), &steps, errors, ORDER, ORDER_REASON);
        }
        checks.below(
            Kind::Order,
            format!("centre with 2000 steps, {}", placement.name),
            x[2],
            20.0 * 150.0 * (0.5 * 150.0 / 2000.0_f64).powi(5) / 7200.0,
            "a constant spin is off by (ωh/2)⁵/7200 a radian, here over 150 rad; twenty times for the nutation",
        );
    }
    Ok(())
}

fn chain(checks: &mut Checks) -> Outcome {
    let steps = [50, 100, 200];
    let (time, bodies, force) = &body_chain::exact(checks, true, 1.0)?;
    let placement = &placements(1.0)[0];
    let runs = runs(&body_chain::scene(true, 1e-2), *time, steps)?;
    for (index, (position, quaternion)) in bodies.iter().enumerate() {
        let (mut x, mut q) = (Vec::new(), Vec::new());
        for run in &runs {
            x.push(distance(position_at(run, *time, index, placement)?.as_slice(), position));
            q.push(distance(&quaternion_at(run, *time, index, placement, *quaternion)?, quaternion));
        }
        checks.order(format!("position of body {}", index + 1), &steps, &x, ORDER, ORDER_REASON);
        checks.order(format!("rotation of body {}", index + 1), &steps, &q, ORDER, ORDER_REASON);
    }
    let mut f = Vec::new();
    for run in &runs {
        f.push(distance(force_at(run, *time, 0, placement)?.as_slice(), force));
        checks.below(
            Kind::Invariant,
            "joints",
            violation(run),
            1e-14,
            "closed after every step to the rounding of positions of order 1",
        );
    }
    checks.order("force of the ground", &steps, &f, ORDER, ORDER_REASON);
    let energy: Vec<f64> = runs.iter().map(energy_error).collect();
    checks.order("energy", &steps, &energy, ORDER, ORDER_REASON);
    Ok(())
}

/// A flexible rod in large motion on one mesh: order 5 against its own finest run, and the limit of the other method.
fn ring(checks: &mut Checks) -> Outcome {
    let (end, steps) = (1.0, [25, 50, 100, 400]);
    let scene = spun_ring::scene(end / 400.0, 3, 4);
    let runs = runs(&scene, end, steps)?;
    let last = |solution: &Solution| -> Result<[f64; 3], Box<dyn Error>> {
        let row = solution.rows.last().ok_or("no rows")?;
        Ok(row.probes[0].position)
    };
    let finest = last(&runs[3])?;
    let mut errors = Vec::new();
    for run in &runs[..3] {
        errors.push(distance(&last(run)?, &finest));
    }
    checks.order("place of a point", &steps[..3], &errors, ORDER, ORDER_REASON);

    let mut other = scene;
    if let Some(dynamics) = &mut other.dynamics {
        dynamics.end_time = end;
    }
    let mut alpha = Vec::new();
    for count in [200.0, 400.0, 800.0] {
        alpha.push(last(&run(&with_step(&other, end / count))?)?);
    }
    let extrapolated = |k: usize| -> [f64; 3] {
        std::array::from_fn(|i| alpha[k + 1][i] + (alpha[k + 1][i] - alpha[k][i]) / 3.0)
    };
    checks.below(
        Kind::CrossCode,
        "limit of generalized-alpha",
        distance(&extrapolated(1), &finest),
        distance(&extrapolated(1), &extrapolated(0)),
        "extrapolated values improve faster than they still change: by 2³ or more a halving",
    );
    Ok(())
}
