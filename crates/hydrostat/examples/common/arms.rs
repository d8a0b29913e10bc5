//! The arms that examples and benches solve.

use std::error::Error;

use hydrostat::Arm;
use hydrostat_files::{ArmFile, shipped};

/// The shipped arm of that name, else the one in that file.
pub(crate) fn named(name: &str) -> Result<Arm, Box<dyn Error>> {
    let file = match shipped::get(name) {
        Some(text) => ArmFile::parse(text, name)?,
        None => ArmFile::read(name)?,
    };
    Ok(file.arm()?)
}

/// The same with tensions (N) and in a stream (m/s).
pub(crate) fn pulled(name: &str, tensions: &[f64], speed: f64) -> Result<Arm, Box<dyn Error>> {
    let mut arm = named(name)?;
    arm.set_tensions(tensions)?;
    arm.flow.speed = speed;
    Ok(arm)
}
