//! The arm in space: section law in six strains, loads as vectors, and the solver of their equations (`docs/model.md`,
//! the arm in space).
//!
//! What is the same in the plane is taken from there: profiles, sections along the arm, the section stretch, the
//! scalar flow laws, meshes and their errors, verdicts.

mod buckling;
pub(crate) mod cable_paths;
mod change;
pub(crate) mod configuration;
mod deflation;
pub(crate) mod engine;
pub(crate) mod equations;
mod equilibria;
pub(crate) mod inertia;
mod kinks;
mod lengths;
mod loaded;
pub(crate) mod loads;
pub(crate) mod many;
mod mesh;
mod neutral;
mod paths;
mod place;
mod places;
pub(crate) mod rotation;
mod row;
pub(crate) mod section;
pub(crate) mod section_solve;
mod sensitivity;
mod solve;
mod stability;
mod start;
mod stroke_control;
mod strokes;
#[cfg(test)]
mod tests;
mod tip;
mod traced;
mod varied;

pub use self::configuration::{SpatialConfiguration, SpatialStation, SpatialStations, SpatialWrench};
pub use self::equilibria::SpatialEquilibria;
pub(crate) use self::equilibria::equilibria;
pub use self::many::solve_many_in_space;
pub use self::row::SpatialRow;
pub use self::sensitivity::{Ellipsoid, SpatialPoseChange};
pub(crate) use self::sensitivity::{Quantity, turn_between};
pub use self::solve::{NoSpatialEquilibrium, SpatialError, SpatialSolver};
pub use self::tip::{SpatialSnap, SpatialTip};
