//! Scene → Model: nodes, numbering, supports, loads and probes; frozen afterwards.

mod free_motion;
mod rod;

use std::ops::Range;

use nalgebra::Vector3;

use crate::curve::PlacedCurve;
use crate::element::LineLoad;
use crate::error::{Error, SceneError};
use crate::interpolation::{HalfTurn, Pose};
use crate::joint::Support;
use crate::load::{Course, PointLoad};
use crate::rod::{NODE_TOLERANCE, RodElements, RodProperties};
use crate::scene::{EulerSequence, LoadKind, Scene, parse_point};
use crate::state::State;

/// A rod ready to be solved.
#[derive(Debug)]
pub struct RodModel {
    /// Its name.
    pub name: String,
    /// Number of elements.
    pub elements: usize,
    /// Polynomial degree p.
    pub degree: usize,
    /// Number of nodes, p · elements + 1.
    pub nodes: usize,
    /// Reference length of the discrete rod [m].
    pub length: f64,
    /// The start of its curve: positions are kept relative to it, so that a rod far from the inertial origin loses
    /// no digits [m].
    pub(crate) origin: Vector3<f64>,
    pub(crate) kernel: Box<dyn RodElements>,
    pub(crate) properties: RodProperties,
    /// Its nodes among those of the model.
    pub(crate) range: Range<usize>,
    /// Held nodes, ascending.
    pub(crate) supports: Vec<Support>,
    /// Point loads, ascending by node.
    pub(crate) point_loads: Vec<PointLoad>,
    pub(crate) line_loads: Vec<(LineLoad, Course)>,
    /// Shortest element, J_e [m].
    pub(crate) element_length: f64,
}

/// A joint to the ground, as the results see it.
#[derive(Clone, Debug)]
pub(crate) struct GroundJoint {
    pub rod: usize,
    /// Index among the rod's supports.
    pub support: usize,
    /// +1 if the rod is the second of the pair, −1 if the ground is.
    pub sign: f64,
}

/// A probe, resolved.
#[derive(Clone, Debug)]
pub(crate) struct ProbeModel {
    pub rod: usize,
    pub xi: f64,
    pub offset: Vector3<f64>,
    pub angles: Option<EulerSequence>,
}

/// A determinant of the interpolated rotation below this is a mesh too coarse: with two nodes α apart it falls to
/// cos²(α/2) halfway between them, so a tenth is lost at 37° in one interval, where strains are off by as much.
const RESOLVED_DETERMINANT: f64 = 0.9;

/// Everything a solve needs and nothing it changes.
#[derive(Debug)]
pub struct Model {
    pub(crate) rods: Vec<RodModel>,
    pub(crate) joints: Vec<GroundJoint>,
    pub(crate) probes: Vec<ProbeModel>,
    pub(crate) reference: State,
    warnings: Vec<String>,
}

impl Model {
    /// Validates the scene and builds the model; the fit (21) of reference configurations happens here.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        scene.validate()?;
        let curves = scene
            .rod
            .iter()
            .enumerate()
            .map(|(i, rod)| PlacedCurve::new(&rod.curve, &format!("rod.{i}.curve")))
            .collect::<Result<Vec<_>, _>>()?;
        let mut model = Self {
            rods: Vec::new(),
            joints: Vec::new(),
            probes: Vec::new(),
            reference: State::default(),
            warnings: Vec::new(),
        };
        for (index, curve) in curves.into_iter().enumerate() {
            let (rod, nodes) = rod::build(scene, index, curve, model.reference.poses().len())?;
            model.rods.push(rod);
            model.reference.append(nodes);
        }
        for index in 0..scene.load.len() {
            model.add_load(scene, index)?;
        }
        for rod in &mut model.rods {
            rod.point_loads.sort_by_key(|load| load.node);
        }
        model.add_joints(scene)?;
        for index in 0..scene.probe.len() {
            model.add_probe(scene, index)?;
        }
        free_motion::refuse(&model)?;
        model.warnings = model.unresolved(&model.reference, "undeformed shape");
        Ok(model)
    }

    /// The rods.
    pub fn rods(&self) -> impl Iterator<Item = &RodModel> {
        self.rods.iter()
    }

    /// Number of scalar unknowns: 6 a node, less what the joints hold.
    pub fn unknowns(&self) -> usize {
        let held = |rod: &RodModel| rod.supports.iter().map(|support| 6 - support.freedom).sum::<usize>();
        self.rods.iter().map(|rod| 6 * rod.nodes - held(rod)).sum()
    }

    /// The first load factor after `t` at which a load's course bends.
    pub(crate) fn next_bend(&self, t: f64) -> Option<f64> {
        let bends = self.courses().filter_map(|course| course.next_bend(t));
        bends.min_by(f64::total_cmp)
    }

    fn courses(&self) -> impl Iterator<Item = &Course> {
        self.rods.iter().flat_map(|rod| {
            let line_loads = rod.line_loads.iter().map(|(_, course)| course);
            rod.point_loads.iter().map(|load| &load.course).chain(line_loads)
        })
    }

    /// The undeformed state; positions are relative to the start of each rod.
    pub fn reference_state(&self) -> &State {
        &self.reference
    }

    /// Whether any load acts at load factor 0 already.
    pub(crate) fn loaded_at_start(&self) -> bool {
        self.courses().any(|course| course.factor(0.0) != 0.0)
    }

    /// What the user should know about the model.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The pose of a rod at ξ ∈ [0, 1] with a lever in the section's basis, inertial.
    pub fn pose(&self, state: &State, rod: usize, xi: f64, offset: &Vector3<f64>) -> Result<Pose, HalfTurn> {
        let rod = &self.rods[rod];
        let pose = rod.kernel.pose(&state.poses()[rod.range.clone()], xi)?;
        Ok(Pose { position: rod.origin + pose.position + pose.rotation * offset, rotation: pose.rotation })
    }

    /// A sentence for every rod whose mesh does not resolve a state.
    pub(crate) fn unresolved(&self, state: &State, what: &str) -> Vec<String> {
        let sentence = |rod: &RodModel| {
            let poses = &state.poses()[rod.range.clone()];
            let (element, stretch) = rod.kernel.smallest_stretch(poses, &rod.properties);
            if stretch <= 0.0 {
                return Some(format!(
                    "rod `{}` is pushed through itself in its {what}: in element {element} its stretch is \
                     {stretch:.3}; no material does that",
                    rod.name
                ));
            }
            let (element, determinant) = rod.kernel.smallest_determinant(poses);
            (determinant < RESOLVED_DETERMINANT).then(|| {
                format!(
                    "the mesh of rod `{}` is too coarse for its {what}: in element {element} the interpolated \
                     rotation has the determinant {determinant:.3} instead of 1; use more elements",
                    rod.name
                )
            })
        };
        self.rods.iter().filter_map(sentence).collect()
    }

    fn add_load(&mut self, scene: &Scene, index: usize) -> Result<(), SceneError> {
        let load = &scene.load[index];
        if matches!(load.kind, LoadKind::Force | LoadKind::Moment) {
            let (rod, node) = self.node(&load.on, &format!("load.{index}.on"))?;
            self.rods[rod].point_loads.extend(PointLoad::new(node, load));
        }
        Ok(())
    }

    fn add_joints(&mut self, scene: &Scene) -> Result<(), SceneError> {
        // Where each joint's support ended up after sorting: remembered by (rod, node).
        let mut places = Vec::new();
        for (index, joint) in scene.joint.iter().enumerate() {
            let end = usize::from(joint.between[0] == "ground");
            let (rod, node) = self.node(&joint.between[end], &format!("joint.{index}.between.{end}"))?;
            let model = &mut self.rods[rod];
            if model.supports.iter().any(|support| support.node == node) {
                return Err(SceneError::new(
                    format!("joint.{index}.between.{end}"),
                    format!("holds `{}`, which another joint holds already", joint.between[end]),
                    "one joint a node; more are not available yet",
                ));
            }
            let pose = &self.reference.poses()[model.range.start + node];
            let point = joint.point.map_or(pose.position, |point| Vector3::from(point) - model.origin);
            let axis = Vector3::from(joint.axis.unwrap_or([1.0, 0.0, 0.0]));
            model.supports.push(Support::new(node, joint.kind, pose, point, axis));
            places.push((rod, node, if end == 1 { 1.0 } else { -1.0 }));
        }
        for rod in &mut self.rods {
            rod.supports.sort_by_key(|support| support.node);
        }
        for (rod, node, sign) in places {
            let support = self.rods[rod].supports.partition_point(|support| support.node < node);
            self.joints.push(GroundJoint { rod, support, sign });
        }
        Ok(())
    }

    fn add_probe(&mut self, scene: &Scene, index: usize) -> Result<(), SceneError> {
        let probe = &scene.probe[index];
        let (rod, xi) = self.point(&probe.on, &format!("probe.{index}.on"))?;
        let offset = Vector3::from(probe.offset.unwrap_or_default());
        self.probes.push(ProbeModel { rod, xi, offset, angles: probe.angles });
        Ok(())
    }

    /// `rod@ξ` as (index of the rod, ξ).
    fn point(&self, on: &str, key: &str) -> Result<(usize, f64), SceneError> {
        parse_point(on)
            .and_then(|(name, xi)| Some((self.rods.iter().position(|rod| rod.name == name)?, xi)))
            .ok_or_else(|| {
                SceneError::new(key, format!("names no point of a rod: `{on}`"), "rod@ξ, ξ in [0, 1]")
            })
    }

    /// `rod@ξ` as (index of the rod, index of the node in it).
    fn node(&self, on: &str, key: &str) -> Result<(usize, usize), SceneError> {
        let (rod, xi) = self.point(on, key)?;
        let positions = self.rods[rod].kernel.node_positions();
        let distance = |node: &f64| (node - xi).abs();
        let nearest =
            (0..positions.len()).min_by(|&a, &b| distance(&positions[a]).total_cmp(&distance(&positions[b])));
        match nearest {
            Some(node) if distance(&positions[node]) <= NODE_TOLERANCE => Ok((rod, node)),
            _ => {
                let nearest = nearest.map_or(0.0, |node| positions[node]);
                Err(SceneError::new(
                    key,
                    format!("is no node of the rod: ξ = {xi}"),
                    format!("a node; the nearest is ξ = {nearest}"),
                ))
            }
        }
    }
}
