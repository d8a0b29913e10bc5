//! Inverse kinetics: round trips, targets out of reach, redundancy, and paths of targets.

use hydrostat::{Arm, Bound, Cable, Follower, Options, Profile, ReachError, ReachOptions, Solver, Target};

fn cone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

fn options(most: f64) -> ReachOptions {
    ReachOptions { max_tension: Some(most), ..ReachOptions::default() }
}

fn target_of(arm: &Arm, tensions: &[f64]) -> Option<Target> {
    let mut arm = arm.clone();
    arm.set_tensions(tensions).unwrap();
    arm.solve().ok().map(|shape| Target::tip(shape.tip().x, shape.tip().y))
}

/// Tensions to a tip, and from there to tensions that lead to the same tip, as a solve of its own says.
fn round_trips(arm: &Arm, most: f64, per_cable: usize) -> (usize, usize) {
    let n = arm.cables.len().min(2);
    let (mut all, mut met) = (0, 0);
    for k in 0..per_cable.pow(u32::try_from(n).unwrap()) {
        let share =
            |c: usize| (k / per_cable.pow(u32::try_from(c).unwrap()) % per_cable) as f64 / (per_cable - 1) as f64;
        let tensions: Vec<f64> = (0..arm.cables.len()).map(|c| if c < n { most * share(c) } else { 0.0 }).collect();
        let Some(target) = target_of(arm, &tensions) else { continue };
        all += 1;
        let found =
            arm.reach(&[target], &ReachOptions { max_tension: Some(most), all: false, ..ReachOptions::default() });
        let back = found.ok().and_then(|found| found.solutions.into_iter().next());
        let good = back.is_some_and(|back| {
            let tip = back.configuration.tip();
            (tip.x - target.x).hypot(tip.y - target.y) < 1.1e-8 * arm.length
        });
        if !good {
            println!("{}: {tensions:?} to {target:?} not met", arm.name);
        }
        met += usize::from(good);
    }
    (met, all)
}

#[test]
fn tips_are_reached_again() {
    let mut flowing = cone();
    flowing.flow.speed = 0.1;
    flowing.flow.direction = 1.0;
    for arm in [cone(), flowing] {
        let (met, all) = round_trips(&arm, 0.5, 5);
        println!("{met} of {all}");
        assert!(all >= 24 && met == all, "{met} of {all}");
    }
}
