//! Newton's method on a mesh.

use hydrostat_bvp::LinearisationError;

use super::discrete::Engine;
use super::trouble::Trouble;
use crate::numerics::rounds::{correct, linearise};
use crate::statics::dimensions::{M, Q};

/// Corrections (rad) after which kinks of the load are where they will be, but for second order.
const SMALL: f64 = 0.1;

/// Rounds of Newton after which nodes are moved onto the kinks before the next.
const PINS: usize = 2;

/// What the square of a change of strains leaves to the tip's way (over L).
const LEFT_BY_STRAINS: f64 = 0.01;

/// Changes of own ends that one call may make.
const TURNS: usize = 2;

impl Engine {
    /// Newton on the present mesh until the tip moves by less than `tolerance`.
    pub(crate) fn newton(&mut self, tolerance: f64, most: usize) -> Result<(), Trouble> {
        self.iterate(tolerance, most, None)
    }

    /// Newton until what is left of the tip's way is below `tolerance`, by the way rounds fall. Given how close to the
    /// kinks of the load nodes have to be, they are moved there as soon as corrections are small: a round on nodes that
    /// are off is as good as lost.
    pub(super) fn iterate(&mut self, tolerance: f64, most: usize, resolution: Option<f64>) -> Result<(), Trouble> {
        if self.equations.stroke_control.is_some() {
            return self.iterate_at_strokes(tolerance, most);
        }
        let clamped = self.equations.arm().model.support == crate::Support::Clamped;
        let most = if clamped { most } else { 60 };
        let (mut applied, mut halvings, mut round) = (0.0, 0, 0);
        let mut before = f64::INFINITY;
        let mut pins = if resolution.is_some() { PINS } else { 0 };
        let mut turns = 0;
        self.match_closure();
        loop {
            self.may_go_on()?;
            match linearise(&mut self.system, &self.equations, &self.solution) {
                Ok(()) => {}
                Err(LinearisationError::Slopes(failure)) => {
                    if applied == 0.0 || halvings == 8 {
                        return Err(Trouble::Section(failure));
                    }
                    applied *= 0.5;
                    halvings += 1;
                    self.solution.add(&self.correction, -applied);
                    continue;
                }
                Err(singular) => return Err(singular.into()),
            }
            self.rounds += 1;
            if turns < TURNS && self.choose_sides() {
                turns += 1;
                applied = 0.0;
                continue;
            }
            round += 1;
            correct(&mut self.system, &self.solution, &mut self.correction);
            let size = self.correction.largest(0);
            if !size.is_finite() {
                return Err(Trouble::Singular);
            }
            let [dx, dy] = self.correction.total;
            applied = if size > 1.0 { 1.0 / size } else { 1.0 };
            halvings = 0;
            self.solution.add(&self.correction, applied);
            let [x, y] = self.system.totals();
            self.tip = [x + dx, y + dy];
            let moved = dx.hypot(dy).max(0.1 * size);
            // Rounds fall with the square of their size, and no faster than the last one did. Strains count, too: those
            // at the ends of elements may be far off where no angle is.
            let strained = self.correction.largest_inner();
            let whole = size.max(strained);
            let rate = if applied < 1.0 { 1.0 } else { (whole / before).min(1.0).max(10.0 * size.max(self.reached())) };
            self.left_over = (moved * rate.min(1.0)).max(LEFT_BY_STRAINS * strained * strained);
            before = whole;
            self.last = size;
            let stop = round == most || (clamped && round >= 4 && size > 3.0);
            if self.left_over <= tolerance || stop {
                self.system.quadratures(&mut self.spans);
                add_to_spans(&mut self.spans, &self.correction.by_element);
                return if self.left_over <= tolerance { Ok(()) } else { Err(Trouble::Stalled(size)) };
            }
            if size < SMALL
                && pins > 0
                && let Some(resolution) = resolution
            {
                pins -= 1;
                if self.pin_kinks(resolution) {
                    // The correction belongs to the mesh before.
                    applied = 0.0;
                }
            }
        }
    }

    /// The largest correction (rad) at the last linearisation, which is not made.
    pub(crate) fn correction_here(&mut self) -> f64 {
        correct(&mut self.system, &self.solution, &mut self.correction);
        self.correction.largest(0)
    }

    /// The largest change of the angle within an element by the last correction.
    fn reached(&self) -> f64 {
        let mesh = &self.solution.mesh;
        let groups = self.solution.groups();
        let mut largest = 0.0_f64;
        for i in 0..mesh.elements() {
            for j in 0..M {
                let (block, lane) = groups.at(i, j);
                largest = largest.max(mesh.step(i) * self.correction.stages[block].slope[0].0[lane].abs());
            }
        }
        largest
    }
}

/// Brings what each element adds to the tip's position up to a correction.
pub(super) fn add_to_spans(spans: &mut [[f64; Q]], changes: &[[f64; Q]]) {
    for (span, change) in spans.iter_mut().zip(changes) {
        for q in 0..Q {
            span[q] += change[q];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::rounds::simplify;
    use crate::rod::arm::{Arm, Cable};
    use crate::rod::profile::Profile;

    /// With kept factors rounds fall by one ratio and end where Newton's do, beta' of its polynomials included.
    #[test]
    fn rounds_with_kept_factors_end_at_the_solution() {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
        arm.flow.speed = 0.1;
        let mut engine = Engine::new(&arm);
        engine.start_from_cables(8).unwrap();
        engine.newton(1e-10, 20).unwrap();
        assert!(engine.solution.directions.is_closed(), "the closure has a part in this");
        engine.change_loads(|arm| arm.cables[0].tension = 0.21);
        engine.linearise().unwrap();
        let mut sizes = Vec::new();
        for _ in 0..8 {
            correct(&mut engine.system, &engine.solution, &mut engine.correction);
            sizes.push(engine.correction.largest(0).max(engine.correction.largest_inner()));
            engine.solution.add(&engine.correction, 1.0);
            simplify(&mut engine.system, &engine.equations, &engine.solution).unwrap();
        }
        assert!((2..6).all(|k| sizes[k] < 0.1 * sizes[k - 1] || sizes[k] < 1e-11), "{sizes:?}");
        engine.linearise().unwrap();
        correct(&mut engine.system, &engine.solution, &mut engine.correction);
        let left = engine.correction.largest(0).max(engine.correction.largest_inner());
        assert!(left < 1e-11, "{left:e} after {sizes:?}");
    }
}
