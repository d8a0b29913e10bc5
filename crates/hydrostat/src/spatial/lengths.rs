//! Newton rounds in which the lengths of taut cables are held, see [`crate::statics::border`].

use hydrostat_bvp::{Collocation, Correction, Determinant, Forcing, Solution};

use super::cable_paths::StageData;
use super::equations::{Equations, L, N, Q};
use crate::numerics::rounds::respond;
use crate::statics::border::{UnitPull, add_pulls, meeting};
use crate::statics::engine::Trouble;
use crate::statics::equations::StrokeControl;

/// What a round does to the tensions and slacks of the commanded cables.
#[derive(Debug, Clone, Default)]
pub(super) struct StrokeRound {
    /// Changes of the tensions, in the unit of force.
    pub(super) tensions: Vec<f64>,
    /// Strokes less commands after the round, over L.
    pub(super) slack: Vec<f64>,
    /// By how much the strokes of taut cables are off before it, over L.
    pub(super) off: f64,
    /// Of B.
    pub(super) border: Option<Determinant>,
}

/// The change of the equations with a unit of tension of cable `c`, at the last linearisation.
pub(super) fn unit_change<const S: usize>(
    equations: &Equations,
    system: &Collocation<N, S, Q, L>,
    c: usize,
) -> Result<Forcing<N, Q, L>, Trouble> {
    let mut unit = vec![0.0; equations.arm().cables.len()];
    unit[c] = 1.0;
    let change = equations.change_by_tensions(system.stations(), system.end_stations(), &unit);
    change.map_err(Trouble::Section)
}

/// One for every taut cable, at the last linearisation.
pub(super) fn pull_taut<const S: usize>(
    equations: &Equations,
    system: &Collocation<N, S, Q, L>,
    solution: &Solution<N, S, L>,
    stroke_control: &StrokeControl,
) -> Result<Vec<UnitPull<N, S, Q, L>>, Trouble> {
    let at = StageData::of(system, solution);
    let mut out = Vec::new();
    for index in stroke_control.taut_cables() {
        let cable = stroke_control.cables[index];
        let change = unit_change(equations, system, cable)?;
        let mut response = Correction::default();
        respond(system, &change, &mut response);
        let mut strokes: Vec<f64> =
            stroke_control.cables.iter().map(|c| equations.stroke_change(*c, at, &response)).collect();
        strokes[index] += equations.stroke(cable, at)[1];
        out.push(UnitPull { response, strokes });
    }
    Ok(out)
}

/// Adds to a Newton correction at fixed tensions what the tensions of taut cables change in the same round.
pub(super) fn hold_lengths<const S: usize>(
    equations: &Equations,
    system: &Collocation<N, S, Q, L>,
    solution: &Solution<N, S, L>,
    stroke_control: &StrokeControl,
    correction: &mut Correction<N, S, Q, L>,
) -> Result<StrokeRound, Trouble> {
    let at = StageData::of(system, solution);
    let pulled = pull_taut(equations, system, solution, stroke_control)?;
    let mut round = StrokeRound::default();
    for (index, cable) in stroke_control.cables.iter().enumerate() {
        let off = equations.stroke(*cable, at)[0] - equations.command(stroke_control, index);
        if stroke_control.taut[index] {
            round.off = round.off.max(off.abs());
        }
        round.slack.push(off + equations.stroke_change(*cable, at, correction));
    }
    let (tensions, border) = meeting(stroke_control, &pulled, [&round.slack, &round.slack]).ok_or(Trouble::Singular)?;
    let changes = tensions.iter().map(|both| both[0]);
    round.tensions = add_pulls(stroke_control, &pulled, changes, correction, &mut round.slack);
    round.border = Some(border);
    Ok(round)
}

impl Equations {
    /// Stroke that is commanded of held cable `index` now, over L.
    pub(crate) fn command(&self, stroke_control: &StrokeControl, index: usize) -> f64 {
        stroke_control
            .command(index, self.arm.cables[stroke_control.cables[index]].stroke.unwrap_or(0.0) / self.units.length)
    }

    /// Changes the tension of one cable, in the unit of force.
    pub(crate) fn set_tension(&mut self, cable: usize, tension: f64) {
        self.tensions[cable] = tension;
        self.arm.cables[cable].tension = tension * self.units.force;
    }
}
