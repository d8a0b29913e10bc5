//! The motion at any place along the arm.

use hydrostat_bvp::{Collocation, Groups, Mesh};

use super::dimensions::S;
use super::history::Snapshot;
use crate::statics::dimensions::{L, M};

/// The arm at one place and time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionStation {
    /// Arc length of the undeformed arm from the base, m.
    pub s: f64,
    /// Place of the centreline, m.
    pub x: f64,
    /// The same along e2.
    pub y: f64,
    /// Angle of the section, rad.
    pub theta: f64,
    /// Stretch.
    pub nu: f64,
    /// Shear.
    pub eta: f64,
    /// Bending, 1/m.
    pub mu: f64,
    /// Velocity of the centreline, m/s.
    pub velocity: [f64; 2],
    /// Rate of theta, rad/s.
    pub omega: f64,
}

/// The motion at `s` (m) of an arm of `length` (m) by the polynomials through nodes and stages of an element.
pub(super) fn station(
    at: &Snapshot,
    mesh: &Mesh,
    system: &Collocation<S, M, 0, L>,
    length: f64,
    s: f64,
) -> MotionStation {
    let place = (s / length).clamp(0.0, 1.0);
    let element = mesh.element_of(place).min(mesh.elements() - 1);
    let x = (place - mesh.nodes()[element]) / mesh.step(element);
    let (stages, ends) = system.gauss.cardinals_with_ends(x);
    let strain_weights = system.gauss.cardinals(x);
    let groups = Groups { elements: mesh.elements(), stages: M };
    let (mut value, mut rate, mut strain) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for (i, weight) in [(element, ends[0]), (element + 1, ends[1])] {
        let (own, own_rate) = (at.node::<3>(i), at.node_rate::<3>(i));
        for k in 0..3 {
            value[k] += weight * own[k];
            rate[k] += weight * own_rate[k];
        }
    }
    for (j, weight) in stages.iter().enumerate() {
        let (block, lane) = groups.at(element, j);
        let ([own, own_rate], [strains, _]) = (at.stage::<3>(block), at.strains::<4>(block));
        for k in 0..3 {
            value[k] += weight * own[k].0[lane];
            rate[k] += weight * own_rate[k].0[lane];
            strain[k] += strain_weights[j] * strains[k].0[lane];
        }
    }
    let ([theta, x, y], [omega, u, v], [nu, eta, mu]) = (value, rate, strain);
    MotionStation {
        s,
        x: x * length,
        y: y * length,
        theta,
        nu,
        eta,
        mu: mu / length,
        velocity: [u * length, v * length],
        omega,
    }
}
