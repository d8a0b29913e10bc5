//! Arms at random, of every option, with loads from nothing to extremes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use hydrostat::{
    Arm, Cable, Cavity, EnteringSpeed, FlowLaw, FlowSurface, Gravity, Hydrostatics, LayerMean, Material, ModelOptions,
    Motion, Profile, Support, Volume, WettedLength,
};

use crate::dice::Dice;

/// What an arm at random is drawn from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Draw {
    /// Most orders of magnitude of loads over those that bend an arm by about one.
    pub(crate) extreme: f64,
    pub(crate) friction: bool,
    pub(crate) strokes: bool,
    /// ModelOptions whose loads can jump.
    pub(crate) jumps: bool,
}

impl Draw {
    pub(crate) const ALL: Self = Self { extreme: 6.0, friction: true, strokes: true, jumps: true };
}

/// The arm of this seed.
pub(crate) fn arm(seed: u64, draw: &Draw) -> Arm {
    let mut dice = Dice::new(seed.wrapping_mul(0x2545_F491_4F6C_DD1D));
    let dice = &mut dice;
    let length = dice.order(0.01, 3.0);
    let thick = length * dice.order(0.002, 0.1);
    let mut arm = Arm::cone(length, thick, thick, 1.0, 0.5);
    arm.name = format!("seed {seed}");
    arm.radius = radius(dice, length, thick);
    geometry(dice, &mut arm);
    readings(dice, &mut arm, draw);
    // E I at the base, and EI/L^2: the force that bends by about one.
    let bending = stiffness(&arm);
    let force = bending / (length * length);
    cables(dice, &mut arm, bending, draw);
    loads(dice, &mut arm, force, draw);
    arm
}

/// E I at the base, N m2.
pub(crate) fn stiffness(arm: &Arm) -> f64 {
    let (outer, inner) = (arm.radius.at(0.0, arm.length).value, arm.inner_radius.at(0.0, arm.length).value);
    let wall = PI * (outer * outer - inner * inner);
    match &arm.material {
        Material::Homogeneous { young, .. } => young * (outer * outer + inner * inner) / 4.0 * wall,
        Material::Coefficients { c3, .. } => c3.at(0.0, arm.length).value * wall,
    }
}

fn radius(dice: &mut Dice, length: f64, thick: f64) -> Profile {
    let tip = match dice.index(10) {
        0 => 1e-6_f64.min(thick),
        1..4 => thick,
        _ => thick * dice.order(0.03, 1.0),
    };
    match dice.index(10) {
        0 => thick.into(),
        1 | 2 => {
            let inner = 1 + dice.index(4);
            let mut points = vec![[0.0, thick]];
            for k in 1..=inner {
                let fraction = (k as f64 + dice.between(-0.3, 0.3)) / (inner + 1) as f64;
                points.push([fraction * length, (thick + fraction * (tip - thick)) * dice.between(0.8, 1.2)]);
            }
            points.push([length, tip]);
            Profile::table(&points).expect("places increase")
        }
        _ => Profile::linear(thick, tip),
    }
}

fn geometry(dice: &mut Dice, arm: &mut Arm) {
    arm.base.x = dice.between(-0.1, 0.1);
    arm.base.y = dice.between(-0.1, 0.1);
    arm.base.angle =
        if dice.chance(0.3) { dice.pick(&[0.0, FRAC_PI_2, -FRAC_PI_2, PI]) } else { dice.between(-PI, PI) };
    arm.density = dice.between(300.0, 2500.0);
    if dice.chance(0.2) {
        let fraction = dice.between(0.2, 0.9);
        arm.inner_radius = scaled(&arm.radius, fraction);
        arm.cavity = dice.pick(&[Cavity::Flooded, Cavity::Sealed]);
    }
    let young = dice.order(3e3, 3e7);
    if dice.chance(0.3) {
        let thick = arm.radius.at(0.0, arm.length).value;
        let [c1, c2, c3] =
            [young, young * dice.between(0.1, 0.6), young * thick * thick * dice.between(0.15, 0.6)].map(|value| {
                if dice.chance(0.5) { value.into() } else { Profile::linear(value, value * dice.between(0.4, 1.5)) }
            });
        arm.material = Material::Coefficients { c1, c2, c3 };
    } else {
        arm.material = Material::Homogeneous {
            young,
            poisson: dice.between(0.0, 0.5),
            shear_factor: dice.pick(&[1.0, 0.9, 5.0 / 6.0]),
        };
    }
    if dice.chance(0.2) {
        let bend = 2.0 / arm.length;
        arm.reference.mu = Profile::linear(dice.between(-bend, bend), dice.between(-bend, bend));
        if dice.chance(0.3) {
            arm.reference.nu = Profile::linear(dice.between(0.95, 1.05), dice.between(0.95, 1.05));
            arm.reference.eta = dice.between(-0.03, 0.03).into();
        }
    }
}

fn scaled(profile: &Profile, factor: f64) -> Profile {
    match profile {
        Profile::Constant(value) => Profile::Constant(value * factor),
        Profile::Linear { base, tip } => Profile::linear(base * factor, tip * factor),
        Profile::Table(table) => {
            let points: Vec<[f64; 2]> = table.points().map(|[s, value]| [s, value * factor]).collect();
            Profile::table(&points).expect("places increase")
        }
    }
}

fn readings(dice: &mut Dice, arm: &mut Arm, draw: &Draw) {
    let mut readings = ModelOptions {
        volume: dice.pick(&[Volume::Planar, Volume::Planar, Volume::Circular, Volume::None]),
        ..ModelOptions::default()
    };
    if dice.chance(0.3) {
        readings.layer_mean = dice.pick(&LayerMean::ALL);
        readings.wetted_length = dice.pick(&WettedLength::ALL);
        readings.hydrostatics = dice.pick(&Hydrostatics::ALL);
    }
    if draw.jumps && dice.chance(0.15) {
        readings.flow_surface = dice.pick(&FlowSurface::ALL);
        readings.entering_speed = dice.pick(&EnteringSpeed::ALL);
    }
    if dice.chance(0.03) {
        readings.support = Support::UnstrainedBase;
    }
    arm.model = readings;
}

fn cables(dice: &mut Dice, arm: &mut Arm, bending: f64, draw: &Draw) {
    let count = match dice.index(20) {
        0..4 => 0,
        4..9 => 1,
        9..15 => 2,
        15..18 => 3 + dice.index(3),
        18 => 6 + dice.index(6),
        _ => 20,
    };
    let rubs = draw.friction && dice.chance(0.25);
    let held = draw.strokes && dice.chance(0.2);
    let thick = arm.radius.at(0.0, arm.length).value;
    for i in 0..count {
        let end = if dice.chance(0.3) { dice.between(0.2, 1.0) } else { 1.0 };
        let side = dice.sign();
        let fraction = side * dice.between(0.1, 0.95);
        let tip = arm.radius.at(end * arm.length, arm.length).value;
        let thinnest = (0..=50).map(|k| arm.radius.at(end * arm.length * f64::from(k) / 50.0, arm.length).value);
        let thinnest = thinnest.fold(f64::INFINITY, f64::min);
        let offset = match dice.index(4) {
            0 => (fraction * thinnest).into(),
            1 if matches!(arm.radius, Profile::Linear { .. }) => {
                // Another fraction of the radius at the tip: a cable that changes sides, too.
                let other = if dice.chance(0.3) { -fraction } else { side * dice.between(0.05, 0.95) };
                let last = arm.radius.at(arm.length, arm.length).value;
                Profile::linear(fraction * thick, other * last)
            }
            _ => scaled(&arm.radius, fraction),
        };
        let mut cable = Cable::new(format!("cable {i}"), offset);
        cable.end = end;
        if dice.chance(0.85) {
            // What bends by about one, and what the section at the anchor carries.
            let bends = bending / (fraction.abs() * thick * arm.length) / (1.0 + count as f64).sqrt();
            let carries = bending * 4.0 * tip * tip / thick.powi(4) / count as f64;
            cable.tension = (dice.order(0.01, 6.0) * bends).min(dice.order(0.01, 0.5) * carries);
        }
        if rubs && dice.chance(0.7) {
            cable.friction = dice.order(0.01, 1.0);
            cable.motion = dice.pick(&[Motion::In, Motion::Out]);
        }
        if held && dice.chance(0.5) {
            let bent = fraction.abs() * thick;
            cable.stroke = Some(if dice.chance(0.7) { bent * dice.between(0.0, 1.5) } else { -bent * dice.fraction() });
            cable.stroke = cable.stroke.map(|stroke| stroke.clamp(-0.5 * arm.length, 0.5 * arm.length));
            if dice.chance(0.5) {
                cable.stiffness = Some(dice.order(0.1, 1e4) * bending / (thick * arm.length));
            }
        }
        arm.cables.push(cable);
    }
}

fn loads(dice: &mut Dice, arm: &mut Arm, force: f64, draw: &Draw) {
    // Loads over those that bend by about one: mostly moderate, some extreme.
    let strength = |dice: &mut Dice| {
        if dice.chance(0.2) { dice.order(1.0, 10.0_f64.powf(draw.extreme)) } else { dice.order(1e-3, 10.0) }
    };
    let length = arm.length;
    let diameter = 2.0 * arm.radius.at(0.0, length).value;
    arm.flow.density = dice.pick(&[0.0, 1000.0, 1000.0, 1022.0]);
    if dice.chance(0.55) {
        if dice.chance(0.4) {
            arm.flow.law =
                FlowLaw::QuadraticDrag { cn: dice.between(0.5, 3.0), ct: dice.pick(&[0.0, 0.005, 0.03, 0.1]) };
        }
        arm.flow.density = arm.flow.density.max(1000.0);
        arm.flow.direction = if dice.chance(0.3) {
            arm.base.angle + dice.pick(&[FRAC_PI_2, -FRAC_PI_2, 1.0, 0.5])
        } else {
            dice.between(-PI, PI)
        };
        // Ca = 1/2 rho C_n D U^2 L^3/EI.
        let most = 10.0_f64.powf(draw.extreme + 1.0);
        let number = if dice.chance(0.15) { dice.order(1.0, most) } else { dice.order(1e-2, 30.0) };
        arm.flow.speed = (number * force / (0.5 * arm.flow.density * 2.0 * diameter * length)).sqrt();
    }
    if dice.chance(0.5) {
        let wall = arm.density * PI * (0.5 * diameter).powi(2);
        let acceleration = if dice.chance(0.5) { 9.81 } else { strength(dice) * force / (wall * length).max(1e-300) };
        // No more than a straight arm of this section could carry along itself by a good part.
        let most = 0.15 * force * length * length * 16.0 / (diameter * diameter) / (wall * length);
        let acceleration = acceleration.min(most);
        let direction = if dice.chance(0.6) { -FRAC_PI_2 } else { dice.between(-PI, PI) };
        arm.gravity = Some(Gravity { acceleration, direction });
    }
    if dice.chance(0.3) {
        // A thin tip carries little.
        let tip = arm.radius.at(length, length).value / (0.5 * diameter);
        let size = dice.order(1e-3, 10.0) * force * tip.powi(3);
        let angle = dice.between(0.0, TAU);
        match dice.index(3) {
            0 => arm.tip.force = [size * angle.cos(), size * angle.sin()],
            1 => arm.tip.follower = [0.3 * size * angle.cos(), 0.3 * size * angle.sin()],
            _ => arm.tip.moment = dice.sign() * 0.3 * size * length * tip,
        }
    }
    if dice.chance(0.25) {
        let size = strength(dice).min(1e3) * force / length;
        let mut along = |scale: f64| {
            let (base, tip) = (dice.between(-scale, scale), dice.between(-scale, scale));
            if dice.chance(0.3) {
                let points = [[0.0, base], [0.4 * length, tip], [0.7 * length, 0.5 * base], [length, 0.0]];
                Profile::table(&points).expect("places increase")
            } else {
                Profile::linear(base, 0.1 * tip)
            }
        };
        arm.distributed.force = [along(size), along(size)];
        arm.distributed.couple = along(0.1 * size.min(3.0 * force / length) * length);
    }
}
