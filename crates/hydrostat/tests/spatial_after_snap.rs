//! What comes after a snap in space: against the snap in the plane, and the equilibria.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/space.rs"]
mod space;

use hydrostat::{AfterSnapError, Arm, MotionError, SpatialError, Stability, VerdictKind};
use hydrostat_files::{ArmFile, shipped};
use space::{apart, rotation, silicone, solved, tip, turned, turned_arm};

/// An arm that lies against the stream, and snaps as the stream grows.
fn against_the_stream() -> Arm {
    let mut arm = silicone();
    arm.cables.clear();
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.flow.speed = 0.4;
    arm.flow.direction = 172.0_f64.to_radians();
    arm
}

#[test]
fn a_snap_in_any_plane_is_that_in_the_plane() {
    let arm = against_the_stream();
    let flat = arm.solve_after_snap(1e-7).unwrap();
    let m = rotation(0.7, -0.4, 1.9);
    let turned_about = turned_arm(&arm, &m);
    let found = turned_about.solve_after_snap_in_space(1e-7).unwrap();
    assert_eq!((flat.snaps.len(), found.snaps.len()), (1, 1));
    let (own, want) = (&found.snaps[0], &flat.snaps[0]);
    assert!((own.snap.load_fraction - want.snap.load_fraction).abs() < 2e-3);
    assert!((own.snap.distance() - want.snap.distance()).abs() < 5e-3 * arm.length);
    assert!((own.duration / want.duration - 1.0).abs() < 0.1, "{} {}", own.duration, want.duration);
    let end = flat.configuration.tip();
    let off = apart(tip(&found.configuration), turned(&m, [end.x, end.y, 0.0])) / arm.length;
    assert!(off < 1e-5, "{off:.1e}");
    assert_eq!(found.configuration.stability(), Some(Stability::Stable));
    let all = arm.equilibria(1e-7).unwrap();
    let near = |own: hydrostat::Tip| apart(turned(&m, [own.x, own.y, 0.0]), tip(&found.configuration)) / arm.length;
    let nearest = all.found.iter().map(|own| near(own.configuration.tip())).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-5, "{nearest:.1e} of {} equilibria", all.found.len());
}

#[test]
fn an_arm_in_space_that_does_not_snap_has_its_usual_answer() {
    let mut arm = against_the_stream();
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.0;
    let turned = turned_arm(&arm, &rotation(0.7, -0.4, 1.9));
    let found = turned.solve_after_snap_in_space(1e-7).unwrap();
    assert!(found.snaps.is_empty());
    assert!(apart(tip(&found.configuration), tip(&solved(&turned, 1e-8))) < 1e-6 * arm.length);
}

#[test]
fn snaps_that_no_motion_follows_are_refused_with_their_key() {
    let mut arm = turned_arm(&against_the_stream(), &rotation(0.7, -0.4, 1.9));
    arm.cables = silicone().cables;
    arm.cables[0].stroke = Some(0.005);
    let refused = arm.solve_after_snap_in_space(1e-6).unwrap_err();
    let AfterSnapError::Motion { motion: MotionError::Unsupported { key, .. }, .. } = &refused else {
        panic!("{refused}")
    };
    assert_eq!(key, "cable[0].stroke");
    // Without the motion it is a verdict.
    arm.cables.clear();
    let SpatialError::NoEquilibrium(no) =
        hydrostat::SpatialSolver::new(&arm, hydrostat::Options::with_tol(1e-6)).unwrap().solve().unwrap_err()
    else {
        panic!("a verdict")
    };
    assert_eq!(no.verdict.kind, VerdictKind::LimitPoint);
}

/// An arm rested for 4e9 s and was said to move: under the resistance that stability assumes two motions grow where it
/// rests, and under its own none.
#[test]
fn an_octopus_arm_that_had_come_to_rest_was_said_to_move() {
    let mut arm = ArmFile::parse(shipped::get("octopus-spatial").unwrap(), "octopus-spatial").unwrap().arm().unwrap();
    arm.flow.speed = 0.3;
    arm.flow.direction = 180.0_f64.to_radians();
    let found = arm.solve_after_snap_in_space(1e-6).unwrap();
    assert_eq!(found.snaps.len(), 1);
    assert!(found.snaps[0].duration < 60.0, "{} s", found.snaps[0].duration);
    // The path leads to no shape and no turn of the base does: the search starts from this one.
    let all = arm.equilibria_in_space(1e-6).unwrap();
    let end = tip(&found.configuration);
    let nearest = all.found.iter().map(|own| apart(tip(&own.configuration), end)).fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-4 * arm.length && all.sum_of_signs == Some(1), "{nearest:.1e} {:?}", all.sum_of_signs);
}
