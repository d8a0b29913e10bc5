//! What equations are differentiated by, and the differences where there is no closed form.

use super::range::Change;
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::phase::Phase;

/// What the equations are differentiated by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Way {
    /// The parameter of a path: the fraction of a phase, the fraction of a range, or an imposed couple.
    Path,
    /// The tension of a cable, in the unit of force.
    Tension(usize),
    /// A number of the arm, in its unit.
    Of(Parameter),
}

/// Part of its scale by which a number is moved to either side for a difference; with four places the error is its
/// fourth power.
const STEP: f64 = 1e-3;

/// The same for angles of the stream. Rounding leaves some 1e-10 of a load by it.
const SHORT_STEP: f64 = 1e-6;

/// The places of a difference of the fourth order, in steps, and their weights.
pub(crate) const PLACES: [(f64, f64); 4] =
    [(1.0, 8.0 / 12.0), (-1.0, -8.0 / 12.0), (2.0, -1.0 / 12.0), (-2.0, 1.0 / 12.0)];

impl Way {
    /// The step of differences, in its unit, given the unit of force (N) and what is varied.
    pub(crate) fn step(self, arm: &Arm, unit: f64, varied: Option<&[Change]>) -> f64 {
        // Where an arm lies along the stream its load has kinks within small angles.
        let step = |parameter| match parameter {
            Parameter::FlowDirection | Parameter::StreamAlong(_) => SHORT_STEP,
            _ => STEP,
        };
        match (self, varied) {
            (Self::Path, Some(ways)) => {
                let one = |way: &Change| step(way.parameter) * way.parameter.scale(arm, unit) / way.whole().abs();
                ways.iter().map(one).fold(f64::INFINITY, f64::min)
            }
            (Self::Path, None) | (Self::Tension(_), _) => STEP,
            (Self::Of(parameter), _) => step(parameter) * parameter.scale(arm, unit),
        }
    }

    /// The tensions (in the unit of force, N) that grow with it, where that is all that does.
    pub(crate) fn pulls(
        self,
        tensions: &[f64],
        unit: f64,
        varied: Option<&[Change]>,
        phase: Phase,
    ) -> Option<Vec<f64>> {
        let one = |c: usize, tension: f64| (0..tensions.len()).map(|k| if k == c { tension } else { 0.0 }).collect();
        match (self, varied) {
            (Self::Tension(c), _) => Some(one(c, 1.0)),
            (Self::Of(Parameter::Tension(c)), _) => Some(one(c, 1.0 / unit)),
            (Self::Path, Some(ways)) => together(ways, tensions.len(), unit),
            (Self::Path, None) if phase == Phase::Tension => Some(tensions.to_vec()),
            _ => None,
        }
    }
}

/// The tensions that grow with several parameters, where these are tensions alone.
fn together(ways: &[Change], count: usize, unit: f64) -> Option<Vec<f64>> {
    let mut out = vec![0.0; count];
    for way in ways {
        let Parameter::Tension(c) = way.parameter else { return None };
        out[c] += way.whole() / unit;
    }
    Some(out)
}
