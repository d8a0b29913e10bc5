//! The result of a sweep, read back.

use std::path::Path;

use hydrostat_files::{Axis, head_now, key_of_head};
use serde::Deserialize;

use crate::column::{Column, Data, ROW};
use crate::csv_file;
use crate::error::{SweepError, read_error};
use crate::file_format::{Format, noted};
use crate::parquet_file::Reader;

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
const OUTPUTS: [&str; 10] = [
    "tip_x_m",
    "tip_alpha_rad",
    "stroke_0_m",
    "tension_0_N",
    "base_force_x_N",
    "fold_margin",
    "stability",
    "error_estimate_m",
    "warnings",
    "verdict",
];

impl Table {
    /// Reads columns by their names, as far as they are there. Outputs of earlier versions had other names (`stroke[0]_m`): their columns
    /// have the names of now.
    ///
    /// # Errors
    /// [`SweepError::Read`].
    pub fn read(path: &Path, wanted: &[&str]) -> Result<Self, SweepError> {
        let names = own_names(path)?;
        let present: Vec<usize> =
            (0..names.len()).filter(|k| wanted.iter().any(|name| head_now(name) == head_now(&names[*k]))).collect();
        let mut columns = if Format::of(path) == Some(Format::Csv) {
            csv_file::columns(path, &present)?
        } else {
            let reader = Reader::open(path)?;
            let read = |k: &usize| reader.column(&names[*k]).transpose();
            present.iter().filter_map(read).collect::<Result<_, _>>()?
        };
        for column in &mut columns {
            column.name = head_now(&column.name);
        }
        Ok(Self { columns })
    }

    /// All columns read.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn column(&self, name: &str) -> Option<&Data> {
        self.columns.iter().find(|column| column.name == head_now(name)).map(|column| &column.data)
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

/// The names of all columns of a sweep's output, as they are written now.
///
/// # Errors
/// [`SweepError::Read`], also when it is none.
pub fn names(path: &Path) -> Result<Vec<String>, SweepError> {
    Ok(own_names(path)?.iter().map(|name| head_now(name)).collect())
}

/// The names as they stand in the file.
fn own_names(path: &Path) -> Result<Vec<String>, SweepError> {
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
        let key =
            |NotedKey { key, column, unit, per_si }| VariedKey { column: head_now(&column), name: key, unit, per_si };
        return Ok(noted.vary.into_iter().map(key).collect());
    }
    let keys = names.into_iter().skip(1).take_while(|name| !OUTPUTS.contains(&name.as_str()));
    Ok(keys.map(key_of).collect())
}

/// The key whose column has this name, by the unit at its end.
fn key_of(column: String) -> VariedKey {
    let key = key_of_head(&column).map(|(key, _)| key);
    match key.and_then(|key| format!("{key}=0").parse::<Axis>().ok()) {
        Some(axis) => VariedKey { unit: axis.unit.to_owned(), per_si: axis.per_si(), name: axis.key, column },
        None => VariedKey { name: column.clone(), column, unit: String::new(), per_si: 1.0 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Outputs of before heads became identifiers, with what stands beside them and without.
    #[test]
    fn outputs_of_old_versions_are_read() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("old.csv");
        let text = "row,flow.speed_m_per_s,model.volume,cable[0].tension_N,tip_x_m,stroke[0]_m,verdict\n\
                    0,0.5,planar,1.0,0.2,0.01,\n1,0.6,none,2.0,,,limit_point\n";
        std::fs::write(&path, text).unwrap();
        let want = ["row", "flow_speed_m_s", "model_volume", "cable_0_tension_N", "tip_x_m", "stroke_0_m", "verdict"];
        assert_eq!(names(&path).unwrap(), want);
        let keys = |path: &Path| -> Vec<(String, String, String)> {
            let keys = varied_keys(path).unwrap();
            keys.into_iter().map(|key| (key.name, key.column, key.unit)).collect()
        };
        let key = |name: &str, column: &str, unit: &str| (name.to_owned(), column.to_owned(), unit.to_owned());
        let guessed = [
            key("flow.speed", "flow_speed_m_s", "m/s"),
            key("model.volume", "model_volume", ""),
            key("cable[0].tension", "cable_0_tension_N", "N"),
        ];
        assert_eq!(keys(&path), guessed);
        for name in ["stroke[0]_m", "stroke_0_m"] {
            let strokes = Table::read(&path, &[name]).unwrap().numbers(name).unwrap();
            assert!(strokes[0] == 0.01 && strokes[1].is_nan());
        }
        let note =
            r#"{"vary": [{"key": "flow.speed", "column": "flow.speed_m_per_s", "unit": "cm/s", "per_si": 100.0}]}"#;
        std::fs::write(csv_file::beside(&path), note).unwrap();
        assert_eq!(keys(&path), [key("flow.speed", "flow_speed_m_s", "cm/s")]);
    }
}
