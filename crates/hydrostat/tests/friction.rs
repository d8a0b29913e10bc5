//! Cables that rub in their channels.

use hydrostat::cases::inextensible_arm;
use hydrostat::{Arm, Cable, Configuration, Motion, Options, Phase, Profile, SolveError, Solver, VerdictKind};
use hydrostat_files::{ArmFile, shipped};

fn solve(arm: &Arm, tol: f64) -> Configuration {
    Solver::new(arm, Options::with_tol(tol)).unwrap().solve().unwrap_or_else(|e| panic!("{e}"))
}

/// An inextensible arm with one cable beside it bends by mu = T y/EI, and the cable turns as the arm does:
/// theta' = k exp(-+ f theta) with k = T(0) y/EI, so that theta = +- ln(1 +- f k s)/f.
#[test]
fn a_bent_inextensible_arm_against_the_closed_form() {
    let lever = 0.005;
    for (motion, sign) in [(Motion::In, 1.0), (Motion::Out, -1.0)] {
        for friction in [0.05, 0.2, 0.5, 2.0] {
            // Paid out it curls up without end where friction times curvature comes to one.
            for curvature in [0.5_f64, 1.5, 8.0].into_iter().filter(|k| motion == Motion::In || friction * k < 0.9) {
                let mut arm = inextensible_arm("rubbed");
                // EI is 1 N m2.
                let cable = Cable::new("left", lever).pulled(curvature / lever);
                arm.cables.push(cable.with_friction(friction, motion));
                let turn = sign * (1.0 + sign * friction * curvature).ln() / friction;
                let solved = solve(&arm, 1e-9);
                let off = (solved.tip().theta - turn).abs();
                assert!(off < 2e-8, "friction {friction}, {motion:?}, curvature {curvature}: off by {off:e} rad");
                let half = sign * (1.0 + 0.5 * sign * friction * curvature).ln() / friction;
                assert!((solved.at(0.5).theta - half).abs() < 2e-8);
            }
        }
    }
}

fn cone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.4));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1));
    arm.flow.speed = 0.2;
    arm
}

#[test]
fn friction_that_vanishes_leaves_the_answer_without() {
    let free = solve(&cone(), 1e-9);
    let mut last = f64::INFINITY;
    for friction in [1e-3, 1e-5, 1e-7] {
        let mut arm = cone();
        for cable in &mut arm.cables {
            cable.friction = friction;
        }
        let rubbed = solve(&arm, 1e-9);
        let off = (rubbed.tip().x - free.tip().x).hypot(rubbed.tip().y - free.tip().y) / arm.length;
        assert!(off < friction && off < last, "friction {friction}: {off:e}");
        last = off;
    }
}

/// Reeling in bends less than without friction, paying out more: a hysteresis.
#[test]
fn reeling_in_and_paying_out_lie_on_both_sides() {
    let with = |motion| {
        let mut arm = cone();
        for cable in &mut arm.cables {
            (cable.friction, cable.motion) = (0.1, motion);
        }
        solve(&arm, 1e-8).tip().theta
    };
    let free = solve(&cone(), 1e-8).tip().theta;
    assert!(with(Motion::In) < free && free < with(Motion::Out));
}

/// The rounds end where shape and turns agree: the balance of the whole arm does not feel them, the tip does by less
/// than the tolerance.
#[test]
fn the_tolerance_is_kept_with_friction() {
    let mut arm = cone();
    arm.cables[0].friction = 0.15;
    arm.cables[0].end = 0.7;
    let best = solve(&arm, 1e-11);
    for tol in [1e-6, 1e-8] {
        let solved = solve(&arm, tol);
        let off = (solved.tip().x - best.tip().x).hypot(solved.tip().y - best.tip().y) / arm.length;
        assert!(off <= tol, "{tol:e}: off by {off:e}");
    }
}

#[test]
fn friction_spares_the_tip() {
    // 1 N folds the tip shut without friction, not with.
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(1.0));
    assert!(arm.solve().is_err());
    arm.cables[0].friction = 0.1;
    let solved = solve(&arm, 1e-8);
    assert_eq!(solved.cables[0].tension, 1.0);
}

/// Cables that rub much: rounds of shape and turns go from side to side there by themselves, and the answer was the
/// verdict without friction.
#[test]
fn strong_friction_was_called_a_fold() {
    for tension in [0.8, 1.0, 1.5] {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(tension));
        let mut last = f64::INFINITY;
        for friction in [0.4, 0.8, 1.2, 1.6, 1.7, 1.8, 1.9, 2.0] {
            arm.cables[0].friction = friction;
            let turned = solve(&arm, 1e-8).tip().theta;
            assert!(turned > 0.0 && turned < last, "friction {friction} at {tension} N: {turned} after {last}");
            last = turned;
        }
    }
}

/// Rounds can lead nowhere where a cable squeezes a thin tip. What they pass then is no limit of the arm, which more
/// friction only spares.
#[test]
fn rounds_that_lead_nowhere_were_called_a_limit_of_the_sections() {
    let mut arm = ArmFile::parse(shipped::get("paper").unwrap(), "paper").unwrap().arm().unwrap();
    arm.set_tensions(&[60.0, 0.0]).unwrap();
    for friction in [0.94, 1.2] {
        arm.cables[0].friction = friction;
        if let Err(error) = arm.solve() {
            let SolveError::NoEquilibrium(no) = error else { panic!("{error}") };
            assert_eq!(no.verdict.kind, VerdictKind::NotFound, "friction {friction}: {}", no.verdict.message());
        }
    }
}

/// Paid out, a cable pulls the tip more and more, and folds it shut: at the same friction, however much there was to
/// be, and what is last found to be good is in balance with the friction that it says.
#[test]
fn a_cable_paid_out_until_it_folds_the_tip_was_not_found() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.3).with_friction(0.0, Motion::Out));
    let mut folds = Vec::new();
    for friction in [0.2, 0.3, 1.0] {
        arm.cables[0].friction = friction;
        let Err(SolveError::NoEquilibrium(no)) = arm.solve() else { panic!("friction {friction} has an answer") };
        assert_eq!(
            (no.verdict.kind, no.verdict.phase),
            (VerdictKind::CableFold, Phase::Friction),
            "{}",
            no.verdict.message()
        );
        assert!((no.verdict.s.unwrap() - arm.length).abs() < 1e-3);
        folds.push(no.verdict.load_fraction * friction);
        let last = no.last_good.unwrap();
        let again = solve(&last.arm, 1e-8);
        let off = (again.tip().x - last.tip().x).hypot(again.tip().y - last.tip().y) / arm.length;
        assert!(off < 1e-4, "friction {} in place of {friction}: {off:e} off", last.arm.cables[0].friction);
    }
    assert!(folds.iter().all(|fold| (fold / folds[0] - 1.0).abs() < 1e-3), "{folds:?}");
}

#[test]
fn a_commanded_stroke_with_friction_takes_more_tension() {
    let mut arm = cone();
    arm.cables[1].tension = 0.0;
    arm.cables[0].stroke = Some(0.012);
    let free = solve(&arm, 1e-9);
    arm.cables[0].friction = 0.1;
    let rubbed = solve(&arm, 1e-9);
    assert!((rubbed.cables[0].stroke - 0.012).abs() < 1e-9);
    assert!(rubbed.cables[0].tension > 1.05 * free.cables[0].tension);
}

/// The direction of the cable turns one way, then the other. On both sides of a node where it does, the polynomials had
/// that place some micrometres off: nodes clustered there, or left it, and rounds of shape and turns did not settle. At
/// 1e-6 friction was not raised past 0.066 of it.
#[test]
fn nodes_clustered_where_a_cable_turns_the_other_way() {
    let mut arm = Arm::cone(0.2, 0.010, 0.004, 100e3, 0.5);
    arm.reference.mu = Profile::linear(0.0, -20.0);
    arm.cables.push(Cable::new("left", 0.002).pulled(0.3).with_friction(0.2, Motion::In));
    // Found by an independent solver, to 4e-10.
    let tip = [0.169_509_232_5, -0.072_851_846_9];
    // 8.384 mm and 193.201 mm are where chi' changes its sign in the arm without friction; with it the second is
    // further out.
    let first = 8.380e-3;
    for tol in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
        let solved = solve(&arm, tol);
        let off = (solved.tip().x - tip[0]).hypot(solved.tip().y - tip[1]);
        assert!(off < tol * arm.length + 5e-10, "{tol:e}: off by {off:e} m");
        assert!(solved.error_estimate <= tol * arm.length, "{tol:e}: {:e} m", solved.error_estimate);
        let nodes = &solved.stations.s;
        assert!(nodes.iter().any(|s| (s - first).abs() < 1e-5), "{tol:e}: {nodes:?}");
        let shortest = nodes.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        assert!(shortest > 1e-3 * arm.length, "{tol:e}: nodes {shortest:e} m apart");
    }
}

/// Kinks of a slack cable change nothing. The estimate had them as if it pulled: 0.02 mm on an arm that is right to
/// 1e-9 mm.
#[test]
fn the_kinks_of_a_slack_cable_counted_in_the_estimate() {
    let mut arm = Arm::cone(0.2, 0.010, 0.004, 100e3, 0.5);
    arm.cables.push(Cable::new("pull", Profile::linear(0.006, 0.002)).pulled(0.3));
    let slack = Cable::new("slack", Profile::linear(-0.006, 0.002)).reeled_in(-0.02);
    arm.cables.push(slack.with_friction(0.3, Motion::In));
    arm.tip.force = [0.0, -0.02];
    for tol in [1e-6, 1e-8, 1e-10] {
        let solved = solve(&arm, tol);
        assert_eq!(solved.cables[1].tension, 0.0);
        assert!(solved.error_estimate <= tol * arm.length, "{tol:e}: {:e} m", solved.error_estimate);
    }
}
