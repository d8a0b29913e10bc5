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
//! The tension at a place hangs on all the turns before it, so that it is found in rounds: a shape for given turns,
//! the turns of that shape, and so on, see `rubbing`.

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

/// The turn of one cable.
#[derive(Debug)]
struct Turn {
    /// Phi at the left node of every element, its step there included.
    before: Vec<f64>,
    /// |chi'| at the stages of every element.
    rate: Vec<[f64; M]>,
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
    /// Of the engine's solution, whose stations are up to date.
    pub(crate) fn of(engine: &Engine) -> Result<Self, SectionFailure> {
        let equations = &engine.equations;
        let gauss = engine.system.gauss.clone();
        let mesh = &engine.solution.mesh;
        let mut cables = Vec::with_capacity(equations.arm().cables.len());
        for c in 0..equations.arm().cables.len() {
            let mut turn = Turn { before: Vec::new(), rate: Vec::new() };
            let mut turned = 0.0;
            for i in 0..mesh.elements() {
                turned += step_at(engine, c, i)?;
                turn.before.push(turned);
                let angles: [f64; M] = std::array::from_fn(|j| {
                    let (block, lane) = engine.solution.groups().at(i, j);
                    equations.cable_angle_in(c, block, &engine.system.stations()[block]).0[lane]
                });
                let slope = |j: usize| (0..M).map(|l| gauss.d[j][l] * angles[l]).sum::<f64>() / mesh.step(i);
                let rate: [f64; M] = std::array::from_fn(|j| slope(j).abs());
                for j in 0..M {
                    turned += mesh.step(i) * gauss.b[j] * rate[j];
                }
                turn.rate.push(rate);
            }
            cables.push(turn);
        }
        Ok(Self { gauss, nodes: mesh.nodes().to_vec(), cables })
    }

    /// Phi of cable `c` at `s` (over L).
    pub(crate) fn at(&self, c: usize, s: f64, from_left: bool) -> f64 {
        let turn = &self.cables[c];
        let last = self.nodes.len() - 2;
        let right = self.nodes.partition_point(|node| *node <= s).saturating_sub(1).min(last);
        let i = if from_left && right > 0 && self.nodes[right] == s { right - 1 } else { right };
        let h = self.nodes[i + 1] - self.nodes[i];
        let x = (s - self.nodes[i]) / h;
        let integrals = self.gauss.integrals(x);
        let mut turned = turn.before[i];
        for j in 0..M {
            turned += h * integrals[j] * turn.rate[i][j];
        }
        turned
    }
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

/// The step of cable `c`'s angle at the left node of element `i`, where another cable ends.
fn step_at(engine: &Engine, c: usize, i: usize) -> Result<f64, SectionFailure> {
    let (equations, mesh) = (&engine.equations, &engine.solution.mesh);
    let s = mesh.nodes()[i];
    let cables = equations.arm().cables.len();
    if i == 0 || !(0..cables).any(|c| (equations.cable_end(c) - s).abs() < 1e-9) {
        return Ok(0.0);
    }
    let [before, after] = [engine.beside_node(i, true)?, engine.beside_node(i, false)?];
    Ok((equations.cable_angle(c, s, &after) - equations.cable_angle(c, s, &before)).abs())
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
