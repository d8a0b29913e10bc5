//! Small motions of the arm in space against closed forms, those in the plane, and its motion.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/motion.rs"]
mod moving;

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/space.rs"]
mod space;

use std::f64::consts::PI;

use hydrostat::{Arm, Course, Mode, MotionOptions, SpatialInstant, Volume};
use moving::{in_space as motion, inputs, options};
use space::{rotation, silicone, three_cables, turned_arm};

/// First roots of cos b cosh b = -1.
const B: [f64; 3] = [1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613];

const DENSITY: f64 = 1000.0;

/// A uniform rod of 1 m in a vacuum.
fn rod(radius: f64, young: f64) -> Arm {
    let mut arm = Arm::cone(1.0, radius, radius, young, 0.5);
    arm.density = DENSITY;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm
}

/// sqrt(EI/(rho A L^4)).
fn unit(arm: &Arm) -> f64 {
    let r = arm.radius.at(0.0, arm.length).value;
    let [_, _, ei] = arm.stiffness_at(0.0);
    (ei / (DENSITY * PI * r * r)).sqrt()
}

fn modes(arm: &Arm, count: usize, elements: usize) -> Vec<Mode> {
    arm.modes_in_space(count, elements).unwrap().modes
}

fn nearest(modes: &[Mode], rate: [f64; 2]) -> f64 {
    let off = |mode: &Mode| (mode.rate[0] - rate[0]).hypot(mode.rate[1] - rate[1]);
    modes.iter().map(off).fold(f64::INFINITY, f64::min) / rate[0].hypot(rate[1])
}

#[test]
fn a_round_rod_bends_to_all_sides_at_the_frequencies_of_the_beam() {
    let mut arm = rod(1e-3, 1e9);
    let dry = modes(&arm, 6, 6);
    for (k, mode) in dry.iter().enumerate() {
        let want = B[k / 2] * B[k / 2] * unit(&arm);
        assert!((mode.rate[1] / want - 1.0).abs() < 1e-4 && mode.rate[0] == 0.0, "{k}: {mode:?} {want}");
    }
    // Water moves along across the arm.
    arm.flow.density = 500.0;
    let fall = (DENSITY / (DENSITY + 500.0)).sqrt();
    for (wet, dry) in modes(&arm, 6, 6).iter().zip(&dry) {
        assert!((wet.rate[1] / dry.rate[1] / fall - 1.0).abs() < 1e-5, "{wet:?} {dry:?}");
    }
}

#[test]
fn a_thick_rod_twists_and_stretches_at_the_speeds_of_its_waves() {
    let arm = rod(0.05, 1e6);
    let all = modes(&arm, 12, 6);
    let (stretch, twist) = ((1e6_f64 / DENSITY).sqrt(), (1e6 / 3.0 / DENSITY).sqrt());
    for want in [0.5 * PI * twist, 1.5 * PI * twist, 0.5 * PI * stretch] {
        assert!(nearest(&all, [0.0, want]) < 1e-8, "{want} {all:?}");
    }
    // Bending is that in the plane, twice.
    for own in arm.modes(3, 6).unwrap().modes {
        let same = all.iter().filter(|mode| (mode.rate[1] / own.rate[1] - 1.0).abs() < 1e-8).count();
        assert!(same == 2 || (own.rate[1] / (0.5 * PI * stretch) - 1.0).abs() < 1e-8, "{same} of {own:?} in {all:?}");
    }
}

/// An arm in a stream, bent by a cable, whose material has a memory of rate: the motions in its plane are among all.
#[test]
fn motions_in_the_plane_are_among_those_in_space() {
    let mut arm = silicone();
    arm.cables[0].tension = 0.1;
    arm.flow.speed = 0.1;
    arm.flow.direction = 0.4;
    let turned = turned_arm(&arm, &rotation(0.7, -0.4, 1.9));
    for relaxation in [0.0, 2.7e-3] {
        let with = |arm: &Arm| {
            let mut arm = arm.clone();
            arm.dynamics.relaxation_time = relaxation;
            arm
        };
        let flat = with(&arm).modes(4, 12).unwrap().modes;
        let all = modes(&with(&turned), 10, 12);
        for own in flat {
            let off = nearest(&all, own.rate);
            assert!(off < 1e-5, "{relaxation}: {off:.1e} {own:?} in {all:?}");
        }
    }
}

#[test]
fn becks_rod_flutters_from_twenty_on_in_space() {
    let mut arm = rod(1e-3, 1e9);
    let [_, _, ei] = arm.stiffness_at(0.0);
    let mut at = |load: f64| {
        arm.tip.follower = [-load * ei, 0.0];
        arm.modes_in_space(6, 6).unwrap()
    };
    assert!(at(20.049).is_stable());
    let past = at(20.053);
    assert!(past.modes.iter().any(Mode::is_flutter), "{past:?}");
    let rate = at(21.0).modes.iter().map(|mode| mode.rate[0]).fold(0.0, f64::max);
    assert!((rate / unit(&rod(1e-3, 1e9)) - 2.1254).abs() < 2e-3, "{rate}");
}

/// An arm that gravity, stream and three cables bend out of any plane, let go from a small push: after a while its two
/// slowest motions are left, which decay.
#[test]
fn an_arm_bent_in_space_comes_to_rest_as_its_modes_say() {
    let mut arm = three_cables();
    arm.dynamics.relaxation_time = 2.7e-3;
    let all = arm.modes_in_space(8, 12).unwrap();
    assert!(all.is_stable());
    let release = inputs(&[("tip.force[1]", Course::step(1e-4, arm.tip.force[1], 0.0))]);
    let every = 0.25;
    let rows = motion(&arm, release, MotionOptions { elements: Some(12), ..options(1e-8) }, 5.0, every);
    let moved = |pair: &[SpatialInstant]| {
        let [from, to] = [&pair[0].tip, &pair[1].tip];
        [to.x - from.x, to.y - from.y, to.z - from.z]
    };
    // From 2 s on, when faster ones are over.
    let ways: Vec<[f64; 3]> = rows.windows(2).skip(8).map(moved).collect();
    // d(t + 2 h) = (p + q) d(t + h) - p q d(t) with p, q the decays in h = 2 rows, by least squares.
    let (mut matrix, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
    for own in ways.windows(5) {
        for k in 0..3 {
            let [now, next, after] = [own[0][k], own[2][k], own[4][k]];
            for (i, a) in [next, now].into_iter().enumerate() {
                matrix[i][0] += a * next;
                matrix[i][1] += a * now;
                right[i] += a * after;
            }
        }
    }
    let [[a, b], [c, d]] = matrix;
    let determinant = a * d - b * c;
    let sum = (right[0] * d - b * right[1]) / determinant;
    let product = (right[0] * c - a * right[1]) / determinant;
    let root = (0.25 * sum * sum - product).sqrt();
    let mut slow: Vec<f64> = all.modes.iter().filter(|mode| mode.rate[1] == 0.0).map(|mode| mode.rate[0]).collect();
    slow.sort_by(|a, b| b.total_cmp(a));
    for (found, want) in [0.5 * sum + root, 0.5 * sum - root].into_iter().zip(slow) {
        let found = found.ln() / (2.0 * every);
        assert!((found / want - 1.0).abs() < 3e-3, "{found} {want}");
    }
}
