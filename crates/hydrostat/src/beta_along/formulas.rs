//! The formulas that join beta, beta' and beta'' at the stages of an element.

use hydrostat_bvp::{Gauss, LANES, Lanes, Real};

use super::carried::Carried;
use crate::elimination::solve_in_place;

/// No method here has more stages.
pub(super) const MOST_STAGES: usize = 5;

pub(super) const ZERO: Lanes = Lanes([0.0; LANES]);
pub(super) const ONE: Lanes = Lanes([1.0; LANES]);

/// Numbers by two stages.
pub(crate) type Weights = [[f64; MOST_STAGES]; MOST_STAGES];

/// How beta' and beta'' of an element hang together once rounds have converged, with weights by two stages for a length of one.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Rule<'a> {
    /// beta' by the closed form, beta'' from the polynomial through beta (weights 0) and beta' (1).
    Sharp(&'a Weights, &'a Weights),
    /// beta' by the closed form, beta'' from the polynomial through beta'.
    Plain(&'a Weights),
    /// beta' from the polynomial through beta, beta'' from that through beta'.
    Own(&'a Weights),
    /// beta' such that beta goes on from a neighbour's, beta'' from the polynomial through beta'.
    Carried(Carried<'a>, &'a Weights),
}

/// Weights that give beta'' at the stages of an element of length one.
#[derive(Debug, Clone)]
pub(super) struct Differentiation {
    /// From the polynomial through beta and beta' at all stages.
    pub(super) by_value: Weights,
    pub(super) by_slope: Weights,
    /// From the polynomial through beta'.
    pub(super) plain: Weights,
    /// Largest row sum of `by_slope`: how it amplifies what beta' is off by.
    pub(super) hermite_gain: f64,
    /// Integrals of the polynomial through beta' over an element, and from its left end to each stage.
    pub(super) whole: [f64; MOST_STAGES],
    pub(super) upto: Weights,
    /// beta at the left and right end, from the polynomial through beta and beta' at all stages.
    pub(super) ends: [[[f64; MOST_STAGES]; 2]; 2],
}

impl Differentiation {
    pub(super) fn new<const M: usize>(gauss: &Gauss<M>) -> Self {
        const { assert!(M == 4 || M == 5, "BetaAlong::close is compiled for these") };
        let row = |v: &[f64; M]| {
            let mut out = [0.0; MOST_STAGES];
            out[..M].copy_from_slice(v);
            out
        };
        let weights = |m: &[[f64; M]; M]| {
            let mut out = [[0.0; MOST_STAGES]; MOST_STAGES];
            for j in 0..M {
                out[j][..M].copy_from_slice(&m[j]);
            }
            out
        };
        let rows = gauss.hermite[1].iter().map(|row| row.iter().map(|v| v.abs()).sum::<f64>());
        Self {
            hermite_gain: rows.fold(0.0, f64::max),
            by_value: weights(&gauss.hermite[0]),
            by_slope: weights(&gauss.hermite[1]),
            plain: weights(&gauss.d),
            whole: row(&gauss.b),
            upto: weights(&gauss.a),
            ends: gauss.ends.map(|end| end.value.map(|weights| row(&weights))),
        }
    }

    /// Largest `reach` over the step, `inverse` being one over that, times the gain.
    #[inline(always)]
    pub(super) fn sharpness<const M: usize>(&self, reach: &[Lanes; M], inverse: Lanes) -> Lanes {
        let mut largest = ZERO;
        for reach in reach {
            largest = largest.max(reach.abs());
        }
        largest * inverse * Lanes::of(self.hermite_gain)
    }

    /// The second derivative of what has these values and slopes at the stages.
    #[inline(always)]
    pub(super) fn second_derivative<const M: usize>(
        &self,
        value: &[Lanes; M],
        slope: &[Lanes; M],
        inverse: Lanes,
    ) -> [Lanes; M] {
        let over_step: [Lanes; M] = each_stage(|l| value[l] * inverse);
        each_stage(|j| {
            let mut sum = ZERO;
            for l in 0..M {
                sum += Lanes::of(self.by_value[j][l]) * over_step[l] + Lanes::of(self.by_slope[j][l]) * slope[l];
            }
            sum * inverse
        })
    }
}

/// The largest pivot that counts as zero.
const SMALLEST: f64 = 1e-12;

/// Solves the equations; where they are singular, `otherwise`.
#[inline(always)]
pub(super) fn solve_small<const M: usize>(
    matrix: &[[Lanes; M]; M],
    right: &[Lanes; M],
    otherwise: &[Lanes; M],
) -> [Lanes; M] {
    let (mut a, mut out) = (*matrix, *right);
    let mut fine = ONE;
    for k in 0..M {
        let pivot = a[k][k].abs();
        fine = Lanes::of(SMALLEST).if_less(pivot, fine, ZERO);
        for i in k + 1..M {
            fine = pivot.if_less(Lanes::of(0.1) * a[i][k].abs(), ZERO, fine);
        }
        let scale = ONE / a[k][k];
        for c in k + 1..M {
            a[k][c] = a[k][c] * scale;
        }
        out[k] = out[k] * scale;
        for i in 0..M {
            if i != k {
                let f = a[i][k];
                for c in k + 1..M {
                    a[i][c] -= f * a[k][c];
                }
                let own = out[k];
                out[i] -= f * own;
            }
        }
    }
    if !(-fine).all_below(0.0) {
        for lane in 0..LANES {
            if fine.0[lane] == 0.0 {
                solve_lane(matrix, right, lane, otherwise, &mut out);
            }
        }
    }
    out
}

/// [`solve_small`] in one lane, with row pivoting.
#[cold]
#[inline(never)]
fn solve_lane<const M: usize>(
    matrix: &[[Lanes; M]; M],
    right: &[Lanes; M],
    lane: usize,
    otherwise: &[Lanes; M],
    out: &mut [Lanes; M],
) {
    let mut own = matrix.map(|row| row.map(|v| v.0[lane]));
    let mut solved = right.map(|v| [v.0[lane]]);
    let fine = solve_in_place(&mut own, &mut solved, SMALLEST);
    for j in 0..M {
        out[j].0[lane] = if fine { solved[j][0] } else { otherwise[j].0[lane] };
    }
}

/// A number for every stage.
#[inline(always)]
pub(super) fn each_stage<const M: usize>(mut f: impl FnMut(usize) -> Lanes) -> [Lanes; M] {
    let mut out = [ZERO; M];
    for j in 0..M {
        out[j] = f(j);
    }
    out
}
