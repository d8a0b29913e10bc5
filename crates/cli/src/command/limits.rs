//! How much tension an arm carries: by each cable alone, and by all cables of a side together.

use hydrostat::{Arm, DistributedLoad, Material, Options, SolveError, Solver, TipLoad, VerdictKind};

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
        arm.cables.iter().enumerate().map(|(i, c)| (format!("{} alone", c.name), vec![i])).collect();
    for (name, sign) in [("all of the left side, each", 1.0), ("all of the right side, each", -1.0)] {
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

/// The arm with slack cables and no other load.
fn bare(arm: &Arm) -> Arm {
    let mut bare = arm.clone();
    bare.flow.speed = 0.0;
    bare.gravity = None;
    bare.tip = TipLoad::default();
    bare.distributed = DistributedLoad::default();
    for cable in &mut bare.cables {
        cable.tension = 0.0;
        cable.max_tension = None;
    }
    bare
}

fn limit(bare: &Arm, group: &[usize]) -> Limit {
    // The section at the anchor gives the scale: it cannot carry much more than C1 A.
    let anchor = group.iter().map(|c| bare.cables[*c].end * bare.length).fold(0.0, f64::max);
    let scale = axial_stiffness(bare, anchor) / group.len() as f64;
    // A section that spreads under compression carries more, but nothing carries many times what
    // the widest section would.
    let most = 10.0 * axial_stiffness(bare, 0.0).max(scale);
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
    Solver::new(&arm, Options { tol: 1e-5 })?.solve().map(|_| ())
}

fn why(kind: VerdictKind) -> Option<&'static str> {
    match kind {
        VerdictKind::CableFold => Some("a cable folds its side shut"),
        VerdictKind::SectionCrushed => Some("the section is crushed"),
        VerdictKind::NoSectionSolution => Some("no strains carry the load"),
        VerdictKind::LimitPoint => Some("the arm snaps to another shape"),
        VerdictKind::LoadJump | VerdictKind::NotFound => None,
    }
}

/// C1 A of the unloaded section at `s` (m), N.
fn axial_stiffness(arm: &Arm, s: f64) -> f64 {
    let r2 = arm.radius.at(s, arm.length).value.powi(2) - arm.inner_radius.at(s, arm.length).value.powi(2);
    let c1 = match &arm.material {
        Material::Homogeneous { young, .. } => *young,
        Material::Coefficients { c1, .. } => c1.at(s, arm.length).value,
    };
    c1 * std::f64::consts::PI * r2
}
