//! Rigid motions that the joints of a rod leave free: in statics there is no solution then.

use nalgebra::{DMatrix, Vector3};

use crate::error::SceneError;
use crate::model::{Model, RodModel};
use crate::rotation::skew;

/// Refuses the first rod that can move without strain, naming the motion.
pub fn refuse(model: &Model) -> Result<(), SceneError> {
    for rod in &model.rods {
        if let Some((translation, rotation)) = free_motion(model, rod) {
            let motion = describe(&(translation, rotation), &model.origin);
            return Err(SceneError::new(
                "joint",
                format!("leaves rod `{}` free to move without strain: {motion}", rod.name),
                "joints to the ground that hold every rod",
            ));
        }
    }
    Ok(())
}

/// A rigid motion (v, ω): r ↦ v + ω × r that every support of the rod allows.
///
/// A support with free body rotations P and anchor c asks v + ω × c = 0 and (1 − P) Aᵀ ω = 0. Lengths are
/// divided by the rod's, so that the rank is one of pure numbers.
fn free_motion(model: &Model, rod: &RodModel) -> Option<(Vector3<f64>, Vector3<f64>)> {
    // Zero rows pad the matrix so that the decomposition has all six right singular vectors.
    let mut rows = DMatrix::zeros(6 * rod.supports.len().max(1), 6);
    for (index, support) in rod.supports.iter().enumerate() {
        let pose = &model.reference.poses()[rod.range.start + support.node];
        let held = (nalgebra::Matrix3::identity() - support.free) * pose.rotation.transpose();
        let mut block = rows.fixed_view_mut::<6, 6>(6 * index, 0);
        block.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        block.fixed_view_mut::<3, 3>(0, 3).copy_from(&-skew(&(support.anchor / rod.length)));
        block.fixed_view_mut::<3, 3>(3, 3).copy_from(&held);
    }
    let decomposition = rows.svd(false, true);
    let (index, value) = decomposition.singular_values.argmin();
    if value > 1e-9 {
        return None;
    }
    let motion = decomposition.v_t?.row(index).transpose();
    let v = Vector3::new(motion[0], motion[1], motion[2]) * rod.length;
    Some((v, Vector3::new(motion[3], motion[4], motion[5])))
}

/// The motion in words: the translation, or the axis and a point on it.
fn describe((v, w): &(Vector3<f64>, Vector3<f64>), origin: &Vector3<f64>) -> String {
    let show = |x: &Vector3<f64>| {
        let round = |x: f64| (x * 1e6).round() / 1e6 + 0.0;
        format!("[{}, {}, {}]", round(x.x), round(x.y), round(x.z))
    };
    if w.norm() < 1e-9 {
        return format!("translation along {}", show(&v.normalize()));
    }
    let point = origin + w.cross(v) / w.norm_squared();
    format!("rotation about the axis {} through {}", show(&w.normalize()), show(&point))
}
