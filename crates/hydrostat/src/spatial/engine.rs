//! Newton rounds on the equations of one arm in space.

use std::sync::LazyLock;

use hydrostat_bvp::{
    Collocation, Correction, Determinant, Forcing, Gauss, Lanes, LinearisationError, Resampling, Solution,
};

use super::equations::{Equations, Guess, K, L, M, N, Q};
use super::lengths::StrokeRound;
use super::neutral::without_neutral;
use super::rotation::{Vector, dot, turn_of};
use crate::numerics::rounds::{correct, linearise, respond};
use crate::rod::arm::Arm;
use crate::rod::model_options::Support;
use crate::statics::configuration::Statistics;
use crate::statics::engine::Trouble;
use crate::statics::equations::{SectionFailure, StrokeControl, Way};

/// Steps of the section law that the check leaves: its one round has to take up their squares.
const CHECKED: f64 = 1e-5;

/// What the square of a change of strains leaves to the tip's way (over L).
const LEFT_BY_STRAINS: f64 = 0.01;

/// What strokes may be off by (over L) before the last round, which leaves the square of that.
const STROKES: f64 = 1e-10;

/// Rounds at held lengths added to those at given tensions: the set of taut cables may change.
const MORE: usize = 12;

/// Changes of own ends that one call of Newton's method may make.
const TURNS: usize = 2;

/// Corrections (rad) after which kinks of the load are where they will be, but for second order.
const SMALL: f64 = 0.1;

/// Rounds of Newton after which nodes are moved onto the kinks before the next.
const PINS: usize = 2;

/// The methods of solve and check.
#[derive(Debug)]
pub(super) struct Methods {
    solve: Gauss<M>,
    pub(super) check: Gauss<K>,
    pub(super) to_check: Resampling<M, K>,
}

pub(super) static METHODS: LazyLock<Methods> = LazyLock::new(|| {
    let (solve, check) = (Gauss::new(), Gauss::new());
    let to_check = Resampling::new(&solve, &check);
    Methods { solve, check, to_check }
});

#[derive(Debug, Clone)]
pub(crate) struct Engine {
    pub(crate) equations: Equations,
    /// The cables whose strokes are commanded, once they are.
    pub(super) stroke_control: Option<StrokeControl>,
    /// Determinant of the strokes of taut cables by their tensions, at the last round.
    pub(super) border: Option<Determinant>,
    pub(crate) system: Collocation<N, M, Q, L>,
    pub(super) check_equations: Equations,
    pub(super) check: Collocation<N, K, Q, L>,
    pub(crate) solution: Guess,
    pub(super) correction: Correction<N, M, Q, L>,
    pub(super) check_correction: Correction<N, K, Q, L>,
    /// The solution with one more stage, for the check.
    pub(super) finer: Solution<N, K, L>,
    /// U_t, and U_p in space, over the stream's speed, at the stations.
    pub(super) speeds: Vec<(Lanes, Vector<Lanes>)>,
    /// The solution before it was moved to another mesh.
    pub(super) before: Guess,
    pub(super) errors: Vec<f64>,
    /// r over L that each element adds, at the last round.
    pub(super) spans: Vec<[f64; Q]>,
    pub(super) breaks: Vec<f64>,
    pub(super) rounds: usize,
    pub(super) meshes: usize,
    /// The last correction, rad.
    pub(super) last: f64,
    /// Whether a path only has to lead to its end.
    pub(super) in_a_hurry: bool,
    /// Whether a round since this was last cleared took less than a whole correction.
    pub(super) damped: bool,
    /// What the last round leaves to the next (tip over L), by the way rounds fall.
    pub(super) left_over: f64,
    /// Tip position over L from the base at the last round.
    pub(super) tip: [f64; Q],
    /// The work that may be done, in evaluations of a station.
    pub(super) allowed: usize,
}

/// A solution with all that belongs to it, to come back to.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(super) solution: Guess,
    pub(super) fraction: [f64; 2],
    range_fraction: f64,
    base: [f64; 4],
    tensions: Vec<f64>,
    stroke_control: Option<StrokeControl>,
    spans: Vec<[f64; Q]>,
    pub(super) tip: [f64; Q],
    /// See [`Engine::speeds`]; of a path that did not need them, of an earlier point or none.
    pub(super) speeds: Vec<(Lanes, Vector<Lanes>)>,
}

impl Engine {
    pub(crate) fn new(arm: &Arm) -> Self {
        let methods = &*METHODS;
        Self {
            equations: Equations::new(arm, M),
            stroke_control: None,
            border: None,
            check_equations: Equations::new(arm, K).leaving(CHECKED),
            system: Collocation::with(methods.solve.clone()),
            check: Collocation::with(methods.check.clone()),
            solution: Solution::default(),
            correction: Correction::default(),
            check_correction: Correction::default(),
            finer: Solution::default(),
            speeds: Vec::new(),
            before: Solution::default(),
            errors: Vec::new(),
            spans: Vec::new(),
            breaks: arm.breaks().iter().map(|s| s / arm.length).collect(),
            rounds: 0,
            meshes: 0,
            last: 0.0,
            in_a_hurry: false,
            damped: false,
            left_over: 0.0,
            tip: [0.0; Q],
            allowed: usize::MAX,
        }
    }

    /// The solution with its equations, without what the last rounds have left: nothing that is large is copied.
    pub(super) fn without_workspace(&self) -> Self {
        let methods = &*METHODS;
        Self {
            equations: self.equations.clone(),
            stroke_control: self.stroke_control.clone(),
            border: self.border,
            check_equations: self.check_equations.without_places(),
            system: Collocation::with(methods.solve.clone()),
            check: Collocation::with(methods.check.clone()),
            solution: self.solution.clone(),
            correction: Correction::default(),
            check_correction: Correction::default(),
            finer: Solution::default(),
            speeds: Vec::new(),
            before: Solution::default(),
            errors: Vec::new(),
            spans: self.spans.clone(),
            breaks: self.breaks.clone(),
            ..*self
        }
    }

    pub(super) fn state(&self) -> State {
        State {
            solution: self.solution.clone(),
            fraction: self.equations.fraction,
            range_fraction: self.equations.range_fraction(),
            base: self.equations.base,
            tensions: self.equations.tensions.clone(),
            stroke_control: self.stroke_control.clone(),
            spans: self.spans.clone(),
            tip: self.tip,
            speeds: self.speeds.clone(),
        }
    }

    pub(super) fn restore(&mut self, state: &State) {
        let same = self.solution.mesh == state.solution.mesh;
        self.solution.clone_from(&state.solution);
        self.spans.clone_from(&state.spans);
        self.speeds.clone_from(&state.speeds);
        self.tip = state.tip;
        self.equations.fraction = state.fraction;
        if self.equations.range_fraction() != state.range_fraction {
            self.equations.set_range_fraction(state.range_fraction);
        }
        self.equations.base = state.base;
        self.stroke_control.clone_from(&state.stroke_control);
        for (cable, tension) in state.tensions.iter().enumerate() {
            self.equations.set_tension(cable, *tension);
        }
        if same {
            self.equations.place_ends(&self.solution);
        } else {
            self.equations.place_on(&self.system.gauss, &self.solution);
        }
    }

    /// What the work so far took.
    pub(super) fn statistics(&self, load_steps: usize) -> Statistics {
        Statistics {
            elements: self.solution.mesh.elements(),
            stages: M,
            newton_rounds: self.rounds,
            meshes: self.meshes,
            load_steps,
            evaluations: self.system.evaluations,
        }
    }

    /// Work done so far.
    pub(super) fn work(&self) -> usize {
        (self.system.evaluations + self.check.evaluations) * self.equations.arm().cost_factor()
    }

    /// Refuses to go on where no work is left.
    pub(super) fn may_go_on(&self) -> Result<(), Trouble> {
        if self.work() >= self.allowed { Err(Trouble::Spent) } else { Ok(()) }
    }

    /// Factorises at the present solution.
    pub(super) fn linearise(&mut self) -> Result<(), Trouble> {
        self.may_go_on()?;
        self.rounds += 1;
        Ok(linearise(&mut self.system, &self.equations, &self.solution)?)
    }

    /// Newton on the present mesh until what is left of the tip's way is below `tolerance`, by the way rounds fall.
    /// Given how close to the kinks of the load nodes have to be, they are moved there as soon as corrections are
    /// small.
    pub(super) fn iterate(&mut self, tolerance: f64, most: usize, resolution: Option<f64>) -> Result<(), Trouble> {
        let clamped = self.equations.arm().model.support == Support::Clamped;
        let most = if clamped { most } else { 60 };
        let most = if self.stroke_control.is_some() { most + MORE } else { most };
        let (mut applied, mut halvings, mut round) = (0.0, 0, 0);
        let (mut lengths, mut switches) = (StrokeRound::default(), 0);
        let mut before = f64::INFINITY;
        let mut pins = if resolution.is_some() { PINS } else { 0 };
        let mut turns = 0;
        self.match_closure();
        loop {
            self.may_go_on()?;
            match linearise(&mut self.system, &self.equations, &self.solution) {
                Ok(()) => {}
                Err(LinearisationError::Slopes(failure)) => {
                    self.halve(&lengths.tensions, &mut applied, &mut halvings, failure)?;
                    continue;
                }
                Err(singular) => return Err(singular.into()),
            }
            self.rounds += 1;
            if turns < TURNS && self.choose_sides() {
                turns += 1;
                applied = 0.0;
                continue;
            }
            round += 1;
            correct(&mut self.system, &self.solution, &mut self.correction);
            without_neutral(&self.equations, &self.system, &self.solution, &mut self.correction);
            lengths = self.hold_lengths()?;
            let size = largest_turn(&self.solution, &self.correction);
            if !size.is_finite() {
                return Err(Trouble::Singular);
            }
            applied = if size > 1.0 { 1.0 / size } else { 1.0 };
            halvings = 0;
            let moved = self.take_correction(applied).max(0.1 * size);
            self.add_tensions(&lengths.tensions, applied);
            self.damped |= applied < 1.0;
            let strained = self.correction.largest_inner();
            let whole = size.max(strained);
            let rate = if applied < 1.0 { 1.0 } else { (whole / before).min(1.0).max(10.0 * size) };
            self.left_over = (moved * rate.min(1.0)).max(LEFT_BY_STRAINS * strained * strained);
            before = whole;
            self.last = size;
            if lengths.off > STROKES.max(0.01 * tolerance) {
                self.left_over = self.left_over.max(10.0 * lengths.off);
            }
            if self.switch_taut(size, &lengths.slack) {
                switches += 1;
                if switches > MORE {
                    return Err(Trouble::Stalled(size));
                }
                before = f64::INFINITY;
                continue;
            }
            let stop = round == most || (clamped && round >= 6 && size > 3.0);
            if self.left_over <= tolerance || stop {
                return if self.left_over <= tolerance { Ok(()) } else { Err(Trouble::Stalled(size)) };
            }
            if size < SMALL
                && pins > 0
                && let Some(resolution) = resolution
            {
                pins -= 1;
                if self.pin_kinks(resolution) {
                    // The correction belongs to the mesh before.
                    applied = 0.0;
                }
            }
        }
    }

    /// Takes half of the last correction back, and of the changes of tensions that came with it, after a `failure` of
    /// its end.
    pub(super) fn halve(
        &mut self,
        tensions: &[f64],
        applied: &mut f64,
        halvings: &mut usize,
        failure: SectionFailure,
    ) -> Result<(), Trouble> {
        if *applied == 0.0 || *halvings == 8 {
            return Err(Trouble::Section(failure));
        }
        *applied *= 0.5;
        *halvings += 1;
        self.solution.add(&self.correction, -*applied);
        self.add_tensions(tensions, -*applied);
        Ok(())
    }

    /// Adds `applied` of the correction; how far the whole of it moves the tip, over L.
    pub(super) fn take_correction(&mut self, applied: f64) -> f64 {
        let d = self.correction.total;
        self.system.quadratures(&mut self.spans);
        self.tip = self.system.totals();
        for (span, change) in self.spans.iter_mut().zip(&self.correction.by_element) {
            for q in 0..Q {
                span[q] += change[q];
            }
        }
        for q in 0..Q {
            self.tip[q] += d[q];
        }
        self.solution.add(&self.correction, applied);
        dot(&d, &d).sqrt()
    }

    /// The response of the solution, at its last linearisation, to the fraction of the present phase.
    pub(super) fn response(&mut self, out: &mut Correction<N, M, Q, L>) -> Result<(), Trouble> {
        respond(&self.system, &self.change_by(Way::Path)?, out);
        Ok(())
    }

    /// The change of the equations by `way` at the last linearisation.
    pub(super) fn change_by(&self, way: Way) -> Result<Forcing<N, Q, L>, Trouble> {
        let ends = [&self.solution.nodes[0], &self.solution.nodes[self.solution.mesh.elements()]];
        let change = self.equations.change_by(way, self.system.stations(), self.system.end_stations(), ends);
        change.map_err(Trouble::Section)
    }
}

/// The largest turn (rad) of a node by a correction.
pub(super) fn largest_turn(solution: &Guess, correction: &Correction<N, M, Q, L>) -> f64 {
    let mut largest = 0.0;
    for (z, dz) in solution.nodes.iter().zip(&correction.nodes) {
        let phi = turn_of(z, dz);
        let size = dot(&phi, &phi).sqrt();
        if size.is_nan() {
            return f64::NAN;
        }
        largest = f64::max(largest, size);
    }
    largest
}
