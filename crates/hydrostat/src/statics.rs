//! Equilibria of a rod: the equations, their solution, and what is asked of it.

pub(crate) mod border;
pub(crate) mod compliance;
pub mod configuration;
pub(crate) mod dense;
pub(crate) mod dimensions;
pub(crate) mod engine;
pub(crate) mod equations;
pub(crate) mod friction;
mod friction_iteration;
pub(crate) mod kept;
pub(crate) mod limit;
pub mod many;
pub mod path;
pub(crate) mod phase;
pub(crate) mod prediction;
pub(crate) mod refinement;
pub mod row;
pub mod sensitivity;
pub(crate) mod shape;
pub mod snap;
pub mod solve;
pub mod stability;
mod strokes;
pub mod verdict;
pub mod warm_start;
pub(crate) mod warning;
