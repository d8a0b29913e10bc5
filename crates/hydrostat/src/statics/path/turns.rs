//! The curve of equilibria of an arm whose base turns about an axis, and where the base has turned by whole turns.
//!
//! Seen from the tip the equations are an initial-value problem: the rotation of the tip gives the whole arm, down to
//! the rotation of the base. In space the equilibria for all rotations of the base are therefore a closed manifold,
//! that of the rotations of the tip; those for a base that turns about one axis are curves on it, which close, or end
//! where a section has no strains.

use super::points::PathEnd;
use super::step_control::StepControl;
use super::stepper::{Fraction, Point, StepOutcome, Stepper};
use super::traced::{Along, Traced};
use crate::statics::verdict::VerdictKind;

/// How finely the curve is followed.
const CONTROL: StepControl = StepControl { most: usize::MAX, ..StepControl::BRISK };

/// Most points of one curve.
const MOST: usize = 800;

/// Whether a curve is followed further.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Further {
    Yes,
    /// What comes is known.
    No,
    /// Nothing at all is followed further.
    Stop,
}

/// What a curve has come to.
pub(crate) enum Met<'e, E> {
    /// One more point.
    Point,
    /// The base has turned by whole turns: the engine with that solution, and whether the angle rises along the curve.
    WholeTurns { engine: &'e mut E, rises: bool },
}

/// Follows the curve through the engine's equilibrium, whose base turns once round over its range, to one side of the
/// angle of the base (1 or -1). Where another curve crosses, it goes straight on. `further` is asked at every point and
/// at whole turns. What ended the curve, unless what comes was known.
pub(crate) fn follow_turns<E: Traced>(
    engine: &mut E,
    side: f64,
    further: &mut dyn FnMut(Met<'_, E>) -> Further,
) -> Option<PathEnd> {
    let start = engine.range_fraction();
    let mut stepper = Stepper::new(engine, Along::Range, [f64::NEG_INFINITY, f64::INFINITY]);
    let begun = stepper
        .keep_accuracy(None, &mut Fraction::Fixed(start), [CONTROL.accuracy; 2])
        .and_then(|()| stepper.point(start));
    let Ok(mut here) = begun else { return Some(PathEnd::Limit { kind: VerdictKind::NotFound, s: None }) };
    if side * here.dlambda_ds < 0.0 {
        stepper.orientation = -stepper.orientation;
        here.dlambda_ds = -here.dlambda_ds;
    }
    Curve { stepper, further }.follow(here)
}

struct Curve<'e, 'f, E: Traced> {
    stepper: Stepper<'e, E>,
    further: &'f mut dyn FnMut(Met<'_, E>) -> Further,
}

impl<E: Traced> Curve<'_, '_, E> {
    fn follow(&mut self, mut here: Point<E>) -> Option<PathEnd> {
        let mut step = 0.05;
        let mut points = 0;
        while step >= 1e-8 {
            let (mut next, outcome) = match self.stepper.advance(&here, step, CONTROL) {
                Ok(found) => found,
                Err(trouble) => {
                    self.stepper.last_trouble = Some(trouble);
                    step *= 0.4;
                    continue;
                }
            };
            let mut extreme = None;
            if outcome == StepOutcome::Bifurcation {
                self.stepper.orientation = -self.stepper.orientation;
                next.dlambda_ds = -next.dlambda_ds;
            } else if next.dlambda_ds * here.dlambda_ds < 0.0 {
                extreme = Some(self.stepper.limit_point(&here, &next, step, CONTROL).0);
            }
            let points_of_step: Vec<&Point<E>> = [&here].into_iter().chain(&extreme).chain([&next]).collect();
            let mut further = (self.further)(Met::Point);
            for leg in points_of_step.windows(2) {
                if further == Further::Yes {
                    further = self.whole_turns_between(leg[0], leg[1]);
                }
            }
            match further {
                Further::Yes => {}
                Further::No => return None,
                Further::Stop => return Some(PathEnd::Stopped),
            }
            points += 1;
            if points == MOST {
                return Some(PathEnd::MostPoints);
            }
            here = next;
            step = (step * 1.6).min(CONTROL.longest);
        }
        Some(self.stepper.end_at(&here))
    }

    /// Tells of the whole turns between two points between which the angle of the base rises or falls, in their order.
    fn whole_turns_between(&mut self, from: &Point<E>, to: &Point<E>) -> Further {
        let rises = to.fraction > from.fraction;
        let mut turns = if rises { from.fraction.floor() + 1.0 } else { from.fraction.ceil() - 1.0 };
        while if rises { turns <= to.fraction } else { turns >= to.fraction } {
            if self.land_between(from, to, turns) {
                let further = (self.further)(Met::WholeTurns { engine: self.stepper.engine, rises });
                if further != Further::Yes {
                    return further;
                }
            }
            turns += if rises { 1.0 } else { -1.0 };
        }
        Further::Yes
    }

    /// Brings the engine to the point between two at which the base has turned by `turns`; whether it got there.
    fn land_between(&mut self, from: &Point<E>, to: &Point<E>, turns: f64) -> bool {
        let control = StepControl { straightness: -1.0, ..CONTROL };
        let mut ends = [from, to];
        if (to.fraction - turns).abs() < (from.fraction - turns).abs() {
            ends.swap(0, 1);
        }
        ends.into_iter().any(|end| {
            if end.fraction == turns {
                self.stepper.engine.restore(&end.state);
                return true;
            }
            self.stepper.land(end, turns, control).is_ok()
        })
    }
}
