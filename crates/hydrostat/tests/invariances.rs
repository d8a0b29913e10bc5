//! What must not change an arm, or change it in a known way.

use std::f64::consts::PI;

use hydrostat::{
    Arm, Cable, Configuration, FlowLaw, Gravity, LayerMean, Options, Profile, SolveError, Solver, Volume, WettedLength,
};
use proptest::prelude::*;
use proptest::sample::select;

const TOL: f64 = 1e-8;

fn solve(arm: &Arm) -> Result<Configuration, SolveError> {
    Solver::new(arm, Options::with_tol(TOL)).unwrap().solve()
}

prop_compose! {
    /// Moderate arms: loads are fractions of what bends the arm by about a radian.
    fn arms()(
        (length, radius, taper, young, poisson) in (0.15..0.4, 0.03..0.06, 0.2..1.0, 5e4..3e5, 0.3..0.5),
        (left, right, inward, end) in (0.2..0.8, 0.2..0.8, 0.5..1.0, select(vec![1.0, 1.0, 0.45])),
        pulls in (0.0..0.6, 0.0..0.3),
        (cauchy, stream_direction) in (0.0..1.5, -PI..PI),
        (excess, gravity_direction) in (-0.3..0.5, -PI..PI),
        (push, push_direction, moment, follower) in (0.0..0.4, -PI..PI, -0.3..0.3, -0.3..0.3),
        (angle, x, y) in (-PI..PI, -1.0..1.0, -1.0..1.0),
        volume in select(vec![Volume::Planar, Volume::Circular, Volume::None]),
        layer_mean in select(vec![LayerMean::Speed, LayerMean::Momentum]),
        wetted_length in select(vec![WettedLength::Reference, WettedLength::Deformed]),
        law in select(vec![FlowLaw::Momentum, FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.005 }]),
    ) -> Arm {
        let ([radius, right, cauchy, push_direction, follower], tip_share): ([f64; 5], f64) =
            ([radius * length, right, cauchy, push_direction, follower], taper);
        let tip_radius = tip_share * radius;
        let mut arm = Arm::cone(length, radius, tip_radius, young, poisson);
        let middle = 0.5 * (radius + tip_radius);
        let bending = young * PI * middle.powi(4) / 4.0;
        let force = bending / (length * length);
        let offset = |fraction: f64| Profile::linear(fraction * radius, fraction * inward * tip_radius);
        // A quarter of what folds a tip section shut.
        let most = 0.25 * young * PI * tip_radius * tip_radius;
        arm.cables.push(Cable::new("left", offset(left)).pulled(pulls.0 * most));
        arm.cables.push(Cable::new("right", offset(-right)).pulled(pulls.1 * most).ending_at(end));
        arm.flow.law = law;
        arm.flow.speed = (cauchy * force / (arm.flow.density * PI * middle * length)).sqrt();
        arm.flow.direction = stream_direction;
        arm.density = 1000.0 * (1.0 + excess);
        arm.gravity = Some(Gravity {
            acceleration: 2.0 * force / (1000.0 * PI * middle * middle * length),
            direction: gravity_direction,
        });
        arm.tip.force = [push * force * push_direction.cos(), push * force * push_direction.sin()];
        arm.tip.moment = moment * bending / length;
        arm.tip.follower = [0.0, follower * force];
        arm.distributed.force[1] = (0.2 * follower * force / length).into();
        (arm.base.angle, arm.base.x, arm.base.y) = (angle, x, y);
        arm.model.volume = volume;
        arm.model.layer_mean = layer_mean;
        arm.model.wetted_length = wetted_length;
        arm
    }
}

/// Both arms have an answer, and `image` takes the places (x, y, theta) of the first to those of
/// the second at the same fraction of the length; or neither has one, for the same reason.
fn check(one: &Arm, two: &Arm, image: impl Fn([f64; 3]) -> [f64; 3]) -> Result<(), TestCaseError> {
    match (solve(one), solve(two)) {
        (Ok(first), Ok(second)) => {
            prop_assert_eq!(first.stable, second.stable);
            for k in 0..=20 {
                let fraction = f64::from(k) / 20.0;
                let (a, b) = (first.at(fraction * one.length), second.at(fraction * two.length));
                let want = image([a.x, a.y, a.theta]);
                let off = (want[0] - b.x).hypot(want[1] - b.y) / two.length;
                prop_assert!(off < 3.0 * TOL, "places differ by {off:e} L at {fraction}");
                let turn = (want[2] - b.theta).abs();
                prop_assert!(turn < 30.0 * TOL, "angles differ by {turn:e} at {fraction}");
                prop_assert!((a.nu - b.nu).abs() < 30.0 * TOL, "stretches differ at {fraction}: {} {}", a.nu, b.nu);
            }
        }
        (Err(SolveError::NoEquilibrium(first)), Err(SolveError::NoEquilibrium(second))) => {
            let (first, second) = (&first.verdict, &second.verdict);
            prop_assert_eq!((first.kind, first.phase), (second.kind, second.phase));
            prop_assert!((first.load_fraction - second.load_fraction).abs() < 1e-3, "{first:?} {second:?}");
        }
        (first, second) => prop_assert!(
            false,
            "one has an answer, one has not: {:?} {:?}",
            first.map(|c| c.tip()).map_err(|e| e.to_string()),
            second.map(|c| c.tip()).map_err(|e| e.to_string())
        ),
    }
    Ok(())
}

fn mirrored(arm: &Arm) -> Arm {
    let mut out = arm.clone();
    out.base.y = -arm.base.y;
    out.base.angle = -arm.base.angle;
    for cable in &mut out.cables {
        cable.offset = cable.offset.scaled(-1.0, 1.0);
    }
    out.cables.reverse();
    out.flow.direction = -arm.flow.direction;
    if let Some(gravity) = &mut out.gravity {
        gravity.direction = -gravity.direction;
    }
    out.tip.force[1] = -arm.tip.force[1];
    out.tip.follower[1] = -arm.tip.follower[1];
    out.tip.moment = -arm.tip.moment;
    out.distributed.force[1] = arm.distributed.force[1].scaled(-1.0, 1.0);
    out.distributed.couple = arm.distributed.couple.scaled(-1.0, 1.0);
    out
}

/// Turned about the origin. Constant distributed loads only.
fn turned(arm: &Arm, angle: f64) -> Arm {
    let turn = |[x, y]: [f64; 2]| [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos()];
    let mut out = arm.clone();
    [out.base.x, out.base.y] = turn([arm.base.x, arm.base.y]);
    out.base.angle += angle;
    out.flow.direction += angle;
    if let Some(gravity) = &mut out.gravity {
        gravity.direction += angle;
    }
    out.tip.force = turn(arm.tip.force);
    let spread = turn([0, 1].map(|k| arm.distributed.force[k].at(0.0, arm.length).value));
    out.distributed.force = spread.map(Profile::from);
    out
}

/// All lengths times `length`, all stiffnesses times `stiffness`, and loads to match.
fn rescaled(arm: &Arm, length: f64, stiffness: f64) -> Arm {
    let mut out = arm.clone();
    let force = stiffness * length * length;
    out.length *= length;
    out.radius = arm.radius.scaled(length, length);
    out.base.x *= length;
    out.base.y *= length;
    let hydrostat::Material::Homogeneous { young, .. } = &mut out.material else { unreachable!() };
    *young *= stiffness;
    for cable in &mut out.cables {
        cable.offset = cable.offset.scaled(length, length);
        cable.tension *= force;
    }
    // Half of the factor of density U^2 falls to each.
    out.flow.density *= stiffness.sqrt();
    out.flow.speed *= stiffness.powf(0.25);
    out.density *= stiffness.sqrt();
    if let Some(gravity) = &mut out.gravity {
        gravity.acceleration *= stiffness.sqrt() / length;
    }
    out.tip.force = arm.tip.force.map(|f| f * force);
    out.tip.follower = arm.tip.follower.map(|f| f * force);
    out.tip.moment *= force * length;
    out.distributed.force = [0, 1].map(|k| arm.distributed.force[k].scaled(force / length, length));
    out
}

proptest! {
    #![proptest_config(hydrostat_fuzz::property(24))]

    #[test]
    fn a_mirrored_arm_has_the_mirrored_shape(arm in arms()) {
        check(&arm, &mirrored(&arm), |[x, y, theta]| [x, -y, -theta])?;
    }

    #[test]
    fn a_turned_arm_has_the_turned_shape(arm in arms(), angle in -PI..PI) {
        check(&arm, &turned(&arm, angle), |[x, y, theta]| {
            [x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos(), theta + angle]
        })?;
    }

    #[test]
    fn a_moved_arm_has_the_moved_shape(arm in arms(), dx in -3.0..3.0, dy in -3.0..3.0) {
        let mut moved = arm.clone();
        moved.base.x += dx;
        moved.base.y += dy;
        check(&arm, &moved, |[x, y, theta]| [x + dx, y + dy, theta])?;
    }

    #[test]
    fn units_do_not_matter(arm in arms(), length in 0.01..100.0, stiffness in 1e-3..1e3) {
        check(&arm, &rescaled(&arm, length, stiffness), |[x, y, theta]| [x * length, y * length, theta])?;
    }

    #[test]
    fn a_slack_cable_is_no_cable(arm in arms(), fraction in -0.9..0.9, end in select(vec![0.3, 1.0])) {
        let mut more = arm.clone();
        let offset = Profile::linear(fraction * arm.radius.at(0.0, arm.length).value, 0.0);
        more.cables.insert(1, Cable::new("slack", offset).ending_at(end));
        check(&arm, &more, |place| place)?;
    }

    #[test]
    fn two_half_tensions_on_one_line_are_one(arm in arms()) {
        let mut split = arm.clone();
        for cable in &mut split.cables {
            cable.tension *= 0.5;
        }
        let halves = split.cables.clone();
        split.cables.extend(halves);
        check(&arm, &split, |place| place)?;
    }
}

/// An arm whose cable folds its tip shut: where on the path, no unit of length decides.
#[test]
fn a_verdict_does_not_depend_on_units() {
    let mut arm = Arm::cone(0.15, 0.0078, 0.0039, 206e3, 0.44);
    arm.cables.push(Cable::new("left", Profile::linear(0.0059, 0.0015)).pulled(4.917_687));
    arm.cables.push(Cable::new("right", Profile::linear(-0.0016, -0.0004)).pulled(2.874_317));
    arm.tip.force = [0.0, 0.015];
    arm.model.volume = Volume::None;
    let fraction = |arm: &Arm| match solve(arm) {
        Err(SolveError::NoEquilibrium(end)) => (end.verdict.kind, end.verdict.load_fraction),
        other => panic!("an answer or another error: {:?}", other.map(|c| c.tip())),
    };
    let (kind, first) = fraction(&arm);
    let factors = [(100.0, 1.0), (1.0, 1e3), (0.013, 0.37), (7.3, 12.0), (0.9, 1.1), (3.0, 1.0)];
    let all: Vec<f64> = factors
        .iter()
        .map(|(a, b)| {
            let (other, second) = fraction(&rescaled(&arm, *a, *b));
            assert_eq!(kind, other);
            second
        })
        .collect();
    let spread = all.iter().fold(0.0_f64, |w, f| w.max((f - first).abs()));
    assert!(spread < 1e-6, "{first} and {all:?}");
}
