//! A body on a rod without inertia: an oscillator of two degrees of freedom in each plane.

use std::f64::consts::TAU;

use cosserat::scene::{Body, Dynamics, JointKind, LoadKind, Modes, Rod, Scene, Section};
use nalgebra::{Matrix2, Vector2};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load};
use crate::motion::{Recursion, follow, joint, place, vibrate};
use crate::pieces::line;
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "closed form: M ü + F⁻¹ u = f with the flexibility of a Timoshenko cantilever, L³/3EI + L/GA, L²/2EI, L/EI";
    vec![
        Case::new("massless_rod::frequencies", SOURCE, frequencies),
        Case::new("massless_rod::recursion", SOURCE, recursion),
        Case::new("massless_rod::order_in_time", SOURCE, order_in_time),
    ]
}

const LENGTH: f64 = 1.5;
const AXIAL: f64 = 900.0;
const SHEARS: [f64; 2] = [300.0, 200.0];
const TORSION: f64 = 2.0;
const BENDINGS: [f64; 2] = [4.0, 5.0];
const MASS: f64 = 0.8;
const INERTIA: [f64; 3] = [0.02, 0.03, 0.05];

fn scene() -> Scene {
    let section = Section::Custom {
        axial: AXIAL,
        shear_y: SHEARS[0],
        shear_z: SHEARS[1],
        torsion: TORSION,
        bending_y: BENDINGS[0],
        bending_z: BENDINGS[1],
        mass_per_length: None,
        rotary_inertia: None,
    };
    let mut rod = Rod::new("rod", line(LENGTH), section, None, 2, 4);
    rod.inertia = false;
    let body = Body {
        name: "bob".to_string(),
        shape: None,
        density: None,
        mass: Some(MASS),
        inertia: Some(INERTIA),
        position: [LENGTH, 0.0, 0.0],
        orientation: [1.0, 0.0, 0.0, 0.0],
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    };
    Scene {
        rod: vec![rod],
        body: vec![body],
        joint: vec![clamp("rod@0"), joint(JointKind::Rigid, "rod@1", "bob", None)],
        probe: vec![crate::measure::probe("bob", "bob")],
        ..Scene::default()
    }
}

/// ω² and, for a force 1 on the deflection, the deflection's share of each mode: w = Σ share · q, q̈ + ω² q = 1.
fn modes(shear: f64, bending: f64, inertia: f64) -> [(f64, f64); 2] {
    let l = LENGTH;
    let flexibility = Matrix2::new(
        l.powi(3) / (3.0 * bending) + l / shear,
        l * l / (2.0 * bending),
        l * l / (2.0 * bending),
        l / bending,
    );
    // With M^½ on both sides the problem is symmetric.
    let root = Matrix2::from_diagonal(&Vector2::new(MASS.sqrt(), inertia.sqrt()));
    let pairs = (root * flexibility * root).symmetric_eigen();
    let of = |k: usize| (1.0 / pairs.eigenvalues[k], pairs.eigenvectors[(0, k)].powi(2) / MASS);
    let mut modes = [of(0), of(1)];
    modes.sort_by(|a, b| a.0.total_cmp(&b.0));
    modes
}

/// Deflection along e_z with rotation about e_y, and along e_y with rotation about e_z.
fn planes() -> [[(f64, f64); 2]; 2] {
    [modes(SHEARS[1], BENDINGS[0], INERTIA[1]), modes(SHEARS[0], BENDINGS[1], INERTIA[2])]
}

fn frequencies(checks: &mut Checks) -> Outcome {
    let mut expected: Vec<f64> = planes().iter().flatten().map(|(square, _)| square.sqrt()).collect();
    expected.push((AXIAL / (MASS * LENGTH)).sqrt());
    expected.push((TORSION / (INERTIA[0] * LENGTH)).sqrt());
    expected.sort_by(f64::total_cmp);
    for placement in placements(LENGTH) {
        let solution = vibrate(&placement.apply(&Scene { modes: Some(Modes { count: 9 }), ..scene() }))?;
        checks.absolute(
            Kind::ClosedForm,
            format!("number of modes, {}", placement.name),
            (solution.modes.len() as f64, 6.0),
            0.0,
            "one body has six, and nothing else has inertia",
        );
        for (n, (mode, omega)) in solution.modes.iter().zip(&expected).enumerate() {
            checks.relative(
                Kind::ClosedForm,
                format!("ω{}, {}", n + 1, placement.name),
                (mode.angular_frequency, *omega),
                1e-10,
                "the deflection is cubic and the element of degree 4 exact; the flexibility is known to ε EA L²/EI p⁴, 1e-11",
            );
        }
    }
    Ok(())
}

/// A force that comes suddenly and stays; the deflection along e_z.
const FORCE: f64 = 1e-4;

fn sudden(steps: usize, end: f64) -> Scene {
    let mut scene = scene();
    scene.load.push(load(LoadKind::Force, "bob", [0.0, 0.0, FORCE]));
    scene.dynamics = Some(Dynamics::new(end, end / steps as f64));
    scene
}

/// Small motions follow the recursion of the method, mode by mode: the whole scheme, with multipliers, a rod without
/// inertia and a consistent start.
fn recursion(checks: &mut Checks) -> Outcome {
    let modes = planes()[0];
    let end = 3.0 * TAU / modes[0].0.sqrt();
    let deflection = FORCE * (LENGTH.powi(3) / (3.0 * BENDINGS[0]) + LENGTH / SHEARS[1]);
    for (spectral_radius, steps) in [(0.0, 100), (0.5, 100), (0.8, 100), (0.8, 1000)] {
        for placement in placements(LENGTH) {
            let mut scene = placement.apply(&sudden(steps, end));
            if let Some(options) = &mut scene.dynamics {
                options.spectral_radius = spectral_radius;
            }
            let solution = follow(&scene)?;
            let mut parts = modes.map(|(square, _)| Recursion::new(spectral_radius, square, 1.0));
            let (step, mut worst, mut largest) = (end / steps as f64, 0.0_f64, 0.0_f64);
            for row in 1..=steps {
                let moved =
                    parts.iter_mut().zip(modes).map(|(part, (_, share))| share * part.step(step, 1.0));
                let expected = FORCE * moved.sum::<f64>();
                let found = placement.undo_direction(place(&solution, row, 0) - place(&solution, 0, 0)).z;
                worst = worst.max((found - expected).abs());
                largest = largest.max(found);
            }
            let what = format!("ρ∞ = {spectral_radius}, {steps} steps, {}", placement.name);
            checks.below(
                Kind::ClosedForm,
                format!("deflection against the recursion, over the static one, {what}"),
                worst / deflection,
                1e-7,
                "(w/L)² = 2e-9 of geometry, over 3 periods 20 times; Newton's test leaves 1e-9 of the forces a step",
            );
            checks.absolute(
                Kind::ClosedForm,
                format!("largest deflection over the static one, {what}"),
                (largest / deflection, 2.0),
                0.02,
                "a sudden load deflects twice as far: 1 − cos ωt; the step misses the top by (ωh)²/8 = 5e-3, the second \
                 mode has less than 1 % of the deflection",
            );
        }
    }
    Ok(())
}

/// Amplitude and phase against the exact motion.
fn order_in_time(checks: &mut Checks) -> Outcome {
    let modes = planes()[0];
    let end = 2.3 * TAU / modes[0].0.sqrt();
    let exact: f64 = modes
        .iter()
        .map(|(square, share)| FORCE * share / square * (1.0 - (square.sqrt() * end).cos()))
        .sum();
    let slowest = modes[0].0.sqrt();
    let counts = [400, 800, 1600];
    let mut errors = Vec::new();
    for steps in counts {
        let solution = follow(&sudden(steps, end))?;
        errors.push(((place(&solution, steps, 0).z - place(&solution, 0, 0).z) / exact - 1.0).abs());
    }
    checks.order(
        "deflection after 2.3 periods",
        &counts,
        &errors,
        (2.0, 0.1),
        "order 2; the next term is smaller by ωh = 0.04, and what the second mode adds is damped or small",
    );
    checks.below(
        Kind::ClosedForm,
        "deflection after 2.3 periods, finest",
        errors[2],
        (slowest * end / 1600.0).powi(2) * slowest * end,
        "(ωh)² ωt: phase errors of second order methods are (ωh)²/12 to 5/12 of the angle",
    );
    Ok(())
}
