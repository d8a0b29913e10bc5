//! The section law: which strains carry a contact force and moment. (11)-(14).

use crate::cable::{Offset, pull};
use crate::readings::Volume;
use crate::swelling::{Swelling, swelling};
use hydrostat_bvp::Real;

/// A section as the law sees it, per unit beta^2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stiffness<R> {
    /// C1 A0, C2 A0, C3 A0 with A0 = pi (R^2 - R_in^2), the undeformed area.
    pub(crate) value: [R; 3],
    /// Their slopes along the arm.
    pub(crate) slope: [R; 3],
    /// Reference strains nu_o, eta_o, mu_o.
    pub(crate) reference: [R; 3],
    /// Their slopes along the arm.
    pub(crate) reference_slope: [R; 3],
}

/// A cable at a section: its offset, and its tension there (zero past its anchor).
#[derive(Debug, Clone, Copy)]
pub(crate) struct CableAt<R> {
    pub(crate) offset: Offset<R>,
    pub(crate) tension: R,
    /// T', which friction makes; zero without.
    pub(crate) tension_slope: R,
}

/// The law and the cables together at given strains: `carried` equals (n_f.a, n_f.b, m_f) in equilibrium.
#[derive(Clone, Copy)]
pub(crate) struct Balance<R> {
    pub(crate) swelling: Swelling<R>,
    /// C1 (nu - nu_o) A + sum T t_c.a,  C2 (eta - eta_o) A + sum T t_c.b,
    /// C3 (mu - mu_o) A - sum T y beta t_c.a.
    pub(crate) carried: [R; 3],
    /// Derivatives by nu, eta, mu.
    pub(crate) by_strain: [[R; 3]; 3],
    /// Derivative along s at fixed strains.
    pub(crate) along_s: [R; 3],
    /// The part of `along_s` that beta'' carries.
    pub(crate) by_curvature: [R; 3],
    /// The cables' part of `carried`.
    pub(crate) cables: [R; 3],
    /// Smallest tau.a / nu of the cables that pull: zero when one folds its side shut.
    pub(crate) openness: R,
}

/// (11), (12), (14): n.a = C1 (nu - nu_o) A, n.b = C2 (eta - eta_o) A, m = C3 (mu - mu_o) A with
/// A = A0 beta(nu)^2, joined with the cables' local law.
///
/// `beta_along` holds beta' and beta'', fixed here.
#[inline(always)]
pub(crate) fn balance<R: Real>(
    volume: Volume,
    stiffness: &Stiffness<R>,
    cables: &[CableAt<R>],
    strain: [R; 3],
    beta_along: [R; 2],
) -> Balance<R> {
    let swelling = swelling(volume, strain[0]);
    let area = swelling.beta * swelling.beta;
    let area_nu = R::of(2.0) * swelling.beta * swelling.slope;
    let zero = R::of(0.0);
    let mut out = Balance {
        swelling,
        carried: [zero; 3],
        by_strain: [[zero; 3]; 3],
        along_s: [zero; 3],
        by_curvature: [zero; 3],
        cables: [zero; 3],
        openness: R::of(1.0),
    };
    for k in 0..3 {
        let strained = strain[k] - stiffness.reference[k];
        out.by_strain[k][k] = stiffness.value[k] * area;
        out.carried[k] = out.by_strain[k][k] * strained;
        out.by_strain[k][0] += stiffness.value[k] * strained * area_nu;
        out.along_s[k] = (stiffness.slope[k] * strained - stiffness.value[k] * stiffness.reference_slope[k]) * area;
    }
    for cable in cables {
        let (pull, tangent) = pull(cable.tension, &cable.offset, strain, &swelling, beta_along);
        let open = zero.if_less(cable.tension, tangent.along / strain[0], R::of(1.0));
        out.openness = open.min(out.openness);
        for k in 0..3 {
            out.cables[k] += pull.load[k];
            out.along_s[k] += pull.along_s[k] + cable.tension_slope * pull.by_tension[k];
            out.by_curvature[k] += pull.by_curvature[k];
            for c in 0..3 {
                out.by_strain[k][c] += pull.by_strain[k][c];
            }
        }
    }
    for k in 0..3 {
        out.carried[k] += out.cables[k];
    }
    out
}

/// Inverse of a 3x3 matrix by cofactors, and its determinant.
#[inline(always)]
pub(crate) fn inverse3<R: Real>(m: &[[R; 3]; 3]) -> ([[R; 3]; 3], R) {
    let cofactor = |i: usize, j: usize| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1]
    };
    let first = [cofactor(0, 0), cofactor(0, 1), cofactor(0, 2)];
    let determinant = m[0][0] * first[0] + m[0][1] * first[1] + m[0][2] * first[2];
    let scale = R::of(1.0) / determinant;
    let row = |j: usize| [first[j] * scale, cofactor(1, j) * scale, cofactor(2, j) * scale];
    ([row(0), row(1), row(2)], determinant)
}

/// `m v`.
#[inline(always)]
pub(crate) fn apply3<R: Real>(m: &[[R; 3]; 3], v: [R; 3]) -> [R; 3] {
    [
        m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
        m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
        m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section() -> (Stiffness<f64>, [CableAt<f64>; 2]) {
        let stiffness = Stiffness {
            value: [3.0, 1.0, 0.2],
            slope: [-0.3, -0.1, -0.05],
            reference: [1.02, 0.01, 0.3],
            reference_slope: [0.05, -0.02, 0.4],
        };
        let cable = |y, tension| CableAt {
            offset: Offset { y, slope: -0.05 * y, curvature: 0.3 * y },
            tension,
            tension_slope: -0.3 * tension,
        };
        (stiffness, [cable(0.08, 0.4), cable(-0.05, 0.2)])
    }

    #[test]
    fn strain_derivatives_match_differences_for_every_volume_law() {
        let (stiffness, cables) = section();
        for volume in [Volume::Planar, Volume::Circular, Volume::None] {
            let e = [0.9, 0.03, 1.4];
            let b = balance(volume, &stiffness, &cables, e, [0.2, -0.5]);
            for c in 0..3 {
                let (mut hi, mut lo) = (e, e);
                hi[c] += 1e-6;
                lo[c] -= 1e-6;
                let hi = balance(volume, &stiffness, &cables, hi, [0.2, -0.5]).carried;
                let lo = balance(volume, &stiffness, &cables, lo, [0.2, -0.5]).carried;
                for k in 0..3 {
                    assert!(((hi[k] - lo[k]) / 2e-6 - b.by_strain[k][c]).abs() < 1e-8, "{volume:?} {k} {c}");
                }
            }
        }
    }

    #[test]
    fn derivative_along_s_matches_differences_of_everything_that_varies() {
        let (stiffness, cables) = section();
        let e = [0.9, 0.03, 1.4];
        let (slope, curvature) = (0.2, -0.5);
        let at = |ds: f64| {
            let mut st = stiffness;
            let mut ca = cables;
            for k in 0..3 {
                st.value[k] += ds * st.slope[k];
                st.reference[k] += ds * st.reference_slope[k];
            }
            for c in &mut ca {
                c.offset.y += ds * c.offset.slope + 0.5 * ds * ds * c.offset.curvature;
                c.offset.slope += ds * c.offset.curvature;
                c.tension += ds * c.tension_slope;
            }
            // At fixed strains beta itself stays, only beta' moves: its part in y' beta is y' beta', which
            // reaches the law through nu'.
            balance(Volume::Planar, &st, &ca, e, [slope + ds * curvature, curvature]).carried
        };
        let (lo, hi) = (at(-1e-6), at(1e-6));
        let b = balance(Volume::Planar, &stiffness, &cables, e, [slope, curvature]);
        for k in 0..3 {
            assert!(((hi[k] - lo[k]) / 2e-6 - b.along_s[k]).abs() < 1e-8);
        }
    }
}
