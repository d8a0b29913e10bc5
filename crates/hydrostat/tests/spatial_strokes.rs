//! Commanded strokes of arms in space: against the plane, and against the tensions that they take.

use hydrostat::{Arm, Cable, Options, Profile, Space, SpatialError, SpatialSolver, VerdictKind};
use proptest::prelude::*;

#[path = "common/space.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod common;

use common::{apart, rotation, solved, three_cables, tip, turned, turned_arm};

/// Silicone arms with two cables reeled in or paid out, in the plane.
fn planar_arm() -> impl Strategy<Value = Arm> {
    let stroke = -0.004..0.014_f64;
    (stroke.clone(), stroke, 0.0..0.3_f64, 0.0..3.1_f64, prop::option::of(5.0..500.0_f64), 0.3..1.0_f64).prop_map(
        |(left, right, speed, direction, stiffness, end)| {
            let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
            arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).reeled_in(left));
            arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).reeled_in(right));
            arm.cables[0].stiffness = stiffness;
            arm.cables[1].end = end;
            (arm.flow.speed, arm.flow.direction) = (speed, direction);
            arm
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Strokes in a plane that is turned take the tensions, and give the shapes, of the plane.
    #[test]
    fn strokes_in_any_plane_are_those_of_the_plane(arm in planar_arm(), a in -3.0..3.0_f64, b in -1.5..1.5_f64, c in -3.0..3.0_f64) {
        let Ok(flat) = arm.solve() else { return Ok(()) };
        let m = rotation(a, b, c);
        let space = SpatialSolver::new(&turned_arm(&arm, &m), Options::default()).unwrap().solve();
        let space = match space {
            Ok(space) => space,
            Err(error) => return Err(TestCaseError::fail(format!("{error}"))),
        };
        let there = turned(&m, [flat.tip().x, flat.tip().y, 0.0]);
        // Either tip is good to 1e-8 by an estimate that may be too small by a factor.
        prop_assert!(apart(tip(&space), there) < 1e-7 * arm.length, "{:?} {there:?}", tip(&space));
        for (flat, space) in flat.cables.iter().zip(&space.cables) {
            prop_assert!((flat.tension - space.tension).abs() < 1e-6, "{flat:?} {space:?}");
            prop_assert_eq!(flat.command.map(|c| c.slack), space.command.map(|c| c.slack));
            prop_assert!((flat.stroke - space.stroke).abs() < 1e-7 * arm.length, "{flat:?} {space:?}");
        }
    }
}

/// Three cables around the arm: the strokes that tensions make, commanded, take these tensions.
#[test]
fn commanded_strokes_take_the_tensions_that_make_them() {
    for tensions in [[0.1, 0.05, 0.02], [0.3, 0.01, 0.01], [0.02, 0.2, 0.25]] {
        let mut arm = three_cables();
        for (cable, tension) in arm.cables.iter_mut().zip(tensions) {
            cable.tension = tension;
        }
        let pulled = solved(&arm, 1e-9);
        let mut commanded = arm.clone();
        for (cable, state) in commanded.cables.iter_mut().zip(&pulled.cables) {
            (cable.stroke, cable.tension) = (Some(state.stroke), 0.0);
        }
        let held = solved(&commanded, 1e-9);
        assert!(apart(tip(&held), tip(&pulled)) < 1e-8 * arm.length, "{tensions:?}");
        for (cable, tension) in held.cables.iter().zip(tensions) {
            assert!((cable.tension - tension).abs() < 1e-7, "{tensions:?}: {cable:?}");
            assert!(cable.command.is_some_and(|command| !command.slack));
        }
        let directions =
            |shape: &hydrostat::SpatialConfiguration| shape.stability().and_then(hydrostat::Stability::directions);
        assert_eq!(directions(&held), directions(&pulled));
    }
}

/// The unstretched length of an elastic cable is what is reeled in.
#[test]
fn an_elastic_cable_stretches_by_its_tension() {
    let mut arm = three_cables();
    arm.cables[0] = arm.cables[0].clone().reeled_in(0.01);
    arm.cables[0].stiffness = Some(5.0);
    let shape = solved(&arm, 1e-9);
    let cable = &shape.cables[0];
    let unloaded = cable.length + cable.stroke;
    let expected = (unloaded - 0.01) * (1.0 + cable.tension / 5.0);
    assert!((cable.length - expected).abs() < 1e-9, "{cable:?}");
    assert!(cable.tension > 0.01);
}

/// A cable that would have to push is slack, and the arm is as without it.
#[test]
fn a_cable_paid_out_is_slack() {
    let mut arm = three_cables();
    arm.cables[2] = arm.cables[2].clone().reeled_in(-0.05);
    let without = Arm { cables: arm.cables[..2].to_vec(), ..arm.clone() };
    let shape = solved(&arm, 1e-9);
    assert!(shape.cables[2].command.is_some_and(|command| command.slack));
    assert_eq!(shape.cables[2].tension, 0.0);
    assert!(apart(tip(&shape), tip(&solved(&without, 1e-9))) < 1e-9 * arm.length);
}

/// More than the sections can take ends in a verdict that names the phase of strokes.
#[test]
fn a_stroke_beyond_the_arm_is_a_verdict() {
    let mut arm = three_cables();
    arm.space = Some(Space::default());
    arm.cables[0] = arm.cables[0].clone().reeled_in(0.12);
    let Err(SpatialError::NoEquilibrium(no)) = SpatialSolver::new(&arm, Options::default()).unwrap().solve() else {
        panic!("half of the arm was reeled in")
    };
    assert_eq!(no.verdict.phase, hydrostat::Phase::Stroke);
    assert_ne!(no.verdict.kind, VerdictKind::NotFound);
    assert!(no.verdict.load_fraction > 0.1 && no.last_good.is_some(), "{:?}", no.verdict);
}

/// Small motions at held lengths in the plane are among those in space: what tensions move directly was left out.
#[test]
fn motions_at_held_lengths_are_those_of_the_plane() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).reeled_in(0.012));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).reeled_in(0.004));
    (arm.flow.speed, arm.flow.direction) = (0.1, 1.0);
    let flat = arm.solve().unwrap();
    assert!(flat.cables.iter().all(|cable| cable.tension > 0.0), "{:?}", flat.cables);
    let flat = flat.growth().unwrap();
    let space = solved(&turned_arm(&arm, &rotation(0.7, -0.4, 1.9)), 1e-8).growth().unwrap();
    // Both in units of their own: by the ratio of the two slowest.
    let wanted = flat.rates[1][0] / flat.rates[0][0];
    let pairs = space.rates.iter().flat_map(|a| space.rates.iter().map(move |b| b[0] / a[0]));
    let off = pairs.map(|ratio| (ratio / wanted - 1.0).abs()).fold(f64::INFINITY, f64::min);
    assert!(off < 1e-4, "{off:e}: {:?} not among {:?}", flat.rates, space.rates);
}
