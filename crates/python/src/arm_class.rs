//! The class of arms, for what takes or gives one.

use hydrostat_files::{ArmFile, arm_to_toml};
use pyo3::prelude::*;

use crate::wrong::file_error;

/// An override: the name that messages have for where it comes from, the key, the value.
pub(crate) type Setting = (String, String, String);

/// An arm with the text that it was read from.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Arm {
    pub(crate) file: ArmFile,
    pub(crate) given: hydrostat::Arm,
    pub(crate) text: String,
    pub(crate) settings: Vec<Setting>,
}

impl Arm {
    /// Of an arm of the library, whose text is what it would be written as.
    pub(crate) fn of(py: Python<'_>, arm: &hydrostat::Arm) -> PyResult<Self> {
        let text = arm_to_toml(arm);
        let file = ArmFile::parse(&text, &arm.name).map_err(|error| file_error(py, error))?;
        Ok(Self { file, given: arm.clone(), text, settings: Vec::new() })
    }
}
