//! What changes in time: loads, stream, gravity and base as functions of it.

use std::fmt;
use std::str::FromStr;

use super::error::MotionError;
use crate::rod::arm::Arm;
use crate::rod::parameter::{BASE_PLACE, Parameter, Unfit};
use crate::rod::profile::Table;

/// A quantity over time, in its unit.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// Straight lines between `(time in s, value)`, times not falling; two rows at one time are a jump. Before the
    /// first row and after the last one the value stays.
    Table(Vec<(f64, f64)>),
    /// A smooth line through points at times in s, the monotone cubic of [`Profile`](crate::Profile)'s tables. Before
    /// the first point and after the last one the value stays.
    Smooth(Table),
    /// mean + amplitude sin(2 pi frequency t + phase).
    Sine {
        /// Its mean.
        mean: f64,
        /// Its amplitude.
        amplitude: f64,
        /// Hz.
        frequency: f64,
        /// rad.
        phase: f64,
    },
}

impl Course {
    /// The same at all times.
    pub fn constant(value: f64) -> Self {
        Self::Table(vec![(0.0, value)])
    }

    /// From one value to another between two times, s.
    pub fn ramp(from: f64, to: f64, start: f64, end: f64) -> Self {
        Self::Table(vec![(start, from), (end, to)])
    }

    /// A jump from one value to another.
    pub fn step(from: f64, to: f64, at: f64) -> Self {
        Self::Table(vec![(at, from), (at, to)])
    }

    /// Value and rate (1/s) at `time`, as they are just before it.
    ///
    /// ```
    /// use hydrostat::Course;
    ///
    /// let course = Course::Table(vec![(0.0, 0.0), (0.2, 0.1), (0.2, 0.0)]);
    /// assert_eq!(course.before(0.1), (0.05, 0.5));
    /// assert_eq!(course.before(0.2).0, 0.1);
    /// assert_eq!(course.before(0.3), (0.0, 0.0));
    /// ```
    pub fn before(&self, time: f64) -> (f64, f64) {
        match self {
            Self::Table(rows) => {
                let next = rows.partition_point(|(t, _)| *t < time);
                match (next.checked_sub(1).map(|k| rows[k]), rows.get(next).copied()) {
                    (None, Some((_, value))) | (Some((_, value)), None) => (value, 0.0),
                    (Some((t, v)), Some((u, w))) => {
                        let rate = (w - v) / (u - t);
                        (if time == u { w } else { v + rate * (time - t) }, rate)
                    }
                    (None, None) => (0.0, 0.0),
                }
            }
            Self::Smooth(table) => {
                let [first, last] = table.ends();
                let at = table.at(time.clamp(first, last));
                (at.value, if time > first && time <= last { at.slope } else { 0.0 })
            }
            Self::Sine { mean, amplitude, frequency, phase } => {
                let omega = 2.0 * std::f64::consts::PI * frequency;
                let (sin, cos) = (omega * time + phase).sin_cos();
                (mean + amplitude * sin, amplitude * omega * cos)
            }
        }
    }

    /// Value and rate just after `time`.
    fn after(&self, time: f64) -> (f64, f64) {
        let rows = match self {
            Self::Table(rows) => rows,
            Self::Smooth(table) => {
                let [first, last] = table.ends();
                let at = table.at(time.clamp(first, last));
                return (at.value, if time >= first && time < last { at.slope } else { 0.0 });
            }
            Self::Sine { .. } => return self.before(time),
        };
        let next = rows.partition_point(|(t, _)| *t <= time);
        match (next.checked_sub(1).map(|k| rows[k]), rows.get(next).copied()) {
            (None, Some((_, value))) | (Some((_, value)), None) => (value, 0.0),
            (Some((t, v)), Some((u, w))) => {
                let rate = (w - v) / (u - t);
                (v + rate * (time - t), rate)
            }
            (None, None) => (0.0, 0.0),
        }
    }

    /// The first corner after `time`.
    fn next_corner(&self, time: f64) -> Option<f64> {
        let rows = match self {
            Self::Table(rows) => rows,
            Self::Smooth(table) => return table.ends().into_iter().find(|end| *end > time),
            Self::Sine { .. } => return None,
        };
        rows.get(rows.partition_point(|(t, _)| *t <= time)).map(|(t, _)| *t)
    }

    fn check(&self) -> Result<(), String> {
        match self {
            Self::Table(rows) => {
                if rows.is_empty() {
                    return Err("a table needs a row".to_owned());
                }
                for (t, v) in rows {
                    if !t.is_finite() || !v.is_finite() {
                        return Err(format!("{t}, {v} are no finite numbers"));
                    }
                }
                for pair in rows.windows(2) {
                    if pair[1].0 < pair[0].0 {
                        return Err(format!("times must not fall, found {} s after {} s", pair[1].0, pair[0].0));
                    }
                }
                Ok(())
            }
            // Its points were looked at when it was made.
            Self::Smooth(_) => Ok(()),
            Self::Sine { mean, amplitude, frequency, phase } => {
                let fine = [mean, amplitude, frequency, phase].into_iter().all(|v| v.is_finite());
                if fine { Ok(()) } else { Err("a sine needs finite numbers".to_owned()) }
            }
        }
    }

    /// Values that it comes to, among them the largest and the smallest.
    ///
    /// ```
    /// use hydrostat::Course;
    ///
    /// assert_eq!(Course::ramp(0.1, 0.3, 0.0, 2.0).values(), [0.1, 0.3]);
    /// ```
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::Table(rows) => rows.iter().map(|(_, v)| *v).collect(),
            // Between its points is no value beyond theirs.
            Self::Smooth(table) => table.points().map(|[_, value]| value).collect(),
            Self::Sine { mean, amplitude, .. } => vec![mean - amplitude, mean + amplitude],
        }
    }
}

/// A quantity of an arm that may change in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Driven {
    Of(Parameter),
    /// The place of the base along e1 (0), e2 (1) or e3 (2), m.
    Base(usize),
}

impl fmt::Display for Driven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Of(parameter) => parameter.fmt(f),
            Self::Base(axis) => f.write_str(BASE_PLACE[*axis.min(&2)]),
        }
    }
}

impl Driven {
    /// Its place in the arm.
    fn set(self, arm: &mut Arm, value: f64) -> Result<(), Unfit> {
        match self {
            Self::Of(parameter) => parameter.set(arm, value)?,
            Self::Base(axis) => *arm.base_place_mut(axis)? = value,
        }
        Ok(())
    }

    fn read(key: &str) -> Option<Self> {
        let base = BASE_PLACE.iter().position(|own| *own == key).map(Self::Base);
        base.or_else(|| Parameter::from_str(key).ok().filter(|p| p.may_be_led()).map(Self::Of))
    }

    fn is_of_base(self) -> bool {
        match self {
            Self::Base(_) => true,
            Self::Of(own) => {
                matches!(own, Parameter::BaseAngle | Parameter::BaseAlong(_) | Parameter::SectionAlong(_))
            }
        }
    }

    /// Why an arm cannot be led by both: one of them would stand for the other.
    fn excludes(self, other: Self) -> Option<&'static str> {
        const CABLE: &str = "a cable is led by its tension or by its stroke";
        const DIRECTION: &str = "a direction is led by its angle or by its parts";
        let (Self::Of(own), Self::Of(other)) = (self, other) else { return None };
        let one_way = |own: Parameter, other: Parameter| match (own, other) {
            (Parameter::Tension(c), Parameter::Stroke(k)) if c == k => Some(CABLE),
            (Parameter::FlowDirection, Parameter::StreamAlong(_))
            | (Parameter::GravityDirection, Parameter::GravityAlong(_))
            | (Parameter::BaseAngle, Parameter::BaseAlong(_)) => Some(DIRECTION),
            _ => None,
        };
        one_way(own, other).or_else(|| one_way(other, own))
    }

    fn is_of_stream(self) -> bool {
        matches!(self, Self::Of(Parameter::FlowSpeed | Parameter::FlowDirection | Parameter::StreamAlong(_)))
    }
}

/// Loads and base of an arm as functions of time; what is not among them stays as the arm has it.
///
/// ```
/// use hydrostat::{Course, Inputs};
///
/// let mut inputs = Inputs::default();
/// inputs.set("cable[0].tension", Course::ramp(0.0, 0.2, 0.0, 0.2))?; // N over s
/// inputs.set("flow.speed", Course::constant(0.1))?;
/// inputs.set("distributed.force[1]", Course::step(0.0, 0.5, 0.1))?; // N/m, the same all along
/// assert!(inputs.set("arm.length", Course::constant(0.1)).is_err());
/// assert!(inputs.set("cable[0].stroke", Course::constant(0.01)).is_err(), "its tension is given");
/// # Ok::<(), hydrostat::MotionError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inputs {
    courses: Vec<(Driven, Course)>,
}

impl Inputs {
    /// The names of what may change in time, those of the cables with the index 0.
    pub fn names() -> Vec<String> {
        let of = crate::rod::parameter::names();
        let base = BASE_PLACE.map(str::to_owned);
        of.into_iter().filter(|name| Driven::read(name).is_some()).chain(base).collect()
    }

    /// Sets the course of the quantity `key`, which has the name and the unit that [`Parameter`] gives it; also
    /// `arm.base.x`, `arm.base.y` and, in space, `arm.base.z`, m.
    ///
    /// A load along the arm is led by the numbers that its profile has in the arm: `distributed.force[1]` is the force
    /// (N/m) all along where the arm has one value or none, `distributed.force[1].base` and `.tip` are the ends of a
    /// linear profile, `distributed.force[1][0][1]` is the value at the first point of a table.
    ///
    /// # Errors
    /// [`MotionError::Course`] when no such quantity may change in time, when the course is none, or when a quantity
    /// that excludes it is led: the tension and the stroke of one cable, the angle and the parts of one direction.
    pub fn set(&mut self, key: &str, course: Course) -> Result<(), MotionError> {
        let wrong = |reason: String| MotionError::Course { key: key.to_owned(), reason };
        let Some(driven) = Driven::read(key) else {
            return Err(wrong(format!(
                "this key cannot change over time; keys that can: {}",
                Self::names().join(", ")
            )));
        };
        course.check().map_err(wrong)?;
        let other = self.courses.iter().find_map(|(other, _)| Some((other, driven.excludes(*other)?)));
        if let Some((other, why)) = other {
            return Err(wrong(format!("`{other}` is given as well, and {why}")));
        }
        if let (true, Course::Table(rows)) = (driven.is_of_base(), &course)
            && let Some(pair) = rows.windows(2).find(|pair| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1)
        {
            return Err(wrong(format!("the base cannot jump, as it does at {} s", pair[0].0)));
        }
        self.courses.retain(|(own, _)| *own != driven);
        self.courses.push((driven, course));
        Ok(())
    }

    /// `arm` with the loads just before `time`, s.
    ///
    /// ```
    /// use hydrostat::{Arm, Course, Inputs};
    ///
    /// let mut inputs = Inputs::default();
    /// inputs.set("tip.force[1]", Course::ramp(0.0, 0.2, 0.0, 1.0))?; // N over s
    /// let arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// assert_eq!(inputs.arm_at(&arm, 0.5)?.tip.force, [0.0, 0.1]);
    /// # Ok::<(), hydrostat::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// [`MotionError`] where the arm has no such load, or cannot have one of its values at any time.
    pub fn arm_at(&self, arm: &Arm, time: f64) -> Result<Arm, MotionError> {
        self.check(arm)?;
        let mut out = arm.clone();
        self.apply(&mut out, time);
        Ok(out)
    }

    /// Refuses what `arm` does not have, or values that it cannot have.
    pub(super) fn check(&self, arm: &Arm) -> Result<(), MotionError> {
        for (driven, course) in &self.courses {
            for value in course.values() {
                let mut arm = arm.clone();
                driven.set(&mut arm, value)?;
                arm.check()?;
            }
        }
        Ok(())
    }

    /// Leads the quantity `key` from its value in `arm` at the first time to `value` at the second one, and keeps it
    /// there.
    pub(super) fn lead(&mut self, key: &str, value: f64, arm: &Arm, [start, end]: [f64; 2]) -> Result<(), MotionError> {
        let other = match Driven::read(key) {
            Some(Driven::Of(Parameter::Tension(c))) => Some((c, true, Parameter::Stroke(c))),
            Some(Driven::Of(Parameter::Stroke(c))) => Some((c, false, Parameter::Tension(c))),
            _ => None,
        };
        if let Some((c, commanded, other)) = other
            && arm.cables.get(c).is_some_and(|cable| cable.stroke.is_some() == commanded)
        {
            let reason = format!("the cable is led by `{other}` in this run, which cannot change on the way");
            return Err(MotionError::Course { key: key.to_owned(), reason });
        }
        let now = match Driven::read(key) {
            Some(Driven::Of(parameter)) => parameter.of(arm)?,
            Some(Driven::Base(axis)) => arm.base_place(axis).unwrap_or_default(),
            // Which has no such name.
            None => 0.0,
        };
        let mut one = Self::default();
        one.set(key, Course::ramp(now, value, start, end))?;
        one.check(arm)?;
        self.set(key, Course::ramp(now, value, start, end))
    }

    /// The loads just before `time`, put into `arm`.
    pub(super) fn apply(&self, arm: &mut Arm, time: f64) {
        for (driven, course) in &self.courses {
            // What does not fit was refused by `check`.
            let _ = driven.set(arm, course.before(time).0);
        }
    }

    /// The acceleration of the stream just before `time`, m/s2: in the plane the rate of speed (cos direction, sin
    /// direction).
    pub(super) fn stream_acceleration(&self, arm: &Arm, time: f64) -> [f64; 3] {
        let rate = |of: Parameter| {
            self.courses.iter().find(|(driven, _)| *driven == Driven::Of(of)).map_or(0.0, |(_, c)| c.before(time).1)
        };
        if arm.space.is_some() {
            return self.stream_acceleration_in_space(arm, time);
        }
        let (sin, cos) = arm.flow.direction.sin_cos();
        let (along, across) = (rate(Parameter::FlowSpeed), arm.flow.speed * rate(Parameter::FlowDirection));
        [along * cos - across * sin, along * sin + across * cos, 0.0]
    }

    /// The same by differences, exact where the speed alone changes.
    fn stream_acceleration_in_space(&self, arm: &Arm, time: f64) -> [f64; 3] {
        /// s.
        const APART: f64 = 1e-6;
        let moving =
            || self.courses.iter().filter(|(driven, course)| driven.is_of_stream() && course.before(time).1 != 0.0);
        if moving().next().is_none() {
            return [0.0; 3];
        }
        let at = |dt: f64| {
            let mut arm = arm.clone();
            for (driven, course) in moving() {
                let (value, rate) = course.before(time);
                let _ = driven.set(&mut arm, value + rate * dt);
            }
            arm.stream_in_space()
        };
        let (after, before) = (at(APART), at(-APART));
        std::array::from_fn(|k| (after[k] - before[k]) / (2.0 * APART))
    }

    /// The first corner or jump of a course after `time`.
    pub(super) fn next_corner(&self, time: f64) -> Option<f64> {
        self.courses.iter().filter_map(|(_, course)| course.next_corner(time)).min_by(f64::total_cmp)
    }

    /// Whether accelerations jump at `time`: a load does, the rate of the stream, or the velocity of the base.
    pub(super) fn jumps_at(&self, time: f64) -> bool {
        self.courses.iter().any(|(driven, course)| {
            let ((v, rate), (w, next)) = (course.before(time), course.after(time));
            v != w || (rate != next && (driven.is_of_base() || driven.is_of_stream()))
        })
    }

    /// The same for an arm that is at rest until `time`, base and stream with it.
    pub(super) fn jumps_from_rest(&self, time: f64) -> bool {
        let rate = |(driven, course): &(Driven, Course)| {
            (driven.is_of_base() || driven.is_of_stream()) && course.after(time).1 != 0.0
        };
        self.jumps_at(time) || self.courses.iter().any(rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tension was silently ignored.
    #[test]
    fn tension_and_stroke_of_one_cable_are_refused() {
        let both = |first: &str, second: &str| {
            let mut inputs = Inputs::default();
            inputs.set(first, Course::constant(0.01)).unwrap();
            inputs.set(second, Course::constant(0.01)).map_err(|error| error.to_string())
        };
        let words = "`cable[0].stroke`: `cable[0].tension` is given as well, and a cable is led by its tension or by its stroke";
        assert_eq!(both("cable[0].tension", "cable[0].stroke").unwrap_err(), words);
        for (first, second) in [
            ("cable[0].stroke", "cable[0].tension"),
            ("flow.direction", "flow.direction[2]"),
            ("gravity.direction[0]", "gravity.direction"),
            ("arm.base.direction[1]", "arm.base.angle"),
        ] {
            let error = both(first, second).unwrap_err();
            assert!(error.starts_with(&format!("`{second}`: `{first}` is given as well")), "{error}");
        }
        for (first, second) in [
            ("cable[0].tension", "cable[1].stroke"),
            ("cable[0].tension", "cable[0].tension"),
            ("flow.direction", "gravity.direction[1]"),
        ] {
            both(first, second).unwrap();
        }
    }

    #[test]
    fn corners_and_jumps_are_met() {
        let mut inputs = Inputs::default();
        inputs.set("cable[0].tension", Course::Table(vec![(0.0, 0.0), (0.2, 0.1), (0.4, 0.1), (0.4, 0.0)])).unwrap();
        inputs.set("flow.speed", Course::ramp(0.0, 0.1, 0.1, 0.3)).unwrap();
        let mut at = -1.0;
        let mut met = Vec::new();
        while let Some(next) = inputs.next_corner(at) {
            met.push((next, inputs.jumps_at(next)));
            at = next;
        }
        assert_eq!(met, [(0.0, false), (0.1, true), (0.2, false), (0.3, true), (0.4, true)]);
    }
}
