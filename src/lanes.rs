//! Arithmetic of the kernels: four elements side by side, one in every lane of a vector register, with fused
//! multiply-adds where there are any.
//!
//! A kernel is an `#[inline(always)]` function of a [`Processor`]; `widest!` compiles its call twice, once for AVX2
//! and FMA, and chooses when it runs. The two differ by rounding; one machine always takes the same.

#[cfg(target_arch = "x86_64")]
use std::sync::LazyLock;

use nalgebra::{Matrix3, Vector3};
#[cfg(target_arch = "x86_64")]
use pulp::Simd as _;

/// Evaluates a call of kernels with `$processor` for the widest vectors there are.
macro_rules! widest {
    ($processor:ident => $call:expr) => {{
        #[cfg(target_arch = "x86_64")]
        {
            match crate::lanes::vectors() {
                Some($processor) => {
                    // What can be called once only is inlined whatever its size; a shim around it would not be.
                    let once = crate::lanes::Once;
                    pulp::Simd::vectorize(
                        $processor,
                        #[inline(always)]
                        || {
                            let _once = once;
                            $call
                        },
                    )
                }
                None => {
                    let $processor = crate::lanes::Plain;
                    $call
                }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            let $processor = crate::lanes::Plain;
            $call
        }
    }};
}
pub(crate) use widest;

/// AVX2 and FMA if there are any, and if the environment does not hold `COSSERAT_PLAIN`: then results agree bit for
/// bit between machines with and without, and tools can run the program that do not know all of their instructions.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn vectors() -> Option<pulp::x86::V3> {
    static VECTORS: LazyLock<Option<pulp::x86::V3>> =
        LazyLock::new(|| match std::env::var_os("COSSERAT_PLAIN") {
            None => pulp::x86::V3::try_new(),
            Some(_) => None,
        });
    *VECTORS
}

/// Moved into a closure it makes it one that can be called once only.
#[cfg(target_arch = "x86_64")]
pub(crate) struct Once;

/// What multiplies and adds.
pub trait Processor: Copy {
    /// a b + c by components.
    fn multiply_add4(self, a: [f64; 4], b: [f64; 4], c: [f64; 4]) -> [f64; 4];

    /// a b + c by components.
    fn multiply_add2(self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> [f64; 2];

    /// a b + c.
    #[inline(always)]
    fn multiply_add(self, a: Wide, b: Wide, c: Wide) -> Wide {
        Wide(self.multiply_add4(a.0, b.0, c.0))
    }

    /// a b − c.
    fn multiply_subtract(self, a: Wide, b: Wide, c: Wide) -> Wide;

    /// c − a b.
    fn subtract_product(self, a: Wide, b: Wide, c: Wide) -> Wide;

    /// a + b.
    fn add(self, a: Wide, b: Wide) -> Wide;

    /// a − b.
    fn subtract(self, a: Wide, b: Wide) -> Wide;

    /// a b.
    fn multiply(self, a: Wide, b: Wide) -> Wide;

    /// a/b.
    fn divide(self, a: Wide, b: Wide) -> Wide;

    /// √a.
    fn square_root(self, a: Wide) -> Wide;

    /// s a.
    #[inline(always)]
    fn scale(self, s: f64, a: Wide) -> Wide {
        self.multiply(Wide::splat(s), a)
    }

    /// x + a y.
    #[inline(always)]
    fn add_scaled6(self, x: &mut [f64; 6], a: f64, y: &[f64; 6]) {
        self.add_products6(x, &[a; 6], y);
    }

    /// x + a b by components.
    #[inline(always)]
    fn add_products6(self, x: &mut [f64; 6], a: &[f64; 6], b: &[f64; 6]) {
        let ([a4 @ .., _, _], [b4 @ .., _, _]) = (a, b);
        let ([_, _, _, _, a2 @ ..], [_, _, _, _, b2 @ ..]) = (a, b);
        let [x4 @ .., _, _] = &mut *x;
        *x4 = self.multiply_add4(*a4, *b4, *x4);
        let [_, _, _, _, x2 @ ..] = x;
        *x2 = self.multiply_add2(*a2, *b2, *x2);
    }
}

/// No vectors that are known; fused where the processor always is.
#[derive(Clone, Copy, Debug)]
pub struct Plain;

impl Processor for Plain {
    #[inline(always)]
    fn multiply_add4(self, a: [f64; 4], b: [f64; 4], mut c: [f64; 4]) -> [f64; 4] {
        for k in 0..4 {
            c[k] = multiply_add(a[k], b[k], c[k]);
        }
        c
    }

    #[inline(always)]
    fn multiply_add2(self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> [f64; 2] {
        [multiply_add(a[0], b[0], c[0]), multiply_add(a[1], b[1], c[1])]
    }

    #[inline(always)]
    fn multiply_subtract(self, a: Wide, b: Wide, c: Wide) -> Wide {
        self.multiply_add(a, b, Wide(c.0.map(|c| -c)))
    }

    #[inline(always)]
    fn subtract_product(self, a: Wide, b: Wide, c: Wide) -> Wide {
        self.multiply_add(Wide(a.0.map(|a| -a)), b, c)
    }

    #[inline(always)]
    fn add(self, a: Wide, b: Wide) -> Wide {
        Wide::gather(|lane| a.0[lane] + b.0[lane])
    }

    #[inline(always)]
    fn subtract(self, a: Wide, b: Wide) -> Wide {
        Wide::gather(|lane| a.0[lane] - b.0[lane])
    }

    #[inline(always)]
    fn multiply(self, a: Wide, b: Wide) -> Wide {
        Wide::gather(|lane| a.0[lane] * b.0[lane])
    }

    #[inline(always)]
    fn divide(self, a: Wide, b: Wide) -> Wide {
        Wide::gather(|lane| a.0[lane] / b.0[lane])
    }

    #[inline(always)]
    fn square_root(self, a: Wide) -> Wide {
        Wide(a.0.map(f64::sqrt))
    }
}

/// a b + c; every 64-bit ARM processor fuses.
#[inline(always)]
fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_arch = "aarch64") { a.mul_add(b, c) } else { a * b + c }
}

#[cfg(target_arch = "x86_64")]
impl Processor for pulp::x86::V3 {
    #[inline(always)]
    fn multiply_add4(self, a: [f64; 4], b: [f64; 4], c: [f64; 4]) -> [f64; 4] {
        pulp::cast(self.mul_add_f64x4(pulp::cast(a), pulp::cast(b), pulp::cast(c)))
    }

    #[inline(always)]
    fn multiply_add2(self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> [f64; 2] {
        pulp::cast(self.mul_add_f64x2(pulp::cast(a), pulp::cast(b), pulp::cast(c)))
    }

    #[inline(always)]
    fn multiply_subtract(self, a: Wide, b: Wide, c: Wide) -> Wide {
        Wide(pulp::cast(self.mul_sub_f64x4(pulp::cast(a.0), pulp::cast(b.0), pulp::cast(c.0))))
    }

    #[inline(always)]
    fn subtract_product(self, a: Wide, b: Wide, c: Wide) -> Wide {
        Wide(pulp::cast(self.negate_mul_add_f64x4(pulp::cast(a.0), pulp::cast(b.0), pulp::cast(c.0))))
    }

    #[inline(always)]
    fn add(self, a: Wide, b: Wide) -> Wide {
        Wide(pulp::cast(self.add_f64s(pulp::cast(a.0), pulp::cast(b.0))))
    }

    #[inline(always)]
    fn subtract(self, a: Wide, b: Wide) -> Wide {
        Wide(pulp::cast(self.sub_f64s(pulp::cast(a.0), pulp::cast(b.0))))
    }

    #[inline(always)]
    fn multiply(self, a: Wide, b: Wide) -> Wide {
        Wide(pulp::cast(self.mul_f64s(pulp::cast(a.0), pulp::cast(b.0))))
    }

    #[inline(always)]
    fn divide(self, a: Wide, b: Wide) -> Wide {
        Wide(pulp::cast(self.div_f64s(pulp::cast(a.0), pulp::cast(b.0))))
    }

    #[inline(always)]
    fn square_root(self, a: Wide) -> Wide {
        Wide(pulp::cast(self.sqrt_f64x4(pulp::cast(a.0))))
    }
}

/// Elements that are computed side by side.
pub const LANES: usize = 4;

/// The same number of four elements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Wide(pub [f64; LANES]);

impl Wide {
    /// The same in all lanes.
    #[inline(always)]
    pub const fn splat(x: f64) -> Self {
        Self([x; LANES])
    }

    /// One of every lane.
    #[inline(always)]
    pub fn gather(of: impl Fn(usize) -> f64) -> Self {
        Self([of(0), of(1), of(2), of(3)])
    }
}

/// Three components.
pub type Vector = [Wide; 3];

/// One vector of every lane.
#[inline(always)]
pub fn gather<'a>(of: impl Fn(usize) -> &'a Vector3<f64>) -> Vector {
    let [a, b, c, d] = [of(0), of(1), of(2), of(3)];
    let mut result = Vector::default();
    for k in 0..3 {
        result[k] = Wide([a[k], b[k], c[k], d[k]]);
    }
    result
}

/// The vector of a lane.
#[inline(always)]
pub fn scatter(v: &Vector, lane: usize) -> Vector3<f64> {
    Vector3::new(v[0].0[lane], v[1].0[lane], v[2].0[lane])
}

// Loops, not closures: what is not inlined for certain would not be compiled for the processor's vectors.

/// a v.
#[inline(always)]
pub fn times(processor: impl Processor, a: f64, v: &Vector) -> Vector {
    let mut result = *v;
    for x in &mut result {
        *x = processor.scale(a, *x);
    }
    result
}

/// a b by components.
#[inline(always)]
pub fn product(processor: impl Processor, a: &Vector, b: &Vector) -> Vector {
    let mut result = *a;
    for k in 0..3 {
        result[k] = processor.multiply(a[k], b[k]);
    }
    result
}

/// u + v.
#[inline(always)]
pub fn sum(processor: impl Processor, u: &Vector, v: &Vector) -> Vector {
    let mut result = *u;
    for k in 0..3 {
        result[k] = processor.add(u[k], v[k]);
    }
    result
}

/// u − v.
#[inline(always)]
pub fn difference(processor: impl Processor, u: &Vector, v: &Vector) -> Vector {
    let mut result = *u;
    for k in 0..3 {
        result[k] = processor.subtract(u[k], v[k]);
    }
    result
}

/// u + a v.
#[inline(always)]
pub fn plus_scaled(processor: impl Processor, u: &Vector, a: f64, v: &Vector) -> Vector {
    let mut result = *u;
    for k in 0..3 {
        result[k] = processor.multiply_add(Wide::splat(a), v[k], u[k]);
    }
    result
}

/// a × b.
#[inline(always)]
pub fn cross(processor: impl Processor, a: &Vector, b: &Vector) -> Vector {
    let mut result = *a;
    for (k, i, j) in TURNS {
        result[k] = processor.multiply_subtract(a[i], b[j], processor.multiply(a[j], b[i]));
    }
    result
}

/// |a|.
#[inline(always)]
pub fn norm(processor: impl Processor, a: &Vector) -> Wide {
    let square = processor.multiply_add(a[1], a[1], processor.multiply(a[0], a[0]));
    processor.square_root(processor.multiply_add(a[2], a[2], square))
}

/// Every axis with the two that follow it.
const TURNS: [(usize, usize, usize); 3] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];

/// A 3×3 matrix, column by column.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Matrix(pub [Vector; 3]);

impl Matrix {
    /// One matrix of every lane.
    #[inline(always)]
    pub fn gather<'a>(of: impl Fn(usize) -> &'a Matrix3<f64>) -> Self {
        let [a, b, c, d] = [of(0), of(1), of(2), of(3)].map(|matrix| &matrix.data.0);
        let mut result = Self::default();
        for column in 0..3 {
            for row in 0..3 {
                result.0[column][row] =
                    Wide([a[column][row], b[column][row], c[column][row], d[column][row]]);
            }
        }
        result
    }

    /// The matrix of a lane.
    pub fn scatter(&self, lane: usize) -> Matrix3<f64> {
        Matrix3::from_fn(|row, column| self.0[column][row].0[lane])
    }

    /// ã.
    #[inline(always)]
    pub fn skew(processor: impl Processor, a: &Vector) -> Self {
        let zero = Wide::splat(0.0);
        let mut minus = *a;
        for x in &mut minus {
            *x = processor.subtract(zero, *x);
        }
        Self([[zero, a[2], minus[1]], [minus[2], zero, a[0]], [a[1], minus[0], zero]])
    }

    /// Mᵀ.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        let [a, b, c] = &self.0;
        Self([[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]])
    }

    /// s M.
    #[inline(always)]
    pub fn scaled(&self, processor: impl Processor, s: f64) -> Self {
        let mut result = *self;
        for column in &mut result.0 {
            *column = times(processor, s, column);
        }
        result
    }

    /// M diag(d).
    #[inline(always)]
    pub fn times_diagonal(&self, processor: impl Processor, d: &Vector) -> Self {
        let mut result = *self;
        for c in 0..3 {
            result.0[c] = product(processor, &self.0[c], &[d[c]; 3]);
        }
        result
    }

    /// diag(d) M.
    #[inline(always)]
    pub fn diagonal_times(&self, processor: impl Processor, d: &Vector) -> Self {
        let mut result = *self;
        for column in &mut result.0 {
            *column = product(processor, d, column);
        }
        result
    }

    /// M + s N.
    #[inline(always)]
    pub fn plus_scaled(&self, processor: impl Processor, s: f64, other: &Self) -> Self {
        let mut result = *self;
        for c in 0..3 {
            result.0[c] = plus_scaled(processor, &self.0[c], s, &other.0[c]);
        }
        result
    }

    /// M v.
    #[inline(always)]
    pub fn times_vector(&self, processor: impl Processor, v: &Vector) -> Vector {
        let [a, b, c] = &self.0;
        let mut result = *v;
        for k in 0..3 {
            let first = processor.multiply_add(v[1], b[k], processor.multiply(v[0], a[k]));
            result[k] = processor.multiply_add(v[2], c[k], first);
        }
        result
    }

    /// Mᵀ v.
    #[inline(always)]
    pub fn transpose_times_vector(&self, processor: impl Processor, v: &Vector) -> Vector {
        self.transpose().times_vector(processor, v)
    }

    /// M N.
    #[inline(always)]
    pub fn times(&self, processor: impl Processor, other: &Self) -> Self {
        let mut result = *other;
        for column in &mut result.0 {
            *column = self.times_vector(processor, column);
        }
        result
    }

    /// M ã.
    #[inline(always)]
    pub fn times_skew(&self, processor: impl Processor, a: &Vector) -> Self {
        let mut result = *self;
        for (column, i, j) in TURNS {
            for k in 0..3 {
                let second = processor.multiply(a[i], self.0[j][k]);
                result.0[column][k] = processor.multiply_subtract(a[j], self.0[i][k], second);
            }
        }
        result
    }

    /// L + M N.
    #[inline(always)]
    pub fn plus_product(&self, processor: impl Processor, m: &Self, n: &Self) -> Self {
        let mut result = *self;
        for (sum, v) in result.0.iter_mut().zip(&n.0) {
            for (x, m) in v.iter().zip(&m.0) {
                for k in 0..3 {
                    sum[k] = processor.multiply_add(*x, m[k], sum[k]);
                }
            }
        }
        result
    }

    /// j⁻¹(Skw(M)).
    #[inline(always)]
    pub fn axial(&self, processor: impl Processor) -> Vector {
        let mut result = Vector::default();
        for (k, i, j) in TURNS {
            result[k] = processor.scale(0.5, processor.subtract(self.0[i][j], self.0[j][i]));
        }
        result
    }

    /// ½ ((tr M) 1 − M).
    #[inline(always)]
    pub fn half_trace_minus(&self, processor: impl Processor) -> Self {
        let mut result = self.scaled(processor, -0.5);
        for (k, i, j) in TURNS {
            result.0[k][k] = processor.scale(0.5, processor.add(self.0[i][i], self.0[j][j]));
        }
        result
    }
}
