//! The system that couples chains: their kept nodes, bodies, and the multipliers of joints.

use nalgebra::Matrix6;

use super::{Dense, NODE, Singular, Sparse};

/// Up to this size the dense factorisation is the faster one.
const DENSE: usize = 120;

/// A square system that is built, factorised and solved again and again with the same pattern.
pub enum Coupled {
    /// For few unknowns.
    Dense(Dense),
    /// For many.
    Sparse(Box<Sparse>),
}

impl Coupled {
    /// An n × n system.
    pub fn new(size: usize) -> Self {
        if size <= DENSE { Self::Dense(Dense::new(size)) } else { Self::Sparse(Box::new(Sparse::new(size))) }
    }

    /// Forgets the values.
    pub fn clear(&mut self) {
        match self {
            Self::Dense(system) => system.clear(),
            Self::Sparse(system) => system.clear(),
        }
    }

    /// Adds to an entry; the same entries in the same order after every [`Self::clear`].
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        match self {
            Self::Dense(system) => system.add(row, column, value),
            Self::Sparse(system) => system.add(row, column, value),
        }
    }

    /// Adds a block of two nodes from a row and a column on.
    pub fn add_block(&mut self, row: usize, column: usize, block: &Matrix6<f64>) {
        for i in 0..NODE {
            for j in 0..NODE {
                self.add(row + i, column + j, block[(i, j)]);
            }
        }
    }

    /// Factorises what was added.
    pub fn factorize(&mut self) -> Result<(), Singular> {
        match self {
            Self::Dense(system) => system.factorize(),
            Self::Sparse(system) => system.factorize(),
        }
    }

    /// b ← A⁻¹ b.
    pub fn solve(&self, b: &mut [f64]) -> Result<(), Singular> {
        match self {
            Self::Dense(system) => {
                system.solve(b);
                if b.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Singular) }
            }
            Self::Sparse(system) => system.solve(b),
        }
    }
}
