//! Masses and moments of inertia of the bob and of the wire.

use cosserat::Model;
use cosserat::scene::Statics;

use super::{DENSITY, GRAVITY, Pendulum, bob_mass, places, wire_length};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::solve;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new(
        "wilberforce::masses",
        "closed forms of a cylinder and a helical wire; the figures of the authors' program",
        masses,
    )]
}

const DIGITS: &str = "half a unit of the last printed digit, relative";
const ROUNDING: &str = "a dozen roundings";

fn masses(checks: &mut Checks) -> Outcome {
    let scene = Pendulum::paper().statics(Statics::default());
    let model = Model::new(&scene)?;
    let bob = model.bodies().next().ok_or("no body")?;
    let (mass, inertia) = (bob.mass.mass, bob.mass.inertia);
    let digits = 0.5e-13 / 0.46;
    checks.relative(Kind::CrossCode, "mass of the bob [kg]", (mass, 0.4696536503855), digits, DIGITS);
    let digits = 0.5e-14 / 1.1e-4;
    checks.relative(Kind::CrossCode, "I_zz [kg m²]", (inertia.z, 1.2422339053e-4), digits, DIGITS);
    for value in [inertia.x, inertia.y] {
        checks.relative(Kind::CrossCode, "I_xx, I_yy [kg m²]", (value, 1.1283428951e-4), digits, DIGITS);
    }
    checks.relative(Kind::ClosedForm, "ρ π r² h [kg]", (mass, bob_mass()), 1e-14, ROUNDING);
    let across = bob_mass() * (3.0 * 23e-3_f64.powi(2) + 36e-3_f64.powi(2)) / 12.0;
    checks.relative(Kind::ClosedForm, "m (3r² + h²)/12 [kg m²]", (inertia.x, across), 1e-14, ROUNDING);

    // The wire's mass is what the clamp carries besides the bob, if the wire has weight as well.
    for placement in places() {
        let mut scene = Pendulum::new(12, 6).statics(Statics::default());
        scene.rod[0].gravity = true;
        let solution = solve(&placement.apply(&scene))?;
        let row = solution.rows.last().ok_or("no rows")?;
        let [x, y, z, ..] = row.reactions[0];
        let carried = placement.undo_direction([x, y, z].into()).z.abs() / GRAVITY;
        let exact = DENSITY * std::f64::consts::PI * 0.25e-6 * wire_length();
        checks.absolute(
            Kind::ClosedForm,
            format!("mass of the wire, by its weight [kg], {}", placement.name),
            (carried - bob_mass(), exact),
            1e-9,
            "residuals of 1e-9 of 4.6 N at the end, divided by g, twice; the length of an element of 90° and degree \
             6 is wrong by (π/2)¹²/12! = 5e-7 of its part at most, 1e-9 kg",
        );
        checks.absolute(
            Kind::CrossCode,
            format!("mass of the wire [g], {}", placement.name),
            (1e3 * (carried - bob_mass()), 1.8595),
            0.5e-4 + 1e-6,
            "half a unit of the last printed digit",
        );
    }
    Ok(())
}
