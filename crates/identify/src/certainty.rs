//! How well the rows know the parameters: covariance, and the directions that the data see least of.

use nalgebra::{DMatrix, DVector, SVD};

use crate::least_squares::{NOTHING, Rows};
use crate::loss::Loss;

/// A combination of parameters, each in its scale, and how well the data know it.
#[derive(Debug, Clone, PartialEq)]
pub struct Direction {
    /// How many standard deviations the measured numbers move (root of the sum of squares) when the parameters move by one unit of their
    /// scales along this direction.
    pub singular_value: f64,
    /// Its components, one a parameter, of length one.
    pub weights: Vec<f64>,
}

/// Of the estimates at a minimum: [variance or covariance], infinite where nothing is known.
pub(crate) fn covariance(rows: &Rows, loss: Loss, free: &[usize], spread: f64) -> DMatrix<f64> {
    let count = rows.jacobian.ncols();
    let mut out = DMatrix::from_element(count, count, 0.0);
    if free.is_empty() {
        return out;
    }
    let (curvature, square) = spread_of(rows, loss, free.len());
    let mut jacobian = rows.jacobian.select_columns(free);
    let norms: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    for (mut column, norm) in jacobian.column_iter_mut().zip(&norms) {
        if *norm > 0.0 {
            column /= *norm;
        }
    }
    // Information A = c J^T J + P and the covariance of the gradient B = q J^T J + P.
    let mut own = jacobian.clone();
    let mut pull = jacobian;
    let fraction = 1.0 / (spread * spread);
    for i in 0..rows.measured {
        own.row_mut(i).scale_mut((curvature * fraction).sqrt());
        pull.row_mut(i).scale_mut((square * fraction).sqrt());
    }
    let SVD { v_t, singular_values, .. } = SVD::new(own, false, true);
    let Some(directions) = v_t else {
        // Asked for above; without them nothing is known.
        for i in free {
            out[(*i, *i)] = f64::INFINITY;
        }
        return out;
    };
    let least = NOTHING * singular_values.max();
    let known: Vec<usize> = (0..singular_values.len()).filter(|k| singular_values[*k] > least).collect();
    let mut inverse = DMatrix::zeros(free.len(), free.len());
    let mut seen = DVector::<f64>::zeros(free.len());
    for k in &known {
        let row = directions.row(*k);
        inverse += row.transpose() * row / singular_values[*k].powi(2);
        seen += row.transpose().map(|v| v * v);
    }
    let half = pull * &inverse;
    let found = half.tr_mul(&half);
    for (a, i) in free.iter().enumerate() {
        for (b, j) in free.iter().enumerate() {
            // A parameter whose unit vector is not within what is known has no variance.
            let unknown = |k: usize| 1.0 - seen[k] > 1e-6;
            out[(*i, *j)] = match (unknown(a), unknown(b)) {
                (false, false) => found[(a, b)] / (norms[a] * norms[b]),
                _ if a == b => f64::INFINITY,
                _ => f64::NAN,
            };
        }
    }
    out
}

/// Mean curvature of the loss over the measured rows, and the mean square of its slope with Huber's correction for few rows (Huber 1981,
/// section 7.6). Both are one for least squares.
fn spread_of(rows: &Rows, loss: Loss, parameters: usize) -> (f64, f64) {
    if loss == Loss::None || rows.measured == 0 {
        return (1.0, 1.0);
    }
    let count = rows.measured as f64;
    let all = || rows.residuals.iter().take(rows.measured).copied();
    let mean = all().map(|r| loss.curvature(r)).sum::<f64>() / count;
    let curvature = mean.max(0.1);
    let variance = all().map(|r| (loss.curvature(r) - mean).powi(2)).sum::<f64>() / count;
    let correction = 1.0 + parameters as f64 / count * variance / (curvature * curvature);
    let freedom = (count - parameters as f64).max(1.0);
    let square = all().map(|r| loss.slope(r).powi(2)).sum::<f64>() / freedom;
    (curvature, square * correction * correction)
}

/// The directions of the measured rows alone, priors aside, the least known first.
pub(crate) fn directions(rows: &Rows, scales: &[f64]) -> Vec<Direction> {
    let mut jacobian = rows.jacobian.rows(0, rows.measured).into_owned();
    for (mut column, scale) in jacobian.column_iter_mut().zip(scales) {
        column *= *scale;
    }
    let count = scales.len();
    if jacobian.nrows() < count {
        // Directions that no row is left for are directions too.
        jacobian = jacobian.insert_rows(rows.measured, count - rows.measured, 0.0);
    }
    let SVD { v_t, singular_values, .. } = SVD::new(jacobian, false, true);
    let Some(v_t) = v_t else { return Vec::new() };
    let mut out: Vec<Direction> = (0..count)
        .map(|k| Direction {
            singular_value: singular_values[k],
            weights: {
                let row: Vec<f64> = v_t.row(k).iter().copied().collect();
                let largest = row.iter().copied().fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
                row.into_iter().map(|v| v * largest.signum()).collect()
            },
        })
        .collect();
    out.sort_by(|a, b| a.singular_value.total_cmp(&b.singular_value));
    out
}

/// Covariances over the standard deviations; not finite where these are not.
pub(crate) fn correlation(covariance: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let count = covariance.nrows();
    let one = |i: usize, j: usize| {
        if i == j { 1.0 } else { covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt() }
    };
    (0..count).map(|i| (0..count).map(|j| one(i, j)).collect()).collect()
}
