//! A cable at a section: its tangent, and the force and moment it puts on the body. (5), (6).

use crate::rod::area_law::SectionStretch;
use hydrostat_bvp::{Real, each};

/// Offset of a cable at a place: y and y'.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Offset<R> {
    pub(crate) y: R,
    pub(crate) slope: R,
}

/// Unit tangent t_c of a cable in the directors, and the derivatives of its components.
#[derive(Clone, Copy)]
pub(crate) struct Tangent<R> {
    /// t_c . a
    pub(crate) a: R,
    /// t_c . b
    pub(crate) b: R,
    /// |tau|: cable length per reference length.
    pub(crate) stretch: R,
    /// tau . a = nu - y beta mu; at zero the cable folds its side shut.
    pub(crate) along: R,
    /// Derivatives of (a, b) by tau . a
    by_along: (R, R),
    /// and by tau . b.
    by_across: (R, R),
}

/// tau = (nu - y beta mu) a + (eta + (y beta)') b with (y beta)' = y' beta + y beta', from
/// r_c = r + y beta b (source: above (5)); t_c = tau / |tau|.
#[inline(always)]
pub(crate) fn tangent<R: Real>(
    offset: &Offset<R>,
    [nu, eta, mu]: [R; 3],
    section_stretch: &SectionStretch<R>,
    beta_slope: R,
) -> Tangent<R> {
    let along = nu - offset.y * section_stretch.beta * mu;
    let across = eta + offset.slope * section_stretch.beta + offset.y * beta_slope;
    let inverse = R::of(1.0) / (along * along + across * across).sqrt();
    let (a, b) = (along * inverse, across * inverse);
    let mixed = -(a * b * inverse);
    Tangent {
        a,
        b,
        stretch: (along * along + across * across) * inverse,
        along,
        by_along: (b * b * inverse, mixed),
        by_across: (mixed, a * a * inverse),
    }
}

/// What one cable adds to the section's balance (see [`crate::rod::section`]), with its derivatives.
#[derive(Clone, Copy)]
pub(crate) struct Pull<R> {
    /// T (t_c . a, t_c . b, -y beta t_c . a).
    pub(crate) load: [R; 3],
    /// By nu, eta, mu (columns).
    pub(crate) by_strain: [[R; 3]; 3],
    /// By beta'.
    pub(crate) by_beta_slope: [R; 3],
}

/// Integrated from s to the tip, (5) and (6) leave the local law
/// n = n_f - sum T t_c, m = m_f + sum T y beta (t_c . a).
#[inline(always)]
pub(crate) fn pull<R: Real>(
    tension: R,
    offset: &Offset<R>,
    strain: [R; 3],
    section_stretch: &SectionStretch<R>,
    beta_slope: R,
) -> (Pull<R>, Tangent<R>) {
    let t = tangent(offset, strain, section_stretch, beta_slope);
    let [_, _, mu] = strain;
    let arm = offset.y * section_stretch.beta;

    // d(tau . a), d(tau . b) by nu, by mu; eta enters tau . b alone.
    let along_nu = R::of(1.0) - offset.y * mu * section_stretch.slope;
    let across_nu = offset.slope * section_stretch.slope;
    let a_nu = t.by_along.0 * along_nu + t.by_across.0 * across_nu;
    let b_nu = t.by_along.1 * along_nu + t.by_across.1 * across_nu;
    let (a_eta, b_eta) = t.by_across;
    let (a_mu, b_mu) = (-(arm * t.by_along.0), -(arm * t.by_along.1));

    let lever = tension * arm;
    let by_strain = [
        [tension * a_nu, tension * a_eta, tension * a_mu],
        [tension * b_nu, tension * b_eta, tension * b_mu],
        [-(lever * a_nu + tension * offset.y * section_stretch.slope * t.a), -(lever * a_eta), -(lever * a_mu)],
    ];
    // beta' enters tau . b as eta does, times y.
    let by_beta_slope = each(|k| offset.y * by_strain[k][1]);
    (Pull { load: [tension * t.a, tension * t.b, -(lever * t.a)], by_strain, by_beta_slope }, t)
}
