//! What an identification found, as JSON and CSV.

use hydrostat::Arm;
use hydrostat_identify::{Case, Fit, Loss, Miss, Prediction, Residual, misses};
use serde::Serialize;

use crate::csv_text::Rows;
use crate::results::{SCHEMA, cell, json};
use crate::written::Inputs;

#[derive(Debug, Clone, Serialize)]
struct EstimateOut {
    key: String,
    unit: &'static str,
    start: f64,
    estimate: f64,
    sd: Option<f64>,
    interval: Option<[Option<f64>; 2]>,
    bounds: [Option<f64>; 2],
    held_by: Option<&'static str>,
    prior: Option<PriorOut>,
}

#[derive(Debug, Clone, Serialize)]
struct PriorOut {
    mean: f64,
    sd: f64,
}

#[derive(Debug, Clone, Serialize)]
struct DirectionOut {
    singular_value: f64,
    weights: Vec<f64>,
}

#[derive(Debug, Clone, Serialize)]
struct ResidualOut {
    case: String,
    quantity: String,
    s: Option<f64>,
    offset: Option<[f64; 3]>,
    unit: &'static str,
    measured: f64,
    sd: f64,
    fitted: f64,
    residual: f64,
    weight: f64,
    row: Option<usize>,
}

#[derive(Debug, Clone, Serialize)]
struct LeftOutOut {
    case: String,
    within: f64,
    predicted: Option<f64>,
    message: Option<String>,
    shifts: Vec<f64>,
}

#[derive(Debug, Clone, Serialize)]
struct NoAnswerOut {
    case: String,
    trials: usize,
    at: Vec<f64>,
    message: String,
}

#[derive(Debug, Clone, Serialize)]
struct MissOut {
    s: f64,
    offset: [f64; 3],
    cases: usize,
    rms: f64,
    largest: f64,
}

impl MissOut {
    fn all(misses: Vec<Miss>) -> Vec<Self> {
        let out = |one: Miss| Self {
            s: one.marker.s,
            offset: one.marker.offset,
            cases: one.count,
            rms: one.rms,
            largest: one.most,
        };
        misses.into_iter().map(out).collect()
    }
}

#[derive(Debug, Clone, Serialize)]
struct PredictionsOut {
    residuals: Vec<ResidualOut>,
    misses: Vec<MissOut>,
    no_answer: Vec<UnansweredOut>,
}

#[derive(Debug, Clone, Serialize)]
struct UnansweredOut {
    case: String,
    message: String,
}

/// The document of a fit. Lengths in m, angles in rad; what is not known is null.
#[derive(Debug, Clone, Serialize)]
pub struct IdentificationDocument {
    schema: u32,
    version: &'static str,
    converged: bool,
    loss: &'static str,
    parameters: Vec<EstimateOut>,
    covariance: Vec<Vec<f64>>,
    correlation: Vec<Vec<f64>>,
    scales: Vec<f64>,
    directions: Vec<DirectionOut>,
    verdict: Vec<String>,
    chi_square: f64,
    freedom: i64,
    spread: f64,
    misfit: Option<String>,
    residuals: Vec<ResidualOut>,
    misses: Vec<MissOut>,
    predictions: Option<PredictionsOut>,
    cross_validation: Vec<LeftOutOut>,
    no_answer: Vec<NoAnswerOut>,
    rounds: usize,
    evaluations: usize,
    inputs: Inputs,
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn name(cases: &[Case], case: usize) -> String {
    cases.get(case).map(|case| case.name.clone()).unwrap_or_default()
}

fn residual(cases: &[Case], one: &Residual) -> ResidualOut {
    ResidualOut {
        case: name(cases, one.case),
        quantity: one.measurement.quantity.name(),
        s: one.measurement.quantity.place(),
        offset: one.measurement.quantity.marker().map(|(marker, _)| marker.offset),
        unit: one.measurement.quantity.unit(),
        measured: one.measurement.value,
        sd: one.measurement.sd,
        fitted: one.fitted,
        residual: one.standardised,
        weight: one.weight,
        row: (one.measurement.row > 0).then_some(one.measurement.row),
    }
}

impl IdentificationDocument {
    /// Of a fit to `cases`; `arm` is the fitted one, with the loads of its file.
    pub fn new(arm: &Arm, cases: &[Case], fit: &Fit, loss: Loss) -> Self {
        let name = |case: usize| name(cases, case);
        let parameters = fit.estimates.iter().map(|one| EstimateOut {
            key: one.fitted.parameter.to_string(),
            unit: one.fitted.parameter.unit(),
            start: one.fitted.start,
            estimate: one.value,
            sd: one.sd.and_then(finite),
            interval: one.interval.map(|ends| ends.map(finite)),
            bounds: one.fitted.bounds.map(finite),
            held_by: one.held.map(|side| if side == 0 { "lower" } else { "upper" }),
            prior: one.fitted.prior.map(|prior| PriorOut { mean: prior.mean, sd: prior.sd }),
        });
        let directions = fit.directions.iter().map(|direction| DirectionOut {
            singular_value: direction.singular_value,
            weights: direction.weights.clone(),
        });
        let left_out = fit.left_out.iter().map(|one| LeftOutOut {
            case: name(one.case),
            within: one.within,
            predicted: one.predicted.as_ref().ok().copied(),
            message: one.predicted.as_ref().err().map(ToString::to_string),
            shifts: one.shifts.clone(),
        });
        let no_answer = fit.no_answer.iter().map(|one| NoAnswerOut {
            case: name(one.case),
            trials: one.trials,
            at: one.at.clone(),
            message: one.why.to_string(),
        });
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            converged: fit.converged,
            loss: loss.name(),
            parameters: parameters.collect(),
            covariance: fit.covariance.clone(),
            correlation: fit.correlation.clone(),
            scales: fit.estimates.iter().map(|one| one.scale.size).collect(),
            directions: directions.collect(),
            verdict: fit.verdict(),
            chi_square: fit.chi_square,
            freedom: fit.freedom,
            spread: fit.spread,
            misfit: fit.misfit(),
            residuals: fit.residuals.iter().map(|one| residual(cases, one)).collect(),
            misses: MissOut::all(misses(&fit.residuals)),
            predictions: None,
            cross_validation: left_out.collect(),
            no_answer: no_answer.collect(),
            rounds: fit.rounds,
            evaluations: fit.evaluations,
            inputs: Inputs::new(arm),
        }
    }

    /// With load cases that were not fitted.
    #[must_use]
    pub fn with_predictions(mut self, cases: &[Case], predicted: &[Prediction]) -> Self {
        if predicted.is_empty() {
            return self;
        }
        let found = || predicted.iter().filter_map(|one| one.found.as_ref().ok()).flat_map(|(residuals, _)| residuals);
        let unanswered = |one: &Prediction| {
            let message = one.found.as_ref().err()?.to_string();
            Some(UnansweredOut { case: name(cases, one.case), message })
        };
        self.predictions = Some(PredictionsOut {
            residuals: found().map(|one| residual(cases, one)).collect(),
            misses: MissOut::all(misses(found())),
            no_answer: predicted.iter().filter_map(unanswered).collect(),
        });
        self
    }

    /// The document, one line.
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// Every measured number beside the fit, one row each.
pub fn residuals_csv(cases: &[Case], fit: &Fit) -> String {
    let mut out = Rows::new(&COLUMNS.map(str::to_owned));
    for one in &fit.residuals {
        out.row(&residual_row(cases, one));
    }
    out.text()
}

/// [`residuals_csv`] followed by the numbers of load cases that were not fitted, with a column that tells the two apart.
pub fn residuals_csv_with_predictions(cases: &[Case], fit: &Fit, others: &[Case], predicted: &[Prediction]) -> String {
    let mut names = COLUMNS.map(str::to_owned).to_vec();
    names.push("predicted".to_owned());
    let mut out = Rows::new(&names);
    let own = fit.residuals.iter().map(|one| (cases, one, false));
    let of_others = predicted.iter().filter_map(|one| one.found.as_ref().ok()).flat_map(|(residuals, _)| residuals);
    for (cases, one, was_predicted) in own.chain(of_others.map(|one| (others, one, true))) {
        let mut row = residual_row(cases, one).to_vec();
        row.push(was_predicted.to_string());
        out.row(&row);
    }
    out.text()
}

const COLUMNS: [&str; 10] =
    ["case", "quantity", "s_m", "unit", "measured", "sd", "fitted", "residual_sd", "weight", "row"];

fn residual_row(cases: &[Case], one: &Residual) -> [String; 10] {
    let quantity = one.measurement.quantity;
    [
        name(cases, one.case),
        quantity.name(),
        quantity.place().map_or_else(String::new, cell),
        quantity.unit().to_owned(),
        cell(one.measurement.value),
        cell(one.measurement.sd),
        cell(one.fitted),
        cell(one.standardised),
        cell(one.weight),
        if one.measurement.row == 0 { String::new() } else { one.measurement.row.to_string() },
    ]
}
