//! Perfect joints between two moving parts a and b, as equations g = 0 on their poses with multipliers λ.
//!
//! A part is a rod's node, a body, or the ground, whose pose stays and whose columns are left out. The joint holds a
//! point c = r + A s and a basis B = A J of each part (s, J constant in the body basis, B_a = B_b at the start):
//!
//! ```text
//! g₁…₃ = (r_b + A_b s_b) − (r_a + A_a s_a) − o         every joint, inertial [m]
//! g₄…₆ = j⁻¹(Skw(R)),  R = B_aᵀ B_b                    rigid: as sin θ e of the relative rotation
//! g₄,₅ = (B_a e₂)·(B_b e₁), (B_a e₃)·(B_b e₁)          revolute about e₁: the first column of R
//! ```
//!
//! The offset o makes g = 0 at the start: positions may be kept relative to another origin for each part. The rows of
//! rotation vanish half a turn away, too; no step of a solver is that long.
//!
//! With the rotations ψ = Jᵀ δφ in the joint's basis every derivative follows from δR = R ψ̃_b − ψ̃_a R and
//! j⁻¹(Skw(φ̃ M)) = ½ ((tr M) 1 − M) φ, and with Ṙ alike, R̈ at rest accelerations is
//! Ω̃_a² R − 2 Ω̃_a R Ω̃_b + R Ω̃_b² for Ω = Jᵀ ω.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::inertia::Velocity;
use crate::interpolation::{Pose, half_trace_minus};
use crate::rotation::{axial, direction, skew};
use crate::scene::JointKind;

/// A joint between part a (index 0) and part b (index 1).
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    kind: JointKind,
    /// s, from each part's own point to the joint's, body basis [m].
    arms: [Vector3<f64>; 2],
    /// J, from the joint's basis to each part's body basis; the first column is the axis.
    frames: [Matrix3<f64>; 2],
    /// o [m].
    offset: Vector3<f64>,
}

/// A right-handed basis whose first column is the given direction: the second is perpendicular to the coordinate axis
/// that the direction is farthest from.
fn basis_along(axis: &Vector3<f64>) -> Matrix3<f64> {
    let first = direction(axis);
    let second = direction(&first.cross(&Vector3::ith(first.iamin(), 1.0)));
    Matrix3::from_columns(&[first, second, first.cross(&second)])
}

/// Writes a 3×3 matrix into a 6×6 one.
#[inline]
fn put(target: &mut Matrix6<f64>, row: usize, column: usize, part: &Matrix3<f64>) {
    target.fixed_view_mut::<3, 3>(row, column).copy_from(part);
}

/// Both halves of a six-vector.
#[inline]
fn halves(v: &Vector6<f64>) -> [Vector3<f64>; 2] {
    [v.fixed_rows::<3>(0).into_owned(), v.fixed_rows::<3>(3).into_owned()]
}

/// Both halves in one.
#[inline]
fn join(first: &Vector3<f64>, second: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(first.x, first.y, first.z, second.x, second.y, second.z)
}

impl Constraint {
    /// From the poses of a and b at the start and the joint's point relative to the origin of each part's positions
    /// [m]; `axis` of a revolute joint, of any non-zero length; all inertial.
    pub fn new(kind: JointKind, poses: [&Pose; 2], points: [Vector3<f64>; 2], axis: Vector3<f64>) -> Self {
        let common = match kind {
            JointKind::Rigid | JointKind::Spherical => Matrix3::identity(),
            JointKind::Revolute => basis_along(&axis),
        };
        let arms = [0, 1].map(|part| poses[part].rotation.tr_mul(&(points[part] - poses[part].position)));
        let frames = poses.map(|pose| pose.rotation.tr_mul(&common));
        let mut constraint = Self { kind, arms, frames, offset: Vector3::zeros() };
        constraint.offset = constraint.separation(poses[0], poses[1]);
        constraint
    }

    /// What the joint leaves free.
    pub fn kind(&self) -> JointKind {
        self.kind
    }

    /// Number of equations.
    pub fn rows(&self) -> usize {
        match self.kind {
            JointKind::Rigid => 6,
            JointKind::Spherical => 3,
            JointKind::Revolute => 5,
        }
    }

    /// (r_b + A_b s_b) − (r_a + A_a s_a) − o.
    #[inline]
    fn separation(&self, a: &Pose, b: &Pose) -> Vector3<f64> {
        let [start, end] = self.arms;
        (b.position + b.rotation * end) - (a.position + a.rotation * start) - self.offset
    }

    /// R = B_aᵀ B_b.
    #[inline]
    fn relative_rotation(&self, a: &Pose, b: &Pose) -> Matrix3<f64> {
        (a.rotation * self.frames[0]).tr_mul(&(b.rotation * self.frames[1]))
    }

    /// The rows of rotation of R or of a derivative of R, in which they are linear; those that do not exist are zero.
    #[inline]
    fn rotation_rows(&self, r: &Matrix3<f64>) -> Vector3<f64> {
        match self.kind {
            JointKind::Rigid => axial(r),
            JointKind::Spherical => Vector3::zeros(),
            JointKind::Revolute => Vector3::new(r.m21, r.m31, 0.0),
        }
    }

    /// g; rows that do not exist are zero.
    #[inline]
    pub fn gap(&self, a: &Pose, b: &Pose) -> Vector6<f64> {
        join(&self.separation(a, b), &self.rotation_rows(&self.relative_rotation(a, b)))
    }

    /// G = ∂g/∂(δr, δφ) of a and of b; rows that do not exist are zero.
    ///
    /// ```text
    /// δ(A s) = −A s̃ δφ
    /// rigid      δg = −½ ((tr R) 1 − R) ψ_a + ½ ((tr R) 1 − Rᵀ) ψ_b
    /// revolute   δg_k = e_k·((R e₁)~ ψ_a − R ẽ₁ ψ_b),  k = 2, 3
    /// ```
    #[inline]
    pub fn jacobian(&self, a: &Pose, b: &Pose) -> [Matrix6<f64>; 2] {
        let mut jacobian = [Matrix6::zeros(); 2];
        for (part, (pose, sign)) in [(a, -1.0), (b, 1.0)].into_iter().enumerate() {
            jacobian[part].fixed_view_mut::<3, 3>(0, 0).fill_diagonal(sign);
            put(&mut jacobian[part], 0, 3, &(pose.rotation * skew(&self.arms[part]) * -sign));
        }
        let r = self.relative_rotation(a, b);
        let turns = match self.kind {
            JointKind::Rigid => [-half_trace_minus(&r), half_trace_minus(&r.transpose())],
            JointKind::Spherical => return jacobian,
            JointKind::Revolute => {
                let axis = r.column(0).into_owned();
                [skew(&axis), -r * skew(&Vector3::x())].map(|turn| {
                    Matrix3::from_rows(&[
                        turn.row(1).into(),
                        turn.row(2).into(),
                        Vector3::zeros().transpose(),
                    ])
                })
            }
        };
        for part in 0..2 {
            put(&mut jacobian[part], 3, 3, &(turns[part] * self.frames[part].transpose()));
        }
        jacobian
    }

    /// The multipliers of rotation as a vector μ in the joint's basis.
    #[inline]
    fn couple(&self, multipliers: &Vector3<f64>) -> Vector3<f64> {
        match self.kind {
            JointKind::Rigid => *multipliers,
            JointKind::Spherical => Vector3::zeros(),
            JointKind::Revolute => Vector3::new(0.0, multipliers.x, multipliers.y),
        }
    }

    /// Gᵀ λ, what the joint does to a and to b: (force inertial [N], moment body [N m]).
    ///
    /// ```text
    /// every joint   ∓λ_r                           ∓s × (Aᵀ λ_r)
    /// rigid         −½ J_a ((tr R) μ − Rᵀ μ)       ½ J_b ((tr R) μ − R μ)
    /// revolute      J_a (μ × R e₁)                 J_b (e₁ × Rᵀ μ)
    /// ```
    #[inline]
    pub fn forces(&self, a: &Pose, b: &Pose, multipliers: &Vector6<f64>) -> [Vector6<f64>; 2] {
        let [force, couple] = halves(multipliers);
        let couple = self.couple(&couple);
        let r = self.relative_rotation(a, b);
        let [start, end] = match self.kind {
            JointKind::Rigid => {
                let trace = r.trace();
                [-0.5 * (trace * couple - r.tr_mul(&couple)), 0.5 * (trace * couple - r * couple)]
            }
            JointKind::Spherical => [Vector3::zeros(); 2],
            JointKind::Revolute => {
                [couple.cross(&r.column(0).into_owned()), Vector3::x().cross(&r.tr_mul(&couple))]
            }
        };
        let moment = |part: usize, pose: &Pose| self.arms[part].cross(&pose.rotation.tr_mul(&force));
        [
            join(&-force, &(self.frames[0] * start - moment(0, a))),
            join(&force, &(self.frames[1] * end + moment(1, b))),
        ]
    }

    /// Blocks K_ij = −∂(Gᵀ λ)_i/∂(δr, δφ)_j for fixed λ, i and j being a and b; only rotations are coupled.
    ///
    /// ```text
    /// δ(Aᵀ λ_r) = (Aᵀ λ_r)~ δφ     δ(Rᵀ μ) = (Rᵀ μ)~ ψ_b − Rᵀ μ̃ ψ_a     δ(R μ) = (R μ)~ ψ_a − R μ̃ ψ_b
    /// δ(tr R) = 2 ρ·(ψ_a − ψ_b),  ρ = j⁻¹(Skw(R))      from tr(ψ̃ R) = −2 ρ·ψ
    /// ```
    #[inline]
    pub fn tangent(&self, a: &Pose, b: &Pose, multipliers: &Vector6<f64>) -> [[Matrix6<f64>; 2]; 2] {
        let [force, couple] = halves(multipliers);
        let couple = self.couple(&couple);
        let r = self.relative_rotation(a, b);
        let (turned, back) = (r * couple, r.tr_mul(&couple));
        let mut blocks = match self.kind {
            JointKind::Rigid => {
                let trace = couple * (2.0 * axial(&r)).transpose();
                let across = r.tr_mul(&skew(&couple));
                [[trace + across, -trace - skew(&back)], [skew(&turned) - trace, trace - r * skew(&couple)]]
                    .map(|row| row.map(|block| 0.5 * block))
            }
            JointKind::Spherical => [[Matrix3::zeros(); 2]; 2],
            JointKind::Revolute => {
                let (axis, first) = (skew(&r.column(0).into_owned()), skew(&Vector3::x()));
                let couple = skew(&couple);
                [[-couple * axis, couple * r * first], [first * r.tr_mul(&couple), -first * skew(&back)]]
            }
        };
        for i in 0..2 {
            for j in 0..2 {
                blocks[i][j] = self.frames[i] * blocks[i][j] * self.frames[j].transpose();
            }
        }
        for (part, (pose, sign)) in [(a, 1.0), (b, -1.0)].into_iter().enumerate() {
            blocks[part][part] += skew(&(self.arms[part] * sign)) * skew(&pose.rotation.tr_mul(&force));
        }
        blocks.map(|row| {
            row.map(|block| {
                let mut whole = Matrix6::zeros();
                put(&mut whole, 3, 3, &block);
                whole
            })
        })
    }

    /// Ġ u, so that g̈ = G u̇ + Ġ u; rows that do not exist are zero.
    ///
    /// (A s)¨ at rest accelerations is A (ω × (ω × s)), because Ȧ = A ω̃; R̈ stands above.
    #[inline]
    pub fn acceleration(&self, a: &Pose, b: &Pose, u_a: &Velocity, u_b: &Velocity) -> Vector6<f64> {
        let centripetal = |part: usize, pose: &Pose, omega: &Vector3<f64>| {
            pose.rotation * omega.cross(&omega.cross(&self.arms[part]))
        };
        let separation = centripetal(1, b, &u_b.rotation) - centripetal(0, a, &u_a.rotation);
        let r = self.relative_rotation(a, b);
        let start = skew(&self.frames[0].tr_mul(&u_a.rotation));
        let end = skew(&self.frames[1].tr_mul(&u_b.rotation));
        let rate = start * (start * r - 2.0 * r * end) + r * end * end;
        join(&separation, &self.rotation_rows(&rate))
    }

    /// A generalised force on part 0 (a) or 1 (b), force inertial and moment body, as force and moment about the
    /// joint's point, both inertial: A m − (A s) × f.
    pub fn wrench(
        &self,
        part: usize,
        pose: &Pose,
        force: &Vector3<f64>,
        moment: &Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let arm = pose.rotation * self.arms[part];
        (*force, pose.rotation * moment - arm.cross(force))
    }
}
