//! Elimination of the nodes inside the elements, four elements at a time.
//!
//! The interior nodes go in their order; what is left over the two ends is the element's condensed matrix.

use super::NODE;
use super::layout::Layout;
use super::wide::{
    Entries, Growth, divide, gather, solve_lower, solve_upper, subtract_product, subtract_times,
};
use crate::element::{Block, Tangents};
use crate::lanes::{Processor, Wide};

/// The factors of what is inside the elements of one rod.
#[derive(Clone, Debug)]
pub struct Interiors {
    /// Nodes inside an element.
    inside: usize,
    layout: Layout,
    /// Makes force and moment rows comparable [m].
    length: f64,
    /// By groups of four elements: for every k the pivot block, V_kj and W_jk of the inside nodes that come later, then
    /// of the two ends.
    blocks: Vec<Block>,
}

impl Interiors {
    /// For elements of degree `degree` and length `length` [m].
    pub fn new(layout: Layout, degree: usize, length: f64) -> Self {
        let inside = degree - 1;
        let size = layout.groups() * inside * (inside + 4);
        Self { inside, layout, length, blocks: vec![[[Wide::default(); NODE]; NODE]; size] }
    }

    /// Which elements stand side by side.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Eliminates what is inside the elements of a group in place; false if multipliers are large or no numbers.
    #[inline(always)]
    pub fn eliminate<const N: usize>(
        &mut self,
        processor: impl Processor,
        group: usize,
        k: &mut Tangents<N>,
    ) -> bool {
        let size = self.inside * (self.inside + 4);
        let mut factors = &mut self.blocks[group * size..][..size];
        let mut growth = Growth::default();
        for pivot in 1..N - 1 {
            let left = N - pivot;
            let (own, rest) = factors.split_at_mut(1 + 2 * left);
            factors = rest;
            let Some((d, pairs)) = own.split_first_mut() else { return false };
            *d = k[pivot][pivot];
            let pairs = pairs.as_chunks_mut::<2>().0;
            for (index, [v, w]) in pairs.iter_mut().enumerate() {
                let node = node_left::<N>(pivot, index);
                *v = k[pivot][node];
                *w = k[node][pivot];
            }
            divide(processor, d, pairs, &mut growth);
            for (row, [_, w]) in pairs.iter().enumerate() {
                let row = &mut k[node_left::<N>(pivot, row)];
                for (column, [v, _]) in pairs.iter().enumerate() {
                    subtract_product(processor, &mut row[node_left::<N>(pivot, column)], w, v);
                }
            }
        }
        growth.is_small(self.length, self.layout.lanes(group))
    }

    /// Eliminates the interior unknowns from b, six entries a node along the rod.
    #[inline(always)]
    pub fn forward(&self, processor: impl Processor, b: &mut [[f64; NODE]]) {
        let size = self.inside * (self.inside + 4);
        for (group, blocks) in self.blocks.chunks_exact(size.max(1)).enumerate() {
            let starts = self.layout.elements(group).map(|e| e * (self.inside + 1));
            let mut x: [Entries; MOST] = [[Wide::default(); NODE]; MOST];
            for (i, x) in x.iter_mut().enumerate().take(self.inside) {
                *x = gather(b, starts.map(|start| start + 1 + i));
            }
            // What is taken from the two ends.
            let mut ends = [[Wide::default(); NODE]; 2];
            let mut blocks = blocks.iter();
            let mut next = || blocks.next().unwrap_or(&NO_BLOCK);
            for k in 0..self.inside {
                let d = next();
                let y = &mut x[k];
                solve_lower(processor, d, y);
                let y = *y;
                for x in x[k + 1..self.inside].iter_mut().chain(&mut ends) {
                    let (_v, w) = (next(), next());
                    subtract_times(processor, x, w, &y);
                }
            }
            for lane in 0..self.layout.lanes(group) {
                for (i, x) in x.iter().enumerate().take(self.inside) {
                    b[starts[lane] + 1 + i] = x.map(|x| x.0[lane]);
                }
                for (end, node) in ends.iter().zip([starts[lane], starts[lane] + self.inside + 1]) {
                    for (b, x) in b[node].iter_mut().zip(end) {
                        *b += x.0[lane];
                    }
                }
            }
        }
    }

    /// With the entries of the ends solved, the interior ones.
    #[inline(always)]
    pub fn backward(&self, processor: impl Processor, b: &mut [[f64; NODE]]) {
        let size = self.inside * (self.inside + 4);
        for (group, blocks) in self.blocks.chunks_exact(size.max(1)).enumerate() {
            let starts = self.layout.elements(group).map(|e| e * (self.inside + 1));
            let mut x: [Entries; MOST] = [[Wide::default(); NODE]; MOST];
            for (i, x) in x.iter_mut().enumerate().take(self.inside) {
                *x = gather(b, starts.map(|start| start + 1 + i));
            }
            let ends = [0, self.inside + 1].map(|i| gather(b, starts.map(|start| start + i)));
            let mut blocks = blocks.iter().rev();
            let mut next = || blocks.next().unwrap_or(&NO_BLOCK);
            for k in (0..self.inside).rev() {
                let mut y = x[k];
                for x in x[k + 1..self.inside].iter().chain(&ends).rev() {
                    let (_w, v) = (next(), next());
                    subtract_times(processor, &mut y, v, x);
                }
                solve_upper(processor, next(), &mut y);
                x[k] = y;
            }
            for lane in 0..self.layout.lanes(group) {
                for (i, x) in x.iter().enumerate().take(self.inside) {
                    b[starts[lane] + 1 + i] = x.map(|x| x.0[lane]);
                }
            }
        }
    }
}

/// Of the nodes that are left after a pivot, those inside that come later and then the two ends, the one of an index.
#[inline(always)]
fn node_left<const N: usize>(pivot: usize, index: usize) -> usize {
    match pivot + 1 + index {
        node if node < N - 1 => node,
        node if node == N - 1 => 0,
        _ => N - 1,
    }
}

/// Most nodes inside an element, those of degree 8.
const MOST: usize = 7;
const NO_BLOCK: Block = [[Wide::splat(0.0); NODE]; NODE];
