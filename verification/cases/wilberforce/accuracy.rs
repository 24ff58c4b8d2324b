//! `accuracy` on the large motion with a massless wire, against the boundary-value problem of the wire.

use cosserat::scene::Dynamics;
use cosserat::{Model, Scene, dynamics};
use nalgebra::Vector3;

use super::{Pendulum, wire_length};
use crate::case::{Case, Checks, Outcome};
use crate::cases::accuracy::check_proportion;
use crate::placement::placements;
use crate::steps::{position_at, quaternion_at, rotation};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("wilberforce::accuracy", "boundary-value problem of the wire at every instant", accuracy)
            .reads(&[FILE])
            .slow(),
    ]
}

const FILE: &str = "continuous/wilberforce_motion.csv";
const END: f64 = 2.0;

/// With an inertia of the wire that is nothing, its own swings are no part of the motion, and the bob's error is all.
fn accuracy(checks: &mut Checks) -> Outcome {
    let as_is = &placements(1.0)[0];
    let table = checks.reference(FILE)?;
    let row = table.row(&[("t", "2.0")])?;
    let (exact, turned) = (Vector3::from(row.numbers("x y z")?), row.numbers("qw qx qy qz")?);
    let pendulum = Pendulum { inertia: false, ..Pendulum::new(9, 6) };
    let (mut positions, mut turns) = (Vec::new(), Vec::new());
    for accuracy in [1e-1, 1e-2, 1e-3, 1e-4] {
        let options = Dynamics::accurate(END, accuracy);
        let scene = Scene { dynamics: Some(options.clone()), ..pendulum.scene() };
        let run = dynamics::solve(&Model::new(&scene)?, &options, &mut |_, _| ())?;
        let found = position_at(&run, END, 0, as_is)?;
        positions.push((accuracy, (found - exact).norm() / wire_length()));
        let found = quaternion_at(&run, END, 0, as_is, turned)?;
        turns.push((accuracy, rotation(found).angle_to(&rotation(turned))));
    }
    check_proportion(checks, "position, in lengths of the wire", &positions);
    check_proportion(checks, "rotation", &turns);
    Ok(())
}
