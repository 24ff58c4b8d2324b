//! What serde cannot see and what needs no geometry: ranges, combinations, names, references.

mod check;
mod rod;
mod section;

use std::collections::HashMap;

use toml::Value;

use super::read::refuse_non_finite;
use super::{Joint, JointKind, Load, LoadKind, LoadTime, Scene};
use crate::rod::NODE_TOLERANCE;
use check::{Check, at_least_one, fail, finite_number, known, non_zero, positive, quoted};

impl Scene {
    /// Checks everything that can be checked without building the model.
    ///
    /// # Errors
    /// [`crate::SceneError`] for the first entry that is wrong; its key is the path in the scene file.
    pub fn validate(&self) -> Check {
        finite(self)?;
        if self.rod.is_empty() {
            return fail("rod", "is missing", "at least one `[[rod]]`");
        }
        names(self)?;
        for (index, rod) in self.rod.iter().enumerate() {
            let key = format!("rod.{index}");
            rod::rod(rod, &key)?;
            if self.gravity.is_some_and(|gravity| gravity != [0.0; 3]) && rod.gravity {
                section::weight(rod, &key)?;
            }
        }
        for (index, joint) in self.joint.iter().enumerate() {
            self.validate_joint(joint, &format!("joint.{index}"))?;
        }
        for (index, load) in self.load.iter().enumerate() {
            self.validate_load(load, &format!("load.{index}"))?;
        }
        for (index, probe) in self.probe.iter().enumerate() {
            self.validate_point(&probe.on, &format!("probe.{index}.on"))?;
        }
        self.validate_statics()
    }

    /// The name of a joint of the scene: its own, or `joint1`, `joint2`, … in order.
    pub fn joint_name(&self, index: usize) -> String {
        self.joint
            .get(index)
            .and_then(|joint| joint.name.clone())
            .unwrap_or_else(|| format!("joint{}", index + 1))
    }

    fn validate_joint(&self, joint: &Joint, key: &str) -> Check {
        let between = format!("{key}.between");
        let grounded = joint.between.iter().filter(|part| *part == "ground").count();
        match grounded {
            0 => {
                for (end, part) in joint.between.iter().enumerate() {
                    self.validate_point(part, &format!("{between}.{end}")).map_err(|mut error| {
                        error.expected.push_str(", or \"ground\"");
                        error
                    })?;
                }
                return fail(
                    between,
                    "joins two points of rods, which is not available yet",
                    "\"ground\" as one of the two",
                );
            }
            1 => {}
            _ => {
                return fail(between, "joins the ground to itself", "\"ground\" and a point \"rod@ξ\"");
            }
        }
        for (end, part) in joint.between.iter().enumerate() {
            if part != "ground" {
                self.validate_point(part, &format!("{between}.{end}"))?;
            }
        }
        let axis = format!("{key}.axis");
        match (joint.kind, &joint.axis) {
            (JointKind::Revolute, None) => {
                fail(axis, "is missing", "the axis `[x, y, z]` of the revolute joint")
            }
            (JointKind::Revolute, Some(direction)) => {
                non_zero(&axis, direction, "a direction other than zero")
            }
            (_, Some(_)) => {
                fail(axis, "is given, but the joint is not revolute", "an axis for revolute joints only")
            }
            (_, None) => Ok(()),
        }
    }

    fn validate_load(&self, load: &Load, key: &str) -> Check {
        let on = format!("{key}.on");
        match load.kind {
            LoadKind::Force | LoadKind::Moment => self.validate_point(&load.on, &on)?,
            LoadKind::LineForce | LoadKind::LineMoment => {
                if let Some((name, _)) = load.on.rsplit_once('@') {
                    return fail(
                        on,
                        format!("is the point {:?}, but a line load acts along the rod", load.on),
                        format!("the rod's name alone, {name:?}"),
                    );
                }
                known(&on, &load.on, &self.rod_names(), "")?;
            }
        }
        if load.offset.is_some() && load.kind != LoadKind::Force {
            return fail(
                format!("{key}.offset"),
                "is given, but the load is not a force",
                "a lever for loads of kind \"force\" only",
            );
        }
        match &load.time {
            Some(LoadTime::Table(rows)) => time_table(rows, &format!("{key}.time")),
            _ => Ok(()),
        }
    }

    /// `rod@ξ` with a known rod and ξ in [0, 1].
    fn validate_point(&self, on: &str, key: &str) -> Check {
        let Some((name, xi)) = parse_point(on) else {
            let rod = self.rod.iter().find(|rod| rod.name == on);
            let example = rod.or(self.rod.first()).map_or("rod", |rod| &rod.name);
            return fail(
                key,
                format!("is {on:?}, which is no point of a rod"),
                format!("a rod and ξ from 0 to 1, such as \"{example}@1\""),
            );
        };
        known(key, name, &self.rod_names(), &on[name.len()..])?;
        // As near to an end as a node may be to its ξ.
        if !(-NODE_TOLERANCE..=1.0 + NODE_TOLERANCE).contains(&xi) {
            return fail(key, format!("is {on:?}, beyond the ends of the rod"), "ξ from 0 to 1");
        }
        Ok(())
    }

    fn rod_names(&self) -> Vec<String> {
        self.rod.iter().map(|rod| rod.name.clone()).collect()
    }

    fn validate_statics(&self) -> Check {
        let Some(statics) = &self.statics else {
            return fail(
                "statics",
                "is missing, so the scene asks for nothing",
                "the table `[statics]`, which may be empty",
            );
        };
        if let Some(increments) = statics.increments {
            at_least_one("statics.increments", increments, "increments")?;
        }
        if let Some(tolerance) = statics.tolerance {
            positive("statics.tolerance", tolerance, "a positive tolerance [N, N m]")?;
        }
        at_least_one("statics.max_iterations", statics.max_iterations, "iterations")
    }
}

/// Splits `rod@ξ`; ξ is finite, but may lie outside [0, 1].
pub(crate) fn parse_point(on: &str) -> Option<(&str, f64)> {
    let (name, xi) = on.rsplit_once('@')?;
    let xi: f64 = xi.parse().ok()?;
    (!name.is_empty() && xi.is_finite()).then_some((name, xi))
}

/// No infinity and no NaN, wherever in the scene: the scene file's form has all numbers by their key.
fn finite(scene: &Scene) -> Check {
    match Value::try_from(scene) {
        Ok(document) => refuse_non_finite(&document),
        Err(error) => fail("scene", error.to_string(), "entries that a scene file can hold"),
    }
}

fn names(scene: &Scene) -> Check {
    let rods = scene.rod.iter().map(|rod| rod.name.clone());
    unique("rod", rods)?;
    if let Some(index) = scene.rod.iter().position(|rod| rod.name == "ground") {
        return fail(
            format!("rod.{index}.name"),
            "is \"ground\", which is what joints call the fixed world",
            "another name",
        );
    }
    unique("joint", (0..scene.joint.len()).map(|index| scene.joint_name(index)))?;
    unique("probe", scene.probe.iter().map(|probe| probe.name.clone()))
}

/// Names are prefixes of columns and parts of file names, and `@` ends the name of a rod.
fn unique(table: &str, names: impl Iterator<Item = String>) -> Check {
    let mut seen = HashMap::new();
    for (index, name) in names.enumerate() {
        let key = format!("{table}.{index}.name");
        if name.is_empty() {
            return fail(key, "is empty", "a name");
        }
        let forbidden = |c: &char| matches!(c, '@' | ',' | '"' | '/') || c.is_control();
        if let Some(character) = name.chars().find(forbidden) {
            return fail(
                key,
                format!("is {} and contains {character:?}", quoted(&name)),
                "a name without @, comma, quotation mark, slash and control characters",
            );
        }
        if let Some(first) = seen.insert(name.clone(), index) {
            return fail(
                key,
                format!("is {}, the name of `{table}.{first}` too", quoted(&name)),
                format!("a different name for every {table}"),
            );
        }
    }
    Ok(())
}

fn time_table(rows: &[[f64; 2]], key: &str) -> Check {
    if rows.is_empty() {
        return fail(key, "is empty", "at least one row `[t, factor]`");
    }
    for (index, pair) in rows.windows(2).enumerate() {
        let ([before, _], [time, _]) = (pair[0], pair[1]);
        if time <= before {
            return fail(
                format!("{key}.{}.0", index + 1),
                format!("is {}, after {}", finite_number(time), finite_number(before)),
                "times that increase from row to row",
            );
        }
    }
    Ok(())
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
    fn points_are_split_at_the_last_at() {
        assert_eq!(parse_point("a@0.5"), Some(("a", 0.5)));
        assert_eq!(parse_point("a@1e-3"), Some(("a", 1e-3)));
        for wrong in ["a", "@1", "a@", "a@x", "a@nan", "a@inf"] {
            assert_eq!(parse_point(wrong), None, "{wrong}");
        }
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
