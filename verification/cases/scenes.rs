//! The scene files that come with the program end where they should.

use std::path::Path;

use cosserat::scene::Scene;

use crate::case::{Case, Checks, Outcome};
use crate::cases::bend_45;
use crate::tip::{Exact, check_tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new("scenes::bend_45", "bend_45::values, F = 600", bend).reads(&[bend_45::LOADS]),
        Case::new("scenes::roll_up", "closed form; Euler 1744", roll_up),
    ]
}

/// The tip of a shipped file; its mesh is the finer of the two.
fn check(checks: &mut Checks, file: &str, exact: &Exact) -> Outcome {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(file);
    let shipped = Scene::from_file(path)?;
    let scene = |elements| {
        let mut scene = shipped.clone();
        scene.rod[0].elements = elements;
        scene
    };
    check_tip(checks, file, &scene, shipped.rod[0].elements, exact)
}

fn bend(checks: &mut Checks) -> Outcome {
    let exact = Exact { allowance: 1e-9, ..bend_45::loads(checks)?[2].exact };
    check(checks, "bend_45.toml", &exact)
}

fn roll_up(checks: &mut Checks) -> Outcome {
    let exact = Exact { tip: [0.0; 3], digits: 0.0, length: 1.0, allowance: 1e-9 };
    check(checks, "roll_up.toml", &exact)
}
