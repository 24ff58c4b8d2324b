//! A hyperelastic rod under dead and body-fixed end loads forgets how it got there: increments, the iteration and
//! the unknowns of the linear systems are means, and the end is the same.

use std::error::Error;
use std::f64::consts::FRAC_PI_4;

use cosserat::scene::{
    Basis, Coordinates, CurveShape, Joint, JointKind, LoadKind, NewtonKind, Rod, Scene, Statics,
};
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, position, probe, solve};
use crate::pieces::{circle, line, rectangle, young_poisson};
use crate::placement::{Placement, placements};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("path_independence::spring", "helical spring of section 4.1, wire end at 2 N", |checks| {
            compare(checks, &spring(), &SPRING)
        })
        .slow(),
        Case::new("path_independence::bend", "45° bend (Bathe & Bolourchi 1979) at 600", |checks| {
            compare(checks, &bend(), &BEND)
        }),
        Case::new(
            "path_independence::hinged",
            "a rod between a revolute and a spherical joint, both off its nodes, with levers on its loads",
            |checks| compare(checks, &hinged(), &HINGED),
        ),
    ]
}

/// How far two converged answers can be apart.
struct Bounds {
    name: &'static str,
    /// A length of the scene.
    size: f64,
    /// Absolute tolerance of the residual, where that is the sharper test.
    tolerance: Option<f64>,
    position: f64,
    rotation: f64,
    reason: &'static str,
}

const SPRING: Bounds = Bounds {
    name: "spring",
    size: 0.1,
    tolerance: None,
    position: 1e-9,
    rotation: 1e-7,
    reason: "the test leaves τ = 1e-9 of the nodal moment contributions, Σ|N′| 2 F R = 0.16 N m, at 151 nodes; of random \
             sign and times L/EI = 128 rad/(N m), ½ on average, 1e-7 rad, and 1e-9 m at the arm R",
};

const BEND: Bounds = Bounds {
    name: "bend",
    size: 100.0,
    tolerance: Some(1e-7),
    position: 1e-7,
    rotation: 2e-9,
    reason: "residuals of 1e-7 at 25 nodes, of random sign: 5e-7 L³/(3 EI) = 1e-7 and 5e-7 L²/(2 EI) = 2e-9",
};

const HINGED: Bounds = Bounds {
    name: "hinged rod",
    size: 2.0,
    tolerance: Some(1e-8),
    position: 2e-9,
    rotation: 2e-9,
    reason: "residuals of 1e-8 at 25 nodes, of random sign: 5e-8 L/(4 EI) = 2e-9 rad between the two joints, 1e-9 of \
             the length at arms of a metre",
};

fn spring() -> Scene {
    let helix = CurveShape::Helix { coils: 10.0, radius: 0.01, pitch: 0.005, phase: 0.0 };
    Scene {
        rod: vec![Rod::new("wire", helix, circle(1e-3), Some(young_poisson(1e11, 0.2)), 75, 2)],
        joint: vec![clamp("wire@0")],
        load: vec![load(LoadKind::Force, "wire@1", [0.0, 0.0, 2.0])],
        probe: vec![probe("end", "wire@1"), probe("middle", "wire@0.5")],
        ..Scene::default()
    }
}

fn bend() -> Scene {
    let arc = CurveShape::Arc { radius: 100.0, angle: FRAC_PI_4 };
    Scene {
        rod: vec![Rod::new("bend", arc, rectangle(1.0, 1.0, None), Some(young_poisson(1e7, 0.0)), 8, 3)],
        joint: vec![clamp("bend@0")],
        load: vec![load(LoadKind::Force, "bend@1", [0.0, 0.0, 600.0])],
        probe: vec![probe("end", "bend@1"), probe("middle", "bend@0.5")],
        ..Scene::default()
    }
}

fn hinged() -> Scene {
    let joint = |kind, on: &str, point, axis| Joint {
        name: None,
        kind,
        between: ["ground".to_string(), on.to_string()],
        point: Some(point),
        axis,
    };
    let mut push = load(LoadKind::Force, "rod@0.5", [-3.0, 9.0, 4.0]);
    push.offset = Some([0.1, 0.15, -0.2]);
    let mut follow = load(LoadKind::Force, "rod@1", [-2.0, 1.0, 6.0]);
    (follow.basis, follow.offset) = (Basis::Body, Some([0.0, -0.1, 0.1]));
    let mut twist = load(LoadKind::Moment, "rod@0.5", [1.5, 0.0, 0.8]);
    twist.basis = Basis::Body;
    Scene {
        rod: vec![Rod::new("rod", line(2.0), circle(0.04), Some(young_poisson(1e8, 0.3)), 8, 3)],
        joint: vec![
            joint(JointKind::Revolute, "rod@0", [-0.1, 0.05, 0.2], Some([0.3, 1.0, -0.6])),
            joint(JointKind::Spherical, "rod@1", [2.1, -0.1, 0.15], None),
        ],
        load: vec![push, follow, twist, load(LoadKind::LineForce, "rod", [0.0, -3.0, 2.0])],
        probe: vec![probe("end", "rod@1"), probe("middle", "rod@0.5")],
        ..Scene::default()
    }
}

/// How a scene is solved.
fn ways() -> Vec<(&'static str, Statics)> {
    let way =
        |increments, newton, coordinates| Statics { increments, newton, coordinates, ..Statics::default() };
    use Coordinates::{Increments, Quaternions};
    use NewtonKind::{Displacement, Mixed};
    vec![
        ("10 increments", way(Some(10), Mixed, Increments)),
        ("8 increments", way(Some(8), Mixed, Increments)),
        ("500 increments", way(Some(500), Mixed, Increments)),
        ("automatic", way(None, Mixed, Increments)),
        ("automatic, plain", way(None, Displacement, Increments)),
        ("500 increments, plain", way(Some(500), Displacement, Increments)),
        ("10 increments, 7N", way(Some(10), Mixed, Quaternions)),
        ("automatic, 7N", way(None, Mixed, Quaternions)),
        ("automatic, plain, 7N", way(None, Displacement, Quaternions)),
    ]
}

/// Where a probe is, and its quaternion.
type End = (Vector3<f64>, Vector4<f64>);

/// Both probes in the axes of the scene before it was placed.
fn ends(scene: &Scene, placement: &Placement) -> Result<Vec<End>, Box<dyn Error>> {
    let solution = solve(&placement.apply(scene))?;
    (0..2)
        .map(|index| {
            let last = solution.rows.last().ok_or("no rows")?;
            let [w, x, y, z] = last.probes[index].quaternion;
            let turned = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
            let q = placement.rotation.inverse() * turned;
            Ok((position(&solution, index, placement)?, Vector4::new(q.w, q.i, q.j, q.k)))
        })
        .collect()
}

/// Every way and place against the first.
fn compare(checks: &mut Checks, scene: &Scene, bounds: &Bounds) -> Outcome {
    let mut first = None;
    for placement in placements(bounds.size) {
        for (way, statics) in ways() {
            let statics = Statics { tolerance: bounds.tolerance, ..statics };
            let scene = Scene { statics: Some(statics), ..scene.clone() };
            let found =
                ends(&scene, &placement).map_err(|error| format!("{}, {way}: {error}", bounds.name))?;
            let first = first.get_or_insert_with(|| found.clone());
            for (k, point) in ["end", "middle"].into_iter().enumerate() {
                let quantity = format!("{}, {point}, {way}, {}", bounds.name, placement.name);
                let ((r, p), (r0, p0)) = (found[k], first[k]);
                checks.vector(
                    Kind::Invariant,
                    quantity.clone(),
                    (r.into(), r0.into()),
                    bounds.position,
                    bounds.reason,
                );
                // 2 sin of a quarter of the angle between the two, whichever sign the quaternions have.
                let apart = 2.0 * (p - p0).norm().min((p + p0).norm());
                checks.below(
                    Kind::Invariant,
                    format!("{quantity}, rotation"),
                    apart,
                    bounds.rotation,
                    bounds.reason,
                );
            }
        }
    }
    Ok(())
}
