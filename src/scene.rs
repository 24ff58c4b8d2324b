//! What the user wrote: one set of plain structs for the scene file, the Rust literal and the binding.
//!
//! SI units, angles in radians, quaternions `[w, x, y, z]` from the cross-section to the inertial basis.
//! Unknown keys are refused by serde; everything that serde cannot see (ranges, references between
//! tables, combinations) is checked by [`Scene::validate`].

mod analysis;
mod body;
mod part;
mod read;
mod rod;
mod study;
mod validate;

pub use analysis::{Analysis, Coordinates, Dynamics, Method, Modes, NewtonKind, Statics, Step};
pub use body::{Body, Shape};
pub(crate) use part::{Part, parse_point};
pub use read::SceneFile;
pub use rod::{
    Curve, CurveShape, InterpolationKind, Material, NodeSpacing, QuadratureKind, Reference, Rod, Section,
    Theory,
};
pub use study::{Increments, Study, Tolerance};

use serde::{Deserialize, Serialize};

/// A scene: rods and bodies, how they are held and loaded, what is recorded, and the analysis.
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
    /// The rigid bodies.
    pub body: Vec<Body>,
    /// The joints, each between two of the ground, a body and a rod's node.
    pub joint: Vec<Joint>,
    /// The loads; several may act at one place.
    pub load: Vec<Load>,
    /// What is recorded.
    pub probe: Vec<Probe>,
    /// The static analysis; exactly one of the three is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub statics: Option<Statics>,
    /// The motion in time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dynamics: Option<Dynamics>,
    /// Small vibrations about the static equilibrium.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes: Option<Modes>,
    /// What the plot shows beside the solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plot: Option<Plot>,
    /// What a study of speed against accuracy tries; nothing else looks at it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub study: Option<Study>,
}

impl Scene {
    /// The same scene with what the model would fill in: the names of joints and the course of loads, `"constant"`
    /// in dynamics and `"ramp"` otherwise.
    pub fn with_defaults(&self) -> Self {
        let mut scene = self.clone();
        for (index, joint) in scene.joint.iter_mut().enumerate() {
            joint.name = Some(self.joint_name(index));
        }
        let course = self.default_course();
        for load in &mut scene.load {
            load.time.get_or_insert(LoadTime::Named(course));
        }
        scene
    }

    /// How a load varies that does not say.
    pub(crate) fn default_course(&self) -> NamedTime {
        match self.analysis() {
            Some(Analysis::Dynamics(_)) => NamedTime::Constant,
            _ => NamedTime::Ramp,
        }
    }

    /// The name of a joint of the scene: its own, or `joint1`, `joint2`, … in order.
    pub fn joint_name(&self, index: usize) -> String {
        self.joint
            .get(index)
            .and_then(|joint| joint.name.clone())
            .unwrap_or_else(|| format!("joint{}", index + 1))
    }
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
    /// The two parts, each `"ground"`, a body's name or `"rod@ξ"` at a node.
    pub between: [String; 2],
    /// Where it acts and where its reaction is taken, inertial, at the start [m]; default the rod node's point (of
    /// two rod nodes the second's), else the second body's centre of mass.
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
    /// `"rod@ξ"` at a node, or a body (its centre of mass); for line loads the rod's name.
    pub on: String,
    /// N, N m, N/m or N m/m, by kind.
    pub value: [f64; 3],
    /// The basis of `value`.
    #[serde(default)]
    pub basis: Basis,
    /// Forces: rigid lever from the node or the centre of mass, in the section's or body's basis [m].
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
    /// Turns with the cross-section or the body.
    Body,
}

/// How a load varies with the load factor (statics, up to 1; modes, at 1) or the time (dynamics).
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
    /// Proportional to the load factor: the default in statics and modes. In dynamics from 0 at the start to 1 at
    /// the end time.
    Ramp,
    /// The same all the time: the default in dynamics.
    Constant,
}

/// What is recorded: the pose of a point of a rod or body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Unique among probes; the prefix of its columns.
    pub name: String,
    /// A body (its centre of mass), or `"rod@ξ"` for any ξ in [0, 1].
    pub on: String,
    /// Rigid lever in the section's or body's basis [m].
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

/// What the plot shows beside the solution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Plot {
    /// Slope of a straight line to compare with [N/m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<f64>,
}
