//! Inertia of a section: its own, that of the water it carries along, and that of the water it displaces.
//!
//! With r.. the acceleration of the centreline, U. that of the stream and w the normal of the centreline,
//!
//! ```text
//! n_f' = -f + rho_arm A_m r.. + f_a          A_m = pi (R^2 - R_in^2)
//! m_f' = -r' x n_f - couple + d/dt (J omega)  J = J_0 beta^2,  J_0 = rho_arm A_m (R^2 + R_in^2)/4
//! f_a  = rho_w C_a pi (beta R)^2 nu ((r.. - U.) . w) w          Morison's added mass, per reference length
//! ```
//!
//! The water in a flooded cavity moves along across the arm: rho_w pi R_in^2 d is added to the mass there. A stream
//! that speeds up acts on the displaced water as gravity does: f has rho_w d pi (R^2 - R_in^2) U. besides (sealed:
//! R^2), and rho_w d pi R_in^2 (U. . w) w where the cavity's water moves along.
//!
//! Left out: the section's own lateral motion, and the pull of omega^2 on the strains, both of the order (R/L)^2.

use crate::rod::area_law::{SectionStretch, area_derivatives, displacement};
use crate::rod::arm::{Arm, Cavity};
use crate::rod::loads::{Frame, Water, dot};
use crate::rod::model_options::Volume;
use crate::rod::profile::Profile;
use hydrostat_bvp::{Real, each};

/// Masses of a section per reference length, so that mass times acceleration (L/s2) is a load in the unit of force over
/// L; `rotary` is a couple in the unit of force over an angular acceleration (1/s2).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Masses<R> {
    /// rho_arm A_m.
    pub(crate) wall: R,
    /// J_0.
    pub(crate) rotary: R,
    /// rho_w C_a pi R^2.
    pub(crate) added: R,
    /// rho_w pi R_in^2 of a flooded cavity.
    pub(crate) inside: R,
    /// rho_w pi (R^2 - R_in^2), or R^2 of a sealed arm.
    pub(crate) displaced: R,
}

impl<R: Real> Masses<R> {
    /// Those of an arm where its profiles have the values `at`; `force` is the unit of force, N. All zero without
    /// inertia.
    #[inline(always)]
    pub(crate) fn new(arm: &Arm, force: f64, at: impl Fn(&Profile) -> R) -> Self {
        let zero = R::of(0.0);
        if !arm.dynamics.inertia {
            return Self { wall: zero, rotary: zero, added: zero, inside: zero, displaced: zero };
        }
        let pi = std::f64::consts::PI;
        let (r, r_in) = (at(&arm.radius), at(&arm.inner_radius));
        let (square, inner) = (r * r, r_in * r_in);
        let per_length = arm.length * arm.length / force;
        let wall = R::of(pi * arm.density) * (square - inner);
        let water = R::of(pi * arm.flow.density * per_length);
        let (inside, outline) = match arm.cavity {
            Cavity::Flooded => (water * inner, square - inner),
            Cavity::Sealed => (zero, square),
        };
        Self {
            wall: wall * R::of(per_length),
            rotary: wall * (square + inner) * R::of(0.25 / force),
            added: water * R::of(arm.dynamics.added_mass) * square,
            inside,
            displaced: water * outline,
        }
    }
}

/// A load of inertia in space, which n_f' has with a plus, and its derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Inertia<R> {
    pub(crate) force: [R; 2],
    pub(crate) by_theta: [R; 2],
    /// By nu, eta, mu.
    pub(crate) by_strain: [[R; 3]; 2],
    /// By the acceleration.
    pub(crate) by_acceleration: [[R; 2]; 2],
}

/// rho_arm A_m r.. + (M p) w - rho_w d A U.,  p = (r.. - U.) . w,  M = rho_w (C_a pi R^2 beta^2 nu + pi R_in^2 d).
/// `along` is the centreline's frame, accelerations are in L/s2.
#[inline(always)]
pub(crate) fn inertia<R: Real>(
    water: &Water,
    masses: &Masses<R>,
    along: &Frame<R>,
    nu: R,
    section_stretch: &SectionStretch<R>,
    acceleration: [R; 2],
    stream_acceleration: [f64; 2],
) -> Inertia<R> {
    let [area, area_nu, _] = area_derivatives(water.volume, nu);
    let [d, d_nu] = displacement(water.displaced, water.volume, nu, section_stretch);
    let still: [R; 2] = each(|k| R::of(stream_acceleration[k]));
    let against: [R; 2] = each(|k| acceleration[k] - still[k]);
    let mass = masses.added * area * nu + masses.inside * d;
    let mass_nu = masses.added * (area_nu * nu + area) + masses.inside * d_nu;
    let Frame { u, w, turn, .. } = along;
    let (across, down) = (dot(against, *w), dot(against, *u));
    // Turning u by a small angle turns w by -u.
    let turned: [R; 2] = each(|k| -(mass * (down * w[k] + across * u[k])));
    let own_by_nu: [R; 2] = each(|k| mass_nu * across * w[k] - masses.displaced * d_nu * still[k]);
    Inertia {
        force: each(|k| masses.wall * acceleration[k] + mass * across * w[k] - masses.displaced * d * still[k]),
        by_theta: turned,
        by_strain: each(|k| {
            let by = turned[k];
            [by * turn[0] + own_by_nu[k], by * turn[1], by * turn[2]]
        }),
        by_acceleration: each(|k| each(|c| mass * w[k] * w[c] + if k == c { masses.wall } else { R::of(0.0) })),
    }
}

/// The moment d/dt (J_0 beta^2 omega) = J_0 (beta^2 omega. + (beta^2)' nu. omega) and its derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Turning<R> {
    pub(crate) couple: R,
    /// By omega., omega, nu and nu. in this order.
    pub(crate) by: [R; 4],
}

/// [`Turning`] of a section whose stretch changes at the rate `nu_rate` (1/s) while it turns with `omega` (1/s).
#[inline(always)]
pub(crate) fn turning<R: Real>(
    volume: Volume,
    masses: &Masses<R>,
    [nu, nu_rate]: [R; 2],
    [omega, omega_rate]: [R; 2],
) -> Turning<R> {
    let [area, area_nu, area_nu_nu] = area_derivatives(volume, nu);
    let j = masses.rotary;
    Turning {
        couple: j * (area * omega_rate + area_nu * nu_rate * omega),
        by: [
            j * area,
            j * area_nu * nu_rate,
            j * (area_nu * omega_rate + area_nu_nu * nu_rate * omega),
            j * area_nu * omega,
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::area_law::area_law;
    use crate::rod::flow::Law;
    use crate::rod::loads::centreline;
    use crate::rod::model_options::{Displaced, FlowSurface, Hydrostatics, WettedLength};

    #[test]
    fn derivatives_match_differences_for_every_volume_law() {
        let masses = Masses { wall: 1.1, rotary: 0.02, added: 0.9, inside: 0.3, displaced: 0.8 };
        for (volume, displaced) in Volume::ALL.into_iter().flat_map(|v| Displaced::ALL.map(|d| (v, d))) {
            let water = Water {
                stream: [0.0; 2],
                law: Law::drag(1.0, 0.1),
                surface: FlowSurface::Centreline,
                wetted: WettedLength::Reference,
                volume,
                displaced,
                hydrostatics: Hydrostatics::Archimedes,
                tangential_factor: 1.0,
            };
            let at = |x: [f64; 5]| {
                let along = centreline([x[0].cos(), x[0].sin()], [x[1], x[2]]);
                inertia(&water, &masses, &along, x[1], &area_law(volume, x[1]), [x[3], x[4]], [0.4, -0.7])
            };
            let turned = |x: [f64; 4]| turning(volume, &masses, [x[2], x[3]], [x[1], x[0]]);
            let (x, y) = ([0.7, 0.9, 0.15, 2.0, -1.3], [1.7, -0.6, 0.85, 0.4]);
            let (exact, exact_turning) = (at(x), turned(y));
            for c in 0..5 {
                let (mut hi, mut lo) = (x, x);
                hi[c] += 1e-6;
                lo[c] -= 1e-6;
                for k in 0..2 {
                    let want = (at(hi).force[k] - at(lo).force[k]) / 2e-6;
                    let got = match c {
                        0 => exact.by_theta[k],
                        1 | 2 => exact.by_strain[k][c - 1],
                        _ => exact.by_acceleration[k][c - 3],
                    };
                    assert!((want - got).abs() < 1e-8, "{volume:?} {c} {k}: {got} {want}");
                }
            }
            for c in 0..4 {
                let (mut hi, mut lo) = (y, y);
                hi[c] += 1e-6;
                lo[c] -= 1e-6;
                let want = (turned(hi).couple - turned(lo).couple) / 2e-6;
                assert!((want - exact_turning.by[c]).abs() < 1e-8, "{volume:?} {c}");
            }
        }
    }
}
