//! Which physical limit stands where a path cannot go on.

use super::points::PathEnd;
use super::stepper::{Point, Stepper};
use super::traced::Traced;
use crate::statics::engine::{Engine, Trouble};
use crate::statics::limit::limit_at;
use crate::statics::verdict::VerdictKind;

impl<E: Traced> Stepper<'_, E> {
    /// Names the limit that the last good point is at, with its place, m.
    pub(super) fn name_limit(&mut self, fraction: f64, residual: f64) -> (VerdictKind, Option<f64>) {
        self.set(fraction);
        *self.engine.last_mut() = residual;
        self.engine.name_limit(self.last_trouble.as_ref())
    }

    /// What ends a path at the last good point.
    pub(super) fn end_at(&mut self, here: &Point<E>) -> PathEnd {
        self.engine.restore(&here.state);
        let residual = *self.engine.last_mut();
        let (kind, s) = self.name_limit(here.fraction, residual);
        PathEnd::Limit { kind, s }
    }
}

/// Names the limit that the engine's solution is at, with its place, m; `trouble` is what kept it from going on.
pub(crate) fn name_limit(engine: &mut Engine, trouble: Option<&Trouble>) -> (VerdictKind, Option<f64>) {
    let mut near = engine.margins_to_limits();
    let failed = trouble.and_then(Trouble::failed_section);
    if let Some(failure) = &failed {
        near.note_failure(failure);
    }
    let model = engine.equations.arm().model;
    let (kind, s) = match limit_at(near, engine.equations.volume()) {
        Some((kind, s)) => (kind, Some(s)),
        None if model.load_can_jump() && failed.is_none() => (VerdictKind::LoadJump, engine.nearest_switch()),
        None => (VerdictKind::NotFound, failed.map(|f| f.s)),
    };
    (kind, s.map(|s| s * engine.equations.units.length))
}
