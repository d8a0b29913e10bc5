//! Newton's method kept away from shapes that are known (P. E. Farrell, A. Birkisson, S. W. Funke, "Deflation
//! techniques for finding distinct solutions of nonlinear partial differential equations", SIAM J. Sci. Comput. 37,
//! 2015, <https://doi.org/10.1137/140984798>).
//!
//! The residual F is multiplied by m = prod (1/r_i^2 + 1), where r_i is how far the shape is from the known one i,
//!
//! ```text
//! r_i^2 = 1/L int |q - q_i|^2 ds,
//! ```
//!
//! with the quaternions q of the sections. m F has no zero at a known shape, and those of F elsewhere. Its derivative
//! differs from m dF by a matrix of rank one, so that Newton's step for m F is that for F, p, times a number (Sherman
//! and Morrison):
//!
//! ```text
//! p/(1 - d ln m . p),   d ln m . p = - sum 2 <q - q_i, dq>/(r_i^2 (1 + r_i^2)),   dq: the change of q in p.
//! ```

use hydrostat_bvp::LinearisationError;

use super::engine::{Engine, largest_turn};
use super::equations::Guess;
use crate::numerics::rounds::{correct, linearise};
use crate::statics::engine::Trouble;

/// Most rounds.
const MOST: usize = 60;

/// Correction (rad) of the plain equations from which their own rounds lead to the shape.
const CLOSE: f64 = 1e-2;

/// Changes of own ends that are made.
const SIDES: usize = 2;

impl Engine {
    /// Rounds from the present shape until a shape that is none of the `known` ones is near.
    pub(super) fn near_another(&mut self, known: &[&Guess]) -> Result<(), Trouble> {
        let (mut applied, mut halvings, mut sides) = (0.0, 0, 0);
        self.match_closure();
        for _ in 0..MOST {
            self.may_go_on()?;
            match linearise(&mut self.system, &self.equations, &self.solution) {
                Ok(()) => {}
                Err(LinearisationError::Slopes(failure)) => {
                    self.halve(&[], &mut applied, &mut halvings, failure)?;
                    continue;
                }
                Err(singular) => return Err(singular.into()),
            }
            self.rounds += 1;
            if sides < SIDES && self.choose_sides() {
                sides += 1;
                applied = 0.0;
                continue;
            }
            correct(&mut self.system, &self.solution, &mut self.correction);
            let size = largest_turn(&self.solution, &self.correction);
            if !size.is_finite() {
                return Err(Trouble::Singular);
            }
            if size < CLOSE {
                return Ok(());
            }
            self.last = size;
            let step = 1.0 / (1.0 - self.towards(known));
            if step.is_nan() {
                return Err(Trouble::Singular);
            }
            // No section turns by more than one radian.
            applied = step.clamp(-1.0 / size, 1.0 / size);
            halvings = 0;
            self.take_correction(applied);
        }
        Err(Trouble::Stalled(self.last))
    }

    /// d ln m . p for the present correction.
    fn towards(&self, known: &[&Guess]) -> f64 {
        let (mesh, gauss) = (&self.solution.mesh, &self.system.gauss);
        let mut out = 0.0;
        for other in known {
            let (mut square, mut product) = (0.0, 0.0);
            let nodes = self.solution.nodes.iter().zip(&self.correction.nodes).zip(mesh.nodes());
            for (((z, dz), s), weight) in nodes.zip(mesh.node_weights()) {
                let there = other.state_in(gauss, other.mesh.element_of(*s), *s);
                for k in 0..4 {
                    let off = z[k] - there[k];
                    square += weight * off * off;
                    product += weight * off * dz[k];
                }
            }
            out -= 2.0 * product / (square * (1.0 + square));
        }
        out
    }
}
