//! Closed forms and published tables, to the digits that they have.

use hydrostat::cases::{self, Case, Measure, uniform_arm};
use hydrostat::{Arm, Configuration, Options, Solver, Volume};

fn solve(arm: &Arm) -> Configuration {
    let mut solver = Solver::new(arm, Options::with_tol(1e-11)).unwrap();
    solver.solve().unwrap_or_else(|e| panic!("{}: {e}", arm.name))
}

/// What an answer at that tolerance may add to the error of the known value, over its size.
const OWN: f64 = 1e-11;

fn check(cases: &[Case]) {
    for case in cases {
        let solved = solve(&case.arm);
        for quantity in &case.exact {
            let got = quantity.what.of(&solved);
            let off = (got - quantity.value).abs();
            let bound = quantity.tolerance + OWN * quantity.value.abs().max(case.arm.length);
            assert!(off <= bound, "{}: {:?} is {got}, off by {off:e} > {bound:e}", case.name, quantity.what);
        }
    }
}

const VOLUMES: [Volume; 3] = [Volume::Planar, Volume::Circular, Volume::None];

#[test]
fn one_cable_bends_a_circular_arc() {
    for volume in VOLUMES {
        check(&[1.0, 4.0, 8.0].map(|tension| cases::one_cable(volume, tension)));
    }
}

/// Not its tip alone: every place of the arc, x = nu sin(mu s)/mu and y = nu (1 - cos(mu s))/mu,
/// and the constant contact force and moment in the section.
#[test]
fn one_cable_bends_a_circular_arc_everywhere() {
    for volume in VOLUMES {
        let (tension, offset) = (6.0, 0.005);
        let case = cases::one_cable(volume, tension);
        let known = |what| case.exact.iter().find(|q| q.what == what).unwrap().value;
        let (nu, mu, beta) = (known(Measure::MiddleNu), known(Measure::MiddleMu), known(Measure::MiddleBeta));
        let solved = solve(&case.arm);
        for k in 0..=40 {
            let s = case.arm.length * f64::from(k) / 40.0;
            let station = solved.at(s);
            assert!((station.x - nu * (mu * s).sin() / mu).abs() < 1e-12);
            assert!((station.y - nu * (1.0 - (mu * s).cos()) / mu).abs() < 1e-12);
            assert!((station.theta - mu * s).abs() < 1e-11);
            assert!(station.alpha.abs() < 1e-11 && station.beta_slope.abs() < 1e-9);
            assert!((station.n_a + tension).abs() < 1e-10 && station.n_b.abs() < 1e-10);
            assert!((station.m - tension * offset * beta).abs() < 1e-11);
        }
        // The cable lies at y beta inside the arc.
        let length = (nu - offset * beta * mu) * case.arm.length;
        assert!((solved.cables[0].length - length).abs() < 1e-12);
        assert!((solved.cables[0].stroke - (case.arm.length - length)).abs() < 1e-12);
    }
}

#[test]
fn opposite_cables_leave_the_arm_straight() {
    for volume in VOLUMES {
        check(&[1.0, 4.0, 8.0].map(|tension| cases::opposite_cables(volume, tension)));
    }
}

#[test]
fn end_moment_bends_a_full_circle() {
    check(&[cases::end_moment_circle()]);
}

/// Parts and multiples of the circle, clockwise too.
#[test]
fn end_moment_bends_any_arc() {
    for moment in [-9.0_f64, -0.5, 1.0, 3.0, 12.0, 20.0] {
        let mut arm = uniform_arm("arc", 1e4, 1e4);
        arm.tip.moment = moment;
        let solved = solve(&arm);
        for k in 1..=16 {
            let s = f64::from(k) / 16.0;
            let station = solved.at(s);
            assert!((station.x - (moment * s).sin() / moment).abs() < OWN);
            assert!((station.y - (1.0 - (moment * s).cos()) / moment).abs() < OWN);
        }
    }
}

#[test]
fn dead_end_loads_meet_the_elastica_table() {
    check(&cases::end_loads());
}

#[test]
fn end_loads_with_shear_meet_the_table() {
    check(&cases::end_loads_with_shear());
}

#[test]
fn distributed_loads_meet_the_table() {
    check(&cases::distributed_loads());
}

#[test]
fn own_weight_in_a_vacuum_meets_the_same_table() {
    check(&cases::own_weights());
}

#[test]
fn follower_loads_meet_the_table() {
    check(&cases::follower_loads());
}

#[test]
fn quadratic_normal_drag_meets_the_table() {
    check(&cases::normal_drag());
}

#[test]
fn cases_have_names_of_their_own_and_known_quantities() {
    let all = cases::all();
    let names: std::collections::HashSet<&str> = all.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names.len(), all.len());
    for case in &all {
        assert!(case.arm.check().is_ok() && !case.exact.is_empty() && case.arm.name == case.name);
    }
}

/// m^2/(2EI) + n.a + (n.a)^2/(2EA) + (n.b)^2/(2GA) is constant along a uniform arm whose contact
/// force is.
#[test]
fn the_invariant_is_constant_along_the_arm() {
    for (ea, ga, force, moment, follower) in [
        (50.0, 20.0, [0.0, 3.0], 0.0, [0.0, 0.0]),
        (50.0, 20.0, [2.0, 3.0], -2.0, [0.0, 0.0]),
        (200.0, 8.0, [-1.0, 0.7], 1.0, [0.0, 0.0]),
        (30.0, 1e4, [0.0, 0.0], 0.5, [0.3, 4.0]),
        (1e4, 1e4, [0.5, -9.0], 4.0, [0.0, 0.0]),
    ] {
        let mut arm = uniform_arm("invariant", ea, ga);
        arm.tip.force = force;
        arm.tip.moment = moment;
        arm.tip.follower = follower;
        let solved = solve(&arm);
        let invariant = |s: f64| {
            let st = solved.at(s);
            0.5 * st.m * st.m + st.n_a + 0.5 * st.n_a * st.n_a / ea + 0.5 * st.n_b * st.n_b / ga
        };
        let at_tip = invariant(1.0);
        for k in 0..97 {
            let s = f64::from(k) / 97.0;
            let off = (invariant(s) - at_tip).abs() / at_tip.abs().max(1.0);
            assert!(off < 1e-10, "EA {ea}, GA {ga}, s {s}: off by {off:e} of {at_tip}");
        }
    }
}
