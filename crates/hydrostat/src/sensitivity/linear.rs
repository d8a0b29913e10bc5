//! The collocation equations differentiated at a converged solution, beta' and beta'' included, and factorised.
//!
//! In an element the unknown changes are those of the stage slopes k and of beta' at the stages, given that of the state at
//! its left node. beta'' follows beta and beta' by the formula that the rounds use ([`Rule`]), so that nothing lags here: what is
//! solved is the derivative of the discrete solution itself.
//!
//! ```text
//! b = inner dz + (closed, value) drift      dz_j = dz_i + h sum a_jl k_l
//! (1 - h J a) k = J dz_i + drift            J = F_z + F_b inner
//! ```
//!
//! An output is a row of weights on all of that. Forward, a parameter's column is solved for and the weights applied to it;
//! adjoint, the transposed systems turn the weights into some on the drifts, which serve all parameters.

use hydrostat_bvp::{Condition, Gauss, Problem};

use super::band::Band;
use super::carry::Carry;
use super::element::{Element, SLOPES};
use crate::beta_along::{BetaAlong, Rule};
use crate::dispatch::widest;
use crate::engine::{Engine, M};
use crate::equilibrium::{BY, Equations, N, OUT, RATE, Spot, VALUE};

/// How the closed-form quantities of every station follow a parameter at a fixed state and beta', with the conditions.
#[derive(Debug, Clone, Default)]
pub(super) struct Drift {
    /// Station by station; empty where none of them follows.
    pub(super) stations: Vec<[f64; OUT]>,
    /// d |tau| of every cable at every station.
    pub(super) stretch: Vec<f64>,
    /// What the conditions at either end ask for.
    pub(super) left: f64,
    pub(super) right: [f64; N - 1],
}

/// Weights at a stage: on z, on beta', on the drift, and on the |tau| of a cable.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StageWeights {
    pub(super) z: [f64; N],
    pub(super) beta_slope: f64,
    pub(super) direct: [f64; OUT],
    pub(super) stretch: f64,
}

/// A linear functional of the change of the solution.
#[derive(Debug, Clone, Default)]
pub(super) struct Functional {
    nodes: Vec<(usize, [f64; N])>,
    /// The first element with weights at its stages, and those.
    first: usize,
    stages: Vec<[StageWeights; M]>,
    /// The cable whose |tau| counts.
    cable: usize,
}

/// What an adjoint solve leaves: weights on drifts.
#[derive(Debug, Clone)]
pub(super) struct Cotangent {
    stations: Vec<[f64; OUT]>,
    left: f64,
    right: [f64; N - 1],
}

/// The derivative of the equations at a solution, factorised.
pub(super) struct Linear {
    gauss: Gauss<M>,
    elements: Vec<Element>,
    /// d |tau| by state and beta', of every cable at every station.
    stretch: Vec<[f64; BY]>,
    cables: usize,
    band: Band,
    carry: Option<Carry>,
}

/// The change of the solution with a parameter.
pub(super) struct Response {
    nodes: Vec<f64>,
    /// State and beta' at every stage.
    stages: Vec<[[f64; BY]; M]>,
}

impl Linear {
    /// Of what the engine has settled on and evaluated, `spots` being the stations. `None` where it is singular.
    pub(super) fn new(engine: &Engine, spots: &[Spot]) -> Option<Self> {
        let (equations, mesh) = (&engine.equations, &engine.solution.mesh);
        let gauss = engine.system.gauss.clone();
        let cables = equations.arm().cables.len();
        let n = mesh.elements();
        let mut stretch = Vec::with_capacity(n * M * cables);
        let stations = equations.by_state(spots, &mut stretch);
        let elements: Option<Vec<Element>> = widest(
            #[inline(always)]
            || {
                let stations = stations.as_chunks::<M>().0.iter().enumerate();
                stations.map(|(i, own)| Element::new(&gauss, mesh.step(i), own, equations.rule(i))).collect()
            },
        );
        let elements = elements?;
        let transitions: Vec<_> = elements.iter().map(|e| e.transition(&gauss)).collect();
        let mut left = [Condition::default(); N];
        let mut right = [Condition::default(); N];
        equations.left(&engine.solution.nodes[0], &mut left);
        equations.right(&engine.solution.nodes[n], &mut right);
        let band = Band::new(&transitions, &left[0].gradient, &[0, 1, 2].map(|r| right[r].gradient))?;
        let mut this = Self { gauss, elements, stretch, cables, band, carry: None };
        if (0..n).any(|i| equations.beta.carried(i).is_some()) {
            this.carry = Some(Carry::new(&this, &equations.beta, n)?);
        }
        Some(this)
    }

    /// The change of the solution with a parameter.
    pub(super) fn response(&self, drift: &Drift) -> Response {
        let response = self.response_given(drift, &[]);
        match &self.carry {
            None => response,
            Some(carry) => self.response_given(drift, &carry.known(self, &response, drift)),
        }
    }

    /// The change of the solution with a parameter, given that of the beta that elements take over, none where there are no numbers.
    pub(super) fn response_given(&self, drift: &Drift, known: &[f64]) -> Response {
        let n = self.elements.len();
        let mut nodes = vec![0.0; N * (n + 1)];
        nodes[0] = drift.left;
        nodes[1 + N * n..].copy_from_slice(&drift.right);
        let drifts = drift.stations.as_chunks::<M>().0;
        let given = if drifts.is_empty() && known.is_empty() { 0 } else { n };
        let own: Vec<_> =
            self.elements[..given].iter().enumerate().map(|(i, e)| e.own(drifts.get(i), known.get(i))).collect();
        for (i, (element, (_, slopes))) in self.elements.iter().zip(&own).enumerate() {
            for (l, weight) in self.gauss.b.iter().enumerate() {
                for a in 0..N {
                    nodes[1 + N * i + a] += element.h * weight * slopes[l * N + a];
                }
            }
        }
        self.band.solve(&mut nodes);
        let zero = ([0.0; M], [0.0; SLOPES]);
        let stages = self.elements.iter().enumerate().map(|(i, element)| {
            let z: [f64; N] = std::array::from_fn(|a| nodes[N * i + a]);
            element.stages(&self.gauss, &z, own.get(i).unwrap_or(&zero))
        });
        let stages = stages.collect();
        Response { nodes, stages }
    }

    /// What a functional makes of a response to the same drift.
    pub(super) fn apply(&self, functional: &Functional, response: &Response, drift: &Drift) -> f64 {
        let at_nodes = functional.nodes.iter().map(|(i, weights)| dot(weights, &response.nodes[N * i..N * (i + 1)]));
        let mut sum: f64 = at_nodes.sum();
        for (i, weights) in (functional.first..).zip(&functional.stages) {
            for (j, w) in weights.iter().enumerate() {
                let (z, b) = response.stages[i][j].split_at(N);
                sum += dot(&w.z, z) + w.beta_slope * b[0];
                if !drift.stations.is_empty() {
                    sum += dot(&w.direct, &drift.stations[i * M + j]);
                }
                if w.stretch != 0.0 && !drift.stretch.is_empty() {
                    sum += w.stretch * drift.stretch[(i * M + j) * self.cables + functional.cable];
                }
            }
        }
        sum
    }

    /// The weights on drifts that a functional comes to.
    pub(super) fn adjoint(&self, functional: &Functional) -> Cotangent {
        match &self.carry {
            None => self.adjoint_given(functional),
            Some(carry) => self.adjoint_given(&carry.with_known(self, functional)),
        }
    }

    fn adjoint_given(&self, functional: &Functional) -> Cotangent {
        let n = self.elements.len();
        let mut nodes = vec![0.0; N * (n + 1)];
        for (i, weights) in &functional.nodes {
            for a in 0..N {
                nodes[N * i + a] += weights[a];
            }
        }
        let blank = [StageWeights::default(); M];
        let of = |i: usize| i.checked_sub(functional.first).and_then(|k| functional.stages.get(k)).unwrap_or(&blank);
        let mut by_slopes = vec![[0.0; SLOPES]; n];
        for (i, element) in self.elements.iter().enumerate() {
            let (by_node, slopes) = element.back(&self.gauss, of(i));
            for a in 0..N {
                nodes[N * i + a] += by_node[a];
            }
            by_slopes[i] = slopes;
        }
        self.band.solve_transposed(&mut nodes);
        let mut stations = vec![[0.0; OUT]; n * M];
        for (i, element) in self.elements.iter().enumerate() {
            let row = &nodes[1 + N * i..];
            for (l, weight) in self.gauss.b.iter().enumerate() {
                for a in 0..N {
                    by_slopes[i][l * N + a] += element.h * weight * row[a];
                }
            }
            let out = &mut stations[i * M..(i + 1) * M];
            element.cotangent(of(i), &by_slopes[i], out);
        }
        let right = std::array::from_fn(|r| nodes[1 + N * n + r]);
        Cotangent { stations, left: nodes[0], right }
    }

    /// What weights and a functional's own make of a drift.
    pub(super) fn along(&self, functional: &Functional, cotangent: &Cotangent, drift: &Drift) -> f64 {
        let mut sum = cotangent.left * drift.left + dot(&cotangent.right, &drift.right);
        for (weights, own) in cotangent.stations.iter().zip(&drift.stations) {
            sum += dot(weights, own);
        }
        if !drift.stretch.is_empty() {
            for (i, weights) in (functional.first..).zip(&functional.stages) {
                for (j, w) in weights.iter().enumerate() {
                    sum += w.stretch * drift.stretch[(i * M + j) * self.cables + functional.cable];
                }
            }
        }
        sum
    }

    /// Component `a` of the state at node `i`.
    pub(super) fn state(i: usize, a: usize) -> Functional {
        let mut weights = [0.0; N];
        weights[a] = 1.0;
        Functional { nodes: vec![(i, weights)], ..Functional::default() }
    }

    /// x (0) or y (1) over L at node `i`.
    pub(super) fn position(&self, i: usize, q: usize) -> Functional {
        let stages = self.elements[..i].iter().map(|element| {
            std::array::from_fn(|j| {
                let weight = element.h * self.gauss.b[j];
                let mut out = StageWeights::default();
                out.add(weight, &element.rate[j][q]);
                out.direct[RATE + q] = weight;
                out
            })
        });
        Functional { stages: stages.collect(), ..Functional::default() }
    }

    /// The length of cable `c` over L, times `factor`.
    pub(super) fn length(&self, equations: &Equations, c: usize, factor: f64) -> Functional {
        let end = equations.cable_end(c);
        let stages = self.elements.iter().enumerate().map(|(i, element)| {
            std::array::from_fn(|j| {
                let mut out = StageWeights::default();
                if equations.stations()[i * M + j] < end {
                    out.stretch = factor * element.h * self.gauss.b[j];
                    out.add(out.stretch, &self.stretch[(i * M + j) * self.cables + c]);
                }
                out
            })
        });
        Functional { stages: stages.collect(), cable: c, ..Functional::default() }
    }

    /// beta at an end (left 0, right 1) of element `i`, less that which is carried into it, if one is.
    pub(super) fn beta_at_end(&self, beta: &BetaAlong, i: usize, end: usize) -> Functional {
        let element = &self.elements[i];
        let carried = beta.carried(i).is_some();
        let [by_value, by_slope] = beta.end_weights(end);
        let mut stage = [StageWeights::default(); M];
        for (j, out) in stage.iter_mut().enumerate() {
            if carried {
                out.beta_slope = element.h * if end == 0 { -self.gauss.b[j] } else { self.gauss.b[j] };
            } else {
                out.add(by_value[j], &element.value[j]);
                out.beta_slope += element.h * by_slope[j];
                out.direct[VALUE] = by_value[j];
            }
        }
        Functional { first: i, stages: vec![stage], ..Functional::default() }
    }

    /// Weights on the state at node `node`, and `by_curvature` times beta'' at the end `x` (0 or 1) of element `i`.
    pub(super) fn at_end(
        &self,
        equations: &Equations,
        (node, weights): (usize, [f64; N]),
        (i, x): (usize, usize),
        by_curvature: f64,
    ) -> Functional {
        let element = &self.elements[i];
        let inverse = 1.0 / element.h;
        let mut stage = [StageWeights::default(); M];
        let (on_value, on_slope): ([f64; M], [f64; M]) = match equations.rule(i) {
            Rule::Sharp(..) => {
                let ends = &self.gauss.ends[x].curvature;
                (ends[0].map(|w| w * inverse * inverse), ends[1].map(|w| w * inverse))
            }
            Rule::Plain(d) | Rule::Own(d) | Rule::Carried(_, d) => {
                let ends = self.gauss.cardinals(if x == 0 { 0.0 } else { 1.0 });
                let of = |l: usize| (0..M).map(|j| ends[j] * d[j][l]).sum::<f64>() * inverse;
                ([0.0; M], std::array::from_fn(of))
            }
        };
        for l in 0..M {
            stage[l].add(by_curvature * on_value[l], &element.value[l]);
            stage[l].beta_slope += by_curvature * on_slope[l];
            stage[l].direct[VALUE] = by_curvature * on_value[l];
        }
        Functional { nodes: vec![(node, weights)], first: i, stages: vec![stage], cable: 0 }
    }
}

impl Functional {
    /// The same with weights from the first element on.
    pub(super) fn padded(&self) -> Self {
        let mut stages = vec![[StageWeights::default(); M]; self.first];
        stages.extend_from_slice(&self.stages);
        Self { nodes: self.nodes.clone(), first: 0, stages, cable: self.cable }
    }

    /// Adds `factor` times another one in which no cable counts.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        self.nodes.extend(other.nodes.iter().map(|(i, weights)| (*i, weights.map(|w| factor * w))));
        let past = other.first + other.stages.len();
        if self.stages.len() < past {
            self.stages.resize(past, [StageWeights::default(); M]);
        }
        for (own, other) in self.stages[other.first..].iter_mut().zip(&other.stages) {
            for (own, other) in own.iter_mut().zip(other) {
                for a in 0..N {
                    own.z[a] += factor * other.z[a];
                }
                own.beta_slope += factor * other.beta_slope;
                for (own, other) in own.direct.iter_mut().zip(&other.direct) {
                    *own += factor * other;
                }
            }
        }
    }
}

impl StageWeights {
    /// Adds `weight` times a quantity that these are the derivatives of.
    fn add(&mut self, weight: f64, by: &[f64; BY]) {
        for a in 0..N {
            self.z[a] += weight * by[a];
        }
        self.beta_slope += weight * by[N];
    }
}

#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}
