//! The helical spring of Harsch & Eugster, section 4.1 (after Marino 2017), shared by the cases about it.
//!
//! E = 1e11, ν = 0.2, d = 1 mm, R = 10 mm, 10 coils, pitch 5 mm, clamped at ξ = 0, dead force along +e_z at ξ = 1:
//! at the end of the wire, as the paper has it, or on the axis of the helix through a rigid lever.

use std::error::Error;
use std::f64::consts::{PI, TAU};

use cosserat::scene::{
    CurveShape, InterpolationKind, LoadKind, NodeSpacing, QuadratureKind, Reference, Rod, Scene, Statics,
};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use crate::case::Checks;
use crate::measure::{clamp, displacement, load, probe, solve};
use crate::pieces::{circle, young_poisson};
use crate::placement::{Placement, placements};
use crate::references::Row;

pub const YOUNG: f64 = 1e11;
pub const POISSON: f64 = 0.2;
pub const DIAMETER: f64 = 1e-3;
pub const RADIUS: f64 = 10e-3;
pub const COILS: f64 = 10.0;
pub const PITCH: f64 = 5e-3;

/// G.
pub const SHEAR: f64 = YOUNG / (2.0 * (1.0 + POISSON));
/// A.
pub const AREA: f64 = PI * DIAMETER * DIAMETER / 4.0;
/// I, about either diameter; I_p = 2 I.
pub const SECOND_MOMENT: f64 = AREA * DIAMETER * DIAMETER / 16.0;

/// Displacements of the end of the wire when the force acts there: the continuous rod equations.
pub const WIRE_END: &str = "continuous/static_spring_wire_end.csv";

/// A force [N] and a displacement [m].
pub struct WireEnd {
    pub force: f64,
    pub exact: [f64; 3],
}

/// All loads of the file.
pub fn wire_end(checks: &mut Checks) -> Result<Vec<WireEnd>, Box<dyn Error>> {
    let row = |row: Row| Ok(WireEnd { force: row.number("force")?, exact: row.numbers("x y z")? });
    checks.reference(WIRE_END)?.rows().map(row).collect()
}

/// Forces [N], the displacements that the authors' program printed, and half of their last digit [m].
pub fn printed(checks: &mut Checks, file: &str) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let row = |row: Row| {
        let [force, z, digit] = row.numbers("force z z_half_digit")?;
        Ok([force, 1e-3 * z, 1e-3 * digit])
    };
    checks.reference(file)?.rows().map(row).collect()
}

/// How far a curve of the authors' program may be from the same curve solved exactly, rounding apart [m].
///
/// It stops at residuals of 1e-8, and a moment of 1e-8 N m left at a node turns what follows by as much times s/GI_p
/// on the lever R: on average ½ L R/GI_p = 0.77 m/(N m), at each of 151 nodes, if all have one sign.
pub const PRINTED_CURVE: f64 = 1.2e-6;
pub const PRINTED_CURVE_REASON: &str =
    "half of the last printed digit; 151 nodes with a residual of 1e-8 N m times 0.77 m/(N m): 1.2 µm";

/// tan α = pitch/(2πR).
pub fn slope(pitch: f64) -> f64 {
    pitch / (TAU * RADIUS)
}

/// Length of the wire [m].
pub fn wire_length(pitch: f64) -> f64 {
    TAU * COILS * RADIUS * 1.0_f64.hypot(slope(pitch))
}

/// Where the three placements of a spring's scene put it.
pub fn places() -> [Placement; 3] {
    placements(COILS * PITCH)
}

/// One problem about the spring; change what differs.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Force along +e_z [N].
    pub force: f64,
    /// Whether it acts on the axis of the helix rather than at the end of the wire.
    pub on_axis: bool,
    /// E [Pa].
    pub young: f64,
    pub pitch: f64,
    pub elements: usize,
    pub degree: usize,
    pub spacing: NodeSpacing,
    pub interpolation: InterpolationKind,
    pub quadrature: QuadratureKind,
    pub reference: Reference,
    pub statics: Statics,
}

impl Spring {
    /// Pulled at the end of the wire; R12, nodes on the curve, automatic increments.
    pub fn new(force: f64, elements: usize, degree: usize) -> Self {
        Self {
            force,
            on_axis: false,
            young: YOUNG,
            pitch: PITCH,
            elements,
            degree,
            spacing: NodeSpacing::default(),
            interpolation: InterpolationKind::default(),
            quadrature: QuadratureKind::default(),
            reference: Reference::default(),
            statics: Statics::default(),
        }
    }

    /// Pulled on the axis.
    pub fn axial(force: f64, elements: usize, degree: usize) -> Self {
        Self { on_axis: true, ..Self::new(force, elements, degree) }
    }

    pub fn scene(&self) -> Scene {
        let helix = CurveShape::Helix { coils: COILS, radius: RADIUS, pitch: self.pitch, phase: 0.0 };
        let rod = Rod {
            node_spacing: self.spacing,
            interpolation: self.interpolation,
            quadrature: self.quadrature,
            reference: self.reference,
            ..Rod::new(
                "spring",
                helix,
                circle(DIAMETER),
                Some(young_poisson(self.young, POISSON)),
                self.elements,
                self.degree,
            )
        };
        // The normal e_y of a helix points to its axis.
        let offset = self.on_axis.then_some([0.0, RADIUS, 0.0]);
        let mut force = load(LoadKind::Force, "spring@1", [0.0, 0.0, self.force]);
        force.offset = offset;
        let mut loaded = probe("loaded point", "spring@1");
        loaded.offset = offset;
        Scene {
            rod: vec![rod],
            joint: vec![clamp("spring@0")],
            load: vec![force],
            probe: vec![loaded],
            statics: Some(self.statics.clone()),
            ..Scene::default()
        }
    }

    pub fn solve(&self, placement: &Placement) -> Result<Solution, Box<dyn Error>> {
        solve(&placement.apply(&self.scene()))
    }

    /// Displacement of the loaded point under the whole force [m].
    pub fn displacement(&self, placement: &Placement) -> Result<Vector3<f64>, Box<dyn Error>> {
        displacement(&self.solve(placement)?, 0, placement)
    }

    /// dF/du_z at F = 0 [N/m], by the difference of a small force and its opposite: the even terms drop out.
    pub fn initial_stiffness(&self, placement: &Placement) -> Result<f64, Box<dyn Error>> {
        let pulled = self.displacement(placement)?;
        let pushed = Self { force: -self.force, ..self.clone() }.displacement(placement)?;
        Ok(2.0 * self.force / (pulled.z - pushed.z))
    }
}
