//! Rigid bodies.

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
