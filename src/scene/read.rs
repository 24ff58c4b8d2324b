//! Reading a scene file: overrides, and errors that point at the place in the file.

mod explain;
mod overrides;

use std::path::{Path, PathBuf};

use toml::Value;
use toml::de::{DeTable, DeValue};

use super::analysis::steps_given;
use super::validate::{one_analysis, one_step};
use super::{CurveShape, Scene};
use crate::error::{Error, SceneError};
pub(super) use explain::{hint, one_of};
use overrides::Override;

/// A scene file as it was written, together with the overrides of the command line.
///
/// It remembers where every entry came from, so that also errors found later, when the model is
/// built, can be given their place by [`SceneFile::locate`].
#[derive(Clone, Debug)]
pub struct SceneFile {
    name: String,
    folder: Option<PathBuf>,
    text: String,
    overrides: Vec<Override>,
    document: Value,
}

impl SceneFile {
    /// Reads the file at `path` and applies overrides `KEY=VALUE`, KEY a dotted path with arrays by
    /// index, VALUE in TOML.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read, [`Error::Scene`] if it is not TOML or an override
    /// is wrong.
    pub fn read(path: impl AsRef<Path>, overrides: &[String]) -> Result<Self, Error> {
        let path = path.as_ref();
        let text = std::fs::read_to_string(path).map_err(|source| Error::File {
            action: "read",
            path: path.to_owned(),
            source,
        })?;
        let mut file = Self::parse(text, path.display().to_string(), overrides)?;
        file.folder = path.parent().map(Path::to_owned);
        Ok(file)
    }

    /// Like [`SceneFile::read`], from text; `name` stands for the file in messages.
    ///
    /// # Errors
    /// [`SceneError`] if the text is not TOML or an override is wrong.
    pub fn parse(
        text: impl Into<String>,
        name: impl Into<String>,
        overrides: &[String],
    ) -> Result<Self, SceneError> {
        let (text, name) = (text.into(), name.into());
        let table = text.parse::<toml::Table>().map_err(|error| syntax_error(&error, &text, &name))?;
        let mut document = Value::Table(table);
        let overrides =
            overrides.iter().map(|argument| Override::parse(argument)).collect::<Result<Vec<_>, _>>()?;
        for entry in &overrides {
            entry.apply(&mut document)?;
        }
        Ok(Self { name, folder: None, text, overrides, document })
    }

    /// The scene, validated. A relative file of given poses is resolved against the scene's folder.
    ///
    /// # Errors
    /// [`SceneError`] with its place, for the first entry that is wrong.
    pub fn scene(&self) -> Result<Scene, SceneError> {
        self.interpret().map_err(|error| self.locate(error))
    }

    fn interpret(&self) -> Result<Scene, SceneError> {
        refuse_non_finite(&self.document)?;
        refuse_several_analyses(&self.document)?;
        refuse_steps(&self.document)?;
        let mut scene = explain::deserialize(&self.document)?;
        scene.validate()?;
        if let Some(folder) = &self.folder {
            resolve_files(&mut scene, folder);
        }
        Ok(scene)
    }

    /// Adds the place to an error that has none: `file:line` of its key or of the nearest parent that
    /// is in the file, or the override that set the key.
    pub fn locate(&self, mut error: SceneError) -> SceneError {
        if error.place.is_none() {
            let (line, found) = self.line_of(&error.key);
            // A table that only an override brought in, by one of its entries, is not in the file.
            let setter = self
                .overrides
                .iter()
                .rev()
                .find(|entry| entry.covers(&error.key) || (!found && entry.is_beneath(&error.key)));
            error.place = Some(match setter {
                Some(entry) => entry.place(),
                None => format!("{}:{line}", self.name),
            });
        }
        error
    }

    /// The line of a key or of its nearest parent, and whether it is the key itself.
    fn line_of(&self, key: &str) -> (usize, bool) {
        // The text was parsed before, so this cannot fail; line 1 would still be a sensible answer.
        DeTable::parse(&self.text).map_or((1, false), |root| {
            let (offset, found) = offset_of(root.get_ref(), key);
            (line_at(&self.text, offset), found)
        })
    }
}

impl Scene {
    /// Reads and validates a scene file.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read, [`Error::Scene`] with file and line if it is wrong.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, Error> {
        Ok(SceneFile::read(path, &[])?.scene()?)
    }

    /// Reads and validates a scene given as TOML text.
    ///
    /// # Errors
    /// [`SceneError`] whose place is `scene:line`.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        SceneFile::parse(text, "scene", &[])?.scene()
    }
}

/// A TOML syntax error; there is no key yet, so the offending line stands in for it.
fn syntax_error(error: &toml::de::Error, text: &str, name: &str) -> SceneError {
    let offset = error.span().map_or(0, |span| span.start);
    let line = line_at(text, offset);
    let source = text.lines().nth(line - 1).unwrap_or_default().trim();
    let (problem, expected) = match error.message().split_once(", expected ") {
        Some((problem, expected)) => (problem, expected),
        None if error.message() == "duplicate key" => ("the key was given before", "every key only once"),
        None if error.message().contains("overflow") => (error.message(), "a number within range"),
        None => (error.message(), "valid TOML"),
    };
    SceneError {
        key: source.to_owned(),
        problem: problem.to_owned(),
        expected: expected.to_owned(),
        place: Some(format!("{name}:{line}")),
    }
}

/// The line of a byte offset, counted from 1.
fn line_at(text: &str, offset: usize) -> usize {
    let end = offset.min(text.len());
    1 + text.as_bytes()[..end].iter().filter(|byte| **byte == b'\n').count()
}

/// Where the entry of a dotted key starts, or the nearest parent that exists, and which of the two.
fn offset_of(root: &DeTable<'_>, key: &str) -> (usize, bool) {
    let mut segments = key.split('.').peekable();
    let mut offset = 0;
    let mut table = Some(root);
    while let (Some(entries), Some(name)) = (table, segments.peek()) {
        let Some((key, mut value)) = entries.iter().find(|(key, _)| key.get_ref() == name) else {
            break;
        };
        segments.next();
        offset = key.span().start;
        while let (DeValue::Array(items), Some(index)) = (value.get_ref(), segments.peek()) {
            let index = index.parse().ok();
            let Some(item) = index.and_then(|index: usize| items.get(index)) else {
                return (offset, false);
            };
            segments.next();
            offset = item.span().start;
            value = item;
        }
        table = match value.get_ref() {
            DeValue::Table(table) => Some(table),
            _ => None,
        };
    }
    (offset, segments.peek().is_none())
}

/// Appends a segment to a dotted key.
pub(super) fn beneath(key: &str, segment: &str) -> String {
    if key.is_empty() { segment.to_owned() } else { format!("{key}.{segment}") }
}

/// Refuses infinities and NaN anywhere in a document.
pub(super) fn refuse_non_finite(document: &Value) -> Result<(), SceneError> {
    fn walk(value: &Value, key: &str) -> Result<(), SceneError> {
        match value {
            Value::Float(number) if !number.is_finite() => {
                Err(SceneError::new(key, format!("is {number}"), "a finite number"))
            }
            Value::Array(items) => items
                .iter()
                .enumerate()
                .try_for_each(|(index, item)| walk(item, &beneath(key, &index.to_string()))),
            Value::Table(entries) => {
                entries.iter().try_for_each(|(name, entry)| walk(entry, &beneath(key, name)))
            }
            _ => Ok(()),
        }
    }
    walk(document, "")
}

/// Here rather than by serde, to point at the entry; a table that is wrong in itself is left to serde.
fn refuse_steps(document: &Value) -> Result<(), SceneError> {
    let given = document.get("dynamics").and_then(steps_given);
    given.map_or(Ok(()), |[time_step, accuracy]| one_step(time_step, accuracy))
}

/// Before the entries of an analysis are looked at: a surplus one need not be complete.
fn refuse_several_analyses(document: &Value) -> Result<(), SceneError> {
    let present = ["statics", "dynamics", "modes"].map(|table| document.get(table).is_some());
    if present == [false; 3] { Ok(()) } else { one_analysis(present) }
}

/// Makes the files of given poses independent of the scene's folder and of the current one, so that
/// the scene can be written somewhere else and read again.
fn resolve_files(scene: &mut Scene, folder: &Path) {
    for rod in &mut scene.rod {
        if let CurveShape::Poses { file } = &mut rod.curve.shape {
            let joined = folder.join(&file);
            *file = std::path::absolute(&joined).unwrap_or(joined);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSES: &str = r#"
[[rod]]
name = "cable"
curve = { kind = "poses", file = "poses.csv" }
section = { kind = "circle", diameter = 0.01 }
material = { young_modulus = 2e11, poisson_ratio = 0.3 }
elements = 4
degree = 2
[statics]
"#;

    #[test]
    fn files_of_poses_are_looked_for_beside_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, POSES).unwrap();
        let scene = Scene::from_file(&path).unwrap();
        let file = folder.path().join("poses.csv");
        assert_eq!(scene.rod[0].curve.shape, CurveShape::Poses { file });
    }

    #[test]
    fn later_errors_are_given_their_place() {
        let overrides = ["rod.0.degree=3".to_owned(), "plot.slope=1".to_owned()];
        let file = SceneFile::parse(POSES, "cable.toml", &overrides).unwrap();
        let place = |key: &str| file.locate(SceneError::new(key, "", "")).place.unwrap();
        assert_eq!(place("rod.0.curve.file"), "cable.toml:4");
        assert_eq!(place("rod.0.curve"), "cable.toml:4");
        assert_eq!(place("rod.0"), "cable.toml:2");
        assert_eq!(place("rod.0.reference"), "cable.toml:2");
        assert_eq!(place("rod.0.degree"), "--set rod.0.degree=3");
        assert_eq!(place("plot"), "--set plot.slope=1");
        assert_eq!(place("joint.7.axis"), "cable.toml:1");
    }
}
