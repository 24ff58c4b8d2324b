//! Meshes and steps to choose from.

use nalgebra::Matrix3;

use super::estimate::Belief;
use crate::curve::PlacedCurve;
use crate::error::{Error, SceneError};
use crate::scene::{
    Analysis, Basis, InterpolationKind, Load, LoadKind, Method, QuadratureKind, Scene, Statics,
};
use crate::study::{Milestones, Settings, admissible_elements};

/// Milestones of a motion.
const IN_TIME: f64 = 100.0;
/// An element of the first mesh turns by this in the reference, for every degree: nodes less than half a turn apart
/// are admitted, and the first mesh need not be good, only cheap.
const FIRST_TURN: f64 = 0.8;
/// Given poses are shared by so many elements at least, or the degree is lower.
const FEWEST_ELEMENTS: usize = 8;
/// Elements grow by 4/3, rounded up: at order 2p = 8 the error falls by 10.
const FINER: [usize; 2] = [4, 3];
/// Where probes are inside elements: order p + 1 only.
const FINER_INSIDE: [usize; 2] = [3, 2];
/// Elements of degree 1, which have order 2, and whatever has failed: the error falls by 4.
const DOUBLED: [usize; 2] = [2, 1];
/// Inside elements a higher degree gains one order only, and errors vary the more with the place.
const MOST_INSIDE: usize = 4;
/// Probes at ends of elements keep the whole order 2p, but meshes in multiples of more than this would be too coarse a
/// choice.
const MOST_PARTS: usize = 24;

/// What a sequence of runs refines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refined {
    Mesh,
    Step,
}

/// The settings of one run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Level {
    /// Of every rod.
    elements: Vec<usize>,
    /// Steps from one milestone to the next; in statics increments are automatic.
    steps: usize,
}

impl Level {
    /// Grows with what is refined.
    pub(super) fn size(&self, refined: Refined) -> f64 {
        match refined {
            Refined::Mesh => self.elements.iter().sum::<usize>() as f64,
            Refined::Step => self.steps as f64,
        }
    }

    /// Number of steps between milestones.
    pub(super) fn steps(&self) -> f64 {
        self.steps as f64
    }
}

/// What is the same in all runs: the scene with its degree and tolerance, and which meshes it admits.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    scene: Scene,
    milestones: Milestones,
    /// Elements of a rod are multiples of these.
    parts: Vec<usize>,
    /// Whether every probe is at an end of elements in all of these meshes.
    aligned: bool,
}

impl Plan {
    /// For a scene with probes.
    pub(super) fn new(scene: &Scene, accuracy: f64) -> Result<Self, Error> {
        let (parts, aligned) = admissible(scene)?;
        let most = if aligned { usize::MAX } else { MOST_INSIDE };
        let degree = degree(accuracy).min(most);
        let mut chosen = scene.clone();
        for (index, rod) in chosen.rod.iter_mut().enumerate() {
            let curve = PlacedCurve::new(&rod.curve, &format!("rod.{index}.curve"))?;
            rod.degree = match (rod.interpolation, curve.given_poses()) {
                (InterpolationKind::R12, None) => degree,
                (InterpolationKind::R12, Some(poses)) => ((poses - 1) / FEWEST_ELEMENTS).clamp(1, degree),
                _ => rod.degree,
            };
        }
        let milestones = match &mut chosen.dynamics {
            Some(options) => {
                options.tolerance = None;
                Milestones::in_time(options.end_time, &[options.end_time / IN_TIME])
            }
            None => {
                let statics = chosen.statics.get_or_insert_with(Statics::default);
                (statics.increments, statics.tolerance) = (None, None);
                Milestones::on_path(&[])
            }
        };
        Ok(Self { scene: chosen, milestones, parts, aligned })
    }

    /// With the settings that all levels share.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn milestones(&self) -> &Milestones {
        &self.milestones
    }

    /// The coarsest level: elements by the turn of the reference curve, and not fewer than the scene's proportions ask
    /// for beside the other rods.
    pub(super) fn first(&self) -> Result<Level, Error> {
        let mut by_turn = Vec::new();
        for (index, rod) in self.scene.rod.iter().enumerate() {
            let turn = turn(&PlacedCurve::new(&rod.curve, &format!("rod.{index}.curve"))?);
            by_turn.push((turn / (FIRST_TURN * rod.degree as f64)).max(1.0));
        }
        let most = by_turn.iter().fold(1.0_f64, |a, &b| a.max(b));
        let written = self.scene.rod.iter().map(|rod| rod.elements as f64);
        let largest = written.clone().fold(1.0_f64, f64::max);
        let elements = written.zip(&by_turn).zip(&self.parts).map(|((written, turn), parts)| {
            let wanted = turn.max(most * written / largest);
            // Saturates; a mesh of such a size is refused by the scene's validation.
            ((wanted / *parts as f64 - 1e-9).ceil().max(1.0) as usize).saturating_mul(*parts)
        });
        Ok(Level { elements: elements.collect(), steps: 1 })
    }

    /// The next finer level.
    pub(super) fn finer(&self, level: &Level, refined: Refined) -> Level {
        let linear = self.scene.rod.iter().any(|rod| rod.degree == 1);
        let finer = if self.aligned { FINER } else { FINER_INSIDE };
        self.grown(level, refined, if linear { DOUBLED } else { finer })
    }

    /// Twice as fine, for where a level failed.
    pub(super) fn doubled(&self, level: &Level, refined: Refined) -> Level {
        self.grown(level, refined, DOUBLED)
    }

    fn grown(&self, level: &Level, refined: Refined, [numerator, denominator]: [usize; 2]) -> Level {
        match refined {
            Refined::Mesh => {
                let grow = |(elements, parts): (&usize, &usize)| {
                    (elements / parts).saturating_mul(numerator).div_ceil(denominator).saturating_mul(*parts)
                };
                Level { elements: level.elements.iter().zip(&self.parts).map(grow).collect(), ..*level }
            }
            Refined::Step => Level { elements: level.elements.clone(), steps: level.steps.saturating_mul(2) },
        }
    }

    /// The scene of a level, validated.
    pub(super) fn variant(&self, level: &Level) -> Result<Scene, SceneError> {
        let time_step = self.scene.dynamics.as_ref().map(|_| self.milestones.step_of(level.steps));
        let elements = Some(level.elements.clone());
        Settings { elements, time_step, ..Settings::default() }.apply(&self.scene)
    }

    /// Scalar unknowns of a level, those of multipliers and supports aside.
    pub(super) fn unknowns(&self, level: &Level) -> f64 {
        let rods = self.scene.rod.iter().zip(&level.elements);
        let nodes: f64 = rods.map(|(rod, elements)| rod.degree as f64 * *elements as f64 + 1.0).sum();
        6.0 * (nodes + self.scene.body.len() as f64)
    }

    /// How far observed orders are believed: 2 of generalized-α and 5 of Radau IIA, and half an order more; 2p at ends of
    /// elements, and an order more, for coarse meshes converge faster at first. Full quadrature locks, and meshes that
    /// have just come free of it converge unevenly. Probes inside elements sit at another place of their element in
    /// every mesh, and errors there, of order p + 1, vary with the place: that of the last mesh may be as large as that
    /// of the mesh before, and the distance less than either.
    pub(super) fn belief(&self, refined: Refined) -> Belief {
        let degree = self.scene.rod.iter().map(|rod| rod.degree).max().unwrap_or(1) as f64;
        let locks = self.scene.rod.iter().any(|rod| rod.quadrature == QuadratureKind::Full);
        match (refined, self.scene.analysis()) {
            (Refined::Step, Some(Analysis::Dynamics(options))) if options.method == Method::Radau => {
                Belief::up_to(5.5)
            }
            (Refined::Step, _) => Belief::up_to(2.5),
            (Refined::Mesh, _) if !self.aligned => Belief::little(degree + 1.0, 1.5),
            (Refined::Mesh, _) if locks => Belief::little(2.0 * degree, 1.0),
            (Refined::Mesh, _) => Belief::up_to(2.0 * degree + 1.0),
        }
    }
}

/// The degree with the least work on the way to an accuracy: a degree more divides the elements, but makes each dearer
/// with its third power or so.
fn degree(accuracy: f64) -> usize {
    match accuracy {
        accuracy if accuracy >= 1e-3 => 3,
        accuracy if accuracy >= 1e-7 => 4,
        _ => 6,
    }
}

/// For every rod the number whose multiples keep joints and loads, and if it is not too large probes, at ends of
/// elements, and whether it is so for probes.
fn admissible(scene: &Scene) -> Result<(Vec<usize>, bool), Error> {
    let held = admissible_elements(scene)?;
    let mut probed = scene.clone();
    // A load asks for what a probe needs.
    probed.load.extend(scene.probe.iter().map(|probe| Load {
        kind: LoadKind::Force,
        on: probe.on.clone(),
        value: [0.0; 3],
        basis: Basis::Inertial,
        offset: None,
        time: None,
    }));
    match admissible_elements(&probed) {
        Ok(parts) if parts.iter().zip(&held).all(|(parts, held)| parts == held || *parts <= MOST_PARTS) => {
            Ok((parts, true))
        }
        _ => Ok((held, false)),
    }
}

/// The angle by which the frame of a curve turns from end to end [rad].
fn turn(curve: &PlacedCurve) -> f64 {
    let Some(poses) = curve.given_poses() else { return curve.total_turn().abs() };
    let rotations: Vec<Matrix3<f64>> =
        (0..poses).map(|k| curve.pose(k as f64 / (poses - 1) as f64).rotation).collect();
    let angle = |pair: &[Matrix3<f64>]| {
        let cosine = 0.5 * ((pair[0].transpose() * pair[1]).trace() - 1.0);
        cosine.clamp(-1.0, 1.0).acos()
    };
    rotations.windows(2).map(angle).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPRING: &str = r#"
[[rod]]
name = "spring"
curve = { kind = "helix", coils = 10, radius = 10e-3, pitch = 5e-3 }
section = { kind = "circle", diameter = 1e-3 }
material = { young_modulus = 1e11, poisson_ratio = 0.2 }
elements = 60
degree = 2
[[rod]]
name = "stem"
curve = { kind = "line", from = [0, 0, 0], to = [0, 0, 1] }
section = { kind = "circle", diameter = 1e-2 }
material = { young_modulus = 1e11, poisson_ratio = 0.2 }
elements = 6
degree = 1
interpolation = "se3"
[[joint]]
kind = "rigid"
between = ["ground", "spring@0"]
[[joint]]
kind = "rigid"
between = ["ground", "stem@0.5"]
"#;

    fn plan(text: &str, accuracy: f64) -> Plan {
        let scene = Scene::from_toml(&format!("{SPRING}{text}[statics]\nincrements = 7\ntolerance = 1e-8\n"))
            .unwrap();
        Plan::new(&scene, accuracy).unwrap()
    }

    fn probe(on: &str) -> String {
        format!("[[probe]]\nname = {:?}\non = {on:?}\n", on.replace('@', " at "))
    }

    /// 63 rad of helix by 0.8 rad a degree; a tenth of that for the other rod, an even number.
    #[test]
    fn the_first_mesh_follows_the_turn_of_the_curve() {
        for (accuracy, degree, elements) in [(1e-2, 3, [27, 4]), (1e-4, 4, [20, 2]), (1e-8, 6, [14, 2])] {
            let plan = plan("", accuracy);
            let variant = plan.variant(&plan.first().unwrap()).unwrap();
            assert_eq!([&variant.rod[0], &variant.rod[1]].map(|rod| rod.elements), elements, "{accuracy}");
            // SE(3) has no other degree.
            assert_eq!([&variant.rod[0], &variant.rod[1]].map(|rod| rod.degree), [degree, 1]);
            let statics = variant.statics.unwrap();
            assert_eq!((statics.increments, statics.tolerance), (None, None));
        }
    }

    #[test]
    fn every_rod_is_refined_every_time() {
        let mut plan = plan("", 1e-4);
        plan.scene.rod[1].degree = 4;
        let mut level = plan.first().unwrap();
        for _ in 0..6 {
            let finer = plan.finer(&level, Refined::Mesh);
            for (before, after) in level.elements.iter().zip(&finer.elements) {
                let growth = *after as f64 / *before as f64;
                assert!((1.33..=2.0).contains(&growth), "{before} {after}");
            }
            assert_eq!(finer.elements[1] % 2, 0);
            level = finer;
        }
    }

    #[test]
    fn probes_are_at_ends_of_elements_where_few_do() {
        let belief = |probes: &str| plan(probes, 1e-4).belief(Refined::Mesh);
        assert_eq!(belief(&probe("spring@1")), Belief::up_to(9.0));
        let tenths = probe("spring@0.1") + &probe("spring@0.5");
        assert_eq!(belief(&tenths), Belief::up_to(9.0));
        assert_eq!(plan(&tenths, 1e-4).parts, [10, 2]);
        // 37 is too many; 1/π is no fraction.
        for odd in [probe("spring@0.1351351351351351"), probe("stem@0.3183098861837907")] {
            let plan = plan(&odd, 1e-4);
            assert_eq!((plan.aligned, &plan.parts[..]), (false, &[1, 2][..]));
            assert_eq!(plan.belief(Refined::Mesh), Belief::little(5.0, 1.5));
        }
    }
}
