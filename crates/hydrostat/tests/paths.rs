//! Paths and searches for all equilibria against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use hydrostat::cases::{HEAVY_COLUMN, column, column_buckling_load, heavy_column, inextensible_arm};
use hydrostat::{Arm, Branch, Event, Parameter, PathEnd, PathError, PathOptions, Stability};

/// sn, cn, dn of `u` by descending Landen transformations (arithmetic-geometric means).
fn jacobi(u: f64, k: f64) -> [f64; 3] {
    let (mut a, mut b, mut ratios) = (1.0, (1.0 - k * k).sqrt(), Vec::new());
    let mut c = k;
    while c.abs() > 1e-16 {
        let mean = 0.5 * (a + b);
        c = 0.5 * (a - b);
        b = (a * b).sqrt();
        a = mean;
        ratios.push(c / a);
    }
    let mut phi = u * a * 2.0_f64.powi(i32::try_from(ratios.len()).unwrap());
    for ratio in ratios.iter().rev() {
        phi = 0.5 * (phi + (ratio * phi.sin()).clamp(-1.0, 1.0).asin());
    }
    let sn = phi.sin();
    [sn, phi.cos(), (1.0 - k * k * sn * sn).sqrt()]
}

/// Angle at which the base of an elastica of L sqrt(P/EI) = `w` is held, from the line of the thrust P, when its tip
/// has turned to 2 asin(k): sin(phi/2) = k sn(K - w (1 - s/L)), so k cn(w)/dn(w) at the base (Love, A Treatise on the
/// Mathematical Theory of Elasticity, the inflexional elastica).
fn base_angle(w: f64, k: f64) -> f64 {
    let [_, cn, dn] = jacobi(w, k);
    2.0 * (k * cn / dn).asin()
}

/// An inextensible arm along e1 under a thrust against it.
fn thrust(w: f64) -> Arm {
    let mut arm = inextensible_arm("elastica");
    arm.tip.force = [-w * w, 0.0];
    arm
}

fn values(branch: &Branch, event: Event) -> Vec<f64> {
    branch.points.iter().filter(|p| p.event == Some(event)).map(|p| p.value).collect()
}

#[test]
fn the_buckled_elastica_snaps_at_the_base_angle_of_the_closed_form() {
    for w in [1.8, 2.0, 2.5] {
        // The extreme of the base angle over k, by golden section.
        let (mut low, mut high) = (0.0, 0.999);
        for _ in 0..120 {
            let third = 0.381_966_011_250_105 * (high - low);
            if base_angle(w, low + third) < base_angle(w, high - third) { high -= third } else { low += third }
        }
        let extreme = base_angle(w, 0.5 * (low + high)).abs();
        let options = PathOptions { tol: 1e-7, ..PathOptions::default() };
        let path = thrust(w).path(Parameter::BaseAngle, [-1.2, 1.2], &options).unwrap();
        assert_eq!(path.branches[0].end, PathEnd::ReachedEnd);
        let limits = values(&path.branches[0], Event::LimitPoint);
        assert_eq!(limits.len(), 2, "{limits:?}");
        // Held from -1.2, the arm has buckled to one side, and stays there until past zero.
        assert!((limits[0] - extreme).abs() < 1e-6, "w = {w}: {} and {extreme}", limits[0]);
        assert!((limits[1] + extreme).abs() < 1e-6, "w = {w}: {} and {extreme}", limits[1]);
    }
}

#[test]
fn a_column_bifurcates_at_its_buckling_loads_and_stays_straight() {
    for (ea, ga) in [(1e6, 3e5), (400.0, 130.0)] {
        let critical = column_buckling_load(ea, ga).unwrap();
        let path = column(ea, ga, 0.0, 0.0)
            .path(Parameter::TipForce(0), [0.0, -3.0 * critical], &PathOptions::default())
            .unwrap();
        let found = values(&path.branches[0], Event::Bifurcation);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0] / critical + 1.0).abs() < 1e-6, "EA {ea}, GA {ga}: {} and {critical}", found[0]);
        for point in path.branches[0].points.iter().filter(|p| p.event.is_none()) {
            assert!(point.configuration.tip().y.abs() < 1e-9);
            let unstable = point.value < -critical;
            assert_eq!(point.stability, Some(if unstable { Stability::Unstable(1) } else { Stability::Stable }));
        }
    }
}

#[test]
fn branches_are_switched_to_where_a_column_buckles() {
    let critical = column_buckling_load(1e6, 3e5).unwrap();
    let options = PathOptions { branches: true, ..PathOptions::default() };
    let path = column(1e6, 3e5, 0.0, 0.0).path(Parameter::TipForce(0), [0.0, -1.5 * critical], &options).unwrap();
    assert_eq!(path.branches.len(), 3);
    let [left, right] = [1, 2].map(|b: usize| path.branches[b].points.last().unwrap());
    // Both sides are mirror images, and what the solve of a slightly disturbed column leads to.
    let disturbed = column(1e6, 3e5, 1.5 * critical, 1e-9).solve().unwrap();
    for buckled in [left, right] {
        assert!((buckled.value / critical + 1.5).abs() < 1e-12);
        assert_eq!(buckled.stability, Some(Stability::Stable));
        assert!((buckled.configuration.tip().x - disturbed.tip().x).abs() < 1e-6);
        assert!((buckled.configuration.tip().y.abs() - disturbed.tip().y).abs() < 1e-6);
    }
    assert!(left.configuration.tip().y * right.configuration.tip().y < 0.0);
}

#[test]
fn a_heavy_column_bifurcates_at_its_buckling_length() {
    let options = PathOptions { tol: 1e-7, ..PathOptions::default() };
    let arm = heavy_column(HEAVY_COLUMN, 0.0);
    let whole = arm.gravity.unwrap().acceleration;
    let path = arm.path(Parameter::GravityAcceleration, [0.0, 1.2 * whole], &options).unwrap();
    let found = values(&path.branches[0], Event::Bifurcation);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0] / whole - 1.0).abs() < 1e-6, "{} and {whole}", found[0]);
}

#[test]
fn a_path_keeps_to_its_branch_where_another_passes_close() {
    // A column that is pushed aside by 1e-4 of its load: its branch leaves the straight one smoothly, and the
    // other half of the pitchfork, which ends in a limit point near the buckling load, comes close.
    let critical = column_buckling_load(1e6, 3e5).unwrap();
    for longest in [0.05, 0.2, 0.4] {
        let options = PathOptions { longest, ..PathOptions::default() };
        let path = column(1e6, 3e5, 0.0, 1e-4 * critical)
            .path(Parameter::TipForce(0), [0.0, -2.0 * critical], &options)
            .unwrap();
        let branch = &path.branches[0];
        assert_eq!(branch.end, PathEnd::ReachedEnd);
        let mut turned = 0.0;
        for point in &branch.points {
            assert_eq!((point.event, point.stability), (None, Some(Stability::Stable)));
            assert!(point.configuration.tip().theta >= turned, "steps of {longest}: back at {}", point.value);
            turned = point.configuration.tip().theta;
        }
        let back = column(1e6, 3e5, 2.0 * critical, 1e-4 * critical).equilibria(1e-8).unwrap();
        // From the other half of the pitchfork the path goes round its limit point.
        assert_eq!(back.found.len(), 3);
    }
}

#[test]
fn all_equilibria_of_the_elastica_are_found() {
    // One pair of shapes for every odd multiple of pi/2 that L sqrt(P/EI) exceeds, and the straight one.
    for (w, count) in [(1.5, 1), (2.0, 3), (4.6, 3), (4.8, 5), (7.7, 5), (8.0, 7)] {
        let all = thrust(w).equilibria(1e-9).unwrap();
        assert!(all.complete, "w = {w}: {:?}", all.ends);
        assert_eq!(all.found.len(), count, "w = {w}");
        for found in &all.found {
            // theta(L) = 2 asin(k) with the base at zero: cn(w; k) = 0.
            let k = (0.5 * found.configuration.tip().theta).sin().abs();
            assert!(jacobi(w, k)[1].abs() < 1e-6 || k < 1e-9, "w = {w}: k = {k}");
        }
        for (one, other) in all.found.iter().zip(all.found.iter().rev()) {
            assert!((one.configuration.tip().theta + other.configuration.tip().theta).abs() < 1e-8);
        }
        // Straight: one more unstable direction at every buckling load. Bent: the first pair is stable.
        let middle = all.found[count / 2].stability;
        let expected = if count == 1 { Stability::Stable } else { Stability::Unstable(count / 2) };
        assert_eq!(middle, Some(expected), "w = {w}");
        if count > 1 {
            assert_eq!(all.found.iter().filter(|e| e.stability == Some(Stability::Stable)).count(), 2, "w = {w}");
        }
    }
}

#[test]
fn equilibria_past_a_limit_point_are_found_although_the_path_leads_to_none() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(hydrostat::Cable::new("left", hydrostat::Profile::linear(0.005, 0.001)).pulled(0.3));
    arm.flow.speed = 0.5;
    arm.flow.direction = PI;
    assert!(arm.solve().is_err());
    let all = arm.equilibria(1e-8).unwrap();
    assert!(all.complete);
    assert_eq!(all.found.len(), 9);
    // Towards the arm's two ways to lie down the stream.
    assert_eq!(all.found.iter().filter(|e| e.stability == Some(Stability::Stable)).count(), 2);
    for found in &all.found {
        assert_eq!(found.configuration.arm.base.angle, 0.0);
        let whole_turns = (found.configuration.stations.theta[0] / PI).abs();
        assert!(whole_turns < 1e-12);
    }
}

#[test]
fn a_hanging_arm_in_an_updraught_has_five_equilibria() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1100.0;
    arm.base.angle = -FRAC_PI_2;
    arm.gravity = Some(hydrostat::Gravity::default());
    arm.flow.speed = 0.3;
    arm.flow.direction = FRAC_PI_2;
    let all = arm.equilibria(1e-8).unwrap();
    assert!(all.complete);
    let stable: Vec<bool> = all.found.iter().map(|e| e.stability == Some(Stability::Stable)).collect();
    assert_eq!(stable, [true, false, true, false, true]);
}

#[test]
fn a_request_that_cannot_be_is_refused_with_its_numbers() {
    let arm = thrust(1.0);
    let path = |parameter, range| arm.path(parameter, range, &PathOptions::default());
    let refused = path(Parameter::Tension(0), [0.0, 1.0]).unwrap_err();
    assert!(refused.to_string().contains("0 cables"), "{refused}");
    let refused = path(Parameter::FlowSpeed, [0.0, -1.0]).unwrap_err();
    assert!(matches!(refused, PathError::Value { value: -1.0, .. }), "{refused}");
    assert!(matches!(path(Parameter::FlowSpeed, [0.5, 0.5]), Err(PathError::Option { .. })));
    assert!(matches!(
        path(Parameter::FlowSpeed, [0.0, f64::NAN]),
        Err(PathError::Value { .. } | PathError::Option { .. })
    ));
    assert!(matches!(arm.equilibria(0.0), Err(PathError::Option { .. })));
}

#[test]
fn a_path_that_starts_where_there_is_no_equilibrium_says_so() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(hydrostat::Cable::new("left", hydrostat::Profile::linear(0.005, 0.001)));
    let refused = arm.path(Parameter::Tension(0), [5.0, 0.0], &PathOptions::default()).unwrap_err();
    assert!(matches!(refused, PathError::Start { value: 5.0, .. }), "{refused}");
    // From the other end the points up to the limit are kept.
    let path = arm.path(Parameter::Tension(0), [0.0, 5.0], &PathOptions::default()).unwrap();
    let branch = &path.branches[0];
    assert!(matches!(branch.end, PathEnd::Limit { kind: hydrostat::VerdictKind::CableFold, .. }), "{:?}", branch.end);
    assert!(branch.points.len() > 5);
    assert!(branch.points.last().unwrap().value > 0.9);
}

#[test]
fn a_path_over_the_geometry_is_that_of_solves() {
    use hydrostat::{Cable, Point, Profile};

    let mut arm = Arm::cone(0.245, 0.010, 0.003, 110e3, 0.5);
    let offset = Profile::table(&[[0.0, 0.005], [0.1, 0.004], [0.245, 0.001]]).unwrap();
    arm.cables.push(Cable::new("left", offset).pulled(0.15));
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.0;
    for (parameter, range) in
        [(Parameter::Radius(Point::Tip), [0.003, 0.006]), (Parameter::Offset(0, Point::Knot(1)), [0.004, 0.0025])]
    {
        let path = arm.path(parameter, range, &PathOptions::default()).unwrap();
        let branch = &path.branches[0];
        assert_eq!(branch.end, PathEnd::ReachedEnd);
        for point in &branch.points {
            let mut own = arm.clone();
            parameter.set(&mut own, point.value).unwrap();
            let (tip, found) = (own.solve().unwrap().tip(), point.configuration.tip());
            assert!((tip.x - found.x).hypot(tip.y - found.y) < 3e-6 * arm.length, "{parameter} at {}", point.value);
        }
    }
}
