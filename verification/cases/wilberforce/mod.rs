//! The Wilberforce pendulum of Harsch & Eugster, section 4.2, shared by the cases about it.
//!
//! A steel wire of 1 mm, three coils of radius 16 mm and pitch 1 mm, leads from the bob (ξ = 0, z = 0) to a clamp
//! (ξ = 1, z = 3 mm). The bob is a steel cylinder about the axis of the helix, its centre of mass half its height and
//! half a wire's diameter below z = 0. Gravity acts on the bob only; there is no damping; it is released at rest from
//! the unstressed spring. The references under `references/continuous/` come from the continuous rod equations, without
//! finite elements.

mod accuracy;
mod authors;
mod beat;
mod bob;
mod convergence;
mod energy;
mod exact_motion;
mod frequencies;
mod quaternions;
mod reference_integrator;
mod shipped;
mod stiffness;
mod swing;
mod work;

use std::error::Error;
use std::f64::consts::PI;

use cosserat::scene::{
    Body, CurveShape, Dynamics, Joint, JointKind, Material, Modes, Reference, Rod, Scene, Shape, Statics,
};
use cosserat::solution::Solution;
use cosserat::{Model, dynamics, modes};

use crate::case::Case;
use crate::measure::{clamp, probe};
use crate::pieces::circle;
use crate::placement::{Placement, placements};
use swing::Swing;

/// Every case about the pendulum.
pub fn all() -> Vec<Case> {
    [
        accuracy::all(),
        authors::all(),
        beat::all(),
        bob::all(),
        convergence::all(),
        energy::all(),
        exact_motion::all(),
        frequencies::all(),
        quaternions::all(),
        reference_integrator::all(),
        shipped::all(),
        stiffness::all(),
        work::all(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The pendulum on a wire without inertia, without an analysis.
pub fn massless() -> Scene {
    Pendulum { inertia: false, ..Pendulum::new(9, 6) }.scene()
}

const SHEAR: f64 = 81e9;
const POISSON: f64 = 0.23;
const DENSITY: f64 = 7850.0;
const DIAMETER: f64 = 1e-3;
const RADIUS: f64 = 16e-3;
const COILS: f64 = 3.0;
const PITCH: f64 = 1e-3;
const BOB_RADIUS: f64 = 23e-3;
const BOB_HEIGHT: f64 = 36e-3;
const GRAVITY: f64 = 9.81;
/// z of the bob's centre of mass at the start [m].
const START: f64 = -0.5 * (BOB_HEIGHT + DIAMETER);

/// tan α = pitch/(2πR).
fn slope() -> f64 {
    PITCH / (2.0 * PI * RADIUS)
}

/// Length of the wire [m].
fn wire_length() -> f64 {
    2.0 * PI * COILS * RADIUS * 1.0_f64.hypot(slope())
}

/// m of the bob [kg].
fn bob_mass() -> f64 {
    DENSITY * PI * BOB_RADIUS * BOB_RADIUS * BOB_HEIGHT
}

/// I_zz of the bob [kg m²].
fn bob_spin_inertia() -> f64 {
    0.5 * bob_mass() * BOB_RADIUS * BOB_RADIUS
}

/// Where the three placements of the pendulum put it.
fn places() -> [Placement; 3] {
    placements(0.1)
}

/// The pendulum; change what differs.
#[derive(Clone, Debug)]
struct Pendulum {
    elements: usize,
    degree: usize,
    reference: Reference,
    /// G of the wire [Pa].
    shear: f64,
    /// ρ of the wire [kg/m³].
    density: f64,
    /// Whether the wire has inertia.
    inertia: bool,
    /// Whether the bob has weight.
    weight: bool,
    /// Quaternion of the bob at the start.
    orientation: [f64; 4],
}

impl Pendulum {
    /// Nodes exactly on the helix.
    fn new(elements: usize, degree: usize) -> Self {
        Self {
            elements,
            degree,
            reference: Reference::Nodes,
            shear: SHEAR,
            density: DENSITY,
            inertia: true,
            weight: true,
            orientation: [1.0, 0.0, 0.0, 0.0],
        }
    }

    /// The paper's mesh and fit.
    fn paper() -> Self {
        Self { reference: Reference::Fit { samples: 45 }, ..Self::new(18, 2) }
    }

    /// Without an analysis.
    fn scene(&self) -> Scene {
        let helix = CurveShape::Helix { coils: COILS, radius: RADIUS, pitch: PITCH, phase: PI };
        let steel = Material {
            shear_modulus: Some(self.shear),
            poisson_ratio: Some(POISSON),
            density: Some(self.density),
            ..Material::default()
        };
        let spring = Rod {
            reference: self.reference,
            gravity: false,
            inertia: self.inertia,
            ..Rod::new("spring", helix, circle(DIAMETER), Some(steel), self.elements, self.degree)
        };
        let bob = Body {
            name: "bob".to_string(),
            shape: Some(Shape::Cylinder { radius: BOB_RADIUS, height: BOB_HEIGHT }),
            density: Some(DENSITY),
            mass: None,
            inertia: None,
            position: [0.0, 0.0, START],
            orientation: self.orientation,
            velocity: [0.0; 3],
            angular_velocity: [0.0; 3],
        };
        let between = ["spring@0".to_string(), "bob".to_string()];
        let grip = Joint { name: None, kind: JointKind::Rigid, between, point: None, axis: None };
        Scene {
            gravity: self.weight.then_some([0.0, 0.0, -GRAVITY]),
            rod: vec![spring],
            body: vec![bob],
            joint: vec![clamp("spring@1"), grip],
            probe: vec![probe("bob", "bob")],
            ..Scene::default()
        }
    }

    /// The motion in time.
    fn swing(&self, placement: &Placement, options: &Dynamics) -> Result<Swing, Box<dyn Error>> {
        let scene = Scene { dynamics: Some(options.clone()), ..self.scene() };
        let model = Model::new(&placement.apply(&scene))?;
        Ok(Swing::new(dynamics::solve(&model, options, &mut |_, _| ())?, placement))
    }

    /// The same, where it is.
    fn swing_as_is(&self, options: &Dynamics) -> Result<Swing, Box<dyn Error>> {
        self.swing(&places()[0], options)
    }

    /// The lowest angular frequencies [rad/s], and everything else.
    fn modes(&self, placement: &Placement, count: usize) -> Result<(Vec<f64>, Solution), Box<dyn Error>> {
        let options = Modes { count };
        let scene = Scene { modes: Some(options.clone()), ..self.scene() };
        let model = Model::new(&placement.apply(&scene))?;
        let solution = modes::solve(&model, &options, &mut |_, _| ())?;
        Ok((solution.modes.iter().map(|mode| mode.angular_frequency).collect(), solution))
    }

    /// Hanging at rest.
    fn statics(&self, options: Statics) -> Scene {
        Scene { statics: Some(options), ..self.scene() }
    }
}

/// The paper's step [s].
const PAPER_STEP: f64 = 5e-3;

/// The paper's step, spectral radius and tolerance.
fn paper_steps(end_time: f64) -> Dynamics {
    Dynamics { tolerance: Some(1e-8), ..Dynamics::new(end_time, PAPER_STEP) }
}

/// The program's defaults with a step.
fn steps(end_time: f64, time_step: f64) -> Dynamics {
    Dynamics::new(end_time, time_step)
}
