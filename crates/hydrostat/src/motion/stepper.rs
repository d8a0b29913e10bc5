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

use hydrostat_bvp::{Lanes, Mesh, Real};

use super::dimensions::{S, Shape};
use super::error::{MotionError, MotionVerdict, MotionVerdictKind};
use super::event::{MotionEvent, MotionEventKind};
use super::history::{Snapshot, between};
use super::inputs::Inputs;
use super::settling::{Settling, Unsolved};
use super::state::MotionState;
use super::tableau::{RUNNING, STARTING, Tableau};
use super::works::{Ledger, Reading, WORKS};
use crate::rod::arm::Arm;
use crate::rod::readings::Support;
use crate::statics::engine::Engine;
use crate::statics::equations::{Margins, SectionFailure};
use crate::statics::limit::limit_at;
use crate::statics::refinement::graded;
use crate::statics::solve::{Options, Solver};
use crate::statics::verdict::{SolveError, VerdictKind};

/// The most steps that one run may take, those taken back included.
const MOST_STEPS: usize = 1_000_000;

/// What a step's embedded error may be over the tolerance of the tip: errors of steps add up.
const SHARE: f64 = 0.003;

/// What unresolved waves of a jump move the tip by, over its way until then, as measured: 0.3 to 1.7 % where a cable of
/// the silicone arm is released, at any tolerance.
const UNRESOLVED: f64 = 0.02;

/// To how much of the time in which the arm swings it is known when cables become slack or taut.
const EVENT: f64 = 1e-4;

/// Events whose time is looked for within a step, and that are kept, in one run.
const LOCATED: usize = 1000;
const EVENTS: usize = 10_000;

/// What is left of Newton's method over the error of a step: what is left is systematic and adds up.
const LEFT: f64 = 0.01;

/// The motion from step to step.
#[derive(Debug, Clone)]
pub(super) struct Stepper {
    pub(super) settling: Settling,
    /// The arm with the loads of the start.
    arm: Arm,
    pub(super) inputs: Inputs,
    pub(super) time: f64,
    /// The motion at `time`, and at the start of the last step.
    pub(super) now: Snapshot,
    pub(super) before: Snapshot,
    /// The last step.
    pub(super) step: f64,
    /// The next one.
    next: f64,
    /// Whether accelerations at `time` are those after it.
    running: bool,
    stages: Vec<Snapshot>,
    kept: Shape,
    kept_scales: [f64; S],
    kept_tensions: (Vec<f64>, Vec<bool>),
    /// Tensions (N) through the last step, with their times.
    pub(super) tensions: Vec<(f64, Vec<f64>)>,
    /// Works, and what the base carries.
    pub(super) ledger: Ledger,
    /// What happened, the first [`EVENTS`] times.
    pub(super) events: Vec<MotionEvent>,
    /// Whether the surface is folded at `time`.
    folded: bool,
    /// The first jump of a load that the motion passed.
    pub(super) jumped: Option<f64>,
    /// Smallest and largest x and y of the tip, over L.
    pub(super) reached: [[f64; 2]; 2],
    /// Error of a step over L that is asked for.
    tolerance: f64,
    /// Whether steps keep the length they are given.
    fixed: Option<f64>,
    /// Sum of the steps' embedded errors at the tip, over L.
    pub(super) error: f64,
    pub(super) steps: usize,
    pub(super) rejected: usize,
}

impl Stepper {
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
        let mut settling = Settling::new(&start);
        start_at_rest(&mut settling, &start, elements, tol, time)?;
        Ok(Self::at_rest(settling, start, inputs, time, tol, fixed))
    }

    /// At rest in the shape that `settling` has, in equilibrium or not.
    pub(super) fn at_rest(
        mut settling: Settling,
        start: Arm,
        inputs: Inputs,
        time: f64,
        tol: f64,
        fixed: Option<f64>,
    ) -> Self {
        let layout = settling.moving.layout();
        let mut now = Snapshot::at_rest(layout);
        now.take(&mut settling.system, &settling.solution, &settling.moving.scales);
        let (running, jumped) = (!inputs.jumps_from_rest(time), inputs.jumps_at(time).then_some(time));
        let nothing = [[0.0; WORKS]; 2];
        let this = Self::starting(settling, start, inputs, time, now, nothing);
        Self { running, jumped, tolerance: SHARE * tol, fixed, next: fixed.unwrap_or(0.0), ..this }
    }

    /// From a state that another run was in.
    pub(super) fn resumed(
        arm: &Arm,
        inputs: Inputs,
        state: &MotionState,
        tol: f64,
        fixed: Option<f64>,
    ) -> Result<Self, MotionError> {
        arm.check()?;
        inputs.check(arm)?;
        let mut start = arm.clone();
        inputs.apply(&mut start, state.time);
        check(&start)?;
        let mesh = state.check(&start)?;
        let mut settling = Settling::new(&start);
        let statics = &mut settling.moving.statics;
        for (c, tension) in state.tensions.iter().enumerate().filter(|(c, _)| start.cables[*c].stroke.is_some()) {
            statics.set_tension(c, *tension);
        }
        statics.hold_strokes();
        let now = state.restore(&mut settling, mesh);
        let energy = settling.moving.statics.units.force * start.length;
        let works = [&state.works, &state.powers].map(|list| std::array::from_fn(|k| list[k] / energy));
        let running = state.smooth && !inputs.jumps_at(state.time);
        let this = Self::starting(settling, start, inputs, state.time, now, works);
        let next = fixed.unwrap_or(if running { state.next } else { 0.0 });
        Ok(Self { running, tolerance: SHARE * tol, fixed, next, error: state.error, jumped: state.jumped, ..this })
    }

    fn starting(
        mut settling: Settling,
        start: Arm,
        inputs: Inputs,
        time: f64,
        now: Snapshot,
        works: [[f64; WORKS]; 2],
    ) -> Self {
        settling.forget();
        let most = RUNNING.c.len();
        let energy = settling.moving.energies(&settling.system, &now).iter().sum();
        let [_, x, y] = now.node(now.layout.nodes - 1);
        Self {
            kept: settling.solution.clone(),
            kept_scales: [1.0; S],
            kept_tensions: settling.tensions(),
            tensions: vec![(time, settling.tensions().0)],
            ledger: Ledger::new(time, settling.at_base(), energy, works),
            events: Vec::new(),
            folded: settling.moving.fold_margin(&now)[0] <= 0.0,
            jumped: None,
            reached: [[x, y]; 2],
            settling,
            arm: start,
            inputs,
            time,
            before: now.clone(),
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
        self.settling.take_tensions(&self.kept_tensions);
    }

    fn accept(&mut self, h: f64, corner: f64, to_corner: bool, tip_error: f64) {
        std::mem::swap(&mut self.before, &mut self.now);
        let tableau = self.tableau();
        std::mem::swap(&mut self.now, &mut self.stages[tableau.c.len() - 1]);
        let energy = self.settling.moving.energies(&self.settling.system, &self.now).iter().sum();
        self.ledger.accept(tableau, h, energy);
        self.time = if to_corner { corner } else { self.time + h };
        self.step = h;
        self.steps += 1;
        self.error += tip_error;
        let [_, x, y] = self.now.node(self.now.layout.nodes - 1);
        let [least, most] = self.reached;
        self.reached = [[least[0].min(x), least[1].min(y)], [most[0].max(x), most[1].max(y)]];
        self.kept.clone_from(&self.settling.solution);
        let tensions = std::mem::replace(&mut self.kept_tensions, self.settling.tensions());
        self.kept_scales = self.settling.moving.scales;
        self.note_events(&tensions.1);
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

    /// A shorter step, where cables became slack or taut in the one of length `h` and it is not known well when.
    fn before_event(&self, h: f64) -> Option<f64> {
        let changed = self.settling.tensions().1 != self.kept_tensions.1;
        let known = h <= EVENT * self.settling.moving.time_unit() || self.events.len() >= LOCATED;
        (changed && !known && self.fixed.is_none()).then_some(0.5 * h)
    }

    /// Notes what happened in the last step, before which the cables were taut as `taut` says.
    fn note_events(&mut self, taut: &[bool]) {
        let held: Vec<usize> = self.settling.moving.held().collect();
        for ((cable, before), now) in held.into_iter().zip(taut).zip(self.kept_tensions.1.clone()) {
            if *before != now {
                let kind = if now { MotionEventKind::Taut(cable) } else { MotionEventKind::Slack(cable) };
                self.note(MotionEvent { time: self.time, kind });
            }
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
        if tableau.explicit_first {
            self.stages[0].clone_from(&self.now);
        }
        self.ledger.start(self.time, tableau.explicit_first);
        let holds = self.settling.moving.statics.held.is_some();
        if holds {
            self.tensions = vec![(self.time, self.kept_tensions.0.clone())];
        }
        for i in first..tableau.c.len() {
            let time = self.time + tableau.c[i] * h;
            self.take_loads(time);
            let (done, rest) = self.stages.split_at_mut(i);
            let history = &mut self.settling.moving.history;
            history.values.clone_from(&self.now.values);
            history.rates.copy_from_slice(&self.now.rates[..self.now.layout.second()]);
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
            own.take(&mut settling.system, &settling.solution, &settling.moving.scales);
            own.rates_from(cv, &settling.moving.history);
            let base = settling.at_base();
            let powers = settling.moving.powers(&settling.system, own, base);
            self.ledger.take(Reading { time, powers, base });
            if holds {
                self.tensions.push((time, self.settling.tensions().0));
            }
        }
        Ok(self.errors(tableau, h))
    }

    /// The embedded error of x and y: the largest, and the tip's.
    fn errors(&self, tableau: &Tableau, h: f64) -> [f64; 2] {
        let layout = self.now.layout;
        let zero = Lanes::of(0.0);
        let at = |k: usize| {
            let terms = self.stages.iter().zip(tableau.error).take(tableau.c.len());
            terms.fold(zero, |sum, (stage, weight)| sum + Lanes::of(h * weight) * stage.rates[k])
        };
        let mut largest = 0.0_f64;
        for block in 0..layout.blocks {
            let (x, y) = (at(3 * block + 1), at(3 * block + 2));
            let square = x * x + y * y;
            for v in square.0 {
                largest = if v.is_nan() { f64::NAN } else { largest.max(v) };
            }
        }
        let tip = at(3 * layout.blocks + layout.nodes - 1);
        let tip = tip.0[1].hypot(tip.0[2]);
        let whole = largest.sqrt().max(tip);
        [if whole.is_nan() { f64::INFINITY } else { whole }, tip]
    }

    /// The loads just before `time`.
    fn take_loads(&mut self, time: f64) {
        self.inputs.apply(&mut self.arm, time);
        let acceleration = self.inputs.stream_acceleration(&self.arm, time);
        self.settling.moving.set_loads(&self.arm, acceleration);
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

    /// The tension of a held cable (N) at `time` in the last step, by straight lines between its stages.
    pub(super) fn tension_at(&self, cable: usize, time: f64) -> f64 {
        let before = self.tensions.iter().filter(|(t, _)| *t <= time).max_by(|a, b| a.0.total_cmp(&b.0));
        let after = self.tensions.iter().filter(|(t, _)| *t >= time).min_by(|a, b| a.0.total_cmp(&b.0));
        match (before, after) {
            (Some((t, v)), Some((u, w))) if u > t => v[cable] + (w[cable] - v[cable]) * (time - t) / (u - t),
            (Some((_, v)), _) | (None, Some((_, v))) => v[cable],
            (None, None) => 0.0,
        }
    }

    /// The share of the last step that is over at `time`: 1 before the first one.
    pub(super) fn share_at(&self, time: f64) -> f64 {
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
        let way = (most[0] - least[0]).hypot(most[1] - least[1]);
        self.error + self.unresolved_jump().map_or(0.0, |_| UNRESOLVED * way)
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

/// Settles on the equilibrium of `arm`: that of the statics, or, where these find none and name no limit, the one that
/// Newton's method finds from the unloaded arm (a hinge is too soft for the statics' evidence).
pub(super) fn start_at_rest(
    settling: &mut Settling,
    arm: &Arm,
    elements: Option<usize>,
    tol: f64,
    time: f64,
) -> Result<(), MotionError> {
    check(arm)?;
    let elements = elements.unwrap_or_else(|| fair_elements(arm, tol));
    let of_start = |error: SolveError| MotionError::Start(Box::new(error));
    let mut solver = Solver::new(arm, Options::with_tol((0.01 * tol).clamp(1e-10, 1e-6))).map_err(of_start)?;
    let missing = match solver.solve() {
        Ok(_) => {
            let engine = solver.engine_mut();
            let statics = &mut settling.moving.statics;
            for (c, cable) in
                engine.equations.arm().cables.iter().enumerate().filter(|(_, cable)| cable.stroke.is_some())
            {
                statics.set_tension(c, cable.tension);
            }
            statics.hold_strokes();
            let mesh = mesh_at(engine, arm, elements);
            settling.start_from(&engine.solution, engine.equations.units.force, mesh);
            None
        }
        Err(SolveError::NoEquilibrium(no)) if no.verdict.kind == VerdictKind::NotFound => {
            settling.start_unloaded(mesh(arm, elements));
            Some(SolveError::NoEquilibrium(no))
        }
        Err(error) => return Err(of_start(error)),
    };
    match settling.solve(time, 1e-10).and_then(|()| settling.solve(time, 1e-12)) {
        Ok(()) => Ok(()),
        Err(_) => Err(missing.map_or_else(|| not_found(time, 0.0, None, arm), of_start)),
    }
}

/// The verdict on a step that cannot be done.
pub(super) fn not_found(time: f64, step: f64, failure: Option<SectionFailure>, arm: &Arm) -> MotionError {
    let near = failure.map(|SectionFailure { s, openness, nu, regularity }| Margins {
        openness: (openness, s),
        nu: (nu, s),
        regularity: (regularity, s),
    });
    let kind = match near.and_then(|near| limit_at(near, arm.readings.volume)) {
        Some((VerdictKind::CableFold, _)) => MotionVerdictKind::CableFold,
        Some((VerdictKind::SectionCrushed, _)) => MotionVerdictKind::SectionCrushed,
        Some((VerdictKind::NoSectionSolution, _)) => MotionVerdictKind::NoSectionSolution,
        _ => MotionVerdictKind::NotFound,
    };
    MotionError::Ended(MotionVerdict { kind, time, s: failure.map(|f| f.s * arm.length), step })
}

/// `list += weight other`, as far as both go.
fn add(list: &mut [Lanes], other: &[Lanes], weight: f64) {
    let weight = Lanes::of(weight);
    for (own, other) in list.iter_mut().zip(other) {
        *own += weight * *other;
    }
}

/// Elements for a tolerance. In water, kinks of the drag bound what a mesh can do, not modes.
fn fair_elements(arm: &Arm, tol: f64) -> usize {
    let count = if tol >= 5e-4 {
        8
    } else if tol >= 5e-5 {
        12
    } else {
        20
    };
    if arm.flow.density == 0.0 { 8.min(count) } else { count }
}

/// A mesh with nodes on the kinks that the stream's load has at the shape of the engine.
pub(super) fn mesh_at(engine: &mut Engine, arm: &Arm, elements: usize) -> Mesh {
    let mut mesh = mesh(arm, elements);
    let kinks = engine.kinks(1e-6);
    let fixed: Vec<f64> = arm.breaks().iter().map(|s| s / arm.length).collect();
    if kinks.len() <= mesh.elements() {
        mesh.pin(&fixed, &kinks);
    }
    mesh
}

fn mesh(arm: &Arm, elements: usize) -> Mesh {
    let breaks: Vec<f64> = arm.breaks().iter().map(|s| s / arm.length).collect();
    graded(arm, &breaks, elements)
}

/// Refuses what cannot move.
pub(super) fn check(arm: &Arm) -> Result<(), MotionError> {
    arm.check()?;
    let refuse = |key: String, reason| Err(MotionError::Unsupported { key, reason });
    if arm.readings.support == Support::UnstrainedBase {
        return refuse("model.support".to_owned(), "only a clamped arm can move");
    }
    if let Some(i) = arm.cables.iter().position(|c| c.friction > 0.0) {
        return refuse(
            format!("cable[{i}].friction"),
            "cables with friction stick as they turn back, which motion leaves out",
        );
    }
    if !arm.dynamics.inertia && arm.flow.density == 0.0 && arm.dynamics.relaxation_time == 0.0 {
        return refuse(
            "dynamics.inertia".to_owned(),
            "without inertia, water and relaxation time nothing resists the motion",
        );
    }
    if arm.dynamics.inertia && arm.density == 0.0 {
        return refuse("arm.density".to_owned(), "an arm without mass has no motion; set `dynamics.inertia = false`");
    }
    Ok(())
}
