//! The same scene turned and shifted in space: a rod does not know where it is.

use cosserat::scene::{Basis, Scene};
use nalgebra::{UnitQuaternion, Vector3};

/// A rigid motion x ↦ shift + R x of a whole scene.
#[derive(Clone, Debug)]
pub struct Placement {
    pub name: &'static str,
    pub rotation: UnitQuaternion<f64>,
    pub shift: Vector3<f64>,
}

/// As it is, and two other orientations and positions; `size` is a length of the scene [m].
pub fn placements(size: f64) -> [Placement; 3] {
    let turned = |x: f64, y: f64, z: f64| UnitQuaternion::from_scaled_axis(Vector3::new(x, y, z));
    [
        Placement { name: "as is", rotation: UnitQuaternion::identity(), shift: Vector3::zeros() },
        Placement {
            name: "turned",
            rotation: turned(0.7, -1.9, 0.4),
            shift: size * Vector3::new(0.3, -2.0, 1.1),
        },
        Placement {
            name: "upside down",
            rotation: turned(3.0, 0.6, -0.2),
            shift: size * Vector3::new(-7.0, 4.0, 9.0),
        },
    ]
}

impl Placement {
    /// The scene in its new place.
    pub fn apply(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        let turn = |v: [f64; 3]| -> [f64; 3] { (self.rotation * Vector3::from(v)).into() };
        let place = |v: [f64; 3]| -> [f64; 3] { (self.shift + self.rotation * Vector3::from(v)).into() };
        scene.gravity = scene.gravity.map(turn);
        for rod in &mut scene.rod {
            rod.curve.origin = place(rod.curve.origin);
            let [w, x, y, z] = rod.curve.orientation;
            let before = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
            let q = self.rotation * before;
            rod.curve.orientation = [q.w, q.i, q.j, q.k];
        }
        for body in &mut scene.body {
            body.position = place(body.position);
            body.velocity = turn(body.velocity);
            let [w, x, y, z] = body.orientation;
            let before = nalgebra::Quaternion::new(w, x, y, z);
            let q = self.rotation.quaternion() * before;
            body.orientation = [q.w, q.i, q.j, q.k];
        }
        for joint in &mut scene.joint {
            joint.point = joint.point.map(place);
            joint.axis = joint.axis.map(turn);
        }
        for load in scene.load.iter_mut().filter(|load| load.basis == Basis::Inertial) {
            load.value = turn(load.value);
        }
        scene
    }

    /// A displacement or direction of the placed scene in the axes of the original one.
    pub fn undo_direction(&self, v: Vector3<f64>) -> Vector3<f64> {
        self.rotation.inverse() * v
    }

    /// A position of the placed scene in the original one.
    pub fn undo_position(&self, v: Vector3<f64>) -> Vector3<f64> {
        self.rotation.inverse() * (v - self.shift)
    }

    /// A quaternion of the placed scene in the original one.
    pub fn undo_quaternion(&self, [w, x, y, z]: [f64; 4]) -> [f64; 4] {
        let q =
            self.rotation.inverse() * UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(w, x, y, z));
        [q.w, q.i, q.j, q.k]
    }
}
