//! What outputs at a place begin with: the element's polynomials there, and a beta' as sharp as the state.

use std::sync::LazyLock;

use hydrostat_bvp::{Along, Derivatives, Gauss, LANES, Side};

use crate::statics::dimensions::{Guess, M, N};
use crate::statics::equations::{Equations, SectionQuery, SectionState};

/// What is known at `x` in [0, 1] of element `i`, where the state is `z`.
pub(crate) fn asked_in(solution: &Guess, gauss: &Gauss<M>, i: usize, x: f64, z: [f64; N]) -> SectionQuery {
    let known = solution.inner_in(gauss, i, x);
    let s = if x == 1.0 { solution.mesh.nodes()[i + 1] } else { solution.mesh.nodes()[i] + x * solution.mesh.step(i) };
    SectionQuery { s, from_left: x > 0.0, z, strain: known.inner, beta_slope: known.closure_slope }
}

/// The reach of beta' over an element's length up to which the section law gives beta' better than the element's
/// polynomial.
const SHORT_REACH: f64 = 0.05;

/// At the left and the right end of an element, by its own end.
static AT_ENDS: LazyLock<[[Derivatives<M>; 2]; 2]> = LazyLock::new(|| {
    let gauss = Gauss::new();
    [0.0, 1.0].map(|x| [Side::Left, Side::Right].map(|side| Derivatives::new(&gauss, x, side)))
});

/// The same with the beta' that follows from the section law along the arm, given everything at the place with the
/// beta' of the polynomial.
///
/// beta' at the end of a polynomial of degree M + 1 is right to order M only. With beta = g(s, z, beta') the section
/// law,
///
/// ```text
/// beta' = g_s + g_z z' + r beta''        r = dg/d beta'
/// ```
///
/// at each place, where the reach r is mostly some micrometres: how beta'' is known hardly counts. Both are derivatives
/// of g along the arm, by its values here and at three places inside the element, where beta' follows a line; beta''
/// with r times the beta''' of the polynomial beside. Where the first time changes much, a second time begins with its
/// beta' and beta''.
#[inline(always)]
pub(crate) fn sharpened(
    equations: &Equations,
    solution: &Guess,
    gauss: &Gauss<M>,
    (i, x): (usize, f64),
    asked: SectionQuery,
    here: &SectionState,
) -> SectionQuery {
    const STEP: f64 = 1e-3;
    const REACH_STEP: f64 = 1e-4;
    /// Change of beta' by the first time, times the reach over the element's length, below which a second time changes
    /// less than the differences are known to.
    const ONCE: f64 = 1e-10;
    if !solution.directions.is_closed() {
        return asked;
    }
    let h = solution.mesh.step(i);
    let step = if x > 0.5 { -STEP * h } else { STEP * h };
    let side = solution.directions.side(i);
    let there = |end: usize| solution.along(i, &AT_ENDS[end][side.index()]);
    let Along { slope: bend, inner: turn, closure: [curvature, bend_of_slope] } = match x {
        0.0 => there(0),
        1.0 => there(1),
        x => solution.along(i, &Derivatives::new(gauss, x, side)),
    };
    let along = |k: f64, beta_slope: f64, curvature: f64| {
        let d = k * step;
        let z = std::array::from_fn(|a| asked.z[a] + d * (here.slope[a] + 0.5 * d * bend[a]));
        let beta_slope = beta_slope + d * curvature;
        let strain = std::array::from_fn(|k| here.strain[k] + d * turn[k]);
        SectionQuery { s: asked.s + d, from_left: asked.from_left && k == 0.0, z, strain, beta_slope }
    };
    // beta' and beta'' from beta here and further on.
    let slopes_of = |[a, b, c, d]: [f64; LANES], reach: f64| {
        let slope = (18.0 * b - 9.0 * c + 2.0 * d - 11.0 * a) / (6.0 * step);
        (slope, (2.0 * a - 5.0 * b + 4.0 * c - d) / (step * step) + reach * bend_of_slope)
    };
    let push = REACH_STEP * asked.beta_slope.abs().max(1.0);
    let pushed = SectionQuery { beta_slope: asked.beta_slope + push, strain: here.strain, ..asked };
    let [first, second, third] = [1.0, 2.0, 3.0].map(|k| along(k, asked.beta_slope, curvature));
    let Some([one, two, three, pushed]) = equations.beta_at(&[first, second, third, pushed]) else { return asked };
    let reach = (pushed - here.beta) / push;
    if reach.abs() > SHORT_REACH * h {
        return asked;
    }
    let (slope, curved) = slopes_of([here.beta, one, two, three], reach);
    let (slope, curvature) = (slope + reach * (curved - curvature), curved);
    if (reach / h * (slope - asked.beta_slope)).abs() < ONCE {
        return SectionQuery { beta_slope: slope, strain: here.strain, ..asked };
    }
    let Some(again) = equations.beta_at(&[0.0, 1.0, 2.0, 3.0].map(|k| along(k, slope, curvature))) else {
        return asked;
    };
    let (slope, curved) = slopes_of(again, reach);
    SectionQuery { beta_slope: slope + reach * (curved - curvature), strain: here.strain, ..asked }
}
