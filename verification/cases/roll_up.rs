//! A straight cantilever under an end moment M = 2π n EI/L bends to n full turns, exactly, for any section.
//!
//! The moment about the fixed direction e_z is the same in both bases. Tip: (L/θ) (sin θ, 1 − cos θ, 0), θ = 2π n.

use std::f64::consts::TAU;

use cosserat::scene::{CurveShape, LoadKind, Material, Rod, Scene, Section, Statics};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, position, probe, solve};
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case { name: "roll_up::closed_form", source: "closed form; Euler 1744", run: closed_form }]
}

const LENGTH: f64 = 2.0;
const DIAMETER: f64 = 0.02;
const YOUNG: f64 = 2e9;

fn scene(turns: f64, elements: usize, degree: usize) -> Scene {
    let bending = YOUNG * std::f64::consts::PI * DIAMETER.powi(4) / 64.0;
    let section = Section::Circle {
        diameter: DIAMETER,
        inner_diameter: None,
        shear_factor: 1.0,
        torsion_constant: None,
    };
    let line = CurveShape::Line { length: Some(LENGTH), from: None, to: None, normal: None };
    let material = Material { young_modulus: Some(YOUNG), poisson_ratio: Some(0.3), ..Material::default() };
    Scene {
        rod: vec![Rod::new("beam", line, section, Some(material), elements, degree)],
        joint: vec![clamp("beam@0")],
        load: vec![load(LoadKind::Moment, "beam@1", [0.0, 0.0, TAU * turns * bending / LENGTH])],
        probe: vec![probe("tip", "beam@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn closed_form(checks: &mut Checks) -> Outcome {
    for turns in [0.125, 0.25, 1.0, 2.0, 10.0] {
        let angle = TAU * turns;
        let exact = [LENGTH / angle * angle.sin(), LENGTH / angle * (1.0 - angle.cos()), 0.0];
        let elements = if turns < 5.0 { 12 } else { 40 };
        for placement in placements(LENGTH) {
            let solution = solve(&placement.apply(&scene(turns, elements, 6)))?;
            let tip = position(&solution, 0, &placement)?;
            checks.vector(
                Kind::ClosedForm,
                format!("tip after {turns} turns, {}", placement.name),
                (tip.into(), exact),
                1e-9 * LENGTH,
                "PLACEHOLDER: derive",
            );
        }
    }
    Ok(())
}
