//! Linear systems: frontal elimination for chains, sparse LU for the rest.
//!
//! A chain of elements with nodes 0 … p is eliminated from its start: to the matrix of an element is added what is
//! left over its first node from the elements before, its first p nodes are eliminated with row pivoting among
//! them, and what is left over its last node goes on to the next. The work is that of condensing the interior
//! nodes and eliminating the block-tridiagonal rest, in one sweep. Nothing is allocated after construction.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use nalgebra::Matrix6;
use thiserror::Error;

use crate::element::ElementTangent;

/// Unknowns of a node.
pub const NODE: usize = 6;

/// A pivot is zero or a number is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the matrix is singular or a number overflowed")]
pub struct Singular;

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

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Calls `$function::<W>` on the rows of a front of `$nodes` nodes, 2 to 9.
macro_rules! with_front {
    ($nodes:expr, $rows:expr, $as_chunks:ident, $function:ident, $($argument:expr),*) => {
        match $nodes {
            2 => $function($rows.$as_chunks::<{ 2 * NODE }>().0, $($argument),*),
            3 => $function($rows.$as_chunks::<{ 3 * NODE }>().0, $($argument),*),
            4 => $function($rows.$as_chunks::<{ 4 * NODE }>().0, $($argument),*),
            5 => $function($rows.$as_chunks::<{ 5 * NODE }>().0, $($argument),*),
            6 => $function($rows.$as_chunks::<{ 6 * NODE }>().0, $($argument),*),
            7 => $function($rows.$as_chunks::<{ 7 * NODE }>().0, $($argument),*),
            8 => $function($rows.$as_chunks::<{ 8 * NODE }>().0, $($argument),*),
            _ => $function($rows.$as_chunks::<{ 9 * NODE }>().0, $($argument),*),
        }
    };
}

/// The factorised tangent of one rod.
#[derive(Clone, Debug)]
pub struct Chain {
    elements: usize,
    /// Nodes of an element.
    nodes: usize,
    /// Per element the eliminated front, row-major, as wide as its unknowns.
    fronts: Vec<f64>,
    /// Per element the pivots of all its nodes but the last.
    pivots: Vec<u8>,
    /// The last node of the rod.
    last: [[f64; NODE]; NODE],
    last_pivots: [u8; NODE],
}

impl Chain {
    /// For a rod of `elements` elements of degree `degree`, 1 to 8.
    pub fn new(elements: usize, degree: usize) -> Self {
        let width = NODE * (degree + 1);
        Self {
            elements,
            nodes: degree + 1,
            fronts: vec![0.0; elements * width * width],
            pivots: vec![0; elements * NODE * degree],
            last: [[0.0; NODE]; NODE],
            last_pivots: [0; NODE],
        }
    }

    /// Adds the tangent of element e and eliminates all its nodes but the last; in order, from element 0.
    pub fn add_element<const N: usize>(
        &mut self,
        e: usize,
        tangent: &ElementTangent<N>,
    ) -> Result<(), Singular> {
        let (width, count) = (NODE * N, NODE * (N - 1));
        let front = &mut self.fronts[e * width * width..][..width * width];
        for (i, blocks) in tangent.iter().enumerate() {
            for (j, block) in blocks.iter().enumerate() {
                put(&mut front[i * NODE * width + j * NODE..], width, block);
            }
        }
        if e > 0 {
            for (row, left) in front.chunks_exact_mut(width).zip(&self.last) {
                for (x, left) in row.iter_mut().zip(left) {
                    *x += left;
                }
            }
        }
        let pivots = &mut self.pivots[e * count..][..count];
        with_front!(N, front, as_chunks_mut, eliminate, count, pivots)?;
        for (row, left) in front[count * width..].chunks_exact(width).zip(&mut self.last) {
            left.copy_from_slice(&row[count..]);
        }
        Ok(())
    }

    /// Eliminates the last node, after all elements.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        eliminate(&mut self.last, NODE, &mut self.last_pivots)
    }

    /// b ← K⁻¹ b, six entries a node, nodes in order along the rod.
    pub fn solve(&self, b: &mut [f64]) {
        let (width, count) = (NODE * self.nodes, NODE * (self.nodes - 1));
        let front = |e: usize| &self.fronts[e * width * width..][..width * width];
        for e in 0..self.elements {
            let pivots = &self.pivots[e * count..][..count];
            let b = &mut b[e * count..][..width];
            with_front!(self.nodes, front(e), as_chunks, forward, count, pivots, b);
        }
        let last = &mut b[self.elements * count..][..NODE];
        forward(&self.last, NODE, &self.last_pivots, last);
        backward(&self.last, NODE, last);
        for e in (0..self.elements).rev() {
            let b = &mut b[e * count..][..width];
            with_front!(self.nodes, front(e), as_chunks, backward, count, b);
        }
    }
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

/// A general sparse system; the pattern and its ordering are found once and reused.
#[derive(Default)]
pub struct Sparse {
    size: usize,
    entries: Vec<Triplet<usize, usize, f64>>,
    symbolic: Option<SymbolicLu<usize>>,
    factors: Option<Lu<usize, f64>>,
}

impl Sparse {
    /// An n × n system.
    pub fn new(size: usize) -> Self {
        Self { size, ..Self::default() }
    }

    /// Forgets the values, not the pattern: the same entries must be added again.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Adds to an entry.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.entries.push(Triplet::new(row, column, value));
    }

    /// Factorises the sum of all entries.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        self.factors = None;
        if self.entries.iter().any(|entry| !entry.val.is_finite()) {
            return Err(Singular);
        }
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(self.size, self.size, &self.entries)
            .map_err(|_| Singular)?;
        let symbolic = match &self.symbolic {
            Some(symbolic) => symbolic.clone(),
            None => {
                let symbolic = SymbolicLu::try_new(matrix.symbolic()).map_err(|_| Singular)?;
                self.symbolic.insert(symbolic).clone()
            }
        };
        self.factors = Some(Lu::try_new_with_symbolic(symbolic, matrix.as_ref()).map_err(|_| Singular)?);
        Ok(())
    }

    /// b ← K⁻¹ b.
    pub fn solve(&self, b: &mut [f64]) -> Result<(), Singular> {
        let factors = self.factors.as_ref().ok_or(Singular)?;
        let mut right = faer::ColMut::from_slice_mut(b);
        factors.solve_in_place(&mut right);
        if b.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Singular) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reproducible numbers in (−1, 1).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    fn agree<const N: usize>(elements: usize) {
        let degree = N - 1;
        let size = NODE * (elements * degree + 1);
        let mut numbers = Numbers(N as u64);
        let mut chain = Chain::new(elements, degree);
        let mut sparse = Sparse::new(size);
        for _ in 0..2 {
            sparse.clear();
            let x: Vec<f64> = (0..size).map(|_| numbers.next()).collect();
            let mut b = vec![0.0; size];
            for e in 0..elements {
                let tangent: ElementTangent<N> =
                    std::array::from_fn(|_| std::array::from_fn(|_| Matrix6::from_fn(|_, _| numbers.next())));
                chain.add_element(e, &tangent).expect("regular");
                for (i, row) in tangent.iter().enumerate() {
                    for (j, block) in row.iter().enumerate() {
                        for r in 0..NODE {
                            for c in 0..NODE {
                                let (row, column) =
                                    ((e * degree + i) * NODE + r, (e * degree + j) * NODE + c);
                                sparse.add(row, column, block[(r, c)]);
                                b[row] += block[(r, c)] * x[column];
                            }
                        }
                    }
                }
            }
            chain.factorize().expect("regular");
            sparse.factorize().expect("regular");
            let mut by_chain = b.clone();
            chain.solve(&mut by_chain);
            sparse.solve(&mut b).expect("regular");
            for i in 0..size {
                assert!((by_chain[i] - x[i]).abs() < 1e-9, "N = {N}: {} {}", by_chain[i], x[i]);
                assert!((b[i] - x[i]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn chain_and_sparse_solve_the_same_system() {
        agree::<2>(7);
        agree::<3>(5);
        agree::<5>(3);
        agree::<9>(2);
    }

    #[test]
    fn singular_matrices_are_an_error() {
        let mut chain = Chain::new(2, 1);
        assert_eq!(chain.add_element(0, &[[Matrix6::<f64>::zeros(); 2]; 2]), Err(Singular));
        let identity = [[Matrix6::identity(), Matrix6::zeros()], [Matrix6::zeros(), Matrix6::zeros()]];
        assert_eq!(chain.add_element(0, &identity).and_then(|()| chain.factorize()), Err(Singular));
        let overflow = [[Matrix6::from_element(f64::INFINITY); 2]; 2];
        assert_eq!(chain.add_element(0, &overflow), Err(Singular));
        let mut sparse = Sparse::new(1);
        sparse.add(0, 0, f64::NAN);
        assert_eq!(sparse.factorize(), Err(Singular));
    }
}
