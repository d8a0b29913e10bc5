//! The arm in motion in space: `docs/motion.md`, section 5.

mod equations;
mod moves;
mod powers;
mod simulation;
mod start;
mod strokes;

pub use self::simulation::{SpatialInstant, SpatialMotionStation, SpatialSimulation};
