//! What can go wrong with a sweep.

use std::io;
use std::path::{Path, PathBuf};

use hydrostat::SolveError;
use hydrostat_files::WriteError;
use parquet::errors::ParquetError;

use crate::arms::ValueError;
use crate::plan::PlanError;

/// Why a sweep cannot be done, or went no further.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// Keys and values make no plan.
    #[error("--vary: {0}")]
    Plan(#[from] PlanError),
    /// A value of a key makes no arm.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// The tolerance.
    #[error(transparent)]
    Option(#[from] SolveError),
    /// A fraction of the sweep that is none.
    #[error(
        "--shard {index}/{of}: expected a number from 1 to {of}, and at most {rows} shards, because the sweep has {rows} rows"
    )]
    Shard {
        /// Which.
        index: u64,
        /// Of how many.
        of: u64,
        /// Rows of the sweep, the most shards that it has.
        rows: u64,
    },
    /// The output is there already.
    #[error("{} exists; remove it or choose another name", .path.display())]
    Exists {
        /// The output.
        path: PathBuf,
    },
    /// A sweep into this output was begun and not ended.
    #[error("{} holds the parts of an interrupted sweep; resume it with --resume, or remove that directory", .directory.display())]
    Begun {
        /// Where its parts are.
        directory: PathBuf,
    },
    /// Parts or output of another sweep.
    #[error("{} belongs to another sweep: its {what} differs; remove it, or request the same sweep", .path.display())]
    Other {
        /// The parts' directory or the output.
        path: PathBuf,
        /// What is different.
        what: &'static str,
    },
    /// A second sweep into the same output.
    #[error("another sweep is writing {}; wait until it ends, or choose another name", .path.display())]
    Locked {
        /// The output.
        path: PathBuf,
    },
    /// An output that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A file that is no result of a sweep, or was damaged.
    #[error("{}: {message}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },
    /// A part whose bytes changed after it was written.
    #[error("{} was changed after it was written; --resume solves its rows again", .path.display())]
    Damaged {
        /// The part.
        path: PathBuf,
    },
    /// Whoever watched it ended it. Whole parts stay where they are, to go on from.
    #[error("the sweep was interrupted")]
    Stopped,
    /// Threads that could not be started.
    #[error("{0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// A failure to write `path`.
pub(crate) fn write_error(path: &Path, source: io::Error) -> SweepError {
    WriteError { path: path.to_owned(), source }.into()
}

/// A failure of the Parquet library while it wrote `path`.
pub(crate) fn parquet_error(path: &Path, error: ParquetError) -> SweepError {
    let source = match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(io) => *io,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    };
    write_error(path, source)
}

/// A file that cannot be read.
pub(crate) fn read_error(path: &Path, error: impl std::fmt::Display) -> SweepError {
    SweepError::Read { path: path.to_owned(), message: error.to_string() }
}
