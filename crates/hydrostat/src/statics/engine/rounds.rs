//! What is compiled for the widest vectors: evaluation, linearisation, corrections.

use hydrostat_bvp::{Collocation, Correction, Forcing, LinearisationError, Solution};

use crate::numerics::dispatch::{Work, dispatch};
use crate::statics::dimensions::{L, N, Q};
use crate::statics::equations::{Equations, SectionFailure};

struct Evaluate<'a, const S: usize>(&'a mut Collocation<N, S, Q, L>, &'a Equations, &'a Solution<N, S, L>);

impl<const S: usize> Work for Evaluate<'_, S> {
    type Output = Result<(), SectionFailure>;
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        self.0.evaluate::<_, FUSED>(self.1, self.2)
    }
}

struct Linearise<'a, const S: usize>(&'a mut Collocation<N, S, Q, L>, &'a Equations, &'a Solution<N, S, L>);

impl<const S: usize> Work for Linearise<'_, S> {
    type Output = Result<(), LinearisationError<SectionFailure>>;
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        self.0.linearise::<_, FUSED>(self.1, self.2)
    }
}

struct Correct<'a, const S: usize>(
    &'a mut Collocation<N, S, Q, L>,
    &'a Solution<N, S, L>,
    &'a mut Correction<N, S, Q, L>,
);

impl<const S: usize> Work for Correct<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.0.newton::<FUSED>(self.1, self.2);
    }
}

struct Respond<'a, const S: usize>(&'a Collocation<N, S, Q, L>, &'a Forcing<N, Q, L>, &'a mut Correction<N, S, Q, L>);

impl<const S: usize> Work for Respond<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.0.response::<FUSED>(self.1, self.2);
    }
}

/// [`Collocation::evaluate`].
pub(crate) fn evaluate<const S: usize>(
    system: &mut Collocation<N, S, Q, L>,
    equations: &Equations,
    solution: &Solution<N, S, L>,
) -> Result<(), SectionFailure> {
    dispatch(Evaluate(system, equations, solution))
}

/// [`Collocation::linearise`].
pub(crate) fn linearise<const S: usize>(
    system: &mut Collocation<N, S, Q, L>,
    equations: &Equations,
    solution: &Solution<N, S, L>,
) -> Result<(), LinearisationError<SectionFailure>> {
    dispatch(Linearise(system, equations, solution))
}

/// [`Collocation::newton`].
pub(crate) fn correct<const S: usize>(
    system: &mut Collocation<N, S, Q, L>,
    solution: &Solution<N, S, L>,
    out: &mut Correction<N, S, Q, L>,
) {
    dispatch(Correct(system, solution, out));
}

/// [`Collocation::response`].
pub(crate) fn respond<const S: usize>(
    system: &Collocation<N, S, Q, L>,
    change: &Forcing<N, Q, L>,
    out: &mut Correction<N, S, Q, L>,
) {
    dispatch(Respond(system, change, out));
}
