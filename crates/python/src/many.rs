//! Many arms that differ in a few numbers, each answered with a few numbers.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use hydrostat::parameter::names;
use hydrostat::{
    ArmError, NoRow, Options, Parameter, PoseChange, Row, SensitivityOptions, SolveError, Solver, Tile, Wanted,
};
use hydrostat_files::Dimension;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::wrong;
use crate::interrupt::interruptible;
use crate::order::order;
use crate::solution::{options, words};
use crate::sweep::say;

/// Rows that are ordered at a time: some tens of milliseconds, in which Ctrl-C is not heard.
const BLOCK: usize = 1 << 17;
/// The word for a row whose numbers are none.
const NOT_A_NUMBER: &str = "not_a_number";

/// The derivatives of a row: of x, y, theta and alpha at the tip, then of each cable's stroke, by the parameters asked for.
type Gradients = Vec<Vec<f64>>;

/// What a row is answered with.
enum Answer {
    /// With the kinds of its warnings.
    Row(Box<Row>, Option<Gradients>, String),
    No(NoRow),
}

/// What is varied, and what is asked.
struct Request<'a> {
    base: &'a hydrostat::Arm,
    varied: Vec<(Parameter, Vec<f64>)>,
    options: Options,
    tile: usize,
    wanted: Wanted,
    gradients: Vec<Parameter>,
}

/// The names of what can vary, those of cables with the index 0.
#[pyfunction]
pub(crate) fn parameter_names() -> Vec<String> {
    names()
}

/// Solves `arm` with the values of `keys`, a column each (angles in degrees), row by row; rows with NaN are none. So many `threads`, 0 for
/// as many as the machine has; `progress` hears rows that are done.
#[pyfunction]
#[pyo3(signature = (arm, keys, columns, rows, tol, snaps, tile, strokes, fold_margin, stability, warnings, stations, gradients, threads, progress))]
#[expect(clippy::too_many_arguments, clippy::fn_params_excessive_bools, reason = "one call of a private function")]
pub(crate) fn solve_many<'py>(
    py: Python<'py>,
    arm: &Arm,
    keys: Vec<String>,
    columns: Vec<PyReadonlyArray1<'py, f64>>,
    rows: usize,
    tol: f64,
    snaps: (f64, f64),
    tile: usize,
    strokes: bool,
    fold_margin: bool,
    stability: bool,
    warnings: bool,
    stations: usize,
    gradients: Vec<String>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    if arm.given.space.is_some() {
        let what = "`solve_many` (`sweep` takes all arms)";
        return Err(wrong(ArmError::OnlyInPlane { what }));
    }
    let mut varied: Vec<(Parameter, Vec<f64>)> = Vec::new();
    for (key, column) in keys.iter().zip(&columns) {
        let parameter: Parameter = key.parse().map_err(wrong)?;
        parameter.of(&arm.given).map_err(wrong)?;
        let si = |value: &f64| if parameter.unit() == "rad" { Dimension::Angle.bare(*value) } else { *value };
        varied.push((parameter, column.as_array().iter().map(si).collect()));
    }
    let by = |key: &String| -> PyResult<Parameter> {
        let of_gradients = |error: &dyn std::fmt::Display| wrong(format!("gradients: {error}"));
        let parameter: Parameter = key.parse().map_err(|error| of_gradients(&error))?;
        parameter.of(&arm.given).map_err(|error| of_gradients(&error))?;
        Ok(parameter)
    };
    let wanted = Wanted { strokes, fold_margin, stability, warnings, stations };
    let gradients = gradients.iter().map(by).collect::<PyResult<_>>()?;
    let options = options(tol, snaps);
    let request = Request { base: &arm.given, varied, options, tile, wanted, gradients };
    // Options are looked at whatever the rows.
    let start = Tile::new(options, wanted).map_err(wrong)?;
    if tile == 0 {
        let none: SolveError = SolveError::Option { option: "tile", value: 0.0, expected: "at least 1" };
        return Err(wrong(none));
    }
    let done = AtomicU64::new(0);
    let answers = interruptible(
        py,
        |py| say(py, progress.as_ref(), done.load(Ordering::Relaxed)),
        |stop| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
            Ok(pool.install(|| request.answers(&start, rows, &done, stop)))
        },
    )?;
    let answers = answers.map_err(|error: rayon::ThreadPoolBuildError| PyRuntimeError::new_err(error.to_string()))?;
    say(py, progress.as_ref(), rows as u64)?;
    request.columns_of(py, &answers)
}

impl Request<'_> {
    /// The answers of all rows; `None` of those with NaN.
    fn answers(&self, start: &Tile, rows: usize, done: &AtomicU64, stop: &AtomicBool) -> Answers {
        let mut out = Answers { solved: Vec::new(), places: Vec::with_capacity(rows) };
        let tile = |rows: &[usize]| -> Vec<Answer> {
            let mut tile = start.clone();
            let mut differentiated = None;
            let mut arm = self.base.clone();
            let mut out = Vec::with_capacity(rows.len());
            for row in rows {
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                for (parameter, values) in &self.varied {
                    // The arm was seen to have it.
                    let _ = parameter.set(&mut arm, values[*row]);
                }
                out.push(match tile.solve(&arm) {
                    Ok(found) => {
                        let gradients = self.gradients(&mut differentiated, &arm, &found);
                        let kinds = if self.wanted.warnings {
                            hydrostat_sweep::warning_kinds(&found, self.options.tol * arm.length)
                        } else {
                            String::new()
                        };
                        Answer::Row(Box::new(found), gradients, kinds)
                    }
                    Err(no) => Answer::No(no),
                });
                done.fetch_add(1, Ordering::Relaxed);
            }
            out
        };
        let mut from = 0;
        while from < rows && !stop.load(Ordering::Relaxed) {
            let block = from..rows.min(from + BLOCK);
            from = block.end;
            let order = order(&self.varied, block.clone());
            done.fetch_add((block.len() - order.solved.len()) as u64, Ordering::Relaxed);
            let solved: Vec<Vec<Answer>> = order.solved.par_chunks(self.tile).map(tile).collect();
            let before = out.solved.len();
            out.solved.extend(solved.into_iter().flatten());
            out.places.extend(order.places.into_iter().map(|place| place.map(|place| before + place)));
        }
        out
    }

    /// Derivatives about the shape of a row that was found, where there are any.
    fn gradients(&self, kept: &mut Option<Solver>, arm: &hydrostat::Arm, found: &Row) -> Option<Gradients> {
        if self.gradients.is_empty() {
            return None;
        }
        let near = |tip: hydrostat::Tip| {
            (tip.x - found.tip.x).hypot(tip.y - found.tip.y) <= (1e-6 + 10.0 * self.options.tol) * arm.length
        };
        // From the row before where that leads to the shape that the row has.
        let warm = kept
            .as_mut()
            .is_some_and(|solver| solver.set_arm(arm).is_ok() && solver.update().is_ok_and(|answer| near(answer.tip)));
        if !warm {
            let mut solver = Solver::new(arm, self.options).ok()?;
            solver.solve().ok()?;
            *kept = Some(solver);
        }
        let found = kept.as_mut()?.sensitivities_with(&self.gradients, &SensitivityOptions::default()).ok()?;
        let of = |part: fn(&PoseChange) -> f64| -> Vec<f64> { found.tip.iter().map(part).collect() };
        let mut out = vec![of(|tip| tip.x), of(|tip| tip.y), of(|tip| tip.theta), of(|tip| tip.alpha)];
        out.extend(found.strokes);
        Some(out)
    }

    fn columns_of<'py>(&self, py: Python<'py>, answers: &Answers) -> PyResult<Bound<'py, PyDict>> {
        let out = PyDict::new(py);
        let cables = self.base.cables.len();
        let wanted = self.wanted;
        let numbers =
            |of: &dyn Fn(&Row) -> f64| -> Vec<f64> { answers.rows().map(|row| row.map_or(f64::NAN, of)).collect() };
        let put = |name: &str, values: Vec<f64>| out.set_item(name, given(py, values));
        put("tip_x", numbers(&|row| row.tip.x))?;
        put("tip_y", numbers(&|row| row.tip.y))?;
        put("tip_theta", numbers(&|row| row.tip.theta))?;
        put("tip_alpha", numbers(&|row| row.tip.alpha))?;
        put("base_force_x", numbers(&|row| row.base_reaction.force[0]))?;
        put("base_force_y", numbers(&|row| row.base_reaction.force[1]))?;
        put("base_moment", numbers(&|row| row.base_reaction.moment))?;
        put("error_estimate", numbers(&|row| row.error_estimate))?;
        let flat = |count: usize, of: &dyn Fn(&Row) -> &[f64]| -> Vec<f64> {
            let mut cells = Vec::with_capacity(count * answers.places.len());
            for (k, row) in answers.rows().enumerate() {
                cells.extend_from_slice(row.map_or(&[][..], of));
                cells.resize((k + 1) * count, f64::NAN);
            }
            cells
        };
        put("tension", flat(cables, &|row| &row.tensions))?;
        if wanted.strokes {
            put("stroke", flat(cables, &|row| &row.strokes))?;
        }
        if wanted.fold_margin {
            put("fold_margin", numbers(&|row| row.fold_margin.map_or(f64::NAN, |fold| fold.value)))?;
        }
        if wanted.stations >= 2 {
            put("x", flat(wanted.stations, &|row| &row.stations.x))?;
            put("y", flat(wanted.stations, &|row| &row.stations.y))?;
            put("theta", flat(wanted.stations, &|row| &row.stations.theta))?;
        }
        if !self.gradients.is_empty() {
            for (k, name) in ["d_tip_x", "d_tip_y", "d_tip_theta", "d_tip_alpha"].into_iter().enumerate() {
                put(name, answers.derivatives(k, 1, self.gradients.len()))?;
            }
            put("d_stroke", answers.derivatives(4, cables, self.gradients.len()))?;
        }
        if wanted.stability {
            let state = |row: Option<&Row>| row.and_then(|row| words(row.stability).0).unwrap_or_default();
            out.set_item("stability", answers.rows().map(state).collect::<Vec<_>>())?;
        }
        if wanted.warnings {
            let words = |answer: Option<&'_ Answer>| match answer {
                Some(Answer::Row(_, _, kinds)) => kinds.clone(),
                _ => String::new(),
            };
            out.set_item("warnings", answers.all().map(words).collect::<Vec<_>>())?;
        }
        let verdict = |answer: Option<&Answer>| match answer {
            None => NOT_A_NUMBER,
            Some(Answer::Row(..)) => "",
            Some(Answer::No(NoRow::Verdict(verdict))) => verdict.kind.name(),
            Some(Answer::No(NoRow::Arm(_))) => hydrostat_sweep::NO_ARM,
        };
        out.set_item("verdict", answers.all().map(verdict).collect::<Vec<_>>())?;
        let reason = |answer: (usize, Option<&Answer>)| match answer {
            (row, None) => self.not_a_number(row),
            (_, Some(Answer::Row(..))) => String::new(),
            (_, Some(Answer::No(no))) => no.to_string(),
        };
        out.set_item("reason", answers.all().enumerate().map(reason).collect::<Vec<_>>())?;
        let fraction = |answer: Option<&Answer>| match answer {
            Some(Answer::No(NoRow::Verdict(verdict))) => verdict.load_fraction,
            _ => f64::NAN,
        };
        put("load_fraction", answers.all().map(fraction).collect())?;
        Ok(out)
    }

    fn not_a_number(&self, row: usize) -> String {
        let own = self.varied.iter().find(|(_, values)| values[row].is_nan());
        own.map_or_else(String::new, |(parameter, _)| format!("`{parameter}` is not a number"))
    }
}

/// Answers of the rows that were solved, and the place of each row's among them.
struct Answers {
    solved: Vec<Answer>,
    places: Vec<Option<usize>>,
}

impl Answers {
    fn all(&self) -> impl Iterator<Item = Option<&Answer>> {
        self.places.iter().map(|place| place.and_then(|place| self.solved.get(place)))
    }

    fn rows(&self) -> impl Iterator<Item = Option<&Row>> {
        self.all().map(|answer| match answer {
            Some(Answer::Row(row, ..)) => Some(row.as_ref()),
            _ => None,
        })
    }

    /// Derivatives of `count` quantities from the one at `first` on by so many parameters, row by row.
    fn derivatives(&self, first: usize, count: usize, parameters: usize) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.places.len() * count * parameters);
        for answer in self.all() {
            match answer {
                Some(Answer::Row(_, Some(gradients), _)) => {
                    out.extend(gradients[first..first + count].iter().flatten());
                }
                _ => out.resize(out.len() + count * parameters, f64::NAN),
            }
        }
        out
    }
}
