//! Rotations at the ends of their ranges: quaternions and directions of any norm, angles where a series takes over and
//! where a logarithm stops being one, matrices with no rotation near them.

use cosserat::rotation::{
    direction, exp_so3, log_se3, log_so3, normalized, polar_rotation, quaternion_exp, quaternion_of,
    rotation_matrix,
};
use nalgebra::{Matrix3, Vector3, Vector4};
use std::f64::consts::PI;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::states::{Generator, Worst};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("rotation_limits::norms", "A(2ᵏ P) = A(P), eq. (5)", norms),
        Case::new("rotation_limits::small_angles", "sin x, and 1/x for what it undoes", small_angles),
        Case::new("rotation_limits::half_turn", "the shortest rotation has two axes there", half_turn),
        Case::new("rotation_limits::large_turns", "A = 2 e eᵀ − 1, and the quaternion (0, e)", large_turns),
        Case::new("rotation_limits::no_rotation_near", "the polar decomposition M = R U", no_rotation_near),
    ]
}

/// Powers of two over the whole range of numbers, none of which changes a digit.
fn norms(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(400);
    let [mut map, mut unit, mut along] = [Worst::default(); 3];
    for _ in 0..20 {
        let p = Vector4::from_fn(|_, _| random.number());
        let v = random.vector();
        let exact = p / p.dot(&p).sqrt();
        for exponent in [-1000, -600, -300, -1, 0, 1, 300, 600, 1000] {
            let factor = 2.0_f64.powi(exponent);
            map.compare(rotation_matrix(&(p * factor)).iter().copied(), rotation_matrix(&p).iter().copied());
            unit.compare(normalized(&(p * factor)).iter().copied(), exact.iter().copied());
            along.compare(direction(&(v * factor)).iter().copied(), (v / v.norm()).iter().copied());
        }
    }
    checks.below(Kind::Invariant, "A(2ᵏ P) against A(P)", map.0, 0.0, "a power of two changes no digit");
    for (quantity, worst) in [("P/‖P‖", unit), ("v/‖v‖", along)] {
        checks.below(Kind::ClosedForm, quantity, worst.0, 2e-15, "8 ε: a root, a quotient and four squares");
    }
    Ok(())
}

/// The vector of a quaternion and the logarithm, relative to the angle, on both sides of where series take over.
fn small_angles(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(401);
    let [mut exp, mut log] = [Worst::default(); 2];
    for half in [1e-150, 1e-20, 0.9e-8, 1.1e-8, 1e-6, 0.5e-4, 0.999e-4, 1.001e-4, 1e-3] {
        for _ in 0..10 {
            let axis = random.axis();
            let q = quaternion_exp(&(2.0 * half * axis));
            let sine: f64 = half.sin();
            exp.compare(q.iter().skip(1).map(|x| x / sine), axis.iter().copied());
            exp.compare([q[0]], [half.cos()]);
            let back = log_so3(&exp_so3(&(2.0 * half * axis)));
            log.compare(back.iter().map(|x| x / (2.0 * half)), axis.iter().copied());
        }
    }
    let none = quaternion_exp(&Vector3::zeros());
    exp.compare(none.iter().copied(), [1.0, 0.0, 0.0, 0.0]);
    log.compare_against(log_so3(&Matrix3::identity()).iter().copied(), [0.0; 3], 1.0);
    let reason = "16 ε: a sine or its series, the norm of the axis, and some products";
    checks.below(Kind::ClosedForm, "(cos ½φ, e sin ½φ)", exp.0, 4e-15, reason);
    checks.below(Kind::ClosedForm, "log exp φ/φ", log.0, 4e-15, reason);
    Ok(())
}

/// A logarithm of SE(3) up to 1e-6 before half a turn, and none from there on, nor of what is no number.
fn half_turn(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(402);
    let given = |angle: f64, axis: &Vector3<f64>| log_se3(&exp_so3(&(angle * axis)), &Vector3::x()).is_some();
    let (mut before, mut after) = (0, 0);
    for _ in 0..10 {
        let axis = random.axis();
        before += [3.0, PI - 1e-3, PI - 1.1e-6].iter().filter(|angle| given(**angle, &axis)).count();
        after += [PI - 0.9e-6, PI, PI + 0.9e-6].iter().filter(|angle| given(**angle, &axis)).count();
    }
    after += usize::from(log_se3(&Matrix3::from_element(f64::NAN), &Vector3::x()).is_some());
    let reason = "the angle is known to ε, a tenth of the 1e-6 is far more";
    checks.absolute(Kind::ClosedForm, "logarithms before it", (before as f64, 30.0), 0.0, reason);
    checks.absolute(Kind::ClosedForm, "logarithms at it", (after as f64, 0.0), 0.0, reason);
    Ok(())
}

/// The quaternion of half a turn, and of a little less, about the axes of a cube: three of its components, two or none
/// may vanish, and to divide by a small one would lose every digit.
fn large_turns(checks: &mut Checks) -> Outcome {
    let mut worst = Worst::default();
    let steps = [-1.0, 0.0, 1.0];
    let all = steps.iter().flat_map(|x| steps.iter().flat_map(move |y| steps.map(|z| [*x, *y, z])));
    for axis in all.map(Vector3::from).filter(|axis| axis.norm() > 0.5) {
        let e: Vector3<f64> = axis / axis.norm();
        for missing in [0.0, 1e-12, 1e-7, 1e-3, 0.5] {
            let (sine, cosine) = (f64::sin(0.5 * missing), f64::cos(0.5 * missing));
            let exact = Vector4::new(sine, cosine * e.x, cosine * e.y, cosine * e.z);
            // cos θ 1 + (1 − cos θ) e eᵀ + sin θ ẽ for θ = π − missing.
            let (c, s) = (-f64::cos(missing), f64::sin(missing));
            let across = Matrix3::new(0.0, -e.z, e.y, e.z, 0.0, -e.x, -e.y, e.x, 0.0);
            let a = Matrix3::identity() * c + e * e.transpose() * (1.0 - c) + across * s;
            let found = quaternion_of(&a);
            let sign = found.dot(&exact).signum();
            worst.compare(found.iter().map(|x| x * sign), exact.iter().copied());
        }
    }
    let reason = "8 ε: half of differences and sums of two matrix entries, over a component of at least ½";
    checks.below(Kind::ClosedForm, "quaternion of A", worst.0, 2e-15, reason);
    Ok(())
}

/// R of M = R U for U of sizes and shapes that sums of rotations have; none where det M does not tell its sign, and none of a reflection.
fn no_rotation_near(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(403);
    let mut worst = Worst::default();
    for size in [1e-150, 0.1, 1.0, 40.0, 1e150] {
        for smallest in [1e-11, 1e-8, 1e-6, 0.3, 1.0] {
            let (r, b) = (exp_so3(&(3.0 * random.vector())), exp_so3(&(3.0 * random.vector())));
            let u = b * Matrix3::from_diagonal(&Vector3::new(smallest, 1.0, 0.8)) * b.transpose();
            let found = polar_rotation(&(size * r * u)).ok_or("no rotation")?;
            // A carries ε, and what has the smallest stretch is turned by ε over it.
            worst.compare_against(found.iter().copied(), r.iter().copied(), 1.0 / smallest);
        }
    }
    let reason = "45 ε over the smallest stretch: rounding of M, and of its inverse in the first step";
    checks.below(Kind::ClosedForm, "R of R U, times the smallest stretch", worst.0, 1e-14, reason);
    let flat = |height: f64| Matrix3::from_diagonal(&Vector3::new(1.0, height, 1.0));
    // det/‖M‖³ is h/√8.
    let none = [
        flat(2.7e-12),
        flat(0.0),
        -Matrix3::identity(),
        flat(-1.0),
        Matrix3::zeros(),
        Matrix3::from_element(f64::NAN),
        1e-120 * flat(2.7e-12),
        1e120 * flat(2.7e-12),
    ];
    let found = none.iter().filter(|m| polar_rotation(m).is_some()).count();
    checks.absolute(
        Kind::ClosedForm,
        "rotations of what has none",
        (found as f64, 0.0),
        0.0,
        "det M ≤ 1e-12 ‖M‖³, or no number",
    );
    let some = [flat(3.0e-12), 1e-120 * flat(3.0e-12), 1e120 * flat(3.0e-12)];
    let found = some.iter().filter(|m| polar_rotation(m).is_some()).count();
    checks.absolute(
        Kind::ClosedForm,
        "rotations just above",
        (found as f64, 3.0),
        0.0,
        "det M = 1.06e-12 ‖M‖³",
    );
    Ok(())
}
