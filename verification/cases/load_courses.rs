//! Loads that vary in time, and gravity that a rod does not feel: a free rod's centre of mass tells what acts.

use cosserat::scene::{Basis, Dynamics, Load, LoadKind, LoadTime, NamedTime, Rod, Scene, Section};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{load, probe};
use crate::motion::{Recursion, follow, place};
use crate::pieces::line;
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new(
        "load_courses::centre_of_mass",
        "Newton's second law of the whole; the recursion of the method",
        centre_of_mass,
    )]
}

const END: f64 = 0.5;
const STEPS: usize = 100;
const LENGTH: f64 = 2.0;
const MASS: f64 = 0.7 * LENGTH;
const GRAVITY: [f64; 3] = [0.0, -3.0, 9.0];
const TABLE: [[f64; 2]; 4] = [[0.05, 0.0], [0.2, 2.0], [0.3, -1.0], [0.4, 0.5]];

fn rod(name: &str) -> Rod {
    let section = Section::Custom {
        axial: 500.0,
        shear_y: 300.0,
        shear_z: 200.0,
        torsion: 1.0,
        bending_y: 2.0,
        bending_z: 3.0,
        mass_per_length: Some(MASS / LENGTH),
        rotary_inertia: Some([0.01, 0.02, 0.03]),
    };
    Rod::new(name, line(LENGTH), section, None, 3, 2)
}

/// Zero before the first point, linear, constant after the last.
fn tabulated(t: f64) -> f64 {
    let [first, .., last] = TABLE;
    if t <= first[0] {
        return first[1];
    }
    let inside = TABLE.windows(2).find(|pair| t <= pair[1][0]);
    inside.map_or(last[1], |pair| {
        let [a, b] = [pair[0], pair[1]];
        a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0])
    })
}

/// A course by the scene, and as a function.
type Course = (&'static str, Option<LoadTime>, fn(f64) -> f64);

fn centre_of_mass(checks: &mut Checks) -> Outcome {
    let value = [1.0, 0.4, -0.6];
    let loads: [(&str, Load, f64); 4] = [
        ("line force", load(LoadKind::LineForce, "rod", value), LENGTH),
        ("force at a node", load(LoadKind::Force, "rod@0.5", value), 1.0),
        (
            "force at a lever",
            Load { offset: Some([0.0, 0.2, 0.1]), ..load(LoadKind::Force, "rod@1", value) },
            1.0,
        ),
        ("moments", load(LoadKind::LineMoment, "rod", value), 0.0),
    ];
    let courses: [Course; 4] = [
        ("constant", Some(LoadTime::Named(NamedTime::Constant)), |_| 1.0),
        ("nothing said", None, |_| 1.0),
        ("ramp", Some(LoadTime::Named(NamedTime::Ramp)), |t| t / END),
        ("table", Some(LoadTime::Table(TABLE.to_vec())), tabulated),
    ];
    for (kind, load, size) in &loads {
        for (course, time, factor) in &courses {
            for gravity in [true, false] {
                let mut rod = rod("rod");
                rod.gravity = gravity;
                let scene = Scene {
                    gravity: Some(GRAVITY),
                    rod: vec![rod],
                    load: vec![Load { time: time.clone(), basis: Basis::Inertial, ..load.clone() }],
                    probe: (0..7)
                        .map(|k| probe(&format!("p{k}"), &format!("rod@{}", f64::from(k) / 6.0)))
                        .collect(),
                    dynamics: Some(Dynamics::new(END, END / STEPS as f64)),
                    ..Scene::default()
                };
                let placement = &placements(LENGTH)[usize::from(gravity)];
                let solution = follow(&placement.apply(&scene))?;
                let centre = |row: usize| {
                    // Simpson's weights of the three elements.
                    let weights = [1.0, 4.0, 2.0, 4.0, 2.0, 4.0, 1.0];
                    let sum: Vector3<f64> =
                        weights.iter().enumerate().map(|(k, w)| place(&solution, row, k) * *w).sum();
                    sum / 18.0
                };
                let mut falling = Recursion::new(0.8, 0.0, 1.0);
                let mut pushed = Recursion::new(0.8, 0.0, factor(0.0));
                let (step, start) = (END / STEPS as f64, centre(0));
                let mut worst = 0.0_f64;
                for row in 1..=STEPS {
                    let fallen = if gravity { falling.step(step, 1.0) } else { 0.0 };
                    let moved = pushed.step(step, factor(row as f64 * step)) * size / MASS;
                    let expected = Vector3::from(GRAVITY) * fallen + Vector3::from(value) * moved;
                    let found = placement.undo_direction(centre(row) - start);
                    worst = worst.max((found - expected).norm());
                }
                checks.below(
                    Kind::ClosedForm,
                    format!("{kind}, {course}, gravity {gravity}, {}", placement.name),
                    worst,
                    2e-13,
                    "linear in the unknowns, so that the first iteration solves it: rounding, 100 steps of ε times \
                     positions of 5 and their sums, 1e-13",
                );
            }
        }
    }
    Ok(())
}
