//! A slender cantilever under loads in time: sudden and small, slow and large, and let go.

use std::error::Error;

use cosserat::scene::{Dynamics, Load, LoadKind, LoadTime, NamedTime, Rod, Scene, Statics};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies::{DENSITY, FILE, LENGTH, POISSON, YOUNG, bending, steel};
use crate::measure::{clamp, load, probe, solve};
use crate::motion::{Recursion, follow, place};
use crate::pieces::{circle, line};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "cantilever_motion::sudden_load",
            "w = Σ 4F/(ρAL ω_k²)(1 − cos ω_k t) of the Euler–Bernoulli cantilever, by the method's recursion",
            sudden_load,
        )
        .reads(&[FILE]),
        Case::new(
            "cantilever_motion::slow_load",
            "statics; what is left over oscillates with w_s/(ωT)",
            slow_load,
        )
        .reads(&[FILE]),
        Case::new(
            "cantilever_motion::energy",
            "no load, no loss: dissipation of the method as an order",
            energy,
        )
        .reads(&[FILE]),
    ]
}

const DIAMETER: f64 = 0.01;
const AREA: f64 = std::f64::consts::PI * DIAMETER * DIAMETER / 4.0;
const BENDING: f64 = YOUNG * AREA * DIAMETER * DIAMETER / 16.0;

/// The lowest, with shear and rotary inertia.
fn lowest(checks: &mut Checks) -> Result<[f64; 4], Box<dyn Error>> {
    bending(checks, "slender", "cantilever", "any")
}

fn scene(force: f64, elements: usize) -> Scene {
    Scene {
        rod: vec![Rod::new("rod", line(LENGTH), circle(DIAMETER), Some(steel()), elements, 4)],
        joint: vec![clamp("rod@0")],
        load: vec![load(LoadKind::Force, "rod@1", [0.0, 0.0, force])],
        probe: vec![probe("tip", "rod@1")],
        ..Scene::default()
    }
}

/// βL of the k-th mode.
fn beta(k: usize) -> f64 {
    match k {
        0 => 1.875104068711961,
        1 => 4.694091132974175,
        2 => 7.854757438237613,
        _ => (k as f64 + 0.5) * std::f64::consts::PI,
    }
}

fn sudden_load(checks: &mut Checks) -> Outcome {
    let lowest = lowest(checks)?;
    let deflection = 1e-4;
    let force = 3.0 * BENDING * deflection;
    let (period, steps) = (std::f64::consts::TAU / lowest[0], 400);
    let step = 2.0 * period / steps as f64;
    for spectral_radius in [1.0, 0.8, 0.3] {
        let mut scene = scene(force, 4);
        let options = Dynamics { spectral_radius, ..Dynamics::new(2.0 * period, step) };
        scene.dynamics = Some(options);
        let solution = follow(&scene)?;
        let mut modes: Vec<(f64, Recursion)> = (0..6)
            .map(|k| {
                let slender = beta(k).powi(4) * BENDING / (DENSITY * AREA);
                let square = lowest.get(k).map_or(slender, |omega| omega * omega);
                (4.0 * force / (DENSITY * AREA), Recursion::new(spectral_radius, square, 1.0))
            })
            .collect();
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for row in 1..=steps {
            let expected: f64 = modes.iter_mut().map(|(size, mode)| *size * mode.step(step, 1.0)).sum();
            let found = place(&solution, row, 0).z;
            worst = worst.max((found - expected).abs() / deflection);
            largest = largest.max(found / deflection);
        }
        let higher: f64 = (4..20).map(|k| 12.0 * beta(k).powi(-4)).sum();
        checks.below(
            Kind::ClosedForm,
            format!("tip against six modes over the static deflection, ρ∞ = {spectral_radius}"),
            worst,
            2.0 * higher + 4.0 * (beta(0) * DIAMETER / 4.0).powi(2) * (1.0 + 2.0 * (1.0 + POISSON)),
            "twice the modes from the fifth on, Σ 12/β⁴, whose phases shear shifts by anything; shear and rotary \
             inertia in the shares of the others, (βr/L)² (1 + E/G)",
        );
        checks.absolute(
            Kind::ClosedForm,
            format!("largest deflection over the static one, ρ∞ = {spectral_radius}"),
            (largest, 2.0),
            2.0 * 12.0 / beta(1).powi(4) + 0.01,
            "1 − cos of the first mode reaches two; the others have Σ 12/β⁴ = 3 % of the deflection, twice",
        );
    }
    Ok(())
}

/// A load that grows slowly to where the deflection is large ends at the static equilibrium, but for a small oscillation.
fn slow_load(checks: &mut Checks) -> Outcome {
    let [first, ..] = lowest(checks)?;
    let force = 3.0 * BENDING;
    let mut still = scene(force, 4);
    still.statics = Some(Statics::default());
    let solution = solve(&still)?;
    let last = solution.rows.len() - 1;
    let end = place(&solution, last, 0);
    for periods in [10.0, 20.0] {
        let time = periods * std::f64::consts::TAU / first;
        let mut moving = scene(force, 4);
        moving.load[0].time = Some(LoadTime::Named(NamedTime::Ramp));
        moving.dynamics = Some(Dynamics::new(time, time / (40.0 * periods)));
        let solution = follow(&moving)?;
        let last = solution.rows.len() - 1;
        checks.below(
            Kind::ClosedForm,
            format!("distance from the equilibrium after {periods} periods of ramp"),
            (place(&solution, last, 0) - end).norm(),
            2.0 / (first * time),
            "a ramp leaves w_s/(ωT) of the linear deflection w_s = 1 oscillating, once from its start; the path bends \
             and the frequency changes by as much again",
        );
        checks.above(
            Kind::ClosedForm,
            format!("deflection after {periods} periods of ramp"),
            place(&solution, last, 0).z,
            0.5,
            "a large one: 0.6 of the length by the elastica at F L²/EI = 3",
        );
    }
    Ok(())
}

/// After a smooth pulse the energy stays, to the dissipation of the method; without dissipation better still.
fn energy(checks: &mut Checks) -> Outcome {
    let [first, ..] = lowest(checks)?;
    let period = std::f64::consts::TAU / first;
    let counts = [100, 200, 400];
    for spectral_radius in [0.5, 0.8, 1.0] {
        let mut losses = Vec::new();
        for count in counts {
            let mut scene = scene(0.3 * BENDING, 4);
            // Rises and falls over two periods.
            let table = LoadTime::Table(vec![[0.0, 0.0], [period, 1.0], [1.5 * period, 0.0]]);
            scene.load[0] = Load { time: Some(table), ..scene.load[0].clone() };
            scene.dynamics = Some(Dynamics {
                spectral_radius,
                ..Dynamics::new(6.0 * period, 2.0 * period / count as f64)
            });
            let solution = follow(&scene)?;
            let start = solution.energies[count].total();
            let changes =
                solution.energies[count..].iter().map(|energies| (energies.total() / start - 1.0).abs());
            losses.push(changes.fold(0.0, f64::max));
        }
        let name = format!("largest change of the energy, ρ∞ = {spectral_radius}");
        checks.above(
            Kind::Order,
            format!("{name}: order on {counts:?}, {losses:?}"),
            (losses[1] / losses[2]).log2(),
            1.5,
            "order 2, and 3 where dissipation is most of it; where the two cancel, half an order is lost on the way",
        );
        checks.below(
            Kind::Order,
            format!("{name}, finest"),
            losses[2],
            (first * 2.0 * period / 400.0_f64).powi(2),
            "(ωh)² of the first mode, which has nearly all of the energy",
        );
    }
    Ok(())
}
