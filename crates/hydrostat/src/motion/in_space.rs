//! The arm in motion in space: `docs/motion.md`, section 5.

mod equations;
mod modes;
mod moves;
mod powers;
mod pulls;
mod quasi_static;
mod rest;
mod simulation;
mod start;

pub use self::quasi_static::SpatialQuasiStatic;
pub use self::simulation::{SpatialInstant, SpatialMotionStation, SpatialSimulation};
