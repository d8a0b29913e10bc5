//! Slopes of the state at a station, and their gradients.

use hydrostat_bvp::{Real, each};

use crate::rod::loads::Load;
use crate::rod::section_solve::Solved;
use crate::statics::dimensions::{N, Q};

/// d(nu, eta, mu)/dz: the law depends on z through n_f.a, n_f.b and m_f alone.
#[inline(always)]
pub(crate) fn strain_by_state<R: Real>(
    inverse: &[[R; 3]; 3],
    [cos, sin]: [R; 2],
    [n_a, n_b, _]: [R; 3],
) -> [[R; N]; 3] {
    each(|k| {
        let [by_n_a, by_n_b, by_m] = inverse[k];
        [by_n_a * n_b - by_n_b * n_a, by_n_a * cos - by_n_b * sin, by_n_a * sin + by_n_b * cos, by_m]
    })
}

/// Change of z' with the strains, at fixed z and beta'.
#[inline(always)]
pub(crate) fn by_strain_change<R: Real>(load: &Load<R>, contact: [R; 3], strain: [R; 3]) -> [R; N] {
    let by = |k: usize| {
        -(load.by_strain[k][0] * strain[0] + load.by_strain[k][1] * strain[1] + load.by_strain[k][2] * strain[2])
    };
    [strain[2], by(0), by(1), contact[0] * strain[1] - contact[1] * strain[0]]
}

#[inline(always)]
pub(crate) fn jacobian<R: Real>(
    [cos, sin]: [R; 2],
    [n_a, n_b, _]: [R; 3],
    solved: &Solved<R>,
    load: &Load<R>,
    by_state: &[[R; N]; 3],
) -> [[R; N]; N] {
    let zero = R::of(0.0);
    let [nu, eta, _] = solved.strain;
    let mut out = [[zero; N]; N];
    out[0] = by_state[2];
    for b in 0..N {
        for k in 0..2 {
            out[k + 1][b] = -(load.by_strain[k][0] * by_state[0][b]
                + load.by_strain[k][1] * by_state[1][b]
                + load.by_strain[k][2] * by_state[2][b]);
        }
        out[3][b] = n_a * by_state[1][b] - n_b * by_state[0][b];
    }
    for k in 0..2 {
        out[k + 1][0] -= load.by_theta[k];
    }
    // n_a, n_b by theta: n_b, -n_a; by n_f: the directors.
    out[3][0] += eta * n_b + nu * n_a;
    out[3][1] += eta * cos + nu * sin;
    out[3][2] += eta * sin - nu * cos;
    out
}

#[inline(always)]
pub(crate) fn rate_gradient<R: Real>([cos, sin]: [R; 2], rate: [R; 2], by_state: &[[R; N]; 3]) -> [[R; N]; Q] {
    let mut out = [[R::of(0.0); N]; Q];
    for b in 0..N {
        out[0][b] = cos * by_state[0][b] - sin * by_state[1][b];
        out[1][b] = sin * by_state[0][b] + cos * by_state[1][b];
    }
    out[0][0] -= rate[1];
    out[1][0] += rate[0];
    out
}

/// n_f along a and b, and m_f.
#[inline(always)]
pub(crate) fn in_directors<R: Real>([cos, sin]: [R; 2], z: &[R; N]) -> [R; 3] {
    [cos * z[1] + sin * z[2], cos * z[2] - sin * z[1], z[3]]
}
