//! The soft pendulum that comes with the program: a hinged rod that falls, bends and whips its end.

use std::error::Error;
use std::path::Path;

use cosserat::scene::{Dynamics, InterpolationKind, Load, LoadKind, LoadTime, Scene, Step};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{load, probe};
use crate::motion::{Recursion, follow, place};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "flexible_pendulum::impulse",
            "the centre of mass under weight and hinge force; the recursion of the method",
            impulse,
        ),
        Case::new(
            "flexible_pendulum::shipped",
            "conservation of energy; differences between meshes and steps",
            shipped_scene,
        ),
        Case::new("flexible_pendulum::time", "order 2 of a smooth motion", time),
        Case::new("flexible_pendulum::meshes", "order 2p at the end of the rod, R12 and SE(3) alike", meshes),
    ]
}

const GRAVITY: f64 = 9.81;
/// 1100 kg/m³ · π (20 mm)² · 1 m.
const MASS: f64 = 1100.0 * std::f64::consts::PI * 4e-4;

fn shipped() -> Result<Scene, Box<dyn Error>> {
    Ok(Scene::from_file(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/flexible_pendulum.toml"))?)
}

/// The shipped scene on another mesh, to another time.
fn scene(
    interpolation: InterpolationKind,
    elements: usize,
    degree: usize,
    end: f64,
    steps: usize,
) -> Result<Scene, Box<dyn Error>> {
    let mut scene = shipped()?;
    scene.rod[0].interpolation = interpolation;
    scene.rod[0].elements = elements;
    scene.rod[0].degree = degree;
    scene.probe = [0.25, 0.5, 0.75, 1.0].map(|xi| probe(&format!("p{xi}"), &format!("rod@{xi}"))).to_vec();
    if let Some(options) = &mut scene.dynamics {
        options.end_time = end;
        options.step = Step::Constant(end / steps as f64);
    }
    Ok(scene)
}

/// The hinge's force moves the centre of mass, step by step as the method says.
fn impulse(checks: &mut Checks) -> Outcome {
    let mut scene = shipped()?;
    let intervals = 2 * scene.rod[0].elements;
    scene.probe = (0..=intervals)
        .map(|k| probe(&format!("p{k}"), &format!("rod@{}", k as f64 / intervals as f64)))
        .collect();
    let step = scene.dynamics.as_ref().and_then(Dynamics::time_step).ok_or("no constant step")?;
    let solution = follow(&scene)?;
    // Simpson's weights.
    let weight = |k: usize| if k == 0 || k == intervals { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
    let centre = |row: usize| -> Vector3<f64> {
        let sum: Vector3<f64> = (0..=intervals).map(|k| place(&solution, row, k) * weight(k)).sum();
        sum / (3.0 * intervals as f64)
    };
    let force = |row: usize| -> [f64; 3] {
        let [x, y, z, ..] = solution.rows[row].reactions[0];
        [x / MASS, y / MASS, z / MASS - GRAVITY]
    };
    let start = centre(0);
    let mut parts = force(0).map(|force| Recursion::new(0.8, 0.0, force));
    let mut worst = 0.0_f64;
    let mut moved = 0.0_f64;
    for row in 1..solution.rows.len() {
        let force = force(row);
        let expected: [f64; 3] = std::array::from_fn(|k| parts[k].step(step, force[k]));
        let found = centre(row) - start;
        worst = worst.max((found - Vector3::from(expected)).norm());
        moved = moved.max(found.norm());
    }
    checks.below(
        Kind::ClosedForm,
        "centre of mass against the recursion with the hinge's force, 1500 steps",
        worst,
        1e-11,
        "linear in the unknowns, so that every iteration solves it, and exact with the force that is recorded: rounding, \
         1500 steps of ε times 1 m and sums of 25 nodes, 1e-11",
    );
    checks.above(
        Kind::Invariant,
        "way of the centre of mass [m]",
        moved,
        0.5,
        "half of the length: it swings",
    );
    let side = solution.rows.iter().map(|row| row.reactions[0]);
    let (mut across, mut about, mut largest) = (0.0_f64, 0.0_f64, 0.0_f64);
    for [x, y, z, a, b, c] in side {
        largest = largest.max(x.hypot(z));
        across = across.max(y.abs());
        about = about.max(a.abs()).max(b.abs()).max(c.abs());
    }
    let reason =
        "the motion is plane and the hinge free: rounding, 1e-9 of Newton's test of the largest force";
    checks.below(
        Kind::Invariant,
        "hinge force across the plane, over the largest",
        across / largest,
        1e-9,
        reason,
    );
    checks.below(Kind::Invariant, "hinge moments over the largest force [m]", about / largest, 1e-9, reason);
    Ok(())
}

const R12: InterpolationKind = InterpolationKind::R12;
/// Just past the lowest point.
const END: f64 = 0.48;
/// Times at which motions are compared, evenly in the second half.
const TIMES: usize = 20;

/// The four probes at all these times.
fn path(solution: &Solution) -> Vec<Vector3<f64>> {
    let steps = solution.rows.len() - 1;
    let rows = (1..=TIMES).map(|k| steps / 2 + k * (steps / 2) / TIMES);
    rows.flat_map(|row| (0..4).map(move |index| place(solution, row, index))).collect()
}

/// Root mean square distance [m].
fn distance(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum();
    (sum / a.len() as f64).sqrt()
}

/// Bending vibrations hinged–free, (βL)² √(EI/ρA)/L², βL = 3.93, 7.07, 10.2: 10, 34 and 70 rad/s.
const VIBRATION: f64 = 70.0;

/// The same weight, but it comes on smoothly in 0.3 s: a sudden start wakes vibrations without end, and the order of the
/// method is lost in those it does not resolve.
fn smooth(
    interpolation: InterpolationKind,
    elements: usize,
    degree: usize,
    steps: usize,
) -> Result<Vec<Vector3<f64>>, Box<dyn Error>> {
    let mut scene = scene(interpolation, elements, degree, LATER, steps)?;
    scene.gravity = None;
    let rise = |k: usize| {
        let x = k as f64 / 120.0;
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x)
    };
    let table = (0..=120).map(|k| [0.3 * k as f64 / 120.0, rise(k)]).collect();
    let weight = load(LoadKind::LineForce, "rod", [0.0, 0.0, -MASS * GRAVITY]);
    scene.load.push(Load { time: Some(LoadTime::Table(table)), ..weight });
    Ok(path(&follow(&scene)?))
}

/// The lowest point comes later then.
const LATER: f64 = 0.6;

fn shipped_scene(checks: &mut Checks) -> Outcome {
    let run = |elements, degree, steps| follow(&scene(R12, elements, degree, END, steps)?);
    let mut changes = Vec::new();
    let mut paths = Vec::new();
    for steps in [240, 480, 960] {
        let solution = run(4, 6, steps)?;
        paths.push(path(&solution));
        let change = solution.energies.iter().map(|energies| energies.total() - solution.energies[0].total());
        // The fall of the centre of mass turns m g L/2 into other energy.
        changes.push(change.fold(0.0, |a: f64, b| a.max(b.abs())) / (0.5 * MASS * GRAVITY));
    }
    checks.order(
        "largest change of the energy",
        &[240, 480, 960],
        &changes,
        (2.0, 0.4),
        "order 2; the next term is smaller by ωh, 0.2 for what the sudden start wakes of the fifth vibration, 200 rad/s",
    );
    checks.below(
        Kind::Order,
        "largest change of the energy over m g L/2, finest",
        changes[2],
        (VIBRATION * END / 960.0).powi(2),
        "(ωh)², ω = 70 rad/s of the third bending vibration",
    );
    let (coarse, ours) = (path(&run(6, 2, 240)?), path(&run(12, 2, 240)?));
    checks.below(
        Kind::Order,
        "motion with the shipped mesh and step against a finer one of both",
        distance(&ours, &paths[2]),
        2.0 * distance(&paths[0], &paths[1]) + distance(&coarse, &ours) / 3.0,
        "of order 1 or more in time, twice the difference to the half step is left; of order 2 or more in space, a third \
         of the difference to half the elements",
    );
    checks.below(
        Kind::Order,
        "motion with the shipped mesh and step, in lengths",
        distance(&ours, &paths[2]),
        2e-3,
        "what no picture of the motion shows: 1/500 of the length",
    );
    Ok(())
}

fn time(checks: &mut Checks) -> Outcome {
    let counts = [200, 400, 800];
    let paths = counts
        .into_iter()
        .chain([1600])
        .map(|steps| smooth(R12, 4, 6, steps))
        .collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    let differences: Vec<f64> = paths.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
    checks.order(
        "motion, differences of successive steps",
        &counts,
        &differences,
        (2.0, 0.2),
        "order 2; the next term is smaller by ωh = 0.1, ω = 70 rad/s of the third bending vibration",
    );
    checks.below(
        Kind::Order,
        "motion, last difference",
        differences[2],
        (VIBRATION * LATER / 800.0).powi(2),
        "(ωh)² of the length, ω = 70 rad/s of the third bending vibration",
    );
    Ok(())
}

fn meshes(checks: &mut Checks) -> Outcome {
    let steps = 200;
    let reference = smooth(R12, 8, 8, steps)?;
    let ladders: [(InterpolationKind, usize, [usize; 3]); 4] = [
        (R12, 1, [16, 32, 64]),
        (InterpolationKind::Se3, 1, [16, 32, 64]),
        (R12, 2, [8, 16, 32]),
        (R12, 3, [4, 8, 16]),
    ];
    for (interpolation, degree, meshes) in ladders {
        let errors = meshes
            .iter()
            .map(|&elements| Ok(distance(&smooth(interpolation, elements, degree, steps)?, &reference)))
            .collect::<Result<Vec<f64>, Box<dyn Error>>>()?;
        let factorials: f64 = (1..=degree).map(|k| 1.0 / (degree + k) as f64).product();
        let what = format!("motion to {LATER} s, {interpolation:?}, p = {degree}");
        checks.order(
            &what,
            &meshes,
            &errors,
            (2.0 * degree as f64, 0.4),
            "2p; the next term is smaller by (kh)², 0.4 at most with kL = 10.2 of the third bending vibration",
        );
        checks.below(
            Kind::Order,
            what,
            errors[2],
            (10.2 / meshes[2] as f64).powi(2 * degree as i32) * factorials * factorials,
            "(kh)^{2p} [p!/(2p)!]² of the length, kL = 10.2 of the third bending vibration",
        );
    }
    Ok(())
}
