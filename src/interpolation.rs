//! From nodal poses to the pose, the strains and their derivatives at one point of an element.
//!
//! Strains are per element coordinate x ∈ [0, 1]: γ̄ = Aᵀ r′, κ̄ = j⁻¹(Skw(Aᵀ A′)), ′ = d/dx; division by the
//! reference Jacobian J = ‖r⁰′‖ makes them γ and κ of eq. (7). Nodal increments are (δr, δφ), δr inertial and
//! δA = A δφ̃ in the body basis.
//!
//! For any B: Bᵀ φ̃ + φ̃ B = ((tr B) φ − B φ)~, hence j⁻¹(Skw(φ̃ B)) = ½ ((tr B) 1 − B) φ. Every rotational
//! derivative below is this identity.

use nalgebra::{Matrix3, Vector3};
use thiserror::Error;

use crate::lagrange::Basis;
use crate::rotation::{
    Twist, TwistMap, axial, exp_se3, log_se3, polar_rotation, right_jacobian_inverse_se3, right_jacobian_se3,
    skew,
};

/// Position and orientation A_IK of a cross-section or a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position in the inertial basis [m].
    pub position: Vector3<f64>,
    /// A_IK, from the cross-section to the inertial basis.
    pub rotation: Matrix3<f64>,
}

/// An increment of a node: δr inertial [m], δφ in the body basis [rad].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Increment {
    /// δr.
    pub translation: Vector3<f64>,
    /// δφ.
    pub rotation: Vector3<f64>,
}

/// Strains at one point, per element coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strain {
    /// A_IK as interpolated: for R12 orthogonal at the nodes only.
    pub rotation: Matrix3<f64>,
    /// γ̄ = Aᵀ r′ [m].
    pub gamma: Vector3<f64>,
    /// κ̄ [rad].
    pub kappa: Vector3<f64>,
}

/// Strains with their derivatives; κ̄ depends on rotations only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrainDerivative<const N: usize> {
    /// The strains themselves.
    pub strain: Strain,
    /// ∂γ̄/∂δr_j.
    pub gamma_translation: [Matrix3<f64>; N],
    /// ∂γ̄/∂δφ_j.
    pub gamma_rotation: [Matrix3<f64>; N],
    /// ∂κ̄/∂δφ_j.
    pub kappa_rotation: [Matrix3<f64>; N],
}

/// Derivative of an interpolated pose: δr = Σ (r_r δr_j + r_φ δφ_j), δφ = Σ φ_φ δφ_j (body basis).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseDerivative<const N: usize> {
    /// The pose itself.
    pub pose: Pose,
    /// ∂r/∂δr_j.
    pub position_translation: [Matrix3<f64>; N],
    /// ∂r/∂δφ_j.
    pub position_rotation: [Matrix3<f64>; N],
    /// ∂φ/∂δφ_j.
    pub rotation_rotation: [Matrix3<f64>; N],
}

/// Nodes of one element are turned so far against each other that no rotation lies between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the nodes of an element are half a turn or more apart")]
pub struct HalfTurn;

/// A way to interpolate between the N nodes of an element.
pub trait Interpolation<const N: usize> {
    /// Position and rotation, the latter projected to the nearest rotation where it is not one.
    fn pose(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Pose, HalfTurn>;

    /// The pose and its derivative.
    fn pose_derivative(nodes: &[Pose; N], basis: &Basis<N>) -> Result<PoseDerivative<N>, HalfTurn>;

    /// The strains.
    fn strain(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Strain, HalfTurn>;

    /// The strains and their derivatives.
    fn strain_derivative(nodes: &[Pose; N], basis: &Basis<N>) -> Result<StrainDerivative<N>, HalfTurn>;

    /// (δγ̄, δκ̄) for given nodal increments.
    fn strain_increment(
        nodes: &[Pose; N],
        basis: &Basis<N>,
        increments: &[Increment; N],
    ) -> Result<(Vector3<f64>, Vector3<f64>), HalfTurn>;

    /// What the rotation's derivative needs at a point, computed once: see [`Self::rotated`].
    type Turn;

    /// The rotation's derivative at a point.
    fn turn(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Self::Turn, HalfTurn>;

    /// ∂(A n)/∂δφ_j for a fixed n in the body basis.
    fn rotated(turn: &Self::Turn, j: usize, n: &Vector3<f64>) -> Matrix3<f64>;

    /// ∂(Aᵀ b)/∂δφ_j for a fixed b in the inertial basis.
    fn rotated_back(turn: &Self::Turn, j: usize, b: &Vector3<f64>) -> Matrix3<f64>;
}

/// R12: positions and transformation matrices interpolated alike, eq. (6).
#[derive(Clone, Copy, Debug)]
pub struct R12;

/// Σ c_j A_j.
#[inline]
fn combine<const N: usize>(nodes: &[Pose; N], c: &[f64; N]) -> Matrix3<f64> {
    let mut sum = nodes[0].rotation * c[0];
    for j in 1..N {
        sum += nodes[j].rotation * c[j];
    }
    sum
}

/// r′ = Σ N_j′ (r_j − r_0): differences first, so that a rod far from the origin loses nothing here.
#[inline]
fn tangent_vector<const N: usize>(nodes: &[Pose; N], basis: &Basis<N>) -> Vector3<f64> {
    let mut sum = Vector3::zeros();
    for j in 1..N {
        sum += (nodes[j].position - nodes[0].position) * basis.derivative[j];
    }
    sum
}

/// ½ ((tr M) 1 − M).
#[inline]
pub(crate) fn half_trace_minus(m: &Matrix3<f64>) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(0.5 * m.trace()) - 0.5 * m
}

impl<const N: usize> Interpolation<N> for R12 {
    fn pose(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Pose, HalfTurn> {
        let mut position = nodes[0].position;
        for j in 1..N {
            position += (nodes[j].position - nodes[0].position) * basis.value[j];
        }
        let rotation = polar_rotation(&combine(nodes, &basis.value)).ok_or(HalfTurn)?;
        Ok(Pose { position, rotation })
    }

    /// With A = R U: j⁻¹(Skw(Rᵀ δA)) = ½ ((tr U) 1 − U) δφ, and Rᵀ δA = Σ N_j C_j δφ̃_j with C_j = Rᵀ A_j.
    fn pose_derivative(nodes: &[Pose; N], basis: &Basis<N>) -> Result<PoseDerivative<N>, HalfTurn> {
        let pose = <Self as Interpolation<N>>::pose(nodes, basis)?;
        let stretch = pose.rotation.tr_mul(&combine(nodes, &basis.value));
        let inverse = half_trace_minus(&stretch).try_inverse().ok_or(HalfTurn)?;
        let mut result = PoseDerivative {
            pose,
            position_translation: [Matrix3::zeros(); N],
            position_rotation: [Matrix3::zeros(); N],
            rotation_rotation: [Matrix3::zeros(); N],
        };
        for j in 0..N {
            result.position_translation[j] = Matrix3::from_diagonal_element(basis.value[j]);
            let back = nodes[j].rotation.tr_mul(&pose.rotation);
            result.rotation_rotation[j] = inverse * half_trace_minus(&back) * basis.value[j];
        }
        Ok(result)
    }

    #[inline]
    fn strain(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Strain, HalfTurn> {
        let rotation = combine(nodes, &basis.value);
        let slope = combine(nodes, &basis.derivative);
        let gamma = rotation.tr_mul(&tangent_vector(nodes, basis));
        Ok(Strain { rotation, gamma, kappa: axial(&rotation.tr_mul(&slope)) })
    }

    /// δγ̄ = Aᵀ Σ N_j′ δr_j + Σ N_j (A_jᵀ r′)~ δφ_j,
    /// δκ̄ = Σ ½ [N_j′ (tr D_j 1 − D_j) − N_j (tr B_j 1 − B_j)] δφ_j, D_j = A_jᵀ A, B_j = A_jᵀ A′.
    #[inline]
    fn strain_derivative(nodes: &[Pose; N], basis: &Basis<N>) -> Result<StrainDerivative<N>, HalfTurn> {
        let rotation = combine(nodes, &basis.value);
        let slope = combine(nodes, &basis.derivative);
        let tangent = tangent_vector(nodes, basis);
        let transposed = rotation.transpose();
        let strain = Strain { rotation, gamma: transposed * tangent, kappa: axial(&(transposed * slope)) };
        let mut result = StrainDerivative {
            strain,
            gamma_translation: [Matrix3::zeros(); N],
            gamma_rotation: [Matrix3::zeros(); N],
            kappa_rotation: [Matrix3::zeros(); N],
        };
        for j in 0..N {
            let back = nodes[j].rotation.transpose();
            result.gamma_translation[j] = transposed * basis.derivative[j];
            result.gamma_rotation[j] = skew(&(back * tangent * basis.value[j]));
            // Both products at once: N_j′ D_j − N_j B_j = A_jᵀ (N_j′ A − N_j A′).
            result.kappa_rotation[j] =
                half_trace_minus(&(back * (rotation * basis.derivative[j] - slope * basis.value[j])));
        }
        Ok(result)
    }

    #[inline]
    fn strain_increment(
        nodes: &[Pose; N],
        basis: &Basis<N>,
        increments: &[Increment; N],
    ) -> Result<(Vector3<f64>, Vector3<f64>), HalfTurn> {
        let rotation = combine(nodes, &basis.value);
        let slope = combine(nodes, &basis.derivative);
        let tangent = tangent_vector(nodes, basis);
        let (mut turned, mut turned_slope, mut stretched) =
            (Matrix3::zeros(), Matrix3::zeros(), Vector3::zeros());
        for j in 0..N {
            let change = nodes[j].rotation * skew(&increments[j].rotation);
            turned += change * basis.value[j];
            turned_slope += change * basis.derivative[j];
            stretched += increments[j].translation * basis.derivative[j];
        }
        let gamma = turned.tr_mul(&tangent) + rotation.tr_mul(&stretched);
        let kappa = axial(&(turned.tr_mul(&slope) + rotation.tr_mul(&turned_slope)));
        Ok((gamma, kappa))
    }

    /// N_j A_j.
    type Turn = [Matrix3<f64>; N];

    #[inline]
    fn turn(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Self::Turn, HalfTurn> {
        Ok(std::array::from_fn(|j| nodes[j].rotation * basis.value[j]))
    }

    /// δA n = Σ N_j A_j δφ̃_j n.
    #[inline]
    fn rotated(turn: &Self::Turn, j: usize, n: &Vector3<f64>) -> Matrix3<f64> {
        -turn[j] * skew(n)
    }

    /// δAᵀ b = −Σ N_j δφ̃_j A_jᵀ b.
    #[inline]
    fn rotated_back(turn: &Self::Turn, j: usize, b: &Vector3<f64>) -> Matrix3<f64> {
        skew(&turn[j].tr_mul(b))
    }
}

/// SE(3): H(x) = H₀ Exp(x θ), θ = (γ̄; κ̄) = Log(H₀⁻¹ H₁), constant strains (Harsch, Sailer & Eugster 2023).
#[derive(Clone, Copy, Debug)]
pub struct Se3;

/// θ = Log(H₀⁻¹ H₁).
fn relative_twist(nodes: &[Pose; 2]) -> Result<Twist, HalfTurn> {
    let back = nodes[0].rotation.transpose();
    log_se3(&(back * nodes[1].rotation), &(back * (nodes[1].position - nodes[0].position))).ok_or(HalfTurn)
}

fn scaled(twist: &Twist, x: f64) -> Twist {
    Twist { translation: twist.translation * x, rotation: twist.rotation * x }
}

/// [[a, b], [0, a]] [[c, d], [0, c]].
fn compose(first: &TwistMap, second: &TwistMap) -> TwistMap {
    TwistMap {
        diagonal: first.diagonal * second.diagonal,
        coupling: first.diagonal * second.coupling + first.coupling * second.diagonal,
    }
}

/// δθ = J_r⁻¹(θ) η₁ − J_r⁻¹(−θ) η₀ with the body increments η_j = (A_jᵀ δr_j, δφ_j); both factors.
fn twist_derivative(twist: &Twist) -> [TwistMap; 2] {
    let start = right_jacobian_inverse_se3(&scaled(twist, -1.0));
    [TwistMap { diagonal: -start.diagonal, coupling: -start.coupling }, right_jacobian_inverse_se3(twist)]
}

/// η(x) = Ad(Exp(−x θ)) η₀ + x J_r(x θ) δθ; the factors of η₀ and η₁.
fn body_derivative(twist: &Twist, x: f64) -> [TwistMap; 2] {
    let part = scaled(twist, x);
    let (rotation, position) = exp_se3(&part);
    let mut jacobian = right_jacobian_se3(&part);
    jacobian.diagonal *= x;
    jacobian.coupling *= x;
    let [start, end] = twist_derivative(twist).map(|map| compose(&jacobian, &map));
    let back = rotation.transpose();
    [TwistMap { diagonal: start.diagonal + back, coupling: start.coupling - back * skew(&position) }, end]
}

/// A and ∂φ/∂δφ_j at a point of an SE(3) element.
#[derive(Clone, Copy, Debug)]
pub struct Se3Turn {
    rotation: Matrix3<f64>,
    spin: [Matrix3<f64>; 2],
}

impl Interpolation<2> for Se3 {
    fn pose(nodes: &[Pose; 2], basis: &Basis<2>) -> Result<Pose, HalfTurn> {
        let (rotation, position) = exp_se3(&scaled(&relative_twist(nodes)?, basis.x));
        let start = &nodes[0];
        Ok(Pose { position: start.position + start.rotation * position, rotation: start.rotation * rotation })
    }

    fn pose_derivative(nodes: &[Pose; 2], basis: &Basis<2>) -> Result<PoseDerivative<2>, HalfTurn> {
        let pose = Self::pose(nodes, basis)?;
        let maps = body_derivative(&relative_twist(nodes)?, basis.x);
        Ok(PoseDerivative {
            pose,
            position_translation: std::array::from_fn(|j| {
                pose.rotation * maps[j].diagonal * nodes[j].rotation.transpose()
            }),
            position_rotation: maps.map(|map| pose.rotation * map.coupling),
            rotation_rotation: maps.map(|map| map.diagonal),
        })
    }

    fn strain(nodes: &[Pose; 2], basis: &Basis<2>) -> Result<Strain, HalfTurn> {
        let twist = relative_twist(nodes)?;
        let rotation = nodes[0].rotation * exp_se3(&scaled(&twist, basis.x)).0;
        Ok(Strain { rotation, gamma: twist.translation, kappa: twist.rotation })
    }

    fn strain_derivative(nodes: &[Pose; 2], basis: &Basis<2>) -> Result<StrainDerivative<2>, HalfTurn> {
        let strain = Self::strain(nodes, basis)?;
        let maps = twist_derivative(&Twist { translation: strain.gamma, rotation: strain.kappa });
        Ok(StrainDerivative {
            strain,
            gamma_translation: std::array::from_fn(|j| maps[j].diagonal * nodes[j].rotation.transpose()),
            gamma_rotation: maps.map(|map| map.coupling),
            kappa_rotation: maps.map(|map| map.diagonal),
        })
    }

    fn strain_increment(
        nodes: &[Pose; 2],
        basis: &Basis<2>,
        increments: &[Increment; 2],
    ) -> Result<(Vector3<f64>, Vector3<f64>), HalfTurn> {
        let d = Self::strain_derivative(nodes, basis)?;
        let (mut gamma, mut kappa) = (Vector3::zeros(), Vector3::zeros());
        for j in 0..2 {
            gamma += d.gamma_translation[j] * increments[j].translation
                + d.gamma_rotation[j] * increments[j].rotation;
            kappa += d.kappa_rotation[j] * increments[j].rotation;
        }
        Ok((gamma, kappa))
    }

    type Turn = Se3Turn;

    fn turn(nodes: &[Pose; 2], basis: &Basis<2>) -> Result<Se3Turn, HalfTurn> {
        let twist = relative_twist(nodes)?;
        let rotation = nodes[0].rotation * exp_se3(&scaled(&twist, basis.x)).0;
        Ok(Se3Turn { rotation, spin: body_derivative(&twist, basis.x).map(|map| map.diagonal) })
    }

    /// δA n = A δφ̃ n = −A ñ δφ.
    fn rotated(turn: &Se3Turn, j: usize, n: &Vector3<f64>) -> Matrix3<f64> {
        -turn.rotation * skew(n) * turn.spin[j]
    }

    /// δAᵀ b = −δφ̃ Aᵀ b = (Aᵀ b)~ δφ.
    fn rotated_back(turn: &Se3Turn, j: usize, b: &Vector3<f64>) -> Matrix3<f64> {
        skew(&turn.rotation.tr_mul(b)) * turn.spin[j]
    }
}
