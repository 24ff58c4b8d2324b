//! Lagrange basis on one element, x ∈ [0, 1], eq. (4).

use crate::quadrature::{Quadrature, gauss_lobatto_points};
use crate::scene::NodeSpacing;

/// Node positions of one element of degree p.
pub fn element_nodes(degree: usize, spacing: NodeSpacing) -> Vec<f64> {
    match spacing {
        NodeSpacing::Equal => (0..=degree).map(|i| i as f64 / degree as f64).collect(),
        NodeSpacing::GaussLobatto => gauss_lobatto_points(degree),
    }
}

/// Values and derivatives of the N = p + 1 basis functions at one point of the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis<const N: usize> {
    /// Where on the element, in [0, 1].
    pub x: f64,
    /// Quadrature weight; 1 where the point is not one of a rule.
    pub weight: f64,
    /// N_i(x).
    pub value: [f64; N],
    /// dN_i/dx.
    pub derivative: [f64; N],
}

/// N_i = Π_{j≠i} (x − x_j)/(x_i − x_j), and its derivative as the sum of products
/// Σ_{k≠i} 1/(x_i − x_k) Π_{j≠i,k} (x − x_j)/(x_i − x_j), which is finite at the nodes, too.
pub fn basis<const N: usize>(nodes: &[f64; N], x: f64, weight: f64) -> Basis<N> {
    let mut result = Basis { x, weight, value: [1.0; N], derivative: [0.0; N] };
    for i in 0..N {
        for k in (0..N).filter(|&k| k != i) {
            result.value[i] *= (x - nodes[k]) / (nodes[i] - nodes[k]);
            let product: f64 = (0..N)
                .filter(|&j| j != i && j != k)
                .map(|j| (x - nodes[j]) / (nodes[i] - nodes[j]))
                .product();
            result.derivative[i] += product / (nodes[i] - nodes[k]);
        }
    }
    result
}

/// The basis at every point of a rule.
pub fn basis_at_rule<const N: usize>(nodes: &[f64; N], rule: &Quadrature) -> Vec<Basis<N>> {
    rule.points.iter().zip(&rule.weights).map(|(&x, &weight)| basis(nodes, x, weight)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const N: usize>() {
        for spacing in [NodeSpacing::Equal, NodeSpacing::GaussLobatto] {
            let nodes: [f64; N] = element_nodes(N - 1, spacing).try_into().expect("N nodes");
            for x in [0.0, 0.1, 0.37, 0.5, 1.0] {
                let b = basis(&nodes, x, 1.0);
                // Interpolates every polynomial of degree N − 1 exactly, with its derivative.
                for degree in 0..N as i32 {
                    let value: f64 = (0..N).map(|i| b.value[i] * nodes[i].powi(degree)).sum();
                    let slope: f64 = (0..N).map(|i| b.derivative[i] * nodes[i].powi(degree)).sum();
                    let exact = if degree == 0 { 0.0 } else { degree as f64 * x.powi(degree - 1) };
                    assert!((value - x.powi(degree)).abs() < 1e-13);
                    assert!((slope - exact).abs() < 1e-12, "N = {N}, x = {x}, degree {degree}");
                }
            }
        }
    }

    #[test]
    fn reproduces_polynomials() {
        check::<2>();
        check::<3>();
        check::<5>();
        check::<9>();
    }
}
