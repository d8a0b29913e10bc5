//! The equilibria of arms in space that curves over the rotation of the base lead to.

use hydrostat::{Arm, Cable, PathEnd, PathError, Profile, SpatialEquilibria, Stability};

#[path = "common/space.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod common;

use common::{apart, in_space, rotation, silicone, tip, turned, turned_arm};

/// An arm that the stream meets from ahead and a little from the side.
fn leaning(degrees: f64) -> Arm {
    let mut arm = silicone();
    for cable in &mut arm.cables {
        cable.tension = 0.0;
    }
    arm.flow.speed = 0.2;
    arm.flow.direction = degrees.to_radians();
    arm
}

fn all(arm: &Arm) -> SpatialEquilibria {
    let all = arm.equilibria_in_space(1e-8).unwrap_or_else(|error| panic!("{error}"));
    for one in &all.found {
        println!("{:?} {:?}", tip(&one.configuration), one.stability);
    }
    println!("{} curves, {} points, signs sum to {:?}", all.curves.len(), all.steps, all.sum_of_signs);
    all
}

#[test]
fn those_of_the_plane_are_among_them() {
    let arm = leaning(175.0);
    let planar = arm.equilibria(1e-8).unwrap();
    assert!(planar.complete && planar.found.len() >= 3);
    let space = all(&in_space(&arm));
    for one in &planar.found {
        let own = one.configuration.tip();
        let near = space.found.iter().map(|other| apart([own.x, own.y, 0.0], tip(&other.configuration)));
        let off = near.fold(f64::INFINITY, f64::min);
        assert!(off < 1e-7 * arm.length, "{off}");
    }
    assert!(!space.misses_some());
    // Those out of the plane come in pairs that mirror each other.
    for one in &space.found {
        let [x, y, z] = tip(&one.configuration);
        let mirrored = space.found.iter().map(|other| apart([x, y, -z], tip(&other.configuration)));
        assert!(mirrored.fold(f64::INFINITY, f64::min) < 1e-6 * arm.length, "{x} {y} {z}");
    }
}

#[test]
fn they_do_not_depend_on_the_frame() {
    let arm = leaning(172.0);
    let plain = all(&in_space(&arm));
    let frame = rotation(0.3, -0.8, 0.5);
    let other = all(&turned_arm(&arm, &frame));
    assert_eq!(plain.found.len(), other.found.len());
    for one in &plain.found {
        let own = turned(&frame, tip(&one.configuration));
        let near = other.found.iter().map(|other| apart(own, tip(&other.configuration)));
        assert!(near.fold(f64::INFINITY, f64::min) < 1e-7 * arm.length);
    }
}

#[test]
fn an_arm_that_bends_little_has_one() {
    let mut arm = common::three_cables();
    arm.flow.speed = 0.05;
    let all = all(&arm);
    assert_eq!(all.found.len(), 1);
    assert_eq!(all.found[0].stability, Some(Stability::Stable));
    assert_eq!(all.sum_of_signs, Some(1));
}

/// A column above its critical load: the straight shape, and one shape for the circle of those that are buckled.
#[test]
fn a_circle_of_shapes_is_one() {
    let mut arm = Arm::cone(0.2, 0.005, 0.005, 1e5, 0.25);
    arm.tip.force[0] = -0.0045;
    let plane = arm.equilibria(1e-8).unwrap();
    let space = all(&in_space(&arm));
    assert!(space.circles && !all_circles(&leaning(175.0)));
    assert_eq!((plane.found.len(), space.found.len()), (3, 2));
    for one in &plane.found {
        let own = one.configuration.tip();
        let off = |[x, y, z]: [f64; 3]| (own.x - x).hypot(own.y.abs() - y.hypot(z));
        let near = space.found.iter().map(|other| off(tip(&other.configuration))).fold(f64::INFINITY, f64::min);
        assert!(near < 1e-7 * arm.length, "{near}");
    }
    let states: Vec<_> = space.found.iter().map(|one| one.stability).collect();
    assert!(
        states.contains(&Some(Stability::Unstable(2))) && states.contains(&Some(Stability::Marginal)),
        "{states:?}"
    );
}

fn all_circles(arm: &Arm) -> bool {
    in_space(arm).equilibria_in_space_while(1e-8, |_| false).unwrap().circles
}

#[test]
fn a_search_ends_where_it_is_told_to() {
    let arm = in_space(&leaning(175.0));
    let part = arm.equilibria_in_space_while(1e-8, |points| points < 10).unwrap();
    assert_eq!(part.steps, 10);
    assert_eq!(part.curves.last(), Some(&Some(PathEnd::Stopped)));
}

#[test]
fn strokes_are_refused_by_the_name_of_their_cable() {
    let mut arm = in_space(&leaning(175.0));
    arm.cables.push(Cable::new("held", Profile::linear(0.001, 0.001)));
    arm.cables.last_mut().unwrap().stroke = Some(0.001);
    assert!(matches!(arm.equilibria_in_space(1e-8), Err(PathError::Stroke { cable }) if cable == "held"));
}
