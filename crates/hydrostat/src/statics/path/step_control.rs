//! How finely paths are followed, and what they meet.

use crate::statics::shape::Tip;
use crate::statics::snap::Snap;

/// Fractions start here rather than at zero, where a tangent by the fraction is not defined. What an arm
/// in line with the stream does below is beyond the accuracy that its angles to the stream are known to.
pub(super) const START: f64 = 1e-7;

/// Error of the tip over L that is kept along the path.
pub(crate) const LOOSE: f64 = 1e-4;

/// The clearance of determinants below which the mesh of a path may have decided their sign. The tail of a rod that
/// lies in the stream is free to turn, to first order, and its determinant is next to nothing, of either sign.
pub(crate) const BY_MESH: f64 = 1e-5;

/// The clearance below which a sign that would turn a path back, or that at its end, has to be the same on halves of
/// the elements.
pub(crate) const DOUBTFUL: f64 = 1e-3;

/// Largest turn a unit of load (rad) on a branch that nothing but the load moves along: rounding.
pub(super) const SYMMETRIC: f64 = 1e-10;

/// The most accurate that a path gets however short its steps, tip error over L.
pub(super) const FINEST: f64 = 1e-7;

/// More elements than this serve only to meet what a path must be accurate to.
pub(super) const MANY: usize = 100;

/// Two branches that come as near as this fraction meet.
pub(super) const MEET: f64 = 1e-3;

/// How far the secant slope dlambda/ds of a step may differ from the mean of the slopes at its two ends, relative to
/// the larger of them: two limit points within one step would make them differ by far more.
pub(super) const EVEN: f64 = 0.15;

/// Steps shorter than this go round a corner of the path, which the load's kinks make where a whole part
/// of the arm meets them at once, and through bifurcations.
pub(super) const CORNER: f64 = 1e-5;

/// How finely a path is followed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepControl {
    /// Longest step of arclength (root mean square of the change of theta, with the fraction).
    pub(crate) longest: f64,
    /// Smallest cosine between the tangents at both ends of a step.
    pub(crate) straightness: f64,
    /// Most steps, refused ones included.
    pub(crate) most: usize,
    /// Error of the tip over L that is kept.
    pub(crate) accuracy: f64,
}

impl StepControl {
    pub(crate) const BRISK: Self = Self { longest: 0.4, straightness: 0.94, most: 1000, accuracy: LOOSE };
}

/// What a path met.
#[derive(Debug, Clone)]
pub(crate) struct PathSummary<T = Tip> {
    pub(crate) steps: usize,
    /// Times the determinant changed sign while the load went on rising: bifurcations passed since the last snap.
    pub(crate) bifurcations: usize,
    /// The snaps that the arm makes on its way.
    pub(crate) snaps: Vec<Snap<T>>,
    /// Whether it ended on a branch that nothing but the load moves along.
    pub(crate) symmetric: bool,
}

impl<T> Default for PathSummary<T> {
    fn default() -> Self {
        Self { steps: 0, bifurcations: 0, snaps: Vec::new(), symmetric: false }
    }
}
