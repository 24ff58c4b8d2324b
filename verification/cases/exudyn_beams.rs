//! Strongly bent rods against Exudyn's geometrically exact beam elements (two nodes, poses interpolated on SE(3)).
//!
//! `references/exudyn/` holds the pose of the loaded end over the load factor on three meshes, and the limit extrapolated
//! from them by h² and h⁴ with an estimate of its error. Ours runs on a mesh whose own error a coarser one shows to be
//! small beside that.

use std::error::Error;
use std::f64::consts::{FRAC_PI_4, PI};

use cosserat::scene::{Basis, CurveShape, Load, LoadKind, Material, Rod, Scene, Section, Statics};
use nalgebra::Vector3;

use super::bend_45::{self, RADIUS, YOUNG};
use super::cantilever::{self, BENDING, force};
use super::spring::Spring;
use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::{clamp, load, probe, solve};
use crate::pieces::{line, rectangle, young_poisson, young_shear};
use crate::placement::{Placement, placements};
use crate::references::Table;
use crate::steps::{distance, rotation};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "Exudyn, ObjectBeamGeometricallyExact, three meshes and their limit";
    vec![
        Case::new("exudyn_beams::cantilever", SOURCE, shear_soft).reads(&["exudyn/cantilever.csv"]),
        Case::new("exudyn_beams::bend_45", SOURCE, bend).reads(&["exudyn/bend_45.csv"]),
        Case::new("exudyn_beams::twisted", SOURCE, twisted).reads(&["exudyn/twisted.csv"]),
        Case::new("exudyn_beams::spring", SOURCE, spring).reads(&["exudyn/spring.csv"]),
    ]
}

/// One rod, clamped at its start, with probe 0 at its end.
struct Problem {
    table: &'static str,
    length: f64,
    scene: fn(usize) -> Scene,
    elements: usize,
    /// Ours, where a residual of 1e-9 of the load, the default, moves the end by more than a tenth of the reference's error.
    tolerance: Option<f64>,
    /// Of the picture: full load, and which coordinate of the end is drawn over the load.
    load: f64,
    axes: [&'static str; 2],
    coordinate: usize,
}

fn scene(shape: CurveShape, section: Section, material: Option<Material>, elements: usize) -> Scene {
    Scene {
        rod: vec![Rod::new("rod", shape, section, material, elements, 4)],
        joint: vec![clamp("rod@0")],
        probe: vec![probe("end", "rod@1")],
        ..Scene::default()
    }
}

fn shear_soft(checks: &mut Checks) -> Outcome {
    let scene = |elements| {
        let section = Section::Custom {
            axial: 5.0,
            shear_y: 1.0,
            shear_z: 1.0,
            torsion: 1.0,
            bending_y: BENDING,
            bending_z: BENDING,
            mass_per_length: None,
            rotary_inertia: None,
        };
        let load = vec![load(LoadKind::Force, "rod@1", [0.0, force(10.0), 0.0])];
        Scene { load, ..scene(line(cantilever::LENGTH), section, None, elements) }
    };
    let problem = Problem {
        table: "exudyn/cantilever.csv",
        length: cantilever::LENGTH,
        scene,
        elements: 32,
        tolerance: Some(1e-12),
        load: force(10.0),
        axes: ["force [N]", "y of the end [m]"],
        coordinate: 1,
    };
    problem.check(checks)
}

fn bend(checks: &mut Checks) -> Outcome {
    let scene = |elements| {
        let arc = CurveShape::Arc { radius: RADIUS, angle: FRAC_PI_4 };
        let load = vec![load(LoadKind::Force, "rod@1", [0.0, 0.0, 600.0])];
        let material = Some(young_poisson(YOUNG, 0.0));
        Scene { load, ..scene(arc, rectangle(1.0, 1.0, None), material, elements) }
    };
    let problem = Problem {
        table: "exudyn/bend_45.csv",
        length: bend_45::LENGTH,
        scene,
        elements: 24,
        tolerance: None,
        load: 600.0,
        axes: ["force [N]", "z of the end [m]"],
        coordinate: 2,
    };
    problem.check(checks)
}

/// A quarter of a turn by a moment that turns with the end, and a force that does not (benchmark of the orders of
/// convergence, slenderness 100).
fn twisted(checks: &mut Checks) -> Outcome {
    const LENGTH: f64 = 1000.0;
    const WIDTH: f64 = 10.0;
    const MOMENT: f64 = WIDTH * WIDTH * WIDTH * WIDTH / 12.0 * 2.0 * PI / LENGTH / 4.0;
    let scene = |elements| {
        let moment = Load { basis: Basis::Body, ..load(LoadKind::Moment, "rod@1", [0.0, 0.0, MOMENT]) };
        let force = load(LoadKind::Force, "rod@1", [0.0, 0.0, MOMENT / LENGTH]);
        let material = Some(young_shear(1.0, 0.5));
        let rod = scene(line(LENGTH), rectangle(WIDTH, WIDTH, None), material, elements);
        Scene { load: vec![moment, force], ..rod }
    };
    let problem = Problem {
        table: "exudyn/twisted.csv",
        length: LENGTH,
        scene,
        elements: 32,
        tolerance: None,
        load: MOMENT,
        axes: ["moment [N m]", "y of the end [m]"],
        coordinate: 1,
    };
    problem.check(checks)
}

fn spring(checks: &mut Checks) -> Outcome {
    let problem = Problem {
        table: "exudyn/spring.csv",
        length: super::spring::wire_length(super::spring::PITCH),
        scene: |elements| Spring::new(10.0, elements, 6).scene(),
        elements: 60,
        tolerance: None,
        load: 10.0,
        axes: ["force [N]", "z of the end of the wire [m]"],
        coordinate: 2,
    };
    problem.check(checks)
}

/// Where the end is: position, and quaternion of the section.
type Pose = ([f64; 3], [f64; 4]);
/// Load factor, pose, estimated errors of position and rotation.
type Stored = (f64, Pose, [f64; 2]);

/// How far two poses are apart [m, rad].
fn apart(a: &Pose, b: &Pose) -> [f64; 2] {
    let turn = rotation(a.1).inverse() * rotation(b.1);
    [distance(&a.0, &b.0), 2.0 * turn.imag().norm()]
}

/// The rows of one mesh, or of the limit: load factor, pose, estimated errors.
fn rows(table: &Table, elements: &str) -> Result<Vec<Stored>, Box<dyn Error>> {
    table
        .select(&[("elements", elements)])?
        .iter()
        .map(|row| {
            let pose = (row.numbers::<3>("x y z")?, row.numbers::<4>("qw qx qy qz")?);
            Ok((row.number("factor")?, pose, row.numbers("position_error rotation_error")?))
        })
        .collect()
}

const QUANTITIES: [&str; 2] = ["position [m]", "rotation [rad]"];
const REASON: &str = "the estimated error of Exudyn's limit, at its worst along the path; half as much again for our \
                      mesh and solver, which half as many elements have to keep";
const HALVED: &str = "half of the reference's estimated error: half as many elements have 16 times the mesh error or \
                      more, and a Newton path and a rounding of their own";
const ORDER: &str = "Exudyn's elements have order 2 and an error even in h: the next term, of order 4, is below 3 % of \
                     the first on these meshes, log₂ 1.03 = 0.04";

impl Problem {
    /// The whole load path in every placement, with equal increments where the reference has its rows.
    fn check(&self, checks: &mut Checks) -> Outcome {
        let table = checks.reference(self.table)?;
        let limit = rows(&table, "limit")?;
        let count = limit.len();
        let accuracy: [f64; 2] =
            std::array::from_fn(|k| limit.iter().fold(0.0, |most: f64, row| most.max(row.2[k])));
        let mut as_is = Vec::new();
        for placement in placements(self.length) {
            let path = self.path(self.elements, count, &placement)?;
            for (name, (error, accuracy)) in QUANTITIES.iter().zip(worst(&path, &limit).zip(accuracy)) {
                let what = format!("{name} of the end, worst of {count} load factors, {}", placement.name);
                checks.below(Kind::CrossCode, what, error, 1.5 * accuracy, REASON);
            }
            if as_is.is_empty() {
                as_is = path;
            }
        }
        let as_rows: Vec<_> = limit.iter().zip(&as_is).map(|(row, pose)| (row.0, *pose, row.2)).collect();
        let halved = self.path(self.elements / 2, count, &placements(self.length)[0])?;
        for (name, (change, accuracy)) in QUANTITIES.iter().zip(worst(&halved, &as_rows).zip(accuracy)) {
            let what =
                format!("{name} of the end, {} elements instead of {}", self.elements / 2, self.elements);
            checks.below(Kind::Invariant, what, change, 0.5 * accuracy, HALVED);
        }
        self.orders(checks, &table, &as_is[count - 1])?;
        checks.trajectory(self.picture(&as_rows, &limit));
        Ok(())
    }

    /// The end at each of `count` equal increments.
    fn path(
        &self,
        elements: usize,
        count: usize,
        placement: &Placement,
    ) -> Result<Vec<Pose>, Box<dyn Error>> {
        let statics =
            Some(Statics { increments: Some(count), tolerance: self.tolerance, ..Statics::default() });
        let solution = solve(&placement.apply(&Scene { statics, ..(self.scene)(elements) }))?;
        let pose = |row: &cosserat::solution::Row| {
            let end = &row.probes[0];
            let position = placement.undo_position(Vector3::from(end.position)).into();
            (position, placement.undo_quaternion(end.quaternion))
        };
        Ok(solution.rows.iter().skip(1).map(pose).collect())
    }

    /// What Exudyn's meshes are off by under the full load, held against our converged solution.
    fn orders(&self, checks: &mut Checks, table: &Table, ours: &Pose) -> Outcome {
        let mut meshes: Vec<usize> = Vec::new();
        for row in table.rows() {
            match row.word("elements")?.parse() {
                Ok(elements) if !meshes.contains(&elements) => meshes.push(elements),
                _ => {}
            }
        }
        let mut errors = [Vec::new(), Vec::new()];
        for elements in &meshes {
            let path = rows(table, &elements.to_string())?;
            let full = path.last().ok_or("a mesh without rows")?;
            for (errors, error) in errors.iter_mut().zip(apart(&full.1, ours)) {
                errors.push(error);
            }
        }
        for (name, errors) in QUANTITIES.iter().zip(&errors) {
            let what = format!("{name} of the end, Exudyn's meshes against ours");
            checks.order(what, &meshes, errors, (2.0, 0.04), ORDER);
        }
        Ok(())
    }

    fn picture(&self, ours: &[(f64, Pose, [f64; 2])], theirs: &[(f64, Pose, [f64; 2])]) -> Trajectory {
        let line = |rows: &[(f64, Pose, [f64; 2])]| {
            rows.iter().map(|row| [row.0 * self.load, row.1.0[self.coordinate]]).collect()
        };
        Trajectory {
            title: format!("Load path, {}", self.table),
            axes: self.axes,
            measured: line(ours),
            source: "Exudyn, extrapolated",
            reference: line(theirs),
        }
    }
}

/// Largest distances along a path; NaN if one has other rows than the other.
fn worst(path: &[Pose], rows: &[(f64, Pose, [f64; 2])]) -> impl Iterator<Item = f64> {
    let mut most = if path.len() == rows.len() { [0.0; 2] } else { [f64::NAN; 2] };
    for (pose, row) in path.iter().zip(rows) {
        for (most, error) in most.iter_mut().zip(apart(pose, &row.1)) {
            *most = if error > *most || error.is_nan() { error } else { *most };
        }
    }
    most.into_iter()
}
