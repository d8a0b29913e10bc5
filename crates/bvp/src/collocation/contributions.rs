//! What each element contributes to the correction of the totals: the adjoint of the solve.

use super::Collocation;
use crate::real::{LANES, Lanes, Real};

/// Gradients of one total, kept for their memory.
#[derive(Debug, Clone, Default)]
#[allow(clippy::struct_field_names, reason = "what the gradients are by")]
pub(super) struct Adjoint<const N: usize> {
    /// By the affine part of each element.
    by_affine: Vec<[f64; N]>,
    /// By the loads of the rows of each node.
    by_rows: Vec<[f64; N]>,
    /// By the state at each node.
    by_node: Vec<[f64; N]>,
}

impl<const N: usize, const M: usize, const Q: usize> Collocation<N, M, Q> {
    /// What each element's residual contributes to the Newton correction of the totals, as the sum
    /// over the `Q` totals of absolute values: the adjoint of [`Collocation::solve`]. To it comes
    /// the change of each element's own quadratures against `before`.
    #[inline(always)]
    pub fn contributions(&mut self, before: &[[f64; Q]], out: &mut Vec<f64>) {
        let n = self.groups.elements;
        out.clear();
        out.resize(n, 0.0);
        for q in 0..Q {
            let Adjoint { by_affine, by_rows, by_node } = &mut self.adjoint;
            for (v, length) in [(by_affine, n), (by_rows, n + 1), (by_node, n + 1)] {
                v.clear();
                v.resize(length, [0.0; N]);
            }
            self.weigh_elements(q, before, out);
            self.weigh_nodes(out);
        }
    }

    /// Of total `q`, the gradients by the state at each node through its own element, and what stages and quadratures contribute.
    #[inline(always)]
    fn weigh_elements(&mut self, q: usize, before: &[[f64; Q]], out: &mut [f64]) {
        let groups = self.groups;
        for g in 0..groups.count() {
            let (stages, h) = (&self.stages[g], self.steps[g]);
            let mut own = Lanes::of(0.0);
            let mut by_z = [Lanes::of(0.0); N];
            let mut by_slopes = [[Lanes::of(0.0); N]; M];
            for j in 0..M {
                let weight = h * Lanes::of(self.gauss.b[j]);
                let local = &self.locals[g * M + j];
                own += weight * local.rate[q];
                let mut gradient = local.rate_gradient[q];
                for a in 0..N {
                    gradient[a] = gradient[a] * weight;
                    by_z[a] += gradient[a];
                }
                for l in 0..M {
                    let w = h * Lanes::of(self.gauss.a[j][l]);
                    for a in 0..N {
                        by_slopes[l][a] += w * gradient[a];
                    }
                }
            }
            for l in 0..M {
                for a in 0..N {
                    own += by_slopes[l][a] * stages.load[0][l][a];
                    for c in 0..N {
                        by_z[c] += by_slopes[l][a] * stages.response[l][a][c];
                    }
                }
            }
            for lane in 0..groups.filled(g) {
                let i = g * LANES + lane;
                self.adjoint.by_node[i] = by_z.map(|v| v.0[lane]);
                out[i] += (own.0[lane] - before[i][q]).abs();
            }
        }
    }

    /// Takes these gradients back to s = 0 and the loads of the rows on to s = 1: what the jump over each element contributes.
    #[inline(always)]
    fn weigh_nodes(&mut self, out: &mut [f64]) {
        let n = self.groups.elements;
        let right_count = self.right_count;
        let left_count = N - right_count;
        let Adjoint { by_affine, by_rows, by_node } = &mut self.adjoint;
        for i in (0..n).rev() {
            let rows = &self.rows[i + 1];
            // What the carried rows decide does not come through the transition.
            let given = by_node[i + 1];
            let mut through = given;
            for r in 0..right_count {
                let decided = given[rows.pivot[r]];
                by_rows[i + 1][r] += decided;
                for c in 0..N {
                    through[c] -= rows.rows[r][c] * decided;
                }
            }
            for r in 0..right_count {
                through[rows.pivot[r]] = 0.0;
            }
            for a in 0..N {
                by_affine[i][a] += through[a];
                for c in 0..N {
                    by_node[i][c] += self.transitions[i].by_state[a][c] * through[a];
                }
            }
        }
        for r in 0..right_count {
            for a in 0..N {
                by_rows[0][r] += self.start[a][left_count + r] * by_node[0][a];
            }
        }
        for i in 0..n {
            let mut carried = [0.0; N];
            for r in 0..right_count {
                for c in 0..N {
                    carried[c] += self.rows[i].reduction[r][c] * by_rows[i][r];
                }
            }
            for r in 0..right_count {
                by_rows[i + 1][r] += carried[r];
                for a in 0..N {
                    by_affine[i][a] -= self.rows[i + 1].rows[r][a] * carried[r];
                }
            }
            let mut total = 0.0;
            for a in 0..N {
                total += by_affine[i][a] * self.transitions[i].affine[0][a];
            }
            out[i] += total.abs();
        }
    }
}
