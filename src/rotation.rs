//! Rotations and rigid motions: the quaternion map (5) with its rate (10), exponential and logarithm of
//! SO(3) and SE(3), their right Jacobians, and the projection of a 3×3 matrix to the nearest rotation.
//!
//! Conventions: δA = A δφ̃ (δφ in the body basis); twists are (translation, rotation) in the body basis;
//! the right Jacobian J_r maps δψ to the body variation, exp(ψ + δψ) = exp(ψ) exp(J_r(ψ) δψ).

use std::f64::consts::PI;

use nalgebra::{Matrix3, Matrix3x4, Matrix4x3, Vector3, Vector4};

/// ã with ã b = a × b.
#[inline]
pub fn skew(a: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}

/// v/‖v‖ for any finite v ≠ 0: divided by its largest component first, no square over- or underflows.
pub fn direction(v: &Vector3<f64>) -> Vector3<f64> {
    (v / v.amax()).normalize()
}

/// j⁻¹(Skw(M)) = ½ (M₃₂ − M₂₃, M₁₃ − M₃₁, M₂₁ − M₁₂).
#[inline]
pub fn axial(m: &Matrix3<f64>) -> Vector3<f64> {
    0.5 * Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

/// P, divided by a power of two near its norm where squares could over- or underflow.
///
/// A power of two changes no digit, so A(P) and A(2ᵏ P) agree bit for bit.
#[inline]
fn scaled(p: &Vector4<f64>) -> Vector4<f64> {
    let size = p.amax();
    if (1e-100..1e100).contains(&size) {
        return *p;
    }
    let exponent = size.log2().floor();
    // 2^±1074 is not representable in one factor: take the power in two halves.
    let half = (-0.5 * exponent).floor();
    p * half.exp2() * (-exponent - half).exp2()
}

/// A(P) = 1 + 2 (p̃² + p₀ p̃) / ‖P‖², eq. (5), for any non-zero finite P = (p₀, p).
#[inline]
pub fn rotation_matrix(quaternion: &Vector4<f64>) -> Matrix3<f64> {
    let q = scaled(quaternion);
    let s = 2.0 / q.norm_squared();
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    Matrix3::new(
        1.0 - s * (y * y + z * z),
        s * (x * y - w * z),
        s * (x * z + w * y),
        s * (x * y + w * z),
        1.0 - s * (x * x + z * z),
        s * (y * z - w * x),
        s * (x * z - w * y),
        s * (y * z + w * x),
        1.0 - s * (x * x + y * y),
    )
}

/// Q(P) = ½ (−pᵀ; p₀ 1 + p̃), eq. (10): Ṗ = Q(P) ω, ω in the body basis.
#[inline]
pub fn quaternion_rate(p: &Vector4<f64>) -> Matrix4x3<f64> {
    let (w, x, y, z) = (0.5 * p[0], 0.5 * p[1], 0.5 * p[2], 0.5 * p[3]);
    Matrix4x3::new(-x, -y, -z, w, -z, y, z, w, -x, -y, x, w)
}

/// T(P) = 4 Q(P)ᵀ / ‖P‖²: δφ = T(P) δP, the derivative of (5) in the body basis.
///
/// T Q = 1 because QᵀQ = ¼ ‖P‖² 1; T P = 0 because the norm turns nothing.
#[inline]
pub fn rotation_from_quaternion_rate(p: &Vector4<f64>) -> Matrix3x4<f64> {
    quaternion_rate(p).transpose() * (4.0 / p.norm_squared())
}

/// Quaternion product a ∘ b, with A(a ∘ b) = A(a) A(b).
#[inline]
pub fn quaternion_product(a: &Vector4<f64>, b: &Vector4<f64>) -> Vector4<f64> {
    Vector4::new(
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )
}

/// The unit quaternion of exp(φ̃): (cos ½φ, ½ φ sinc ½φ).
#[inline]
pub fn quaternion_exp(phi: &Vector3<f64>) -> Vector4<f64> {
    let square = 0.25 * phi.norm_squared();
    let (cosine, sinc) = if square < SMALL_SQUARE {
        const COSINE: [f64; 9] = inverse_factorials(0);
        const SINC: [f64; 9] = inverse_factorials(1);
        (polynomial(&COSINE, square), polynomial(&SINC, square))
    } else {
        let half = square.sqrt();
        (half.cos(), sinc(half))
    };
    let s = 0.5 * sinc;
    Vector4::new(cosine, s * phi.x, s * phi.y, s * phi.z)
}

/// Below it what the series leave out, x⁹/18! and x⁹/19! of the square x, is less than ε/100.
const SMALL_SQUARE: f64 = 0.8;

/// P / ‖P‖ for any non-zero finite P.
#[inline]
pub fn normalized(quaternion: &Vector4<f64>) -> Vector4<f64> {
    scaled(quaternion).normalize()
}

/// A unit quaternion of a rotation matrix, by the largest of its four components (Spurrier 1978).
pub fn quaternion_of(a: &Matrix3<f64>) -> Vector4<f64> {
    let trace = a.trace();
    let quaternion = if trace >= a.m11.max(a.m22).max(a.m33) {
        Vector4::new(1.0 + trace, a.m32 - a.m23, a.m13 - a.m31, a.m21 - a.m12)
    } else if a.m11 >= a.m22 && a.m11 >= a.m33 {
        Vector4::new(a.m32 - a.m23, 1.0 + 2.0 * a.m11 - trace, a.m12 + a.m21, a.m13 + a.m31)
    } else if a.m22 >= a.m33 {
        Vector4::new(a.m13 - a.m31, a.m12 + a.m21, 1.0 + 2.0 * a.m22 - trace, a.m23 + a.m32)
    } else {
        Vector4::new(a.m21 - a.m12, a.m13 + a.m31, a.m23 + a.m32, 1.0 + 2.0 * a.m33 - trace)
    };
    quaternion.normalize()
}

/// The rotation nearest to M in the Frobenius norm, R of the polar decomposition M = R U; `None` if det M is
/// not positive (then no nearest rotation is a continuous choice).
///
/// Newton's iteration R ← ½ (s R + R⁻ᵀ/s) with s² = ‖R⁻¹‖/‖R‖ (Higham 1986): s keeps the singular values σ and
/// 1/σ in balance and tends to 1, so that no stretch takes more than some six steps. Once a step changes R by δ it is
/// off by δ²/2.
pub fn polar_rotation(m: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let mut r = m / m.amax();
    let determinant = r.determinant();
    if determinant.is_nan() || determinant <= 1e-12 * r.norm().powi(3) {
        return None;
    }
    for _ in 0..12 {
        let inverse = r.try_inverse()?.transpose();
        let scale = (inverse.norm() / r.norm()).sqrt();
        let next = 0.5 * (scale * r + inverse / scale);
        let change = (next - r).amax();
        r = next;
        if change < 1e-9 {
            return Some(r);
        }
    }
    None
}

/// sin θ / θ.
#[inline]
fn sinc(theta: f64) -> f64 {
    if theta.abs() < 1e-4 { 1.0 - theta * theta / 6.0 } else { theta.sin() / theta }
}

/// Σ a_k x^k by Horner's rule.
#[inline]
fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, a| sum * x + a)
}

/// Coefficients of V(ψ) = 1 + b ψ̃ + c ψ̃² and their derivatives divided by θ = ‖ψ‖.
struct ExpCoefficients {
    /// b = (1 − cos θ)/θ².
    b: f64,
    /// c = (θ − sin θ)/θ³.
    c: f64,
    /// b′/θ.
    b1: f64,
    /// c′/θ.
    c1: f64,
}

impl ExpCoefficients {
    /// Taylor series up to θ = 1, where the closed forms have lost no more than a digit.
    fn new(theta: f64) -> Self {
        let x = theta * theta;
        if theta < 1.0 {
            // b = Σ (−x)^k/(2k+2)!, c = Σ (−x)^k/(2k+3)!; d/dx doubled is d/dθ over θ.
            const B: [f64; 9] = inverse_factorials(2);
            const C: [f64; 9] = inverse_factorials(3);
            const B1: [f64; 8] = doubled_derivative(&B);
            const C1: [f64; 8] = doubled_derivative(&C);
            Self {
                b: polynomial(&B, x),
                c: polynomial(&C, x),
                b1: polynomial(&B1, x),
                c1: polynomial(&C1, x),
            }
        } else {
            let (sin, cos) = theta.sin_cos();
            let b = (1.0 - cos) / x;
            let c = (theta - sin) / (x * theta);
            Self { b, c, b1: (sin / theta - 2.0 * b) / x, c1: (b - 3.0 * c) / x }
        }
    }
}

/// (−1)^k / (2k + first)! for k = 0, 1, ….
const fn inverse_factorials(first: usize) -> [f64; 9] {
    let mut result = [0.0; 9];
    let mut factorial = 1.0;
    let mut i = 2;
    while i <= first {
        factorial *= i as f64;
        i += 1;
    }
    let mut k = 0;
    let mut sign = 1.0;
    while k < 9 {
        result[k] = sign / factorial;
        factorial *= ((2 * k + first + 1) * (2 * k + first + 2)) as f64;
        sign = -sign;
        k += 1;
    }
    result
}

/// 2 d/dx of a power series in x.
const fn doubled_derivative<const N: usize, const M: usize>(a: &[f64; N]) -> [f64; M] {
    let mut result = [0.0; M];
    let mut k = 0;
    while k < M {
        result[k] = 2.0 * (k + 1) as f64 * a[k + 1];
        k += 1;
    }
    result
}

/// d(θ) = (1 − ½θ cot ½θ)/θ² of V⁻¹ = 1 − ½ψ̃ + d ψ̃², and d′/θ.
fn log_coefficients(theta: f64) -> (f64, f64) {
    // d = Σ |B_{2k+2}|/(2k+2)! x^k, B the Bernoulli numbers; also 2 ζ(2k+2)/(2π)^{2k+2}.
    const D: [f64; 18] = [
        8.333_333_333_333_333e-2,
        1.388_888_888_888_889e-3,
        3.306_878_306_878_307e-5,
        8.267_195_767_195_768e-7,
        2.087_675_698_786_81e-8,
        5.284_190_138_687_493e-10,
        1.338_253_653_068_467_8e-11,
        3.389_680_296_322_583e-13,
        8.586_062_056_277_845e-15,
        2.174_868_698_558_062e-16,
        5.509_002_828_360_23e-18,
        1.395_446_468_581_252e-19,
        3.534_707_039_629_467e-21,
        8.953_517_427_037_546e-23,
        2.267_952_452_337_683e-24,
        5.744_790_668_872_202e-26,
        1.455_172_475_614_865e-27,
        3.685_994_940_665_31e-29,
    ];
    const D1: [f64; 17] = doubled_derivative(&D);
    let x = theta * theta;
    if theta < 2.0 {
        return (polynomial(&D, x), polynomial(&D1, x));
    }
    let (sin, cos) = (0.5 * theta).sin_cos();
    let cot = cos / sin;
    let d = 1.0 / x - cot / (2.0 * theta);
    let d1 = (-2.0 / x + cot / (2.0 * theta) + 0.25 / (sin * sin)) / x;
    (d, d1)
}

/// V(ψ) = 1 + b ψ̃ + c ψ̃², the left Jacobian of SO(3); J_r(ψ) = V(ψ)ᵀ = V(−ψ).
fn left_jacobian(psi: &Vector3<f64>) -> Matrix3<f64> {
    let k = ExpCoefficients::new(psi.norm());
    let s = skew(psi);
    Matrix3::identity() + k.b * s + k.c * s * s
}

/// J_r(ψ): exp(ψ + δψ) = exp(ψ) exp(J_r δψ).
pub fn right_jacobian(psi: &Vector3<f64>) -> Matrix3<f64> {
    left_jacobian(psi).transpose()
}

/// J_r(ψ)⁻¹ = 1 + ½ψ̃ + d ψ̃²; singular at θ = 2π only.
pub fn right_jacobian_inverse(psi: &Vector3<f64>) -> Matrix3<f64> {
    let (d, _) = log_coefficients(psi.norm());
    let s = skew(psi);
    Matrix3::identity() + 0.5 * s + d * s * s
}

/// exp(ψ̃), through the quaternion.
pub fn exp_so3(psi: &Vector3<f64>) -> Matrix3<f64> {
    rotation_matrix(&quaternion_exp(psi))
}

/// The rotation vector of the shortest rotation, ‖ψ‖ ≤ π, through the quaternion (acos loses half the digits near 0).
pub fn log_so3(a: &Matrix3<f64>) -> Vector3<f64> {
    rotation_vector(&quaternion_of(a))
}

/// The rotation vector of a unit quaternion, ‖ψ‖ ≤ π.
pub fn rotation_vector(quaternion: &Vector4<f64>) -> Vector3<f64> {
    let q = if quaternion[0] < 0.0 { -quaternion } else { *quaternion };
    let v = Vector3::new(q[1], q[2], q[3]);
    let sine = v.norm();
    // 2 atan(s/c)/s tends to 2/c as s → 0.
    let factor = if sine < 1e-8 { 2.0 / q[0] } else { 2.0 * sine.atan2(q[0]) / sine };
    factor * v
}

/// A twist (v, ψ), or a rigid motion's logarithm: translation first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Translational part.
    pub translation: Vector3<f64>,
    /// Rotational part.
    pub rotation: Vector3<f64>,
}

/// A 6×6 matrix of the form [[a, b], [0, a]], which all Jacobians of SE(3) have.
#[derive(Clone, Copy, Debug)]
pub struct TwistMap {
    /// Both diagonal blocks.
    pub diagonal: Matrix3<f64>,
    /// Translation from rotation.
    pub coupling: Matrix3<f64>,
}

/// Exp(v, ψ) = (exp ψ̃, V(ψ) v).
pub fn exp_se3(twist: &Twist) -> (Matrix3<f64>, Vector3<f64>) {
    (exp_so3(&twist.rotation), left_jacobian(&twist.rotation) * twist.translation)
}

/// Log(A, r) = (V(ψ)⁻¹ r, ψ) with ψ = log A; `None` within 1e-6 of half a turn, where ψ is ambiguous.
pub fn log_se3(a: &Matrix3<f64>, r: &Vector3<f64>) -> Option<Twist> {
    let rotation = log_so3(a);
    let angle = rotation.norm();
    if angle.is_nan() || angle >= PI - 1e-6 {
        return None;
    }
    // V⁻¹ = J_l⁻¹ = J_r⁻ᵀ.
    Some(Twist { translation: right_jacobian_inverse(&rotation).tr_mul(r), rotation })
}

/// ∂/∂ψ of ψ × (ψ × v) = ψ (ψ·v) − v ψ².
fn double_cross_derivative(psi: &Vector3<f64>, v: &Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(psi.dot(v)) + psi * v.transpose() - 2.0 * v * psi.transpose()
}

/// J_r of SE(3): Exp(θ + δθ) = Exp(θ) Exp(J_r δθ).
///
/// The body translation of Exp is exp(ψ)ᵀ δ(V v), which gives exp(ψ)ᵀ V = J_r and the coupling exp(ψ)ᵀ ∂(V v)/∂ψ.
pub fn right_jacobian_se3(twist: &Twist) -> TwistMap {
    let (v, psi) = (&twist.translation, &twist.rotation);
    let k = ExpCoefficients::new(psi.norm());
    let cross = psi.cross(v);
    let derivative = -k.b * skew(v)
        + k.c * double_cross_derivative(psi, v)
        + (k.b1 * cross + k.c1 * psi.cross(&cross)) * psi.transpose();
    TwistMap { diagonal: right_jacobian(psi), coupling: exp_so3(psi).tr_mul(&derivative) }
}

/// J_r⁻¹ of SE(3): Log(H Exp(η)) = Log(H) + J_r⁻¹ η to first order.
///
/// With v = V⁻¹ r: δv = V⁻¹ A η_v + ∂(V⁻¹ r)/∂ψ J_r⁻¹ η_ω, V⁻¹ A = J_r⁻¹,
/// ∂(V⁻¹ r)/∂ψ = ½ r̃ + d ∂(ψ×(ψ×r))/∂ψ + (d′/θ) (ψ×(ψ×r)) ψᵀ.
pub fn right_jacobian_inverse_se3(twist: &Twist) -> TwistMap {
    let psi = &twist.rotation;
    let r = left_jacobian(psi) * twist.translation;
    let (d, d1) = log_coefficients(psi.norm());
    let derivative = 0.5 * skew(&r)
        + d * double_cross_derivative(psi, &r)
        + d1 * psi.cross(&psi.cross(&r)) * psi.transpose();
    let diagonal = right_jacobian_inverse(psi);
    TwistMap { diagonal, coupling: derivative * diagonal }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> [Vector3<f64>; 3] {
        [Vector3::new(0.3, -0.5, 0.81), Vector3::new(-1.0, 0.2, 0.1), Vector3::new(0.0, 0.0, 1.0)]
            .map(|v| v.normalize())
    }

    /// Angles across the switches of the series and up to half a turn.
    const ANGLES: [f64; 12] =
        [0.0, 1e-12, 1e-8, 1e-4, 1e-2, 0.5, 0.999_999, 1.000_001, 1.999_999, 2.000_001, 2.5, 3.1];

    #[test]
    fn quaternion_map_is_orthogonal_and_blind_to_the_norm() {
        let p = Vector4::new(0.3, -0.7, 0.2, 0.5);
        let a = rotation_matrix(&p);
        assert!((a.transpose() * a - Matrix3::identity()).amax() < 1e-15);
        for exponent in [-320.0, -300.0, -100.0, 100.0, 307.0_f64] {
            let factor = 10f64.powf(exponent / 2.0);
            let b = rotation_matrix(&(p * factor * factor));
            let tolerance = if exponent < -300.0 { 1e-3 } else { 4e-15 }; // subnormal numbers have few digits
            assert!((a - b).amax() < tolerance, "1e{exponent}: {}", (a - b).amax());
        }
    }

    #[test]
    fn exp_and_log_invert_each_other() {
        for direction in directions() {
            for angle in ANGLES {
                let psi = angle * direction;
                assert!(
                    (log_so3(&exp_so3(&psi)) - psi).norm() <= 4e-15 * (1.0 + angle) / (PI - angle).min(1.0)
                );
                let twist = Twist { translation: Vector3::new(0.4, 0.9, -0.3), rotation: psi };
                let (a, r) = exp_se3(&twist);
                let back = log_se3(&a, &r).expect("below half a turn");
                assert!((back.translation - twist.translation).norm() < 1e-13);
            }
        }
        assert!(log_se3(&exp_so3(&(PI * directions()[0])), &Vector3::zeros()).is_none());
    }

    #[test]
    fn coefficients_do_not_jump_at_the_switches() {
        let (below, above) = (ExpCoefficients::new(1.0 - 1e-15), ExpCoefficients::new(1.0));
        for (x, y) in [(below.b, above.b), (below.c, above.c), (below.b1, above.b1), (below.c1, above.c1)] {
            assert!((x - y).abs() < 2e-15, "{x} {y}");
        }
        let ((d, d1), (e, e1)) = (log_coefficients(2.0 - 1e-15), log_coefficients(2.0));
        assert!((d - e).abs() < 2e-16 && (d1 - e1).abs() < 2e-16, "{d} {e} {d1} {e1}");
    }

    #[test]
    fn jacobians_invert_each_other() {
        for direction in directions() {
            for angle in ANGLES {
                let twist = Twist { translation: Vector3::new(0.4, 0.9, -0.3), rotation: angle * direction };
                let (j, i) = (right_jacobian_se3(&twist), right_jacobian_inverse_se3(&twist));
                assert!((j.diagonal * i.diagonal - Matrix3::identity()).amax() < 1e-14);
                assert!((j.diagonal * i.coupling + j.coupling * i.diagonal).amax() < 2e-14, "{angle}");
            }
        }
    }

    #[test]
    fn polar_rotation_recovers_the_rotation() {
        let r = exp_so3(&Vector3::new(0.3, 1.2, -2.0));
        let u = Matrix3::new(1.2, 0.1, -0.2, 0.1, 0.7, 0.05, -0.2, 0.05, 0.9);
        let found = polar_rotation(&(r * u)).expect("positive determinant");
        assert!((found - r).amax() < 2e-15);
        assert!(polar_rotation(&Matrix3::zeros()).is_none());
        assert!(polar_rotation(&-Matrix3::identity()).is_none());
        assert!(polar_rotation(&Matrix3::from_element(f64::NAN)).is_none());
    }

    #[test]
    fn rates_of_the_quaternion_are_inverse_to_each_other() {
        let p = Vector4::new(0.3, -0.7, 0.2, 0.5) * 3.0;
        let t = rotation_from_quaternion_rate(&p);
        assert!((t * quaternion_rate(&p) - Matrix3::identity()).amax() < 1e-15);
        assert!((t * p).amax() < 1e-15);
    }
}
