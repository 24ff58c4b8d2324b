//! Strains and poses of one element with their derivatives, and the fit's residual (21) with its Jacobian.

use cosserat::fit::{twist_from, twist_jacobian};
use cosserat::interpolation::{Interpolation, Pose, R12, Se3};
use cosserat::lagrange::basis;
use cosserat::scene::NodeSpacing;
use nalgebra::{Matrix3, Vector3};
use num_dual::Dual64;

use super::{ROUNDING, ROUNDING_REASON};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{self, Ansatz, Frame, axial, polar, relative_twist};
use crate::states::{ANGLES, ElementState, Generator, Worst, places, unit_increment};
use crate::strains::{strain_derivative, strain_increment};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "derivatives::strains",
            "eq. (6), (7); Log(H₀⁻¹ H₁) of Harsch, Sailer & Eugster 2023",
            |checks| every_degree(checks, &STRAINS),
        ),
        Case::new("derivatives::poses_and_fit", "eq. (6), (20), (21)", |checks| every_degree(checks, &POSES)),
    ]
}

/// A check for every degree and both interpolations.
type Check<const N: usize> = fn(&mut Checks, Ansatz, NodeSpacing, &str) -> Outcome;

struct Family {
    one: Check<2>,
    two: Check<3>,
    three: Check<4>,
    five: Check<6>,
    eight: Check<9>,
    twist: Check<2>,
}

const STRAINS: Family = Family {
    one: strains::<2, R12>,
    two: strains::<3, R12>,
    three: strains::<4, R12>,
    five: strains::<6, R12>,
    eight: strains::<9, R12>,
    twist: strains::<2, Se3>,
};

const POSES: Family = Family {
    one: poses::<2, R12>,
    two: poses::<3, R12>,
    three: poses::<4, R12>,
    five: poses::<6, R12>,
    eight: poses::<9, R12>,
    twist: poses::<2, Se3>,
};

fn every_degree(checks: &mut Checks, family: &Family) -> Outcome {
    for spacing in [NodeSpacing::GaussLobatto, NodeSpacing::Equal] {
        (family.one)(checks, Ansatz::Matrices, spacing, "R12, p = 1")?;
        (family.two)(checks, Ansatz::Matrices, spacing, "R12, p = 2")?;
        (family.three)(checks, Ansatz::Matrices, spacing, "R12, p = 3")?;
        (family.five)(checks, Ansatz::Matrices, spacing, "R12, p = 5")?;
        (family.eight)(checks, Ansatz::Matrices, spacing, "R12, p = 8")?;
        (family.twist)(checks, Ansatz::Twist, spacing, "SE(3)")?;
    }
    Ok(())
}

/// Places in the element: both ends, a node of even degrees, and two others.
const PLACES: [f64; 5] = [0.0, 0.21, 0.5, 0.87, 1.0];

fn strains<const N: usize, I: Interpolation<N>>(
    checks: &mut Checks,
    ansatz: Ansatz,
    spacing: NodeSpacing,
    name: &str,
) -> Outcome {
    let places = places::<N>(spacing);
    let [mut gamma_r, mut gamma_phi, mut kappa_phi, mut value, mut direction] = [Worst::default(); 5];
    for (seed, angle) in (10..).zip(ANGLES) {
        let state = ElementState::new(&places, angle, seed);
        let poses = state.poses();
        for x in PLACES {
            let basis = basis(&places, x, 1.0);
            // Σ|N′| |A| of both sums.
            let scale: f64 = basis.derivative.iter().map(|slope| slope.abs()).sum();
            let d = strain_derivative::<N, I>(&poses, &basis)?;
            let columns = |part: fn(&formulas::Point<Dual64>) -> Vector3<Dual64>, first: usize, j: usize| {
                Matrix3::from_columns(&[0, 1, 2].map(|k| {
                    let nodes = state.moved(&unit_increment::<N>(j, first + k));
                    part(&formulas::point(ansatz, &places, &nodes, x)).map(|x| x.eps)
                }))
            };
            let stack = |blocks: &[Matrix3<f64>; N]| blocks.iter().flatten().copied().collect::<Vec<_>>();
            let exact = |part, first| std::array::from_fn::<_, N, _>(|j| columns(part, first, j));
            gamma_r.compare(stack(&d.gamma_translation), stack(&exact(|p| p.gamma, 0)));
            gamma_phi.compare(stack(&d.gamma_rotation), stack(&exact(|p| p.gamma, 3)));
            kappa_phi.compare(stack(&d.kappa_rotation), stack(&exact(|p| p.kappa, 3)));
            let mut random = Generator::new(seed);
            let increments = std::array::from_fn(|_| random.increment());
            let exact = formulas::point(ansatz, &places, &state.moved(&increments), x);
            let strain = I::strain(&poses, &basis)?;
            for s in [strain, d.strain] {
                value.compare_against(s.gamma.iter().copied(), exact.gamma.iter().map(|x| x.re), scale);
                value.compare_against(s.kappa.iter().copied(), exact.kappa.iter().map(|x| x.re), scale);
                value.compare_against(s.rotation.iter().copied(), exact.rotation.iter().map(|x| x.re), scale);
            }
            let [gamma, kappa] = strain_increment::<N, I>(&poses, &basis, &increments)?;
            direction.compare_against(gamma.iter().copied(), exact.gamma.iter().map(|x| x.eps), scale);
            direction.compare_against(kappa.iter().copied(), exact.kappa.iter().map(|x| x.eps), scale);
        }
    }
    for (quantity, worst) in [
        ("γ̄, κ̄, A", value),
        ("∂γ̄/∂δr", gamma_r),
        ("∂γ̄/∂δφ", gamma_phi),
        ("∂κ̄/∂δφ", kappa_phi),
        ("(δγ̄, δκ̄) along increments", direction),
    ] {
        let quantity = format!("{quantity}, {name}, {spacing:?}");
        checks.below(Kind::Invariant, quantity, worst.0, ROUNDING, ROUNDING_REASON);
    }
    Ok(())
}

/// The interpolated pose: the rotation nearest to eq. (6), which is its own where there is one already.
fn pose(ansatz: Ansatz, places: &[f64], nodes: &[Frame<Dual64>], x: f64) -> Frame<Dual64> {
    let point = formulas::point(ansatz, places, nodes, x);
    Frame {
        position: point.position,
        rotation: match ansatz {
            Ansatz::Matrices => polar(&point.rotation),
            Ansatz::Twist => point.rotation,
        },
    }
}

/// Errors of the interpolated pose and of the fit's residual.
#[derive(Default)]
struct PoseErrors {
    pose: Worst,
    derivative: Worst,
    residual: Worst,
    jacobian: Worst,
}

fn poses<const N: usize, I: Interpolation<N>>(
    checks: &mut Checks,
    ansatz: Ansatz,
    spacing: NodeSpacing,
    name: &str,
) -> Outcome {
    let places = places::<N>(spacing);
    let mut errors = PoseErrors::default();
    // From about 2 rad on the interpolated matrices come near to singular ones, where no rotation is nearest.
    let usable = |angle: f64| angle < 1.5 || matches!(ansatz, Ansatz::Twist);
    for (seed, angle) in (30..).zip(ANGLES).filter(|(_, angle)| usable(*angle)) {
        let state = ElementState::new(&places, angle, seed);
        let mut random = Generator::new(seed);
        for x in PLACES {
            compare_pose::<N, I>(&mut errors, ansatz, (&places, x), &state, &mut random)?;
        }
    }
    for (quantity, worst) in [
        ("pose", errors.pose),
        ("∂pose/∂(δr, δφ)", errors.derivative),
        ("Log(H_j⁻¹ H)", errors.residual),
        ("∂Log(H_j⁻¹ H)/∂(δr, δφ)", errors.jacobian),
    ] {
        let quantity = format!("{quantity}, {name}, {spacing:?}");
        checks.below(Kind::Invariant, quantity, worst.0, ROUNDING, ROUNDING_REASON);
    }
    Ok(())
}

/// The pose at x, its derivative, and those of its twist from a target that is about 1.2 rad away.
fn compare_pose<const N: usize, I: Interpolation<N>>(
    errors: &mut PoseErrors,
    ansatz: Ansatz,
    (places, x): (&[f64; N], f64),
    state: &ElementState<N>,
    random: &mut Generator,
) -> Outcome {
    let (nodes, basis) = (state.poses(), basis(places, x, 1.0));
    let d = I::pose_derivative(&nodes, &basis)?;
    let plain = I::pose(&nodes, &basis)?;
    let target = Pose {
        position: d.pose.position + random.vector(),
        rotation: d.pose.rotation * formulas::exp(&(1.2 * random.axis())),
    };
    let twist = twist_from(&target, &d.pose).ok_or("no logarithm")?;
    let fixed = Frame {
        position: target.position.map(Dual64::from_re),
        rotation: target.rotation.map(Dual64::from_re),
    };
    for (j, k) in (0..N).flat_map(|j| (0..6).map(move |k| (j, k))) {
        let exact = pose(ansatz, places, &state.moved(&unit_increment::<N>(j, k)), x);
        for p in [plain, d.pose] {
            let ours = p.position.iter().chain(p.rotation.iter()).copied();
            let exact = exact.position.iter().chain(exact.rotation.iter()).map(|x| x.re);
            errors.pose.compare_against(ours, exact, 1.0);
        }
        let (position, rotation) = if k < 3 {
            (d.position_translation[j].column(k).into_owned(), Vector3::zeros())
        } else {
            (
                d.position_rotation[j].column(k - 3).into_owned(),
                d.rotation_rotation[j].column(k - 3).into_owned(),
            )
        };
        let spin = axial(&(exact.rotation.map(|x| Dual64::from_re(x.re)).transpose() * exact.rotation));
        errors.derivative.compare_against(
            position.iter().chain(rotation.iter()).copied(),
            exact.position.iter().chain(spin.iter()).map(|x| x.eps),
            1.0,
        );
        let theta = relative_twist(&fixed, &exact);
        errors.residual.compare_against(
            [twist.translation, twist.rotation].iter().flatten().copied(),
            theta.iter().flatten().map(|x| x.re),
            1.0,
        );
        errors.jacobian.compare_against(
            twist_jacobian(&twist, &d, j).column(k).iter().copied(),
            theta.iter().flatten().map(|x| x.eps),
            1.0,
        );
    }
    Ok(())
}
