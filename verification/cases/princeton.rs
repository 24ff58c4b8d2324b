//! Princeton beam: a thin strip clamped at one end, tip load of 8.896 N at an angle β to its stiff direction.
//!
//! Bending about both axes and torsion couple (Dowell & Traybar 1975; Bauchau et al. 2016).

use std::error::Error;

use cosserat::scene::{LoadKind, Rod, Scene, Statics};

use super::static_rods::load_path;
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, probe};
use crate::pieces::{line, rectangle, young_poisson};
use crate::placement::placements;
use crate::tip::{Exact, check_tip, tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("princeton::values", "the continuous equations, scripts/references/static_rods.py", values)
            .reads(&[TIPS]),
        Case::new("princeton::ansys", "ANSYS, 199 beam elements, β = 45°", ansys).reads(&[ANSYS]),
    ]
}

pub const LENGTH: f64 = 0.508;
pub const WIDTH: f64 = 12.3777e-3;
pub const HEIGHT: f64 = 3.2024e-3;
pub const YOUNG: f64 = 71.7e9;
pub const POISSON: f64 = 0.31;

/// The tips.
pub const TIPS: &str = "continuous/static_princeton.csv";
const ANSYS: &str = "published/ansys_princeton.csv";
/// β in the file's words and as a number.
const ANGLES: [(&str, f64); 3] = [("30.0", 30.0), ("45.0", 45.0), ("90.0", 90.0)];

/// β in degrees, and the tip.
pub fn tips(checks: &mut Checks) -> Result<Vec<(f64, Exact)>, Box<dyn Error>> {
    let table = checks.reference(TIPS)?;
    let exact = |(words, degrees)| {
        let row = table.row(&[("degrees", words), ("factor", "1.0")])?;
        Ok((degrees, Exact::of(&row, LENGTH, 1e-10)?))
    };
    ANGLES.into_iter().map(exact).collect()
}

/// J = 0.198 (I_y + I_z).
pub fn torsion_constant() -> f64 {
    0.198 * WIDTH * HEIGHT * (WIDTH.powi(2) + HEIGHT.powi(2)) / 12.0
}

/// (0, −F cos β, F sin β).
pub fn force(degrees: f64) -> [f64; 3] {
    let beta = degrees.to_radians();
    [0.0, -8.896 * beta.cos(), 8.896 * beta.sin()]
}

fn scene(degrees: f64, torsion_constant: f64, elements: usize) -> Scene {
    let section = rectangle(WIDTH, HEIGHT, Some(torsion_constant));
    let material = young_poisson(YOUNG, POISSON);
    Scene {
        rod: vec![Rod::new("strip", line(LENGTH), section, Some(material), elements, 4)],
        joint: vec![clamp("strip@0")],
        load: vec![load(LoadKind::Force, "strip@1", force(degrees))],
        probe: vec![probe("tip", "strip@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn values(checks: &mut Checks) -> Outcome {
    for (degrees, exact) in tips(checks)? {
        let name = format!("β = {degrees}°");
        check_tip(checks, &name, &|elements| scene(degrees, torsion_constant(), elements), 16, &exact)?;
    }
    let table = checks.reference(TIPS)?;
    for (words, degrees) in ANGLES {
        let rows = table.select(&[("degrees", words)])?;
        let title = format!("Princeton beam, β = {degrees}°");
        load_path(checks, &title, &scene(degrees, torsion_constant(), 16), 1.0, rows, "factor")?;
    }
    Ok(())
}

/// ANSYS computes a torsion constant of its own from a mesh of the section, which it does not print. That of a thin
/// strip, w h³/3, is the largest there is; the figures must lie between the tips of either.
fn ansys(checks: &mut Checks) -> Outcome {
    let table = checks.reference(ANSYS)?;
    // Printed without signs.
    let [y, z] = table.row(&[("degrees", "45.0")])?.numbers("y z")?;
    for placement in placements(LENGTH) {
        let ours = tip(&scene(45.0, torsion_constant(), 16), &placement)?;
        let strip = tip(&scene(45.0, WIDTH * HEIGHT.powi(3) / 3.0, 16), &placement)?;
        for (name, ours, strip, ansys) in [("u_y", ours.y, strip.y, -y), ("u_z", ours.z, strip.z, z)] {
            checks.absolute(
                Kind::CrossCode,
                format!("{name}, {}", placement.name),
                (ours, ansys),
                (strip - ours).abs(),
                "how far the tip moves between J = 0.198 (I_y + I_z) and the thin strip's J, which bounds any other",
            );
        }
    }
    Ok(())
}
