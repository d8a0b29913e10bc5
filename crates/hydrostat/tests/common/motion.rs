//! Motions of the tests: their loads, and their answers at equal times.

use hydrostat::{Arm, Course, Inputs, Instant, MotionOptions, Simulation, SpatialInstant, SpatialSimulation};

pub(crate) fn options(tol: f64) -> MotionOptions {
    MotionOptions { tol, ..MotionOptions::default() }
}

pub(crate) fn inputs(courses: &[(&str, Course)]) -> Inputs {
    let mut out = Inputs::default();
    for (key, course) in courses {
        out.set(key, course.clone()).unwrap();
    }
    out
}

/// A cable is pulled in 0.2 s, and let go at 0.4 s.
pub(crate) fn pull() -> (&'static str, Course) {
    ("cable[0].tension", Course::Table(vec![(0.0, 0.0), (0.2, 0.2), (0.4, 0.2), (0.4, 0.0)]))
}

/// The motion in the plane at equal times.
pub(crate) fn in_plane(arm: &Arm, inputs: Inputs, options: MotionOptions, until: f64, every: f64) -> Vec<Instant> {
    let mut simulation = Simulation::new(arm, inputs, options).unwrap();
    let mut out = Vec::new();
    let sink = |at: &Instant, _: &Simulation| {
        out.push(at.clone());
        true
    };
    simulation.run(until, every, sink).unwrap();
    out
}

/// The same in space.
pub(crate) fn in_space(
    arm: &Arm,
    inputs: Inputs,
    options: MotionOptions,
    until: f64,
    every: f64,
) -> Vec<SpatialInstant> {
    let mut simulation = SpatialSimulation::new(arm, inputs, options).unwrap();
    let mut out = Vec::new();
    let sink = |at: &SpatialInstant, _: &SpatialSimulation| {
        out.push(at.clone());
        true
    };
    simulation.run(until, every, sink).unwrap();
    out
}
