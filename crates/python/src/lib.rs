//! The extension module `hydrostat._native` of the Python package: thin classes over the library, which `python/hydrostat` dresses.
//!
//! Numbers cross as NumPy arrays, without copies where they are a solution's; errors become Python's exceptions in `errors`; the
//! interpreter is let go of while anything is solved, and long calls look for Ctrl-C (`interrupt`).

mod arm;
mod arm_class;
mod arrays;
mod errors;
mod figure;
mod history;
mod identification;
mod interrupt;
mod many;
mod modes;
mod motion;
mod order;
mod paths;
mod reach;
mod sensitivity;
mod solution;
mod solver;
mod spatial_solution;
mod spatial_solver;
mod sweep;
mod wrong;

use pyo3::prelude::*;

/// The module.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::arm::{Arm, bare_unit, shipped, shipped_names};
    #[pymodule_export]
    use super::figure::{Figure, curve_figure, map_figure, source_figures, workspace_figure};
    #[pymodule_export]
    use super::history::{History, history};
    #[pymodule_export]
    use super::identification::{Fit, identify, measurements_template};
    #[pymodule_export]
    use super::many::{parameter_names, solve_many};
    #[pymodule_export]
    use super::modes::{Modes, modes};
    #[pymodule_export]
    use super::motion::{Simulation, motion_figures};
    #[pymodule_export]
    use super::paths::{Equilibria, Path, equilibria, over_figure, path};
    #[pymodule_export]
    use super::reach::{Boundary, Follower, Reach, reach, reachable};
    #[pymodule_export]
    use super::sensitivity::{Sensitivities, SpatialSensitivities, ellipse};
    #[pymodule_export]
    use super::solution::{Solution, Stations, angle};
    #[pymodule_export]
    use super::solver::Solver;
    #[pymodule_export]
    use super::spatial_solution::{SpatialSolution, Stations as SpatialStations};
    #[pymodule_export]
    use super::spatial_solver::SpatialSolver;
    #[pymodule_export]
    use super::sweep::Sweep;

    use numpy::{PyArray1, PyArrayMethods};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // NumPy's interface is looked up at its first use: Ctrl-C in the midst of that would be a panic.
        let _ = PyArray1::<f64>::zeros(module.py(), 0, false).readonly();
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
