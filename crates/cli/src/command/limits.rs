//! How much tension an arm carries: by each cable alone, and by all cables of a side together.

use hydrostat::{Arm, Options, SolveError, Solver, VerdictKind};

/// What ends a rise in tension.
pub(super) enum Limit {
    /// A physical limit.
    Reached {
        /// Of each cable that is pulled, N.
        tension: f64,
        why: &'static str,
        /// Where, m, if it is local.
        s: Option<f64>,
    },
    /// None up to this tension, N.
    NoneBelow(f64),
    /// The solver gave up without naming a limit; shapes were found up to this tension, N.
    Unknown(f64),
}

/// Each group of cables and its limit.
pub(super) fn limits(arm: &Arm) -> Vec<(String, Limit)> {
    let mut groups: Vec<(String, Vec<usize>)> =
        arm.cables.iter().enumerate().map(|(i, c)| (format!("cable {} alone", c.name), vec![i])).collect();
    for (name, sign) in [("all cables on the left, each", 1.0), ("all cables on the right, each", -1.0)] {
        let side: Vec<usize> = (0..arm.cables.len()).filter(|i| sign * side_of(arm, *i) > 0.0).collect();
        if side.len() > 1 {
            groups.push((name.to_owned(), side));
        }
    }
    let bare = bare(arm);
    groups.into_iter().map(|(name, group)| (name, limit(&bare, &group))).collect()
}

/// The offset halfway to the anchor, m: positive on the left.
fn side_of(arm: &Arm, cable: usize) -> f64 {
    let c = &arm.cables[cable];
    c.offset.at(0.5 * c.end * arm.length, arm.length).value
}

/// The arm without its loads, whose cables may be pulled as hard as it bears.
fn bare(arm: &Arm) -> Arm {
    let mut bare = arm.unloaded();
    for cable in &mut bare.cables {
        cable.max_tension = None;
    }
    bare
}

fn limit(bare: &Arm, group: &[usize]) -> Limit {
    // The section at the anchor gives the scale: it cannot carry much more than C1 A.
    let anchor = group.iter().map(|c| bare.cables[*c].end * bare.length).fold(0.0, f64::max);
    let axial = |s: f64| bare.stiffness_at(s)[0];
    let scale = axial(anchor) / group.len() as f64;
    // A section that spreads under compression carries more, but nothing carries many times what
    // the widest section would.
    let most = 10.0 * axial(0.0).max(scale);
    let mut carried = 0.0;
    let mut tension = scale;
    while tension <= most {
        match solve(bare, group, tension) {
            Ok(()) => carried = tension,
            Err(SolveError::NoEquilibrium(failure)) => {
                let verdict = failure.verdict;
                let tension = verdict.load_fraction * tension;
                return match why(verdict.kind) {
                    Some(why) => Limit::Reached { tension, why, s: verdict.s },
                    None => Limit::Unknown(tension.max(carried)),
                };
            }
            Err(_) => return Limit::Unknown(carried),
        }
        tension *= 8.0;
    }
    Limit::NoneBelow(carried)
}

fn solve(bare: &Arm, group: &[usize], tension: f64) -> Result<(), SolveError> {
    let mut arm = bare.clone();
    for cable in group {
        arm.cables[*cable].tension = tension;
    }
    // The limit is wanted to a few digits; a coarse mesh finds it sooner.
    Solver::new(&arm, Options::with_tol(1e-5))?.solve().map(|_| ())
}

fn why(kind: VerdictKind) -> Option<&'static str> {
    match kind {
        VerdictKind::LimitPoint => Some("the arm snaps to another shape"),
        VerdictKind::CableFold | VerdictKind::SectionCrushed | VerdictKind::NoSectionSolution => Some(kind.phrase()),
        VerdictKind::LoadJump | VerdictKind::NotFound => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::{Cable, Profile};

    #[test]
    fn a_commanded_stroke_kept_the_tension_from_being_raised() {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
        let tension = |arm: &Arm| match limits(arm).remove(0).1 {
            Limit::Reached { tension, .. } => tension,
            Limit::NoneBelow(tension) => panic!("none below {tension}"),
            Limit::Unknown(tension) => panic!("unknown above {tension}"),
        };
        let free = tension(&arm);
        arm.cables[0].stroke = Some(0.005);
        assert_eq!(tension(&arm), free);
    }
}
