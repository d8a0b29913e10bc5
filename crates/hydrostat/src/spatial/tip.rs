//! The tip of an arm in space.

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
