//! A straight rod bent and twisted to a helix of two coils by an end moment that turns with the last cross-section.
//!
//! All strains are constant, so the helix is exact for any section: κ = (2πn)² R/L² · (c, 0, 1), c = h/(2πnR),
//! L = 2πnR √(1 + c²) (Harsch, Sailer & Eugster 2023, section 5.3).

use std::f64::consts::{PI, TAU};

use cosserat::scene::{Basis, CurveShape, InterpolationKind, LoadKind, Rod, Scene, Statics};

use super::static_rods::load_path;
use crate::case::{Case, Checks, Outcome};
use crate::measure::{clamp, load, probe};
use crate::pieces::{circle, young_shear};
use crate::tip::{Exact, check_tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "closed form; Harsch, Sailer & Eugster 2023";
    vec![
        Case::new("straight_to_helix::r12", SOURCE, r12),
        Case::new("straight_to_helix::se3", SOURCE, se3),
        Case::new(
            "straight_to_helix::pulled",
            "the continuous equations, scripts/references/static_rods.py",
            pulled,
        )
        .reads(&[PULLED]),
    ]
}

const COILS: f64 = 2.0;
const RADIUS: f64 = 10.0;
const HEIGHT: f64 = 50.0;
const YOUNG: f64 = 1.0;
const SHEAR: f64 = 0.5;

/// c, the tangent of the pitch angle.
fn slope() -> f64 {
    HEIGHT / (TAU * COILS * RADIUS)
}

fn length() -> f64 {
    (1.0 + slope().powi(2)).sqrt() * TAU * COILS * RADIUS
}

fn scene(slenderness: f64, interpolation: InterpolationKind, elements: usize, degree: usize) -> Scene {
    let (c, length) = (slope(), length());
    let start = [0.0, -RADIUS, 0.0];
    let along = length / (1.0 + c * c).sqrt();
    let line = CurveShape::Line {
        length: None,
        from: Some(start),
        to: Some([along, -RADIUS, c * along]),
        normal: Some([0.0, 1.0, 0.0]),
    };
    let diameter = length / slenderness;
    let second_moment = PI * diameter.powi(4) / 64.0;
    let curvature = RADIUS * (TAU * COILS / length).powi(2);
    let mut rod = Rod::new("rod", line, circle(diameter), Some(young_shear(YOUNG, SHEAR)), elements, degree);
    rod.interpolation = interpolation;
    let twisting = SHEAR * 2.0 * second_moment * curvature * c;
    let bending = YOUNG * second_moment * curvature;
    let mut moment = load(LoadKind::Moment, "rod@1", [twisting, 0.0, bending]);
    moment.basis = Basis::Body;
    Scene {
        rod: vec![rod],
        joint: vec![clamp("rod@0")],
        load: vec![moment],
        probe: vec![probe("tip", "rod@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn check(
    checks: &mut Checks,
    interpolation: InterpolationKind,
    (elements, degree): (usize, usize),
) -> Outcome {
    for slenderness in [1e1, 1e2, 1e3, 1e4] {
        let exact = Exact { tip: [0.0, -RADIUS, HEIGHT], digits: 0.0, length: length(), allowance: 1e-10 };
        let name = format!("slenderness {slenderness:.0e}, degree {degree}");
        let scene = |elements| scene(slenderness, interpolation, elements, degree);
        check_tip(checks, &name, &scene, elements, &exact)?;
    }
    Ok(())
}

fn r12(checks: &mut Checks) -> Outcome {
    check(checks, InterpolationKind::R12, (64, 4))?;
    check(checks, InterpolationKind::R12, (32, 6))
}

/// The strains of an element are constant: exact on any mesh.
fn se3(checks: &mut Checks) -> Outcome {
    // More than four, so that an element turns by less than half a turn.
    for elements in [10, 16, 80] {
        check(checks, InterpolationKind::Se3, (elements, 1))?;
    }
    Ok(())
}

const PULLED: &str = "continuous/static_two_coils.csv";

/// With a dead tip force on top there is no closed form: the last section turns by more than two turns under it.
fn pulled(checks: &mut Checks) -> Outcome {
    let table = checks.reference(PULLED)?;
    for (words, slenderness) in [("100.0", 1e2), ("10000.0", 1e4)] {
        let diameter = length() / slenderness;
        let unit = YOUNG * PI * diameter.powi(4) / 64.0 / length().powi(2);
        let scene = |elements| {
            let mut scene = scene(slenderness, InterpolationKind::R12, elements, 6);
            let force = [2.0, -6.0, 9.0].map(|share| share * unit);
            scene.load.push(load(LoadKind::Force, "rod@1", force));
            scene
        };
        let row = table.row(&[("slenderness", words), ("factor", "1.0")])?;
        let exact = Exact::of(&row, length(), 1e-10)?;
        let name = format!("with a force, slenderness {words}");
        check_tip(checks, &name, &scene, 48, &exact)?;
        let title = format!("two coils by a body end moment and a dead force, slenderness {words}");
        load_path(checks, &title, &scene(48), 1.0, table.select(&[("slenderness", words)])?, "factor")?;
    }
    Ok(())
}
