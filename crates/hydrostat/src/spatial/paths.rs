//! Paths of an arm in space over the range of one parameter, by the stepper of the plane.

use super::configuration::SpatialConfiguration;
use super::solve::{SpatialError, SpatialSolver};
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::path::{Path, PathError, PathOptions, PathPoint, ends_of_range, has_a_path, trace};
use crate::statics::solve::Options;

impl Arm {
    /// [`Arm::path`] of an arm in space: the parameter may be a part of a direction or of a load that leaves the plane,
    /// too, and an arm without [`Arm::space`] may leave its plane.
    ///
    /// Two eigenvalues of the stability may pass zero together, as those of a straight column do at Euler's load. The
    /// sign of the determinant stays there; the bifurcation is found by the count of unstable directions.
    ///
    /// ```
    /// use hydrostat::{Arm, Event, Parameter, PathOptions, Space, Stability};
    ///
    /// // A column that is pushed: it buckles to any side.
    /// let mut arm = Arm::cone(0.2, 0.005, 0.005, 1e5, 0.5);
    /// arm.space = Some(Space::default());
    /// let stiffness = std::f64::consts::PI / 4.0 * 1e5 * 0.005_f64.powi(4);
    /// let euler = std::f64::consts::PI.powi(2) * stiffness / (4.0 * 0.2 * 0.2); // N
    /// let path = arm.path_in_space(Parameter::TipForce(0), [0.0, -1.3 * euler], &PathOptions::default()).unwrap();
    /// let points = &path.branches[0].points;
    /// assert!(points.iter().any(|point| point.event == Some(Event::Bifurcation)));
    /// assert_eq!(points[points.len() - 1].stability, Some(Stability::Unstable(2)));
    /// ```
    ///
    /// # Errors
    /// [`PathError`].
    pub fn path_in_space(
        &self,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
    ) -> Result<Path<SpatialConfiguration>, PathError<SpatialError>> {
        self.path_in_space_with(parameter, range, options, |_| true)
    }

    /// [`Arm::path_in_space`] that hands every point to `watch`, see [`Arm::path_with`].
    ///
    /// # Errors
    /// [`PathError`].
    pub fn path_in_space_with(
        &self,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        mut watch: impl FnMut(&PathPoint<SpatialConfiguration>) -> bool,
    ) -> Result<Path<SpatialConfiguration>, PathError<SpatialError>> {
        let mut arm = self.clone();
        arm.space.get_or_insert_default();
        let [first, _] = ends_of_range(&arm, parameter, range, options)?;
        has_a_path(&arm)?;
        let start_error = |source| PathError::Start { parameter, value: range[0], source };
        let mut solver = SpatialSolver::new(&first, Options::with_tol(options.tol.min(1e-8))).map_err(start_error)?;
        solver.solve().map_err(start_error)?;
        let engine = &mut solver.engine;
        engine.allowed = usize::MAX;
        engine.equations.vary(parameter, range[0], range[1]);
        Ok(Path { parameter, range, branches: trace(engine, options, &mut watch) })
    }
}
