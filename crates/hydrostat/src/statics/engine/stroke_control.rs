//! Rounds in which the lengths of taut cables are held: shape and tensions in one bordered system, see
//! [`crate::statics::border`].

use hydrostat_bvp::{Collocation, Correction, Determinant};

use super::discrete::{Engine, response_change};
use super::newton::add_to_spans;
use super::trouble::Trouble;
use crate::numerics::rounds::{correct, respond};
use crate::statics::border::{self, UnitPull};
use crate::statics::dimensions::{Guess, L, M, N, Q};
use crate::statics::equations::{Equations, SectionFailure, StationData, StrokeControl, Way};

/// What strokes may be off by (over L) before the last round, which leaves the square of that.
const STROKES: f64 = 1e-10;

/// Corrections (rad) above which the tensions do not yet say which cables are taut.
const SETTLED: f64 = 0.3;

/// Changes of the shape (rad) and of strokes (over L) that may be all that the last round still does.
const ROUNDING: f64 = 1e-6;

/// Rounds added to those of given tensions: the set of taut cables may change.
const MORE: usize = 12;

/// One linearisation in the plane.
type NewtonStep = border::NewtonStep<Correction<N, M, Q, L>>;

impl Engine {
    /// Sign and size of the determinant of shape and unknown tensions together, at the last linearisation.
    pub(crate) fn determinant(&self) -> Determinant {
        let shape = self.system.determinant();
        if self.equations.stroke_control.is_none() {
            return shape;
        }
        shape.times(self.border)
    }

    /// [`Engine::linearise`] with the corrections, at held strokes where there are any.
    pub(crate) fn linearise_at_strokes(&mut self, parameter: bool, round: &mut NewtonStep) -> Result<(), Trouble> {
        self.match_closure();
        self.linearise()?;
        if self.choose_sides() {
            self.linearise()?;
        }
        correct(&mut self.system, &self.solution, &mut round.rest);
        if parameter {
            self.response(Way::Path, &mut round.response);
        } else {
            round.response.clone_from(&round.rest);
            round.response.scale(0.0);
        }
        let Some(stroke_control) = self.equations.stroke_control.clone() else {
            round.let_go();
            return Ok(());
        };
        let pulled = pull_taut(&self.equations, &self.system, &self.solution, &stroke_control);
        let (equations, at) = (&self.equations, StationData::of(&self.system));
        let off = |index: usize| {
            equations.stroke(stroke_control.cables[index], at)[0] - equations.command(&stroke_control, index)
        };
        let change = |cable: usize, by: &Correction<N, M, Q, L>| equations.stroke_change(cable, at, by);
        let command = |index: usize| equations.command_derivative(&stroke_control, index);
        self.border = round.hold(&stroke_control, &pulled, off, change, command).ok_or(Trouble::Singular)?;
        Ok(())
    }

    /// Adds `factor` times the rest (0) or the response (1) of a round to shape and tensions.
    pub(crate) fn add_round(&mut self, round: &NewtonStep, which: usize, factor: f64) {
        self.solution.add(if which == 0 { &round.rest } else { &round.response }, factor);
        self.add_tensions(&round.tension[which], factor);
    }

    /// Adds `factor` times `changes` (in the unit of force), one a commanded cable, to the tensions.
    pub(crate) fn add_tensions(&mut self, changes: &[f64], factor: f64) {
        let Some(stroke_control) = self.equations.stroke_control.take() else { return };
        let unit = self.equations.units.force;
        for ((cable, taut), change) in stroke_control.cables.iter().zip(&stroke_control.taut).zip(changes) {
            if *taut {
                let tension = self.equations.arm().cables[*cable].tension + factor * change * unit;
                self.equations.set_tension(*cable, tension);
            }
        }
        self.equations.stroke_control = Some(stroke_control);
    }

    /// Newton at held strokes until the tip moves by less than `tolerance` and the strokes are met.
    pub(super) fn iterate_at_strokes(&mut self, tolerance: f64, most: usize) -> Result<(), Trouble> {
        let strokes = STROKES.max(0.01 * tolerance);
        let mut round = NewtonStep::default();
        let (mut applied, mut halvings, mut switches) = (0.0, 0, 0);
        let mut count = 0;
        loop {
            let mut next = NewtonStep::default();
            match self.linearise_at_strokes(false, &mut next) {
                Ok(()) => round = next,
                Err(Trouble::Section(failure)) => {
                    self.halve(&round, &mut applied, &mut halvings, failure)?;
                    continue;
                }
                Err(trouble) => return Err(trouble),
            }
            count += 1;
            let size = round.rest.largest(0);
            if !size.is_finite() {
                return Err(Trouble::Singular);
            }
            applied = if size > 1.0 { 1.0 / size } else { 1.0 };
            halvings = 0;
            self.add_round(&round, 0, applied);
            let ([x, y], [dx, dy]) = (self.system.totals(), round.rest.total);
            self.tip = [x + dx, y + dy];
            let moved = dx.hypot(dy).max(0.1 * size);
            self.last = size;
            self.left_over = moved;
            if size < SETTLED && self.switch_taut(&round.slack[0]) {
                switches += 1;
                if switches > MORE {
                    return Err(Trouble::Stalled(size));
                }
                continue;
            }
            let met = round.off <= strokes;
            let last = count >= most + MORE;
            // Where rounding is all that rounds still move, the estimate says what it moves.
            let restless = last && size <= ROUNDING && round.off <= ROUNDING;
            let done = applied == 1.0 && (met && moved <= tolerance || restless && moved <= tolerance.max(ROUNDING));
            if !met {
                self.left_over = self.left_over.max(10.0 * round.off);
            }
            if done || last || (count >= MORE && size > 3.0) {
                self.system.quadratures(&mut self.spans);
                add_to_spans(&mut self.spans, &round.rest.by_element);
                return if done { Ok(()) } else { Err(Trouble::Stalled(size.max(round.off))) };
            }
        }
    }

    /// Takes half of what is left of the last round back, where its end has no strains.
    fn halve(
        &mut self,
        round: &NewtonStep,
        applied: &mut f64,
        halvings: &mut usize,
        failure: SectionFailure,
    ) -> Result<(), Trouble> {
        if *applied == 0.0 || *halvings == 8 || round.rest.nodes.is_empty() {
            return Err(Trouble::Section(failure));
        }
        *applied *= 0.5;
        *halvings += 1;
        self.add_round(round, 0, -*applied);
        Ok(())
    }

    /// Lets cables go slack that push, and takes slack ones up that are too short; whether any changed.
    fn switch_taut(&mut self, slack: &[f64]) -> bool {
        let Some(mut stroke_control) = self.equations.stroke_control.take() else { return false };
        let changed = stroke_control.switching
            && stroke_control.switch(|cable| self.equations.arm().cables[cable].tension, slack);
        if changed {
            stroke_control.slack_cables().for_each(|cable| self.equations.set_tension(cable, 0.0));
        }
        self.equations.stroke_control = Some(stroke_control);
        changed
    }
}

/// One for every taut cable, at the last linearisation.
pub(crate) fn pull_taut(
    equations: &Equations,
    system: &Collocation<N, M, Q, L>,
    solution: &Guess,
    stroke_control: &StrokeControl,
) -> Vec<UnitPull<N, M, Q, L>> {
    let at = StationData::of(system);
    let mut out = Vec::new();
    for index in stroke_control.taut_cables() {
        let cable = stroke_control.cables[index];
        let change = response_change(equations, system, solution, Way::Tension(cable));
        let mut response = Correction::default();
        respond(system, &change, &mut response);
        let mut strokes: Vec<f64> =
            stroke_control.cables.iter().map(|cable| equations.stroke_change(*cable, at, &response)).collect();
        strokes[index] += equations.stroke(cable, at)[1];
        out.push(UnitPull { response, strokes });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::parameter::Parameter;
    use crate::statics::refinement::{First, Refinable as _};
    use crate::{Arm, Cable, Profile};

    /// Three cables, one of them elastic and one short, in a stream.
    fn arm() -> Arm {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).reeled_in(0.010));
        arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).reeled_in(-0.006));
        arm.cables.push(Cable::new("short", Profile::linear(0.004, 0.002)).reeled_in(0.008));
        arm.cables[1].stiffness = Some(10.0);
        arm.cables[2].end = 0.12;
        arm.flow.speed = 0.2;
        arm.flow.direction = 1.0;
        arm
    }

    fn settled(arm: &Arm) -> Engine {
        let mut engine = Engine::new(arm);
        engine.equations.hold_strokes();
        engine.start_from_cables(8).unwrap();
        engine.settle(1e-11, First::Rough).unwrap();
        engine
    }

    fn tensions(engine: &Engine, unit: f64) -> Vec<f64> {
        engine.equations.arm().cables.iter().map(|c| c.tension / unit).collect()
    }

    /// The response of shape, tensions and slacks to every kind of parameter, against solves on both sides.
    #[test]
    fn responses_at_held_strokes_match_differences_of_solves() {
        const RANGE: f64 = 50.0;
        for (parameter, step, taut) in [
            (Parameter::Stroke(0), 1e-5, 2),
            (Parameter::Stroke(1), 1e-5, 2),
            (Parameter::FlowSpeed, 1e-3, 2),
            (Parameter::FlowDirection, 1e-3, 2),
            (Parameter::Young, 200.0, 2),
            (Parameter::BaseAngle, 1e-3, 2),
            (Parameter::TipFollower(1), 2e-5, 2),
        ] {
            let arm = arm();
            let mut engine = settled(&arm);
            assert_eq!(
                engine.equations.stroke_control.as_ref().unwrap().taut.iter().filter(|taut| **taut).count(),
                taut
            );
            let value = parameter.of(&arm).unwrap();
            // A range that differences of it are not lost in rounding.
            engine.equations.vary(parameter, value, value + RANGE * step);
            let mut round = NewtonStep::default();
            for _ in 0..3 {
                engine.linearise_at_strokes(true, &mut round).unwrap();
            }
            let at = |value: f64| {
                let mut arm = arm.clone();
                parameter.set(&mut arm, value).unwrap();
                settled(&arm)
            };
            let (before, after) = (at(value - step), at(value + step));
            let turned = 0.5 * (after.tip_angle() - before.tip_angle());
            let found = round.response.nodes.last().unwrap()[0] / RANGE;
            let bound = if parameter == Parameter::FlowDirection { 2e-5 } else { 2e-4 };
            assert!((turned - found).abs() < bound * turned.abs().max(1e-3), "{parameter}: {found} for {turned}");
            let unit = engine.equations.units.force;
            for (c, (after, before)) in tensions(&after, unit).iter().zip(tensions(&before, unit)).enumerate() {
                let (change, found) = (0.5 * (after - before), round.tension[1][c] / RANGE);
                assert!((change - found).abs() < bound * change.abs().max(1e-3), "{parameter}: {found} for {change}");
            }
            let slack = |engine: &Engine| {
                let stroke_control = engine.equations.stroke_control.clone().unwrap();
                let strokes = engine.strokes(0..3);
                let one = |i: usize| strokes[i] - engine.equations.command(&stroke_control, i);
                [one(0), one(1), one(2)]
            };
            for ((after, before), found) in slack(&after).iter().zip(slack(&before)).zip(&round.slack[1]) {
                let (change, found) = (0.5 * (after - before), found / RANGE);
                assert!((change - found).abs() < bound * change.abs().max(1e-5), "{parameter}: {found} for {change}");
            }
        }
    }

    #[test]
    fn rounds_at_held_strokes_converge_quadratically() {
        let mut engine = settled(&arm());
        let mut moved = engine.equations.arm().clone();
        moved.cables[0].stroke = Some(0.0105);
        engine.set_loads(&moved);
        let mut sizes = Vec::new();
        for _ in 0..5 {
            let mut round = NewtonStep::default();
            engine.linearise_at_strokes(false, &mut round).unwrap();
            engine.add_round(&round, 0, 1.0);
            sizes.push(round.off.max(round.rest.largest(0)));
        }
        assert!(sizes[2] < 5.0 * sizes[1].powi(2) && sizes[3] < 5.0 * sizes[2].powi(2), "{sizes:?}");
        assert!(sizes[4] < 1e-11, "{sizes:?}");
    }
}
