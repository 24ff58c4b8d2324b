//! The fit (21): nodes such that the rod meets given poses best in the metric of relative twists.
//!
//! K(q) = ½ Σ_j ‖θ_j‖², θ_j = Log(H_j⁻¹ H(ξ_j)), by Levenberg–Marquardt. H(ξ) is the interpolated pose with its
//! rotation projected to SO(3), where the logarithm is defined. ∂θ = J_r⁻¹(θ) (Aᵀ δr, δφ); a sample touches the
//! nodes of one element only, so the normal equations are a chain. Nodal quaternions move by the exponential and
//! keep their unit norm: what (21) does not determine, the norm, is no unknown.

use std::fmt::Debug;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use thiserror::Error;

use crate::element::{ElementTangent, zero_tangent};
use crate::interpolation::{HalfTurn, Increment, Interpolation, Pose, PoseDerivative};
use crate::lanes::Plain;
use crate::linear_solver::{Chain, NODE};
use crate::rod::Elements;
use crate::rotation::{Twist, log_se3, right_jacobian_inverse_se3};
use crate::state::State;

/// How the fit went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitReport {
    /// Accepted and rejected steps.
    pub iterations: usize,
    /// √(mean ‖θ_j‖²) in the mixed metric of twists [m, rad].
    pub residual: f64,
}

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FitError {
    /// An element cannot follow the given poses.
    #[error("element {0} cannot follow poses that are half a turn away from it")]
    HalfTurn(usize),
    /// No minimum found.
    #[error("no minimum after {iterations} iterations; the last relative step is {step:.1e}")]
    NotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Largest component of the last step [m, rad].
        step: f64,
    },
}

/// A step below this fraction of the rod's size (and of a radian) ends the fit.
const STEP_TOLERANCE: f64 = 1e-12;
const MAX_ITERATIONS: usize = 100;

/// θ = Log(H_target⁻¹ H).
pub fn twist_from(target: &Pose, pose: &Pose) -> Option<Twist> {
    let back = target.rotation.transpose();
    log_se3(&(back * pose.rotation), &(back * (pose.position - target.position)))
}

/// The 6×6 derivative of θ with respect to (δr, δφ) of node i.
pub fn twist_jacobian<const N: usize>(twist: &Twist, d: &PoseDerivative<N>, i: usize) -> Matrix6<f64> {
    let map = right_jacobian_inverse_se3(twist);
    let back = d.pose.rotation.transpose();
    let translation = map.diagonal * back * d.position_translation[i];
    let rotation = map.diagonal * (back * d.position_rotation[i]) + map.coupling * d.rotation_rotation[i];
    let mut result = Matrix6::zeros();
    result.fixed_view_mut::<3, 3>(0, 0).copy_from(&translation);
    result.fixed_view_mut::<3, 3>(0, 3).copy_from(&rotation);
    result.fixed_view_mut::<3, 3>(3, 0).copy_from(&Matrix3::zeros());
    result.fixed_view_mut::<3, 3>(3, 3).copy_from(&(map.diagonal * d.rotation_rotation[i]));
    result
}

/// The samples of every element, with their local coordinate.
struct Samples<'a, const N: usize, I> {
    elements: &'a Elements<N, I>,
    targets: &'a [Pose],
}

impl<const N: usize, I> Samples<'_, N, I>
where
    I: Interpolation<N> + Debug + Send + Sync + 'static,
{
    /// Visits (element, local coordinate, target) in order.
    fn visit(&self, mut each: impl FnMut(usize, f64, &Pose) -> Result<(), HalfTurn>) -> Result<(), FitError> {
        for (j, target) in self.targets.iter().enumerate() {
            let (e, x) = self.elements.locate(j as f64 / (self.targets.len() - 1) as f64);
            each(e, x, target).map_err(|_| FitError::HalfTurn(e))?;
        }
        Ok(())
    }

    fn nodes<'b>(&self, e: usize, state: &'b State) -> Result<&'b [Pose; N], HalfTurn> {
        state.poses()[e * (N - 1)..].first_chunk().ok_or(HalfTurn)
    }

    /// K(q).
    fn cost(&self, state: &State) -> Result<f64, FitError> {
        let mut cost = 0.0;
        self.visit(|e, x, target| {
            let pose = I::pose(self.nodes(e, state)?, &self.elements.basis_at(x))?;
            let twist = twist_from(target, &pose).ok_or(HalfTurn)?;
            cost += 0.5 * (twist.translation.norm_squared() + twist.rotation.norm_squared());
            Ok(())
        })?;
        Ok(cost)
    }

    /// Jᵀ J by elements and −Jᵀ θ by nodes.
    fn normal_equations(
        &self,
        state: &State,
        matrices: &mut [ElementTangent<N>],
        gradient: &mut [f64],
    ) -> Result<(), FitError> {
        matrices.fill(zero_tangent());
        gradient.fill(0.0);
        self.visit(|e, x, target| {
            let d = I::pose_derivative(self.nodes(e, state)?, &self.elements.basis_at(x))?;
            let twist = twist_from(target, &d.pose).ok_or(HalfTurn)?;
            let (v, w) = (twist.translation, twist.rotation);
            let theta = Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z);
            let jacobians: [Matrix6<f64>; N] = std::array::from_fn(|i| twist_jacobian(&twist, &d, i));
            for i in 0..N {
                let part = jacobians[i].tr_mul(&theta);
                for (sum, part) in gradient[(e * (N - 1) + i) * NODE..].iter_mut().zip(part.iter()) {
                    *sum -= part;
                }
                for j in 0..N {
                    matrices[e][i][j] += jacobians[i].tr_mul(&jacobians[j]);
                }
            }
            Ok(())
        })
    }
}

/// Moves the nodes to the minimum of K from where they are.
pub fn fit<const N: usize, I>(
    elements: &Elements<N, I>,
    state: &mut State,
    targets: &[Pose],
) -> Result<FitReport, FitError>
where
    I: Interpolation<N> + Debug + Send + Sync + 'static,
{
    let samples = Samples { elements, targets };
    let count = elements.count();
    let size = targets.iter().map(|pose| (pose.position - targets[0].position).norm()).fold(0.0, f64::max);
    let mut chain = Chain::new(count, N - 1, &[], size / count as f64);
    let mut matrices = vec![zero_tangent::<N>(); count];
    let mut gradient = vec![0.0; NODE * state.poses().len()];
    let mut cost = samples.cost(state)?;
    let mut damping = 1e-6;
    let mut step = f64::INFINITY;
    for iteration in 0..MAX_ITERATIONS {
        samples.normal_equations(state, &mut matrices, &mut gradient)?;
        // More damping until the cost does not rise; a cost at its rounding floor may rise by as little.
        loop {
            let mut increment = gradient.clone();
            let solved = damped_solve(&mut chain, &matrices, damping, &mut increment);
            let trial = solved.map(|()| moved(state, &increment));
            let trial_cost = trial.as_ref().and_then(|trial| samples.cost(trial).ok());
            if let (Some(trial), Some(trial_cost)) = (trial, trial_cost)
                && trial_cost <= cost * (1.0 + 1e-12) + f64::MIN_POSITIVE
            {
                *state = trial;
                cost = trial_cost;
                damping *= 0.1;
                step = relative_size(&increment, size);
                break;
            }
            damping *= 10.0;
            if damping > 1e12 {
                return Err(FitError::NotConverged { iterations: iteration + 1, step });
            }
        }
        if step <= STEP_TOLERANCE {
            state.normalize();
            let residual = (2.0 * cost / targets.len() as f64).sqrt();
            return Ok(FitReport { iterations: iteration + 1, residual });
        }
    }
    Err(FitError::NotConverged { iterations: MAX_ITERATIONS, step })
}

/// (Jᵀ J + μ diag(Jᵀ J)) δq = −Jᵀ θ; a node no sample touches would have an empty diagonal, hence `None`.
fn damped_solve<const N: usize>(
    chain: &mut Chain,
    matrices: &[ElementTangent<N>],
    damping: f64,
    increment: &mut [f64],
) -> Option<()> {
    for step in 0..matrices.len() {
        let mut damped = matrices[chain.element(step)];
        for (i, row) in damped.iter_mut().enumerate() {
            for k in 0..NODE {
                row[i][(k, k)] *= 1.0 + damping;
            }
        }
        chain.add_element(Plain, step, &damped).ok()?;
    }
    chain.factorize().ok()?;
    chain.solve(increment);
    increment.iter().all(|x| x.is_finite()).then_some(())
}

fn moved(state: &State, increment: &[f64]) -> State {
    let mut trial = state.clone();
    for (node, part) in increment.chunks_exact(NODE).enumerate() {
        trial.add(node, &increment_of(part));
    }
    trial
}

/// Six entries as (δr, δφ).
pub fn increment_of(part: &[f64]) -> Increment {
    Increment {
        translation: Vector3::new(part[0], part[1], part[2]),
        rotation: Vector3::new(part[3], part[4], part[5]),
    }
}

/// The largest δr over the rod's size or δφ.
fn relative_size(increment: &[f64], size: f64) -> f64 {
    increment.chunks_exact(NODE).fold(0.0, |largest, part| {
        let part = increment_of(part);
        largest.max(part.translation.amax() / size).max(part.rotation.amax())
    })
}
