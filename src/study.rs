//! Speed against accuracy on the user's own scene: variants of it, what they cost, and how far they are from a run
//! that is far finer.
//!
//! A variant of a scene ([`Settings::apply`]) has another mesh, other increments or another tolerance, but the same
//! rods, loads and probes. Every run is recorded at the same [`Milestones`], load factors or times, so that errors can
//! be taken over the whole path: the largest over probes and milestones of
//!
//! ```text
//! e_r = |r − r*| / L          L: length of all rods together                            [–]
//! e_φ = 2 atan2(|v|, |w|)     (w, v) = P*⁻¹ P: the angle between the two rotations      [rad]
//! ```
//!
//! The [`Reference`] r*, P* is the finest of a sequence of runs, each far finer than the one before; the distance of
//! the last two bounds its own error wherever refinement at least halves the error, and is reported with it.

mod errors;
mod ladder;
mod mesh;
mod milestones;
mod plan;
mod reference;
mod rows;
mod settings;
mod trial;

pub use crate::scene::{Increments, Tolerance};
pub use errors::{Errors, Trajectory, compare};
pub use mesh::{admissible_elements, fitting_elements, proportional_elements};
pub use milestones::Milestones;
pub use plan::Plan;
pub use reference::{Finest, Reference, find_reference, with_probes};
pub use rows::{Advice, Key, Measure, Row, SOLVED, advice, front};
pub use settings::Settings;
pub use trial::{Stop, Trial, solve, time};

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::Scene;
    use crate::scene::LoadTime;

    const ARC: &str = r#"
[[rod]]
name = "arc"
curve = { kind = "arc", radius = 1.0, angle = 1.0 }
section = { kind = "circle", diameter = 0.05 }
material = { young_modulus = 1e7, poisson_ratio = 0.3, density = 1000 }
elements = 4
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "arc@0"]
[[load]]
kind = "force"
on = "arc@1"
value = [0, 0, 5]
"#;

    fn scene(analysis: &str) -> Scene {
        with_probes(&Scene::from_toml(&format!("{ARC}{analysis}")).unwrap())
    }

    fn settings(degree: usize, elements: usize) -> Settings {
        Settings { degree: Some(degree), elements: Some(vec![elements]), ..Settings::default() }
    }

    /// The end of the rod superconverges with order 2p over the whole path: halving the elements divides the errors by
    /// 16 and 64, nearly.
    #[test]
    fn errors_of_a_static_path_fall_with_their_order() {
        let scene = scene("[statics]\n");
        let milestones = Milestones::of(&scene).unwrap();
        assert_eq!(milestones.count(), 10);
        let finest = Finest { intervals: vec![32], degree: 3, time_step: None };
        let mut runs = Vec::new();
        let reference = find_reference(&scene, &milestones, &finest, &[1], 1e-11, &mut |run, _, _| {
            runs.push(run);
        })
        .unwrap();
        runs.dedup();
        assert!(runs.len() >= 2 && reference.error.largest() < 1e-9, "{runs:?} {}", reference.error);
        for (degree, meshes, order) in [(2, [4, 8, 16], 4.0), (3, [2, 4, 8], 6.0)] {
            let errors = meshes.map(|elements| {
                let variant = settings(degree, elements).apply(&scene).unwrap();
                let trial = solve(&variant, &milestones, &mut |_, _| ()).unwrap();
                assert_eq!(trial.trajectory.rows.len(), 11);
                compare(&trial.trajectory, &reference.trajectory).unwrap()
            });
            // The last halving; half an order is left for what is not asymptotic yet.
            let [_, before, last] = errors;
            let position = (before.position / last.position).log2();
            let rotation = (before.rotation / last.rotation).log2();
            assert!((position - order).abs() < 0.5, "degree {degree}: {position} {errors:?}");
            assert!((rotation - order).abs() < 0.5, "degree {degree}: {rotation} {errors:?}");
        }
    }

    /// Generalized-α has order 2 where the motion is smooth: the load grows from zero. On four elements of degree 4
    /// the time error is all there is.
    #[test]
    fn errors_of_a_motion_fall_with_their_order() {
        let mut scene = scene("[dynamics]\nend_time = 0.5\ntime_step = 0.02\n");
        let smooth = |k: u32| [0.02 * f64::from(k), (0.05 * f64::from(k) * PI / 2.0).sin().powi(4)];
        scene.load[0].time = Some(LoadTime::Table((0..26).map(smooth).collect()));
        let milestones = Milestones::in_time(0.5, &[0.02, 0.01, 0.005]);
        assert_eq!(milestones.count(), 25);
        let finest = Finest { intervals: vec![16], degree: 4, time_step: Some(0.0025) };
        let reference = find_reference(&scene, &milestones, &finest, &[1], 1e-6, &mut |_, _, _| ()).unwrap();
        let errors = [0.01, 0.005, 0.0025].map(|step| {
            let settings = Settings { time_step: Some(step), degree: Some(4), ..Settings::default() };
            let trial = solve(&settings.apply(&scene).unwrap(), &milestones, &mut |_, _| ()).unwrap();
            assert_eq!(trial.trajectory.rows.len(), 26);
            compare(&trial.trajectory, &reference.trajectory).unwrap()
        });
        let order = (errors[1].position / errors[2].position).log2();
        assert!((order - 2.0).abs() < 0.5, "{order} {errors:?}, reference {}", reference.error);
        assert!(10.0 * reference.error.largest() < errors[2].largest(), "{errors:?} {}", reference.error);
    }

    #[test]
    fn a_scene_without_probes_has_them_at_free_ends() {
        let probes = scene("[statics]\n").probe;
        assert_eq!(probes.iter().map(|probe| probe.on.as_str()).collect::<Vec<_>>(), ["arc@1"]);
        let held =
            format!("{ARC}[[joint]]\nkind = \"rigid\"\nbetween = [\"arc@1\", \"ground\"]\n[statics]\n");
        let probes = with_probes(&Scene::from_toml(&held).unwrap()).probe;
        assert_eq!(probes.iter().map(|probe| probe.on.as_str()).collect::<Vec<_>>(), ["arc@0.5"]);
    }
}
