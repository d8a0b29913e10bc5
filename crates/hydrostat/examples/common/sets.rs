//! Named sets of arms whose solves are not direct.

use std::error::Error;

use hydrostat::{Arm, Gravity, cases};

use crate::arms::pulled;

type Failure = Box<dyn Error>;

/// In a stream from this direction (degrees).
fn turned(mut arm: Arm, degrees: f64) -> Arm {
    arm.flow.direction = degrees.to_radians();
    arm
}

/// Arms whose answer needs the path from the unloaded arm.
pub(crate) fn ramped() -> Result<Vec<(&'static str, Arm)>, Failure> {
    let mut heavy = turned(pulled("silicone", &[0.5, 0.0], 0.1)?, 70.0);
    (heavy.density, heavy.gravity) = (1200.0, Some(Gravity::default()));
    let curled = [0.0, 0.0, 3.0, 0.0, 0.0, 0.0];
    Ok(vec![
        ("silicone, 0.5 N, 0.1 m/s", pulled("silicone", &[0.5, 0.0], 0.1)?),
        ("silicone, 0.5 N, 0.1 m/s at 70 deg", turned(pulled("silicone", &[0.5, 0.0], 0.1)?, 70.0)),
        ("silicone, 0.5 N, 0.1 m/s at 70 deg, heavy", heavy),
        ("silicone, 0.2 N, 0.1 m/s at 150 deg", turned(pulled("silicone", &[0.2, 0.0], 0.1)?, 150.0)),
        ("silicone, 0.3 m/s at 120 deg", turned(pulled("silicone", &[0.0, 0.0], 0.3)?, 120.0)),
        ("octopus, 0.015 N, 0.05 m/s", pulled("octopus", &[0.015, 0.0], 0.05)?),
        ("octopus, 0.03 m/s at 135 deg", turned(pulled("octopus", &[0.0, 0.0], 0.03)?, 135.0)),
        ("multi-bending, 3 N, 0.2 m/s", pulled("multi-bending", &curled, 0.2)?),
        ("paper, 80 N, 0.5 m/s at 150 deg", turned(pulled("paper", &[80.0, 0.0], 0.5)?, 150.0)),
        ("normal drag, Ca 10", cases::normal_drag()[1].arm.clone()),
        ("follower end force 1", cases::follower_loads()[0].arm.clone()),
    ])
}

/// Arms whose path ends in a limit point.
pub(crate) fn limit_points() -> Result<Vec<(&'static str, Arm)>, Failure> {
    let facing = |degrees| Ok::<_, Failure>(turned(pulled("silicone", &[0.0, 0.0], 0.5)?, degrees));
    Ok(vec![
        ("silicone, 0.5 m/s at 165 deg", facing(165.0)?),
        ("silicone, 0.5 m/s at 170 deg", facing(170.0)?),
        ("silicone, 0.5 m/s at 172 deg", facing(172.0)?),
    ])
}
