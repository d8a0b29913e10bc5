//! The sizes of a stage's boundary-value problem.

use hydrostat_bvp::Solution;

use crate::statics::dimensions::{L, M};

/// States: those of the statics, and x, y.
pub(super) const S: usize = 6;
/// Where x stands among them; y follows.
pub(super) const X: usize = 4;

/// A solution on the mesh of the motion.
pub(super) type Shape = Solution<S, M, L>;
