//! Continuation: along the loads, over a parameter, round the angle of the base; followed by arclength so that no fold
//! is stepped over unseen.

mod beside;
mod circle;
mod contact;
mod events;
mod limits;
mod load_stepping;
pub(crate) mod loaded;
mod no_equilibrium;
mod points;
mod range;
#[cfg(test)]
pub(crate) mod small_steps;
mod step_control;
mod stepper;
mod trace;
pub(crate) mod traced;
mod turns;

pub use circle::{Equilibria, Equilibrium};
pub(crate) use limits::name_limit;
pub(crate) use load_stepping::{Stopped, follow, follow_on, follow_range, follow_strokes};
pub(crate) use no_equilibrium::{no_equilibrium, no_equilibrium_in_range};
pub(crate) use points::has_a_path;
pub use points::{Branch, Event, Path, PathEnd, PathError, PathOptions, PathPoint};
pub(crate) use step_control::{BY_MESH, DOUBTFUL, LOOSE, PathSummary, StepControl};
pub(crate) use trace::{ends_of_range, trace};
pub(crate) use turns::{Further, Met, follow_turns};
