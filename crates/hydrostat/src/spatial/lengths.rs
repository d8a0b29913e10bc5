//! Newton rounds in which the lengths of taut cables are held: as in the plane, shape and tensions in one bordered
//! system.
//!
//! With A the linearised equations, t the tensions of the taut cables, and s their strokes,
//!
//! ```text
//! A dz + A_t dt = -residual            s_z dz + s_t dt = command - s
//! ```
//!
//! is solved by blocks. Its determinant is that of A times that of B = s_t - s_z A^-1 A_t, the strokes that unit
//! tensions reel in, which is positive in the unloaded arm.

use hydrostat_bvp::{Collocation, Correction, Determinant, Solution};

use super::cable_paths::StageData;
use super::equations::{Equations, L, N, Q};
use crate::numerics::elimination::solved;
use crate::numerics::rounds::respond;
use crate::statics::engine::Trouble;
use crate::statics::equations::StrokeControl;

/// What a round does to the tensions and slacks of the commanded cables.
#[derive(Debug, Clone, Default)]
pub(super) struct HeldRound {
    /// Changes of the tensions, in the unit of force.
    pub(super) tensions: Vec<f64>,
    /// Strokes less commands after the round, over L.
    pub(super) slack: Vec<f64>,
    /// By how much the strokes of taut cables are off before it, over L.
    pub(super) off: f64,
    /// Of B.
    pub(super) border: Option<Determinant>,
}

/// What a unit of tension of a taut cable does at fixed tensions of all others.
#[derive(Debug)]
pub(super) struct UnitPull<const S: usize> {
    /// To the solution.
    pub(super) response: Correction<N, S, Q, L>,
    /// To the strokes of all commanded cables, over L.
    pub(super) strokes: Vec<f64>,
}

/// One for every taut cable, at the last linearisation.
pub(super) fn pull_taut<const S: usize>(
    equations: &Equations,
    system: &Collocation<N, S, Q, L>,
    solution: &Solution<N, S, L>,
    held: &StrokeControl,
) -> Result<Vec<UnitPull<S>>, Trouble> {
    let at = StageData::of(system, solution);
    let mut out = Vec::new();
    for index in held.taut_cables() {
        let cable = held.cables[index];
        let mut unit = vec![0.0; equations.arm().cables.len()];
        unit[cable] = 1.0;
        let change =
            equations.change_by_tensions(system.stations(), system.end_stations(), &unit).map_err(Trouble::Section)?;
        let mut response = Correction::default();
        respond(system, &change, &mut response);
        let mut strokes: Vec<f64> = held.cables.iter().map(|c| equations.stroke_change(*c, at, &response)).collect();
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
    held: &StrokeControl,
    correction: &mut Correction<N, S, Q, L>,
) -> Result<HeldRound, Trouble> {
    let at = StageData::of(system, solution);
    let pulled = pull_taut(equations, system, solution, held)?;
    let mut round = HeldRound { tensions: vec![0.0; held.cables.len()], ..HeldRound::default() };
    for (index, cable) in held.cables.iter().enumerate() {
        let off = equations.stroke(*cable, at)[0] - equations.command(held, index);
        if held.taut[index] {
            round.off = round.off.max(off.abs());
        }
        round.slack.push(off + equations.stroke_change(*cable, at, correction));
    }
    let taut = held.taut_cables();
    let row = |index: &usize| (pulled.iter().map(|by| by.strokes[*index]).collect(), [-round.slack[*index], 0.0]);
    let (tensions, border) = solved(taut.iter().map(row).collect()).ok_or(Trouble::Singular)?;
    for ((index, pulled), [tension, _]) in taut.iter().zip(&pulled).zip(&tensions) {
        correction.add(&pulled.response, *tension);
        round.tensions[*index] = *tension;
        for (slack, by) in round.slack.iter_mut().zip(&pulled.strokes) {
            *slack += tension * by;
        }
    }
    round.border = Some(border);
    Ok(round)
}

impl Equations {
    /// Stroke that is commanded of held cable `index` now, over L.
    pub(super) fn command(&self, held: &StrokeControl, index: usize) -> f64 {
        held.command(index, self.arm.cables[held.cables[index]].stroke.unwrap_or(0.0) / self.units.length)
    }

    /// Changes the tension of one cable, in the unit of force.
    pub(super) fn set_tension(&mut self, cable: usize, tension: f64) {
        self.tensions[cable] = tension;
        self.arm.cables[cable].tension = tension * self.units.force;
    }
}
