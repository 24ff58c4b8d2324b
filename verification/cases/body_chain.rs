//! Three bodies on a ball joint, an oblique hinge and a ball joint, in space.
//!
//! The references are Kane's equations in seven coordinates, `scripts/rigid_bodies.py`: poses good to 1e-12, forces to
//! 3e-12.

use cosserat::scene::{Body, Dynamics, Joint, JointKind, Scene};
use nalgebra::{UnitQuaternion, Vector3};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::probe;
use crate::placement::{Placement, placements};
use crate::steps::{
    body, check_second_order, check_vanishes, energy_error, force_at, halved_twice, joint, position_at,
    quaternion_at, rotation, run, violation,
};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    let source = "Kane's equations in seven coordinates, scripts/rigid_bodies.py";
    vec![
        Case::new("body_chain::moving", source, |checks| order(checks, true, &MOVING)),
        Case::new("body_chain::at_rest", source, |checks| order(checks, false, &AT_REST)),
        Case::new("body_chain::far_away", "objectivity", far_away),
        Case::new("body_chain::twice_the_same", "the same arithmetic", twice_the_same),
    ]
}

/// t, (position, quaternion) of the bodies, force of the ground on the first.
pub type Exact = (f64, [([f64; 3], [f64; 4]); 3], [f64; 3]);

#[rustfmt::skip]
pub const MOVING: [Exact; 2] = [
    (0.5, [
        ([-0.0314266933254025, 0.227037546749127, -0.295747046160683], [0.866342422469836, 0.0219640005053867, 0.335598432596506, 0.369245286699321]),
        ([-0.119145734549081, 0.474015250749925, -0.800749055090747], [0.241392467848677, 0.263543474941956, 0.178679294838679, 0.916705090461156]),
        ([-0.2057700561487, 0.933346630462492, -1.07540659704454], [0.507088607408787, -0.0235544594449308, 0.861079605671412, 0.0291246351606369]),
    ], [7.69837625594611, -13.9039474090139, 25.0734667704136]),
    (1.0, [
        ([-0.127292909287294, -0.230477443288223, -0.265850829189041], [0.603955589015156, -0.492500338868098, 0.602356052289422, 0.172766457920711]),
        ([-0.449986840871086, -0.651555990456736, -0.55687255099969], [0.197389456510723, 0.368271851211183, 0.756667166520153, 0.502859866338778]),
        ([-0.814341178542876, -0.807567450712178, -0.889855866340648], [0.193871214437501, -0.715115108052775, 0.641807924791112, -0.197754701897384]),
    ], [13.5776343283029, 19.0599762338826, 22.9097237084787]),
];

#[rustfmt::skip]
const AT_REST: [Exact; 2] = [
    (0.5, [
        ([0.0606750195888635, 0.0052282876147899, -0.369176390098972], [0.873812726993709, 0.0154481251805065, 0.41437320140802, -0.253983313481603]),
        ([0.0286368182001065, 0.0232583242410018, -0.945981446270774], [0.719934416697578, 0.355065266327211, 0.231110656545105, 0.549737170594817]),
        ([0.167782696092828, 0.157064504847092, -1.43605794705841], [0.421995089029231, -0.0975466460060756, 0.788251269860271, -0.437109519745163]),
    ], [-2.62279352594521, -5.42282798702282, 36.5313181217038]),
    (1.0, [
        ([-0.262091894395224, -0.110459635572477, -0.243118300013632], [0.460635912822478, -0.16215499325519, 0.568688919636318, -0.66190122122828]),
        ([-0.718942380448085, -0.211490139440384, -0.531878422904726], [0.795119367908225, 0.279041039869675, 0.537051035539639, -0.0386972101252325]),
        ([-0.992728338635766, -0.421694333087858, -0.945382864069113], [0.133110534960745, -0.494988197321226, 0.784953080588515, -0.348018578914614]),
    ], [8.70803071694046, 2.12592799403068, 13.1486343083667]),
];

const STEP: f64 = 2e-3;

/// The chain, moving or at rest.
pub fn scene(moving: bool, step: f64) -> Scene {
    let bodies = [
        Body {
            velocity: [0.0, 0.7, 0.35],
            angular_velocity: [0.5, -1.0, 2.0],
            ..body("body1", 1.2, [0.02, 0.03, 0.04], [0.3, 0.1, -0.2])
        },
        Body {
            orientation: [0.6, 0.0, 0.0, 0.8],
            velocity: [0.1, 2.0, 0.55],
            angular_velocity: [-0.28, -0.96, 3.0],
            ..body("body2", 0.8, [0.015, 0.01, 0.02], [0.7, 0.2, -0.6])
        },
        Body {
            orientation: [0.8, 0.0, 0.6, 0.0],
            velocity: [-0.9, 2.7, 0.35],
            angular_velocity: [-1.24, 2.0, -0.68],
            ..body("body3", 0.5, [0.006, 0.008, 0.004], [1.0, 0.6, -0.8])
        },
    ];
    let still = |body: Body| Body { velocity: [0.0; 3], angular_velocity: [0.0; 3], ..body };
    let hinge = joint("hinge", JointKind::Revolute, ["body1", "body2"], [0.5, 0.3, -0.4]);
    Scene {
        gravity: Some([0.0, 0.0, -9.81]),
        body: bodies.into_iter().map(|body| if moving { body } else { still(body) }).collect(),
        joint: vec![
            joint("ball", JointKind::Spherical, ["ground", "body1"], [0.0; 3]),
            Joint { axis: Some([1.0, 2.0, 2.0]), ..hinge },
            joint("end", JointKind::Spherical, ["body2", "body3"], [0.9, 0.4, -0.7]),
        ],
        probe: ["body1", "body2", "body3"].map(|name| probe(name, name)).to_vec(),
        dynamics: Some(Dynamics::new(1.0, step)),
        ..Scene::default()
    }
}

fn order(checks: &mut Checks, moving: bool, table: &[Exact]) -> Outcome {
    for placement in placements(1.0) {
        let runs = halved_twice(&placement.apply(&scene(moving, STEP)))?;
        for &(time, bodies, force) in table {
            for (index, (position, quaternion)) in bodies.into_iter().enumerate() {
                let label =
                    |what: &str| format!("{what} of body {} at {time} s, {}", index + 1, placement.name);
                let (mut x, mut q) = (Vec::new(), Vec::new());
                for run in &runs {
                    x.push(position_at(run, time, index, &placement)?);
                    q.push(quaternion_at(run, time, index, &placement, quaternion)?);
                }
                let slices = [x[0].as_slice(), x[1].as_slice(), x[2].as_slice()];
                check_second_order(checks, &label("position"), slices, &position);
                check_second_order(checks, &label("rotation"), [&q[0], &q[1], &q[2]], &quaternion);
            }
            let mut f = Vec::new();
            for run in &runs {
                f.push(force_at(run, time, 0, &placement)?);
            }
            let slices = [f[0].as_slice(), f[1].as_slice(), f[2].as_slice()];
            check_second_order(checks, &format!("force at {time} s, {}", placement.name), slices, &force);
        }
        let errors = [0, 1, 2].map(|k| energy_error(&runs[k]));
        check_vanishes(checks, &format!("energy, {}", placement.name), errors);
        for run in &runs {
            let label = format!("joints, {}", placement.name);
            let reason =
                "Newton's test: 1e-9 of the way in a step, at up to 10 m/s or 30 rad/s; and rounding";
            checks.below(Kind::Invariant, label, violation(run), 1e-9 * STEP * 30.0 + 1e-14, reason);
            let mean = run.statistics.newton_iterations as f64 / run.statistics.increments as f64;
            checks.below(Kind::Pinned, "iterations a step", mean, 3.0, "the first step starts from a = ẏ");
        }
    }
    Ok(())
}

/// 1 km away and turned by more than half a turn.
fn far_away(checks: &mut Checks) -> Outcome {
    let near = &placements(1.0)[0];
    let far = Placement {
        name: "far",
        rotation: UnitQuaternion::from_scaled_axis(Vector3::new(2.1, -3.3, 1.7)),
        shift: 1e3 * Vector3::new(0.6, -0.64, 0.48),
    };
    let [here, there] = [near, &far].map(|placement| run(&placement.apply(&scene(true, STEP))));
    let (here, there) = (here?, there?);
    let reason = "the scene's numbers round to 1e-13 at 1 km; Newton stops within 1e-9 of the forces, which 60 m/s² over \
                  half the second's square make 3e-8";
    for time in [0.1, 0.5, 1.0] {
        for index in 0..3 {
            let pair = (position_at(&there, time, index, &far)?, position_at(&here, time, index, near)?);
            let label = format!("position of body {} at {time} s", index + 1);
            checks.vector(Kind::Invariant, label, (pair.0.into(), pair.1.into()), 3e-8, reason);
            let q = quaternion_at(&here, time, index, near, [1.0, 0.0, 0.0, 0.0])?;
            let turned = rotation(quaternion_at(&there, time, index, &far, q)?).angle_to(&rotation(q));
            let label = format!("rotation of body {} at {time} s", index + 1);
            checks.below(Kind::Invariant, label, turned, 3e-7, "the same at arms of 0.1 m and more");
        }
    }
    Ok(())
}

fn twice_the_same(checks: &mut Checks) -> Outcome {
    let [first, second] = [0, 1].map(|_| run(&scene(true, STEP)));
    let same = f64::from(u8::from(first? == second?));
    let reason = "no thread, no clock and no random number is in the way: bit for bit";
    checks.absolute(Kind::Invariant, "two runs are equal", (same, 1.0), 0.0, reason);
    Ok(())
}
