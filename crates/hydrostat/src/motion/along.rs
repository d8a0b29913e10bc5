//! Integrals and least values along a moving arm.

use hydrostat_bvp::{Collocation, Groups, Lanes};

use crate::statics::dimensions::M;

/// The integral along the arm (over L) of what `density` gives in a block of stages.
pub(super) fn integral<const S: usize, const L: usize, const K: usize>(
    system: &Collocation<S, M, 0, L>,
    groups: Groups,
    density: impl Fn(usize) -> [Lanes; K],
) -> [f64; K] {
    let mut out = [0.0; K];
    for block in 0..groups.count() * M {
        let (weight, steps) = (system.gauss.b[block % M], system.steps()[block / M]);
        for (sum, density) in out.iter_mut().zip(density(block)) {
            for lane in 0..groups.filled(block / M) {
                *sum += weight * steps.0[lane] * density.0[lane];
            }
        }
    }
    out
}

/// The least value at the stages of those that `value` gives in a block of them, and its place, which it gives beside.
pub(super) fn least(groups: Groups, value: impl Fn(usize) -> [Lanes; 2]) -> [f64; 2] {
    let mut least = [f64::INFINITY, 0.0];
    for block in 0..groups.count() * M {
        let [value, place] = value(block);
        for lane in 0..groups.filled(block / M) {
            if value.0[lane] < least[0] {
                least = [value.0[lane], place.0[lane]];
            }
        }
    }
    least
}
