//! The iteration of Radau's method: what its matrices, its starting values and its memory are good for shows in the work
//! alone; the answer is the same.

use std::error::Error;

use cosserat::scene::{Dynamics, Joint, JointKind, Load, LoadKind, LoadTime, Method, NamedTime, Rod, Scene};
use cosserat::solution::{SolveError, Statistics, StopReason};
use cosserat::{Model, dynamics};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::load;
use crate::pieces::{circle, line, young_poisson};
use crate::steps::{body, joint, run};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("radau_work::steady_spin", "matrices are exact where nothing changes", steady_spin),
        Case::new("radau_work::starting_values", "polynomials through three stages", starting_values),
        Case::new("radau_work::stiffness", "what is stiff turns with the rod", stiffness),
        Case::new("radau_work::renewed", "matrices are renewed after ten iterations", renewed),
        Case::new("radau_work::given_up", "a step is done in 64 parts at most", given_up),
    ]
}

fn work(scene: &Scene, steps: usize, step: f64) -> Result<Statistics, Box<dyn Error>> {
    let options = Dynamics { method: Method::Radau, ..Dynamics::new(steps as f64 * step, step) };
    Ok(run(&Scene { dynamics: Some(options), ..scene.clone() })?.statistics)
}

fn each(work: &Statistics) -> f64 {
    work.newton_iterations as f64 / work.increments as f64
}

fn check_factorizations(checks: &mut Checks, what: &str, work: &Statistics, each: usize) {
    let found = (work.factorizations as f64, (each * work.increments) as f64);
    let reason =
        "a step has a real and a complex matrix and that of its end, and one more to close its joints";
    checks.absolute(Kind::Invariant, format!("{what}: factorisations"), found, 0.0, reason);
    let reason = "no step is done in parts";
    checks.absolute(Kind::Invariant, format!("{what}: rejected"), (work.rejected as f64, 0.0), 0.0, reason);
}

/// A body that spins about a principal axis, all but steadily: gyroscopic moments are linear in what is left, their matrix
/// the same at every time. Two forces along the axis that cancel, one of them at a lever, are a stiffness against
/// tilting; it meets the angle as the stages' quaternions have it.
fn steady_spin(checks: &mut Checks) -> Outcome {
    const SPIN: f64 = 10.0;
    for axis in 0..3 {
        for (force, step) in [(0.0, 0.02), (100.0, 0.1), (-100.0, 0.1)] {
            let mut top = body("top", 2.0, [1.0, 1.6, 2.1], [0.0; 3]);
            top.angular_velocity = [0.7e-6, -1.1e-6, 0.9e-6];
            top.angular_velocity[axis] += SPIN;
            let along = |value: f64| std::array::from_fn(|k| if k == axis { value } else { 0.0 });
            let constant = Some(LoadTime::Named(NamedTime::Constant));
            let pull =
                |value: f64| Load { time: constant.clone(), ..load(LoadKind::Force, "top", along(value)) };
            let mut scene = Scene { body: vec![top], ..Scene::default() };
            if force != 0.0 {
                scene.load = vec![Load { offset: Some(along(0.7)), ..pull(force) }, pull(-force)];
            }
            let work = work(&scene, 10, step)?;
            let what = format!("about axis {}, {force} N", axis + 1);
            let (bound, reason) = if force == 0.0 {
                (
                    4.0,
                    "one solves it, the next are for the square of 1e-6 and to see that rounding is reached",
                )
            } else {
                (
                    8.0,
                    "sixteen digits, two or more an iteration: only the stages' quaternions are not what is linear",
                )
            };
            checks.below(Kind::Invariant, format!("{what}: iterations a step"), each(&work), bound, reason);
            check_factorizations(checks, &what, &work, 3);
        }
    }
    Ok(())
}

/// A body that tumbles, with ωh = 0.02: the first step starts from nothing, the others from parabolas continued, which are
/// off by three powers of ωh less.
fn starting_values(checks: &mut Checks) -> Outcome {
    let mut top = body("top", 2.0, [1.0, 1.6, 2.3], [0.0; 3]);
    top.angular_velocity = [6.0, 5.0, -7.0];
    let scene = Scene { body: vec![top], ..Scene::default() };
    let (one, all) = (work(&scene, 1, 2e-3)?, work(&scene, 11, 2e-3)?);
    let later = (all.newton_iterations - one.newton_iterations) as f64 / 10.0;
    checks.above(
        Kind::Invariant,
        "iterations that a step saves against the first",
        one.newton_iterations as f64 - later,
        1.0,
        "an iteration gains one power of ωh or two, so that at least one is saved",
    );
    check_factorizations(checks, "tumbling", &all, 3);
    Ok(())
}

/// A rod hinged to the ground swings down with a weight at its end, to which another one is linked.
fn swing(modulus: f64) -> Scene {
    let mut material = young_poisson(modulus, 0.5);
    material.density = Some(1100.0);
    let hinge = Joint {
        point: None,
        axis: Some([0.0, 1.0, 0.0]),
        ..joint("hinge", JointKind::Revolute, ["ground", "rod@0"], [0.0; 3])
    };
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        rod: vec![Rod::new("rod", line(1.0), circle(0.04), Some(material), 4, 2)],
        body: vec![
            body("bob", 1.0, [0.01; 3], [1.0, 0.0, 0.0]),
            body("tail", 0.5, [0.005; 3], [1.2, 0.0, 0.0]),
        ],
        joint: vec![
            hinge,
            joint("weld", JointKind::Rigid, ["rod@1", "bob"], [1.0, 0.0, 0.0]),
            joint("link", JointKind::Spherical, ["bob", "tail"], [1.1, 0.0, 0.0]),
        ],
        ..Scene::default()
    }
}

/// From rubber to steel; the frames in which the rod is stiff turn by up to a tenth of a radian within a step.
fn stiffness(checks: &mut Checks) -> Outcome {
    let moduli = [5e6, 5e8, 5e11];
    let mut iterations = Vec::new();
    for modulus in moduli {
        let work = work(&swing(modulus), 24, 0.02)?;
        check_factorizations(checks, &format!("E = {modulus:e}"), &work, 4);
        iterations.push(each(&work));
    }
    for k in 1..moduli.len() {
        checks.below(
            Kind::Invariant,
            format!("iterations a step for E = {:e} over those for {:e}", moduli[k], moduli[0]),
            iterations[k] / iterations[0],
            1.1,
            "what frozen matrices miss is forces that turn with the rod, which they are turned with, and bending, \
             which falls with stiffness; a tenth for chance",
        );
    }
    Ok(())
}

/// Steps in which the rod turns by half a radian: matrices of the start do not do for all of them.
fn renewed(checks: &mut Checks) -> Outcome {
    const STEPS: usize = 8;
    let work = work(&swing(5e8), STEPS, 0.1)?;
    let more = work.factorizations as f64 - 4.0 * STEPS as f64;
    let reason = "two matrices in place of two";
    checks.absolute(Kind::Invariant, "matrices beyond four a step, odd", (more % 2.0, 0.0), 0.0, reason);
    checks.above(Kind::Invariant, "matrices beyond four a step", more, 2.0, "ten iterations are not enough");
    let most = 2 * (work.newton_iterations / 11);
    let reason = "never before ten iterations with the old ones";
    checks.below(Kind::Invariant, "matrices beyond four a step at most", more, most as f64, reason);
    checks.absolute(Kind::Invariant, "rejected", (work.rejected as f64, 0.0), 0.0, "none is done in parts");
    Ok(())
}

/// One iteration finds no step of a body that tumbles by more than 1e-2 of a radian: halved six times, it is given up.
fn given_up(checks: &mut Checks) -> Outcome {
    let mut top = body("top", 2.0, [1.0, 1.6, 2.3], [0.0; 3]);
    top.angular_velocity = [60.0, 50.0, -70.0];
    let options = Dynamics { method: Method::Radau, max_iterations: 1, ..Dynamics::new(0.1, 0.01) };
    let scene = Scene { body: vec![top], dynamics: Some(options.clone()), ..Scene::default() };
    let Err(failure) = dynamics::solve(&Model::new(&scene)?, &options, &mut |_, _| ()) else {
        return Err("one iteration was enough".into());
    };
    let iterations = matches!(failure.error, SolveError::Step { reason: StopReason::Iterations, .. });
    let reason = "one is allowed";
    checks.absolute(
        Kind::Invariant,
        "stopped for its iterations",
        (f64::from(u8::from(iterations)), 1.0),
        0.0,
        reason,
    );
    let work = &failure.partial.statistics;
    checks.absolute(Kind::Invariant, "halvings", (work.rejected as f64, 6.0), 0.0, "64 = 2⁶");
    checks.absolute(Kind::Invariant, "steps done", (work.increments as f64, 0.0), 0.0, "the first fails");
    Ok(())
}
