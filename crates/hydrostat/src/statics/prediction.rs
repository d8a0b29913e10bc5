//! A first guess for the next row of many: the affine continuation of the rows before it.

use nalgebra::{Matrix3, Vector3};

/// Rows before the last one that are kept.
const KEPT: usize = 4;

/// Rows before the last one that enter a prediction: loads that vary in as many directions are followed.
const DIRECTIONS: usize = 3;

/// How far a prediction may go on, over the way between the rows it comes from.
const LONGEST: f64 = 2.0;

/// How exactly the next loads have to be met, over their size.
const EXACT: f64 = 1e-9;

/// What was found at the rows before the last one, with their loads; the newest first.
#[derive(Debug, Clone)]
pub(crate) struct Recent<T>(Vec<(Vec<f64>, T)>);

impl<T> Recent<T> {
    pub(crate) fn new() -> Self {
        Self(Vec::with_capacity(KEPT))
    }

    /// Keeps one more, and no more than are of use.
    pub(crate) fn push(&mut self, loads: Vec<f64>, found: T) {
        self.0.truncate(KEPT - 1);
        self.0.insert(0, (loads, found));
    }

    /// Earlier rows with steps `a_j`, such that x <- x + a_j (x - x_j), one after the other from the row at the loads
    /// `here`, puts the loads x at `next`. As few rows as can be, and of these the nearest; none where the next loads
    /// are not an affine combination of the earlier ones, or too far out.
    pub(crate) fn steps(&self, here: &[f64], next: &[f64]) -> Vec<(&T, f64)> {
        let rows = &self.0;
        // Loads in units of their own size.
        let sizes: Vec<f64> = (0..here.len())
            .map(|k| rows.iter().map(|row| row.0[k].abs()).fold(here[k].abs().max(next[k].abs()), f64::max))
            .collect();
        let from_here = |loads: &[f64]| -> Vec<f64> {
            (0..sizes.len()).map(|k| if sizes[k] > 0.0 { (loads[k] - here[k]) / sizes[k] } else { 0.0 }).collect()
        };
        let ways: Vec<Vec<f64>> = rows.iter().map(|row| from_here(&row.0)).collect();
        let way = from_here(next);
        for count in 1..=DIRECTIONS.min(rows.len()) {
            let mut best: Option<(f64, Vec<usize>, Vector3<f64>)> = None;
            for chosen in subsets(rows.len(), count) {
                let Some(weights) = weights(&chosen, &ways, &way) else { continue };
                // Errors go with the squares of the ways.
                let cost = |(j, weight): (&usize, &f64)| weight.abs() * dot(&ways[*j], &ways[*j]);
                let cost: f64 = chosen.iter().zip(weights.iter()).map(cost).sum();
                if best.as_ref().is_none_or(|best| cost < best.0) {
                    best = Some((cost, chosen, weights));
                }
            }
            if let Some((_, chosen, weights)) = best {
                return in_turn(&weights.as_slice()[..count])
                    .map(|steps| chosen.iter().zip(steps).map(|(j, step)| (&rows[*j].1, step)).collect())
                    .unwrap_or_default();
            }
        }
        Vec::new()
    }
}

/// The weights w_j with which sum w_j ways_j = way, if there are such and they are not too large.
fn weights(chosen: &[usize], ways: &[Vec<f64>], way: &[f64]) -> Option<Vector3<f64>> {
    let count = chosen.len();
    let mut gram = Matrix3::identity();
    let mut right = Vector3::zeros();
    for (a, i) in chosen.iter().enumerate() {
        right[a] = dot(&ways[*i], way);
        for (b, j) in chosen.iter().enumerate() {
            gram[(a, b)] = dot(&ways[*i], &ways[*j]);
        }
    }
    let weights = gram.lu().solve(&right)?;
    let reached = |k: usize| chosen.iter().enumerate().map(|(a, j)| weights[a] * ways[*j][k]).sum::<f64>();
    let exact = (0..way.len()).all(|k| (reached(k) - way[k]).abs() <= EXACT);
    let size: f64 = weights.iter().take(count).map(|w| w.abs()).sum();
    (exact && size <= LONGEST).then_some(weights)
}

/// The steps that, one after the other, make these weights.
fn in_turn(weights: &[f64]) -> Option<Vec<f64>> {
    // The last step takes its weight whole, and those before are scaled by what it leaves of them.
    let mut left = 1.0_f64;
    let mut steps = vec![0.0; weights.len()];
    for (step, weight) in steps.iter_mut().zip(weights).rev() {
        if left.abs() < 0.1 {
            return None;
        }
        *step = -weight / left;
        left -= weight;
    }
    Some(steps)
}

/// All sets of `count` of the first `many` numbers.
fn subsets(many: usize, count: usize) -> impl Iterator<Item = Vec<usize>> {
    let sets = (0..1_usize << many).filter(move |set| set.count_ones() as usize == count);
    sets.map(move |set| (0..many).filter(|j| set >> j & 1 == 1).collect())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What an affine function gives at the next loads, from its values at earlier ones.
    fn predicted(points: &[[f64; 3]], here: [f64; 3], next: [f64; 3]) -> Option<(f64, f64)> {
        let f = |p: &[f64; 3]| 0.3 + 2.0 * p[0] - 0.7 * p[1] + 0.1 * p[2];
        let mut recent = Recent::new();
        for point in points {
            recent.push(point.to_vec(), f(point));
        }
        let mut x = f(&here);
        let steps = recent.steps(&here, &next);
        for (before, step) in &steps {
            x += step * (x - **before);
        }
        (!steps.is_empty()).then_some((x, f(&next)))
    }

    #[test]
    fn an_affine_function_is_continued_exactly_in_one_two_and_three_directions() {
        let line = [[0.1, 0.0, 0.5], [0.2, 0.0, 0.5]];
        let plane = [[0.1, 0.0, 0.5], [0.13, 0.05, 0.5]];
        let space = [[0.1, 0.0, 0.5], [0.13, 0.05, 0.5], [0.12, 0.02, 0.6]];
        for (points, here, next) in [
            (&line[..], [0.3, 0.0, 0.5], [0.37, 0.0, 0.5]),
            (&plane[..], [0.12, 0.04, 0.5], [0.123, 0.035, 0.5]),
            (&space[..], [0.15, 0.03, 0.55], [0.123, 0.029, 0.535]),
        ] {
            let (found, exact) = predicted(points, here, next).expect("a combination");
            assert!((found - exact).abs() < 1e-12, "{found} for {exact}");
        }
    }

    #[test]
    fn loads_out_of_reach_are_not_predicted() {
        let points = [[0.1, 0.0, 0.5], [0.2, 0.0, 0.5]];
        // Off the line, and too far along it.
        assert!(predicted(&points, [0.3, 0.0, 0.5], [0.3, 0.1, 0.5]).is_none());
        assert!(predicted(&points, [0.3, 0.0, 0.5], [1.3, 0.0, 0.5]).is_none());
        // Where nothing changes there is nothing to follow.
        let same = [[0.3, 0.0, 0.5]];
        assert!(predicted(&same, [0.3, 0.0, 0.5], [0.4, 0.0, 0.5]).is_none());
    }
}
