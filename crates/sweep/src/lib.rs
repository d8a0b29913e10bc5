//! Sweeps over keys of an arm file: every combination of values, or a sample of them, as a file with a row each.
//!
//! A [`Plan`] says which values each row has and how rows fall into tiles, both by the row's number alone. A [`Sweep`] solves tiles
//! on several threads and writes whole parts into a directory beside its output, from which a run that was stopped goes
//! on; parts are joined at the end. A row is the same to the last bit whatever threads, shards and stops there were. Rows without an
//! equilibrium are rows with a verdict. [`Table`] reads an output back.

mod answer;
mod arms;
mod column;
mod csv_file;
mod draw;
mod error;
mod file_format;
mod parquet_file;
mod parts;
mod plan;
mod run;
mod shard;
mod sobol;
mod table;

pub use arms::ValueError;
pub use column::{Column, Data, NO_ARM, Output, kinds as warning_kinds};
pub use csv_file::beside as note_beside;
pub use error::SweepError;
pub use file_format::{Format, NOTE};
pub use parquet_file::{parquet_bytes, parquet_columns};
pub use plan::{Plan, PlanError, Sample};
pub use run::{Summary, Sweep, SweepOptions};
pub use shard::Shard;
pub use sobol::Sobol;
pub use table::{Table, VariedKey, names, varied_keys};
