//! The cases, one file a problem.

mod roll_up;

use crate::case::Case;

/// Every case.
pub fn all() -> Vec<Case> {
    [roll_up::all()].into_iter().flatten().collect()
}
