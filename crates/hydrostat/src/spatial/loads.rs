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
use crate::rod::model_options::{Displaced, Hydrostatics, Volume, WettedLength};

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
    let r = &arm.model;
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
    /// By the stream: `by_stream[k][c]` is the change of component k with that of component c, in space.
    pub(crate) by_stream: [Vector<R>; 3],
    /// U_t and U_p (in space) over the stream's speed.
    pub(crate) along: R,
    pub(crate) across: Vector<R>,
}

/// Less than any speed across the arm that matters.
const STILL: f64 = 1e-300;

/// The stream of an arm at rest: the same everywhere, `None` in still water.
#[inline(always)]
pub(crate) fn uniform<R: Real>(water: &Water) -> Option<Vector<R>> {
    (water.stream != [0.0; 3]).then(|| water.stream.map(R::of))
}

/// The load of everything but cables, tip and support at a station. `stream` is the velocity of the water against the
/// section in space (m/s), U - r. where the arm moves; `None` where none acts.
#[inline(always)]
pub(crate) fn load<R: Real>(
    water: &Water,
    body: &Body<R>,
    stream: Option<Vector<R>>,
    directors: &Directors<R>,
    strain: &[R; STRAINS],
    section_stretch: &SectionStretch<R>,
) -> Load<R> {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let along = Tangent::of(strain);
    let Tangent { t, stretch, .. } = along;
    // All in the directors, turned into space at the end.
    let mut own = Turned::default();
    let mut out = Load {
        force: body.force,
        by_turn: [[zero; 3]; 3],
        by_stretch: [[zero; 3]; 3],
        by_stream: [[zero; 3]; 3],
        along: zero,
        across: [zero; 3],
    };
    if let Some(stream) = stream {
        let stream = directors.to_body(&stream);
        let u_t = dot(&stream, &t);
        let across: Vector<R> = each(|k| stream[k] - u_t * t[k]);
        let u_p = dot(&across, &across).sqrt();
        let over = one / u_p.max(R::of(STILL));
        let w = times(over, &across);
        let pressed = traction(water.law, u_t, u_p, one);
        let (mut s, mut s_by) = (body.wetted * section_stretch.beta, [body.wetted * section_stretch.slope, zero, zero]);
        if water.wetted == WettedLength::Deformed {
            s_by = each(|k| s_by[k] * stretch + s * t[k]);
            s = s * stretch;
        }
        let per_s: Vector<R> = each(|k| pressed.tangential * t[k] + pressed.normal * w[k]);
        // Turning t towards w turns w towards -t; turning it sideways turns w by -U_t/|U_p| of that.
        let sideways = pressed.tangential - pressed.normal * over * u_t;
        let towards: Vector<R> = each(|k| {
            (pressed.tangential_turn - pressed.normal) * t[k]
                + (pressed.tangential + pressed.normal_turn - sideways) * w[k]
        });
        // More stream along t, along w, and sideways, which turns w.
        let [t_by_t, t_by_p] = pressed.tangential_by;
        let [n_by_t, n_by_p] = pressed.normal_by;
        let beside = pressed.normal * over;
        let mut by_stream = [[zero; 3]; 3];
        for k in 0..3 {
            own.force[k] = s * per_s[k];
            for c in 0..3 {
                own.by_tangent[k][c] = s * towards[k] * w[c];
                own.by_size[k][c] = s_by[c] * per_s[k];
                let of_t = t[k] * (t_by_t * t[c] + t_by_p * w[c]);
                let of_w = w[k] * (n_by_t * t[c] + (n_by_p - beside) * w[c]);
                by_stream[k][c] = s * (of_t + of_w - beside * t[k] * t[c]);
            }
            own.by_tangent[k][k] += s * sideways;
            by_stream[k][k] += s * beside;
        }
        out.by_stream = directors.matrix_to_space(&by_stream);
        let speed = R::of(1.0 / dot(&water.stream, &water.stream).sqrt());
        out.along = u_t * speed;
        out.across = times(speed, &directors.to_space(&across));
    }
    let [d, d_nu] = displacement(water.displaced, water.volume, strain[0], section_stretch);
    let h: Vector<R> = each(|k| body.weight[k] - body.displaced[k] * d);
    let h_nu: Vector<R> = each(|k| -(body.displaced[k] * d_nu));
    match water.hydrostatics {
        Hydrostatics::Archimedes => {
            for k in 0..3 {
                out.force[k] += h[k];
                out.by_stretch[0][k] += h_nu[k];
            }
        }
        Hydrostatics::NormalOnly => own.add_across(&along, &directors.to_body(&h), &directors.to_body(&h_nu), one),
    }
    let (by_turn, by_stretch) = own.gradients(directors, &along);
    let force = directors.to_space(&own.force);
    for k in 0..3 {
        out.force[k] += force[k];
        for j in 0..3 {
            out.by_turn[k][j] += by_turn[k][j];
            out.by_stretch[k][j] += by_stretch[k][j];
        }
    }
    out
}

/// The direction of the centreline in the directors.
#[derive(Clone, Copy)]
pub(crate) struct Tangent<R> {
    pub(crate) t: Vector<R>,
    /// |r'| and its inverse.
    stretch: R,
    inverse: R,
}

impl<R: Real> Tangent<R> {
    #[inline(always)]
    pub(crate) fn of(strain: &[R; STRAINS]) -> Self {
        let v = [strain[0], strain[1], strain[2]];
        let stretch = dot(&v, &v).sqrt();
        let inverse = R::of(1.0) / stretch;
        Self { t: times(inverse, &v), stretch, inverse }
    }
}

/// A force in the directors that is fixed in space but for the centreline's direction t, and the strains.
#[derive(Clone, Copy, Default)]
pub(crate) struct Turned<R> {
    pub(crate) force: Vector<R>,
    /// Row by row, for changes of t normal to it, in space.
    by_tangent: [Vector<R>; 3],
    /// By nu, eta, zeta at fixed t.
    by_size: [Vector<R>; 3],
}

impl<R: Real> Turned<R> {
    /// Adds the part across the centreline of `factor` times a vector that is `h` in the directors, and changes by
    /// `h_nu` with nu, the factor in it.
    #[inline(always)]
    pub(crate) fn add_across(&mut self, along: &Tangent<R>, h: &Vector<R>, h_nu: &Vector<R>, factor: R) {
        let t = &along.t;
        let (h_t, h_nu_t) = (dot(h, t), dot(h_nu, t));
        for k in 0..3 {
            self.force[k] += factor * (h[k] - h_t * t[k]);
            self.by_size[k][0] += h_nu[k] - h_nu_t * t[k];
            for c in 0..3 {
                self.by_tangent[k][c] -= factor * t[k] * h[c];
            }
            self.by_tangent[k][k] -= factor * h_t;
        }
    }

    /// Derivatives in space: by a turn about each director, and by nu, eta, zeta.
    #[inline(always)]
    pub(crate) fn gradients(&self, directors: &Directors<R>, along: &Tangent<R>) -> ([Vector<R>; 3], [Vector<R>; 3]) {
        let (zero, one) = (R::of(0.0), R::of(1.0));
        let t = &along.t;
        let apply = |d: &Vector<R>| each(|k| dot(&self.by_tangent[k], d));
        let by_turn = each(|k| {
            let own: Vector<R> = each(|j| if j == k { one } else { zero });
            directors.to_space(&apply(&cross(&own, t)))
        });
        let by_stretch = each(|k| {
            let across: Vector<R> = each(|j| (if j == k { one } else { zero } - t[k] * t[j]) * along.inverse);
            let moved = apply(&across);
            directors.to_space(&each(|j| moved[j] + self.by_size[j][k]))
        });
        (by_turn, by_stretch)
    }
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
                load(&water, &body(), Some(water.stream), &Directors::of(q), strain, &area_law(water.volume, strain[0]))
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
                let [with, against] = [STEP, -STEP].map(|h| {
                    let mut stream = water.stream;
                    stream[k] += h;
                    let own = area_law(water.volume, strain[0]);
                    load(&water, &body(), Some(stream), &Directors::of(&q), &strain, &own).force
                });
                for j in 0..3 {
                    let by = (with[j] - against[j]) / (2.0 * STEP);
                    assert!((by - here.by_stream[j][k]).abs() < 1e-8, "{water:?} stream {k} {j}");
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
            let here = load(&water, &body, uniform(&water), &Directors::of(&q), &strain, &own);
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
