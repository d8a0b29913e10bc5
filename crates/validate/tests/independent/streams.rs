//! Rods clamped across streams of all speeds: each is solved, and no tip stands away from those of the speeds beside it.

use hydrostat::{Arm, Configuration, FlowLaw, LayerMean, Options, SolveError, Solver, Volume};
use hydrostat_files::ArmFile;
use rayon::prelude::*;

use crate::correction::{Correction, correct, equilibrium_near};
use crate::mechanics::Model;
use crate::polynomials::Points;
use crate::shape::{POINTS, Shape};

const SPEEDS: i32 = 200;

/// From 0.001 to 2 m/s, evenly by order of magnitude.
fn speed(k: i32) -> f64 {
    1e-3 * 2000.0_f64.powf(f64::from(k) / f64::from(SPEEDS - 1))
}

/// Whether the stream along a rod that lies in it pulls less than 0.8 of what its base section carries.
fn is_carried(arm: &Arm) -> bool {
    let radius = arm.radius.at(0.0, arm.length).value;
    let hydrostat::Material::Homogeneous { young, .. } = arm.material else { unreachable!() };
    let area = std::f64::consts::PI * radius * radius;
    let along = match arm.flow.law {
        FlowLaw::Momentum => arm.model.layer_mean.factor().powi(2),
        FlowLaw::QuadraticDrag { ct, .. } => ct,
    };
    // Bends carry some of the normal load as tension, too: EI/2 curvature^2 at most, which is small here.
    let pull = along * std::f64::consts::PI * arm.flow.density * radius * arm.flow.speed.powi(2) * arm.length;
    let most = match arm.model.volume {
        Volume::Planar => 0.25,
        Volume::Circular => 1.0 / 3.0,
        Volume::None => 0.5,
    };
    pull < 0.8 * most * young * area
}

/// The rod in a stream of that speed (m/s).
fn in_stream(rod: &Arm, speed: f64) -> Arm {
    let mut arm = rod.clone();
    arm.flow.speed = speed;
    arm
}

/// The rod at all speeds.
fn solved(rod: &Arm) -> Vec<Result<Configuration, SolveError>> {
    let solve = |k: i32| Solver::new(&in_stream(rod, speed(k)), Options::default())?.solve();
    (0..SPEEDS).into_par_iter().map(solve).collect()
}

/// What is wrong with the rod, as `solved` has it over all speeds.
fn wrong(rod: &Arm, solved: &[Result<Configuration, SolveError>]) -> Vec<String> {
    let points = Points::new(POINTS);
    let (mut out, mut not_followed, mut doubted) = (Vec::new(), 0, 0);
    for (k, answer) in (0..SPEEDS).zip(solved) {
        let name = format!("{}, {:.5} m/s", rod.name, speed(k));
        match answer {
            Ok(own) => {
                // Newton's method on the equations written out anew, from the shape at the speed before, arrives here too.
                let Some(Ok(before)) = k.checked_sub(1).and_then(|k| solved.get(usize::try_from(k).ok()?)) else {
                    continue;
                };
                let (tip, last) = (own.tip(), before.tip());
                let moved = (tip.x - last.x).hypot(tip.y - last.y) / rod.length;
                if moved > 0.05 && is_carried(&own.arm) {
                    out.push(format!("{name}: {moved:.3} L from the tip at the speed before"));
                }
                let model = Model::new(&own.arm);
                let off = |beside: &Correction| (beside.tip[0] - tip.x).hypot(beside.tip[1] - tip.y);
                let allowed = 3.0 * own.error_estimate + 1e-5 * rod.length;
                // Elements that end where those of the speed before did may be too long for kinks that have moved.
                let coarse = correct(&mut Shape::read(&model, &points, before, 1));
                let beside = match coarse {
                    Ok(beside) if off(&beside) <= allowed => Ok(beside),
                    _ => equilibrium_near(&model, before, own),
                };
                match beside {
                    Ok(beside) => {
                        if off(&beside) > allowed + 2.0 * beside.doubt {
                            let [off, doubt] = [off(&beside), beside.doubt].map(|metres| metres / rod.length);
                            out.push(format!("{name}: {off:.1e} L from the equilibrium here, known to {doubt:.1e} L"));
                        }
                        doubted += usize::from(beside.doubt > 1e-5 * rod.length);
                    }
                    // The kinks move too far from speed to speed.
                    Err(_) => not_followed += 1,
                }
            }
            Err(SolveError::NoEquilibrium(no)) => {
                if is_carried(&in_stream(rod, speed(k))) {
                    out.push(format!("{name}: {}", no.verdict.message()));
                }
            }
            Err(error) => out.push(format!("{name}: {error}")),
        }
    }
    assert!(not_followed < SPEEDS / 5, "{}: {not_followed} were not followed", rod.name);
    assert!(doubted < 10, "{}: {doubted} are known to no more than 1e-5 L", rod.name);
    out
}

fn none_wrong(rods: &[Arm]) {
    are_none(&rods.iter().flat_map(|rod| wrong(rod, &solved(rod))).collect::<Vec<_>>());
}

fn are_none(wrong: &[String]) {
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

fn blade() -> Arm {
    let mut arm = ArmFile::parse(include_str!("cases/blade.toml"), "blade.toml").unwrap().arm().unwrap();
    "blade".clone_into(&mut arm.name);
    arm
}

fn rods() -> Vec<Arm> {
    let mut out = Vec::new();
    for law in [FlowLaw::Momentum, FlowLaw::QuadraticDrag { cn: 1.0, ct: 0.03 }] {
        for volume in [Volume::Planar, Volume::None] {
            for (length, radius, young) in [(1.0, 1e-3, 1e6), (0.3, 4e-3, 5e5)] {
                let mut arm = Arm::cone(length, radius, radius, young, 0.5);
                arm.name = format!("rod of {length} m, {radius} m, {young} Pa, {law:?}, {volume:?}");
                arm.radius = radius.into();
                arm.base.angle = std::f64::consts::FRAC_PI_2;
                arm.flow.law = law;
                arm.model.volume = volume;
                out.push(arm);
            }
        }
    }
    out
}

#[test]
fn a_blade_in_quadratic_drag_bends_steadily_with_the_speed() {
    none_wrong(&[blade()]);
}

/// Where its tip lies along the stream the load's kink moves with it.
#[test]
fn a_blade_bends_steadily_with_the_speed_by_the_momentum_law() {
    let mut arm = blade();
    arm.flow.law = FlowLaw::Momentum;
    none_wrong(&[arm.clone()]);
    let refused: Vec<f64> = (0..200_i32)
        .map(|k| 0.05 + 0.004 * f64::from(k) / 199.0)
        .filter(|speed| in_stream(&arm, *speed).solve().is_err())
        .collect();
    assert!(refused.is_empty(), "refused at {refused:?} m/s");
}

/// Its tail lies in the stream, whose load across it has no slope there: next to nothing holds the tail, and signs of
/// determinants say little.
#[test]
fn a_blade_that_the_stream_pulls_to_twice_its_length_is_solved_at_every_speed() {
    let mut arm = blade();
    arm.flow.law = FlowLaw::Momentum;
    arm.model.volume = Volume::None;
    let solved = solved(&arm);
    are_none(&wrong(&arm, &solved));
    let refused: Vec<f64> = (0..SPEEDS).zip(&solved).filter(|(_, at)| at.is_err()).map(|(k, _)| speed(k)).collect();
    assert!(refused.is_empty(), "refused at {refused:?} m/s");
}

#[test]
fn rods_bend_steadily_with_the_speed() {
    none_wrong(&rods());
}

#[test]
fn rods_bend_steadily_with_the_speed_by_the_other_mean() {
    let rods: Vec<Arm> = rods()
        .into_iter()
        .filter(|arm| arm.flow.law == FlowLaw::Momentum)
        .map(|mut arm| {
            arm.model.layer_mean = LayerMean::Momentum;
            arm.name += ", root of the mean square";
            arm
        })
        .collect();
    none_wrong(&rods);
}
