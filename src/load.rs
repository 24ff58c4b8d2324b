//! Point loads at a node or a body, and how loads vary.

use nalgebra::{Matrix6, Vector3};

use crate::interpolation::Pose;
use crate::rotation::skew;
use crate::scene::{Analysis, Basis, Load, LoadKind, LoadTime, NamedTime, Scene};

/// The factor of a load over the load factor (or time).
#[derive(Clone, Debug, PartialEq)]
pub enum Course {
    /// The load factor itself.
    Ramp,
    /// 1.
    Constant,
    /// Linear between given points, constant outside.
    Table(Vec<[f64; 2]>),
}

impl Course {
    /// From the scene. In dynamics a ramp grows from 0 at the start to 1 at the end time.
    pub fn new(time: Option<&LoadTime>, scene: &Scene) -> Self {
        match time {
            None => Self::default_for(scene),
            Some(LoadTime::Named(NamedTime::Ramp)) => match scene.analysis() {
                Some(Analysis::Dynamics(options)) => Self::Table(vec![[0.0, 0.0], [options.end_time, 1.0]]),
                _ => Self::Ramp,
            },
            Some(LoadTime::Named(NamedTime::Constant)) => Self::Constant,
            Some(LoadTime::Table(table)) => Self::Table(table.clone()),
        }
    }

    /// What gravity and a load without course do: constant in dynamics, a ramp otherwise.
    pub fn default_for(scene: &Scene) -> Self {
        match scene.analysis() {
            Some(Analysis::Dynamics(_)) => Self::Constant,
            _ => Self::Ramp,
        }
    }

    /// The first time after `t` at which the course bends.
    pub fn next_bend(&self, t: f64) -> Option<f64> {
        match self {
            Self::Ramp | Self::Constant => None,
            Self::Table(table) => table.iter().map(|row| row[0]).find(|&time| time > t),
        }
    }

    /// The factor at `t`.
    pub fn factor(&self, t: f64) -> f64 {
        match self {
            Self::Ramp => t,
            Self::Constant => 1.0,
            Self::Table(table) => {
                let after = table.partition_point(|row| row[0] <= t);
                match (after.checked_sub(1).and_then(|before| table.get(before)), table.get(after)) {
                    (None, Some(row)) | (Some(row), None) => row[1],
                    (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * ((t - a[0]) / (b[0] - a[0])),
                    (None, None) => 0.0,
                }
            }
        }
    }
}

/// A force or moment at a node.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLoad {
    /// Index of the node within its rod, or in the model for a body.
    pub node: usize,
    /// True for a moment, false for a force.
    pub is_moment: bool,
    /// Components [N] or [N m].
    pub value: Vector3<f64>,
    /// Basis of the components.
    pub basis: Basis,
    /// Lever of a force in the body basis [m].
    pub lever: Vector3<f64>,
    /// How it varies.
    pub course: Course,
}

impl PointLoad {
    /// A load of the scene at a node; `None` for line loads.
    pub fn new(node: usize, load: &Load, scene: &Scene) -> Option<Self> {
        let is_moment = match load.kind {
            LoadKind::Force => false,
            LoadKind::Moment => true,
            LoadKind::LineForce | LoadKind::LineMoment => return None,
        };
        Some(Self {
            node,
            is_moment,
            value: Vector3::from(load.value),
            basis: load.basis,
            lever: Vector3::from(load.offset.unwrap_or_default()),
            course: Course::new(load.time.as_ref(), scene),
        })
    }

    /// The weight of a body at its node.
    pub fn weight(node: usize, weight: Vector3<f64>, course: Course) -> Self {
        Self {
            node,
            is_moment: false,
            value: weight,
            basis: Basis::Inertial,
            lever: Vector3::zeros(),
            course,
        }
    }

    /// (force inertial, moment body) on the node: a force F at the lever s adds s × Aᵀ F.
    pub fn rows(&self, pose: &Pose, factor: f64) -> (Vector3<f64>, Vector3<f64>) {
        let value = self.value * factor;
        let (inertial, body) = match self.basis {
            Basis::Inertial => (value, pose.rotation.tr_mul(&value)),
            Basis::Body => (pose.rotation * value, value),
        };
        if self.is_moment { (Vector3::zeros(), body) } else { (inertial, self.lever.cross(&body)) }
    }

    /// −∂rows/∂(δr, δφ): ∂(Aᵀ F)/∂φ = (Aᵀ F)~, ∂(A F)/∂φ = −A F̃.
    pub fn tangent(&self, pose: &Pose, factor: f64) -> Matrix6<f64> {
        let value = self.value * factor;
        let mut result = Matrix6::zeros();
        match (self.is_moment, self.basis) {
            (true, Basis::Body) => {}
            (true, Basis::Inertial) => {
                result.fixed_view_mut::<3, 3>(3, 3).copy_from(&-skew(&pose.rotation.tr_mul(&value)));
            }
            (false, Basis::Inertial) => {
                let part = -skew(&self.lever) * skew(&pose.rotation.tr_mul(&value));
                result.fixed_view_mut::<3, 3>(3, 3).copy_from(&part);
            }
            (false, Basis::Body) => {
                result.fixed_view_mut::<3, 3>(0, 3).copy_from(&(pose.rotation * skew(&value)));
            }
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_linear_between_and_constant_outside() {
        let course = Course::Table(vec![[0.0, 0.0], [0.5, 2.0], [1.0, 1.0]]);
        for (t, factor) in
            [(-1.0, 0.0), (0.0, 0.0), (0.25, 1.0), (0.5, 2.0), (0.75, 1.5), (1.0, 1.0), (2.0, 1.0)]
        {
            assert_eq!(course.factor(t), factor);
        }
        assert_eq!(Course::Table(vec![[0.5, 3.0]]).factor(0.1), 3.0);
    }
}
