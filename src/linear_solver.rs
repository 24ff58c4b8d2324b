//! Linear systems: block-tridiagonal elimination for chains, sparse LU for the rest.
//!
//! A chain of elements with nodes 0 … p couples its interior nodes to nothing else. They are condensed first,
//! K_bb ← K_bb − K_bi K_ii⁻¹ K_ib, which leaves a block-tridiagonal system over the shared end nodes. Both stages
//! pivot by rows within their block. Nothing is allocated after construction.

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

/// Gaussian elimination with row pivoting on the first `m` columns of the row-major m × `width` matrix `a`.
///
/// Leaves the multipliers below and U on and above the diagonal, and the right columns as X = A⁻¹ B.
fn eliminate(a: &mut [f64], m: usize, width: usize, pivots: &mut [usize]) -> Result<(), Singular> {
    for k in 0..m {
        let mut pivot = k;
        for i in k + 1..m {
            if a[i * width + k].abs() > a[pivot * width + k].abs() {
                pivot = i;
            }
        }
        pivots[k] = pivot;
        if pivot != k {
            for column in 0..width {
                a.swap(k * width + column, pivot * width + column);
            }
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
            for (x, y) in other[k + 1..].iter_mut().zip(&row[k + 1..]) {
                *x -= factor * y;
            }
        }
    }
    for k in (0..m).rev() {
        let (head, tail) = a.split_at_mut((k + 1) * width);
        let row = &mut head[k * width..];
        let (factors, right) = row.split_at_mut(m);
        for (other, factor) in tail.chunks_exact(width).zip(&factors[k + 1..]) {
            for (x, y) in right.iter_mut().zip(&other[m..]) {
                *x -= factor * y;
            }
        }
        let inverse = 1.0 / factors[k];
        for x in right {
            *x *= inverse;
        }
    }
    Ok(())
}

/// b ← A⁻¹ b with the factors of [`eliminate`].
fn substitute(a: &[f64], m: usize, width: usize, pivots: &[usize], b: &mut [f64]) {
    for (k, &pivot) in pivots.iter().enumerate() {
        b.swap(k, pivot);
    }
    for i in 1..m {
        let sum: f64 = (0..i).map(|k| a[i * width + k] * b[k]).sum();
        b[i] -= sum;
    }
    for i in (0..m).rev() {
        let sum: f64 = (i + 1..m).map(|k| a[i * width + k] * b[k]).sum();
        b[i] = (b[i] - sum) / a[i * width + i];
    }
}

/// y ← y − A x for a row-major matrix with `x.len()` columns, `stride` apart.
fn subtract_product(a: &[f64], stride: usize, x: &[f64], y: &mut [f64]) {
    for (row, y) in a.chunks_exact(stride).zip(y) {
        *y -= row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
    }
}

/// The factorised tangent of one rod.
#[derive(Clone, Debug)]
pub struct Chain {
    elements: usize,
    /// m = 6 (p − 1) interior unknowns of an element.
    interior: usize,
    /// Per element m × (m + 12): factors of K_ii, then K_ii⁻¹ K_ib.
    condensed: Vec<f64>,
    /// Per element 12 × m: K_bi.
    coupling: Vec<f64>,
    /// Per element m pivots.
    interior_pivots: Vec<usize>,
    /// Per end node 6 × 12: the diagonal block, then the block to the next end node.
    diagonal: Vec<f64>,
    /// Per element 6 × 6: from the next end node back.
    lower: Vec<f64>,
    /// Per end node 6 pivots.
    pivots: Vec<usize>,
}

/// Columns of a row of `diagonal`.
const WIDE: usize = 2 * NODE;

impl Chain {
    /// For a rod of `elements` elements of degree `degree`.
    pub fn new(elements: usize, degree: usize) -> Self {
        let interior = NODE * (degree - 1);
        Self {
            elements,
            interior,
            condensed: vec![0.0; elements * interior * (interior + WIDE)],
            coupling: vec![0.0; elements * WIDE * interior],
            interior_pivots: vec![0; elements * interior],
            diagonal: vec![0.0; (elements + 1) * NODE * WIDE],
            lower: vec![0.0; elements * NODE * NODE],
            pivots: vec![0; (elements + 1) * NODE],
        }
    }

    /// Forgets the matrix.
    pub fn clear(&mut self) {
        self.diagonal.fill(0.0);
    }

    /// Adds and condenses the tangent of one element; every element once, in any order.
    pub fn add_element<const N: usize>(
        &mut self,
        e: usize,
        tangent: &ElementTangent<N>,
    ) -> Result<(), Singular> {
        let m = self.interior;
        let width = m + WIDE;
        let end = N - 1;
        let condensed = &mut self.condensed[e * m * width..][..m * width];
        let coupling = &mut self.coupling[e * WIDE * m..][..WIDE * m];
        for i in 1..end {
            let row = NODE * (i - 1);
            for j in 1..end {
                put(&mut condensed[row * width..], width, NODE * (j - 1), &tangent[i][j]);
            }
            put(&mut condensed[row * width..], width, m, &tangent[i][0]);
            put(&mut condensed[row * width..], width, m + NODE, &tangent[i][end]);
            put(coupling, m, row, &tangent[0][i]);
            put(&mut coupling[NODE * m..], m, row, &tangent[end][i]);
        }
        eliminate(condensed, m, width, &mut self.interior_pivots[e * m..][..m])?;
        // Row-major 12 × 12: what is left over the two end nodes.
        let mut ends = [0.0; WIDE * WIDE];
        for (i, a) in [0, end].into_iter().enumerate() {
            for (j, b) in [0, end].into_iter().enumerate() {
                put(&mut ends[i * NODE * WIDE..], WIDE, j * NODE, &tangent[a][b]);
            }
        }
        for (row, ends) in ends.chunks_exact_mut(WIDE).enumerate() {
            for (k, condensed) in condensed.chunks_exact(width).enumerate() {
                let factor = coupling[row * m + k];
                for (x, y) in ends.iter_mut().zip(&condensed[m..]) {
                    *x -= factor * y;
                }
            }
        }
        let diagonal = &mut self.diagonal[e * NODE * WIDE..][..2 * NODE * WIDE];
        let lower = &mut self.lower[e * NODE * NODE..][..NODE * NODE];
        for i in 0..NODE {
            for j in 0..NODE {
                diagonal[i * WIDE + j] += ends[i * WIDE + j];
                diagonal[i * WIDE + NODE + j] = ends[i * WIDE + NODE + j];
                lower[i * NODE + j] = ends[(NODE + i) * WIDE + j];
                diagonal[(NODE + i) * WIDE + j] += ends[(NODE + i) * WIDE + NODE + j];
            }
        }
        Ok(())
    }

    /// Eliminates along the end nodes: W_v = D_v⁻¹ U_v, D_{v+1} ← D_{v+1} − L_v W_v.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        const BLOCK: usize = NODE * WIDE;
        for v in 0..=self.elements {
            let (done, rest) = self.diagonal.split_at_mut((v + 1) * BLOCK);
            let block = &mut done[v * BLOCK..];
            eliminate(block, NODE, WIDE, &mut self.pivots[v * NODE..][..NODE])?;
            if v == self.elements {
                break;
            }
            let lower = &self.lower[v * NODE * NODE..][..NODE * NODE];
            for (next, lower) in rest[..BLOCK].chunks_exact_mut(WIDE).zip(lower.chunks_exact(NODE)) {
                for (factor, row) in lower.iter().zip(block.chunks_exact(WIDE)) {
                    for (x, y) in next[..NODE].iter_mut().zip(&row[NODE..]) {
                        *x -= factor * y;
                    }
                }
            }
        }
        Ok(())
    }

    /// b ← K⁻¹ b, six entries a node, nodes in order along the rod.
    pub fn solve(&self, b: &mut [f64]) {
        let m = self.interior;
        let (width, stride) = (m + WIDE, m + NODE);
        const BLOCK: usize = NODE * WIDE;
        let mut ends = [0.0; WIDE];
        for e in 0..self.elements {
            let element = &mut b[e * stride..][..stride + NODE];
            let (first, rest) = element.split_at_mut(NODE);
            let (inner, last) = rest.split_at_mut(m);
            if m > 0 {
                let pivots = &self.interior_pivots[e * m..][..m];
                substitute(&self.condensed[e * m * width..][..m * width], m, width, pivots, inner);
                ends[..NODE].copy_from_slice(first);
                ends[NODE..].copy_from_slice(last);
                subtract_product(&self.coupling[e * WIDE * m..][..WIDE * m], m, inner, &mut ends);
                first.copy_from_slice(&ends[..NODE]);
                last.copy_from_slice(&ends[NODE..]);
            }
            substitute(
                &self.diagonal[e * BLOCK..][..BLOCK],
                NODE,
                WIDE,
                &self.pivots[e * NODE..][..NODE],
                first,
            );
            subtract_product(&self.lower[e * NODE * NODE..][..NODE * NODE], NODE, first, last);
        }
        let e = self.elements;
        let last = &mut b[e * stride..][..NODE];
        substitute(&self.diagonal[e * BLOCK..][..BLOCK], NODE, WIDE, &self.pivots[e * NODE..][..NODE], last);
        for e in (0..self.elements).rev() {
            let element = &mut b[e * stride..][..stride + NODE];
            let (first, rest) = element.split_at_mut(NODE);
            let (inner, last) = rest.split_at_mut(m);
            for (row, x) in self.diagonal[e * BLOCK..][..BLOCK].chunks_exact(WIDE).zip(&mut *first) {
                *x -= row[NODE..].iter().zip(&*last).map(|(a, x)| a * x).sum::<f64>();
            }
            for (row, x) in self.condensed[e * m * width..][..m * width].chunks_exact(width).zip(inner) {
                *x -= row[m..].iter().zip(first.iter().chain(&*last)).map(|(a, x)| a * x).sum::<f64>();
            }
        }
    }
}

/// Writes a 6×6 block into a row-major matrix at `column`.
#[inline]
fn put(rows: &mut [f64], width: usize, column: usize, block: &Matrix6<f64>) {
    for i in 0..NODE {
        for j in 0..NODE {
            rows[i * width + column + j] = block[(i, j)];
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
            chain.clear();
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
        chain.clear();
        chain.add_element(0, &[[Matrix6::<f64>::zeros(); 2]; 2]).expect("nothing to condense");
        chain.add_element(1, &[[Matrix6::<f64>::zeros(); 2]; 2]).expect("nothing to condense");
        assert_eq!(chain.factorize(), Err(Singular));
        let mut sparse = Sparse::new(1);
        sparse.add(0, 0, f64::NAN);
        assert_eq!(sparse.factorize(), Err(Singular));
    }
}
