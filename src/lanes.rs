//! Arithmetic of the kernels: small matrices in vector registers, with fused multiply-adds where there are any.
//!
//! A kernel is an `#[inline(always)]` function of a [`Processor`]; `widest!` compiles its call twice, once for AVX2
//! and FMA, and chooses when it runs. The two differ by rounding; one machine always takes the same.

#[cfg(target_arch = "x86_64")]
use std::sync::LazyLock;

use nalgebra::{Matrix3, Vector3};

/// Evaluates a call of kernels with `$processor` for the widest vectors there are.
macro_rules! widest {
    ($processor:ident => $call:expr) => {{
        #[cfg(target_arch = "x86_64")]
        {
            match crate::lanes::vectors() {
                Some($processor) => pulp::Simd::vectorize(
                    $processor,
                    #[inline(always)]
                    || $call,
                ),
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

/// What multiplies and adds.
pub trait Processor: Copy {
    /// a b + c by components.
    fn multiply_add4(self, a: [f64; 4], b: [f64; 4], c: [f64; 4]) -> [f64; 4];

    /// a b + c by components.
    fn multiply_add2(self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> [f64; 2];

    /// x + a y.
    #[inline(always)]
    fn add_scaled4(self, x: &mut [f64; 4], a: f64, y: &[f64; 4]) {
        *x = self.multiply_add4([a; 4], *y, *x);
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
}

/// Three components in four lanes, the last of which is not used.
pub type Lanes = [f64; 4];

/// a x.
#[inline(always)]
pub fn times<const W: usize>(a: f64, x: &[f64; W]) -> [f64; W] {
    let mut result = *x;
    for k in 0..W {
        result[k] *= a;
    }
    result
}

/// a b by components.
#[inline(always)]
pub fn product<const W: usize>(a: &[f64; W], b: &[f64; W]) -> [f64; W] {
    let mut result = *a;
    for k in 0..W {
        result[k] *= b[k];
    }
    result
}

/// A vector in lanes.
#[inline(always)]
pub fn lanes(v: &Vector3<f64>) -> Lanes {
    [v.x, v.y, v.z, v.z]
}

/// The vector of lanes.
#[inline(always)]
pub fn vector(v: &Lanes) -> Vector3<f64> {
    Vector3::new(v[0], v[1], v[2])
}

/// a × b.
#[inline(always)]
pub fn cross(a: &Lanes, b: &Lanes) -> Lanes {
    let x = a[1] * b[2] - a[2] * b[1];
    let y = a[2] * b[0] - a[0] * b[2];
    let z = a[0] * b[1] - a[1] * b[0];
    [x, y, z, z]
}

/// A 3×3 matrix as three columns in lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Columns(pub [Lanes; 3]);

impl From<&Matrix3<f64>> for Columns {
    #[inline(always)]
    fn from(m: &Matrix3<f64>) -> Self {
        Self([[m.m11, m.m21, m.m31, m.m31], [m.m12, m.m22, m.m32, m.m32], [m.m13, m.m23, m.m33, m.m33]])
    }
}

impl From<Columns> for Matrix3<f64> {
    #[inline(always)]
    fn from(m: Columns) -> Self {
        Self::from_fn(|row, column| m.0[column][row])
    }
}

impl Columns {
    /// ã.
    #[inline(always)]
    pub fn skew(a: &Lanes) -> Self {
        Self([[0.0, a[2], -a[1], 0.0], [-a[2], 0.0, a[0], 0.0], [a[1], -a[0], 0.0, 0.0]])
    }

    /// Mᵀ.
    #[inline(always)]
    pub fn transpose(&self) -> Self {
        let [a, b, c] = &self.0;
        Self([[a[0], b[0], c[0], c[0]], [a[1], b[1], c[1], c[1]], [a[2], b[2], c[2], c[2]]])
    }

    /// s M.
    #[inline(always)]
    pub fn scaled(&self, s: f64) -> Self {
        let mut result = *self;
        for column in &mut result.0 {
            for x in column {
                *x *= s;
            }
        }
        result
    }

    /// M diag(d).
    #[inline(always)]
    pub fn times_diagonal(&self, d: &Vector3<f64>) -> Self {
        let mut result = *self;
        for (column, d) in result.0.iter_mut().zip([d.x, d.y, d.z]) {
            for x in column {
                *x *= d;
            }
        }
        result
    }

    /// Mᵀ v.
    #[inline(always)]
    pub fn transpose_times(&self, processor: impl Processor, v: &Lanes) -> Lanes {
        self.transpose().times_vector(processor, v)
    }

    /// diag(d) M.
    #[inline(always)]
    pub fn diagonal_times(&self, d: &Lanes) -> Self {
        let mut result = *self;
        for column in &mut result.0 {
            for (x, d) in column.iter_mut().zip(d) {
                *x *= d;
            }
        }
        result
    }

    /// M + s N.
    #[inline(always)]
    pub fn plus_scaled(mut self, processor: impl Processor, s: f64, other: &Self) -> Self {
        for (column, other) in self.0.iter_mut().zip(&other.0) {
            processor.add_scaled4(column, s, other);
        }
        self
    }

    /// M v.
    #[inline(always)]
    pub fn times_vector(&self, processor: impl Processor, v: &Lanes) -> Lanes {
        let mut sum = times(v[0], &self.0[0]);
        processor.add_scaled4(&mut sum, v[1], &self.0[1]);
        processor.add_scaled4(&mut sum, v[2], &self.0[2]);
        sum
    }

    /// M N.
    #[inline(always)]
    pub fn times(&self, processor: impl Processor, other: &Self) -> Self {
        let [a, b, c] = &other.0;
        Self([
            self.times_vector(processor, a),
            self.times_vector(processor, b),
            self.times_vector(processor, c),
        ])
    }

    /// M ã.
    #[inline(always)]
    pub fn times_skew(&self, processor: impl Processor, a: &Lanes) -> Self {
        let [m, n, o] = &self.0;
        let mut result = Self([times(a[2], n), times(a[0], o), times(a[1], m)]);
        processor.add_scaled4(&mut result.0[0], -a[1], o);
        processor.add_scaled4(&mut result.0[1], -a[2], m);
        processor.add_scaled4(&mut result.0[2], -a[0], n);
        result
    }

    /// L + M N.
    #[inline(always)]
    pub fn plus_product(mut self, processor: impl Processor, m: &Self, n: &Self) -> Self {
        for (sum, column) in self.0.iter_mut().zip(&n.0) {
            for k in 0..3 {
                processor.add_scaled4(sum, column[k], &m.0[k]);
            }
        }
        self
    }

    /// j⁻¹(Skw(M)).
    #[inline(always)]
    pub fn axial(&self) -> Lanes {
        let [a, b, c] = &self.0;
        let z = 0.5 * (a[1] - b[0]);
        [0.5 * (b[2] - c[1]), 0.5 * (c[0] - a[2]), z, z]
    }

    /// ½ ((tr M) 1 − M).
    #[inline(always)]
    pub fn half_trace_minus(&self) -> Self {
        let [a, b, c] = &self.0;
        let half = self.scaled(-0.5).0;
        Self([
            [0.5 * (b[1] + c[2]), half[0][1], half[0][2], 0.0],
            [half[1][0], 0.5 * (a[0] + c[2]), half[1][2], 0.0],
            [half[2][0], half[2][1], 0.5 * (a[0] + b[1]), 0.0],
        ])
    }
}
