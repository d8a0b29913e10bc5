//! Balance of the whole arm and of every part of it.

use hydrostat::{
    Arm, Cable, Cavity, Displaced, EnteringSpeed, FlowLaw, FlowSurface, Gravity, Hydrostatics, ModelOptions, Options,
    Profile, Solver, Volume, WettedLength,
};
use hydrostat_validate::balance::residuals;

fn check(arm: &Arm) {
    let solved = Solver::new(arm, Options::default()).unwrap().solve().unwrap_or_else(|e| panic!("{}: {e}", arm.name));
    let off = residuals(&solved);
    eprintln!("{:32} {off:?}", arm.name);
    assert!(off.whole < 1e-6 && off.parts < 1e-6 && off.law < 1e-7, "{}: {off:?}", arm.name);
}

fn silicone(name: &str) -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    name.clone_into(&mut arm.name);
    arm.density = 1080.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1));
    arm
}

#[test]
fn cables_alone() {
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        let mut arm = silicone("cables alone");
        arm.model.volume = volume;
        check(&arm);
    }
}

#[test]
fn streams_from_all_sides() {
    for direction in [0.0, 0.7, 1.5, -1.2] {
        let mut arm = silicone("stream");
        arm.flow.speed = 0.12;
        arm.flow.direction = direction;
        check(&arm);
    }
}

/// The tip curls past the stream: the normal speed changes sign on the way.
#[test]
fn a_curled_arm_with_kinked_loads() {
    for (tension, direction) in [(0.9, 0.2), (0.9, 0.5), (0.8, 0.35)] {
        let mut arm = silicone("kinks");
        arm.cables[0].tension = tension;
        arm.cables[1].tension = 0.0;
        arm.flow.speed = 0.03;
        arm.flow.direction = direction;
        let tip = arm.solve().unwrap().tip();
        assert!(direction > 0.0 && tip.theta + tip.alpha > direction, "{tip:?} does not pass the stream");
        check(&arm);
    }
}

#[test]
fn weight_and_buoyancy() {
    for (density, direction) in [(1080.0, -1.57), (1300.0, -0.4), (900.0, 0.9)] {
        let mut arm = silicone("weight");
        arm.density = density;
        arm.gravity = Some(Gravity { acceleration: 9.81, direction });
        check(&arm);
    }
}

#[test]
fn hollow_arms_flooded_and_sealed() {
    for cavity in [Cavity::Flooded, Cavity::Sealed] {
        let mut arm = silicone("hollow");
        arm.inner_radius = Profile::linear(0.006, 0.001);
        arm.cavity = cavity;
        arm.gravity = Some(Gravity::default());
        arm.flow.speed = 0.05;
        arm.flow.direction = 0.5;
        arm.base.x = 0.3;
        arm.base.y = -0.2;
        arm.base.angle = 0.8;
        check(&arm);
    }
}

#[test]
fn quadratic_drag() {
    let mut arm = silicone("quadratic drag");
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.005 };
    arm.flow.speed = 0.15;
    arm.flow.direction = 1.3;
    check(&arm);
}

#[test]
fn loads_on_the_tip_and_along_the_arm() {
    let mut arm = silicone("tip and distributed loads");
    arm.tip.force = [0.01, -0.004];
    arm.tip.moment = 2e-5;
    arm.tip.follower = [-0.003, 0.002];
    arm.distributed.force = [Profile::linear(0.01, -0.02), Profile::linear(0.0, 0.05)];
    arm.distributed.couple = 1e-4.into();
    arm.base.angle = -0.3;
    // At 0.731 of the full tensions this arm snaps.
    arm.cables[0].tension = 0.3;
    check(&arm);
}

#[test]
fn tables_shorter_cables_and_unloaded_strains() {
    let mut arm = silicone("tables and short cables");
    arm.radius = Profile::table(&[[0.0, 0.012], [0.06, 0.010], [0.15, 0.006], [0.245, 0.003]]).unwrap();
    arm.cables[0].offset = 0.0025.into();
    arm.cables[1].offset = (-0.004).into();
    arm.cables[1].end = 0.45;
    arm.cables[1].tension = 0.4;
    arm.reference.mu = Profile::linear(2.0, -1.0);
    arm.reference.nu = Profile::linear(1.0, 1.02);
    arm.flow.speed = 0.05;
    arm.flow.direction = 0.8;
    check(&arm);
}

/// Where the load jumps a rule that bisects comes no nearer than its last halving: the balance of this arm was 4.7e-5 off for that
/// alone. What is left is the gap within which the place of the jump is open, at any tolerance.
#[test]
fn the_balance_across_a_jump_is_off_by_its_gap_alone() {
    let mut arm = silicone("literal, with a jump");
    arm.flow.density = 1022.0;
    arm.flow.speed = 0.05;
    arm.flow.direction = 1.1;
    arm.gravity = Some(Gravity::default());
    (arm.cables[0].tension, arm.cables[1].tension) = (0.3, 0.0);
    arm.model = ModelOptions::LITERAL;
    for tol in [1e-8, 1e-10] {
        let off = residuals(&Solver::new(&arm, Options::with_tol(tol)).unwrap().solve().unwrap());
        println!("{tol:e}: {off:?}");
        assert!(off.whole < 1.5e-6 && off.parts < 1.5e-6 && off.law < 1e-9, "{tol:e}: {off:?}");
    }
}

#[test]
fn other_readings() {
    let mut arm = silicone("deformed length, mean square");
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.1;
    arm.gravity = Some(Gravity::default());
    arm.model.wetted_length = WettedLength::Deformed;
    arm.model.layer_mean = hydrostat::LayerMean::Momentum;
    check(&arm);
    arm.cables[0].tension = 0.2;
    for (name, readings) in [
        ("normal-only", ModelOptions { hydrostatics: Hydrostatics::NormalOnly, ..ModelOptions::default() }),
        ("resultant", ModelOptions { entering_speed: EnteringSpeed::Resultant, ..ModelOptions::default() }),
        ("lateral", ModelOptions { flow_surface: FlowSurface::Lateral, ..ModelOptions::default() }),
        ("section", ModelOptions { displaced: Displaced::Section, ..ModelOptions::default() }),
        ("none", ModelOptions { volume: Volume::None, ..ModelOptions::default() }),
        ("literal", ModelOptions::LITERAL),
    ] {
        name.clone_into(&mut arm.name);
        arm.model = readings;
        check(&arm);
    }
    // Without a stream neither side is windward: the mean of both.
    "literal in still water".clone_into(&mut arm.name);
    arm.flow.speed = 0.0;
    check(&arm);
}
