//! Targets one after the other, each from the tensions of the last.

use super::effort::dot;
use super::search::{Goal, STILL, Search, State};
use super::{ReachError, ReachOptions, Reached, Target};
use crate::arm::Arm;
use crate::configuration::Tip;
use crate::sensitivity::SensitivityError;

/// Most rounds a target.
const ROUNDS: usize = 12;

/// The share of a distance that a round may leave before the jacobian is taken anew.
const SLOW: f64 = 0.1;

/// How far (tensions over their scale) more cables than conditions go towards their least effort a target, beyond what the target takes.
const SLIDE: f64 = 0.02;

/// How far (over L) the arm may end from where its derivatives lead before it has jumped to another branch.
const JUMP: f64 = 0.1;

/// Follows a path of targets.
///
/// With more cables than conditions tensions are those of least effort, or on their way there: from others they go a little with every
/// target, since shapes on the way have to stay at the targets.
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
    search: Search,
    state: State,
    jacobian: Vec<Vec<f64>>,
}

/// Where a follower got to.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// N.
    pub tensions: Vec<f64>,
    /// The tip.
    pub tip: Tip,
    /// Root of the weighted sum of squared distances to the targets, over L.
    pub distance: f64,
    /// Whether that is within the tolerance.
    pub reached: bool,
    /// Whether the arm went to another branch of its equilibria on the way: the determinant changed its sign, or the arm ended elsewhere
    /// than its derivatives lead.
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
        let search = Search::new(arm, Goal::Places(targets.to_vec()), options)?;
        let own: Vec<f64> = arm.cables.iter().map(|cable| cable.tension).collect();
        let mut state = search.begin(&own)?;
        if state.distance() > search.tol {
            let found = arm.reach(targets, options)?;
            if let Some(Reached { tensions, .. }) = found.solutions.into_iter().next().or(found.closest) {
                state = search.begin(&tensions)?;
            }
        }
        let jacobian = search.jacobian(&state.solver).ok_or(SensitivityError::Singular)?;
        Ok(Self { search, state, jacobian })
    }

    /// Goes to the next targets, which have to be for the same places as the first.
    ///
    /// Where they cannot be reached the arm stays as near as it came.
    ///
    /// # Errors
    /// [`ReachError::Target`] for other places, [`ReachError::Solve`] where the arm is lost.
    pub fn follow(&mut self, targets: &[Target]) -> Result<Followed, ReachError> {
        let places = |targets: &[Target]| targets.iter().map(|t| (t.s, t.angle.is_some())).collect::<Vec<_>>();
        match &mut self.search.goal {
            Goal::Places(own) if places(own) == places(targets) && targets.iter().all(|t| (t.x + t.y).is_finite()) => {
                own.clear();
                own.extend_from_slice(targets);
            }
            _ => return Err(ReachError::Target),
        }
        self.state.rest = self.search.rest(&self.state.solver);
        let sign = self.state.solver.engine.determinant().sign;
        let (mut jumped, mut solves, mut fresh) = (false, 0, false);
        // After a step that led no nearer, with the jacobian of where it began: shorter ones.
        let mut careful = false;
        let mut damping = 1e-9;
        while self.state.distance() > self.search.tol && solves < ROUNDS {
            let before = self.state.distance();
            let next = self.next(damping, careful);
            let change: Vec<f64> = next.iter().zip(&self.state.tensions).map(|(a, b)| a - b).collect();
            if self.search.change(&next, &self.state.tensions) < STILL {
                break;
            }
            let kept = self.state.tensions.clone();
            solves += 1;
            let solver = &mut self.state.solver;
            let moved = solver.set_tensions(&next).and_then(|()| solver.update());
            let rest = moved.ok().map(|_| self.search.rest(solver));
            let Some(rest) = rest.filter(|rest| dot(rest, rest).sqrt() < before) else {
                // No nearer: back, with the jacobian of here, and shorter steps.
                solver.set_tensions(&kept)?;
                solver.update()?;
                damping = if fresh { (100.0 * damping).max(1e-4) } else { damping };
                careful |= fresh;
                self.renew()?;
                fresh = true;
                continue;
            };
            // Where the derivatives lead, and by how much they were off: Broyden's update.
            let off: Vec<f64> = (0..rest.len())
                .map(|r| {
                    let led: f64 = self.jacobian.iter().zip(&change).map(|(column, d)| column[r] * d).sum();
                    rest[r] - self.state.rest[r] - led
                })
                .collect();
            jumped |= dot(&off, &off).sqrt() > JUMP;
            (self.state.rest, self.state.tensions) = (rest, next);
            let after = self.state.distance();
            if after > self.search.tol && after > SLOW * before {
                self.renew()?;
                fresh = true;
                continue;
            }
            fresh = false;
            let scale = &self.search.scale;
            let square: f64 = change.iter().zip(scale).map(|(d, s)| (d / s) * (d / s)).sum();
            for ((column, d), s) in self.jacobian.iter_mut().zip(&change).zip(scale) {
                for (v, off) in column.iter_mut().zip(&off) {
                    *v += off * d / (s * s * square);
                }
            }
        }
        let engine = &self.state.solver.engine;
        jumped |= engine.determinant().sign != sign;
        let tip = self.state.solver.tip()?;
        let distance = self.state.distance();
        let reached = distance <= self.search.tol;
        Ok(Followed { tensions: self.state.tensions.clone(), tip, distance, reached, jumped, solves })
    }

    /// Tensions that meet the targets to first order: those of least effort, or, where these are far, some on the way there from the nearest.
    fn next(&self, damping: f64, careful: bool) -> Vec<f64> {
        let (search, state) = (&self.search, &self.state);
        let nearest = || search.damped(&self.jacobian, state, damping);
        if careful {
            return nearest();
        }
        let Some(least) = search.towards_least_effort(&self.jacobian, state) else { return nearest() };
        if state.tensions.len() <= state.rest.len() {
            return least;
        }
        let nearest = nearest();
        let far = search.change(&least, &nearest);
        let share = if far > SLIDE { SLIDE / far } else { 1.0 };
        nearest.iter().zip(&least).map(|(near, least)| near + share * (least - near)).collect()
    }

    fn renew(&mut self) -> Result<(), ReachError> {
        self.jacobian = self.search.jacobian(&self.state.solver).ok_or(SensitivityError::Singular)?;
        Ok(())
    }
}
