//! Cables whose stroke is commanded in motion, in the plane or in space: shape and tensions in one bordered system
//! ([`crate::statics::border`]), with taut and slack cables by an active set.

use hydrostat_bvp::Correction;

use super::border::Border;
use super::pulls::Pull;
use super::settling::{Moves, Settling, Unsolved};
use crate::numerics::rounds::respond;
use crate::statics::border::{UnitPull, add_pulls, meeting};

/// Corrections above which tensions do not yet say which cables are taut.
const SETTLED: f64 = 0.3;

impl<P: Moves<S, L>, const S: usize, const L: usize> Settling<P, S, L> {
    /// The cables whose stroke is commanded.
    pub(super) fn held_cables(&self) -> &[usize] {
        self.moving.stroke_control().map_or(&[], |stroke_control| &stroke_control.cables)
    }

    /// What cables did in the last solve, which was at `time`.
    pub(super) fn pull(&self, time: f64) -> Pull {
        let tensions: Vec<f64> = self.moving.arm().cables.iter().map(|cable| cable.tension).collect();
        let Some(stroke_control) = self.moving.stroke_control() else {
            return Pull { time, tensions, ..Pull::default() };
        };
        let margin = |(index, cable): (usize, &usize)| {
            if stroke_control.taut[index] {
                tensions[*cable]
            } else {
                self.border.slack.get(index).copied().unwrap_or(0.0)
            }
        };
        let margins = stroke_control.cables.iter().enumerate().map(margin).collect();
        Pull { time, taut: stroke_control.taut.clone(), margins, tensions }
    }

    /// Takes the tensions of held cables back.
    pub(super) fn take_pull(&mut self, Pull { tensions, taut, .. }: &Pull) {
        let Some(stroke_control) = self.moving.stroke_control_mut() else { return };
        stroke_control.taut.clone_from(taut);
        for cable in stroke_control.cables.clone() {
            self.moving.set_tension(cable, tensions[cable]);
        }
    }

    /// Adds to the correction of the last linearisation what the tensions of held cables do, so that their strokes
    /// are met; by how much those of taut ones were off.
    pub(super) fn hold_strokes(&mut self) -> Result<f64, Unsolved> {
        let Some(stroke_control) = self.moving.stroke_control().cloned() else { return Ok(0.0) };
        let (moving, system) = (&self.moving, &self.system);
        let Border { slack, strained, forcing, .. } = &mut self.border;
        moving.strained(system, strained);
        let taut = stroke_control.taut_cables();
        let mut pulled = Vec::with_capacity(taut.len());
        for index in taut {
            moving.pull_by(stroke_control.cables[index], system, forcing);
            let mut response = Correction::default();
            respond(system, forcing, &mut response);
            let change = |cable: &usize| moving.stroke_change(*cable, system, strained, &response);
            let mut strokes: Vec<f64> = stroke_control.cables.iter().map(change).collect();
            strokes[index] += moving.stroke(stroke_control.cables[index], system, strained)[1];
            pulled.push(UnitPull { response, strokes });
        }
        let mut most = 0.0_f64;
        slack.clear();
        for (index, cable) in stroke_control.cables.iter().enumerate() {
            let off = moving.stroke(*cable, system, strained)[0] - moving.command(&stroke_control, index);
            if stroke_control.taut[index] {
                most = most.max(off.abs());
            }
            slack.push(off + moving.stroke_change(*cable, system, strained, &self.correction));
        }
        let found = meeting(&stroke_control, &pulled, [slack, slack]);
        let changes = found.iter().flat_map(|(tensions, _)| tensions.iter().map(|both| both[0]));
        self.border.tensions = add_pulls(&stroke_control, &pulled, changes, &mut self.correction, slack);
        found.map(|_| most).ok_or(Unsolved::Singular)
    }

    /// Adds `factor` times the last round to the tensions.
    pub(super) fn add_tensions(&mut self, factor: f64) {
        let Some(stroke_control) = self.moving.stroke_control().cloned() else { return };
        let force = self.moving.units().force;
        for ((cable, taut), change) in stroke_control.cables.iter().zip(&stroke_control.taut).zip(&self.border.tensions)
        {
            if *taut {
                let tension = self.moving.arm().cables[*cable].tension + factor * change * force;
                self.moving.set_tension(*cable, tension);
            }
        }
    }

    /// Lets cables go slack that push, and takes slack ones up that are too short, given the size of the last
    /// correction; whether any changed.
    pub(super) fn switch_taut(&mut self, size: f64) -> bool {
        if size > SETTLED {
            return false;
        }
        let Some(mut stroke_control) = self.moving.stroke_control().cloned() else { return false };
        let cables = &self.moving.arm().cables;
        let changed = stroke_control.switch(|cable| cables[cable].tension, &self.border.slack);
        if changed {
            stroke_control.slack_cables().for_each(|cable| self.moving.set_tension(cable, 0.0));
            if let Some(own) = self.moving.stroke_control_mut() {
                *own = stroke_control;
            }
        }
        changed
    }
}
