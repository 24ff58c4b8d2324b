//! Reference data: that what is stored is what was described, and that what was not is refused.

use std::collections::BTreeSet;
use std::error::Error;
use std::fs;
use std::path::Path;

use super::{SOURCE, is};
use crate::case::{Case, Checks, Kind, Outcome};
use crate::references::{Package, Resource, Table, hash, package, root};

pub fn all() -> Vec<Case> {
    vec![
        Case::new("harness::stale_files_fail", SOURCE, stale_files_fail),
        Case::new("provenance::hashes", SOURCE, hashes),
        Case::new("provenance::descriptions", SOURCE, descriptions),
        Case::new("provenance::scripts", SOURCE, scripts),
        Case::new("provenance::used", SOURCE, used),
    ]
}

/// Every source, `references/<source>/`.
fn packages() -> Result<Vec<Package>, Box<dyn Error>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(root())? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    names.sort();
    names.iter().map(|name| package(&root(), name)).collect()
}

fn files(packages: &[Package]) -> impl Iterator<Item = (String, &Resource)> {
    packages.iter().flat_map(|package| {
        package.resources.iter().map(|resource| (format!("{}/{}", package.name, resource.path), resource))
    })
}

fn hashes(checks: &mut Checks) -> Outcome {
    let packages = packages()?;
    let mut described = BTreeSet::new();
    for (name, resource) in files(&packages) {
        let content = fs::read(root().join(&name)).map_err(|error| format!("{name}: {error}"))?;
        is(checks, format!("hash of {name}"), hash(&content) == resource.hash);
        is(checks, format!("size of {name}"), content.len() as u64 == resource.bytes);
        Table::read(&root(), &name)?;
        described.insert(name);
    }
    for package in &packages {
        for entry in fs::read_dir(root().join(&package.name))? {
            let file = entry?.file_name().to_string_lossy().into_owned();
            let name = format!("{}/{file}", package.name);
            is(
                checks,
                format!("{name} is described"),
                file == "datapackage.json" || described.contains(&name),
            );
        }
    }
    Ok(())
}

fn descriptions(checks: &mut Checks) -> Outcome {
    for (name, resource) in files(&packages()?) {
        let said = [&resource.title, &resource.accuracy, &resource.accuracy_method];
        is(checks, format!("{name}: title and accuracy"), said.iter().all(|text| !text.trim().is_empty()));
        is(checks, format!("{name}: licence"), !resource.licenses.is_empty());
        let fields = &resource.schema.fields;
        let bare = fields.iter().find(|field| {
            let number = field.kind == "number" || field.kind == "integer";
            field.description.trim().is_empty() || (number && field.unit.trim().is_empty())
        });
        let bare = bare.map_or(String::new(), |field| format!(" ({} lacks one)", field.name));
        is(checks, format!("{name}: every column has a description and a unit{bare}"), bare.is_empty());
        let kinds = ["number", "integer", "string"];
        is(checks, format!("{name}: types"), fields.iter().all(|field| kinds.contains(&field.kind.as_str())));
        // A column of numbers must be one: also what no case reads.
        let table = Table::read(&root(), &name)?;
        for row in table.rows() {
            for field in fields.iter().filter(|field| field.kind != "string") {
                row.number(&field.name)?;
            }
        }
    }
    Ok(())
}

fn scripts(checks: &mut Checks) -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pinned = fs::read_to_string(folder.join("scripts/references/requirements.txt"))?;
    let packages = packages()?;
    let mut busy = BTreeSet::new();
    for (name, resource) in files(&packages) {
        let Resource { script, tools, .. } = resource;
        is(checks, format!("{name}: {script} exists"), folder.join(script).is_file());
        busy.insert(script.as_str());
        for (tool, version) in tools.iter().filter(|(tool, _)| *tool != "python") {
            let wanted = format!("{tool}=={version}");
            is(
                checks,
                format!("{name}: {wanted} is what the scripts install"),
                pinned.lines().any(|line| line == wanted),
            );
        }
    }
    for entry in fs::read_dir(folder.join("scripts/references"))? {
        let file = entry?.file_name().to_string_lossy().into_owned();
        let script = format!("scripts/references/{file}");
        if file.ends_with(".py") && !HELPERS.contains(&file.as_str()) {
            is(checks, format!("{script} makes a file"), busy.contains(script.as_str()));
        }
    }
    Ok(())
}

/// Modules that the scripts share.
const HELPERS: [&str; 2] = ["datapackage.py", "rod_equations.py"];

fn used(checks: &mut Checks) -> Outcome {
    let cases = crate::cases::all();
    let read: BTreeSet<&str> = cases.iter().flat_map(|case| case.reads).copied().collect();
    for (name, _) in files(&packages()?) {
        is(checks, format!("a case reads {name}"), read.contains(name.as_str()));
    }
    Ok(())
}

const DESCRIPTOR: &str = r#"{ "name": "made_up", "title": "", "resources": [ {
    "name": "values", "path": "values.csv", "title": "Two numbers", "bytes": 8, "hash": "HASH",
    "licenses": [ { "name": "CC0-1.0" } ], "script": "none", "parameters": {}, "tools": {},
    "accuracy": "exact", "accuracyMethod": "made up",
    "schema": { "fields": [ { "name": "x", "type": "number", "unit": "m", "description": "made up" },
                            { "name": "y", "type": "number", "unit": "m", "description": "made up" } ] } } ] }"#;

/// A folder with one described file; the content may be another than was described.
fn stored(described: &str, content: &str) -> Result<tempfile::TempDir, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let source = folder.path().join("made_up");
    fs::create_dir(&source)?;
    fs::write(source.join("datapackage.json"), DESCRIPTOR.replace("HASH", &hash(described.as_bytes())))?;
    fs::write(source.join("values.csv"), content)?;
    fs::write(source.join("other.csv"), content)?;
    Ok(folder)
}

fn stale_files_fail(checks: &mut Checks) -> Outcome {
    let good = "x,y\n1,2\n";
    let read = |described: &str, content: &str, name: &str| -> Result<Table, Box<dyn Error>> {
        Table::read(stored(described, content)?.path(), name)
    };
    let table = read(good, good, "made_up/values.csv")?;
    let row = table.rows().next().ok_or("a table without rows")?;
    let numbers = row.numbers::<2>("x y")?;
    checks.absolute(Kind::Invariant, "x of a good file", (numbers[0], 1.0), 0.0, "it is stored exactly");
    checks.absolute(Kind::Invariant, "y of a good file", (numbers[1], 2.0), 0.0, "it is stored exactly");
    is(checks, "a column that is not there is refused", row.number("z").is_err());
    let refused = |result: Result<Table, Box<dyn Error>>, word: &str| {
        result.err().is_some_and(|error| error.to_string().contains(word))
    };
    is(checks, "one digit changed: stale", refused(read(good, "x,y\n1,3\n", "made_up/values.csv"), "stale"));
    is(checks, "one line more: stale", refused(read(good, "x,y\n1,2\n3,4\n", "made_up/values.csv"), "stale"));
    let other = "x,z\n1,2\n";
    is(checks, "other columns than described", refused(read(other, other, "made_up/values.csv"), "columns"));
    is(
        checks,
        "a file that is not described",
        refused(read(good, good, "made_up/other.csv"), "not described"),
    );
    is(checks, "a source that is not there", read(good, good, "nowhere/values.csv").is_err());
    for word in ["NaN", "inf", "", "one"] {
        let content = format!("x,y\n{word},2\n");
        let table = read(&content, &content, "made_up/values.csv")?;
        let row = table.rows().next().ok_or("a table without rows")?;
        is(checks, format!("\"{word}\" is no number"), row.number("x").is_err());
    }
    let keyed = "x,y\na,1\nb,2\nb,3\n";
    let table = read(keyed, keyed, "made_up/values.csv")?;
    is(checks, "one row of that name", table.row(&[("x", "a")])?.number("y")? == 1.0);
    is(checks, "two rows of that name are refused", table.row(&[("x", "b")]).is_err());
    is(checks, "no row of that name is refused", table.row(&[("x", "c")]).is_err());
    is(
        checks,
        "a file that the case does not declare is refused",
        Checks::default().reference("made_up/values.csv").is_err(),
    );
    Ok(())
}
