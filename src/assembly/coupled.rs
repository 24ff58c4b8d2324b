//! One chain a rod, and the system that couples them: kept nodes, bodies and multipliers.

use nalgebra::Matrix6;

use super::LoadLevel;
use crate::linear_solver::{Condensed, Coupled, NODE, Singular};
use crate::model::{Model, RodModel};
use crate::rod::StepVelocity;
use crate::state::State;

/// Chains, and the system of their kept nodes, of the bodies and of the multipliers.
pub struct Chains {
    /// One a rod.
    pub chains: Vec<Condensed>,
    coupled: Coupled,
    /// First row of every coupled node in that system; `None` for the chains' own.
    places: Vec<Option<usize>>,
    /// The coupled nodes in the order of their rows.
    nodes: Vec<usize>,
    right: Vec<f64>,
}

impl Chains {
    /// For a model.
    pub fn new(model: &Model) -> Self {
        let joined = || model.couplings.iter().flat_map(|coupling| coupling.nodes.into_iter().flatten());
        let chain = |rod: &RodModel| {
            let own = joined().filter(|node| rod.range.contains(node));
            let kept: Vec<usize> = own.map(|node| node - rod.range.start).collect();
            Condensed::new(rod.elements, rod.degree, &kept, rod.element_length)
        };
        let chains: Vec<Condensed> = model.rods.iter().map(chain).collect();
        let of_rods = model.rods.iter().zip(&chains);
        let kept = of_rods.flat_map(|(rod, chain)| chain.kept().iter().map(|node| rod.range.start + node));
        let nodes: Vec<usize> = kept.chain(model.bodies.iter().map(|body| body.node)).collect();
        let mut places = vec![None; model.reference.poses().len()];
        for (index, &node) in nodes.iter().enumerate() {
            places[node] = Some(NODE * index);
        }
        let size = NODE * nodes.len() + model.reference.multipliers().len();
        Self { chains, coupled: Coupled::new(size), places, nodes, right: vec![0.0; size] }
    }

    /// Adds a block to the coupled system, by nodes of the model.
    fn add(&mut self, row: usize, column: usize, block: &Matrix6<f64>) {
        if let (Some(row), Some(column)) = (self.places[row], self.places[column]) {
            self.coupled.add_block(row, column, block);
        }
    }

    /// b ← K⁻¹ b: six entries a node, then the multipliers.
    pub fn solve(&mut self, model: &Model, b: &mut [f64]) -> Result<(), Singular> {
        for (rod, chain) in model.rods.iter().zip(&self.chains) {
            chain.forward(&mut b[NODE * rod.range.start..NODE * rod.range.end]);
        }
        let nodal = NODE * self.nodes.len();
        for (&node, right) in self.nodes.iter().zip(self.right.chunks_exact_mut(NODE)) {
            right.copy_from_slice(&b[NODE * node..][..NODE]);
        }
        let multipliers = NODE * self.places.len();
        self.right[nodal..].copy_from_slice(&b[multipliers..]);
        self.coupled.solve(&mut self.right)?;
        for (&node, right) in self.nodes.iter().zip(self.right.chunks_exact(NODE)) {
            b[NODE * node..][..NODE].copy_from_slice(right);
        }
        b[multipliers..].copy_from_slice(&self.right[nodal..]);
        for (rod, chain) in model.rods.iter().zip(&self.chains) {
            chain.backward(&mut b[NODE * rod.range.start..NODE * rod.range.end]);
        }
        Ok(())
    }
}

/// Bodies, joints and what is left of the chains, after every chain has its elements.
pub fn factorize_chains(
    system: &mut Chains,
    model: &Model,
    state: &State,
    level: &LoadLevel,
    step: Option<&StepVelocity>,
) -> Result<(), Singular> {
    system.coupled.clear();
    for (index, rod) in model.rods.iter().enumerate() {
        system.chains[index].factorize()?;
        let first = rod.range.start;
        for (row, column, block) in system.chains[index].remainder() {
            if let (Some(row), Some(column)) = (system.places[first + row], system.places[first + column]) {
                system.coupled.add_block(row, column, block);
            }
        }
    }
    let scale = step.map_or(1.0, |step| step.b * step.b);
    for body in &model.bodies {
        let mut block = Matrix6::zeros();
        for load in &body.loads {
            block += load.tangent(&state.poses()[body.node], level.factor(&load.course)) * scale;
        }
        if let Some(step) = step {
            block += body.mass.inertia_tangent(&step.velocities[body.node], step.b);
        }
        system.add(body.node, body.node, &block);
    }
    let first = NODE * system.nodes.len();
    for coupling in &model.couplings {
        let [a, b] = coupling.poses(state);
        let tangent = coupling.constraint.tangent(a, b, &coupling.multipliers(state));
        let jacobian = coupling.constraint.jacobian(a, b);
        for (i, row_node) in coupling.nodes.iter().enumerate() {
            let Some(row_node) = *row_node else { continue };
            for (j, column_node) in coupling.nodes.iter().enumerate() {
                if let Some(column_node) = *column_node {
                    system.add(row_node, column_node, &(tangent[i][j] * scale));
                }
            }
            let Some(place) = system.places[row_node] else { continue };
            for (k, &row) in coupling.rows.iter().enumerate() {
                let multiplier = first + coupling.first + k;
                for c in 0..NODE {
                    system.coupled.add(multiplier, place + c, jacobian[i][(row, c)]);
                    system.coupled.add(place + c, multiplier, -jacobian[i][(row, c)]);
                }
            }
        }
    }
    system.coupled.factorize()
}
