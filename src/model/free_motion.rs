//! Rigid motions that the joints of a rod leave free: in statics there is no solution then.

use nalgebra::{DMatrix, Vector3};

use crate::error::SceneError;
use crate::model::{Model, RodModel};
use crate::rotation::{direction, skew};

/// Refuses the first rod that can move without strain, naming the motion.
pub fn refuse(model: &Model) -> Result<(), SceneError> {
    for rod in &model.rods {
        if let Some((translation, rotation)) = free_motion(model, rod)? {
            let motion = describe(&(translation, rotation), &(rod.origin + base(rod)));
            return Err(SceneError::new(
                "joint",
                format!("leaves rod `{}` free to move without strain: {motion}", rod.name),
                "joints to the ground that hold every rod",
            ));
        }
    }
    Ok(())
}

/// Where motions are taken about: the first support, so that one alone has no lever, wherever it is.
fn base(rod: &RodModel) -> Vector3<f64> {
    rod.supports.first().map_or_else(Vector3::zeros, |support| support.anchor)
}

/// A rigid motion and its rotation.
type Motion = (Vector3<f64>, Vector3<f64>);

/// A rigid motion (v, ω): r ↦ v + ω × (r − base) that every support of the rod allows.
///
/// A support with free body rotations P and anchor c asks v + ω × (c − base) = 0 and (1 − P) Aᵀ ω = 0. Lengths are
/// divided by the rod's, so that the rank is one of pure numbers.
fn free_motion(model: &Model, rod: &RodModel) -> Result<Option<Motion>, SceneError> {
    // Zero rows pad the matrix so that the decomposition has all six right singular vectors.
    let mut rows = DMatrix::zeros(6 * rod.supports.len().max(1), 6);
    for (index, support) in rod.supports.iter().enumerate() {
        let pose = &model.reference.poses()[rod.range.start + support.node];
        let held = (nalgebra::Matrix3::identity() - support.free) * pose.rotation.transpose();
        let mut block = rows.fixed_view_mut::<6, 6>(6 * index, 0);
        block.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        block.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&((support.anchor - base(rod)) / rod.length)));
        block.fixed_view_mut::<3, 3>(3, 3).copy_from(&held);
    }
    let beyond = || {
        let problem = format!("holds rod `{}` at points beyond all numbers", rod.name);
        SceneError::new("joint", problem, "points within reach of the rod")
    };
    if !rows.iter().all(|x: &f64| x.is_finite()) {
        return Err(beyond());
    }
    let decomposition = rows.try_svd(false, true, f64::EPSILON, 10_000).ok_or_else(beyond)?;
    let (index, value) = decomposition.singular_values.argmin();
    let Some(motion) = decomposition.v_t.filter(|_| value <= 1e-9) else { return Ok(None) };
    let motion = motion.row(index).transpose();
    let v = Vector3::new(motion[0], motion[1], motion[2]) * rod.length;
    Ok(Some((v, Vector3::new(motion[3], motion[4], motion[5]))))
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
