//! Arms: a file's text with what overrides it, and the arm that it means.

use hydrostat::SpatialSolver;
use hydrostat_files::{ArmFile, arm_to_toml, shipped as files};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

pub(crate) use crate::arm_class::Arm;
use crate::arm_class::Setting;
use crate::arrays::finite;
use crate::errors::{file_error, solve_error, spatial_error, wrong};
use crate::motion::after_snap_error;
use crate::solution::{Solution, options};
use crate::spatial_solution::SpatialSolution;

#[pymethods]
impl Arm {
    /// The arm that TOML text means, with overrides. `path` is for messages and the default of the name.
    #[new]
    #[pyo3(signature = (text, path, settings = Vec::new()))]
    fn new(py: Python<'_>, text: String, path: &str, settings: Vec<Setting>) -> PyResult<Self> {
        let mut file = ArmFile::parse(&text, path).map_err(|error| file_error(py, error))?;
        for (option, key, value) in &settings {
            file.set_by(option, key, value).map_err(|error| file_error(py, error))?;
        }
        let given = file.arm().map_err(|error| file_error(py, error))?;
        Ok(Self { file, given, text, settings })
    }

    /// The arm with further overrides, which take the place of earlier ones.
    fn replaced(&self, py: Python<'_>, settings: Vec<Setting>) -> PyResult<Self> {
        let replaced = |old: &Setting| settings.iter().any(|new| new.1 == old.1 || is_other_pull(&new.1, &old.1));
        let mut all: Vec<Setting> = self.settings.iter().filter(|old| !replaced(old)).cloned().collect();
        all.extend(settings);
        Self::new(py, self.text.clone(), self.file.path(), all)
    }

    /// What a pickle takes: text, path and overrides.
    fn parts(&self) -> (&str, &str, Vec<Setting>) {
        (&self.text, self.file.path(), self.settings.clone())
    }

    /// The whole arm as TOML, defaults filled in.
    fn to_toml(&self) -> String {
        arm_to_toml(&self.given)
    }

    #[getter]
    fn name(&self) -> &str {
        &self.given.name
    }

    #[getter]
    fn length(&self) -> f64 {
        self.given.length
    }

    /// The cables' names.
    #[getter]
    fn cables(&self) -> Vec<&str> {
        self.given.cables.iter().map(|cable| cable.name.as_str()).collect()
    }

    /// Whether the stroke of each cable is commanded.
    #[getter]
    fn commanded(&self) -> Vec<bool> {
        self.given.cables.iter().map(|cable| cable.stroke.is_some()).collect()
    }

    /// Whether the arm may leave the plane e1-e2.
    #[getter]
    fn is_spatial(&self) -> bool {
        self.given.space.is_some()
    }

    /// The arm and this one are the same.
    fn same(&self, other: &Self) -> bool {
        self.given == other.given
    }

    /// Solves under these loads; `None` among the strokes leaves a cable its tension. `snaps` is how far the tip may jump (over the length) and
    /// turn (rad) at a snap. A `Solution`, or a `SpatialSolution` of an arm in space.
    #[pyo3(signature = (tensions, strokes, flow_speed, tol, snaps, after_snap))]
    #[allow(clippy::too_many_arguments, reason = "those of Python's function")]
    fn solve(
        &self,
        py: Python<'_>,
        tensions: Option<PyReadonlyArray1<'_, f64>>,
        strokes: Option<Vec<Option<f64>>>,
        flow_speed: Option<f64>,
        tol: f64,
        snaps: (f64, f64),
        after_snap: bool,
    ) -> PyResult<Py<PyAny>> {
        let mut arm = self.given.clone();
        if let Some(tensions) = tensions {
            let tensions = finite("tensions", &tensions, false)?;
            arm.set_tensions(&tensions).map_err(|error| wrong(format!("tensions: {error}")))?;
        }
        if let Some(strokes) = strokes {
            if strokes.len() != arm.cables.len() {
                let (cables, given) = (arm.cables.len(), strokes.len());
                return Err(wrong(format!("strokes: the arm has {cables} cables, {given} strokes were given")));
            }
            for (cable, stroke) in arm.cables.iter_mut().zip(strokes) {
                cable.stroke = stroke.or(cable.stroke);
            }
        }
        if let Some(speed) = flow_speed {
            arm.flow.speed = speed;
        }
        let options = options(tol, snaps);
        if after_snap && arm.space.is_some() {
            let solved = py.detach(|| arm.solve_after_snap_in_space(tol));
            let found = solved.map_err(|error| after_snap_error(py, error, options, spatial_error))?;
            return Ok(Py::new(py, SpatialSolution::after_snap(found, options))?.into_any());
        }
        if after_snap {
            let solved = py.detach(|| arm.solve_after_snap(tol));
            let found = solved.map_err(|error| after_snap_error(py, error, options, solve_error))?;
            return Ok(Py::new(py, Solution::after_snap(found, options))?.into_any());
        }
        if arm.space.is_some() {
            let solved = py.detach(|| SpatialSolver::new(&arm, options)?.solve());
            let found = solved.map_err(|error| spatial_error(py, error, options))?;
            return Ok(Py::new(py, SpatialSolution::new(found, options))?.into_any());
        }
        let solved = py.detach(|| hydrostat::Solver::new(&arm, options)?.solve());
        let found = solved.map_err(|error| solve_error(py, error, options))?;
        Ok(Py::new(py, Solution::new(found, options))?.into_any())
    }
}

/// Whether one key is a cable's stroke and the other its tension: a cable is given by either.
fn is_other_pull(new: &str, old: &str) -> bool {
    let of = |key: &'_ str, name: &str| key.strip_suffix(name).map(str::to_owned);
    let pairs = [(".tension", ".stroke"), (".stroke", ".tension")];
    pairs.iter().any(|(one, other)| of(new, one).is_some_and(|cable| of(old, other) == Some(cable)))
}

/// The unit of a bare number at a key.
#[pyfunction]
pub(crate) fn bare_unit(key: &str) -> Option<&'static str> {
    hydrostat_files::bare_unit(key)
}

/// The text of an arm that ships with the program.
#[pyfunction]
pub(crate) fn shipped(name: &str) -> Option<&'static str> {
    files::get(name)
}

/// Names and descriptions of the arms that ship with the program.
#[pyfunction]
pub(crate) fn shipped_names() -> Vec<(&'static str, &'static str)> {
    files::names()
        .chain(files::spatial_names())
        .map(|name| (name, files::description(name).unwrap_or_default()))
        .collect()
}
