//! What a search for equilibria found beside the shape that a solve leads to.

use hydrostat::{Equilibria, SpatialEquilibria, Stability};
use serde::Serialize;

/// What a search found: of an arm in the plane, or in space.
#[derive(Debug, Clone, Copy)]
pub enum Search<'a> {
    /// In the plane.
    Plane(&'a Equilibria),
    /// In space.
    Space(&'a SpatialEquilibria),
}

impl<'a> From<&'a Equilibria> for Search<'a> {
    fn from(all: &'a Equilibria) -> Self {
        Self::Plane(all)
    }
}

impl<'a> From<&'a SpatialEquilibria> for Search<'a> {
    fn from(all: &'a SpatialEquilibria) -> Self {
        Self::Space(all)
    }
}

impl Search<'_> {
    /// Whether these are known to be all.
    pub fn is_complete(self) -> bool {
        matches!(self, Self::Plane(all) if all.complete)
    }
}

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

impl Others {
    /// Of what a search found.
    pub fn of<'a>(all: impl Into<Search<'a>>) -> Self {
        let all = all.into();
        let stabilities: Vec<Option<Stability>> = match all {
            Search::Plane(all) => all.found.iter().map(|one| one.stability).collect(),
            Search::Space(all) => all.found.iter().map(|one| one.stability).collect(),
        };
        let stable = stabilities.iter().filter(|stability| **stability == Some(Stability::Stable)).count();
        Self { count: stabilities.len(), stable, complete: all.is_complete() }
    }
}
