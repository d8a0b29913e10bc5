//! Kinks of the stream's load in space, and nodes that follow them.
//!
//! Where U_t changes sign, the curvature of |V_t| V_t jumps. |U_p| is a cone: an arm in the plane of the stream
//! passes through its apex, which is the planar kink where U_n changes sign; off the plane an arm passes at a
//! distance, within a length
//! |U_p|/|U_p'| that elements
//! have to resolve. Nodes go where U_t changes sign, and where |U_p| is least.

use hydrostat_bvp::{LANES, each};

use super::engine::Engine;
use super::equations::M;
use super::loads::Tangent;
use super::rotation::{Vector, dot};
use crate::statics::engine::{at_jumps, end_beside, zero_beside};

/// How close (over L) nodes are kept to the kinks of the load at a tolerance: closer than in the plane, so that what
/// the estimate does not see is less.
pub(super) fn kink_resolution(tolerance: f64, jumps: bool) -> f64 {
    let resolution = (0.002 * tolerance.sqrt()).max(5e-8);
    if jumps { resolution.min(at_jumps(tolerance)) } else { resolution }
}

/// Kinks that nodes are placed on, as in the plane.
const MOST: usize = 500;

/// Places of an element between which changes of sign are looked for.
const SAMPLES: usize = 8;

/// |U_p| over |U| at its least from which on the cone is wide enough for elements of any mesh.
const FAR: f64 = 0.3;

/// Speeds over that of the stream below which all of an element lies along it, or across.
const NOTHING: f64 = 1e-6;

impl Engine {
    /// Brings the stations and the speeds there up to date with the solution.
    pub(super) fn take_speeds(&mut self) {
        self.system.take_stations(&self.solution);
        let stations = self.system.stations().iter().enumerate();
        self.speeds.clear();
        self.speeds.extend(stations.map(|(block, station)| self.equations.speeds(block, station)));
    }

    /// U_t and U_p at the stages of element `i`.
    fn speeds_of(&self, i: usize) -> [[f64; M]; 4] {
        let (first, lane) = (i / LANES * M, i % LANES);
        let own = &self.speeds[first..first + M];
        [
            each(|j| own[j].0.0[lane]),
            each(|j| own[j].1[0].0[lane]),
            each(|j| own[j].1[1].0[lane]),
            each(|j| own[j].1[2].0[lane]),
        ]
    }

    /// Places inside (0, 1) where the load of the stream has a kink. Those closer than `resolution` count as one.
    pub(crate) fn kinks(&mut self, resolution: f64) -> Vec<f64> {
        let mut out = Vec::new();
        let stream = self.equations.arm().flow.speed != 0.0 && self.equations.arm().flow.density != 0.0;
        if !stream {
            return out;
        }
        self.take_speeds();
        let gauss = &self.system.gauss;
        let mesh = &self.solution.mesh;
        for which in 0..2 {
            let first = out.len();
            // Place and value before.
            let mut before = (0.0, 0.0);
            for i in 0..mesh.elements() {
                let (start, h) = (mesh.nodes()[i], mesh.step(i));
                let [along, x, y, z] = self.speeds_of(i);
                let size = |own: &[f64; M]| own.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let weigh = |c: &[f64; M], own: &[f64; M]| -> f64 { (0..M).map(|j| c[j] * own[j]).sum() };
                let vector = |c: &[f64; M]| -> Vector<f64> { [weigh(c, &x), weigh(c, &y), weigh(c, &z)] };
                let least = if which == 0 { size(&along) } else { size(&x).max(size(&y)).max(size(&z)) };
                if least < NOTHING {
                    before.1 = 0.0;
                    continue;
                }
                // What changes sign: U_t, or the slope of |U_p|^2/2, upwards.
                let at = |place: f64| -> f64 {
                    let cardinals = gauss.cardinals(place);
                    if which == 0 {
                        weigh(&cardinals, &along)
                    } else {
                        dot(&vector(&cardinals), &vector(&gauss.slopes(place)))
                    }
                };
                for sample in 0..=SAMPLES {
                    let place = sample as f64 / SAMPLES as f64;
                    let now = (start + h * place, at(place));
                    let crosses = before.1 * now.1 < 0.0 && (which == 0 || before.1 < 0.0);
                    if crosses {
                        let (mut lo, mut hi) = (before, now);
                        while sample > 0 && hi.0 - lo.0 > 1e-3 * resolution {
                            let mid = 0.5 * (lo.0 + hi.0);
                            let value = at((mid - start) / h);
                            if value * lo.1 <= 0.0 { hi = (mid, value) } else { lo = (mid, value) }
                        }
                        let kink = 0.5 * (lo.0 + hi.0);
                        let across = vector(&gauss.cardinals((kink - start) / h));
                        if which == 0 {
                            // Polynomials on both sides of a node put the same change at slightly different places.
                            let apart = resolution.max(1e-3 * h);
                            let kink = self.sharpened(kink, i, &along);
                            if out.len() > first && kink - out[out.len() - 1] < apart {
                                out.pop();
                            } else {
                                out.push(kink);
                            }
                        } else if dot(&across, &across).sqrt() < FAR {
                            out.push(kink);
                        }
                    }
                    if now.1 != 0.0 {
                        before = now;
                    }
                }
            }
        }
        out.retain(|s| *s > resolution && *s < 1.0 - resolution);
        out.sort_by(f64::total_cmp);
        out.dedup_by(|b, a| *b - *a < resolution);
        if out.len() > MOST {
            out.clear();
        }
        out
    }

    /// The place of a change of sign of U_t, given where the polynomial through its values `own` at the stages of
    /// element `i` has it: near a node, that polynomial is moved to U_t there, as in the plane.
    fn sharpened(&self, place: f64, i: usize, own: &[f64; M]) -> f64 {
        let mesh = &self.solution.mesh;
        let Some(end) = end_beside(mesh, i, place) else { return place };
        let Ok(section) = self.section_in(i, end) else { return place };
        let stream = &self.equations.water.stream;
        let speed = dot(stream, stream).sqrt();
        let at_node = dot(&section.directors.to_body(stream), &Tangent::of(&section.strain).t) / speed;
        let x = zero_beside(&self.system.gauss, own, (end, at_node), mesh.step(i));
        x.map_or(place, |x| mesh.nodes()[i] + mesh.step(i) * x)
    }

    /// Moves nodes onto the kinks at the present solution, where no pinned node is within `resolution`; whether any
    /// moved.
    pub(super) fn pin_kinks(&mut self, resolution: f64) -> bool {
        let kinks = self.kinks(10.0 * resolution);
        self.pin(&kinks, resolution)
    }

    /// Moves nodes onto `kinks` that no pinned node is within `tolerance` of; whether any moved.
    pub(super) fn pin(&mut self, kinks: &[f64], tolerance: f64) -> bool {
        let mesh = &self.solution.mesh;
        let stray = kinks.iter().any(|s| {
            let i = mesh.element_of(*s);
            let (left, right) = (s - mesh.nodes()[i], mesh.nodes()[i + 1] - s);
            let nearest = if left < right { i } else { i + 1 };
            !(left.min(right) < tolerance && mesh.is_pinned(nearest))
        });
        if !stray {
            return false;
        }
        let mut pinned = mesh.clone();
        pinned.pin(&self.breaks, kinks);
        if pinned == self.solution.mesh {
            return false;
        }
        self.remap_to(pinned);
        true
    }
}
