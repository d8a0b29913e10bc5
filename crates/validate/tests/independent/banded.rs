//! Linear equations with a band of entries, by elimination with partial pivoting.

/// A square matrix whose entries stand at most `below` under and `above` over the diagonal.
pub(crate) struct Banded {
    below: usize,
    width: usize,
    /// Row by row; what stands in column `c` of row `r` is at `c + below - r`.
    rows: Vec<Vec<f64>>,
}

impl Banded {
    pub(crate) fn new(size: usize, below: usize, above: usize) -> Self {
        // Exchanged rows reach further to the right.
        let width = 2 * below + above + 1;
        Self { below, width, rows: vec![vec![0.0; width]; size] }
    }

    pub(crate) fn set(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row][column + self.below - row] = value;
    }

    /// Factors, kept with the pivots; `None` if it is singular.
    pub(crate) fn factor(mut self) -> Option<Factors> {
        let size = self.rows.len();
        let (below, width) = (self.below, self.width);
        let mut pivots = Vec::with_capacity(size);
        let mut multipliers = Vec::with_capacity(size);
        for k in 0..size {
            let last = (k + below).min(size - 1);
            let lead = |r: usize, rows: &[Vec<f64>]| rows[r][k + below - r].abs();
            let pivot = (k..=last).max_by(|i, j| lead(*i, &self.rows).total_cmp(&lead(*j, &self.rows)))?;
            let largest = lead(pivot, &self.rows);
            if largest == 0.0 || !largest.is_finite() {
                return None;
            }
            if pivot != k {
                // Both rows by column, so that they can change places.
                for c in k..(k + width - below).min(size) {
                    let (own, other) = (c + below - k, c + below - pivot);
                    let kept = self.rows[k][own];
                    self.rows[k][own] = if other < width { self.rows[pivot][other] } else { 0.0 };
                    if other < width {
                        self.rows[pivot][other] = kept;
                    }
                }
            }
            let mut own = Vec::with_capacity(below);
            for r in k + 1..=last {
                let factor = self.rows[r][k + below - r] / self.rows[k][below];
                own.push(factor);
                if factor != 0.0 {
                    for c in k..(k + width - below).min(size) {
                        let at = c + below - r;
                        if at < width {
                            let taken = factor * self.rows[k][c + below - k];
                            self.rows[r][at] -= taken;
                        }
                    }
                }
            }
            pivots.push(pivot);
            multipliers.push(own);
        }
        Some(Factors { below, width, rows: self.rows, pivots, multipliers })
    }
}

pub(crate) struct Factors {
    below: usize,
    width: usize,
    rows: Vec<Vec<f64>>,
    pivots: Vec<usize>,
    multipliers: Vec<Vec<f64>>,
}

impl Factors {
    pub(crate) fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        let size = right.len();
        for k in 0..size {
            right.swap(k, self.pivots[k]);
            for (i, factor) in self.multipliers[k].iter().enumerate() {
                right[k + 1 + i] -= factor * right[k];
            }
        }
        for k in (0..size).rev() {
            let known: f64 = (k + 1..(k + self.width - self.below).min(size))
                .map(|c| self.rows[k][c + self.below - k] * right[c])
                .sum();
            right[k] = (right[k] - known) / self.rows[k][self.below];
        }
        right
    }
}

#[test]
fn banded_equations_are_solved() {
    let size = 30;
    let entry = |r: usize, c: usize| {
        let inside = c + 4 >= r && c <= r + 3;
        if inside { ((7 * r + 3 * c) as f64).sin() } else { 0.0 }
    };
    let mut matrix = Banded::new(size, 4, 3);
    for r in 0..size {
        for c in r.saturating_sub(4)..(r + 4).min(size) {
            matrix.set(r, c, entry(r, c));
        }
    }
    let want: Vec<f64> = (0..size).map(|k| 1.0 + k as f64).collect();
    let right = (0..size).map(|r| (0..size).map(|c| entry(r, c) * want[c]).sum()).collect();
    let got = matrix.factor().unwrap().solve(right);
    assert!(got.iter().zip(&want).all(|(a, b)| (a - b).abs() < 1e-10), "{got:?}");
}
