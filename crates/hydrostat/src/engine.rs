//! Newton rounds, meshes and estimates on one arm's equations.

mod budget;
mod carry_over;
mod held;
mod kinks;
mod loads;
#[cfg(test)]
pub(crate) mod manufactured;
mod newton;
mod rounds;
mod settle;
mod start;
mod watch;

use std::sync::LazyLock;

use hydrostat_bvp::{Collocation, Correction, Determinant, Gauss, Hermite, Mesh, RoundError, Solution};

use crate::arm::Arm;
use crate::configuration::{Statistics, Tip};
use crate::dispatch::widest;
use crate::equilibrium::{Asked, AtPlace, Equations, N, Nearness, Q, SectionFailure};
use crate::verdict::Phase;

pub(crate) use self::budget::WORK;
pub(crate) use self::held::{Round, UnitPull, at_stations, pull_taut};
pub(crate) use self::rounds::{evaluate, linearise, solve};
pub(crate) use self::settle::First;

/// Stages of the solve, and of the check that estimates its error.
pub(crate) const M: usize = 4;
const K: usize = M + 1;

/// A tolerance down to which what Newton leaves is foreseen well enough not to wait for it.
const TIGHT: f64 = 1e-9;

pub(crate) type Guess = Solution<N, M>;

#[derive(Debug, Clone)]
pub(crate) enum Trouble {
    Section(SectionFailure),
    Singular,
    Stalled(f64),
    Mesh,
    /// The work that was allowed is done.
    Spent,
}

impl From<RoundError<SectionFailure>> for Trouble {
    fn from(error: RoundError<SectionFailure>) -> Self {
        match error {
            RoundError::Slopes(failure) => Self::Section(failure),
            RoundError::Singular(_) => Self::Singular,
        }
    }
}

/// Corrections (rad) that may go on hopping across a kink of the load.
pub(crate) const HOP: f64 = 1e-4;

/// Newton along a path, where hopping across a kink is good enough.
pub(crate) fn roughly(result: Result<(), Trouble>) -> Result<(), Trouble> {
    match result {
        Err(Trouble::Stalled(size)) if size <= HOP => Ok(()),
        other => other,
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Engine {
    pub(crate) equations: Equations,
    pub(crate) system: Collocation<N, M, Q>,
    check_equations: Equations,
    check: Collocation<N, K, Q>,
    pub(crate) solution: Solution<N, M>,
    correction: Correction<N, M, Q>,
    check_correction: Correction<N, K, Q>,
    /// The solution with one more stage, for the check.
    finer: Solution<N, K>,
    stations: Vec<f64>,
    check_stations: Vec<f64>,
    guesses: Vec<SectionGuess>,
    /// The kinks that were found last.
    found: Vec<f64>,
    /// The solution before it was moved to another mesh.
    before: Solution<N, M>,
    errors: Vec<f64>,
    /// x, y over L that each element adds, at the last round.
    pub(crate) spans: Vec<[f64; Q]>,
    breaks: Vec<f64>,
    pub(crate) rounds: usize,
    pub(crate) meshes: usize,
    pub(crate) last: f64,
    /// Whether a path is followed, which has more to lose from an estimate that is off by what beta' lags behind: an arm in
    /// line with the stream is led by angles of its size.
    pub(crate) on_a_path: bool,
    /// Whether such a path only has to lead to its end.
    pub(crate) in_a_hurry: bool,
    /// What the last round moved the tip by (over L), or would have where Newton stopped ahead of it.
    rest: f64,
    /// Tip position over L at the last round.
    pub(crate) tip: [f64; Q],
    /// The part of unknown tensions in the determinant of the last round.
    border: Determinant,
    /// The work that may be done, see `budget`.
    allowed: usize,
    /// The part of it that other engines did.
    done_beside: usize,
}

/// Strains, beta' and beta'' at a station to be.
pub(crate) type SectionGuess = ([f64; 3], f64, f64);

/// The methods of solve and check, and the weights that take the stages of one to those of the other.
#[derive(Debug)]
struct Methods {
    solve: Gauss<M>,
    check: Gauss<K>,
    values: [[f64; M]; K],
    sharp: [Hermite<M>; K],
}

static METHODS: LazyLock<Methods> = LazyLock::new(|| {
    let (solve, check) = (Gauss::<M>::new(), Gauss::<K>::new());
    let values = check.c.map(|x| solve.cardinals(x));
    let sharp = check.c.map(|x| solve.hermite_at(x));
    Methods { solve, check, values, sharp }
});

/// How far the tip (over L) would move, to first order, if the stream's tangential load on `solution`
/// were `factor` of what it is.
pub(crate) fn shift_by_tangential_load(equations: &Equations, solution: &Guess, factor: f64) -> Option<f64> {
    let (mut equations, mut system, mut correction) = (equations.clone(), Collocation::new(), Correction::default());
    equations.set_tangential_factor(factor);
    linearise(&mut system, &mut equations, solution, false).ok()?;
    solve(&system, solution, 0, &mut correction);
    Some(correction.total[0].hypot(correction.total[1]))
}

/// A solution with all that belongs to it, to come back to.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) solution: Guess,
    pub(crate) equations: Equations,
    spans: Vec<[f64; Q]>,
    pub(crate) tip: [f64; Q],
}

impl Engine {
    pub(crate) fn state(&self) -> State {
        State {
            solution: self.solution.clone(),
            equations: self.equations.clone(),
            spans: self.spans.clone(),
            tip: self.tip,
        }
    }

    pub(crate) fn restore(&mut self, state: &State) {
        self.solution.clone_from(&state.solution);
        let (evaluations, work) = (self.equations.evaluations, self.equations.work);
        self.equations.clone_from(&state.equations);
        // What was done stays done.
        (self.equations.evaluations, self.equations.work) = (evaluations, work);
        self.spans.clone_from(&state.spans);
        self.tip = state.tip;
        // Friction belongs to the shape, and the check is of the same arm.
        if self.equations.grip.is_some() || self.check_equations.grip.is_some() {
            self.check_equations.set_grip(self.equations.grip.as_ref());
        }
    }

    /// theta at the tip, rad.
    pub(crate) fn tip_angle(&self) -> f64 {
        self.solution.nodes.last().map_or(0.0, |z| z[0])
    }

    /// What the work so far took.
    pub(crate) fn statistics(&self, load_steps: usize) -> Statistics {
        Statistics {
            elements: self.solution.mesh.elements(),
            stages: M,
            newton_rounds: self.rounds,
            meshes: self.meshes,
            load_steps,
            evaluations: self.equations.evaluations,
        }
    }

    pub(crate) fn new(arm: &Arm) -> Self {
        let methods = &*METHODS;
        let breaks: Vec<f64> = arm.breaks().iter().map(|s| s / arm.length).collect();
        Self {
            equations: Equations::new(arm, &methods.solve),
            check_equations: Equations::new(arm, &methods.check),
            system: Collocation::with(methods.solve.clone()),
            check: Collocation::with(methods.check.clone()),
            solution: Solution::constant(Mesh::uniform(1, &[]), [0.0; N]),
            correction: Correction::default(),
            check_correction: Correction::default(),
            finer: Solution::constant(Mesh::uniform(1, &[]), [0.0; N]),
            stations: Vec::new(),
            check_stations: Vec::new(),
            guesses: Vec::new(),
            found: Vec::new(),
            before: Solution::constant(Mesh::uniform(1, &[]), [0.0; N]),
            errors: Vec::new(),
            spans: Vec::new(),
            breaks,
            rounds: 0,
            meshes: 0,
            last: 0.0,
            rest: 0.0,
            on_a_path: false,
            in_a_hurry: false,
            tip: [0.0; 2],
            border: Determinant { sign: 1.0, log: 0.0 },
            allowed: usize::MAX,
            done_beside: 0,
        }
    }

    /// The section at an end, which is no station.
    fn at_end(&self, tip: bool) -> Result<AtPlace, SectionFailure> {
        let n = self.solution.mesh.elements();
        let (node, nearest) = if tip { (n, n * M - 1) } else { (0, 0) };
        self.beside_node(node, tip).or_else(|_| {
            let asked = self.asked_beside(node, tip);
            self.equations.at_place(&Asked { strain: self.equations.strain(nearest), ..asked })
        })
    }

    /// Where the tip is, after Newton has converged.
    pub(crate) fn read_tip(&self) -> Result<Tip, SectionFailure> {
        let [nu, eta, _] = self.at_end(true)?.strain;
        let (base, length) = (self.equations.arm().base, self.equations.units.length);
        let [x, y] = self.tip;
        Ok(Tip { x: base.x + length * x, y: base.y + length * y, theta: self.tip_angle(), alpha: eta.atan2(nu) })
    }

    /// Whether the section law has strains at both ends.
    pub(crate) fn ends_fine(&self) -> Result<(), Trouble> {
        self.at_end(false).and_then(|_| self.at_end(true)).map(|_| ()).map_err(Trouble::Section)
    }

    /// How near the limits of the section law stations and ends are.
    pub(crate) fn nearest_limits(&mut self) -> Nearness {
        let _ = self.refresh();
        let mut near = self.equations.nearness;
        for (tip, s) in [(false, 0.0), (true, 1.0)] {
            if let Ok(end) = self.at_end(tip) {
                near.note(s, end.openness, end.strain[0], end.regularity);
            }
        }
        near
    }

    /// Where the switch of the load that can jump is nearest to its jump.
    pub(crate) fn nearest_switch(&self) -> Option<f64> {
        let which = if self.equations.arm().readings.flow_surface == crate::FlowSurface::Lateral { 2 } else { 0 };
        (0..self.equations.stations().len())
            .min_by(|a, b| {
                let distance = |k: usize| self.equations.switch(k / M, k % M, which).abs();
                distance(*a).total_cmp(&distance(*b))
            })
            .map(|k| self.equations.stations()[k])
    }

    /// Factorises at the present solution.
    pub(crate) fn linearise(&mut self, parameter: bool) -> Result<(), Trouble> {
        self.may_go_on()?;
        self.rounds += 1;
        Ok(linearise(&mut self.system, &mut self.equations, &self.solution, parameter)?)
    }

    /// Brings stages, strains and switches up to date with the solution.
    pub(crate) fn refresh(&mut self) -> Result<(), SectionFailure> {
        evaluate(&mut self.system, &mut self.equations, &self.solution)
    }

    /// What each element adds to the tip's position, of a solution that Newton left on another mesh.
    pub(crate) fn measure(&mut self) -> Result<(), SectionFailure> {
        self.refresh()?;
        self.system.quadratures(&mut self.spans);
        self.tip = self.system.totals();
        Ok(())
    }

    /// Brings what is remembered at the stations up to the solution, to first order.
    pub(crate) fn foresee(&mut self) {
        let (system, equations, solution) = (&mut self.system, &mut self.equations, &self.solution);
        widest(
            #[inline(always)]
            || equations.foresee(system.take_states(solution)),
        );
    }

    /// The section on either side of node `i`.
    pub(crate) fn beside_node(&self, i: usize, left: bool) -> Result<AtPlace, SectionFailure> {
        self.equations.at_place(&self.asked_beside(i, left))
    }

    pub(crate) fn asked_beside(&self, i: usize, left: bool) -> Asked {
        let (element, x) = if left { (i - 1, 1.0) } else { (i, 0.0) };
        let gauss = &self.system.gauss;
        let (strain, beta) =
            self.equations.remembered_sharply(element, &gauss.cardinals(x), &gauss.ends[usize::from(left)]);
        Asked { s: self.solution.mesh.nodes()[i], from_left: left, z: self.solution.nodes[i], strain, beta }
    }

    pub(crate) fn reset_statistics(&mut self) {
        self.rounds = 0;
        self.meshes = 0;
        self.equations.evaluations = 0;
    }

    pub(crate) fn set_phase(&mut self, phase: Phase, fraction: f64) {
        self.equations.set_phase(phase, fraction);
    }
}
