//! Rows and shapes of a solution while it grows.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Vector3, Vector4};

use crate::assembly::Workspace;
use crate::interpolation::Pose;
use crate::model::{JointModel, Model, ProbeModel, ProbedPart};
use crate::rotation::quaternion_of;
use crate::solution::{Energies, ProbePose, Row, Shape, Solution, Statistics, StopReason};
use crate::state::State;

/// Shapes kept beside the start: at the first increments past k/SHAPES of the path.
const SHAPES: usize = 8;
/// Points of a rod's centreline in a shape.
const SHAPE_POINTS: usize = 1000;

/// Collects a solution.
pub struct Recorder {
    solution: Solution,
    /// The last parameter there will be.
    end: f64,
}

impl Recorder {
    /// For a model whose parameter (load factor or time) runs from 0 to `end`.
    pub fn new(model: &Model, end: f64) -> Self {
        let solution = Solution {
            unknowns: model.unknowns(),
            warnings: model.warnings().to_vec(),
            ..Solution::default()
        };
        Self { solution, end }
    }

    /// Adds a row for a converged state whose forces the workspace holds.
    pub fn record(
        &mut self,
        model: &Model,
        parameter: f64,
        state: &State,
        work: &Workspace,
    ) -> Result<(), StopReason> {
        let previous = self.solution.rows.last();
        let mut probes = Vec::with_capacity(model.probes.len());
        for (index, probe) in model.probes.iter().enumerate() {
            let pose = probe_pose(model, probe, state)?;
            let before = previous.map(|row| &row.probes[index]);
            let quaternion = continuous(quaternion_of(&pose.rotation), before);
            let angles = probe.angles.map(|_| unwrapped(euler_zyx(&pose.rotation), before));
            probes.push(ProbePose { position: pose.position.into(), quaternion: quaternion.into(), angles });
        }
        let reactions = model.joints.iter().map(|joint| {
            let (f, m) = reaction(model, joint, state, work);
            [f.x, f.y, f.z, m.x, m.y, m.z]
        });
        let row = Row { parameter, probes, reactions: reactions.collect() };
        self.solution.rows.push(row);
        let place = |parameter: f64| parameter / self.end * SHAPES as f64 + 1e-9;
        let wanted = self.solution.shapes.last().map_or(0.0, |shape| place(shape.parameter).floor() + 1.0);
        if place(parameter) >= wanted {
            self.solution.shapes.push(shape(model, parameter, state));
        }
        Ok(())
    }

    /// Adds the energies of the row that was recorded last.
    pub fn record_energies(&mut self, energies: Energies) {
        self.solution.energies.push(energies);
    }

    /// The solution; warns where the mesh resolves the reference, but not the last state.
    pub fn finish(mut self, model: &Model, state: &State, statistics: Statistics) -> Solution {
        if model.warnings().is_empty() {
            self.solution.warnings = model.unresolved(state, "last state");
        }
        Solution { statistics, ..self.solution }
    }
}

/// The pose of a probe.
pub fn probe_pose(model: &Model, probe: &ProbeModel, state: &State) -> Result<Pose, StopReason> {
    match probe.on {
        ProbedPart::Body(body) => Ok(model.body_pose(state, body, &probe.offset)),
        ProbedPart::Rod { rod, xi } => model.pose(state, rod, xi, &probe.offset).map_err(|_| {
            let elements = model.rods[rod].elements;
            StopReason::HalfTurn { rod, element: ((xi * elements as f64) as usize).min(elements - 1) }
        }),
    }
}

/// (force, moment about the joint's point) on the second of the pair, inertial.
fn reaction(
    model: &Model,
    joint: &JointModel,
    state: &State,
    work: &Workspace,
) -> (Vector3<f64>, Vector3<f64>) {
    match *joint {
        JointModel::Held { rod, support, sign } => {
            let support = &model.rods[rod].supports[support];
            let node = model.rods[rod].range.start + support.node;
            let pose = &state.poses()[node];
            let (f, m) = support.reaction(pose, &work.forces.force[node], &work.forces.moment[node]);
            (f * sign, m * sign)
        }
        JointModel::Coupled(coupling) => {
            let coupling = &model.couplings[coupling];
            let poses = coupling.poses(state);
            let forces = coupling.constraint.forces(poses[0], poses[1], &coupling.multipliers(state));
            // On the ground acts the opposite of what acts on the other part.
            let (part, sign) = if coupling.nodes[1].is_some() { (1, 1.0) } else { (0, -1.0) };
            let (force, moment) = (forces[part].fixed_rows::<3>(0), forces[part].fixed_rows::<3>(3));
            let (f, m) =
                coupling.constraint.wrench(part, poses[part], &force.into_owned(), &moment.into_owned());
            (f * sign, m * sign)
        }
    }
}

/// The centrelines, without the points that cannot be interpolated.
fn shape(model: &Model, parameter: f64, state: &State) -> Shape {
    let rods = (0..model.rods.len()).map(|rod| {
        let points = (0..=SHAPE_POINTS).map(|k| k as f64 / SHAPE_POINTS as f64);
        points.filter_map(|xi| Some(model.position(state, rod, xi).ok()?.into())).collect()
    });
    Shape { parameter, rods: rods.collect() }
}

/// ±P: w ≥ 0 at the start, then the sign nearer to the row before.
fn continuous(quaternion: Vector4<f64>, before: Option<&ProbePose>) -> Vector4<f64> {
    let same = match before {
        Some(pose) => Vector4::from(pose.quaternion).dot(&quaternion) >= 0.0,
        None => quaternion[0] >= 0.0,
    };
    if same { quaternion } else { -quaternion }
}

/// (α, β, γ) of A = R_x(γ) R_y(β) R_z(α): A₁₁ = cβ cα, A₁₂ = −cβ sα, A₁₃ = sβ, A₂₃ = −sγ cβ, A₃₃ = cγ cβ.
fn euler_zyx(a: &Matrix3<f64>) -> [f64; 3] {
    let cosine = a.m11.hypot(a.m12);
    [(-a.m12).atan2(a.m11), a.m13.atan2(cosine), (-a.m23).atan2(a.m33)]
}

/// Of all angles of the same rotation those nearest to the row before: (α + π, π − β, γ + π) is the same as
/// (α, β, γ), and so are whole turns of each.
fn unwrapped(angles: [f64; 3], before: Option<&ProbePose>) -> [f64; 3] {
    let Some(before) = before.and_then(|pose| pose.angles) else {
        return angles;
    };
    let [alpha, beta, gamma] = angles;
    let nearest = |angles: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|k| angles[k] + TAU * ((before[k] - angles[k]) / TAU).round())
    };
    let way = |angles: &[f64; 3]| -> f64 { angles.iter().zip(&before).map(|(a, b)| (a - b).abs()).sum() };
    let (first, second) = (nearest(angles), nearest([alpha + PI, PI - beta, gamma + PI]));
    if way(&second) < way(&first) { second } else { first }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A turn about e_y through ±90°, where the plain angles fold back.
    #[test]
    fn angles_go_on_where_the_plain_ones_fold() {
        let mut before: Option<ProbePose> = None;
        for k in 0..200 {
            let beta = 0.05 * f64::from(k);
            let rotation =
                Matrix3::new(beta.cos(), 0.0, beta.sin(), 0.0, 1.0, 0.0, -beta.sin(), 0.0, beta.cos());
            let angles = unwrapped(euler_zyx(&rotation), before.as_ref());
            assert!(angles[0].abs() < 1e-9 && (angles[1] - beta).abs() < 1e-9 && angles[2].abs() < 1e-9);
            before = Some(ProbePose {
                position: [0.0; 3],
                quaternion: [1.0, 0.0, 0.0, 0.0],
                angles: Some(angles),
            });
        }
    }
}
