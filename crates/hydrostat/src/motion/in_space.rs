//! The arm in motion in space: `docs/motion.md`, section 5.

mod equations;
mod modes;
mod moves;
mod powers;
mod pulls;
mod simulation;
mod start;

pub use self::simulation::{SpatialInstant, SpatialMotionStation, SpatialSimulation};
