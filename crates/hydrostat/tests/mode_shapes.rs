//! Shapes of small motions against closed forms.

use std::f64::consts::PI;

use hydrostat::{Arm, ModeStation, Volume};

/// First roots of cos b cosh b = -1.
const B: [f64; 3] = [1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613];

/// A uniform rod of 1 m in a vacuum.
fn rod(radius: f64) -> Arm {
    let mut arm = Arm::cone(1.0, radius, radius, 1e9, 0.5);
    arm.density = 1000.0;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm
}

/// Deflection and slope of a clamped-free beam of length 1 in its mode with the root `b`, 1 at the tip.
fn beam(b: f64, s: f64) -> [f64; 2] {
    let ratio = (b.cosh() + b.cos()) / (b.sinh() + b.sin());
    let at = |s: f64| {
        let x = b * s;
        let y = x.cosh() - x.cos() - ratio * (x.sinh() - x.sin());
        [y, b * (x.sinh() + x.sin() - ratio * (x.cosh() - x.cos()))]
    };
    at(s).map(|v| v / at(1.0)[0])
}

/// The largest difference of a part of a shape from a function of s, the imaginary parts from nothing.
fn off(shape: &[ModeStation], part: impl Fn(&ModeStation) -> [f64; 2], want: impl Fn(f64) -> f64) -> f64 {
    let last = (shape.len() - 1) as f64;
    let off = |(k, at): (usize, &ModeStation)| {
        let [re, im] = part(at);
        (re - want(k as f64 / last)).hypot(im)
    };
    shape.iter().enumerate().map(off).fold(0.0, f64::max)
}

#[test]
fn a_slender_rod_bends_as_a_beam() {
    let modes = rod(1e-3).modes(3, 8).unwrap();
    assert_eq!((modes.shapes.len(), modes.sections.len()), (3, 51));
    for (k, (b, shape)) in B.iter().zip(&modes.shapes).enumerate() {
        let bends = off(shape, |at| at.displacement[1], |s| beam(*b, s)[0]);
        let turns = off(shape, |at| at.turn[2], |s| beam(*b, s)[1]);
        // Shear and rotary inertia of a rod 500 times as long as thick.
        assert!(bends < 2e-5 * b * b && turns < 2e-4 * b * b, "{k}: {bends:.1e} {turns:.1e}");
        assert!(off(shape, |at| at.displacement[0], |_| 0.0) < 1e-9);
    }
    let end = modes.sections[50];
    assert!((end.s - 1.0).abs() < 1e-12 && (end.place[0] - 1.0).abs() < 1e-12 && end.directors[2] == [0.0, 0.0, 1.0]);
}

#[test]
fn twins_in_space_bend_across_each_other() {
    // Unequal twins: the base turned about no axis of the page.
    let mut arm = rod(1e-3);
    arm.dynamics.relaxation_time = 1e-3;
    let modes = arm.modes_in_space(6, 6).unwrap();
    for (k, shape) in modes.shapes.iter().enumerate() {
        let (along, across) = (1 + k % 2, 2 - k % 2);
        let bends = off(shape, |at| at.displacement[along], |s| beam(B[k / 2], s)[0]);
        assert!(bends < 1e-4 * (1 + k * k) as f64, "{k}: {bends:.1e}");
        assert!(off(shape, |at| at.displacement[across], |_| 0.0) < 1e-6, "{k}");
        // e1 x e2 = e3: a turn about e3 lifts along e2, one about e2 lowers along e3.
        let (axis, sign) = if along == 1 { (2, 1.0) } else { (1, -1.0) };
        let turns = off(shape, |at| at.turn[axis].map(|v| sign * v), |s| beam(B[k / 2], s)[1]);
        assert!(turns < 1e-3 * (1 + k * k) as f64, "{k}: {turns:.1e}");
    }
}

/// A thick rod twists and stretches in quarter waves.
#[test]
fn twist_and_stretch_are_quarter_waves() {
    let radius = 0.2;
    let modes = rod(radius).modes_in_space(8, 8).unwrap();
    let of = |speed: f64| {
        let want = 0.25 * speed;
        let nearest = |k: &usize| (modes.modes[*k].frequency() - want).abs();
        (0..8).min_by(|a, b| nearest(a).total_cmp(&nearest(b))).unwrap()
    };
    // G = E/3 of what keeps its volume.
    let twist = &modes.shapes[of((1e9_f64 / 3.0 / 1000.0).sqrt())];
    let turns = off(twist, |at| at.turn[0], |s| (0.5 * PI * s).sin() / radius);
    assert!(turns < 1e-5 / radius, "{turns:.1e}");
    assert!(off(twist, |at| at.displacement[1], |_| 0.0) < 1e-7);
    let stretch = &modes.shapes[of((1e9_f64 / 1000.0).sqrt())];
    let moves = off(stretch, |at| at.displacement[0], |s| (0.5 * PI * s).sin());
    assert!(moves < 1e-5, "{moves:.1e}");
}

/// In water that streams past a bent arm shapes are complex; those of the plane are among those in space.
#[test]
fn shapes_in_the_plane_are_among_those_in_space() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.2;
    let (plane, space) = (arm.modes(3, 8).unwrap(), arm.modes_in_space(10, 8).unwrap());
    let mut complex = 0.0_f64;
    for (mode, shape) in plane.modes.iter().zip(&plane.shapes) {
        let distance = |k: &usize| {
            let rate = space.modes[*k].rate;
            (rate[0] - mode.rate[0]).hypot(rate[1] - mode.rate[1])
        };
        let k = (0..space.modes.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        assert!(distance(&k) < 1e-4 * mode.rate[0].hypot(mode.rate[1]), "{mode:?}");
        for (a, b) in shape.iter().zip(&space.shapes[k]) {
            let (a, b) = ([a.displacement, a.turn], [b.displacement, b.turn]);
            for (a, b) in a.as_flattened().as_flattened().iter().zip(b.as_flattened().as_flattened()) {
                assert!((a - b).abs() < 2e-3 * (1.0 + a.abs()), "{mode:?}: {a} {b}");
            }
            complex = complex.max(a[0][1][1].abs());
        }
    }
    assert!(complex > 1e-3, "drag makes waves: {complex}");
}
