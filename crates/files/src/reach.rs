//! What inverse kinetics found, as JSON and CSV.

use hydrostat::{Arm, Bound, Reach, Reached};
use serde::Serialize;

use crate::results::{SCHEMA, cell, json, row};
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

#[derive(Debug, Clone, Serialize)]
struct ReachedOut<'a> {
    effort: f64,
    distance: f64,
    bounds: Vec<BoundOut>,
    on_the_path: bool,
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

/// Solutions of an arm with `cables` cables, one row each, or the closest that was found.
pub fn reach_csv(cables: usize, found: &Reach) -> String {
    let mut names = ["number", "reached", "effort_N2", "distance"].map(str::to_owned).to_vec();
    names.extend(State::columns(cables, &["on_the_path"]));
    let mut out = row(&names);
    for (index, one) in found.solutions.iter().chain(&found.closest).enumerate() {
        let reached = found.closest.is_none();
        let mut cells = vec![(index + 1).to_string(), reached.to_string(), cell(one.effort), cell(one.distance)];
        cells.extend(State::new(&one.configuration, one.stability).cells(&[&one.on_the_path.to_string()]));
        out.push_str(&row(&cells));
    }
    out
}
