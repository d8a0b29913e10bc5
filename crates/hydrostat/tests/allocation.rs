//! A warm update allocates nothing: control loops and sweeps call it millions of times.

use allocation_counter::measure;
use hydrostat::{Arm, Cable, Options, Profile, Solver};

fn arm() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm.flow.speed = 0.2;
    arm
}

#[test]
fn the_counter_counts() {
    assert!(measure(|| drop(Solver::new(&arm(), Options::default()))).count_total > 10);
}

#[test]
fn a_warm_update_allocates_nothing() {
    let mut solver = Solver::new(&arm(), Options::default()).unwrap();
    let cold = solver.solve().unwrap();
    let mut moved: f64 = 0.0;
    // The first few find out how much room the moves of nodes onto kinks take.
    for round in 0..40 {
        // Up and down by one percent.
        let level = i32::abs(round % 8 - 4);
        let tension = [0.5 * 1.01_f64.powi(level), 0.0];
        let speed = 0.2 + 0.001 * f64::from(level);
        let counted = measure(|| {
            solver.set_tensions(&tension).unwrap();
            solver.set_flow_speed(speed).unwrap();
            let answer = solver.update().unwrap();
            moved = moved.max((answer.tip.x - cold.tip().x).hypot(answer.tip.y - cold.tip().y));
        });
        assert!(round < 8 || counted.count_total == 0, "round {round}: {counted:?}");
    }
    assert!(moved > 1e-3, "the arm hardly moved: {moved}");
}

#[test]
fn an_update_is_the_tip_of_the_configuration() {
    let mut solver = Solver::new(&arm(), Options::default()).unwrap();
    let mut twin = solver.clone();
    assert_eq!(solver.update().unwrap().tip, twin.configuration().unwrap().tip());
    solver.set_tensions(&[0.505, 0.0]).unwrap();
    twin.set_tensions(&[0.505, 0.0]).unwrap();
    let (answer, whole) = (solver.update().unwrap(), twin.configuration().unwrap());
    let off = (answer.tip.x - whole.tip().x).hypot(answer.tip.y - whole.tip().y);
    assert!(off < 1e-14 && (answer.tip.alpha - whole.tip().alpha).abs() < 1e-12, "{off}");
    assert_eq!(answer.error_estimate, whole.error_estimate);
    // What is read out later is the same, and after a change of loads it is not the old one.
    assert_eq!(solver.configuration().unwrap().tip(), whole.tip());
    solver.set_tensions(&[0.51, 0.0]).unwrap();
    let later = solver.configuration().unwrap();
    assert!(later.tip().theta > whole.tip().theta && later.cables[0].tension == 0.51);
}
