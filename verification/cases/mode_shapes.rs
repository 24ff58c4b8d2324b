//! The shapes of modes at probes: on nodes, between them, and at levers.

use std::f64::consts::FRAC_PI_2;

use cosserat::scene::{Modes, Scene};
use cosserat::solution::Mode;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies::{LENGTH, POISSON, speeds, stocky_section, straight};
use crate::measure::{clamp, probe};
use crate::motion::vibrate;
use crate::pieces::rectangle;
use crate::placement::{Placement, placements};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "mode_shapes::bending",
            "Euler–Bernoulli: cosh βx − cos βx − σ (sinh βx − sin βx), βL = 1.87510407, 4.69409113",
            bending,
        ),
        Case::new("mode_shapes::axial_and_torsional", "closed form: sin((2n − 1)πx/2L)", axial_and_torsional),
        Case::new("mode_shapes::levers", "a rigid lever: u + θ × A s", levers),
    ]
}

/// Height of the strip [m]; it bends across it first.
const HEIGHT: f64 = 1e-3;
/// No node of four elements of degree 8 lies at 0.37 or 0.81.
const PLACES: [f64; 5] = [0.25, 0.37, 0.5, 0.81, 1.0];

fn with_probes(mut scene: Scene, count: usize) -> Scene {
    scene.probe = PLACES.iter().map(|xi| probe(&format!("p{xi}"), &format!("rod@{xi}"))).collect();
    scene.modes = Some(Modes { count });
    scene
}

/// Displacement and rotation of a probe in the axes of the scene before it was placed.
fn amplitudes(mode: &Mode, index: usize, placement: &Placement) -> [Vector3<f64>; 2] {
    let [x, y, z, a, b, c] = mode.shape[index];
    [Vector3::new(x, y, z), Vector3::new(a, b, c)].map(|v| placement.undo_direction(v))
}

/// φ and φ′ of a clamped beam of length 1.
fn clamped(beta: f64, x: f64) -> [f64; 2] {
    let sigma = (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin());
    let z = beta * x;
    [
        z.cosh() - z.cos() - sigma * (z.sinh() - z.sin()),
        beta * (z.sinh() + z.sin() - sigma * (z.cosh() - z.cos())),
    ]
}

fn bending(checks: &mut Checks) -> Outcome {
    let scene = with_probes(straight(rectangle(0.02, HEIGHT, None), 4, 8, vec![clamp("rod@0")], 1), 2);
    for placement in placements(LENGTH) {
        let solution = vibrate(&placement.apply(&scene))?;
        for (n, (mode, beta)) in solution.modes.iter().zip([1.8751040687, 4.6940911330]).enumerate() {
            let slender = (beta * HEIGHT / LENGTH).powi(2) / 12.0 * (1.0 + 2.0 * (1.0 + POISSON));
            let [tip, _] = amplitudes(mode, PLACES.len() - 1, &placement);
            let size = tip.z / clamped(beta, 1.0)[0];
            for (index, xi) in PLACES.into_iter().enumerate() {
                let [u, theta] = amplitudes(mode, index, &placement);
                let [phi, slope] = clamped(beta, xi);
                // e_y turns e_z against e_x: w′ = −θ_y.
                let pairs = [
                    ("deflection", u / size, Vector3::new(0.0, 0.0, phi)),
                    ("rotation", theta / (size * beta), Vector3::new(0.0, -slope / beta, 0.0)),
                ];
                for (what, measured, expected) in pairs {
                    checks.vector(
                        Kind::ClosedForm,
                        format!("mode {}, {what} at ξ = {xi}, {}", n + 1, placement.name),
                        (measured.into(), expected.into()),
                        10.0 * slender + 1e-6,
                        "shear and rotary inertia, (β h/L)²/12 (1 + E/G) of the amplitude 2, five times in the \
                         second mode; rounding ε (c p² n/L)²/ω², 1e-6, of the thin strip",
                    );
                }
            }
        }
    }
    Ok(())
}

fn axial_and_torsional(checks: &mut Checks) -> Outcome {
    let scene = with_probes(straight(stocky_section(), 4, 8, vec![clamp("rod@0")], 1), 6);
    for placement in placements(LENGTH) {
        let solution = vibrate(&placement.apply(&scene))?;
        let [axial, torsional] = speeds();
        for (what, omega, part) in
            [("axial", axial * FRAC_PI_2 / LENGTH, 0), ("torsional", torsional * FRAC_PI_2 / LENGTH, 1)]
        {
            let Some(mode) =
                solution.modes.iter().find(|mode| (mode.angular_frequency / omega - 1.0).abs() < 1e-6)
            else {
                return Err(format!("no {what} mode").into());
            };
            for (index, xi) in PLACES.into_iter().enumerate() {
                let found = amplitudes(mode, index, &placement);
                let expected = Vector3::new((FRAC_PI_2 * xi).sin(), 0.0, 0.0);
                let sign = amplitudes(mode, PLACES.len() - 1, &placement)[part].x.signum();
                for (k, name) in ["displacement", "rotation"].into_iter().enumerate() {
                    let expected = if k == part { expected } else { Vector3::zeros() };
                    let size = amplitudes(mode, PLACES.len() - 1, &placement)[part].norm() * sign;
                    checks.vector(
                        Kind::ClosedForm,
                        format!("{what} mode, {name} at ξ = {xi}, {}", placement.name),
                        ((found[k] / size).into(), expected.into()),
                        1e-8,
                        "(kh)^8 8!/16! of a shape of degree 8, 1e-11; a shape is known to ε ω_max²/(ω gap), 1e-9",
                    );
                }
            }
            let largest =
                mode.shape.iter().flatten().fold(0.0_f64, |a, x| if x.abs() > a.abs() { *x } else { a });
            checks.absolute(
                Kind::Invariant,
                format!("{what} mode, largest number, {}", placement.name),
                (largest, 1.0),
                4.0 * f64::EPSILON,
                "shapes are scaled to it",
            );
        }
    }
    Ok(())
}

fn levers(checks: &mut Checks) -> Outcome {
    let mut scene = with_probes(straight(stocky_section(), 4, 8, vec![clamp("rod@0")], 1), 6);
    let lever = Vector3::new(0.3, -0.2, 0.5);
    for xi in PLACES {
        let mut off = probe(&format!("off{xi}"), &format!("rod@{xi}"));
        off.offset = Some(lever.into());
        scene.probe.push(off);
    }
    for placement in placements(LENGTH) {
        let solution = vibrate(&placement.apply(&scene))?;
        let mut worst = 0.0_f64;
        let mut turned = 0.0_f64;
        for mode in &solution.modes {
            for index in 0..PLACES.len() {
                let [u, theta] = amplitudes(mode, index, &placement);
                let [off, same] = amplitudes(mode, PLACES.len() + index, &placement);
                worst = worst.max((off - u - theta.cross(&lever)).norm()).max((same - theta).norm());
                turned = turned.max((off - u).norm());
            }
        }
        checks.below(
            Kind::Invariant,
            format!("u + θ × A s, {}", placement.name),
            worst,
            1e-14,
            "the same numbers, multiplied out: 45 ε",
        );
        checks.above(
            Kind::Invariant,
            format!("what the lever adds, {}", placement.name),
            turned,
            0.1,
            "rotations are of the order of deflections over the length, and one is 1",
        );
    }
    Ok(())
}
