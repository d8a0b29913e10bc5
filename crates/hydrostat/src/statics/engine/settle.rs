//! Meshes, their errors, and the way to a tolerance.

use hydrostat_bvp::{LANES, Limits, Mesh};

use super::discrete::{Engine, METHODS, State};
use super::kinks::kink_resolution;
use super::trouble::{Trouble, roughly};
use crate::numerics::dispatch::widest;
use crate::numerics::rounds::{correct, linearise};
use crate::statics::dimensions::M;

/// How close (over L) nodes are kept to kinks on meshes that are refined afterwards.
const COARSE: f64 = 1e-3;

/// How close (over L) nodes are kept to kinks of friction.
const OF_FRICTION: f64 = 5e-8;

/// The error that a mesh is made for, over the tolerance: element by element it is foreseen with its sign lost.
const TARGET: f64 = 0.3;

/// What Newton is asked for on a first mesh (tip over L): what it leaves there would be taken for errors of the
/// elements.
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

/// Errors of the tip (over L) that rounding makes, which no comparison shows.
const ROUNDED: f64 = 1e-13;

/// What Newton moves the tip by (over L) at the end of an approach.
const NEAR: f64 = 0.03;

/// Reach of beta' over the length of the shortest element that meets the section law at both ends: on shorter ones the
/// equations there hardly differ.
const SHORTEST_CLOSING: f64 = 0.3;

/// Elements on which most arms meet a tolerance: by the order of the method, and what `paper` takes.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tolerances are in [1e-12, 1e-2]")]
fn fair_elements(tolerance: f64) -> usize {
    (tolerance.powf(-1.0 / (2 * M) as f64).ceil() as usize).next_multiple_of(LANES).max(8)
}

/// What the mesh is that a solve settles from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum First {
    /// Anything: good to make a better one from.
    Rough,
    /// One on which most arms meet the tolerance.
    Fair,
    /// One that met it nearby.
    Warm,
}

impl Engine {
    /// Compares with one more stage an element: what the tip would move, over L. Fills the errors that each element
    /// contributes, unless it is at most `enough`.
    pub(crate) fn estimate_unless(&mut self, tolerance: f64, enough: Option<f64>) -> Result<f64, Trouble> {
        if self.spans.len() != self.solution.mesh.elements() {
            // The last Newton rounds on this mesh did not converge: there is nothing to compare with.
            return Err(Trouble::Mesh);
        }
        let methods = &*METHODS;
        let own = &self.equations;
        let (solution, finer) = (&self.solution, &mut self.finer);
        widest(
            #[inline(always)]
            || solution.resample(&methods.to_check, finer),
        );
        self.check_equations.fraction = own.fraction;
        self.check_equations.phase = own.phase;
        self.check_equations.take_arm_of(own);
        self.check_equations.place_on(&methods.check, &self.finer);
        let mut estimate = self.compare()?;
        // What Newton left is in the solution, but not in the tip that its last round foresaw.
        let unseen = (LEFT * self.left_over).max(ROUNDED);
        if enough.is_some_and(|enough| estimate.max(unseen) <= enough) {
            return Ok(estimate.max(unseen));
        }
        let (check, spans, errors) = (&mut self.check, &self.spans, &mut self.errors);
        widest(
            #[inline(always)]
            || check.contributions(spans, errors),
        );
        let contributed: f64 = self.errors.iter().sum();
        if estimate > tolerance && contributed < tolerance {
            // Between nodes the polynomials are less accurate than at them, and one Newton round
            // from there leaves the square of that in the comparison: a second one removes it.
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
        let total = self.check.totals();
        let [dx, dy] = self.check_correction.total;
        Ok((total[0] + dx - self.tip[0]).hypot(total[1] + dy - self.tip[1]))
    }

    pub(crate) fn refine(&mut self, target: f64, most: usize) {
        let mesh = self.refined(target, most);
        self.move_to(mesh);
    }

    /// A mesh on which every element would contribute the same to an error `target`.
    fn refined(&self, target: f64, most: usize) -> Mesh {
        let limits = Limits { fewest: 4, most, growth: 6.0, cut: 8.0, least: 0.2 };
        let mut shortest = vec![1e-6; self.solution.mesh.elements()];
        for (i, reach) in self.system.closing_reaches() {
            shortest[i] = f64::max(shortest[i], reach / SHORTEST_CLOSING);
        }
        self.solution.mesh.redistributed(&self.errors, &shortest, (2 * M + 1) as f64, target, limits)
    }

    /// Newton from a rough start until corrections are small, and on to a mesh on which most arms meet `tolerance`.
    pub(crate) fn approach(&mut self, tolerance: f64) -> Result<(), Trouble> {
        self.iterate(NEAR, 14, None)?;
        let kinks = self.kinks(10.0 * kink_resolution(tolerance));
        let mut mesh = self.graded(fair_elements(tolerance));
        mesh.pin(&self.breaks, &kinks);
        self.move_to(mesh);
        Ok(())
    }

    /// A mesh with shorter elements where the arm is thinner, and with it the lengths on which shape and loads vary.
    fn graded(&self, elements: usize) -> Mesh {
        let arm = self.equations.arm();
        Mesh::graded(elements, &self.breaks, |s| arm.radius.at(s * arm.length, arm.length).value.sqrt().recip())
    }

    /// Refines until the estimate meets `tolerance` (tip position over L). Where that cannot be had,
    /// the best there is, if it is good to [`WORST`].
    pub(crate) fn settle(&mut self, tolerance: f64, first: First) -> Result<f64, Trouble> {
        let mut estimate = f64::INFINITY;
        let mut best: Option<(f64, State)> = None;
        // The shape on the last mesh that carried it, at the end of a path.
        let mut carried: Option<State> = None;
        let mut cuts = 0;
        let mut hops = 0;
        let least = (LEFT * tolerance).max(RESTLESS);
        let near = self.resolution(tolerance);
        for attempt in 0..10 {
            let goal = match (attempt, first) {
                (0, First::Warm | First::Fair) => least,
                (0, First::Rough) => tolerance.max(FIRST),
                _ => (1e-4 * estimate).min(tolerance.max(1e-3)).max(least),
            };
            let mut fine = goal <= 3.0 * tolerance;
            // A first mesh is only there to make a better one from.
            let resolution = if fine { near } else { near.max(COARSE) };
            let mut converged = self.converge(goal, resolution);
            let mut hop = 0.0;
            if converged.is_err() && hops < HOPS && (attempt > 0 || first == First::Fair) {
                hops += 1;
                // It may be the mesh: good enough to make a better one from.
                fine = false;
                converged = roughly(converged);
                hop = self.last;
            }
            let enough = fine.then_some(tolerance);
            let outcome = converged.and_then(|()| self.estimate_unless(tolerance, enough));
            estimate = match (outcome, &best) {
                (Ok(estimate), _) => estimate.max(hop),
                (Err(trouble), None) => {
                    let Some(state) = carried.as_ref().filter(|_| cuts < CUTS) else { return Err(trouble) };
                    // Newton got lost on a mesh that the errors of another foresaw: layers of a fast stream are where
                    // elements are long on it. Halves of the elements that carried the shape carry it, too.
                    cuts += 1;
                    self.restore(state);
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

    /// How close nodes are kept to kinks at a tolerance. Those of friction are given while a shape is looked for, and
    /// as beside them chi' is not zero (`friction`), what a node that is off one costs is of first order.
    fn resolution(&self, tolerance: f64) -> f64 {
        let resolution = kink_resolution(tolerance);
        if self.equations.capstan.is_some() { resolution.min(OF_FRICTION) } else { resolution }
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
}
