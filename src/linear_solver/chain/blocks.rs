//! Elimination of 6×6 blocks without interchanges, and what tells that it went well.
//!
//! Blocks hold columns, so that every inner loop adds a multiple of one column to another. With the factors of the
//! pivot blocks A_kk = L_k U_k of the remaining matrix,
//!
//! ```text
//! W_ik = A_ik U_k⁻¹      V_kj = L_k⁻¹ A_kj      A_ij ← A_ij − W_ik V_kj      i, j > k
//! ```
//!
//! by substitution: explicit inverses of the pivot blocks would cost as many digits as their bending is softer than
//! their stretching. Nothing is interchanged, so rounding errors grow with the multipliers; a front whose multipliers
//! are large is eliminated again with pivoting.

use nalgebra::Matrix6;

use crate::lanes::Processor;
use crate::linear_solver::NODE;

/// A 6×6 matrix, column by column.
type Block = [[f64; NODE]; NODE];

/// Sums of squares of the multipliers by the kind of the pivot's row, translation or rotation.
#[derive(Clone, Copy, Debug, Default)]
struct Growth {
    by_force: [f64; NODE],
    by_moment: [f64; NODE],
}

/// Multipliers up to here, forces and moments made comparable by a length, cost at most three digits of a step of
/// Newton's iteration, which mends them; ordinary rods stay below a hundred.
const MOST_GROWTH: f64 = 1e3;

impl Growth {
    #[inline(always)]
    fn add(&mut self, processor: impl Processor, pivot: usize, multipliers: &[f64; NODE]) {
        let sum = if pivot < 3 { &mut self.by_force } else { &mut self.by_moment };
        processor.add_products6(sum, multipliers, multipliers);
    }

    /// False if a multiplier is large or no number.
    #[inline(always)]
    fn is_small(&self, length: f64) -> bool {
        let square = length * length;
        let three = |x: &[f64]| x[0] + x[1] + x[2];
        let (force, moment) = (&self.by_force, &self.by_moment);
        three(&force[..3]) + three(&force[3..]) / square + three(&moment[..3]) * square + three(&moment[3..])
            <= MOST_GROWTH * MOST_GROWTH
    }
}

/// a x.
#[inline(always)]
fn scale(a: f64, x: &[f64; NODE]) -> [f64; NODE] {
    x.map(|x| a * x)
}

/// a b by components.
#[inline(always)]
fn product(a: &[f64; NODE], b: &[f64; NODE]) -> [f64; NODE] {
    std::array::from_fn(|k| a[k] * b[k])
}

/// D = L U in place, with the reciprocals of the diagonal of U.
#[inline(always)]
fn factorize(processor: impl Processor, d: &mut Block, growth: &mut Growth) {
    factorize_column::<0>(processor, d, growth);
    factorize_column::<1>(processor, d, growth);
    factorize_column::<2>(processor, d, growth);
    factorize_column::<3>(processor, d, growth);
    factorize_column::<4>(processor, d, growth);
    factorize_column::<5>(processor, d, growth);
}

#[inline(always)]
fn factorize_column<const K: usize>(processor: impl Processor, d: &mut Block, growth: &mut Growth) {
    let inverse = 1.0 / d[K][K];
    // Zero down to the diagonal, so that whole columns can be added.
    let multipliers = product(&scale(inverse, &d[K]), &BELOW[K]);
    for column in K + 1..NODE {
        let entry = d[column][K];
        processor.add_scaled6(&mut d[column], -entry, &multipliers);
    }
    d[K][K + 1..].copy_from_slice(&multipliers[K + 1..]);
    d[K][K] = inverse;
    growth.add(processor, K, &multipliers);
}

/// Keeps what is below the diagonal.
const BELOW: [[f64; NODE]; NODE] = {
    let mut below = [[0.0; NODE]; NODE];
    let mut k = 0;
    while k < NODE {
        let mut i = k + 1;
        while i < NODE {
            below[k][i] = 1.0;
            i += 1;
        }
        k += 1;
    }
    below
};

/// Keeps what is above the diagonal.
const ABOVE: [[f64; NODE]; NODE] = {
    let mut above = [[0.0; NODE]; NODE];
    let mut k = 0;
    while k < NODE {
        let mut i = 0;
        while i < k {
            above[k][i] = 1.0;
            i += 1;
        }
        k += 1;
    }
    above
};

/// A ← A U⁻¹.
#[inline(always)]
fn divide_by_upper(processor: impl Processor, a: &mut Block, d: &Block) {
    for column in 0..NODE {
        let mut x = a[column];
        for k in 0..column {
            processor.add_scaled6(&mut x, -d[column][k], &a[k]);
        }
        a[column] = scale(d[column][column], &x);
    }
}

/// A ← L⁻¹ A.
#[inline(always)]
fn divide_by_lower(processor: impl Processor, a: &mut Block, d: &Block) {
    let mut lower = *d;
    for k in 0..NODE {
        lower[k] = product(&lower[k], &BELOW[k]);
    }
    for column in a {
        for k in 0..NODE - 1 {
            let x = column[k];
            processor.add_scaled6(column, -x, &lower[k]);
        }
    }
}

/// C ← C − A B.
#[inline(always)]
fn subtract_product(processor: impl Processor, c: &mut Block, a: &Block, b: &Block) {
    for (sum, column) in c.iter_mut().zip(b) {
        let mut x = *sum;
        for k in 0..NODE {
            processor.add_scaled6(&mut x, -column[k], &a[k]);
        }
        *sum = x;
    }
}

/// y ← y − A x.
#[inline(always)]
pub fn subtract_times(processor: impl Processor, y: &mut [f64; NODE], a: &Matrix6<f64>, x: &[f64; NODE]) {
    for k in 0..NODE {
        processor.add_scaled6(y, -x[k], &a.data.0[k]);
    }
}

/// y ← L⁻¹ y.
#[inline(always)]
pub fn solve_lower(processor: impl Processor, d: &Matrix6<f64>, y: &mut [f64; NODE]) {
    for k in 0..NODE - 1 {
        let x = y[k];
        processor.add_scaled6(y, -x, &product(&d.data.0[k], &BELOW[k]));
    }
}

/// y ← U⁻¹ y.
#[inline(always)]
pub fn solve_upper(processor: impl Processor, d: &Matrix6<f64>, y: &mut [f64; NODE]) {
    for k in (0..NODE).rev() {
        let x = y[k] * d.data.0[k][k];
        processor.add_scaled6(y, -x, &product(&d.data.0[k], &ABOVE[k]));
        y[k] = x;
    }
}

/// Eliminates the first `count` of `width` block rows and columns, `backwards` the last, blocks row by row; false if
/// the multipliers, made comparable by `length`, are too large, and then the blocks are of no use.
#[inline(always)]
pub fn eliminate(
    processor: impl Processor,
    a: &mut [Matrix6<f64>],
    (width, count, backwards): (usize, usize, bool),
    length: f64,
) -> bool {
    let mut growth = Growth::default();
    for k in 0..count {
        let (p, left) = if backwards { (width - 1 - k, 0..width - 1 - k) } else { (k, k + 1..width) };
        let (before, from) = a.split_at_mut(p * width);
        let (pivot_row, after) = from.split_at_mut(width);
        let rows = if backwards { before } else { after };
        let mut pivot = pivot_row[p].data.0;
        factorize(processor, &mut pivot, &mut growth);
        pivot_row[p].data.0 = pivot;
        for block in &mut pivot_row[left.clone()] {
            divide_by_lower(processor, &mut block.data.0, &pivot);
        }
        for row in rows.chunks_exact_mut(width) {
            let mut w = row[p].data.0;
            divide_by_upper(processor, &mut w, &pivot);
            for (column, multipliers) in w.iter().enumerate() {
                growth.add(processor, column, multipliers);
            }
            row[p].data.0 = w;
            for (sum, block) in row[left.clone()].iter_mut().zip(&pivot_row[left.clone()]) {
                subtract_product(processor, &mut sum.data.0, &w, &block.data.0);
            }
        }
    }
    growth.is_small(length)
}
