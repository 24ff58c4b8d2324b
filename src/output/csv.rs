//! The tables: one row for the start and every accepted increment or step, or one for every mode.

use std::path::Path;

use super::Results;
use crate::error::Error;

/// Poses of the probes, and Euler angles where a probe asks for them.
pub(super) fn probes(dir: &Path, results: Results) -> Result<(), Error> {
    let mut header = vec![results.parameter().to_owned()];
    for probe in &results.scene.probe {
        header.extend(columns(&probe.name, &["x", "y", "z", "qw", "qx", "qy", "qz"]));
        if probe.angles.is_some() {
            header.extend(columns(&probe.name, &["alpha", "beta", "gamma"]));
        }
    }
    let rows = results.solution.rows.iter().map(|row| {
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
pub(super) fn reactions(dir: &Path, results: Results) -> Result<(), Error> {
    let mut header = vec![results.parameter().to_owned()];
    for index in 0..results.scene.joint.len() {
        let name = results.scene.joint_name(index);
        header.extend(columns(&name, &["fx", "fy", "fz", "mx", "my", "mz"]));
    }
    let rows = results.solution.rows.iter().map(|row| {
        let mut numbers = vec![row.parameter];
        numbers.extend(row.reactions.iter().flatten());
        numbers
    });
    table(dir, "reactions.csv", &header, rows)
}

/// Energies and the largest violation of a joint over time.
pub(super) fn energies(dir: &Path, results: Results) -> Result<(), Error> {
    let header = ["time", "kinetic", "strain", "gravity", "total", "constraint"].map(str::to_owned);
    let pairs = results.solution.rows.iter().zip(&results.solution.energies);
    let rows = pairs.map(|(row, energies)| {
        let [kinetic, strain, gravity] = [energies.kinetic, energies.strain, energies.gravity];
        vec![row.parameter, kinetic, strain, gravity, energies.total(), energies.constraint]
    });
    table(dir, "energies.csv", &header, rows)
}

/// Frequencies and the shapes at the probes; the modes are counted from 1.
pub(super) fn modes(dir: &Path, results: Results) -> Result<(), Error> {
    let mut header = ["mode", "frequency_hz", "angular_frequency"].map(str::to_owned).to_vec();
    for probe in &results.scene.probe {
        header.extend(columns(&probe.name, &["x", "y", "z", "rx", "ry", "rz"]));
    }
    let rows = results.solution.modes.iter().enumerate().map(|(index, mode)| {
        let numbers = [mode.frequency(), mode.angular_frequency];
        let numbers = numbers.into_iter().chain(mode.shape.iter().flatten().copied());
        let number = (index + 1).to_string();
        std::iter::once(number).chain(numbers.map(written)).collect()
    });
    records(dir, "modes.csv", &header, rows)
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
    records(dir, name, header, rows.map(|row| row.into_iter().map(written).collect()))
}

/// The shortest digits that read back exactly; nothing for what is no number, which every reader of tables takes
/// for a missing value.
fn written(number: f64) -> String {
    // + 0.0 turns -0.0 into 0.0.
    if number.is_finite() { format!("{:?}", number + 0.0) } else { String::new() }
}

fn records(
    dir: &Path,
    name: &str,
    header: &[String],
    rows: impl Iterator<Item = Vec<String>>,
) -> Result<(), Error> {
    let path = dir.join(name);
    let cannot_write = |error: csv::Error| super::cannot_write(&path, error.into());
    let mut writer = csv::Writer::from_path(&path).map_err(cannot_write)?;
    writer.write_record(header).map_err(cannot_write)?;
    for row in rows {
        writer.write_record(row).map_err(cannot_write)?;
    }
    writer.flush().map_err(|error| super::cannot_write(&path, error))
}
