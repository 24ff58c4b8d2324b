//! The cases, one file a problem.

mod bend_45;
mod cantilever;
mod cantilever_motion;
mod continuous;
mod convergence_orders;
mod derivatives;
mod flexible_pendulum;
mod free_flight;
mod frequencies;
mod frequencies_complex;
mod frequencies_joined;
mod frequencies_loaded;
mod frequencies_meshes;
mod load_courses;
mod loads;
mod massless_rod;
mod mode_shapes;
mod objectivity;
mod path_independence;
mod petrov_galerkin;
mod princeton;
mod probes;
mod reactions;
mod reference;
mod right_angle_cantilever;
mod roll_up;
mod scenes;
mod spring;
mod spring_axis;
mod spring_comparison;
mod spring_fit;
mod spring_wire_end;
mod spring_work;
mod spun_ring;
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
        frequencies::all(),
        frequencies_meshes::all(),
        frequencies_joined::all(),
        frequencies_loaded::all(),
        mode_shapes::all(),
        spun_ring::all(),
        free_flight::all(),
        load_courses::all(),
        massless_rod::all(),
        cantilever_motion::all(),
        frequencies_complex::all(),
        right_angle_cantilever::all(),
        flexible_pendulum::all(),
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
