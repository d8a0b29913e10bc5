//! Advice about units that look wrong.

use hydrostat::{Arm, Verdict, VerdictKind};
use hydrostat_files::{Slip, Span, Varied, likeliest_slip, slips_beside, slips_of_spans, unit_slips};

use crate::say;

/// Advice about the units, which comes first: where no limit of the arm was established, and where a number looks like
/// a slip, a unit is mostly wrong.
pub(super) fn slip(arm: &Arm, verdict: &Verdict) -> Option<String> {
    if verdict.kind == VerdictKind::NotFound {
        return likeliest_slip(arm).map(|slip| format!("look at the units first: {slip}"));
    }
    let slip = unit_slips(arm).into_iter().next()?;
    Some(format!("look at the units first: {slip} If the unit is right: {}", verdict.advice()))
}

/// Warns of slips at the ends of what varies. Those of the arm itself have been told with the arm.
pub(super) fn warn(arm: &Arm, spans: &[Span]) {
    tell(slips_of_spans(arm, spans));
}

/// The same of the range of a parameter.
pub(super) fn warn_of_range(arm: &Arm, varied: &Varied) {
    warn(arm, &[Span { key: varied.parameter.to_string(), ends: varied.range }]);
}

/// The same of arms that differ from `base` in what varies.
pub(super) fn warn_beside(base: &Arm, others: impl IntoIterator<Item = Arm>) {
    tell(slips_beside(base, others));
}

/// Warns of a bound on all tensions that looks like a slip.
pub(super) fn warn_of_bound(arm: &Arm, max_tension: Option<f64>) {
    let Some(most) = max_tension else { return };
    let mut pulled = arm.slackened();
    for cable in &mut pulled.cables {
        cable.tension = most;
    }
    let first = slips_beside(arm, [pulled]).into_iter().next();
    tell(first.map(|slip| Slip { key: "--max-tension".to_owned(), ..slip }));
}

fn tell(slips: impl IntoIterator<Item = Slip>) {
    for slip in slips {
        say::warning(slip);
    }
}
