//! Variants of a scene.

use crate::error::SceneError;
use crate::scene::{
    Dynamics, Increments, InterpolationKind, Reference, Rod, Scene, Statics, Step, Tolerance,
};

/// What a variant of a scene changes; what is absent stays as the scene has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// The polynomial degree of all rods.
    pub degree: Option<usize>,
    /// The elements of every rod, in the scene's order.
    pub elements: Option<Vec<usize>>,
    /// The interpolation of all rods.
    pub interpolation: Option<InterpolationKind>,
    /// Load increments; statics only.
    pub increments: Option<Increments>,
    /// Constant time step [s]; dynamics only.
    pub time_step: Option<f64>,
    /// When Newton's iteration ends.
    pub tolerance: Option<Tolerance>,
}

impl Settings {
    /// The variant of a scene ([`Settings::change`]), validated; whether joints and loads sit on nodes is found when
    /// the model is built.
    ///
    /// # Errors
    /// [`SceneError`] for what the scene does not have (a time step in statics) or does not allow (degree 2 with
    /// SE(3)); its key is the path in the scene file.
    pub fn apply(&self, scene: &Scene) -> Result<Scene, SceneError> {
        let variant = self.change(scene)?;
        variant.validate()?;
        Ok(variant)
    }

    /// The variant of a scene, whether it makes sense or not.
    ///
    /// A rod whose reference is fitted to samples of its curve keeps their number where that is enough for the nodes
    /// of the variant; otherwise they grow in proportion to the nodes.
    ///
    /// # Errors
    /// [`SceneError`] for what the scene does not have, such as a time step in statics.
    pub fn change(&self, scene: &Scene) -> Result<Scene, SceneError> {
        let mut variant = scene.clone();
        if let Some(elements) = &self.elements
            && elements.len() != scene.rod.len()
        {
            let problem = format!("has {} numbers for {} rods", elements.len(), scene.rod.len());
            return Err(SceneError::new("study.elements", problem, "one number for every rod"));
        }
        for (index, rod) in variant.rod.iter_mut().enumerate() {
            let nodes = nodes(rod);
            if let Some(elements) = &self.elements {
                rod.elements = elements[index];
            }
            rod.degree = self.degree.unwrap_or(rod.degree);
            rod.interpolation = self.interpolation.unwrap_or(rod.interpolation);
            keep_fit_determined(rod, nodes);
        }
        self.apply_to_analysis(&mut variant)?;
        Ok(variant)
    }

    fn apply_to_analysis(&self, variant: &mut Scene) -> Result<(), SceneError> {
        let statics = &mut variant.statics;
        if let Some(increments) = self.increments {
            let Some(options) = statics.as_mut() else {
                return Err(foreign("increments", "[statics]"));
            };
            options.increments = match increments {
                Increments::Equal(count) => Some(count),
                Increments::Automatic => None,
            };
        }
        if let Some(time_step) = self.time_step {
            let Some(options) = variant.dynamics.as_mut() else {
                return Err(foreign("time_step", "[dynamics]"));
            };
            set_time_step(options, time_step);
        }
        let Some(tolerance) = self.tolerance else { return Ok(()) };
        let tolerance = match tolerance {
            Tolerance::Relative => None,
            Tolerance::Absolute(tolerance) => Some(tolerance),
        };
        match (statics, &mut variant.dynamics) {
            (Some(Statics { tolerance: of_scene, .. }), _) => *of_scene = tolerance,
            (None, Some(options)) => options.tolerance = tolerance,
            (None, None) => return Err(foreign("tolerance", "[statics] or [dynamics]")),
        }
        Ok(())
    }
}

/// The constant time step of a motion, if it has one [s].
pub(super) fn time_step(options: &Dynamics) -> Option<f64> {
    options.time_step()
}

fn set_time_step(options: &mut Dynamics, time_step: f64) {
    options.step = Step::Constant(time_step);
}

/// A setting of an analysis that the scene does not have.
fn foreign(name: &str, analysis: &str) -> SceneError {
    let problem = "is given, but the scene has no such setting";
    SceneError::new(format!("study.{name}"), problem, format!("`{name}` only beside `{analysis}`"))
}

/// Of a valid rod, or of one whose validation will refuse it.
fn nodes(rod: &Rod) -> usize {
    rod.elements.saturating_mul(rod.degree).saturating_add(1)
}

/// A fit to fewer samples than nodes has no unique answer, and one to the same number follows no curve any better.
fn keep_fit_determined(rod: &mut Rod, nodes_before: usize) {
    let nodes = nodes(rod);
    if let Reference::Fit { samples } = &mut rod.reference
        && *samples < nodes
    {
        let scaled = (*samples as u128 * nodes as u128).div_ceil(nodes_before as u128);
        *samples = usize::try_from(scaled).unwrap_or(usize::MAX).max(nodes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(analysis: &str) -> Scene {
        let rod = r#"
[[rod]]
name = "arc"
curve = { kind = "arc", radius = 1.0, angle = 1.0 }
section = { kind = "circle", diameter = 0.01 }
material = { young_modulus = 2e11, poisson_ratio = 0.3, density = 7850 }
elements = 4
degree = 2
reference = { kind = "fit", samples = 19 }
[[joint]]
kind = "rigid"
between = ["ground", "arc@0"]
"#;
        Scene::from_toml(&format!("{rod}\n{analysis}\n")).unwrap()
    }

    #[test]
    fn every_setting_arrives() {
        let settings = Settings {
            degree: Some(1),
            elements: Some(vec![7]),
            interpolation: Some(InterpolationKind::Se3),
            increments: Some(Increments::Equal(30)),
            tolerance: Some(Tolerance::Absolute(1e-7)),
            time_step: None,
        };
        let variant = settings.apply(&scene("[statics]")).unwrap();
        let rod = &variant.rod[0];
        assert_eq!((rod.degree, rod.elements, rod.interpolation), (1, 7, InterpolationKind::Se3));
        let statics = variant.statics.as_ref().unwrap();
        assert_eq!((statics.increments, statics.tolerance), (Some(30), Some(1e-7)));
        assert_eq!(rod.reference, Reference::Fit { samples: 19 });
        let motion = scene("[dynamics]\nend_time = 1.0\ntime_step = 0.1");
        let settings = Settings { time_step: Some(0.05), ..Settings::default() };
        assert_eq!(settings.apply(&motion).unwrap().dynamics.unwrap().time_step(), Some(0.05));
        assert_eq!(Settings::default().apply(&motion).unwrap(), motion);
    }

    #[test]
    fn samples_grow_only_where_they_must() {
        for (elements, samples) in [(9, 19), (10, 45), (40, 171)] {
            let settings = Settings { elements: Some(vec![elements]), ..Settings::default() };
            let variant = settings.apply(&scene("[statics]")).unwrap();
            assert_eq!(variant.rod[0].reference, Reference::Fit { samples }, "{elements}");
        }
    }

    #[test]
    fn what_the_scene_has_not_is_refused() {
        let refused = |settings: Settings, analysis: &str| settings.apply(&scene(analysis)).unwrap_err().key;
        let time_step = Settings { time_step: Some(0.1), ..Settings::default() };
        assert_eq!(refused(time_step, "[statics]"), "study.time_step");
        let increments = Settings { increments: Some(Increments::Equal(3)), ..Settings::default() };
        assert_eq!(refused(increments, "[modes]\ncount = 1"), "study.increments");
        let tolerance = Settings { tolerance: Some(Tolerance::Relative), ..Settings::default() };
        assert_eq!(refused(tolerance, "[modes]\ncount = 1"), "study.tolerance");
        let elements = Settings { elements: Some(vec![1, 2]), ..Settings::default() };
        assert_eq!(refused(elements, "[statics]"), "study.elements");
        let se3 = Settings { interpolation: Some(InterpolationKind::Se3), ..Settings::default() };
        assert_eq!(refused(se3, "[statics]"), "rod.0.interpolation");
    }
}
