//! What the user wrote: one set of plain structs for the scene file, the Rust literal and the binding.
//!
//! SI units, angles in radians, quaternions `[w, x, y, z]` from the cross-section to the inertial basis.
//! Unknown keys are refused by serde; everything that serde cannot see (ranges, references between
//! tables, combinations) is checked by [`Scene::validate`].

mod read;
mod validate;

pub use read::SceneFile;
pub(crate) use validate::parse_point;

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// A scene: rods, how they are held and loaded, what is recorded, and the analysis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Scene {
    /// Anything; repeated in the results.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Gravitational acceleration in the inertial basis [m/s²]; absent means none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[f64; 3]>,
    /// The rods.
    pub rod: Vec<Rod>,
    /// The joints, between a rod's node and the ground.
    pub joint: Vec<Joint>,
    /// The loads; several may act at one place.
    pub load: Vec<Load>,
    /// What is recorded.
    pub probe: Vec<Probe>,
    /// The static analysis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statics: Option<Statics>,
    /// What the plot shows beside the solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plot: Option<Plot>,
}

impl Scene {
    /// The same scene with what the model would fill in: the names of joints and the course of loads.
    pub fn with_defaults(&self) -> Self {
        let mut scene = self.clone();
        for (index, joint) in scene.joint.iter_mut().enumerate() {
            joint.name = Some(self.joint_name(index));
        }
        for load in &mut scene.load {
            load.time.get_or_insert(LoadTime::Named(NamedTime::Ramp));
        }
        scene
    }
}

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

fn identity_quaternion() -> [f64; 4] {
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

/// A joint; every joint keeps the relative pose of the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Default `joint1`, `joint2`, … in order.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// What it leaves free.
    pub kind: JointKind,
    /// The two parts: `"ground"` or `"rod@ξ"` at a node.
    pub between: [String; 2],
    /// Where it acts, inertial, at the start [m]; default the rod node's point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<[f64; 3]>,
    /// Axis of a revolute joint, inertial, at the start; any non-zero length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
}

/// What a joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum JointKind {
    /// Nothing.
    Rigid,
    /// Every rotation about a point.
    Spherical,
    /// The rotation about an axis through a point.
    Revolute,
}

/// A load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Force or moment, at a point or along the rod.
    pub kind: LoadKind,
    /// `"rod@ξ"` at a node for point loads, the rod's name for line loads.
    pub on: String,
    /// N, N m, N/m or N m/m, by kind.
    pub value: [f64; 3],
    /// The basis of `value`.
    #[serde(default)]
    pub basis: Basis,
    /// Forces: rigid lever from the node in the section's basis [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<[f64; 3]>,
    /// How the load varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<LoadTime>,
}

/// Force or moment, at a point or along the rod.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadKind {
    /// Point force [N].
    Force,
    /// Point moment [N m].
    Moment,
    /// Force per reference length [N/m].
    LineForce,
    /// Moment per reference length [N m/m].
    LineMoment,
}

/// The basis of a load's components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Inertial: the direction stays (a dead load).
    #[default]
    Inertial,
    /// Turns with the cross-section.
    Body,
}

/// How a load varies with the load factor (statics) or the time (dynamics).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "`time` must be \"ramp\", \"constant\" or a table [[t, factor], …]")]
pub enum LoadTime {
    /// A named course.
    Named(NamedTime),
    /// Factors at given times, linear between, constant outside.
    Table(Vec<[f64; 2]>),
}

/// A named course of a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NamedTime {
    /// Proportional to the load factor: the default in statics.
    Ramp,
    /// The same all the time: the default in dynamics.
    Constant,
}

/// What is recorded: the pose of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Unique among probes; the prefix of its columns.
    pub name: String,
    /// `"rod@ξ"` for any ξ in [0, 1].
    pub on: String,
    /// Rigid lever in the section's basis [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<[f64; 3]>,
    /// Adds three Euler angles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angles: Option<EulerSequence>,
}

/// A sequence of Euler angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EulerSequence {
    /// A = R_x(γ) R_y(β) R_z(α).
    Zyx,
}

/// The static analysis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Statics {
    /// Number of equal load increments; absent: automatic.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub increments: Option<usize>,
    /// Absolute max-norm of the residual [N, N m]; absent: the unit-free test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The iteration.
    pub newton: NewtonKind,
    /// Largest number of iterations in one increment; an automatic one is retried, smaller, after twelve.
    pub max_iterations: usize,
    /// The unknowns of the linear systems.
    pub coordinates: Coordinates,
}

impl Default for Statics {
    fn default() -> Self {
        Self {
            increments: None,
            tolerance: None,
            newton: NewtonKind::Mixed,
            max_iterations: 50,
            coordinates: Coordinates::Increments,
        }
    }
}

/// The Newton iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NewtonKind {
    /// The stress of the geometric tangent is an iterate of its own (Magisano, Leonetti & Garcea 2017).
    #[default]
    Mixed,
    /// The plain iteration.
    Displacement,
}

/// The unknowns of the linear systems; the solution is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coordinates {
    /// 6 a node: (δr, δφ), the rotation updated by the exponential.
    #[default]
    Increments,
    /// 7 a node: (r, P) with the unit constraints, the paper's system (16) and (17).
    Quaternions,
}

/// What the plot shows beside the solution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Plot {
    /// Slope of a straight line to compare with [N/m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
}
