//! All equilibria of an arm as JSON and CSV, at its loads and over a range of one of them.

use hydrostat::{Arm, Equilibrium, PathEnd, SpatialConfiguration};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::digits::number;
use crate::others::Search;
use crate::paths::{EndOut, limit_message};
use crate::results::{SCHEMA, cell, json};
use crate::state::State;
use crate::varied::{RangeOut, Varied};
use crate::written::Inputs;

fn states(all: Search<'_>) -> Vec<State<'_>> {
    match all {
        Search::Plane(all) => all.found.iter().map(state).collect(),
        Search::Space(all) => all.found.iter().map(state_in_space).collect(),
    }
}

fn columns(all: Search<'_>, cables: usize) -> Vec<String> {
    match all {
        Search::Plane(_) => State::columns(cables, &[]),
        Search::Space(_) => State::columns_in_space(cables, &[]),
    }
}

#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
enum SearchOut<'a> {
    Plane {
        complete: bool,
        tip_angles: [f64; 2],
        base_angles: [f64; 2],
        ends: [Option<EndOut>; 2],
        equilibria: Vec<State<'a>>,
    },
    Space {
        complete: bool,
        /// Whether it is known that some are missing.
        misses_some: bool,
        sum_of_signs: Option<i64>,
        /// Curves that were followed, and those that ended at a limit.
        curves: usize,
        ends: Vec<EndOut>,
        equilibria: Vec<State<'a>>,
    },
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
    #[serde(flatten)]
    over: RangeOut,
    values: Vec<ValueOut<'a>>,
    inputs: Inputs,
}

/// What stopped a search on one side, in a phrase: `end` is one of [`hydrostat::Equilibria::ends`], with the base's angle there (rad).
pub fn side_message(end: PathEnd, base: f64) -> String {
    let at = format!("with the base at {} deg", number(base.to_degrees()));
    match end {
        PathEnd::Limit { kind, s } => format!("{} {at}", limit_message(kind, s)),
        PathEnd::MostPoints => format!("the curve reached the largest number of points {at}"),
        PathEnd::Stopped => format!("the search was stopped {at}"),
        PathEnd::ReachedEnd | PathEnd::ReachedStart => format!("the curve ended {at}"),
    }
}

impl<'a> From<Search<'a>> for SearchOut<'a> {
    fn from(search: Search<'a>) -> Self {
        let equilibria = states(search);
        match search {
            Search::Plane(all) => {
                let end = |side: usize| {
                    let message = |end| side_message(end, all.base_angles[side]);
                    all.ends[side].map(|end| EndOut::new(end, message(end)))
                };
                Self::Plane {
                    complete: all.complete,
                    tip_angles: all.tip_angles,
                    base_angles: all.base_angles,
                    ends: [end(0), end(1)],
                    equilibria,
                }
            }
            Search::Space(all) => Self::Space {
                complete: false,
                misses_some: all.misses_some(),
                sum_of_signs: all.sum_of_signs,
                curves: all.curves.len(),
                ends: all.curves.iter().flatten().map(|end| EndOut::new(*end, curve_message(*end))).collect(),
                equilibria,
            },
        }
    }
}

/// What ended a curve of a search in space, in a phrase.
pub fn curve_message(end: PathEnd) -> String {
    match end {
        PathEnd::Limit { kind, s } => limit_message(kind, s),
        PathEnd::MostPoints => "the curve reached the largest number of points".to_owned(),
        PathEnd::Stopped => "the search was stopped".to_owned(),
        PathEnd::ReachedEnd | PathEnd::ReachedStart => "the curve ended".to_owned(),
    }
}

fn state(one: &Equilibrium) -> State<'_> {
    State::new(&one.configuration, one.stability)
}

fn state_in_space(one: &Equilibrium<SpatialConfiguration>) -> State<'_> {
    State::in_space(&one.configuration, one.stability)
}

impl<'a> EquilibriaDocument<'a> {
    /// Of the equilibria of `arm`.
    pub fn new(arm: &Arm, all: impl Into<Search<'a>>) -> Self {
        Self { schema: SCHEMA, version: env!("CARGO_PKG_VERSION"), search: all.into().into(), inputs: Inputs::new(arm) }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

impl<'a> OverDocument<'a> {
    /// Of the equilibria of `arm` at each value (SI) of what varies, or why there are none.
    pub fn new(arm: &Arm, varied: &Varied, searches: &'a [(f64, Result<Search<'a>, String>)]) -> Self {
        let value = |(value, found): &'a (f64, Result<Search<'a>, String>)| ValueOut {
            value: *value,
            search: found.as_ref().ok().map(|all| (*all).into()),
            message: found.as_ref().err().map(String::as_str),
        };
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            over: RangeOut::new(varied.parameter, varied.range),
            values: searches.iter().map(value).collect(),
            inputs: Inputs::new(arm),
        }
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// The equilibria of an arm with `cables` cables, one row each, counted from 1 in the order of the tip's angle, in space
/// of its place.
pub fn equilibria_csv<'a>(cables: usize, all: impl Into<Search<'a>>) -> String {
    let all = all.into();
    let mut names = vec!["number".to_owned()];
    names.extend(columns(all, cables));
    let mut out = Rows::new(&names);
    for (index, one) in states(all).iter().enumerate() {
        let mut cells = vec![(index + 1).to_string()];
        cells.extend(one.cells(&[]));
        out.row(&cells);
    }
    out.text()
}

/// [`equilibria_csv`] at each value of what varies; `complete` says whether those at a value are all.
pub fn over_csv(cables: usize, varied: &Varied, searches: &[(f64, Result<Search<'_>, String>)]) -> String {
    let found: Vec<(f64, Search<'_>)> =
        searches.iter().filter_map(|(value, all)| Some((*value, *all.as_ref().ok()?))).collect();
    let mut names = vec![varied.column(), "complete".to_owned(), "number".to_owned()];
    names.extend(found.first().map_or_else(|| State::columns(cables, &[]), |(_, all)| columns(*all, cables)));
    let mut out = Rows::new(&names);
    for (value, all) in found {
        for (index, one) in states(all).iter().enumerate() {
            let mut cells = vec![cell(value), all.is_complete().to_string(), (index + 1).to_string()];
            cells.extend(one.cells(&[]));
            out.row(&cells);
        }
    }
    out.text()
}
