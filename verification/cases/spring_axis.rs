//! The spring pulled on its axis, through a rigid lever from the end of the wire: the load case of the textbooks.

use super::spring::{
    AREA, COILS, DIAMETER, PITCH, RADIUS, SECOND_MOMENT, SHEAR, Spring, YOUNG, places, slope, wire_length,
};
use crate::case::{Case, Checks, Kind, Outcome};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "spring_axis::values",
            "continuous rod equations, scripts/references/static_rods.py",
            values,
        )
        .slow()
        .reads(&[AXIS]),
        Case::new("spring_axis::initial_stiffness", "Castigliano; Berg & Marshall 1991", initial_stiffness),
    ]
}

/// 5e-4 m/N times 1e-9 of 100 N, ten times [m].
const SOLVER: f64 = 5e-10;
const AXIS: &str = "continuous/static_spring_axis.csv";

/// Secant stiffnesses and the displacement at 100 N.
fn values(checks: &mut Checks) -> Outcome {
    let table = checks.reference(AXIS)?;
    let mut secants = Vec::new();
    for row in table.rows() {
        let [force, z, accuracy] = row.numbers("force z position_accuracy")?;
        secants.push((force, force / z, accuracy / z));
    }
    let (large, secant, accuracy) = secants.pop().ok_or("the file has no rows")?;
    let exact = large / secant;
    for placement in places() {
        for &(force, exact, _) in &secants {
            let mut spring = Spring::axial(force, 48, 6);
            if force < 0.01 {
                // As at the end of the wire: the default test's rounding floor is no small part of this load.
                spring.statics.tolerance = Some(1e-9);
            }
            let secant = force / spring.displacement(&placement)?.z;
            checks.relative(
                Kind::ClosedForm,
                format!("secant stiffness at {force} N [N/m], {}", placement.name),
                (secant, exact),
                1e-8,
                "mesh 1e-9, as at the end of the wire; solver 1e-9 of the load at several nodes",
            );
        }
        let displacement = |elements| Spring::axial(large, elements, 6).displacement(&placement);
        let [coarse, fine] = [displacement(48)?.z, displacement(60)?.z];
        checks.absolute(
            Kind::ClosedForm,
            format!("u_z at 100 N [m], {}", placement.name),
            (fine, exact),
            accuracy * exact + SOLVER + (fine - coarse).abs() / 2.8,
            "the reference's accuracy; solver 1e-9 of the load at several nodes, compliance 5e-4 m/N; mesh: at order p, as the layers at the ends are as short as an element, (60/48)^6 − 1 = 2.8 times below the change from 48",
        );
    }
    Ok(())
}

/// c of 1/c = L R² (cos²α/GI_p + sin²α/EI) + L (cos²α/GA + sin²α/EA). Exact for the tangent at no load: with the
/// force on the axis the resultants are the same all along the wire.
fn castigliano(pitch: f64) -> f64 {
    let sine = slope(pitch) / 1.0_f64.hypot(slope(pitch));
    let (sine, cosine) = (sine * sine, 1.0 - sine * sine);
    let levers = cosine / (2.0 * SHEAR * SECOND_MOMENT) + sine / (YOUNG * SECOND_MOMENT);
    let forces = cosine / (SHEAR * AREA) + sine / (YOUNG * AREA);
    1.0 / (wire_length(pitch) * (RADIUS * RADIUS * levers + forces))
}

/// Castigliano's stiffness, and how the textbook's k = Gd⁴/64nR³ differs from it:
///
/// k/c = 1 + d²/8R² + tan²α (GI_p/EI − ½) + …. The first part is direct shear and stays for any pitch, the second
/// falls with its square.
fn initial_stiffness(checks: &mut Checks) -> Outcome {
    let textbook = SHEAR * DIAMETER.powi(4) / (64.0 * COILS * RADIUS.powi(3));
    let direct_shear = DIAMETER * DIAMETER / (8.0 * RADIUS * RADIUS);
    for placement in places() {
        let name = placement.name;
        let mut rests = Vec::new();
        for pitch in [PITCH, PITCH / 2.0, PITCH / 4.0] {
            let mut spring = Spring { pitch, ..Spring::axial(1e-3, 48, 6) };
            spring.statics.tolerance = Some(1e-9);
            let stiffness = spring.initial_stiffness(&placement)?;
            checks.relative(
                Kind::ClosedForm,
                format!("tangent stiffness at no load, pitch {pitch} m [N/m], {name}"),
                (stiffness, castigliano(pitch)),
                1e-7,
                "cubic term of ±1e-3 N 1e-8 (a millionth of the 1e-2 between ±1 N), mesh 1e-8, rounding 5e-8",
            );
            rests.push(textbook / stiffness - 1.0 - direct_shear);
        }
        checks.order(
            format!("textbook − Castigliano − direct shear over the pitch, {name}"),
            &[1, 2, 4],
            &rests,
            (2.0, 0.01),
            "next power is 4: tan²α = 1.6e-3 at the middle pitch, times 3/4 of a factor of order one, over ln 2",
        );
        checks.relative(
            Kind::ClosedForm,
            format!("its factor tan²α (GI_p/EI − 1/2), {name}"),
            (
                rests[2] / slope(PITCH / 4.0).powi(2),
                2.0 * SHEAR / YOUNG - 0.5,
            ),
            2e-3,
            "d²/8R² = 1.25e-3 of it by the shear's own share, tan²α = 4e-4, and 1e-7 of 1.3e-4 from the stiffness",
        );
    }
    Ok(())
}
