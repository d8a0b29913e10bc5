//! Stability against static divergence: buckling loads, what lies beyond them, and what cannot buckle.

use std::f64::consts::{FRAC_PI_2, PI};

use hydrostat::cases::{
    HEAVY_COLUMN, column, column_buckling_load, distributed_loads, end_loads, heavy_column, uniform_arm,
};
use hydrostat::{Arm, Cable, Configuration, Gravity, Growth, Profile, Stability, Support, Volume};

fn solve(arm: &Arm) -> Configuration {
    arm.solve().unwrap_or_else(|e| panic!("{}: {e}", arm.name))
}

fn growth(arm: &Arm) -> Growth {
    solve(arm).growth().unwrap_or_else(|| panic!("{}: not established", arm.name))
}

/// EA and GA of slender to stocky columns, soft in shear, soft in tension.
const COLUMNS: [(f64, f64); 6] = [(1e6, 3e5), (2500.0, 800.0), (400.0, 130.0), (100.0, 33.0), (1e4, 3.0), (30.0, 1e6)];

/// The slowest decay turns into growth at the load P (1 + P (1/GA - 1/EA)) = pi^2 EI/(4 L^2).
#[test]
fn the_buckling_load_of_columns_to_a_millionth() {
    for (ea, ga) in COLUMNS {
        let critical = column_buckling_load(ea, ga).unwrap();
        let at = |fraction: f64| growth(&column(ea, ga, fraction * critical, 0.0));
        for (fraction, want) in [(0.5, Stability::Stable), (0.9999, Stability::Stable), (1.0, Stability::Marginal)] {
            assert_eq!(at(fraction).stability(), want, "EA {ea}, GA {ga}: {fraction} of the load");
        }
        for fraction in [1.0001, 1.5, 2.0] {
            assert_eq!(at(fraction).stability(), Stability::Unstable(1), "EA {ea}, GA {ga}: {fraction} of the load");
        }
        let [below, exact, above] = [1.0 - 1e-6, 1.0, 1.0 + 1e-6].map(|fraction| at(fraction).rates[0][0]);
        assert!(below < -5e-7 && above > 5e-7, "EA {ea}, GA {ga}: {below:e} {above:e}");
        assert!(exact.abs() < 1e-9, "EA {ea}, GA {ga}: {exact:e}");
    }
}

/// Without shear and stretch to speak of, the n-th load is (2n - 1)^2 Euler's.
#[test]
fn each_higher_buckling_load_adds_a_direction() {
    for (fraction, count) in [(8.99, 1), (9.01, 2), (24.98, 2), (25.02, 3)] {
        let arm = column(1e7, 3e6, fraction * PI * PI / 4.0, 0.0);
        assert_eq!(growth(&arm).stability(), Stability::Unstable(count), "{fraction} of Euler's load");
    }
}

#[test]
fn a_column_under_its_own_weight() {
    let at = |fraction: f64| growth(&heavy_column(fraction * HEAVY_COLUMN, 0.0));
    let [below, above] = [1.0 - 1e-6, 1.0 + 1e-6].map(|fraction| at(fraction).rates[0][0]);
    assert!(below < -5e-7 && above > 5e-7, "{below:e} {above:e}");
    for (fraction, want) in [(0.99, Stability::Stable), (1.01, Stability::Unstable(1)), (2.0, Stability::Unstable(1))] {
        assert_eq!(at(fraction).stability(), want, "{fraction} of the weight");
    }
    let beyond = solve(&heavy_column(1.5 * HEAVY_COLUMN, 0.0));
    assert!((beyond.tip().y - 1.0).abs() < 1e-9, "it stays upright");
}

/// The branch that leaves a buckling load to the side is stable.
#[test]
fn a_bent_column_past_its_load_is_stable() {
    for fraction in [1.01, 1.5, 3.0] {
        let arm = column(1e6, 3e5, fraction * PI * PI / 4.0, 1e-3);
        assert_eq!(growth(&arm).stability(), Stability::Stable, "{fraction} of the load");
    }
}

/// A thrust that turns with the tip has no static buckling load. In this metric the two slowest motions
/// join to a pair that swings from 6.96 N and grows from 22.08 N on (Beck's load, with inertia, is 20.05 N).
#[test]
fn a_tangential_follower_has_no_static_buckling_load() {
    let at = |load: f64| {
        let mut arm = uniform_arm("follower", 1e6, 3e5);
        arm.tip.follower = [-load, 0.0];
        growth(&arm)
    };
    for load in [1.0, 2.0, 3.0, 8.0, 20.0, 21.0] {
        let found = at(load);
        assert_eq!(found.stability(), Stability::Stable, "{load} N: {:?}", found.rates);
    }
    for load in [25.0, 40.0, 60.0] {
        let found = at(load);
        assert_eq!(found.stability(), Stability::Unstable(2), "{load} N: {:?}", found.rates);
        let [a, b] = [found.rates[0], found.rates[1]];
        assert!(a[1] != 0.0 && a[0] == b[0] && a[1] == -b[1], "{load} N: one pair, {a:?} {b:?}");
    }
}

fn cone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

/// All rates are over the slowest one of this arm.
#[test]
fn an_unloaded_arm_is_stable() {
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        for curvature in [0.0, 8.0] {
            let mut arm = cone();
            arm.model.volume = volume;
            arm.reference.mu = curvature.into();
            let found = growth(&arm);
            assert_eq!(found.stability(), Stability::Stable);
            assert!((found.rates[0][0] + 1.0).abs() < 1e-6 && found.rates[0][1] == 0.0, "{:?}", found.rates);
        }
    }
}

#[test]
fn a_hanging_arm_is_stable_and_stiffer_than_a_standing_one() {
    let [hanging, standing] = [-FRAC_PI_2, FRAC_PI_2].map(|angle| {
        let mut arm = cone();
        arm.base.angle = angle;
        arm.density = 1300.0;
        arm.gravity = Some(Gravity::default());
        growth(&arm)
    });
    assert_eq!(hanging.stability(), Stability::Stable);
    assert!(hanging.rates[0][0] < -1.0 && standing.rates[0][0] > -1.0, "{hanging:?} {standing:?}");
}

#[test]
fn pulled_arms_in_a_stream_are_stable() {
    for (tension, speed) in [(0.2, 0.0), (0.0, 0.5), (0.3, 0.5)] {
        let mut arm = cone();
        arm.cables[0].tension = tension;
        arm.flow.speed = speed;
        assert_eq!(growth(&arm).stability(), Stability::Stable, "{tension} N, {speed} m/s");
    }
}

/// Dead loads on a classical rod have a potential: the tangent is symmetric.
#[test]
fn rates_under_conservative_loads_are_real() {
    for case in end_loads().iter().chain(&distributed_loads()) {
        let found = growth(&case.arm);
        assert_eq!(found.stability(), Stability::Stable, "{}", case.name);
        assert!(found.rates.iter().all(|rate| rate[1] == 0.0), "{}: {:?}", case.name, found.rates);
    }
}

/// A straight column and a bent one are as stable in whatever direction they point.
#[test]
fn rates_do_not_depend_on_the_direction_of_the_arm() {
    let found: Vec<Growth> = [0.0_f64, 0.7, 2.5]
        .into_iter()
        .map(|angle| {
            let mut arm = uniform_arm("turned", 400.0, 130.0);
            arm.base.angle = angle;
            let (sin, cos) = angle.sin_cos();
            arm.tip.force = [-2.0 * cos - 0.3 * sin, -2.0 * sin + 0.3 * cos];
            growth(&arm)
        })
        .collect();
    for turned in &found[1..] {
        for (a, b) in turned.rates.iter().zip(&found[0].rates).take(3) {
            assert!((a[0] - b[0]).abs() < 1e-6 * b[0].abs(), "{a:?} {b:?}");
        }
    }
}

/// What the solve knows of the determinant's sign agrees with the count.
#[test]
fn the_count_agrees_with_what_the_path_knows() {
    for fraction in [0.5, 2.0, 8.0, 12.0] {
        let solved = solve(&column(1e6, 3e5, fraction * PI * PI / 4.0, 0.0));
        let stable = solved.stability().and_then(Stability::is_stable);
        assert_eq!(solved.stable == Some(false), stable == Some(false), "{fraction} of Euler's load");
    }
}

/// An arm that does not meet its tip's balance is at no equilibrium that could be stable.
#[test]
fn the_unstrained_base_has_no_stability() {
    let mut arm = cone();
    arm.model.support = Support::UnstrainedBase;
    arm.flow.speed = 0.05;
    assert_eq!(solve(&arm).stability(), None);
}
