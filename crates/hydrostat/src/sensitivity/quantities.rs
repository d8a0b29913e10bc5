//! What is differentiated, and how each of it weighs changes of the solution.

use super::dual::WAYS;
use super::linear::{Drift, Functional, Linear};
use super::{SensitivityError, SensitivityMethod, unsettled};
use crate::elimination::solved;
use crate::engine::{Engine, M, Trouble};
use crate::equilibrium::{Asked, CLOSED, Equations, N, OUT, RATE, Spot};
use crate::parameter::Parameter;

/// What Newton's last round moves (rad, and the tip over L) before an exact derivative is taken.
const CONVERGED: f64 = 1e-12;

/// The same where rounding, or a kink of the load, does not let it get there.
const NEARLY: f64 = 1e-7;

/// Rounds until then.
const ROUNDS: usize = 10;

/// Something that is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// x or y (m) at a node.
    Position(usize, usize),
    /// theta (rad) at a node.
    Theta(usize),
    /// alpha (rad) at a node.
    Alpha(usize),
    /// The length (m) of the path of a cable less than at the reference strains.
    Stroke(usize),
    /// What has to be reeled in (m) of a cable for that, its own stretch aside.
    Command(usize),
    /// Force along e1 (0), e2 (1) (N) or moment (2) (N m) on the base.
    Base(usize),
}

/// Quantities with weights.
type Sum = Vec<(Quantity, f64)>;

/// Quantities of a pose.
pub(crate) const POSE: usize = 4;

/// Derivatives of quantities, one row each, and of the tensions of all cables.
pub(crate) struct Found {
    pub(crate) rows: Vec<Vec<f64>>,
    pub(crate) tensions: Vec<Vec<f64>>,
}

/// A quantity as weights on the change of the solution, with what follows a parameter beside that.
struct Row {
    functional: Functional,
    /// What a unit of it is in SI.
    unit: f64,
    /// One a source, in SI.
    direct: Vec<f64>,
}

impl Engine {
    /// The quantities of the pose at a node (over L).
    pub(crate) fn pose_at(&self, place: f64) -> [Quantity; POSE] {
        let node = self.node_at(place).unwrap_or(self.solution.mesh.elements());
        [Quantity::Position(node, 0), Quantity::Position(node, 1), Quantity::Theta(node), Quantity::Alpha(node)]
    }

    /// Rounds until nothing moves any more, and what the equations are at that.
    pub(crate) fn converge_fully(&mut self) -> Result<(), SensitivityError> {
        match self.newton(CONVERGED, ROUNDS) {
            Err(Trouble::Stalled(size)) if size < NEARLY => {}
            other => other.map_err(|trouble| unsettled(&trouble))?,
        }
        self.refresh().map_err(|failure| unsettled(&Trouble::Section(failure)))
    }

    /// Derivatives by `parameters` at the last evaluation, cables that are commanded held. `None` where the system is singular.
    pub(crate) fn derivatives(
        &self,
        quantities: &[Quantity],
        parameters: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Found> {
        let rows: Vec<Sum> = quantities.iter().map(|quantity| vec![(*quantity, 1.0)]).collect();
        self.derivatives_of(rows, parameters, method)
    }

    /// Derivatives of one weighted sum of poses.
    pub(crate) fn gradient(&self, sum: &[(Quantity, f64)], parameters: &[Parameter]) -> Option<Found> {
        self.derivatives_of(vec![sum.to_vec()], parameters, SensitivityMethod::Adjoint)
    }

    /// Derivatives of weighted sums.
    fn derivatives_of(&self, mut sums: Vec<Sum>, parameters: &[Parameter], method: SensitivityMethod) -> Option<Found> {
        let equations = &self.equations;
        let (held, cables) = (equations.held.as_ref(), equations.arm().cables.len());
        let taut: Vec<usize> = held.map_or(Vec::new(), |held| held.tight().iter().map(|i| held.cables[*i]).collect());
        let mut sources = parameters.to_vec();
        sources.extend(taut.iter().map(|c| Parameter::Tension(*c)));
        let asked = sums.len();
        sums.extend(taut.iter().map(|c| vec![(Quantity::Command(*c), 1.0)]));
        let mut rows = self.unheld_derivatives(&sums, &sources, method)?;

        let count = parameters.len();
        let strokes = rows.split_off(asked);
        let mut tensions = vec![vec![0.0; count]; cables];
        for k in 0..count {
            if let Parameter::Tension(c) = parameters[k] {
                tensions[c][k] = 1.0;
            }
            if taut.is_empty() {
                continue;
            }
            let row = |(stroke, c): (&Vec<f64>, &usize)| {
                let command = f64::from(u8::from(parameters[k] == Parameter::Stroke(*c)));
                (stroke[count..].to_vec(), [command - stroke[k], 0.0])
            };
            let (changes, _) = solved(strokes.iter().zip(&taut).map(row).collect())?;
            for (t, (c, [change, _])) in taut.iter().zip(&changes).enumerate() {
                tensions[*c][k] = *change;
                for row in &mut rows {
                    row[k] += row[count + t] * change;
                }
            }
        }
        for row in &mut rows {
            row.truncate(count);
        }
        Some(Found { rows, tensions })
    }

    /// Derivatives with all tensions given.
    fn unheld_derivatives(
        &self,
        sums: &[Sum],
        sources: &[Parameter],
        method: SensitivityMethod,
    ) -> Option<Vec<Vec<f64>>> {
        let equations = &self.equations;
        let spots = equations.spots();
        let linear = Linear::new(self, &spots)?;
        let drifts = self.drifts(&spots, sources);
        let rows: Option<Vec<Row>> = sums.iter().map(|sum| self.sum_row(&linear, &spots, sum, sources)).collect();
        let rows = rows?;
        let forward = match method {
            SensitivityMethod::Forward => true,
            SensitivityMethod::Adjoint => false,
            SensitivityMethod::Best => sources.len() <= rows.len(),
        };
        let mut out = vec![vec![0.0; sources.len()]; rows.len()];
        if forward {
            for (k, drift) in drifts.iter().enumerate() {
                let response = linear.response(drift);
                for (out, row) in out.iter_mut().zip(&rows) {
                    out[k] = row.unit * linear.apply(&row.functional, &response, drift) + row.direct[k];
                }
            }
        } else {
            for (out, row) in out.iter_mut().zip(&rows) {
                let cotangent = linear.adjoint(&row.functional);
                for (k, drift) in drifts.iter().enumerate() {
                    out[k] = row.unit * linear.along(&row.functional, &cotangent, drift) + row.direct[k];
                }
            }
        }
        Some(out)
    }

    /// The row of a sum; of several quantities, all of them poses.
    fn sum_row(&self, linear: &Linear, spots: &[Spot], sum: &Sum, sources: &[Parameter]) -> Option<Row> {
        if let [(quantity, weight)] = sum[..]
            && weight == 1.0
        {
            return self.row(linear, spots, quantity, sources);
        }
        let mut out = Row { functional: Functional::default(), unit: 1.0, direct: vec![0.0; sources.len()] };
        for (quantity, weight) in sum.iter().filter(|(_, weight)| *weight != 0.0) {
            let row = self.row(linear, spots, *quantity, sources)?;
            out.functional.add(weight * row.unit, &row.functional);
            for (out, own) in out.direct.iter_mut().zip(&row.direct) {
                *out += weight * own;
            }
        }
        Some(out)
    }

    fn row(&self, linear: &Linear, spots: &[Spot], quantity: Quantity, sources: &[Parameter]) -> Option<Row> {
        let equations = &self.equations;
        let length = equations.units.length;
        let mut direct = vec![0.0; sources.len()];
        let (functional, unit) = match quantity {
            Quantity::Position(node, q) => (linear.position(node, q), length),
            Quantity::Theta(node) => (Linear::state(node, 0), 1.0),
            Quantity::Alpha(node) => (self.alpha_row(linear, node, sources, &mut direct)?, 1.0),
            Quantity::Stroke(c) => {
                self.reference_row(spots, c, sources, &mut direct);
                (linear.length(equations, c, -1.0), length)
            }
            Quantity::Base(k) => {
                let force = equations.units.force;
                (Linear::state(0, k + 1), if k < 2 { -force } else { -force * length })
            }
            Quantity::Command(c) => {
                self.reference_row(spots, c, sources, &mut direct);
                let [_, by_length, by_tension] = equations.stroke(c, &self.system.gauss.b);
                for (direct, source) in direct.iter_mut().zip(sources) {
                    if *source == Parameter::Tension(c) {
                        *direct = by_tension * length / equations.units.force;
                    }
                }
                (linear.length(equations, c, by_length), length)
            }
        };
        Some(Row { functional, unit, direct })
    }

    /// What the length of a cable at the reference strains makes of the geometry.
    fn reference_row(&self, spots: &[Spot], c: usize, sources: &[Parameter], direct: &mut [f64]) {
        let equations = &self.equations;
        for (direct, source) in direct.iter_mut().zip(sources) {
            let by = equations.reference_length_by(spots, c, *source, &self.system.gauss.b);
            *direct = by * equations.units.length;
        }
    }

    /// alpha where a node ends an element (at the base, begins one): beta' there is by the closed form, and beta'' from the element.
    fn alpha_row(&self, linear: &Linear, node: usize, sources: &[Parameter], direct: &mut [f64]) -> Option<Functional> {
        let equations = &self.equations;
        let left = node > 0;
        let (element, nearest) = if left { (node - 1, node * M - 1) } else { (0, 0) };
        let asked = self.asked_beside(node, left);
        let found = match equations.at_place(&asked) {
            Err(_) => equations.at_place(&Asked { strain: equations.strain(nearest), ..asked }).ok()?,
            Ok(found) => found,
        };
        let beta = [found.beta_slope, asked.beta[1]];
        let spot = equations.spot_at(&Asked { strain: found.strain, beta, ..asked });
        let spot = std::slice::from_ref(&spot);
        let state = *equations.by_state(spot, &mut Vec::new()).first()?;
        let [x, y] = state.rate;
        let square = x * x + y * y;
        // alpha is the direction of (x, y)' less theta.
        let turn = |by_x: f64, by_y: f64| (x * by_y - y * by_x) / square;
        let one = |out: usize, way: usize| state.by[out][way];
        let by_beta = turn(one(RATE, N), one(RATE + 1, N));
        let share = by_beta / (1.0 - one(CLOSED, N));
        let mut weights: [f64; N] =
            std::array::from_fn(|a| turn(one(RATE, a), one(RATE + 1, a)) + share * one(CLOSED, a));
        weights[0] -= 1.0;
        for (direct, source) in direct.iter_mut().zip(sources) {
            let own = direct_change(equations, spot, *source);
            *direct = turn(own[RATE], own[RATE + 1]) + share * own[CLOSED];
        }
        Some(linear.at_end(equations, (node, weights), (element, usize::from(left)), share * state.reach))
    }

    fn drifts(&self, spots: &[Spot], sources: &[Parameter]) -> Vec<Drift> {
        let equations = &self.equations;
        let mut out: Vec<Drift> = sources.iter().map(|source| self.end_drift(*source)).collect();
        let of_sections: Vec<usize> = (0..sources.len()).filter(|k| is_of_section_law(sources[*k])).collect();
        for ways in of_sections.chunks(WAYS) {
            let parameters: Vec<Parameter> = ways.iter().map(|k| sources[*k]).collect();
            let mut stretch = Vec::new();
            let found = equations.by_section(spots, &parameters, &mut stretch);
            for (way, k) in ways.iter().enumerate() {
                out[*k].stations = found.iter().map(|by| by.map(|by| by.0[way])).collect();
                out[*k].stretch = stretch.iter().map(|by| by.0[way]).collect();
            }
        }
        for (drift, source) in out.iter_mut().zip(sources).filter(|(_, source)| is_of_loads(**source)) {
            drift.stations = spots.iter().map(|spot| equations.by_load(spot, *source)).collect();
        }
        out
    }

    /// What the conditions at the ends make of a parameter.
    fn end_drift(&self, source: Parameter) -> Drift {
        let left = f64::from(u8::from(source == Parameter::BaseAngle));
        let right = self.equations.tip_load_by(source, self.tip_angle());
        Drift { left, right, ..Drift::default() }
    }
}

/// How what is evaluated at one place follows a parameter.
fn direct_change(equations: &Equations, spot: &[Spot], source: Parameter) -> [f64; OUT] {
    if is_of_section_law(source) {
        return equations.by_section(spot, &[source], &mut Vec::new())[0].map(|by| by.0[0]);
    }
    if is_of_loads(source) { equations.by_load(&spot[0], source) } else { [0.0; OUT] }
}

/// Whether strains follow it at a fixed state.
fn is_of_section_law(parameter: Parameter) -> bool {
    matches!(
        parameter,
        Parameter::Tension(_)
            | Parameter::Young
            | Parameter::Poisson
            | Parameter::ShearFactor
            | Parameter::Offset(..)
            | Parameter::Radius(_)
            | Parameter::Coefficient(_)
    )
}

/// Whether the loads along the arm follow it.
fn is_of_loads(parameter: Parameter) -> bool {
    matches!(
        parameter,
        Parameter::FlowSpeed
            | Parameter::FlowDirection
            | Parameter::FlowDensity
            | Parameter::GravityAcceleration
            | Parameter::GravityDirection
            | Parameter::Density
            | Parameter::DragNormal
            | Parameter::DragTangential
    )
}
