//! Newton's rounds of the collocation of an arm in space, each compiled once. Not for wide vectors, unlike those of the
//! plane: with ten states that takes minutes.

use hydrostat_bvp::{Collocation, Correction, Forcing, LinearisationError, Solution};

use super::equations::{Equations, L, N, Q};
use crate::statics::equations::SectionFailure;

/// Stages of the solve, and of the check that estimates its error.
pub(crate) const M: usize = 4;
pub(super) const K: usize = M + 1;

pub(crate) type Guess = Solution<N, M, L>;

/// [`Collocation::evaluate`].
#[inline(never)]
pub(super) fn evaluate(
    system: &mut Collocation<N, M, Q, L>,
    equations: &Equations,
    solution: &Guess,
) -> Result<(), SectionFailure> {
    system.evaluate::<_, false>(equations, solution)
}

/// [`Collocation::linearise`].
#[inline(never)]
pub(super) fn linearise<const S: usize>(
    system: &mut Collocation<N, S, Q, L>,
    equations: &Equations,
    solution: &Solution<N, S, L>,
) -> Result<(), LinearisationError<SectionFailure>> {
    system.linearise::<_, false>(equations, solution)
}

/// [`Collocation::newton`].
#[inline(never)]
pub(super) fn correct<const S: usize>(
    system: &mut Collocation<N, S, Q, L>,
    solution: &Solution<N, S, L>,
    out: &mut Correction<N, S, Q, L>,
) {
    system.newton::<false>(solution, out);
}

/// [`Collocation::response`].
#[inline(never)]
pub(super) fn respond<const S: usize>(
    system: &Collocation<N, S, Q, L>,
    change: &Forcing<N, Q, L>,
    out: &mut Correction<N, S, Q, L>,
) {
    system.response::<false>(change, out);
}
