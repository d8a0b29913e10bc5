//! Steps in time, their error, and their length.
//!
//! With the weights a of a method ([`Tableau`]) and h the step, stage i has
//!
//! ```text
//! q_i = Q + h gamma v_i        Q = q_n + h sum_j a_ij v_j        (j < i)
//! v_i = V + h gamma a_i        V = v_n + h sum_j a_ij a_j
//! ```
//!
//! so that v_i = cv (q_i - Q) and a_i = cv (v_i - V) with cv = 1/(h gamma). Strains do the same with their rates.

use std::ops::Range;

use hydrostat_bvp::{Lanes, Real, Solution};

use super::error::{MotionError, MotionVerdict, MotionVerdictKind};
use super::event::{MotionEvent, MotionEventKind};
use super::history::{Snapshot, between};
use super::inputs::Inputs;
use super::pulls::{Pull, Pulls};
use super::settling::{Moves, Settling, Unsolved};
use super::start::not_found;
use super::state::MotionState;
use super::tableau::{RUNNING, STARTING, Tableau};
use super::works::{Ledger, Reading, WORKS};
use crate::rod::arm::Arm;
use crate::statics::dimensions::M;
use crate::statics::equations::SectionFailure;

/// The most steps that one run may take, those taken back included.
const MOST_STEPS: usize = 1_000_000;

/// What a step's embedded error may be over the tolerance of the tip: errors of steps add up.
const SHARE: f64 = 0.003;

/// The error of the tip over the sum of the steps' embedded ones. With relaxation times of 0.3 to 10 ms and tolerances
/// of 1e-2 to 1e-4 the largest error in a release of the silicone arm's cable was 0.6 to 5 times the sum.
const PROPAGATED: f64 = 3.0;

/// What unresolved waves of a jump move the tip by, over its way until then, as measured: 0.3 to 1.7 % where a cable of
/// the silicone arm is released, at any tolerance.
const UNRESOLVED: f64 = 0.02;

/// How short steps become in which cables become slack or taut, over the time in which the arm swings: motion has a
/// corner there, and the time itself is known better, from the line through the last tensions or slacks.
const EVENT: f64 = 1e-5;

/// Events whose time is looked for within a step, and that are kept, in one run.
const LOCATED: usize = 1000;
const EVENTS: usize = 10_000;

/// What is left of Newton's method over the error of a step: what is left is systematic and adds up.
const LEFT: f64 = 0.01;

/// The motion from step to step.
#[derive(Debug, Clone)]
pub(super) struct Stepper<P: Moves<S, L>, const S: usize, const L: usize> {
    pub(super) settling: Settling<P, S, L>,
    /// The arm with the loads of the start.
    arm: Arm,
    pub(super) inputs: Inputs,
    pub(super) time: f64,
    /// The motion at the end and at the start of the last step, in the coordinates of that step.
    pub(super) now: Snapshot,
    pub(super) before: Snapshot,
    /// The motion at `time` in the coordinates of the next step.
    start: Snapshot,
    /// The last step.
    pub(super) step: f64,
    /// The next one.
    next: f64,
    /// Whether accelerations at `time` are those after it.
    running: bool,
    stages: Vec<Snapshot>,
    kept: Solution<S, M, L>,
    kept_scales: [f64; S],
    kept_pull: Pull,
    /// What cables do through the last step.
    pub(super) pulls: Pulls,
    /// Works, and what the base carries.
    pub(super) ledger: Ledger,
    /// What happened, the first [`EVENTS`] times.
    pub(super) events: Vec<MotionEvent>,
    /// Whether the surface is folded at `time`.
    folded: bool,
    /// The first jump of a load that the motion passed.
    pub(super) jumped: Option<f64>,
    /// Smallest and largest x, y and z of the tip, over L.
    pub(super) reached: [[f64; 3]; 2],
    /// Error of a step over L that is asked for.
    tolerance: f64,
    /// Whether steps keep the length they are given.
    fixed: Option<f64>,
    /// Sum of the steps' embedded errors at the tip, over L.
    pub(super) error: f64,
    pub(super) steps: usize,
    pub(super) rejected: usize,
}

impl<P: Moves<S, L>, const S: usize, const L: usize> Stepper<P, S, L> {
    /// At rest in the equilibrium of the inputs just before `time`.
    pub(super) fn new(
        arm: &Arm,
        inputs: Inputs,
        time: f64,
        tol: f64,
        elements: Option<usize>,
        fixed: Option<f64>,
    ) -> Result<Self, MotionError> {
        arm.check()?;
        inputs.check(arm)?;
        let mut start = arm.clone();
        inputs.apply(&mut start, time);
        let settling = P::start(&start, elements, tol, time)?;
        Ok(Self::at_rest(settling, start, inputs, time, tol, fixed))
    }

    /// At rest in the shape that `settling` has, in equilibrium or not.
    pub(super) fn at_rest(
        mut settling: Settling<P, S, L>,
        start: Arm,
        inputs: Inputs,
        time: f64,
        tol: f64,
        fixed: Option<f64>,
    ) -> Self {
        let now = settling.moving.at_rest(&mut settling.system, &settling.solution);
        let (running, jumped) = (!inputs.jumps_from_rest(time), inputs.jumps_at(time).then_some(time));
        let nothing = [[0.0; WORKS]; 2];
        let this = Self::starting(settling, start, inputs, time, now, nothing);
        Self { running, jumped, tolerance: SHARE * tol, fixed, next: fixed.unwrap_or(0.0), ..this }
    }

    /// From a state that another run was in, which `settling` and `now` have taken.
    pub(super) fn going_on(
        settling: Settling<P, S, L>,
        start: Arm,
        inputs: Inputs,
        now: Snapshot,
        state: &MotionState,
        works: [[f64; WORKS]; 2],
        (tol, fixed): (f64, Option<f64>),
    ) -> Self {
        let running = state.smooth && !inputs.jumps_at(state.time);
        let this = Self::starting(settling, start, inputs, state.time, now, works);
        let next = fixed.unwrap_or(if running { state.next } else { 0.0 });
        let mut start = Snapshot::default();
        this.settling.moving.restarted(&this.now, &mut start);
        Self { start, running, tolerance: SHARE * tol, fixed, next, error: state.error, jumped: state.jumped, ..this }
    }

    fn starting(
        mut settling: Settling<P, S, L>,
        start: Arm,
        inputs: Inputs,
        time: f64,
        now: Snapshot,
        works: [[f64; WORKS]; 2],
    ) -> Self {
        settling.forget();
        let most = RUNNING.c.len();
        let energy = settling.moving.energies(&settling.system, &now).iter().sum();
        let [tip, _] = now.node_place(now.layout.nodes - 1);
        let pull = settling.pull(time);
        Self {
            kept: settling.solution.clone(),
            kept_scales: [1.0; S],
            pulls: Pulls::new(pull.clone()),
            kept_pull: pull,
            ledger: Ledger::new(time, settling.moving.carried_at(&settling.solution, 0), energy, works),
            events: Vec::new(),
            folded: settling.moving.fold_margin(&now)[0] <= 0.0,
            jumped: None,
            reached: [tip; 2],
            settling,
            arm: start,
            inputs,
            time,
            before: now.clone(),
            start: now.clone(),
            stages: vec![now.clone(); most],
            now,
            step: 0.0,
            next: 0.0,
            running: true,
            tolerance: SHARE,
            fixed: None,
            error: 0.0,
            steps: 0,
            rejected: 0,
        }
    }

    /// Takes the accelerations at the present time for unknown, as those of a shape that is let go.
    pub(super) fn let_go(mut self) -> Self {
        self.running = false;
        self
    }

    /// One step towards `until`, or to the first corner of an input before it.
    pub(super) fn advance(&mut self, until: f64) -> Result<(), MotionError> {
        let corner = self.inputs.next_corner(self.time).map_or(until, |corner| corner.min(until));
        let left = corner - self.time;
        if self.next <= 0.0 {
            self.next = self.first_step().min(left);
        }
        let shortest = 1e-9 * self.time.abs().max(1e-3);
        let mut reduced = false;
        loop {
            if self.steps + self.rejected >= MOST_STEPS {
                return Err(self.ended(MotionVerdictKind::TooManySteps, None));
            }
            // No rest that is much shorter than a step.
            let h = if self.next >= 0.999 * left {
                left
            } else if self.next > 0.5 * left {
                0.5 * left
            } else {
                self.next
            };
            match self.try_step(self.tableau(), h) {
                Ok([whole, tip]) => {
                    let ratio = whole / self.tolerance;
                    let factor = 0.9 * ratio.max(1e-8).powf(-0.25);
                    if ratio > 1.0 && self.fixed.is_none() && h > shortest {
                        self.reject(h * factor.clamp(0.1, 0.9));
                        reduced = true;
                        continue;
                    }
                    if let Some(shorter) = self.before_event(h) {
                        self.reject(shorter);
                        reduced = true;
                        continue;
                    }
                    self.accept(h, corner, h == left, tip);
                    if self.fixed.is_none() {
                        let most = if reduced { 1.0 } else { 4.0 };
                        let proposed = h * factor.clamp(0.2, most);
                        // A step cut by a corner says little of longer ones.
                        self.next = if h < 0.9 * self.next { proposed.max(self.next.min(4.0 * h)) } else { proposed };
                    }
                    return Ok(());
                }
                Err(unsolved) => {
                    if h < shortest || self.fixed.is_some() && h < 1e-3 * self.next {
                        let failure = match unsolved {
                            Unsolved::Section(failure) => Some(failure),
                            _ => None,
                        };
                        return Err(self.ended_by(h, failure));
                    }
                    self.reject(0.25 * h);
                    reduced = true;
                }
            }
        }
    }

    /// The method of the next step.
    fn tableau(&self) -> &'static Tableau {
        if self.running { &RUNNING } else { &STARTING }
    }

    fn reject(&mut self, next: f64) {
        self.rejected += 1;
        self.next = next;
        self.settling.restore(&self.kept, &self.kept_scales, self.time);
        self.settling.take_pull(&self.kept_pull);
    }

    fn accept(&mut self, h: f64, corner: f64, to_corner: bool, tip_error: f64) {
        std::mem::swap(&mut self.before, &mut self.start);
        let tableau = self.tableau();
        std::mem::swap(&mut self.now, &mut self.stages[tableau.c.len() - 1]);
        self.settling.moving.restarted(&self.now, &mut self.start);
        let energy = self.settling.moving.energies(&self.settling.system, &self.now).iter().sum();
        self.ledger.accept(tableau, h, energy);
        self.time = if to_corner { corner } else { self.time + h };
        self.step = h;
        self.steps += 1;
        self.error += tip_error;
        let [tip, _] = self.now.node_place(self.now.layout.nodes - 1);
        for (k, place) in tip.into_iter().enumerate() {
            self.reached[0][k] = self.reached[0][k].min(place);
            self.reached[1][k] = self.reached[1][k].max(place);
        }
        self.kept.clone_from(&self.settling.solution);
        self.kept_pull = self.settling.pull(self.time);
        self.kept_scales = *self.settling.moving.scales();
        self.note_events();
        self.pulls.accept(!to_corner);
        self.running = true;
        if to_corner && self.inputs.jumps_at(self.time) {
            self.running = false;
            self.jumped = self.jumped.or(Some(self.time));
            self.settling.forget();
            if self.fixed.is_none() {
                self.next = 0.0;
            }
        }
    }

    /// A shorter step, to just before the first cable became slack or taut in the one of length `h`.
    fn before_event(&self, h: f64) -> Option<f64> {
        let short = EVENT * self.settling.moving.time_unit();
        if h <= short || self.events.len() >= LOCATED || self.fixed.is_some() {
            return None;
        }
        let first = self.pulls.changes().into_iter().map(|(_, time, _)| time).min_by(f64::total_cmp)?;
        Some((first - self.time - 0.5 * short).clamp(0.5 * short, 0.5 * h))
    }

    /// Notes what happened in the last step.
    fn note_events(&mut self) {
        let mut changes = self.pulls.changes();
        changes.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (index, time, taut) in changes {
            let cable = self.settling.held_cables()[index];
            let kind = if taut { MotionEventKind::Taut(cable) } else { MotionEventKind::Slack(cable) };
            self.note(MotionEvent { time, kind });
        }
        let folded = self.settling.moving.fold_margin(&self.now)[0] <= 0.0;
        if folded != self.folded {
            self.folded = folded;
            self.note_fold(folded);
        }
    }

    /// Finds when in the last step the surface folded, or unfolded.
    fn note_fold(&mut self, folded: bool) {
        let mut at = Snapshot::default();
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            between(&self.before, &self.now, self.step, middle, &mut at);
            let there = self.settling.moving.fold_margin(&at)[0] <= 0.0;
            if there == folded { high = middle } else { low = middle }
        }
        between(&self.before, &self.now, self.step, high, &mut at);
        let [_, s] = self.settling.moving.fold_margin(&at);
        let place = s * self.arm.length;
        let kind = if folded { MotionEventKind::SurfaceFolds(place) } else { MotionEventKind::SurfaceUnfolds };
        self.note(MotionEvent { time: self.time - (1.0 - high) * self.step, kind });
    }

    fn note(&mut self, event: MotionEvent) {
        if self.events.len() < EVENTS {
            self.events.push(event);
        }
    }

    /// Solves the stages of a step; the largest error along the arm and that of the tip, over L.
    fn try_step(&mut self, tableau: &Tableau, h: f64) -> Result<[f64; 2], Unsolved> {
        let cv = 1.0 / (h * tableau.gamma);
        self.settling.set_rate(cv);
        let first = usize::from(tableau.explicit_first);
        self.settling.moving.start_step(&self.start);
        if tableau.explicit_first {
            self.stages[0].clone_from(&self.start);
        }
        self.ledger.start(self.time, tableau.explicit_first);
        let holds = !self.settling.held_cables().is_empty();
        if holds {
            self.pulls.start(&self.kept_pull);
        }
        for i in first..tableau.c.len() {
            let time = self.time + tableau.c[i] * h;
            self.take_loads(time);
            let (done, rest) = self.stages.split_at_mut(i);
            let history = self.settling.moving.history_mut();
            history.values.clone_from(&self.start.values);
            history.rates.copy_from_slice(&self.start.rates[..self.start.layout.second()]);
            for (j, stage) in done.iter().enumerate() {
                let weight = h * tableau.a[i][j];
                if weight != 0.0 {
                    add(&mut history.values, &stage.rates, weight);
                    add(&mut history.rates, &stage.second, weight);
                }
            }
            self.settling.solve(time, LEFT * self.tolerance)?;
            let own = &mut rest[0];
            let settling = &mut self.settling;
            settling.moving.read(&mut settling.system, &settling.solution, own);
            own.rates_from(cv, settling.moving.history_mut());
            let base = settling.moving.carried_at(&settling.solution, 0);
            let powers = settling.moving.powers(&settling.system, own, base);
            self.ledger.take(Reading { time, powers, base });
            if holds {
                self.pulls.take(self.settling.pull(time));
            }
        }
        Ok(self.errors(tableau, h))
    }

    /// The embedded error: the largest of the centreline and, where it counts ([`Moves::radius`]), of the surface as
    /// sections turn; and that of the tip.
    fn errors(&self, tableau: &Tableau, h: f64) -> [f64; 2] {
        let layout = self.start.layout;
        let zero = Lanes::of(0.0);
        let terms = || self.stages.iter().zip(tableau.error).take(tableau.c.len());
        let at = |k: usize| terms().fold(zero, |sum, (stage, weight)| sum + Lanes::of(h * weight) * stage.rates[k]);
        let mut largest = 0.0_f64;
        for block in 0..layout.blocks {
            let first = layout.coordinates() * block + layout.turns;
            let square = |of: Range<usize>| of.map(at).fold(zero, |sum, error| sum + error * error);
            let mut take = |square: Lanes| {
                for v in square.0 {
                    largest = if v.is_nan() { f64::NAN } else { largest.max(v) };
                }
            };
            take(square(first..first + layout.places));
            if let Some(radius) = self.settling.moving.radius(block) {
                take(radius * radius * square(first - layout.turns..first));
            }
        }
        let mut off = [0.0; 3];
        for (stage, weight) in terms() {
            let rate = stage.place_in(&stage.rates, layout.nodes - 1);
            off.iter_mut().zip(rate).for_each(|(sum, rate)| *sum += h * weight * rate);
        }
        let tip = norm(&off);
        let whole = largest.sqrt().max(tip);
        [if whole.is_nan() { f64::INFINITY } else { whole }, tip]
    }

    /// The loads just before `time`.
    fn take_loads(&mut self, time: f64) {
        self.inputs.apply(&mut self.arm, time);
        self.settling.moving.take_loads(&self.arm, &self.inputs, time);
    }

    /// A step after which control finds its own: a small part of the time that the arm takes to swing.
    fn first_step(&self) -> f64 {
        let arm = &self.arm;
        let length = arm.length;
        let [_, _, ei] = arm.stiffness_at(0.0);
        let r = arm.radius.at(0.0, length).value;
        let mass = std::f64::consts::PI * r * r * (arm.density + arm.flow.density);
        let period = (mass * length.powi(4) / ei).sqrt();
        if self.step > 0.0 { self.step.min(0.02 * period) * 0.2 } else { 0.005 * period.max(1e-6) }
    }

    fn ended(&self, kind: MotionVerdictKind, s: Option<f64>) -> MotionError {
        MotionError::Ended(MotionVerdict { kind, time: self.time, s, step: self.next })
    }

    fn ended_by(&self, h: f64, failure: Option<SectionFailure>) -> MotionError {
        not_found(self.time, h, failure, &self.arm)
    }

    /// The fraction of the last step that is over at `time`: 1 before the first one.
    pub(super) fn fraction_at(&self, time: f64) -> f64 {
        if self.step == 0.0 { 1.0 } else { 1.0 - (self.time - time) / self.step }
    }

    /// The first jump of a load whose waves no step resolves: the material has no memory of rate that damps them.
    pub(super) fn unresolved_jump(&self) -> Option<f64> {
        let dynamics = &self.arm.dynamics;
        self.jumped.filter(|_| dynamics.inertia && dynamics.relaxation_time == 0.0)
    }

    /// What the tip is off by, over L, as far as that is known.
    pub(super) fn estimate(&self) -> f64 {
        let [least, most] = self.reached;
        let way = norm(&std::array::from_fn(|k| most[k] - least[k]));
        PROPAGATED * self.error + self.unresolved_jump().map_or(0.0, |_| UNRESOLVED * way)
    }

    /// The next step, and whether accelerations at `time` go on.
    pub(super) fn next_step(&self) -> (f64, bool) {
        (self.next, self.running)
    }

    /// The arm with the loads of the last solve.
    pub(super) fn arm(&self) -> &Arm {
        &self.arm
    }
}

/// `list += weight other`, as far as both go.
fn add(list: &mut [Lanes], other: &[Lanes], weight: f64) {
    let weight = Lanes::of(weight);
    for (own, other) in list.iter_mut().zip(other) {
        *own += weight * *other;
    }
}

fn norm(v: &[f64; 3]) -> f64 {
    v[0].hypot(v[1]).hypot(v[2])
}
