//! A four-bar loop in an oblique plane: a planar mechanism in space has three constraints too many.
//!
//! The references are one minimal coordinate: poses good to 4e-12, forces to 2e-10. How the normal forces and the
//! moments in the plane are shared among the joints is indeterminate and not looked at.

use std::error::Error;

use cosserat::scene::{Dynamics, Joint, JointKind, Scene};
use cosserat::solution::{Solution, SolveError, StopReason};
use cosserat::{Model, dynamics};
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::probe;
use crate::placement::placements;
use crate::steps::{
    body, check_second_order, check_vanishes, energy_error, force_at, halved_twice, joint, position_at,
    quaternion_at, run, violation,
};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("four_bar::order", "one minimal coordinate", order).reads(&[FILE]),
        Case::new("four_bar::dead_point", "a parallelogram in line can fold", dead_point),
        Case::new("four_bar::order_of_joints", "the loop has no first joint", order_of_joints),
    ]
}

/// Position and quaternion of the coupler, sum of the ground's forces, in-plane forces at A and D.
type Exact = ([f64; 3], [f64; 4], [f64; 3], [[f64; 2]; 2]);

const FILE: &str = "rigid/four_bar.csv";

/// The reference at a time of the file.
fn exact(checks: &mut Checks, time: f64) -> Result<Exact, Box<dyn Error>> {
    let table = checks.reference(FILE)?;
    let row = table.row(&[("t", &format!("{time:?}"))])?;
    let in_plane = [row.numbers("a1 a2")?, row.numbers("d1 d2")?];
    Ok((row.numbers("x y z")?, row.numbers("qw qx qy qz")?, row.numbers("fx fy fz")?, in_plane))
}

const NORMAL: [f64; 3] = [1.0, 2.0, 2.0];
const PLANE: [[f64; 3]; 2] = [[2.0, 1.0, -2.0], [-2.0, 2.0, -1.0]];
const STEP: f64 = 4e-3;

const JOINTS: [(&str, [&str; 2], [f64; 3]); 4] = [
    ("A", ["ground", "bar1"], [0.0, 0.0, 0.0]),
    ("B", ["bar1", "bar2"], [-0.4, 0.4, -0.2]),
    ("C", ["bar2", "bar3"], [0.2, 1.0, -1.1]),
    ("D", ["ground", "bar3"], [1.0, 0.5, -1.0]),
];

/// The loop, its joints in this order.
pub fn scene(order: [usize; 4]) -> Scene {
    let joint = |index: usize| {
        let (name, between, point) = JOINTS[index];
        Joint { axis: Some(NORMAL), ..joint(name, JointKind::Revolute, between, point) }
    };
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        body: vec![
            body("bar1", 1.0, [0.03, 0.04, 0.05], [-0.2, 0.2, -0.1]),
            body("bar2", 2.0, [0.2, 0.3, 0.25], [-0.1, 0.7, -0.65]),
            body("bar3", 1.5, [0.12, 0.1, 0.09], [0.6, 0.75, -1.05]),
        ],
        joint: order.map(joint).to_vec(),
        probe: ["bar1", "bar2", "bar3"].map(|name| probe(name, name)).to_vec(),
        dynamics: Some(Dynamics::new(2.0, STEP)),
        ..Scene::default()
    }
}

const AS_WRITTEN: [usize; 4] = [0, 1, 2, 3];

/// Whether the model's only warning names the joint and how many of its constraints follow from others.
fn warns(scene: &Scene, joint: &str) -> Result<f64, Box<dyn Error>> {
    let model = Model::new(scene)?;
    let sentence = format!("3 of the 5 constraints of joint `{joint}`");
    let right = matches!(model.warnings(), [warning] if warning.contains(&sentence));
    Ok(f64::from(u8::from(right)))
}

const NAMED: &str =
    "the loop is closed by the joint that comes last, and the plane makes three of its constraints redundant";

fn order(checks: &mut Checks) -> Outcome {
    let scene = scene(AS_WRITTEN);
    checks.absolute(
        Kind::Invariant,
        "the warning names joint D and 3 of 5",
        (warns(&scene, "D")?, 1.0),
        0.0,
        NAMED,
    );
    let normal = Vector3::from(NORMAL).normalize();
    for placement in placements(1.0) {
        let runs = halved_twice(&placement.apply(&scene))?;
        for time in [0.5, 1.0, 2.0] {
            let (position, quaternion, sum, in_plane) = exact(checks, time)?;
            let label = |what: &str| format!("{what} at {time} s, {}", placement.name);
            let [mut x, mut q, mut s, mut p] = [const { Vec::<Vec<f64>>::new() }; 4];
            for run in &runs {
                x.push(position_at(run, time, 1, &placement)?.as_slice().to_vec());
                q.push(quaternion_at(run, time, 1, &placement, quaternion)?.to_vec());
                let forces = [force_at(run, time, 0, &placement)?, force_at(run, time, 3, &placement)?];
                s.push((forces[0] + forces[1]).as_slice().to_vec());
                let axes = PLANE.map(|axis| Vector3::from(axis).normalize());
                p.push(forces.iter().flat_map(|force| axes.map(|axis| axis.dot(force))).collect());
            }
            check_second_order(checks, &label("position of the coupler"), [&x[0], &x[1], &x[2]], &position);
            check_second_order(checks, &label("rotation of the coupler"), [&q[0], &q[1], &q[2]], &quaternion);
            check_second_order(checks, &label("sum of the ground's forces"), [&s[0], &s[1], &s[2]], &sum);
            check_second_order(
                checks,
                &label("forces in the plane"),
                [&p[0], &p[1], &p[2]],
                in_plane.as_flattened(),
            );
        }
        if placement.name == "as is" {
            path(checks, &runs[2])?;
        }
        let energies = [0, 1, 2].map(|k| energy_error(&runs[k]));
        check_vanishes(checks, &format!("energy, {}", placement.name), energies);
        for run in &runs {
            // All rows of all joints, also those that are not imposed.
            let reason = "Newton's test, 1e-9 of the way in a step at up to 6 m/s or rad/s, through a loop of \
                          four bars; and rounding";
            let bound = 1e-9 * STEP * 6.0 * 4.0 + 1e-13;
            checks.below(
                Kind::Invariant,
                format!("joints, {}", placement.name),
                violation(run),
                bound,
                reason,
            );
            let drift = drift(run, &scene, &placement, &normal);
            checks.below(Kind::Invariant, format!("out of plane, {}", placement.name), drift, bound, reason);
        }
    }
    Ok(())
}

/// The height of the coupler's centre of mass over time.
fn path(checks: &mut Checks, run: &Solution) -> Outcome {
    let table = checks.reference(FILE)?;
    let mut reference = Vec::new();
    for row in table.rows() {
        let point = row.numbers::<2>("t z")?;
        if point[0] <= 2.0 {
            reference.push(point);
        }
    }
    checks.trajectory(Trajectory {
        title: "Four-bar loop: centre of mass of the coupler".to_string(),
        axes: ["t [s]", "z [m]"],
        measured: run.rows.iter().step_by(10).map(|row| [row.parameter, row.probes[1].position[2]]).collect(),
        source: "one minimal coordinate",
        reference,
    });
    Ok(())
}

/// Largest way of a centre of mass along the normal.
fn drift(
    run: &Solution,
    scene: &Scene,
    placement: &crate::placement::Placement,
    normal: &Vector3<f64>,
) -> f64 {
    let off = |(index, pose): (usize, &cosserat::solution::ProbePose)| {
        let way =
            placement.undo_position(Vector3::from(pose.position)) - Vector3::from(scene.body[index].position);
        normal.dot(&way).abs()
    };
    run.rows.iter().flat_map(|row| row.probes.iter().enumerate().map(off)).fold(0.0, f64::max)
}

fn order_of_joints(checks: &mut Checks) -> Outcome {
    let as_is = &placements(1.0)[0];
    let reference = run(&scene(AS_WRITTEN))?;
    for (order, last) in [([3, 2, 1, 0], "A"), ([2, 0, 3, 1], "B"), ([1, 3, 0, 2], "C")] {
        let scene = scene(order);
        checks.absolute(
            Kind::Invariant,
            format!("the warning names {last}"),
            (warns(&scene, last)?, 1.0),
            0.0,
            NAMED,
        );
        let other = run(&scene)?;
        for time in [0.5, 1.0, 2.0] {
            for index in 0..3 {
                let pair = [&other, &reference].map(|run| position_at(run, time, index, as_is));
                let [a, b] = pair;
                let reason = "the same equations; Newton stops within 1e-9 of the forces, which 15 m/s² over half of four \
                              seconds squared make 3e-8";
                let label = format!("position of bar {} at {time} s, {last} last", index + 1);
                checks.vector(Kind::Invariant, label, (a?.into(), b?.into()), 3e-8, reason);
            }
        }
    }
    Ok(())
}

/// A parallelogram that starts in line has a fourth constraint that follows from the others, but only there: when
/// the bars leave the line the run must stop and say so, not go on with a mechanism that has come apart.
fn dead_point(checks: &mut Checks) -> Outcome {
    let hinge = |name, between, x| Joint {
        axis: Some([0.0, 0.0, 1.0]),
        ..joint(name, JointKind::Revolute, between, [x, 0.0, 0.0])
    };
    let scene = Scene {
        gravity: Some([0.0, -9.81, 0.0]),
        body: vec![
            body("bar1", 1.0, [0.01, 0.1, 0.1], [0.5, 0.0, 0.0]),
            body("bar2", 2.0, [0.01, 0.7, 0.7], [2.0, 0.0, 0.0]),
            body("bar3", 1.0, [0.01, 0.1, 0.1], [2.5, 0.0, 0.0]),
        ],
        joint: vec![
            hinge("A", ["ground", "bar1"], 0.0),
            hinge("B", ["bar1", "bar2"], 1.0),
            hinge("C", ["bar2", "bar3"], 3.0),
            hinge("D", ["ground", "bar3"], 2.0),
        ],
        probe: vec![probe("bar1", "bar1")],
        dynamics: Some(Dynamics::new(0.5, 1e-3)),
        ..Scene::default()
    };
    for placement in placements(1.0) {
        let model = Model::new(&placement.apply(&scene))?;
        let named =
            matches!(model.warnings(), [warning] if warning.contains("4 of the 5 constraints of joint `D`"));
        let label = |what: &str| format!("{what}, {}", placement.name);
        let reason = "in line the two ways round the loop fall together";
        checks.absolute(Kind::Invariant, label("named"), (f64::from(u8::from(named)), 1.0), 0.0, reason);
        let options = scene.dynamics.as_ref().ok_or("no [dynamics]")?;
        let Err(failure) = dynamics::solve(&model, options, &mut |_, _| ()) else {
            return Err("the mechanism came apart unseen".into());
        };
        let departed =
            matches!(failure.error, SolveError::Step { reason: StopReason::Departed { joint: 3 }, .. });
        let reason = "joint D is the one that was not imposed in full";
        checks.absolute(
            Kind::Invariant,
            label("departed"),
            (f64::from(u8::from(departed)), 1.0),
            0.0,
            reason,
        );
        let reason =
            "what is kept has not come apart by more than a part in 10⁵ of the bars, which no one sees";
        checks.below(Kind::Invariant, label("gap"), violation(&failure.partial), 1e-5, reason);
        let reason = "with all bars falling freely the gap is of the fourth order in their angle: it is small for \
                      some steps";
        let steps = failure.partial.statistics.increments as f64;
        checks.above(Kind::Invariant, label("steps"), steps, 10.0, reason);
    }
    Ok(())
}
