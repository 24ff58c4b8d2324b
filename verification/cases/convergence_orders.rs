//! A straight rod bent out of its plane by a quarter-turn moment and a dead tip force: orders of convergence.

use std::error::Error;
use std::f64::consts::TAU;

use cosserat::scene::{Basis, InterpolationKind, LoadKind, NodeSpacing, QuadratureKind, Rod, Scene, Statics};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::static_rods::load_path;
use crate::case::{Case, Checks, Kind, Outcome};
use crate::continuous::{Cantilever, Shape, Station, angle};
use crate::measure::{clamp, load, probe, solve};
use crate::pieces::{line, rectangle, young_shear};
use crate::placement::{Placement, placements};
use crate::tip::{Exact, check_tip};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str =
        "Harsch, Sailer & Eugster 2023, section 5.1; errors against the continuous equations";
    vec![
        Case::new("convergence_orders::tip", SOURCE, tip).reads(&[TIPS]),
        Case::new("convergence_orders::r12", SOURCE, r12),
        Case::new("convergence_orders::r12_values", SOURCE, r12_values),
        Case::new("convergence_orders::quaternion", SOURCE, quaternion)
            .awaits("interpolation = \"quaternion\""),
        Case::new("convergence_orders::se3", SOURCE, se3),
        Case::new("convergence_orders::full_quadrature_locks", SOURCE, full_quadrature_locks),
    ]
}

const LENGTH: f64 = 1000.0;
const YOUNG: f64 = 1.0;
const SHEAR: f64 = 0.5;
/// Points of the root mean square, evenly from ξ = 0 to ξ = 1.
const POINTS: usize = 100;

/// The tips.
pub const TIPS: &str = "continuous/static_quarter_turn.csv";
/// In the file's words and as a number.
const SLENDERNESS: [(&str, f64); 2] = [("100.0", 1e2), ("10000.0", 1e4)];

/// Slenderness and tip.
pub fn tips(checks: &mut Checks) -> Result<Vec<(f64, Exact)>, Box<dyn Error>> {
    let table = checks.reference(TIPS)?;
    let exact = |(words, slenderness)| {
        let row = table.row(&[("slenderness", words), ("factor", "1.0")])?;
        Ok((slenderness, Exact::of(&row, LENGTH, 1e-10)?))
    };
    SLENDERNESS.into_iter().map(exact).collect()
}

/// The problem without finite elements.
pub fn continuous(slenderness: f64) -> Cantilever {
    let width = LENGTH / slenderness;
    let (area, second) = (width * width, width.powi(4) / 12.0);
    let moment = YOUNG * second * TAU / LENGTH / 4.0;
    Cantilever {
        length: LENGTH,
        force_stiffness: [YOUNG * area, SHEAR * area, SHEAR * area],
        moment_stiffness: [SHEAR * 2.0 * second, YOUNG * second, YOUNG * second],
        reference_curvature: [0.0; 3],
        clamp: Station::default(),
        force: [0.0, 0.0, moment / LENGTH],
        body_moment: [0.0, 0.0, moment],
    }
}

/// One rung.
#[derive(Clone, Copy, Debug)]
struct Mesh {
    slenderness: f64,
    interpolation: InterpolationKind,
    quadrature: QuadratureKind,
    node_spacing: NodeSpacing,
    degree: usize,
    elements: usize,
}

impl Mesh {
    /// R12 with the defaults.
    fn r12(slenderness: f64, degree: usize, elements: usize) -> Self {
        Self {
            slenderness,
            interpolation: InterpolationKind::default(),
            quadrature: QuadratureKind::default(),
            node_spacing: NodeSpacing::default(),
            degree,
            elements,
        }
    }
}

fn scene(mesh: &Mesh) -> Scene {
    let width = LENGTH / mesh.slenderness;
    let mut rod = Rod::new(
        "rod",
        line(LENGTH),
        rectangle(width, width, None),
        Some(young_shear(YOUNG, SHEAR)),
        mesh.elements,
        mesh.degree,
    );
    rod.interpolation = mesh.interpolation;
    rod.quadrature = mesh.quadrature;
    rod.node_spacing = mesh.node_spacing;
    let moment = YOUNG * width.powi(4) / 12.0 * TAU / LENGTH / 4.0;
    let mut turning = load(LoadKind::Moment, "rod@1", [0.0, 0.0, moment]);
    turning.basis = Basis::Body;
    Scene {
        rod: vec![rod],
        joint: vec![clamp("rod@0")],
        load: vec![turning, load(LoadKind::Force, "rod@1", [0.0, 0.0, moment / LENGTH])],
        probe: (0..POINTS)
            .map(|k| {
                let xi = k as f64 / (POINTS - 1) as f64;
                probe(&format!("p{k}"), &format!("rod@{xi}"))
            })
            .collect(),
        statics: Some(Statics::default()),
        ..Scene::default()
    }
}

/// Root mean square errors of centreline and rotation.
fn errors(mesh: &Mesh, placement: &Placement, exact: &Shape) -> Result<[f64; 2], Box<dyn Error>> {
    let solution = solve(&placement.apply(&scene(mesh)))?;
    let row = solution.rows.last().ok_or("no rows")?;
    let mut sums = [0.0; 2];
    for (pose, station) in row.probes.iter().zip(&exact.stations) {
        let position = placement.undo_position(Vector3::from(pose.position));
        let [w, x, y, z] = pose.quaternion;
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let rotation = placement.rotation.inverse() * rotation;
        sums[0] += (position - station.position).norm_squared();
        sums[1] += angle(&rotation, &station.rotation).powi(2);
    }
    Ok(sums.map(|sum| (sum / POINTS as f64).sqrt()))
}

/// The errors on a ladder of meshes, centreline and rotation apart.
fn ladder(
    mesh: &Mesh,
    ladder: &[usize],
    placement: &Placement,
    exact: &Shape,
) -> Result<[Vec<f64>; 2], Box<dyn Error>> {
    let (mut centreline, mut rotation) = (Vec::new(), Vec::new());
    for &elements in ladder {
        let [r, phi] = errors(&Mesh { elements, ..*mesh }, placement, exact)?;
        centreline.push(r);
        rotation.push(phi);
    }
    Ok([centreline, rotation])
}

const ORDER: &str = "the next term of the error is smaller by a power of h: 0.1 leaves room for it and tells \
                     neighbouring orders apart";
/// Elements of the ladders for p ≤ 4; more run into rounding at p = 4.
const MESHES: [usize; 3] = [4, 8, 16];

/// e_r and e_rot of R12, p = 2, slenderness 1e2, for 2, 4, 8, 16 elements, with a unit of the last digit.
const QUADRATIC: [(usize, [f64; 2], [f64; 2]); 4] = [
    (2, [2.1819, 1e-4], [2.647e-3, 1e-6]),
    (4, [0.26008, 1e-5], [3.097e-4, 1e-7]),
    (8, [0.032135, 1e-6], [3.817e-5, 1e-8]),
    (16, [0.0040051, 1e-7], [4.753e-6, 1e-9]),
];

/// What the finest mesh may be off by at most, in centreline and rotation, and why.
fn caps(degree: usize) -> ([f64; 2], &'static str) {
    let [.., (_, [r, _], [phi, _])] = QUADRATIC;
    match degree {
        1 => {
            // |m| ≤ M + F L = 2 M, and G I_t = E I: κ L ≤ 2 · TAU/4.
            let turn = 2.0 * TAU / 4.0;
            let small = (turn / 16.0).powi(2);
            let caps = [LENGTH * small * (turn / 12.0 + 0.125), turn * small / 6.0];
            (
                caps,
                "strains of linear elements are off by (κh)²/6 in bending and (κh)²/8 in stretch (roll_up::linear_r12)",
            )
        }
        2 => ([1.001 * r, 1.001 * phi], "the table's value, and a unit of its last digits"),
        _ => ([r, phi], "more degrees of freedom must not be worse than p = 2"),
    }
}

/// The tip, and on its way.
fn tip(checks: &mut Checks) -> Outcome {
    for (slenderness, exact) in tips(checks)? {
        let name = format!("slenderness {slenderness:.0e}");
        check_tip(checks, &name, &|elements| with_tip(slenderness, elements), 24, &exact)?;
    }
    let table = checks.reference(TIPS)?;
    for (words, slenderness) in SLENDERNESS {
        let rows = table.select(&[("slenderness", words)])?;
        let title = format!("body end moment and dead tip force, slenderness {slenderness:.0e}");
        load_path(checks, &title, &with_tip(slenderness, 24), 1.0, rows, "factor")?;
    }
    Ok(())
}

/// Elements of degree 4, probe 0 at the tip.
fn with_tip(slenderness: f64, elements: usize) -> Scene {
    let mut scene = scene(&Mesh::r12(slenderness, 4, elements));
    scene.probe = vec![probe("tip", "rod@1")];
    scene
}

/// The absolute caps on the finest mesh, and why.
type Caps = fn(usize) -> ([f64; 2], &'static str);

fn r12(checks: &mut Checks) -> Outcome {
    orders(checks, InterpolationKind::R12, caps)
}

/// Positions as with R12, and the nodal quaternions in between.
fn quaternion(checks: &mut Checks) -> Outcome {
    let caps = |degree| {
        // κ h, with κ as in `caps`.
        let turn = 0.5 * TAU / MESHES[2] as f64;
        let remainder = turn.powi(degree as i32 + 1);
        (
            [LENGTH * remainder, remainder],
            "the remainder of an interpolation, (κh)^(p+1) with a constant of one",
        )
    };
    orders(checks, InterpolationKind::Quaternion, caps)
}

fn orders(checks: &mut Checks, interpolation: InterpolationKind, caps: Caps) -> Outcome {
    for (_, slenderness) in SLENDERNESS {
        let exact = continuous(slenderness).solve(POINTS - 1)?;
        for (degree, node_spacing) in [
            (1, NodeSpacing::GaussLobatto),
            (2, NodeSpacing::GaussLobatto),
            (3, NodeSpacing::GaussLobatto),
            (3, NodeSpacing::Equal),
            (4, NodeSpacing::GaussLobatto),
            (4, NodeSpacing::Equal),
        ] {
            let mesh = Mesh { node_spacing, interpolation, ..Mesh::r12(slenderness, degree, 1) };
            let (caps, reason) = caps(degree);
            for placement in placements(LENGTH) {
                let errors = ladder(&mesh, &MESHES, &placement, &exact)?;
                for (what, errors, cap) in
                    [("centreline", &errors[0], caps[0]), ("rotation", &errors[1], caps[1])]
                {
                    let name = format!(
                        "{what}, {interpolation:?}, p = {degree}, {node_spacing:?}, slenderness {slenderness:.0e}, {}",
                        placement.name
                    );
                    checks.order(&name, &MESHES, errors, ((degree + 1) as f64, 0.1), ORDER);
                    checks.below(Kind::Order, name, errors[MESHES.len() - 1], cap, reason);
                }
            }
        }
    }
    Ok(())
}

fn r12_values(checks: &mut Checks) -> Outcome {
    let thick = continuous(1e2).solve(POINTS - 1)?;
    let thin = continuous(1e4).solve(POINTS - 1)?;
    for (elements, centreline, rotation) in QUADRATIC {
        for placement in placements(LENGTH) {
            let thick = errors(&Mesh::r12(1e2, 2, elements), &placement, &thick)?;
            let thin = errors(&Mesh::r12(1e4, 2, elements), &placement, &thin)?;
            let table = [("e_r", centreline), ("e_rot", rotation)];
            for (k, (what, [value, unit])) in table.into_iter().enumerate() {
                let name = format!("{what}, p = 2, {elements} elements, {}", placement.name);
                checks.absolute(
                    Kind::ClosedForm,
                    &name,
                    (thick[k], value),
                    unit,
                    "a unit of the last printed digit",
                );
                checks.relative(
                    Kind::Invariant,
                    format!("{name}: slenderness 1e4 against 1e2"),
                    (thin[k], thick[k]),
                    1e-4,
                    "stretch and shear are 1/slenderness² = 1e-4 of bending at 1e2, less at 1e4: without locking the \
                     errors cannot differ by more",
                );
            }
        }
    }
    Ok(())
}

fn se3(checks: &mut Checks) -> Outcome {
    let meshes = [4, 8, 16, 32];
    let table = [(3.1193, 1e-4), (0.77498, 1e-5), (0.19345, 1e-5), (0.048342, 1e-6)];
    for (_, slenderness) in SLENDERNESS {
        let exact = continuous(slenderness).solve(POINTS - 1)?;
        let mesh = Mesh { interpolation: InterpolationKind::Se3, ..Mesh::r12(slenderness, 1, 1) };
        for placement in placements(LENGTH) {
            let errors = ladder(&mesh, &meshes, &placement, &exact)?;
            for (what, errors) in [("centreline", &errors[0]), ("rotation", &errors[1])] {
                let name = format!("{what}, SE(3), slenderness {slenderness:.0e}, {}", placement.name);
                checks.order(name, &meshes, errors, (2.0, 0.1), ORDER);
            }
            for ((elements, error), (value, unit)) in meshes.iter().zip(&errors[0]).zip(table) {
                checks.absolute(
                    Kind::ClosedForm,
                    format!("e_r, {elements} elements, slenderness {slenderness:.0e}, {}", placement.name),
                    (*error, value),
                    unit + 1e-4 * value,
                    "a unit of the last printed digit; stretch and shear, which slenderness changes, are 1e-4 of \
                     bending or less",
                );
            }
        }
    }
    Ok(())
}

/// Locking is there to be seen: an integration that is exact for the polynomials couples bending to stretch and shear.
fn full_quadrature_locks(checks: &mut Checks) -> Outcome {
    let thick = continuous(1e2).solve(POINTS - 1)?;
    let thin = continuous(1e4).solve(POINTS - 1)?;
    let full = |slenderness, degree, elements| Mesh {
        quadrature: QuadratureKind::Full,
        ..Mesh::r12(slenderness, degree, elements)
    };
    let table = [
        (1, 4, 345.0, 1.0),
        (1, 32, 279.0, 1.0),
        (2, 2, 261.0, 1.0),
        (2, 4, 158.0, 1.0),
        (2, 8, 40.0, 1.0),
        (2, 16, 3.5, 0.1),
    ];
    for placement in placements(LENGTH) {
        for (degree, elements, value, unit) in table {
            let name = format!("p = {degree}, {elements} elements, {}", placement.name);
            let [locked, _] = errors(&full(1e2, degree, elements), &placement, &thick)?;
            let [free, _] = errors(&Mesh::r12(1e2, degree, elements), &placement, &thick)?;
            checks.absolute(
                Kind::ClosedForm,
                format!("e_r, {name}"),
                (locked, value),
                unit,
                "a unit of the last printed digit",
            );
            checks.above(
                Kind::Order,
                format!("e_r over that of reduced quadrature, {name}"),
                locked / free,
                10.0,
                "locking is an order of magnitude, or it is none",
            );
        }
        let [locked, _] = errors(&full(1e4, 1, 32), &placement, &thin)?;
        let [deflection, _] = errors(&full(1e4, 1, 1), &placement, &thin)?;
        checks.above(
            Kind::Order,
            format!("e_r of 32 linear elements over that of one, slenderness 1e4, {}", placement.name),
            locked / deflection,
            0.99,
            "shear energy outweighs bending by (h/w)², 1e5 here: the rod does not move at all",
        );
    }
    Ok(())
}
