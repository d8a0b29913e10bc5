//! The arm in motion against closed forms and against the statics.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/motion.rs"]
mod moving;

use std::f64::consts::PI;

use hydrostat::{
    Arm, Cable, Course, Dynamics, FlowLaw, Gravity, Inputs, Instant, Join, Material, MotionError, MotionOptions,
    MotionVerdictKind, Profile, Simulation, Volume,
};
use moving::{in_plane as motion, inputs, options};

/// First roots of cos b cosh b = -1.
const B: [f64; 3] = [1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613];

/// First period of [`rod`], s.
const PERIOD: f64 = 4.25;

/// A slender uniform rod of 1 m in a vacuum, R/L = 1e-3.
fn rod() -> Arm {
    let (rho, r) = (1000.0, 1e-3_f64);
    // omega_1 = b_1^2 sqrt(E r^2/(4 rho))/L^2.
    let young = (2.0 * PI / PERIOD / (B[0] * B[0])).powi(2) * 4.0 * rho / (r * r);
    let mut arm = Arm::cone(1.0, r, r, young, 0.5);
    arm.density = rho;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    arm
}

/// The silicone arm of Renda et al. with one cable on either side.
fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

/// Largest distance of two motions' tips, m.
fn distance(a: &[Instant], b: &[Instant]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a.tip[0] - b.tip[0]).hypot(a.tip[1] - b.tip[1])).fold(0.0, f64::max)
}

/// Times at which `of` passes zero, by the cubic through value and rate at the rows.
fn crossings(rows: &[Instant], of: impl Fn(&Instant) -> [f64; 2]) -> Vec<f64> {
    let mut out = Vec::new();
    for pair in rows.windows(2) {
        let h = pair[1].time - pair[0].time;
        let ([y, v], [z, w]) = (of(&pair[0]), of(&pair[1]));
        if y * z >= 0.0 {
            continue;
        }
        let at = |x: f64| {
            let (x2, x3) = (x * x, x * x * x);
            (1.0 - 3.0 * x2 + 2.0 * x3) * y
                + (x - 2.0 * x2 + x3) * h * v
                + (3.0 * x2 - 2.0 * x3) * z
                + (x3 - x2) * h * w
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if at(middle) * y > 0.0 { low = middle } else { high = middle }
        }
        out.push(pair[0].time + h * low);
    }
    out
}

#[test]
fn an_arm_at_rest_stays_where_the_statics_have_it() {
    let mut arm = silicone();
    arm.cables[0].tension = 0.2;
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.0;
    let still = arm.solve().unwrap();
    let mut simulation = Simulation::new(&arm, Inputs::default(), options(1e-5)).unwrap();
    let at = simulation.step(1.0).unwrap();
    let moved = (at.tip[0] - still.tip().x).hypot(at.tip[1] - still.tip().y) / arm.length;
    assert!(moved < 1e-6, "{moved}");
    assert!((at.cables[0].stroke - still.cables[0].stroke).abs() < 1e-6 * arm.length);
    assert!(at.kinetic_energy < 1e-18, "{at:?}");
}

#[test]
fn a_small_free_swing_has_the_period_of_the_first_mode() {
    let arm = rod();
    let [_, _, ei] = arm.stiffness_at(0.0);
    let inputs = inputs(&[("tip.force[1]", Course::step(3e-3 * ei, 0.0, 0.0))]);
    let rows = motion(&arm, inputs, MotionOptions { elements: Some(4), ..options(1e-6) }, 20.0 * PERIOD, 0.02);
    // The phase of the first mode in the tip's motion, over five periods under a window.
    let phase = |from: usize, omega: f64| -> f64 {
        let count = 1062;
        let window = |i: usize| 0.5 - 0.5 * (2.0 * PI * i as f64 / count as f64).cos();
        let [mut re, mut im] = [0.0, 0.0];
        for i in 0..count {
            let at = &rows[from + i];
            re += window(i) * at.tip[1] * (omega * at.time).cos();
            im += window(i) * at.tip[1] * (omega * at.time).sin();
        }
        im.atan2(re)
    };
    let omega = 2.0 * PI / PERIOD;
    // The phase against the mode's frequency drifts with what the frequency is off.
    let drift = phase(3188, omega) - phase(0, omega);
    let off = drift / (3188.0 * 0.02) / omega;
    assert!(off.abs() < 2e-5, "the frequency is off by {off:.1e}");
}

#[test]
fn modes_of_a_slender_rod_are_those_of_the_beam() {
    let mut arm = rod();
    let omega = 2.0 * PI / PERIOD;
    let modes = arm.modes(4, 8).unwrap();
    for (b, mode) in B.iter().zip(&modes.modes) {
        let want = omega * (b / B[0]).powi(2);
        assert!((mode.rate[1] / want - 1.0).abs() < 4e-5 && mode.rate[0] == 0.0, "{mode:?} {want}");
    }
    // Water moves along across the arm: rho to rho + C_a rho_w.
    for (density, added) in [(1000.0, 1.0), (500.0, 1.0), (1000.0, 0.5)] {
        arm.flow.density = density;
        arm.dynamics.added_mass = added;
        let wet = arm.modes(4, 8).unwrap();
        let fall = (1000.0 / (1000.0 + added * density)).sqrt();
        for (wet, dry) in wet.modes.iter().zip(&modes.modes).take(3) {
            assert!((wet.rate[1] / dry.rate[1] / fall - 1.0).abs() < 1e-5, "{wet:?} {dry:?}");
        }
    }
}

/// Timoshenko's frequencies of a thick clamped-free rod, by the determinant of its four solutions.
fn timoshenko(ga: f64, ei: f64, [mass, rotary]: [f64; 2], guess: f64) -> f64 {
    // w = A e^(k x), psi = B e^(k x): GA (w'' - psi') = -m w2 w, EI psi'' + GA (w' - psi) = -j w2 psi.
    let determinant = |omega: f64| {
        let w2 = omega * omega;
        // EI GA k^4 + (EI m + GA j) w2 k^2 + m w2 (j w2 - GA) = 0.
        let (a, b, c) = (ei * ga, (ei * mass + ga * rotary) * w2, mass * w2 * (rotary * w2 - ga));
        let root = (b * b - 4.0 * a * c).sqrt();
        let (p, q) = (((-b + root) / (2.0 * a)).sqrt(), ((b + root) / (2.0 * a)).sqrt());
        let s = (ga * p * p + mass * w2) / (ga * p);
        let t = (ga * q * q - mass * w2) / (ga * q);
        // psi of cosh p x: s sinh p x; of sinh p x: s cosh p x; of cos q x: -t sin q x; of sin q x: t cos q x.
        let (ch, sh, co, si) = (p.cosh(), p.sinh(), q.cos(), q.sin());
        let ratio = s / t;
        // w1 = cosh - cos, psi1 = s sinh + t sin; w2 = sinh - ratio sin, psi2 = s cosh - s cos.
        let moment = [s * p * ch + t * q * co, s * p * sh + s * q * si];
        let shear = [p * sh + q * si - (s * sh + t * si), p * ch - ratio * q * co - (s * ch - s * co)];
        moment[0] * shear[1] - moment[1] * shear[0]
    };
    let (mut low, mut high) = (0.9 * guess, 1.0001 * guess);
    assert!(determinant(low) * determinant(high) < 0.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if determinant(middle) * determinant(low) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn modes_of_a_thick_rod_are_timoshenkos() {
    let (r, rho, young) = (0.05_f64, 1200.0, 1e6);
    let mut arm = Arm::cone(1.0, r, r, young, 0.5);
    arm.density = rho;
    arm.flow.density = 0.0;
    arm.model.volume = Volume::None;
    let [_, ga, ei] = arm.stiffness_at(0.0);
    let area = PI * r * r;
    let (mass, rotary) = (rho * area, rho * area * r * r / 4.0);
    let modes = arm.modes(8, 8).unwrap();
    for (k, b) in B.iter().take(2).enumerate() {
        let slender = b * b * (ei / mass).sqrt();
        let want = timoshenko(ga, ei, [mass, rotary], slender);
        let found = modes.modes[k].rate[1];
        assert!((found / want - 1.0).abs() < 1e-6, "{found} {want} {slender}");
    }
    // Stretch: (2k - 1) pi/2 sqrt(E/rho)/L.
    let want = 0.5 * PI * (young / rho).sqrt();
    let nearest = modes.modes.iter().map(|mode| (mode.rate[1] / want - 1.0).abs()).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{nearest}");
}

#[test]
fn becks_rod_flutters_from_twenty_on() {
    let mut arm = rod();
    let [_, _, ei] = arm.stiffness_at(0.0);
    let grows = |arm: &mut Arm, load: f64| {
        arm.tip.follower = [-load * ei, 0.0];
        arm.modes(4, 6).unwrap()
    };
    assert!(grows(&mut arm, 20.049).is_stable());
    let past = grows(&mut arm, 20.053);
    assert!(past.modes.iter().any(hydrostat::Mode::is_flutter), "{past:?}");
    let rate = grows(&mut arm, 21.0).modes.iter().map(|mode| mode.rate[0]).fold(0.0, f64::max);
    // In units of sqrt(rho A L^4/EI), as published and found before: 2.125.
    let unit = 2.0 * PI / PERIOD / (B[0] * B[0]);
    assert!((rate / unit - 2.1254).abs() < 2e-3, "{}", rate / unit);
    // A little viscosity of the material (Ziegler): from 10.94 on.
    arm.dynamics.relaxation_time = 1e-4;
    assert!(grows(&mut arm, 10.93).is_stable());
    assert!(!grows(&mut arm, 10.96).is_stable());
}

#[test]
fn viscosity_damps_small_swings_by_half_the_square_of_their_frequency() {
    let mut arm = rod();
    let free = arm.modes(2, 6).unwrap();
    arm.dynamics.relaxation_time = 1e-3;
    let damped = arm.modes(2, 6).unwrap();
    for (damped, free) in damped.modes.iter().zip(&free.modes) {
        let want = -0.5 * free.rate[1].powi(2) * 1e-3;
        assert!((damped.rate[0] / want - 1.0).abs() < 1e-4, "{damped:?} {want}");
    }
}

/// A rigid heavy rod on a soft hinge.
fn pendulum(radius: f64) -> Arm {
    let (length, d) = (1.0, 1e-5);
    let area = PI * radius * radius;
    let weight = 1000.0 * area * length * 9.81;
    let mut arm = Arm::cone(length, radius, radius, 1.0, 0.5);
    arm.model.volume = Volume::None;
    arm.density = 1000.0;
    arm.flow.density = 0.0;
    arm.gravity = Some(Gravity::default());
    let stiff: Profile = (1e6 * weight / area).into();
    // EI of the hinge over its length: 3e-5 of weight times length.
    let [soft, rigid] = [3e-5 * weight * length * d / area, 1e5 * weight * length * length / area];
    let points = [[0.0, soft], [d, soft], [1.01 * d, rigid], [length, rigid]];
    let bending = Profile::joined(&points, Join::Linear).unwrap();
    arm.material = Material::Coefficients { c1: stiff.clone(), c2: stiff, c3: bending };
    arm
}

#[test]
fn a_rigid_rod_on_a_hinge_swings_as_a_physical_pendulum() {
    let radius = 0.02;
    let arm = pendulum(radius);
    // Gravity along the rod turns down: the rod is let go at 90 deg.
    let turn = Course::step(0.0, -PI / 2.0, 0.0);
    let rows = motion(&arm, inputs(&[("gravity.direction", turn)]), options(1e-5), 4.2, 0.01);
    let passed = crossings(&rows, |at| [at.tip[0], at.tip_velocity[0]]);
    let period = passed[2] - passed[0];
    let small = 2.0 * PI * (2.0 / (3.0 * 9.81_f64)).sqrt();
    let want = 1.180_340_6 * small * (1.0 + 3.0 * radius * radius / 8.0);
    assert!((period / want - 1.0).abs() < 1e-4 + 2e-4, "{period} {want}");
    // The energy of the swing comes and goes by gravity: at the bottom all of m g L/2 is kinetic.
    let most = rows.iter().map(|at| at.kinetic_energy).fold(0.0, f64::max);
    let weight = 1000.0 * PI * radius * radius * 9.81;
    assert!((most / (0.5 * weight) - 1.0).abs() < 2e-3, "{most}");
}

#[test]
fn errors_fall_with_the_fourth_power_of_smooth_steps() {
    let arm = rod();
    let [_, _, ei] = arm.stiffness_at(0.0);
    let force = Course::Sine { mean: 0.1 * ei, amplitude: 0.1 * ei, frequency: 0.25, phase: -PI / 2.0 };
    let run = |step: f64| {
        let own = MotionOptions { step: Some(step), elements: Some(2), ..options(1e-9) };
        motion(&arm, inputs(&[("tip.force[1]", force.clone())]), own, 4.0, 0.5)
    };
    let best = run(0.01);
    let [coarse, fine] = [0.1, 0.05].map(|step| distance(&run(step), &best));
    assert!(coarse / fine > 10.0, "{coarse:.2e} {fine:.2e}");
}

#[test]
fn tips_are_within_the_tolerance_and_the_estimate_says_so() {
    for (relaxation_time, elements) in [(2.7e-3, 12), (1e-3, 8), (0.3e-3, 8)] {
        let mut arm = silicone();
        arm.flow.speed = 0.1;
        arm.dynamics.relaxation_time = relaxation_time;
        let pull = Course::Table(vec![(0.0, 0.0), (0.2, 0.2), (0.4, 0.2), (0.4, 0.0)]);
        let run = |tol: f64| {
            let own = MotionOptions { elements: Some(elements), ..options(tol) };
            let mut simulation = Simulation::new(&arm, inputs(&[("cable[0].tension", pull.clone())]), own).unwrap();
            let mut rows = Vec::new();
            simulation
                .run(1.0, 0.05, |at, _| {
                    rows.push(at.clone());
                    true
                })
                .unwrap();
            (rows, simulation.error_estimate())
        };
        let (best, _) = run(1e-5);
        for tol in [1e-3, 1e-4] {
            let (rows, estimate) = run(tol);
            let error = distance(&rows, &best);
            assert!(error < tol * arm.length, "t_v {relaxation_time} s: {error:.2e}");
            let said = format!("t_v {relaxation_time} s, tol {tol}: off by {error:.2e}, said {estimate:.2e}");
            assert!(error < 2.0 * estimate && estimate < 5.0 * tol * arm.length, "{said}");
        }
    }
}

#[test]
fn a_large_free_swing_keeps_its_energy() {
    let (arm, periods) = (rod(), 20.0);
    let [_, _, ei] = arm.stiffness_at(0.0);
    let pulse: Vec<(f64, f64)> =
        (0..=200).map(|k| f64::from(k) * 0.02).map(|t| (t, 2.5 * ei * (PI * t / 4.0).sin().powi(2))).collect();
    let inputs = inputs(&[("tip.force[1]", Course::Table(pulse))]);
    let own = MotionOptions { elements: Some(4), ..options(1e-4) };
    let rows = motion(&arm, inputs, own, 4.0 + PERIOD * periods, 0.25 * PERIOD);
    let free: Vec<f64> =
        rows.iter().filter(|at| at.time > 4.0).map(|at| at.kinetic_energy + at.strain_energy).collect();
    let swing = rows.iter().map(|at| at.tip[1].abs()).fold(0.0, f64::max);
    assert!(swing > 0.4, "{swing}");
    let off = free.iter().map(|energy| (energy / free[0] - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 2e-3, "{off:.1e}");
}

#[test]
fn motion_under_constant_loads_ends_in_an_equilibrium() {
    let mut arm = silicone();
    arm.flow.speed = 0.2;
    arm.flow.direction = PI;
    // Past the limit point, near -29.6 deg, the arm snaps; the motion ends where the only equilibrium is.
    let turn = Course::ramp(-0.4363, -0.6109, 0.0, 1.0);
    let rows = motion(&arm, inputs(&[("arm.base.angle", turn)]), options(1e-4), 25.0, 1.0);
    let end = rows.last().unwrap();
    arm.base.angle = -0.6109;
    let all = arm.equilibria(1e-8).unwrap();
    let nearest = all
        .found
        .iter()
        .map(|one| {
            let tip = one.configuration.tip();
            (end.tip[0] - tip.x).hypot(end.tip[1] - tip.y)
        })
        .fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-4 * arm.length, "{nearest:.1e} {:?}", all.found.len());
}

#[test]
fn slow_loads_leave_the_arm_near_its_static_path() {
    let mut arm = silicone();
    arm.flow.speed = 0.1;
    let off = |time: f64| {
        let pull = Course::ramp(0.0, 0.2, 0.0, time);
        let rows = motion(&arm, inputs(&[("cable[0].tension", pull)]), options(1e-5), 0.5 * time, 0.5 * time);
        let mut half = arm.clone();
        half.cables[0].tension = 0.1;
        let still = half.solve().unwrap().tip();
        let end = rows.last().unwrap();
        (end.tip[0] - still.x).hypot(end.tip[1] - still.y)
    };
    let [fast, slow] = [16.0, 32.0].map(off);
    // In a stream the drag is linear in a slow motion.
    assert!((fast / slow - 2.0).abs() < 0.3, "{fast:.2e} {slow:.2e}");
}

#[test]
fn a_free_neutral_arm_follows_a_stream_that_speeds_up() {
    // Soft enough to be free: the base alone holds it.
    let mut arm = Arm::cone(1.0, 0.01, 0.01, 1e4, 0.5);
    arm.density = 1000.0;
    arm.model.volume = Volume::None;
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 1.0, ct: 0.01 };
    arm.flow.direction = PI / 2.0;
    let speed = Course::ramp(0.0, 0.1, 0.0, 1.0);
    let rows = motion(&arm, inputs(&[("flow.speed", speed)]), options(1e-4), 0.5, 0.1);
    let end = rows.last().unwrap();
    assert!((end.tip_velocity[1] - 0.05).abs() < 5e-4, "{end:?}");
    assert!((end.tip[1] - 0.0125).abs() < 2e-4, "{end:?}");
}

#[test]
fn a_commanded_stroke_is_met_and_ends_in_its_equilibrium() {
    let mut arm = silicone();
    arm.flow.speed = 0.1;
    let reel = Course::ramp(0.0, 0.011, 0.0, 0.2);
    let rows = motion(&arm, inputs(&[("cable[0].stroke", reel)]), options(1e-4), 6.0, 0.1);
    for at in &rows {
        let command = 0.011 * (at.time / 0.2).min(1.0);
        assert!((at.cables[0].stroke - command).abs() < 2e-4 * arm.length, "{at:?}");
        assert!(at.cables[0].tension >= 0.0);
    }
    arm.cables[0].stroke = Some(0.011);
    let still = arm.solve().unwrap();
    let end = rows.last().unwrap();
    let off = (end.tip[0] - still.tip().x).hypot(end.tip[1] - still.tip().y);
    assert!(off < 1e-3 * arm.length, "{off:.1e}");
    assert!((end.cables[0].tension / still.cables[0].tension - 1.0).abs() < 1e-2, "{end:?}");
}

#[test]
fn overdamped_motion_needs_something_that_resists() {
    let mut arm = silicone();
    arm.dynamics.inertia = false;
    arm.flow.speed = 0.1;
    let step = inputs(&[("cable[0].tension", Course::step(0.1, 0.0, 0.0))]);
    let rows = motion(&arm, step.clone(), options(1e-4), 4.0, 0.5);
    let still = arm.solve().unwrap().tip();
    let end = rows.last().unwrap();
    assert!((end.tip[0] - still.x).hypot(end.tip[1] - still.y) < 1e-3 * arm.length, "{end:?}");
    assert_eq!(end.kinetic_energy, 0.0);
    arm.flow.density = 0.0;
    arm.dynamics.relaxation_time = 0.0;
    let refused = Simulation::new(&arm, step, options(1e-4)).unwrap_err();
    assert!(matches!(refused, MotionError::Unsupported { ref key, .. } if key == "dynamics.inertia"), "{refused}");
}

#[test]
fn a_pull_that_folds_the_tip_ends_the_motion_with_time_and_place() {
    let arm = silicone();
    let pull = inputs(&[("cable[0].tension", Course::ramp(0.0, 3.0, 0.0, 1.0))]);
    let mut simulation = Simulation::new(&arm, pull, options(1e-3)).unwrap();
    let mut known = 0.0;
    let ended = simulation
        .run(1.0, 0.01, |at, _| {
            known = at.time;
            true
        })
        .unwrap_err();
    let MotionError::Ended(verdict) = ended else { panic!("{ended}") };
    assert_eq!(verdict.kind, MotionVerdictKind::CableFold);
    // The statics fold at 0.95 N.
    assert!((0.25..0.5).contains(&verdict.time) && known <= verdict.time, "{verdict:?}");
    assert!(verdict.s.is_some_and(|s| s > 0.2), "{verdict:?}");
}

/// It ended in `no_section_solution`, which is no limit of the arm: neither a relaxation time of 10 us nor sections
/// that do not swell end there, nor does the same arm on fewer elements.
#[test]
fn short_waves_that_grow_without_relaxation_time_were_called_a_limit_of_the_arm() {
    let mut arm = silicone();
    arm.dynamics.relaxation_time = 0.0;
    let end = |arm: &Arm, elements: Option<usize>| {
        let let_go = inputs(&[("cable[0].tension", Course::ramp(0.2, 0.0, 0.0, 0.05))]);
        let options = MotionOptions { elements, ..options(1e-8) };
        Simulation::new(arm, let_go, options).unwrap().advance_to(1e-3)
    };
    let Err(MotionError::Ended(verdict)) = end(&arm, None) else { panic!("short waves grow") };
    assert_eq!(verdict.kind, MotionVerdictKind::ShortWaves);
    assert!(verdict.message().contains("set `dynamics.relaxation_time`"), "{}", verdict.message());
    end(&arm, Some(8)).unwrap();
    let damped = Arm { dynamics: Dynamics { relaxation_time: 1e-5, ..arm.dynamics }, ..arm.clone() };
    end(&damped, None).unwrap();
    arm.model.volume = Volume::None;
    end(&arm, None).unwrap();
}

/// A tension that was led paid the cable out, and a stroke that was led did nothing.
#[test]
fn a_cable_is_not_led_by_its_tension_and_by_its_stroke_in_one_run() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.005);
    let mut simulation = Simulation::new(&arm, Inputs::default(), options(1e-3)).unwrap();
    for (key, other) in [("cable[0].tension", "cable[0].stroke"), ("cable[1].stroke", "cable[1].tension")] {
        let error = simulation.step_to(0.01, &[(key, 0.01)]).unwrap_err().to_string();
        assert!(error.starts_with(&format!("`{key}`: the cable is led by `{other}` in this run")), "{error}");
    }
    simulation.step_to(0.01, &[("cable[0].stroke", 0.0051), ("cable[1].tension", 0.01)]).unwrap();
}

#[test]
fn friction_and_jumps_of_the_base_are_refused_with_their_keys() {
    let mut arm = silicone();
    arm.cables[0].friction = 0.2;
    let refused = Simulation::new(&arm, Inputs::default(), options(1e-4)).unwrap_err();
    assert!(refused.to_string().starts_with("`cable[0].friction`"), "{refused}");
    let mut inputs = Inputs::default();
    let refused = inputs.set("arm.base.angle", Course::step(0.0, 0.1, 0.5)).unwrap_err();
    assert!(refused.to_string().contains("cannot jump"), "{refused}");
    let refused = inputs.set("arm.radius.base", Course::constant(0.1)).unwrap_err();
    assert!(refused.to_string().contains("cable[0].tension"), "{refused}");
}

/// Modes at held lengths were those at the tensions that the cables take.
#[test]
fn modes_at_held_lengths_were_those_at_given_tensions() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(hydrostat::Cable::new("left", hydrostat::Profile::linear(0.005, 0.001)).reeled_in(0.005));
    let refused = arm.modes(4, 8).unwrap_err();
    assert!(refused.to_string().contains("cable[0].stroke"), "{refused}");
}
