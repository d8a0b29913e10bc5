//! What a solver remembers of its last solve.

use crate::statics::configuration::Tip;
use crate::statics::snap::Snap;

/// What is known of the equilibrium that an engine holds, beside the solution itself.
#[derive(Debug, Clone)]
pub(crate) struct Solved<T = Tip> {
    /// Estimated error of the tip position, over L.
    pub(crate) estimate: f64,
    /// Load steps of the path to it.
    pub(crate) steps: usize,
    /// The snaps on that path.
    pub(crate) snaps: Vec<Snap<T>>,
    /// Whether it is stable, where the path knows.
    pub(crate) stable: Option<bool>,
}
