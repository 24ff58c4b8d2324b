//! Rigid bodies and cross-sections: mass and inertia by quadrature over the volume, inertia forces as the rate of
//! momentum, the tangent of an implicit time step.

use std::f64::consts::TAU;

use cosserat::body::MassProperties;
use cosserat::inertia::Velocity;
use cosserat::quadrature::gauss_legendre;
use cosserat::scene::{Body, Material, Section, Shape};
use cosserat::section;
use nalgebra::{Matrix3, Vector3, Vector6};
use num_dual::Dual64;

use super::inertia::{STEPS, velocity};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{axial, lift, rotation, tilde, turned};
use crate::states::{Generator, Worst};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![
        Case::new(
            "derivatives::mass_properties",
            "∫ ρ (x·x 1 − x xᵀ) dV over bodies and cross-sections, by Gauss's rule",
            mass_properties,
        ),
        Case::new(
            "derivatives::rigid_body",
            "d/dt (m v), d/dt (A Θ ω), the energy of point masses; P₊ ∝ P* ∘ (1, b ω₊/2)",
            rigid_body,
        ),
    ]
}

/// (∫ dV, ∫ x·x 1 − x xᵀ dV) over the image of the unit cube under `map`, which gives a point and its volume element.
fn moments(map: impl Fn([f64; 3]) -> (Vector3<f64>, f64)) -> (f64, Matrix3<f64>) {
    // Exact to degree 31, where polynomials reach 5; cos² over a turn is off by 5e-20.
    let rule = gauss_legendre(16);
    let points = || rule.points.iter().copied().zip(rule.weights.iter().copied());
    let (mut volume, mut second) = (0.0, Matrix3::zeros());
    for (u, weight_u) in points() {
        for (v, weight_v) in points() {
            for (w, weight_w) in points() {
                let (x, element) = map([u, v, w]);
                let element = element * weight_u * weight_v * weight_w;
                volume += element;
                second += (Matrix3::identity() * x.dot(&x) - x * x.transpose()) * element;
            }
        }
    }
    (volume, second)
}

/// A point of a circle; `angle` in turns.
fn around(radius: f64, angle: f64) -> [f64; 2] {
    let (sine, cosine) = (TAU * angle).sin_cos();
    [radius * cosine, radius * sine]
}

fn mass_properties(checks: &mut Checks) -> Outcome {
    let reason = "200 ε: a sum of 4096 terms rounds by about √4096 ε = 64 ε of the sum of their sizes";
    let density = 7.85;
    let mut shapes = Vec::new();
    let (radius, height) = (0.7, 2.1);
    shapes.push((
        Shape::Cylinder { radius, height },
        moments(|[u, v, w]| {
            let [x, y] = around(radius * u, v);
            (Vector3::new(x, y, height * (w - 0.5)), radius * u * radius * TAU * height)
        }),
    ));
    let size = [0.3, 1.1, 1.9];
    shapes.push((
        Shape::Cuboid { size },
        moments(|point| {
            let at = |k: usize| size[k] * (point[k] - 0.5);
            (Vector3::new(at(0), at(1), at(2)), size[0] * size[1] * size[2])
        }),
    ));
    shapes.push((
        Shape::Sphere { radius },
        // By Archimedes' cylinder: even in the height and in the angle.
        moments(|[u, v, w]| {
            let (distance, cosine) = (radius * u, 2.0 * w - 1.0);
            let [x, y] = around(distance * (1.0 - cosine * cosine).sqrt(), v);
            (Vector3::new(x, y, distance * cosine), distance * distance * radius * 2.0 * TAU)
        }),
    ));
    for (shape, (volume, second)) in shapes {
        let body = body(Some(shape), Some(density), None, None);
        let ours = MassProperties::new(&body).ok_or("a shape with a density")?;
        let mut worst = Worst::default();
        worst.compare([ours.mass], [density * volume]);
        let inertia = Matrix3::from_diagonal(&ours.inertia);
        worst.compare(inertia.iter().copied(), (density * second).iter().copied());
        checks.below(Kind::ClosedForm, format!("mass and inertia, {shape:?}"), worst.0, 5e-14, reason);
    }
    let given = MassProperties::new(&body(None, None, Some(2.0), Some([3.0, 4.0, 5.0])));
    let as_given = MassProperties { mass: 2.0, inertia: Vector3::new(3.0, 4.0, 5.0) };
    verdict(checks, "mass and inertia as given", given == Some(as_given));
    let (shape, inertia) = (Some(Shape::Sphere { radius }), Some([1.0; 3]));
    let incomplete = [
        body(None, None, None, None),
        body(shape, None, None, None),
        body(None, None, Some(1.0), None),
        body(shape, None, Some(1.0), None),
        body(shape, Some(density), Some(1.0), inertia),
    ];
    let none = incomplete.iter().all(|body| MassProperties::new(body).is_none());
    verdict(checks, "exactly one of two descriptions", none);
    cross_sections(checks, density, reason)
}

fn body(shape: Option<Shape>, density: Option<f64>, mass: Option<f64>, inertia: Option<[f64; 3]>) -> Body {
    Body {
        name: "body".to_string(),
        shape,
        density,
        mass,
        inertia,
        position: [0.0; 3],
        orientation: [1.0, 0.0, 0.0, 0.0],
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    }
}

fn verdict(checks: &mut Checks, quantity: &str, holds: bool) {
    checks.absolute(Kind::ClosedForm, quantity, (f64::from(u8::from(holds)), 1.0), 0.0, "a verdict is exact");
}

/// A slice of unit length about its centre, its thickness left out: x = 0.
fn cross_sections(checks: &mut Checks, density: f64, reason: &'static str) -> Outcome {
    let (outer, inner) = (1.3, 0.4);
    let (width, height) = (0.5, 1.7);
    // A torsion constant is stiffness, not inertia.
    let torsion_constant = Some(0.123);
    let sections = [
        (
            Section::Circle {
                diameter: outer,
                inner_diameter: Some(inner),
                shear_factor: 0.8,
                torsion_constant,
            },
            moments(|[u, v, _]| {
                let radius = 0.5 * (inner + (outer - inner) * u);
                let [y, z] = around(radius, v);
                (Vector3::new(0.0, y, z), radius * 0.5 * (outer - inner) * TAU)
            }),
        ),
        (
            Section::Rectangle { width, height, shear_factor: 0.8, torsion_constant },
            moments(|[u, v, _]| (Vector3::new(0.0, width * (u - 0.5), height * (v - 0.5)), width * height)),
        ),
    ];
    let material = Material { density: Some(density), ..Material::default() };
    for (section, (area, second)) in sections {
        let ours = section::inertia(&section, Some(&material)).ok_or("a section with a density")?;
        let mut worst = Worst::default();
        worst.compare([ours.mass_per_length], [density * area]);
        let rotary = Matrix3::from_diagonal(&ours.rotary);
        worst.compare(rotary.iter().copied(), (density * second).iter().copied());
        checks.below(Kind::ClosedForm, format!("inertia of {section:?}"), worst.0, 5e-14, reason);
    }
    let custom = |mass_per_length, rotary_inertia| Section::Custom {
        axial: 1.0,
        shear_y: 1.0,
        shear_z: 1.0,
        torsion: 1.0,
        bending_y: 1.0,
        bending_z: 1.0,
        mass_per_length,
        rotary_inertia,
    };
    let ours = section::inertia(&custom(Some(2.0), Some([3.0, 4.0, 5.0])), None);
    let as_given = section::SectionInertia { mass_per_length: 2.0, rotary: Vector3::new(3.0, 4.0, 5.0) };
    verdict(checks, "inertia of a section as given", ours == Some(as_given));
    let incomplete = [custom(Some(2.0), None), custom(None, Some([3.0, 4.0, 5.0]))];
    verdict(
        checks,
        "no inertia from half of it",
        incomplete.iter().all(|section| section::inertia(section, Some(&material)).is_none()),
    );
    Ok(())
}

/// Eight equal masses at the corners of a box, as a rigid body: m and half the box's edges.
const MASS: f64 = 1.9;
const CORNER: Vector3<f64> = Vector3::new(0.5, 0.9, 1.3);

fn eight_masses() -> MassProperties {
    let squares = CORNER.component_mul(&CORNER);
    let sums = Vector3::new(squares.y + squares.z, squares.z + squares.x, squares.x + squares.y);
    MassProperties { mass: MASS, inertia: MASS * sums }
}

/// Every corner with its velocity v + A (ω × x).
fn corner_velocities(a: &Matrix3<f64>, u: &Velocity) -> impl Iterator<Item = Vector3<f64>> {
    let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    (0..8).map(move |k| {
        let corner = CORNER.component_mul(&Vector3::new(sign(k & 1), sign(k & 2), sign(k & 4)));
        u.translation + a * u.rotation.cross(&corner)
    })
}

fn rigid_body(checks: &mut Checks) -> Outcome {
    let body = eight_masses();
    let [mut forces, mut energy, mut tangent] = [Worst::default(); 3];
    for (seed, b) in (260..).zip(STEPS).chain((270..).zip(STEPS)) {
        let mut random = Generator::new(seed);
        let quaternion = 3.0 * random.axis().insert_row(0, random.number());
        let a = rotation(&quaternion);
        let (u, rate) = (velocity(&mut random), velocity(&mut random));

        // d/dt of A Θ ω with Ȧ by eq. (10), turned back.
        let omega = u.rotation.zip_map(&rate.rotation, Dual64::new);
        let moving = turned(&quaternion.map(Dual64::from_re), &u.rotation.map(|x| Dual64::new(0.0, x)));
        let momentum = rotation(&moving) * omega.component_mul(&lift(&body.inertia));
        let moment = a.tr_mul(&momentum.map(|x| x.eps));
        let (force, ours) = body.inertia_force(&u, &rate);
        forces.compare(force.iter().copied(), rate.translation.iter().map(|x| -MASS * x));
        forces.compare(ours.iter().copied(), moment.iter().map(|x| -x));
        let sum: f64 = corner_velocities(&a, &u).map(|v| MASS / 16.0 * v.dot(&v)).sum();
        energy.compare([body.kinetic_energy(&u)], [sum]);
        compare_step(&mut tangent, &body, &quaternion, (&u, &rate), b);
    }
    let reason = "200 ε: dozens of operations with numbers of one size";
    for (quantity, worst) in
        [("(−m v̇, −Θ ω̇ − ω × Θω)", forces), ("½ (m v·v + ω·Θω)", energy), ("(M + b D) diag(1, Y⁻¹)", tangent)]
    {
        checks.below(Kind::Invariant, quantity, worst.0, 5e-14, reason);
    }
    Ok(())
}

/// ∂f/∂u̇₊ through a step that turns by about one, against the tangent times (δr, δφ)/b².
fn compare_step(
    worst: &mut Worst,
    body: &MassProperties,
    start: &nalgebra::Vector4<f64>,
    (u, rate): (&Velocity, &Velocity),
    b: f64,
) {
    let now = Velocity {
        translation: u.translation + b * rate.translation,
        rotation: (u.rotation + rate.rotation) / b,
    };
    let ours = body.inertia_tangent(&now, b);
    let inertia = Matrix3::from_diagonal(&lift::<Dual64>(&body.inertia));
    let mut columns: [(Vec<f64>, Vec<f64>); 2] = Default::default();
    for k in 0..6 {
        let unit = |first: usize| Vector3::from_fn(|i, _| f64::from(u8::from(first + i == k)));
        // δu₊ = b δu̇₊, δr = b δv₊.
        let spin = (rate.rotation / (b * b)).zip_map(&unit(3), Dual64::new);
        let omega = now.rotation.zip_map(&(unit(3) * b), Dual64::new);
        let a = rotation(&turned(&start.map(Dual64::from_re), &(omega * Dual64::from_re(b))));
        let turn = axial(&(a.map(|x| Dual64::from_re(x.re)).transpose() * a)).map(|x| x.eps);
        let moment = inertia * spin + tilde(&omega) * inertia * omega;
        let change = Vector6::from_iterator((unit(0) * (b * b)).iter().chain(&turn).copied()) / (b * b);
        let (measured, reference) = &mut columns[k / 3];
        measured.extend((ours * change).iter());
        reference.extend((unit(0) * body.mass).iter());
        reference.extend(moment.iter().map(|x| x.eps));
    }
    for (measured, reference) in columns {
        worst.compare(measured, reference);
    }
}
