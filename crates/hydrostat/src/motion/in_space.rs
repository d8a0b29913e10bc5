//! The arm in motion in space: `docs/motion.md`, section 5.

mod after_snap;
mod equations;
mod modes;
mod moves;
mod powers;
mod pulls;
mod quasi_static;
mod simulation;
mod start;

pub use self::after_snap::SpatialSnapMotion;
pub use self::quasi_static::SpatialQuasiStatic;
pub use self::simulation::{SpatialInstant, SpatialMotionStation, SpatialSimulation};
