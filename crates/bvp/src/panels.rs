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

    #[inline(always)]
    fn set(&mut self, k: usize, value: f64) {
        if k < N {
            self.own[k] = value;
        } else {
            self.own_w = value;
        }
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
        let mut clearance = 1.0;
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
        clearance = f64::min(clearance, self.eliminate::<FUSED>(panel, &mut product)?);
        self.panels.push(panel);
        // The conditions at s = 1 have passed all rows between nodes.
        if right.len() * (n * N + shared) % 2 == 1 {
            product.turn();
        }
        Some(product.whole(clearance))
    }

    /// Eliminates the unknowns of a panel; what is left of the last pivot.
    #[inline(always)]
    fn eliminate<const FUSED: bool>(&mut self, panel: Panel, product: &mut Product) -> Option<f64> {
        let rows = &mut self.rows[panel.start..panel.start + panel.rows];
        let mut clearance = 1.0;
        for k in 0..panel.unknowns {
            let (mut best, mut largest) = (k, rows[k].at(k).abs());
            for (r, row) in rows.iter().enumerate().skip(k + 1) {
                let size = row.at(k).abs();
                if size > largest {
                    (best, largest) = (r, size);
                }
            }
            // The negation also catches NaN.
            #[allow(clippy::neg_cmp_op_on_partial_ord)]
            if !(largest > 0.0) || largest == f64::INFINITY {
                return None;
            }
            if best != k {
                rows.swap(best, k);
                product.turn();
            }
            self.pivots.push(best);
            let (upper, lower) = rows.split_at_mut(k + 1);
            let own = &upper[k];
            let pivot = own.at(k);
            product.times(pivot);
            let scale = 1.0 / pivot;
            let last = k + 2 == panel.unknowns && lower.len() == 1;
            for row in lower {
                let f = row.at(k) * scale;
                if last {
                    let (before, by) = (row.at(k + 1), f * own.at(k + 1));
                    clearance = (before - by).abs() / before.abs().max(by.abs()).max(1e-300);
                }
                for c in k + 1..N {
                    row.own[c] = row.own[c].plus::<FUSED>(-f, own.own[c]);
                }
                for c in 0..N {
                    row.next[c] = row.next[c].plus::<FUSED>(-f, own.next[c]);
                }
                if k < N {
                    row.own_w = row.own_w.plus::<FUSED>(-f, own.own_w);
                }
                row.next_w = row.next_w.plus::<FUSED>(-f, own.next_w);
                row.set(k, f);
            }
        }
        Some(clearance)
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
            for k in 0..panel.unknowns {
                let own = right[k];
                for (r, row) in rows.iter().enumerate().skip(k + 1) {
                    right[r] -= row.at(k) * own;
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
            for k in (0..panel.unknowns).rev() {
                let row = &self.rows[panel.start + k];
                let mut sum = memory[panel.start + k] - row.next_w * w_next;
                for c in 0..N {
                    sum -= row.next[c] * z_next[c];
                }
                for (c, z) in z.iter().enumerate().skip(k + 1) {
                    sum -= row.own[c] * z;
                }
                if k < N {
                    if panel.unknowns > N {
                        sum -= row.own_w * w;
                    }
                    z[k] = sum / row.own[k];
                } else {
                    w = sum / row.own_w;
                }
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
