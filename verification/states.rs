//! States of one element with nothing special about them: no symmetry, large rotations and stretches, quaternions
//! of any norm.

use cosserat::interpolation::{Increment, Pose};
use cosserat::lagrange::element_nodes;
use cosserat::rotation::{quaternion_exp, quaternion_product, rotation_matrix};
use cosserat::scene::NodeSpacing;
use nalgebra::{Vector3, Vector4};
use num_dual::Dual64;

use crate::formulas::{Frame, lift, quaternion_rate, rotation};

/// A linear congruential generator (Knuth's MMIX constants): the same numbers on every machine.
pub struct Generator(u64);

impl Generator {
    pub fn new(seed: u64) -> Self {
        let mut generator = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        generator.number();
        generator
    }

    /// Evenly distributed in [−1, 1).
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.number(), self.number(), self.number())
    }

    /// A direction.
    pub fn axis(&mut self) -> Vector3<f64> {
        loop {
            let v = self.vector();
            if (0.1..1.0).contains(&v.norm()) {
                return v.normalize();
            }
        }
    }

    pub fn increment(&mut self) -> Increment {
        Increment { translation: self.vector(), rotation: self.vector() }
    }
}

/// The nodes of one element.
#[derive(Clone, Debug)]
pub struct ElementState<const N: usize> {
    pub positions: [Vector3<f64>; N],
    /// Of norms between 0.3 and 3.
    pub quaternions: [Vector4<f64>; N],
}

impl<const N: usize> ElementState<N> {
    /// The last node is turned against the first by about `angle` (exactly, if there are two), its length is
    /// about 1.3, bent and sheared.
    pub fn new(places: &[f64; N], angle: f64, seed: u64) -> Self {
        let mut random = Generator::new(seed);
        let first = quaternion_exp(&(2.0 * random.axis()));
        let (axis, corner) = (random.axis(), random.vector());
        let direction = random.axis();
        let quaternions = std::array::from_fn(|i| {
            let x = places[i];
            // Nothing at the ends.
            let wobble = 0.4 * angle * x * (1.0 - x) * random.vector();
            let turn = quaternion_product(&quaternion_exp(&(axis * angle * x)), &quaternion_exp(&wobble));
            quaternion_product(&first, &turn) * 10f64.powf(0.5 * random.number())
        });
        let positions = std::array::from_fn(|i| {
            let x = places[i];
            corner + direction * (1.3 * x) + 0.5 * x * (1.0 - x) * random.vector()
        });
        Self { positions, quaternions }
    }

    /// As the library takes them.
    pub fn poses(&self) -> [Pose; N] {
        std::array::from_fn(|i| Pose {
            position: self.positions[i],
            rotation: rotation_matrix(&self.quaternions[i]),
        })
    }

    /// q + ε δq with the kinematic relation (10), δP = Q(P) δφ.
    pub fn moved(&self, increments: &[Increment; N]) -> Vec<Frame<Dual64>> {
        let dual = |value: f64, rate: f64| Dual64::new(value, rate);
        (0..N)
            .map(|i| {
                let p = self.quaternions[i].map(Dual64::from_re);
                let rate = quaternion_rate(&p, &lift(&increments[i].rotation)).map(|x| x.re);
                Frame {
                    position: self.positions[i].zip_map(&increments[i].translation, dual),
                    rotation: rotation(&self.quaternions[i].zip_map(&rate, dual)),
                }
            })
            .collect()
    }
}

/// Component k of (δr, δφ) at node j.
pub fn unit_increment<const N: usize>(j: usize, k: usize) -> [Increment; N] {
    let mut increments = [Increment::default(); N];
    if k < 3 {
        increments[j].translation[k] = 1.0;
    } else {
        increments[j].rotation[k - 3] = 1.0;
    }
    increments
}

/// Node places of an element.
pub fn places<const N: usize>(spacing: NodeSpacing) -> [f64; N] {
    element_nodes(N - 1, spacing).try_into().unwrap_or_else(|_| unreachable!("N places"))
}

/// Relative angles: three that are small, the switches of the series at 1 and 2 from both sides, and large ones.
pub const ANGLES: [f64; 9] = [1e-12, 1e-8, 1e-4, 0.3, 1.0 - 1e-9, 1.0 + 1e-9, 2.0 - 1e-9, 2.0 + 1e-9, 3.0];

/// The largest error of many, relative to the largest exact entry of each; NaN stays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst(pub f64);

impl Worst {
    /// Compares a list with the exact one.
    pub fn compare(&mut self, measured: impl IntoIterator<Item = f64>, exact: impl IntoIterator<Item = f64>) {
        let exact: Vec<f64> = exact.into_iter().collect();
        let scale = exact.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        self.compare_against(measured, exact, scale);
    }

    /// The same against a given scale.
    pub fn compare_against(
        &mut self,
        measured: impl IntoIterator<Item = f64>,
        exact: impl IntoIterator<Item = f64>,
        scale: f64,
    ) {
        let (measured, exact): (Vec<f64>, Vec<f64>) =
            (measured.into_iter().collect(), exact.into_iter().collect());
        if measured.len() != exact.len() {
            self.0 = f64::NAN;
        }
        for (a, b) in measured.iter().zip(&exact) {
            let error = (a - b).abs() / scale;
            self.0 = if self.0.is_nan() || error <= self.0 { self.0 } else { error };
        }
    }
}
