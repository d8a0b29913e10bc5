//! Derivatives of quantities that are linear in the change of a solution and of its equations, forward or adjoint, in
//! the plane and in space.

use hydrostat_bvp::{
    Collocation, Correction, Cotangent, Forcing, Functional, Groups, LANES, Lanes, Side, Solution, StageWeights,
};

use crate::numerics::elimination::solved;
use crate::numerics::rounds::respond;
use crate::rod::parameter::Parameter;

/// Which way derivatives are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum SensitivityMethod {
    /// Whichever takes fewer solves.
    #[default]
    Best,
    /// One solve a parameter.
    Forward,
    /// One solve an output.
    Adjoint,
}

/// Derivatives of quantities, one row each, and of the tensions of all cables.
pub(crate) struct Derivatives {
    pub(crate) rows: Vec<Vec<f64>>,
    pub(crate) tensions: Vec<Vec<f64>>,
}

/// A quantity as weights on the change of the solution and on that of the equations.
pub(crate) struct Row<const N: usize, const Q: usize, const L: usize> {
    pub(crate) functional: Functional<N>,
    /// Weights on the forcings of rates and strains at the stages, in blocks; empty where there are none.
    pub(crate) stages: Vec<([Lanes; Q], [Lanes; L])>,
    /// Weights on the forcings of strains at ends: block, lane.
    pub(crate) ends: Vec<(usize, usize, [f64; L])>,
    /// What follows the sources at a fixed solution, in SI.
    pub(crate) direct: Vec<f64>,
}

impl<const N: usize, const Q: usize, const L: usize> Default for Row<N, Q, L> {
    fn default() -> Self {
        Self { functional: Functional::default(), stages: Vec::new(), ends: Vec::new(), direct: Vec::new() }
    }
}

impl<const N: usize, const Q: usize, const L: usize> Row<N, Q, L> {
    /// Room for weights at so many blocks of stations.
    pub(crate) fn reserve(&mut self, blocks: usize) {
        self.functional.stages.resize(blocks, StageWeights::default());
        self.stages.resize(blocks, ([Lanes::default(); Q], [Lanes::default(); L]));
    }

    /// What the forcings of rates and strains add.
    fn forced(&self, change: &Forcing<N, Q, L>) -> f64 {
        let mut sum = Lanes::default();
        for ((rates, strains), forcing) in self.stages.iter().zip(&change.stages) {
            for q in 0..Q {
                sum += rates[q] * forcing.rate[q];
            }
            for k in 0..L {
                sum += strains[k] * forcing.inner[k];
            }
        }
        let mut out: f64 = sum.0.iter().sum();
        for (block, lane, by) in &self.ends {
            if let Some((inner, _)) = change.ends.get(*block) {
                out += (0..L).map(|k| by[k] * inner[k].0[*lane]).sum::<f64>();
            }
        }
        out
    }

    /// Adds `factor` times coordinate `q` at a node: the integral of its slope.
    pub(crate) fn add_position<const M: usize>(
        &mut self,
        system: &Collocation<N, M, Q, L>,
        groups: Groups,
        [node, q]: [usize; 2],
        factor: f64,
    ) {
        self.reserve(groups.count() * M);
        for (block, local) in system.locals().iter().enumerate() {
            let (g, j) = (block / M, block % M);
            let mut weight = Lanes::default();
            for lane in 0..groups.filled(g) {
                if g * LANES + lane < node {
                    weight.0[lane] = factor * system.steps()[g].0[lane] * system.gauss.b[j];
                }
            }
            let own = &mut self.functional.stages[block];
            for a in 0..N {
                own.state[a] += weight * local.rate_gradient[q][a];
            }
            own.closure_slope += weight * local.rate_by_closure[q];
            self.stages[block].0[q] += weight;
        }
    }
}

/// Derivatives of quantities, one row each, by changes of the equations, with all tensions given. `None` where the
/// system is singular.
pub(crate) fn at_given_tensions<const N: usize, const M: usize, const Q: usize, const L: usize>(
    system: &Collocation<N, M, Q, L>,
    solution: &Solution<N, M, L>,
    rows: &[Row<N, Q, L>],
    changes: &[Forcing<N, Q, L>],
    method: SensitivityMethod,
) -> Option<Vec<Vec<f64>>> {
    let adjoint = match method {
        SensitivityMethod::Forward => false,
        SensitivityMethod::Adjoint => true,
        SensitivityMethod::Best => rows.len() < changes.len(),
    };
    let mut out: Vec<Vec<f64>> = rows.iter().map(|row| row.direct.clone()).collect();
    if adjoint {
        for (row, out) in rows.iter().zip(&mut out) {
            let cotangent = system.adjoint(&row.functional);
            for (out, change) in out.iter_mut().zip(changes) {
                *out += along(&cotangent, change) + row.forced(change);
            }
        }
    } else {
        let mut response = Correction::default();
        for (k, change) in changes.iter().enumerate() {
            respond(system, change, &mut response);
            let states = system.moved_states(&response);
            for (row, out) in rows.iter().zip(&mut out) {
                out[k] += apply(system, solution, &row.functional, &response, &states) + row.forced(change);
            }
        }
    }
    out.iter().flatten().all(|v| v.is_finite()).then_some(out)
}

/// Holds the strokes of the taut cables: given the derivatives of the quantities asked for, and after them those of the
/// strokes of these cables as they are commanded, by the parameters and after them by the tensions of these cables.
pub(crate) fn hold(
    mut rows: Vec<Vec<f64>>,
    asked: usize,
    parameters: &[Parameter],
    taut: &[usize],
    cables: usize,
) -> Option<Derivatives> {
    let count = parameters.len();
    let strokes = rows.split_off(asked);
    let mut tensions = vec![vec![0.0; count]; cables];
    for k in 0..count {
        if let Parameter::Tension(c) = parameters[k] {
            tensions[c][k] = 1.0;
        }
        if taut.is_empty() {
            continue;
        }
        let row = |(stroke, c): (&Vec<f64>, &usize)| {
            let command = f64::from(u8::from(parameters[k] == Parameter::Stroke(*c)));
            (stroke[count..].to_vec(), [command - stroke[k], 0.0])
        };
        let (changes, _) = solved(strokes.iter().zip(taut).map(row).collect())?;
        for (t, (c, [change, _])) in taut.iter().zip(&changes).enumerate() {
            tensions[*c][k] = *change;
            for row in &mut rows {
                row[k] += row[count + t] * change;
            }
        }
    }
    for row in &mut rows {
        row.truncate(count);
    }
    Some(Derivatives { rows, tensions })
}

/// What a functional makes of a response.
fn apply<const N: usize, const M: usize, const Q: usize, const L: usize>(
    system: &Collocation<N, M, Q, L>,
    solution: &Solution<N, M, L>,
    functional: &Functional<N>,
    response: &Correction<N, M, Q, L>,
    states: &[[Lanes; N]],
) -> f64 {
    let mut sum = 0.0;
    for (i, weights) in &functional.nodes {
        sum += (0..N).map(|a| weights[a] * response.nodes[*i][a]).sum::<f64>();
    }
    let groups = solution.groups();
    for (block, weights) in functional.stages.iter().enumerate() {
        let mut own = weights.closure_slope * response.stages[block].closure_slope;
        for a in 0..N {
            own += weights.state[a] * states[block][a];
        }
        sum += own.0[..groups.filled(block / M)].iter().sum::<f64>();
    }
    for end in &functional.ends {
        sum += end.closure_slope * response.ends[end.block].closure_slope.0[end.lane];
        let place = &solution.directions.ends()[end.block];
        let (i, side) = (place.elements[end.lane], place.sides[end.lane]);
        let mut z = response.nodes[i];
        if side == Side::Right {
            let (g, lane) = (i / LANES, i % LANES);
            for l in 0..M {
                for a in 0..N {
                    let slope = response.stages[g * M + l].slope[a].0[lane];
                    z[a] += solution.mesh.step(i) * system.gauss.b[l] * slope;
                }
            }
        }
        sum += (0..N).map(|a| end.state[a] * z[a]).sum::<f64>();
    }
    sum
}

/// What weights on changes of the equations make of one.
fn along<const N: usize, const Q: usize, const L: usize>(weights: &Cotangent<N>, change: &Forcing<N, Q, L>) -> f64 {
    let mut sum = Lanes::default();
    for ((slopes, values), forcing) in weights.slopes.iter().zip(&weights.values).zip(&change.stages) {
        for a in 0..N {
            sum += slopes[a] * forcing.slope[a];
        }
        sum += *values * forcing.value;
    }
    for (weight, (_, value)) in weights.ends.iter().zip(&change.ends) {
        sum += *weight * *value;
    }
    let conditions = weights.left.iter().zip(&change.left).chain(weights.right.iter().zip(&change.right));
    sum.0.iter().sum::<f64>() + conditions.map(|(w, v)| w * v).sum::<f64>()
}
