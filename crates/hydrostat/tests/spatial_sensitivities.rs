//! Derivatives of equilibria in space against differences of solves.

use hydrostat::{
    Arm, FlowLaw, Options, Parameter, Profile, SensitivityError, SensitivityMethod, SensitivityOptions,
    SpatialConfiguration, SpatialPoseChange, SpatialSolver, Support, Volume,
};
use proptest::prelude::*;

#[path = "common/space.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod common;

use common::{apart, three_cables};

/// A change of a parameter that counts for these arms.
fn scale(parameter: Parameter, arm: &Arm) -> f64 {
    let least = match parameter.unit() {
        "N" => 0.01,
        "m" => 1e-3,
        "N m" => 1e-4,
        "m/s" => 0.1,
        "kg/m3" => 1000.0,
        "m/s2" => 10.0,
        "Pa" => 1e4,
        _ => 1.0,
    };
    parameter.of(arm).unwrap().abs().max(least)
}

/// All numbers that are differentiated: tip, its directors, strokes, tensions, base.
fn numbers(shape: &SpatialConfiguration) -> Vec<f64> {
    let tip = shape.tip();
    let mut out = vec![tip.x, tip.y, tip.z];
    out.extend(tip.a.into_iter().chain(tip.b).chain(tip.c));
    out.extend(shape.cables.iter().map(|cable| cable.stroke));
    out.extend(shape.cables.iter().map(|cable| cable.tension));
    out.extend(shape.base_reaction.force.into_iter().chain(shape.base_reaction.moment));
    out
}

fn moved(arm: &Arm, parameter: Parameter, by: f64) -> Option<Vec<f64>> {
    let value = parameter.of(arm).unwrap();
    let mut arm = arm.clone();
    parameter.set(&mut arm, value + by).unwrap();
    SpatialSolver::new(&arm, Options::with_tol(1e-12)).ok()?.solve().ok().map(|shape| numbers(&shape))
}

/// Differences of the fourth order, and of both the second, which tell how smooth the numbers are.
fn difference(arm: &Arm, parameter: Parameter, step: f64) -> Option<Vec<f64>> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| moved(arm, parameter, k * step));
    let (a, b, c, d) = (a?, b?, c?, d?);
    Some((0..a.len()).map(|k| (a[k] - 8.0 * b[k] + 8.0 * c[k] - d[k]) / (12.0 * step)).collect())
}

fn check(arm: &Arm, bound: f64) {
    let parameters = Parameter::all_of(arm);
    let mut solver = SpatialSolver::new(arm, Options::with_tol(1e-12)).unwrap();
    let shape = solver.solve().unwrap();
    let found = solver.sensitivities(&parameters).unwrap();
    let sizes = numbers(&shape);
    for (k, parameter) in parameters.iter().enumerate() {
        let step = if parameter.unit().is_empty() || parameter.unit() == "rad" { 2e-4 } else { 1e-3 };
        let step = step * scale(*parameter, arm);
        let Some(differences) = difference(arm, *parameter, step) else { continue };
        let (tip, own) = (shape.tip(), found.tip[k]);
        let mut all = own.place.to_vec();
        for director in [tip.a, tip.b, tip.c] {
            all.extend(own.of_director(director));
        }
        all.extend(found.strokes.iter().map(|row| row[k]));
        all.extend(found.tensions.iter().map(|row| row[k]));
        all.extend(found.base[k].force.into_iter().chain(found.base[k].moment));
        for (which, (own, by)) in all.iter().zip(&differences).enumerate() {
            let size = by.abs().max(sizes[which].abs().max(1e-3) / scale(*parameter, arm));
            let off = (own - by).abs() / size;
            assert!(off < bound, "{parameter}, number {which}: {own} for {by}, off by {off:e}");
        }
    }
}

#[test]
fn derivatives_match_differences_of_solves() {
    check(&three_cables(), 1e-6);
}

#[test]
fn derivatives_match_differences_with_quadratic_drag_and_cables_that_turn() {
    let mut arm = three_cables();
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 2.0, ct: 0.02 };
    arm.model.volume = Volume::Circular;
    arm.cables[0].angle = Profile::linear(0.2, 1.5);
    arm.cables[1].end = 0.15;
    check(&arm, 1e-6);
}

#[test]
fn derivatives_match_differences_where_strokes_are_commanded() {
    let mut arm = three_cables();
    arm.cables[0].stroke = Some(0.008);
    arm.cables[0].tension = 0.0;
    arm.cables[1].stroke = Some(0.002);
    arm.cables[1].tension = 0.0;
    arm.cables[1].stiffness = Some(20.0);
    check(&arm, 1e-6);
}

#[test]
fn forward_and_adjoint_are_the_same() {
    let mut arm = three_cables();
    arm.cables[2].stroke = Some(0.004);
    let parameters = Parameter::all_of(&arm);
    let mut solver = SpatialSolver::new(&arm, Options::default()).unwrap();
    let stations = vec![0.0, 0.1, 0.245];
    let mut by = |method| {
        let options = SensitivityOptions { stations: stations.clone(), method };
        solver.sensitivities_with(&parameters, &options).unwrap()
    };
    let (forward, adjoint) = (by(SensitivityMethod::Forward), by(SensitivityMethod::Adjoint));
    let close = |a: f64, b: f64, size: f64| (a - b).abs() < 1e-9 * size.max(a.abs());
    for k in 0..parameters.len() {
        for (a, b) in [(&forward.tip[k], &adjoint.tip[k])]
            .into_iter()
            .chain(forward.stations.iter().zip(&adjoint.stations).map(|(a, b)| (&a.changes[k], &b.changes[k])))
        {
            let size = forward.tip[k].turn.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for axis in 0..3 {
                assert!(close(a.place[axis], b.place[axis], size), "{}: {a:?} {b:?}", parameters[k]);
                assert!(close(a.turn[axis], b.turn[axis], size), "{}: {a:?} {b:?}", parameters[k]);
            }
        }
        // The base stays but for what turns it; the last station is the tip.
        let base = forward.stations[0].changes[k];
        assert!(apart(base.place, [0.0; 3]) < 1e-12, "{}", parameters[k]);
        assert_eq!(forward.stations[2].changes[k], forward.tip[k]);
    }
    // Of the square of the distance of the tip from a place.
    let tip = solver.update().unwrap().tip;
    let weights = SpatialPoseChange { place: [2.0 * tip.x, 2.0 * tip.y, 2.0 * tip.z], turn: [0.0, 0.1, -0.2] };
    let gradient = solver.gradient(&parameters, &[(arm.length, weights)]).unwrap();
    for (k, own) in gradient.iter().enumerate() {
        let change = forward.tip[k];
        let sum: f64 = (0..3).map(|j| weights.place[j] * change.place[j] + weights.turn[j] * change.turn[j]).sum();
        assert!((own - sum).abs() < 1e-6 * sum.abs().max(1e-6), "{}: {own} for {sum}", parameters[k]);
    }
}

#[test]
fn the_ellipsoid_is_that_of_the_jacobian() {
    let arm = three_cables();
    let found = SpatialSolver::new(&arm, Options::default()).unwrap().sensitivities(&Parameter::all_of(&arm)).unwrap();
    let ellipsoid = found.manipulability().unwrap();
    let columns = found.tip_jacobian(&[0, 1, 2].map(Parameter::Tension));
    for (half, axis) in ellipsoid.half_axes.iter().zip(ellipsoid.directions) {
        let along = columns.iter().map(|c| (0..3).map(|k| c[k] * axis[k]).sum::<f64>().powi(2)).sum::<f64>().sqrt();
        assert!((along - half).abs() < 1e-9 * ellipsoid.half_axes[0]);
    }
}

#[test]
fn what_has_no_derivative_says_why() {
    let mut arm = three_cables();
    arm.cables[0].stroke = Some(0.002);
    let mut solver = SpatialSolver::new(&arm, Options::default()).unwrap();
    let error = |e: Result<_, SensitivityError<_>>| e.map(|_: hydrostat::Sensitivities<_, _>| ()).unwrap_err();
    let found = error(solver.sensitivities(&[Parameter::Tension(0)]));
    assert!(matches!(found, SensitivityError::Commanded(0)), "{found}");
    let found = error(solver.sensitivities(&[Parameter::BaseAngle]));
    assert!(found.to_string().contains("`arm.base.direction[0]` to"), "{found}");
    arm.cables[0].stroke = None;
    arm.model.support = Support::UnstrainedBase;
    let found = error(SpatialSolver::new(&arm, Options::default()).unwrap().sensitivities(&[Parameter::Tension(0)]));
    assert!(matches!(found, SensitivityError::Support), "{found}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn derivatives_of_random_arms_match_differences(
        tensions in prop::array::uniform3(0.0..0.15_f64),
        angles in prop::array::uniform3(-0.5..0.5_f64),
        stream in prop::array::uniform3(-1.0..1.0_f64),
        speed in 0.02..0.12_f64,
        drag in any::<bool>(),
        circular in any::<bool>(),
    ) {
        let mut arm = three_cables();
        for (k, cable) in arm.cables.iter_mut().enumerate() {
            cable.tension = tensions[k];
            cable.angle = Profile::linear(2.0 * k as f64, 2.0 * k as f64 + angles[k]);
        }
        arm.flow.speed = speed;
        arm.space.as_mut().unwrap().stream = Some(stream);
        prop_assume!(stream.iter().map(|v| v * v).sum::<f64>() > 0.1);
        if drag {
            arm.flow.law = FlowLaw::QuadraticDrag { cn: 1.5, ct: 0.02 };
        }
        if circular {
            arm.model.volume = Volume::Circular;
        }
        prop_assume!(SpatialSolver::new(&arm, Options::with_tol(1e-10)).unwrap().solve().is_ok());
        check(&arm, 1e-5);
    }
}
