//! Derivatives of the polynomials of a solution at one place of an element.

use crate::directions::Side;
use crate::gauss::Gauss;
use crate::solution::Solution;

/// Weights of stages and ends at one place of an element, for the derivatives by x in [0, 1] of the polynomials through them.
#[derive(Debug, Clone, Copy)]
pub struct Derivatives<const M: usize> {
    /// Of the slopes at the stages, for the second derivative of the state.
    slope: [f64; M],
    /// Of the inner unknowns at the stages and at both ends.
    inner: ([f64; M], [f64; 2]),
    /// Of the closure slope at the stages and at the own end: first and second derivative.
    closure: [([f64; M], f64); 2],
}

/// Derivatives along the problem at one place.
#[derive(Debug, Clone, Copy)]
pub struct Along<const N: usize, const L: usize> {
    /// z''.
    pub slope: [f64; N],
    /// y'.
    pub inner: [f64; L],
    /// w'' and w'''.
    pub closure: [f64; 2],
}

impl<const M: usize> Derivatives<M> {
    /// At `x` of an element whose own end is `side`.
    pub fn new(gauss: &Gauss<M>, x: f64, side: Side) -> Self {
        /// Differences at two and four times this are exact for polynomials up to the fourth degree.
        const STEP: f64 = 0.125;
        let places = [-2.0, -1.0, 1.0, 2.0].map(|k| x + k * STEP);
        let first = |[a, b, c, d]: [f64; 4]| (8.0 * (c - b) - (d - a)) / (12.0 * STEP);
        let second =
            |middle: f64, [a, b, c, d]: [f64; 4]| (16.0 * (b + c) - 30.0 * middle - (a + d)) / (12.0 * STEP * STEP);
        let slopes = places.map(|x| gauss.cardinals(x));
        let inner = places.map(|x| gauss.cardinals_with_ends(x));
        let own = side.place();
        let closure = places.map(|x| gauss.cardinals_with_end(x, own));
        let here = gauss.cardinals_with_end(x, own);
        Self {
            slope: std::array::from_fn(|j| first(slopes.map(|w| w[j]))),
            inner: (
                std::array::from_fn(|j| first(inner.map(|w| w.0[j]))),
                std::array::from_fn(|end| first(inner.map(|w| w.1[end]))),
            ),
            closure: [
                (std::array::from_fn(|j| first(closure.map(|w| w.0[j]))), first(closure.map(|w| w.1))),
                (
                    std::array::from_fn(|j| second(here.0[j], closure.map(|w| w.0[j]))),
                    second(here.1, closure.map(|w| w.1)),
                ),
            ],
        }
    }
}

impl<const N: usize, const M: usize, const L: usize> Solution<N, M, L> {
    /// Derivatives in element `i`, of a problem with a closure variable, at the place of the weights.
    pub fn along(&self, i: usize, weights: &Derivatives<M>) -> Along<N, L> {
        let mut out = Along { slope: [0.0; N], inner: [0.0; L], closure: [0.0; 2] };
        for j in 0..M {
            let (slope, inner) = (self.slope(i, j), self.inner(i, j));
            for a in 0..N {
                out.slope[a] += weights.slope[j] * slope[a];
            }
            for a in 0..L {
                out.inner[a] += weights.inner.0[j] * inner.inner[a];
            }
            for (out, (at_stages, _)) in out.closure.iter_mut().zip(&weights.closure) {
                *out += at_stages[j] * inner.closure_slope;
            }
        }
        let side = self.directions.side(i);
        let own = self.inner_at_own_end(i);
        let mut ends = [own.inner; 2];
        ends[side.other().index()] = self.inner_at_other_end(i);
        for (end, weight) in ends.iter().zip(weights.inner.1) {
            for a in 0..L {
                out.inner[a] += weight * end[a];
            }
        }
        for (out, (_, at_own)) in out.closure.iter_mut().zip(&weights.closure) {
            *out += at_own * own.closure_slope;
        }
        let h = self.mesh.step(i);
        Along {
            slope: out.slope.map(|v| v / h),
            inner: out.inner.map(|v| v / h),
            closure: [out.closure[0] / h, out.closure[1] / (h * h)],
        }
    }
}
