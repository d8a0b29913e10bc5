//! The section law in six strains, and a cable at a section (`docs/model.md`, the arm in space).
//!
//! The strains are (nu, eta, zeta, tau, kappa, mu): v = nu a + eta b + zeta c is r', and u = tau a + kappa b + mu c
//! the rate at which the directors turn, a' = u x a. One isotropic round section has
//!
//! ```text
//! n = A (C1 (nu - nu_o) a + C2 (eta - eta_o) b + C2 (zeta - zeta_o) c)
//! m = A (C4 (tau - tau_o) a + C3 (kappa - kappa_o) b + C3 (mu - mu_o) c)        A = A0 beta(nu)^2
//! ```
//!
//! and a cable at y b + z c of the straight arm passes at p = beta (y b + z c), with the tangent
//!
//! ```text
//! tau_c = v + u x p + (0, (beta y)', (beta z)')        t = tau_c/|tau_c|
//! n = n_f - sum T t        m = m_f - sum T p x t
//! ```

use hydrostat_bvp::{Real, each};

use super::rotation::{Vector, cross, dot, sum, times};
use crate::rod::area_law::{SectionStretch, area_law};
use crate::rod::model_options::Volume;

/// Strains of a section.
pub(crate) const STRAINS: usize = 6;

/// A section as the law sees it, per unit beta^2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stiffness<R> {
    /// C1 A0, C2 A0, C2 A0, C4 A0, C3 A0, C3 A0.
    pub(crate) value: [R; STRAINS],
    /// Reference strains.
    pub(crate) reference: [R; STRAINS],
}

/// A cable at a section: y and z with their slopes, and its tension there (zero past its anchor).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct CableAt<R> {
    pub(crate) y: R,
    pub(crate) z: R,
    pub(crate) y_slope: R,
    pub(crate) z_slope: R,
    pub(crate) tension: R,
}

/// The law and the cables together at given strains: `carried` equals (n_f, m_f) in the directors in equilibrium.
#[derive(Clone, Copy)]
pub(crate) struct Balance<R> {
    pub(crate) section_stretch: SectionStretch<R>,
    pub(crate) carried: [R; STRAINS],
    pub(crate) by_strain: [[R; STRAINS]; STRAINS],
    /// Derivatives by beta'.
    pub(crate) by_beta_slope: [R; STRAINS],
    /// The cables' part of `carried`.
    pub(crate) cables: [R; STRAINS],
    /// Smallest tau_c . a / nu of the cables that pull: zero when one folds its side shut.
    pub(crate) openness: R,
}

/// What one cable adds to the section's balance, with its derivatives, and its tangent.
#[derive(Clone, Copy)]
pub(crate) struct Pull<R> {
    /// T (t, p x t) in the directors.
    pub(crate) load: [R; STRAINS],
    pub(crate) by_strain: [[R; STRAINS]; STRAINS],
    pub(crate) by_beta_slope: [R; STRAINS],
    /// tau_c . a.
    pub(crate) along: R,
}

/// The tangent tau_c of a cable, its place p, and what both change by with beta.
#[inline(always)]
pub(crate) fn tangent<R: Real>(
    cable: &CableAt<R>,
    strain: &[R; STRAINS],
    section_stretch: &SectionStretch<R>,
    beta_slope: R,
) -> Tangent<R> {
    let zero = R::of(0.0);
    let [nu, eta, zeta, u1, u2, u3] = *strain;
    let place = [zero, cable.y, cable.z];
    let slope = [zero, cable.y_slope, cable.z_slope];
    let by_beta = sum(&cross(&[u1, u2, u3], &place), &slope);
    let tau = each(|k| [nu, eta, zeta][k] + section_stretch.beta * by_beta[k] + beta_slope * place[k]);
    Tangent { tau, by_beta, place }
}

/// See [`tangent`].
#[derive(Clone, Copy)]
pub(crate) struct Tangent<R> {
    pub(crate) tau: Vector<R>,
    /// d tau / d beta.
    pub(crate) by_beta: Vector<R>,
    /// p over beta, which is also d tau / d beta'.
    pub(crate) place: Vector<R>,
}

/// What a cable adds to the balance.
#[inline(always)]
pub(crate) fn pull<R: Real>(
    cable: &CableAt<R>,
    strain: &[R; STRAINS],
    section_stretch: &SectionStretch<R>,
    beta_slope: R,
) -> Pull<R> {
    let zero = R::of(0.0);
    let Tangent { tau, by_beta, place } = tangent(cable, strain, section_stretch, beta_slope);
    let inverse = R::of(1.0) / dot(&tau, &tau).sqrt();
    let t = times(inverse, &tau);
    let tension = cable.tension;
    let lever = times(section_stretch.beta, &place);
    let force = times(tension, &t);
    let moment = cross(&lever, &force);
    let fraction = tension * inverse;
    // T dt for a change of tau.
    let turned = |d: &Vector<R>| {
        let along = dot(&t, d);
        each(|k| fraction * (d[k] - along * t[k]))
    };
    let mut out = Pull {
        load: [force[0], force[1], force[2], moment[0], moment[1], moment[2]],
        by_strain: [[zero; STRAINS]; STRAINS],
        by_beta_slope: [zero; STRAINS],
        along: tau[0],
    };
    let both = |force: Vector<R>| {
        let moment = cross(&lever, &force);
        [force[0], force[1], force[2], moment[0], moment[1], moment[2]]
    };
    let one = |k: usize| each(|j| if j == k { R::of(1.0) } else { zero });
    for k in 0..3 {
        let by_v = both(turned(&one(k)));
        let by_u = both(turned(&cross(&one(k), &lever)));
        for row in 0..STRAINS {
            out.by_strain[row][k] = by_v[row];
            out.by_strain[row][3 + k] = by_u[row];
        }
    }
    let by_section_stretch = both(turned(&times(section_stretch.slope, &by_beta)));
    let by_lever = cross(&times(section_stretch.slope, &place), &force);
    for row in 0..3 {
        out.by_strain[row][0] += by_section_stretch[row];
        out.by_strain[3 + row][0] += by_section_stretch[3 + row] + by_lever[row];
    }
    out.by_beta_slope = both(turned(&place));
    out
}

/// The section law joined with the cables' local law.
#[inline(always)]
pub(crate) fn balance<R: Real>(
    volume: Volume,
    stiffness: &Stiffness<R>,
    cables: &[CableAt<R>],
    strain: &[R; STRAINS],
    beta_slope: R,
) -> Balance<R> {
    let zero = R::of(0.0);
    let section_stretch = area_law(volume, strain[0]);
    let area = section_stretch.beta * section_stretch.beta;
    let area_nu = R::of(2.0) * section_stretch.beta * section_stretch.slope;
    let mut out = Balance {
        section_stretch,
        carried: [zero; STRAINS],
        by_strain: [[zero; STRAINS]; STRAINS],
        by_beta_slope: [zero; STRAINS],
        cables: [zero; STRAINS],
        openness: R::of(1.0),
    };
    for k in 0..STRAINS {
        let strained = strain[k] - stiffness.reference[k];
        out.by_strain[k][k] = stiffness.value[k] * area;
        out.carried[k] = out.by_strain[k][k] * strained;
        out.by_strain[k][0] += stiffness.value[k] * strained * area_nu;
    }
    for cable in cables {
        let pull = pull(cable, strain, &section_stretch, beta_slope);
        let open = zero.if_less(cable.tension, pull.along / strain[0], R::of(1.0));
        out.openness = open.min(out.openness);
        for k in 0..STRAINS {
            out.cables[k] += pull.load[k];
            out.by_beta_slope[k] += pull.by_beta_slope[k];
            for c in 0..STRAINS {
                out.by_strain[k][c] += pull.by_strain[k][c];
            }
        }
    }
    for k in 0..STRAINS {
        out.carried[k] += out.cables[k];
    }
    out
}

/// Inverse of the balance's derivative, and its last pivot: that of nu, once the other five strains are eliminated.
///
/// Those five rows are symmetric and positive definite whatever the tensions, because beta depends on nu alone: they
/// need no exchanges. The pivot of nu passes through zero at the limits of the section law.
#[inline(always)]
pub(crate) fn inverse<R: Real>(m: &[[R; STRAINS]; STRAINS]) -> ([[R; STRAINS]; STRAINS], R) {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let mut out = *m;
    let mut last = one;
    for step in 0..STRAINS {
        let k = if step + 1 == STRAINS { 0 } else { step + 1 };
        let pivot = out[k][k];
        last = pivot;
        let scale = one / pivot;
        out[k][k] = one;
        for c in 0..STRAINS {
            out[k][c] = out[k][c] * scale;
        }
        let own = out[k];
        for i in 0..STRAINS {
            if i != k {
                let f = out[i][k];
                out[i][k] = zero;
                for c in 0..STRAINS {
                    out[i][c] -= f * own[c];
                }
            }
        }
    }
    (out, last)
}

/// `m v`.
#[inline(always)]
pub(crate) fn apply<R: Real>(m: &[[R; STRAINS]; STRAINS], v: &[R; STRAINS]) -> [R; STRAINS] {
    let mut out = [R::of(0.0); STRAINS];
    for k in 0..STRAINS {
        for c in 0..STRAINS {
            out[k] += m[k][c] * v[c];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::cable::Offset;

    fn section() -> (Stiffness<f64>, [CableAt<f64>; 3]) {
        let stiffness =
            Stiffness { value: [3.0, 1.0, 1.0, 0.15, 0.2, 0.2], reference: [1.02, 0.01, -0.02, 0.1, 0.2, 0.3] };
        let cable =
            |y, z, tension| CableAt { y, z, y_slope: -0.05 * y + 0.3 * z, z_slope: 0.02 * z - 0.3 * y, tension };
        (stiffness, [cable(0.08, 0.01, 0.4), cable(-0.05, 0.06, 0.2), cable(0.0, -0.07, 0.1)])
    }

    #[test]
    fn derivatives_match_differences_for_every_volume_law() {
        let (stiffness, cables) = section();
        for volume in Volume::ALL {
            let x = [0.9, 0.03, -0.05, 0.4, -0.8, 1.4, 0.2];
            let at = |x: [f64; 7]| balance(volume, &stiffness, &cables, &each(|k| x[k]), x[6]);
            let here = at(x);
            for c in 0..7 {
                let (mut hi, mut lo) = (x, x);
                hi[c] += 1e-6;
                lo[c] -= 1e-6;
                let (hi, lo) = (at(hi).carried, at(lo).carried);
                for k in 0..STRAINS {
                    let exact = if c < STRAINS { here.by_strain[k][c] } else { here.by_beta_slope[k] };
                    assert!(((hi[k] - lo[k]) / 2e-6 - exact).abs() < 1e-8, "{volume:?} {k} {c}");
                }
            }
            let (inverse, pivot) = inverse(&here.by_strain);
            assert!(pivot > 0.0);
            for k in 0..STRAINS {
                let column = apply(&here.by_strain, &each(|j| inverse[j][k]));
                assert!((0..STRAINS).all(|j| (column[j] - f64::from(u8::from(j == k))).abs() < 1e-12));
            }
        }
    }

    /// In the plane the law is the planar one.
    #[test]
    fn in_the_plane_it_is_the_planar_law() {
        let (stiffness, _) = section();
        let stiffness = Stiffness { reference: [1.02, 0.01, 0.0, 0.0, 0.0, 0.3], ..stiffness };
        let cable = CableAt { y: 0.08, z: 0.0, y_slope: -0.01, z_slope: 0.0, tension: 0.4 };
        let planar = crate::rod::section::Stiffness {
            value: [3.0, 1.0, 0.2],
            reference: [1.02, 0.01, 0.3],
            reference_slope: 0.0,
        };
        let own = crate::rod::section::CableAt { offset: Offset { y: 0.08, slope: -0.01 }, tension: 0.4 };
        for volume in Volume::ALL {
            let here = balance(volume, &stiffness, &[cable], &[0.9, 0.03, 0.0, 0.0, 0.0, 1.4], 0.2);
            let there = crate::rod::section::balance(volume, &planar, &[own], [0.9, 0.03, 1.4], 0.2);
            for (k, of) in [0, 1, 5].into_iter().enumerate() {
                assert!((here.carried[of] - there.carried[k]).abs() < 1e-15, "{volume:?}");
            }
            assert!([2, 3, 4].into_iter().all(|k| here.carried[k].abs() < 1e-15), "{volume:?}");
        }
    }
}
