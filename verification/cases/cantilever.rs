//! Straight shear-soft cantilever under a dead tip force P = α² EI/L² across it: finite stretch and shear.
//!
//! L = 2π, EA = 5, GA = 1, EI = 2: strains are so large that a wrong γ shows in the second digit.

use std::f64::consts::TAU;

use cosserat::scene::{LoadKind, Rod, Scene, Section, Statics};

use crate::case::{Case, Checks, Outcome};
use crate::measure::{clamp, load, probe};
use crate::pieces::line;
use crate::tip::{Exact, check_tip, half_digit};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new(
        "cantilever::values",
        "the continuous equations (elliptic integrals with stretch and shear), see continuous::published_tips",
        values,
    )]
}

pub const LENGTH: f64 = TAU;
pub const BENDING: f64 = 2.0;

/// α², and (x, deflection)/L of the tip.
pub const TIPS: [(f64, [f64; 2]); 3] = [
    (10.0 / 9.0, [0.921_189_562_7, 0.374_765_827_1]),
    (5.0, [0.574_675_308_5, 0.829_423_259_9]),
    (10.0, [0.394_214_876_9, 1.009_158_306_0]),
];

/// The tip force.
pub fn force(alpha_squared: f64) -> f64 {
    alpha_squared * BENDING / LENGTH.powi(2)
}

fn scene(alpha_squared: f64, elements: usize) -> Scene {
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
    Scene {
        rod: vec![Rod::new("beam", line(LENGTH), section, None, elements, 4)],
        joint: vec![clamp("beam@0")],
        load: vec![load(LoadKind::Force, "beam@1", [0.0, force(alpha_squared), 0.0])],
        probe: vec![probe("tip", "beam@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn values(checks: &mut Checks) -> Outcome {
    for (alpha_squared, [x, y]) in TIPS {
        let exact = Exact {
            tip: [LENGTH * x, LENGTH * y, 0.0],
            digits: half_digit(1e-10) * LENGTH,
            length: LENGTH,
            allowance: 1e-10,
        };
        let name = format!("α² = {alpha_squared:.3}");
        check_tip(checks, &name, &|elements| scene(alpha_squared, elements), 32, &exact)?;
    }
    Ok(())
}
