//! The formats of tables, and the note that a table carries.

use std::path::Path;

use crate::csv_file;
use crate::error::SweepError;
use crate::parquet_file::Reader;

/// How a file is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Parquet, compressed with gzip.
    Parquet,
    /// CSV with a header.
    Csv,
}

impl Format {
    /// By the ending of a file's name, `.parquet` or `.csv`.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "parquet" => Some(Self::Parquet),
            "csv" => Some(Self::Csv),
            _ => None,
        }
    }

    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Parquet => "parquet",
            Self::Csv => "csv",
        }
    }
}

/// The key under which a Parquet file notes the sweep that it is of. Of `out.csv` the same stands in `out.csv.json`.
pub const NOTE: &str = "hydrostat.sweep";

/// What a whole output says that it is of.
pub(crate) fn noted(output: &Path, format: Format) -> Result<Option<String>, SweepError> {
    match format {
        Format::Parquet => Ok(Reader::open(output)?.note(NOTE)),
        Format::Csv => csv_file::note(output),
    }
}
