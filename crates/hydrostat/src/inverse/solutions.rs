//! All that reaches targets: the search from several starts, and along lines from what it finds.

use super::in_plane::Goal;
use super::problem::{Reach, ReachError, ReachOptions, Target};
use super::reaching::Reaching;
use super::search::{Search, State};
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::sensitivity::check;
use crate::statics::solve::Solver;

/// Most steps along lines, and misses that lines are followed from.
const STEPS: usize = 600;
const MISSED: usize = 3;

/// Change of the tensions, over their scale, between starts that led to the same.
const SAME: f64 = 1e-5;

impl Arm {
    /// Tensions, from 0 to their largest, that bring the arm to `targets`; the tensions and strokes of the arm itself
    /// do not count.
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
        Search::<Solver>::new(self, Goal::Places(targets.to_vec()), options)?.run(options, &go_on)
    }

    /// [`Arm::reach`] by the lengths of the cables: of what is found the strokes are commanded that its tensions make.
    /// It is solved again with these, and its stability is that with lengths held.
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

    /// [`Arm::reach_by_strokes`] while `go_on`, which is asked every round, says so; then with what was found until
    /// then.
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn reach_by_strokes_while(
        &self,
        targets: &[Target],
        options: &ReachOptions,
        go_on: impl Fn() -> bool,
    ) -> Result<Reach, ReachError> {
        let mut search = Search::<Solver>::new(self, Goal::Places(targets.to_vec()), options)?;
        search.hold_lengths();
        search.run(options, &go_on)
    }

    /// Tensions of one cable, all others slack, that turn the tip section to the angle `alpha` (rad) against the
    /// centreline; distances are then angles, in rad.
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
        let mut search = Search::<Solver>::new(self, Goal::TipAngle(alpha), options)?;
        search.pull_only(cable);
        search.run(options, &|| true)
    }
}

impl<S: Reaching> Search<S> {
    #[expect(clippy::type_complexity, reason = "what the solver makes of an arm")]
    pub(super) fn run(
        &self,
        options: &ReachOptions,
        go_on: &dyn Fn() -> bool,
    ) -> Result<Reach<S::Shape, S::Place>, ReachError<S::Error>> {
        let mut found = Candidates { search: self, solutions: Vec::new(), missed: Vec::new(), failure: None };
        for start in self.starts() {
            if !go_on() || (!options.all && !found.solutions.is_empty()) {
                break;
            }
            found.look_from(&start, go_on);
        }
        if options.all || found.solutions.is_empty() {
            found.look_along_lines(options.all, go_on);
        }
        let Candidates { solutions, missed, failure, .. } = found;
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
struct Candidates<'a, S: Reaching> {
    search: &'a Search<S>,
    /// Different tensions that reach the targets.
    solutions: Vec<State<S>>,
    /// Different ones from which nothing leads nearer, the nearest first.
    missed: Vec<State<S>>,
    failure: Option<ReachError<S::Error>>,
}

impl<S: Reaching> Candidates<'_, S> {
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

    fn look_along(
        &mut self,
        from: &State<S>,
        direction: &[f64],
        all: bool,
        steps: &mut usize,
        go_on: &dyn Fn() -> bool,
    ) {
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
