//! Which settings a study tries.

use crate::scene::{Analysis, Increments, InterpolationKind, Rod, Scene, Study, Tolerance};
use crate::study::mesh::{fitting_elements, proportional_elements};
use crate::study::settings::{Settings, time_step};

/// Degrees tried beside the scene's own in statics.
const DEGREES: [usize; 5] = [1, 2, 3, 4, 6];
/// The degree tried beside the scene's own in dynamics, where every mesh is tried with every step; the second where
/// the first is the scene's own.
const DEGREE_IN_TIME: [usize; 2] = [4, 2];
/// Meshes of every degree: their nodes as parts of the scene's own.
const NODES: [[usize; 2]; 4] = [[1, 4], [1, 2], [1, 1], [2, 1]];
/// The same in dynamics.
const NODES_IN_TIME: [[usize; 2]; 3] = [[1, 2], [1, 1], [2, 1]];
/// Numbers of equal load increments, in milestones of the path.
const INCREMENTS: [usize; 3] = [1, 5, 20];
/// Time steps as parts of the scene's own.
const STEPS: [f64; 4] = [2.0, 1.0, 0.5, 0.25];
/// The same where there is nothing but bodies.
const STEPS_OF_BODIES: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
/// The time step beside the accuracy of a scene without a constant one, as a part of the end time.
pub(super) const STEP: f64 = 1.0 / 400.0;

/// The settings to try, without repetitions, before time steps are fitted to the milestones: every combination of
/// what `[study]` lists, or a selection about the scene's own settings.
pub(super) fn ladder(scene: &Scene, admissible: &[usize], equal_increments: usize) -> Vec<Settings> {
    let study = scene.study.clone().unwrap_or_default();
    let lists = Study { accuracies: None, ..study.clone() };
    let all = match scene.analysis() {
        _ if lists != Study::default() => product(scene, admissible, &study),
        Some(Analysis::Dynamics(options)) => {
            let itself = time_step(options).is_none().then(Settings::default);
            let own = time_step(options).unwrap_or(STEP * options.end_time);
            itself.into_iter().chain(in_time(scene, admissible, own)).collect()
        }
        _ => on_path(scene, admissible, equal_increments),
    };
    let mut distinct: Vec<Settings> = Vec::with_capacity(all.len());
    for settings in all {
        if !distinct.contains(&settings) {
            distinct.push(settings);
        }
    }
    distinct
}

/// The entries of a list, or once nothing.
fn choices<T: Copy>(list: &Option<Vec<T>>) -> Vec<Option<T>> {
    list.as_ref().map_or_else(|| vec![None], |list| list.iter().copied().map(Some).collect())
}

/// Every combination; SE(3) with degree 1 only.
fn product(scene: &Scene, admissible: &[usize], study: &Study) -> Vec<Settings> {
    let mut all = Vec::new();
    for interpolation in choices(&study.interpolation) {
        let degrees = match interpolation {
            Some(InterpolationKind::Se3) => vec![Some(1)],
            _ => choices(&study.degree),
        };
        for degree in degrees {
            for total in choices(&study.elements) {
                let elements = total.map(|total| proportional_elements(scene, admissible, total));
                let mesh = Settings { degree, elements, interpolation, ..Settings::default() };
                all.extend(of_solver(scene, study, &mesh));
            }
        }
    }
    all
}

/// The combinations of what is no matter of the mesh; a constant step is named, to be fitted to the milestones.
fn of_solver(scene: &Scene, study: &Study, mesh: &Settings) -> Vec<Settings> {
    let own = scene.dynamics.as_ref().and_then(time_step);
    let mut all = Vec::new();
    for increments in choices(&study.increments) {
        for time_step in choices(&study.time_step) {
            for tolerance in choices(&study.tolerance) {
                let time_step = time_step.or(own);
                all.push(Settings { increments, time_step, tolerance, ..mesh.clone() });
            }
        }
    }
    all
}

/// In statics: the scene itself; degrees and meshes under automatic increments; then its own mesh under equal ones.
fn on_path(scene: &Scene, admissible: &[usize], equal_increments: usize) -> Vec<Settings> {
    let mut all = vec![Settings::default()];
    let solver = Settings {
        increments: Some(Increments::Automatic),
        tolerance: Some(Tolerance::Relative),
        ..Settings::default()
    };
    if scene.statics.is_none() {
        return all;
    }
    let mut degrees = DEGREES.to_vec();
    if let Some((_, own)) = own_kind(scene)
        && !degrees.contains(&own)
    {
        degrees.push(own);
        degrees.sort_unstable();
    }
    let mut kinds: Vec<_> = degrees.into_iter().map(|degree| (InterpolationKind::R12, degree)).collect();
    kinds.push((InterpolationKind::Se3, 1));
    all.extend(meshes(scene, admissible, &kinds, &NODES, &solver));
    let equal = INCREMENTS.map(|count| Increments::Equal(count * equal_increments));
    all.extend(equal.map(|increments| Settings { increments: Some(increments), ..Settings::default() }));
    all
}

/// In dynamics: every mesh with every step, the scene's own among them.
fn in_time(scene: &Scene, admissible: &[usize], own: f64) -> Vec<Settings> {
    let solver = Settings::default();
    let (meshes, steps) = match own_kind(scene) {
        None => (vec![solver], &STEPS_OF_BODIES[..]),
        Some(kind) => {
            let other = DEGREE_IN_TIME.into_iter().map(|degree| (InterpolationKind::R12, degree));
            let other = other.filter(|other| *other != kind).take(1);
            let kinds: Vec<_> = std::iter::once(kind).chain(other).collect();
            (meshes(scene, admissible, &kinds, &NODES_IN_TIME, &solver), &STEPS[..])
        }
    };
    let end = scene.dynamics.as_ref().map_or(f64::INFINITY, |options| options.end_time);
    let steps: Vec<f64> = steps.iter().map(|part| part * own).filter(|step| *step <= end).collect();
    let with = |mesh: &Settings| {
        let mesh = mesh.clone();
        steps.iter().map(move |step| Settings { time_step: Some(*step), ..mesh.clone() }).collect::<Vec<_>>()
    };
    meshes.iter().flat_map(with).collect()
}

/// Interpolation and degree of the scene; where rods differ R12 and the largest. Nothing without rods.
fn own_kind(scene: &Scene) -> Option<(InterpolationKind, usize)> {
    let degree = scene.rod.iter().map(|rod| rod.degree).max()?;
    Some((common(scene, |rod| rod.interpolation).unwrap_or_default(), degree))
}

/// Interpolations and degrees, each on meshes with so many times the nodes of the scene.
fn meshes(
    scene: &Scene,
    admissible: &[usize],
    kinds: &[(InterpolationKind, usize)],
    nodes: &[[usize; 2]],
    solver: &Settings,
) -> Vec<Settings> {
    let intervals = scene.rod.iter().map(|rod| rod.elements.saturating_mul(rod.degree));
    let Some(own) = intervals.reduce(usize::saturating_add) else { return Vec::new() };
    let mut all = Vec::new();
    for &(interpolation, degree) in kinds {
        for &[numerator, denominator] in nodes {
            let total = own.saturating_mul(numerator).div_ceil(denominator * degree);
            let elements = Some(fitting_elements(scene, admissible, total));
            let (degree, interpolation) = (Some(degree), Some(interpolation));
            all.push(Settings { degree, interpolation, elements, ..solver.clone() });
        }
    }
    all
}

/// What all rods have in common.
pub(super) fn common<T: PartialEq>(scene: &Scene, of: impl Fn(&Rod) -> T) -> Option<T> {
    let first = of(scene.rod.first()?);
    scene.rod.iter().all(|rod| of(rod) == first).then_some(first)
}
