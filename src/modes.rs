//! Small vibrations about a static equilibrium: (K − ω² M) x = 0 on the motions that the joints allow, undamped.
//!
//! The tangent K is unsymmetric (Petrov–Galerkin), so that ω² may be complex where two frequencies come close; the
//! imaginary part vanishes with the mesh and is reported where it is not negligible.
//!
//! The pairs with the lowest |ω² + 1/b²| are those with the largest θ of
//!
//! ```text
//! ⎡M + b² K  −Gᵀ⎤ ⎡y⎤   ⎡M x⎤
//! ⎣G          0 ⎦ ⎣μ⎦ = ⎣ 0 ⎦ ,   y = θ x   ⇔   K x = ω² M x + Gᵀ λ, G x = 0,   θ = 1/(1 + b² ω²)
//! ```
//!
//! whose matrix is that of a time step with b; a rigid motion has θ = 1 and does not make it singular. A block Krylov
//! space of the operator, orthonormal in M, holds modes of any multiplicity up to the size of the block: round rods
//! vibrate alike in every plane.

mod krylov;

use nalgebra::Vector3;

use crate::assembly::{LoadLevel, Motion, Workspace};
use crate::inertia::Velocity;
use crate::interpolation::Increment;
use crate::linear_solver::NODE;
use crate::model::free_motion::free_motions;
use crate::model::{Model, ProbedPart};
use crate::recorder::Recorder;
use crate::rod::StepVelocity;
use crate::scene::{Coordinates, Modes, Statics};
use crate::solution::{Mode, Solution, SolveError, SolveFailure, Statistics, StopReason};
use crate::state::State;
use crate::statics;
use krylov::{Operator, Pair};

/// θ is known to rounding; ω² = (1/θ − 1)/b² is, relative to itself, if b² ω² of the lowest mode that is no rigid
/// motion lies within this and its inverse.
const WELL_SCALED: f64 = 1e-4;
/// Least b² ω² of an unstable mode: the shift is at −1.
const BELOW: f64 = -0.8;
/// Times that b is chosen again.
const ATTEMPTS: usize = 12;
/// A pair whose Im ω² is larger, relative to |ω²|, is reported.
const COMPLEX: f64 = 1e-8;

/// Solves for the static equilibrium, if anything is loaded, and for the modes about it.
///
/// # Errors
/// [`SolveFailure`] if there is no equilibrium, or no frequencies are found.
pub fn solve(
    model: &Model,
    options: &Modes,
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Solution, Box<SolveFailure>> {
    let (mut solution, state) = if model.loaded() {
        statics::equilibrium(model, &Statics::default(), progress)?
    } else {
        undeformed(model)?
    };
    match frequencies(model, &state, options.count, &mut solution) {
        Ok(modes) => {
            solution.modes = modes;
            Ok(solution)
        }
        Err(reason) => Err(Box::new(SolveFailure { error: SolveError::Modes { reason }, partial: solution })),
    }
}

/// The reference as a solution without increments.
fn undeformed(model: &Model) -> Result<(Solution, State), Box<SolveFailure>> {
    let (mut recorder, mut work) = (Recorder::new(model, 1.0), Workspace::new(model, Coordinates::default()));
    let state = model.reference.clone();
    let recorded =
        work.evaluate(model, &state, &LEVEL, None).and_then(|()| recorder.record(model, 0.0, &state, &work));
    let solution = recorder.finish(model, &state, Statistics::default());
    match recorded {
        Ok(()) => Ok((solution, state)),
        Err(reason) => Err(Box::new(SolveFailure { error: SolveError::Modes { reason }, partial: solution })),
    }
}

/// The whole load.
const LEVEL: LoadLevel = LoadLevel { load_factor: 1.0, preload: 1.0 };

fn frequencies(
    model: &Model,
    state: &State,
    count: usize,
    solution: &mut Solution,
) -> Result<Vec<Mode>, StopReason> {
    let mut operator = ShiftInvert::new(model, state)?;
    // Motions without stiffness are known exactly; a loaded model has none, or it would have no equilibrium.
    let free =
        if model.loaded() { Vec::new() } else { free_motions(model).map_err(|_| StopReason::Singular)? };
    let mut b = natural_time(model);
    let mut found: Option<(f64, Vec<Pair>)> = None;
    for attempt in 1.. {
        solution.statistics.factorizations += 1;
        let wanted = count.saturating_sub(free.len()).max(1);
        let searched = operator.factorize(b).and_then(|()| krylov::largest(&mut operator, &free, wanted));
        let pairs = match (searched, found.take()) {
            (Ok(pairs), _) => pairs,
            // Another b would only have made them more precise.
            (Err(_), Some((b, pairs))) => {
                return Ok(report(model, state, b, (&free, &pairs), count, solution));
            }
            (Err(reason), None) => return Err(reason),
        };
        // Of an unstable equilibrium all modes are found in order only if the shift −1/b² lies below the lowest ω².
        let most_negative = pairs.iter().map(|pair| pair.stiffness().re).fold(0.0, f64::min);
        let lowest = pairs.iter().map(|pair| pair.stiffness().norm()).reduce(f64::min).filter(|x| *x > 0.0);
        let well_scaled = if most_negative < 0.0 {
            most_negative > BELOW
        } else {
            lowest.is_none_or(|x| (WELL_SCALED..1.0 / WELL_SCALED).contains(&x))
        };
        if attempt == ATTEMPTS || well_scaled {
            return Ok(report(model, state, b, (&free, &pairs), count, solution));
        }
        let factor = if most_negative < 0.0 {
            (0.5 * BELOW / most_negative).sqrt()
        } else {
            lowest.map_or(1.0, |x| 1.0 / x.sqrt())
        };
        found = Some((b, pairs));
        b *= factor;
    }
    Ok(Vec::new())
}

/// 1/ω of a bending rod, up to a factor: (m L³/EI)^½ with all of the mass; of a pendulum without rods (L/g)^½.
fn natural_time(model: &Model) -> f64 {
    let bodies: f64 = model.bodies.iter().map(|body| body.mass.mass).sum();
    let of_rod = |rod: &crate::model::RodModel| {
        let own = rod.properties.inertia.as_ref().map_or(0.0, |inertia| inertia.section.mass_per_length);
        let stiffness = rod.properties.stiffness.moment.min();
        ((own * rod.length + bodies) * rod.length.powi(3) / stiffness).sqrt()
    };
    let pendulum = (model.size / model.gravity.norm()).sqrt();
    let time = model.rods.iter().map(of_rod).reduce(f64::max).unwrap_or(pendulum);
    if time.is_normal() { time } else { 1.0 }
}

fn report(
    model: &Model,
    state: &State,
    b: f64,
    (free, pairs): (&[Vec<f64>], &[Pair]),
    count: usize,
    solution: &mut Solution,
) -> Vec<Mode> {
    let found = free.len() + pairs.len();
    if found < count {
        solution
            .warnings
            .push(format!("there are only {found} modes: nothing else that can move has inertia"));
    }
    let free = free.iter().map(|vector| Mode { angular_frequency: 0.0, shape: shape(model, state, vector) });
    let mut modes: Vec<Mode> = free.take(count).collect();
    let mut unstable = Vec::new();
    for pair in pairs.iter().take(count - modes.len()) {
        let index = modes.len();
        let scaled = pair.stiffness();
        let (real, imaginary) = (scaled.re, scaled.im);
        let is_complex = imaginary.abs() > COMPLEX * scaled.norm();
        if is_complex && imaginary > 0.0 {
            solution.warnings.push(format!(
                "modes {} and {} have complex frequencies, ω² = {:.6e} (1 ± {:.1e} i) rad²/s²: the \
                 discretisation's, they turn real as the mesh is refined",
                index + 1,
                index + 2,
                real / (b * b),
                imaginary / real.abs()
            ));
        }
        if real < 0.0 && !is_complex {
            unstable.push((index + 1).to_string());
        }
        let angular_frequency = real.abs().sqrt().copysign(real) / b;
        modes.push(Mode { angular_frequency, shape: shape(model, state, &pair.vector) });
    }
    if !unstable.is_empty() {
        // An unstressed rod is stable: without loads this is the mesh's.
        let why = if model.loaded() {
            "the equilibrium is unstable"
        } else {
            "nothing is loaded, so the mesh is too coarse, use more elements"
        };
        let fastest = modes.iter().map(|mode| -mode.angular_frequency).fold(0.0, f64::max);
        solution.warnings.push(format!(
            "ω² < 0 for mode {}: {why}; the frequency is given as negative, and the fastest grows as \
             exp({fastest:.6e} t/s)",
            unstable.join(", ")
        ));
    }
    modes
}

/// (δr, δφ) at the probes, inertial, scaled such that the largest number is 1.
fn shape(model: &Model, state: &State, vector: &[f64]) -> Vec<[f64; 6]> {
    let increments: Vec<Increment> = vector.chunks_exact(NODE).map(crate::fit::increment_of).collect();
    let mut shape: Vec<[f64; 6]> = model
        .probes
        .iter()
        .map(|probe| {
            let (rotation, Increment { translation, rotation: turn }) = match probe.on {
                ProbedPart::Body(body) => {
                    let node = model.bodies[body].node;
                    (state.poses()[node].rotation, increments[node])
                }
                ProbedPart::Rod { rod, xi } => {
                    let rod = &model.rods[rod];
                    let (poses, own) = (&state.poses()[rod.range.clone()], &increments[rod.range.clone()]);
                    // A state that was recorded has a pose everywhere.
                    let Ok(found) = rod.kernel.pose_increment(poses, own, xi) else { return [0.0; 6] };
                    found
                }
            };
            let displacement: Vector3<f64> = translation + rotation * turn.cross(&probe.offset);
            let turn = rotation * turn;
            [displacement.x, displacement.y, displacement.z, turn.x, turn.y, turn.z]
        })
        .collect();
    let largest = shape.iter().flatten().fold(0.0_f64, |a, &x| if x.abs() > a.abs() { x } else { a });
    if largest != 0.0 {
        shape.iter_mut().flatten().for_each(|x| *x /= largest);
    }
    shape
}

/// x ↦ (M + b² K)⁻¹ M x on the motions that the joints allow.
struct ShiftInvert<'a> {
    model: &'a Model,
    state: &'a State,
    work: Workspace,
    motion: Motion,
    right: Vec<f64>,
}

impl<'a> ShiftInvert<'a> {
    fn new(model: &'a Model, state: &'a State) -> Result<Self, StopReason> {
        let nodes = state.poses().len();
        let still = vec![Velocity::default(); nodes];
        let mut work = Workspace::new(model, Coordinates::default());
        work.evaluate(model, state, &LEVEL, None)?;
        work.reset_stresses();
        Ok(Self {
            model,
            state,
            work,
            motion: Motion { velocities: still.clone(), accelerations: still },
            right: vec![0.0; NODE * nodes + state.multipliers().len()],
        })
    }

    fn factorize(&mut self, b: f64) -> Result<(), StopReason> {
        // Products with M have used the memory of the forces.
        self.work.evaluate(self.model, self.state, &LEVEL, None)?;
        let step = StepVelocity { velocities: &self.motion.velocities, b };
        self.work.factorize(self.model, self.state, &LEVEL, Some(&step))
    }
}

impl Operator for ShiftInvert<'_> {
    fn size(&self) -> usize {
        NODE * self.state.poses().len()
    }

    fn mass(&mut self, x: &[f64]) -> Vec<f64> {
        for (rate, x) in self.motion.accelerations.iter_mut().zip(x.chunks_exact(NODE)) {
            rate.translation = Vector3::from_column_slice(&x[..3]);
            rate.rotation = Vector3::from_column_slice(&x[3..]);
        }
        self.work.inertia_forces(self.model, &self.motion);
        let forces = self.work.forces.force.iter().zip(&self.work.forces.moment);
        let mut product: Vec<f64> = forces.flat_map(|(f, m)| [-f.x, -f.y, -f.z, -m.x, -m.y, -m.z]).collect();
        for rod in &self.model.rods {
            for support in &rod.supports {
                product[NODE * (rod.range.start + support.node)..][..NODE].fill(0.0);
            }
        }
        product
    }

    fn solve(&mut self, mass_times_x: &[f64]) -> Result<Vec<f64>, StopReason> {
        self.right.fill(0.0);
        self.right[..mass_times_x.len()].copy_from_slice(mass_times_x);
        self.work.solve_right(self.model, &mut self.right)?;
        Ok(self.right[..mass_times_x.len()].to_vec())
    }
}
