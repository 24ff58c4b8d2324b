//! The few questions that are asked of many entries.

use crate::error::SceneError;
use crate::scene::read::{hint, one_of};

/// Nothing, or what is wrong.
pub(super) type Check = Result<(), SceneError>;

/// More of anything than this is a slip of the keyboard and would only exhaust the memory.
pub(super) const MOST: usize = 10_000_000;

pub(super) fn fail(key: impl Into<String>, problem: impl Into<String>, expected: impl Into<String>) -> Check {
    Err(SceneError::new(key, problem, expected))
}

/// A number for a message: shortest digits, as a scene file would have it.
pub(super) fn finite_number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

pub(super) fn quoted(name: &str) -> String {
    format!("{name:?}")
}

pub(super) fn positive(key: impl Into<String>, value: f64, expected: &str) -> Check {
    if value > 0.0 {
        return Ok(());
    }
    fail(key, format!("is {}", finite_number(value)), expected)
}

pub(super) fn at_least_one(key: &str, value: usize, what: &str) -> Check {
    if (1..=MOST).contains(&value) {
        return Ok(());
    }
    let expected = format!("at least 1 and at most {MOST} {what}");
    fail(key, format!("is {value}"), expected)
}

pub(super) fn non_zero(key: &str, value: &[f64], expected: &str) -> Check {
    if value.iter().any(|component| *component != 0.0) {
        return Ok(());
    }
    fail(key, "is zero", expected)
}

/// A reference to a rod; `suffix` is what follows the name in the scene (`@ξ`), for the suggestion.
pub(super) fn known(key: &str, name: &str, names: &[String], suffix: &str) -> Check {
    if names.iter().any(|known| known == name) {
        return Ok(());
    }
    let candidates: Vec<_> = names.iter().map(|name| format!("{name}{suffix}")).collect();
    let written = format!("{name}{suffix}");
    let hint = hint(&written, &candidates, '"');
    fail(
        key,
        format!("is {written:?}, but no rod has the name {name:?}{hint}"),
        match names.len() {
            0 => "a rod, but the scene has none".into(),
            _ => listed(names, "the rod", "rods"),
        },
    )
}

/// "the rod …", "one of the rods …" or, of many, only their number.
pub(super) fn listed(names: &[String], one: &str, many: &str) -> String {
    match names.len() {
        1 => format!("{one} {}", one_of(names, '"')),
        2..=8 => format!("one of the {many} {}", one_of(names, '"')),
        count => format!("one of the {count} {many}"),
    }
}
