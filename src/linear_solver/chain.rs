//! Frontal elimination of one rod.

use nalgebra::Matrix6;

use super::{NODE, Singular, dot};
use crate::element::ElementTangent;

/// Gaussian elimination of the first `count` unknowns of a square row-major matrix, with pivots among the first
/// `count` rows: leaves the multipliers below the diagonal, U on and above it, and the Schur complement.
#[inline]
fn eliminate<const W: usize>(a: &mut [[f64; W]], count: usize, pivots: &mut [u8]) -> Result<(), Singular> {
    for k in 0..count {
        let mut pivot = k;
        for i in k + 1..count {
            if a[i][k].abs() > a[pivot][k].abs() {
                pivot = i;
            }
        }
        pivots[k] = pivot as u8;
        a.swap(k, pivot);
        let (head, tail) = a.split_at_mut(k + 1);
        let row = &head[k];
        let inverse = 1.0 / row[k];
        if !(inverse.is_finite() && inverse != 0.0) {
            return Err(Singular);
        }
        for other in tail {
            let factor = other[k] * inverse;
            other[k] = factor;
            for j in k + 1..W {
                other[j] -= factor * row[j];
            }
        }
    }
    Ok(())
}

/// b ← L⁻¹ b for the eliminated unknowns, and what is left of b for the others.
#[inline]
fn forward<const W: usize>(a: &[[f64; W]], count: usize, pivots: &[u8], b: &mut [f64]) {
    for (k, &pivot) in pivots[..count].iter().enumerate() {
        b.swap(k, usize::from(pivot));
    }
    for i in 1..W {
        let known = count.min(i);
        let (before, rest) = b.split_at_mut(i);
        rest[0] -= dot(&a[i][..known], &before[..known]);
    }
}

/// b ← U⁻¹ b for the eliminated unknowns, from the last, the others being known.
#[inline]
fn backward<const W: usize>(a: &[[f64; W]], count: usize, b: &mut [f64]) {
    for i in (0..count).rev() {
        let (before, after) = b.split_at_mut(i + 1);
        before[i] = (before[i] - dot(&a[i][i + 1..], after)) / a[i][i];
    }
}

/// Most nodes of a front: those of an element of degree 8 and one that is carried along.
const MOST: usize = 10;

/// Calls `$function::<W>` on the rows of a front of `$nodes` nodes, 1 to 10.
macro_rules! with_front {
    ($nodes:expr, $rows:expr, $as_chunks:ident, $function:ident, $($argument:expr),*) => {
        match $nodes {
            1 => $function($rows.$as_chunks::<NODE>().0, $($argument),*),
            2 => $function($rows.$as_chunks::<{ 2 * NODE }>().0, $($argument),*),
            3 => $function($rows.$as_chunks::<{ 3 * NODE }>().0, $($argument),*),
            4 => $function($rows.$as_chunks::<{ 4 * NODE }>().0, $($argument),*),
            5 => $function($rows.$as_chunks::<{ 5 * NODE }>().0, $($argument),*),
            6 => $function($rows.$as_chunks::<{ 6 * NODE }>().0, $($argument),*),
            7 => $function($rows.$as_chunks::<{ 7 * NODE }>().0, $($argument),*),
            8 => $function($rows.$as_chunks::<{ 8 * NODE }>().0, $($argument),*),
            9 => $function($rows.$as_chunks::<{ 9 * NODE }>().0, $($argument),*),
            _ => $function($rows.$as_chunks::<{ 10 * NODE }>().0, $($argument),*),
        }
    };
}

/// The matrix of one element and what comes with it, in the order of elimination.
#[derive(Clone, Debug, PartialEq)]
struct Front {
    /// Where its rows start among the values, and its pivots.
    values: usize,
    pivots: usize,
    /// The nodes of the rod in the order of the front: first those that are eliminated here, then the others.
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
/// elements before; its nodes but the last are eliminated with row pivoting among them, and what is left over its
/// last node goes on to the next. That is the work of condensing the interior nodes and of eliminating the
/// block-tridiagonal rest, in one sweep. Nodes that others need (a joint's) are *kept*: they are carried along from
/// front to front until the next kept node, and what is left over them is the rod's share in the coupled system.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Whether elements are taken from the last to the first: from the end that is not kept.
    backwards: bool,
    elements: usize,
    fronts: Vec<Front>,
    values: Vec<f64>,
    pivots: Vec<u8>,
    /// What the last front left over, row-major over one or two nodes.
    left: [f64; 4 * NODE * NODE],
    kept: Vec<usize>,
    /// What is left over the kept nodes, by pairs of them, in a fixed order.
    remainder: Vec<(usize, usize, Matrix6<f64>)>,
    filled: usize,
}

impl Chain {
    /// For a rod of `elements` elements of degree `degree`, 1 to 8, that keeps some of its nodes. A kept node inside
    /// an element makes it keep the element's ends, too: see [`Self::kept`].
    pub fn new(elements: usize, degree: usize, kept: &[usize]) -> Self {
        let last = elements * degree;
        let mut kept: Vec<usize> = kept
            .iter()
            .flat_map(|&node| {
                let start = node - node % degree;
                if node == start { vec![node] } else { vec![start, node, start + degree] }
            })
            .collect();
        kept.sort_unstable();
        kept.dedup();
        let backwards = kept.first() == Some(&0) && kept.last() != Some(&last);
        let mut chain = Self {
            backwards,
            elements,
            fronts: Vec::with_capacity(elements + 1),
            values: Vec::new(),
            pivots: Vec::new(),
            left: [0.0; 4 * NODE * NODE],
            kept,
            remainder: Vec::new(),
            filled: 0,
        };
        let (mut size, mut pivots, mut carried) = (0, 0, None);
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
            let place = |node: usize| nodes.iter().position(|&other| other == node).unwrap_or(0) as u8;
            let mut front = Front {
                values: size,
                pivots,
                nodes: [0; MOST],
                width: nodes.len() as u8,
                eliminated: eliminated as u8,
                slots: [0; MOST],
                incoming: [0; 2],
                incoming_count: incoming.len() as u8,
                leaves: nodes[eliminated..].iter().all(|&node| is_kept(node)),
            };
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
            size += (nodes.len() * NODE).pow(2);
            pivots += eliminated * NODE;
            if front.leaves {
                let rest = &nodes[eliminated..];
                let pairs = rest.iter().flat_map(|&a| rest.iter().map(move |&b| (a, b)));
                chain.remainder.extend(pairs.map(|(a, b)| (a, b, Matrix6::zeros())));
                (incoming, carried) = (Vec::new(), None);
            } else {
                incoming = nodes[eliminated..].to_vec();
                carried = incoming.iter().copied().find(|&node| is_kept(node));
            }
            chain.fronts.push(front);
        }
        chain.values = vec![0.0; size];
        chain.pivots = vec![0; pivots];
        chain
    }

    /// The kept nodes, ascending.
    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// The element that is eliminated at a step, counted from 0.
    #[inline]
    pub fn element(&self, step: usize) -> usize {
        if self.backwards { self.elements - 1 - step } else { step }
    }

    /// Adds the tangent of the element of a step and eliminates what can be eliminated; in order, from step 0.
    pub fn add_element<const N: usize>(
        &mut self,
        step: usize,
        tangent: &ElementTangent<N>,
    ) -> Result<(), Singular> {
        if step == 0 {
            self.filled = 0;
        }
        let front = &self.fronts[step];
        let width = NODE * usize::from(front.width);
        let rows = &mut self.values[front.values..][..width * width];
        if usize::from(front.width) > N {
            rows.fill(0.0);
        }
        for (i, blocks) in tangent.iter().enumerate() {
            for (j, block) in blocks.iter().enumerate() {
                let (row, column) = (usize::from(front.slots[i]), usize::from(front.slots[j]));
                put(&mut rows[row * NODE * width + column * NODE..], width, block);
            }
        }
        self.eliminate_front(step)
    }

    /// Eliminates the last node, after all elements.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        let Some(front) = self.fronts.get(self.elements) else { return Ok(()) };
        let width = NODE * usize::from(front.width);
        self.values[front.values..][..width * width].fill(0.0);
        self.eliminate_front(self.elements)
    }

    fn eliminate_front(&mut self, step: usize) -> Result<(), Singular> {
        let front = &self.fronts[step];
        let width = NODE * usize::from(front.width);
        let rows = &mut self.values[front.values..][..width * width];
        let incoming = &front.incoming[..usize::from(front.incoming_count)];
        let side = NODE * incoming.len();
        for (a, &row) in incoming.iter().enumerate() {
            for (b, &column) in incoming.iter().enumerate() {
                for i in 0..NODE {
                    let start = (usize::from(row) * NODE + i) * width + usize::from(column) * NODE;
                    let from = (a * NODE + i) * side + b * NODE;
                    for (x, left) in rows[start..][..NODE].iter_mut().zip(&self.left[from..][..NODE]) {
                        *x += left;
                    }
                }
            }
        }
        let count = NODE * usize::from(front.eliminated);
        let pivots = &mut self.pivots[front.pivots..][..count];
        with_front!(front.width, rows, as_chunks_mut, eliminate, count, pivots)?;
        let rest = width - count;
        if front.leaves {
            for a in (0..rest).step_by(NODE) {
                for b in (0..rest).step_by(NODE) {
                    let block = &mut self.remainder[self.filled].2;
                    for i in 0..NODE {
                        for j in 0..NODE {
                            block[(i, j)] = rows[(count + a + i) * width + count + b + j];
                        }
                    }
                    self.filled += 1;
                }
            }
        } else {
            for (row, left) in rows[count * width..].chunks_exact(width).zip(self.left.chunks_exact_mut(rest))
            {
                left.copy_from_slice(&row[count..]);
            }
        }
        Ok(())
    }

    /// What is left over the kept nodes after the factorisation: blocks by rows and columns, to be summed.
    pub fn remainder(&self) -> &[(usize, usize, Matrix6<f64>)] {
        &self.remainder
    }

    /// The first half of the solution: eliminates the chain's own unknowns from b (six entries a node, in order
    /// along the rod) and leaves in the entries of the kept nodes the right side of their system.
    pub fn forward(&self, b: &mut [f64]) {
        let mut x = [0.0; MOST * NODE];
        for front in &self.fronts {
            let (nodes, count) = gather(front, b, &mut x);
            let width = NODE * nodes.len();
            let rows = &self.values[front.values..][..width * width];
            let pivots = &self.pivots[front.pivots..][..count];
            with_front!(nodes.len(), rows, as_chunks, forward, count, pivots, &mut x[..width]);
            for (&node, x) in nodes.iter().zip(x.chunks_exact(NODE)) {
                b[NODE * node as usize..][..NODE].copy_from_slice(x);
            }
        }
    }

    /// The second half: with the kept nodes' entries solved, the others.
    pub fn backward(&self, b: &mut [f64]) {
        let mut x = [0.0; MOST * NODE];
        for front in self.fronts.iter().rev() {
            let (nodes, count) = gather(front, b, &mut x);
            let width = NODE * nodes.len();
            let rows = &self.values[front.values..][..width * width];
            with_front!(nodes.len(), rows, as_chunks, backward, count, &mut x[..width]);
            let solved = &nodes[..usize::from(front.eliminated)];
            for (&node, x) in solved.iter().zip(x.chunks_exact(NODE)) {
                b[NODE * node as usize..][..NODE].copy_from_slice(x);
            }
        }
    }

    /// b ← K⁻¹ b for a chain that keeps no node.
    pub fn solve(&self, b: &mut [f64]) {
        self.forward(b);
        self.backward(b);
    }
}

/// A front's nodes and number of eliminated unknowns; copies its entries of b to x.
#[inline]
fn gather<'a>(front: &'a Front, b: &[f64], x: &mut [f64; MOST * NODE]) -> (&'a [u32], usize) {
    let nodes = &front.nodes[..usize::from(front.width)];
    for (&node, x) in nodes.iter().zip(x.chunks_exact_mut(NODE)) {
        x.copy_from_slice(&b[NODE * node as usize..][..NODE]);
    }
    (nodes, NODE * usize::from(front.eliminated))
}

/// Writes a 6×6 block into a row-major matrix.
#[inline]
fn put(rows: &mut [f64], width: usize, block: &Matrix6<f64>) {
    for i in 0..NODE {
        for j in 0..NODE {
            rows[i * width + j] = block[(i, j)];
        }
    }
}
