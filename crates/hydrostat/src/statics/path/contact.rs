//! Cables with a commanded stroke that go slack or taut along a path.
//!
//! Tension and slack of such a cable are not negative, and one of them is zero. Where the one that is not comes down to
//! zero, they change their parts: the path goes on in a corner, in the direction in which the other one rises.

use super::step_control::StepControl;
use super::stepper::{Point, StepOutcome, Stepper};
use super::traced::Traced;
use crate::statics::engine::Trouble;

/// Tensions (in the unit of force) and slacks (over L) that count as zero.
const ZERO: f64 = 1e-11;

/// What the margin of a cable may be past zero for a contact to be found.
const FOUND: f64 = 1e-10;

/// Where a cable goes slack or taut.
pub(super) struct Contact<E: Traced> {
    /// The point, with the tangent that leads to it.
    pub(super) at: Point<E>,
    /// The same point with the tangent that leads on.
    pub(super) after: Point<E>,
    /// The cable.
    pub(super) cable: usize,
    /// Whether it goes slack, else taut.
    pub(super) slack: bool,
}

/// The end of a step, how the path goes on there, and the contact that it ended at.
type Advanced<E> = (Point<E>, StepOutcome, Option<Contact<E>>);

impl<E: Traced> Stepper<'_, E> {
    /// The margins of the commanded cables after the last linearisation.
    pub(super) fn margins(&self) -> Vec<f64> {
        let Some(stroke_control) = self.engine.stroke_control() else { return Vec::new() };
        let margin = |i: usize| {
            if stroke_control.taut[i] { self.engine.tension(stroke_control.cables[i]) } else { self.round.slack[0][i] }
        };
        (0..stroke_control.cables.len()).map(margin).collect()
    }

    /// A step that ends where the first cable goes slack or taut, if one does on the way.
    pub(super) fn advance_to_contact(
        &mut self,
        here: &Point<E>,
        step: f64,
        control: StepControl,
    ) -> Result<Advanced<E>, Trouble> {
        let (next, turn) = self.advance(here, step, control)?;
        let past: Vec<usize> = (0..next.margins.len()).filter(|i| next.margins[*i] < -ZERO).collect();
        if past.is_empty() {
            return Ok((next, turn, None));
        }
        // One that has just changed and changes back, or another branch: only a shorter step tells these apart.
        if turn == StepOutcome::Bifurcation || past.iter().any(|i| here.margins[*i] < FOUND) {
            return Err(Trouble::Stalled(step));
        }
        let contact = self.contact_between(here, next, &past, step, StepControl { straightness: -1.0, ..control })?;
        Ok((contact.at.clone(), StepOutcome::Regular, Some(contact)))
    }

    /// Where between two points, `step` apart, the first of the cables `past` goes slack or taut.
    fn contact_between(
        &mut self,
        here: &Point<E>,
        next: Point<E>,
        past: &[usize],
        step: f64,
        control: StepControl,
    ) -> Result<Contact<E>, Trouble> {
        // The first of them, over how far each is from it at the start.
        let least = |point: &Point<E>| {
            let fraction = |i: &usize| point.margins[*i] / here.margins[*i];
            past.iter().map(|i| (fraction(i), *i)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, 0))
        };
        let (mut low, mut high) = ((0.0, 1.0), (step, least(&next).0));
        let mut reached = next;
        for _ in 0..40 {
            let (value, i) = least(&reached);
            if (value * here.margins[i]).abs() < FOUND {
                return self.change(reached, i);
            }
            // False position, its older end weighed down so that both ends come in.
            let fraction: f64 = low.1 / (low.1 - high.1);
            let middle = low.0 + fraction.clamp(0.02, 0.98) * (high.0 - low.0);
            let (point, turn) = self.advance(here, middle, control)?;
            if turn == StepOutcome::Bifurcation {
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
    fn change(&mut self, at: Point<E>, i: usize) -> Result<Contact<E>, Trouble> {
        self.engine.restore(&at.state);
        self.set(at.fraction);
        let (cable, slack) = self.engine.switch_active(i);
        let after = self.leave_contacts(at.fraction, |this, after| {
            let way = this.opening(after, i);
            if way == 0.0 { at.dlambda_ds.signum() * after.dlambda_ds.signum() } else { way }
        })?;
        Ok(Contact { at, after, cable, slack })
    }

    /// The first point of a path, from which the parameter rises, with cables taut or slack as that needs.
    pub(super) fn first_contacts(&mut self, fraction: f64) -> Result<Point<E>, Trouble> {
        self.engine.let_cables_switch(false);
        self.leave_contacts(fraction, |_, after| after.dlambda_ds)
    }

    /// Whether cables that are to be reeled in from where they hang slack would have to push: more tension pays them
    /// out there. The engine is left with them slack.
    pub(super) fn nothing_reels_in(&mut self) -> bool {
        let kept = self.engine.state();
        self.set(0.0);
        let Some(stroke_control) = self.engine.stroke_control().cloned() else { return false };
        let short: Vec<usize> =
            (0..stroke_control.cables.len()).filter(|i| self.engine.command_derivative(*i) > 0.0).collect();
        for i in short.iter().filter(|i| !stroke_control.taut[**i]) {
            self.engine.switch_active(*i);
        }
        let pushes = self.linearise().is_ok() && short.iter().any(|i| self.round.tension[1][*i] < 0.0);
        self.engine.restore(&kept);
        self.set(0.0);
        pushes
    }

    /// The point here with its tangent in the direction in which `way` is positive, and with those cables changed over
    /// that are at a contact which that tangent leads past.
    fn leave_contacts(&mut self, fraction: f64, way: impl Fn(&Self, &Point<E>) -> f64) -> Result<Point<E>, Trouble> {
        let mut changes = 0;
        loop {
            let mut after = self.point(fraction)?;
            if way(self, &after) < 0.0 {
                self.orientation = -self.orientation;
                after.dlambda_ds = -after.dlambda_ds;
            }
            let count = after.margins.len();
            let past: Vec<usize> =
                (0..count).filter(|i| after.margins[*i] < FOUND && self.opening(&after, *i) < -ZERO).collect();
            if past.is_empty() {
                for margin in &mut after.margins {
                    *margin = margin.max(0.0);
                }
                return Ok(after);
            }
            if changes > 2 * count {
                return Err(Trouble::Stalled(0.0));
            }
            // All at first, because cables may hold together what none of them holds alone; then one by one.
            let together = if changes == 0 { past.len() } else { 1 };
            for i in past.into_iter().take(together) {
                self.engine.switch_active(i);
            }
            changes += 1;
        }
    }

    /// How the margin of the commanded cable `i` changes along the tangent of a point, after its linearisation.
    fn opening(&self, point: &Point<E>, i: usize) -> f64 {
        let taut = self.engine.stroke_control().is_some_and(|stroke_control| stroke_control.taut[i]);
        point.dlambda_ds * if taut { self.round.tension[1][i] } else { self.round.slack[1][i] }
    }
}
