//! Joints between two parts: the equations g = 0, G, Gᵀ λ, its tangent, Ġ u, and the wrench about the joint's point,
//! at poses that do not satisfy the joint.

use cosserat::constraint::Constraint;
use cosserat::inertia::Velocity;
use cosserat::interpolation::{Increment, Pose};
use cosserat::scene::JointKind;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use num_dual::{Dual2_64, Dual64, HyperDual64};

use super::inertia::velocity;
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{Fitted, Frame, Held, exp, lift, rotation, turned};
use crate::states::{ElementState, Generator, Worst, unit_increment};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "derivatives::constraint",
            "points and directions of the parts' material, eq. (5), (10)",
            constraint,
        ),
        Case::new(
            "derivatives::constraint_axis",
            "a right-handed orthonormal basis along the axis of a revolute joint",
            constraint_axis,
        ),
    ]
}

const REASON: &str = "200 ε: up to five 3×3 products in a row on either side, of rotations good to 10 ε and numbers of \
                      one size";
const BOUND: f64 = 5e-14;

fn frame(pose: &Pose) -> Frame<f64> {
    Frame { position: pose.position, rotation: pose.rotation }
}

/// The joint's basis, as the library has chosen it: a at the start, b turned until its axis is ±e_k of the inertial
/// basis, so that the rows of rotation are ±e₂·e_k and ±e₃·e_k.
fn basis_of(constraint: &Constraint, [a, b]: [&Pose; 2], axis: &Vector3<f64>) -> Matrix3<f64> {
    let mut basis = Matrix3::zeros();
    basis.set_column(0, axis);
    for k in 0..3 {
        let sign = if axis[k] < 0.0 { -1.0 } else { 1.0 };
        // Half a turn about the direction between the two brings one to the other.
        let between: Vector3<f64> = (axis + Vector3::ith(k, sign)).normalize();
        let turn = 2.0 * between * between.transpose() - Matrix3::identity();
        let gap = constraint.gap(a, &Pose { position: b.position, rotation: turn * b.rotation });
        basis[(k, 1)] = sign * gap[3];
        basis[(k, 2)] = sign * gap[4];
    }
    basis
}

/// A joint of the library and the same of the formulas.
struct Joined {
    constraint: Constraint,
    fitted: Fitted,
    start: [Pose; 2],
}

impl Joined {
    /// Parts kept about origins of their own: the joint's point differs by any vector.
    fn new(kind: JointKind, seed: u64) -> Self {
        let mut random = Generator::new(seed);
        let start = ElementState::<2>::new(&[0.0, 1.0], 2.0, seed).poses();
        let points = [random.vector(), random.vector()];
        let axis = random.axis();
        let [a, b] = &start;
        let constraint = Constraint::new(kind, [a, b], points, 3.0 * axis);
        let held = match kind {
            JointKind::Rigid => Held::Everything,
            JointKind::Spherical => Held::Point,
            JointKind::Revolute => Held::Axis(basis_of(&constraint, [a, b], &axis)),
        };
        let fitted = Fitted { held, start: [frame(a), frame(b)], points };
        Self { constraint, fitted, start }
    }
}

#[derive(Default)]
struct Errors {
    start: Worst,
    gap: Worst,
    jacobian: Worst,
    forces: Worst,
    tangent: Worst,
    acceleration: Worst,
    wrench: Worst,
}

fn constraint(checks: &mut Checks) -> Outcome {
    for (kind, rows) in [(JointKind::Rigid, 6), (JointKind::Spherical, 3), (JointKind::Revolute, 5)] {
        let mut errors = Errors::default();
        for seed in 300..320 {
            let joined = Joined::new(kind, seed);
            let [a, b] = &joined.start;
            let gap = joined.constraint.gap(a, b);
            errors.start.compare_against(gap.iter().copied(), [0.0; 6], 1.0);
            // Anywhere else.
            let state = ElementState::<2>::new(&[0.0, 1.0], 2.5, seed + 1000);
            compare(&mut errors, &joined, &state, &mut Generator::new(seed + 2000));
        }
        let counted = Joined::new(kind, 300).constraint.rows() as f64;
        let quantity = format!("number of rows, {kind:?}");
        checks.absolute(Kind::Invariant, quantity, (counted, f64::from(rows)), 0.0, "a count is exact");
        for (quantity, worst) in [
            ("g at the start", errors.start),
            ("g", errors.gap),
            ("G", errors.jacobian),
            ("Gᵀ λ", errors.forces),
            ("−∂(Gᵀ λ)/∂q", errors.tangent),
            ("Ġ u", errors.acceleration),
            ("wrench about the joint's point", errors.wrench),
        ] {
            checks.below(Kind::Invariant, format!("{quantity}, {kind:?}"), worst.0, BOUND, REASON);
        }
    }
    Ok(())
}

fn compare(errors: &mut Errors, joined: &Joined, state: &ElementState<2>, random: &mut Generator) {
    let Joined { constraint, fitted, .. } = joined;
    let [a, b] = state.poses();
    let gap = constraint.gap(&a, &b);
    errors.gap.compare(gap.iter().copied(), fitted.gap(&[frame(&a), frame(&b)]));

    let moved = |part: usize, k: usize| -> [Frame<Dual64>; 2] {
        let nodes = state.moved(&unit_increment::<2>(part, k));
        [nodes[0], nodes[1]]
    };
    // Multipliers of rows that do not exist must do nothing.
    let multipliers = Vector6::from_fn(|_, _| random.number());
    let jacobian = constraint.jacobian(&a, &b);
    let forces = constraint.forces(&a, &b, &multipliers);
    for part in 0..2 {
        let column = |k: usize| fitted.gap(&moved(part, k)).map(|x| x.eps);
        errors.jacobian.compare(jacobian[part].iter().copied(), (0..6).flat_map(column));
        let work = |k: usize| column(k).iter().zip(&multipliers).map(|(g, l)| g * l).sum::<f64>();
        errors.forces.compare(forces[part].iter().copied(), (0..6).map(work));
    }
    compare_tangent(errors, joined, state, &multipliers);
    compare_acceleration(errors, joined, state, random);

    for (part, pose) in [a, b].iter().enumerate() {
        let (force, moment) = (random.vector(), random.vector());
        let (at_point, about) = constraint.wrench(part, pose, &force, &moment);
        // The power of either is the same for every motion.
        for k in 0..6 {
            let increments: [Increment; 2] = unit_increment(part, k);
            let start = &fitted.start[part];
            let arm = start.rotation.tr_mul(&(fitted.points[part] - start.position));
            let frame = &moved(part, k)[part];
            let point = (frame.position + frame.rotation * lift::<Dual64>(&arm)).map(|x| x.eps);
            let spin = pose.rotation * increments[part].rotation;
            let [given, turned] = [increments[part].translation, increments[part].rotation];
            let exact = force.dot(&given) + moment.dot(&turned);
            let scale = force.norm() * (1.0 + arm.norm()) + moment.norm();
            errors.wrench.compare_against([at_point.dot(&point) + about.dot(&spin)], [exact], scale);
        }
    }
}

/// Both parts after two increments in a row, each of component k of (δr, δφ) of one part: the first, of j, moves the
/// place at which the second, of i, measures Gᵀ λ.
fn moved_twice(
    state: &ElementState<2>,
    (j, k): (usize, usize),
    (i, l): (usize, usize),
) -> [Frame<HyperDual64>; 2] {
    let zero = HyperDual64::from_re(0.0);
    let unit = |first: usize, k: usize, step: HyperDual64| {
        Vector3::from_fn(|m, _| if first + m == k { step } else { zero })
    };
    std::array::from_fn(|part| {
        let mut position = lift::<HyperDual64>(&state.positions[part]);
        let mut quaternion = state.quaternions[part].map(HyperDual64::from_re);
        for (at, component, step) in [(j, k, zero.derivative1()), (i, l, zero.derivative2())] {
            if at == part {
                position += unit(0, component, step);
                quaternion = turned(&quaternion, &unit(3, component, step));
            }
        }
        Frame { position, rotation: rotation(&quaternion) }
    })
}

fn compare_tangent(
    errors: &mut Errors,
    joined: &Joined,
    state: &ElementState<2>,
    multipliers: &Vector6<f64>,
) {
    let [a, b] = state.poses();
    let blocks: [[Matrix6<f64>; 2]; 2] = joined.constraint.tangent(&a, &b, multipliers);
    let (mut measured, mut exact) = (Vec::new(), Vec::new());
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        for (l, k) in (0..6).flat_map(|l| (0..6).map(move |k| (l, k))) {
            let gap = joined.fitted.gap(&moved_twice(state, (j, k), (i, l)));
            measured.push(blocks[i][j][(l, k)]);
            exact.push(-gap.iter().zip(multipliers).map(|(g, m)| g.eps1eps2 * m).sum::<f64>());
        }
    }
    errors.tangent.compare(measured, exact);
}

/// g̈ along r + v t + ½ v̇ t², A exp(ω t + ½ ω̇ t²), whose velocity and acceleration at t = 0 are (v, ω), (v̇, ω̇).
fn compare_acceleration(
    errors: &mut Errors,
    joined: &Joined,
    state: &ElementState<2>,
    random: &mut Generator,
) {
    let [a, b] = state.poses();
    let (velocities, rates): ([Velocity; 2], [Velocity; 2]) =
        ([velocity(random), velocity(random)], [velocity(random), velocity(random)]);
    let path: [Frame<Dual2_64>; 2] = std::array::from_fn(|part| {
        let (u, rate) = (&velocities[part], &rates[part]);
        let course = |start: f64, first: f64, second: f64| Dual2_64::new(start, first, second);
        let angle = u.rotation.zip_map(&rate.rotation, |first, second| course(0.0, first, second));
        let position =
            Vector3::from_fn(|k, _| course(state.positions[part][k], u.translation[k], rate.translation[k]));
        Frame { position, rotation: rotation(&state.quaternions[part].map(Dual2_64::from_re)) * exp(&angle) }
    });
    let six = |u: &Velocity| Vector6::from_iterator(u.translation.iter().chain(&u.rotation).copied());
    let [start, end] = joined.constraint.jacobian(&a, &b);
    let ours = start * six(&rates[0])
        + end * six(&rates[1])
        + joined.constraint.acceleration(&a, &b, &velocities[0], &velocities[1]);
    errors.acceleration.compare(ours.iter().copied(), joined.fitted.gap(&path).map(|g| g.v2));
}

/// Axes along, against, near and far from the coordinate axes, of any length.
fn constraint_axis(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(330);
    let mut axes = vec![Vector3::new(1.0, 1.0, 1.0).normalize(), Vector3::new(-1.0, 1.0, 0.0).normalize()];
    for k in 0..3 {
        let along = Vector3::ith(k, 1.0);
        axes.extend([along, -along, (along + 1e-9 * random.axis()).normalize()]);
    }
    axes.extend((0..20).map(|_| random.axis()));
    let mut worst = Worst::default();
    let [a, b] = ElementState::<2>::new(&[0.0, 1.0], 2.0, 331).poses();
    for axis in &axes {
        for length in [1e-200, 1.0, 1e200] {
            let constraint =
                Constraint::new(JointKind::Revolute, [&a, &b], [a.position, b.position], axis * length);
            let basis = basis_of(&constraint, [&a, &b], axis);
            let square = basis.tr_mul(&basis);
            worst.compare(square.iter().copied(), Matrix3::<f64>::identity().iter().copied());
            worst.compare([basis.determinant()], [1.0]);
        }
    }
    checks.below(Kind::Invariant, "EᵀE = 1, det E = 1", worst.0, BOUND, REASON);
    Ok(())
}
