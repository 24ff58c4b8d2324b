//! Frontal elimination of one rod.

mod blocks;
mod pivoted;

use std::ops::Range;

use nalgebra::Matrix6;

use super::{NODE, Singular};
use crate::element::ElementTangent;
use crate::lanes::{Plain, Processor, widest};
use pivoted::Pivoted;

/// Most nodes of a front: those of an element of degree 8 and one that is carried along.
const MOST: usize = 10;

/// No pivoting.
const NONE: u32 = u32::MAX;

/// The matrix of one element and what comes with it, in the order of elimination.
#[derive(Clone, Debug, PartialEq)]
struct Front {
    /// Where its blocks start, row by row.
    blocks: usize,
    /// Place of its factors if it was eliminated with pivoting, or [`NONE`].
    pivoted: u32,
    /// Whether it is the element with what the one before left over its first node, in the element's own order.
    plain: bool,
    /// The nodes of the rod in the order of the front: first those that are eliminated here, then the others; the
    /// other way round in a chain that goes backwards.
    nodes: [u32; MOST],
    width: u8,
    eliminated: u8,
    /// Place of every node of the element, in its own order.
    slots: [u8; MOST],
    /// Places that what the front before left over goes to.
    incoming: [u8; 2],
    incoming_count: u8,
    /// Whether what is left over belongs to kept nodes only and leaves the chain.
    leaves: bool,
}

/// The factorised tangent of one rod.
///
/// Elements are eliminated in order. The matrix of an element receives what is left over its first node from the
/// elements before; its nodes but the last are eliminated, and what is left over its last node goes on to the next.
/// That is the work of condensing the interior nodes and of eliminating the block-tridiagonal rest, in one sweep.
/// Blocks are eliminated as they come; a front whose multipliers grow large is eliminated again with row pivoting.
/// Nodes that others need (a joint's) are *kept*: they are carried along from front to front until the next kept
/// node, and what is left over them is the rod's share in the coupled system.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Whether elements and their nodes are taken from the last to the first: from the end that is not kept.
    backwards: bool,
    elements: usize,
    /// Makes force and moment rows comparable [m].
    length: f64,
    fronts: Vec<Front>,
    blocks: Vec<Matrix6<f64>>,
    /// The fronts that needed pivoting, and memory for more.
    pivoted: Vec<Pivoted>,
    pivoted_count: usize,
    /// What the last front left over, over one or two nodes, row by row.
    left: [Matrix6<f64>; 4],
    kept: Vec<usize>,
    /// What is left over the kept nodes, by pairs of them, in a fixed order.
    remainder: Vec<(usize, usize, Matrix6<f64>)>,
    filled: usize,
}

/// The nodes that a chain keeps, ascending: of an element with a kept node inside the ends, too.
pub fn kept_nodes(degree: usize, kept: &[usize]) -> Vec<usize> {
    let mut kept: Vec<usize> = kept
        .iter()
        .flat_map(|&node| {
            let start = node - node % degree;
            if node == start { vec![node] } else { vec![start, node, start + degree] }
        })
        .collect();
    kept.sort_unstable();
    kept.dedup();
    kept
}

impl Chain {
    /// For a rod of `elements` elements of degree `degree`, 1 to 8, that keeps some of its nodes. A kept node inside
    /// an element makes it keep the element's ends, too: see [`Self::kept`]. `length` is that of an element [m].
    pub fn new(elements: usize, degree: usize, kept: &[usize], length: f64) -> Self {
        let last = elements * degree;
        let kept = kept_nodes(degree, kept);
        let backwards = kept.first() == Some(&0) && kept.last() != Some(&last);
        let mut chain = Self {
            backwards,
            elements,
            length,
            fronts: Vec::with_capacity(elements + 1),
            blocks: Vec::new(),
            pivoted: Vec::new(),
            pivoted_count: 0,
            left: [Matrix6::zeros(); 4],
            kept,
            remainder: Vec::new(),
            filled: 0,
        };
        let (mut size, mut carried) = (0, None);
        // What the front before leaves over: at most the carried node and its last.
        let mut incoming: Vec<usize> = Vec::new();
        for step in 0..=elements {
            let node_at = |i: usize| {
                let place = step * degree + i;
                if backwards { last - place } else { place }
            };
            // After the last element the last node remains.
            let count = if step < elements { degree + 1 } else { 1 };
            let is_kept = |node: usize| chain.kept.binary_search(&node).is_ok();
            let goes = |i: usize| !is_kept(node_at(i)) && (i + 1 < count || step == elements);
            if step == elements && is_kept(node_at(0)) {
                break;
            }
            let mut nodes: Vec<usize> = (0..count).filter(|&i| goes(i)).map(node_at).collect();
            let eliminated = nodes.len();
            nodes.extend(carried);
            nodes.extend((0..count).filter(|&i| !goes(i)).map(node_at));
            if backwards {
                nodes.reverse();
            }
            let place = |node: usize| nodes.iter().position(|&other| other == node).unwrap_or(0) as u8;
            let mut front = Front {
                blocks: 0,
                pivoted: NONE,
                plain: false,
                nodes: [0; MOST],
                width: nodes.len() as u8,
                eliminated: eliminated as u8,
                slots: [0; MOST],
                incoming: [0; 2],
                incoming_count: incoming.len() as u8,
                leaves: false,
            };
            let rest = &nodes[chain.rest(&front)];
            front.leaves = rest.iter().all(|&node| is_kept(node));
            for (slot, &node) in front.nodes.iter_mut().zip(&nodes) {
                *slot = node as u32;
            }
            for i in 0..count {
                let own = if backwards { count - 1 - i } else { i };
                front.slots[own] = place(node_at(i));
            }
            for (slot, &node) in front.incoming.iter_mut().zip(&incoming) {
                *slot = place(node);
            }
            let in_order = front.slots[..count].iter().enumerate().all(|(i, &slot)| i == usize::from(slot));
            front.plain = in_order && nodes.len() == count && incoming.len() < 2;
            // What is left over its last node is handed on, so that the next one may write there.
            if front.plain && chain.fronts.last().is_some_and(|before| before.plain) {
                size -= 1;
            }
            front.blocks = size;
            size += nodes.len().pow(2);
            if front.leaves {
                let pairs = rest.iter().flat_map(|&a| rest.iter().map(move |&b| (a, b)));
                chain.remainder.extend(pairs.map(|(a, b)| (a, b, Matrix6::zeros())));
                (incoming, carried) = (Vec::new(), None);
            } else {
                incoming = rest.to_vec();
                carried = incoming.iter().copied().find(|&node| is_kept(node));
            }
            chain.fronts.push(front);
        }
        if backwards {
            for front in &mut chain.fronts {
                front.blocks = size - front.blocks - usize::from(front.width).pow(2);
            }
        }
        chain.blocks = vec![Matrix6::zeros(); size];
        chain
    }

    /// With other numbers for the nodes, in the same order.
    pub fn with_nodes_at(mut self, place: impl Fn(usize) -> usize) -> Self {
        for front in &mut self.fronts {
            for node in &mut front.nodes[..usize::from(front.width)] {
                *node = place(*node as usize) as u32;
            }
        }
        for node in &mut self.kept {
            *node = place(*node);
        }
        for (row, column, _) in &mut self.remainder {
            (*row, *column) = (place(*row), place(*column));
        }
        self
    }

    /// The places of a front that are left over.
    #[inline(always)]
    fn rest(&self, front: &Front) -> Range<usize> {
        let (width, count) = (usize::from(front.width), usize::from(front.eliminated));
        if self.backwards { 0..width - count } else { count..width }
    }

    /// The place of a front that is eliminated as the k-th.
    #[inline(always)]
    fn eliminated(&self, front: &Front, k: usize) -> usize {
        if self.backwards { usize::from(front.width) - 1 - k } else { k }
    }

    /// The kept nodes, ascending.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Whether elements are taken from the last to the first.
    pub fn is_backwards(&self) -> bool {
        self.backwards
    }

    /// The element that is eliminated at a step, counted from 0.
    #[inline]
    pub fn element(&self, step: usize) -> usize {
        if self.backwards { self.elements - 1 - step } else { step }
    }

    /// Where the tangent of the element of a step may be written for [`Self::eliminate_written`]; `None` where only
    /// [`Self::add_element`] will do.
    #[inline(always)]
    pub fn place<const N: usize>(&mut self, step: usize) -> Option<&mut ElementTangent<N>> {
        let front = &self.fronts[step];
        if !front.plain {
            return None;
        }
        self.blocks[front.blocks..].as_chunks_mut::<N>().0.first_chunk_mut()
    }

    /// Eliminates the element whose tangent was written to its place; false if it must be added again with
    /// [`Self::add_element`], because its elimination needs pivoting.
    #[inline(always)]
    pub fn eliminate_written(&mut self, processor: impl Processor, step: usize) -> bool {
        self.start(step);
        self.receive(step);
        let eliminated = self.eliminate_blocks(processor, step);
        if eliminated {
            self.pass_on(step);
        }
        eliminated
    }

    /// Adds the tangent of the element of a step and eliminates what can be eliminated; in order, from step 0.
    #[inline(always)]
    pub fn add_element<const N: usize>(
        &mut self,
        processor: impl Processor,
        step: usize,
        tangent: &ElementTangent<N>,
    ) -> Result<(), Singular> {
        self.start(step);
        self.eliminate(processor, step, tangent)
    }

    fn start(&mut self, step: usize) {
        if step == 0 {
            self.filled = 0;
            self.pivoted_count = 0;
        }
    }

    /// Eliminates the last node, after all elements.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        if self.fronts.len() > self.elements {
            self.eliminate::<0>(Plain, self.elements, &[])
        } else {
            Ok(())
        }
    }

    #[inline(always)]
    fn eliminate<const N: usize>(
        &mut self,
        processor: impl Processor,
        step: usize,
        tangent: &ElementTangent<N>,
    ) -> Result<(), Singular> {
        self.fill(step, tangent);
        if !self.eliminate_blocks(processor, step) {
            self.fill(step, tangent);
            self.eliminate_pivoted(step)?;
        }
        self.pass_on(step);
        Ok(())
    }

    /// Without pivoting; false if that does not do.
    #[inline(always)]
    fn eliminate_blocks(&mut self, processor: impl Processor, step: usize) -> bool {
        let front = &mut self.fronts[step];
        let (width, count) = (usize::from(front.width), usize::from(front.eliminated));
        front.pivoted = NONE;
        let blocks = &mut self.blocks[front.blocks..][..width * width];
        blocks::eliminate(processor, blocks, (width, count, self.backwards), self.length)
    }

    /// The matrix of a front: the element's and what was left over.
    #[inline(always)]
    fn fill<const N: usize>(&mut self, step: usize, tangent: &ElementTangent<N>) {
        let front = &self.fronts[step];
        let width = usize::from(front.width);
        let blocks = &mut self.blocks[front.blocks..][..width * width];
        if width > N {
            blocks.fill(Matrix6::zeros());
        }
        for (row, &i) in tangent.iter().zip(&front.slots) {
            let blocks = &mut blocks[usize::from(i) * width..][..width];
            for (block, &j) in row.iter().zip(&front.slots) {
                blocks[usize::from(j)] = *block;
            }
        }
        self.receive(step);
    }

    /// Adds what was left over.
    #[inline(always)]
    fn receive(&mut self, step: usize) {
        let front = &self.fronts[step];
        let width = usize::from(front.width);
        let blocks = &mut self.blocks[front.blocks..][..width * width];
        let incoming = &front.incoming[..usize::from(front.incoming_count)];
        let places = incoming.iter().flat_map(|&i| incoming.iter().map(move |&j| (i, j)));
        for ((i, j), left) in places.zip(&self.left) {
            blocks[usize::from(i) * width + usize::from(j)] += left;
        }
    }

    /// Eliminates a front that is filled with row pivoting.
    #[cold]
    fn eliminate_pivoted(&mut self, step: usize) -> Result<(), Singular> {
        let front = &mut self.fronts[step];
        let (width, count) = (usize::from(front.width), usize::from(front.eliminated));
        if self.pivoted.len() == self.pivoted_count {
            self.pivoted.push(Pivoted::default());
        }
        front.pivoted = self.pivoted_count as u32;
        let pivoted = &mut self.pivoted[self.pivoted_count];
        self.pivoted_count += 1;
        pivoted.factorize(&self.blocks[front.blocks..][..width * width], width, count, self.backwards)
    }

    /// Hands on what a front that is eliminated has left over.
    #[inline(always)]
    fn pass_on(&mut self, step: usize) {
        let front = &self.fronts[step];
        let (width, rest) = (usize::from(front.width), self.rest(front));
        let blocks = &self.blocks[front.blocks..][..width * width];
        let places = rest.clone().flat_map(|i| rest.clone().map(move |j| (i, j)));
        for (k, (i, j)) in places.enumerate() {
            let block = match self.pivoted.get(front.pivoted as usize) {
                Some(pivoted) => pivoted.block(i, j),
                None => blocks[i * width + j],
            };
            if front.leaves {
                self.remainder[self.filled].2 = block;
                self.filled += 1;
            } else {
                self.left[k] = block;
            }
        }
    }

    /// What is left over the kept nodes after the factorisation: blocks by rows and columns, to be summed.
    pub fn remainder(&self) -> &[(usize, usize, Matrix6<f64>)] {
        &self.remainder
    }

    /// The first half of the solution: eliminates the chain's own unknowns from b (six entries a node, in order
    /// along the rod) and leaves in the entries of the kept nodes the right side of their system.
    pub fn forward(&self, b: &mut [f64]) {
        let b = b.as_chunks_mut::<NODE>().0;
        widest!(processor => self.forward_blocks(processor, b));
    }

    #[inline(always)]
    fn forward_blocks(&self, processor: impl Processor, b: &mut [[f64; NODE]]) {
        for front in &self.fronts {
            let (nodes, blocks) = self.parts(front);
            if let Some(pivoted) = self.pivoted.get(front.pivoted as usize) {
                let mut x = self.gather(nodes, b);
                pivoted.forward(&mut x.as_flattened_mut()[..NODE * nodes.len()]);
                self.scatter(nodes, nodes.len(), &x, b);
                continue;
            }
            let width = nodes.len();
            for k in 0..usize::from(front.eliminated) {
                let pivot = self.eliminated(front, k);
                let mut y = b[nodes[pivot] as usize];
                blocks::solve_lower(processor, &blocks[pivot * width + pivot], &mut y);
                b[nodes[pivot] as usize] = y;
                for i in if self.backwards { 0..pivot } else { pivot + 1..width } {
                    let (node, block) = (nodes[i] as usize, &blocks[i * width + pivot]);
                    blocks::subtract_times(processor, &mut b[node], block, &y);
                }
            }
        }
    }

    /// The second half: with the kept nodes' entries solved, the others.
    pub fn backward(&self, b: &mut [f64]) {
        let b = b.as_chunks_mut::<NODE>().0;
        widest!(processor => self.backward_blocks(processor, b));
    }

    #[inline(always)]
    fn backward_blocks(&self, processor: impl Processor, b: &mut [[f64; NODE]]) {
        for front in self.fronts.iter().rev() {
            let (nodes, blocks) = self.parts(front);
            let (width, count) = (nodes.len(), usize::from(front.eliminated));
            if let Some(pivoted) = self.pivoted.get(front.pivoted as usize) {
                let mut x = self.gather(nodes, b);
                pivoted.backward(&mut x.as_flattened_mut()[..NODE * nodes.len()]);
                self.scatter(nodes, count, &x, b);
                continue;
            }
            for k in (0..count).rev() {
                let pivot = self.eliminated(front, k);
                let row = &blocks[pivot * width..][..width];
                let mut y = b[nodes[pivot] as usize];
                for j in if self.backwards { 0..pivot } else { pivot + 1..width } {
                    blocks::subtract_times(processor, &mut y, &row[j], &b[nodes[j] as usize]);
                }
                blocks::solve_upper(processor, &row[pivot], &mut y);
                b[nodes[pivot] as usize] = y;
            }
        }
    }

    /// The nodes and blocks of a front.
    #[inline(always)]
    fn parts<'a>(&'a self, front: &'a Front) -> (&'a [u32], &'a [Matrix6<f64>]) {
        let width = usize::from(front.width);
        (&front.nodes[..width], &self.blocks[front.blocks..][..width * width])
    }

    /// b ← K⁻¹ b for a chain that keeps no node.
    pub fn solve(&self, b: &mut [f64]) {
        self.forward(b);
        self.backward(b);
    }

    /// The entries of some nodes in the order of elimination.
    fn gather(&self, nodes: &[u32], b: &[[f64; NODE]]) -> [[f64; NODE]; MOST] {
        let mut x = [[0.0; NODE]; MOST];
        for (i, x) in x.iter_mut().enumerate().take(nodes.len()) {
            let place = if self.backwards { nodes.len() - 1 - i } else { i };
            *x = b[nodes[place] as usize];
        }
        x
    }

    /// Puts the first `count` of them back.
    fn scatter(&self, nodes: &[u32], count: usize, x: &[[f64; NODE]; MOST], b: &mut [[f64; NODE]]) {
        for (i, x) in x.iter().enumerate().take(count) {
            let place = if self.backwards { nodes.len() - 1 - i } else { i };
            b[nodes[place] as usize] = *x;
        }
    }
}
