//! One rigid body: its mass, given one way or the other, and its start.

use super::check::{Check, fail, finite_number, non_zero, positive};
use crate::body::MassProperties;
use crate::scene::{Body, Shape};

const PAIRS: &str = "either `shape` and `density` or `mass` and `inertia`";

/// The relative excess of a moment of inertia over the sum of the others that is put down to the digits written.
const ROUNDING: f64 = 1e-6;

pub(super) fn body(body: &Body, key: &str) -> Check {
    one_pair(body, key)?;
    if let Some(shape) = &body.shape {
        sizes(shape, &format!("{key}.shape"))?;
    }
    if let Some(density) = body.density {
        positive(format!("{key}.density"), density, "a positive density [kg/m³]")?;
    }
    if let Some(mass) = body.mass {
        positive(format!("{key}.mass"), mass, "a positive mass [kg]")?;
    }
    if let Some(inertia) = &body.inertia {
        principal(inertia, &format!("{key}.inertia"))?;
    }
    within_range(body, key)?;
    non_zero(&format!("{key}.orientation"), &body.orientation, "a quaternion other than zero")
}

/// Exactly one of the two ways to give mass and inertia.
fn one_pair(body: &Body, key: &str) -> Check {
    let homogeneous = [("shape", body.shape.is_some()), ("density", body.density.is_some())];
    let given = [("mass", body.mass.is_some()), ("inertia", body.inertia.is_some())];
    let count = |pair: &[(&str, bool); 2]| pair.iter().filter(|(_, present)| *present).count();
    let (kept, surplus) = match (count(&homogeneous), count(&given)) {
        (0, 0) => return fail(key, "gives no mass", PAIRS),
        (0, 2) | (2, 0) => return Ok(()),
        (1, 0) => return partner(&homogeneous, key),
        (0, 1) => return partner(&given, key),
        (1, 2) => (given, homogeneous),
        _ => (homogeneous, given),
    };
    let first = |pair: [(&'static str, bool); 2]| if pair[0].1 { pair[0].0 } else { pair[1].0 };
    fail(format!("{key}.{}", first(surplus)), format!("is given together with `{}`", first(kept)), PAIRS)
}

/// What is missing of a pair of which one is given.
fn partner(pair: &[(&str, bool); 2], key: &str) -> Check {
    let [(present, _), (missing, _)] = if pair[0].1 { *pair } else { [pair[1], pair[0]] };
    let expected = match missing {
        "shape" => "a shape such as `{ kind = \"sphere\", radius = 0.1 }`",
        "density" => "a positive density [kg/m³]",
        "mass" => "a positive mass [kg]",
        _ => "three principal moments of inertia `[x, y, z]` [kg m²]",
    };
    fail(format!("{key}.{missing}"), format!("is missing beside `{present}`"), expected)
}

fn sizes(shape: &Shape, key: &str) -> Check {
    match shape {
        Shape::Cylinder { radius, height } => {
            positive(format!("{key}.radius"), *radius, "a positive radius [m]")?;
            positive(format!("{key}.height"), *height, "a positive height [m]")
        }
        Shape::Cuboid { size } => size.iter().enumerate().try_for_each(|(index, edge)| {
            positive(format!("{key}.size.{index}"), *edge, "a positive edge [m]")
        }),
        Shape::Sphere { radius } => positive(format!("{key}.radius"), *radius, "a positive radius [m]"),
    }
}

/// I_x ≤ I_y + I_z and so on: I_y + I_z − I_x = 2 ∫ x² dm, which no mass makes negative.
fn principal(inertia: &[f64; 3], key: &str) -> Check {
    for (index, moment) in inertia.iter().enumerate() {
        positive(format!("{key}.{index}"), *moment, "a positive moment of inertia [kg m²]")?;
    }
    for (index, moment) in inertia.iter().enumerate() {
        let others = inertia[(index + 1) % 3] + inertia[(index + 2) % 3];
        if *moment > others * (1.0 + ROUNDING) {
            return fail(
                format!("{key}.{index}"),
                format!(
                    "is {}, more than the other two together, {}, which no body has",
                    finite_number(*moment),
                    finite_number(others)
                ),
                "at most their sum, which a flat plate reaches",
            );
        }
    }
    Ok(())
}

/// Finite and positive, also where sizes and density are each but their products are not.
fn within_range(body: &Body, key: &str) -> Check {
    let Some(MassProperties { mass, inertia }) = MassProperties::new(body) else {
        return Ok(());
    };
    if mass.is_normal() && inertia.iter().all(|moment| moment.is_normal()) {
        return Ok(());
    }
    fail(
        key,
        format!("has a mass or inertia beyond all numbers: {mass:?} kg, {:?} kg m²", inertia.as_slice()),
        if body.shape.is_some() {
            "sizes and a density whose products are positive and finite"
        } else {
            "a mass and moments of inertia of ordinary size"
        },
    )
}
