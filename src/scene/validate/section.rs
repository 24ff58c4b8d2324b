//! The cross-section of a rod and its material.

use super::check::{Check, fail, finite_number, positive};
use crate::scene::{Analysis, Material, Rod, Scene, Section};

const MODULUS: &str = "a positive modulus [Pa]";
const DENSITY: &str = "a positive density [kg/m³]";
const POISSON_RANGE: &str = "a Poisson's ratio above -1 and up to 0.5";

/// What weight needs, and inertia in dynamics and modes: a mass per length, given or from the density.
pub(super) fn mass(scene: &Scene, rod: &Rod, key: &str) -> Check {
    let weighs = rod.gravity && scene.gravity.is_some_and(|gravity| gravity != [0.0; 3]);
    let moves = match scene.analysis() {
        Some(Analysis::Dynamics(_)) if rod.inertia => Some("dynamics"),
        Some(Analysis::Modes(_)) if rod.inertia => Some("modes"),
        _ => None,
    };
    let missing = match (&rod.section, &rod.material) {
        (Section::Custom { mass_per_length: None, .. }, _) => {
            Some(("section.mass_per_length", "the mass per length [kg/m]"))
        }
        (Section::Custom { rotary_inertia: None, .. }, _) if moves.is_some() => {
            Some(("section.rotary_inertia", "the rotary inertia per length `[xx, yy, zz]` [kg m]"))
        }
        (Section::Custom { .. }, _) => None,
        (_, Some(material)) if material.density.is_some() => None,
        (_, Some(_)) => Some(("material.density", "the density [kg/m³]")),
        (_, None) => Some(("material", "the material with its density [kg/m³]")),
    };
    let Some((entry, expected)) = missing else {
        return Ok(());
    };
    // The rotary inertia has no weight.
    let weighs = weighs && entry != "section.rotary_inertia";
    let (reason, without) = match (moves, weighs) {
        (None, false) => return Ok(()),
        (None, true) => ("takes part in gravity".to_owned(), "`gravity = false`"),
        (Some(analysis), false) => (format!("has inertia in `[{analysis}]`"), "`inertia = false`"),
        (Some(analysis), true) => (
            format!("has inertia in `[{analysis}]` and takes part in gravity"),
            "`inertia = false` and `gravity = false`",
        ),
    };
    fail(
        format!("{key}.{entry}"),
        format!("is missing, but the rod {reason}"),
        format!("{expected}, or {without} for this rod"),
    )
}

pub(super) fn section(section: &Section, key: &str) -> Check {
    let size = |entry: &str, value: f64, expected: &str| positive(format!("{key}.{entry}"), value, expected);
    match section {
        Section::Circle { diameter, inner_diameter, shear_factor, torsion_constant } => {
            size("diameter", *diameter, "a positive diameter [m]")?;
            if let Some(inner) = inner_diameter
                && !(0.0..*diameter).contains(inner)
            {
                return fail(
                    format!("{key}.inner_diameter"),
                    format!("is {}", finite_number(*inner)),
                    format!(
                        "an inner diameter from 0 to below the diameter, {} [m]",
                        finite_number(*diameter)
                    ),
                );
            }
            factors(*shear_factor, *torsion_constant, key)
        }
        Section::Rectangle { width, height, shear_factor, torsion_constant } => {
            size("width", *width, "a positive width [m]")?;
            size("height", *height, "a positive height [m]")?;
            factors(*shear_factor, *torsion_constant, key)
        }
        Section::Custom {
            axial,
            shear_y,
            shear_z,
            torsion,
            bending_y,
            bending_z,
            mass_per_length,
            rotary_inertia,
        } => {
            for (entry, value) in [("axial", axial), ("shear_y", shear_y), ("shear_z", shear_z)] {
                size(entry, *value, "a positive stiffness [N]")?;
            }
            for (entry, value) in [("torsion", torsion), ("bending_y", bending_y), ("bending_z", bending_z)] {
                size(entry, *value, "a positive stiffness [N m²]")?;
            }
            if let Some(mass) = mass_per_length {
                size("mass_per_length", *mass, "a positive mass per length [kg/m]")?;
            }
            for (index, value) in rotary_inertia.iter().flatten().enumerate() {
                let entry = format!("rotary_inertia.{index}");
                size(&entry, *value, "a positive rotary inertia per length [kg m]")?;
            }
            Ok(())
        }
    }
}

fn factors(shear_factor: f64, torsion_constant: Option<f64>, key: &str) -> Check {
    positive(format!("{key}.shear_factor"), shear_factor, "a positive shear factor")?;
    match torsion_constant {
        Some(value) => {
            let key = format!("{key}.torsion_constant");
            positive(key, value, "a positive torsion constant [m⁴]")
        }
        None => Ok(()),
    }
}

pub(super) fn material_of(rod: &Rod, key: &str) -> Check {
    let custom = matches!(rod.section, Section::Custom { .. });
    match (&rod.material, custom) {
        (None, true) => Ok(()),
        (Some(_), true) => fail(
            key,
            "is given beside a custom section, which has its stiffnesses already",
            "no material here",
        ),
        (None, false) => {
            fail(key, "is missing", "a table such as `{ young_modulus = 2e11, poisson_ratio = 0.3 }`")
        }
        (Some(given), false) => material(given, key),
    }
}

fn material(material: &Material, key: &str) -> Check {
    let constants = [
        ("young_modulus", material.young_modulus),
        ("shear_modulus", material.shear_modulus),
        ("poisson_ratio", material.poisson_ratio),
    ];
    let given: Vec<_> = constants
        .iter()
        .filter(|(_, value)| value.is_some())
        .map(|(entry, _)| format!("`{entry}`"))
        .collect();
    let problem = match &given[..] {
        [] => "gives no elastic constant".to_owned(),
        [only] => format!("gives only {only}"),
        [_, _] => String::new(),
        _ => "gives all three elastic constants".to_owned(),
    };
    if !problem.is_empty() {
        return fail(key, problem, "exactly two of `young_modulus`, `shear_modulus` and `poisson_ratio`");
    }
    for (entry, value) in &constants[..2] {
        if let Some(value) = value {
            positive(format!("{key}.{entry}"), *value, MODULUS)?;
        }
    }
    if let Some(density) = material.density {
        positive(format!("{key}.density"), density, DENSITY)?;
    }
    poisson_ratio(material, key)
}

fn poisson_ratio(material: &Material, key: &str) -> Check {
    if let Some(ratio) = material.poisson_ratio
        && !(ratio > -1.0 && ratio <= 0.5)
    {
        return fail(format!("{key}.poisson_ratio"), format!("is {}", finite_number(ratio)), POISSON_RANGE);
    }
    if let (Some(young), Some(shear)) = (material.young_modulus, material.shear_modulus) {
        let ratio = young / (2.0 * shear) - 1.0;
        // E = 3 G is incompressible and allowed, also when it is rounded.
        if !(ratio > -1.0 && ratio <= 0.5 + 1e-12) {
            return fail(
                key,
                format!("implies a Poisson's ratio of {}", finite_number(ratio)),
                format!("moduli that imply {POISSON_RANGE}"),
            );
        }
    }
    Ok(())
}
