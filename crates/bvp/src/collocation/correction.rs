//! What is solved with the factors: Newton corrections, and responses to changes of the equations.

use super::stations::group_start;
use super::{Collocation, Forcing, Memory};
use crate::block::apply;
use crate::condense::{Column, solve_column};
use crate::correction::Correction;
use crate::directions::Side;
use crate::gauss::POINTS;
use crate::groups::{make_room, resize};
use crate::panels::{AtNodes, Loads};
use crate::real::{LANES, Lanes, Real};
use crate::solution::{End, Solution, Stage};

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Collocation<N, M, Q, L> {
    /// The column of a group for right sides of its stage equations, changes of the closure variable at stages and own end, and defects
    /// of its slopes.
    #[inline(always)]
    fn column<const FUSED: bool>(
        &self,
        g: usize,
        mut slopes: [[Lanes; N]; M],
        change: &[Lanes; POINTS],
        defect: Option<&[Lanes; POINTS]>,
    ) -> Column<N, M> {
        let zero = Lanes::of(0.0);
        let (mut value, mut by_closure) = ([zero; POINTS], [zero; POINTS]);
        if const { L > 0 } && self.directions.is_closed() {
            value = *change;
            if let Some(defect) = defect {
                for m in 0..M + 1 {
                    let inner = self.inner_at(g, m);
                    value[m] += inner.reach * defect[m];
                }
                by_closure = *defect;
            }
            for j in 0..M + 1 {
                for m in 0..M + 1 {
                    by_closure[j] = by_closure[j].plus::<FUSED>(self.condensed.w(g)[j][m], value[m]);
                }
            }
            for j in 0..M {
                let u = &self.locals[g * M + j].by_closure;
                for a in 0..N {
                    slopes[j][a] += u[a] * by_closure[j];
                }
            }
        }
        solve_column::<FUSED, N, M>(self.condensed.lu(g), &mut slopes);
        Column { slopes, closure: by_closure, value, change: *change }
    }

    /// The column of the residual in group `g`.
    #[inline(always)]
    fn residual_column<const FUSED: bool>(&self, g: usize, solution: &Solution<N, M, L>) -> Column<N, M> {
        let zero = Lanes::of(0.0);
        let mut slopes = [[zero; N]; M];
        let mut change = [zero; POINTS];
        for j in 0..M {
            let local = &self.locals[g * M + j];
            for a in 0..N {
                slopes[j][a] = local.slope[a] - solution.stages[g * M + j].slope[a];
            }
            change[j] = local.inner.value_change;
        }
        if const { L > 0 } && self.directions.is_closed() {
            change[M] = self.ends[g].value_change;
        }
        let defect = self.condensed.closures.get(g).map(|closure| &closure.defect);
        self.column::<FUSED>(g, slopes, &change, defect)
    }

    /// Loads of the rows of a column's elements: jumps of the state over them (without those of the solution), and own values.
    #[inline(always)]
    fn load_rows(&self, g: usize, column: &Column<N, M>, loads: &mut Loads<N>) {
        let (groups, h) = (self.groups, self.steps[g]);
        let zero = Lanes::of(0.0);
        let (mut jump, mut own) = ([zero; N], zero);
        for j in 0..M {
            let w = h * Lanes::of(self.gauss.b[j]);
            for a in 0..N {
                jump[a] += w * column.slopes[j][a];
            }
        }
        if const { L > 0 } && self.directions.is_closed() {
            let closure = &self.condensed.closures[g];
            for m in 0..M + 1 {
                own += closure.own[m] * column.value[m];
            }
            for j in 0..M {
                for a in 0..N {
                    own += h * closure.own_by_slopes[j][a] * column.slopes[j][a];
                }
            }
        }
        for lane in 0..groups.filled(g) {
            let i = g * LANES + lane;
            loads.transitions[i] = jump.map(|v| v.0[lane]);
            loads.own[i] = own.0[lane];
        }
    }

    /// What closing elements take over of a column, put into the rows: `change` at their other ends, and whether their defects
    /// count.
    fn load_closings(
        &self,
        columns: &[Column<N, M>],
        change: impl Fn(usize, usize) -> f64,
        with_defect: bool,
        loads: &mut Loads<N>,
        out: &mut Vec<f64>,
    ) {
        out.clear();
        for closing in &self.closings {
            let (g, own) = (closing.element / LANES, closing.element % LANES);
            let column = &columns[g];
            let mut taken = closing.by_change * change(closing.block, closing.lane);
            if with_defect {
                taken += closing.by_defect * closing.defect;
            }
            for m in 0..M + 1 {
                taken += closing.by_value[m] * column.value[m].0[own];
            }
            for l in 0..M {
                for a in 0..N {
                    taken += closing.by_slopes[l][a] * column.slopes[l][a].0[own];
                }
            }
            let i = closing.element;
            for a in 0..N {
                loads.transitions[i][a] += closing.by_taken[a] * taken;
            }
            loads.own[i] += closing.own_by_taken * taken;
            out.push(taken);
        }
    }

    /// The values that elements take over, given those of the nodes and what closings add.
    fn fill_taken(&self, nodes: &AtNodes<N>, closing: &[f64], taken: &mut Vec<f64>) {
        taken.clear();
        if const { L == 0 } || !self.directions.is_closed() {
            return;
        }
        taken.extend((0..self.groups.elements).map(|i| match self.directions.side(i) {
            Side::Left => nodes.w[i + 1],
            Side::Right => nodes.w[i],
        }));
        for (closing, added) in self.closings.iter().zip(closing) {
            let z = &nodes.z[closing.element];
            taken[closing.element] = (0..N).fold(*added, |sum, a| sum + closing.row[a] * z[a]);
        }
    }

    /// The Newton correction of the solution that was linearised.
    #[inline(always)]
    pub fn newton<const FUSED: bool>(&mut self, solution: &Solution<N, M, L>, out: &mut Correction<N, M, Q, L>) {
        let groups = self.groups;
        let mut memory = std::mem::take(&mut self.memory);
        memory.columns.clear();
        make_room(&mut memory.columns, groups.count());
        resize(&mut memory.loads.transitions, groups.elements, [0.0; N]);
        resize(&mut memory.loads.own, groups.elements, 0.0);
        for g in 0..groups.count() {
            let column = self.residual_column::<FUSED>(g, solution);
            self.load_rows(g, &column, &mut memory.loads);
            let (h, z) = group_start(groups, g, solution);
            let mut end = z;
            for j in 0..M {
                let w = h * Lanes::of(self.gauss.b[j]);
                for a in 0..N {
                    end[a] += w * solution.stages[g * M + j].slope[a];
                }
            }
            for lane in 0..groups.filled(g) {
                let i = g * LANES + lane;
                for a in 0..N {
                    memory.loads.transitions[i][a] += end[a].0[lane] - solution.nodes[i + 1][a];
                }
            }
            memory.columns.push(column);
        }
        let ends = &self.ends;
        self.load_closings(
            &memory.columns,
            |block, lane| ends[block].value_change.0[lane],
            true,
            &mut memory.loads,
            &mut memory.closing,
        );
        self.panels.solve(&memory.loads, &mut memory.nodes, &mut memory.rows);
        self.fill_taken(&memory.nodes, &memory.closing, &mut memory.taken);
        self.finish::<FUSED>(&mut memory, true, out, |g, j, stage, _| {
            let (station, local) = (&self.stations[g * M + j], &self.locals[g * M + j]);
            let before = &solution.stages[g * M + j].inner;
            for a in 0..L {
                stage.inner[a] += station.inner[a] - before[a] + local.inner.change[a];
            }
        });
        for (b, end) in out.ends.iter_mut().enumerate() {
            for a in 0..L {
                end.inner[a] += self.end_stations[b].inner[a] - solution.ends[b].inner[a] + self.ends[b].change[a];
            }
        }
        self.memory = memory;
    }

    /// By how much the state jumps over each element in the last Newton correction, from no change at its left node: the local error of the
    /// element where the solution was another method's.
    pub fn jumps(&self) -> &[[f64; N]] {
        &self.memory.loads.transitions
    }

    /// The changes of the states at the stages, in blocks, by a correction.
    pub fn moved_states(&self, correction: &Correction<N, M, Q, L>) -> Vec<[Lanes; N]> {
        let groups = self.groups;
        let mut out = vec![[Lanes::default(); N]; groups.count() * M];
        for g in 0..groups.count() {
            let h = self.steps[g];
            for j in 0..M {
                let state = &mut out[g * M + j];
                for lane in 0..LANES {
                    for a in 0..N {
                        state[a].0[lane] = correction.nodes[groups.element(g, lane)][a];
                    }
                }
                for l in 0..M {
                    let w = h * Lanes::of(self.gauss.a[j][l]);
                    for a in 0..N {
                        state[a] += w * correction.stages[g * M + l].slope[a];
                    }
                }
            }
        }
        out
    }

    /// The response of the solution to a change of the equations: the derivative by what the change is by.
    #[inline(always)]
    pub fn response<const FUSED: bool>(&self, forcing: &Forcing<N, Q, L>, out: &mut Correction<N, M, Q, L>) {
        let groups = self.groups;
        let mut memory = Memory::default();
        memory.columns.reserve_exact(groups.count());
        resize(&mut memory.loads.transitions, groups.elements, [0.0; N]);
        resize(&mut memory.loads.own, groups.elements, 0.0);
        let zero = Lanes::of(0.0);
        for g in 0..groups.count() {
            let (mut slopes, mut value) = ([[zero; N]; M], [zero; POINTS]);
            if !forcing.stages.is_empty() {
                for j in 0..M {
                    slopes[j] = forcing.stages[g * M + j].slope;
                    value[j] = forcing.stages[g * M + j].value;
                }
            }
            if !forcing.ends.is_empty() {
                value[M] = forcing.ends[g].1;
            }
            let column = self.column::<FUSED>(g, slopes, &value, None);
            self.load_rows(g, &column, &mut memory.loads);
            memory.columns.push(column);
        }
        let at_end = |block: usize, lane: usize| forcing.ends.get(block).map_or(0.0, |end| end.1.0[lane]);
        self.load_closings(&memory.columns, at_end, false, &mut memory.loads, &mut memory.closing);
        for r in 0..N {
            (memory.loads.left[r], memory.loads.right[r]) = (-forcing.left[r], -forcing.right[r]);
        }
        self.panels.solve(&memory.loads, &mut memory.nodes, &mut memory.rows);
        self.fill_taken(&memory.nodes, &memory.closing, &mut memory.taken);
        self.finish::<FUSED>(&mut memory, false, out, |g, j, stage, rate| {
            if let Some(added) = forcing.stages.get(g * M + j) {
                for a in 0..L {
                    stage.inner[a] += added.inner[a];
                }
                for q in 0..Q {
                    rate[q] += added.rate[q];
                }
            }
        });
        for (end, (inner, _)) in out.ends.iter_mut().zip(&forcing.ends) {
            for a in 0..L {
                end.inner[a] += inner[a];
            }
        }
    }

    /// Stages, ends and quadratures of a correction, given the nodes; `with_defects` where those of the closure slopes count; `add` adds what changes inner
    /// unknowns and rates at stage `j` of group `g` beside state and closure slope.
    #[inline(always)]
    #[allow(clippy::too_many_lines, reason = "one pass over a group, whose parts share what it has at hand")]
    fn finish<const FUSED: bool>(
        &self,
        memory: &mut Memory<N, M>,
        with_defects: bool,
        out: &mut Correction<N, M, Q, L>,
        add: impl Fn(usize, usize, &mut Stage<N, L>, &mut [Lanes; Q]),
    ) {
        let groups = self.groups;
        let zero = Lanes::of(0.0);
        out.nodes.clone_from(&memory.nodes.z);
        resize(&mut out.stages, groups.count() * M, Stage::default());
        resize(&mut out.ends, self.end_stations.len(), End::default());
        resize(&mut out.by_element, groups.elements, [0.0; Q]);
        out.total = [0.0; Q];
        memory.values.clear();
        make_room(&mut memory.values, groups.count());
        for g in 0..groups.count() {
            let (h, column) = (self.steps[g], &memory.columns[g]);
            let (by_stages, by_taken_stages) = (self.condensed.by_state(g), self.condensed.by_taken(g));
            let mut z = [zero; N];
            let mut taken = zero;
            for lane in 0..LANES {
                let i = groups.element(g, lane);
                for a in 0..N {
                    z[a].0[lane] = memory.nodes.z[i][a];
                }
                if const { L > 0 } && self.directions.is_closed() {
                    taken.0[lane] = memory.taken[i];
                }
            }
            let mut k = column.slopes;
            for j in 0..M {
                let by_state = apply(&by_stages[j], &z);
                for a in 0..N {
                    k[j][a] += by_state[a];
                    if const { L > 0 } && self.directions.is_closed() {
                        k[j][a] += by_taken_stages[j][a] * taken;
                    }
                }
            }
            let mut states = [z; M];
            for j in 0..M {
                for l in 0..M {
                    let w = h * Lanes::of(self.gauss.a[j][l]);
                    for a in 0..N {
                        states[j][a] = states[j][a].plus::<FUSED>(w, k[l][a]);
                    }
                }
            }
            let mut closure_slopes = [zero; POINTS];
            if const { L > 0 } && self.directions.is_closed() {
                let closure = &self.condensed.closures[g];
                let mut values = [zero; POINTS];
                let mut own = z;
                for l in 0..M {
                    let w = h * closure.right * Lanes::of(self.gauss.b[l]);
                    for a in 0..N {
                        own[a] += w * k[l][a];
                    }
                }
                for m in 0..M + 1 {
                    let (inner, state) = (self.inner_at(g, m), if m < M { &states[m] } else { &own });
                    for a in 0..N {
                        values[m] = values[m].plus::<FUSED>(inner.value_gradient[a], state[a]);
                    }
                }
                for j in 0..M + 1 {
                    let mut slope = column.closure[j] + closure.omega[j] * taken;
                    for m in 0..M + 1 {
                        slope = slope.plus::<FUSED>(self.condensed.w(g)[j][m], values[m]);
                    }
                    closure_slopes[j] = slope;
                }
                for m in 0..M + 1 {
                    let inner = self.inner_at(g, m);
                    values[m] += column.change[m] + inner.reach * closure_slopes[m];
                }
                memory.values.push(values);
                let end = &mut out.ends[g];
                end.closure_slope = closure_slopes[M];
                let inner = &self.ends[g];
                for a in 0..L {
                    end.inner[a] = inner.by_closure[a] * closure_slopes[M];
                    for b in 0..N {
                        end.inner[a] += inner.gradient[a][b] * own[b];
                    }
                }
            }
            let mut quadrature = [zero; Q];
            for j in 0..M {
                let local = &self.locals[g * M + j];
                let mut stage = Stage { slope: k[j], inner: [zero; L], closure_slope: closure_slopes[j] };
                let mut rate = [zero; Q];
                for a in 0..L {
                    stage.inner[a] = local.inner.by_closure[a] * closure_slopes[j];
                    for b in 0..N {
                        stage.inner[a] = stage.inner[a].plus::<FUSED>(local.inner.gradient[a][b], states[j][b]);
                    }
                }
                for q in 0..Q {
                    rate[q] = local.rate_by_closure[q] * closure_slopes[j];
                    for a in 0..N {
                        rate[q] = rate[q].plus::<FUSED>(local.rate_gradient[q][a], states[j][a]);
                    }
                }
                add(g, j, &mut stage, &mut rate);
                let weight = h * Lanes::of(self.gauss.b[j]);
                for q in 0..Q {
                    quadrature[q] += weight * rate[q];
                }
                out.stages[g * M + j] = stage;
            }
            for lane in 0..groups.filled(g) {
                let i = g * LANES + lane;
                for q in 0..Q {
                    out.by_element[i][q] = quadrature[q].0[lane];
                    out.total[q] += out.by_element[i][q];
                }
            }
        }
        self.finish_closings(memory, with_defects, out);
    }

    /// The other ends of closing elements, by the polynomial through w.
    fn finish_closings(&self, memory: &Memory<N, M>, with_defects: bool, out: &mut Correction<N, M, Q, L>) {
        for (k, closing) in self.closings.iter().enumerate() {
            let i = closing.element;
            let (g, own) = (i / LANES, i % LANES);
            let mut z = memory.nodes.z[i];
            if self.directions.side(i) == Side::Left {
                let h = self.steps[g].0[own];
                for l in 0..M {
                    for a in 0..N {
                        z[a] += h * self.gauss.b[l] * out.stages[g * M + l].slope[a].0[own];
                    }
                }
            }
            let d = &self.gauss.closure[self.directions.side(i).index()][M + 1];
            let inverse_h = 1.0 / self.steps[g].0[own];
            let mut slope = inverse_h * d[M + 1] * memory.taken[i];
            for m in 0..M + 1 {
                slope += inverse_h * d[m] * memory.values[g][m].0[own];
            }
            if with_defects {
                slope += closing.defect;
            }
            let (inner, end) = (&self.ends[closing.block], &mut out.ends[closing.block]);
            // The last block is filled up with the last of them.
            let lanes = if k + 1 == self.closings.len() { closing.lane..LANES } else { closing.lane..closing.lane + 1 };
            for lane in lanes {
                end.closure_slope.0[lane] = slope;
                for a in 0..L {
                    let mut sum = inner.by_closure[a].0[lane] * slope;
                    for b in 0..N {
                        sum += inner.gradient[a][b].0[lane] * z[b];
                    }
                    end.inner[a].0[lane] = sum;
                }
            }
        }
    }
}
