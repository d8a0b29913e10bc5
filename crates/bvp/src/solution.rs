//! Discrete solutions.

use crate::directions::{Directions, Side};
use crate::gauss::Gauss;
use crate::groups::{Groups, make_room, resize};
use crate::mesh::Mesh;
use crate::real::{LANES, Lanes};

/// The unknowns at a stage of four elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stage<const N: usize, const L: usize> {
    /// Slope of the state.
    pub slope: [Lanes; N],
    /// Inner unknowns.
    pub inner: [Lanes; L],
    /// Slope of the closure variable.
    pub closure_slope: Lanes,
}

impl<const N: usize, const L: usize> Default for Stage<N, L> {
    fn default() -> Self {
        Self { slope: [Lanes::default(); N], inner: [Lanes::default(); L], closure_slope: Lanes::default() }
    }
}

/// The unknowns at an end of four elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End<const L: usize> {
    /// Inner unknowns.
    pub inner: [Lanes; L],
    /// Slope of the closure variable.
    pub closure_slope: Lanes,
}

impl<const L: usize> Default for End<L> {
    fn default() -> Self {
        Self { inner: [Lanes::default(); L], closure_slope: Lanes::default() }
    }
}

/// A discrete solution: a point of the space that Newton's method works in.
#[derive(Debug, Default)]
pub struct Solution<const N: usize, const M: usize, const L: usize = 0> {
    /// The mesh.
    pub mesh: Mesh,
    /// From which side elements take the closure variable.
    pub directions: Directions,
    /// States at the nodes.
    pub nodes: Vec<[f64; N]>,
    /// The stages in the blocks of [`Groups`].
    pub stages: Vec<Stage<N, L>>,
    /// The ends in the blocks of [`Directions::ends`].
    pub ends: Vec<End<L>>,
}

impl<const N: usize, const M: usize, const L: usize> Clone for Solution<N, M, L> {
    fn clone(&self) -> Self {
        Self {
            mesh: self.mesh.clone(),
            directions: self.directions.clone(),
            nodes: self.nodes.clone(),
            stages: self.stages.clone(),
            ends: self.ends.clone(),
        }
    }

    /// Without allocation where there is room.
    fn clone_from(&mut self, other: &Self) {
        self.mesh.clone_from(&other.mesh);
        self.directions.clone_from(&other.directions);
        self.nodes.clone_from(&other.nodes);
        self.stages.clone_from(&other.stages);
        self.ends.clone_from(&other.ends);
    }
}

/// The unknowns of the closure at a place of one element.
#[derive(Debug, Clone, Copy)]
pub struct InnerState<const L: usize> {
    /// Inner unknowns.
    pub inner: [f64; L],
    /// Slope of the closure variable.
    pub closure_slope: f64,
}

impl<const N: usize, const M: usize, const L: usize> Solution<N, M, L> {
    /// The state `z` everywhere, with the inner unknowns `inner`, and no closure variable yet.
    pub fn constant(mesh: Mesh, z: [f64; N], inner: [f64; L]) -> Self {
        let n = mesh.elements();
        let groups = Groups { elements: n, stages: M };
        let stage = Stage { inner: inner.map(|v| Lanes([v; LANES])), ..Stage::default() };
        Self {
            mesh,
            directions: Directions::default(),
            nodes: vec![z; n + 1],
            stages: vec![stage; groups.count() * M],
            ends: Vec::new(),
        }
    }

    /// How the stages stand in blocks.
    #[inline(always)]
    pub fn groups(&self) -> Groups {
        Groups { elements: self.mesh.elements(), stages: M }
    }

    /// Slope of the state at stage `j` of element `i`.
    #[inline(always)]
    pub fn slope(&self, i: usize, j: usize) -> [f64; N] {
        let (block, lane) = self.groups().at(i, j);
        self.stages[block].slope.map(|v| v.0[lane])
    }

    /// Inner unknowns and closure slope at stage `j` of element `i`.
    #[inline(always)]
    pub fn inner(&self, i: usize, j: usize) -> InnerState<L> {
        let (block, lane) = self.groups().at(i, j);
        let stage = &self.stages[block];
        InnerState { inner: stage.inner.map(|v| v.0[lane]), closure_slope: stage.closure_slope.0[lane] }
    }

    /// The same at the own end of element `i`, for problems with a closure variable.
    pub fn inner_at_own_end(&self, i: usize) -> InnerState<L> {
        let (block, lane) = (i / LANES, i % LANES);
        let end = &self.ends[block];
        InnerState { inner: end.inner.map(|v| v.0[lane]), closure_slope: end.closure_slope.0[lane] }
    }

    /// The state of element `i` where the integrals of the cardinal polynomials are `weights`.
    fn weighed(&self, i: usize, weights: &[f64; M]) -> [f64; N] {
        let h = self.mesh.step(i);
        let mut z = self.nodes[i];
        for (j, w) in weights.iter().enumerate() {
            let slope = self.slope(i, j);
            for a in 0..N {
                z[a] += h * w * slope[a];
            }
        }
        z
    }

    /// State at `s` from the collocation polynomial of element `i`.
    pub fn state_in(&self, gauss: &Gauss<M>, i: usize, s: f64) -> [f64; N] {
        self.weighed(i, &gauss.integrals((s - self.mesh.nodes()[i]) / self.mesh.step(i)))
    }

    /// Slope of the state at `x` in [0, 1] of element `i` by the polynomial through the stages.
    pub fn slope_in(&self, gauss: &Gauss<M>, i: usize, x: f64) -> [f64; N] {
        self.slope_by(&gauss.cardinals(x), i)
    }

    fn slope_by(&self, cardinals: &[f64; M], i: usize) -> [f64; N] {
        let mut out = [0.0; N];
        for (j, w) in cardinals.iter().enumerate() {
            let slope = self.slope(i, j);
            for a in 0..N {
                out[a] += w * slope[a];
            }
        }
        out
    }

    /// Inner unknowns and closure slope at `x` in [0, 1] of element `i`, by the polynomials through the stages and, where there is a
    /// closure variable, the ends. (The closure slope is of the degree that stages and own end settle.)
    pub fn inner_in(&self, gauss: &Gauss<M>, i: usize, x: f64) -> InnerState<L> {
        self.inner_by(gauss, &gauss.cardinals(x), i, x)
    }

    /// [`Solution::inner_in`], given the cardinal polynomials at `x`.
    fn inner_by(&self, gauss: &Gauss<M>, cardinals: &[f64; M], i: usize, x: f64) -> InnerState<L> {
        let mut out = InnerState { inner: [0.0; L], closure_slope: 0.0 };
        if const { L == 0 } || !self.directions.is_closed() {
            for (j, w) in cardinals.iter().enumerate() {
                let of = self.inner(i, j).inner;
                for a in 0..L {
                    out.inner[a] += w * of[a];
                }
            }
            return out;
        }
        let side = self.directions.side(i);
        let place = side.place();
        let own = self.inner_at_own_end(i);
        let mut ends = [own.inner; 2];
        ends[side.other().index()] = self.inner_at_other_end(i);
        let ([left, right], mut slope_at_own) = ([x, 1.0 - x], 1.0);
        let mut at_ends = [right, left];
        for c in gauss.c {
            at_ends[0] *= (x - c) / -c;
            at_ends[1] *= (x - c) / (1.0 - c);
            slope_at_own *= (x - c) / (place - c);
        }
        for j in 0..M {
            let (of, c) = (self.inner(i, j), gauss.c[j]);
            let weight = cardinals[j] * x * (x - 1.0) / (c * (c - 1.0));
            for a in 0..L {
                out.inner[a] += weight * of.inner[a];
            }
            out.closure_slope += cardinals[j] * (x - place) / (c - place) * of.closure_slope;
        }
        for a in 0..L {
            out.inner[a] += at_ends[0] * ends[0][a] + at_ends[1] * ends[1][a];
        }
        out.closure_slope += slope_at_own * own.closure_slope;
        out
    }

    /// Inner unknowns at the end of element `i` that is not its own.
    pub(crate) fn inner_at_other_end(&self, i: usize) -> [f64; L] {
        let (block, lane) = self.directions.end_taken(i);
        self.ends[block].inner.map(|v| v.0[lane])
    }

    /// Carries the solution over to the mesh of `out` by its polynomials; elements that both meshes have stay as they are. `jumps`
    /// say where the new elements take the closure variable over; see [`Directions::set`].
    pub fn remap(&self, gauss: &Gauss<M>, jumps: impl Fn(f64) -> bool, out: &mut Self) {
        let n = out.mesh.elements();
        let groups = Groups { elements: n, stages: M };
        out.nodes.clear();
        make_room(&mut out.nodes, n + 1);
        resize(&mut out.stages, groups.count() * M, Stage::default());
        let old = self.mesh.nodes();
        let mut e = 0;
        let advance = |e: &mut usize, s: f64| {
            while *e + 1 < self.mesh.elements() && old[*e + 1] <= s {
                *e += 1;
            }
            *e
        };
        for i in 0..n {
            let (s, h) = (out.mesh.nodes()[i], out.mesh.step(i));
            let own = advance(&mut e, s);
            out.nodes.push(if s == old[own] { self.nodes[own] } else { self.state_in(gauss, own, s) });
            let kept = s == old[own] && out.mesh.nodes()[i + 1] == old[own + 1];
            let (block, lane) = groups.at(i, 0);
            for j in 0..M {
                let (slope, inner) = if kept {
                    (self.slope(own, j), self.inner(own, j))
                } else {
                    let at = s + h * gauss.c[j];
                    let from = advance(&mut e, at);
                    let x = (at - old[from]) / self.mesh.step(from);
                    let cardinals = gauss.cardinals(x);
                    (self.slope_by(&cardinals, from), self.inner_by(gauss, &cardinals, from, x))
                };
                let stage = &mut out.stages[block + j];
                put(stage, lane, &slope, &inner);
                if i + 1 == n {
                    for lane in lane + 1..LANES {
                        put(stage, lane, &slope, &inner);
                    }
                }
            }
        }
        out.nodes.push(self.nodes[self.mesh.elements()]);
        if const { L == 0 } || !self.directions.is_closed() {
            out.directions.clear();
            out.ends.clear();
            return;
        }
        let Self { mesh, directions, .. } = out;
        let nodes = mesh.nodes();
        let middle = |i: usize| 0.5 * (nodes[i] + nodes[i + 1]);
        let sides = (0..n).map(|i| self.directions.side(self.mesh.element_of(middle(i))));
        directions.set(sides, |node| jumps(nodes[node]));
        self.fill_ends(gauss, out);
    }

    /// This solution's polynomials sampled with `K` stages on the same mesh.
    #[inline(always)]
    pub fn resample<const K: usize>(&self, weights: &Resampling<M, K>, out: &mut Solution<N, K, L>) {
        let groups = self.groups();
        out.mesh.clone_from(&self.mesh);
        out.directions.clone_from(&self.directions);
        out.nodes.clone_from(&self.nodes);
        out.ends.clone_from(&self.ends);
        resize(&mut out.stages, groups.count() * K, Stage::default());
        let closed = L > 0 && self.directions.is_closed();
        for g in 0..groups.count() {
            let own = &self.stages[g * M..(g + 1) * M];
            let mut right = Lanes::default();
            // Inner unknowns at the left and the right end.
            let mut ends = [[Lanes::default(); L]; 2];
            if closed {
                for lane in 0..LANES {
                    let i = groups.element(g, lane);
                    let side = self.directions.side(i);
                    right.0[lane] = side.place();
                    let other = self.inner_at_other_end(i);
                    for a in 0..L {
                        ends[side.index()][a].0[lane] = self.ends[g].inner[a].0[lane];
                        ends[side.other().index()][a].0[lane] = other[a];
                    }
                }
            }
            for (j, stage) in out.stages[g * K..(g + 1) * K].iter_mut().enumerate() {
                let mut new = Stage::default();
                for m in 0..M {
                    let w = Lanes([weights.values[j][m]; LANES]);
                    for a in 0..N {
                        new.slope[a] += w * own[m].slope[a];
                    }
                    let w = Lanes([if closed { weights.inner[j].0[m] } else { weights.values[j][m] }; LANES]);
                    for a in 0..L {
                        new.inner[a] += w * own[m].inner[a];
                    }
                    if closed {
                        let [on_left, on_right] = [weights.slopes[0][j].0[m], weights.slopes[1][j].0[m]];
                        let w = Lanes([on_left; LANES]) + right * Lanes([on_right - on_left; LANES]);
                        new.closure_slope += w * own[m].closure_slope;
                    }
                }
                if closed {
                    for (end, weight) in ends.iter().zip(weights.inner[j].1) {
                        for a in 0..L {
                            new.inner[a] += Lanes([weight; LANES]) * end[a];
                        }
                    }
                    let [on_left, on_right] = [weights.slopes[0][j].1, weights.slopes[1][j].1];
                    let w = Lanes([on_left; LANES]) + right * Lanes([on_right - on_left; LANES]);
                    new.closure_slope += w * self.ends[g].closure_slope;
                }
                *stage = new;
            }
        }
    }

    /// Fills the ends of `out` with what this solution's polynomials have there.
    fn fill_ends(&self, gauss: &Gauss<M>, out: &mut Self) {
        let Solution { mesh, directions, ends, .. } = out;
        ends.clear();
        make_room(ends, directions.ends.len());
        let old = &self.mesh;
        for place in directions.ends() {
            let mut end = End::default();
            for lane in 0..LANES {
                let (i, side) = (place.elements[lane], place.sides[lane]);
                let s = mesh.nodes()[i + side.index()];
                // The element of the old mesh on the same side of a jump.
                let from = old.element_of(mesh.nodes()[i] + 0.5 * mesh.step(i));
                let inside = s >= old.nodes()[from] && s <= old.nodes()[from + 1];
                let from = match (inside, side) {
                    (true, _) => from,
                    (false, Side::Left) => old.element_of(s),
                    (false, Side::Right) => old.nodes().partition_point(|node| *node < s).clamp(1, old.elements()) - 1,
                };
                let kept = self.directions.is_closed()
                    && old.nodes()[from..from + 2] == mesh.nodes()[i..i + 2]
                    && self.directions.side(from) == side
                    && directions.side(i) == side;
                let inner = if kept {
                    self.inner_at_own_end(from)
                } else {
                    self.inner_in(gauss, from, (s - old.nodes()[from]) / old.step(from))
                };
                for a in 0..L {
                    end.inner[a].0[lane] = inner.inner[a];
                }
                end.closure_slope.0[lane] = inner.closure_slope;
            }
            ends.push(end);
        }
    }

    /// This solution with an own end given to every element, and the unknowns there by extrapolation; see [`Directions::set`].
    pub fn with_sides(
        &self,
        gauss: &Gauss<M>,
        side: impl Fn(usize) -> Side,
        jumps: impl Fn(f64) -> bool,
        out: &mut Self,
    ) {
        out.clone_from(self);
        let nodes = self.mesh.nodes();
        out.directions.set((0..self.mesh.elements()).map(side), |node| jumps(nodes[node]));
        self.fill_ends(gauss, out);
    }

    /// Moves the solution on by `fraction` times its way from the solution `before`; false, and as it was, where the two do not correspond.
    pub fn extrapolate(&mut self, before: &Self, fraction: f64) -> bool {
        if self.nodes.len() != before.nodes.len() || self.directions != before.directions {
            return false;
        }
        let by = Lanes([fraction; LANES]);
        let nodes = self.nodes.as_flattened_mut().iter_mut().zip(before.nodes.as_flattened());
        nodes.for_each(|(own, other)| *own += fraction * (*own - other));
        for (own, other) in self.stages.iter_mut().zip(&before.stages) {
            own.slope.iter_mut().zip(&other.slope).for_each(|(own, other)| *own += by * (*own - *other));
            own.inner.iter_mut().zip(&other.inner).for_each(|(own, other)| *own += by * (*own - *other));
            own.closure_slope += by * (own.closure_slope - other.closure_slope);
        }
        for (own, other) in self.ends.iter_mut().zip(&before.ends) {
            own.inner.iter_mut().zip(&other.inner).for_each(|(own, other)| *own += by * (*own - *other));
            own.closure_slope += by * (own.closure_slope - other.closure_slope);
        }
        true
    }
}

/// Weights that take the stages of one method to those of another.
#[derive(Debug, Clone)]
pub struct Resampling<const M: usize, const K: usize> {
    values: [[f64; M]; K],
    /// With both ends.
    inner: [([f64; M], [f64; 2]); K],
    /// With the own end, on either side.
    slopes: [[([f64; M], f64); K]; 2],
}

impl<const M: usize, const K: usize> Resampling<M, K> {
    /// From one method to another.
    pub fn new(from: &Gauss<M>, to: &Gauss<K>) -> Self {
        Self {
            values: to.c.map(|x| from.cardinals(x)),
            inner: to.c.map(|x| from.cardinals_with_ends(x)),
            slopes: [Side::Left, Side::Right].map(|side| to.c.map(|x| from.cardinals_with_end(x, side.place()))),
        }
    }
}

#[inline(always)]
fn put<const N: usize, const L: usize>(stage: &mut Stage<N, L>, lane: usize, slope: &[f64; N], inner: &InnerState<L>) {
    for a in 0..N {
        stage.slope[a].0[lane] = slope[a];
    }
    for a in 0..L {
        stage.inner[a].0[lane] = inner.inner[a];
    }
    stage.closure_slope.0[lane] = inner.closure_slope;
}
