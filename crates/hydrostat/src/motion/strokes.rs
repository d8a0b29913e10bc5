//! Cables whose stroke is commanded in motion: shape and tensions in one bordered system
//! ([`crate::statics::border`]), with taut and slack cables by an active set.

use hydrostat_bvp::Correction;

use super::equations::Moving;
use super::in_plane::Planar;
use super::settling::Unsolved;
use crate::statics::border::{UnitPull, add_pulls, meeting};
use crate::statics::equations::StationData;

/// Corrections above which tensions do not yet say which cables are taut.
const SETTLED: f64 = 0.3;

impl Planar {
    /// Adds to the correction of the last linearisation what the tensions of held cables do, so that their strokes
    /// are met.
    pub(super) fn border(&mut self) -> Result<(), Unsolved> {
        let Some(held) = self.moving.statics.held.clone() else { return Ok(()) };
        let mut border = std::mem::take(&mut self.border);
        Moving::for_strokes(self.system.stations(), &mut border.stations);
        let statics = &self.moving.statics;
        let at = StationData { weights: &self.system.gauss.b, steps: self.system.steps(), stations: &border.stations };
        let taut = held.taut_cables();
        let mut pulled = Vec::with_capacity(taut.len());
        for index in taut {
            self.moving.pull_by(held.cables[index], &self.system, &mut border.forcing);
            let mut response = Correction::default();
            self.respond(&border.forcing, &mut response);
            let mut strokes: Vec<f64> =
                held.cables.iter().map(|cable| statics.stroke_change(*cable, at, &response)).collect();
            strokes[index] += statics.stroke(held.cables[index], at)[1];
            pulled.push(UnitPull { response, strokes });
        }
        border.off = 0.0;
        border.slack.clear();
        for (index, cable) in held.cables.iter().enumerate() {
            let off = statics.stroke(*cable, at)[0] - statics.command(&held, index);
            if held.taut[index] {
                border.off = border.off.max(off.abs());
            }
            border.slack.push(off + statics.stroke_change(*cable, at, &self.correction));
        }
        let found = meeting(&held, &pulled, [&border.slack, &border.slack]);
        let changes = found.iter().flat_map(|(tensions, _)| tensions.iter().map(|both| both[0]));
        border.tensions = add_pulls(&held, &pulled, changes, &mut self.correction, &mut border.slack);
        self.border = border;
        found.map(|_| ()).ok_or(Unsolved::Singular)
    }

    /// Adds `factor` times the last round to the tensions.
    pub(super) fn add_tensions(&mut self, factor: f64) {
        let Some(held) = self.moving.statics.held.take() else { return };
        let statics = &mut self.moving.statics;
        for ((cable, taut), change) in held.cables.iter().zip(&held.taut).zip(&self.border.tensions) {
            if *taut {
                let tension = statics.arm().cables[*cable].tension + factor * change * statics.units.force;
                statics.set_tension(*cable, tension);
            }
        }
        statics.held = Some(held);
    }

    /// Lets cables go slack that push, and takes slack ones up that are too short, given the size of the last
    /// correction; whether any changed.
    pub(super) fn switch_taut(&mut self, size: f64) -> bool {
        if size > SETTLED {
            return false;
        }
        let Some(mut held) = self.moving.statics.held.take() else { return false };
        let statics = &mut self.moving.statics;
        let changed = held.switch(|cable| statics.arm().cables[cable].tension, &self.border.slack);
        if changed {
            held.slack_cables().for_each(|cable| statics.set_tension(cable, 0.0));
        }
        statics.held = Some(held);
        changed
    }
}
