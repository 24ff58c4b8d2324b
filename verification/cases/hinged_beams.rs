//! Beams in several pieces, held at both ends, and hinges inside: Timoshenko's closed forms under small loads, and
//! what holds under large ones.

use cosserat::scene::{Joint, JointKind, Load, LoadKind, Rod, Scene, Section, Statics};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, probe, solve};
use crate::placement::placements;
use crate::steps::rotation;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("hinged_beams::inner_hinge", "Timoshenko's beam, closed form", inner_hinge),
        Case::new("hinged_beams::fixed_at_both_ends", "Timoshenko's beam, closed form", fixed),
        Case::new("hinged_beams::oblique_hinge", "a hinge carries no moment about its axis", oblique_hinge),
    ]
}

const AXIAL: f64 = 1e5;
const SHEAR: f64 = 4e4;
const BENDING: f64 = 20.0;

const SECTION: Section = Section::Custom {
    axial: AXIAL,
    shear_y: SHEAR,
    shear_z: SHEAR,
    torsion: 15.0,
    bending_y: BENDING,
    bending_z: BENDING,
    mass_per_length: Some(2.0),
    rotary_inertia: Some([1e-3, 5e-4, 5e-4]),
};

const SMALL: &str = "second order in the load: (w/r)² with the deflection w and the radius of gyration r = √(EI/EA), for the \
                     stretch that ends held apart bring in; and 1e-7 for positions of 1 m, rounded, over w";

/// Relative error of linear theory for the deflection w.
fn small(w: f64) -> f64 {
    w * w * AXIAL / BENDING + 1e-7
}

fn line(name: &str, from: f64, to: f64) -> Rod {
    let shape = cosserat::scene::CurveShape::Line {
        length: None,
        from: Some([from, 0.0, 0.0]),
        to: Some([to, 0.0, 0.0]),
        normal: Some([0.0, 1.0, 0.0]),
    };
    Rod::new(name, shape, SECTION, None, 4, 4)
}

fn join(kind: JointKind, between: [&str; 2], axis: Option<[f64; 3]>) -> Joint {
    Joint { name: None, kind, between: between.map(str::to_string), point: None, axis }
}

const FIRST: f64 = 0.6;
const SECOND: f64 = 0.8;

/// Clamped, hinged at 0.6 m, pinned at 1.4 m.
fn gerber(kind: JointKind, reversed: bool, force: f64) -> Scene {
    let axis = Some([0.0, 0.0, 1.0]);
    let pair = if reversed { ["b@0", "a@1"] } else { ["a@1", "b@0"] };
    let hinge = join(kind, pair, axis.filter(|_| kind == JointKind::Revolute));
    Scene {
        rod: vec![line("a", 0.0, FIRST), line("b", FIRST, FIRST + SECOND)],
        joint: vec![clamp("a@0"), hinge, join(JointKind::Revolute, ["ground", "b@1"], axis)],
        load: vec![load(LoadKind::Force, "b@0.5", [0.0, force, 0.0])],
        probe: vec![probe("hinge", "a@1"), probe("hinge2", "b@0"), probe("middle", "b@0.5")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

fn inner_hinge(checks: &mut Checks) -> Outcome {
    const FORCE: f64 = 1e-2;
    let half = 0.5 * FORCE;
    let hinge = half * FIRST.powi(3) / (3.0 * BENDING) + half * FIRST / SHEAR;
    let middle = 0.5 * hinge + FORCE * SECOND.powi(3) / (48.0 * BENDING) + FORCE * SECOND / (4.0 * SHEAR);
    for kind in [JointKind::Revolute, JointKind::Spherical] {
        for reversed in [false, true] {
            for placement in placements(1.0) {
                let what = format!("{kind:?}, reversed: {reversed}, {}", placement.name);
                let solution = solve(&placement.apply(&gerber(kind, reversed, FORCE)))?;
                let [start, end] =
                    [solution.rows.first(), solution.rows.last()].map(|row| row.ok_or("no rows"));
                let (start, end) = (start?, end?);
                let way = |k: usize| {
                    let way = Vector3::from(end.probes[k].position) - Vector3::from(start.probes[k].position);
                    placement.undo_direction(way)
                };
                for (k, exact) in [hinge, hinge, middle].into_iter().enumerate() {
                    let label = format!("deflection of probe {k}, {what}");
                    checks.relative(Kind::ClosedForm, label, (way(k).y, exact), small(middle), SMALL);
                }
                let [f, m] = [0, 3].map(|first| {
                    let [x, y, z] = [0, 1, 2].map(|k| end.reactions[1][first + k]);
                    placement.undo_direction(Vector3::new(x, y, z))
                });
                let sign = if reversed { -1.0 } else { 1.0 };
                // On the second piece, unless the pair is reversed; the load is carried half and half.
                let label = format!("force of the hinge, {what}");
                checks.relative(Kind::ClosedForm, label, (f.y * sign, -half), small(middle), SMALL);
                let free = if kind == JointKind::Revolute { m.z.abs() } else { m.norm() };
                let reason = "no multiplier acts on what is free: rounding of half the load at arms of 0.1 m";
                checks.below(Kind::Invariant, format!("free moment, {what}"), free, 1e-15, reason);
                let forces: Vector3<f64> = [0, 2]
                    .map(|joint| Vector3::from_column_slice(&end.reactions[joint][..3]))
                    .into_iter()
                    .sum();
                let sum = placement.undo_direction(forces) + Vector3::new(0.0, FORCE, 0.0);
                let reason = "34 nodes within Newton's test, 1e-9 of the forces or their rounding, 8 ε EA p²/J of \
                              1 m: 1e-7";
                checks.below(Kind::Invariant, format!("Σ forces, {what}"), sum.norm(), 34.0 * 1e-7, reason);
            }
        }
    }
    Ok(())
}

const LENGTH: f64 = 1.2;

/// Held at both ends, under a force in the middle or its own weight.
fn fixed(checks: &mut Checks) -> Outcome {
    const FORCE: f64 = 0.05;
    const GRAVITY: f64 = 0.03;
    let by_force = FORCE * LENGTH.powi(3) / (192.0 * BENDING) + FORCE * LENGTH / (4.0 * SHEAR);
    let line_load = 2.0 * GRAVITY;
    let by_weight =
        line_load * LENGTH.powi(4) / (384.0 * BENDING) + line_load * LENGTH.powi(2) / (8.0 * SHEAR);
    let cases: [(&str, f64, f64, f64); 2] = [
        ("force in the middle", by_force, FORCE, FORCE * LENGTH / 8.0),
        ("own weight", by_weight, line_load * LENGTH, line_load * LENGTH.powi(2) / 12.0),
    ];
    for (name, deflection, total, moment) in cases {
        let mut scene = Scene {
            rod: vec![line("beam", 0.0, LENGTH)],
            joint: vec![clamp("beam@0"), clamp("beam@1")],
            probe: vec![probe("middle", "beam@0.5"), probe("left", "beam@0.25"), probe("right", "beam@0.75")],
            statics: Some(Statics::default()),
            ..Scene::default()
        };
        if name == "own weight" {
            scene.gravity = Some([0.0, -GRAVITY, 0.0]);
        } else {
            scene.load.push(load(LoadKind::Force, "beam@0.5", [0.0, -FORCE, 0.0]));
        }
        for placement in placements(1.0) {
            let what = format!("{name}, {}", placement.name);
            let solution = solve(&placement.apply(&scene))?;
            let way = |k: usize| crate::measure::displacement(&solution, k, &placement);
            let pair = (way(0)?.y, -deflection);
            checks.relative(Kind::ClosedForm, format!("deflection, {what}"), pair, small(deflection), SMALL);
            let reason = "the beam is its own mirror image: rounding of positions of 1 m, times EA/EI L² for what \
                          bends";
            let pair = (way(1)?.y, way(2)?.y);
            checks.absolute(Kind::Invariant, format!("symmetry, {what}"), pair, 1e-11, reason);
            let row = solution.rows.last().ok_or("no rows")?;
            for (joint, sign) in [(0, 1.0), (1, -1.0)] {
                let at = |first: usize| Vector3::from_column_slice(&row.reactions[joint][first..first + 3]);
                let (f, m) = (placement.undo_direction(at(0)), placement.undo_direction(at(3)));
                let label = format!("force at end {joint}, {what}");
                checks.relative(Kind::ClosedForm, label, (f.y, 0.5 * total), small(deflection) + 1e-6, SMALL);
                let label = format!("moment at end {joint}, {what}");
                checks.relative(
                    Kind::ClosedForm,
                    label,
                    (m.z, sign * moment),
                    small(deflection) + 1e-6,
                    SMALL,
                );
            }
        }
    }
    Ok(())
}

/// Two rods in line with an oblique hinge between them, bent far: the axis moves with both, no moment acts about it.
fn oblique_hinge(checks: &mut Checks) -> Outcome {
    const AXIS: [f64; 3] = [0.48, -0.6, 0.64];
    for between in [["a@1", "b@0"], ["b@0", "a@1"]] {
        let loads: Vec<Load> = vec![
            load(LoadKind::Moment, "b@0.5", [20.0, -10.0, 15.0]),
            load(LoadKind::Force, "a@0.5", [5.0, 60.0, -40.0]),
        ];
        let scene = Scene {
            rod: vec![line("a", 0.0, FIRST), line("b", FIRST, FIRST + SECOND)],
            joint: vec![
                clamp("a@0"),
                join(JointKind::Revolute, between, Some(AXIS)),
                join(JointKind::Spherical, ["ground", "b@1"], None),
            ],
            load: loads,
            probe: vec![probe("a", "a@1"), probe("b", "b@0")],
            statics: Some(Statics::default()),
            ..Scene::default()
        };
        for placement in placements(1.0) {
            let what = format!("{between:?}, {}", placement.name);
            let solution = solve(&placement.apply(&scene))?;
            let row = solution.rows.last().ok_or("no rows")?;
            // All bases are the inertial one at the start, so the axis has the same components in both.
            let axes = [0, 1].map(|k| {
                let start = rotation(solution.rows[0].probes[k].quaternion);
                let turn = rotation(row.probes[k].quaternion) * start.inverse();
                placement.undo_direction(turn * (placement.rotation * Vector3::from(AXIS).normalize()))
            });
            let reason = "the joint closes to 1e-9 of a radian; a quadratic step beyond that is rounding";
            checks.vector(
                Kind::Invariant,
                format!("axis, {what}"),
                (axes[0].into(), axes[1].into()),
                1e-9,
                reason,
            );
            let turned = (axes[0] - Vector3::from(AXIS).normalize()).norm();
            checks.above(
                Kind::Invariant,
                format!("turn of the axis, {what}"),
                turned,
                0.05,
                "or nothing was tested",
            );
            let moment = placement.undo_direction(Vector3::from_column_slice(&row.reactions[1][3..]));
            let reason = "of moments of 20 N m, with axes that agree to 1e-9";
            let pair = (moment.dot(&axes[0]), 0.0);
            checks.absolute(Kind::Invariant, format!("moment about the axis, {what}"), pair, 4e-8, reason);
            checks.above(
                Kind::Invariant,
                format!("moment, {what}"),
                moment.norm(),
                1.0,
                "or nothing was tested",
            );
            let apart =
                (Vector3::from(row.probes[0].position) - Vector3::from(row.probes[1].position)).norm();
            let reason = "1e-9 of the shorter rod";
            checks.below(Kind::Invariant, format!("gap, {what}"), apart, 1e-9 * FIRST, reason);
        }
    }
    Ok(())
}
