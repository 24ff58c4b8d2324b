//! Overrides `KEY=VALUE` of single scene entries.

use toml::Value;

use crate::error::SceneError;

/// No entry of a scene lies deeper than this, by far.
const DEEPEST: usize = 64;

/// One override, parsed.
#[derive(Clone, Debug)]
pub(super) struct Override {
    argument: String,
    key: String,
    value: Value,
}

impl Override {
    /// Parses `KEY=VALUE`.
    pub(super) fn parse(argument: &str) -> Result<Self, SceneError> {
        let refuse = |key: &str, problem: &str, expected: String| SceneError {
            key: key.to_owned(),
            problem: problem.to_owned(),
            expected,
            place: Some(place(argument)),
        };
        let Some((key, value)) = argument.split_once('=') else {
            return Err(refuse(argument, "has no value", "KEY=VALUE, such as rod.0.elements=150".into()));
        };
        let (key, value) = (key.trim(), value.trim());
        if key.split('.').any(|segment| segment.trim().is_empty()) {
            let expected = "a dotted path with arrays by index, such as rod.0.elements";
            return Err(refuse(key, "is not a key", expected.into()));
        }
        if key.split('.').count() > DEEPEST {
            let expected = format!("a path of at most {DEEPEST} parts");
            return Err(refuse("…", "is nested too deeply", expected));
        }
        match value.parse::<Value>() {
            Ok(value) => Ok(Self {
                argument: argument.to_owned(),
                key: key.split('.').map(str::trim).collect::<Vec<_>>().join("."),
                value,
            }),
            Err(_) if value.is_empty() => {
                Err(refuse(key, "has no value", "a value in TOML after the equals sign".into()))
            }
            Err(_) => Err(refuse(
                key,
                &format!("{value} is not TOML"),
                format!(
                    "a value in TOML (strings need quotes: --set '{key}=\"{}\"')",
                    value.trim_matches(['"', '\''])
                ),
            )),
        }
    }

    /// Sets the entry, which may be absent, also in an absent table; arrays do not grow.
    pub(super) fn apply(&self, document: &mut Value) -> Result<(), SceneError> {
        let refuse = |key: &str, problem: String, expected: String| {
            Err(SceneError { key: key.to_owned(), problem, expected, place: Some(self.place()) })
        };
        let mut node = document;
        let mut walked = String::new();
        for segment in self.key.split('.') {
            let parent = walked.clone();
            walked = super::beneath(&walked, segment);
            node = match node {
                Value::Table(entries) => {
                    let is_index = segment.bytes().all(|byte| byte.is_ascii_digit());
                    if entries.is_empty() && is_index {
                        let expected = "an array that the scene file has";
                        return refuse(&walked, format!("`{parent}` is absent"), expected.into());
                    }
                    // A new entry is a table until the walk ends or goes on into it.
                    entries.entry(segment).or_insert_with(|| Value::Table(toml::Table::new()))
                }
                Value::Array(items) => {
                    let count = items.len();
                    let item = segment.parse().ok().and_then(|index: usize| items.get_mut(index));
                    let Some(item) = item else {
                        let expected = match count {
                            0 => "no index, because the array is empty".to_owned(),
                            1 => "the index 0, because the array has one entry".to_owned(),
                            _ => format!("an index from 0 to {}", count - 1),
                        };
                        return refuse(&walked, format!("`{parent}` has no entry {segment}"), expected);
                    };
                    item
                }
                _ => {
                    let expected = format!("a key that is no longer than `{parent}`");
                    return refuse(&walked, format!("`{parent}` is neither a table nor an array"), expected);
                }
            };
        }
        *node = self.value.clone();
        Ok(())
    }

    /// Whether an entry was set by this override.
    pub(super) fn covers(&self, key: &str) -> bool {
        key.strip_prefix(&self.key).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    }

    /// Whether this override set something inside the entry.
    pub(super) fn is_beneath(&self, key: &str) -> bool {
        self.key.strip_prefix(key).is_some_and(|rest| rest.starts_with('.'))
    }

    /// What messages name instead of file and line.
    pub(super) fn place(&self) -> String {
        place(&self.argument)
    }
}

fn place(argument: &str) -> String {
    format!("--set {argument}")
}
