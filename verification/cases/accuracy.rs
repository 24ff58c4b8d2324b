//! `accuracy` is what the error is at the end: in proportion, over decades, for motions that do not amplify errors.

use std::error::Error;

use cosserat::scene::{Basis, Body, Dynamics, Load, LoadKind, LoadTime, Method, Scene};
use cosserat::solution::Solution;
use cosserat::{Model, dynamics};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::{body_chain, heavy_top};
use crate::measure::{load, probe};
use crate::placement::placements;
use crate::steps::{body, position_at, quaternion_at, rotation, run};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("accuracy::heavy_top", "Euler's equations by Taylor series", top).reads(&[heavy_top::FILE]),
        Case::new("accuracy::radau", "Euler's equations by Taylor series", radau).reads(&[heavy_top::FILE]),
        Case::new("accuracy::free_body", "closed form", free_body).reads(&[FREE_FILE]),
        Case::new("accuracy::chain", "Kane's equations in seven coordinates", chain).reads(body_chain::FILES),
        Case::new("accuracy::blow", "closed form", blow),
        Case::new("accuracy::fast_and_slow", "closed form", fast_and_slow),
    ]
}

/// What the estimated errors of positions sum up to is at most the accuracy. Errors of velocities, which are not in
/// the sum, move (4/π) ln R as much where steps of a vibration differ by R: 1 + (4/π) ln 10 in all.
pub const MOST: f64 = 4.0;
pub const SUM: &str = "1 + (4/π) ln R = 3.9: errors of positions sum up to no more than the accuracy, and those of \
                       velocities to (4/π) ln R of it where steps follow a vibration and differ by R = 10";

/// Errors at the end over decades of the accuracy.
pub fn check_proportion(checks: &mut Checks, what: &str, errors: &[(f64, f64)]) {
    for &(accuracy, error) in errors {
        checks.below(Kind::ClosedForm, format!("{what}, accuracy {accuracy:e}"), error, MOST * accuracy, SUM);
    }
    let (Some(first), Some(last)) = (errors.first(), errors.last()) else { return };
    let order = (first.1 / last.1).log10() / (first.0 / last.0).log10();
    let decades = (first.0 / last.0).log10();
    let shown: Vec<String> = errors.iter().map(|(_, error)| format!("{error:.2e}")).collect();
    // e lies between 0.7/1.05⁴ and 1 where steps have settled.
    let spread = (1.0_f64 / (0.7 / 1.05_f64.powi(4))).log10() / decades;
    checks.absolute(
        Kind::Order,
        format!("{what}: power of the accuracy, errors [{}]", shown.join(", ")),
        (order, 1.0),
        2.0 * spread,
        "order 2 with steps as the root of the accuracy; a step has from 0.58 to 1 of its part, which over these decades \
         is that much of a power; twice for what the accuracy 0.1 is too coarse for",
    );
}

const DECADES: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];

fn angle(found: [f64; 4], exact: [f64; 4]) -> f64 {
    rotation(found).angle_to(&rotation(exact))
}

fn through(scene: &Scene, times: &[f64]) -> Result<Solution, Box<dyn Error>> {
    let options = scene.dynamics.as_ref().ok_or("the scene asks for no motion")?;
    Ok(dynamics::solve_through(&Model::new(scene)?, options, times, &mut |_, _| ())?)
}

/// 150 rad/s about its axis: |ω|³/4 is what turns it too little.
fn top(checks: &mut Checks) -> Outcome {
    const END: f64 = 1.0;
    const SPIN: f64 = 150.0;
    let as_is = &placements(1.0)[0];
    let (_, position, quaternion, _) = heavy_top::exact(checks, END)?;
    let (mut centres, mut turns) = (Vec::new(), Vec::new());
    for accuracy in DECADES {
        let mut scene = heavy_top::scene(["ground", "top"]);
        scene.dynamics = Some(Dynamics::accurate(END, accuracy));
        let run = run(&scene)?;
        centres.push((accuracy, (position_at(&run, END, 0, as_is)? - Vector3::from(position)).norm()));
        turns.push((accuracy, angle(quaternion_at(&run, END, 0, as_is, quaternion)?, quaternion)));
        // C h² T ω³/4 = 0.7 accuracy with ρ = 0.8.
        let constant = 1.0 / 12.0 + 1.0 / 324.0;
        let step = (0.7 * accuracy / (constant * END * 0.25 * SPIN.powi(3))).sqrt();
        let reason =
            "steady spin: the step that the estimate makes of it; 5 % are no change of a step, and the start";
        let steps = run.statistics.increments as f64;
        checks.relative(Kind::ClosedForm, format!("steps, {accuracy:e}"), (steps, END / step), 0.1, reason);
        let rejected = run.statistics.rejected as f64;
        let reason = "the first steps, until the spin is noticed; each drops to a tenth at most";
        checks.below(Kind::Pinned, format!("rejected, {accuracy:e}"), rejected, 10.0, reason);
    }
    check_proportion(checks, "centre", &centres);
    check_proportion(checks, "rotation", &turns);
    Ok(())
}

/// Held to an estimate of order 3, the method of order 5 is better than asked for, and more so the more is asked.
fn radau(checks: &mut Checks) -> Outcome {
    const END: f64 = 1.0;
    let as_is = &placements(1.0)[0];
    let (_, position, quaternion, _) = heavy_top::exact(checks, END)?;
    let mut before = [f64::INFINITY; 2];
    for accuracy in [1e-2, 1e-4, 1e-6] {
        let mut scene = heavy_top::scene(["ground", "top"]);
        scene.dynamics = Some(Dynamics { method: Method::Radau, ..Dynamics::accurate(END, accuracy) });
        let run = run(&scene)?;
        let errors = [
            (position_at(&run, END, 0, as_is)? - Vector3::from(position)).norm(),
            angle(quaternion_at(&run, END, 0, as_is, quaternion)?, quaternion),
        ];
        for (k, what) in ["centre", "rotation"].into_iter().enumerate() {
            checks.below(
                Kind::ClosedForm,
                format!("{what}, accuracy {accuracy:e}"),
                errors[k],
                accuracy,
                SUM,
            );
            let part = errors[k] / accuracy;
            let reason = "h³ follows the accuracy and the error h⁵: its part falls from one to the next";
            checks.below(Kind::Order, format!("{what}: part of the accuracy"), part, before[k], reason);
            before[k] = part;
        }
    }
    Ok(())
}

const FREE_FILE: &str = "rigid/free_symmetric_body.csv";

fn free_body(checks: &mut Checks) -> Outcome {
    const END: f64 = 5.0;
    let row: [f64; 4] = checks.reference(FREE_FILE)?.row(&[("t", "5.0")])?.numbers("qw qx qy qz")?;
    let mut turns = Vec::new();
    for accuracy in DECADES {
        let scene = Scene {
            body: vec![Body {
                angular_velocity: [1.0, 0.0, 10.0],
                ..body("nut", 1.0, [2.0, 2.0, 3.0], [0.0; 3])
            }],
            probe: vec![probe("nut", "nut")],
            dynamics: Some(Dynamics::accurate(END, accuracy)),
            ..Scene::default()
        };
        let run = run(&scene)?;
        turns.push((accuracy, angle(quaternion_at(&run, END, 0, &placements(1.0)[0], row)?, row)));
    }
    check_proportion(checks, "rotation", &turns);
    Ok(())
}

fn chain(checks: &mut Checks) -> Outcome {
    let as_is = &placements(1.0)[0];
    // Coarser ones would be met by a hundred steps, the fewest there are.
    let runs = [1e-3, 1e-4, 1e-5, 1e-6].map(|accuracy| {
        let mut scene = body_chain::scene(true, 1.0);
        scene.dynamics = Some(Dynamics::accurate(1.0, accuracy));
        through(&scene, &[0.5]).map(|run| (accuracy, run))
    });
    let runs = runs.into_iter().collect::<Result<Vec<_>, _>>()?;
    for time in [0.5, 1.0] {
        let (_, bodies, _) = body_chain::exact(checks, true, time)?;
        let (mut positions, mut turns) = (Vec::new(), Vec::new());
        for (accuracy, run) in &runs {
            let mut worst = [0.0_f64; 2];
            for (index, (position, quaternion)) in bodies.iter().enumerate() {
                let found = position_at(run, time, index, as_is)? - Vector3::from(*position);
                worst[0] = worst[0].max(found.norm() / LEVER);
                worst[1] =
                    worst[1].max(angle(quaternion_at(run, time, index, as_is, *quaternion)?, *quaternion));
            }
            positions.push((*accuracy, worst[0]));
            turns.push((*accuracy, worst[1]));
        }
        check_proportion(checks, &format!("positions at {time} s, in longest levers"), &positions);
        check_proportion(checks, &format!("rotations at {time} s"), &turns);
    }
    Ok(())
}

/// The longest lever of the chain, of the first body to the ground [m]: |(0.3, 0.1, −0.2)|.
const LEVER: f64 = 0.374_165_738_677_394_1;

/// A triangle of 10 ms, then five seconds of free flight: a peak that is stepped over, or its impulse off, shows at the
/// end. The body turns about e_y with the same course.
fn blow(checks: &mut Checks) -> Outcome {
    const PEAK: [f64; 3] = [5.0, 5.005, 5.01];
    const END: f64 = 10.0;
    let course = || Some(LoadTime::Table(vec![[PEAK[0], 0.0], [PEAK[1], 1.0], [PEAK[2], 0.0]]));
    let force = Load { time: course(), ..load(LoadKind::Force, "bob", [400.0, 0.0, 0.0]) };
    let moment =
        Load { time: course(), basis: Basis::Body, ..load(LoadKind::Moment, "bob", [0.0, 40.0, 0.0]) };
    // Half the base of the triangle times the height is the impulse, which acts as if at the peak.
    let flight = 0.005 * (END - PEAK[1]);
    let (way, turn) = (400.0 / 2.0 * flight, 40.0 / 0.3 * flight);
    for accuracy in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        let scene = Scene {
            body: vec![body("bob", 2.0, [0.2, 0.3, 0.4], [0.0; 3])],
            load: vec![force.clone(), moment.clone()],
            probe: vec![probe("bob", "bob")],
            dynamics: Some(Dynamics::accurate(END, accuracy)),
            ..Scene::default()
        };
        let run = run(&scene)?;
        let met = |time: &&f64| run.rows.iter().any(|row| row.parameter == **time);
        let met = PEAK.iter().filter(met).count() as f64;
        checks.absolute(
            Kind::Invariant,
            format!("bends met, {accuracy:e}"),
            (met, 3.0),
            0.0,
            "steps end at them",
        );
        let last = &run.rows.last().ok_or("no rows")?.probes[0];
        let reason = SUM;
        checks.absolute(
            Kind::ClosedForm,
            format!("way, {accuracy:e}"),
            (last.position[0], way),
            MOST * accuracy,
            reason,
        );
        let exact = [(0.5 * turn).cos(), 0.0, (0.5 * turn).sin(), 0.0];
        let error = angle(last.quaternion, exact);
        checks.below(Kind::ClosedForm, format!("turn, {accuracy:e}"), error, MOST * accuracy, reason);
    }
    Ok(())
}

/// A wheel at 1 rad/s that for a fifth of a second is spun to 200 rad/s and back.
fn fast_and_slow(checks: &mut Checks) -> Outcome {
    const END: f64 = 10.0;
    const ACCURACY: f64 = 1e-3;
    const STEP: f64 = 1e-4;
    // From 4.0 to 4.2 s: up for a tenth, down for a tenth, by triangles of 50 ms each way.
    let times = [0.0, 4.0, 4.05, 4.15, 4.2];
    let factors = [0.0, 0.0, 1.0, -1.0, 0.0];
    let table = times.iter().zip(factors).map(|(&time, factor)| [time, factor]).collect();
    let moment = Load {
        time: Some(LoadTime::Table(table)),
        basis: Basis::Body,
        ..load(LoadKind::Moment, "wheel", [0.0, 0.0, 1600.0])
    };
    let scene = |options| Scene {
        body: vec![Body {
            angular_velocity: [0.0, 0.0, 1.0],
            ..body("wheel", 1.0, [0.2, 0.2, 0.4], [0.0; 3])
        }],
        load: vec![moment.clone()],
        probe: vec![probe("wheel", "wheel")],
        dynamics: Some(options),
        ..Scene::default()
    };
    // ∬ of the course: its first integral, t²/0.1 up to 50 ms and as much below 50 ms from there to the middle, then back.
    let twice = 2.0 * 0.05 * 0.05;
    let turn = END + 1600.0 / 0.4 * twice;
    let exact = [(0.5 * turn).cos(), 0.0, 0.0, (0.5 * turn).sin()];
    let error =
        |run: &Solution| run.rows.last().map_or(f64::NAN, |row| angle(row.probes[0].quaternion, exact));
    let adaptive = run(&scene(Dynamics::accurate(END, ACCURACY)))?;
    let constant = run(&scene(Dynamics::new(END, STEP)))?;
    checks.below(Kind::ClosedForm, "turn, accuracy 1e-3", error(&adaptive), MOST * ACCURACY, SUM);
    let reason = "C h² of ∫|ω|³/4 dt, 2e6 · 0.2 s at most: 3.5e-4; and as much for velocities";
    checks.below(Kind::ClosedForm, "turn, constant step", error(&constant), 2.0 * 3.5e-4, reason);
    // Order 2: as many constant steps as have the same error.
    let equal = END / STEP * (error(&constant) / error(&adaptive)).sqrt();
    let steps = adaptive.statistics.increments;
    let gain = gain(END);
    checks.above(
        Kind::ClosedForm,
        format!("constant steps of the same error, over {steps}; foretold {gain:.2}"),
        equal / steps as f64,
        0.8 * gain,
        "steps with C h² d = E/T have the error E and are ∫√d dt √(C T/E), constant ones with C h² ∫d dt = E are \
         T √(C ∫d dt/E); a tenth less for what is no change of a step, as much for the bends",
    );
    Ok(())
}

/// √(T ∫d dt)/∫√d dt for the wheel, d = |ω³/4 − ω̈| over the time T: what steps by their error save.
fn gain(duration: f64) -> f64 {
    const POINTS: usize = 1_000_000;
    let step = duration / POINTS as f64;
    let (mut whole, mut roots) = (0.0, 0.0);
    for k in 0..POINTS {
        // From the nearer end of the fifth of a second.
        let t = (k as f64 + 0.5) * step - 4.0;
        let t = t.min(0.2 - t);
        let (spin, curvature) = if t <= 0.0 {
            (1.0, 0.0)
        } else if t < 0.05 {
            (1.0 + 4e4 * t * t, 8e4)
        } else {
            (201.0 - 4e4 * (0.1 - t).powi(2), -8e4)
        };
        let d = (0.25 * spin * spin * spin - curvature).abs();
        whole += step * d;
        roots += step * d.sqrt();
    }
    (duration * whole).sqrt() / roots
}
