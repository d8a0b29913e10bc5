//! Linear conditions within bounds: met with the least effort, or as nearly as a damped step may.
//!
//! For the least effort, a least-squares problem with a little weight on the tensions themselves has one answer within
//! the bounds, which a finite number of changes of the set of free cables finds. What it leaves of the conditions is
//! added to what is asked for, and again, until nothing is left: the method of multipliers, whose limit is the least
//! effort. It needs no start within the bounds, and none where the conditions leave a single point of them.

use crate::numerics::elimination::solved;

/// Weight of the effort, over the largest square of a column.
const WEIGHT: f64 = 1e-9;

/// Most rounds on what is left: each divides it by one and the square of a singular value (over the largest) over the
/// weight.
const ROUNDS: usize = 80;

/// What is left (over the size of the conditions) when all is met, and what is still good enough.
const MET: [f64; 2] = [1e-13, 1e-9];

/// The fraction that a round may leave before the conditions are taken for ones that no tensions meet.
const STUCK: f64 = 0.999;

/// Where a tension is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Least,
    Free,
    Most,
}

/// The t with J t = c and 0 <= t <= most, J given by its columns, for which the sum of squares of the first `cables` is
/// least: what comes after these takes no effort. `None` where no t does.
pub(super) fn least_effort(columns: &[Vec<f64>], wanted: &[f64], most: &[f64], cables: usize) -> Option<Vec<f64>> {
    let size = dot(wanted, wanted).sqrt().max(f64::MIN_POSITIVE);
    let weight = WEIGHT * columns.iter().map(|column| dot(column, column)).fold(f64::MIN_POSITIVE, f64::max);
    let weights: Vec<f64> = (0..most.len()).map(|c| if c < cables { weight } else { 0.0 }).collect();
    let centre = vec![0.0; most.len()];
    let mut problem = Bounded {
        columns,
        most,
        weights: &weights,
        centre: &centre,
        t: centre.clone(),
        places: vec![Place::Least; most.len()],
    };
    let mut asked = wanted.to_vec();
    let mut before = f64::INFINITY;
    for round in 0..ROUNDS {
        problem.solve(&asked)?;
        let left = problem.left(wanted);
        let off = dot(&left, &left).sqrt() / size;
        if off <= MET[0] {
            return Some(problem.t);
        }
        if round > 2 && off > STUCK * before {
            break;
        }
        before = off;
        for (asked, left) in asked.iter_mut().zip(&left) {
            *asked += left;
        }
    }
    let left = problem.left(wanted);
    (dot(&left, &left).sqrt() <= MET[1] * size).then_some(problem.t)
}

/// The t of the least |J t - c|^2 + sum of weights (t - centre)^2 with 0 <= t <= most, from the centre, which is
/// within. `None` where it is not determined.
pub(super) fn nearest(
    columns: &[Vec<f64>],
    wanted: &[f64],
    most: &[f64],
    weights: &[f64],
    centre: &[f64],
) -> Option<Vec<f64>> {
    let place = |(t, most): (&f64, &f64)| match *t {
        t if t <= 0.0 => Place::Least,
        t if t >= *most => Place::Most,
        _ => Place::Free,
    };
    let places = centre.iter().zip(most).map(place).collect();
    let mut problem = Bounded { columns, most, weights, centre, t: centre.to_vec(), places };
    problem.solve(wanted)?;
    Some(problem.t)
}

/// |J t - asked|^2 + sum of weights (t - centre)^2 within bounds.
struct Bounded<'a> {
    columns: &'a [Vec<f64>],
    most: &'a [f64],
    weights: &'a [f64],
    centre: &'a [f64],
    t: Vec<f64>,
    places: Vec<Place>,
}

impl Bounded<'_> {
    /// What t leaves of conditions.
    fn left(&self, wanted: &[f64]) -> Vec<f64> {
        let met = |r: usize| self.columns.iter().zip(&self.t).map(|(column, t)| column[r] * t).sum::<f64>();
        wanted.iter().enumerate().map(|(r, wanted)| wanted - met(r)).collect()
    }

    /// Half of how fast the sum falls with `t[c]`, of what t leaves.
    fn downhill(&self, c: usize, left: &[f64]) -> f64 {
        dot(&self.columns[c], left) - self.weights[c] * (self.t[c] - self.centre[c])
    }

    /// From the tensions before: free cables go to the least of the sum until one meets a bound, and what would leave
    /// its bound downhill is let go, one at a time. The sum falls with every change, so that no set of free cables
    /// comes twice.
    fn solve(&mut self, asked: &[f64]) -> Option<()> {
        let largest = self.columns.iter().map(|column| dot(column, column)).fold(0.0, f64::max).sqrt();
        let still = 1e-14 * largest * dot(asked, asked).sqrt();
        for _ in 0..8 * (self.t.len() + 2) {
            self.settle(asked)?;
            let left = self.left(asked);
            let downhill = |c: &usize| self.downhill(*c, &left);
            let leaves = |c: &usize| match self.places[*c] {
                Place::Free => false,
                Place::Least => self.most[*c] > 0.0 && downhill(c) > still,
                Place::Most => downhill(c) < -still,
            };
            let next = (0..self.t.len()).filter(leaves).max_by(|a, b| downhill(a).abs().total_cmp(&downhill(b).abs()));
            let Some(next) = next else { break };
            self.places[next] = Place::Free;
        }
        Some(())
    }

    /// The least of the sum over the free cables, stopped at bounds.
    fn settle(&mut self, asked: &[f64]) -> Option<()> {
        loop {
            let free: Vec<usize> = (0..self.t.len()).filter(|c| self.places[*c] == Place::Free).collect();
            if free.is_empty() {
                return Some(());
            }
            let left = self.left(asked);
            let row = |a: &usize| {
                let by = free
                    .iter()
                    .map(|b| dot(&self.columns[*a], &self.columns[*b]) + if a == b { self.weights[*a] } else { 0.0 });
                (by.collect(), [self.downhill(*a, &left), 0.0])
            };
            let (step, _) = solved(free.iter().map(row).collect())?;
            // How much of the step there is room for, and who stops it.
            let mut fraction = 1.0;
            let mut stops = None;
            for (c, [d, _]) in free.iter().zip(&step) {
                let (room, place) = if *d < 0.0 {
                    (-self.t[*c] / d, Place::Least)
                } else {
                    ((self.most[*c] - self.t[*c]) / d, Place::Most)
                };
                if *d != 0.0 && room < fraction {
                    (fraction, stops) = (room.max(0.0), Some((*c, place)));
                }
            }
            for (c, [d, _]) in free.iter().zip(&step) {
                self.t[*c] = (self.t[*c] + fraction * d).clamp(0.0, self.most[*c]);
            }
            let Some((c, place)) = stops else { return Some(()) };
            self.places[c] = place;
            self.t[c] = if place == Place::Least { 0.0 } else { self.most[c] };
        }
    }
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
            let found = least_effort(&columns, &wanted, &most, most.len()).unwrap();
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

    /// Conditions that tensions within their bounds meet, some of them on their bounds: all are met, by none of more
    /// effort than those.
    #[test]
    fn what_can_be_met_is_met_with_no_more_effort() {
        let mut state = 1_u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (mut met, count) = (0, 20_000);
        for k in 0..count {
            let (cables, rows) = (1 + k % 6, 1 + k / 6 % 3);
            let columns: Vec<Vec<f64>> = (0..cables).map(|_| (0..rows).map(|_| draw() - 0.5).collect()).collect();
            let most: Vec<f64> = (0..cables).map(|_| 0.1 + draw()).collect();
            let fraction = |at: f64| (1.6 * at - 0.3).clamp(0.0, 1.0);
            let t: Vec<f64> = most.iter().map(|most| most * fraction(draw())).collect();
            let wanted: Vec<f64> = (0..rows).map(|r| columns.iter().zip(&t).map(|(c, t)| c[r] * t).sum()).collect();
            let Some(found) = least_effort(&columns, &wanted, &most, most.len()) else { continue };
            met += 1;
            assert!(found.iter().zip(&most).all(|(t, most)| (0.0..=*most).contains(t)), "{found:?}");
            assert!(dot(&found, &found) <= dot(&t, &t) * (1.0 + 1e-6) + 1e-12, "{found:?} {t:?}");
            for r in 0..rows {
                let sum: f64 = columns.iter().zip(&found).map(|(c, t)| c[r] * t).sum();
                assert!((sum - wanted[r]).abs() < 1e-8, "{sum} {}", wanted[r]);
            }
        }
        println!("{met} of {count}");
        assert_eq!(met, count);
    }

    #[test]
    fn what_bounds_forbid_is_not_found() {
        assert!(least_effort(&[vec![1.0, 0.0], vec![0.0, 1.0]], &[-1.0, 0.2], &[1.0, 1.0], 2).is_none());
        assert!(least_effort(&[vec![1.0, 0.0], vec![0.0, 1.0]], &[2.0, 0.2], &[1.0, 1.0], 2).is_none());
    }
}
