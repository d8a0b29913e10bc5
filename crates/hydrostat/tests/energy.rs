//! The balance of energy of the arm in motion: kinetic + strain + dissipated - worked = constant, whatever acts.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/motion.rs"]
mod moving;

use std::f64::consts::PI;

use hydrostat::{
    Arm, Cable, Course, Gravity, Inputs, Instant, Join, Material, MotionOptions, Profile, Simulation, Volume, Works,
};
use moving::{in_plane, inputs, options, pull};

/// A slender uniform rod of 1 m in a vacuum whose first mode has a period of 4.25 s.
fn rod() -> Arm {
    let (rho, r) = (1000.0, 1e-3_f64);
    let young = (2.0 * PI / 4.25 / 1.875_104_069_f64.powi(2)).powi(2) * 4.0 * rho / (r * r);
    let mut arm = Arm::cone(1.0, r, r, young, 0.5);
    arm.density = rho;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm
}

/// The silicone arm with a cable on either side, in a stream.
fn silicone(volume: Volume) -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.flow.speed = 0.1;
    arm.model.volume = volume;
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

fn motion(arm: &Arm, courses: &[(&str, Course)], tol: f64, until: f64) -> Vec<Instant> {
    in_plane(arm, inputs(courses), options(tol), until, 0.013 * until)
}

/// What the balance gains and loses at most, over the largest of its terms.
fn balance(rows: &[Instant]) -> [f64; 2] {
    let kept = |at: &Instant| at.kinetic_energy + at.strain_energy - at.works.sum();
    let first = kept(&rows[0]);
    let largest = rows.iter().flat_map(|at| {
        let Works { cables, water, gravity, loads, base, dissipated, volume } = at.works;
        [at.kinetic_energy, at.strain_energy, cables, water, gravity, loads, base, dissipated, volume]
    });
    let size = largest.fold(0.0, |size: f64, term| size.max(term.abs()));
    let off = rows.iter().map(|at| (kept(at) - first) / size);
    off.fold([0.0, 0.0], |[gain, loss], off: f64| [f64::max(gain, off), f64::max(loss, -off)])
}

/// A smooth push of the tip of [`rod`] that bends it by half its length.
fn push(arm: &Arm) -> (&'static str, Course) {
    let [_, _, ei] = arm.stiffness_at(0.0);
    ("tip.force[1]", Course::Sine { mean: ei, amplitude: ei, frequency: 0.25, phase: -PI / 2.0 })
}

fn assert_balanced(rows: &[Instant], bound: f64) {
    let [gain, loss] = balance(rows);
    assert!(gain < bound && loss < bound, "gained {gain:.1e}, lost {loss:.1e} of the largest term");
}

const LAWS: [Volume; 3] = [Volume::None, Volume::Planar, Volume::Circular];

#[test]
fn energy_is_kept_in_a_vacuum_with_and_without_viscosity() {
    for relaxation_time in [0.0, 0.01] {
        let mut arm = rod();
        arm.dynamics.relaxation_time = relaxation_time;
        for tol in [1e-3, 1e-5] {
            let rows = motion(&arm, &[push(&arm)], tol, 8.0);
            assert_balanced(&rows, tol);
            let works = rows.last().unwrap().works;
            assert!((works.dissipated > 0.0) == (relaxation_time > 0.0), "{works:?}");
            assert_eq!([works.water, works.cables, works.volume], [0.0; 3]);
        }
    }
}

#[test]
fn energy_balances_in_a_stream_with_a_cable_that_is_let_go() {
    for volume in LAWS {
        let rows = motion(&silicone(volume), &[pull()], 1e-4, 1.0);
        assert_balanced(&rows, 1e-4);
        let works = rows.last().unwrap().works;
        assert!(works.cables > 0.0 && works.water < 0.0 && works.dissipated > 0.0, "{works:?}");
        assert!((volume == Volume::None) == (works.volume.abs() < 1e-15), "{works:?}");
    }
}

#[test]
fn energy_balances_with_strokes_commanded() {
    for volume in LAWS {
        let reel = ("cable[0].stroke", Course::ramp(0.0, 0.011, 0.0, 0.2));
        assert_balanced(&motion(&silicone(volume), &[reel], 1e-4, 1.0), 2e-4);
    }
}

#[test]
fn energy_balances_with_a_base_that_moves_under_gravity() {
    for volume in LAWS {
        let mut arm = silicone(volume);
        arm.gravity = Some(Gravity::default());
        let base = [
            ("arm.base.angle", Course::Sine { mean: 0.2, amplitude: 0.3, frequency: 1.0, phase: 0.0 }),
            ("arm.base.x", Course::ramp(0.0, 0.05, 0.1, 0.4)),
            ("arm.base.y", Course::Sine { mean: 0.0, amplitude: 0.03, frequency: 2.0, phase: 0.0 }),
        ];
        let rows = motion(&arm, &base, 1e-4, 1.0);
        assert_balanced(&rows, 1e-4);
        assert!(rows.last().unwrap().works.base > 0.01);
    }
}

#[test]
fn energy_balances_with_loads_along_the_arm_in_a_stream_that_changes() {
    for volume in LAWS {
        let mut arm = silicone(volume);
        arm.gravity = Some(Gravity::default());
        arm.tip.follower = [0.0, 0.01];
        arm.tip.moment = 0.001;
        arm.distributed.force[1] = Profile::linear(0.1, 0.3);
        arm.distributed.couple = Profile::linear(0.003, 0.001);
        let swell = ("flow.speed", Course::Sine { mean: 0.1, amplitude: 0.1, frequency: 1.0, phase: 0.0 });
        assert_balanced(&motion(&arm, &[swell], 1e-4, 1.0), 1e-5);
    }
}

/// Works by what is seen from outside: a cable's tension over its stroke.
#[test]
fn the_work_of_a_cable_is_its_tension_over_its_stroke() {
    let arm = silicone(Volume::Planar);
    let mut inputs = Inputs::default();
    inputs.set("cable[0].tension", Course::ramp(0.0, 0.2, 0.0, 0.2)).unwrap();
    let mut simulation = Simulation::new(&arm, inputs, MotionOptions::default()).unwrap();
    let (mut before, mut work) = (simulation.now(), 0.0);
    for _ in 0..400 {
        let at = simulation.step(1e-3).unwrap();
        let [a, b] = [&before, &at].map(|at| at.cables[0]);
        work += 0.5 * (a.tension + b.tension) * (b.stroke - a.stroke);
        before = at;
    }
    assert!((before.works.cables / work - 1.0).abs() < 1e-3, "{} {work}", before.works.cables);
}

/// A rigid rod on a soft hinge that is let go level: the hinge carries a quarter of its weight at first, 2.5 times it
/// at the bottom, and weight does m g L/2 of work on the way.
#[test]
fn the_hinge_of_a_rod_that_falls_carries_what_the_closed_form_says() {
    let (length, d, radius) = (1.0, 1e-5, 0.02);
    let area = PI * radius * radius;
    let weight = 1000.0 * area * length * 9.81;
    let mut arm = Arm::cone(length, radius, radius, 1.0, 0.5);
    arm.model.volume = Volume::None;
    arm.density = 1000.0;
    arm.flow.density = 0.0;
    arm.gravity = Some(Gravity::default());
    let stiff: Profile = (1e6 * weight / area).into();
    let [soft, rigid] = [3e-5 * weight * length * d / area, 1e5 * weight * length * length / area];
    let bending = Profile::joined(&[[0.0, soft], [d, soft], [1.01 * d, rigid], [length, rigid]], Join::Linear).unwrap();
    arm.material = Material::Coefficients { c1: stiff.clone(), c2: stiff, c3: bending };
    arm.dynamics.relaxation_time = 1e-5;
    let mut inputs = Inputs::default();
    inputs.set("gravity.direction", Course::step(0.0, -PI / 2.0, 0.0)).unwrap();
    let options = MotionOptions { tol: 1e-5, ..MotionOptions::default() };
    let mut simulation = Simulation::new(&arm, inputs, options).unwrap();
    let first = simulation.now().base_reaction;
    assert!((first.force[0] / -weight - 1.0).abs() < 1e-6, "{first:?}");
    let thickness = 1.0 + 0.75 * radius * radius;
    let early = simulation.advance_to(0.03).unwrap().base_reaction;
    assert!((early.force[1] / weight - 0.25).abs() < 5e-3, "{early:?}");
    // Where the rod passes the bottom all of m g L/2 is kinetic.
    let mut most = 0.0_f64;
    let mut bottom = simulation.now();
    while bottom.time < 1.0 {
        bottom = simulation.step(2e-3).unwrap();
        most = most.max(bottom.base_reaction.force[1]);
        let fallen = -0.5 * weight * bottom.tip[1];
        assert!((bottom.works.gravity - fallen).abs() < 1e-3 * weight, "{bottom:?} {fallen}");
    }
    let want = 1.0 + 1.5 / thickness;
    assert!((most / weight / want - 1.0).abs() < 2e-3, "{} {want}", most / weight);
}

/// What the estimate said after a jump without relaxation time was less than a fifth of the error.
#[test]
fn the_estimate_of_a_jump_that_is_not_resolved_was_too_low() {
    let mut arm = silicone(Volume::Planar);
    arm.dynamics.relaxation_time = 0.0;
    let run = |tol: f64| {
        let (key, course) = pull();
        let mut inputs = Inputs::default();
        inputs.set(key, course).unwrap();
        let own = MotionOptions { tol, elements: Some(8), ..MotionOptions::default() };
        let mut simulation = Simulation::new(&arm, inputs, own).unwrap();
        let mut tips = Vec::new();
        let sink = |at: &Instant, _: &Simulation| {
            tips.push(at.tip);
            true
        };
        simulation.run(0.7, 0.02, sink).unwrap();
        (tips, simulation.error_estimate())
    };
    let (best, _) = run(2e-5);
    for tol in [1e-3, 2e-4] {
        let (tips, estimate) = run(tol);
        let apart = tips.iter().zip(&best).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
        let error = apart.fold(0.0, f64::max);
        assert!(error > tol * arm.length, "resolved after all: {error:.1e}");
        assert!(error < estimate && estimate < 10.0 * error, "{error:.1e}, said {estimate:.1e}");
    }
}
