//! A sweep from its plan to its output.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use hydrostat::{Arm, NoRow, Options, SnapBounds, VerdictKind};
use hydrostat_files::{ArmFile, arm_to_toml, write_whole, write_whole_with};
use rayon::prelude::*;
use serde::Serialize;

use crate::answer::{AnyRow, NoAnswer, Tile, solve_after_snap, solve_after_snap_in_space};
use crate::arms::{Arms, Last};
use crate::column::{Answer, Answered, Column, Data, Layout, Output, WARNINGS};
use crate::error::{SweepError, parquet_error};
use crate::file_format::{Format, NOTE, noted};
use crate::parquet_file::Reader;
use crate::parts::{Part, Parts, difference};
use crate::plan::Plan;
use crate::shard::{Shard, common, rows_of, tiles_and_rows};
use crate::{csv_file, parquet_file};

/// About so many parts of a sweep, within the bounds below.
const PARTS: u64 = 64;
/// The most rows of a part.
const LONGEST: u64 = 16_384;
/// The most numbers of a part, 8 bytes each.
const LARGEST: u64 = 1 << 20;

/// What is asked of a sweep beyond its plan.
#[derive(Debug, Clone)]
pub struct SweepOptions {
    /// Error of the tip position over the length, in [1e-12, 1e-2].
    pub tol: f64,
    /// How far an arm may snap on its way to its loads.
    pub snaps: SnapBounds,
    /// Whether to follow the motion after each snap until the arm rests, whatever the bounds.
    pub after_snap: bool,
    /// What is written of every row.
    pub outputs: Vec<Output>,
    /// So many equally spaced stations of every row; none below two.
    pub stations: usize,
    /// The part of the rows that is solved; `None` for all.
    pub shard: Option<Shard>,
}

impl Default for SweepOptions {
    fn default() -> Self {
        Self {
            tol: 1e-6,
            snaps: SnapBounds::default(),
            after_snap: false,
            outputs: Output::DEFAULT.to_vec(),
            stations: 0,
            shard: None,
        }
    }
}

/// What a sweep came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Summary {
    /// Rows written.
    pub rows: u64,
    /// Rows that have an answer.
    pub answered: u64,
    /// Rows that an earlier run had left in whole parts.
    pub resumed: u64,
    /// Parts of an earlier run whose bytes were not those written, and that were solved again.
    pub damaged: u64,
    /// The kinds of warnings, each with how many rows have it; none where warnings are no column.
    pub warnings: BTreeMap<String, u64>,
}

/// A sweep that can be run.
///
/// ```
/// use hydrostat_files::{ArmFile, shipped};
/// use hydrostat_sweep::{Plan, Sample, Sweep, SweepOptions};
///
/// let directory = tempfile::tempdir().unwrap();
/// let file = ArmFile::parse(shipped::get("silicone").unwrap(), "silicone").unwrap();
/// let plan = Plan::new(vec!["cable[0].tension=0:1.5:7".parse().unwrap()], Sample::Grid, 0).unwrap();
/// let sweep = Sweep::new(&file, plan, &SweepOptions::default()).unwrap();
/// let out = directory.path().join("out.parquet");
/// let summary = sweep.run(&out, false, 1, &|_| {}).unwrap();
/// // Steps of 0.25 N: from 0.943 N on the cable compresses its side of the tip to zero length.
/// assert_eq!((summary.rows, summary.answered), (7, 4));
/// let table = hydrostat_sweep::Table::read(&out, &["tip_y_m", "verdict"]).unwrap();
/// assert_eq!(table.numbers("tip_y_m").unwrap().len(), 7);
/// ```
#[derive(Debug, Clone)]
pub struct Sweep {
    plan: Plan,
    arms: Arms,
    layout: Layout,
    start: Tile,
    tiles: Range<u64>,
    /// The rows of these tiles that are wanted: all but where there are more shards than tiles.
    rows: Range<u64>,
    options: Options,
    /// Whether to follow the motion after each snap.
    after_snap: bool,
    name: String,
    note: String,
}

/// What is said of a sweep beside its rows.
#[derive(Serialize)]
struct Note<'a> {
    version: &'static str,
    arm: String,
    vary: Vec<Varied<'a>>,
    sample: String,
    seed: u64,
    tol: f64,
    snap_distance: Option<f64>,
    snap_angle: Option<f64>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    after_snap: bool,
    columns: Vec<&'static str>,
    shapes: usize,
    shard: Option<String>,
    rows: Range<u64>,
}

#[derive(Serialize)]
struct Varied<'a> {
    key: &'a str,
    column: String,
    unit: &'a str,
    per_si: f64,
    values: String,
}

impl Sweep {
    /// Of the arm of `file`, checked as far as it can be without solving.
    ///
    /// # Errors
    /// [`SweepError`]: a key that the arm file does not have, a value that makes no arm, a tolerance or shard out of range.
    pub fn new(file: &ArmFile, plan: Plan, options: &SweepOptions) -> Result<Self, SweepError> {
        let arms = Arms::new(file, plan.axes())?;
        let layout = Layout::new(&options.outputs, arms.base(), options.stations);
        // Where motions are followed every snap is one.
        let every = SnapBounds { distance: 0.0, angle: 0.0 };
        let snaps = if options.after_snap { every } else { options.snaps };
        let each = Options { snaps, ..Options::with_tol(options.tol) };
        let start = Tile::new(each, layout.wanted())?;
        let (tiles, rows) = match options.shard {
            None => (0..plan.tiles(), 0..plan.rows()),
            Some(shard) => tiles_and_rows(&plan, shard)?,
        };
        let note = note(&plan, &arms, &layout, options, &rows);
        let name = arms.base().name.clone();
        let after_snap = options.after_snap;
        Ok(Self { plan, arms, layout, start, tiles, rows, options: each, after_snap, name, note })
    }

    /// The name of the arm.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The rows of this sweep, or of this shard of it.
    pub fn rows(&self) -> Range<u64> {
        self.rows.clone()
    }

    /// The rows of some tiles that are wanted.
    fn rows_of(&self, tiles: &Range<u64>) -> Range<u64> {
        common(&self.rows, &rows_of(&self.plan, tiles))
    }

    /// The tiles of this sweep, or of this shard of it. Rows of different tiles do not depend on each other.
    pub fn tiles(&self) -> Range<u64> {
        self.tiles.clone()
    }

    /// The arm and all that the rows depend on, as JSON.
    pub fn note(&self) -> &str {
        &self.note
    }

    /// Solves all rows that are not there yet and writes `output`, whose name ends in `.csv`, or else is Parquet. With `resume`, goes
    /// on with what an earlier run has left. `threads` of 0 are as many as the machine has. `done` hears how many
    /// rows are solved or were found, from several threads.
    ///
    /// # Errors
    /// [`SweepError`]; whole parts stay where they are, to go on from.
    pub fn run(
        &self,
        output: &Path,
        resume: bool,
        threads: usize,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<Summary, SweepError> {
        let go_on = |rows| {
            done(rows);
            true
        };
        self.run_while(output, resume, threads, &go_on)
    }

    /// [`Sweep::run`] that ends soon after `go_on`, which hears what `done` does there, is false.
    ///
    /// # Errors
    /// [`SweepError`], that of an end on request being [`SweepError::Stopped`].
    pub fn run_while(
        &self,
        output: &Path,
        resume: bool,
        threads: usize,
        go_on: &(dyn Fn(u64) -> bool + Sync),
    ) -> Result<Summary, SweepError> {
        let format = Format::of(output).unwrap_or(Format::Parquet);
        let rows = self.rows();
        if output.exists() {
            self.is_ended(output, resume, format)?;
            let count = rows.end - rows.start;
            let (answered, warnings) = (answered(output)?, warnings(output)?);
            return Ok(Summary { rows: count, answered, resumed: count, damaged: 0, warnings });
        }
        if format == Format::Csv && csv_file::note(output)?.is_some_and(|note| note != self.note) {
            return Err(SweepError::Exists { path: csv_file::beside(output) });
        }
        let parts = Parts::open(output, &self.note, resume, format.ending())?;
        let tiles = self.parts();
        let (present, damaged) = parts.present(tiles.len())?;
        let resumed = present.iter().zip(&tiles).filter(|(part, _)| part.is_some()).map(|(_, tiles)| {
            let rows = self.rows_of(tiles);
            rows.end - rows.start
        });
        let resumed: u64 = resumed.sum();
        let count = AtomicU64::new(resumed);
        let stopped = AtomicBool::new(false);
        let go_on = |rows| {
            let on = go_on(rows);
            stopped.fetch_or(!on, Ordering::Relaxed);
            on
        };
        go_on(resumed);
        let solve = |(index, (present, tiles)): (usize, (Option<Part>, &Range<u64>))| match present {
            Some(part) => Ok(part),
            None if stopped.load(Ordering::Relaxed) => Err(SweepError::Stopped),
            None => {
                self.part(index, tiles, &parts, format, &|rows| go_on(count.fetch_add(rows, Ordering::Relaxed) + rows))
            }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let written: Vec<Part> = pool.install(|| {
            present.into_par_iter().zip(&tiles).enumerate().with_max_len(1).map(solve).collect::<Result<_, _>>()
        })?;
        for part in &written {
            if !part.is_intact()? {
                return Err(SweepError::Damaged { path: part.path.clone() });
            }
        }
        let paths: Vec<PathBuf> = written.iter().map(|part| part.path.clone()).collect();
        let columns = self.layout.columns(self.plan.axes());
        let mut warnings = BTreeMap::new();
        if let Some(index) = columns.iter().position(|column| column.name == WARNINGS) {
            for path in &paths {
                count_kinds(&words_of_part(path, index, format)?, &mut warnings);
            }
        }
        if format == Format::Csv {
            write_whole(csv_file::beside(output), self.note.as_bytes())?;
        }
        write_whole_with(output, |file| match format {
            Format::Parquet => {
                let notes = [
                    ("hydrostat.version", env!("CARGO_PKG_VERSION").to_owned()),
                    ("hydrostat.arm", arm_to_toml(self.arms.base())),
                    (NOTE, self.note.clone()),
                ];
                parquet_file::join(&paths, &columns, &notes, output, file)
            }
            Format::Csv => csv_file::join(&paths, &columns, output, file),
        })?;
        parts.remove()?;
        let answered = written.iter().map(|part| part.answered).sum();
        Ok(Summary { rows: rows.end - rows.start, answered, resumed, damaged, warnings })
    }

    /// An output that is there is the end of this sweep, or in the way.
    fn is_ended(&self, output: &Path, resume: bool, format: Format) -> Result<(), SweepError> {
        let exists = || SweepError::Exists { path: output.to_owned() };
        if !resume {
            return Err(exists());
        }
        // A kill between the renaming and the removal leaves both.
        if crate::parts::directory(output).exists() {
            return Parts::open(output, &self.note, true, format.ending())?.remove();
        }
        match noted(output, format)? {
            Some(note) if note == self.note => Ok(()),
            Some(note) => Err(SweepError::Other { path: output.to_owned(), what: difference(&note, &self.note) }),
            // It does not say what it is of.
            None => Err(exists()),
        }
    }

    /// The tiles of each part.
    fn parts(&self) -> Vec<Range<u64>> {
        let rows = self.rows();
        let count = rows.end - rows.start;
        let width = self.layout.columns(self.plan.axes()).len() as u64;
        let size = (count / PARTS).clamp(1, LONGEST).min(LARGEST / width);
        let mut out: Vec<Range<u64>> = Vec::new();
        let mut start = self.tiles.start;
        while start < self.tiles.end {
            let mut end = start + 1;
            let first = self.plan.tile(start).start;
            while end < self.tiles.end && self.plan.tile(end).end - first <= size {
                end += 1;
            }
            out.push(start..end);
            start = end;
        }
        out
    }

    fn part(
        &self,
        index: usize,
        tiles: &Range<u64>,
        parts: &Parts,
        format: Format,
        go_on: &(dyn Fn(u64) -> bool + Sync),
    ) -> Result<Part, SweepError> {
        let columns = self.whole_columns(tiles, go_on)?;
        let bytes = match format {
            Format::Parquet => {
                parquet_file::part(&columns).map_err(|error| parquet_error(Path::new("a part"), error))?
            }
            Format::Csv => csv_file::part(&columns),
        };
        parts.write(index, without_verdict(&columns), &bytes)
    }

    /// Solves some of the tiles on the threads of rayon's current pool: the rows as columns, for those who keep them elsewhere than in a
    /// file of [`Sweep::run`]. `go_on` hears of every row that is done how many these are; when it is false, the rows not yet begun are
    /// left out, with their tiles.
    pub fn columns(&self, tiles: &Range<u64>, go_on: &(dyn Fn(u64) -> bool + Sync)) -> Vec<Column> {
        let stopped = AtomicBool::new(false);
        let row_done = |row: u64| {
            if !go_on(u64::from(self.rows.contains(&row))) {
                stopped.store(true, Ordering::Relaxed);
            }
            !stopped.load(Ordering::Relaxed)
        };
        let solve = |tile| {
            if stopped.load(Ordering::Relaxed) { None } else { self.tile(tile, &row_done) }
                .unwrap_or((0..0, Vec::new()))
        };
        let solved: Vec<(Range<u64>, Vec<Answered>)> = tiles.clone().into_par_iter().map(solve).collect();
        let mut columns: Vec<Column> = self.layout.columns(self.plan.axes());
        for (rows, answers) in solved {
            for (row, answer) in rows.zip(&answers).filter(|(row, _)| self.rows.contains(row)) {
                self.layout.add(&mut columns, row, &self.plan.values(row), answer);
            }
        }
        columns
    }

    /// Solves some of the tiles as [`Sweep::columns`] does and writes them as one Parquet file, which appears whole or not at all. How
    /// many rows it has, and how many of them have an answer.
    ///
    /// # Errors
    /// [`SweepError::Write`], [`SweepError::Stopped`].
    pub fn write_tiles(
        &self,
        tiles: &Range<u64>,
        output: &Path,
        go_on: &(dyn Fn(u64) -> bool + Sync),
    ) -> Result<(u64, u64), SweepError> {
        let columns = self.whole_columns(tiles, go_on)?;
        let bytes = parquet_file::part(&columns).map_err(|error| parquet_error(output, error))?;
        write_whole(output, &bytes)?;
        Ok((columns[0].data.len() as u64, without_verdict(&columns)))
    }

    /// The columns of all rows of the tiles.
    fn whole_columns(
        &self,
        tiles: &Range<u64>,
        go_on: &(dyn Fn(u64) -> bool + Sync),
    ) -> Result<Vec<Column>, SweepError> {
        let columns = self.columns(tiles, go_on);
        let rows = self.rows_of(tiles);
        let whole = columns.iter().all(|column| column.data.len() as u64 == rows.end - rows.start);
        if whole { Ok(columns) } else { Err(SweepError::Stopped) }
    }

    /// The rows of a tile with what became of each; `None` where `row_done`, which hears of each row, is false.
    fn tile(&self, tile: u64, row_done: &dyn Fn(u64) -> bool) -> Option<(Range<u64>, Vec<Answered>)> {
        let rows = self.plan.tile(tile);
        let mut solver = self.start.clone();
        let mut last = Last::default();
        let mut solved: Vec<(u64, Answered)> = Vec::new();
        for row in self.plan.order(tile) {
            let arm = self.arms.arm(&self.plan.values(row), &mut last);
            let asked = arm.as_ref().map_or(f64::INFINITY, |arm| self.options.tol * arm.length);
            let answer = arm.map_err(NoAnswer::Arm).and_then(|arm| self.answer(arm, &mut solver));
            solved.push((row, Answered { answer, asked }));
            // A tile that is done is kept.
            if !row_done(row) && (solved.len() as u64) < rows.end - rows.start {
                return None;
            }
        }
        solved.sort_unstable_by_key(|(row, _)| *row);
        Some((rows, solved.into_iter().map(|(_, answer)| answer).collect()))
    }
}

impl Sweep {
    /// What becomes of a row of a tile.
    fn answer(&self, arm: &Arm, tile: &mut Tile) -> Answer {
        let in_space = arm.space.is_some();
        if in_space != self.layout.is_spatial() {
            // Their columns differ.
            return Err(NoAnswer::Arm(
                "`arm.space`: expected the same in all rows; give it in the arm file".to_owned(),
            ));
        }
        let found =
            if in_space { tile.space.next(arm).map(AnyRow::from) } else { tile.plane.next(arm).map(AnyRow::from) };
        match found {
            Err(NoRow::Verdict(verdict)) if self.after_snap && verdict.kind == VerdictKind::LimitPoint => {
                let after_snap = if in_space { solve_after_snap_in_space } else { solve_after_snap };
                after_snap(arm, self.options.tol, self.layout.wanted(), verdict)
            }
            found => Ok(found?),
        }
    }
}

/// How many rows have an answer.
fn without_verdict(columns: &[Column]) -> u64 {
    let verdicts = columns.iter().find(|column| column.name == "verdict").map(|column| &column.data);
    match verdicts {
        Some(Data::Text(words)) => words.iter().filter(|word| word.is_none()).count() as u64,
        _ => 0,
    }
}

/// How many rows of a whole output have an answer.
fn answered(output: &Path) -> Result<u64, SweepError> {
    let table = crate::table::Table::read(output, &["verdict"])?;
    Ok(table.words("verdict").map_or(0, |words| words.iter().filter(|word| word.is_none()).count() as u64))
}

/// The words of a column of a part, by its index.
fn words_of_part(path: &Path, index: usize, format: Format) -> Result<Vec<Option<String>>, SweepError> {
    if format == Format::Csv {
        return csv_file::words_of_part(path, index);
    }
    match Reader::open(path)?.column(WARNINGS)?.map(|column| column.data) {
        Some(Data::Text(words)) => Ok(words),
        _ => Ok(Vec::new()),
    }
}

/// The kinds of warnings of a whole output.
fn warnings(output: &Path) -> Result<BTreeMap<String, u64>, SweepError> {
    let mut out = BTreeMap::new();
    let table = crate::table::Table::read(output, &[WARNINGS])?;
    count_kinds(&table.words(WARNINGS).unwrap_or_default(), &mut out);
    Ok(out)
}

/// Adds the kinds of some rows to those counted before.
fn count_kinds(rows: &[Option<String>], counts: &mut BTreeMap<String, u64>) {
    for kind in rows.iter().flatten().flat_map(|kinds| kinds.split(' ')) {
        *counts.entry(kind.to_owned()).or_default() += 1;
    }
}

fn note(plan: &Plan, arms: &Arms, layout: &Layout, options: &SweepOptions, rows: &Range<u64>) -> String {
    let vary = plan.axes().iter().map(|axis| Varied {
        key: &axis.key,
        column: axis.column(),
        unit: axis.unit,
        per_si: axis.per_si(),
        values: format!("{:?}", axis.values),
    });
    let note = Note {
        version: env!("CARGO_PKG_VERSION"),
        arm: arm_to_toml(arms.base()),
        vary: vary.collect(),
        sample: plan.sample().to_string(),
        seed: plan.seed(),
        tol: options.tol,
        // Without bounds these are null.
        snap_distance: Some(options.snaps.distance).filter(|bound| bound.is_finite()),
        snap_angle: Some(options.snaps.angle).filter(|bound| bound.is_finite()),
        after_snap: options.after_snap,
        columns: layout.outputs().iter().map(|output| output.name()).collect(),
        shapes: options.stations,
        shard: options.shard.map(|shard| format!("{}/{}", shard.index, shard.of)),
        rows: rows.clone(),
    };
    // A structure of plain fields always becomes JSON.
    serde_json::to_string_pretty(&note).unwrap_or_default()
}
