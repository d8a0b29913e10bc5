//! Arms and targets of the tests of inverse kinetics.

use hydrostat::{Arm, Cable, Profile, ReachOptions, Target};
use hydrostat_files::{ArmFile, shipped};

pub(crate) fn shipped_arm(name: &str) -> Arm {
    ArmFile::parse(shipped::get(name).unwrap(), name).unwrap().arm().unwrap()
}

pub(crate) fn cone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

pub(crate) fn options(most: f64) -> ReachOptions {
    ReachOptions { max_tension: Some(most), ..ReachOptions::default() }
}

pub(crate) fn target_of(arm: &Arm, tensions: &[f64]) -> Option<Target> {
    let mut arm = arm.clone();
    arm.set_tensions(tensions).unwrap();
    let shape = arm.solve().ok()?;
    // Else tips could not be told as closely as they are to be reached.
    assert!(shape.error_estimate <= 1e-8 * arm.length, "{} at {tensions:?}: {:e}", arm.name, shape.error_estimate);
    Some(Target::tip(shape.tip().x, shape.tip().y))
}

/// Strokes (m) at tensions, what stretches of an elastic cable reeled in, too, as a solve says.
pub(crate) fn strokes_at(arm: &Arm, tensions: &[f64]) -> Vec<f64> {
    let mut arm = arm.clone();
    arm.set_tensions(tensions).unwrap();
    let shape = arm.solve().unwrap();
    let stroke = |(cable, state): (&Cable, &hydrostat::CableState)| {
        let unloaded = state.length + state.stroke;
        unloaded - state.length / cable.stiffness.map_or(1.0, |stiffness| 1.0 + state.tension / stiffness)
    };
    arm.cables.iter().zip(&shape.cables).map(stroke).collect()
}

pub(crate) fn wound_in_by(most: f64, tension: f64) -> ReachOptions {
    ReachOptions { max_stroke: Some(most), ..options(tension) }
}
