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

/// An eigenvalue θ with a real vector.
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
/// A residual below this that no longer falls has reached what rounding leaves of it: ε (ω_max/ω)² with the highest
/// frequency of the mesh.
const FLOOR: f64 = 1e-4;
/// θ below this part of the largest is rounding: an infinite frequency.
const INFINITE: f64 = 1e-13;
/// A negative θ below this part of the largest is rounding, too: taken seriously it would be a violent instability.
const NEGATIVE: f64 = 1e-9;
/// Blocks after which the search is given up.
const MOST_BLOCKS: usize = 30;

/// The pairs with the smallest Re (1/θ), `count` of them or all there are, beside those of the `known` vectors, which
/// span an invariant space R.
///
/// Every block is S M times the one before, orthonormalised in M against R and all of them (Gram–Schmidt, twice);
/// vectors that add nothing are dropped, and when none is left the space is invariant and holds all that has inertia.
/// The pairs of VᵀM S M V are tested by their residual. Without R: since S M R ⊂ R, the operator less its part along R
/// has the other eigenvalues, whatever complement is taken; from its vector z the operator's own is z + R c with
/// (θ − θ_R) c = RᵀM S M z, θ_R = 1.
pub fn largest(
    operator: &mut dyn Operator,
    known: &[Vec<f64>],
    count: usize,
) -> Result<Vec<Pair>, StopReason> {
    let size = operator.size();
    let mut space = Space::default();
    for vector in known {
        space.add(operator, vector.clone());
    }
    let rigid = space.vectors.len();
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
    let mut images: Vec<Vec<f64>> = Vec::new();
    let mut worst_before = f64::INFINITY;
    for _ in 0..MOST_BLOCKS {
        let first = images.len();
        for vector in std::mem::take(&mut next) {
            if space.add(operator, vector) {
                let load = &space.loads[rigid + images.len()];
                let mut image = operator.solve(load)?;
                space.remove(rigid, &mut image);
                images.push(image);
            }
        }
        let invariant = images.len() == first;
        let (mut pairs, worst) = project(operator, &space, rigid, &images, wanted)?;
        let at_floor = worst <= FLOOR && worst > 0.5 * worst_before;
        if invariant || (pairs.len() == wanted && (worst <= FOUND || at_floor)) {
            for pair in &mut pairs {
                let load = operator.mass(&pair.vector);
                let image = operator.solve(&load)?;
                for (vector, load) in space.vectors[..rigid].iter().zip(&space.loads) {
                    axpy(dot(load, &image) / (pair.value.re - 1.0), vector, &mut pair.vector);
                }
            }
            return Ok(pairs);
        }
        worst_before = worst;
        next = images[first..].to_vec();
    }
    Err(StopReason::Iterations)
}

/// Vectors v orthonormal in M, and M v.
#[derive(Default)]
struct Space {
    vectors: Vec<Vec<f64>>,
    loads: Vec<Vec<f64>>,
}

impl Space {
    /// Takes from x its part along the first `count` vectors.
    fn remove(&self, count: usize, x: &mut [f64]) {
        for _ in 0..2 {
            for (vector, load) in self.vectors[..count].iter().zip(&self.loads) {
                axpy(-dot(load, x), vector, x);
            }
        }
    }

    /// Adds what a vector has beyond the space; `false` if that is nothing.
    fn add(&mut self, operator: &mut dyn Operator, mut vector: Vec<f64>) -> bool {
        let before = dot(&vector, &operator.mass(&vector)).max(0.0).sqrt();
        self.remove(self.vectors.len(), &mut vector);
        let mut load = operator.mass(&vector);
        let norm = dot(&vector, &load).max(0.0).sqrt();
        if !(norm > NOTHING * before && norm.is_normal()) {
            return false;
        }
        vector.iter_mut().chain(&mut load).for_each(|x| *x /= norm);
        self.vectors.push(vector);
        self.loads.push(load);
        true
    }
}

/// The wanted pairs of the projection on the vectors after the first `rigid`, and their largest relative residual.
fn project(
    operator: &mut dyn Operator,
    space: &Space,
    rigid: usize,
    images: &[Vec<f64>],
    wanted: usize,
) -> Result<(Vec<Pair>, f64), StopReason> {
    let (basis, loads) = (&space.vectors[rigid..], &space.loads[rigid..]);
    let matrix: Vec<Vec<f64>> =
        loads.iter().map(|load| images.iter().map(|image| dot(load, image)).collect()).collect();
    let mut small = eigenpairs(&matrix).map_err(|_| StopReason::Singular)?;
    let largest = small.iter().map(|(value, _)| value.norm()).fold(0.0, f64::max);
    small.retain(|(value, _)| {
        value.norm() > if value.re > 0.0 { INFINITE * largest } else { NEGATIVE * largest }
    });
    // By rising Re ω²; of a complex pair first the one with the positive imaginary part.
    let key = |value: &Complex<f64>| value.inv();
    small.sort_by(|(a, _), (b, _)| {
        let (a, b) = (key(a), key(b));
        a.re.total_cmp(&b.re).then(b.im.total_cmp(&a.im))
    });
    small.truncate(wanted);
    let mut worst = 0.0_f64;
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
        // NaN stays.
        let relative = error / (value.norm() * size);
        worst = if relative > worst || relative.is_nan() { relative } else { worst };
        // A complex pair spans a plane: the real part for the first of the two, the imaginary one for the second.
        pairs.push(Pair { value, vector: if value.im < 0.0 { imaginary } else { real } });
    }
    Ok((pairs, worst))
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
