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
use crate::beta_along::{BetaAlong, Rule};
use crate::compliance::solve_in_place;
use crate::dispatch::widest;
use crate::engine::{Engine, M};
use crate::equilibrium::{BY, ByState, CLOSED, Equations, N, OUT, Q, RATE, Spot, VALUE};

/// Stage slopes of an element.
const SLOPES: usize = N * M;

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
struct StageWeights {
    z: [f64; N],
    beta_slope: f64,
    direct: [f64; OUT],
    stretch: f64,
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

struct Element {
    h: f64,
    /// Derivatives at the stages.
    rate: [[[f64; BY]; Q]; M],
    value: [[f64; BY]; M],
    slope_by_beta: [[f64; N]; M],
    /// beta' at the stages by the states there, and by the drifts of the closed form and of beta.
    inner: [[f64; SLOPES]; M],
    by_closed: [[f64; M]; M],
    by_value: [[f64; M]; M],
    /// The same by the beta that is carried into the element, if one is.
    by_known: [f64; M],
    /// Of the stage equations.
    inverse: [[f64; SLOPES]; SLOPES],
    /// Stage slopes by the state at the left node.
    response: [[f64; N]; SLOPES],
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

impl Element {
    #[inline(always)]
    fn new(gauss: &Gauss<M>, h: f64, stations: &[ByState; M], rule: Rule) -> Option<Self> {
        let row = |j: usize, out: usize| -> [f64; BY] { stations[j].by[out] };
        let value: [[f64; BY]; M] = std::array::from_fn(|j| row(j, VALUE));
        let right = beta_slopes(h, stations, &value, rule)?;
        let part = |from: usize| std::array::from_fn(|j| std::array::from_fn(|l| right[j][from + l]));
        let (by_closed, by_value) = (part(SLOPES), part(SLOPES + M));
        let by_known = std::array::from_fn(|j| right[j][SLOPES + 2 * M]);
        let inner: [[f64; SLOPES]; M] = std::array::from_fn(|j| std::array::from_fn(|c| right[j][c]));
        let mut slope_by_beta = [[0.0; N]; M];
        // J = F_z + F_b inner, by all states of the element.
        let mut jacobian = [[0.0; SLOPES]; SLOPES];
        for j in 0..M {
            for a in 0..N {
                let by = row(j, a);
                slope_by_beta[j][a] = by[N];
                let own = &mut jacobian[N * j + a];
                for c in 0..SLOPES {
                    own[c] = by[N] * inner[j][c];
                }
                for c in 0..N {
                    own[N * j + c] += by[c];
                }
            }
        }
        let mut matrix = [[0.0; SLOPES]; SLOPES];
        let mut right = [[0.0; SLOPES + N]; SLOPES];
        for r in 0..SLOPES {
            matrix[r][r] = 1.0;
            right[r][r] = 1.0;
            for j in 0..M {
                for c in 0..N {
                    let by = jacobian[r][N * j + c];
                    right[r][SLOPES + c] += by;
                    for l in 0..M {
                        matrix[r][N * l + c] -= h * gauss.a[j][l] * by;
                    }
                }
            }
        }
        if !solve_in_place(&mut matrix, &mut right) {
            return None;
        }
        Some(Self {
            h,
            rate: std::array::from_fn(|j| std::array::from_fn(|q| row(j, RATE + q))),
            value,
            slope_by_beta,
            inner,
            by_closed,
            by_value,
            by_known,
            inverse: std::array::from_fn(|r| std::array::from_fn(|c| right[r][c])),
            response: std::array::from_fn(|r| std::array::from_fn(|c| right[r][SLOPES + c])),
        })
    }

    fn transition(&self, gauss: &Gauss<M>) -> [[f64; N]; N] {
        let mut out = [[0.0; N]; N];
        for a in 0..N {
            out[a][a] = 1.0;
            for (l, weight) in gauss.b.iter().enumerate() {
                for c in 0..N {
                    out[a][c] += self.h * weight * self.response[N * l + a][c];
                }
            }
        }
        out
    }

    /// beta' and the stage slopes by a drift, and the beta that is carried into the element, alone.
    fn own(&self, drift: Option<&[[f64; OUT]; M]>, known: Option<&f64>) -> ([f64; M], [f64; SLOPES]) {
        let mut beta = self.by_known.map(|by| by * known.unwrap_or(&0.0));
        if let Some(drift) = drift {
            for j in 0..M {
                for l in 0..M {
                    beta[j] += self.by_closed[j][l] * drift[l][CLOSED] + self.by_value[j][l] * drift[l][VALUE];
                }
            }
        }
        let mut given = [0.0; SLOPES];
        for j in 0..M {
            for a in 0..N {
                given[N * j + a] = drift.map_or(0.0, |drift| drift[j][a]) + self.slope_by_beta[j][a] * beta[j];
            }
        }
        (beta, std::array::from_fn(|r| dot(&self.inverse[r], &given)))
    }

    /// State and beta' at the stages, given the state at the left node and what a drift adds.
    fn stages(&self, gauss: &Gauss<M>, z: &[f64; N], (beta, slopes): &([f64; M], [f64; SLOPES])) -> [[f64; BY]; M] {
        let k: [f64; SLOPES] = std::array::from_fn(|r| slopes[r] + dot(&self.response[r], z));
        let mut states = [0.0; SLOPES];
        for j in 0..M {
            for a in 0..N {
                let inside: f64 = (0..M).map(|l| gauss.a[j][l] * k[N * l + a]).sum();
                states[N * j + a] = z[a] + self.h * inside;
            }
        }
        std::array::from_fn(|j| {
            let mut out = [0.0; BY];
            out[..N].copy_from_slice(&states[N * j..N * (j + 1)]);
            out[N] = beta[j] + dot(&self.inner[j], &states);
            out
        })
    }

    /// Weights at the stages as weights on the state at the left node, and on the stage slopes.
    fn back(&self, gauss: &Gauss<M>, weights: &[StageWeights; M]) -> ([f64; N], [f64; SLOPES]) {
        let mut by_state = [0.0; SLOPES];
        for (j, w) in weights.iter().enumerate() {
            for a in 0..N {
                by_state[N * j + a] += w.z[a];
            }
            for (by, inner) in by_state.iter_mut().zip(&self.inner[j]) {
                *by += w.beta_slope * inner;
            }
        }
        let mut by_slopes = [0.0; SLOPES];
        let mut by_node = [0.0; N];
        for j in 0..M {
            for a in 0..N {
                let by = by_state[N * j + a];
                by_node[a] += by;
                for l in 0..M {
                    by_slopes[N * l + a] += self.h * gauss.a[j][l] * by;
                }
            }
        }
        for (by, response) in by_slopes.iter().zip(&self.response) {
            for a in 0..N {
                by_node[a] += by * response[a];
            }
        }
        (by_node, by_slopes)
    }

    /// Weights on the stage slopes and at the stages as weights on the drifts.
    fn cotangent(&self, weights: &[StageWeights; M], by_slopes: &[f64; SLOPES], out: &mut [[f64; OUT]]) {
        let mut by_given = [0.0; SLOPES];
        for (by, row) in by_slopes.iter().zip(&self.inverse) {
            for (given, inverse) in by_given.iter_mut().zip(row) {
                *given += by * inverse;
            }
        }
        let mut by_beta = [0.0; M];
        for (j, w) in weights.iter().enumerate() {
            out[j] = w.direct;
            by_beta[j] = w.beta_slope;
            for a in 0..N {
                out[j][a] += by_given[N * j + a];
                by_beta[j] += self.slope_by_beta[j][a] * by_given[N * j + a];
            }
        }
        for j in 0..M {
            for l in 0..M {
                out[l][CLOSED] += by_beta[j] * self.by_closed[j][l];
                out[l][VALUE] += by_beta[j] * self.by_value[j][l];
            }
        }
    }
}

/// Columns of beta' at the stages of an element: by the states there, by the drifts of the closed form and of beta, and by the beta that is carried
/// into it. From (1 - ...) b = ... dz + drifts.
#[inline(always)]
fn beta_slopes(
    h: f64,
    stations: &[ByState; M],
    value: &[[f64; BY]; M],
    rule: Rule,
) -> Option<[[f64; SLOPES + 2 * M + 1]; M]> {
    let inverse = 1.0 / h;
    let mut matrix = [[0.0; M]; M];
    let mut right = [[0.0; SLOPES + 2 * M + 1]; M];
    for j in 0..M {
        let reach = stations[j].reach;
        matrix[j][j] = 1.0;
        let mut on_value = [0.0; M];
        match rule {
            Rule::Sharp(by_value, by_slope) => {
                for l in 0..M {
                    on_value[l] = reach * by_value[j][l] * inverse * inverse;
                    matrix[j][l] -= reach * by_slope[j][l] * inverse;
                }
            }
            Rule::Plain(d) => {
                for l in 0..M {
                    matrix[j][l] -= reach * d[j][l] * inverse;
                }
            }
            Rule::Own(d) => {
                for l in 0..M {
                    on_value[l] = d[j][l] * inverse;
                }
            }
            Rule::Carried(by, _) => {
                for l in 0..M {
                    matrix[j][l] = h * by.since_known(j, l);
                }
                on_value[j] = 1.0;
                right[j][SLOPES + 2 * M] = -1.0;
            }
        }
        if !matches!(rule, Rule::Own(_) | Rule::Carried(..)) {
            matrix[j][j] -= stations[j].by[CLOSED][N];
            for a in 0..N {
                right[j][N * j + a] += stations[j].by[CLOSED][a];
            }
            right[j][SLOPES + j] = 1.0;
        }
        for l in 0..M {
            matrix[j][l] -= on_value[l] * value[l][N];
            for a in 0..N {
                right[j][N * l + a] += on_value[l] * value[l][a];
            }
            right[j][SLOPES + M + l] = on_value[l];
        }
    }
    solve_in_place(&mut matrix, &mut right).then_some(right)
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += a * b;
    }
    sum
}
