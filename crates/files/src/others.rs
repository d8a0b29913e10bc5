//! What a search for equilibria found beside the shape that a solve leads to.

use hydrostat::{Equilibria, Stability};
use serde::Serialize;

/// What a search found beside the path that a solve follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Others {
    /// Equilibria.
    pub count: usize,
    /// Those known to be stable.
    pub stable: usize,
    /// Whether these are all.
    pub complete: bool,
}

impl From<&Equilibria> for Others {
    fn from(all: &Equilibria) -> Self {
        let stable = all.found.iter().filter(|e| e.stability == Some(Stability::Stable)).count();
        Self { count: all.found.len(), stable, complete: all.complete }
    }
}
