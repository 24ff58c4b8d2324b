//! x
use crate::{error::Error, scene::Scene, solution::Solution};
use std::path::Path;
pub(super) fn plot(_d: &Path, _s: &Scene, _x: &Solution) -> Result<(), Error> {
    Ok(())
}
