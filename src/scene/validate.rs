//! What serde cannot see and what needs no geometry: ranges, combinations, names, references.

mod analysis;
mod body;
mod check;
mod names;
mod parts;
mod rod;
mod section;
mod study;

use toml::Value;

use super::Scene;
use super::read::refuse_non_finite;
pub(super) use analysis::{one_analysis, one_step};
use check::{Check, fail};

impl Scene {
    /// Checks everything that can be checked without building the model.
    ///
    /// # Errors
    /// [`crate::SceneError`] for the first entry that is wrong; its key is the path in the scene file.
    pub fn validate(&self) -> Check {
        finite(self)?;
        if self.rod.is_empty() && self.body.is_empty() {
            return fail("rod", "is missing", "at least one `[[rod]]` or `[[body]]`");
        }
        one_analysis([self.statics.is_some(), self.dynamics.is_some(), self.modes.is_some()])?;
        names::names(self)?;
        for (index, rod) in self.rod.iter().enumerate() {
            let key = format!("rod.{index}");
            rod::rod(rod, &key)?;
            section::mass(self, rod, &key)?;
        }
        for (index, body) in self.body.iter().enumerate() {
            body::body(body, &format!("body.{index}"))?;
        }
        for index in 0..self.joint.len() {
            parts::joint(self, index)?;
        }
        for index in 0..self.load.len() {
            parts::load(self, index)?;
        }
        for index in 0..self.probe.len() {
            parts::probe(self, index)?;
        }
        analysis::analysis(self)?;
        study::study(self)
    }
}

/// No infinity and no NaN, wherever in the scene: the scene file's form has all numbers by their key.
fn finite(scene: &Scene) -> Check {
    match Value::try_from(scene) {
        Ok(document) => refuse_non_finite(&document),
        Err(error) => fail("scene", error.to_string(), "entries that a scene file can hold"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Plot, Reference};

    const SCENE: &str = r#"
[[rod]]
name = "beam"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 0.01 }
material = { young_modulus = 2e11, poisson_ratio = 0.3 }
elements = 4
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "beam@0"]
[statics]
"#;

    fn scene() -> Scene {
        Scene::from_toml(SCENE).unwrap()
    }

    #[test]
    fn literals_are_checked_for_finite_numbers() {
        let mut wrong = scene();
        wrong.rod[0].curve.origin[1] = f64::NAN;
        assert_eq!(wrong.validate().unwrap_err().key, "rod.0.curve.origin.1");
        let mut wrong = scene();
        wrong.plot = Some(Plot { slope: Some(f64::INFINITY) });
        assert_eq!(wrong.validate().unwrap_err().key, "plot.slope");
    }

    #[test]
    fn literals_with_huge_integers_are_refused() {
        let mut wrong = scene();
        wrong.rod[0].elements = usize::MAX;
        assert!(wrong.validate().is_err());
        let mut wrong = scene();
        wrong.rod[0].reference = Reference::Fit { samples: usize::MAX };
        assert!(wrong.validate().is_err());
    }

    #[test]
    fn a_joint_without_name_is_numbered() {
        assert_eq!(scene().joint_name(0), "joint1");
    }

    #[test]
    fn moduli_may_imply_the_limits_of_poissons_ratio_but_not_more() {
        let mut scene = scene();
        let mut with = |young, shear| {
            let material = scene.rod[0].material.as_mut().unwrap();
            material.young_modulus = Some(young);
            material.shear_modulus = Some(shear);
            material.poisson_ratio = None;
            scene.validate()
        };
        assert_eq!(with(3.0e9, 1.0e9), Ok(()));
        assert_eq!(with(1.0e9, 1.0e9), Ok(()));
        assert!(with(3.1e9, 1.0e9).is_err());
    }

    #[test]
    fn an_error_of_a_literal_has_no_place() {
        let mut wrong = scene();
        wrong.rod[0].elements = 0;
        let error = wrong.validate().unwrap_err();
        assert_eq!(
            error.to_string(),
            "`rod.0.elements`: is 0; expected at least 1 and at most 10000000 elements"
        );
    }
}
