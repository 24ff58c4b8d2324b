//! Numbers of elements that keep a scene a scene: joints and loads must sit on nodes of every mesh.

use crate::error::SceneError;
use crate::rod::NODE_TOLERANCE;
use crate::scene::{LoadKind, Part, Rod, Scene};

/// Meshes whose every admissible size is a multiple of more than this are not looked for.
const MOST_PARTS: usize = 1000;

/// For every rod the number of elements whose multiples, and only they, have an end of an element wherever a joint or
/// a point load sits on the rod, whatever the degree: the smallest q for which every ξ q is whole.
///
/// # Errors
/// [`SceneError`] for a joint or a load at a ξ that is no such fraction: it sits on a node inside an element, which
/// exists for one degree and one mesh only.
pub fn admissible_elements(scene: &Scene) -> Result<Vec<usize>, SceneError> {
    let points = held_points(scene);
    let admissible = |(index, rod): (usize, &Rod)| {
        let mine: Vec<_> = points.iter().filter(|point| point.rod == index).collect();
        let whole = |q: &usize, xi: f64| (xi - (xi * *q as f64).round() / *q as f64).abs() <= NODE_TOLERANCE;
        let most = MOST_PARTS.max(rod.elements);
        let found = (1..=most).find(|q| mine.iter().all(|point| whole(q, point.xi)));
        found.ok_or_else(|| {
            let alone = |point: &&&Point| !(1..=most).any(|q| whole(&q, point.xi));
            let point = mine.iter().find(alone).or(mine.last());
            SceneError::new(
                point.map_or_else(|| format!("rod.{index}"), |point| point.key.clone()),
                "is on a node that meshes of other sizes do not have",
                "a point between elements, ξ = k/n with a small n",
            )
        })
    };
    scene.rod.iter().enumerate().map(admissible).collect()
}

/// A point of a rod that must be a node.
struct Point {
    rod: usize,
    xi: f64,
    key: String,
}

/// Where joints and point loads sit on rods.
fn held_points(scene: &Scene) -> Vec<Point> {
    let on_rod = |text: &str, key: String| match scene.part(text) {
        Some(Part::Rod { index, xi }) => Some(Point { rod: index, xi, key }),
        _ => None,
    };
    let joints = scene.joint.iter().enumerate().flat_map(|(index, joint)| {
        let ends = joint.between.iter().enumerate();
        ends.filter_map(move |(end, text)| on_rod(text, format!("joint.{index}.between.{end}")))
    });
    let loads = scene.load.iter().enumerate().filter_map(|(index, load)| match load.kind {
        LoadKind::Force | LoadKind::Moment => on_rod(&load.on, format!("load.{index}.on")),
        LoadKind::LineForce | LoadKind::LineMoment => None,
    });
    joints.chain(loads).collect()
}

/// About `total` elements over all rods, in the proportions of the scene: of every rod its share where that is whole,
/// otherwise the nearest number as in [`fitting_elements`]; `admissible` is from [`admissible_elements`].
pub fn proportional_elements(scene: &Scene, admissible: &[usize], total: usize) -> Vec<usize> {
    let all = all_elements(scene);
    let whole = |rod: &Rod| {
        let share = share(rod, total);
        (share.is_multiple_of(all) && share > 0).then(|| usize::try_from(share / all).unwrap_or(usize::MAX))
    };
    let fitting = fitting_elements(scene, admissible, total);
    scene.rod.iter().zip(fitting).map(|(rod, fitting)| whole(rod).unwrap_or(fitting)).collect()
}

/// About `total` elements over all rods, in the proportions of the scene: of every rod the number nearest to its share
/// that keeps joints and loads on nodes, whatever the degree.
pub fn fitting_elements(scene: &Scene, admissible: &[usize], total: usize) -> Vec<usize> {
    let all = all_elements(scene) as f64;
    let fitting = |(rod, &least): (&Rod, &usize)| {
        let parts = share(rod, total) as f64 / (all * least as f64);
        // Saturates; a mesh of such a size is refused by the scene's validation.
        (parts.round().max(1.0) as usize).saturating_mul(least)
    };
    scene.rod.iter().zip(admissible).map(fitting).collect()
}

fn all_elements(scene: &Scene) -> u128 {
    scene.rod.iter().map(|rod| rod.elements as u128).sum()
}

/// The share of a rod, times all elements of the scene.
fn share(rod: &Rod, total: usize) -> u128 {
    rod.elements as u128 * total as u128
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rods of 4 and 12 elements, points of which are held or loaded.
    fn scene(points: &[&str]) -> Scene {
        let rod = |name: &str, elements: usize| {
            format!(
                "[[rod]]\nname = {name:?}\ncurve = {{ kind = \"line\", length = 1.0 }}\n\
                 section = {{ kind = \"circle\", diameter = 0.01 }}\n\
                 material = {{ young_modulus = 2e11, poisson_ratio = 0.3 }}\nelements = {elements}\ndegree = 2\n"
            )
        };
        let load = |on: &&str| format!("[[load]]\nkind = \"force\"\non = {on:?}\nvalue = [0, 0, 1]\n");
        let loads: String = points.iter().map(load).collect();
        let text = format!("{}{}{loads}[statics]\n", rod("a", 4), rod("b", 12));
        Scene::from_toml(&text).unwrap()
    }

    #[test]
    fn points_stay_on_nodes() {
        for (points, wanted) in [
            (&["a@0", "b@1"][..], [1, 1]),
            (&["a@0.5", "a@0.25"], [4, 1]),
            (&["b@0.5", "b@0.333333333333", "a@0.125"], [8, 6]),
            (&["a@0.37"], [100, 1]),
        ] {
            assert_eq!(admissible_elements(&scene(points)).unwrap(), wanted);
        }
        // A Gauss–Lobatto point inside an element: (1 − 1/√5)/2.
        let error = admissible_elements(&scene(&["b@1", "a@0.27639320225"])).unwrap_err();
        assert_eq!(error.key, "load.1.on");
    }

    #[test]
    fn rods_share_elements_in_proportion() {
        let scene = scene(&["a@0", "b@0.5"]);
        for (total, wanted) in
            [(16, [4, 12]), (32, [8, 24]), (8, [2, 6]), (4, [1, 3]), (6, [2, 4]), (1, [1, 2])]
        {
            assert_eq!(proportional_elements(&scene, &[1, 2], total), wanted, "{total}");
        }
    }
}
