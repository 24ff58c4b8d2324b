//! The quaternion map with its rates, exponential and logarithm of SO(3) and SE(3), their right Jacobians.

use cosserat::interpolation::{Increment, Pose};
use cosserat::rotation::{
    Twist, TwistMap, exp_se3, exp_so3, log_se3, log_so3, quaternion_exp, quaternion_of, quaternion_product,
    quaternion_rate, right_jacobian, right_jacobian_inverse, right_jacobian_inverse_se3, right_jacobian_se3,
    rotation_from_quaternion_rate, rotation_matrix, rotation_vector,
};
use cosserat::state::State;
use nalgebra::{Matrix3, Vector3, Vector4};
use num_dual::Dual64;

use super::{ROUNDING, ROUNDING_REASON};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{self, Frame, axial, relative_twist, tilde};
use crate::states::{ANGLES, Generator, Worst};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("derivatives::quaternion_map", "eq. (5), (10)", quaternion_map),
        Case::new(
            "derivatives::rotation_exponential",
            "exp and log of SO(3) as power series",
            rotation_exponential,
        ),
        Case::new(
            "derivatives::motion_exponential",
            "Exp and Log of SE(3), V(ψ) = ∫₀¹ exp(x ψ̃) dx as a power series",
            motion_exponential,
        ),
    ]
}

fn values(v: &Vector3<Dual64>) -> Vector3<f64> {
    v.map(|x| x.re)
}

fn rates(v: &Vector3<Dual64>) -> Vector3<f64> {
    v.map(|x| x.eps)
}

/// j⁻¹(Aᵀ Ȧ), the body rate of a dual rotation.
fn body_rate(a: &Matrix3<Dual64>) -> Vector3<f64> {
    rates(&axial(&(a.map(|x| Dual64::from_re(x.re)).transpose() * a)))
}

fn unit(k: usize) -> Vector3<f64> {
    Vector3::ith(k, 1.0)
}

/// v + ε e_k.
fn seeded(v: &Vector3<f64>, k: usize) -> Vector3<Dual64> {
    v.zip_map(&unit(k), Dual64::new)
}

/// A(P), δφ = T(P) δP, Ṗ = Q(P) ω, A(a ∘ b) = A(a) A(b), the update of a node.
fn quaternion_map(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(1);
    let [mut map, mut turn, mut rate, mut product, mut update] = [Worst::default(); 5];
    for norm in [1e-100, 1e-3, 1.0, 40.0, 1e100] {
        for _ in 0..20 {
            let p = Vector4::from_fn(|_, _| random.number()) * norm;
            let a = formulas::rotation(&p);
            map.compare(rotation_matrix(&p).iter().copied(), a.iter().copied());
            for k in 0..4 {
                let dual = Vector4::from_fn(|i, _| Dual64::new(p[i] / norm, f64::from(u8::from(i == k))));
                let exact = body_rate(&formulas::rotation(&dual));
                let ours = rotation_from_quaternion_rate(&p).column(k) * norm;
                turn.compare(ours.iter().copied(), exact.iter().copied());
            }
            let omega = random.vector();
            let exact = formulas::quaternion_rate(&p, &omega);
            rate.compare((quaternion_rate(&p) * omega).iter().copied(), exact.iter().copied());
            let q = Vector4::from_fn(|_, _| random.number());
            let both = quaternion_product(&p, &q);
            let exact = a * formulas::rotation(&q);
            product.compare(rotation_matrix(&both).iter().copied(), exact.iter().copied());
            let mut state = State::default();
            state.push(Vector3::zeros(), p);
            let increment = Increment { translation: random.vector(), rotation: 2.0 * omega };
            state.add(0, &increment);
            let exact = a * formulas::exp(&increment.rotation);
            let pose: &Pose = &state.poses()[0];
            update.compare(pose.rotation.iter().copied(), exact.iter().copied());
            update.compare(pose.position.iter().copied(), increment.translation.iter().copied());
        }
    }
    for (quantity, worst) in [
        ("A(P)", map),
        ("T(P) against ∂A/∂P", turn),
        ("Q(P) ω", rate),
        ("A(P ∘ Q) = A(P) A(Q)", product),
        ("A(P ∘ exp δφ) = A(P) exp δφ", update),
    ] {
        let reason = "50 ε: matrix entries of size one from a dozen operations, four times over";
        checks.below(Kind::Invariant, quantity, worst.0, 1e-14, reason);
    }
    Ok(())
}

/// exp ψ̃, Log A and J_r, J_r⁻¹ at every angle.
fn rotation_exponential(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(2);
    let [mut exp, mut log, mut jacobian, mut inverse] = [Worst::default(); 4];
    for angle in ANGLES {
        for _ in 0..10 {
            let psi = angle * random.axis();
            let a = formulas::exp(&psi);
            exp.compare(exp_so3(&psi).iter().copied(), a.iter().copied());
            // A carries ε per entry, and its logarithm ε/sin θ near half a turn.
            let near = 1.0 / angle.sin().abs().max(angle.cos());
            let exact = formulas::log(&a);
            for ours in
                [log_so3(&a), rotation_vector(&quaternion_of(&a)), rotation_vector(&-quaternion_exp(&psi))]
            {
                log.compare_against(ours.iter().copied(), exact.iter().copied(), near);
            }
            for k in 0..3 {
                let exact = body_rate(&formulas::exp(&seeded(&psi, k)));
                jacobian.compare_against(
                    right_jacobian(&psi).column(k).iter().copied(),
                    exact.iter().copied(),
                    1.0,
                );
                let turned =
                    a.map(Dual64::from_re) * (Matrix3::identity() + tilde(&seeded(&Vector3::zeros(), k)));
                let exact = rates(&formulas::log(&turned));
                let ours = right_jacobian_inverse(&psi);
                inverse.compare_against(ours.column(k).iter().copied(), exact.iter().copied(), near * near);
            }
        }
    }
    for (quantity, worst) in [
        ("exp ψ̃", exp),
        ("Log A, times sin θ", log),
        ("J_r(ψ)", jacobian),
        ("J_r(ψ)⁻¹, times sin² θ", inverse),
    ] {
        let reason =
            "250 ε: the terms of the power series reach e³ = 20 before they cancel, and lose that factor";
        checks.below(Kind::Invariant, quantity, worst.0, 5e-14, reason);
    }
    Ok(())
}

/// The two blocks of column k ≥ 3, or of column k < 3 of a twist map.
fn column(map: &TwistMap, k: usize) -> [f64; 6] {
    let (v, w) = if k < 3 {
        (map.diagonal.column(k).into_owned(), Vector3::zeros())
    } else {
        (map.coupling.column(k - 3).into_owned(), map.diagonal.column(k - 3).into_owned())
    };
    [v.x, v.y, v.z, w.x, w.y, w.z]
}

fn joined(v: &Vector3<f64>, w: &Vector3<f64>) -> [f64; 6] {
    [v.x, v.y, v.z, w.x, w.y, w.z]
}

/// Component k of a six-vector: which half, and which entry.
fn halves(k: usize) -> [Vector3<f64>; 2] {
    let mut halves = [Vector3::zeros(); 2];
    halves[k / 3][k % 3] = 1.0;
    halves
}

fn motion_exponential(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(3);
    let [mut exp, mut log, mut jacobian, mut inverse] = [Worst::default(); 4];
    let origin = Frame { position: Vector3::zeros(), rotation: Matrix3::identity() };
    for angle in ANGLES {
        for _ in 0..10 {
            let (v, psi) = (2.0 * random.vector(), angle * random.axis());
            let twist = Twist { translation: v, rotation: psi };
            let (a, r) = exp_se3(&twist);
            exp.compare(a.iter().copied(), formulas::exp(&psi).iter().copied());
            exp.compare_against(r.iter().copied(), (formulas::mean_exp(&psi) * v).iter().copied(), v.norm());
            let near = 1.0 / angle.sin().abs().max(angle.cos());
            let back = log_se3(&a, &r).ok_or("no logarithm below half a turn")?;
            log.compare_against(back.translation.iter().copied(), v.iter().copied(), near);
            log.compare_against(back.rotation.iter().copied(), psi.iter().copied(), near);
            let (forward, backward) = (right_jacobian_se3(&twist), right_jacobian_inverse_se3(&twist));
            for k in 0..6 {
                let [dv, dpsi] = halves(k);
                let moving = psi.zip_map(&dpsi, Dual64::new);
                let position = formulas::mean_exp(&moving) * v.zip_map(&dv, Dual64::new);
                let body = a.tr_mul(&rates(&position));
                let exact = joined(&body, &body_rate(&formulas::exp(&moving)));
                jacobian.compare_against(column(&forward, k), exact, 1.0);
                // H Exp(ε η) = (A (1 + ε η̃_ω), r + ε A η_v).
                let turned = Matrix3::identity() + tilde(&dpsi.map(|x| Dual64::new(0.0, x)));
                let end = Frame {
                    position: r.zip_map(&(a * dv), Dual64::new),
                    rotation: a.map(Dual64::from_re) * turned,
                };
                let [v, w] = relative_twist(&origin, &end);
                debug_assert!((values(&w) - psi).norm() < 1e-9);
                inverse.compare_against(column(&backward, k), joined(&rates(&v), &rates(&w)), near * near);
            }
        }
    }
    for (quantity, worst) in [
        ("Exp θ", exp),
        ("Log Exp θ = θ, times sin θ", log),
        ("J_r(θ)", jacobian),
        ("J_r(θ)⁻¹, times sin² θ", inverse),
    ] {
        checks.below(Kind::Invariant, quantity, worst.0, ROUNDING, ROUNDING_REASON);
    }
    Ok(())
}
