//! Places where the solution is asked for: nodes, at which it is most accurate.

use super::discrete::Engine;
use super::kinks::kink_resolution;
use super::trouble::Trouble;
use crate::statics::refinement::{First, Refinable as _};

/// Places (over L) that are this near are the same.
const SAME: f64 = 1e-9;

impl Engine {
    /// Whether the data, or what is asked for, has a node at `s` (over L).
    pub(crate) fn has_break_at(&self, s: f64) -> bool {
        self.breaks.iter().any(|own| (own - s).abs() < SAME)
    }

    /// The node at `s` (over L), if there is one.
    pub(crate) fn node_at(&self, s: f64) -> Option<usize> {
        self.solution.mesh.nodes().iter().position(|node| (node - s).abs() < SAME)
    }

    /// x and y over L from the base, and theta, at a place (over L) that is watched, after Newton has converged.
    pub(crate) fn pose_of(&self, place: f64) -> [f64; 3] {
        let node = self.node_at(place).unwrap_or(self.solution.mesh.elements());
        let mut out = [0.0, 0.0, self.solution.nodes[node][0]];
        for span in &self.spans[..node] {
            out[0] += span[0];
            out[1] += span[1];
        }
        out
    }

    /// Keeps a node at each of these places (over L), from now on, and settles on the mesh that has them.
    pub(crate) fn watch(&mut self, places: &[f64], tolerance: f64) -> Result<(), Trouble> {
        let new: Vec<f64> = places.iter().copied().filter(|s| self.node_at(*s).is_none()).collect();
        for s in places.iter().filter(|s| **s > SAME && **s < 1.0 - SAME) {
            if !self.has_break_at(*s) {
                self.breaks.push(*s);
            }
        }
        self.breaks.sort_by(f64::total_cmp);
        if new.is_empty() {
            return Ok(());
        }
        let mut moving = self.kinks(10.0 * kink_resolution(tolerance, self.equations.arm().model.load_can_jump()));
        moving.extend(&new);
        let mut mesh = self.solution.mesh.clone();
        mesh.pin(&self.breaks, &moving);
        self.remap_to(mesh);
        self.settle(tolerance, First::Fair).map(|_| ())
    }
}
