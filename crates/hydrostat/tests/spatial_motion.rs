//! The arm in motion in space against closed forms, the motion in the plane, the statics and its own energy.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/motion.rs"]
mod moving;

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/space.rs"]
mod space;

use std::f64::consts::PI;

use hydrostat::{
    Arm, Course, FlowLaw, Gravity, Inputs, MotionEventKind, MotionOptions, Simulation, Space, SpatialInstant,
    SpatialSimulation, Volume, Works,
};
use moving::{in_plane, in_space as motion, inputs, options};
use space::{apart, rotation, silicone, solved, three_cables, tip, turned, turned_arm};

/// A number of an instant.
type Of = fn(&SpatialInstant) -> f64;

/// First root of cos b cosh b = -1.
const B: f64 = 1.875_104_068_711_961;

/// First period of [`rod`], s.
const PERIOD: f64 = 4.25;

/// A slender uniform rod of 1 m in a vacuum, in space.
fn rod(r: f64) -> Arm {
    let rho = 1000.0;
    // omega_1 = b_1^2 sqrt(E r^2/(4 rho))/L^2.
    let young = (2.0 * PI / PERIOD / (B * B)).powi(2) * 4.0 * rho / (r * r);
    let mut arm = Arm::cone(1.0, r, r, young, 0.5);
    arm.density = rho;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm.space = Some(Space::default());
    arm
}

fn place(at: &SpatialInstant) -> [f64; 3] {
    [at.tip.x, at.tip.y, at.tip.z]
}

/// By how much the frequency of `of` is off that of a first mode that swings once in `per` rows: how far
/// its phase drifts over ten periods.
fn frequency_off(rows: &[SpatialInstant], per: usize, omega: f64, of: impl Fn(&SpatialInstant) -> f64) -> f64 {
    let count = 4 * per;
    let phase = |from: usize| {
        let window = |i: usize| 0.5 - 0.5 * (2.0 * PI * i as f64 / count as f64).cos();
        let [mut re, mut im] = [0.0, 0.0];
        for i in 0..count {
            let at = &rows[from + i];
            re += window(i) * of(at) * (omega * at.time).cos();
            im += window(i) * of(at) * (omega * at.time).sin();
        }
        im.atan2(re)
    };
    let far = 10 * per;
    (phase(far) - phase(0)) / (rows[far].time - rows[0].time) / omega
}

#[test]
fn small_swings_have_the_frequency_of_the_beam_both_ways() {
    let arm = rod(1e-3);
    let [_, _, ei] = arm.stiffness_at(0.0);
    let pull = |size: f64| Course::step(size * ei, 0.0, 0.0);
    let pulls = inputs(&[("tip.force[1]", pull(3e-3)), ("tip.force[2]", pull(-2e-3))]);
    let per = 40;
    let how = MotionOptions { elements: Some(4), ..options(1e-6) };
    let rows = motion(&arm, pulls, how, 14.0 * PERIOD, PERIOD / per as f64);
    for k in [1, 2] {
        let off = frequency_off(&rows, per, 2.0 * PI / PERIOD, |at| place(at)[k]);
        assert!(off.abs() < 2e-5, "direction {k}: off by {off:.1e}");
    }
}

#[test]
fn torsion_and_stretch_waves_run_at_their_speeds() {
    let (arm, per) = (rod(1e-3), 40);
    let hydrostat::Material::Homogeneous { young, .. } = arm.material else { panic!("a homogeneous arm") };
    let rho = arm.density;
    let shear = young / 3.0;
    let twist: Of = |at| at.tip.b[2].atan2(at.tip.b[1]);
    let stretch: Of = |at| at.tip.x - 1.0;
    let size = 1e-3 * PI * 0.25e-12 * shear;
    for (key, modulus, of, size) in
        [("tip.moment[0]", shear, twist, size), ("tip.force[0]", young, stretch, 1e-6 * PI * young * 1e-3)]
    {
        let omega = 0.5 * PI * (modulus / rho).sqrt();
        let period = 2.0 * PI / omega;
        let release = inputs(&[(key, Course::step(size, 0.0, 0.0))]);
        let how = MotionOptions { elements: Some(4), step: Some(period / 100.0), ..options(1e-6) };
        let rows = motion(&arm, release, how, 14.0 * period, period / per as f64);
        let off = frequency_off(&rows, per, omega, of);
        assert!(off.abs() < 1e-5, "{key}: off by {off:.1e}");
    }
}

/// The planar rod pulled across and let go, and a whip of the silicone arm, in five planes.
#[test]
fn motion_in_any_plane_is_that_in_the_plane() {
    let mut free = rod(1e-3);
    free.space = None;
    let [_, _, ei] = free.stiffness_at(0.0);
    free.tip.force = [0.0, 2.0 * ei];
    let mut whip = silicone();
    whip.flow.speed = 0.1;
    whip.flow.direction = 0.4;
    whip.gravity = Some(Gravity { acceleration: 9.81, direction: -1.0 });
    whip.dynamics.relaxation_time = 2.7e-3;
    let mut drag = whip.clone();
    drag.flow.law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.01 };
    drag.model.volume = Volume::Circular;
    let pull = Course::Table(vec![(0.0, 0.0), (0.2, 0.2), (0.3, 0.2), (0.3, 0.0)]);
    for (arm, released, until) in [(free, true, 0.5 * PERIOD), (whip, false, 0.6), (drag, false, 0.5)] {
        let tol = 1e-4;
        let loads = |space: Option<&[[f64; 3]; 3]>| {
            if !released {
                return inputs(&[("cable[0].tension", pull.clone())]);
            }
            let force = space.map_or([0.0, arm.tip.force[1], 0.0], |m| turned(m, [0.0, arm.tip.force[1], 0.0]));
            let keys = ["tip.force[0]", "tip.force[1]", "tip.force[2]"];
            let courses = keys.into_iter().zip(force).take(if space.is_some() { 3 } else { 2 });
            inputs(&courses.map(|(key, force)| (key, Course::step(force, 0.0, 0.0))).collect::<Vec<_>>())
        };
        let every = until / 10.0;
        let flat = in_plane(&arm, loads(None), options(tol), until, every);
        let planes = [(0.7, -0.4, 1.9), (2.5, 1.1, -0.3), (-1.2, 0.2, 2.8), (0.3, -1.4, 0.6), (0.0, 0.0, 0.0)];
        for (a, b, c) in planes.into_iter().take(if released { 5 } else { 3 }) {
            let m = rotation(a, b, c);
            let rows = motion(&turned_arm(&arm, &m), loads(Some(&m)), options(tol), until, every);
            for (flat, at) in flat.iter().zip(&rows) {
                let expected = turned(&m, [flat.tip[0], flat.tip[1], 0.0]);
                let off = apart(expected, place(at)) / arm.length;
                assert!(off < 2.0 * tol, "{off:.1e} at {} s in the plane of {a} {b} {c}", at.time);
                let normal = turned(&m, [0.0, 0.0, 1.0]);
                assert!(apart(at.tip.c, normal) < 1e-6, "c leaves the normal of the plane: {:?}", at.tip.c);
                let energy = (at.kinetic_energy - flat.kinetic_energy).abs();
                assert!(energy < 1e-2 * (flat.strain_energy + flat.kinetic_energy).max(1e-5), "{energy:.1e}");
            }
        }
    }
}

/// What the balance gains or loses at most, over the largest of its terms.
fn balance(rows: &[SpatialInstant]) -> f64 {
    let kept = |at: &SpatialInstant| at.kinetic_energy + at.strain_energy - at.works.sum();
    let first = kept(&rows[0]);
    let largest = rows.iter().flat_map(|at| {
        let Works { cables, water, gravity, loads, base, dissipated, volume } = at.works;
        [at.kinetic_energy, at.strain_energy, cables, water, gravity, loads, base, dissipated, volume]
    });
    let size = largest.fold(0.0, |size: f64, term| size.max(term.abs()));
    rows.iter().map(|at| (kept(at) - first).abs() / size).fold(0.0, f64::max)
}

#[test]
fn a_whirling_rod_keeps_its_energy() {
    // Thick enough for its rotary inertia to matter.
    let arm = rod(0.05);
    let [_, _, ei] = arm.stiffness_at(0.0);
    // Pulled aside, pushed sideways as it is let go, and twisted.
    let pulse = |size: f64| Course::Table(vec![(0.0, 0.0), (0.1 * PERIOD, size), (0.2 * PERIOD, 0.0)]);
    let pull = Course::Table(vec![(0.0, 1.5 * ei), (0.1 * PERIOD, 0.0)]);
    let loads =
        inputs(&[("tip.force[1]", pull), ("tip.force[2]", pulse(2.0 * ei)), ("tip.moment[0]", pulse(0.3 * ei))]);
    let rows = motion(&arm, loads, options(1e-5), 2.2 * PERIOD, 0.05 * PERIOD);
    let free: Vec<f64> =
        rows.iter().filter(|at| at.time > 0.21 * PERIOD).map(|at| at.kinetic_energy + at.strain_energy).collect();
    let off = free.iter().map(|energy| (energy / free[0] - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 1e-3, "{off:.1e}");
    assert!(balance(&rows) < 1e-3, "{:.1e}", balance(&rows));
    let most = |k: usize| rows.iter().map(|at| place(at)[k].abs()).fold(0.0, f64::max);
    assert!(most(1) > 0.3 && most(2) > 0.3, "{} {}", most(1), most(2));
}

#[test]
fn energy_balances_whatever_acts() {
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        let mut arm = three_cables();
        arm.model.volume = volume;
        arm.dynamics.relaxation_time = 2.7e-3;
        let pull = |size: f64| Course::Table(vec![(0.0, 0.0), (0.1, size), (0.2, 0.3 * size)]);
        let loads = inputs(&[
            ("cable[0].tension", pull(0.1)),
            ("cable[1].tension", pull(0.15)),
            ("tip.force[2]", pull(0.003)),
            ("flow.speed", Course::ramp(0.05, 0.15, 0.0, 0.3)),
            ("arm.base.z", Course::ramp(0.0, 0.01, 0.05, 0.25)),
        ]);
        let rows = motion(&arm, loads, options(1e-4), 0.4, 0.02);
        assert!(balance(&rows) < 1e-3, "{volume:?}: {:.1e}", balance(&rows));
    }
}

#[test]
fn motion_ends_in_the_equilibrium() {
    let mut arm = three_cables();
    arm.dynamics.relaxation_time = 2.7e-3;
    let still = solved(&arm, 1e-9);
    let loads = inputs(&[("cable[0].tension", Course::step(0.2, arm.cables[0].tension, 0.0))]);
    let rows = motion(&arm, loads, options(1e-5), 8.0, 1.0);
    let off = apart(tip(&still), place(&rows[8])) / arm.length;
    assert!(off < 2e-5, "{off:.1e}");
    assert!(apart(still.tip().b, rows[8].tip.b) < 1e-4);
    for (cable, own) in still.cables.iter().zip(&rows[8].cables) {
        assert!((cable.stroke - own.stroke).abs() < 1e-5 * arm.length, "{} {own:?}", cable.stroke);
    }
    assert!(apart(still.base_reaction.force, rows[8].base_reaction.force) < 1e-5);
    // At rest from the start, it stays.
    let rows = motion(&arm, Inputs::default(), options(1e-5), 1.0, 0.5);
    assert!(apart(tip(&still), place(&rows[2])) < 1e-6 * arm.length);
    let turned = apart(still.tip().b, rows[2].tip.b);
    assert!(turned < 1e-7, "{turned:.1e}");
    for (cable, own) in still.cables.iter().zip(&rows[2].cables) {
        assert!((cable.stroke - own.stroke).abs() < 1e-8 * arm.length, "{} {own:?}", cable.stroke);
    }
}

/// Reeled in out of the plane in 0.2 s and held, then let out until the cable hangs slack.
#[test]
fn commanded_strokes_are_met_and_end_in_their_equilibrium() {
    let mut arm = three_cables();
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.cables.iter_mut().for_each(|cable| cable.tension = 0.0);
    arm.cables[1].stroke = Some(0.0);
    let reel = Course::Table(vec![(0.0, 0.0), (0.2, 0.011), (7.0, 0.011), (7.2, -0.02)]);
    let loads = inputs(&[("cable[1].stroke", reel.clone())]);
    let mut simulation = SpatialSimulation::new(&arm, loads, options(1e-4)).unwrap();
    for k in 1..=14 {
        let at = simulation.advance_to(0.5 * f64::from(k)).unwrap();
        let (command, _) = reel.before(at.time);
        assert!((at.cables[1].stroke - command).abs() < 2e-4 * arm.length, "{at:?}");
        assert!(at.cables[1].tension >= 0.0);
    }
    let end = simulation.now();
    arm.cables[1].stroke = Some(0.011);
    let still = solved(&arm, 1e-8);
    let off = apart(tip(&still), place(&end)) / arm.length;
    assert!(off < 2e-4, "{off:.1e}");
    assert!((end.cables[1].tension / still.cables[1].tension - 1.0).abs() < 1e-2, "{end:?}");
    let slack = simulation.advance_to(7.4).unwrap();
    assert_eq!(slack.cables[1].tension, 0.0);
    assert!(simulation.events().iter().any(|event| event.kind == MotionEventKind::Slack(1)));
}

#[test]
fn arms_in_space_are_refused_in_the_plane_by_name() {
    let refused = Simulation::new(&three_cables(), Inputs::default(), MotionOptions::default());
    assert!(refused.is_err_and(|error| error.to_string().contains("SpatialSimulation")));
}
