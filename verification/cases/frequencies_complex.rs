//! The unsymmetric stiffness of coarse curved meshes gives complex ω² for some pairs; they turn real on refinement.

use cosserat::scene::{CurveShape, InterpolationKind, Modes, Rod, Scene};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies::steel;
use crate::measure::clamp;
use crate::motion::vibrate;
use crate::pieces::circle;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new(
        "frequencies_complex::clamped_helix",
        "an elastic rod about its stress-free shape has real frequencies only",
        clamped_helix,
    )]
}

/// Two coils of a thick wire, clamped at one end.
fn helix(interpolation: InterpolationKind, elements: usize, degree: usize) -> Scene {
    let curve = CurveShape::Helix { coils: 2.0, radius: 1.0, pitch: 0.5, phase: 0.0 };
    let mut rod = Rod::new("rod", curve, circle(0.1), Some(steel()), elements, degree);
    rod.interpolation = interpolation;
    Scene {
        rod: vec![rod],
        joint: vec![clamp("rod@0")],
        modes: Some(Modes { count: 12 }),
        ..Scene::default()
    }
}

fn clamped_helix(checks: &mut Checks) -> Outcome {
    let exact: Vec<f64> = vibrate(&helix(InterpolationKind::R12, 8, 8))?
        .modes
        .iter()
        .map(|mode| mode.angular_frequency)
        .collect();
    let r12 = InterpolationKind::R12;
    for (interpolation, degree, coarse, fine) in
        [(r12, 1, 16, 128), (InterpolationKind::Se3, 1, 8, 128), (r12, 2, 6, 32)]
    {
        let said = |elements: usize| -> Result<f64, Box<dyn std::error::Error>> {
            let solution = vibrate(&helix(interpolation, elements, degree))?;
            Ok(solution.warnings.iter().filter(|warning| warning.contains("complex frequencies")).count()
                as f64)
        };
        let what = format!("{interpolation:?}, p = {degree}");
        checks.above(
            Kind::Invariant,
            format!("complex pairs that are reported, {what}, {coarse} elements"),
            said(coarse)?,
            1.0,
            "elements that span 45° or more are off by tens of per cent, also in their symmetry",
        );
        checks.absolute(
            Kind::Invariant,
            format!("complex pairs that are reported, {what}, {fine} elements"),
            (said(fine)?, 0.0),
            0.0,
            "no two of these frequencies are closer than the errors of the mesh: nothing can pair up",
        );
        let solution = vibrate(&helix(interpolation, fine, degree))?;
        // The twelfth mode has about three waves over 4π: k R = 3, h = 4π/n.
        let h = 4.0 * std::f64::consts::PI / fine as f64;
        let worst = solution
            .modes
            .iter()
            .zip(&exact)
            .map(|(mode, exact)| (mode.angular_frequency / exact - 1.0).abs());
        checks.below(
            Kind::Order,
            format!("the twelve lowest against 8 elements of degree 8, {what}, {fine} elements"),
            worst.fold(0.0, f64::max),
            (3.0 * h).powi(2 * degree as i32) / if degree == 1 { 4.0 } else { 144.0 },
            "(kh)^{2p} [p!/(2p)!]² with three waves in a turn",
        );
    }
    Ok(())
}
