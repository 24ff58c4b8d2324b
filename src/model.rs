//! Scene → Model: nodes, numbering, joints, loads and probes; frozen afterwards.

mod coupling;
pub(crate) mod free_motion;
mod rod;

use std::ops::Range;

use nalgebra::{Vector3, Vector4};

use crate::body::MassProperties;
use crate::curve::PlacedCurve;
use crate::element::LineLoad;
use crate::error::{Error, SceneError};
use crate::inertia::Velocity;
use crate::interpolation::{HalfTurn, Pose};
use crate::joint::Support;
use crate::load::{Course, PointLoad};
use crate::rod::{NODE_TOLERANCE, RodElements, RodProperties};
use crate::rotation::normalized;
use crate::scene::{Analysis, EulerSequence, LoadKind, Part, Scene};
use crate::state::State;
pub(crate) use coupling::Coupling;

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
    /// Its weight at every node under full gravity [N]; empty without any.
    pub(crate) weights: Vec<Vector3<f64>>,
}

/// A rigid body ready to be solved.
#[derive(Debug)]
pub struct BodyModel {
    /// Its name.
    pub name: String,
    /// Mass and principal inertia.
    pub mass: MassProperties,
    /// Its centre of mass at the start: positions are kept relative to it [m].
    pub(crate) origin: Vector3<f64>,
    /// Its node in the model.
    pub(crate) node: usize,
    /// Its velocity at the start.
    pub(crate) velocity: Velocity,
    pub(crate) loads: Vec<PointLoad>,
    /// Its weight under full gravity [N].
    pub(crate) weight: Vector3<f64>,
    /// The longest lever of its joints and loads [m].
    pub(crate) reach: f64,
}

/// A joint, as the results see it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum JointModel {
    /// Between a rod's node and the ground, eliminated.
    Held {
        rod: usize,
        /// Index among the rod's supports.
        support: usize,
        /// +1 if the rod is the second of the pair, −1 if the ground is.
        sign: f64,
    },
    /// With multipliers: index among the couplings.
    Coupled(usize),
}

/// A probe, resolved.
#[derive(Clone, Debug)]
pub(crate) struct ProbeModel {
    pub on: ProbedPart,
    pub offset: Vector3<f64>,
    pub angles: Option<EulerSequence>,
}

/// What a probe sits on.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ProbedPart {
    Rod { rod: usize, xi: f64 },
    Body(usize),
}

/// A determinant of the interpolated rotation below this is a mesh too coarse: with two nodes α apart it falls to
/// cos²(α/2) halfway between them, so a tenth is lost at 37° in one interval, where strains are off by as much.
const RESOLVED_DETERMINANT: f64 = 0.9;

/// Everything a solve needs and nothing it changes.
#[derive(Debug)]
pub struct Model {
    pub(crate) rods: Vec<RodModel>,
    pub(crate) bodies: Vec<BodyModel>,
    pub(crate) joints: Vec<JointModel>,
    /// The joints with multipliers.
    pub(crate) couplings: Vec<Coupling>,
    /// Gravity and how it varies, for the potential energy.
    pub(crate) gravity: Vector3<f64>,
    pub(crate) probes: Vec<ProbeModel>,
    pub(crate) reference: State,
    /// Length of the shortest rod, or the longest lever where there is none [m].
    pub(crate) size: f64,
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
            bodies: Vec::new(),
            joints: Vec::new(),
            couplings: Vec::new(),
            gravity: scene.gravity.map_or_else(Vector3::zeros, Vector3::from),
            probes: Vec::new(),
            reference: State::default(),
            size: 1.0,
            warnings: Vec::new(),
        };
        for (index, curve) in curves.into_iter().enumerate() {
            let (rod, nodes) = rod::build(scene, index, curve, model.reference.poses().len())?;
            model.rods.push(rod);
            model.reference.append(nodes);
        }
        for index in 0..scene.body.len() {
            model.add_body(scene, index)?;
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
        model.size = model.smallest_size();
        model.warnings = coupling::drop_redundant(&mut model, scene);
        let multipliers = model.couplings.iter().map(|coupling| coupling.rows.len()).sum();
        model.reference.set_multiplier_count(multipliers);
        free_motion::refuse(&model, scene)?;
        if let Some(Analysis::Dynamics(_)) = scene.analysis() {
            coupling::refuse_violating_velocities(&model, scene)?;
        }
        let unresolved = model.unresolved(&model.reference, "undeformed shape");
        model.warnings.extend(unresolved);
        Ok(model)
    }

    /// The rods.
    pub fn rods(&self) -> impl Iterator<Item = &RodModel> {
        self.rods.iter()
    }

    /// The rigid bodies.
    pub fn bodies(&self) -> impl Iterator<Item = &BodyModel> {
        self.bodies.iter()
    }

    /// Number of scalar unknowns: 6 a node and a body, less what joints to the ground hold, and the multipliers of
    /// the other joints.
    pub fn unknowns(&self) -> usize {
        let held = |rod: &RodModel| rod.supports.iter().map(|support| 6 - support.freedom).sum::<usize>();
        let held: usize = self.rods.iter().map(held).sum();
        6 * self.reference.poses().len() - held + self.reference.multipliers().len()
    }

    /// The first load factor after `t` at which a load's course bends.
    pub(crate) fn next_bend(&self, t: f64) -> Option<f64> {
        let bends = self.courses().filter_map(|course| course.next_bend(t));
        bends.min_by(f64::total_cmp)
    }

    fn courses(&self) -> impl Iterator<Item = &Course> {
        let on_rods = self.rods.iter().flat_map(|rod| {
            let line_loads = rod.line_loads.iter().map(|(_, course)| course);
            rod.point_loads.iter().map(|load| &load.course).chain(line_loads)
        });
        on_rods.chain(self.bodies.iter().flat_map(|body| body.loads.iter().map(|load| &load.course)))
    }

    fn smallest_size(&self) -> f64 {
        let rods = self.rods.iter().map(|rod| rod.length).reduce(f64::min);
        let levers = self.bodies.iter().map(|body| body.reach).reduce(f64::max);
        rods.or(levers).filter(|size| *size > 0.0).unwrap_or(1.0)
    }

    /// The velocities at the start: rods at rest, bodies as given.
    pub(crate) fn initial_velocities(&self) -> Vec<Velocity> {
        let mut velocities = vec![Velocity::default(); self.reference.poses().len()];
        for body in &self.bodies {
            velocities[body.node] = body.velocity;
        }
        velocities
    }

    /// The undeformed state, first all nodes of the rods, then the bodies; positions are relative to the start of
    /// each rod and of each body.
    pub fn reference_state(&self) -> &State {
        &self.reference
    }

    /// Whether anything is loaded at all.
    pub(crate) fn loaded(&self) -> bool {
        self.courses().next().is_some()
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

    /// The position of a rod at ξ ∈ [0, 1], inertial: far cheaper than the pose, which projects the rotation.
    pub fn position(&self, state: &State, rod: usize, xi: f64) -> Result<Vector3<f64>, HalfTurn> {
        let rod = &self.rods[rod];
        Ok(rod.origin + rod.kernel.position(&state.poses()[rod.range.clone()], xi)?)
    }

    /// The pose of a body's centre of mass with a lever in its basis, inertial.
    pub fn body_pose(&self, state: &State, body: usize, offset: &Vector3<f64>) -> Pose {
        let body = &self.bodies[body];
        let pose = &state.poses()[body.node];
        Pose { position: body.origin + pose.position + pose.rotation * offset, rotation: pose.rotation }
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

    fn add_body(&mut self, scene: &Scene, index: usize) -> Result<(), SceneError> {
        let body = &scene.body[index];
        let mass = MassProperties::new(body).ok_or_else(|| {
            SceneError::new(format!("body.{index}"), "has no mass", "shape and density, or mass and inertia")
        })?;
        let quaternion = normalized(&Vector4::from(body.orientation));
        let (origin, node) = (Vector3::from(body.position), self.reference.poses().len());
        self.reference.push(Vector3::zeros(), quaternion);
        let weight = self.gravity * mass.mass;
        let loads = if self.gravity != Vector3::zeros() {
            vec![PointLoad::weight(node, weight, Course::default_for(scene))]
        } else {
            Vec::new()
        };
        let velocity = Velocity {
            translation: Vector3::from(body.velocity),
            rotation: Vector3::from(body.angular_velocity),
        };
        self.bodies.push(BodyModel {
            name: body.name.clone(),
            mass,
            origin,
            node,
            velocity,
            loads,
            weight,
            reach: 0.0,
        });
        Ok(())
    }

    fn add_load(&mut self, scene: &Scene, index: usize) -> Result<(), SceneError> {
        let load = &scene.load[index];
        if !matches!(load.kind, LoadKind::Force | LoadKind::Moment) {
            return Ok(());
        }
        match self.place(scene, &load.on, &format!("load.{index}.on"))? {
            Place::Ground => {}
            Place::Body(body) => {
                let body = &mut self.bodies[body];
                let load = PointLoad::new(body.node, load, scene);
                body.reach = load.iter().map(|load| load.lever.norm()).fold(body.reach, f64::max);
                body.loads.extend(load);
            }
            Place::Node { rod, node } => {
                self.rods[rod].point_loads.extend(PointLoad::new(node, load, scene));
            }
        }
        Ok(())
    }

    fn add_joints(&mut self, scene: &Scene) -> Result<(), SceneError> {
        // Where each eliminated joint's support ended up after sorting: remembered by (rod, node).
        let mut held = Vec::new();
        for (index, joint) in scene.joint.iter().enumerate() {
            let mut places = [Place::Ground; 2];
            for (end, place) in places.iter_mut().enumerate() {
                *place = self.place(scene, &joint.between[end], &format!("joint.{index}.between.{end}"))?;
            }
            match places {
                [Place::Ground, Place::Node { rod, node }] | [Place::Node { rod, node }, Place::Ground]
                    if !scene.multiplied(index) =>
                {
                    let model = &mut self.rods[rod];
                    let pose = &self.reference.poses()[model.range.start + node];
                    let point =
                        joint.point.map_or(pose.position, |point| Vector3::from(point) - model.origin);
                    let axis = Vector3::from(joint.axis.unwrap_or([1.0, 0.0, 0.0]));
                    model.supports.push(Support::new(node, joint.kind, pose, point, axis));
                    let sign = if matches!(places[0], Place::Ground) { 1.0 } else { -1.0 };
                    held.push((index, rod, node, sign));
                    self.joints.push(JointModel::Held { rod, support: 0, sign });
                }
                _ => {
                    self.joints.push(JointModel::Coupled(self.couplings.len()));
                    self.couplings.push(Coupling::new(self, joint, places));
                }
            }
        }
        for body in &mut self.bodies {
            let mine = self.couplings.iter().filter(|coupling| coupling.nodes.contains(&Some(body.node)));
            body.reach = mine.map(|coupling| coupling.reach).fold(body.reach, f64::max);
        }
        for rod in &mut self.rods {
            rod.supports.sort_by_key(|support| support.node);
        }
        for (index, rod, node, sign) in held {
            let support = self.rods[rod].supports.partition_point(|support| support.node < node);
            self.joints[index] = JointModel::Held { rod, support, sign };
        }
        Ok(())
    }

    fn add_probe(&mut self, scene: &Scene, index: usize) -> Result<(), SceneError> {
        let probe = &scene.probe[index];
        let on = match scene.part(&probe.on) {
            Some(Part::Body(body)) => ProbedPart::Body(body),
            Some(Part::Rod { index: rod, xi }) => ProbedPart::Rod { rod, xi },
            Some(Part::Ground) | None => {
                let key = format!("probe.{index}.on");
                return Err(SceneError::new(
                    key,
                    format!("names no part: `{}`", probe.on),
                    "a body or \"rod@ξ\"",
                ));
            }
        };
        let offset = Vector3::from(probe.offset.unwrap_or_default());
        self.probes.push(ProbeModel { on, offset, angles: probe.angles });
        Ok(())
    }

    /// The ground, a body, or `rod@ξ` as a node of the rod.
    fn place(&self, scene: &Scene, on: &str, key: &str) -> Result<Place, SceneError> {
        let (rod, xi) = match scene.part(on) {
            Some(Part::Ground) => return Ok(Place::Ground),
            Some(Part::Body(body)) => return Ok(Place::Body(body)),
            Some(Part::Rod { index: rod, xi }) => (rod, xi),
            None => {
                return Err(SceneError::new(
                    key,
                    format!("names no part: `{on}`"),
                    "the ground, a body or \"rod@ξ\"",
                ));
            }
        };
        let positions = self.rods[rod].kernel.node_positions();
        let distance = |node: &f64| (node - xi).abs();
        let nearest =
            (0..positions.len()).min_by(|&a, &b| distance(&positions[a]).total_cmp(&distance(&positions[b])));
        match nearest {
            Some(node) if distance(&positions[node]) <= NODE_TOLERANCE => Ok(Place::Node { rod, node }),
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

/// What a joint or a load takes hold of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    Ground,
    Body(usize),
    /// Index of the rod, and of the node in it.
    Node {
        rod: usize,
        node: usize,
    },
}
