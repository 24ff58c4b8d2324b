//! The factorised tangent of one rod: what is inside the elements is eliminated first, then their ends along the rod.

use nalgebra::Matrix6;

use super::chain::kept_nodes;
use super::interiors::Interiors;
use super::layout::Layout;
use super::segments::Segments;
use super::{Chain, NODE, Singular};
use crate::element::{ElementTangent, Tangents, tangent_of_lane, write_lane_of_block, zero_tangent};
use crate::lanes::{LANES, Plain, Processor, widest};

/// The condensed matrix of the element of a lane.
#[inline(always)]
fn write_ends<const N: usize>(blocks: &Tangents<N>, lane: usize, result: &mut ElementTangent<2>) {
    for (row, i) in result.iter_mut().zip([0, N - 1]) {
        for (block, j) in row.iter_mut().zip([0, N - 1]) {
            write_lane_of_block(&blocks[i][j], lane, block);
        }
    }
}

/// How the ends of the elements are eliminated.
#[derive(Clone, Debug)]
enum Ends {
    /// Along four segments side by side.
    Segments(Box<Segments>),
    /// One after the other, for long rods and those that keep nodes between their ends.
    Chain(Box<Chain>),
}

/// The tangent of one rod.
///
/// The nodes inside four elements at a time are eliminated side by side, and then the elements' ends. Where a node
/// inside an element is kept, or where elimination needs pivoting, a chain has all nodes.
#[derive(Clone, Debug)]
pub struct Condensed {
    elements: usize,
    degree: usize,
    length: f64,
    kept: Vec<usize>,
    /// What is inside the elements and their ends; absent where a node inside is kept.
    parts: Option<(Interiors, Ends)>,
    /// The chain of all nodes, made when it is first needed.
    all: Option<Box<Chain>>,
    /// Whether the factors are those of `all`.
    in_full: bool,
}

impl Condensed {
    /// For a rod of `elements` elements of degree `degree`, 1 to 8, and of `length` [m] each, that keeps some of its
    /// nodes: see [`Chain::new`].
    pub fn new(elements: usize, degree: usize, kept: &[usize], length: f64) -> Self {
        let last = elements * degree;
        let kept = kept_nodes(degree, kept);
        let (parts, all) = if kept.iter().any(|node| node % degree != 0) {
            (None, Some(Box::new(Chain::new(elements, degree, &kept, length))))
        } else {
            let only_ends = kept.iter().all(|&node| node == 0 || node == last);
            let (layout, ends) = match Layout::segments(elements) {
                Some(layout) if only_ends => {
                    (layout, Ends::Segments(Box::new(Segments::new(layout, degree, &kept, length))))
                }
                _ => {
                    let of_ends: Vec<usize> = kept.iter().map(|node| node / degree).collect();
                    let chain = Chain::new(elements, 1, &of_ends, length);
                    let layout = Layout::InOrder { elements, backwards: chain.is_backwards() };
                    (layout, Ends::Chain(Box::new(chain.with_nodes_at(|node| node * degree))))
                }
            };
            (Some((Interiors::new(layout, degree, length), ends)), None)
        };
        let in_full = parts.is_none();
        Self { elements, degree, length, kept, parts, all, in_full }
    }

    /// The kept nodes, ascending.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// What is eliminated last.
    fn chain(&self) -> Option<&Chain> {
        match &self.parts {
            Some((_, Ends::Segments(segments))) if !self.in_full => Some(segments.chain()),
            Some((_, Ends::Chain(chain))) if !self.in_full => Some(chain),
            _ => self.all.as_deref(),
        }
    }

    /// What is left over the kept nodes after the factorisation: blocks by rows and columns, to be summed.
    pub fn remainder(&self) -> &[(usize, usize, Matrix6<f64>)] {
        self.chain().map_or(&[], Chain::remainder)
    }

    fn layout(&self) -> Layout {
        match (&self.parts, &self.all) {
            (Some((interiors, _)), _) if !self.in_full => interiors.layout(),
            (_, Some(all)) => Layout::InOrder { elements: self.elements, backwards: all.is_backwards() },
            _ => Layout::InOrder { elements: self.elements, backwards: false },
        }
    }

    /// The elements of a group of four; lanes without an element of their own repeat another.
    #[inline(always)]
    pub fn group(&self, group: usize) -> [usize; LANES] {
        self.layout().elements(group)
    }

    /// Begins a factorisation.
    pub fn begin(&mut self) {
        self.in_full = self.parts.is_none();
    }

    /// Takes the matrices of the elements of a group, in order from group 0; spoils them. False if all groups are to be
    /// given again, because one needs pivoting.
    #[inline(always)]
    pub fn add<const N: usize>(
        &mut self,
        processor: impl Processor,
        group: usize,
        blocks: &mut Tangents<N>,
    ) -> Result<bool, Singular> {
        let (Some((interiors, ends)), false) = (&mut self.parts, self.in_full) else {
            self.add_in_full(group, blocks)?;
            return Ok(true);
        };
        let mut regular = interiors.eliminate(processor, group, blocks);
        match ends {
            _ if !regular => {}
            Ends::Segments(segments) => {
                let row = |i: usize| [&blocks[i][0], &blocks[i][N - 1]];
                regular = segments.add(processor, group, [row(0), row(N - 1)]);
            }
            Ends::Chain(chain) => {
                for lane in 0..interiors.layout().lanes(group) {
                    add_ends(processor, chain, group * LANES + lane, blocks, lane)?;
                }
            }
        }
        if !regular {
            self.in_full = true;
            self.all.get_or_insert_with(|| {
                Box::new(Chain::new(self.elements, self.degree, &self.kept, self.length))
            });
        }
        Ok(regular)
    }

    #[cold]
    fn add_in_full<const N: usize>(&mut self, group: usize, blocks: &Tangents<N>) -> Result<(), Singular> {
        let lanes = self.layout().lanes(group);
        let Some(chain) = &mut self.all else { return Err(Singular) };
        for lane in 0..lanes {
            chain.add_element(Plain, group * LANES + lane, &tangent_of_lane(blocks, lane))?;
        }
        Ok(())
    }

    /// Eliminates what is left, after all groups.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        match (&mut self.parts, &mut self.all) {
            (Some((_, Ends::Segments(segments))), _) if !self.in_full => segments.factorize(),
            (Some((_, Ends::Chain(chain))), _) if !self.in_full => chain.factorize(),
            (_, Some(chain)) => chain.factorize(),
            _ => Err(Singular),
        }
    }

    /// The first half of the solution: eliminates the rod's own unknowns from b (six entries a node, in order along the
    /// rod) and leaves in the entries of the kept nodes the right side of their system.
    pub fn forward(&self, b: &mut [f64]) {
        if let (Some((interiors, ends)), false) = (&self.parts, self.in_full) {
            let b = b.as_chunks_mut::<NODE>().0;
            widest!(processor => interiors.forward(processor, b));
            if let Ends::Segments(segments) = ends {
                widest!(processor => segments.forward(processor, b));
            }
        }
        if let Some(chain) = self.chain() {
            chain.forward(b);
        }
    }

    /// The second half: with the kept nodes' entries solved, the others.
    pub fn backward(&self, b: &mut [f64]) {
        if let Some(chain) = self.chain() {
            chain.backward(b);
        }
        if let (Some((interiors, ends)), false) = (&self.parts, self.in_full) {
            let b = b.as_chunks_mut::<NODE>().0;
            if let Ends::Segments(segments) = ends {
                widest!(processor => segments.backward(processor, b));
            }
            widest!(processor => interiors.backward(processor, b));
        }
    }
}

/// Adds the condensed matrix of the element of a lane to the chain of the ends.
#[inline(always)]
fn add_ends<const N: usize>(
    processor: impl Processor,
    chain: &mut Chain,
    step: usize,
    blocks: &Tangents<N>,
    lane: usize,
) -> Result<(), Singular> {
    if let Some(place) = chain.place::<2>(step) {
        write_ends(blocks, lane, place);
        if chain.eliminate_written(processor, step) {
            return Ok(());
        }
    }
    let mut condensed = zero_tangent();
    write_ends(blocks, lane, &mut condensed);
    chain.add_element(processor, step, &condensed)
}
