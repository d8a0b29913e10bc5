//! From load cases to estimates and what they are worth.

use std::fmt;

use hydrostat::Arm;
use nalgebra::DMatrix;

use crate::certainty::{Direction, correlation, covariance, directions};
use crate::chi_square::below;
use crate::cross_validation::{LeftOut, leave_out};
use crate::data::{Case, Fitted, Measurement, natural_bounds};
use crate::error::{IdentifyError, Trial};
use crate::least_squares::{Minimum, Settings};
use crate::loss::Loss;
use crate::model::{Cases, KEPT, Observed, Refusal, residuals};
use crate::search::search;
use crate::shape::Shape;
use crate::student::{NORMAL_95, student_95};
use crate::unknown::{Unknown, set_all};
use crate::verdict::{Finding, Scale, findings, verdict};

/// Sums of squares that are this rare, on both sides together, are none that standard deviations say.
const RARE: f64 = 3e-3;
/// Residuals that are so much smaller than standard deviations are none of measured numbers.
const FAR: f64 = 0.1;

/// How parameters are fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitOptions {
    /// How far-out residuals count.
    pub loss: Loss,
    /// Whether standard deviations are known up to a common factor only, which the residuals then give.
    pub rescale: bool,
    /// Whether to fit again without each load case and predict it; not done for more than 200.
    pub cross_validate: bool,
    /// Error of the tip position over L that every solve is asked for, in [1e-12, 1e-2].
    pub tol: f64,
    /// The most steps of the search.
    pub rounds: usize,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self { loss: Loss::None, rescale: false, cross_validate: true, tol: 1e-8, rounds: 100 }
    }
}

/// How far the work is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress {
    /// Steps of the search, and half the sum of squares (or of what the loss makes of them) there.
    Round(usize, f64),
    /// Cross-validation: load cases done, and of how many. Told at every step of the fit that leaves one out.
    LeftOut(usize, usize),
}

impl fmt::Display for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Round(round, cost) => write!(f, "step {round}: half the sum of squares {cost:.4}"),
            Self::LeftOut(done, all) => write!(f, "load case {done} of {all} left out"),
        }
    }
}

/// A parameter that was fitted, in its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// What was asked for.
    pub fitted: Fitted,
    /// The value found.
    pub value: f64,
    /// Standard deviation; infinite where the data know nothing of it, none where a bound holds it.
    pub sd: Option<f64>,
    /// 95 %, cut off at the bounds; infinite or none as `sd`.
    pub interval: Option<[f64; 2]>,
    /// The bound that holds it: 0 the lower, 1 the upper.
    pub held: Option<usize>,
    /// What it is compared by in verdicts.
    pub scale: Scale,
}

/// A measured number beside the fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Index of the load case.
    pub case: usize,
    /// What was measured.
    pub measurement: Measurement,
    /// What the fitted arm has.
    pub fitted: f64,
    /// Fitted less measured, in standard deviations.
    pub standardised: f64,
    /// The fraction of its pull that the loss leaves it, in (0, 1].
    pub weight: f64,
}

/// Trials at which a load case had no answer.
#[derive(Debug, Clone)]
pub struct NoAnswer {
    /// Index of the load case.
    pub case: usize,
    /// How many trials.
    pub trials: usize,
    /// The last of them, in the order of the parameters.
    pub at: Vec<f64>,
    /// Why.
    pub why: Trial,
}

/// What the data say.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The parameters, in the order asked for.
    pub estimates: Vec<Estimate>,
    /// Their covariances; infinite and NaN where the data know nothing.
    pub covariance: Vec<Vec<f64>>,
    /// Covariances over standard deviations.
    pub correlation: Vec<Vec<f64>>,
    /// Combinations of the parameters in their scales, the one that the data know least first. Priors are left aside.
    pub directions: Vec<Direction>,
    /// What the data cannot tell.
    pub findings: Vec<Finding>,
    /// Every measured number, case by case.
    pub residuals: Vec<Residual>,
    /// Sum of the squares of all residuals, those from priors too.
    pub chi_square: f64,
    /// Numbers that were measured or known before less parameters that no bound holds.
    pub freedom: i64,
    /// The factor on standard deviations, one unless these are rescaled.
    pub spread: f64,
    /// Load cases with measured numbers.
    pub load_cases: usize,
    /// The fitted arm in the first 200 of them: the index of the case, and the shape.
    pub shapes: Vec<(usize, Shape)>,
    /// What each load case is predicted to be by the others; empty if not asked for, for one load case and for more than 200.
    pub left_out: Vec<LeftOut>,
    /// Load cases without an answer on the way.
    pub no_answer: Vec<NoAnswer>,
    /// Steps taken.
    pub rounds: usize,
    /// How often all load cases were solved.
    pub evaluations: usize,
    /// Whether the search came to its end.
    pub converged: bool,
}

impl Fit {
    /// `arm` with the estimates; factors multiply its tensions.
    pub fn applied_to(&self, arm: &Arm) -> Arm {
        let unknowns: Vec<Unknown> = self.estimates.iter().map(|one| one.fitted.parameter).collect();
        let values: Vec<f64> = self.estimates.iter().map(|one| one.value).collect();
        set_all(arm, &unknowns, &values)
    }

    /// How a parameter is compared with others.
    fn scale(&self, parameter: Unknown) -> Scale {
        let own = self.estimates.iter().find(|one| one.fitted.parameter == parameter);
        own.map_or(Scale { size: 1.0, own: false }, |one| one.scale)
    }

    /// Which parameters the data cannot tell apart, in sentences.
    pub fn verdict(&self) -> Vec<String> {
        verdict(&self.findings, |parameter| self.scale(parameter))
    }

    /// Whether residuals agree with the standard deviations, in a sentence: by the chi-square distribution, on both sides, three in a
    /// thousand being too few. `None` where there are too few numbers to tell.
    pub fn misfit(&self) -> Option<String> {
        let freedom = usize::try_from(self.freedom).ok().filter(|freedom| *freedom > 0)?;
        let ratio = (self.chi_square / freedom as f64).sqrt();
        let below = below(self.chi_square, freedom);
        Some(if below > 1.0 - 0.5 * RARE {
            format!(
                "residuals are {ratio:.2} times as large as the standard deviations predict: the standard deviations are too small, or the model \
                 is incomplete"
            )
        } else if below < 0.5 * RARE && ratio < FAR {
            format!(
                "residuals are far smaller than the standard deviations predict ({ratio:.1e} times): the standard deviations are too large, or \
                 the values were not measured"
            )
        } else if below < 0.5 * RARE {
            format!(
                "residuals are {ratio:.2} times as large as the standard deviations predict: the standard deviations are too large"
            )
        } else {
            "residuals agree with the standard deviations".to_owned()
        })
    }
}

/// Fits parameters to load cases. `say` is told how far the work is, and says whether to go on: else the fit is what was found until there.
///
/// ```
/// use hydrostat::{Arm, Cable, Parameter, Profile};
/// use hydrostat_identify::{Case, FitOptions, Fitted, Measurement, Quantity, fit};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// let mut cases = Vec::new();
/// for tension in [0.1, 0.2, 0.3] {
///     arm.cables[0].tension = tension; // N
///     let tip = arm.solve()?.tip();
///     let measurements = vec![Measurement::new(Quantity::X(0.245), tip.x, 1e-3), Measurement::new(Quantity::Y(0.245), tip.y, 1e-3)];
///     cases.push(Case { name: format!("{tension} N"), arm: arm.clone(), measurements });
/// }
///
/// let young = Fitted { start: 80e3, ..Fitted::new(Parameter::Young, &arm).expect("a cone is homogeneous") };
/// let found = fit(&cases, &[young], &FitOptions::default(), |_| true).expect("these can be solved");
/// assert!((found.estimates[0].value / 110e3 - 1.0).abs() < 1e-6);
/// assert_eq!(found.verdict(), ["the data determine all parameters"]);
/// # Ok::<(), hydrostat::SolveError>(())
/// ```
///
/// # Errors
/// [`IdentifyError`]. A load case that has no answer at trial values is none: it is named in [`Fit::no_answer`].
pub fn fit(
    cases: &[Case],
    fitted: &[Fitted],
    options: &FitOptions,
    mut say: impl FnMut(Progress) -> bool,
) -> Result<Fit, IdentifyError> {
    let fitted = checked(fitted)?;
    let measured: usize = cases.iter().map(|case| case.measurements.len()).sum();
    if measured == 0 {
        return Err(IdentifyError::NoData);
    }
    if options.rescale && measured <= fitted.len() {
        return Err(IdentifyError::Freedom { measured, parameters: fitted.len() });
    }
    let (mut model, index) = model_of(cases, fitted, options.tol)?;
    let settings = Settings { loss: options.loss, rounds: options.rounds, ..Settings::default() };
    let mut go_on = true;
    let found = search(&mut model, &settings, |rounds, cost| {
        go_on = say(Progress::Round(rounds, cost));
        go_on
    });
    let found = found.map_err(|refusal| start(cases, &index, refusal))?;
    // The answers at hand may be those of a trial.
    let at_end = crate::least_squares::Model::evaluate(&mut model, &found.x);
    let rows = at_end.map_err(|refusal| start(cases, &index, refusal))?;

    let count = model.fitted.len();
    let free: Vec<usize> = (0..count).filter(|k| found.held[*k].is_none()).collect();
    let chi_square = rows.residuals.norm_squared();
    let freedom = signed(rows.residuals.len()) - signed(free.len());
    let spread = if options.rescale { (chi_square / (freedom.max(1)) as f64).sqrt() } else { 1.0 };
    let quantile = if options.rescale { student_95(usize::try_from(freedom).unwrap_or(1)) } else { NORMAL_95 };
    let covariance = covariance(&rows, options.loss, &free, spread);
    let estimates = estimates(&model.fitted, &found, &covariance, quantile);
    let sizes: Vec<f64> = estimates.iter().map(|one| one.scale.size).collect();
    let unknowns = model.unknowns();
    let directions = directions(&rows, &sizes);
    let correlation = correlation(&covariance);
    let findings = findings(&unknowns, &directions, &correlation);
    let left_out = if options.cross_validate && (2..=KEPT).contains(&model.observed.len()) && go_on {
        let sds: Vec<f64> = estimates.iter().map(|one| one.sd.unwrap_or(f64::INFINITY)).collect();
        leave_out(&model, &index, (&found.x, &sds), &settings, |done, all| say(Progress::LeftOut(done, all)))
    } else {
        Vec::new()
    };
    Ok(Fit {
        estimates,
        correlation,
        covariance: (0..count).map(|i| covariance.row(i).iter().copied().collect()).collect(),
        directions,
        findings,
        residuals: all_residuals(&model, &index, options.loss),
        chi_square,
        freedom,
        spread,
        load_cases: index.len(),
        shapes: shapes(&mut model, &index),
        left_out,
        no_answer: no_answer(&found, &index),
        rounds: found.rounds,
        evaluations: found.evaluations,
        converged: found.converged,
    })
}

/// The load cases that have numbers, and their indices: one without would be solved for nothing.
fn model_of(cases: &[Case], fitted: Vec<Fitted>, tol: f64) -> Result<(Cases, Vec<usize>), IdentifyError> {
    let index: Vec<usize> = (0..cases.len()).filter(|i| !cases[*i].measurements.is_empty()).collect();
    let observed: Result<_, _> =
        index.iter().enumerate().map(|(count, i)| Observed::new(&cases[*i], count < KEPT, &fitted, tol)).collect();
    Ok((Cases { observed: observed?, fitted, answers: Vec::new() }, index))
}

/// Each parameter with its standard deviation and interval, which a bound that holds it leaves without a meaning.
fn estimates(fitted: &[Fitted], found: &Minimum<Refusal>, covariance: &DMatrix<f64>, quantile: f64) -> Vec<Estimate> {
    let estimate = |(k, one): (usize, &Fitted)| {
        let (value, held) = (found.x[k], found.held[k]);
        let sd = held.is_none().then(|| covariance[(k, k)].sqrt());
        let cut = |x: f64| x.max(one.bounds[0]).min(one.bounds[1]);
        let interval = sd.map(|sd| [cut(value - quantile * sd), cut(value + quantile * sd)]);
        Estimate { fitted: *one, value, sd, interval, held, scale: Scale::of(value, one.prior.map(|prior| prior.sd)) }
    };
    fitted.iter().enumerate().map(estimate).collect()
}

/// The shapes of the last evaluation that were kept, with the indices of their cases.
fn shapes(model: &mut Cases, index: &[usize]) -> Vec<(usize, Shape)> {
    let kept = index.iter().zip(&mut model.answers).filter_map(|(i, one)| Some((*i, one.shape.take()?)));
    kept.collect()
}

/// Counts as numbers with a sign.
fn signed(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

fn start(cases: &[Case], index: &[usize], refusal: Refusal) -> IdentifyError {
    IdentifyError::Start { case: cases[index[refusal.case]].name.clone(), source: Box::new(refusal.why) }
}

/// Parameters within what makes an arm.
fn checked(fitted: &[Fitted]) -> Result<Vec<Fitted>, IdentifyError> {
    if fitted.is_empty() {
        return Err(IdentifyError::NoParameter);
    }
    let mut out: Vec<Fitted> = Vec::new();
    for one in fitted {
        let parameter = one.parameter;
        if out.iter().any(|other| other.parameter == parameter) {
            return Err(IdentifyError::Twice(parameter));
        }
        let [least, most] = natural_bounds(parameter);
        let bounds = [one.bounds[0].max(least), one.bounds[1].min(most)];
        let range = |expected, found| Err(IdentifyError::Range { parameter, expected, found });
        if bounds[0] >= bounds[1] || bounds.iter().any(|bound| bound.is_nan()) {
            return range("a lower bound below the upper one, both possible for an arm", one.bounds[0]);
        }
        if !one.start.is_finite() {
            return range("a finite start", one.start);
        }
        if !(bounds[0]..=bounds[1]).contains(&one.start) {
            return range("a start within the bounds", one.start);
        }
        if let Some(prior) = one.prior
            && !(prior.sd > 0.0 && prior.sd.is_finite() && prior.mean.is_finite())
        {
            return range("a prior with a standard deviation above zero", prior.sd);
        }
        out.push(Fitted { bounds, ..*one });
    }
    Ok(out)
}

fn all_residuals(model: &Cases, index: &[usize], loss: Loss) -> Vec<Residual> {
    let all = model.observed.iter().zip(&model.answers).zip(index);
    all.flat_map(|((one, answer), case)| residuals_of(&one.case, *case, &answer.values, loss)).collect()
}

/// The measured numbers of load case `index` beside `values`.
pub(crate) fn residuals_of(case: &Case, index: usize, values: &[f64], loss: Loss) -> Vec<Residual> {
    let all = case.measurements.iter().zip(values).zip(residuals(case, values));
    let one = |((measurement, fitted), standardised): ((&Measurement, &f64), f64)| {
        let weight = loss.weight(standardised);
        Residual { case: index, measurement: *measurement, fitted: *fitted, standardised, weight }
    };
    all.map(one).collect()
}

fn no_answer(found: &Minimum<Refusal>, index: &[usize]) -> Vec<NoAnswer> {
    let mut out: Vec<NoAnswer> = Vec::new();
    for refused in &found.refused {
        let case = index[refused.why.case];
        match out.iter_mut().find(|one| one.case == case) {
            Some(one) => {
                one.trials += 1;
                (one.at, one.why) = (refused.at.clone(), refused.why.why.clone());
            }
            None => out.push(NoAnswer { case, trials: 1, at: refused.at.clone(), why: refused.why.why.clone() }),
        }
    }
    out
}
