//! Adjoints: weights on the changes of a solution as weights on changes of its equations.

use super::Collocation;
use super::closing::Closing;
use crate::condense::solve_column_transposed;
use crate::directions::Side;
use crate::gauss::POINTS;
use crate::panels::{AtNodes, Loads};
use crate::real::{LANES, Lanes, Real};

/// Weights at a stage of four elements: on the change of the state, and of the closure slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageWeights<const N: usize> {
    /// On the state.
    pub state: [Lanes; N],
    /// On the closure slope.
    pub closure_slope: Lanes,
}

impl<const N: usize> Default for StageWeights<N> {
    fn default() -> Self {
        Self { state: [Lanes::default(); N], closure_slope: Lanes::default() }
    }
}

/// A linear functional of the change of a solution.
#[derive(Debug, Clone)]
pub struct Functional<const N: usize> {
    /// Weights on the states of nodes.
    pub nodes: Vec<(usize, [f64; N])>,
    /// At the stages, in blocks; empty where there are none.
    pub stages: Vec<StageWeights<N>>,
    /// At ends at which elements meet the closure's equation.
    pub ends: Vec<EndWeights<N>>,
}

/// Weights at one end, which the blocks of [`Directions::ends`](crate::Directions::ends) hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndWeights<const N: usize> {
    /// Its block.
    pub block: usize,
    /// Its lane.
    pub lane: usize,
    /// On the state.
    pub state: [f64; N],
    /// On the closure slope.
    pub closure_slope: f64,
}

impl<const N: usize> Default for Functional<N> {
    fn default() -> Self {
        Self { nodes: Vec::new(), stages: Vec::new(), ends: Vec::new() }
    }
}

/// Weights on changes of the equations.
#[derive(Debug, Clone, Default)]
pub struct Cotangent<const N: usize> {
    /// On those of the slopes at the stages, in blocks.
    pub slopes: Vec<[Lanes; N]>,
    /// On those of the closure variable there, and at the ends in blocks.
    pub values: Vec<Lanes>,
    /// See `values`.
    pub ends: Vec<Lanes>,
    /// On those of the residuals of the conditions at s = 0.
    pub left: Vec<f64>,
    /// On those at s = 1.
    pub right: Vec<f64>,
}

/// What the weights of a group come to before the nodes are known.
#[derive(Debug, Clone, Copy)]
struct Gathered<const N: usize, const M: usize> {
    /// On the stage slopes.
    slopes: [[Lanes; N]; M],
    /// On the state at the left node, and on what the elements take over.
    node: [Lanes; N],
    taken: Lanes,
    /// On the closure slope of the own ends, and on w at the points, by the weights at ends.
    own_slope: Lanes,
    points: [Lanes; POINTS],
}

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Collocation<N, M, Q, L> {
    /// Weights at the stages of group `g` as weights on its stage slopes and on what it is given.
    #[inline(always)]
    fn gather(&self, g: usize, weights: &[StageWeights<N>], ends: &[EndWeights<N>]) -> Gathered<N, M> {
        let zero = Lanes::of(0.0);
        let mut out =
            Gathered { slopes: [[zero; N]; M], node: [zero; N], taken: zero, own_slope: zero, points: [zero; POINTS] };
        for j in 0..M {
            self.add_state_weights(g, j, &weights[j].state, &mut out);
        }
        if const { L > 0 } && self.directions.is_closed() {
            let (closure, w) = (&self.condensed.closures[g], self.condensed.w(g));
            self.gather_ends(g, ends, &mut out);
            out.taken += out.own_slope * closure.omega[M];
            for m in 0..M + 1 {
                let mut on_value = out.points[m] + out.own_slope * w[M][m];
                for j in 0..M {
                    on_value += weights[j].closure_slope * w[j][m];
                }
                let gradient = self.inner_at(g, m).value_gradient;
                self.add_state_weights(g, m, &gradient.map(|v| on_value * v), &mut out);
            }
            for j in 0..M {
                out.taken += weights[j].closure_slope * closure.omega[j];
            }
        }
        for l in 0..M {
            for a in 0..N {
                let own = out.slopes[l][a];
                for b in 0..N {
                    out.node[b] += self.condensed.by_state(g)[l][a][b] * own;
                }
                if const { L > 0 } && self.directions.is_closed() {
                    out.taken += self.condensed.by_taken(g)[l][a] * own;
                }
            }
        }
        out
    }

    /// Puts the weights at the ends of group `g` on states, on what is taken over, on the closure slope of the own ends, and, by that of
    /// other ends, on w at the points.
    fn gather_ends(&self, g: usize, ends: &[EndWeights<N>], out: &mut Gathered<N, M>) {
        for end in ends {
            if end.block < self.groups.count() {
                if end.block == g {
                    let mut state = [Lanes::default(); N];
                    for a in 0..N {
                        state[a].0[end.lane] = end.state[a];
                    }
                    self.add_state_weights(g, M, &state, out);
                    out.own_slope.0[end.lane] += end.closure_slope;
                }
                continue;
            }
            let Some(closing) = self.closing_at(end).filter(|c| c.element / LANES == g) else { continue };
            let lane = closing.element % LANES;
            let at_right = self.directions.side(closing.element) == Side::Left;
            for a in 0..N {
                out.node[a].0[lane] += end.state[a];
                for l in 0..M {
                    if at_right {
                        out.slopes[l][a].0[lane] += self.steps[g].0[lane] * self.gauss.b[l] * end.state[a];
                    }
                }
            }
            for m in 0..M + 1 {
                out.points[m].0[lane] += end.closure_slope * closing.slope_by_point[m];
            }
            out.taken.0[lane] += end.closure_slope * closing.slope_by_taken;
        }
    }

    fn closing_at(&self, end: &EndWeights<N>) -> Option<&Closing<N, M>> {
        self.closings.iter().find(|c| c.block == end.block && c.lane == end.lane)
    }

    /// Adds weights on the state at point `m` of group `g` to those on its slopes and its left node.
    #[inline(always)]
    fn add_state_weights(&self, g: usize, m: usize, weights: &[Lanes; N], out: &mut Gathered<N, M>) {
        let h = self.steps[g];
        for l in 0..M {
            let upto = if m < M {
                Lanes::of(self.gauss.a[m][l])
            } else {
                self.condensed.closures[g].right * Lanes::of(self.gauss.b[l])
            };
            for a in 0..N {
                out.slopes[l][a] += h * upto * weights[a];
            }
        }
        for a in 0..N {
            out.node[a] += weights[a];
        }
    }

    /// What elements gather, put on the nodes.
    fn scatter(&self, gathered: &[Gathered<N, M>], out: &mut AtNodes<N>) {
        for i in 0..self.groups.elements {
            let (g, lane) = (i / LANES, i % LANES);
            for a in 0..N {
                out.z[i][a] += gathered[g].node[a].0[lane];
            }
            if const { L > 0 } && self.directions.is_closed() && !self.directions.closings.contains(&i) {
                let node = if self.directions.side(i) == Side::Left { i + 1 } else { i };
                out.w[node] += gathered[g].taken.0[lane];
            }
        }
        for closing in &self.closings {
            let (g, lane) = (closing.element / LANES, closing.element % LANES);
            for a in 0..N {
                out.z[closing.element][a] += closing.row[a] * gathered[g].taken.0[lane];
            }
        }
    }

    /// The weights on changes of the equations that a functional of the change of the solution comes to.
    pub fn adjoint(&self, functional: &Functional<N>) -> Cotangent<N> {
        let groups = self.groups;
        let zero = Lanes::of(0.0);
        let none = [StageWeights::default(); M];
        let weights = |g: usize| {
            if functional.stages.is_empty() { &none[..] } else { &functional.stages[g * M..(g + 1) * M] }
        };
        let gathered: Vec<_> = (0..groups.count()).map(|g| self.gather(g, weights(g), &functional.ends)).collect();
        let mut nodes = AtNodes::default();
        nodes.clear(groups.elements + 1);
        for (i, weights) in &functional.nodes {
            for a in 0..N {
                nodes.z[*i][a] += weights[a];
            }
        }
        self.scatter(&gathered, &mut nodes);
        let (mut rows, mut memory) = (Loads::default(), Vec::new());
        self.panels.solve_transposed(&nodes, &mut rows, &mut memory);
        let mut out = Cotangent {
            slopes: vec![[zero; N]; groups.count() * M],
            values: vec![zero; groups.count() * M],
            ends: vec![zero; self.end_stations.len()],
            left: rows.left.iter().map(|v| -v).collect(),
            right: rows.right.iter().map(|v| -v).collect(),
        };
        for g in 0..groups.count() {
            let h = self.steps[g];
            let (mut jump, mut own) = ([zero; N], zero);
            let mut on_closing = zero;
            for lane in 0..groups.filled(g) {
                let i = g * LANES + lane;
                for a in 0..N {
                    jump[a].0[lane] = rows.transitions[i][a];
                }
                own.0[lane] = rows.own[i];
            }
            let mut slopes = gathered[g].slopes;
            let mut on_value = [zero; POINTS];
            for l in 0..M {
                let weight = h * Lanes::of(self.gauss.b[l]);
                for a in 0..N {
                    slopes[l][a] += weight * jump[a];
                    if const { L > 0 } && self.directions.is_closed() {
                        slopes[l][a] += h * self.condensed.closures[g].own_by_slopes[l][a] * own;
                    }
                }
            }
            for closing in self.closings.iter().filter(|c| c.element / LANES == g) {
                let lane = closing.element % LANES;
                let mut taken = gathered[g].taken.0[lane] + closing.own_by_taken * own.0[lane];
                for a in 0..N {
                    taken += closing.by_taken[a] * jump[a].0[lane];
                }
                on_closing.0[lane] = taken;
                for l in 0..M {
                    for a in 0..N {
                        slopes[l][a].0[lane] += closing.by_slopes[l][a] * taken;
                    }
                }
                for m in 0..M + 1 {
                    on_value[m].0[lane] += closing.by_value[m] * taken;
                }
                out.ends[closing.block].0[closing.lane] = closing.by_change * taken;
            }
            // Lanes that repeat the last element have no weights.
            for lane in groups.filled(g)..LANES {
                slopes.as_flattened_mut().iter_mut().for_each(|v| v.0[lane] = 0.0);
            }
            solve_column_transposed(self.condensed.lu(g), &mut slopes);
            if const { L > 0 } && self.directions.is_closed() {
                let (closure, w) = (&self.condensed.closures[g], self.condensed.w(g));
                for j in 0..M {
                    let mut on_slope = weights(g)[j].closure_slope;
                    for lane in groups.filled(g)..LANES {
                        on_slope.0[lane] = 0.0;
                    }
                    for a in 0..N {
                        on_slope += self.locals[g * M + j].by_closure[a] * slopes[j][a];
                    }
                    for m in 0..M + 1 {
                        on_value[m] += w[j][m] * on_slope;
                    }
                }
                for m in 0..M + 1 {
                    on_value[m] += closure.own[m] * own + gathered[g].points[m] + w[M][m] * gathered[g].own_slope;
                }
                out.ends[g] = on_value[M];
            }
            for j in 0..M {
                out.slopes[g * M + j] = slopes[j];
                out.values[g * M + j] = on_value[j];
            }
        }
        out
    }

    /// What each element's residual contributes to the last Newton correction of the totals, as the sum over the `Q` totals of
    /// absolute values. To it comes the change of each element's own quadratures against `before`.
    #[inline(always)]
    pub fn contributions(&mut self, before: &[[f64; Q]], out: &mut Vec<f64>) {
        let groups = self.groups;
        out.clear();
        out.resize(groups.elements, 0.0);
        let memory = std::mem::take(&mut self.memory);
        let (mut rows, mut scratch, mut nodes) = (Loads::default(), Vec::new(), AtNodes::default());
        let mut gathered = Vec::with_capacity(groups.count());
        for q in 0..Q {
            gathered.clear();
            nodes.clear(groups.elements + 1);
            for g in 0..groups.count() {
                let (h, column) = (self.steps[g], &memory.columns[g]);
                let mut own = Lanes::of(0.0);
                let mut weights = [StageWeights::default(); M];
                for j in 0..M {
                    let weight = h * Lanes::of(self.gauss.b[j]);
                    let local = &self.locals[g * M + j];
                    own += weight * local.rate[q];
                    for a in 0..N {
                        weights[j].state[a] = weight * local.rate_gradient[q][a];
                    }
                    weights[j].closure_slope = weight * local.rate_by_closure[q];
                    own += weights[j].closure_slope * column.closure[j];
                }
                let found = self.gather(g, &weights, &[]);
                for l in 0..M {
                    for a in 0..N {
                        own += found.slopes[l][a] * column.slopes[l][a];
                    }
                }
                for lane in 0..groups.filled(g) {
                    let i = g * LANES + lane;
                    out[i] += (own.0[lane] - before[i][q]).abs();
                }
                gathered.push(found);
            }
            self.scatter(&gathered, &mut nodes);
            self.panels.solve_transposed(&nodes, &mut rows, &mut scratch);
            for i in 0..groups.elements {
                let mut total = rows.own[i] * memory.loads.own[i];
                for a in 0..N {
                    total += rows.transitions[i][a] * memory.loads.transitions[i][a];
                }
                out[i] += total.abs();
            }
        }
        self.memory = memory;
    }
}
