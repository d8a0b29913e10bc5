//! Evaluation, linearisation and correction in the processor's widest vectors.

use hydrostat_bvp::{Collocation, Correction, RoundError, Singular, Solution};

use crate::dispatch::{Work, dispatch, widest};
use crate::equilibrium::{Equations, N, Q, SectionFailure};

struct Evaluate<'a, const S: usize> {
    system: &'a mut Collocation<N, S, Q>,
    equations: &'a mut Equations,
    solution: &'a Solution<N, S>,
}

impl<const S: usize> Work for Evaluate<'_, S> {
    type Output = Result<(), SectionFailure>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        self.system.evaluate_with::<_, FUSED>(self.equations, self.solution)
    }
}

/// [`Collocation::evaluate`] in the processor's widest vectors.
pub(crate) fn evaluate<const S: usize>(
    system: &mut Collocation<N, S, Q>,
    equations: &mut Equations,
    solution: &Solution<N, S>,
) -> Result<(), SectionFailure> {
    dispatch(Evaluate { system, equations, solution })
}

struct Factorise<'a, const S: usize> {
    system: &'a mut Collocation<N, S, Q>,
    equations: &'a mut Equations,
    solution: &'a Solution<N, S>,
    parameter: bool,
}

impl<const S: usize> Work for Factorise<'_, S> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        let Self { system, equations, solution, parameter } = self;
        system.factorise_with::<_, FUSED>(equations, solution, parameter)
    }
}

/// [`Collocation::linearise`] in the processor's widest vectors.
pub(crate) fn linearise<const S: usize>(
    system: &mut Collocation<N, S, Q>,
    equations: &mut Equations,
    solution: &Solution<N, S>,
    parameter: bool,
) -> Result<(), RoundError<SectionFailure>> {
    evaluate(system, equations, solution).map_err(RoundError::Slopes)?;
    dispatch(Factorise { system, equations, solution, parameter }).map_err(RoundError::Singular)
}

/// [`Collocation::solve`] in the processor's widest vectors.
pub(crate) fn solve<const S: usize>(
    system: &Collocation<N, S, Q>,
    solution: &Solution<N, S>,
    column: usize,
    correction: &mut Correction<N, S, Q>,
) {
    widest(
        #[inline(always)]
        || system.solve(solution, column, correction),
    );
}
