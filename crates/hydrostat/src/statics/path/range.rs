//! Paths that users ask for: equilibria over the range of one parameter, through limit points and bifurcations.

use super::points::{Path, PathError, PathOptions, PathPoint, has_a_path};
use super::trace::{ends_of_range, trace};
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::solve::{Options, Solver};

impl Arm {
    /// Follows the equilibria of this arm while `parameter` runs from `range[0]` towards `range[1]` (units of
    /// [`Parameter::unit`]), by pseudo-arclength continuation: through limit points, where the parameter
    /// turns back, and past bifurcations, until either end of the range is reached.
    ///
    /// The path starts at the configuration that [`Arm::solve`] gives at `range[0]`. The values of limit points and
    /// bifurcations are good to 1e-6 of the range. Cables whose stroke is commanded keep it, or follow it where it is
    /// what varies; where one goes slack or taut the path has a corner, which is an event, and at which the parameter
    /// may turn back.
    ///
    /// ```
    /// use hydrostat::{Arm, Event, Parameter, PathOptions};
    ///
    /// // An arm that lies down the stream, is turned to face it and past it, and then snaps.
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.2;
    /// arm.flow.direction = std::f64::consts::PI;
    /// let path = arm.path(Parameter::BaseAngle, [1.5, -1.5], &PathOptions::default()).unwrap();
    /// let limits = path.branches[0].points.iter().filter(|p| p.event == Some(Event::LimitPoint));
    /// assert_eq!(limits.count(), 4); // into straight and out of it, on both sides
    /// ```
    ///
    /// # Errors
    /// [`PathError`].
    pub fn path(&self, parameter: Parameter, range: [f64; 2], options: &PathOptions) -> Result<Path, PathError> {
        self.path_with(parameter, range, options, |_| true)
    }

    /// [`Arm::path`] that hands every point to `watch` as it is found, and ends after the first for which that is
    /// false: with [`crate::PathEnd::Stopped`], unless that point is the last anyway, and without the branches that
    /// were still to come.
    ///
    /// ```
    /// use hydrostat::{Arm, Parameter, PathEnd, PathOptions};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.1;
    /// let mut points = 0;
    /// let path = arm.path_with(Parameter::BaseAngle, [1.5, -1.5], &PathOptions::default(), |_| {
    ///     points += 1;
    ///     points < 5
    /// });
    /// let branch = &path.unwrap().branches[0];
    /// assert_eq!((branch.points.len(), branch.end), (5, PathEnd::Stopped));
    /// ```
    ///
    /// # Errors
    /// [`PathError`].
    pub fn path_with(
        &self,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        mut watch: impl FnMut(&PathPoint) -> bool,
    ) -> Result<Path, PathError> {
        let [first, _] = ends_of_range(self, parameter, range, options)?;
        has_a_path(self)?;
        let start_error = |source| PathError::Start { parameter, value: range[0], source };
        let mut solver = Solver::new(&first, Options::with_tol(options.tol.min(1e-8))).map_err(start_error)?;
        solver.solve().map_err(start_error)?;
        let engine = solver.engine_mut();
        engine.equations.vary(parameter, range[0], range[1]);
        Ok(Path { parameter, range, branches: trace(engine, options, &mut watch) })
    }
}
