//! Paths of tensions that cannot leave a slack arm which lies in the stream: there the signs of tiny angles decide
//! which way the load goes, and rounding decides these. They begin at a small fraction of the tensions instead.

use super::loaded::Loaded;
use super::traced::Along;
use crate::numerics::distance;
use crate::statics::engine::roughly;
use crate::statics::verdict::{Phase, Verdict, VerdictKind};

/// Fractions of the tensions at which such a path begins.
const AWAY: [f64; 7] = [1e-9, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// How far (over L) the tip may be from its place on the slack arm there: as far as snaps go that are followed.
const BESIDE: f64 = 0.01;

/// Follows the tensions with `follow`, which begins at the fraction that it is given, or else at the engine's slack
/// arm.
pub(crate) fn follow_tensions<E: Loaded>(
    engine: &mut E,
    mut follow: impl FnMut(&mut E, Option<f64>) -> Result<(), Verdict>,
) -> Result<(), Verdict> {
    let (slack, place) = (engine.state(), engine.tip_place());
    let outcome = follow(engine, None);
    if !outcome.as_ref().is_err_and(has_not_begun) {
        return outcome;
    }
    let stuck = engine.state();
    for from in AWAY {
        engine.restore(&slack);
        engine.set(Along::Phase(Phase::Tension), from);
        if roughly(engine.newton(1e-6, 12)).is_err() || distance(&engine.tip_place(), &place) > BESIDE {
            continue;
        }
        let ahead = follow(engine, Some(from));
        if ahead.as_ref().err().is_none_or(|verdict| verdict.load_fraction > 2.0 * from) {
            return ahead;
        }
    }
    engine.restore(&stuck);
    outcome
}

/// Whether a path ends where it began, without a limit that has a name, or turns back before anything pulls.
fn has_not_begun(verdict: &Verdict) -> bool {
    let ends = match verdict.kind {
        VerdictKind::NotFound => verdict.load_fraction < 1e-5,
        VerdictKind::LimitPoint => verdict.load_fraction == 0.0,
        _ => false,
    };
    ends && verdict.spent.is_none()
}
