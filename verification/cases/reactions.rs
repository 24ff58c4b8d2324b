//! Joints to the ground: what is held stays, what is free carries no reaction, and the reactions balance the loads.
//!
//! Forces balance to the residual (Σ N_i′ = 0); moments to the order 2p of the discretisation as well, see
//! `petrov_galerkin.rs`. The loads are summed here from the recorded poses, not by the element's formula.

use cosserat::quadrature::gauss_legendre;
use cosserat::rotation::rotation_matrix;
use cosserat::scene::{
    Basis, CurveShape, Joint, JointKind, Load, LoadKind, Probe, Rod, Scene, Section, Statics,
};
use cosserat::solution::{ProbePose, Solution};
use nalgebra::{Matrix3, Vector3, Vector4};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{load, probe, solve};
use crate::placement::{Placement, placements};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new("reactions::balance", "equilibrium of the whole rod; what each joint holds", balance)]
}

const LENGTH: f64 = 2.0;
const ELEMENTS: usize = 16;
const NODES: f64 = 65.0;
/// Largest component of a nodal residual [N, N m].
const TOLERANCE: f64 = 1e-10;
/// An axis along no coordinate.
const AXIS: [f64; 3] = [0.48, -0.6, 0.64];
const GAUSS_POINTS: usize = 5;

/// A joint at ξ, with its point off the node.
struct Held {
    kind: JointKind,
    xi: f64,
    lever: [f64; 3],
    /// Whether the ground is written second.
    reversed: bool,
}

fn held(kind: JointKind, xi: f64, lever: [f64; 3], reversed: bool) -> Held {
    Held { kind, xi, lever, reversed }
}

impl Held {
    fn point(&self) -> Vector3<f64> {
        Vector3::new(self.xi * LENGTH, 0.0, 0.0) + Vector3::from(self.lever)
    }

    fn joint(&self) -> Joint {
        let mut between = ["ground".to_string(), format!("rod@{}", self.xi)];
        if self.reversed {
            between.swap(0, 1);
        }
        Joint {
            name: None,
            kind: self.kind,
            between,
            point: Some(self.point().into()),
            axis: (self.kind == JointKind::Revolute).then_some(AXIS),
        }
    }

    /// The held point as a point of the rod: the section's basis is the inertial one at the start.
    fn probe(&self, index: usize) -> Probe {
        Probe { offset: Some(self.lever), ..probe(&format!("held{index}"), &format!("rod@{}", self.xi)) }
    }
}

/// Where joints can be: start, end, interior; each kind at each of them.
fn arrangements() -> Vec<(&'static str, Vec<Held>)> {
    use JointKind::{Revolute, Rigid, Spherical};
    let (a, b) = ([-0.1, 0.2, 0.15], [0.05, -0.1, 0.3]);
    vec![
        ("clamped inside", vec![held(Rigid, 0.5, a, true)]),
        (
            "clamped at the start, hinged inside",
            vec![held(Rigid, 0.0, b, false), held(Revolute, 0.5, a, false)],
        ),
        (
            "clamped at the end, ball inside",
            vec![held(Rigid, 1.0, [0.0; 3], false), held(Spherical, 0.5, b, true)],
        ),
        (
            "ball at the start, hinged at the end",
            vec![held(Spherical, 0.0, a, false), held(Revolute, 1.0, b, true)],
        ),
        (
            "hinged at the start, ball at the end",
            vec![held(Revolute, 0.0, a, false), held(Spherical, 1.0, b, false)],
        ),
    ]
}

/// One of every load: both bases, forces with and without lever, moments, along the rod and at points.
fn loads() -> Vec<Load> {
    let with = |kind, on: &str, value, basis, offset| Load { basis, offset, ..load(kind, on, value) };
    let (inertial, body) = (Basis::Inertial, Basis::Body);
    vec![
        with(LoadKind::LineForce, "rod", [0.1, -0.5, 0.3], inertial, None),
        with(LoadKind::LineForce, "rod", [-0.2, 0.3, 0.4], body, None),
        with(LoadKind::LineMoment, "rod", [0.2, 0.1, -0.3], inertial, None),
        with(LoadKind::LineMoment, "rod", [0.1, -0.2, 0.1], body, None),
        with(LoadKind::Force, "rod@0.75", [0.3, 0.4, -0.2], body, Some([0.1, -0.2, 0.3])),
        with(LoadKind::Force, "rod@0.25", [-0.2, 0.1, 0.5], inertial, Some([0.2, 0.1, -0.1])),
        with(LoadKind::Moment, "rod@0.25", [0.1, 0.3, -0.2], inertial, None),
        with(LoadKind::Moment, "rod@0.75", [-0.2, 0.1, 0.2], body, None),
    ]
}

fn scene(joints: &[Held]) -> Scene {
    let line = CurveShape::Line { length: Some(LENGTH), from: None, to: None, normal: None };
    let section = Section::Custom {
        axial: 1e3,
        shear_y: 4e2,
        shear_z: 5e2,
        torsion: 0.8,
        bending_y: 1.0,
        bending_z: 1.5,
        mass_per_length: None,
        rotary_inertia: None,
    };
    let rule = gauss_legendre(GAUSS_POINTS);
    // The held points, the loaded points, the points of the line loads.
    let mut probes: Vec<Probe> = joints.iter().enumerate().map(|(k, joint)| joint.probe(k)).collect();
    probes
        .extend([("quarter", "rod@0.25"), ("three quarters", "rod@0.75")].map(|(name, on)| probe(name, on)));
    for e in 0..ELEMENTS {
        for x in &rule.points {
            let xi = (e as f64 + x) / ELEMENTS as f64;
            probes.push(probe(&format!("s{}", probes.len()), &format!("rod@{xi}")));
        }
    }
    Scene {
        rod: vec![Rod::new("rod", line, section, None, ELEMENTS, 4)],
        joint: joints.iter().map(Held::joint).collect(),
        load: loads(),
        probe: probes,
        statics: Some(Statics { tolerance: Some(TOLERANCE), ..Statics::default() }),
        ..Scene::default()
    }
}

/// (r, A) in the axes of the scene before it was placed.
fn pose(probe: &ProbePose, placement: &Placement) -> (Vector3<f64>, Matrix3<f64>) {
    let back = placement.rotation.inverse().to_rotation_matrix();
    (
        placement.undo_position(Vector3::from(probe.position)),
        back.matrix() * rotation_matrix(&Vector4::from(probe.quaternion)),
    )
}

/// Σ of the loads: force, and moment about the scene's origin.
fn resultant(probes: &[(Vector3<f64>, Matrix3<f64>)]) -> [Vector3<f64>; 2] {
    let ([quarter, three_quarters], along) = ([probes[0], probes[1]], &probes[2..]);
    let rule = gauss_legendre(GAUSS_POINTS);
    let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
    for load in loads() {
        let value = |a: &Matrix3<f64>| match load.basis {
            Basis::Inertial => Vector3::from(load.value),
            Basis::Body => a * Vector3::from(load.value),
        };
        let mut act = |(r, a): &(Vector3<f64>, Matrix3<f64>), factor: f64| {
            let value = value(a) * factor;
            if matches!(load.kind, LoadKind::Force | LoadKind::LineForce) {
                force += value;
                moment += (r + a * Vector3::from(load.offset.unwrap_or_default())).cross(&value);
            } else {
                moment += value;
            }
        };
        match load.on.as_str() {
            "rod" => {
                let weights = rule.weights.iter().cycle();
                for (point, weight) in along.iter().zip(weights) {
                    act(point, weight * LENGTH / ELEMENTS as f64);
                }
            }
            "rod@0.25" => act(&quarter, 1.0),
            _ => act(&three_quarters, 1.0),
        }
    }
    [force, moment]
}

const FREE_REASON: &str = "the moment about what is free is a residual, three components below 1e-10";
const RESIDUAL_REASON: &str = "65 nodal residuals below 1e-10, at arms of at most 3; the order 2p = 8 of moments and \
                               of body loads leaves (κh)⁸/8! = (1/4)⁸/8! = 4e-10 at 2 rad/m";

fn balance(checks: &mut Checks) -> Outcome {
    for (name, joints) in arrangements() {
        for placement in placements(LENGTH) {
            let solution =
                solve(&placement.apply(&scene(&joints))).map_err(|error| format!("{name}: {error}"))?;
            check(checks, &format!("{name}, {}", placement.name), &joints, &solution, &placement)?;
        }
    }
    Ok(())
}

fn check(
    checks: &mut Checks,
    name: &str,
    joints: &[Held],
    solution: &Solution,
    placement: &Placement,
) -> Outcome {
    let (first, last) = (solution.rows.first().ok_or("no rows")?, solution.rows.last().ok_or("no rows")?);
    let before: Vec<_> = first.probes.iter().map(|probe| pose(probe, placement)).collect();
    let after: Vec<_> = last.probes.iter().map(|probe| pose(probe, placement)).collect();
    let [mut force, mut moment] = resultant(&after[joints.len()..]);
    let axis = Vector3::from(AXIS).normalize();
    for (k, joint) in joints.iter().enumerate() {
        let label = format!("{:?} at {}, {name}", joint.kind, joint.xi);
        let sign = if joint.reversed { -1.0 } else { 1.0 };
        let [fx, fy, fz, mx, my, mz] = last.reactions[k];
        let f = placement.undo_direction(Vector3::new(fx, fy, fz)) * sign;
        let m = placement.undo_direction(Vector3::new(mx, my, mz)) * sign;
        force += f;
        moment += joint.point().cross(&f) + m;
        let reason = "positions of size 20 in the placed scene, rounded a few dozen times";
        let pair = (after[k].0.into(), joint.point().into());
        checks.vector(Kind::Invariant, format!("held point, {label}"), pair, 1e-13, reason);
        let turn = after[k].1 * before[k].1.transpose();
        let spin = (turn - Matrix3::identity()).norm();
        let free_moment = match joint.kind {
            JointKind::Rigid => {
                checks.below(Kind::Invariant, format!("turn, {label}"), spin, 1e-13, reason);
                0.0
            }
            JointKind::Revolute => {
                let pair = ((turn * axis).into(), axis.into());
                checks.vector(Kind::Invariant, format!("axis, {label}"), pair, 1e-13, reason);
                m.dot(&axis)
            }
            JointKind::Spherical => m.norm(),
        };
        let pair = (free_moment, 0.0);
        checks.absolute(Kind::Invariant, format!("free moment, {label}"), pair, 2.0 * TOLERANCE, FREE_REASON);
        if joint.kind != JointKind::Rigid && joints.iter().all(|joint| joint.kind != JointKind::Rigid) {
            let reason = "the joint must turn by an amount that matters, or nothing was tested";
            checks.above(Kind::Invariant, format!("turn, {label}"), spin, 0.02, reason);
        }
    }
    let sum = (force.into(), [0.0; 3]);
    checks.vector(Kind::Invariant, format!("Σ forces, {name}"), sum, NODES * TOLERANCE, RESIDUAL_REASON);
    let sum = (moment.into(), [0.0; 3]);
    checks.vector(
        Kind::Invariant,
        format!("Σ moments, {name}"),
        sum,
        3.0 * NODES * TOLERANCE,
        RESIDUAL_REASON,
    );
    Ok(())
}
