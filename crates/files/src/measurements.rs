//! Measured shapes as CSV: a row for each place of each load case. `docs/identification.md` has the format.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use csv::StringRecord;
use hydrostat::Arm;
use hydrostat_identify::{Case, Marker, Measurement, Quantity, Unknown};

use crate::arm_file::ArmFile;
use crate::csv_text::{Dialect, Lines, is_missing, records, without_mark};
use crate::deviations::Deviations;
use crate::digits::number;
use crate::error::shortened;
use crate::marker_columns;
use crate::measured_columns::{Column, Head, Measured, head};
use crate::quantity::Dimension;

/// A position further from the base than this, over the unloaded arm's length, is in another unit than its column says: an arm stretches, but
/// not that far.
const FURTHEST: f64 = 3.0;
/// The largest file that is read.
const MOST_BYTES: u64 = 64 << 20;
/// Places (over L) that are this near are the same.
const SAME: f64 = 1e-9;
/// The most load cases: a fit solves all of them several times, and without each of them.
const MOST_CASES: usize = 1000;
/// The most numbers of a load case: a mesh has a node at each place.
const MOST_NUMBERS: usize = 1000;

/// What is wrong with a file of measurements.
#[derive(Debug, thiserror::Error)]
#[error("{path}{}{}: {why}", row_words(*.row), column_words(.column.as_ref()))]
pub struct MeasurementsError {
    /// The file.
    pub path: String,
    /// The line, from 1 as a spreadsheet counts; 0 where it is none.
    pub row: usize,
    /// The head of the column.
    pub column: Option<String>,
    /// What was expected and found.
    pub why: String,
}

fn row_words(row: usize) -> String {
    if row == 0 { String::new() } else { format!(", row {row}") }
}

fn column_words(column: Option<&String>) -> String {
    column.map_or_else(String::new, |column| format!(", column \"{}\"", shortened(column)))
}

/// Load cases of the arm in `file`, from a CSV file at `path`; `fitted` are the parameters that no case may give.
///
/// # Errors
/// [`MeasurementsError`] with row, column and reason.
pub fn read_measurements(
    path: &Path,
    file: &ArmFile,
    deviations: &Deviations,
    fitted: &[Unknown],
) -> Result<Vec<Case>, MeasurementsError> {
    let name = path.display().to_string();
    let fault = |why: String| MeasurementsError { path: name.clone(), row: 0, column: None, why };
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|error| fault(format!("cannot be read: {error}")))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(fault(format!("is larger than {} MB", MOST_BYTES >> 20)));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid.split(|byte| *byte == b'\n').count();
        MeasurementsError { row: line, ..fault("is not UTF-8; save the table as \"CSV UTF-8\"".to_owned()) }
    })?;
    parse_measurements(&text, &name, file, deviations, fitted)
}

/// [`read_measurements`] of a text that came from `path`, which messages name.
///
/// ```
/// use hydrostat_files::{ArmFile, Deviations, parse_measurements, shipped};
///
/// let file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
/// let text = "case,cable[0].tension [N],s [mm],x [mm],y [mm],sd position [mm]\n\
///             a,0.1,245,230.1,62.3,1\n\
///             a,,120,118.2,,1\n";
/// let cases = parse_measurements(text, "data.csv", &file, &Deviations::default(), &[]).unwrap();
/// assert_eq!((cases.len(), cases[0].measurements.len(), cases[0].arm.cables[0].tension), (1, 3, 0.1));
///
/// let wrong = "case,x [N]\na,1\n";
/// let error = parse_measurements(wrong, "data.csv", &file, &Deviations::default(), &[]).unwrap_err();
/// assert_eq!(error.to_string(), "data.csv, row 1, column \"x [N]\": expected a length in m, cm, mm, um, in, ft; `N` is the unit of a force");
/// ```
///
/// # Errors
/// As there.
pub fn parse_measurements(
    text: &str,
    path: &str,
    file: &ArmFile,
    deviations: &Deviations,
    fitted: &[Unknown],
) -> Result<Vec<Case>, MeasurementsError> {
    let text = without_mark(text);
    let dialect = Dialect::of(text);
    let mut reader = records(text, dialect);
    let fault = |row: usize, why: String| MeasurementsError { path: path.to_owned(), row, column: None, why };
    let mut table = Table {
        path,
        file,
        deviations,
        heads: Vec::new(),
        dialect,
        length: arm_of(file).map_err(|why| fault(0, why))?.length,
        cases: Vec::new(),
    };
    let mut lines = Lines::new(text);
    let mut all = reader.records();
    while let Some(record) = all.next() {
        let record = record.map_err(|error| {
            let row = error.position().map_or(0, |position| lines.of(position.byte()));
            fault(row, error.to_string())
        })?;
        let row = record.position().map_or(0, |position| lines.of(position.byte()));
        if table.heads.is_empty() {
            table.read_heads(row, &record, fitted).map_err(|error| {
                let first = all.next().and_then(Result::ok);
                marker_columns::hint(&record, first.as_ref()).map_or(error, |why| fault(row, why))
            })?;
        } else if record.iter().any(|cell| !cell.is_empty()) {
            table.read_row(row, &record)?;
        }
    }
    if table.heads.is_empty() {
        return Err(fault(0, "is empty: expected a row of column heads, as `--template` writes it".to_owned()));
    }
    table.cases()
}

fn arm_of(file: &ArmFile) -> Result<Arm, String> {
    file.arm().map_err(|error| error.to_string())
}

/// A case while it is read: the settings that it was given, and in which rows.
struct Building {
    name: String,
    /// A head and what a row had there.
    settings: Vec<(usize, String, usize)>,
    measurements: Vec<Measurement>,
    row: usize,
}

struct Table<'a> {
    path: &'a str,
    file: &'a ArmFile,
    deviations: &'a Deviations,
    heads: Vec<Head>,
    dialect: Dialect,
    length: f64,
    cases: Vec<Building>,
}

impl Table<'_> {
    fn fault(&self, row: usize, column: Option<&str>, why: impl Into<String>) -> MeasurementsError {
        MeasurementsError { path: self.path.to_owned(), row, column: column.map(str::to_owned), why: why.into() }
    }

    fn read_heads(&mut self, row: usize, record: &StringRecord, fitted: &[Unknown]) -> Result<(), MeasurementsError> {
        for text in record {
            let mut head = head(text).map_err(|why| self.fault(row, Some(text), why))?;
            if head.column == Column::Theta {
                // Of a table of stations, which has no standard deviations of its own.
                let counts = self.deviations.angle.is_some();
                head.column = if counts { Column::Value(Measured::Angle) } else { Column::Inner };
            }
            let others = self.heads.iter().filter(|other| other.column != Column::Inner);
            if let Some(other) = others.into_iter().find(|other| other.column == head.column) {
                return Err(self.fault(row, Some(text), format!("the column \"{}\" has the same", other.text)));
            }
            if let Column::Setting(key, _) = &head.column
                && fitted.iter().any(|parameter| parameter.to_string() == *key)
            {
                return Err(self.fault(row, Some(text), "is fitted, so that no load case can give it"));
            }
            self.heads.push(head);
        }
        Ok(())
    }

    /// A number in SI; `None` in a cell that says that nothing was measured.
    fn number(
        &self,
        row: usize,
        head: &Head,
        cell: &str,
        dimension: Dimension,
    ) -> Result<Option<f64>, MeasurementsError> {
        if is_missing(cell) {
            return Ok(None);
        }
        let plain = self.dialect.plain(cell);
        let found = plain.parse::<f64>().ok().filter(|value| value.is_finite()).and_then(|value| match dimension {
            Dimension::Number => Some(value),
            // From the decimal text, so that 0.1 mm is 1e-4 to the last bit.
            _ => dimension.parse(&format!("{plain} {}", head.unit)).ok(),
        });
        found.map(Some).ok_or_else(|| {
            let unit = if head.unit.is_empty() { String::new() } else { format!(" ({}, as the head says)", head.unit) };
            self.fault(row, Some(&head.text), format!("expected a number{unit}, found \"{}\"", shortened(cell)))
        })
    }

    fn read_row(&mut self, row: usize, record: &StringRecord) -> Result<(), MeasurementsError> {
        if record.len() != self.heads.len() {
            let why = format!(
                "expected {} cells, as many as there are column heads, found {}",
                self.heads.len(),
                record.len()
            );
            return Err(self.fault(row, None, why));
        }
        let name = match self.cell(record, &Column::Case) {
            Some((head, "")) => {
                return Err(self.fault(row, Some(&head.text), "expected the name of a load case, found nothing"));
            }
            Some((_, name)) => name.to_owned(),
            None => "1".to_owned(),
        };
        let marker = Marker { s: self.place(row, record)?, offset: self.offset(row, record)? };
        let found = self.measured(row, record, marker)?;
        let index = self.case_of(name, row)?;
        self.keep(row, index, found)?;
        self.take_settings(row, record, index)
    }

    /// The head of a column, if there is one, with what stands in its cell.
    fn cell<'r>(&self, record: &'r StringRecord, wanted: &Column) -> Option<(&Head, &'r str)> {
        let at = self.heads.iter().position(|head| head.column == *wanted)?;
        Some((&self.heads[at], record.get(at).unwrap_or_default()))
    }

    /// Where a row was measured (m): the tip where it does not say.
    fn place(&self, row: usize, record: &StringRecord) -> Result<f64, MeasurementsError> {
        let Some((head, cell)) = self.cell(record, &Column::Place) else { return Ok(self.length) };
        let Some(s) = self.number(row, head, cell, Dimension::Length)? else {
            // Only nothing at all is the tip.
            let why = format!("expected a place along the arm, or nothing for the tip, found \"{}\"", shortened(cell));
            return if cell.is_empty() { Ok(self.length) } else { Err(self.fault(row, Some(&head.text), why)) };
        };
        let slack = SAME * self.length;
        if (-slack..=self.length + slack).contains(&s) {
            return Ok(s);
        }
        let why =
            format!("{} mm is beyond the arm, which goes from 0 to {} mm", rounded_mm(s), rounded_mm(self.length));
        Err(self.fault(row, Some(&head.text), why))
    }

    /// Where a row's marker is beside the centreline (m): nowhere where it does not say.
    fn offset(&self, row: usize, record: &StringRecord) -> Result<[f64; 3], MeasurementsError> {
        let mut out = [0.0; 3];
        for (k, out) in out.iter_mut().enumerate() {
            let Some((head, cell)) = self.cell(record, &Column::Offset(k)) else { continue };
            *out = self.number(row, head, cell, Dimension::Length)?.unwrap_or(0.0);
            if out.abs() > self.length {
                let why = format!("{} mm is more than the length of the arm", rounded_mm(*out));
                return Err(self.fault(row, Some(&head.text), why));
            }
        }
        Ok(out)
    }

    /// What a row measures of a marker and elsewhere, each with the head of its column.
    fn measured(
        &self,
        row: usize,
        record: &StringRecord,
        marker: Marker,
    ) -> Result<Vec<(Measurement, String)>, MeasurementsError> {
        let mut out = Vec::new();
        for (head, cell) in self.heads.iter().zip(record) {
            let Column::Value(measured) = head.column else { continue };
            let Some(value) = self.number(row, head, cell, measured.dimension())? else { continue };
            let given = self.deviation(row, record, measured)?;
            let Some(sd) = given.or(self.deviations.of(measured.dimension())) else {
                let name = measured.at(marker).name();
                let why = format!(
                    "has no standard deviation: add a column \"sd {name} [{}]\", or --sd with {}",
                    head.unit,
                    measured.dimension()
                );
                return Err(self.fault(row, Some(&head.text), why));
            };
            out.push((Measurement { quantity: measured.at(marker), value, sd, row }, head.text.clone()));
        }
        Ok(out)
    }

    /// The standard deviation that a row gives, in a column for the quantity or, of positions, in one for all.
    fn deviation(
        &self,
        row: usize,
        record: &StringRecord,
        measured: Measured,
    ) -> Result<Option<f64>, MeasurementsError> {
        let own = self.cell(record, &Column::Deviation(Some(measured)));
        let both = || {
            let position = measured.is_position();
            position.then(|| self.cell(record, &Column::Deviation(None))).flatten()
        };
        let Some((head, cell)) = own.or_else(both) else { return Ok(None) };
        let sd = self.number(row, head, cell, measured.dimension())?;
        if sd.is_some_and(|sd| sd <= 0.0) {
            let why = format!("expected a standard deviation above zero, found {}", shortened(cell));
            return Err(self.fault(row, Some(&head.text), why));
        }
        Ok(sd)
    }

    /// Adds what a row measures to a case, to which no quantity may belong twice.
    fn keep(&mut self, row: usize, index: usize, found: Vec<(Measurement, String)>) -> Result<(), MeasurementsError> {
        let slack = SAME * self.length;
        let stations = self.heads.iter().any(|head| head.column == Column::Inner);
        if self.cases[index].measurements.len() + found.len() > MOST_NUMBERS {
            let why = format!("expected at most {MOST_NUMBERS} measured numbers a load case, found more");
            return Err(self.fault(row, None, why));
        }
        for (measurement, column) in found {
            let case = &self.cases[index];
            if let Some(other) = case.measurements.iter().find(|own| same(own.quantity, measurement.quantity, slack)) {
                if stations && other.value == measurement.value {
                    // A table of stations has the end of a cable twice.
                    continue;
                }
                let (quantity, name) = (measurement.quantity, shortened(&case.name));
                let why = format!("{quantity} of load case {name} is in row {} already", other.row);
                return Err(self.fault(row, Some(&column), why));
            }
            self.cases[index].measurements.push(measurement);
        }
        Ok(())
    }

    /// The index of a case, which begins in this row if there is none of that name.
    fn case_of(&mut self, name: String, row: usize) -> Result<usize, MeasurementsError> {
        if let Some(index) = self.cases.iter().position(|own| own.name == name) {
            return Ok(index);
        }
        if self.cases.len() == MOST_CASES {
            return Err(self.fault(row, None, format!("expected at most {MOST_CASES} load cases, found more")));
        }
        self.cases.push(Building { name, settings: Vec::new(), measurements: Vec::new(), row });
        Ok(self.cases.len() - 1)
    }

    /// What a row gives of a case's loads.
    fn take_settings(&mut self, row: usize, record: &StringRecord, index: usize) -> Result<(), MeasurementsError> {
        let heads = self.heads.clone();
        for (at, (head, cell)) in heads.iter().zip(record).enumerate() {
            let Column::Setting(_, dimension) = &head.column else { continue };
            if cell.is_empty() || (dimension.is_some() && is_missing(cell)) {
                continue;
            }
            let text = match dimension {
                Some(dimension) => {
                    self.number(row, head, cell, *dimension)?;
                    format!("{} {}", self.dialect.plain(cell), head.unit).trim_end().to_owned()
                }
                None => cell.to_owned(),
            };
            let case = &mut self.cases[index];
            match case.settings.iter().find(|(own, ..)| *own == at) {
                Some((_, before, first)) if *before != text => {
                    let [name, before, found] = [&case.name, before, &text].map(|text| shortened(text));
                    let why = format!("load case {name} has \"{before}\" in row {first}, found \"{found}\"");
                    return Err(self.fault(row, Some(&head.text), why));
                }
                Some(_) => {}
                None => case.settings.push((at, text, row)),
            }
        }
        Ok(())
    }

    fn cases(self) -> Result<Vec<Case>, MeasurementsError> {
        let mut out = Vec::with_capacity(self.cases.len());
        for case in &self.cases {
            let mut file = self.file.clone();
            for (at, text, row) in &case.settings {
                let head = &self.heads[*at];
                if let Column::Setting(key, _) = &head.column {
                    file.set_by("", key, text)
                        .map_err(|error| self.fault(*row, Some(&head.text), reason(&error.to_string())))?;
                }
            }
            let arm = arm_of(&file).map_err(|why| {
                self.fault(case.row, None, format!("load case {}: {}", shortened(&case.name), reason(&why)))
            })?;
            self.check_positions(case, &arm)?;
            out.push(Case { name: case.name.clone(), arm, measurements: case.measurements.clone() });
        }
        Ok(out)
    }
}

impl Table<'_> {
    /// Refuses positions that no arm of that size has.
    fn check_positions(&self, case: &Building, arm: &Arm) -> Result<(), MeasurementsError> {
        let longest = arm.length * arm.reference.nu.range(arm.length, arm.length).1.max(1.0);
        for measurement in &case.measurements {
            let Some((marker, axis)) = measurement.quantity.marker() else { continue };
            let base = arm.base_place(axis).unwrap_or_default();
            let measured = [Measured::X, Measured::Y, Measured::Z][axis];
            let off = (measurement.value - base).abs();
            if off <= FURTHEST * longest + marker.offset.iter().map(|v| v * v).sum::<f64>().sqrt() {
                continue;
            }
            let head = self.heads.iter().find(|head| head.column == Column::Value(measured));
            let why = format!(
                "{} mm from the base is {} lengths of the arm; see the unit of the column, and arm.base",
                number(1e3 * off),
                number(off / longest)
            );
            return Err(self.fault(measurement.row, head.map(|head| head.text.as_str()), why));
        }
        Ok(())
    }
}

/// What a message of the arm file says after the setting that it is about.
fn reason(message: &str) -> String {
    message.trim_start().to_owned()
}

pub(crate) fn rounded_mm(s: f64) -> f64 {
    (1e9 * s).round() / 1e6
}

fn same(a: Quantity, b: Quantity, slack: f64) -> bool {
    let offset = |of: Quantity| of.marker().map(|(marker, _)| marker.offset);
    match (a.place(), b.place()) {
        (Some(s), Some(t)) => a.name() == b.name() && (s - t).abs() <= slack && offset(a) == offset(b),
        _ => a == b,
    }
}
