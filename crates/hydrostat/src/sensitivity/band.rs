//! Almost block diagonal systems: equations between neighbouring nodes, and conditions at both ends.

use crate::equilibrium::N;

/// Entries of a row left of its diagonal, and right of it before rows are exchanged.
const BELOW: usize = 4;
const ABOVE: usize = 6;
/// Entries of a row that are kept: exchanges move it to the right.
const WIDTH: usize = BELOW + 1 + ABOVE + BELOW;

/// `LU` of a matrix whose rows are: one condition at the first node, `N` equations between every two nodes, the other
/// conditions at the last one. By elimination with row pivoting, which is stable where growing and decaying solutions mix.
#[derive(Debug, Clone)]
pub(super) struct Band {
    size: usize,
    /// Row `i`, from column `i - BELOW` on.
    rows: Vec<[f64; WIDTH]>,
    pivot: Vec<usize>,
}

impl Band {
    /// `transitions[i]` leads from node `i` to the next; `left` and `right` are the gradients of the conditions.
    /// `None` where it is singular.
    pub(super) fn new(transitions: &[[[f64; N]; N]], left: &[f64; N], right: &[[f64; N]; N - 1]) -> Option<Self> {
        let n = transitions.len();
        let size = N * (n + 1);
        let mut rows = vec![[0.0; WIDTH]; size];
        let mut put = |row: usize, column: usize, value: f64| rows[row][column + BELOW - row] = value;
        for c in 0..N {
            put(0, c, left[c]);
        }
        for (i, by) in transitions.iter().enumerate() {
            for a in 0..N {
                let row = 1 + N * i + a;
                put(row, N * (i + 1) + a, 1.0);
                for c in 0..N {
                    put(row, N * i + c, -by[a][c]);
                }
            }
        }
        for (r, by) in right.iter().enumerate() {
            for c in 0..N {
                put(1 + N * n + r, N * n + c, by[c]);
            }
        }
        let mut this = Self { size, rows, pivot: (0..size).collect() };
        this.factorise().then_some(this)
    }

    fn factorise(&mut self) -> bool {
        for k in 0..self.size {
            let last = (k + BELOW).min(self.size - 1);
            let entry = |rows: &[[f64; WIDTH]], i: usize| rows[i][k + BELOW - i];
            let best = (k..=last)
                .max_by(|i, j| entry(&self.rows, *i).abs().total_cmp(&entry(&self.rows, *j).abs()))
                .unwrap_or(k);
            let pivot = entry(&self.rows, best);
            if pivot == 0.0 || !pivot.is_finite() {
                return false;
            }
            self.pivot[k] = best;
            let reach = (WIDTH - BELOW).min(self.size - k);
            if best != k {
                let shift = best - k;
                for c in 0..reach {
                    // Column k + c of either row.
                    let other = c + BELOW - shift;
                    let (a, b) = (self.rows[k][c + BELOW], self.rows[best][other]);
                    self.rows[k][c + BELOW] = b;
                    self.rows[best][other] = a;
                }
            }
            let own = self.rows[k];
            for i in k + 1..=last {
                let at = k + BELOW - i;
                let factor = self.rows[i][at] / pivot;
                self.rows[i][at] = factor;
                if factor != 0.0 {
                    for c in 1..reach {
                        self.rows[i][at + c] -= factor * own[c + BELOW];
                    }
                }
            }
        }
        true
    }

    /// Solves for `right` in place.
    pub(super) fn solve(&self, right: &mut [f64]) {
        for k in 0..self.size {
            right.swap(k, self.pivot[k]);
            let own = right[k];
            for i in k + 1..=(k + BELOW).min(self.size - 1) {
                right[i] -= self.rows[i][k + BELOW - i] * own;
            }
        }
        for k in (0..self.size).rev() {
            let mut sum = right[k];
            for c in 1..(WIDTH - BELOW).min(self.size - k) {
                sum -= self.rows[k][c + BELOW] * right[k + c];
            }
            right[k] = sum / self.rows[k][BELOW];
        }
    }

    /// Solves the transposed system for `right` in place.
    pub(super) fn solve_transposed(&self, right: &mut [f64]) {
        for k in 0..self.size {
            right[k] /= self.rows[k][BELOW];
            let own = right[k];
            for c in 1..(WIDTH - BELOW).min(self.size - k) {
                right[k + c] -= self.rows[k][c + BELOW] * own;
            }
        }
        for k in (0..self.size).rev() {
            for i in k + 1..=(k + BELOW).min(self.size - 1) {
                right[k] -= self.rows[i][k + BELOW - i] * right[i];
            }
            right.swap(k, self.pivot[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A system in which solutions grow and decay by 1e4 an element: residuals of both solves, and one against the other.
    #[test]
    fn both_solves_leave_nothing_and_agree() {
        let n = 12;
        let transitions: Vec<[[f64; N]; N]> = (0..n)
            .map(|i| {
                let mut by = [[0.0; N]; N];
                for (a, scale) in [1.0, 1e4, 1e-4, -2.0].into_iter().enumerate() {
                    for c in 0..N {
                        let other = ((3 * i + 5 * a + 7 * c) as f64).sin();
                        by[a][c] = scale * (if a == c { 1.0 } else { 0.0 } + 0.3 * other);
                    }
                }
                by
            })
            .collect();
        let left = [1.0, 0.2, -0.1, 0.0];
        let right = [[0.3, 1.0, 0.0, 0.1], [0.0, 0.2, 1.0, 0.0], [0.1, 0.0, 0.0, 1.0]];
        let band = Band::new(&transitions, &left, &right).unwrap();
        let size = N * (n + 1);
        let apply = |x: &[f64]| {
            let mut out = vec![0.0; size];
            out[0] = (0..N).map(|c| left[c] * x[c]).sum();
            for (i, by) in transitions.iter().enumerate() {
                for a in 0..N {
                    let carried: f64 = (0..N).map(|c| by[a][c] * x[N * i + c]).sum();
                    out[1 + N * i + a] = x[N * (i + 1) + a] - carried;
                }
            }
            for (r, by) in right.iter().enumerate() {
                out[1 + N * n + r] = (0..N).map(|c| by[c] * x[N * n + c]).sum();
            }
            out
        };
        let given: Vec<f64> = (0..size).map(|k| (1.7 * k as f64).cos()).collect();
        let mut x = given.clone();
        band.solve(&mut x);
        let largest = x.iter().fold(1.0, |m: f64, v| m.max(v.abs()));
        for (got, want) in apply(&x).iter().zip(&given) {
            assert!((got - want).abs() < 1e-10 * largest, "{got} {want}");
        }
        // w . A^-1 g = (A^-T w) . g.
        let weights: Vec<f64> = (0..size).map(|k| (0.9 * k as f64).sin()).collect();
        let mut y = weights.clone();
        band.solve_transposed(&mut y);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (forward, adjoint) = (dot(&weights, &x), dot(&y, &given));
        assert!((forward - adjoint).abs() < 1e-11 * forward.abs().max(1.0), "{forward} {adjoint}");
    }

    #[test]
    fn what_is_singular_is_refused() {
        let turn = [[0.0; N]; N];
        assert!(Band::new(&[turn], &[0.0; N], &[[0.0; N]; N - 1]).is_none());
    }
}
