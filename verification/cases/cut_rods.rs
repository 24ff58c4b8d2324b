//! A rod that is cut and joined again is the same rod, in statics and in motion, and whichever way its second half
//! runs.
//!
//! Elements and nodes are the same, so that the two sets of equations have the same solution but for rounding and
//! Newton's test.

use std::f64::consts::TAU;

use cosserat::scene::{
    Basis, Curve, CurveShape, Dynamics, Joint, JointKind, Load, LoadKind, LoadTime, NamedTime, Rod, Scene,
    Statics,
};
use cosserat::solution::Solution;
use nalgebra::Vector3;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::{clamp, load, probe, solve};
use crate::pieces::UNEVEN_SECTION;
use crate::placement::placements;
use crate::steps::{distance, run};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let source = "the rod without the cut";
    vec![Case::new("cut_rods::statics", source, statics), Case::new("cut_rods::dynamics", source, motion)]
}

const ELEMENTS: usize = 6;
const DEGREE: usize = 3;
const FORCE: [f64; 3] = [-0.4, 0.5, 0.8];
const MOMENT: [f64; 3] = [0.3, -0.2, 0.4];

/// The whole curve, and its halves.
type Shapes = [Curve; 3];

fn line(from: f64, to: f64) -> Curve {
    let normal = Some([0.0, 1.0, 0.0]);
    CurveShape::Line { length: None, from: Some([from, 0.0, 0.0]), to: Some([to, 0.0, 0.0]), normal }.into()
}

/// A line, its second half running on or back; and a helix.
fn shapes() -> [(&'static str, Shapes, bool); 3] {
    let helix = |coils: f64, phase: f64, z: f64| Curve {
        shape: CurveShape::Helix { coils, radius: 0.4, pitch: 0.5, phase },
        origin: [0.0, 0.0, z],
        orientation: [1.0, 0.0, 0.0, 0.0],
    };
    [
        ("line", [line(0.0, 2.0), line(0.0, 1.0), line(1.0, 2.0)], false),
        ("line, second half backwards", [line(0.0, 2.0), line(0.0, 1.0), line(2.0, 1.0)], true),
        ("helix", [helix(1.0, 0.3, 0.0), helix(0.5, 0.3, 0.0), helix(0.5, 0.3 + 0.5 * TAU, 0.25)], false),
    ]
}

/// Loads at the tip, which is `tip`, and gravity.
fn with_loads(tip: &str, rods: Vec<Rod>, joints: Vec<Joint>) -> Scene {
    let turning = Load { basis: Basis::Body, ..load(LoadKind::Moment, tip, [0.0, 0.1, 0.0]) };
    Scene {
        gravity: Some([0.3, -0.2, -1.0]),
        rod: rods,
        joint: joints,
        load: vec![load(LoadKind::Force, tip, FORCE), load(LoadKind::Moment, tip, MOMENT), turning],
        ..Scene::default()
    }
}

fn whole([curve, ..]: &Shapes) -> Scene {
    let rod = Rod::new("rod", curve.clone(), UNEVEN_SECTION, None, ELEMENTS, DEGREE);
    let mut scene = with_loads("rod@1", vec![rod], vec![clamp("rod@0")]);
    scene.probe = [0.25, 0.5, 0.75, 1.0].map(|xi| probe(&format!("at{xi}"), &format!("rod@{xi}"))).to_vec();
    scene
}

fn halves([_, first, second]: &Shapes, backwards: bool) -> Scene {
    let half =
        |name: &str, curve: &Curve| Rod::new(name, curve.clone(), UNEVEN_SECTION, None, ELEMENTS / 2, DEGREE);
    let (cut, tip) = if backwards { ("b@1", "b@0") } else { ("b@0", "b@1") };
    let weld = Joint {
        name: Some("weld".to_string()),
        kind: JointKind::Rigid,
        between: ["a@1".to_string(), cut.to_string()],
        point: None,
        axis: None,
    };
    let mut scene = with_loads(tip, vec![half("a", first), half("b", second)], vec![clamp("a@0"), weld]);
    // The section turns by half a turn about e_y when the rod runs back: so does what its basis is.
    if let (true, Some(load)) = (backwards, scene.load.last_mut()) {
        load.value = [-load.value[0], load.value[1], -load.value[2]];
    }
    scene.probe = ["a@0.5", cut, "b@0.5", tip].map(|on| probe(&on.replace('@', " "), on)).to_vec();
    scene
}

/// Rows of the pieces against the rod's, at the end; `force` is what acts beyond the cut.
fn check(
    checks: &mut Checks,
    what: &str,
    [whole, cut]: [&Solution; 2],
    backwards: bool,
    bounds: [f64; 2],
) -> Outcome {
    let (a, b) = (whole.rows.last().ok_or("no rows")?, cut.rows.last().ok_or("no rows")?);
    let start = whole.rows.first().ok_or("no rows")?;
    let moved = distance(&a.probes[3].position, &start.probes[3].position);
    checks.above(
        Kind::Invariant,
        format!("way of the tip, {what}"),
        moved,
        1e-2,
        "a rod at rest would show nothing",
    );
    let reason =
        "of the length of 2 m, within Newton's test of 1e-9 of the forces, which a step beyond it undercuts";
    let [length, force] = bounds;
    for (k, (whole, piece)) in a.probes.iter().zip(&b.probes).enumerate() {
        let label = |quantity: &str| format!("{quantity} of probe {k}, {what}");
        checks.vector(Kind::Invariant, label("position"), (piece.position, whole.position), length, reason);
        let half_turn = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::PI);
        let mut turned = crate::steps::rotation(piece.quaternion);
        if backwards && k > 0 {
            turned *= half_turn;
        }
        let angle = turned.angle_to(&crate::steps::rotation(whole.quaternion));
        // An angle near zero is the square root of what rounding leaves of its cosine.
        checks.below(Kind::Invariant, label("rotation"), angle, length.max(5e-8), reason);
    }
    let reason = "of forces of a few newtons, within Newton's test";
    for (k, (x, y)) in a.reactions[0].iter().zip(&b.reactions[0]).enumerate() {
        let label = format!("component {k} of the clamp's reaction, {what}");
        checks.absolute(Kind::Invariant, label, (*y, *x), force, reason);
    }
    Ok(())
}

fn statics(checks: &mut Checks) -> Outcome {
    for (name, shapes, backwards) in shapes() {
        for placement in placements(2.0) {
            let solved = |mut scene: Scene| {
                scene.statics = Some(Statics::default());
                solve(&placement.apply(&scene))
            };
            let (uncut, cut) = (solved(whole(&shapes))?, solved(halves(&shapes, backwards))?);
            let what = format!("{name}, {}", placement.name);
            check(checks, &what, [&uncut, &cut], backwards, [2e-9, 1e-8])?;
            // What the weld carries is what acts beyond it, on the second of the pair.
            let row = cut.rows.last().ok_or("no rows")?;
            let [x, y, z, ..] = row.reactions[1];
            let carried = placement.undo_direction(Vector3::new(x, y, z));
            // The clamp of the uncut rod carries the force and the whole weight, half of which lies beyond the cut.
            let whole = uncut.rows.last().ok_or("no rows")?;
            let clamp = placement.undo_direction(Vector3::from_column_slice(&whole.reactions[0][..3]));
            let beyond = 0.5 * (Vector3::from(FORCE) - clamp);
            let reason = "ten nodal residuals of 1e-9 of forces below 10 N";
            let bound = 1e-7;
            checks.vector(
                Kind::ClosedForm,
                format!("weld, {what}"),
                (carried.into(), (-beyond).into()),
                bound,
                reason,
            );
        }
    }
    Ok(())
}

fn motion(checks: &mut Checks) -> Outcome {
    for (name, shapes, backwards) in shapes() {
        let moved = |mut scene: Scene| {
            scene.dynamics = Some(Dynamics::new(0.3, 5e-3));
            for load in &mut scene.load {
                load.time = Some(LoadTime::Named(NamedTime::Ramp));
            }
            run(&scene)
        };
        let (whole, cut) = (moved(whole(&shapes))?, moved(halves(&shapes, backwards))?);
        // The weld's multipliers and the pieces' own scales: 60 steps, each within 1e-9 of its forces.
        check(checks, &format!("{name}, in motion"), [&whole, &cut], backwards, [2e-8, 1e-5])?;
    }
    Ok(())
}
