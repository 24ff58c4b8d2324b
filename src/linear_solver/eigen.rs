//! Eigenvalues and eigenvectors of small dense unsymmetric matrices.

use faer::Mat;
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
    let matrix = Mat::<f64>::from_fn(size, size, |i, j| rows[i][j]);
    let eigen = matrix.eigen().map_err(|_| Singular)?;
    let (values, vectors) = (eigen.S(), eigen.U());
    Ok((0..size).map(|k| (values[k], (0..size).map(|i| vectors[(i, k)]).collect())).collect())
}
