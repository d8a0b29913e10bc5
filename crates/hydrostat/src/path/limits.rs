//! Which physical limit stands where a path cannot go on.

use super::stepper::Stepper;
use crate::engine::Trouble;
use crate::readings::Volume;
use crate::verdict::VerdictKind;

impl Stepper<'_> {
    /// Names the limit that the last good point is at, with its place over L.
    pub(super) fn name_limit(&mut self, fraction: f64, residual: f64) -> (VerdictKind, Option<f64>) {
        self.engine.last = residual;
        self.set(fraction);
        let near = self.engine.nearest_limits();
        let failed = match &self.last_trouble {
            Some(Trouble::Section(failure)) => Some(*failure),
            _ => None,
        };
        let volume = self.engine.equations.volume();
        let readings = self.engine.equations.arm().readings;
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
        if openness.0 < 0.1 {
            (VerdictKind::CableFold, Some(openness.1))
        } else if volume == Volume::None && nu.0 < 0.1 {
            (VerdictKind::SectionCrushed, Some(nu.1))
        } else if regularity.0 < 0.15 {
            (VerdictKind::NoSectionSolution, Some(regularity.1))
        } else if readings.load_can_jump() && failed.is_none() {
            (VerdictKind::LoadJump, self.engine.nearest_switch())
        } else {
            (VerdictKind::NotFound, failed.map(|f| f.s))
        }
    }
}
