//! Newton rounds, meshes and estimates on one arm's equations.

mod budget;
mod held;
mod kinks;
#[cfg(test)]
pub(crate) mod manufactured;
mod settle;
mod start;
mod watch;

use std::sync::LazyLock;

use hydrostat_bvp::{Collocation, Correction, Determinant, Gauss, Hermite, Mesh, RoundError, Singular, Solution};

use crate::arm::Arm;
use crate::configuration::{Statistics, Tip};
use crate::dispatch::{Work, dispatch, widest};
use crate::equilibrium::{Asked, AtPlace, Equilibrium, N, Nearness, Q, SectionFailure};
use crate::friction::Grip;
use crate::verdict::Phase;

pub(crate) use self::budget::WORK;
pub(crate) use self::held::{Pulled, Round, at_stations, pull_taut, solved};
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

/// Corrections (rad) after which kinks of the load are where they will be, but for second order.
const SMALL: f64 = 0.1;

/// Rounds of Newton after which nodes are moved onto the kinks before the next.
const PINS: usize = 2;

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
    pub(crate) equations: Equilibrium,
    pub(crate) system: Collocation<N, M, Q>,
    check_equations: Equilibrium,
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

struct Evaluate<'a, const S: usize> {
    system: &'a mut Collocation<N, S, Q>,
    equations: &'a mut Equilibrium,
    solution: &'a Solution<N, S>,
}

impl<const S: usize> Work for Evaluate<'_, S> {
    type Output = Result<(), SectionFailure>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        self.system.evaluate_with::<_, FUSED>(self.equations, self.solution)
    }
}

/// [`Collocation::evaluate`] in the processor's widest vectors.
pub(crate) fn evaluate<const S: usize>(
    system: &mut Collocation<N, S, Q>,
    equations: &mut Equilibrium,
    solution: &Solution<N, S>,
) -> Result<(), SectionFailure> {
    dispatch(Evaluate { system, equations, solution })
}

struct Factorise<'a, const S: usize> {
    system: &'a mut Collocation<N, S, Q>,
    equations: &'a mut Equilibrium,
    solution: &'a Solution<N, S>,
    parameter: bool,
}

impl<const S: usize> Work for Factorise<'_, S> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        let Self { system, equations, solution, parameter } = self;
        system.factorise_with::<_, FUSED>(equations, solution, parameter)
    }
}

/// [`Collocation::linearise`] in the processor's widest vectors.
pub(crate) fn linearise<const S: usize>(
    system: &mut Collocation<N, S, Q>,
    equations: &mut Equilibrium,
    solution: &Solution<N, S>,
    parameter: bool,
) -> Result<(), RoundError<SectionFailure>> {
    evaluate(system, equations, solution).map_err(RoundError::Slopes)?;
    dispatch(Factorise { system, equations, solution, parameter }).map_err(RoundError::Singular)
}

/// [`Collocation::solve`] in the processor's widest vectors.
pub(crate) fn solve<const S: usize>(
    system: &Collocation<N, S, Q>,
    solution: &Solution<N, S>,
    column: usize,
    correction: &mut Correction<N, S, Q>,
) {
    widest(
        #[inline(always)]
        || system.solve(solution, column, correction),
    );
}

/// How far the tip (over L) would move, to first order, if the stream's tangential load on `solution`
/// were `factor` of what it is.
pub(crate) fn shift_by_tangential_load(equations: &Equilibrium, solution: &Guess, factor: f64) -> Option<f64> {
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
    pub(crate) equations: Equilibrium,
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
            equations: Equilibrium::new(arm, &methods.solve),
            check_equations: Equilibrium::new(arm, &methods.check),
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
                let v = |k: usize| self.equations.switch(k / M, k % M, which).abs();
                v(*a).total_cmp(&v(*b))
            })
            .map(|k| self.equations.stations()[k])
    }

    /// Newton on the present mesh until the tip moves by less than `tolerance`.
    pub(crate) fn newton(&mut self, tolerance: f64, most: usize) -> Result<(), Trouble> {
        self.iterate(tolerance, most, false, None)
    }

    /// Newton until the tip moves by less than `tolerance`, or, looking `ahead`, until it would move by
    /// less in the round to come. Given how close to the kinks of the load nodes have to be, they are moved there as soon
    /// as corrections are small: a round on nodes that are off is as good as lost.
    fn iterate(&mut self, tolerance: f64, most: usize, ahead: bool, resolution: Option<f64>) -> Result<(), Trouble> {
        if self.equations.held.is_some() {
            return self.iterate_held(tolerance, most);
        }
        let clamped = self.equations.arm().readings.support == crate::Support::Clamped;
        let most = if clamped { most } else { 60 };
        let mut applied = 0.0;
        let mut halvings = 0;
        let mut round = 0;
        let mut before = 0.0;
        let mut pins = if resolution.is_some() { PINS } else { 0 };
        loop {
            self.may_go_on()?;
            match linearise(&mut self.system, &mut self.equations, &self.solution, false) {
                Ok(()) => {}
                Err(RoundError::Slopes(failure)) => {
                    if applied == 0.0 || halvings == 8 {
                        return Err(Trouble::Section(failure));
                    }
                    applied *= 0.5;
                    halvings += 1;
                    self.solution.add(&self.correction, -applied);
                    continue;
                }
                Err(singular) => return Err(singular.into()),
            }
            self.rounds += 1;
            round += 1;
            solve(&self.system, &self.solution, 0, &mut self.correction);
            let size = self.correction.largest(0);
            if !size.is_finite() {
                return Err(Trouble::Singular);
            }
            let [dx, dy] = self.correction.total;
            applied = if size > 1.0 { 1.0 / size } else { 1.0 };
            halvings = 0;
            self.solution.add(&self.correction, applied);
            let [x, y] = self.system.totals();
            let tip = [x + dx, y + dy];
            // beta'' runs a round behind: what it still moves shows from round to round.
            let drifted = if round > 1 { (tip[0] - self.tip[0]).hypot(tip[1] - self.tip[1]) } else { 0.0 };
            self.tip = tip;
            let moved = if ahead {
                // What is left falls with the square of the correction, but not below the share of beta'',
                // which is a round behind, and no faster than it was seen to fall.
                let seen = if round > 1 { size / before } else { 0.0 };
                let rate =
                    if applied < 1.0 { 1.0 } else { (10.0 * self.reached().max(size)).max(seen).clamp(0.05, 1.0) };
                dx.hypot(dy).max(0.1 * size) * rate
            } else {
                dx.hypot(dy).max(0.1 * size).max(0.1 * drifted)
            };
            before = size;
            self.last = size;
            self.rest = if ahead || tolerance <= TIGHT { moved } else { 0.0 };
            let stop = round == most || (clamped && round >= 4 && size > 3.0);
            if moved <= tolerance || stop {
                self.system.quadratures(&mut self.spans);
                for (span, change) in self.spans.iter_mut().zip(&self.correction.by_element) {
                    for q in 0..Q {
                        span[q] += change[q];
                    }
                }
                return if moved <= tolerance { Ok(()) } else { Err(Trouble::Stalled(size)) };
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

    /// The largest change of the angle within an element by the last correction.
    fn reached(&self) -> f64 {
        let mesh = &self.solution.mesh;
        let each = self.correction.slopes.iter().enumerate();
        each.fold(0.0, |m, (i, k)| k.iter().fold(m, |m, k| f64::max(m, mesh.step(i) * k[0].abs())))
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

    /// Moves the solution to another mesh.
    pub(crate) fn move_to(&mut self, mesh: Mesh) {
        std::mem::swap(&mut self.solution, &mut self.before);
        self.solution.mesh = mesh;
        self.come_from_before();
    }

    /// Carries the solution before over to the mesh of the present one.
    fn come_from_before(&mut self) {
        self.meshes += 1;
        let gauss = &self.system.gauss;
        let old = &self.before;
        old.onto(gauss, &mut self.solution);
        let mesh = &self.solution.mesh;
        self.system.stations(mesh, &mut self.stations);
        self.guesses.clear();
        let mut e = 0;
        for s in &self.stations {
            while e + 1 < old.mesh.elements() && old.mesh.nodes()[e + 1] <= *s {
                e += 1;
            }
            let w = gauss.cardinals((s - old.mesh.nodes()[e]) / old.mesh.step(e));
            let (strain, [slope, curvature]) = self.equations.remembered(e, &w);
            self.guesses.push((strain, slope, curvature));
        }
        let guesses = &self.guesses;
        self.equations.place_stations(&self.stations, mesh, |k| guesses[k]);
    }

    /// Moves the solution on by `share` times its way from the solution `before`, nodes on kinks with it. Left as it is where the
    /// two do not correspond node by node.
    pub(crate) fn lead_on(&mut self, before: &Guess, share: f64) {
        let Some(mesh) = self.solution.mesh.led_on(&before.mesh, share) else { return };
        let lead = |own: &mut [f64; N], other: &[f64; N]| {
            for a in 0..N {
                own[a] += share * (own[a] - other[a]);
            }
        };
        let Solution { nodes, slopes, .. } = &mut self.solution;
        nodes.iter_mut().zip(&before.nodes).for_each(|(own, other)| lead(own, other));
        slopes.iter_mut().flatten().zip(before.slopes.iter().flatten()).for_each(|(own, other)| lead(own, other));
        if mesh == self.solution.mesh {
            return;
        }
        self.foresee();
        let remembered = (0..self.stations.len()).map(|k| self.equations.station_guess(k));
        self.guesses.clear();
        self.guesses.extend(remembered);
        self.solution.mesh = mesh;
        self.system.stations(&self.solution.mesh, &mut self.stations);
        let guesses = &self.guesses;
        self.equations.place_stations(&self.stations, &self.solution.mesh, |k| guesses[k]);
    }

    /// Brings what is remembered at the stations up to the solution, to first order.
    pub(crate) fn foresee(&mut self) {
        let (system, equations, solution) = (&mut self.system, &mut self.equations, &self.solution);
        widest(
            #[inline(always)]
            || equations.foresee(system.take_states(solution)),
        );
    }

    /// Whether something pushes against the arm hard enough that a direct solve may have landed on a
    /// branch that the path does not lead to. Cheap and on the safe side.
    pub(crate) fn may_have_left_the_branch(&self) -> bool {
        if self.equations.arm().readings.support == crate::Support::UnstrainedBase {
            // An initial-value problem has one solution.
            return false;
        }
        if self.system.determinant().sign <= 0.0 {
            return true;
        }
        let base = self.equations.arm().base.angle;
        let mut reference_angle = base;
        let mesh = &self.solution.mesh;
        for i in 0..mesh.elements() {
            for j in 0..M {
                let k = i * M + j;
                let s = self.equations.stations()[k];
                let z = self.system.state(i, j);
                let mu = self.equations.reference_strain(k)[2];
                reference_angle += mesh.step(i) * self.system.gauss.b[j] * mu;
                if self.equations.adversity(k, s, z, reference_angle) > 0.3 {
                    return true;
                }
            }
        }
        false
    }

    /// Whether any of the arm is nearly in line with a load.
    pub(crate) fn is_in_line(&self) -> bool {
        (0..self.equations.stations().len()).any(|k| self.equations.is_in_line(k, self.system.state(k / M, k % M)[0]))
    }

    /// Changes loads of the arm in place.
    pub(crate) fn change_loads(&mut self, change: impl Fn(&mut Arm)) {
        self.equations.change_loads(&change);
        self.check_equations.change_loads(&change);
    }

    /// [`Engine::set_loads`] of an arm that differs in tensions, stream, weight and tip loads only.
    pub(crate) fn take_loads(&mut self, arm: &Arm) {
        let own = self.equations.arm();
        if own.gravity != arm.gravity || own.flow.density != arm.flow.density {
            self.set_loads(arm);
            return;
        }
        self.change_loads(|own| {
            for (own, cable) in own.cables.iter_mut().zip(&arm.cables) {
                own.tension = cable.tension;
                own.max_tension = cable.max_tension;
            }
            own.flow.clone_from(&arm.flow);
            own.tip.clone_from(&arm.tip);
        });
    }

    /// Takes other tensions, stream or loads for the same arm.
    pub(crate) fn set_loads(&mut self, arm: &Arm) {
        self.equations.set_loads(arm);
        self.check_equations.set_loads(arm);
    }

    /// Ends a path: `arm` stays, with all angles less by whole turns of the size `angle`.
    pub(crate) fn hold(&mut self, arm: &Arm, angle: f64) {
        self.equations.hold(arm, angle);
        self.check_equations.hold(arm, angle);
        for z in &mut self.solution.nodes {
            z[0] -= angle;
        }
    }

    /// What friction leaves of the tensions from now on.
    pub(crate) fn set_grip(&mut self, grip: Option<&Grip>) {
        self.equations.set_grip(grip);
        self.check_equations.set_grip(grip);
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
