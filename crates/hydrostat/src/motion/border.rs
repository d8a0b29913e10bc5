//! What a round does to the tensions of cables whose stroke is commanded.

use hydrostat_bvp::Forcing;

/// The tensions' part of a round, and memory for it.
#[derive(Debug, Clone)]
pub(super) struct Border<T, const S: usize, const L: usize> {
    /// Changes of the tensions (in the unit of force), one a held cable.
    pub(super) tensions: Vec<f64>,
    /// Strokes less commands after the round, over L.
    pub(super) slack: Vec<f64>,
    pub(super) strained: Vec<T>,
    pub(super) forcing: Forcing<S, 0, L>,
}

impl<T, const S: usize, const L: usize> Default for Border<T, S, L> {
    fn default() -> Self {
        Self { tensions: Vec::new(), slack: Vec::new(), strained: Vec::new(), forcing: Forcing::default() }
    }
}
