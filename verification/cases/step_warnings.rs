//! Steps too long and steps too short: energy that no load has brought, joint forces of rounding noise; both against
//! their thresholds, on motions whose energies and forces are known in closed form.

use cosserat::scene::{Dynamics, JointKind, Load, LoadKind, LoadTime, Method, Rod, Scene, Section};
use cosserat::solution::{Solution, SolveError, SolveFailure, StopReason};
use cosserat::{Model, dynamics};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::load;
use crate::pieces::line;
use crate::steps::{body, joint};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("step_warnings::surplus", "∫ F v dt against its trapezoids", surplus),
        Case::new("step_warnings::rounding", "the energy of rounding, 8 ε of a size", rounding),
        Case::new("step_warnings::joint_noise", "ε m L/h² against the weight", joint_noise),
    ]
}

const MASS: f64 = 2.0;
const STEP: f64 = 0.1;

/// A free body under a force along e_x that varies in time, `rods` beside it. Radau's method is exact for it.
fn pushed(force: f64, course: Vec<[f64; 2]>, velocity: [f64; 3], end: f64) -> Scene {
    let push =
        Load { time: Some(LoadTime::Table(course)), ..load(LoadKind::Force, "bob", [force, 0.0, 0.0]) };
    let mut bob = body("bob", MASS, [1.0, 1.5, 2.0], [0.0; 3]);
    bob.velocity = velocity;
    let options = Dynamics { method: Method::Radau, ..Dynamics::new(end, STEP) };
    Scene { body: vec![bob], load: vec![push], dynamics: Some(options), ..Scene::default() }
}

fn attempt(scene: &Scene) -> Result<Result<Solution, Box<SolveFailure>>, Box<dyn std::error::Error>> {
    let options = scene.dynamics.clone().ok_or("no [dynamics]")?;
    Ok(dynamics::solve(&Model::new(scene)?, &options, &mut |_, _| ()))
}

/// What a run says of its energy: 0 nothing, 1 a warning with these words, 2 that it stops.
fn verdict(outcome: &Result<Solution, Box<SolveFailure>>, words: &[String]) -> f64 {
    let told = |solution: &Solution| {
        let all = |text: &String| words.iter().all(|word| text.contains(word));
        solution.warnings.iter().any(|text| text.contains("too long") && all(text))
    };
    match outcome {
        Ok(solution) if solution.warnings.is_empty() => 0.0,
        Ok(solution) if told(solution) => 1.0,
        Err(failure) if told(&failure.partial) => match failure.error {
            SolveError::Step { reason: StopReason::Energy, .. } => 2.0,
            _ => f64::NAN,
        },
        _ => f64::NAN,
    }
}

/// A surplus and its turnover as the warning prints them.
fn words(surplus: f64, turnover: f64) -> [String; 2] {
    [format!("by up to {surplus:.1e} J"), format!("where {turnover:.1e} J had gone")]
}

const THRESHOLD: &str = "a tenth of what went round is worth a warning, ten times it the end; 1e-6 beside the threshold, where all \
     sums are good to 1e-13";

/// With a force that is linear within a step, F_k f_k at its ends, kinetic energy gains ½ m (v₁² − v₀²),
/// v₁ − v₀ = F h (f₀ + f₁)/2m; the trapezoid sees ½ h F (f₀ v₀ + f₁ v₁), and F² h² (f₀² − f₁²)/8m of it is missing.
/// Energy of a motion across the force is in the turnover only; it is chosen so that the largest part is the threshold.
fn surplus(checks: &mut Checks) -> Outcome {
    const FORCE: f64 = 30.0;
    let courses: [(&str, &[f64], f64, f64); 3] = [
        ("one step", &[1.0, 0.0], 0.0, STEP),
        ("there and back", &[1.0, -0.6, 0.4, -0.1, 0.5], 0.07, 4.0 * STEP),
        ("the last step is half a step", &[0.9, 0.5, -0.2, 0.1], -0.1, 2.5 * STEP),
    ];
    for (name, factors, start, end) in courses {
        let time = |k: usize| (k as f64 * STEP).min(end);
        let course: Vec<[f64; 2]> = factors.iter().enumerate().map(|(k, f)| [time(k), *f]).collect();
        let along = 0.5 * MASS * start * start;
        let (mut speed, mut missing, mut turnover) = (start, 0.0, along);
        // (surplus, what went round but for the motion across) after every step.
        let mut steps = Vec::new();
        for k in 1..factors.len() {
            let (h, [f, g]) = (time(k) - time(k - 1), [factors[k - 1], factors[k]]);
            let next = speed + FORCE * h * (f + g) / (2.0 * MASS);
            missing += (FORCE * h).powi(2) * (f * f - g * g) / (8.0 * MASS);
            turnover += 0.5 * h * FORCE * ((f * speed).abs() + (g * next).abs());
            speed = next;
            steps.push((missing, turnover));
        }
        for (limit, sides) in [(0.1, [0.0, 1.0]), (10.0, [1.0, 2.0])] {
            let across = steps.iter().map(|(s, t)| s / limit - t).fold(f64::NEG_INFINITY, f64::max);
            if across <= 0.0 {
                continue;
            }
            for (factor, expected) in [(1.0 + 1e-6, sides[0]), (1.0 - 1e-6, sides[1])] {
                let across = across * factor;
                let (s, t) = steps
                    .iter()
                    .map(|(s, t)| (*s, t + across))
                    .max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))
                    .ok_or("no steps")?;
                let velocity = [start, (2.0 * across / MASS).sqrt(), 0.0];
                let outcome = attempt(&pushed(FORCE, course.clone(), velocity, end))?;
                let found = verdict(&outcome, &words(s, t));
                let label = format!("{name}: {factor} times what makes the surplus {limit} of the turnover");
                checks.absolute(Kind::ClosedForm, label, (found, expected), 0.0, THRESHOLD);
            }
        }
    }
    Ok(())
}

const LENGTH: f64 = 2.5;

/// A rod of three cubic elements.
fn resting(stiffness: f64, mass_per_length: f64) -> Rod {
    let section = Section::Custom {
        axial: 0.8 * stiffness,
        shear_y: stiffness,
        shear_z: 0.3 * stiffness,
        torsion: 1.1 * stiffness,
        bending_y: 2.3 * stiffness,
        bending_z: 3.1 * stiffness,
        mass_per_length: Some(mass_per_length),
        rotary_inertia: Some([0.02, 0.01, 0.01]),
    };
    Rod::new("rod", line(LENGTH), section, None, 3, 3)
}

/// What rests has a turnover of rounding: velocities of 8 ε r/h in a size r, strains of 8 ε L p²/J_e in a rod. A force
/// that falls to nothing within the only step brings F² h²/8m, of which the trapezoid sees nothing at all.
fn rounding(checks: &mut Checks) -> Outcome {
    let noise = 8.0 * f64::EPSILON;
    let moving = |mass: f64, size: f64| 0.5 * mass * (noise * size / STEP).powi(2);
    let rod = |stiffness: f64, mass: f64| {
        // J_e = L/3, p² = 9.
        let strain = noise * 3.0 * 9.0;
        let stiff = stiffness + 3.1 * stiffness / (LENGTH * LENGTH);
        0.5 * LENGTH * stiff * strain * strain + moving(mass * LENGTH, LENGTH)
    };
    let scenes: [(&str, Option<[f64; 2]>, f64, f64); 5] = [
        ("a body", None, 0.0, moving(MASS, 1.0)),
        ("a body with a lever", None, 4.0, moving(MASS, 4.0)),
        ("a body and a rod", Some([3.0, 0.8]), 0.0, moving(MASS, LENGTH) + rod(3.0, 0.8)),
        ("a body and a heavy rod", Some([2.0, 30.0]), 0.0, moving(MASS, LENGTH) + rod(2.0, 30.0)),
        ("a body with a lever and a stiff rod", Some([80.0, 1.0]), 3.0, moving(MASS, 3.0) + rod(80.0, 1.0)),
    ];
    for (name, beside, lever, floor) in scenes {
        for (limit, sides) in [(0.1, [0.0, 1.0]), (10.0, [1.0, 2.0])] {
            for (factor, expected) in [(1.0 - 1e-6, sides[0]), (1.0 + 1e-6, sides[1])] {
                let energy = factor * limit * floor;
                let force = (8.0 * MASS * energy).sqrt() / STEP;
                let mut scene = pushed(force, vec![[0.0, 1.0], [STEP, 0.0]], [0.0; 3], STEP);
                scene.rod = beside.map(|[stiffness, mass]| resting(stiffness, mass)).into_iter().collect();
                // Along the force: it turns nothing.
                scene.load[0].offset = (lever > 0.0).then_some([lever, 0.0, 0.0]);
                let found = verdict(&attempt(&scene)?, &words(energy, floor));
                let label = format!("{name}: {factor} times what makes the surplus {limit} of the floor");
                checks.absolute(Kind::ClosedForm, label, (found, expected), 0.0, THRESHOLD);
            }
        }
    }
    Ok(())
}

/// A weight hangs from a ball joint; its force is the weight, its noise ε m L/h².
fn joint_noise(checks: &mut Checks) -> Outcome {
    const ARM: f64 = 1.5;
    let gravity = Vector3::new(3.0, -4.0, -8.0);
    let scene = |weight: f64, rod: Option<f64>, method: Method, step: f64| {
        let mut scene = Scene {
            gravity: (weight > 0.0).then(|| (weight * gravity).into()),
            body: vec![
                body("bob", MASS, [1.0, 1.5, 2.0], (ARM * gravity.normalize()).into()),
                // In no joint: it says nothing about their forces.
                body("stone", 50.0 * MASS, [1.0, 1.5, 2.0], [9.0, 9.0, 9.0]),
            ],
            joint: vec![joint("pivot", JointKind::Spherical, ["ground", "bob"], [0.0; 3])],
            dynamics: Some(Dynamics { method, ..Dynamics::new(3.0 * step, step) }),
            ..Scene::default()
        };
        if let Some(length) = rod {
            let section = resting(1.0, 1.0).section;
            scene.rod = vec![Rod { gravity: false, ..Rod::new("rod", line(length), section, None, 1, 1) }];
        }
        scene
    };
    let warned = |scene: &Scene, part: &str| -> Result<f64, Box<dyn std::error::Error>> {
        let solution = attempt(scene)??;
        let words = ["so short", part];
        let told = |text: &String| words.iter().all(|word| text.contains(word));
        Ok(match solution.warnings.as_slice() {
            [] => 0.0,
            [text] if told(text) => 1.0,
            _ => f64::NAN,
        })
    };
    let reason = "a millionth is worth a warning; 1e-3 beside it, where forces are good to some 1e-6";
    for (name, rod, size) in
        [("alone", None, ARM), ("a shorter rod beside it", Some(0.5), ARM), ("a longer one", Some(4.0), 4.0)]
    {
        for (part, text, expected) in
            [(0.999e-6, "", 0.0), (1.001e-6, "about 1e-6 of", 1.0), (3e-6, "about 3e-6 of", 1.0)]
        {
            let step = (f64::EPSILON * size / (part * gravity.norm())).sqrt();
            let found = warned(&scene(1.0, rod, Method::GeneralizedAlpha, step), text)?;
            let label = format!("{name}: noise of {part} of the weight");
            checks.absolute(Kind::ClosedForm, label, (found, expected), 0.0, reason);
        }
    }
    let reason = "joints are imposed on velocities";
    let found = warned(&scene(1.0, None, Method::Radau, 1e-6), "")?;
    checks.absolute(Kind::Invariant, "Radau's method with steps of 1 µs", (found, 0.0), 0.0, reason);
    let reason = "a force of zero has no relative noise";
    let found = warned(&scene(0.0, None, Method::GeneralizedAlpha, 1e-6), "")?;
    checks.absolute(Kind::Invariant, "without weight, with steps of 1 µs", (found, 0.0), 0.0, reason);
    Ok(())
}
