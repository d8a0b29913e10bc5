//! The path that defines the answer: from the unloaded arm, loads first, then tensions (section 7 of
//! `docs/model.md`).

use super::contact::Contact;
use super::stepper::{Along, Fraction, Point, Stepper, Turn};
use super::{LOOSE, MEET, Pace, START, Travelled};
use crate::engine::{Engine, First, Trouble, roughly};
use crate::verdict::{Phase, Verdict, VerdictKind};

/// The tolerance (tip position over L) of the mesh on which a path ends.
const SHARP_TOLERANCE: f64 = 1e-8;

/// Fractions of a phase at which a path in a hurry may have started wrongly.
const HASTE: f64 = 1e-6;

/// Margins of cables (as in `contact`) within which a coarse mesh may have mistaken which of them changes.
const CONTACT: f64 = 1e-6;

/// The first step on that mesh.
const SHARP_STEP: f64 = 1e-3;

/// Follows both phases to whole loads, or to a verdict, with the engine at the last good point.
pub(crate) fn follow(engine: &mut Engine, pace: Pace) -> Result<Travelled, Verdict> {
    let mut outcome = follow_at(engine, pace, pace.accuracy >= LOOSE);
    if let Err(verdict) = &outcome
        && engine.in_a_hurry
        && verdict.spent.is_none()
        && (verdict.kind == VerdictKind::NotFound || verdict.load_fraction < HASTE)
    {
        // Nothing that has physics behind it: it may be the haste.
        outcome = follow_at(engine, pace, false);
    }
    engine.in_a_hurry = false;
    outcome
}

/// [`follow`], in a hurry or with care.
fn follow_at(engine: &mut Engine, mut pace: Pace, hurry: bool) -> Result<Travelled, Verdict> {
    if hurry {
        pace.longest *= 1.5;
    }
    let mut travelled = Travelled::default();
    engine.in_a_hurry = hurry;
    engine.set_phase(Phase::Loads, START);
    engine.start_unloaded(10);
    for phase in [Phase::Loads, Phase::Tension] {
        let moves = match phase {
            Phase::Loads => engine.equations.has_loads(),
            Phase::Tension => engine.equations.has_tension(),
            Phase::Stroke | Phase::Friction => false,
        };
        if moves {
            let stepper = Stepper::new(engine, Along::Phase(phase), [f64::NEG_INFINITY, 1.0]);
            Ramp { stepper, phase }.follow(pace, &mut travelled)?;
        }
        engine.set_phase(phase, 1.0);
    }
    Ok(travelled)
}

/// Follows the strokes to those commanded, or to a verdict, from the engine's equilibrium without them.
pub(crate) fn follow_strokes(engine: &mut Engine, pace: Pace) -> Result<Travelled, Verdict> {
    let mut travelled = Travelled::default();
    let phase = Phase::Stroke;
    let stepper = Stepper::new(engine, Along::Phase(phase), [f64::NEG_INFINITY, 1.0]);
    let outcome = Ramp { stepper, phase }.follow(pace, &mut travelled);
    engine.equations.let_cables_switch(true);
    outcome?;
    engine.set_phase(phase, 1.0);
    Ok(travelled)
}

/// One phase of the path.
struct Ramp<'e> {
    stepper: Stepper<'e>,
    phase: Phase,
}

impl Ramp<'_> {
    fn follow(&mut self, pace: Pace, travelled: &mut Travelled) -> Result<(), Verdict> {
        let mut here = self.start_or_verdict()?;
        // Which side of zero the determinant is on is a matter of the branch, which way is up is not.
        if here.rise < 0.0 {
            self.stepper.orientation = -self.stepper.orientation;
            here.rise = -here.rise;
        }
        self.stepper.begin(&mut here);
        let first = if self.stepper.engine.in_a_hurry { 0.2 } else { 0.1_f64.min(pace.longest) };
        let mut step = first;
        // A point before this one whose tangent climbed clearly more.
        let mut steeper = (here.fraction, here.rise);
        let mut sharpened = false;
        for attempt in 0.. {
            if self.stepper.engine.spent().is_some() {
                self.stepper.engine.restore(&here.state);
                return Err(self.end(VerdictKind::NotFound, here.fraction, None));
            }
            if attempt >= pace.most || step < 1e-8 {
                if !sharpened && let Some(point) = self.sharpen(&here) {
                    sharpened = true;
                    here = point;
                    steeper = (here.fraction, here.rise);
                    step = SHARP_STEP;
                    continue;
                }
                return Err(self.stuck(&here, steeper));
            }
            match self.stepper.advance_to_contact(&here, step, pace) {
                Ok((mut next, turn, contact)) => {
                    if turn == Turn::Crossing {
                        // The branch goes straight on through a bifurcation.
                        self.stepper.orientation = -self.stepper.orientation;
                        next.rise = -next.rise;
                        travelled.crossings += 1;
                    }
                    if next.rise < 0.0 {
                        let (_, limit) = self.stepper.limit_point(&here, &next, step, pace);
                        return Err(self.end(VerdictKind::LimitPoint, limit.clamp(0.0, 1.0), None));
                    }
                    travelled.steps += 1;
                    if let Some(Contact { after, .. }) = contact {
                        if after.rise < 0.0 {
                            // Where a cable goes slack or taut the path turns back in a corner.
                            self.stepper.engine.restore(&next.state);
                            return Err(self.end(VerdictKind::LimitPoint, next.fraction, None));
                        }
                        here = after;
                        steeper = (here.fraction, here.rise);
                        step = first;
                        continue;
                    }
                    if next.fraction == 1.0 {
                        travelled.symmetric = next.is_symmetric();
                        return Ok(());
                    }
                    if here.rise > 1.3 * next.rise {
                        steeper = (here.fraction, here.rise);
                    } else if here.rise < next.rise {
                        steeper = (next.fraction, next.rise);
                    }
                    self.stepper.went(&here, &mut next);
                    here = next;
                    step = (step * self.stepper.pace_up(true)).min(pace.longest);
                }
                Err(trouble) => {
                    self.stepper.last_trouble = Some(trouble);
                    step *= self.stepper.pace_up(false);
                    self.stepper.engine.restore(&here.state);
                }
            }
        }
        unreachable!("the loop returns when its attempts are used up")
    }

    /// [`Ramp::start`], or why there is no such point.
    fn start_or_verdict(&mut self) -> Result<Point, Verdict> {
        // What the phase before it ended with is what is last good.
        let kept = (self.phase != Phase::Loads).then(|| self.stepper.engine.state());
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

    /// Why no step leads on from `here`, given fraction and rise of a point before it whose tangent climbed clearly more.
    fn stuck(&mut self, here: &Point, steeper: (f64, f64)) -> Verdict {
        let residual = self.stepper.engine.last;
        self.stepper.engine.restore(&here.state);
        // Two branches of opposite orientation end where they meet: the path turns back in a corner
        // that the load's kinks make.
        if self.stepper.opposite.is_some_and(|fraction| (fraction - here.fraction).abs() < MEET) {
            return self.end(VerdictKind::LimitPoint, here.fraction, None);
        }
        let (kind, s) = self.stepper.name_limit(here.fraction, residual);
        let end = self.end(kind, here.fraction, s);
        // Towards a fold the square of the climb falls to zero linearly in the load.
        let fall = steeper.1.powi(2) - here.rise.powi(2);
        let ahead = (here.fraction - steeper.0) * here.rise.powi(2) / fall;
        if kind == VerdictKind::NotFound && here.rise < 0.1 && fall > 0.0 && ahead < 1e-3 {
            return self.end(VerdictKind::LimitPoint, here.fraction + ahead, None);
        }
        end
    }

    /// The point that a phase starts from. An arm that lies in the stream, or along another load, has tiny angles to it whose
    /// signs decide where it goes, so this point is made very accurate then, as far as that can be had.
    fn start(&mut self) -> Result<Point, Trouble> {
        let whole = self.stepper.engine.solution.clone();
        let mut fraction = START;
        loop {
            self.stepper.set(fraction);
            match roughly(self.stepper.engine.newton(1e-6, 12)) {
                Ok(()) => break,
                // Straight in line with the stream an arm has a kink all along, and corrections hop.
                Err(_) if fraction > 1e-5 * START => {
                    fraction *= 0.1;
                    self.stepper.engine.solution.clone_from(&whole);
                }
                Err(trouble) => return Err(trouble),
            }
        }
        let careful = !self.stepper.engine.in_a_hurry || self.stepper.engine.is_in_line();
        let accuracies: &[f64] = if careful { &[1e-5, 1e-6, 1e-7] } else { &[1e-5] };
        let refined = accuracies.iter().all(|accuracy| {
            self.stepper.or_back(|this| this.keep_accuracy(None, &mut Fraction::Fixed(fraction), [*accuracy, LOOSE]))
        });
        if refined && careful {
            self.stepper.or_back(|this| this.engine.settle(1e-8, First::Warm).map(|_| ()));
        }
        self.stepper.first_contacts(fraction)
    }

    /// The last good point, or one just before it, on a mesh that is as accurate as an answer. Where the section law ends the
    /// path it may be for what a coarse mesh makes of the ends of the arm, and where cables go slack or taut close to each other
    /// what a mesh is off by decides which does first. `None` where something else ends the path.
    fn sharpen(&mut self, here: &Point) -> Option<Point> {
        let at_contact = here.margins.iter().any(|margin| *margin < CONTACT);
        if !matches!(self.stepper.last_trouble, Some(Trouble::Section(_))) && !at_contact {
            return None;
        }
        for back in [0.0, 1e-4, 1e-3, 1e-2] {
            self.stepper.engine.restore(&here.state);
            let fraction = here.fraction * (1.0 - back);
            self.stepper.set(fraction);
            let before = self.stepper.engine.tip;
            self.stepper.engine.equations.let_cables_switch(at_contact);
            let settled = self.stepper.engine.settle(SHARP_TOLERANCE, First::Warm);
            self.stepper.engine.equations.let_cables_switch(false);
            let [x, y] = self.stepper.engine.tip;
            if settled.is_ok()
                && (x - before[0]).hypot(y - before[1]) < 10.0 * (LOOSE + back)
                && self.stepper.engine.ends_fine().is_ok()
                && let Ok(point) = self.stepper.point(fraction)
                && point.rise * here.rise > 0.0
            {
                return Some(point);
            }
        }
        None
    }

    /// A verdict at `s`, m.
    fn end(&self, kind: VerdictKind, load_fraction: f64, s: Option<f64>) -> Verdict {
        let load_fraction = if load_fraction <= START { 0.0 } else { load_fraction.min(1.0) };
        let engine = &self.stepper.engine;
        let spent = engine.spent().filter(|_| kind == VerdictKind::NotFound);
        Verdict { kind, phase: self.phase, load_fraction, s, residual: engine.last, spent }
    }

    fn never_started(&mut self) -> Verdict {
        self.stepper.engine.last = 0.0;
        let engine = &self.stepper.engine;
        if engine.spent().is_none() && engine.equations.arm().readings.load_can_jump() {
            let length = self.stepper.engine.equations.units.length;
            let place = self.stepper.engine.nearest_switch();
            self.end(VerdictKind::LoadJump, 0.0, place.map(|s| s * length))
        } else {
            self.end(VerdictKind::NotFound, 0.0, None)
        }
    }
}
