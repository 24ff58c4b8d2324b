//! What the names in joints, loads and probes refer to, and which joints need multipliers.

use super::{Analysis, JointKind, Scene};
use crate::rod::NODE_TOLERANCE;

/// What a joint, a load or a probe refers to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Part {
    /// `"ground"`: the inertial basis.
    Ground,
    /// A body's name.
    Body(usize),
    /// `"rod@ξ"`.
    Rod {
        /// Index among the rods.
        index: usize,
        /// ξ; in a validated scene in [0, 1], to within the tolerance of nodes.
        xi: f64,
    },
}

impl Part {
    /// Whether two parts are the same body, the ground both, or at the same node: every ξ of a joint lies within the
    /// tolerance of its node.
    pub(crate) fn coincides(&self, other: &Part) -> bool {
        match (self, other) {
            (Part::Rod { index, xi }, Part::Rod { index: other, xi: other_xi }) => {
                index == other && (xi - other_xi).abs() <= 2.0 * NODE_TOLERANCE
            }
            _ => self == other,
        }
    }
}

impl Scene {
    /// What a name refers to; `None` where there is no such thing.
    pub(crate) fn part(&self, text: &str) -> Option<Part> {
        if text == "ground" {
            return Some(Part::Ground);
        }
        if let Some(index) = self.body.iter().position(|body| body.name == text) {
            return Some(Part::Body(index));
        }
        let (name, xi) = parse_point(text)?;
        let index = self.rod.iter().position(|rod| rod.name == name)?;
        Some(Part::Rod { index, xi })
    }

    /// Whether a joint needs multipliers. The others are *eliminated*: what they hold is no unknown. That is so
    /// between the ground and a rod's node that no other joint uses, in dynamics and modes only if it is rigid.
    pub(crate) fn multiplied(&self, joint: usize) -> bool {
        let Some(parts) = self.parts(joint) else {
            return false;
        };
        let node = match parts {
            [Part::Ground, node @ Part::Rod { .. }] | [node @ Part::Rod { .. }, Part::Ground] => node,
            _ => return true,
        };
        let eliminable = match self.analysis() {
            Some(Analysis::Dynamics(_) | Analysis::Modes(_)) => self.joint[joint].kind == JointKind::Rigid,
            _ => true,
        };
        let shared = (0..self.joint.len())
            .filter(|&other| other != joint)
            .filter_map(|other| self.parts(other))
            .any(|parts| parts.iter().any(|part| part.coincides(&node)));
        shared || !eliminable
    }

    /// Both parts of a joint.
    pub(crate) fn parts(&self, joint: usize) -> Option<[Part; 2]> {
        let [first, second] = &self.joint.get(joint)?.between;
        Some([self.part(first)?, self.part(second)?])
    }
}

/// Splits `rod@ξ`; ξ is finite, but may lie outside [0, 1].
pub(crate) fn parse_point(on: &str) -> Option<(&str, f64)> {
    let (name, xi) = on.rsplit_once('@')?;
    let xi: f64 = xi.parse().ok()?;
    (!name.is_empty() && xi.is_finite()).then_some((name, xi))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
[[rod]]
name = "beam"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 0.01 }
material = { young_modulus = 2e11, poisson_ratio = 0.3, density = 7850 }
elements = 4
degree = 2
[[body]]
name = "block"
shape = { kind = "sphere", radius = 0.1 }
density = 7850
position = [0, 0, 0]
"#;

    fn scene(joints: &[(&str, &str, &str)], analysis: &str) -> Scene {
        let joint = |(kind, first, second): &(&str, &str, &str)| {
            let axis = if *kind == "revolute" { "axis = [1, 0, 0]\n" } else { "" };
            format!("[[joint]]\nkind = {kind:?}\nbetween = [{first:?}, {second:?}]\n{axis}")
        };
        let joints: String = joints.iter().map(joint).collect();
        Scene::from_toml(&format!("{SCENE}{joints}{analysis}")).unwrap()
    }

    const STATICS: &str = "[statics]\n";
    const DYNAMICS: &str = "[dynamics]\nend_time = 1\ntime_step = 0.1\n";
    const MODES: &str = "[modes]\ncount = 3\n";

    #[test]
    fn points_are_split_at_the_last_at() {
        assert_eq!(parse_point("a@0.5"), Some(("a", 0.5)));
        assert_eq!(parse_point("a@1e-3"), Some(("a", 1e-3)));
        for wrong in ["a", "@1", "a@", "a@x", "a@nan", "a@inf"] {
            assert_eq!(parse_point(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn names_are_resolved() {
        let scene = scene(&[], STATICS);
        assert_eq!(scene.part("ground"), Some(Part::Ground));
        assert_eq!(scene.part("block"), Some(Part::Body(0)));
        assert_eq!(scene.part("beam@0.25"), Some(Part::Rod { index: 0, xi: 0.25 }));
        for wrong in ["beam", "block@0", "ground@0", "beem@0", "", "@0", "Ground"] {
            assert_eq!(scene.part(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_point_coincides_with_its_node() {
        let at = |xi| Part::Rod { index: 0, xi };
        assert!(at(0.5).coincides(&at(0.5 + 0.9 * NODE_TOLERANCE)));
        assert!(at(0.5 - 0.9 * NODE_TOLERANCE).coincides(&at(0.5 + 0.9 * NODE_TOLERANCE)));
        assert!(!at(0.5).coincides(&at(0.5 + 3.0 * NODE_TOLERANCE)));
        assert!(!at(0.5).coincides(&Part::Rod { index: 1, xi: 0.5 }));
        assert!(Part::Body(1).coincides(&Part::Body(1)) && !Part::Body(1).coincides(&Part::Body(0)));
        assert!(!Part::Ground.coincides(&at(0.0)));
    }

    #[test]
    fn a_rigid_joint_to_the_ground_is_never_multiplied() {
        for analysis in [STATICS, DYNAMICS, MODES] {
            assert!(!scene(&[("rigid", "ground", "beam@0")], analysis).multiplied(0));
            assert!(!scene(&[("rigid", "beam@0", "ground")], analysis).multiplied(0));
        }
    }

    #[test]
    fn hinges_to_the_ground_are_eliminated_in_statics_only() {
        for kind in ["spherical", "revolute"] {
            let joints = [(kind, "ground", "beam@0")];
            assert!(!scene(&joints, STATICS).multiplied(0), "{kind}");
            assert!(scene(&joints, DYNAMICS).multiplied(0), "{kind}");
            assert!(scene(&joints, MODES).multiplied(0), "{kind}");
        }
    }

    #[test]
    fn joints_between_moving_parts_are_multiplied() {
        for analysis in [STATICS, DYNAMICS, MODES] {
            for (first, second) in [("beam@0", "beam@1"), ("beam@1", "block"), ("ground", "block")] {
                assert!(scene(&[("rigid", first, second)], analysis).multiplied(0), "{first} {second}");
            }
        }
    }

    #[test]
    fn joints_that_share_a_node_are_multiplied() {
        let shared =
            scene(&[("rigid", "ground", "beam@0.5"), ("rigid", "block", "beam@0.5000000005")], STATICS);
        assert!(shared.multiplied(0) && shared.multiplied(1));
        let apart = scene(&[("rigid", "ground", "beam@0.5"), ("rigid", "block", "beam@1")], STATICS);
        assert!(!apart.multiplied(0) && apart.multiplied(1));
    }
}
