//! Sweeps: plans, and the rows of their tiles.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use hydrostat::SnapBounds;
use hydrostat_files::{Axis, AxisValue, AxisValues};
use hydrostat_sweep::{Column, Data, Output, Plan, Sample, SweepError, SweepOptions};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::{sweep_error, wrong};
use crate::interrupt::interruptible;

/// A sweep that can be run, whole or some of its tiles.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Sweep {
    sweep: hydrostat_sweep::Sweep,
}

#[pymethods]
impl Sweep {
    /// Of an arm over `KEY=VALUES`, as on the command line.
    #[new]
    #[expect(clippy::too_many_arguments, reason = "one call of a private function")]
    fn new(
        arm: &Arm,
        vary: Vec<String>,
        sample: Option<&str>,
        seed: u64,
        tol: f64,
        snaps: (f64, f64),
        columns: Option<Vec<String>>,
        shapes: usize,
        after_snap: bool,
    ) -> PyResult<Self> {
        let axes: Vec<Axis> = vary.iter().map(|text| text.parse().map_err(wrong)).collect::<PyResult<_>>()?;
        let sample = match sample {
            None => Sample::Grid,
            Some(text) => text.parse().map_err(|error| wrong(format!("sample: {error}")))?,
        };
        let plan = Plan::new(axes, sample, seed).map_err(|error| wrong(format!("vary: {error}")))?;
        let snaps = SnapBounds { distance: snaps.0, angle: snaps.1 };
        let mut options = SweepOptions { tol, snaps, after_snap, stations: shapes, ..SweepOptions::default() };
        if let Some(names) = columns {
            let read = |name: &String| name.parse().map_err(|error| wrong(format!("columns: {error}")));
            options.outputs = names.iter().map(read).collect::<PyResult<Vec<Output>>>()?;
        }
        let sweep = hydrostat_sweep::Sweep::new(&arm.file, plan, &options).map_err(sweep_error)?;
        Ok(Self { sweep })
    }

    #[getter]
    fn rows(&self) -> u64 {
        self.sweep.plan().rows()
    }

    #[getter]
    fn tiles(&self) -> u64 {
        self.sweep.plan().tiles()
    }

    /// The first row of a tile, and the one after its last.
    fn tile(&self, tile: u64) -> PyResult<(u64, u64)> {
        let tiles = self.tiles();
        if tile >= tiles {
            return Err(wrong(format!("tile: expected a number below {tiles}, found {tile}")));
        }
        let rows = self.sweep.plan().tile(tile);
        Ok((rows.start, rows.end))
    }

    /// Key, column, unit shown and how many of that unit an SI unit is, of each key that varies.
    #[getter]
    fn axes(&self) -> Vec<(&str, String, &str, f64)> {
        let axis = |axis: &'_ Axis| (axis.column(), axis.unit, axis.per_si());
        let all = self.sweep.plan().axes().iter();
        all.map(|a| {
            let (column, unit, per_si) = axis(a);
            (a.key.as_str(), column, unit, per_si)
        })
        .collect()
    }

    /// The values of a key of a grid, SI numbers or words; `None` of a range to draw from.
    fn values<'py>(&self, py: Python<'py>, axis: usize) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(axis) = self.sweep.plan().axes().get(axis) else { return Ok(None) };
        let count = match (&axis.values, axis.values.count()) {
            (AxisValues::Span { .. }, _) | (_, None) => return Ok(None),
            (_, Some(count)) => count,
        };
        let all = || (0..count).filter_map(|index| axis.value(index));
        if axis.dimension.is_some() {
            let numbers = all().map(|value| if let AxisValue::Number(number) = value { number } else { f64::NAN });
            return Ok(Some(given(py, numbers.collect()).into_any()));
        }
        let words: Vec<&str> =
            all().filter_map(|value| if let AxisValue::Word(word) = value { Some(word) } else { None }).collect();
        Ok(Some(PyList::new(py, words)?.into_any()))
    }

    /// The arm and all that the rows depend on, as JSON.
    #[getter]
    fn note(&self) -> &str {
        self.sweep.note()
    }

    /// Solves tiles on so many threads (0: as many as the machine has). Numbers come as arrays, whole numbers as numbers with NaN for none,
    /// words as codes of a list, -1 for none. `progress` hears rows that are done.
    fn columns<'py>(
        &self,
        py: Python<'py>,
        tiles: (u64, u64),
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        self.check(tiles)?;
        let columns = while_asked(py, threads, progress, |go_on| Ok(self.sweep.columns(&(tiles.0..tiles.1), go_on)))?;
        let out = PyDict::new(py);
        for column in columns {
            put(&out, column)?;
        }
        Ok(out)
    }

    /// Solves tiles into one Parquet file: how many rows it has, and how many of them have an answer.
    fn write_tiles(
        &self,
        py: Python<'_>,
        tiles: (u64, u64),
        output: PathBuf,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(u64, u64)> {
        self.check(tiles)?;
        while_asked(py, threads, progress, |go_on| self.sweep.write_tiles(&(tiles.0..tiles.1), &output, go_on))
    }

    /// The program's own sweep into a Parquet or CSV file: rows, those with an answer, those that were there before, and parts that had
    /// changed since and were solved again.
    fn run(
        &self,
        py: Python<'_>,
        output: PathBuf,
        resume: bool,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(u64, u64, u64, u64)> {
        let done = AtomicU64::new(0);
        let summary = interruptible(
            py,
            |py| say(py, progress.as_ref(), done.load(Ordering::Relaxed)),
            |stop| {
                self.sweep.run_while(&output, resume, threads, &|rows| {
                    done.fetch_max(rows, Ordering::Relaxed);
                    !stop.load(Ordering::Relaxed)
                })
            },
        )?
        .map_err(sweep_error)?;
        say(py, progress.as_ref(), summary.rows)?;
        Ok((summary.rows, summary.answered, summary.resumed, summary.damaged))
    }
}

impl Sweep {
    fn check(&self, (from, to): (u64, u64)) -> PyResult<()> {
        let tiles = self.tiles();
        if from < to && to <= tiles {
            return Ok(());
        }
        Err(wrong(format!("tiles: expected two increasing numbers up to {tiles}, found {from} and {to}")))
    }
}

/// Work on tiles in a pool of its own, which hears Ctrl-C.
fn while_asked<T: Send>(
    py: Python<'_>,
    threads: usize,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&(dyn Fn(u64) -> bool + Sync)) -> Result<T, SweepError> + Send,
) -> PyResult<T> {
    let done = AtomicU64::new(0);
    let worked = interruptible(
        py,
        |py| say(py, progress.as_ref(), done.load(Ordering::Relaxed)),
        |stop| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            pool.install(|| {
                work(&|rows| {
                    done.fetch_add(rows, Ordering::Relaxed);
                    !stop.load(Ordering::Relaxed)
                })
            })
        },
    )?;
    say(py, progress.as_ref(), done.load(Ordering::Relaxed))?;
    worked.map_err(sweep_error)
}

/// Tells `progress` how many rows are done.
pub(crate) fn say(py: Python<'_>, progress: Option<&Py<PyAny>>, rows: u64) -> PyResult<()> {
    if let Some(progress) = progress {
        progress.call1(py, (rows,))?;
    }
    Ok(())
}

/// A column into `out`: numbers, or codes with their words.
fn put(out: &Bound<'_, PyDict>, column: Column) -> PyResult<()> {
    let py = out.py();
    match column.data {
        Data::Number(numbers) => out.set_item(column.name, PyArray1::from_vec(py, numbers)),
        Data::Whole(all) => {
            let numbers = all.into_iter().map(|whole| whole.map_or(f64::NAN, |whole| whole as f64)).collect();
            out.set_item(column.name, PyArray1::from_vec(py, numbers))
        }
        Data::Text(all) => {
            let mut places: HashMap<String, i32> = HashMap::new();
            let mut words: Vec<String> = Vec::new();
            // The place of a word among those met so far; -1 where there is none.
            let code = |word: Option<String>| {
                let Some(word) = word else { return -1 };
                if let Some(place) = places.get(&word) {
                    return *place;
                }
                let place = i32::try_from(words.len()).unwrap_or(-1);
                words.push(word.clone());
                places.insert(word, place);
                place
            };
            let codes: Vec<i32> = all.into_iter().map(code).collect();
            out.set_item(column.name, (PyArray1::from_vec(py, codes), words))
        }
    }
}
