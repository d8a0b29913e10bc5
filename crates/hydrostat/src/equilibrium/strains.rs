//! The strains of a section: Newton on the section law.

use hydrostat_bvp::{Lanes, Real, each};

use crate::readings::Volume;
use crate::section::{Balance, CableAt, Stiffness, apply3, balance, inverse3};

/// A station's strains and everything derived.
#[derive(Clone, Copy)]
pub(crate) struct Solved<R> {
    pub(crate) strain: [R; 3],
    pub(crate) balance: Balance<R>,
    pub(super) inverse: [[R; 3]; 3],
    /// Determinant of the section law over that of the slack one: not above zero past a limit.
    pub(crate) regularity: R,
    /// Last Newton step.
    pub(super) step: R,
}

impl Solved<Lanes> {
    /// Whether all lanes are.
    #[inline(always)]
    pub(super) fn fine(&self) -> bool {
        let open = self.balance.openness - Lanes::of(FOLDED);
        let positive = self.regularity.min(open).min(self.strain[0]);
        // A number that is none is below nothing.
        self.step.all_below(STATION) & (-positive).all_below(0.0) & (-self.regularity).all_below(0.0)
    }

    #[inline(always)]
    pub(super) fn fine_in(&self, lane: usize) -> bool {
        let positive = [self.regularity, self.balance.openness - Lanes::of(FOLDED), self.strain[0]];
        (self.step.0[lane] < STATION) & positive.iter().all(|v| v.0[lane] > 0.0)
    }
}

/// The last Newton step of the section law that stations can do with.
pub(super) const STATION: f64 = 1e-6;

/// Openness at which a cable has folded its side shut: below, steps are small because the law is steep, not because it is met.
pub(super) const FOLDED: f64 = 1e-8;

/// Where cables pull, steps below the tolerance but above this are followed by one more. What a step leaves is its square times what may be 1e6
/// where a cable nearly folds its side shut, and must not change from round to round: the length of such an arm
/// did, by 1e-6 of it.
const SHARP: f64 = 1e-9;

/// Newton on the section law from a guess, every lane to `tolerance` or to its own limit.
#[inline(always)]
pub(super) fn solve_section<R: Real>(
    volume: Volume,
    stiffness: &Stiffness<R>,
    cables: &[CableAt<R>],
    contact: [R; 3],
    guess: [R; 3],
    beta_along: [R; 2],
    tolerance: f64,
) -> Solved<R> {
    const SWIFT: usize = 8;
    const MOST: usize = 80;
    let mut strain = guess;
    let one = R::of(1.0);
    let mut near = false;
    for round in 0.. {
        if round == SWIFT && !near {
            strain = guess;
        }
        let balance = balance(volume, stiffness, cables, strain, beta_along);
        let (inverse, det) = inverse3(&balance.by_strain);
        let rest = each(|k| contact[k] - balance.carried[k]);
        let step = apply3(&inverse, rest);
        let mu_scale = one / (R::of(2.0) + strain[2].abs());
        let size = step[0].abs().max(step[1].abs()).max(step[2].abs() * mu_scale);
        let share = if round < SWIFT && is_short(&balance, cables, strain, step, size) {
            one
        } else {
            share_of(&balance, cables, strain, step, size, (round >= SWIFT).then_some(beta_along[0]))
        };
        for k in 0..3 {
            strain[k] += share * step[k];
        }
        let size = size.if_less(R::of(f64::INFINITY), size, R::of(f64::INFINITY));
        let content = size.all_below(tolerance);
        let done = content && (near || cables.is_empty() || size.all_below(SHARP));
        near = content;
        if done || round == MOST {
            let area = balance.swelling.beta * balance.swelling.beta;
            let slack = stiffness.value[0] * stiffness.value[1] * stiffness.value[2] * area * area * area;
            return Solved { strain, balance, inverse, regularity: det / slack, step: size };
        }
    }
    unreachable!("the loop returns at its last round")
}

/// Whether [`share_of`] is one, in every lane and for little more than the section law's first rounds need.
#[inline(always)]
fn is_short<R: Real>(balance: &Balance<R>, cables: &[CableAt<R>], strain: [R; 3], step: [R; 3], size: R) -> bool {
    let mut excess = (size - R::of(0.7)).max(step[0].abs() - R::of(0.5) * strain[0]);
    for cable in cables {
        let (now, closing) = side(balance, cable, strain, step);
        excess = excess.max(closing - R::of(0.67) * now.abs());
    }
    excess.all_below(0.0)
}

/// tau . a of a cable, and how much of it a step takes away.
#[inline(always)]
fn side<R: Real>(balance: &Balance<R>, cable: &CableAt<R>, strain: [R; 3], step: [R; 3]) -> (R, R) {
    let lever = cable.offset.y * balance.swelling.beta;
    let lever_nu = cable.offset.y * balance.swelling.slope;
    (strain[0] - lever * strain[2], lever * step[2] + (lever_nu * strain[2] - R::of(1.0)) * step[0])
}

/// The share of a step of the section law that neither more than halves nu, nor closes a cable's side by more than
/// two thirds, nor leaps; with beta' also turns no cable by more than a fraction of a radian.
#[inline(always)]
fn share_of<R: Real>(
    balance: &Balance<R>,
    cables: &[CableAt<R>],
    strain: [R; 3],
    step: [R; 3],
    size: R,
    turning_at: Option<R>,
) -> R {
    let one = R::of(1.0);
    let mut share = one.min(R::of(0.5) * strain[0] / step[0].abs().max(R::of(1e-30)));
    share = share.min(R::of(0.7) / size.max(R::of(1e-30)));
    for cable in cables {
        let (now, closing) = side(balance, cable, strain, step);
        let allowed = R::of(0.67) * now.abs() / closing.max(R::of(1e-30));
        share = share.min(R::of(0.0).if_less(cable.tension, allowed, one));
        if let Some(beta_slope) = turning_at {
            let swelling = &balance.swelling;
            let across = strain[1] + cable.offset.slope * swelling.beta + cable.offset.y * beta_slope;
            let stretch = (now * now + across * across).sqrt();
            let turning = (step[1] + cable.offset.slope * swelling.slope * step[0]).abs();
            let allowed = R::of(0.3) * stretch / turning.max(R::of(1e-30));
            share = share.min(R::of(0.0).if_less(cable.tension, allowed, one));
        }
    }
    share
}
