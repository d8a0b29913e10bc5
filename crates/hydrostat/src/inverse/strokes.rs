//! How far cables may be wound in.
//!
//! With the strokes z(T) that tensions make, over L, what an elastic cable stretches by reeled in, too:
//!
//! ```text
//! T = 0   or   z(T) <= longest        for every cable
//! ```
//!
//! since one that hangs slack takes no stroke. Steps keep to this with strokes to first order, each as a condition with
//! one more unknown, the room that is left. What curvature makes too long, the least change of the tensions takes away,
//! so that every shape that a search goes through is within the bounds. A slack cable that is past the bound stays
//! slack, and so does one that can be taut nowhere near within it.

use super::conditions::{ByTensions, Conditions, Pulled};
use super::effort::{dot, nearest};
use super::reaching::Reaching;
use super::search::Search;

/// Most changes of tensions until strokes are within their bounds.
const CHANGES: usize = 6;

/// Tensions over their scale that count as none.
const NONE: f64 = 1e-9;

/// Strokes over L past their bound, to first order, where the cable is not held to it, over the tolerance; and where it
/// is.
const PAST: f64 = 0.1;
const ACTIVE: f64 = 1e-6;

/// Weight of a change over that of what it is for.
const LITTLE: f64 = 1e-10;

impl<S: Reaching> Search<S> {
    /// Strokes over L, where they have a bound.
    pub(super) fn strokes(&self, solver: &S) -> Vec<f64> {
        solver.strokes(if self.longest.is_some() { self.scale.len() } else { 0 })
    }

    /// Whether the cable hangs slack.
    pub(super) fn is_slack(&self, cable: usize, tension: f64) -> bool {
        tension <= NONE * self.scale[cable]
    }

    /// The taut cable that is wound in the farthest past its bound, and by how much over L.
    fn too_long(&self, tensions: &[f64], strokes: &[f64]) -> Option<(usize, f64)> {
        let longest = self.longest?;
        let past = strokes.iter().enumerate().filter(|(c, _)| !self.is_slack(*c, tensions[*c]));
        past.map(|(c, z)| (c, z - longest)).max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, past)| *past > 0.0)
    }

    /// What `solve` finds when it holds so many cables to their strokes, with these largest tensions, that to first
    /// order none is wound in too far.
    pub(super) fn within_strokes(
        &self,
        from: Pulled<'_>,
        slopes: &ByTensions,
        solve: impl Fn(&[usize], &[f64]) -> Option<Vec<f64>>,
    ) -> Option<Vec<f64>> {
        let mut active: Vec<usize> = Vec::new();
        let mut most = self.most.clone();
        if let Some(longest) = self.longest {
            for (c, most) in most.iter_mut().enumerate() {
                if self.is_slack(c, from.tensions[c]) && from.strokes[c] > longest {
                    *most = 0.0;
                }
            }
        }
        loop {
            let found = solve(&active, &most);
            let lets_go = match &found {
                None => active.pop(),
                Some(tensions) => {
                    let moved = |c: usize| -> f64 {
                        let by = slopes.strokes.iter().zip(tensions.iter().zip(from.tensions));
                        from.strokes[c] + by.map(|(column, (to, from))| column[c] * (to - from)).sum::<f64>()
                    };
                    let strokes: Vec<f64> = (0..from.strokes.len()).map(moved).collect();
                    match self.too_long(tensions, &strokes) {
                        Some((c, past)) if active.contains(&c) && past > ACTIVE => Some(c),
                        Some((c, past)) if !active.contains(&c) && past > PAST * self.tol => {
                            active.push(c);
                            continue;
                        }
                        _ => return found,
                    }
                }
            };
            // It cannot be taut within its bound.
            let c = lets_go?;
            active.retain(|active| *active != c);
            most[c] = 0.0;
        }
    }

    /// Conditions on the tensions, given by their columns, with those of the strokes of `active` cables below, so many
    /// times as heavy.
    pub(super) fn conditions(
        &self,
        (columns, wanted): (Vec<Vec<f64>>, Vec<f64>),
        from: Pulled<'_>,
        slopes: &ByTensions,
        (active, most): (&[usize], &[f64]),
        heavy: f64,
    ) -> Conditions {
        let now = from.tensions.iter().zip(most).map(|(t, most)| t.min(*most)).collect();
        let mut out = Conditions { columns, wanted, most: most.to_vec(), now };
        let Some(longest) = self.longest else { return out };
        let rows = out.wanted.len();
        for (k, h) in active.iter().enumerate() {
            let own: Vec<f64> = slopes.strokes.iter().map(|column| column[*h]).collect();
            let size =
                own.iter().zip(&self.scale).fold(f64::MIN_POSITIVE, |m, (v, scale)| f64::max(m, (v * scale).abs()));
            for (column, v) in out.columns.iter_mut().zip(&own) {
                column.push(heavy * v / size);
            }
            let left = longest - from.strokes[*h];
            out.wanted.push(heavy * (left + dot(&own, from.tensions)) / size);
            let by = 1.0 / self.scale[*h];
            let mut room = vec![0.0; rows + active.len()];
            room[rows + k] = heavy * by;
            out.columns.push(room);
            out.most.push(f64::INFINITY);
            out.now.push((left / (size * by)).max(0.0));
        }
        out
    }

    /// Solves at `tensions` by `solve`, and changes them as little as brings all strokes within their bounds. `None`
    /// where that is not found.
    pub(super) fn pull(
        &self,
        solver: &mut S,
        tensions: &mut Vec<f64>,
        slopes: &ByTensions,
        mut solve: impl FnMut(&mut S, &[f64]) -> Option<()>,
    ) -> Option<()> {
        for _ in 0..=CHANGES {
            solve(solver, tensions)?;
            let strokes = self.strokes(solver);
            if self.too_long(tensions, &strokes).is_none_or(|(_, past)| past <= self.tol) {
                return Some(());
            }
            *tensions = self.shortened(Pulled { tensions, strokes: &strokes }, slopes)?;
        }
        None
    }

    /// The nearest tensions whose strokes are to first order within their bounds.
    fn shortened(&self, from: Pulled<'_>, slopes: &ByTensions) -> Option<Vec<f64>> {
        self.within_strokes(from, slopes, |active, most| {
            let none = (vec![Vec::new(); most.len()], Vec::new());
            let all = self.conditions(none, from, slopes, (active, most), 1.0);
            let mut weights: Vec<f64> = self.scale.iter().map(|scale| LITTLE / (scale * scale)).collect();
            weights.resize(all.now.len(), 0.0);
            let mut found = nearest(&all.columns, &all.wanted, &all.most, &weights, &all.now)?;
            found.truncate(most.len());
            Some(found)
        })
    }
}
