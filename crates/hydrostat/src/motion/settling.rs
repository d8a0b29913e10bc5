//! Newton's method on the boundary-value problem of one stage.

use hydrostat_bvp::{Collocation, Correction, Forcing, Lanes, LinearisationError, Mesh, Real, Side, Solution};

use super::border::Border;
use super::dimensions::{S, Shape, X};
use super::equations::Moving;
use crate::numerics::rounds::{correct, linearise, respond};
use crate::rod::arm::Arm;
use crate::statics::dimensions::{Guess, L, M, N, Q};
use crate::statics::engine::{turn_sections, wanted_side};
use crate::statics::equations::SectionFailure;

/// Rounds of one solve.
const MOST: usize = 20;

/// Solves that are kept: those of a step that fails, and the last three before it.
const KEPT: usize = 8;

/// Solves through which the motion is extrapolated: more do not predict better.
const THROUGH: usize = 3;

/// What strokes may be off by, over L.
const STROKES: f64 = 1e-9;

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

/// The solver of stages: the last solution, and those before it.
#[derive(Debug, Clone)]
pub(super) struct Settling {
    pub(super) moving: Moving,
    pub(super) system: Collocation<S, M, 0, L>,
    pub(super) solution: Shape,
    pub(super) correction: Correction<S, M, 0, L>,
    pub(super) border: Border,
    /// The last solves, the latest last, with their times.
    past: Vec<(f64, Shape)>,
    spare: Shape,
    /// Linearisations so far, and solves.
    pub(super) rounds: usize,
    pub(super) solves: usize,
}

impl Settling {
    pub(super) fn new(arm: &Arm) -> Self {
        Self {
            moving: Moving::new(arm),
            system: Collocation::new().balanced(),
            solution: Solution::default(),
            correction: Correction::default(),
            border: Border::default(),
            past: Vec::new(),
            spare: Solution::default(),
            rounds: 0,
            solves: 0,
        }
    }

    /// Linearises at the present solution.
    pub(super) fn linearise(&mut self) -> Result<(), LinearisationError<SectionFailure>> {
        linearise(&mut self.system, &self.moving, &self.solution)
    }

    /// The response of the solution at the last linearisation to changes of the equations.
    pub(super) fn respond(&self, change: &Forcing<S, 0, L>, out: &mut Correction<S, M, 0, L>) {
        respond(&self.system, change, out);
    }

    /// n_f(0) and m_f(0) of the solution, in the unit of force.
    pub(super) fn at_base(&self) -> [f64; 3] {
        self.contact().next().unwrap_or_default()
    }

    /// n_f and m_f of the solution at the nodes, in the unit of force.
    pub(super) fn contact(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let scales = self.moving.scales;
        self.solution.nodes.iter().map(move |z| std::array::from_fn(|k| scales[k + 1] * z[k + 1]))
    }

    /// Takes the unloaded arm, on a mesh for the motion.
    pub(super) fn start_unloaded(&mut self, mesh: Mesh) {
        let statics = &mut self.moving.statics;
        let base = statics.arm().base;
        let mut shape = Guess::constant(mesh, [base.angle, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        statics.place_on(&self.system.gauss, &shape);
        for (block, stage) in shape.stages.iter_mut().enumerate() {
            stage.inner = statics.reference_in(block);
        }
        turn_sections(&self.system.gauss, &mut shape);
        let force = statics.units.force;
        let mesh = shape.mesh.clone();
        self.start_from(&shape, force, mesh);
    }

    /// Takes the solution of the statics, whose unit of force is `force` (N), on a mesh for the motion.
    pub(super) fn start_from(&mut self, given: &Guess, force: f64, mesh: Mesh) {
        let statics = &self.moving.statics;
        let whole = with_places(given, force / statics.units.force, statics.arm(), &self.system);
        let statics = &self.moving.statics;
        self.solution = Solution { mesh, ..Solution::default() };
        whole.remap(&self.system.gauss, |s| statics.jumps_at(s), &mut self.solution);
        self.match_closure();
        self.moving.place_on(&self.system.gauss, &self.solution);
        self.past.clear();
    }

    /// Gives the solution a closure where the equations have one.
    fn match_closure(&mut self) {
        let closed = hydrostat_bvp::Problem::is_closed(&self.moving);
        if closed && !self.solution.directions.is_closed() {
            let (whole, statics) = (self.solution.clone(), &self.moving.statics);
            whole.with_sides(&self.system.gauss, |_| Side::Left, |s| statics.jumps_at(s), &mut self.solution);
        }
        if !closed {
            self.solution.directions.clear();
            self.solution.ends.clear();
        }
    }

    /// Takes the rate cv (1/s) of the next solves, and the sizes of the states that go with it: powers of two, so
    /// that they seldom change.
    pub(super) fn set_rate(&mut self, cv: f64) {
        self.moving.cv = cv;
        let mass = self.moving.masses.first().map_or(0.0, |own| (own.wall + own.added).0[0]);
        let wanted = (mass.sqrt() * cv).sqrt().clamp(1.0, 1e9);
        let k = wanted.log2().round().exp2();
        let scales = [1.0, k * k, k * k, k, 1.0 / k, 1.0 / k];
        let before = std::mem::replace(&mut self.moving.scales, scales);
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
    pub(super) fn restore(&mut self, solution: &Shape, scales: &[f64; S], time: f64) {
        self.solution.clone_from(solution);
        rescale(&mut self.solution, &std::array::from_fn(|a| scales[a] / self.moving.scales[a]));
        self.past.retain(|(t, _)| *t <= time);
        self.moving.statics.place_ends(&self.solution);
    }

    /// Solves at `time` until the centreline's change left to do is below `tolerance` (over L).
    pub(super) fn solve(&mut self, time: f64, tolerance: f64) -> Result<(), Unsolved> {
        self.solves += 1;
        let extrapolated = self.predict(time);
        self.moving.set_end_rates(&self.system.gauss);
        match self.iterate(tolerance) {
            Ok(()) => {}
            Err(_) if extrapolated => {
                // From where it was last.
                if let Some((_, last)) = self.past.last() {
                    self.solution.clone_from(last);
                    self.moving.statics.place_ends(&self.solution);
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
            match self.linearise() {
                Ok(()) => {}
                Err(LinearisationError::Slopes(failure)) => {
                    if applied == 0.0 || halvings == 6 {
                        return Err(Unsolved::Section(failure));
                    }
                    applied *= 0.5;
                    halvings += 1;
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
            self.border()?;
            let angle = self.correction.largest(0);
            let moved = self.correction.largest(X).max(self.correction.largest(X + 1)) * self.moving.scales[X];
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
                continue;
            }
            // Rounds fall with the square of their size, and no faster than the last one did. The drag's square, and
            // its kinks, count by what a round changes of the velocity.
            let of_drag = if before == f64::INFINITY { (0.5_f64).min(moved * self.moving.drag_change()) } else { 0.0 };
            let rate = if applied < 1.0 { 1.0 } else { (size / before).min(1.0).max(size).max(of_drag) };
            before = size;
            if moved.max(0.1 * angle) * rate <= tolerance && applied == 1.0 && self.border.off * rate <= STROKES {
                return Ok(());
            }
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
        let (spare, statics) = (&self.spare, &self.moving.statics);
        let side = |i: usize| wanted_side(&self.system, spare, i);
        spare.with_sides(&self.system.gauss, side, |s| statics.jumps_at(s), &mut self.solution);
        self.moving.statics.place_ends(&self.solution);
        self.moving.set_end_rates(&self.system.gauss);
        true
    }

    fn keep(&mut self, time: f64) {
        let mut shape = if self.past.len() == KEPT { self.past.remove(0).1 } else { Shape::default() };
        shape.clone_from(&self.solution);
        self.past.push((time, shape));
    }

    /// Moves the solution to `time` by the polynomial through the last solves; whether that moved it.
    fn predict(&mut self, time: f64) -> bool {
        let last = self.past.len();
        let directions = &self.solution.directions;
        let first = self.past.iter().rposition(|(_, shape)| shape.directions != *directions).map_or(0, |k| k + 1);
        let mut used: Vec<&(f64, Shape)> = self.past[first.max(last.saturating_sub(THROUGH))..].iter().collect();
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
fn rescale(shape: &mut Shape, factors: &[f64; S]) {
    for node in &mut shape.nodes {
        node.iter_mut().zip(factors).for_each(|(z, factor)| *z *= factor);
    }
    for stage in &mut shape.stages {
        stage.slope.iter_mut().zip(factors).for_each(|(z, factor)| *z = Lanes::of(*factor) * *z);
    }
}

/// The sum of `weights` times the shapes, which have one mesh and the same own ends.
fn combine(out: &mut Shape, shapes: &[&(f64, Shape)], weights: &[f64]) {
    let terms = || shapes.iter().map(|(_, shape)| shape).zip(weights.iter().copied());
    for (i, node) in out.nodes.iter_mut().enumerate() {
        for a in 0..S {
            node[a] = terms().map(|(shape, w)| w * shape.nodes[i][a]).sum();
        }
    }
    let sum = |of: &dyn Fn(&Shape) -> Lanes| terms().fold(Lanes::of(0.0), |sum, (s, w)| sum + Lanes::of(w) * of(s));
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

/// The solution of the statics with x and y, from the base, as states, and what it carries times `force`.
fn with_places(given: &Guess, force: f64, arm: &Arm, system: &Collocation<S, M, 0, L>) -> Shape {
    let mut statics = Collocation::<N, M, Q, L>::with(system.gauss.clone());
    statics.take_stations(given);
    let mut out = Solution {
        mesh: given.mesh.clone(),
        directions: given.directions.clone(),
        nodes: Vec::with_capacity(given.nodes.len()),
        stages: Vec::with_capacity(given.stages.len()),
        ends: given.ends.clone(),
    };
    for (station, stage) in statics.stations().iter().zip(&given.stages) {
        let by = Lanes::of(force);
        let (sin, cos) = (station.z[0].map(f64::sin), station.z[0].map(f64::cos));
        let [nu, eta, _] = stage.inner;
        let [theta, n_x, n_y, m] = stage.slope;
        out.stages.push(hydrostat_bvp::Stage {
            slope: [theta, by * n_x, by * n_y, by * m, nu * cos - eta * sin, nu * sin + eta * cos],
            inner: stage.inner,
            closure_slope: stage.closure_slope,
        });
    }
    let (mut x, mut y) = (arm.base.x / arm.length, arm.base.y / arm.length);
    for (i, [theta, n_x, n_y, m]) in given.nodes.iter().copied().enumerate() {
        out.nodes.push([theta, force * n_x, force * n_y, force * m, x, y]);
        if i < given.mesh.elements() {
            let h = given.mesh.step(i);
            for (j, b) in system.gauss.b.iter().enumerate() {
                let slope = out.slope(i, j);
                x += h * b * slope[X];
                y += h * b * slope[X + 1];
            }
        }
    }
    out
}
