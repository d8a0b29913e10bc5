//! The cables whose stroke is commanded.

/// The cables whose stroke is commanded.
#[derive(Debug, Clone)]
pub(crate) struct StrokeControl {
    /// Their indices among the arm's.
    pub(crate) cables: Vec<usize>,
    /// Whether each is taut: then its tension is unknown and its stroke given, else its tension is zero.
    pub(crate) taut: Vec<bool>,
    /// Strokes that the phase of strokes starts from, over L.
    pub(super) from: Vec<f64>,
    /// The share of the way from these to those commanded.
    pub(super) share: f64,
    /// Whether rounds may change which cables are taut. Along a path that is an event of its own.
    pub(crate) switching: bool,
}

impl StrokeControl {
    /// Which of the commanded cables are taut.
    pub(crate) fn taut_cables(&self) -> Vec<usize> {
        (0..self.cables.len()).filter(|index| self.taut[*index]).collect()
    }
}
