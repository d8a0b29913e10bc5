//! The targets: all that reads what others wrote, and the solver.

mod api;
mod arms;
mod tables;
mod texts;
