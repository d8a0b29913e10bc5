//! What a round does to the tensions of cables whose stroke is commanded.

use hydrostat_bvp::{Forcing, Station};

use super::dimensions::S;
use crate::statics::dimensions::{L, N};

/// The tensions' part of a round, and memory for it.
#[derive(Debug, Clone, Default)]
pub(super) struct Border {
    /// Changes of the tensions (in the unit of force), one a held cable.
    pub(super) tensions: Vec<f64>,
    /// Strokes less commands after the round, over L.
    pub(super) slack: Vec<f64>,
    /// By how much the strokes of taut cables were off.
    pub(super) off: f64,
    pub(super) stations: Vec<Station<N, L>>,
    pub(super) forcing: Forcing<S, 0, L>,
}
