//! Small dense systems: LU with row scaling and partial pivoting, in place.

use super::{Singular, dot};

/// A dense n × n system.
#[derive(Clone, Debug)]
pub struct Dense {
    size: usize,
    /// Row-major; after the factorisation L below the diagonal and U on and above it.
    matrix: Vec<f64>,
    /// The power of two that brings the largest entry of every row near 1, so that rows in different units
    /// (forces, gaps of joints) compete fairly for the pivot.
    scale: Vec<f64>,
    pivots: Vec<usize>,
}

impl Dense {
    /// An n × n system of zeros.
    pub fn new(size: usize) -> Self {
        Self { size, matrix: vec![0.0; size * size], scale: vec![0.0; size], pivots: vec![0; size] }
    }

    /// All zero again.
    pub fn clear(&mut self) {
        self.matrix.fill(0.0);
    }

    /// Adds to an entry.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.matrix[row * self.size + column] += value;
    }

    /// Factorises what was added.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        let n = self.size;
        for (row, scale) in self.matrix.chunks_exact_mut(n.max(1)).zip(&mut self.scale) {
            let largest = row.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            *scale = (-largest.log2().round()).exp2();
            if !(scale.is_finite() && *scale > 0.0 && row.iter().all(|x| x.is_finite())) {
                return Err(Singular);
            }
            row.iter_mut().for_each(|x| *x *= *scale);
        }
        for k in 0..n {
            let mut pivot = k;
            for i in k + 1..n {
                if self.matrix[i * n + k].abs() > self.matrix[pivot * n + k].abs() {
                    pivot = i;
                }
            }
            self.pivots[k] = pivot;
            if pivot != k {
                let (head, tail) = self.matrix.split_at_mut(pivot * n);
                head[k * n..][..n].swap_with_slice(&mut tail[..n]);
            }
            let (head, tail) = self.matrix.split_at_mut((k + 1) * n);
            let row = &head[k * n..][..n];
            let inverse = 1.0 / row[k];
            if !(inverse.is_finite() && inverse != 0.0) {
                return Err(Singular);
            }
            for other in tail.chunks_exact_mut(n) {
                let factor = other[k] * inverse;
                if factor != 0.0 {
                    other[k] = factor;
                    for j in k + 1..n {
                        other[j] -= factor * row[j];
                    }
                }
            }
        }
        Ok(())
    }

    /// b ← A⁻¹ b.
    pub fn solve(&self, b: &mut [f64]) {
        let n = self.size;
        for (x, scale) in b.iter_mut().zip(&self.scale) {
            *x *= scale;
        }
        for (k, &pivot) in self.pivots.iter().enumerate() {
            b.swap(k, pivot);
        }
        for i in 0..n {
            b[i] -= dot(&self.matrix[i * n..][..i], &b[..i]);
        }
        for i in (0..n).rev() {
            let row = &self.matrix[i * n..][..n];
            b[i] = (b[i] - dot(&row[i + 1..], &b[i + 1..])) / row[i];
        }
    }
}
