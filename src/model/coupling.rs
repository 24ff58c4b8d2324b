//! Joints with multipliers: which nodes they couple, which of their constraints say nothing new, and whether the
//! velocities at the start respect them.

use nalgebra::{DVector, Matrix3, Vector3, Vector6};

use super::{Model, Place};
use crate::constraint::Constraint;
use crate::error::SceneError;
use crate::inertia::Velocity;
use crate::interpolation::Pose;
use crate::linear_solver::NODE;
use crate::scene::{Joint, Scene};
use crate::state::State;

/// A constraint whose row is, up to this part of itself, a sum of others says nothing new: the geometry of a scene
/// is known to rounding, and a mechanism nearer to a dead point than this cannot be told from one that stands in it.
const DEPENDENT: f64 = 1e-8;

/// Velocities that violate a joint by more than this part of themselves are a mistake; less is the rounding of the
/// scene's numbers, and is projected away.
const VIOLATED: f64 = 1e-6;

/// A joint between two of the ground, bodies and rod nodes.
#[derive(Clone, Debug)]
pub(crate) struct Coupling {
    pub constraint: Constraint,
    /// The two nodes in the model; `None` is the ground.
    pub nodes: [Option<usize>; 2],
    /// Those rows of the constraint that are imposed; the others follow from them.
    pub rows: Vec<usize>,
    /// Where its multipliers start.
    pub first: usize,
    /// |s_a| + |s_b|: the size that rotation rounding is multiplied by [m].
    pub reach: f64,
}

/// The ground as a part: it stands where the joint is, so that no digits are lost far from the origin.
pub(crate) const GROUND: Pose = Pose {
    position: Vector3::new(0.0, 0.0, 0.0),
    rotation: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
};

impl Coupling {
    /// Between two places of a model that has its rods and bodies.
    pub fn new(model: &Model, joint: &Joint, places: [Place; 2]) -> Self {
        let part = |place| match place {
            Place::Ground => (None, Vector3::zeros(), GROUND),
            Place::Body(body) => {
                let body = &model.bodies[body];
                (Some(body.node), body.origin, model.reference.poses()[body.node])
            }
            Place::Node { rod, node } => {
                let rod = &model.rods[rod];
                let node = rod.range.start + node;
                (Some(node), rod.origin, model.reference.poses()[node])
            }
        };
        let parts = places.map(part);
        // By default the rod node's point, else the centre of mass of the second body, else of the first.
        let on_rod = |end: &usize| matches!(places[*end], Place::Node { .. });
        let is_body = |end: &usize| matches!(places[*end], Place::Body(_));
        let end = [1, 0].into_iter().find(on_rod).or([1, 0].into_iter().find(is_body)).unwrap_or(1);
        let (origin, start) = match joint.point {
            Some(point) => (Vector3::from(point), Vector3::zeros()),
            None => (parts[end].1, parts[end].2.position),
        };
        let points = parts.map(|(node, own, _)| match node {
            Some(_) => (origin - own) + start,
            None => Vector3::zeros(),
        });
        let axis = Vector3::from(joint.axis.unwrap_or([1.0, 0.0, 0.0]));
        let constraint = Constraint::new(joint.kind, [&parts[0].2, &parts[1].2], points, axis);
        let reach = (0..2).map(|end| (points[end] - parts[end].2.position).norm()).sum();
        Self {
            rows: (0..constraint.rows()).collect(),
            constraint,
            nodes: parts.map(|(node, ..)| node),
            first: 0,
            reach,
        }
    }

    /// The poses of its two parts.
    pub fn poses<'a>(&self, state: &'a State) -> [&'a Pose; 2] {
        self.nodes.map(|node| node.map_or(&GROUND, |node| &state.poses()[node]))
    }

    /// The velocities of its two parts.
    pub fn velocities(&self, velocities: &[Velocity]) -> [Velocity; 2] {
        self.nodes.map(|node| node.map_or_else(Velocity::default, |node| velocities[node]))
    }

    /// λ of all its rows; zero for those that are not imposed.
    pub fn multipliers(&self, state: &State) -> Vector6<f64> {
        let mut result = Vector6::zeros();
        for (&row, &multiplier) in self.rows.iter().zip(&state.multipliers()[self.first..]) {
            result[row] = multiplier;
        }
        result
    }
}

/// Finds the constraints of closed loops that follow from others, stops imposing them, numbers the multipliers, and
/// says what it did.
///
/// Joints are taken in order. One that connects parts without any connection so far has only independent rows. One
/// that closes a loop keeps the rows of G at the start that are no sum of rows before them (Gram–Schmidt, twice, the
/// largest remainder first; lengths in units of the mechanism's size).
pub(crate) fn drop_redundant(model: &mut Model, scene: &Scene) -> Vec<String> {
    let mut warnings = Vec::new();
    // The ground and every coupled node are parts; union by the smallest index.
    let ground = model.reference.poses().len();
    let mut group: Vec<usize> = (0..=ground).collect();
    fn find(group: &[usize], mut part: usize) -> usize {
        while group[part] != part {
            part = group[part];
        }
        part
    }
    let ends = |coupling: &Coupling| coupling.nodes.map(|node| node.unwrap_or(ground));
    let mut loops = vec![false; model.couplings.len()];
    for (closes, coupling) in loops.iter_mut().zip(&model.couplings) {
        let [a, b] = ends(coupling).map(|part| find(&group, part));
        *closes = a == b;
        group[a.max(b)] = a.min(b);
    }
    let looped: Vec<usize> = loops
        .iter()
        .zip(&model.couplings)
        .filter(|(closes, _)| **closes)
        .map(|(_, coupling)| find(&group, ends(coupling)[0]))
        .collect();
    let names: Vec<String> = (0..model.couplings.len())
        .map(|index| {
            let is_it =
                |joint: &super::JointModel| matches!(joint, super::JointModel::Coupled(i) if *i == index);
            scene.joint_name(model.joints.iter().position(is_it).unwrap_or(0))
        })
        .collect();
    let size = model.couplings.iter().map(|coupling| coupling.reach).fold(0.0, f64::max);
    let size = if size > 0.0 { size } else { 1.0 };
    let columns: Vec<usize> = {
        let mut nodes: Vec<usize> =
            model.couplings.iter().flat_map(|c| c.nodes.into_iter().flatten()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut first = 0;
    for index in 0..model.couplings.len() {
        let coupling = &model.couplings[index];
        if looped.contains(&find(&group, ends(coupling)[0])) {
            let mut rows = jacobian_rows(coupling, &model.reference, &columns, size);
            let all = rows.len();
            let mut kept = Vec::new();
            while kept.len() < all {
                for (_, row, _) in &mut rows {
                    for _ in 0..2 {
                        for vector in &basis {
                            row.axpy(-vector.dot(row), vector, 1.0);
                        }
                    }
                }
                let share = |(_, row, norm): &(usize, DVector<f64>, f64)| row.norm() / norm;
                let Some(best) = (0..rows.len()).max_by(|&a, &b| share(&rows[a]).total_cmp(&share(&rows[b])))
                else {
                    break;
                };
                if share(&rows[best]) <= DEPENDENT {
                    break;
                }
                let (row, vector, _) = rows.swap_remove(best);
                basis.push(vector.normalize());
                kept.push(row);
            }
            kept.sort_unstable();
            if kept.len() < all {
                warnings.push(format!(
                    "{} of the {all} constraints of joint `{}` follow from those of other joints and are not \
                     imposed again; the motion is the same, but the forces in that loop of joints are one \
                     possible set of many",
                    all - kept.len(),
                    names[index]
                ));
            }
            model.couplings[index].rows = kept;
        }
        model.couplings[index].first = first;
        first += model.couplings[index].rows.len();
    }
    warnings
}

/// The rows of G of one joint over the given nodes with their norms, lengths in units of `size`.
fn jacobian_rows(
    coupling: &Coupling,
    state: &State,
    columns: &[usize],
    size: f64,
) -> Vec<(usize, DVector<f64>, f64)> {
    let [a, b] = coupling.poses(state);
    let parts = coupling.constraint.jacobian(a, b);
    let row = |row: usize| {
        let mut vector = DVector::<f64>::zeros(NODE * columns.len());
        for (node, part) in coupling.nodes.iter().zip(&parts) {
            let Some(node) = node else { continue };
            let start = NODE * columns.binary_search(node).unwrap_or(0);
            for column in 0..NODE {
                // δr = size · (δr/size); a gap in length is divided by the size, too.
                let of_translation = if column < 3 { size } else { 1.0 };
                let of_row = if row < 3 { 1.0 / size } else { 1.0 };
                vector[start + column] += part[(row, column)] * of_translation * of_row;
            }
        }
        let norm = vector.norm().max(f64::MIN_POSITIVE);
        (row, vector, norm)
    };
    (0..coupling.constraint.rows()).map(row).collect()
}

/// Refuses velocities at the start that a joint cannot have: ‖G u‖ against the velocities themselves.
pub(crate) fn refuse_violating_velocities(model: &Model, scene: &Scene) -> Result<(), SceneError> {
    let velocities = model.initial_velocities();
    for (index, joint) in model.joints.iter().enumerate() {
        let super::JointModel::Coupled(coupling) = joint else { continue };
        let coupling = &model.couplings[*coupling];
        let [a, b] = coupling.poses(&model.reference);
        let mut rate = Vector6::zeros();
        let (mut speed, mut spin) = (0.0_f64, 0.0_f64);
        for (part, velocity) in
            coupling.constraint.jacobian(a, b).iter().zip(coupling.velocities(&velocities))
        {
            let mut u = Vector6::zeros();
            u.fixed_rows_mut::<3>(0).copy_from(&velocity.translation);
            u.fixed_rows_mut::<3>(3).copy_from(&velocity.rotation);
            rate += part * u;
            speed = speed.max(velocity.translation.norm() + velocity.rotation.norm() * coupling.reach);
            spin = spin.max(velocity.rotation.norm());
        }
        let translation = rate.fixed_rows::<3>(0).norm();
        let rotation = rate.fixed_rows::<3>(3).norm();
        if translation > VIOLATED * speed || rotation > VIOLATED * spin {
            let (violation, unit) =
                if translation > VIOLATED * speed { (translation, "m/s") } else { (rotation, "rad/s") };
            return Err(SceneError::new(
                format!("joint.{index}"),
                format!(
                    "is `{}`, which the velocities at the start violate: its parts separate by {violation:.3e} {unit}",
                    scene.joint_name(index)
                ),
                "velocities and angular velocities of the joined bodies that agree at the joint; rods start at rest",
            ));
        }
    }
    Ok(())
}
