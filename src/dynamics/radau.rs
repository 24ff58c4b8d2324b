//! The Radau IIA method with three stages, of order 5 (Hairer & Wanner, Solving Ordinary Differential Equations II,
//! IV.5), for answers that tell the time error from the space error.
//!
//! ```text
//! U_i = u₀ + h Σ a_ij U̇_j     R_i = r₀ + h Σ a_ij V_j     P_i = P₀ + h Σ a_ij Q(P_j) Ω_j     eq. (10)
//! M U̇_i + fᵍʸʳ(U_i) = f(Q_i, t₀ + c_i h) + Gᵀ(Q_i) Λ_i     G(Q_i) U_i = 0
//! ```
//!
//! Unknowns are U̇_i and Λ_i of the three stages i; the step ends at the last one. Joints are imposed on velocities,
//! where the equations have index 2 and the method keeps order 5 in positions and velocities; imposed on positions
//! (index 3) it would lose two (Hairer, Lubich & Roche 1989). What positions then miss, g ≠ 0 of order h⁵ and more, is
//! removed after the step by the smallest change, min δqᵀ M δq with g(q + δq) = 0; velocities, accelerations and
//! multipliers follow as at the start, which gives these, too, order 5: Λ₃ alone has order 3.

mod estimate;
mod secants;
mod system;
mod tableau;

use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector4};

use super::accuracy::Leading;
use super::{Integrator, Moving, level, start};
use crate::assembly::{Blocks, Motion, Workspace};
use crate::inertia::Velocity;
use crate::interpolation::Increment;
use crate::linear_solver::{NODE, Singular};
use crate::model::Model;
use crate::newton::{Converged, Newton, NotConverged};
use crate::rod::StepVelocity;
use crate::rotation::quaternion_product;
use crate::solution::{Statistics, StopReason};
use crate::state::State;
use secants::Secants;
use system::StageSystems;
use tableau::{STAGES, Tableau};

/// Matrices are those of the start of the step; where they are renewed, of the stage nearest to its middle.
const MIDDLE: usize = 1;

/// Matrices are renewed after more than so many iterations with them,
const PATIENCE: usize = 10;

/// where the residual does not fall to this part any more.
const SLOW: f64 = 0.9;

/// An iterate whose residual does not fall to this part any more has reached rounding. The order of the method shows
/// down to what its equations are solved to, so that the user's tolerance is only the least that is asked for.
const STAGNANT: f64 = 0.5;

/// Most parts that a step is done in.
const MOST_PARTS: usize = 64;

/// The method with its memory.
pub struct Radau {
    tableau: Tableau,
    stages: [Stage; STAGES],
    systems: StageSystems,
    blocks: Blocks,
    /// Of the iteration with these matrices, for the unknowns of all stages in a row.
    secants: Secants,
    steps: Vec<f64>,
    /// Diagonal of M, the same for every stage, and nothing for multipliers.
    weights: Vec<f64>,
    /// A of every node where the matrices were built.
    frames: Vec<Matrix3<f64>>,
    /// h of the step before; `None` before the first.
    previous: Option<f64>,
    /// Whether the workspace has to be evaluated at the start of the step again.
    stale: bool,
    most_parts: usize,
    /// r⃜ and 2 P̄ ∘ P⃜ of every node in the last step.
    derivatives: Vec<Velocity>,
}

/// A stage's iterate, or what remains of the step before.
struct Stage {
    /// Q_i and Λ_i.
    state: State,
    /// U_i and U̇_i.
    motion: Motion,
    /// (ρ_i, −c_i), or the increments.
    right: Vec<f64>,
}

impl Radau {
    /// From a consistent start. Steps that are not solved are done in parts, or left to who asked for them.
    pub fn new(start: &Moving, parts: bool) -> Self {
        let systems = StageSystems::new(start.model);
        let size = systems.size();
        let stage =
            || Stage { state: start.state.clone(), motion: start.motion.clone(), right: vec![0.0; size] };
        Self {
            tableau: Tableau::new(),
            stages: [stage(), stage(), stage()],
            systems,
            blocks: Blocks::default(),
            secants: Secants::default(),
            steps: vec![0.0; STAGES * size],
            weights: vec![0.0; STAGES * size],
            frames: start.state.poses().iter().map(|pose| pose.rotation).collect(),
            previous: None,
            stale: false,
            most_parts: if parts { MOST_PARTS } else { 1 },
            derivatives: start.motion.velocities.clone(),
        }
    }

    /// Starting values: U̇ and Λ as the polynomials through the stages of the step before, continued. At first, and
    /// after a step that failed, zero: a stiff rod's acceleration of the moment says little about a whole step.
    fn predict(&mut self, start: &Moving, length: f64) {
        let Some(previous) = self.previous else {
            for stage in &mut self.stages {
                stage.motion.accelerations.fill(Velocity::default());
                stage.state.multipliers_mut().fill(0.0);
            }
            return;
        };
        let factors: [Vector3<f64>; STAGES] =
            std::array::from_fn(|i| self.tableau.interpolate(1.0 + self.tableau.c[i] * length / previous));
        for node in 0..start.motion.accelerations.len() {
            let old = self.stages.each_ref().map(|stage| stage.motion.accelerations[node]);
            for (stage, factors) in self.stages.iter_mut().zip(&factors) {
                stage.motion.accelerations[node] = combine(factors.as_slice(), &old);
            }
        }
        for index in 0..start.state.multipliers().len() {
            let old = Vector3::from(self.stages.each_ref().map(|stage| stage.state.multipliers()[index]));
            for (stage, factors) in self.stages.iter_mut().zip(&factors) {
                stage.state.multipliers_mut()[index] = factors.dot(&old);
            }
        }
    }

    /// Q_i and U_i of all stages from U̇_i.
    fn place(&mut self, start: &Moving, length: f64) -> Result<(), StopReason> {
        let a = self.tableau.a * length;
        for node in 0..start.motion.velocities.len() {
            if self.systems.place(node).is_none() {
                continue;
            }
            let rates = self.stages.each_ref().map(|stage| stage.motion.accelerations[node]);
            let before = &start.motion.velocities[node];
            let velocities: [Velocity; STAGES] = std::array::from_fn(|i| {
                let change = combine(&[a[(i, 0)], a[(i, 1)], a[(i, 2)]], &rates);
                Velocity {
                    translation: before.translation + change.translation,
                    rotation: before.rotation + change.rotation,
                }
            });
            let turns = turns(&a, &velocities.map(|u| u.rotation)).ok_or(StopReason::Singular)?;
            let (position, quaternion) =
                (start.state.poses()[node].position, start.state.quaternions()[node]);
            for (i, stage) in self.stages.iter_mut().enumerate() {
                let change = combine(&[a[(i, 0)], a[(i, 1)], a[(i, 2)]], &velocities);
                stage.motion.velocities[node] = velocities[i];
                stage.state.set_position(node, position + change.translation);
                stage.state.set_quaternion(node, quaternion_product(&quaternion, &turns[i]));
            }
        }
        Ok(())
    }

    /// (ρ_i, −c_i) of all stages; the residual of the worst in the units of the test.
    fn evaluate(
        &mut self,
        moving: &mut Moving,
        before: f64,
        length: f64,
        newton: &Newton,
    ) -> Result<f64, StopReason> {
        let (model, work) = (moving.model, &mut moving.work);
        let mut worst = 0.0_f64;
        for (i, stage) in self.stages.iter_mut().enumerate() {
            let Stage { state, motion, right } = stage;
            work.evaluate(model, state, &level(before + self.tableau.c[i] * length), Some(motion))?;
            for node in 0..state.poses().len() {
                let Some(place) = self.systems.place(node) else { continue };
                right[place..][..3].copy_from_slice(work.forces.force[node].as_slice());
                right[place + 3..][..3].copy_from_slice(work.forces.moment[node].as_slice());
            }
            for (coupling, gap) in model.couplings.iter().zip(&mut work.gaps) {
                let rate = start::gap_rate(coupling, state, &motion.velocities);
                for (k, &row) in coupling.rows.iter().enumerate() {
                    right[self.systems.nodal() + coupling.first + k] = -rate[row];
                }
                // Tested like positions: what the joint would part by within the step.
                *gap = rate * length;
            }
            let step = StepVelocity { velocities: &motion.velocities, b: length };
            let residual = work.residual(model, state, travel(motion, length), Some(&step));
            let residual = newton.test.measure(&residual);
            worst = if residual.is_nan() { residual } else { worst.max(residual) };
            if !worst.is_finite() {
                return Err(StopReason::Singular);
            }
        }
        Ok(worst)
    }

    /// New matrices where the workspace was evaluated last.
    fn factorize(
        &mut self,
        model: &Model,
        work: &mut Workspace,
        (state, motion): (&State, &Motion),
        time: f64,
        length: f64,
    ) -> Result<(), StopReason> {
        for (frame, pose) in self.frames.iter_mut().zip(state.poses()) {
            *frame = pose.rotation;
        }
        work.blocks(model, state, &level(time), &motion.velocities, &mut self.blocks)?;
        self.secants.clear();
        self.weights.fill(0.0);
        for block in self.blocks.nodal.iter().filter(|block| block.nodes[0] == block.nodes[1]) {
            let Some(place) = self.systems.place(block.nodes[0]) else { continue };
            for stage in self.weights.chunks_exact_mut(self.systems.size()) {
                stage[place..].iter_mut().zip(&block.mass).for_each(|(weight, mass)| *weight += mass.abs());
            }
        }
        self.systems
            .factorize(&self.tableau, &self.blocks, &motion.velocities, length)
            .map_err(|Singular| StopReason::Singular)
    }

    /// New matrices at the stage in the middle of the iterate.
    fn refresh(&mut self, moving: &mut Moving, before: f64, length: f64) -> Result<(), StopReason> {
        let time = before + self.tableau.c[MIDDLE] * length;
        let Stage { state, motion, .. } = &self.stages[MIDDLE];
        let (state, motion) = (state.clone(), motion.clone());
        moving.work.evaluate(moving.model, &state, &level(time), Some(&motion))?;
        self.factorize(moving.model, &mut moving.work, (&state, &motion), time, length)
    }

    /// Solves with the last matrices and moves the iterate.
    ///
    /// Forces of a stage, and with them the multipliers and gaps of translation, are turned by R = A Aᵢᵀ from the
    /// node's frame there to its frame A in the matrices: what a rod is stiff against turns with it, and a
    /// stiff force off by a small angle would move it a long way where it is soft.
    fn improve(&mut self, model: &Model) -> Result<(), StopReason> {
        self.turn(model, 1);
        let [first, second, third] = &mut self.stages;
        self.systems
            .solve(&self.tableau, [&mut first.right, &mut second.right, &mut third.right])
            .map_err(|Singular| StopReason::Singular)?;
        self.turn(model, -1);
        let parts = self.steps.chunks_exact_mut(self.systems.size());
        parts.zip(&self.stages).for_each(|(part, stage)| part.copy_from_slice(&stage.right));
        self.secants.accelerate(&mut self.steps, &self.weights);
        let parts = self.steps.chunks_exact(self.systems.size());
        parts.zip(&mut self.stages).for_each(|(part, stage)| stage.right.copy_from_slice(part));
        for Stage { state, motion, right } in &mut self.stages {
            for (node, rate) in motion.accelerations.iter_mut().enumerate() {
                let Some(place) = self.systems.place(node) else { continue };
                rate.translation += Vector3::from_column_slice(&right[place..][..3]);
                rate.rotation += Vector3::from_column_slice(&right[place + 3..][..3]);
            }
            let increments = &right[self.systems.nodal()..];
            state.multipliers_mut().iter_mut().zip(increments).for_each(|(x, increment)| *x += increment);
        }
        Ok(())
    }

    /// Turns forces and gaps into the frames of the matrices, or multipliers back.
    fn turn(&mut self, model: &Model, direction: i32) {
        let nodal = self.systems.nodal();
        for Stage { state, right, .. } in &mut self.stages {
            let turn = |node: usize| self.frames[node] * state.poses()[node].rotation.transpose();
            let apply = |right: &mut [f64], turn: &Matrix3<f64>| {
                let vector = turn * Vector3::from_column_slice(&right[..3]);
                right[..3].copy_from_slice(vector.as_slice());
            };
            for node in (0..self.frames.len()).filter(|_| direction > 0) {
                if let Some(place) = self.systems.place(node) {
                    apply(&mut right[place..], &turn(node));
                }
            }
            for coupling in &model.couplings {
                let Some(node) = coupling.nodes[1].or(coupling.nodes[0]) else { continue };
                if coupling.rows.starts_with(&[0, 1, 2]) {
                    let turn = if direction > 0 { turn(node) } else { turn(node).transpose() };
                    apply(&mut right[nodal + coupling.first..], &turn);
                }
            }
        }
    }

    /// The simplified Newton iteration for the stages, to rounding.
    fn iterate(
        &mut self,
        moving: &mut Moving,
        before: f64,
        length: f64,
        newton: &Newton,
        statistics: &mut Statistics,
    ) -> Result<Converged, NotConverged> {
        let (mut residual, mut iterations, mut renewed) = (f64::INFINITY, 0, 0);
        let stop = |reason, iterations, residual| NotConverged { iterations, residual, reason };
        loop {
            self.place(moving, length).map_err(|reason| stop(reason, iterations, residual))?;
            let now = self.evaluate(moving, before, length, newton);
            let now = now.map_err(|reason| stop(reason, iterations, residual))?;
            let fall = if iterations == 0 { f64::INFINITY } else { now / residual };
            residual = now;
            let solved = residual <= newton.test.tolerance() && iterations > 0;
            if residual == 0.0 || solved && fall > STAGNANT {
                return Ok(Converged { iterations, residual });
            }
            if iterations == newton.max_iterations {
                // Accepted by the test, if not to rounding.
                let outcome = stop(StopReason::Iterations, iterations, residual);
                return if solved { Ok(Converged { iterations, residual }) } else { Err(outcome) };
            }
            iterations += 1;
            statistics.newton_iterations += 1;
            if !solved && iterations - renewed > PATIENCE && fall > SLOW {
                renewed = iterations;
                self.refresh(moving, before, length).map_err(|reason| stop(reason, iterations, residual))?;
                statistics.factorizations += 2;
            }
            self.improve(moving.model).map_err(|reason| stop(reason, iterations, residual))?;
        }
    }
}

impl Integrator for Radau {
    /// A step whose stages are not found is done in two halves, and these in halves again, down to one in 64.
    fn step(
        &mut self,
        moving: &mut Moving,
        time: f64,
        length: f64,
        newton: &Newton,
        statistics: &mut Statistics,
    ) -> Result<Converged, NotConverged> {
        let (start, whole) = (time - length, length);
        let (mut done, mut parts) = (0, 1);
        let mut worst = Converged { iterations: 0, residual: 0.0 };
        while done < parts {
            let (state, motion) = (moving.state.clone(), moving.motion.clone());
            let length = whole / parts as f64;
            // The last one ends at the time itself, to the last digit.
            let end = if done + 1 == parts { time } else { start + (done + 1) as f64 * length };
            match self.attempt(moving, end, length, newton, statistics) {
                Ok(converged) => {
                    done += 1;
                    worst.iterations = worst.iterations.max(converged.iterations);
                    worst.residual = worst.residual.max(converged.residual);
                }
                Err(stop) if parts == self.most_parts => return Err(stop),
                Err(_) => {
                    (moving.state, moving.motion) = (state, motion);
                    self.undo();
                    statistics.rejected += 1;
                    (done, parts) = (2 * done, 2 * parts);
                }
            }
        }
        Ok(worst)
    }

    fn restart(&mut self, _: &mut Moving, _: f64, _: f64) -> Result<(), StopReason> {
        self.previous = None;
        Ok(())
    }

    fn undo(&mut self) {
        self.previous = None;
        self.stale = true;
    }

    fn leading(&self) -> Leading {
        self.estimate_leading()
    }

    fn derivatives(&self, _: &Moving, derivatives: &mut [Velocity]) {
        derivatives.copy_from_slice(&self.derivatives);
    }
}

impl Radau {
    /// One step of the method; what it leaves in `moving` after an error is of no use.
    fn attempt(
        &mut self,
        moving: &mut Moving,
        time: f64,
        length: f64,
        newton: &Newton,
        statistics: &mut Statistics,
    ) -> Result<Converged, NotConverged> {
        let at = (&moving.state, &moving.motion);
        let unsolved = |reason| NotConverged { iterations: 0, residual: f64::INFINITY, reason };
        if self.stale {
            let start = level(time - length);
            moving.work.evaluate(moving.model, at.0, &start, Some(at.1)).map_err(unsolved)?;
            self.stale = false;
        }
        self.factorize(moving.model, &mut moving.work, at, time - length, length).map_err(unsolved)?;
        // One real, one complex.
        statistics.factorizations += 2;
        self.predict(moving, length);
        let converged = self.iterate(moving, time - length, length, newton, statistics)?;
        self.previous = Some(length);
        self.estimate(moving, length);

        let last = &self.stages[STAGES - 1];
        moving.state.clone_from(&last.state);
        moving.state.normalize();
        moving.motion.clone_from(&last.motion);
        let finished = close(moving, time, statistics).and_then(|()| start::accelerate(moving, time, length));
        statistics.factorizations += 1;
        let Converged { iterations, residual } = converged;
        finished.map_err(|reason| NotConverged { iterations, residual, reason })?;
        Ok(converged)
    }
}

/// Moves positions onto g = 0 by the smallest change, δqᵀ M δq: [[M, −Gᵀ], [G, 0]] (δq, μ) = (0, −g), as long as the
/// gaps at least halve.
fn close(moving: &mut Moving, time: f64, statistics: &mut Statistics) -> Result<(), StopReason> {
    let model = moving.model;
    if model.couplings.is_empty() {
        return Ok(());
    }
    let nodes = moving.state.poses().len();
    let mut right = vec![0.0; NODE * nodes + moving.state.multipliers().len()];
    moving.work.evaluate(model, &moving.state, &level(time), Some(&moving.motion))?;
    start::factorize(moving, time, 0.0)?;
    statistics.factorizations += 1;
    let mut largest = f64::INFINITY;
    loop {
        let mut now = 0.0_f64;
        right.fill(0.0);
        for coupling in &model.couplings {
            let [a, b] = coupling.poses(&moving.state);
            let gap = coupling.constraint.gap(a, b);
            for (k, &row) in coupling.rows.iter().enumerate() {
                right[NODE * nodes + coupling.first + k] = -gap[row];
                now = now.max(gap[row].abs() / if row < 3 { model.size } else { 1.0 });
            }
        }
        if now == 0.0 || now > STAGNANT * largest {
            return Ok(());
        }
        largest = now;
        moving.work.solve_right(model, &mut right)?;
        for (node, change) in right.chunks_exact(NODE).take(nodes).enumerate() {
            let translation = Vector3::from_column_slice(&change[..3]);
            let rotation = Vector3::from_column_slice(&change[3..]);
            moving.state.add(node, &Increment { translation, rotation });
        }
    }
}

/// How far nodes and bodies go in the step (displacement [m], rotation [rad]), for the test of the joints.
fn travel(motion: &Motion, length: f64) -> (f64, f64) {
    let mut travel = (0.0_f64, 0.0_f64);
    for u in &motion.velocities {
        travel.0 = travel.0.max(length * u.translation.amax());
        travel.1 = travel.1.max(length * u.rotation.amax());
    }
    travel
}

/// Σ c_k u_k.
fn combine(factors: &[f64], terms: &[Velocity; STAGES]) -> Velocity {
    let mut sum = Velocity::default();
    for (factor, term) in factors.iter().zip(terms) {
        sum.translation += term.translation * *factor;
        sum.rotation += term.rotation * *factor;
    }
    sum
}

/// p_i of P_i = P₀ ∘ p_i: eq. (10) is Ṗ = ½ P ∘ (0, ω), so p_i − ½ Σ h a_ij p_j ∘ (0, Ω_j) = (1, 0), twelve linear
/// equations; `a` is h A. They are singular only where the step turns by more than the method can follow.
fn turns(a: &Matrix3<f64>, omega: &[Vector3<f64>; STAGES]) -> Option<[Vector4<f64>; STAGES]> {
    const SIZE: usize = 4 * STAGES;
    let mut matrix = SMatrix::<f64, SIZE, SIZE>::identity();
    let mut right = SVector::<f64, SIZE>::zeros();
    for i in 0..STAGES {
        right[4 * i] = 1.0;
        for (j, w) in omega.iter().enumerate() {
            let y = w * (-0.5 * a[(i, j)]);
            // p ∘ (0, y) as a matrix on p.
            #[rustfmt::skip]
            let product = nalgebra::Matrix4::new(
                0.0, -y.x, -y.y, -y.z,
                y.x,  0.0,  y.z, -y.y,
                y.y, -y.z,  0.0,  y.x,
                y.z,  y.y, -y.x,  0.0,
            );
            let mut block = matrix.fixed_view_mut::<4, 4>(4 * i, 4 * j);
            block += product;
        }
    }
    let solution = matrix.lu().solve(&right)?;
    Some(std::array::from_fn(|i| solution.fixed_rows::<4>(4 * i).into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::{quaternion_exp, quaternion_rate};

    /// A constant spin turns by the rational function R(z) of order 5 in place of the exponential.
    #[test]
    fn turns_solve_the_quaternion_equation() {
        let tableau = Tableau::new();
        let h = 0.1;
        let omega = Vector3::new(0.3, -0.7, 1.1);
        let turned = turns(&(tableau.a * h), &[omega; STAGES]).expect("regular");
        for i in 0..STAGES {
            let mut rate = Vector4::zeros();
            for j in 0..STAGES {
                rate += quaternion_rate(&turned[j]) * omega * (h * tableau.a[(i, j)]);
            }
            assert!((turned[i] - Vector4::x() - rate).amax() < 1e-15);
        }
        let exact = quaternion_exp(&(omega * h));
        let error = (turned[STAGES - 1] - exact).amax();
        // z⁶/7200 of the error function of the Padé approximation (2, 3), z = h |ω|/2 = 0.067.
        assert!(error < 1.0 / 7200.0 * (0.5 * h * omega.norm()).powi(6) * 1.1, "{error:e}");
    }
}
