//! SO(3) and the quaternion map: exponential, logarithm, right tangents, A(P), Q(P), T(P), products.

use cosserat::rotation::{
    exp_so3, log_so3, quaternion_exp, quaternion_product, quaternion_rate, right_jacobian,
    right_jacobian_inverse, rotation_from_quaternion_rate, rotation_matrix,
};
use nalgebra::{Vector3, Vector4};

use super::{
    MATRIX, PINOCCHIO, PINOCCHIO_REASON, Quantity, compare, condition, entries, matrix, smallness, vector,
};
use crate::case::{Case, Checks, Kind, Outcome};

const SOURCE: &str = "Pinocchio 4.1.0 and mpmath, scripts/references/pinocchio_kinematics.py";

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("pinocchio::rotation_exponential", SOURCE, exponential)
            .reads(&["pinocchio/rotation_exponential.csv"]),
        Case::new("pinocchio::rotation_logarithm", SOURCE, logarithm)
            .reads(&["pinocchio/rotation_logarithm.csv"]),
        Case::new("pinocchio::rotation_tangents", SOURCE, tangents)
            .reads(&["pinocchio/rotation_tangents.csv"]),
        Case::new("pinocchio::quaternions", SOURCE, quaternions).reads(&["pinocchio/quaternions.csv"]),
        Case::new("pinocchio::weak_ranges", SOURCE, weak_ranges).reads(&WEAK),
    ]
}

const WEAK: [&str; 5] = [
    "pinocchio/weak_ranges.csv",
    "pinocchio/rotation_logarithm.csv",
    "pinocchio/rotation_tangents.csv",
    "pinocchio/motion_logarithm.csv",
    "pinocchio/motion_tangents.csv",
];

/// No figure of Pinocchio's is used where it was found to lose more digits than its rows are said to be good for.
fn weak_ranges(checks: &mut Checks) -> Outcome {
    let [weak, files @ ..] = WEAK;
    let weak = checks.reference(weak)?;
    let maps = [Some("log3"), None, Some("log6"), None];
    for (file, map) in files.into_iter().zip(maps) {
        let table = checks.reference(file)?;
        let (mut weakest, mut ranges) = (0.0_f64, 0);
        for row in table.select(&[("by", "pinocchio")])? {
            let map = map.map_or_else(|| row.word("map"), Ok)?;
            let found = weak.row(&[("map", map), ("range", row.word("range")?)])?;
            weakest = weakest.max(found.number("error")?);
            ranges += 1;
        }
        checks.above(
            Kind::Invariant,
            format!("{file}: rows of Pinocchio's"),
            f64::from(ranges),
            100.0,
            "it is used",
        );
        checks.below(
            Kind::CrossCode,
            format!("{file}: Pinocchio's error where it is used, against 50 digits"),
            weakest,
            PINOCCHIO,
            PINOCCHIO_REASON,
        );
    }
    Ok(())
}

fn exponential(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/rotation_exponential.csv")?;
    let quantities = [
        Quantity {
            name: "exp ψ̃, over 1 + θ/4, off the diagonal over θ < 1",
            rounding: 10.0,
            reason: "10 ε: ½θ carries 1.25 ε and turns by that; a quaternion's parts carry 2 ε, entries are sums of \
                     two doubled products of them",
        },
        Quantity {
            name: "quaternion of exp ψ̃, over 1 + θ/4, its vector over θ < 1",
            rounding: 4.0,
            reason: "4 ε: the norm, its half, sine, quotient and product round once each, ½ ε; ½θ carries 1.25 ε",
        },
    ];
    compare(checks, table.rows(), "range", quantities, |row| {
        let psi = vector(row, "x y z")?;
        let angle = psi.norm();
        let (small, size) = (smallness(row, angle)?, 1.0 + 0.25 * angle);
        let [w, x, y, z] = row.numbers::<4>("w i j k")?;
        let ours = quaternion_exp(&psi);
        let part = (ours.fixed_rows::<3>(1) - Vector3::new(x, y, z)).amax() / small;
        let turned = entries(&exp_so3(&psi), &matrix(row, MATRIX)?, small);
        Ok((angle, [turned / size, (ours[0] - w).abs().max(part) / size]))
    })
}

fn logarithm(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/rotation_logarithm.csv")?;
    let quantities = [Quantity {
        name: "log A, over θ",
        rounding: 12.0,
        reason: "12 ε: the matrix is off the nearest rotation by ½ ε an entry, its quaternion by 2 ε more, and the \
                 logarithm at most π/2 times that, in √3 components",
    }];
    compare(checks, table.rows(), "range", quantities, |row| {
        let reference = vector(row, "x y z")?;
        let angle = reference.norm();
        let error = (log_so3(&matrix(row, MATRIX)?) - reference).norm();
        Ok((angle, [error / (angle.max(1.0) * smallness(row, angle)?)]))
    })
}

fn tangents(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/rotation_tangents.csv")?;
    let quantities = [Quantity {
        name: "J_r(ψ), off the diagonal over θ < 1",
        rounding: 8.0,
        reason: "8 ε: the coefficients' numerators (1 − cos θ, θ − sin θ) carry 2 ε to 3 ε beyond θ = 1, where they \
                 are formed, times matrices of size θ, θ² over θ², θ³; products and sums add 2 ε",
    }];
    compare(checks, table.select(&[("map", "Jexp3")])?, "range", quantities, |row| {
        let psi = vector(row, "x y z")?;
        let angle = psi.norm();
        let small = smallness(row, angle)?;
        Ok((angle, [entries(&right_jacobian(&psi), &matrix(row, MATRIX)?, small)]))
    })?;
    let quantities = [Quantity {
        name: "J_r(ψ)⁻¹, over 1 + x²/sin² x, x = θ/2, off the diagonal over θ < 1",
        rounding: 8.0,
        reason: "8 ε: θ carries 1.25 ε, x cot x has the derivative x²/sin² x for a relative change of x; series, \
                 products and sums add 4 ε",
    }];
    compare(checks, table.select(&[("map", "Jlog3")])?, "range", quantities, |row| {
        let psi = vector(row, "x y z")?;
        let angle = psi.norm();
        let small = smallness(row, angle)?;
        let size = 1.0 + condition(angle).powi(2);
        Ok((angle, [entries(&right_jacobian_inverse(&psi), &matrix(row, MATRIX)?, small) / size]))
    })
}

/// Of any norm between 1e-150 and 1e151.
fn quaternions(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/quaternions.csv")?;
    let reason = "a product of components rounds by ½ ε, a sum of four by 1½ ε more; the norm's square and its \
                  quotient by as much again";
    let quantities = [
        Quantity { name: "A(P)", rounding: 10.0, reason },
        Quantity { name: "P ∘ Q, over |P| |Q|", rounding: 4.0, reason },
        Quantity { name: "Q(P) ω, over |P| |ω|", rounding: 4.0, reason },
        Quantity { name: "T(P) δP, over |δP|/|P|", rounding: 8.0, reason },
    ];
    compare(checks, table.rows(), "size", quantities, |row| {
        let four = |columns: &str| row.numbers::<4>(columns).map(Vector4::from);
        let (p, q) = (four("p0 p1 p2 p3")?, four("q0 q1 q2 q3")?);
        let (omega, change) = (vector(row, "omega_x omega_y omega_z")?, four("dp0 dp1 dp2 dp3")?);
        let turned = entries(&rotation_matrix(&p), &matrix(row, MATRIX)?, 1.0);
        let product = quaternion_product(&p, &q) - four("pq0 pq1 pq2 pq3")?;
        let rate = quaternion_rate(&p) * omega - four("rate0 rate1 rate2 rate3")?;
        let turn = rotation_from_quaternion_rate(&p) * change - vector(row, "turn_x turn_y turn_z")?;
        let norm = p.norm();
        Ok((
            norm,
            [
                turned,
                product.norm() / (norm * q.norm()),
                rate.norm() / (norm * omega.norm()),
                turn.norm() / (change.norm() / norm),
            ],
        ))
    })
}
