//! What probes say: Euler angles and quaternions along many turns, and poses between the nodes.

use std::f64::consts::TAU;

use cosserat::scene::{Basis, EulerSequence, LoadKind, Rod, Scene, Statics};
use cosserat::solution::ProbePose;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, probe, solve};
use crate::pieces::{circle, line, young_poisson};
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("probes::angles", "closed form: pure torsion and pure bending", angles),
        Case::new("probes::rotation", "the definition A = R_x(γ) R_y(β) R_z(α)", rotation),
        Case::new("probes::between_nodes", "closed form of linear R12 elements", between_nodes),
    ]
}

const LENGTH: f64 = 1.0;
const DIAMETER: f64 = 0.02;
const YOUNG: f64 = 1e9;
const POISSON: f64 = 0.25;

/// EI and GI_p.
fn stiffnesses() -> (f64, f64) {
    let bending = YOUNG * std::f64::consts::PI * DIAMETER.powi(4) / 64.0;
    (bending, bending / (1.0 + POISSON))
}

/// A straight cantilever along +e_x under an end moment, in the section's basis or not.
fn scene(moment: [f64; 3], basis: Basis, elements: usize, degree: usize) -> Scene {
    let material = young_poisson(YOUNG, POISSON);
    let mut end = load(LoadKind::Moment, "beam@1", moment);
    end.basis = basis;
    let mut tip = probe("tip", "beam@1");
    tip.angles = Some(EulerSequence::Zyx);
    Scene {
        rod: vec![Rod::new("beam", line(LENGTH), circle(DIAMETER), Some(material), elements, degree)],
        joint: vec![clamp("beam@0")],
        load: vec![end],
        probe: vec![tip],
        statics: Some(Statics { increments: Some(40), ..Statics::default() }),
        ..Scene::default()
    }
}

const CONVERGED: &str = "a residual of τ = 1e-9 of the moment turns the tip by 1e-9 of its angle at each of some tens \
                         of nodes; the solution itself is exact, all strains being constant";

/// α by bending about e_z and γ by torsion, far beyond a turn; β about e_y within its range.
fn angles(checks: &mut Checks) -> Outcome {
    let (bending, torsion) = stiffnesses();
    let turns = 2.3 * TAU;
    for (name, moment, exact) in [
        ("α", [0.0, 0.0, bending * turns], [turns, 0.0, 0.0]),
        ("α, backwards", [0.0, 0.0, -bending * turns], [-turns, 0.0, 0.0]),
        ("β", [0.0, bending * 1.4, 0.0], [0.0, 1.4, 0.0]),
        ("γ", [torsion * turns, 0.0, 0.0], [0.0, 0.0, turns]),
    ] {
        let solution = solve(&scene(moment, Basis::Inertial, 24, 6))?;
        let last = solution.rows.last().and_then(|row| row.probes[0].angles).ok_or("no angles")?;
        checks.vector(Kind::ClosedForm, name, (last, exact), 1e-7, CONVERGED);
        // Linear in the load, so no row may jump.
        for pair in solution.rows.windows(2) {
            let (Some(a), Some(b)) = (pair[0].probes[0].angles, pair[1].probes[0].angles) else {
                return Err("no angles".into());
            };
            let steps: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
            let step = exact.map(|angle| angle / 40.0);
            checks.vector(Kind::ClosedForm, format!("{name}, one increment"), (steps, step), 1e-7, CONVERGED);
        }
    }
    Ok(())
}

fn quaternion(pose: &ProbePose) -> Quaternion<f64> {
    let [w, x, y, z] = pose.quaternion;
    Quaternion::new(w, x, y, z)
}

/// Angles and quaternion are the same rotation; quaternions are unit, w ≥ 0 at first and continuous after.
fn rotation(checks: &mut Checks) -> Outcome {
    const EPSILON: &str = "rounding of the extraction near no singularity";
    let (bending, torsion) = stiffnesses();
    let moment = [2.0 * torsion, 1.1 * bending, 9.0 * bending];
    for placement in placements(LENGTH) {
        let solution = solve(&placement.apply(&scene(moment, Basis::Body, 24, 6)))?;
        let first = quaternion(&solution.rows[0].probes[0]);
        checks.above(Kind::Invariant, "w of the first row", first.w, 0.0, "the contract");
        let mut before = first;
        for row in &solution.rows {
            let pose = &row.probes[0];
            let q = quaternion(pose);
            checks.absolute(Kind::Invariant, "norm", (q.norm(), 1.0), 4.0 * f64::EPSILON, "a few roundings");
            checks.above(
                Kind::Invariant,
                "continuity",
                q.dot(&before),
                0.9,
                "the tip turns by 0.23 rad a row",
            );
            before = q;
            let [alpha, beta, gamma] = pose.angles.ok_or("no angles")?;
            let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
            let composed = about(Vector3::x_axis(), gamma)
                * about(Vector3::y_axis(), beta)
                * about(Vector3::z_axis(), alpha);
            let matrix = UnitQuaternion::from_quaternion(q).to_rotation_matrix();
            let gap = (composed.matrix() - matrix.matrix()).norm();
            checks.below(Kind::Invariant, "angles against the quaternion", gap, 1e-14, EPSILON);
        }
    }
    Ok(())
}

/// Half way along a linear element the nearest rotation to ½ (A₀ + A₁) is the half-way one, and the position is the
/// middle of the chord; a quarter of the way it is turned by atan2(sin θ, 3 + cos θ).
fn between_nodes(checks: &mut Checks) -> Outcome {
    let (bending, _) = stiffnesses();
    for placement in placements(LENGTH) {
        let mut scene = scene([0.0, 0.0, 2.0 * bending], Basis::Inertial, 4, 1);
        for (name, xi) in [("start", 0.25), ("end", 0.5), ("middle", 0.375), ("quarter", 0.3125)] {
            scene.probe.push(probe(name, &format!("beam@{xi}")));
        }
        let mut lever = probe("lever", "beam@0.375");
        lever.offset = Some([0.1, 0.2, 0.3]);
        scene.probe.push(lever);
        let solution = solve(&placement.apply(&scene))?;
        let poses = &solution.rows.last().ok_or("no rows")?.probes;
        let turn = |k: usize| {
            let q = UnitQuaternion::from_quaternion(quaternion(&poses[k]));
            (placement.rotation.inverse() * q).scaled_axis().z
        };
        let place = |k: usize| placement.undo_position(Vector3::from(poses[k].position));
        let theta = turn(2) - turn(1);
        let rounding = 1e-13;
        let reason = "rounding of poses and of what takes them apart";
        let half = (turn(3) - turn(1), 0.5 * theta);
        checks.absolute(Kind::ClosedForm, "rotation half way", half, rounding, reason);
        let quarter = (turn(4) - turn(1), theta.sin().atan2(3.0 + theta.cos()));
        checks.absolute(Kind::ClosedForm, "rotation a quarter of the way", quarter, rounding, reason);
        let chord = 0.5 * (place(1) + place(2));
        checks.vector(
            Kind::ClosedForm,
            "position half way",
            (place(3).into(), chord.into()),
            rounding,
            reason,
        );
        let (sin, cos) = turn(3).sin_cos();
        let lever = Vector3::new(0.1 * cos - 0.2 * sin, 0.1 * sin + 0.2 * cos, 0.3);
        let offset = place(5) - place(3);
        checks.vector(Kind::ClosedForm, "lever half way", (offset.into(), lever.into()), rounding, reason);
    }
    Ok(())
}
