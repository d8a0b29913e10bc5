//! What comes after a snap: where the path of the loads ends in a limit point, the arm moves from just past it until it
//! rests, and the path goes on from there.

use super::error::MotionError;
use super::landing::{Landed, Lands, MOST_SNAPS, PAST, Rest, elsewhere, land};
use super::ranged::{EVERY_SNAP, ErrorOf, Ranged, ShapeOf, TipOf};
use super::resting::Restless;
use crate::rod::arm::Arm;
use crate::spatial::{SpatialConfiguration, SpatialError, SpatialSolver, SpatialTip};
use crate::statics::configuration::{Configuration, Tip};
use crate::statics::path::traced::{Along, Traced as _};
use crate::statics::shape::Pose;
use crate::statics::snap::Snap;
use crate::statics::solve::{Options, Solver};
use crate::statics::verdict::{NoEquilibrium, Phase, SolveError, VerdictKind};

/// A snap whose motion was followed until the arm rested, in the plane or, with [`SpatialTip`], in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SnapMotion<T = Tip> {
    /// At which load, from where, and where the arm rests.
    pub snap: Snap<T>,
    /// How long it takes from rest at the limit point, with the loads 0.1 % of the whole past it, until the arm stays
    /// within 0.002 L of the shape in which it rests, s.
    pub duration: f64,
    /// The tip where the curve of equilibria leads on to at the same loads, which is where
    /// [`crate::Options::snaps`] without bounds lands; `None` where it does not lead on.
    pub on_curve: Option<T>,
}

impl<T: Pose> SnapMotion<T> {
    /// Whether the motion lands elsewhere than where the curve leads on to, for an arm of this length (m).
    ///
    /// ```
    /// use hydrostat::{Phase, Snap, SnapMotion, Tip};
    ///
    /// let at = |x| Tip { x, y: 0.0, theta: 0.0, alpha: 0.0 };
    /// let snap = Snap { phase: Phase::Loads, load_fraction: 0.5, before: at(0.1), after: at(0.15) };
    /// let motion = SnapMotion { snap, duration: 2.0, on_curve: Some(at(0.2)) };
    /// assert!(motion.lands_elsewhere(0.2));
    /// assert!(!SnapMotion { on_curve: None, ..motion }.lands_elsewhere(0.2), "there is nothing to compare with");
    /// ```
    pub fn lands_elsewhere(&self, length: f64) -> bool {
        elsewhere(self.snap.after, self.on_curve, length)
    }

    /// What happens, in a phrase with its numbers, for an arm of this length (m).
    pub fn message(&self, length: f64) -> String {
        let curve = match self.on_curve {
            _ if self.lands_elsewhere(length) => ", in another shape than the curve of equilibria",
            Some(_) => ", on the curve of equilibria",
            None => "; the curve of equilibria does not continue",
        };
        format!("{}; it rests after {:.3} s{curve}", self.snap.message(), self.duration)
    }
}

/// A snap in space whose motion was followed until the arm rested.
pub type SpatialSnapMotion = SnapMotion<SpatialTip>;

/// The equilibrium in which an arm rests whose loads grow slowly, after all snaps on its way.
#[derive(Debug, Clone)]
pub struct AfterSnap<C = Configuration, T = Tip> {
    /// The shape at the whole loads.
    pub configuration: C,
    /// The snaps on the way, in their order; none where the arm does not snap.
    pub snaps: Vec<SnapMotion<T>>,
}

/// Why there is no shape after a snap.
#[derive(Debug, Clone, thiserror::Error)]
pub enum AfterSnapError<E = SolveError> {
    /// The way to the loads ends at something else than a snap, or the arm or an option is refused.
    #[error("{0}")]
    Solve(E),
    /// The arm snaps, and is one that cannot move, or its motion ends.
    #[error("the arm snaps at {}, and its motion is not known: {motion}", phase.load_at(*load_fraction))]
    Motion {
        /// In which phase of loading.
        phase: Phase,
        /// The fraction of the phase's loads at the limit point.
        load_fraction: f64,
        /// Why.
        motion: MotionError,
    },
    /// The arm snaps and does not come to rest.
    #[error(
        "the arm snaps at {}, and does not come to rest: after {time:.3} s its tip still moves at {speed:.2e} m/s",
        phase.load_at(*load_fraction)
    )]
    NoRest {
        /// In which phase of loading.
        phase: Phase,
        /// The fraction of the phase's loads at the limit point.
        load_fraction: f64,
        /// For how long the motion was followed, s.
        time: f64,
        /// The speed of the tip then, m/s.
        speed: f64,
    },
}

impl<E> AfterSnapError<E> {
    /// Of the motion from a limit point.
    pub(super) fn of(restless: Restless, phase: Phase, load_fraction: f64) -> Self {
        match restless {
            Restless::Motion(motion) => Self::Motion { phase, load_fraction, motion },
            Restless::Moving { time, speed } => Self::NoRest { phase, load_fraction, time, speed },
        }
    }
}

impl Arm {
    /// The equilibrium in which this arm rests after its loads have grown slowly from nothing, as [`Arm::solve`] says,
    /// whatever snaps it makes on the way: at each limit point it moves, by its own `dynamics`, from the shape there
    /// with the loads 0.1 % of the whole past it, until it rests, and the path goes on from there. The tip position is
    /// good to `tol` L.
    ///
    /// ```
    /// use hydrostat::Arm;
    ///
    /// // An arm that lies against the stream, and snaps as the stream grows.
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.density = 1080.0;
    /// arm.dynamics.relaxation_time = 2.7e-3; // s
    /// arm.flow.speed = 0.4;
    /// arm.flow.direction = 3.0; // rad
    /// let found = arm.solve_after_snap(1e-8)?;
    /// assert_eq!(found.snaps.len(), 1);
    /// assert!(found.snaps[0].duration > 0.1 && found.snaps[0].snap.distance() > 0.1 * arm.length);
    /// # Ok::<(), hydrostat::AfterSnapError>(())
    /// ```
    ///
    /// # Errors
    /// [`AfterSnapError`]. Arms that need no motion need nothing to damp it.
    pub fn solve_after_snap(&self, tol: f64) -> Result<AfterSnap, AfterSnapError> {
        solve_after_snap::<Solver>(self, tol)
    }

    /// The equilibrium in space in which this arm rests after its loads have grown slowly from nothing, whatever snaps
    /// it makes on the way, as [`Arm::solve_after_snap`] has it in the plane. Cables have tensions: commanded strokes
    /// are refused where the arm snaps.
    ///
    /// # Errors
    /// [`AfterSnapError`]. Arms that need no motion need nothing to damp it.
    pub fn solve_after_snap_in_space(
        &self,
        tol: f64,
    ) -> Result<AfterSnap<SpatialConfiguration, SpatialTip>, AfterSnapError<SpatialError>> {
        solve_after_snap::<SpatialSolver>(self, tol)
    }
}

/// What a solver finds after snaps.
pub(super) type AfterSnapOf<S> = AfterSnap<ShapeOf<S>, TipOf<S>>;

/// The equilibrium at the whole loads of `arm`, with the motion from every limit point on the way.
pub(super) fn solve_after_snap<S: Ranged>(arm: &Arm, tol: f64) -> Result<AfterSnapOf<S>, AfterSnapError<ErrorOf<S>>> {
    let mut solver =
        S::new(arm, Options { snaps: EVERY_SNAP, ..Options::with_tol(tol) }).map_err(AfterSnapError::Solve)?;
    let mut motions: Vec<SnapMotion<TipOf<S>>> = Vec::new();
    let mut solved = solver.solve();
    loop {
        let before = |own: &mut Vec<Snap<TipOf<S>>>| drop(own.splice(0..0, motions.iter().map(|motion| motion.snap)));
        match solved {
            Ok(mut configuration) => {
                before(S::Engine::snaps_of(&mut configuration));
                return Ok(AfterSnap { configuration, snaps: motions });
            }
            Err(SolveError::NoEquilibrium(no)) if snaps_at(&no) && motions.len() < MOST_SNAPS => {
                let (motion, past) = follow(&mut solver, &no, tol)?;
                motions.push(motion);
                solved = solver.solve_on((no.verdict.phase, past));
            }
            Err(SolveError::NoEquilibrium(mut no)) => {
                before(&mut no.snaps);
                return Err(AfterSnapError::Solve(SolveError::NoEquilibrium(no)));
            }
            Err(error) => return Err(AfterSnapError::Solve(error)),
        }
    }
}

/// Whether a motion begins where the path ended.
fn snaps_at<C, T>(no: &NoEquilibrium<C, T>) -> bool {
    no.verdict.kind == VerdictKind::LimitPoint && no.last_good.is_some()
}

/// The motion from the limit point at which the path ended, with the fraction of the loads that it was at. The solver's
/// engine is left where the arm rests.
#[allow(clippy::type_complexity, reason = "names of what is there")]
fn follow<S: Ranged>(
    solver: &mut S,
    no: &NoEquilibrium<ShapeOf<S>, TipOf<S>>,
    tol: f64,
) -> Result<(SnapMotion<TipOf<S>>, f64), AfterSnapError<ErrorOf<S>>> {
    let (phase, load_fraction) = (no.verdict.phase, no.verdict.load_fraction);
    let past = (load_fraction + PAST).min(1.0);
    let engine = solver.engine_mut();
    let (last_good, after_snap) = (no.last_good.as_ref(), no.after_snap.as_ref());
    let landed = land(engine, last_good, after_snap, tol, |engine| engine.set(Along::Phase(phase), past));
    let Landed { before, rest: Rest { configuration, time }, on_curve } =
        landed.map_err(|restless| AfterSnapError::of(restless, phase, load_fraction))?;
    let snap = Snap { phase, load_fraction, before, after: S::Engine::tip_of(&configuration) };
    Ok((SnapMotion { snap, duration: time, on_curve }, past))
}
