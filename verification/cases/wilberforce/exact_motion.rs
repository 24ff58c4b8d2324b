//! The large motion with a massless wire: the strongest test of the whole program.
//!
//! The reference has the bob's six freedoms, and the wire's force and moment from a boundary-value problem at every
//! instant: no finite elements, no multipliers, no generalized-α. What the solver adds is the mesh, here below 1e-9 m,
//! and the time step.

use std::error::Error;

use cosserat::rotation::rotation_matrix;
use nalgebra::{Vector3, Vector4};

use super::swing::Swing;
use super::{Pendulum, places, steps};
use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::references::Table;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "wilberforce::exact_motion",
            "boundary-value problem of the wire at every instant: 1e-9 m, quaternion 2e-8, α 5e-8 rad",
            exact_motion,
        )
        .reads(&[FILE])
        .slow(),
    ]
}

const FILE: &str = "continuous/wilberforce_motion.csv";
/// Where the motion is compared [s]: first as orders as well.
const TIMES: [f64; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 4.0];

const STEPS: [f64; 3] = [4e-3, 2e-3, 1e-3];
/// Of the reference, and as much again for the mesh.
const DIGITS: [f64; 3] = [2e-9, 4e-8, 1e-7];
const END: f64 = 4.0;

/// Position, the nine entries of the rotation, α, and both joints' reactions.
fn at(swing: &Swing, time: f64) -> [Vec<f64>; 4] {
    let row = swing.at(time);
    [
        swing.positions[row].iter().copied().collect(),
        swing.rotations[row].iter().copied().collect(),
        vec![swing.alpha()[row]],
        swing.solution.rows[row].reactions.iter().flatten().copied().collect(),
    ]
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// (4 fine − coarse)/3.
fn extrapolated(coarse: &[f64], fine: &[f64]) -> Vec<f64> {
    coarse.iter().zip(fine).map(|(coarse, fine)| (4.0 * fine - coarse) / 3.0).collect()
}

fn swings() -> Result<Vec<Swing>, Box<dyn Error>> {
    let pendulum = Pendulum { inertia: false, ..Pendulum::new(9, 6) };
    STEPS.iter().map(|step| pendulum.swing_as_is(&steps(END, *step))).collect()
}

const NAMES: [&str; 4] = ["position [m]", "rotation", "α [rad]", "joint forces [N, N m]"];

fn exact_motion(checks: &mut Checks) -> Outcome {
    let swings = swings()?;
    let table = checks.reference(FILE)?;
    for (index, time) in TIMES.into_iter().enumerate() {
        let row = table.row(&[("t", &format!("{time:?}"))])?;
        let found: Vec<[Vec<f64>; 4]> = swings.iter().map(|swing| at(swing, time)).collect();
        let exact = [
            row.numbers::<3>("x y z")?.to_vec(),
            rotation_matrix(&Vector4::from(row.numbers("qw qx qy qz")?)).iter().copied().collect(),
            vec![row.number("alpha")?],
        ];
        for what in 0..3 {
            // A rotation matrix changes by √2 per radian, a quaternion by half: 2√2 times the quaternion's error.
            let digits = DIGITS[what] * if what == 1 { 8.0_f64.sqrt() } else { 1.0 };
            let name = format!("{} at {time} s", NAMES[what]);
            let first = extrapolated(&found[0][what], &found[1][what]);
            let second = extrapolated(&found[1][what], &found[2][what]);
            checks.below(
                Kind::ClosedForm,
                format!("{name}, extrapolated, from the exact one"),
                distance(&second, &exact[what]),
                distance(&first, &second) / 7.0 + digits,
                "after the second order comes the third at the earliest: the first extrapolation has 8 times the error \
                 of the second and differs from it by 7 times; the digits of the reference and of the mesh",
            );
            if index < 2 {
                let errors: Vec<f64> =
                    found.iter().map(|found| distance(&found[what], &exact[what])).collect();
                order(checks, &name, &errors);
                checks.below(
                    Kind::ClosedForm,
                    format!("{name}, Δt = 1 ms, from the exact one"),
                    errors[2],
                    0.4 * distance(&found[1][what], &found[2][what]) + digits,
                    "order 2: a third of the last difference, and a fifth of that for the orders beyond",
                );
            }
        }
        if index < 2 {
            // Here the finest extrapolation stands for the exact forces.
            let best = extrapolated(&found[1][3], &found[2][3]);
            let errors: Vec<f64> = found[..2].iter().map(|found| distance(&found[3], &best)).collect();
            let errors = [errors[0], errors[1], distance(&found[2][3], &best)];
            order(checks, &format!("{} at {time} s", NAMES[3]), &errors);
        }
    }
    paths(checks, &swings[2], &table)?;
    weight_and_inertia(checks, &swings[2])?;
    energy(checks, &swings);
    placed(checks, &swings[0])
}

/// z and α over time.
fn paths(checks: &mut Checks, swing: &Swing, table: &Table) -> Outcome {
    let numbers = [("z", "z [m]", swing.z()), ("alpha", "α [rad]", swing.alpha())];
    for (column, axis, values) in numbers {
        let points = swing.times.iter().zip(values).map(|(&t, value)| [t, value]);
        checks.trajectory(Trajectory {
            title: format!("Wilberforce pendulum with a massless wire: {axis}"),
            axes: ["t [s]", axis],
            measured: points.step_by(10).collect(),
            source: "boundary-value problem",
            reference: table
                .rows()
                .map(|row| row.numbers(&format!("t {column}")))
                .collect::<Result<_, _>>()?,
        });
    }
    Ok(())
}

fn order(checks: &mut Checks, name: &str, errors: &[f64]) {
    let inverse = STEPS.map(|step| (1.0 / step).round() as usize);
    let reason = "order 2; a term of third order as large as the second at ω h = 1, for the fastest motion that is \
                  excited, 54 rad/s, changes the order by log₂[(1 + 0.108)/(1 + 0.054)] = 0.07; twice that";
    checks.order(name, &inverse, errors, (2.0, 0.15), reason);
}

/// The grip carries what moves the bob: m (a − g), the acceleration from positions a step apart.
fn weight_and_inertia(checks: &mut Checks, swing: &Swing) -> Outcome {
    let h = STEPS[2];
    for time in [0.5, 1.0, 3.0] {
        let row = swing.at(time);
        let r = |k: usize| swing.positions[k];
        let acceleration = (r(row + 1) - 2.0 * r(row) + r(row - 1)) / (h * h);
        let force = super::bob_mass() * (acceleration + Vector3::new(0.0, 0.0, super::GRAVITY));
        let [x, y, z, ..] = swing.solution.rows[row].reactions[1];
        checks.vector(
            Kind::Invariant,
            format!("force of the grip at {time} s [N]"),
            ([x, y, z], force.into()),
            2.0 * (54.0 * h).powi(2) * 0.5,
            "m (a − g); differences and the method are both of second order, (ωh)²/12 and (ωh)²/6 or so, for ω ≤ 54 \
             rad/s: (ωh)² of 0.5 N, the largest sideways force, twice, for z with 5 N and 16 rad/s as well",
        );
    }
    Ok(())
}

/// The energy is conserved up to the time error.
fn energy(checks: &mut Checks, swings: &[Swing]) {
    let errors: Vec<f64> = swings
        .iter()
        .map(|swing| {
            let energies = &swing.solution.energies;
            let start = energies[0].total();
            energies.iter().map(|e| (e.total() - start).abs()).fold(0.0, f64::max)
        })
        .collect();
    order(checks, "largest error of the energy", &errors);
    checks.below(
        Kind::Invariant,
        "largest error of the energy, Δt = 1 ms [J]",
        errors[2],
        0.39 * (16.6e-3_f64).powi(2) / 4.0,
        "0.39 J go to and fro with at most 16.6 rad/s: a step of order 2 is wrong by (ωh)²/12 of them, three times",
    );
}

/// The same motion elsewhere, for a shorter time.
fn placed(checks: &mut Checks, as_is: &Swing) -> Outcome {
    let pendulum = Pendulum { inertia: false, ..Pendulum::new(9, 6) };
    for placement in &places()[1..] {
        let swing = pendulum.swing(placement, &steps(0.5, STEPS[0]))?;
        let row = swing.at(0.5);
        checks.vector(
            Kind::Invariant,
            format!("position at 0.5 s, {} [m]", placement.name),
            (swing.positions[row].into(), as_is.positions[row].into()),
            1e-9,
            "125 steps, each solved to 1e-9 of what it travels, 4e-3 m at most",
        );
        let (rotation, expected) = (swing.rotations[row], as_is.rotations[row]);
        let reason = "125 steps, each solved to 1e-9 of 0.1 rad";
        let name = format!("rotation at 0.5 s, {}", placement.name);
        checks.below(Kind::Invariant, name, (rotation - expected).norm(), 2e-8, reason);
    }
    Ok(())
}
