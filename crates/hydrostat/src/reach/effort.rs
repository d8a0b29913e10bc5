//! The least effort that meets linear conditions within bounds.

use crate::engine::solved;

/// Rounds on the multipliers.
const ROUNDS: usize = 200;

/// The shortest share of a step: where fewer cables are free than there are conditions steps are very long.
const SHORTEST: f64 = 1e-16;

/// The t of least |t|^2 with J t = c and 0 <= t <= most, J given by its columns: t follows multipliers y as
/// J^T y cut to the bounds, and Newton's method on J t(y) = c ends after as many rounds as bounds change. `None` where no t does.
pub(super) fn least_effort(columns: &[Vec<f64>], wanted: &[f64], most: &[f64]) -> Option<Vec<f64>> {
    let rows = wanted.len();
    let pull = |y: &[f64]| -> Vec<f64> {
        columns.iter().zip(most).map(|(column, most)| dot(column, y).clamp(0.0, *most)).collect()
    };
    let rest = |t: &[f64]| -> Vec<f64> {
        (0..rows).map(|r| wanted[r] - columns.iter().zip(t).map(|(column, t)| column[r] * t).sum::<f64>()).collect()
    };
    let scale = columns.iter().map(|column| dot(column, column)).fold(0.0, f64::max);
    let size = dot(wanted, wanted).sqrt().max(f64::MIN_POSITIVE);
    let mut y = vec![0.0; rows];
    // From zero no bound would ever let go.
    let mut free = vec![true; columns.len()];
    for _ in 0..ROUNDS {
        let t = pull(&y);
        let left = rest(&t);
        if dot(&left, &left).sqrt() <= 1e-13 * size {
            return Some(t);
        }
        let row = |r: usize| {
            let by = (0..rows).map(|c| {
                let sum: f64 =
                    columns.iter().zip(&free).filter(|(_, free)| **free).map(|(own, _)| own[r] * own[c]).sum();
                sum + if r == c { 1e-12 * scale } else { 0.0 }
            });
            (by.collect(), [left[r], 0.0])
        };
        let (step, _) = solved((0..rows).map(row).collect())?;
        // The dual function rises along the step; halve it until it does enough.
        let dual = |y: &[f64]| {
            let t = pull(y);
            let carried: f64 = columns.iter().zip(&t).map(|(column, t)| dot(column, y) * t - 0.5 * t * t).sum();
            dot(wanted, y) - carried
        };
        let slope: f64 = step.iter().zip(&left).map(|([s, _], l)| s * l).sum();
        let (before, mut share) = (dual(&y), 1.0);
        let next = loop {
            let next: Vec<f64> = y.iter().zip(&step).map(|(y, [s, _])| y + share * s).collect();
            if dual(&next) >= before + 1e-4 * share * slope || share < SHORTEST {
                break next;
            }
            share *= 0.5;
        };
        y = next;
        for ((free, column), most) in free.iter_mut().zip(columns).zip(most) {
            let pulled = dot(column, &y);
            *free = pulled > 0.0 && pulled < *most;
        }
    }
    let t = pull(&y);
    let left = rest(&t);
    (dot(&left, &left).sqrt() <= 1e-9 * size).then_some(t)
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a scan of the one direction that three cables leave free.
    #[test]
    fn three_cables_against_a_scan() {
        let columns = vec![vec![1.0, 0.4], vec![-0.7, 0.5], vec![0.3, -0.9]];
        for (at, most) in
            [([0.5, 0.2, 0.3], [1.0; 3]), ([0.9, 0.1, 0.0], [1.0; 3]), ([0.2, 0.6, 0.4], [0.25, 1.0, 1.0])]
        {
            let wanted: Vec<f64> = (0..2).map(|r| (0..3).map(|c| columns[c][r] * at[c]).sum()).collect();
            let found = least_effort(&columns, &wanted, &most).unwrap();
            // The null vector is the cross product of the rows.
            let null = [
                columns[1][0] * columns[2][1] - columns[2][0] * columns[1][1],
                columns[2][0] * columns[0][1] - columns[0][0] * columns[2][1],
                columns[0][0] * columns[1][1] - columns[1][0] * columns[0][1],
            ];
            let mut best = f64::INFINITY;
            for k in -200_000..=200_000 {
                let t: Vec<f64> = (0..3).map(|c| at[c] + 1e-5 * f64::from(k) * null[c]).collect();
                if t.iter().zip(&most).all(|(t, most)| (-1e-9..=most + 1e-9).contains(t)) {
                    best = best.min(dot(&t, &t));
                }
            }
            assert!((dot(&found, &found) - best).abs() < 1e-4 * best.max(1e-3), "{found:?} {best}");
        }
    }

    #[test]
    fn what_bounds_forbid_is_not_found() {
        assert!(least_effort(&[vec![1.0, 0.0], vec![0.0, 1.0]], &[-1.0, 0.2], &[1.0, 1.0]).is_none());
        assert!(least_effort(&[vec![1.0, 0.0], vec![0.0, 1.0]], &[2.0, 0.2], &[1.0, 1.0]).is_none());
    }
}
