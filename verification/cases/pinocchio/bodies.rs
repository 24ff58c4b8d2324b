//! One free rigid body of unequal moments of inertia: kinetic energy, momenta, and the accelerations that gravity, two
//! forces, a moment and its gyroscopic moment give it; the accelerations from the assembled forces and, through the
//! scene alone, from where the body is a short step later and a short step earlier.

use cosserat::Model;
use cosserat::assembly::{LoadLevel, Motion, Workspace};
use cosserat::body::MassProperties;
use cosserat::inertia::Velocity;
use cosserat::rotation::{quaternion_product, rotation_matrix, rotation_vector};
use cosserat::scene::{Basis, Body, Coordinates, Dynamics, Load, LoadKind, Method, Scene};
use cosserat::solution::Solution;
use nalgebra::{Vector3, Vector4};

use super::{Quantity, Read, compare, from_pinocchio, vector};
use crate::case::{Case, Checks, Outcome};
use crate::measure::{load, probe};
use crate::references::Row;
use crate::steps::{body, run};

const SOURCE: &str = "Pinocchio 4.1.0 and mpmath, scripts/references/pinocchio_bodies.py";

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let case = |name, run| Case::new(name, SOURCE, run).reads(&["pinocchio/free_body.csv"]);
    vec![
        case("pinocchio::body_momenta", momenta),
        case("pinocchio::body_accelerations", accelerations),
        case("pinocchio::body_steps", steps),
    ]
}

/// A row as the scene takes it.
fn scene(row: &Row) -> Read<Scene> {
    let inertia = row.numbers::<3>("inertia_x inertia_y inertia_z")?;
    let body = Body {
        orientation: row.numbers::<4>("q_w q_x q_y q_z")?,
        velocity: row.numbers::<3>("v_x v_y v_z")?,
        angular_velocity: row.numbers::<3>("omega_x omega_y omega_z")?,
        ..body("body", row.number("mass")?, inertia, row.numbers::<3>("r_x r_y r_z")?)
    };
    let acting = |kind, columns: &str| -> Read<Load> { Ok(load(kind, "body", row.numbers::<3>(columns)?)) };
    let force = acting(LoadKind::Force, "force_x force_y force_z")?;
    let lever = row.numbers::<3>("lever_x lever_y lever_z")?;
    let push = acting(LoadKind::Force, "push_x push_y push_z")?;
    let moment = acting(LoadKind::Moment, "moment_x moment_y moment_z")?;
    Ok(Scene {
        gravity: Some(row.numbers::<3>("g_x g_y g_z")?),
        body: vec![body],
        load: vec![
            Load { offset: Some(lever), ..force },
            Load { basis: Basis::Body, ..push },
            Load { basis: Basis::Body, ..moment },
        ],
        probe: vec![probe("body", "body")],
        dynamics: Some(Dynamics::new(1e-3, 1e-3)),
        ..Scene::default()
    })
}

fn velocity(row: &Row) -> Read<Velocity> {
    Ok(Velocity {
        translation: vector(row, "v_x v_y v_z")?,
        rotation: vector(row, "omega_x omega_y omega_z")?,
    })
}

fn properties(row: &Row) -> Read<MassProperties> {
    Ok(MassProperties { mass: row.number("mass")?, inertia: vector(row, "inertia_x inertia_y inertia_z")? })
}

/// Sizes of the terms of (a, ω′): what rounding is measured by.
fn sizes(row: &Row) -> Read<[f64; 2]> {
    let norm = |columns: &str| vector(row, columns).map(|v| v.norm());
    let (body, omega) = (properties(row)?, norm("omega_x omega_y omega_z")?);
    let force = norm("force_x force_y force_z")?;
    let moment = norm("moment_x moment_y moment_z")?
        + norm("lever_x lever_y lever_z")? * force
        + body.inertia.max() * omega * omega;
    let push = norm("push_x push_y push_z")?;
    let acceleration = norm("g_x g_y g_z")? + (force + push) / body.mass;
    Ok([acceleration, moment / body.inertia.min()])
}

/// The energy by the scene, the momenta as what the inertia force of these velocities taken for accelerations is.
fn momenta(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/free_body.csv")?;
    let reason =
        "sums of six positive terms, of three and of three more rounded products; A(P) carries 10 ε an entry";
    let quantities = [
        Quantity { name: "kinetic energy", rounding: 5.0, reason },
        Quantity { name: "energy at the start of the scene's motion", rounding: 5.0, reason },
        Quantity { name: "linear momentum", rounding: 2.0, reason },
        Quantity { name: "angular momentum", rounding: 25.0, reason },
    ];
    compare(checks, table.rows(), "frame", quantities, |row| {
        let (body, u) = (properties(row)?, velocity(row)?);
        let energy = row.number("energy")?;
        let solution = run(&scene(row)?)?;
        let start = solution.energies.first().ok_or("no energies")?.kinetic;
        let (force, moment) = body.inertia_force(&Velocity::default(), &u);
        let [p, l] = [vector(row, "p_x p_y p_z")?, vector(row, "l_x l_y l_z")?];
        let quaternion = Vector4::from(row.numbers::<4>("q_w q_x q_y q_z")?);
        let spin = rotation_matrix(&quaternion) * -moment;
        // Pinocchio takes the moment of p about the world's origin away.
        let lever = if from_pinocchio(row)? { vector(row, "r_x r_y r_z")?.norm() } else { 0.0 };
        Ok((
            u.rotation.norm(),
            [
                (body.kinetic_energy(&u) - energy).abs() / energy,
                (start - energy).abs() / energy,
                (-force - p).norm() / p.norm(),
                (spin - l).norm() / (l.norm() + lever * p.norm()),
            ],
        ))
    })
}

/// u̇ = M⁻¹ (f − fᵍʸʳ) from the forces assembled for no acceleration.
fn accelerations(checks: &mut Checks) -> Outcome {
    let table = checks.reference("pinocchio/free_body.csv")?;
    let reason =
        "A(P) carries 10 ε an entry, products and sums of three another 5 ε, of the sizes of all terms";
    let quantities = [
        Quantity { name: "acceleration, over the sizes of its terms", rounding: 20.0, reason },
        Quantity { name: "angular acceleration, over the sizes of its terms", rounding: 20.0, reason },
    ];
    compare(checks, table.rows(), "frame", quantities, |row| {
        let (body, u) = (properties(row)?, velocity(row)?);
        let model = Model::new(&scene(row)?)?;
        let mut work = Workspace::new(&model, Coordinates::Increments);
        let motion = Motion { velocities: vec![u], accelerations: vec![Velocity::default()] };
        let level = LoadLevel { load_factor: 0.0, preload: 1.0 };
        work.evaluate(&model, model.reference_state(), &level, Some(&motion))?;
        let acceleration = work.forces.force[0] / body.mass;
        let angular = work.forces.moment[0].component_div(&body.inertia);
        let size = sizes(row)?;
        Ok((
            u.rotation.norm(),
            [
                (acceleration - vector(row, "a_x a_y a_z")?).norm() / size[0],
                (angular - vector(row, "alpha_x alpha_y alpha_z")?).norm() / size[1],
            ],
        ))
    })
}

/// Displacement and rotation vector, body basis at the start, of one step h.
fn step(scene: &Scene, h: f64) -> Read<[Vector3<f64>; 2]> {
    let mut scene = scene.clone();
    scene.dynamics = Some(Dynamics { method: Method::Radau, ..Dynamics::new(h, h) });
    let Solution { rows, .. } = run(&scene)?;
    let [first, last] = [&rows[0].probes[0], &rows[1].probes[0]];
    let [w, x, y, z] = first.quaternion;
    let relative = quaternion_product(&Vector4::new(w, -x, -y, -z), &Vector4::from(last.quaternion));
    let moved = Vector3::from(last.position) - Vector3::from(first.position);
    Ok([moved, rotation_vector(&relative)])
}

/// The motion backwards in time is that with the velocities reversed, as no load depends on them: with both,
///
/// ```text
/// [x(h) + x(−h)]/h² = a + c h² + …
/// ```
///
/// of which two steps give a without the h². Rotation vectors do the same.
fn steps(checks: &mut Checks) -> Outcome {
    const NEWTON: f64 = 1e-8;
    let reason = "Newton stops at 1e-9 of the forces, four runs with weights 4/3 and 1/3 of differences of two; h is \
                  0.01 of the time in which the velocity changes by itself, (0.01)⁴/1440 is left of the series";
    let rounding = NEWTON / f64::EPSILON;
    let quantities = [
        Quantity { name: "acceleration by two steps, over the sizes of its terms", rounding, reason },
        Quantity { name: "angular acceleration by two steps, over the sizes of its terms", rounding, reason },
    ];
    let table = checks.reference("pinocchio/free_body.csv")?;
    let rows = table.select(&[("by", "mpmath"), ("frame", "centred")])?;
    compare(checks, rows.into_iter().take(40), "frame", quantities, |row| {
        let size = sizes(row)?;
        let omega = vector(row, "omega_x omega_y omega_z")?.norm();
        let h = 0.01 / (omega + size[1].sqrt());
        // At the origin, so that positions round no more than displacements.
        let mut forward = scene(row)?;
        forward.body[0].position = [0.0; 3];
        let mut backward = forward.clone();
        backward.body[0].velocity = forward.body[0].velocity.map(|x| -x);
        backward.body[0].angular_velocity = forward.body[0].angular_velocity.map(|x| -x);
        let second = |h: f64| -> Read<[Vector3<f64>; 2]> {
            let (ahead, behind) = (step(&forward, h)?, step(&backward, h)?);
            Ok([0, 1].map(|k| (ahead[k] + behind[k]) / (h * h)))
        };
        let (coarse, fine) = (second(h)?, second(0.5 * h)?);
        let [acceleration, angular] = [0, 1].map(|k| (4.0 * fine[k] - coarse[k]) / 3.0);
        Ok((
            omega,
            [
                (acceleration - vector(row, "a_x a_y a_z")?).norm() / size[0],
                (angular - vector(row, "alpha_x alpha_y alpha_z")?).norm() / size[1],
            ],
        ))
    })
}
