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
use crate::lanes::{
    LANES, Matrix, Processor, Vector, Wide, difference, gather, plus_scaled, scatter, sum, times,
};
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

/// The nodes of four elements, side by side.
#[derive(Clone, Copy, Debug)]
pub struct Nodes<'a, const N: usize> {
    /// As they are.
    pub poses: [&'a [Pose; N]; LANES],
    /// A_j.
    pub rotations: [Matrix; N],
    /// r_j − r_0: differences first, so that a rod far from the origin loses nothing here.
    pub from_first: [Vector; N],
}

impl<'a, const N: usize> Nodes<'a, N> {
    /// Of four elements.
    #[inline(always)]
    pub fn new(poses: [&'a [Pose; N]; LANES]) -> Self {
        let mut nodes = Self { poses, rotations: [Matrix::default(); N], from_first: [Vector::default(); N] };
        for j in 0..N {
            nodes.rotations[j] = Matrix::gather(|lane| &poses[lane][j].rotation);
            for k in 0..3 {
                nodes.from_first[j][k] =
                    Wide::gather(|lane| poses[lane][j].position[k] - poses[lane][0].position[k]);
            }
        }
        nodes
    }
}

/// Increments of the nodes of four elements, side by side.
#[derive(Clone, Copy, Debug)]
pub struct Increments<const N: usize> {
    /// δr_j.
    pub translation: [Vector; N],
    /// δφ_j.
    pub rotation: [Vector; N],
}

impl<const N: usize> Increments<N> {
    /// Of four elements.
    #[inline(always)]
    pub fn new(increments: [&[Increment; N]; LANES]) -> Self {
        Self {
            translation: std::array::from_fn(|j| gather(|lane| &increments[lane][j].translation)),
            rotation: std::array::from_fn(|j| gather(|lane| &increments[lane][j].rotation)),
        }
    }
}

/// A, γ̄ and κ̄ at a point of four elements, as in [`Strain`], and how the translations of the nodes strain it there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strains {
    /// A_IK as interpolated.
    pub rotation: Matrix,
    /// γ̄ [m].
    pub gamma: Vector,
    /// κ̄ [rad].
    pub kappa: Vector,
    /// G of ∂γ̄/∂δr_j = N_j′ G, the same for all nodes; κ̄ depends on rotations only.
    pub gamma_translation: Matrix,
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

/// The lane of an element whose nodes are half a turn or more apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfTurnIn(pub usize);

/// A way to interpolate between the N nodes of an element.
pub trait Interpolation<const N: usize> {
    /// Position and rotation, the latter projected to the nearest rotation where it is not one.
    fn pose(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Pose, HalfTurn>;

    /// The position alone.
    fn position(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Vector3<f64>, HalfTurn>;

    /// The pose and its derivative.
    fn pose_derivative(nodes: &[Pose; N], basis: &Basis<N>) -> Result<PoseDerivative<N>, HalfTurn>;

    /// The strains.
    fn strain(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Strain, HalfTurn>;

    /// What the derivatives of the strains need at a point of four elements, computed once.
    type Point: Copy + Default;

    /// The strains at a point of four elements, ready for their derivatives.
    fn point(
        processor: impl Processor,
        nodes: &Nodes<N>,
        basis: &Basis<N>,
    ) -> Result<(Strains, Self::Point), HalfTurnIn>;

    /// M ∂γ̄/∂δφ_j for every given M.
    fn gamma_rotation<const K: usize>(
        processor: impl Processor,
        point: &Self::Point,
        node: (usize, &Nodes<N>, &Basis<N>),
        factors: [&Matrix; K],
    ) -> [Matrix; K];

    /// ∂κ̄/∂δφ_j.
    fn kappa_rotation(
        processor: impl Processor,
        point: &Self::Point,
        node: (usize, &Nodes<N>, &Basis<N>),
    ) -> Matrix;

    /// ∂(A n)/∂δφ_j for a fixed n in the body basis.
    fn turned(
        processor: impl Processor,
        point: &Self::Point,
        node: (usize, &Nodes<N>, &Basis<N>),
        n: &Vector,
    ) -> Matrix;

    /// (δγ̄, δκ̄) of four elements for given nodal increments.
    fn strain_increment(
        processor: impl Processor,
        nodes: &Nodes<N>,
        basis: &Basis<N>,
        increments: &Increments<N>,
    ) -> Result<(Vector, Vector), HalfTurnIn>;

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

/// A, A′ and r′ at a point of four elements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct R12Point {
    rotation: Matrix,
    slope: Matrix,
    tangent: Vector,
}

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
        let rotation = polar_rotation(&combine(nodes, &basis.value)).ok_or(HalfTurn)?;
        Ok(Pose { position: Self::position(nodes, basis)?, rotation })
    }

    fn position(nodes: &[Pose; N], basis: &Basis<N>) -> Result<Vector3<f64>, HalfTurn> {
        let mut position = nodes[0].position;
        for j in 1..N {
            position += (nodes[j].position - nodes[0].position) * basis.value[j];
        }
        Ok(position)
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

    type Point = R12Point;

    #[inline(always)]
    fn point(
        processor: impl Processor,
        nodes: &Nodes<N>,
        basis: &Basis<N>,
    ) -> Result<(Strains, R12Point), HalfTurnIn> {
        let mut rotation = nodes.rotations[0].scaled(processor, basis.value[0]);
        let mut slope = nodes.rotations[0].scaled(processor, basis.derivative[0]);
        let mut tangent = times(processor, basis.derivative[1], &nodes.from_first[1]);
        for j in 1..N {
            rotation = rotation.plus_scaled(processor, basis.value[j], &nodes.rotations[j]);
            slope = slope.plus_scaled(processor, basis.derivative[j], &nodes.rotations[j]);
            if j > 1 {
                tangent = plus_scaled(processor, &tangent, basis.derivative[j], &nodes.from_first[j]);
            }
        }
        let transposed = rotation.transpose();
        let kappa = transposed.times(processor, &slope).axial(processor);
        let gamma = transposed.times_vector(processor, &tangent);
        let strains = Strains { rotation, gamma, kappa, gamma_translation: transposed };
        Ok((strains, R12Point { rotation, slope, tangent }))
    }

    /// N_j M (A_jᵀ r′)~, from δγ̄ = Aᵀ Σ N_j′ δr_j + Σ N_j (A_jᵀ r′)~ δφ_j.
    #[inline(always)]
    fn gamma_rotation<const K: usize>(
        processor: impl Processor,
        point: &R12Point,
        (j, nodes, basis): (usize, &Nodes<N>, &Basis<N>),
        factors: [&Matrix; K],
    ) -> [Matrix; K] {
        let lever = nodes.rotations[j].transpose_times_vector(processor, &point.tangent);
        let lever = times(processor, basis.value[j], &lever);
        let mut products = [Matrix::default(); K];
        for (product, factor) in products.iter_mut().zip(factors) {
            *product = factor.times_skew(processor, &lever);
        }
        products
    }

    /// From δκ̄ = Σ ½ [N_j′ (tr D_j 1 − D_j) − N_j (tr B_j 1 − B_j)] δφ_j, D_j = A_jᵀ A, B_j = A_jᵀ A′: both products
    /// at once, N_j′ D_j − N_j B_j = A_jᵀ (N_j′ A − N_j A′).
    #[inline(always)]
    fn kappa_rotation(
        processor: impl Processor,
        point: &R12Point,
        (j, nodes, basis): (usize, &Nodes<N>, &Basis<N>),
    ) -> Matrix {
        let mixed = point.rotation.scaled(processor, basis.derivative[j]);
        let mixed = mixed.plus_scaled(processor, -basis.value[j], &point.slope);
        nodes.rotations[j].transpose().times(processor, &mixed).half_trace_minus(processor)
    }

    /// δA n = −Σ N_j A_j ñ δφ_j.
    #[inline(always)]
    fn turned(
        processor: impl Processor,
        _: &R12Point,
        (j, nodes, basis): (usize, &Nodes<N>, &Basis<N>),
        n: &Vector,
    ) -> Matrix {
        nodes.rotations[j].times_skew(processor, &times(processor, -basis.value[j], n))
    }

    #[inline(always)]
    fn strain_increment(
        processor: impl Processor,
        nodes: &Nodes<N>,
        basis: &Basis<N>,
        increments: &Increments<N>,
    ) -> Result<(Vector, Vector), HalfTurnIn> {
        let (strains, point) = <Self as Interpolation<N>>::point(processor, nodes, basis)?;
        let (mut turned, mut turned_slope) = (Matrix::default(), Matrix::default());
        let mut stretched = Vector::default();
        for j in 0..N {
            let change = nodes.rotations[j].times_skew(processor, &increments.rotation[j]);
            turned = turned.plus_scaled(processor, basis.value[j], &change);
            turned_slope = turned_slope.plus_scaled(processor, basis.derivative[j], &change);
            let from_first = difference(processor, &increments.translation[j], &increments.translation[0]);
            stretched = plus_scaled(processor, &stretched, basis.derivative[j], &from_first);
        }
        let (turned, back) = (turned.transpose(), strains.gamma_translation);
        let by_turn = turned.times_vector(processor, &point.tangent);
        let by_stretch = back.times_vector(processor, &stretched);
        let gamma = sum(processor, &by_turn, &by_stretch);
        let change = turned.times(processor, &point.slope).plus_product(processor, &back, &turned_slope);
        Ok((gamma, change.axial(processor)))
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

/// δθ by the nodes' increments, and how the rotation turns with them, at a point of four elements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Se3Point {
    rotation: Matrix,
    diagonal: [Matrix; 2],
    coupling: [Matrix; 2],
    spin: [Matrix; 2],
}

/// One of every lane, for what branches.
#[inline(always)]
fn lane_by_lane<T>(
    nodes: &Nodes<2>,
    of: impl Fn(&[Pose; 2]) -> Result<T, HalfTurn>,
) -> Result<[T; LANES], HalfTurnIn> {
    let [a, b, c, d] = [0, 1, 2, 3].map(|lane| of(nodes.poses[lane]).map_err(|HalfTurn| HalfTurnIn(lane)));
    Ok([a?, b?, c?, d?])
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

    fn position(nodes: &[Pose; 2], basis: &Basis<2>) -> Result<Vector3<f64>, HalfTurn> {
        Ok(Self::pose(nodes, basis)?.position)
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

    type Point = Se3Point;

    /// The strains do not see where the nodes are, only how they lie to each other: ∂γ̄/∂δr_0 = −∂γ̄/∂δr_1.
    fn point(
        processor: impl Processor,
        nodes: &Nodes<2>,
        basis: &Basis<2>,
    ) -> Result<(Strains, Se3Point), HalfTurnIn> {
        let twists = lane_by_lane(nodes, relative_twist)?;
        let turns = lane_by_lane(nodes, |nodes| Self::turn(nodes, basis))?;
        let maps = twists.map(|twist| twist_derivative(&twist));
        let point = Se3Point {
            rotation: Matrix::gather(|lane| &turns[lane].rotation),
            diagonal: std::array::from_fn(|j| Matrix::gather(|lane| &maps[lane][j].diagonal)),
            coupling: std::array::from_fn(|j| Matrix::gather(|lane| &maps[lane][j].coupling)),
            spin: std::array::from_fn(|j| Matrix::gather(|lane| &turns[lane].spin[j])),
        };
        let strains = Strains {
            rotation: point.rotation,
            gamma: gather(|lane| &twists[lane].translation),
            kappa: gather(|lane| &twists[lane].rotation),
            gamma_translation: point.diagonal[1].times(processor, &nodes.rotations[1].transpose()),
        };
        Ok((strains, point))
    }

    #[inline(always)]
    fn gamma_rotation<const K: usize>(
        processor: impl Processor,
        point: &Se3Point,
        (j, ..): (usize, &Nodes<2>, &Basis<2>),
        factors: [&Matrix; K],
    ) -> [Matrix; K] {
        let mut products = [Matrix::default(); K];
        for (product, factor) in products.iter_mut().zip(factors) {
            *product = factor.times(processor, &point.coupling[j]);
        }
        products
    }

    #[inline(always)]
    fn kappa_rotation(_: impl Processor, point: &Se3Point, (j, ..): (usize, &Nodes<2>, &Basis<2>)) -> Matrix {
        point.diagonal[j]
    }

    /// δA n = A δφ̃ n = −A ñ δφ.
    #[inline(always)]
    fn turned(
        processor: impl Processor,
        point: &Se3Point,
        (j, ..): (usize, &Nodes<2>, &Basis<2>),
        n: &Vector,
    ) -> Matrix {
        point.rotation.times_skew(processor, &times(processor, -1.0, n)).times(processor, &point.spin[j])
    }

    fn strain_increment(
        _: impl Processor,
        nodes: &Nodes<2>,
        _: &Basis<2>,
        increments: &Increments<2>,
    ) -> Result<(Vector, Vector), HalfTurnIn> {
        let maps = lane_by_lane(nodes, |nodes| Ok(twist_derivative(&relative_twist(nodes)?)))?;
        let mut changes = [[Vector3::zeros(); 2]; LANES];
        for (lane, [gamma, kappa]) in changes.iter_mut().enumerate() {
            for (j, map) in maps[lane].iter().enumerate() {
                let [translation, rotation] =
                    [&increments.translation[j], &increments.rotation[j]].map(|v| scatter(v, lane));
                let node = &nodes.poses[lane][j].rotation;
                *gamma += map.diagonal * node.tr_mul(&translation) + map.coupling * rotation;
                *kappa += map.diagonal * rotation;
            }
        }
        Ok((gather(|lane| &changes[lane][0]), gather(|lane| &changes[lane][1])))
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
