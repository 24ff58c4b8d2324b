//! The load factors or times at which every run has a row.

use crate::error::SceneError;
use crate::scene::{Analysis, Scene};
use crate::study::settings::time_step;

/// Milestones of a static path, where its increments do not ask for others.
const ON_PATH: usize = 10;
/// Most milestones of a static path that equal increments ask for.
const MOST_ON_PATH: usize = 20;
/// Most milestones of a motion; fewer where its steps are longer than the intervals between them.
const IN_TIME: usize = 100;
/// A row belongs to a milestone that is nearer than this part of the end: more than rounding, less than any step.
const SAME: f64 = 1e-9;

/// Equal intervals of the load factor or the time from 0 to the end; every run has a row at the end of each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Milestones {
    /// The last load factor (1) or time [s].
    end: f64,
    /// Number of intervals.
    count: usize,
}

impl Milestones {
    /// For a static path whose runs have the given numbers of equal increments (automatic ones stop anywhere): ten, or
    /// the largest number of at most twenty that divides them all.
    pub fn on_path(increments: &[usize]) -> Self {
        let common = increments.iter().fold(0, |a, &b| greatest_common_divisor(a, b));
        let count = if common.is_multiple_of(ON_PATH) {
            ON_PATH
        } else {
            (1..=MOST_ON_PATH).rev().find(|count| common.is_multiple_of(*count)).unwrap_or(1)
        };
        Self { end: 1.0, count }
    }

    /// For a motion whose runs have the given time steps: of the numbers of intervals up to a hundred the largest
    /// whose intervals hold a whole number of every step; if there is none, the largest whose intervals are no
    /// shorter than any step, and [`Milestones::step`] says which step comes nearest to one that is wanted.
    pub fn in_time(end: f64, steps: &[f64]) -> Self {
        let whole = |count: &usize| {
            steps.iter().all(|step| {
                let number = end / (*count as f64 * step);
                number.round() >= 1.0 && (number - number.round()).abs() <= SAME * number
            })
        };
        let longest = steps.iter().fold(0.0_f64, |a, &b| a.max(b));
        let fits = ((end / longest) as usize).clamp(1, IN_TIME);
        let count = (1..=IN_TIME).rev().find(whole).unwrap_or(fits);
        Self { end, count }
    }

    /// For one scene with its own settings.
    ///
    /// # Errors
    /// [`SceneError`] if the scene asks for modes, which have no path.
    pub fn of(scene: &Scene) -> Result<Self, SceneError> {
        match scene.analysis() {
            Some(Analysis::Dynamics(options)) => {
                Ok(Self::in_time(options.end_time, time_step(options).as_slice()))
            }
            Some(Analysis::Modes(_)) => Err(no_path()),
            Some(Analysis::Statics(options)) => Ok(Self::on_path(options.increments.as_slice())),
            None => Ok(Self::on_path(&[])),
        }
    }

    /// The milestones themselves, without the start.
    pub fn parameters(&self) -> Vec<f64> {
        (1..=self.count).map(|k| self.end * (k as f64 / self.count as f64)).collect()
    }

    /// Number of intervals.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The time step that divides an interval and is nearest to the wanted one, in ratio.
    pub fn step(&self, wanted: f64) -> f64 {
        self.step_of(self.steps(wanted))
    }

    /// How many of the steps nearest to the wanted one make an interval.
    pub fn steps(&self, wanted: f64) -> usize {
        // Saturates; a scene with so many steps is refused by its validation.
        (self.end / (self.count as f64 * wanted)).round().max(1.0) as usize
    }

    /// The time step of which so many make an interval [s].
    pub fn step_of(&self, number: usize) -> f64 {
        self.end / (self.count as f64 * number as f64)
    }

    /// The milestone of a row, 0 the start.
    pub(super) fn index_of(&self, parameter: f64) -> Option<usize> {
        let place = parameter / self.end * self.count as f64;
        let index = place.round();
        ((place - index).abs() <= SAME * self.count as f64).then_some(index as usize)
    }
}

/// Modes are numbers, not a path.
pub(super) fn no_path() -> SceneError {
    SceneError::new("modes", "have no path on which runs could be compared", "`[statics]` or `[dynamics]`")
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_increments_pass_through_all_milestones() {
        for (increments, wanted) in [
            (&[][..], 10),
            (&[500], 10),
            (&[50, 500], 10),
            (&[7], 7),
            (&[12, 18], 6),
            (&[23], 1),
            (&[40, 30], 10),
        ] {
            assert_eq!(Milestones::on_path(increments).count(), wanted, "{increments:?}");
        }
    }

    #[test]
    fn steps_divide_the_intervals() {
        for (end, steps, wanted) in [
            (8.0, &[5e-3][..], 100),
            (8.0, &[5e-3, 2.5e-3, 1e-2], 100),
            (1.0, &[0.1, 0.05], 10),
            (1.0, &[0.3], 3),
            (2.0, &[0.25, 0.4], 1),
        ] {
            let milestones = Milestones::in_time(end, steps);
            assert_eq!(milestones.count(), wanted, "{steps:?}");
        }
        // 1/0.3 is no whole number: three intervals, and the nearest step is a third.
        assert_eq!(Milestones::in_time(1.0, &[0.3]).step(0.3), 1.0 / 3.0);
        assert_eq!(Milestones::in_time(8.0, &[5e-3]).step(5e-3), 5e-3);
    }

    #[test]
    fn rows_belong_to_milestones_in_spite_of_rounding() {
        let milestones = Milestones::in_time(0.7, &[0.001]);
        for (k, parameter) in milestones.parameters().into_iter().enumerate() {
            assert_eq!(milestones.index_of(parameter * (1.0 + 1e-14)), Some(k + 1));
        }
        assert_eq!(milestones.index_of(0.0), Some(0));
        assert_eq!(milestones.index_of(0.0005), None);
    }
}
