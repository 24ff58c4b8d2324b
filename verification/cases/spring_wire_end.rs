//! The spring pulled at the end of the wire, as in section 4.1: the force is eccentric by the coil radius, so the
//! spring first tilts, then opens, and at the end only the wire stretches.

use std::error::Error;
use std::f64::consts::PI;

use cosserat::scene::{LoadTime, NodeSpacing, Statics};
use nalgebra::Vector3;

use super::spring::{
    AREA, COILS, DIAMETER, PITCH, POISSON, RADIUS, SECOND_MOMENT, SHEAR, Spring, WIRE_END, WireEnd, YOUNG,
    places, slope, wire_end, wire_length,
};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::solve;
use crate::placement::Placement;

const SOURCE: &str =
    "Harsch & Eugster, section 4.1; continuous rod equations, scripts/references/static_rods.py";

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("spring_wire_end::values", SOURCE, values).reads(&[WIRE_END]).slow(),
        Case::new("spring_wire_end::order", SOURCE, order).reads(&[WIRE_END]).slow(),
        Case::new(
            "spring_wire_end::discrete",
            "a prototype of the same element, 75 elements, p = 2",
            discrete,
        ),
        Case::new(
            "spring_wire_end::initial_stiffness",
            "Castigliano; Harsch & Eugster, section 4.1; Berg & Marshall 1991",
            initial_stiffness,
        ),
        Case::new(
            "spring_wire_end::final_slope",
            "boundary layer of a stretched rod at its clamp, Timoshenko–Reissner; derivation in the case",
            final_slope,
        )
        .slow(),
    ]
}

/// All seven loads, with the error of the mesh by a coarser one.
fn values(checks: &mut Checks) -> Outcome {
    let table = checks.reference(WIRE_END)?;
    for row in table.rows() {
        let exact: [f64; 3] = row.numbers("x y z")?;
        let [force, accuracy] = row.numbers("force position_accuracy")?;
        let mut spring = Spring::new(force, 60, 6);
        if force < 0.01 {
            // The unit-free test may stop at its rounding floor, 2e-8 N here: too much of a load of 1e-3 N.
            // Actual rounding is near 5e-10 N, and acts in self-equilibrated pairs.
            spring.statics.tolerance = Some(1e-9);
        }
        let coarser = Spring { elements: 48, ..spring.clone() };
        let norm = Vector3::from(exact).norm();
        for placement in places() {
            let tip = spring.displacement(&placement)?;
            let change = (coarser.displacement(&placement)? - tip).norm();
            checks.vector(
                Kind::ClosedForm,
                format!("displacement at {force} N, {}", placement.name),
                (tip.into(), exact),
                3.0_f64.sqrt() * accuracy + 1e-9 * norm + change / 2.8,
                "the reference's accuracy; solver 1e-9 of the load, of which the displacement is no more than \
                 proportional; mesh: at order p, as at 100 N the layers at the ends are as short as an element, \
                 (60/48)^6 − 1 = 2.8 times below the change from 48",
            );
            checks.below(
                Kind::Invariant,
                format!("change from 48 elements at {force} N, {}", placement.name),
                change / norm,
                5.1e-8,
                "order 2p = 12: (κh)¹²/12! for 75° of a coil; at 100 N (h/λ)¹²/12! = 4e-6 in the layers of λ = √(EI/F), 1 % of \
                 the wire",
            );
        }
    }
    Ok(())
}

/// Spacing, degree, meshes, expected order, and the error of one of the meshes at 10 N [mm] that a prototype
/// printed.
type Ladder = (NodeSpacing, usize, [usize; 3], f64, (usize, f64));

/// The coarsest mesh of each ladder turns by half a radian or less from node to node, which is where the orders
/// settle (they come from below); the finest keeps its error above 3e-9 m, a thousand times the accuracy of
/// the exact vectors (1e-12 m) and far above what a residual of 1e-9 of the load moves (1e-10 m).
const LADDERS: [Ladder; 8] = [
    (NodeSpacing::GaussLobatto, 1, [150, 300, 600], 2.0, (300, 0.2814)),
    (NodeSpacing::GaussLobatto, 2, [75, 150, 300], 4.0, (150, 2.860e-3)),
    (NodeSpacing::GaussLobatto, 3, [40, 60, 80], 6.0, (80, 2.512e-4)),
    (NodeSpacing::GaussLobatto, 4, [30, 40, 60], 8.0, (60, 1.988e-5)),
    (NodeSpacing::GaussLobatto, 5, [25, 30, 40], 10.0, (30, 1.774e-4)),
    (NodeSpacing::Equal, 3, [40, 80, 160], 4.0, (160, 4.340e-4)),
    (NodeSpacing::Equal, 4, [20, 40, 80], 6.0, (80, 8.536e-5)),
    (NodeSpacing::Equal, 5, [40, 60, 80], 6.0, (80, f64::NAN)),
];

/// End values superconverge: 2p with Gauss–Lobatto nodes, p + 2 or p + 1 (even, odd p) with even spacing.
fn order(checks: &mut Checks) -> Outcome {
    let loads = wire_end(checks)?;
    for (spacing, degree, meshes, expected, (printed_mesh, printed)) in LADDERS {
        for &WireEnd { force, exact, .. } in loads.iter().filter(|load| (0.5..=10.0).contains(&load.force)) {
            for placement in places() {
                let mut errors = Vec::new();
                for elements in meshes {
                    let spring = Spring { spacing, ..Spring::new(force, elements, degree) };
                    errors.push((spring.displacement(&placement)? - Vector3::from(exact)).norm());
                }
                let title = format!("{spacing:?}, p = {degree}, {force} N, {}", placement.name);
                checks.order(
                    title.clone(),
                    &meshes,
                    &errors,
                    (expected, 0.5),
                    "half an order tells it from every other whole one",
                );
                let printed_error = meshes
                    .iter()
                    .zip(&errors)
                    .find_map(|(mesh, error)| (*mesh == printed_mesh).then_some(1e3 * error));
                if let (10.0, true, Some(error)) = (force, printed.is_finite(), printed_error) {
                    checks.relative(
                        Kind::CrossCode,
                        format!("{title}, {printed_mesh} elements: error [mm]"),
                        (error, printed),
                        1.5e-3,
                        "half of the fourth digit, 5e-4, and the exact vector's own last digit, 5e-12 m of 2e-8 m",
                    );
                }
            }
        }
    }
    Ok(())
}

/// A mesh's own numbers, to every digit that another program printed.
fn discrete(checks: &mut Checks) -> Outcome {
    let printed = [
        ("wire end", false, [5.74843206e-3, 5.32173433e-3, 572.03427875e-3]),
        ("axis", true, [5.74906121e-3, -4.68008151e-3, 577.36968109e-3]),
    ];
    for (title, on_axis, expected) in printed {
        for placement in places() {
            let spring = Spring {
                on_axis,
                statics: Statics { tolerance: Some(1e-8), ..Statics::default() },
                ..Spring::new(100.0, 75, 2)
            };
            checks.vector(
                Kind::CrossCode,
                format!("75 elements, p = 2, 100 N, {title}, {}", placement.name),
                (spring.displacement(&placement)?.into(), expected),
                2e-11,
                "three components rounded by 5e-12 m; a residual of 1e-8 N times the compliance here, 5e-4 m/N: 5e-12 m",
            );
        }
    }
    Ok(())
}

/// 1/c = ∫ (M_x²/GI_p + (M_y² + M_z²)/EI + N²/EA + V²/GA) ds for a unit force at the end of the wire, exact for the
/// helix: with whole coils the lever's mean squares are M = R (cos α (1 − cos φ), sin φ, −sin α (1 − cos φ)) →
/// R² (3/2 cos²α, 1/2, 3/2 sin²α).
fn castigliano() -> f64 {
    let sine = slope(PITCH) / 1.0_f64.hypot(slope(PITCH));
    let (sine, cosine) = (sine * sine, 1.0 - sine * sine);
    let (bending, torsion) = (YOUNG * SECOND_MOMENT, 2.0 * SHEAR * SECOND_MOMENT);
    let levers = 1.5 * cosine / torsion + (0.5 + 1.5 * sine) / bending;
    let forces = cosine / (SHEAR * AREA) + sine / (YOUNG * AREA);
    1.0 / (wire_length(PITCH) * (RADIUS * RADIUS * levers + forces))
}

/// The spring starts at half the stiffness of the textbook, and reaches it as a secant near 7.7 N.
fn initial_stiffness(checks: &mut Checks) -> Outcome {
    let textbook = SHEAR * DIAMETER.powi(4) / (64.0 * COILS * RADIUS.powi(3));
    for placement in places() {
        let name = placement.name;
        let mut spring = Spring::new(1e-3, 48, 6);
        spring.statics.tolerance = Some(1e-9);
        let rough = spring.initial_stiffness(&placement)?;
        let secant = spring.force / spring.displacement(&placement)?.z;
        spring.force = 1e-4;
        let stiffness = spring.initial_stiffness(&placement)?;
        checks.relative(
            Kind::ClosedForm,
            format!("tangent stiffness at no load [N/m], {name}"),
            (stiffness, castigliano()),
            ((rough - stiffness) / stiffness).abs() / 99.0 + 5e-8,
            "the difference's cubic term, a hundredth of that at 1e-3 N; mesh and rounding 5e-8",
        );
        // 33.923 N/m is this secant, not the tangent: the spring tilts so fast that 1e-3 N already add 0.17 %.
        checks.absolute(
            Kind::CrossCode,
            format!("secant stiffness at 1e-3 N [N/m], {name}"),
            (secant, 33.923),
            5e-4,
            "half of the last printed digit",
        );
        let bending = YOUNG * SECOND_MOMENT;
        let small_pitch = bending / (2.0 * PI * COILS * RADIUS.powi(3) * (1.5 * (1.0 + POISSON) + 0.5));
        checks.relative(
            Kind::ClosedForm,
            format!("the same for a small pitch [N/m], {name}"),
            (stiffness, small_pitch),
            slope(PITCH).powi(2),
            "it neglects 0.37 tan²α by the pitch and 0.10 tan²α by direct shear",
        );
        let mut secants = Vec::new();
        for force in [7.65, 7.75] {
            secants.push(force / Spring::new(force, 48, 6).displacement(&placement)?.z);
        }
        let crossing = 7.65 + 0.1 * (textbook - secants[0]) / (secants[1] - secants[0]);
        checks.absolute(
            Kind::CrossCode,
            format!("force at which the secant is Gd⁴/64nR³ [N], {name}"),
            (crossing, 7.7),
            0.05,
            "half of the last printed digit",
        );
    }
    Ok(())
}

/// Under a large force the wire is straight but for layers of the thickness λ = √(EI/F) at its ends. Across the
/// one at the clamp its tangent turns from θ₀ to the force. With β = 1/GA − 1/EA the energy of that layer is
///
/// W = ∫₀^θ₀ √(2EI (F (1 − cos θ) − ½ β F² sin²θ)) dθ,   u = L (1 + F/EA) − W′(F) + …,
///
/// so that du/dF = L/EA − W″ + …. The reference curvature κ⁰ bends the layers further: the free end's adds
/// ⅜ (κ⁰)² λ³/F (planar, small angle), and the clamp's as much in order of magnitude.
fn layer_compliance(force: f64) -> f64 {
    let (bending, beta) = (YOUNG * SECOND_MOMENT, 1.0 / (SHEAR * AREA) - 1.0 / (YOUNG * AREA));
    let turn = 0.5 * PI - slope(PITCH).atan();
    // Midpoints: √(…) is θ times a smooth even function, the error of 2000 points below 1e-6.
    let energy = |f: f64| {
        let steps = 2000;
        let angle = |k: usize| turn * (k as f64 + 0.5) / steps as f64;
        let density = |t: f64| f * (1.0 - t.cos()) - 0.5 * beta * f * f * t.sin().powi(2);
        let sum: f64 = (0..steps).map(|k| (2.0 * bending * density(angle(k))).sqrt()).sum();
        sum * turn / steps as f64
    };
    let d = 0.02 * force;
    let curvature = (energy(force + d) - 2.0 * energy(force) + energy(force - d)) / (d * d);
    let reference = reference_layer(force);
    -curvature + 0.375 * reference
}

/// (κ⁰)² λ³/F.
fn reference_layer(force: f64) -> f64 {
    let curvature = 1.0 / (RADIUS * (1.0 + slope(PITCH).powi(2)));
    curvature.powi(2) * (YOUNG * SECOND_MOMENT / force).powf(1.5) / force
}

/// u_z at growing forces on one path.
fn passing(forces: &[f64], placement: &Placement) -> Result<Vec<f64>, Box<dyn Error>> {
    // Elements of 4 mm, degree 6: nodes closer than λ = 1.1 mm at 3.9 kN.
    let mut scene = Spring::new(1.0, 150, 6).scene();
    // A bend of the course is never stepped over.
    let places: Vec<f64> = (0..=forces.len()).map(|k| k as f64 / forces.len() as f64).collect();
    let course = places.iter().zip([0.0].iter().chain(forces)).map(|(place, force)| [*place, *force]);
    scene.load[0].time = Some(LoadTime::Table(course.collect()));
    let solution = solve(&placement.apply(&scene))?;
    let at = |place: f64| {
        let row = solution.rows.iter().find(|row| row.parameter == place);
        let row = row.ok_or_else(|| format!("no row at {place}"))?;
        Ok(placement.undo_position(Vector3::from(row.probes[0].position)).z - COILS * PITCH)
    };
    places[1..].iter().map(|place| at(*place)).collect()
}

/// The slope of the diagram tends to EA/L.
fn final_slope(checks: &mut Checks) -> Outcome {
    let stretching = wire_length(PITCH) / (YOUNG * AREA);
    let forces = [790_u32, 3900];
    let around = forces.map(|force| [0.998, 1.002].map(|factor| factor * f64::from(force)));
    for placement in places() {
        let name = placement.name;
        let found = passing(around.as_flattened(), &placement)?;
        let mut rests = Vec::new();
        for (k, force) in forces.map(f64::from).into_iter().enumerate() {
            let compliance = (found[2 * k + 1] - found[2 * k]) / (around[k][1] - around[k][0]);
            let predicted = stretching + layer_compliance(force);
            checks.absolute(
                Kind::ClosedForm,
                format!("slope at {force} N over EA/L, {name}"),
                (stretching / compliance, stretching / predicted),
                reference_layer(force) / stretching,
                "the clamp's layer is bent by κ⁰ as much as the free end's, of which ⅜ is counted: (κ⁰)²λ³/F",
            );
            rests.push(compliance - predicted);
        }
        checks.order(
            format!("the rest falls like (κ⁰)²λ³/F ~ F^−5/2, {name}"),
            &forces.map(|force| force as usize),
            &rests,
            (2.5, 0.25),
            "halfway to F^−2 and F^−3; the next term of the expansion is λκ⁰ = 0.25 … 0.11 times this one",
        );
    }
    Ok(())
}
