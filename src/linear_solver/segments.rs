//! Elimination along four segments of a rod side by side.
//!
//! A segment keeps its first node s. After every element but the first, the node c before it is eliminated from the
//! matrix of s, c and the element's last node e,
//!
//! ```text
//! ⎛ K_ss  K_sc            ⎞
//! ⎜ K_cs  K_cc + K₀₀  K₀₁ ⎟
//! ⎝       K₁₀         K₁₁ ⎠
//! ```
//!
//! with K_s., K_.c of the elements before and K₀₀ … K₁₁ of the element itself. What is left over s and the last node is
//! the segment's condensed matrix, an element of a chain of at most four.

use super::layout::Layout;
use super::wide::{
    Entries, Growth, divide, gather, solve_lower, solve_upper, subtract_product, subtract_times,
    write_difference,
};
use super::{Chain, NODE, Singular};
use crate::element::{Block, ElementTangent, write_lane_of_block, zero_tangent};
use crate::lanes::{LANES, Plain, Processor, Wide};

const NO_BLOCK: Block = [[Wide::splat(0.0); NODE]; NODE];

/// The factors of four segments.
#[derive(Clone, Debug)]
pub struct Segments {
    layout: Layout,
    degree: usize,
    /// Makes force and moment rows comparable [m].
    length: f64,
    /// K_ss, K_sc, K_cs, K_cc.
    carried: [[Block; 2]; 2],
    /// By groups but the first: the pivot block, V_cs and W_sc, V_ce and W_ec.
    factors: Vec<(Block, [[Block; 2]; 2])>,
    condensed: [ElementTangent<2>; LANES],
    chain: Chain,
}

impl Segments {
    /// For a rod that keeps none of its nodes but the ends; `kept` tells which.
    pub fn new(layout: Layout, degree: usize, kept: &[usize], length: f64) -> Self {
        let bounds = layout.bounds();
        let segments = bounds.len() - 1;
        let of_segments: Vec<usize> = kept.iter().map(|&node| if node == 0 { 0 } else { segments }).collect();
        let chain = Chain::new(segments, 1, &of_segments, length);
        Self {
            layout,
            degree,
            length,
            carried: [[NO_BLOCK; 2]; 2],
            factors: vec![(NO_BLOCK, [[NO_BLOCK; 2]; 2]); layout.groups() - 1],
            condensed: [zero_tangent(); LANES],
            chain: chain.with_nodes_at(|node| bounds[node] * degree),
        }
    }

    /// The chain of the segments.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// Takes the condensed matrices of the elements of a group; false if multipliers are large or no numbers.
    #[inline(always)]
    pub fn add(&mut self, processor: impl Processor, group: usize, ends: [[&Block; 2]; 2]) -> bool {
        let lanes = self.layout.lanes(group);
        let [[k_ss, k_sc], [k_cs, k_cc]] = &mut self.carried;
        if group == 0 {
            *k_ss = *ends[0][0];
            *k_sc = *ends[0][1];
            *k_cs = *ends[1][0];
            *k_cc = *ends[1][1];
        } else {
            let mut growth = Growth::default();
            let (d, pairs) = &mut self.factors[group - 1];
            for (column, (carried, own)) in d.iter_mut().zip(k_cc.iter().zip(ends[0][0])) {
                for (x, (carried, own)) in column.iter_mut().zip(carried.iter().zip(own)) {
                    *x = processor.add(*carried, *own);
                }
            }
            let [[v_s, w_s], [v_e, w_e]] = &mut *pairs;
            *v_s = *k_cs;
            *w_s = *k_sc;
            *v_e = *ends[0][1];
            *w_e = *ends[1][0];
            divide(processor, d, pairs, &mut growth);
            let [[v_s, w_s], [v_e, w_e]] = pairs;
            subtract_product(processor, k_ss, w_s, v_s);
            write_difference(processor, k_sc, None, w_s, v_e);
            write_difference(processor, k_cs, None, w_e, v_s);
            write_difference(processor, k_cc, Some(ends[1][1]), w_e, v_e);
            if !growth.is_small(self.length, lanes) {
                return false;
            }
        }
        let last = group + 1 == self.layout.groups();
        // All but the longest segments end one group earlier.
        let still = if last { 0 } else { self.layout.lanes(group + 1) };
        for lane in still..lanes {
            for (row, carried) in self.condensed[lane].iter_mut().zip(&self.carried) {
                for (block, carried) in row.iter_mut().zip(carried) {
                    write_lane_of_block(carried, lane, block);
                }
            }
        }
        true
    }

    /// Eliminates the chain of the segments, after all groups.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        for step in 0..self.layout.lanes(0) {
            let segment = self.chain.element(step);
            self.chain.add_element(Plain, step, &self.condensed[segment])?;
        }
        self.chain.factorize()
    }

    /// First and last node of the elements of a group.
    #[inline(always)]
    fn nodes(&self, group: usize) -> [[usize; LANES]; 2] {
        let starts = self.layout.elements(group).map(|e| e * self.degree);
        [starts, starts.map(|start| start + self.degree)]
    }

    /// Eliminates the unknowns inside the segments from b, six entries a node along the rod.
    #[inline(always)]
    pub fn forward(&self, processor: impl Processor, b: &mut [[f64; NODE]]) {
        // What is taken from the first nodes of the segments, and from the next node.
        let (mut first, mut next) = ([Wide::default(); NODE], [Wide::default(); NODE]);
        for (index, (d, [[_, w_s], [_, w_e]])) in self.factors.iter().enumerate() {
            let group = index + 1;
            let [starts, ends] = self.nodes(group);
            let mut y: Entries = gather(b, starts);
            for (y, taken) in y.iter_mut().zip(next) {
                *y = processor.add(*y, taken);
            }
            solve_lower(processor, d, &mut y);
            subtract_times(processor, &mut first, w_s, &y);
            next = [Wide::default(); NODE];
            subtract_times(processor, &mut next, w_e, &y);
            let lanes = self.layout.lanes(group);
            for lane in 0..lanes {
                b[starts[lane]] = y.map(|y| y.0[lane]);
            }
            let still = if index + 1 == self.factors.len() { 0 } else { self.layout.lanes(group + 1) };
            for lane in still..lanes {
                add_lane(&mut b[ends[lane]], &next, lane);
                add_lane(&mut b[self.nodes(0)[0][lane]], &first, lane);
            }
        }
    }

    /// With the entries of the segments' ends solved, the others.
    #[inline(always)]
    pub fn backward(&self, processor: impl Processor, b: &mut [[f64; NODE]]) {
        let first: Entries = gather(b, self.nodes(0)[0]);
        for (index, (d, [[v_s, _], [v_e, _]])) in self.factors.iter().enumerate().rev() {
            let group = index + 1;
            let [starts, ends] = self.nodes(group);
            let mut y: Entries = gather(b, starts);
            subtract_times(processor, &mut y, v_s, &first);
            subtract_times(processor, &mut y, v_e, &gather(b, ends));
            solve_upper(processor, d, &mut y);
            for lane in 0..self.layout.lanes(group) {
                b[starts[lane]] = y.map(|y| y.0[lane]);
            }
        }
    }
}

/// b += x of a lane.
#[inline(always)]
fn add_lane(b: &mut [f64; NODE], x: &Entries, lane: usize) {
    for (b, x) in b.iter_mut().zip(x) {
        *b += x.0[lane];
    }
}
