//! An element's tangent in the paper's own coordinates, seven unknowns a node.

use nalgebra::Vector4;

use super::QUATERNION_NODE;
use crate::element::ElementTangent;
use crate::linear_solver::{NODE, Sparse};
use crate::rotation::rotation_from_quaternion_rate;

/// Columns (r, P) by δφ = T(P) δP, eq. (10); rows as they are. The unit constraint is added per node elsewhere.
pub fn add_quaternion_element<'a, const N: usize>(
    system: &mut Sparse,
    first: usize,
    tangent: &ElementTangent<N>,
    quaternion: impl Fn(usize) -> &'a Vector4<f64>,
) {
    for j in 0..N {
        let rate = rotation_from_quaternion_rate(quaternion(j));
        for (i, row) in tangent.iter().enumerate() {
            let turned = row[j].fixed_view::<6, 3>(0, 3) * rate;
            for r in 0..NODE {
                let row_index = first + QUATERNION_NODE * i + r;
                let column = first + QUATERNION_NODE * j;
                for c in 0..3 {
                    system.add(row_index, column + c, row[j][(r, c)]);
                }
                for c in 0..4 {
                    system.add(row_index, column + 3 + c, turned[(r, c)]);
                }
            }
        }
    }
}
