//! Which solutions are starts for which arms.

use crate::rod::arm::{Arm, Flow, Space};
use crate::rod::model_options::Support;

/// How far the tip may turn (rad) in a warm start to the answer of the arm's load ramp, which other conditions make
/// sure of.
pub(crate) const FARTHEST_ON_RAMP: f64 = 0.5;

/// Which equilibrium a warm start may give, where there are several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum WarmStart {
    /// The one on the branch of the last configuration, as for a control loop.
    #[default]
    Branch,
    /// The one that [`crate::Solver::solve`] gives, at the end of the arm's load ramp, as for the rows of a table.
    /// Wherever a warm start could end elsewhere, the arm is solved from its unloaded shape. Warm starts follow changes
    /// of loads only, of clamped arms without friction and without commanded strokes.
    Ramp,
}

/// Whether a solution for one arm is a start for the other: the same geometry, equations and unknowns.
pub(crate) fn alike(a: &Arm, b: &Arm) -> bool {
    a.has_geometry_of(b)
        && a.cables.iter().zip(&b.cables).all(|(a, b)| a.stroke.is_some() == b.stroke.is_some())
        && !a.has_friction()
        && !b.has_friction()
        && a.breaks() == b.breaks()
}

/// The numbers that [`differ_in_loads`] lets differ.
pub(crate) fn loads(arm: &Arm) -> Vec<f64> {
    let Flow { speed, direction, density, .. } = arm.flow;
    let gravity = arm.gravity.map_or([0.0; 2], |gravity| [gravity.acceleration, gravity.direction]);
    let [fx, fy] = arm.tip.force;
    let [fa, fb] = arm.tip.follower;
    let others = [speed, direction, density, gravity[0], gravity[1], fx, fy, fa, fb, arm.tip.moment];
    let in_space = arm.space.iter().flat_map(Space::loads);
    others.into_iter().chain(in_space).chain(arm.cables.iter().map(|cable| cable.tension)).collect()
}

/// Whether the next row may start from this arm's shape: no friction and no strokes, whose answers hang on the way to
/// them.
pub(crate) fn may_be_followed(arm: &Arm) -> bool {
    arm.model.support == Support::Clamped && !arm.has_friction() && !arm.is_commanded()
}

/// Whether an arm differs from another in what a solver takes between two solves.
pub(crate) fn differ_in_loads(a: &Arm, b: &Arm) -> bool {
    a.has_geometry_of(b)
        && a.base == b.base
        && a.density == b.density
        && a.material == b.material
        && a.distributed == b.distributed
        && a.space.iter().zip(&b.space).all(|(a, b)| a.is_loaded_along_as(b))
        && a.cables.iter().chain(&b.cables).all(|cable| cable.friction == 0.0)
        && b.cables.iter().all(|cable| cable.stroke.is_none())
}
