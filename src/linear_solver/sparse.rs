//! General sparse systems: faer's sparse LU with the pattern found once and reused.

use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{Argsort, Pair, SparseColMat, SymbolicSparseColMat};
use faer::traits::ComplexField;
use faer::traits::ext::ComplexFieldExt;

use super::Singular;

/// A general sparse system; the pattern and its ordering are found once and reused.
pub struct Sparse<T: ComplexField = f64> {
    size: usize,
    indices: Vec<Pair<usize, usize>>,
    values: Vec<T>,
    pattern: Option<Pattern>,
    factors: Option<Lu<usize, T>>,
}

struct Pattern {
    matrix: SymbolicSparseColMat<usize>,
    /// Where every added entry goes.
    order: Argsort<usize>,
    factors: SymbolicLu<usize>,
}

impl<T: ComplexField + Copy> Sparse<T> {
    /// An n × n system.
    pub fn new(size: usize) -> Self {
        Self { size, indices: Vec::new(), values: Vec::new(), pattern: None, factors: None }
    }

    /// Forgets the values, not the pattern: the same entries must be added again, in the same order.
    pub fn clear(&mut self) {
        self.values.clear();
    }

    /// Adds to an entry.
    pub fn add(&mut self, row: usize, column: usize, value: T) {
        if self.pattern.is_none() {
            self.indices.push(Pair::new(row, column));
        }
        self.values.push(value);
    }

    /// Factorises the sum of all entries.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        self.factors = None;
        if self.values.iter().any(|value| !value.is_finite()) || self.values.len() != self.indices.len() {
            return Err(Singular);
        }
        let pattern = match self.pattern.take() {
            Some(pattern) => pattern,
            None => {
                let (matrix, order) =
                    SymbolicSparseColMat::try_new_from_indices(self.size, self.size, &self.indices)
                        .map_err(|_| Singular)?;
                let factors = SymbolicLu::try_new(matrix.as_ref()).map_err(|_| Singular)?;
                Pattern { matrix, order, factors }
            }
        };
        let Pattern { matrix, order, factors } = self.pattern.insert(pattern);
        let values = SparseColMat::new_from_argsort(matrix.clone(), order, &self.values);
        let values = values.map_err(|_| Singular)?;
        self.factors =
            Some(Lu::try_new_with_symbolic(factors.clone(), values.as_ref()).map_err(|_| Singular)?);
        Ok(())
    }

    /// b ← K⁻¹ b.
    pub fn solve(&self, b: &mut [T]) -> Result<(), Singular> {
        use faer::linalg::solvers::Solve;
        let factors = self.factors.as_ref().ok_or(Singular)?;
        let mut right = faer::ColMut::from_slice_mut(b);
        factors.solve_in_place(&mut right);
        if b.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Singular) }
    }
}
