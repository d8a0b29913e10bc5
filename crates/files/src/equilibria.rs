//! All equilibria of an arm as JSON and CSV, at its loads and over a range of one of them.

use hydrostat::{Arm, Equilibria, Equilibrium, PathEnd};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::digits::number;
pub use crate::others::Others;
use crate::paths::{EndOut, limit_message};
use crate::results::{SCHEMA, cell, json};
use crate::state::State;
use crate::varied::Varied;
use crate::written::Inputs;

#[derive(Debug, Clone, Serialize)]
struct SearchOut<'a> {
    complete: bool,
    tip_angles: [f64; 2],
    base_angles: [f64; 2],
    ends: [Option<EndOut>; 2],
    equilibria: Vec<State<'a>>,
}

/// The document of a search for all equilibria.
#[derive(Debug, Clone, Serialize)]
pub struct EquilibriaDocument<'a> {
    schema: u32,
    version: &'static str,
    #[serde(flatten)]
    search: SearchOut<'a>,
    inputs: Inputs,
}

#[derive(Debug, Clone, Serialize)]
struct ValueOut<'a> {
    value: f64,
    #[serde(flatten)]
    search: Option<SearchOut<'a>>,
    message: Option<&'a str>,
}

/// The document of searches at several values of one quantity.
#[derive(Debug, Clone, Serialize)]
pub struct OverDocument<'a> {
    schema: u32,
    version: &'static str,
    parameter: String,
    unit: &'static str,
    range: [f64; 2],
    values: Vec<ValueOut<'a>>,
    inputs: Inputs,
}

/// What stopped a search on one side, in a phrase: `end` is one of [`Equilibria::ends`], with the base's angle there (rad).
pub fn side_message(end: PathEnd, base: f64) -> String {
    let at = format!("with the base at {} deg", number(base.to_degrees()));
    match end {
        PathEnd::Limit { kind, s } => format!("{} {at}", limit_message(kind, s)),
        PathEnd::MostPoints => format!("the curve reached the largest number of points {at}"),
        PathEnd::Stopped => format!("the search was stopped {at}"),
        PathEnd::ReachedEnd | PathEnd::ReachedStart => format!("the curve ended {at}"),
    }
}

impl<'a> SearchOut<'a> {
    fn new(all: &'a Equilibria) -> Self {
        let end = |side: usize| {
            let message = |end| side_message(end, all.base_angles[side]);
            all.ends[side].map(|end| EndOut::new(end, message(end)))
        };
        Self {
            complete: all.complete,
            tip_angles: all.tip_angles,
            base_angles: all.base_angles,
            ends: [end(0), end(1)],
            equilibria: all.found.iter().map(state).collect(),
        }
    }
}

fn state(one: &Equilibrium) -> State<'_> {
    State::new(&one.configuration, one.stability)
}

impl<'a> EquilibriaDocument<'a> {
    /// Of the equilibria of `arm`.
    pub fn new(arm: &Arm, all: &'a Equilibria) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            search: SearchOut::new(all),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

impl<'a> OverDocument<'a> {
    /// Of the equilibria of `arm` at each value (SI) of what varies, or why there are none.
    pub fn new(arm: &Arm, varied: &Varied, searches: &'a [(f64, Result<Equilibria, String>)]) -> Self {
        let value = |(value, found): &'a (f64, Result<Equilibria, String>)| ValueOut {
            value: *value,
            search: found.as_ref().ok().map(SearchOut::new),
            message: found.as_ref().err().map(String::as_str),
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            parameter: varied.parameter.to_string(),
            unit: varied.parameter.unit(),
            range: varied.range,
            values: searches.iter().map(value).collect(),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// The equilibria of an arm with `cables` cables, one row each, counted from 1 in the order of the tip's angle.
pub fn equilibria_csv(cables: usize, all: &Equilibria) -> String {
    let mut names = vec!["number".to_owned()];
    names.extend(State::columns(cables, &[]));
    let mut out = Rows::new(&names);
    for (index, one) in all.found.iter().enumerate() {
        let mut cells = vec![(index + 1).to_string()];
        cells.extend(state(one).cells(&[]));
        out.row(&cells);
    }
    out.text()
}

/// [`equilibria_csv`] at each value of what varies; `complete` says whether those at a value are all.
pub fn over_csv(cables: usize, varied: &Varied, searches: &[(f64, Result<Equilibria, String>)]) -> String {
    let mut names = vec![varied.column(), "complete".to_owned(), "number".to_owned()];
    names.extend(State::columns(cables, &[]));
    let mut out = Rows::new(&names);
    for (value, found) in searches {
        let Ok(all) = found else { continue };
        for (index, one) in all.found.iter().enumerate() {
            let mut cells = vec![cell(*value), all.complete.to_string(), (index + 1).to_string()];
            cells.extend(state(one).cells(&[]));
            out.row(&cells);
        }
    }
    out.text()
}
