//! Inverse kinetics: the tensions that bring tip, or other places, to targets.
//!
//! The distances to the targets, over L, are made small by Newton's method on the tensions, with the exact jacobian
//! (`sensitivity`) on warm solves. A round asks for the least effort |T|^2 among the tensions within their bounds
//! that meet the targets to first order (`reach/effort`); where there are none, or they lead no nearer, it takes a damped least-squares step
//! whose tensions stop at their bounds. Several starts find several answers.

mod effort;
mod follow;

use self::effort::{dot, least_effort};
use crate::arm::Arm;
use crate::configuration::Configuration;
use crate::engine::{Engine, solved};
use crate::parameter::Parameter;
use crate::sensitivity::{SensitivityError, SensitivityMethod, check};
use crate::solve::{Options, Solver};
use crate::stability::Stability;
use crate::verdict::SolveError;

pub use self::follow::{Followed, Follower};

/// Most rounds from a start.
const ROUNDS: usize = 60;

/// Tips (over L) that are this near are at the same place.
const SAME: f64 = 1e-6;

/// The longest step: how far it moves what has a target, over L, to first order.
const LONGEST: f64 = 0.3;

/// Tolerance of solves over the distance at which a target is reached.
const SOLVED: f64 = 0.3;

/// Change of the tensions, over their scale, at which least effort and least distance are found.
const STILL: f64 = 1e-9;

/// Where a place of the arm is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// The place, m along the arm; none for the tip.
    pub s: Option<f64>,
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// Angle of the section from e1, rad, if it matters: in a distance, a radian counts as one arm's length.
    pub angle: Option<f64>,
    /// Weight of its distance among those of several targets.
    pub weight: f64,
}

impl Target {
    /// The tip at (x, y), m.
    pub fn tip(x: f64, y: f64) -> Self {
        Self { s: None, x, y, angle: None, weight: 1.0 }
    }
}

/// How tensions are looked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ReachOptions {
    /// The largest tension of every cable, N, where the cable itself has none.
    pub max_tension: Option<f64>,
    /// Distance over L at which a target is reached, in [1e-10, 1e-2].
    pub tol: f64,
    /// Whether to look from all starts; else the first that reaches the target ends the search.
    pub all: bool,
}

impl Default for ReachOptions {
    fn default() -> Self {
        Self { max_tension: None, tol: 1e-8, all: true }
    }
}

/// A bound that tensions lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bound {
    /// The cable is slack, and would have to push.
    Slack(usize),
    /// The cable has its largest tension.
    Most(usize),
}

/// Tensions, and the shape that they lead to.
#[derive(Debug, Clone)]
pub struct Reached {
    /// N.
    pub tensions: Vec<f64>,
    /// Sum of their squares, N^2.
    pub effort: f64,
    /// Root of the weighted sum of squared distances to the targets, over L.
    pub distance: f64,
    /// The bounds that its tensions lie on.
    pub bounds: Vec<Bound>,
    /// Whether a solve at these tensions, along the path of `docs/model.md`, leads to this shape.
    pub on_the_path: bool,
    /// `None` where it is not established.
    pub stability: Option<Stability>,
    /// The shape.
    pub configuration: Configuration,
}

/// What was found.
#[derive(Debug, Clone)]
pub struct Reach {
    /// Different tensions that reach the targets, least effort first.
    pub solutions: Vec<Reached>,
    /// Where nothing does, the nearest that was found.
    pub closest: Option<Reached>,
}

/// Why tensions cannot be looked for.
#[derive(Debug, Clone, thiserror::Error)]
pub enum ReachError {
    /// The arm is none, or has no equilibrium at any start.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The arm has no derivatives, or a target lies off it.
    #[error(transparent)]
    Sensitivity(#[from] SensitivityError),
    /// An arm without cables reaches nothing.
    #[error("the arm has no cable that could be pulled")]
    NoCables,
    /// No targets, or one that is no number.
    #[error("expected targets that are finite, with weights above 0")]
    Target,
    /// A bound or a tolerance that is none.
    #[error("{option}: expected a number {expected}, found {value}")]
    Option {
        /// Which.
        option: &'static str,
        /// What was given.
        value: f64,
        /// What is.
        expected: &'static str,
    },
}

impl Arm {
    /// Tensions, from 0 to their largest, that bring the arm to `targets`; the tensions and strokes of the arm itself do not count.
    ///
    /// # Errors
    /// [`ReachError`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Profile, ReachOptions, Target};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3));
    /// arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1));
    /// let tip = arm.solve()?.tip();
    ///
    /// let options = ReachOptions { max_tension: Some(0.5), ..ReachOptions::default() };
    /// let found = arm.reach(&[Target::tip(tip.x, tip.y)], &options)?;
    /// let best = &found.solutions[0];
    /// assert!((best.tensions[0] - 0.3).abs() < 1e-6 && (best.tensions[1] - 0.1).abs() < 1e-6);
    ///
    /// // Too far: the nearest place that the tip can get to.
    /// let found = arm.reach(&[Target::tip(0.3, 0.0)], &options)?;
    /// assert!(found.solutions.is_empty());
    /// assert!(found.closest.unwrap().tensions.iter().all(|t| *t < 1e-3), "it does not get longer by pulling");
    /// # Ok::<(), hydrostat::ReachError>(())
    /// ```
    pub fn reach(&self, targets: &[Target], options: &ReachOptions) -> Result<Reach, ReachError> {
        self.reach_while(targets, options, || true)
    }

    /// [`Arm::reach`] while `go_on`, which is asked every round, says so; then with what was found until then.
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn reach_while(
        &self,
        targets: &[Target],
        options: &ReachOptions,
        go_on: impl Fn() -> bool,
    ) -> Result<Reach, ReachError> {
        let search = Search::new(self, targets, options)?;
        let mut out = Reach { solutions: Vec::new(), closest: None };
        let mut failure = None;
        let mut nearest: Option<State> = None;
        for start in search.starts() {
            if !go_on() {
                break;
            }
            let state = match search.from(&start, &go_on) {
                Ok(state) => state,
                Err(error) => {
                    failure = Some(error);
                    continue;
                }
            };
            if state.distance() > options.tol {
                if nearest.as_ref().is_none_or(|n| state.distance() < n.distance()) {
                    nearest = Some(state);
                }
                continue;
            }
            let known = |own: &Reached| search.same(&own.tensions, &state.tensions);
            if !out.solutions.iter().any(known) {
                out.solutions.push(search.read(state)?);
                if !options.all {
                    break;
                }
            }
        }
        out.solutions.sort_by(|a, b| a.effort.total_cmp(&b.effort));
        if out.solutions.is_empty() {
            out.closest = match (nearest, failure) {
                (Some(state), _) => Some(search.read(state)?),
                (None, Some(failure)) => return Err(failure),
                (None, None) => None,
            };
        }
        Ok(out)
    }
}

/// A solved arm at tensions, with the distances to the targets.
#[derive(Debug, Clone)]
struct State {
    solver: Solver,
    tensions: Vec<f64>,
    rest: Vec<f64>,
}

impl State {
    fn distance(&self) -> f64 {
        dot(&self.rest, &self.rest).sqrt()
    }
}

/// What is looked for.
#[derive(Debug, Clone)]
pub(crate) struct Search {
    arm: Arm,
    targets: Vec<Target>,
    /// Largest tensions, N.
    most: Vec<f64>,
    /// Tensions, N, that bend the arm a good deal.
    scale: Vec<f64>,
    tol: f64,
}

impl Search {
    fn new(arm: &Arm, targets: &[Target], options: &ReachOptions) -> Result<Self, ReachError> {
        let mut arm = arm.clone();
        if arm.cables.is_empty() {
            return Err(ReachError::NoCables);
        }
        for cable in &mut arm.cables {
            (cable.stroke, cable.tension) = (None, 0.0);
        }
        arm.check().map_err(SolveError::from)?;
        let fine = |t: &Target| {
            t.x.is_finite()
                && t.y.is_finite()
                && t.angle.is_none_or(f64::is_finite)
                && t.weight > 0.0
                && t.weight.is_finite()
        };
        if targets.is_empty() || !targets.iter().all(fine) {
            return Err(ReachError::Target);
        }
        let stations: Vec<f64> = targets.iter().filter_map(|t| t.s).collect();
        check(&arm, &[], &stations)?;
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
        Ok(Self { arm, targets: targets.to_vec(), most, scale, tol: options.tol })
    }

    /// Tensions to start from: every cable alone, and in pairs, gently and less so.
    fn starts(&self) -> Vec<Vec<f64>> {
        let n = self.scale.len();
        let at = |shares: &dyn Fn(usize) -> f64| (0..n).map(|c| shares(c) * self.scale[c]).collect::<Vec<f64>>();
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
        out
    }

    /// Whether tensions are the same.
    fn same(&self, a: &[f64], b: &[f64]) -> bool {
        a.iter().zip(b).zip(&self.scale).all(|((a, b), scale)| (a - b).abs() < 1e-5 * scale)
    }

    /// Settled at these tensions, from nothing; with less of them where there is no equilibrium.
    fn begin(&self, start: &[f64]) -> Result<State, ReachError> {
        let mut tensions = start.to_vec();
        for attempt in 0.. {
            let mut arm = self.arm.clone();
            arm.set_tensions(&tensions).map_err(SolveError::from)?;
            let mut solver = Solver::new(&arm, Options { tol: (SOLVED * self.tol).clamp(1e-11, 1e-6) })?;
            match solver.update() {
                Ok(_) => {
                    let length = self.arm.length;
                    let places: Vec<f64> = self.targets.iter().filter_map(|t| t.s).map(|s| s / length).collect();
                    if solver.engine.watch(&places, solver.options.tol).is_ok() {
                        let rest = self.rest(&solver);
                        return Ok(State { solver, tensions, rest });
                    }
                    return Err(SensitivityError::Unsettled(f64::NAN).into());
                }
                Err(error) if attempt == 6 => return Err(error.into()),
                Err(_) => tensions.iter_mut().for_each(|t| *t *= 0.4),
            }
        }
        unreachable!("the loop returns at its last attempt")
    }

    /// Weighted distances to the targets, over L.
    fn rest(&self, solver: &Solver) -> Vec<f64> {
        let engine = &solver.engine;
        let (base, length) = (self.arm.base, self.arm.length);
        let mut out = Vec::with_capacity(3 * self.targets.len());
        for target in &self.targets {
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
    fn jacobian(&self, solver: &Solver) -> Option<Vec<Vec<f64>>> {
        let cables: Vec<Parameter> = (0..self.scale.len()).map(Parameter::Tension).collect();
        let mut quantities = Vec::new();
        let mut weights = Vec::new();
        for target in &self.targets {
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
    fn from(&self, start: &[f64], go_on: &dyn Fn() -> bool) -> Result<State, ReachError> {
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

    fn change(&self, a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).zip(&self.scale).fold(0.0, |m, ((a, b), scale)| f64::max(m, (a - b).abs() / scale))
    }

    /// Tensions of least effort that meet the targets to first order, or as much of the way as a step may go.
    fn towards_least_effort(&self, jacobian: &[Vec<f64>], state: &State) -> Option<Vec<f64>> {
        let distance = state.distance();
        let share = if distance > LONGEST { LONGEST / distance } else { 1.0 };
        let carried = |r: usize| jacobian.iter().zip(&state.tensions).map(|(column, t)| column[r] * t).sum::<f64>();
        let wanted: Vec<f64> = state.rest.iter().enumerate().map(|(r, rest)| carried(r) - share * rest).collect();
        least_effort(jacobian, &wanted, &self.most)
    }

    /// A damped least-squares step within the bounds: cables on a bound that they would leave stay there.
    fn damped(&self, jacobian: &[Vec<f64>], state: &State, damping: f64) -> Vec<f64> {
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
    fn step(&self, state: &State, next: &[f64], allowed: Option<f64>) -> Option<State> {
        let mut solver = state.solver.clone();
        solver.set_tensions(next).ok()?;
        solver.update().ok()?;
        let rest = self.rest(&solver);
        let better = State { solver, tensions: next.to_vec(), rest };
        let enough = allowed.unwrap_or((1.0 - 1e-6) * state.distance());
        (better.distance() <= enough).then_some(better)
    }

    fn read(&self, mut state: State) -> Result<Reached, ReachError> {
        let configuration = state.solver.configuration()?;
        let at_bound = |c: usize| {
            let near = 1e-9 * self.scale[c];
            if state.tensions[c] <= near {
                Some(Bound::Slack(c))
            } else {
                (self.most[c] - state.tensions[c] <= near).then_some(Bound::Most(c))
            }
        };
        let tip = configuration.tip();
        let on_the_path = configuration.arm.solve().is_ok_and(|other| {
            let other = other.tip();
            (other.x - tip.x).hypot(other.y - tip.y) < SAME * self.arm.length
        });
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
