//! Every way in which this crate refuses or stops, with the numbers that say why.

use std::path::PathBuf;

use thiserror::Error;

/// A scene that cannot be solved as it is written.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}`{key}`: {problem}; expected {expected}", .place.as_deref().map(|p| format!("{p}: ")).unwrap_or_default())]
pub struct SceneError {
    /// Dotted path of the entry, arrays by index: `rod.0.section.diameter`.
    pub key: String,
    /// What is wrong with it.
    pub problem: String,
    /// What would be right.
    pub expected: String,
    /// `file:line`, or the command-line override the entry came from; absent for scenes built in Rust.
    pub place: Option<String>,
}

impl SceneError {
    /// An error without a place; the reader of a file adds it.
    pub fn new(key: impl Into<String>, problem: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { key: key.into(), problem: problem.into(), expected: expected.into(), place: None }
    }
}

/// Why a scene did not become a model.
#[derive(Debug, Error)]
pub enum Error {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file could not be read or written.
    #[error("cannot {action} {path}: {source}", path = .path.display())]
    File {
        /// "read", "write" or "remove".
        action: &'static str,
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}
