//! Cables whose length is commanded.

use hydrostat::{Arm, Cable, Configuration, Options, Profile, SolveError, Solver, VerdictKind};

fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

fn paper() -> Arm {
    let mut arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

fn solve(arm: &Arm) -> Configuration {
    let mut solver = Solver::new(arm, Options::with_tol(1e-10)).unwrap();
    solver.solve().unwrap_or_else(|e| panic!("{:?}: {e}", arm.cables.iter().map(|c| c.stroke).collect::<Vec<_>>()))
}

/// The same arm with the strokes found commanded in place of the tensions.
fn commanded(solved: &Configuration) -> Arm {
    let mut arm = solved.arm.clone();
    for (cable, state) in arm.cables.iter_mut().zip(&solved.cables) {
        cable.tension = 0.0;
        cable.stroke = Some(state.stroke);
    }
    arm
}

/// In line with a fast stream, with kinks all along, the path of the strokes did not get away from its start.
#[test]
fn strokes_of_an_arm_that_lies_in_a_fast_stream_are_found() {
    let name = "multi-bending";
    let file = hydrostat_files::ArmFile::parse(hydrostat_files::shipped::get(name).unwrap(), name).unwrap();
    let mut pulled = file.arm().unwrap();
    pulled.flow.speed = 1.0;
    for cable in pulled.cables.iter_mut().filter(|cable| cable.name.starts_with("left")) {
        cable.tension = 0.25;
    }
    let given = pulled.solve().unwrap();
    let mut asked = pulled.clone();
    for (cable, state) in asked.cables.iter_mut().zip(&given.cables).filter(|(cable, _)| cable.tension > 0.0) {
        (cable.tension, cable.stroke, cable.max_tension) = (0.0, Some(state.stroke), None);
    }
    let found = asked.solve().unwrap();
    for (a, b) in given.cables.iter().zip(&found.cables) {
        assert!((a.tension - b.tension).abs() < 1e-5, "{a:?} {b:?}");
    }
    let off = (given.tip().x - found.tip().x).hypot(given.tip().y - found.tip().y);
    assert!(off < 1e-7 * pulled.length, "{off:e}");
}

#[test]
fn strokes_of_known_tensions_give_these_tensions_back() {
    for arm in [paper(), silicone()] {
        for speed in [0.0, 0.1, 0.3, 0.5] {
            for (left, right) in [(0.1, 0.0), (0.3, 0.1), (0.05, 0.4), (0.6, 0.5)] {
                let mut pulled = arm.clone();
                pulled.flow.speed = speed;
                pulled.set_tensions(&[left, right]).unwrap();
                let Ok(given) = Solver::new(&pulled, Options::with_tol(1e-10)).unwrap().solve() else { continue };
                let found = solve(&commanded(&given));
                for (one, other) in given.cables.iter().zip(&found.cables) {
                    let off = (one.stroke - other.stroke).abs() / arm.length;
                    assert!(off < 1e-9, "{speed} m/s, {left} and {right} N: stroke off by {off:e} L");
                    let off = (one.tension - other.tension).abs() / left.max(right);
                    assert!(off < 2e-7, "{speed} m/s, {left} and {right} N: tension off by {off:e}");
                }
                let off = (given.tip().x - found.tip().x).hypot(given.tip().y - found.tip().y) / arm.length;
                assert!(off < 1e-8, "{speed} m/s, {left} and {right} N: tip off by {off:e} L");
            }
        }
    }
}

#[test]
fn a_cable_that_would_push_hangs_slack() {
    // The right cable paid out by more than the bend takes: slack, as if it were not there.
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.010);
    let alone = solve(&arm);
    arm.cables[1].stroke = Some(-0.030);
    let both = solve(&arm);
    assert_eq!(both.cables[1].tension, 0.0);
    let command = both.cables[1].command.unwrap();
    assert!(command.slack);
    assert!(command.length > both.cables[1].length + 1e-3, "{command:?} {}", both.cables[1].length);
    assert!((command.length - both.cables[1].length - (both.cables[1].stroke + 0.030)).abs() < 1e-12);
    assert!((alone.tip().y - both.tip().y).abs() < 1e-9);
    assert!(!both.cables[0].command.unwrap().slack);
    // Paid out by less than that, it holds back.
    arm.cables[1].stroke = Some(both.cables[1].stroke + 0.001);
    let held = solve(&arm);
    assert!(held.cables[1].tension > 0.0);
    assert!(held.tip().y < both.tip().y);
}

#[test]
fn tensions_and_slacks_are_complementary_over_a_grid_of_commands() {
    let mut taut = [0; 3];
    for left in -4..=8_i32 {
        for right in -4..=8_i32 {
            let mut arm = silicone();
            arm.flow.speed = 0.1;
            let strokes = [left, right].map(|k| 0.002 * f64::from(k));
            for (cable, stroke) in arm.cables.iter_mut().zip(strokes) {
                cable.stroke = Some(stroke);
            }
            let Ok(found) = arm.solve() else { continue };
            for (cable, stroke) in found.cables.iter().zip(strokes) {
                let slack = cable.stroke - stroke;
                assert!(cable.tension >= 0.0 && slack > -1e-9, "{strokes:?}: {cable:?}");
                assert!(cable.tension == 0.0 || slack.abs() < 1e-9 * arm.length, "{strokes:?}: {cable:?}");
            }
            taut[found.cables.iter().filter(|c| c.tension > 0.0).count()] += 1;
        }
    }
    println!("{taut:?}");
    assert!(taut.iter().all(|count| *count > 10), "{taut:?}");
    assert!(taut.iter().sum::<i32>() > 150, "{taut:?}");
}

#[test]
fn antagonists_at_opposite_strokes_mirror() {
    let mut arm = silicone();
    let at = |arm: &mut Arm, stroke: f64| {
        arm.cables[0].stroke = Some(stroke);
        arm.cables[1].stroke = Some(-stroke);
        solve(arm)
    };
    for stroke in [0.002, 0.006, 0.012] {
        let (one, other) = (at(&mut arm, stroke), at(&mut arm, -stroke));
        assert!((one.tip().y + other.tip().y).abs() < 1e-9);
        assert!((one.cables[0].tension - other.cables[1].tension).abs() < 1e-7);
        assert!(one.tip().y > 0.0);
    }
}

#[test]
fn one_cable_may_be_commanded_and_the_other_pulled() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.008);
    arm.cables[1].tension = 0.2;
    let found = solve(&arm);
    assert!((found.cables[0].stroke - 0.008).abs() < 1e-10);
    assert_eq!(found.cables[1].tension, 0.2);
    let mut given = silicone();
    given.set_tensions(&[found.cables[0].tension, 0.2]).unwrap();
    assert!((solve(&given).tip().y - found.tip().y).abs() < 1e-9);
}

#[test]
fn an_elastic_cable_takes_more_stroke_for_the_same_tension() {
    let mut stiff = silicone();
    stiff.cables[0].tension = 0.4;
    let given = solve(&stiff);
    let reference = given.cables[0].length + given.cables[0].stroke;
    for stiffness in [5.0, 50.0, 5000.0] {
        // Unstretched, the cable is shorter than its path by T/EA.
        let stroke = reference - given.cables[0].length / (1.0 + 0.4 / stiffness);
        let mut arm = silicone();
        arm.cables[0].stroke = Some(stroke);
        arm.cables[0].stiffness = Some(stiffness);
        let found = solve(&arm);
        assert!((found.cables[0].tension - 0.4).abs() < 1e-7, "EA {stiffness}: {}", found.cables[0].tension);
        assert!((found.tip().y - given.tip().y).abs() < 1e-9);
    }
}

#[test]
fn a_small_change_of_stroke_is_solved_from_the_last_shape() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.010);
    let mut solver = Solver::new(&arm, Options::default()).unwrap();
    solver.solve().unwrap();
    solver.set_stroke(0, 0.0101).unwrap();
    let warm = solver.configuration().unwrap();
    arm.cables[0].stroke = Some(0.0101);
    let cold = arm.solve().unwrap();
    assert!((warm.tip().y - cold.tip().y).abs() < 1e-8 * arm.length);
    assert_eq!(warm.statistics.load_steps, 0);
    assert!(warm.statistics.newton_rounds < cold.statistics.newton_rounds);
}

#[test]
fn more_stroke_than_the_arm_can_take_ends_in_a_verdict() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.2);
    let Err(SolveError::NoEquilibrium(no)) = arm.solve() else { panic!("0.2 m of 0.245 m") };
    assert_eq!(no.verdict.kind, VerdictKind::CableFold);
    assert_eq!(no.verdict.phase.name(), "stroke");
    let last = no.last_good.unwrap();
    assert!(last.cables[0].stroke > 0.01 && last.cables[0].tension > 0.5);
}

/// A solver that was given tensions after strokes held on to the commands, at a stroke of zero.
#[test]
fn tensions_that_replace_strokes_are_what_is_solved_for() {
    let mut arm = silicone();
    arm.cables[0].stroke = Some(0.010);
    let mut solver = Solver::new(&arm, Options::default()).unwrap();
    solver.solve().unwrap();
    solver.set_tensions(&[0.2, 0.0]).unwrap();
    let found = solver.configuration().unwrap();
    assert_eq!(found.cables[0].tension, 0.2);
    assert!(found.cables[0].command.is_none());
    assert!(matches!(solver.set_stroke(2, 0.01), Err(SolveError::Option { option: "cable", .. })));
}
