//! A motion that goes on from a state.

use super::error::MotionError;
use super::inputs::Inputs;
use super::settling::Moves;
use super::start::{check, force_unit};
use super::state::MotionState;
use super::stepper::Stepper;
use crate::rod::arm::Arm;

/// From a state that another run was in.
pub(super) fn resumed<P: Moves<S, L>, const S: usize, const L: usize>(
    arm: &Arm,
    inputs: Inputs,
    state: &MotionState,
    tol: f64,
    fixed: Option<f64>,
) -> Result<Stepper<P, S, L>, MotionError> {
    arm.check()?;
    inputs.check(arm)?;
    let mut start = arm.clone();
    inputs.apply(&mut start, state.time);
    check(&start)?;
    let (mesh, now) = state.check::<P, S, L>(&start)?;
    let mut pulled = start.clone();
    for (cable, tension) in pulled.cables.iter_mut().zip(&state.tensions).filter(|(cable, _)| cable.stroke.is_some()) {
        cable.tension = *tension;
    }
    let force = force_unit(&start);
    let mut settling = P::in_shape(&pulled, &now, &state.carried(P::CARRIED, force), mesh);
    settling.system.take_stations(&settling.solution);
    let energy = force * start.length;
    let works = [&state.works, &state.powers].map(|list| std::array::from_fn(|k| list[k] / energy));
    Ok(Stepper::going_on(settling, start, inputs, now, state, works, (tol, fixed)))
}
