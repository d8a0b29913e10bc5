//! Shapes in the plane and in space, as paths have them.

use hydrostat::{
    Arm, CableState, Configuration, Parameter, Path, PathError, PathOptions, PathPoint, Reach, Rest, Restless,
    SolveError, SpatialConfiguration, SpatialError, SpatialStation, SpatialTip, Station, Tip,
};
use hydrostat_figures::{
    Abscissa, Page, Quantity, Scene, path_figure, path_shapes_figure, spatial_path_figure, spatial_path_shapes_figure,
};
use hydrostat_files::{
    Landing, PathDocument, ReachDocument, Varied, path_csv, path_csv_with_landings, reach_csv, spatial_path_csv,
    spatial_path_csv_with_landings, spatial_reach_csv,
};

use super::table::{SPATIAL_TIP, TIP, place_cells, spatial_tip_cells, tip_cells};

/// A shape along a path.
pub(super) trait Shape: Sized {
    /// Why there is none.
    type Error: std::error::Error + Send + Sync + 'static;
    /// One place of it.
    type Place;
    /// The heads of [`Shape::tip_cells`].
    const TIP: [&'static str; 4];

    /// Where the tip is.
    fn tip_cells(&self) -> [String; 4];
    fn place_cells(place: &Self::Place) -> [String; 4];
    fn reach_document<'a>(arm: &Arm, found: &'a Reach<Self, Self::Place>) -> ReachDocument<'a>;
    fn reach_csv(cables: usize, found: &Reach<Self, Self::Place>) -> String;
    fn cables(&self) -> &[CableState];
    fn path(
        arm: &Arm,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        watch: impl FnMut(&PathPoint<Self>) -> bool,
    ) -> Result<Path<Self>, PathError<Self::Error>>;
    fn document<'a>(path: &'a Path<Self>, varied: &Varied) -> Option<PathDocument<'a>>;
    fn csv(path: &Path<Self>, varied: &Varied, landings: Option<&[Landing<Self>]>) -> String;
    fn with_landings<'a>(document: PathDocument<'a>, landings: &[Landing<Self>]) -> PathDocument<'a>;
    /// The arm with the loads that are balanced.
    fn arm(&self) -> &Arm;
    /// Where the arm rests that is let go in this shape under other loads.
    fn let_go(&self, arm: &Arm, tol: f64) -> Result<Rest<Self>, Restless>;
    /// Where the tip is, in words.
    fn tip_words(&self) -> String;
    fn chart(path: &Path<Self>, over: &Abscissa, quantity: Quantity, title: &str, page: &Page) -> Scene;
    /// Shapes along a path.
    fn shapes(path: &Path<Self>, over: &Abscissa, title: &str, page: &Page) -> Scene;
}

/// What both kinds of shapes are asked for alike.
macro_rules! alike {
    () => {
        fn cables(&self) -> &[CableState] {
            &self.cables
        }

        fn with_landings<'a>(document: PathDocument<'a>, landings: &[Landing<Self>]) -> PathDocument<'a> {
            document.with_landings(landings)
        }

        fn arm(&self) -> &Arm {
            &self.arm
        }

        fn let_go(&self, arm: &Arm, tol: f64) -> Result<Rest<Self>, Restless> {
            self.let_go(arm, tol)
        }
    };
}

impl Shape for Configuration {
    type Error = SolveError;
    type Place = Station;
    const TIP: [&'static str; 4] = TIP;

    fn tip_cells(&self) -> [String; 4] {
        tip_cells(self)
    }

    fn place_cells(place: &Station) -> [String; 4] {
        let Station { x, y, theta, alpha, .. } = *place;
        place_cells(Tip { x, y, theta, alpha })
    }

    fn reach_document<'a>(arm: &Arm, found: &'a Reach) -> ReachDocument<'a> {
        ReachDocument::new(arm, found)
    }

    fn reach_csv(cables: usize, found: &Reach) -> String {
        reach_csv(cables, found)
    }

    alike!();

    fn path(
        arm: &Arm,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        watch: impl FnMut(&PathPoint) -> bool,
    ) -> Result<Path, PathError> {
        arm.path_with(parameter, range, options, watch)
    }

    fn document<'a>(path: &'a Path, varied: &Varied) -> Option<PathDocument<'a>> {
        PathDocument::new(path, varied)
    }

    fn csv(path: &Path, varied: &Varied, landings: Option<&[Landing]>) -> String {
        landings.map_or_else(|| path_csv(path, varied), |landings| path_csv_with_landings(path, varied, landings))
    }

    fn tip_words(&self) -> String {
        let [x, y, theta, _] = self.tip_cells();
        format!("x {x} mm, y {y} mm, turned by {theta} deg")
    }

    fn chart(path: &Path, over: &Abscissa, quantity: Quantity, title: &str, page: &Page) -> Scene {
        path_figure(path, over, quantity, title, page)
    }

    fn shapes(path: &Path, over: &Abscissa, title: &str, page: &Page) -> Scene {
        path_shapes_figure(path, over, title, page)
    }
}

impl Shape for SpatialConfiguration {
    type Error = SpatialError;
    type Place = SpatialStation;
    const TIP: [&'static str; 4] = SPATIAL_TIP;

    fn tip_cells(&self) -> [String; 4] {
        spatial_tip_cells(&self.tip())
    }

    fn place_cells(place: &SpatialStation) -> [String; 4] {
        let SpatialStation { x, y, z, a, b, c, alpha, .. } = *place;
        spatial_tip_cells(&SpatialTip { x, y, z, a, b, c, alpha })
    }

    fn reach_document<'a>(arm: &Arm, found: &'a Reach<Self, SpatialStation>) -> ReachDocument<'a> {
        ReachDocument::in_space(arm, found)
    }

    fn reach_csv(cables: usize, found: &Reach<Self, SpatialStation>) -> String {
        spatial_reach_csv(cables, found)
    }

    alike!();

    fn path(
        arm: &Arm,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        watch: impl FnMut(&PathPoint<Self>) -> bool,
    ) -> Result<Path<Self>, PathError<SpatialError>> {
        arm.path_in_space_with(parameter, range, options, watch)
    }

    fn document<'a>(path: &'a Path<Self>, varied: &Varied) -> Option<PathDocument<'a>> {
        PathDocument::in_space(path, varied)
    }

    fn csv(path: &Path<Self>, varied: &Varied, landings: Option<&[Landing<Self>]>) -> String {
        let with = |landings| spatial_path_csv_with_landings(path, varied, landings);
        landings.map_or_else(|| spatial_path_csv(path, varied), with)
    }

    fn tip_words(&self) -> String {
        let [x, y, z, _] = self.tip_cells();
        format!("x {x} mm, y {y} mm, z {z} mm")
    }

    fn chart(path: &Path<Self>, over: &Abscissa, quantity: Quantity, title: &str, page: &Page) -> Scene {
        spatial_path_figure(path, over, quantity, title, page)
    }

    fn shapes(path: &Path<Self>, over: &Abscissa, title: &str, page: &Page) -> Scene {
        spatial_path_shapes_figure(path, over, title, page)
    }
}
