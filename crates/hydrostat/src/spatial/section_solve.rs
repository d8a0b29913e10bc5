//! The strains of a section in space: Newton's method on the section law.

use hydrostat_bvp::{Lanes, Real, each};

use super::section::{Balance, CableAt, STRAINS, Stiffness, apply, balance, inverse, tangent};
use crate::rod::model_options::Volume;

/// A section near its strains: the law at `strain`, and the Newton step from there.
#[derive(Clone, Copy)]
pub(crate) struct Solved<R> {
    pub(crate) strain: [R; STRAINS],
    pub(crate) balance: Balance<R>,
    pub(crate) inverse: [[R; STRAINS]; STRAINS],
    /// The Newton step.
    pub(crate) change: [R; STRAINS],
    /// The last pivot of the section law over that of the slack one: not above zero past a limit.
    pub(crate) regularity: R,
    /// Size of the step.
    pub(crate) size: R,
}

/// Openness at which a cable has folded its side shut, see the planar law.
pub(crate) const FOLDED: f64 = 1e-8;

/// The regularity up to which the law counts as singular, see the planar law.
pub(crate) const SINGULAR: f64 = 3e-5;

impl Solved<Lanes> {
    /// Whether every lane is within `tolerance` of strains within the limits.
    #[inline(always)]
    pub(crate) fn is_fine(&self, tolerance: f64) -> bool {
        let regular = self.regularity - Lanes::of(SINGULAR);
        let positive = regular.min(self.balance.openness - Lanes::of(FOLDED)).min(self.strain[0]);
        // A number that is none is below nothing.
        self.size.all_below(tolerance) & (-positive).all_below(0.0) & (-regular).all_below(0.0)
    }

    #[inline(always)]
    pub(super) fn is_fine_in(&self, lane: usize, tolerance: f64) -> bool {
        let positive =
            [self.regularity - Lanes::of(SINGULAR), self.balance.openness - Lanes::of(FOLDED), self.strain[0]];
        (self.size.0[lane] < tolerance) & positive.iter().all(|v| v.0[lane] > 0.0)
    }
}

/// Newton on the section law from `guess` until the step is below `tolerance` in every lane; that last step is not
/// taken.
#[inline(always)]
pub(crate) fn solve_section<R: Real>(
    volume: Volume,
    stiffness: &Stiffness<R>,
    cables: &[CableAt<R>],
    contact: &[R; STRAINS],
    guess: &[R; STRAINS],
    beta_slope: R,
    tolerance: f64,
) -> Solved<R> {
    const SWIFT: usize = 8;
    const MOST: usize = 80;
    let one = R::of(1.0);
    let mut strain = *guess;
    for round in 0.. {
        if round == SWIFT {
            strain = *guess;
        }
        let balance = balance(volume, stiffness, cables, &strain, beta_slope);
        let (inverse, pivot) = inverse(&balance.by_strain);
        let rest = each(|k| contact[k] - balance.carried[k]);
        let change = apply(&inverse, &rest);
        let nu_scale = one / one.max(strain[0]);
        let mut size = R::of(0.0);
        for k in 0..STRAINS {
            let scale = if k < 3 { nu_scale } else { one / (R::of(2.0) + strain[k].abs()) };
            size = size.max(change[k].abs() * scale);
        }
        let mut sound = R::of(0.0);
        for k in 0..STRAINS {
            sound += change[k];
        }
        // A number that is none is less than nothing: no step.
        let size = sound.abs().if_less(R::of(f64::INFINITY), size, R::of(f64::INFINITY));
        if size.all_below(tolerance) || round == MOST {
            let slack = stiffness.value[0] * balance.section_stretch.beta * balance.section_stretch.beta;
            return Solved { strain, balance, inverse, change, regularity: pivot / slack, size };
        }
        let turning_at = (round >= SWIFT).then_some(beta_slope);
        let fraction = fraction_of(&balance, cables, &strain, &change, size, turning_at);
        for k in 0..STRAINS {
            strain[k] += fraction * change[k];
        }
    }
    unreachable!("the loop returns at its last round")
}

/// The fraction of a step of the section law that neither more than halves nu, nor closes a cable's side by more than
/// two thirds, nor leaps; with beta' also turns no cable by more than a fraction of a radian.
#[inline(always)]
fn fraction_of<R: Real>(
    balance: &Balance<R>,
    cables: &[CableAt<R>],
    strain: &[R; STRAINS],
    step: &[R; STRAINS],
    size: R,
    turning_at: Option<R>,
) -> R {
    let (zero, one, least) = (R::of(0.0), R::of(1.0), R::of(1e-30));
    let section_stretch = &balance.section_stretch;
    let mut fraction = one.min(R::of(0.5) * strain[0] / step[0].abs().max(least));
    fraction = fraction.min(R::of(0.7) / size.max(least));
    for cable in cables {
        // tau_c . a = nu + beta (kappa z - mu y), and how much of it the step takes away.
        let bend = strain[4] * cable.z - strain[5] * cable.y;
        let now = strain[0] + section_stretch.beta * bend;
        let gained = step[0]
            + section_stretch.slope * step[0] * bend
            + section_stretch.beta * (step[4] * cable.z - step[5] * cable.y);
        let allowed = R::of(0.67) * now.abs() / (-gained).max(least);
        fraction = fraction.min(zero.if_less(cable.tension, allowed, one));
        if let Some(beta_slope) = turning_at {
            let tau = tangent(cable, strain, section_stretch, beta_slope).tau;
            let stretch = (tau[0] * tau[0] + tau[1] * tau[1] + tau[2] * tau[2]).sqrt();
            let beta_step = section_stretch.slope * step[0];
            let across = |step: R, slope: R, twist: R| step + slope * beta_step + section_stretch.beta * twist;
            let b = across(step[1], cable.y_slope, -(step[3] * cable.z)).abs();
            let c = across(step[2], cable.z_slope, step[3] * cable.y).abs();
            let allowed = R::of(0.3) * stretch / (b + c).max(least);
            fraction = fraction.min(zero.if_less(cable.tension, allowed, one));
        }
    }
    fraction
}
