//! Where the rows, shapes and events of a motion go.

use std::fs::{File, OpenOptions};
use std::io::{self, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use hydrostat::{Arm, MotionEvent, MotionState, MotionStatistics, MotionVerdict, MotionWarning};
use hydrostat_files::{
    EventOut, MOTION_EVENT_HEADS, MotionDocument, MotionShape, SavedMotion, WriteError, csv_row, motion_event_line,
    motion_line, motion_state_beside, write_whole,
};
use hydrostat_sweep::{Column, Data, parquet_bytes};

use crate::args::{MotionFormat, SimulateArgs};
use crate::output;

/// What a run took, and what should be known about it.
pub(super) struct Told {
    pub(super) statistics: MotionStatistics,
    /// Estimated error of the tip, m.
    pub(super) estimate: f64,
    /// What the steps gained of energy, J.
    pub(super) energy_gap: f64,
    pub(super) warnings: Vec<MotionWarning>,
    pub(super) events: Vec<MotionEvent>,
    /// What another run goes on from.
    pub(super) state: MotionState,
}

/// How a run ended.
pub(super) struct Ending {
    /// Why it did before its time.
    pub(super) verdict: Option<String>,
    /// The limit of the arm that it met.
    pub(super) limit: Option<MotionVerdict>,
}

/// A table that grows line by line.
struct Growing {
    path: PathBuf,
    /// None of standard output.
    file: Option<File>,
    bytes: u64,
}

impl Growing {
    /// A new file, or the first `kept` bytes of the one there is.
    fn open(path: &Path, kept: u64, heads: &str) -> anyhow::Result<Self> {
        if output::file(path).is_none() {
            let mut out = Self { path: path.to_owned(), file: None, bytes: 0 };
            out.add(heads)?;
            return Ok(out);
        }
        let failed = |source| WriteError { path: path.to_owned(), source };
        let kept = if path.exists() { kept } else { 0 };
        let mut file = OpenOptions::new().write(true).create(true).truncate(kept == 0).open(path).map_err(failed)?;
        if kept > 0 {
            file.set_len(kept).map_err(failed)?;
            file.seek(SeekFrom::End(0)).map_err(failed)?;
        }
        let mut out = Self { path: path.to_owned(), file: Some(file), bytes: kept };
        if kept == 0 {
            out.add(heads)?;
        }
        Ok(out)
    }

    fn add(&mut self, text: &str) -> anyhow::Result<()> {
        self.bytes += text.len() as u64;
        match &mut self.file {
            Some(file) => {
                let written = file.write_all(text.as_bytes());
                Ok(written.map_err(|source| WriteError { path: self.path.clone(), source })?)
            }
            None => Ok(output::print(text)?),
        }
    }
}

/// Rows, shapes and events, each where it is wanted.
pub(super) struct MotionOutput {
    format: MotionFormat,
    path: Option<PathBuf>,
    heads: Vec<String>,
    /// The table, where it is CSV in a file.
    table: Option<Growing>,
    shape_table: Option<Growing>,
    event_table: Option<Growing>,
    /// What is written at the end: all rows and shapes of a document.
    rows: Vec<Vec<f64>>,
    shapes: Vec<MotionShape>,
    count: u64,
    noted: usize,
    request: u64,
}

impl MotionOutput {
    /// The format that is asked for.
    pub(super) fn format(args: &SimulateArgs) -> MotionFormat {
        let ending = |path: &PathBuf| path.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
        let by_ending = match args.output.as_ref().map(ending) {
            None => MotionFormat::Text,
            Some(Some(ending)) if ending == "json" => MotionFormat::Json,
            Some(Some(ending)) if ending == "parquet" => MotionFormat::Parquet,
            Some(_) => MotionFormat::Csv,
        };
        args.format.unwrap_or(by_ending)
    }

    /// Opens the files, which `resumed` says what to keep of.
    pub(super) fn new(
        args: &SimulateArgs,
        heads: Vec<String>,
        shape_heads: &str,
        resumed: Option<&SavedMotion>,
        request: u64,
    ) -> anyhow::Result<Self> {
        let [rows, shapes, events] = resumed.map_or([0; 3], |saved| saved.written);
        let format = Self::format(args);
        let table = match (args.file(), format) {
            (Some(path), MotionFormat::Csv) => Some(Growing::open(path, rows, &csv_row(&heads))?),
            (None, MotionFormat::Csv) => {
                output::print(&csv_row(&heads))?;
                None
            }
            _ => None,
        };
        let open = |path: &PathBuf, kept: u64, heads: &str| Growing::open(path, kept, &output::line(heads.to_owned()));
        let shape_table = args.shapes_output.as_ref().map(|path| open(path, shapes, shape_heads));
        let event_table = args.events.as_ref().map(|path| open(path, events, MOTION_EVENT_HEADS));
        Ok(Self {
            format,
            path: args.file().map(Path::to_owned),
            heads,
            table,
            shape_table: shape_table.transpose()?,
            event_table: event_table.transpose()?,
            rows: Vec::new(),
            shapes: Vec::new(),
            count: resumed.map_or(0, |saved| saved.rows),
            noted: 0,
            request,
        })
    }

    /// How many rows there are.
    pub(super) fn rows(&self) -> u64 {
        self.count
    }

    /// Whether another run can go on with these files.
    pub(super) fn is_resumable(&self) -> bool {
        self.table.is_some()
    }

    pub(super) fn take_row(&mut self, numbers: Vec<f64>) -> anyhow::Result<()> {
        self.count += 1;
        match (self.format, &mut self.table) {
            (MotionFormat::Csv, Some(table)) => table.add(&motion_line(&numbers))?,
            (MotionFormat::Csv, None) => output::print(&motion_line(&numbers))?,
            (MotionFormat::Json | MotionFormat::Parquet, _) => self.rows.push(numbers),
            (MotionFormat::Text, _) => {}
        }
        Ok(())
    }

    /// Takes a whole shape, as lines of the table of shapes and as documents have it.
    pub(super) fn take_shape(&mut self, lines: &str, shape: MotionShape) -> anyhow::Result<()> {
        if let Some(table) = &mut self.shape_table {
            table.add(lines)?;
        }
        if self.format == MotionFormat::Json {
            self.shapes.push(shape);
        }
        Ok(())
    }

    /// Writes those of the `events` that are new.
    pub(super) fn note_events(&mut self, events: &[MotionEvent]) -> anyhow::Result<()> {
        for event in EventOut::all(&events[self.noted..], None) {
            if let Some(table) = &mut self.event_table {
                table.add(&motion_event_line(&event))?;
            }
        }
        self.noted = events.len();
        Ok(())
    }

    /// Keeps the state beside the output, so that another run can go on from here.
    pub(super) fn keep(&mut self, state: MotionState) -> Result<(), WriteError> {
        let Some(path) = &self.path else { return Ok(()) };
        let bytes = |table: &Option<Growing>| table.as_ref().map_or(0, |table| table.bytes);
        let written = [&self.table, &self.shape_table, &self.event_table].map(bytes);
        let saved = SavedMotion { state, request: self.request, rows: self.count, written };
        write_whole(motion_state_beside(path), output::line(saved.to_json()).as_bytes())
    }

    /// Writes what is written at the end: a document, a table of columns, or the text that `text` makes of the events.
    pub(super) fn end(
        &mut self,
        arm: &Arm,
        told: &Told,
        ending: &Ending,
        text: impl FnOnce(&[EventOut]) -> Option<String>,
    ) -> anyhow::Result<()> {
        self.note_events(&told.events)?;
        let events = EventOut::all(&told.events, ending.limit.as_ref());
        if let (Some(table), Some(_), Some(last)) = (&mut self.event_table, ending.limit, events.last()) {
            table.add(&motion_event_line(last))?;
        }
        self.keep(told.state.clone())?;
        let path = self.path.as_deref();
        match self.format {
            MotionFormat::Csv => Ok(()),
            MotionFormat::Json => {
                let document = MotionDocument::new(arm, &[], told.statistics, told.estimate, ending.verdict.clone())
                    .with_table(std::mem::take(&mut self.heads), std::mem::take(&mut self.rows))
                    .with_shapes(std::mem::take(&mut self.shapes))
                    .with_notes(events, &told.warnings, told.energy_gap);
                output::put(path, &output::line(document.to_json()))
            }
            MotionFormat::Parquet => {
                let heads = self.heads.iter().enumerate();
                let column = |(k, name): (usize, &String)| Column {
                    name: name.clone(),
                    data: Data::Number(self.rows.iter().map(|row| row[k]).collect()),
                };
                let columns: Vec<Column> = heads.map(column).collect();
                let bytes = parquet_bytes(&columns, path.unwrap_or(Path::new("-")))?;
                match path {
                    Some(path) => write_whole(path, &bytes)?,
                    None => io::stdout().lock().write_all(&bytes)?,
                }
                Ok(())
            }
            MotionFormat::Text => match text(&events) {
                Some(text) => output::put(path, &text),
                None => Ok(()),
            },
        }
    }
}
