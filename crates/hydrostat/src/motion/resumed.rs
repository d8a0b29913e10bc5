//! A motion in the plane that goes on from a state.

use super::dimensions::S;
use super::equations::Moving;
use super::error::MotionError;
use super::in_plane::Planar;
use super::inputs::Inputs;
use super::start::check;
use super::state::MotionState;
use super::stepper::Stepper;
use crate::rod::arm::Arm;
use crate::statics::dimensions::L;

/// From a state that another run was in.
pub(super) fn resumed(
    arm: &Arm,
    inputs: Inputs,
    state: &MotionState,
    tol: f64,
    fixed: Option<f64>,
) -> Result<Stepper<Moving, S, L>, MotionError> {
    arm.check()?;
    inputs.check(arm)?;
    let mut start = arm.clone();
    inputs.apply(&mut start, state.time);
    check(&start)?;
    let mesh = state.check(&start)?;
    let mut settling = Planar::new(&start);
    let statics = &mut settling.moving.statics;
    for (c, tension) in state.tensions.iter().enumerate().filter(|(c, _)| start.cables[*c].stroke.is_some()) {
        statics.set_tension(c, *tension);
    }
    statics.hold_strokes();
    let now = state.restore(&mut settling, mesh);
    let energy = settling.moving.statics.units.force * start.length;
    let works = [&state.works, &state.powers].map(|list| std::array::from_fn(|k| list[k] / energy));
    Ok(Stepper::going_on(settling, start, inputs, now, state, works, (tol, fixed)))
}
