//! The rows that the search sees, against differences of solves.

use hydrostat::{Arm, Options, Parameter, Solver};
use hydrostat_identify::{Case, FitOptions, Fitted, Measurement, Quantity, fit, value_of};

mod common;
use common::{loads, markers, silicone};

fn value(arm: &Arm, quantity: Quantity) -> f64 {
    value_of(&Solver::new(arm, Options::with_tol(1e-12)).unwrap().solve().unwrap(), quantity)
}

/// d value / d parameter by central differences, extrapolated once.
fn difference(arm: &Arm, quantity: Quantity, parameter: Parameter) -> f64 {
    let at = parameter.of(arm).unwrap();
    let central = |step: f64| {
        let side = |to: f64| {
            let mut arm = arm.clone();
            parameter.set(&mut arm, to).unwrap();
            value(&arm, quantity)
        };
        (side(at + step) - side(at - step)) / (2.0 * step)
    };
    let step = 2e-3 * at.abs();
    let (coarse, fine) = (central(step), central(0.5 * step));
    fine + (fine - coarse) / 3.0
}

/// One number a fit: its standard deviation over that of the estimate is the derivative.
fn derivative(name: &str, arm: &Arm, quantity: Quantity, parameter: Parameter) -> f64 {
    let measurements = vec![Measurement::new(quantity, value(arm, quantity), 1.0)];
    let case = Case { name: name.to_owned(), arm: arm.clone(), measurements };
    let options = FitOptions { tol: 1e-10, ..FitOptions::default() };
    let found = fit(&[case], &[Fitted::new(parameter, arm).unwrap()], &options, |_| true).unwrap();
    let direction = &found.directions[0];
    direction.singular_value / found.estimates[0].scale.size
}

#[test]
fn every_kind_of_measurement_has_the_derivative_of_solves() {
    let (name, mut arm) = loads().swap_remove(2);
    arm.cables[1].tension = 0.06;
    let mut commanded = arm.clone();
    commanded.cables[0].stroke = Some(0.012);
    let places = [Quantity::X(0.11), Quantity::Y(0.245), Quantity::Angle(0.2), Quantity::Tangent(0.17)];
    let ends = [Quantity::Stroke(1), Quantity::BaseForce(0), Quantity::BaseForce(1), Quantity::BaseMoment];
    let parameters = [Parameter::Young, Parameter::DragNormal, Parameter::DragTangential, Parameter::FlowDirection];
    let mut compared = 0;
    for (arm, quantities) in
        [(&arm, [&places[..], &ends[..]].concat()), (&commanded, vec![Quantity::Tension(0), Quantity::Y(0.245)])]
    {
        for quantity in quantities {
            for parameter in parameters {
                let want = difference(arm, quantity, parameter).abs();
                let found = derivative(&name, arm, quantity, parameter);
                // What solves to 1e-12 leave over the steps.
                let noise =
                    1e-9 * match quantity.unit() {
                        "N" | "N m" => 0.1,
                        _ => 1.0,
                    } / parameter.of(arm).unwrap().abs();
                assert!(
                    (found - want).abs() < 1e-5 * want + noise,
                    "{quantity} by {parameter}: {found:e} for {want:e}"
                );
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 40);
}

#[test]
fn coefficients_of_a_given_material_can_be_fitted() {
    let mut arm = silicone();
    arm.material = hydrostat::Material::Coefficients { c1: 500e3.into(), c2: 170e3.into(), c3: 3.0.into() };
    arm.cables[0].tension = 0.2;
    (arm.flow.speed, arm.flow.direction) = (0.1, 1.0);
    for k in 0..3 {
        for quantity in markers(2) {
            let parameter = Parameter::Coefficient(k);
            let want = difference(&arm, quantity, parameter).abs();
            let found = derivative("a", &arm, quantity, parameter);
            let noise = 1e-9 / parameter.of(&arm).unwrap();
            assert!((found - want).abs() < 1e-5 * want + noise, "{quantity} by {parameter}: {found:e} for {want:e}");
        }
    }
}
