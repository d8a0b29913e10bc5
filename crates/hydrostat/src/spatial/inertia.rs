//! Inertia of a section in space: its own, that of the water it carries along, and that of the water it displaces (see
//! [`crate::rod::inertia`] for the same in the plane).
//!
//! With r.. the acceleration of the centreline, U. that of the stream, p the part of r.. - U. normal to the
//! centreline, and omega the rate of turn in the directors,
//!
//! ```text
//! n_f' = -f + rho_arm A_m r.. + M p - rho_w d A U.     M = rho_w (C_a pi R^2 beta^2 nu + pi R_in^2 d)
//! m_f' = -r' x n_f - couple + d/dt (J omega)           J = J_0 beta^2 diag(2, 1, 1)
//! d/dt (J omega) = (beta^2)' nu. J_0 omega + J omega. + omega x J omega        in the directors
//! ```

use hydrostat_bvp::{Real, each};

use super::loads::{Tangent, Turned, Water};
use super::rotation::{Directors, Vector, cross, dot};
use crate::rod::area_law::{SectionStretch, area_derivatives, displacement};
use crate::rod::inertia::Masses;
use crate::rod::model_options::Volume;

/// A load of inertia in space, which n_f' has with a plus, and its derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Inertia<R> {
    pub(crate) force: Vector<R>,
    /// By a turn about each director.
    pub(crate) by_turn: [Vector<R>; 3],
    /// By nu, eta, zeta.
    pub(crate) by_stretch: [Vector<R>; 3],
    /// `by_acceleration[k][c]`: of component k by that of component c.
    pub(crate) by_acceleration: [Vector<R>; 3],
}

/// rho_arm A_m r.. + M p - rho_w d A U. Accelerations are in space, in L/s2.
#[inline(always)]
pub(crate) fn inertia<R: Real>(
    water: &Water,
    masses: &Masses<R>,
    directors: &Directors<R>,
    strain: &[R; 6],
    section_stretch: &SectionStretch<R>,
    acceleration: &Vector<R>,
    stream_acceleration: &Vector<f64>,
) -> Inertia<R> {
    let nu = strain[0];
    let [area, area_nu, _] = area_derivatives(water.volume, nu);
    let [d, d_nu] = displacement(water.displaced, water.volume, nu, section_stretch);
    let still: Vector<R> = each(|k| R::of(stream_acceleration[k]));
    let against = directors.to_body(&each(|k| acceleration[k] - still[k]));
    let mass = masses.added * area * nu + masses.inside * d;
    let mass_nu = masses.added * (area_nu * nu + area) + masses.inside * d_nu;
    let along = Tangent::of(strain);
    let mut own = Turned::default();
    own.add_across(&along, &against, &each(|k| mass_nu * against[k]), mass);
    let (by_turn, mut by_stretch) = own.gradients(directors, &along);
    let across = directors.to_space(&own.force);
    let t = directors.to_space(&along.t);
    for k in 0..3 {
        by_stretch[0][k] -= masses.displaced * d_nu * still[k];
    }
    Inertia {
        force: each(|k| masses.wall * acceleration[k] + across[k] - masses.displaced * d * still[k]),
        by_turn,
        by_stretch,
        by_acceleration: each(|k| each(|c| if k == c { masses.wall + mass } else { R::of(0.0) } - mass * t[k] * t[c])),
    }
}

/// The coordinates of a small turn from the rotation that a step starts with: c = 2 tan(angle/2) times the axis, in the
/// directors of the start, with rates v = c. and a = c.. . With D = 1 + c.c/4 they turn the section at
///
/// ```text
/// omega = (v - c x v/2)/D        omega. = (a - c x a/2)/D - (c.v) omega/(2 D)        in its directors
/// ```
///
/// and a turn psi about the directors changes c by psi + c x psi/2 + (c.psi) c/4.
#[derive(Clone, Copy)]
pub(crate) struct Turn<R> {
    pub(crate) c: Vector<R>,
    pub(crate) v: Vector<R>,
    pub(crate) a: Vector<R>,
}

impl<R: Real> Turn<R> {
    /// omega and omega. in the directors.
    #[inline(always)]
    pub(crate) fn rates(&self) -> [Vector<R>; 2] {
        let Self { c, v, a } = self;
        let (half, quarter) = (R::of(0.5), R::of(0.25));
        let fraction = R::of(1.0) / (R::of(1.0) + quarter * dot(c, c));
        let (cv, ca) = (cross(c, v), cross(c, a));
        let omega: Vector<R> = each(|k| fraction * (v[k] - half * cv[k]));
        let by = half * fraction * dot(c, v);
        [omega, each(|k| fraction * (a[k] - half * ca[k]) - by * omega[k])]
    }

    /// Changes of omega and omega. with a turn `psi` about the directors, where v and a change by `rate` and its square
    /// times the change of c.
    #[inline(always)]
    fn changes(&self, [omega, omega_rate]: &[Vector<R>; 2], rate: R, psi: &Vector<R>) -> [Vector<R>; 2] {
        let Self { c, v, a } = self;
        let (half, quarter) = (R::of(0.5), R::of(0.25));
        let fraction = R::of(1.0) / (R::of(1.0) + quarter * dot(c, c));
        let sideways = cross(c, psi);
        let along = quarter * dot(c, psi);
        let dc: Vector<R> = each(|k| psi[k] + half * sideways[k] + along * c[k]);
        let dv: Vector<R> = each(|k| rate * dc[k]);
        let da: Vector<R> = each(|k| rate * dv[k]);
        let less = half * fraction * dot(c, &dc);
        let (first, second) = (cross(&dc, v), cross(c, &dv));
        let turned: Vector<R> = each(|k| fraction * (dv[k] - half * (first[k] + second[k])) - less * omega[k]);
        let by = half * fraction * dot(c, v);
        let (first, second) = (cross(&dc, a), cross(c, &da));
        // fraction (a - c x a/2) = omega. + by omega.
        let own: Vector<R> =
            each(|k| fraction * (da[k] - half * (first[k] + second[k])) - less * (omega_rate[k] + by * omega[k]));
        let by_change = half * fraction * (dot(&dc, v) + dot(c, &dv)) - less * by;
        [turned, each(|k| own[k] - by_change * omega[k] - by * turned[k])]
    }
}

/// d/dt (J omega) in the directors with its derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Turning<R> {
    pub(crate) couple: Vector<R>,
    /// By a turn about each director.
    pub(crate) by_turn: [Vector<R>; 3],
    /// By nu, nu. with it.
    pub(crate) by_nu: Vector<R>,
}

/// [`Turning`] of a section whose stretch changes at the rate `nu_rate` (1/s), of which d nu./d nu is `rate`.
#[inline(always)]
pub(crate) fn turning<R: Real>(
    volume: Volume,
    masses: &Masses<R>,
    [nu, nu_rate]: [R; 2],
    turn: &Turn<R>,
    rate: R,
) -> Turning<R> {
    let [area, area_nu, area_nu_nu] = area_derivatives(volume, nu);
    let j = masses.rotary;
    let double = |v: &Vector<R>| [v[0] + v[0], v[1], v[2]];
    let rates = turn.rates();
    let [omega, omega_rate] = rates;
    let (spun, spun_rate) = (double(&omega), double(&omega_rate));
    let gyration = cross(&omega, &spun);
    let section_stretch = area_nu * nu_rate;
    Turning {
        couple: each(|k| j * (section_stretch * spun[k] + area * (spun_rate[k] + gyration[k]))),
        by_turn: each(|i| {
            let psi: Vector<R> = each(|k| R::of(if k == i { 1.0 } else { 0.0 }));
            let [turned, turned_rate] = turn.changes(&rates, rate, &psi);
            let (first, second) = (cross(&turned, &spun), cross(&omega, &double(&turned)));
            let (own, own_rate) = (double(&turned), double(&turned_rate));
            each(|k| j * (section_stretch * own[k] + area * (own_rate[k] + first[k] + second[k])))
        }),
        by_nu: each(|k| {
            let by = area_nu_nu * nu_rate + area_nu * rate;
            j * (by * spun[k] + area_nu * (spun_rate[k] + gyration[k]))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::rotation::{spin, turned};
    use super::*;
    use crate::rod::area_law::area_law;
    use crate::rod::flow::Law;
    use crate::rod::model_options::{Displaced, Hydrostatics, WettedLength};

    const STEP: f64 = 1e-6;
    const MASSES: Masses<f64> = Masses { wall: 1.1, rotary: 0.2, added: 0.9, inside: 0.3, displaced: 0.8 };

    fn close(a: &Vector<f64>, b: &Vector<f64>, within: f64) -> bool {
        (0..3).all(|k| (a[k] - b[k]).abs() < within)
    }

    /// c of the rotation from `from` to `q`, for quaternions.
    fn coordinates(from: &[f64; 4], q: &[f64; 4]) -> Vector<f64> {
        super::super::rotation::relative(from, q)
    }

    #[test]
    fn forces_follow_turns_strains_and_accelerations() {
        for volume in Volume::ALL {
            let water = Water {
                stream: [0.0; 3],
                law: Law::drag(1.0, 0.1),
                wetted: WettedLength::Reference,
                volume,
                displaced: Displaced::Section,
                hydrostatics: Hydrostatics::Archimedes,
            };
            let q = Directors::of(&[0.4, -0.3, 0.7, 0.2]).quaternion();
            let (strain, moved) = ([0.9, 0.05, -0.08, 0.2, 0.3, 0.4], [0.5, -1.2, 0.8]);
            let at = |q: &[f64; 4], strain: &[f64; 6], moved: &Vector<f64>| {
                let section_stretch = area_law(volume, strain[0]);
                inertia(&water, &MASSES, &Directors::of(q), strain, &section_stretch, moved, &[0.4, -0.7, 0.2])
            };
            let here = at(&q, &strain, &moved);
            for k in 0..3 {
                let mut unit = [0.0; 3];
                unit[k] = STEP;
                let by = |hi: Inertia<f64>, lo: Inertia<f64>| -> Vector<f64> {
                    each(|j| (hi.force[j] - lo.force[j]) / (2.0 * STEP))
                };
                let sides = |sign: f64| turned(&q, &unit.map(|v| sign * v));
                assert!(close(
                    &by(at(&sides(1.0), &strain, &moved), at(&sides(-1.0), &strain, &moved)),
                    &here.by_turn[k],
                    1e-8
                ));
                let sides = |sign: f64| {
                    let mut strain = strain;
                    strain[k] += sign * STEP;
                    strain
                };
                assert!(close(
                    &by(at(&q, &sides(1.0), &moved), at(&q, &sides(-1.0), &moved)),
                    &here.by_stretch[k],
                    1e-8
                ));
                let sides = |sign: f64| each(|j| moved[j] + sign * unit[j]);
                let column: Vector<f64> = each(|j| here.by_acceleration[j][k]);
                assert!(close(&by(at(&q, &strain, &sides(1.0)), at(&q, &strain, &sides(-1.0))), &column, 1e-8));
            }
        }
    }

    /// A quaternion that turns at a known rate: the coordinates' rates give it back.
    #[test]
    fn coordinates_turn_at_the_rate_of_the_section() {
        let from = Directors::of(&[0.4, -0.3, 0.7, 0.2]).quaternion();
        let at = |t: f64| {
            // omega = w + t x in the directors, to third order in t.
            let (w, x) = ([0.7, -0.4, 1.1], [0.3, 0.5, -0.2]);
            let middle = cross(&w, &x);
            turned(
                &turned(&from, &[0.5, 0.2, -0.4]),
                &each(|k| t * w[k] + 0.5 * t * t * x[k] + t * t * t * middle[k] / 12.0),
            )
        };
        let h = 1e-3;
        let [before, c, after] = [-h, 0.0, h].map(|t| coordinates(&from, &at(t)));
        let turn = Turn {
            c,
            v: each(|k| (after[k] - before[k]) / (2.0 * h)),
            a: each(|k| (after[k] - 2.0 * c[k] + before[k]) / (h * h)),
        };
        let [omega, omega_rate] = turn.rates();
        assert!(close(&omega, &[0.7, -0.4, 1.1], 1e-5), "{omega:?}");
        assert!(close(&omega_rate, &[0.3, 0.5, -0.2], 1e-5), "{omega_rate:?}");
        // And q. = q (0, omega)/2.
        let rate: [f64; 4] = each(|k| (at(h)[k] - at(-h)[k]) / (2.0 * h));
        let of = spin(&at(0.0), &omega);
        assert!((0..4).all(|k| (rate[k] - of[k]).abs() < 1e-5));
    }

    #[test]
    fn couples_follow_turns_and_stretch() {
        let from = Directors::of(&[0.4, -0.3, 0.7, 0.2]).quaternion();
        let rate = 3.0;
        let (start, start_rate) = ([0.1, 0.2, -0.1], [0.4, -0.3, 0.6]);
        for volume in Volume::ALL {
            let at = |q: &[f64; 4], nu: f64| {
                let c = coordinates(&from, q);
                let v: Vector<f64> = each(|k| rate * (c[k] - start[k]));
                let a = each(|k| rate * (v[k] - start_rate[k]));
                turning(volume, &MASSES, [nu, rate * (nu - 0.8)], &Turn { c, v, a }, rate)
            };
            let q = turned(&from, &[0.5, 0.2, -0.4]);
            let here = at(&q, 0.9);
            for k in 0..3 {
                let mut unit = [0.0; 3];
                unit[k] = STEP;
                let [hi, lo] = [1.0, -1.0].map(|sign| at(&turned(&q, &unit.map(|v: f64| sign * v)), 0.9).couple);
                assert!(close(&each(|j| (hi[j] - lo[j]) / (2.0 * STEP)), &here.by_turn[k], 1e-7), "{volume:?} {k}");
            }
            let [hi, lo] = [1.0, -1.0].map(|sign| at(&q, 0.9 + sign * STEP).couple);
            assert!(close(&each(|j| (hi[j] - lo[j]) / (2.0 * STEP)), &here.by_nu, 1e-7), "{volume:?}");
        }
    }
}
