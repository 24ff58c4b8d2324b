//! How far two paths of the same probes are apart.

use std::fmt;

use nalgebra::{Vector3, Vector4};

use crate::model::Model;
use crate::solution::{ProbePose, Solution};
use crate::study::Milestones;

/// The largest distance of two paths over probes and milestones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// |Δr| relative to the length of all rods together [–].
    pub position: f64,
    /// Angle between the two rotations [rad].
    pub rotation: f64,
}

impl Errors {
    /// The larger of both, which is what an accuracy is held against: relative to the rods' length, radians.
    pub fn largest(&self) -> f64 {
        self.position.max(self.rotation)
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:.1e} of the length, {:.1e} rad", self.position, self.rotation)
    }
}

/// The poses of all probes at those milestones that a run has a row for, the start included.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Index of the milestone, 0 the start, and one pose for every probe; ascending.
    pub rows: Vec<(usize, Vec<ProbePose>)>,
    /// What lengths are relative to: the length of all rods together, without rods the longest lever [m].
    pub size: f64,
}

impl Trajectory {
    /// What a solution of a model has at the milestones.
    pub fn new(model: &Model, milestones: &Milestones, solution: &Solution) -> Self {
        let rods: f64 = model.rods().map(|rod| rod.length).sum();
        let rows = solution.rows.iter().filter_map(|row| {
            let index = milestones.index_of(row.parameter)?;
            Some((index, row.probes.clone()))
        });
        let mut rows: Vec<_> = rows.collect();
        rows.dedup_by_key(|(index, _)| *index);
        Self { rows, size: if rods > 0.0 { rods } else { model.size } }
    }
}

/// The largest errors of a run against a reference, over the milestones that both have; `None` where they have none
/// in common beside the start, or other probes.
pub fn compare(run: &Trajectory, reference: &Trajectory) -> Option<Errors> {
    let mut errors = Errors::default();
    let mut compared = false;
    for (index, poses) in &run.rows {
        let Ok(found) = reference.rows.binary_search_by_key(index, |(index, _)| *index) else { continue };
        let exact = &reference.rows[found].1;
        if exact.len() != poses.len() {
            return None;
        }
        compared |= *index > 0;
        for (pose, exact) in poses.iter().zip(exact) {
            let distance = Vector3::from(pose.position) - Vector3::from(exact.position);
            errors.position = errors.position.max(distance.norm() / reference.size);
            errors.rotation = errors.rotation.max(angle(&pose.quaternion, &exact.quaternion));
        }
    }
    compared.then_some(errors)
}

/// The angle between two rotations, 2 atan2(|v|, |w|) of (w, v) = b⁻¹ a: the same for ±a, and exact to rounding for
/// small angles, where the cosine is not.
fn angle(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let scalar = Vector4::from(*a).dot(&Vector4::from(*b));
    let (a_vector, b_vector) = (Vector3::new(a[1], a[2], a[3]), Vector3::new(b[1], b[2], b[3]));
    let vector = a_vector * b[0] - b_vector * a[0] - b_vector.cross(&a_vector);
    2.0 * vector.norm().atan2(scalar.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_relative_rotation() {
        let turned = |angle: f64| [(0.5 * angle).cos(), 0.0, (0.5 * angle).sin(), 0.0];
        for wanted in [0.0, 1e-12, 1e-7, 0.3, 3.0] {
            let [a, b] = [turned(0.4 + wanted), turned(0.4)];
            // Rounding of the quaternions themselves.
            assert!((angle(&a, &b) - wanted).abs() < 4.0 * f64::EPSILON, "{wanted}");
            assert_eq!(angle(&a.map(|x| -x), &b), angle(&a, &b));
        }
        let [half, quarter] = [[0.0, 0.0, 0.0, 1.0], [0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0, 0.0]];
        assert_eq!(angle(&half, &[1.0, 0.0, 0.0, 0.0]), std::f64::consts::PI);
        let wanted = 2.0 * 0.0_f64.acos();
        assert!((angle(&half, &quarter) - wanted).abs() < 4.0 * f64::EPSILON);
    }

    #[test]
    fn paths_are_compared_where_both_have_rows() {
        let pose =
            |x: f64| ProbePose { position: [x, 0.0, 0.0], quaternion: [1.0, 0.0, 0.0, 0.0], angles: None };
        let path = |rows: &[(usize, f64)]| Trajectory {
            rows: rows.iter().map(|(index, x)| (*index, vec![pose(*x)])).collect(),
            size: 2.0,
        };
        let run = path(&[(0, 0.0), (1, 0.5), (3, 4.0), (4, 1.0)]);
        let errors = compare(&run, &path(&[(0, 0.0), (1, 0.75), (2, 9.0), (4, 1.0)]));
        assert_eq!(errors, Some(Errors { position: 0.125, rotation: 0.0 }));
        assert_eq!(compare(&run, &path(&[(0, 0.0), (2, 1.0)])), None);
    }
}
