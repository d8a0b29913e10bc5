//! The rod and what acts on it: an arm, its sections, cables and loads. No solver is in sight.

pub(crate) mod area_law;
pub mod arm;
pub(crate) mod cable;
pub(crate) mod cable_list;
pub(crate) mod flow;
pub(crate) mod inertia;
pub(crate) mod loads;
pub mod model_options;
pub mod parameter;
pub mod profile;
pub(crate) mod section;
pub(crate) mod section_solve;
