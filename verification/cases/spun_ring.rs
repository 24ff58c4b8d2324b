//! A closed ring spun up and blown up by a load that turns with it: large motion of a flexible rod in free flight,
//! by symmetry three ordinary equations (radius, turn of the centreline, turn of the section).

use std::error::Error;

use cosserat::scene::{Basis, Dynamics, LoadKind, Scene, Section};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::cases::frequencies_joined::closed_ring;
use crate::measure::{load, probe};
use crate::motion::{Recursion, follow, place};
use crate::placement::{Placement, placements};
use crate::references::Table;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "three ordinary equations by symmetry, two formulations and two integrators";
    vec![
        Case::new("spun_ring::order_in_time", SOURCE, order_in_time).reads(&[FILE]),
        Case::new("spun_ring::symmetry", "rotation of the ring onto itself", symmetry),
        Case::new("spun_ring::gravity", "a constant acceleration adds the motion of a point mass", gravity),
    ]
}

/// What is known at one time.
struct Instant {
    time: f64,
    radius: f64,
    /// Turn of the section.
    turn: f64,
    kinetic: f64,
    strain: f64,
    /// ξ = 0.
    place: [f64; 2],
}

const FILE: &str = "continuous/spun_ring.csv";

impl Instant {
    fn new(table: &Table, time: f64) -> Result<Self, Box<dyn Error>> {
        let row = table.row(&[("t", &format!("{time:?}"))])?;
        let [radius, turn, kinetic, strain] = row.numbers("radius section kinetic strain")?;
        Ok(Self { time, radius, turn, kinetic, strain, place: row.numbers("x y")? })
    }
}

const ELEMENTS: usize = 4;
const DEGREE: usize = 5;

/// The ring with its load and twelve probes.
pub fn scene(step: f64, elements: usize, degree: usize) -> Scene {
    let section = Section::Custom {
        axial: 100.0,
        shear_y: 60.0,
        shear_z: 60.0,
        torsion: 1.0,
        bending_y: 1.0,
        bending_z: 1.0,
        mass_per_length: Some(1.0),
        rotary_inertia: Some([0.05; 3]),
    };
    let mut spinning = load(LoadKind::LineForce, "ring", [4.0, -6.0, 0.0]);
    spinning.basis = Basis::Body;
    let mut scene = closed_ring(section, None, elements, degree);
    scene.load.push(spinning);
    scene.probe.push(probe("start", "ring@0"));
    scene.probe.extend((1..12).map(|k| {
        let xi = f64::from(k) / 12.0;
        probe(&format!("p{k}"), &format!("ring@{xi}"))
    }));
    scene.dynamics = Some(Dynamics::new(2.0, step));
    scene
}

/// Errors of position, rotation, kinetic and strain energy at one time of the table.
fn errors(solution: &Solution, step: f64, exact: &Instant, placement: &Placement) -> [f64; 4] {
    let row = (exact.time / step).round() as usize;
    let [x, y] = exact.place;
    let position = placement.undo_position(place(solution, row, 0));
    let q = solution.rows[row].probes[0].quaternion;
    let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
    let turned = placement.rotation.inverse() * q;
    let expected = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::z_axis(), exact.turn);
    let energies = &solution.energies[row];
    [
        (position - Vector3::new(x, y, 0.0)).norm() / exact.radius,
        crate::continuous::angle(&turned, &expected),
        (energies.kinetic / exact.kinetic - 1.0).abs(),
        (energies.strain / exact.strain - 1.0).abs(),
    ]
}

fn order_in_time(checks: &mut Checks) -> Outcome {
    let table = checks.reference(FILE)?;
    let instants = [Instant::new(&table, 1.0)?, Instant::new(&table, 2.0)?];
    let steps = [200, 400, 800];
    let mut all = [const { Vec::new() }; 8];
    for count in steps {
        let step = 2.0 / count as f64;
        for placement in placements(1.0) {
            let solution = follow(&placement.apply(&scene(step, ELEMENTS, DEGREE)))?;
            for (k, exact) in instants.iter().enumerate() {
                let errors = errors(&solution, step, exact, &placement);
                for (j, error) in errors.into_iter().enumerate() {
                    let list = &mut all[4 * k + j];
                    if placement.name == "as is" {
                        list.push(error);
                    } else if let Some(as_is) = list.last() {
                        checks.below(
                            Kind::Invariant,
                            format!("{} at {} s, {count} steps, {} against as is", NAMES[j], exact.time, placement.name),
                            (error - as_is).abs(),
                            1e-11,
                            "the same iterates in other axes: rounding, 200 steps of ε, and its growth by ωt = 20",
                        );
                    }
                }
            }
            if count > steps[0] {
                if count == steps[2] {
                    path(checks, &solution, &table)?;
                }
                break;
            }
        }
    }
    for (k, errors) in all.iter().enumerate() {
        let exact = &instants[k / 4];
        let name = format!("{} at {} s", NAMES[k % 4], exact.time);
        if exact.time == 1.0 {
            checks.order(
                &name,
                &steps,
                errors,
                (2.0, 0.15),
                "generalized-α is of order 2, the next term smaller by ωh = 0.05 with the breathing √(EA/ρA)/R = 10",
            );
        }
        checks.below(
            Kind::ClosedForm,
            name,
            errors[2],
            (10.0_f64 * 2.0 / 800.0).powi(2) * 10.0 * exact.time,
            "(ωh)² ωt with the breathing frequency ω = √(EA/ρA)/R = 10; errors change their sign near 2 s, where \
             only this is asked",
        );
    }
    Ok(())
}

/// The way of the point that starts at the bottom.
fn path(checks: &mut Checks, solution: &Solution, table: &Table) -> Outcome {
    checks.trajectory(Trajectory {
        title: "Spun ring: the point that starts at the bottom".to_string(),
        axes: ["x [m]", "y [m]"],
        measured: (0..solution.rows.len())
            .step_by(4)
            .map(|row| place(solution, row, 0))
            .map(|r| [r.x, r.y])
            .collect(),
        source: "three ordinary equations",
        reference: table.rows().map(|row| row.numbers("x y")).collect::<Result<_, _>>()?,
    });
    Ok(())
}

const NAMES: [&str; 4] = ["place of ξ = 0", "its rotation", "kinetic energy", "strain energy"];

/// All nodes stay on one circle about the centre, in the plane, whatever the time step.
fn symmetry(checks: &mut Checks) -> Outcome {
    let solution = follow(&scene(0.01, ELEMENTS, DEGREE))?;
    let (mut off, mut out) = (0.0_f64, 0.0_f64);
    // Probes 0, 3, 6 and 9 are ends of elements.
    for row in 0..solution.rows.len() {
        let radius = place(&solution, row, 0).norm();
        for index in (0..12).step_by(3) {
            let place = place(&solution, row, index);
            off = off.max((place.norm() / radius - 1.0).abs());
            out = out.max(place.z.abs());
        }
    }
    let reason =
        "every element does the same but for rounding: 200 steps of ε, which grow with the motion by ωt = 20";
    checks.below(Kind::Invariant, "radii at the ends of the elements, all times", off, 1e-11, reason);
    checks.below(Kind::Invariant, "out of the plane", out, 1e-11, reason);
    let violation = solution.energies.iter().map(|energies| energies.constraint).fold(0.0, f64::max);
    checks.below(
        Kind::Invariant,
        "gap of the joint that closes the ring",
        violation,
        1e-8,
        "Newton's test of joints, 1e-9 of how far the nodes travel in a step, less than 1",
    );
    // The mesh has nothing to say: another one finds the same motion with the same step.
    let finer = follow(&scene(0.01, 12, DEGREE))?;
    let last = solution.rows.len() - 1;
    checks.below(
        Kind::Invariant,
        "place of ξ = 0 at 2 s, 12 elements instead of 4",
        (place(&solution, last, 0) - place(&finer, last, 0)).norm(),
        2e-6,
        "(kh)^10 (5!/10!)² = 1e-7 with kh = π/2 of an element in a quarter of the circle, times ωt = 20",
    );
    Ok(())
}

/// Under gravity the whole falls as a point mass, by the integrator's own recursion.
fn gravity(checks: &mut Checks) -> Outcome {
    let step = 0.01;
    let weight = Vector3::new(0.3, -4.0, -9.0);
    let free = follow(&scene(step, ELEMENTS, DEGREE))?;
    let mut falling = scene(step, ELEMENTS, DEGREE);
    falling.gravity = Some(weight.into());
    let falling = follow(&falling)?;
    let mut mass = Recursion::new(0.8, 0.0, 1.0);
    let mut worst = 0.0_f64;
    for row in 1..free.rows.len() {
        let fallen = mass.step(step, 1.0);
        for index in 0..12 {
            let difference = place(&falling, row, index) - place(&free, row, index) - weight * fallen;
            worst = worst.max(difference.norm());
        }
    }
    checks.below(
        Kind::ClosedForm,
        "fall of all probes against the recursion of a point mass, all times",
        worst,
        1e-11,
        "in a falling frame every iterate is the same: rounding, 200 steps of ε times positions of 20, and its growth with \
         the motion by ωt = 20",
    );
    Ok::<(), Box<dyn Error>>(())
}
