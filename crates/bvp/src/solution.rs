//! Discrete solutions, and corrections of them.

use crate::directions::{Directions, Side};
use crate::gauss::Gauss;
use crate::groups::Groups;
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

    /// The state at stage `j` of element `i`.
    pub fn stage_state(&self, gauss: &Gauss<M>, i: usize, j: usize) -> [f64; N] {
        self.weighed(i, &gauss.a[j])
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
        let mut out = [0.0; N];
        for (j, w) in gauss.cardinals(x).iter().enumerate() {
            let slope = self.slope(i, j);
            for a in 0..N {
                out[a] += w * slope[a];
            }
        }
        out
    }

    /// Inner unknowns and closure slope at `x` in [0, 1] of element `i`, by the polynomials through the stages and, where there is a
    /// closure variable, the own end.
    pub fn inner_in(&self, gauss: &Gauss<M>, i: usize, x: f64) -> InnerState<L> {
        let mut out = InnerState { inner: [0.0; L], closure_slope: 0.0 };
        let mut add = |weight: f64, of: InnerState<L>| {
            for a in 0..L {
                out.inner[a] += weight * of.inner[a];
            }
            out.closure_slope += weight * of.closure_slope;
        };
        if self.directions.is_closed() {
            let (at_stages, at_end) = gauss.cardinals_with_end(x, self.directions.side(i).place());
            for (j, w) in at_stages.iter().enumerate() {
                add(*w, self.inner(i, j));
            }
            add(at_end, self.inner_at_own_end(i));
        } else {
            for (j, w) in gauss.cardinals(x).iter().enumerate() {
                add(*w, self.inner(i, j));
            }
        }
        out
    }

    /// Carries the solution over to `mesh` by its polynomials; elements that both meshes have stay as they are. `side` and `jumps`
    /// say where the new elements take the closure variable over; see [`Directions::set`]. `sampled` is the solution to fill; it may
    /// have another number of stages.
    pub fn onto<const K: usize>(
        &self,
        gauss: &Gauss<M>,
        stages: &Gauss<K>,
        jumps: impl Fn(f64) -> bool,
        out: &mut Solution<N, K, L>,
    ) {
        let n = out.mesh.elements();
        let groups = Groups { elements: n, stages: K };
        let same = K == M;
        out.nodes.clear();
        out.stages.resize(groups.count() * K, Stage::default());
        let old = self.mesh.nodes();
        let mut sides = Vec::with_capacity(n);
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
            let kept = same && s == old[own] && out.mesh.nodes()[i + 1] == old[own + 1];
            let (block, lane) = groups.at(i, 0);
            for j in 0..K {
                let (slope, inner) = if kept {
                    (self.slope(own, j), self.inner(own, j))
                } else {
                    let at = s + h * stages.c[j];
                    let from = advance(&mut e, at);
                    let x = (at - old[from]) / self.mesh.step(from);
                    (self.slope_in(gauss, from, x), self.inner_in(gauss, from, x))
                };
                let stage = &mut out.stages[block + j];
                put(stage, lane, &slope, &inner);
                if i + 1 == n {
                    for lane in lane + 1..LANES {
                        put(stage, lane, &slope, &inner);
                    }
                }
            }
            let middle = s + 0.5 * h;
            sides.push(self.directions.side(self.mesh.element_of(middle)));
        }
        out.nodes.push(self.nodes[self.mesh.elements()]);
        if !self.directions.is_closed() {
            out.directions.clear();
            out.ends.clear();
            return;
        }
        let nodes = out.mesh.nodes();
        out.directions.set(sides.into_iter(), |node| jumps(nodes[node]));
        self.fill_ends(gauss, out);
    }

    /// Fills the ends of `out` with what this solution's polynomials have there.
    fn fill_ends<const K: usize>(&self, gauss: &Gauss<M>, out: &mut Solution<N, K, L>) {
        let Solution { mesh, directions, ends, .. } = out;
        ends.clear();
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
                let inner = self.inner_in(gauss, from, (s - old.nodes()[from]) / old.step(from));
                for a in 0..L {
                    end.inner[a].0[lane] = inner.inner[a];
                }
                end.closure_slope.0[lane] = inner.closure_slope;
            }
            ends.push(end);
        }
    }

    /// Gives every element an own end, and the unknowns there by extrapolation.
    pub fn set_directions(
        &mut self,
        gauss: &Gauss<M>,
        side: impl Fn(usize) -> Side,
        jumps: impl Fn(f64) -> bool,
    ) {
        let before = self.clone();
        let n = self.mesh.elements();
        let nodes = self.mesh.nodes();
        self.directions.set((0..n).map(side), |node| jumps(nodes[node]));
        before.fill_ends(gauss, self);
    }

    /// Moves the solution on by `share` times its way from the solution `before`; false, and as it was, where the two do not correspond.
    pub fn lead_on(&mut self, before: &Self, share: f64) -> bool {
        if self.nodes.len() != before.nodes.len() || self.directions != before.directions {
            return false;
        }
        let by = Lanes([share; LANES]);
        let nodes = self.nodes.as_flattened_mut().iter_mut().zip(before.nodes.as_flattened());
        nodes.for_each(|(own, other)| *own += share * (*own - other));
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

    /// Adds `factor` times a correction.
    #[inline(always)]
    pub fn add<const Q: usize>(&mut self, correction: &Correction<N, M, Q, L>, factor: f64) {
        for (z, dz) in self.nodes.iter_mut().zip(&correction.nodes) {
            for a in 0..N {
                z[a] += factor * dz[a];
            }
        }
        let f = Lanes([factor; LANES]);
        for (own, change) in self.stages.iter_mut().zip(&correction.stages) {
            for a in 0..N {
                own.slope[a] += f * change.slope[a];
            }
            for a in 0..L {
                own.inner[a] += f * change.inner[a];
            }
            own.closure_slope += f * change.closure_slope;
        }
        for (own, change) in self.ends.iter_mut().zip(&correction.ends) {
            for a in 0..L {
                own.inner[a] += f * change.inner[a];
            }
            own.closure_slope += f * change.closure_slope;
        }
    }
}

#[inline(always)]
fn put<const N: usize, const L: usize>(
    stage: &mut Stage<N, L>,
    lane: usize,
    slope: &[f64; N],
    inner: &InnerState<L>,
) {
    for a in 0..N {
        stage.slope[a].0[lane] = slope[a];
    }
    for a in 0..L {
        stage.inner[a].0[lane] = inner.inner[a];
    }
    stage.closure_slope.0[lane] = inner.closure_slope;
}

/// A Newton correction, or a tangent.
#[derive(Debug, Clone)]
pub struct Correction<const N: usize, const M: usize, const Q: usize, const L: usize = 0> {
    /// At the nodes.
    pub nodes: Vec<[f64; N]>,
    /// At the stages, in blocks.
    pub stages: Vec<Stage<N, L>>,
    /// At the ends, in blocks.
    pub ends: Vec<End<L>>,
    /// Of the quadratures over each element.
    pub by_element: Vec<[f64; Q]>,
    /// Of the quadratures over [0, 1].
    pub total: [f64; Q],
}

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Default for Correction<N, M, Q, L> {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            stages: Vec::new(),
            ends: Vec::new(),
            by_element: Vec::new(),
            total: [0.0; Q],
        }
    }
}

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Correction<N, M, Q, L> {
    /// Multiplies it by `factor`.
    pub fn scale(&mut self, factor: f64) {
        let by = Lanes([factor; LANES]);
        self.nodes.as_flattened_mut().iter_mut().for_each(|v| *v *= factor);
        for stage in &mut self.stages {
            stage.slope.iter_mut().for_each(|v| *v = *v * by);
            stage.inner.iter_mut().for_each(|v| *v = *v * by);
            stage.closure_slope = stage.closure_slope * by;
        }
        for end in &mut self.ends {
            end.inner.iter_mut().for_each(|v| *v = *v * by);
            end.closure_slope = end.closure_slope * by;
        }
        self.by_element.as_flattened_mut().iter_mut().for_each(|v| *v *= factor);
        self.total.iter_mut().for_each(|v| *v *= factor);
    }

    /// Adds `factor` times another correction on the same mesh.
    pub fn add(&mut self, other: &Self, factor: f64) {
        let by = Lanes([factor; LANES]);
        let plain = |own: &mut [f64], other: &[f64]| {
            own.iter_mut().zip(other).for_each(|(own, other)| *own += factor * other);
        };
        plain(self.nodes.as_flattened_mut(), other.nodes.as_flattened());
        plain(self.by_element.as_flattened_mut(), other.by_element.as_flattened());
        plain(&mut self.total, &other.total);
        for (own, other) in self.stages.iter_mut().zip(&other.stages) {
            own.slope.iter_mut().zip(&other.slope).for_each(|(own, other)| *own += by * *other);
            own.inner.iter_mut().zip(&other.inner).for_each(|(own, other)| *own += by * *other);
            own.closure_slope += by * other.closure_slope;
        }
        for (own, other) in self.ends.iter_mut().zip(&other.ends) {
            own.inner.iter_mut().zip(&other.inner).for_each(|(own, other)| *own += by * *other);
            own.closure_slope += by * other.closure_slope;
        }
    }

    /// Largest change of component `a` at the nodes.
    pub fn largest(&self, a: usize) -> f64 {
        self.nodes.iter().fold(0.0, |m, z| if z[a].is_nan() { f64::NAN } else { f64::max(m, z[a].abs()) })
    }
}
