//! Gauss collocation: linearisation of a problem about a discrete solution, and what is solved with it.
//!
//! [`Collocation::evaluate`] asks the problem for slopes at all stages (`stations`). [`Collocation::factorise`] eliminates the
//! stages of every element (static condensation) and factorises what is left between nodes (`factorise`). One factorisation
//! serves Newton's method ([`Collocation::newton`]), derivatives by parameters and loads ([`Collocation::response`]), both in
//! `correction`, adjoints ([`Collocation::adjoint`], [`Collocation::contributions`]) and the [`Determinant`].

pub(crate) mod adjoint;
mod closing;
mod correction;
mod factorise;
mod stations;

use crate::condense::{Column, Condensed, Map};
use crate::determinant::Determinant;
use crate::directions::{Directions, Side};
use crate::gauss::{Gauss, POINTS};
use crate::groups::Groups;
use crate::mesh::Mesh;
use crate::panels::{AtNodes, Loads, Panels};
use crate::problem::{Inner, Local, StageForcing, Station};
use crate::real::{Lanes, Real};

use self::closing::Closing;

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
pub enum LinearisationError<F> {
    /// The problem has no slopes at this state.
    Slopes(F),
    /// The linear system is singular.
    Singular(Singular),
}

/// What changes the equations beside their residual: at stages and ends in blocks, and of the end conditions.
#[derive(Debug, Clone)]
pub struct Forcing<const N: usize, const Q: usize, const L: usize> {
    /// At the stages; empty where nothing changes.
    pub stages: Vec<StageForcing<N, Q, L>>,
    /// At the ends in blocks: of inner unknowns, and of the closure variable; empty where nothing changes.
    pub ends: Vec<([Lanes; L], Lanes)>,
    /// Of the residuals of the conditions at s = 0.
    pub left: [f64; N],
    /// Of those at s = 1.
    pub right: [f64; N],
}

impl<const N: usize, const Q: usize, const L: usize> Default for Forcing<N, Q, L> {
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

    /// The same, for unknowns of very different sizes: rows and columns of an element are brought to one size before it is
    /// called singular.
    pub fn balanced(mut self) -> Self {
        self.condensed.balances = true;
        self
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

    /// The inner equations at the ends at the last evaluation, in blocks.
    pub fn ends(&self) -> &[Inner<N, L, Lanes>] {
        &self.ends
    }
}
