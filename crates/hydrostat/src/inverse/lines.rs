//! Further tensions, along lines through the target.
//!
//! Newton's method ends at a fold of the map from tensions to places, where two of its branches meet, and finds one of
//! several solutions on the side that it comes from. The tensions that keep the places on a straight line through their
//! targets form curves,
//!
//! ```text
//! rest(T) . a = 0        for all a across the line
//! rest(T) . d            is 0 at a solution, d along the line
//! ```
//!
//! which pass folds without noticing: only there do the places turn back on their line. Each is followed by arclength
//! from what Newton's method found to where a tension meets its bound. For as many cables as conditions.

use nalgebra::DMatrix;

use super::effort::dot;
use super::reaching::Reaching;
use super::search::{Search, State};
use crate::numerics::distance;
use crate::numerics::elimination::solved;

/// The turn of the tip, rad, that a step aims at: below what makes a warm solve start anew.
const TURN: f64 = 0.12;
/// Most steps, in tensions over their scale, and the first and the shortest.
const LONGEST: f64 = 0.2;
const FIRST: f64 = 0.01;
const SHORTEST: f64 = 1e-5;
/// How far (over L) places may leave the line, and how far a step may move them.
const CLOSE: f64 = 1e-5;
const MOVED: f64 = 0.1;
/// Most corrections a step.
const CORRECTIONS: usize = 5;
/// Least distances (over L) on a line that a search sets out from.
const NEAR: f64 = 0.02;
/// Tensions over their scale at which a curve of unbounded ones ends.
const FARTHEST: f64 = 5.0;
/// The cosine of the largest angle between the tangents of a step.
const STRAIGHT: f64 = 0.9;

/// A line through the targets.
struct Line<'a, S: Reaching> {
    search: &'a Search<S>,
    along: Vec<f64>,
    across: Vec<Vec<f64>>,
    /// Largest tensions over their scale.
    most: Vec<f64>,
}

/// A shape on the curve, with the derivatives of its distances by the tensions over their scale.
struct Point<S> {
    state: State<S>,
    columns: Vec<Vec<f64>>,
    tangent: Vec<f64>,
}

impl<S: Reaching> Search<S> {
    /// Whether lines determine their tensions.
    pub(super) fn has_lines(&self, state: &State<S>) -> bool {
        let conditions = state.rest.len();
        conditions > 1 && conditions == self.most.len()
    }

    /// The direction in which tensions move the places least: across a fold that is near.
    pub(super) fn stiffest(&self, state: &State<S>) -> Option<Vec<f64>> {
        let jacobian = self.jacobian(&state.solver)?;
        let scaled = DMatrix::from_fn(state.rest.len(), jacobian.len(), |r, c| jacobian[c][r] * self.scale[c]);
        let svd = scaled.try_svd(true, false, f64::EPSILON, 100)?;
        let least = svd.singular_values.imin();
        Some(svd.u?.column(least).iter().copied().collect())
    }

    /// Tensions near solutions on the line through the targets along `direction`, which the places of `from` are on:
    /// both ways from there. `go_on` is asked before every step.
    pub(super) fn along(&self, from: &State<S>, direction: &[f64], go_on: &mut dyn FnMut() -> bool) -> Vec<Vec<f64>> {
        let size = dot(direction, direction).sqrt();
        if !(size > 0.0 && size.is_finite()) {
            return Vec::new();
        }
        let along: Vec<f64> = direction.iter().map(|v| v / size).collect();
        let across = across(&along);
        let most = self.most.iter().zip(&self.scale).map(|(most, scale)| (most / scale).min(FARTHEST)).collect();
        let line = Line { search: self, along, across, most };
        let Some(start) = line.start(from) else { return Vec::new() };
        let mut out = Vec::new();
        for sign in [1.0, -1.0] {
            line.walk(&start, sign, go_on, &mut out);
        }
        out
    }
}

impl<S: Reaching> Line<'_, S> {
    fn fractions(&self, state: &State<S>) -> Vec<f64> {
        state.tensions.iter().zip(&self.search.scale).map(|(t, scale)| t / scale).collect()
    }

    fn columns(&self, state: &State<S>) -> Option<Vec<Vec<f64>>> {
        let jacobian = self.search.jacobian(&state.solver)?;
        let scaled = |(column, scale): (&Vec<f64>, &f64)| column.iter().map(|v| v * scale).collect();
        Some(jacobian.iter().zip(&self.search.scale).map(scaled).collect())
    }

    /// Of the conditions with a last row `guide`: the change for which they have these right sides.
    fn change(&self, columns: &[Vec<f64>], right: &[f64], guide: &[f64], last: f64) -> Option<Vec<f64>> {
        let mut rows: Vec<(Vec<f64>, [f64; 2])> = self
            .across
            .iter()
            .zip(right)
            .map(|(a, right)| (columns.iter().map(|column| dot(a, column)).collect(), [*right, 0.0]))
            .collect();
        rows.push((guide.to_vec(), [last, 0.0]));
        let (change, _) = solved(rows)?;
        let change: Vec<f64> = change.into_iter().map(|[d, _]| d).collect();
        change.iter().all(|d| d.is_finite()).then_some(change)
    }

    /// The direction in which the conditions do not change, on the side of `guide`.
    fn tangent(&self, columns: &[Vec<f64>], guide: &[f64]) -> Option<Vec<f64>> {
        let tangent = self.change(columns, &vec![0.0; self.across.len()], guide, 1.0)?;
        let size = dot(&tangent, &tangent).sqrt();
        Some(tangent.iter().map(|v| v / size).collect())
    }

    fn start(&self, from: &State<S>) -> Option<Point<S>> {
        let columns = self.columns(from)?;
        let n = columns.len();
        // The cable that moves most along the curve keeps its conditions best apart.
        let guides = (0..n).map(|c| (0..n).map(|k| f64::from(u8::from(k == c))).collect::<Vec<f64>>());
        let tangents = guides.enumerate().filter_map(|(c, guide)| Some((c, self.tangent(&columns, &guide)?)));
        let (_, tangent) = tangents.max_by(|(a, s), (b, t)| s[*a].abs().total_cmp(&t[*b].abs()))?;
        Some(Point { state: from.clone(), columns, tangent })
    }

    fn offset(&self, state: &State<S>) -> f64 {
        dot(&self.along, &state.rest)
    }

    /// One way; what is near a solution goes to `out`.
    fn walk(&self, start: &Point<S>, sign: f64, go_on: &mut dyn FnMut() -> bool, out: &mut Vec<Vec<f64>>) {
        let begun = self.fractions(&start.state);
        let mut here = Point {
            state: start.state.clone(),
            columns: start.columns.clone(),
            tangent: start.tangent.iter().map(|v| sign * v).collect(),
        };
        let solution = |point: &Point<S>| self.offset(&point.state).abs() <= 10.0 * self.search.tol;
        // The offsets of the last two points.
        let mut before: Option<f64> = None;
        let mut size = FIRST;
        let mut count = 0;
        while go_on() {
            let (fractions, offset) = (self.fractions(&here.state), self.offset(&here.state));
            let stepped = loop {
                let stepped = self.step(&here, &fractions, size);
                if stepped.is_some() || size < SHORTEST {
                    break stepped;
                }
                size *= 0.4;
            };
            let Some((next, ended)) = stepped else { break };
            count += 1;
            let after = self.offset(&next.state);
            let fresh = !solution(&here);
            if fresh && offset * after < 0.0 {
                let fraction = offset / (offset - after);
                let tensions = here.state.tensions.iter().zip(&next.state.tensions);
                out.push(tensions.map(|(a, b)| a + fraction * (b - a)).collect());
            } else if fresh
                && offset.abs() < NEAR
                && before.is_some_and(|before| before * offset > 0.0 && before.abs() >= offset.abs())
                && after.abs() >= offset.abs()
            {
                out.push(here.state.tensions.clone());
            }
            if ended {
                if after.abs() < NEAR && after.abs() <= offset.abs() {
                    out.push(next.state.tensions.clone());
                }
                break;
            }
            let turned = next.state.solver.turned(&here.state.solver);
            let moved = distance(&next.state.rest, &here.state.rest);
            let fit = (TURN / turned.max(1e-12)).min(0.5 * MOVED / moved.max(1e-12));
            let reached = self.fractions(&next.state);
            let round = count > 5 && distance(&reached, &begun) < 0.7 * distance(&reached, &fractions);
            size = (size * fit.clamp(0.3, 2.0)).min(LONGEST);
            before = Some(offset);
            here = next;
            if round {
                break;
            }
        }
    }

    /// A step, and whether it ended at a bound.
    fn step(&self, here: &Point<S>, fractions: &[f64], size: f64) -> Option<(Point<S>, bool)> {
        // As far as there is room.
        let (mut length, mut stop) = (size, None);
        for (c, (t, fraction)) in here.tangent.iter().zip(fractions).enumerate() {
            let bound = if *t > 0.0 { self.most[c] } else { 0.0 };
            if *t != 0.0 && (bound - fraction) / t <= length {
                (length, stop) = (((bound - fraction) / t).max(0.0), Some((c, bound)));
            }
        }
        if length == 0.0 {
            return None;
        }
        let guide: Vec<f64> = match stop {
            Some((c, _)) => (0..fractions.len()).map(|k| f64::from(u8::from(k == c))).collect(),
            None => here.tangent.clone(),
        };
        let mut to: Vec<f64> = fractions.iter().zip(&here.tangent).map(|(fraction, t)| fraction + length * t).collect();
        let mut solver = here.state.solver.clone();
        let mut corrections = 0;
        loop {
            if let Some((c, bound)) = stop {
                to[c] = bound;
            }
            // A little outside is where rounding and the curve's bend lead.
            if to.iter().zip(&self.most).any(|(to, most)| *to < -1e-3 || *to > most + 1e-3) {
                return None;
            }
            let tensions: Vec<f64> = (0..to.len())
                .map(|c| (to[c].clamp(0.0, self.most[c]) * self.search.scale[c]).min(self.search.most[c]))
                .collect();
            solver.pull(&tensions)?;
            solver.settle()?;
            let rest = self.search.rest(&solver);
            if distance(&rest, &here.state.rest) > MOVED {
                return None;
            }
            let off: Vec<f64> = self.across.iter().map(|a| -dot(a, &rest)).collect();
            if dot(&off, &off).sqrt() <= CLOSE {
                break;
            }
            corrections += 1;
            if corrections > CORRECTIONS {
                return None;
            }
            let change = self.change(&here.columns, &off, &guide, 0.0)?;
            to.iter_mut().zip(&change).for_each(|(to, d)| *to += d);
        }
        let tensions = solver.tensions();
        let state = self.search.state(solver, tensions);
        let columns = self.columns(&state)?;
        let tangent = self.tangent(&columns, &here.tangent)?;
        let straight = dot(&tangent, &here.tangent) > STRAIGHT || length < 10.0 * SHORTEST;
        straight.then_some((Point { state, columns, tangent }, stop.is_some()))
    }
}

/// Unit vectors normal to a unit vector and to each other: the rows but the first of the reflection that takes it to an
/// axis.
fn across(along: &[f64]) -> Vec<Vec<f64>> {
    let mut v = along.to_vec();
    v[0] += 1.0_f64.copysign(v[0]);
    let square = dot(&v, &v);
    (1..v.len())
        .map(|r| (0..v.len()).map(|c| f64::from(u8::from(r == c)) - 2.0 * v[r] * v[c] / square).collect())
        .collect()
}
