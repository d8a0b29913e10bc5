//! Kinks of the load, and nodes that follow them.

use hydrostat_bvp::{Gauss, Mesh};

use super::discrete::Engine;
use crate::statics::dimensions::M;
use crate::statics::friction::merged;

/// How close (over L) nodes are kept to the kinks of the load at a tolerance: the error that a kink leaves is of second
/// order in the distance, and the estimate does not see all of it. Closer than rounding places kinks, nodes would chase
/// it. `jumps` says whether the load can jump under the arm's readings.
pub(crate) fn kink_resolution(tolerance: f64, jumps: bool) -> f64 {
    let resolution = (0.02 * tolerance.sqrt()).max(5e-8);
    if jumps { resolution.min(at_jumps(tolerance)) } else { resolution }
}

/// How close (over L) nodes are kept at a tolerance to places where the load jumps: the error that a jump leaves is of
/// first order in the distance, times the load, and the estimate does not see it.
pub(crate) fn at_jumps(tolerance: f64) -> f64 {
    (0.02 * tolerance).max(1e-11)
}

/// Kinks that nodes are placed on. An arm with more winds through the stream so often that no mesh of any use resolves
/// it, and a node for each would take gigabytes: the estimate then says what that costs.
const MOST: usize = 500;

/// How near to a node (over the element) what is there moves the place of a kink.
const NEAR_NODE: f64 = 0.3;

/// The end (0 or 1) of element `i` that `place` (over L) is beside, if it is an inner node of the mesh.
pub(crate) fn end_beside(mesh: &Mesh, i: usize, place: f64) -> Option<f64> {
    let x = (place - mesh.nodes()[i]) / mesh.step(i);
    let (end, is_outer) = if x > 0.5 { (1.0, i + 1 == mesh.elements()) } else { (0.0, i == 0) };
    ((x - end).abs() <= NEAR_NODE && !is_outer).then_some(end)
}

/// Where, in an element of length `step` (over L), the polynomial through its values `own` at the stages changes its
/// sign beside an end, moved to the value that it has at that; `None` where that is not near.
pub(crate) fn zero_beside(gauss: &Gauss<M>, own: &[f64; M], (end, at_end): (f64, f64), step: f64) -> Option<f64> {
    let weigh = |c: &[f64; M]| -> f64 { (0..M).map(|j| c[j] * own[j]).sum() };
    let off = at_end - weigh(&gauss.cardinals(end));
    let mut x = end;
    for _ in 0..4 {
        let moved = (weigh(&gauss.cardinals(x)) + off) / weigh(&gauss.slopes(x));
        x -= moved;
        if moved.abs() * step < 1e-12 {
            break;
        }
    }
    ((x - end).abs() < NEAR_NODE).then_some(x)
}

impl Engine {
    /// Places inside (0, 1) where the load of the stream has a kink: where a switch changes sign.
    /// Changes closer than `resolution`, or than interpolation in an element tells apart, count as one, or
    /// cancel: on both sides of a node on a kink the polynomials put it at slightly different places.
    pub(crate) fn kinks(&mut self, resolution: f64) -> Vec<f64> {
        let mut out = Vec::new();
        self.take_switches();
        self.find_kinks(resolution, &mut out);
        out
    }

    /// [`Engine::kinks`] into `out`.
    pub(super) fn find_kinks(&self, resolution: f64, out: &mut Vec<f64>) {
        const SAMPLES: usize = 8;
        /// The cardinal polynomials' absolute values sum up to less everywhere on an element: what is nearer to its
        /// value at a stage than one part in as many does not change sign.
        const NORM: f64 = 3.0;
        out.clear();
        let mesh = &self.solution.mesh;
        let samples: [[f64; M]; SAMPLES + 1] =
            std::array::from_fn(|sample| self.system.gauss.cardinals(sample as f64 / SAMPLES as f64));
        for switch in 0..3 {
            let first = out.len();
            let mut before = (0.0, 0.0);
            for i in 0..mesh.elements() {
                let (start, h) = (mesh.nodes()[i], mesh.step(i));
                let apart = resolution.max(1e-3 * h);
                let own: [f64; M] = std::array::from_fn(|j| self.switch(i, j, switch));
                let largest = own.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                if largest < 1e-6 {
                    before.1 = 0.0;
                    continue;
                }
                let spread = own.iter().fold(0.0_f64, |m, v| m.max((v - own[0]).abs()));
                if own[0].abs() > NORM * spread && before.1 * own[0] >= 0.0 {
                    before = (start + h, own[0]);
                    continue;
                }
                let weigh = |c: &[f64; M]| -> f64 { (0..M).map(|j| c[j] * own[j]).sum() };
                let at = |x: f64| weigh(&self.system.gauss.cardinals(x));
                for (sample, cardinals) in samples.iter().enumerate() {
                    let x = sample as f64 / SAMPLES as f64;
                    let now = (start + h * x, weigh(cardinals));
                    if before.1 * now.1 < 0.0 {
                        let (mut lo, mut hi) = (before, now);
                        while sample > 0 && hi.0 - lo.0 > 0.01 * resolution {
                            let mid = 0.5 * (lo.0 + hi.0);
                            let value = at((mid - start) / h);
                            if value * lo.1 <= 0.0 { hi = (mid, value) } else { lo = (mid, value) }
                        }
                        let place = self.sharpened(0.5 * (lo.0 + hi.0), i, switch);
                        if out.len() > first && place - out[out.len() - 1] < apart {
                            out.pop();
                        } else {
                            out.push(place);
                        }
                    }
                    if now.1 != 0.0 {
                        before = now;
                    }
                }
            }
        }
        self.add_kinks_of_friction(out);
        out.retain(|s| *s > resolution && *s < 1.0 - resolution);
        out.sort_by(f64::total_cmp);
        out.dedup_by(|b, a| *b - *a < resolution);
        if out.len() > MOST {
            out.clear();
        }
    }

    /// Adds the places where cables that rub turn back: their tensions have kinks there. These are of the turns that
    /// the present tensions are made of, not of the solution: there the kinks are until the next round of turns.
    fn add_kinks_of_friction(&self, out: &mut Vec<f64>) {
        let Some(capstan) = &self.equations.capstan else { return };
        let cables = self.equations.arm().cables.iter().enumerate();
        let with_friction = |(c, cable): (usize, &crate::Cable)| {
            (cable.friction > 0.0 && self.equations.tension(c) != 0.0).then_some(c)
        };
        let with_friction: Vec<usize> = cables.filter_map(with_friction).collect();
        let mut kinks: Vec<f64> = capstan.kinks(&with_friction).collect();
        kinks.sort_by(f64::total_cmp);
        out.extend(merged(&kinks, |_| true));
    }

    /// The place of a change of sign of `switch`, given where the polynomial of element `i` has it: near a node, that
    /// polynomial is moved to what the switch is there, because nodes are as good as the tip and the ends of
    /// polynomials are not. A kink that a node misses is invisible to the estimate.
    fn sharpened(&self, place: f64, i: usize, switch: usize) -> f64 {
        let mesh = &self.solution.mesh;
        let Some(end) = end_beside(mesh, i, place) else { return place };
        let at_end = end == 1.0;
        let Ok(at_node) = self.beside_node(if at_end { i + 1 } else { i }, at_end) else { return place };
        let own: [f64; M] = std::array::from_fn(|j| self.switch(i, j, switch));
        let x = zero_beside(&self.system.gauss, &own, (end, at_node.switches[switch]), mesh.step(i));
        x.map_or(place, |x| mesh.nodes()[i] + mesh.step(i) * x)
    }

    /// Moves nodes onto `kinks` that no pinned node is within `tolerance` of; whether any moved.
    pub(crate) fn pin(&mut self, kinks: &[f64], tolerance: f64) -> bool {
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
        std::mem::swap(&mut self.solution, &mut self.before);
        self.solution.mesh.clone_from(&self.before.mesh);
        self.solution.mesh.pin(&self.breaks, kinks);
        if self.solution.mesh == self.before.mesh {
            std::mem::swap(&mut self.solution, &mut self.before);
            return false;
        }
        self.remap();
        true
    }

    /// Moves nodes onto the kinks at the present solution; whether any moved.
    pub(super) fn pin_kinks(&mut self, resolution: f64) -> bool {
        self.take_switches();
        let mut kinks = std::mem::take(&mut self.found);
        self.find_kinks(10.0 * resolution, &mut kinks);
        let moved = self.pin(&kinks, resolution);
        self.found = kinks;
        moved
    }
}
