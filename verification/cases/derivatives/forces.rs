//! Stress resultants and internal forces of one element, and their tangents.

use cosserat::element::{ElementForce, ElementTangent, ReferencePoint, Stiffness, Stress, zero_tangent};
use cosserat::interpolation::{Increment, Interpolation, R12, Se3};
use cosserat::lagrange::basis_at_rule;
use cosserat::lanes::Plain;
use cosserat::quadrature::gauss_legendre;
use cosserat::scene::NodeSpacing;
use nalgebra::Vector3;
use num_dual::Dual64;

use super::{ROUNDING, ROUNDING_REASON};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{self, Ansatz, Pair, Point, Rows, lift};
use crate::one_element::{advance_stress, internal_force, internal_tangent};
use crate::states::{ANGLES, ElementState, Generator, Worst, places, unit_increment};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("derivatives::stress_from_energy", "eq. (18): n = ∂W/∂γ, m = ∂W/∂κ", stress_from_energy),
        Case::new("derivatives::internal_force", "eq. (11)", internal_forces),
    ]
}

/// Six different stiffnesses, within a factor of six.
pub const STIFFNESS: Stiffness =
    Stiffness { force: Vector3::new(3.0, 1.1, 1.7), moment: Vector3::new(0.6, 0.9, 1.4) };

/// Something to be strained from.
pub fn reference_point(random: &mut Generator) -> ReferencePoint {
    ReferencePoint {
        jacobian: 1.0 + 0.3 * random.number(),
        gamma: Vector3::x() + 0.2 * random.vector(),
        kappa: 0.5 * random.vector(),
    }
}

/// W, eq. (18), at strains per element coordinate.
fn energy_density<D: formulas::Number>(
    gamma: &Vector3<D>,
    kappa: &Vector3<D>,
    reference: &ReferencePoint,
) -> D {
    let mut sum = D::from(0.0);
    for k in 0..3 {
        let stretch = gamma[k] / reference.jacobian - reference.gamma[k];
        let curvature = kappa[k] / reference.jacobian - reference.kappa[k];
        sum += stretch.powi(2) * (0.5 * STIFFNESS.force[k]) + curvature.powi(2) * (0.5 * STIFFNESS.moment[k]);
    }
    sum
}

fn stress_from_energy(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(50);
    let mut worst = Worst::default();
    for _ in 0..100 {
        let reference = reference_point(&mut random);
        let (gamma, kappa) = (random.vector(), random.vector());
        let stress = STIFFNESS.stress(&gamma, &kappa, &reference);
        // ∂W/∂γ = J ∂W/∂γ̄.
        let gradient = |k: usize| {
            let seed = |v: &Vector3<f64>, first: usize| {
                Vector3::from_fn(|i, _| Dual64::new(v[i], f64::from(u8::from(first + i == k))))
            };
            energy_density(&seed(&gamma, 0), &seed(&kappa, 3), &reference).eps * reference.jacobian
        };
        let measured = [stress.force, stress.moment];
        worst.compare(measured.iter().flatten().copied(), (0..6).map(gradient));
    }
    let reason = "20 ε: three operations on either side, strains that cancel to no less than a fifth";
    checks.below(Kind::Invariant, "(n, m) against ∂W", worst.0, 5e-15, reason);
    Ok(())
}

/// n = K_γ (γ − γ⁰), m = K_κ (κ − κ⁰) at every point.
pub fn stresses(points: &[Point<Dual64>], reference: &[ReferencePoint]) -> Vec<Pair<Dual64>> {
    let law = |strain: &Vector3<Dual64>, at_rest: &Vector3<f64>, jacobian: f64, stiffness: &Vector3<f64>| {
        (strain / Dual64::from_re(jacobian) - lift(at_rest)).component_mul(&lift(stiffness))
    };
    points
        .iter()
        .zip(reference)
        .map(|(point, r)| {
            (
                law(&point.gamma, &r.gamma, r.jacobian, &STIFFNESS.force),
                law(&point.kappa, &r.kappa, r.jacobian, &STIFFNESS.moment),
            )
        })
        .collect()
}

/// The four kinds of blocks of a tangent: each has its own unit, and is held against its own largest entry.
pub fn compare_blocks<const N: usize>(
    worst: &mut Worst,
    tangent: &ElementTangent<N>,
    exact: impl Fn([Increment; N]) -> Rows<Dual64>,
) {
    let mut blocks: [(Vec<f64>, Vec<f64>); 4] = Default::default();
    for (j, k) in (0..N).flat_map(|j| (0..6).map(move |k| (j, k))) {
        for (i, row) in exact(unit_increment(j, k)).iter().enumerate() {
            for (l, entry) in row.iter().enumerate() {
                let (measured, reference) = &mut blocks[2 * (l / 3) + k / 3];
                measured.push(tangent[i][j][(l, k)]);
                reference.push(-entry.eps);
            }
        }
    }
    for (measured, reference) in blocks {
        if reference.iter().any(|x| *x != 0.0) {
            worst.compare(measured, reference);
        } else {
            worst.compare_against(measured, reference, 1.0);
        }
    }
}

/// The rows of the library against the exact ones.
pub fn compare_rows<const N: usize>(worst: &mut Worst, force: &ElementForce<N>, exact: &Rows<Dual64>) {
    let list = |part: &[Vector3<f64>; N]| part.iter().flatten().copied().collect::<Vec<_>>();
    let rows = |range: std::ops::Range<usize>| {
        let of = |row: &[Dual64; 6]| row[range.clone()].iter().map(|x| x.re).collect::<Vec<_>>();
        exact.iter().flat_map(of).collect::<Vec<_>>()
    };
    // Nothing in a row has the scale one.
    let largest = |scale: &[f64; N]| match scale.iter().copied().fold(0.0, f64::max) {
        0.0 => 1.0,
        largest => largest,
    };
    worst.compare_against(list(&force.force), rows(0..3), largest(&force.force_scale));
    worst.compare_against(list(&force.moment), rows(3..6), largest(&force.moment_scale));
}

/// Sums of absolute contributions, from the rows that one quadrature point alone makes.
pub struct Scales<const N: usize> {
    pub force: [f64; N],
    pub moment: [f64; N],
}

impl<const N: usize> Default for Scales<N> {
    fn default() -> Self {
        Self { force: [0.0; N], moment: [0.0; N] }
    }
}

/// Components `first`… of row i.
pub fn half(rows: &Rows<Dual64>, i: usize, first: usize) -> Vector3<f64> {
    Vector3::from_fn(|k, _| rows[i][first + k].re)
}

impl<const N: usize> Scales<N> {
    /// The moment rows have two contributions: −N′ m along m, and N (γ̄ × n + κ̄ × m), whose second part is normal to m.
    fn add(&mut self, rows: &impl Fn(Pair<Dual64>) -> Rows<Dual64>, (n, m): &Pair<Dual64>) {
        let zero = lift(&Vector3::zeros());
        let (by_force, by_moment) = (rows((*n, zero)), rows((zero, *m)));
        let along = m.map(|x| x.re).normalize();
        for i in 0..N {
            let turned = half(&by_moment, i, 3);
            let slope = along * along.dot(&turned);
            self.force[i] += half(&by_force, i, 0).norm();
            self.moment[i] += slope.norm() + (half(&by_force, i, 3) + turned - slope).norm();
        }
    }

    pub fn compare(&self, worst: &mut Worst, force: &ElementForce<N>) {
        for (measured, exact) in [(force.force_scale, self.force), (force.moment_scale, self.moment)] {
            let largest = exact.into_iter().fold(0.0, f64::max);
            worst.compare_against(measured, exact, if largest > 0.0 { largest } else { 1.0 });
        }
    }
}

fn internal_forces(checks: &mut Checks) -> Outcome {
    for spacing in [NodeSpacing::GaussLobatto, NodeSpacing::Equal] {
        internal::<2, R12>(checks, Ansatz::Matrices, spacing, "R12, p = 1")?;
        internal::<3, R12>(checks, Ansatz::Matrices, spacing, "R12, p = 2")?;
        internal::<4, R12>(checks, Ansatz::Matrices, spacing, "R12, p = 3")?;
        internal::<6, R12>(checks, Ansatz::Matrices, spacing, "R12, p = 5")?;
        internal::<9, R12>(checks, Ansatz::Matrices, spacing, "R12, p = 8")?;
    }
    internal::<2, Se3>(checks, Ansatz::Twist, NodeSpacing::Equal, "SE(3)")
}

/// Errors of the internal force.
#[derive(Default)]
struct InternalErrors {
    rows: Worst,
    scales: Worst,
    plain: Worst,
    mixed: Worst,
    advanced: Worst,
}

fn internal<const N: usize, I: Interpolation<N>>(
    checks: &mut Checks,
    ansatz: Ansatz,
    spacing: NodeSpacing,
    name: &str,
) -> Outcome {
    let places = places::<N>(spacing);
    let mut errors = InternalErrors::default();
    for (seed, angle) in (60..).zip(ANGLES) {
        let state = ElementState::new(&places, angle, seed);
        compare_internal::<N, I>(&mut errors, ansatz, &places, &state, &mut Generator::new(seed))?;
    }
    for (quantity, worst) in [
        ("fⁱⁿᵗ", errors.rows),
        ("Σ |contribution| to fⁱⁿᵗ", errors.scales),
        ("K at s = ŝ(q)", errors.plain),
        ("K at another s", errors.mixed),
        ("ŝ + C ε′ δq", errors.advanced),
    ] {
        let quantity = format!("{quantity}, {name}, {spacing:?}");
        checks.below(Kind::Invariant, quantity, worst.0, ROUNDING, ROUNDING_REASON);
    }
    Ok(())
}

/// Force, tangent at s = ŝ(q) and at any other s, and the advanced stress of one state.
fn compare_internal<const N: usize, I: Interpolation<N>>(
    errors: &mut InternalErrors,
    ansatz: Ansatz,
    places: &[f64; N],
    state: &ElementState<N>,
    random: &mut Generator,
) -> Outcome {
    let quadrature = gauss_legendre(N - 1);
    let rule = basis_at_rule(places, &quadrature);
    let weighted: Vec<(f64, f64)> = quadrature.points.into_iter().zip(quadrature.weights).collect();
    let poses = state.poses();
    let reference: Vec<_> = rule.iter().map(|_| reference_point(random)).collect();
    let points_of = |increments: &[Increment; N]| -> Vec<Point<Dual64>> {
        let nodes = state.moved(increments);
        let at = |&(x, _): &(f64, f64)| formulas::point(ansatz, places, &nodes, x);
        weighted.iter().map(at).collect()
    };
    let exact =
        |points: &[Point<Dual64>], s: &[Pair<Dual64>]| formulas::internal_force(places, &weighted, points, s);

    let mut constitutive = vec![Stress::default(); rule.len()];
    let mut force = ElementForce::default();
    internal_force::<N, I>(Plain, &poses, &rule, &reference, &STIFFNESS, &mut constitutive, &mut force)?;
    let still = points_of(&[Increment::default(); N]);
    let laws = stresses(&still, &reference);
    compare_rows(&mut errors.rows, &force, &exact(&still, &laws));
    let mut scales = Scales::<N>::default();
    for q in 0..rule.len() {
        let of = |s: Pair<Dual64>| formulas::internal_force(places, &weighted[q..=q], &still[q..=q], &[s]);
        scales.add(&of, &laws[q]);
    }
    scales.compare(&mut errors.scales, &force);

    // s = ŝ(q): the true derivative.
    let mut tangent = zero_tangent::<N>();
    internal_tangent::<N, I>(Plain, &poses, &rule, &reference, &STIFFNESS, &constitutive, &mut tangent)?;
    compare_blocks(&mut errors.plain, &tangent, |increments| {
        let points = points_of(&increments);
        exact(&points, &stresses(&points, &reference))
    });

    // Any s: the derivative of (11) with a stress s + C ε′ δq.
    let mut stress = || Stress { force: random.vector(), moment: random.vector() };
    let mut iterate: Vec<Stress> = rule.iter().map(|_| stress()).collect();
    let mut tangent = zero_tangent::<N>();
    internal_tangent::<N, I>(Plain, &poses, &rule, &reference, &STIFFNESS, &iterate, &mut tangent)?;
    compare_blocks(&mut errors.mixed, &tangent, |increments| {
        let points = points_of(&increments);
        let from = |s: &Vector3<f64>, law: &Vector3<Dual64>| s.zip_map(law, |s, law| Dual64::new(s, law.eps));
        let replaced = stresses(&points, &reference)
            .iter()
            .zip(&iterate)
            .map(|((n, m), s)| (from(&s.force, n), from(&s.moment, m)))
            .collect::<Vec<_>>();
        exact(&points, &replaced)
    });

    let increments = std::array::from_fn(|_| random.increment());
    advance_stress::<N, I>(
        Plain,
        &poses,
        &rule,
        &reference,
        &STIFFNESS,
        &increments,
        &constitutive,
        &mut iterate,
    )?;
    for ((n, m), s) in stresses(&points_of(&increments), &reference).iter().zip(&iterate) {
        for (ours, law) in [(&s.force, n), (&s.moment, m)] {
            let scale = law.map(|x| x.eps).norm() + STIFFNESS.force.x;
            errors.advanced.compare_against(ours.iter().copied(), law.iter().map(|x| x.re + x.eps), scale);
        }
    }
    Ok(())
}
