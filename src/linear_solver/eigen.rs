//! Eigenvalues and eigenvectors of small dense unsymmetric matrices.

use faer::Mat;
use faer::linalg::solvers::Eigen;
use nalgebra::Complex;

use super::Singular;

/// An eigenvalue with its right eigenvector.
pub type Eigenpair = (Complex<f64>, Vec<Complex<f64>>);

/// Eigenvalues with their right eigenvectors of a real n × n matrix, given row by row.
pub fn eigenpairs(rows: &[Vec<f64>]) -> Result<Vec<Eigenpair>, Singular> {
    let size = rows.len();
    if !rows.iter().flatten().all(|x| x.is_finite()) {
        return Err(Singular);
    }
    let real = Mat::<f64>::from_fn(size, size, |i, j| rows[i][j]);
    let complex = || Mat::<Complex<f64>>::from_fn(size, size, |i, j| rows[i][j].into());
    let found = |eigen: Eigen<f64>| {
        let (values, vectors) = (eigen.S(), eigen.U());
        let vector = |k| (0..size).map(|i| vectors[(i, k)]).collect::<Vec<_>>();
        let pairs: Vec<Eigenpair> = (0..size).map(|k| (values[k], vector(k))).collect();
        pairs.iter().flat_map(|(_, vector)| vector).all(|x| x.is_finite()).then_some(pairs)
    };
    // The real algorithm divides by the distance of eigenvalues, which may be zero; the complex one goes its own way.
    let of_real = real.eigen().ok().and_then(found);
    of_real.or_else(|| complex().eigen().ok().and_then(found)).ok_or(Singular)
}
