//! Distributed loads in space: stream, weight and buoyancy, and what the user adds.
//!
//! With the centreline's tangent t = r'/|r'|, U_t = U . t and U_p = U - U_t t, the scalar flow laws of
//! [`crate::flow`] give the load along t and along U_p from the speeds U_t and |U_p|:
//!
//! ```text
//! f = S (|V_t| + 2 |U_p|) V_t t + S |U_p| U_p                  momentum law, S = pi rho_w beta R, V_t = (2/3) U_t
//! f = rho_w C_n beta R |U_p| U_p + rho_w C_t pi beta R |U_t| U_t t        quadratic drag
//! ```

use hydrostat_bvp::{Real, each};

use super::rotation::{Directors, Vector, cross, dot, times};
use super::section::STRAINS;
use crate::rod::area_law::{SectionStretch, displacement};
use crate::rod::arm::Arm;
use crate::rod::flow::{Law, traction};
use crate::rod::readings::{Displaced, Hydrostatics, Volume, WettedLength};

/// What the loads need to know of the arm as a whole.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Water {
    /// U, m/s.
    pub(crate) stream: Vector<f64>,
    pub(crate) law: Law,
    pub(crate) wetted: WettedLength,
    pub(crate) volume: Volume,
    pub(crate) displaced: Displaced,
    pub(crate) hydrostatics: Hydrostatics,
}

/// What the loads need to know of `arm` as a whole.
pub(super) fn water(arm: &Arm) -> Water {
    let r = &arm.readings;
    Water {
        stream: if arm.flow.density == 0.0 { [0.0; 3] } else { arm.stream_in_space() },
        law: Law::new(arm.flow.law, r.entering_speed, r.layer_mean.factor()),
        wetted: r.wetted_length,
        volume: r.volume,
        displaced: r.displaced,
        hydrostatics: r.hydrostatics,
    }
}

/// What the loads need to know of a station, in the solver's units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Body<R> {
    pub(crate) radius: R,
    /// pi rho_w R: S over beta.
    pub(crate) wetted: R,
    /// Weight of the wall per length.
    pub(crate) weight: Vector<R>,
    /// Weight of the water that the undeformed section displaces.
    pub(crate) displaced: Vector<R>,
    /// Dead load.
    pub(crate) force: Vector<R>,
    /// Dead couple.
    pub(crate) couple: Vector<R>,
}

/// A distributed force in space with its derivatives, and what its kinks are seen by.
#[derive(Clone, Copy)]
pub(crate) struct Load<R> {
    pub(crate) force: Vector<R>,
    /// By a turn of the section about its directors: `by_turn[k]` is the change with the turn about director k.
    pub(crate) by_turn: [Vector<R>; 3],
    /// By nu, eta, zeta.
    pub(crate) by_stretch: [Vector<R>; 3],
    /// U_t and U_p (in space) over the stream's speed.
    pub(crate) along: R,
    pub(crate) across: Vector<R>,
}

/// Less than any speed across the arm that matters.
const STILL: f64 = 1e-300;

/// The load of everything but cables, tip and support at a station.
#[inline(always)]
pub(crate) fn load<R: Real>(
    water: &Water,
    body: &Body<R>,
    directors: &Directors<R>,
    strain: &[R; STRAINS],
    swelling: &SectionStretch<R>,
) -> Load<R> {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let v = [strain[0], strain[1], strain[2]];
    let stretch = dot(&v, &v).sqrt();
    let inverse = one / stretch;
    let t = times(inverse, &v);
    // All in the directors, turned into space at the end. `by_tangent` is d f / d t, row by row, for changes normal to
    // t in space.
    let mut force = [zero; 3];
    let mut by_tangent = [[zero; 3]; 3];
    let mut by_size = [[zero; 3]; 3];
    let mut out =
        Load { force: body.force, by_turn: [[zero; 3]; 3], by_stretch: [[zero; 3]; 3], along: zero, across: [zero; 3] };
    if water.stream != [0.0; 3] {
        let stream = directors.to_body(&water.stream.map(R::of));
        let u_t = dot(&stream, &t);
        let across: Vector<R> = each(|k| stream[k] - u_t * t[k]);
        let u_p = dot(&across, &across).sqrt();
        let over = one / u_p.max(R::of(STILL));
        let w = times(over, &across);
        let own = traction(water.law, u_t, u_p, one);
        let (mut s, mut s_by) = (body.wetted * swelling.beta, [body.wetted * swelling.slope, zero, zero]);
        if water.wetted == WettedLength::Deformed {
            s_by = each(|k| s_by[k] * stretch + s * t[k]);
            s = s * stretch;
        }
        let per_s: Vector<R> = each(|k| own.tangential * t[k] + own.normal * w[k]);
        // Turning t towards w turns w towards -t; turning it sideways turns w by -U_t/|U_p| of that.
        let sideways = own.tangential - own.normal * over * u_t;
        let towards: Vector<R> =
            each(|k| (own.tangential_turn - own.normal) * t[k] + (own.tangential + own.normal_turn - sideways) * w[k]);
        for k in 0..3 {
            force[k] = s * per_s[k];
            for c in 0..3 {
                by_tangent[k][c] = s * towards[k] * w[c];
                by_size[k][c] = s_by[c] * per_s[k];
            }
            by_tangent[k][k] += s * sideways;
        }
        let speed = R::of(1.0 / dot(&water.stream, &water.stream).sqrt());
        out.along = u_t * speed;
        out.across = times(speed, &directors.to_space(&across));
    }
    let [d, d_nu] = displacement(water.displaced, water.volume, v[0], swelling);
    let h: Vector<R> = each(|k| body.weight[k] - body.displaced[k] * d);
    let h_nu: Vector<R> = each(|k| -(body.displaced[k] * d_nu));
    match water.hydrostatics {
        Hydrostatics::Archimedes => {
            for k in 0..3 {
                out.force[k] += h[k];
                out.by_stretch[0][k] += h_nu[k];
            }
        }
        Hydrostatics::NormalOnly => {
            let (h, h_nu) = (directors.to_body(&h), directors.to_body(&h_nu));
            let (h_t, h_nu_t) = (dot(&h, &t), dot(&h_nu, &t));
            for k in 0..3 {
                force[k] += h[k] - h_t * t[k];
                by_size[k][0] += h_nu[k] - h_nu_t * t[k];
                for c in 0..3 {
                    by_tangent[k][c] -= t[k] * h[c];
                }
                by_tangent[k][k] -= h_t;
            }
        }
    }
    let apply = |d: &Vector<R>| each(|k| dot(&by_tangent[k], d));
    for k in 0..3 {
        let own: Vector<R> = each(|j| if j == k { one } else { zero });
        let by_turn = directors.to_space(&apply(&cross(&own, &t)));
        let across: Vector<R> = each(|j| (own[j] - t[k] * t[j]) * inverse);
        let moved = apply(&across);
        let by_stretch = directors.to_space(&each(|j| moved[j] + by_size[j][k]));
        for j in 0..3 {
            out.by_turn[k][j] += by_turn[j];
            out.by_stretch[k][j] += by_stretch[j];
        }
    }
    let force = directors.to_space(&force);
    for k in 0..3 {
        out.force[k] += force[k];
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::rotation::turned;
    use super::*;
    use crate::rod::area_law::area_law;

    fn body() -> Body<f64> {
        Body {
            radius: 0.05,
            wetted: 0.7,
            weight: [0.1, -0.4, 0.2],
            displaced: [0.05, -0.2, 0.1],
            force: [0.01, 0.02, 0.03],
            couple: [0.0; 3],
        }
    }

    fn waters() -> Vec<Water> {
        let laws = [
            Law::MomentumTangential { layer: 2.0 / 3.0 },
            Law::MomentumResultant { layer: 0.7 },
            Law::Quadratic { normal: 0.4, tangential: 0.02 },
        ];
        let mut out = Vec::new();
        for law in laws {
            for (wetted, hydrostatics, displaced) in [
                (WettedLength::Reference, Hydrostatics::Archimedes, Displaced::Volume),
                (WettedLength::Deformed, Hydrostatics::NormalOnly, Displaced::Section),
            ] {
                let stream = [0.3, -0.2, 0.4];
                out.push(Water { stream, law, wetted, volume: Volume::Planar, displaced, hydrostatics });
            }
        }
        out
    }

    const STEP: f64 = 1e-6;

    #[test]
    fn derivatives_match_differences_for_every_law_and_reading() {
        let q = Directors::of(&[0.4, -0.3, 0.7, 0.2]).quaternion();
        let strain = [0.9, 0.05, -0.08, 0.2, 0.3, 0.4];
        for water in waters() {
            let at = |q: &[f64; 4], strain: &[f64; 6]| {
                load(&water, &body(), &Directors::of(q), strain, &area_law(water.volume, strain[0]))
            };
            let here = at(&q, &strain);
            for k in 0..3 {
                let [hi, lo] = [STEP, -STEP].map(|h| {
                    let mut phi = [0.0; 3];
                    phi[k] = h;
                    at(&turned(&q, &phi), &strain).force
                });
                let [far, near] = [STEP, -STEP].map(|h| {
                    let mut strain = strain;
                    strain[k] += h;
                    at(&q, &strain).force
                });
                for j in 0..3 {
                    assert!(
                        ((hi[j] - lo[j]) / (2.0 * STEP) - here.by_turn[k][j]).abs() < 1e-8,
                        "{water:?} turn {k} {j}"
                    );
                    let by = (far[j] - near[j]) / (2.0 * STEP);
                    assert!((by - here.by_stretch[k][j]).abs() < 1e-8, "{water:?} stretch {k} {j}");
                }
            }
        }
    }

    /// A section in the plane of the stream has the planar load.
    #[test]
    fn in_the_plane_it_is_the_planar_load() {
        for mut water in waters() {
            water.stream = [0.3, -0.2, 0.0];
            let body =
                Body { weight: [0.1, -0.4, 0.0], displaced: [0.05, -0.2, 0.0], force: [0.01, 0.02, 0.0], ..body() };
            let (theta, strain) = (0.7_f64, [0.9, 0.05, 0.0, 0.0, 0.0, 0.4]);
            let own = area_law(water.volume, strain[0]);
            let q = [(0.5 * theta).cos(), 0.0, 0.0, (0.5 * theta).sin()];
            let here = load(&water, &body, &Directors::of(&q), &strain, &own);
            let planar = crate::rod::loads::Water {
                stream: [0.3, -0.2],
                law: water.law,
                surface: crate::FlowSurface::Centreline,
                wetted: water.wetted,
                volume: water.volume,
                displaced: water.displaced,
                hydrostatics: water.hydrostatics,
                tangential_factor: 1.0,
            };
            let section = crate::rod::loads::Body {
                radius: 0.05,
                radius_slope: 0.0,
                wetted: 0.7,
                weight: [0.1, -0.4],
                displaced: [0.05, -0.2],
                force: [0.01, 0.02],
                couple: 0.0,
            };
            let strains = [strain[0], strain[1], strain[5]];
            let stream = crate::rod::loads::uniform(&planar);
            let there =
                crate::rod::loads::load(&planar, &section, stream, [theta.cos(), theta.sin()], strains, &own, 0.0);
            for k in 0..2 {
                assert!((here.force[k] - there.force[k]).abs() < 1e-14);
                assert!((here.by_turn[2][k] - there.by_theta[k]).abs() < 1e-14);
                for c in 0..2 {
                    assert!((here.by_stretch[c][k] - there.by_strain[k][c]).abs() < 1e-14);
                }
            }
            assert!(here.force[2].abs() < 1e-15 && here.across[2].abs() < 1e-15);
        }
    }
}
