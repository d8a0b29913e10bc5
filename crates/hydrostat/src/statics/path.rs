//! Continuation: along the loads, over a parameter, round the angle of the base; followed by arclength so that no fold is stepped
//! over unseen.

mod circle;
mod contact;
mod events;
mod limits;
mod pace;
mod ramp;
mod range;
#[cfg(test)]
pub(crate) mod small_steps;
mod stepper;

pub use circle::{Equilibria, Equilibrium};
pub(crate) use limits::name_limit;
pub(crate) use pace::{LOOSE, Pace, Travelled};
pub(crate) use ramp::{Stopped, follow, follow_strokes};
pub use range::{Branch, Event, Path, PathEnd, PathError, PathOptions, PathPoint};
