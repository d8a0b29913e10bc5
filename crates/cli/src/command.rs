//! One file a command.

pub(crate) mod arms;
mod boundary;
pub(crate) mod check;
pub(crate) mod equilibria;
pub(crate) mod figures;
mod follow;
pub(crate) mod identify;
mod limits;
pub(crate) mod main_job;
pub(crate) mod path;
pub(crate) mod plot;
pub(crate) mod reach;
pub(crate) mod serve;
pub(crate) mod solve;
mod summary;
pub(crate) mod sweep;
mod table;
pub(crate) mod validate;

/// A command that did what it could: what it found is written, and it is not all that was asked for.
#[derive(Debug)]
pub(crate) struct NoAnswer(String);

impl std::fmt::Display for NoAnswer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NoAnswer {}
