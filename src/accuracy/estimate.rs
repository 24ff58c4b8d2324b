//! What a sequence of refined runs says about the error of the finest.

use crate::study::{Errors, Trajectory, compare};

/// The estimate is so many times what the observed order foretells.
const SAFETY: f64 = 3.0;
/// Least order: a method of order 2 that is not asymptotic yet may show little more than half of it.
const LEAST_ORDER: f64 = 1.0;
/// Runs nearer to each other than this agree: rounding and what Newton's iteration leaves.
const SAME: f64 = 1e-10;
/// Distances that fall no more are noise if they are this small,
const NOISE: f64 = 1e-6;
/// and have fallen by this factor before.
const FALLEN: f64 = 1e-3;

/// What the runs say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Verdict {
    /// Nothing yet.
    Open,
    /// They converge; the error of the finest.
    Converging(Errors),
    /// They have converged as far as they can; the error of any of the last.
    Noise(Errors),
}

/// How far an observed order is believed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Belief {
    /// Above this it is chance.
    pub most_order: f64,
    /// Largest d₂/e, distance of the last two runs over the error of the finest, that may follow from it.
    pub most_gain: f64,
}

impl Belief {
    /// Of an order at most.
    pub(super) fn up_to(most_order: f64) -> Self {
        Self { most_order, most_gain: f64::INFINITY }
    }

    /// Of an order that tells little: the estimate is so many times the distance itself, or more where the order is so
    /// low that the distance is less than the error.
    pub(super) fn little(most_order: f64, times: f64) -> Self {
        Self { most_order, most_gain: SAFETY / times }
    }
}

/// Paths of one scene with growing numbers of elements, or of steps.
#[derive(Clone, Debug)]
pub(super) struct Sequence {
    belief: Belief,
    sizes: Vec<f64>,
    /// Of each from the one before.
    distances: Vec<Errors>,
    last: Option<Trajectory>,
}

impl Sequence {
    pub(super) fn new(belief: Belief) -> Self {
        Self { belief, sizes: Vec::new(), distances: Vec::new(), last: None }
    }

    /// Adds a finer run; one that has nothing in common with the last starts anew.
    pub(super) fn push(&mut self, size: f64, trajectory: Trajectory) {
        match self.last.as_ref().and_then(|last| compare(&trajectory, last)) {
            Some(distance) => self.distances.push(distance),
            None => self.clear(),
        }
        self.sizes.push(size);
        self.last = Some(trajectory);
    }

    pub(super) fn clear(&mut self) {
        self.sizes.clear();
        self.distances.clear();
        self.last = None;
    }

    pub(super) fn verdict(&self) -> Verdict {
        let part = |of: fn(&Errors) -> f64| self.part(&self.distances.iter().map(of).collect::<Vec<_>>());
        match (part(|distance| distance.position), part(|distance| distance.rotation)) {
            (Part::Open, _) | (_, Part::Open) => Verdict::Open,
            (position, rotation) => {
                let errors = Errors { position: position.value(), rotation: rotation.value() };
                let noise = |part| matches!(part, Part::Noise(_));
                // What still converges may become better, unless noise is the larger part.
                let larger = if errors.position >= errors.rotation { position } else { rotation };
                if noise(larger) { Verdict::Noise(errors) } else { Verdict::Converging(errors) }
            }
        }
    }

    /// Of positions or rotations alone.
    fn part(&self, distances: &[f64]) -> Part {
        let (&[.., s1, s2, s3], &[.., d1, d2]) = (self.sizes.as_slice(), distances) else {
            return Part::Open;
        };
        let both = d1.max(d2);
        if both <= SAME {
            return Part::Noise(both);
        }
        let order = (d1 / d2).ln() / (s2 / s1).ln();
        if order >= LEAST_ORDER {
            let Belief { most_order, most_gain } = self.belief;
            let gain = ((s3 / s2).powf(order.min(most_order)) - 1.0).min(most_gain);
            // An order that cannot be is chance: the error of the run before was small by accident, and the distance is
            // the error itself.
            let gain = if order > most_order { gain.min(SAFETY) } else { gain };
            return Part::Converging(SAFETY * d2 / gain);
        }
        let largest = distances.iter().fold(0.0_f64, |a, &b| a.max(b));
        if both <= NOISE && both <= FALLEN * largest { Part::Noise(SAFETY * both) } else { Part::Open }
    }
}

/// What is known of one kind of error.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Open,
    Converging(f64),
    Noise(f64),
}

impl Part {
    fn value(self) -> f64 {
        match self {
            Self::Open => f64::INFINITY,
            Self::Converging(value) | Self::Noise(value) => value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solution::ProbePose;

    /// A path of one probe along x, off by so much of a length of 1.
    fn path(x: f64) -> Trajectory {
        let pose = ProbePose { position: [x, 0.0, 0.0], quaternion: [1.0, 0.0, 0.0, 0.0], angles: None };
        Trajectory { rows: vec![(1, vec![pose])], size: 1.0 }
    }

    fn verdict(belief: Belief, runs: &[(f64, f64)]) -> Verdict {
        let mut sequence = Sequence::new(belief);
        for (size, error) in runs {
            sequence.push(*size, path(1.0 + error));
        }
        sequence.verdict()
    }

    fn converging(belief: Belief, runs: &[(f64, f64)]) -> f64 {
        match verdict(belief, runs) {
            Verdict::Converging(errors) => errors.position,
            other => panic!("{other:?}"),
        }
    }

    /// Errors c/nᵠ: three times the last of them, but for the order that unequal ratios of the sizes bend.
    #[test]
    fn errors_that_follow_an_order_are_estimated_with_safety() {
        for (order, sizes) in [(8.0, [4.0, 6.0, 9.0]), (4.0, [10.0, 14.0, 20.0]), (2.0, [1.0, 2.0, 4.0])] {
            let errors = sizes.map(|n: f64| 1e-2 * (n / sizes[0]).powf(-order));
            let runs: Vec<(f64, f64)> = sizes.into_iter().zip(errors).collect();
            let ratio = converging(Belief::up_to(9.0), &runs) / errors[2];
            assert!((2.5..=3.5).contains(&ratio), "{order}: {ratio}");
            // At order 4 and a ratio of 1.43, 3.2 times.
            let distance = (errors[1] - errors[2]) / errors[2];
            let ratio = converging(Belief::little(9.0, 1.0), &runs) / errors[2];
            assert!((ratio - distance).abs() <= 0.1 * distance, "{order}: {ratio} {distance}");
        }
        // At order 4, twice refined by 2, the second error small by accident: the distance is the last error, and the
        // order seems to be 8.
        let runs = [(1.0, 2.56e-2), (2.0, 0.0), (4.0, 1e-4)];
        let ratio = converging(Belief::up_to(4.5), &runs) / 1e-4;
        assert!((0.999..=3.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn too_few_runs_and_runs_that_do_not_converge_say_nothing() {
        assert_eq!(verdict(Belief::up_to(9.0), &[(1.0, 0.1), (2.0, 0.01)]), Verdict::Open);
        // A mesh that locks: every refinement moves more than the one before.
        assert_eq!(
            verdict(Belief::up_to(9.0), &[(1.0, 1.0), (2.0, 0.999), (4.0, 0.996), (8.0, 0.98)]),
            Verdict::Open
        );
        // Order one half.
        assert_eq!(verdict(Belief::up_to(9.0), &[(1.0, 1.0), (4.0, 0.5), (16.0, 0.25)]), Verdict::Open);
    }

    #[test]
    fn what_has_fallen_and_falls_no_more_is_noise() {
        let runs = [(1.0, 1e-3), (2.0, 1e-8), (4.0, -1e-8), (8.0, 2e-8)];
        match verdict(Belief::up_to(9.0), &runs) {
            Verdict::Noise(errors) => {
                assert!(errors.position >= 2e-8 && errors.position < 2e-7, "{errors:?}")
            }
            other => panic!("{other:?}"),
        }
        // Nothing to refine: the same from the start.
        let same = [(1.0, 0.0), (2.0, 1e-12), (4.0, 0.0)];
        assert!(
            matches!(verdict(Belief::up_to(9.0), &same), Verdict::Noise(errors) if errors.position <= 1e-11)
        );
    }
}
