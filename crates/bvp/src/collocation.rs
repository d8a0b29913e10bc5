//! Gauss collocation: linearisation, condensation of the stages, and the sweep over the nodes.
//!
//! The unknowns of an element are the slopes at its `M` stages; they are eliminated element by
//! element, four elements side by side, which leaves `z_{i+1} = G_i z_i + g_i` between nodes. The conditions at s = 1 are then
//! carried from node to node towards s = 0 as rows `C_i z_i = d_i`, reduced with pivoting at every
//! node. Carrying rows (rather than solutions) is what keeps problems with both fast growing and
//! fast decaying solutions stable, where shooting from either end overflows.

use crate::block::{Block, add_scaled, apply, inverse, invert_in_order, multiply, subtract_applied, subtract_product};
use crate::gauss::Gauss;
use crate::groups::Groups;
use crate::mesh::Mesh;
use crate::problem::{Condition, Local, Problem};
use crate::real::{LANES, Lanes, Real};

/// A discrete solution: states at the nodes and slopes at the stages.
#[derive(Debug, Clone)]
pub struct Solution<const N: usize, const M: usize> {
    /// The mesh.
    pub mesh: Mesh,
    /// States at the nodes.
    pub nodes: Vec<[f64; N]>,
    /// Slopes at the stages of each element.
    pub slopes: Vec<[[f64; N]; M]>,
}

impl<const N: usize, const M: usize> Solution<N, M> {
    /// The state `z` everywhere.
    pub fn constant(mesh: Mesh, z: [f64; N]) -> Self {
        let n = mesh.elements();
        Self { mesh, nodes: vec![z; n + 1], slopes: vec![[[0.0; N]; M]; n] }
    }

    /// State at `s` from the collocation polynomial of element `i`.
    pub fn state_in(&self, gauss: &Gauss<M>, i: usize, s: f64) -> [f64; N] {
        let h = self.mesh.step(i);
        let w = gauss.integrals((s - self.mesh.nodes()[i]) / h);
        let mut z = self.nodes[i];
        for j in 0..M {
            for a in 0..N {
                z[a] += h * w[j] * self.slopes[i][j][a];
            }
        }
        z
    }

    /// Carries the solution over to the mesh of `out` by its polynomials; elements that both meshes have stay as they are.
    pub fn onto(&self, gauss: &Gauss<M>, out: &mut Self) {
        let Self { mesh, nodes, slopes } = out;
        nodes.clear();
        slopes.clear();
        let mut e = 0;
        let mut advance = |s: f64| {
            while e + 1 < self.mesh.elements() && self.mesh.nodes()[e + 1] <= s {
                e += 1;
            }
            e
        };
        for (i, &s) in mesh.nodes().iter().enumerate() {
            let e = advance(s);
            let start = self.mesh.nodes()[e];
            nodes.push(if s == start { self.nodes[e] } else { self.state_in(gauss, e, s) });
            if i == mesh.elements() {
                break;
            }
            if s == start && mesh.nodes()[i + 1] == self.mesh.nodes()[e + 1] {
                slopes.push(self.slopes[e]);
                continue;
            }
            let h = mesh.step(i);
            let mut k = [[0.0; N]; M];
            for j in 0..M {
                let at = s + h * gauss.c[j];
                let e = advance(at);
                let l = gauss.cardinals((at - self.mesh.nodes()[e]) / self.mesh.step(e));
                for m in 0..M {
                    for a in 0..N {
                        k[j][a] += l[m] * self.slopes[e][m][a];
                    }
                }
            }
            slopes.push(k);
        }
    }

    /// This solution's polynomials sampled as a solution with `K` stages on the same mesh: `weights` are the cardinal
    /// polynomials at the stages.
    pub fn resample<const K: usize>(&self, weights: &[[f64; M]; K], out: &mut Solution<N, K>) {
        out.mesh.clone_from(&self.mesh);
        out.nodes.clone_from(&self.nodes);
        out.slopes.clear();
        out.slopes.extend(self.slopes.iter().map(|own| {
            let mut slopes = [[0.0; N]; K];
            for (slope, l) in slopes.iter_mut().zip(weights) {
                for m in 0..M {
                    for a in 0..N {
                        slope[a] += l[m] * own[m][a];
                    }
                }
            }
            slopes
        }));
    }
}

/// The stages of a group of elements after they are eliminated.
#[derive(Debug, Clone, Copy)]
struct Stages<const N: usize, const M: usize> {
    /// d (stage slopes) / d z_i.
    response: [Block<N, Lanes>; M],
    /// Stage slopes due to the residual (0) and to the parameter (1).
    load: [[[Lanes; N]; M]; 2],
}

/// Transition of an element, `dz_{i+1} = g dz_i + affine[0] + affine[1] dlambda`.
#[derive(Debug, Clone, Copy)]
struct Transition<const N: usize> {
    by_state: Block<N>,
    affine: [[f64; N]; 2],
}

/// The right conditions carried to a node, reduced: `z[pivot[r]] + sum_free rows[r][free] z[free] = load[r]`.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_field_names, reason = "the rows are what the struct is named for")]
struct Rows<const N: usize> {
    rows: Block<N>,
    load: [[f64; 2]; N],
    pivot: [usize; N],
    /// Reduced = `undo`^-1 times carried; kept for the adjoint.
    reduction: Block<N>,
}

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

/// A Newton correction, or a tangent.
#[derive(Debug, Clone)]
pub struct Correction<const N: usize, const M: usize, const Q: usize> {
    /// At the nodes.
    pub nodes: Vec<[f64; N]>,
    /// At the stages, of the slopes.
    pub slopes: Vec<[[f64; N]; M]>,
    /// Of the quadratures over each element.
    pub by_element: Vec<[f64; Q]>,
    /// Of the quadratures over [0, 1].
    pub total: [f64; Q],
}

impl<const N: usize, const M: usize, const Q: usize> Default for Correction<N, M, Q> {
    fn default() -> Self {
        Self { nodes: Vec::new(), slopes: Vec::new(), by_element: Vec::new(), total: [0.0; Q] }
    }
}

impl<const N: usize, const M: usize, const Q: usize> Correction<N, M, Q> {
    /// Multiplies it by `factor`.
    pub fn scale(&mut self, factor: f64) {
        self.for_each(&Self::default(), |own, _| *own *= factor);
    }

    /// Adds `factor` times another correction on the same mesh.
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.for_each(other, |own, other| *own += factor * other);
    }

    /// Every number with its counterpart, zero where there is none.
    fn for_each(&mut self, other: &Self, mut change: impl FnMut(&mut f64, f64)) {
        let z = [0.0; N];
        for (i, own) in self.nodes.iter_mut().enumerate() {
            let other = other.nodes.get(i).unwrap_or(&z);
            own.iter_mut().zip(other).for_each(|(own, other)| change(own, *other));
        }
        for (i, own) in self.slopes.iter_mut().flatten().enumerate() {
            let other = other.slopes.as_flattened().get(i).unwrap_or(&z);
            own.iter_mut().zip(other).for_each(|(own, other)| change(own, *other));
        }
        for (i, own) in self.by_element.iter_mut().enumerate() {
            let other = other.by_element.get(i).unwrap_or(&[0.0; Q]);
            own.iter_mut().zip(other).for_each(|(own, other)| change(own, *other));
        }
        for (own, other) in self.total.iter_mut().zip(&other.total) {
            change(own, *other);
        }
    }

    /// Largest change of component `a` at the nodes.
    pub fn largest(&self, a: usize) -> f64 {
        self.nodes.iter().fold(0.0, |m, z| if z[a].is_nan() { f64::NAN } else { f64::max(m, z[a].abs()) })
    }
}

/// The sign and size of the determinant of the shooting matrix: of the conditions at s = 1 by the
/// states that the conditions at s = 0 leave free. It does not depend on the mesh, changes sign
/// where two solutions meet or cross, and is what tells branches apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Determinant {
    /// -1, 0 or 1.
    pub sign: f64,
    /// Natural logarithm of the size.
    pub log: f64,
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
    rows: Vec<Rows<N>>,
    right_count: usize,
    determinant: Determinant,
    /// Inverse of the left conditions joined with the rows at node 0.
    start: Block<N>,
    left_load: [[f64; 2]; N],
    adjoint: Adjoint<N>,
}

/// Gradients of one total, kept for their memory.
#[derive(Debug, Clone, Default)]
#[allow(clippy::struct_field_names, reason = "what the gradients are by")]
struct Adjoint<const N: usize> {
    /// By the affine part of each element.
    by_affine: Vec<[f64; N]>,
    /// By the loads of the rows of each node.
    by_rows: Vec<[f64; N]>,
    /// By the state at each node.
    by_node: Vec<[f64; N]>,
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
        let blank = Rows { rows: [[0.0; N]; N], load: [[0.0; 2]; N], pivot: [0; N], reduction: [[0.0; N]; N] };
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
        let left_count = N - self.right_count;
        out.nodes.resize(n + 1, [0.0; N]);
        out.slopes.resize(n, [[0.0; N]; M]);
        out.by_element.resize(n, [0.0; Q]);
        let mut load = [0.0; N];
        for r in 0..N {
            load[r] =
                if r < left_count { self.left_load[r][column] } else { self.rows[0].load[r - left_count][column] };
        }
        out.nodes[0] = apply(&self.start, &load);
        out.total = [0.0; Q];
        for i in 0..n {
            let element = &self.transitions[i];
            let mut next = apply(&element.by_state, &out.nodes[i]);
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
            out.nodes[i + 1] = next;
        }
        let groups = self.groups;
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

    /// What each element's residual contributes to the Newton correction of the totals, as the sum
    /// over the `Q` totals of absolute values: the adjoint of [`Collocation::solve`]. To it comes
    /// the change of each element's own quadratures against `before`.
    #[inline(always)]
    pub fn contributions(&mut self, before: &[[f64; Q]], out: &mut Vec<f64>) {
        let groups = self.groups;
        let n = groups.elements;
        out.clear();
        out.resize(n, 0.0);
        let nr = self.right_count;
        let nl = N - nr;
        let Adjoint { by_affine, by_rows, by_node } = &mut self.adjoint;
        for q in 0..Q {
            for (v, length) in [(&mut *by_affine, n), (&mut *by_rows, n + 1), (&mut *by_node, n + 1)] {
                v.clear();
                v.resize(length, [0.0; N]);
            }
            for g in 0..groups.count() {
                let (stages, h) = (&self.stages[g], self.steps[g]);
                let mut own = Lanes::of(0.0);
                let mut by_z = [Lanes::of(0.0); N];
                let mut by_slopes = [[Lanes::of(0.0); N]; M];
                for j in 0..M {
                    let weight = h * Lanes::of(self.gauss.b[j]);
                    let local = &self.locals[g * M + j];
                    own += weight * local.rate[q];
                    let mut gradient = local.rate_gradient[q];
                    for a in 0..N {
                        gradient[a] = gradient[a] * weight;
                        by_z[a] += gradient[a];
                    }
                    for l in 0..M {
                        let w = h * Lanes::of(self.gauss.a[j][l]);
                        for a in 0..N {
                            by_slopes[l][a] += w * gradient[a];
                        }
                    }
                }
                for l in 0..M {
                    for a in 0..N {
                        own += by_slopes[l][a] * stages.load[0][l][a];
                        for c in 0..N {
                            by_z[c] += by_slopes[l][a] * stages.response[l][a][c];
                        }
                    }
                }
                for lane in 0..groups.filled(g) {
                    let i = g * LANES + lane;
                    by_node[i] = by_z.map(|v| v.0[lane]);
                    out[i] += (own.0[lane] - before[i][q]).abs();
                }
            }
            for i in (0..n).rev() {
                let rows = &self.rows[i + 1];
                // What the carried rows decide does not come through the transition.
                let given = by_node[i + 1];
                let mut bar = given;
                for r in 0..nr {
                    let decided = given[rows.pivot[r]];
                    by_rows[i + 1][r] += decided;
                    for c in 0..N {
                        bar[c] -= rows.rows[r][c] * decided;
                    }
                }
                for r in 0..nr {
                    bar[rows.pivot[r]] = 0.0;
                }
                for a in 0..N {
                    by_affine[i][a] += bar[a];
                    for c in 0..N {
                        by_node[i][c] += self.transitions[i].by_state[a][c] * bar[a];
                    }
                }
            }
            for r in 0..nr {
                for a in 0..N {
                    by_rows[0][r] += self.start[a][nl + r] * by_node[0][a];
                }
            }
            for i in 0..n {
                let mut carried = [0.0; N];
                for r in 0..nr {
                    for c in 0..N {
                        carried[c] += self.rows[i].reduction[r][c] * by_rows[i][r];
                    }
                }
                for r in 0..nr {
                    by_rows[i + 1][r] += carried[r];
                    for a in 0..N {
                        by_affine[i][a] -= self.rows[i + 1].rows[r][a] * carried[r];
                    }
                }
                let mut total = 0.0;
                for a in 0..N {
                    total += by_affine[i][a] * self.transitions[i].affine[0][a];
                }
                out[i] += total.abs();
            }
        }
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

/// Eliminates the stages of one element: on return `response` and `load` hold the stage slopes they
/// lead to. Of `load`, the columns are the right sides given; `response` is written only.
#[inline(always)]
pub(crate) fn eliminate<const N: usize, const M: usize, const Q: usize>(
    h: f64,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q>],
    response: &mut [Block<N>; M],
    load: &mut [[[f64; N]; M]],
) -> bool {
    let mut m = [[[[0.0; N]; N]; M]; M];
    let invert = |block: &mut Block<N>| match inverse(block, 1e-10) {
        Some(inverse) => {
            *block = inverse;
            true
        }
        None => false,
    };
    eliminate_by::<f64, false, N, M, Q>(invert, h, gauss, locals, &mut m, response, load)
}

/// [`eliminate`] for four elements, without exchanges; one, or zero where that is not fine.
#[inline(always)]
fn eliminate_in_order<const FUSED: bool, const N: usize, const M: usize, const Q: usize>(
    h: Lanes,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q, Lanes>],
    m: &mut [[Block<N, Lanes>; M]; M],
    response: &mut [Block<N, Lanes>; M],
    load: &mut [[[Lanes; N]; M]],
) -> Lanes {
    let mut fine = Lanes::of(1.0);
    eliminate_by::<Lanes, FUSED, N, M, Q>(
        #[inline(always)]
        |block: &mut Block<N, Lanes>| {
            fine = fine.min(invert_in_order::<FUSED, N, Lanes>(block));
            true
        },
        h,
        gauss,
        locals,
        m,
        response,
        load,
    );
    fine
}

/// [`eliminate`] for one of four elements, whose loads are `given`.
#[cold]
#[inline(never)]
fn eliminate_lane<const N: usize, const M: usize, const Q: usize, const C: usize>(
    lane: usize,
    h: Lanes,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q, Lanes>],
    given: &[[[Lanes; N]; M]; C],
    out: &mut Stages<N, M>,
) -> bool {
    let own: [Local<N, Q>; M] = std::array::from_fn(|j| locals[j].lane(lane));
    let mut load = given.map(|column| column.map(|stage| stage.map(|v| v.0[lane])));
    let mut response = [[[0.0; N]; N]; M];
    let done = eliminate(h.0[lane], gauss, &own, &mut response, &mut load);
    for j in 0..M {
        for a in 0..N {
            for b in 0..N {
                out.response[j][a][b].0[lane] = response[j][a][b];
            }
            for column in 0..C {
                out.load[column][j][a].0[lane] = load[column][j][a];
            }
        }
    }
    done
}

/// The elimination, given how a block is inverted in place. `m` is memory.
#[inline(always)]
fn eliminate_by<R: Real, const FUSED: bool, const N: usize, const M: usize, const Q: usize>(
    mut invert: impl FnMut(&mut Block<N, R>) -> bool,
    h: R,
    gauss: &Gauss<M>,
    locals: &[Local<N, Q, R>],
    m: &mut [[Block<N, R>; M]; M],
    response: &mut [Block<N, R>; M],
    load: &mut [[[R; N]; M]],
) -> bool {
    // Block row j of the equations is 1 - h J_j a_j., so all of the first row's blocks are multiples
    // of J_0, and one product J_i R_0 a row serves the whole first step.
    let one = R::of(1.0);
    let ha = |j: usize, l: usize| h * R::of(gauss.a[j][l]);
    let locals = &locals[..M];
    let inv = &mut m[0][0];
    set_scaled(inv, -ha(0, 0), &locals[0].jacobian);
    for a in 0..N {
        inv[a][a] += one;
    }
    if !invert(inv) {
        return false;
    }
    let (lead, rest) = response.split_at_mut(1);
    let lead = &mut lead[0];
    *lead = locals[0].jacobian;
    multiply::<FUSED, N, R>(lead, &m[0][0]);
    for column in load.iter_mut() {
        column[0] = apply(&m[0][0], &column[0]);
    }
    for l in 1..M {
        set_scaled(&mut m[0][l], -ha(0, l), lead);
    }
    for i in 1..M {
        let own = &locals[i].jacobian;
        let f = ha(i, 0);
        let mut next = *lead;
        multiply::<FUSED, N, R>(&mut next, own);
        for l in 1..M {
            let block = &mut m[i][l];
            let (by_own, by_next) = (-ha(i, l), -f * ha(0, l));
            for a in 0..N {
                for c in 0..N {
                    block[a][c] = (by_own * own[a][c]).plus::<FUSED>(by_next, next[a][c]);
                }
            }
        }
        for a in 0..N {
            m[i][i][a][a] += one;
        }
        for a in 0..N {
            for c in 0..N {
                rest[i - 1][a][c] = own[a][c].plus::<FUSED>(f, next[a][c]);
            }
        }
        for column in load.iter_mut() {
            let lead = apply(own, &column[0]);
            for a in 0..N {
                column[i][a] = column[i][a].plus::<FUSED>(f, lead[a]);
            }
        }
    }
    for j in 1..M {
        let (upper, lower) = m.split_at_mut(j + 1);
        let (inv, row) = upper[j].split_at_mut(j + 1);
        let inv = &mut inv[j];
        if !invert(inv) {
            return false;
        }
        for block in row.iter_mut() {
            multiply::<FUSED, N, R>(block, inv);
        }
        let (own, others) = response.split_at_mut(j + 1);
        let own = &mut own[j];
        multiply::<FUSED, N, R>(own, inv);
        for column in load.iter_mut() {
            column[j] = apply(inv, &column[j]);
        }
        for i in j + 1..M {
            let (f, blocks) = lower[i - j - 1].split_at_mut(j + 1);
            let f = &f[j];
            for (block, of) in blocks.iter_mut().zip(row.iter()) {
                subtract_product::<FUSED, N, R>(block, f, of);
            }
            subtract_product::<FUSED, N, R>(&mut others[i - j - 1], f, own);
            for column in load.iter_mut() {
                let lead = column[j];
                subtract_applied::<FUSED, N, R>(&mut column[i], f, &lead);
            }
        }
    }
    for j in (0..M).rev() {
        let (own, others) = response.split_at_mut(j + 1);
        for l in j + 1..M {
            subtract_product::<FUSED, N, R>(&mut own[j], &m[j][l], &others[l - j - 1]);
            for column in load.iter_mut() {
                let other = column[l];
                subtract_applied::<FUSED, N, R>(&mut column[j], &m[j][l], &other);
            }
        }
    }
    true
}

/// `out = f m` for one number `f`.
#[inline(always)]
fn set_scaled<const N: usize, R: Real>(out: &mut Block<N, R>, f: R, m: &Block<N, R>) {
    for a in 0..N {
        for c in 0..N {
            out[a][c] = f * m[a][c];
        }
    }
}

/// A product of many factors that neither overflows nor takes a logarithm a factor.
#[derive(Debug, Clone, Copy)]
struct Product {
    sign: f64,
    log: f64,
    rest: f64,
}

impl Product {
    fn new() -> Self {
        Self { sign: 1.0, log: 0.0, rest: 1.0 }
    }

    #[inline(always)]
    fn times(&mut self, factor: f64) {
        if factor < 0.0 {
            self.sign = -self.sign;
        }
        let next = self.rest * factor.abs();
        if (1e-100..1e100).contains(&next) {
            self.rest = next;
        } else {
            self.spill(factor.abs());
        }
    }

    /// Takes logarithms before the product leaves the range of numbers.
    #[cold]
    #[inline(never)]
    fn spill(&mut self, factor: f64) {
        if factor == 0.0 {
            self.sign = 0.0;
        }
        self.log += self.rest.ln() + factor.ln();
        self.rest = 1.0;
    }

    fn whole(self) -> Determinant {
        Determinant { sign: self.sign, log: self.log + self.rest.ln() }
    }
}

impl<const N: usize> Rows<N> {
    /// Takes the first `count` rows of the `next` node through the transition that leads there.
    #[inline(always)]
    fn carry<const FUSED: bool>(&mut self, next: &Self, transition: &Transition<N>, count: usize) {
        for r in 0..count {
            let row = &next.rows[r];
            let mut own = [0.0; N];
            let mut load = next.load[r];
            for b in 0..N {
                for c in 0..N {
                    own[c] = own[c].plus::<FUSED>(row[b], transition.by_state[b][c]);
                }
                load[0] -= row[b] * transition.affine[0][b];
                load[1] -= row[b] * transition.affine[1][b];
            }
            self.rows[r] = own;
            self.load[r] = load;
        }
    }
}

/// The largest free entry that reduced rows may have on pivots that were not searched for.
const LARGEST_FREE: f64 = 8.0;

/// Reduces carried rows to the identity on their pivots; false, with the rows spoilt, when one is small or a free
/// entry comes out large.
#[inline(always)]
fn reduce_on<const FUSED: bool, const N: usize>(c: &mut Rows<N>, count: usize, determinant: &mut Product) -> bool {
    let mut product = *determinant;
    for r in 0..N {
        c.reduction[r] = [0.0; N];
        c.reduction[r][r] = 1.0;
    }
    for r in 0..count {
        let column = c.pivot[r];
        let pivot = c.rows[r][column];
        let mut largest = 0.0_f64;
        for v in c.rows[r] {
            largest = largest.max(v.abs());
        }
        // The negation also catches NaN.
        #[allow(clippy::neg_cmp_op_on_partial_ord)]
        if !(pivot.abs() * LARGEST_FREE > largest) {
            return false;
        }
        product.times(pivot);
        eliminate_column::<FUSED, N>(c, count, r, column, 1.0 / pivot);
    }
    let mut fine = true;
    for r in 0..count {
        for v in c.rows[r] {
            fine &= v.abs() <= LARGEST_FREE;
        }
    }
    if fine {
        *determinant = product;
    }
    fine
}

/// Scales row `r` to one in `column` and clears that column in the other rows.
#[inline(always)]
fn eliminate_column<const FUSED: bool, const N: usize>(
    c: &mut Rows<N>,
    count: usize,
    r: usize,
    column: usize,
    scale: f64,
) {
    let (mut own, mut load, mut reduction) = (c.rows[r], c.load[r], c.reduction[r]);
    for k in 0..N {
        own[k] *= scale;
        reduction[k] *= scale;
    }
    load[0] *= scale;
    load[1] *= scale;
    own[column] = 1.0;
    for i in 0..count {
        if i != r {
            let f = c.rows[i][column];
            for k in 0..N {
                c.rows[i][k] = c.rows[i][k].plus::<FUSED>(-f, own[k]);
                c.reduction[i][k] = c.reduction[i][k].plus::<FUSED>(-f, reduction[k]);
            }
            c.load[i][0] -= f * load[0];
            c.load[i][1] -= f * load[1];
            c.rows[i][column] = 0.0;
        }
    }
    (c.rows[r], c.load[r], c.reduction[r]) = (own, load, reduction);
}

/// Reduces on pivots of its own with a search for the largest entry of the remaining rows at every pivot, so that no
/// column is divided by something small; false where the rows are singular.
#[cold]
#[inline(never)]
fn reduce_on_largest<const N: usize>(c: &mut Rows<N>, count: usize, determinant: &mut Product) -> bool {
    for r in 0..N {
        c.reduction[r] = [0.0; N];
        c.reduction[r][r] = 1.0;
    }
    for r in 0..count {
        let (mut row, mut column, mut largest) = (r, 0, 0.0);
        for i in r..count {
            for col in 0..N {
                if c.rows[i][col].abs() > largest {
                    (row, column, largest) = (i, col, c.rows[i][col].abs());
                }
            }
        }
        if largest == 0.0 || !largest.is_finite() {
            return false;
        }
        if row != r {
            c.rows.swap(row, r);
            c.load.swap(row, r);
            c.reduction.swap(row, r);
            determinant.sign = -determinant.sign;
        }
        c.pivot[r] = column;
        let pivot = c.rows[r][column];
        determinant.times(pivot);
        eliminate_column::<false, N>(c, count, r, column, 1.0 / pivot);
    }
    true
}

/// Multiplies by the determinant of a matrix.
#[inline(always)]
fn multiply_by_determinant<const N: usize>(mut m: Block<N>, product: &mut Product) {
    for k in 0..N {
        let mut best = k;
        for i in k + 1..N {
            if m[i][k].abs() > m[best][k].abs() {
                best = i;
            }
        }
        if best != k {
            m.swap(best, k);
            product.sign = -product.sign;
        }
        product.times(m[k][k]);
        if m[k][k] == 0.0 {
            return;
        }
        for i in k + 1..N {
            let f = m[i][k] / m[k][k];
            for c in k..N {
                m[i][c] -= f * m[k][c];
            }
        }
    }
}

impl<const N: usize, const M: usize> Solution<N, M> {
    /// Adds `factor` times a correction.
    #[inline(always)]
    pub fn add<const Q: usize>(&mut self, correction: &Correction<N, M, Q>, factor: f64) {
        for (z, dz) in self.nodes.iter_mut().zip(&correction.nodes) {
            for a in 0..N {
                z[a] += factor * dz[a];
            }
        }
        for (k, dk) in self.slopes.iter_mut().zip(&correction.slopes) {
            for j in 0..M {
                for a in 0..N {
                    k[j][a] += factor * dk[j][a];
                }
            }
        }
    }
}
