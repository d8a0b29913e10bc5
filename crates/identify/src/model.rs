//! Load cases as rows: what an equilibrium has of each measured number, and how it follows the parameters.

use hydrostat::parameter::Unfit;
use hydrostat::{
    Arm, Configuration, Options, Parameter, PoseChange, Sensitivities, SensitivityError, SensitivityOptions, Solver,
    SpatialConfiguration, SpatialPoseChange, SpatialSolver, SpatialWrench, Support,
};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::data::{Case, Fitted};
use crate::error::{IdentifyError, Trial};
use crate::least_squares::{Model, Rows};
use crate::quantity::Quantity;
use crate::shape::{Shape, off_in_plane, off_in_space, value_in_space, value_of};
use crate::unknown::{Chain, Unknown, set_all};

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
    pub(crate) shape: Option<Shape>,
}

impl Observed {
    pub(crate) fn new(case: &Case, kept: bool, fitted: &[Fitted], tol: f64) -> Result<Self, IdentifyError> {
        let name = || case.name.clone();
        let mut arm = case.arm.clone();
        for one in fitted {
            let commanded = |c: usize| arm.cables.get(c).map(|cable| cable.stroke.is_some());
            let wrong: Option<SensitivityError> = match one.parameter.parameter() {
                Some(Parameter::Tension(c)) if commanded(c) == Some(true) => Some(SensitivityError::Commanded(c)),
                Some(Parameter::Stroke(c)) if commanded(c) == Some(false) => Some(SensitivityError::NotCommanded(c)),
                _ => None,
            };
            if let Some(wrong) = wrong {
                return Err(IdentifyError::Start { case: name(), source: Box::new(wrong.into()) });
            }
            if one.parameter == Parameter::Length {
                return Err(IdentifyError::Unfit { case: name(), source: Unfit::Places });
            }
            let unfit = |source| IdentifyError::Unfit { case: name(), source };
            match one.parameter.parameter() {
                Some(parameter) => parameter.set(&mut arm, one.start).map_err(unfit)?,
                None => one.parameter.of(&arm).map(|_| ()).map_err(unfit)?,
            }
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

    pub(crate) fn answer(&mut self, unknowns: &[Unknown], x: &[f64]) -> Result<Answer, Trial> {
        let arm = set_all(&self.case.arm, unknowns, x);
        let chain = Chain::new(&self.case.arm, unknowns, x);
        if arm.space.is_some() { self.in_space(&arm, &chain) } else { self.in_plane(&arm, &chain) }
    }

    fn wanted(&self) -> SensitivityOptions {
        SensitivityOptions { stations: self.stations.clone(), ..SensitivityOptions::default() }
    }

    fn in_plane(&mut self, arm: &Arm, chain: &Chain) -> Result<Answer, Trial> {
        let mut solver = match self.solver.take() {
            Some(mut solver) => {
                solver.set_arm(arm)?;
                solver
            }
            None => Box::new(Solver::new(arm, self.options)?),
        };
        // What a trial without an answer leaves behind is no start for the next one.
        let found = solver.sensitivities_with(&chain.parameters, &self.wanted())?;
        let shape = solver.configuration()?;
        self.solver = self.kept.then_some(solver);
        let all = self.case.measurements.iter().map(|one| one.quantity);
        let values = all.clone().map(|quantity| value_of(&shape, quantity)).collect();
        let rows =
            all.map(|quantity| chain.row(quantity, |k| self.change_in_plane(&found, &shape, quantity, k))).collect();
        Ok(Answer { values, rows, shape: self.kept.then(|| Shape::Plane(Box::new(shape))) })
    }

    /// Solved anew: what an arm in space is given can only change by its tensions.
    fn in_space(&self, arm: &Arm, chain: &Chain) -> Result<Answer, Trial> {
        let mut solver = SpatialSolver::new(arm, self.options).map_err(SensitivityError::Solve)?;
        let shape = solver.solve().map_err(SensitivityError::Solve)?;
        let found = solver.sensitivities_with(&chain.parameters, &self.wanted())?;
        let all = self.case.measurements.iter().map(|one| one.quantity);
        let values = all.clone().map(|quantity| value_in_space(&shape, quantity)).collect();
        let rows =
            all.map(|quantity| chain.row(quantity, |k| self.change_in_space(&found, &shape, quantity, k))).collect();
        Ok(Answer { values, rows, shape: self.kept.then(|| Shape::Space(Box::new(shape))) })
    }

    /// The change of the pose at a place that was measured.
    fn pose<P: Copy + Default, W>(&self, found: &Sensitivities<P, W>, s: f64, k: usize) -> P {
        let off = |own: f64| (own - s).abs();
        let at = (0..self.stations.len()).min_by(|a, b| off(self.stations[*a]).total_cmp(&off(self.stations[*b])));
        at.map_or(P::default(), |at| found.stations[at].changes[k])
    }

    /// d quantity / d parameter `k`.
    fn change_in_plane(&self, found: &Sensitivities, shape: &Configuration, quantity: Quantity, k: usize) -> f64 {
        let pose = |s: f64| -> PoseChange { self.pose(found, s, k) };
        match quantity {
            Quantity::X(s) => pose(s).x,
            Quantity::Y(s) => pose(s).y,
            // An arrow that turns by d theta goes by d theta k x arrow.
            Quantity::Off(marker, axis) => {
                let (change, [x, y]) = (pose(marker.s), off_in_plane(&shape.at(marker.s), marker.offset));
                if axis == 0 { change.x - change.theta * y } else { change.y + change.theta * x }
            }
            Quantity::Angle(s) => pose(s).theta,
            Quantity::Tangent(s) => pose(s).theta + pose(s).alpha,
            Quantity::Stroke(c) => found.strokes[c][k],
            Quantity::Tension(c) => found.tensions[c][k],
            Quantity::BaseForce(axis) => found.base[k].force[axis.min(1)],
            Quantity::BaseMoment => found.base[k].moment,
            // An arm in the plane has none of these, which was checked.
            Quantity::Z(_) | Quantity::BaseMomentAbout(_) => 0.0,
        }
    }

    /// d quantity / d parameter `k`.
    fn change_in_space(
        &self,
        found: &Sensitivities<SpatialPoseChange, SpatialWrench>,
        shape: &SpatialConfiguration,
        quantity: Quantity,
        k: usize,
    ) -> f64 {
        if let Some((marker, axis)) = quantity.marker() {
            let change = self.pose(found, marker.s, k);
            let off = off_in_space(&shape.at(marker.s), marker.offset);
            return change.place[axis] + change.of_director(off)[axis];
        }
        match quantity {
            Quantity::Stroke(c) => found.strokes[c][k],
            Quantity::Tension(c) => found.tensions[c][k],
            Quantity::BaseForce(axis) => found.base[k].force[axis.min(2)],
            Quantity::BaseMoment => found.base[k].moment[2],
            Quantity::BaseMomentAbout(axis) => found.base[k].moment[axis.min(1)],
            // Angles in the plane, which was checked.
            _ => 0.0,
        }
    }
}

/// Why a case does not have a quantity.
fn missing(arm: &Arm, quantity: Quantity) -> Option<String> {
    let cable = |c: usize| match arm.cables.get(c) {
        None => Err(format!("was measured of an arm with {} cables, counted from 0", arm.cables.len())),
        Some(cable) => Ok(cable.stroke.is_some()),
    };
    let of_base = matches!(quantity, Quantity::BaseForce(_) | Quantity::BaseMoment | Quantity::BaseMomentAbout(_));
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
        Quantity::Angle(_) | Quantity::Tangent(_) if arm.space.is_some() => {
            Some("is of arms in the plane alone, and this one is in space: give places of markers".to_owned())
        }
        Quantity::Z(_) | Quantity::Off(_, 2..) | Quantity::BaseForce(2..) | Quantity::BaseMomentAbout(_)
            if arm.space.is_none() =>
        {
            Some(IN_PLANE.to_owned())
        }
        Quantity::Off(marker, _) if arm.space.is_none() && marker.offset[2] != 0.0 => {
            Some(format!("has an offset along c, which {IN_PLANE}"))
        }
        _ if of_base && arm.model.support != Support::Clamped => {
            Some("follows no equilibrium with support = \"unstrained-base\"".to_owned())
        }
        _ => {
            let (s, slack) = (quantity.place()?, SAME * arm.length);
            let on = (-slack..=arm.length + slack).contains(&s);
            (!on).then(|| format!("is beyond the arm, which is {} mm long", 1e3 * arm.length))
        }
    }
}

/// What is said of quantities of space in the plane.
const IN_PLANE: &str = "is of an arm in space, and this one is in the plane: say space = \"spatial\" under [arm]";

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
    pub(crate) fn unknowns(&self) -> Vec<Unknown> {
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
        let unknowns = self.unknowns();
        let all: Vec<Result<Answer, Trial>> =
            self.observed.par_iter_mut().map(|one| one.answer(&unknowns, x)).collect();
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
