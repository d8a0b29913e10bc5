//! A path of targets as CSV: a header that names quantities with their units, and one row a target.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use hydrostat::Target;

use crate::error::shortened;

/// The most that is read, in bytes.
const MOST: u64 = 64 << 20;

/// Names of columns, their unit in SI, and what they are.
const COLUMNS: [(&str, f64, Kind); 8] = [
    ("x_m", 1.0, Kind::X),
    ("x_cm", 1e-2, Kind::X),
    ("x_mm", 1e-3, Kind::X),
    ("y_m", 1.0, Kind::Y),
    ("y_cm", 1e-2, Kind::Y),
    ("y_mm", 1e-3, Kind::Y),
    ("angle_rad", 1.0, Kind::Angle),
    ("angle_deg", std::f64::consts::PI / 180.0, Kind::Angle),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    X,
    Y,
    Angle,
}

/// What is wrong with a file of targets, and where.
#[derive(Debug, thiserror::Error)]
pub enum TargetsError {
    /// It could not be read, or is no text.
    #[error("{path}: cannot be read: {source}")]
    Read {
        /// The file.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// More than a path needs.
    #[error("{path}: expected at most {MOST} bytes, found more")]
    TooLarge {
        /// The file.
        path: String,
    },
    /// A header that lacks a quantity, names one twice or has one that is unknown.
    #[error(
        "{path}:{line}: expected a header with x_m and y_m (or x_mm, y_mm), and angle_deg if it matters, found {found}"
    )]
    Header {
        /// The file.
        path: String,
        /// Its line, from 1.
        line: usize,
        /// What is wrong with it.
        found: String,
    },
    /// A row with more or fewer cells than the header.
    #[error("{path}:{line}: expected {expected} cells as in the header, found {found}")]
    Ragged {
        /// The file.
        path: String,
        /// Its line, from 1.
        line: usize,
        /// Cells of the header.
        expected: usize,
        /// Cells of the row.
        found: usize,
    },
    /// A cell that is no finite number.
    #[error("{path}:{line}: {column}: expected a finite number, found \"{found}\"")]
    Value {
        /// The file.
        path: String,
        /// Its line, from 1.
        line: usize,
        /// The column's name.
        column: String,
        /// What stands there.
        found: String,
    },
    /// A file without rows.
    #[error("{path}: expected at least one target below the header, found none")]
    Empty {
        /// The file.
        path: String,
    },
}

/// Targets of the place `s` (m along the arm, none for the tip), in the order of the rows of a file. Empty lines and what
/// follows a `#` are left out.
///
/// # Errors
/// [`TargetsError`].
pub fn read_targets(path: impl AsRef<Path>, s: Option<f64>) -> Result<Vec<Target>, TargetsError> {
    let name = path.as_ref().display().to_string();
    let read = |source| TargetsError::Read { path: name.clone(), source };
    let mut text = String::new();
    File::open(path.as_ref()).and_then(|file| file.take(MOST + 1).read_to_string(&mut text)).map_err(read)?;
    if text.len() as u64 > MOST {
        return Err(TargetsError::TooLarge { path: name });
    }
    parse_targets(&text, &name, s)
}

/// [`read_targets`] of text that came from `path`, which messages name.
///
/// # Errors
/// [`TargetsError`].
///
/// ```
/// let text = "x_mm,y_mm,angle_deg\n180,70,30\n181,71,31\n";
/// let targets = hydrostat_files::parse_targets(text, "path.csv", None).unwrap();
/// assert!(targets.len() == 2 && (targets[1].y - 0.071).abs() < 1e-15);
///
/// let error = hydrostat_files::parse_targets("x_m,y_m\n0.1,here\n", "path.csv", None).unwrap_err();
/// assert_eq!(error.to_string(), "path.csv:2: y_m: expected a finite number, found \"here\"");
/// ```
pub fn parse_targets(text: &str, path: &str, s: Option<f64>) -> Result<Vec<Target>, TargetsError> {
    let path = path.to_owned();
    let mut columns: Option<Vec<(&str, f64, Kind)>> = None;
    let mut out = Vec::new();
    for (index, row) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = index + 1;
        let row = row.split('#').next().unwrap_or_default();
        if row.trim().is_empty() {
            continue;
        }
        let cells: Vec<&str> = row.split(',').map(|cell| cell.trim().trim_matches('"').trim()).collect();
        let Some(columns) = &columns else {
            columns = Some(header(&cells).map_err(|found| TargetsError::Header { path: path.clone(), line, found })?);
            continue;
        };
        if cells.len() != columns.len() {
            return Err(TargetsError::Ragged { path, line, expected: columns.len(), found: cells.len() });
        }
        let mut target = Target { s, ..Target::tip(0.0, 0.0) };
        for (cell, (column, unit, kind)) in cells.iter().zip(columns) {
            let Some(value) = cell.parse().ok().filter(|value: &f64| value.is_finite()) else {
                return Err(TargetsError::Value { path, line, column: (*column).to_owned(), found: shortened(cell) });
            };
            match kind {
                Kind::X => target.x = value * unit,
                Kind::Y => target.y = value * unit,
                Kind::Angle => target.angle = Some(value * unit),
            }
        }
        out.push(target);
    }
    match columns {
        None => Err(TargetsError::Header { path, line: 1, found: "nothing".to_owned() }),
        Some(_) if out.is_empty() => Err(TargetsError::Empty { path }),
        Some(_) => Ok(out),
    }
}

/// What the columns are, or what is wrong with them.
fn header(cells: &[&str]) -> Result<Vec<(&'static str, f64, Kind)>, String> {
    let mut out: Vec<(&'static str, f64, Kind)> = Vec::new();
    for cell in cells {
        let Some(known) = COLUMNS.into_iter().find(|(name, ..)| name == cell) else {
            return Err(format!("the column \"{}\"", shortened(cell)));
        };
        if let Some((other, ..)) = out.iter().find(|(.., kind)| *kind == known.2) {
            return Err(format!("{other} and {cell}"));
        }
        out.push(known);
    }
    match [("x", Kind::X), ("y", Kind::Y)].into_iter().find(|(_, kind)| !out.iter().any(|(.., own)| own == kind)) {
        Some((name, _)) => Err(format!("no {name}")),
        None => Ok(out),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        for (text, words) in [
            (
                "",
                "t.csv:1: expected a header with x_m and y_m (or x_mm, y_mm), and angle_deg if it matters, found nothing",
            ),
            ("x_m,z_m\n", "found the column \"z_m\""),
            ("x_m\n1\n", "found no y"),
            ("x_m,y_m,x_mm\n", "found x_m and x_mm"),
            ("x_m,y_m\n\n# none\n", "t.csv: expected at least one target"),
            ("# units in the header\nx_m,y_m\n1,2\n1,2,3\n", "t.csv:4: expected 2 cells as in the header, found 3"),
            ("x_m,y_m\n1,inf\n", "t.csv:2: y_m: expected a finite number, found \"inf\""),
            (
                format!("x_m,y_m\n1,{}\n", "9".repeat(9000)).as_str(),
                format!("t.csv:2: y_m: expected a finite number, found \"{}...\"", "9".repeat(60)).as_str(),
            ),
            ("x_m,y_m\n,1\n", "t.csv:2: x_m: expected a finite number, found \"\""),
        ] {
            let error = parse_targets(text, "t.csv", None).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
