//! The way to a tolerance, of an arm in the plane and in space alike: Newton on a mesh, an estimate of its error, the
//! next mesh from what each element contributes.

use hydrostat_bvp::{LANES, Limits, Mesh};

use crate::rod::arm::Arm;
use crate::statics::dimensions::M;
use crate::statics::engine::{Trouble, roughly};

/// How close (over L) nodes are kept to kinks on meshes that are refined afterwards.
const COARSE: f64 = 1e-3;

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

/// Newton rounds on one mesh.
const ROUNDS: usize = 14;

/// Elements of a mesh.
const MOST_ELEMENTS: usize = 2000;

/// Reach of beta' over the length of the shortest element that meets the section law at both ends: on shorter ones the
/// equations there hardly differ.
const SHORTEST_CLOSING: f64 = 0.3;

/// Elements on which most arms meet a tolerance: by the order of the method, and what `paper` takes.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tolerances are in [1e-12, 1e-2]")]
fn fair_elements(tolerance: f64) -> usize {
    (tolerance.powf(-1.0 / (2 * M) as f64).ceil() as usize).next_multiple_of(LANES).max(8)
}

/// A mesh with shorter elements where the arm is thinner, and with it the lengths on which shape and loads vary.
pub(crate) fn graded(arm: &Arm, breaks: &[f64], elements: usize) -> Mesh {
    Mesh::graded(elements, breaks, |s| arm.radius.at(s * arm.length, arm.length).value.sqrt().recip())
}

/// The error of the tip (over L) that the last Newton round may have left, `correction` by its own measure, or
/// rounding.
pub(crate) fn unseen(correction: f64) -> f64 {
    (LEFT * correction).max(ROUNDED)
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

/// A solution on a mesh that can be moved to another one: of an arm in the plane, or in space.
pub(crate) trait Refinable {
    /// A solution with all that belongs to it, to come back to.
    type State: Clone;

    /// Meshes that may be tried.
    const MESHES: usize;

    fn arm(&self) -> &Arm;
    fn mesh(&self) -> &Mesh;
    fn remap_to(&mut self, mesh: Mesh);
    fn state(&self) -> Self::State;
    fn restore(&mut self, state: &Self::State);

    /// Places (over L) where nodes stay: ends of cables, corners of tables.
    fn breaks(&self) -> &[f64];
    /// Errors that the elements contribute, after an estimate that filled them.
    fn errors(&self) -> &[f64];
    /// Elements that meet the section law at both ends, with the reach of beta' there (over L).
    fn closing_reaches(&self) -> Vec<(usize, f64)>;

    /// How close nodes are kept to kinks at a tolerance.
    fn resolution(&self, tolerance: f64) -> f64;
    /// Places (over L) of the kinks at the present solution; those closer than `apart` are one.
    fn kinks(&mut self, apart: f64) -> Vec<f64>;
    /// Moves nodes onto the kinks at the present solution; whether any moved.
    fn pin_kinks(&mut self, resolution: f64) -> bool;

    /// Newton until a round moves the tip by less than `goal` (over L).
    fn iterate(&mut self, goal: f64, most: usize, resolution: Option<f64>) -> Result<(), Trouble>;
    /// The tip's correction (over L) by the last round.
    fn last(&self) -> f64;
    fn linearise(&mut self) -> Result<(), Trouble>;
    /// Compares with one more stage an element: what the tip would move, over L. Fills the errors that each element
    /// contributes, unless it is at most `enough`.
    fn estimate(&mut self, tolerance: f64, enough: Option<f64>) -> Result<f64, Trouble>;

    /// A mesh on which every element would contribute the same to an error `target`.
    fn refined(&self, target: f64, most: usize) -> Mesh {
        let limits = Limits { fewest: 4, most, growth: 6.0, cut: 8.0, least: 0.2 };
        let mut shortest = vec![1e-6; self.mesh().elements()];
        for (i, reach) in self.closing_reaches() {
            shortest[i] = f64::max(shortest[i], reach / SHORTEST_CLOSING);
        }
        self.mesh().redistributed(self.errors(), &shortest, (2 * M + 1) as f64, target, limits)
    }

    /// What `read` finds on halves of the elements, where Newton has a solution there; then back on these.
    fn on_halves<T>(
        &mut self,
        tolerance: f64,
        read: impl FnOnce(&mut Self) -> Result<T, Trouble>,
    ) -> Result<T, Trouble> {
        let kept = self.state();
        self.remap_to(self.mesh().cut(2));
        let there = roughly(self.iterate(tolerance, 9, None)).and_then(|()| read(self));
        self.restore(&kept);
        there
    }

    /// Moves to such a mesh, with nodes on the kinks; those closer than `apart` are one.
    fn refine(&mut self, target: f64, most: usize, apart: f64) {
        let mut mesh = self.refined(target, most);
        let kinks = self.kinks(apart);
        mesh.pin(self.breaks(), &kinks);
        self.remap_to(mesh);
    }

    /// Newton from a rough start until corrections are small, and on to a mesh on which most arms meet `tolerance`.
    fn approach(&mut self, tolerance: f64) -> Result<(), Trouble> {
        self.iterate(NEAR, ROUNDS, None)?;
        let resolution = self.resolution(tolerance);
        let kinks = self.kinks(10.0 * resolution);
        let mut mesh = graded(self.arm(), self.breaks(), fair_elements(tolerance));
        mesh.pin(self.breaks(), &kinks);
        self.remap_to(mesh);
        Ok(())
    }

    /// Refines until the estimate meets `tolerance` (tip position over L). Where that cannot be had,
    /// the best there is, if it is good to [`WORST`].
    fn settle(&mut self, tolerance: f64, first: First) -> Result<f64, Trouble> {
        let mut estimate = f64::INFINITY;
        let mut best: Option<(f64, Self::State)> = None;
        // The shape on the last mesh that carried it, at the end of a path.
        let mut carried: Option<Self::State> = None;
        let mut cuts = 0;
        let mut hops = 0;
        let least = (LEFT * tolerance).max(RESTLESS);
        let near = self.resolution(tolerance);
        for attempt in 0..Self::MESHES {
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
                hop = self.last();
            }
            let enough = fine.then_some(tolerance);
            let outcome = converged.and_then(|()| self.estimate(tolerance, enough));
            estimate = match (outcome, &best) {
                (Ok(estimate), _) => estimate.max(hop),
                (Err(trouble), None) => {
                    let Some(state) = carried.as_ref().filter(|_| cuts < CUTS) else { return Err(trouble) };
                    // Newton got lost on a mesh that the errors of another foresaw: layers of a fast stream are where
                    // elements are long on it. Halves of the elements that carried the shape carry it, too.
                    cuts += 1;
                    self.restore(state);
                    let halves = self.mesh().cut(1 << cuts);
                    self.remap_to(halves);
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
            self.refine(TARGET * tolerance, MOST_ELEMENTS, 10.0 * near);
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
        self.iterate(goal, ROUNDS, Some(resolution))?;
        for _ in 0..4 {
            if !self.pin_kinks(resolution) {
                break;
            }
            self.iterate(goal, ROUNDS, None)?;
        }
        Ok(())
    }
}
