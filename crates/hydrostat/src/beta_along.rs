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

mod carried;
mod formulas;

use hydrostat_bvp::{Gauss, LANES, Lanes, Local, Real};

pub(crate) use self::carried::{Carried, Side};
pub(crate) use self::formulas::Rule;
use self::formulas::{Differentiation, MOST_STAGES, ONE, Weights, ZERO, each_stage, solve_small};
use crate::equilibrium::{N, Q};

/// `reach` over the step from which on beta' is the slope of the element's own polynomial.
const OWN: f64 = 0.05;

/// `reach` over the step, times how the sharpest formula for beta'' amplifies, up to which that formula serves.
const SHARP: f64 = 0.3;

/// How beta and the slopes hang together at a station.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coupling {
    /// d z' / d beta'.
    pub(crate) slope: [Lanes; N],
    /// d (x', y') / d beta'.
    pub(crate) rate: [Lanes; Q],
    /// w = d beta / d z at fixed beta'.
    pub(crate) value: [Lanes; N],
    /// d beta / d parameter at fixed z and beta'.
    pub(crate) value_drift: Lanes,
}

/// beta, beta' and beta'' at the stations, the same stage of four elements side by side.
#[derive(Debug, Clone)]
pub(crate) struct BetaAlong {
    weights: Differentiation,
    stages: usize,
    /// beta.
    pub(crate) value: Vec<Lanes>,
    /// beta'.
    pub(crate) slope: Vec<Lanes>,
    /// beta'', following the state between rounds where elements are long enough, else one Newton round behind.
    pub(crate) curvature: Vec<Lanes>,
    /// beta' by the closed form.
    pub(crate) closed: Vec<Lanes>,
    /// d beta' / d beta'' of the closed form, over L: the length on which a fast mode would live.
    pub(crate) reach: Vec<Lanes>,
    pub(crate) coupling: Vec<Coupling>,
    /// d beta' / d z along with everything else.
    by_state: Vec<[Lanes; N]>,
    /// Leave beta'' out: for first guesses on meshes that may be too coarse to differentiate on.
    pub(crate) blunt: bool,
    /// Whether nothing was evaluated at these stations yet: beta'' is what was given.
    fresh: bool,
    /// Elements at whose right end beta jumps.
    jumps: Vec<usize>,
    /// beta at both ends of the elements, and where they take theirs over from, as [`BetaAlong::carry`] left it.
    at_ends: Vec<[f64; 2]>,
    sides: Vec<Option<(Side, usize)>>,
    /// Whether [`BetaAlong::close`] met elements that are short against `reach`.
    pub(crate) some_short: bool,
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
            fresh: true,
            jumps: Vec::new(),
            at_ends: Vec::new(),
            sides: Vec::new(),
            some_short: false,
        }
    }

    /// Room for `blocks`, and no derivatives known at any.
    pub(crate) fn resize(&mut self, blocks: usize) {
        self.value.resize(blocks, ONE);
        self.slope.resize(blocks, ZERO);
        self.curvature.resize(blocks, ZERO);
        self.closed.resize(blocks, ZERO);
        self.reach.resize(blocks, ZERO);
        let blank = Coupling { slope: [ZERO; N], rate: [ZERO; Q], value: [ZERO; N], value_drift: ZERO };
        self.coupling.resize(blocks, blank);
        self.by_state.clear();
        self.by_state.resize(blocks, [ZERO; N]);
        self.fresh = true;
    }

    /// First guesses in a lane of a block.
    pub(crate) fn start(&mut self, block: usize, lane: usize, slope: f64, curvature: f64) {
        self.slope[block].0[lane] = slope;
        self.curvature[block].0[lane] = curvature;
    }

    /// Whether an element, `inverse` one over its length, is too short to differentiate sharply on.
    #[inline(always)]
    pub(crate) fn is_short(&self, group: usize, lane: usize, inverse: f64) -> bool {
        self.largest_reach(group, lane) * inverse * self.weights.hermite_gain >= SHARP
    }

    /// Where element `i` takes its beta over from, and which element that is.
    pub(crate) fn carried(&self, i: usize) -> Option<(Side, usize)> {
        self.sides.get(i).copied().flatten()
    }

    /// Weights of beta, and of beta' of an element of length one, at its stages: beta at its left (0) or right (1) end.
    pub(crate) fn end_weights(&self, end: usize) -> &[[f64; MOST_STAGES]; 2] {
        &self.weights.ends[end]
    }

    #[inline(always)]
    fn largest_reach(&self, group: usize, lane: usize) -> f64 {
        let reach = &self.reach[group * self.stages..(group + 1) * self.stages];
        reach.iter().fold(0.0_f64, |most, reach| most.max(reach.0[lane].abs()))
    }

    /// Which formulas hold on an element, `inverse` one over its length.
    pub(crate) fn rule(&self, group: usize, lane: usize, inverse: f64) -> Rule<'_> {
        let weights = &self.weights;
        if let Some((side, _)) = self.carried(group * LANES + lane) {
            return Rule::Carried(Carried { side, whole: &weights.whole, upto: &weights.upto }, &weights.plain);
        }
        if !self.is_short(group, lane, inverse) {
            Rule::Sharp(&weights.by_value, &weights.by_slope)
        } else if self.largest_reach(group, lane) * inverse < OWN {
            Rule::Plain(&weights.plain)
        } else {
            Rule::Own(&weights.plain)
        }
    }

    /// beta'' from beta and beta' as they have been moved to another state, where they were those of a state before and
    /// elements are long enough.
    #[inline(always)]
    pub(crate) fn follow_curvature(&mut self, steps: &[Lanes]) {
        if self.fresh {
            return;
        }
        if self.stages == 4 { self.follow_curvature_on::<4>(steps) } else { self.follow_curvature_on::<5>(steps) }
    }

    #[inline(always)]
    fn follow_curvature_on<const M: usize>(&mut self, steps: &[Lanes]) {
        let groups = steps
            .iter()
            .zip(self.value.as_chunks::<M>().0)
            .zip(self.slope.as_chunks::<M>().0)
            .zip(self.reach.as_chunks::<M>().0)
            .zip(self.curvature.as_chunks_mut::<M>().0);
        for ((((step, value), slope), reach), curvature) in groups {
            let inverse = ONE / *step;
            let sharp = self.weights.sharpness(reach, inverse);
            let followed = self.weights.second_derivative(value, slope, inverse);
            for j in 0..M {
                curvature[j] = sharp.if_less(Lanes::of(SHARP), followed[j], curvature[j]);
            }
        }
    }

    /// beta' in `block` after its states have moved.
    #[inline(always)]
    pub(crate) fn followed(&self, block: usize, moved: &[Lanes; N]) -> Lanes {
        let mut slope = self.slope[block];
        for a in 0..N {
            slope += self.by_state[block][a] * moved[a];
        }
        slope
    }

    /// How beta' in `block` follows the state.
    #[inline(always)]
    pub(crate) fn by_state(&self, block: usize) -> &[Lanes; N] {
        &self.by_state[block]
    }

    /// Where beta moves by `value_drift` with a parameter at fixed z and beta': what beta' does, into `slope_drift`, and what
    /// that adds to `drifts`. For the last state that was closed.
    pub(crate) fn follow_drift(
        &self,
        steps: &[Lanes],
        value_drift: &[Lanes],
        drifts: &mut [[Lanes; N]],
        slope_drift: &mut Vec<Lanes>,
    ) {
        let stages = self.stages;
        slope_drift.clear();
        for (block, drifts) in drifts.iter_mut().enumerate() {
            let (group, j) = (block / stages, block % stages);
            let inverse = ONE / steps[group];
            let (mut reach_slope, mut drift) = (ZERO, ZERO);
            for l in 0..stages {
                let d = Lanes::of(self.weights.plain[j][l]) * inverse;
                reach_slope += d * self.reach[group * stages + l];
                drift += d * value_drift[group * stages + l];
            }
            let by = &self.coupling[block];
            let own = ONE - dot(&by.value, &by.slope) - reach_slope;
            let share = Lanes::of(0.3).if_less(own, ONE / own, ZERO);
            let drift = share * (drift + dot(&by.value, drifts));
            for b in 0..N {
                drifts[b] += by.slope[b] * drift;
            }
            slope_drift.push(drift);
        }
    }

    /// Closes the loop: from what the slopes were evaluated with to the next beta' and beta'', and into
    /// slopes, gradients and drifts what beta' adds to them. `steps` are element lengths, a group.
    #[inline(always)]
    pub(crate) fn close<const FUSED: bool>(
        &mut self,
        steps: &[Lanes],
        out: &mut [Local<N, Q, Lanes>],
        drifts: &mut [[Lanes; N]],
    ) {
        self.fresh = self.blunt;
        self.some_short = false;
        self.sides.clear();
        // Loops of a length that the compiler knows are several times faster.
        if self.stages == 4 {
            self.close_on::<FUSED, 4>(steps, out, drifts);
        } else {
            self.close_on::<FUSED, 5>(steps, out, drifts);
        }
    }

    #[inline(always)]
    fn close_on<const FUSED: bool, const M: usize>(
        &mut self,
        steps: &[Lanes],
        out: &mut [Local<N, Q, Lanes>],
        drifts: &mut [[Lanes; N]],
    ) {
        let groups = steps
            .iter()
            .zip(self.value.as_chunks::<M>().0)
            .zip(self.slope.as_chunks_mut::<M>().0)
            .zip(self.curvature.as_chunks_mut::<M>().0)
            .zip(self.closed.as_chunks::<M>().0)
            .zip(self.reach.as_chunks::<M>().0)
            .zip(self.coupling.as_chunks::<M>().0)
            .zip(self.by_state.as_chunks_mut::<M>().0)
            .zip(out.as_chunks_mut::<M>().0)
            .zip(drifts.as_chunks_mut::<M>().0);
        for (((((((((step, value), slope), curvature), closed), reach), coupling), by_state), out), drifts) in groups {
            let group = Group { inverse: ONE / *step, value, closed, reach, coupling };
            if self.blunt {
                group.close_bluntly(slope, curvature, by_state, out);
            } else {
                self.some_short |= group.close::<FUSED>(&self.weights, slope, curvature, by_state, out, drifts);
            }
        }
    }
}

/// A group of elements of `M` stages.
struct Group<'a, const M: usize> {
    /// One over the steps.
    inverse: Lanes,
    value: &'a [Lanes; M],
    closed: &'a [Lanes; M],
    reach: &'a [Lanes; M],
    coupling: &'a [Coupling; M],
}

impl<const M: usize> Group<'_, M> {
    /// beta' lags, without beta''.
    #[inline(always)]
    fn close_bluntly(
        &self,
        slope: &mut [Lanes; M],
        curvature: &mut [Lanes; M],
        by_state: &mut [[Lanes; N]; M],
        out: &mut [Local<N, Q, Lanes>; M],
    ) {
        for j in 0..M {
            add_change(&self.coupling[j], self.closed[j] - slope[j], &mut out[j]);
            slope[j] = self.closed[j];
            curvature[j] = ZERO;
            by_state[j] = [ZERO; N];
        }
    }

    #[inline(always)]
    fn close<const FUSED: bool>(
        &self,
        weights: &Differentiation,
        slope: &mut [Lanes; M],
        curvature: &mut [Lanes; M],
        by_state: &mut [[Lanes; N]; M],
        out: &mut [Local<N, Q, Lanes>; M],
        drifts: &mut [[Lanes; N]; M],
    ) -> bool {
        let before = *slope;
        let own_part: [Lanes; M] = each_stage(|j| dot(&self.coupling[j].value, &self.coupling[j].slope));
        let short = self.next(weights, &own_part, slope, curvature);
        for j in 0..M {
            let (mut along, mut reach_slope, mut drift) = ([ZERO; N], ZERO, ZERO);
            for l in 0..M {
                let d = Lanes::of(weights.plain[j][l]) * self.inverse;
                let other = &self.coupling[l];
                for a in 0..N {
                    along[a] = along[a].plus::<FUSED>(d, other.value[a]);
                }
                reach_slope = reach_slope.plus::<FUSED>(d, self.reach[l]);
                drift = drift.plus::<FUSED>(d, other.value_drift);
            }
            let by = &self.coupling[j];
            let own = ONE - own_part[j] - reach_slope;
            // Far from a shape the linearisation may mean nothing: then beta' only lags.
            let share = Lanes::of(0.3).if_less(own, ONE / own, ZERO);
            let local = &mut out[j];
            for b in 0..N {
                for a in 0..N {
                    along[a] = along[a].plus::<FUSED>(by.value[b], local.jacobian[b][a]);
                }
            }
            for a in 0..N {
                along[a] = share * along[a];
            }
            let drift = share * (drift + dot(&by.value, &drifts[j]));
            add_change(by, slope[j] - before[j], local);
            for b in 0..N {
                drifts[j][b] += by.slope[b] * drift;
                for a in 0..N {
                    local.jacobian[b][a] = local.jacobian[b][a].plus::<FUSED>(by.slope[b], along[a]);
                }
            }
            for q in 0..Q {
                for a in 0..N {
                    local.rate_gradient[q][a] = local.rate_gradient[q][a].plus::<FUSED>(by.rate[q], along[a]);
                }
            }
            by_state[j] = along;
        }
        short
    }

    /// The next beta' and beta''; whether an element is short.
    ///
    /// beta'' feeds back into beta' as `reach` beta''. Where a step is long against `reach` the
    /// sharpest formula serves, one round behind. Where it is not, lagging would excite the fast mode
    /// that `docs/model.md`, section 8, item 1 excludes: there beta' and beta'' are solved for together,
    /// and where `reach` is a good part of the step, beta' is the slope of the element's own
    /// polynomial through beta, which has no fast mode, found by Newton along with everything else.
    #[inline(always)]
    fn next(
        &self,
        weights: &Differentiation,
        own_part: &[Lanes; M],
        slope: &mut [Lanes; M],
        curvature: &mut [Lanes; M],
    ) -> bool {
        let given = (*slope, *curvature);
        let sharp = weights.sharpness(self.reach, self.inverse);
        let bound = Lanes::of(SHARP);
        for j in 0..M {
            let share = ONE - own_part[j];
            let share = Lanes::of(0.3).if_less(share, share, ONE);
            slope[j] += (self.closed[j] - slope[j]) / share;
        }
        *curvature = weights.second_derivative(self.value, slope, self.inverse);
        let some_short = !sharp.all_below(SHARP);
        if some_short {
            let (short, short_curvature) = self.next_on_short(weights, sharp / Lanes::of(weights.hermite_gain), given);
            for j in 0..M {
                slope[j] = sharp.if_less(bound, slope[j], short[j]);
                curvature[j] = sharp.if_less(bound, curvature[j], short_curvature[j]);
            }
        }
        some_short
    }

    /// The next beta' and beta'' where a step is not long against `reach`; `largest` is the largest `reach` over the
    /// step.
    #[inline(always)]
    fn next_on_short(
        &self,
        weights: &Differentiation,
        largest: Lanes,
        (slope, curvature): ([Lanes; M], [Lanes; M]),
    ) -> ([Lanes; M], [Lanes; M]) {
        let bound = Lanes::of(OWN);
        let mut matrix = [[ZERO; M]; M];
        let mut right = [ZERO; M];
        let rest: [Lanes; M] = each_stage(|l| (self.value[l] - self.reach[l] * slope[l]) * self.inverse);
        let reach: [Lanes; M] = each_stage(|l| self.reach[l] * self.inverse);
        for j in 0..M {
            let mut sum = ZERO;
            for l in 0..M {
                let d = Lanes::of(weights.plain[j][l]);
                sum += d * rest[l];
                matrix[j][l] = -(largest.if_less(bound, reach[j], reach[l]) * d);
            }
            matrix[j][j] += ONE;
            // beta' - reach beta'' = rest, with beta'' the slope of the polynomial through beta', or, on the
            // shortest, one Newton step on beta' = D beta(nu(z, beta')) / h: d beta / d beta' is `reach`.
            right[j] = largest.if_less(bound, self.closed[j] - self.reach[j] * curvature[j], sum);
        }
        let slope = solve_small(&matrix, &right, &slope);
        let curvature = each_stage(|j| {
            let mut sum = ZERO;
            for l in 0..M {
                sum += Lanes::of(weights.plain[j][l]) * slope[l];
            }
            sum * self.inverse
        });
        (slope, curvature)
    }
}

/// What a change of beta' adds to slopes and rates.
#[inline(always)]
fn add_change(by: &Coupling, change: Lanes, local: &mut Local<N, Q, Lanes>) {
    for b in 0..N {
        local.slope[b] += by.slope[b] * change;
    }
    for q in 0..Q {
        local.rate[q] += by.rate[q] * change;
    }
}

#[inline(always)]
fn dot(a: &[Lanes; N], b: &[Lanes; N]) -> Lanes {
    let mut sum = ZERO;
    for k in 0..N {
        sum += a[k] * b[k];
    }
    sum
}
