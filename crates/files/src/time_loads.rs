//! Loads over time: as CSV with the column `t_s`, and as `KEY=SHAPE:...`.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use hydrostat::{Arm, Course, Inputs, MotionError};

use crate::csv_text::{Dialect, Lines, is_missing, records, without_mark};
use crate::error::shortened;
use crate::format::{bracketed, dimension_at, nearest};
use crate::heads::{key_named, readings, unit_of};
use crate::quantity::{Dimension, WrongValue};
use crate::shared_unit::{PartialUnit, shared_unit};
use crate::slips::Span;

/// The most that is read, in bytes.
const MOST: u64 = 64 << 20;

/// The column of times.
const TIME: &str = "t_s";

/// What is wrong with loads over time, and where.
#[derive(Debug, thiserror::Error)]
pub enum TimeLoadsError {
    /// The file could not be read, or is no text.
    #[error("{path}: cannot be read: {source}")]
    Read {
        /// The file.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// More than 64 MiB.
    #[error("{path}: expected at most {MOST} bytes, found more")]
    TooLarge {
        /// The file.
        path: String,
    },
    /// A header without times, with a key twice, or with one that cannot change in time.
    #[error("{path}:{line}: column {column}: {found}")]
    Header {
        /// The file.
        path: String,
        /// Its line, from 1.
        line: usize,
        /// Its column, from 1.
        column: usize,
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
    #[error("{path}:{line}: column {column}, {key}: expected a finite number, found \"{}\"", shortened(.found))]
    Value {
        /// The file.
        path: String,
        /// Its line, from 1.
        line: usize,
        /// Its column, from 1.
        column: usize,
        /// Its head.
        key: String,
        /// What stands there.
        found: String,
    },
    /// Times that fall.
    #[error("{path}:{line}: t_s: expected a time not before that of the row above, {before} s, found {found} s")]
    Falls {
        /// The file.
        path: String,
        /// Its line, from 1.
        line: usize,
        /// The time before, s.
        before: f64,
        /// The time, s.
        found: f64,
    },
    /// A file without rows.
    #[error("{path}: expected a header with t_s and loads, and rows below it, found none")]
    Empty {
        /// The file.
        path: String,
    },
    /// A load that cannot be, a jump of the base say.
    #[error("{path}: {source}")]
    Load {
        /// The file.
        path: String,
        /// Why.
        source: MotionError,
    },
}

/// Why a text does not say how a load changes in time.
#[derive(Debug, Clone, thiserror::Error)]
pub enum ShapedError {
    /// Not of a form that is known.
    #[error(
        "{}: expected KEY=ramp:FROM:TO:START:END, KEY=step:FROM:TO:AT or KEY=sine:MEAN:AMPLITUDE:PERIOD, such as \
         'cable[0].tension=ramp:0:0.2 N:0 s:200 ms'",
        shortened(.text)
    )]
    Form {
        /// What was given.
        text: String,
    },
    /// A part that is no value.
    #[error(transparent)]
    Value(#[from] WrongValue),
    /// A unit after some numbers of one dimension only, not after the last.
    #[error(transparent)]
    Unit(#[from] PartialUnit),
    /// A load that cannot be.
    #[error(transparent)]
    Load(#[from] MotionError),
}

/// Adds to `inputs` the loads of a CSV file: the column `t_s` (s), and columns with the keys of loads, in SI units and
/// angles in degrees, or with a unit in the head: `cable_0_tension_mN`, `flow.speed [cm/s]`. Straight lines join the
/// rows; two rows at one time are a jump. An empty cell is skipped. Gives what each load runs through.
///
/// # Errors
/// [`TimeLoadsError`].
pub fn read_time_loads(path: impl AsRef<Path>, inputs: &mut Inputs) -> Result<Vec<Span>, TimeLoadsError> {
    let (text, name) = text_of(path.as_ref())?;
    parse_time_loads(&text, &name, inputs)
}

/// [`read_time_loads`] of text that came from `path`, which messages name.
///
/// # Errors
/// [`TimeLoadsError`].
///
/// ```
/// use hydrostat::Inputs;
/// use hydrostat_files::parse_time_loads;
///
/// let mut inputs = Inputs::default();
/// parse_time_loads("t_s,cable[0].tension\n0,0\n0.2,0.2\n0.2,0\n", "loads.csv", &mut inputs).unwrap();
///
/// let error = parse_time_loads("t_s,arm.length\n0,0\n", "loads.csv", &mut inputs).unwrap_err();
/// assert!(error.to_string().starts_with("loads.csv:1: column 2: `arm.length`"), "{error}");
/// let error = parse_time_loads("t_s,flow.speed\n0,fast\n", "loads.csv", &mut inputs).unwrap_err();
/// assert_eq!(error.to_string(), "loads.csv:2: column 2, flow.speed: expected a finite number, found \"fast\"");
/// ```
pub fn parse_time_loads(text: &str, path: &str, inputs: &mut Inputs) -> Result<Vec<Span>, TimeLoadsError> {
    let table = Table::read(text, path)?;
    let path = path.to_owned();
    let Some((time_column, unit)) = table.header.time else {
        let found = "expected a column `t_s` with times in s, found none".to_owned();
        return Err(TimeLoadsError::Header { path, line: table.line, column: 1, found });
    };
    let mut rows: Vec<Vec<(f64, f64)>> = vec![Vec::new(); table.header.keys.len()];
    let mut before = f64::NEG_INFINITY;
    for row in &table.rows {
        let time = unit.in_si(table.number(row, time_column, TIME)?);
        if time < before {
            return Err(TimeLoadsError::Falls { path, line: row.line, before, found: time });
        }
        before = time;
        for ((column, key, unit), rows) in table.header.keys.iter().zip(&mut rows) {
            if !row.is_missing(*column) {
                rows.push((time, unit.in_si(table.number(row, *column, key)?)));
            }
        }
    }
    if !before.is_finite() {
        return Err(TimeLoadsError::Empty { path });
    }
    let mut spans = Vec::new();
    for ((_, key, _), rows) in table.header.keys.iter().zip(rows) {
        if !rows.is_empty() {
            let set = set(inputs, key, Course::Table(rows));
            spans.extend(set.map_err(|source| TimeLoadsError::Load { path: path.clone(), source })?);
        }
    }
    Ok(spans)
}

/// Loads in their order, one row after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadRows {
    /// The keys of the columns, as the file has them.
    pub keys: Vec<String>,
    /// The values of each row in SI units, angles in degrees, with the row's line in the file.
    pub rows: Vec<(usize, Vec<f64>)>,
    path: String,
}

impl LoadRows {
    /// Of rows of values under these keys, SI units, angles in degrees; NaN keeps what the arm has.
    pub fn new(keys: &[String], rows: Vec<Vec<f64>>) -> Self {
        let rows = rows.into_iter().enumerate().map(|(k, values)| (k + 1, values)).collect();
        Self { keys: keys.iter().map(|key| bracketed(key)).collect(), rows, path: "loads".to_owned() }
    }

    /// The unit of a column's numbers: that of the key in SI, `deg` for angles, empty for plain numbers.
    pub fn unit(&self, column: usize) -> &'static str {
        let dimension = self.keys.get(column).and_then(|key| dimension_at(key)).unwrap_or(Dimension::Number);
        if dimension == Dimension::Angle { "deg" } else { dimension.bare_unit() }
    }

    /// The column of a key, with its indices in brackets or behind points.
    pub fn column(&self, key: &str) -> Option<usize> {
        let key = bracketed(key);
        self.keys.iter().position(|own| *own == key)
    }

    /// What each load runs through.
    pub fn spans(&self) -> Vec<Span> {
        let of = |(k, key): (usize, &String)| {
            let dimension = dimension_at(key).unwrap_or(Dimension::Number);
            Span::of(key, self.rows.iter().map(|(_, values)| dimension.bare(values[k])))
        };
        self.keys.iter().enumerate().filter_map(of).collect()
    }

    /// The arm at each row.
    ///
    /// # Errors
    /// [`TimeLoadsError::Load`] with the line of a row whose loads make no arm.
    pub fn arms(&self, arm: &Arm) -> Result<Vec<Arm>, TimeLoadsError> {
        let one = |(line, values): &(usize, Vec<f64>)| {
            let load = |source| TimeLoadsError::Load { path: format!("{}:{line}", self.path), source };
            let mut inputs = Inputs::default();
            for (key, value) in self.keys.iter().zip(values).filter(|(_, value)| value.is_finite()) {
                let dimension = dimension_at(key).unwrap_or(Dimension::Number);
                inputs.set(key, Course::constant(dimension.bare(*value))).map_err(load)?;
            }
            inputs.arm_at(arm, 0.0).map_err(load)
        };
        self.rows.iter().map(one).collect()
    }
}

/// Reads loads in their order from a CSV file: columns with the keys of loads, in SI units, angles in degrees. A
/// column `t_s` is ignored. A cell that is empty keeps the value of the row above, or that of the arm.
///
/// # Errors
/// [`TimeLoadsError`].
pub fn read_load_rows(path: impl AsRef<Path>) -> Result<LoadRows, TimeLoadsError> {
    let (text, name) = text_of(path.as_ref())?;
    parse_load_rows(&text, &name)
}

/// [`read_load_rows`] of text that came from `path`, which messages name.
///
/// # Errors
/// [`TimeLoadsError`].
///
/// ```
/// use hydrostat_files::parse_load_rows;
///
/// let loads = parse_load_rows("cable[0].tension,flow.speed\n0,0.1\n0.2,\n0,\n", "loads.csv").unwrap();
/// assert_eq!(loads.rows[1], (3, vec![0.2, 0.1]));
/// let error = parse_load_rows("cable[0].tension\nmuch\n", "loads.csv").unwrap_err();
/// assert_eq!(error.to_string(), "loads.csv:2: column 1, cable[0].tension: expected a finite number, found \"much\"");
/// ```
pub fn parse_load_rows(text: &str, path: &str) -> Result<LoadRows, TimeLoadsError> {
    let table = Table::read(text, path)?;
    let mut rows: Vec<(usize, Vec<f64>)> = Vec::new();
    for row in &table.rows {
        let mut values = Vec::with_capacity(table.header.keys.len());
        for (k, (column, key, unit)) in table.header.keys.iter().enumerate() {
            let above = rows.last().map_or(f64::NAN, |(_, values)| values[k]);
            values.push(if row.is_missing(*column) { above } else { unit.bare(table.number(row, *column, key)?) });
        }
        rows.push((row.line, values));
    }
    if rows.is_empty() || table.header.keys.is_empty() {
        return Err(TimeLoadsError::Empty { path: path.to_owned() });
    }
    let keys = table.header.keys.into_iter().map(|(_, key, _)| key).collect();
    Ok(LoadRows { keys, rows, path: path.to_owned() })
}

/// The text of a file, and its name for messages.
fn text_of(path: &Path) -> Result<(String, String), TimeLoadsError> {
    let name = path.display().to_string();
    let read = |source| TimeLoadsError::Read { path: name.clone(), source };
    let mut text = String::new();
    File::open(path).and_then(|file| file.take(MOST + 1).read_to_string(&mut text)).map_err(read)?;
    if text.len() as u64 > MOST {
        return Err(TimeLoadsError::TooLarge { path: name });
    }
    Ok((text, name))
}

/// A table of loads with its cells as they stand there.
struct Table {
    path: String,
    dialect: Dialect,
    header: Header,
    /// The line of the header.
    line: usize,
    rows: Vec<Line>,
}

/// A row of a table.
struct Line {
    line: usize,
    cells: Vec<String>,
}

impl Line {
    fn is_missing(&self, column: usize) -> bool {
        is_missing(self.cells.get(column).map_or("", String::as_str))
    }
}

impl Table {
    /// Rows that are as long as the header; empty ones are passed over.
    fn read(text: &str, path: &str) -> Result<Self, TimeLoadsError> {
        let path = path.to_owned();
        let text = without_mark(text);
        let dialect = Dialect::of(text);
        let mut reader = records(text, dialect);
        let mut lines = Lines::new(text);
        let mut header: Option<(Header, usize, usize)> = None;
        let mut rows = Vec::new();
        for record in reader.records() {
            // The text is in memory and is UTF-8.
            let Ok(record) = record else { continue };
            let line = record.position().map_or(0, |position| lines.of(position.byte()));
            if record.iter().all(str::is_empty) {
                continue;
            }
            let Some((_, expected, _)) = &header else {
                let found = Header::read(record.iter()).map_err(|(column, found)| TimeLoadsError::Header {
                    path: path.clone(),
                    line,
                    column,
                    found,
                })?;
                header = Some((found, record.len(), line));
                continue;
            };
            if record.len() != *expected {
                return Err(TimeLoadsError::Ragged { path, line, expected: *expected, found: record.len() });
            }
            rows.push(Line { line, cells: record.iter().map(str::to_owned).collect() });
        }
        match header {
            Some((header, _, line)) => Ok(Self { path, dialect, header, line, rows }),
            None => Err(TimeLoadsError::Empty { path }),
        }
    }

    /// A cell as a number.
    fn number(&self, row: &Line, column: usize, key: &str) -> Result<f64, TimeLoadsError> {
        let cell = row.cells.get(column).map_or("", String::as_str);
        self.dialect.number(cell).ok_or_else(|| TimeLoadsError::Value {
            path: self.path.clone(),
            line: row.line,
            column: column + 1,
            key: key.to_owned(),
            found: cell.to_owned(),
        })
    }
}

/// Where times stand with their unit, and the columns of loads with their keys and units.
struct Header {
    time: Option<(usize, Unit)>,
    keys: Vec<(usize, String, Unit)>,
}

/// What the numbers of a column are in: the unit in its head, or that of bare numbers.
#[derive(Debug, Clone, Copy)]
struct Unit(Dimension, Option<&'static str>);

impl Unit {
    fn in_si(self, value: f64) -> f64 {
        let Self(dimension, unit) = self;
        // As text, so that 200 mN here are those of the arm file, to the last bit.
        let with_unit = unit.and_then(|unit| dimension.parse(&format!("{value:?} {unit}")).ok());
        with_unit.unwrap_or_else(|| dimension.bare(value))
    }

    /// The number as one without a unit has it: SI, angles in degrees.
    fn bare(self, value: f64) -> f64 {
        match self {
            Self(_, None) => value,
            Self(Dimension::Angle, Some(_)) => self.in_si(value).to_degrees(),
            Self(_, Some(_)) => self.in_si(value),
        }
    }
}

/// The load of a head, such as `cable[0].tension`, `cable_0_tension_mN` or `flow.speed [cm/s]`.
fn load(head: &str) -> Option<(String, Unit)> {
    let can_change = |key: &str| Inputs::default().set(key, Course::constant(0.0)).is_ok();
    readings(head).into_iter().find_map(|(name, unit)| {
        let bare = bracketed(name);
        let key = if can_change(&bare) { bare } else { key_named(name).filter(|key| can_change(key))? };
        let dimension = dimension_at(&key).unwrap_or(Dimension::Number);
        let known = unit_of(dimension, unit);
        (unit.is_empty() || known.is_some()).then_some((key, Unit(dimension, known)))
    })
}

/// The unit of a column of times: `t_s`, `t_ms`, `time [s]`.
fn times(head: &str) -> Option<Unit> {
    readings(head).into_iter().find_map(|(name, unit)| {
        let unit = unit_of(Dimension::Time, unit).filter(|_| ["t", "time"].contains(&name))?;
        Some(Unit(Dimension::Time, Some(unit)))
    })
}

impl Header {
    /// The column (from 1) and what is wrong with it, where something is.
    fn read<'a>(cells: impl Iterator<Item = &'a str>) -> Result<Self, (usize, String)> {
        let (mut time, mut keys) = (None, Vec::<(usize, String, Unit)>::new());
        for (k, cell) in cells.enumerate() {
            if let Some(unit) = times(cell) {
                if time.replace((k, unit)).is_some() {
                    return Err((k + 1, "the times are there twice".to_owned()));
                }
                continue;
            }
            let Some((key, unit)) = load(cell) else { return Err((k + 1, unknown(cell))) };
            if keys.iter().any(|(_, other, _)| *other == key) {
                return Err((k + 1, format!("`{key}` is there twice")));
            }
            keys.push((k, key, unit));
        }
        Ok(Self { time, keys })
    }
}

/// What is wrong with a head that is neither times nor a load. With a suggestion the list of all heads is left out.
fn unknown(head: &str) -> String {
    let known = Inputs::names();
    let is_time = ["t", "time", "times"].contains(&head.to_lowercase().as_str());
    let near = nearest(&bracketed(head), known.iter().map(String::as_str).chain([TIME]));
    let hint = match (is_time, near) {
        (true, _) => format!("; did you mean `{TIME}`?"),
        (false, Some(near)) => format!("; did you mean `{near}`?"),
        (false, None) => format!("; columns that can: {TIME}, {}", known.join(", ")),
    };
    format!("`{}` cannot change over time{hint}", shortened(head))
}

/// Adds to `inputs` one load that changes in time: `KEY=ramp:FROM:TO:START:END`, `KEY=step:FROM:TO:AT` or
/// `KEY=sine:MEAN:AMPLITUDE:PERIOD`, values and times in SI units (angles in degrees) unless they have their own. A unit after the last
/// value holds for both values, one after the last time for both times. Gives what the load runs through.
///
/// # Errors
/// [`ShapedError`].
///
/// ```
/// use hydrostat::Inputs;
/// use hydrostat_files::set_shaped;
///
/// let mut inputs = Inputs::default();
/// set_shaped("cable[0].tension=ramp:50:200 mN:0:0.2 s", &mut inputs).unwrap();
/// set_shaped("flow.speed=sine:0.1:0.05:2", &mut inputs).unwrap();
/// assert!(set_shaped("flow.speed=0:1", &mut inputs).is_err());
/// ```
pub fn set_shaped(text: &str, inputs: &mut Inputs) -> Result<Span, ShapedError> {
    let form = || ShapedError::Form { text: text.to_owned() };
    let (key, shape) = text.split_once('=').ok_or_else(form)?;
    let key = bracketed(key.trim());
    let parts: Vec<&str> = shape.split(':').map(str::trim).collect();
    let dimension = dimension_at(&key).unwrap_or(Dimension::Number);
    let course = match parts[..] {
        ["ramp", from, to, start, end] => {
            let [from, to] = alike(dimension, &key, [from, to])?;
            let [start, end] = alike(Dimension::Time, &key, [start, end])?;
            Course::ramp(from, to, start, end)
        }
        ["step", from, to, at] => {
            let [from, to] = alike(dimension, &key, [from, to])?;
            let [at] = alike(Dimension::Time, &key, [at])?;
            Course::step(from, to, at)
        }
        ["sine", mean, amplitude, period] => {
            let [mean, amplitude] = alike(dimension, &key, [mean, amplitude])?;
            let [period] = alike(Dimension::Time, &key, [period])?;
            Course::Sine { mean, amplitude, frequency: 1.0 / period, phase: 0.0 }
        }
        _ => return Err(form()),
    };
    set(inputs, &key, course)?.ok_or_else(form)
}

/// Sets the course of a load, and gives what it runs through.
fn set(inputs: &mut Inputs, key: &str, course: Course) -> Result<Option<Span>, MotionError> {
    let span = Span::of(key, course.values());
    inputs.set(key, course)?;
    Ok(span)
}

/// Numbers of one dimension in SI units; a unit after the last one holds for all.
fn alike<const N: usize>(dimension: Dimension, key: &str, parts: [&str; N]) -> Result<[f64; N], ShapedError> {
    let mut out = [0.0; N];
    for (out, text) in out.iter_mut().zip(shared_unit(dimension, key, &parts, ":")?) {
        *out = dimension.value_of(key, &text)?.0;
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Inputs, String> {
        let mut inputs = Inputs::default();
        parse_time_loads(text, "loads.csv", &mut inputs).map(|_| inputs).map_err(|error| error.to_string())
    }

    /// Only keys without a unit were read, not the heads that all other tables have.
    #[test]
    fn heads_are_those_of_other_tables() {
        let plain = read("t_s,cable[0].tension,flow.direction\n0,0,90\n2,0.2,180\n").unwrap();
        for heads in [
            "t_ms,cable_0_tension_mN,flow_direction_deg",
            "t [ms],cable[0].tension [mN],flow.direction [deg]",
            "time_ms,cable.0.tension [mN],flow.direction",
        ] {
            let other = read(&format!("{heads}\n0,0,90\n2000,200,180\n")).unwrap();
            assert_eq!(other, plain, "{heads}");
        }
    }

    #[test]
    fn loads_along_the_arm_are_read_by_key_and_by_head() {
        let plain =
            read("t_s,distributed.force[1].tip,distributed.couple[0],distributed.couple\n0,0,0,0\n1,2,3,4\n").unwrap();
        for heads in [
            "t_s,distributed_force_1_tip_N_m,distributed_couple_0_N,distributed_couple_N",
            "t_s,distributed.force.1.tip,distributed.couple.0,distributed.couple[2]",
        ] {
            assert_eq!(read(&format!("{heads}\n0,0,0,0\n1,2,3,4\n")).unwrap(), plain, "{heads}");
        }
        let mut shaped = Inputs::default();
        set_shaped("distributed.force[1]=ramp:0:50 mN/m:0:1", &mut shaped).unwrap();
        assert_eq!(read("t_s,distributed.force[1]\n0,0\n1,0.05\n").unwrap(), shaped);
    }

    /// The tension was ignored.
    #[test]
    fn tension_and_stroke_of_one_cable_are_refused_in_a_file_and_beside_it() {
        let error = read("t_s,cable[0].tension,cable[0].stroke\n0,0,0\n").unwrap_err();
        assert!(error.starts_with("loads.csv: `cable[0].stroke`: `cable[0].tension` is given as well"), "{error}");
        let mut inputs = read("t_s,cable[0].tension\n0,0\n").unwrap();
        let error = set_shaped("cable[0].stroke=ramp:0:1 mm:0:1", &mut inputs).unwrap_err().to_string();
        assert!(error.contains("`cable[0].stroke`: `cable[0].tension` is given as well"), "{error}");
        let rows = parse_load_rows("cable[0].tension,cable[0].stroke\n0,0\n", "loads.csv").unwrap();
        let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(hydrostat::Cable::new("left", 0.001));
        let error = rows.arms(&arm).unwrap_err().to_string();
        assert!(error.starts_with("loads.csv:2: `cable[0].stroke`: `cable[0].tension` is given as well"), "{error}");
    }

    #[test]
    fn heads_that_are_none_get_a_hint() {
        for (heads, words) in [
            ("time,flow.speed", "column 1: `time` cannot change over time; did you mean `t_s`?"),
            ("t_s,flow.sped", "column 2: `flow.sped` cannot change over time; did you mean `flow.speed`?"),
            (
                "t_s,arm.length",
                "column 2: `arm.length` cannot change over time; columns that can: t_s, cable[0].tension, ",
            ),
            ("t_s,t_ms", "column 2: the times are there twice"),
            ("t_s,cable_0_tension_mm", "column 2: `cable_0_tension_mm` cannot change over time; "),
            ("flow.speed,tip.moment", "column 1: expected a column `t_s` with times in s, found none"),
        ] {
            let error = read(&format!("{heads}\n0,0\n")).unwrap_err();
            assert!(error.starts_with(&format!("loads.csv:1: {words}")), "{error}");
        }
    }
    /// The first number of `ramp:50:100 mN` was read in newtons.
    #[test]
    fn a_unit_after_the_last_number_holds_for_all_of_its_dimension() {
        let shaped = |text: &str| {
            let mut inputs = Inputs::default();
            set_shaped(text, &mut inputs).map(|_| inputs).map_err(|error| error.to_string())
        };
        for (shared, each) in [
            ("cable[0].tension=ramp:50:100 mN:0:0.02", "cable[0].tension=ramp:50 mN:100 mN:0 s:0.02 s"),
            ("cable[0].tension=sine:50:20 mN:1", "cable[0].tension=sine:50 mN:20 mN:1 s"),
            ("flow.speed=ramp:5:20 cm/s:100:1000 ms", "flow.speed=ramp:5 cm/s:20 cm/s:100 ms:1000 ms"),
            ("flow.direction=step:1:2 rad:10 ms", "flow.direction=step:1 rad:2 rad:10 ms"),
            ("cable[0].tension=ramp:0:0.2 N:0 s:200 ms", "cable[0].tension=ramp:0:0.2:0:0.2"),
        ] {
            assert_eq!(shaped(shared).unwrap(), shaped(each).unwrap(), "{shared}");
        }
        let error = shaped("flow.speed=ramp:5 cm/s:20:0:1").unwrap_err();
        assert!(error.contains("\"5:20 cm/s\"") && error.contains("\"5 cm/s:20 m/s\""), "{error}");
        let error = shaped("flow.speed=ramp:5:20:1 ms:2").unwrap_err();
        assert!(error.contains("\"1:2 ms\"") && error.contains("\"1 ms:2 s\""), "{error}");
    }
}
