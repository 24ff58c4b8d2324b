//! The rows of a study, and what they advise.

use serde::{Deserialize, Serialize};

use crate::scene::{InterpolationKind, Scene};
use crate::study::Errors;
use crate::study::ladder::common;
use crate::study::reference::elements;
use crate::study::settings::time_step;

/// The status of a run that arrived.
pub const SOLVED: &str = "solved";

/// The settings of a run; what does not apply, or differs among rods, is absent.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Key {
    /// The polynomial degree.
    pub degree: Option<usize>,
    /// The elements, all rods together.
    pub elements: Option<usize>,
    /// The interpolation.
    pub interpolation: Option<InterpolationKind>,
    /// The equal load increments; absent: automatic.
    pub increments: Option<usize>,
    /// The constant time step [s]; absent in dynamics: the scene's accuracy.
    pub time_step: Option<f64>,
    /// The absolute max-norm of the residual; absent: the unit-free test.
    pub tolerance: Option<f64>,
}

impl Key {
    /// Of a variant of a scene.
    pub fn of(variant: &Scene) -> Self {
        let (statics, dynamics) = (variant.statics.as_ref(), variant.dynamics.as_ref());
        Self {
            degree: common(variant, |rod| rod.degree),
            elements: elements(variant),
            interpolation: common(variant, |rod| rod.interpolation),
            increments: statics.and_then(|options| options.increments),
            time_step: dynamics.and_then(time_step),
            tolerance: statics
                .map(|options| options.tolerance)
                .or(dynamics.map(|options| options.tolerance))
                .flatten(),
        }
    }
}

/// One run of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its settings.
    pub key: Key,
    /// Against the reference; absent where it failed.
    pub errors: Option<Errors>,
    /// Processor time of the solve [s]; absent where it failed.
    pub seconds: Option<f64>,
    /// Newton iterations, those of rejected increments included, and of a run that failed those until then; absent
    /// where nothing was begun.
    pub newton_iterations: Option<usize>,
    /// Factorisations of the tangent, counted alike.
    pub factorizations: Option<usize>,
    /// [`SOLVED`], or why it failed.
    pub status: String,
}

/// What an error is taken of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Positions, relative to the length of all rods together.
    Position,
    /// Rotations [rad].
    Rotation,
    /// The larger of both.
    Largest,
}

impl Measure {
    /// The error of a run; `None` if it failed.
    pub fn of(self, row: &Row) -> Option<f64> {
        let errors = row.errors?;
        Some(match self {
            Self::Position => errors.position,
            Self::Rotation => errors.rotation,
            Self::Largest => errors.largest(),
        })
    }
}

/// The Pareto front: indices of the runs than which none is both as fast and as accurate, from the fastest to the
/// most accurate. Of equals the first.
pub fn front(rows: &[Row], measure: Measure) -> Vec<usize> {
    let mut order: Vec<(usize, f64, f64)> = rows
        .iter()
        .enumerate()
        .filter_map(|(index, row)| Some((index, row.seconds?, measure.of(row)?)))
        .collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut best = f64::INFINITY;
    order.retain(|(_, _, error)| {
        let better = *error < best;
        best = best.min(*error);
        better
    });
    order.into_iter().map(|(index, ..)| index).collect()
}

/// What a study says about an accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advice<'a> {
    /// The fastest run that reaches it.
    Take(&'a Row),
    /// No run reaches it; the most accurate one, if any run arrived at all.
    Unreached(Option<&'a Row>),
    /// The error of the reference is larger.
    Unknown,
}

/// The fastest run whose error and that of the reference together are at most `accuracy`: its distance from what the
/// reference stands for is no more than the two errors.
pub fn advice<'a>(rows: &'a [Row], accuracy: f64, reference: &Errors) -> Advice<'a> {
    if reference.largest() >= accuracy {
        return Advice::Unknown;
    }
    let front = front(rows, Measure::Largest);
    let reaches = |row: &Row| {
        row.errors.is_some_and(|errors| {
            errors.position + reference.position <= accuracy
                && errors.rotation + reference.rotation <= accuracy
        })
    };
    let mut candidates = front.iter().map(|&index| &rows[index]);
    match candidates.find(|row| reaches(row)) {
        Some(row) => Advice::Take(row),
        None => Advice::Unreached(front.last().map(|&index| &rows[index])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(degree: usize, run: Option<(f64, f64)>) -> Row {
        Row {
            key: Key { degree: Some(degree), ..Key::default() },
            errors: run.map(|(_, error)| Errors { position: 0.5 * error, rotation: error }),
            seconds: run.map(|(seconds, _)| seconds),
            newton_iterations: None,
            factorizations: None,
            status: if run.is_some() { SOLVED } else { "stopped" }.to_owned(),
        }
    }

    fn rows() -> Vec<Row> {
        let runs = [
            Some((3.0, 1e-3)),
            None,
            Some((1.0, 1e-1)),
            Some((2.0, 1e-4)),
            Some((4.0, 1e-6)),
            Some((4.0, 1e-7)),
            Some((9.0, 1e-7)),
        ];
        runs.into_iter().enumerate().map(|(index, run)| row(index + 1, run)).collect()
    }

    #[test]
    fn the_front_has_what_nothing_beats() {
        assert_eq!(front(&rows(), Measure::Largest), [2, 3, 5]);
        assert_eq!(front(&rows(), Measure::Position), [2, 3, 5]);
        assert_eq!(front(&rows()[1..2], Measure::Rotation), [] as [usize; 0]);
    }

    #[test]
    fn advice_counts_the_error_of_the_reference() {
        let rows = rows();
        let exact = Errors::default();
        let taken = |accuracy, reference: &Errors| match advice(&rows, accuracy, reference) {
            Advice::Take(row) => row.key.degree,
            _ => None,
        };
        assert_eq!(taken(1e-1, &exact), Some(3));
        assert_eq!(taken(1e-4, &exact), Some(4));
        let coarse = Errors { position: 0.0, rotation: 1e-5 };
        assert_eq!(taken(1e-1, &coarse), Some(4));
        assert_eq!(taken(1e-4, &coarse), Some(6));
        assert_eq!(advice(&rows, 1e-5, &coarse), Advice::Unknown);
        assert_eq!(advice(&rows, 1e-8, &exact), Advice::Unreached(Some(&rows[5])));
        assert_eq!(advice(&rows[1..2], 1.0, &exact), Advice::Unreached(None));
    }
}
