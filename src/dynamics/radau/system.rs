//! The linear systems of the simplified Newton iteration.
//!
//! With M, D, K and G frozen, the increments of all stages obey
//!
//! ```text
//! M δU̇_i + D δU_i + K δQ_i − Gᵀ δΛ_i = ρ_i,   G δU_i = −c_i,   δU = h A δU̇,   δQ = h A (δU − (0, ω̃ δφ))
//! ```
//!
//! where A mixes the stages, ρ is the residual, c = G U, and the last is the rate δφ̇ = δω − ω × δφ of a rotation
//! increment in the body basis with ω frozen, too. Multiplied by a left eigenvector of A, ℓᵀ A = μ ℓᵀ, stages separate
//! (Hairer & Wanner, IV.8), and with x̂ = Σ ℓ_i x_i and y = h μ ω
//!
//! ```text
//! ⎡M + hμ D + h²μ² K W  −Gᵀ⎤ ⎡δû̇⎤   ⎡  ρ̂    ⎤
//! ⎣G                     0 ⎦ ⎣δλ̂⎦ = ⎣−ĉ/(hμ)⎦     W = diag(1, (1 + ỹ)⁻¹) = diag(1, (1 − ỹ + y yᵀ)/(1 + y·y))
//! ```
//!
//! The last, (1 + ỹ)(1 − ỹ + y yᵀ) = 1 − ỹ² + y yᵀ = 1 + y·y, is an identity of polynomials and holds for complex y.
//! μ takes one real and one complex value with its conjugate, x_i = t_i x̂ + 2 Re(t_i x̂).

use nalgebra::{Complex, Matrix3, Vector3};

use super::tableau::{Eigen, STAGES, Tableau};
use crate::assembly::Blocks;
use crate::inertia::Velocity;
use crate::linear_solver::{NODE, Singular, Sparse};
use crate::model::Model;

/// Both systems with their pattern; held nodes are left out.
pub struct StageSystems {
    real: Sparse<f64>,
    complex: Sparse<Complex<f64>>,
    /// First unknown of every node that moves.
    places: Vec<Option<usize>>,
    /// Six a moving node, and where the multipliers start.
    nodal: usize,
    /// h of the last factors.
    length: f64,
    right: Vec<f64>,
    complex_right: Vec<Complex<f64>>,
}

impl StageSystems {
    /// For a model.
    pub fn new(model: &Model) -> Self {
        let mut held = vec![false; model.reference.poses().len()];
        for rod in &model.rods {
            rod.supports.iter().for_each(|support| held[rod.range.start + support.node] = true);
        }
        let mut nodal = 0;
        let places = held.iter().map(|held| {
            let place = nodal;
            nodal += if *held { 0 } else { NODE };
            (!held).then_some(place)
        });
        let places = places.collect();
        let size = nodal + model.reference.multipliers().len();
        Self {
            real: Sparse::new(size),
            complex: Sparse::new(size),
            places,
            nodal,
            length: 0.0,
            right: vec![0.0; size],
            complex_right: vec![Complex::default(); size],
        }
    }

    /// First unknown of a node; `None` if it is held.
    pub fn place(&self, node: usize) -> Option<usize> {
        self.places[node]
    }

    /// Number of unknowns of nodes; those of the multipliers follow.
    pub fn nodal(&self) -> usize {
        self.nodal
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.right.len()
    }

    /// Builds and factorises both systems for a step of a length.
    pub fn factorize(
        &mut self,
        tableau: &Tableau,
        blocks: &Blocks,
        velocities: &[Velocity],
        length: f64,
    ) -> Result<(), Singular> {
        let Self { real, complex, places, nodal, .. } = self;
        self.length = length;
        let scaled = tableau.eigen.map(|eigen| eigen.value * length);
        real.clear();
        fill(blocks, velocities, places, *nodal, scaled[0], |row, column, x| real.add(row, column, x.re));
        real.factorize()?;
        complex.clear();
        fill(blocks, velocities, places, *nodal, scaled[1], |row, column, x| complex.add(row, column, x));
        complex.factorize()
    }

    /// (ρ_i, −c_i) of all stages → (δU̇_i, δΛ_i), with the last factors.
    pub fn solve(&mut self, tableau: &Tableau, stages: [&mut [f64]; STAGES]) -> Result<(), Singular> {
        let [of_real, of_complex] = &tableau.eigen;
        let project = |eigen: &Eigen, row: usize| {
            let sum: Complex<f64> = (0..STAGES).map(|i| eigen.left[i] * stages[i][row]).sum();
            if row < self.nodal { sum } else { sum / (eigen.value * self.length) }
        };
        for row in 0..self.right.len() {
            self.right[row] = project(of_real, row).re;
            self.complex_right[row] = project(of_complex, row);
        }
        self.real.solve(&mut self.right)?;
        self.complex.solve(&mut self.complex_right)?;
        for (i, stage) in stages.into_iter().enumerate() {
            for (x, (real, complex)) in stage.iter_mut().zip(self.right.iter().zip(&self.complex_right)) {
                *x = of_real.right[i].re * real + 2.0 * (of_complex.right[i] * complex).re;
            }
        }
        Ok(())
    }
}

/// Adds the entries of the matrix above for one z = hμ.
fn fill(
    blocks: &Blocks,
    velocities: &[Velocity],
    places: &[Option<usize>],
    nodal: usize,
    z: Complex<f64>,
    mut add: impl FnMut(usize, usize, Complex<f64>),
) {
    for block in &blocks.nodal {
        let [Some(row), Some(column)] = block.nodes.map(|node| places[node]) else { continue };
        let turn = turn(&velocities[block.nodes[1]].rotation, z) * (z * z);
        for r in 0..NODE {
            for c in 0..3 {
                add(row + r, column + c, z * z * block.stiffness[(r, c)] + diagonal(block.mass[r], r == c));
            }
            for c in 0..3 {
                let stiffness: Complex<f64> =
                    (0..3).map(|k| turn[(k, c)] * block.stiffness[(r, 3 + k)]).sum();
                let gyroscopic = if r < 3 { 0.0 } else { block.gyroscopic[(r - 3, c)] };
                add(
                    row + r,
                    column + 3 + c,
                    stiffness + z * gyroscopic + diagonal(block.mass[r], r == 3 + c),
                );
            }
        }
    }
    for constraint in &blocks.constraints {
        let Some(place) = places[constraint.node] else { continue };
        let row = nodal + constraint.multiplier;
        for (c, &entry) in constraint.entries.iter().enumerate() {
            add(row, place + c, Complex::from(entry));
            add(place + c, row, Complex::from(-entry));
        }
    }
}

/// `value` on the diagonal, 0 elsewhere.
fn diagonal(value: f64, on: bool) -> f64 {
    if on { value } else { 0.0 }
}

/// (1 + ỹ)⁻¹ for y = z ω.
fn turn(omega: &Vector3<f64>, z: Complex<f64>) -> Matrix3<Complex<f64>> {
    let y = omega.map(|omega| z * omega);
    let (zero, one) = (Complex::from(0.0), Complex::from(1.0));
    let skew = Matrix3::new(zero, -y.z, y.y, y.z, zero, -y.x, -y.y, y.x, zero);
    (Matrix3::identity() - skew + y * y.transpose()) / (one + y.dot(&y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turn_is_the_inverse() {
        let (omega, z) = (Vector3::new(3.0, -7.0, 2.0), Complex::new(0.16, 0.18));
        let y = omega.map(|omega| z * omega);
        let zero = Complex::from(0.0);
        let matrix = Matrix3::identity() + Matrix3::new(zero, -y.z, y.y, y.z, zero, -y.x, -y.y, y.x, zero);
        let error = matrix * turn(&omega, z) - Matrix3::identity();
        assert!(error.iter().all(|x| x.norm() < 1e-14));
    }
}
