//! The unknowns: nodal positions and quaternions with how an increment is added to them, and the joints'
//! multipliers.

use nalgebra::{Vector3, Vector4};

use crate::interpolation::{Increment, Pose};
use crate::rotation::{
    normalized, quaternion_exp, quaternion_of, quaternion_product, rotation_matrix, rotation_vector,
};

/// Nodal positions and quaternions, the matrices A(P) beside them, and the multipliers of the joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    quaternions: Vec<Vector4<f64>>,
    poses: Vec<Pose>,
    multipliers: Vec<f64>,
}

impl State {
    /// Nodes at given poses.
    pub fn from_poses(poses: impl IntoIterator<Item = Pose>) -> Self {
        let mut state = Self::default();
        for pose in poses {
            state.push(pose.position, quaternion_of(&pose.rotation));
        }
        state
    }

    /// Appends a node; the quaternion may have any non-zero norm.
    pub fn push(&mut self, position: Vector3<f64>, quaternion: Vector4<f64>) {
        self.quaternions.push(quaternion);
        self.poses.push(Pose { position, rotation: rotation_matrix(&quaternion) });
    }

    /// Appends all nodes of another state.
    pub fn append(&mut self, mut other: Self) {
        self.quaternions.append(&mut other.quaternions);
        self.poses.append(&mut other.poses);
    }

    /// Nodal poses.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Nodal quaternions.
    pub fn quaternions(&self) -> &[Vector4<f64>] {
        &self.quaternions
    }

    /// λ of the joints that have multipliers [N, N m].
    pub fn multipliers(&self) -> &[f64] {
        &self.multipliers
    }

    /// λ, to be changed.
    pub fn multipliers_mut(&mut self) -> &mut [f64] {
        &mut self.multipliers
    }

    /// Sets all multipliers to zero, as many as given.
    pub(crate) fn set_multiplier_count(&mut self, count: usize) {
        self.multipliers = vec![0.0; count];
    }

    /// r ← r + δr, P ← P ∘ exp(δφ), kept at unit norm.
    pub fn add(&mut self, node: usize, increment: &Increment) {
        self.poses[node].position += increment.translation;
        let turned = quaternion_product(&self.quaternions[node], &quaternion_exp(&increment.rotation));
        self.set_quaternion(node, normalized(&turned));
    }

    /// Sets a node's position.
    pub fn set_position(&mut self, node: usize, position: Vector3<f64>) {
        self.poses[node].position = position;
    }

    /// Sets a node's quaternion, of any non-zero norm.
    pub fn set_quaternion(&mut self, node: usize, quaternion: Vector4<f64>) {
        self.quaternions[node] = quaternion;
        self.poses[node].rotation = rotation_matrix(&quaternion);
    }

    /// Normalises every quaternion; turns nothing.
    pub fn normalize(&mut self) {
        for node in 0..self.quaternions.len() {
            self.set_quaternion(node, normalized(&self.quaternions[node]));
        }
    }

    /// The increment that leads from `earlier` to this state at a node, by the shortest rotation.
    pub fn increment_since(&self, earlier: &Self, node: usize) -> Increment {
        let before = earlier.quaternions[node];
        let inverse = Vector4::new(before[0], -before[1], -before[2], -before[3]);
        let relative = normalized(&quaternion_product(&inverse, &self.quaternions[node]));
        Increment {
            translation: self.poses[node].position - earlier.poses[node].position,
            rotation: rotation_vector(&relative),
        }
    }
}
