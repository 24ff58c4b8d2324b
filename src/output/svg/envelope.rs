//! How far an oscillation swings, and when it swings least and most.

use super::path::Point;

/// Turns by less than this share of the whole range are noise.
const NOISE: f64 = 1e-3;
/// Fewer extrema are no oscillation.
const FEWEST: usize = 8;
/// An envelope that varies by less than this share of its largest value does not beat.
const BEAT: f64 = 0.2;
/// How deep the valleys of an envelope must be, and how high its summits: within this share of its range from
/// its lowest or highest point. Beats that repeat have many, and samples make one of them the extreme.
const TIE: f64 = 0.1;

/// Two consecutive extrema of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Midway between the two.
    pub time: f64,
    /// The mean of the two.
    pub mean: f64,
    /// Half their difference; not negative.
    pub amplitude: f64,
}

/// When an oscillation swings least and most.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beat {
    pub least: Option<f64>,
    pub most: Option<f64>,
}

/// The swings of a signal, a list of (time, value) with increasing times; none unless it oscillates.
pub fn envelope(signal: &[Point]) -> Vec<Swing> {
    let extrema = extrema(signal);
    if extrema.len() < FEWEST {
        return Vec::new();
    }
    swings(&extrema)
}

fn swings(extrema: &[Point]) -> Vec<Swing> {
    let swing = |pair: &[Point]| Swing {
        time: 0.5 * (pair[0][0] + pair[1][0]),
        mean: 0.5 * (pair[0][1] + pair[1][1]),
        amplitude: 0.5 * (pair[0][1] - pair[1][1]).abs(),
    };
    extrema.windows(2).map(swing).collect()
}

/// Maxima and minima in turn, (time, value), each at the vertex of the parabola through three samples; the first
/// and the last sample are none.
pub fn extrema(signal: &[Point]) -> Vec<Point> {
    let values = signal.iter().map(|point| point[1]);
    let (low, high) = values
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let noise = NOISE * (high - low);
    if !(noise.is_finite() && noise > 0.0) {
        return Vec::new();
    }
    let mut found = Vec::new();
    // Candidates since the last extremum: the lowest and the highest sample.
    let (mut lowest, mut highest) = (0, 0);
    let mut rising = None;
    for (k, point) in signal.iter().enumerate() {
        if point[1] < signal[lowest][1] {
            lowest = k;
        }
        if point[1] > signal[highest][1] {
            highest = k;
        }
        if rising != Some(false) && point[1] < signal[highest][1] - noise {
            found.push(highest);
            (rising, lowest) = (Some(false), k);
        } else if rising != Some(true) && point[1] > signal[lowest][1] + noise {
            found.push(lowest);
            (rising, highest) = (Some(true), k);
        }
    }
    // The signal has turned after each of them, so none is the last sample; the first one may be found.
    found.iter().filter_map(|&k| signal.get(k.checked_sub(1)?..=k + 1)).map(vertex).collect()
}

/// The vertex of the parabola through three points, the middle one highest or lowest.
fn vertex(points: &[Point]) -> Point {
    let [before, here, after] = [points[0], points[1], points[2]];
    // Newton's form about the middle point: v + slope s + curvature s².
    let (left, right) = (here[0] - before[0], after[0] - here[0]);
    let (rise, fall) = ((here[1] - before[1]) / left, (after[1] - here[1]) / right);
    let curvature = (fall - rise) / (left + right);
    let slope = (rise * right + fall * left) / (left + right);
    let step = -0.5 * slope / curvature;
    // Where the three lie on a line, as with equal samples, the middle one will do.
    if step.is_finite() && -left <= step && step <= right {
        [here[0] + step, here[1] + 0.5 * slope * step]
    } else {
        here
    }
}

/// The lower and the upper side of an envelope. It stands about the mean of the two extrema of every swing, averaged
/// over its neighbours with the weights ¼, ½, ¼: where the amplitude changes, the mean alternates from swing to
/// swing, and both sides would be stairs.
pub fn sides(swings: &[Swing]) -> [Vec<Point>; 2] {
    let mean = |k: usize| {
        let before = swings[k.saturating_sub(1)].mean;
        let after = swings[(k + 1).min(swings.len() - 1)].mean;
        match k {
            0 => 0.5 * (swings[k].mean + after),
            k if k + 1 == swings.len() => 0.5 * (before + swings[k].mean),
            k => 0.25 * before + 0.5 * swings[k].mean + 0.25 * after,
        }
    };
    [-1.0, 1.0].map(|sign| {
        let points = swings.iter().enumerate();
        points.map(|(k, swing)| [swing.time, mean(k) + sign * swing.amplitude]).collect()
    })
}

/// When the swing is least and most for the first time, away from both ends of the record; never, if it does not
/// beat.
pub fn beat(swings: &[Swing]) -> Beat {
    let first = |swings: Vec<Swing>| swings.first().map(|swing| swing.time);
    Beat { least: first(valleys(swings)), most: first(summits(swings)) }
}

/// Of a second oscillation that takes up what the first gives away: the summit next to the first one's least
/// swing, the valley next to its most.
pub fn answering(swings: &[Swing], first: Beat) -> Beat {
    let nearest = |swings: Vec<Swing>, to: Option<f64>| {
        let to = to?;
        let distance = |swing: &Swing| (swing.time - to).abs();
        swings.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|swing| swing.time)
    };
    Beat { least: nearest(valleys(swings), first.most), most: nearest(summits(swings), first.least) }
}

fn valleys(swings: &[Swing]) -> Vec<Swing> {
    let turned: Vec<Swing> =
        swings.iter().map(|swing| Swing { amplitude: -swing.amplitude, ..*swing }).collect();
    let upright = |swing: Swing| Swing { amplitude: -swing.amplitude, ..swing };
    summits(&turned).into_iter().map(upright).collect()
}

/// Local maxima of the amplitude that are high, without the first and the last swing.
fn summits(swings: &[Swing]) -> Vec<Swing> {
    let amplitudes = swings.iter().map(|swing| swing.amplitude);
    let (low, high) = amplitudes.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), amplitude| {
        (low.min(amplitude), high.max(amplitude))
    });
    if high - low < BEAT * high.abs().max(low.abs()) {
        return Vec::new();
    }
    let threshold = high - TIE * (high - low);
    let triples = swings.windows(3).filter(|triple| {
        let [before, here, after] = [0, 1, 2].map(|k| triple[k].amplitude);
        here >= threshold && here >= before && here > after
    });
    triples.map(|triple| triple[1]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn sampled(end: f64, step: f64, signal: impl Fn(f64) -> f64) -> Vec<Point> {
        (0..=(end / step) as usize).map(|k| k as f64 * step).map(|time| [time, signal(time)]).collect()
    }

    /// a cos ω₁t + b cos ω₂t swings by √(a² + b² + 2ab cos Δt), Δ = ω₂ − ω₁.
    #[test]
    fn the_envelope_of_a_beat_is_the_known_one() {
        let (a, b, mean) = (1.0, 0.6, 3.0);
        let (slow, fast) = (15.0, 16.5);
        let signal = sampled(20.0, 5e-3, |t| mean + a * (slow * t).cos() + b * (fast * t).cos());
        let swings = envelope(&signal);
        // On the average the larger part sets the pace; it is slowest where the swing is least.
        assert!((swings.len() as f64 - 20.0 * slow / PI).abs() < 3.0);
        let (delta, slowest) = (fast - slow, (a * slow - b * fast) / (a - b));
        // A swing sees the envelope e at two times, which costs e″ (π/2ω)²/2, and extrema lie beside the envelope by
        // e′²/2eω²; e″ ≤ abΔ²/(a − b) = 1.5 Δ² and e′²/e ≤ 1.5 Δ²: together less than 3 (Δ/ω)².
        let bound = 3.0 * (delta / slowest).powi(2);
        for swing in &swings {
            let wanted = (a * a + b * b + 2.0 * a * b * (delta * swing.time).cos()).sqrt();
            assert!((swing.amplitude - wanted).abs() < bound, "{swing:?} {wanted}");
        }
        let beat = beat(&swings);
        // Swings are at most π/ω apart; the extreme one is a neighbour of the true extreme.
        let period = TAU / delta;
        let off = |time: Option<f64>, phase: f64| {
            let beats = time.unwrap() / period - phase;
            (beats - beats.round()).abs() * period
        };
        assert!(off(beat.least, 0.5) < PI / slowest, "{beat:?}");
        assert!(off(beat.most, 0.0) < PI / slowest, "{beat:?}");
    }

    #[test]
    fn an_oscillation_that_takes_up_the_other_answers_it() {
        let signal = |sign: f64| sampled(16.0, 5e-3, |t| (15.0 * t).cos() + sign * 0.7 * (16.5 * t).cos());
        let first = beat(&envelope(&signal(1.0)));
        let second = answering(&envelope(&signal(-1.0)), first);
        let [least, most] = [first.least.unwrap(), first.most.unwrap()];
        let swing = PI / 15.75;
        assert!((second.most.unwrap() - least).abs() <= swing);
        assert!((second.least.unwrap() - most).abs() <= swing);
    }

    #[test]
    fn a_parabola_is_met_exactly_between_uneven_samples() {
        let parabola = |t: f64| 2.0 - 3.0 * (t - 0.37).powi(2);
        let points: Vec<Point> = [0.0, 0.3, 1.0].map(|t| [t, parabola(t)]).into();
        let [time, value] = vertex(&points);
        assert!((time - 0.37).abs() < 1e-14 && (value - 2.0).abs() < 1e-14);
    }

    #[test]
    fn swings_are_half_the_difference_at_the_middle() {
        let zigzag: Vec<Point> = (0..20).map(|k| [k as f64, if k % 2 == 0 { 1.0 } else { -3.0 }]).collect();
        let swings = envelope(&zigzag);
        assert_eq!(swings.len(), 17);
        assert_eq!(swings[0], Swing { time: 1.5, mean: -1.0, amplitude: 2.0 });
        assert_eq!(beat(&swings), Beat::default());
    }

    #[test]
    fn what_does_not_oscillate_has_no_envelope() {
        let noise = |t: f64| t + 1e-6 * (1e3 * t).sin();
        for signal in [
            Vec::new(),
            vec![[0.0, 1.0]],
            sampled(1.0, 0.01, |_| 3.0),
            sampled(1.0, 0.01, |t| t * t),
            sampled(1.0, 0.001, noise),
            sampled(1.0, 0.01, |t| (3.0 * TAU * t).sin()),
            sampled(1.0, 0.01, |_| f64::NAN),
            sampled(1.0, 0.01, |t| (100.0 * t).sin() * f64::INFINITY),
        ] {
            assert_eq!(envelope(&signal), []);
        }
    }

    #[test]
    fn the_sides_of_an_amplitude_that_grows_evenly_are_straight() {
        let extremum = |k: i32| [f64::from(k), 2.0 + f64::from(if k % 2 == 0 { k } else { -k })];
        let swings = swings(&(0..12).map(extremum).collect::<Vec<Point>>());
        for (sign, side) in [-1.0, 1.0].into_iter().zip(sides(&swings)) {
            for [time, value] in side {
                assert!((value - 2.0 - sign * time).abs() < 1e-12, "{time} {value}");
            }
        }
        assert!(sides(&[]).iter().all(Vec::is_empty));
    }

    #[test]
    fn a_decaying_or_a_steady_oscillation_does_not_beat() {
        for damping in [0.0, 0.3] {
            let swings = envelope(&sampled(10.0, 0.01, |t| (-damping * t).exp() * (10.0 * t).cos()));
            assert!(swings.len() > 25);
            assert_eq!(beat(&swings), Beat::default());
        }
    }
}
