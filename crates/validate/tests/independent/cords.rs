//! Cords: uniform rods held at the base that hang under loads of one direction, shot from the tip.
//!
//! With all loads along one direction d the force n_f = N d is known but for its size, and the rod is a pendulum: with phi the
//! angle from d, EI phi'' = N sin phi (N = w s with s from the tip, where nothing stretches or shears). Every shape that
//! does not wind belongs to one phi at the tip, however small it is: where w L^3/EI is 1e6, phi(L) is 1e-290, and what is
//! looked for is its logarithm. Strains are closed forms, because the angle to the force is all that they need.

use std::f64::consts::{FRAC_PI_2, PI};

use hydrostat::{Arm, Gravity, Profile, Volume};

use crate::dice::Dice;
use crate::march::{Motion, march};
use crate::mechanics::displaced;

/// A uniform solid rod of one material that hangs.
#[derive(Debug, Clone)]
pub(crate) struct Cord {
    pub(crate) arm: Arm,
    /// E, G = C2, Pa.
    young: f64,
    shear: f64,
    area: f64,
    /// E I, N m2.
    bending: f64,
    /// Direction of the load, rad.
    down: f64,
}

impl Cord {
    /// Of an arm that is one; its load is what acts at the base.
    pub(crate) fn new(arm: &Arm) -> Self {
        let hydrostat::Material::Homogeneous { young, poisson, shear_factor } = arm.material else {
            unreachable!("cords are homogeneous")
        };
        let radius = arm.radius.at(0.0, arm.length).value;
        let area = PI * radius * radius;
        let mut out = Self {
            arm: arm.clone(),
            young,
            shear: shear_factor * young / (2.0 * (1.0 + poisson)),
            area,
            bending: young * area * radius * radius / 4.0,
            down: 0.0,
        };
        let [x, y] = out.load(0.0, 1.0);
        out.down = y.atan2(x);
        out
    }

    /// Load per length at `s` where the stretch is `nu`.
    fn load(&self, s: f64, nu: f64) -> [f64; 2] {
        let arm = &self.arm;
        let weight = (arm.density - arm.flow.density * displaced(arm, nu)) * self.area;
        let gravity = arm.gravity.unwrap_or(Gravity { acceleration: 0.0, direction: 0.0 });
        let g = [gravity.direction.cos(), gravity.direction.sin()].map(|v| gravity.acceleration * v);
        [0, 1].map(|k| weight * g[k] + arm.distributed.force[k].at(s, arm.length).value)
    }

    /// The same along its direction, N/m.
    fn pull(&self, s: f64, nu: f64) -> f64 {
        let [x, y] = self.load(s, nu);
        x * self.down.cos() + y * self.down.sin()
    }

    /// nu and beta^2 of the section that carries `force` along a; `None` where none does.
    fn stretched(&self, force: f64) -> Option<[f64; 2]> {
        let t = force / (self.young * self.area);
        match self.arm.model.volume {
            // (nu - 1)/nu^2 = t.
            Volume::Planar => {
                let nu = 2.0 / (1.0 + (1.0 - 4.0 * t).sqrt());
                Some([nu, 1.0 / (nu * nu)]).filter(|[nu, _]| nu.is_finite())
            }
            Volume::Circular => (t < 1.0).then(|| [1.0 / (1.0 - t), 1.0 - t]),
            Volume::None => (t > -1.0).then_some([1.0 + t, 1.0]),
        }
    }

    /// E I over w L^3, about.
    pub(crate) fn heaviness(&self) -> f64 {
        self.pull(0.0, 1.0) * self.arm.length.powi(3) / self.bending
    }

    fn attempt(&self, logarithm: f64) -> Shot {
        let start = [logarithm.exp(), 0.0, 0.0, 0.0, 0.0];
        let mut hanging = Hanging { cord: self, breaks: false };
        match march(&mut hanging, 0.0, self.arm.length, start, 1e-12) {
            Some(end) => Shot::Arrives(end),
            None if hanging.breaks => Shot::Breaks,
            None => Shot::Winds,
        }
    }

    /// Angle from the load's direction at the base, two sums on the way, and how far the tip is along and across that direction.
    fn shot(&self, logarithm: f64) -> Option<[f64; 5]> {
        match self.attempt(logarithm) {
            Shot::Arrives(end) => Some(end),
            Shot::Breaks | Shot::Winds => None,
        }
    }

    /// Whether every section of the shape carries its force.
    pub(crate) fn has_shape(&self) -> bool {
        let wanted = (self.arm.base.angle - self.down).abs();
        let (mut low, mut high) = (-690.0, wanted.ln());
        let mut carried = true;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            // The straighter down, the more the base carries.
            match self.attempt(middle) {
                Shot::Arrives(end) if end[0] >= wanted => high = middle,
                Shot::Winds => high = middle,
                Shot::Arrives(_) => (low, carried) = (middle, true),
                Shot::Breaks => (low, carried) = (middle, false),
            }
        }
        carried
    }

    /// Tip and its angle.
    pub(crate) fn tip(&self) -> [f64; 3] {
        let wanted = self.arm.base.angle - self.down;
        let wanted = wanted - 2.0 * PI * (wanted / (2.0 * PI)).round();
        let (side, wanted) = (wanted.signum(), wanted.abs());
        // phi at the base grows with phi at the tip, and is the larger one.
        let (mut low, mut high) = (-690.0, wanted.ln());
        let off = |logarithm: f64| self.shot(logarithm).map_or(f64::INFINITY, |end| end[0].ln() - wanted.ln());
        let (mut below, mut above) = (off(low), off(high));
        assert!(below <= 0.0 && above >= 0.0, "no shape of {}: {below} {above}", self.arm.name);
        for round in 0..300 {
            if high - low < 1e-13 * low.abs().max(1.0) || above == 0.0 {
                break;
            }
            // Regula falsi by turns with halving.
            let fraction = if round % 2 == 0 && above.is_finite() { below / (below - above) } else { 0.5 };
            let middle = low + (high - low) * fraction.clamp(1e-3, 1.0 - 1e-3);
            let there = off(middle);
            if there > 0.0 {
                (high, above) = (middle, there);
            } else {
                (low, below) = (middle, there);
            }
        }
        let logarithm = if -below < above { low } else { high };
        let [_, _, _, along, across] = self.shot(logarithm).expect("shapes were found on both sides");
        let (sin, cos) = self.down.sin_cos();
        let base = &self.arm.base;
        // Angles to the right of the load's direction mirror those to the left.
        let across = side * across;
        let x = base.x + along * cos - across * sin;
        let y = base.y + along * sin + across * cos;
        [x, y, self.down + side * logarithm.exp()]
    }
}

enum Shot {
    Arrives([f64; 5]),
    /// A section carries no more.
    Breaks,
    Winds,
}

/// phi, -m L/EI, N, and how far the tip is from here along and across d; by the length from the tip.
struct Hanging<'a> {
    cord: &'a Cord,
    /// Whether the last section that was asked for has no strains.
    breaks: bool,
}

impl Motion<5> for Hanging<'_> {
    fn slopes(&mut self, t: f64, y: &[f64; 5]) -> Option<[f64; 5]> {
        let cord = self.cord;
        let [phi, moment, force, _, _] = *y;
        let (sin, cos) = phi.sin_cos();
        let stretched = cord.stretched(force * cos);
        self.breaks = stretched.is_none();
        let [nu, area] = stretched?;
        let eta = -force * sin / (cord.shear * cord.area * area);
        let turn = moment / (cord.arm.length * area);
        let lever = force * (nu * sin + eta * cos) * cord.arm.length / cord.bending;
        let pull = cord.pull(cord.arm.length - t, nu);
        Some([turn, lever, pull, nu * cos - eta * sin, nu * sin + eta * cos])
    }

    fn scale(&self, y: &[f64; 5]) -> [f64; 5] {
        let cord = self.cord;
        let length = cord.arm.length;
        let weight = cord.pull(0.0, 1.0) * length;
        // Relative to what is there: a tip's angle of 1e-290 has digits.
        let moment = y[1].abs().max(1e-3 * y[0].abs());
        [y[0].abs(), moment, weight, length, length.min(length * (y[0].abs() + 1e-3))]
    }

    fn lost(&self, y: &[f64; 5]) -> bool {
        // It winds.
        y[0] > 3.5
    }
}

/// A cord at random, its base within 60 degrees of level. `heaviest` bounds w L^3/EI.
pub(crate) fn cord(seed: u64, heaviest: f64) -> Cord {
    let mut dice = Dice::new(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5EED);
    loop {
        let (length, radius) = (dice.order(0.05, 2.0), dice.order(3e-4, 0.02));
        let volume = dice.pick(&[Volume::Planar, Volume::Circular, Volume::None]);
        // Axial force at the base over C1 A0. `planar` carries a quarter; beyond a third, shear lets straight cords to the side.
        let most = if volume == Volume::Planar { 0.2 } else { 0.25 };
        let axial = dice.order(1e-5, most);
        let heaviness = 4.0 * axial * (length / radius).powi(2);
        if !(0.1..heaviest).contains(&heaviness) {
            continue;
        }
        let density = dice.between(1020.0, 2000.0);
        let water = dice.chance(0.4);
        let by_weight = dice.chance(0.6);
        let net = if water { (density - 1000.0).max(50.0) } else { density };
        let density = if water { 1000.0 + net } else { density };
        // Where the water displaced follows the stretch, little stretch is much of a small net weight.
        if water && axial > 0.3 * net / 1000.0 {
            continue;
        }
        let young = if by_weight { net * 9.81 * length / axial } else { dice.order(1e4, 1e8) };
        let mut arm = Arm::cone(length, radius, radius, young, dice.between(0.3, 0.5));
        arm.name = format!("cord {seed}");
        arm.radius = radius.into();
        arm.density = density;
        arm.flow.density = if water { 1000.0 } else { 0.0 };
        arm.model.volume = volume;
        arm.base.angle = dice.between(-PI / 3.0, PI / 3.0);
        if by_weight {
            arm.gravity = Some(Gravity { acceleration: 9.81, direction: -FRAC_PI_2 });
        } else {
            let load = axial * young * PI * radius * radius / length;
            let turn = dice.between(-PI, PI);
            arm.base.angle += turn + FRAC_PI_2;
            let fraction = if dice.chance(0.5) { 1.0 } else { dice.between(0.3, 1.0) };
            let along = |v: f64| -> Profile {
                if fraction == 1.0 { (load * v).into() } else { Profile::linear(load * v, fraction * load * v) }
            };
            arm.distributed.force = [along(turn.cos()), along(turn.sin())];
        }
        let cord = Cord::new(&arm);
        if cord.heaviness() < heaviest {
            return cord;
        }
    }
}
