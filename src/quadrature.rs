//! Gauss–Legendre rules and Gauss–Lobatto points on [0, 1].

use std::f64::consts::PI;

/// A quadrature rule on [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrature {
    /// Points, ascending.
    pub points: Vec<f64>,
    /// Weights; their sum is 1.
    pub weights: Vec<f64>,
}

/// P_n(x), P_{n−1}(x) by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut p, mut previous) = (1.0, 0.0);
    for k in 0..n {
        let k1 = k as f64;
        (p, previous) = (((2.0 * k1 + 1.0) * x * p - k1 * previous) / (k1 + 1.0), p);
    }
    (p, previous)
}

/// The n-point Gauss–Legendre rule, exact for polynomials of degree 2n − 1: Newton's iteration on P_n.
pub fn gauss_legendre(n: usize) -> Quadrature {
    let mut rule = Quadrature { points: Vec::with_capacity(n), weights: Vec::with_capacity(n) };
    for i in 0..n {
        let mut x = -(PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..10 {
            let (p, previous) = legendre(n, x);
            slope = n as f64 * (x * p - previous) / (x * x - 1.0);
            x -= p / slope;
        }
        rule.points.push(0.5 * (1.0 + x));
        rule.weights.push(1.0 / ((1.0 - x * x) * slope * slope));
    }
    rule
}

/// The p + 1 Gauss–Lobatto points: 0, 1 and the zeros of P_p′ between them.
pub fn gauss_lobatto_points(p: usize) -> Vec<f64> {
    (0..=p)
        .map(|i| {
            if i == 0 {
                return 0.0;
            }
            if i == p {
                return 1.0;
            }
            // Newton on P_p′, whose derivative follows from Legendre's equation.
            let mut x = -(PI * i as f64 / p as f64).cos();
            for _ in 0..20 {
                let (value, previous) = legendre(p, x);
                let n = p as f64;
                let slope = n * (x * value - previous) / (x * x - 1.0);
                let curvature = (2.0 * x * slope - n * (n + 1.0) * value) / (1.0 - x * x);
                x -= slope / curvature;
            }
            0.5 * (1.0 + x)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_rules_are_exact_to_their_degree_and_no_further() {
        for n in 1..=41 {
            let rule = gauss_legendre(n);
            let moment = |k: i32| {
                rule.points.iter().zip(&rule.weights).map(|(x, w)| w * (2.0 * x - 1.0).powi(k)).sum::<f64>()
            };
            for k in 0..2 * n as i32 {
                let exact = if k % 2 == 0 { 1.0 / (k + 1) as f64 } else { 0.0 };
                assert!((moment(k) - exact).abs() < 4e-15, "n = {n}, degree {k}");
            }
            if n <= 12 {
                assert!((moment(2 * n as i32) - 1.0 / (2 * n + 1) as f64).abs() > 1e-9);
            }
        }
    }

    #[test]
    fn lobatto_points_are_symmetric_and_known() {
        assert_eq!(gauss_lobatto_points(1), [0.0, 1.0]);
        assert!((gauss_lobatto_points(2)[1] - 0.5).abs() < 1e-16);
        let expected = 0.5 * (1.0 - (1.0f64 / 5.0).sqrt());
        assert!((gauss_lobatto_points(3)[1] - expected).abs() < 1e-15);
        for p in 1..=8 {
            let points = gauss_lobatto_points(p);
            for i in 0..=p {
                assert!((points[i] + points[p - i] - 1.0).abs() < 1e-15);
            }
        }
    }
}
