//! Folds of the map from tensions to the tip: level lines of a determinant in a face of the box of tensions.

use hydrostat_bvp::continuation::location::RegulaFalsi;

use super::boundary::{Here, LEAST, Tracer, cross};

/// Difference of tensions over the largest, for gradients of the determinant.
const APART: f64 = 1e-4;
/// Most points of a fold, each way.
const MOST_POINTS: usize = 2000;

impl Tracer<'_> {
    /// det(J_f, J_g), each by its tension over the largest.
    fn fold_of(&self, here: &Here, [f, g]: [usize; 2]) -> f64 {
        self.search.most[f] * self.search.most[g] * cross(&here.columns[f], &here.columns[g])
    }

    /// Lines of folds in the face where the cables of `pair` are between their bounds.
    pub(super) fn folds(&self, pair: [usize; 2], corner: &[f64]) -> Vec<Vec<Here>> {
        let n = self.lattice + 1;
        let fraction = |k: usize| k as f64 / self.lattice as f64;
        let nodes: Vec<Option<Here>> =
            (0..n * n).map(|k| self.at(&self.in_face(pair, corner, [fraction(k / n), fraction(k % n)]))).collect();
        let mut lines: Vec<Vec<Here>> = Vec::new();
        for k in 0..n * n {
            let right = (k % n + 1 < n).then_some(k + 1);
            let up = (k + n < n * n).then_some(k + n);
            for other in [right, up].into_iter().flatten() {
                let (Some(a), Some(b)) = (&nodes[k], &nodes[other]) else { continue };
                if self.fold_of(a, pair) * self.fold_of(b, pair) >= 0.0 {
                    continue;
                }
                let Some(seed) = self.between(a, b, pair) else { continue };
                let known = lines.iter().flatten().any(|here| self.far(here, &seed, pair) < 0.6 / self.lattice as f64);
                if !known {
                    lines.push(self.fold(&seed, pair));
                }
            }
        }
        lines
    }

    /// Tensions at fractions of the largest in a face.
    pub(super) fn in_face(&self, [f, g]: [usize; 2], corner: &[f64], fraction: [f64; 2]) -> Vec<f64> {
        let mut tensions = corner.to_vec();
        for (c, fraction) in [f, g].into_iter().zip(fraction) {
            tensions[c] = (fraction * self.search.most[c]).min(self.search.most[c]);
        }
        tensions
    }

    fn fraction(&self, here: &Here, pair: [usize; 2]) -> [f64; 2] {
        pair.map(|c| here.state.tensions[c] / self.search.most[c])
    }

    /// Between the tensions of two shapes, over their largest.
    fn far(&self, a: &Here, b: &Here, pair: [usize; 2]) -> f64 {
        let [a, b] = [a, b].map(|here| self.fraction(here, pair));
        (a[0] - b[0]).hypot(a[1] - b[1])
    }

    /// The fold between two shapes on either side of it.
    fn between(&self, a: &Here, b: &Here, pair: [usize; 2]) -> Option<Here> {
        let [from, to] = [a, b].map(|here| self.fraction(here, pair));
        let ends = [a, b].map(|here| self.fold_of(here, pair));
        let (sign, small) = (ends[0].signum(), 1e-8 * ends[0].abs().max(ends[1].abs()));
        let mut search = RegulaFalsi::between((0.0, sign * ends[0]), (1.0, sign * ends[1]));
        let mut here = a.clone();
        for _ in 0..40 {
            let s = search.place(0.0);
            let at = [from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])];
            here = self.to(&here, &self.in_face(pair, &a.state.tensions, at))?;
            let value = self.fold_of(&here, pair);
            if value.abs() <= small {
                return Some(here);
            }
            search.put(s, sign * value);
        }
        None
    }

    /// The line of a fold through a point of it, both ways, or once round.
    fn fold(&self, seed: &Here, pair: [usize; 2]) -> Vec<Here> {
        let (forth, closed) = self.follow_fold(seed, pair, 1.0);
        let mut line = if closed { Vec::new() } else { self.follow_fold(seed, pair, -1.0).0 };
        line.reverse();
        line.push(seed.clone());
        line.extend(forth);
        if closed {
            line.push(seed.clone());
        }
        line
    }

    /// One way, and whether that led round to the start.
    fn follow_fold(&self, seed: &Here, pair: [usize; 2], sign: f64) -> (Vec<Here>, bool) {
        let longest = 0.5 / self.lattice as f64;
        let mut out: Vec<Here> = Vec::new();
        let mut way: Option<[f64; 2]> = None;
        let mut step = longest;
        while out.len() < MOST_POINTS {
            let here = out.last().unwrap_or(seed);
            let Some(gradient) = self.fold_gradient(here, pair) else { break };
            let steep = gradient[0].hypot(gradient[1]);
            if steep == 0.0 {
                break;
            }
            let normal = gradient.map(|v| v / steep);
            let mut tangent = [-normal[1], normal[0]];
            let forth = way.map_or(sign, |way| way[0] * tangent[0] + way[1] * tangent[1]);
            if forth < 0.0 {
                tangent = tangent.map(|v| -v);
            }
            let moves = |r: usize| {
                let by = |k: usize| here.columns[pair[k]][r] * self.search.most[pair[k]] * tangent[k];
                by(0) + by(1)
            };
            let speed = moves(0).hypot(moves(1));
            step = (2.0 * step).min(longest).min(self.spacing / speed.max(1e-300));
            let from = self.fraction(here, pair);
            let next = loop {
                let to = [from[0] + step * tangent[0], from[1] + step * tangent[1]];
                let next = self.onto_fold(here, pair, to, normal, steep);
                let next =
                    next.filter(|n| self.far(here, n, pair) < 2.0 * step && self.apart(here, n) <= 3.0 * self.spacing);
                step *= if next.is_some() { 1.0 } else { 0.5 };
                if next.is_some() || step < LEAST {
                    break next;
                }
            };
            let Some(next) = next else { break };
            way = Some(tangent);
            let round = out.len() > 5 && self.far(&next, seed, pair) < step;
            if round {
                return (out, true);
            }
            out.push(next);
        }
        (out, false)
    }

    /// Derivatives of the determinant by the tensions over their largest, by differences towards the middle of the
    /// face.
    fn fold_gradient(&self, here: &Here, pair: [usize; 2]) -> Option<[f64; 2]> {
        let at = self.fraction(here, pair);
        let value = self.fold_of(here, pair);
        let mut out = [0.0; 2];
        for k in 0..2 {
            let mut fraction = at;
            let apart = if at[k] > 0.5 { -APART } else { APART };
            fraction[k] += apart;
            let other = self.to(here, &self.in_face(pair, &here.state.tensions, fraction))?;
            out[k] = (self.fold_of(&other, pair) - value) / apart;
        }
        Some(out)
    }

    /// From fractions `at` onto the fold along its normal, within the face: Newton, its slope corrected on the way.
    fn onto_fold(&self, from: &Here, pair: [usize; 2], at: [f64; 2], normal: [f64; 2], steep: f64) -> Option<Here> {
        let (mut off, mut slope) = (0.0, steep);
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..8 {
            let fraction = [at[0] + off * normal[0], at[1] + off * normal[1]];
            if fraction.iter().any(|v| !(0.0..=1.0).contains(v)) {
                return None;
            }
            let here = self.to(from, &self.in_face(pair, &from.state.tensions, fraction))?;
            let value = self.fold_of(&here, pair);
            if let Some((other, earlier)) = before
                && off != other
            {
                slope = (value - earlier) / (off - other);
            }
            let change = -value / slope;
            if change.abs() < 1e-7 {
                return Some(here);
            }
            before = Some((off, value));
            off += change;
            if !off.is_finite() {
                return None;
            }
        }
        None
    }
}
