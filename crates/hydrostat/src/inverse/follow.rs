//! Targets one after the other, each from the tensions of the last.

use super::conditions::ByTensions;
use super::effort::dot;
use super::in_plane::{Goal, SAME};
use super::in_space::SpatialTarget;
use super::problem::{Reach, ReachError, ReachOptions, Target};
use super::reaching::Reaching;
use super::search::{STILL, Search, State};
use crate::rod::arm::Arm;
use crate::spatial::{SpatialError, SpatialSolver};
use crate::statics::configuration::Tip;
use crate::statics::sensitivity::SensitivityError;
use crate::statics::solve::Solver;

/// Most rounds a target.
const ROUNDS: usize = 12;

/// The fraction of a distance that a round may leave before the jacobian is taken anew.
const SLOW: f64 = 0.1;

/// How far (tensions over their scale) more cables than conditions go towards their least effort a target, beyond what
/// the target takes: in its first round, whose error the others mend.
const SLIDE: f64 = 0.02;

/// How far (over L) the arm may end from where its derivatives lead before it has jumped to another branch.
const JUMP: f64 = 0.1;

/// Damping of a step, over the largest square of a column of the jacobian: where nothing speaks against it. A step that
/// leads no nearer takes more, one that does takes less again.
const DAMPING: f64 = 1e-9;

/// The least part of a change of the tensions that is tried on its own.
const LEAST: f64 = 1e-2;

/// Follows a path of targets.
///
/// With more cables than conditions tensions are those of least effort, or on their way there: from others they go a
/// little with every target, since shapes on the way have to stay at the targets.
///
/// ```
/// use hydrostat::{Arm, Cable, Follower, Profile, ReachOptions, Target};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3));
/// arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1));
/// let tip = arm.solve()?.tip();
/// let mut follower = Follower::new(&arm, &[Target::tip(tip.x, tip.y)], &ReachOptions::default())?;
/// for step in 1..=10 {
///     let target = Target::tip(tip.x, tip.y - 2e-4 * f64::from(step)); // m
///     let found = follower.follow(&[target])?;
///     assert!(found.reached && !found.jumped);
/// }
/// # Ok::<(), hydrostat::ReachError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Follower {
    inner: Following<Solver>,
}

/// [`Follower`] of an arm in space.
///
/// ```
/// use hydrostat::{Arm, Cable, Profile, ReachOptions, Space, SpatialFollower, SpatialTarget};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// for k in 0..3 {
///     let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
///     arm.cables.push(Cable::new(format!("{k}"), Profile::linear(0.005, 0.001)).at_angle(angle).pulled(0.1));
/// }
/// arm.space = Some(Space::default());
/// let [x, y, z] = [0.2447, 0.0, 0.0]; // m, near the tip
/// let mut follower = SpatialFollower::new(&arm, &[SpatialTarget::tip([x, y, z])], &ReachOptions::default())?;
/// let found = follower.follow(&[SpatialTarget::tip([x, y + 1e-3, z - 1e-3])])?;
/// assert!(!found.jumped && found.tensions.len() == 3);
/// # Ok::<(), hydrostat::ReachError<hydrostat::SpatialError>>(())
/// ```
#[derive(Debug, Clone)]
pub struct SpatialFollower {
    inner: Following<SpatialSolver>,
}

/// What both do.
#[derive(Debug, Clone)]
struct Following<S: Reaching> {
    search: Search<S>,
    state: State<S>,
    slopes: ByTensions,
}

/// Where a follower got to.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed<T = Tip> {
    /// N.
    pub tensions: Vec<f64>,
    /// The tip; of an arm in space its place, m.
    pub tip: T,
    /// Root of the weighted sum of squared distances to the targets, over L.
    pub distance: f64,
    /// Whether that is within the tolerance.
    pub reached: bool,
    /// Whether the arm went to another branch of its equilibria on the way: small changes of the tensions lead neither
    /// there nor back, or the arm ended elsewhere than its derivatives lead.
    pub jumped: bool,
    /// Solves that it took.
    pub solves: usize,
}

impl Follower {
    /// From the tensions of `arm`, or, where they do not reach the first targets, from the least effort that does.
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn new(arm: &Arm, targets: &[Target], options: &ReachOptions) -> Result<Self, ReachError> {
        let search = Search::<Solver>::new(arm, Goal::Places(targets.to_vec()), options)?;
        Ok(Self { inner: Following::new(search, || Ok(best(arm.reach(targets, options)?)))? })
    }

    /// Goes to the next targets, which have to be for the same places as the first.
    ///
    /// Where they cannot be reached, or derivatives end (at a limit point), the arm stays as near as it came, and the
    /// next targets are followed from there.
    ///
    /// # Errors
    /// [`ReachError::Target`] for other places, and for targets that are none.
    pub fn follow(&mut self, targets: &[Target]) -> Result<Followed, ReachError> {
        let places = |targets: &[Target]| targets.iter().map(|t| (t.s, t.angle.is_some())).collect::<Vec<_>>();
        let search = &mut self.inner.search;
        match &mut search.goal {
            Goal::Places(own)
                if places(own) == places(targets) && targets.iter().all(|target| target.is_for(&search.arm)) =>
            {
                own.clear();
                own.extend_from_slice(targets);
            }
            _ => return Err(ReachError::Target),
        }
        let went = self.inner.follow();
        let tip = self.inner.state.solver.tip()?;
        Ok(self.inner.followed(tip, went))
    }
}

impl SpatialFollower {
    /// As [`Follower::new`].
    ///
    /// # Errors
    /// [`ReachError`].
    pub fn new(arm: &Arm, targets: &[SpatialTarget], options: &ReachOptions) -> Result<Self, ReachError<SpatialError>> {
        let search = Search::<SpatialSolver>::new(arm, targets.to_vec(), options)?;
        Ok(Self { inner: Following::new(search, || Ok(best(arm.reach_in_space(targets, options)?)))? })
    }

    /// As [`Follower::follow`].
    ///
    /// # Errors
    /// [`ReachError::Target`] for other places, and for targets that are none.
    pub fn follow(&mut self, targets: &[SpatialTarget]) -> Result<Followed<[f64; 3]>, ReachError<SpatialError>> {
        let places =
            |targets: &[SpatialTarget]| targets.iter().map(|t| (t.s, t.direction.is_some())).collect::<Vec<_>>();
        let Search { goal, arm, .. } = &mut self.inner.search;
        if places(goal) != places(targets) || !targets.iter().all(|target| target.is_for(arm)) {
            return Err(ReachError::Target);
        }
        targets.clone_into(goal);
        let went = self.inner.follow();
        let arm = &self.inner.search.arm;
        let (place, _) = self.inner.state.solver.pose_of(1.0);
        let tip = [0, 1, 2].map(|k| arm.base_place(k).unwrap_or_default() + arm.length * place[k]);
        Ok(self.inner.followed(tip, went))
    }
}

/// The tensions of least effort, or those that come closest.
fn best<C, P>(found: Reach<C, P>) -> Option<Vec<f64>> {
    found.solutions.into_iter().next().or(found.closest).map(|one| one.tensions)
}

/// How a target was gone to.
#[derive(Debug, Clone, Copy)]
struct Went {
    jumped: bool,
    solves: usize,
}

impl<S: Reaching> Following<S> {
    /// From the tensions of the arm, or where these do not reach the targets from those of `elsewhere`.
    fn new(
        search: Search<S>,
        elsewhere: impl FnOnce() -> Result<Option<Vec<f64>>, ReachError<S::Error>>,
    ) -> Result<Self, ReachError<S::Error>> {
        let own: Vec<f64> = search.arm.cables.iter().map(|cable| cable.tension).collect();
        let mut state = search.begin(&own)?;
        if state.distance() > search.tol
            && let Some(tensions) = elsewhere()?
        {
            state = search.begin(&tensions)?;
        }
        let slopes = search.slopes(&state.solver).ok_or(SensitivityError::Singular)?;
        Ok(Self { search, state, slopes })
    }

    fn followed<T>(&self, tip: T, Went { jumped, solves }: Went) -> Followed<T> {
        let distance = self.state.distance();
        let reached = distance <= self.search.tol;
        Followed { tensions: self.state.tensions.clone(), tip, distance, reached, jumped, solves }
    }

    /// Goes to the targets of the search.
    fn follow(&mut self) -> Went {
        self.state.rest = self.search.rest(&self.state.solver);
        let (mut jumped, mut solves, mut fresh) = (false, 0, false);
        // After a step that led no nearer, with the jacobian of where it began: shorter ones.
        let mut careful = false;
        let mut damping = DAMPING;
        while self.state.distance() > self.search.tol && solves < ROUNDS {
            let before = self.state.distance();
            let wanted = self.next(damping, careful, solves == 0);
            if self.search.change(&wanted, &self.state.tensions) < STILL {
                break;
            }
            solves += 1;
            let Some((next, another_branch)) = self.at(&wanted).filter(|(next, _)| next.distance() < before) else {
                // No nearer: from here again with the jacobian of here, and shorter steps.
                damping = if fresh { (100.0 * damping).max(1e-4) } else { damping };
                careful |= fresh;
                if !self.renew() {
                    break;
                }
                fresh = true;
                continue;
            };
            damping = (0.01 * damping).max(DAMPING);
            let last = std::mem::replace(&mut self.state, next);
            let change: Vec<f64> = self.state.tensions.iter().zip(&last.tensions).map(|(a, b)| a - b).collect();
            let off = led_astray(&self.slopes.rest, &change, &last.rest, &self.state.rest);
            jumped |= another_branch || dot(&off, &off).sqrt() > JUMP;
            let after = self.state.distance();
            if after > self.search.tol && (another_branch || after > SLOW * before) {
                if !self.renew() {
                    break;
                }
                fresh = true;
                continue;
            }
            fresh = false;
            // Broyden's update.
            let scale = &self.search.scale;
            let square: f64 = change.iter().zip(scale).map(|(d, s)| (d / s) * (d / s)).sum();
            let of_strokes = led_astray(&self.slopes.strokes, &change, &last.strokes, &self.state.strokes);
            for (columns, off) in [(&mut self.slopes.rest, off), (&mut self.slopes.strokes, of_strokes)] {
                for ((column, d), s) in columns.iter_mut().zip(&change).zip(scale) {
                    for (v, off) in column.iter_mut().zip(&off) {
                        *v += off * d / (s * s * square);
                    }
                }
            }
        }
        Went { jumped, solves }
    }

    /// The arm at other tensions, changed by what strokes are too long there, and whether that is on another branch.
    fn at(&self, tensions: &[f64]) -> Option<(State<S>, bool)> {
        let mut tensions = tensions.to_vec();
        let mut solver = self.state.solver.clone();
        let mut another_branch = false;
        self.search.pull(&mut solver, &mut tensions, &self.slopes, |solver, tensions| {
            another_branch |= go(solver, tensions, &self.state.solver)?;
            Some(())
        })?;
        Some((self.search.state(solver, tensions), another_branch))
    }

    /// Tensions that meet the targets to first order: those of least effort, or, where these are far, the nearest, in
    /// the `first` round a little on the way there.
    fn next(&self, damping: f64, careful: bool, first: bool) -> Vec<f64> {
        let (search, state) = (&self.search, &self.state);
        let nearest = || search.damped(&self.slopes, state, damping);
        if careful {
            return nearest();
        }
        let Some(least) = search.towards_least_effort(&self.slopes, state) else { return nearest() };
        if state.tensions.len() <= state.rest.len() {
            return least;
        }
        let nearest = nearest();
        let far = search.change(&least, &nearest);
        let fraction = match far {
            far if far <= SLIDE => 1.0,
            far if first => SLIDE / far,
            _ => return nearest,
        };
        nearest.iter().zip(&least).map(|(near, least)| near + fraction * (least - near)).collect()
    }

    /// Derivatives of here, if there are any.
    fn renew(&mut self) -> bool {
        let found = self.search.slopes(&self.state.solver);
        let is_some = found.is_some();
        self.slopes = found.unwrap_or_else(|| self.slopes.clone());
        is_some
    }
}

/// By how much values after a change are off from where their derivatives lead.
fn led_astray(columns: &[Vec<f64>], change: &[f64], before: &[f64], after: &[f64]) -> Vec<f64> {
    let led = |r: usize| columns.iter().zip(change).map(|(column, d)| column[r] * d).sum::<f64>();
    (0..after.len()).map(|r| after[r] - before[r] - led(r)).collect()
}

/// Solves at other tensions, from `kept`: in parts where one is too far, and where none lead there, as if nothing had
/// been solved before. Whether that is another branch, which does not lead back. `None` where there is no equilibrium.
fn go<S: Reaching>(solver: &mut S, tensions: &[f64], kept: &S) -> Option<bool> {
    solver.pull(tensions)?;
    if solver.settle_warm().is_some() {
        return Some(false);
    }
    if let Some(led) = led_to(kept.clone(), tensions) {
        *solver = led;
        return Some(false);
    }
    solver.settle()?;
    let there = kept.tip_pose();
    let back = led_to(solver.clone(), &kept.tensions()).map(|back| back.tip_pose());
    Some(!back.is_some_and(|back| back.iter().zip(there).all(|(a, b)| (a - b).abs() < SAME)))
}

/// To other tensions by small changes, on one branch.
fn led_to<S: Reaching>(mut solver: S, tensions: &[f64]) -> Option<S> {
    let from = solver.tensions();
    let (mut done, mut part) = (0.0, 0.5);
    while done < 1.0 {
        if part < LEAST {
            return None;
        }
        let to = f64::min(done + part, 1.0);
        let mut next = solver.clone();
        let between: Vec<f64> =
            from.iter().zip(tensions).map(|(a, b)| if to < 1.0 { a + to * (b - a) } else { *b }).collect();
        next.pull(&between)?;
        if next.settle_warm().is_some() {
            (solver, done) = (next, to);
        } else {
            part *= 0.5;
        }
    }
    Some(solver)
}
