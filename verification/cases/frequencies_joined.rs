//! Vibrations of rods joined to a body, to another rod and to themselves.

use std::error::Error;
use std::f64::consts::TAU;

use cosserat::scene::{
    Body, CurveShape, InterpolationKind, Joint, JointKind, Material, Modes, Rod, Scene, Section,
};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies::{FILE, LENGTH, bending, lowest, speeds, steel, stocky_section, straight};
use crate::measure::clamp;
use crate::motion::{frequencies, joint, vibrate};
use crate::pieces::circle;
use crate::placement::placements;
use crate::references::Table;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "frequencies_joined::tip_body",
            "transfer matrix of Timoshenko's rod with a rigid body, and Ritz",
            tip_body,
        )
        .reads(&[TIP_FILE]),
        Case::new(
            "frequencies_joined::frame",
            "transfer matrix of Simo & Vu-Quoc's (1988) frame, and Ritz",
            frame,
        )
        .reads(&[FRAME_FILE]),
        Case::new(
            "frequencies_joined::mechanisms",
            "counting freedoms; rods free at both ends, by symmetry (frequencies::slender)",
            mechanisms,
        )
        .reads(&[FILE]),
        Case::new(
            "frequencies_joined::ring",
            "Fourier's 3×3 matrices of the closed Cosserat ring, and transfer matrices",
            ring,
        )
        .reads(&[RING_FILE]),
        Case::new("frequencies_joined::ring_orders", "the same; order 2p", ring_orders).reads(&[RING_FILE]),
    ]
}

/// Mass 50, inertia (1, 2, 3), rigidly at the end.
fn with_body(position: [f64; 3], elements: usize, degree: usize) -> Scene {
    let mut scene = straight(stocky_section(), elements, degree, vec![clamp("rod@0")], 8);
    scene.body.push(Body {
        name: "tip".to_string(),
        shape: None,
        density: None,
        mass: Some(50.0),
        inertia: Some([1.0, 2.0, 3.0]),
        position,
        orientation: [1.0, 0.0, 0.0, 0.0],
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    });
    scene.joint.push(joint(JointKind::Rigid, "rod@1", "tip", None));
    scene
}

const TIP_FILE: &str = "continuous/tip_body_frequencies.csv";
const FRAME_FILE: &str = "continuous/frame_frequencies.csv";
const RING_FILE: &str = "continuous/ring_frequencies.csv";

/// Where the body's centre of mass is, and what the file calls it.
const BODIES: [([f64; 3], &str); 2] = [([1.15, 0.0, 0.0], "in line"), ([1.15, 0.1, -0.2], "aside")];

fn tip_body(checks: &mut Checks) -> Outcome {
    let table = checks.reference(TIP_FILE)?;
    for (position, body) in BODIES {
        let rows = table.select(&[("body", body)])?;
        let exact: Vec<f64> = rows.iter().map(|row| row.number("omega")).collect::<Result<_, _>>()?;
        for placement in placements(LENGTH) {
            let found = frequencies(&placement.apply(&with_body(position, 4, 8)))?;
            for (n, &omega) in exact.iter().enumerate() {
                let measured = found.get(n).copied().unwrap_or(f64::NAN);
                checks.relative(
                    Kind::ClosedForm,
                    format!("body at {position:?}, ω{}, {}", n + 1, placement.name),
                    (measured, omega),
                    1e-9,
                    "the table's last digit, 2e-12 at most; half of ε (c p² n/L)²/ω² = 2e-9 · (1e2/ω)², \
                     and 1e-10 of the mesh",
                );
            }
        }
    }
    Ok(())
}

/// A leg of the frame of Simo & Vu-Quoc.
pub fn leg(name: &str, from: [f64; 3], to: [f64; 3], elements: usize, degree: usize) -> Rod {
    let section = Section::Custom {
        axial: 1e6,
        shear_y: 1e6,
        shear_z: 1e6,
        torsion: 1e3,
        bending_y: 1e3,
        bending_z: 1e3,
        mass_per_length: Some(1.0),
        rotary_inertia: Some([20.0, 10.0, 10.0]),
    };
    let line = CurveShape::Line { length: None, from: Some(from), to: Some(to), normal: None };
    Rod::new(name, line, section, None, elements, degree)
}

/// Both legs, clamped and joined.
pub fn frame_scene(elements: usize, degree: usize) -> Scene {
    let elbow = [0.0, 10.0, 0.0];
    Scene {
        rod: vec![
            leg("leg", [0.0; 3], elbow, elements, degree),
            leg("arm", elbow, [10.0, 10.0, 0.0], elements, degree),
        ],
        joint: vec![clamp("leg@0"), joint(JointKind::Rigid, "leg@1", "arm@0", None)],
        ..Scene::default()
    }
}

fn frame(checks: &mut Checks) -> Outcome {
    let table = checks.reference(FRAME_FILE)?;
    let exact = table.rows().map(|row| row.number("omega")).collect::<Result<Vec<_>, _>>()?;
    for placement in placements(10.0) {
        let scene = Scene { modes: Some(Modes { count: 10 }), ..frame_scene(4, 8) };
        let solution = vibrate(&placement.apply(&scene))?;
        for (n, &omega) in exact.iter().enumerate() {
            let measured = solution.modes.get(n).map_or(f64::NAN, |mode| mode.angular_frequency);
            // The fastest wave is the axial one, c = √(1e6/1).
            let highest = 1e3 * (64.0 * 4.0) / 10.0;
            checks.relative(
                Kind::ClosedForm,
                format!("frame, ω{}, {}", n + 1, placement.name),
                (measured, omega),
                1e-10 + 0.5 * f64::EPSILON * (highest / omega).powi(2),
                "the reference is good to 1e-10; half of ε (c p² n/L)²/ω² of rounding in ω²",
            );
        }
        checks.absolute(
            Kind::Invariant,
            format!("warnings, {}", placement.name),
            (solution.warnings.len() as f64, 0.0),
            0.0,
            "an open chain of joints has nothing redundant, and its modes are real",
        );
    }
    Ok(())
}

/// Two slender rods in line, hinged to each other: as many zeros as freedoms, and where both bend alike the hinge
/// carries nothing, so that each vibrates as if it were free.
fn mechanisms(checks: &mut Checks) -> Outcome {
    let [lowest_free, ..] = bending(checks, "slender", "free", "any")?;
    let across = Some([0.0, 0.0, 1.0]);
    let between = |kind, axis| joint(kind, "rod@1", "next@0", axis);
    let hinge = joint(JointKind::Revolute, "ground", "rod@0", across);
    let mechanisms = [
        ("spherical", vec![between(JointKind::Spherical, None)], 9, 4),
        ("revolute", vec![between(JointKind::Revolute, across)], 7, 2),
        ("double pendulum", vec![hinge, between(JointKind::Revolute, across)], 2, 0),
    ];
    for (what, joints, zeros, alike) in mechanisms {
        let mut scene = straight(circle(0.01), 3, 8, joints, zeros + 8);
        let mut next = scene.rod[0].clone();
        (next.name, next.curve.origin) = ("next".to_string(), [LENGTH, 0.0, 0.0]);
        scene.rod.push(next);
        for placement in placements(LENGTH) {
            let solution = vibrate(&placement.apply(&scene))?;
            let found: Vec<f64> = solution.modes.iter().map(|mode| mode.angular_frequency).collect();
            let at_rest = found.iter().filter(|omega| omega.abs() < 1e-6 * lowest_free).count();
            checks.absolute(
                Kind::ClosedForm,
                format!("zeros, {what}, {}", placement.name),
                (at_rest as f64, zeros as f64),
                0.0,
                "6 a rod less what joints hold; 1e-12 of an elastic ω² is rounding",
            );
            checks.absolute(
                Kind::Invariant,
                format!("warnings, {what}, {}", placement.name),
                (solution.warnings.len() as f64, 0.0),
                0.0,
                "a mechanism at rest is not unstable, and its frequencies are real",
            );
            // Both planes, or the one about the hinge's axis.
            let bound = 1e-7;
            let near = found.iter().filter(|omega| (*omega / lowest_free - 1.0).abs() < bound).count();
            checks.absolute(
                Kind::ClosedForm,
                format!("frequencies of a free rod, {what}, {}", placement.name),
                (near as f64, (alike / 2) as f64),
                0.0,
                "one for each plane in which the hinge is free, to half of ε (c p² n/L)²/ω² = 5e-8; none with an end held",
            );
        }
    }
    Ok(())
}

/// A closed ring of radius 1, cut and joined at ξ = 0.
pub fn closed_ring(section: Section, material: Option<Material>, elements: usize, degree: usize) -> Scene {
    let mut rod =
        Rod::new("ring", CurveShape::Arc { radius: 1.0, angle: TAU }, section, material, elements, degree);
    rod.curve.origin = [0.0, -1.0, 0.0];
    let closed: Joint = joint(JointKind::Rigid, "ring@0", "ring@1", None);
    Scene { rod: vec![rod], joint: vec![closed], ..Scene::default() }
}

/// The lowest `count` elastic frequencies of the `thin` or `thick` ring: two of each kind for n > 0 waves around, one for
/// n = 0.
fn elastic(table: &Table, ring: &str, count: usize) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut all = Vec::new();
    for row in table.select(&[("ring", ring)])? {
        let modes = if row.word("n")? == "0" { 1 } else { 2 };
        all.extend(std::iter::repeat_n(row.number("omega")?, modes));
    }
    Ok(lowest(&[&all], count))
}

fn ring(checks: &mut Checks) -> Outcome {
    let table = checks.reference(RING_FILE)?;
    // Both bend with n = 2, 3, 4; the thirteenth of the thick one turns all sections alike.
    for (what, diameter, count) in [("thin", 0.01, 12), ("thick", 0.2, 13)] {
        let expected = elastic(&table, what, count)?;
        for placement in placements(1.0) {
            let mut scene = placement.apply(&closed_ring(circle(diameter), Some(steel()), 12, 8));
            scene.modes = Some(Modes { count: 6 + expected.len() });
            let solution = vibrate(&scene)?;
            let what = format!("{what}, {}", placement.name);
            checks.absolute(
                Kind::Invariant,
                format!("warnings, {what}"),
                (solution.warnings.len() as f64, 0.0),
                0.0,
                "the joint that closes one rod has no redundant constraint, the mesh resolves the ring, and the \
                 frequencies are real",
            );
            for (n, mode) in solution.modes.iter().take(6).enumerate() {
                checks.below(
                    Kind::ClosedForm,
                    format!("rigid motion {}, {what}", n + 1),
                    mode.angular_frequency.abs() / expected[0],
                    1e-6,
                    "a rigid motion has no stiffness: 1e-12 of the first elastic ω² is rounding",
                );
            }
            for (n, omega) in expected.iter().enumerate() {
                let measured = solution.modes.get(6 + n).map_or(f64::NAN, |mode| mode.angular_frequency);
                let highest = speeds()[0] * (64.0 * 12.0) / TAU;
                checks.relative(
                    Kind::ClosedForm,
                    format!("elastic ω{}, {what}", n + 1),
                    (measured, *omega),
                    1e-9 + 0.5 * f64::EPSILON * (highest / omega).powi(2),
                    "1e-9 of the mesh, (π/6)^16 < 4e-5 times n^16 (8!/16!)²; half of ε (c p² n/L)²/ω² of rounding",
                );
            }
        }
    }
    Ok(())
}

fn ring_orders(checks: &mut Checks) -> Outcome {
    let r12 = InterpolationKind::R12;
    let ladders: [(InterpolationKind, usize, [usize; 3]); 4] = [
        (r12, 1, [32, 64, 128]),
        (InterpolationKind::Se3, 1, [32, 64, 128]),
        (r12, 2, [16, 32, 64]),
        (r12, 3, [12, 24, 48]),
    ];
    let table = checks.reference(RING_FILE)?;
    for (section, what) in [(circle(0.2), "thick"), (circle(0.01), "thin")] {
        let of = |plane| -> Result<f64, Box<dyn Error>> {
            table.row(&[("ring", what), ("plane", plane), ("n", "2"), ("branch", "1")])?.number("omega")
        };
        let exact = [of("out")?, of("in")?];
        for (interpolation, degree, meshes) in ladders {
            let mut errors = [const { Vec::new() }; 2];
            for elements in meshes {
                let mut scene = closed_ring(section.clone(), Some(steel()), elements, degree);
                scene.rod[0].interpolation = interpolation;
                scene.modes = Some(Modes { count: 10 });
                let found = frequencies(&scene)?;
                for (k, exact) in exact.into_iter().enumerate() {
                    errors[k].push((found.get(6 + 2 * k).unwrap_or(&f64::NAN) / exact - 1.0).abs());
                }
            }
            for (errors, plane) in errors.iter().zip(["out of plane", "in plane"]) {
                let name = format!("{what} ring, n = 2 {plane}, {interpolation:?}, p = {degree}");
                checks.order(
                    &name,
                    &meshes,
                    errors,
                    (2.0 * degree as f64, 0.15),
                    "the next term is smaller by (n h/R)², 0.15 at most",
                );
                let factorials: f64 = (1..=degree).map(|k| 1.0 / (degree + k) as f64).product();
                let finest = 2.0 * TAU / meshes[2] as f64;
                checks.below(
                    Kind::Order,
                    name,
                    errors[2],
                    finest.powi(2 * degree as i32) * factorials * factorials,
                    "(n h/R)^{2p} [p!/(2p)!]² as of a straight bar: reduced quadrature does not lock, thin or thick",
                );
            }
        }
    }
    Ok(())
}
