//! All distributed loads at a station: stream (7)-(10), weight and buoyancy, and what the user adds.

use crate::rod::area_law::{SectionStretch, displacement};
use crate::rod::flow::{Law, traction};
use crate::rod::model_options::{Displaced, FlowSurface, Hydrostatics, Volume, WettedLength};
use hydrostat_bvp::{Real, each};

/// What the loads need to know of the arm as a whole.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Water {
    /// U, m/s.
    pub(crate) stream: [f64; 2],
    pub(crate) law: Law,
    pub(crate) surface: FlowSurface,
    pub(crate) wetted: WettedLength,
    /// The area law, on which the displaced water depends, too.
    pub(crate) volume: Volume,
    pub(crate) displaced: Displaced,
    pub(crate) hydrostatics: Hydrostatics,
    /// Factor on the tangential load, one but for asking what hangs on it.
    pub(crate) tangential_factor: f64,
}

/// What the loads need to know of a station (in the units of [`crate::statics::equations::Units`]).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Body<R> {
    pub(crate) radius: R,
    pub(crate) radius_slope: R,
    /// pi rho_w R: S over beta.
    pub(crate) wetted: R,
    /// Weight of the wall per length, as a vector: rho_arm pi (R^2 - R_in^2) g.
    pub(crate) weight: [R; 2],
    /// Weight of the water that the undeformed section displaces, as a vector.
    pub(crate) displaced: [R; 2],
    /// Dead load along e1, e2.
    pub(crate) force: [R; 2],
    /// Dead couple.
    pub(crate) couple: R,
}

/// A distributed force in space with its derivatives, and where its kinks are.
#[derive(Clone, Copy)]
pub(crate) struct Load<R> {
    pub(crate) force: [R; 2],
    /// By theta.
    pub(crate) by_theta: [R; 2],
    /// By nu, eta, mu.
    pub(crate) by_strain: [[R; 3]; 2],
    /// By beta', which the lateral surface alone depends on.
    pub(crate) by_beta_slope: [R; 2],
    /// By the velocity of the water against the section, per m/s: `by_stream[k][c]` = d f_k / d U_c.
    pub(crate) by_stream: [[R; 2]; 2],
    /// Speeds whose change of sign kinks the load: along and across the surface, and, on the
    /// lateral surface, the tie of both sides, where it jumps. Over the stream's speed.
    pub(crate) switches: [R; 3],
}

/// A direction fixed in the section: tangent (x, y) in the directors and its derivatives by strain.
#[derive(Clone, Copy)]
struct Direction<R> {
    x: R,
    y: R,
    x_strain: [R; 3],
    y_strain: [R; 3],
    y_beta_slope: R,
}

/// Unit vectors u, w = k x u in space and the turn of u by strain.
#[derive(Clone, Copy)]
pub(crate) struct Frame<R> {
    pub(crate) u: [R; 2],
    pub(crate) w: [R; 2],
    pub(crate) turn: [R; 3],
    turn_beta_slope: R,
}

impl<R: Real> Direction<R> {
    #[inline(always)]
    fn frame(&self, cos: R, sin: R) -> Frame<R> {
        let square = self.x * self.x + self.y * self.y;
        let inverse = R::of(1.0) / square.sqrt();
        let u = [(cos * self.x - sin * self.y) * inverse, (sin * self.x + cos * self.y) * inverse];
        let f = inverse * inverse;
        let turn = each(|k| (self.x * self.y_strain[k] - self.y * self.x_strain[k]) * f);
        Frame { u, w: [-u[1], u[0]], turn, turn_beta_slope: self.x * self.y_beta_slope * f }
    }
}

/// The centreline: r' = nu a + eta b.
#[inline(always)]
pub(crate) fn centreline<R: Real>([cos, sin]: [R; 2], [nu, eta]: [R; 2]) -> Frame<R> {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    Direction { x: nu, y: eta, x_strain: [one, zero, zero], y_strain: [zero, one, zero], y_beta_slope: zero }
        .frame(cos, sin)
}

/// The surface of the left side (`sigma` 1) or the right (-1): x_sigma' = (nu - sigma beta R mu) a + (eta + sigma (beta
/// R)') b.
#[inline(always)]
fn lateral<R: Real>(
    sigma: f64,
    [nu, eta, mu]: [R; 3],
    section_stretch: &SectionStretch<R>,
    [radius, radius_slope]: [R; 2],
    beta_slope: R,
) -> Direction<R> {
    let (zero, one, sigma) = (R::of(0.0), R::of(1.0), R::of(sigma));
    let half_width = sigma * section_stretch.beta * radius;
    Direction {
        x: nu - half_width * mu,
        y: eta + sigma * (beta_slope * radius + section_stretch.beta * radius_slope),
        x_strain: [one - sigma * section_stretch.slope * radius * mu, zero, -half_width],
        y_strain: [sigma * radius_slope * section_stretch.slope, one, zero],
        y_beta_slope: sigma * radius,
    }
}

#[inline(always)]
pub(crate) fn dot<R: Real>(a: [R; 2], b: [R; 2]) -> R {
    a[0] * b[0] + a[1] * b[1]
}

/// The stream's tangential part U.u_t (m/s) along the surface that `surface` means, where theta, alpha, the strains,
/// and beta with its slope are these; at the tie of both lateral sides, where it is the same on both, along the left
/// one. `radius` is R (m) with its slope.
pub(crate) fn stream_along(
    stream: [f64; 2],
    surface: FlowSurface,
    [theta, alpha]: [f64; 2],
    strain: [f64; 3],
    [beta, beta_slope]: [f64; 2],
    radius: [f64; 2],
) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let section_stretch = SectionStretch { beta, slope: 0.0 };
    match surface {
        FlowSurface::Centreline => {
            let angle = theta + alpha;
            stream[0] * angle.cos() + stream[1] * angle.sin()
        }
        FlowSurface::Lateral => {
            let side = |sigma| lateral(sigma, strain, &section_stretch, radius, beta_slope).frame(cos, sin);
            let (left, right) = (side(1.0), side(-1.0));
            let windward = if dot(stream, left.w) <= -dot(stream, right.w) { left } else { right };
            dot(stream, windward.u)
        }
    }
}

/// The stream of an arm at rest: the same everywhere, `None` in still water.
#[inline(always)]
pub(crate) fn uniform<R: Real>(water: &Water) -> Option<[R; 2]> {
    (water.stream != [0.0; 2]).then(|| each(|k| R::of(water.stream[k])))
}

/// The load of everything but cables, tip and support at a station. `stream` is the velocity of the water against the
/// section (m/s), U - r. where the arm moves; `None` where none acts.
#[inline(always)]
pub(crate) fn load<R: Real>(
    water: &Water,
    body: &Body<R>,
    stream: Option<[R; 2]>,
    [cos, sin]: [R; 2],
    strain: [R; 3],
    section_stretch: &SectionStretch<R>,
    beta_slope: R,
) -> Load<R> {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let [nu, eta, _] = strain;
    let along = centreline([cos, sin], [nu, eta]);
    let mut out = Load {
        force: body.force,
        by_theta: [zero; 2],
        by_strain: [[zero; 3]; 2],
        by_beta_slope: [zero; 2],
        by_stream: [[zero; 2]; 2],
        switches: [zero; 3],
    };

    let wetted = wetted(water, body, strain, section_stretch);
    match water.surface {
        FlowSurface::Centreline => {
            if let Some(stream) = stream {
                stream_load(water, stream, &along, one, wetted, one, &mut out);
            }
            add_hydrostatics(water, body, nu, section_stretch, &[(one, along)], &mut out);
        }
        FlowSurface::Lateral => {
            let radius = [body.radius, body.radius_slope];
            let side = |sigma| lateral(sigma, strain, section_stretch, radius, beta_slope).frame(cos, sin);
            let (left, right) = (side(1.0), side(-1.0));
            let fraction = left_fraction(stream.unwrap_or([zero; 2]), &left, &right);
            if let Some(stream) = stream {
                lateral_load(water, stream, &left, &right, fraction, wetted, &mut out);
            }
            add_hydrostatics(water, body, nu, section_stretch, &[(fraction, left), (one - fraction, right)], &mut out);
        }
    }
    out
}

/// S = pi rho_w beta R, times |r'| when the deformed length is wet, and how it follows the strains.
#[inline(always)]
fn wetted<R: Real>(water: &Water, body: &Body<R>, strain: [R; 3], section_stretch: &SectionStretch<R>) -> (R, [R; 3]) {
    let zero = R::of(0.0);
    let [nu, eta, _] = strain;
    let (s, s_nu) = (body.wetted * section_stretch.beta, body.wetted * section_stretch.slope);
    match water.wetted {
        WettedLength::Reference => (s, [s_nu, zero, zero]),
        WettedLength::Deformed => {
            let stretch = (nu * nu + eta * eta).sqrt();
            (s * stretch, [s_nu * stretch + s * nu / stretch, s * eta / stretch, zero])
        }
    }
}

/// U . u_n on the left and on the right side, u_n = sigma k x u_t outward: the smaller is windward.
#[inline(always)]
fn hits<R: Real>(stream: [R; 2], left: &Frame<R>, right: &Frame<R>) -> [R; 2] {
    [dot(stream, left.w), -dot(stream, right.w)]
}

/// The left side's fraction of what acts on the windward surface: one or nothing, and half where the sides tie, as
/// they do without a stream.
#[inline(always)]
fn left_fraction<R: Real>(stream: [R; 2], left: &Frame<R>, right: &Frame<R>) -> R {
    let (zero, one, half) = (R::of(0.0), R::of(1.0), R::of(0.5));
    let [hit_left, hit_right] = hits(stream, left, right);
    hit_left.if_less(hit_right, one, hit_right.if_less(hit_left, zero, half))
}

/// Adds the stream's load on the windward one of the two sides, on each half where they tie.
#[inline(always)]
fn lateral_load<R: Real>(
    water: &Water,
    stream: [R; 2],
    left: &Frame<R>,
    right: &Frame<R>,
    left_fraction: R,
    wetted: (R, [R; 3]),
    out: &mut Load<R>,
) {
    let (zero, one) = (R::of(0.0), R::of(1.0));
    let [hit_left, hit_right] = hits(stream, left, right);
    let faces = |hit: R| hit.if_less(zero, one, zero);
    stream_load(water, stream, left, faces(hit_left), wetted, left_fraction, out);
    stream_load(water, stream, right, faces(hit_right), wetted, one - left_fraction, out);
    let speed = R::of(1.0 / water.stream[0].hypot(water.stream[1]));
    let windward = hit_left.min(hit_right);
    out.switches[1] = windward * speed;
    out.switches[2] = (hit_left - hit_right) * speed;
}

/// Adds weight less buoyancy, the hydrostatic part of (9) and (10). `surfaces` are the one or two whose normals direct
/// it where only its normal part acts, with their fractions.
#[inline(always)]
fn add_hydrostatics<R: Real>(
    water: &Water,
    body: &Body<R>,
    nu: R,
    section_stretch: &SectionStretch<R>,
    surfaces: &[(R, Frame<R>)],
    out: &mut Load<R>,
) {
    // Weight less buoyancy: f_h = (rho_arm - rho_w d) pi (R^2 - R_in^2) g (solid or flooded).
    let [d, d_nu] = displacement(water.displaced, water.volume, nu, section_stretch);
    let h: [R; 2] = each(|k| body.weight[k] - body.displaced[k] * d);
    let h_nu: [R; 2] = each(|k| -(body.displaced[k] * d_nu));
    match water.hydrostatics {
        Hydrostatics::Archimedes => {
            for k in 0..2 {
                out.force[k] += h[k];
                out.by_strain[k][0] += h_nu[k];
            }
        }
        Hydrostatics::NormalOnly => {
            for (fraction, surface) in surfaces {
                let Frame { u, w, turn, turn_beta_slope } = surface;
                let (across, down, across_nu) =
                    (dot(h, *w) * *fraction, dot(h, *u) * *fraction, dot(h_nu, *w) * *fraction);
                for k in 0..2 {
                    out.force[k] += across * w[k];
                    let turned = -(down * w[k] + across * u[k]);
                    out.by_theta[k] += turned;
                    out.by_beta_slope[k] += turned * *turn_beta_slope;
                    for c in 0..3 {
                        out.by_strain[k][c] += turned * turn[c];
                    }
                    out.by_strain[k][0] += across_nu * w[k];
                }
            }
        }
    }
}

/// Adds `fraction` of the stream's load on one surface: S (g_t u + g_n w).
#[inline(always)]
fn stream_load<R: Real>(
    water: &Water,
    stream: [R; 2],
    frame: &Frame<R>,
    normal_share: R,
    (s, s_strain): (R, [R; 3]),
    fraction: R,
    out: &mut Load<R>,
) {
    let (u_t, u_n) = (dot(stream, frame.u), dot(stream, frame.w));
    let t = traction(water.law, u_t, u_n, normal_share);
    let factor = R::of(water.tangential_factor);
    let (tangential, tangential_turn) = (factor * t.tangential, factor * t.tangential_turn);
    let s = s * fraction;
    for k in 0..2 {
        let per_s = tangential * frame.u[k] + t.normal * frame.w[k];
        let turned = s * ((tangential_turn - t.normal) * frame.u[k] + (t.normal_turn + tangential) * frame.w[k]);
        out.force[k] += s * per_s;
        out.by_theta[k] += turned;
        out.by_beta_slope[k] += turned * frame.turn_beta_slope;
        for c in 0..3 {
            out.by_strain[k][c] += turned * frame.turn[c] + fraction * s_strain[c] * per_s;
        }
        for c in 0..2 {
            let by_speed = |[by_t, by_n]: [R; 2]| by_t * frame.u[c] + by_n * frame.w[c];
            let (along, across) = (factor * by_speed(t.tangential_by), by_speed(t.normal_by));
            out.by_stream[k][c] += s * (along * frame.u[k] + across * frame.w[k]);
        }
    }
    let speed = R::of(1.0 / water.stream[0].hypot(water.stream[1]));
    out.switches[0] += fraction * u_t * speed;
    out.switches[1] += fraction * u_n * speed;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::area_law::area_law;
    use crate::rod::arm::FlowLaw;
    use crate::rod::model_options::{EnteringSpeed, LayerMean};

    /// Every reading's derivatives against differences, away from kinks.
    #[test]
    fn derivatives_match_differences_in_every_reading() {
        let body = Body {
            radius: 0.05,
            radius_slope: -0.04,
            wetted: 1.3,
            weight: [0.1, -0.5],
            displaced: [0.08, -0.4],
            force: [0.0; 2],
            couple: 0.0,
        };
        for surface in [FlowSurface::Centreline, FlowSurface::Lateral] {
            for entering in [EnteringSpeed::Tangential, EnteringSpeed::Resultant] {
                for wetted in [WettedLength::Reference, WettedLength::Deformed] {
                    for hydrostatics in Hydrostatics::ALL {
                        for (volume, displaced) in Volume::ALL.into_iter().flat_map(|v| Displaced::ALL.map(|d| (v, d)))
                        {
                            let water = Water {
                                stream: [0.6, 0.3],
                                law: Law::new(FlowLaw::Momentum, entering, LayerMean::Speed.factor()),
                                surface,
                                wetted,
                                volume,
                                displaced,
                                hydrostatics,
                                tangential_factor: 1.0,
                            };
                            check(&water, &body);
                        }
                    }
                }
            }
        }
    }

    fn check(water: &Water, body: &Body<f64>) {
        let at = |x: [f64; 7]| {
            let e = [x[1], x[2], x[3]];
            load(water, body, Some([x[5], x[6]]), [x[0].cos(), x[0].sin()], e, &area_law(water.volume, e[0]), x[4])
        };
        for theta in [0.9, 2.2, -1.4] {
            let x = [theta, 0.9, 0.1, 3.0, 0.3, 0.6, 0.3];
            let exact = at(x);
            for c in 0..7 {
                let (mut hi, mut lo) = (x, x);
                hi[c] += 1e-6;
                lo[c] -= 1e-6;
                let (hi, lo) = (at(hi), at(lo));
                for k in 0..2 {
                    let want = (hi.force[k] - lo.force[k]) / 2e-6;
                    let got = match c {
                        0 => exact.by_theta[k],
                        4 => exact.by_beta_slope[k],
                        5 | 6 => exact.by_stream[k][c - 5],
                        _ => exact.by_strain[k][c - 1],
                    };
                    assert!((want - got).abs() < 2e-7, "{water:?} theta {theta} by {c}: {got} {want}");
                }
            }
        }
    }
}
