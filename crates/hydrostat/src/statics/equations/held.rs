//! Cables whose length is commanded, as the equations know them: which are taut, and what is commanded of them.

use super::stroke_control::StrokeControl;
use super::system::Equations;
use crate::rod::parameter::Parameter;
use crate::statics::verdict::Phase;

impl Equations {
    /// Commands the strokes of the arm, no cable taut but those that have a tension.
    pub(crate) fn hold_strokes(&mut self) {
        let commanded = |cable: &usize| self.arm.cables[*cable].stroke.is_some();
        self.held = StrokeControl::slack((0..self.arm.cables.len()).filter(commanded).collect());
        if let Some(held) = &mut self.held {
            held.taut = held.cables.iter().map(|cable| self.tensions[*cable] > 0.0).collect();
        }
    }

    /// Leaves all cables to their tensions.
    pub(crate) fn let_go(&mut self) {
        self.held = None;
    }

    /// Starts the phase of strokes from those that the cables have.
    pub(crate) fn start_strokes_from(&mut self, strokes: Vec<f64>) {
        if let Some(held) = &mut self.held {
            held.from = strokes;
        }
    }

    /// Makes held cable `index` slack that was taut, or the other way round: which it is of the arm's, and whether it
    /// is slack now.
    pub(crate) fn switch_active(&mut self, index: usize) -> (usize, bool) {
        let Some(mut held) = self.held.take() else { return (index, false) };
        held.taut[index] = !held.taut[index];
        let (cable, slack) = (held.cables[index], !held.taut[index]);
        if slack {
            self.set_tension(cable, 0.0);
        }
        self.held = Some(held);
        (cable, slack)
    }

    /// Whether rounds may change which cables are taut.
    pub(crate) fn let_cables_switch(&mut self, may: bool) {
        if let Some(held) = &mut self.held {
            held.switching = may;
        }
    }

    pub(super) fn set_stroke_fraction(&mut self, phase: Phase, fraction: f64) {
        if let Some(held) = &mut self.held {
            held.fraction = if phase == Phase::Stroke { fraction } else { 1.0 };
        }
    }

    /// Stroke that is commanded of held cable `index` now, over L.
    pub(crate) fn command(&self, held: &StrokeControl, index: usize) -> f64 {
        held.command(index, self.whole_command(held.cables[index]))
    }

    fn whole_command(&self, cable: usize) -> f64 {
        self.arm.cables[cable].stroke.unwrap_or(0.0) / self.units.length
    }

    /// The change of that stroke a unit of the parameter.
    pub(crate) fn command_derivative(&self, held: &StrokeControl, index: usize) -> f64 {
        let cable = held.cables[index];
        match self.varied_over() {
            _ if self.imposed.is_some() => 0.0,
            Some(ways) => {
                let own = ways.iter().filter(|way| way.parameter == Parameter::Stroke(cable));
                own.map(|way| way.whole() / self.units.length).sum()
            }
            None if self.phase == Phase::Stroke => self.whole_command(cable) - held.from[index],
            _ => 0.0,
        }
    }

    /// Whether the parameter moves commands and nothing else.
    pub(crate) fn only_commands_move(&self) -> bool {
        match self.varied_over() {
            _ if self.imposed.is_some() => false,
            Some(ways) => ways.iter().all(|way| matches!(way.parameter, Parameter::Stroke(_))),
            None => self.phase == Phase::Stroke,
        }
    }
}
