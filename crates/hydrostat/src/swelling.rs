//! How a section swells as it is stretched: beta(nu), (15) and (16).

use crate::readings::Volume;
use hydrostat_bvp::Real;

/// Section stretch and its slope in the stretch.
#[derive(Clone, Copy)]
pub(crate) struct Swelling<R> {
    /// beta.
    pub(crate) beta: R,
    /// d beta / d nu.
    pub(crate) slope: R,
}

/// (15), (16): det F = beta (nu -+ beta R mu) on the two sides; its mean over the section is beta nu.
///
/// `planar` sets that mean to one, `circular` keeps the volume of a round section, nu beta^2 = 1,
/// and `none` keeps the section rigid. Needs nu > 0.
#[inline(always)]
pub(crate) fn swelling<R: Real>(volume: Volume, nu: R) -> Swelling<R> {
    match volume {
        Volume::Planar => {
            let beta = R::of(1.0) / nu;
            Swelling { beta, slope: -(beta * beta) }
        }
        Volume::Circular => {
            let inverse = R::of(1.0) / nu;
            let beta = inverse.sqrt();
            Swelling { beta, slope: R::of(-0.5) * beta * inverse }
        }
        Volume::None => Swelling { beta: R::of(1.0), slope: R::of(0.0) },
    }
}
