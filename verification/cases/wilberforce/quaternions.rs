//! The norm of a nodal quaternion turns nothing: rescaled quaternions give the same forces and the same motion, and
//! q̇ = B(q) u is linear in q, q̇ = D(u) q, eq. (10).

use cosserat::Model;
use cosserat::assembly::{LoadLevel, Workspace};
use cosserat::rotation::{quaternion_rate, rotation_matrix};
use cosserat::scene::Coordinates;
use nalgebra::{Matrix4, Vector3, Vector4};

use super::{Pendulum, paper_steps};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::states::Generator;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "wilberforce::rates",
            "eq. (10): B(q) u = D(u) q, D written from the product with (0, ω)",
            rates,
        ),
        Case::new("wilberforce::norms", "eq. (5): A(P) does not depend on ‖P‖", norms),
    ]
}

/// ½ P ∘ (0, ω) as a matrix on P.
fn rate_matrix(omega: &Vector3<f64>) -> Matrix4<f64> {
    let (x, y, z) = (omega.x, omega.y, omega.z);
    0.5 * Matrix4::new(0.0, -x, -y, -z, x, 0.0, z, -y, y, -z, 0.0, x, z, y, -x, 0.0)
}

fn quaternion(random: &mut Generator) -> Vector4<f64> {
    let norm = 10.0_f64.powf(6.0 * random.number());
    Vector4::from_fn(|_, _| random.number()) * norm
}

fn rates(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(7);
    let (mut identity, mut norm, mut kinematic) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..1000 {
        let (p, omega) = (quaternion(&mut random), 20.0 * random.vector());
        let rate = quaternion_rate(&p) * omega;
        let size = p.norm() * omega.norm();
        identity = identity.max((rate - rate_matrix(&omega) * p).norm() / size);
        // d‖P‖²/dt = 0.
        norm = norm.max((p.dot(&rate) / (p.norm() * size)).abs());
        // Ȧ = A ω̃, by a central difference along the rate.
        let step = 1e-4 / omega.norm();
        let a = |sign: f64| rotation_matrix(&(p + sign * step * rate));
        let turned = (a(1.0) - a(-1.0)) / (2.0 * step);
        let exact = rotation_matrix(&p) * omega.cross_matrix();
        kinematic = kinematic.max((turned - exact).norm() / omega.norm());
    }
    let reason = "four products and three sums, each rounded: 4 ε";
    checks.below(Kind::ClosedForm, "B(q) u − D(u) q, relative", identity, 4.0 * f64::EPSILON, reason);
    checks.below(Kind::Invariant, "P·Ṗ, relative", norm, 4.0 * f64::EPSILON, reason);
    let reason = "a difference over 1e-4 rad: (1e-4)²/6 · √2 and ε/1e-4 at nine entries";
    checks.below(Kind::ClosedForm, "Ȧ − A ω̃, relative", kinematic, 3e-8, reason);
    Ok(())
}

/// Forces of a state under the weight.
fn forces(model: &Model, state: &cosserat::state::State) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let mut work = Workspace::new(model, Coordinates::Increments);
    work.evaluate(model, state, &LoadLevel { load_factor: 1.0, preload: 1.0 }, None)?;
    let nodes = work.forces.force.iter().zip(&work.forces.moment);
    Ok(nodes.flat_map(|(f, m)| [f.x, f.y, f.z, m.x, m.y, m.z]).collect())
}

fn norms(checks: &mut Checks) -> Outcome {
    // Forces of a deformed state whose quaternions are scaled.
    let model = Model::new(&Pendulum::paper().statics(Default::default()))?;
    let mut random = Generator::new(11);
    let mut state = model.reference_state().clone();
    for node in 0..state.poses().len() {
        let position = state.poses()[node].position + 1e-3 * random.vector();
        let turned = state.quaternions()[node] + 0.03 * Vector4::from_fn(|_, _| random.number());
        state.set_position(node, position);
        state.set_quaternion(node, turned);
    }
    let plain = forces(&model, &state)?;
    let scale = plain.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    for (name, powers) in [("powers of two", true), ("any factors", false)] {
        let mut scaled = state.clone();
        for node in 0..state.poses().len() {
            let exponent = 20.0 * random.number();
            let factor = if powers { exponent.round().exp2() } else { -exponent.exp2() };
            scaled.set_quaternion(node, state.quaternions()[node] * factor);
        }
        let found = forces(&model, &scaled)?;
        let error = plain.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale;
        let (bound, reason) = if powers {
            (0.0, "a power of two changes no digit")
        } else {
            (1e-13, "relative to the largest force: matrices of ten roundings, differenced over six nodes")
        };
        checks.below(Kind::Invariant, format!("forces, quaternions scaled by {name}"), error, bound, reason);
        state.normalize();
    }

    // The motion of a scene whose orientations are scaled; the bob is the same however it is turned about its axis.
    let options = paper_steps(1.0);
    let plain = Pendulum::paper().swing_as_is(&options)?;
    let turned = |factor: f64| {
        let orientation = [0.9 * factor, 0.0, 0.0, 0.7 * factor];
        Pendulum { orientation, ..Pendulum::paper() }.swing_as_is(&options)
    };
    let one = turned(1.0)?;
    let digit = "a last digit more or less moves a step within the tolerance of 1e-8 N m at most, 2.6e-8 rad, and not all \
                 of 200 steps to one side";
    for (name, other, bound, reason) in [
        ("orientation of the bob times 4", turned(4.0)?, 0.0, "a power of two changes no digit"),
        ("orientation of the bob times −3.7", turned(-3.7)?, 1e-7, digit),
        ("bob not turned about its axis", plain, 1e-6, digit),
    ] {
        let row = one.at(1.0);
        let shift = (one.positions[row] - other.positions[row]).norm() / 0.1;
        let turn = (one.rotations[row] - other.rotations[row]).norm();
        checks.below(Kind::Invariant, format!("motion to 1 s, {name}"), shift.max(turn), bound, reason);
    }
    Ok(())
}
