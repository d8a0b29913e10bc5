//! Newton's method on a mesh.

use hydrostat_bvp::RoundError;

use super::{Engine, TIGHT, Trouble, linearise, solve};
use crate::equilibrium::Q;

/// Corrections (rad) after which kinks of the load are where they will be, but for second order.
const SMALL: f64 = 0.1;

/// Rounds of Newton after which nodes are moved onto the kinks before the next.
const PINS: usize = 2;

impl Engine {
    /// Newton on the present mesh until the tip moves by less than `tolerance`.
    pub(crate) fn newton(&mut self, tolerance: f64, most: usize) -> Result<(), Trouble> {
        self.iterate(tolerance, most, false, None)
    }

    /// Newton until the tip moves by less than `tolerance`, or, looking `ahead`, until it would move by
    /// less in the round to come. Given how close to the kinks of the load nodes have to be, they are moved there as soon
    /// as corrections are small: a round on nodes that are off is as good as lost.
    pub(super) fn iterate(
        &mut self,
        tolerance: f64,
        most: usize,
        ahead: bool,
        resolution: Option<f64>,
    ) -> Result<(), Trouble> {
        if self.equations.held.is_some() {
            return self.iterate_held(tolerance, most);
        }
        let clamped = self.equations.arm().readings.support == crate::Support::Clamped;
        let most = if clamped { most } else { 60 };
        let mut applied = 0.0;
        let mut halvings = 0;
        let mut round = 0;
        let mut before = 0.0;
        let mut pins = if resolution.is_some() { PINS } else { 0 };
        loop {
            self.may_go_on()?;
            match linearise(&mut self.system, &mut self.equations, &self.solution, false) {
                Ok(()) => {}
                Err(RoundError::Slopes(failure)) => {
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
            round += 1;
            solve(&self.system, &self.solution, 0, &mut self.correction);
            let size = self.correction.largest(0);
            if !size.is_finite() {
                return Err(Trouble::Singular);
            }
            let [dx, dy] = self.correction.total;
            applied = if size > 1.0 { 1.0 / size } else { 1.0 };
            halvings = 0;
            self.solution.add(&self.correction, applied);
            let [x, y] = self.system.totals();
            let tip = [x + dx, y + dy];
            // beta'' runs a round behind: what it still moves shows from round to round.
            let drifted = if round > 1 { (tip[0] - self.tip[0]).hypot(tip[1] - self.tip[1]) } else { 0.0 };
            self.tip = tip;
            let moved = dx.hypot(dy).max(0.1 * size);
            let moved = if ahead {
                let seen = if round > 1 { size / before } else { 0.0 };
                moved * if applied < 1.0 { 1.0 } else { self.foreseen_rate(size, seen) }
            } else {
                moved.max(0.1 * drifted)
            };
            before = size;
            self.last = size;
            self.rest = if ahead || tolerance <= TIGHT { moved } else { 0.0 };
            let stop = round == most || (clamped && round >= 4 && size > 3.0);
            if moved <= tolerance || stop {
                self.system.quadratures(&mut self.spans);
                add_to_spans(&mut self.spans, &self.correction.by_element);
                return if moved <= tolerance { Ok(()) } else { Err(Trouble::Stalled(size)) };
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

    /// The share of a correction of this size that is left to the next: it falls with the square of the correction, but not below the
    /// share of beta'', which is a round behind, and no faster than it was `seen` to fall.
    fn foreseen_rate(&self, size: f64, seen: f64) -> f64 {
        (10.0 * self.reached().max(size)).max(seen).clamp(0.05, 1.0)
    }

    /// The largest change of the angle within an element by the last correction.
    fn reached(&self) -> f64 {
        let mesh = &self.solution.mesh;
        let each = self.correction.slopes.iter().enumerate();
        each.fold(0.0, |m, (i, k)| k.iter().fold(m, |m, k| f64::max(m, mesh.step(i) * k[0].abs())))
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
