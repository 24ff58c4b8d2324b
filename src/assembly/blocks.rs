//! M, D, K and G of a model apart, block by block, for methods that combine them with more than one factor.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::{LoadLevel, Workspace};
use crate::inertia::{Velocity, gyroscopic_tangent};
use crate::model::Model;
use crate::rod::{Applied, TangentError, Target};
use crate::solution::StopReason;
use crate::state::State;

/// What two nodes add to M = ∂/∂u̇, D = ∂/∂u and K = ∂/∂(δr, δφ) of M u̇ + fᵍʸʳ − f − Gᵀ λ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// Row and column, nodes of the model.
    pub nodes: [usize; 2],
    /// Diagonal of M; the rest is zero.
    pub mass: Vector6<f64>,
    /// D, rows of moments and columns of ω; the rest is zero.
    pub gyroscopic: Matrix3<f64>,
    /// K.
    pub stiffness: Matrix6<f64>,
}

/// The part of a row of G that belongs to one node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstraintRow {
    /// Index of the multiplier.
    pub multiplier: usize,
    /// Node of the model.
    pub node: usize,
    /// Its six entries.
    pub entries: Vector6<f64>,
}

/// M, D, K and G as sums of blocks, always the same ones in the same order; held nodes are as if they were free.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blocks {
    /// M, D and K.
    pub nodal: Vec<Block>,
    /// G.
    pub constraints: Vec<ConstraintRow>,
    /// Of one rod.
    stiffness: Vec<Matrix6<f64>>,
}

impl Workspace {
    /// M, D, K and G at the state and level that were evaluated last and the velocities u.
    ///
    /// # Errors
    /// [`StopReason::Singular`] for a rod without inertia.
    pub fn blocks(
        &mut self,
        model: &Model,
        state: &State,
        level: &LoadLevel,
        velocities: &[Velocity],
        blocks: &mut Blocks,
    ) -> Result<(), StopReason> {
        blocks.nodal.clear();
        blocks.constraints.clear();
        for index in 0..model.rods.len() {
            self.rod_blocks(index, model, state, level, velocities, blocks)?;
        }
        for body in &model.bodies {
            let loads = body.loads.iter();
            let pose = &state.poses()[body.node];
            blocks.nodal.push(Block {
                nodes: [body.node; 2],
                mass: diagonal(body.mass.mass, &body.mass.inertia),
                gyroscopic: gyroscopic_tangent(&body.mass.inertia, &velocities[body.node].rotation),
                stiffness: loads.map(|load| load.tangent(pose, level.factor(&load.course))).sum(),
            });
        }
        for coupling in &model.couplings {
            let [a, b] = coupling.poses(state);
            let tangent = coupling.constraint.tangent(a, b, &coupling.multipliers(state));
            let jacobian = coupling.constraint.jacobian(a, b);
            for (i, row) in coupling.nodes.iter().enumerate() {
                let Some(row) = *row else { continue };
                for (j, column) in coupling.nodes.iter().enumerate() {
                    let Some(column) = *column else { continue };
                    blocks.nodal.push(Block {
                        nodes: [row, column],
                        mass: Vector6::zeros(),
                        gyroscopic: Matrix3::zeros(),
                        stiffness: tangent[i][j],
                    });
                }
                blocks.constraints.extend(coupling.rows.iter().enumerate().map(|(k, &of_joint)| {
                    ConstraintRow {
                        multiplier: coupling.first + k,
                        node: row,
                        entries: jacobian[i].row(of_joint).transpose(),
                    }
                }));
            }
        }
        Ok(())
    }

    fn rod_blocks(
        &mut self,
        index: usize,
        model: &Model,
        state: &State,
        level: &LoadLevel,
        velocities: &[Velocity],
        blocks: &mut Blocks,
    ) -> Result<(), StopReason> {
        let (rod, work) = (&model.rods[index], &mut self.rods[index]);
        let Some(inertia) = &rod.properties.inertia else { return Err(StopReason::Singular) };
        let (range, first) = (rod.range.clone(), rod.range.start);
        let poses = &state.poses()[range.clone()];
        for (load, tangent) in rod.point_loads.iter().zip(&mut work.load_tangents) {
            tangent.1 = load.tangent(&poses[load.node], level.factor(&load.course));
        }
        let applied = Applied {
            line_load: &work.line_load,
            line_loaded: !rod.line_loads.is_empty(),
            tangents: &work.load_tangents,
            supports: &[],
            force: &self.forces.force[range.clone()],
            step: None,
        };
        blocks.stiffness.clear();
        rod.kernel
            .assemble_tangent(
                state,
                range.clone(),
                &rod.properties,
                &work.constitutive,
                &applied,
                &mut Target::Blocks(&mut blocks.stiffness),
            )
            .map_err(|error| match error {
                TangentError::HalfTurn(element) => StopReason::HalfTurn { rod: index, element },
                TangentError::Singular => StopReason::Singular,
            })?;
        let mut stiffness = blocks.stiffness.iter();
        let section = &inertia.section;
        rod.kernel.visit_inertia(&rod.properties, &velocities[range], &mut |nodes, mass, spin| {
            blocks.nodal.push(Block {
                nodes: nodes.map(|node| first + node),
                mass: diagonal(mass * section.mass_per_length, &(section.rotary * mass)),
                gyroscopic: gyroscopic_tangent(&section.rotary, spin),
                stiffness: stiffness.next().copied().unwrap_or_default(),
            });
        });
        Ok(())
    }
}

/// (m, m, m, Θ₁, Θ₂, Θ₃).
fn diagonal(mass: f64, inertia: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(mass, mass, mass, inertia.x, inertia.y, inertia.z)
}
