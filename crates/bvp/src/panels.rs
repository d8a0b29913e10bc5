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
use crate::groups::{make_room, resize};
use crate::problem::Condition;
use crate::real::Real;

/// A row between two neighbouring nodes.
#[derive(Debug, Clone, Copy)]
struct Row<const N: usize> {
    own: [f64; N],
    next: [f64; N],
    /// Of the closure variables, own and next.
    w: [f64; 2],
}

impl<const N: usize> Row<N> {
    const ZERO: Self = Self { own: [0.0; N], next: [0.0; N], w: [0.0; 2] };

    #[inline(always)]
    fn at(&self, k: usize) -> f64 {
        if k < N { self.own[k] } else { self.w[0] }
    }
}

/// The rows that eliminate the unknowns of a node.
#[derive(Debug, Clone, Copy)]
struct Panel<const N: usize> {
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
    /// The row that was exchanged with each unknown's, within the panel: of the state, and of the closure variable.
    pivots: [usize; N],
    last_pivot: usize,
}

impl<const N: usize> Panel<N> {
    /// The row that was exchanged with that of unknown `k`.
    #[inline(always)]
    fn pivot(&self, k: usize) -> usize {
        if k < N { self.pivots[k] } else { self.last_pivot }
    }
}

/// The factorised system.
#[derive(Debug, Clone, Default)]
pub(crate) struct Panels<const N: usize> {
    /// From s = 0, one a node.
    eliminated: Vec<Panel<N>>,
    rows: Vec<Row<N>>,
    /// Rows in use.
    used: usize,
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
        resize(&mut self.z, nodes, [0.0; N]);
        self.w.clear();
        resize(&mut self.w, nodes, 0.0);
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
        self.eliminated.clear();
        make_room(&mut self.eliminated, n + 1);
        // A panel has at most as many rows as two nodes have unknowns. All are written before they are read.
        let most = (n + 1) * (2 * N + 2);
        if self.rows.len() < most {
            resize(&mut self.rows, most, Row::ZERO);
        }
        self.left_count = left.len();
        let flow = |node: usize| directions.flow.get(node).copied().unwrap_or_default();
        for (row, condition) in self.rows.iter_mut().zip(left) {
            *row = Row { own: condition.gradient, ..Row::ZERO };
        }
        let (mut start, mut carried) = (0, left.len());
        let mut shared = 0;
        let mut here = flow(0);
        for (i, map) in maps.iter().enumerate() {
            let next = flow(i + 1);
            let unknowns = N + usize::from(here != Flow::None);
            shared += usize::from(next != Flow::None);
            // Where the value that the element takes over stands, if it is a node's.
            let from = match directions.side(i) {
                Side::Left => [0.0, -f64::from(u8::from(next == Flow::Left))],
                Side::Right => [-f64::from(u8::from(here == Flow::Right)), 0.0],
            };
            let rows = &mut self.rows[start..start + 2 * (2 * N + 2)];
            let mut at = carried;
            let own_row = |w: [f64; 2]| Row {
                own: map.own_by_state.map(|v| -v),
                next: [0.0; N],
                w: [from[0] * map.own_by_taken + w[0], from[1] * map.own_by_taken + w[1]],
            };
            if here == Flow::Left {
                rows[at] = own_row([1.0, 0.0]);
                at += 1;
            }
            for (a, row) in rows[at..at + N].iter_mut().enumerate() {
                row.own = map.by_state[a].map(|v| -v);
                row.next = [0.0; N];
                row.next[a] = 1.0;
                row.w = [from[0] * map.by_taken[a], from[1] * map.by_taken[a]];
            }
            at += N;
            if next == Flow::Right {
                rows[at] = own_row([0.0, 1.0]);
                at += 1;
            }
            let mut panel = Panel {
                start,
                rows: at,
                carried,
                unknowns,
                first_is_closure: here == Flow::Left,
                last_is_closure: next == Flow::Right,
                pivots: [0; N],
                last_pivot: 0,
            };
            let (rows, behind) = rows.split_at_mut(at);
            eliminate::<FUSED, N>(rows, &mut panel, &mut product)?;
            carried = at - unknowns;
            for (row, from) in behind.iter_mut().zip(&rows[unknowns..]) {
                *row = Row { own: from.next, next: [0.0; N], w: [from.w[1], 0.0] };
            }
            self.eliminated.push(panel);
            start += at;
            here = next;
        }
        let mut panel = Panel {
            start,
            rows: carried + right.len(),
            carried,
            unknowns: N,
            first_is_closure: false,
            last_is_closure: false,
            pivots: [0; N],
            last_pivot: 0,
        };
        if panel.rows != N {
            return None;
        }
        let rows = &mut self.rows[start..start + N];
        for (row, condition) in rows[carried..].iter_mut().zip(right) {
            *row = Row { own: condition.gradient, ..Row::ZERO };
        }
        eliminate::<FUSED, N>(rows, &mut panel, &mut product)?;
        self.used = start + N;
        self.eliminated.push(panel);
        // The conditions at s = 1 have passed all rows between nodes.
        if right.len() * (n * N + shared) % 2 == 1 {
            product.turn();
        }
        Some(product.whole(self.clearance(&panel)))
    }

    /// The least pivot of the last panel over the numbers that it is the difference of and over its row: the digits that are
    /// left of it. Where growing solutions meet no condition at the end that they grow towards, the row that comes from the
    /// left has lost all but theirs, and a pivot in another column is what rounding left.
    fn clearance(&self, panel: &Panel<N>) -> f64 {
        let rows = &self.rows[panel.start..panel.start + N];
        let mut least = 1.0_f64;
        for k in 0..N {
            let pivot = rows[k].own[k].abs();
            let mut terms = rows[k].own[k..].iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
            // Its column before elimination, by multiplying the factors.
            for before in 0..k {
                terms = terms.max((rows[k].own[before] * rows[before].own[k]).abs());
            }
            least = least.min(if terms > 0.0 { pivot / terms } else { 0.0 });
        }
        least
    }

    /// Solves for a right side.
    #[inline(always)]
    pub(crate) fn solve(&self, loads: &Loads<N>, out: &mut AtNodes<N>, memory: &mut Vec<f64>) {
        let n = self.eliminated.len() - 1;
        memory.clear();
        resize(memory, self.used, 0.0);
        memory[..self.left_count].copy_from_slice(&loads.left[..self.left_count]);
        for (i, panel) in self.eliminated.iter().enumerate() {
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
            for k in 0..panel.unknowns {
                right.swap(k, panel.pivot(k));
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
                    right[r] -= rows[r].w[0] * own;
                }
            }
            if i < n {
                behind[..panel.rows - panel.unknowns].copy_from_slice(&right[panel.unknowns..]);
            }
        }
        out.clear(n + 1);
        for (i, panel) in self.eliminated.iter().enumerate().rev() {
            let (z_next, w_next) = if i < n { (out.z[i + 1], out.w[i + 1]) } else { ([0.0; N], 0.0) };
            let (mut z, mut w) = ([0.0; N], 0.0);
            let rows = &self.rows[panel.start..panel.start + panel.unknowns];
            let right = &memory[panel.start..panel.start + panel.unknowns];
            let known = |k: usize| {
                let mut sum = right[k] - rows[k].w[1] * w_next;
                for c in 0..N {
                    sum -= rows[k].next[c] * z_next[c];
                }
                sum
            };
            if panel.unknowns > N {
                w = known(N) / rows[N].w[0];
            }
            for k in (0..N).rev() {
                let mut sum = known(k) - rows[k].w[0] * w;
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
        let n = self.eliminated.len() - 1;
        memory.clear();
        resize(memory, self.used, 0.0);
        // From the upper factor.
        let (mut z_given, mut w_given) = ([0.0; N], 0.0);
        for (i, panel) in self.eliminated.iter().enumerate() {
            let rows = &self.rows[panel.start..panel.start + panel.rows];
            let own = &mut memory[panel.start..panel.start + panel.rows];
            let (mut z_passed, mut w_passed) = ([0.0; N], 0.0);
            for k in 0..panel.unknowns {
                let mut sum = if k < N { weights.z[i][k] - z_given[k] } else { weights.w[i] - w_given };
                for m in 0..k {
                    sum -= rows[m].at(k) * own[m];
                }
                own[k] = sum / rows[k].at(k);
                for c in 0..N {
                    z_passed[c] += rows[k].next[c] * own[k];
                }
                w_passed += rows[k].w[1] * own[k];
            }
            (z_given, w_given) = (z_passed, w_passed);
        }
        // From the lower one.
        resize(&mut out.transitions, n, [0.0; N]);
        out.own.clear();
        resize(&mut out.own, n, 0.0);
        for (i, panel) in self.eliminated.iter().enumerate().rev() {
            let rows = &self.rows[panel.start..panel.start + panel.rows];
            let (before, behind) = memory.split_at_mut(panel.start + panel.rows);
            let own = &mut before[panel.start..];
            if i < n {
                own[panel.unknowns..].copy_from_slice(&behind[..panel.rows - panel.unknowns]);
            }
            for k in (0..panel.unknowns).rev() {
                let mut sum = own[k];
                for (r, row) in rows.iter().enumerate().skip(k + 1) {
                    sum -= row.at(k) * own[r];
                }
                own[k] = sum;
            }
            for k in (0..panel.unknowns).rev() {
                own.swap(k, panel.pivot(k));
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

/// Eliminates the unknowns of a panel.
#[inline(always)]
fn eliminate<const FUSED: bool, const N: usize>(
    rows: &mut [Row<N>],
    panel: &mut Panel<N>,
    product: &mut Product,
) -> Option<()> {
    // Steps one by one, so that each is compiled for its column.
    const APART: usize = 4;
    if N > 0 {
        panel.pivots[0] = eliminate_one::<FUSED, N>(rows, 0, product)?;
    }
    if N > 1 {
        panel.pivots[1] = eliminate_one::<FUSED, N>(rows, 1, product)?;
    }
    if N > 2 {
        panel.pivots[2] = eliminate_one::<FUSED, N>(rows, 2, product)?;
    }
    if N > 3 {
        panel.pivots[3] = eliminate_one::<FUSED, N>(rows, 3, product)?;
    }
    for k in APART..N {
        panel.pivots[k] = eliminate_one::<FUSED, N>(rows, k, product)?;
    }
    if panel.unknowns > N {
        panel.last_pivot = eliminate_one::<FUSED, N>(rows, N, product)?;
    }
    Some(())
}

/// Eliminates unknown `k` of a panel, the closure variable where it is the last; the row that was exchanged with its own.
#[inline(always)]
fn eliminate_one<const FUSED: bool, const N: usize>(
    rows: &mut [Row<N>],
    k: usize,
    product: &mut Product,
) -> Option<usize> {
    let (mut best, mut largest) = (k, rows.get(k)?.at(k).abs());
    for (r, row) in rows.iter().enumerate().skip(k + 1) {
        let size = row.at(k).abs();
        if size > largest {
            (best, largest) = (r, size);
        }
    }
    if largest == 0.0 || !largest.is_finite() {
        return None;
    }
    if best != k {
        rows.swap(best, k);
        product.turn();
    }
    let (upper, lower) = rows.split_at_mut(k + 1);
    let own = &upper[k];
    let pivot = own.at(k);
    product.times(pivot);
    let scale = 1.0 / pivot;
    // The columns before are the lower factor's: they get nothing, so that rows are whole vectors.
    let mut behind = own.own;
    for c in 0..N {
        behind[c] = if c > k { own.own[c] } else { 0.0 };
    }
    let [own_w, next_w] = own.w;
    let w = [if k < N { own_w } else { 0.0 }, next_w];
    for row in lower {
        let f = row.at(k) * scale;
        for c in 0..N {
            row.own[c] = row.own[c].plus::<FUSED>(-f, behind[c]);
        }
        for c in 0..N {
            row.next[c] = row.next[c].plus::<FUSED>(-f, own.next[c]);
        }
        for c in 0..2 {
            row.w[c] = row.w[c].plus::<FUSED>(-f, w[c]);
        }
        if k < N {
            row.own[k] = f;
        } else {
            row.w[0] = f;
        }
    }
    Some(best)
}
