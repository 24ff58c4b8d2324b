//! The times that constant steps end at.

/// A last step that is shorter than this part of the others is merged with the one before it.
const SHORTEST_STEP: f64 = 1e-6;

/// Multiples of the step up to the end, where the last one is shorter; with milestones, between every two of them (and
/// the start and the end) the fewest equal steps that are no longer than the step.
pub fn constant(step: f64, end: f64, milestones: &[f64]) -> Box<dyn Iterator<Item = f64> + '_> {
    if milestones.is_empty() {
        let inner = (1..).map(move |k| k as f64 * step);
        let inner = inner.take_while(move |time| end - time >= SHORTEST_STEP * step);
        return Box::new(inner.chain(std::iter::once(end)));
    }
    let ends = milestones.iter().copied().chain(std::iter::once(end));
    let starts = std::iter::once(0.0).chain(milestones.iter().copied());
    Box::new(starts.zip(ends).flat_map(move |(start, end)| {
        let steps = ((end - start) / step - SHORTEST_STEP).ceil().max(1.0);
        // The last one ends at the milestone itself, to the last digit.
        let time = move |k: u64| {
            if k as f64 == steps { end } else { start + (end - start) * (k as f64 / steps) }
        };
        (1..=steps as u64).map(time)
    }))
}

/// Those between the start and the end, in order.
pub fn sorted(milestones: &[f64], end: f64) -> Vec<f64> {
    let mut inside: Vec<f64> = milestones.iter().copied().filter(|time| *time > 0.0 && *time < end).collect();
    inside.sort_by(f64::total_cmp);
    inside.dedup();
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_constant_step_is_shorter_and_never_tiny() {
        let times = |step, end| constant(step, end, &[]).collect::<Vec<_>>();
        assert_eq!(times(0.5, 2.0), [0.5, 1.0, 1.5, 2.0]);
        assert_eq!(times(0.75, 2.0), [0.75, 1.5, 2.0]);
        assert_eq!(times(2.0, 2.0), [2.0]);
        // 3 · 0.1 > 0.3 and 0.1 + 1e-8 is as good as 0.1.
        assert_eq!(times(0.1, 0.3), [0.1, 0.2, 0.3]);
        assert_eq!(times(0.1, 0.2 + 1e-8), [0.1, 0.2 + 1e-8]);
    }

    #[test]
    fn milestones_are_met_by_equal_steps_between_them() {
        let times = constant(0.25, 1.5, &[0.5, 0.875]).collect::<Vec<_>>();
        assert_eq!(times[..4], [0.25, 0.5, 0.6875, 0.875]);
        assert_eq!(times.len(), 7);
        assert_eq!(times[6], 1.5);
        assert!((times[4] - 0.875 - 0.625 / 3.0).abs() < 1e-15);
        assert_eq!(sorted(&[2.0, 0.5, -1.0, f64::NAN, 0.5, 0.25, 0.0], 1.0), [0.25, 0.5]);
    }
}
