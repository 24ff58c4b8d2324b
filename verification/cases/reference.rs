//! Reference configurations: the fit (21) against what is known of it, and given poses.

use std::f64::consts::PI;
use std::fmt::Write;

use cosserat::Model;
use cosserat::interpolation::Pose;
use cosserat::rotation::{log_se3, quaternion_of};
use cosserat::scene::{CurveShape, InterpolationKind, Reference, Rod, Scene, Statics};
use cosserat::state::State;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, probe};
use crate::pieces::{circle, young_poisson};
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("reference::exact_fit", "as many samples as nodes, at the nodes", exact_fit),
        Case::new("reference::minimum", "the definition (21)", minimum),
        Case::new("reference::wilberforce", "the authors' program, 45 samples", wilberforce),
        Case::new("reference::poses", "the same samples read from a file", poses),
    ]
}

/// The Wilberforce pendulum's spring: three coils, radius 16 mm, pitch 1 mm.
fn scene(elements: usize, degree: usize, samples: usize) -> Scene {
    let helix = CurveShape::Helix { coils: 3.0, radius: 16e-3, pitch: 1e-3, phase: PI };
    let material = young_poisson(199e9, 0.23);
    let mut rod = Rod::new("spring", helix, circle(1e-3), Some(material), elements, degree);
    rod.reference = Reference::Fit { samples };
    Scene {
        rod: vec![rod],
        joint: vec![clamp("spring@1")],
        probe: vec![probe("bottom", "spring@0")],
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

/// The largest distance of positions and of matrix entries between the nodes of two models.
fn distance(a: &Model, b: &Model) -> f64 {
    let poses = a.reference_state().poses().iter().zip(b.reference_state().poses());
    poses.fold(0.0, |most: f64, (a, b)| {
        most.max((a.position - b.position).norm()).max((a.rotation - b.rotation).amax())
    })
}

/// With samples at the nodes the residual can vanish, and then the nodes are on the curve.
fn exact_fit(checks: &mut Checks) -> Outcome {
    for (interpolation, degree) in
        [(InterpolationKind::R12, 1), (InterpolationKind::R12, 2), (InterpolationKind::Se3, 1)]
    {
        let elements = 36;
        let mut fitted = scene(elements, degree, elements * degree + 1);
        fitted.rod[0].interpolation = interpolation;
        let mut exact = fitted.clone();
        exact.rod[0].reference = Reference::Nodes;
        for placement in placements(16e-3) {
            let gap =
                distance(&Model::new(&placement.apply(&fitted))?, &Model::new(&placement.apply(&exact))?);
            let name = format!("{interpolation:?}, degree {degree}, {}", placement.name);
            checks.below(Kind::ClosedForm, name, gap, 1e-12, "the step that ends the fit, 1e-12 of the size");
        }
    }
    Ok(())
}

/// K(q) of eq. (21) through the public poses only.
fn cost(model: &Model, state: &State, targets: &[Pose]) -> Result<f64, Box<dyn std::error::Error>> {
    let mut sum = 0.0;
    for (j, target) in targets.iter().enumerate() {
        let xi = j as f64 / (targets.len() - 1) as f64;
        let pose = model.pose(state, 0, xi, &Vector3::zeros())?;
        let back = target.rotation.transpose();
        let twist = log_se3(&(back * pose.rotation), &(back * (pose.position - target.position)))
            .ok_or("half a turn from the target")?;
        sum += 0.5 * (twist.translation.norm_squared() + twist.rotation.norm_squared());
    }
    Ok(sum)
}

/// The poses of the exact curve at evenly spaced ξ: nodes of a model that has them all.
fn exact_poses(samples: usize) -> Result<(State, Vec<Pose>), Box<dyn std::error::Error>> {
    let mut on_curve = scene(samples - 1, 1, samples);
    on_curve.rod[0].reference = Reference::Nodes;
    let model = Model::new(&on_curve)?;
    let state = model.reference_state().clone();
    let xi = (0..samples).map(|j| j as f64 / (samples - 1) as f64);
    let poses = xi.map(|xi| model.pose(&state, 0, xi, &Vector3::zeros())).collect::<Result<_, _>>()?;
    Ok((state, poses))
}

/// K rises by the same in a direction and its opposite: the slope is zero, the curvature positive.
fn minimum(checks: &mut Checks) -> Outcome {
    for (degree, samples) in [(2, 45), (2, 181), (3, 181)] {
        let model = Model::new(&scene(18, degree, samples))?;
        let (_, targets) = exact_poses(samples)?;
        let state = model.reference_state();
        let lowest = cost(&model, state, &targets)?;
        for node in [0, 7, 18 * degree / 2, 18 * degree] {
            for direction in 0..6 {
                let step = 1e-4;
                let moved = |sign: f64| {
                    let mut increment = cosserat::interpolation::Increment::default();
                    // Lengths in the same metric as angles: 1e-4 m and 1e-4 rad.
                    if direction < 3 {
                        increment.translation[direction] = sign * step;
                    } else {
                        increment.rotation[direction - 3] = sign * step;
                    }
                    let mut state = state.clone();
                    state.add(node, &increment);
                    cost(&model, &state, &targets)
                };
                let (up, down) = (moved(1.0)? - lowest, moved(-1.0)? - lowest);
                let name = format!("degree {degree}, {samples} samples, node {node}, direction {direction}");
                checks.above(Kind::Invariant, format!("curvature, {name}"), up + down, 0.0, "a minimum");
                checks.below(
                    Kind::Invariant,
                    format!("slope over curvature, {name}"),
                    ((up - down) / (up + down)).abs(),
                    1e-2,
                    "third derivatives times the step: residuals and turns of a few per cent of a radian, 1e-4 \
                     rad steps; a node off the minimum by a hundredth of the step would be seen",
                );
            }
        }
    }
    Ok(())
}

fn wilberforce(checks: &mut Checks) -> Outcome {
    let model = Model::new(&scene(18, 2, 45))?;
    for xi in [0.0, 1.0] {
        let end = model.pose(model.reference_state(), 0, xi, &Vector3::zeros())?.position;
        checks.absolute(
            Kind::CrossCode,
            format!("radius of the wire end at ξ = {xi} [mm]"),
            (1e3 * end.x.hypot(end.y), 16.018),
            5e-4,
            "half a printed digit",
        );
    }
    Ok(())
}

fn poses(checks: &mut Checks) -> Outcome {
    let samples = 91;
    let fitted = scene(18, 2, samples);
    let (_, targets) = exact_poses(samples)?;
    let mut table = String::from("x,y,z,qw,qx,qy,qz\n");
    for (j, pose) in targets.iter().enumerate() {
        // Any norm and either sign.
        let q = quaternion_of(&pose.rotation) * if j % 2 == 0 { 1.0 } else { -7.0 };
        let r = pose.position;
        writeln!(table, "{:?},{:?},{:?},{:?},{:?},{:?},{:?}", r.x, r.y, r.z, q[0], q[1], q[2], q[3])?;
    }
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("poses.csv");
    std::fs::write(&file, table)?;
    let mut read = fitted.clone();
    read.rod[0].curve = CurveShape::Poses { file }.into();
    read.rod[0].reference = Reference::Nodes;
    for placement in placements(16e-3) {
        let gap = distance(&Model::new(&placement.apply(&fitted))?, &Model::new(&placement.apply(&read))?);
        let reason = "the step that ends the fit, 1e-12 of the size, and the rounding of the quaternions";
        checks.below(Kind::Invariant, placement.name, gap, 1e-12, reason);
    }
    Ok(())
}
