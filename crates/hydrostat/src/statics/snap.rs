//! Snaps: jumps that an arm makes as its loads grow slowly, where its path of equilibria turns back and then leads on
//! (section 7 of `docs/model.md`).

use crate::statics::shape::{Pose, Tip};
use crate::statics::verdict::Phase;

/// A jump from a limit point of the path to the next stable part of the same curve at the same loads, in the plane or,
/// with [`crate::SpatialTip`], in space.
///
/// ```
/// use hydrostat::{Phase, Snap, Tip};
///
/// let at = |x, theta| Tip { x, y: 0.0, theta, alpha: 0.0 };
/// let snap = Snap { phase: Phase::Tension, load_fraction: 0.25, before: at(0.1, 0.0), after: at(0.13, -0.2) };
/// assert!((snap.distance() - 0.03).abs() < 1e-12 && snap.angle() == 0.2);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snap<T = Tip> {
    /// In which phase of loading.
    pub phase: Phase,
    /// The fraction of the phase's loads at the limit point, 0 to 1.
    pub load_fraction: f64,
    /// The tip at the limit point.
    pub before: T,
    /// The tip where the arm lands.
    pub after: T,
}

impl<T: Pose> Snap<T> {
    /// How far the tip jumps, m.
    pub fn distance(&self) -> f64 {
        self.before.distance_to(&self.after)
    }

    /// How far the tip turns, rad, never negative.
    pub fn angle(&self) -> f64 {
        self.before.turn_to(&self.after)
    }

    /// What happens, in a phrase with its numbers.
    pub fn message(&self) -> String {
        let (millimetres, degrees) = (1e3 * self.distance(), self.angle().to_degrees());
        let load = self.phase.load_at(self.load_fraction);
        format!("the arm snaps at {load}: its tip jumps by {millimetres:.3} mm and turns by {degrees:.3} deg")
    }
}

/// How far the tip of an arm may jump at a snap on the way to its loads for the shape after it to be an answer. An arm
/// that snaps further has the verdict [`crate::VerdictKind::LimitPoint`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SnapBounds {
    /// Of the tip's position, over L, at least 0.
    pub distance: f64,
    /// Of its turn, rad, at least 0.
    pub angle: f64,
}

impl Default for SnapBounds {
    fn default() -> Self {
        Self::SMALL
    }
}

impl SnapBounds {
    /// 0.01 L and 2 degrees, the default.
    pub const SMALL: Self = Self { distance: 0.01, angle: 2.0 * std::f64::consts::PI / 180.0 };
    /// Every snap is followed, however far.
    pub const NONE: Self = Self { distance: f64::INFINITY, angle: f64::INFINITY };

    /// Whether a snap of an arm of this length (m) is within the bounds.
    pub fn allow<T: Pose>(&self, snap: &Snap<T>, length: f64) -> bool {
        snap.distance() <= self.distance * length && snap.angle() <= self.angle
    }
}
