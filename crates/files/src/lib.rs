//! What Hydrostat reads and writes: arm files, their schema, units, results as JSON and CSV.
//!
//! An [`ArmFile`] is TOML text with overrides; [`ArmFile::arm`] is the `hydrostat::Arm` that it
//! means, and every [`FileError`] says where, what was expected and what was found. [`Solution`]
//! and [`Failure`] are the JSON documents of a solve, [`write_whole`] puts any output on disk.

mod arm_file;
mod document;
mod error;
mod format;
mod output;
mod quantity;
mod reading;
pub mod results;
pub mod schema;
mod setting;
pub mod shipped;
mod written;

pub use arm_file::ArmFile;
pub use error::{FileError, Place};
pub use output::{WriteError, write_whole};
pub use quantity::{Dimension, QuantityError, STANDARD_GRAVITY};
pub use results::{Failure, Note, Solution, stations_csv};
pub use written::{Inputs, arm_to_toml};
