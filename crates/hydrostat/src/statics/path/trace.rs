//! Branches of equilibria over the range that the equations of an engine vary over.

use super::contact::Contact;
use super::points::{Branch, Event, PathEnd, PathError, PathOptions, PathPoint};
use super::step_control::StepControl;
use super::stepper::{Fraction, Point, StepOutcome, Stepper};
use super::traced::{Along, Traced};
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::engine::Trouble;
use crate::statics::stability::Stability;
use crate::statics::verdict::VerdictKind;

/// Elements at the start of a path: a straight arm is exact on fewer, but not its determinant.
const FEWEST: usize = 8;

/// A step in which the number of unstable directions changes by more than its events explain is repeated with shorter
/// ones down to this length: two bifurcations leave the sign of the determinant as it was.
const COUNTED: f64 = 0.01;

/// The branches from the engine's solution, which is that at the start of the range.
pub(crate) fn trace<E: Traced>(
    engine: &mut E,
    options: &PathOptions,
    watch: &mut dyn FnMut(&PathPoint<E::Shape>) -> bool,
) -> Vec<Branch<E::Shape>> {
    let control = StepControl { longest: options.longest, straightness: 0.97, most: usize::MAX, accuracy: options.tol };
    let mut trace = Trace {
        stepper: Stepper::new(engine, Along::Range, [0.0, 1.0]),
        control,
        most: options.most,
        watch,
        stopped: false,
        bifurcations: Vec::new(),
    };
    let first = if let Ok(start) = trace.start() {
        trace.from(start, None)
    } else {
        // Solved, but not as finely as a path needs: no point, and a reason.
        let end = PathEnd::Limit { kind: VerdictKind::NotFound, s: None };
        Branch { points: Vec::new(), end, switched_at: None }
    };
    let mut branches = vec![first];
    if options.branches {
        for bifurcation in std::mem::take(&mut trace.bifurcations) {
            branches.extend(trace.switched(&bifurcation));
        }
    }
    branches
}

/// `arm` at both ends of the range of a path.
pub(crate) fn ends_of_range<S>(
    arm: &Arm,
    parameter: Parameter,
    range: [f64; 2],
    options: &PathOptions,
) -> Result<[Arm; 2], PathError<S>> {
    check(range, options)?;
    let at = |value: f64| parameter.checked(arm, value).map_err(|source| PathError::Value { parameter, value, source });
    Ok([at(range[0])?, at(range[1])?])
}

fn check<S>(range: [f64; 2], options: &PathOptions) -> Result<(), PathError<S>> {
    let refuse = |option, value, expected| Err(PathError::Option { option, value, expected });
    if !(1e-7..=1e-3).contains(&options.tol) {
        return refuse("tol", options.tol, "in [1e-7, 1e-3]");
    }
    if !(1e-3..=0.4).contains(&options.longest) {
        return refuse("longest", options.longest, "in [0.001, 0.4]");
    }
    for value in range {
        if !value.is_finite() {
            return refuse("range", value, "two finite numbers");
        }
    }
    if range[0] == range[1] {
        return refuse("range", range[1], "two different numbers");
    }
    Ok(())
}

struct Trace<'e, 'w, E: Traced> {
    stepper: Stepper<'e, E>,
    control: StepControl,
    /// Points that may still come.
    most: usize,
    watch: &'w mut dyn FnMut(&PathPoint<E::Shape>) -> bool,
    /// Whether it said that this is enough.
    stopped: bool,
    /// Bifurcations, where the branch followed goes straight on.
    bifurcations: Vec<Point<E>>,
}

impl<E: Traced> Trace<'_, '_, E> {
    /// The solve at the start of the range as a point.
    fn start(&mut self) -> Result<Point<E>, Trouble> {
        let engine = &mut *self.stepper.engine;
        let parts = FEWEST.div_ceil(engine.mesh().elements());
        if parts > 1 {
            let mesh = engine.mesh().cut(parts);
            engine.remap_to(mesh);
            engine.newton(1e-9, 12)?;
        }
        let tol = self.control.accuracy;
        self.stepper.keep_accuracy(None, &mut Fraction::Fixed(0.0), [tol, tol])?;
        self.stepper.first_contacts(0.0)
    }

    /// The branch from a point into the range.
    fn from(&mut self, mut here: Point<E>, switched_at: Option<f64>) -> Branch<E::Shape> {
        // Which side of zero the determinant is on is a matter of the branch, which way is up is not.
        if switched_at.is_none() && here.dlambda_ds < 0.0 {
            self.stepper.orientation = -self.stepper.orientation;
            here.dlambda_ds = -here.dlambda_ds;
        }
        self.stepper.begin(&mut here);
        let mut points = Vec::new();
        let end = self.collect(here, &mut points);
        Branch { points, end, switched_at }
    }

    fn collect(&mut self, mut here: Point<E>, points: &mut Vec<PathPoint<E::Shape>>) -> PathEnd {
        if let Some(first) = read(self.stepper.engine, &here, None)
            && let Some(end) = self.put(first, points)
        {
            return end;
        }
        let mut step = 0.05_f64.min(self.control.longest);
        while step >= 1e-8 {
            let advanced = self.stepper.advance_to_contact(&here, step, self.control);
            let (mut next, turn, contact) = match advanced {
                Ok(found) => found,
                Err(trouble) => {
                    self.stepper.last_trouble = Some(trouble);
                    step *= 0.4;
                    self.stepper.engine.restore(&here.state);
                    continue;
                }
            };
            let step_taken = if contact.is_some() { self.stepper.distance(&here, &next) } else { step };
            let event = if turn == StepOutcome::Bifurcation {
                Some(Event::Bifurcation)
            } else if next.dlambda_ds * here.dlambda_ds < 0.0 {
                Some(Event::LimitPoint)
            } else {
                None
            };
            let read_next = read(self.stepper.engine, &next, None);
            let counts = counts(points, read_next.as_ref());
            let change = counts.map_or(0, |[before, after]| before.abs_diff(after));
            if step > COUNTED && change > usize::from(event.is_some()) {
                step *= 0.4;
                self.stepper.engine.restore(&here.state);
                continue;
            }
            if let Some(event) = event
                && let Some(end) = self.put_event(event, &here, &mut next, step_taken, points)
            {
                return end;
            }
            if event.is_none()
                && let Some(counts) = counts.filter(|_| change > 0 && change.is_multiple_of(2))
                && let Some(end) = self.put_double(&here, &next, step_taken, counts, points)
            {
                return end;
            }
            if let Some(contact) = contact {
                if let Some(end) = self.put_contact(&contact, &next, points) {
                    return end;
                }
                here = contact.after;
                self.stepper.engine.restore(&here.state);
                step = step.min(0.05);
                continue;
            }
            // Corrections may have left the range: then the next step lands on its end.
            let inside = (0.0..=1.0).contains(&next.fraction);
            let end = read_next.filter(|_| inside).and_then(|read| self.put(read, points));
            if next.fraction == 1.0 {
                return PathEnd::ReachedEnd;
            }
            if next.fraction == 0.0 {
                return PathEnd::ReachedStart;
            }
            if let Some(end) = end {
                return end;
            }
            self.stepper.went(&here, &mut next);
            here = next;
            step = (step * 1.6).min(self.control.longest);
        }
        self.stepper.end_at(&here)
    }

    /// Keeps the point of an event between two points, and goes straight on through a bifurcation; why none may come
    /// after it.
    fn put_event(
        &mut self,
        event: Event,
        here: &Point<E>,
        next: &mut Point<E>,
        step: f64,
        points: &mut Vec<PathPoint<E::Shape>>,
    ) -> Option<PathEnd> {
        let at = if event == Event::Bifurcation {
            self.stepper.bifurcation(here, next, step, self.control)
        } else {
            self.stepper.limit_point(here, next, step, self.control).0
        };
        if let Some(read) = read(self.stepper.engine, &at, Some(event))
            && let Some(end) = self.put(read, points)
        {
            return Some(end);
        }
        if event == Event::Bifurcation {
            self.bifurcations.push(at);
            self.stepper.orientation = -self.stepper.orientation;
            next.dlambda_ds = -next.dlambda_ds;
        }
        None
    }

    /// Keeps the bifurcation between two points at which two eigenvalues pass zero together, if they do; why none may
    /// come after it.
    fn put_double(
        &mut self,
        here: &Point<E>,
        next: &Point<E>,
        step: f64,
        counts: [usize; 2],
        points: &mut Vec<PathPoint<E::Shape>>,
    ) -> Option<PathEnd> {
        let at = self.stepper.double_bifurcation(here, next, step, counts, self.control)?;
        let end = read(self.stepper.engine, &at, Some(Event::Bifurcation)).and_then(|read| self.put(read, points));
        self.bifurcations.push(at);
        end
    }

    /// Keeps the point at which a cable goes slack or taut, which may be a limit point, too; why none may come after
    /// it.
    fn put_contact(
        &mut self,
        contact: &Contact<E>,
        next: &Point<E>,
        points: &mut Vec<PathPoint<E::Shape>>,
    ) -> Option<PathEnd> {
        let event = if contact.slack { Event::Slack(contact.cable) } else { Event::Taut(contact.cable) };
        let turns_back = (contact.after.dlambda_ds * next.dlambda_ds < 0.0).then_some(Event::LimitPoint);
        for event in turns_back.into_iter().chain([event]) {
            if let Some(read) = read(self.stepper.engine, &contact.after, Some(event))
                && let Some(end) = self.put(read, points)
            {
                return Some(end);
            }
        }
        None
    }

    /// Keeps a point; why none may come after it.
    fn put(&mut self, point: PathPoint<E::Shape>, points: &mut Vec<PathPoint<E::Shape>>) -> Option<PathEnd> {
        self.stopped = !(self.watch)(&point);
        points.push(point);
        self.most = self.most.saturating_sub(1);
        if self.stopped {
            return Some(PathEnd::Stopped);
        }
        (self.most == 0).then_some(PathEnd::MostPoints)
    }

    /// The branches to both sides of a bifurcation.
    fn switched(&mut self, bifurcation: &Point<E>) -> Vec<Branch<E::Shape>> {
        let mut out = Vec::new();
        for side in [1.0, -1.0] {
            let value = self.stepper.engine.value_at(bifurcation.fraction);
            if self.stopped {
                break;
            }
            if let Some(first) = self.stepper.switch(bifurcation, side, self.control) {
                out.push(self.from(first, Some(value)));
            }
        }
        out
    }
}

/// The numbers of unstable directions at the last regular point and at `next`, where both are known.
fn counts<C>(points: &[PathPoint<C>], next: Option<&PathPoint<C>>) -> Option<[usize; 2]> {
    let count = |point: &PathPoint<C>| point.stability.and_then(Stability::directions);
    let last = points.iter().rev().find(|p| p.event.is_none_or(|event| event.cable().is_some()))?;
    Some([count(last)?, next.and_then(count)?])
}

/// The configuration at a point.
fn read<E: Traced>(engine: &mut E, point: &Point<E>, event: Option<Event>) -> Option<PathPoint<E::Shape>> {
    engine.restore(&point.state);
    let value = engine.value_at(point.fraction);
    let configuration = engine.read(point.error)?;
    let stability = match event {
        // There one direction is neither stable nor unstable, by its definition.
        Some(Event::LimitPoint | Event::Bifurcation) => Some(Stability::Marginal),
        // With the cables taut that are so from there on.
        Some(Event::Slack(_) | Event::Taut(_)) | None => E::stability(&configuration),
    };
    Some(PathPoint { value, configuration, stability, event })
}
