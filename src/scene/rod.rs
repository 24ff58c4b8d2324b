//! Rods: curve, section, material and discretisation.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// A slender rod.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rod {
    /// Unique among rods; `name@ξ` addresses a point of the rod.
    pub name: String,
    /// The undeformed centreline with its frames.
    pub curve: Curve,
    /// The cross-section, constant along the rod.
    pub section: Section,
    /// The material; absent only for a custom section.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<Material>,
    /// Number of elements, at least 1.
    pub elements: usize,
    /// Polynomial degree p of the ansatz, 1 to 8; an element has p + 1 nodes.
    pub degree: usize,
    /// Where the nodes of an element lie.
    #[serde(default)]
    pub node_spacing: NodeSpacing,
    /// How the cross-section rotation is interpolated.
    #[serde(default)]
    pub interpolation: InterpolationKind,
    /// Quadrature of the internal forces.
    #[serde(default)]
    pub quadrature: QuadratureKind,
    /// How the nodes of the reference configuration follow from the curve.
    #[serde(default)]
    pub reference: Reference,
    /// The rod theory.
    #[serde(default)]
    pub theory: Theory,
    /// Whether the rod takes part in gravity when the scene has it.
    #[serde(default = "yes")]
    pub gravity: bool,
    /// Whether the rod has inertia in dynamics and modes.
    #[serde(default = "yes")]
    pub inertia: bool,
}

impl Rod {
    /// A rod with the defaults of a scene file.
    pub fn new(
        name: impl Into<String>,
        curve: impl Into<Curve>,
        section: Section,
        material: Option<Material>,
        elements: usize,
        degree: usize,
    ) -> Self {
        Self {
            name: name.into(),
            curve: curve.into(),
            section,
            material,
            elements,
            degree,
            node_spacing: NodeSpacing::default(),
            interpolation: InterpolationKind::default(),
            quadrature: QuadratureKind::default(),
            reference: Reference::default(),
            theory: Theory::default(),
            gravity: true,
            inertia: true,
        }
    }
}

fn yes() -> bool {
    true
}

/// A curve, placed in space: r = origin + A(orientation) r_shape, A_IK = A(orientation) A_shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// The curve before it is placed.
    #[serde(flatten)]
    pub shape: CurveShape,
    /// Where the shape's origin lies [m].
    #[serde(default)]
    pub origin: [f64; 3],
    /// How the shape is turned.
    #[serde(default = "identity_quaternion")]
    pub orientation: [f64; 4],
}

pub(super) fn identity_quaternion() -> [f64; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

impl From<CurveShape> for Curve {
    fn from(shape: CurveShape) -> Self {
        Self { shape, origin: [0.0; 3], orientation: identity_quaternion() }
    }
}

/// The shapes of centrelines, ξ from 0 to 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum CurveShape {
    /// A straight line: `length` along +e_x, or `from` one point `to` another.
    Line {
        /// Length [m]; alone.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        length: Option<f64>,
        /// Start [m]; together with `to`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from: Option<[f64; 3]>,
        /// End [m]; together with `from`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<[f64; 3]>,
        /// Direction of the section's e_y, projected if oblique; only with `from` and `to`.
        /// Default e_z × tangent, or +e_y where that vanishes.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        normal: Option<[f64; 3]>,
    },
    /// A circular arc from the origin along +e_x, bending towards +e_y.
    Arc {
        /// Radius [m].
        radius: f64,
        /// Opening angle [rad].
        angle: f64,
    },
    /// A helix about +e_z with its Serret–Frenet frame.
    Helix {
        /// Number of coils.
        coils: f64,
        /// Coil radius [m].
        radius: f64,
        /// Rise per coil [m].
        pitch: f64,
        /// Angle at which it starts [rad].
        #[serde(default)]
        phase: f64,
    },
    /// Given poses, fitted by eq. (21).
    Poses {
        /// CSV file with the columns `x,y,z,qw,qx,qy,qz`; relative to the scene file.
        file: PathBuf,
    },
}

/// A cross-section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Section {
    /// A circle or a tube.
    Circle {
        /// Outer diameter [m].
        diameter: f64,
        /// Inner diameter [m]; absent means solid.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        inner_diameter: Option<f64>,
        /// Shear correction factor k in k G A.
        #[serde(default = "one")]
        shear_factor: f64,
        /// Torsion constant [m⁴]; default I_y + I_z.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        torsion_constant: Option<f64>,
    },
    /// A rectangle.
    Rectangle {
        /// Width along e_y [m].
        width: f64,
        /// Height along e_z [m].
        height: f64,
        /// Shear correction factor k in k G A.
        #[serde(default = "one")]
        shear_factor: f64,
        /// Torsion constant [m⁴]; default I_y + I_z.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        torsion_constant: Option<f64>,
    },
    /// Stiffnesses (and inertia) given directly.
    Custom {
        /// Axial stiffness EA [N].
        axial: f64,
        /// Shear stiffness along e_y [N].
        shear_y: f64,
        /// Shear stiffness along e_z [N].
        shear_z: f64,
        /// Torsional stiffness [N m²].
        torsion: f64,
        /// Bending stiffness about e_y [N m²].
        bending_y: f64,
        /// Bending stiffness about e_z [N m²].
        bending_z: f64,
        /// Mass per reference length [kg/m]; where inertia or weight is needed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        mass_per_length: Option<f64>,
        /// Rotary inertia per reference length about e_x, e_y, e_z [kg m]; where inertia is needed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rotary_inertia: Option<[f64; 3]>,
    },
}

fn one() -> f64 {
    1.0
}

/// An isotropic linear elastic material: exactly two of the three elastic constants.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus E [Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub young_modulus: Option<f64>,
    /// Shear modulus G [Pa].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_modulus: Option<f64>,
    /// Poisson's ratio ν, in (−1, 0.5].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub poisson_ratio: Option<f64>,
    /// Mass density [kg/m³]; where inertia or weight is needed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
}

/// Where the p + 1 nodes of an element lie. The same for degrees 1 and 2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NodeSpacing {
    /// Gauss–Lobatto points: the end values superconverge with order 2p.
    #[default]
    GaussLobatto,
    /// Evenly, as in the paper.
    Equal,
}

/// How the cross-section rotation is interpolated between the nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum InterpolationKind {
    /// The nodal transformation matrices, eq. (6).
    #[default]
    R12,
    /// The relative twist of two nodes (Harsch, Sailer & Eugster 2023); degree 1 only.
    Se3,
    /// The nodal quaternions.
    Quaternion,
}

/// Quadrature of the internal forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum QuadratureKind {
    /// p Gauss points: free of locking.
    #[default]
    Reduced,
    /// ⌈(p + 1)²/2⌉ Gauss points: locks, and is there to show it.
    Full,
}

/// How the nodes of the reference configuration follow from the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Reference {
    /// Nodes exactly on the curve.
    #[default]
    Nodes,
    /// Least squares, eq. (21).
    Fit {
        /// Number of evenly spaced samples of the curve, at least the number of nodes.
        samples: usize,
    },
}

/// The rod theory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Theory {
    /// Stretch, shear, torsion and bending.
    #[default]
    Cosserat,
    /// No shear.
    ShearRigid,
    /// Neither shear nor stretch.
    Inextensible,
}
