//! The largest eigenpairs of S M, M symmetric and perhaps singular, from a block Krylov space.

use nalgebra::Complex;

use crate::linear_solver::eigenpairs;
use crate::solution::StopReason;

/// x ↦ S (M x).
pub trait Operator {
    /// Length of a vector.
    fn size(&self) -> usize;

    /// M x.
    fn mass(&mut self, x: &[f64]) -> Vec<f64>;

    /// S f for f = M x.
    fn solve(&mut self, mass_times_x: &[f64]) -> Result<Vec<f64>, StopReason>;
}

/// An eigenvalue θ with the real part of its vector, M-normalised.
#[derive(Clone, Debug)]
pub struct Pair {
    /// θ.
    pub value: Complex<f64>,
    /// x.
    pub vector: Vec<f64>,
}

impl Pair {
    /// b² ω² = 1/θ − 1.
    pub fn stiffness(&self) -> Complex<f64> {
        self.value.inv() - 1.0
    }
}

/// More vectors in a block than pairs are wanted: what hides behind the last one decides how fast it is found.
const GUARD: usize = 6;
/// A vector that is a sum of the basis up to this part of itself adds nothing.
const NOTHING: f64 = 1e-10;
/// ‖S M x − θ x‖ ≤ this |θ| ‖x‖, in M: the pair is found, θ to about the square of it.
const FOUND: f64 = 1e-9;
/// θ below this part of the largest is rounding: an infinite frequency.
const INFINITE: f64 = 1e-13;
/// Blocks after which the search is given up.
const MOST_BLOCKS: usize = 30;

/// The pairs with the smallest Re (1/θ), `count` of them or all there are.
///
/// Every block is S M times the one before, orthonormalised in M against all of them (Gram–Schmidt, twice); vectors
/// that add nothing are dropped, and when none is left the space is invariant and holds all that has inertia. The pairs
/// of VᵀM S M V are tested by their residual.
pub fn largest(operator: &mut dyn Operator, count: usize) -> Result<Vec<Pair>, StopReason> {
    let size = operator.size();
    let mut numbers = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = || {
        numbers = numbers.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (numbers >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let wanted = count.min(size);
    let mut next = Vec::new();
    for _ in 0..(wanted + GUARD).min(size) {
        let start: Vec<f64> = (0..size).map(|_| random()).collect();
        let load = operator.mass(&start);
        next.push(operator.solve(&load)?);
    }
    // V, M V and S M V.
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let (mut loads, mut images) = (basis.clone(), basis.clone());
    for _ in 0..MOST_BLOCKS {
        let first = basis.len();
        for mut vector in std::mem::take(&mut next) {
            let mut load = operator.mass(&vector);
            let before = dot(&vector, &load).max(0.0).sqrt();
            for _ in 0..2 {
                for (other, other_load) in basis.iter().zip(&loads) {
                    let share = dot(other_load, &vector);
                    axpy(-share, other, &mut vector);
                }
            }
            load.clone_from(&operator.mass(&vector));
            let norm = dot(&vector, &load).max(0.0).sqrt();
            if norm > NOTHING * before && norm.is_normal() {
                vector.iter_mut().for_each(|x| *x /= norm);
                load.iter_mut().for_each(|x| *x /= norm);
                images.push(operator.solve(&load)?);
                basis.push(vector);
                loads.push(load);
            }
        }
        let invariant = basis.len() == first;
        let (pairs, all_found) = project(operator, &basis, &loads, &images, wanted)?;
        if invariant || (pairs.len() == wanted && all_found) {
            return Ok(pairs);
        }
        next = images[first..].to_vec();
    }
    Err(StopReason::Iterations)
}

/// The wanted pairs of the projection, and whether all have been found.
fn project(
    operator: &mut dyn Operator,
    basis: &[Vec<f64>],
    loads: &[Vec<f64>],
    images: &[Vec<f64>],
    wanted: usize,
) -> Result<(Vec<Pair>, bool), StopReason> {
    let matrix: Vec<Vec<f64>> =
        loads.iter().map(|load| images.iter().map(|image| dot(load, image)).collect()).collect();
    let mut small = eigenpairs(&matrix).map_err(|_| StopReason::Singular)?;
    let largest = small.iter().map(|(value, _)| value.norm()).fold(0.0, f64::max);
    small.retain(|(value, _)| value.norm() > INFINITE * largest);
    // By rising Re ω²; of a complex pair first the one with the positive imaginary part.
    let key = |value: &Complex<f64>| value.inv();
    small.sort_by(|(a, _), (b, _)| {
        let (a, b) = (key(a), key(b));
        a.re.total_cmp(&b.re).then(b.im.total_cmp(&a.im))
    });
    small.truncate(wanted);
    let mut all_found = true;
    let mut pairs = Vec::with_capacity(small.len());
    for (value, coefficients) in small {
        // The phase that makes the largest coefficient real.
        let largest = coefficients
            .iter()
            .fold(Complex::new(0.0, 0.0), |largest, c| if c.norm() > largest.norm() { *c } else { largest });
        let phase = largest.conj() / largest.norm();
        let sum = |of: &[Vec<f64>], part: fn(Complex<f64>) -> f64| {
            let mut sum = vec![0.0; operator.size()];
            for (vector, c) in of.iter().zip(&coefficients) {
                axpy(part(c * phase), vector, &mut sum);
            }
            sum
        };
        let (real, imaginary) = (sum(basis, |c| c.re), sum(basis, |c| c.im));
        let (image, image_imaginary) = (sum(images, |c| c.re), sum(images, |c| c.im));
        let mut residual = image;
        axpy(-value.re, &real, &mut residual);
        axpy(value.im, &imaginary, &mut residual);
        let mut residual_imaginary = image_imaginary;
        axpy(-value.re, &imaginary, &mut residual_imaginary);
        axpy(-value.im, &real, &mut residual_imaginary);
        let mut norm = |x: &[f64]| {
            let load = operator.mass(x);
            dot(x, &load).max(0.0)
        };
        let error = (norm(&residual) + norm(&residual_imaginary)).sqrt();
        let size = (norm(&real) + norm(&imaginary)).sqrt();
        all_found &= error <= FOUND * value.norm() * size;
        pairs.push(Pair { value, vector: real });
    }
    Ok((pairs, all_found))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// y ← y + c x.
fn axpy(c: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += c * x;
    }
}
