//! Parts of scenes that many cases share.

use cosserat::scene::{CurveShape, Material, Section};

/// A straight line along +e_x.
pub fn line(length: f64) -> CurveShape {
    CurveShape::Line { length: Some(length), from: None, to: None, normal: None }
}

/// A solid circle, shear factor 1, torsion constant I_y + I_z.
pub fn circle(diameter: f64) -> Section {
    Section::Circle { diameter, inner_diameter: None, shear_factor: 1.0, torsion_constant: None }
}

/// A rectangle with shear factor 1.
pub fn rectangle(width: f64, height: f64, torsion_constant: Option<f64>) -> Section {
    Section::Rectangle { width, height, shear_factor: 1.0, torsion_constant }
}

/// An isotropic material by E and ν.
pub fn young_poisson(young_modulus: f64, poisson_ratio: f64) -> Material {
    Material { young_modulus: Some(young_modulus), poisson_ratio: Some(poisson_ratio), ..Material::default() }
}

/// An isotropic material by E and G.
pub fn young_shear(young_modulus: f64, shear_modulus: f64) -> Material {
    Material { young_modulus: Some(young_modulus), shear_modulus: Some(shear_modulus), ..Material::default() }
}

/// A section that is another in every direction, of a rod that bends by its own length under a newton.
pub const UNEVEN_SECTION: Section = Section::Custom {
    axial: 1e4,
    shear_y: 4e3,
    shear_z: 5e3,
    torsion: 0.8,
    bending_y: 1.0,
    bending_z: 1.5,
    mass_per_length: Some(0.5),
    rotary_inertia: Some([3e-4, 1e-4, 2e-4]),
};
