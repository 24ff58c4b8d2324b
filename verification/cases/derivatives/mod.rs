//! Every derivative that is written by hand, against dual numbers through the paper's formulas (`formulas.rs`).
//!
//! Chained: pose → strains → their derivatives; energy density → n, m; forces → tangents, for the nodal increments
//! r + δr, δP = Q(P) δφ; inertia and joints alike. Dual numbers have no step, so both sides are exact but for rounding.

mod bodies;
mod constraints;
mod forces;
mod inertia;
mod kinematics;
mod line_loads;
mod point_loads;
mod rotations;
mod supports;

use crate::case::Case;

/// The cases of this folder.
pub fn all() -> Vec<Case> {
    [
        rotations::all(),
        kinematics::all(),
        forces::all(),
        line_loads::all(),
        point_loads::all(),
        supports::all(),
        inertia::all(),
        bodies::all(),
        constraints::all(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Of all these comparisons, relative to the largest entry.
const ROUNDING: f64 = 1e-12;
const ROUNDING_REASON: &str = "4500 ε: an entry sums up to 60 rounded products, which cancel to no less than 1/70 \
                               of their absolute sum (Lebesgue constants ≤ 11, stiffness ratios ≤ 6)";

pub use forces::{STIFFNESS, reference_point};
