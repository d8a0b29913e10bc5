//! The highest tension: the one at which alpha(L) is what the source publishes.

use hydrostat::{Arm, Configuration};

use super::{SPEED, StudyError, TIP_ANGLE, solved, tension, tip_angle};

/// How near alpha(L) as solved has to come, deg.
const CLOSE: f64 = 1e-6;

/// The shape at that tension.
pub(super) fn configuration(arm: &Arm) -> Result<Configuration, StudyError> {
    let largest = arm.cables[0].max_tension.unwrap_or(100.0);
    let mut low = (0.0, -TIP_ANGLE);
    let mut high = (largest, 0.0);
    // The first tension of an even ladder that turns the section far enough: the way there passes
    // only tensions that have an equilibrium.
    let mut found = None;
    for step in 1..=STEPS {
        let shape = solved(arm, largest * f64::from(step) / f64::from(STEPS), SPEED)?;
        let over = tip_angle(&shape) - TIP_ANGLE;
        if over >= 0.0 {
            high = (tension(&shape), over);
            found = Some(shape);
            break;
        }
        low = (tension(&shape), over);
    }
    let Some(mut shape) = found else {
        return Err(StudyError::NoTension { largest, angle: low.1 + TIP_ANGLE });
    };
    // Regula falsi with the Illinois weight: the bracket is kept and both of its ends move.
    let (mut low_over, mut high_over) = (low.1, high.1);
    let mut side = 0;
    for _ in 0..60 {
        if (tip_angle(&shape) - TIP_ANGLE).abs() <= CLOSE {
            break;
        }
        let next = (low.0 * high_over - high.0 * low_over) / (high_over - low_over);
        shape = solved(arm, next, SPEED)?;
        let over = tip_angle(&shape) - TIP_ANGLE;
        if over < 0.0 {
            (low.0, low_over) = (next, over);
            if side == -1 {
                high_over *= 0.5;
            }
            side = -1;
        } else {
            (high.0, high_over) = (next, over);
            if side == 1 {
                low_over *= 0.5;
            }
            side = 1;
        }
    }
    Ok(shape)
}

const STEPS: u32 = 20;
