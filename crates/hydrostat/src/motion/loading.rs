//! Quasi-static loading: equilibria along any sequence of loads, each reached from the one before, with the snaps on
//! the way. An arm that snaps one way at one load snaps back at another: the answer depends on the way.

use super::after_snap::{AfterSnap, AfterSnapError, AfterSnapOf, solve_after_snap};
use super::error::MotionError;
use super::landing::{Landed, Lands as _, MOST_SNAPS, Rest, elsewhere, land};
use super::ranged::{ErrorOf, Ranged, ShapeOf, TipOf, lowest, past, ways};
use super::resting::Restless;
use crate::rod::arm::{Arm, ArmError};
use crate::spatial::{SpatialConfiguration, SpatialError, SpatialSolver, SpatialTip};
use crate::statics::configuration::{Configuration, Tip};
use crate::statics::path::traced::{Along, Traced as _};
use crate::statics::phase::percent;
use crate::statics::shape::Pose;
use crate::statics::solve::Solver;
use crate::statics::verdict::{SolveError, Verdict, VerdictKind};

/// A snap on the way from one sequence of loads to the next: in the plane, or with [`SpatialTip`] in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadingSnap<T = Tip> {
    /// The fraction of the way from the loads before at the limit point, 0 to 1.
    pub fraction: f64,
    /// The tip there.
    pub before: T,
    /// The tip where the arm rests.
    pub after: T,
    /// How long that takes, as [`crate::SnapMotion::duration`], s.
    pub duration: f64,
    /// As [`crate::SnapMotion::on_curve`].
    pub on_curve: Option<T>,
}

impl<T: Pose> LoadingSnap<T> {
    /// How far the tip jumps, m.
    pub fn distance(&self) -> f64 {
        self.before.distance_to(&self.after)
    }

    /// How far the tip turns, rad, never negative.
    pub fn angle(&self) -> f64 {
        self.before.turn_to(&self.after)
    }

    /// As [`crate::SnapMotion::lands_elsewhere`].
    pub fn lands_elsewhere(&self, length: f64) -> bool {
        elsewhere(self.after, self.on_curve, length)
    }
}

/// The equilibrium that the arm is in at given loads, and how it came there.
#[derive(Debug, Clone)]
pub struct LoadingStep<C = Configuration, T = Tip> {
    /// The shape.
    pub configuration: C,
    /// The snaps since the loads before, in their order.
    pub snaps: Vec<LoadingSnap<T>>,
}

/// Why there is no equilibrium at the next loads.
#[derive(Debug, Clone, thiserror::Error)]
pub enum LoadingError<E = SolveError> {
    /// There is none at the first loads.
    #[error("{0}")]
    Start(AfterSnapError<E>),
    /// The loads make no arm.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// Something other than loads differs from the arm before, or what the arm has cannot be followed.
    #[error("`{key}`: {reason}")]
    Unsupported {
        /// Which key of the arm.
        key: String,
        /// Why.
        reason: &'static str,
    },
    /// The way to the loads ends at a limit of the arm.
    #[error("{} of the way from the loads before, {}{}", percent(*fraction), kind.phrase(), place(*s))]
    Limit {
        /// Which limit.
        kind: VerdictKind,
        /// The fraction of the way from the loads before, 0 to 1.
        fraction: f64,
        /// Where along the arm (m), if the limit is local.
        s: Option<f64>,
    },
    /// The arm snaps on the way, and its motion ends or is none.
    #[error("{} of the way from the loads before the arm snaps, and its motion is not known: {motion}", percent(*fraction))]
    Motion {
        /// The fraction of the way from the loads before, 0 to 1.
        fraction: f64,
        /// Why.
        motion: MotionError,
    },
    /// The arm snaps on the way and does not come to rest.
    #[error(
        "{} of the way from the loads before the arm snaps, and does not come to rest: after {time:.3} s its tip \
         still moves at {speed:.2e} m/s",
        percent(*fraction)
    )]
    NoRest {
        /// The fraction of the way from the loads before, 0 to 1.
        fraction: f64,
        /// For how long the motion was followed, s.
        time: f64,
        /// The speed of the tip then, m/s.
        speed: f64,
    },
}

fn place(s: Option<f64>) -> String {
    s.map_or_else(String::new, |s| format!(" at s = {s:.4} m"))
}

/// An arm under loads that change slowly.
///
/// ```
/// use hydrostat::{Arm, Loading};
///
/// // An arm in the stream, whose base is turned against it and back.
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.density = 1080.0;
/// arm.dynamics.relaxation_time = 2.7e-3; // s
/// arm.flow.speed = 0.2;
/// arm.flow.direction = std::f64::consts::PI;
/// arm.base.angle = 0.6;
/// let (mut loading, first) = Loading::start(&arm, 1e-8)?;
/// arm.base.angle = -0.6;
/// let there = loading.go_to(&arm)?;
/// assert_eq!(there.snaps.len(), 1, "it is blown over to the other side");
/// arm.base.angle = 0.6;
/// let back = loading.go_to(&arm)?;
/// assert_eq!(back.snaps.len(), 1);
/// let off = back.configuration.tip().theta - first.configuration.tip().theta;
/// assert!(off.abs() < 1e-6, "after a cycle it is where it was");
/// # Ok::<(), hydrostat::LoadingError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Loading<S = Solver> {
    solver: S,
    tol: f64,
}

/// An equilibrium on the way.
pub(super) type Step<S> = LoadingStep<ShapeOf<S>, TipOf<S>>;

impl Loading {
    /// The arm at its first loads, where [`Arm::solve_after_snap`] has it, to a tip error of `tol` L.
    ///
    /// # Errors
    /// [`LoadingError::Start`], and [`LoadingError::Unsupported`] with friction of cables or an unstrained base.
    pub fn start(arm: &Arm, tol: f64) -> Result<(Self, AfterSnap), LoadingError> {
        begin(arm, tol)
    }

    /// The arm at its present loads.
    pub fn arm(&self) -> &Arm {
        self.solver.arm()
    }

    /// Follows the equilibrium along the straight line from the present loads to those of `arm`, which differs in
    /// nothing else: tensions, strokes, stream, gravity, loads on the tip, place and angle of the base. Where it ends
    /// in a limit point the arm moves to where it rests, and the way goes on from there. After an error the loads are
    /// those before.
    ///
    /// # Errors
    /// [`LoadingError`].
    pub fn go_to(&mut self, arm: &Arm) -> Result<LoadingStep, LoadingError> {
        go_on(self, arm)
    }
}

impl Loading<SpatialSolver> {
    /// The arm in space at its first loads, where [`Arm::solve_after_snap_in_space`] has it.
    ///
    /// # Errors
    /// As [`Loading::start`].
    #[allow(clippy::type_complexity, reason = "names of what is there")]
    pub fn start_in_space(
        arm: &Arm,
        tol: f64,
    ) -> Result<(Self, AfterSnap<SpatialConfiguration, SpatialTip>), LoadingError<SpatialError>> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        begin(&arm, tol)
    }

    /// The arm at its present loads.
    pub fn arm(&self) -> &Arm {
        self.solver.arm()
    }

    /// [`Loading::go_to`] in space: the parts of directions and loads along e3 may change, too. Directions change along
    /// straight lines of their parts. Where the arm snaps, cables have tensions.
    ///
    /// # Errors
    /// [`LoadingError`].
    pub fn go_to(
        &mut self,
        arm: &Arm,
    ) -> Result<LoadingStep<SpatialConfiguration, SpatialTip>, LoadingError<SpatialError>> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        go_on(self, &arm)
    }
}

#[allow(clippy::type_complexity, reason = "names of what is there")]
fn begin<S: Ranged>(arm: &Arm, tol: f64) -> Result<(Loading<S>, AfterSnapOf<S>), LoadingError<ErrorOf<S>>> {
    if let Some(i) = arm.cables.iter().position(|cable| cable.friction > 0.0) {
        let reason = "cables with friction stick as they turn back, which loading leaves out";
        return Err(LoadingError::Unsupported { key: format!("cable[{i}].friction"), reason });
    }
    if arm.model.support == crate::rod::model_options::Support::UnstrainedBase {
        let reason = "only a clamped arm has equilibria that follow its loads";
        return Err(LoadingError::Unsupported { key: "model.support".to_owned(), reason });
    }
    let first = solve_after_snap::<S>(arm, tol).map_err(LoadingError::Start)?;
    let solver = S::at(arm, &first.configuration, tol).map_err(|e| LoadingError::Start(AfterSnapError::Solve(e)))?;
    Ok((Loading { solver, tol }, first))
}

fn go_on<S: Ranged>(loading: &mut Loading<S>, arm: &Arm) -> Result<Step<S>, LoadingError<ErrorOf<S>>> {
    arm.check()?;
    let kept = loading.solver.clone();
    let outcome = follow(loading, arm);
    if outcome.is_err() {
        loading.solver = kept;
    }
    outcome
}

fn follow<S: Ranged>(loading: &mut Loading<S>, arm: &Arm) -> Result<Step<S>, LoadingError<ErrorOf<S>>> {
    let Loading { solver, tol } = loading;
    let ways = ways(solver.arm(), arm).map_err(|(key, reason)| LoadingError::Unsupported { key, reason })?;
    let (past, lowest) = (past(&ways), lowest(&ways));
    solver.take_place_of_base(arm);
    let mut from = 0.0;
    let mut snaps = Vec::new();
    if ways.is_empty() {
        let configuration = solver.resettle().map_err(|error| limit::<S>(error, 1.0))?;
        return Ok(LoadingStep { configuration, snaps });
    }
    solver.vary_together(ways);
    loop {
        match solver.along_range([from, lowest]) {
            Ok(configuration) => return Ok(LoadingStep { configuration, snaps }),
            Err(SolveError::NoEquilibrium(no))
                if no.verdict.kind == VerdictKind::LimitPoint && snaps.len() < MOST_SNAPS =>
            {
                let fraction = no.verdict.load_fraction;
                from = (fraction + past).min(1.0);
                let engine = solver.engine_mut();
                let set = |engine: &mut S::Engine| engine.set(Along::Range, from);
                let landed = land(engine, no.last_good.as_ref(), no.after_snap.as_ref(), *tol, set);
                let Landed { before, rest: Rest { configuration, time }, on_curve } =
                    landed.map_err(|restless| match restless {
                        Restless::Motion(motion) => LoadingError::Motion { fraction, motion },
                        Restless::Moving { time, speed } => LoadingError::NoRest { fraction, time, speed },
                    })?;
                let after = S::Engine::tip_of(&configuration);
                snaps.push(LoadingSnap { fraction, before, after, duration: time, on_curve });
                if from == 1.0 {
                    return Ok(LoadingStep { configuration, snaps });
                }
            }
            Err(error) => return Err(limit::<S>(error, from)),
        }
    }
}

/// An error of the statics in terms of the way.
fn limit<S: Ranged>(error: ErrorOf<S>, from: f64) -> LoadingError<ErrorOf<S>> {
    match error {
        SolveError::NoEquilibrium(no) => {
            let Verdict { kind, load_fraction: fraction, s, .. } = no.verdict;
            LoadingError::Limit { kind, fraction, s }
        }
        SolveError::Arm(error) => LoadingError::Arm(error),
        SolveError::Option { .. } => LoadingError::Limit { kind: VerdictKind::NotFound, fraction: from, s: None },
    }
}
