//! Newton's method on the tensions, from several starts.

use super::conditions::{ByTensions, Pulled};
use super::effort::{dot, least_effort, nearest};
use super::problem::{Bound, ReachError, ReachOptions, Reached};
use super::reaching::Reaching;
use crate::rod::arm::Arm;
use crate::statics::sensitivity::{SensitivityError, check};
use crate::statics::solve::Solver;

/// Most rounds from a start.
const ROUNDS: usize = 60;

/// The longest step: how far it moves what has a target, over L, to first order.
const LONGEST: f64 = 0.3;

/// Tolerance of solves over the distance at which a target is reached.
const SOLVED: f64 = 0.3;

/// What a slack cable is paid out beyond the length that it would be taut at, over that of the whole cable.
const PAID_OUT: f64 = 0.01;

/// How often less is pulled where a search cannot begin.
const LESS: usize = 6;

/// How heavy strokes are in a damped step, over the targets.
const HEAVY: f64 = 1e3;

/// Change of the tensions, over their scale, at which least effort and least distance are found.
pub(super) const STILL: f64 = 1e-9;

/// Change of the tensions, over their scale, within which solutions may be one.
const NEIGHBOURS: f64 = 0.05;

/// A solved arm at tensions, with the distances to the targets.
#[derive(Debug, Clone)]
pub(super) struct State<S = Solver> {
    pub(super) solver: S,
    pub(super) tensions: Vec<f64>,
    pub(super) rest: Vec<f64>,
    /// Strokes over L; none where they have no bound.
    pub(super) strokes: Vec<f64>,
}

impl<S> State<S> {
    pub(super) fn distance(&self) -> f64 {
        dot(&self.rest, &self.rest).sqrt()
    }

    /// Sum of the squares of the tensions, N^2.
    pub(super) fn effort(&self) -> f64 {
        dot(&self.tensions, &self.tensions)
    }

    pub(super) fn pulled(&self) -> Pulled<'_> {
        Pulled { tensions: &self.tensions, strokes: &self.strokes }
    }
}

/// What is looked for.
#[derive(Debug, Clone)]
pub(super) struct Search<S: Reaching = Solver> {
    pub(super) arm: Arm,
    pub(super) goal: S::Goal,
    /// Largest tensions, N; 0 for what is not pulled.
    pub(super) most: Vec<f64>,
    /// Tensions, N, that bend the arm a good deal.
    pub(super) scale: Vec<f64>,
    /// The largest stroke of a cable that pulls, over L.
    pub(super) longest: Option<f64>,
    pub(super) tol: f64,
    /// Whether the lengths of cables are commanded of what is found, in place of their tensions.
    by_strokes: bool,
}

impl<S: Reaching> Search<S> {
    pub(super) fn new(arm: &Arm, goal: S::Goal, options: &ReachOptions) -> Result<Self, ReachError<S::Error>> {
        if arm.cables.is_empty() {
            return Err(ReachError::NoCables);
        }
        let arm = arm.slackened();
        arm.check().map_err(|error| ReachError::Solve(S::wrong(error)))?;
        if !S::fits(&goal, &arm) {
            return Err(ReachError::Target);
        }
        check(&arm, &[], &S::stations(&goal))?;
        if !(1e-10..=1e-2).contains(&options.tol) {
            return Err(ReachError::Option { option: "tol", value: options.tol, expected: "in [1e-10, 1e-2]" });
        }
        for (option, value) in [("max_tension", options.max_tension), ("max_stroke", options.max_stroke)] {
            if let Some(value) = value.filter(|most| !(*most > 0.0 && most.is_finite())) {
                return Err(ReachError::Option { option, value, expected: "above 0" });
            }
        }
        let bending = S::unit_force(&arm) * arm.length * arm.length;
        let scale: Vec<f64> = arm
            .cables
            .iter()
            .map(|cable| {
                let y = cable.offset.at(0.0, arm.length).value.abs();
                bending / (arm.length * y.max(1e-3 * arm.length))
            })
            .collect();
        let bound = |own: Option<f64>| match (own, options.max_tension) {
            (Some(own), Some(given)) => own.min(given),
            (own, given) => own.or(given).unwrap_or(f64::INFINITY),
        };
        let most: Vec<f64> = arm.cables.iter().map(|cable| bound(cable.max_tension)).collect();
        let scale = scale.iter().zip(&most).map(|(scale, most)| scale.min(*most)).collect();
        let longest = options.max_stroke.map(|stroke| stroke / arm.length);
        Ok(Self { arm, goal, most, scale, longest, tol: options.tol, by_strokes: false })
    }

    /// Commands the lengths of cables of what is found.
    pub(super) fn hold_lengths(&mut self) {
        self.by_strokes = true;
    }

    /// Leaves all cables slack but one.
    pub(super) fn pull_only(&mut self, cable: usize) {
        for most in self.most.iter_mut().enumerate().filter(|(c, _)| *c != cable).map(|(_, most)| most) {
            *most = 0.0;
        }
    }

    /// Tensions to start from: every cable alone, and in pairs, gently and less so. Where strokes have a bound every
    /// cable also with all others slack, since these can then be beyond it.
    pub(super) fn starts(&self) -> Vec<Vec<f64>> {
        let n = self.scale.len();
        let at = |fractions: &dyn Fn(usize) -> f64| {
            (0..n).map(|c| (fractions(c) * self.scale[c]).min(self.most[c])).collect::<Vec<f64>>()
        };
        let mut out = vec![at(&|_| 0.05)];
        for strong in [0.2, 0.6, 1.0] {
            for own in 0..n {
                out.push(at(&|c| if c == own { strong } else { 0.02 }));
            }
        }
        if n < 6 {
            for a in 0..n {
                for b in a + 1..n {
                    for [own, other] in [[0.7, 0.4], [0.4, 0.7]] {
                        out.push(at(&|c| {
                            if c == a {
                                own
                            } else if c == b {
                                other
                            } else {
                                0.02
                            }
                        }));
                    }
                }
            }
        }
        if self.longest.is_some() {
            for (strong, own) in [0.2, 0.6].into_iter().flat_map(|strong| (0..n).map(move |own| (strong, own))) {
                out.push(at(&|c| if c == own { strong } else { 0.0 }));
            }
        }
        out.dedup();
        out
    }

    /// Whether two solutions are near each other and what is between them is one, too: at the edge of what is reached,
    /// the tensions that bring the arm to within the tolerance of a target are as many as its root allows.
    pub(super) fn joined(&self, a: &State<S>, b: &State<S>) -> bool {
        if self.change(&a.tensions, &b.tensions) >= NEIGHBOURS {
            return false;
        }
        let between: Vec<f64> = a.tensions.iter().zip(&b.tensions).map(|(a, b)| 0.5 * (a + b)).collect();
        let mut solver = a.solver.clone();
        let solved = solver.pull(&between).is_some() && solver.settle_warm().is_some();
        solved && self.state(solver, between).distance() <= 3.0 * self.tol
    }

    /// Settled at these tensions, from nothing.
    pub(super) fn at(&self, tensions: &[f64]) -> Result<State<S>, ReachError<S::Error>> {
        let mut arm = self.arm.clone();
        arm.set_tensions(tensions).map_err(|error| ReachError::Solve(S::wrong(error)))?;
        let mut solver = S::begin(&arm, (SOLVED * self.tol).clamp(1e-11, 1e-6)).map_err(ReachError::Solve)?;
        let places: Vec<f64> = S::stations(&self.goal).iter().map(|s| s / self.arm.length).collect();
        if !solver.watch(&places) {
            return Err(SensitivityError::Unsettled(f64::NAN).into());
        }
        Ok(self.state(solver, tensions.to_vec()))
    }

    /// The state of a solved arm.
    pub(super) fn state(&self, solver: S, tensions: Vec<f64>) -> State<S> {
        let (rest, strokes) = (self.rest(&solver), self.strokes(&solver));
        State { solver, tensions, rest, strokes }
    }

    /// [`Search::at`], with less of the tensions where there is no equilibrium or strokes are too long.
    pub(super) fn begin(&self, start: &[f64]) -> Result<State<S>, ReachError<S::Error>> {
        let mut tensions = start.to_vec();
        let mut found = self.at(&tensions).map(|state| self.within(state));
        for _ in 0..LESS {
            if !matches!(found, Ok(None) | Err(ReachError::Solve(_))) {
                break;
            }
            for tension in &mut tensions {
                *tension *= 0.4;
            }
            found = self.at(&tensions).map(|state| self.within(state));
        }
        match found? {
            Some(state) => Ok(state),
            // A slack cable takes no stroke.
            None => self.at(&vec![0.0; tensions.len()]),
        }
    }

    /// With strokes within their bounds, if they get there.
    fn within(&self, mut state: State<S>) -> Option<State<S>> {
        if self.longest.is_none() {
            return Some(state);
        }
        let slopes = self.slopes(&state.solver)?;
        self.pull(&mut state.solver, &mut state.tensions, &slopes, updated)?;
        Some(self.state(state.solver, state.tensions))
    }

    /// Weighted distances to the targets, over L.
    pub(super) fn rest(&self, solver: &S) -> Vec<f64> {
        solver.rest(&self.goal, &self.arm)
    }

    /// Derivatives of the distances by the tensions: one column a cable. `None` at a limit point.
    pub(super) fn jacobian(&self, solver: &S) -> Option<Vec<Vec<f64>>> {
        self.derivatives(solver, false).map(|slopes| slopes.rest)
    }

    /// [`Search::jacobian`], with the derivatives of strokes where they have a bound.
    pub(super) fn slopes(&self, solver: &S) -> Option<ByTensions> {
        self.derivatives(solver, self.longest.is_some())
    }

    fn derivatives(&self, solver: &S, of_strokes: bool) -> Option<ByTensions> {
        let cables = self.scale.len();
        let rows = solver.derivatives(&self.goal, &self.arm, of_strokes)?;
        let count = rows.len() - if of_strokes { cables } else { 0 };
        let column = |c: usize| rows.iter().map(|row| row[c]).collect();
        let mut rest: Vec<Vec<f64>> = (0..cables).map(column).collect();
        let strokes = rest.iter_mut().map(|column| column.split_off(count)).collect();
        Some(ByTensions { rest, strokes })
    }

    /// From a start to the nearest that can be had, of least effort.
    pub(super) fn from(&self, start: &[f64], go_on: &dyn Fn() -> bool) -> Result<State<S>, ReachError<S::Error>> {
        let mut state = self.begin(start)?;
        let mut damping = 1e-3;
        let mut refined = 0;
        for _ in 0..ROUNDS {
            if !go_on() {
                break;
            }
            let Some(slopes) = self.slopes(&state.solver) else { break };
            let reached = state.distance() <= 0.1 * self.tol;
            if let Some(next) = self.towards_least_effort(&slopes, &state) {
                let still = self.change(&next, &state.tensions) < STILL;
                if reached && (still || refined > 20) {
                    break;
                }
                if let Some(better) = self.step(&state, &slopes, &next, if reached { Some(self.tol) } else { None }) {
                    refined += usize::from(reached);
                    state = better;
                    continue;
                }
            }
            if reached {
                break;
            }
            // Damped least squares, ever shorter.
            let mut moved = false;
            while damping < 1e9 {
                let next = self.damped(&slopes, &state, damping);
                if self.change(&next, &state.tensions) < STILL {
                    break;
                }
                if let Some(better) = self.step(&state, &slopes, &next, None) {
                    state = better;
                    damping = (0.2 * damping).max(1e-12);
                    moved = true;
                    break;
                }
                damping *= 8.0;
            }
            if !moved {
                break;
            }
        }
        Ok(state)
    }

    /// The largest change of the tensions over their scale.
    pub(super) fn change(&self, a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).zip(&self.scale).fold(0.0, |m, ((a, b), scale)| f64::max(m, (a - b).abs() / scale))
    }

    /// Tensions of least effort that meet the targets to first order, or as much of the way as a step may go.
    pub(super) fn towards_least_effort(&self, slopes: &ByTensions, state: &State<S>) -> Option<Vec<f64>> {
        let distance = state.distance();
        let fraction = if distance > LONGEST { LONGEST / distance } else { 1.0 };
        let wanted = linear(&slopes.rest, state, fraction);
        self.within_strokes(state.pulled(), slopes, |active, most| {
            let targets = (slopes.rest.clone(), wanted.clone());
            let all = self.conditions(targets, state.pulled(), slopes, (active, most), 1.0);
            let mut found = least_effort(&all.columns, &all.wanted, &all.most, most.len())?;
            found.truncate(most.len());
            Some(found)
        })
    }

    /// A damped least-squares step within the bounds.
    pub(super) fn damped(&self, slopes: &ByTensions, state: &State<S>, damping: f64) -> Vec<f64> {
        let sizes = slopes.rest.iter().zip(&self.scale).map(|(column, scale)| scale * scale * dot(column, column));
        let size = sizes.fold(f64::MIN_POSITIVE, f64::max);
        let wanted = linear(&slopes.rest, state, 1.0);
        let found = self.within_strokes(state.pulled(), slopes, |active, most| {
            let targets = (slopes.rest.clone(), wanted.clone());
            let all = self.conditions(targets, state.pulled(), slopes, (active, most), HEAVY);
            let mut weights: Vec<f64> = self.scale.iter().map(|scale| damping * size / (scale * scale)).collect();
            weights.resize(all.now.len(), 0.0);
            let mut found = nearest(&all.columns, &all.wanted, &all.most, &weights, &all.now)?;
            found.truncate(most.len());
            Some(found)
        });
        let Some(mut next) = found else { return state.tensions.clone() };
        let moved = |r: usize| -> f64 {
            let by = slopes.rest.iter().zip(next.iter().zip(&state.tensions));
            by.map(|(column, (to, from))| column[r] * (to - from)).sum()
        };
        let longest = (0..state.rest.len()).map(moved).fold(0.0, f64::hypot);
        if longest > LONGEST {
            for ((to, from), most) in next.iter_mut().zip(&state.tensions).zip(&self.most) {
                *to = (from + LONGEST / longest * (*to - from)).clamp(0.0, *most);
            }
        }
        next
    }

    /// The arm at other tensions, changed by what strokes are too long there, if that is nearer; near enough where a
    /// distance is `allowed`.
    pub(super) fn step(
        &self,
        state: &State<S>,
        slopes: &ByTensions,
        next: &[f64],
        allowed: Option<f64>,
    ) -> Option<State<S>> {
        let mut solver = state.solver.clone();
        let mut tensions = next.to_vec();
        self.pull(&mut solver, &mut tensions, slopes, updated)?;
        let better = self.state(solver, tensions);
        let enough = allowed.unwrap_or((1.0 - 1e-6) * state.distance());
        (better.distance() <= enough).then_some(better)
    }

    #[expect(clippy::type_complexity, reason = "what the solver makes of an arm")]
    pub(super) fn read(&self, mut state: State<S>) -> Result<Reached<S::Shape, S::Place>, ReachError<S::Error>> {
        let configuration = state.solver.shape().map_err(ReachError::Solve)?;
        let mut bounds = Vec::new();
        for c in 0..self.scale.len() {
            if self.is_slack(c, state.tensions[c]) {
                bounds.push(Bound::Slack(c));
                continue;
            }
            if self.most[c] - state.tensions[c] <= 1e-9 * self.scale[c] {
                bounds.push(Bound::Most(c));
            }
            if self.longest.is_some_and(|longest| longest - state.strokes[c] <= 10.0 * self.tol) {
                bounds.push(Bound::Stroke(c));
            }
        }
        let asked = if self.by_strokes { self.commanded(&configuration) } else { S::arm(&configuration).clone() };
        let led = S::on_the_path(&asked).filter(|other| S::is_near(other, &configuration));
        let on_the_path = led.is_some();
        let configuration = led.filter(|_| self.by_strokes).unwrap_or(configuration);
        Ok(Reached {
            effort: state.effort(),
            distance: state.distance(),
            bounds,
            on_the_path,
            stability: S::stability(&configuration),
            places: S::stations(&self.goal).iter().map(|s| S::place(&configuration, *s)).collect(),
            tensions: state.tensions,
            configuration,
        })
    }
}

impl<S: Reaching> Search<S> {
    /// The arm with its cables at the lengths that they have; of an elastic one what its tension stretches is reeled
    /// in, too. One that hangs slack is paid out a little beyond that: any longer one has the same shape, and one just
    /// taut is not to pull on the way there.
    fn commanded(&self, configuration: &S::Shape) -> Arm {
        let mut arm = S::arm(configuration).clone();
        for (c, (cable, state)) in arm.cables.iter_mut().zip(S::cables(configuration)).enumerate() {
            let unloaded = state.length + state.stroke;
            cable.stroke = Some(if self.is_slack(c, state.tension) {
                state.stroke - PAID_OUT * unloaded
            } else {
                let stretch = cable.stiffness.map_or(1.0, |stiffness| 1.0 + state.tension / stiffness);
                unloaded - state.length / stretch
            });
        }
        arm
    }
}

/// What the derivatives times tensions have to be for a fraction of the way to the targets.
fn linear<S>(columns: &[Vec<f64>], state: &State<S>, fraction: f64) -> Vec<f64> {
    let carried = |r: usize| columns.iter().zip(&state.tensions).map(|(column, t)| column[r] * t).sum::<f64>();
    state.rest.iter().enumerate().map(|(r, rest)| carried(r) - fraction * rest).collect()
}

/// Solves at other tensions, if it can.
fn updated<S: Reaching>(solver: &mut S, tensions: &[f64]) -> Option<()> {
    solver.pull(tensions)?;
    solver.settle()
}
