//! The fitted reference, eq. (21), on the spring of section 4.1.

use cosserat::scene::Reference;

use super::spring::{Spring, places};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{probe, solve};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case {
            name: "spring_fit::nodes",
            source: "SciPy on eq. (21) in the paper's 7N unknowns",
            run: nodes,
        },
        Case {
            name: "spring_fit::curve",
            source: "authors' program, 75 elements, p = 2, fit of 301 samples, 500 increments",
            run: curve,
        },
    ]
}

const FIT: Reference = Reference::Fit { samples: 301 };

/// Where the fit puts the nodes: not on the curve, but outside and inside of it in turn.
///
/// The SciPy minimum is that of the unconstrained problem in 7 · 151 unknowns, the interpolated matrix not
/// projected and the angle taken from its trace, as the paper writes it. Ours projects the matrix first and keeps
/// the quaternions at unit length. The positions agree to 1e-14 m: they hardly see the rotations.
fn nodes(checks: &mut Checks) -> Outcome {
    for placement in places() {
        let mut spring = Spring::new(1e-3, 75, 2);
        spring.reference = FIT;
        let mut scene = spring.scene();
        scene.probe.push(probe("middle", "spring@0.5"));
        let solution = solve(&placement.apply(&scene))?;
        let start = solution.rows.first().ok_or("the solution has no rows")?;
        let scipy = [[1.7313146725685e-5, -1.0008850888986e-2, 5e-2], [0.0, -9.99575549563974e-3, 2.5e-2]];
        for (pose, expected) in start.probes.iter().zip(scipy) {
            let local = placement.undo_position(pose.position.into());
            checks.vector(
                Kind::CrossCode,
                format!("fitted node near {expected:?}, {}", placement.name),
                (local.into(), expected),
                1e-13,
                "both minimisers' last step, 1e-12 of the spring's size; SciPy's gradient 8e-16",
            );
        }
    }
    Ok(())
}

/// The curve of section 4.1 with the fitted reference, beside that of the authors' program.
///
/// The two programs agree on the fit itself (above), yet their curves differ by 0.06, 0.11, 0.18, 0.19 and 0.01 mm.
/// No variant of (21) that was tried closes the gap: the matrix projected or not, end nodes held or free,
/// SciPy's two methods with their default tolerances, 151 to 1001 samples. So the fit is known to within what it
/// changes, and no better.
fn curve(checks: &mut Checks) -> Outcome {
    let printed =
        [(5.0, 79.481e-3), (10.0, 149.932e-3), (20.0, 271.775e-3), (50.0, 498.823e-3), (100.0, 572.243e-3)];
    for placement in places() {
        for (force, expected) in printed {
            let nodes = Spring::new(force, 75, 2);
            let fitted = Spring { reference: FIT, ..nodes.clone() };
            let (nodes, fitted) = (nodes.displacement(&placement)?.z, fitted.displacement(&placement)?.z);
            checks.absolute(
                Kind::CrossCode,
                format!("u_z with a fit of 301 samples, {force} N, {}", placement.name),
                (fitted, expected),
                (fitted - nodes).abs(),
                "the fit's own error: what it changes against nodes on the curve",
            );
        }
    }
    Ok(())
}
