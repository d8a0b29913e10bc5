//! What inverse kinetics found, as JSON and CSV.

use hydrostat::{Arm, Bound, Reach, Reached, Station};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{SCHEMA, cell, json};
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

/// A place that a target is for, where that is not the tip.
#[derive(Debug, Clone, Serialize)]
struct PlaceOut {
    s: f64,
    x: f64,
    y: f64,
    theta: f64,
    alpha: f64,
}

impl From<&Station> for PlaceOut {
    fn from(station: &Station) -> Self {
        let Station { s, x, y, theta, alpha, .. } = *station;
        Self { s, x, y, theta, alpha }
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

impl<'a> From<&'a Reached> for ReachedOut<'a> {
    fn from(one: &'a Reached) -> Self {
        Self {
            effort: one.effort,
            distance: one.distance,
            bounds: one.bounds.iter().map(BoundOut::from).collect(),
            on_the_path: one.on_the_path,
            places: one.places.iter().map(PlaceOut::from).collect(),
            state: State::new(&one.configuration, one.stability),
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
    let all: Vec<&Reached> = found.solutions.iter().chain(&found.closest).collect();
    let mut names = ["number", "reached", "effort_N2", "distance"].map(str::to_owned).to_vec();
    for k in 0..all.first().map_or(0, |one| one.places.len()) {
        names.extend(["s_m", "x_m", "y_m", "theta_rad", "alpha_rad"].map(|name| format!("place_{k}_{name}")));
    }
    names.extend(State::columns(cables, &["on_the_path"]));
    let mut out = Rows::new(&names);
    for (index, one) in all.iter().enumerate() {
        let reached = found.closest.is_none();
        let mut cells = vec![(index + 1).to_string(), reached.to_string(), cell(one.effort), cell(one.distance)];
        for place in &one.places {
            cells.extend([place.s, place.x, place.y, place.theta, place.alpha].map(cell));
        }
        cells.extend(State::new(&one.configuration, one.stability).cells(&[&one.on_the_path.to_string()]));
        out.row(&cells);
    }
    out.text()
}
