//! The arms that ship with the program.

use hydrostat::Arm;
use hydrostat_files::{ArmFile, shipped};

/// All of them. Their files are checked by tests of `hydrostat-files`: one that could not be read would be missing here, and counted so.
pub(crate) fn arms() -> Vec<Arm> {
    shipped::names().filter_map(arm).collect()
}

/// The one of that name.
pub(crate) fn arm(name: &str) -> Option<Arm> {
    ArmFile::parse(shipped::get(name)?, name).and_then(|file| file.arm()).ok()
}
