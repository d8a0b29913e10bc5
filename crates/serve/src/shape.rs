//! What the server asks of arms in the plane and in space.

use hydrostat::{
    Arm, Configuration, Equilibria, Equilibrium, NoEquilibrium, NoSpatialEquilibrium, Options, Parameter, Path,
    PathError, PathOptions, Reach, ReachError, ReachOptions, SolveError, Solver, SpatialConfiguration,
    SpatialEquilibria, SpatialError, SpatialSolver, SpatialStation, SpatialTarget, Stability, Station, Target, Verdict,
};
use hydrostat_figures::{
    Abscissa, Page, Quantity, Scene, arm_figure, equilibria_figure, path_figure, reach_figure, spatial_arm_figure,
    spatial_equilibria_figure, spatial_path_figure,
};
use hydrostat_files::{
    FailureDocument, Note, Others, PathDocument, ReachDocument, Search, SolutionDocument, SpatialFailureDocument,
    SpatialSolutionDocument, Varied, path_csv, reach_csv, spatial_path_csv, spatial_reach_csv, spatial_stations_csv,
    stations_csv,
};
use serde::Serialize;

use crate::drawing::{Drawing, Silhouette};
use crate::problem::Problem;
use crate::work::Deadline;

/// The document of a shape or of a verdict.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum Answered<'a> {
    Shape(Box<SolutionDocument<'a>>),
    None(Box<FailureDocument<'a>>),
    ShapeInSpace(Box<SpatialSolutionDocument<'a>>),
    NoneInSpace(Box<SpatialFailureDocument<'a>>),
}

/// Why a solve has no shape.
pub(crate) enum Unsolved<F> {
    Verdict(Box<F>),
    Refused(Problem),
}

impl<F> From<Unsolved<F>> for Problem
where
    Self: From<Box<F>>,
{
    fn from(unsolved: Unsolved<F>) -> Self {
        match unsolved {
            Unsolved::Verdict(failure) => failure.into(),
            Unsolved::Refused(problem) => problem,
        }
    }
}

impl From<Box<NoEquilibrium>> for Problem {
    fn from(failure: Box<NoEquilibrium>) -> Self {
        SolveError::NoEquilibrium(failure).into()
    }
}

impl From<Box<NoSpatialEquilibrium>> for Problem {
    fn from(failure: Box<NoSpatialEquilibrium>) -> Self {
        SpatialError::NoEquilibrium(failure).into()
    }
}

/// A goal of reach.
pub(crate) struct Aim {
    /// Two coordinates in the plane, three in space, m.
    pub(crate) place: Vec<f64>,
    pub(crate) station: Option<f64>,
    /// In the plane, rad.
    pub(crate) angle: Option<f64>,
    /// Of a, in space.
    pub(crate) direction: Option<[f64; 3]>,
}

/// An equilibrium of an arm in the plane or in space.
pub(crate) trait Shape: Sized {
    /// A verdict with the last good shape.
    type Failure;
    /// One place of it.
    type Place;
    /// All that were found.
    type All;

    fn solve(arm: &Arm, tol: f64) -> Result<Self, Unsolved<Self::Failure>>;
    fn notes(&self, tol: f64) -> Vec<Note>;
    fn is_stable(&self) -> Option<bool>;
    fn resample(&mut self, count: usize);
    fn tip(&self) -> [f64; 3];
    fn drawing(&self) -> Drawing;
    fn silhouette(&self, count: usize) -> Silhouette;
    fn csv(&self) -> String;
    fn figure(&self, note: Option<&str>, page: &Page) -> Scene;
    fn document<'a>(&'a self, notes: &'a [Note]) -> Answered<'a>;

    fn verdict(failure: &Self::Failure) -> &Verdict;
    fn last_good(failure: &mut Self::Failure) -> Option<&mut Self>;
    /// `notes` are those on the last good shape.
    fn failure<'a>(failure: &'a Self::Failure, notes: &'a [Note], others: Option<Others>) -> Answered<'a>;

    fn path(
        arm: &Arm,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        deadline: Deadline,
    ) -> Result<Path<Self>, Problem>;
    fn path_document<'a>(path: &'a Path<Self>, varied: &Varied) -> Option<PathDocument<'a>>;
    fn path_csv(path: &Path<Self>, varied: &Varied) -> String;
    fn path_figure(path: &Path<Self>, over: &Abscissa, title: &str, page: &Page) -> Scene;

    fn all(arm: &Arm, tol: f64, deadline: Deadline) -> Result<Self::All, Problem>;
    fn search(all: &Self::All) -> Search<'_>;
    fn found(all: &Self::All) -> &[Equilibrium<Self>];
    fn all_figure(all: &Self::All, arm: &Arm, page: &Page) -> Scene;

    fn reach(
        arm: &Arm,
        aim: &Aim,
        by_strokes: bool,
        options: &ReachOptions,
        deadline: Deadline,
    ) -> Result<Reach<Self, Self::Place>, Problem>;
    fn reach_document<'a>(arm: &Arm, found: &'a Reach<Self, Self::Place>) -> ReachDocument<'a>;
    fn reach_csv(cables: usize, found: &Reach<Self, Self::Place>) -> String;
    fn reach_figure(&self, aim: &Aim, note: Option<&str>, page: &Page) -> Scene;
}

impl Shape for Configuration {
    type Failure = NoEquilibrium;
    type Place = Station;
    type All = Equilibria;

    fn solve(arm: &Arm, tol: f64) -> Result<Self, Unsolved<NoEquilibrium>> {
        let solved = Solver::new(arm, Options::with_tol(tol)).and_then(|mut solver| solver.solve());
        solved.map_err(|error| match error {
            SolveError::NoEquilibrium(failure) => Unsolved::Verdict(failure),
            error => Unsolved::Refused(error.into()),
        })
    }

    fn notes(&self, tol: f64) -> Vec<Note> {
        Note::all(self, tol)
    }

    fn is_stable(&self) -> Option<bool> {
        self.stability().map_or(self.stable, Stability::is_stable)
    }

    fn resample(&mut self, count: usize) {
        self.stations = self.resampled(count);
    }

    fn tip(&self) -> [f64; 3] {
        let tip = self.tip();
        [tip.x, tip.y, 0.0]
    }

    fn drawing(&self) -> Drawing {
        Drawing::new(self)
    }

    fn silhouette(&self, count: usize) -> Silhouette {
        Silhouette::new(self, count)
    }

    fn csv(&self) -> String {
        stations_csv(&self.stations)
    }

    fn figure(&self, note: Option<&str>, page: &Page) -> Scene {
        arm_figure(self, note, page)
    }

    fn document<'a>(&'a self, notes: &'a [Note]) -> Answered<'a> {
        Answered::Shape(Box::new(SolutionDocument::new(self, self.fold_margin().value, notes)))
    }

    fn verdict(failure: &NoEquilibrium) -> &Verdict {
        &failure.verdict
    }

    fn last_good(failure: &mut NoEquilibrium) -> Option<&mut Self> {
        failure.last_good.as_mut()
    }

    fn failure<'a>(failure: &'a NoEquilibrium, notes: &'a [Note], others: Option<Others>) -> Answered<'a> {
        let margin = failure.last_good.as_ref().map_or(f64::NAN, |shape| shape.fold_margin().value);
        Answered::None(Box::new(FailureDocument::new(failure, margin, notes).with_others(others)))
    }

    fn path(
        arm: &Arm,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        deadline: Deadline,
    ) -> Result<Path, Problem> {
        Ok(arm.path_with(parameter, range, options, |_| deadline.is_ahead())?)
    }

    fn path_document<'a>(path: &'a Path, varied: &Varied) -> Option<PathDocument<'a>> {
        PathDocument::new(path, varied)
    }

    fn path_csv(path: &Path, varied: &Varied) -> String {
        path_csv(path, varied)
    }

    fn path_figure(path: &Path, over: &Abscissa, title: &str, page: &Page) -> Scene {
        path_figure(path, over, Quantity::TipY, title, page)
    }

    fn all(arm: &Arm, tol: f64, deadline: Deadline) -> Result<Equilibria, Problem> {
        Ok(arm.equilibria_while(tol, |_| deadline.is_ahead())?)
    }

    fn search(all: &Equilibria) -> Search<'_> {
        all.into()
    }

    fn found(all: &Equilibria) -> &[Equilibrium] {
        &all.found
    }

    fn all_figure(all: &Equilibria, arm: &Arm, page: &Page) -> Scene {
        equilibria_figure(all, &format!("{}: all equilibria", arm.name), page)
    }

    fn reach(
        arm: &Arm,
        aim: &Aim,
        by_strokes: bool,
        options: &ReachOptions,
        deadline: Deadline,
    ) -> Result<Reach, Problem> {
        let [x, y] = aim.place[..] else { return Err(Problem::target(2)) };
        if aim.direction.is_some() {
            return Err(Problem::field(
                "direction",
                "direction: this is for arms in space; in the plane give an angle",
            ));
        }
        let target = Target { s: aim.station, angle: aim.angle, ..Target::tip(x, y) };
        let found: Result<Reach, ReachError> = if by_strokes {
            arm.reach_by_strokes_while(&[target], options, || deadline.is_ahead())
        } else {
            arm.reach_while(&[target], options, || deadline.is_ahead())
        };
        Ok(found?)
    }

    fn reach_document<'a>(arm: &Arm, found: &'a Reach) -> ReachDocument<'a> {
        ReachDocument::new(arm, found)
    }

    fn reach_csv(cables: usize, found: &Reach) -> String {
        reach_csv(cables, found)
    }

    fn reach_figure(&self, aim: &Aim, note: Option<&str>, page: &Page) -> Scene {
        let target = aim.place.first_chunk().copied().unwrap_or_default();
        reach_figure(self, &[target], note, page)
    }
}

impl Shape for SpatialConfiguration {
    type Failure = NoSpatialEquilibrium;
    type Place = SpatialStation;
    type All = SpatialEquilibria;

    fn solve(arm: &Arm, tol: f64) -> Result<Self, Unsolved<NoSpatialEquilibrium>> {
        let solved = SpatialSolver::new(arm, Options::with_tol(tol)).and_then(|mut solver| solver.solve());
        solved.map_err(|error| match error {
            SpatialError::NoEquilibrium(failure) => Unsolved::Verdict(failure),
            error => Unsolved::Refused(error.into()),
        })
    }

    fn notes(&self, tol: f64) -> Vec<Note> {
        Note::all_in_space(self, tol)
    }

    fn is_stable(&self) -> Option<bool> {
        self.stability().map_or(self.stable, Stability::is_stable)
    }

    fn resample(&mut self, count: usize) {
        self.stations = self.resampled(count);
    }

    fn tip(&self) -> [f64; 3] {
        let tip = self.tip();
        [tip.x, tip.y, tip.z]
    }

    fn drawing(&self) -> Drawing {
        Drawing::in_space(self)
    }

    fn silhouette(&self, count: usize) -> Silhouette {
        Silhouette::in_space(self, count)
    }

    fn csv(&self) -> String {
        spatial_stations_csv(&self.stations)
    }

    fn figure(&self, note: Option<&str>, page: &Page) -> Scene {
        spatial_arm_figure(self, note, page)
    }

    fn document<'a>(&'a self, notes: &'a [Note]) -> Answered<'a> {
        Answered::ShapeInSpace(Box::new(SpatialSolutionDocument::new(self, notes)))
    }

    fn verdict(failure: &NoSpatialEquilibrium) -> &Verdict {
        &failure.verdict
    }

    fn last_good(failure: &mut NoSpatialEquilibrium) -> Option<&mut Self> {
        failure.last_good.as_mut()
    }

    fn failure<'a>(failure: &'a NoSpatialEquilibrium, notes: &'a [Note], _: Option<Others>) -> Answered<'a> {
        Answered::NoneInSpace(Box::new(SpatialFailureDocument::new(failure, notes)))
    }

    fn path(
        arm: &Arm,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        deadline: Deadline,
    ) -> Result<Path<Self>, Problem> {
        let path: Result<_, PathError<SpatialError>> =
            arm.path_in_space_with(parameter, range, options, |_| deadline.is_ahead());
        Ok(path?)
    }

    fn path_document<'a>(path: &'a Path<Self>, varied: &Varied) -> Option<PathDocument<'a>> {
        PathDocument::in_space(path, varied)
    }

    fn path_csv(path: &Path<Self>, varied: &Varied) -> String {
        spatial_path_csv(path, varied)
    }

    fn path_figure(path: &Path<Self>, over: &Abscissa, title: &str, page: &Page) -> Scene {
        spatial_path_figure(path, over, Quantity::TipY, title, page)
    }

    fn all(arm: &Arm, tol: f64, deadline: Deadline) -> Result<SpatialEquilibria, Problem> {
        Ok(arm.equilibria_in_space_while(tol, |_| deadline.is_ahead())?)
    }

    fn search(all: &SpatialEquilibria) -> Search<'_> {
        all.into()
    }

    fn found(all: &SpatialEquilibria) -> &[Equilibrium<Self>] {
        &all.found
    }

    fn all_figure(all: &SpatialEquilibria, arm: &Arm, page: &Page) -> Scene {
        spatial_equilibria_figure(all, &format!("{}: equilibria", arm.name), page)
    }

    fn reach(
        arm: &Arm,
        aim: &Aim,
        by_strokes: bool,
        options: &ReachOptions,
        deadline: Deadline,
    ) -> Result<Reach<Self, SpatialStation>, Problem> {
        let [x, y, z] = aim.place[..] else { return Err(Problem::target(3)) };
        if aim.angle.is_some() {
            let message = "angle: this is for arms in the plane; in space give direction, [x, y, z] of the normal a";
            return Err(Problem::field("angle", message));
        }
        let target = SpatialTarget { s: aim.station, direction: aim.direction, ..SpatialTarget::tip([x, y, z]) };
        Ok(if by_strokes {
            arm.reach_in_space_by_strokes_while(&[target], options, || deadline.is_ahead())?
        } else {
            arm.reach_in_space_while(&[target], options, || deadline.is_ahead())?
        })
    }

    fn reach_document<'a>(arm: &Arm, found: &'a Reach<Self, SpatialStation>) -> ReachDocument<'a> {
        ReachDocument::in_space(arm, found)
    }

    fn reach_csv(cables: usize, found: &Reach<Self, SpatialStation>) -> String {
        spatial_reach_csv(cables, found)
    }

    fn reach_figure(&self, _: &Aim, note: Option<&str>, page: &Page) -> Scene {
        self.figure(note, page)
    }
}
