//! A whole study: what is run, against which reference, and at which milestones.

use crate::error::SceneError;
use crate::scene::{Analysis, Increments, Scene};
use crate::solution::Statistics;
use crate::study::ladder::{STEP, ladder};
use crate::study::mesh::admissible_elements;
use crate::study::milestones::no_path;
use crate::study::reference::{Finest, Reference, find_reference, with_probes};
use crate::study::trial::{Stop, Trial, solve, time};
use crate::study::{Key, Milestones, Row, SOLVED, Settings, compare};

/// Accuracies that are asked for where the scene names none.
const ACCURACIES: [f64; 3] = [1e-2, 1e-4, 1e-6];
/// The same in dynamics, whose time error falls slowly.
const ACCURACIES_IN_TIME: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// The reference shall be better than the best accuracy that is asked for, so many times.
const BETTER: f64 = 10.0;
/// A run whose processor time is below this is repeated [s].
const SHORT: f64 = 0.05;

/// A study of one scene.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene that is varied, with probes.
    scene: Scene,
    milestones: Milestones,
    admissible: Vec<usize>,
    runs: Vec<(Settings, Key)>,
    finest: Finest,
    accuracies: Vec<f64>,
}

impl Plan {
    /// Plans the study of a validated scene.
    ///
    /// # Errors
    /// [`SceneError`] if the scene asks for modes, or has a joint or load on a node that other meshes do not have.
    pub fn new(scene: &Scene) -> Result<Self, SceneError> {
        let mut scene = with_probes(scene);
        let study = scene.study.clone().unwrap_or_default();
        let admissible = admissible_elements(&scene)?;
        let (milestones, equal) = match scene.analysis() {
            Some(Analysis::Modes(_)) => return Err(no_path()),
            Some(Analysis::Dynamics(options)) => {
                let steps = ladder(&scene, &admissible, 0);
                let steps: Vec<f64> = steps.iter().filter_map(|settings| settings.time_step).collect();
                (Milestones::in_time(options.end_time, &steps), 0)
            }
            Some(Analysis::Statics(_)) | None => {
                let milestones = Milestones::on_path(&equal_increments(&scene));
                (milestones, milestones.count())
            }
        };
        let mut settings = ladder(&scene, &admissible, equal);
        scene.study = None;
        for settings in &mut settings {
            settings.time_step = settings.time_step.map(|step| milestones.step(step));
        }
        let mut runs: Vec<(Settings, Key)> = Vec::with_capacity(settings.len());
        for settings in settings {
            let key = Key::of(&settings.change(&scene)?);
            // Another way to say the same: the scene's own settings are among those of the ladder.
            if !runs.iter().any(|(_, other)| *other == key) {
                runs.push((settings, key));
            }
        }
        let mut finest = finest(&scene, &runs);
        if let (Some(options), None) = (&scene.dynamics, finest.time_step) {
            finest.time_step = Some(milestones.step(STEP * options.end_time));
        }
        let accuracies = match (study.accuracies, &scene.dynamics) {
            (Some(accuracies), _) => accuracies,
            (None, Some(_)) => ACCURACIES_IN_TIME.to_vec(),
            (None, None) => ACCURACIES.to_vec(),
        };
        Ok(Self { scene, milestones, admissible, runs, finest, accuracies })
    }

    /// The scene that is varied, with probes and without the lists of the study.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where all runs are compared.
    pub fn milestones(&self) -> &Milestones {
        &self.milestones
    }

    /// The settings of the runs, in order.
    pub fn keys(&self) -> impl ExactSizeIterator<Item = &Key> {
        self.runs.iter().map(|(_, key)| key)
    }

    /// The accuracies that advice is wanted for.
    pub fn accuracies(&self) -> &[f64] {
        &self.accuracies
    }

    /// Finds the reference; `progress` hears the number of the run towards it beside what [`solve`] tells.
    ///
    /// # Errors
    /// As [`find_reference`].
    pub fn reference(&self, progress: &mut dyn FnMut(usize, f64, &Statistics)) -> Result<Reference, Stop> {
        let goal = self.accuracies.iter().copied().fold(f64::INFINITY, f64::min) / BETTER;
        find_reference(&self.scene, &self.milestones, &self.finest, &self.admissible, goal, progress)
    }

    /// Does the run `index`; a failure is a row, too.
    pub fn run(
        &self,
        index: usize,
        reference: &Reference,
        progress: &mut dyn FnMut(f64, &Statistics),
    ) -> Row {
        let (settings, key) = &self.runs[index];
        match self.measured(settings, progress) {
            Ok((trial, statistics, seconds)) => {
                let errors = compare(&trial.trajectory, &reference.trajectory);
                Row {
                    key: key.clone(),
                    errors,
                    seconds: Some(seconds),
                    newton_iterations: Some(statistics.newton_iterations),
                    factorizations: Some(statistics.factorizations),
                    status: SOLVED.to_owned(),
                }
            }
            Err(stop) => {
                let spent = match &stop {
                    Stop::Solver(failure) => Some(&failure.partial.statistics),
                    Stop::Setup(_) => None,
                };
                Row {
                    key: key.clone(),
                    errors: None,
                    seconds: None,
                    newton_iterations: spent.map(|work| work.newton_iterations),
                    factorizations: spent.map(|work| work.factorizations),
                    status: stop.to_string(),
                }
            }
        }
    }

    /// The run through the milestones, and work and processor time of a plain one. They are the same run, unless
    /// automatic increments or steps go out of their way to the milestones, or it is so short that it is repeated.
    fn measured(
        &self,
        settings: &Settings,
        progress: &mut dyn FnMut(f64, &Statistics),
    ) -> Result<(Trial, Statistics, f64), Stop> {
        let variant = settings.apply(&self.scene).map_err(|error| Stop::Setup(error.into()))?;
        let trial = solve(&variant, &self.milestones, progress)?;
        let automatic = match variant.analysis() {
            Some(Analysis::Dynamics(options)) => options.time_step().is_none(),
            Some(Analysis::Statics(options)) => options.increments.is_none(),
            Some(Analysis::Modes(_)) | None => false,
        };
        let (statistics, seconds) = if automatic || trial.seconds < SHORT {
            time(&variant, &mut |_, _| ())?
        } else {
            (trial.statistics.clone(), trial.seconds)
        };
        Ok((trial, statistics, seconds))
    }
}

/// All numbers of equal increments that are asked for.
fn equal_increments(scene: &Scene) -> Vec<usize> {
    let listed = scene.study.iter().filter_map(|study| study.increments.as_ref()).flatten();
    let listed = listed.filter_map(|increments| match increments {
        Increments::Equal(count) => Some(*count),
        Increments::Automatic => None,
    });
    let own = scene.statics.as_ref().and_then(|options| options.increments);
    let listed: Vec<usize> = listed.collect();
    let replaced = scene.study.as_ref().is_some_and(|study| study.increments.is_some());
    if replaced { listed } else { own.into_iter().collect() }
}

/// The finest of the runs that make sense.
fn finest(scene: &Scene, runs: &[(Settings, Key)]) -> Finest {
    let mut finest = Finest { intervals: vec![1; scene.rod.len()], degree: 1, time_step: None };
    for variant in runs.iter().filter_map(|(settings, _)| settings.apply(scene).ok()) {
        for (intervals, rod) in finest.intervals.iter_mut().zip(&variant.rod) {
            *intervals = (rod.elements * rod.degree).max(*intervals);
            finest.degree = finest.degree.max(rod.degree);
        }
    }
    let steps = runs.iter().filter_map(|(settings, _)| settings.time_step);
    finest.time_step = steps.reduce(f64::min);
    finest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::InterpolationKind;

    const ROD: &str = r#"
[[rod]]
name = "rod"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 0.05 }
material = { young_modulus = 1e7, poisson_ratio = 0.3, density = 1000 }
elements = 6
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "rod@0.5"]
"#;

    fn plan(text: &str) -> (Scene, Plan) {
        let scene = Scene::from_toml(text).unwrap();
        let plan = Plan::new(&scene).unwrap();
        (scene, plan)
    }

    /// No run is asked for twice, the scene itself is among them, and every mesh has a node in the middle.
    #[test]
    fn selections_are_about_the_scene() {
        let motion = "[dynamics]\nend_time = 1.0\ntime_step = 0.01\n";
        for (analysis, count, milestones) in
            [("[statics]\n", 23, 10), ("[statics]\nincrements = 7\n", 23, 7), (motion, 24, 50)]
        {
            let (scene, plan) = plan(&format!("{ROD}{analysis}"));
            let keys: Vec<&Key> = plan.keys().collect();
            assert_eq!((keys.len(), plan.milestones().count()), (count, milestones), "{analysis}");
            assert!(keys.contains(&&Key::of(&scene)), "{analysis}");
            for (index, key) in keys.iter().enumerate() {
                assert!(!keys[..index].contains(key), "{key:?}");
                assert!(key.elements.is_some_and(|elements| elements % 2 == 0), "{key:?}");
            }
        }
    }

    #[test]
    fn bodies_alone_are_tried_with_many_steps() {
        let body = "[[body]]\nname = \"nut\"\nmass = 1.0\ninertia = [1, 2, 2.5]\nposition = [0, 0, 0]\n";
        let (_, plan) = plan(&format!("{body}[dynamics]\nend_time = 2.0\ntime_step = 0.01\n"));
        let steps: Vec<f64> = plan.keys().filter_map(|key| key.time_step).collect();
        assert_eq!(steps, [0.04, 0.02, 0.01, 0.005, 0.0025, 0.00125]);
        assert!(plan.keys().all(|key| key.elements.is_none() && key.degree.is_none()));
        assert_eq!(plan.scene().probe.len(), 1);
    }

    /// A motion whose steps follow an accuracy is tried as it is, and with constant steps; lists of other things leave
    /// it its accuracy. The reference has constant steps, whatever is tried.
    #[test]
    fn steps_may_follow_an_accuracy() {
        let motion = "[dynamics]\nend_time = 1.0\naccuracy = 1e-3\n";
        let (scene, selected) = plan(&format!("{ROD}{motion}"));
        let steps: Vec<_> = selected.keys().map(|key| key.time_step).collect();
        assert_eq!(selected.keys().next(), Some(&Key::of(&scene)));
        assert_eq!(steps.iter().filter(|step| step.is_none()).count(), 1);
        assert!(steps.contains(&Some(2.5e-3)), "{steps:?}");
        let (_, listed) = plan(&format!("{ROD}{motion}[study]\ndegree = [1, 2]\n"));
        assert!(listed.keys().len() == 2 && listed.keys().all(|key| key.time_step.is_none()));
        assert_eq!((listed.finest.time_step, listed.milestones().count()), (Some(2.5e-3), 100));
    }

    /// A list replaces the selection; steps that do not divide the end time are moved to the nearest that do.
    #[test]
    fn lists_are_combined() {
        let motion = "[dynamics]\nend_time = 1.0\ntime_step = 0.01\n[study]\n";
        let (_, listed) =
            plan(&format!("{ROD}{motion}degree = [1, 2]\ninterpolation = [\"r12\", \"se3\"]\n"));
        let kinds: Vec<_> = listed.keys().map(|key| (key.interpolation, key.degree)).collect();
        let [r12, se3] = [InterpolationKind::R12, InterpolationKind::Se3].map(Some);
        assert_eq!(kinds, [(r12, Some(1)), (r12, Some(2)), (se3, Some(1))]);
        assert!(listed.keys().all(|key| key.time_step == Some(0.01) && key.elements == Some(6)));
        let (_, moved) = plan(&format!("{ROD}{motion}time_step = [0.3, 0.15]\n"));
        let steps: Vec<_> = moved.keys().filter_map(|key| key.time_step).collect();
        assert_eq!(steps, [1.0 / 3.0, 1.0 / 6.0]);
    }
}
