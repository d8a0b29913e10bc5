//! Newton's method on the boundary-value problem of one stage.

use std::fmt::Debug;

use hydrostat_bvp::{
    Collocation, Correction, Forcing, Gauss, Lanes, LinearisationError, Mesh, Problem, Real, Side, Solution,
};

use super::border::Border;
use super::error::MotionError;
use super::history::{History, Layout, Snapshot};
use super::inputs::Inputs;
use super::works::{Carried, WORKS};
use crate::numerics::rounds::{correct, linearise, respond, simplify};
use crate::rod::arm::Arm;
use crate::statics::dimensions::{M, Units};
use crate::statics::engine::wanted_side;
use crate::statics::equations::{SectionFailure, StrokeControl};

/// Rounds of one solve.
const MOST: usize = 20;

/// Solves that are kept: those of a step that fails, and the last three before it.
const KEPT: usize = 8;

/// Solves through which the motion is extrapolated: more do not predict better.
const THROUGH: usize = 3;

/// What strokes may be off by, over L.
const STROKES: f64 = 1e-9;

/// What rounds with kept factors leave of the correction before, at most: else new factors are worth their cost.
const SLOW: f64 = 0.1;

/// Changes of the set of taut cables that one solve may make.
const SWITCHES: usize = 12;

/// Changes of own ends that one solve may make.
const TURNS: usize = 2;

/// Why a stage was not solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Unsolved {
    Section(SectionFailure),
    Singular,
    Stalled,
}

/// The boundary-value problem of one stage in time with `S` states and `L` strains, in the plane or in space, and what
/// is read of its solutions.
pub(super) trait Moves<const S: usize, const L: usize>:
    Problem<S, 0, L, Failure = SectionFailure> + Clone
{
    /// Coordinates of a station that turn it, and those of its place.
    const COORDINATES: [usize; 2];

    /// Which components of n_f and m_f, three each, there are.
    const CARRIED: &'static [usize];

    /// The strains in a block of stations, which strokes follow from.
    type Strained: Clone + Debug;

    /// Refuses what cannot move; else at rest in the equilibrium of `arm`.
    fn start(arm: &Arm, elements: Option<usize>, tol: f64, time: f64) -> Result<Settling<Self, S, L>, MotionError>;

    /// The sizes of the states where those of place are 1/k, see `scales`.
    fn sizes(k: f64) -> [f64; S];

    /// What a solution holds, times these, is the state. With k^4 = mass cv^2 and the sizes 1 of angles, k^2 of forces,
    /// k of moments, 1/k of places all states of a bending wave that a step resolves are of one size, and elimination
    /// in order is stable.
    fn scales(&self) -> &[f64; S];

    /// Takes d rate / d value (1/s) and the sizes of the states.
    fn set_rate(&mut self, cv: f64, scales: [f64; S]);

    /// The arm with the loads and tensions of the last solve.
    fn arm(&self) -> &Arm;
    fn units(&self) -> Units;

    /// Mass per length at the base with the water there, in the unit of force s2/L.
    fn mass(&self) -> f64;

    fn place_on(&mut self, gauss: &Gauss<M>, solution: &Solution<S, M, L>);
    fn place_ends(&mut self, solution: &Solution<S, M, L>);
    fn jumps_at(&self, s: f64) -> bool;
    fn set_end_rates(&mut self, gauss: &Gauss<M>);
    fn layout(&self) -> Layout;
    fn history_mut(&mut self) -> &mut History;

    /// The largest angle (rad) and change of place (over L) of a correction.
    fn largest(&self, correction: &Correction<S, M, 0, L>) -> [f64; 2];

    /// How much of the velocity of the water against the tip a change of place (over L) is, by the last history; zero
    /// in a vacuum.
    fn drag_change(&self) -> f64;

    /// Takes the loads of `arm`, which has the same sections, just before `time`.
    fn take_loads(&mut self, arm: &Arm, inputs: &Inputs, time: f64);

    /// The time in which the arm swings, about, s.
    fn time_unit(&self) -> f64 {
        let mass = self.mass();
        if mass > 0.0 { mass.sqrt() } else { 1.0 }
    }

    /// At rest in a solution; `system` is for its memory.
    fn at_rest(&self, system: &mut Collocation<S, M, 0, L>, solution: &Solution<S, M, L>) -> Snapshot {
        let mut out = Snapshot::at_rest(self.layout());
        self.read(system, solution, &mut out);
        out
    }

    /// Takes where a step starts from.
    fn start_step(&mut self, _now: &Snapshot) {}

    /// The motion that ends a step as the start of the next one.
    fn restarted(&self, now: &Snapshot, out: &mut Snapshot) {
        out.clone_from(now);
    }

    /// Takes the values of a solution; `system` is for its memory.
    fn read(&self, system: &mut Collocation<S, M, 0, L>, solution: &Solution<S, M, L>, out: &mut Snapshot);

    /// n_f and m_f at a node of a solution, in the unit of force.
    fn carried_at(&self, solution: &Solution<S, M, L>, node: usize) -> Carried;

    /// In the shape that a motion of `arm` has on this mesh, where the nodes carry about this much (in the unit of
    /// force). The cables have the tensions of `arm`.
    fn in_shape(arm: &Arm, at: &Snapshot, carried: &[Carried], mesh: Mesh) -> Settling<Self, S, L>;

    /// Whether the base of `arm` is where a motion has it.
    fn is_based(arm: &Arm, at: &Snapshot) -> bool;

    /// Where an error of a section's turn counts by itself, the radius (over L) in a block of stages by which it does:
    /// in space the surface is to be known as well as the centreline, which stays where it is as the arm twists.
    fn radius(&self, block: usize) -> Option<Lanes>;

    /// The powers (in the unit of force times L/s) in the motion `at`, which `system` was linearised at and whose base
    /// carries `base`.
    fn powers(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot, base: Carried) -> [f64; WORKS];

    /// Kinetic energy and that of strain (in the unit of force times L) in the motion `at`.
    fn energies(&self, system: &Collocation<S, M, 0, L>, at: &Snapshot) -> [f64; 2];

    /// The smallest margin against folds of the surface in the motion `at`, and where over L: at or below zero the
    /// surface folds.
    fn fold_margin(&self, at: &Snapshot) -> [f64; 2];

    /// The cables whose stroke is commanded.
    fn stroke_control(&self) -> Option<&StrokeControl>;
    fn stroke_control_mut(&mut self) -> Option<&mut StrokeControl>;

    /// Changes the tension (N) of a cable.
    fn set_tension(&mut self, cable: usize, tension: f64);

    /// Stroke that is commanded of held cable `index` now, over L.
    fn command(&self, stroke_control: &StrokeControl, index: usize) -> f64;

    /// The strains that `system` was linearised at.
    fn strained(&self, system: &Collocation<S, M, 0, L>, out: &mut Vec<Self::Strained>);

    /// Unstretched stroke of a cable, over L, and its derivative by the tension (in the unit of force).
    fn stroke(&self, cable: usize, system: &Collocation<S, M, 0, L>, strained: &[Self::Strained]) -> [f64; 2];

    /// Change of that stroke with a correction, at fixed tension.
    fn stroke_change(
        &self,
        cable: usize,
        system: &Collocation<S, M, 0, L>,
        strained: &[Self::Strained],
        correction: &Correction<S, M, 0, L>,
    ) -> f64;

    /// What changes with a unit of the tension of a cable (in the unit of force), into `out`.
    fn pull_by(&self, cable: usize, system: &Collocation<S, M, 0, L>, out: &mut Forcing<S, 0, L>);
}

/// The solver of stages: the last solution, and those before it.
#[derive(Debug, Clone)]
pub(super) struct Settling<P: Moves<S, L>, const S: usize, const L: usize> {
    pub(super) moving: P,
    pub(super) system: Collocation<S, M, 0, L>,
    pub(super) solution: Solution<S, M, L>,
    pub(super) correction: Correction<S, M, 0, L>,
    pub(super) border: Border<P::Strained, S, L>,
    /// The last solves, the latest last, with their times.
    past: Vec<(f64, Solution<S, M, L>)>,
    spare: Solution<S, M, L>,
    /// Whether the factors of the system serve the next round: they are of this step and of these own ends.
    factors: bool,
    /// Rounds so far, and solves.
    pub(super) rounds: usize,
    pub(super) solves: usize,
}

impl<P: Moves<S, L>, const S: usize, const L: usize> Settling<P, S, L> {
    pub(super) fn of(moving: P) -> Self {
        Self {
            moving,
            system: Collocation::new().balanced(),
            solution: Solution::default(),
            correction: Correction::default(),
            border: Border::default(),
            past: Vec::new(),
            spare: Solution::default(),
            factors: false,
            rounds: 0,
            solves: 0,
        }
    }

    /// Linearises at the present solution.
    pub(super) fn linearise(&mut self) -> Result<(), LinearisationError<SectionFailure>> {
        self.factors = false;
        linearise(&mut self.system, &self.moving, &self.solution)?;
        self.factors = true;
        Ok(())
    }

    /// Evaluates at the present solution, and keeps the factors of the last linearisation.
    fn simplify(&mut self) -> Result<(), LinearisationError<SectionFailure>> {
        simplify(&mut self.system, &self.moving, &self.solution).map_err(LinearisationError::Slopes)
    }

    /// The response of the solution at the last linearisation to changes of the equations.
    pub(super) fn respond(&self, change: &Forcing<S, 0, L>, out: &mut Correction<S, M, 0, L>) {
        respond(&self.system, change, out);
    }

    /// Takes a shape on a mesh for the motion.
    pub(super) fn start_from(&mut self, whole: &Solution<S, M, L>, mesh: Mesh) {
        self.solution = Solution { mesh, ..Solution::default() };
        let moving = &self.moving;
        whole.remap(&self.system.gauss, |s| moving.jumps_at(s), &mut self.solution);
        self.match_closure();
        self.moving.place_on(&self.system.gauss, &self.solution);
        self.past.clear();
        self.factors = false;
    }

    /// Gives the solution a closure where the equations have one.
    fn match_closure(&mut self) {
        let closed = hydrostat_bvp::Problem::is_closed(&self.moving);
        if closed && !self.solution.directions.is_closed() {
            let (whole, moving) = (self.solution.clone(), &self.moving);
            whole.with_sides(&self.system.gauss, |_| Side::Left, |s| moving.jumps_at(s), &mut self.solution);
        }
        if !closed {
            self.solution.directions.clear();
            self.solution.ends.clear();
        }
    }

    /// Takes the rate cv (1/s) of a step's solves, and the sizes of the states that go with it: powers of two, so that
    /// they seldom change. The factors of the step before are forgotten: its shapes are too far away.
    pub(super) fn set_rate(&mut self, cv: f64) {
        let wanted = (self.moving.mass().sqrt() * cv).sqrt().clamp(1.0, 1e9);
        let scales = P::sizes(wanted.log2().round().exp2());
        self.factors = false;
        let before = *self.moving.scales();
        self.moving.set_rate(cv, scales);
        if before != scales {
            let factors = std::array::from_fn(|a| before[a] / scales[a]);
            rescale(&mut self.solution, &factors);
            self.past.iter_mut().for_each(|(_, shape)| rescale(shape, &factors));
        }
    }

    /// Forgets the motion before, which leads nowhere after a jump.
    pub(super) fn forget(&mut self) {
        self.past.clear();
    }

    /// Goes back to a solution at `time`, and forgets all that came after it.
    pub(super) fn restore(&mut self, solution: &Solution<S, M, L>, scales: &[f64; S], time: f64) {
        self.solution.clone_from(solution);
        rescale(&mut self.solution, &std::array::from_fn(|a| scales[a] / self.moving.scales()[a]));
        self.past.retain(|(t, _)| *t <= time);
        self.factors = false;
        self.moving.place_ends(&self.solution);
    }

    /// Solves at `time` until the centreline's change left to do is below `tolerance` (over L).
    pub(super) fn solve(&mut self, time: f64, tolerance: f64) -> Result<(), Unsolved> {
        self.solves += 1;
        let extrapolated = self.predict(time);
        self.moving.set_end_rates(&self.system.gauss);
        match self.iterate(tolerance) {
            Ok(()) => {}
            Err(_) if extrapolated => {
                self.factors = false;
                // From where it was last.
                if let Some((_, last)) = self.past.last() {
                    self.solution.clone_from(last);
                    self.moving.place_ends(&self.solution);
                    self.moving.set_end_rates(&self.system.gauss);
                }
                self.iterate(tolerance)?;
            }
            Err(error) => return Err(error),
        }
        self.keep(time);
        Ok(())
    }

    fn iterate(&mut self, tolerance: f64) -> Result<(), Unsolved> {
        let (mut applied, mut halvings, mut turns, mut switches) = (0.0, 0, 0, 0);
        let mut before = f64::INFINITY;
        let mut round = 0;
        while round < MOST {
            let keeps = self.factors;
            let linearised = if keeps { self.simplify() } else { self.linearise() };
            match linearised {
                Ok(()) => {}
                Err(LinearisationError::Slopes(failure)) => {
                    if applied == 0.0 || halvings == 6 {
                        return Err(Unsolved::Section(failure));
                    }
                    applied *= 0.5;
                    halvings += 1;
                    self.factors = false;
                    self.solution.add(&self.correction, -applied);
                    self.add_tensions(-applied);
                    continue;
                }
                Err(_) => return Err(Unsolved::Singular),
            }
            self.rounds += 1;
            if turns < TURNS && self.choose_sides() {
                turns += 1;
                applied = 0.0;
                continue;
            }
            round += 1;
            correct(&mut self.system, &self.solution, &mut self.correction);
            let off = self.hold_strokes()?;
            let [angle, moved] = self.moving.largest(&self.correction);
            let strained = self.correction.largest_inner();
            let size = angle.max(strained).max(moved);
            if !size.is_finite() {
                return Err(Unsolved::Singular);
            }
            applied = if angle > 1.0 { 1.0 / angle } else { 1.0 };
            halvings = 0;
            self.solution.add(&self.correction, applied);
            self.add_tensions(applied);
            if switches < SWITCHES && self.switch_taut(size) {
                switches += 1;
                round -= 1;
                self.factors = false;
                continue;
            }
            // Rounds fall with the square of their size, and no faster than the last one did, which is all that is
            // known of rounds with kept factors. The drag's square, and its kinks, count by what a round changes of the
            // velocity.
            let last = if before == f64::INFINITY { 0.0 } else { (size / before).min(1.0) };
            let rate = match (before == f64::INFINITY, keeps) {
                _ if applied < 1.0 => 1.0,
                (true, true) => SLOW,
                (true, false) => size.max((moved * self.moving.drag_change()).min(0.5)),
                (false, true) => last,
                (false, false) => last.max(size),
            };
            before = size;
            if moved.max(0.1 * angle) * rate <= tolerance && applied == 1.0 && off * rate <= STROKES {
                return Ok(());
            }
            self.factors = applied == 1.0 && last < SLOW;
        }
        Err(Unsolved::Stalled)
    }

    /// Gives elements the own ends that the reach of beta' asks for; whether any changed.
    fn choose_sides(&mut self) -> bool {
        if !self.solution.directions.is_closed() {
            return false;
        }
        let (solution, system) = (&self.solution, &self.system);
        let elements = solution.mesh.elements();
        if (0..elements).all(|i| wanted_side(system, solution, i) == solution.directions.side(i)) {
            return false;
        }
        std::mem::swap(&mut self.solution, &mut self.spare);
        let (spare, moving) = (&self.spare, &self.moving);
        let side = |i: usize| wanted_side(&self.system, spare, i);
        spare.with_sides(&self.system.gauss, side, |s| moving.jumps_at(s), &mut self.solution);
        self.moving.place_ends(&self.solution);
        self.moving.set_end_rates(&self.system.gauss);
        self.factors = false;
        true
    }

    fn keep(&mut self, time: f64) {
        let mut shape = if self.past.len() == KEPT { self.past.remove(0).1 } else { Solution::default() };
        shape.clone_from(&self.solution);
        self.past.push((time, shape));
    }

    /// Moves the solution to `time` by the polynomial through the last solves; whether that moved it.
    fn predict(&mut self, time: f64) -> bool {
        let last = self.past.len();
        let directions = &self.solution.directions;
        let first = self.past.iter().rposition(|(_, shape)| shape.directions != *directions).map_or(0, |k| k + 1);
        let mut used: Vec<&(f64, Solution<S, M, L>)> =
            self.past[first.max(last.saturating_sub(THROUGH))..].iter().collect();
        // Stages of equal times would divide by nothing.
        let span = used.iter().fold(1e-300, |span, (t, _)| f64::max(span, (t - time).abs()));
        for k in (1..used.len()).rev() {
            if used[..k].iter().any(|(t, _)| (t - used[k].0).abs() < 1e-6 * span) {
                used.remove(k - 1);
            }
        }
        if used.len() < 2 {
            return false;
        }
        let weights: Vec<f64> = (0..used.len())
            .map(|k| {
                let others = (0..used.len()).filter(|l| *l != k);
                others.map(|l| (time - used[l].0) / (used[k].0 - used[l].0)).product()
            })
            .collect();
        combine(&mut self.solution, &used, &weights);
        true
    }
}

/// Multiplies the states.
fn rescale<const S: usize, const L: usize>(shape: &mut Solution<S, M, L>, factors: &[f64; S]) {
    for node in &mut shape.nodes {
        node.iter_mut().zip(factors).for_each(|(z, factor)| *z *= factor);
    }
    for stage in &mut shape.stages {
        stage.slope.iter_mut().zip(factors).for_each(|(z, factor)| *z = Lanes::of(*factor) * *z);
    }
}

/// The sum of `weights` times the shapes, which have one mesh and the same own ends.
fn combine<const S: usize, const L: usize>(
    out: &mut Solution<S, M, L>,
    shapes: &[&(f64, Solution<S, M, L>)],
    weights: &[f64],
) {
    let terms = || shapes.iter().map(|(_, shape)| shape).zip(weights.iter().copied());
    for (i, node) in out.nodes.iter_mut().enumerate() {
        for a in 0..S {
            node[a] = terms().map(|(shape, w)| w * shape.nodes[i][a]).sum();
        }
    }
    let sum = |of: &dyn Fn(&Solution<S, M, L>) -> Lanes| {
        terms().fold(Lanes::of(0.0), |sum, (s, w)| sum + Lanes::of(w) * of(s))
    };
    for (b, stage) in out.stages.iter_mut().enumerate() {
        for a in 0..S {
            stage.slope[a] = sum(&|s| s.stages[b].slope[a]);
        }
        for a in 0..L {
            stage.inner[a] = sum(&|s| s.stages[b].inner[a]);
        }
        stage.closure_slope = sum(&|s| s.stages[b].closure_slope);
    }
    for (b, end) in out.ends.iter_mut().enumerate() {
        for a in 0..L {
            end.inner[a] = sum(&|s| s.ends[b].inner[a]);
        }
        end.closure_slope = sum(&|s| s.ends[b].closure_slope);
    }
}
