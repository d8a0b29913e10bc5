//! The checker sees what it is there for: an answer to another arm is corrected to the answer of this one.

use hydrostat::{Arm, Cable, FlowLaw, Gravity, Material, ModelOptions, Motion, Profile, Volume};

use crate::correction::equilibrium_beside;
use crate::mechanics::Model;
use crate::residuals::residuals;

fn arm() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.003, 110e3, 0.45);
    arm.density = 1080.0;
    arm.inner_radius = Profile::linear(0.004, 0.001);
    arm.base.angle = 0.3;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.002)).pulled(0.05).ending_at(0.6));
    (arm.flow.speed, arm.flow.direction) = (0.08, 1.1);
    arm.gravity = Some(Gravity::default());
    (arm.tip.force, arm.tip.follower, arm.tip.moment) = ([1e-3, -5e-4], [-4e-4, 3e-4], 1e-5);
    arm.distributed.force = [Profile::linear(0.01, -0.02), 0.01.into()];
    arm.distributed.couple = 1e-4.into();
    arm.reference.mu = Profile::linear(1.0, -1.0);
    arm.reference.nu = Profile::linear(1.0, 1.01);
    arm
}

/// Changes one thing by a little.
type Change = (&'static str, fn(&mut Arm));

const CHANGES: [Change; 19] = [
    ("radius", |arm| arm.radius = Profile::linear(0.010_002, 0.003)),
    ("inner radius", |arm| arm.inner_radius = Profile::linear(0.004_002, 0.001)),
    ("density", |arm| arm.density = 1080.5),
    ("base", |arm| arm.base.angle = 0.300_02),
    ("stiffness", |arm| arm.material = Material::Homogeneous { young: 110.01e3, poisson: 0.45, shear_factor: 1.0 }),
    ("shear", |arm| arm.material = Material::Homogeneous { young: 110e3, poisson: 0.45, shear_factor: 0.99 }),
    ("reference bend", |arm| arm.reference.mu = Profile::linear(1.0, -1.001)),
    ("reference shear", |arm| arm.reference.eta = 1e-5.into()),
    ("tension", |arm| arm.cables[0].tension = 0.200_02),
    ("offset", |arm| arm.cables[0].offset = Profile::linear(0.005_001, 0.001)),
    ("end", |arm| arm.cables[1].end = 0.64),
    ("speed", |arm| arm.flow.speed = 0.080_01),
    ("direction", |arm| arm.flow.direction = 1.1002),
    ("water", |arm| arm.flow.density = 1000.1),
    ("gravity", |arm| arm.gravity = Some(Gravity { acceleration: 9.811, ..Gravity::default() })),
    ("tip force", |arm| arm.tip.force[1] = -5.001e-4),
    ("tip follower", |arm| arm.tip.follower[1] = 3.001e-4),
    ("tip moment", |arm| arm.tip.moment = 1.001e-5),
    ("couple", |arm| arm.distributed.couple = 1.001e-4.into()),
];

fn check(name: &str, before: &Arm, after: &Arm) {
    let (one, two) = (before.solve().unwrap(), after.solve().unwrap());
    let beside = equilibrium_beside(&Model::new(after), &one).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    let moved = (one.tip().x - two.tip().x).hypot(one.tip().y - two.tip().y);
    let left = (beside.tip[0] - two.tip().x).hypot(beside.tip[1] - two.tip().y);
    let turned = (beside.theta - two.tip().theta).abs();
    assert!(moved > 1e-7 * after.length, "{name}: the change moves nothing, {moved:e}");
    // With friction estimates are too small, see `friction`: what holds is the tolerance.
    let rubs = after.cables.iter().any(|cable| cable.friction > 0.0);
    let allowed = if rubs { 1e-8 * after.length } else { 3.0 * two.error_estimate + 1e-12 };
    assert!(left < allowed && turned < 1e-7, "{name}: {left:e} m of {moved:e} are left");
    // The reaction is the new arm's, too.
    let reaction = &two.base_reaction;
    for (own, said) in beside.base.iter().zip([reaction.force[0], reaction.force[1], reaction.moment]) {
        assert!((own + said).abs() < 1e-6 * (1e-3 + said.abs()), "{name}: {own} {said}");
    }
    // What is off is off in the raw residuals, too.
    let (right, wrong) = (residuals(&Model::new(before), &one), residuals(&Model::new(after), &one));
    assert!(wrong.largest() > 10.0 * right.largest(), "{name}: {right:?} {wrong:?}");
}

#[test]
fn every_change_of_an_arm_is_seen_and_corrected() {
    let before = arm();
    for (name, change) in CHANGES {
        let mut after = before.clone();
        change(&mut after);
        check(name, &before, &after);
    }
}

#[test]
fn every_change_is_seen_in_other_readings_and_laws() {
    for (volume, law) in [
        (Volume::None, FlowLaw::QuadraticDrag { cn: 2.0, ct: 0.02 }),
        (Volume::Circular, FlowLaw::QuadraticDrag { cn: 2.0, ct: 0.02 }),
        (Volume::Circular, FlowLaw::Momentum),
    ] {
        let mut before = arm();
        before.model = ModelOptions { volume, ..ModelOptions::default() };
        before.flow.law = law;
        for (name, change) in [CHANGES[8], CHANGES[11], CHANGES[14]] {
            let mut after = before.clone();
            change(&mut after);
            check(name, &before, &after);
        }
    }
}

/// A cable that turns one way: without a kink friction is solved as said.
#[test]
fn a_change_of_friction_is_seen() {
    let mut before = arm();
    before.reference.mu = 0.0.into();
    before.cables.truncate(1);
    (before.flow.speed, before.gravity) = (0.0, None);
    (before.tip, before.distributed) = Default::default();
    before.cables[0].offset = Profile::linear(0.005, 0.002);
    for motion in [Motion::In, Motion::Out] {
        before.cables[0] = before.cables[0].clone().with_friction(0.2, motion);
        let mut after = before.clone();
        after.cables[0].friction = 0.2002;
        check("friction", &before, &after);
    }
}
