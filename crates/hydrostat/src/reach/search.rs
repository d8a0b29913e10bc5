//! Newton's method on the tensions, from several starts.

use super::effort::{dot, least_effort};
use super::{Bound, ReachError, ReachOptions, Reached, Target};
use crate::arm::Arm;
use crate::configuration::Configuration;
use crate::engine::{Engine, solved};
use crate::parameter::Parameter;
use crate::sensitivity::{SensitivityError, SensitivityMethod, check};
use crate::solve::{Options, Solver};
use crate::verdict::SolveError;

/// Most rounds from a start.
const ROUNDS: usize = 60;

/// Tips (over L) that are this near are at the same place.
const SAME: f64 = 1e-6;

/// The longest step: how far it moves what has a target, over L, to first order.
const LONGEST: f64 = 0.3;

/// Tolerance of solves over the distance at which a target is reached.
const SOLVED: f64 = 0.3;

/// Change of the tensions, over their scale, at which least effort and least distance are found.
pub(super) const STILL: f64 = 1e-9;

/// What is to be reached.
#[derive(Debug, Clone)]
pub(super) enum Goal {
    /// Places of the arm.
    Places(Vec<Target>),
    /// The angle alpha of the tip section, rad.
    TipAngle(f64),
}

/// A solved arm at tensions, with the distances to the targets.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) solver: Solver,
    pub(super) tensions: Vec<f64>,
    pub(super) rest: Vec<f64>,
}

impl State {
    pub(super) fn distance(&self) -> f64 {
        dot(&self.rest, &self.rest).sqrt()
    }
}

/// What is looked for.
#[derive(Debug, Clone)]
pub(super) struct Search {
    pub(super) arm: Arm,
    pub(super) goal: Goal,
    /// Largest tensions, N; 0 for what is not pulled.
    pub(super) most: Vec<f64>,
    /// Tensions, N, that bend the arm a good deal.
    pub(super) scale: Vec<f64>,
    pub(super) tol: f64,
    /// Whether the lengths of cables are commanded of what is found, in place of their tensions.
    by_strokes: bool,
}

impl Search {
    pub(super) fn new(arm: &Arm, goal: Goal, options: &ReachOptions) -> Result<Self, ReachError> {
        if arm.cables.is_empty() {
            return Err(ReachError::NoCables);
        }
        let arm = arm.slackened();
        arm.check().map_err(SolveError::from)?;
        let fine = |t: &Target| {
            t.x.is_finite()
                && t.y.is_finite()
                && t.angle.is_none_or(f64::is_finite)
                && t.weight > 0.0
                && t.weight.is_finite()
        };
        let fine = match &goal {
            Goal::Places(targets) => !targets.is_empty() && targets.iter().all(fine),
            Goal::TipAngle(angle) => angle.is_finite(),
        };
        if !fine {
            return Err(ReachError::Target);
        }
        check(&arm, &[], &goal.stations().collect::<Vec<f64>>())?;
        if !(1e-10..=1e-2).contains(&options.tol) {
            return Err(ReachError::Option { option: "tol", value: options.tol, expected: "in [1e-10, 1e-2]" });
        }
        if let Some(value) = options.max_tension.filter(|most| !(*most > 0.0 && most.is_finite())) {
            return Err(ReachError::Option { option: "max_tension", value, expected: "above 0" });
        }
        let bending = Engine::new(&arm).equations.units.force * arm.length * arm.length;
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
        Ok(Self { arm, goal, most, scale, tol: options.tol, by_strokes: false })
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

    /// Tensions to start from: every cable alone, and in pairs, gently and less so.
    pub(super) fn starts(&self) -> Vec<Vec<f64>> {
        let n = self.scale.len();
        let at = |shares: &dyn Fn(usize) -> f64| {
            (0..n).map(|c| (shares(c) * self.scale[c]).min(self.most[c])).collect::<Vec<f64>>()
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
        out.dedup();
        out
    }

    /// Whether tensions are the same.
    pub(super) fn same(&self, a: &[f64], b: &[f64]) -> bool {
        a.iter().zip(b).zip(&self.scale).all(|((a, b), scale)| (a - b).abs() < 1e-5 * scale)
    }

    /// Settled at these tensions, from nothing.
    pub(super) fn at(&self, tensions: &[f64]) -> Result<State, ReachError> {
        let mut arm = self.arm.clone();
        arm.set_tensions(tensions).map_err(SolveError::from)?;
        let mut solver = Solver::new(&arm, Options { tol: (SOLVED * self.tol).clamp(1e-11, 1e-6) })?;
        solver.update()?;
        let places: Vec<f64> = self.goal.stations().map(|s| s / self.arm.length).collect();
        if solver.engine.watch(&places, solver.options.tol).is_err() {
            return Err(SensitivityError::Unsettled(f64::NAN).into());
        }
        let rest = self.rest(&solver);
        Ok(State { solver, tensions: tensions.to_vec(), rest })
    }

    /// [`Search::at`], with less of the tensions where there is no equilibrium.
    pub(super) fn begin(&self, start: &[f64]) -> Result<State, ReachError> {
        let mut tensions = start.to_vec();
        let mut found = self.at(&tensions);
        for _ in 0..6 {
            if !matches!(found, Err(ReachError::Solve(_))) {
                break;
            }
            for tension in &mut tensions {
                *tension *= 0.4;
            }
            found = self.at(&tensions);
        }
        found
    }

    /// Weighted distances to the targets, over L.
    pub(super) fn rest(&self, solver: &Solver) -> Vec<f64> {
        let engine = &solver.engine;
        let (base, length) = (self.arm.base, self.arm.length);
        let targets = match &self.goal {
            Goal::Places(targets) => targets,
            // Where the end has no strains it is as far off as can be.
            Goal::TipAngle(angle) => return vec![engine.read_tip().map_or(f64::INFINITY, |tip| tip.alpha - angle)],
        };
        let mut out = Vec::with_capacity(3 * targets.len());
        for target in targets {
            let [x, y, theta] = engine.pose_of(target.s.map_or(1.0, |s| s / length));
            out.push(target.weight * (x - (target.x - base.x) / length));
            out.push(target.weight * (y - (target.y - base.y) / length));
            if let Some(angle) = target.angle {
                let turns = std::f64::consts::TAU;
                let off = (theta - angle).rem_euclid(turns);
                out.push(target.weight * if off > 0.5 * turns { off - turns } else { off });
            }
        }
        out
    }

    /// Derivatives of the distances by the tensions: one column a cable. `None` at a limit point.
    pub(super) fn jacobian(&self, solver: &Solver) -> Option<Vec<Vec<f64>>> {
        let cables: Vec<Parameter> = (0..self.scale.len()).map(Parameter::Tension).collect();
        let mut quantities = Vec::new();
        let mut weights = Vec::new();
        let targets: &[Target] = match &self.goal {
            Goal::Places(targets) => targets,
            Goal::TipAngle(_) => {
                quantities.push(solver.engine.pose_at(1.0)[3]);
                weights.push(1.0);
                &[]
            }
        };
        for target in targets {
            let [x, y, theta, _] = solver.engine.pose_at(target.s.map_or(1.0, |s| s / self.arm.length));
            quantities.extend([x, y]);
            weights.extend([target.weight / self.arm.length; 2]);
            if target.angle.is_some() {
                quantities.push(theta);
                weights.push(target.weight);
            }
        }
        let found = solver.engine.derivatives(&quantities, &cables, SensitivityMethod::Best)?;
        let column = |c: usize| found.rows.iter().zip(&weights).map(|(row, weight)| weight * row[c]).collect();
        Some((0..cables.len()).map(column).collect())
    }

    /// From a start to the nearest that can be had, of least effort.
    pub(super) fn from(&self, start: &[f64], go_on: &dyn Fn() -> bool) -> Result<State, ReachError> {
        let mut state = self.begin(start)?;
        let mut damping = 1e-3;
        let mut refined = 0;
        for _ in 0..ROUNDS {
            if !go_on() {
                break;
            }
            let Some(jacobian) = self.jacobian(&state.solver) else { break };
            let reached = state.distance() <= 0.1 * self.tol;
            if let Some(next) = self.towards_least_effort(&jacobian, &state) {
                let still = self.change(&next, &state.tensions) < STILL;
                if reached && (still || refined > 20) {
                    break;
                }
                if let Some(better) = self.step(&state, &next, if reached { Some(self.tol) } else { None }) {
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
                let next = self.damped(&jacobian, &state, damping);
                if self.change(&next, &state.tensions) < STILL {
                    break;
                }
                if let Some(better) = self.step(&state, &next, None) {
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

    pub(super) fn change(&self, a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).zip(&self.scale).fold(0.0, |m, ((a, b), scale)| f64::max(m, (a - b).abs() / scale))
    }

    /// Tensions of least effort that meet the targets to first order, or as much of the way as a step may go.
    pub(super) fn towards_least_effort(&self, jacobian: &[Vec<f64>], state: &State) -> Option<Vec<f64>> {
        let distance = state.distance();
        let share = if distance > LONGEST { LONGEST / distance } else { 1.0 };
        let carried = |r: usize| jacobian.iter().zip(&state.tensions).map(|(column, t)| column[r] * t).sum::<f64>();
        let wanted: Vec<f64> = state.rest.iter().enumerate().map(|(r, rest)| carried(r) - share * rest).collect();
        least_effort(jacobian, &wanted, &self.most)
    }

    /// A damped least-squares step within the bounds: cables on a bound that they would leave stay there.
    pub(super) fn damped(&self, jacobian: &[Vec<f64>], state: &State, damping: f64) -> Vec<f64> {
        let n = self.scale.len();
        let scaled: Vec<Vec<f64>> =
            jacobian.iter().zip(&self.scale).map(|(column, s)| column.iter().map(|v| v * s).collect()).collect();
        let size = scaled.iter().map(|column| dot(column, column)).fold(f64::MIN_POSITIVE, f64::max);
        // Only what would leave its bound downhill stays there.
        let downhill = |c: usize| -dot(&scaled[c], &state.rest);
        let on_bound = |c: usize| match downhill(c) {
            slope if slope < 0.0 => state.tensions[c] <= 0.0,
            _ => state.tensions[c] >= self.most[c],
        };
        let mut fixed: Vec<bool> = (0..n).map(on_bound).collect();
        let mut next = state.tensions.clone();
        for _ in 0..=n {
            let free: Vec<usize> = (0..n).filter(|c| !fixed[*c]).collect();
            let row = |a: &usize| {
                let by = free.iter().map(|b| dot(&scaled[*a], &scaled[*b]) + if a == b { damping * size } else { 0.0 });
                (by.collect(), [downhill(*a), 0.0])
            };
            let Some((step, _)) = solved(free.iter().map(row).collect()) else { return next };
            let mut longest = 0.0_f64;
            for r in 0..state.rest.len() {
                longest = longest.hypot(free.iter().zip(&step).map(|(c, [d, _])| scaled[*c][r] * d).sum());
            }
            let share = if longest > LONGEST { LONGEST / longest } else { 1.0 };
            next.clone_from(&state.tensions);
            let mut stopped = false;
            for (c, [d, _]) in free.iter().zip(&step) {
                let wanted = state.tensions[*c] + share * d * self.scale[*c];
                next[*c] = wanted.clamp(0.0, self.most[*c]);
                if wanted != next[*c] && state.tensions[*c] == next[*c] && !stopped {
                    (fixed[*c], stopped) = (true, true);
                }
            }
            if !stopped {
                break;
            }
        }
        next
    }

    /// The arm at other tensions, if that is nearer; near enough where a distance is `allowed`.
    pub(super) fn step(&self, state: &State, next: &[f64], allowed: Option<f64>) -> Option<State> {
        let mut solver = state.solver.clone();
        solver.set_tensions(next).ok()?;
        solver.update().ok()?;
        let rest = self.rest(&solver);
        let better = State { solver, tensions: next.to_vec(), rest };
        let enough = allowed.unwrap_or((1.0 - 1e-6) * state.distance());
        (better.distance() <= enough).then_some(better)
    }

    pub(super) fn read(&self, mut state: State) -> Result<Reached, ReachError> {
        let configuration = state.solver.configuration()?;
        let at_bound = |c: usize| {
            let near = 1e-9 * self.scale[c];
            if state.tensions[c] <= near {
                Some(Bound::Slack(c))
            } else {
                (self.most[c] - state.tensions[c] <= near).then_some(Bound::Most(c))
            }
        };
        let asked = if self.by_strokes { commanded(&configuration) } else { configuration.arm.clone() };
        let led = asked.solve().ok().filter(|other| near(other, &configuration));
        let on_the_path = led.is_some();
        let configuration = led.filter(|_| self.by_strokes).unwrap_or(configuration);
        Ok(Reached {
            effort: dot(&state.tensions, &state.tensions),
            distance: state.distance(),
            bounds: (0..self.scale.len()).filter_map(at_bound).collect(),
            on_the_path,
            stability: configuration.stability(),
            tensions: state.tensions,
            configuration,
        })
    }
}

impl Goal {
    /// Places that are looked at beside the tip, m.
    fn stations(&self) -> impl Iterator<Item = f64> {
        let targets: &[Target] = match self {
            Self::Places(targets) => targets,
            Self::TipAngle(_) => &[],
        };
        targets.iter().filter_map(|target| target.s)
    }
}

/// Whether two tips are at the same place.
fn near(a: &Configuration, b: &Configuration) -> bool {
    (a.tip().x - b.tip().x).hypot(a.tip().y - b.tip().y) < SAME * a.arm.length
}

/// The arm with its cables at the lengths that they have; of an elastic one what its tension stretches is reeled in, too.
fn commanded(configuration: &Configuration) -> Arm {
    let mut arm = configuration.arm.clone();
    for (cable, state) in arm.cables.iter_mut().zip(&configuration.cables) {
        let stretch = cable.stiffness.map_or(1.0, |stiffness| 1.0 + state.tension / stiffness);
        cable.stroke = Some(state.length + state.stroke - state.length / stretch);
    }
    arm
}
