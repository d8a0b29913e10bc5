//! What is wrong with an arm file, and where.

use std::fmt;
use std::io;

use hydrostat::ArmError;
use hydrostat::profile::TableError;

/// Where a value was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// In a file.
    Line {
        /// The file, as the user named it.
        path: String,
        /// From 1.
        line: usize,
        /// In characters, from 1.
        column: usize,
    },
    /// In an override given beside the file.
    Setting {
        /// The option that it was given with, and what the user wrote: `--set KEY=VALUE`.
        setting: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { path, line, .. } => write!(f, "{path}:{line}"),
            Self::Setting { setting } => f.write_str(&shortened(setting)),
        }
    }
}

/// Why a text is not an arm. Every variant that comes from the text says where.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file could not be read.
    #[error("{path}: cannot be read: {source}")]
    Read {
        /// The file.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// Far more than an arm needs.
    #[error("{path}: larger than {limit} bytes, the limit for an arm file")]
    TooLarge {
        /// The file.
        path: String,
        /// The most that is read, in bytes.
        limit: u64,
    },
    /// Bytes that are not text.
    #[error("{place}: not UTF-8 text: the byte 0x{byte:02x}")]
    NotText {
        /// Where.
        place: Place,
        /// The first byte that is none.
        byte: u8,
    },
    /// Text that is not TOML.
    #[error("{place}: {}not valid TOML: {message}", prefix(.key.as_ref()))]
    Syntax {
        /// Where.
        place: Place,
        /// The key at that place, if there is one.
        key: Option<String>,
        /// What the TOML parser says.
        message: String,
    },
    /// A key that appears twice.
    #[error("{place}: {key}: the key is given twice")]
    Duplicate {
        /// Where the second one is.
        place: Place,
        /// The key.
        key: String,
    },
    /// A key that the format does not have.
    #[error("{place}: {key}: unknown key; expected {expected}{}", hint(.suggestion.as_ref()))]
    UnknownKey {
        /// Where.
        place: Place,
        /// The dotted key.
        key: String,
        /// What was expected in its stead.
        expected: String,
        /// The key that may have been meant.
        suggestion: Option<String>,
    },
    /// A key that must be there and is not.
    #[error("{place}: {key}: missing; expected {expected}")]
    Missing {
        /// The table that lacks it.
        place: Place,
        /// The dotted key.
        key: String,
        /// What was expected.
        expected: String,
    },
    /// A value of the wrong type, unit or size.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// Where.
        place: Place,
        /// The dotted key.
        key: String,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
    /// Values that together make no arm.
    #[error("{place}: {key}: expected {}, found {}", expected(.source), found(.source))]
    Arm {
        /// Where.
        place: Place,
        /// The dotted key.
        key: String,
        /// Why, with its numbers.
        source: Box<ArmError>,
    },
}

impl FileError {
    /// The dotted key that is wrong, if one is.
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::Read { .. } | Self::TooLarge { .. } | Self::NotText { .. } => None,
            Self::Syntax { key, .. } => key.as_deref(),
            Self::Duplicate { key, .. }
            | Self::UnknownKey { key, .. }
            | Self::Missing { key, .. }
            | Self::Value { key, .. }
            | Self::Arm { key, .. } => Some(key),
        }
    }

    /// Where, unless the file could not be read at all.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Read { .. } | Self::TooLarge { .. } => None,
            Self::NotText { place, .. }
            | Self::Syntax { place, .. }
            | Self::Duplicate { place, .. }
            | Self::UnknownKey { place, .. }
            | Self::Missing { place, .. }
            | Self::Value { place, .. }
            | Self::Arm { place, .. } => Some(place),
        }
    }
}

fn prefix(key: Option<&String>) -> String {
    key.map_or_else(String::new, |k| format!("{k}: "))
}

fn hint(suggestion: Option<&String>) -> String {
    suggestion.map_or_else(String::new, |s| format!("; did you mean `{s}`?"))
}

fn expected(error: &ArmError) -> String {
    match error {
        ArmError::NotFinite { .. } => "a finite number".to_owned(),
        ArmError::NotPositive { .. } => "a value above zero".to_owned(),
        ArmError::Negative { .. } => "a value that is not negative".to_owned(),
        ArmError::OutOfRange { expected, .. } => format!("a value {expected}"),
        ArmError::InnerRadius { outer, s, .. } => format!("less than the radius, {outer} m at s = {s} m"),
        ArmError::OffsetOutside { radius, s, .. } => {
            format!("an offset inside the section, at most {radius} m at s = {s} m")
        }
        ArmError::TensionAboveMax { max_tension, .. } => format!("at most its max_tension of {max_tension} N"),
        ArmError::TableDoesNotCover { length, .. } => {
            format!("a table that runs from s = 0 to the length, {length} m")
        }
        ArmError::Table { source: TableError::TooShort { .. }, .. } => "at least two points [s, value]".to_owned(),
        ArmError::Table { source: TableError::NotIncreasing { previous, .. }, .. } => {
            format!("increasing places, here one above s = {previous} m")
        }
        ArmError::Table { source: TableError::NotFinite { .. }, .. } => "finite numbers".to_owned(),
        ArmError::TooManyBreaks { most, .. } => {
            format!("at most {most} places at which tables have points and cables end")
        }
        ArmError::TensionCount { cables, .. } => format!("{cables} tensions, one per cable"),
        ArmError::OutOfPlane { .. } => "`space = \"spatial\"` in `[arm]` for a value out of the plane".to_owned(),
        ArmError::OnlyInPlane { what } => format!("an arm in the plane, which {what} requires"),
        ArmError::NotInSpace { .. } => "a value that is supported with `space = \"spatial\"`".to_owned(),
        ArmError::Direction { .. } => "another direction".to_owned(),
    }
}

fn found(error: &ArmError) -> String {
    match error {
        ArmError::NotFinite { .. } => "one that is not".to_owned(),
        ArmError::NotPositive { value, s: Some(s), .. } => format!("{value} at s = {s} m"),
        ArmError::NotPositive { value, s: None, .. }
        | ArmError::Negative { value, .. }
        | ArmError::OutOfRange { value, .. } => format!("{value}"),
        ArmError::InnerRadius { inner, .. } => format!("{inner} m there"),
        ArmError::OffsetOutside { offset, .. } => format!("{offset} m there"),
        ArmError::TensionAboveMax { tension, .. } => format!("{tension} N"),
        ArmError::TableDoesNotCover { from, to, .. } => format!("one from {from} m to {to} m"),
        ArmError::Table { source: TableError::TooShort { found }, .. } | ArmError::TooManyBreaks { found, .. } => {
            format!("{found}")
        }
        ArmError::Table { source: TableError::NotIncreasing { s, .. }, .. } => format!("s = {s} m"),
        ArmError::Table { source: TableError::NotFinite { s, value, .. }, .. } => format!("[{s}, {value}]"),
        ArmError::TensionCount { given, .. } => format!("{given}"),
        ArmError::OutOfPlane { .. } => "an arm in the plane".to_owned(),
        ArmError::OnlyInPlane { .. } => "`space = \"spatial\"`".to_owned(),
        ArmError::NotInSpace { key, why } => format!("`{key}`, which {why} in space"),
        ArmError::Direction { why, .. } => format!("one that {why}"),
    }
}

/// `text` on one line and not longer than a message can bear.
pub(crate) fn shortened(text: &str) -> String {
    const LIMIT: usize = 60;
    let mut short: String = text.chars().take(LIMIT).flat_map(char::escape_debug).collect();
    if text.chars().nth(LIMIT).is_some() {
        short.push_str("...");
    }
    // The quotes of a message are its own; inside them only control characters need an escape.
    short.replace("\\'", "'").replace("\\\"", "\"")
}
