//! What is said of an answer is the same however it was found, and of the whole arm.

use hydrostat::cases::inextensible_arm;
use hydrostat::{
    Arm, Cable, Configuration, LayerMean, Options, Parameter, PathOptions, Profile, SolveError, Solver, Warning,
};

/// An arm across a stream that its tangential load matters for.
fn dragged() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    arm.flow.speed = 0.1;
    arm
}

fn kinds(shape: &Configuration) -> Vec<&'static str> {
    shape.warnings().iter().map(Warning::kind).collect()
}

fn messages(shape: &Configuration) -> Vec<String> {
    shape.warnings().iter().map(Warning::message).collect()
}

#[test]
fn warm_answers_said_nothing_of_the_tangential_load() -> Result<(), SolveError> {
    let arm = dragged();
    let mut solver = Solver::new(&arm, Options::default())?;
    let whole = solver.solve()?;
    assert_eq!(kinds(&whole), ["tangential_load"]);
    assert_eq!(messages(&solver.configuration()?), messages(&whole));
    solver.set_tensions(&[0.201])?;
    solver.update()?;
    assert_eq!(kinds(&solver.configuration()?), ["tangential_load"]);
    let path = arm.path(Parameter::Tension(0), [0.2, 0.21], &PathOptions::default()).expect("a path");
    for point in &path.branches[0].points {
        assert_eq!(kinds(&point.configuration), ["tangential_load"], "{} N", point.value);
    }
    let all = arm.equilibria(1e-8).expect("they are found");
    assert!(all.found.iter().all(|one| kinds(&one.configuration) == ["tangential_load"]));
    Ok(())
}

#[test]
fn the_tangential_load_was_called_4_ninths_in_every_reading() {
    for (layer_mean, ct) in [(LayerMean::Speed, 4.0 / 9.0), (LayerMean::Momentum, 8.0 / 15.0)] {
        let mut arm = dragged();
        arm.model.layer_mean = layer_mean;
        let warnings = arm.solve().unwrap().warnings();
        let Warning::TangentialLoad { ct: said, tip_shift } = warnings[0] else { panic!("{warnings:?}") };
        assert!((said - ct).abs() < 1e-12 && tip_shift > 0.01, "{warnings:?}");
        assert!(warnings[0].message().contains(&format!("{ct:.3}")), "{}", warnings[0].message());
    }
}

/// A cone that is curved before anything acts, the more the nearer to the tip: R mu_o is largest between the nodes.
#[test]
fn the_fold_margin_was_that_of_the_nodes() {
    let mut arm = inextensible_arm("curved cone");
    arm.radius = Profile::linear(0.1, 0.013);
    arm.reference.mu = Profile::linear(0.0, 5.0);
    let shape = arm.solve().unwrap();
    let radius_times_mu = |s: f64| (0.1 - 0.087 * s) * 5.0 * s;
    let at = 1.0 / 1.74;
    let largest = radius_times_mu(at);
    let nodes = shape.stations.s.iter().map(|s| radius_times_mu(*s)).fold(0.0, f64::max);
    assert!(largest - nodes > 4e-4, "no node is near: {:?}", shape.stations.s);
    let margin = shape.fold_margin();
    assert!((margin.value - (1.0 - largest)).abs() < 2e-4, "{margin:?}, want {}", 1.0 - largest);
    assert!((margin.s - at).abs() < 0.06, "{margin:?}");
}
