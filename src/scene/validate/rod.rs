//! One rod: its curve and its discretisation.

use super::check::{Check, MOST, at_least_one, fail, non_zero, positive};
use super::section::{material_of, section};
use crate::scene::{Curve, CurveShape, InterpolationKind, Reference, Rod, Theory};

pub(super) fn rod(rod: &Rod, key: &str) -> Check {
    unavailable(rod, key)?;
    curve(&rod.curve, &format!("{key}.curve"))?;
    section(&rod.section, &format!("{key}.section"))?;
    material_of(rod, &format!("{key}.material"))?;
    mesh(rod, key)?;
    reference(rod, &format!("{key}.reference"))
}

fn unavailable(rod: &Rod, key: &str) -> Check {
    if rod.interpolation == InterpolationKind::Quaternion {
        return fail(
            format!("{key}.interpolation"),
            "is \"quaternion\", which is not available yet",
            "\"r12\" or \"se3\"",
        );
    }
    let theory = match rod.theory {
        Theory::Cosserat => return Ok(()),
        Theory::ShearRigid => "shear-rigid",
        Theory::Inextensible => "inextensible",
    };
    fail(format!("{key}.theory"), format!("is \"{theory}\", which is not available yet"), "\"cosserat\"")
}

fn curve(curve: &Curve, key: &str) -> Check {
    let orientation = format!("{key}.orientation");
    non_zero(&orientation, &curve.orientation, "a quaternion other than zero")?;
    match &curve.shape {
        CurveShape::Line { length, from, to, normal } => line(*length, *from, *to, *normal, key),
        CurveShape::Arc { radius, angle } => {
            positive(format!("{key}.radius"), *radius, "a positive radius [m]")?;
            positive(format!("{key}.angle"), *angle, "a positive angle [rad]")
        }
        // Any pitch will do: negative is left-handed, zero a flat ring.
        CurveShape::Helix { coils, radius, .. } => {
            positive(format!("{key}.coils"), *coils, "a positive number of coils")?;
            positive(format!("{key}.radius"), *radius, "a positive radius [m]")
        }
        CurveShape::Poses { file } if file.as_os_str().is_empty() => fail(
            format!("{key}.file"),
            "is empty",
            "the path of a CSV file with the columns x,y,z,qw,qx,qy,qz",
        ),
        CurveShape::Poses { .. } => Ok(()),
    }
}

fn line(
    length: Option<f64>,
    from: Option<[f64; 3]>,
    to: Option<[f64; 3]>,
    normal: Option<[f64; 3]>,
    key: &str,
) -> Check {
    let (from, to) = match (length, from, to) {
        (Some(length), None, None) => {
            if normal.is_some() {
                return fail(
                    format!("{key}.normal"),
                    "is given together with `length`",
                    "a normal only beside `from` and `to`",
                );
            }
            return positive(format!("{key}.length"), length, "a positive length [m]");
        }
        (None, Some(from), Some(to)) => (from, to),
        (None, Some(_), None) => {
            return fail(format!("{key}.to"), "is missing", "the end `[x, y, z]` [m]");
        }
        (None, None, Some(_)) => {
            return fail(format!("{key}.from"), "is missing", "the start `[x, y, z]` [m]");
        }
        (None, None, None) => {
            return fail(key, "has neither `length` nor `from` and `to`", "one of them");
        }
        (Some(_), _, _) => {
            return fail(
                format!("{key}.length"),
                "is given together with `from` or `to`",
                "either `length` or `from` and `to`",
            );
        }
    };
    let tangent = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    non_zero(&format!("{key}.to"), &tangent, "an end that differs from the start").map_err(|mut error| {
        error.problem = "is the same point as `from`".into();
        error
    })?;
    match normal {
        None => Ok(()),
        Some(normal) => across(&format!("{key}.normal"), &normal, &tangent),
    }
}

/// A normal that can be projected: neither zero nor along the tangent.
fn across(key: &str, normal: &[f64; 3], tangent: &[f64; 3]) -> Check {
    non_zero(key, normal, "a direction other than zero")?;
    let (n, t) = (unit(normal), unit(tangent));
    let cross = [n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]];
    // Closer than this, rounding decides the direction of what is left after the projection.
    if largest(&cross) < 1e-12 {
        return fail(key, "is parallel to the line", "a direction across the line");
    }
    Ok(())
}

/// Scaled by the largest component: a direction of length between 1 and √3, whatever the exponents.
fn unit(vector: &[f64; 3]) -> [f64; 3] {
    let scale = largest(vector);
    vector.map(|component| component / scale)
}

fn largest(vector: &[f64; 3]) -> f64 {
    vector.iter().fold(0.0, |most, component| component.abs().max(most))
}

fn mesh(rod: &Rod, key: &str) -> Check {
    at_least_one(&format!("{key}.elements"), rod.elements, "elements")?;
    if !(1..=8).contains(&rod.degree) {
        return fail(format!("{key}.degree"), format!("is {}", rod.degree), "a degree from 1 to 8");
    }
    if rod.interpolation == InterpolationKind::Se3 && rod.degree != 1 {
        return fail(
            format!("{key}.interpolation"),
            format!("is \"se3\" with degree {}", rod.degree),
            "degree 1 with \"se3\", or \"r12\"",
        );
    }
    Ok(())
}

fn reference(rod: &Rod, key: &str) -> Check {
    let Reference::Fit { samples } = rod.reference else {
        return Ok(());
    };
    if matches!(rod.curve.shape, CurveShape::Poses { .. }) {
        return fail(
            key,
            "is a fit, but given poses are always fitted, with all of them",
            "no `reference` beside a curve of kind \"poses\"",
        );
    }
    let nodes = rod.elements * rod.degree + 1;
    if !(nodes..=MOST.max(nodes)).contains(&samples) {
        return fail(
            format!("{key}.samples"),
            format!("is {samples}, for {nodes} nodes"),
            format!("at least {nodes} samples and at most {}", MOST.max(nodes)),
        );
    }
    Ok(())
}
