//! What is known where a path ends before its loads: the verdict, with the shapes around it.

use super::load_stepping::Stopped;
use super::loaded::Loaded;
use super::step_control::LOOSE;
use super::traced::Along;
use crate::numerics::distance;
use crate::statics::refinement::First;
use crate::statics::verdict::{NoEquilibrium, Phase};

/// How far below the fraction of a verdict the last good shape may be. Right at a limit the tangent is singular, and a
/// finer mesh, or a place between stations, may already be past it.
const BACK: [f64; 5] = [1e-9, 1e-5, 1e-4, 1e-3, 5e-3];

/// How far (over the distance of the tip from the base, or over L) the tip may move there.
const MOVED: f64 = 0.05;

/// The tightest tolerance (tip over L) of the last good shape.
const TIGHTEST: f64 = 1e-6;

/// The verdict of a phase with the last good shape, which the engine is at, settled and read.
pub(crate) fn no_equilibrium<E: Loaded>(
    engine: &mut E,
    stopped: Stopped<E>,
    tol: f64,
) -> NoEquilibrium<E::Shape, E::Tip> {
    let kept = engine.state();
    let (place, verdict) = (engine.tip_place(), &stopped.verdict);
    // Where sections give way, arms are many times as long as they were.
    let size = distance(&place, &[0.0; 3]).max(1.0);
    let last_good = BACK.into_iter().find_map(|back| {
        engine.restore(&kept);
        // Friction is that of the shape, whose turns belong to it.
        if verdict.phase != Phase::Friction {
            engine.set(Along::Phase(verdict.phase), verdict.load_fraction * (1.0 - back));
        }
        let estimate = engine.settle(tol.max(TIGHTEST), First::Warm).ok()?;
        if distance(&engine.tip_place(), &place) < MOVED * size { engine.read(estimate) } else { None }
    });
    let last_good = last_good.or_else(|| {
        engine.restore(&kept);
        as_it_is(engine)
    });
    with_shapes(engine, stopped, last_good, tol)
}

/// The verdict of a range with the last good shape, which the engine is at, as it is.
pub(crate) fn no_equilibrium_in_range<E: Loaded>(
    engine: &mut E,
    stopped: Stopped<E>,
    tol: f64,
) -> NoEquilibrium<E::Shape, E::Tip> {
    let last_good = as_it_is(engine);
    with_shapes(engine, stopped, last_good, tol)
}

/// The engine's shape, as accurate as paths are.
fn as_it_is<E: Loaded>(engine: &mut E) -> Option<E::Shape> {
    engine.measure().ok().and_then(|()| engine.read(LOOSE))
}

fn with_shapes<E: Loaded>(
    engine: &mut E,
    stopped: Stopped<E>,
    last_good: Option<E::Shape>,
    tol: f64,
) -> NoEquilibrium<E::Shape, E::Tip> {
    let Stopped { verdict, snaps, after_snap, at_full_loads } = stopped;
    let mut read = |state: Option<Box<E::State>>| {
        engine.restore(state?.as_ref());
        let estimate = engine.settle(tol, First::Warm).ok()?;
        engine.read(estimate)
    };
    let (after_snap, at_full_loads) = (read(after_snap), read(at_full_loads));
    NoEquilibrium { verdict, last_good, snaps, after_snap, at_full_loads }
}
