//! Elimination of 6×6 blocks of four matrices side by side, without interchanges.
//!
//! With the factors of a pivot block K_kk = L_k U_k of the remaining matrix,
//!
//! ```text
//! W_ik = K_ik U_k⁻¹      V_kj = L_k⁻¹ K_kj      K_ij ← K_ij − W_ik V_kj
//! ```
//!
//! for all nodes i, j that are left. Nothing is interchanged, so rounding errors grow with the multipliers; where these
//! are large, the matrices are eliminated otherwise.

use super::NODE;
use crate::element::Block;
use crate::lanes::{LANES, Processor, Wide};

/// Six entries of a node in every lane.
pub type Entries = [Wide; NODE];

/// Multipliers up to here, forces and moments made comparable by a length, cost at most four digits of a step of
/// Newton's iteration, which mends them. With held ends an element is stiff, and they are of the order of ten, but for
/// iterates far from equilibrium that all but buckle within an element.
const MOST_GROWTH: f64 = 1e4;

/// The entries of one node of each of four elements.
#[inline(always)]
pub fn gather(b: &[[f64; NODE]], nodes: [usize; LANES]) -> Entries {
    let of: [&[f64; NODE]; LANES] = nodes.map(|node| &b[node]);
    std::array::from_fn(|k| Wide::gather(|lane| of[lane][k]))
}

/// Sums of squares of the multipliers by the kinds of their row and of the pivot's, translation or rotation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Growth {
    same: Wide,
    moment_by_force: Wide,
    force_by_moment: Wide,
}

impl Growth {
    #[inline(always)]
    fn add(&mut self, processor: impl Processor, row: usize, pivot: usize, multiplier: Wide) {
        let sum = match (row < 3, pivot < 3) {
            (true, true) | (false, false) => &mut self.same,
            (false, true) => &mut self.moment_by_force,
            (true, false) => &mut self.force_by_moment,
        };
        *sum = processor.multiply_add(multiplier, multiplier, *sum);
    }

    /// False if a multiplier of the first `lanes` lanes is large or no number; `length` makes force and moment rows
    /// comparable [m].
    #[inline(always)]
    pub fn is_small(&self, length: f64, lanes: usize) -> bool {
        let square = length * length;
        (0..lanes).all(|lane| {
            let sum = self.same.0[lane]
                + self.moment_by_force.0[lane] / square
                + self.force_by_moment.0[lane] * square;
            sum <= MOST_GROWTH * MOST_GROWTH
        })
    }
}

/// D = L U in place, with the reciprocals of the diagonal of U.
#[inline(always)]
pub fn factorize(processor: impl Processor, d: &mut Block, growth: &mut Growth) {
    for k in 0..NODE {
        let inverse = processor.divide(Wide::splat(1.0), d[k][k]);
        d[k][k] = inverse;
        for row in k + 1..NODE {
            d[k][row] = processor.multiply(d[k][row], inverse);
            growth.add(processor, row, k, d[k][row]);
        }
        for column in k + 1..NODE {
            let entry = d[column][k];
            for row in k + 1..NODE {
                d[column][row] = processor.subtract_product(entry, d[k][row], d[column][row]);
            }
        }
    }
}

/// A ← A U⁻¹.
#[inline(always)]
pub fn divide_by_upper(processor: impl Processor, a: &mut Block, d: &Block, growth: &mut Growth) {
    for column in 0..NODE {
        let mut x = a[column];
        for k in 0..column {
            let entry = d[column][k];
            for row in 0..NODE {
                x[row] = processor.subtract_product(entry, a[k][row], x[row]);
            }
        }
        for row in 0..NODE {
            x[row] = processor.multiply(x[row], d[column][column]);
            growth.add(processor, row, column, x[row]);
        }
        a[column] = x;
    }
}

/// A ← L⁻¹ A.
#[inline(always)]
pub fn divide_by_lower(processor: impl Processor, a: &mut Block, d: &Block) {
    for column in a {
        solve_lower(processor, d, column);
    }
}

/// C ← C − A B.
#[inline(always)]
pub fn subtract_product(processor: impl Processor, c: &mut Block, a: &Block, b: &Block) {
    for (sum, column) in c.iter_mut().zip(b) {
        subtract_times(processor, sum, a, column);
    }
}

/// C ← S − A B, or without a start −A B.
#[inline(always)]
pub fn write_difference(
    processor: impl Processor,
    c: &mut Block,
    start: Option<&Block>,
    a: &Block,
    b: &Block,
) {
    for (index, (result, column)) in c.iter_mut().zip(b).enumerate() {
        let mut sum = start.map_or([Wide::splat(0.0); NODE], |start| start[index]);
        subtract_times(processor, &mut sum, a, column);
        *result = sum;
    }
}

/// y ← y − A x.
#[inline(always)]
pub fn subtract_times(processor: impl Processor, y: &mut Entries, a: &Block, x: &Entries) {
    let mut sum = *y;
    for k in 0..NODE {
        let entry = x[k];
        for row in 0..NODE {
            sum[row] = processor.subtract_product(entry, a[k][row], sum[row]);
        }
    }
    *y = sum;
}

/// y ← L⁻¹ y.
#[inline(always)]
pub fn solve_lower(processor: impl Processor, d: &Block, y: &mut Entries) {
    for k in 0..NODE - 1 {
        let entry = y[k];
        for row in k + 1..NODE {
            y[row] = processor.subtract_product(entry, d[k][row], y[row]);
        }
    }
}

/// y ← U⁻¹ y.
#[inline(always)]
pub fn solve_upper(processor: impl Processor, d: &Block, y: &mut Entries) {
    for k in (0..NODE).rev() {
        y[k] = processor.multiply(y[k], d[k][k]);
        let entry = y[k];
        for row in 0..k {
            y[row] = processor.subtract_product(entry, d[k][row], y[row]);
        }
    }
}

/// Eliminates a node between others: leaves the factors of its block d, and of the blocks of its row and column
/// with every other node V_kj and W_jk.
#[inline(always)]
pub fn divide(processor: impl Processor, d: &mut Block, pairs: &mut [[Block; 2]], growth: &mut Growth) {
    factorize(processor, d, growth);
    for [v, w] in pairs {
        divide_by_lower(processor, v, d);
        divide_by_upper(processor, w, d, growth);
    }
}
