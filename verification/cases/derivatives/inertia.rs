//! Inertia of one element: mass matrix, inertia and gyroscopic forces, kinetic energy, and the tangent of an implicit
//! time step.

use cosserat::element::{ElementForce, ElementTangent, zero_tangent};
use cosserat::inertia::{
    Velocity, gyroscopic_tangent, inertia_force, kinetic_energy, mass_coefficients, spin_from_turn,
};
use cosserat::interpolation::Increment;
use cosserat::lagrange::{Basis, basis_at_rule};
use cosserat::lanes::Plain;
use cosserat::quadrature::gauss_legendre;
use cosserat::scene::NodeSpacing;
use cosserat::section::SectionInertia;
use nalgebra::{Vector3, Vector6};
use num_dual::Dual64;

use super::forces::compare_rows;
use super::{ROUNDING, ROUNDING_REASON};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{self, Frame, Number, Pair, Rows, Weight, axial, lift, rotation, tilde, turned};
use crate::one_element::inertia_tangent;
use crate::states::{ElementState, Generator, Worst, places, unit_increment};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("derivatives::mass_matrix", "eq. (13)", mass_matrix),
        Case::new(
            "derivatives::inertia",
            "eq. (13), (14) as one integral over the fields (9); f = −M u̇ − fᵍʸʳ",
            inertia,
        ),
        Case::new(
            "derivatives::implicit_step",
            "P₊ ∝ P* ∘ (1, b ω₊/2), r₊ = r* + b v₊, u₊ = u* + b u̇₊",
            implicit_step,
        ),
    ]
}

/// Four different inertias, within a factor of three.
const SECTION: SectionInertia = SectionInertia { mass_per_length: 1.3, rotary: Vector3::new(1.7, 0.6, 1.1) };
const WEIGHT: Weight = (SECTION.mass_per_length, SECTION.rotary);

/// Time steps: where M is everything, where all parts count, where the pose is.
pub const STEPS: [f64; 4] = [1e-4, 0.1, 1.0, 30.0];

/// An element with its rule of full quadrature.
struct Element<const N: usize> {
    places: [f64; N],
    rule: Vec<Basis<N>>,
    weighted: Vec<(f64, f64)>,
    jacobians: Vec<f64>,
    mass: [[f64; N]; N],
}

impl<const N: usize> Element<N> {
    fn new(spacing: NodeSpacing, jacobian: impl FnMut(&Basis<N>) -> f64) -> Self {
        let places = places::<N>(spacing);
        let quadrature = gauss_legendre((N * N).div_ceil(2));
        let rule = basis_at_rule(&places, &quadrature);
        let jacobians: Vec<f64> = rule.iter().map(jacobian).collect();
        let weighted = quadrature.points.into_iter().zip(quadrature.weights).collect();
        let mass = mass_coefficients(&rule, &jacobians);
        Self { places, rule, weighted, jacobians, mass }
    }

    /// −M u̇ − fᵍʸʳ(u) of the formulas.
    fn exact<D: Number>(&self, velocities: &[Pair<D>], accelerations: &[Pair<D>]) -> Rows<D> {
        formulas::inertia_force(
            &self.places,
            &self.weighted,
            &self.jacobians,
            WEIGHT,
            velocities,
            accelerations,
        )
    }
}

pub fn velocity(random: &mut Generator) -> Velocity {
    Velocity { translation: random.vector(), rotation: random.vector() }
}

fn pairs<D: Number, const N: usize>(velocities: &[Velocity; N]) -> Vec<Pair<D>> {
    velocities.iter().map(|u| (lift(&u.translation), lift(&u.rotation))).collect()
}

/// Does it for every degree that has a check of its own elsewhere.
macro_rules! every_degree {
    ($check:ident, $checks:expr) => {
        for spacing in [NodeSpacing::GaussLobatto, NodeSpacing::Equal] {
            $check::<2>($checks, spacing, "p = 1");
            $check::<3>($checks, spacing, "p = 2");
            $check::<4>($checks, spacing, "p = 3");
            $check::<6>($checks, spacing, "p = 5");
            $check::<9>($checks, spacing, "p = 8");
        }
    };
}

fn mass_matrix(checks: &mut Checks) -> Outcome {
    every_degree!(mass_of, checks);
    Ok(())
}

/// m_ij with an uneven J at every point; with an even one by the moments of the monomials, Σ m_ij x_i^a x_j^b =
/// J ∫ x^(a+b) dx, which N_i reproduces for a, b ≤ p.
fn mass_of<const N: usize>(checks: &mut Checks, spacing: NodeSpacing, name: &str) {
    let mut random = Generator::new(200);
    let element = Element::<N>::new(spacing, |_| 1.0 + 0.3 * random.number());
    let mut coefficients = Worst::default();
    let integral = |i: usize, j: usize| -> f64 {
        let at = |(&(x, weight), jacobian): (&(f64, f64), &f64)| {
            let [first, second] = [i, j].map(|k| formulas::shape(&element.places, k, x).0);
            weight * first * second * jacobian
        };
        element.weighted.iter().zip(&element.jacobians).map(at).sum()
    };
    let all = || (0..N).flat_map(|i| (0..N).map(move |j| (i, j)));
    coefficients.compare(all().map(|(i, j)| element.mass[i][j]), all().map(|(i, j)| integral(i, j)));

    let even = Element::<N>::new(spacing, |_| 0.7);
    let mut moments = Worst::default();
    for (a, b) in all() {
        let power = |i: usize, n: usize| even.places[i].powi(n as i32);
        let sum: f64 = all().map(|(i, j)| even.mass[i][j] * power(i, a) * power(j, b)).sum();
        moments.compare([sum], [0.7 / (a + b + 1) as f64]);
    }
    for (quantity, worst) in [("∫ N_i N_j J dx", coefficients), ("moments of M", moments)] {
        let quantity = format!("{quantity}, {name}, {spacing:?}");
        checks.below(Kind::ClosedForm, quantity, worst.0, ROUNDING, ROUNDING_REASON);
    }
}

fn inertia(checks: &mut Checks) -> Outcome {
    every_degree!(inertia_of, checks);
    Ok(())
}

fn inertia_of<const N: usize>(checks: &mut Checks, spacing: NodeSpacing, name: &str) {
    let [mut rows, mut scales, mut energy] = [Worst::default(); 3];
    for seed in 210..220 {
        let mut random = Generator::new(seed);
        let element = Element::<N>::new(spacing, |_| 1.0 + 0.3 * random.number());
        let velocities: [Velocity; N] = std::array::from_fn(|_| velocity(&mut random));
        let accelerations: [Velocity; N] = std::array::from_fn(|_| velocity(&mut random));
        let mut force = ElementForce::default();
        inertia_force(
            &element.rule,
            &element.jacobians,
            &element.mass,
            &SECTION,
            &velocities,
            &accelerations,
            &mut force,
        );
        compare_rows(&mut rows, &force, &element.exact(&pairs(&velocities), &pairs(&accelerations)));
        compare_scales(&mut scales, &element, &velocities, &accelerations, &force);
        // What is there is kept.
        let mut twice = force;
        inertia_force(
            &element.rule,
            &element.jacobians,
            &element.mass,
            &SECTION,
            &velocities,
            &accelerations,
            &mut twice,
        );
        let list = |f: &ElementForce<N>| -> Vec<f64> {
            let vectors = f.force.iter().chain(&f.moment).flatten();
            vectors.chain(&f.force_scale).chain(&f.moment_scale).copied().collect()
        };
        rows.compare(list(&twice), list(&force).into_iter().map(|x| 2.0 * x));
        let exact = formulas::kinetic_energy(
            &element.places,
            &element.weighted,
            &element.jacobians,
            WEIGHT,
            &pairs(&velocities),
        );
        energy.compare([kinetic_energy(&element.mass, &SECTION, &velocities)], [exact]);
    }
    for (quantity, worst) in
        [("−M u̇ − fᵍʸʳ", rows), ("sums of absolute contributions", scales), ("½ uᵀ M u", energy)]
    {
        let quantity = format!("{quantity}, {name}, {spacing:?}");
        checks.below(Kind::Invariant, quantity, worst.0, ROUNDING, ROUNDING_REASON);
    }
}

/// Σ |contribution|: of every node to M u̇, and of every point to fᵍʸʳ.
fn compare_scales<const N: usize>(
    worst: &mut Worst,
    element: &Element<N>,
    velocities: &[Velocity; N],
    accelerations: &[Velocity; N],
    force: &ElementForce<N>,
) {
    let (mut forces, mut moments) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        for j in 0..N {
            let weight = element.mass[i][j].abs();
            forces[i] += weight * SECTION.mass_per_length * accelerations[j].translation.norm();
            moments[i] += weight * SECTION.rotary.component_mul(&accelerations[j].rotation).norm();
        }
        for (&(x, weight), jacobian) in element.weighted.iter().zip(&element.jacobians) {
            let mut omega = Vector3::zeros();
            for (k, u) in velocities.iter().enumerate() {
                omega += u.rotation * formulas::shape(&element.places, k, x).0;
            }
            let moment = tilde(&omega) * SECTION.rotary.component_mul(&omega);
            moments[i] +=
                (weight * jacobian * formulas::shape(&element.places, i, x).0).abs() * moment.norm();
        }
    }
    worst.compare(force.force_scale, forces);
    worst.compare(force.moment_scale, moments);
}

fn implicit_step(checks: &mut Checks) -> Outcome {
    turn_of_a_step(checks);
    every_degree!(step_of, checks);
    Ok(())
}

/// The quaternion of a step, δω = Y⁻¹ δφ/b, and the derivative of ω × I ω, each alone.
fn turn_of_a_step(checks: &mut Checks) {
    let mut random = Generator::new(230);
    let [mut update, mut turn, mut gyroscopic] = [Worst::default(); 3];
    for b in STEPS {
        for _ in 0..10 {
            let (omega, old) = (random.vector(), 3.0 * random.axis().insert_row(0, random.number()));
            // P₊ − b Q(P₊) ω is P*, but for its norm.
            let new = turned(&old, &(b * omega));
            let back = new - formulas::quaternion_rate(&new, &(b * omega));
            update.compare(back.normalize().iter().copied(), old.normalize().iter().copied());
            for k in 0..3 {
                let moving = omega.zip_map(&Vector3::ith(k, 1.0), Dual64::new);
                let a = rotation(&turned(&old.map(Dual64::from_re), &(moving * Dual64::from_re(b))));
                let back = spin_from_turn(&omega, b) * body_rate(&a) / b;
                turn.compare(back.iter().copied(), Vector3::<f64>::ith(k, 1.0).iter().copied());
                let exact = tilde(&moving) * moving.component_mul(&lift(&SECTION.rotary));
                let ours = gyroscopic_tangent(&SECTION.rotary, &omega);
                gyroscopic.compare(ours.column(k).iter().copied(), exact.iter().map(|x| x.eps));
            }
        }
    }
    let reason = "200 ε: dozens of operations with numbers of one size";
    checks.below(Kind::Invariant, "P₊ − b Ṗ₊ = P*", update.0, 5e-14, reason);
    checks.below(Kind::Invariant, "∂(ω × I ω)/∂ω", gyroscopic.0, 5e-14, reason);
    let reason = "20 ε |y|: Y⁻¹, of size |y|², magnifies the rounding of δφ/b, of size 1/|y|; |y| reaches 26";
    checks.below(Kind::Invariant, "Y⁻¹ δφ/b = δω", turn.0, 1.2e-13, reason);
}

/// j⁻¹(Aᵀ δA).
fn body_rate(a: &nalgebra::Matrix3<Dual64>) -> Vector3<f64> {
    axial(&(a.map(|x| Dual64::from_re(x.re)).transpose() * a)).map(|x| x.eps)
}

/// Forces that depend on the poses of all nodes, of no other meaning: A_j w_ij + c_ij × r_j and
/// A_iᵀ (r_j × A_j w_ij).
struct MadeUp<const N: usize> {
    turning: [[Vector3<f64>; N]; N],
    placed: [[Vector3<f64>; N]; N],
}

impl<const N: usize> MadeUp<N> {
    fn new(random: &mut Generator) -> Self {
        let mut table = || std::array::from_fn(|_| std::array::from_fn(|_| random.vector()));
        Self { turning: table(), placed: table() }
    }

    fn rows<D: Number>(&self, nodes: &[Frame<D>]) -> Rows<D> {
        let sum = |i: usize| {
            let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
            for (j, node) in nodes.iter().enumerate() {
                let turned = node.rotation * lift::<D>(&self.turning[i][j]);
                force += turned + lift::<D>(&self.placed[i][j]).cross(&node.position);
                moment += node.position.cross(&turned);
            }
            let moment = nodes[i].rotation.transpose() * moment;
            [force.x, force.y, force.z, moment.x, moment.y, moment.z]
        };
        (0..N).map(sum).collect()
    }

    /// −∂f/∂(δr, δφ).
    fn tangent(&self, state: &ElementState<N>) -> ElementTangent<N> {
        let mut tangent = zero_tangent::<N>();
        for (j, k) in (0..N).flat_map(|j| (0..6).map(move |k| (j, k))) {
            for (i, row) in self.rows(&state.moved(&unit_increment(j, k))).iter().enumerate() {
                for (l, entry) in row.iter().enumerate() {
                    tangent[i][j][(l, k)] = -entry.eps;
                }
            }
        }
        tangent
    }
}

/// The end of a step, (r*, P*) and u* being given, for accelerations u̇₊ moving as dual numbers.
struct Step<'a, const N: usize> {
    b: f64,
    start: &'a ElementState<N>,
    velocities: &'a [Velocity; N],
    accelerations: &'a [Velocity; N],
}

/// Poses and (u, u̇).
struct End {
    quaternions: Vec<nalgebra::Vector4<Dual64>>,
    nodes: Vec<Frame<Dual64>>,
    velocities: Vec<Pair<Dual64>>,
    accelerations: Vec<Pair<Dual64>>,
}

impl<const N: usize> Step<'_, N> {
    fn end(&self, change: &[Increment; N]) -> End {
        let b = Dual64::from_re(self.b);
        let accelerations: Vec<Pair<Dual64>> = (0..N)
            .map(|i| {
                let u = &self.accelerations[i];
                (
                    u.translation.zip_map(&change[i].translation, Dual64::new),
                    u.rotation.zip_map(&change[i].rotation, Dual64::new),
                )
            })
            .collect();
        let velocities: Vec<Pair<Dual64>> = pairs::<Dual64, N>(self.velocities)
            .into_iter()
            .zip(&accelerations)
            .map(|((v, omega), (dv, spin))| (v + dv * b, omega + spin * b))
            .collect();
        let quaternions: Vec<_> = (0..N)
            .map(|i| turned(&self.start.quaternions[i].map(Dual64::from_re), &(velocities[i].1 * b)))
            .collect();
        let nodes = (0..N)
            .map(|i| Frame {
                position: lift::<Dual64>(&self.start.positions[i]) + velocities[i].0 * b,
                rotation: rotation(&quaternions[i]),
            })
            .collect();
        End { quaternions, nodes, velocities, accelerations }
    }
}

/// ∂R/∂u̇₊ of R = f(q₊) − M u̇₊ − fᵍʸʳ(u₊), through the whole step, against the tangent times (δr, δφ)/b².
fn step_of<const N: usize>(checks: &mut Checks, spacing: NodeSpacing, name: &str) {
    let mut worst = Worst::default();
    for (seed, b) in (240..).zip(STEPS).chain((250..).zip(STEPS)) {
        let mut random = Generator::new(seed);
        let element = Element::<N>::new(spacing, |_| 1.0 + 0.3 * random.number());
        let start = ElementState::new(&element.places, 1.5, seed);
        let velocities: [Velocity; N] = std::array::from_fn(|_| velocity(&mut random));
        // The rotation of a step stays of the size of one, so that Y⁻¹ magnifies no rounding.
        let accelerations: [Velocity; N] = std::array::from_fn(|_| velocity(&mut random))
            .map(|u| Velocity { translation: u.translation / b, rotation: u.rotation / (b * b) });
        let velocities = velocities.map(|u| Velocity { rotation: u.rotation / b, ..u });
        let forces = MadeUp::<N>::new(&mut random);
        let step = Step { b, start: &start, velocities: &velocities, accelerations: &accelerations };
        let end = step.end(&[Increment::default(); N]);
        let state = ElementState::<N> {
            positions: std::array::from_fn(|i| end.nodes[i].position.map(|x| x.re)),
            quaternions: std::array::from_fn(|i| end.quaternions[i].map(|x| x.re)),
        };
        let mut tangent = forces.tangent(&state);
        let now: [Velocity; N] = std::array::from_fn(|i| Velocity {
            translation: end.velocities[i].0.map(|x| x.re),
            rotation: end.velocities[i].1.map(|x| x.re),
        });
        inertia_tangent(
            Plain,
            &element.rule,
            &element.jacobians,
            &element.mass,
            &SECTION,
            &now,
            b,
            &mut tangent,
        );

        let mut blocks: [(Vec<f64>, Vec<f64>); 4] = Default::default();
        for (j, k) in (0..N).flat_map(|j| (0..6).map(move |k| (j, k))) {
            let end = step.end(&unit_increment(j, k));
            let inertia = element.exact(&end.velocities, &end.accelerations);
            let given = forces.rows(&end.nodes);
            let (moved, turned) = (end.nodes[j].position.map(|x| x.eps), body_rate(&end.nodes[j].rotation));
            let change = Vector6::from_iterator(moved.iter().chain(&turned).copied()) / (b * b);
            for i in 0..N {
                let ours = tangent[i][j] * change;
                for l in 0..6 {
                    let (measured, reference) = &mut blocks[2 * (l / 3) + k / 3];
                    measured.push(ours[l]);
                    reference.push(-(inertia[i][l] + given[i][l]).eps);
                }
            }
        }
        for (measured, reference) in blocks {
            worst.compare(measured, reference);
        }
    }
    let quantity = format!("b² K + (M + b D) diag(1, Y⁻¹), {name}, {spacing:?}");
    checks.below(Kind::Invariant, quantity, worst.0, ROUNDING, ROUNDING_REASON);
}
