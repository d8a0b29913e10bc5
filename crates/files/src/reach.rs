//! What inverse kinetics found, as JSON and CSV.

use hydrostat::{Arm, Bound, Reach, Reached, SpatialConfiguration, SpatialStation, SpatialTip, Station};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{SCHEMA, cell, json};
use crate::spatial_results::TipOut as SpatialTipOut;
use crate::state::State;
use crate::written::Inputs;

#[derive(Debug, Clone, Serialize)]
struct BoundOut {
    cable: usize,
    kind: &'static str,
}

impl From<&Bound> for BoundOut {
    fn from(bound: &Bound) -> Self {
        match *bound {
            Bound::Slack(cable) => Self { cable, kind: "slack" },
            Bound::Most(cable) => Self { cable, kind: "most" },
            Bound::Stroke(cable) => Self { cable, kind: "stroke" },
        }
    }
}

/// A place that a target is for, where that is not the tip, in the plane or in space.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
enum PlaceOut {
    Plane {
        s: f64,
        x: f64,
        y: f64,
        theta: f64,
        alpha: f64,
    },
    Space {
        s: f64,
        #[serde(flatten)]
        pose: SpatialTipOut,
    },
}

impl PlaceOut {
    const COLUMNS: [&'static str; 5] = ["s_m", "x_m", "y_m", "theta_rad", "alpha_rad"];

    fn columns_in_space() -> Vec<String> {
        let pose = SpatialTipOut::COLUMNS.iter().map(|name| name.trim_start_matches("tip_").to_owned());
        std::iter::once("s_m".to_owned()).chain(pose).collect()
    }

    fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Plane { s, x, y, theta, alpha } => vec![*s, *x, *y, *theta, *alpha],
            Self::Space { s, pose } => std::iter::once(*s).chain(pose.numbers()).collect(),
        }
    }
}

impl From<&Station> for PlaceOut {
    fn from(station: &Station) -> Self {
        let Station { s, x, y, theta, alpha, .. } = *station;
        Self::Plane { s, x, y, theta, alpha }
    }
}

impl From<&SpatialStation> for PlaceOut {
    fn from(station: &SpatialStation) -> Self {
        let SpatialStation { s, x, y, z, a, b, c, alpha, .. } = *station;
        Self::Space { s, pose: SpatialTip { x, y, z, a, b, c, alpha }.into() }
    }
}

#[derive(Debug, Clone, Serialize)]
struct ReachedOut<'a> {
    effort: f64,
    distance: f64,
    bounds: Vec<BoundOut>,
    on_the_path: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    places: Vec<PlaceOut>,
    #[serde(flatten)]
    state: State<'a>,
}

type InSpace = Reached<SpatialConfiguration, SpatialStation>;

impl<'a> From<&'a Reached> for ReachedOut<'a> {
    fn from(one: &'a Reached) -> Self {
        Self::new(one, State::new(&one.configuration, one.stability))
    }
}

impl<'a> From<&'a InSpace> for ReachedOut<'a> {
    fn from(one: &'a InSpace) -> Self {
        Self::new(one, State::in_space(&one.configuration, one.stability))
    }
}

impl<'a> ReachedOut<'a> {
    fn new<C, P>(one: &'a Reached<C, P>, state: State<'a>) -> Self
    where
        PlaceOut: From<&'a P>,
    {
        Self {
            effort: one.effort,
            distance: one.distance,
            bounds: one.bounds.iter().map(BoundOut::from).collect(),
            on_the_path: one.on_the_path,
            places: one.places.iter().map(PlaceOut::from).collect(),
            state,
        }
    }
}

/// The document of what was found for targets.
#[derive(Debug, Clone, Serialize)]
pub struct ReachDocument<'a> {
    schema: u32,
    version: &'static str,
    reached: bool,
    solutions: Vec<ReachedOut<'a>>,
    closest: Option<ReachedOut<'a>>,
    inputs: Inputs,
}

impl<'a> ReachDocument<'a> {
    /// Of what was found for `arm`.
    pub fn new(arm: &Arm, found: &'a Reach) -> Self {
        Self::of(arm, found)
    }

    /// The same of an arm in space.
    pub fn in_space(arm: &Arm, found: &'a Reach<SpatialConfiguration, SpatialStation>) -> Self {
        Self::of(arm, found)
    }

    fn of<C, P>(arm: &Arm, found: &'a Reach<C, P>) -> Self
    where
        ReachedOut<'a>: From<&'a Reached<C, P>>,
    {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            reached: !found.solutions.is_empty(),
            solutions: found.solutions.iter().map(ReachedOut::from).collect(),
            closest: found.closest.as_ref().map(ReachedOut::from),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// Solutions of an arm with `cables` cables, one row each, or the closest that was found. Before the tip come the places that
/// targets are for, where these are others.
pub fn reach_csv(cables: usize, found: &Reach) -> String {
    let places = PlaceOut::COLUMNS.map(str::to_owned);
    rows(found, &places, &State::columns(cables, &["on_the_path"]))
}

/// The same of an arm in space.
pub fn spatial_reach_csv(cables: usize, found: &Reach<SpatialConfiguration, SpatialStation>) -> String {
    rows(found, &PlaceOut::columns_in_space(), &State::columns_in_space(cables, &["on_the_path"]))
}

fn rows<'a, C, P>(found: &'a Reach<C, P>, place_columns: &[String], columns: &[String]) -> String
where
    ReachedOut<'a>: From<&'a Reached<C, P>>,
{
    let all: Vec<ReachedOut<'a>> = found.solutions.iter().chain(&found.closest).map(ReachedOut::from).collect();
    let mut names = ["number", "reached", "effort_N2", "distance"].map(str::to_owned).to_vec();
    for k in 0..all.first().map_or(0, |one| one.places.len()) {
        names.extend(place_columns.iter().map(|name| format!("place_{k}_{name}")));
    }
    names.extend_from_slice(columns);
    let mut out = Rows::new(&names);
    for (index, one) in all.iter().enumerate() {
        let reached = found.closest.is_none();
        let mut cells = vec![(index + 1).to_string(), reached.to_string(), cell(one.effort), cell(one.distance)];
        for place in &one.places {
            cells.extend(place.numbers().into_iter().map(cell));
        }
        cells.extend(one.state.cells(&[&one.on_the_path.to_string()]));
        out.row(&cells);
    }
    out.text()
}
