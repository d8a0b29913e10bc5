//! Motions that go on from the state of another one, what happens on the way, and the equilibria beside them.

#[allow(dead_code, reason = "other tests need more of it")]
#[path = "common/motion.rs"]
mod moving;

use hydrostat::{
    Arm, Cable, Course, Inputs, MotionError, MotionEventKind, MotionOptions, MotionWarning, Profile, Simulation,
};
use moving::inputs;

/// The silicone arm with a cable on either side, in a stream.
fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.flow.speed = 0.1;
    arm.dynamics.relaxation_time = 2.7e-3;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

fn pull() -> Inputs {
    inputs(&[moving::pull()])
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[test]
fn a_motion_goes_on_from_its_state_as_if_it_had_not_stopped() {
    let arm = silicone();
    let cases = [pull(), inputs(&[("cable[0].stroke", Course::ramp(0.0, 0.011, 0.0, 0.3))])];
    for (loads, stop) in cases.into_iter().flat_map(|loads| [0.13, 0.4, 0.45].map(|stop| (loads.clone(), stop))) {
        let mut whole = Simulation::new(&arm, loads.clone(), MotionOptions::default()).unwrap();
        let at_stop = whole.advance_to(stop).unwrap();
        let state = whole.state();
        let end = whole.advance_to(0.8).unwrap();
        let mut second = Simulation::resume(&arm, loads, MotionOptions::default(), &state).unwrap();
        let again = second.now();
        assert!(apart(again.tip, at_stop.tip) < 1e-12 && again.time == stop, "{again:?} {at_stop:?}");
        assert!((again.works.cables - at_stop.works.cables).abs() < 1e-12, "{again:?} {at_stop:?}");
        let goes_on = second.advance_to(0.8).unwrap();
        assert!(apart(goes_on.tip, end.tip) < 1e-4 * arm.length, "stop {stop}: {:.1e}", apart(goes_on.tip, end.tip));
        let off = goes_on.works.sum() - end.works.sum();
        assert!(off.abs() < 1e-3 * end.works.cables.abs(), "{off:.1e} {:?}", end.works);
    }
}

#[test]
fn a_motion_goes_on_under_other_loads() {
    let arm = silicone();
    let mut first = Simulation::new(&arm, pull(), MotionOptions::default()).unwrap();
    first.advance_to(0.3).unwrap();
    let state = first.state().under_other_loads();
    // Held for the first motion, let go for the second.
    let mut second = Simulation::resume(&arm, Inputs::default(), MotionOptions::default(), &state).unwrap();
    first.advance_to(0.4).unwrap();
    let mut want = Simulation::new(
        &arm,
        inputs(&[("cable[0].tension", Course::Table(vec![(0.0, 0.0), (0.2, 0.2), (0.3, 0.2), (0.3, 0.0)]))]),
        MotionOptions::default(),
    )
    .unwrap();
    let [a, b] = [&mut second, &mut want].map(|simulation| simulation.advance_to(0.7).unwrap());
    assert!(apart(a.tip, b.tip) < 2e-4 * arm.length, "{:.1e}", apart(a.tip, b.tip) / arm.length);
}

#[test]
fn states_of_other_arms_and_broken_states_are_refused() {
    let arm = silicone();
    let simulation = Simulation::new(&arm, Inputs::default(), MotionOptions::default()).unwrap();
    let state = simulation.state();
    let refused = |arm: &Arm, state| {
        let error = Simulation::resume(arm, Inputs::default(), MotionOptions::default(), &state).unwrap_err();
        assert!(matches!(error, MotionError::State { .. }), "{error}");
        error.to_string()
    };
    let longer = Arm { length: 0.3, ..arm.clone() };
    assert!(refused(&longer, state.clone()).contains("0.3 m"));
    let mut moved = arm.clone();
    moved.base.angle = 0.1;
    assert!(refused(&moved, state.clone()).contains("cannot jump"));
    let mut short = state.clone();
    short.values.pop();
    assert!(refused(&arm, short).contains("`values`"));
    let mut falling = state.clone();
    falling.nodes.reverse();
    assert!(refused(&arm, falling).contains("mesh"));
    let mut wild = state;
    wild.rates[0] = f64::NAN;
    assert!(refused(&arm, wild).contains("finite"));
}

#[test]
fn a_cable_that_is_paid_out_fast_goes_slack_and_becomes_taut_again_at_known_times() {
    let mut arm = silicone();
    arm.flow.speed = 0.0;
    // Reeled in slowly, then paid out faster than the arm follows.
    let stroke = Course::Table(vec![(0.0, 0.0), (0.5, 0.012), (0.52, 0.002)]);
    let run = |every: f64| {
        let mut simulation =
            Simulation::new(&arm, inputs(&[("cable[0].stroke", stroke.clone())]), MotionOptions::default()).unwrap();
        let mut rows = Vec::new();
        simulation
            .run(1.5, every, |at, _| {
                rows.push((at.time, at.cables[0].tension));
                true
            })
            .unwrap();
        (simulation.events().to_vec(), rows)
    };
    let (events, rows) = run(2e-3);
    assert!(events.len() >= 2, "{events:?}");
    assert_eq!(
        events.iter().map(|event| event.kind).find(|kind| *kind != MotionEventKind::Taut(0)),
        Some(MotionEventKind::Slack(0))
    );
    for pair in events.windows(2) {
        assert!(pair[0].time <= pair[1].time && pair[0].kind != pair[1].kind, "{events:?}");
    }
    // Rows between two events are all slack, or all taut.
    for (time, tension) in rows {
        let last = events.iter().take_while(|event| event.time <= time).last();
        let near = events.iter().any(|event| (event.time - time).abs() < 1e-3);
        if let (Some(last), false) = (last, near) {
            assert_eq!(tension == 0.0, last.kind == MotionEventKind::Slack(0), "{time} {tension} {events:?}");
        }
    }
    // When is no matter of the rows.
    let (others, _) = run(0.5);
    assert_eq!(events, others);
}

/// They were the ends of the steps that saw them: 0.2307 and 0.3518 s here.
#[test]
fn times_at_which_a_cable_becomes_slack_or_taut_were_late() {
    let mut arm = silicone();
    arm.flow.speed = 0.0;
    let stroke = Course::Sine { mean: 0.006, amplitude: 0.006, frequency: 2.5, phase: 0.0 };
    let events = |options: MotionOptions| {
        let loads = inputs(&[("cable[0].stroke", stroke.clone())]);
        let mut simulation = Simulation::new(&arm, loads, MotionOptions { elements: Some(12), ..options }).unwrap();
        simulation.advance_to(0.4).unwrap();
        simulation.events().to_vec()
    };
    // Equal steps, which no event shortens.
    let fine = events(MotionOptions { step: Some(5e-4), ..MotionOptions::default() });
    let kinds = [MotionEventKind::Slack(0), MotionEventKind::Taut(0)];
    for (tol, late) in [(1e-3, 1e-4), (1e-4, 6e-4), (1e-5, 1e-4)] {
        let found = events(MotionOptions { tol, ..MotionOptions::default() });
        assert!(found.len() == 2 && fine.len() == 2, "{tol}: {found:?} {fine:?}");
        for ((found, fine), kind) in found.iter().zip(&fine).zip(kinds) {
            assert!(found.kind == kind && fine.kind == kind, "{tol}: {found:?} {fine:?}");
            let off = found.time - fine.time;
            // At 1e-4 the taut one is 5e-4 s late: an error of 25 um, at the 5 cm/s at which the slack closes.
            assert!(off.abs() < late, "{tol}: {off:.1e} s, {found:?} {fine:?}");
        }
    }
}

#[test]
fn a_surface_that_folds_is_an_event_before_the_cable_folds_the_arm() {
    let arm = silicone();
    let loads = inputs(&[("cable[0].tension", Course::ramp(0.0, 3.0, 0.0, 1.0))]);
    let mut simulation = Simulation::new(&arm, loads, MotionOptions { tol: 1e-3, ..MotionOptions::default() }).unwrap();
    let MotionError::Ended(verdict) = simulation.advance_to(1.0).unwrap_err() else { panic!("it folds") };
    let [event] = simulation.events() else { panic!("{:?}", simulation.events()) };
    let MotionEventKind::SurfaceFolds(s) = event.kind else { panic!("{event:?}") };
    assert!(event.time < verdict.time && s > 0.2, "{event:?} {verdict:?}");
}

#[test]
fn stations_are_on_the_arm_and_move_with_it() {
    let arm = silicone();
    let mut simulation = Simulation::new(&arm, pull(), MotionOptions::default()).unwrap();
    let at = simulation.advance_to(0.45).unwrap();
    let tip = simulation.station(arm.length);
    assert!(apart([tip.x, tip.y], at.tip) < 1e-12 && apart(tip.velocity, at.tip_velocity) < 1e-10, "{tip:?} {at:?}");
    let base = simulation.station(0.0);
    assert!(apart([base.x, base.y], [0.0; 2]) < 1e-12 && base.omega.abs() < 1e-9, "{base:?}");
    // Nodes of the mesh, and differences along the arm: r' = nu a + eta b, theta' = mu.
    for [s, x, y, theta] in simulation.shape() {
        let own = simulation.station(s);
        assert!(apart([own.x, own.y], [x, y]) < 1e-12 && (own.theta - theta).abs() < 1e-12, "{own:?}");
    }
    for k in 1..20 {
        let s = arm.length * f64::from(k) / 20.3;
        let [low, here, high] = [-1e-5, 0.0, 1e-5].map(|d| simulation.station(s + d));
        let (sin, cos) = here.theta.sin_cos();
        let slope = [(high.x - low.x) / 2e-5, (high.y - low.y) / 2e-5];
        assert!((slope[0] - (here.nu * cos - here.eta * sin)).abs() < 2e-4, "{here:?} {slope:?}");
        assert!((slope[1] - (here.nu * sin + here.eta * cos)).abs() < 2e-4, "{here:?} {slope:?}");
        assert!(((high.theta - low.theta) / 2e-5 - here.mu).abs() < 2e-2 * here.mu.abs().max(1.0), "{here:?}");
    }
    // Velocities are differences in time.
    let mut later = simulation.clone();
    later.step(1e-5).unwrap();
    let (a, b) = (simulation.station(0.2), later.station(0.2));
    assert!(((b.x - a.x) / 1e-5 - a.velocity[0]).abs() < 1e-2, "{a:?} {b:?}");
}

#[test]
fn equilibria_beside_a_slow_motion_are_near_and_beside_a_fast_one_are_not() {
    let arm = silicone();
    let off = |time: f64| {
        let loads = inputs(&[("cable[0].tension", Course::ramp(0.0, 0.2, 0.0, time))]);
        let mut simulation = Simulation::new(&arm, loads, MotionOptions::default()).unwrap();
        let mut equilibria = simulation.quasi_static().unwrap();
        let at = simulation.advance_to(0.5 * time).unwrap();
        let tip = equilibria.tip(0.5 * time).unwrap();
        let mut half = arm.clone();
        half.cables[0].tension = 0.1;
        let still = half.solve().unwrap().tip();
        assert!(apart([tip.x, tip.y], [still.x, still.y]) < 1e-5 * arm.length);
        apart(at.tip, [tip.x, tip.y]) / arm.length
    };
    let [fast, slow] = [0.2, 20.0].map(off);
    assert!(fast > 0.05 && slow < 0.01, "{fast:.1e} {slow:.1e}");
}

/// The estimate of a motion after a jump without relaxation time was less than a fifth of the error, and nothing said
/// so.
#[test]
fn a_jump_that_is_not_resolved_was_not_told() {
    let mut arm = silicone();
    let mut simulation = Simulation::new(&arm, pull(), MotionOptions::default()).unwrap();
    simulation.advance_to(0.45).unwrap();
    assert_eq!(simulation.warnings(), []);
    arm.dynamics.relaxation_time = 0.0;
    let mut simulation = Simulation::new(&arm, pull(), MotionOptions::default()).unwrap();
    simulation.advance_to(0.3).unwrap();
    assert_eq!(simulation.warnings(), []);
    simulation.advance_to(0.45).unwrap();
    let [MotionWarning::UnresolvedJump { time }] = simulation.warnings()[..] else {
        panic!("{:?}", simulation.warnings())
    };
    assert_eq!(time, 0.4);
}
