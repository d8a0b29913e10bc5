//! The path that defines the answer: from the unloaded arm, loads first, then tensions (section 7 of
//! `docs/model.md`).

use super::beside::follow_tensions;
use super::contact::Contact;
use super::loaded::Loaded;
use super::step_control::{LOOSE, MEET, PathSummary, START, StepControl};
use super::stepper::{Fraction, Point, StepOutcome, Stepper};
use super::traced::Along;
use crate::statics::engine::{Engine, Trouble, roughly};
use crate::statics::refinement::First;
use crate::statics::snap::{Snap, SnapBounds};
use crate::statics::stability::Stability;
use crate::statics::verdict::{Phase, Verdict, VerdictKind};

/// The tolerance (tip position over L) of the mesh on which a path ends.
const SHARP_TOLERANCE: f64 = 1e-8;

/// Fractions of a phase at which a path in a hurry may have started wrongly.
const HASTE: f64 = 1e-6;

/// Margins of cables (as in `contact`) within which a coarse mesh may have mistaken which of them changes.
const CONTACT: f64 = 1e-6;

/// Attempts at steps beyond a limit point, by which the path has to lead on.
const BEYOND: usize = 400;

/// The first step on that mesh.
const SHARP_STEP: f64 = 1e-3;

/// Where a path ends without an answer. The engine is at the last good point.
pub(crate) struct Stopped<E: Loaded = Engine> {
    pub(crate) verdict: Verdict,
    /// The snaps on the way, with the one that is refused.
    pub(crate) snaps: Vec<Snap<E::Tip>>,
    /// Where the arm lands after the refused snap.
    pub(crate) after_snap: Option<Box<E::State>>,
    /// The end of the path beyond that snap, at whole loads.
    pub(crate) at_full_loads: Option<Box<E::State>>,
}

impl<E: Loaded> From<Verdict> for Stopped<E> {
    fn from(verdict: Verdict) -> Self {
        Self { verdict, snaps: Vec::new(), after_snap: None, at_full_loads: None }
    }
}

/// A snap that goes too far, after which the path is followed for what lies beyond.
struct Refused<E: Loaded> {
    verdict: Verdict,
    /// At the limit point.
    before: E::State,
    after: E::State,
}

/// Follows both phases to whole loads, or to a verdict, with the engine at the last good point.
pub(crate) fn follow<E: Loaded>(
    engine: &mut E,
    control: StepControl,
    bounds: SnapBounds,
) -> Result<PathSummary<E::Tip>, Stopped<E>> {
    let hurry = control.accuracy >= LOOSE;
    let mut outcome = follow_at(engine, control, bounds, hurry);
    if let Err(Stopped { verdict, .. }) = &outcome
        && hurry
        && verdict.spent.is_none()
        && (verdict.kind == VerdictKind::NotFound || verdict.load_fraction < HASTE)
    {
        // Nothing that has physics behind it: it may be the haste.
        outcome = follow_at(engine, control, bounds, false);
    }
    engine.hurry(false);
    outcome
}

/// [`follow`], in a hurry or with care.
fn follow_at<E: Loaded>(
    engine: &mut E,
    mut control: StepControl,
    bounds: SnapBounds,
    hurry: bool,
) -> Result<PathSummary<E::Tip>, Stopped<E>> {
    if hurry {
        control.longest *= 1.5;
    }
    let mut way = Way::new(bounds);
    engine.hurry(hurry);
    engine.set(Along::Phase(Phase::Loads), START);
    engine.start_unloaded();
    for (phase, acts) in [(Phase::Loads, engine.has_loads()), (Phase::Tension, engine.has_tension())] {
        if acts && let Err(verdict) = way.along(engine, phase, control) {
            return Err(way.stopped(engine, verdict));
        }
        engine.set(Along::Phase(phase), 1.0);
    }
    way.whole(engine)
}

/// Follows the path on to whole loads, or to a verdict, from the engine's equilibrium at the fraction `from` of
/// `phase`.
pub(crate) fn follow_on<E: Loaded>(
    engine: &mut E,
    (phase, from): (Phase, f64),
    control: StepControl,
    bounds: SnapBounds,
) -> Result<PathSummary<E::Tip>, Stopped<E>> {
    let mut way = Way::new(bounds);
    if from < 1.0 {
        let outcome = way.along_from(engine, phase, Some(from), control);
        engine.let_cables_switch(true);
        if let Err(verdict) = outcome {
            return Err(way.stopped(engine, verdict));
        }
    }
    engine.set(Along::Phase(phase), 1.0);
    if phase == Phase::Loads && engine.has_tension() {
        if let Err(verdict) = way.along(engine, Phase::Tension, control) {
            return Err(way.stopped(engine, verdict));
        }
        engine.set(Along::Phase(Phase::Tension), 1.0);
    }
    way.whole(engine)
}

/// Follows the range that the engine's equations vary over to its end, or to a verdict, from the engine's equilibrium
/// at the fraction `from` of it. Behind a limit point it is followed down to the fraction `lowest`. Fractions of snaps
/// and verdicts are fractions of the range, and their phase says nothing.
pub(crate) fn follow_range<E: Loaded>(
    engine: &mut E,
    [from, lowest]: [f64; 2],
    control: StepControl,
    bounds: SnapBounds,
) -> Result<PathSummary<E::Tip>, Stopped<E>> {
    let mut way = Way::new(bounds);
    let stepper = Stepper::new(engine, Along::Range, [f64::NEG_INFINITY, 1.0]);
    let outcome = Ramp { stepper, phase: Phase::Tension, from: Some(from), lowest, way: &mut way, turned_back: None }
        .follow(control);
    engine.let_cables_switch(true);
    if let Err(verdict) = outcome {
        return Err(way.stopped(engine, verdict));
    }
    engine.set(Along::Range, 1.0);
    way.whole(engine)
}

/// Follows the strokes to those commanded, or to a verdict, from the engine's equilibrium without them.
pub(crate) fn follow_strokes<E: Loaded>(
    engine: &mut E,
    control: StepControl,
    bounds: SnapBounds,
) -> Result<PathSummary<E::Tip>, Stopped<E>> {
    let mut way = Way::new(bounds);
    let outcome = way.along(engine, Phase::Stroke, control);
    engine.let_cables_switch(true);
    if let Err(verdict) = outcome {
        return Err(way.stopped(engine, verdict));
    }
    engine.set(Along::Phase(Phase::Stroke), 1.0);
    way.whole(engine)
}

/// What the path has met so far.
struct Way<E: Loaded> {
    bounds: SnapBounds,
    travelled: PathSummary<E::Tip>,
    refused: Option<Refused<E>>,
}

impl<E: Loaded> Way<E> {
    fn new(bounds: SnapBounds) -> Self {
        Self { bounds, travelled: PathSummary::default(), refused: None }
    }

    /// One phase of the path.
    fn along(&mut self, engine: &mut E, phase: Phase, control: StepControl) -> Result<(), Verdict> {
        if phase != Phase::Tension || engine.is_in_a_hurry() {
            return self.along_from(engine, phase, None, control);
        }
        follow_tensions(engine, |engine, from| self.along_from(engine, phase, from, control))
    }

    /// The rest of a phase, from the engine's equilibrium at a fraction of it where there is one.
    fn along_from(
        &mut self,
        engine: &mut E,
        phase: Phase,
        from: Option<f64>,
        control: StepControl,
    ) -> Result<(), Verdict> {
        let stepper = Stepper::new(engine, Along::Phase(phase), [f64::NEG_INFINITY, 1.0]);
        Ramp { stepper, phase, from, lowest: 0.0, way: self, turned_back: None }.follow(control)
    }

    /// The end of the path at whole loads.
    fn whole(self, engine: &mut E) -> Result<PathSummary<E::Tip>, Stopped<E>> {
        let Some(refused) = self.refused else { return Ok(self.travelled) };
        let end = engine.state();
        engine.restore(&refused.before);
        let Refused { verdict, after, .. } = refused;
        Err(Stopped {
            verdict,
            snaps: self.travelled.snaps,
            after_snap: Some(after.into()),
            at_full_loads: Some(end.into()),
        })
    }

    /// The end of the path before that, for the reason that `verdict` gives.
    fn stopped(self, engine: &mut E, verdict: Verdict) -> Stopped<E> {
        let snaps = self.travelled.snaps;
        let Some(Refused { verdict, before, after }) = self.refused else {
            return Stopped { snaps, ..verdict.into() };
        };
        engine.restore(&before);
        Stopped { verdict, snaps, after_snap: Some(after.into()), at_full_loads: None }
    }
}

/// A limit point at which the path turned back, and past whose load it has not come again.
struct TurnedBack<E: Loaded> {
    fraction: f64,
    state: E::State,
    /// `None` where the section at the tip is at its limit.
    tip: Option<E::Tip>,
}

/// One phase of the path.
struct Ramp<'e, 'w, E: Loaded> {
    stepper: Stepper<'e, E>,
    phase: Phase,
    /// The fraction at which the engine has an equilibrium to start from, where it does.
    from: Option<f64>,
    /// The fraction below which it is not followed once it has turned back.
    lowest: f64,
    way: &'w mut Way<E>,
    turned_back: Option<TurnedBack<E>>,
}

impl<E: Loaded> Ramp<'_, '_, E> {
    fn follow(&mut self, control: StepControl) -> Result<(), Verdict> {
        let mut here = self.start_or_verdict()?;
        // Which side of zero the determinant is on is a matter of the branch, which way is up is not.
        if here.dlambda_ds < 0.0 {
            self.stepper.orientation = -self.stepper.orientation;
            here.dlambda_ds = -here.dlambda_ds;
        }
        self.stepper.begin(&mut here);
        let first = if self.stepper.engine.is_in_a_hurry() { 0.2 } else { 0.1_f64.min(control.longest) };
        let mut step = first;
        // A point before this one with a clearly larger dlambda/ds.
        let mut steeper = (here.fraction, here.dlambda_ds);
        let mut sharpened = false;
        let mut most = control.most;
        let mut attempt = 0;
        loop {
            if self.stepper.engine.spent().is_some() {
                self.stepper.engine.restore(&here.state);
                // A limit point that was met before says more.
                let turned_back = self.does_not_lead_on();
                return Err(turned_back.unwrap_or_else(|| self.end(VerdictKind::NotFound, here.fraction, None)));
            }
            if attempt >= most || step < 1e-8 {
                if let Some(verdict) = self.does_not_lead_on() {
                    return Err(verdict);
                }
                if !sharpened && let Some(point) = self.sharpen(&here) {
                    sharpened = true;
                    here = point;
                    steeper = (here.fraction, here.dlambda_ds);
                    step = SHARP_STEP;
                    continue;
                }
                return Err(self.stuck(&here, steeper));
            }
            attempt += 1;
            match self.stepper.advance_to_contact(&here, step, control) {
                Ok((mut next, turn, contact)) => {
                    if turn == StepOutcome::Bifurcation {
                        // The branch goes straight on through a bifurcation.
                        self.stepper.orientation = -self.stepper.orientation;
                        next.dlambda_ds = -next.dlambda_ds;
                        self.way.travelled.bifurcations += 1;
                    }
                    if self.turned_back.is_some() {
                        if next.fraction <= self.lowest
                            && let Some(verdict) = self.does_not_lead_on()
                        {
                            return Err(verdict);
                        }
                        if self.comes_past(&here, &next) && !self.land(&here, control) {
                            // The step goes round the next limit point, too.
                            step *= 0.4;
                            continue;
                        }
                    } else if next.dlambda_ds < 0.0 {
                        let (_, limit) = self.stepper.limit_point(&here, &next, step, control);
                        self.turn_back(limit.clamp(0.0, 1.0));
                        most = most.max(attempt + BEYOND);
                    }
                    self.way.travelled.steps += 1;
                    if let Some(Contact { after, .. }) = contact {
                        if after.dlambda_ds < 0.0 && self.turned_back.is_none() {
                            // Where a cable goes slack or taut the path turns back in a corner.
                            self.stepper.engine.restore(&next.state);
                            self.turn_back(next.fraction);
                            most = most.max(attempt + BEYOND);
                        }
                        here = after;
                        steeper = (here.fraction, here.dlambda_ds);
                        step = first;
                        continue;
                    }
                    if next.fraction == 1.0 {
                        if let Some(verdict) = self.does_not_lead_on() {
                            return Err(verdict);
                        }
                        self.way.travelled.symmetric = next.is_symmetric();
                        return Ok(());
                    }
                    if here.dlambda_ds > 1.3 * next.dlambda_ds {
                        steeper = (here.fraction, here.dlambda_ds);
                    } else if here.dlambda_ds < next.dlambda_ds {
                        steeper = (next.fraction, next.dlambda_ds);
                    }
                    self.stepper.went(&here, &mut next);
                    here = next;
                    step = (step * self.stepper.pace_up(true)).min(control.longest);
                }
                Err(trouble) => {
                    self.stepper.last_trouble = Some(trouble);
                    step *= self.stepper.pace_up(false);
                    self.stepper.engine.restore(&here.state);
                }
            }
        }
    }

    /// Notes the limit point that the engine is at.
    fn turn_back(&mut self, fraction: f64) {
        let engine = &self.stepper.engine;
        self.turned_back = Some(TurnedBack { fraction, state: engine.state(), tip: engine.tip() });
        self.stepper.bounds[0] = self.lowest;
    }

    /// Whether a step leads past the load of the limit point again, upwards.
    fn comes_past(&self, here: &Point<E>, next: &Point<E>) -> bool {
        self.turned_back.as_ref().is_some_and(|limit| here.fraction < limit.fraction && next.fraction >= limit.fraction)
    }

    /// The arm lands where a step from `here` comes past the load of the limit point, if that shape is stable. Whether
    /// the path is known that far.
    fn land(&mut self, here: &Point<E>, control: StepControl) -> bool {
        let Some(limit) = self.turned_back.take() else { return true };
        let kept = (self.stepper.engine.state(), self.stepper.orientation);
        // From before the second limit point no tangent leads there.
        let landed = here.dlambda_ds > 0.0
            && self.stepper.land(here, limit.fraction, StepControl { straightness: -1.0, ..control }).is_ok();
        let snap = if landed { self.landing(&limit) } else { None };
        let after = self.stepper.engine.state();
        self.stepper.engine.restore(&kept.0);
        self.stepper.orientation = kept.1;
        let Some((snap, stable)) = snap else {
            self.turned_back = Some(limit);
            return false;
        };
        if !stable {
            // The arm does not stay there: the path may come past this load once more.
            self.turned_back = Some(limit);
            return true;
        }
        self.stepper.bounds[0] = f64::NEG_INFINITY;
        self.way.travelled.bifurcations = 0;
        if self.way.refused.is_some() {
            return true;
        }
        let holds = self.way.bounds.allow(&snap, self.stepper.engine.arm().length);
        self.way.travelled.snaps.push(snap);
        if !holds {
            let verdict = self.end(VerdictKind::LimitPoint, limit.fraction, None);
            self.way.refused = Some(Refused { verdict, before: limit.state, after });
        }
        true
    }

    /// The snap from a limit point to the engine's shape, and whether that is stable.
    fn landing(&mut self, limit: &TurnedBack<E>) -> Option<(Snap<E::Tip>, bool)> {
        let engine = &mut *self.stepper.engine;
        let estimate = engine.settle(SHARP_TOLERANCE, First::Warm).ok()?;
        let (before, after) = (limit.tip?, engine.tip()?);
        let read = engine.read(estimate)?;
        let stable = matches!(E::stability(&read), Some(Stability::Stable) | None);
        let snap = Snap { phase: self.phase, load_fraction: limit.fraction, before, after };
        Some((snap, stable))
    }

    /// Why a path that turned back has not come past the limit point again; the engine is at that.
    fn does_not_lead_on(&mut self) -> Option<Verdict> {
        let limit = self.turned_back.take()?;
        self.stepper.engine.restore(&limit.state);
        Some(self.end(VerdictKind::LimitPoint, limit.fraction, None))
    }

    /// [`Ramp::start`], or why there is no such point.
    fn start_or_verdict(&mut self) -> Result<Point<E>, Verdict> {
        // What the phase before it ended with is what is last good.
        let kept = (self.phase != Phase::Loads || self.from.is_some()).then(|| self.stepper.engine.state());
        self.start().map_err(|_| {
            if let Some(kept) = kept {
                self.stepper.engine.restore(&kept);
            }
            if self.phase == Phase::Stroke && self.stepper.nothing_reels_in() {
                return self.end(VerdictKind::LimitPoint, 0.0, None);
            }
            self.never_started()
        })
    }

    /// Why no step leads on from `here`, given fraction and dlambda/ds of a point before it with a clearly larger
    /// dlambda/ds.
    fn stuck(&mut self, here: &Point<E>, steeper: (f64, f64)) -> Verdict {
        let residual = *self.stepper.engine.last_mut();
        self.stepper.engine.restore(&here.state);
        let (kind, s) = self.stepper.name_limit(here.fraction, residual);
        // Two branches of opposite orientation end where they meet: the path turns back in a corner
        // that the load's kinks make. Where sections end it, branches beyond are none.
        let of_sections =
            kind != VerdictKind::NotFound && matches!(self.stepper.last_trouble, Some(Trouble::Section(_)));
        // At its very beginning a path can be at such a corner of a shape that lies in the stream, and turn nowhere.
        let is_under_way = here.fraction > MEET;
        if !of_sections
            && is_under_way
            && self.stepper.opposite.is_some_and(|fraction| (fraction - here.fraction).abs() < MEET)
        {
            return self.end(VerdictKind::LimitPoint, here.fraction, None);
        }
        let end = self.end(kind, here.fraction, s);
        // Towards a fold the square of dlambda/ds falls to zero linearly in the load.
        let fall = steeper.1.powi(2) - here.dlambda_ds.powi(2);
        let ahead = (here.fraction - steeper.0) * here.dlambda_ds.powi(2) / fall;
        if kind == VerdictKind::NotFound && here.dlambda_ds < 0.1 && fall > 0.0 && ahead < 1e-3 {
            return self.end(VerdictKind::LimitPoint, here.fraction + ahead, None);
        }
        end
    }

    /// The point that a phase starts from. An arm that lies in the stream, or along another load, has tiny angles to it
    /// whose signs decide where it goes, so this point is made very accurate then, as far as that can be had.
    fn start(&mut self) -> Result<Point<E>, Trouble> {
        if let Some(from) = self.from {
            self.stepper.set(from);
            roughly(self.stepper.engine.newton(1e-6, 12))?;
            self.stepper.keep_accuracy(None, &mut Fraction::Fixed(from), [LOOSE, LOOSE])?;
            return self.stepper.first_contacts(from);
        }
        let whole = self.stepper.engine.guess();
        let mut fraction = START;
        loop {
            self.stepper.set(fraction);
            match roughly(self.stepper.engine.newton(1e-6, 12)) {
                Ok(()) => break,
                // Straight in line with the stream an arm has a kink all along, and corrections hop.
                Err(_) if fraction > 1e-5 * START => {
                    fraction *= 0.1;
                    self.stepper.engine.take_guess(&whole);
                }
                Err(trouble) => return Err(trouble),
            }
        }
        let careful = !self.stepper.engine.is_in_a_hurry() || self.stepper.engine.may_be_in_line();
        let accuracies: &[f64] = if careful { &[1e-5, 1e-6, 1e-7] } else { &[1e-5] };
        let refined = accuracies.iter().all(|accuracy| {
            self.stepper.or_back(|this| this.keep_accuracy(None, &mut Fraction::Fixed(fraction), [*accuracy, LOOSE]))
        });
        if refined && careful {
            self.stepper.or_back(|this| this.engine.settle(1e-8, First::Warm).map(|_| ()));
        }
        self.stepper.first_contacts(fraction)
    }

    /// The last good point, or one just before it, on a mesh that is as accurate as an answer. Where the section law
    /// ends the path it may be for what a coarse mesh makes of the ends of the arm, and where cables go slack or taut
    /// close to each other what a mesh is off by decides which does first. `None` where something else ends the path.
    fn sharpen(&mut self, here: &Point<E>) -> Option<Point<E>> {
        let at_contact = here.margins.iter().any(|margin| *margin < CONTACT);
        if !matches!(self.stepper.last_trouble, Some(Trouble::Section(_))) && !at_contact {
            return None;
        }
        for back in [0.0, 1e-4, 1e-3, 1e-2] {
            self.stepper.engine.restore(&here.state);
            let fraction = here.fraction * (1.0 - back);
            self.stepper.set(fraction);
            let before = self.stepper.engine.tip_place();
            self.stepper.engine.let_cables_switch(at_contact);
            let settled = self.stepper.engine.settle(SHARP_TOLERANCE, First::Warm);
            self.stepper.engine.let_cables_switch(false);
            let [x, y, z] = self.stepper.engine.tip_place();
            if settled.is_ok()
                && (x - before[0]).hypot(y - before[1]).hypot(z - before[2]) < 10.0 * (LOOSE + back)
                && self.stepper.engine.check_ends().is_ok()
                && let Ok(point) = self.stepper.point(fraction)
                && point.dlambda_ds * here.dlambda_ds > 0.0
            {
                return Some(point);
            }
        }
        None
    }

    /// A verdict at `s`, m.
    fn end(&mut self, kind: VerdictKind, load_fraction: f64, s: Option<f64>) -> Verdict {
        let load_fraction = if load_fraction <= START { 0.0 } else { load_fraction.min(1.0) };
        let engine = &mut *self.stepper.engine;
        let spent = engine.spent().filter(|_| kind == VerdictKind::NotFound);
        Verdict { kind, phase: self.phase, load_fraction, s, residual: *engine.last_mut(), spent }
    }

    fn never_started(&mut self) -> Verdict {
        *self.stepper.engine.last_mut() = 0.0;
        let engine = &self.stepper.engine;
        if engine.spent().is_none() && engine.arm().model.load_can_jump() {
            let length = self.stepper.engine.arm().length;
            let place = self.stepper.engine.place_of_jump();
            self.end(VerdictKind::LoadJump, 0.0, place.map(|s| s * length))
        } else {
            self.end(VerdictKind::NotFound, 0.0, None)
        }
    }
}
