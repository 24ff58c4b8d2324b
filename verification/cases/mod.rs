//! The cases, one file a problem.

mod bend_45;
mod cantilever;
mod continuous;
mod convergence_orders;
mod derivatives;
mod loads;
mod objectivity;
mod path_independence;
mod petrov_galerkin;
mod princeton;
mod probes;
mod reactions;
mod reference;
mod roll_up;
mod scenes;
mod spring;
mod spring_axis;
mod spring_comparison;
mod spring_fit;
mod spring_wire_end;
mod spring_work;
mod straight_to_helix;

use crate::case::Case;

/// Every case.
pub fn all() -> Vec<Case> {
    [
        bend_45::all(),
        cantilever::all(),
        continuous::all(),
        convergence_orders::all(),
        derivatives::all(),
        loads::all(),
        objectivity::all(),
        path_independence::all(),
        petrov_galerkin::all(),
        princeton::all(),
        probes::all(),
        reactions::all(),
        reference::all(),
        roll_up::all(),
        scenes::all(),
        spring_axis::all(),
        spring_comparison::all(),
        spring_fit::all(),
        spring_wire_end::all(),
        spring_work::all(),
        straight_to_helix::all(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
