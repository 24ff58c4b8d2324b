//! The results of a study: `study.csv` grows row by row, `study.json` remembers what it was for, `study.svg` shows it.
//!
//! Every file is replaced as a whole, by renaming one that is complete: a study can be stopped at any time.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{cannot_write, svg};
use crate::error::{Error, SceneError};
use crate::scene::{CurveShape, Scene};
use crate::solution::ProbePose;
use crate::study::{Errors, Key, Plan, Reference, Row, SOLVED, Trajectory};

const TABLE: &str = "study.csv";
const MEMORY: &str = "study.json";
const PICTURE: &str = "study.svg";

/// What of a study lies in a folder already.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// Its reference.
    pub reference: Reference,
    /// The rows of finished runs; of each of the study's runs at most one, in order.
    pub rows: Vec<Row>,
}

/// Reads what an earlier study of the same scene has left in the folder; nothing if there is none.
///
/// # Errors
/// [`Error::Scene`] if the folder holds the study of another scene, of other settings, or of another version of this
/// program; [`Error::File`] if a file cannot be read.
pub fn read(dir: &Path, plan: &Plan) -> Result<Option<Stored>, Error> {
    let path = dir.join(MEMORY);
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(Error::File { action: "read", path, source }),
    };
    let other = |problem: &str| {
        let expected = format!("another folder, or {} removed", path.display());
        Err(Error::Scene(SceneError::new("--out", problem, expected)))
    };
    let Ok(memory) = serde_json::from_str::<Memory>(&text) else {
        return other("holds a study.json that is not of this program");
    };
    if memory.version != env!("CARGO_PKG_VERSION") {
        return other(&format!("holds a study that cosserat {} has begun", memory.version));
    }
    if memory.identity != Identity::of(plan)? {
        return other("holds the study of another scene or of other settings");
    }
    let rows = read_rows(dir, plan)?;
    Ok(Some(Stored { reference: memory.reference.into(), rows }))
}

/// Writes what a study needs to be resumed.
///
/// # Errors
/// [`Error::File`] if it cannot be written.
pub fn write_reference(dir: &Path, plan: &Plan, reference: &Reference) -> Result<(), Error> {
    let path = dir.join(MEMORY);
    let memory = Memory {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        identity: Identity::of(plan)?,
        reference: reference.into(),
    };
    let text = serde_json::to_string_pretty(&memory).map_err(|error| cannot_write(&path, error.into()))?;
    replace(path, &text)
}

/// Writes the table with the rows there are.
///
/// # Errors
/// [`Error::File`] if it cannot be written.
pub fn write_rows(dir: &Path, rows: &[Row]) -> Result<(), Error> {
    let path = dir.join(TABLE);
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    let failed = |error: csv::Error| cannot_write(&path, error.into());
    writer.write_record(COLUMNS).map_err(failed)?;
    for row in rows {
        writer.serialize(Record::from(row)).map_err(failed)?;
    }
    let bytes = writer.into_inner().map_err(|error| cannot_write(&path, error.into_error()))?;
    let text = String::from_utf8(bytes).map_err(|error| cannot_write(&path, std::io::Error::other(error)))?;
    replace(path, &text)
}

/// Draws the work–precision diagram.
///
/// # Errors
/// [`Error::File`] if it cannot be written.
pub fn draw(dir: &Path, title: Option<&str>, rows: &[Row], reference: &Errors) -> Result<(), Error> {
    let path = dir.join(PICTURE);
    let document = svg::study(title, rows, reference).map_err(|error| cannot_write(&path, error))?;
    replace(path, &document)
}

/// Writes a file into the folder and removes it.
///
/// # Errors
/// [`Error::File`] if nothing can be written there.
pub fn try_to_write(dir: &Path) -> Result<(), Error> {
    let path = beside(&dir.join(TABLE));
    std::fs::write(&path, "").map_err(|source| cannot_write(&path, source))?;
    super::remove(path)
}

/// The name beside a file's is this process's own: the same study may be running in the folder twice.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.to_owned().into_os_string();
    name.push(format!(".{}.part", std::process::id()));
    name.into()
}

/// Writes a file beside its place and moves it there.
fn replace(path: PathBuf, text: &str) -> Result<(), Error> {
    let beside = beside(&path);
    std::fs::write(&beside, text).map_err(|source| cannot_write(&beside, source))?;
    std::fs::rename(&beside, &path).map_err(|source| cannot_write(&path, source))
}

/// The rows of the plan's runs; what was cut off or is of no run of the plan is left out, to be done again.
fn read_rows(dir: &Path, plan: &Plan) -> Result<Vec<Row>, Error> {
    let path = dir.join(TABLE);
    let bytes = match std::fs::read(&path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(source) => return Err(Error::File { action: "read", path, source }),
    };
    // The last line may have been cut off, and still look like one.
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(&[][..], |end| &bytes[..=end]);
    let mut reader = csv::Reader::from_reader(whole);
    let found: Vec<Row> = reader.deserialize::<Record>().filter_map(|record| record.ok()?.row()).collect();
    Ok(plan.keys().filter_map(|key| found.iter().find(|row| row.key == *key).cloned()).collect())
}

/// The columns of the table.
const COLUMNS: [&str; 12] = [
    "degree",
    "elements",
    "interpolation",
    "increments",
    "time_step",
    "tolerance",
    "position_error",
    "rotation_error",
    "seconds",
    "newton_iterations",
    "factorizations",
    "status",
];

/// A row of the table.
#[derive(Serialize, Deserialize)]
struct Record {
    degree: Option<usize>,
    elements: Option<usize>,
    interpolation: Option<crate::scene::InterpolationKind>,
    increments: Option<usize>,
    time_step: Option<f64>,
    tolerance: Option<f64>,
    position_error: Option<f64>,
    rotation_error: Option<f64>,
    seconds: Option<f64>,
    newton_iterations: Option<usize>,
    factorizations: Option<usize>,
    status: String,
}

impl From<&Row> for Record {
    fn from(row: &Row) -> Self {
        let Key { degree, elements, interpolation, increments, time_step, tolerance } = row.key.clone();
        Self {
            degree,
            elements,
            interpolation,
            increments,
            time_step,
            tolerance,
            position_error: row.errors.map(|errors| errors.position),
            rotation_error: row.errors.map(|errors| errors.rotation),
            seconds: row.seconds,
            newton_iterations: row.newton_iterations,
            factorizations: row.factorizations,
            status: row.status.clone(),
        }
    }
}

impl Record {
    /// `None` for a row without status, or one that was solved and says not how well, or with numbers that no run has.
    fn row(self) -> Option<Row> {
        let Self { degree, elements, interpolation, increments, time_step, tolerance, .. } = self;
        let errors = self.position_error.zip(self.rotation_error);
        let errors = errors.map(|(position, rotation)| Errors { position, rotation });
        let possible = |number: f64| number.is_finite() && number >= 0.0;
        let complete = if self.status == SOLVED {
            let errors = errors.is_some_and(|errors| possible(errors.position) && possible(errors.rotation));
            errors && self.seconds.is_some_and(possible)
        } else {
            !self.status.is_empty()
        };
        complete.then_some(Row {
            key: Key { degree, elements, interpolation, increments, time_step, tolerance },
            errors,
            seconds: self.seconds,
            newton_iterations: self.newton_iterations,
            factorizations: self.factorizations,
            status: self.status,
        })
    }
}

/// `study.json`.
#[derive(Serialize, Deserialize)]
struct Memory {
    version: String,
    identity: Identity,
    reference: StoredReference,
}

/// What must be the same for a study to be resumed.
#[derive(PartialEq, Serialize, Deserialize)]
struct Identity {
    /// The scene as a file has it, without what changes no run.
    scene: String,
    /// The runs.
    runs: Vec<Key>,
    accuracies: Vec<f64>,
    /// Files of given poses: a sum over their bytes.
    files: Vec<String>,
}

impl Identity {
    fn of(plan: &Plan) -> Result<Self, Error> {
        let scene = Scene { title: None, plot: None, ..plan.scene().clone() };
        let text = toml::to_string(&scene).map_err(|error| {
            Error::Scene(SceneError::new("scene", error.to_string(), "entries that a scene file can hold"))
        })?;
        let files = scene.rod.iter().filter_map(|rod| match &rod.curve.shape {
            CurveShape::Poses { file } => Some(file),
            _ => None,
        });
        let sum = |path: &PathBuf| match std::fs::read(path) {
            Ok(bytes) => Ok(format!("{:016x}", fnv_1a(&bytes))),
            Err(source) => Err(Error::File { action: "read", path: path.clone(), source }),
        };
        Ok(Self {
            scene: text,
            runs: plan.keys().cloned().collect(),
            accuracies: plan.accuracies().to_vec(),
            files: files.map(sum).collect::<Result<_, _>>()?,
        })
    }
}

/// FNV-1a (Fowler, Noll & Vo 1991), which is the same on every machine.
fn fnv_1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// A reference with its path: for every milestone the poses of the probes, position and quaternion.
#[derive(Serialize, Deserialize)]
struct StoredReference {
    degree: Option<usize>,
    elements: Option<usize>,
    time_step: Option<f64>,
    position_error: f64,
    rotation_error: f64,
    seconds: f64,
    size: f64,
    rows: Vec<(usize, Vec<StoredPose>)>,
}

/// Position and quaternion.
type StoredPose = ([f64; 3], [f64; 4]);

impl From<&Reference> for StoredReference {
    fn from(reference: &Reference) -> Self {
        let poses = |poses: &[ProbePose]| poses.iter().map(|pose| (pose.position, pose.quaternion)).collect();
        let rows = reference.trajectory.rows.iter().map(|(index, row)| (*index, poses(row)));
        Self {
            degree: reference.degree,
            elements: reference.elements,
            time_step: reference.time_step,
            position_error: reference.error.position,
            rotation_error: reference.error.rotation,
            seconds: reference.seconds,
            size: reference.trajectory.size,
            rows: rows.collect(),
        }
    }
}

impl From<StoredReference> for Reference {
    fn from(stored: StoredReference) -> Self {
        let pose = |(position, quaternion)| ProbePose { position, quaternion, angles: None };
        let rows = stored.rows.into_iter().map(|(index, row)| (index, row.into_iter().map(pose).collect()));
        Self {
            trajectory: Trajectory { rows: rows.collect(), size: stored.size },
            error: Errors { position: stored.position_error, rotation: stored.rotation_error },
            degree: stored.degree,
            elements: stored.elements,
            time_step: stored.time_step,
            seconds: stored.seconds,
        }
    }
}
