//! Where the rows, shapes and events of a motion go.

use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{self, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use hydrostat::{Arm, Instant, MotionEvent, MotionStation, MotionVerdict, Simulation};
use hydrostat_files::{
    EventOut, MOTION_EVENT_HEADS, MOTION_SHAPE_HEADS, MotionDocument, SavedMotion, WriteError, motion_event_line,
    motion_heads, motion_line, motion_shape_lines, motion_state_beside, number, write_whole,
};
use hydrostat_sweep::{Column, Data, parquet_bytes};

use crate::args::{MotionFormat, SimulateArgs};
use crate::output;

/// How a run ended.
pub(super) struct Ending {
    /// Why it did before its time.
    pub(super) verdict: Option<String>,
    /// The limit of the arm that it met.
    pub(super) limit: Option<MotionVerdict>,
    /// What it took, s.
    pub(super) wall: f64,
}

/// A table that grows line by line.
struct Growing {
    path: PathBuf,
    file: File,
    bytes: u64,
}

impl Growing {
    /// A new file, or the first `kept` bytes of the one there is.
    fn open(path: &Path, kept: u64, heads: &str) -> Result<Self, WriteError> {
        let failed = |source| WriteError { path: path.to_owned(), source };
        let kept = if path.exists() { kept } else { 0 };
        let mut file = OpenOptions::new().write(true).create(true).truncate(kept == 0).open(path).map_err(failed)?;
        if kept > 0 {
            file.set_len(kept).map_err(failed)?;
            file.seek(SeekFrom::End(0)).map_err(failed)?;
        }
        let mut out = Self { path: path.to_owned(), file, bytes: kept };
        if kept == 0 {
            out.add(&output::line(heads.to_owned()))?;
        }
        Ok(out)
    }

    fn add(&mut self, text: &str) -> Result<(), WriteError> {
        self.bytes += text.len() as u64;
        self.file.write_all(text.as_bytes()).map_err(|source| WriteError { path: self.path.clone(), source })
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
    /// What is written at the end: all rows and shapes of a document, of a text the last row.
    rows: Vec<Vec<f64>>,
    shapes: Vec<(f64, Vec<MotionStation>)>,
    last: Option<Instant>,
    /// Tip of the last equilibrium, and the last and the largest distance from one over the length.
    equilibrium: Option<([f64; 2], [f64; 2])>,
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
        arm: &Arm,
        stations: usize,
        resumed: Option<&SavedMotion>,
        request: u64,
    ) -> anyhow::Result<Self> {
        let heads = motion_heads(arm.cables.len(), stations, args.quasi_static);
        let [rows, shapes, events] = resumed.map_or([0; 3], |saved| saved.written);
        let format = Self::format(args);
        let table = match (&args.output, format) {
            (Some(path), MotionFormat::Csv) => Some(Growing::open(path, rows, &heads.join(","))?),
            (None, MotionFormat::Csv) => {
                output::print(&output::line(heads.join(",")))?;
                None
            }
            _ => None,
        };
        let shape_table = args.shapes_output.as_ref().map(|path| Growing::open(path, shapes, MOTION_SHAPE_HEADS));
        let event_table = args.events.as_ref().map(|path| Growing::open(path, events, MOTION_EVENT_HEADS));
        Ok(Self {
            format,
            path: args.output.clone(),
            heads,
            table,
            shape_table: shape_table.transpose()?,
            event_table: event_table.transpose()?,
            rows: Vec::new(),
            shapes: Vec::new(),
            last: None,
            equilibrium: None,
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

    /// Takes the equilibrium of a row, which has the tip at x, y (m), and how far from it the tip is over the length.
    pub(super) fn take_equilibrium(&mut self, [x, y, _, distance]: [f64; 4]) {
        if distance.is_finite() {
            let most = self.equilibrium.map_or(0.0, |(_, [_, most])| most);
            self.equilibrium = Some(([x, y], [distance, most.max(distance)]));
        }
    }

    pub(super) fn take_row(&mut self, at: &Instant, numbers: Vec<f64>) -> anyhow::Result<()> {
        self.count += 1;
        match (self.format, &mut self.table) {
            (MotionFormat::Csv, Some(table)) => table.add(&motion_line(&numbers))?,
            (MotionFormat::Csv, None) => output::print(&motion_line(&numbers))?,
            (MotionFormat::Json | MotionFormat::Parquet, _) => self.rows.push(numbers),
            (MotionFormat::Text, _) => {}
        }
        self.last = Some(at.clone());
        Ok(())
    }

    pub(super) fn take_shape(&mut self, time: f64, stations: Vec<MotionStation>) -> Result<(), WriteError> {
        if let Some(table) = &mut self.shape_table {
            table.add(&motion_shape_lines(time, &stations))?;
        }
        if self.format == MotionFormat::Json {
            self.shapes.push((time, stations));
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
    pub(super) fn keep(&mut self, simulation: &Simulation) -> Result<(), WriteError> {
        let Some(path) = &self.path else { return Ok(()) };
        let bytes = |table: &Option<Growing>| table.as_ref().map_or(0, |table| table.bytes);
        let written = [&self.table, &self.shape_table, &self.event_table].map(bytes);
        let saved = SavedMotion { state: simulation.state(), request: self.request, rows: self.count, written };
        write_whole(motion_state_beside(path), output::line(saved.to_json()).as_bytes())
    }

    /// Writes what is written at the end.
    pub(super) fn end(&mut self, arm: &Arm, simulation: &Simulation, ending: &Ending) -> anyhow::Result<()> {
        self.note_events(simulation.events())?;
        let events = EventOut::all(simulation.events(), ending.limit.as_ref());
        if let (Some(table), Some(_), Some(last)) = (&mut self.event_table, ending.limit, events.last()) {
            table.add(&motion_event_line(last))?;
        }
        self.keep(simulation)?;
        let path = self.path.as_deref();
        match self.format {
            MotionFormat::Csv => Ok(()),
            MotionFormat::Json => {
                let (statistics, estimate) = (simulation.statistics(), simulation.error_estimate());
                let document = MotionDocument::new(arm, &[], statistics, estimate, ending.verdict.clone())
                    .with_table(std::mem::take(&mut self.heads), std::mem::take(&mut self.rows))
                    .with_shapes(&self.shapes)
                    .with_notes(events, &simulation.warnings(), simulation.energy_gap());
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
            MotionFormat::Text => match &self.last {
                Some(at) => {
                    let mut text = text(arm, at, &events, simulation, ending.wall);
                    if let Some(([x, y], [distance, most])) = self.equilibrium {
                        let _ = writeln!(
                            text,
                            "statics in equilibrium the tip would be at ({}, {}) m, {} of the length away; at most {} on the way",
                            number(x),
                            number(y),
                            number(distance),
                            number(most)
                        );
                    }
                    output::put(path, &text)
                }
                None => Ok(()),
            },
        }
    }
}

/// The end and what it took, for people.
fn text(arm: &Arm, at: &Instant, events: &[EventOut], simulation: &Simulation, wall: f64) -> String {
    let (statistics, estimate) = (simulation.statistics(), simulation.error_estimate());
    let mut text = format!(
        "motion {}\n\nafter  {} s the tip is at ({}, {}) m, turned by {} deg, and moves at {} m/s\n",
        arm.name,
        number(at.time),
        number(at.tip[0]),
        number(at.tip[1]),
        number(at.tip_theta.to_degrees()),
        number(at.tip_velocity[0].hypot(at.tip_velocity[1]))
    );
    for (cable, own) in arm.cables.iter().zip(&at.cables) {
        let _ = writeln!(
            text,
            "cable  {}: {} N, {} mm reeled in",
            cable.name,
            number(own.tension),
            number(1e3 * own.stroke)
        );
    }
    let (base, works) = (at.base_reaction, at.works);
    let all = [works.cables, works.water, works.gravity, works.loads, works.base, works.volume, works.dissipated];
    let largest = all.iter().fold(at.strain_energy, |largest, work| largest.max(work.abs()));
    // What rounding leaves of nothing is nothing.
    let all = all.map(|work| number(if work.abs() < 1e-12 * largest { 0.0 } else { work }));
    let [cables, water, gravity, loads, own_base, volume, dissipated] = all;
    let _ = writeln!(
        text,
        "base   ({}, {}) N and {} N m hold it\n\
         energy {} J kinetic, {} J of strain\n\
         work   {cables} J by cables, {water} by water, {gravity} by gravity, {loads} by loads, {own_base} by the base, \
         {volume} by sections that swell; {dissipated} dissipated",
        number(base.force[0]),
        number(base.force[1]),
        number(base.moment),
        number(at.kinetic_energy),
        number(at.strain_energy),
    );
    for event in events {
        let of = event.cable.map_or_else(String::new, |cable| format!(", cable {cable}"));
        let place = event.s.map_or_else(String::new, |s| format!(", s = {} m", number(s)));
        let _ = writeln!(text, "event  {} s: {}{of}{place}", number(event.time), event.kind);
    }
    let _ = writeln!(
        text,
        "steps  {} in time, {} taken back, on {} elements, in {} s: {} times as fast as the clock\n\
         error  about {} m at the tip by the steps",
        statistics.steps,
        statistics.rejected,
        statistics.elements,
        number(wall),
        number(at.time / wall),
        number(estimate)
    );
    text
}
