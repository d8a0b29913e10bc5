//! Arms in space: known parameters come back, derivatives of markers beside the centreline are those of solves, intervals
//! cover, and an arm in a plane of space has the fit of the arm in the plane.

use hydrostat::parameter::Curvature;
use hydrostat::{
    Arm, BaseDirections, Cable, Gravity, Options, Parameter, Point, Profile, Solver, Space, SpatialSolver,
};
use hydrostat_identify::{
    Case, Fit, FitOptions, Fitted, Marker, Measurement, Quantity, Shape, Unknown, fit, misses, predict, value_in_space,
    value_of,
};

mod common;
use common::{Random, noisy};

/// An arm that hangs in air from a tilted base, bent and twisted by itself, with two tendons that end before its tip.
fn hanging() -> Arm {
    let mut arm = Arm::cone(0.36, 0.015, 0.005, 330e3, 0.45);
    arm.density = 1400.0;
    arm.flow.density = 0.0;
    for angle in [30.0_f64, 150.0] {
        let mut cable = Cable::new("tendon", Profile::linear(0.0114, 0.002)).at_angle(angle.to_radians());
        cable.end = 0.85;
        arm.cables.push(cable);
    }
    arm.gravity = Some(Gravity::default());
    arm.reference.mu = 0.4.into();
    arm.space = Some(Space {
        base: Some(BaseDirections { direction: [0.05, -0.02, -1.0], section: Some([0.0, 1.0, 0.0]) }),
        gravity: Some([0.0, 0.0, -1.0]),
        kappa: (-0.6).into(),
        ..Space::default()
    });
    arm
}

fn loads() -> Vec<(String, Arm)> {
    let pulled = |name: &str, tensions: [f64; 2]| {
        let mut arm = hanging();
        arm.set_tensions(&tensions).unwrap();
        (name.to_owned(), arm)
    };
    vec![pulled("left", [3.0, 0.0]), pulled("right", [0.0, 2.0]), pulled("both", [2.5, 1.5])]
}

/// Markers beside the centreline, as those of `tentacle`.
fn markers() -> Vec<Quantity> {
    let places =
        [(0.129, [0.0, 0.0, 0.025]), (0.22, [0.0, 0.002, -0.021]), (0.28, [0.0, 0.0, 0.0]), (0.36, [0.008, 0.0, 0.0])];
    let all = places.into_iter().map(|(s, offset)| Marker { s, offset });
    all.flat_map(|marker| (0..3).map(move |axis| Quantity::of_marker(marker, axis))).collect()
}

/// What arms have of the quantities, with the standard deviation `sd`, under tensions that are `factor` of those stated.
fn exact(arms: &[(String, Arm)], quantities: &[Quantity], sd: f64, factor: f64) -> Vec<Case> {
    let one = |(name, arm): &(String, Arm)| {
        let mut pulled = arm.clone();
        Unknown::TensionFactor.set(&mut pulled, factor).unwrap();
        let shape = SpatialSolver::new(&pulled, Options::with_tol(1e-11)).unwrap().solve().unwrap();
        let measured = quantities.iter().map(|own| Measurement::new(*own, value_in_space(&shape, *own), sd));
        Case { name: name.clone(), arm: arm.clone(), measurements: measured.collect() }
    };
    arms.iter().map(one).collect()
}

fn options() -> FitOptions {
    FitOptions { tol: 1e-10, cross_validate: false, ..FitOptions::default() }
}

fn fitted(cases: &[Case], wanted: &[(Unknown, f64)]) -> Fit {
    let wanted: Vec<Fitted> = wanted
        .iter()
        .map(|(unknown, start)| Fitted { start: *start, ..Fitted::new(*unknown, &cases[0].arm).unwrap() })
        .collect();
    fit(cases, &wanted, &options(), |_| true).unwrap()
}

fn curved(own: Curvature) -> Unknown {
    Parameter::Reference(own, Point::Whole).into()
}

#[test]
fn known_parameters_come_back_without_noise() {
    let cases = exact(&loads(), &markers(), 1e-3, 0.8);
    let found = fitted(
        &cases,
        &[
            (Unknown::TensionFactor, 1.0),
            (Parameter::Density.into(), 1000.0),
            (curved(Curvature::Kappa), 0.0),
            (curved(Curvature::Mu), 0.0),
            (Parameter::BaseAlong(0).into(), 0.0),
        ],
    );
    assert!(found.converged);
    for (one, want) in found.estimates.iter().zip([0.8, 1400.0, -0.6, 0.4, 0.05]) {
        assert!((one.value / want - 1.0).abs() < 1e-6, "{}: {} for {want}", one.fitted.parameter, one.value);
        assert!(one.interval.is_some_and(|[low, high]| low < want && want < high));
    }
    assert!(misses(&found.residuals).iter().all(|miss| miss.rms < 1e-7 && miss.count == 3));

    let arm = found.applied_to(&cases[2].arm);
    assert!((arm.cables[0].tension - 2.0).abs() < 1e-6 && (arm.density - 1400.0).abs() < 1e-2);
    let mut other = cases[0].clone();
    other.arm.set_tensions(&[1.0, 1.0]).unwrap();
    let others = exact(&[("other".to_owned(), other.arm)], &markers(), 1e-3, 0.8);
    let predicted = predict(&found, &others, &options()).unwrap();
    let (residuals, shape) = predicted[0].found.as_ref().unwrap();
    assert!(matches!(shape, Shape::Space(_)) && residuals.len() == 12);
    assert!(residuals.iter().all(|one| (one.fitted - one.measurement.value).abs() < 1e-7));
}

/// Young's modulus and density in air, and the tensions, are known by their ratios alone: which the verdict says.
#[test]
fn stiffness_and_the_factor_on_tensions_go_together() {
    let cases = exact(&loads(), &markers(), 1e-3, 0.9);
    let found = fitted(
        &cases,
        &[(Parameter::Young.into(), 300e3), (Unknown::TensionFactor, 1.0), (Parameter::Density.into(), 1300.0)],
    );
    let verdict = found.verdict().join("; ");
    assert!(verdict.contains("do not separate") && verdict.contains("tension_factor"), "{verdict}");
}

/// d value / d unknown by central differences of solves.
fn difference(case: &Case, quantity: Quantity, unknown: Unknown, at: f64, step: f64) -> f64 {
    let value = |to: f64| {
        let mut arm = case.arm.clone();
        unknown.set(&mut arm, to).unwrap();
        if arm.space.is_some() {
            value_in_space(&SpatialSolver::new(&arm, Options::with_tol(1e-12)).unwrap().solve().unwrap(), quantity)
        } else {
            value_of(&Solver::new(&arm, Options::with_tol(1e-12)).unwrap().solve().unwrap(), quantity)
        }
    };
    let central = |step: f64| (value(at + step) - value(at - step)) / (2.0 * step);
    let (coarse, fine) = (central(step), central(0.5 * step));
    fine + (fine - coarse) / 3.0
}

/// One number a fit: the singular value is the derivative in the parameter's scale.
fn derivative(case: &Case, quantity: Quantity, unknown: Unknown) -> f64 {
    let value = match case.arm.space {
        Some(_) => {
            value_in_space(&SpatialSolver::new(&case.arm, Options::default()).unwrap().solve().unwrap(), quantity)
        }
        None => value_of(&case.arm.solve().unwrap(), quantity),
    };
    let one = Case { measurements: vec![Measurement::new(quantity, value, 1.0)], ..case.clone() };
    let found = fit(&[one], &[Fitted::new(unknown, &case.arm).unwrap()], &options(), |_| true).unwrap();
    found.directions[0].singular_value / found.estimates[0].scale.size
}

#[test]
fn markers_beside_the_centreline_have_the_derivatives_of_solves() {
    let (name, arm) = loads().swap_remove(2);
    let case = Case { name, arm, measurements: Vec::new() };
    let marker = Marker { s: 0.2, offset: [0.004, 0.015, -0.021] };
    let unknowns: [(Unknown, f64, f64); 6] = [
        (Parameter::Young.into(), 330e3, 1e3),
        (Unknown::TensionFactor, 1.0, 3e-3),
        (Unknown::CableFactor(1), 1.0, 3e-3),
        (Parameter::Density.into(), 1400.0, 5.0),
        (curved(Curvature::Kappa), -0.6, 5e-3),
        (curved(Curvature::Mu), 0.4, 5e-3),
    ];
    for (unknown, at, step) in unknowns {
        for quantity in (0..3)
            .map(|axis| Quantity::of_marker(marker, axis))
            .chain([Quantity::BaseMomentAbout(1), Quantity::Stroke(0)])
        {
            let want = difference(&case, quantity, unknown, at, step).abs();
            let found = derivative(&case, quantity, unknown);
            let noise = 2e-10 / step;
            assert!((found - want).abs() < 1e-6 * want + noise, "{quantity} by {unknown}: {found:e} for {want:e}");
        }
    }
}

#[test]
fn in_the_plane_too() {
    let mut arm = common::silicone();
    arm.cables[0].tension = 0.2;
    arm.reference.mu = 1.5.into();
    (arm.flow.speed, arm.flow.direction) = (0.1, 1.0);
    let case = Case { name: "a".to_owned(), arm, measurements: Vec::new() };
    let marker = Marker { s: 0.17, offset: [0.003, -0.012, 0.0] };
    let unknowns: [(Unknown, f64, f64); 3] = [
        (Parameter::Young.into(), 110e3, 300.0),
        (Unknown::TensionFactor, 1.0, 3e-3),
        (curved(Curvature::Mu), 1.5, 5e-3),
    ];
    for (unknown, at, step) in unknowns {
        for quantity in [Quantity::Off(marker, 0), Quantity::Off(marker, 1), Quantity::Stroke(0)] {
            let want = difference(&case, quantity, unknown, at, step).abs();
            let found = derivative(&case, quantity, unknown);
            assert!(
                (found - want).abs() < 1e-6 * want + 2e-10 / step,
                "{quantity} by {unknown}: {found:e} for {want:e}"
            );
        }
    }
}

/// Standardised errors of the estimates over data sets with noise: their mean square is one, and 95 % are within 1.96.
#[test]
fn intervals_cover() {
    let truth = exact(&loads(), &markers(), 2e-3, 0.8);
    let wanted = [(Unknown::TensionFactor, 0.8), (Parameter::Density.into(), 1400.0), (curved(Curvature::Kappa), -0.6)];
    let mut random = Random::new(7);
    let (mut inside, mut square, mut count) = (0, 0.0, 0);
    for _ in 0..40 {
        let found = fitted(&noisy(&truth, &mut random), &wanted);
        for (one, (_, want)) in found.estimates.iter().zip(wanted) {
            let off = (one.value - want) / one.sd.unwrap();
            inside += usize::from(off.abs() < 1.96);
            square += off * off;
            count += 1;
        }
    }
    assert!(inside * 100 >= 88 * count, "{inside} of {count}");
    assert!((0.7..1.4).contains(&(square / count as f64)), "{}", square / count as f64);
}

/// The silicone arm, and the same in space: to the size of the solves' errors one fit.
#[test]
fn an_arm_in_a_plane_of_space_has_the_planar_fit() {
    let arms = common::loads();
    let quantities = common::markers(3);
    let mut random = Random::new(3);
    let plane = noisy(&common::exact(&arms[..2], &quantities, |_| 1e-3), &mut random);
    let in_space: Vec<Case> = plane
        .iter()
        .map(|case| {
            let mut own = case.clone();
            own.arm.space = Some(Space::default());
            own.measurements.extend([0.1, 0.245].map(|s| Measurement::new(Quantity::Z(s), 0.0, 1e-3)));
            own
        })
        .collect();
    let wanted = [(Parameter::Young.into(), 100e3), (Parameter::DragNormal.into(), 2.0), (curved(Curvature::Mu), 0.0)];
    let [flat, round] = [&plane, &in_space].map(|cases| fitted(cases, &wanted));
    for (a, b) in flat.estimates.iter().zip(&round.estimates) {
        let sd = a.sd.unwrap();
        assert!((a.value - b.value).abs() < 1e-4 * sd, "{}: {} and {}", a.fitted.parameter, a.value, b.value);
        assert!((sd / b.sd.unwrap() - 1.0).abs() < 1e-4);
    }
    assert!((flat.chi_square / round.chi_square - 1.0).abs() < 1e-6);
}

#[test]
fn what_an_arm_does_not_have_is_refused_with_its_name() {
    let young = |arm: &Arm| [Fitted::new(Parameter::Young, arm).unwrap()];
    let said = |arm: &Arm, quantity: Quantity| {
        let case =
            Case { name: "a".to_owned(), arm: arm.clone(), measurements: vec![Measurement::new(quantity, 0.0, 1.0)] };
        fit(&[case], &young(arm), &options(), |_| true).unwrap_err().to_string()
    };
    let there = hanging();
    for angle in [Quantity::Angle(0.1), Quantity::Tangent(0.1)] {
        assert!(said(&there, angle).contains("arms in the plane alone"));
    }
    let flat = common::silicone();
    for of_space in [Quantity::Z(0.1), Quantity::BaseForce(2), Quantity::BaseMomentAbout(0)] {
        assert!(said(&flat, of_space).contains("space = \"spatial\""), "{of_space}");
    }
    let beside = Marker { s: 0.1, offset: [0.0, 0.0, 0.01] };
    let words = said(&flat, Quantity::Off(beside, 0));
    assert!(words.contains("offset along c") && words.contains("x at s = 100 mm, beside by (0, 0, 10) mm"), "{words}");
    assert!(Fitted::new(Unknown::CableFactor(4), &flat).is_err());
    assert!(Fitted::new(Parameter::Reference(Curvature::Tau, Point::Whole), &flat).is_err());
}
