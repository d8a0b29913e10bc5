//! Quasi-static loading: equilibria along any sequence of loads, each reached from the one before, with the snaps on
//! the way. An arm that snaps one way at one load snaps back at another: the answer depends on the way.

use super::after_snap::{AfterSnap, AfterSnapError, Landed, PAST, elsewhere, land};
use super::error::MotionError;
use super::rest::Rest;
use super::resting::Restless;
use crate::rod::arm::{Arm, ArmError};
use crate::rod::parameter::Parameter;
use crate::statics::configuration::{Configuration, Tip};
use crate::statics::equations::Change;
use crate::statics::phase::percent;
use crate::statics::snap::SnapBounds;
use crate::statics::solve::{Options, Solver};
use crate::statics::verdict::{SolveError, VerdictKind};

/// The most snaps on the way from one row to the next.
const MOST_SNAPS: usize = 50;

/// A snap on the way from one sequence of loads to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadingSnap {
    /// The share of the way from the loads before at the limit point, 0 to 1.
    pub share: f64,
    /// The tip there.
    pub before: Tip,
    /// The tip where the arm rests.
    pub after: Tip,
    /// How long that takes, as [`crate::SnapMotion::duration`], s.
    pub duration: f64,
    /// As [`crate::SnapMotion::on_curve`].
    pub on_curve: Option<Tip>,
}

impl LoadingSnap {
    /// How far the tip jumps, m.
    pub fn distance(&self) -> f64 {
        (self.after.x - self.before.x).hypot(self.after.y - self.before.y)
    }

    /// How far the tip turns, rad, never negative.
    pub fn angle(&self) -> f64 {
        (self.after.theta - self.before.theta).abs()
    }

    /// As [`crate::SnapMotion::lands_elsewhere`].
    pub fn lands_elsewhere(&self, length: f64) -> bool {
        elsewhere(self.after, self.on_curve, length)
    }
}

/// The equilibrium that the arm is in at given loads, and how it came there.
#[derive(Debug, Clone)]
pub struct LoadingStep {
    /// The shape.
    pub configuration: Configuration,
    /// The snaps since the loads before, in their order.
    pub snaps: Vec<LoadingSnap>,
}

/// Why there is no equilibrium at the next loads.
#[derive(Debug, Clone, thiserror::Error)]
pub enum LoadingError {
    /// There is none at the first loads.
    #[error(transparent)]
    Start(#[from] AfterSnapError),
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
    #[error("{} of the way from the loads before, {}{}", percent(*share), kind.phrase(), place(*s))]
    Limit {
        /// Which limit.
        kind: VerdictKind,
        /// The share of the way from the loads before, 0 to 1.
        share: f64,
        /// Where along the arm (m), if the limit is local.
        s: Option<f64>,
    },
    /// The arm snaps on the way, and its motion ends or is none.
    #[error("{} of the way from the loads before the arm snaps, and its motion is not known: {motion}", percent(*share))]
    Motion {
        /// The share of the way from the loads before, 0 to 1.
        share: f64,
        /// Why.
        motion: MotionError,
    },
    /// The arm snaps on the way and does not come to rest.
    #[error(
        "{} of the way from the loads before the arm snaps, and does not come to rest: after {time:.3} s its tip \
         still moves at {speed:.2e} m/s",
        percent(*share)
    )]
    NoRest {
        /// The share of the way from the loads before, 0 to 1.
        share: f64,
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
pub struct Loading {
    solver: Solver,
    tol: f64,
}

impl Loading {
    /// The arm at its first loads, where [`Arm::solve_after_snap`] has it, to a tip error of `tol` L.
    ///
    /// # Errors
    /// [`LoadingError::Start`], and [`LoadingError::Unsupported`] with friction of cables or an unstrained base.
    pub fn start(arm: &Arm, tol: f64) -> Result<(Self, AfterSnap), LoadingError> {
        if let Some(i) = arm.cables.iter().position(|cable| cable.friction > 0.0) {
            let reason = "cables with friction stick as they turn back, which loading leaves out";
            return Err(LoadingError::Unsupported { key: format!("cable[{i}].friction"), reason });
        }
        if arm.readings.support == crate::rod::readings::Support::UnstrainedBase {
            let reason = "only a clamped arm has equilibria that follow its loads";
            return Err(LoadingError::Unsupported { key: "model.support".to_owned(), reason });
        }
        let first = arm.solve_after_snap(tol)?;
        let snaps = SnapBounds { distance: 0.0, angle: 0.0 };
        let mut solver = Solver::new(arm, Options { tol, snaps }).map_err(AfterSnapError::Solve)?;
        let engine = solver.engine_mut();
        let dense = first.configuration.dense();
        engine.equations.clone_from(&dense.equations);
        engine.solution.clone_from(&dense.solution);
        Ok((Self { solver, tol }, first))
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
        arm.check()?;
        let kept = self.solver.clone();
        let outcome = self.follow(arm);
        if outcome.is_err() {
            self.solver = kept;
        }
        outcome
    }

    fn follow(&mut self, arm: &Arm) -> Result<LoadingStep, LoadingError> {
        let ways = ways(self.solver.arm(), arm)?;
        let (tol, base) = (self.tol, [arm.base.x, arm.base.y]);
        let (past, lowest) = (past(&ways), lowest(&ways));
        let engine = self.solver.engine_mut();
        (engine.equations.arm.base.x, engine.equations.arm.base.y) = (base[0], base[1]);
        let mut from = 0.0;
        let mut snaps: Vec<LoadingSnap> = Vec::new();
        if ways.is_empty() {
            let configuration = self.solver.resettle().map_err(|error| limit(&error, 1.0))?;
            return Ok(LoadingStep { configuration, snaps });
        }
        engine.equations.vary_together(ways);
        loop {
            match self.solver.solve_along_range([from, lowest]) {
                Ok(configuration) => return Ok(LoadingStep { configuration, snaps }),
                Err(SolveError::NoEquilibrium(no))
                    if no.verdict.kind == VerdictKind::LimitPoint && snaps.len() < MOST_SNAPS =>
                {
                    let share = no.verdict.load_fraction;
                    from = (share + past).min(1.0);
                    let landed =
                        land(self.solver.engine_mut(), &no, tol, |engine| engine.equations.set_range_fraction(from));
                    let Landed { before, rest: Rest { configuration, time }, on_curve } =
                        landed.map_err(|restless| match restless {
                            Restless::Motion(motion) => LoadingError::Motion { share, motion },
                            Restless::Moving { time, speed } => LoadingError::NoRest { share, time, speed },
                        })?;
                    snaps.push(LoadingSnap { share, before, after: configuration.tip(), duration: time, on_curve });
                    if from == 1.0 {
                        return Ok(LoadingStep { configuration, snaps });
                    }
                }
                Err(error) => return Err(limit(&error, from)),
            }
        }
    }
}

/// A verdict of the statics in terms of the way.
fn limit(error: &SolveError, from: f64) -> LoadingError {
    match error {
        SolveError::NoEquilibrium(no) => {
            LoadingError::Limit { kind: no.verdict.kind, share: no.verdict.load_fraction, s: no.verdict.s }
        }
        SolveError::Arm(error) => LoadingError::Arm(error.clone()),
        SolveError::Option { .. } => LoadingError::Limit { kind: VerdictKind::NotFound, share: from, s: None },
    }
}

/// The loads that may change.
fn loads(cables: usize) -> impl Iterator<Item = Parameter> {
    let of_cables = (0..cables).flat_map(|c| [Parameter::Tension(c), Parameter::Stroke(c)]);
    of_cables.chain([
        Parameter::FlowSpeed,
        Parameter::FlowDirection,
        Parameter::GravityAcceleration,
        Parameter::GravityDirection,
        Parameter::TipForce(0),
        Parameter::TipForce(1),
        Parameter::TipMoment,
        Parameter::TipFollower(0),
        Parameter::TipFollower(1),
        Parameter::BaseAngle,
    ])
}

/// What changes from one arm to another of the same kind.
fn ways(own: &Arm, arm: &Arm) -> Result<Vec<Change>, LoadingError> {
    let mut moved = own.clone();
    let mut out = Vec::new();
    for parameter in loads(arm.cables.len().min(own.cables.len())) {
        let commanded = |c: usize| own.cables[c].stroke.is_some();
        let acts = match parameter {
            Parameter::Tension(c) => !commanded(c),
            Parameter::Stroke(c) => commanded(c) && arm.cables[c].stroke.is_some(),
            Parameter::GravityAcceleration | Parameter::GravityDirection => {
                own.gravity.is_some() && arm.gravity.is_some()
            }
            _ => true,
        };
        let (Ok(from), Ok(to)) = (parameter.of(own), parameter.of(arm)) else { continue };
        if acts && from != to {
            out.push(Change { parameter, from, to });
            // It is a load of this arm.
            let _ = parameter.set(&mut moved, to);
        }
    }
    moved.base = arm.base;
    for (own, other) in moved.cables.iter_mut().zip(&arm.cables) {
        // Tensions of cables whose strokes are commanded follow from these.
        if own.stroke.is_some() && other.stroke.is_some() {
            own.tension = other.tension;
        }
    }
    if moved == *arm {
        return Ok(out);
    }
    let key = if moved.cables.iter().zip(&arm.cables).any(|(a, b)| a.stroke.is_some() != b.stroke.is_some()) {
        "cable.stroke"
    } else if moved.gravity.is_some() != arm.gravity.is_some() {
        "gravity"
    } else {
        "arm"
    };
    let reason =
        "only tensions or strokes of the same cables, stream, gravity, loads on the tip and the base may change";
    Err(LoadingError::Unsupported { key: key.to_owned(), reason })
}

/// The share of the way, at most 0, down to which the curve behind a limit point is followed: there the first load that
/// is not negative is nothing.
fn lowest(ways: &[Change]) -> f64 {
    /// How many ways back is far enough.
    const FAR: f64 = -100.0;
    let own = |way: &Change| match way.parameter {
        Parameter::Tension(_) | Parameter::FlowSpeed | Parameter::GravityAcceleration if way.to > way.from => {
            -way.from / (way.to - way.from)
        }
        _ => FAR,
    };
    ways.iter().map(own).fold(FAR, f64::max).min(0.0)
}

/// The share of the way by which loads are past a limit point while the arm moves: [`PAST`] of the largest load that
/// changes, so that it does not hang on how finely the way is cut.
fn past(ways: &[Change]) -> f64 {
    let own = |way: &Change| {
        let size = match way.parameter {
            // Angles have no size.
            Parameter::FlowDirection | Parameter::GravityDirection | Parameter::BaseAngle => 1.0,
            _ => way.from.abs().max(way.to.abs()),
        };
        PAST * size / (way.to - way.from).abs()
    };
    ways.iter().map(own).fold(f64::INFINITY, f64::min)
}
