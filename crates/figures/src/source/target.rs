//! The highest tension: the one at which alpha(L) is what the source publishes.

use hydrostat::{Arm, Configuration, Reach, ReachError, ReachOptions};

use super::solves::{SPEED, StudyError, TIP_ANGLE, loaded};

/// The largest tension that is looked at where the cable names none, N.
const LARGEST: f64 = 100.0;

/// How near alpha(L) has to come, rad.
const CLOSE: f64 = 1e-9;

/// The shape at that tension: of those that solves lead to, the one with the least.
pub(super) fn configuration(arm: &Arm) -> Result<Configuration, StudyError> {
    let largest = arm.cables[0].max_tension.unwrap_or(LARGEST);
    let options = ReachOptions { max_tension: Some(largest), tol: CLOSE, ..ReachOptions::default() };
    let Reach { solutions, closest } =
        loaded(arm, 0.0, SPEED).reach_tip_angle(0, TIP_ANGLE.to_radians(), &options).map_err(|error| match error {
            ReachError::Solve(source) => StudyError::Solve { tension: 0.0, speed: SPEED, source: Box::new(source) },
            other => StudyError::Reach(Box::new(other)),
        })?;
    let Some(found) = solutions.into_iter().find(|one| one.on_the_path) else {
        let nearest = closest.map(|closest| [closest.tensions[0], closest.configuration.tip().alpha.to_degrees()]);
        return Err(StudyError::NoTension { largest, nearest });
    };
    Ok(found.configuration)
}
