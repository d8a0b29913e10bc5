//! Tensions for places in space: targets that solves made are found again, and what is out of reach says so.

use std::f64::consts::TAU;

use hydrostat::{
    Arm, Bound, Cable, Options, Profile, ReachError, ReachOptions, SpatialConfiguration, SpatialSolver, SpatialTarget,
};
use proptest::prelude::*;

#[path = "common/space.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod common;

use common::{apart, three_cables, tip};

fn solved(arm: &Arm, tensions: &[f64]) -> SpatialConfiguration {
    let mut arm = arm.clone();
    for (cable, tension) in arm.cables.iter_mut().zip(tensions) {
        (cable.tension, cable.stroke) = (*tension, None);
    }
    SpatialSolver::new(&arm, Options::with_tol(1e-9)).unwrap().solve().unwrap()
}

/// The first that is found.
fn first() -> ReachOptions {
    ReachOptions { all: false, max_tension: Some(0.4), ..ReachOptions::default() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Of three cables there are as many tensions as conditions of a place.
    #[test]
    fn random_places_are_found_again(tensions in prop::array::uniform3(0.0..0.25_f64), speed in 0.0..0.08_f64) {
        let mut arm = three_cables();
        arm.flow.speed = speed;
        let shape = solved(&arm, &tensions);
        let found = arm.reach_in_space(&[SpatialTarget::tip(tip(&shape))], &first()).unwrap();
        prop_assert!(!found.solutions.is_empty(), "{tensions:?}: {:?}", found.closest.map(|c| c.distance));
        let reached = solved(&arm, &found.solutions[0].tensions);
        prop_assert!(apart(tip(&reached), tip(&shape)) < 1e-6 * arm.length);
    }
}

/// Four cables and a place: one free direction, in which the effort is least.
#[test]
fn more_cables_than_conditions_take_the_least_effort() {
    let mut arm = three_cables();
    arm.cables.clear();
    for k in 0..4 {
        let cable = Cable::new(format!("{k}"), Profile::linear(0.005, 0.001));
        arm.cables.push(cable.at_angle(f64::from(k) * TAU / 4.0 + 0.2));
    }
    let tensions = [0.12, 0.1, 0.05, 0.08];
    let target = SpatialTarget::tip(tip(&solved(&arm, &tensions)));
    let found = arm.reach_in_space(&[target], &first()).unwrap();
    let best = &found.solutions[0];
    assert!(best.effort < tensions.iter().map(|t| t * t).sum::<f64>());
    assert!(best.distance < 1e-8 && best.on_the_path);
    // Along the direction that keeps the place the effort does not fall.
    for step in [-1e-3_f64, 1e-3] {
        let mut bounded = first();
        bounded.max_tension = None;
        let mut own = arm.clone();
        for (cable, tension) in own.cables.iter_mut().zip(&best.tensions) {
            cable.max_tension = Some(tension + step.max(0.0) + 0.5);
        }
        own.cables[0].max_tension = Some((best.tensions[0] + step).max(1e-4));
        let other = own.reach_in_space(&[target], &bounded).unwrap();
        if let Some(other) = other.solutions.first() {
            assert!(other.effort > best.effort - 1e-9, "{} {}", other.effort, best.effort);
        }
    }
}

#[test]
fn a_direction_at_the_tip_is_met_or_as_near_as_it_gets() {
    let mut arm = three_cables();
    arm.cables.clear();
    for k in 0..6 {
        let cable = Cable::new(format!("{k}"), Profile::linear(0.005, 0.001)).at_angle(f64::from(k) * TAU / 6.0);
        arm.cables.push(if k % 2 == 0 { cable } else { Cable { end: 0.13, ..cable } });
    }
    let tensions = [0.1, 0.05, 0.02, 0.08, 0.06, 0.01];
    let shape = solved(&arm, &tensions);
    let target = SpatialTarget { direction: Some(shape.tip().a.map(|v| 3.0 * v)), ..SpatialTarget::tip(tip(&shape)) };
    let found = arm.reach_in_space(&[target], &first()).unwrap();
    let best = &found.solutions[0];
    let a = best.configuration.tip().a;
    assert!(apart(a, shape.tip().a) < 1e-7, "{a:?} {:?}", shape.tip().a);
    assert!(apart(tip(&best.configuration), tip(&shape)) < 1e-8);
}

#[test]
fn a_place_along_the_arm_is_reached() {
    let arm = three_cables();
    let shape = solved(&arm, &[0.15, 0.02, 0.08]);
    let there = shape.at(0.15);
    let target = SpatialTarget { s: Some(0.15), ..SpatialTarget::tip([there.x, there.y, there.z]) };
    let found = arm.reach_in_space(&[target], &first()).unwrap();
    let place = found.solutions[0].places[0];
    assert!(apart([place.x, place.y, place.z], [there.x, there.y, there.z]) < 1e-7);
}

#[test]
fn out_of_reach_is_the_nearest_place_with_its_bounds() {
    let arm = three_cables();
    let found = arm.reach_in_space(&[SpatialTarget::tip([0.4, 0.0, 0.0])], &first()).unwrap();
    assert!(found.solutions.is_empty());
    let closest = found.closest.unwrap();
    assert!(closest.distance > 0.1);
    assert!(
        closest.bounds.iter().any(|bound| matches!(bound, Bound::Slack(_) | Bound::Most(_))),
        "{:?}",
        closest.bounds
    );
    // No small change of the tensions leads nearer.
    let far = |tensions: &[f64]| apart(tip(&solved(&arm, tensions)), [0.4, 0.0, 0.0]);
    let least = far(&closest.tensions);
    for c in 0..3 {
        for step in [-2e-3, 2e-3] {
            let mut tensions = closest.tensions.clone();
            tensions[c] = (tensions[c] + step).clamp(0.0, 0.4);
            assert!(far(&tensions) > least - 1e-7, "{c} {step}");
        }
    }
}

#[test]
fn what_is_no_target_is_refused() {
    let arm = three_cables();
    let none = SpatialTarget { direction: Some([0.0; 3]), ..SpatialTarget::tip([0.2, 0.0, 0.0]) };
    for targets in [vec![], vec![none], vec![SpatialTarget::tip([f64::NAN, 0.0, 0.0])]] {
        assert!(matches!(arm.reach_in_space(&targets, &first()), Err(ReachError::Target)));
    }
}
