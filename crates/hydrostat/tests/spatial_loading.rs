//! Loads in space that rise and fall, and shapes that are let go, against those in the plane.

use hydrostat::{Arm, Cable, Loading, LoadingError, Options, Parameter, PathOptions, Profile, Space, SpatialSolver};

fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("up", Profile::linear(0.005, 0.001)).at_angle(std::f64::consts::FRAC_PI_2));
    arm.space = Some(Space::default());
    arm
}

/// Against the stream the arm snaps over as its base turns, and back, as it does in the plane.
#[test]
fn an_arm_in_a_plane_snaps_there_as_in_the_plane() {
    let mut arm = silicone();
    arm.flow.speed = 0.2;
    arm.flow.direction = std::f64::consts::PI;
    arm.base.angle = 0.6;
    let mut flat = arm.clone();
    flat.space = None;
    flat.cables.pop();
    let (mut plane, _) = Loading::start(&flat, 1e-8).unwrap();
    let (mut space, first) = Loading::start_in_space(&arm, 1e-8).unwrap();
    for angle in [-0.6, 0.6] {
        (arm.base.angle, flat.base.angle) = (angle, angle);
        let (there, own) = (plane.go_to(&flat).unwrap(), space.go_to(&arm).unwrap());
        assert_eq!((there.snaps.len(), own.snaps.len()), (1, 1));
        let (a, b) = (there.snaps[0], own.snaps[0]);
        assert!((a.fraction - b.fraction).abs() < 1e-5, "{} {}", a.fraction, b.fraction);
        assert!((a.duration - b.duration).abs() < 0.02 * a.duration, "{} {}", a.duration, b.duration);
        assert!((a.distance() - b.distance()).abs() < 1e-3 * arm.length, "{} {}", a.distance(), b.distance());
        let (a, b) = (there.configuration.tip(), own.configuration.tip());
        assert!((a.x - b.x).hypot(a.y - b.y).hypot(b.z) < 1e-6 * arm.length, "{a:?} {b:?}");
        if angle == 0.6 {
            let tip = first.configuration.tip();
            assert!((tip.x - b.x).hypot(tip.y - b.y) < 1e-6 * arm.length, "after a cycle it is where it was");
        }
    }
}

/// Without snaps the way does not matter: where loads in three directions change together a solve has the same shape.
#[test]
fn loads_that_change_together_end_where_a_solve_does() {
    let mut arm = silicone();
    let (mut loading, _) = Loading::start_in_space(&arm, 1e-8).unwrap();
    arm.cables[1].tension = 0.1;
    arm.flow.speed = 0.05;
    Parameter::StreamAlong(2).set(&mut arm, 0.5).unwrap();
    arm.base.x = 0.1;
    arm.space.as_mut().unwrap().z = -0.2;
    Parameter::TipForce(2).set(&mut arm, 1e-3).unwrap();
    let step = loading.go_to(&arm).unwrap();
    assert!(step.snaps.is_empty());
    let solved = SpatialSolver::new(&arm, Options::default()).unwrap().solve().unwrap();
    let (a, b) = (step.configuration.tip(), solved.tip());
    assert!((a.x - b.x).hypot(a.y - b.y).hypot(a.z - b.z) < 1e-7 * arm.length, "{a:?} {b:?}");
    assert!(a.z < -0.1 && a.x > 0.2);
    // A fold on the way leaves the loads before.
    let mut pulled = arm.clone();
    pulled.cables[1].tension = 5.0;
    assert!(matches!(loading.go_to(&pulled), Err(LoadingError::Limit { .. })));
    let again = loading.go_to(&arm).unwrap().configuration.tip();
    assert!((again.z - a.z).abs() < 1e-8 * arm.length);
    arm.density = 1100.0;
    assert!(matches!(loading.go_to(&arm), Err(LoadingError::Unsupported { .. })));
}

/// From a limit point of a path the arm moves to where it rests in the plane.
#[test]
fn a_shape_at_a_limit_point_is_let_go() {
    let mut arm = silicone();
    arm.flow.speed = 0.2;
    arm.flow.direction = std::f64::consts::PI;
    let path = arm.path_in_space(Parameter::BaseAngle, [0.6, -0.6], &PathOptions::default()).unwrap();
    let limit = path.branches[0].points.iter().find(|p| p.event == Some(hydrostat::Event::LimitPoint)).unwrap();
    let mut past = limit.configuration.arm.clone();
    past.base.angle = limit.value - 1.2e-3;
    let rest = limit.configuration.let_go(&past, 1e-8).unwrap();
    past.space = None;
    past.cables.pop();
    let flat = past.solve_after_snap(1e-8).unwrap().configuration.tip();
    let tip = rest.configuration.tip();
    assert!((tip.x - flat.x).hypot(tip.y - flat.y).hypot(tip.z) < 1e-6 * arm.length, "{tip:?} {flat:?}");
    assert!(rest.time > 0.5);
    past.length = 0.3;
    assert!(limit.configuration.let_go(&past, 1e-8).is_err());
}
