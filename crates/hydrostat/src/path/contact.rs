//! Cables with a commanded stroke that go slack or taut along a path.
//!
//! Tension and slack of such a cable are not negative, and one of them is zero. Where the one that is not comes down to
//! zero, they change their parts: the path goes on in a corner, in the direction in which the other one rises.

use super::Pace;
use super::stepper::{Point, Stepper, Turn};
use crate::engine::Trouble;

/// Tensions (in the unit of force) and slacks (over L) that count as zero.
const ZERO: f64 = 1e-11;

/// What the margin of a cable may be past zero for a contact to be found.
const FOUND: f64 = 1e-10;

/// Where a cable goes slack or taut.
pub(super) struct Contact {
    /// The point, with the tangent that leads to it.
    pub(super) at: Point,
    /// The same point with the tangent that leads on.
    pub(super) after: Point,
    /// The cable.
    pub(super) cable: usize,
    /// Whether it goes slack, else taut.
    pub(super) slack: bool,
}

impl Stepper<'_> {
    /// The margins of the commanded cables after the last linearisation.
    pub(super) fn margins(&self) -> Vec<f64> {
        let Some(held) = &self.engine.equations.held else { return Vec::new() };
        let margin = |i: usize| {
            if held.taut[i] { self.engine.equations.tension(held.cables[i]) } else { self.round.slack[0][i] }
        };
        (0..held.cables.len()).map(margin).collect()
    }

    /// Where between two points, `step` apart, the first cable goes slack or taut, if one does.
    pub(super) fn contact(
        &mut self,
        here: &Point,
        next: &Point,
        step: f64,
        pace: Pace,
    ) -> Result<Option<Contact>, Trouble> {
        let past: Vec<usize> = (0..next.margins.len()).filter(|i| next.margins[*i] < -ZERO).collect();
        if past.is_empty() {
            return Ok(None);
        }
        // One that has just changed and changes back: only a shorter step tells that apart from one that never did.
        if past.iter().any(|i| here.margins[*i] < FOUND) {
            return Err(Trouble::Stalled(step));
        }
        let pace = Pace { straightness: -1.0, ..pace };
        // The first of them, over how far each is from it at the start.
        let least = |point: &Point| {
            let share = |i: &usize| point.margins[*i] / here.margins[*i];
            past.iter().map(|i| (share(i), *i)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, 0))
        };
        let (mut low, mut high) = ((0.0, 1.0), (step, least(next).0));
        let mut reached = next.clone();
        for _ in 0..40 {
            let (value, i) = least(&reached);
            if (value * here.margins[i]).abs() < FOUND {
                return self.change(reached, i).map(Some);
            }
            // False position, its older end weighed down so that both ends come in.
            let share: f64 = low.1 / (low.1 - high.1);
            let middle = low.0 + share.clamp(0.02, 0.98) * (high.0 - low.0);
            let (point, turn) = self.advance(here, middle, pace)?;
            if turn == Turn::Crossing {
                return Err(Trouble::Stalled(step));
            }
            let value = least(&point).0;
            if value < 0.0 {
                high = (middle, value);
                low.1 *= 0.5;
            } else {
                low = (middle, value);
                high.1 *= 0.5;
            }
            reached = point;
        }
        Err(Trouble::Stalled(step))
    }

    /// The change of the commanded cable `i` at a point.
    fn change(&mut self, at: Point, i: usize) -> Result<Contact, Trouble> {
        self.engine.restore(&at.state);
        self.set(at.fraction);
        let (cable, slack) = self.engine.equations.change_over(i);
        let mut after = self.point(at.fraction)?;
        let rises = if slack { self.round.slack[1][i] } else { self.round.tension[1][i] };
        let way = if rises == 0.0 { at.rise.signum() } else { rises.signum() };
        if after.rise * way < 0.0 {
            self.orientation = -self.orientation;
            after.rise = -after.rise;
        }
        after.margins[i] = 0.0;
        Ok(Contact { at, after, cable, slack })
    }
}
