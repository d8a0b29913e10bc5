//! What paths are made of: points with their events, branches and their ends.

use crate::rod::arm::Arm;
use crate::rod::model_options::Support;
use crate::rod::parameter::{Parameter, Refused};
use crate::statics::configuration::Configuration;
use crate::statics::stability::Stability;
use crate::statics::verdict::{SolveError, VerdictKind};

/// How a path is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathOptions {
    /// Error of the tip position over L that is kept at every point, in [1e-7, 1e-3].
    pub tol: f64,
    /// Longest step: root mean square of the change of theta along the arm (rad), joined with the change of the
    /// parameter over its range. In [0.001, 0.4].
    pub longest: f64,
    /// Most points.
    pub most: usize,
    /// Whether to follow the branches that cross at bifurcations, too.
    pub branches: bool,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self { tol: 1e-6, longest: 0.2, most: 1000, branches: false }
    }
}

/// What is special about a point of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Event {
    /// The parameter turns back: beyond it this shape has no neighbour, and the arm snaps.
    LimitPoint,
    /// Another branch crosses.
    Bifurcation,
    /// The cable of this index, whose stroke is commanded, goes slack.
    Slack(usize),
    /// The cable of this index, whose stroke is commanded, is taken up.
    Taut(usize),
}

impl Event {
    /// The name in results: `limit_point`, `bifurcation`, `slack` or `taut`.
    pub fn name(self) -> &'static str {
        match self {
            Self::LimitPoint => "limit_point",
            Self::Bifurcation => "bifurcation",
            Self::Slack(_) => "slack",
            Self::Taut(_) => "taut",
        }
    }

    /// The index of the cable that goes slack or taut.
    pub fn cable(self) -> Option<usize> {
        match self {
            Self::Slack(cable) | Self::Taut(cable) => Some(cable),
            Self::LimitPoint | Self::Bifurcation => None,
        }
    }
}

/// One equilibrium of a path: in the plane, or with [`crate::SpatialConfiguration`] in space.
#[derive(Debug, Clone)]
pub struct PathPoint<C = Configuration> {
    /// The parameter.
    pub value: f64,
    /// The shape, its arm carrying that value.
    pub configuration: C,
    /// `None` where it is not established.
    pub stability: Option<Stability>,
    /// What is special about it.
    pub event: Option<Event>,
}

/// Why a path ends where it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathEnd {
    /// At the end of the range.
    ReachedEnd,
    /// Back at the start of the range, on another branch than it left from or on the way back from a limit point.
    ReachedStart,
    /// After the most points allowed.
    MostPoints,
    /// Where whoever watched it said so.
    Stopped,
    /// At what no equilibrium goes past: the kind, with the place along the arm (m) if the limit is local.
    Limit {
        /// Which limit.
        kind: VerdictKind,
        /// Where, m.
        s: Option<f64>,
    },
}

impl PathEnd {
    /// The name in results: `reached_end`, `cable_fold` and so on.
    pub fn name(self) -> &'static str {
        match self {
            Self::ReachedEnd => "reached_end",
            Self::ReachedStart => "reached_start",
            Self::MostPoints => "most_points",
            Self::Stopped => "stopped",
            Self::Limit { kind, .. } => kind.name(),
        }
    }
}

/// Equilibria in the order in which a branch meets them.
#[derive(Debug, Clone)]
pub struct Branch<C = Configuration> {
    /// Limit points and bifurcations stand among the others, in their place.
    pub points: Vec<PathPoint<C>>,
    /// Why it ends.
    pub end: PathEnd,
    /// Value of the parameter at the bifurcation that it was switched to at.
    pub switched_at: Option<f64>,
}

/// A path of equilibria.
#[derive(Debug, Clone)]
pub struct Path<C = Configuration> {
    /// What varies.
    pub parameter: Parameter,
    /// Its range: the path starts at the first value.
    pub range: [f64; 2],
    /// The branch that the solve at the first value is on, then those switched to.
    pub branches: Vec<Branch<C>>,
}

/// Why there is no path: in the plane, or with [`crate::SpatialError`] in space.
#[derive(Debug, Clone, thiserror::Error)]
pub enum PathError<E = SolveError> {
    /// The arm cannot have the value at one end of the range.
    #[error("at {}: {source}", parameter.shown(*value))]
    Value {
        /// What was to vary.
        parameter: Parameter,
        /// The value.
        value: f64,
        /// Why not.
        source: Refused,
    },
    /// An option or a range that cannot be.
    #[error("`{option}` must be {expected}, found {value}")]
    Option {
        /// Which option.
        option: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The reading has no family of equilibria.
    #[error("`support = \"unstrained-base\"` is an initial-value problem without limit points or several equilibria")]
    Support,
    /// Cables whose stroke is commanded, where all equilibria are asked for.
    #[error(
        "cable `{cable}` has a commanded stroke: the equilibria for all base angles are one curve at given tensions \
         only; set the tension that `solve` finds"
    )]
    Stroke {
        /// The first such cable's name.
        cable: String,
    },
    /// Cables that rub: what they carry depends on how they slid.
    #[error(
        "cable `{cable}` has friction, so that its tension depends on the history of loading; paths need cables without friction"
    )]
    Friction {
        /// The first such cable's name.
        cable: String,
    },
    /// There is no equilibrium to start from.
    #[error("no equilibrium at the start of the path, {}: {source}", parameter.shown(*value))]
    Start {
        /// What was to vary.
        parameter: Parameter,
        /// The value.
        value: f64,
        /// Why not.
        source: E,
    },
}

/// Whether there are paths of the equilibria of `arm`.
pub(crate) fn has_a_path<E>(arm: &Arm) -> Result<(), PathError<E>> {
    if arm.model.support == Support::UnstrainedBase {
        return Err(PathError::Support);
    }
    match arm.cables.iter().find(|c| c.friction > 0.0) {
        Some(cable) => Err(PathError::Friction { cable: cable.name.clone() }),
        None => Ok(()),
    }
}
