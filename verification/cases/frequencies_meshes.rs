//! What a mesh makes of the frequencies of straight rods: linear elements in closed form, orders for the others.

use std::f64::consts::{FRAC_PI_2, PI};

use cosserat::scene::{InterpolationKind, Modes};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies::{
    DENSITY, FILE, LENGTH, POISSON, YOUNG, bending, lowest, pinned, speeds, stocky_section, straight,
};
use crate::measure::clamp;
use crate::motion::frequencies;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "frequencies_meshes::linear",
            "dispersion of linear elements with one point and a consistent mass, closed form",
            linear,
        ),
        Case::new(
            "frequencies_meshes::orders",
            "Galerkin's eigenvalues converge with order 2p; Timoshenko's frequencies",
            orders,
        )
        .reads(&[FILE]),
    ]
}

const AREA: f64 = 0.1 * 0.2;
const SHEAR: f64 = YOUNG / (2.0 * (1.0 + POISSON));

/// ω of a bar of linear elements in a standing wave of wave number k: ω² = c² (6/h²) (1 − cos kh)/(2 + cos kh).
fn bar(speed: f64, k: f64, h: f64) -> f64 {
    let cosine = (k * h).cos();
    speed / h * (6.0 * (1.0 - cosine) / (2.0 + cosine)).sqrt()
}

/// The lower ω of a beam of linear elements, w = W sin kx and θ = Θ cos kx at the nodes.
///
/// With s = (2/h) sin(kh/2), c = cos(kh/2) and μ = (2 + cos kh)/3 the energies are those of
/// GA (s W − c Θ)² + EI s² Θ² and ω² μ (ρA W² + ρI Θ²), point after point of one-point quadrature.
fn beam(second: f64, k: f64, h: f64) -> f64 {
    let (s, c) = (2.0 / h * (k * h / 2.0).sin(), (k * h / 2.0).cos());
    let inertia = (2.0 + (k * h).cos()) / 3.0;
    let (a, b) = (SHEAR * AREA * s * s, SHEAR * AREA * s * c);
    let d = SHEAR * AREA * c * c + YOUNG * second * s * s;
    let (m, j) = (inertia * DENSITY * AREA, inertia * DENSITY * second);
    // (a − ω² m)(d − ω² j) = b²
    let half = 0.5 * (a / m + d / j);
    let product = (a * d - b * b) / (m * j);
    (product / (half + (half * half - product).sqrt())).sqrt()
}

const LINEAR: &str = "a closed form on both sides; ε (c p² n/L)²/ω², with 3.5 c n/L for the highest frequency 4e-12 at most, is rounding";

/// The nodal values of the waves solve the discrete equations, with R12 and with SE(3), which agree at first order
/// on a straight rod.
fn linear(checks: &mut Checks) -> Outcome {
    let [axial, torsional] = speeds();
    let seconds = [0.1 * 0.2_f64.powi(3) / 12.0, 0.2 * 0.1_f64.powi(3) / 12.0];
    for interpolation in [InterpolationKind::R12, InterpolationKind::Se3] {
        for elements in [1, 2, 5, 16] {
            let h = LENGTH / elements as f64;
            let what = format!("{interpolation:?}, {elements} elements");
            let mut clamped = straight(stocky_section(), elements, 1, vec![clamp("rod@0")], 6 * elements);
            clamped.rod[0].interpolation = interpolation;
            let found = frequencies(&clamped)?;
            let waves = (1..=elements.min(3)).map(|n| (2 * n - 1) as f64 * FRAC_PI_2 / LENGTH);
            let mut expected: Vec<(String, f64)> = Vec::new();
            for (n, k) in waves.enumerate() {
                expected.push((format!("axial {}, {what}", n + 1), bar(axial, k, h)));
                expected.push((format!("torsional {}, {what}", n + 1), bar(torsional, k, h)));
            }
            nearest(checks, &found, &expected);

            let mut hinged = straight(stocky_section(), elements, 1, pinned(), 6 * elements - 1);
            hinged.rod[0].interpolation = interpolation;
            if elements > 1 {
                let found = frequencies(&hinged)?;
                let mut expected: Vec<(String, f64)> = Vec::new();
                for n in 1..elements.min(5) {
                    let k = n as f64 * PI / LENGTH;
                    for (axis, second) in ["e_y", "e_z"].into_iter().zip(seconds) {
                        expected.push((format!("pinned about {axis}, n = {n}, {what}"), beam(second, k, h)));
                    }
                }
                nearest(checks, &found, &expected);
            }
        }
    }
    Ok(())
}

/// Every expected frequency is among those found.
fn nearest(checks: &mut Checks, found: &[f64], expected: &[(String, f64)]) {
    for (what, omega) in expected {
        let nearest = found.iter().copied().min_by(|a, b| (a - omega).abs().total_cmp(&(b - omega).abs()));
        let measured = nearest.unwrap_or(f64::NAN);
        checks.relative(Kind::ClosedForm, what.clone(), (measured, *omega), 1e-11, LINEAR);
    }
}

fn orders(checks: &mut Checks) -> Outcome {
    // The three lowest of the stocky cantilever: both bending planes, and the second mode of one.
    let planes =
        [bending(checks, "stocky", "cantilever", "e_y")?, bending(checks, "stocky", "cantilever", "e_z")?];
    let exact = lowest(&[&planes[0], &planes[1]], 3);
    let r12 = InterpolationKind::R12;
    let ladders: [(InterpolationKind, usize, [usize; 3]); 5] = [
        (r12, 1, [16, 32, 64]),
        (InterpolationKind::Se3, 1, [16, 32, 64]),
        (r12, 2, [8, 16, 32]),
        (r12, 3, [2, 4, 8]),
        (r12, 4, [1, 2, 4]),
    ];
    for (interpolation, degree, meshes) in ladders {
        let mut errors = [const { Vec::new() }; 3];
        for elements in meshes {
            let mut scene = straight(stocky_section(), elements, degree, vec![clamp("rod@0")], 3);
            scene.rod[0].interpolation = interpolation;
            scene.modes = Some(Modes { count: 3 });
            for ((errors, found), exact) in errors.iter_mut().zip(frequencies(&scene)?).zip(&exact) {
                errors.push((found / exact - 1.0).abs());
            }
        }
        // βL of the mode, and the factor of bending's eigenvalues against a bar's.
        for ((errors, wave), n) in errors.iter().zip([1.8751, 1.8751, 4.6941]).zip(1..) {
            let name = format!("ω{n}, {interpolation:?}, p = {degree}");
            checks.order(
                &name,
                &meshes,
                errors,
                (2.0 * degree as f64, 0.1),
                "the next term is smaller by (kh)², 0.1 at most: neighbouring orders stay apart",
            );
            let factorials: f64 = (1..=degree).map(|k| 1.0 / (degree + k) as f64).product();
            let finest = wave / meshes[2] as f64;
            checks.below(
                Kind::Order,
                name,
                errors[2],
                3.0 * finest.powi(2 * degree as i32) * factorials * factorials,
                "(kh)^{2p} [p!/(2p)!]² of a bar; bending is off in both of its derivatives, and its wave is \
                 shorter at the clamp: three times",
            );
        }
    }
    Ok(())
}
