//! One file a command.

pub(crate) mod arms;
mod boundary;
pub(crate) mod check;
pub(crate) mod equilibria;
pub(crate) mod figures;
mod follow;
pub(crate) mod history;
pub(crate) mod identify;
pub(crate) mod init;
mod limits;
mod loaded;
pub(crate) mod main_job;
mod misses;
pub(crate) mod modes;
mod motion_output;
mod motion_text;
mod moving;
mod over;
pub(crate) mod path;
pub(crate) mod plot;
pub(crate) mod reach;
pub(crate) mod serve;
mod shape;
pub(crate) mod shell;
pub(crate) mod simulate;
mod slip;
pub(crate) mod solve;
mod solve_spatial;
mod summary;
pub(crate) mod sweep;
mod table;
mod targets;
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

/// The error of an option out of its range, in terms of the command line.
fn wrong_option(option: &str, value: f64, expected: &str, error: impl Into<anyhow::Error>) -> anyhow::Error {
    let option = option.replace('_', "-");
    error.into().context(format!("--{option}: expected a number {expected}, found {value}"))
}

/// An error with advice that depends on the request.
#[derive(Debug)]
pub(crate) struct Advised {
    error: anyhow::Error,
    advice: String,
}

impl Advised {
    /// `error`, with its advice if there is any.
    fn with(error: impl Into<anyhow::Error>, advice: Option<String>) -> anyhow::Error {
        let error = error.into();
        match advice {
            Some(advice) => Self { error, advice }.into(),
            None => error,
        }
    }

    pub(crate) fn advice(&self) -> &str {
        &self.advice
    }
}

impl std::fmt::Display for Advised {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.error.fmt(f)
    }
}

impl std::error::Error for Advised {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(self.error.as_ref())
    }
}
