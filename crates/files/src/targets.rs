//! A path of targets as CSV: a header that names quantities with their units, and one row a target.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use csv::StringRecord;
use hydrostat::Target;

use crate::csv_text::{Dialect, Lines, is_missing, without_mark};
use crate::error::shortened;
use crate::heads::{readings, unit_of};
use crate::quantity::Dimension;
use crate::results::{INNER, PLACE, THETA};

/// The most that is read, in bytes.
const MOST: u64 = 64 << 20;

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

/// Targets of the place `s` (m along the arm, none for the tip), in the order of the rows of a file. Empty lines, what follows a `#`, and of
/// a table of stations all but x and y are left out. An angle that is empty, `NaN` or `NA` does not matter.
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
    let text = without_comments(without_mark(text));
    let dialect = Dialect::of(&text);
    let mut reader = dialect.reader().from_reader(text.as_bytes());
    let mut lines = Lines::new(&text);
    let mut columns: Option<Vec<TargetColumn>> = None;
    let mut out = Vec::new();
    for record in reader.records() {
        // The text is in memory and is UTF-8.
        let Ok(record) = record else { continue };
        let line = record.position().map_or(0, |position| lines.of(position.byte()));
        // Spreadsheets leave empty rows as wide as the table; a wider one is a slip.
        let fits = columns.as_ref().is_none_or(|columns| record.len() <= columns.len());
        if fits && record.iter().all(str::is_empty) {
            continue;
        }
        let Some(columns) = &columns else {
            columns =
                Some(header(&record).map_err(|found| TargetsError::Header { path: path.clone(), line, found })?);
            continue;
        };
        if record.len() != columns.len() {
            return Err(TargetsError::Ragged { path, line, expected: columns.len(), found: record.len() });
        }
        let mut target = Target { s, ..Target::tip(0.0, 0.0) };
        for (cell, column) in record.iter().zip(columns) {
            let Some((kind, dimension, unit)) = column.quantity else { continue };
            if kind == Kind::Angle && is_missing(cell) {
                continue;
            }
            // From the decimal text, so that 0.1 mm is 1e-4 to the last bit.
            let number =
                dialect.number(cell).and_then(|_| dimension.parse(&format!("{} {unit}", dialect.plain(cell))).ok());
            let Some(value) = number else {
                let column = column.head.clone();
                return Err(TargetsError::Value { path, line, column, found: shortened(cell) });
            };
            match kind {
                Kind::X => target.x = value,
                Kind::Y => target.y = value,
                Kind::Angle => target.angle = Some(value),
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

/// A text without what follows a # in its lines.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        match line.split_once('#') {
            Some((kept, comment)) => out.extend([kept, if comment.ends_with('\n') { "\n" } else { "" }]),
            None => out.push_str(line),
        }
    }
    out
}

/// A column and what it has of a target, in which unit.
struct TargetColumn {
    head: String,
    quantity: Option<(Kind, Dimension, &'static str)>,
}

/// What the columns are, or what is wrong with them. Those of a table of stations beside x and y do not count.
fn header(record: &StringRecord) -> Result<Vec<TargetColumn>, String> {
    let mut out: Vec<TargetColumn> = Vec::new();
    for head in record {
        let quantity = quantity(head);
        if quantity.is_none() && !(INNER.contains(&head) || head == THETA || head == PLACE) {
            return Err(format!("the column \"{}\"", shortened(head)));
        }
        let same = |other: &&TargetColumn| {
            quantity.is_some() && other.quantity.map(|(kind, ..)| kind) == quantity.map(|(kind, ..)| kind)
        };
        if let Some(other) = out.iter().find(same) {
            return Err(format!("{} and {head}", other.head));
        }
        out.push(TargetColumn { head: head.to_owned(), quantity });
    }
    let has = |kind: Kind| out.iter().any(|column| column.quantity.is_some_and(|(own, ..)| own == kind));
    match [("x", Kind::X), ("y", Kind::Y)].into_iter().find(|(_, kind)| !has(*kind)) {
        Some((name, _)) => Err(format!("no {name}")),
        None => Ok(out),
    }
}

/// The units of targets.
const UNITS: [&str; 5] = ["m", "cm", "mm", "rad", "deg"];

/// What a head names, as `x_mm` or as `x [mm]`.
fn quantity(head: &str) -> Option<(Kind, Dimension, &'static str)> {
    readings(head).into_iter().find_map(|(name, unit)| {
        let (kind, dimension) = match name.to_lowercase().as_str() {
            "x" | "target_x" => (Kind::X, Dimension::Length),
            "y" | "target_y" => (Kind::Y, Dimension::Length),
            "angle" | "target_angle" => (Kind::Angle, Dimension::Angle),
            _ => return None,
        };
        let unit = unit_of(dimension, unit).filter(|unit| UNITS.contains(unit))?;
        Some((kind, dimension, unit))
    })
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
            ("x [mm];y [N]\n1;2\n", "found the column \"y [N]\""),
            ("x_m,y_m,target_x_m\n", "found x_m and target_x_m"),
        ] {
            let error = parse_targets(text, "t.csv", None).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn tables_of_spreadsheets_and_of_stations_are_read() {
        let read = |text: &str| -> Vec<(f64, f64, Option<f64>)> {
            parse_targets(text, "t.csv", None).unwrap().iter().map(|t| (t.x, t.y, t.angle)).collect()
        };
        let want = [(0.1805, 0.07, None), (0.181, -0.071, Some(90_f64.to_radians()))];
        for text in [
            "\u{feff}x [mm];y [mm];angle [deg]\r\n180,5;70;\r\n181;-71;90\r\n",
            "x_mm\ty_mm\tangle_deg\n180.5\t70\tNaN\n\n181\t-71\t90\n",
            "# targets\n\"x_cm\",Y_cm,angle_deg # with an angle, or not\n18.05,7,NA\n18.1,-7.1,90\n",
        ] {
            assert_eq!(read(text), want, "{text}");
        }
        let stations =
            "s_m,x_m,y_m,theta_rad,nu,eta,mu_per_m,beta,alpha_rad,n_a_N,n_b_N,m_Nm\n0.1,0.09,0.01,0.2,,,,,,,,\n";
        assert_eq!(read(stations), [(0.09, 0.01, None)]);
    }
}
