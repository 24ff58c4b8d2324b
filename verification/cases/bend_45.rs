//! 45° bend: an arc of radius 100 clamped at one end, with a dead tip force out of its plane (Bathe & Bolourchi 1979).
//!
//! The program's arc starts along +e_x and bends towards +e_y; the tables' x points to the centre and their y along
//! the first tangent. Their axes are those of the scene mirrored at the plane x = y, and so is the force.

use std::error::Error;
use std::f64::consts::FRAC_PI_4;

use cosserat::scene::{CurveShape, LoadKind, Rod, Scene, Statics};

use super::static_rods::{find, load_path};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, probe};
use crate::pieces::{rectangle, young_poisson};
use crate::placement::placements;
use crate::references;
use crate::tip::{Exact, check_tip, tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "the continuous equations for the exact arc, scripts/references/static_rods.py";
    vec![
        Case::new("bend_45::values", SOURCE, values).reads(&[LOADS]),
        Case::new("bend_45::slenderness", SOURCE, slenderness).reads(&[SLENDERNESS]),
        Case::new(
            "bend_45::published",
            "Bathe & Bolourchi 1979, IJNME 14; Simo & Vu-Quoc 1986, CMAME 58, section 5.3",
            published,
        )
        .reads(&[LOADS, BATHE, SIMO]),
    ]
}

pub const RADIUS: f64 = 100.0;
pub const LENGTH: f64 = RADIUS * FRAC_PI_4;
pub const YOUNG: f64 = 1e7;

/// Loads up to 600 N, and the torsion constant that several codes use.
pub const LOADS: &str = "continuous/static_bend_45.csv";
/// Radius/width from 1e1 to 1e4 under the force that bends all of them alike.
pub const SLENDERNESS: &str = "continuous/static_bend_45_slenderness.csv";
const BATHE: &str = "published/bathe_bolourchi_1979.csv";
const SIMO: &str = "published/simo_vu_quoc_1986.csv";

/// One problem and its tip: width, torsion constant (default w⁴/6), force.
pub struct Row {
    pub width: f64,
    pub torsion_constant: Option<f64>,
    pub force: f64,
    pub exact: Exact,
}

impl Row {
    fn new(width: f64, torsion_constant: Option<f64>, row: &references::Row) -> Result<Self, Box<dyn Error>> {
        let force = row.number("force")?;
        Ok(Self { width, torsion_constant, force, exact: Exact::of(row, LENGTH, 1e-10)? })
    }
}

/// Three loads with J = 1/6, which is the default, and the largest with J = 0.141.
pub fn loads(checks: &mut Checks) -> Result<Vec<Row>, Box<dyn Error>> {
    let table = checks.reference(LOADS)?;
    let row = |case, torsion_constant, force| {
        Row::new(1.0, torsion_constant, &find(&table, &[("case", case)], "force", force)?)
    };
    let mut rows = Vec::new();
    for force in [300.0, 450.0, 600.0] {
        rows.push(row("1/6", None, force)?);
    }
    rows.push(row("0.141", Some(0.141), 600.0)?);
    Ok(rows)
}

/// The ladder.
pub fn ladder(checks: &mut Checks) -> Result<Vec<Row>, Box<dyn Error>> {
    let table = checks.reference(SLENDERNESS)?;
    table.rows().map(|row| Row::new(row.number("width")?, None, &row)).collect()
}

/// Between the axes of the printed tables and those of the scene, either way.
pub fn mirrored([x, y, z]: [f64; 3]) -> [f64; 3] {
    [y, x, z]
}

fn scene(row: &Row, elements: usize, degree: usize) -> Scene {
    let arc = CurveShape::Arc { radius: RADIUS, angle: FRAC_PI_4 };
    let section = rectangle(row.width, row.width, row.torsion_constant);
    let material = young_poisson(YOUNG, 0.0);
    Scene {
        rod: vec![Rod::new("bend", arc, section, Some(material), elements, degree)],
        joint: vec![clamp("bend@0")],
        load: vec![load(LoadKind::Force, "bend@1", [0.0, 0.0, row.force])],
        probe: vec![probe("tip", "bend@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn check(checks: &mut Checks, rows: &[Row]) -> Outcome {
    for row in rows {
        let Row { width, force, exact, .. } = row;
        let name = format!("F = {force:e}, width {width}, J {:?}", row.torsion_constant);
        check_tip(checks, &name, &|elements| scene(row, elements, 4), 24, exact)?;
    }
    Ok(())
}

fn values(checks: &mut Checks) -> Outcome {
    let rows = loads(checks)?;
    check(checks, &rows)?;
    let table = checks.reference(LOADS)?;
    let scene = scene(&rows[2], 24, 4);
    load_path(checks, "45° bend, J = 1/6", &scene, 600.0, table.select(&[("case", "1/6")])?, "force")
}

fn slenderness(checks: &mut Checks) -> Outcome {
    let rows = ladder(checks)?;
    check(checks, &rows)
}

/// Both papers use 8 elements with two nodes, so their figures carry a mesh error that ours on that mesh shows.
fn published(checks: &mut Checks) -> Outcome {
    let row = &loads(checks)?[2];
    let centre = [RADIUS * (1.0 - FRAC_PI_4.cos()), RADIUS * FRAC_PI_4.sin(), 0.0];
    let mut papers = Vec::new();
    for (name, file, from) in [("Simo & Vu-Quoc", SIMO, [0.0; 3]), ("Bathe & Bolourchi", BATHE, centre)] {
        let table = checks.reference(file)?;
        let printed = find(&table, &[], "force", row.force)?;
        let [x, y, z, digit] = printed.numbers("x y z z_half_digit")?;
        papers.push((name, [from[0] + x, from[1] + y, from[2] + z], digit));
    }
    for placement in placements(LENGTH) {
        let fine = tip(&scene(row, 24, 4), &placement)?;
        let linear = tip(&scene(row, 8, 1), &placement)?;
        let fine = mirrored(fine.into());
        let linear = mirrored(linear.into());
        let mesh_error = (0..3).fold(0.0_f64, |most, k| most.max((linear[k] - fine[k]).abs()));
        for &(name, tip, half_digit) in &papers {
            for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
                checks.absolute(
                    Kind::Published,
                    format!("{name}, {axis} of the tip, {}", placement.name),
                    (fine[k], tip[k]),
                    mesh_error + half_digit,
                    "half a printed digit, and what 8 linear elements are off by in the worst component",
                );
            }
        }
    }
    Ok(())
}
