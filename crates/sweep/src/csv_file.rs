//! Columns as CSV: a header and a line a row.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::column::{Column, Data};
use crate::error::{SweepError, read_error, write_error};

/// The lines of a part, without header.
pub(crate) fn part(columns: &[Column]) -> Vec<u8> {
    let rows = columns.first().map_or(0, |column| column.data.len());
    let mut out = String::new();
    for row in 0..rows {
        for (k, column) in columns.iter().enumerate() {
            if k > 0 {
                out.push(',');
            }
            match &column.data {
                Data::Whole(values) => out.extend(values[row].map(|value| value.to_string())),
                Data::Number(values) if values[row].is_nan() => {}
                Data::Number(values) => {
                    // Writing into a text does not fail.
                    let _ = write!(out, "{:?}", values[row]);
                }
                Data::Text(values) => out.extend(values[row].as_deref().map(quoted)),
            }
        }
        out.push('\n');
    }
    out.into_bytes()
}

/// A text as one cell.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// The names of columns as a line.
pub(crate) fn header(columns: &[Column]) -> String {
    let names: Vec<String> = columns.iter().map(|column| quoted(&column.name)).collect();
    names.join(",") + "\n"
}

/// Writes header and parts to `out`.
pub(crate) fn join(parts: &[PathBuf], columns: &[Column], path: &Path, out: impl Write) -> Result<(), SweepError> {
    let failed = |error| write_error(path, error);
    let mut out = BufWriter::new(out);
    out.write_all(header(columns).as_bytes()).map_err(failed)?;
    for part in parts {
        let mut file = File::open(part).map_err(|error| read_error(part, error))?;
        io::copy(&mut file, &mut out).map_err(failed)?;
    }
    out.flush().map_err(failed)
}

/// Where stands what the CSV file `path` is of: readers of CSV know no other place for it.
pub fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".json");
    path.with_file_name(name)
}

/// What is noted about the file; `None` where nothing is.
pub(crate) fn note(path: &Path) -> Result<Option<String>, SweepError> {
    let beside = beside(path);
    match fs::read_to_string(&beside) {
        Ok(note) => Ok(Some(note)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(read_error(&beside, error)),
    }
}

/// The names of the columns of a file.
pub(crate) fn names(path: &Path) -> Result<Vec<String>, SweepError> {
    let file = File::open(path).map_err(|error| read_error(path, error))?;
    let mut line = String::new();
    BufReader::new(file).read_line(&mut line).map_err(|error| read_error(path, error))?;
    Ok(cells(line.trim_end_matches(['\n', '\r'])))
}

/// The columns `wanted` (by their index) of a file. A column of numbers only, or nothing, is one of numbers.
pub(crate) fn columns(path: &Path, wanted: &[usize]) -> Result<Vec<Column>, SweepError> {
    let names = names(path)?;
    let file = File::open(path).map_err(|error| read_error(path, error))?;
    let mut texts: Vec<Vec<Option<String>>> = vec![Vec::new(); wanted.len()];
    for (index, line) in BufReader::new(file).lines().enumerate().skip(1) {
        let line = line.map_err(|error| read_error(path, error))?;
        let cells = cells(&line);
        if cells.len() != names.len() {
            let found = format!("line {}: expected {} cells, found {}", index + 1, names.len(), cells.len());
            return Err(read_error(path, found));
        }
        for (column, at) in texts.iter_mut().zip(wanted) {
            column.push(Some(cells[*at].clone()).filter(|cell| !cell.is_empty()));
        }
    }
    let column = |(values, at): (Vec<Option<String>>, &usize)| {
        let number = |text: &Option<String>| text.as_ref().map_or(Some(f64::NAN), |text| text.parse().ok());
        let numbers: Option<Vec<f64>> = values.iter().map(number).collect();
        Column { name: names[*at].clone(), data: numbers.map_or(Data::Text(values), Data::Number) }
    };
    Ok(texts.into_iter().zip(wanted).map(column).collect())
}

fn cells(line: &str) -> Vec<String> {
    let (mut out, mut cell, mut inside) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if inside && letters.next_if_eq(&'"').is_some() => cell.push('"'),
            '"' => inside = !inside,
            ',' if !inside => out.push(std::mem::take(&mut cell)),
            other => cell.push(other),
        }
    }
    out.push(cell);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_read_as_they_were_written() {
        for text in ["plain", "a,b", "say \"so\"", "", "\"", ",,"] {
            let line = [quoted(text), quoted("x"), quoted(text)].join(",");
            assert_eq!(cells(&line), [text, "x", text]);
        }
    }
}
