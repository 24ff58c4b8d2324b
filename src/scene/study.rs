//! What a study tries: the lists of its settings.

use serde::{Deserialize, Serialize};

use super::InterpolationKind;

/// The study of speed against accuracy on a scene: every combination of what is listed here, and the scene's own
/// setting where there is no list. Without any list a selection about the scene's own settings is tried.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Study {
    /// Degrees of all rods; with SE(3) the degree is 1, whatever is listed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degree: Option<Vec<usize>>,
    /// Numbers of elements, all rods together, shared among them in the proportions of the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elements: Option<Vec<usize>>,
    /// Interpolations of all rods.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interpolation: Option<Vec<InterpolationKind>>,
    /// Numbers of equal load increments, or `"automatic"`; beside `[statics]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub increments: Option<Vec<Increments>>,
    /// Constant time steps [s]; beside `[dynamics]`. All runs pass through the same times: a step that does not divide
    /// the intervals between them is replaced by the nearest that does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_step: Option<Vec<f64>>,
    /// Absolute max-norms of the residual, or `"default"` for the unit-free test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<Vec<Tolerance>>,
    /// The accuracies for which the cheapest settings are named: of positions relative to the length of all rods
    /// together, of rotations in radians; default 1e-2, 1e-4, 1e-6 in statics and 1e-2, 1e-3, 1e-4 in dynamics.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracies: Option<Vec<f64>>,
}

/// How the load is brought up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Entry<usize>", into = "Entry<usize>")]
pub enum Increments {
    /// As many increments as it takes: `"automatic"`.
    Automatic,
    /// A number of equal increments.
    Equal(usize),
}

/// When Newton's iteration ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Entry<f64>", into = "Entry<f64>")]
pub enum Tolerance {
    /// The unit-free test: `"default"`.
    Relative,
    /// Absolute max-norm of the residual [N, N m; m, rad for joints].
    Absolute(f64),
}

/// A number or a word, as it is written.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Entry<T> {
    Number(T),
    Word(String),
}

const AUTOMATIC: &str = "automatic";
const DEFAULT: &str = "default";

impl TryFrom<Entry<usize>> for Increments {
    type Error = String;

    fn try_from(entry: Entry<usize>) -> Result<Self, String> {
        match entry {
            Entry::Number(count) => Ok(Self::Equal(count)),
            Entry::Word(word) if word == AUTOMATIC => Ok(Self::Automatic),
            Entry::Word(word) => Err(format!("{word:?} is no number of increments")),
        }
    }
}

impl From<Increments> for Entry<usize> {
    fn from(increments: Increments) -> Self {
        match increments {
            Increments::Automatic => Self::Word(AUTOMATIC.to_owned()),
            Increments::Equal(count) => Self::Number(count),
        }
    }
}

impl TryFrom<Entry<f64>> for Tolerance {
    type Error = String;

    fn try_from(entry: Entry<f64>) -> Result<Self, String> {
        match entry {
            Entry::Number(tolerance) => Ok(Self::Absolute(tolerance)),
            Entry::Word(word) if word == DEFAULT => Ok(Self::Relative),
            Entry::Word(word) => Err(format!("{word:?} is no tolerance")),
        }
    }
}

impl From<Tolerance> for Entry<f64> {
    fn from(tolerance: Tolerance) -> Self {
        match tolerance {
            Tolerance::Relative => Self::Word(DEFAULT.to_owned()),
            Tolerance::Absolute(tolerance) => Self::Number(tolerance),
        }
    }
}
