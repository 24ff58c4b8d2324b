//! The paper's formulas once more, for any number type: dual numbers then differentiate them exactly.
//!
//! Written from the paper and not from the library, and differently from it: matrices where the library multiplies
//! out, power series and Cramer's rule where it has closed forms, the basis' slope by a dual number, too.

use nalgebra::{Matrix3, Vector3, Vector4};
use num_dual::{Dual64, DualNum};

/// `f64` and the dual numbers over it.
pub trait Number: DualNum<Primitive = f64> + Copy {}
impl<T: DualNum<Primitive = f64> + Copy> Number for T {}

/// A constant vector.
pub fn lift<D: Number>(v: &Vector3<f64>) -> Vector3<D> {
    v.map(D::from)
}

/// ã.
pub fn tilde<D: Number>(a: &Vector3<D>) -> Matrix3<D> {
    let zero = D::from(0.0);
    Matrix3::new(zero, -a.z, a.y, a.z, zero, -a.x, -a.y, a.x, zero)
}

/// j⁻¹(½ (M − Mᵀ)).
pub fn axial<D: Number>(m: &Matrix3<D>) -> Vector3<D> {
    let skew = (m - m.transpose()) * D::from(0.5);
    Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)])
}

/// M⁻¹ by Cramer's rule: rows b × c, c × a, a × b over the determinant, for M = (a b c).
pub fn inverse<D: Number>(m: &Matrix3<D>) -> Matrix3<D> {
    let (a, b, c) = (m.column(0).into_owned(), m.column(1).into_owned(), m.column(2).into_owned());
    let normal = b.cross(&c);
    let rows = [normal, c.cross(&a), a.cross(&b)].map(|row| row.transpose());
    Matrix3::from_rows(&rows) * a.dot(&normal).recip()
}

/// A(P) = 1 + 2 (p̃² + p₀ p̃)/‖P‖², eq. (5), as it is printed.
pub fn rotation<D: Number>(p: &Vector4<D>) -> Matrix3<D> {
    let part = tilde(&Vector3::new(p[1], p[2], p[3]));
    Matrix3::identity() + (part * part + part * p[0]) * (p.dot(p).recip() * 2.0)
}

/// Q(P) ω of eq. (10).
pub fn quaternion_rate<D: Number>(p: &Vector4<D>, omega: &Vector3<D>) -> Vector4<D> {
    let vector = Vector3::new(p[1], p[2], p[3]);
    let turned = omega * p[0] + vector.cross(omega);
    Vector4::new(-vector.dot(omega), turned.x, turned.y, turned.z) * D::from(0.5)
}

/// Σ ψ̃^k/(k + first)!: exp ψ̃ for `first` = 0, ∫₀¹ exp(x ψ̃) dx = V(ψ) for 1; to 40 terms, π⁴⁰/40! < 1e-27.
fn exponential_series<D: Number>(psi: &Vector3<D>, first: usize) -> Matrix3<D> {
    let (m, mut sum) = (tilde(psi), Matrix3::zeros());
    for k in (1..=40).rev() {
        sum = (Matrix3::identity() + sum) * m * D::from(1.0 / (k + first) as f64);
    }
    Matrix3::identity() + sum
}

/// exp ψ̃.
pub fn exp<D: Number>(psi: &Vector3<D>) -> Matrix3<D> {
    exponential_series(psi, 0)
}

/// V(ψ) with Exp(v, ψ) = (exp ψ̃, V v).
pub fn mean_exp<D: Number>(psi: &Vector3<D>) -> Matrix3<D> {
    exponential_series(psi, 1)
}

/// Log A, ‖ψ‖ < π, from s = axial(A) = sin θ e: the series of arcsin in ‖s‖², analytic at 0; beyond sin θ = 0.3
/// by the angle atan2(‖s‖, ½ (tr A − 1)).
pub fn log<D: Number>(a: &Matrix3<D>) -> Vector3<D> {
    let s = axial(a);
    let square = s.dot(&s);
    let cosine = (a[(0, 0)] + a[(1, 1)] + a[(2, 2)] - 1.0) * 0.5;
    if square.re() < 0.09 && cosine.re() > 0.0 {
        // arcsin(x)/x = 1 + x²·1/(2·3) + x⁴·(1·3)/(2·4·5) + …
        let (mut sum, mut term) = (D::from(1.0), D::from(1.0));
        for k in 1..=20 {
            let n = 2.0 * k as f64;
            term = term * square * ((n - 1.0) / n);
            sum += term * (1.0 / (n + 1.0));
        }
        return s * sum;
    }
    let sine = square.sqrt();
    s * (sine.atan2(cosine) / sine)
}

/// R of the polar decomposition M = R U: R = M (MᵀM)^{-½}, the root by Denman & Beavers (1976).
pub fn polar<D: Number>(m: &Matrix3<D>) -> Matrix3<D> {
    let (mut y, mut z) = (m.transpose() * m, Matrix3::identity());
    for _ in 0..20 {
        let half = D::from(0.5);
        (y, z) = ((y + inverse(&z)) * half, (z + inverse(&y)) * half);
    }
    m * z
}

/// A node, or a point of the rod.
#[derive(Clone, Copy, Debug)]
pub struct Frame<D: Number> {
    /// r.
    pub position: Vector3<D>,
    /// A.
    pub rotation: Matrix3<D>,
}

/// Log(H₀⁻¹ H₁), eq. (20), (21): (V⁻¹ A₀ᵀ (r₁ − r₀), Log A₀ᵀA₁).
pub fn relative_twist<D: Number>(start: &Frame<D>, end: &Frame<D>) -> [Vector3<D>; 2] {
    let back = start.rotation.transpose();
    let turn = log(&(back * end.rotation));
    [inverse(&mean_exp(&turn)) * (back * (end.position - start.position)), turn]
}

/// How the rod is interpolated between its nodes.
#[derive(Clone, Copy, Debug)]
pub enum Ansatz {
    /// Eq. (6).
    Matrices,
    /// H₀ Exp(x Log(H₀⁻¹ H₁)).
    Twist,
}

/// What eq. (6) and (7) give at one point, per element coordinate.
#[derive(Clone, Copy, Debug)]
pub struct Point<D: Number> {
    pub position: Vector3<D>,
    pub rotation: Matrix3<D>,
    pub gamma: Vector3<D>,
    pub kappa: Vector3<D>,
}

/// N_i and N_i′ at x: eq. (4) at the dual number x + ε.
pub fn shape(places: &[f64], i: usize, x: f64) -> (f64, f64) {
    let x = Dual64::new(x, 1.0);
    let mut product = Dual64::from_re(1.0);
    for (_, &other) in places.iter().enumerate().filter(|&(j, _)| j != i) {
        product *= (x - other) / (places[i] - other);
    }
    (product.re, product.eps)
}

/// The point at x of an element with the given nodes at the given places.
pub fn point<D: Number>(ansatz: Ansatz, places: &[f64], nodes: &[Frame<D>], x: f64) -> Point<D> {
    match ansatz {
        Ansatz::Matrices => {
            let (mut r, mut r1) = (Vector3::zeros(), Vector3::zeros());
            let (mut a, mut a1) = (Matrix3::zeros(), Matrix3::zeros());
            for (i, node) in nodes.iter().enumerate() {
                let (value, slope) = shape(places, i, x);
                r += node.position * D::from(value);
                r1 += node.position * D::from(slope);
                a += node.rotation * D::from(value);
                a1 += node.rotation * D::from(slope);
            }
            Point { position: r, rotation: a, gamma: a.transpose() * r1, kappa: axial(&(a.transpose() * a1)) }
        }
        Ansatz::Twist => {
            let [gamma, kappa] = relative_twist(&nodes[0], &nodes[1]);
            let turn = kappa * D::from(x);
            let offset = mean_exp(&turn) * gamma * D::from(x);
            Point {
                position: nodes[0].position + nodes[0].rotation * offset,
                rotation: nodes[0].rotation * exp(&turn),
                gamma,
                kappa,
            }
        }
    }
}

/// Force and moment at one point, in whatever bases the formula asks for.
pub type Pair<D> = (Vector3<D>, Vector3<D>);

/// Rows of one element, six a node.
pub type Rows<D> = Vec<[D; 6]>;

fn row<D: Number>((force, moment): Pair<D>) -> [D; 6] {
    [force.x, force.y, force.z, moment.x, moment.y, moment.z]
}

/// f_e^int, eq. (11), for stress resultants (n, m) given at every point of the rule (places and weights).
pub fn internal_force<D: Number>(
    places: &[f64],
    rule: &[(f64, f64)],
    points: &[Point<D>],
    stresses: &[Pair<D>],
) -> Rows<D> {
    let sum = |i: usize| {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for ((&(x, weight), point), (n, m)) in rule.iter().zip(points).zip(stresses) {
            let (value, slope) = shape(places, i, x);
            let (value, slope) = (D::from(value * weight), D::from(slope * weight));
            let couple = point.gamma.cross(n) + point.kappa.cross(m);
            force -= point.rotation * n * slope;
            moment -= m * slope - couple * value;
        }
        row((force, moment))
    };
    (0..places.len()).map(sum).collect()
}

/// f_e^ext, eq. (12), for (b, c) given at every point, with J.
pub fn external_force<D: Number>(
    places: &[f64],
    rule: &[(f64, f64)],
    jacobians: &[f64],
    loads: &[Pair<D>],
) -> Rows<D> {
    let sum = |i: usize| {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for ((&(x, weight), &jacobian), (b, c)) in rule.iter().zip(jacobians).zip(loads) {
            let factor = D::from(shape(places, i, x).0 * weight * jacobian);
            force += b * factor;
            moment += c * factor;
        }
        row((force, moment))
    };
    (0..places.len()).map(sum).collect()
}

/// Σ N_i y_i at x, eq. (9): (v, ω) or their rates.
fn field<D: Number>(places: &[f64], nodal: &[Pair<D>], x: f64) -> Pair<D> {
    let (mut v, mut omega) = (Vector3::zeros(), Vector3::zeros());
    for (i, (nodal_v, nodal_omega)) in nodal.iter().enumerate() {
        let value = D::from(shape(places, i, x).0);
        v += nodal_v * value;
        omega += nodal_omega * value;
    }
    (v, omega)
}

/// What a cross-section weighs: A_ρ0 and the diagonal of I_ρ0.
pub type Weight = (f64, Vector3<f64>);

/// −M_e u̇ − f_e^gyr(u), eq. (13) and (14) under one integral: the inertia of the fields (9) at every point of the rule.
pub fn inertia_force<D: Number>(
    places: &[f64],
    rule: &[(f64, f64)],
    jacobians: &[f64],
    (mass, rotary): Weight,
    velocities: &[Pair<D>],
    accelerations: &[Pair<D>],
) -> Rows<D> {
    let inertia = Matrix3::from_diagonal(&lift::<D>(&rotary));
    let loads: Vec<Pair<D>> = rule
        .iter()
        .map(|&(x, _)| {
            let (_, omega) = field(places, velocities, x);
            let (acceleration, spin) = field(places, accelerations, x);
            let moment = inertia * spin + tilde(&omega) * inertia * omega;
            (-acceleration * D::from(mass), -moment)
        })
        .collect();
    external_force(places, rule, jacobians, &loads)
}

/// ∫ ½ (A_ρ0 v·v + ω·I_ρ0 ω) J dx of the fields (9).
pub fn kinetic_energy(
    places: &[f64],
    rule: &[(f64, f64)],
    jacobians: &[f64],
    (mass, rotary): Weight,
    velocities: &[Pair<f64>],
) -> f64 {
    let at = |(&(x, weight), &jacobian): (&(f64, f64), &f64)| {
        let (v, omega) = field(places, velocities, x);
        0.5 * weight * jacobian * (mass * v.dot(&v) + omega.dot(&(Matrix3::from_diagonal(&rotary) * omega)))
    };
    rule.iter().zip(jacobians).map(at).sum()
}

/// P ∘ (1, φ/2) = P + Q(P) φ, eq. (10): P turned by φ in its own basis, and stretched.
pub fn turned<D: Number>(p: &Vector4<D>, phi: &Vector3<D>) -> Vector4<D> {
    p + quaternion_rate(p, phi)
}

/// What a joint does not leave free.
#[derive(Clone, Copy, Debug)]
pub enum Held {
    /// A point.
    Point,
    /// A point and the first of three directions e₁, e₂, e₃ given at the start.
    Axis(Matrix3<f64>),
    /// A point and every direction.
    Everything,
}

/// A joint as it was fitted: both parts at the start, and its point among the positions of each.
#[derive(Clone, Copy, Debug)]
pub struct Fitted {
    pub held: Held,
    pub start: [Frame<f64>; 2],
    pub points: [Vector3<f64>; 2],
}

impl Fitted {
    /// What has moved apart since: points of the parts' material, and directions b_k in terms of the a_k.
    ///
    /// With the material directions a_k and b_k that were both e_k at the start, ½ B_aᵀ Σ a_k × b_k is the axial
    /// vector of R = B_aᵀ B_b, for Σ e_k × ρ̃ e_k = 2ρ and Σ e_k × S e_k = 0 if S is symmetric.
    pub fn gap<D: Number>(&self, now: &[Frame<D>; 2]) -> [D; 6] {
        let moved = |part: usize| {
            let (start, now) = (&self.start[part], &now[part]);
            let turn = now.rotation * start.rotation.transpose().map(D::from);
            let arm = lift::<D>(&(self.points[part] - start.position));
            (now.position + turn * arm - lift(&self.points[part]), turn)
        };
        let ((from, a), (to, b)) = (moved(0), moved(1));
        let apart = to - from;
        let direction =
            |turn: &Matrix3<D>, of: &Matrix3<f64>, k: usize| turn * lift(&of.column(k).into_owned());
        let rows = match self.held {
            Held::Point => Vector3::zeros(),
            Held::Axis(basis) => {
                let axis = direction(&b, &basis, 0);
                let row = |k: usize| direction(&a, &basis, k).dot(&axis);
                Vector3::new(row(1), row(2), D::from(0.0))
            }
            Held::Everything => {
                let mut sum = Vector3::zeros();
                for k in 0..3 {
                    sum += a.column(k).cross(&b.column(k));
                }
                a.transpose() * sum * D::from(0.5)
            }
        };
        [apart.x, apart.y, apart.z, rows.x, rows.y, rows.z]
    }
}
