//! Linear systems: condensation and frontal elimination for chains, dense LU for what couples a few of them, sparse LU for the rest.

mod chain;
mod condensed;
mod coupled;
mod dense;
mod eigen;
mod interiors;
mod layout;
mod segments;
mod sparse;
mod wide;

pub use chain::Chain;
pub use condensed::Condensed;
pub use coupled::Coupled;
pub use dense::Dense;
pub use eigen::{Eigenpair, eigenpairs};
pub use sparse::Sparse;

use thiserror::Error;

/// Unknowns of a node.
pub const NODE: usize = 6;

/// A pivot is zero or a number is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the matrix is singular or a number overflowed")]
pub struct Singular;

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix6;

    use super::*;
    use crate::element::{ElementTangent, set_tangent_of_lane, zero_tangents};
    use crate::lanes::{LANES, Plain};

    /// Reproducible numbers in (−1, 1).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// A random chain, coupled over its kept nodes by random blocks, against one sparse system of everything.
    fn agree<const N: usize>(elements: usize, kept: &[usize]) {
        let degree = N - 1;
        let size = NODE * (elements * degree + 1);
        let mut numbers = Numbers(N as u64);
        let mut chain = Chain::new(elements, degree, kept, 1.0);
        let kept = chain.kept().to_vec();
        let mut coupled = Coupled::new(NODE * kept.len());
        let mut sparse = Sparse::<f64>::new(size);
        for _ in 0..2 {
            sparse.clear();
            coupled.clear();
            let x: Vec<f64> = (0..size).map(|_| numbers.next()).collect();
            let mut b = vec![0.0; size];
            let mut add = |row: usize, column: usize, block: &Matrix6<f64>| {
                for r in 0..NODE {
                    for c in 0..NODE {
                        let (row, column) = (row * NODE + r, column * NODE + c);
                        sparse.add(row, column, block[(r, c)]);
                        b[row] += block[(r, c)] * x[column];
                    }
                }
            };
            for step in 0..elements {
                let mut tangent: ElementTangent<N> =
                    std::array::from_fn(|_| std::array::from_fn(|_| Matrix6::from_fn(|_, _| numbers.next())));
                if step % 2 == 0 {
                    // Pivots of zero on the diagonal.
                    let node = if kept == [0] { N - 1 } else { 0 };
                    tangent[node][node] = Matrix6::from_fn(|r, c| if r + c == 5 { 1.0 } else { 0.0 });
                }
                let e = chain.element(step);
                chain.add_element(Plain, step, &tangent).expect("regular");
                for (i, row) in tangent.iter().enumerate() {
                    for (j, block) in row.iter().enumerate() {
                        add(e * degree + i, e * degree + j, block);
                    }
                }
            }
            chain.factorize().expect("regular");
            let place = |node: usize| NODE * kept.iter().position(|&other| other == node).expect("kept");
            for (row, column, block) in chain.remainder() {
                coupled.add_block(place(*row), place(*column), block);
            }
            for &row in &kept {
                for &column in &kept {
                    let block = Matrix6::from_fn(|_, _| numbers.next());
                    coupled.add_block(place(row), place(column), &block);
                    add(row, column, &block);
                }
            }
            coupled.factorize().expect("regular");
            sparse.factorize().expect("regular");
            let mut by_chain = b.clone();
            chain.forward(&mut by_chain);
            let mut rest: Vec<f64> =
                kept.iter().flat_map(|&n| by_chain[NODE * n..][..NODE].to_vec()).collect();
            coupled.solve(&mut rest).expect("regular");
            for (&node, part) in kept.iter().zip(rest.chunks_exact(NODE)) {
                by_chain[NODE * node..][..NODE].copy_from_slice(part);
            }
            chain.backward(&mut by_chain);
            sparse.solve(&mut b).expect("regular");
            for i in 0..size {
                assert!((by_chain[i] - x[i]).abs() < 1e-8, "N = {N}: {} {}", by_chain[i], x[i]);
                assert!((b[i] - x[i]).abs() < 1e-8);
            }
        }
    }

    /// Random elements that are as stiff as to need no pivoting, or not; a rod's factors against one sparse system.
    fn condensed_agrees<const N: usize>(elements: usize, kept: &[usize], singular: Option<usize>) {
        let degree = N - 1;
        let size = NODE * (elements * degree + 1);
        let mut numbers = Numbers(N as u64);
        let mut rod = Condensed::new(elements, degree, kept, 1.0);
        let kept = rod.kept().to_vec();
        for _ in 0..2 {
            let mut sparse = Sparse::<f64>::new(size);
            let x: Vec<f64> = (0..size).map(|_| numbers.next()).collect();
            let mut b = vec![0.0; size];
            let mut add = |sparse: &mut Sparse<f64>, row: usize, column: usize, block: &Matrix6<f64>| {
                for r in 0..NODE {
                    for c in 0..NODE {
                        let (row, column) = (row * NODE + r, column * NODE + c);
                        sparse.add(row, column, block[(r, c)]);
                        b[row] += block[(r, c)] * x[column];
                    }
                }
            };
            let mut block = |i: usize, j: usize| {
                let diagonal = if i == j { 4.0 } else { 0.0 };
                Matrix6::from_fn(|r, c| numbers.next() + if r == c { diagonal } else { 0.0 })
            };
            let tangents: Vec<ElementTangent<N>> = (0..elements)
                .map(|e| {
                    let mut tangent: ElementTangent<N> =
                        std::array::from_fn(|i| std::array::from_fn(|j| block(i, j)));
                    if singular == Some(e) {
                        // A pivot of zero inside, or at the first node.
                        tangent[N / 2][N / 2] = Matrix6::from_fn(|r, c| if r + c == 5 { 1.0 } else { 0.0 });
                    }
                    tangent
                })
                .collect();
            rod.begin();
            let mut group = 0;
            while group * LANES < elements {
                let mut side_by_side = zero_tangents::<N>();
                for (lane, e) in rod.group(group).into_iter().enumerate() {
                    set_tangent_of_lane(&mut side_by_side, lane, &tangents[e]);
                }
                group =
                    if rod.add(Plain, group, &mut side_by_side).expect("regular") { group + 1 } else { 0 };
            }
            rod.factorize().expect("regular");
            for (e, tangent) in tangents.iter().enumerate() {
                for (i, row) in tangent.iter().enumerate() {
                    for (j, block) in row.iter().enumerate() {
                        add(&mut sparse, e * degree + i, e * degree + j, block);
                    }
                }
            }
            let place = |node: usize| NODE * kept.iter().position(|&other| other == node).expect("kept");
            let mut coupled = Coupled::new(NODE * kept.len());
            for (row, column, block) in rod.remainder() {
                coupled.add_block(place(*row), place(*column), block);
            }
            coupled.factorize().expect("regular");
            sparse.factorize().expect("regular");
            let mut by_rod = b.clone();
            rod.forward(&mut by_rod);
            let mut rest: Vec<f64> = kept.iter().flat_map(|&n| by_rod[NODE * n..][..NODE].to_vec()).collect();
            coupled.solve(&mut rest).expect("regular");
            for (&node, part) in kept.iter().zip(rest.chunks_exact(NODE)) {
                by_rod[NODE * node..][..NODE].copy_from_slice(part);
            }
            rod.backward(&mut by_rod);
            for i in 0..size {
                assert!((by_rod[i] - x[i]).abs() < 1e-7, "{N} {elements} {kept:?}: {} {}", by_rod[i], x[i]);
            }
        }
    }

    #[test]
    fn condensed_and_sparse_solve_the_same_system() {
        for elements in 1..=11 {
            let last = 2 * elements;
            for kept in [&[][..], &[0], &[last], &[0, last], &[2 * (elements / 2)], &[1]] {
                condensed_agrees::<3>(elements, kept, None);
            }
            for kept in [&[][..], &[0], &[elements], &[elements / 2]] {
                condensed_agrees::<2>(elements, kept, None);
            }
            condensed_agrees::<5>(elements, &[], None);
        }
        condensed_agrees::<9>(6, &[0], None);
        condensed_agrees::<7>(5, &[30], None);
    }

    #[test]
    fn what_needs_pivoting_is_eliminated_in_full() {
        for singular in 0..6 {
            for kept in [&[][..], &[0], &[12], &[4]] {
                condensed_agrees::<3>(6, kept, Some(singular));
            }
            condensed_agrees::<2>(6, &[], Some(singular));
            condensed_agrees::<6>(6, &[], Some(singular));
        }
    }

    #[test]
    fn chain_and_sparse_solve_the_same_system() {
        agree::<2>(7, &[]);
        agree::<3>(5, &[]);
        agree::<5>(3, &[]);
        agree::<9>(2, &[]);
    }

    #[test]
    fn chains_keep_nodes() {
        for kept in [&[0][..], &[7], &[3], &[0, 7], &[0, 3, 4, 7], &[2, 5]] {
            agree::<2>(7, kept);
        }
        for kept in [&[0][..], &[10], &[4], &[5], &[0, 10], &[0, 3, 10], &[1, 2, 3, 8], &[10, 9]] {
            agree::<3>(5, kept);
        }
        for kept in [&[0][..], &[16], &[0, 16], &[3, 8]] {
            agree::<9>(2, kept);
        }
        assert_eq!(Chain::new(5, 2, &[3], 1.0).kept(), &[2, 3, 4]);
    }

    #[test]
    fn many_unknowns_are_coupled_by_a_sparse_system() {
        let kept: Vec<usize> = (0..=30).collect();
        agree::<2>(30, &kept);
    }

    #[test]
    fn singular_matrices_are_an_error() {
        let mut chain = Chain::new(2, 1, &[], 1.0);
        assert_eq!(chain.add_element(Plain, 0, &[[Matrix6::<f64>::zeros(); 2]; 2]), Err(Singular));
        let identity = [[Matrix6::identity(), Matrix6::zeros()], [Matrix6::zeros(), Matrix6::zeros()]];
        assert_eq!(chain.add_element(Plain, 0, &identity).and_then(|()| chain.factorize()), Err(Singular));
        let overflow = [[Matrix6::from_element(f64::INFINITY); 2]; 2];
        assert_eq!(chain.add_element(Plain, 0, &overflow), Err(Singular));
        let mut sparse = Sparse::new(1);
        sparse.add(0, 0, f64::NAN);
        assert_eq!(sparse.factorize(), Err(Singular));
        let mut dense = Dense::new(2);
        dense.add(0, 0, 1.0);
        assert_eq!(dense.factorize(), Err(Singular));
        dense.add(1, 0, f64::INFINITY);
        assert_eq!(dense.factorize(), Err(Singular));
    }
}
