//! Point loads with levers in both bases, and their tangents.

use cosserat::load::{Course, PointLoad};
use cosserat::scene::Basis;
use nalgebra::Vector3;
use num_dual::Dual64;

use crate::case::{Case, Checks, Kind, Outcome};
use crate::formulas::{Frame, lift};
use crate::states::{ElementState, Generator, Worst, unit_increment};

/// The cases of this file.
pub fn all() -> Vec<Case> {
    vec![Case::new(
        "derivatives::point_load",
        "virtual work of a force at a lever, and of a moment, in both bases",
        point_load,
    )]
}

/// (force inertial, moment body) from virtual work: F·δ(r + A s) = F·δr + (s × Aᵀ F)·δφ.
fn exact_rows(load: &PointLoad, factor: f64, node: &Frame<Dual64>) -> [Dual64; 6] {
    let (a, value) = (node.rotation, lift(&(load.value * factor)));
    let (inertial, body) = match load.basis {
        Basis::Inertial => (value, a.transpose() * value),
        Basis::Body => (a * value, value),
    };
    let (f, m) = if load.is_moment {
        (Vector3::zeros(), body)
    } else {
        // (A s) × F in the inertial basis, then turned back.
        (inertial, a.transpose() * (a * lift(&load.lever)).cross(&inertial))
    };
    [f.x, f.y, f.z, m.x, m.y, m.z]
}

fn point_load(checks: &mut Checks) -> Outcome {
    let mut random = Generator::new(90);
    for is_moment in [false, true] {
        for basis in [Basis::Inertial, Basis::Body] {
            let [mut rows, mut tangent] = [Worst::default(); 2];
            for seed in 0..20 {
                let load = PointLoad {
                    node: 0,
                    is_moment,
                    value: random.vector(),
                    basis,
                    lever: if is_moment { Vector3::zeros() } else { random.vector() },
                    course: Course::Ramp,
                };
                let factor = 1.0 + 0.5 * random.number();
                let state = ElementState::<2>::new(&[0.0, 1.0], 2.0, seed);
                let pose = state.poses()[0];
                let exact = |k: usize| exact_rows(&load, factor, &state.moved(&unit_increment::<2>(0, k))[0]);
                let (force, moment) = load.rows(&pose, factor);
                let ours: [f64; 6] = std::array::from_fn(|k| if k < 3 { force[k] } else { moment[k - 3] });
                rows.compare(ours, exact(0).map(|x| x.re));
                let k = load.tangent(&pose, factor);
                let reference: Vec<f64> = (0..6).flat_map(|k| exact(k).map(|x| -x.eps)).collect();
                tangent.compare_against(k.iter().copied(), reference, load.value.norm());
            }
            let name = format!("{} in the {basis:?} basis", if is_moment { "moment" } else { "force" });
            let reason = "50 ε: two products with entries of size one";
            checks.below(Kind::Invariant, format!("rows, {name}"), rows.0, 1e-14, reason);
            checks.below(Kind::Invariant, format!("tangent, {name}"), tangent.0, 1e-14, reason);
        }
    }
    Ok(())
}
