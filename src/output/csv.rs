//! `probes.csv` and `reactions.csv`: one row for the start and every accepted increment.

use std::path::Path;

use crate::error::Error;
use crate::scene::Scene;
use crate::solution::Solution;

/// Poses of the probes, and Euler angles where a probe asks for them.
pub(super) fn probes(dir: &Path, scene: &Scene, solution: &Solution) -> Result<(), Error> {
    let mut header = vec!["load_factor".to_owned()];
    for probe in &scene.probe {
        header.extend(columns(&probe.name, &["x", "y", "z", "qw", "qx", "qy", "qz"]));
        if probe.angles.is_some() {
            header.extend(columns(&probe.name, &["alpha", "beta", "gamma"]));
        }
    }
    let rows = solution.rows.iter().map(|row| {
        let mut numbers = vec![row.parameter];
        for pose in &row.probes {
            numbers.extend(pose.position);
            numbers.extend(pose.quaternion);
            numbers.extend(pose.angles.iter().flatten());
        }
        numbers
    });
    table(dir, "probes.csv", &header, rows)
}

/// Forces and moments of the joints on the second of their pair.
pub(super) fn reactions(dir: &Path, scene: &Scene, solution: &Solution) -> Result<(), Error> {
    let mut header = vec!["load_factor".to_owned()];
    for index in 0..scene.joint.len() {
        let name = scene.joint_name(index);
        header.extend(columns(&name, &["fx", "fy", "fz", "mx", "my", "mz"]));
    }
    let rows = solution.rows.iter().map(|row| {
        let mut numbers = vec![row.parameter];
        numbers.extend(row.reactions.iter().flatten());
        numbers
    });
    table(dir, "reactions.csv", &header, rows)
}

fn columns(name: &str, components: &[&str]) -> impl Iterator<Item = String> {
    components.iter().map(move |component| format!("{name}.{component}"))
}

fn table(
    dir: &Path,
    name: &str,
    header: &[String],
    rows: impl Iterator<Item = Vec<f64>>,
) -> Result<(), Error> {
    let path = dir.join(name);
    let cannot_write = |error: csv::Error| super::cannot_write(&path, error.into());
    let mut writer = csv::Writer::from_path(&path).map_err(cannot_write)?;
    writer.write_record(header).map_err(cannot_write)?;
    for row in rows {
        // The shortest digits that read back exactly; + 0.0 turns -0.0 into 0.0.
        let numbers = row.iter().map(|number| format!("{:?}", number + 0.0));
        writer.write_record(numbers).map_err(cannot_write)?;
    }
    writer.flush().map_err(|error| super::cannot_write(&path, error))
}
