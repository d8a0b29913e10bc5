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
//! the turns of that shape, and so on, see `friction_iteration`. Where chi' changes its sign the tension has a kink,
//! and the mesh a node.

use std::sync::Arc;

use hydrostat_bvp::Gauss;

use crate::rod::arm::{Arm, Motion};
use crate::statics::dimensions::M;

/// What friction leaves of the tensions, for turns that are a mixture of those of several shapes.
#[derive(Debug, Clone)]
pub(crate) struct CapstanFactors {
    /// The fraction of the friction that acts.
    pub(crate) of_friction: f64,
    /// What the exponent is by the turn, a cable.
    exponents: Vec<f64>,
    /// With weights that sum up to one.
    shapes: Vec<(f64, Arc<WrapAngles>)>,
}

/// How far each cable has turned, along one shape.
#[derive(Debug)]
pub(crate) struct WrapAngles {
    gauss: Gauss<M>,
    /// The mesh of the shape.
    nodes: Vec<f64>,
    cables: Vec<Turn>,
}

/// The stages and both ends of an element.
pub(crate) const POINTS: usize = M + 2;

/// The turn of one cable.
#[derive(Debug, Default)]
struct Turn {
    /// Phi at the left node of every element, its step there included.
    before: Vec<f64>,
    /// chi at the left end, the stages and the right end of every element.
    angles: Vec<[f64; POINTS]>,
    /// Which way every element turns, see [`parts`].
    parts: Vec<Vec<(f64, f64)>>,
    /// Where chi turns back (over L), in order.
    kinks: Vec<f64>,
}

/// What the exponent is by the turn, a cable, with a fraction of the friction: minus the friction while reeling in.
pub(crate) fn exponents(arm: &Arm, of_friction: f64) -> Vec<f64> {
    let sign = |motion| match motion {
        Motion::In => -1.0,
        Motion::Out => 1.0,
    };
    arm.cables.iter().map(|cable| sign(cable.motion) * of_friction * cable.friction).collect()
}

impl WrapAngles {
    /// Of cables with these angles in space on the mesh of these nodes, given the nodes at which the data break, and
    /// those at which the angles step.
    pub(crate) fn new(
        gauss: Gauss<M>,
        nodes: Vec<f64>,
        angles: Vec<Vec<[f64; POINTS]>>,
        breaks: &[bool],
        steps: &[bool],
    ) -> Self {
        let cables = angles.into_iter().map(|own| Turn::new(&gauss, &nodes, own, breaks, steps)).collect();
        Self { gauss, nodes, cables }
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

    /// What kinks inside of elements cost at most (tip over L, to first order), for cables with these exponents by the
    /// turn, 0 for those that are slack.
    ///
    /// Beside a kink chi' = c' x. A polynomial across it, at the distance d from the node, misses c' d^2 of the turn,
    /// which changes the tension by the exponent times that, and the direction of the tip by what the cable turns times
    /// that. Beside a node on the kink d is the thickness of the layers (see [`parts`]), and what is missed is of third
    /// order.
    pub(crate) fn off_nodes(&self, exponents: &[f64]) -> f64 {
        let of_cable = |(c, exponent): (usize, &f64)| {
            if *exponent == 0.0 {
                return 0.0;
            }
            let turn = &self.cables[c];
            let missed: f64 = turn
                .kinks_inside()
                .map(|(i, x)| {
                    let step = self.nodes[i + 1] - self.nodes[i];
                    let (distance, node) = if x < 0.5 { (x, self.nodes[i]) } else { (1.0 - x, self.nodes[i + 1]) };
                    let nearest =
                        turn.kinks.iter().map(|kink| (kink - node).abs() / step).fold(f64::INFINITY, f64::min);
                    let layers = nearest < 0.5 * distance;
                    let missed = if layers { distance.powi(3) * step + nearest * nearest } else { distance * distance };
                    curvature(&self.gauss, &turn.angles[i], x).abs() * missed
                })
                .sum();
            exponent.abs() * missed * self.at(c, 1.0, true)
        };
        exponents.iter().enumerate().map(of_cable).sum()
    }
}

/// Kinks nearer to each other (over L) are one: no element is to be shorter than the layers beside kinks, where chi' is
/// no polynomial. The turn in between is of third order in their distance, what a node beside a kink costs of second.
const APART: f64 = 5e-5;

/// How far beyond a node the polynomial of the element beside counts, over the shorter of the two elements that meet
/// there.
const BESIDE: f64 = 0.4;

impl Turn {
    /// Of a cable with these angles, on a mesh of which some nodes are breaks of the data, and some of these steps of
    /// chi.
    fn new(gauss: &Gauss<M>, nodes: &[f64], angles: Vec<[f64; POINTS]>, breaks: &[bool], steps: &[bool]) -> Self {
        let kinks = kinks(gauss, nodes, &angles, breaks);
        let mut out = Self { before: Vec::new(), angles, parts: Vec::new(), kinks };
        out.parts = out.angles.iter().map(|angles| parts(gauss, angles)).collect();
        let mut passed = 0.0;
        for i in 0..nodes.len() - 1 {
            if i > 0 {
                // Where another cable ends the angle steps; elsewhere a step is a layer thinner than any element, which
                // turns as its surroundings do.
                let step = out.angles[i][0] - out.angles[i - 1][POINTS - 1];
                passed += if steps[i] { step.abs() } else { step * out.parts[i][0].1 };
            }
            out.before.push(passed);
            passed += out.within(gauss, i, 1.0);
        }
        out
    }

    /// Elements, and where in them chi turns back.
    fn kinks_inside(&self) -> impl Iterator<Item = (usize, f64)> {
        self.parts.iter().enumerate().flat_map(|(i, parts)| parts[1..].iter().map(move |(x, _)| (i, *x)))
    }

    /// How far chi turns from the left end of element `i` to `x`.
    fn within(&self, gauss: &Gauss<M>, i: usize, x: f64) -> f64 {
        let (angles, parts) = (&self.angles[i], &self.parts[i]);
        let mut turned = 0.0;
        for (k, (from, sense)) in parts.iter().enumerate() {
            if *from > x {
                break;
            }
            let to = parts.get(k + 1).map_or(x, |next| next.0.min(x));
            turned += sense * (value(gauss, angles, to) - value(gauss, angles, *from));
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

/// Where chi turns back (over L), in order.
///
/// There T' = 0 and T'' jumps, T'' = -+ friction T |chi'|'. Through nu' and beta'' it is in chi', which jumps with it:
///
/// ```text
/// chi' = c +- r c'     before and after the kink, r some micrometres and of either sign
/// ```
///
/// with c what chi' would be without. So the polynomial before a node on the kink has its extreme by r to one side of
/// it, and the one behind by r to the other: both in their elements, or none. The kink is where c = 0, and c at a node
/// is the mean of both sides. With the distance from the node the part of the other side's polynomial falls to nothing,
/// so that what changes its sign is continuous and no change is lost or found twice.
fn kinks(gauss: &Gauss<M>, nodes: &[f64], angles: &[[f64; POINTS]], breaks: &[bool]) -> Vec<f64> {
    const SAMPLES: u32 = 24;
    let count = angles.len();
    let step = |i: usize| nodes[i + 1] - nodes[i];
    let turns: Vec<bool> = angles.iter().map(turns).collect();
    // chi' by the polynomial of element `i`, which may be asked beyond its ends.
    let slope =
        |i: usize, s: f64| if turns[i] { slope(gauss, &angles[i], (s - nodes[i]) / step(i)) / step(i) } else { 0.0 };
    // The part that the polynomial across a node has at a distance from it.
    let part = |node: usize, distance: f64| {
        if node == 0 || node == count || breaks[node] {
            return 0.0;
        }
        0.5 * (1.0 - distance / (BESIDE * step(node - 1).min(step(node)))).max(0.0)
    };
    let blended = |i: usize, s: f64| {
        let own = slope(i, s);
        let (left, right) = (part(i, s - nodes[i]), part(i + 1, nodes[i + 1] - s));
        let before = if left > 0.0 { left * (slope(i - 1, s) - own) } else { 0.0 };
        let behind = if right > 0.0 { right * (slope(i + 1, s) - own) } else { 0.0 };
        own + before + behind
    };
    let mut out = Vec::new();
    let mut before = (0.0, 0.0);
    for i in 0..count {
        if breaks[i] {
            before.1 = 0.0;
        }
        for k in 0..=SAMPLES {
            let s = nodes[i] + step(i) * f64::from(k) / f64::from(SAMPLES);
            let now = (s, blended(i, s));
            if before.1 * now.1 < 0.0 {
                let at = |s: f64| blended(if s < nodes[i] { i - 1 } else { i }, s);
                out.push(change_of_sign([before.0, now.0], before.1, at));
            }
            if now.1 != 0.0 {
                before = now;
            }
        }
    }
    merged(&out, |count| count % 2 == 1)
}

/// Where `of` changes its sign between two places, at the first of which it is `first`, by halving.
fn change_of_sign([mut low, mut high]: [f64; 2], first: f64, of: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if of(middle) * first > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Changes of sign in order, those nearer to each other than [`APART`] as one in their middle, if their number counts.
pub(crate) fn merged(places: &[f64], counts: impl Fn(usize) -> bool) -> Vec<f64> {
    let clusters = places.chunk_by(|a, b| b - a < APART);
    clusters.filter(|own| counts(own.len())).map(|own| 0.5 * (own[0] + own[own.len() - 1])).collect()
}

/// The parts of an element in which chi turns one way: where each begins (in [0, 1]), and its sign.
///
/// Beside a kink at a node chi' = c +- r c' (see [`kinks`]). For r > 0 this is the solution outside of layers of the
/// thickness r on both sides, in which |chi'| = c' (|x| - r + r exp(-|x|/r)): these turn by c' r^2 more each, as the
/// absolute value of the polynomials does.
fn parts(gauss: &Gauss<M>, angles: &[f64; POINTS]) -> Vec<(f64, f64)> {
    const SAMPLES: u32 = 24;
    let mut begins = vec![0.0];
    if turns(angles) {
        let mut before = (0.0, slope(gauss, angles, 0.0));
        for k in 1..=SAMPLES {
            let x = f64::from(k) / f64::from(SAMPLES);
            let now = (x, slope(gauss, angles, x));
            if before.1 * now.1 < 0.0 {
                begins.push(change_of_sign([before.0, now.0], before.1, |x| slope(gauss, angles, x)));
            }
            before = now;
        }
    }
    let sense = |k: usize| {
        let (from, to) = (begins[k], begins.get(k + 1).copied().unwrap_or(1.0));
        if value(gauss, angles, to) < value(gauss, angles, from) { -1.0 } else { 1.0 }
    };
    (0..begins.len()).map(|k| (begins[k], sense(k))).collect()
}

/// Second derivative of the polynomial through stages and ends at `x`.
fn curvature(gauss: &Gauss<M>, angles: &[f64; POINTS], x: f64) -> f64 {
    const NEAR: f64 = 1e-2;
    let [before, here, behind] = [x - NEAR, x, x + NEAR].map(|x| value(gauss, angles, x));
    (before - 2.0 * here + behind) / (NEAR * NEAR)
}

/// Whether chi turns in an element by more than rounding.
fn turns(angles: &[f64; POINTS]) -> bool {
    const ROUNDING: f64 = 1e-10;
    angles.iter().any(|angle| (angle - angles[0]).abs() >= ROUNDING)
}

/// Slope of the polynomial through stages and ends at `x`.
fn slope(gauss: &Gauss<M>, angles: &[f64; POINTS], x: f64) -> f64 {
    const NEAR: f64 = 1e-5;
    (value(gauss, angles, x + NEAR) - value(gauss, angles, x - NEAR)) / (2.0 * NEAR)
}

impl CapstanFactors {
    pub(crate) fn new(of_friction: f64, exponents: Vec<f64>, shapes: Vec<(f64, Arc<WrapAngles>)>) -> Self {
        Self { of_friction, exponents, shapes }
    }

    /// Where the tensions of these cables have kinks (over L), by the last of the shapes: in the end all of them have
    /// the same.
    pub(crate) fn kinks<'a>(&'a self, cables: &'a [usize]) -> impl Iterator<Item = f64> + 'a {
        let last = self.shapes.last();
        last.into_iter().flat_map(|(_, shape)| cables.iter().flat_map(|c| shape.cables[*c].kinks.iter().copied()))
    }

    /// The fraction of its tension that cable `c` has left at `s` (over L).
    pub(crate) fn tension_ratio(&self, c: usize, s: f64, from_left: bool) -> f64 {
        let exponent = self.exponents[c];
        if exponent == 0.0 {
            return 1.0;
        }
        let turned: f64 = self.shapes.iter().map(|(weight, shape)| weight * shape.at(c, s, from_left)).sum();
        (exponent * turned).exp()
    }
}
