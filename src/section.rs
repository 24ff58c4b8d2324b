//! Cross-section and material → stiffness and inertia.

use std::f64::consts::PI;

use nalgebra::Vector3;

use crate::element::Stiffness;
use crate::scene::{Material, Section};

/// Young's and shear modulus from exactly two of E, G, ν: E = 2 G (1 + ν). `None` if not exactly two are given.
pub fn moduli(material: &Material) -> Option<(f64, f64)> {
    match (material.young_modulus, material.shear_modulus, material.poisson_ratio) {
        (Some(e), Some(g), None) => Some((e, g)),
        (Some(e), None, Some(nu)) => Some((e, e / (2.0 * (1.0 + nu)))),
        (None, Some(g), Some(nu)) => Some((2.0 * g * (1.0 + nu), g)),
        _ => None,
    }
}

/// Area [m²] and second moments I_y, I_z [m⁴] of a circle, tube or rectangle.
fn geometry(section: &Section) -> Option<(f64, f64, f64)> {
    match section {
        Section::Circle { diameter, inner_diameter, .. } => {
            let inner = inner_diameter.unwrap_or(0.0);
            let area = PI / 4.0 * (diameter - inner) * (diameter + inner);
            // D⁴ − d⁴ = (D² − d²)(D² + d²) keeps the digits of a thin wall.
            let second = area / 16.0 * (diameter * diameter + inner * inner);
            Some((area, second, second))
        }
        Section::Rectangle { width, height, .. } => {
            Some((width * height, width * height.powi(3) / 12.0, height * width.powi(3) / 12.0))
        }
        Section::Custom { .. } => None,
    }
}

/// K_γ = diag(EA, kGA, kGA), K_κ = diag(G I_t, E I_y, E I_z); `None` for an invalid combination.
pub fn stiffness(section: &Section, material: Option<&Material>) -> Option<Stiffness> {
    match section {
        Section::Custom { axial, shear_y, shear_z, torsion, bending_y, bending_z, .. } => Some(Stiffness {
            force: Vector3::new(*axial, *shear_y, *shear_z),
            moment: Vector3::new(*torsion, *bending_y, *bending_z),
        }),
        Section::Circle { shear_factor, torsion_constant, .. }
        | Section::Rectangle { shear_factor, torsion_constant, .. } => {
            let (e, g) = moduli(material?)?;
            let (area, second_y, second_z) = geometry(section)?;
            let shear = shear_factor * g * area;
            let torsion = torsion_constant.unwrap_or(second_y + second_z);
            Some(Stiffness {
                force: Vector3::new(e * area, shear, shear),
                moment: Vector3::new(g * torsion, e * second_y, e * second_z),
            })
        }
    }
}

/// Inertia of a cross-section per reference length, about its centre and along its principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionInertia {
    /// A_ρ0 = ρA [kg/m].
    pub mass_per_length: f64,
    /// Diagonal of I_ρ0 = ρ diag(I_y + I_z, I_y, I_z) in the cross-section basis [kg m].
    pub rotary: Vector3<f64>,
}

/// A_ρ0 and I_ρ0 of eq. (3); `None` if the density, or a part of a custom inertia, is not given.
///
/// About e_x it is the polar moment ρ ∫ y² + z² dA whatever the torsion constant, which is about stiffness only.
pub fn inertia(section: &Section, material: Option<&Material>) -> Option<SectionInertia> {
    match section {
        Section::Custom { mass_per_length, rotary_inertia, .. } => Some(SectionInertia {
            mass_per_length: (*mass_per_length)?,
            rotary: Vector3::from((*rotary_inertia)?),
        }),
        Section::Circle { .. } | Section::Rectangle { .. } => {
            let density = material?.density?;
            let (area, second_y, second_z) = geometry(section)?;
            Some(SectionInertia {
                mass_per_length: density * area,
                rotary: density * Vector3::new(second_y + second_z, second_y, second_z),
            })
        }
    }
}

/// Mass per reference length [kg/m]; `None` if the density is not given.
pub fn mass_per_length(section: &Section, material: Option<&Material>) -> Option<f64> {
    match section {
        Section::Custom { mass_per_length, .. } => *mass_per_length,
        _ => Some(material?.density? * geometry(section)?.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tube_is_the_difference_of_two_circles() {
        let circle = |diameter, inner_diameter| Section::Circle {
            diameter,
            inner_diameter,
            shear_factor: 1.0,
            torsion_constant: None,
        };
        let material = Material { young_modulus: Some(2.0), shear_modulus: Some(0.8), ..Material::default() };
        let of = |section| stiffness(&section, Some(&material)).expect("complete");
        let (tube, outer, inner) = (of(circle(3.0, Some(2.0))), of(circle(3.0, None)), of(circle(2.0, None)));
        assert!((tube.force - (outer.force - inner.force)).amax() < 1e-14);
        assert!((tube.moment - (outer.moment - inner.moment)).amax() < 1e-14);
        assert!((outer.moment.x - 0.8 * PI * 81.0 / 32.0).abs() < 1e-14);
    }

    #[test]
    fn any_two_moduli_give_the_same() {
        let (e, nu) = (2.1e11, 0.3);
        let g = e / 2.6;
        let all = [(Some(e), Some(g), None), (Some(e), None, Some(nu)), (None, Some(g), Some(nu))];
        for (young_modulus, shear_modulus, poisson_ratio) in all {
            let material = Material { young_modulus, shear_modulus, poisson_ratio, density: None };
            let (young, shear) = moduli(&material).expect("two given");
            assert!((young / e - 1.0).abs() < 1e-15 && (shear / g - 1.0).abs() < 1e-15);
        }
        assert!(moduli(&Material::default()).is_none());
    }
}
