//! Coefficients of the Radau IIA method with three stages, and the eigenvalues that split its equations.

use nalgebra::{Complex, Matrix3, Vector3};

/// Stages.
pub const STAGES: usize = 3;

/// An eigenvalue of A with its eigenvectors, ℓᵀ A = μ ℓᵀ, A t = μ t, ℓᵀ t = 1.
#[derive(Clone, Copy, Debug)]
pub struct Eigen {
    /// μ.
    pub value: Complex<f64>,
    /// t.
    pub right: Vector3<Complex<f64>>,
    /// ℓ.
    pub left: Vector3<Complex<f64>>,
}

/// The coefficients (Hairer & Wanner, Solving Ordinary Differential Equations II, table IV.5.6). The weights are the
/// last row of A: a step ends at its last stage.
#[derive(Clone, Copy, Debug)]
pub struct Tableau {
    /// A: y_i = y₀ + h Σ a_ij ẏ_j.
    pub a: Matrix3<f64>,
    /// c: stage i is at t₀ + c_i h.
    pub c: Vector3<f64>,
    /// The real eigenvalue of A, and the complex one with positive imaginary part.
    pub eigen: [Eigen; 2],
}

impl Tableau {
    /// Computes the coefficients.
    ///
    /// The eigenvalues are the zeros of μ³ − 3/5 μ² + 3/20 μ − 1/60 by Cardano's formula, with p = ∛81 and q = ∛9:
    ///
    /// ```text
    /// μ = (6 + p − q)/30     and     μ = (12 − p + q)/60 ± i √3 (p + q)/60
    /// ```
    pub fn new() -> Self {
        let s = 6.0_f64.sqrt();
        let a = Matrix3::new(
            (88.0 - 7.0 * s) / 360.0,
            (296.0 - 169.0 * s) / 1800.0,
            (-2.0 + 3.0 * s) / 225.0,
            (296.0 + 169.0 * s) / 1800.0,
            (88.0 + 7.0 * s) / 360.0,
            (-2.0 - 3.0 * s) / 225.0,
            (16.0 - s) / 36.0,
            (16.0 + s) / 36.0,
            1.0 / 9.0,
        );
        let (p, q) = (81.0_f64.cbrt(), 9.0_f64.cbrt());
        let real = Complex::new((6.0 + p - q) / 30.0, 0.0);
        let complex = Complex::new((12.0 - p + q) / 60.0, (p + q) * 3.0_f64.sqrt() / 60.0);
        Self {
            a,
            c: Vector3::new((4.0 - s) / 10.0, (4.0 + s) / 10.0, 1.0),
            eigen: [real, complex].map(|value| eigen(&a, value)),
        }
    }

    /// The polynomial with the values y_i at c_i, at x: its Lagrange factors.
    pub fn interpolate(&self, x: f64) -> Vector3<f64> {
        let c = &self.c;
        Vector3::from_fn(|i, _| (0..STAGES).filter(|&j| j != i).map(|j| (x - c[j]) / (c[i] - c[j])).product())
    }
}

/// A − μ has rank 2: its null vector is perpendicular to two of its rows, the left one to two of its columns.
fn eigen(a: &Matrix3<f64>, value: Complex<f64>) -> Eigen {
    let shifted = a.map(Complex::from) - Matrix3::from_diagonal_element(value);
    let right = shifted.row(0).transpose().cross(&shifted.row(1).transpose());
    let left = shifted.column(0).cross(&shifted.column(1));
    Eigen { value, right, left: left / left.dot(&right) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// B(5): Σ b_i c_i^(k−1) = 1/k; C(3): Σ a_ij c_j^(k−1) = c_i^k/k; D(2): Σ b_i c_i^(k−1) a_ij = b_j (1 − c_j^k)/k.
    /// They are what order 5 follows from.
    #[test]
    fn simplifying_assumptions_hold() {
        let Tableau { a, c, .. } = Tableau::new();
        let b = a.row(2);
        let power = |k: i32| c.map(|c| c.powi(k));
        for k in 1..=5 {
            assert!(((b * power(k - 1)).x - 1.0 / k as f64).abs() < 1e-15);
        }
        for k in 1..=3 {
            assert!((a * power(k - 1) - power(k) / k as f64).amax() < 1e-15);
        }
        for k in 1..=2 {
            let left = b.component_mul(&power(k - 1).transpose()) * a;
            let right = b.component_mul(&power(k).map(|c| (1.0 - c) / k as f64).transpose());
            assert!((left - right).amax() < 1e-15);
        }
    }

    /// A = μ t ℓᵀ + 2 Re(μ t ℓᵀ) and 1 = t ℓᵀ + 2 Re(t ℓᵀ) over the real and the complex eigenvalue.
    #[test]
    fn eigenvalues_and_vectors_give_a_back() {
        let Tableau { a, eigen: [real, complex], .. } = Tableau::new();
        let part = |e: &Eigen| e.right * e.left.transpose();
        let sum = |f: &dyn Fn(&Eigen) -> Complex<f64>| {
            (part(&real) * f(&real)).map(|x| x.re) + (part(&complex) * f(&complex)).map(|x| 2.0 * x.re)
        };
        assert!((sum(&|e| e.value) - a).amax() < 1e-15);
        assert!((sum(&|_| Complex::new(1.0, 0.0)) - Matrix3::identity()).amax() < 1e-14);
    }

    #[test]
    fn interpolation_is_exact_for_parabolas() {
        let tableau = Tableau::new();
        let parabola = |x: f64| 3.0 * x * x - 2.0 * x + 5.0;
        let x = 1.6;
        assert!((tableau.interpolate(x).dot(&tableau.c.map(parabola)) - parabola(x)).abs() < 1e-13);
    }
}
