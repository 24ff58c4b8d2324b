//! A straight cantilever under an end moment M = 2π n EI/L bends to n full turns, exactly, for any section.
//!
//! The moment about the fixed direction e_z is the same in both bases. Tip: (L/θ) (sin θ, 1 − cos θ, 0), θ = 2π n.

use std::f64::consts::{PI, TAU};

use cosserat::scene::{InterpolationKind, LoadKind, Rod, Scene, Statics};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, probe};
use crate::pieces::{circle, line, young_poisson};
use crate::placement::placements;
use crate::tip::{Exact, check_tip, tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("roll_up::closed_form", "closed form; Euler 1744", closed_form).slow(),
        Case::new("roll_up::se3", "closed form; Euler 1744", se3),
        Case::new("roll_up::linear_r12", "closed form of the discrete equations", linear_r12),
    ]
}

const LENGTH: f64 = 2.0;
const DIAMETER: f64 = 0.02;
const YOUNG: f64 = 2e9;
const TURNS: [f64; 5] = [0.125, 0.25, 1.0, 2.0, 10.0];

fn scene(turns: f64, interpolation: InterpolationKind, elements: usize, degree: usize) -> Scene {
    let bending = YOUNG * PI * DIAMETER.powi(4) / 64.0;
    let material = young_poisson(YOUNG, 0.3);
    let mut rod = Rod::new("beam", line(LENGTH), circle(DIAMETER), Some(material), elements, degree);
    rod.interpolation = interpolation;
    Scene {
        rod: vec![rod],
        joint: vec![clamp("beam@0")],
        load: vec![load(LoadKind::Moment, "beam@1", [0.0, 0.0, TAU * turns * bending / LENGTH])],
        probe: vec![probe("tip", "beam@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn exact(turns: f64) -> Exact {
    let angle = TAU * turns;
    Exact {
        tip: [LENGTH / angle * angle.sin(), LENGTH / angle * (1.0 - angle.cos()), 0.0],
        digits: 0.0,
        length: LENGTH,
        allowance: 1e-10,
    }
}

fn closed_form(checks: &mut Checks) -> Outcome {
    // Elements a turn such that halving them stays within the allowance: (θ_e/2p)^(2p), roughly.
    for (degree, per_turn) in [(3, 128.0), (4, 48.0), (6, 24.0), (8, 16.0)] {
        for turns in TURNS {
            let elements = 2 * (0.5_f64 * per_turn * turns).ceil() as usize;
            let name = format!("{turns} turns, degree {degree}");
            let scene = |elements| scene(turns, InterpolationKind::R12, elements, degree);
            check_tip(checks, &name, &scene, elements, &exact(turns))?;
        }
    }
    Ok(())
}

/// The strains of an element are constant: exact on any mesh whose elements turn by less than half a turn.
fn se3(checks: &mut Checks) -> Outcome {
    for turns in TURNS {
        let elements = 2 * (2.0 * turns).ceil() as usize + 2;
        let scene = |elements| scene(turns, InterpolationKind::Se3, elements, 1);
        let name = format!("{turns} turns, {elements} elements");
        check_tip(checks, &name, &scene, 2 * elements, &exact(turns))?;
    }
    Ok(())
}

/// The discrete equations of two-node R12 elements with one quadrature point, solved by hand.
///
/// At the middle A = ½ (A₀ + A₁) = cos(½θ) R, R the rotation half way: κ̄ = sin θ, so sin θ = M L/(EI N) in every one
/// of the N elements. n = 0 asks for Aᵀ r′ = h e_x, so every chord is h/cos(½θ) long, h = L/N.
fn linear_r12(checks: &mut Checks) -> Outcome {
    for (turns, elements) in [(0.125, 1), (0.25, 4), (1.0, 16), (2.0, 40), (10.0, 100)] {
        let theta = (TAU * turns / elements as f64).asin();
        let chord = LENGTH / elements as f64 / (0.5 * theta).cos();
        let mut discrete = [0.0; 3];
        for e in 0..elements {
            let (sin, cos) = ((e as f64 + 0.5) * theta).sin_cos();
            discrete[0] += chord * cos;
            discrete[1] += chord * sin;
        }
        for placement in placements(LENGTH) {
            let tip = tip(&scene(turns, InterpolationKind::R12, elements, 1), &placement)?;
            checks.vector(
                Kind::ClosedForm,
                format!("tip after {turns} turns, {elements} linear elements, {}", placement.name),
                (tip.into(), discrete),
                2e-9 * elements as f64 * LENGTH,
                "Newton stops when every node's moment is off by τ = 1e-9 of what acts there, 2 M, or less: a bending \
                 moment off by 2 N τ M moves the tip by up to 2 N τ L",
            );
        }
    }
    Ok(())
}
