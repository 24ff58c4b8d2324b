//! Straight shear-soft cantilever under a dead tip force P = α² EI/L² across it: finite stretch and shear.
//!
//! L = 2π, EA = 5, GA = 1, EI = 2: strains are so large that a wrong γ shows in the second digit.

use std::error::Error;
use std::f64::consts::TAU;

use cosserat::scene::{LoadKind, Rod, Scene, Section, Statics, Theory};

use super::static_rods::load_path;
use crate::case::{Case, Checks, Outcome};
use crate::measure::{clamp, load, probe};
use crate::pieces::line;
use crate::tip::{Exact, check_tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "the continuous equations, scripts/references/static_rods.py";
    vec![
        Case::new("cantilever::values", SOURCE, values).reads(&[TIPS]),
        Case::new("cantilever::constrained_theories", SOURCE, constrained_theories).reads(&[TIPS]),
        Case::new("cantilever::shear_rigid", SOURCE, shear_rigid)
            .reads(&[TIPS])
            .awaits("rods without shear, theory = \"shear-rigid\""),
        Case::new("cantilever::inextensible", SOURCE, inextensible)
            .reads(&[TIPS])
            .awaits("rods without shear and stretch, theory = \"inextensible\""),
    ]
}

pub const LENGTH: f64 = TAU;
pub const BENDING: f64 = 2.0;

/// The tips.
pub const TIPS: &str = "continuous/static_cantilever.csv";

/// Name of the row, α², where the tip is.
pub type Tip = (&'static str, f64, Exact);

/// α² in the file's words and as a number, and the tip, under the whole load.
pub fn tips(checks: &mut Checks) -> Result<[Tip; 3], Box<dyn Error>> {
    let table = checks.reference(TIPS)?;
    let exact = |words| {
        let row = table.row(&[("theory", "cosserat"), ("alpha_squared", words), ("factor", "1.0")])?;
        Exact::of(&row, LENGTH, 1e-10)
    };
    Ok([("10/9", 10.0 / 9.0, exact("10/9")?), ("5", 5.0, exact("5")?), ("10", 10.0, exact("10")?)])
}

/// The tip force.
pub fn force(alpha_squared: f64) -> f64 {
    alpha_squared * BENDING / LENGTH.powi(2)
}

fn scene(alpha_squared: f64, elements: usize, [axial, shear]: [f64; 2]) -> Scene {
    let section = Section::Custom {
        axial,
        shear_y: shear,
        shear_z: shear,
        torsion: 1.0,
        bending_y: BENDING,
        bending_z: BENDING,
        mass_per_length: None,
        rotary_inertia: None,
    };
    Scene {
        rod: vec![Rod::new("beam", line(LENGTH), section, None, elements, 4)],
        joint: vec![clamp("beam@0")],
        load: vec![load(LoadKind::Force, "beam@1", [0.0, force(alpha_squared), 0.0])],
        probe: vec![probe("tip", "beam@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

const STIFFNESS: [f64; 2] = [5.0, 1.0];

fn values(checks: &mut Checks) -> Outcome {
    for (words, alpha_squared, exact) in tips(checks)? {
        let name = format!("α² = {words}");
        check_tip(checks, &name, &|elements| scene(alpha_squared, elements, STIFFNESS), 32, &exact)?;
        let table = checks.reference(TIPS)?;
        let rows = table.select(&[("theory", "cosserat"), ("alpha_squared", words)])?;
        let title = format!("shear-soft cantilever, {name}");
        load_path(checks, &title, &scene(alpha_squared, 32, STIFFNESS), 1.0, rows, "factor")?;
    }
    Ok(())
}

/// Stiff instead of rigid: what is ruled out in the reference is P/S here, and the tip is off by less than twice L P/S.
fn constrained_theories(checks: &mut Checks) -> Outcome {
    const STIFF: f64 = 1e8;
    let table = checks.reference(TIPS)?;
    for (theory, words, alpha_squared, stiffness) in [
        ("shear-rigid", "10", 10.0, [5.0, STIFF]),
        ("inextensible", "10/3", 10.0 / 3.0, [STIFF; 2]),
        ("inextensible", "10", 10.0, [STIFF; 2]),
    ] {
        let row = table.row(&[("theory", theory), ("alpha_squared", words), ("factor", "1.0")])?;
        let rigid = Exact::of(&row, LENGTH, 1e-9)?;
        let strain = force(alpha_squared) / STIFF;
        let exact = Exact { digits: rigid.digits + 2.0 * LENGTH * strain, ..rigid };
        let name = format!("{theory}, α² = {words}");
        check_tip(checks, &name, &|elements| scene(alpha_squared, elements, stiffness), 32, &exact)?;
    }
    Ok(())
}

/// The tips of a theory, whose reference has that strain ruled out as well.
fn theory(checks: &mut Checks, theory: Theory, name: &str, loads: &[(&str, f64)]) -> Outcome {
    let table = checks.reference(TIPS)?;
    for &(words, alpha_squared) in loads {
        let row = table.row(&[("theory", name), ("alpha_squared", words), ("factor", "1.0")])?;
        let exact = Exact::of(&row, LENGTH, 1e-10)?;
        let scene = |elements| {
            let mut scene = scene(alpha_squared, elements, STIFFNESS);
            scene.rod[0].theory = theory;
            scene
        };
        check_tip(checks, &format!("{name}, α² = {words}"), &scene, 32, &exact)?;
    }
    Ok(())
}

fn shear_rigid(checks: &mut Checks) -> Outcome {
    theory(checks, Theory::ShearRigid, "shear-rigid", &[("10", 10.0)])
}

fn inextensible(checks: &mut Checks) -> Outcome {
    theory(checks, Theory::Inextensible, "inextensible", &[("10/3", 10.0 / 3.0), ("10", 10.0)])
}
