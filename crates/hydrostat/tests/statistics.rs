//! What solves take, counted and never timed: a change that makes them dearer should be seen.
//! Cheaper is fine; lower the bounds then.

use hydrostat::cases;
use hydrostat::{Arm, Cable, Gravity, Profile, Volume};

/// Elements, Newton rounds and load steps that an arm may take, a few more than it did.
struct Bound {
    elements: usize,
    rounds: usize,
    load_steps: usize,
}

fn check(name: &str, arm: &Arm, bound: &Bound) {
    let taken = arm.solve().unwrap_or_else(|e| panic!("{name}: {e}")).statistics;
    eprintln!("{name}: {taken:?}");
    assert_eq!(taken.stages, 4, "{name}");
    assert!(taken.elements <= bound.elements, "{name}: {} elements", taken.elements);
    assert!(taken.newton_rounds <= bound.rounds, "{name}: {} rounds", taken.newton_rounds);
    assert!(taken.load_steps <= bound.load_steps, "{name}: {} load steps", taken.load_steps);
    assert!(taken.evaluations >= taken.elements * taken.stages && taken.meshes >= 1, "{name}: {taken:?}");
}

fn cone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

#[test]
fn cables_alone_take_one_direct_solve() {
    let direct = |elements| Bound { elements, rounds: 8, load_steps: 0 };
    check("cone", &cone(), &direct(18));
    let mut short = cone();
    (short.cables[1].end, short.cables[1].tension) = (0.5, 0.3);
    check("cone with a short cable", &short, &direct(18));
    check("uniform arm", &cases::one_cable(Volume::Planar, 4.0).arm, &direct(12));
}

#[test]
fn a_stream_that_trails_the_arm_takes_one_direct_solve() {
    let mut arm = cone();
    arm.cables.clear();
    arm.flow.speed = 0.5;
    arm.flow.direction = 1.5;
    check("flag", &arm, &Bound { elements: 24, rounds: 22, load_steps: 0 });
}

#[test]
fn pulled_against_a_stream_the_arm_is_followed_along_the_path() {
    let mut arm = cone();
    arm.flow.speed = 0.1;
    let followed = Bound { elements: 27, rounds: 215, load_steps: 20 };
    check("along", &arm, &followed);
    arm.flow.direction = 1.2;
    check("across", &arm, &followed);
    arm.density = 1200.0;
    arm.gravity = Some(Gravity::default());
    check("across, heavy", &arm, &followed);
}

#[test]
fn loads_of_the_tables() {
    check("end load 10", &cases::end_loads()[3].arm, &Bound { elements: 12, rounds: 13, load_steps: 0 });
    check("drag 10", &cases::normal_drag()[1].arm, &Bound { elements: 12, rounds: 54, load_steps: 7 });
    check("follower 1", &cases::follower_loads()[0].arm, &Bound { elements: 16, rounds: 45, load_steps: 7 });
}
