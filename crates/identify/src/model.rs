//! Load cases as rows: what an equilibrium has of each measured number, and how it follows the parameters.

use hydrostat::parameter::Unfit;
use hydrostat::{
    Arm, Configuration, Options, Parameter, PoseChange, Sensitivities, SensitivityError, SensitivityOptions, Solver,
    Support,
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::data::{Case, Fitted, Quantity};
use crate::error::{IdentifyError, Trial};
use crate::least_squares::{Model, Rows};

/// Places (over L) that are this near are the same, and one this far beyond an end is at it.
const SAME: f64 = 1e-9;

/// So many load cases keep their solvers and shapes, some 0.4 MB each; others are solved anew.
pub(crate) const KEPT: usize = 200;

/// A load case with its solver, which starts from its last answer.
#[derive(Debug, Clone)]
pub(crate) struct Observed {
    pub(crate) case: Case,
    kept: bool,
    /// Places along the arm, m, that were measured.
    stations: Vec<f64>,
    options: Options,
    solver: Option<Box<Solver>>,
}

/// What a case comes to.
#[derive(Debug, Clone)]
pub(crate) struct Answer {
    /// Of the model, one a measurement.
    pub(crate) values: Vec<f64>,
    /// By the parameters, one row a measurement.
    pub(crate) rows: Vec<Vec<f64>>,
    /// Of cases that keep it.
    pub(crate) shape: Option<Configuration>,
}

impl Observed {
    pub(crate) fn new(case: &Case, kept: bool, fitted: &[Fitted], tol: f64) -> Result<Self, IdentifyError> {
        let name = || case.name.clone();
        let mut arm = case.arm.clone();
        for one in fitted {
            let commanded = |c: usize| arm.cables.get(c).map(|cable| cable.stroke.is_some());
            let wrong = match one.parameter {
                Parameter::Tension(c) if commanded(c) == Some(true) => Some(SensitivityError::Commanded(c)),
                Parameter::Stroke(c) if commanded(c) == Some(false) => Some(SensitivityError::NotCommanded(c)),
                _ => None,
            };
            if let Some(wrong) = wrong {
                return Err(IdentifyError::Start { case: name(), source: Box::new(wrong.into()) });
            }
            if one.parameter == Parameter::Length {
                return Err(IdentifyError::Unfit { case: name(), source: Unfit::Places });
            }
            let source = one.parameter.set(&mut arm, one.start);
            source.map_err(|source| IdentifyError::Unfit { case: name(), source })?;
        }
        let mut stations: Vec<f64> = Vec::new();
        for one in &case.measurements {
            if !(one.sd > 0.0 && one.sd.is_finite() && one.value.is_finite()) {
                let (quantity, value, sd) = (one.quantity, one.value, one.sd);
                return Err(IdentifyError::Measurement { case: name(), quantity, value, sd });
            }
            if let Some(why) = missing(&arm, one.quantity) {
                return Err(IdentifyError::Quantity { case: name(), quantity: one.quantity, why });
            }
            if let Some(s) = one.quantity.place().map(|s| s.clamp(0.0, arm.length))
                && !stations.iter().any(|own| (own - s).abs() <= SAME * arm.length)
            {
                stations.push(s);
            }
        }
        let case = Case { arm, ..case.clone() };
        Ok(Self { case, kept, stations, options: Options::with_tol(tol), solver: None })
    }

    /// The arm at these values of the parameters.
    fn arm_at(&self, parameters: &[Parameter], x: &[f64]) -> Arm {
        let mut arm = self.case.arm.clone();
        for (parameter, x) in parameters.iter().zip(x) {
            // That the arm has it was checked.
            let _ = parameter.set(&mut arm, *x);
        }
        arm
    }

    pub(crate) fn answer(&mut self, parameters: &[Parameter], x: &[f64]) -> Result<Answer, Trial> {
        let arm = self.arm_at(parameters, x);
        let mut solver = match self.solver.take() {
            Some(mut solver) => {
                solver.set_arm(&arm)?;
                solver
            }
            None => Box::new(Solver::new(&arm, self.options)?),
        };
        let wanted = SensitivityOptions { stations: self.stations.clone(), ..SensitivityOptions::default() };
        // What a trial without an answer leaves behind is no start for the next one.
        let found = solver.sensitivities_with(parameters, &wanted)?;
        let shape = solver.configuration()?;
        self.solver = self.kept.then_some(solver);
        let (mut values, mut rows) = (Vec::new(), Vec::new());
        for one in &self.case.measurements {
            values.push(value_of(&shape, one.quantity));
            rows.push((0..parameters.len()).map(|k| self.change(&found, one.quantity, k)).collect());
        }
        Ok(Answer { values, rows, shape: self.kept.then_some(shape) })
    }

    /// d quantity / d parameter `k`.
    fn change(&self, found: &Sensitivities, quantity: Quantity, k: usize) -> f64 {
        let pose = |s: f64| {
            let off = |own: f64| (own - s).abs();
            let at = (0..self.stations.len()).min_by(|a, b| off(self.stations[*a]).total_cmp(&off(self.stations[*b])));
            at.map_or(PoseChange::default(), |at| found.stations[at].changes[k])
        };
        match quantity {
            Quantity::X(s) => pose(s).x,
            Quantity::Y(s) => pose(s).y,
            Quantity::Angle(s) => pose(s).theta,
            Quantity::Tangent(s) => pose(s).theta + pose(s).alpha,
            Quantity::Stroke(c) => found.strokes[c][k],
            Quantity::Tension(c) => found.tensions[c][k],
            Quantity::BaseForce(axis) => found.base[k].force[axis.min(1)],
            Quantity::BaseMoment => found.base[k].moment,
        }
    }
}

/// Why a case does not have a quantity.
fn missing(arm: &Arm, quantity: Quantity) -> Option<String> {
    let cable = |c: usize| match arm.cables.get(c) {
        None => Err(format!("was measured of an arm with {} cables, counted from 0", arm.cables.len())),
        Some(cable) => Ok(cable.stroke.is_some()),
    };
    match quantity {
        Quantity::Stroke(c) => match cable(c) {
            Ok(false) => None,
            Ok(true) => Some("is commanded in this case: it says nothing".to_owned()),
            Err(why) => Some(why),
        },
        Quantity::Tension(c) => match cable(c) {
            Ok(true) => None,
            Ok(false) => {
                Some("is given in this case: it says nothing. Command the stroke of the cable instead".to_owned())
            }
            Err(why) => Some(why),
        },
        Quantity::BaseForce(_) | Quantity::BaseMoment if arm.readings.support != Support::Clamped => {
            Some("follows no equilibrium with support = \"unstrained-base\"".to_owned())
        }
        _ => {
            let (s, slack) = (quantity.place()?, SAME * arm.length);
            let on = (-slack..=arm.length + slack).contains(&s);
            (!on).then(|| format!("is beyond the arm, which is {} mm long", 1e3 * arm.length))
        }
    }
}

/// What a configuration has of a quantity.
pub fn value_of(shape: &Configuration, quantity: Quantity) -> f64 {
    match quantity {
        Quantity::X(s) => shape.at(s).x,
        Quantity::Y(s) => shape.at(s).y,
        Quantity::Angle(s) => shape.at(s).theta,
        Quantity::Tangent(s) => {
            let place = shape.at(s);
            place.theta + place.alpha
        }
        Quantity::Stroke(c) => shape.cables.get(c).map_or(f64::NAN, |cable| cable.stroke),
        Quantity::Tension(c) => shape.cables.get(c).map_or(f64::NAN, |cable| cable.tension),
        Quantity::BaseForce(axis) => shape.base_reaction.force[axis.min(1)],
        Quantity::BaseMoment => shape.base_reaction.moment,
    }
}

/// All load cases together.
#[derive(Debug, Clone)]
pub(crate) struct Cases {
    pub(crate) observed: Vec<Observed>,
    pub(crate) fitted: Vec<Fitted>,
    /// The last answers.
    pub(crate) answers: Vec<Answer>,
}

/// A trial that a case refused.
#[derive(Debug, Clone)]
pub(crate) struct Refusal {
    pub(crate) case: usize,
    pub(crate) why: Trial,
}

impl Cases {
    pub(crate) fn parameters(&self) -> Vec<Parameter> {
        self.fitted.iter().map(|one| one.parameter).collect()
    }

    /// Without load case `left_out`.
    pub(crate) fn without(&self, left_out: usize) -> Self {
        let kept = self.observed.iter().enumerate().filter(|(i, _)| *i != left_out);
        Self { observed: kept.map(|(_, one)| one.clone()).collect(), fitted: self.fitted.clone(), answers: Vec::new() }
    }
}

/// Residuals of a case in standard deviations.
pub(crate) fn residuals<'a>(case: &'a Case, values: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    case.measurements.iter().zip(values).map(|(one, value)| {
        let off = value - one.value;
        // Angles that differ by whole turns are the same angle.
        let turn = std::f64::consts::TAU;
        let off = if one.quantity.unit() == "rad" { off - turn * (off / turn).round() } else { off };
        off / one.sd
    })
}

impl Model for Cases {
    type Refusal = Refusal;

    fn evaluate(&mut self, x: &[f64]) -> Result<Rows, Refusal> {
        let parameters = self.parameters();
        let all: Vec<Result<Answer, Trial>> =
            self.observed.par_iter_mut().map(|one| one.answer(&parameters, x)).collect();
        let mut answers = Vec::with_capacity(all.len());
        for (case, answer) in all.into_iter().enumerate() {
            answers.push(answer.map_err(|why| Refusal { case, why })?);
        }
        let measured: usize = answers.iter().map(|answer| answer.values.len()).sum();
        let priors = self.fitted.iter().filter(|one| one.prior.is_some()).count();
        let mut out = DVector::zeros(measured + priors);
        let mut jacobian = DMatrix::zeros(measured + priors, x.len());
        let mut row = 0;
        for (one, answer) in self.observed.iter().zip(&answers) {
            let own = residuals(&one.case, &answer.values).zip(&answer.rows).zip(&one.case.measurements);
            for ((residual, by), measurement) in own {
                out[row] = residual;
                for (k, by) in by.iter().enumerate() {
                    jacobian[(row, k)] = by / measurement.sd;
                }
                row += 1;
            }
        }
        for (k, prior) in self.fitted.iter().enumerate().filter_map(|(k, one)| Some((k, one.prior?))) {
            out[row] = (x[k] - prior.mean) / prior.sd;
            jacobian[(row, k)] = 1.0 / prior.sd;
            row += 1;
        }
        self.answers = answers;
        Ok(Rows { residuals: out, jacobian, measured })
    }
}
