//! Line loads and gravity on a straight cantilever, where the deflection has a closed form.

use cosserat::scene::{Basis, CurveShape, Load, LoadKind, Rod, Scene, Section, Statics};
use nalgebra::{Vector3, Vector4};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, displacement, load, probe, solve};
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "loads::line_force",
            "Timoshenko's cantilever: w L⁴/(8 EI) + w L²/(2 GA); axially w L²/(2 EA)",
            line_force,
        ),
        Case::new(
            "loads::line_moment",
            "closed form: EI θ′ = c (L − s), tip ∫ (cos θ, sin θ) ds; torsion c L²/(2 GI_p)",
            line_moment,
        ),
    ]
}

const LENGTH: f64 = 2.0;
const AXIAL: f64 = 1e4;
const SHEAR: [f64; 2] = [3e3, 4e3];
const TORSION: f64 = 1.3;
/// About e_y, e_z.
const BENDING: [f64; 2] = [1.0, 2.0];
const MASS: f64 = 0.7;

fn cantilever(load: Option<Load>) -> Scene {
    let line = CurveShape::Line { length: Some(LENGTH), from: None, to: None, normal: None };
    let section = Section::Custom {
        axial: AXIAL,
        shear_y: SHEAR[0],
        shear_z: SHEAR[1],
        torsion: TORSION,
        bending_y: BENDING[0],
        bending_z: BENDING[1],
        mass_per_length: Some(MASS),
        rotary_inertia: None,
    };
    Scene {
        rod: vec![Rod::new("beam", line, section, None, 8, 6)],
        joint: vec![clamp("beam@0")],
        load: load.into_iter().collect(),
        probe: vec![probe("tip", "beam@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn line(kind: LoadKind, value: Vector3<f64>, basis: Basis) -> Scene {
    cantilever(Some(Load { basis, ..load(kind, "beam", value.into()) }))
}

fn tips(scene: &Scene, mut check: impl FnMut(Vector3<f64>, &str)) -> Outcome {
    for placement in placements(LENGTH) {
        let solution = solve(&placement.apply(scene))?;
        check(displacement(&solution, 0, &placement)?, placement.name);
    }
    Ok(())
}

/// Small transverse loads in both bases and as weight, an axial one of any size.
fn line_force(checks: &mut Checks) -> Outcome {
    let small = "(δ/L)² = 1e-10 from the non-linear terms, and τ = 1e-9 of the load with a factor of ten for the \
                 sum of the nodal residuals";
    for (direction, bending, shear) in
        [(Vector3::y(), BENDING[1], SHEAR[0]), (Vector3::z(), BENDING[0], SHEAR[1])]
    {
        let w = 1e-5 * 8.0 * bending / LENGTH.powi(3);
        let exact = w * LENGTH.powi(4) / (8.0 * bending) + w * LENGTH.powi(2) / (2.0 * shear);
        let mut weight = cantilever(None);
        weight.gravity = Some((direction * (w / MASS)).into());
        for (name, scene) in [
            ("inertial", line(LoadKind::LineForce, direction * w, Basis::Inertial)),
            ("body", line(LoadKind::LineForce, direction * w, Basis::Body)),
            ("weight", weight),
        ] {
            tips(&scene, |tip, place| {
                let pair = (tip.dot(&direction), exact);
                checks.relative(Kind::ClosedForm, format!("deflection, {name}, {place}"), pair, 1e-8, small);
                let aside = (tip.norm_squared() - pair.0 * pair.0).max(0.0).sqrt();
                let reason = "the shortening ∫ ½ w′² is of size δ²/L = 1e-5 δ";
                checks.below(
                    Kind::ClosedForm,
                    format!("aside, {name}, {place}"),
                    aside,
                    1e-5 * exact,
                    reason,
                );
            })?;
        }
    }
    // No more: a load that follows the rod has a transverse response that grows like exp ∫ √(w (L − s)/EI) ds, 70 here.
    let w = 5.0;
    let exact = w * LENGTH.powi(2) / (2.0 * AXIAL);
    for basis in [Basis::Inertial, Basis::Body] {
        tips(&line(LoadKind::LineForce, Vector3::x() * w, basis), |tip, place| {
            let reason = "linear at any size; τ = 1e-9 of the load, a factor of ten for the sum of the nodal residuals";
            let exact = [exact, 0.0, 0.0];
            checks.vector(
                Kind::ClosedForm,
                format!("extension, {basis:?}, {place}"),
                (tip.into(), exact),
                1e-8 * exact[0],
                reason,
            );
        })?;
    }
    Ok(())
}

/// Moments about a fixed direction are the same in both bases. About e_z the rod bends to a part of Euler's spiral
/// without any force, θ(s) = c (L s − ½ s²)/EI, here by 2.5 rad; about e_x it is twisted.
fn line_moment(checks: &mut Checks) -> Outcome {
    let turn = 2.5;
    // Simpson's rule on 2000 intervals: h⁴ θ′⁴ L/180 < 1e-12.
    let spiral = |along: fn(f64) -> f64| {
        let n = 2000;
        let value = |k: usize| {
            let s = k as f64 / n as f64;
            along(turn * (2.0 * s - s * s))
        };
        let weight = |k: usize| {
            if k == 0 || k == n { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 }
        };
        LENGTH * (0..=n).map(|k| weight(k) * value(k)).sum::<f64>() / (3.0 * n as f64)
    };
    let (x, y) = (spiral(f64::cos) - LENGTH, spiral(f64::sin));
    let reason =
        "(κh)^{2p} = (5/8)^{12} = 4e-3 with a constant p!²/(2p)!² of 2e-12 leaves τ = 1e-9 of the load";
    for basis in [Basis::Inertial, Basis::Body] {
        for (k, exact) in [(2, [x, y, 0.0]), (1, [x, 0.0, -y])] {
            let c = turn * 2.0 * BENDING[k - 1] / LENGTH.powi(2);
            let scene = line(LoadKind::LineMoment, Vector3::ith(k, c), basis);
            tips(&scene, |tip, place| {
                checks.vector(
                    Kind::ClosedForm,
                    format!("tip, moment about axis {k}, {basis:?}, {place}"),
                    (tip.into(), exact),
                    1e-8 * LENGTH,
                    reason,
                );
            })?;
        }
        let c = turn * 2.0 * TORSION / LENGTH.powi(2);
        for placement in placements(LENGTH) {
            let solution = solve(&placement.apply(&line(LoadKind::LineMoment, Vector3::x() * c, basis)))?;
            let [first, last] = [solution.rows.first(), solution.rows.last()]
                .map(|row| row.map(|row| Vector4::from(row.probes[0].quaternion)).unwrap_or_default());
            // The scalar product of unit quaternions is the cosine of half the angle.
            checks.absolute(
                Kind::ClosedForm,
                format!("cosine of half the twist, {basis:?}, {}", placement.name),
                (first.dot(&last).abs(), (0.5 * turn).cos().abs()),
                1e-8,
                reason,
            );
        }
    }
    Ok(())
}
