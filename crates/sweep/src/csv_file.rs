//! Columns as CSV: a header and a line a row.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use csv::{Reader, StringRecord, Trim};
use hydrostat_files::{Dialect, csv_writer, is_missing};

use crate::column::{Column, Data};
use crate::error::{SweepError, read_error, write_error};

/// The lines of a part, without header.
pub(crate) fn part(columns: &[Column]) -> Vec<u8> {
    let rows = columns.first().map_or(0, |column| column.data.len());
    let mut out = csv_writer().from_writer(Vec::new());
    let mut cell = String::new();
    for row in 0..rows {
        for column in columns {
            cell.clear();
            match &column.data {
                Data::Whole(values) => cell.extend(values[row].map(|value| value.to_string())),
                Data::Number(values) if values[row].is_nan() => {}
                Data::Number(values) => {
                    // Writing into a text does not fail.
                    let _ = write!(cell, "{:?}", values[row]);
                }
                Data::Text(values) => cell.extend(values[row].as_deref()),
            }
            // Nor does writing into memory.
            let _ = out.write_field(&cell);
        }
        let _ = out.write_record(None::<&[u8]>);
    }
    out.into_inner().unwrap_or_default()
}

/// The names of columns as a line.
pub(crate) fn header(columns: &[Column]) -> Vec<u8> {
    let mut out = csv_writer().from_writer(Vec::new());
    let _ = out.write_record(columns.iter().map(|column| &column.name));
    out.into_inner().unwrap_or_default()
}

/// Writes header and parts to `out`.
pub(crate) fn join(parts: &[PathBuf], columns: &[Column], path: &Path, out: impl Write) -> Result<(), SweepError> {
    let failed = |error| write_error(path, error);
    let mut out = BufWriter::new(out);
    out.write_all(&header(columns)).map_err(failed)?;
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

/// What parts the cells of a file, and a reader of its rows from the first.
fn open(path: &Path) -> Result<(Dialect, Reader<BufReader<File>>), SweepError> {
    /// No head of a table is longer.
    const BEGIN: u64 = 1 << 20;
    let failed = |error| read_error(path, error);
    let mut file = File::open(path).map_err(failed)?;
    let mut begin = Vec::new();
    (&mut file).take(BEGIN).read_to_end(&mut begin).map_err(failed)?;
    let end = begin.iter().position(|byte| *byte == b'\n').unwrap_or(begin.len());
    let dialect = Dialect::of(&String::from_utf8_lossy(&begin[..end]));
    file.rewind().map_err(failed)?;
    Ok((dialect, dialect.reader().trim(Trim::None).from_reader(BufReader::new(file))))
}

/// The names of the columns of a file.
pub(crate) fn names(path: &Path) -> Result<Vec<String>, SweepError> {
    let (_, mut reader) = open(path)?;
    let heads = reader.records().next().transpose().map_err(|error| read_error(path, error))?;
    Ok(heads.iter().flatten().map(str::to_owned).collect())
}

/// The columns `wanted` (by their index) of a file. A column of numbers only, or nothing, is one of numbers.
pub(crate) fn columns(path: &Path, wanted: &[usize]) -> Result<Vec<Column>, SweepError> {
    let names = names(path)?;
    let (dialect, mut reader) = open(path)?;
    let mut texts: Vec<Vec<Option<String>>> = vec![Vec::new(); wanted.len()];
    for record in reader.records().skip(1) {
        let record = record.map_err(|error| read_error(path, error))?;
        if record.len() != names.len() {
            let line = record.position().map_or(0, csv::Position::line);
            let found = format!("line {line}: expected {} cells, found {}", names.len(), record.len());
            return Err(read_error(path, found));
        }
        for (column, at) in texts.iter_mut().zip(wanted) {
            column.push(record.get(*at).filter(|cell| !cell.is_empty()).map(str::to_owned));
        }
    }
    let column = |(values, at): (Vec<Option<String>>, &usize)| {
        let number = |text: &Option<String>| match text {
            Some(text) if !is_missing(text) => dialect.plain(text).parse().ok(),
            _ => Some(f64::NAN),
        };
        let numbers: Option<Vec<f64>> = values.iter().map(number).collect();
        Column { name: names[*at].clone(), data: numbers.map_or(Data::Text(values), Data::Number) }
    };
    Ok(texts.into_iter().zip(wanted).map(column).collect())
}

/// One column of a part, which has no header, as words.
pub(crate) fn words_of_part(path: &Path, index: usize) -> Result<Vec<Option<String>>, SweepError> {
    let file = File::open(path).map_err(|error| read_error(path, error))?;
    let mut reader = Dialect { delimiter: b',' }.reader().trim(Trim::None).from_reader(BufReader::new(file));
    let word = |record: Result<StringRecord, csv::Error>| {
        let record = record.map_err(|error| read_error(path, error))?;
        Ok(record.get(index).filter(|cell| !cell.is_empty()).map(str::to_owned))
    };
    reader.records().map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A name with an end of a line was written in quotes and read as two rows.
    #[test]
    fn cells_with_ends_of_lines_were_read_as_rows() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("out.csv");
        let texts =
            ["plain", "a,b", "say \"so\"", "two\nlines", "\"", ",,", "a\r\nb", " x "].map(|text| Some(text.to_owned()));
        let words = Column { name: "na\nme".to_owned(), data: Data::Text(texts.to_vec()) };
        let numbers = Column { name: "number".to_owned(), data: Data::Number(vec![1.5; texts.len()]) };
        let columns = [words, numbers];
        fs::write(&path, [header(&columns), part(&columns)].concat()).unwrap();
        assert_eq!(names(&path).unwrap(), ["na\nme", "number"]);
        assert_eq!(self::columns(&path, &[0, 1]).unwrap(), columns);
        fs::write(&path, part(&columns)).unwrap();
        assert_eq!(words_of_part(&path, 0).unwrap(), texts);
    }

    #[test]
    fn tables_that_a_spreadsheet_saved_are_read() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("out.csv");
        fs::write(&path, "\u{feff}row;flow_speed_m_s;tip_y_m\r\n0;0,5;NaN\r\n1;1;-2,5e-3\r\n").unwrap();
        assert_eq!(names(&path).unwrap(), ["row", "flow_speed_m_s", "tip_y_m"]);
        let columns = self::columns(&path, &[1, 2]).unwrap();
        assert_eq!(columns[0].data, Data::Number(vec![0.5, 1.0]));
        let Data::Number(tips) = &columns[1].data else { panic!("{:?}", columns[1]) };
        assert!(tips[0].is_nan() && tips[1] == -2.5e-3);
    }
}
