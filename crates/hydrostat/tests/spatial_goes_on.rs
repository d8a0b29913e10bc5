//! Motions in space that go on from the state of another one, the equilibria beside them, and steps that see twist.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/motion.rs"]
mod moving;

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/space.rs"]
mod space;

use std::f64::consts::PI;

use hydrostat::{
    Arm, Course, Inputs, MotionError, MotionOptions, Space, SpatialInstant, SpatialSimulation, SpatialTip, Volume,
};
use moving::{in_space as motion, inputs, options, pull};
use space::{apart, solved, three_cables};

fn place(tip: &SpatialTip) -> [f64; 3] {
    [tip.x, tip.y, tip.z]
}

fn arm() -> Arm {
    let mut arm = three_cables();
    arm.dynamics.relaxation_time = 2.7e-3;
    arm
}

#[test]
fn a_motion_in_space_goes_on_from_its_state_as_if_it_had_not_stopped() {
    let pulled = arm();
    let mut reeled = arm();
    reeled.cables.iter_mut().for_each(|cable| cable.tension = 0.0);
    let reel = ("cable[0].stroke", Course::ramp(0.0, 0.011, 0.0, 0.3));
    for (arm, load, stop) in [(&pulled, pull(), 0.13), (&pulled, pull(), 0.4), (&reeled, reel, 0.13)] {
        let loads = inputs(&[load]);
        let start = MotionOptions { tol: 1e-3, ..MotionOptions::default() };
        let mut whole = SpatialSimulation::new(arm, loads.clone(), start).unwrap();
        let at_stop = whole.advance_to(stop).unwrap();
        let state = whole.state();
        let mut second = SpatialSimulation::resume(arm, loads, start, &state).unwrap();
        let again = second.now();
        assert!(apart(place(&again.tip), place(&at_stop.tip)) < 1e-12, "{again:?} {at_stop:?}");
        assert!((again.kinetic_energy - at_stop.kinetic_energy).abs() < 1e-9 * at_stop.kinetic_energy.max(1e-6));
        let (want, found) = (whole.advance_to(0.5).unwrap(), second.advance_to(0.5).unwrap());
        let off = apart(place(&want.tip), place(&found.tip)) / arm.length;
        assert!(off < 1e-3, "{stop}: {off:.1e}");
        let works = (want.works.sum() - found.works.sum()).abs();
        assert!(works < 2e-3 * want.works.cables.abs(), "{works:.1e} {:?}", want.works);
    }
}

#[test]
fn a_state_of_another_arm_is_refused() {
    let arm = arm();
    let simulation = SpatialSimulation::new(&arm, Inputs::default(), MotionOptions::default()).unwrap();
    let state = simulation.state();
    let mut turned = arm.clone();
    turned.space = Some(Space { base: None, ..arm.space.clone().unwrap() });
    let mut longer = arm.clone();
    longer.length *= 1.1;
    for other in [&turned, &longer] {
        let refused = SpatialSimulation::resume(other, Inputs::default(), MotionOptions::default(), &state);
        assert!(matches!(refused, Err(MotionError::State { .. })), "{refused:?}");
    }
    let mut flat = arm.clone();
    flat.space = None;
    flat.cables.truncate(0);
    let refused = hydrostat::Simulation::resume(&flat, Inputs::default(), MotionOptions::default(), &state);
    assert!(matches!(refused, Err(MotionError::State { .. })), "{refused:?}");
}

#[test]
fn the_equilibrium_beside_a_motion_is_that_of_the_statics() {
    let arm = arm();
    let loads = inputs(&[("cable[1].tension", Course::ramp(0.05, 0.15, 0.0, 0.4))]);
    let simulation = SpatialSimulation::new(&arm, loads, MotionOptions::default()).unwrap();
    let mut equilibria = simulation.quasi_static().unwrap();
    for (time, tension) in [(0.0, 0.05), (0.1, 0.075), (0.4, 0.15), (1.0, 0.15)] {
        let mut there = arm.clone();
        there.cables[1].tension = tension;
        let off = apart(place(&equilibria.tip(time).unwrap()), place(&solved(&there, 1e-8).tip()));
        assert!(off < 2e-6 * arm.length, "{time}: {off:.1e}");
    }
}

/// The angle by which the tip is twisted about e1.
fn twist(at: &SpatialInstant) -> f64 {
    at.tip.b[2].atan2(at.tip.b[1])
}

/// A rod that a moment about its axis twists to and fro: its centreline never moves, and steps that saw no more than
/// that would grow without bound.
#[test]
fn steps_see_an_arm_that_only_twists() {
    let (r, young) = (0.05, 1e6);
    let mut arm = Arm::cone(1.0, r, r, young, 0.5);
    arm.density = 1000.0;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm.space = Some(Space::default());
    // phi = A sin(w x/c) sin(w t) of a forced swing, from its speed at t = 0 on: grown smoothly instead.
    let gj = young / 3.0 * PI * r.powi(4) / 2.0;
    let wave = (young / 3.0 / 1000.0_f64).sqrt();
    let period = 4.0 / wave;
    let swing = Course::Sine { mean: 0.5 * gj, amplitude: 0.5 * gj, frequency: 0.3 / period, phase: -PI / 2.0 };
    let load = inputs(&[("tip.moment[0]", swing)]);
    let sharp = MotionOptions { step: Some(period / 400.0), elements: Some(8), ..options(1e-6) };
    let exact = motion(&arm, load.clone(), sharp, 5.0 * period, 0.1 * period);
    let most = exact.iter().map(|at| twist(at).abs()).fold(0.0, f64::max);
    assert!(most > 0.5, "{most}");
    for tol in [1e-3, 1e-4] {
        let own = MotionOptions { elements: Some(8), ..options(tol) };
        let rows = motion(&arm, load.clone(), own, 5.0 * period, 0.1 * period);
        let off = rows.iter().zip(&exact).map(|(a, b)| (twist(a) - twist(b)).abs()).fold(0.0, f64::max);
        assert!(r * off < tol, "{tol}: {off:.2e}");
        assert!(rows.iter().all(|at| apart(place(&at.tip), [1.0, 0.0, 0.0]) < 1e-9));
    }
}
