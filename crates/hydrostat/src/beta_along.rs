//! How the section stretch beta varies along the arm: beta', on which every cable's tangent depends,
//! found by differentiating the section law implicitly (`docs/model.md`, section 8, item 1).
//!
//! Along a solution beta' = d/ds beta(nu(s, z(s), beta'(s))), which the section law gives in closed form
//! but for the beta'' inside it. So beta' at a station has a value `Phi(z, beta', beta'')`, and all that
//! the slopes z' = F(z, beta') need is the linearisation of beta' = Phi together with theirs:
//!
//! ```text
//! Phi_z     = w' + w F_z            w     = d beta / d z      at fixed beta'
//! Phi_beta' = reach' + w F_beta'    reach = d beta / d beta'  at fixed z
//! ```
//!
//! where w' and reach' are differentiated along an element. What is left out is reach times the slope
//! of the change of beta', which is the fast mode that no shape of an arm has.

use hydrostat_bvp::{Gauss, Local};

use crate::equilibrium::{N, Q};

/// Weights that give beta'' at the stages of an element of length one.
#[derive(Debug, Clone)]
struct Differentiation {
    /// From the polynomial through beta and beta' at all stages.
    by_value: Vec<f64>,
    by_slope: Vec<f64>,
    /// From the polynomial through beta'.
    plain: Vec<f64>,
    /// Largest row sum of `by_slope`: how it amplifies what beta' is off by.
    hermite_gain: f64,
}

/// No method here has more stages.
const MOST_STAGES: usize = 6;

impl Differentiation {
    fn new<const M: usize>(gauss: &Gauss<M>) -> Self {
        const { assert!(M <= MOST_STAGES) };
        let flat = |m: &[[f64; M]; M]| m.iter().flatten().copied().collect::<Vec<f64>>();
        let rows = gauss.hermite[1].iter().map(|row| row.iter().map(|v| v.abs()).sum::<f64>());
        Self {
            hermite_gain: rows.fold(0.0, f64::max),
            by_value: flat(&gauss.hermite[0]),
            by_slope: flat(&gauss.hermite[1]),
            plain: flat(&gauss.d),
        }
    }

    /// Slope of the polynomial through `values` on an element of length 1/`inverse`.
    #[inline(always)]
    fn slope_of(&self, values: &[f64], inverse: f64, out: &mut [f64]) {
        let m = values.len();
        for j in 0..m {
            out[j] = (0..m).map(|l| self.plain[j * m + l] * values[l]).sum::<f64>() * inverse;
        }
    }
}

/// Puts the solution of the equations into `slope`, which stays when they are singular.
#[inline(always)]
fn solve_for_slope(matrix: &mut [[f64; MOST_STAGES + 1]; MOST_STAGES], slope: &mut [f64]) {
    let m = slope.len();
    if solve_small(matrix, m) {
        for j in 0..m {
            slope[j] = matrix[j][m];
        }
    }
}

/// Solves `m` equations whose right side is column `m`, by elimination with row pivoting.
#[inline(always)]
fn solve_small(a: &mut [[f64; MOST_STAGES + 1]; MOST_STAGES], m: usize) -> bool {
    for k in 0..m {
        let mut best = k;
        for i in k + 1..m {
            if a[i][k].abs() > a[best][k].abs() {
                best = i;
            }
        }
        if a[best][k].abs() < 1e-12 || !a[best][k].is_finite() {
            return false;
        }
        a.swap(k, best);
        let inverse = 1.0 / a[k][k];
        for i in 0..m {
            if i != k {
                let f = a[i][k] * inverse;
                for c in k..=m {
                    a[i][c] -= f * a[k][c];
                }
            }
        }
    }
    for k in 0..m {
        a[k][m] /= a[k][k];
    }
    true
}

/// How beta and the slopes hang together at a station.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Coupling {
    /// d z' / d beta'.
    pub(crate) slope: [f64; N],
    /// d (x', y') / d beta'.
    pub(crate) rate: [f64; Q],
    /// w = d beta / d z at fixed beta'.
    pub(crate) value: [f64; N],
    /// d beta / d parameter at fixed z and beta'.
    pub(crate) value_drift: f64,
}

/// beta, beta' and beta'' at the stations.
#[derive(Debug, Clone)]
pub(crate) struct BetaAlong {
    weights: Differentiation,
    stages: usize,
    /// beta.
    pub(crate) value: Vec<f64>,
    /// beta'.
    pub(crate) slope: Vec<f64>,
    /// beta'', one Newton round behind.
    pub(crate) curvature: Vec<f64>,
    /// beta' by the closed form.
    pub(crate) closed: Vec<f64>,
    /// d beta' / d beta'' of the closed form, over L: the length on which a fast mode would live.
    pub(crate) reach: Vec<f64>,
    pub(crate) coupling: Vec<Coupling>,
    /// d beta' / d z along with everything else.
    by_state: Vec<[f64; N]>,
    /// Leave beta'' out: for first guesses on meshes that may be too coarse to differentiate on.
    pub(crate) blunt: bool,
}

impl BetaAlong {
    pub(crate) fn new<const M: usize>(gauss: &Gauss<M>) -> Self {
        Self {
            weights: Differentiation::new(gauss),
            stages: M,
            value: Vec::new(),
            slope: Vec::new(),
            curvature: Vec::new(),
            closed: Vec::new(),
            reach: Vec::new(),
            coupling: Vec::new(),
            by_state: Vec::new(),
            blunt: false,
        }
    }

    pub(crate) fn resize(&mut self, count: usize) {
        self.value.resize(count, 1.0);
        self.slope.resize(count, 0.0);
        self.curvature.resize(count, 0.0);
        self.closed.resize(count, 0.0);
        self.reach.resize(count, 0.0);
        self.coupling.resize(count, Coupling::default());
        self.by_state.resize(count, [0.0; N]);
    }

    /// First guesses at station `k`.
    pub(crate) fn start(&mut self, k: usize, slope: f64, curvature: f64) {
        self.slope[k] = slope;
        self.curvature[k] = curvature;
        self.by_state[k] = [0.0; N];
    }

    /// beta' at station `k` after its state has moved.
    #[inline(always)]
    pub(crate) fn follow(&mut self, k: usize, moved: [f64; N]) -> f64 {
        for a in 0..N {
            self.slope[k] += self.by_state[k][a] * moved[a];
        }
        self.slope[k]
    }

    /// Closes the loop: from what the slopes were evaluated with to the next beta' and beta'', and into
    /// slopes, gradients and drifts what beta' adds to them.
    #[inline(always)]
    pub(crate) fn close(&mut self, steps: &[f64], out: &mut [Local<N, Q>], drifts: &mut [[f64; N]]) {
        // Loops of a length that the compiler knows are several times faster.
        match self.stages {
            4 => self.close_on(4, steps, out, drifts),
            5 => self.close_on(5, steps, out, drifts),
            m => self.close_on(m, steps, out, drifts),
        }
    }

    #[inline(always)]
    fn close_on(&mut self, m: usize, steps: &[f64], out: &mut [Local<N, Q>], drifts: &mut [[f64; N]]) {
        for first in (0..steps.len()).step_by(m) {
            let inverse = 1.0 / steps[first];
            let mut before = [0.0; MOST_STAGES];
            before[..m].copy_from_slice(&self.slope[first..first + m]);
            let mut own_part = [0.0; MOST_STAGES];
            for j in 0..m {
                let by = &self.coupling[first + j];
                own_part[j] = dot(&by.value, &by.slope);
            }
            self.next(m, first, inverse, &own_part);
            for j in 0..m {
                let k = first + j;
                let (mut value_slope, mut reach_slope, mut drift) = ([0.0; N], 0.0, 0.0);
                for l in 0..m {
                    let d = self.weights.plain[j * m + l] * inverse;
                    let other = &self.coupling[first + l];
                    for a in 0..N {
                        value_slope[a] += d * other.value[a];
                    }
                    reach_slope += d * self.reach[first + l];
                    drift += d * other.value_drift;
                }
                let by = &self.coupling[k];
                let own = 1.0 - own_part[j] - reach_slope;
                // Far from a shape the linearisation may mean nothing: then beta' only lags.
                let share = if own > 0.3 && !self.blunt { 1.0 / own } else { 0.0 };
                let local = &mut out[k];
                let mut by_state = value_slope;
                for b in 0..N {
                    for a in 0..N {
                        by_state[a] += by.value[b] * local.jacobian[b][a];
                    }
                }
                by_state = by_state.map(|v| share * v);
                let drift = share * (drift + dot(&by.value, &drifts[k]));
                let change = self.slope[k] - before[j];
                for b in 0..N {
                    local.slope[b] += by.slope[b] * change;
                    drifts[k][b] += by.slope[b] * drift;
                    for a in 0..N {
                        local.jacobian[b][a] += by.slope[b] * by_state[a];
                    }
                }
                for q in 0..Q {
                    local.rate[q] += by.rate[q] * change;
                    for a in 0..N {
                        local.rate_gradient[q][a] += by.rate[q] * by_state[a];
                    }
                }
                self.by_state[k] = by_state;
            }
        }
    }

    /// The next beta' and beta'' on the element whose first station is `first`.
    ///
    /// beta'' feeds back into beta' as `reach` beta''. Where a step is long against `reach` the
    /// sharpest formula serves, one round behind. Where it is not, lagging would excite the fast mode
    /// that `docs/model.md`, section 8, item 1 excludes: there beta' and beta'' are solved for together,
    /// and where `reach` is a good part of the step, beta' is the slope of the element's own
    /// polynomial through beta, which has no fast mode, found by Newton along with everything else.
    #[inline(always)]
    fn next(&mut self, m: usize, first: usize, inverse: f64, own_part: &[f64; MOST_STAGES]) {
        let own = first..first + m;
        let w = &self.weights;
        let reach = &self.reach[own.clone()];
        let largest = reach.iter().fold(0.0_f64, |a, r| a.max(r.abs()));
        let closed = &self.closed[own.clone()];
        let beta = &self.value[own.clone()];
        let slope = &mut self.slope[own.clone()];
        let curvature = &mut self.curvature[own];
        let mut matrix = [[0.0; MOST_STAGES + 1]; MOST_STAGES];
        if self.blunt {
            slope.copy_from_slice(closed);
            curvature.fill(0.0);
        } else if largest * inverse * w.hermite_gain < 0.3 {
            for j in 0..m {
                let share = 1.0 - own_part[j];
                slope[j] += (closed[j] - slope[j]) / if share > 0.3 { share } else { 1.0 };
            }
            for j in 0..m {
                let mut sum = 0.0;
                for l in 0..m {
                    sum += w.by_value[j * m + l] * beta[l] * inverse + w.by_slope[j * m + l] * slope[l];
                }
                curvature[j] = sum * inverse;
            }
        } else if largest * inverse < 0.05 {
            // beta' - reach beta'' = rest, with beta'' the slope of the polynomial through beta'.
            for j in 0..m {
                for l in 0..m {
                    matrix[j][l] = -reach[j] * w.plain[j * m + l] * inverse;
                }
                matrix[j][j] += 1.0;
                matrix[j][m] = closed[j] - reach[j] * curvature[j];
            }
            solve_for_slope(&mut matrix, slope);
            w.slope_of(slope, inverse, curvature);
        } else {
            // One Newton step on beta' = D beta(nu(z, beta')) / h: d beta / d beta' is `reach`.
            for j in 0..m {
                for l in 0..m {
                    let d = w.plain[j * m + l] * inverse;
                    matrix[j][l] = -d * reach[l];
                    matrix[j][m] += d * (beta[l] - reach[l] * slope[l]);
                }
                matrix[j][j] += 1.0;
            }
            solve_for_slope(&mut matrix, slope);
            w.slope_of(slope, inverse, curvature);
        }
    }
}

#[inline(always)]
fn dot(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}
