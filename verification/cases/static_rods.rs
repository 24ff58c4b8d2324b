//! Rods under every kind of load, dead and turning with the section, along the rod and at its end: tip, rotation of
//! the tip, what the clamp holds, and the whole shape, against the continuous equations.
//!
//! `scripts/references/static_rods.py` solves them by collocation and by multiple shooting; its files say how far the
//! two are apart. No problem of this file has a closed form or stays in a plane.

use std::error::Error;
use std::f64::consts::PI;

use cosserat::scene::{Basis, CurveShape, Load, LoadKind, Rod, Scene, Statics};
use cosserat::solution::{ProbePose, Solution};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::spring::{COILS, PITCH, RADIUS, SECOND_MOMENT, Spring, WIRE_END, YOUNG, places, wire_length};
use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::continuous::angle;
use crate::measure::{clamp, load, probe, solve};
use crate::pieces::{UNEVEN_SECTION, line};
use crate::placement::{Placement, placements};
use crate::references::{Row, Table};

const LOADS: &str = "continuous/static_loads.csv";
const SHAPES: &str = "continuous/static_shapes.csv";
const SPRING_SHAPE: &str = "continuous/static_spring_shape.csv";
const SPRING_AXIS: &str = "continuous/static_spring_axis.csv";

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "the continuous equations, scripts/references/static_rods.py";
    vec![
        Case::new("static_rods::tips_and_clamps", SOURCE, tips_and_clamps).reads(&[LOADS]),
        Case::new("static_rods::shapes", SOURCE, shapes).reads(&[SHAPES]),
        Case::new("static_rods::spring_clamp", SOURCE, spring_clamp).reads(&[WIRE_END, SPRING_AXIS]).slow(),
        Case::new("static_rods::spring_shape", SOURCE, spring_shape).reads(&[SPRING_SHAPE]).slow(),
    ]
}

const LENGTH: f64 = 2.0;
const ELEMENTS: usize = 20;

/// The loads of one name in the files.
fn loads(problem: &str) -> Result<Vec<Load>, Box<dyn Error>> {
    use LoadKind::{Force, LineForce, LineMoment, Moment};
    let with = |kind, value, basis| {
        let on = if matches!(kind, Force | Moment) { "rod@1" } else { "rod" };
        Load { basis, ..load(kind, on, value) }
    };
    let dead = |kind, value| with(kind, value, Basis::Inertial);
    let body = |kind, value| with(kind, value, Basis::Body);
    Ok(match problem {
        "dead line force, dead tip moment" => {
            vec![dead(LineForce, [0.3, -1.0, 0.8]), dead(Moment, [0.6, 0.8, 2.0])]
        }
        "body line force" => vec![body(LineForce, [0.2, -1.2, 0.9])],
        "dead line moment" => vec![dead(LineMoment, [0.5, 1.2, 1.6])],
        "body line moment" => vec![body(LineMoment, [0.5, 0.6, 5.0])],
        "dead tip force, body tip moment" => {
            vec![dead(Force, [0.2, -0.6, 0.9]), body(Moment, [0.6, 0.8, 4.5])]
        }
        "body tip force" => vec![body(Force, [0.1, -1.3, 0.9])],
        "all on a helix" => {
            let offset = Some([0.1, 0.2, -0.15]);
            vec![
                Load { offset, ..dead(Force, [0.3, 0.2, 0.8]) },
                Load { offset, ..body(Force, [0.1, 0.1, 0.2]) },
                dead(Moment, [0.2, -0.3, 0.4]),
                body(Moment, [0.1, 0.3, -0.5]),
                dead(LineForce, [0.1, -0.2, -0.3]),
                body(LineForce, [0.1, 0.2, 0.1]),
                dead(LineMoment, [0.1, 0.05, -0.1]),
                body(LineMoment, [-0.1, 0.1, 0.2]),
            ]
        }
        _ => return Err(format!("no such problem: {problem}").into()),
    })
}

/// Probes at these ξ.
pub fn scene(problem: &str, elements: usize, stations: &[f64]) -> Result<Scene, Box<dyn Error>> {
    let helix = CurveShape::Helix { coils: 1.5, radius: 0.3, pitch: 0.25, phase: 0.0 };
    let curve = if problem == "all on a helix" { helix } else { line(LENGTH) };
    Ok(Scene {
        rod: vec![Rod::new("rod", curve, UNEVEN_SECTION, None, elements, 8)],
        joint: vec![clamp("rod@0")],
        load: loads(problem)?,
        probe: stations.iter().map(|xi| probe(&format!("at {xi}"), &format!("rod@{xi}"))).collect(),
        statics: Some(Statics::default()),
        ..Scene::default()
    })
}

/// The names in a file, each once, in order.
fn problems(table: &Table) -> Result<Vec<String>, Box<dyn Error>> {
    let mut names: Vec<String> = Vec::new();
    for row in table.rows() {
        let name = row.word("problem")?;
        if names.last().is_none_or(|last| last != name) {
            names.push(name.to_string());
        }
    }
    Ok(names)
}

/// What is compared: position, rotation, force and moment of the clamp.
#[derive(Clone, Copy, Debug)]
struct End {
    position: Vector3<f64>,
    rotation: UnitQuaternion<f64>,
    force: Vector3<f64>,
    moment: Vector3<f64>,
}

fn rotation([w, x, y, z]: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

fn pose(probe: &ProbePose, placement: &Placement) -> (Vector3<f64>, UnitQuaternion<f64>) {
    let position = placement.undo_position(Vector3::from(probe.position));
    (position, rotation(placement.undo_quaternion(probe.quaternion)))
}

impl End {
    /// Probe 0 and joint 0 under the whole load, in the scene before it was placed.
    fn of(solution: &Solution, placement: &Placement) -> Result<Self, Box<dyn Error>> {
        let last = solution.rows.last().ok_or("no rows")?;
        let (position, rotation) = pose(&last.probes[0], placement);
        let [fx, fy, fz, mx, my, mz] = last.reactions[0];
        let force = placement.undo_direction(Vector3::new(fx, fy, fz));
        let moment = placement.undo_direction(Vector3::new(mx, my, mz));
        Ok(Self { position, rotation, force, moment })
    }

    fn exact(row: &Row) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            position: row.numbers("x y z")?.into(),
            rotation: rotation(row.numbers("qw qx qy qz")?),
            force: row.numbers("fx fy fz")?.into(),
            moment: row.numbers("mx my mz")?.into(),
        })
    }

    /// Distances of position, rotation, force and moment.
    fn apart(&self, other: &Self) -> [f64; 4] {
        [
            (self.position - other.position).norm(),
            angle(&self.rotation, &other.rotation),
            (self.force - other.force).norm(),
            (self.moment - other.moment).norm(),
        ]
    }
}

const WHAT: [&str; 4] = ["tip", "rotation of the tip", "force of the clamp", "moment of the clamp"];
/// Relative to the length, to 1 rad, to the force and to the moment.
const ALLOWANCE: [f64; 4] = [1e-10, 1e-9, 1e-9, 1e-9];
const REASON: &str = "the reference's accuracy, and the allowance that halving the mesh has to keep, too";
const HALVED: &str = "fewer elements have 4 times the mesh error or more, and a Newton path and a rounding of \
                      their own: what they do not change is converged";

/// √3 times the accuracy of each component; the file's angle is that of the rotation already.
fn accuracies(row: &Row) -> Result<[f64; 4], Box<dyn Error>> {
    let root = 3.0_f64.sqrt();
    let [position, force, moment] = row.numbers("position_accuracy force_accuracy moment_accuracy")?;
    Ok([root * position, 2.0 * row.number("rotation_accuracy")?, root * force, root * moment])
}

fn tips_and_clamps(checks: &mut Checks) -> Outcome {
    let table = checks.reference(LOADS)?;
    for problem in problems(&table)? {
        let row = table.row(&[("problem", &problem), ("factor", "1.0")])?;
        let (exact, accuracy) = (End::exact(&row)?, accuracies(&row)?);
        let sizes = [LENGTH, 1.0, exact.force.norm().max(1.0), exact.moment.norm().max(1.0)];
        let allowed: [f64; 4] = std::array::from_fn(|k| ALLOWANCE[k] * sizes[k]);
        let whole = scene(&problem, ELEMENTS, &[1.0])?;
        let mut as_is = None;
        for placement in placements(LENGTH) {
            let end = End::of(&solve(&placement.apply(&whole))?, &placement)?;
            for (k, apart) in end.apart(&exact).into_iter().enumerate() {
                let name = format!("{}, {problem}, {}", WHAT[k], placement.name);
                checks.below(Kind::ClosedForm, name, apart, accuracy[k] + allowed[k], REASON);
            }
            as_is.get_or_insert(end);
        }
        let [place, ..] = placements(LENGTH);
        let halved = End::of(&solve(&place.apply(&scene(&problem, ELEMENTS / 2, &[1.0])?))?, &place)?;
        let as_is = as_is.ok_or("no placements")?;
        for (k, apart) in halved.apart(&as_is).into_iter().enumerate() {
            let name = format!("{}, {problem}, half as many elements", WHAT[k]);
            checks.below(Kind::Invariant, name, apart, allowed[k], HALVED);
        }
        let rows = table.select(&[("problem", &problem)])?;
        load_path(checks, &problem, &whole, 1.0, rows, "factor")?;
    }
    Ok(())
}

/// Poses along the rod at ends of elements, and the shape as a picture.
fn shapes(checks: &mut Checks) -> Outcome {
    let table = checks.reference(SHAPES)?;
    for problem in problems(&table)? {
        let rows = table.select(&[("problem", &problem)])?;
        let stations = numbers(&rows, "xi")?;
        let scene = |elements| scene(&problem, elements, &stations);
        let allowed = [ALLOWANCE[0] * LENGTH, ALLOWANCE[1]];
        let bounds = Bounds { fine: allowed, share: 0.0, change: allowed, reasons: [REASON, HALVED] };
        let meshes = (&scene(ELEMENTS)?, &scene(ELEMENTS / 2)?);
        check_shape(checks, &problem, meshes, &rows, (placements(LENGTH), bounds))?;
    }
    Ok(())
}

fn numbers(rows: &[Row], column: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    rows.iter().map(|row| row.number(column)).collect()
}

/// For positions and rotations along a rod.
struct Bounds {
    /// On top of the reference's accuracy, and of this share of the change from the coarser mesh.
    fine: [f64; 2],
    share: f64,
    /// Of that change.
    change: [f64; 2],
    /// Of both.
    reasons: [&'static str; 2],
}

/// Largest distance of all probes from the file's stations, and from those of a coarser mesh.
fn check_shape(
    checks: &mut Checks,
    name: &str,
    (fine, coarse): (&Scene, &Scene),
    rows: &[Row],
    (places, bounds): ([Placement; 3], Bounds),
) -> Outcome {
    let [position, turn] = rows[0].numbers("position_accuracy rotation_accuracy")?;
    let accuracy = [3.0_f64.sqrt() * position, 2.0 * turn];
    let poses = |scene: &Scene, placement: &Placement| -> Result<Vec<_>, Box<dyn Error>> {
        let solution = solve(&placement.apply(scene))?;
        let last = solution.rows.last().ok_or("no rows")?;
        Ok(last.probes.iter().map(|probe| pose(probe, placement)).collect())
    };
    let mut exact = Vec::new();
    for row in rows {
        let position: [f64; 3] = row.numbers("x y z")?;
        exact.push((Vector3::from(position), rotation(row.numbers("qw qx qy qz")?)));
    }
    let apart = |a: &[(Vector3<f64>, UnitQuaternion<f64>)], b: &[(Vector3<f64>, UnitQuaternion<f64>)]| {
        a.iter().zip(b).fold([0.0_f64; 2], |worst, (a, b)| {
            [worst[0].max((a.0 - b.0).norm()), worst[1].max(angle(&a.1, &b.1))]
        })
    };
    let as_is = poses(fine, &places[0])?;
    let change = apart(&poses(coarse, &places[0])?, &as_is);
    for placement in &places {
        let worst = apart(&poses(fine, placement)?, &exact);
        for (k, what) in ["positions", "rotations"].into_iter().enumerate() {
            let quantity = format!("{what} along the rod, {name}, {}", placement.name);
            let bound = accuracy[k] + bounds.fine[k] + bounds.share * change[k];
            checks.below(Kind::ClosedForm, quantity, worst[k], bound, bounds.reasons[0]);
        }
    }
    for (k, what) in ["positions", "rotations"].into_iter().enumerate() {
        let quantity = format!("{what} along the rod, {name}, coarser mesh");
        checks.below(Kind::Invariant, quantity, change[k], bounds.change[k], bounds.reasons[1]);
    }
    checks.trajectory(Trajectory {
        title: format!("shape, {name}"),
        axes: ["x [m]", "z [m]"],
        measured: as_is.iter().map(|(r, _)| [r.x, r.z]).collect(),
        source: "the continuous equations",
        reference: exact.iter().map(|(r, _)| [r.x, r.z]).collect(),
    });
    Ok(())
}

/// At the clamp, what the whole force holds, and the rotation of the end. Newton may leave 1e-9 of the load.
fn spring_clamp(checks: &mut Checks) -> Outcome {
    for (file, on_axis) in [(WIRE_END, false), (SPRING_AXIS, true)] {
        let table = checks.reference(file)?;
        for row in table.rows() {
            let force = row.number("force")?;
            if !(1.0..=10.0).contains(&force) {
                continue;
            }
            let (exact, accuracy) = (End::exact(&row)?, accuracies(&row)?);
            let end = |elements, placement: &Placement| {
                let spring = Spring { on_axis, ..Spring::new(force, elements, 6) };
                End::of(&spring.solve(placement)?, placement)
            };
            // 1e-9 of the load, its moment at the lever that the loaded point has, and the end by as much of half a turn.
            let lever = (COILS * PITCH + row.number("z")?).hypot(2.0 * RADIUS);
            let solver = [1e-9 * PI, 1e-9 * force, 1e-9 * force * lever];
            let [place, ..] = places();
            let change = end(48, &place)?.apart(&end(60, &place)?);
            for placement in places() {
                let fine = end(60, &placement)?;
                for (k, apart) in fine.apart(&exact).into_iter().enumerate().skip(1) {
                    let name = format!("{}, {force} N, on the axis {on_axis}, {}", WHAT[k], placement.name);
                    let bound = accuracy[k] + solver[k - 1] + change[k] / 2.8;
                    checks.below(Kind::ClosedForm, name, apart, bound, SPRING_REASON);
                }
            }
        }
        let rows: Vec<Row> = table.rows().collect();
        let spring = Spring { on_axis, ..Spring::new(100.0, 60, 6) };
        let title =
            if on_axis { "spring pulled on its axis" } else { "spring pulled at the end of the wire" };
        load_path_displaced(checks, title, &spring.scene(), 100.0, rows, "force")?;
    }
    Ok(())
}

const SPRING_REASON: &str = "the reference's accuracy; 1e-9 of the load left by Newton's method; mesh: at order p or more, \
                             (60/48)^6 − 1 = 2.8 times below the change from 48 elements";

/// The whole wire at 10 and 100 N, at ends of elements.
///
/// What an element of length h cannot follow is (h/ℓ)^2p/(2p)! in rotation and ℓ times that in position, with ℓ the
/// shorter of the radius of the coils and the layers at the ends of a stretched wire, √(EI/F).
fn spring_shape(checks: &mut Checks) -> Outcome {
    let table = checks.reference(SPRING_SHAPE)?;
    for (force, newtons) in [("10.0", 10.0), ("100.0", 100.0)] {
        let rows = table.select(&[("force", force)])?;
        let shortest = (YOUNG * SECOND_MOMENT / newtons).sqrt().min(RADIUS);
        let missed = (wire_length(PITCH) / 40.0 / shortest).powi(12) / 479_001_600.0;
        let stretched = rows.last().ok_or("no rows")?.number("z")? - COILS * PITCH;
        let bounds = Bounds {
            fine: [1e-9 * stretched, 1e-9 * PI],
            share: 1.0 / 10.4,
            change: [missed * shortest, missed],
            reasons: [
                "the reference's accuracy; 1e-9 of the load left by Newton's method, and as much of displacement and half a \
                 turn; mesh: at order p or more, (60/40)^6 − 1 = 10.4 times below the change from 40 elements",
                "order 2p = 12: (h/ℓ)¹²/12!, ℓ the shorter of R and √(EI/F)",
            ],
        };
        let stations = numbers(&rows, "xi")?;
        let scene = |elements| -> Result<Scene, Box<dyn Error>> {
            let mut scene = Spring::new(newtons, elements, 6).scene();
            scene.probe =
                stations.iter().map(|xi| probe(&format!("at {xi}"), &format!("spring@{xi}"))).collect();
            Ok(scene)
        };
        let name = format!("spring, {force} N");
        check_shape(checks, &name, (&scene(60)?, &scene(40)?), &rows, (places(), bounds))?;
    }
    Ok(())
}

/// The row with these words, and this number in a column.
pub fn find<'a>(
    table: &'a Table,
    keys: &[(&str, &str)],
    column: &str,
    value: f64,
) -> Result<Row<'a>, Box<dyn Error>> {
    let rows = table.select(keys)?;
    let found = rows.into_iter().find(|row| row.number(column).is_ok_and(|number| number == value));
    Ok(found.ok_or_else(|| format!("no row with {column} = {value} and {keys:?}"))?)
}

/// A picture: how far the tip, probe 0, has moved over the load.
pub fn load_path(
    checks: &mut Checks,
    title: &str,
    scene: &Scene,
    full: f64,
    rows: Vec<Row>,
    column: &str,
) -> Outcome {
    path(checks, title, scene, full, (rows, column, false))
}

/// The same, where the rows have displacements.
fn load_path_displaced(
    checks: &mut Checks,
    title: &str,
    scene: &Scene,
    full: f64,
    rows: Vec<Row>,
    column: &str,
) -> Outcome {
    path(checks, title, scene, full, (rows, column, true))
}

fn path(
    checks: &mut Checks,
    title: &str,
    scene: &Scene,
    full: f64,
    (rows, column, displaced): (Vec<Row>, &str, bool),
) -> Outcome {
    let solution = solve(scene)?;
    let start = Vector3::from(solution.rows.first().ok_or("no rows")?.probes[0].position);
    let moved = |at: [f64; 3]| (Vector3::from(at) - start).norm();
    let measured =
        solution.rows.iter().map(|row| [moved(row.probes[0].position), full * row.parameter]).collect();
    let mut reference = Vec::new();
    for row in rows {
        let at: [f64; 3] = row.numbers("x y z")?;
        let distance = if displaced { Vector3::from(at).norm() } else { moved(at) };
        reference.push([distance, row.number(column)?]);
    }
    let axes = ["displacement of the tip [m]", if column == "force" { "force [N]" } else { "load factor" }];
    checks.trajectory(Trajectory {
        title: title.to_string(),
        axes,
        measured,
        source: "the continuous equations",
        reference,
    });
    Ok(())
}
