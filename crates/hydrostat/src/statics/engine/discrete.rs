//! One arm's equations on a mesh: the solution, its linearisation, and what is read off it.

use std::sync::LazyLock;

use hydrostat_bvp::{Collocation, Correction, Determinant, Gauss, Lanes, Resampling, Solution};

use super::outputs::{asked_in, sharpened};
use super::trouble::Trouble;
use crate::numerics::rounds::{correct, evaluate, linearise, respond};
use crate::rod::arm::Arm;
use crate::statics::dimensions::{Guess, K, L, M, N, Q};
use crate::statics::equations::{Equations, Margins, SectionFailure, SectionQuery, SectionState, StationData, Way};
use crate::statics::phase::Phase;
use crate::statics::refinement::Refinable as _;
use crate::statics::shape::{Statistics, Tip};

/// Steps of the section law that the check leaves: its one round has to take up their squares.
const CHECKED: f64 = 1e-5;

#[derive(Debug, Clone)]
pub(crate) struct Engine {
    pub(crate) equations: Equations,
    pub(crate) system: Collocation<N, M, Q, L>,
    pub(super) check_equations: Equations,
    pub(super) check: Collocation<N, K, Q, L>,
    pub(crate) solution: Solution<N, M, L>,
    pub(super) correction: Correction<N, M, Q, L>,
    pub(super) check_correction: Correction<N, K, Q, L>,
    /// The solution with one more stage, for the check.
    pub(super) finer: Solution<N, K, L>,
    /// The kinks that were found last.
    pub(super) found: Vec<f64>,
    /// Speeds whose change of sign kinks the load, at the stations.
    pub(super) switches: Vec<[Lanes; 3]>,
    /// The solution before it was moved to another mesh.
    pub(super) before: Solution<N, M, L>,
    pub(super) errors: Vec<f64>,
    /// x, y over L that each element adds, at the last round.
    pub(crate) spans: Vec<[f64; Q]>,
    pub(super) breaks: Vec<f64>,
    pub(crate) rounds: usize,
    pub(crate) meshes: usize,
    pub(crate) last: f64,
    /// What the last round leaves to the next (tip over L), by the way rounds fall.
    pub(super) left_over: f64,
    /// Whether a path only has to lead to its end.
    pub(crate) in_a_hurry: bool,
    /// Tip position over L at the last round.
    pub(crate) tip: [f64; Q],
    /// The part of unknown tensions in the determinant of the last round.
    pub(super) border: Determinant,
    /// The work that may be done, see `budget`.
    pub(super) allowed: usize,
    /// The part of it that other engines did.
    pub(super) done_beside: usize,
    /// Evaluations before the work that counts, and before those of the statistics.
    pub(super) worked_from: usize,
    pub(super) counted_from: usize,
}

/// The methods of solve and check.
#[derive(Debug)]
pub(super) struct Methods {
    pub(super) solve: Gauss<M>,
    pub(super) check: Gauss<K>,
    pub(super) to_check: Resampling<M, K>,
}

pub(super) static METHODS: LazyLock<Methods> = LazyLock::new(|| {
    let (solve, check) = (Gauss::new(), Gauss::new());
    let to_check = Resampling::new(&solve, &check);
    Methods { solve, check, to_check }
});

/// How far the tip (over L) would move, to first order, if the stream's tangential load on `solution`
/// were `factor` of what it is.
pub(crate) fn shift_by_tangential_load(equations: &Equations, solution: &Guess, factor: f64) -> Option<f64> {
    let (mut equations, mut system, mut correction) = (equations.clone(), Collocation::new(), Correction::default());
    equations.set_tangential_factor(factor);
    linearise(&mut system, &equations, solution).ok()?;
    correct(&mut system, solution, &mut correction);
    Some(correction.total[0].hypot(correction.total[1]))
}

/// A solution with all that belongs to it, to come back to.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) solution: Guess,
    pub(crate) equations: Equations,
    spans: Vec<[f64; Q]>,
    pub(crate) tip: [f64; Q],
    switches: Vec<[Lanes; 3]>,
}

impl State {
    /// Switch `which` of the load at stage `j` of element `i`, see [`Engine::take_switches`].
    pub(crate) fn switch(&self, i: usize, j: usize, which: usize) -> f64 {
        let (block, lane) = self.solution.groups().at(i, j);
        self.switches[block][which].0[lane]
    }
}

impl Engine {
    pub(crate) fn state(&self) -> State {
        State {
            solution: self.solution.clone(),
            equations: self.equations.clone(),
            spans: self.spans.clone(),
            tip: self.tip,
            switches: self.switches.clone(),
        }
    }

    pub(crate) fn restore(&mut self, state: &State) {
        self.solution.clone_from(&state.solution);
        self.equations.clone_from(&state.equations);
        self.spans.clone_from(&state.spans);
        self.switches.clone_from(&state.switches);
        self.tip = state.tip;
        // Friction belongs to the shape, and the check is of the same arm.
        if self.equations.capstan.is_some() || self.check_equations.capstan.is_some() {
            self.check_equations.set_capstan(self.equations.capstan.as_ref());
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
            evaluations: self.system.evaluations - self.counted_from,
        }
    }

    pub(crate) fn new(arm: &Arm) -> Self {
        let methods = &*METHODS;
        let breaks: Vec<f64> = arm.breaks().iter().map(|s| s / arm.length).collect();
        Self {
            equations: Equations::new(arm, M),
            check_equations: Equations::new(arm, K).leaving(CHECKED),
            system: Collocation::with(methods.solve.clone()),
            check: Collocation::with(methods.check.clone()),
            solution: Solution::default(),
            correction: Correction::default(),
            check_correction: Correction::default(),
            finer: Solution::default(),
            found: Vec::new(),
            switches: Vec::new(),
            before: Solution::default(),
            errors: Vec::new(),
            spans: Vec::new(),
            breaks,
            rounds: 0,
            meshes: 0,
            last: 0.0,
            left_over: 0.0,
            in_a_hurry: false,
            tip: [0.0; 2],
            border: Determinant::ONE,
            allowed: usize::MAX,
            done_beside: 0,
            worked_from: 0,
            counted_from: 0,
        }
    }

    /// The section at an end, which is no station.
    pub(super) fn at_end(&self, tip: bool) -> Result<SectionState, SectionFailure> {
        let n = self.solution.mesh.elements();
        let (node, nearest) = if tip { (n, n * M - 1) } else { (0, 0) };
        self.beside_node(node, tip).or_else(|_| {
            let asked = self.asked_beside(node, tip);
            self.equations
                .at_place(&SectionQuery { strain: self.solution.inner(nearest / M, nearest % M).inner, ..asked })
        })
    }

    /// Where the tip is, after Newton has converged.
    pub(crate) fn read_tip(&self) -> Result<Tip, SectionFailure> {
        let here = self.at_end(true)?;
        let [nu, eta, _] = self.sharp_beside(self.solution.mesh.elements(), true, &here)?.strain;
        let (base, length) = (self.equations.arm().base, self.equations.units.length);
        let [x, y] = self.tip;
        Ok(Tip { x: base.x + length * x, y: base.y + length * y, theta: self.tip_angle(), alpha: eta.atan2(nu) })
    }

    /// Whether the section law has strains at both ends.
    pub(crate) fn check_ends(&self) -> Result<(), Trouble> {
        self.at_end(false).and_then(|_| self.at_end(true)).map(|_| ()).map_err(Trouble::Section)
    }

    /// How near the limits of the section law stations and ends are.
    pub(crate) fn margins_to_limits(&mut self) -> Margins {
        self.system.take_stations(&self.solution);
        let mut near = self.equations.margins(self.system.stations());
        for (tip, s) in [(false, 0.0), (true, 1.0)] {
            if let Ok(end) = self.at_end(tip) {
                near.note(s, end.openness, end.strain[0], end.regularity);
            }
        }
        near
    }

    /// Brings the stations and the load's switches there up to date with the solution.
    pub(crate) fn take_switches(&mut self) {
        self.system.take_stations(&self.solution);
        let stations = self.system.stations().iter().enumerate();
        self.switches.clear();
        self.switches.extend(stations.map(|(block, station)| self.equations.switches(block, station)));
    }

    /// Switch `which` of the load at stage `j` of element `i`.
    pub(crate) fn switch(&self, i: usize, j: usize, which: usize) -> f64 {
        let (block, lane) = self.solution.groups().at(i, j);
        self.switches[block][which].0[lane]
    }

    /// Where the switch of the load that can jump is nearest to its jump.
    pub(crate) fn nearest_switch(&mut self) -> Option<f64> {
        self.take_switches();
        let which = if self.equations.arm().model.flow_surface == crate::FlowSurface::Lateral { 2 } else { 0 };
        (0..self.equations.stations().len())
            .min_by(|a, b| {
                let distance = |k: usize| self.switch(k / M, k % M, which).abs();
                distance(*a).total_cmp(&distance(*b))
            })
            .map(|k| self.equations.stations()[k])
    }

    /// Factorises at the present solution.
    pub(crate) fn linearise(&mut self) -> Result<(), Trouble> {
        self.may_go_on()?;
        self.rounds += 1;
        Ok(linearise(&mut self.system, &self.equations, &self.solution)?)
    }

    /// The sign of the determinant at the present solution, where neither rounding nor the mesh decides it: what it is
    /// the difference of is known better than that, and on halves of the elements it is the same. The tail of a rod
    /// that lies in the stream is free to turn, to first order: the load along it turns with it, and that across it is
    /// of second order. The determinant is next to nothing then, and of either sign.
    pub(crate) fn sure_sign(&mut self) -> Option<f64> {
        /// What a mesh that is good to 1e-8 leaves of a determinant, with two digits to spare.
        const BY_MESH: f64 = 1e-6;
        let determinant = self.system.determinant();
        let here = determinant.known_sign().filter(|_| determinant.clearance > BY_MESH)?;
        let there = self.on_halves(1e-9, |halves| Ok(halves.system.determinant().known_sign()));
        let back = self.linearise();
        (there.is_ok_and(|sign| sign == Some(here)) && back.is_ok()).then_some(here)
    }

    /// The response of the solution at the last linearisation to a change of what is given.
    pub(crate) fn response(&self, way: Way, out: &mut Correction<N, M, Q, L>) {
        let change = response_change(&self.equations, &self.system, &self.solution, way);
        respond(&self.system, &change, out);
    }

    /// A system with the stations of the present solution.
    pub(crate) fn at_present(&self) -> Collocation<N, M, Q, L> {
        let mut system = Collocation::with(self.system.gauss.clone());
        system.take_stations(&self.solution);
        system
    }

    /// The strokes that are commanded of cables for the present solution, over L.
    pub(crate) fn strokes(&self, cables: impl Iterator<Item = usize>) -> Vec<f64> {
        let system = self.at_present();
        cables.map(|c| self.equations.stroke(c, StationData::of(&system))[0]).collect()
    }

    /// Evaluates the equations at the present solution.
    pub(crate) fn refresh(&mut self) -> Result<(), SectionFailure> {
        evaluate(&mut self.system, &self.equations, &self.solution)
    }

    /// What each element adds to the tip's position, of a solution that Newton left on another mesh.
    pub(crate) fn measure(&mut self) -> Result<(), SectionFailure> {
        self.refresh()?;
        self.system.quadratures(&mut self.spans);
        self.tip = self.system.totals();
        Ok(())
    }

    /// The section on either side of node `i`.
    pub(crate) fn beside_node(&self, i: usize, left: bool) -> Result<SectionState, SectionFailure> {
        self.equations.at_place(&self.asked_beside(i, left))
    }

    /// The same with beta' as outputs have it, or as it is where the section has no strains with that.
    pub(crate) fn sharp_beside_node(&self, i: usize, left: bool) -> Result<SectionState, SectionFailure> {
        let here = self.beside_node(i, left)?;
        Ok(self.sharp_beside(i, left, &here).unwrap_or(here))
    }

    /// The section on either side of node `i` with beta' as outputs have it, given that with the beta' of the
    /// polynomial.
    pub(super) fn sharp_beside(
        &self,
        i: usize,
        left: bool,
        here: &SectionState,
    ) -> Result<SectionState, SectionFailure> {
        let end = if left { (i - 1, 1.0) } else { (i, 0.0) };
        let asked = self.asked_beside(i, left);
        self.equations.at_place(&sharpened(&self.equations, &self.solution, &self.system.gauss, end, asked, here))
    }

    pub(crate) fn asked_beside(&self, i: usize, left: bool) -> SectionQuery {
        let (element, x) = if left { (i - 1, 1.0) } else { (i, 0.0) };
        asked_in(&self.solution, &self.system.gauss, element, x, self.solution.nodes[i])
    }

    pub(crate) fn reset_statistics(&mut self) {
        self.rounds = 0;
        self.meshes = 0;
        self.counted_from = self.system.evaluations;
    }

    pub(crate) fn set_phase(&mut self, phase: Phase, fraction: f64) {
        self.equations.set_phase(phase, fraction);
    }
}

/// The change of the equations by `way` at the last linearisation of `system`.
pub(crate) fn response_change(
    equations: &Equations,
    system: &Collocation<N, M, Q, L>,
    solution: &Guess,
    way: Way,
) -> hydrostat_bvp::Forcing<N, Q, L> {
    let ends = [&solution.nodes[0], &solution.nodes[solution.mesh.elements()]];
    equations.change_by(way, system.stations(), system.locals(), system.end_stations(), ends)
}
