//! The differentiated equations of one element: its stages eliminated.

use hydrostat_bvp::Gauss;

use super::linear::{StageWeights, dot};
use crate::beta_along::Rule;
use crate::elimination::solve_in_place;
use crate::engine::M;
use crate::equilibrium::{BY, ByState, CLOSED, N, OUT, Q, RATE, VALUE};

/// Stage slopes of an element.
pub(super) const SLOPES: usize = N * M;

pub(super) struct Element {
    pub(super) h: f64,
    /// Derivatives at the stages.
    pub(super) rate: [[[f64; BY]; Q]; M],
    pub(super) value: [[f64; BY]; M],
    pub(super) slope_by_beta: [[f64; N]; M],
    /// beta' at the stages by the states there, and by the drifts of the closed form and of beta.
    pub(super) inner: [[f64; SLOPES]; M],
    pub(super) by_closed: [[f64; M]; M],
    pub(super) by_value: [[f64; M]; M],
    /// The same by the beta that is carried into the element, if one is.
    pub(super) by_known: [f64; M],
    /// Of the stage equations.
    pub(super) inverse: [[f64; SLOPES]; SLOPES],
    /// Stage slopes by the state at the left node.
    pub(super) response: [[f64; N]; SLOPES],
}

impl Element {
    #[inline(always)]
    pub(super) fn new(gauss: &Gauss<M>, h: f64, stations: &[ByState; M], rule: Rule) -> Option<Self> {
        let row = |j: usize, out: usize| -> [f64; BY] { stations[j].by[out] };
        let value: [[f64; BY]; M] = std::array::from_fn(|j| row(j, VALUE));
        let right = beta_slopes(h, stations, &value, rule)?;
        let part = |from: usize| std::array::from_fn(|j| std::array::from_fn(|l| right[j][from + l]));
        let (by_closed, by_value) = (part(SLOPES), part(SLOPES + M));
        let by_known = std::array::from_fn(|j| right[j][SLOPES + 2 * M]);
        let inner: [[f64; SLOPES]; M] = std::array::from_fn(|j| std::array::from_fn(|c| right[j][c]));
        let mut slope_by_beta = [[0.0; N]; M];
        // J = F_z + F_b inner, by all states of the element.
        let mut jacobian = [[0.0; SLOPES]; SLOPES];
        for j in 0..M {
            for a in 0..N {
                let by = row(j, a);
                slope_by_beta[j][a] = by[N];
                let own = &mut jacobian[N * j + a];
                for c in 0..SLOPES {
                    own[c] = by[N] * inner[j][c];
                }
                for c in 0..N {
                    own[N * j + c] += by[c];
                }
            }
        }
        let mut matrix = [[0.0; SLOPES]; SLOPES];
        let mut right = [[0.0; SLOPES + N]; SLOPES];
        for r in 0..SLOPES {
            matrix[r][r] = 1.0;
            right[r][r] = 1.0;
            for j in 0..M {
                for c in 0..N {
                    let by = jacobian[r][N * j + c];
                    right[r][SLOPES + c] += by;
                    for l in 0..M {
                        matrix[r][N * l + c] -= h * gauss.a[j][l] * by;
                    }
                }
            }
        }
        if !solve_in_place(&mut matrix, &mut right, 0.0) {
            return None;
        }
        Some(Self {
            h,
            rate: std::array::from_fn(|j| std::array::from_fn(|q| row(j, RATE + q))),
            value,
            slope_by_beta,
            inner,
            by_closed,
            by_value,
            by_known,
            inverse: std::array::from_fn(|r| std::array::from_fn(|c| right[r][c])),
            response: std::array::from_fn(|r| std::array::from_fn(|c| right[r][SLOPES + c])),
        })
    }

    pub(super) fn transition(&self, gauss: &Gauss<M>) -> [[f64; N]; N] {
        let mut out = [[0.0; N]; N];
        for a in 0..N {
            out[a][a] = 1.0;
            for (l, weight) in gauss.b.iter().enumerate() {
                for c in 0..N {
                    out[a][c] += self.h * weight * self.response[N * l + a][c];
                }
            }
        }
        out
    }

    /// beta' and the stage slopes by a drift, and the beta that is carried into the element, alone.
    pub(super) fn own(&self, drift: Option<&[[f64; OUT]; M]>, known: Option<&f64>) -> ([f64; M], [f64; SLOPES]) {
        let mut beta = self.by_known.map(|by| by * known.unwrap_or(&0.0));
        if let Some(drift) = drift {
            for j in 0..M {
                for l in 0..M {
                    beta[j] += self.by_closed[j][l] * drift[l][CLOSED] + self.by_value[j][l] * drift[l][VALUE];
                }
            }
        }
        let mut given = [0.0; SLOPES];
        for j in 0..M {
            for a in 0..N {
                given[N * j + a] = drift.map_or(0.0, |drift| drift[j][a]) + self.slope_by_beta[j][a] * beta[j];
            }
        }
        (beta, std::array::from_fn(|r| dot(&self.inverse[r], &given)))
    }

    /// State and beta' at the stages, given the state at the left node and what a drift adds.
    pub(super) fn stages(
        &self,
        gauss: &Gauss<M>,
        z: &[f64; N],
        (beta, slopes): &([f64; M], [f64; SLOPES]),
    ) -> [[f64; BY]; M] {
        let k: [f64; SLOPES] = std::array::from_fn(|r| slopes[r] + dot(&self.response[r], z));
        let mut states = [0.0; SLOPES];
        for j in 0..M {
            for a in 0..N {
                let inside: f64 = (0..M).map(|l| gauss.a[j][l] * k[N * l + a]).sum();
                states[N * j + a] = z[a] + self.h * inside;
            }
        }
        std::array::from_fn(|j| {
            let mut out = [0.0; BY];
            out[..N].copy_from_slice(&states[N * j..N * (j + 1)]);
            out[N] = beta[j] + dot(&self.inner[j], &states);
            out
        })
    }

    /// Weights at the stages as weights on the state at the left node, and on the stage slopes.
    pub(super) fn back(&self, gauss: &Gauss<M>, weights: &[StageWeights; M]) -> ([f64; N], [f64; SLOPES]) {
        let mut by_state = [0.0; SLOPES];
        for (j, w) in weights.iter().enumerate() {
            for a in 0..N {
                by_state[N * j + a] += w.z[a];
            }
            for (by, inner) in by_state.iter_mut().zip(&self.inner[j]) {
                *by += w.beta_slope * inner;
            }
        }
        let mut by_slopes = [0.0; SLOPES];
        let mut by_node = [0.0; N];
        for j in 0..M {
            for a in 0..N {
                let by = by_state[N * j + a];
                by_node[a] += by;
                for l in 0..M {
                    by_slopes[N * l + a] += self.h * gauss.a[j][l] * by;
                }
            }
        }
        for (by, response) in by_slopes.iter().zip(&self.response) {
            for a in 0..N {
                by_node[a] += by * response[a];
            }
        }
        (by_node, by_slopes)
    }

    /// Weights on the stage slopes and at the stages as weights on the drifts.
    pub(super) fn cotangent(&self, weights: &[StageWeights; M], by_slopes: &[f64; SLOPES], out: &mut [[f64; OUT]]) {
        let mut by_given = [0.0; SLOPES];
        for (by, row) in by_slopes.iter().zip(&self.inverse) {
            for (given, inverse) in by_given.iter_mut().zip(row) {
                *given += by * inverse;
            }
        }
        let mut by_beta = [0.0; M];
        for (j, w) in weights.iter().enumerate() {
            out[j] = w.direct;
            by_beta[j] = w.beta_slope;
            for a in 0..N {
                out[j][a] += by_given[N * j + a];
                by_beta[j] += self.slope_by_beta[j][a] * by_given[N * j + a];
            }
        }
        for j in 0..M {
            for l in 0..M {
                out[l][CLOSED] += by_beta[j] * self.by_closed[j][l];
                out[l][VALUE] += by_beta[j] * self.by_value[j][l];
            }
        }
    }
}

/// Columns of beta' at the stages of an element: by the states there, by the drifts of the closed form and of beta, and by the beta that is carried
/// into it. From (1 - ...) b = ... dz + drifts.
#[inline(always)]
fn beta_slopes(
    h: f64,
    stations: &[ByState; M],
    value: &[[f64; BY]; M],
    rule: Rule,
) -> Option<[[f64; SLOPES + 2 * M + 1]; M]> {
    let inverse = 1.0 / h;
    let mut matrix = [[0.0; M]; M];
    let mut right = [[0.0; SLOPES + 2 * M + 1]; M];
    for j in 0..M {
        let reach = stations[j].reach;
        matrix[j][j] = 1.0;
        let mut on_value = [0.0; M];
        match rule {
            Rule::Sharp(by_value, by_slope) => {
                for l in 0..M {
                    on_value[l] = reach * by_value[j][l] * inverse * inverse;
                    matrix[j][l] -= reach * by_slope[j][l] * inverse;
                }
            }
            Rule::Plain(d) => {
                for l in 0..M {
                    matrix[j][l] -= reach * d[j][l] * inverse;
                }
            }
            Rule::Own(d) => {
                for l in 0..M {
                    on_value[l] = d[j][l] * inverse;
                }
            }
            Rule::Carried(by, _) => {
                for l in 0..M {
                    matrix[j][l] = h * by.since_known(j, l);
                }
                on_value[j] = 1.0;
                right[j][SLOPES + 2 * M] = -1.0;
            }
        }
        if !matches!(rule, Rule::Own(_) | Rule::Carried(..)) {
            matrix[j][j] -= stations[j].by[CLOSED][N];
            for a in 0..N {
                right[j][N * j + a] += stations[j].by[CLOSED][a];
            }
            right[j][SLOPES + j] = 1.0;
        }
        for l in 0..M {
            matrix[j][l] -= on_value[l] * value[l][N];
            for a in 0..N {
                right[j][N * l + a] += on_value[l] * value[l][a];
            }
            right[j][SLOPES + M + l] = on_value[l];
        }
    }
    solve_in_place(&mut matrix, &mut right, 0.0).then_some(right)
}
