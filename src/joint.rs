//! Joints between a rod's node and the ground, as what they leave free.
//!
//! A joint holds the point c = r + A s of a node (s the lever in the body basis) and leaves the body rotations
//! δφ = P z free: P = 0 rigid, 1 spherical, a aᵀ revolute with axis a (body basis). The compatible nodal
//! increments are (δr, δφ) = T z, T = (A s̃ P; P), because δr = −A δφ̃ s = A s̃ δφ. The equilibrium of what is
//! free is Tᵀ f = 0, and the joint's reaction is what is left of f. Nothing is multiplied: the held unknowns do
//! not exist, their rows are the identity.

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::element::ElementTangent;
use crate::interpolation::{Increment, Pose};
use crate::rotation::{direction, skew};
use crate::scene::JointKind;

/// A node held by the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// Index of the node within its rod.
    pub node: usize,
    /// The held point c, inertial [m].
    pub anchor: Vector3<f64>,
    /// s, from the node to the held point in the node's body basis [m].
    pub lever: Vector3<f64>,
    /// P, onto the free rotations in the body basis.
    pub free: Matrix3<f64>,
    /// Number of free rotations.
    pub freedom: usize,
}

impl Support {
    /// From the pose of the node at the start; `axis` inertial, of any non-zero length.
    pub fn new(node: usize, kind: JointKind, pose: &Pose, point: Vector3<f64>, axis: Vector3<f64>) -> Self {
        let lever = pose.rotation.tr_mul(&(point - pose.position));
        let (free, freedom) = match kind {
            JointKind::Rigid => (Matrix3::zeros(), 0),
            JointKind::Spherical => (Matrix3::identity(), 3),
            JointKind::Revolute => {
                let axis = pose.rotation.tr_mul(&direction(&axis));
                (axis * axis.transpose(), 1)
            }
        };
        Self { node, anchor: point, lever, free, freedom }
    }

    /// The node's position for its rotation: r = c − A s.
    pub fn position(&self, rotation: &Matrix3<f64>) -> Vector3<f64> {
        self.anchor - rotation * self.lever
    }

    /// T z for the solved rotation z.
    pub fn increment(&self, rotation: &Matrix3<f64>, z: &Vector3<f64>) -> Increment {
        let free = self.free * z;
        Increment { translation: rotation * self.lever.cross(&free), rotation: free }
    }

    /// T as a 6×6 matrix with zero columns for what is held.
    fn compatible(&self, rotation: &Matrix3<f64>) -> Matrix6<f64> {
        let mut t = Matrix6::zeros();
        t.fixed_view_mut::<3, 3>(0, 3).copy_from(&(rotation * skew(&self.lever) * self.free));
        t.fixed_view_mut::<3, 3>(3, 3).copy_from(&self.free);
        t
    }

    /// The moment row of Tᵀ f; the force row is zero.
    pub fn free_moment(
        &self,
        rotation: &Matrix3<f64>,
        force: &Vector3<f64>,
        moment: &Vector3<f64>,
    ) -> Vector3<f64> {
        // s̃ᵀ b = −s × b.
        self.free * (moment - self.lever.cross(&rotation.tr_mul(force)))
    }

    /// Turns the blocks of local node `i` into Tᵀ K T; `owner` adds, once per node, the identity of what is held
    /// and the change of T: −∂(Tᵀ f)/∂φ at fixed f is P s̃ (Aᵀ f)~ P.
    pub fn reduce<const N: usize>(
        &self,
        tangent: &mut ElementTangent<N>,
        i: usize,
        rotation: &Matrix3<f64>,
        force: &Vector3<f64>,
        owner: bool,
    ) {
        let t = self.compatible(rotation);
        for k in 0..N {
            tangent[k][i] *= t;
        }
        for block in &mut tangent[i] {
            *block = t.tr_mul(block);
        }
        if owner {
            let turned = self.free * skew(&self.lever) * skew(&rotation.tr_mul(force)) * self.free;
            let diagonal = &mut tangent[i][i];
            let mut held = diagonal.fixed_view_mut::<3, 3>(0, 0);
            held += Matrix3::identity();
            let mut rotations = diagonal.fixed_view_mut::<3, 3>(3, 3);
            rotations += turned + Matrix3::identity() - self.free;
        }
    }

    /// (force, moment about the held point) that the ground exerts on the rod, inertial, from the node's rows f.
    pub fn reaction(
        &self,
        pose: &Pose,
        force: &Vector3<f64>,
        moment: &Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let arm = pose.position - self.anchor;
        (-force, -(pose.rotation * moment) - arm.cross(force))
    }
}
