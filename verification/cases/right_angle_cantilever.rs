//! The right-angle cantilever of Simo & Vu-Quoc (1988): large motion of two legs after a kick across their plane.

use std::error::Error;
use std::path::Path;

use cosserat::scene::{Dynamics, LoadKind, LoadTime, Scene};
use cosserat::solution::Solution;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies_joined::frame_scene;
use crate::measure::{load, probe};
use crate::motion::{follow, place};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "right_angle_cantilever::published",
            "Simo & Vu-Quoc 1988: 40 linear elements a leg, time step 0.005",
            published,
        )
        .reads(&[PEAKS]),
        Case::new("right_angle_cantilever::work", "work of the load; order 2 in time, 2p in space", work),
        Case::new("right_angle_cantilever::energy", "no load after t = 2: the energy stays", energy),
    ]
}

fn scene(elements: usize, degree: usize, end: f64, step: f64) -> Scene {
    let kick = load(LoadKind::Force, "leg@1", [0.0, 0.0, 50.0]);
    let time = LoadTime::Table(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]);
    let mut scene = frame_scene(elements, degree);
    scene.load.push(cosserat::scene::Load { time: Some(time), ..kick });
    scene.probe = vec![probe("elbow", "leg@1"), probe("tip", "arm@1")];
    scene.dynamics = Some(Dynamics::new(end, step));
    scene
}

/// Time and value of the extremum of z of a probe that is nearest to a time, by a parabola through three rows.
fn extremum(solution: &Solution, index: usize, near: f64) -> [f64; 2] {
    let z = |row: usize| place(solution, row, index).z;
    let time = |row: usize| solution.rows[row].parameter;
    let turns = (1..solution.rows.len() - 1).filter(|&k| (z(k) - z(k - 1)) * (z(k + 1) - z(k)) <= 0.0);
    let nearest = turns.min_by(|&a, &b| (time(a) - near).abs().total_cmp(&(time(b) - near).abs()));
    let Some(row) = nearest else { return [f64::NAN; 2] };
    let (half, curve) = (0.5 * (z(row + 1) - z(row - 1)), z(row + 1) - 2.0 * z(row) + z(row - 1));
    [time(row) - half / curve * (time(row + 1) - time(row)), z(row) - 0.5 * half * half / curve]
}

/// Point, time and value of extrema.
const PEAKS: &str = "published/simo_vu_quoc_1988.csv";

fn published(checks: &mut Checks) -> Outcome {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/right_angle_cantilever.toml");
    let mut shipped = Scene::from_file(path)?;
    if let Some(options) = &mut shipped.dynamics {
        options.end_time = 16.2;
    }
    let shipped = follow(&shipped)?;
    let converged = follow(&scene(6, 5, 16.2, 0.01))?;
    let theirs = follow(&scene(40, 1, 16.2, 0.01))?;
    let table = checks.reference(PEAKS)?;
    for row in table.rows() {
        let what = row.word("point")?;
        let [time, time_digit, value, digit] = row.numbers("time time_half_digit z z_half_digit")?;
        let index = usize::from(what == "tip");
        let ours = extremum(&converged, index, time);
        let linear = extremum(&theirs, index, time);
        for (who, found) in [("shipped scene", extremum(&shipped, index, time)), ("converged", ours)] {
            checks.absolute(
                Kind::Published,
                format!("{what} at {time}, z, {who}"),
                (found[1], value),
                digit + (linear[1] - ours[1]).abs(),
                "half a unit of the last printed digit, and what 40 linear elements a leg make of it",
            );
            checks.absolute(
                Kind::Published,
                format!("{what} at {time}, t, {who}"),
                (found[0], time),
                time_digit + 0.0025 + (linear[0] - ours[0]).abs(),
                "half a unit of the last printed digit, half of the published time step, and what 40 linear elements a \
                 leg make of it",
            );
        }
    }
    Ok(())
}

/// Energy at the end of the load, and the load's work by the trapezoidal rule.
fn balance(scene: &Scene) -> Result<[f64; 2], Box<dyn Error>> {
    let solution = follow(scene)?;
    let factor = |t: f64| (1.0 - (t - 1.0).abs()).max(0.0);
    let work = (1..solution.rows.len()).map(|row| {
        let [before, after] = [row - 1, row].map(|row| 50.0 * factor(solution.rows[row].parameter));
        0.5 * (before + after) * (place(&solution, row, 0) - place(&solution, row - 1, 0)).z
    });
    let energy = solution.energies.last().ok_or("no energies")?.total();
    Ok([energy - solution.energies[0].total(), work.sum()])
}

fn work(checks: &mut Checks) -> Outcome {
    let counts = [50, 100, 200];
    let mut errors = Vec::new();
    for count in counts {
        let [energy, work] = balance(&scene(4, 6, 2.0, 2.0 / count as f64))?;
        errors.push((energy / work - 1.0).abs());
    }
    checks.order(
        "energy over work of the load, over time steps",
        &counts,
        &errors,
        (2.0, 0.2),
        "generalized-α and the trapezoidal rule are of order 2; the next term is smaller by ωh = 0.1, ω = 10",
    );
    checks.below(
        Kind::Order,
        "energy over work of the load, 200 steps",
        errors[2],
        (1.1 * 0.01_f64).powi(2),
        "(ωh)², ω = 1.1 of the fifth vibration: what lies above it has no share",
    );
    let [energy, work] = balance(&scene(4, 6, 2.0, 0.02))?;
    for (degree, meshes) in [(1, [10, 20, 40]), (2, [5, 10, 20])] {
        let mut errors = Vec::new();
        for elements in meshes {
            let [of_mesh, by_load] = balance(&scene(elements, degree, 2.0, 0.02))?;
            errors.push(((of_mesh - by_load) - (energy - work)).abs() / work);
        }
        checks.order(
            format!("energy less work, p = {degree}, over elements"),
            &meshes,
            &errors,
            (2.0 * degree as f64, 0.4),
            "2p on smooth fields (petrov_galerkin); the kick sends waves as short as 2 elements of the coarse meshes",
        );
        checks.below(
            Kind::Order,
            format!("energy less work, p = {degree}, {} elements", meshes[2]),
            errors[2],
            (10.0 / meshes[2] as f64).powi(2 * degree as i32),
            "(kh)^{2p} of the work, with bending waves of kL = 10 at most of any weight",
        );
    }
    Ok(())
}

fn energy(checks: &mut Checks) -> Outcome {
    let counts = [500, 1000, 2000];
    let mut drifts = Vec::new();
    for count in counts {
        let step = 10.0 / count as f64;
        let solution = follow(&scene(5, 5, 10.0, step))?;
        let start = (2.0 / step).round() as usize;
        let first = solution.energies[start].total();
        let worst = solution.energies[start..].iter().map(|e| (e.total() / first - 1.0).abs());
        drifts.push(worst.fold(0.0, f64::max));
        let gap = solution.energies.iter().map(|energies| energies.constraint).fold(0.0, f64::max);
        checks.below(
            Kind::Invariant,
            format!("gap of the elbow, step {step}"),
            gap,
            1e-9 * 20.0,
            "Newton's test of joints: 1e-9 of how far nodes travel in a step, at most 10 · h, and of their rounding",
        );
    }
    checks.order(
        "largest change of the energy from t = 2 to 10",
        &counts,
        &drifts,
        (2.0, 0.5),
        "order 2, and higher where only damping is left",
    );
    checks.below(
        Kind::Order,
        "largest change of the energy from t = 2 to 10, finest",
        drifts[2],
        (1.1 * 0.005_f64).powi(2),
        "(ωh)², ω = 1.1 of the fifth vibration: what lies above it has no share",
    );
    Ok(())
}
