//! A loaded tip against a reference, in every placement, with the error of the mesh under control.

use std::error::Error;

use cosserat::scene::Scene;
use nalgebra::Vector3;

use crate::case::{Checks, Kind, Outcome};
use crate::measure::{position, solve};
use crate::placement::{Placement, placements};

/// Where the tip should be, and how well that is known.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    /// Position of probe 0 at the end of the path.
    pub tip: [f64; 3],
    /// What the digits of the reference leave open, as a distance.
    pub digits: f64,
    /// Length of the rod.
    pub length: f64,
    /// What mesh, solver tolerance and rounding may move the tip by, relative to the length.
    pub allowance: f64,
}

/// Half a unit of the last printed digit in each of three components.
pub fn half_digit(unit: f64) -> f64 {
    0.5 * unit * 3.0_f64.sqrt()
}

const REASON: &str =
    "what the reference's digits leave open, and the allowance that halving the mesh has to keep, too";
const HALVED: &str = "half as many elements have 4 times the mesh error or more, and a Newton path and a rounding of \
                      their own: what they do not change is converged";

/// Checks probe 0 of `scene(elements)` in every placement, and that half as many elements find the same.
pub fn check_tip(
    checks: &mut Checks,
    what: &str,
    scene: &dyn Fn(usize) -> Scene,
    elements: usize,
    exact: &Exact,
) -> Outcome {
    let allowance = exact.allowance * exact.length;
    let mut as_is = Vector3::zeros();
    for (index, placement) in placements(exact.length).iter().enumerate() {
        let tip = tip(&scene(elements), placement)?;
        if index == 0 {
            as_is = tip;
        }
        checks.vector(
            Kind::ClosedForm,
            format!("tip, {what}, {}", placement.name),
            (tip.into(), exact.tip),
            exact.digits + allowance,
            REASON,
        );
    }
    let halved = tip(&scene(elements / 2), &placements(exact.length)[0])?;
    checks.below(
        Kind::Invariant,
        format!("tip, {what}, {} elements instead of {elements}", elements / 2),
        (halved - as_is).norm(),
        allowance,
        HALVED,
    );
    Ok(())
}

/// Where probe 0 ends, in the axes of the scene before it was placed.
pub fn tip(scene: &Scene, placement: &Placement) -> Result<Vector3<f64>, Box<dyn Error>> {
    position(&solve(&placement.apply(scene))?, 0, placement)
}
