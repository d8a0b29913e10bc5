//! Warm starts: what they give, on which branch, and what is read of them.

use hydrostat::{
    Arm, Cable, Gravity, Options, Parameter, Pose as _, Profile, Rows, SnapBounds, Solver, Space, SpatialSolver,
    Wanted, WarmStart,
};

/// A cone with a cable, in a stream from ahead that it gives way to by a snap.
fn arm(tension: f64) -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(tension));
    arm
}

/// A column under a load on its tip, over that which buckles it, with a small force across.
fn column(across: f64) -> Arm {
    let mut arm = Arm::cone(0.2, 0.010, 0.010, 110e3, 0.5);
    let stiffness = 110e3 * std::f64::consts::FRAC_PI_4 * 0.010_f64.powi(4);
    let euler = stiffness * (0.5 * std::f64::consts::PI / 0.2).powi(2);
    arm.tip.force = [-1.1 * euler, across]; // N
    arm
}

fn on_ramp() -> Options {
    Options { warm_start: WarmStart::Ramp, ..Options::default() }
}

/// After a push to the other side, the arm stays on the side that it leans to; its own load ramp ends on the other.
#[test]
fn a_branch_is_followed_past_the_place_where_the_ramp_ends_elsewhere() {
    let mut sides = [Vec::new(), Vec::new()];
    for (side, options) in sides.iter_mut().zip([Options::default(), on_ramp()]) {
        let mut solver = Solver::new(&column(2e-3), options).unwrap();
        for across in [2e-3, 1e-3, 5e-4, -1e-4, -2e-4] {
            solver.set_arm(&column(across)).unwrap();
            side.push(solver.update().unwrap().tip.y);
        }
    }
    let [branch, ramp] = sides;
    assert!(branch.iter().all(|y| *y > 0.01), "{branch:?}");
    assert!(ramp[..3].iter().all(|y| *y > 0.01) && ramp[3..].iter().all(|y| *y < -0.01), "{ramp:?}");
    for (y, across) in ramp.iter().zip([2e-3, 1e-3, 5e-4, -1e-4, -2e-4]) {
        let cold = column(across).solve().unwrap().tip().y;
        assert!((y - cold).abs() < 4e-9, "{across} N: {y}, from the unloaded arm {cold}");
    }
}

/// A configuration after a solve was solved once more, and had lost its snaps.
#[test]
fn a_configuration_is_what_the_solve_before_gave() {
    let mut snapping = arm(0.3);
    (snapping.flow.speed, snapping.flow.direction) = (0.5, 172_f64.to_radians());
    let everywhere = SnapBounds { distance: f64::INFINITY, angle: f64::INFINITY };
    let options = Options { snaps: everywhere, ..Options::default() };
    let mut with_snaps = 0;
    for arm in [arm(0.3), snapping, column(1e-4)] {
        let mut solver = Solver::new(&arm, options).unwrap();
        let Ok(solved) = solver.solve() else { continue };
        with_snaps += usize::from(!solved.snaps.is_empty());
        let again = solver.configuration().unwrap();
        assert_eq!(again.tip(), solved.tip());
        assert_eq!((again.stable, again.error_estimate), (solved.stable, solved.error_estimate));
        assert_eq!((again.statistics, &again.snaps), (solved.statistics, &solved.snaps));
        let answer = solver.update().unwrap();
        assert!(answer.tip.distance_to(&solved.tip()) < 1e-15 && answer.statistics == solved.statistics);
    }
    assert!(with_snaps > 0, "no arm snapped");
    let mut in_space = arm(0.3);
    in_space.space = Some(Space::default());
    let mut solver = SpatialSolver::new(&in_space, Options::default()).unwrap();
    let solved = solver.solve().unwrap();
    let again = solver.configuration().unwrap();
    assert_eq!((again.tip(), again.statistics), (solved.tip(), solved.statistics));
    assert!(solver.update().unwrap().tip.distance_to(&solved.tip()) < 1e-15);
}

/// A warm start costs rounds of the mesh that there is, in space as in the plane, whatever load changes.
#[test]
fn a_stream_that_changes_is_followed_in_space() {
    let mut arm = arm(0.2);
    arm.space = Some(Space::default());
    arm.flow.speed = 0.1;
    let mut solver = SpatialSolver::new(&arm, Options::default()).unwrap();
    let cold = solver.update().unwrap();
    arm.flow.speed = 0.101;
    solver.set_arm(&arm).unwrap();
    let warm = solver.update().unwrap();
    assert!(warm.statistics.newton_rounds < cold.statistics.newton_rounds);
    let off = warm.tip.distance_to(&SpatialSolver::new(&arm, Options::default()).unwrap().solve().unwrap().tip());
    assert!(off < 2e-8 * arm.length, "{off}");
    // Another geometry starts anew.
    arm.length *= 1.1;
    solver.set_arm(&arm).unwrap();
    let longer = solver.update().unwrap().tip;
    let cold = SpatialSolver::new(&arm, Options::default()).unwrap().solve().unwrap().tip();
    assert_eq!(longer, cold);
}

/// A row has the same numbers whether they are at hand or read out of the whole configuration.
#[test]
fn rows_at_hand_are_rows_of_configurations() {
    let wanted = Wanted { strokes: true, ..Wanted::default() };
    let whole = Wanted { strokes: true, fold_margin: true, ..Wanted::default() };
    let mut short = Rows::<Solver>::new(Options::with_tol(1e-8), wanted).unwrap();
    let mut long = Rows::<Solver>::new(Options::with_tol(1e-8), whole).unwrap();
    for step in 0..8 {
        let arm = arm(0.05 * f64::from(step));
        let (a, b) = (short.next(&arm).unwrap(), long.next(&arm).unwrap());
        let off = (a.tip.x - b.tip.x).hypot(a.tip.y - b.tip.y);
        assert!(off < 1e-14 && (a.strokes[0] - b.strokes[0]).abs() < 1e-10, "{off} {:?} {:?}", a.strokes, b.strokes);
        assert_eq!((a.error_estimate, a.tensions, a.fold_margin), (b.error_estimate, b.tensions, None));
    }
    // An arm without answer leaves nothing behind.
    assert!(short.next(&arm(1.9)).is_err() && short.next(&arm(-1.0)).is_err());
    assert_eq!(short.next(&arm(0.1)).unwrap().tip, arm(0.1).solve().unwrap().tip());
}

/// A row whose warm start failed was solved from the unloaded arm on the meshes that the row before had left.
#[test]
fn a_row_far_from_the_one_before_is_that_of_a_solve() {
    for in_space in [false, true] {
        let far = |tension: f64| {
            let mut arm = arm(tension);
            arm.space = in_space.then(Space::default);
            arm.flow.speed = 0.1;
            arm
        };
        let wanted = Wanted::default();
        if in_space {
            let mut rows = Rows::<SpatialSolver>::new(Options::default(), wanted).unwrap();
            rows.next(&far(0.05)).unwrap();
            let cold = SpatialSolver::new(&far(0.7), Options::default()).unwrap().solve().unwrap();
            assert_eq!(rows.next(&far(0.7)).unwrap().tip, cold.tip());
        } else {
            let mut rows = Rows::<Solver>::new(Options::default(), wanted).unwrap();
            rows.next(&far(0.05)).unwrap();
            rows.next(&far(0.06)).unwrap();
            assert_eq!(rows.next(&far(0.7)).unwrap().tip, far(0.7).solve().unwrap().tip());
        }
    }
}

/// Changes one load, the base or the material by the fraction `by`.
fn changed(arm: &mut Arm, what: usize, by: f64) {
    match what {
        0 => arm.flow.speed *= 1.0 + by,
        1 => arm.flow.direction += by,
        2 => arm.gravity.as_mut().unwrap().direction += by,
        3 => arm.flow.density *= 1.0 + by,
        4 => arm.base.angle += by,
        5 => arm.density *= 1.0 + by,
        6 => Parameter::Young.set(arm, 110e3 * (1.0 + by)).unwrap(),
        7 => arm.tip.force[1] += 5e-3 * by,
        _ => arm.cables[1].tension += 0.5 * by,
    }
}

/// Whatever of loads, base and material changes, an update gives what a solve from the unloaded arm does.
#[test]
fn updates_are_solves_whatever_changes() {
    let options = Options::default();
    let mut warm = [0, 0];
    for by in [0.01, 0.05, 0.2] {
        let mut flat = arm(0.05);
        flat.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.02));
        (flat.density, flat.flow.speed) = (1200.0, 0.06);
        flat.gravity = Some(Gravity { acceleration: 9.81, direction: 0.4 });
        let mut solid = flat.clone();
        solid.space = Some(Space::default());
        solid.cables[1].angle = 2.0.into();
        let (mut plane, mut space) =
            (Solver::new(&flat, options).unwrap(), SpatialSolver::new(&solid, options).unwrap());
        let rounds = [plane.update().unwrap().statistics, space.update().unwrap().statistics].map(|s| s.newton_rounds);
        for what in 0..9 {
            changed(&mut flat, what, by);
            changed(&mut solid, what, by);
            plane.set_arm(&flat).unwrap();
            space.set_arm(&solid).unwrap();
            let (one, other) = (plane.update().unwrap(), space.update().unwrap());
            let off = [
                one.tip.distance_to(&flat.solve().unwrap().tip()),
                other.tip.distance_to(&SpatialSolver::new(&solid, options).unwrap().solve().unwrap().tip()),
            ];
            assert!(off.iter().all(|off| *off < 2e-8 * flat.length), "change {what} by {by}: {off:?}");
            warm[0] += usize::from(one.statistics.newton_rounds < rounds[0]);
            warm[1] += usize::from(other.statistics.newton_rounds < rounds[1]);
        }
    }
    assert!(warm.iter().all(|warm| *warm >= 9), "{warm:?} of 27 are warm");
}

/// Tensions that were set in space left strokes commanded, and were not what was solved for.
#[test]
fn tensions_in_space_replace_strokes() {
    let mut arm = arm(0.0);
    arm.space = Some(Space::default());
    arm.cables[0].stroke = Some(0.003);
    let mut solver = SpatialSolver::new(&arm, Options::default()).unwrap();
    assert!(solver.solve().unwrap().cables[0].command.is_some());
    solver.set_tensions(&[0.05]).unwrap();
    let found = solver.configuration().unwrap();
    assert!(found.cables[0].command.is_none() && found.cables[0].tension == 0.05);
}
