//! Static problems whose paths are known without finite elements.

use std::error::Error;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

use cosserat::Model;
use cosserat::scene::{
    Basis, CurveShape, InterpolationKind, Load, LoadKind, NodeSpacing, QuadratureKind, Reference, Rod, Scene,
    Section, Statics,
};
use cosserat::solution::ProbePose;
use cosserat::study::Trajectory;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::continuous::{Cantilever, Station};
use crate::measure::{clamp, load, probe};
use crate::pieces::line;
use crate::references::{Row, Table};

/// A scene and where its probes are at the tenths of its load.
#[derive(Clone, Debug)]
pub struct Problem {
    pub name: String,
    pub scene: Scene,
    pub exact: Trajectory,
}

/// The tenths of the load.
const MILESTONES: usize = 10;

/// The files under `references/` of [`loads`] and [`shapes`], of [`spring`], and of [`pulled_coils`].
pub const LOADS: [&str; 2] = ["continuous/static_loads.csv", "continuous/static_shapes.csv"];
pub const SPRINGS: [&str; 2] = ["continuous/static_spring_wire_end.csv", "continuous/static_spring_axis.csv"];
pub const COILS: [&str; 1] = ["continuous/static_two_coils.csv"];

/// Number of equal intervals of the rod, and those whose ends have probes.
pub type Stations = (usize, &'static [usize]);

/// Reads one of them.
pub type Read<'a> = &'a mut dyn FnMut(&str) -> Result<Table, Box<dyn Error>>;

impl Problem {
    /// With another scene for the same path.
    pub fn with(&self, what: &str, change: impl Fn(&mut Rod)) -> Self {
        let mut problem = self.clone();
        problem.name = format!("{}, {what}", self.name);
        problem.scene.rod.iter_mut().for_each(change);
        problem
    }

    pub fn se3(&self) -> Self {
        self.with("two-node SE(3)", |rod| {
            (rod.degree, rod.interpolation) = (1, InterpolationKind::Se3);
            // The scene as it is written must be sound: a helix of 9.4 rad, nodes less than half a turn apart.
            rod.elements = rod.elements.max(8);
        })
    }

    pub fn evenly_spaced(&self) -> Self {
        self.with("equal node spacing", |rod| rod.node_spacing = NodeSpacing::Equal)
    }

    pub fn fitted(&self) -> Self {
        self.with("fitted", |rod| rod.reference = Reference::Fit { samples: 121 })
    }

    pub fn fully_integrated(&self) -> Self {
        self.with("full quadrature", |rod| rod.quadrature = QuadratureKind::Full)
    }
}

fn pose(position: Vector3<f64>, rotation: UnitQuaternion<f64>) -> ProbePose {
    let q = rotation.into_inner();
    ProbePose { position: position.into(), quaternion: [q.w, q.i, q.j, q.k], angles: None }
}

/// From `x y z qw qx qy qz`, the position from `start`.
fn row_pose(row: &Row, start: [f64; 3]) -> Result<ProbePose, Box<dyn Error>> {
    let displacement: [f64; 3] = row.numbers("x y z")?;
    let position = std::array::from_fn(|k| start[k] + displacement[k]);
    Ok(ProbePose { position, quaternion: row.numbers("qw qx qy qz")?, angles: None })
}

/// A rod of the continuous equations with its curve, by shooting at every tenth of the load; probes at the given ones
/// of so many equal intervals, of which the end is the last.
fn shot(
    name: impl Into<String>,
    curve: CurveShape,
    cantilever: &Cantilever,
    (intervals, stations): Stations,
) -> Result<Problem, Box<dyn Error>> {
    let [axial, shear_y, shear_z] = cantilever.force_stiffness;
    let [torsion, bending_y, bending_z] = cantilever.moment_stiffness;
    let section = Section::Custom {
        axial,
        shear_y,
        shear_z,
        torsion,
        bending_y,
        bending_z,
        mass_per_length: None,
        rotary_inertia: None,
    };
    let mut loads = Vec::new();
    if cantilever.force != [0.0; 3] {
        loads.push(load(LoadKind::Force, "rod@1", cantilever.force));
    }
    if cantilever.body_moment != [0.0; 3] {
        let moment = load(LoadKind::Moment, "rod@1", cantilever.body_moment);
        loads.push(Load { basis: Basis::Body, ..moment });
    }
    let place = |station: usize| station as f64 / intervals as f64;
    let scene = Scene {
        rod: vec![Rod::new("rod", curve, section, None, 8, 2)],
        joint: vec![clamp("rod@0")],
        load: loads,
        probe: stations.iter().map(|&k| probe(&format!("p{k}"), &format!("rod@{}", place(k)))).collect(),
        statics: Some(Statics::default()),
        ..Scene::default()
    };
    let mut rows = Vec::new();
    for index in 1..=MILESTONES {
        let factor = index as f64 / MILESTONES as f64;
        let part = Cantilever {
            force: cantilever.force.map(|x| factor * x),
            body_moment: cantilever.body_moment.map(|x| factor * x),
            ..cantilever.clone()
        };
        let shape = part.solve(intervals)?;
        let poses = stations.iter().map(|&k| pose(shape.stations[k].position, shape.stations[k].rotation));
        rows.push((index, poses.collect()));
    }
    let at = if intervals > 1 { format!(", probes at {intervals}ths") } else { String::new() };
    let name = name.into() + &at;
    Ok(Problem { name, scene, exact: Trajectory { rows, size: cantilever.length } })
}

const TIP: Stations = (1, &[1]);

/// Straight along +e_x.
fn straight(length: f64, force_stiffness: [f64; 3], moment_stiffness: [f64; 3]) -> Cantilever {
    Cantilever {
        length,
        force_stiffness,
        moment_stiffness,
        reference_curvature: [0.0; 3],
        clamp: Station::default(),
        force: [0.0; 3],
        body_moment: [0.0; 3],
    }
}

/// EA = 5, GA = 1, EI = 2, L = 2π, dead force across.
pub fn cantilever(alpha_squared: f64, stations: Stations) -> Result<Problem, Box<dyn Error>> {
    let rod = Cantilever {
        force: [0.0, alpha_squared * 2.0 / TAU.powi(2), 0.0],
        ..straight(TAU, [5.0, 1.0, 1.0], [1.0, 2.0, 2.0])
    };
    shot(format!("cantilever, α² = {alpha_squared:.3}"), line(TAU), &rod, stations)
}

/// 45° bend: radius 100, square section, dead force out of the plane.
pub fn bend(
    (width, torsion_constant, force): (f64, f64, f64),
    stations: Stations,
) -> Result<Problem, Box<dyn Error>> {
    let (young, radius) = (1e7, 100.0);
    let (area, second, shear) = (width * width, width.powi(4) / 12.0, 0.5 * young);
    let length = radius * FRAC_PI_4;
    let rod = Cantilever {
        reference_curvature: [0.0, 0.0, 1.0 / radius],
        force: [0.0, 0.0, force],
        ..straight(
            length,
            [young * area, shear * area, shear * area],
            [shear * torsion_constant, young * second, young * second],
        )
    };
    let name = format!("45° bend, F = {force:e}, width {width}");
    shot(name, CurveShape::Arc { radius, angle: FRAC_PI_4 }, &rod, stations)
}

/// A straight slender rod bent to so many turns by an end moment.
pub fn roll_up(turns: f64, stations: Stations) -> Result<Problem, Box<dyn Error>> {
    let (length, diameter, young) = (2.0, 0.02_f64, 2e9);
    let (area, second, shear) = (PI * diameter.powi(2) / 4.0, PI * diameter.powi(4) / 64.0, young / 2.6);
    let bending = young * second;
    let rod = Cantilever {
        body_moment: [0.0, 0.0, TAU * turns * bending / length],
        ..straight(
            length,
            [young * area, shear * area, shear * area],
            [2.0 * shear * second, bending, bending],
        )
    };
    shot(format!("{turns} turns"), line(length), &rod, stations)
}

const COIL_RADIUS: f64 = 10.0;
/// 2πn.
const COIL_TURN: f64 = 2.0 * TAU;
/// c = h/(2πnR).
const SLOPE: f64 = 50.0 / (COIL_TURN * COIL_RADIUS);

/// EI and EA for E = 1, GI_p = EI for G = 1/2, and the length.
fn coil(slenderness: f64) -> (f64, f64, f64) {
    let length = 1.0_f64.hypot(SLOPE) * COIL_TURN * COIL_RADIUS;
    let diameter = length / slenderness;
    (PI * diameter.powi(4) / 64.0, PI * diameter.powi(2) / 4.0, length)
}

/// A straight rod bent to two coils by a moment that turns with its end.
pub fn two_coils(slenderness: f64) -> Result<Problem, Box<dyn Error>> {
    let (second, area, length) = coil(slenderness);
    let from = [0.0, -COIL_RADIUS, 0.0];
    let along = COIL_TURN * COIL_RADIUS;
    let curve = CurveShape::Line {
        length: None,
        from: Some(from),
        to: Some([along, -COIL_RADIUS, SLOPE * along]),
        normal: Some([0.0, 1.0, 0.0]),
    };
    let curvature = COIL_RADIUS * (COIL_TURN / length).powi(2);
    let rod = Cantilever {
        clamp: Station { position: from.into(), rotation: tilted(SLOPE) },
        body_moment: [second * curvature * SLOPE, 0.0, second * curvature],
        ..straight(length, [area, 0.5 * area, 0.5 * area], [second, second, second])
    };
    shot(format!("two coils by a moment, slenderness {slenderness:e}"), curve, &rod, TIP)
}

/// The same with a dead force on top, for which shooting is too sensitive: what the file has of the tenths.
pub fn pulled_coils(words: &str, slenderness: f64, read: Read) -> Result<Problem, Box<dyn Error>> {
    let mut problem = two_coils(slenderness)?;
    let (second, _, length) = coil(slenderness);
    let force = [2.0, -6.0, 9.0].map(|share| share * second / length.powi(2));
    problem.scene.load.push(load(LoadKind::Force, "rod@1", force));
    problem.name = format!("two coils and a force, slenderness {words}");
    problem.exact.rows.clear();
    for row in read(COILS[0])?.select(&[("slenderness", words)])? {
        let tenth = MILESTONES as f64 * row.number("factor")?;
        if (tenth - tenth.round()).abs() < 1e-9 {
            problem.exact.rows.push((tenth.round() as usize, vec![row_pose(&row, [0.0; 3])?]));
        }
    }
    Ok(problem)
}

/// e_x along (1, 0, c), e_y along y.
fn tilted(slope: f64) -> UnitQuaternion<f64> {
    let stretch = 1.0_f64.hypot(slope);
    UnitQuaternion::from_matrix(&Matrix3::from_columns(&[
        Vector3::new(1.0, 0.0, slope) / stretch,
        Vector3::y(),
        Vector3::new(-slope, 0.0, 1.0) / stretch,
    ]))
}

/// A quarter turn by a moment and a dead force out of its plane.
pub fn quarter_turn(slenderness: f64, stations: Stations) -> Result<Problem, Box<dyn Error>> {
    let rod = crate::cases::convergence_orders::continuous(slenderness);
    let name = format!("quarter turn, slenderness {slenderness:e}");
    shot(name, line(rod.length), &rod, stations)
}

/// A thin strip with a force at an angle to it.
pub fn princeton(degrees: f64) -> Result<Problem, Box<dyn Error>> {
    use crate::cases::princeton::{HEIGHT, LENGTH, POISSON, WIDTH, YOUNG, force, torsion_constant};
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let area = WIDTH * HEIGHT;
    let bending = |height: f64| YOUNG * area * height.powi(2) / 12.0;
    let rod = Cantilever {
        force: force(degrees),
        ..straight(
            LENGTH,
            [YOUNG * area, shear * area, shear * area],
            [shear * torsion_constant(), bending(HEIGHT), bending(WIDTH)],
        )
    };
    shot(format!("Princeton beam, {degrees}°"), line(LENGTH), &rod, TIP)
}

/// The helical spring pulled at the end of the wire or on its axis, up to 10 or 100 N: what the file has of the tenths.
pub fn spring(force: f64, on_axis: bool, read: Read) -> Result<Problem, Box<dyn Error>> {
    let scene =
        crate::cases::spring::Spring { on_axis, ..crate::cases::spring::Spring::new(force, 75, 2) }.scene();
    let model = Model::new(&scene)?;
    let offset = scene.probe[0].offset.unwrap_or_default();
    let start = model.pose(model.reference_state(), 0, 1.0, &offset.into())?.position;
    let table = read(SPRINGS[usize::from(on_axis)])?;
    let mut rows = Vec::new();
    for row in table.rows() {
        let tenth = MILESTONES as f64 * row.number("force")? / force;
        if tenth > 0.5 && tenth < 10.5 && (tenth - tenth.round()).abs() < 1e-9 {
            rows.push((tenth.round() as usize, vec![row_pose(&row, start.into())?]));
        }
    }
    let size = crate::cases::spring::wire_length(crate::cases::spring::PITCH);
    let where_ = if on_axis { "on its axis" } else { "at the wire's end" };
    Ok(Problem { name: format!("spring, {force} N {where_}"), scene, exact: Trajectory { rows, size } })
}

/// Every kind of load on a rod of 2 m, the tip at every tenth.
pub fn loads(read: Read) -> Result<Vec<Problem>, Box<dyn Error>> {
    let table = read(LOADS[0])?;
    let mut problems: Vec<Problem> = Vec::new();
    for row in table.rows() {
        let word = row.word("problem")?;
        if problems.last().is_none_or(|last| last.name != word) {
            let scene = crate::cases::static_rods::scene(word, 2, &[1.0])?;
            let rows = Vec::new();
            problems.push(Problem {
                name: word.to_string(),
                scene,
                exact: Trajectory { rows, size: length(word) },
            });
        }
        let index = (MILESTONES as f64 * row.number("factor")?).round() as usize;
        if let Some(problem) = problems.last_mut() {
            problem.exact.rows.push((index, vec![row_pose(&row, [0.0; 3])?]));
        }
    }
    Ok(problems)
}

/// The whole shape of some of them under the whole load.
pub fn shapes(read: Read) -> Result<Vec<Problem>, Box<dyn Error>> {
    let table = read(LOADS[1])?;
    let mut problems: Vec<Problem> = Vec::new();
    let mut stations = Vec::new();
    for row in table.rows() {
        let word = row.word("problem")?;
        let name = format!("shape, {word}");
        if problems.last().is_none_or(|last| last.name != name) {
            stations.clear();
            let rows = vec![(MILESTONES, Vec::new())];
            let exact = Trajectory { rows, size: length(word) };
            problems.push(Problem { name, scene: Scene::default(), exact });
        }
        stations.push(row.number("xi")?);
        if let Some(problem) = problems.last_mut() {
            problem.scene = crate::cases::static_rods::scene(word, 2, &stations)?;
            problem.exact.rows[0].1.push(row_pose(&row, [0.0; 3])?);
        }
    }
    Ok(problems)
}

/// Of the rods of `static_rods`.
fn length(problem: &str) -> f64 {
    if problem == "all on a helix" { (TAU * 1.5 * 0.3_f64).hypot(1.5 * 0.25) } else { 2.0 }
}
