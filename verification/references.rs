//! Reference data from outside, `references/<source>/<name>.csv`, and where it comes from: the Frictionless descriptor
//! beside it. A file that was changed since it was described is not read.

use std::collections::HashMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use sha2::{Digest, Sha256};

/// The entry of one file in `datapackage.json`.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Resource {
    pub path: String,
    pub title: String,
    pub bytes: u64,
    pub hash: String,
    pub licenses: Vec<Licence>,
    /// Publications.
    #[serde(default)]
    pub sources: Vec<Publication>,
    /// What made the file, relative to the root of the repository.
    pub script: String,
    pub parameters: HashMap<String, serde_json::Value>,
    /// Names and versions.
    pub tools: HashMap<String, String>,
    pub accuracy: String,
    pub accuracy_method: String,
    pub schema: Schema,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Licence {
    pub name: String,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Publication {
    pub title: String,
    pub table: String,
    pub page: String,
    pub grade: String,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Schema {
    pub fields: Vec<Field>,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Field {
    pub name: String,
    #[serde(rename = "type")]
    pub kind: String,
    pub unit: String,
    pub description: String,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Package {
    pub name: String,
    pub resources: Vec<Resource>,
}

/// The folder of all references.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("references")
}

/// The descriptor of one source.
pub fn package(root: &Path, source: &str) -> Result<Package, Box<dyn Error>> {
    let path = root.join(source).join("datapackage.json");
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?)
}

/// A file of numbers and words, with its description.
#[derive(Clone, Debug)]
pub struct Table {
    pub resource: Resource,
    name: String,
    columns: HashMap<String, usize>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Reads `source/name.csv` under `root`.
    ///
    /// # Errors
    /// The file is missing, not described, or not what was described: other bytes, other columns.
    pub fn read(root: &Path, name: &str) -> Result<Self, Box<dyn Error>> {
        let (source, file) =
            name.split_once('/').ok_or_else(|| format!("{name}: expected source/name.csv"))?;
        let package = package(root, source)?;
        let resource = package.resources.into_iter().find(|resource| resource.path == file);
        let resource = resource.ok_or_else(|| format!("{name} is not described in its datapackage.json"))?;
        let content = fs::read(root.join(name)).map_err(|error| format!("{name}: {error}"))?;
        let hash = hash(&content);
        if hash != resource.hash {
            let described = &resource.hash;
            return Err(format!("{name} is stale: its hash is {hash}, described is {described}").into());
        }
        let mut reader = csv::Reader::from_reader(content.as_slice());
        let header: Vec<String> = reader.headers()?.iter().map(str::to_string).collect();
        let described: Vec<&str> = resource.schema.fields.iter().map(|field| field.name.as_str()).collect();
        if header != described {
            return Err(format!("{name}: columns {header:?}, described {described:?}").into());
        }
        let columns = header.into_iter().enumerate().map(|(index, column)| (column, index)).collect();
        let rows = reader
            .into_records()
            .map(|record| Ok(record?.iter().map(str::to_string).collect()))
            .collect::<Result<_, csv::Error>>()?;
        Ok(Self { resource, name: name.to_string(), columns, rows })
    }

    /// Its rows, in order.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = Row<'_>> {
        (0..self.rows.len()).map(|index| Row { table: self, index })
    }

    /// The one row with these words in these columns.
    ///
    /// # Errors
    /// There is none, or more than one.
    pub fn row(&self, keys: &[(&str, &str)]) -> Result<Row<'_>, Box<dyn Error>> {
        let mut found = self.select(keys)?.into_iter();
        match (found.next(), found.next()) {
            (Some(row), None) => Ok(row),
            (first, _) => {
                let count = if first.is_some() { "several rows" } else { "no row" };
                Err(format!("{}: {count} with {keys:?}", self.name).into())
            }
        }
    }

    /// The rows with these words in these columns.
    pub fn select(&self, keys: &[(&str, &str)]) -> Result<Vec<Row<'_>>, Box<dyn Error>> {
        let mut found = Vec::new();
        for row in self.rows() {
            let mut all = true;
            for &(column, word) in keys {
                all &= row.word(column)? == word;
            }
            if all {
                found.push(row);
            }
        }
        Ok(found)
    }
}

/// One row of a table.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    table: &'a Table,
    index: usize,
}

impl<'a> Row<'a> {
    /// An entry as it is written.
    pub fn word(&self, column: &str) -> Result<&'a str, Box<dyn Error>> {
        let place = self.table.columns.get(column);
        let place = *place.ok_or_else(|| format!("{} has no column {column}", self.table.name))?;
        Ok(&self.table.rows[self.index][place])
    }

    /// A finite number.
    pub fn number(&self, column: &str) -> Result<f64, Box<dyn Error>> {
        let word = self.word(column)?;
        let value: Option<f64> = word.parse().ok().filter(|value: &f64| value.is_finite());
        let Self { table, index } = self;
        Ok(value
            .ok_or_else(|| format!("{}, row {}, {column}: {word} is no number", table.name, index + 1))?)
    }

    /// Several numbers, their columns separated by blanks: `row.numbers("x y z")`.
    pub fn numbers<const N: usize>(&self, columns: &str) -> Result<[f64; N], Box<dyn Error>> {
        let values: Vec<f64> =
            columns.split_whitespace().map(|column| self.number(column)).collect::<Result<_, _>>()?;
        let count = values.len();
        Ok(values.try_into().map_err(|_| format!("{columns}: {count} columns, expected {N}"))?)
    }
}

/// As in a descriptor.
pub fn hash(content: &[u8]) -> String {
    let digest = Sha256::digest(content);
    digest.iter().fold("sha256:".to_string(), |text, byte| format!("{text}{byte:02x}"))
}
