//! The error of a step, where steps follow an accuracy: that of a formula of order 3 with the rate at the start as a
//! fourth node (Hairer & Wanner, IV.8), b̂_i = b_i − μ ℓ_i(0), with the real eigenvalue μ of A and Lagrange's
//! polynomials ℓ_i of the stages,
//!
//! ```text
//! μ h (q̇₀ − Σ ℓ_i(0) q̇_i) = −μ c₁ c₂ c₃ h⁴ q⃜/6 = −μ h⁴ q⃜/60
//! ```
//!
//! It is more than the error of order 5. A step remembers nothing of those before, so that kinks do no harm.

use nalgebra::{Vector3, Vector4};

use super::Radau;
use crate::dynamics::Moving;
use crate::dynamics::accuracy::Leading;
use crate::rotation::{quaternion_product, quaternion_rate};

impl Radau {
    /// μ h³ q⃜/60 a unit of time.
    pub(super) fn estimate_leading(&self) -> Leading {
        Leading { order: 3, constant: self.tableau.eigen[0].value.re / 60.0, kink: 0.0 }
    }

    /// q⃜ of every node from q̇ = (v, Q(P) ω) at the start and at the stages; of P as an angle, 2 P̄ ∘ P⃜.
    pub(super) fn estimate(&mut self, start: &Moving, length: f64) {
        let factors = self.tableau.interpolate(0.0);
        let scale = 60.0 / length.powi(3);
        for (node, derivative) in self.derivatives.iter_mut().enumerate() {
            let quaternion = &start.state.quaternions()[node];
            let before = &start.motion.velocities[node];
            let mut velocity = -before.translation;
            let mut rate = -(quaternion_rate(quaternion) * before.rotation);
            for (stage, factor) in self.stages.iter().zip(factors.iter()) {
                let now = &stage.motion.velocities[node];
                velocity += now.translation * *factor;
                rate += quaternion_rate(&stage.state.quaternions()[node]) * now.rotation * *factor;
            }
            let conjugate = Vector4::new(quaternion[0], -quaternion[1], -quaternion[2], -quaternion[3]);
            let turned = quaternion_product(&conjugate, &rate);
            derivative.translation = velocity * scale;
            derivative.rotation = Vector3::new(turned[1], turned[2], turned[3]) * (2.0 * scale);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tableau::Tableau;

    /// A cubic rate with the third derivative 6 misses its parabola by h³/60 times that at the start.
    #[test]
    fn a_cubic_misses_the_parabola_of_the_stages_by_a_sixtieth() {
        let tableau = Tableau::new();
        let cubic = |x: f64| x * x * x - 2.0 * x * x + 3.0;
        let missed = tableau.interpolate(0.0).dot(&tableau.c.map(cubic)) - cubic(0.0);
        assert!((60.0 * missed - 6.0).abs() < 1e-12, "{missed}");
    }
}
