//! Closed loops of rods, and bodies that ride on rods, in statics.

use cosserat::Model;
use cosserat::scene::{CurveShape, Joint, JointKind, Load, LoadKind, Rod, Scene, Statics};
use cosserat::solution::Row;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, position, probe, solve};
use crate::pieces::UNEVEN_SECTION;
use crate::placement::{Placement, placements};
use crate::steps::{body, joint};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("loaded_frames::triangle", "equilibrium and the mirror image", triangle),
        Case::new("loaded_frames::bodies_on_rods", "the same rod under the bodies' weights", riding),
        Case::new("loaded_frames::hanging", "equilibrium", hanging),
        Case::new(
            "loaded_frames::held_twice",
            "half the work is done by either joint, or all by one",
            held_twice,
        ),
    ]
}

fn line(name: &str, from: [f64; 3], to: [f64; 3], elements: usize, degree: usize) -> Rod {
    let shape =
        CurveShape::Line { length: None, from: Some(from), to: Some(to), normal: Some([0.0, 0.0, 1.0]) };
    Rod::new(name, shape, UNEVEN_SECTION, None, elements, degree)
}

fn rigid(between: [&str; 2]) -> Joint {
    Joint {
        name: None,
        kind: JointKind::Rigid,
        between: between.map(str::to_string),
        point: None,
        axis: None,
    }
}

fn force_and_moment(row: &Row, joint: usize, placement: &Placement) -> [Vector3<f64>; 2] {
    [0, 3].map(|first| {
        placement.undo_direction(Vector3::from_column_slice(&row.reactions[joint][first..first + 3]))
    })
}

/// An equilateral triangle, clamped at one corner; two joints share the node at the clamp.
fn triangle(checks: &mut Checks) -> Outcome {
    let height = 0.75_f64.sqrt();
    let corners = [[0.0, 0.0, 0.0], [0.5, height, 0.0], [-0.5, height, 0.0]];
    let loads: [(Load, [f64; 3]); 2] = [
        (load(LoadKind::Force, "b@0.5", [0.0, 3.0, 2.0]), [0.0, height, 0.0]),
        (load(LoadKind::Moment, "b@0.5", [0.5, 0.0, 0.0]), [0.0; 3]),
    ];
    let scene = Scene {
        rod: vec![
            line("a", corners[0], corners[1], 4, 4),
            line("b", corners[1], corners[2], 4, 4),
            line("c", corners[2], corners[0], 4, 4),
        ],
        joint: vec![
            rigid(["ground", "a@0"]),
            rigid(["a@1", "b@0"]),
            rigid(["b@1", "c@0"]),
            rigid(["c@1", "a@0"]),
        ],
        load: loads.iter().map(|(load, _)| load.clone()).collect(),
        probe: ["a@0.5", "c@0.5", "a@1", "c@0", "b@0", "b@1", "b@0.25", "b@0.75", "b@0.5", "a@0", "c@1"]
            .map(|on| probe(&on.replace('@', " "), on))
            .to_vec(),
        statics: Some(Statics::default()),
        ..Scene::default()
    };
    let warnings = Model::new(&scene)?.warnings().len() as f64;
    let reason = "rods can strain: a closed loop of them has no constraint too many";
    checks.absolute(Kind::Invariant, "warnings", (warnings, 0.0), 0.0, reason);
    for placement in placements(1.0) {
        let solution = solve(&placement.apply(&scene))?;
        let at = |k: usize| position(&solution, k, &placement);
        for (k, l) in [(0, 1), (2, 3), (4, 5), (6, 7)] {
            let (right, left) = (at(k)?, at(l)?);
            let mirrored = Vector3::new(-left.x, left.y, left.z);
            let label = format!("mirror image of probe {k}, {}", placement.name);
            let reason = "Newton's test, 1e-9 of the forces, on a frame whose deflection is below its size";
            checks.vector(Kind::Invariant, label, (right.into(), mirrored.into()), 1e-8, reason);
        }
        let reason = "on the plane of the mirror";
        checks.absolute(
            Kind::Invariant,
            format!("middle, {}", placement.name),
            (at(8)?.x, 0.0),
            1e-8,
            reason,
        );
        let moved = (at(8)? - Vector3::new(0.0, height, 0.0)).norm();
        checks.above(
            Kind::Invariant,
            format!("way, {}", placement.name),
            moved,
            0.05,
            "or nothing was tested",
        );
        for (k, l) in [(2, 4), (3, 5), (9, 10)] {
            let label = format!("gap of probes {k} and {l}, {}", placement.name);
            checks.vector(
                Kind::Invariant,
                label,
                (at(k)?.into(), at(l)?.into()),
                1e-9,
                "1e-9 of a rod's length",
            );
        }
        let row = solution.rows.last().ok_or("no rows")?;
        let [force, moment] = force_and_moment(row, 0, &placement);
        let reason = "51 nodal residuals within Newton's test, 1e-9 of forces below 10 N; moments to order 2p besides, \
                      (κh)⁸/8! < 1e-9 at 2 rad/m";
        let pair = (force.into(), [0.0, -3.0, -2.0]);
        checks.vector(
            Kind::ClosedForm,
            format!("force of the clamp, {}", placement.name),
            pair,
            5e-7,
            reason,
        );
        let exact = -(at(8)?.cross(&Vector3::new(0.0, 3.0, 2.0)) + Vector3::new(0.5, 0.0, 0.0));
        let pair = (moment.into(), exact.into());
        checks.vector(
            Kind::ClosedForm,
            format!("moment of the clamp, {}", placement.name),
            pair,
            5e-7,
            reason,
        );
    }
    Ok(())
}

const GRAVITY: [f64; 3] = [1.0, -2.0, -9.0];

/// Bodies at the middle node of a quadratic element, at a joint of elements, two of them at one node, and at the
/// end with a lever: the rod under the forces m g, with levers, at these nodes.
fn riding(checks: &mut Checks) -> Outcome {
    let bodies = [
        ("one", "rod@0.375", 0.05, [0.75, 0.0, 0.0]),
        ("two", "rod@0.5", 0.08, [1.0, 0.1, -0.2]),
        ("three", "rod@0.5", 0.03, [0.9, 0.0, 0.3]),
        ("four", "rod@1", 0.06, [2.1, -0.1, 0.2]),
    ];
    let base = Scene {
        gravity: Some(GRAVITY),
        // e_x, e_z and −e_y of space are e_x, e_y and e_z of the section.
        rod: vec![line("rod", [0.0; 3], [2.0, 0.0, 0.0], 4, 2)],
        joint: vec![clamp("rod@0")],
        probe: vec![probe("a", "rod@0.4"), probe("b", "rod@0.7"), probe("tip", "rod@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    };
    let (mut ridden, mut loaded) = (base.clone(), base);
    for (name, on, mass, at) in bodies {
        ridden.body.push(body(name, mass, [1e-3, 1e-3, 1e-3], at));
        ridden.joint.push(rigid([on, name]));
        let xi: f64 = on.trim_start_matches("rod@").parse()?;
        let [x, y, z] = [at[0] - 2.0 * xi, at[1], at[2]];
        let weight = GRAVITY.map(|g| mass * g);
        loaded.load.push(Load { offset: Some([x, z, -y]), ..load(LoadKind::Force, on, weight) });
    }
    for placement in placements(2.0) {
        let [a, b] = [&ridden, &loaded].map(|scene| solve(&placement.apply(scene)));
        let (a, b) = (a?, b?);
        let reason = "Newton's test, 1e-9 of the forces, on a rod whose deflection is below its length";
        for k in 0..3 {
            let pair = (position(&a, k, &placement)?.into(), position(&b, k, &placement)?.into());
            let label = format!("position of probe {k}, {}", placement.name);
            checks.vector(Kind::Invariant, label, pair, 1e-8, reason);
        }
        let moved = (position(&a, 2, &placement)? - Vector3::new(2.0, 0.0, 0.0)).norm();
        checks.above(
            Kind::Invariant,
            format!("way of the tip, {}", placement.name),
            moved,
            0.1,
            "or nothing was tested",
        );
        let (rows, others) = (a.rows.last().ok_or("no rows")?, b.rows.last().ok_or("no rows")?);
        for k in 0..6 {
            let pair = (rows.reactions[0][k], others.reactions[0][k]);
            let label = format!("component {k} of the clamp, {}", placement.name);
            checks.absolute(Kind::Invariant, label, pair, 1e-7, "1e-9 of forces of 15 N at nine nodes");
        }
        for (k, (name, _, mass, _)) in bodies.iter().enumerate() {
            let [force, _] = force_and_moment(rows, k + 1, &placement);
            let pair = (force.into(), GRAVITY.map(|g| -mass * g));
            let label = format!("what carries {name}, {}", placement.name);
            checks.vector(
                Kind::ClosedForm,
                label,
                pair,
                1e-9,
                "the body's residual, 1e-9 of its weight of 1 N",
            );
        }
    }
    Ok(())
}

/// A body held by the ground, and one that hangs on a vertical rod: what holds them carries their weight.
fn hanging(checks: &mut Checks) -> Outcome {
    let (mass, at) = (3.0, [0.4, -0.3, -0.5]);
    for reversed in [false, true] {
        let pair = if reversed { ["bob", "ground"] } else { ["ground", "bob"] };
        let scene = Scene {
            gravity: Some([0.0, 0.0, -9.81]),
            body: vec![body("bob", mass, [1.0, 1.0, 1.0], at)],
            joint: vec![joint("wall", JointKind::Rigid, pair, [0.0; 3])],
            probe: vec![probe("bob", "bob")],
            statics: Some(Statics::default()),
            ..Scene::default()
        };
        for placement in placements(1.0) {
            let solution = solve(&placement.apply(&scene))?;
            let row = solution.rows.last().ok_or("no rows")?;
            let sign = if reversed { -1.0 } else { 1.0 };
            let [force, moment] = force_and_moment(row, 0, &placement).map(|v| v * sign);
            let weight = Vector3::new(0.0, 0.0, -9.81 * mass);
            let what = format!("reversed: {reversed}, {}", placement.name);
            let reason = "1e-9 of the weight, 29 N";
            let pair = (force.into(), (-weight).into());
            checks.vector(Kind::ClosedForm, format!("force, {what}"), pair, 3e-8, reason);
            let exact = -Vector3::from(at).cross(&weight);
            checks.vector(
                Kind::ClosedForm,
                format!("moment, {what}"),
                (moment.into(), exact.into()),
                3e-8,
                reason,
            );
        }
    }
    let scene = Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        rod: vec![line_down()],
        body: vec![body("bob", mass, [1.0, 1.0, 1.0], [0.0, 0.0, -2.5])],
        joint: vec![clamp("rod@0"), rigid(["rod@1", "bob"])],
        probe: vec![probe("tip", "rod@1")],
        statics: Some(Statics::default()),
        ..Scene::default()
    };
    for placement in placements(2.0) {
        let solution = solve(&placement.apply(&scene))?;
        let row = solution.rows.last().ok_or("no rows")?;
        let label = |what: &str| format!("{what}, {}", placement.name);
        let reason = "nine nodal residuals of 1e-9 of 40 N";
        let [force, _] = force_and_moment(row, 0, &placement);
        let exact = [0.0, 0.0, 9.81 * (mass + 0.5 * 2.0)];
        checks.vector(Kind::ClosedForm, label("force of the ground"), (force.into(), exact), 4e-7, reason);
        let [force, moment] = force_and_moment(row, 1, &placement);
        let pair = (force.into(), [0.0, 0.0, 9.81 * mass]);
        checks.vector(Kind::ClosedForm, label("force of the rod"), pair, 3e-8, "1e-9 of 29 N");
        let reason = "the rod is straight and the bob below it: 1e-9 of 29 N at arms of 0.5 m";
        checks.below(Kind::Invariant, label("moment of the rod"), moment.norm(), 3e-8, reason);
        // (m g L + ρA g L²/2)/EA.
        let (length, half_weight) = (2.0, 9.81 * 0.5);
        let stretch = (9.81 * mass + half_weight) * length / 1e4;
        let pair = (position(&solution, 0, &placement)?.z, -2.0 - stretch);
        let reason = "linear along the axis whatever the load; p = 2 holds its parabola; 1e-9 of the forces of \
                      the stretch";
        checks.absolute(Kind::ClosedForm, label("stretch"), pair, 1e-9 * 2.0, reason);
    }
    Ok(())
}

fn line_down() -> Rod {
    let shape = CurveShape::Line {
        length: None,
        from: Some([0.0; 3]),
        to: Some([0.0, 0.0, -2.0]),
        normal: Some([0.0, 1.0, 0.0]),
    };
    Rod::new("rod", shape, UNEVEN_SECTION, None, 4, 2)
}

/// A second joint that holds what is held already is named and left out; the body stays and its weight is carried.
fn held_twice(checks: &mut Checks) -> Outcome {
    let scene = Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        body: vec![body("bob", 2.0, [1.0, 1.0, 1.0], [0.3, 0.2, -0.4])],
        joint: vec![
            joint("left", JointKind::Rigid, ["ground", "bob"], [0.0; 3]),
            joint("right", JointKind::Rigid, ["ground", "bob"], [1.0, 0.0, 0.0]),
        ],
        probe: vec![probe("bob", "bob")],
        statics: Some(Statics::default()),
        ..Scene::default()
    };
    let model = Model::new(&scene)?;
    let named =
        matches!(model.warnings(), [warning] if warning.contains("6 of the 6 constraints of joint `right`"));
    let reason = "the first joint holds all six freedoms";
    checks.absolute(Kind::Invariant, "named", (f64::from(u8::from(named)), 1.0), 0.0, reason);
    for placement in placements(1.0) {
        let solution = solve(&placement.apply(&scene))?;
        let row = solution.rows.last().ok_or("no rows")?;
        let sum = force_and_moment(row, 0, &placement)[0] + force_and_moment(row, 1, &placement)[0];
        let label = |what: &str| format!("{what}, {}", placement.name);
        let pair = (sum.into(), [0.0, 0.0, 2.0 * 9.81]);
        checks.vector(Kind::ClosedForm, label("Σ forces"), pair, 2e-8, "1e-9 of the weight, 20 N");
        let pair = (position(&solution, 0, &placement)?.into(), [0.3, 0.2, -0.4]);
        checks.vector(Kind::Invariant, label("position"), pair, 1e-9, "1e-9 of the levers, 1 m");
    }
    Ok(())
}
