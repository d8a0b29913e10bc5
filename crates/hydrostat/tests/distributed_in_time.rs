//! Loads along the arm that change in time, along a path and along a history: closed forms and the statics.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/motion.rs"]
mod moving;

use std::f64::consts::PI;

use hydrostat::{
    Arm, Course, Inputs, Loading, MotionError, MotionOptions, Options, Parameter, PathOptions, Profile, Solver, Space,
    SpatialSolver, Volume,
};
use moving::{in_plane, in_space, inputs, options};

/// Roots of cos b cosh b = -1, and sigma of the modes cosh - cos - sigma (sinh - sin).
const MODES: [[f64; 2]; 3] = [
    [1.875_104_068_711_961, 0.734_095_514],
    [4.694_091_132_974_175, 1.018_467_319],
    [7.854_757_438_237_613, 0.999_224_497],
];

/// First period of [`rod`], s.
const PERIOD: f64 = 4.25;

/// A slender uniform rod of 1 m in a vacuum, R/L = 1e-3.
fn rod() -> Arm {
    let (rho, r) = (1000.0, 1e-3_f64);
    let [b, _] = MODES[0];
    let young = (2.0 * PI / PERIOD / (b * b)).powi(2) * 4.0 * rho / (r * r);
    let mut arm = Arm::cone(1.0, r, r, young, 0.5);
    arm.density = rho;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm
}

/// The tip (over w L^4/EI) of a cantilever at rest whose uniform load rises from zero to w within `rise` (s).
fn tip_of_beam(time: f64, rise: f64) -> f64 {
    let [first, _] = MODES[0];
    let mode = |(k, [b, sigma]): (usize, &[f64; 2])| {
        let omega = 2.0 * PI / PERIOD * (b / first).powi(2);
        // What a load that rises for good moves the mode by.
        let rising = |t: f64| if t > 0.0 { (t - (omega * t).sin() / omega) / rise } else { 0.0 };
        let at_tip = if k % 2 == 0 { 2.0 } else { -2.0 };
        at_tip * (2.0 * sigma / b) / b.powi(4) * (rising(time) - rising(time - rise))
    };
    MODES.iter().enumerate().map(mode).sum()
}

#[test]
fn a_load_along_a_beam_that_rises_swings_it_as_its_modes_say() {
    let arm = rod();
    let [_, _, ei] = arm.stiffness_at(0.0);
    // 1e-3 L at rest: the beam is linear to 1e-6.
    let (load, rise) = (8e-3 * ei, 0.3 * PERIOD);
    let swing = |key: &str| inputs(&[(key, Course::ramp(0.0, load, 0.0, rise))]);
    let plan = || (MotionOptions { elements: Some(4), ..options(1e-7) }, 2.0 * PERIOD, 0.05 * PERIOD);
    let (own, until, every) = plan();
    for at in in_plane(&arm, swing("distributed.force[1]"), own, until, every) {
        let off = at.tip[1] - 8e-3 * tip_of_beam(at.time, rise);
        assert!(off.abs() < 3e-6, "{}: {off:.1e}", at.time);
    }
    let spatial = Arm { space: Some(Space::default()), ..arm };
    for (key, axis) in [("distributed.force[1]", 1), ("distributed.force[2]", 2)] {
        let (own, until, every) = plan();
        for at in in_space(&spatial, swing(key), own, until, every) {
            let off = [at.tip.x, at.tip.y, at.tip.z][axis] - 8e-3 * tip_of_beam(at.time, rise);
            assert!(off.abs() < 3e-6, "{key} at {}: {off:.1e}", at.time);
        }
    }
}

/// A silicone arm that damps its swings well.
fn damped() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.004, 110e3, 0.5);
    arm.dynamics.relaxation_time = 0.1;
    arm
}

#[test]
fn slow_loads_along_the_arm_end_at_the_static_shape() {
    let ends = [
        ("distributed.force[0]", -0.05),
        ("distributed.force[1].base", 0.1),
        ("distributed.force[1].tip", 0.05),
        ("distributed.couple", 2e-4),
    ];
    let mut arm = damped();
    arm.distributed.force[1] = Profile::linear(0.0, 0.0);
    let mut spatial = Arm { space: Some(Space::default()), ..arm.clone() };
    let rise = |ends: &[(&str, f64)]| {
        let courses: Vec<(&str, Course)> =
            ends.iter().map(|(key, end)| (*key, Course::ramp(0.0, *end, 0.0, 2.0))).collect();
        inputs(&courses)
    };
    let mut still = arm.clone();
    for (key, value) in ends {
        key.parse::<Parameter>().unwrap().set(&mut still, value).unwrap();
    }
    let still = still.solve().unwrap();
    let bent = still.tip().y / arm.length;
    assert!(bent > 0.05, "{bent}");
    let last = in_plane(&arm, rise(&ends), options(1e-4), 30.0, 30.0).pop().unwrap();
    let off = (last.tip[0] - still.tip().x).hypot(last.tip[1] - still.tip().y) / arm.length;
    assert!(off < 1e-4, "{off:.1e}");

    let out_of_plane =
        [("distributed.force[2]", 0.05), ("distributed.couple[0]", 5e-5), ("distributed.couple[1]", -1e-4)];
    let all: Vec<(&str, f64)> = ends.into_iter().chain(out_of_plane).collect();
    let last = in_space(&spatial, rise(&all), options(1e-4), 30.0, 30.0).pop().unwrap();
    for (key, value) in all {
        key.parse::<Parameter>().unwrap().set(&mut spatial, value).unwrap();
    }
    let still = SpatialSolver::new(&spatial, Options::default()).unwrap().solve().unwrap();
    let [tip, at] = [still.tip(), last.tip];
    let off = (tip.x - at.x).hypot(tip.y - at.y).hypot(tip.z - at.z) / spatial.length;
    assert!(off < 1e-4 && tip.z.abs() > 0.03 * spatial.length, "{off:.1e} {tip:?}");
    let turned = (0..3).map(|k| (tip.b[k] - at.b[k]).abs()).fold(0.0, f64::max);
    assert!(turned < 1e-3, "{turned:.1e}");
}

/// The inputs of a motion, a path and a history take the same names, and refuse what the arm gives in another way.
#[test]
fn a_path_and_a_history_of_a_load_along_the_arm_end_where_a_solve_does() {
    let arm = damped();
    let parameter: Parameter = "distributed.force[1]".parse().unwrap();
    let mut loaded = arm.clone();
    parameter.set(&mut loaded, 0.15).unwrap();
    let still = loaded.solve().unwrap();
    let path = arm.path(parameter, [0.0, 0.15], &PathOptions::default()).unwrap();
    let end = path.branches[0].points.last().unwrap().configuration.tip();
    let off = (end.x - still.tip().x).hypot(end.y - still.tip().y) / arm.length;
    assert!(off < 1e-6 && still.tip().y > 0.1 * arm.length, "{off:.1e} {:?}", still.tip());
    let (mut history, _) = Loading::<Solver>::start(&arm, 1e-8).unwrap();
    let step = history.go_to(&loaded).unwrap();
    let at = step.configuration.tip();
    let off = (at.x - still.tip().x).hypot(at.y - still.tip().y) / arm.length;
    assert!(off < 1e-6 && step.snaps.is_empty(), "{off:.1e}");

    let mut given = arm.clone();
    given.distributed.force[1] = Profile::linear(0.1, 0.2);
    let mut whole = Inputs::default();
    whole.set("distributed.force[1]", Course::constant(0.3)).unwrap();
    let Err(MotionError::Unfit(unfit)) = whole.arm_at(&given, 0.0) else { panic!("its ends are given") };
    let words = unfit.to_string();
    assert!(words.ends_with("it has `distributed.force[1].base` to `distributed.force[1].tip`"), "{words}");
    assert!("distributed.force[2]".parse::<Parameter>().unwrap().of(&arm).is_err(), "it is in the plane");
}

/// Derivatives by loads along the arm are those of differences; an arm without them has none among its parameters.
#[test]
fn derivatives_by_loads_along_the_arm_are_differences() {
    let mut arm = damped();
    assert!(!Parameter::all_of(&arm).iter().any(|own| own.to_string().starts_with("distributed")));
    arm.distributed.force[1] = 0.1.into();
    arm.distributed.couple = Profile::linear(2e-4, 0.0);
    let mut solver = Solver::new(&arm, Options::default()).unwrap();
    solver.solve().unwrap();
    let all: Vec<Parameter> =
        Parameter::all_of(&arm).into_iter().filter(|own| own.to_string().starts_with("distributed")).collect();
    assert_eq!(all.len(), 3, "{all:?}");
    let found = solver.sensitivities(&all).unwrap();
    for (k, parameter) in all.into_iter().enumerate() {
        let value = parameter.of(&arm).unwrap();
        let step = 1e-3 * value.abs().max(1e-3);
        let tip = |by: f64| {
            let mut moved = arm.clone();
            parameter.set(&mut moved, value + by).unwrap();
            moved.solve().unwrap().tip().y
        };
        let expected = (tip(step) - tip(-step)) / (2.0 * step);
        assert!((found.tip[k].y - expected).abs() < 1e-4 * expected.abs(), "{parameter}: {expected}");
    }
}
