//! Rows and shapes of a solution while it grows.

use nalgebra::{Matrix3, Vector3, Vector4};

use crate::assembly::Workspace;
use crate::model::{Model, ProbeModel};
use crate::rotation::quaternion_of;
use crate::solution::{ProbePose, Row, Shape, Solution, Statistics, StopReason};
use crate::state::State;

/// Shapes kept beside the start: at the first increments past k/SHAPES of the path.
const SHAPES: usize = 8;
/// Points of a rod's centreline in a shape.
const SHAPE_POINTS: usize = 1000;

/// Collects a solution.
pub struct Recorder {
    solution: Solution,
}

impl Recorder {
    /// For a model.
    pub fn new(model: &Model) -> Self {
        let solution = Solution {
            unknowns: model.unknowns(),
            warnings: model.warnings().to_vec(),
            ..Solution::default()
        };
        Self { solution }
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
            let pose =
                model.pose(state, probe.rod, probe.xi, &probe.offset).map_err(|_| half_turn(model, probe))?;
            let before = previous.map(|row| &row.probes[index]);
            let quaternion = continuous(quaternion_of(&pose.rotation), before);
            let angles = probe.angles.map(|_| unwrapped(euler_zyx(&pose.rotation), before));
            probes.push(ProbePose { position: pose.position.into(), quaternion: quaternion.into(), angles });
        }
        let reactions = model.joints.iter().map(|joint| {
            let (rod, work) = (&model.rods[joint.rod], &work.rods[joint.rod]);
            let support = &rod.supports[joint.support];
            let pose = &state.poses()[rod.range.start + support.node];
            let (f, m) =
                support.reaction(pose, &work.forces.force[support.node], &work.forces.moment[support.node]);
            let (f, m) = (f * joint.sign, m * joint.sign);
            [f.x, f.y, f.z, m.x, m.y, m.z]
        });
        let row = Row { parameter, probes, reactions: reactions.collect() };
        self.solution.rows.push(row);
        let wanted =
            self.solution.shapes.last().map_or(0.0, |shape| {
                ((shape.parameter * SHAPES as f64 + 1e-9).floor() + 1.0) / SHAPES as f64
            });
        if parameter >= wanted - 1e-9 {
            self.solution.shapes.push(shape(model, parameter, state));
        }
        Ok(())
    }

    /// The solution; warns where the mesh resolves the reference, but not the last state.
    pub fn finish(mut self, model: &Model, state: &State, statistics: Statistics) -> Solution {
        if model.warnings().is_empty() {
            self.solution.warnings = model.unresolved(state, "last state");
        }
        Solution { statistics, ..self.solution }
    }
}

fn half_turn(model: &Model, probe: &ProbeModel) -> StopReason {
    let elements = model.rods[probe.rod].elements;
    StopReason::HalfTurn {
        rod: probe.rod,
        element: ((probe.xi * elements as f64) as usize).min(elements - 1),
    }
}

/// The centrelines, without the points that cannot be interpolated.
fn shape(model: &Model, parameter: f64, state: &State) -> Shape {
    let rods = (0..model.rods.len()).map(|rod| {
        let points = (0..=SHAPE_POINTS).map(|k| k as f64 / SHAPE_POINTS as f64);
        let pose = |xi| model.pose(state, rod, xi, &Vector3::zeros());
        points.filter_map(|xi| Some(pose(xi).ok()?.position.into())).collect()
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

/// Adds whole turns to come nearest to the row before.
fn unwrapped(angles: [f64; 3], before: Option<&ProbePose>) -> [f64; 3] {
    let Some(before) = before.and_then(|pose| pose.angles) else {
        return angles;
    };
    std::array::from_fn(|k| {
        let turn = std::f64::consts::TAU;
        angles[k] + turn * ((before[k] - angles[k]) / turn).round()
    })
}
