//! The errors that a study reports, against true ones: a rod wound up to a helix, the 45° bend and a spinning top, each
//! known without discretisation over the whole path.
//!
//! A study holds its runs against a reference of its own, whose error it estimates. If the estimate is a bound, the
//! reference is as near to the truth as it says, and by the triangle inequality so is every error that it reports.

use std::error::Error;

use cosserat::scene::{
    Basis, Body, CurveShape, Dynamics, Increments, InterpolationKind, LoadKind, Rod, Scene, Statics, Study,
};
use cosserat::study::{Advice, Errors, Plan, Row, Settings, Trajectory, advice, solve};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use super::bend_45;
use super::static_rods::find;
use crate::case::{Case, Checks, Kind, Outcome};
use crate::continuous::angle;
use crate::measure::{clamp, load, probe};
use crate::pieces::{circle, line, rectangle, young_poisson, young_shear};
use crate::placement::{Placement, placements};
use crate::steps::body;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "study::helix",
            "closed form: constant strains under a moment that turns with its section",
            helix,
        ),
        Case::new("study::bend_45", "the continuous equations, scripts/references/static_rods.py", bend)
            .reads(&[bend_45::LOADS]),
        Case::new("study::top", "closed form: a symmetric body without forces", top).reads(&[TOP_FILE]),
    ]
}

/// A pose, and the parameter it belongs to: a load factor or a time.
struct Station {
    parameter: f64,
    position: Vector3<f64>,
    rotation: UnitQuaternion<f64>,
}

/// What is known of the truth.
struct Truth {
    /// At some of the milestones, all of them after the start.
    stations: Vec<Station>,
    /// What lengths are relative to [m].
    size: f64,
    /// Errors of the truth itself.
    digits: Errors,
}

impl Truth {
    /// The true errors of probe 0, where the truth is known.
    fn errors(
        &self,
        plan: &Plan,
        path: &Trajectory,
        placement: &Placement,
    ) -> Result<Errors, Box<dyn Error>> {
        let mut errors = Errors::default();
        for station in &self.stations {
            let parameters = plan.milestones().parameters();
            let same = |parameter: &f64| {
                (parameter - station.parameter).abs() < 1e-9 * parameters[parameters.len() - 1]
            };
            let index = 1 + parameters.iter().position(same).ok_or("no such milestone")?;
            let row = path.rows.iter().find(|(milestone, _)| *milestone == index).ok_or("no such row")?;
            let pose = row.1.first().ok_or("no probe")?;
            let position = placement.shift + placement.rotation * station.position;
            let distance = (Vector3::from(pose.position) - position).norm() / self.size;
            let [w, x, y, z] = pose.quaternion;
            let found = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
            let turned = angle(&found, &(placement.rotation * station.rotation));
            errors.position = errors.position.max(distance);
            errors.rotation = errors.rotation.max(turned);
        }
        Ok(errors)
    }

    /// Whether these are all milestones of the path.
    fn complete(&self, plan: &Plan) -> bool {
        self.stations.len() == plan.milestones().count()
    }
}

/// The same study with a ladder so coarse, and accuracies so low, that the error of its reference is far above
/// rounding: there the estimate has to be a bound by itself.
fn coarse(scene: &Scene) -> Scene {
    let lists = scene.study.clone().unwrap_or_default();
    let lists =
        Study { degree: Some(vec![1]), elements: Some(vec![3, 4]), accuracies: Some(vec![1.0]), ..lists };
    Scene { study: Some(lists), ..scene.clone() }
}

const OWN: &str = "what the study says of its reference, and the digits of the truth";
const REPORTED: &str = "the triangle inequality: the error that the study says its reference has, and the digits of the \
                        truth";
const HIDDEN: &str = "the truth is known at some milestones only: there the error is at most the reported one and that \
                      of the reference";
const ADVISED: &str = "what the advice is for";

/// Does the whole study in every placement and holds it against the truth.
fn check(checks: &mut Checks, what: &str, scene: &Scene, truth: &Truth) -> Outcome {
    for placement in placements(truth.size) {
        let plan = Plan::new(&placement.apply(scene))?;
        let reference = plan.reference(&mut |_, _, _| ())?;
        let claimed = Errors {
            position: reference.error.position + truth.digits.position,
            rotation: reference.error.rotation + truth.digits.rotation,
        };
        let name = |quantity: &str| format!("{quantity}, {what}, {}", placement.name);
        let own = truth.errors(&plan, &reference.trajectory, &placement)?;
        checks.below(Kind::ClosedForm, name("reference, position"), own.position, claimed.position, OWN);
        checks.below(Kind::ClosedForm, name("reference, rotation"), own.rotation, claimed.rotation, OWN);
        let mut rows = Vec::new();
        let mut true_errors = Vec::new();
        for index in 0..plan.keys().len() {
            let row = plan.run(index, &reference, &mut |_, _| ());
            let errors = row.errors.ok_or_else(|| format!("run {index}: {}", row.status))?;
            let path = repeat(&plan, &row)?;
            let exact = truth.errors(&plan, &path, &placement)?;
            let run = name(&format!(
                "degree {:?}, {:?} elements, step {:?}",
                row.key.degree, row.key.elements, row.key.time_step
            ));
            for (quantity, reported, exact, claimed) in [
                ("position", errors.position, exact.position, claimed.position),
                ("rotation", errors.rotation, exact.rotation, claimed.rotation),
            ] {
                let quantity = format!("{quantity}, {run}");
                if truth.complete(&plan) {
                    checks.absolute(Kind::ClosedForm, quantity, (reported, exact), claimed, REPORTED);
                } else {
                    checks.below(Kind::ClosedForm, quantity, exact, reported + claimed, HIDDEN);
                }
            }
            rows.push(row);
            true_errors.push(exact);
        }
        for &accuracy in plan.accuracies() {
            let Advice::Take(row) = advice(&rows, accuracy, &reference.error) else {
                return Err(format!("nothing is advised for {accuracy:e}").into());
            };
            let index =
                rows.iter().position(|other| other.key == row.key).ok_or("the advice is for no row")?;
            let quantity = name(&format!("true error of what is advised for {accuracy:e}"));
            checks.below(Kind::ClosedForm, quantity, true_errors[index].largest(), accuracy, ADVISED);
        }
    }
    Ok(())
}

/// The path of a run of the study.
fn repeat(plan: &Plan, row: &Row) -> Result<Trajectory, Box<dyn Error>> {
    let settings = Settings {
        degree: row.key.degree,
        elements: row.key.elements.map(|elements| vec![elements]),
        interpolation: row.key.interpolation,
        increments: row.key.increments.map(Increments::Equal),
        time_step: row.key.time_step,
        tolerance: None,
    };
    let variant = settings.apply(plan.scene())?;
    Ok(solve(&variant, plan.milestones(), &mut |_, _| ())?.trajectory)
}

/// Length, stiffness and the strains k at the full load: with ν = 0 the section is as stiff in torsion as in bending,
/// so that the moment K k of a constant k is in equilibrium.
const LENGTH: f64 = 1.0;
const DIAMETER: f64 = 0.01;
const YOUNG: f64 = 1e9;
const TWIST: f64 = 1.0;
const CURVATURE: f64 = 2.0;

/// A(L) = exp(L λ k̃) and r(L) = L V(L λ k) e_x, V(φ) = 1 + (1 − cos φ)/φ² φ̃ + (φ − sin φ)/φ³ φ̃².
fn wound(factor: f64) -> Station {
    let vector = Vector3::new(TWIST, 0.0, CURVATURE) * (LENGTH * factor);
    let (phi, skew) = (vector.norm(), vector.cross_matrix());
    let v = Matrix3::identity()
        + skew * ((1.0 - phi.cos()) / phi.powi(2))
        + skew * skew * ((phi - phi.sin()) / phi.powi(3));
    Station {
        parameter: factor,
        position: LENGTH * (v * Vector3::x()),
        rotation: UnitQuaternion::from_scaled_axis(vector),
    }
}

fn helix(checks: &mut Checks) -> Outcome {
    let stiffness = YOUNG * std::f64::consts::PI * DIAMETER.powi(4) / 64.0;
    let material = young_shear(YOUNG, 0.5 * YOUNG);
    let mut moment = load(LoadKind::Moment, "rod@1", [TWIST * stiffness, 0.0, CURVATURE * stiffness]);
    moment.basis = Basis::Body;
    let rod = Rod::new("rod", line(LENGTH), circle(DIAMETER), Some(material), 4, 2);
    let scene = Scene {
        rod: vec![rod],
        joint: vec![clamp("rod@0")],
        load: vec![moment],
        probe: vec![probe("tip", "rod@1")],
        statics: Some(Statics::default()),
        study: Some(Study {
            degree: Some(vec![1, 2, 3]),
            elements: Some(vec![4, 8, 16]),
            accuracies: Some(vec![1e-1, 1e-4]),
            ..Study::default()
        }),
        ..Scene::default()
    };
    let stations = (1..=10).map(|k| wound(f64::from(k) / 10.0)).collect();
    let truth = Truth { stations, size: LENGTH, digits: rounding() };
    check(checks, "straight to helix", &scene, &truth)?;
    check(checks, "straight to helix, coarsely", &coarse(&scene), &truth)?;
    // SE(3) elements have constant strains, so that theirs is the exact answer.
    let mut exact = scene;
    exact.study = Some(Study {
        interpolation: Some(vec![InterpolationKind::Se3]),
        elements: Some(vec![4]),
        ..Study::default()
    });
    check(checks, "straight to helix, SE(3)", &exact, &truth)
}

/// What Newton's test and rounding leave of a position in lengths and of an angle: the relative test stops below 1e-9
/// of the forces, and full steps near the solution square what is left.
fn rounding() -> Errors {
    Errors { position: 1e-11, rotation: 1e-11 }
}

fn bend(checks: &mut Checks) -> Outcome {
    const FORCE: f64 = 600.0;
    let table = checks.reference(bend_45::LOADS)?;
    let mut stations = Vec::new();
    let mut digits = rounding();
    for force in [75.0, 150.0, 300.0, 450.0, FORCE] {
        let row = find(&table, &[("case", "1/6")], "force", force)?;
        let [w, x, y, z] = row.numbers("qw qx qy qz")?;
        stations.push(Station {
            parameter: force / FORCE,
            position: Vector3::from(row.numbers::<3>("x y z")?),
            rotation: UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
        });
        let position = row.number("position_accuracy")? * 3.0_f64.sqrt() / bend_45::LENGTH;
        digits.position = digits.position.max(position + rounding().position);
        digits.rotation = digits.rotation.max(row.number("rotation_accuracy")? + rounding().rotation);
    }
    let arc = CurveShape::Arc { radius: bend_45::RADIUS, angle: std::f64::consts::FRAC_PI_4 };
    let material = young_poisson(bend_45::YOUNG, 0.0);
    let scene = Scene {
        rod: vec![Rod::new("bend", arc, rectangle(1.0, 1.0, None), Some(material), 4, 2)],
        joint: vec![clamp("bend@0")],
        load: vec![load(LoadKind::Force, "bend@1", [0.0, 0.0, FORCE])],
        probe: vec![probe("tip", "bend@1")],
        statics: Some(Statics::default()),
        study: Some(Study {
            degree: Some(vec![1, 2]),
            elements: Some(vec![4, 8, 16]),
            // Eight equal increments make eight milestones, with all loads of the table among them.
            increments: Some(vec![Increments::Equal(8)]),
            accuracies: Some(vec![1e-2, 1e-4]),
            ..Study::default()
        }),
        ..Scene::default()
    };
    let truth = Truth { stations, size: bend_45::LENGTH, digits };
    check(checks, "45° bend", &scene, &truth)?;
    check(checks, "45° bend, coarsely", &coarse(&scene), &truth)
}

const TOP_FILE: &str = "rigid/free_symmetric_body.csv";

fn top(checks: &mut Checks) -> Outcome {
    const END: f64 = 5.0;
    let table = checks.reference(TOP_FILE)?;
    let mut stations = Vec::new();
    for row in table.rows() {
        let time = row.number("t")?;
        let [w, x, y, z] = row.numbers("qw qx qy qz")?;
        if time > 0.0 && time <= END {
            let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
            stations.push(Station { parameter: time, position: Vector3::zeros(), rotation });
        }
    }
    let turns = [1.0, 0.0, 10.0];
    let scene = Scene {
        body: vec![Body { angular_velocity: turns, ..body("top", 1.0, [2.0, 2.0, 3.0], [0.0; 3]) }],
        probe: vec![probe("top", "top")],
        dynamics: Some(Dynamics::new(END, 0.01)),
        study: Some(Study {
            time_step: Some(vec![0.01, 0.005, 0.0025]),
            accuracies: Some(vec![1e-1]),
            ..Study::default()
        }),
        ..Scene::default()
    };
    let digits = Errors { position: 1e-12, rotation: 1e-12 };
    check(checks, "top", &scene, &Truth { stations, size: 1.0, digits })
}
