//! Meshes of an arm in space, their errors, and the way to a tolerance: that of the plane.

use hydrostat_bvp::{LANES, Limits, Mesh};

use super::engine::{Engine, METHODS, State};
use super::equations::M;
use super::kinks::kink_resolution;
use super::lengths::hold_lengths;
use super::rotation::dot;
use crate::numerics::rounds::{correct, linearise};
use crate::statics::engine::{Trouble, roughly};

/// How close (over L) nodes are kept to kinks on meshes that are refined afterwards.
const COARSE: f64 = 1e-3;
/// The error that a mesh is made for, over the tolerance.
const TARGET: f64 = 0.3;
/// What Newton is asked for on a first mesh (tip over L).
const FIRST: f64 = 1e-5;
/// The worst estimate (tip over L) with which a solution is still an answer.
const WORST: f64 = 1e-4;
/// Meshes on which Newton may go on hopping across a kink of the load.
const HOPS: usize = 2;
/// Times that the elements of a mesh that carried a shape are halved where Newton gets lost on the next one.
const CUTS: usize = 2;
/// Corrections of the tip (over L) that Newton is not asked to get below.
const RESTLESS: f64 = 1e-13;
/// What Newton leaves (tip over L), over the tolerance.
const LEFT: f64 = 0.1;
/// Errors of the tip (over L) that rounding makes.
const ROUNDED: f64 = 1e-13;
/// What Newton moves the tip by (over L) at the end of an approach.
const NEAR: f64 = 0.03;
/// Error of the tip over L that is kept along a path, and most elements there.
pub(super) const LOOSE: f64 = 1e-4;
const MANY: usize = 200;
/// Reach of beta' over the length of the shortest element that meets the section law at both ends.
const SHORTEST_CLOSING: f64 = 0.3;

/// What the comparison with one more stage is multiplied by to be the estimate: where the load has kinks nearby, one
/// stage more takes away as little as two thirds of the error.
const SAFE: f64 = 2.0;

/// Elements on which most arms meet a tolerance.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tolerances are in [1e-12, 1e-2]")]
fn fair_elements(tolerance: f64) -> usize {
    (tolerance.powf(-1.0 / (2 * M) as f64).ceil() as usize).next_multiple_of(LANES).max(8)
}

/// What the mesh is that a solve settles from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum First {
    /// Anything: good to make a better one from.
    Rough,
    /// One on which most arms meet the tolerance.
    Fair,
    /// One that met it nearby.
    Warm,
}

impl Engine {
    /// Moves the solution to another mesh.
    pub(super) fn move_to(&mut self, mesh: Mesh) {
        std::mem::swap(&mut self.solution, &mut self.before);
        self.solution.mesh = mesh;
        self.meshes += 1;
        let (gauss, equations) = (&self.system.gauss, &self.equations);
        self.before.remap(gauss, |s| equations.jumps_at(s), &mut self.solution);
        self.equations.place_on(gauss, &self.solution);
    }

    /// Compares with one more stage an element: what the tip would move, over L. Fills the errors that each element
    /// contributes, unless it is at most `enough`.
    pub(super) fn estimate(&mut self, tolerance: f64, enough: Option<f64>) -> Result<f64, Trouble> {
        if self.spans.len() != self.solution.mesh.elements() {
            return Err(Trouble::Mesh);
        }
        let methods = &*METHODS;
        let (solution, finer) = (&self.solution, &mut self.finer);
        solution.resample(&methods.to_check, finer);
        self.check_equations.fraction = self.equations.fraction;
        self.check_equations.phase = self.equations.phase;
        self.check_equations.take_arm_of(&self.equations);
        self.check_equations.place_on(&methods.check, &self.finer);
        let mut estimate = self.compare()?;
        let unseen = (LEFT * self.left_over).max(ROUNDED);
        if enough.is_some_and(|enough| estimate.max(unseen) <= enough) {
            return Ok(estimate.max(unseen));
        }
        self.check.contributions(&self.spans, &mut self.errors);
        let contributed: f64 = self.errors.iter().sum();
        if estimate > tolerance && contributed < tolerance {
            // Between nodes the polynomials are less accurate than at them: a second round takes that away.
            self.finer.add(&self.check_correction, 1.0);
            estimate = self.compare()?;
        }
        Ok(estimate.max(unseen))
    }

    /// How far a Newton round with one more stage puts the tip from where the solve has it.
    fn compare(&mut self) -> Result<f64, Trouble> {
        self.may_go_on()?;
        linearise(&mut self.check, &self.check_equations, &self.finer)?;
        self.rounds += 1;
        correct(&mut self.check, &self.finer, &mut self.check_correction);
        if let Some(held) = &self.held {
            hold_lengths(&self.check_equations, &self.check, &self.finer, held, &mut self.check_correction)?;
        }
        let (total, d) = (self.check.totals(), self.check_correction.total);
        let off = [0, 1, 2].map(|k| total[k] + d[k] - self.tip[k]);
        Ok(SAFE * dot(&off, &off).sqrt())
    }

    /// A mesh on which every element would contribute the same to an error `target`.
    pub(super) fn refined(&self, target: f64, most: usize) -> Mesh {
        let limits = Limits { fewest: 4, most, growth: 6.0, cut: 8.0, least: 0.2 };
        let mut shortest = vec![1e-6; self.solution.mesh.elements()];
        for (i, reach) in self.system.closing_reaches() {
            shortest[i] = f64::max(shortest[i], reach / SHORTEST_CLOSING);
        }
        self.solution.mesh.redistributed(&self.errors, &shortest, (2 * M + 1) as f64, target, limits)
    }

    /// Newton from a rough start until corrections are small, and on to a mesh on which most arms meet `tolerance`.
    pub(super) fn approach(&mut self, tolerance: f64) -> Result<(), Trouble> {
        self.iterate(NEAR, 14, None)?;
        let kinks = self.kinks(10.0 * kink_resolution(tolerance));
        let arm = self.equations.arm();
        let density = |s: f64| arm.radius.at(s * arm.length, arm.length).value.sqrt().recip();
        let mut mesh = Mesh::graded(fair_elements(tolerance), &self.breaks, density);
        mesh.pin(&self.breaks, &kinks);
        self.move_to(mesh);
        Ok(())
    }

    /// Refines until the estimate meets `tolerance` (tip position over L). Where that cannot be had,
    /// the best there is, if it is good to [`WORST`].
    pub(super) fn settle(&mut self, tolerance: f64, first: First) -> Result<f64, Trouble> {
        let mut estimate = f64::INFINITY;
        let mut best: Option<(f64, State)> = None;
        let mut carried: Option<State> = None;
        let (mut cuts, mut hops) = (0, 0);
        let least = (LEFT * tolerance).max(RESTLESS);
        let near = kink_resolution(tolerance);
        for attempt in 0..12 {
            let goal = match (attempt, first) {
                (0, First::Warm | First::Fair) => least,
                (0, First::Rough) => tolerance.max(FIRST),
                _ => (1e-4 * estimate).min(tolerance.max(1e-3)).max(least),
            };
            let mut fine = goal <= 3.0 * tolerance;
            let resolution = if fine { near } else { near.max(COARSE) };
            let mut converged = self.converge(goal, resolution);
            let mut hop = 0.0;
            if converged.is_err() && hops < HOPS && (attempt > 0 || first == First::Fair) {
                hops += 1;
                fine = false;
                converged = roughly(converged);
                hop = self.last;
            }
            let enough = fine.then_some(tolerance);
            let outcome = converged.and_then(|()| self.estimate(tolerance, enough));
            estimate = match (outcome, &best) {
                (Ok(estimate), _) => estimate.max(hop),
                (Err(trouble), None) => {
                    let Some(state) = carried.as_ref().filter(|_| cuts < CUTS) else { return Err(trouble) };
                    cuts += 1;
                    let state = state.clone();
                    self.restore(&state);
                    let halves = self.solution.mesh.cut(1 << cuts);
                    self.move_to(halves);
                    continue;
                }
                (Err(_), Some(_)) => break,
            };
            if estimate <= tolerance && fine {
                return Ok(estimate);
            }
            if attempt > 0 && estimate < best.as_ref().map_or(WORST, |b| b.0) {
                best = Some((estimate, self.state()));
            }
            if first == First::Rough && estimate < WORST {
                carried = Some(self.state());
            }
            let mut mesh = self.refined(TARGET * tolerance, 2000);
            let kinks = self.kinks(10.0 * near);
            mesh.pin(&self.breaks, &kinks);
            self.move_to(mesh);
        }
        match best {
            Some((estimate, state)) => {
                self.restore(&state);
                self.linearise()?;
                Ok(estimate)
            }
            None => Err(Trouble::Mesh),
        }
    }

    /// Newton on this mesh, with nodes moved to within `resolution` of the kinks of the load.
    fn converge(&mut self, goal: f64, resolution: f64) -> Result<(), Trouble> {
        self.iterate(goal, 14, Some(resolution))?;
        for _ in 0..4 {
            if !self.pin_kinks(resolution) {
                break;
            }
            self.iterate(goal, 14, None)?;
        }
        Ok(())
    }

    /// Refines the mesh at the present loads where the tip's error is above what a path keeps.
    pub(super) fn keep_accuracy(&mut self) -> Result<(), Trouble> {
        for _ in 0..4 {
            let Ok(estimate) = self.estimate(LOOSE, Some(LOOSE)) else { break };
            if estimate <= LOOSE {
                return Ok(());
            }
            let mut mesh = self.refined(0.1 * LOOSE, MANY);
            let kinks = self.kinks(1e-3);
            mesh.pin(&self.breaks, &kinks);
            self.move_to(mesh);
            roughly(self.iterate(1e-6, 9, None))?;
        }
        Ok(())
    }
}
