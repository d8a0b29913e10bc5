//! Columns about their buckling loads: what the branches are and what is said of their stability.

use std::f64::consts::{FRAC_PI_2, PI};

use hydrostat::cases::{HEAVY_COLUMN, column, column_buckling_load, heavy_column, inextensible_arm, uniform_arm};
use hydrostat::{Arm, Configuration, Options, Solver};

fn solve(arm: &Arm) -> Configuration {
    let mut solver = Solver::new(arm, Options::with_tol(1e-9)).unwrap();
    solver.solve().unwrap_or_else(|e| panic!("{} {:?}: {e}", arm.name, arm.tip))
}

/// EA and GA of slender to stocky columns, soft in shear, soft in tension.
const COLUMNS: [(f64, f64); 6] = [(1e6, 3e5), (2500.0, 800.0), (400.0, 130.0), (100.0, 33.0), (1e4, 3.0), (30.0, 1e6)];

fn check_straight_columns(fractions: &[f64]) {
    for (ea, ga) in COLUMNS {
        let critical = column_buckling_load(ea, ga).unwrap();
        for &fraction in fractions {
            let load = fraction * critical;
            let solved = solve(&column(ea, ga, load, 0.0));
            let off = (solved.tip().x - (1.0 - load / ea)).hypot(solved.tip().y);
            assert!(off < 1e-9, "EA {ea}, GA {ga}: {fraction} of the load: off by {off:e}");
            assert_eq!(solved.stable == Some(false), fraction > 1.0, "EA {ea}, GA {ga}: {fraction} of the load");
        }
    }
}

#[test]
fn a_straight_column_below_its_load_is_not_called_unstable() {
    check_straight_columns(&[0.5, 0.9, 0.999]);
}

#[test]
fn a_straight_column_above_its_load_is_unstable() {
    check_straight_columns(&[1.001, 1.1, 2.0]);
}

#[test]
fn a_disturbed_column_bends_the_way_it_is_pushed() {
    for (ea, ga) in COLUMNS {
        let critical = column_buckling_load(ea, ga).unwrap();
        for across in [1e-2, -1e-3] {
            let mut last = 0.0;
            for fraction in [0.5, 0.9, 0.999, 1.001, 1.1, 1.5] {
                let solved = solve(&column(ea, ga, fraction * critical, across));
                let aside = solved.tip().y * across.signum();
                assert!(
                    aside > last,
                    "EA {ea}, GA {ga}: {fraction} of the load, pushed by {across}: {aside} after {last}"
                );
                assert_ne!(solved.stable, Some(false), "EA {ea}, GA {ga}: {fraction} of the load, pushed by {across}");
                last = aside;
            }
        }
    }
}

/// Complete elliptic integrals K and E of modulus `k` by the arithmetic-geometric mean.
fn elliptic(k: f64) -> (f64, f64) {
    let (mut a, mut b, mut c, mut sum, mut power) = (1.0_f64, (1.0 - k * k).sqrt(), k, 0.5 * k * k, 0.5);
    while c.abs() > 1e-16 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        power *= 2.0;
        sum += power * c * c;
    }
    let first = PI / (2.0 * a);
    (first, first * (1.0 - sum))
}

/// The bent branch of the inextensible column: with k = sin(theta_L/2), P L^2/EI = K^2,
/// x/L = 2 E/K - 1, y/L = 2 k/K.
#[test]
fn past_its_load_a_column_follows_the_elastica() {
    for angle in [20.0_f64, 60.0, 100.0] {
        let k = (0.5 * angle.to_radians()).sin();
        let (first, second) = elliptic(k);
        let mut arm = inextensible_arm("elastica past its load");
        arm.tip.force = [-first * first, 1e-8];
        let solved = solve(&arm);
        // The push that chooses the side moves the tip by up to ten times itself near the load.
        let (x, y) = (2.0 * second / first - 1.0, 2.0 * k / first);
        let off = (solved.tip().x - x).hypot(solved.tip().y - y);
        assert!(off < 1e-6, "{angle} deg: tip {:?}, want {x} {y}", solved.tip());
        assert_ne!(solved.stable, Some(false));
    }
}

fn check_heavy_columns(fractions: &[f64]) {
    for &fraction in fractions {
        let solved = solve(&heavy_column(fraction * HEAVY_COLUMN, 0.0));
        let off = (solved.tip().y - 1.0).hypot(solved.tip().x);
        assert!(off < 1e-9, "{fraction} of the weight: off by {off:e}");
        assert_eq!(solved.stable == Some(false), fraction > 1.0, "{fraction} of the weight");
    }
}

#[test]
fn a_heavy_column_stands_up_to_its_greatest_weight() {
    check_heavy_columns(&[0.5, 0.99, 0.9999]);
}

#[test]
fn a_heavier_column_stays_upright_and_is_unstable() {
    check_heavy_columns(&[1.0001, 1.01, 2.0]);
}

#[test]
fn a_disturbed_heavy_column_sags_the_way_it_is_pushed() {
    for across in [1e-2, -1e-3] {
        let mut last = 0.0;
        for fraction in [0.5, 0.9, 0.99, 1.01, 1.1, 1.5] {
            let solved = solve(&heavy_column(fraction * HEAVY_COLUMN, across));
            let aside = solved.tip().x * across.signum();
            assert!(aside > last, "{fraction} of the weight, pushed by {across}: {aside} after {last}");
            assert_ne!(solved.stable, Some(false), "{fraction} of the weight, pushed by {across}");
            last = aside;
        }
    }
}

/// A thrust that turns with the tip has no buckling load of the static kind.
#[test]
fn a_tangential_follower_never_buckles_statically() {
    for (ea, ga) in [(1e6, 3e5), (2500.0, 800.0)] {
        for fraction in [0.9, 1.1, 3.0, 5.0, 7.0] {
            let mut arm = uniform_arm("follower", ea, ga);
            arm.tip.follower = [-fraction * PI * FRAC_PI_2 / 2.0, 0.0];
            let straight = solve(&arm);
            assert!(straight.tip().y.abs() < 1e-9);
            assert_ne!(straight.stable, Some(false), "{fraction} of the dead load");
            arm.tip.force[1] = 1e-3;
            let pushed = solve(&arm);
            assert_ne!(pushed.stable, Some(false), "{fraction} of the dead load, pushed");
        }
    }
}
