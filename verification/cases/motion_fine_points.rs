//! What is easily overlooked in a method: the start of a spinning body, loads within a halved step, and shapes between
//! the nodes.

use cosserat::scene::{InterpolationKind, LoadKind, LoadTime, Method, Modes, Rod, Scene};
use nalgebra::{Matrix3, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies::{LENGTH, steel};
use crate::cases::heavy_top;
use crate::measure::{clamp, load, probe};
use crate::motion::vibrate;
use crate::pieces::{line, rectangle};
use crate::placement::placements;
use crate::steps::{force_at, position_at, run, with_step};

pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "motion_fine_points::first_reaction",
            "Euler's equations about the fixed point",
            first_reaction,
        ),
        Case::new("motion_fine_points::halved_steps", "the same motion by short steps", halved_steps),
        Case::new("motion_fine_points::se3_shapes", "closed form of a constant curvature", se3_shapes),
    ]
}

/// The top that also nods: I ω̇ = r × m g − ω × I ω about the fixed point, a = ω̇ × r + ω × (ω × r), f = m (a − g).
fn first_reaction(checks: &mut Checks) -> Outcome {
    let (mass, arm) = (15.0, Vector3::y());
    let turn = Vector3::new(3.0, 150.0, -4.61538);
    let gravity = Vector3::new(0.0, 0.0, -9.81);
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.234375 + mass, 0.46875, 0.234375 + mass));
    let moment = arm.cross(&(mass * gravity)) - turn.cross(&(inertia * turn));
    let rate: Vector3<f64> = inertia.try_inverse().ok_or("no inverse")? * moment;
    let of_velocity = turn.cross(&turn.cross(&arm));
    let force = mass * (rate.cross(&arm) + of_velocity - gravity);

    let mut scene = with_step(&heavy_top::scene(["ground", "top"]), 1e-3);
    scene.body[0].angular_velocity = turn.into();
    scene.body[0].velocity = turn.cross(&arm).into();
    for method in [Method::GeneralizedAlpha, Method::Radau] {
        if let Some(dynamics) = &mut scene.dynamics {
            dynamics.end_time = 1e-3;
            dynamics.method = method;
        }
        for placement in placements(1.0) {
            let run = run(&placement.apply(&scene))?;
            let found = force_at(&run, 0.0, 0, &placement)?;
            checks.vector(
                Kind::ClosedForm,
                format!("force at the start, {method:?}, {}", placement.name),
                (found.into(), force.into()),
                1e-11 * force.norm(),
                "one linear system with masses of 15 and inertias of 0.2: rounding",
            );
        }
    }
    checks.above(
        Kind::Invariant,
        "share of Ġ u in the force",
        mass * of_velocity.norm() / force.norm(),
        0.1,
        "what forgets it is far off",
    );
    Ok(())
}

const HALVED: &str = "a constant spin is off by (ωh/2)⁵/7200 a radian, with quarters of a step 1.3e-7 over these 12 rad at \
                      an arm of 1 m; with the load of half a step too early or late the way changes by a twentieth";

/// A load that grows within the step: its halves and quarters end, and have their stages, at times of their own.
fn halved_steps(checks: &mut Checks) -> Outcome {
    const STEP: f64 = 8e-3;
    let end = 10.0 * STEP;
    let mut scene = heavy_top::scene(["ground", "top"]);
    let mut push = load(LoadKind::Force, "top", [3e3, 0.0, 2e3]);
    push.time = Some(LoadTime::Table(vec![[0.0, 0.0], [end, 1.0]]));
    scene.load = vec![push];
    let Some(dynamics) = &mut scene.dynamics else { return Err("the scene has no [dynamics]".into()) };
    dynamics.method = Method::Radau;
    dynamics.end_time = end;
    let fine = with_step(&scene, STEP / 16.0);
    let Some(dynamics) = &mut scene.dynamics else { return Err("the scene has no [dynamics]".into()) };
    dynamics.max_iterations = 6;
    for placement in placements(1.0) {
        let coarse = run(&placement.apply(&with_step(&scene, STEP)))?;
        let exact = run(&placement.apply(&fine))?;
        checks.above(
            Kind::Invariant,
            format!("halvings, {}", placement.name),
            coarse.statistics.rejected as f64,
            20.0,
            "two or more in each of ten steps",
        );
        checks.below(
            Kind::Invariant,
            format!("halvings at most, {}", placement.name),
            coarse.statistics.rejected as f64,
            60.0,
            "parts of a step only get smaller, down to one in 2⁶",
        );
        let mut worst = 0.0_f64;
        for k in 1..=10 {
            let time = k as f64 * STEP;
            let found = position_at(&coarse, time, 0, &placement)?;
            worst = worst.max((found - position_at(&exact, time, 0, &placement)?).norm());
        }
        checks.below(Kind::Invariant, format!("way of the top, {}", placement.name), worst, 1.3e-7, HALVED);
    }
    Ok(())
}

/// u = (u_a + u_b)/2 + h/8 (θ_a − θ_b) × e_x and θ = (θ_a + θ_b)/2 in the middle of an element: what a twist that is
/// constant along the element makes of its ends, to first order; shapes of modes are of first order.
fn se3_shapes(checks: &mut Checks) -> Outcome {
    let (elements, size) = (4, LENGTH / 4.0);
    let mut rod = Rod::new("rod", line(LENGTH), rectangle(0.02, 0.03, None), Some(steel()), elements, 1);
    rod.interpolation = InterpolationKind::Se3;
    let places = (0..=2 * elements).map(|k| k as f64 / (2 * elements) as f64);
    let scene = Scene {
        rod: vec![rod],
        joint: vec![clamp("rod@0")],
        probe: places.map(|xi| probe(&format!("p{xi}"), &format!("rod@{xi}"))).collect(),
        modes: Some(Modes { count: 6 }),
        ..Scene::default()
    };
    for placement in placements(LENGTH) {
        let (mut off, mut bent) = (0.0_f64, 0.0_f64);
        for mode in vibrate(&placement.apply(&scene))?.modes {
            let shape: Vec<[Vector3<f64>; 2]> = mode
                .shape
                .iter()
                .map(|&[x, y, z, a, b, c]| {
                    [Vector3::new(x, y, z), Vector3::new(a, b, c)].map(|v| placement.undo_direction(v))
                })
                .collect();
            for element in shape.windows(3).step_by(2) {
                let [[u_a, a], [u, theta], [u_b, b]] = [element[0], element[1], element[2]];
                let bend = size / 8.0 * (a - b).cross(&Vector3::x());
                off = off.max((u - 0.5 * (u_a + u_b) - bend).norm()).max((theta - 0.5 * (a + b)).norm());
                bent = bent.max(bend.norm());
            }
        }
        checks.below(
            Kind::ClosedForm,
            format!("middle of an element, {}", placement.name),
            off,
            1e-14,
            "the same sums of numbers up to 1: rounding",
        );
        checks.above(
            Kind::Invariant,
            format!("share of the ends' rotations, {}", placement.name),
            bent,
            0.02,
            "what forgets it is far off",
        );
    }
    Ok(())
}
