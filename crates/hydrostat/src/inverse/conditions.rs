//! Tensions with their derivatives, and linear conditions on them.

/// Derivatives by the tensions, one column a cable.
#[derive(Debug, Clone)]
pub(super) struct ByTensions {
    /// Of the distances.
    pub(super) rest: Vec<Vec<f64>>,
    /// Of the strokes over L; empty columns where they have no bound.
    pub(super) strokes: Vec<Vec<f64>>,
}

/// Tensions, and the strokes over L that they make: none where strokes have no bound.
#[derive(Clone, Copy)]
pub(super) struct Pulled<'a> {
    pub(super) tensions: &'a [f64],
    pub(super) strokes: &'a [f64],
}

/// Linear conditions on tensions, and on the room that is left of strokes, which comes after these.
pub(super) struct Conditions {
    pub(super) columns: Vec<Vec<f64>>,
    pub(super) wanted: Vec<f64>,
    pub(super) most: Vec<f64>,
    /// What the unknowns are now.
    pub(super) now: Vec<f64>,
}
