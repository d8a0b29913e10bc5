//! Paths of equilibria as JSON and CSV.

use hydrostat::{
    Arm, Branch, Configuration, Event, Path, PathEnd, PathPoint, Rest, SpatialConfiguration, SpatialTip, Tip,
    VerdictKind,
};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{SCHEMA, cell, json};
use crate::state::{AnyTip, State};
use crate::varied::{RangeOut, Varied};
use crate::written::Inputs;

/// The document of a path.
#[derive(Debug, Clone, Serialize)]
pub struct PathDocument<'a> {
    schema: u32,
    version: &'static str,
    #[serde(flatten)]
    over: RangeOut,
    branches: Vec<BranchOut<'a>>,
    inputs: Inputs,
}

#[derive(Debug, Clone, Serialize)]
struct BranchOut<'a> {
    switched_at: Option<f64>,
    end: EndOut,
    points: Vec<PointOut<'a>>,
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct EndOut {
    kind: &'static str,
    s: Option<f64>,
    message: String,
}

/// Where an arm rests that is let go at a limit point of a path.
#[derive(Debug, Clone)]
pub struct Landing<C = Configuration> {
    /// The branch and the point on it, from 0.
    pub at: [usize; 2],
    /// The shape and the time that it takes, or why there is none.
    pub outcome: Result<Rest<C>, String>,
}

#[derive(Debug, Clone, Serialize)]
struct LandingOut {
    /// The tip where the arm rests.
    tip: Option<AnyTip>,
    /// s
    duration: Option<f64>,
    /// Why it is not known where.
    message: Option<String>,
}

impl LandingOut {
    fn new<C: Landed>(landing: &Landing<C>) -> Self {
        match &landing.outcome {
            Ok(rest) => Self { tip: Some(rest.configuration.landed()), duration: Some(rest.time), message: None },
            Err(message) => Self { tip: None, duration: None, message: Some(message.clone()) },
        }
    }
}

/// What is said of a shape in which an arm rests.
pub(crate) trait Landed {
    /// The heads of [`Landed::place`].
    const PLACE: &'static [&'static str];

    fn landed(&self) -> AnyTip;
    fn place(&self) -> Vec<f64>;
}

impl Landed for Configuration {
    const PLACE: &'static [&'static str] = &["after_snap_x_m", "after_snap_y_m", "after_snap_theta_rad"];

    fn landed(&self) -> AnyTip {
        self.tip().into()
    }

    fn place(&self) -> Vec<f64> {
        let Tip { x, y, theta, .. } = self.tip();
        vec![x, y, theta]
    }
}

impl Landed for SpatialConfiguration {
    const PLACE: &'static [&'static str] = &["after_snap_x_m", "after_snap_y_m", "after_snap_z_m"];

    fn landed(&self) -> AnyTip {
        self.tip().into()
    }

    fn place(&self) -> Vec<f64> {
        let SpatialTip { x, y, z, .. } = self.tip();
        vec![x, y, z]
    }
}

#[derive(Debug, Clone, Serialize)]
struct PointOut<'a> {
    value: f64,
    #[serde(flatten)]
    state: State<'a>,
    event: Option<&'static str>,
    /// Index of the cable that goes slack or taut.
    cable: Option<usize>,
    /// Where the arm rests after a limit point, where that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    after_snap: Option<LandingOut>,
}

impl EndOut {
    pub(crate) fn new(end: PathEnd, message: String) -> Self {
        let s = match end {
            PathEnd::Limit { s, .. } => s,
            _ => None,
        };
        Self { kind: end.name(), s, message }
    }
}

/// Why a path of `varied` ends, in a phrase, with the value (SI) at its last point.
pub fn end_message(end: PathEnd, varied: &Varied, value: f64) -> String {
    let at = format!("at {} = {}", varied.parameter, varied.with_unit(value));
    match end {
        PathEnd::ReachedEnd => format!("the end of the range was reached, {}", varied.with_unit(varied.range[1])),
        PathEnd::ReachedStart => {
            format!("the path returned to the start of the range, {}", varied.with_unit(varied.range[0]))
        }
        PathEnd::MostPoints => format!("the largest number of points was reached {at}"),
        PathEnd::Stopped => format!("it was stopped {at}"),
        PathEnd::Limit { kind, s } => format!("{} {at}", limit_message(kind, s)),
    }
}

/// What no equilibrium goes past, in a phrase, and where along the arm (m).
pub fn limit_message(kind: VerdictKind, s: Option<f64>) -> String {
    let why = kind.phrase();
    s.map_or_else(|| why.to_owned(), |s| format!("{why}, at s = {s:.4} m,"))
}

fn branch<'a, C>(
    branch: &'a Branch<C>,
    varied: &Varied,
    state: impl Fn(&'a PathPoint<C>) -> State<'a>,
) -> BranchOut<'a> {
    let last = branch.points.last().map_or(f64::NAN, |point| point.value);
    BranchOut {
        switched_at: branch.switched_at,
        end: EndOut::new(branch.end, end_message(branch.end, varied, last)),
        points: branch.points.iter().map(|own| point(own, state(own))).collect(),
    }
}

fn in_plane(point: &PathPoint) -> State<'_> {
    State::new(&point.configuration, point.stability)
}

fn in_space(point: &PathPoint<SpatialConfiguration>) -> State<'_> {
    State::in_space(&point.configuration, point.stability)
}

fn point<'a, C>(point: &PathPoint<C>, state: State<'a>) -> PointOut<'a> {
    let cable = point.event.and_then(Event::cable);
    PointOut { value: point.value, state, event: point.event.map(Event::name), cable, after_snap: None }
}

impl<'a> PathDocument<'a> {
    /// Of a path of what varies; `inputs` are the arm's, with the value at the start of the path.
    pub fn new(path: &'a Path, varied: &Varied) -> Option<Self> {
        Self::of(path, varied, in_plane, |first| &first.arm)
    }

    /// The same of an arm in space.
    pub fn in_space(path: &'a Path<SpatialConfiguration>, varied: &Varied) -> Option<Self> {
        Self::of(path, varied, in_space, |first| &first.arm)
    }

    fn of<C>(
        path: &'a Path<C>,
        varied: &Varied,
        state: impl Fn(&'a PathPoint<C>) -> State<'a> + Copy,
        arm: impl Fn(&C) -> &Arm,
    ) -> Option<Self> {
        let first = path.branches.first()?.points.first()?;
        Some(Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            over: RangeOut::new(path.parameter, path.range),
            branches: path.branches.iter().map(|b| branch(b, varied, state)).collect(),
            inputs: Inputs::new(arm(&first.configuration)),
        })
    }

    /// With where the arm rests after limit points.
    #[allow(private_bounds, reason = "in the plane or in space")]
    pub fn with_landings<C: Landed>(mut self, landings: &[Landing<C>]) -> Self {
        for landing in landings {
            let [branch, point] = landing.at;
            let point = self.branches.get_mut(branch).and_then(|branch| branch.points.get_mut(point));
            if let Some(point) = point {
                point.after_snap = Some(LandingOut::new(landing));
            }
        }
        self
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// The points of all branches, one row each, with names and SI units in the first row. Branches count from 0.
pub fn path_csv(path: &Path, varied: &Varied) -> String {
    let columns = |more: &[&str]| State::columns(cables_of(path, |c| c.cables.len()), more);
    rows(path, varied, columns, in_plane, None::<&[Landing]>)
}

/// [`path_csv`] with the tip where the arm rests after limit points, and how long that takes.
pub fn path_csv_with_landings(path: &Path, varied: &Varied, landings: &[Landing]) -> String {
    let columns = |more: &[&str]| State::columns(cables_of(path, |c| c.cables.len()), more);
    rows(path, varied, columns, in_plane, Some(landings))
}

/// The same of an arm in space.
pub fn spatial_path_csv(path: &Path<SpatialConfiguration>, varied: &Varied) -> String {
    let columns = |more: &[&str]| State::columns_in_space(cables_of(path, |c| c.cables.len()), more);
    rows(path, varied, columns, in_space, None::<&[Landing<SpatialConfiguration>]>)
}

/// [`path_csv_with_landings`] of an arm in space.
pub fn spatial_path_csv_with_landings(
    path: &Path<SpatialConfiguration>,
    varied: &Varied,
    landings: &[Landing<SpatialConfiguration>],
) -> String {
    let columns = |more: &[&str]| State::columns_in_space(cables_of(path, |c| c.cables.len()), more);
    rows(path, varied, columns, in_space, Some(landings))
}

fn cables_of<C>(path: &Path<C>, cables: impl Fn(&C) -> usize) -> usize {
    path.branches.iter().flat_map(|b| &b.points).next().map_or(0, |point| cables(&point.configuration))
}

fn rows<'a, C: Landed>(
    path: &'a Path<C>,
    varied: &Varied,
    columns: impl Fn(&[&str]) -> Vec<String>,
    state: impl Fn(&'a PathPoint<C>) -> State<'a>,
    landings: Option<&[Landing<C>]>,
) -> String {
    let mut names = vec!["branch".to_owned(), varied.column()];
    let after: Vec<&str> = C::PLACE.iter().copied().chain(["after_snap_s"]).collect();
    let more: Vec<&str> = ["event"].into_iter().chain(after.iter().copied().filter(|_| landings.is_some())).collect();
    names.extend(columns(&more));
    let mut out = Rows::new(&names);
    let all = path.branches.iter().enumerate();
    let all = all.flat_map(|(b, branch)| branch.points.iter().enumerate().map(move |(p, point)| ([b, p], point)));
    for (at, point) in all {
        let mut cells = vec![at[0].to_string(), cell(point.value)];
        let name = |event: Event| match event.cable() {
            Some(cable) => format!("{}[{cable}]", event.name()),
            None => event.name().to_owned(),
        };
        let mut more = vec![point.event.map(name).unwrap_or_default()];
        if let Some(landings) = landings {
            let rest =
                landings.iter().find(|landing| landing.at == at).and_then(|landing| landing.outcome.as_ref().ok());
            let numbers = rest.map(|rest| {
                let mut numbers = rest.configuration.place();
                numbers.push(rest.time);
                numbers
            });
            more.extend(
                (0..after.len()).map(|k| numbers.as_ref().map_or_else(String::new, |numbers| cell(numbers[k]))),
            );
        }
        let more: Vec<&str> = more.iter().map(String::as_str).collect();
        cells.extend(state(point).cells(&more));
        out.row(&cells);
    }
    out.text()
}
