//! Names: one thing each, and fit for columns and files.

use std::collections::HashMap;

use super::check::{Check, fail, quoted};
use crate::scene::Scene;

pub(super) fn names(scene: &Scene) -> Check {
    let parts = keyed("rod", scene.rod.iter().map(|rod| rod.name.clone()))
        .chain(keyed("body", scene.body.iter().map(|body| body.name.clone())));
    let parts: Vec<_> = parts.collect();
    unique(&parts, "rod and body")?;
    if let Some((key, _)) = parts.iter().find(|(_, name)| name == "ground") {
        return fail(
            format!("{key}.name"),
            "is \"ground\", which is what joints call the fixed world",
            "another name",
        );
    }
    let joints: Vec<_> =
        keyed("joint", (0..scene.joint.len()).map(|index| scene.joint_name(index))).collect();
    unique(&joints, "joint")?;
    let probes: Vec<_> = keyed("probe", scene.probe.iter().map(|probe| probe.name.clone())).collect();
    unique(&probes, "probe")
}

/// Every name with the key of the entry that has it.
fn keyed(table: &'static str, names: impl Iterator<Item = String>) -> impl Iterator<Item = (String, String)> {
    names.enumerate().map(move |(index, name)| (format!("{table}.{index}"), name))
}

/// Names are prefixes of columns and parts of file names, and `@` ends the name of a rod.
fn unique(names: &[(String, String)], what: &str) -> Check {
    let mut seen = HashMap::new();
    for (entry, name) in names {
        let key = format!("{entry}.name");
        if name.is_empty() {
            return fail(key, "is empty", "a name");
        }
        let forbidden = |c: &char| matches!(c, '@' | ',' | '"' | '/') || c.is_control();
        if let Some(character) = name.chars().find(forbidden) {
            return fail(
                key,
                format!("is {} and contains {character:?}", quoted(name)),
                "a name without @, comma, quotation mark, slash and control characters",
            );
        }
        if let Some(first) = seen.insert(name, entry) {
            return fail(
                key,
                format!("is {}, the name of `{first}` too", quoted(name)),
                format!("a different name for every {what}"),
            );
        }
    }
    Ok(())
}
