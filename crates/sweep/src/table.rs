//! The result of a sweep, read back.

use std::path::Path;

use hydrostat_files::Axis;
use serde::Deserialize;

use crate::column::{Column, Data, ROW};
use crate::csv_file;
use crate::error::{SweepError, read_error};
use crate::parquet_file::Reader;
use crate::run::{Format, noted};

/// A key that a sweep varied.
#[derive(Debug, Clone, PartialEq)]
pub struct VariedKey {
    /// The name of its column.
    pub column: String,
    /// For people: the key, or where that is not noted, the column.
    pub name: String,
    /// The unit in which it is shown; empty where there is none.
    pub unit: String,
    /// How many of that unit an SI unit is.
    pub per_si: f64,
}

/// Some columns of a sweep's output.
#[derive(Debug, Clone)]
pub struct Table {
    columns: Vec<Column>,
}

#[derive(Deserialize)]
struct Noted {
    vary: Vec<NotedKey>,
}

#[derive(Deserialize)]
struct NotedKey {
    key: String,
    column: String,
    unit: String,
    per_si: f64,
}

/// The first column that is no key, of any sweep.
const OUTPUTS: [&str; 9] = [
    "tip_x_m",
    "tip_alpha_rad",
    "stroke[0]_m",
    "tension[0]_N",
    "base_force_x_N",
    "fold_margin",
    "stability",
    "error_estimate_m",
    "verdict",
];

impl Table {
    /// Reads columns by their names, as far as they are there.
    ///
    /// # Errors
    /// [`SweepError::Read`].
    pub fn read(path: &Path, wanted: &[&str]) -> Result<Self, SweepError> {
        let names = names(path)?;
        let present: Vec<usize> = (0..names.len()).filter(|k| wanted.contains(&names[*k].as_str())).collect();
        let columns = if Format::of(path) == Some(Format::Csv) {
            csv_file::columns(path, &present)?
        } else {
            let reader = Reader::open(path)?;
            let read = |k: &usize| reader.column(&names[*k]).transpose();
            present.iter().filter_map(read).collect::<Result<_, _>>()?
        };
        Ok(Self { columns })
    }

    /// All columns read.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn column(&self, name: &str) -> Option<&Data> {
        self.columns.iter().find(|column| column.name == name).map(|column| &column.data)
    }

    /// A column of numbers, NaN where there is none; `None` where the column is not there or is of words.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        match self.column(name)? {
            Data::Number(values) => Some(values.clone()),
            Data::Whole(values) => Some(values.iter().map(|v| v.map_or(f64::NAN, |v| v as f64)).collect()),
            Data::Text(_) => None,
        }
    }

    /// A column of words; `None` where the column is not there.
    pub fn words(&self, name: &str) -> Option<Vec<Option<String>>> {
        match self.column(name)? {
            Data::Text(values) => Some(values.clone()),
            // CSV does not tell a column without words from one without numbers.
            other => Some(vec![None; other.len()]),
        }
    }
}

/// The names of all columns of a sweep's output.
///
/// # Errors
/// [`SweepError::Read`], also when it is none.
pub fn names(path: &Path) -> Result<Vec<String>, SweepError> {
    let names =
        if Format::of(path) == Some(Format::Csv) { csv_file::names(path)? } else { Reader::open(path)?.names() };
    if names.first().map(String::as_str) != Some(ROW) {
        return Err(read_error(path, "expected the output of a sweep, whose first column is `row`"));
    }
    Ok(names)
}

/// The keys that a sweep varied, in their order, from its output.
///
/// # Errors
/// [`SweepError::Read`].
pub fn varied_keys(path: &Path) -> Result<Vec<VariedKey>, SweepError> {
    let names = names(path)?;
    if let Some(note) = noted(path, Format::of(path).unwrap_or(Format::Parquet))? {
        let noted: Noted = serde_json::from_str(&note).map_err(|error| read_error(path, error))?;
        let key = |NotedKey { key, column, unit, per_si }| VariedKey { column, name: key, unit, per_si };
        return Ok(noted.vary.into_iter().map(key).collect());
    }
    let keys = names.into_iter().skip(1).take_while(|name| !OUTPUTS.contains(&name.as_str()));
    Ok(keys.map(key_of).collect())
}

/// The key whose column has this name, by the unit at its end.
fn key_of(column: String) -> VariedKey {
    let ends = column.match_indices('_').map(|(at, _)| at).chain([column.len()]);
    let axes = ends.filter_map(|end| format!("{}=0", &column[..end]).parse::<Axis>().ok());
    match axes.into_iter().find(|axis| axis.column() == column) {
        Some(axis) => VariedKey { unit: axis.unit.to_owned(), per_si: axis.per_si(), name: axis.key, column },
        None => VariedKey { name: column.clone(), column, unit: String::new(), per_si: 1.0 },
    }
}
