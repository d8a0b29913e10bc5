//! The cables of an arm in space whose strokes are commanded, as the engine holds them.

use hydrostat_bvp::{Correction, Determinant};

use super::cable_paths::StageData;
use super::engine::Engine;
use super::equations::{L, M, N, Q};
use super::lengths::{StrokeRound, hold_lengths, pull_taut};
use super::neutral::{is_on_a_circle, without_neutral};
use crate::numerics::rounds::correct;
use crate::statics::border::{NewtonStep, border};
use crate::statics::engine::Trouble;
use crate::statics::equations::StrokeControl;

/// Corrections (rad) above which the tensions do not yet say which cables are taut.
const SETTLED: f64 = 0.3;

impl Engine {
    /// Commands the strokes of the arm, all these cables slack.
    pub(super) fn hold_strokes(&mut self) {
        let cables = &self.equations.arm().cables;
        let commanded: Vec<usize> = (0..cables.len()).filter(|c| cables[*c].stroke.is_some()).collect();
        self.stroke_control = StrokeControl::slack(commanded);
    }

    /// Leaves all cables to their tensions, those with a commanded stroke slack.
    pub(super) fn release_strokes(&mut self) {
        (self.stroke_control, self.border) = (None, None);
        for cable in 0..self.equations.arm().cables.len() {
            if self.equations.arm().cables[cable].stroke.is_some() {
                self.equations.set_tension(cable, 0.0);
            }
        }
    }

    /// Sign and size of the determinant of shape and unknown tensions together, at the last linearisation. On a circle
    /// of equal shapes its sign decides nothing.
    pub(super) fn determinant(&self) -> Determinant {
        let shape = self.system.determinant();
        let whole = self.border.map_or(shape, |border| shape.times(border));
        if is_on_a_circle(&self.equations, &self.solution) { Determinant { clearance: 0.0, ..whole } } else { whole }
    }

    /// Holds the lengths of taut cables in the present correction, if any are commanded.
    pub(super) fn hold_lengths(&mut self) -> Result<StrokeRound, Trouble> {
        let Some(stroke_control) = &self.stroke_control else { return Ok(StrokeRound::default()) };
        let round = hold_lengths(&self.equations, &self.system, &self.solution, stroke_control, &mut self.correction)?;
        self.border = round.border;
        Ok(round)
    }

    /// The determinant of the strokes of taut cables by their tensions, at the last linearisation.
    pub(super) fn find_border(&mut self) -> Result<(), Trouble> {
        let Some(stroke_control) = &self.stroke_control else { return Ok(()) };
        let pulled = pull_taut(&self.equations, &self.system, &self.solution, stroke_control)?;
        self.border = Some(border(stroke_control, &pulled).ok_or(Trouble::Singular)?);
        Ok(())
    }

    /// Adds `factor` times `changes` (in the unit of force), one a commanded cable, to the tensions.
    pub(super) fn add_tensions(&mut self, changes: &[f64], factor: f64) {
        let Some(stroke_control) = &self.stroke_control else { return };
        for (cable, change) in stroke_control.cables.iter().zip(changes) {
            let tension = self.equations.tension(*cable) + factor * change;
            self.equations.set_tension(*cable, tension);
        }
    }

    /// Lets cables go slack that push, and takes slack ones up that are too short, once a correction of `size` (rad)
    /// says which these are; whether any changed.
    pub(super) fn switch_taut(&mut self, size: f64, slack: &[f64]) -> bool {
        let Some(stroke_control) = &mut self.stroke_control else { return false };
        let changed = stroke_control.switching
            && size < SETTLED
            && stroke_control.switch(|cable| self.equations.tension(cable), slack);
        if changed {
            stroke_control.slack_cables().for_each(|cable| self.equations.set_tension(cable, 0.0));
        }
        changed
    }

    /// Makes held cable `index` slack that was taut, or the other way round: which it is of the arm's, and whether it
    /// is slack now.
    pub(super) fn switch_active(&mut self, index: usize) -> (usize, bool) {
        let Some(stroke_control) = &mut self.stroke_control else { return (index, false) };
        stroke_control.taut[index] = !stroke_control.taut[index];
        let (cable, slack) = (stroke_control.cables[index], !stroke_control.taut[index]);
        if slack {
            self.equations.set_tension(cable, 0.0);
        }
        (cable, slack)
    }

    /// Factorises at the solution, and finds correction and response, at held strokes where there are any.
    pub(super) fn linearise_at_strokes(
        &mut self,
        parameter: bool,
        round: &mut NewtonStep<Correction<N, M, Q, L>>,
    ) -> Result<(), Trouble> {
        self.match_closure();
        self.linearise()?;
        if self.choose_sides() {
            self.linearise()?;
        }
        correct(&mut self.system, &self.solution, &mut round.rest);
        without_neutral(&self.equations, &self.system, &self.solution, &mut round.rest);
        if parameter {
            self.response(&mut round.response)?;
            without_neutral(&self.equations, &self.system, &self.solution, &mut round.response);
        } else {
            round.response.clone_from(&round.rest);
            round.response.scale(0.0);
        }
        let Some(stroke_control) = &self.stroke_control else {
            round.let_go();
            return Ok(());
        };
        let (equations, at) = (&self.equations, StageData::of(&self.system, &self.solution));
        let pulled = pull_taut(equations, &self.system, &self.solution, stroke_control)?;
        let off = |index: usize| {
            equations.stroke(stroke_control.cables[index], at)[0] - equations.command(stroke_control, index)
        };
        let change = |cable: usize, by: &Correction<N, M, Q, L>| equations.stroke_change(cable, at, by);
        let command = |index: usize| equations.command_derivative(stroke_control, index);
        self.border = Some(round.hold(stroke_control, &pulled, off, change, command).ok_or(Trouble::Singular)?);
        Ok(())
    }

    /// Whether cable `c` has a commanded stroke and is taut.
    pub(super) fn is_taut(&self, c: usize) -> bool {
        let stroke_control = self
            .stroke_control
            .iter()
            .flat_map(|stroke_control| stroke_control.cables.iter().zip(&stroke_control.taut));
        stroke_control.into_iter().any(|(cable, taut)| *cable == c && *taut)
    }

    /// Strokes of the commanded cables at the present solution, over L.
    pub(super) fn strokes(&self) -> Vec<f64> {
        let at = StageData::of(&self.system, &self.solution);
        let cables = self.stroke_control.iter().flat_map(|stroke_control| stroke_control.cables.iter());
        cables.map(|cable| self.equations.stroke(*cable, at)[0]).collect()
    }
}
