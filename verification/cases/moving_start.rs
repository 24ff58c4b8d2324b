//! A pendulum that is given a push: what the joint bears in the very first steps. And a fall from rest.
//!
//! In one plane the angle φ from the hanging position tells everything: with the inertia I about the hinge,
//! I ω² = I ω₀² + 2 m g l (cos φ − cos φ₀), I ω̇ = −m g l sin φ, and the hinge bears m (a_S − g). Where the pendulum is
//! comes from the run itself, so that the closed form shows the error of the force alone.

use cosserat::scene::{Dynamics, JointKind, Scene};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::probe;
use crate::motion::follow;
use crate::placement::{Placement, placements};
use crate::steps::{body, force_at, halved_twice, joint, position_at};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("moving_start::reactions", "equation of a plane pendulum; energy", reactions),
        Case::new("moving_start::fall", "free fall: gravity brings m g²t²/2", fall),
        Case::new(
            "moving_start::not_quite",
            "an impulse at the hinge keeps the moment of momentum",
            not_quite,
        ),
    ]
}

const LENGTH: f64 = 0.5;
const MASS: f64 = 2.0;
/// About its centre of mass, normal to the plane [kg m²].
const INERTIA: f64 = 0.05;
/// Angle and rate at the start.
const START: (f64, f64) = (0.7, 8.0);
const GRAVITY: f64 = 9.81;
const STEP: f64 = 2e-3;
/// Steps that are looked at: wrong multipliers fade by about the spectral radius a step.
const STEPS: usize = 40;

fn scene() -> Scene {
    let (angle, rate) = START;
    let position = [LENGTH * angle.sin(), 0.0, -LENGTH * angle.cos()];
    let mut bob = body("bob", MASS, [0.03, INERTIA, 0.04], position);
    // φ grows about −e_y.
    bob.angular_velocity = [0.0, -rate, 0.0];
    bob.velocity = [LENGTH * rate * angle.cos(), 0.0, LENGTH * rate * angle.sin()];
    Scene {
        gravity: Some([0.0, 0.0, -GRAVITY]),
        body: vec![bob],
        joint: vec![joint("hinge", JointKind::Spherical, ["ground", "bob"], [0.0; 3])],
        probe: vec![probe("bob", "bob")],
        dynamics: Some(Dynamics::new(STEPS as f64 * STEP, STEP)),
        ..Scene::default()
    }
}

/// The force on the bob where its centre of mass is.
fn force(position: Vector3<f64>) -> Vector3<f64> {
    let down = position / position.norm();
    let (sine, cosine) = (down.x, -down.z);
    let inertia = INERTIA + MASS * LENGTH * LENGTH;
    let squared = START.1.powi(2) + 2.0 * MASS * GRAVITY * LENGTH / inertia * (cosine - START.0.cos());
    let change = -MASS * GRAVITY * LENGTH / inertia * sine;
    let across = Vector3::new(cosine, 0.0, sine);
    (across * change * LENGTH - down * squared * LENGTH) * MASS + Vector3::new(0.0, 0.0, MASS * GRAVITY)
}

fn reactions(checks: &mut Checks) -> Outcome {
    for placement in placements(LENGTH) {
        let runs = halved_twice(&placement.apply(&scene()))?;
        let mut errors = Vec::new();
        for (run, part) in runs.iter().zip([1.0, 0.5, 0.25]) {
            let mut worst = 0.0_f64;
            for index in 0..=STEPS {
                let time = index as f64 * part * STEP;
                let exact = force(position_at(run, time, 0, &placement)?);
                worst = worst.max((force_at(run, time, 0, &placement)? - exact).norm() / exact.norm());
            }
            errors.push(worst);
        }
        first_order(checks, &placement, &errors);
    }
    Ok(())
}

fn first_order(checks: &mut Checks, placement: &Placement, errors: &[f64]) {
    let name = format!("force of the hinge in the first {STEPS} steps, {}", placement.name);
    checks.below(
        Kind::ClosedForm,
        format!("{name}: largest error, in parts of the force"),
        errors[0],
        START.1 * STEP,
        "first order: what the force changes by in one step is ω h of it, with ω up to 8 rad/s",
    );
    checks.order(name, &[1, 2, 4], errors, (1.0, 0.15), "the first multipliers are of first order");
}

/// All energy of a fall comes from gravity: none of it is a surplus that is worth a warning.
fn fall(checks: &mut Checks) -> Outcome {
    let scene = Scene {
        gravity: Some([0.0, 0.0, -GRAVITY]),
        body: vec![body("stone", MASS, [0.03, INERTIA, 0.04], [0.0; 3])],
        dynamics: Some(Dynamics::new(0.2, STEP)),
        ..Scene::default()
    };
    for placement in placements(LENGTH) {
        let run = follow(&placement.apply(&scene))?;
        let kinetic = run.energies.last().ok_or("no energies")?.kinetic;
        checks.relative(
            Kind::ClosedForm,
            format!("kinetic energy [J], {}", placement.name),
            (kinetic, 0.5 * MASS * (GRAVITY * 0.2).powi(2)),
            1e-12,
            "constant acceleration is integrated exactly: rounding of 100 steps",
        );
        checks.absolute(
            Kind::Invariant,
            format!("warnings, {}", placement.name),
            (run.warnings.len() as f64, 0.0),
            0.0,
            "nothing appears that no load has brought",
        );
    }
    Ok(())
}

/// Velocities that a hinge cannot have, by less than what is refused, as digits of a file may leave them: the hinge's
/// impulse takes away what is along the arm, and of a speed δ across it what does not turn the body, so that
/// ω = ω₀ + m l δ/(Θ + m l²). The force at the start is m l ω².
fn not_quite(checks: &mut Checks) -> Outcome {
    let (arm, rate, along, across): (f64, f64, f64, f64) = (0.8, 3.0, 7e-7, 1.3e-6);
    let bodies: [(f64, f64, [f64; 3], [f64; 3]); 2] =
        [(2.0, 0.4, [0.0; 3], [1.0, 0.0, 0.0]), (3.0, 0.7, [5.0, 1.0, -2.0], [0.0, 0.6, -0.8])];
    let mut scene = Scene { dynamics: Some(Dynamics::new(STEP, STEP)), ..Scene::default() };
    for (name, (mass, inertia, pivot, direction)) in ["a", "b"].into_iter().zip(bodies) {
        let (pivot, direction) = (Vector3::from(pivot), Vector3::from(direction));
        // A principal axis across the arm.
        let axis = if name == "a" { Vector3::z() } else { Vector3::x() };
        let mut bob = body(name, mass, [inertia; 3], (pivot + arm * direction).into());
        bob.angular_velocity = (rate * axis).into();
        let turn = axis.cross(&direction);
        bob.velocity = ((arm * rate + across) * turn + along * direction).into();
        scene.body.push(bob);
        scene.joint.push(joint(
            &format!("hinge {name}"),
            JointKind::Spherical,
            ["ground", name],
            pivot.into(),
        ));
    }
    for placement in placements(arm) {
        let run = follow(&placement.apply(&scene))?;
        let mut kinetic = 0.0;
        for (index, (mass, inertia, _, direction)) in bodies.into_iter().enumerate() {
            let spin: f64 = rate + mass * arm * across / (inertia + mass * arm * arm);
            let exact = -mass * arm * spin * spin * Vector3::from(direction);
            let found = force_at(&run, 0.0, index, &placement)?;
            checks.vector(
                Kind::ClosedForm,
                format!("force of hinge {}, {}", index + 1, placement.name),
                (found.into(), exact.into()),
                1e-11 * exact.norm(),
                "two linear systems: rounding; the speed across is worth 1e-6",
            );
            kinetic += 0.5 * (inertia + mass * arm * arm) * spin * spin;
        }
        checks.relative(
            Kind::ClosedForm,
            format!("kinetic energy, {}", placement.name),
            (run.energies.first().ok_or("no energies")?.kinetic, kinetic),
            1e-13,
            "a linear system and six squares: rounding; the speeds that are taken away are worth 1e-6",
        );
    }
    Ok(())
}
