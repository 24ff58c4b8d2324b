//! A soft cantilever that swings in space through most of its length, under its weight and a dead force at its tip.
//!
//! The reference is PyElastica's, an explicit scheme on a staggered grid, extrapolated to 5e-5 of the length. Beyond
//! it stands only what this solver is checked for here as well: that mesh and steps no longer matter.

use std::error::Error;

use cosserat::scene::{Dynamics, LoadKind, LoadTime, Rod, Scene, Section};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::{clamp, load, probe};
use crate::pieces::line;
use crate::placement::{Placement, placements};
use crate::references::Table;
use crate::steps::{halved_twice, position_at, quaternion_at, rotation, run};

const FILE: &str = "pyelastica/soft_cantilever.csv";

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "pyelastica_rods::soft_cantilever",
            "PyElastica 1.0.0, Gazzola, Dudte, McCormick & Mahadevan 2018",
            soft_cantilever,
        )
        .reads(&[FILE])
        .slow(),
    ]
}

/// Of the reference, relative to the length of 1 m, and in directions.
const PLACE: f64 = 5e-5;
const DIRECTION: f64 = 1e-3;
/// What mesh and steps may leave of ours.
const OURS: f64 = 5e-6;
const STEP: f64 = 5e-4;
const ELEMENTS: usize = 8;

fn scene(table: &Table, elements: usize) -> Result<Scene, Box<dyn Error>> {
    let number = |name: &str| -> Result<f64, Box<dyn Error>> {
        let value = table.resource.parameters.get(name).and_then(serde_json::Value::as_f64);
        Ok(value.ok_or_else(|| format!("the descriptor has no {name}"))?)
    };
    let (radius, density, young) = (number("radius")?, number("density")?, number("young_modulus")?);
    let shear = young / (2.0 * (1.0 + number("poisson_ratio")?));
    let area = std::f64::consts::PI * radius * radius;
    let second = area * radius * radius / 4.0;
    let section = Section::Custom {
        axial: number("axial_factor")? * young * area,
        shear_y: number("shear_factor")? * shear * area,
        shear_z: number("shear_factor")? * shear * area,
        torsion: shear * 2.0 * second,
        bending_y: young * second,
        bending_z: young * second,
        mass_per_length: Some(density * area),
        rotary_inertia: Some([2.0 * density * second, density * second, density * second]),
    };
    let mut push = load(LoadKind::Force, "rod@1", [0.0, number("force")?, 0.0]);
    push.time = Some(LoadTime::Table(vec![[0.0, 0.0], [number("ramp")?, 1.0]]));
    Ok(Scene {
        gravity: Some([0.0, 0.0, -number("gravity")?]),
        rod: vec![Rod::new("rod", line(number("length")?), section, None, elements, 4)],
        joint: vec![clamp("rod@0")],
        load: vec![push],
        probe: vec![probe("tip", "rod@1"), probe("middle", "rod@0.5")],
        dynamics: Some(Dynamics::new(1.0, STEP)),
        ..Scene::default()
    })
}

/// Tip, middle, e_x and e_z at the tip.
type Sight = [Vector3<f64>; 4];

fn sight(solution: &Solution, time: f64, placement: &Placement) -> Result<Sight, Box<dyn Error>> {
    let turn = rotation(quaternion_at(solution, time, 0, placement, [1.0, 0.0, 0.0, 0.0])?);
    Ok([
        position_at(solution, time, 0, placement)?,
        position_at(solution, time, 1, placement)?,
        turn * Vector3::x(),
        turn * Vector3::z(),
    ])
}

/// b + (b − a)/3: what is left of order 2 goes.
fn extrapolated(a: &Sight, b: &Sight) -> Sight {
    std::array::from_fn(|k| b[k] + (b[k] - a[k]) / 3.0)
}

const REFERENCE: &str =
    "what the reference is known to, and what this solver's mesh and steps may leave, checked below";
const STEPS: &str = "values extrapolated from h, h/2 and from h/2, h/4 differ by more than the second are wrong by, by a \
                     factor of 4 or more";
const MESH: &str = "places converge with order 5 or more at degree 4: the mesh that is used has less than a sixteenth of \
                    this left";

fn soft_cantilever(checks: &mut Checks) -> Outcome {
    let table = checks.reference(FILE)?;
    let names = ["tip", "middle", "e_x of the tip", "e_z of the tip"];
    let columns = ["x y z", "mid_x mid_y mid_z", "ex_x ex_y ex_z", "ez_x ez_y ez_z"];
    let scene = scene(&table, ELEMENTS)?;
    for placement in placements(1.0) {
        let runs = halved_twice(&placement.apply(&scene))?;
        let (mut off, mut changed) = ([0.0_f64; 4], [0.0_f64; 4]);
        let (mut way, mut dots) = (Vec::new(), Vec::new());
        for row in table.rows() {
            let time = row.number("time")?;
            let [a, b, c] = [0, 1, 2].map(|k| sight(&runs[k], time, &placement));
            let (a, b, c) = (a?, b?, c?);
            let (first, second) = (extrapolated(&a, &b), extrapolated(&b, &c));
            for k in 0..4 {
                let exact = Vector3::from(row.numbers::<3>(columns[k])?);
                off[k] = off[k].max((second[k] - exact).norm());
                changed[k] = changed[k].max((second[k] - first[k]).norm());
            }
            dots.push([row.number("y")?, row.number("z")?]);
        }
        for k in 0..4 {
            let label = |what: &str| format!("{}, {what}, {}", names[k], placement.name);
            let (reference, ours) = if k < 2 { (PLACE, OURS) } else { (DIRECTION, 20.0 * OURS) };
            checks.below(
                Kind::CrossCode,
                label("largest distance over 1 s"),
                off[k],
                reference + ours,
                REFERENCE,
            );
            checks.below(Kind::Order, label("change by the steps"), changed[k], 4.0 * ours, STEPS);
        }
        if placement.name == "as is" {
            for row in runs[2].rows.iter().step_by(40) {
                let [_, y, z] = row.probes[0].position;
                way.push([y, z]);
            }
            checks.trajectory(Trajectory {
                title: "Tip of a soft cantilever, seen along it".to_string(),
                axes: ["y [m]", "z [m]"],
                measured: way,
                source: "PyElastica",
                reference: dots,
            });
            mesh(checks, &table, &runs[0])?;
        }
    }
    Ok(())
}

/// Half of the elements find the same, with the same steps.
fn mesh(checks: &mut Checks, table: &Table, full: &Solution) -> Outcome {
    let half = run(&scene(table, ELEMENTS / 2)?)?;
    let place = &placements(1.0)[0];
    let mut worst = 0.0_f64;
    for row in table.rows() {
        let time = row.number("time")?;
        let (a, b) = (sight(&half, time, place)?, sight(full, time, place)?);
        worst = worst.max((a[0] - b[0]).norm()).max((a[1] - b[1]).norm());
    }
    checks.below(Kind::Invariant, "places with half of the elements", worst, 16.0 * OURS, MESH);
    Ok(())
}
