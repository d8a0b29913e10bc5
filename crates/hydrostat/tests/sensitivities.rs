//! Sensitivities against extrapolated differences of solves, against each other, and against closed forms.

use hydrostat::{
    Arm, Cable, Configuration, Displaced, Ellipse, FlowLaw, Gravity, Material, ModelOptions, Options, Parameter,
    PoseChange, Profile, SensitivityError, SensitivityMethod, SensitivityOptions, Solver, Volume,
};

/// Tolerance of the solves that are differenced.
const TIGHT: Options = Options::with_tol(1e-12);

fn cone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.4);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.08));
    arm
}

/// Everything acts at once.
fn loaded() -> Arm {
    let mut arm = cone();
    arm.flow.speed = 0.15;
    arm.flow.direction = 0.9;
    arm.gravity = Some(Gravity::default());
    arm.tip.force = [1e-4, -2e-4];
    arm.tip.moment = 1e-5;
    arm.tip.follower = [2e-4, 1e-4];
    arm.base.angle = 0.2;
    arm
}

/// Short and elastic cables, at commanded strokes.
fn held() -> Arm {
    let mut arm = loaded();
    arm.cables[0] = Cable::new("left", Profile::linear(0.005, 0.001)).reeled_in(0.010);
    arm.cables[1] = Cable::new("right", Profile::linear(-0.005, -0.001)).reeled_in(0.006);
    arm.cables[1].stiffness = Some(10.0);
    arm.cables.push(Cable::new("short", Profile::linear(0.004, 0.002)).pulled(0.05));
    arm.cables[2].end = 0.6;
    arm
}

/// An arm whose coefficients are given, as stiff as the source's, with a thicker tip: that of the source's arm leaves
/// solves an error of 1e-8 of the length whatever is asked for, and differences of them no digits to compare with.
fn stiff() -> Arm {
    let mut arm = Arm::cone(0.2, 0.010, 0.003, 500e3, 0.5);
    arm.material = Material::Coefficients { c1: 500e3.into(), c2: (500e3 / 3.0).into(), c3: 150.0.into() };
    arm.cables.push(Cable::new("left", Profile::linear(0.008, 0.002)).pulled(2.0));
    arm.cables.push(Cable::new("right", Profile::linear(-0.008, -0.002)).pulled(0.5));
    arm.flow.speed = 0.5;
    // Not along the base, where a kink of the load would come and go with every parameter.
    arm.flow.direction = 0.3;
    arm
}

/// The same loads where the displaced water follows the stretch.
fn displacing(volume: Volume, displaced: Displaced) -> Arm {
    let mut arm = loaded();
    arm.model = ModelOptions { volume, displaced, ..ModelOptions::default() };
    arm
}

/// The readings of the source that differ, with the stream on one side all along.
fn literal() -> Arm {
    let mut arm = cone();
    arm.set_tensions(&[0.05, 0.02]).unwrap();
    arm.gravity = Some(Gravity::default());
    arm.flow.speed = 0.05;
    arm.model = ModelOptions { flow_surface: hydrostat::FlowSurface::Lateral, ..ModelOptions::default() };
    arm.model.hydrostatics = hydrostat::Hydrostatics::NormalOnly;
    arm.model.entering_speed = hydrostat::EnteringSpeed::Resultant;
    arm.model.volume = hydrostat::Volume::Circular;
    arm.flow.direction = -1.3;
    arm
}

/// Cables and a hollow body whose profiles are tables, one cable at a commanded stroke.
fn routed() -> Arm {
    let mut arm = cone();
    let table = |points: &[[f64; 2]]| Profile::table(points).unwrap();
    arm.radius = table(&[[0.0, 0.010], [0.08, 0.0085], [0.16, 0.006], [0.245, 0.003]]);
    arm.inner_radius = Profile::linear(0.003, 0.001);
    arm.cavity = hydrostat::Cavity::Sealed;
    arm.gravity = Some(Gravity::default());
    arm.flow.speed = 0.1;
    arm.flow.direction = -1.1;
    arm.cables[0].offset = table(&[[0.0, 0.006], [0.1, 0.0045], [0.2, 0.0025], [0.245, 0.0015]]);
    arm.cables[1].offset = table(&[[0.0, -0.005], [0.12, -0.0032], [0.245, -0.001]]);
    arm.cables[1] = Cable { stroke: Some(0.004), tension: 0.0, ..arm.cables[1].clone() };
    arm.reference.mu = 0.5.into();
    arm
}

/// Quadratic drag, with the stream on one side all along.
fn dragged() -> Arm {
    let mut arm = cone();
    arm.set_tensions(&[0.05, 0.02]).unwrap();
    arm.gravity = Some(Gravity::default());
    arm.flow.speed = 0.1;
    arm.flow.direction = -1.3;
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.02 };
    arm
}

/// Tip pose, then strokes, then tensions, then the pose at a place, then the wrench at the base.
fn numbers(shape: &Configuration, s: f64) -> Vec<f64> {
    let (tip, place) = (shape.tip(), shape.at(s));
    let mut out = vec![tip.x, tip.y, tip.theta, tip.alpha];
    out.extend(shape.cables.iter().map(|c| c.stroke));
    out.extend(shape.cables.iter().map(|c| c.tension));
    out.extend([place.x, place.y, place.theta, place.alpha]);
    let base = shape.base_reaction;
    out.extend([base.force[0], base.force[1], base.moment]);
    out
}

/// A scale on which the parameter changes the arm smoothly.
fn scale(parameter: Parameter, value: f64) -> f64 {
    match parameter {
        Parameter::Tension(_) => 0.05 * value.abs().max(0.1),
        Parameter::Stroke(_) => 1e-4,
        Parameter::TipForce(_) | Parameter::TipFollower(_) => 5e-4,
        Parameter::TipMoment => 4e-6,
        Parameter::FlowDirection | Parameter::GravityDirection | Parameter::BaseAngle => 0.05,
        Parameter::FlowSpeed => 0.01,
        Parameter::Poisson => 0.08,
        _ => 0.04 * value.abs(),
    }
}

/// Romberg's extrapolation of central differences, to the eighth order.
fn differences(arm: &Arm, parameter: Parameter, s: f64) -> Vec<f64> {
    let value = parameter.of(arm).unwrap();
    let step = scale(parameter, value);
    // By the length, a place keeps its fraction of it.
    let part = s / arm.length;
    let at = |value: f64| {
        let mut arm = arm.clone();
        parameter.set(&mut arm, value).unwrap();
        numbers(&Solver::new(&arm, TIGHT).unwrap().solve().unwrap(), part * arm.length)
    };
    let mut levels: Vec<Vec<f64>> = (0..4)
        .map(|k| {
            let h = step / 2.0_f64.powi(k);
            let (after, before) = (at(value + h), at(value - h));
            after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * h)).collect()
        })
        .collect();
    for order in 1..levels.len() {
        let factor = 4.0_f64.powi(i32::try_from(order).unwrap());
        for k in 0..levels.len() - order {
            let better: Vec<f64> = levels[k + 1]
                .iter()
                .zip(&levels[k])
                .map(|(fine, coarse)| fine + (fine - coarse) / (factor - 1.0))
                .collect();
            levels[k] = better;
        }
    }
    levels.swap_remove(0)
}

fn sensitivities(arm: &Arm, options: Options, s: f64, method: SensitivityMethod) -> Vec<Vec<f64>> {
    let parameters = Parameter::all_of(arm);
    let mut solver = Solver::new(arm, options).unwrap();
    let wanted = SensitivityOptions { stations: vec![s], method };
    let found = solver.sensitivities_with(&parameters, &wanted).unwrap();
    let pose = |p: hydrostat::PoseChange| [p.x, p.y, p.theta, p.alpha];
    (0..parameters.len())
        .map(|k| {
            let mut out = pose(found.tip[k]).to_vec();
            out.extend(found.strokes.iter().map(|row| row[k]));
            out.extend(found.tensions.iter().map(|row| row[k]));
            out.extend(pose(found.stations[0].changes[k]));
            let base = found.base[k];
            out.extend([base.force[0], base.force[1], base.moment]);
            out
        })
        .collect()
}

/// Lengths, angles, forces and moments among the numbers, which have a scale each.
fn kind(k: usize, cables: usize) -> usize {
    let place = k.checked_sub(4 + 2 * cables).unwrap_or(k);
    match k {
        k if k < 4 || k >= 4 + 2 * cables => [0, 0, 1, 1, 2, 2, 3][place],
        k if k < 4 + cables => 0,
        _ => 2,
    }
}

#[test]
fn sensitivities_match_extrapolated_differences_of_solves() {
    let mut worst_of_all = 0.0_f64;
    for (name, arm) in [
        ("cone", cone()),
        ("loaded", loaded()),
        ("rigid sections", displacing(Volume::None, Displaced::Volume)),
        ("by section", displacing(Volume::Planar, Displaced::Section)),
        ("held", held()),
        ("stiff", stiff()),
        ("dragged", dragged()),
        ("literal", literal()),
        ("routed", routed()),
    ] {
        let s = 0.55 * arm.length;
        let exact = sensitivities(&arm, TIGHT, s, SensitivityMethod::Best);
        for (parameter, exact) in Parameter::all_of(&arm).into_iter().zip(&exact) {
            let smooth = !matches!(
                parameter,
                Parameter::FlowSpeed | Parameter::GravityAcceleration | Parameter::Density | Parameter::Tension(_)
            ) || parameter.of(&arm).unwrap() != 0.0;
            let changes = scale(parameter, parameter.of(&arm).unwrap()) != 0.0;
            if !(smooth && changes) {
                continue;
            }
            let want = differences(&arm, parameter, s);
            let cables = arm.cables.len();
            let mut sizes = [1e-12_f64; 4];
            for (k, want) in want.iter().enumerate() {
                sizes[kind(k, cables)] = sizes[kind(k, cables)].max(want.abs());
            }
            // What solves to 1e-12 leave is magnified where a step moves the arm by little.
            let noise = 1e-12 / scale(parameter, parameter.of(&arm).unwrap());
            // alpha comes from beta', which rounding at a thin tip moves by some 1e-11 rad.
            let noise_at = |k: usize| if [3, 3 + 4 + 2 * cables].contains(&k) { 10.0 * noise } else { noise };
            let off = |(k, (want, exact)): (usize, (&f64, &f64))| {
                ((want - exact).abs() - noise_at(k)).max(0.0) / sizes[kind(k, cables)]
            };
            let worst = want.iter().zip(exact).enumerate().map(off).fold(0.0, f64::max);
            println!("{name} {parameter}: {worst:.1e} of {sizes:?}");
            worst_of_all = worst_of_all.max(worst);
            assert!(worst < 1e-8, "{name} {parameter}: {worst:e} off");
        }
    }
    println!("worst {worst_of_all:e}");
}

/// The source's arm pressed by both cables, whose beta is carried from element to element. Solves of it are good to
/// 1e-9 of the length, whatever is asked for.
fn squeezed() -> Arm {
    let mut arm = stiff();
    arm.radius = Profile::linear(0.010, 0.0008);
    arm.cables[0] = Cable::new("left", Profile::linear(0.008, 0.0001)).pulled(40.0);
    arm.cables[1] = Cable::new("right", Profile::linear(-0.008, -0.0001)).pulled(20.0);
    arm
}

#[test]
fn sensitivities_of_squeezed_arms_match_differences() {
    let arm = squeezed();
    let s = 0.9 * arm.length;
    let exact = sensitivities(&arm, Options::with_tol(1e-10), s, SensitivityMethod::Best);
    for (parameter, exact) in Parameter::all_of(&arm).into_iter().zip(&exact) {
        if !matches!(parameter, Parameter::Tension(_)) {
            continue;
        }
        let want = differences(&arm, parameter, s);
        let mut sizes = [1e-12_f64; 4];
        for (k, want) in want.iter().enumerate() {
            sizes[kind(k, 2)] = sizes[kind(k, 2)].max(want.abs());
        }
        for (k, (want, exact)) in want.iter().zip(exact).enumerate() {
            let off = (want - exact).abs() / sizes[kind(k, 2)];
            // Angles alpha hang on beta' at the place, between the stations that it is known at.
            let bound = if k == 3 || k == 11 { 1e-4 } else { 1e-6 };
            println!("{parameter} {k}: {off:.1e}");
            assert!(off < bound, "{parameter} {k}: {off:e} off, {want:e} {exact:e}");
        }
    }
}

#[test]
fn forward_and_adjoint_agree() {
    for arm in [loaded(), held(), stiff(), dragged(), literal(), routed(), squeezed()] {
        let s = 0.3 * arm.length;
        let forward = sensitivities(&arm, Options::default(), s, SensitivityMethod::Forward);
        let adjoint = sensitivities(&arm, Options::default(), s, SensitivityMethod::Adjoint);
        for (forward, adjoint) in forward.iter().zip(&adjoint) {
            let size = forward.iter().fold(1e-12_f64, |m, v| m.max(v.abs()));
            for (f, a) in forward.iter().zip(adjoint) {
                assert!((f - a).abs() < 1e-12 * size, "{f:e} {a:e}");
            }
        }
    }
}

/// One adjoint solve gives what all rows together do.
#[test]
fn a_gradient_is_the_sum_of_weighted_rows() {
    for arm in [loaded(), held(), literal(), routed()] {
        let parameters = Parameter::all_of(&arm);
        let places = [0.2, 0.45, 0.8, 1.0].map(|fraction| fraction * arm.length);
        let weights = [[1.0, -0.3, 0.2, 0.0], [0.0, 2.0, 0.0, -0.1], [-0.7, 0.4, 0.0, 0.3], [0.5, 0.0, -0.4, 0.2]];
        let pose = |[x, y, theta, alpha]: [f64; 4]| PoseChange { x, y, theta, alpha };
        let asked: Vec<(f64, PoseChange)> = places.into_iter().zip(weights.map(pose)).collect();
        let mut solver = Solver::new(&arm, Options::default()).unwrap();
        let gradient = solver.gradient(&parameters, &asked).unwrap();
        let wanted = SensitivityOptions { stations: places.to_vec(), method: SensitivityMethod::Forward };
        let found = solver.sensitivities_with(&parameters, &wanted).unwrap();
        for (k, got) in gradient.iter().enumerate() {
            let (mut want, mut size) = (0.0, 1e-12);
            for (station, weights) in found.stations.iter().zip(&weights) {
                let p = station.changes[k];
                for (w, p) in weights.iter().zip([p.x, p.y, p.theta, p.alpha]) {
                    want += w * p;
                    size += (w * p).abs();
                }
            }
            assert!((got - want).abs() < 1e-10 * size, "{}: {got:e} for {want:e}", parameters[k]);
        }
    }
}

/// An unloaded cantilever: L^3/3EI + L/GA, L^2/2EI, L/EI and L/EA.
#[test]
fn compliance_of_a_cantilever_is_in_the_textbooks() {
    let (length, radius, young, poisson) = (0.3_f64, 0.01_f64, 2e5_f64, 0.3_f64);
    let arm = Arm::cone(length, radius, radius, young, poisson);
    let area = std::f64::consts::PI * radius * radius;
    let bending = young * area * radius * radius / 4.0;
    let Material::Homogeneous { shear_factor, .. } = arm.material else { panic!("a cone is homogeneous") };
    let shear = shear_factor * young / (2.0 * (1.0 + poisson)) * area;
    let loads = [Parameter::TipForce(0), Parameter::TipForce(1), Parameter::TipMoment];
    let found = Solver::new(&arm, Options::default()).unwrap().sensitivities(&loads).unwrap().compliance().unwrap();
    let (sway, turn) = (length.powi(3) / (3.0 * bending) + length / shear, length.powi(2) / (2.0 * bending));
    let want = [[length / (young * area), 0.0, 0.0], [0.0, sway, turn], [0.0, turn, length / bending]];
    for (found, want) in found.iter().flatten().zip(want.iter().flatten()) {
        assert!((found - want).abs() <= 1e-11 * want.abs().max(1e-6), "{found} for {want}");
    }
}

#[test]
fn an_ellipse_holds_what_its_jacobian_does() {
    let columns = [[3.0, 1.0], [-0.5, 2.0], [0.1, 0.4]];
    let ellipse = Ellipse::of(&columns);
    let (sin, cos) = ellipse.direction.sin_cos();
    let reach = |x: f64, y: f64| columns.iter().map(|c| (c[0] * x + c[1] * y).powi(2)).sum::<f64>().sqrt();
    assert!((reach(cos, sin) - ellipse.half_axes[0]).abs() < 1e-14);
    assert!((reach(-sin, cos) - ellipse.half_axes[1]).abs() < 1e-14);
    for k in 0..50 {
        let (sin, cos) = f64::from(k).sin_cos();
        assert!(reach(cos, sin) <= ellipse.half_axes[0] + 1e-14 && reach(cos, sin) >= ellipse.half_axes[1] - 1e-14);
    }
}

#[test]
fn what_has_no_derivative_is_refused() {
    let refused =
        |arm: &Arm, parameter| Solver::new(arm, Options::default()).unwrap().sensitivities(&[parameter]).err();
    assert!(matches!(refused(&held(), Parameter::Tension(0)), Some(SensitivityError::Commanded(0))));
    assert!(matches!(refused(&cone(), Parameter::Stroke(1)), Some(SensitivityError::NotCommanded(1))));
    assert!(matches!(refused(&stiff(), Parameter::Young), Some(SensitivityError::Unfit(_))));
    assert!(matches!(refused(&cone(), Parameter::Tension(2)), Some(SensitivityError::Unfit(_))));
    let mut rubbing = cone();
    rubbing.cables[0].friction = 0.1;
    assert!(matches!(refused(&rubbing, Parameter::Young), Some(SensitivityError::Friction(_))));
    let off = SensitivityOptions { stations: vec![0.3], ..SensitivityOptions::default() };
    let found = Solver::new(&cone(), Options::default()).unwrap().sensitivities_with(&[], &off);
    assert!(matches!(found, Err(SensitivityError::Station { .. })));
}

/// How good derivatives are where the solve is not tight: of the size of its error, which counts for more where a
/// parameter moves the arm little. At 1e-8 the largest is 2.1e-6 (below 1e-6 on the mesh that paths without hurry led
/// to), at 1e-6 it is 4.4e-6.
#[test]
fn derivatives_are_as_good_as_the_solve() {
    let arm = loaded();
    let s = 0.6 * arm.length;
    let exact = sensitivities(&arm, TIGHT, s, SensitivityMethod::Best);
    for (tol, bound) in [(1e-8, 3e-6), (1e-6, 1e-4)] {
        let found = sensitivities(&arm, Options::with_tol(tol), s, SensitivityMethod::Best);
        let mut worst = 0.0_f64;
        for (found, exact) in found.iter().zip(&exact) {
            let size = exact.iter().fold(1e-12_f64, |m, v| m.max(v.abs()));
            worst = found.iter().zip(exact).map(|(f, e)| (f - e).abs() / size).fold(worst, f64::max);
        }
        println!("tol {tol:e}: {worst:e}");
        assert!(worst < bound, "{worst:e} at {tol:e}");
    }
}
