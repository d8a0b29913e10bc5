//! Paths of arms in space, against closed forms, single solves and the paths of the plane.

use std::f64::consts::PI;

use hydrostat::{
    Arm, Branch, Event, Options, Parameter, Path, PathEnd, PathOptions, Space, SpatialConfiguration, SpatialSolver,
    Stability, Volume,
};

#[path = "common/space.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod common;

use common::{apart, in_space, silicone, three_cables, tip};

fn followed(arm: &Arm, parameter: Parameter, range: [f64; 2]) -> Path<SpatialConfiguration> {
    arm.path_in_space(parameter, range, &PathOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn values<C>(branch: &Branch<C>, event: Event) -> Vec<f64> {
    branch.points.iter().filter(|p| p.event == Some(event)).map(|p| p.value).collect()
}

/// A uniform column with `none` and the load at which it buckles.
fn column() -> (Arm, f64) {
    let mut arm = Arm::cone(0.2, 0.005, 0.005, 1e5, 0.25);
    arm.model.volume = Volume::None;
    let area = PI * 0.005_f64.powi(2);
    let [axial, shear] = [1e5 * area, 1e5 / 2.5 * area];
    let euler = PI.powi(2) * 1e5 * PI / 4.0 * 0.005_f64.powi(4) / (4.0 * 0.2 * 0.2);
    // P (1 + P (1/GA - 1/EA)) = pi^2 EI / (4 L^2).
    let by = 1.0 / shear - 1.0 / axial;
    (arm, ((1.0 + 4.0 * by * euler).sqrt() - 1.0) / (2.0 * by))
}

#[test]
fn a_column_buckles_in_two_directions_at_once() {
    let (arm, load) = column();
    let path = followed(&arm, Parameter::TipForce(0), [0.0, -1.4 * load]);
    let branch = &path.branches[0];
    let found = values(branch, Event::Bifurcation);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0] / load + 1.0).abs() < 1e-6, "{} for {load}", found[0]);
    for point in branch.points.iter().filter(|point| point.event.is_none()) {
        let count = if point.value > -load { Stability::Stable } else { Stability::Unstable(2) };
        assert_eq!(point.stability, Some(count), "at {}", point.value);
    }
    assert_eq!(branch.end, PathEnd::ReachedEnd);
}

/// How far the tip is from the axis of the base, and along it, m.
fn off_axis(shape: &SpatialConfiguration) -> [f64; 2] {
    let [x, y, z] = tip(shape);
    [y.hypot(z), x]
}

/// What buckles may lie in any plane through the axis: the turn about it costs nothing, and must not be taken for a
/// limit point.
#[test]
fn branches_of_a_column_have_no_limit_points_on_their_circles() {
    let (arm, load) = column();
    let options = PathOptions { branches: true, ..PathOptions::default() };
    let range = [0.0, -1.4 * load];
    let path = arm.path_in_space(Parameter::TipForce(0), range, &options).unwrap_or_else(|error| panic!("{error}"));
    let plane = arm.path(Parameter::TipForce(0), range, &options).unwrap();
    assert_eq!(path.branches.len(), plane.branches.len());
    for branch in &path.branches[1..] {
        assert!(values(branch, Event::LimitPoint).is_empty() && values(branch, Event::Bifurcation).is_empty());
        assert_eq!(branch.end, PathEnd::ReachedEnd);
        let last = &branch.points[branch.points.len() - 1];
        let own = plane.branches[1].points.last().unwrap();
        assert_eq!(own.value, last.value);
        let there = own.configuration.tip();
        let [off, along] = off_axis(&last.configuration);
        assert!((off - there.y.abs()).abs() < 2e-6 * arm.length, "{off} for {}", there.y);
        assert!((along - there.x).abs() < 2e-6 * arm.length, "{along} for {}", there.x);
        assert!(branch.points.len() < 100, "{}", branch.points.len());
    }
}

#[test]
fn points_of_a_path_are_solves() {
    let arm = three_cables();
    for (parameter, to) in [
        (Parameter::StreamAlong(2), 0.7),
        (Parameter::GravityAlong(0), 1.0),
        (Parameter::BaseAlong(1), -0.5),
        (Parameter::SectionAlong(2), -0.6),
        (Parameter::TipForce(2), -0.001),
        (Parameter::TipFollower(2), 0.001),
        (Parameter::TipMomentAbout(0), -1e-5),
        (Parameter::Tension(2), 0.1),
        (Parameter::CableAngle(0, hydrostat::Point::Whole), 0.6),
        (Parameter::Radius(hydrostat::Point::Tip), 0.003),
    ] {
        let from = parameter.of(&arm).unwrap();
        let branch = followed(&arm, parameter, [from, to]).branches.remove(0);
        assert_eq!(branch.end, PathEnd::ReachedEnd, "{parameter}");
        for point in branch.points.iter().step_by(3) {
            let mut own = arm.clone();
            parameter.set(&mut own, point.value).unwrap();
            let solved = SpatialSolver::new(&own, Options::default()).unwrap().solve().unwrap();
            let off = apart(tip(&solved), tip(&point.configuration)) / arm.length;
            assert!(off < 2e-6, "{parameter} = {}: {off}", point.value);
        }
    }
}

#[test]
fn limit_points_are_those_of_the_plane() {
    let mut arm = silicone();
    arm.flow.speed = 0.2;
    arm.flow.direction = PI;
    let plane = arm.path(Parameter::BaseAngle, [1.5, -1.5], &PathOptions::default()).unwrap();
    let there = followed(&in_space(&arm), Parameter::BaseAngle, [1.5, -1.5]);
    let [plane, there] = [values(&plane.branches[0], Event::LimitPoint), values(&there.branches[0], Event::LimitPoint)];
    assert_eq!(plane.len(), there.len(), "{plane:?} and {there:?}");
    for (a, b) in plane.iter().zip(&there) {
        assert!((a - b).abs() < 1e-5, "{plane:?} and {there:?}");
    }
}

#[test]
fn a_base_that_turns_once_round_comes_back_to_the_same_shape() {
    let mut arm = three_cables();
    arm.space = Some(Space { base: None, ..arm.space.unwrap() });
    arm.flow.speed = 0.03;
    let branch = followed(&arm, Parameter::BaseAngle, [0.0, 2.0 * PI]).branches.remove(0);
    assert_eq!(branch.end, PathEnd::ReachedEnd);
    let [first, last] = [&branch.points[0], &branch.points[branch.points.len() - 1]];
    assert!(apart(tip(&first.configuration), tip(&last.configuration)) < 1e-6 * arm.length);
}

#[test]
fn cables_with_a_commanded_stroke_go_slack_and_taut() {
    let mut arm = three_cables();
    arm.flow.speed = 0.05;
    for cable in &mut arm.cables {
        cable.tension = 0.0;
    }
    arm.cables[0].stroke = Some(0.0);
    arm.cables[1].stroke = Some(0.002);
    let branch = followed(&arm, Parameter::Stroke(0), [0.004, -0.012]).branches.remove(0);
    assert_eq!(branch.end, PathEnd::ReachedEnd);
    assert!(branch.points.iter().any(|p| p.event == Some(Event::Slack(0))));
    for point in &branch.points {
        let shape = &point.configuration;
        for cable in shape.cables.iter().take(2) {
            let command = cable.command.as_ref().unwrap();
            let spare = cable.stroke - command.stroke;
            assert!(cable.tension > -1e-9 && spare > -1e-8, "{} at {}: {cable:?}", cable.name, point.value);
            assert!(cable.tension < 1e-9 || spare.abs() < 1e-7, "{} at {}: {cable:?}", cable.name, point.value);
        }
    }
}
