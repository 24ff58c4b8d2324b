//! A motion of the bob as numbers over time, and the envelope of a beat.

use std::f64::consts::TAU;

use cosserat::rotation::rotation_matrix;
use cosserat::solution::Solution;
use nalgebra::{Matrix3, Vector3, Vector4};

use crate::placement::Placement;

/// Time and pose of the bob at every step, in the axes of the scene before it was placed.
pub struct Swing {
    pub times: Vec<f64>,
    pub positions: Vec<Vector3<f64>>,
    pub rotations: Vec<Matrix3<f64>>,
    pub solution: Solution,
}

impl Swing {
    /// Of probe 0.
    pub fn new(solution: Solution, placement: &Placement) -> Self {
        let back = placement.rotation.inverse().to_rotation_matrix();
        let start =
            solution.rows.first().map(|row| rotation_matrix(&Vector4::from(row.probes[0].quaternion)));
        // The bob's basis is the inertial one at the start, and turns only from there.
        let start = start.unwrap_or_else(Matrix3::identity);
        let rotation = |q: [f64; 4]| {
            back.matrix() * rotation_matrix(&Vector4::from(q)) * start.transpose() * back.matrix().transpose()
        };
        let rows = &solution.rows;
        Self {
            times: rows.iter().map(|row| row.parameter).collect(),
            positions: rows
                .iter()
                .map(|row| placement.undo_position(row.probes[0].position.into()))
                .collect(),
            rotations: rows.iter().map(|row| rotation(row.probes[0].quaternion)).collect(),
            solution,
        }
    }

    /// z of the centre of mass [m].
    pub fn z(&self) -> Vec<f64> {
        self.positions.iter().map(|position| position.z).collect()
    }

    /// α of A = R_x(γ) R_y(β) R_z(α), unwrapped [rad].
    pub fn alpha(&self) -> Vec<f64> {
        unwrapped(self.rotations.iter().map(|a| f64::atan2(-a.m12, a.m11)))
    }

    /// α of A = R_z(α) R_y(β) R_x(γ), unwrapped [rad].
    pub fn yaw(&self) -> Vec<f64> {
        unwrapped(self.rotations.iter().map(|a| f64::atan2(a.m21, a.m11)))
    }

    /// The index of a time that is a multiple of the step.
    pub fn at(&self, time: f64) -> usize {
        let step = self.times.get(1).copied().unwrap_or(f64::NAN);
        (time / step).round() as usize
    }
}

fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut last = 0.0;
    angles
        .map(|angle| {
            last = angle + TAU * ((last - angle) / TAU).round();
            last
        })
        .collect()
}

/// Times and values of the extrema, each by the parabola through three samples.
pub fn extrema(times: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
    let windows = times.windows(3).zip(values.windows(3));
    windows
        .filter(|(_, v)| (v[1] - v[0]) * (v[2] - v[1]) <= 0.0 && v[1] != v[2])
        .map(|(t, v)| {
            let place = 0.5 * (v[0] - v[2]) / (v[0] - 2.0 * v[1] + v[2]);
            (t[1] + place * (t[1] - t[0]), v[1] - 0.25 * (v[0] - v[2]) * place)
        })
        .collect()
}

/// Half the difference of consecutive extrema, at their mid-time.
pub fn envelope(extrema: &[(f64, f64)]) -> Vec<(f64, f64)> {
    extrema.windows(2).map(|e| (0.5 * (e[0].0 + e[1].0), 0.5 * (e[1].1 - e[0].1).abs())).collect()
}

/// The largest of `sign` times the values between two times.
pub fn largest(points: &[(f64, f64)], (from, to): (f64, f64), sign: f64) -> (f64, f64) {
    let inside = points.iter().filter(|point| (from..to).contains(&point.0));
    inside.copied().max_by(|a, b| (sign * a.1).total_cmp(&(sign * b.1))).unwrap_or((f64::NAN, f64::NAN))
}

/// The same between the points of an envelope: the extremum of the parabola through it and its neighbours.
pub fn peak(points: &[(f64, f64)], range: (f64, f64), sign: f64) -> (f64, f64) {
    let highest = largest(points, range, sign);
    let Some(three) = points.windows(3).find(|three| three[1] == highest) else {
        return (f64::NAN, f64::NAN);
    };
    let [(a, before), (b, middle), (c, after)] = [three[0], three[1], three[2]];
    // Newton's form: middle + s (t − b) + k (t − b)(t − a).
    let (left, right) = ((middle - before) / (b - a), (after - middle) / (c - b));
    let k = (right - left) / (c - a);
    let t = 0.5 * (a + b) - 0.5 * left / k;
    (t, middle + left * (t - b) + k * (t - b) * (t - a))
}

/// The extremum nearest to a time.
pub fn nearest(extrema: &[(f64, f64)], time: f64) -> (f64, f64) {
    let nearest = extrema.iter().min_by(|a, b| (a.0 - time).abs().total_cmp(&(b.0 - time).abs()));
    nearest.copied().unwrap_or((f64::NAN, f64::NAN))
}
