//! Steps as long as their error allows.
//!
//! # The error of a step
//! A method of order p errs in a step by C h^{p+1} q^{(p+1)}: over the time T, as long as errors only add up, by
//! ∫ C h^p |q^{(p+1)}| dt, and this is what `accuracy` bounds. Hence each step is held to
//!
//! ```text
//! C h^p T |d| ≤ accuracy     d = (r^{(p+1)}/L, φ^{(p+1)}), the largest of all nodes and bodies
//! ```
//!
//! with the length scale L of the model; generalized-α has p = 2 and C of [`super::generalized_alpha`]. Errors of
//! velocities are not tested. With steps of one length theirs, ∫ C h² r⁗ dt = C h² [r‴], move nothing by more than the
//! same bound in the time T. In a vibration cos ωt they are largest where d vanishes: with h² as 1/|d| they move, as a
//! part of the bound, the mean of |tan ωt|, which is (4/π) ln R where the longest step is R times the shortest: three
//! times as much as positions for R = 10.
//!
//! # What is too fast to be followed
//! A slender rod swings in modes of any frequency. A part of q of the amplitude A and the frequency ω has
//! |d| = ω^{p+1} A, so C h^p T |d| may be large, though that part can be wrong by 2 A at most: once it is out of
//! phase, it cannot become more so. It is as fast as this from
//!
//! ```text
//! C h^p T ω_c^{p+1} = 2
//! ```
//!
//! on, so d passes through a low-pass filter of order p + 1, |H| = |1 + iω/ω_c|^{−(p+1)}: of what is slower than ω_c
//! the error of the phase counts, of what is faster its amplitude, C h^p T ω^{p+1} A (ω_c/ω)^{p+1} = 2 A. What is out
//! of phase by T therefore asks for short steps only where it swings by more than half the accuracy. The filter is
//! a row of p + 1 averages, s_k ← s_k + (1 − e^{−ω_c h}) (s_{k−1} − s_k) with s₀ = d, which begin with nothing: t after
//! d has begun s_{p+1} is d (ω_c t)^{p+1}/(p + 1)!, and the test sees 2 d t^{p+1}/(p + 1)!, twice the way that d has
//! led to. Hence a blow is noticed when it has moved something by half the accuracy, whatever the step.
//!
//! Where a load bends, and at the start, d jumps. A method that remembers more than the last state does not know,
//! and is off by velocities K h^p Δd, which over T lead anywhere; the first step after it is held to
//! K h^p T |Δd| ≤ accuracy, too, without a filter. (What is smooth needs no such test: K is less than C.) Where rods are
//! let go Δd is as large as the mesh is fine, so the test asks for no step below a millionth of the motion.
//!
//! # The next step
//! With e the error of a step over what is allowed, h is multiplied by the lesser of
//!
//! ```text
//! (θ/e)^{1/p}     and     (θ/e)^{1/4p} (θ/e₋)^{1/4p} (h/h₋)^{−1/4}
//! ```
//!
//! the second being the filter H211b of Söderlind (2003) with b = 4: steps, and joints' forces with them, change
//! smoothly. e₋ and h₋ are those of the step before. A step with e > 1 is done again with h (θ/e)^{1/p}. One whose
//! equations are not solved is done again with half of it, and h grows beyond that but slowly.

use super::Moving;
use crate::inertia::Velocity;

/// θ: what a step aims at, of what is allowed, so that few are done again.
const AIM: f64 = 0.7;

/// A step is no longer than this part of the motion: rows are there to be looked at, too.
const LONGEST: f64 = 1e-2;

/// Nor shorter than this one: time itself has 16 digits, and accelerations carry its rounding over h².
const SHORTEST: f64 = 1e-10;

/// Largest growth from one step to the next, and largest drop.
const GROWTH: f64 = 2.0;
const DROP: f64 = 0.1;

/// The shortest step, as a part of the motion, that is held to what a kink does.
const SHORTEST_KINKED: f64 = 1e-6;

/// Growth of the longest step that can be solved, from one step to the next.
const RECOVERY: f64 = 1.05;

/// A change of the step by less than this part is none.
const IDLE: f64 = 0.05;

/// What is known of the error of a method.
#[derive(Clone, Copy, Debug)]
pub struct Leading {
    /// p.
    pub order: i32,
    /// C.
    pub constant: f64,
    /// K: where d jumps by Δd from one step to the next, velocities are off by K h^p Δd ever after.
    pub kink: f64,
}

/// The control of the steps.
pub struct Accuracy {
    accuracy: f64,
    duration: f64,
    /// L.
    size: f64,
    leading: Leading,
    /// d of every node, and s_1 … s_{p+1} of every node in a row.
    derivatives: Vec<Velocity>,
    averages: Vec<Velocity>,
    /// Those with the last step.
    next: Vec<Velocity>,
    /// d of the last step that was accepted, and whether the next one follows a kink.
    last: Vec<Velocity>,
    kinked: bool,
    /// h and e of the step before; `None` before the first.
    before: Option<(f64, f64)>,
    length: f64,
    /// What the equations of a step can be solved for, as far as known.
    longest: f64,
}

impl Accuracy {
    /// From a consistent start. The first step moves the rest of the motion, with the accelerations there, by what
    /// the accuracy allows.
    pub fn new(accuracy: f64, duration: f64, leading: Leading, start: &Moving) -> Self {
        let size = start.model.size;
        let nodes = start.motion.accelerations.len();
        let averages = vec![Velocity::default(); nodes * (leading.order + 1) as usize];
        let fastest = largest(start.motion.accelerations.iter().copied(), size);
        let first = (accuracy / fastest).sqrt();
        Self {
            accuracy,
            duration,
            size,
            leading,
            derivatives: vec![Velocity::default(); nodes],
            last: vec![Velocity::default(); nodes],
            kinked: true,
            next: averages.clone(),
            averages,
            before: None,
            length: first.clamp(SHORTEST * duration, LONGEST * duration),
            longest: LONGEST * duration,
        }
    }

    /// The step to take when there is nothing to be met [s].
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The shortest step that is tried [s]. What has to be met may ask for a shorter one.
    pub fn shortest(&self) -> f64 {
        SHORTEST * self.duration
    }

    /// e of a step, whose d `derive` writes.
    pub fn judge(&mut self, length: f64, derive: impl FnOnce(&mut [Velocity])) -> f64 {
        let Leading { order, constant, kink } = self.leading;
        derive(&mut self.derivatives);
        let rate = constant * length.powi(order) * self.duration;
        let cutoff = (2.0 / rate).powf(1.0 / f64::from(order + 1));
        let part = -(-cutoff * length).exp_m1();
        let stages = (order + 1) as usize;
        let mut worst = 0.0_f64;
        let rows = self.averages.chunks_exact(stages).zip(self.next.chunks_exact_mut(stages));
        for (d, (averages, next)) in self.derivatives.iter().zip(rows) {
            let mut input = *d;
            for (average, next) in averages.iter().zip(next) {
                next.translation = average.translation + (input.translation - average.translation) * part;
                next.rotation = average.rotation + (input.rotation - average.rotation) * part;
                input = *next;
            }
            worst = larger(worst, weighed(&input, self.size));
        }
        if self.kinked && length > SHORTEST_KINKED * self.duration {
            let jumps = self.derivatives.iter().zip(&self.last).map(|(now, before)| Velocity {
                translation: now.translation - before.translation,
                rotation: now.rotation - before.rotation,
            });
            worst = larger(worst, kink / constant * largest(jumps, self.size));
        }
        rate * worst / self.accuracy
    }

    /// The next step follows a kink.
    pub fn kink(&mut self) {
        self.kinked = true;
    }

    /// After a step with e ≤ 1.
    pub fn accept(&mut self, length: f64, error: f64) {
        std::mem::swap(&mut self.averages, &mut self.next);
        self.last.copy_from_slice(&self.derivatives);
        self.kinked = false;
        let order = f64::from(self.leading.order);
        let (x, alone) = (0.25 / order, aim(error, 1.0 / order));
        let factor = match self.before {
            Some((before, error_before)) => {
                alone.min(aim(error, x) * aim(error_before, x) * (length / before).powf(-0.25))
            }
            None => alone,
        };
        self.before = Some((length, error));
        let factor = if (factor - 1.0).abs() < IDLE { 1.0 } else { factor.clamp(DROP, GROWTH) };
        self.longest = (self.longest * RECOVERY).min(LONGEST * self.duration);
        self.length = (length * factor).min(self.longest);
    }

    /// After a step with e > 1.
    pub fn reject(&mut self, length: f64, error: f64) {
        let wanted = aim(error, 1.0 / f64::from(self.leading.order));
        // NaN is as bad as it can be.
        let factor = if error.is_finite() { wanted.max(DROP) } else { DROP };
        self.length = length * factor;
    }

    /// After a step whose equations were not solved.
    pub fn halve(&mut self, length: f64) {
        self.longest = 0.5 * length;
        self.length = self.longest;
    }
}

/// (θ/e)^x; an error of nothing lets a step grow like a small one.
fn aim(error: f64, exponent: f64) -> f64 {
    (AIM / error.max(1e-12)).powf(exponent)
}

/// max (|r|/L, |φ|) of one.
fn weighed(x: &Velocity, size: f64) -> f64 {
    larger(x.translation.norm() / size, x.rotation.norm())
}

/// The largest of all.
fn largest(values: impl Iterator<Item = Velocity>, size: f64) -> f64 {
    values.map(|x| weighed(&x, size)).fold(0.0, larger)
}

/// The larger, or NaN if one is.
fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::Model;
    use crate::scene::{Dynamics, Scene};

    const LEADING: Leading = Leading { order: 2, constant: 0.1, kink: 0.01 };

    fn control(accuracy: f64, duration: f64) -> Accuracy {
        let scene = "[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n";
        let mut scene =
            Scene::from_toml(&format!("{scene}[dynamics]\nend_time = 1\ntime_step = 0.1\n")).unwrap();
        scene.dynamics = Some(Dynamics::accurate(duration, accuracy));
        let model = Model::new(&scene).unwrap();
        Accuracy::new(accuracy, duration, LEADING, &Moving::new(&model))
    }

    fn along(x: f64) -> Velocity {
        Velocity { translation: Vector3::new(x, 0.0, 0.0), rotation: Vector3::zeros() }
    }

    /// e of A sin ωt after many steps, at its largest.
    fn of_vibration(amplitude: f64, frequency: f64, length: f64, duration: f64) -> f64 {
        let mut control = control(1.0, duration);
        let mut largest = 0.0_f64;
        let steps = (duration / length) as usize;
        for step in 1..=steps {
            let time = (step as f64 - 0.5) * length;
            let d = -amplitude * frequency.powi(3) * (frequency * time).cos();
            let error = control.judge(length, |derivatives| derivatives[0] = along(d));
            control.accept(length, error);
            largest = if step > steps / 2 { largest.max(error) } else { 0.0 };
        }
        largest
    }

    /// C h² T ω³ A where that is small, 2 A where it is not: ω_c = (2/(C h² T))^{1/3} = 27 for h = 0.01, T = 10.
    #[test]
    fn slow_vibrations_count_with_their_phase_and_fast_ones_with_their_amplitude() {
        let (length, duration) = (1e-2, 10.0);
        let slow = of_vibration(1.0, 1.0, length, duration);
        // |H| at ω/ω_c = 1/27 is 1 − 3/2 · 27⁻².
        assert!((slow / (0.1 * length * length * duration) - 1.0).abs() < 3e-3, "{slow}");
        // |H| at ω/ω_c = 150/27 is 0.95 of (ω_c/ω)³; averages of steps of ω h = 1.5 differ from those of functions.
        let fast = of_vibration(1.0, 150.0, length, duration);
        assert!(fast > 1.0 && fast < 4.0, "{fast}");
    }

    /// What has just begun is noticed by twice the way it has led to, whatever the step.
    #[test]
    fn a_new_derivative_counts_with_the_way_it_has_led_to() {
        for length in [1e-6, 1e-7] {
            let mut control = control(1.0, 1.0);
            control.kinked = false;
            let (d, steps, mut error) = (8.0, 10.0, 0.0);
            for _ in 0..10 {
                error = control.judge(length, |derivatives| derivatives[0] = along(d));
                control.accept(length, error);
            }
            // t³/6 as a sum of steps.
            let way = d * length.powi(3) * steps * (steps + 1.0) * (steps + 2.0) / 6.0;
            let cutoff = (2.0 / (0.1 * length * length)).cbrt();
            // 1 − ¾ ω_c t + …, 0.15 to 0.3.
            let part = error / (2.0 * way);
            assert!(part < 1.0 && part > 1.0 - cutoff * steps * length, "{part}");
        }
    }

    #[test]
    fn the_first_step_after_a_kink_is_held_to_it() {
        let mut control = control(1e-3, 2.0);
        let judge = |control: &mut Accuracy| control.judge(1e-3, |derivatives| derivatives[0] = along(500.0));
        // Δd = 1e12 in the shortest step would be K h² T |Δd| = 1e-2 · 1e-12 · 2 · 1e12/1e-3 = 20.
        assert!(control.judge(1e-6, |derivatives| derivatives[0] = along(1e12)) < 5.0);
        let error = judge(&mut control);
        assert!((error - 0.01 * 1e-6 * 2.0 * 500.0 / 1e-3).abs() < 1e-12, "{error}");
        control.accept(1e-3, 0.5);
        let smooth = judge(&mut control);
        assert!(smooth < 0.3 * error, "{smooth}");
        control.kink();
        assert_eq!(judge(&mut control), smooth);
        assert!(control.judge(1e-3, |derivatives| derivatives[0] = along(f64::NAN)).is_nan());
    }

    #[test]
    fn steps_settle_where_the_error_is_what_is_aimed_at() {
        let mut control = control(1e-3, 1e3);
        let error = |length: f64| (length / 0.03).powi(2);
        for _ in 0..60 {
            let length = control.length();
            let e = error(length);
            if e <= 1.0 { control.accept(length, e) } else { control.reject(length, e) }
        }
        let e = error(control.length());
        // Within what is no change: (1 + IDLE)^{2p}.
        assert!(e > AIM * 1.05_f64.powi(-4) && e < AIM * 1.05_f64.powi(4), "{e}");
        control.reject(1.0, f64::NAN);
        assert_eq!(control.length(), DROP);
        control.halve(0.02);
        assert_eq!(control.length(), 0.01);
        control.accept(0.01, 1e-9);
        assert_eq!(control.length(), 0.01 * RECOVERY);
    }
}
