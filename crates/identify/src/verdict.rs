//! What the data can tell, in words.

use crate::certainty::Direction;
use crate::unknown::Unknown;

/// Below this many standard deviations a unit of scale, 95 % of a direction span more than the scale itself.
const UNSEEN: f64 = 2.0;
/// Correlations from which parameters are hard to tell apart.
const CLOSE: f64 = 0.95;
/// Components of a direction that count, over its largest.
const PART: f64 = 0.3;

/// Something that the data do not tell well.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// One parameter that the data hardly depend on.
    Silent {
        /// Which.
        parameter: Unknown,
        /// How many standard deviations the measured numbers move when it moves by its scale.
        moves: f64,
    },
    /// Parameters of which the data know a combination only.
    Inseparable {
        /// Each with its fraction of the direction that is not known, the largest one.
        parameters: Vec<(Unknown, f64)>,
        /// How many standard deviations the measured numbers move along it when the largest moves by its scale.
        moves: f64,
    },
    /// Two parameters that are known, and their combination much better.
    Close {
        /// The two.
        parameters: [Unknown; 2],
        /// Between their estimates.
        correlation: f64,
    },
}

/// How a parameter is measured where it is compared with others: by its own size, or, at zero, by a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// In the parameter's unit.
    pub size: f64,
    /// Whether that is the size of the estimate.
    pub own: bool,
}

impl Scale {
    pub(crate) fn of(value: f64, prior: Option<f64>) -> Self {
        match prior {
            _ if value != 0.0 => Self { size: value.abs(), own: true },
            Some(sd) => Self { size: sd, own: false },
            None => Self { size: 1.0, own: false },
        }
    }
}

/// What the directions of the data and the correlations of the estimates say.
pub(crate) fn findings(parameters: &[Unknown], directions: &[Direction], correlation: &[Vec<f64>]) -> Vec<Finding> {
    let mut out = Vec::new();
    let mut told: Vec<Unknown> = Vec::new();
    for direction in directions.iter().filter(|direction| direction.singular_value < UNSEEN) {
        let largest = direction.weights.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
        let parts: Vec<(Unknown, f64)> = parameters
            .iter()
            .zip(&direction.weights)
            .filter(|(_, w)| w.abs() >= PART * largest)
            .map(|(parameter, w)| (*parameter, w / largest))
            .collect();
        let moves = direction.singular_value / largest;
        told.extend(parts.iter().map(|(parameter, _)| *parameter));
        out.push(match parts.as_slice() {
            [(parameter, _)] => Finding::Silent { parameter: *parameter, moves },
            _ => Finding::Inseparable { parameters: parts, moves },
        });
    }
    for (i, row) in correlation.iter().enumerate() {
        for (j, correlation) in row.iter().enumerate().skip(i + 1) {
            let pair = [parameters[i], parameters[j]];
            if correlation.abs() >= CLOSE && !pair.iter().all(|own| told.contains(own)) {
                out.push(Finding::Close { parameters: pair, correlation: *correlation });
            }
        }
    }
    out
}

/// A number with two digits that matter.
fn short(value: f64) -> String {
    let text = format!("{value:.1e}");
    let plain: f64 = text.parse().unwrap_or(value);
    if (1e-3..1e4).contains(&plain.abs()) { format!("{plain}") } else { text }
}

/// By how much a parameter is moved, in words: a tenth of its scale times `fraction`.
fn step(parameter: Unknown, scale: Scale, fraction: f64) -> String {
    let way = if fraction < 0.0 { "down" } else { "up" };
    if scale.own {
        format!("{parameter} {way} by {} %", short(10.0 * fraction.abs()))
    } else {
        let unit = parameter.unit();
        format!("{parameter} {way} by {} {unit}", short(0.1 * scale.size * fraction.abs())).trim_end().to_owned()
    }
}

fn joined(words: &[String], last: &str) -> String {
    match words {
        [rest @ .., end] if !rest.is_empty() => format!("{} {last} {end}", rest.join(", ")),
        _ => words.concat(),
    }
}

impl Finding {
    /// In a sentence or two. `scale` has those of the parameters that were fitted.
    pub fn words(&self, scale: impl Fn(Unknown) -> Scale) -> String {
        const HELP: &str = "Fix one of them, add a prior, or measure a case in which their effects differ";
        let sds = |moves: f64| match short(0.1 * moves).as_str() {
            _ if moves < 1e-6 => "the measured values by no more than rounding".to_owned(),
            text => format!("the measured values by {text} standard deviations in total"),
        };
        match self {
            Self::Silent { parameter, moves } => {
                let size = step(*parameter, scale(*parameter), 1.0);
                format!(
                    "the data hardly constrain {parameter}: {size} changes {}. Fix it, add a prior, or measure a case that depends on it",
                    sds(*moves)
                )
            }
            Self::Inseparable { parameters, moves } => {
                let names: Vec<String> = parameters.iter().map(|(parameter, _)| parameter.to_string()).collect();
                let steps: Vec<String> =
                    parameters.iter().map(|(p, fraction)| step(*p, scale(*p), *fraction)).collect();
                format!(
                    "the data do not separate {}: {} changes {}. {HELP}",
                    joined(&names, "and"),
                    joined(&steps, "with"),
                    sds(*moves)
                )
            }
            Self::Close { parameters: [a, b], correlation } => format!(
                "the data hardly separate {a} and {b}: their estimates have a correlation of {correlation:.3}, and a combination of them is \
                 known much better than either. {HELP}"
            ),
        }
    }
}

/// The whole verdict: its sentences, or that there is nothing to say.
pub(crate) fn verdict(findings: &[Finding], scale: impl Fn(Unknown) -> Scale) -> Vec<String> {
    if findings.is_empty() {
        return vec!["the data determine all parameters".to_owned()];
    }
    findings.iter().map(|finding| finding.words(&scale)).collect()
}
