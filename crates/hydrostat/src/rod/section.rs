//! The section law: which strains carry a contact force and moment. (11)-(14).

use crate::rod::area_law::{SectionStretch, area_law};
use crate::rod::cable::{Offset, pull};
use crate::rod::model_options::Volume;
use hydrostat_bvp::Real;

/// A section as the law sees it, per unit beta^2.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stiffness<R> {
    /// C1 A0, C2 A0, C3 A0 with A0 = pi (R^2 - R_in^2), the undeformed area.
    pub(crate) value: [R; 3],
    /// Reference strains nu_o, eta_o, mu_o.
    pub(crate) reference: [R; 3],
    /// Slope of nu_o along the arm.
    pub(crate) reference_slope: R,
}

/// A cable at a section: its offset, and its tension there (zero past its anchor).
#[derive(Debug, Clone, Copy)]
pub(crate) struct CableAt<R> {
    pub(crate) offset: Offset<R>,
    pub(crate) tension: R,
}

/// The law and the cables together at given strains: `carried` equals (n_f.a, n_f.b, m_f) in equilibrium.
#[derive(Clone, Copy)]
pub(crate) struct Balance<R> {
    pub(crate) section_stretch: SectionStretch<R>,
    /// C1 (nu - nu_o) A + sum T t_c.a,  C2 (eta - eta_o) A + sum T t_c.b,
    /// C3 (mu - mu_o) A - sum T y beta t_c.a.
    pub(crate) carried: [R; 3],
    /// Derivatives by nu, eta, mu.
    pub(crate) by_strain: [[R; 3]; 3],
    /// Derivatives by beta'.
    pub(crate) by_beta_slope: [R; 3],
    /// The cables' part of `carried`.
    pub(crate) cables: [R; 3],
    /// Smallest tau.a / nu of the cables that pull: zero when one folds its side shut.
    pub(crate) openness: R,
}

/// (11), (12), (14): n.a = C1 (nu - nu_o) A, n.b = C2 (eta - eta_o) A, m = C3 (mu - mu_o) A with
/// A = A0 beta(nu)^2, joined with the cables' local law.
#[inline(always)]
pub(crate) fn balance<R: Real>(
    volume: Volume,
    stiffness: &Stiffness<R>,
    cables: &[CableAt<R>],
    strain: [R; 3],
    beta_slope: R,
) -> Balance<R> {
    let section_stretch = area_law(volume, strain[0]);
    let area = section_stretch.beta * section_stretch.beta;
    let area_nu = R::of(2.0) * section_stretch.beta * section_stretch.slope;
    let zero = R::of(0.0);
    let mut out = Balance {
        section_stretch,
        carried: [zero; 3],
        by_strain: [[zero; 3]; 3],
        by_beta_slope: [zero; 3],
        cables: [zero; 3],
        openness: R::of(1.0),
    };
    for k in 0..3 {
        let strained = strain[k] - stiffness.reference[k];
        out.by_strain[k][k] = stiffness.value[k] * area;
        out.carried[k] = out.by_strain[k][k] * strained;
        out.by_strain[k][0] += stiffness.value[k] * strained * area_nu;
    }
    for cable in cables {
        let (pull, tangent) = pull(cable.tension, &cable.offset, strain, &section_stretch, beta_slope);
        let open = zero.if_less(cable.tension, tangent.along / strain[0], R::of(1.0));
        out.openness = open.min(out.openness);
        for k in 0..3 {
            out.cables[k] += pull.load[k];
            out.by_beta_slope[k] += pull.by_beta_slope[k];
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
        let stiffness = Stiffness { value: [3.0, 1.0, 0.2], reference: [1.02, 0.01, 0.3], reference_slope: 0.05 };
        let cable = |y, tension| CableAt { offset: Offset { y, slope: -0.05 * y }, tension };
        (stiffness, [cable(0.08, 0.4), cable(-0.05, 0.2)])
    }

    #[test]
    fn derivatives_match_differences_for_every_volume_law() {
        let (stiffness, cables) = section();
        for volume in [Volume::Planar, Volume::Circular, Volume::None] {
            let x = [0.9, 0.03, 1.4, 0.2];
            let at = |x: [f64; 4]| balance(volume, &stiffness, &cables, [x[0], x[1], x[2]], x[3]);
            let b = at(x);
            for c in 0..4 {
                let (mut hi, mut lo) = (x, x);
                hi[c] += 1e-6;
                lo[c] -= 1e-6;
                let (hi, lo) = (at(hi).carried, at(lo).carried);
                for k in 0..3 {
                    let exact = if c < 3 { b.by_strain[k][c] } else { b.by_beta_slope[k] };
                    assert!(((hi[k] - lo[k]) / 2e-6 - exact).abs() < 1e-8, "{volume:?} {k} {c}");
                }
            }
        }
    }
}
