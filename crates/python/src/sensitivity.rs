//! Derivatives of an equilibrium.

use hydrostat::{Arm, Ellipse, Ellipsoid, Parameter, PoseChange, SensitivityMethod, SpatialPoseChange, SpatialWrench};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays::given;
use crate::errors::wrong;

/// Derivatives by parameters, in their order.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Sensitivities {
    found: hydrostat::Sensitivities,
}

/// A column of numbers.
type Numbers<'py> = Bound<'py, PyArray1<f64>>;

/// Changes of x, y, theta and alpha.
type Poses<'py> = [Numbers<'py>; 4];

/// Half axes and direction.
type EllipseFields = ([f64; 2], f64);

impl Sensitivities {
    pub(crate) fn new(found: hydrostat::Sensitivities) -> Self {
        Self { found }
    }
}

/// The parameters of these names, or all that the arm has.
pub(crate) fn parameters(names: Option<Vec<String>>, arm: &Arm) -> PyResult<Vec<Parameter>> {
    let Some(names) = names else { return Ok(Parameter::all_of(arm)) };
    names.iter().map(|name| name.parse().map_err(|error| wrong(format!("parameters: {error}")))).collect()
}

pub(crate) fn method(name: &str) -> PyResult<SensitivityMethod> {
    Ok(match name {
        "best" => SensitivityMethod::Best,
        "forward" => SensitivityMethod::Forward,
        "adjoint" => SensitivityMethod::Adjoint,
        _ => return Err(wrong(format!("method: expected best, forward or adjoint, found {name:?}"))),
    })
}

fn poses<'py>(py: Python<'py>, changes: &[PoseChange]) -> Poses<'py> {
    let column = |of: fn(&PoseChange) -> f64| given(py, changes.iter().map(of).collect());
    [column(|c| c.x), column(|c| c.y), column(|c| c.theta), column(|c| c.alpha)]
}

fn fields(ellipse: Ellipse) -> EllipseFields {
    (ellipse.half_axes, ellipse.direction)
}

#[pymethods]
impl Sensitivities {
    /// Names and units.
    #[getter]
    fn parameters(&self) -> Vec<(String, &'static str)> {
        self.found.parameters.iter().map(|parameter| (parameter.to_string(), parameter.unit())).collect()
    }

    /// Of the tip, a number a parameter.
    fn tip<'py>(&self, py: Python<'py>) -> Poses<'py> {
        poses(py, &self.found.tip)
    }

    /// Of the strokes, cable after cable.
    fn strokes<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        given(py, self.found.strokes.concat())
    }

    /// Of the tensions, cable after cable.
    fn tensions<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        given(py, self.found.tensions.concat())
    }

    /// Of the places asked for, one after the other.
    fn stations<'py>(&self, py: Python<'py>) -> Poses<'py> {
        let all: Vec<PoseChange> = self.found.stations.iter().flat_map(|station| station.changes.clone()).collect();
        poses(py, &all)
    }

    fn compliance(&self) -> Option<[[f64; 3]; 3]> {
        self.found.compliance()
    }

    fn manipulability(&self) -> Option<EllipseFields> {
        self.found.manipulability().map(fields)
    }
}

/// Derivatives of an arm in space by parameters, in their order.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct SpatialSensitivities {
    found: hydrostat::Sensitivities<SpatialPoseChange, SpatialWrench>,
}

/// Changes of x, y, z, and turns about e1, e2, e3.
type PosesInSpace<'py> = [Numbers<'py>; 6];

/// Half axes and directions.
type EllipsoidFields = ([f64; 3], [[f64; 3]; 3]);

impl SpatialSensitivities {
    pub(crate) fn new(found: hydrostat::Sensitivities<SpatialPoseChange, SpatialWrench>) -> Self {
        Self { found }
    }
}

fn poses_in_space<'py>(py: Python<'py>, changes: &[SpatialPoseChange]) -> PosesInSpace<'py> {
    std::array::from_fn(|k| {
        let part = |c: &SpatialPoseChange| if k < 3 { c.place[k] } else { c.turn[k - 3] };
        given(py, changes.iter().map(part).collect())
    })
}

#[pymethods]
impl SpatialSensitivities {
    /// Names and units.
    #[getter]
    fn parameters(&self) -> Vec<(String, &'static str)> {
        self.found.parameters.iter().map(|parameter| (parameter.to_string(), parameter.unit())).collect()
    }

    /// Of the tip, a number a parameter.
    fn tip<'py>(&self, py: Python<'py>) -> PosesInSpace<'py> {
        poses_in_space(py, &self.found.tip)
    }

    /// Of the strokes, cable after cable.
    fn strokes<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        given(py, self.found.strokes.concat())
    }

    /// Of the tensions, cable after cable.
    fn tensions<'py>(&self, py: Python<'py>) -> Numbers<'py> {
        given(py, self.found.tensions.concat())
    }

    /// Of the places asked for, one after the other.
    fn stations<'py>(&self, py: Python<'py>) -> PosesInSpace<'py> {
        let all: Vec<SpatialPoseChange> =
            self.found.stations.iter().flat_map(|station| station.changes.clone()).collect();
        poses_in_space(py, &all)
    }

    fn compliance(&self) -> Option<[[f64; 6]; 6]> {
        self.found.compliance()
    }

    fn manipulability(&self) -> Option<EllipsoidFields> {
        self.found.manipulability().map(|Ellipsoid { half_axes, directions }| (half_axes, directions))
    }
}

/// The ellipse of a jacobian, given by its columns.
#[pyfunction]
pub(crate) fn ellipse(columns: Vec<[f64; 2]>) -> EllipseFields {
    fields(Ellipse::of(&columns))
}
