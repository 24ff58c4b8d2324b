//! A flexible rod in free flight: kicked off by pulses, then bending and tumbling on its own.
//!
//! The force rows are Galerkin's and the method is linear in them, so that the centre of mass follows the integrator's
//! recursion of a point mass exactly, however the rod bends. The moment rows are Petrov–Galerkin's: angular momentum
//! is conserved to order 2p of the mesh and order 2 of the time step.

use std::error::Error;

use cosserat::scene::{
    Basis, CurveShape, Dynamics, InterpolationKind, Load, LoadKind, LoadTime, Rod, Scene, Section,
};
use cosserat::solution::Solution;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::continuous::angle;
use crate::measure::{load, probe};
use crate::motion::{Recursion, follow, place};
use crate::pieces::line;
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "free_flight::centre_of_mass",
            "ΣN_i′ = 0: the sum of the force rows has no internal forces; the recursion of the method",
            centre_of_mass,
        ),
        Case::new(
            "free_flight::angular_momentum_of_the_mesh",
            "impulse of the loads; order 2p, petrov_galerkin::momentum",
            angular_momentum_of_the_mesh,
        ),
        Case::new(
            "free_flight::angular_momentum_in_time",
            "impulse of the loads; generalized-α is of order 2",
            angular_momentum_in_time,
        ),
        Case::new(
            "free_flight::stiff_rod",
            "Euler's equations of a rigid body; eq. (14), and the sign of eq. (15)",
            stiff_rod,
        ),
    ]
}

const MASS: f64 = 1.2;
const ROTARY: [f64; 3] = [0.03, 0.012, 0.02];

fn section(stiffness: f64) -> Section {
    Section::Custom {
        axial: 200.0 * stiffness,
        shear_y: 120.0 * stiffness,
        shear_z: 150.0 * stiffness,
        torsion: 1.5 * stiffness,
        bending_y: 1.0 * stiffness,
        bending_z: 2.0 * stiffness,
        mass_per_length: Some(MASS),
        rotary_inertia: Some(ROTARY),
    }
}

/// A pulse of 0.2 s, so smooth that it does not wake waves which the meshes do not resolve; its integral is 0.1 s.
fn pulse(kind: LoadKind, on: &str, value: [f64; 3], basis: Basis) -> Load {
    let time = (0..=INTERVALS).map(|k| [k as f64 * INTERVAL, at_point(k)]).collect();
    Load { time: Some(LoadTime::Table(time)), basis, ..load(kind, on, value) }
}

const INTERVALS: usize = 80;
const INTERVAL: f64 = 0.2 / INTERVALS as f64;

/// ⁴⁄₃ sin⁴ at the points of the table.
fn at_point(k: usize) -> f64 {
    if k < INTERVALS {
        4.0 / 3.0 * (std::f64::consts::PI * k as f64 / INTERVALS as f64).sin().powi(4)
    } else {
        0.0
    }
}

/// The pulse's factor, linear between the points.
fn factor(t: f64) -> f64 {
    let place = t / INTERVAL;
    let k = (place.floor() as usize).min(INTERVALS - 1);
    if t >= 0.2 { 0.0 } else { at_point(k) + (at_point(k + 1) - at_point(k)) * (place - k as f64) }
}

const KICK: [f64; 3] = [1.0, 8.0, -5.0];
const TWIST: [f64; 3] = [2.0, -0.6, 1.0];

#[derive(Clone, Copy, Debug)]
struct Mesh {
    interpolation: InterpolationKind,
    degree: usize,
    elements: usize,
}

impl Mesh {
    fn r12(degree: usize, elements: usize) -> Self {
        Self { interpolation: InterpolationKind::R12, degree, elements }
    }

    /// Gauss–Lobatto nodes and weights of [0, 1], the nodes of the elements and the integrals of their basis.
    fn lobatto(&self) -> Vec<(f64, f64)> {
        let five = (1.0 - 1.0 / 5.0_f64.sqrt()) / 2.0;
        let seven = (1.0 - (3.0 / 7.0_f64).sqrt()) / 2.0;
        match self.degree {
            1 => vec![(0.0, 0.5), (1.0, 0.5)],
            2 => vec![(0.0, 1.0 / 6.0), (0.5, 2.0 / 3.0), (1.0, 1.0 / 6.0)],
            3 => vec![(0.0, 1.0 / 12.0), (five, 5.0 / 12.0), (1.0 - five, 5.0 / 12.0), (1.0, 1.0 / 12.0)],
            _ => vec![
                (0.0, 0.05),
                (seven, 49.0 / 180.0),
                (0.5, 16.0 / 45.0),
                (1.0 - seven, 49.0 / 180.0),
                (1.0, 0.05),
            ],
        }
    }

    /// ξ and weight of every node, element by element; shared nodes twice.
    fn nodes(&self) -> Vec<(f64, f64)> {
        let n = self.elements as f64;
        (0..self.elements)
            .flat_map(|e| self.lobatto().into_iter().map(move |(x, w)| ((e as f64 + x) / n, w / n)))
            .collect()
    }
}

/// A quarter circle of length 1, so that bending and torsion are coupled from the start.
fn scene(mesh: &Mesh, steps: usize) -> Scene {
    let arc = CurveShape::Arc { radius: 2.0 / std::f64::consts::PI, angle: std::f64::consts::FRAC_PI_2 };
    let mut rod = Rod::new("rod", arc, section(1.0), None, mesh.elements, mesh.degree);
    rod.interpolation = mesh.interpolation;
    Scene {
        rod: vec![rod],
        load: vec![
            pulse(LoadKind::Force, "rod@1", KICK, Basis::Inertial),
            pulse(LoadKind::Moment, "rod@0", TWIST, Basis::Inertial),
        ],
        probe: mesh
            .nodes()
            .iter()
            .enumerate()
            .map(|(k, (xi, _))| probe(&format!("p{k}"), &format!("rod@{}", xi.min(1.0))))
            .collect(),
        dynamics: Some(Dynamics::new(END, END / steps as f64)),
        ..Scene::default()
    }
}

const END: f64 = 0.8;

/// The discrete rod's centre of mass; its length is that of the polynomials, so the weights are normalised.
fn centre(solution: &Solution, row: usize, mesh: &Mesh) -> Vector3<f64> {
    let nodes = mesh.nodes();
    nodes.iter().enumerate().map(|(k, (_, weight))| place(solution, row, k) * *weight).sum()
}

fn centre_of_mass(checks: &mut Checks) -> Outcome {
    // An element of a degree above one has a curved reference whose J varies: straight rods have the weights above.
    for mesh in [Mesh::r12(1, 6), Mesh::r12(2, 4), Mesh::r12(3, 2), Mesh::r12(4, 2)] {
        for placement in placements(1.0) {
            let steps = 400;
            let mut scene = scene(&mesh, steps);
            scene.rod[0].curve = line(1.0).into();
            scene.gravity = Some([0.5, -9.0, 3.0]);
            let mut turning = pulse(LoadKind::LineMoment, "rod", [0.3, -2.0, 4.0], Basis::Body);
            turning.time = Some(LoadTime::Table(vec![[0.0, 1.0], [0.3, -1.0], [0.5, 0.0]]));
            scene.load.push(turning);
            let solution = follow(&placement.apply(&scene))?;
            let weight = Vector3::new(0.5, -9.0, 3.0);
            let mut falling = Recursion::new(0.8, 0.0, 1.0);
            let mut kicked = Recursion::new(0.8, 0.0, 0.0);
            let step = END / steps as f64;
            let start = centre(&solution, 0, &mesh);
            let mut worst = 0.0_f64;
            for row in 1..solution.rows.len() {
                let fallen = falling.step(step, 1.0);
                let moved = kicked.step(step, factor(row as f64 * step));
                let expected = weight * fallen + Vector3::from(KICK) * (moved / MASS);
                let found = placement.undo_direction(centre(&solution, row, &mesh) - start);
                worst = worst.max((found - expected).norm());
            }
            checks.below(
                Kind::ClosedForm,
                format!("centre of mass, p = {}, all times, {}", mesh.degree, placement.name),
                worst,
                2e-12,
                "linear in the unknowns, so that the first iteration solves it: rounding, 400 steps of ε times \
                 positions of 20 and their sums, 2e-12",
            );
            let turn = solution.rows[steps].probes[0].quaternion;
            let turn = 2.0 * Vector3::new(turn[1], turn[2], turn[3]).norm().atan2(turn[0].abs());
            checks.above(
                Kind::Invariant,
                format!("turn of the rod meanwhile, p = {}, {}", mesh.degree, placement.name),
                turn,
                0.3,
                "a rod that only flies says nothing about one that tumbles",
            );
        }
    }
    Ok(())
}

/// Σ w (ρA r × v + A ρI ω) in a row, with rates by central differences of order four.
fn angular_momentum(solution: &Solution, row: usize, mesh: &Mesh, step: f64) -> Vector3<f64> {
    let rotation = |row: usize, index: usize| {
        let [w, x, y, z] = solution.rows[row].probes[index].quaternion;
        Quaternion::new(w, x, y, z)
    };
    let mut sum = Vector3::zeros();
    for (index, (_, weight)) in mesh.nodes().into_iter().enumerate() {
        let near = place(solution, row + 1, index) - place(solution, row - 1, index);
        let far = place(solution, row + 2, index) - place(solution, row - 2, index);
        let velocity = (near * 8.0 - far) / (12.0 * step);
        let near = rotation(row + 1, index) - rotation(row - 1, index);
        let far = rotation(row + 2, index) - rotation(row - 2, index);
        let rate = (near * 8.0 - far) / (12.0 * step);
        let q = rotation(row, index);
        let omega = (q.conjugate() * rate).imag() * 2.0;
        let spin = UnitQuaternion::from_quaternion(q) * Vector3::from(ROTARY).component_mul(&omega);
        sum += weight * (MASS * place(solution, row, index).cross(&velocity) + spin);
    }
    sum
}

/// Angular momentum at a time after the pulses, less the angular impulse of the loads.
fn excess(mesh: &Mesh, steps: usize) -> Result<Vector3<f64>, Box<dyn Error>> {
    let solution = follow(&scene(mesh, steps + 2))?;
    let step = END / (steps + 2) as f64;
    let last = mesh.nodes().len() - 1;
    let mut impulse = Vector3::zeros();
    for row in 0..=steps {
        // The trapezoidal rule; the factor vanishes at both ends.
        let arm = place(&solution, row, last);
        impulse +=
            step * factor(row as f64 * step) * (arm.cross(&Vector3::from(KICK)) + Vector3::from(TWIST));
    }
    Ok(angular_momentum(&solution, steps, mesh, step) - impulse)
}

/// The angular impulse is about 0.1 s (0.7 · 9 N + 2.3 N m), and what is bent carries as much.
const IMPULSE: f64 = 1.0;

fn angular_momentum_of_the_mesh(checks: &mut Checks) -> Outcome {
    let steps = 798;
    let reference = excess(&Mesh::r12(4, 10), steps)?;
    let se3 = |elements| Mesh { interpolation: InterpolationKind::Se3, degree: 1, elements };
    let ladders: [(&str, [Mesh; 3]); 4] = [
        ("R12, p = 1", [8, 16, 32].map(|n| Mesh::r12(1, n))),
        ("SE(3)", [8, 16, 32].map(se3)),
        ("R12, p = 2", [4, 8, 16].map(|n| Mesh::r12(2, n))),
        ("R12, p = 3", [2, 4, 8].map(|n| Mesh::r12(3, n))),
    ];
    for (what, meshes) in ladders {
        let errors = meshes
            .iter()
            .map(|mesh| Ok((excess(mesh, steps)? - reference).norm() / IMPULSE))
            .collect::<Result<Vec<f64>, Box<dyn Error>>>()?;
        let counts = meshes.map(|mesh| mesh.elements);
        let p = meshes[0].degree;
        let factorials: f64 = (1..=p).map(|k| 1.0 / (p + k) as f64).product();
        checks.order(
            format!("angular momentum less impulse, {what}"),
            &counts,
            &errors,
            (2.0 * p as f64, 0.3),
            "2p; the next term is smaller by (kh)², k = 4.7 of the first bending vibration: 0.2 on the coarsest pair",
        );
        checks.below(
            Kind::Order,
            format!("angular momentum less impulse, {what}, finest"),
            errors[2],
            (5.0 / counts[2] as f64).powi(2 * p as i32) * factorials * factorials,
            "(kh)^{2p} [p!/(2p)!]² of the impulse, k = 4.7 of the first bending vibration",
        );
    }
    Ok(())
}

fn angular_momentum_in_time(checks: &mut Checks) -> Outcome {
    let counts = [398, 798, 1598];
    let errors = counts
        .iter()
        .map(|&steps| Ok(excess(&Mesh::r12(4, 10), steps)?.norm() / IMPULSE))
        .collect::<Result<Vec<f64>, Box<dyn Error>>>()?;
    checks.order(
        "angular momentum less impulse",
        &[400, 800, 1600],
        &errors,
        (2.0, 0.2),
        "generalized-α is of order 2; the next term is smaller by ωh = 0.1 with the third bending vibration of 110 rad/s",
    );
    checks.below(
        Kind::Order,
        "angular momentum less impulse, finest",
        errors[2],
        (10.0 * END / 1600.0_f64).powi(2) * 10.0 * END,
        "(ωh)² ωt of the impulse, with the spin of 10 rad/s",
    );
    Ok(())
}

/// ω and q of a rigid body under body moments, by the classical Runge–Kutta method, with the gyroscopic moment
/// ω × G ω.
fn rigid(inertia: Vector3<f64>, g: Vector3<f64>, moment: Vector3<f64>, end: f64) -> UnitQuaternion<f64> {
    type Motion = (Vector3<f64>, Quaternion<f64>);
    let rate = |t: f64, (omega, q): &Motion| -> Motion {
        let torque = moment * factor(t) - omega.cross(&g.component_mul(omega));
        (torque.component_div(&inertia), q * Quaternion::from_imag(*omega) * 0.5)
    };
    let add = |y: &Motion, h: f64, k: &Motion| -> Motion { (y.0 + k.0 * h, y.1 + k.1 * h) };
    let (count, mut y) = (20_000, (Vector3::zeros(), Quaternion::identity()));
    let h = end / f64::from(count);
    for index in 0..count {
        let t = f64::from(index) * h;
        let a = rate(t, &y);
        let b = rate(t + 0.5 * h, &add(&y, 0.5 * h, &a));
        let c = rate(t + 0.5 * h, &add(&y, 0.5 * h, &b));
        let d = rate(t + h, &add(&y, h, &c));
        for (weight, k) in [(1.0, a), (2.0, b), (2.0, c), (1.0, d)] {
            y = add(&y, weight * h / 6.0, &k);
        }
    }
    UnitQuaternion::from_quaternion(y.1)
}

/// A rod that hardly bends tumbles as a rigid body; with the other sign of the gyroscopic force it would not.
fn stiff_rod(checks: &mut Checks) -> Outcome {
    const TUMBLE: f64 = 2.0;
    let moment = Vector3::new(2.0, -1.5, 1.0);
    let across = MASS / 12.0;
    let inertia = Vector3::from(ROTARY) + Vector3::new(0.0, across, across);
    let exact = rigid(inertia, inertia, moment, TUMBLE);
    // Only the rotary inertia of the sections has a gyroscopic force to get wrong.
    let reversed = inertia - 2.0 * Vector3::from(ROTARY);
    let wrong = angle(&rigid(inertia, reversed, moment, TUMBLE), &exact);
    let counts = [400, 800, 1600];
    let mut errors = Vec::new();
    for count in counts {
        let scene = Scene {
            rod: vec![Rod::new("rod", line(1.0), section(1e5), None, 2, 4)],
            load: vec![pulse(LoadKind::LineMoment, "rod", moment.into(), Basis::Body)],
            probe: vec![probe("middle", "rod@0.5")],
            dynamics: Some(Dynamics::new(TUMBLE, TUMBLE / count as f64)),
            ..Scene::default()
        };
        let solution = follow(&scene)?;
        let [w, x, y, z] = solution.rows[count].probes[0].quaternion;
        errors.push(angle(&UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)), &exact));
    }
    checks.order(
        "rotation after 2 s",
        &counts,
        &errors,
        (2.0, 0.2),
        "generalized-α is of order 2; the next term is smaller by ωh, 0.1 at most",
    );
    let spin = 0.1 * 2.0 / inertia.x;
    checks.below(
        Kind::ClosedForm,
        "rotation after 2 s, finest",
        errors[2],
        (spin * TUMBLE / 1600.0).powi(2) * spin * TUMBLE + 1e-3,
        "(ωh)² ωt, ω = 7 rad/s; (ω/ω_bending)² ωt = 3e-5 · 14 of the rod's compliance, ω_bending = 22 · √1e5 rad/s",
    );
    checks.above(
        Kind::ClosedForm,
        "what the wrong sign would add",
        wrong,
        0.1,
        "two orders above the bound: the sign is seen",
    );
    Ok(())
}
