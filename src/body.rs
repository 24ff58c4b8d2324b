//! Rigid bodies: mass and inertia of the shapes, Newton's and Euler's equations about the centre of mass.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::inertia::{Velocity, gyroscopic_moment, gyroscopic_tangent, spin_from_turn};
use crate::scene::{Body, Shape};

/// Mass and principal inertia of a rigid body about its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// m [kg].
    pub mass: f64,
    /// Diagonal of Θ in the body basis [kg m²].
    pub inertia: Vector3<f64>,
}

/// Volume [m³] and mean squares (x̄², ȳ², z̄²) of the distances from the planes through the centre [m²].
fn geometry(shape: &Shape) -> (f64, Vector3<f64>) {
    match *shape {
        // ∫ x² dA = π r⁴/4, ∫ z² dz = h³/12.
        Shape::Cylinder { radius, height } => {
            let across = radius * radius / 4.0;
            (PI * radius * radius * height, Vector3::new(across, across, height * height / 12.0))
        }
        Shape::Cuboid { size } => (size.iter().product(), Vector3::from(size.map(|edge| edge * edge / 12.0))),
        // A third of the mean of ‖x‖², ∫ r⁴ dr/∫ r² dr = 3 r²/5.
        Shape::Sphere { radius } => (4.0 / 3.0 * PI * radius.powi(3), Vector3::repeat(radius * radius / 5.0)),
    }
}

impl MassProperties {
    /// From shape and density, Θ = m (ȳ² + z̄², z̄² + x̄², x̄² + ȳ²), or from mass and inertia; `None` unless exactly
    /// one of the two pairs is given.
    pub fn new(body: &Body) -> Option<Self> {
        match (&body.shape, body.density, body.mass, body.inertia) {
            (Some(shape), Some(density), None, None) => {
                let (volume, squares) = geometry(shape);
                let mass = density * volume;
                let (x, y, z) = (squares.x, squares.y, squares.z);
                Some(Self { mass, inertia: mass * Vector3::new(y + z, z + x, x + y) })
            }
            (None, None, Some(mass), Some(inertia)) => Some(Self { mass, inertia: Vector3::from(inertia) }),
            _ => None,
        }
    }

    /// (−m v̇, −Θ ω̇ − ω × Θω): force inertial [N], moment body [N m], for the velocity u and the acceleration u̇.
    #[inline]
    pub fn inertia_force(&self, u: &Velocity, rate: &Velocity) -> (Vector3<f64>, Vector3<f64>) {
        let moment =
            self.inertia.component_mul(&rate.rotation) + gyroscopic_moment(&self.inertia, &u.rotation);
        (-self.mass * rate.translation, -moment)
    }

    /// (M + b D) diag(1, Y⁻¹), D = ω̃ Θ − (Θω)~: b² times the tangent −∂f/∂(δr, δφ) of [`Self::inertia_force`] in an
    /// implicit step, δu̇ = δu/b, δv = δr/b, δω = Y⁻¹ δφ/b (see [`spin_from_turn`]).
    #[inline]
    pub fn inertia_tangent(&self, u: &Velocity, b: f64) -> Matrix6<f64> {
        let rotary =
            Matrix3::from_diagonal(&self.inertia) + gyroscopic_tangent(&self.inertia, &(u.rotation * b));
        let mut tangent = Matrix6::zeros();
        tangent.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(self.mass);
        tangent.fixed_view_mut::<3, 3>(3, 3).copy_from(&(rotary * spin_from_turn(&u.rotation, b)));
        tangent
    }

    /// ½ (m v·v + ω·Θω) [J].
    #[inline]
    pub fn kinetic_energy(&self, u: &Velocity) -> f64 {
        let spin = self.inertia.component_mul(&u.rotation);
        0.5 * (self.mass * u.translation.norm_squared() + u.rotation.dot(&spin))
    }
}
