//! The kernels of four elements side by side, asked for one: it stands in the third lane, between others.

use cosserat::element::{
    self, ElementForce, ElementTangent, ReferencePoint, Stiffness, Stress, TangentScratch,
    set_tangent_of_lane, tangent_of_lane, zero_tangents,
};
use cosserat::inertia::{ElementMass, Velocity, inertia_tangents};
use cosserat::interpolation::{HalfTurn, HalfTurnIn, Increment, Increments, Interpolation, Nodes, Pose};
use cosserat::lagrange::Basis;
use cosserat::lanes::{LANES, Processor};
use cosserat::section::SectionInertia;

/// Where the element stands.
pub const LANE: usize = 2;

/// The neighbours are undeformed elements of the same poses but for the first node, which all share.
fn neighbours<const N: usize>(poses: &[Pose; N]) -> [Pose; N] {
    std::array::from_fn(|i| Pose {
        rotation: poses[0].rotation,
        position: poses[0].position + poses[0].rotation * nalgebra::Vector3::new(i as f64, 0.0, 0.0),
    })
}

fn side_by_side<'a, T>(own: &'a T, other: &'a T) -> [&'a T; LANES] {
    std::array::from_fn(|lane| if lane == LANE { own } else { other })
}

fn half_turn(HalfTurnIn(lane): HalfTurnIn) -> HalfTurn {
    assert_eq!(lane, LANE);
    HalfTurn
}

/// Those of the element, then others.
fn with_others<T: Copy>(own: &[T], others: T) -> (Vec<T>, [usize; LANES]) {
    let all = own.iter().copied().chain(own.iter().map(|_| others)).collect();
    (all, std::array::from_fn(|lane| if lane == LANE { 0 } else { own.len() }))
}

fn straight() -> ReferencePoint {
    ReferencePoint { jacobian: 1.0, gamma: [1.0, 0.0, 0.0].into(), kappa: [0.0; 3].into() }
}

/// Adds the forces to `result`, as it was when there was one lane.
pub fn internal_force<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    poses: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    stresses: &mut [Stress],
    result: &mut ElementForce<N>,
) -> Result<(), HalfTurn> {
    let others = neighbours(poses);
    let (reference, starts) = with_others(reference, straight());
    let (mut all, _) = with_others(stresses, Stress::default());
    let nodes = Nodes::new(side_by_side(poses, &others));
    *result =
        element::internal_force::<N, I>(processor, &nodes, rule, (&reference, &starts), stiffness, &mut all)
            .map_err(half_turn)?
            .of_lane(LANE);
    let own = all[..stresses.len()].to_vec();
    stresses.copy_from_slice(&own);
    Ok(())
}

pub fn internal_tangent<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    poses: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    stresses: &[Stress],
    tangent: &mut ElementTangent<N>,
) -> Result<(), HalfTurn> {
    let others = neighbours(poses);
    let (reference, starts) = with_others(reference, straight());
    let (stresses, _) = with_others(stresses, Stress::default());
    let mut tangents = zero_tangents::<N>();
    let (nodes, mut scratch) = (Nodes::new(side_by_side(poses, &others)), TangentScratch::default());
    let points = (&reference[..], &starts);
    element::internal_tangent::<N, I>(
        processor,
        &nodes,
        rule,
        points,
        stiffness,
        &stresses,
        &mut scratch,
        &mut tangents,
    )
    .map_err(half_turn)?;
    *tangent = tangent_of_lane(&tangents, LANE);
    Ok(())
}

#[allow(clippy::too_many_arguments)]
pub fn advance_stress<const N: usize, I: Interpolation<N>>(
    processor: impl Processor,
    poses: &[Pose; N],
    rule: &[Basis<N>],
    reference: &[ReferencePoint],
    stiffness: &Stiffness,
    increments: &[Increment; N],
    constitutive: &[Stress],
    stresses: &mut [Stress],
) -> Result<(), HalfTurn> {
    let others = neighbours(poses);
    let (reference, starts) = with_others(reference, straight());
    let (constitutive, _) = with_others(constitutive, Stress::default());
    let (mut all, _) = with_others(stresses, Stress::default());
    element::advance_stress::<N, I>(
        processor,
        &Nodes::new(side_by_side(poses, &others)),
        rule,
        (&reference, &starts),
        stiffness,
        &Increments::new(side_by_side(increments, &[Increment::default(); N])),
        &constitutive,
        &mut all,
    )
    .map_err(half_turn)?;
    stresses.copy_from_slice(&all[..stresses.len()]);
    Ok(())
}

#[allow(clippy::too_many_arguments)]
pub fn inertia_tangent<const N: usize>(
    processor: impl Processor,
    rule: &[Basis<N>],
    jacobians: &[f64],
    coefficients: &[[f64; N]; N],
    section: &SectionInertia,
    velocities: &[Velocity; N],
    b: f64,
    tangent: &mut ElementTangent<N>,
) {
    let (own, ones) = (ElementMass { jacobians, coefficients }, vec![1.0; jacobians.len()]);
    let other = ElementMass { jacobians: &ones, coefficients: &[[1.0; N]; N] };
    let mut tangents = zero_tangents::<N>();
    set_tangent_of_lane(&mut tangents, LANE, tangent);
    inertia_tangents::<N>(
        processor,
        rule,
        &std::array::from_fn(|lane| if lane == LANE { own } else { other }),
        section,
        side_by_side(velocities, &[Velocity::default(); N]),
        b,
        &mut tangents,
    );
    *tangent = tangent_of_lane(&tangents, LANE);
}
