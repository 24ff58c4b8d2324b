//! The scene files that come with the program: the pendulum is the paper's, and the spring with the bob hangs where the
//! continuous equations put it.

use std::error::Error;
use std::path::Path;

use cosserat::rotation::rotation_vector;
use cosserat::scene::Scene;
use cosserat::solution::Solution;
use cosserat::{Model, dynamics};
use nalgebra::Vector3;

use super::{Pendulum, paper_steps, places};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{probe, solve};
use crate::placement::Placement;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("wilberforce::shipped", "authors_table, the same scene as a file", pendulum),
        Case::new(
            "wilberforce::spring_with_bob",
            "shooting on the continuous equations, 1e-12 m",
            equilibrium,
        )
        .reads(&[HANGING]),
    ]
}

fn file(name: &str) -> Result<Scene, Box<dyn Error>> {
    Ok(Scene::from_file(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name))?)
}

fn pendulum(checks: &mut Checks) -> Outcome {
    let shipped = file("wilberforce.toml")?;
    let mut options = shipped.dynamics.clone().ok_or("no dynamics")?;
    let same = options == paper_steps(8.0);
    let reason = "Δt, ρ∞, tolerance and end time of the paper";
    checks.below(Kind::Published, "settings that differ", f64::from(u8::from(!same)), 0.0, reason);
    // A second is enough to see that both are the same scene.
    options.end_time = 1.0;
    let solution = dynamics::solve(&Model::new(&shipped)?, &options, &mut |_, _| ())?;
    let swing = Pendulum::paper().swing_as_is(&paper_steps(1.0))?;
    let numbers = |solution: &Solution| -> Vec<f64> {
        solution
            .rows
            .iter()
            .flat_map(|row| row.probes[0].position.into_iter().chain(row.probes[0].quaternion))
            .collect()
    };
    let (a, b) = (numbers(&solution), numbers(&swing.solution));
    let different = a.iter().zip(&b).filter(|(a, b)| a != b).count() + a.len().abs_diff(b.len());
    checks.below(
        Kind::Invariant,
        "numbers that differ in 1 s",
        different as f64,
        0.0,
        "the same scene, bit for bit",
    );
    let rows = solution.rows.iter().zip(swing.alpha());
    let apart =
        rows.map(|(row, alpha)| row.probes[0].angles.map_or(f64::NAN, |angles| (angles[0] - alpha).abs()));
    let worst = apart.fold(0.0, |worst: f64, x| if x <= worst { worst } else { x });
    let reason = "two ways to one angle, rounded a dozen times";
    checks.below(Kind::Invariant, "α of the file's probe [rad]", worst, 1e-14, reason);
    Ok(())
}

/// The bob at rest under its weight.
const HANGING: &str = "continuous/wilberforce_hanging.csv";

/// Where the bob hangs and how it is turned, where the wire ends; and α.
type Hanging = ([Vector3<f64>; 3], f64);

fn hanging(elements: usize, degree: usize, placement: &Placement) -> Result<Hanging, Box<dyn Error>> {
    let mut scene = file("spring_with_bob.toml")?;
    (scene.rod[0].elements, scene.rod[0].degree) = (elements, degree);
    scene.probe.push(probe("end", "spring@0"));
    let solution = solve(&placement.apply(&scene))?;
    let (first, last) = (solution.rows.first().ok_or("no rows")?, solution.rows.last().ok_or("no rows")?);
    let [before, after] = [first, last].map(|row| nalgebra::Vector4::from(row.probes[0].quaternion));
    let back = nalgebra::Vector4::new(before[0], -before[1], -before[2], -before[3]);
    let turn = rotation_vector(&cosserat::rotation::quaternion_product(&after, &back));
    let place = |index: usize| placement.undo_position(last.probes[index].position.into());
    let alpha = last.probes[0].angles.map_or(f64::NAN, |angles| angles[0]);
    Ok(([place(0), placement.undo_direction(turn), place(1)], alpha))
}

fn equilibrium(checks: &mut Checks) -> Outcome {
    let shipped = file("spring_with_bob.toml")?;
    let (elements, degree) = (shipped.rod[0].elements, shipped.rod[0].degree);
    let names = ["centre of mass [m]", "rotation vector", "end of the wire [m]"];
    let table = checks.reference(HANGING)?;
    let row = table.rows().next().ok_or("no rows")?;
    let exact: [[f64; 3]; 3] = [row.numbers("x y z")?, row.numbers("rx ry rz")?, row.numbers("ex ey ez")?];
    for placement in places() {
        let (fine, alpha) = hanging(12, 8, &placement)?;
        let scale = [1.0, 20.0, 1.0];
        for k in 0..3 {
            checks.vector(
                Kind::ClosedForm,
                format!("{}, 12 elements of degree 8, {}", names[k], placement.name),
                (fine[k].into(), exact[k]),
                1e-9 * scale[k],
                "1e-9 of 4.6 N on a spring of 112 N/m is 4e-11 m, at each of 97 nodes, half of it by chance; for the \
                 rotation divided by a lever of 50 mm or less",
            );
        }
        if placement.name == "as is" {
            let reason = "as the rotation vector";
            checks.absolute(Kind::ClosedForm, "α [rad]", (alpha, row.number("alpha")?), 2e-8, reason);
        }
        // As shipped: p = 4 on 20° of a coil.
        let (found, _) = hanging(elements, degree, &placement)?;
        for k in 0..3 {
            checks.vector(
                Kind::ClosedForm,
                format!("{}, as shipped, {}", names[k], placement.name),
                (found[k].into(), exact[k]),
                0.06 * (std::f64::consts::TAU / 6.0).powi(8) / 40_320.0 * scale[k],
                "order 2p = 8: (κh)⁸/8! for an element of 60° of a coil, of a path of 6 cm",
            );
        }
    }
    let meshes = [12, 18, 27];
    let mut errors = [Vec::new(), Vec::new(), Vec::new()];
    for mesh in meshes {
        let (found, _) = hanging(mesh, degree, &places()[0])?;
        for k in 0..3 {
            errors[k].push((found[k] - Vector3::from(exact[k])).norm());
        }
    }
    for k in 0..3 {
        let reason = "2p; from 60° to 40° the next term, two orders higher with a constant of one, changes the order by \
                      ln[(1 + (π/3)²)/(1 + (2π/9)²)]/ln 1.5 = 0.85";
        checks.order(format!("{}, p = 4", names[k]), &meshes, &errors[k], (8.0, 0.85), reason);
    }
    Ok(())
}
