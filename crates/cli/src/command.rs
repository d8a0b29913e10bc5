//! One file a command.

pub(crate) mod arms;
pub(crate) mod check;
pub(crate) mod figures;
mod limits;
pub(crate) mod main_job;
pub(crate) mod solve;
mod summary;
