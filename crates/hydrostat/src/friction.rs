//! Cables that rub in their channels: the capstan law along an arm.
//!
//! A cable under the tension T that bears on its channel while it slides loses the coefficient of friction times
//! T times the angle that it turns through. With chi the angle of its tangent t_c in space,
//!
//! ```text
//! T(s) = T(0) exp(-+ friction Phi(s))     Phi(s) = integral of |chi'| over [0, s], with the steps of chi
//! chi' = mu + (tau_a tau_b' - tau_b tau_a') / |tau|^2
//! tau_a = nu - y beta mu                  tau_b = eta + (y beta)'          (above (5) of the source)
//! ```
//!
//! less towards the tip while reeling in, more while paying out. The body gets what the cable loses: the
//! distributed force (T t_c)' in place of T t_c', acting at the cable, which integrates to the same local law
//! (section 2 of `docs/model.md`) with the local T(s). At no friction it is the law without.
//!
//! The tension at a place follows all turns before it, so that it is found in rounds: a shape for given turns,
//! the turns of that shape, and so on, see `rubbing`. Where chi' changes its sign the tension has a kink, and the mesh a node.

use std::sync::Arc;

use hydrostat_bvp::Gauss;

use crate::arm::{Arm, Motion};
use crate::engine::{Engine, M};
use crate::equilibrium::{AtPlace, Equations, SectionFailure};

/// What friction leaves of the tensions, for turns that are a mixture of those of several shapes.
#[derive(Debug, Clone)]
pub(crate) struct Grip {
    /// The share of the friction that acts.
    pub(crate) of_friction: f64,
    /// What the exponent is by the turn, a cable.
    exponents: Vec<f64>,
    /// With weights that sum up to one.
    shapes: Vec<(f64, Arc<Turns>)>,
}

/// How far each cable has turned, along one shape.
#[derive(Debug)]
pub(crate) struct Turns {
    gauss: Gauss<M>,
    /// The mesh of the shape.
    nodes: Vec<f64>,
    cables: Vec<Turn>,
}

/// The stages and both ends of an element.
const POINTS: usize = M + 2;

/// The turn of one cable.
#[derive(Debug, Default)]
struct Turn {
    /// Phi at the left node of every element, its step there included.
    before: Vec<f64>,
    /// chi at the left end, the stages and the right end of every element.
    angles: Vec<[f64; POINTS]>,
    /// Where in an element (in [0, 1]) chi turns back, in order.
    extremes: Vec<Vec<f64>>,
}

/// What the exponent is by the turn, a cable, with a share of the friction: minus the friction while reeling in.
pub(crate) fn exponents(arm: &Arm, of_friction: f64) -> Vec<f64> {
    let sign = |motion| match motion {
        Motion::In => -1.0,
        Motion::Out => 1.0,
    };
    arm.cables.iter().map(|cable| sign(cable.motion) * of_friction * cable.friction).collect()
}

impl Turns {
    /// Of the engine's solution.
    pub(crate) fn of(engine: &Engine) -> Result<Self, SectionFailure> {
        let equations = &engine.equations;
        let gauss = engine.system.gauss.clone();
        let mesh = &engine.solution.mesh;
        let count = equations.arm().cables.len();
        let system = engine.at_present();
        let stations = system.stations();
        let mut cables: Vec<Turn> = (0..count).map(|_| Turn::default()).collect();
        let mut last: Vec<f64> = vec![0.0; count];
        for i in 0..mesh.elements() {
            let [left, right] = [engine.beside_node(i, false)?, engine.beside_node(i + 1, true)?];
            let ends = [(mesh.nodes()[i], &left, i), (mesh.nodes()[i + 1], &right, i + 1)];
            for (c, turn) in cables.iter_mut().enumerate() {
                let [first, end] =
                    ends.map(|(s, at, node)| engine.solution.nodes[node][0] + equations.cable_angle(c, s, at));
                let mut angles = [first; POINTS];
                for j in 0..M {
                    let (block, lane) = engine.solution.groups().at(i, j);
                    angles[1 + j] = equations.cable_angle_in(c, block, &stations[block]).0[lane];
                }
                angles[POINTS - 1] = end;
                // Where another cable ends the angle steps.
                let step = if i > 0 && equations.jumps_at(mesh.nodes()[i]) { (first - last[c]).abs() } else { 0.0 };
                let before = turn.before.last().copied().unwrap_or(0.0) + turn.over_last(&gauss) + step;
                turn.before.push(before);
                turn.extremes.push(extremes(&gauss, &angles));
                turn.angles.push(angles);
                last[c] = end;
            }
        }
        Ok(Self { gauss, nodes: mesh.nodes().to_vec(), cables })
    }

    /// Phi of cable `c` at `s` (over L).
    pub(crate) fn at(&self, c: usize, s: f64, from_left: bool) -> f64 {
        let turn = &self.cables[c];
        let last = self.nodes.len() - 2;
        let right = self.nodes.partition_point(|node| *node <= s).saturating_sub(1).min(last);
        let i = if from_left && right > 0 && self.nodes[right] == s { right - 1 } else { right };
        let x = (s - self.nodes[i]) / (self.nodes[i + 1] - self.nodes[i]);
        turn.before[i] + turn.within(&self.gauss, i, x)
    }

    /// Where chi of one of these cables turns back (over L): its tension has a kink there.
    pub(crate) fn kinks<'a>(&'a self, cables: &'a [usize]) -> impl Iterator<Item = f64> + 'a {
        cables.iter().flat_map(move |c| {
            let turn = &self.cables[*c];
            turn.extremes.iter().enumerate().flat_map(move |(i, own)| {
                own.iter().map(move |x| self.nodes[i] + x * (self.nodes[i + 1] - self.nodes[i]))
            })
        })
    }
}

impl Turn {
    /// How far chi turns over the last element.
    fn over_last(&self, gauss: &Gauss<M>) -> f64 {
        if self.angles.is_empty() { 0.0 } else { self.within(gauss, self.angles.len() - 1, 1.0) }
    }

    /// How far chi turns from the left end of element `i` to `x`: its variation.
    fn within(&self, gauss: &Gauss<M>, i: usize, x: f64) -> f64 {
        let angles = &self.angles[i];
        let (mut turned, mut from) = (0.0, angles[0]);
        let stops = self.extremes[i].iter().copied().filter(|stop| *stop < x).chain([x]);
        for stop in stops {
            let angle = value(gauss, angles, stop);
            turned += (angle - from).abs();
            from = angle;
        }
        turned
    }
}

/// The polynomial through stages and ends at `x`.
fn value(gauss: &Gauss<M>, angles: &[f64; POINTS], x: f64) -> f64 {
    let (at_stages, [left, right]) = gauss.cardinals_with_ends(x);
    let inner: f64 = at_stages.iter().zip(&angles[1..]).map(|(w, angle)| w * angle).sum();
    inner + left * angles[0] + right * angles[POINTS - 1]
}

/// Where the polynomial through stages and ends has an extreme value inside an element.
fn extremes(gauss: &Gauss<M>, angles: &[f64; POINTS]) -> Vec<f64> {
    const SAMPLES: u32 = 16;
    /// What of the turn is rounding.
    const ROUNDING: f64 = 1e-10;
    const NEAR: f64 = 1e-5;
    let spread = angles.iter().fold(0.0_f64, |m, angle| m.max((angle - angles[0]).abs()));
    let mut out = Vec::new();
    if spread < ROUNDING {
        return out;
    }
    let slope = |x: f64| value(gauss, angles, x + NEAR) - value(gauss, angles, x - NEAR);
    let mut before = (0.0, slope(0.0));
    for k in 1..=SAMPLES {
        let x = f64::from(k) / f64::from(SAMPLES);
        let now = (x, slope(x));
        if before.1 * now.1 < 0.0 {
            let (mut low, mut high) = (before, now);
            for _ in 0..40 {
                let middle = 0.5 * (low.0 + high.0);
                let there = slope(middle);
                if there * low.1 > 0.0 { low = (middle, there) } else { high = (middle, there) }
            }
            out.push(0.5 * (low.0 + high.0));
        }
        if now.1 != 0.0 {
            before = now;
        }
    }
    out
}

impl Grip {
    pub(crate) fn new(of_friction: f64, exponents: Vec<f64>, shapes: Vec<(f64, Arc<Turns>)>) -> Self {
        Self { of_friction, exponents, shapes }
    }

    /// The share of its tension that cable `c` has left at `s` (over L).
    fn share(&self, c: usize, s: f64, from_left: bool) -> f64 {
        let exponent = self.exponents[c];
        if exponent == 0.0 {
            return 1.0;
        }
        let turned: f64 = self.shapes.iter().map(|(weight, shape)| weight * shape.at(c, s, from_left)).sum();
        (exponent * turned).exp()
    }
}

impl Equations {
    /// Angle of cable `c` from the section normal at a place.
    fn cable_angle(&self, c: usize, s: f64, at: &AtPlace) -> f64 {
        let offset = self.offset(c, s);
        let [nu, eta, mu] = at.strain;
        let along = nu - offset.y * at.beta * mu;
        (eta + offset.slope * at.beta + offset.y * at.beta_slope).atan2(along)
    }

    /// Takes what friction leaves of the tensions, at every station.
    pub(crate) fn set_grip(&mut self, grip: Option<&Grip>) {
        self.grip = grip.cloned();
        self.take_pulls();
    }

    /// What friction leaves of the tension of cable `c` at `s`.
    pub(crate) fn pull_share(&self, c: usize, s: f64, from_left: bool) -> f64 {
        self.grip.as_ref().map_or(1.0, |grip| grip.share(c, s, from_left))
    }
}
