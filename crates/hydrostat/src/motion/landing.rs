//! Where an arm lands that is let go past a limit point, in the plane or in space.

use super::error::MotionError;
use super::resting::Restless;
use super::start::not_found;
use crate::statics::configuration::Configuration;
use crate::statics::path::loaded::Loaded;
use crate::statics::refinement::First;
use crate::statics::shape::Pose;
use crate::statics::snap::Snap;

/// The fraction of the loads by which they are past the limit point while the arm moves.
pub(super) const PAST: f64 = 1e-3;

/// The most snaps on one way.
pub(super) const MOST_SNAPS: usize = 50;

/// Tips (over L) that are as near as this are those of one equilibrium.
const SAME: f64 = 1e-4;

/// Where an arm came to rest: in the plane, or with [`crate::SpatialConfiguration`] in space.
#[derive(Debug, Clone)]
pub struct Rest<C = Configuration> {
    /// The equilibrium. The number of its growing motions is even, most often none: that is counted against another
    /// resistance than the arm's, against which they decay.
    pub configuration: C,
    /// When the arm came within 0.002 L of it to stay, s after it was let go.
    pub time: f64,
}

/// An engine whose arm can be let go.
pub(super) trait Lands: Loaded {
    /// Takes shape and loads of a configuration.
    fn take(&mut self, shape: &Self::Shape);
    /// The tip of a configuration.
    fn tip_of(shape: &Self::Shape) -> Self::Tip;
    /// The snaps on the way to a configuration.
    fn snaps_of(shape: &mut Self::Shape) -> &mut Vec<Snap<Self::Tip>>;
    /// Refuses arms that cannot move or whose motion never ends.
    fn can_rest(&self) -> Result<(), MotionError>;
    /// Lets the shape go under the loads that the equations have, and leaves the engine at the equilibrium in which the
    /// arm comes to rest, settled to `tol`.
    fn come_to_rest(&mut self, tol: f64) -> Result<Rest<Self::Shape>, Restless>;
}

/// A motion from a limit point.
pub(super) struct Landed<E: Lands> {
    /// The tip at the limit point.
    pub(super) before: E::Tip,
    pub(super) rest: Rest<E::Shape>,
    /// The tip where the curve leads on to at the same loads.
    pub(super) on_curve: Option<E::Tip>,
}

/// The motion from the last good shape of a path that ended in a limit point, with the loads past it that `past` gives
/// the engine, which is left where the arm rests. `after_snap` is where the curve leads on to.
pub(super) fn land<E: Lands>(
    engine: &mut E,
    last_good: Option<&E::Shape>,
    after_snap: Option<&E::Shape>,
    tol: f64,
    past: impl Fn(&mut E),
) -> Result<Landed<E>, Restless> {
    let Some(last_good) = last_good else { return Err(Restless::Motion(not_found(0.0, 0.0, None, engine.arm()))) };
    let on_curve = after_snap.and_then(|shape| {
        engine.take(shape);
        past(engine);
        engine.settle(tol, First::Warm).ok().and_then(|_| engine.tip())
    });
    engine.take(last_good);
    past(engine);
    engine.can_rest().map_err(Restless::Motion)?;
    Ok(Landed { before: E::tip_of(last_good), rest: engine.come_to_rest(tol)?, on_curve })
}

/// Whether the tip is elsewhere than `on_curve`, where there is such a place.
pub(super) fn elsewhere<T: Pose>(after: T, on_curve: Option<T>, length: f64) -> bool {
    on_curve.is_some_and(|tip| tip.distance_to(&after) > SAME * length || tip.turn_to(&after) > 0.01)
}
