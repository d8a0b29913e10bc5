//! Which limit of the section law an arm is at.

use crate::rod::model_options::Volume;
use crate::statics::equations::Margins;
use crate::statics::verdict::VerdictKind;

/// Openness, stretch and regularity below which their limit is the one that ends a path or a motion.
const NEAR: [f64; 3] = [0.1, 0.1, 0.15];

/// The limit that stations so near to all of them are at, with its place (over L); `None` where they are at none.
pub(crate) fn limit_at(near: Margins, volume: Volume) -> Option<(VerdictKind, f64)> {
    let Margins { openness, nu, regularity } = near;
    if openness.0 < NEAR[0] {
        Some((VerdictKind::CableFold, openness.1))
    } else if volume == Volume::None && nu.0 < NEAR[1] {
        Some((VerdictKind::SectionCrushed, nu.1))
    } else if regularity.0 < NEAR[2] {
        Some((VerdictKind::NoSectionSolution, regularity.1))
    } else {
        None
    }
}
