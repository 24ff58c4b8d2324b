//! Steps of different length: the order they keep, times they have to meet, and steps that are done again.

use std::error::Error;
use std::path::Path;

use cosserat::scene::{Dynamics, Scene};
use cosserat::solution::{Obstacle, Solution, SolveError};
use cosserat::{Model, dynamics};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::{body_chain, heavy_top};
use crate::placement::placements;
use crate::steps::{check_second_order, force_at, position_at, quaternion_at, run};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("variable_steps::order", "Kane's equations in seven coordinates", order)
            .reads(body_chain::FILES),
        Case::new("variable_steps::milestones", "the times that were asked for", milestones),
        Case::new("variable_steps::done_again", "the same steps without a retry, bit for bit", done_again),
        Case::new("variable_steps::unsolved", "Euler's equations by Taylor series", unsolved)
            .reads(&[heavy_top::FILE]),
        Case::new("variable_steps::too_much_asked", "what converged before is kept", too_much_asked),
    ]
}

/// With `[dynamics]` and times to be met.
fn through(scene: &Scene, milestones: &[f64]) -> Result<Solution, Box<dyn Error>> {
    let options = scene.dynamics.as_ref().ok_or("the scene asks for no motion")?;
    Ok(dynamics::solve_through(&Model::new(scene)?, options, milestones, &mut |_, _| ())?)
}

/// Lengths as from a die, each up to 16 times its neighbour; their sum is 1.
fn lengths() -> Vec<f64> {
    let mut seed = 12345_u64;
    let mut lengths: Vec<f64> = (0..20)
        .map(|_| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            0.25 * 16_f64.powf((seed >> 11) as f64 / (1_u64 << 53) as f64)
        })
        .collect();
    let sum: f64 = lengths.iter().sum();
    lengths.iter_mut().for_each(|length| *length /= sum);
    lengths
}

/// The same lengths over and over, so that an error of order k has a constant and halves k times.
fn order(checks: &mut Checks) -> Outcome {
    let as_is = &placements(1.0)[0];
    let lengths = lengths();
    let mut runs = Vec::new();
    for repeated in [40_u32, 80, 160] {
        let mut times = Vec::new();
        for k in 0..repeated {
            let mut time = 0.0;
            for length in &lengths {
                time += length;
                times.push((f64::from(k) + time) / f64::from(repeated));
            }
        }
        let mut scene = body_chain::scene(true, 1.0);
        scene.dynamics = Some(Dynamics::new(1.0, 1.0));
        // The sum of the last lengths may be the end but for rounding.
        let inner = times.iter().copied().filter(|time| *time < 1.0 - 1e-9);
        runs.push(through(&scene, &inner.collect::<Vec<_>>())?);
    }
    let (_, bodies, force) = body_chain::exact(checks, true, 1.0)?;
    for (index, (position, quaternion)) in bodies.into_iter().enumerate() {
        let (mut x, mut q) = (Vec::new(), Vec::new());
        for run in &runs {
            x.push(position_at(run, 1.0, index, as_is)?);
            q.push(quaternion_at(run, 1.0, index, as_is, quaternion)?);
        }
        let slices = [x[0].as_slice(), x[1].as_slice(), x[2].as_slice()];
        let label = |what: &str| format!("{what} of body {}", index + 1);
        check_second_order(checks, &label("position"), slices, &position);
        check_second_order(checks, &label("rotation"), [&q[0], &q[1], &q[2]], &quaternion);
    }
    let mut errors = Vec::new();
    for run in &runs {
        errors.push((force_at(run, 1.0, 0, as_is)? - nalgebra::Vector3::from(force)).norm());
    }
    let order = 0.5 * (errors[0] / errors[2]).log2();
    let shown: Vec<String> = errors.iter().map(|error| format!("{error:.2e}")).collect();
    checks.above(
        Kind::Order,
        format!("force of the ground: order, errors [{}]", shown.join(", ")),
        order,
        0.85,
        "a change of the step by its own length moves the multipliers by O(h): order 1; 0.15 for the next term",
    );
    Ok(())
}

fn milestones(checks: &mut Checks) -> Outcome {
    const TIMES: [f64; 4] = [1.0 / 3.0, 0.25, 0.6180339887498949, 0.618034];
    let mut scene = body_chain::scene(true, 0.013);
    let meets = |checks: &mut Checks, what: &str, solution: &Solution| {
        let met = |time: &&f64| solution.rows.iter().any(|row| row.parameter == **time);
        let reason = "to the last digit";
        let found = TIMES.iter().filter(met).count() as f64;
        checks.absolute(Kind::Invariant, format!("times met, {what}"), (found, 4.0), 0.0, reason);
        let last = solution.rows.last().map_or(f64::NAN, |row| row.parameter);
        checks.absolute(Kind::Invariant, format!("the end, {what}"), (last, 1.0), 0.0, reason);
    };
    let constant = through(&scene, &TIMES)?;
    meets(checks, "constant step", &constant);
    let longest = constant.rows.windows(2).map(|rows| rows[1].parameter - rows[0].parameter);
    let longest = longest.fold(0.0, f64::max);
    let reason = "equal steps between milestones are no longer than the time step, but for a merged last one";
    checks.below(Kind::Invariant, "longest step", longest, 0.013 * (1.0 + 2e-6), reason);
    // ⌈0.25/0.013⌉ + ⌈(1/12)/0.013⌉ + ⌈0.2847/0.013⌉ + 1 + ⌈0.381966/0.013⌉.
    let rows = constant.rows.len() as f64 - 1.0;
    let reason = "20 + 7 + 22 + 1 + 30, the fewest steps that are short enough";
    checks.absolute(Kind::ClosedForm, "steps", (rows, 80.0), 0.0, reason);
    scene.dynamics = Some(Dynamics::accurate(1.0, 1e-2));
    meets(checks, "accuracy", &through(&scene, &TIMES)?);
    Ok(())
}

/// A rod, for its stresses, and joints: where the steps of a run with rejections are given, none is done again, and all
/// numbers are the same.
fn done_again(checks: &mut Checks) -> Outcome {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut pendulum = Scene::from_file(root.join("scenes/flexible_pendulum.toml"))?;
    pendulum.dynamics = Some(Dynamics::accurate(3.0, 1e-2));
    let mut top = heavy_top::scene(["ground", "top"]);
    top.dynamics = Some(Dynamics::accurate(1.0, 1e-2));
    for (what, mut scene) in [("flexible pendulum", pendulum), ("heavy top", top)] {
        let [first, second] = [run(&scene)?, run(&scene)?];
        let reason = "no clock is in the way: bit for bit";
        let same = f64::from(u8::from(first == second));
        checks.absolute(Kind::Invariant, format!("{what}: two runs are equal"), (same, 1.0), 0.0, reason);
        let rejected = first.statistics.rejected as f64;
        let reason = "before a fast motion is noticed, steps are too long for it";
        checks.above(Kind::Invariant, format!("{what}: steps done again"), rejected, 1.0, reason);
        let end = scene.dynamics.as_ref().ok_or("no motion")?.end_time;
        scene.dynamics = Some(Dynamics::new(end, end));
        let times: Vec<f64> = first.rows.iter().map(|row| row.parameter).collect();
        let straight = through(&scene, &times)?;
        let same = straight.rows == first.rows && straight.energies == first.energies;
        let reason = "a retry begins with what the step before has left, bit for bit";
        let same = f64::from(u8::from(same));
        checks.absolute(Kind::Invariant, format!("{what}: without a retry"), (same, 1.0), 0.0, reason);
        checks.absolute(
            Kind::Invariant,
            format!("{what}: rejected then"),
            (straight.statistics.rejected as f64, 0.0),
            0.0,
            "constant steps are not",
        );
    }
    Ok(())
}

/// One iteration a step is not enough for long ones, which are halved until it is.
fn unsolved(checks: &mut Checks) -> Outcome {
    const END: f64 = 0.2;
    const ACCURACY: f64 = 1e-1;
    let mut scene = heavy_top::scene(["ground", "top"]);
    scene.dynamics = Some(Dynamics { max_iterations: 1, ..Dynamics::accurate(END, ACCURACY) });
    let solution = run(&scene)?;
    let rejected = solution.statistics.rejected as f64;
    checks.above(Kind::Invariant, "steps done again", rejected, 1.0, "two iterations are needed at first");
    let reason = "never more than one";
    let most = solution.statistics.most_iterations as f64;
    checks.below(Kind::Invariant, "iterations in a step", most, 1.0, reason);
    let spent = solution.statistics.newton_iterations as f64;
    let steps = solution.statistics.increments as f64;
    let reason = "those of rejected steps are counted";
    checks.above(Kind::Invariant, "iterations", spent, steps + rejected, reason);
    let (_, position, ..) = heavy_top::exact(checks, END)?;
    let found = position_at(&solution, END, 0, &placements(1.0)[0])?;
    let reason = "the accuracy, and steps are shorter than it asks for";
    checks.vector(Kind::ClosedForm, "centre", (found.into(), position), ACCURACY, reason);
    Ok(())
}

fn too_much_asked(checks: &mut Checks) -> Outcome {
    let mut scene = body_chain::scene(true, 1.0);
    let precise = Dynamics::accurate(1.0, 1e-30);
    let unsolvable = Dynamics { tolerance: Some(1e-300), ..Dynamics::accurate(1.0, 1e-2) };
    for (what, options) in [("accuracy 1e-30", precise), ("tolerance 1e-300", unsolvable)] {
        scene.dynamics = Some(options.clone());
        let Err(failure) = dynamics::solve(&Model::new(&scene)?, &options, &mut |_, _| ()) else {
            return Err(format!("{what} did not fail").into());
        };
        let SolveError::Accuracy { reached, steps, obstacle } = &failure.error else {
            return Err(format!("{what} failed otherwise: {}", failure.error).into());
        };
        let right = match obstacle {
            Obstacle::Error { excess, length, shortest } => {
                what.starts_with("accuracy") && *excess > 1.0 && length <= shortest
            }
            Obstacle::Newton { residual, tolerance, length, shortest, .. } => {
                what.starts_with("tolerance") && residual > tolerance && length <= shortest
            }
            Obstacle::Steps { .. } => false,
        };
        let reason = "the step that was tried is the shortest, and is too bad by the numbers that are told";
        let right = f64::from(u8::from(right));
        checks.absolute(Kind::Invariant, format!("{what}: obstacle"), (right, 1.0), 0.0, reason);
        let partial = &failure.partial;
        let rows = (partial.rows.len() as f64, *steps as f64 + 1.0);
        let reason = "the start and every step that was accepted";
        checks.absolute(Kind::Invariant, format!("{what}: rows"), rows, 0.0, reason);
        let last = partial.rows.last().map_or(f64::NAN, |row| row.parameter);
        checks.absolute(Kind::Invariant, format!("{what}: last time"), (last, *reached), 0.0, reason);
        let numbers = partial.energies.iter().all(|energies| energies.total().is_finite());
        let finite = f64::from(u8::from(numbers && failure.error.to_string().contains("shortest")));
        checks.absolute(Kind::Invariant, format!("{what}: numbers"), (finite, 1.0), 0.0, "none is NaN");
    }
    Ok(())
}
