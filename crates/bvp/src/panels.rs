//! The condensed equations between neighbouring nodes and the end conditions: an almost block diagonal system.
//!
//! Gaussian elimination with row pivoting, node by node from s = 0, which is stable where growing and decaying solutions mix and
//! shooting from either end overflows (Ascher, Mattheij and Russell, "Numerical solution of boundary value problems for ordinary differential
//! equations", 1995, chapter 7). The factors serve right sides, their transposes and the determinant.
//!
//! The unknowns of a node are its state and, where an element takes the closure variable over from its neighbour there, that.

use crate::condense::Map;
use crate::determinant::{Determinant, Product};
use crate::directions::{Directions, Flow, Side};
use crate::problem::Condition;
use crate::real::Real;

/// A row between two neighbouring nodes.
#[derive(Debug, Clone, Copy)]
struct Row<const N: usize> {
    own: [f64; N],
    own_w: f64,
    next: [f64; N],
    next_w: f64,
}

impl<const N: usize> Row<N> {
    const ZERO: Self = Self { own: [0.0; N], own_w: 0.0, next: [0.0; N], next_w: 0.0 };

    #[inline(always)]
    fn at(&self, k: usize) -> f64 {
        if k < N { self.own[k] } else { self.own_w }
    }
}

/// The rows that eliminate the unknowns of a node.
#[derive(Debug, Clone, Copy, Default)]
struct Panel {
    /// Where they start, and how many they are.
    start: usize,
    rows: usize,
    /// How many of them come from the panel before.
    carried: usize,
    /// Unknowns of the node.
    unknowns: usize,
    /// Whether the first row after those carried, or the last, is that of a closure variable.
    first_is_closure: bool,
    last_is_closure: bool,
}

/// The factorised system.
#[derive(Debug, Clone, Default)]
pub(crate) struct Panels<const N: usize> {
    panels: Vec<Panel>,
    rows: Vec<Row<N>>,
    /// The row that was exchanged with each unknown's, within its panel: as many a panel as it has unknowns.
    pivots: Vec<usize>,
    left_count: usize,
}

/// A right side, or the multipliers of the rows: by conditions and elements.
#[derive(Debug, Clone)]
pub(crate) struct Loads<const N: usize> {
    /// Of the conditions at s = 0.
    pub(crate) left: [f64; N],
    /// Of the transitions of elements.
    pub(crate) transitions: Vec<[f64; N]>,
    /// Of the closure variable at own ends.
    pub(crate) own: Vec<f64>,
    /// Of the conditions at s = 1.
    pub(crate) right: [f64; N],
}

impl<const N: usize> Default for Loads<N> {
    fn default() -> Self {
        Self { left: [0.0; N], transitions: Vec::new(), own: Vec::new(), right: [0.0; N] }
    }
}

/// Unknowns of the nodes, or weights on them.
#[derive(Debug, Clone, Default)]
pub(crate) struct AtNodes<const N: usize> {
    pub(crate) z: Vec<[f64; N]>,
    pub(crate) w: Vec<f64>,
}

impl<const N: usize> AtNodes<N> {
    pub(crate) fn clear(&mut self, nodes: usize) {
        self.z.clear();
        self.z.resize(nodes, [0.0; N]);
        self.w.clear();
        self.w.resize(nodes, 0.0);
    }
}

impl<const N: usize> Panels<N> {
    /// Factorises; the determinant times `product`, or `None` where the system is singular.
    #[inline(always)]
    pub(crate) fn factorise<const FUSED: bool>(
        &mut self,
        maps: &[Map<N>],
        directions: &Directions,
        left: &[Condition<N>],
        right: &[Condition<N>],
        mut product: Product,
    ) -> Option<Determinant> {
        let n = maps.len();
        self.panels.clear();
        self.rows.clear();
        self.pivots.clear();
        self.left_count = left.len();
        let flow = |node: usize| directions.flow.get(node).copied().unwrap_or_default();
        for condition in left {
            self.rows.push(Row { own: condition.gradient, ..Row::ZERO });
        }
        let (mut start, mut carried) = (0, left.len());
        let mut shared = 0;
        for (i, map) in maps.iter().enumerate() {
            let (here, next) = (flow(i), flow(i + 1));
            let unknowns = N + usize::from(here != Flow::None);
            shared += usize::from(next != Flow::None);
            // Where the value that the element takes over stands, if it is a node's.
            let (from_own, from_next) = match directions.side(i) {
                Side::Left => (false, next == Flow::Left),
                Side::Right => (here == Flow::Right, false),
            };
            let own_row = Row {
                own: map.own_by_state.map(|v| -v),
                own_w: if from_own { -map.own_by_taken } else { 0.0 },
                next: [0.0; N],
                next_w: if from_next { -map.own_by_taken } else { 0.0 },
            };
            if here == Flow::Left {
                self.rows.push(Row { own_w: 1.0, ..own_row });
            }
            for a in 0..N {
                let mut row = Row { own: map.by_state[a].map(|v| -v), ..Row::ZERO };
                row.next[a] = 1.0;
                row.own_w = if from_own { -map.by_taken[a] } else { 0.0 };
                row.next_w = if from_next { -map.by_taken[a] } else { 0.0 };
                self.rows.push(row);
            }
            if next == Flow::Right {
                self.rows.push(Row { next_w: 1.0, ..own_row });
            }
            let panel = Panel {
                start,
                rows: self.rows.len() - start,
                carried,
                unknowns,
                first_is_closure: here == Flow::Left,
                last_is_closure: next == Flow::Right,
            };
            self.eliminate::<FUSED>(panel, &mut product)?;
            self.panels.push(panel);
            carried = panel.rows - unknowns;
            start = self.rows.len();
            for r in 0..carried {
                let row = self.rows[panel.start + unknowns + r];
                self.rows.push(Row { own: row.next, own_w: row.next_w, ..Row::ZERO });
            }
        }
        for condition in right {
            self.rows.push(Row { own: condition.gradient, ..Row::ZERO });
        }
        let panel = Panel { start, rows: self.rows.len() - start, carried, unknowns: N, ..Panel::default() };
        if panel.rows != N {
            return None;
        }
        self.eliminate::<FUSED>(panel, &mut product)?;
        self.panels.push(panel);
        // The conditions at s = 1 have passed all rows between nodes.
        if right.len() * (n * N + shared) % 2 == 1 {
            product.turn();
        }
        Some(product.whole(self.clearance(panel)))
    }

    /// Eliminates the unknowns of a panel.
    #[inline(always)]
    fn eliminate<const FUSED: bool>(&mut self, panel: Panel, product: &mut Product) -> Option<()> {
        let rows = &mut self.rows[panel.start..panel.start + panel.rows];
        for k in 0..N {
            let mut best = k;
            for r in k + 1..rows.len() {
                if rows[r].own[k].abs() > rows[best].own[k].abs() {
                    best = r;
                }
            }
            let pivot = rows[best].own[k];
            if pivot == 0.0 || !pivot.is_finite() {
                return None;
            }
            if best != k {
                rows.swap(best, k);
                product.turn();
            }
            self.pivots.push(best);
            product.times(pivot);
            let scale = 1.0 / pivot;
            if k + 1 == N && rows.len() == N {
                break;
            }
            let (upper, lower) = rows.split_at_mut(k + 1);
            let own = &upper[k];
            for row in lower {
                let f = row.own[k] * scale;
                for c in k + 1..N {
                    row.own[c] = row.own[c].plus::<FUSED>(-f, own.own[c]);
                }
                for c in 0..N {
                    row.next[c] = row.next[c].plus::<FUSED>(-f, own.next[c]);
                }
                row.own_w -= f * own.own_w;
                row.next_w -= f * own.next_w;
                row.own[k] = f;
            }
        }
        if panel.unknowns > N {
            self.eliminate_closure::<FUSED>(panel, product)?;
        }
        Some(())
    }

    /// The last unknown of a panel, where it is a closure variable.
    #[inline(always)]
    fn eliminate_closure<const FUSED: bool>(&mut self, panel: Panel, product: &mut Product) -> Option<()> {
        let rows = &mut self.rows[panel.start..panel.start + panel.rows];
        let mut best = N;
        for r in N + 1..rows.len() {
            if rows[r].own_w.abs() > rows[best].own_w.abs() {
                best = r;
            }
        }
        let pivot = rows[best].own_w;
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        if best != N {
            rows.swap(best, N);
            product.turn();
        }
        self.pivots.push(best);
        product.times(pivot);
        let scale = 1.0 / pivot;
        let (upper, lower) = rows.split_at_mut(N + 1);
        let own = &upper[N];
        for row in lower {
            let f = row.own_w * scale;
            for c in 0..N {
                row.next[c] = row.next[c].plus::<FUSED>(-f, own.next[c]);
            }
            row.next_w -= f * own.next_w;
            row.own_w = f;
        }
        Some(())
    }

    /// The last pivot of the last panel over the numbers that it is the difference of: the digits that are left of it.
    fn clearance(&self, panel: Panel) -> f64 {
        let Some(row) = self.rows.get(panel.start + N - 1).filter(|_| N > 1) else { return 1.0 };
        // Its column before elimination, by multiplying the factors.
        let mut terms = row.own[N - 1].abs();
        for k in 0..N - 1 {
            terms = terms.max((row.own[k] * self.rows[panel.start + k].own[N - 1]).abs());
        }
        if terms > 0.0 { row.own[N - 1].abs() / terms } else { 0.0 }
    }

    /// Solves for a right side.
    #[inline(always)]
    pub(crate) fn solve(&self, loads: &Loads<N>, out: &mut AtNodes<N>, memory: &mut Vec<f64>) {
        let n = self.panels.len() - 1;
        memory.clear();
        memory.resize(self.rows.len(), 0.0);
        memory[..self.left_count].copy_from_slice(&loads.left[..self.left_count]);
        let mut pivots = self.pivots.iter();
        for (i, panel) in self.panels.iter().enumerate() {
            let rows = &self.rows[panel.start..panel.start + panel.rows];
            let (before, behind) = memory.split_at_mut(panel.start + panel.rows);
            let right = &mut before[panel.start..];
            let mut at = panel.carried;
            if i < n {
                if panel.first_is_closure {
                    right[at] = loads.own[i];
                    at += 1;
                }
                right[at..at + N].copy_from_slice(&loads.transitions[i]);
                at += N;
                if panel.last_is_closure {
                    right[at] = loads.own[i];
                }
            } else {
                right[at..].copy_from_slice(&loads.right[..panel.rows - at]);
            }
            for (k, pivot) in pivots.by_ref().take(panel.unknowns).enumerate() {
                right.swap(k, *pivot);
            }
            for k in 0..N {
                let own = right[k];
                for r in k + 1..rows.len() {
                    right[r] -= rows[r].own[k] * own;
                }
            }
            if panel.unknowns > N {
                let own = right[N];
                for r in N + 1..rows.len() {
                    right[r] -= rows[r].own_w * own;
                }
            }
            if i < n {
                behind[..panel.rows - panel.unknowns].copy_from_slice(&right[panel.unknowns..]);
            }
        }
        out.clear(n + 1);
        for (i, panel) in self.panels.iter().enumerate().rev() {
            let (z_next, w_next) = if i < n { (out.z[i + 1], out.w[i + 1]) } else { ([0.0; N], 0.0) };
            let (mut z, mut w) = ([0.0; N], 0.0);
            let rows = &self.rows[panel.start..panel.start + panel.unknowns];
            let right = &memory[panel.start..panel.start + panel.unknowns];
            let known = |k: usize| {
                let mut sum = right[k] - rows[k].next_w * w_next;
                for c in 0..N {
                    sum -= rows[k].next[c] * z_next[c];
                }
                sum
            };
            if panel.unknowns > N {
                w = known(N) / rows[N].own_w;
            }
            for k in (0..N).rev() {
                let mut sum = known(k) - rows[k].own_w * w;
                for c in k + 1..N {
                    sum -= rows[k].own[c] * z[c];
                }
                z[k] = sum / rows[k].own[k];
            }
            (out.z[i], out.w[i]) = (z, w);
        }
    }

    /// Solves the transposed system: weights on the unknowns of nodes as multipliers of the rows.
    #[inline(always)]
    pub(crate) fn solve_transposed(&self, weights: &AtNodes<N>, out: &mut Loads<N>, memory: &mut Vec<f64>) {
        let n = self.panels.len() - 1;
        memory.clear();
        memory.resize(self.rows.len(), 0.0);
        // From the upper factor.
        let (mut z_given, mut w_given) = ([0.0; N], 0.0);
        for (i, panel) in self.panels.iter().enumerate() {
            let rows = &self.rows[panel.start..panel.start + panel.rows];
            let own = &mut memory[panel.start..panel.start + panel.rows];
            let (mut z_passed, mut w_passed) = ([0.0; N], 0.0);
            for k in 0..panel.unknowns {
                let mut sum =
                    if k < N { weights.z[i][k] - z_given[k] } else { weights.w[i] - w_given };
                for m in 0..k {
                    sum -= rows[m].at(k) * own[m];
                }
                own[k] = sum / rows[k].at(k);
                for c in 0..N {
                    z_passed[c] += rows[k].next[c] * own[k];
                }
                w_passed += rows[k].next_w * own[k];
            }
            (z_given, w_given) = (z_passed, w_passed);
        }
        // From the lower one.
        out.transitions.resize(n, [0.0; N]);
        out.own.clear();
        out.own.resize(n, 0.0);
        let mut end = self.pivots.len();
        for (i, panel) in self.panels.iter().enumerate().rev() {
            let rows = &self.rows[panel.start..panel.start + panel.rows];
            let (before, behind) = memory.split_at_mut(panel.start + panel.rows);
            let own = &mut before[panel.start..];
            if i < n {
                own[panel.unknowns..].copy_from_slice(&behind[..panel.rows - panel.unknowns]);
            }
            let pivots = &self.pivots[end - panel.unknowns..end];
            end -= panel.unknowns;
            for k in (0..panel.unknowns).rev() {
                let mut sum = own[k];
                for (r, row) in rows.iter().enumerate().skip(k + 1) {
                    sum -= row.at(k) * own[r];
                }
                own[k] = sum;
            }
            for k in (0..panel.unknowns).rev() {
                own.swap(k, pivots[k]);
            }
            let mut at = panel.carried;
            if i < n {
                if panel.first_is_closure {
                    out.own[i] = own[at];
                    at += 1;
                }
                out.transitions[i].copy_from_slice(&own[at..at + N]);
                at += N;
                if panel.last_is_closure {
                    out.own[i] = own[at];
                }
            } else {
                out.right[..panel.rows - at].copy_from_slice(&own[at..]);
            }
        }
        out.left[..self.left_count].copy_from_slice(&memory[..self.left_count]);
    }
}
