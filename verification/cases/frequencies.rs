//! Axial, torsional and bending vibrations of straight rods, slender and stocky, held in three ways.

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};

use cosserat::scene::{Joint, JointKind, Material, Modes, Rod, Scene, Section};

use crate::case::{Case, Checks, Kind, Outcome};
use crate::measure::clamp;
use crate::motion::{frequencies, joint, vibrate};
use crate::pieces::{circle, line, rectangle, young_poisson};
use crate::placement::{Placement, placements};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    const SOURCE: &str = "Timoshenko's equations by Huang's determinants and by transfer matrices; axial and torsional: closed form";
    vec![
        Case::new("frequencies::slender", SOURCE, slender).reads(&[FILE]),
        Case::new("frequencies::stocky", SOURCE, stocky).reads(&[FILE]),
        Case::new("frequencies::hinged", SOURCE, hinged).reads(&[FILE]),
        Case::new(
            "frequencies::euler_bernoulli",
            "closed form, nπ; Timoshenko's first correction",
            euler_bernoulli,
        ),
        Case::new("frequencies::count", "counting", count),
    ]
}

/// E = 2e11, ν = 0.3, ρ = 7800.
pub fn steel() -> Material {
    Material { density: Some(DENSITY), ..young_poisson(YOUNG, POISSON) }
}

pub const YOUNG: f64 = 2e11;
pub const POISSON: f64 = 0.3;
pub const DENSITY: f64 = 7800.0;
pub const LENGTH: f64 = 1.0;

/// √(E/ρ) and √(G/ρ); with the torsion constant I_y + I_z the second is the speed of torsional waves.
pub fn speeds() -> [f64; 2] {
    [(YOUNG / DENSITY).sqrt(), (YOUNG / (2.0 * (1.0 + POISSON)) / DENSITY).sqrt()]
}

/// The wide side along e_y, the high one along e_z.
pub fn stocky_section() -> Section {
    rectangle(0.1, 0.2, None)
}

/// A straight steel rod named `rod`, with joints, asked for modes.
pub fn straight(section: Section, elements: usize, degree: usize, joints: Vec<Joint>, count: usize) -> Scene {
    Scene {
        rod: vec![Rod::new("rod", line(LENGTH), section, Some(steel()), elements, degree)],
        joint: joints,
        modes: Some(Modes { count }),
        ..Scene::default()
    }
}

/// Both ends on spherical joints.
pub fn pinned() -> Vec<Joint> {
    ["rod@0", "rod@1"].map(|end| joint(JointKind::Spherical, "ground", end, None)).to_vec()
}

/// Bending, by Huang's determinants and transfer matrices.
pub const FILE: &str = "continuous/straight_rod_frequencies.csv";

/// The four lowest of the `slender` or `stocky` rod, as `cantilever`, `free` or `pinned`, that bend it about `e_y`,
/// `e_z` or `any` axis.
pub fn bending(
    checks: &mut Checks,
    rod: &str,
    support: &str,
    axis: &str,
) -> Result<[f64; 4], Box<dyn Error>> {
    let table = checks.reference(FILE)?;
    let rows = table.select(&[("rod", rod), ("support", support), ("axis", axis)])?;
    let omegas: Vec<f64> = rows.iter().map(|row| row.number("omega")).collect::<Result<_, _>>()?;
    Ok(omegas.try_into().map_err(|_| "not four modes")?)
}

const ELEMENTS: usize = 6;
const DEGREE: usize = 8;

/// Half of what rounding leaves of ω², ε ω_max², with the highest frequency of the mesh, about c p² n/L; and the mesh's own error.
///
/// Galerkin's eigenvalues of degree p are off by (kh)^{2p} [p!/(2p)!]², relative; kh ≤ 2.7 here.
fn bound(frequency: f64) -> f64 {
    let highest = speeds()[0] * (DEGREE * DEGREE * ELEMENTS) as f64 / LENGTH;
    1e-10 + 0.5 * f64::EPSILON * (highest / frequency).powi(2)
}

const BOUND: &str = "(kh)^16 (8!/16!)² < 1e-10 of the mesh, and half of ε (c p² n/L)²/ω² of rounding in ω²";
const ZERO: &str = "a rigid motion has no stiffness: 1e-12 of the first elastic ω² is rounding";

/// Checks that the frequencies are `zeros` zeros and then exactly these.
fn compare(
    checks: &mut Checks,
    what: &str,
    scene: &Scene,
    placement: &Placement,
    zeros: usize,
    expected: &[f64],
) -> Outcome {
    let mut scene = placement.apply(scene);
    scene.modes = Some(Modes { count: zeros + expected.len() });
    let found = frequencies(&scene)?;
    let what = format!("{what}, {}", placement.name);
    for (k, &omega) in found.iter().take(zeros).enumerate() {
        checks.below(
            Kind::ClosedForm,
            format!("{what}, rigid motion {}", k + 1),
            omega.abs() / expected[0],
            1e-6,
            ZERO,
        );
    }
    for (k, &omega) in expected.iter().enumerate() {
        let measured = found.get(zeros + k).copied().unwrap_or(f64::NAN);
        checks.relative(
            Kind::ClosedForm,
            format!("{what}, ω{}", k + 1),
            (measured, omega),
            bound(omega),
            BOUND,
        );
    }
    Ok(())
}

fn twice(values: &[f64]) -> Vec<f64> {
    values.iter().flat_map(|&omega| [omega, omega]).collect()
}

/// The lowest `count` of several families.
pub fn lowest(families: &[&[f64]], count: usize) -> Vec<f64> {
    let mut all: Vec<f64> = families.iter().flat_map(|family| family.iter().copied()).collect();
    all.sort_by(f64::total_cmp);
    all.truncate(count);
    all
}

fn slender(checks: &mut Checks) -> Outcome {
    let scene = |joints| straight(circle(0.01), ELEMENTS, DEGREE, joints, 1);
    let clamped = twice(&bending(checks, "slender", "cantilever", "any")?);
    let free = twice(&bending(checks, "slender", "free", "any")?);
    let both = twice(&bending(checks, "slender", "pinned", "any")?);
    for placement in placements(LENGTH) {
        let cantilever = scene(vec![clamp("rod@0")]);
        compare(checks, "slender cantilever", &cantilever, &placement, 0, &clamped)?;
        compare(checks, "slender, free", &scene(Vec::new()), &placement, 6, &free)?;
        compare(checks, "slender, pinned", &scene(pinned()), &placement, 1, &both)?;
    }
    Ok(())
}

fn stocky(checks: &mut Checks) -> Outcome {
    let [axial, torsional] = speeds();
    let odd = |speed: f64| [1.0, 3.0, 5.0].map(|n| n * FRAC_PI_2 * speed / LENGTH);
    let whole = |speed: f64| [1.0, 2.0, 3.0].map(|n| n * PI * speed / LENGTH);
    let scene = |joints| straight(stocky_section(), ELEMENTS, DEGREE, joints, 1);
    let mut tables = Vec::new();
    for support in ["cantilever", "free", "pinned"] {
        let planes = [bending(checks, "stocky", support, "e_y")?, bending(checks, "stocky", support, "e_z")?];
        tables.push(planes);
    }
    let [clamped, free, both] = [&tables[0], &tables[1], &tables[2]];
    for placement in placements(LENGTH) {
        let families: [&[f64]; 4] = [&clamped[0], &clamped[1], &odd(axial), &odd(torsional)];
        let cantilever = scene(vec![clamp("rod@0")]);
        compare(checks, "stocky cantilever", &cantilever, &placement, 0, &lowest(&families, 10))?;
        let families: [&[f64]; 4] = [&free[0], &free[1], &whole(axial), &whole(torsional)];
        compare(checks, "stocky, free", &scene(Vec::new()), &placement, 6, &lowest(&families, 10))?;
        // Spherical joints hold both ends along the axis and let them turn about it.
        let families: [&[f64]; 4] = [&both[0], &both[1], &whole(axial), &whole(torsional)];
        compare(checks, "stocky, pinned", &scene(pinned()), &placement, 1, &lowest(&families, 10))?;
    }
    Ok(())
}

/// Revolute joints about e_y at both ends: pinned in one plane, clamped in the other, no rigid motion.
fn hinged(checks: &mut Checks) -> Outcome {
    let hinges =
        ["rod@0", "rod@1"].map(|end| joint(JointKind::Revolute, "ground", end, Some([0.0, 1.0, 0.0])));
    let about = [bending(checks, "stocky", "pinned", "e_y")?, bending(checks, "stocky", "pinned", "e_z")?];
    for placement in placements(LENGTH) {
        let scene = straight(stocky_section(), ELEMENTS, DEGREE, hinges.to_vec(), 12);
        let found = frequencies(&placement.apply(&scene))?;
        // A clamped rod has, by Timoshenko's equations, the nonzero frequencies of none of the others about e_z.
        let [axial, torsional] = speeds();
        let fixed = [axial, torsional].map(|speed| PI * speed / LENGTH);
        for omega in about[0].into_iter().take(3).chain(fixed) {
            let nearest =
                found.iter().copied().min_by(|a, b| (a - omega).abs().total_cmp(&(b - omega).abs()));
            checks.relative(
                Kind::ClosedForm,
                format!("hinged, the one nearest to {omega:.3}, {}", placement.name),
                (nearest.unwrap_or(f64::NAN), omega),
                bound(omega),
                BOUND,
            );
        }
        let lowest = found.first().copied().unwrap_or(f64::NAN);
        checks.above(
            Kind::ClosedForm,
            format!("hinged, the lowest over that of the pinned rod about e_z, {}", placement.name),
            lowest / about[1][0],
            1.0,
            "hinges about e_y clamp the rod about e_z: stiffer than pinned, and nothing is free",
        );
    }
    Ok(())
}

/// ω = ω_EB (1 − ½ (nπ r/L)² (1 + E/G) + …), r² = I/A: the limit, its order and its coefficient.
fn euler_bernoulli(checks: &mut Checks) -> Outcome {
    let diameters = [0.04, 0.02, 0.01];
    for n in [1, 2] {
        let mut errors = Vec::new();
        for diameter in diameters {
            let found = frequencies(&straight(circle(diameter), ELEMENTS, DEGREE, pinned(), 5))?;
            let radius = diameter / 4.0;
            let wave = f64::from(n) * PI / LENGTH;
            let limit = wave * wave * speeds()[0] * radius;
            let both = 2 * n as usize - 1;
            errors.push(1.0 - found[both] / limit);
            let slenderness = (wave * radius).powi(2);
            let first = 0.5 * slenderness * (1.0 + 2.0 * (1.0 + POISSON));
            checks.absolute(
                Kind::ClosedForm,
                format!("1 − ω/ω_EB, n = {n}, diameter {diameter}"),
                (1.0 - found[both] / limit, first),
                10.0 * slenderness.powi(2),
                "the next term is (nπ r/L)⁴ times products of 1 and E/G = 2.6, less than ten together",
            );
        }
        checks.order(
            format!("1 − ω/ω_EB over the diameter, n = {n}"),
            &[1, 2, 4],
            &errors,
            (2.0, 0.01),
            "the next term is four orders of the slenderness, 2e-3 at most of the first, apart",
        );
    }
    Ok(())
}

fn count(checks: &mut Checks) -> Outcome {
    const EXACT: &str = "a whole number";
    let solution = vibrate(&straight(stocky_section(), 1, 1, vec![clamp("rod@0")], 20))?;
    checks.absolute(
        Kind::ClosedForm,
        "modes of one clamped linear element",
        (solution.modes.len() as f64, 6.0),
        0.0,
        EXACT,
    );
    let told = solution.warnings.iter().any(|warning| warning.contains("only 6 modes"));
    checks.above(Kind::Invariant, "that there are no more is said", f64::from(u8::from(told)), 1.0, EXACT);
    let solution = vibrate(&straight(stocky_section(), 2, 2, Vec::new(), 30))?;
    checks.absolute(
        Kind::ClosedForm,
        "modes of two free quadratic elements",
        (solution.modes.len() as f64, 30.0),
        0.0,
        EXACT,
    );
    checks.absolute(
        Kind::Invariant,
        "warnings where there are as many as asked for",
        (solution.warnings.len() as f64, 0.0),
        0.0,
        EXACT,
    );
    let falls =
        solution.modes.windows(2).filter(|pair| pair[1].angular_frequency < pair[0].angular_frequency);
    checks.absolute(Kind::Invariant, "frequencies out of order", (falls.count() as f64, 0.0), 0.0, EXACT);
    Ok(())
}
