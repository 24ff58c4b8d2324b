//! Rigid motions that the joints leave free: in statics there is no solution then, nor for rods without mass.

use nalgebra::{DMatrix, DVector, Matrix6, Vector3};

use super::Model;
use crate::error::SceneError;
use crate::interpolation::Pose;
use crate::linear_solver::NODE;
use crate::rotation::{direction, skew};
use crate::scene::{Analysis, Scene};

/// Refuses what can move without strain and without inertia: in statics any part, in dynamics a rod without mass.
/// Modes need an equilibrium first, if anything is loaded.
pub fn refuse(model: &Model, scene: &Scene) -> Result<(), SceneError> {
    let parts = parts(model);
    let (moving, why): (Vec<bool>, _) = match scene.analysis() {
        Some(Analysis::Dynamics(_)) => (parts.iter().map(|part| part.massless).collect(), "without inertia"),
        Some(Analysis::Modes(_)) if !model.loaded() => {
            (parts.iter().map(|part| part.massless).collect(), "without inertia")
        }
        _ => (vec![true; parts.len()], "without strain"),
    };
    let Some((part, translation, rotation)) = free_motion(model, &parts, &moving)? else { return Ok(()) };
    let part = &parts[part];
    let motion = describe(&(translation, rotation), &(part.origin + part.base));
    Err(SceneError::new(
        "joint",
        format!("leaves {} free to move {why}: {motion}", part.name),
        "joints to the ground that hold every rod and every body",
    ))
}

/// A rod or a body as a rigid part.
struct Part {
    name: String,
    massless: bool,
    /// What its positions are relative to.
    origin: Vector3<f64>,
    /// Where its motions are taken about, relative to the origin: a joint, so that one alone has no lever.
    base: Vector3<f64>,
    size: f64,
}

fn parts(model: &Model) -> Vec<Part> {
    let rods = model.rods.iter().map(|rod| {
        let joined = || {
            let nodes = model.couplings.iter().flat_map(|coupling| coupling.nodes.into_iter().flatten());
            let node = nodes.into_iter().find(|node| rod.range.contains(node));
            node.map(|node| model.reference.poses()[node].position)
        };
        let held = rod.supports.first().map(|support| support.anchor);
        Part {
            name: format!("rod `{}`", rod.name),
            massless: rod.properties.inertia.is_none(),
            origin: rod.origin,
            base: held.or_else(joined).unwrap_or_else(Vector3::zeros),
            size: rod.length,
        }
    });
    let bodies = model.bodies.iter().map(|body| {
        let mine = model.couplings.iter().filter(|coupling| coupling.nodes.contains(&Some(body.node)));
        Part {
            name: format!("body `{}`", body.name),
            massless: false,
            origin: body.origin,
            base: Vector3::zeros(),
            size: mine.map(|coupling| coupling.reach).fold(0.0, f64::max),
        }
    });
    rods.chain(bodies).collect()
}

/// The part that a node of the model belongs to.
fn part_of(model: &Model, node: usize) -> usize {
    let rod = model.rods.iter().position(|rod| rod.range.contains(&node));
    rod.unwrap_or_else(|| model.rods.len() + node - model.rods.last().map_or(0, |rod| rod.range.end))
}

/// (δr, δφ) of a node under the motion (v, ω) of its part: δr = v + ω × (r − c), δφ = Aᵀ ω.
fn carried(pose: &Pose, base: &Vector3<f64>, size: f64) -> Matrix6<f64> {
    let mut map = Matrix6::zeros();
    // v in units of the size.
    map.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(size);
    map.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&(pose.position - base)));
    map.fixed_view_mut::<3, 3>(3, 3).copy_from(&pose.rotation.transpose());
    map
}

/// Index of a part, its velocity at its base, and its rotation.
type Motion = (usize, Vector3<f64>, Vector3<f64>);

/// Six equations: from a column on a block of them.
type Block = (usize, Matrix6<f64>);

/// A part, with its velocity at its base and its rotation, that can move though every joint holds; parts that are
/// not `moving` stand still.
fn free_motion(model: &Model, parts: &[Part], moving: &[bool]) -> Result<Option<Motion>, SceneError> {
    for component in components(model, parts.len(), moving) {
        let Some(motion) = null_space(model, parts, &component)?.into_iter().next() else { continue };
        let (k, part) = component
            .iter()
            .enumerate()
            .max_by(|a, b| {
                let of = |k: usize| motion.rows(NODE * k, NODE).norm();
                of(a.0).total_cmp(&of(b.0)).then(b.0.cmp(&a.0))
            })
            .map_or((0, 0), |(k, &part)| (k, part));
        let of = |i: usize| Vector3::from_fn(|j, _| motion[NODE * k + i + j]);
        return Ok(Some((part, of(0) * size(parts, &component), of(3))));
    }
    Ok(None)
}

/// All motions of the model without strain, as six numbers (δr, δφ) a node.
pub fn free_motions(model: &Model) -> Result<Vec<Vec<f64>>, SceneError> {
    let parts = parts(model);
    let mut motions = Vec::new();
    for component in components(model, parts.len(), &vec![true; parts.len()]) {
        let size = size(&parts, &component);
        for motion in null_space(model, &parts, &component)? {
            let mut vector = vec![0.0; NODE * model.reference.poses().len()];
            for (node, (row, pose)) in vector.chunks_exact_mut(NODE).zip(model.reference.poses()).enumerate()
            {
                let part = part_of(model, node);
                let Some(k) = component.iter().position(|&other| other == part) else { continue };
                let of_part = motion.fixed_rows::<NODE>(NODE * k);
                row.copy_from_slice((carried(pose, &parts[part].base, size) * of_part).as_slice());
            }
            motions.push(vector);
        }
    }
    Ok(motions)
}

fn size(parts: &[Part], component: &[usize]) -> f64 {
    let size = component.iter().map(|&part| parts[part].size).fold(0.0, f64::max);
    if size > 0.0 { size } else { 1.0 }
}

/// The motions (v/size, ω) of the parts of a component that every joint allows, the freest first.
///
/// A held node with free body rotations P and anchor c asks v + ω × (c − base) = 0 and (1 − P) Aᵀ ω = 0, a coupling
/// G (δr, δφ) = 0. Lengths are divided by the size of the mechanism, so that the rank is one of pure numbers.
fn null_space(model: &Model, parts: &[Part], component: &[usize]) -> Result<Vec<DVector<f64>>, SceneError> {
    let size = size(parts, component);
    let column = |part: usize| component.iter().position(|&other| other == part).map(|k| NODE * k);
    let width = NODE * component.len();
    let mut rows: Vec<Vec<Block>> = Vec::new();
    for (index, rod) in model.rods.iter().enumerate() {
        let Some(start) = column(index) else { continue };
        for support in &rod.supports {
            let pose = &model.reference.poses()[rod.range.start + support.node];
            let mut block = Matrix6::zeros();
            let arm = (support.anchor - parts[index].base) / size;
            block.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
            block.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&arm));
            let held = (nalgebra::Matrix3::identity() - support.free) * pose.rotation.transpose();
            block.fixed_view_mut::<3, 3>(3, 3).copy_from(&held);
            rows.push(vec![(start, block)]);
        }
    }
    for coupling in &model.couplings {
        let [a, b] = coupling.poses(&model.reference);
        let mut blocks = Vec::new();
        for (node, part) in coupling.nodes.iter().zip(coupling.constraint.jacobian(a, b)) {
            let Some(node) = *node else { continue };
            let owner = part_of(model, node);
            let Some(start) = column(owner) else { continue };
            let mut block = part * carried(&model.reference.poses()[node], &parts[owner].base, size);
            let mut lengths = block.fixed_view_mut::<3, 6>(0, 0);
            lengths /= size;
            blocks.push((start, block));
        }
        rows.push(blocks);
    }
    // Zero rows pad the matrix so that the decomposition has all right singular vectors.
    let mut matrix = DMatrix::zeros((NODE * rows.len()).max(width), width);
    for (index, blocks) in rows.iter().enumerate() {
        for (start, block) in blocks {
            let mut view = matrix.view_mut((NODE * index, *start), (NODE, NODE));
            view += block;
        }
    }
    let beyond = || {
        let name = component.first().map_or("", |&part| parts[part].name.as_str());
        let problem = format!("holds {name} at points beyond all numbers");
        SceneError::new("joint", problem, "points within reach of the parts")
    };
    if !matrix.iter().all(|x: &f64| x.is_finite()) {
        return Err(beyond());
    }
    let decomposition = matrix.try_svd(false, true, f64::EPSILON, 10_000).ok_or_else(beyond)?;
    let Some(vectors) = decomposition.v_t else { return Ok(Vec::new()) };
    let values = decomposition.singular_values;
    let mut free: Vec<usize> = (0..values.len()).filter(|&k| values[k] <= 1e-9).collect();
    free.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    Ok(free.into_iter().map(|k| vectors.row(k).transpose()).collect())
}

/// The moving parts, by what is joined without the help of the ground or of parts that stand still.
fn components(model: &Model, count: usize, moving: &[bool]) -> Vec<Vec<usize>> {
    let mut label: Vec<usize> = (0..count).collect();
    for coupling in &model.couplings {
        if let [Some(a), Some(b)] = coupling.nodes.map(|node| node.map(|node| part_of(model, node)))
            && moving[a]
            && moving[b]
        {
            let (from, to) = (label[a].max(label[b]), label[a].min(label[b]));
            label.iter_mut().filter(|label| **label == from).for_each(|label| *label = to);
        }
    }
    let members = |root: usize| (0..count).filter(|&part| moving[part] && label[part] == root).collect();
    (0..count).map(members).filter(|members: &Vec<usize>| !members.is_empty()).collect()
}

/// The motion in words: the translation, or the axis and a point on it.
///
/// Of the two directions of a line the one whose largest component is positive, whatever the decomposition gave.
fn describe((v, w): &(Vector3<f64>, Vector3<f64>), origin: &Vector3<f64>) -> String {
    let show = |x: &Vector3<f64>| {
        let round = |x: f64| (x * 1e6).round() / 1e6 + 0.0;
        format!("[{}, {}, {}]", round(x.x), round(x.y), round(x.z))
    };
    let line = |x: &Vector3<f64>| {
        let direction = direction(x);
        show(&(direction * direction[direction.iamax()].signum()))
    };
    if w.norm() < 1e-9 {
        return format!("translation along {}", line(v));
    }
    let point = origin + w.cross(v) / w.norm_squared();
    format!("rotation about the axis {} through {}", line(w), show(&point))
}
