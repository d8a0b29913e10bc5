//! What is asked of targets by `hydrostat reach`, one or many.

use hydrostat::{Arm, ReachOptions, Target};
use hydrostat_files::number;

use crate::args::ReachArgs;

pub(super) fn options(args: &ReachArgs) -> ReachOptions {
    ReachOptions {
        max_tension: args.max_tension,
        max_stroke: args.max_stroke,
        tol: args.tol.unwrap_or(ReachOptions::default().tol),
        all: true,
    }
}

/// Targets that are further from the base than this, over L, were hardly meant in m: an arm stretches, but not that far.
const FAR: f64 = 3.0;

/// What to try where a target is further away than any arm stretches.
pub(super) fn far_off(arm: &Arm, target: &Target) -> Option<String> {
    let lengths = (target.x - arm.base.x).hypot(target.y - arm.base.y) / arm.length;
    (lengths > FAR).then(|| {
        let [far, x, y] = [lengths, target.x, target.y].map(number);
        format!(
            "if you mean millimetres, write \"{x} mm,{y} mm\", in a file the heads x_mm,y_mm: ({x}, {y}) m is {far} arm lengths from the base"
        )
    })
}
