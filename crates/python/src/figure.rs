//! Drawings of `hydrostat-figures`.

use hydrostat_figures::source::{Shown, Study};
use hydrostat_figures::{Abscissa, Coloured, ColouredColumn, KeyValues, Page, Quantity, Scene};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arm_class::Arm;
use crate::interrupt::interruptible;
use crate::wrong::wrong;

/// A drawing, as SVG, PDF and PNG.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Figure {
    scene: Scene,
}

impl Figure {
    pub(crate) fn new(scene: Scene) -> Self {
        Self { scene }
    }
}

#[pymethods]
impl Figure {
    fn svg(&self, text: bool) -> String {
        if text { self.scene.svg_with_text() } else { self.scene.svg() }
    }

    fn pdf<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &py.detach(|| self.scene.pdf()))
    }

    fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| self.scene.png()).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn texts(&self) -> Vec<&str> {
        self.scene.texts().collect()
    }
}

/// Name, unit and how many of that unit an SI unit is.
pub(crate) type Axis = (String, String, f64);

pub(crate) fn abscissa((name, unit, per_si): Axis) -> Abscissa {
    Abscissa { name, unit, per_si }
}

pub(crate) fn quantity(name: &str) -> PyResult<Quantity> {
    name.parse().map_err(|error| wrong(format!("quantity: {error}, found {name:?}")))
}

/// Values a row, as colours.
#[derive(FromPyObject)]
pub(crate) enum Colours<'py> {
    Numbers(PyReadonlyArray1<'py, f64>),
    Words(Vec<Option<String>>),
}

fn column(name: String, values: Colours<'_>) -> ColouredColumn {
    let values = match values {
        Colours::Numbers(numbers) => Coloured::Numbers(numbers.as_array().to_vec()),
        Colours::Words(words) => Coloured::Words(words),
    };
    ColouredColumn { name, values }
}

/// A column over two keys.
#[pyfunction]
pub(crate) fn map_figure(
    axes: (Axis, Axis),
    keys: (PyReadonlyArray1<'_, f64>, PyReadonlyArray1<'_, f64>),
    name: String,
    values: Colours<'_>,
    title: &str,
) -> Figure {
    let key = |axis: Axis, values: &PyReadonlyArray1<'_, f64>| KeyValues {
        axis: abscissa(axis),
        values: values.as_array().to_vec(),
    };
    let keys = [key(axes.0, &keys.0), key(axes.1, &keys.1)];
    Figure::new(hydrostat_figures::map_figure(&keys, &column(name, values), title, &Page::default()))
}

/// Places of the tip, of arms in space from three sides.
#[pyfunction]
#[pyo3(signature = (x, y, z, name, values, title))]
pub(crate) fn workspace_figure(
    x: PyReadonlyArray1<'_, f64>,
    y: PyReadonlyArray1<'_, f64>,
    z: Option<PyReadonlyArray1<'_, f64>>,
    name: String,
    values: Colours<'_>,
    title: &str,
) -> Figure {
    let (x, y) = (x.as_array(), y.as_array());
    let (page, column) = (Page::default(), column(name, values));
    let tips = x.iter().zip(y.iter());
    Figure::new(if let Some(z) = z {
        let tips: Vec<[f64; 3]> = tips.zip(z.as_array()).map(|((x, y), z)| [*x, *y, *z]).collect();
        hydrostat_figures::spatial_workspace_figure(&tips, &column, title, &page)
    } else {
        let tips: Vec<[f64; 2]> = tips.map(|(x, y)| [*x, *y]).collect();
        hydrostat_figures::workspace_figure(&tips, &column, title, &page)
    })
}

/// A column over one key.
#[pyfunction]
pub(crate) fn curve_figure(
    axis: Axis,
    key: PyReadonlyArray1<'_, f64>,
    name: &str,
    values: PyReadonlyArray1<'_, f64>,
    title: &str,
) -> Figure {
    let key = KeyValues { axis: abscissa(axis), values: key.as_array().to_vec() };
    let values = values.as_array().to_vec();
    Figure::new(hydrostat_figures::curve_figure(&key, name, &values, title, &Page::default()))
}

/// Name, drawing and CSV of each part of the source's figure; statement, finding and evidence of each claim.
type Parts = (Vec<(&'static str, Figure, String)>, Vec<(&'static str, &'static str, String)>);

/// The source's figure, and what its text says about it.
#[pyfunction]
pub(crate) fn source_figures(py: Python<'_>, arm: &Arm, at_highest: bool, faster: Vec<f64>) -> PyResult<Parts> {
    let shown = Shown { at_highest, faster };
    let study = interruptible(py, |_| Ok(()), |_| Study::of(&arm.given, &shown))?.map_err(wrong)?;
    let figures = study.figures(&Page::default()).map(|figure| (figure.name, Figure::new(figure.scene), figure.csv));
    let claims = study.claims.iter().map(|claim| (claim.statement, claim.finding.words(), claim.evidence.clone()));
    Ok((figures.into(), claims.collect()))
}
