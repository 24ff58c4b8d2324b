//! The reference without finite elements is itself held against another that a script made in Python.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::{bend_45, cantilever, convergence_orders, princeton, spring};
use crate::continuous::{Cantilever, Station};
use crate::placement::placements;
use crate::tip::Exact;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "continuous::other_tips",
            "the same equations by collocation and by multiple shooting, scripts/references/static_rods.py",
            other_tips,
        )
        .reads(&[
            cantilever::TIPS,
            bend_45::LOADS,
            bend_45::SLENDERNESS,
            princeton::TIPS,
            spring::WIRE_END,
            convergence_orders::TIPS,
        ]),
    ]
}

/// A square section of width w with torsion constant J.
fn square(young: f64, shear: f64, width: f64, torsion_constant: Option<f64>) -> ([f64; 3], [f64; 3]) {
    let (area, second) = (width * width, width.powi(4) / 12.0);
    let torsion = shear * torsion_constant.unwrap_or(2.0 * second);
    ([young * area, shear * area, shear * area], [torsion, young * second, young * second])
}

fn check(checks: &mut Checks, name: String, rod: &Cantilever, exact: &Exact) -> Outcome {
    const ACCURACY: f64 = 1e-10;
    const RESOLVED: &str = "required of a reference; the order is 6: the finer resolution is 64 times better than the \
                            change";
    for placement in placements(rod.length) {
        let mut placed = rod.clone();
        placed.clamp.position = placement.shift + placement.rotation * rod.clamp.position;
        placed.clamp.rotation = placement.rotation * rod.clamp.rotation;
        placed.force = (placement.rotation * Vector3::from(rod.force)).into();
        let shape = placed.solve(1)?;
        let last = shape.stations.last().ok_or("no stations")?;
        let name = format!("{name}, {}", placement.name);
        for (what, change) in [("positions/L", shape.position_change), ("rotations", shape.rotation_change)] {
            checks.below(
                Kind::Invariant,
                format!("{name}: change of {what} by twice the steps"),
                change,
                ACCURACY,
                RESOLVED,
            );
        }
        checks.vector(
            Kind::ClosedForm,
            name,
            (placement.undo_position(last.position).into(), exact.tip),
            exact.digits + ACCURACY * rod.length,
            "the accuracy of both",
        );
    }
    Ok(())
}

fn other_tips(checks: &mut Checks) -> Outcome {
    roll_up(checks)?;
    cantilever_tips(checks)?;
    bend_tips(checks)?;
    princeton_tips(checks)?;
    spring_tips(checks)?;
    for (slenderness, exact) in convergence_orders::tips(checks)? {
        let rod = convergence_orders::continuous(slenderness);
        let name = format!("convergence problem, slenderness {slenderness:.0e}");
        check(checks, name, &rod, &exact)?;
    }
    Ok(())
}

fn roll_up(checks: &mut Checks) -> Outcome {
    let rod = Cantilever {
        length: 1.0,
        force_stiffness: [1e3, 4e2, 4e2],
        moment_stiffness: [0.5, 1.0, 1.0],
        reference_curvature: [0.0; 3],
        clamp: Station::default(),
        force: [0.0; 3],
        body_moment: [0.0, 0.0, FRAC_PI_2],
    };
    let tip = [1.0 / FRAC_PI_2, 1.0 / FRAC_PI_2, 0.0];
    let exact = Exact { tip, digits: 0.0, length: 1.0, allowance: 0.0 };
    check(checks, "quarter circle".into(), &rod, &exact)
}

fn cantilever_tips(checks: &mut Checks) -> Outcome {
    let length = cantilever::LENGTH;
    for (words, alpha_squared, exact) in cantilever::tips(checks)? {
        let rod = Cantilever {
            length,
            force_stiffness: [5.0, 1.0, 1.0],
            moment_stiffness: [1.0, cantilever::BENDING, cantilever::BENDING],
            reference_curvature: [0.0; 3],
            clamp: Station::default(),
            force: [0.0, cantilever::force(alpha_squared), 0.0],
            body_moment: [0.0; 3],
        };
        check(checks, format!("cantilever, α² = {words}"), &rod, &exact)?;
    }
    Ok(())
}

fn bend_tips(checks: &mut Checks) -> Outcome {
    let mut rows = bend_45::loads(checks)?;
    rows.extend(bend_45::ladder(checks)?);
    for row in rows {
        let young = bend_45::YOUNG;
        let (force_stiffness, moment_stiffness) = square(young, 0.5 * young, row.width, row.torsion_constant);
        let rod = Cantilever {
            length: bend_45::LENGTH,
            force_stiffness,
            moment_stiffness,
            reference_curvature: [0.0, 0.0, 1.0 / bend_45::RADIUS],
            clamp: Station::default(),
            force: [0.0, 0.0, row.force],
            body_moment: [0.0; 3],
        };
        let name = format!("45° bend, F = {:e}, J {:?}", row.force, row.torsion_constant);
        check(checks, name, &rod, &row.exact)?;
    }
    Ok(())
}

fn princeton_tips(checks: &mut Checks) -> Outcome {
    use princeton::{HEIGHT, LENGTH, POISSON, WIDTH, YOUNG, force, tips, torsion_constant};
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let area = WIDTH * HEIGHT;
    for (degrees, exact) in tips(checks)? {
        let rod = Cantilever {
            length: LENGTH,
            force_stiffness: [YOUNG * area, shear * area, shear * area],
            moment_stiffness: [
                shear * torsion_constant(),
                YOUNG * area * HEIGHT.powi(2) / 12.0,
                YOUNG * area * WIDTH.powi(2) / 12.0,
            ],
            reference_curvature: [0.0; 3],
            clamp: Station::default(),
            force: force(degrees),
            body_moment: [0.0; 3],
        };
        let name = format!("Princeton beam, β = {degrees}°");
        check(checks, name, &rod, &exact)?;
    }
    Ok(())
}

/// The helical spring: 63 rad of reference, κ⁰ with twist.
fn spring_tips(checks: &mut Checks) -> Outcome {
    const YOUNG: f64 = 1e11;
    const SHEAR: f64 = YOUNG / 2.4;
    let (coils, radius, diameter) = (10.0, 10e-3, 1e-3_f64);
    let slope: f64 = 5e-3 / (TAU * radius);
    let stretch = 1.0_f64.hypot(slope);
    let (area, second) = (PI * diameter.powi(2) / 4.0, PI * diameter.powi(4) / 64.0);
    let start = Vector3::new(0.0, -radius, 0.0);
    let frame = Matrix3::from_columns(&[
        Vector3::new(1.0, 0.0, slope) / stretch,
        Vector3::y(),
        Vector3::new(-slope, 0.0, 1.0) / stretch,
    ]);
    let length = TAU * coils * radius * stretch;
    let end = start + Vector3::z() * (TAU * coils * slope * radius);
    // More load than that asks for multiple shooting: the clamp moment's effect on the tip grows exponentially.
    for row in checks.reference(spring::WIRE_END)?.rows() {
        let force = row.number("force")?;
        if force > 1.0 {
            continue;
        }
        let rod = Cantilever {
            length,
            force_stiffness: [YOUNG * area, SHEAR * area, SHEAR * area],
            moment_stiffness: [2.0 * SHEAR * second, YOUNG * second, YOUNG * second],
            reference_curvature: [
                slope / (radius * stretch * stretch),
                0.0,
                1.0 / (radius * stretch * stretch),
            ],
            clamp: Station { position: start, rotation: UnitQuaternion::from_matrix(&frame) },
            force: [0.0, 0.0, force],
            body_moment: [0.0; 3],
        };
        let exact = Exact::of(&row, length, 0.0)?.displaced(end.into());
        check(checks, format!("helical spring, {force} N"), &rod, &exact)?;
    }
    Ok(())
}
