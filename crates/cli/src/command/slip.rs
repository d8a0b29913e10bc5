//! Advice about units that look wrong.

use hydrostat::{Arm, Verdict, VerdictKind};
use hydrostat_files::{likeliest_slip, unit_slips};

/// Advice about the units, which comes first: where no limit of the arm was established, and where a number looks like
/// a slip, a unit is mostly wrong.
pub(super) fn slip(arm: &Arm, verdict: &Verdict) -> Option<String> {
    if verdict.kind == VerdictKind::NotFound {
        return likeliest_slip(arm).map(|slip| format!("look at the units first: {slip}"));
    }
    let slip = unit_slips(arm).into_iter().next()?;
    Some(format!("look at the units first: {slip} If the unit is right: {}", verdict.advice()))
}
