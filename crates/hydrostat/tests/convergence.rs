//! The error against the tolerance that was asked for, and against its estimate.

use hydrostat::cases;
use hydrostat::{Arm, Cable, Configuration, Gravity, Options, Profile, Solver};

/// Smooth problems of several kinds, easy and hard.
fn arms() -> Vec<Arm> {
    let mut arms = Vec::new();
    let mut cone = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    cone.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    cone.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    "cone".clone_into(&mut cone.name);
    arms.push(cone.clone());
    "cone along a stream".clone_into(&mut cone.name);
    cone.flow.speed = 0.1;
    arms.push(cone.clone());
    "heavy cone across a stream".clone_into(&mut cone.name);
    cone.flow.direction = 1.2;
    cone.density = 1200.0;
    cone.gravity = Some(Gravity::default());
    arms.push(cone);
    for mut cases in [cases::end_loads(), cases::own_weights(), cases::follower_loads(), cases::normal_drag()] {
        arms.extend(cases.pop().map(|c| c.arm));
    }
    arms
}

fn solve(arm: &Arm, tol: f64) -> Configuration {
    let mut solver = Solver::new(arm, Options { tol }).unwrap();
    solver.solve().unwrap_or_else(|e| panic!("{} at {tol:e}: {e}", arm.name))
}

/// Rounding, and the error of the answer at the tightest tolerance, over L.
const FLOOR: f64 = 5e-12;

fn check_errors(digits: std::ops::RangeInclusive<i32>) {
    for arm in arms() {
        let best = solve(&arm, 1e-12);
        for k in digits.clone() {
            let tol = 10_f64.powi(-k);
            let solved = solve(&arm, tol);
            let off = (solved.tip().x - best.tip().x).hypot(solved.tip().y - best.tip().y) / arm.length;
            let estimate = solved.error_estimate / arm.length;
            let own = best.error_estimate / arm.length;
            eprintln!("{}: tol {tol:e}, off {off:.1e}, estimate {estimate:.1e}, of the best {own:.1e}", arm.name);
            assert!(off <= tol, "{}: off by {off:e}, asked for {tol:e}", arm.name);
            assert!(estimate <= tol, "{}: estimate {estimate:e}, asked for {tol:e}", arm.name);
            // An estimate far below what was asked for may be low, but not by what matters.
            assert!(
                off <= 3.0 * estimate + 0.15 * tol + FLOOR,
                "{}: off by {off:e}, estimate {estimate:e}, tolerance {tol:e}",
                arm.name
            );
        }
    }
}

#[test]
fn the_tip_is_as_good_as_asked_for_and_the_estimate_says_so() {
    check_errors(4..=10);
}

#[test]
fn the_tip_is_as_good_as_asked_for_near_rounding() {
    check_errors(11..=11);
}

/// Six digits more take a mesh about 10^(6/8) times as fine: the order shows in the element count.
#[test]
fn elements_grow_as_the_order_says() {
    for arm in arms() {
        let [coarse, fine] = [1e-5, 1e-11].map(|tol| solve(&arm, tol).statistics.elements);
        eprintln!("{}: {coarse} and {fine} elements", arm.name);
        assert!(fine <= 9 * coarse, "{}: {coarse} elements at 1e-5, {fine} at 1e-11", arm.name);
    }
}

#[test]
fn the_dense_solution_is_as_good_as_the_nodes() {
    for arm in arms() {
        let (rough, best) = (solve(&arm, 1e-8), solve(&arm, 1e-12));
        for k in 0..=100 {
            let s = arm.length * f64::from(k) / 100.0;
            let (a, b) = (rough.at(s), best.at(s));
            let off = (a.x - b.x).hypot(a.y - b.y) / arm.length;
            assert!(off < 1e-8, "{}: off by {off:e} at {s}", arm.name);
            assert!((a.theta - b.theta).abs() < 1e-7, "{}: {} at {s}", arm.name, (a.theta - b.theta).abs());
        }
    }
}

/// Loose tolerances are answered too.
#[test]
fn a_loose_tolerance_is_enough_for_a_rough_answer() {
    for arm in arms() {
        let best = solve(&arm, 1e-10);
        for tol in [1e-2, 1e-3] {
            let solved = solve(&arm, tol);
            let off = (solved.tip().x - best.tip().x).hypot(solved.tip().y - best.tip().y) / arm.length;
            assert!(off <= tol, "{}: off by {off:e}, asked for {tol:e}", arm.name);
        }
    }
}
