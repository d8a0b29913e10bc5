//! A run from time to time, in the plane or in space.

use super::error::MotionError;
use super::history::{Snapshot, between};
use super::inputs::Inputs;
use super::options::{MotionOptions, MotionStatistics};
use super::resumed::resumed;
use super::settling::Moves;
use super::state::{MotionState, flat};
use super::stepper::Stepper;
use super::warning::MotionWarning;
use super::works::Works;
use crate::rod::arm::Arm;

/// A motion at the time that was asked for last.
#[derive(Debug, Clone)]
pub(super) struct Run<P: Moves<S, L>, const S: usize, const L: usize> {
    pub(super) stepper: Stepper<P, S, L>,
    /// The motion at the time asked for.
    pub(super) asked: Snapshot,
    pub(super) time: f64,
}

impl<P: Moves<S, L>, const S: usize, const L: usize> Run<P, S, L> {
    /// The arm at rest in the equilibrium of its loads just before the start.
    pub(super) fn new(arm: &Arm, inputs: Inputs, options: MotionOptions) -> Result<Self, MotionError> {
        options.check()?;
        let MotionOptions { start, tol, elements, step } = options;
        Ok(Self::of(Stepper::new(arm, inputs, start, tol, elements, step)?))
    }

    /// From the state that another run was in.
    pub(super) fn resume(
        arm: &Arm,
        inputs: Inputs,
        options: MotionOptions,
        state: &MotionState,
    ) -> Result<Self, MotionError> {
        options.check()?;
        Ok(Self::of(resumed(arm, inputs, state, options.tol, options.step)?))
    }

    pub(super) fn of(stepper: Stepper<P, S, L>) -> Self {
        Self { asked: stepper.now.clone(), time: stepper.time, stepper }
    }

    /// What the run took until now.
    pub(super) fn statistics(&self) -> MotionStatistics {
        let settling = &self.stepper.settling;
        MotionStatistics {
            steps: self.stepper.steps,
            rejected: self.stepper.rejected,
            solves: settling.solves,
            rounds: settling.rounds,
            elements: settling.solution.mesh.elements(),
        }
    }

    /// The error of the tip, m.
    pub(super) fn error_estimate(&self) -> f64 {
        self.stepper.estimate() * self.stepper.arm().length
    }

    /// The unit of energy, J.
    fn energy(&self) -> f64 {
        let units = self.stepper.settling.moving.units();
        units.force * units.length
    }

    /// By how much the steps changed the energy of the arm beside all works, J.
    pub(super) fn energy_gap(&self) -> f64 {
        self.stepper.ledger.gap()[0] * self.energy()
    }

    /// What was done on the arm since the start.
    pub(super) fn works(&self) -> Works {
        let stepper = &self.stepper;
        stepper.ledger.works_at(stepper.fraction_at(self.time), stepper.step).in_units_of(self.energy())
    }

    /// What should be known about the motion until now.
    pub(super) fn warnings(&self) -> Vec<MotionWarning> {
        let warning = |time| MotionWarning::UnresolvedJump { time };
        self.stepper.unresolved_jump().map(warning).into_iter().collect()
    }

    /// What it takes to go on from the present time in another run.
    pub(super) fn state(&self) -> MotionState {
        let (stepper, settling) = (&self.stepper, &self.stepper.settling);
        let (units, solution) = (settling.moving.units(), &settling.solution);
        let energy = units.force * units.length;
        let (next, running) = stepper.next_step();
        let at_end = self.time == stepper.time;
        let [works, powers] = stepper.ledger.at(stepper.fraction_at(self.time), stepper.step);
        let mut tensions = vec![0.0; stepper.arm().cables.len()];
        for &cable in settling.held_cables() {
            tensions[cable] = stepper.pulls.tension_at(cable, self.time);
        }
        let contact = |node: usize| {
            let carried = settling.moving.carried_at(solution, node);
            P::CARRIED.iter().map(|k| carried[*k] * if *k < 3 { units.force } else { energy }).collect()
        };
        MotionState {
            time: self.time,
            length: units.length,
            nodes: solution.mesh.nodes().to_vec(),
            values: flat(&self.asked.values),
            rates: flat(&self.asked.rates),
            second: flat(&self.asked.second),
            rotations: flat(self.asked.from.as_flattened()),
            contact: (0..solution.nodes.len()).map(contact).collect(),
            tensions,
            works: works.map(|work| work * energy).to_vec(),
            powers: powers.map(|power| power * energy).to_vec(),
            error: stepper.error,
            next,
            jumped: stepper.jumped,
            smooth: running || !at_end,
        }
    }

    /// The arm with the loads of the present time.
    pub(super) fn arm(&self) -> Arm {
        let mut arm = self.stepper.arm().clone();
        self.stepper.inputs.apply(&mut arm, self.time);
        arm
    }

    /// Moves on by `dt` (s) while `loads` change to these values along straight lines, or until `go_on` refuses the
    /// next step in time.
    pub(super) fn step_to(
        &mut self,
        dt: f64,
        loads: &[(&str, f64)],
        mut go_on: impl FnMut() -> bool,
    ) -> Result<(), MotionError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(MotionError::Option { option: "dt", value: dt, expected: "above 0" });
        }
        if self.stepper.time > self.time {
            let (option, value) = ("time", self.stepper.time);
            let expected = "the end of a step: loads can be led on only in a run of which every step does so";
            return Err(MotionError::Option { option, value, expected });
        }
        let end = self.time + dt;
        let arm = self.arm();
        for (key, value) in loads {
            self.stepper.inputs.lead(key, *value, &arm, [self.time, end])?;
        }
        loop {
            self.stepper.advance(end)?;
            if self.stepper.time >= end || !go_on() {
                break;
            }
        }
        self.asked.clone_from(&self.stepper.now);
        self.time = self.stepper.time;
        Ok(())
    }

    /// Moves on to `time` (s), which is not before the present one.
    pub(super) fn advance_to(&mut self, time: f64) -> Result<(), MotionError> {
        if !(time >= self.time && time.is_finite()) {
            return Err(MotionError::Option { option: "time", value: time, expected: "not before the present one" });
        }
        // Steps may pass the time asked for, but not the corners of inputs.
        let far = time + 1e6;
        while self.stepper.time < time {
            self.stepper.advance(far)?;
        }
        let stepper = &self.stepper;
        if stepper.time == time || stepper.step == 0.0 {
            self.asked.clone_from(&stepper.now);
        } else {
            let x = stepper.fraction_at(time);
            between(&stepper.before, &stepper.now, stepper.step, x, &mut self.asked);
        }
        self.time = time;
        Ok(())
    }

    /// The present time, that and `every`, and so on up to `until` (s).
    pub(super) fn times(
        &self,
        until: f64,
        every: f64,
    ) -> Result<impl Iterator<Item = f64> + use<P, S, L>, MotionError> {
        if !(every > 0.0 && every.is_finite()) {
            return Err(MotionError::Option { option: "every", value: every, expected: "above 0" });
        }
        let start = self.time;
        let times =
            (1_u64..).map(move |k| start + k as f64 * every).take_while(move |time| *time <= until + 1e-9 * every);
        Ok(std::iter::once(start).chain(times))
    }
}
