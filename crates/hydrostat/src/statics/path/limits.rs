//! Which physical limit stands where a path cannot go on.

use super::range::PathEnd;
use super::stepper::{Point, Stepper};
use crate::rod::readings::Volume;
use crate::statics::engine::{Engine, Trouble};
use crate::statics::verdict::VerdictKind;

impl Stepper<'_> {
    /// Names the limit that the last good point is at, with its place, m.
    pub(super) fn name_limit(&mut self, fraction: f64, residual: f64) -> (VerdictKind, Option<f64>) {
        self.set(fraction);
        name_limit(self.engine, self.last_trouble.as_ref(), residual)
    }

    /// What ends a path at the last good point.
    pub(super) fn end_at(&mut self, here: &Point) -> PathEnd {
        self.engine.restore(&here.state);
        let residual = self.engine.last;
        let (kind, s) = self.name_limit(here.fraction, residual);
        PathEnd::Limit { kind, s }
    }
}

/// Names the limit that the engine's solution is at, with its place, m; `trouble` is what kept it from going on.
pub(crate) fn name_limit(engine: &mut Engine, trouble: Option<&Trouble>, residual: f64) -> (VerdictKind, Option<f64>) {
    engine.last = residual;
    let near = engine.margins_to_limits();
    let failed = match trouble {
        Some(Trouble::Section(failure)) => Some(*failure),
        _ => None,
    };
    let volume = engine.equations.volume();
    let readings = engine.equations.arm().readings;
    let mut openness = near.openness;
    let mut nu = near.nu;
    let mut regularity = near.regularity;
    if let Some(f) = failed {
        // The failure may be at an end, which is no station, or just past the limit.
        for (least, value) in [(&mut openness, f.openness), (&mut nu, f.nu), (&mut regularity, f.regularity)] {
            if value.abs() < least.0 {
                *least = (value.abs(), f.s);
            }
        }
    }
    let (kind, s) = if openness.0 < 0.1 {
        (VerdictKind::CableFold, Some(openness.1))
    } else if volume == Volume::None && nu.0 < 0.1 {
        (VerdictKind::SectionCrushed, Some(nu.1))
    } else if regularity.0 < 0.15 {
        (VerdictKind::NoSectionSolution, Some(regularity.1))
    } else if readings.load_can_jump() && failed.is_none() {
        (VerdictKind::LoadJump, engine.nearest_switch())
    } else {
        (VerdictKind::NotFound, failed.map(|f| f.s))
    };
    (kind, s.map(|s| s * engine.equations.units.length))
}
