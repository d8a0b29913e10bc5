//! Gauss collocation: linearisation, condensation of the stages, and the sweep over the nodes.
//!
//! The unknowns of an element are the slopes at its `M` stages; they are eliminated element by
//! element, four elements side by side, which leaves `z_{i+1} = G_i z_i + g_i` between nodes. The conditions at s = 1 are then
//! carried from node to node towards s = 0 as rows `C_i z_i = d_i`, reduced with pivoting at every
//! node. Carrying rows (rather than solutions) is what keeps problems with both fast growing and
//! fast decaying solutions stable, where shooting from either end overflows.

mod contributions;

use self::contributions::Adjoint;
use crate::block::{Block, add_scaled, apply, inverse};
use crate::carry::{
    CarriedRows, Determinant, Product, Transition, multiply_by_determinant, reduce_on, reduce_on_largest,
};
use crate::condense::{Stages, eliminate, eliminate_in_order, eliminate_lane};
use crate::gauss::Gauss;
use crate::groups::Groups;
use crate::mesh::Mesh;
use crate::problem::{Condition, Local, Problem};
use crate::real::{LANES, Lanes, Real};
use crate::solution::{Correction, Solution};

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

/// Workspace of a collocation solve with `M` stages: nothing is allocated once the mesh has its size.
#[derive(Debug, Clone)]
pub struct Collocation<const N: usize, const M: usize, const Q: usize> {
    /// The method's points and weights.
    pub gauss: Gauss<M>,
    groups: Groups,
    /// Element lengths, a group.
    steps: Vec<Lanes>,
    states: Vec<[Lanes; N]>,
    locals: Vec<Local<N, Q, Lanes>>,
    drifts: Vec<[Lanes; N]>,
    stages: Vec<Stages<N, M>>,
    transitions: Vec<Transition<N>>,
    /// Memory of the elimination.
    scratch: Box<[[Block<N, Lanes>; M]; M]>,
    rows: Vec<CarriedRows<N>>,
    right_count: usize,
    determinant: Determinant,
    /// Inverse of the left conditions joined with the rows at node 0.
    start: Block<N>,
    left_load: [[f64; 2]; N],
    adjoint: Adjoint<N>,
}

impl<const N: usize, const M: usize, const Q: usize> Default for Collocation<N, M, Q> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, const M: usize, const Q: usize> Collocation<N, M, Q> {
    /// An empty workspace.
    pub fn new() -> Self {
        Self::with(Gauss::new())
    }

    /// An empty workspace, given the method.
    pub fn with(gauss: Gauss<M>) -> Self {
        Self {
            gauss,
            groups: Groups { elements: 0, stages: M },
            steps: Vec::new(),
            states: Vec::new(),
            locals: Vec::new(),
            drifts: Vec::new(),
            stages: Vec::new(),
            transitions: Vec::new(),
            scratch: Box::new([[[[Lanes::of(0.0); N]; N]; M]; M]),
            rows: Vec::new(),
            right_count: 0,
            determinant: Determinant { sign: 0.0, log: 0.0 },
            start: [[0.0; N]; N],
            left_load: [[0.0; 2]; N],
            adjoint: Adjoint::default(),
        }
    }

    /// The stage points of a mesh, in order.
    pub fn stations(&self, mesh: &Mesh, out: &mut Vec<f64>) {
        out.clear();
        for i in 0..mesh.elements() {
            let (s, h) = (mesh.nodes()[i], mesh.step(i));
            out.extend(self.gauss.c.iter().map(|c| s + h * c));
        }
    }

    /// State at stage `j` of element `i` of the last [`Collocation::linearise`].
    pub fn state(&self, i: usize, j: usize) -> [f64; N] {
        let (block, lane) = self.groups.at(i, j);
        self.states[block].map(|v| v.0[lane])
    }

    /// Slopes, rates and gradients at stage `j` of element `i` of the last [`Collocation::linearise`].
    pub fn local(&self, i: usize, j: usize) -> Local<N, Q> {
        let (block, lane) = self.groups.at(i, j);
        self.locals[block].lane(lane)
    }

    /// How element `i` follows the state at its left node and `loads` on the slopes at its stages, at the last
    /// [`Collocation::linearise`]: the stage slopes by that state, and those by each load in place of the load. `None` where its stages
    /// cannot be eliminated.
    #[inline(always)]
    pub fn eliminate(&self, i: usize, loads: &mut [[[f64; N]; M]]) -> Option<[[[f64; N]; N]; M]> {
        let (block, lane) = self.groups.at(i, 0);
        let locals: [Local<N, Q>; M] = std::array::from_fn(|j| self.local(i, j));
        let mut response = [[[0.0; N]; N]; M];
        let h = self.steps[block / M].0[lane];
        eliminate(h, &self.gauss, &locals, &mut response, loads).then_some(response)
    }

    /// The conditions at s = 1, carried to node `i` by the last [`Collocation::linearise`].
    pub fn rows(&self, i: usize) -> &CarriedRows<N> {
        &self.rows[i]
    }

    /// The state at s = 0 by what its conditions ask for, those of the problem there before the carried ones.
    pub fn start(&self) -> &[[f64; N]; N] {
        &self.start
    }

    /// Determinant at the last [`Collocation::linearise`].
    pub fn determinant(&self) -> Determinant {
        self.determinant
    }

    /// Evaluates the problem at the stages of `solution` without linearising.
    ///
    /// # Errors
    /// Those of [`Problem::slopes`].
    #[inline(always)]
    pub fn evaluate<P: Problem<N, Q>>(&mut self, problem: &mut P, solution: &Solution<N, M>) -> Result<(), P::Failure> {
        self.evaluate_with::<P, false>(problem, solution)
    }

    /// [`Collocation::evaluate`]; for `FUSED` see [`Collocation::factorise_with`].
    ///
    /// # Errors
    /// Those of [`Problem::slopes`].
    #[inline(always)]
    pub fn evaluate_with<P: Problem<N, Q>, const FUSED: bool>(
        &mut self,
        problem: &mut P,
        solution: &Solution<N, M>,
    ) -> Result<(), P::Failure> {
        self.take_states(solution);
        self.locals.resize(self.states.len(), Local::default());
        problem.slopes::<FUSED>(self.groups, &self.states, &mut self.locals)
    }

    /// The states at the stages of `solution`, in the blocks of [`Groups`].
    #[inline(always)]
    pub fn take_states(&mut self, solution: &Solution<N, M>) -> &[[Lanes; N]] {
        let groups = Groups { elements: solution.mesh.elements(), stages: M };
        self.groups = groups;
        self.steps.resize(groups.count(), Lanes::of(0.0));
        self.states.resize(groups.count() * M, [Lanes::of(0.0); N]);
        for g in 0..groups.count() {
            let mut h = Lanes::of(0.0);
            let mut z = [Lanes::of(0.0); N];
            for lane in 0..LANES {
                let i = groups.element(g, lane);
                h.0[lane] = solution.mesh.step(i);
                for a in 0..N {
                    z[a].0[lane] = solution.nodes[i][a];
                }
            }
            let k = stage_slopes(groups, g, solution);
            for j in 0..M {
                let mut out = z;
                for l in 0..M {
                    let w = h * Lanes::of(self.gauss.a[j][l]);
                    for a in 0..N {
                        out[a] += w * k[l][a];
                    }
                }
                self.states[g * M + j] = out;
            }
            self.steps[g] = h;
        }
        &self.states
    }

    /// Evaluates the problem at `solution` and factorises its linearisation. With `parameter`, also
    /// the response to the problem's parameter.
    ///
    /// # Errors
    /// [`RoundError`].
    #[inline(always)]
    pub fn linearise<P: Problem<N, Q>>(
        &mut self,
        problem: &mut P,
        solution: &Solution<N, M>,
        parameter: bool,
    ) -> Result<(), RoundError<P::Failure>> {
        self.evaluate(problem, solution).map_err(RoundError::Slopes)?;
        self.factorise_with::<P, false>(problem, solution, parameter).map_err(RoundError::Singular)
    }

    /// The rest of [`Collocation::linearise`] once the problem was evaluated at `solution`; with `FUSED` in fused
    /// multiply-adds, which only pays where the caller is compiled for a processor that has them. On its own so that
    /// callers who compile for several processors do so once for what is evaluated.
    ///
    /// # Errors
    /// [`Singular`].
    #[inline(always)]
    pub fn factorise_with<P: Problem<N, Q>, const FUSED: bool>(
        &mut self,
        problem: &mut P,
        solution: &Solution<N, M>,
        parameter: bool,
    ) -> Result<(), Singular> {
        if parameter {
            self.drifts.resize(self.locals.len(), [Lanes::of(0.0); N]);
            problem.drift(&mut self.drifts);
            self.condense::<FUSED, 2>(solution)?;
        } else {
            self.condense::<FUSED, 1>(solution)?;
        }
        self.carry_rows::<P, FUSED>(problem, solution)
    }

    /// Eliminates the stages of every element, with the first `C` columns of the loads.
    #[inline(always)]
    fn condense<const FUSED: bool, const C: usize>(&mut self, solution: &Solution<N, M>) -> Result<(), Singular> {
        let groups = self.groups;
        let zero = Lanes::of(0.0);
        let empty = Stages { response: [[[zero; N]; N]; M], load: [[[zero; N]; M]; 2] };
        self.stages.resize(groups.count(), empty);
        self.transitions.resize(groups.elements, Transition { by_state: [[0.0; N]; N], affine: [[0.0; N]; 2] });
        for g in 0..groups.count() {
            let h = self.steps[g];
            let k = stage_slopes(groups, g, solution);
            let locals = &self.locals[g * M..(g + 1) * M];
            let drifts = if C > 1 { &self.drifts[g * M..(g + 1) * M] } else { &[] };
            let stages = &mut self.stages[g];
            let mut given = [[[zero; N]; M]; C];
            for j in 0..M {
                for a in 0..N {
                    given[0][j][a] = locals[j].slope[a] - k[j][a];
                }
                if C > 1 {
                    given[1][j] = drifts[j];
                }
            }
            stages.load[..C].copy_from_slice(&given);
            let fine = eliminate_in_order::<FUSED, N, M, Q>(
                h,
                &self.gauss,
                locals,
                &mut self.scratch,
                &mut stages.response,
                &mut stages.load[..C],
            );
            if !(-fine).all_below(0.0) {
                for lane in 0..LANES {
                    let fine = fine.0[lane] > 0.0;
                    if !fine && !eliminate_lane(lane, h, &self.gauss, locals, &given, stages) {
                        return Err(Singular::Element(groups.element(g, lane)));
                    }
                }
            }
            let load = &stages.load;
            let mut by_state = [[zero; N]; N];
            let mut affine = [[zero; N]; C];
            for a in 0..N {
                by_state[a][a] = Lanes::of(1.0);
            }
            for j in 0..M {
                let w = h * Lanes::of(self.gauss.b[j]);
                add_scaled::<FUSED, N, Lanes>(&mut by_state, w, &stages.response[j]);
                for a in 0..N {
                    affine[0][a] += w * (k[j][a] + load[0][j][a]);
                    if C > 1 {
                        affine[1][a] += w * load[1][j][a];
                    }
                }
            }
            for lane in 0..groups.filled(g) {
                let i = g * LANES + lane;
                let out = &mut self.transitions[i];
                for a in 0..N {
                    for b in 0..N {
                        out.by_state[a][b] = by_state[a][b].0[lane];
                    }
                    out.affine[0][a] = solution.nodes[i][a] - solution.nodes[i + 1][a] + affine[0][a].0[lane];
                    out.affine[1][a] = if C > 1 { affine[1][a].0[lane] } else { 0.0 };
                }
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn carry_rows<P: Problem<N, Q>, const FUSED: bool>(
        &mut self,
        problem: &P,
        solution: &Solution<N, M>,
    ) -> Result<(), Singular> {
        let n = solution.mesh.elements();
        let left_count = problem.left_count();
        let right_count = N - left_count;
        self.right_count = right_count;
        let blank = CarriedRows { rows: [[0.0; N]; N], load: [[0.0; 2]; N], pivot: [0; N], reduction: [[0.0; N]; N] };
        self.rows.resize(n + 1, blank);
        let mut determinant = Product::new();

        let mut conditions = [Condition::default(); N];
        problem.right(&solution.nodes[n], &mut conditions);
        let last = &mut self.rows[n];
        for r in 0..right_count {
            last.rows[r] = conditions[r].gradient;
            last.load[r] = [-conditions[r].residual, -conditions[r].drift];
        }
        if !reduce_on_largest(last, right_count, &mut determinant) {
            return Err(Singular::System);
        }
        for i in (0..n).rev() {
            let (before, behind) = self.rows.split_at_mut(i + 1);
            let (own, next, transition) = (&mut before[i], &behind[0], &self.transitions[i]);
            own.carry::<FUSED>(next, transition, right_count);
            own.pivot = next.pivot;
            if !reduce_on::<FUSED, N>(own, right_count, &mut determinant) {
                own.carry::<FUSED>(next, transition, right_count);
                if !reduce_on_largest(own, right_count, &mut determinant) {
                    return Err(Singular::System);
                }
            }
        }

        let mut conditions = [Condition::default(); N];
        problem.left(&solution.nodes[0], &mut conditions);
        let mut joined = [[0.0; N]; N];
        for r in 0..left_count {
            joined[r] = conditions[r].gradient;
            self.left_load[r] = [-conditions[r].residual, -conditions[r].drift];
        }
        joined[left_count..N].copy_from_slice(&self.rows[0].rows[..right_count]);
        multiply_by_determinant(joined, &mut determinant);
        self.determinant = determinant.whole();
        self.start = inverse(&joined, 1e-300).ok_or(Singular::System)?;
        Ok(())
    }

    /// Solves for column `column` of the loads (0: Newton correction, 1: response to the parameter).
    #[inline(always)]
    pub fn solve(&self, solution: &Solution<N, M>, column: usize, out: &mut Correction<N, M, Q>) {
        let n = solution.mesh.elements();
        out.nodes.resize(n + 1, [0.0; N]);
        out.slopes.resize(n, [[0.0; N]; M]);
        out.by_element.resize(n, [0.0; Q]);
        self.solve_nodes(column, &mut out.nodes);
        self.solve_stages(column, out);
    }

    /// The changes of the states at the nodes, from s = 0 on.
    #[inline(always)]
    fn solve_nodes(&self, column: usize, nodes: &mut [[f64; N]]) {
        let left_count = N - self.right_count;
        let mut load = [0.0; N];
        for r in 0..N {
            load[r] =
                if r < left_count { self.left_load[r][column] } else { self.rows[0].load[r - left_count][column] };
        }
        nodes[0] = apply(&self.start, &load);
        for i in 0..self.groups.elements {
            let element = &self.transitions[i];
            let mut next = apply(&element.by_state, &nodes[i]);
            for a in 0..N {
                next[a] += element.affine[column][a];
            }
            // The carried rows, not the transition, decide the components they pivot on: this
            // stops what grows towards s = 1 from being amplified.
            let rows = &self.rows[i + 1];
            for r in 0..self.right_count {
                next[rows.pivot[r]] = 0.0;
            }
            let mut pivots = [0.0; N];
            for r in 0..self.right_count {
                let mut v = rows.load[r][column];
                for c in 0..N {
                    v -= rows.rows[r][c] * next[c];
                }
                pivots[r] = v;
            }
            for r in 0..self.right_count {
                next[rows.pivot[r]] = pivots[r];
            }
            nodes[i + 1] = next;
        }
    }

    /// The changes of the stage slopes and of the quadratures, given those at the nodes.
    #[inline(always)]
    fn solve_stages(&self, column: usize, out: &mut Correction<N, M, Q>) {
        let groups = self.groups;
        out.total = [0.0; Q];
        for g in 0..groups.count() {
            let (h, stages) = (self.steps[g], &self.stages[g]);
            let mut z = [Lanes::of(0.0); N];
            for lane in 0..LANES {
                for a in 0..N {
                    z[a].0[lane] = out.nodes[groups.element(g, lane)][a];
                }
            }
            let mut k = [[Lanes::of(0.0); N]; M];
            for j in 0..M {
                k[j] = apply(&stages.response[j], &z);
                for a in 0..N {
                    k[j][a] += stages.load[column][j][a];
                }
            }
            let mut quadrature = [Lanes::of(0.0); Q];
            for j in 0..M {
                let mut dz = z;
                for l in 0..M {
                    let w = h * Lanes::of(self.gauss.a[j][l]);
                    for a in 0..N {
                        dz[a] += w * k[l][a];
                    }
                }
                let local = &self.locals[g * M + j];
                for q in 0..Q {
                    let mut rate = Lanes::of(0.0);
                    for a in 0..N {
                        rate += local.rate_gradient[q][a] * dz[a];
                    }
                    quadrature[q] += h * Lanes::of(self.gauss.b[j]) * rate;
                }
            }
            for lane in 0..groups.filled(g) {
                let i = g * LANES + lane;
                for j in 0..M {
                    for a in 0..N {
                        out.slopes[i][j][a] = k[j][a].0[lane];
                    }
                }
                for q in 0..Q {
                    out.by_element[i][q] = quadrature[q].0[lane];
                    out.total[q] += out.by_element[i][q];
                }
            }
        }
    }

    /// The quadratures over the elements of group `g`.
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

    /// The quadratures over each element at the state of the last linearisation.
    pub fn quadratures(&self, out: &mut Vec<[f64; Q]>) {
        out.clear();
        for g in 0..self.groups.count() {
            let sum = self.quadratures_of(g);
            out.extend((0..self.groups.filled(g)).map(|lane| sum.map(|v| v.0[lane])));
        }
    }

    /// The quadratures over [0, 1] at the state of the last linearisation.
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
}

/// Slopes at the stages of the elements of group `g`.
#[inline(always)]
fn stage_slopes<const N: usize, const M: usize>(
    groups: Groups,
    g: usize,
    solution: &Solution<N, M>,
) -> [[Lanes; N]; M] {
    let mut k = [[Lanes::of(0.0); N]; M];
    for lane in 0..LANES {
        let own = &solution.slopes[groups.element(g, lane)];
        for j in 0..M {
            for a in 0..N {
                k[j][a].0[lane] = own[j][a];
            }
        }
    }
    k
}
