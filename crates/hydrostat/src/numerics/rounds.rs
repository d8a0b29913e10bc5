//! Rounds of the collocation, compiled for the widest vectors: evaluation, linearisation, corrections.

use hydrostat_bvp::{Collocation, Correction, Forcing, LinearisationError, Problem, Solution};

use super::dispatch::{Work, dispatch};

struct Evaluate<'a, P, const N: usize, const S: usize, const Q: usize, const L: usize>(
    &'a mut Collocation<N, S, Q, L>,
    &'a P,
    &'a Solution<N, S, L>,
);

impl<P: Problem<N, Q, L>, const N: usize, const S: usize, const Q: usize, const L: usize> Work
    for Evaluate<'_, P, N, S, Q, L>
{
    type Output = Result<(), P::Failure>;
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        self.0.evaluate::<_, FUSED>(self.1, self.2)
    }
}

struct Linearise<'a, P, const N: usize, const S: usize, const Q: usize, const L: usize>(
    &'a mut Collocation<N, S, Q, L>,
    &'a P,
    &'a Solution<N, S, L>,
);

impl<P: Problem<N, Q, L>, const N: usize, const S: usize, const Q: usize, const L: usize> Work
    for Linearise<'_, P, N, S, Q, L>
{
    type Output = Result<(), LinearisationError<P::Failure>>;
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        self.0.linearise::<_, FUSED>(self.1, self.2)
    }
}

struct Simplify<'a, P, const N: usize, const S: usize, const Q: usize, const L: usize>(
    &'a mut Collocation<N, S, Q, L>,
    &'a P,
    &'a Solution<N, S, L>,
);

impl<P: Problem<N, Q, L>, const N: usize, const S: usize, const Q: usize, const L: usize> Work
    for Simplify<'_, P, N, S, Q, L>
{
    type Output = Result<(), P::Failure>;
    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        self.0.simplify::<_, FUSED>(self.1, self.2)
    }
}

struct Correct<'a, const N: usize, const S: usize, const Q: usize, const L: usize>(
    &'a mut Collocation<N, S, Q, L>,
    &'a Solution<N, S, L>,
    &'a mut Correction<N, S, Q, L>,
);

impl<const N: usize, const S: usize, const Q: usize, const L: usize> Work for Correct<'_, N, S, Q, L> {
    type Output = ();
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.0.newton::<FUSED>(self.1, self.2);
    }
}

struct Respond<'a, const N: usize, const S: usize, const Q: usize, const L: usize>(
    &'a Collocation<N, S, Q, L>,
    &'a Forcing<N, Q, L>,
    &'a mut Correction<N, S, Q, L>,
);

impl<const N: usize, const S: usize, const Q: usize, const L: usize> Work for Respond<'_, N, S, Q, L> {
    type Output = ();
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.0.response::<FUSED>(self.1, self.2);
    }
}

/// [`Collocation::evaluate`].
#[inline(never)]
pub(crate) fn evaluate<P: Problem<N, Q, L>, const N: usize, const S: usize, const Q: usize, const L: usize>(
    system: &mut Collocation<N, S, Q, L>,
    problem: &P,
    solution: &Solution<N, S, L>,
) -> Result<(), P::Failure> {
    dispatch(Evaluate(system, problem, solution))
}

/// [`Collocation::linearise`].
#[inline(never)]
pub(crate) fn linearise<P: Problem<N, Q, L>, const N: usize, const S: usize, const Q: usize, const L: usize>(
    system: &mut Collocation<N, S, Q, L>,
    problem: &P,
    solution: &Solution<N, S, L>,
) -> Result<(), LinearisationError<P::Failure>> {
    dispatch(Linearise(system, problem, solution))
}

/// [`Collocation::simplify`].
#[inline(never)]
pub(crate) fn simplify<P: Problem<N, Q, L>, const N: usize, const S: usize, const Q: usize, const L: usize>(
    system: &mut Collocation<N, S, Q, L>,
    problem: &P,
    solution: &Solution<N, S, L>,
) -> Result<(), P::Failure> {
    dispatch(Simplify(system, problem, solution))
}

/// [`Collocation::newton`].
#[inline(never)]
pub(crate) fn correct<const N: usize, const S: usize, const Q: usize, const L: usize>(
    system: &mut Collocation<N, S, Q, L>,
    solution: &Solution<N, S, L>,
    out: &mut Correction<N, S, Q, L>,
) {
    dispatch(Correct(system, solution, out));
}

/// [`Collocation::response`].
#[inline(never)]
pub(crate) fn respond<const N: usize, const S: usize, const Q: usize, const L: usize>(
    system: &Collocation<N, S, Q, L>,
    change: &Forcing<N, Q, L>,
    out: &mut Correction<N, S, Q, L>,
) {
    dispatch(Respond(system, change, out));
}
