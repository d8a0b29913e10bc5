//! Many arms that differ in a few numbers, each answered with a few numbers.

use std::sync::atomic::Ordering;

use hydrostat::parameter::names;
use hydrostat::{ManyOptions, NoRow, Parameter, Row, Wanted};
use hydrostat_files::Dimension;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::wrong;
use crate::interrupt::interruptible;
use crate::solution::words;

/// Tiles a thread that are solved between two looks at whether to go on.
const TILES: usize = 8;

type Answer = Result<Row, NoRow>;

/// The names of what can vary, those of cables with the index 0.
#[pyfunction]
pub(crate) fn parameter_names() -> Vec<String> {
    names()
}

/// Solves `arm` with the values of `keys`, a column each (angles in degrees), row by row.
#[pyfunction]
#[pyo3(signature = (arm, keys, columns, rows, tol, tile, strokes, fold_margin, stability, stations))]
#[expect(clippy::too_many_arguments, reason = "one call of a private function")]
pub(crate) fn solve_many<'py>(
    py: Python<'py>,
    arm: &Arm,
    keys: Vec<String>,
    columns: Vec<PyReadonlyArray1<'py, f64>>,
    rows: usize,
    tol: f64,
    tile: usize,
    strokes: bool,
    fold_margin: bool,
    stability: bool,
    stations: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let mut varied: Vec<(Parameter, Vec<f64>)> = Vec::new();
    for (key, column) in keys.iter().zip(&columns) {
        let parameter: Parameter = key.parse().map_err(wrong)?;
        parameter.of(&arm.given).map_err(wrong)?;
        let si = |value: &f64| if parameter.unit() == "rad" { Dimension::Angle.bare(*value) } else { *value };
        varied.push((parameter, column.as_array().iter().map(si).collect()));
    }
    let wanted = Wanted { strokes, fold_margin, stability, stations };
    let options = ManyOptions { tol, tile, wanted };
    let chunk = tile.max(1) * TILES * rayon::current_num_threads();
    let base = &arm.given;
    let answers = interruptible(
        py,
        |_| Ok(()),
        |stop| -> Result<Vec<Answer>, hydrostat::SolveError> {
            let mut answers = Vec::with_capacity(rows);
            let mut start = 0;
            // At least once, so that options are looked at.
            while (start < rows || start == 0) && !stop.load(Ordering::Relaxed) {
                let arms: Vec<hydrostat::Arm> =
                    (start..rows.min(start + chunk)).map(|row| arm_of(base, &varied, row)).collect();
                answers.extend(hydrostat::solve_many(&arms, &options)?);
                start += chunk;
            }
            Ok(answers)
        },
    )?;
    columns_of(py, &answers.map_err(wrong)?, base.cables.len(), wanted)
}

fn arm_of(base: &hydrostat::Arm, varied: &[(Parameter, Vec<f64>)], row: usize) -> hydrostat::Arm {
    let mut arm = base.clone();
    for (parameter, values) in varied {
        // The arm was seen to have it.
        let _ = parameter.set(&mut arm, values[row]);
    }
    arm
}

fn columns_of<'py>(py: Python<'py>, answers: &[Answer], cables: usize, wanted: Wanted) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    let numbers = |of: &dyn Fn(&Row) -> f64| -> Vec<f64> {
        answers.iter().map(|answer| answer.as_ref().map_or(f64::NAN, of)).collect()
    };
    let put = |name: &str, values: Vec<f64>| out.set_item(name, given(py, values));
    put("tip_x", numbers(&|row| row.tip.x))?;
    put("tip_y", numbers(&|row| row.tip.y))?;
    put("tip_theta", numbers(&|row| row.tip.theta))?;
    put("tip_alpha", numbers(&|row| row.tip.alpha))?;
    put("base_force_x", numbers(&|row| row.base_reaction.force[0]))?;
    put("base_force_y", numbers(&|row| row.base_reaction.force[1]))?;
    put("base_moment", numbers(&|row| row.base_reaction.moment))?;
    put("error_estimate", numbers(&|row| row.error_estimate))?;
    let flat = |count: usize, of: &dyn Fn(&Row) -> Vec<f64>| -> Vec<f64> {
        let cells = |answer: &Answer| {
            let mut cells = answer.as_ref().map_or_else(|_| Vec::new(), of);
            cells.resize(count, f64::NAN);
            cells
        };
        answers.iter().flat_map(cells).collect()
    };
    put("tension", flat(cables, &|row| row.tensions.clone()))?;
    if wanted.strokes {
        put("stroke", flat(cables, &|row| row.strokes.clone()))?;
    }
    if wanted.fold_margin {
        put("fold_margin", numbers(&|row| row.fold_margin.map_or(f64::NAN, |fold| fold.value)))?;
    }
    if wanted.stations >= 2 {
        put("x", flat(wanted.stations, &|row| row.stations.x.clone()))?;
        put("y", flat(wanted.stations, &|row| row.stations.y.clone()))?;
        put("theta", flat(wanted.stations, &|row| row.stations.theta.clone()))?;
    }
    if wanted.stability {
        let state = |answer: &Answer| answer.as_ref().ok().and_then(|row| words(row.stability).0).unwrap_or_default();
        out.set_item("stability", answers.iter().map(state).collect::<Vec<_>>())?;
    }
    let verdict = |answer: &Answer| match answer {
        Ok(_) => "",
        Err(NoRow::Verdict(verdict)) => verdict.kind.name(),
        Err(NoRow::Arm(_)) => hydrostat_sweep::NO_ARM,
    };
    out.set_item("verdict", answers.iter().map(verdict).collect::<Vec<_>>())?;
    let fraction = |answer: &Answer| match answer {
        Err(NoRow::Verdict(verdict)) => verdict.load_fraction,
        _ => f64::NAN,
    };
    put("load_fraction", answers.iter().map(fraction).collect())?;
    Ok(out)
}
