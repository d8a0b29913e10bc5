//! Cables whose length is commanded, as the equations know them: which are taut, and what is commanded of them.

use super::stroke_control::StrokeControl;
use super::system::Equations;
use crate::rod::parameter::Parameter;
use crate::statics::verdict::Phase;

impl Equations {
    /// Commands the strokes of the arm, no cable taut but those that have a tension.
    pub(crate) fn hold_strokes(&mut self) {
        let commanded = |cable: &usize| self.arm.cables[*cable].stroke.is_some();
        self.stroke_control = StrokeControl::slack((0..self.arm.cables.len()).filter(commanded).collect());
        if let Some(stroke_control) = &mut self.stroke_control {
            stroke_control.taut = stroke_control.cables.iter().map(|cable| self.tensions[*cable] > 0.0).collect();
        }
    }

    /// Leaves all cables to their tensions.
    pub(crate) fn let_go(&mut self) {
        self.stroke_control = None;
    }

    /// Starts the phase of strokes from those that the cables have.
    pub(crate) fn start_strokes_from(&mut self, strokes: Vec<f64>) {
        if let Some(stroke_control) = &mut self.stroke_control {
            stroke_control.from = strokes;
        }
    }

    /// Makes held cable `index` slack that was taut, or the other way round: which it is of the arm's, and whether it
    /// is slack now.
    pub(crate) fn switch_active(&mut self, index: usize) -> (usize, bool) {
        let Some(mut stroke_control) = self.stroke_control.take() else { return (index, false) };
        stroke_control.taut[index] = !stroke_control.taut[index];
        let (cable, slack) = (stroke_control.cables[index], !stroke_control.taut[index]);
        if slack {
            self.set_tension(cable, 0.0);
        }
        self.stroke_control = Some(stroke_control);
        (cable, slack)
    }

    /// Whether rounds may change which cables are taut.
    pub(crate) fn let_cables_switch(&mut self, may: bool) {
        if let Some(stroke_control) = &mut self.stroke_control {
            stroke_control.switching = may;
        }
    }

    pub(super) fn set_stroke_fraction(&mut self, phase: Phase, fraction: f64) {
        if let Some(stroke_control) = &mut self.stroke_control {
            stroke_control.fraction = if phase == Phase::Stroke { fraction } else { 1.0 };
        }
    }

    /// Stroke that is commanded of held cable `index` now, over L.
    pub(crate) fn command(&self, stroke_control: &StrokeControl, index: usize) -> f64 {
        stroke_control.command(index, self.whole_command(stroke_control.cables[index]))
    }

    fn whole_command(&self, cable: usize) -> f64 {
        self.arm.cables[cable].stroke.unwrap_or(0.0) / self.units.length
    }

    /// The change of that stroke a unit of the parameter.
    pub(crate) fn command_derivative(&self, stroke_control: &StrokeControl, index: usize) -> f64 {
        let cable = stroke_control.cables[index];
        match self.varied_over() {
            _ if self.imposed.is_some() => 0.0,
            Some(ways) => {
                let own = ways.iter().filter(|way| way.parameter == Parameter::Stroke(cable));
                own.map(|way| way.whole() / self.units.length).sum()
            }
            None if self.phase == Phase::Stroke => self.whole_command(cable) - stroke_control.from[index],
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
