//! From serde's errors to messages that name the key and say in the user's words what is expected.
//!
//! serde_path_to_error knows the path, except inside tagged tables (`curve`, `section`,
//! `reference`, `shape`): serde reads those twice and forgets where it was. There the key is found again,
//! by its name where the message has it, otherwise by leaving out one entry at a time.

use serde_path_to_error::Segment;
use toml::Value;

use super::beneath;
use crate::error::SceneError;
use crate::scene::Scene;

/// Deserialises a document and explains the first error.
pub(super) fn deserialize(document: &Value) -> Result<Scene, SceneError> {
    refuse_arrays(document)?;
    let scene: Scene = serde_path_to_error::deserialize(document.clone()).map_err(|error| {
        let path = path_of(error.path());
        explain(document, path, error.inner().message())
    })?;
    refuse_ignored(document, &scene)?;
    Ok(scene)
}

/// serde takes an array for a table if the order of the fields is right; in a scene that is a mistake.
fn refuse_arrays(document: &Value) -> Result<(), SceneError> {
    let table = |value: Option<&Value>, key: String| match value {
        Some(value @ Value::Array(_)) => {
            let path: Vec<_> = key.split('.').map(str::to_owned).collect();
            let expected = describe(&path).unwrap_or("a table");
            Err(SceneError::new(key, show(value), expected))
        }
        _ => Ok(()),
    };
    for key in ["statics", "dynamics", "modes", "plot", "study"] {
        table(document.get(key), key.to_owned())?;
    }
    for key in ["rod", "body", "joint", "load", "probe"] {
        let entries = document.get(key).and_then(Value::as_array);
        for (index, entry) in entries.into_iter().flatten().enumerate() {
            let key = format!("{key}.{index}");
            table(Some(entry), key.clone())?;
            for part in ["curve", "section", "material", "reference", "shape"] {
                table(entry.get(part), beneath(&key, part))?;
            }
        }
    }
    Ok(())
}

fn path_of(path: &serde_path_to_error::Path) -> Vec<String> {
    path.iter()
        .filter_map(|segment| match segment {
            Segment::Seq { index } => Some(index.to_string()),
            Segment::Map { key } => Some(key.clone()),
            Segment::Enum { .. } | Segment::Unknown => None,
        })
        .collect()
}

fn explain(document: &Value, mut path: Vec<String>, message: &str) -> SceneError {
    let (found, expected) = message.split_once(", expected ").unwrap_or((message, ""));
    let candidates = in_backticks(expected);
    if let Some(name) = found.strip_prefix("unknown field ") {
        let name = name.trim_matches('`');
        if path.last().is_some_and(|last| last == name) {
            path.pop();
        }
        return unknown_key(document, path, name, candidates);
    }
    if let Some(name) = message.strip_prefix("missing field ") {
        return missing_key(document, path, name.trim_matches('`'));
    }
    if lookup(document, &path).is_some_and(Value::is_table) {
        if found.starts_with("unknown variant ") {
            path.push("kind".into());
        } else if let Some(culprit) = culprit(document, &path, message) {
            path.push(culprit);
        }
    }
    let value = lookup(document, &path);
    let mut problem = value.map_or_else(|| found.to_owned(), show);
    let wanted = if candidates.is_empty() {
        let message = if expected.is_empty() { message } else { expected };
        describe(&path).map_or_else(|| plainly(&path, message), str::to_owned)
    } else {
        problem.push_str(&hint(value.and_then(Value::as_str).unwrap_or_default(), &candidates, '"'));
        one_of(&candidates, '"')
    };
    SceneError::new(path.join("."), problem, wanted)
}

fn unknown_key(
    document: &Value,
    mut path: Vec<String>,
    name: &str,
    mut candidates: Vec<String>,
) -> SceneError {
    let tagged = lookup(document, &path).is_some_and(|table| table.get("kind").is_some());
    if tagged && name != "kind" && !candidates.iter().any(|candidate| candidate == "kind") {
        candidates.insert(0, "kind".into());
    }
    // The placement is flattened beside the shape, so serde does not list it there.
    if path.len() == 3 && path[2] == "curve" {
        candidates.extend(["origin".into(), "orientation".into()]);
    }
    let hint = hint(name, &candidates, '`');
    path.push(name.to_owned());
    SceneError::new(path.join("."), format!("is not a known key{hint}"), one_of(&candidates, '`'))
}

fn missing_key(document: &Value, mut path: Vec<String>, name: &str) -> SceneError {
    // Without its tag serde does not look at the other keys of a table: a misspelt tag is better
    // explained where it stands.
    if name == "kind"
        && let Some(table) = lookup(document, &path).and_then(Value::as_table)
        && let Some(misspelt) = table.keys().find(|key| near(key, name))
    {
        return unknown_key(document, path, misspelt, vec![name.to_owned()]);
    }
    path.push(name.to_owned());
    let expected = describe(&path).unwrap_or("this key");
    SceneError::new(path.join("."), "is missing", expected)
}

/// The entry of a tagged table without which the error would be another one.
fn culprit(document: &Value, path: &[String], message: &str) -> Option<String> {
    let table = lookup(document, path)?.as_table()?;
    table
        .keys()
        .filter(|key| *key != "kind")
        .find(|key| {
            let mut without = document.clone();
            if let Some(table) = lookup_mut(&mut without, path).and_then(Value::as_table_mut) {
                table.remove(*key);
            }
            match serde_path_to_error::deserialize::<_, Scene>(without) {
                Ok(_) => true,
                Err(error) => error.inner().message() != message,
            }
        })
        .cloned()
}

/// serde ignores further keys beside the tag of a variant without fields (`reference = { kind =
/// "nodes", samples = 5 }`). What was understood is written by the scene again; the rest was ignored.
fn refuse_ignored(document: &Value, scene: &Scene) -> Result<(), SceneError> {
    fn walk(written: &Value, understood: &Value, key: &str) -> Result<(), SceneError> {
        match (written, understood) {
            (Value::Table(written), Value::Table(understood)) => {
                for (name, value) in written {
                    let key = beneath(key, name);
                    let Some(known) = understood.get(name) else {
                        let candidates: Vec<_> = understood.keys().cloned().collect();
                        let expected = one_of(&candidates, '`');
                        return Err(SceneError::new(key, "is not a known key", expected));
                    };
                    walk(value, known, &key)?;
                }
                Ok(())
            }
            (Value::Array(written), Value::Array(understood)) => {
                written.iter().zip(understood).enumerate().try_for_each(|(index, (value, known))| {
                    walk(value, known, &beneath(key, &index.to_string()))
                })
            }
            _ => Ok(()),
        }
    }
    // A scene that cannot be written has a number out of range, which its validation reports.
    Value::try_from(scene).map_or(Ok(()), |understood| walk(document, &understood, ""))
}

fn lookup<'a>(document: &'a Value, path: &[String]) -> Option<&'a Value> {
    path.iter().try_fold(document, |value, segment| match value {
        Value::Table(entries) => entries.get(segment),
        Value::Array(items) => items.get(segment.parse::<usize>().ok()?),
        _ => None,
    })
}

fn lookup_mut<'a>(document: &'a mut Value, path: &[String]) -> Option<&'a mut Value> {
    path.iter().try_fold(document, |value, segment| match value {
        Value::Table(entries) => entries.get_mut(segment),
        Value::Array(items) => items.get_mut(segment.parse::<usize>().ok()?),
        _ => None,
    })
}

/// What is written, in short.
fn show(value: &Value) -> String {
    match value {
        Value::Table(_) => "is a table".into(),
        Value::Array(items) if items.is_empty() => "is an empty array".into(),
        Value::Array(items) if items.len() == 1 => "is an array with one entry".into(),
        Value::Array(items) => format!("is an array with {} entries", items.len()),
        Value::String(text) => format!("is {text:?}"),
        other => format!("is {other}"),
    }
}

fn in_backticks(text: &str) -> Vec<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Joins candidates to "`a`, `b` or `c`".
pub(in crate::scene) fn one_of(candidates: &[String], quote: char) -> String {
    let quoted: Vec<_> = candidates.iter().map(|candidate| format!("{quote}{candidate}{quote}")).collect();
    match quoted.split_last() {
        None => "nothing".into(),
        Some((only, [])) => only.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}

/// " (did you mean …?)" if a candidate is near.
pub(in crate::scene) fn hint(word: &str, candidates: &[String], quote: char) -> String {
    candidates
        .iter()
        .filter(|candidate| near(word, candidate))
        .min_by_key(|candidate| strsim::osa_distance(word, candidate))
        .map(|best| format!(" (did you mean {quote}{best}{quote}?)"))
        .unwrap_or_default()
}

fn near(word: &str, candidate: &str) -> bool {
    let allowed = (candidate.chars().count() / 3).max(1);
    // Equal but for the case counts as near, however long the word.
    word.eq_ignore_ascii_case(candidate) || strsim::osa_distance(word, candidate) <= allowed
}

/// serde's words for what it expects, in the words of a scene file.
fn plainly(path: &[String], expected: &str) -> String {
    match expected {
        "f64" => "a number".into(),
        "usize" => "a whole number, not negative".into(),
        "a boolean" => "true or false".into(),
        "a string" => "a string in quotes".into(),
        "a sequence" if path.len() == 1 => format!("an array of tables `[[{}]]`", path[0]),
        _ if expected.starts_with("struct ") || expected.contains("enum ") => "a table".into(),
        other => other.into(),
    }
}

/// What belongs to a key, with its unit.
fn describe(path: &[String]) -> Option<&'static str> {
    let table = path.first().map(String::as_str);
    if let Some(described) = describe_study(path) {
        return Some(described);
    }
    Some(match path.last()?.as_str() {
        "name" | "title" => "a string in quotes",
        "gravity" if path.len() == 1 => "an acceleration `[x, y, z]` [m/s²]",
        "inertia" if table == Some("body") => "three principal moments of inertia `[x, y, z]` [kg m²]",
        "gravity" | "inertia" => "true or false",
        "curve" => "a table such as `{ kind = \"line\", length = 1.0 }`",
        "section" => "a table such as `{ kind = \"circle\", diameter = 1e-3 }`",
        "material" => "a table such as `{ young_modulus = 2e11, poisson_ratio = 0.3 }`",
        "reference" => "a table, `{ kind = \"nodes\" }` or `{ kind = \"fit\", samples = … }`",
        "elements" => "a whole number of elements, at least 1",
        "degree" => "a whole number, the polynomial degree, from 1 to 8",
        "node_spacing" => "\"gauss-lobatto\" or \"equal\"",
        "interpolation" => "\"r12\" or \"se3\"",
        "quadrature" => "\"reduced\" or \"full\"",
        "theory" => "\"cosserat\"",
        "kind" => match (table?, path.get(2).map(String::as_str)) {
            ("rod", Some("curve")) => "\"line\", \"arc\", \"helix\" or \"poses\"",
            ("rod", Some("section")) => "\"circle\", \"rectangle\" or \"custom\"",
            ("rod", Some("reference")) => "\"nodes\" or \"fit\"",
            ("body", Some("shape")) => "\"cylinder\", \"cuboid\" or \"sphere\"",
            ("joint", _) => "\"rigid\", \"spherical\" or \"revolute\"",
            ("load", _) => "\"force\", \"moment\", \"line_force\" or \"line_moment\"",
            _ => return None,
        },
        "diameter" => "a positive diameter [m]",
        "inner_diameter" => "an inner diameter [m]",
        "width" | "height" | "length" => "a positive length [m]",
        "radius" => "a positive radius [m]",
        "angle" => "a positive angle [rad]",
        "coils" => "a positive number of coils",
        "pitch" => "a number, the rise per coil [m]",
        "phase" => "an angle [rad]",
        "file" => "the path of a CSV file, in quotes",
        "shape" => "a table such as `{ kind = \"sphere\", radius = 0.1 }`",
        "size" => "three positive edges `[x, y, z]` [m]",
        "mass" => "a positive mass [kg]",
        "position" => "the centre of mass `[x, y, z]` [m]",
        "velocity" => "a velocity `[x, y, z]` [m/s]",
        "angular_velocity" => "an angular velocity `[x, y, z]` [rad/s]",
        "from" | "to" | "origin" | "offset" | "point" => "a vector `[x, y, z]` [m]",
        "normal" | "axis" => "a direction `[x, y, z]`",
        "orientation" => "a quaternion `[w, x, y, z]`",
        "shear_factor" => "a positive number",
        "torsion_constant" => "a positive torsion constant [m⁴]",
        "axial" | "shear_y" | "shear_z" => "a positive stiffness [N]",
        "torsion" | "bending_y" | "bending_z" => "a positive stiffness [N m²]",
        "mass_per_length" => "a positive mass per length [kg/m]",
        "rotary_inertia" => "three positive numbers `[xx, yy, zz]` [kg m]",
        "young_modulus" | "shear_modulus" => "a positive modulus [Pa]",
        "poisson_ratio" => "a number above -1 and up to 0.5",
        "density" => "a positive density [kg/m³]",
        "samples" => "a whole number of samples",
        "between" => "two parts in quotes, such as `[\"ground\", \"rod@0\"]`",
        "on" if table == Some("load") => "the point \"rod@ξ\" or a body, or the rod's name for a line load",
        "on" => "the point \"rod@ξ\" or a body",
        "value" => "a vector `[x, y, z]` [N, N m, N/m or N m/m, by kind]",
        "basis" => "\"inertial\" or \"body\"",
        "time" => "\"ramp\", \"constant\" or rows `[[t, factor], …]`",
        "angles" => "\"zyx\"",
        "increments" => "a whole number of increments, at least 1",
        "tolerance" if table == Some("dynamics") => "a positive number [N, N m; m, rad for joints]",
        "tolerance" => "a positive number [N, N m]",
        "end_time" => "a positive time [s]",
        "time_step" => "a positive time step [s]",
        "accuracy" => "a positive part of the rods' length, and angle [rad]",
        "method" => "\"generalized-alpha\" or \"radau\"",
        "spectral_radius" => "a number from 0 to 1",
        "count" => "a whole number of modes, at least 1",
        "newton" => "\"mixed\" or \"displacement\"",
        "max_iterations" => "a whole number of iterations, at least 1",
        "coordinates" => "\"increments\" or \"quaternions\"",
        "slope" => "a number [N/m]",
        "statics" if path.len() == 1 => "a table `[statics]`",
        "dynamics" if path.len() == 1 => "a table `[dynamics]`",
        "modes" if path.len() == 1 => "a table `[modes]`",
        "plot" if path.len() == 1 => "a table `[plot]`",
        "study" if path.len() == 1 => "a table `[study]`",
        _ => return None,
    })
}

/// What belongs to a list of the study, or to one of its entries.
fn describe_study(path: &[String]) -> Option<&'static str> {
    let (table, rest) = path.split_first()?;
    let (list, entry) = rest.split_first()?;
    if table != "study" {
        return None;
    }
    Some(match (list.as_str(), entry.is_empty()) {
        ("degree", true) => "a list of degrees, such as `[1, 2, 4]`",
        ("degree", false) => "a whole number, the polynomial degree, from 1 to 8",
        ("elements", true) => "a list of numbers of elements, such as `[10, 20, 40]`",
        ("elements", false) => "a whole number of elements, at least 1",
        ("interpolation", true) => "a list of interpolations, such as `[\"r12\", \"se3\"]`",
        ("increments", true) => "a list of numbers of increments, such as `[\"automatic\", 100]`",
        ("increments", false) => "a whole number of increments, at least 1, or \"automatic\"",
        ("time_step", true) => "a list of time steps [s], such as `[1e-3, 5e-4]`",
        ("time_step", false) => "a positive time step [s]",
        ("tolerance", true) => "a list of tolerances, such as `[\"default\", 1e-8]`",
        ("tolerance", false) => "a positive number [N, N m], or \"default\"",
        ("accuracies", true) => "a list of accuracies, such as `[1e-2, 1e-4]`",
        ("accuracies", false) => "a positive number, relative to the rods' length and in radians",
        _ => return None,
    })
}
