//! Line loads of one element in both bases, and their tangents.

use cosserat::element::{ElementForce, LineLoad, line_load_force, line_load_tangent, zero_tangent};
use cosserat::interpolation::{Increment, Interpolation, R12, Se3};
use cosserat::lagrange::basis_at_rule;
use cosserat::quadrature::gauss_legendre;
use cosserat::scene::NodeSpacing;
use num_dual::Dual64;

use super::forces::{Scales, compare_blocks, compare_rows, half};
use super::{ROUNDING, ROUNDING_REASON};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{self, Ansatz, Pair, Rows, lift};
use crate::states::{ANGLES, ElementState, Generator, Worst, places};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new("derivatives::line_load", "eq. (12)", line_loads)]
}

fn line_loads(checks: &mut Checks) -> Outcome {
    line::<2, R12>(checks, Ansatz::Matrices, "R12, p = 1")?;
    line::<3, R12>(checks, Ansatz::Matrices, "R12, p = 2")?;
    line::<4, R12>(checks, Ansatz::Matrices, "R12, p = 3")?;
    line::<6, R12>(checks, Ansatz::Matrices, "R12, p = 5")?;
    line::<2, Se3>(checks, Ansatz::Twist, "SE(3)")
}

fn line<const N: usize, I: Interpolation<N>>(checks: &mut Checks, ansatz: Ansatz, name: &str) -> Outcome {
    let places = places::<N>(NodeSpacing::GaussLobatto);
    let quadrature = gauss_legendre((N * N).div_ceil(2));
    let rule = basis_at_rule(&places, &quadrature);
    let weighted: Vec<(f64, f64)> = quadrature.points.into_iter().zip(quadrature.weights).collect();
    let [mut rows, mut scales, mut slopes] = [Worst::default(); 3];
    for (seed, angle) in (80..).zip(ANGLES) {
        let mut random = Generator::new(seed);
        let state = ElementState::new(&places, angle, seed);
        let poses = state.poses();
        let jacobians: Vec<f64> = rule.iter().map(|_| 1.0 + 0.3 * random.number()).collect();
        for load in every_load(&mut random) {
            let pairs = |increments: &[Increment; N]| -> Vec<Pair<Dual64>> {
                let nodes = state.moved(increments);
                let at = |&(x, _): &(f64, f64)| -> Pair<Dual64> {
                    let a = formulas::point(ansatz, &places, &nodes, x).rotation;
                    (
                        lift(&load.force) + a * lift(&load.body_force),
                        lift(&load.body_moment) + a.transpose() * lift(&load.moment),
                    )
                };
                weighted.iter().map(at).collect()
            };
            let exact = |increments: [Increment; N]| -> Rows<Dual64> {
                formulas::external_force(&places, &weighted, &jacobians, &pairs(&increments))
            };
            let mut force = ElementForce::default();
            line_load_force::<N, I>(&poses, &rule, &jacobians, &load, &mut force)?;
            let still = [Increment::default(); N];
            compare_rows(&mut rows, &force, &exact(still));
            let mut absolute = Scales::<N>::default();
            for (q, pair) in pairs(&still).into_iter().enumerate() {
                let (point, jacobian) = (&weighted[q..=q], &jacobians[q..=q]);
                let alone = formulas::external_force(&places, point, jacobian, &[pair]);
                for i in 0..N {
                    absolute.force[i] += half(&alone, i, 0).norm();
                    absolute.moment[i] += half(&alone, i, 3).norm();
                }
            }
            absolute.compare(&mut scales, &force);
            let mut tangent = zero_tangent::<N>();
            line_load_tangent::<N, I>(&poses, &rule, &jacobians, &load, &mut tangent)?;
            compare_blocks(&mut slopes, &tangent, exact);
            // A dead force and a body-fixed moment have no tangent, and are not asked for one.
            let turns = [load.turns(), load.body_force.norm() > 0.0 || load.moment.norm() > 0.0];
            let [measured, expected] = turns.map(|flag| f64::from(u8::from(flag)));
            let reason = "a verdict is exact";
            checks.absolute(Kind::Invariant, "whether a line load turns", (measured, expected), 0.0, reason);
        }
    }
    for (quantity, worst) in [("fᵉˣᵗ", rows), ("Σ |contribution| to fᵉˣᵗ", scales), ("−∂fᵉˣᵗ/∂q", slopes)]
    {
        checks.below(Kind::Invariant, format!("{quantity}, {name}"), worst.0, ROUNDING, ROUNDING_REASON);
    }
    Ok(())
}

/// Each kind alone, and all at once.
fn every_load(random: &mut Generator) -> [LineLoad; 5] {
    let [force, body_force, moment, body_moment] = [(); 4].map(|()| random.vector());
    let none = LineLoad::default();
    [
        LineLoad { force, ..none },
        LineLoad { body_force, ..none },
        LineLoad { moment, ..none },
        LineLoad { body_moment, ..none },
        LineLoad { force, body_force, moment, body_moment },
    ]
}
