//! The strains of a section: Newton's method on the section law.

use hydrostat_bvp::{Lanes, Real, each};

use crate::rod::model_options::Volume;
use crate::rod::section::{Balance, CableAt, Stiffness, apply3, balance, inverse3};

/// A section near its strains: the law at `strain`, and the Newton step from there.
#[derive(Clone, Copy)]
pub(crate) struct Solved<R> {
    pub(crate) strain: [R; 3],
    pub(crate) balance: Balance<R>,
    pub(crate) inverse: [[R; 3]; 3],
    /// The Newton step.
    pub(crate) change: [R; 3],
    /// Determinant of the section law over that of the slack one: not above zero past a limit.
    pub(crate) regularity: R,
    /// Size of the step.
    pub(crate) size: R,
}

impl Solved<Lanes> {
    /// Whether every lane is within `tolerance` of strains within the limits.
    #[inline(always)]
    pub(crate) fn is_solved(&self, tolerance: f64) -> bool {
        let open = self.balance.openness - Lanes::of(FOLDED);
        let regular = self.regularity - Lanes::of(SINGULAR);
        let positive = regular.min(open).min(self.strain[0]);
        // A number that is none is below nothing.
        self.size.all_below(tolerance) & (-positive).all_below(0.0) & (-regular).all_below(0.0)
    }

    #[inline(always)]
    pub(crate) fn is_solved_in(&self, lane: usize, tolerance: f64) -> bool {
        let positive =
            [self.regularity - Lanes::of(SINGULAR), self.balance.openness - Lanes::of(FOLDED), self.strain[0]];
        (self.size.0[lane] < tolerance) & positive.iter().all(|v| v.0[lane] > 0.0)
    }
}

/// Openness at which a cable has folded its side shut: below, steps are small because the law is steep, not because it
/// is met.
pub(crate) const FOLDED: f64 = 1e-8;

/// Determinant of the section law over that of the slack one, up to which the law counts as singular: `circular` never
/// ends, but stretches by 3e4 there, at 0.99997 of what it can carry.
pub(crate) const SINGULAR: f64 = 3e-5;

/// Newton on the section law from `strain` until the step is below `tolerance` in every lane; that last step is not
/// taken.
#[inline(always)]
pub(crate) fn solve_section<R: Real>(
    volume: Volume,
    stiffness: &Stiffness<R>,
    cables: &[CableAt<R>],
    contact: [R; 3],
    guess: [R; 3],
    beta_slope: R,
    tolerance: f64,
) -> Solved<R> {
    const SWIFT: usize = 8;
    const MOST: usize = 80;
    let mut strain = guess;
    let one = R::of(1.0);
    for round in 0.. {
        if round == SWIFT {
            strain = guess;
        }
        let balance = balance(volume, stiffness, cables, strain, beta_slope);
        let (inverse, det) = inverse3(&balance.by_strain);
        let rest = each(|k| contact[k] - balance.carried[k]);
        let change = apply3(&inverse, rest);
        let mu_scale = one / (R::of(2.0) + strain[2].abs());
        let nu_scale = one / one.max(strain[0]);
        let size = (change[0].abs().max(change[1].abs()) * nu_scale).max(change[2].abs() * mu_scale);
        let size = size.if_less(R::of(f64::INFINITY), size, R::of(f64::INFINITY));
        if size.all_below(tolerance) || round == MOST {
            let area = balance.section_stretch.beta * balance.section_stretch.beta;
            let slack = stiffness.value[0] * stiffness.value[1] * stiffness.value[2] * area * area * area;
            return Solved { strain, balance, inverse, change, regularity: det / slack, size };
        }
        let damping = if round < SWIFT && is_short(&balance, cables, strain, change, size) {
            one
        } else {
            damping_of(&balance, cables, strain, change, size, (round >= SWIFT).then_some(beta_slope))
        };
        for k in 0..3 {
            strain[k] += damping * change[k];
        }
    }
    unreachable!("the loop returns at its last round")
}

/// Whether [`damping_of`] is one, in every lane and for little more than the section law's first rounds need.
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
    let lever = cable.offset.y * balance.section_stretch.beta;
    let lever_nu = cable.offset.y * balance.section_stretch.slope;
    (strain[0] - lever * strain[2], lever * step[2] + (lever_nu * strain[2] - R::of(1.0)) * step[0])
}

/// The damping of a step of the section law that neither more than halves nu, nor closes a cable's side by more than
/// two thirds, nor leaps; with beta' also turns no cable by more than a fraction of a radian.
#[inline(always)]
fn damping_of<R: Real>(
    balance: &Balance<R>,
    cables: &[CableAt<R>],
    strain: [R; 3],
    step: [R; 3],
    size: R,
    turning_at: Option<R>,
) -> R {
    let one = R::of(1.0);
    let mut damping = one.min(R::of(0.5) * strain[0] / step[0].abs().max(R::of(1e-30)));
    damping = damping.min(R::of(0.7) / size.max(R::of(1e-30)));
    for cable in cables {
        let (now, closing) = side(balance, cable, strain, step);
        let allowed = R::of(0.67) * now.abs() / closing.max(R::of(1e-30));
        damping = damping.min(R::of(0.0).if_less(cable.tension, allowed, one));
        if let Some(beta_slope) = turning_at {
            let section_stretch = &balance.section_stretch;
            let across = strain[1] + cable.offset.slope * section_stretch.beta + cable.offset.y * beta_slope;
            let stretch = (now * now + across * across).sqrt();
            let turning = (step[1] + cable.offset.slope * section_stretch.slope * step[0]).abs();
            let allowed = R::of(0.3) * stretch / turning.max(R::of(1e-30));
            damping = damping.min(R::of(0.0).if_less(cable.tension, allowed, one));
        }
    }
    damping
}
