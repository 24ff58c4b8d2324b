//! Rigid bodies.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::rod::identity_quaternion;

/// A rigid body: a shape with a density, or mass and principal inertia.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Unique among rods and bodies.
    pub name: String,
    /// The shape; together with `density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Mass density [kg/m³]; together with `shape`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Mass [kg]; together with `inertia`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Moments of inertia about the centre of mass and the principal axes e_x, e_y, e_z of the body [kg m²].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<[f64; 3]>,
    /// The centre of mass at the start, inertial [m].
    pub position: [f64; 3],
    /// Quaternion `[w, x, y, z]` from the body to the inertial basis at the start, of any non-zero norm.
    #[serde(default = "identity_quaternion")]
    pub orientation: [f64; 4],
    /// Velocity of the centre of mass at the start, inertial [m/s].
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Angular velocity at the start, body basis [rad/s].
    #[serde(default)]
    pub angular_velocity: [f64; 3],
}

impl Body {
    /// Mass [kg] and moments of inertia about the centre of mass and the principal axes [kg m²]; `None` for an
    /// invalid combination.
    pub(crate) fn mass_and_inertia(&self) -> Option<(f64, [f64; 3])> {
        match (&self.shape, self.density, self.mass, self.inertia) {
            (Some(shape), Some(density), None, None) => {
                let mass = density * shape.volume();
                Some((mass, shape.squared_gyration().map(|squared| mass * squared)))
            }
            (None, None, Some(mass), Some(inertia)) => Some((mass, inertia)),
            _ => None,
        }
    }
}

/// The shape of a homogeneous body about its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A circular cylinder with the axis e_z.
    Cylinder {
        /// Radius [m].
        radius: f64,
        /// Height [m].
        height: f64,
    },
    /// A box.
    Cuboid {
        /// Edges along e_x, e_y, e_z [m].
        size: [f64; 3],
    },
    /// A ball.
    Sphere {
        /// Radius [m].
        radius: f64,
    },
}

impl Shape {
    /// Volume [m³].
    fn volume(&self) -> f64 {
        match *self {
            Self::Cylinder { radius, height } => PI * radius * radius * height,
            Self::Cuboid { size: [x, y, z] } => x * y * z,
            Self::Sphere { radius } => 4.0 / 3.0 * PI * radius * radius * radius,
        }
    }

    /// Moments of inertia about e_x, e_y, e_z for unit mass [m²].
    fn squared_gyration(&self) -> [f64; 3] {
        match *self {
            Self::Cylinder { radius, height } => {
                let across = radius * radius / 4.0 + height * height / 12.0;
                [across, across, radius * radius / 2.0]
            }
            Self::Cuboid { size } => {
                let [x, y, z] = size.map(|edge| edge * edge / 12.0);
                [y + z, z + x, x + y]
            }
            Self::Sphere { radius } => [0.4 * radius * radius; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel(shape: Shape) -> (f64, [f64; 3]) {
        let body = Body {
            name: "bob".into(),
            shape: Some(shape),
            density: Some(7850.0),
            mass: None,
            inertia: None,
            position: [0.0; 3],
            orientation: identity_quaternion(),
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
        };
        body.mass_and_inertia().unwrap()
    }

    #[test]
    fn the_bob_of_the_wilberforce_pendulum() {
        let (mass, inertia) = steel(Shape::Cylinder { radius: 23e-3, height: 36e-3 });
        assert!((mass - 0.4696536503855).abs() < 1e-13);
        assert!((inertia[0] - 1.1283428951e-4).abs() < 1e-14 && inertia[0] == inertia[1]);
        assert!((inertia[2] - 1.2422339053e-4).abs() < 1e-14);
    }

    #[test]
    fn a_cube_has_the_inertia_of_a_ball_but_for_a_factor() {
        let (mass, inertia) = steel(Shape::Cuboid { size: [0.1, 0.1, 0.1] });
        assert!((mass - 7.85).abs() < 1e-14);
        assert!(inertia.iter().all(|moment| (moment - mass * 0.01 / 6.0).abs() < 1e-16));
        let (mass, inertia) = steel(Shape::Sphere { radius: 0.1 });
        assert!((mass - 7850.0 * 4.0 / 3.0 * PI * 1e-3).abs() < 1e-12);
        assert!(inertia.iter().all(|moment| (moment - 0.4 * mass * 0.01).abs() < 1e-15));
    }
}
