//! What is easily overlooked in a motion: held nodes, the last step, default points, the zero of energies, loads at the
//! stages, closed loops far away and near a dead point, energy that comes from nowhere or from rounding, and a gravity of zero.

use crate::case::{Case, Checks, Kind, Outcome};
use crate::cases::frequencies::{LENGTH, steel};
use crate::measure::{clamp, load, probe};
use crate::motion::{follow, frequencies, place, vibrate};
use crate::pieces::{circle, line};
use crate::placement::{Placement, placements};
use crate::steps::{body, joint, run};
use cosserat::scene::{
    Body, Curve, CurveShape, Dynamics, Joint, JointKind, LoadKind, LoadTime, Method, Modes, NamedTime, Rod,
    Scene, Section, Step,
};
use cosserat::{Model, dynamics};
use nalgebra::{UnitQuaternion, Vector3};

pub fn all() -> Vec<Case> {
    vec![
        Case::new("motion_details::held", "the joint holds the node", held),
        Case::new("motion_details::last_step", "free fall; the end time is a row", last_step),
        Case::new("motion_details::points", "the default is a point like any other", points),
        Case::new("motion_details::gravity", "m g z", gravity),
        Case::new(
            "motion_details::radau_loads",
            "a cubic in time, which the method integrates exactly",
            radau_loads,
        ),
        Case::new("motion_details::pair", "two modes are two motions", pair),
        Case::new("motion_details::runaway", "energy has a source", runaway),
        Case::new("motion_details::turned", "the loop has the same redundant constraints everywhere", turned),
        Case::new("motion_details::stiff_at_rest", "what rests stays at rest", stiff_at_rest),
        Case::new("motion_details::no_gravity", "a gravity of zero is none", no_gravity),
    ]
}

fn held(checks: &mut Checks) -> Outcome {
    use JointKind::{Rigid, Spherical};
    for (kind, node) in [(Rigid, "rod@0"), (Spherical, "rod@0"), (Rigid, "rod@1"), (Spherical, "rod@0.5")] {
        let mut hold = clamp(node);
        hold.kind = kind;
        let scene = Scene {
            gravity: Some([0.3, -0.2, -9.81]),
            rod: vec![Rod::new("rod", line(LENGTH), circle(0.01), Some(steel()), 4, 2)],
            joint: vec![hold],
            probe: vec![probe("held", node)],
            dynamics: Some(Dynamics::new(0.1, 1e-3)),
            ..Scene::default()
        };
        let run = follow(&scene)?;
        let way = (0..run.rows.len())
            .map(|row| (place(&run, row, 0) - place(&run, 0, 0)).norm())
            .fold(0.0, f64::max);
        checks.below(
            Kind::Invariant,
            format!("way of the held node {node}, {kind:?}"),
            way,
            1e-13,
            "the joint holds it",
        );
    }
    Ok(())
}

fn falling(end: f64, step: f64) -> Scene {
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        body: vec![Body { velocity: [1.0, 0.0, 0.0], ..body("bob", 2.0, [1.0, 1.5, 2.0], [0.5, -1.0, 3.0]) }],
        probe: vec![probe("bob", "bob")],
        dynamics: Some(Dynamics::new(end, step)),
        ..Scene::default()
    }
}

fn last_step(checks: &mut Checks) -> Outcome {
    for (end, step, rows) in [(2.0, 0.6, 5.0), (1.0, 1.0 / 49.0, 50.0)] {
        let scene = falling(end, step);
        let options = scene.dynamics.as_ref().ok_or("no [dynamics]")?;
        let mut heard = Vec::new();
        let run = dynamics::solve(&Model::new(&scene)?, options, &mut |part, _| heard.push(part))?;
        let last = run.rows.last().ok_or("no rows")?;
        let parts: Vec<f64> = run.rows.iter().skip(1).map(|row| row.parameter / end).collect();
        checks.absolute(
            Kind::Invariant,
            format!("heard of every step, step {step}"),
            (f64::from(u8::from(heard == parts)), 1.0),
            0.0,
            "the part of the time that is done",
        );
        checks.absolute(
            Kind::Invariant,
            format!("rows, step {step}"),
            (run.rows.len() as f64, rows),
            0.0,
            "the start, whole steps, and a shorter last one only where it is one",
        );
        checks.absolute(
            Kind::Invariant,
            format!("last time, step {step}"),
            (last.parameter, end),
            0.0,
            "the end time itself",
        );
        checks.absolute(
            Kind::ClosedForm,
            format!("way, step {step}"),
            (last.probes[0].position[0], 0.5 + end),
            1e-12,
            "a constant velocity is integrated exactly, to the rounding of 50 steps",
        );
    }
    Ok(())
}

fn points(checks: &mut Checks) -> Outcome {
    let scene = |point: Option<[f64; 3]>| Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        body: vec![
            body("a", 1.0, [0.1, 0.2, 0.3], [0.0; 3]),
            body("b", 2.0, [0.3, 0.2, 0.4], [1.0, 0.5, -0.2]),
        ],
        joint: vec![
            Joint {
                name: None,
                kind: JointKind::Spherical,
                between: ["ground".into(), "a".into()],
                point: Some([0.0, 0.0, 0.5]),
                axis: None,
            },
            Joint {
                name: None,
                kind: JointKind::Spherical,
                between: ["a".into(), "b".into()],
                point,
                axis: None,
            },
        ],
        probe: vec![probe("a", "a"), probe("b", "b")],
        dynamics: Some(Dynamics::new(0.2, 1e-2)),
        ..Scene::default()
    };
    let (default, given) = (run(&scene(None))?, run(&scene(Some([1.0, 0.5, -0.2])))?);
    for k in 0..2 {
        let at = |run| Vector3::from(place(run, 20, k));
        checks.vector(
            Kind::Invariant,
            format!("body {k}"),
            (at(&default).into(), at(&given).into()),
            1e-13,
            "the same point: rounding of 20 steps",
        );
    }
    Ok(())
}

fn gravity(checks: &mut Checks) -> Outcome {
    let mut scene = falling(0.1, 0.1);
    let mut curve: Curve = line(LENGTH).into();
    curve.origin = [1.0, 2.0, 5.0];
    scene.rod = vec![Rod::new("rod", curve, circle(0.01), Some(steel()), 2, 2)];
    let mass = std::f64::consts::PI / 4.0 * 1e-4 * LENGTH * steel().density.ok_or("no density")?;
    // Exact for a fall.
    if let Some(options) = &mut scene.dynamics {
        options.method = Method::Radau;
    }
    let energies = run(&scene)?.energies;
    let way = 0.5 * 9.81 * 0.1 * 0.1;
    for (row, way) in [(0, 0.0), (1, way)] {
        let found = energies.get(row).ok_or("no energies")?.gravity;
        checks.relative(
            Kind::ClosedForm,
            format!("m g z in row {row}"),
            (found, 9.81 * (2.0 * (3.0 - way) + mass * (5.0 - way))),
            1e-13,
            "one product for each; the mass of the rod by quadrature, exact on a line",
        );
    }
    Ok(())
}

fn radau_loads(checks: &mut Checks) -> Outcome {
    let mut scene = falling(1.0, 0.25);
    scene.gravity = None;
    let mut push = load(LoadKind::Force, "bob", [2.0, -1.0, 0.5]);
    push.time = Some(LoadTime::Named(NamedTime::Ramp));
    scene.load = vec![push];
    if let Some(d) = &mut scene.dynamics {
        d.method = Method::Radau;
    }
    let run = run(&scene)?;
    let found = Vector3::from(place(&run, 4, 0)) - Vector3::new(1.5, -1.0, 3.0);
    checks.vector(
        Kind::ClosedForm,
        "way",
        (found.into(), (Vector3::new(2.0, -1.0, 0.5) / 12.0).into()),
        1e-13,
        "stage order 3: a cubic way to rounding",
    );
    Ok(())
}

/// The shipped pendulum with ten times its step. Whether Newton's iteration fails at 1.5 s or converges to nonsense,
/// which the balance of energy notices, is a matter of rounding; it must not go on.
fn runaway(checks: &mut Checks) -> Outcome {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/flexible_pendulum.toml");
    let mut scene = Scene::from_file(path)?;
    let Some(options) = &mut scene.dynamics else { return Err("the scene has no [dynamics]".into()) };
    options.step = Step::Constant(0.1);
    let options = options.clone();
    let outcome = dynamics::solve(&Model::new(&scene)?, &options, &mut |_, _| ());
    let stopped = outcome.is_err();
    checks.absolute(
        Kind::Invariant,
        "stopped",
        (f64::from(u8::from(stopped)), 1.0),
        0.0,
        "7 J of weight cannot bring the 4e7 J that the step at 1.5 s may converge to",
    );
    Ok(())
}

fn pair(checks: &mut Checks) -> Outcome {
    let rod = Rod::new(
        "rod",
        CurveShape::Helix { coils: 2.0, radius: 1.0, pitch: 0.5, phase: 0.0 },
        circle(0.1),
        Some(steel()),
        16,
        1,
    );
    let scene = Scene {
        rod: vec![rod],
        joint: vec![clamp("rod@0")],
        probe: ["rod@0.25", "rod@0.5", "rod@1"].map(|on| probe(&on.replace('@', " "), on)).to_vec(),
        modes: Some(Modes { count: 12 }),
        ..Scene::default()
    };
    let modes = vibrate(&scene)?.modes;
    for pair in modes.windows(2) {
        let d = pair[0]
            .shape
            .iter()
            .flatten()
            .zip(pair[1].shape.iter().flatten())
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        checks.above(
            Kind::Invariant,
            "neighbours differ",
            d,
            1e-6,
            "also where they are a complex pair; equal ones would differ by rounding",
        );
    }
    Ok(())
}

fn turned(checks: &mut Checks) -> Outcome {
    let far = Placement {
        name: "far",
        rotation: UnitQuaternion::from_scaled_axis(Vector3::new(0.7, -1.9, 0.4)),
        shift: Vector3::new(3e4, -2e4, 1e4),
    };
    let model = Model::new(&far.apply(&crate::cases::four_bar::scene([0, 1, 2, 3])))?;
    let named = matches!(model.warnings(), [w] if w.contains("3 of the 5"));
    checks.absolute(
        Kind::Invariant,
        "three of five constraints dropped, far away",
        (f64::from(u8::from(named)), 1.0),
        0.0,
        "a plane loop",
    );
    let hinge = |name, between, x: f64, y: f64| Joint {
        axis: Some([0.0, 0.0, 1.0]),
        ..joint(name, JointKind::Revolute, between, [x, y, 0.0])
    };
    // Bars of 1 at 1e-3 rad from line.
    let (c, s) = (1e-3_f64.cos(), 1e-3_f64.sin());
    let scene = Scene {
        body: vec![
            body("bar1", 1.0, [0.01, 0.1, 0.1], [0.5 * c, 0.5 * s, 0.0]),
            body("bar2", 2.0, [0.01, 0.7, 0.7], [1.0 + c, s, 0.0]),
            body("bar3", 1.0, [0.01, 0.1, 0.1], [2.0 + 0.5 * c, 0.5 * s, 0.0]),
        ],
        joint: vec![
            hinge("A", ["ground", "bar1"], 0.0, 0.0),
            hinge("B", ["bar1", "bar2"], c, s),
            hinge("C", ["bar2", "bar3"], 2.0 + c, s),
            hinge("D", ["ground", "bar3"], 2.0, 0.0),
        ],
        dynamics: Some(Dynamics::new(0.5, 1e-3)),
        ..Scene::default()
    };
    let model = Model::new(&scene)?;
    let named = matches!(model.warnings(), [w] if w.contains("3 of the 5"));
    checks.absolute(
        Kind::Invariant,
        "three of five constraints dropped, near the line",
        (f64::from(u8::from(named)), 1.0),
        0.0,
        "1e-3 rad from the dead point the others are independent",
    );
    Ok(())
}

/// A rod and a block, rigidly joined, that rest: the joint's rows of rotation are rounding, and closing them moves and
/// strains what is stiff. That energy no load has brought, and it is no sign of a step too long.
fn stiff_at_rest(checks: &mut Checks) -> Outcome {
    let (length, steps) = (100.0, 20);
    for (axial, degree) in [(1e10, 8), (1e12, 6), (1e13, 2)] {
        let section = Section::Custom {
            axial,
            shear_y: axial / 3.0,
            shear_z: axial / 3.0,
            torsion: 1e-3 * axial,
            bending_y: 1e-3 * axial,
            bending_z: 1e-3 * axial,
            mass_per_length: Some(1e-7 * axial),
            rotary_inertia: Some([2e-10 * axial, 1e-10 * axial, 1e-10 * axial]),
        };
        let mass = 1e-6 * axial;
        let mut block = body("block", mass, [mass, 2.0 * mass, 2.5 * mass], [length + 2.0, 1.0, -0.5]);
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(-0.4, 1.3, 0.9));
        block.orientation = [turn.w, turn.i, turn.j, turn.k];
        let weld = joint("weld", JointKind::Rigid, ["rod@1", "block"], [length, 0.0, 0.0]);
        let mut scene = Scene {
            rod: vec![Rod::new("rod", line(length), section, None, 20, degree)],
            body: vec![block],
            joint: vec![weld],
            probe: vec![probe("tip", "rod@1")],
            dynamics: Some(Dynamics::new(f64::from(steps) * 1e-2, 1e-2)),
            ..Scene::default()
        };
        for held in [false, true] {
            if held {
                scene.joint.push(clamp("rod@0"));
            }
            for placement in placements(length) {
                let run = follow(&placement.apply(&scene))?;
                let rows = run.rows.len();
                let label = |what: &str| {
                    format!("{what}, EA = {axial:e}, degree {degree}, held: {held}, {}", placement.name)
                };
                checks.absolute(
                    Kind::Invariant,
                    label("rows"),
                    (rows as f64, f64::from(steps) + 1.0),
                    0.0,
                    "it runs to the end",
                );
                checks.below(
                    Kind::Invariant,
                    label("way of the tip"),
                    (place(&run, rows - 1, 0) - place(&run, 0, 0)).norm(),
                    1e-11 * length,
                    "the joint is off by a few ε radian, over the length, and what follows is as small",
                );
                // That the joint's force is all noise may be said.
                let energy = run.warnings.iter().filter(|warning| warning.contains("energy"));
                checks.below(
                    Kind::Invariant,
                    label("warnings of energy"),
                    energy.count() as f64,
                    0.0,
                    "there is nothing to warn of",
                );
            }
        }
    }
    Ok(())
}

/// A free rod and a free body: a scene with a load would have no equilibrium to vibrate about.
fn no_gravity(checks: &mut Checks) -> Outcome {
    let mut scene = Scene {
        body: vec![body("bob", 2.0, [1.0, 1.5, 2.0], [0.0, 0.0, 1.0])],
        probe: vec![probe("bob", "bob")],
        modes: Some(Modes { count: 6 }),
        ..Scene::default()
    };
    for with_rod in [false, true] {
        if with_rod {
            scene.rod = vec![Rod::new("rod", line(LENGTH), circle(0.01), Some(steel()), 4, 2)];
            scene.modes = Some(Modes { count: 15 });
        }
        scene.gravity = None;
        let without = frequencies(&scene)?;
        scene.gravity = Some([0.0; 3]);
        let with = frequencies(&scene)?;
        let same = f64::from(u8::from(with == without && !with.is_empty()));
        checks.absolute(
            Kind::Invariant,
            format!("the same frequencies, with a rod: {with_rod}"),
            (same, 1.0),
            0.0,
            "the same arithmetic: bit for bit",
        );
    }
    Ok(())
}
