//! The tip of an arm in space.

use super::rotation::dot;
use crate::statics::shape::Pose;
use crate::statics::snap::Snap;

/// The tip of an arm in space.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpatialTip {
    /// m.
    pub x: f64,
    /// m.
    pub y: f64,
    /// m.
    pub z: f64,
    /// Director normal to the tip section.
    pub a: [f64; 3],
    /// Director in the tip section.
    pub b: [f64; 3],
    /// Director in the tip section, a x b.
    pub c: [f64; 3],
    /// Angle between section normal and centreline tangent, rad, in [0, pi].
    pub alpha: f64,
}

/// A jump of an arm in space from a limit point to the next stable part of the same curve at the same loads. Its angle
/// is that of the rotation between both tip sections.
pub type SpatialSnap = Snap<SpatialTip>;

impl Pose for SpatialTip {
    fn distance_to(&self, other: &Self) -> f64 {
        (self.x - other.x).hypot(self.y - other.y).hypot(self.z - other.z)
    }

    /// The angle of the rotation between both sections.
    fn turn_to(&self, other: &Self) -> f64 {
        let trace = dot(&self.a, &other.a) + dot(&self.b, &other.b) + dot(&self.c, &other.c);
        (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos()
    }
}
