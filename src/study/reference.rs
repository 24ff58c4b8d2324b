//! The run that all others are held against, with an estimate of its own error.

use crate::error::SceneError;
use crate::scene::{
    CurveShape, Dynamics, InterpolationKind, JointKind, Method, NewtonKind, NodeSpacing, Part, Probe,
    QuadratureKind, Reference as Nodes, Scene, Statics,
};
use crate::solution::Statistics;
use crate::study::settings::time_step;
use crate::study::trial::{Stop, solve};
use crate::study::{Errors, Milestones, Trajectory, compare};

/// The reference has so many degrees more than the finest run: nodal errors fall like h²ᵖ, others like hᵖ⁺¹.
const MORE_DEGREES: usize = 2;
/// Its least and most degree.
const DEGREES: [usize; 2] = [4, 8];
/// Elements, and steps of Radau IIA (order 5), grow by this ratio from one run to the next: a seventh of the error is
/// left at most.
const FINER: [usize; 2] = [3, 2];
/// The first step of Radau IIA is so many times the shortest of generalized-α, and already more accurate.
const LONGER: usize = 4;
/// The first step of generalized-α, where there is no Radau IIA, is this part of the shortest of the others,
const SHORTER: usize = 2;
/// and the steps grow by this ratio in number: a quarter of the error is left.
const FINER_IN_TIME: [usize; 2] = [2, 1];
/// Most runs, the two that are needed included.
const MOST_RUNS: usize = 4;

/// The finest settings of the runs that a reference is for.
#[derive(Clone, Debug, PartialEq)]
pub struct Finest {
    /// Of every rod the most intervals between nodes, elements times degree.
    pub intervals: Vec<usize>,
    /// The largest degree.
    pub degree: usize,
    /// The smallest time step, one that divides the intervals between milestones [s]; dynamics only.
    pub time_step: Option<f64>,
}

/// The path that all others are held against.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Where the probes are at the milestones.
    pub trajectory: Trajectory,
    /// Its distance from the next coarser reference, which bounds its own error wherever refinement at least halves
    /// the error.
    pub error: Errors,
    /// Its degree; nothing without rods.
    pub degree: Option<usize>,
    /// Its elements, all rods together; nothing without rods.
    pub elements: Option<usize>,
    /// Its time step [s]; dynamics only.
    pub time_step: Option<f64>,
    /// Processor time of all runs that led to it [s].
    pub seconds: f64,
}

/// Finds a reference for runs of a scene: R12 of a high degree on Gauss–Lobatto nodes that lie on the curve, the
/// default tolerance, and in dynamics Radau IIA, or where rods have no inertia much shorter steps of generalized-α.
/// It is refined until its error is estimated below `goal`, falls no more, or four runs are done.
///
/// `admissible` is from [`admissible_elements`](super::admissible_elements); `progress` hears the number of the run
/// beside what [`solve`] tells.
///
/// # Errors
/// [`Stop`] if a run fails, or in dynamics if of no two runs, one after the other, both arrive; a run that fails when
/// there is a reference already leaves it as it is.
pub fn find_reference(
    scene: &Scene,
    milestones: &Milestones,
    finest: &Finest,
    admissible: &[usize],
    goal: f64,
    progress: &mut dyn FnMut(usize, f64, &Statistics),
) -> Result<Reference, Stop> {
    let mut found: Option<Reference> = None;
    let mut coarser: Option<Trajectory> = None;
    let mut seconds = 0.0;
    let mut stopped = None;
    for number in 0..MOST_RUNS {
        let variant = level(scene, milestones, finest, admissible, number);
        let trial = match solve(&variant, milestones, &mut |done, work| progress(number, done, work)) {
            Ok(trial) => trial,
            Err(_) if found.is_some() => break,
            // Shorter steps may pass where longer ones did not.
            Err(stop @ Stop::Solver(_)) if scene.dynamics.is_some() => {
                (coarser, stopped) = (None, Some(stop));
                continue;
            }
            Err(stop) => return Err(stop),
        };
        seconds += trial.seconds;
        let Some(coarse) = coarser.replace(trial.trajectory.clone()) else { continue };
        let error = distance(&trial.trajectory, &coarse)?;
        // Rounding is reached: another run would be no better, and neither is this one.
        if found.as_ref().is_some_and(|found| error.largest() >= found.error.largest()) {
            break;
        }
        found = Some(named(&variant, trial.trajectory, error));
        if error.largest() <= goal {
            break;
        }
    }
    match (found, stopped) {
        (Some(reference), _) => Ok(Reference { seconds, ..reference }),
        (None, Some(stop)) => Err(stop),
        (None, None) => Err(nothing_in_common()),
    }
}

fn named(variant: &Scene, trajectory: Trajectory, error: Errors) -> Reference {
    Reference {
        trajectory,
        error,
        degree: variant.rod.first().map(|rod| rod.degree),
        elements: elements(variant),
        time_step: variant.dynamics.as_ref().and_then(time_step),
        seconds: 0.0,
    }
}

/// Of all rods together; nothing without rods.
pub(super) fn elements(scene: &Scene) -> Option<usize> {
    let all = scene.rod.iter().map(|rod| rod.elements);
    all.reduce(usize::saturating_add)
}

fn distance(fine: &Trajectory, coarse: &Trajectory) -> Result<Errors, Stop> {
    compare(fine, coarse).ok_or_else(nothing_in_common)
}

fn nothing_in_common() -> Stop {
    let error = SceneError::new("probe", "has no rows in common", "at least one probe and one milestone");
    Stop::Setup(error.into())
}

/// The scene of run 0, 1, … towards a reference.
fn level(
    scene: &Scene,
    milestones: &Milestones,
    finest: &Finest,
    admissible: &[usize],
    number: usize,
) -> Scene {
    let mut variant = scene.clone();
    let [least, most] = DEGREES;
    let degree = (finest.degree + MORE_DEGREES).clamp(least, most);
    for (index, rod) in variant.rod.iter_mut().enumerate() {
        rod.degree = degree;
        // As many elements as a run of the finest degree with as many nodes has; where there is no higher degree, more.
        let elements = finest.intervals[index].div_ceil(degree - MORE_DEGREES);
        let parts = elements.div_ceil(admissible[index]);
        rod.elements = grown(parts, FINER, number) * admissible[index];
        rod.interpolation = InterpolationKind::R12;
        rod.node_spacing = NodeSpacing::GaussLobatto;
        rod.quadrature = QuadratureKind::Reduced;
        if !matches!(rod.curve.shape, CurveShape::Poses { .. }) {
            rod.reference = Nodes::Nodes;
        }
    }
    if variant.statics.is_some() {
        variant.statics = Some(Statics::default());
    }
    if let (Some(options), Some(step)) = (&scene.dynamics, finest.time_step) {
        variant.dynamics = Some(in_time(scene, options, milestones, step, number));
    }
    variant
}

fn in_time(scene: &Scene, options: &Dynamics, milestones: &Milestones, step: f64, number: usize) -> Dynamics {
    let parts = milestones.steps(step);
    let radau = scene.rod.iter().all(|rod| rod.inertia);
    let (method, parts) = if radau {
        (Method::Radau, grown(parts.div_ceil(LONGER), FINER, number))
    } else {
        (Method::GeneralizedAlpha, grown(SHORTER * parts, FINER_IN_TIME, number))
    };
    let spectral_radius = options.spectral_radius;
    Dynamics {
        method,
        spectral_radius,
        newton: NewtonKind::Mixed,
        ..Dynamics::new(options.end_time, milestones.step_of(parts))
    }
}

/// ⌈count · (n/d)^times⌉, rounded up every time so that it grows.
fn grown(count: usize, [numerator, denominator]: [usize; 2], times: usize) -> usize {
    (0..times).fold(count, |count, _| (count * numerator).div_ceil(denominator))
}

/// The scene with probes where it has none: at the ends of rods that are not clamped to the ground and at bodies; if
/// there are no such places, in the middle of every rod.
pub fn with_probes(scene: &Scene) -> Scene {
    let mut variant = scene.clone();
    if !variant.probe.is_empty() {
        return variant;
    }
    let clamped = |rod: usize, end: f64| {
        let here = Part::Rod { index: rod, xi: end };
        scene.joint.iter().enumerate().any(|(index, joint)| {
            let parts = scene.parts(index);
            let holds = |[a, b]: [Part; 2]| {
                (a == Part::Ground && b.coincides(&here)) || (b == Part::Ground && a.coincides(&here))
            };
            joint.kind == JointKind::Rigid && parts.is_some_and(holds)
        })
    };
    let ends = scene.rod.iter().enumerate().flat_map(|(index, rod)| {
        let free = ["0", "1"].into_iter().zip([0.0, 1.0]).filter(move |(_, xi)| !clamped(index, *xi));
        free.map(|(xi, _)| format!("{}@{xi}", rod.name)).collect::<Vec<_>>()
    });
    let mut places: Vec<String> = ends.chain(scene.body.iter().map(|body| body.name.clone())).collect();
    if places.is_empty() {
        places = scene.rod.iter().map(|rod| format!("{}@0.5", rod.name)).collect();
    }
    let probe = |(index, on)| Probe { name: format!("probe{}", index + 1), on, offset: None, angles: None };
    variant.probe = places.into_iter().enumerate().map(probe).collect();
    variant
}
