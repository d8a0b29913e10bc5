//! Small motions about an equilibrium.

use hydrostat::{Mode, ModeSection, ModeShape, SpatialTip};
use hydrostat_figures::{Page, mode_shapes_figure, root_locus_figure};
use hydrostat_files::{ModesDocument, mode_kind, mode_shapes_csv, modes_csv};
use numpy::PyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arm_class::Arm;
use crate::arrays::given;
use crate::errors::motion_error;
use crate::figure::Figure;

#[derive(Clone)]
enum Found {
    Plane(hydrostat::Modes),
    Space(hydrostat::Modes<SpatialTip>),
}

/// The same of modes in the plane and in space.
macro_rules! of {
    ($found:expr, $own:ident => $what:expr) => {
        match $found {
            Found::Plane($own) => $what,
            Found::Space($own) => $what,
        }
    };
}

/// The slowest motions about an equilibrium.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Modes {
    arm: hydrostat::Arm,
    found: Found,
}

/// The `count` slowest motions about the equilibrium of an arm.
#[pyfunction]
pub(crate) fn modes(py: Python<'_>, arm: &Arm, count: usize, elements: usize) -> PyResult<Modes> {
    let arm = arm.given.clone();
    let found = py.detach(|| {
        if arm.space.is_some() {
            arm.modes_in_space(count, elements).map(Found::Space)
        } else {
            arm.modes(count, elements).map(Found::Plane)
        }
    });
    Ok(Modes { found: found.map_err(|error| motion_error(py, error))?, arm })
}

impl Modes {
    fn all(&self) -> &[Mode] {
        of!(&self.found, own => &own.modes)
    }

    fn shapes(&self) -> &[ModeShape] {
        of!(&self.found, own => &own.shapes)
    }

    fn sections(&self) -> &[ModeSection] {
        of!(&self.found, own => &own.sections)
    }
}

#[pymethods]
impl Modes {
    /// Real and imaginary part of each rate, and what the mode does.
    #[getter]
    fn rates(&self) -> Vec<(f64, f64, &'static str)> {
        self.all().iter().map(|mode| (mode.rate[0], mode.rate[1], mode_kind(mode))).collect()
    }

    #[getter]
    fn stable(&self) -> bool {
        of!(&self.found, own => own.is_stable())
    }

    #[getter]
    fn is_spatial(&self) -> bool {
        matches!(self.found, Found::Space(_))
    }

    /// s, and place and directors a, b, c in the equilibrium, station by station: 13 numbers each.
    fn stations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let numbers = |at: &ModeSection| {
            [at.s].into_iter().chain(at.place).chain(at.directors.into_iter().flatten()).collect::<Vec<_>>()
        };
        given(py, self.sections().iter().flat_map(numbers).collect())
    }

    /// Displacement and turn of a mode, real and imaginary part of three components each, station by station.
    fn shape<'py>(&self, py: Python<'py>, mode: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let Some(shape) = self.shapes().get(mode) else { return Err(PyIndexError::new_err("mode: there is none")) };
        let numbers = |at: &hydrostat::ModeStation| at.displacement.into_iter().chain(at.turn).flatten();
        Ok(given(py, shape.iter().flat_map(numbers).collect()))
    }

    /// The rates in the complex plane.
    fn figure(&self, title: &str) -> Figure {
        Figure::new(root_locus_figure(&[(0.0, self.all())], None, title, &Page::default()))
    }

    /// The shapes of the first modes.
    fn shapes_figure(&self, title: &str) -> Figure {
        let page = Page::default();
        Figure::new(of!(&self.found, own => mode_shapes_figure(&self.arm, own, title, &page)))
    }

    fn to_json(&self) -> String {
        of!(&self.found, own => ModesDocument::new(&self.arm, own).to_json())
    }

    fn to_csv(&self) -> String {
        of!(&self.found, own => modes_csv(own))
    }

    fn shapes_csv(&self) -> String {
        of!(&self.found, own => mode_shapes_csv(own))
    }
}
