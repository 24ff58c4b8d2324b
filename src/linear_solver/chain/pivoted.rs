//! Elimination of one front with row pivoting, for fronts that need it: plain loops over a row-major matrix.

use nalgebra::Matrix6;

use crate::linear_solver::{NODE, Singular, dot};

/// The factors of one front.
#[derive(Clone, Debug, Default)]
pub struct Pivoted {
    matrix: Vec<f64>,
    pivots: Vec<u8>,
    /// Rows and columns.
    width: usize,
    backwards: bool,
}

impl Pivoted {
    /// Eliminates the first `count` of `width` block rows, `backwards` the last, blocks row by row, with pivots among
    /// their rows: leaves the multipliers below the diagonal, U on and above it, and the Schur complement.
    pub fn factorize(
        &mut self,
        blocks: &[Matrix6<f64>],
        width: usize,
        count: usize,
        backwards: bool,
    ) -> Result<(), Singular> {
        self.backwards = backwards;
        self.width = NODE * width;
        self.matrix.clear();
        self.matrix.resize(self.width * self.width, 0.0);
        self.pivots.clear();
        for (index, block) in blocks.iter().enumerate() {
            let [i, j] = [index / width, index % width].map(|place| self.place(place));
            let first = i * NODE * self.width + j * NODE;
            for row in 0..NODE {
                for column in 0..NODE {
                    self.matrix[first + row * self.width + column] = block[(row, column)];
                }
            }
        }
        let (a, width, count) = (&mut self.matrix, self.width, NODE * count);
        for k in 0..count {
            let mut pivot = k;
            for i in k + 1..count {
                if a[i * width + k].abs() > a[pivot * width + k].abs() {
                    pivot = i;
                }
            }
            self.pivots.push(pivot as u8);
            if pivot != k {
                let (head, tail) = a.split_at_mut(pivot * width);
                head[k * width..][..width].swap_with_slice(&mut tail[..width]);
            }
            let (head, tail) = a.split_at_mut((k + 1) * width);
            let row = &head[k * width..];
            let inverse = 1.0 / row[k];
            if !(inverse.is_finite() && inverse != 0.0) {
                return Err(Singular);
            }
            for other in tail.chunks_exact_mut(width) {
                let factor = other[k] * inverse;
                other[k] = factor;
                for j in k + 1..width {
                    other[j] -= factor * row[j];
                }
            }
        }
        Ok(())
    }

    /// From the order of the front to that of elimination.
    fn place(&self, place: usize) -> usize {
        if self.backwards { self.width / NODE - 1 - place } else { place }
    }

    /// Block (i, j) of what the elimination leaves over.
    pub fn block(&self, i: usize, j: usize) -> Matrix6<f64> {
        let [i, j] = [i, j].map(|place| self.place(place));
        Matrix6::from_fn(|row, column| self.matrix[(NODE * i + row) * self.width + NODE * j + column])
    }

    /// b ← L⁻¹ b for the eliminated unknowns, and what is left of b for the others.
    pub fn forward(&self, b: &mut [f64]) {
        for (k, &pivot) in self.pivots.iter().enumerate() {
            b.swap(k, usize::from(pivot));
        }
        for (i, row) in self.matrix.chunks_exact(self.width).enumerate() {
            let known = self.pivots.len().min(i);
            b[i] -= dot(&row[..known], &b[..known]);
        }
    }

    /// b ← U⁻¹ b for the eliminated unknowns, from the last, the others being known.
    pub fn backward(&self, b: &mut [f64]) {
        for (i, row) in self.matrix.chunks_exact(self.width).enumerate().take(self.pivots.len()).rev() {
            b[i] = (b[i] - dot(&row[i + 1..], &b[i + 1..])) / row[i];
        }
    }
}
