//! Gauss collocation: linearisation of a problem about a discrete solution, and what is solved with it.
//!
//! [`Collocation::evaluate`] asks the problem for slopes at all stages. [`Collocation::factorise`] eliminates the
//! stages of every element (static condensation) and factorises what is left between nodes. One factorisation serves Newton's
//! method ([`Collocation::newton`]), derivatives by parameters and loads ([`Collocation::response`]), adjoints
//! ([`Collocation::adjoint`], [`Collocation::contributions`]) and the [`Determinant`].

pub(crate) mod adjoint;

use crate::block::{add_scaled, apply};
use crate::condense::{Column, Condensed, Map, condense, condense_closed, solve_column};
use crate::determinant::{Determinant, Product};
use crate::directions::{Directions, Side};
use crate::gauss::{Gauss, POINTS};
use crate::groups::{Groups, make_room, resize};
use crate::mesh::Mesh;
use crate::panels::{AtNodes, Loads, Panels};
use crate::problem::{Condition, Drift, Inner, Local, Problem, Station};
use crate::real::{LANES, Lanes, Real};
use crate::solution::{Correction, End, Solution, Stage};

/// Why a linear system could not be solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Singular {
    /// The stages of an element cannot be eliminated: it is too long for its fastest solution.
    Element(usize),
    /// The end conditions do not determine the solution.
    System,
}

/// Why a Newton round has no correction.
#[derive(Debug, Clone, PartialEq)]
pub enum RoundError<F> {
    /// The problem has no slopes at this state.
    Slopes(F),
    /// The linear system is singular.
    Singular(Singular),
}

/// An element that meets the closure's equation at its other end too: `w = row . z + what columns add`.
#[derive(Debug, Clone)]
struct Closing<const N: usize, const M: usize> {
    element: usize,
    /// Block and lane of its other end.
    block: usize,
    lane: usize,
    row: [f64; N],
    /// What a change of the inner equation at the other end adds, and a defect of its closure slope.
    by_change: f64,
    by_defect: f64,
    defect: f64,
    /// What the values of a column at stages and own end add, and its stage slopes.
    by_value: [f64; POINTS],
    by_slopes: [[f64; N]; M],
    /// The closure slope there by the values of a column, and by w, at fixed states.
    slope_by_point: [f64; POINTS],
    slope_by_taken: f64,
    /// What the element's maps were before w was put in.
    by_taken: [f64; N],
    own_by_taken: f64,
}

/// What changes the equations beside their residual: at stages and ends in blocks, and of the end conditions.
#[derive(Debug, Clone)]
pub struct Change<const N: usize, const Q: usize, const L: usize> {
    /// At the stages; empty where nothing changes.
    pub stages: Vec<Drift<N, Q, L>>,
    /// At the ends in blocks: of inner unknowns, and of the closure variable; empty where nothing changes.
    pub ends: Vec<([Lanes; L], Lanes)>,
    /// Of the residuals of the conditions at s = 0.
    pub left: [f64; N],
    /// Of those at s = 1.
    pub right: [f64; N],
}

impl<const N: usize, const Q: usize, const L: usize> Default for Change<N, Q, L> {
    fn default() -> Self {
        Self { stages: Vec::new(), ends: Vec::new(), left: [0.0; N], right: [0.0; N] }
    }
}

/// Workspace of a collocation solve with `M` stages: nothing is allocated once the mesh has its size.
#[derive(Debug, Clone)]
pub struct Collocation<const N: usize, const M: usize, const Q: usize, const L: usize = 0> {
    /// The method's points and weights.
    pub gauss: Gauss<M>,
    /// Stations evaluated so far.
    pub evaluations: usize,
    groups: Groups,
    /// Element lengths, a group.
    steps: Vec<Lanes>,
    stations: Vec<Station<N, L>>,
    locals: Vec<Local<N, Q, L, Lanes>>,
    end_stations: Vec<Station<N, L>>,
    ends: Vec<Inner<N, L, Lanes>>,
    directions: Directions,
    condensed: Condensed<N, M>,
    maps: Vec<Map<N>>,
    closings: Vec<Closing<N, M>>,
    panels: Panels<N>,
    determinant: Determinant,
    memory: Memory<N, M>,
}

/// Right sides and solutions, kept for their memory.
#[derive(Debug, Clone)]
struct Memory<const N: usize, const M: usize> {
    columns: Vec<Column<N, M>>,
    loads: Loads<N>,
    nodes: AtNodes<N>,
    taken: Vec<f64>,
    closing: Vec<f64>,
    /// dw at stages and own ends, a group.
    values: Vec<[Lanes; POINTS]>,
    rows: Vec<f64>,
}

impl<const N: usize, const M: usize> Default for Memory<N, M> {
    fn default() -> Self {
        Self {
            columns: Vec::new(),
            loads: Loads::default(),
            nodes: AtNodes::default(),
            taken: Vec::new(),
            closing: Vec::new(),
            values: Vec::new(),
            rows: Vec::new(),
        }
    }
}

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Default for Collocation<N, M, Q, L> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, const M: usize, const Q: usize, const L: usize> Collocation<N, M, Q, L> {
    /// An empty workspace.
    pub fn new() -> Self {
        Self::with(Gauss::new())
    }

    /// An empty workspace, given the method.
    pub fn with(gauss: Gauss<M>) -> Self {
        Self {
            gauss,
            evaluations: 0,
            groups: Groups { elements: 0, stages: M },
            steps: Vec::new(),
            stations: Vec::new(),
            locals: Vec::new(),
            end_stations: Vec::new(),
            ends: Vec::new(),
            directions: Directions::default(),
            condensed: Condensed::default(),
            maps: Vec::new(),
            closings: Vec::new(),
            panels: Panels::default(),
            determinant: Determinant::ONE,
            memory: Memory::default(),
        }
    }

    /// Places of the stages along `mesh`, element by element.
    pub fn places(&self, mesh: &Mesh, out: &mut Vec<f64>) {
        out.clear();
        for i in 0..mesh.elements() {
            let (s, h) = (mesh.nodes()[i], mesh.step(i));
            out.extend(self.gauss.c.iter().map(|c| s + h * c));
        }
    }

    /// The stations of the last evaluation, in blocks, with the inner unknowns that the problem left.
    pub fn stations(&self) -> &[Station<N, L>] {
        &self.stations
    }

    /// What the problem said of them.
    pub fn locals(&self) -> &[Local<N, Q, L, Lanes>] {
        &self.locals
    }

    /// The stations at the ends that meet the closure's equation, in blocks.
    pub fn end_stations(&self) -> &[Station<N, L>] {
        &self.end_stations
    }

    /// The length over which disturbances of the closure variable fade (above zero towards s = 0), at stage `j` of element `i`.
    pub fn reach(&self, i: usize, j: usize) -> f64 {
        let (block, lane) = self.groups.at(i, j);
        self.locals[block].inner.reach.0[lane]
    }

    /// Elements that meet the closure's equation at both ends, and the size of its reach at the stage next to the other one.
    pub fn closing_reaches(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.directions.closings.iter().map(|i| {
            let stage = if self.directions.side(*i) == Side::Left { M - 1 } else { 0 };
            (*i, self.reach(*i, stage).abs())
        })
    }

    /// What each element adds to the quadratures, at the last evaluation.
    pub fn quadratures(&self, out: &mut Vec<[f64; Q]>) {
        out.clear();
        for g in 0..self.groups.count() {
            let sum = self.quadratures_of(g);
            out.extend((0..self.groups.filled(g)).map(|lane| sum.map(|v| v.0[lane])));
        }
    }

    /// The quadratures over [0, 1], at the last evaluation.
    pub fn totals(&self) -> [f64; Q] {
        let mut total = [0.0; Q];
        for g in 0..self.groups.count() {
            let sum = self.quadratures_of(g);
            for lane in 0..self.groups.filled(g) {
                for q in 0..Q {
                    total[q] += sum[q].0[lane];
                }
            }
        }
        total
    }

    #[inline(always)]
    fn quadratures_of(&self, g: usize) -> [Lanes; Q] {
        let mut sum = [Lanes::of(0.0); Q];
        for j in 0..M {
            let weight = self.steps[g] * Lanes::of(self.gauss.b[j]);
            for q in 0..Q {
                sum[q] += weight * self.locals[g * M + j].rate[q];
            }
        }
        sum
    }

    /// The inner equations at point `m` of group `g`: a stage, or the own end after them.
    #[inline(always)]
    fn inner_at(&self, g: usize, m: usize) -> &Inner<N, L, Lanes> {
        if m < M { &self.locals[g * M + m].inner } else { &self.ends[g] }
    }

    /// The determinant at the last factorisation.
    pub fn determinant(&self) -> Determinant {
        self.determinant
    }

    /// Element lengths, a group.
    pub fn steps(&self) -> &[Lanes] {
        &self.steps
    }

    /// Takes the stations of a solution: states at the stages and ends.
    #[inline(always)]
    pub fn take_stations(&mut self, solution: &Solution<N, M, L>) {
        let groups = solution.groups();
        self.groups = groups;
        let zero = Lanes::of(0.0);
        let blank = Station { z: [zero; N], inner: [zero; L], closure_slope: zero };
        resize(&mut self.steps, groups.count(), zero);
        resize(&mut self.stations, groups.count() * M, blank);
        for g in 0..groups.count() {
            let (h, z) = group_start(groups, g, solution);
            let stages = &solution.stages[g * M..(g + 1) * M];
            for j in 0..M {
                let mut out = z;
                for l in 0..M {
                    let w = h * Lanes::of(self.gauss.a[j][l]);
                    for a in 0..N {
                        out[a] += w * stages[l].slope[a];
                    }
                }
                let Stage { inner, closure_slope, .. } = stages[j];
                self.stations[g * M + j] = Station { z: out, inner, closure_slope };
            }
            self.steps[g] = h;
        }
        self.directions.clone_from(&solution.directions);
        resize(&mut self.end_stations, self.directions.ends.len(), blank);
        for (b, place) in self.directions.ends.iter().enumerate() {
            let station = &mut self.end_stations[b];
            for lane in 0..LANES {
                let i = place.elements[lane];
                let mut z = solution.nodes[i];
                if place.sides[lane] == Side::Right {
                    let (first, own) = (i / LANES * M, i % LANES);
                    let h = solution.mesh.step(i);
                    for (b, stage) in self.gauss.b.iter().zip(&solution.stages[first..first + M]) {
                        for a in 0..N {
                            z[a] += h * b * stage.slope[a].0[own];
                        }
                    }
                }
                for a in 0..N {
                    station.z[a].0[lane] = z[a];
                }
            }
            let End { inner, closure_slope } = solution.ends[b];
            station.inner = inner;
            station.closure_slope = closure_slope;
        }
    }

    /// Evaluates the problem at the stations of a solution.
    ///
    /// # Errors
    /// Those of the problem.
    #[inline(always)]
    pub fn evaluate<P: Problem<N, Q, L>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> Result<(), P::Failure> {
        self.take_stations(solution);
        resize(&mut self.locals, self.stations.len(), Local::default());
        self.evaluations += self.groups.elements * M;
        problem.stages::<FUSED>(self.groups, &mut self.stations, &mut self.locals)?;
        if self.directions.is_closed() {
            resize(&mut self.ends, self.end_stations.len(), Inner::default());
            problem.ends::<FUSED>(&self.directions.ends, &mut self.end_stations, &mut self.ends)?;
        }
        Ok(())
    }

    /// Takes the inner unknowns with their Newton step at fixed state and closure slope into a solution, and the closure slopes that
    /// follow from the polynomials through the closure variable.
    pub fn take_inner(&self, solution: &mut Solution<N, M, L>) {
        for ((stage, station), local) in solution.stages.iter_mut().zip(&self.stations).zip(&self.locals) {
            for a in 0..L {
                stage.inner[a] = station.inner[a] + local.inner.change[a];
            }
        }
        if !self.directions.is_closed() {
            return;
        }
        for ((end, station), inner) in solution.ends.iter_mut().zip(&self.end_stations).zip(&self.ends) {
            for a in 0..L {
                end.inner[a] = station.inner[a] + inner.change[a];
            }
        }
        let at_end = |block: usize, lane: usize| self.ends[block].value.0[lane] + self.ends[block].value_change.0[lane];
        for i in 0..self.groups.elements {
            let (g, lane) = (i / LANES, i % LANES);
            let h = solution.mesh.step(i);
            let d = &self.gauss.closure[self.directions.side(i).index()];
            let mut values = [0.0; POINTS];
            for j in 0..M {
                let inner = &self.locals[g * M + j].inner;
                values[j] = inner.value.0[lane] + inner.value_change.0[lane];
            }
            values[M] = at_end(g, lane);
            let (block, end_lane) = self.directions.end_taken(i);
            values[M + 1] = at_end(block, end_lane);
            let slope = |m: usize| (0..M + 2).map(|l| d[m][l] * values[l]).sum::<f64>() / h;
            let last = i + 1 == self.groups.elements;
            let lanes = |first: usize, fill: bool| if fill { first..LANES } else { first..first + 1 };
            for j in 0..M {
                for lane in lanes(lane, last) {
                    solution.stages[g * M + j].closure_slope.0[lane] = slope(j);
                }
            }
            for lane in lanes(lane, last) {
                solution.ends[g].closure_slope.0[lane] = slope(M);
            }
            if let Some(k) = self.directions.closings.iter().position(|c| *c == i) {
                for lane in lanes(k % LANES, k + 1 == self.directions.closings.len()) {
                    solution.ends[self.groups.count() + k / LANES].closure_slope.0[lane] = slope(M + 1);
                }
            }
        }
    }

    /// Evaluates and factorises.
    ///
    /// # Errors
    /// [`RoundError`].
    #[inline(always)]
    pub fn linearise<P: Problem<N, Q, L>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> Result<(), RoundError<P::Failure>> {
        self.evaluate::<P, FUSED>(problem, solution).map_err(RoundError::Slopes)?;
        self.factorise::<P, FUSED>(problem, solution).map_err(RoundError::Singular)
    }

    /// Factorises what was evaluated last.
    ///
    /// # Errors
    /// [`Singular`].
    #[inline(always)]
    pub fn factorise<P: Problem<N, Q, L>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M, L>,
    ) -> Result<(), Singular> {
        let groups = self.groups;
        let mut product = Product::new();
        self.condensed.resize(groups.count(), self.directions.is_closed());
        let blank = Map { by_state: [[0.0; N]; N], by_taken: [0.0; N], own_by_state: [0.0; N], own_by_taken: 0.0 };
        resize(&mut self.maps, groups.elements, blank);
        for g in 0..groups.count() {
            let mut own_product = Lanes::of(1.0);
            let condensed = if self.directions.is_closed() {
                self.condense_closed::<FUSED>(g, &mut own_product)
            } else {
                let locals = &self.locals[g * M..(g + 1) * M];
                let (group, _) = self.condensed.group_mut(g);
                condense::<FUSED, N, M, Q, L>(self.steps[g], &self.gauss, locals, group, &mut own_product)
            };
            condensed.map_err(|lane| Singular::Element(groups.element(g, lane)))?;
            for lane in 0..groups.filled(g) {
                if own_product.0[lane] < 0.0 {
                    product.turn();
                }
            }
            self.map_group::<FUSED>(g);
        }
        self.close(&mut product)?;
        let left_count = problem.left_count();
        let (mut left, mut right) = ([Condition::default(); N], [Condition::default(); N]);
        problem.left(&solution.nodes[0], &mut left);
        problem.right(&solution.nodes[groups.elements], &mut right);
        let conditions = (&left[..left_count], &right[..N - left_count]);
        self.determinant = self
            .panels
            .factorise::<FUSED>(&self.maps, &self.directions, conditions.0, conditions.1, product)
            .ok_or(Singular::System)?;
        for (r, condition) in conditions.0.iter().enumerate() {
            self.memory.loads.left[r] = -condition.residual;
        }
        for (r, condition) in conditions.1.iter().enumerate() {
            self.memory.loads.right[r] = -condition.residual;
        }
        Ok(())
    }

    #[inline(always)]
    fn condense_closed<const FUSED: bool>(&mut self, g: usize, product: &mut Lanes) -> Result<(), usize> {
        let groups = self.groups;
        let zero = Lanes::of(0.0);
        let (mut values, mut slopes) = ([zero; POINTS], [zero; POINTS]);
        for j in 0..M {
            values[j] = self.locals[g * M + j].inner.value;
            slopes[j] = self.stations[g * M + j].closure_slope;
        }
        values[M] = self.ends[g].value;
        slopes[M] = self.end_stations[g].closure_slope;
        for lane in 0..LANES {
            let (block, from) = self.directions.end_taken(groups.element(g, lane));
            values[M + 1].0[lane] = self.ends[block].value.0[from];
        }
        let locals = &self.locals[g * M..(g + 1) * M];
        let (group, Some(closure)) = self.condensed.group_mut(g) else { return Err(0) };
        condense_closed::<FUSED, N, M, Q, L>(
            self.steps[g],
            &self.gauss,
            self.directions.ends[g].sides,
            locals,
            &self.ends[g],
            &values,
            &slopes,
            group,
            closure,
            product,
        )
    }

    /// The maps of the elements of a group.
    #[inline(always)]
    fn map_group<const FUSED: bool>(&mut self, g: usize) {
        let (groups, h) = (self.groups, self.steps[g]);
        let (by_stages, by_taken_stages) = (self.condensed.by_state(g), self.condensed.by_taken(g));
        let zero = Lanes::of(0.0);
        let mut by_state = [[zero; N]; N];
        for a in 0..N {
            by_state[a][a] = Lanes::of(1.0);
        }
        for j in 0..M {
            let w = h * Lanes::of(self.gauss.b[j]);
            add_scaled::<FUSED, N, Lanes>(&mut by_state, w, &by_stages[j]);
        }
        for lane in 0..groups.filled(g) {
            let out = &mut self.maps[g * LANES + lane];
            for a in 0..N {
                for b in 0..N {
                    out.by_state[a][b] = by_state[a][b].0[lane];
                }
            }
        }
        if !self.directions.is_closed() {
            return;
        }
        let closure = &self.condensed.closures[g];
        let mut by_taken = [zero; N];
        let mut own_by_state = [zero; N];
        let mut own_by_taken = closure.own_by_taken;
        for m in 0..M + 1 {
            let inner = self.inner_at(g, m);
            for a in 0..N {
                own_by_state[a] += closure.own[m] * inner.value_gradient[a];
            }
        }
        for j in 0..M {
            let w = h * Lanes::of(self.gauss.b[j]);
            for a in 0..N {
                let s = h * closure.own_by_slopes[j][a];
                by_taken[a] += w * by_taken_stages[j][a];
                own_by_taken += s * by_taken_stages[j][a];
                for b in 0..N {
                    own_by_state[b] = own_by_state[b].plus::<FUSED>(s, by_stages[j][a][b]);
                }
            }
        }
        for lane in 0..groups.filled(g) {
            let out = &mut self.maps[g * LANES + lane];
            out.by_taken = by_taken.map(|v| v.0[lane]);
            out.own_by_state = own_by_state.map(|v| v.0[lane]);
            out.own_by_taken = own_by_taken.0[lane];
        }
    }

    /// Puts what closing elements take over into their maps.
    fn close(&mut self, product: &mut Product) -> Result<(), Singular> {
        self.closings.clear();
        self.closings.reserve(self.directions.closings.len());
        for (k, &i) in self.directions.closings.iter().enumerate() {
            let (block, lane) = (self.groups.count() + k / LANES, k % LANES);
            let closing = self.closing(i, block, lane, product).ok_or(Singular::Element(i))?;
            let map = &mut self.maps[i];
            for a in 0..N {
                for b in 0..N {
                    map.by_state[a][b] += map.by_taken[a] * closing.row[b];
                }
                map.own_by_state[a] += map.own_by_taken * closing.row[a];
            }
            map.by_taken = [0.0; N];
            map.own_by_taken = 0.0;
            self.closings.push(closing);
        }
        Ok(())
    }

    fn closing(&self, i: usize, block: usize, lane: usize, product: &mut Product) -> Option<Closing<N, M>> {
        let (g, own) = (i / LANES, i % LANES);
        let (map, closure) = (&self.maps[i], &self.condensed.closures[g]);
        let h = self.steps[g].0[own];
        let at = |v: Lanes| v.0[own];
        let other = &self.ends[block];
        let reach = other.reach.0[lane];
        let at_right = self.directions.side(i) == Side::Left;
        // Slopes at the other end by the values at the points, and by those that P leaves.
        let defect = at(closure.other_slope) - self.end_stations[block].closure_slope.0[lane];
        let by_point = closure.other.map(|v| v.0[own]);
        let slope_by_taken = at(closure.other_by_taken);
        let mut by_slopes = [[0.0; N]; M];
        let mut row = [0.0; N];
        for m in 0..M + 1 {
            let gradient = self.inner_at(g, m).value_gradient.map(|v| v.0[own]);
            for a in 0..N {
                row[a] += by_point[m] * gradient[a];
            }
            for l in 0..M {
                let weight = if m < M { self.gauss.a[m][l] } else { at(closure.right) * self.gauss.b[l] };
                for a in 0..N {
                    by_slopes[l][a] += h * weight * by_point[m] * gradient[a];
                }
            }
        }
        let end_gradient = other.value_gradient.map(|v| v.0[lane]);
        for a in 0..N {
            row[a] = reach * row[a] + end_gradient[a];
            for l in 0..M {
                by_slopes[l][a] *= reach;
                if at_right {
                    by_slopes[l][a] += h * self.gauss.b[l] * end_gradient[a];
                }
            }
        }
        let mut by_taken = reach * slope_by_taken;
        for l in 0..M {
            for a in 0..N {
                by_taken += by_slopes[l][a] * at(self.condensed.by_taken(g)[l][a]);
                for b in 0..N {
                    row[b] += by_slopes[l][a] * at(self.condensed.by_state(g)[l][a][b]);
                }
            }
        }
        let left = 1.0 - by_taken;
        if left == 0.0 || !left.is_finite() {
            return None;
        }
        if left < 0.0 {
            product.turn();
        }
        let scale = 1.0 / left;
        Some(Closing {
            element: i,
            block,
            lane,
            row: row.map(|v| scale * v),
            by_change: scale,
            by_defect: scale * reach,
            defect,
            by_value: by_point.map(|v| scale * reach * v),
            by_slopes: by_slopes.map(|v| v.map(|v| scale * v)),
            slope_by_point: by_point,
            slope_by_taken,
            by_taken: map.by_taken,
            own_by_taken: map.own_by_taken,
        })
    }

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
        if self.directions.is_closed() {
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
        if self.directions.is_closed() {
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
        if self.directions.is_closed() {
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
        if !self.directions.is_closed() {
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

    /// The inner equations at the ends at the last evaluation, in blocks.
    pub fn ends(&self) -> &[Inner<N, L, Lanes>] {
        &self.ends
    }

    /// The response of the solution to a change of the equations: the derivative by what the change is by.
    #[inline(always)]
    pub fn response<const FUSED: bool>(&self, change: &Change<N, Q, L>, out: &mut Correction<N, M, Q, L>) {
        let groups = self.groups;
        let mut memory = Memory::default();
        memory.columns.reserve_exact(groups.count());
        resize(&mut memory.loads.transitions, groups.elements, [0.0; N]);
        resize(&mut memory.loads.own, groups.elements, 0.0);
        let zero = Lanes::of(0.0);
        for g in 0..groups.count() {
            let (mut slopes, mut value) = ([[zero; N]; M], [zero; POINTS]);
            if !change.stages.is_empty() {
                for j in 0..M {
                    slopes[j] = change.stages[g * M + j].slope;
                    value[j] = change.stages[g * M + j].value;
                }
            }
            if !change.ends.is_empty() {
                value[M] = change.ends[g].1;
            }
            let column = self.column::<FUSED>(g, slopes, &value, None);
            self.load_rows(g, &column, &mut memory.loads);
            memory.columns.push(column);
        }
        let at_end = |block: usize, lane: usize| change.ends.get(block).map_or(0.0, |end| end.1.0[lane]);
        self.load_closings(&memory.columns, at_end, false, &mut memory.loads, &mut memory.closing);
        for r in 0..N {
            (memory.loads.left[r], memory.loads.right[r]) = (-change.left[r], -change.right[r]);
        }
        self.panels.solve(&memory.loads, &mut memory.nodes, &mut memory.rows);
        self.fill_taken(&memory.nodes, &memory.closing, &mut memory.taken);
        self.finish::<FUSED>(&mut memory, false, out, |g, j, stage, rate| {
            if let Some(drift) = change.stages.get(g * M + j) {
                for a in 0..L {
                    stage.inner[a] += drift.inner[a];
                }
                for q in 0..Q {
                    rate[q] += drift.rate[q];
                }
            }
        });
        for (end, (inner, _)) in out.ends.iter_mut().zip(&change.ends) {
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
                if self.directions.is_closed() {
                    taken.0[lane] = memory.taken[i];
                }
            }
            let mut k = column.slopes;
            for j in 0..M {
                let by_state = apply(&by_stages[j], &z);
                for a in 0..N {
                    k[j][a] += by_state[a];
                    if self.directions.is_closed() {
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
            if self.directions.is_closed() {
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

/// Element lengths and left nodes of group `g`.
#[inline(always)]
fn group_start<const N: usize, const M: usize, const L: usize>(
    groups: Groups,
    g: usize,
    solution: &Solution<N, M, L>,
) -> (Lanes, [Lanes; N]) {
    let mut h = Lanes::of(0.0);
    let mut z = [Lanes::of(0.0); N];
    for lane in 0..LANES {
        let i = groups.element(g, lane);
        h.0[lane] = solution.mesh.step(i);
        for a in 0..N {
            z[a].0[lane] = solution.nodes[i][a];
        }
    }
    (h, z)
}
