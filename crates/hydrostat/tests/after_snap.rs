//! What comes after a snap, against the list of equilibria and the motion itself; loads up and down.

use hydrostat::{
    AfterSnapError, Arm, Cable, Course, FlowLaw, Inputs, Loading, LoadingError, LoadingSnap, MotionError,
    MotionOptions, Parameter, PathOptions, Profile, Simulation, Stability, Volume,
};

fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

/// Snaps against the stream.
fn facing(direction: f64, speed: f64, tension: f64) -> Arm {
    let mut arm = silicone();
    arm.flow.speed = speed;
    arm.flow.direction = direction;
    arm.cables[0].tension = tension;
    arm
}

#[test]
fn the_shape_after_a_snap_is_a_stable_one_of_the_equilibria() {
    for (direction, speed, tension) in [(3.0, 0.2, 0.2), (3.0, 0.4, 0.0), (3.0, 0.4, 0.2), (3.1, 0.4, 0.2)] {
        let arm = facing(direction, speed, tension);
        let found = arm.solve_after_snap(1e-8).unwrap();
        assert_eq!(found.snaps.len(), 1, "{direction} {speed} {tension}");
        let tip = found.configuration.tip();
        let all = arm.equilibria(1e-8).unwrap();
        let own = all.found.iter().find(|e| (e.configuration.tip().theta - tip.theta).abs() < 1e-6);
        assert_eq!(own.and_then(|e| e.stability), Some(Stability::Stable), "{direction} {speed} {tension}: {tip:?}");
        assert_eq!(found.configuration.snaps.len(), 1);
        let snap = found.snaps[0];
        assert!(snap.duration > 1.0 && snap.duration < 100.0, "{snap:?}");
    }
}

#[test]
fn an_arm_that_does_not_snap_has_its_usual_answer() {
    let arm = facing(0.5, 0.1, 0.3);
    let (usual, after) = (arm.solve().unwrap(), arm.solve_after_snap(1e-8).unwrap());
    assert!(after.snaps.is_empty());
    assert!((usual.tip().x - after.configuration.tip().x).abs() < 1e-12);
}

/// The whole way as motion: the tension is raised slowly, and held until the arm rests.
#[test]
fn the_shape_after_a_snap_is_the_end_of_a_slow_motion() {
    let arm = facing(3.0, 0.2, 0.2);
    let found = arm.solve_after_snap(1e-8).unwrap();
    let mut inputs = Inputs::default();
    inputs.set("cable[0].tension", Course::ramp(0.0, 0.2, 0.0, 60.0)).unwrap();
    let options = MotionOptions { tol: 1e-3, elements: Some(20), ..MotionOptions::default() };
    let mut simulation = Simulation::new(&arm, inputs, options).unwrap();
    let end = simulation.advance_to(120.0).unwrap();
    let tip = found.configuration.tip();
    let off = (end.tip[0] - tip.x).hypot(end.tip[1] - tip.y) / arm.length;
    assert!(off < 2e-3, "{off:e}: {tip:?} {end:?}");
}

#[test]
fn inertia_does_not_change_where_the_arm_lands() {
    let mut arm = facing(3.0, 0.2, 0.2);
    let moving = arm.solve_after_snap(1e-8).unwrap();
    arm.dynamics.inertia = false;
    let creeping = arm.solve_after_snap(1e-8).unwrap();
    let off = moving.configuration.tip().theta - creeping.configuration.tip().theta;
    assert!(off.abs() < 1e-6, "{off}");
    let [a, b] = [moving.snaps[0].duration, creeping.snaps[0].duration];
    assert!((a - b).abs() < 0.1 * a, "{a} {b}");
}

#[test]
fn a_snap_of_an_arm_with_friction_is_refused_by_name() {
    let mut arm = facing(3.0, 0.4, 0.0);
    arm.cables[0].friction = 0.1;
    let error = arm.solve_after_snap(1e-8).unwrap_err();
    let AfterSnapError::Motion { motion: MotionError::Unsupported { key, .. }, .. } = &error else { panic!("{error}") };
    assert_eq!(key, "cable[0].friction");
    assert!(error.to_string().contains("the arm snaps at"), "{error}");
}

/// An inextensible heavy column that a dead force bends to one side has two shapes where the force is turned: the path
/// of the force ends where its own bending shape ends.
#[test]
fn a_column_under_a_dead_load_snaps_to_its_mirror_image() {
    let mut arm = Arm::cone(1.0, 0.01, 0.01, 1e6, 0.5);
    arm.model.volume = Volume::None;
    arm.density = 1000.0;
    arm.flow.density = 0.0;
    arm.dynamics.relaxation_time = 0.05;
    let [_, _, ei] = arm.stiffness_at(0.0);
    // 1.2 times the load at which it buckles, with a side load that is turned over.
    let push = 1.2 * std::f64::consts::PI.powi(2) / 4.0 * ei;
    arm.tip.force = [-push, 0.5 * ei];
    let (mut loading, first) = Loading::start(&arm, 1e-8).unwrap();
    arm.tip.force[1] = -0.5 * ei;
    let over = loading.go_to(&arm).unwrap();
    assert_eq!(over.snaps.len(), 1);
    let (a, b) = (first.configuration.tip(), over.configuration.tip());
    assert!((a.x - b.x).abs() < 1e-6 && (a.y + b.y).abs() < 1e-6, "{a:?} {b:?}");
    // It passes the middle, without side load, on its own side, up to the limit point of the path.
    arm.tip.force[1] = 0.5 * ei;
    let path = arm.path(Parameter::TipForce(1), [0.5 * ei, -0.5 * ei], &PathOptions::default()).unwrap();
    let limit = path.branches[0].points.iter().find(|p| p.event.is_some()).unwrap().value;
    assert!((over.snaps[0].fraction - (0.5 - limit / ei)).abs() < 1e-5, "{:?} {limit}", over.snaps[0]);
    assert!(over.snaps[0].before.y > 0.0 && over.snaps[0].after.y < 0.0, "{:?}", over.snaps[0]);
    arm.tip.force[1] = 0.5 * ei;
    let back = loading.go_to(&arm).unwrap();
    assert_eq!(back.snaps.len(), 1);
    assert!((back.snaps[0].fraction - over.snaps[0].fraction).abs() < 1e-5, "both ways alike");
    // Without viscosity nothing stops it in a vacuum.
    arm.dynamics.relaxation_time = 0.0;
    let (mut loading, _) = Loading::start(&arm, 1e-8).unwrap();
    arm.tip.force[1] = -0.5 * ei;
    let error = loading.go_to(&arm).unwrap_err();
    let LoadingError::Motion { motion: MotionError::Unsupported { key, .. }, .. } = &error else { panic!("{error}") };
    assert_eq!(key, "dynamics.relaxation_time");
    arm.tip.force[1] = 0.5 * ei;
    // In water that does not drag it swings on.
    arm.flow.density = 1000.0;
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 0.0, ct: 0.0 };
    let (mut loading, _) = Loading::start(&arm, 1e-8).unwrap();
    arm.tip.force[1] = -0.5 * ei;
    let error = loading.go_to(&arm).unwrap_err();
    assert!(matches!(error, LoadingError::NoRest { speed, .. } if speed > 0.0), "{error}");
}

/// Both limit points of the base's angle are those of the path, and the way between does not hang on how it is cut.
#[test]
fn limit_points_up_and_down_are_those_of_the_path() {
    let mut arm = facing(std::f64::consts::PI, 0.2, 0.0);
    arm.base.angle = 0.6;
    let path = arm.path(Parameter::BaseAngle, [0.6, -0.6], &PathOptions::default()).unwrap();
    let limit = path.branches[0].points.iter().find(|p| p.event.is_some()).unwrap().value;
    for cuts in [1, 7] {
        arm.base.angle = 0.6;
        let (mut loading, first) = Loading::start(&arm, 1e-8).unwrap();
        let mut met = Vec::new();
        for (from, to) in [(0.6, -0.6), (-0.6, 0.6)] {
            for k in 1..=cuts {
                let before = from + (to - from) * f64::from(k - 1) / f64::from(cuts);
                arm.base.angle = from + (to - from) * f64::from(k) / f64::from(cuts);
                let step = loading.go_to(&arm).unwrap();
                met.extend(step.snaps.iter().map(|snap| before + snap.fraction * (arm.base.angle - before)));
                // The curve leads on through angles that are not those between the rows.
                let along = |snap: &LoadingSnap| snap.on_curve.is_some() && !snap.lands_elsewhere(arm.length);
                assert!(step.snaps.iter().all(along), "{:?}", step.snaps);
                if k == cuts && to == 0.6 {
                    let off = step.configuration.tip().theta - first.configuration.tip().theta;
                    assert!(off.abs() < 1e-6, "{off}");
                }
            }
        }
        assert_eq!(met.len(), 2, "{met:?}");
        assert!((met[0] - limit).abs() < 1e-4 && (met[1] + limit).abs() < 1e-4, "{met:?} {limit}");
    }
}

#[test]
fn a_fold_on_the_way_leaves_the_loads_before() {
    let mut arm = silicone();
    let (mut loading, _) = Loading::start(&arm, 1e-8).unwrap();
    arm.cables[0].tension = 0.5;
    let pulled = loading.go_to(&arm).unwrap();
    arm.cables[0].tension = 5.0;
    let error = loading.go_to(&arm).unwrap_err();
    assert!(matches!(error, LoadingError::Limit { .. }), "{error}");
    arm.cables[0].tension = 0.5;
    let again = loading.go_to(&arm).unwrap();
    assert!((again.configuration.tip().theta - pulled.configuration.tip().theta).abs() < 1e-7);
    arm.length = 0.3;
    assert!(matches!(loading.go_to(&arm), Err(LoadingError::Unsupported { .. })));
}

/// Several loads along one line, against a solve at its end.
#[test]
fn loads_that_change_together_end_where_a_solve_does() {
    let mut arm = silicone();
    arm.gravity = Some(hydrostat::Gravity::default());
    let (mut loading, _) = Loading::start(&arm, 1e-9).unwrap();
    arm.cables[0].tension = 0.3;
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.0;
    arm.tip.force = [1e-3, -2e-3];
    arm.base.angle = 0.3;
    arm.base.x = 0.1;
    let (led, solved) = (loading.go_to(&arm).unwrap(), arm.solve().unwrap());
    let (a, b) = (led.configuration.tip(), solved.tip());
    assert!((a.x - b.x).hypot(a.y - b.y) < 1e-8 && (a.theta - b.theta).abs() < 1e-7, "{a:?} {b:?}");
}

/// Strokes in place of tensions: the same shapes, whichever is given.
#[test]
fn strokes_lead_up_and_down() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.002);
    let (mut loading, first) = Loading::start(&arm, 1e-8).unwrap();
    arm.cables[0].stroke = Some(0.010);
    let wound = loading.go_to(&arm).unwrap();
    let solved = arm.solve().unwrap();
    assert!((wound.configuration.tip().theta - solved.tip().theta).abs() < 1e-6);
    assert!(wound.configuration.cables[0].tension > first.configuration.cables[0].tension);
    arm.cables[0].stroke = Some(0.002);
    let back = loading.go_to(&arm).unwrap();
    assert!((back.configuration.tip().theta - first.configuration.tip().theta).abs() < 1e-6);
}
