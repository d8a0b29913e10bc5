//! The clock of a session: an arm in motion under loads that the page ramps, lets go, and pulls with a hand.
//!
//! The page asks for a piece of time with every message, so that nothing moves for a page that has gone. A message moves
//! the arm on by at most [`limits::MOTION_BY`] and works for about [`limits::MOTION_WORK`]; where that does not suffice the
//! answer says how far it came.

use std::str::FromStr;
use std::time::Instant;

use axum::http::StatusCode;
use hydrostat::{Arm, CableMotion, MotionError, MotionVerdict, MotionWarning, Parameter};
use hydrostat_files::{ArmFile, EventOut, Inputs, MotionShape, Note};
use serde::{Deserialize, Serialize};

use crate::arm_source::{Settings, arm, overridden};
use crate::hand::Hand;
use crate::limits;
use crate::moving::{Moving, Now, moving};
use crate::problem::Problem;

/// Less time than this, s, is none: steps are not cut so short.
const OVER: f64 = 1e-6;

/// What the page wants of the clock.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MotionWish {
    /// Begins at the time 0, at rest in the equilibrium of the arm.
    #[serde(default)]
    pub(crate) start: bool,
    /// How far to move on, s.
    by: f64,
    /// Loads that change, by the keys and in the units of the arm file.
    #[serde(default)]
    loads: Settings,
    /// How long they take to get there, along straight lines, s; zero is a jump.
    #[serde(default)]
    within: f64,
    /// Where a hand pulls the tip to, two numbers in the plane and three in space, m.
    hold: Option<Vec<f64>>,
}

/// The arm at the present time.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct MotionOut {
    shape: MotionShape,
    /// Section stretch at the stations.
    beta: Vec<f64>,
    /// Velocity of the tip, m/s.
    velocity: [f64; 3],
    cables: Vec<CableOut>,
    /// J.
    kinetic_energy: f64,
    strain_energy: f64,
    /// Done on the arm since the start, J; dissipated is taken from it.
    works: WorksOut,
    /// What the hand exerts on the tip, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    hand: Option<[f64; 3]>,
    /// Of the tip, m.
    error_estimate: f64,
    /// What happened since the answer before.
    events: Vec<EventOut>,
    warnings: Vec<Note>,
    /// The arm with its present loads, where they are not those of the answer before.
    #[serde(skip_serializing_if = "Option::is_none")]
    inputs: Option<Inputs>,
    /// Whether loads are still on their way.
    ramping: bool,
    /// Why nothing moves any more.
    #[serde(skip_serializing_if = "Option::is_none")]
    ended: Option<EndOut>,
}

#[derive(Debug, Clone, Serialize)]
struct CableOut {
    tension: f64,
    stroke: f64,
}

#[derive(Debug, Clone, Serialize)]
struct WorksOut {
    cables: f64,
    water: f64,
    gravity: f64,
    loads: f64,
    base: f64,
    volume: f64,
    dissipated: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct EndOut {
    kind: &'static str,
    time: f64,
    s: Option<f64>,
    message: String,
}

/// A load on its way from one value to another.
#[derive(Debug, Clone)]
struct Ramp {
    key: String,
    parameter: Parameter,
    values: [f64; 2],
    times: [f64; 2],
}

impl Ramp {
    fn at(&self, time: f64) -> f64 {
        let ([from, to], [start, end]) = (self.values, self.times);
        if time >= end - OVER { to } else { from + (to - from) * ((time - start) / (end - start)).max(0.0) }
    }
}

/// An arm in motion.
pub(crate) struct Run {
    /// What loads are read with.
    file: ArmFile,
    /// With the present loads, without the hand.
    arm: Arm,
    moving: Box<dyn Moving>,
    now: Now,
    ramps: Vec<Ramp>,
    hand: Hand,
    /// Stations of answers, m.
    pub(crate) places: Vec<f64>,
    /// The first jump of a load in a material without memory of rate, s.
    jumped: Option<f64>,
    /// Events that the page has.
    told: usize,
    /// The arm whose loads the page has.
    shown: Option<Arm>,
    ended: Option<MotionVerdict>,
}

impl Run {
    /// At rest in the equilibrium of the arm, with `count` stations.
    pub(crate) fn begin(file: ArmFile, arm: Arm, count: usize) -> Result<Self, Problem> {
        let mut moving = moving(&arm, None)?;
        let last = count.saturating_sub(1).max(1) as f64;
        Ok(Self {
            now: moving.now(),
            places: (0..count).map(|i| arm.length * i as f64 / last).collect(),
            hand: Hand::of(&arm),
            file,
            arm,
            moving,
            ramps: Vec::new(),
            jumped: None,
            told: 0,
            shown: None,
            ended: None,
        })
    }

    /// The arm with its present loads.
    pub(crate) fn arm(&self) -> &Arm {
        &self.arm
    }

    /// Does what is wanted.
    pub(crate) fn answer(&mut self, wish: &MotionWish) -> Result<MotionOut, Problem> {
        let MotionWish { by, within, .. } = *wish;
        if !(0.0..=limits::MOTION_BY).contains(&by) {
            let message = format!("motion.by: expected 0 to {} s, found {by}", limits::MOTION_BY);
            return Err(Problem::field("motion.by", message));
        }
        if !(0.0..=limits::MOTION_WITHIN).contains(&within) {
            let message = format!("motion.within: expected 0 to {} s, found {within}", limits::MOTION_WITHIN);
            return Err(Problem::field("motion.within", message));
        }
        let at = wish.hold.as_deref().map(|hold| self.place(hold)).transpose()?;
        if self.ended.is_none() {
            if !wish.loads.is_empty() {
                self.lead(&wish.loads, within)?;
            }
            self.hand.at = at;
            self.move_on(by)?;
            self.renew()?;
        }
        Ok(self.out())
    }

    fn place(&self, hold: &[f64]) -> Result<[f64; 3], Problem> {
        let in_space = self.arm.space.is_some();
        let place = match (hold, in_space) {
            ([x, y], false) => [*x, *y, 0.0],
            ([x, y, z], true) => [*x, *y, *z],
            _ => [f64::NAN; 3],
        };
        if place.iter().all(|v| v.is_finite()) {
            return Ok(place);
        }
        let count = if in_space { "three finite numbers, x, y and z" } else { "two finite numbers, x and y" };
        Err(Problem::field("motion.hold", format!("motion.hold: expected {count} in m")))
    }

    /// Sets out for other loads.
    fn lead(&mut self, loads: &Settings, within: f64) -> Result<(), Problem> {
        let wanted = arm(&overridden(self.file.clone(), loads)?)?;
        let mut led = Vec::new();
        for key in loads.keys() {
            let wrong = |error: String| Problem::field("motion.loads", format!("motion.loads: {key}: {error}"));
            let parameter = Parameter::from_str(key).map_err(|error| wrong(error.to_string()))?;
            let of = |arm: &Arm| parameter.of(arm).map_err(|error| wrong(error.to_string()));
            let (values, start) = ([of(&self.arm)?, of(&wanted)?], self.now.time);
            // The key is refused here where it cannot change over time.
            let mut course = hydrostat::Inputs::default();
            course.set(key, hydrostat::Course::constant(values[1]))?;
            if values[0] == values[1] && self.ramps.iter().all(|own| own.parameter != parameter) {
                continue;
            }
            led.push(Ramp { key: key.clone(), parameter, values, times: [start, start + within] });
        }
        self.ramps.retain(|own| led.iter().all(|new| new.parameter != own.parameter));
        if within > OVER {
            self.ramps.append(&mut led);
            return Ok(());
        }
        // A jump: the motion goes on from here under other loads.
        let mut arm = self.arm.clone();
        for Ramp { parameter, values: [_, to], .. } in &led {
            parameter.set(&mut arm, *to).map_err(MotionError::Unfit)?;
        }
        if arm != self.arm {
            let mut state = self.moving.state().under_other_loads();
            let dynamics = &arm.dynamics;
            if dynamics.inertia && dynamics.relaxation_time == 0.0 {
                // As people read it: to a microsecond.
                self.jumped = self.jumped.or(Some((1e6 * self.now.time).round() / 1e6));
            }
            state.jumped = self.jumped;
            self.moving = moving(&self.pulled(&arm), Some(&state))?;
            self.told = 0;
            self.arm = arm;
        }
        Ok(())
    }

    /// `arm` with what the hand exerts.
    fn pulled(&self, arm: &Arm) -> Arm {
        let mut out = arm.clone();
        for (k, name) in (0..self.dimensions()).zip(FORCE) {
            if let Ok(parameter) = Parameter::from_str(name) {
                let own = parameter.of(&out).unwrap_or_default();
                let _ = parameter.set(&mut out, own + self.hand.force[k]);
            }
        }
        out
    }

    fn dimensions(&self) -> usize {
        if self.arm.space.is_some() { 3 } else { 2 }
    }

    /// Moves on by `by` (s), as far as the time for it goes.
    fn move_on(&mut self, by: f64) -> Result<(), Problem> {
        let (end, until) = (self.now.time + by, Instant::now() + limits::MOTION_WORK);
        while end - self.now.time > OVER && Instant::now() < until {
            let start = self.now.time;
            let mut to = if self.hand.is_felt() { end.min(start + self.hand.step) } else { end };
            to = self.ramps.iter().fold(to, |to, ramp| to.min(ramp.times[1].max(start + OVER)));
            let before = self.hand.force;
            let mut ahead = self.hand.ahead(&self.now, to - start);
            let kept = self.hand.at.map(|_| self.moving.copy());
            let mut moved = self.step(to, &ahead, until);
            if let (Ok(now), Some(kept)) = (&moved, kept)
                && to - now.time < OVER
                && self.hand.is_off(now, &ahead)
            {
                ahead = self.hand.ahead(now, 0.0);
                self.moving = kept;
                moved = self.step(to, &ahead, until);
            }
            self.now = match moved {
                Ok(now) => now,
                Err(MotionError::Ended(verdict)) => {
                    self.ended = Some(verdict);
                    return Ok(());
                }
                Err(error) => return Err(error.into()),
            };
            let time = self.now.time;
            let share = ((time - start) / (to - start)).min(1.0);
            self.hand.force = std::array::from_fn(|k| before[k] + share * (ahead[k] - before[k]));
            for ramp in &self.ramps {
                ramp.parameter.set(&mut self.arm, ramp.at(time)).map_err(MotionError::Unfit)?;
            }
            self.ramps.retain(|ramp| time < ramp.times[1] - OVER);
        }
        Ok(())
    }

    /// One step to `to` (s), over which the hand's force becomes `ahead` (N).
    fn step(&mut self, to: f64, ahead: &[f64; 3], until: Instant) -> Result<Now, MotionError> {
        let mut loads: Vec<(&str, f64)> = self.ramps.iter().map(|ramp| (ramp.key.as_str(), ramp.at(to))).collect();
        if self.hand.is_felt() {
            for (k, name) in (0..self.dimensions()).zip(FORCE) {
                let own = match loads.iter().position(|(key, _)| *key == name) {
                    Some(i) => loads.remove(i).1,
                    None => Parameter::from_str(name).ok().and_then(|p| p.of(&self.arm).ok()).unwrap_or_default(),
                };
                loads.push((name, own + ahead[k]));
            }
        }
        self.moving.move_on(to - self.now.time, &loads, &mut || Instant::now() < until)?;
        Ok(self.moving.now())
    }

    /// A run has a largest number of steps; a clock has none, and begins another run before it comes to that.
    fn renew(&mut self) -> Result<(), Problem> {
        let taken = self.moving.statistics();
        if taken.steps + taken.rejected > limits::MOTION_STEPS {
            self.moving = moving(&self.pulled(&self.arm), Some(&self.moving.state()))?;
            self.told = 0;
        }
        Ok(())
    }

    fn out(&mut self) -> MotionOut {
        let (shape, stretches) = self.moving.shape(&self.places);
        let volume = self.arm.model.volume;
        let inputs = (self.shown.as_ref() != Some(&self.arm)).then(|| Inputs::new(&self.arm));
        if inputs.is_some() {
            self.shown = Some(self.arm.clone());
        }
        let all = self.moving.events();
        let events = EventOut::all(all.get(self.told..).unwrap_or_default(), None);
        self.told = all.len();
        let note = |warning: MotionWarning| Note { kind: warning.kind(), message: warning.message() };
        let cable = |cable: &CableMotion| CableOut { tension: cable.tension, stroke: cable.stroke };
        let works = self.now.works;
        MotionOut {
            shape,
            beta: stretches.iter().map(|nu| volume.section_stretch(*nu)).collect(),
            velocity: self.now.velocity,
            cables: self.now.cables.iter().map(cable).collect(),
            kinetic_energy: self.now.kinetic,
            strain_energy: self.now.strained,
            works: WorksOut {
                cables: works.cables,
                water: works.water,
                gravity: works.gravity,
                loads: works.loads,
                base: works.base,
                volume: works.volume,
                dissipated: works.dissipated,
            },
            hand: self.hand.is_felt().then_some(self.hand.force),
            error_estimate: self.moving.error_estimate(),
            events,
            warnings: self.moving.warnings().into_iter().map(note).collect(),
            inputs,
            ramping: !self.ramps.is_empty(),
            ended: self.ended.map(|end| EndOut {
                kind: end.kind.name(),
                time: end.time,
                s: end.s,
                message: end.message(),
            }),
        }
    }
}

/// The keys of the force on the tip.
const FORCE: [&str; 3] = ["tip.force[0]", "tip.force[1]", "tip.force[2]"];

/// A message for a clock that was not started, or whose run went with the connection.
pub(crate) fn no_run() -> Problem {
    let message = "motion: nothing moves; begin with start";
    Problem::new(StatusCode::CONFLICT, "no_motion", Some("motion"), message)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm_source::ArmSource;
    use hydrostat::{Course, MotionOptions, Simulation};

    fn run(name: &str, set: &str) -> Run {
        let settings: Settings = serde_json::from_str(set).unwrap();
        let file = overridden(ArmSource::Name(name.to_owned()).file().unwrap(), &settings).unwrap();
        let arm = file.arm().unwrap();
        Run::begin(file, arm, 11).unwrap()
    }

    fn wish(text: &str) -> MotionWish {
        serde_json::from_str(text).unwrap()
    }

    /// Asks for `time` (s) in pieces, the first with `more` fields, and for what a piece did not come to. All of them have
    /// `kept` fields.
    fn moved(run: &mut Run, time: f64, more: &str, kept: &str) -> MotionOut {
        let end = run.now.time + time;
        let mut out = run.answer(&wish(&format!(r#"{{"by": 0{more}{kept}}}"#))).unwrap();
        while end - run.now.time > 1e-5 && out.ended.is_none() {
            let by = (end - run.now.time).min(1.0 / 30.0);
            out = run.answer(&wish(&format!(r#"{{"by": {by:?}{kept}}}"#))).unwrap();
        }
        out
    }

    const SOFT: &str = r#"{"dynamics.relaxation_time": 0.0027, "flow.speed": 0.1, "flow.direction": 90}"#;

    #[test]
    fn a_ramp_and_a_release_are_those_of_a_run_with_the_same_loads() {
        let mut own = run("silicone", SOFT);
        let arm = own.arm.clone();
        let ramped = moved(&mut own, 0.1, r#", "loads": {"cable[0].tension": 0.2}, "within": 0.2"#, "");
        assert!(ramped.ramping && (ramped.cables[0].tension - 0.1).abs() < 1e-5, "{ramped:?}");
        moved(&mut own, 0.2, "", "");
        let let_go = moved(&mut own, 0.2, r#", "loads": {"cable[0].tension": 0}"#, "");
        assert!(!let_go.ramping && let_go.cables[0].tension == 0.0);
        let mut inputs = hydrostat::Inputs::default();
        inputs.set("cable[0].tension", Course::Table(vec![(0.0, 0.0), (0.2, 0.2), (0.3, 0.2), (0.3, 0.0)])).unwrap();
        let mut other = Simulation::new(&arm, inputs, MotionOptions::default()).unwrap();
        let at = other.advance_to(own.now.time).unwrap();
        let off = (at.tip[0] - own.now.tip[0]).hypot(at.tip[1] - own.now.tip[1]) / arm.length;
        assert!(off < 1e-3, "{off:e}");
        let energies = [own.now.kinetic - at.kinetic_energy, own.now.strained - at.strain_energy];
        assert!(energies.iter().all(|gap| gap.abs() < 2e-2 * at.strain_energy), "{energies:?} of {}", at.strain_energy);
        assert!((own.now.works.cables - at.works.cables).abs() < 1e-2 * at.works.cables.abs());
    }

    #[test]
    fn a_tip_that_is_held_comes_to_the_equilibrium_with_the_force_of_the_hand() {
        for (name, hold) in [("silicone", "[0.2, 0.06]"), ("silicone-spatial", "[0.22, 0.03, -0.05]")] {
            let mut own = run(name, r#"{"dynamics.relaxation_time": 0.02, "cable[0].tension": 0.05}"#);
            let rest = own.now.tip;
            let away = |tip: [f64; 3]| (0..3).map(|k| (tip[k] - rest[k]).powi(2)).sum::<f64>().sqrt();
            let held = moved(&mut own, 6.0, "", &format!(r#", "hold": {hold}"#));
            assert!(held.kinetic_energy < 1e-4 * held.strain_energy, "{name}: it rests: {}", held.kinetic_energy);
            let force = held.hand.unwrap();
            let at = own.hand.at.unwrap();
            for k in 0..3 {
                let spring = own.hand.stiffness() * (at[k] - own.now.tip[k]);
                assert!((force[k] - spring).abs() < 3e-3 * own.hand.stiffness() * own.arm.length, "{name}: {force:?}");
            }
            let mut arm = own.arm.clone();
            arm.tip.force = [force[0], force[1]];
            let tip = if let Some(space) = &mut arm.space {
                space.tip_force = force[2];
                let tip =
                    hydrostat::SpatialSolver::new(&arm, hydrostat::Options::default()).unwrap().solve().unwrap().tip();
                [tip.x, tip.y, tip.z]
            } else {
                let tip = arm.solve().unwrap().tip();
                [tip.x, tip.y, 0.0]
            };
            let off = (0..3).map(|k| (tip[k] - own.now.tip[k]).powi(2)).sum::<f64>().sqrt() / arm.length;
            assert!(off < 1e-2, "{name}: {off:e}");
            // Let go, it goes back.
            let far = away(own.now.tip);
            let free = moved(&mut own, 3.0, "", "");
            assert!(free.hand.is_none() && away(own.now.tip) < 0.2 * far, "{name}: {} of {far}", away(own.now.tip));
        }
    }

    /// Spring and arm have an energy that the damper alone takes from, where the section is rigid and nothing flows. The
    /// force of a hand that lagged behind fed the motion.
    #[test]
    fn a_hand_feeds_no_motion() {
        let mut own = run("silicone", r#"{"flow.density": 0, "model.volume": "none"}"#);
        let (hold, most) = ([0.22, 0.07], own.hand.stiffness());
        let energy = |own: &Run| {
            let [x, y, _] = own.now.tip;
            let stretch = (x - hold[0]).powi(2) + (y - hold[1]).powi(2);
            own.now.kinetic + own.now.strained + 0.5 * most * stretch
        };
        let mut before = energy(&own);
        for _ in 0..20 {
            moved(&mut own, 0.1, "", &format!(r#", "hold": {hold:?}"#));
            let now = energy(&own);
            assert!(now < 1.02 * before, "{now:e} after {before:e} at {} s", own.now.time);
            before = now;
        }
    }

    #[test]
    fn a_run_that_ends_says_why_and_keeps_what_it_has() {
        let mut own = run("silicone", SOFT);
        let end = moved(&mut own, 3.0, r#", "loads": {"cable[0].tension": 1.5}, "within": 0.5"#, "");
        let ended = end.ended.clone().expect("too much tension");
        assert_eq!(ended.kind, "cable_fold");
        assert!(own.now.time > 0.1 && own.now.time <= ended.time, "{} {}", own.now.time, ended.time);
        let again = own.answer(&wish(r#"{"by": 0.1, "loads": {"cable[0].tension": 0}, "hold": [0.1, 0.1]}"#)).unwrap();
        assert_eq!(again.ended.unwrap().time, ended.time);
        assert_eq!(own.now.tip, own.moving.now().tip);
    }

    #[test]
    fn what_cannot_be_is_refused_and_the_run_goes_on() {
        let mut own = run("silicone", SOFT);
        for (text, field, says) in [
            (r#"{"by": 0.3}"#, "motion.by", "0 to 0.25 s"),
            (r#"{"by": -1}"#, "motion.by", "0 to 0.25 s"),
            (r#"{"by": 0.1, "within": 1e9}"#, "motion.within", "0 to 3600 s"),
            (r#"{"by": 0.1, "hold": [1]}"#, "motion.hold", "x and y"),
            (r#"{"by": 0.1, "loads": {"arm.length": 0.1}}"#, "motion.loads", "cannot change over time"),
            (r#"{"by": 0.1, "loads": {"arm.base.angle": 20}}"#, "motion.loads", "base"),
            (r#"{"by": 0.1, "loads": {"cable[7].tension": 1}}"#, "set", "cable"),
        ] {
            let error = own.answer(&wish(text)).unwrap_err().body.error;
            assert_eq!(error.field.as_deref(), Some(field), "{text}: {}", error.message);
            assert!(error.message.contains(says), "{text}: {}", error.message);
        }
        let on = moved(&mut own, 0.1, r#", "loads": {"arm.base.angle": 20}, "within": 0.1"#, "");
        assert!(on.ended.is_none() && (own.arm.base.angle - 20_f64.to_radians()).abs() < 1e-12);
        assert!((own.now.time - 0.1).abs() < 1e-5);
    }

    #[test]
    fn a_jump_without_memory_of_rate_is_warned_of() {
        let mut own = run("silicone", r#"{"cable[0].tension": 0.1}"#);
        assert!(moved(&mut own, 0.02, "", "").warnings.is_empty());
        let out = moved(&mut own, 0.02, r#", "loads": {"cable[0].tension": 0}"#, "");
        assert_eq!(out.warnings.len(), 1);
        assert_eq!(out.warnings[0].kind, "unresolved_jump");
        assert!(out.warnings[0].message.starts_with("a load jumps at 0.02 s and"), "{}", out.warnings[0].message);
    }
}
