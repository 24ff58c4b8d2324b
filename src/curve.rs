//! Reference centrelines with their frames, ξ from 0 to 1.

use std::f64::consts::TAU;
use std::path::Path;

use nalgebra::{Matrix3, Vector3, Vector4};
use serde::Deserialize;

use crate::error::{Error, SceneError};
use crate::interpolation::Pose;
use crate::rotation::{direction, rotation_matrix};
use crate::scene::{Curve, CurveShape};

/// A curve that can be evaluated.
#[derive(Clone, Debug)]
pub enum Centreline {
    /// r = start + ξ (end − start), constant frame.
    Line {
        /// Start [m].
        start: Vector3<f64>,
        /// End − start [m].
        span: Vector3<f64>,
        /// A_IK.
        rotation: Matrix3<f64>,
    },
    /// r = (R sin φ, R (1 − cos φ), 0), φ = angle ξ.
    Arc {
        /// R [m].
        radius: f64,
        /// Opening angle [rad].
        angle: f64,
    },
    /// r = (R sin φ, −R cos φ, R c (φ − phase)), φ = phase + 2π coils ξ, eq. (19) with a phase.
    Helix {
        /// Number of coils.
        coils: f64,
        /// R [m].
        radius: f64,
        /// c = pitch/(2πR).
        slope: f64,
        /// Angle at which it starts [rad].
        phase: f64,
    },
    /// Given poses at evenly spaced ξ.
    Poses(Vec<Pose>),
}

/// A centreline with its place in space.
#[derive(Clone, Debug)]
pub struct PlacedCurve {
    centreline: Centreline,
    origin: Vector3<f64>,
    rotation: Matrix3<f64>,
}

impl PlacedCurve {
    /// From the validated scene; reads the file of given poses.
    pub fn new(curve: &Curve, key: &str) -> Result<Self, Error> {
        let centreline = match &curve.shape {
            CurveShape::Line { length: Some(length), .. } => Centreline::Line {
                start: Vector3::zeros(),
                span: Vector3::x() * *length,
                rotation: Matrix3::identity(),
            },
            CurveShape::Line { from, to, normal, .. } => {
                let start = Vector3::from(from.unwrap_or_default());
                let span = Vector3::from(to.unwrap_or_default()) - start;
                Centreline::Line { start, span, rotation: line_frame(&span, normal.map(Vector3::from)) }
            }
            CurveShape::Arc { radius, angle } => Centreline::Arc { radius: *radius, angle: *angle },
            CurveShape::Helix { coils, radius, pitch, phase } => Centreline::Helix {
                coils: *coils,
                radius: *radius,
                slope: pitch / (TAU * radius),
                phase: *phase,
            },
            CurveShape::Poses { file } => Centreline::Poses(read_poses(file, key)?),
        };
        Ok(Self {
            centreline,
            origin: Vector3::from(curve.origin),
            rotation: rotation_matrix(&Vector4::from(curve.orientation)),
        })
    }

    /// The pose at ξ; between given poses the nearest one's rotation and a straight line, a start for the fit.
    pub fn pose(&self, xi: f64) -> Pose {
        let local = self.centreline.pose(xi);
        Pose {
            position: self.origin + self.rotation * local.position,
            rotation: self.rotation * local.rotation,
        }
    }

    /// The same curve, moved by −`by`.
    pub fn relative_to(mut self, by: &Vector3<f64>) -> Self {
        self.origin -= by;
        self
    }

    /// The given poses, if that is what the curve is made of.
    pub fn given_poses(&self) -> Option<usize> {
        match &self.centreline {
            Centreline::Poses(poses) => Some(poses.len()),
            _ => None,
        }
    }

    /// The angle ∫ ‖κ⁰‖ ds by which the frame turns from ξ = 0 to 1, where it is known in advance.
    pub fn total_turn(&self) -> f64 {
        match self.centreline {
            Centreline::Line { .. } | Centreline::Poses(_) => 0.0,
            Centreline::Arc { angle, .. } => angle,
            // ‖κ⁰‖ L = √(1 + c²)/(R (1 + c²)) · R √(1 + c²) 2π n.
            Centreline::Helix { coils, .. } => TAU * coils,
        }
    }
}

impl Centreline {
    fn pose(&self, xi: f64) -> Pose {
        match self {
            Self::Line { start, span, rotation } => Pose { position: start + span * xi, rotation: *rotation },
            Self::Arc { radius, angle } => {
                let (sin, cos) = (angle * xi).sin_cos();
                // 1 − cos φ = 2 sin² ½φ keeps the digits of a flat arc.
                let versine = 2.0 * (0.5 * angle * xi).sin().powi(2);
                Pose {
                    position: Vector3::new(radius * sin, radius * versine, 0.0),
                    rotation: Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0),
                }
            }
            Self::Helix { coils, radius, slope, phase } => {
                let turn = TAU * coils * xi;
                let (sin, cos) = (phase + turn).sin_cos();
                let stretch = 1.0_f64.hypot(*slope);
                Pose {
                    position: *radius * Vector3::new(sin, -cos, slope * turn),
                    rotation: Matrix3::from_columns(&[
                        Vector3::new(cos, sin, *slope) / stretch,
                        Vector3::new(-sin, cos, 0.0),
                        Vector3::new(-slope * cos, -slope * sin, 1.0) / stretch,
                    ]),
                }
            }
            Self::Poses(poses) => {
                let place = xi.clamp(0.0, 1.0) * (poses.len() - 1) as f64;
                let before = (place.floor() as usize).min(poses.len() - 2);
                let part = place - before as f64;
                let (a, b) = (&poses[before], &poses[before + 1]);
                Pose {
                    position: a.position + (b.position - a.position) * part,
                    rotation: if part < 0.5 { a.rotation } else { b.rotation },
                }
            }
        }
    }
}

/// (tangent, normal projected, binormal); the default normal is e_z × tangent, or +e_y where that vanishes.
fn line_frame(span: &Vector3<f64>, normal: Option<Vector3<f64>>) -> Matrix3<f64> {
    let tangent = direction(span);
    let wanted = normal.map_or_else(
        || {
            let default = Vector3::z().cross(&tangent);
            if default.norm() > 1e-9 { default } else { Vector3::y() }
        },
        |normal| direction(&normal),
    );
    let projected = wanted - tangent * tangent.dot(&wanted);
    let normal = direction(&projected);
    Matrix3::from_columns(&[tangent, normal, tangent.cross(&normal)])
}

/// One line of a pose file.
#[derive(Deserialize)]
struct PoseRow {
    x: f64,
    y: f64,
    z: f64,
    qw: f64,
    qx: f64,
    qy: f64,
    qz: f64,
}

/// Reads `x,y,z,qw,qx,qy,qz`.
fn read_poses(file: &Path, key: &str) -> Result<Vec<Pose>, Error> {
    let wrong = |problem: String| {
        SceneError::new(
            format!("{key}.file"),
            problem,
            "a CSV file with the header x,y,z,qw,qx,qy,qz and finite numbers",
        )
    };
    let text = std::fs::read_to_string(file).map_err(|source| Error::File {
        action: "read",
        path: file.to_path_buf(),
        source,
    })?;
    let mut poses = Vec::new();
    for (index, row) in csv::Reader::from_reader(text.as_bytes()).deserialize::<PoseRow>().enumerate() {
        let line = index + 2;
        let row = row.map_err(|error| wrong(format!("{} is malformed: {error}", file.display())))?;
        let quaternion = Vector4::new(row.qw, row.qx, row.qy, row.qz);
        let position = Vector3::new(row.x, row.y, row.z);
        if !position.iter().chain(quaternion.iter()).all(|x| x.is_finite()) {
            return Err(wrong(format!(
                "line {line} of {} holds a number that is not finite",
                file.display()
            ))
            .into());
        }
        if quaternion.amax() == 0.0 {
            return Err(wrong(format!("line {line} of {} holds a zero quaternion", file.display())).into());
        }
        poses.push(Pose { position, rotation: rotation_matrix(&quaternion) });
    }
    if poses.len() < 2 {
        return Err(wrong(format!(
            "{} has {} of the poses; a rod needs two at least",
            file.display(),
            poses.len()
        ))
        .into());
    }
    Ok(poses)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(shape: CurveShape) -> PlacedCurve {
        PlacedCurve::new(&shape.into(), "rod.0.curve").expect("no file to read")
    }

    fn line(from: [f64; 3], to: [f64; 3], normal: Option<[f64; 3]>) -> PlacedCurve {
        placed(CurveShape::Line { length: None, from: Some(from), to: Some(to), normal })
    }

    fn close(a: Vector3<f64>, b: [f64; 3]) -> bool {
        (a - Vector3::from(b)).norm() < 1e-14
    }

    /// e_x is the direction of the derivative, the frame is a rotation, and it turns as much as it says.
    #[test]
    fn frames_follow_their_curves() {
        let curves = [
            line([1.0, 2.0, 3.0], [-1.0, 0.5, 2.0], Some([1.0, 1.0, 1.0])),
            placed(CurveShape::Arc { radius: 2.0, angle: 1.3 }),
            placed(CurveShape::Helix { coils: 1.7, radius: 0.3, pitch: -0.2, phase: 0.4 }),
        ];
        for curve in curves {
            let mut turned = 0.0;
            for k in 0..1000 {
                let xi = k as f64 / 1000.0;
                let (now, next) = (curve.pose(xi), curve.pose(xi + 1e-3));
                let (before, after) = (curve.pose(xi - 1e-6), curve.pose(xi + 1e-6));
                let tangent = (after.position - before.position).normalize();
                assert!((now.rotation.column(0) - tangent).norm() < 1e-8);
                assert!((now.rotation.transpose() * now.rotation - Matrix3::identity()).amax() < 1e-15);
                assert!(now.rotation.determinant() > 0.0);
                turned += crate::rotation::log_so3(&(now.rotation.transpose() * next.rotation)).norm();
            }
            assert!((turned - curve.total_turn()).abs() < 1e-10, "{turned}");
        }
    }

    #[test]
    fn the_arc_bends_towards_e_y_and_the_helix_rises_from_its_phase() {
        let end = placed(CurveShape::Arc { radius: 2.0, angle: std::f64::consts::FRAC_PI_2 }).pose(1.0);
        assert!(close(end.position, [2.0, 2.0, 0.0]));
        assert!(close(end.rotation.column(1).into(), [-1.0, 0.0, 0.0]), "e_y points to the centre");
        let phase = std::f64::consts::PI;
        let helix = placed(CurveShape::Helix { coils: 3.0, radius: 0.5, pitch: 0.1, phase });
        assert!(close(helix.pose(0.0).position, [0.0, 0.5, 0.0]));
        assert!(close(helix.pose(1.0).position, [0.0, 0.5, 0.3]));
        assert!(close(helix.pose(0.0).rotation.column(1).into(), [0.0, -1.0, 0.0]), "normal to the axis");
    }

    #[test]
    fn lines_choose_their_normal() {
        let normal = |curve: PlacedCurve| curve.pose(0.5).rotation.column(1).into_owned();
        assert!(close(normal(line([0.0; 3], [2.0, 0.0, 0.0], None)), [0.0, 1.0, 0.0]), "e_z × e_x");
        assert!(close(normal(line([0.0; 3], [0.0, 3.0, 0.0], None)), [-1.0, 0.0, 0.0]), "e_z × e_y");
        assert!(close(normal(line([0.0; 3], [0.0, 0.0, -1.0], None)), [0.0, 1.0, 0.0]), "e_y along e_z");
        let oblique = line([0.0; 3], [1.0, 0.0, 0.0], Some([5.0, 0.0, -2.0]));
        assert!(close(normal(oblique), [0.0, 0.0, -1.0]), "projected");
        let along = placed(CurveShape::Line { length: Some(2.0), from: None, to: None, normal: None });
        assert!(close(along.pose(1.0).position, [2.0, 0.0, 0.0]));
        assert_eq!(along.pose(0.3).rotation, Matrix3::identity());
    }

    #[test]
    fn origin_and_orientation_place_a_curve() {
        let mut curve = Curve::from(CurveShape::Arc { radius: 1.0, angle: 1.0 });
        curve.origin = [1.0, 2.0, 3.0];
        curve.orientation = [2.0, 0.0, 0.0, 2.0]; // a quarter turn about e_z, of any norm
        let start = PlacedCurve::new(&curve, "").expect("no file to read").pose(0.0);
        assert!(close(start.position, [1.0, 2.0, 3.0]));
        assert!(close(start.rotation.column(0).into(), [0.0, 1.0, 0.0]));
    }
}
