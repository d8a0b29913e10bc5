//! Inverse kinetics: the tensions that bring tip, or other places, to targets.
//!
//! The distances to the targets, over L, are made small by Newton's method on the tensions, with the exact jacobian
//! (`sensitivity`) on warm solves. A round asks for the least effort |T|^2 among the tensions within their bounds
//! that meet the targets to first order (`reach/effort`); where there are none, or they lead no nearer, it takes a damped least-squares step
//! within the bounds. Strokes have theirs, too (`reach/strokes`). Several starts find several answers, and, of as many cables as conditions, lines through the
//! target (`reach/lines`) the others, across folds of the map from tensions to places.

mod boundary;
mod effort;
mod folds;
mod follow;
mod lines;
mod search;
mod strokes;

use self::search::{Goal, Search, State};
use crate::arm::Arm;
use crate::configuration::{Configuration, Station};
use crate::parameter::Parameter;
use crate::sensitivity::{SensitivityError, check};
use crate::stability::Stability;
use crate::verdict::SolveError;

pub use self::boundary::{Boundary, BoundaryKind, BoundaryOptions, BoundaryPiece, BoundaryPoint, BoundaryProgress};
pub use self::follow::{Followed, Follower};

/// Most steps along lines, and misses that lines are followed from.
const STEPS: usize = 600;
const MISSED: usize = 3;

/// Change of the tensions, over their scale, between starts that led to the same.
const SAME: f64 = 1e-5;

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
    /// Weight of its distance among those of several targets, from 1e-9 to 1e9.
    pub weight: f64,
}

impl Target {
    /// The tip at (x, y), m.
    pub fn tip(x: f64, y: f64) -> Self {
        Self { s: None, x, y, angle: None, weight: 1.0 }
    }

    /// Whether squares of its distances are numbers.
    fn is_for(&self, arm: &Arm) -> bool {
        /// Lengths of the arm.
        const FURTHEST: f64 = 1e6;
        let near = [self.x - arm.base.x, self.y - arm.base.y].iter().all(|far| far.abs() <= FURTHEST * arm.length);
        near && self.angle.is_none_or(f64::is_finite) && (1e-9..=1e9).contains(&self.weight)
    }
}

/// How tensions are looked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ReachOptions {
    /// The largest tension of every cable, N; of this and the cable's own the smaller counts.
    pub max_tension: Option<f64>,
    /// The largest stroke of every cable that pulls, m: how far it can be wound in.
    pub max_stroke: Option<f64>,
    /// Distance over L at which a target is reached, in [1e-10, 1e-2].
    pub tol: f64,
    /// Whether to look from all starts, and along lines from what they find; else the first that reaches the target ends the search.
    pub all: bool,
}

impl Default for ReachOptions {
    fn default() -> Self {
        Self { max_tension: None, max_stroke: None, tol: 1e-8, all: true }
    }
}

/// A bound that tensions lie on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bound {
    /// The cable is slack, and would have to push.
    Slack(usize),
    /// The cable has its largest tension.
    Most(usize),
    /// The cable is wound in as far as it can be.
    Stroke(usize),
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
    /// Whether a solve at these tensions (or at the strokes that they make), along the path of `docs/model.md`, leads to this shape.
    pub on_the_path: bool,
    /// `None` where it is not established.
    pub stability: Option<Stability>,
    /// The arm at the places of targets that are not for the tip, in the order of the targets.
    pub places: Vec<Station>,
    /// The shape; with strokes commanded where they hold it and a solve leads here.
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
    /// No targets, or one that is no number, or out of all bounds.
    #[error("expected targets within a million lengths of the arm, with weights from 1e-9 to 1e9")]
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
        Search::new(self, Goal::Places(targets.to_vec()), options)?.run(options, &go_on)
    }

    /// [`Arm::reach`] by the lengths of the cables: of what is found the strokes are commanded that its tensions make. It is
    /// solved again with these, and its stability is that with lengths held.
    ///
    /// # Errors
    /// [`ReachError`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Profile, ReachOptions, Target};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    /// arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    /// let found = arm.reach_by_strokes(&[Target::tip(0.182, 0.078)], &ReachOptions::default())?;
    /// let best = &found.solutions[0].configuration;
    /// assert!(best.arm.cables.iter().all(|cable| cable.stroke.is_some()));
    /// assert!((best.tip().x - 0.182).hypot(best.tip().y - 0.078) < 1e-8);
    /// # Ok::<(), hydrostat::ReachError>(())
    /// ```
    pub fn reach_by_strokes(&self, targets: &[Target], options: &ReachOptions) -> Result<Reach, ReachError> {
        self.reach_by_strokes_while(targets, options, || true)
    }

    /// [`Arm::reach_by_strokes`] while `go_on`, which is asked every round, says so; then with what was found until then.
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn reach_by_strokes_while(
        &self,
        targets: &[Target],
        options: &ReachOptions,
        go_on: impl Fn() -> bool,
    ) -> Result<Reach, ReachError> {
        let mut search = Search::new(self, Goal::Places(targets.to_vec()), options)?;
        search.hold_lengths();
        search.run(options, &go_on)
    }

    /// Tensions of one cable, all others slack, that turn the tip section to the angle `alpha` (rad) against the centreline; distances
    /// are then angles, in rad.
    ///
    /// # Errors
    /// [`ReachError`].
    ///
    /// ```
    /// use hydrostat::{Arm, Cable, Profile, ReachOptions};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    /// let found = arm.reach_tip_angle(0, 0.01, &ReachOptions::default())?;
    /// let tip = found.solutions[0].configuration.tip();
    /// assert!((tip.alpha - 0.01).abs() < 1e-7);
    /// # Ok::<(), hydrostat::ReachError>(())
    /// ```
    pub fn reach_tip_angle(&self, cable: usize, alpha: f64, options: &ReachOptions) -> Result<Reach, ReachError> {
        check(self, &[Parameter::Tension(cable)], &[])?;
        let mut search = Search::new(self, Goal::TipAngle(alpha), options)?;
        search.pull_only(cable);
        search.run(options, &|| true)
    }
}

impl Search {
    fn run(&self, options: &ReachOptions, go_on: &dyn Fn() -> bool) -> Result<Reach, ReachError> {
        let mut found = Found { search: self, solutions: Vec::new(), missed: Vec::new(), failure: None };
        for start in self.starts() {
            if !go_on() || (!options.all && !found.solutions.is_empty()) {
                break;
            }
            found.look_from(&start, go_on);
        }
        if options.all || found.solutions.is_empty() {
            found.look_along_lines(options.all, go_on);
        }
        let Found { solutions, missed, failure, .. } = found;
        let mut out = Reach { solutions: Vec::new(), closest: None };
        for state in solutions {
            out.solutions.push(self.read(state)?);
        }
        out.solutions.sort_by(|a, b| a.effort.total_cmp(&b.effort));
        if out.solutions.is_empty() {
            out.closest = match (missed.into_iter().next(), failure) {
                (Some(state), _) => Some(self.read(state)?),
                (None, Some(failure)) => return Err(failure),
                (None, None) => None,
            };
        }
        Ok(out)
    }
}

/// What a search has found so far.
struct Found<'a> {
    search: &'a Search,
    /// Different tensions that reach the targets.
    solutions: Vec<State>,
    /// Different ones from which nothing leads nearer, the nearest first.
    missed: Vec<State>,
    failure: Option<ReachError>,
}

impl Found<'_> {
    fn look_from(&mut self, start: &[f64], go_on: &dyn Fn() -> bool) {
        let state = match self.search.from(start, go_on) {
            Ok(state) => state,
            Err(error) => {
                self.failure = Some(error);
                return;
            }
        };
        let reached = state.distance() <= self.search.tol;
        let list = if reached { &mut self.solutions } else { &mut self.missed };
        let search = self.search;
        if list.iter().any(|own| search.change(&own.tensions, &state.tensions) < SAME) {
            return;
        }
        // The same solution, as far as the tolerance tells: that of less effort stays.
        match list.iter_mut().find(|own| reached && search.joined(own, &state)) {
            Some(own) if state.effort() < own.effort() => *own = state,
            Some(_) => {}
            None => list.push(state),
        }
        self.missed.sort_by(|a, b| a.distance().total_cmp(&b.distance()));
    }

    /// Along lines through the targets: from the nearest misses, until something is found, and from all that is found.
    fn look_along_lines(&mut self, all: bool, go_on: &dyn Fn() -> bool) {
        let mut steps = STEPS;
        for k in 0..self.missed.len().min(MISSED) {
            if !self.solutions.is_empty() {
                break;
            }
            let state = self.missed[k].clone();
            self.look_along(&state, &state.rest, all, &mut steps, go_on);
        }
        let mut k = 0;
        while all && k < self.solutions.len() {
            let state = self.solutions[k].clone();
            if let Some(direction) = self.search.stiffest(&state) {
                self.look_along(&state, &direction, all, &mut steps, go_on);
            }
            k += 1;
        }
    }

    fn look_along(&mut self, from: &State, direction: &[f64], all: bool, steps: &mut usize, go_on: &dyn Fn() -> bool) {
        if !self.search.has_lines(from) {
            return;
        }
        let mut more = || {
            *steps = steps.saturating_sub(1);
            *steps > 0 && go_on()
        };
        for start in self.search.along(from, direction, &mut more) {
            if go_on() && (all || self.solutions.is_empty()) {
                self.look_from(&start, go_on);
            }
        }
    }
}
