//! 45° bend: an arc of radius 100 clamped at one end, with a dead tip force out of its plane (Bathe & Bolourchi 1979).
//!
//! The program's arc starts along +e_x and bends towards +e_y; the tables' x points to the centre and their y along
//! the first tangent. Their axes are those of the scene mirrored at the plane x = y, and so is the force.

use std::f64::consts::FRAC_PI_4;

use cosserat::scene::{CurveShape, LoadKind, Rod, Scene, Statics};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, probe};
use crate::pieces::{rectangle, young_poisson};
use crate::placement::placements;
use crate::tip::{Exact, check_tip, half_digit, tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "the continuous equations for the exact arc, see continuous::published_tips";
    vec![
        Case::new("bend_45::values", SOURCE, values),
        Case::new("bend_45::slenderness", SOURCE, slenderness),
        Case::new(
            "bend_45::published",
            "Bathe & Bolourchi 1979, IJNME 14; Simo & Vu-Quoc 1986, CMAME 58, section 5.3",
            published,
        ),
    ]
}

pub const RADIUS: f64 = 100.0;
pub const LENGTH: f64 = RADIUS * FRAC_PI_4;
pub const YOUNG: f64 = 1e7;

/// One row of the table: width, torsion constant (default w⁴/6), force, tip in the table's axes.
pub struct Row {
    pub width: f64,
    pub torsion_constant: Option<f64>,
    pub force: f64,
    pub tip: [f64; 3],
}

const fn row(width: f64, torsion_constant: Option<f64>, force: f64, tip: [f64; 3]) -> Row {
    Row { width, torsion_constant, force, tip }
}

/// Three loads, and the torsion constant that several codes use.
pub const LOADS: [Row; 4] = [
    row(1.0, None, 300.0, [22.244_780_95, 58.779_122_49, 40.191_891_67]),
    row(1.0, None, 450.0, [18.508_178_93, 52.238_558_01, 48.502_927_34]),
    row(1.0, None, 600.0, [15.684_800_53, 47.150_438_57, 53.474_858_79]),
    row(1.0, Some(0.141), 600.0, [15.560_325_40, 46.896_769_60, 53.604_858_46]),
];

/// Radius/width from 1e1 to 1e4 under the force that bends all of them alike.
pub const SLENDERNESS: [Row; 4] = [
    row(10.0, None, 6e6, [15.657_247_97, 47.065_665_64, 54.095_027_01]),
    row(1.0, None, 6e2, [15.684_800_53, 47.150_438_57, 53.474_858_79]),
    row(0.1, None, 6e-2, [15.685_075_39, 47.151_285_84, 53.468_661_05]),
    row(0.01, None, 6e-6, [15.685_078_13, 47.151_294_31, 53.468_599_07]),
];

/// Between the table's axes and those of the scene, either way.
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
        let exact =
            Exact { tip: mirrored(row.tip), digits: half_digit(1e-8), length: LENGTH, allowance: 1e-10 };
        let Row { width, force, .. } = row;
        let name = format!("F = {force:e}, width {width}, J {:?}", row.torsion_constant);
        check_tip(checks, &name, &|elements| scene(row, elements, 4), 24, &exact)?;
    }
    Ok(())
}

fn values(checks: &mut Checks) -> Outcome {
    check(checks, &LOADS)
}

fn slenderness(checks: &mut Checks) -> Outcome {
    check(checks, &SLENDERNESS)
}

/// Both papers use 8 elements with two nodes, so their figures carry a mesh error that ours on that mesh shows.
fn published(checks: &mut Checks) -> Outcome {
    let row = &LOADS[2];
    let centre = [RADIUS * (1.0 - FRAC_PI_4.cos()), RADIUS * FRAC_PI_4.sin(), 0.0];
    let bathe = [-13.4, -23.5, 53.4];
    let papers = [
        ("Simo & Vu-Quoc", [15.79, 47.23, 53.37], 0.005),
        ("Bathe & Bolourchi", std::array::from_fn(|k| centre[k] + bathe[k]), 0.05),
    ];
    for placement in placements(LENGTH) {
        let fine = tip(&scene(row, 24, 4), &placement)?;
        let linear = tip(&scene(row, 8, 1), &placement)?;
        let fine = mirrored(fine.into());
        let linear = mirrored(linear.into());
        let mesh_error = (0..3).fold(0.0_f64, |most, k| most.max((linear[k] - fine[k]).abs()));
        for (name, tip, half_digit) in papers {
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
