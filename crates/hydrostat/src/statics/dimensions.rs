//! The sizes of the boundary-value problem, and the units in which it is solved.

use hydrostat_bvp::Solution;

/// States: theta, n_f along e1, n_f along e2, m_f.
pub(crate) const N: usize = 4;
/// Quadratures: x, y.
pub(crate) const Q: usize = 2;
/// Inner unknowns: nu, eta, mu.
pub(crate) const L: usize = 3;

/// Stages of the solve.
pub(crate) const M: usize = 4;
/// Stages of the check that estimates its error.
pub(crate) const K: usize = M + 1;

/// A solution on the mesh of a solve.
pub(crate) type Guess = Solution<N, M, L>;

/// The units in which the equations are solved: lengths in L, forces in `force`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    pub(crate) length: f64,
    pub(crate) force: f64,
}
