//! Small systems of linear equations, by elimination with row pivoting.

use hydrostat_bvp::Determinant;

/// Solves `matrix x = right` into `right`, of sizes that are known beforehand; false where a pivot is no larger than
/// `smallest`.
#[inline(always)]
pub(crate) fn solve_in_place<const S: usize, const C: usize>(
    matrix: &mut [[f64; S]; S],
    right: &mut [[f64; C]; S],
    smallest: f64,
) -> bool {
    for k in 0..S {
        let mut best = k;
        for i in k + 1..S {
            if matrix[i][k].abs() > matrix[best][k].abs() {
                best = i;
            }
        }
        matrix.swap(k, best);
        right.swap(k, best);
        let pivot = matrix[k][k];
        if pivot.abs() <= smallest || !pivot.is_finite() {
            return false;
        }
        let (row, given) = (matrix[k], right[k]);
        for i in k + 1..S {
            let f = matrix[i][k] / pivot;
            if f != 0.0 {
                for c in 0..S {
                    matrix[i][c] -= f * row[c];
                }
                for c in 0..C {
                    right[i][c] -= f * given[c];
                }
            }
        }
    }
    for k in (0..S).rev() {
        let inverse = 1.0 / matrix[k][k];
        let given = right[k].map(|v| v * inverse);
        right[k] = given;
        for i in 0..k {
            let f = matrix[i][k];
            for c in 0..C {
                right[i][c] -= f * given[c];
            }
        }
    }
    true
}

/// One equation of a system of as many as there are cables, say: coefficients, and the two right sides.
pub(crate) type Equation = (Vec<f64>, [f64; 2]);

/// Solves for both right sides; with the determinant.
pub(crate) fn solved(mut rows: Vec<Equation>) -> Option<(Vec<[f64; 2]>, Determinant)> {
    let n = rows.len();
    let mut determinant = Determinant::ONE;
    for k in 0..n {
        let best = (k..n).max_by(|i, j| rows[*i].0[k].abs().total_cmp(&rows[*j].0[k].abs()))?;
        if best != k {
            rows.swap(k, best);
            determinant.sign = -determinant.sign;
        }
        let pivot = rows[k].0[k];
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        determinant.sign *= pivot.signum();
        determinant.log += pivot.abs().ln();
        let own = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != k {
                let factor = row.0[k] / pivot;
                row.0.iter_mut().zip(&own.0).for_each(|(v, o)| *v -= factor * o);
                row.1.iter_mut().zip(&own.1).for_each(|(v, o)| *v -= factor * o);
            }
        }
    }
    Some((rows.iter().enumerate().map(|(k, (row, right))| right.map(|v| v / row[k])).collect(), determinant))
}
