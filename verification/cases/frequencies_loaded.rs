//! Vibrations about a loaded equilibrium: a straight rod under tension and compression, up to buckling and beyond.
//!
//! A rod along x under the dead axial force −P is stretched by λ = 1 − P/EA. A small deflection w and rotation θ about it
//! have the shear w′ − λθ, and the equations of motion are, per reference length,
//!
//! ```text
//! N = GA (w′ − λθ) − P θ          transverse force           N′ = −ω² ρA w
//! M = EI θ′                       moment                     M′ = −ω² ρI θ − (λ GA + P)(w′ − λθ)
//! ```
//!
//! with w = θ = 0 at the clamp, and N = ω² m w, M = ω² J θ at a body of mass m and inertia J at the end (r′ × n, whose
//! component is λ N + P w′ = (λ GA + P)(w′ − λθ)). The coefficients are constant, so that the matrix exponential is
//! the solution.

use cosserat::scene::{Body, JointKind, LoadKind, Material, Modes, Rod, Scene};
use nalgebra::{Matrix2, Matrix4};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load};
use crate::motion::{joint, vibrate};
use crate::pieces::{line, rectangle, young_shear};
use crate::placement::placements;

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str =
        "the linearised continuous equations of a straight Cosserat rod, by the matrix exponential";
    vec![
        Case::new("frequencies_loaded::axial_force", SOURCE, axial_force),
        Case::new(
            "frequencies_loaded::buckling",
            "P (1 + P/GA − P/EA) = π²EI/(4L²), column with stretch and shear; linear law near it",
            buckling,
        ),
        Case::new("frequencies_loaded::hanging_body", SOURCE, hanging_body),
    ]
}

const YOUNG: f64 = 1e6;
const SHEAR: f64 = 4e5;
const DENSITY: f64 = 1000.0;
/// Along e_y, the weak direction, and along e_z.
const SIDES: [f64; 2] = [0.05, 0.08];

/// A rod of length 1 in bending about e_z, or about e_y.
#[derive(Clone, Copy, Debug)]
struct Planar {
    axial: f64,
    shear: f64,
    bending: f64,
    mass: f64,
    rotary: f64,
    /// Compression P.
    force: f64,
    body: [f64; 2],
}

impl Planar {
    fn new(strong: bool, force: f64) -> Self {
        let [width, height] = SIDES;
        let area = width * height;
        let second = if strong { area * height * height } else { area * width * width } / 12.0;
        Self {
            axial: YOUNG * area,
            shear: SHEAR * area,
            bending: YOUNG * second,
            mass: DENSITY * area,
            rotary: DENSITY * second,
            force,
            body: [0.0; 2],
        }
    }

    /// Zero where ω² is an eigenvalue.
    fn determinant(&self, square: f64) -> f64 {
        let stretch = 1.0 - self.force / self.axial;
        let p = self.force;
        // Rates of (w, θ, N, M); the shear is (N + P θ)/GA.
        let lever = stretch * self.shear + p;
        let matrix = Matrix4::new(
            0.0,
            stretch + p / self.shear,
            1.0 / self.shear,
            0.0,
            0.0,
            0.0,
            0.0,
            1.0 / self.bending,
            -square * self.mass,
            0.0,
            0.0,
            0.0,
            0.0,
            -square * self.rotary - lever * p / self.shear,
            -lever / self.shear,
            0.0,
        );
        // In units in which all entries are alike.
        let scale = Matrix4::from_diagonal(&nalgebra::Vector4::new(1.0, 1.0, self.bending, self.bending));
        let end = (scale.try_inverse().unwrap_or_else(Matrix4::zeros) * matrix * scale).exp();
        let [mass, inertia] = self.body.map(|x| x * square / self.bending);
        let row = |force: usize, place: usize, inertia: f64, column: usize| {
            end[(force, column)] - inertia * end[(place, column)]
        };
        Matrix2::new(row(2, 0, mass, 2), row(2, 0, mass, 3), row(3, 1, inertia, 2), row(3, 1, inertia, 3))
            .determinant()
    }

    /// The `count` lowest ω², from `from` on, by steps and bisection.
    fn squares(&self, from: f64, count: usize) -> Vec<f64> {
        // A hundredth of the first of a massive or massless free rod, in size.
        let step = 0.02 * self.bending / (self.mass + 3.0 * self.body[0]);
        let (mut found, mut low) = (Vec::new(), from);
        let mut value = self.determinant(low);
        while found.len() < count {
            // Steps that grow like the distances between eigenvalues.
            let high = low + step.max(0.02 * low.abs());
            let next = self.determinant(high);
            if value.signum() != next.signum() {
                let (mut a, mut b) = (low, high);
                for _ in 0..200 {
                    let middle = 0.5 * (a + b);
                    if self.determinant(middle).signum() == value.signum() { a = middle } else { b = middle }
                }
                found.push(0.5 * (a + b));
            }
            (low, value) = (high, next);
        }
        found
    }

    /// The load at which ω² = 0: P λ (λ GA + P)/GA … = π² EI/(4 L²), written as in the source.
    fn critical(&self) -> f64 {
        let euler = std::f64::consts::PI.powi(2) * self.bending / 4.0;
        let c = 1.0 / self.shear - 1.0 / self.axial;
        2.0 * euler / (1.0 + (1.0 + 4.0 * euler * c).sqrt())
    }
}

fn material() -> Material {
    Material { density: Some(DENSITY), ..young_shear(YOUNG, SHEAR) }
}

fn column(force: f64, count: usize) -> Scene {
    let [width, height] = SIDES;
    Scene {
        rod: vec![Rod::new("rod", line(1.0), rectangle(width, height, None), Some(material()), 4, 8)],
        joint: vec![clamp("rod@0")],
        load: vec![load(LoadKind::Force, "rod@1", [-force, 0.0, 0.0])],
        modes: Some(Modes { count }),
        ..Scene::default()
    }
}

const EXACT: &str = "(kh)^16 (8!/16!)² < 1e-12 of the mesh; half of ε (c p² n/L)²/ω², 1e-9 at most at 10 rad/s, of rounding; \
                     the equilibrium is found to 1e-9 of the load, ω² = ω₀² (1 − P/P_cr)";

/// ω with the sign of ω².
fn signed(square: f64) -> f64 {
    square.abs().sqrt().copysign(square)
}

/// Bending frequencies in both planes under loads from tension to near buckling.
fn axial_force(checks: &mut Checks) -> Outcome {
    let critical = Planar::new(false, 0.0).critical();
    for ratio in [-8.0, -1.0, 0.0, 0.5, 0.9] {
        let force = ratio * critical;
        let mut expected: Vec<f64> = [false, true]
            .into_iter()
            .flat_map(|strong| Planar::new(strong, force).squares(-1.0, 3))
            .map(signed)
            .collect();
        expected.sort_by(f64::total_cmp);
        for placement in placements(1.0) {
            let solution = vibrate(&placement.apply(&column(force, 4)))?;
            for (n, (mode, omega)) in solution.modes.iter().zip(&expected).enumerate() {
                checks.relative(
                    Kind::ClosedForm,
                    format!("ω{} at P = {ratio} P_cr, {}", n + 1, placement.name),
                    (mode.angular_frequency, *omega),
                    1e-8 / (1.0 - ratio).min(1.0),
                    EXACT,
                );
            }
        }
    }
    Ok(())
}

fn buckling(checks: &mut Checks) -> Outcome {
    let free = Planar::new(false, 0.0);
    let critical = free.critical();
    let at_critical = Planar::new(false, critical);
    checks.below(
        Kind::ClosedForm,
        "reference: the determinant at ω = 0 and the column's critical load",
        at_critical.determinant(0.0).abs(),
        1e-12,
        "the same equations twice: rounding",
    );
    // Linear near the critical load.
    let mut slopes = Vec::new();
    let distances = [0.04, 0.02, 0.01];
    for distance in distances {
        let mode = vibrate(&column((1.0 - distance) * critical, 1))?.modes[0].angular_frequency;
        slopes.push(mode * mode / distance);
    }
    let slope = 2.0 * slopes[2] - slopes[1];
    let differences: Vec<f64> = slopes.iter().map(|s| (s / slope - 1.0).abs()).collect();
    checks.order(
        "ω²/(1 − P/P_cr) minus its limit, over the distance from P_cr",
        &[1, 2, 4],
        &differences,
        (1.0, 0.1),
        "ω² is analytic in P with a simple zero at P_cr: the next term of the slope is linear, and the one after a \
         25th of it",
    );
    // d(ω²)/dP at P_cr from the shape of buckling: Rayleigh's quotient is stationary there.
    let [derivative, square] = [std::f64::consts::PI.powi(2) / 8.0, 1.5 - 4.0 / std::f64::consts::PI];
    checks.relative(
        Kind::ClosedForm,
        "ω²/(1 − P/P_cr) at P_cr against P_cr ∫φ′² dx/∫ρA φ² dx, φ = 1 − cos(πx/2L)",
        (slope, critical * derivative / (free.mass * square)),
        3.0 * (std::f64::consts::PI / 2.0).powi(2) * free.bending / free.axial * (1.0 + YOUNG / SHEAR),
        "Euler–Bernoulli's shape: shear and rotary inertia are (πr/2L)² (1 + E/G) of it, once in φ and twice in φ²",
    );
    for ratio in [1.01, 1.5, 3.0] {
        let force = ratio * critical;
        let growth = Planar::new(false, force).squares(-200.0 * ratio * ratio, 1)[0];
        let solution = vibrate(&column(force, 2))?;
        let what = format!("growth at P = {ratio} P_cr");
        let measured = solution.modes[0].angular_frequency;
        checks.relative(
            Kind::ClosedForm,
            what.clone(),
            (measured, signed(growth)),
            1e-8 / (ratio - 1.0).min(1.0),
            EXACT,
        );
        let told = solution.warnings.iter().any(|warning| warning.contains("unstable"));
        checks.above(
            Kind::Invariant,
            format!("{what}: a warning"),
            f64::from(u8::from(told)),
            1.0,
            "an unstable equilibrium must not pass in silence",
        );
    }
    let stable = vibrate(&column(0.99 * critical, 2))?;
    checks.absolute(
        Kind::Invariant,
        "warnings below the critical load",
        (stable.warnings.len() as f64, 0.0),
        0.0,
        "the equilibrium is stable and the frequencies are real",
    );
    Ok(())
}

/// A body hanging from a soft clamped rod, or standing on it; gravity pulls on the body only.
fn hanging_body(checks: &mut Checks) -> Outcome {
    let (mass, inertia) = (3.0, [0.004, 0.005, 0.006]);
    for (what, gravity) in [("hanging", 9.81), ("weightless", 0.0), ("standing", -0.7)] {
        let force = -mass * gravity;
        let mut expected: Vec<f64> = [(false, inertia[2]), (true, inertia[1])]
            .into_iter()
            .flat_map(|(strong, inertia)| {
                let planar = Planar { body: [mass, inertia], ..Planar::new(strong, force) };
                planar.squares(-1.0, 2)
            })
            .map(signed)
            .collect();
        expected.sort_by(f64::total_cmp);
        let mut scene = column(0.0, 2);
        scene.load.clear();
        scene.gravity = Some([gravity, 0.0, 0.0]);
        scene.rod[0].gravity = false;
        scene.body.push(Body {
            name: "weight".to_string(),
            shape: None,
            density: None,
            mass: Some(mass),
            inertia: Some(inertia),
            position: [1.0, 0.0, 0.0],
            orientation: [1.0, 0.0, 0.0, 0.0],
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
        });
        scene.joint.push(joint(JointKind::Rigid, "rod@1", "weight", None));
        for placement in placements(1.0) {
            let solution = vibrate(&placement.apply(&scene))?;
            for (n, (mode, omega)) in solution.modes.iter().zip(&expected).enumerate() {
                checks.relative(
                    Kind::ClosedForm,
                    format!("{what}, ω{}, {}", n + 1, placement.name),
                    (mode.angular_frequency, *omega),
                    1e-8,
                    EXACT,
                );
            }
        }
    }
    Ok(())
}
