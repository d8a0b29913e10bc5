//! How a section swells as it is stretched: beta(nu), (15) and (16), and the water that it displaces.

use crate::rod::model_options::{Displaced, Volume};
use hydrostat_bvp::Real;

/// Section stretch and its slope in the stretch.
#[derive(Clone, Copy)]
pub(crate) struct SectionStretch<R> {
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
pub(crate) fn area_law<R: Real>(volume: Volume, nu: R) -> SectionStretch<R> {
    match volume {
        Volume::Planar => {
            let beta = R::of(1.0) / nu;
            SectionStretch { beta, slope: -(beta * beta) }
        }
        Volume::Circular => {
            let inverse = R::of(1.0) / nu;
            let beta = inverse.sqrt();
            SectionStretch { beta, slope: R::of(-0.5) * beta * inverse }
        }
        Volume::None => SectionStretch { beta: R::of(1.0), slope: R::of(0.0) },
    }
}

impl Volume {
    /// beta at the stretch `nu`, above 0: what a section's lengths across the arm are over those of the unloaded arm.
    ///
    /// ```
    /// use hydrostat::Volume;
    ///
    /// assert_eq!(Volume::Planar.section_stretch(0.5), 2.0);
    /// assert_eq!(Volume::Circular.section_stretch(0.25), 2.0);
    /// assert_eq!(Volume::None.section_stretch(0.5), 1.0);
    /// ```
    pub fn section_stretch(self, nu: f64) -> f64 {
        area_law(self, nu).beta
    }
}

/// beta^2 and its first two derivatives by nu: beta^2 = nu^-p with p = 2, 1, 0 under `planar`, `circular`, `none`.
#[inline(always)]
pub(crate) fn area_derivatives<R: Real>(volume: Volume, nu: R) -> [R; 3] {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let inverse = one / nu;
    match volume {
        Volume::Planar => {
            let area = inverse * inverse;
            [area, R::of(-2.0) * area * inverse, R::of(6.0) * area * area]
        }
        Volume::Circular => [inverse, -(inverse * inverse), R::of(2.0) * inverse * inverse * inverse],
        Volume::None => [one, zero, zero],
    }
}

/// The water that a section displaces over that of the unloaded arm, d, and d d / d nu.
///
/// By (15) the arm keeps its volume, so d = 1 under `planar` and `circular`; rigid sections (`none`) sweep d = nu. The
/// reading `section` has what the round section below (12) sweeps, d = nu beta^2, under every volume law.
#[inline(always)]
pub(crate) fn displacement<R: Real>(
    displaced: Displaced,
    volume: Volume,
    nu: R,
    section_stretch: &SectionStretch<R>,
) -> [R; 2] {
    match (displaced, volume) {
        (Displaced::Volume, Volume::Planar | Volume::Circular) => [R::of(1.0), R::of(0.0)],
        (Displaced::Volume, Volume::None) => [nu, R::of(1.0)],
        (Displaced::Section, _) => {
            let SectionStretch { beta, slope } = *section_stretch;
            [nu * beta * beta, beta * (beta + R::of(2.0) * nu * slope)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both readings agree where the round section keeps the arm's volume, and where no section swells.
    #[test]
    fn readings_of_the_displaced_water_differ_under_the_planar_law_alone() {
        for nu in [0.3, 0.8, 1.0, 1.4] {
            for volume in [Volume::Circular, Volume::None] {
                let [kept, section] = Displaced::ALL.map(|one| displacement(one, volume, nu, &area_law(volume, nu)));
                assert!((0..2).all(|k| (kept[k] - section[k]).abs() < 1e-15), "{volume:?} {nu}");
            }
            let planar = area_law(Volume::Planar, nu);
            assert_eq!(displacement(Displaced::Volume, Volume::Planar, nu, &planar), [1.0, 0.0]);
            let [d, d_nu] = displacement(Displaced::Section, Volume::Planar, nu, &planar);
            assert!((d - 1.0 / nu).abs() < 1e-15 && (d_nu + 1.0 / (nu * nu)).abs() < 1e-14);
        }
    }
}
