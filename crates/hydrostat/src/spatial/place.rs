//! One place of an arm in space as data.

use super::loads::Body;
use super::rotation::{Directors, cross};
use super::section::Stiffness;
use crate::rod::arm::{Arm, Space};
use crate::rod::profile::Profile;

/// One place of the arm as data.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place<R> {
    /// Over L.
    pub(crate) s: R,
    pub(crate) stiffness: Stiffness<R>,
    /// d nu_o / ds, over L.
    pub(crate) reference_slope: R,
    pub(crate) body: Body<R>,
}

/// Whether anything of `space` loads the arm.
pub(super) fn loads_of(space: &Space) -> bool {
    space.tip_force != 0.0
        || space.tip_follower != 0.0
        || space.tip_moment != [0.0; 2]
        || !(space.force.is_zero() && space.couple.iter().all(Profile::is_zero))
}

/// The quaternion of the base of `arm`.
pub(super) fn base_of(arm: &Arm) -> [f64; 4] {
    let [a, b] = arm.base_directors();
    Directors { a, b, c: cross(&a, &b) }.quaternion()
}
