//! The cases, one file a problem.

mod accuracy;
mod bend_45;
mod body_chain;
mod cantilever;
mod cantilever_motion;
mod continuous;
mod convergence_orders;
mod cut_rods;
mod derivatives;
mod exudyn_beams;
mod exudyn_bodies;
mod exudyn_chains;
mod exudyn_wilberforce;
mod flexible_pendulum;
mod four_bar;
mod free_bodies;
mod free_flight;
mod frequencies;
mod frequencies_complex;
mod frequencies_joined;
mod frequencies_loaded;
mod frequencies_meshes;
mod heavy_top;
mod hinged_beams;
mod load_courses;
mod loaded_frames;
mod loads;
mod massless_rod;
mod mechanisms;
mod mode_shapes;
mod motion_details;
mod motion_fine_points;
mod moving_start;
mod mujoco_chains;
mod objectivity;
mod path_independence;
mod petrov_galerkin;
mod pinocchio;
mod princeton;
mod probes;
mod pyelastica_rods;
mod radau;
mod radau_work;
mod reactions;
mod reference;
mod right_angle_cantilever;
mod roll_up;
mod rotation_limits;
mod run_accuracy;
mod scenes;
mod spring;
mod spring_axis;
mod spring_comparison;
mod spring_fit;
mod spring_wire_end;
mod spring_work;
mod spun_ring;
mod static_rods;
mod step_warnings;
mod straight_to_helix;
mod study;
mod time_steps;
mod variable_steps;
mod wilberforce;

use crate::case::Case;

/// What no case of the suite covers, for the report.
pub const LEFT_OUT: &[&str] = &[
    "Contact, friction and damping: the solver has none of them.",
    "Stability of equilibria past a buckling load: statics does not judge it; [modes] about such an equilibrium does.",
    "Published figures whose sources contradict each other or were digitised (grade C): never a gate.",
    "OpenSees: its Python package needs a system library that a fresh machine may lack; Exudyn and PyElastica stand \
     for other rod programs.",
    "Running times: benches/ measures them, no case asserts one.",
];

/// Every case.
pub fn all() -> Vec<Case> {
    [
        accuracy::all(),
        bend_45::all(),
        body_chain::all(),
        cantilever::all(),
        cantilever_motion::all(),
        continuous::all(),
        convergence_orders::all(),
        cut_rods::all(),
        derivatives::all(),
        exudyn_bodies::all(),
        exudyn_chains::all(),
        exudyn_beams::all(),
        exudyn_wilberforce::all(),
        flexible_pendulum::all(),
        four_bar::all(),
        free_bodies::all(),
        free_flight::all(),
        frequencies::all(),
        frequencies_complex::all(),
        frequencies_joined::all(),
        frequencies_loaded::all(),
        frequencies_meshes::all(),
        heavy_top::all(),
        hinged_beams::all(),
        load_courses::all(),
        loaded_frames::all(),
        loads::all(),
        massless_rod::all(),
        mechanisms::all(),
        mode_shapes::all(),
        objectivity::all(),
        motion_details::all(),
        moving_start::all(),
        motion_fine_points::all(),
        mujoco_chains::all(),
        path_independence::all(),
        petrov_galerkin::all(),
        pinocchio::all(),
        princeton::all(),
        probes::all(),
        pyelastica_rods::all(),
        radau::all(),
        radau_work::all(),
        reactions::all(),
        reference::all(),
        right_angle_cantilever::all(),
        roll_up::all(),
        run_accuracy::all(),
        rotation_limits::all(),
        scenes::all(),
        spring_axis::all(),
        spring_comparison::all(),
        spring_fit::all(),
        spring_wire_end::all(),
        spring_work::all(),
        spun_ring::all(),
        static_rods::all(),
        step_warnings::all(),
        straight_to_helix::all(),
        study::all(),
        time_steps::all(),
        variable_steps::all(),
        wilberforce::all(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
