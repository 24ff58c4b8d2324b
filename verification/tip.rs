//! A loaded tip against a reference, in every placement, with the error of the mesh under control.

use std::error::Error;

use cosserat::scene::Scene;
use nalgebra::Vector3;

use crate::case::{Checks, Kind, Outcome};
use crate::measure::{position, solve};
use crate::placement::{Placement, placements};
use crate::references::Row;

/// Where the tip should be, and how well that is known.
#[derive(Clone, Copy, Debug)]
pub struct Exact {
    /// Position of probe 0 at the end of the path.
    pub tip: [f64; 3],
    /// What the accuracy of the reference leaves open, as a distance.
    pub digits: f64,
    /// Length of the rod.
    pub length: f64,
    /// What mesh, solver tolerance and rounding may move the tip by, relative to the length.
    pub allowance: f64,
}

impl Exact {
    /// From a row of a reference file, `x y z` and `position_accuracy`, the error of each of them.
    pub fn of(row: &Row, length: f64, allowance: f64) -> Result<Self, Box<dyn Error>> {
        let digits = row.number("position_accuracy")? * 3.0_f64.sqrt();
        Ok(Self { tip: row.numbers("x y z")?, digits, length, allowance })
    }

    /// The same, where the row has the tip's displacement from here.
    pub fn displaced(self, from: [f64; 3]) -> Self {
        Self { tip: std::array::from_fn(|k| from[k] + self.tip[k]), ..self }
    }
}

const REASON: &str =
    "what the reference's accuracy leaves open, and the allowance that halving the mesh has to keep, too";
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
