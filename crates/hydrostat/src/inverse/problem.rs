//! What is asked of an arm, and what is found.

use crate::rod::arm::Arm;
use crate::statics::configuration::{Configuration, Station};
use crate::statics::sensitivity::SensitivityError;
use crate::statics::stability::Stability;
use crate::statics::verdict::SolveError;

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
    pub(super) fn is_for(&self, arm: &Arm) -> bool {
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
    /// Whether to look from all starts, and along lines from what they find; else the first that reaches the target
    /// ends the search.
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

/// Tensions, and the shape that they lead to: in the plane, or with [`crate::SpatialConfiguration`] and
/// [`crate::SpatialStation`] in space.
#[derive(Debug, Clone)]
pub struct Reached<C = Configuration, P = Station> {
    /// N.
    pub tensions: Vec<f64>,
    /// Sum of their squares, N^2.
    pub effort: f64,
    /// Root of the weighted sum of squared distances to the targets, over L.
    pub distance: f64,
    /// The bounds that its tensions lie on.
    pub bounds: Vec<Bound>,
    /// Whether a solve at these tensions (or at the strokes that they make), along the path of `docs/model.md`, leads
    /// to this shape.
    pub on_the_path: bool,
    /// `None` where it is not established.
    pub stability: Option<Stability>,
    /// The arm at the places of targets that are not for the tip, in the order of the targets.
    pub places: Vec<P>,
    /// The shape; with strokes commanded where they hold it and a solve leads here.
    pub configuration: C,
}

/// What was found.
#[derive(Debug, Clone)]
pub struct Reach<C = Configuration, P = Station> {
    /// Different tensions that reach the targets, least effort first.
    pub solutions: Vec<Reached<C, P>>,
    /// Where nothing does, the nearest that was found.
    pub closest: Option<Reached<C, P>>,
}

/// Why tensions cannot be looked for: in the plane, or with [`crate::SpatialError`] in space.
#[derive(Debug, Clone, thiserror::Error)]
pub enum ReachError<E = SolveError> {
    /// The arm is none, or has no equilibrium at any start.
    #[error(transparent)]
    Solve(E),
    /// The arm has no derivatives, or a target lies off it.
    #[error(transparent)]
    Sensitivity(#[from] SensitivityError<E>),
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

impl From<SolveError> for ReachError {
    fn from(error: SolveError) -> Self {
        Self::Solve(error)
    }
}
