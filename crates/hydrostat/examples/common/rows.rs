//! The rows of a batch.

use std::error::Error;

use hydrostat::Arm;

use crate::arms::pulled;

/// `paper` at so many tensions of its left cable from 0 to 80 N at each of so many speeds from 0 to 1 m/s.
pub(crate) fn grid(count: u32) -> Result<Vec<Arm>, Box<dyn Error>> {
    let paper = pulled("paper", &[0.0, 0.0], 0.0)?;
    let fraction = |k: u32| f64::from(k) / f64::from(count - 1);
    let row = |k: u32| {
        let mut arm = paper.clone();
        arm.flow.speed = fraction(k / count);
        arm.cables[0].tension = 80.0 * fraction(k % count);
        arm
    };
    Ok((0..count * count).map(row).collect())
}
