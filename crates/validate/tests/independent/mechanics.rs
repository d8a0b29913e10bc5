//! The equations of `docs/model.md`, sections 2 to 7 and 9, at one place of an arm: section law with cables, loads, ends.
//!
//! Written from that page alone. Nothing is called of the solver: of `hydrostat` only the fields of an [`Arm`] are read.

use std::f64::consts::PI;

use hydrostat::{
    Arm, Cavity, Displaced, EnteringSpeed, FlowLaw, FlowSurface, Hydrostatics, LayerMean, Material, Motion, Volume,
    WettedLength,
};

use crate::curve::Curve;

pub(crate) type Pair = [f64; 2];

/// theta, and n_f along e1 and e2 and m_f: what is integrated along the arm.
pub(crate) type State = [f64; 4];

/// nu, eta, mu.
pub(crate) type Strains = [f64; 3];

fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn left_of(u: Pair) -> Pair {
    [-u[1], u[0]]
}

fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}

/// a and b of a section.
pub(crate) fn directors(theta: f64) -> [Pair; 2] {
    let (sin, cos) = theta.sin_cos();
    [[cos, sin], [-sin, cos]]
}

/// r' in space: (2).
pub(crate) fn advance(theta: f64, e: Strains) -> Pair {
    let [a, b] = directors(theta);
    [e[0] * a[0] + e[1] * b[0], e[0] * a[1] + e[1] * b[1]]
}

/// An arm with its profiles read out.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub(crate) arm: Arm,
    radius: Curve,
    inner: Curve,
    stiffness: Option<[Curve; 3]>,
    reference: [Curve; 3],
    offsets: Vec<Curve>,
    force: [Curve; 2],
    couple: Curve,
    stream: Pair,
    gravity: Pair,
}

/// A cable at a place: which, its offset in the straight arm and the slope of that.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CableHere {
    pub(crate) index: usize,
    pub(crate) offset: f64,
    pub(crate) offset_slope: f64,
}

/// What is given of the arm at a place.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    pub(crate) s: f64,
    pub(crate) radius: f64,
    pub(crate) radius_slope: f64,
    /// C1 A0, C2 A0, C3 A0.
    pub(crate) stiffness: [f64; 3],
    pub(crate) reference: Strains,
    pub(crate) reference_slope: f64,
    /// Those that have not ended.
    pub(crate) cables: Vec<CableHere>,
    /// Weight of the wall, and of the water that the straight arm displaces, per length.
    weight: Pair,
    buoyancy: Pair,
    force: Pair,
    couple: f64,
}

/// Why a section has no strains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NoStrains {
    pub(crate) s: f64,
}

/// d beta and beta as functions of nu: section 4.
pub(crate) fn beta(volume: Volume, nu: f64) -> [f64; 2] {
    match volume {
        Volume::Planar => [1.0 / nu, -1.0 / (nu * nu)],
        Volume::Circular => [nu.powf(-0.5), -0.5 * nu.powf(-1.5)],
        Volume::None => [1.0, 0.0],
    }
}

impl Model {
    pub(crate) fn new(arm: &Arm) -> Self {
        let curve = |profile| Curve::new(profile, arm.length);
        let stiffness = match &arm.material {
            Material::Homogeneous { .. } => None,
            Material::Coefficients { c1, c2, c3 } => Some([curve(c1), curve(c2), curve(c3)]),
        };
        let along = |size: f64, direction: f64| [size * direction.cos(), size * direction.sin()];
        Self {
            radius: curve(&arm.radius),
            inner: curve(&arm.inner_radius),
            stiffness,
            reference: [curve(&arm.reference.nu), curve(&arm.reference.eta), curve(&arm.reference.mu)],
            offsets: arm.cables.iter().map(|cable| curve(&cable.offset)).collect(),
            force: [curve(&arm.distributed.force[0]), curve(&arm.distributed.force[1])],
            couple: curve(&arm.distributed.couple),
            stream: along(arm.flow.speed, arm.flow.direction),
            gravity: arm.gravity.map_or([0.0; 2], |g| along(g.acceleration, g.direction)),
            arm: arm.clone(),
        }
    }

    /// Where something changes its law, both ends of the arm included.
    pub(crate) fn breaks(&self) -> Vec<f64> {
        let length = self.arm.length;
        let curves = [&self.radius, &self.inner, &self.couple].into_iter();
        let curves = curves.chain(self.stiffness.iter().flatten()).chain(&self.reference).chain(&self.offsets);
        let mut at: Vec<f64> = curves.chain(&self.force).flat_map(|curve| curve.knots().to_vec()).collect();
        at.extend(self.arm.cables.iter().map(|cable| cable.end * length));
        at.retain(|s| *s > 1e-9 * length && *s < (1.0 - 1e-9) * length);
        at.extend([0.0, length]);
        at.sort_by(f64::total_cmp);
        at.dedup_by(|b, a| *b - *a <= 1e-9 * length);
        at
    }

    /// What is given at `s`, as seen from `inside` beside it, which says on which side of a cable's end it is.
    pub(crate) fn place(&self, s: f64, inside: f64) -> Place {
        let arm = &self.arm;
        let [radius, radius_slope] = self.radius.at(s);
        let inner = self.inner.at(s)[0];
        let wall = PI * (radius * radius - inner * inner);
        let c = match &arm.material {
            Material::Homogeneous { young, poisson, shear_factor } => [
                *young,
                shear_factor * young / (2.0 * (1.0 + poisson)),
                young * (radius * radius + inner * inner) / 4.0,
            ],
            Material::Coefficients { .. } => {
                let curves = self.stiffness.as_ref().expect("coefficients have curves");
                [curves[0].at(s)[0], curves[1].at(s)[0], curves[2].at(s)[0]]
            }
        };
        let outline = if arm.cavity == Cavity::Sealed { PI * radius * radius } else { wall };
        let cables = arm.cables.iter().zip(&self.offsets).enumerate();
        let cables = cables.filter(|(_, (cable, _))| inside < cable.end * arm.length).map(|(index, (_, offset))| {
            let [offset, offset_slope] = offset.at(s);
            CableHere { index, offset, offset_slope }
        });
        Place {
            s,
            radius,
            radius_slope,
            stiffness: c.map(|c| c * wall),
            reference: [0, 1, 2].map(|k| self.reference[k].at(s)[0]),
            reference_slope: self.reference[0].at(s)[1],
            cables: cables.collect(),
            weight: self.gravity.map(|g| arm.density * wall * g),
            buoyancy: self.gravity.map(|g| arm.flow.density * outline * g),
            force: [0, 1].map(|k| self.force[k].at(s)[0]),
            couple: self.couple.at(s)[0],
        }
    }

    /// Slope of a cable's path by s, along a and b: (5).
    pub(crate) fn tau(&self, cable: &CableHere, e: Strains, beta_slope: f64) -> Pair {
        let beta = beta(self.arm.model.volume, e[0])[0];
        [e[0] - cable.offset * beta * e[2], e[1] + cable.offset_slope * beta + cable.offset * beta_slope]
    }

    /// What strains carry with the tensions of the cables here: n_f . a, n_f . b, m_f; and its derivatives by the strains.
    pub(crate) fn carried(
        &self,
        place: &Place,
        tensions: &[f64],
        e: Strains,
        beta_slope: f64,
    ) -> ([f64; 3], [[f64; 3]; 3]) {
        let [beta, beta_nu] = beta(self.arm.model.volume, e[0]);
        let area = beta * beta;
        let (mut out, mut by) = ([0.0; 3], [[0.0; 3]; 3]);
        for k in 0..3 {
            let strained = place.stiffness[k] * (e[k] - place.reference[k]);
            out[k] = strained * area;
            by[k][k] = place.stiffness[k] * area;
            by[k][0] += strained * 2.0 * beta * beta_nu;
        }
        for cable in &place.cables {
            let tension = tensions[cable.index];
            if tension == 0.0 {
                continue;
            }
            let y = cable.offset;
            let [x, z] = self.tau(cable, e, beta_slope);
            let size = x.hypot(z);
            let (p, q) = (tension * x / size, tension * z / size);
            let by_x = [1.0 - y * beta_nu * e[2], 0.0, -y * beta];
            let by_z = [cable.offset_slope * beta_nu, 1.0, 0.0];
            out[0] += p;
            out[1] += q;
            out[2] -= y * beta * p;
            for k in 0..3 {
                let turn = tension * (x * by_z[k] - z * by_x[k]) / (size * size * size);
                by[0][k] -= turn * z;
                by[1][k] += turn * x;
                by[2][k] += y * beta * turn * z;
            }
            by[2][0] -= y * beta_nu * p;
        }
        (out, by)
    }

    /// n . a, n . b and m by the section law alone: (11), (12), (14).
    pub(crate) fn stress(&self, place: &Place, e: Strains) -> [f64; 3] {
        let area = beta(self.arm.model.volume, e[0])[0].powi(2);
        [0, 1, 2].map(|k| place.stiffness[k] * (e[k] - place.reference[k]) * area)
    }

    /// n_f and m_f of strains: what the section carries, cables included, as forces in space.
    pub(crate) fn state(&self, place: &Place, tensions: &[f64], theta: f64, e: Strains, beta_slope: f64) -> State {
        let ([n_a, n_b, m], _) = self.carried(place, tensions, e, beta_slope);
        let [a, b] = directors(theta);
        [theta, n_a * a[0] + n_b * b[0], n_a * a[1] + n_b * b[1], m]
    }

    /// Strains that carry a state, from a guess by Newton's method.
    pub(crate) fn strains(
        &self,
        place: &Place,
        tensions: &[f64],
        z: State,
        beta_slope: f64,
        guess: Strains,
    ) -> Result<Strains, NoStrains> {
        let [a, b] = directors(z[0]);
        let want = [dot([z[1], z[2]], a), dot([z[1], z[2]], b), z[3]];
        let mut e = guess;
        let mut before = f64::INFINITY;
        for _ in 0..60 {
            let (got, by) = self.carried(place, tensions, e, beta_slope);
            let step = solve3(by, [want[0] - got[0], want[1] - got[1], want[2] - got[2]]);
            if !step.iter().all(|v| v.is_finite()) {
                return Err(NoStrains { s: place.s });
            }
            // A stretch stays positive, and no step is longer than the section is thin.
            let most = (0.5 * e[0]).min(0.3);
            let long = (step[0].abs() / most).max(step[1].abs() / 0.3).max(step[2].abs() * place.radius / 0.5);
            let fraction = if long > 1.0 { 1.0 / long } else { 1.0 };
            for k in 0..3 {
                e[k] += fraction * step[k];
            }
            let size = step[0].abs().max(step[1].abs()).max(step[2].abs() * place.radius);
            let scale = 1.0 + e[0].abs() + (e[2] * place.radius).abs();
            if size < 1e-15 * scale || (size < 1e-11 * scale && size >= 0.5 * before) {
                return Ok(e);
            }
            before = size;
        }
        Err(NoStrains { s: place.s })
    }

    /// Force in space and couple per reference length: sections 5 and 6, and what the user adds.
    pub(crate) fn load(&self, place: &Place, theta: f64, e: Strains, beta_slope: f64) -> [f64; 3] {
        let stream = self.stream_load(place, theta, e, beta_slope);
        let weight = self.hydrostatics(place, theta, e, beta_slope);
        let force = [0, 1].map(|k| stream[k] + weight[k] + place.force[k]);
        [force[0], force[1], place.couple]
    }

    /// Tangent of the lateral surface of side `sigma`, in space.
    fn lateral(&self, place: &Place, theta: f64, e: Strains, beta_slope: f64, sigma: f64) -> Pair {
        let beta = beta(self.arm.model.volume, e[0])[0];
        let along = e[0] - sigma * beta * place.radius * e[2];
        let across = e[1] + sigma * (beta_slope * place.radius + beta * place.radius_slope);
        unit(theta, along, across)
    }

    /// Tangents that the stream's load acts by, each with its side (0: both) and its fraction.
    fn surfaces(&self, place: &Place, theta: f64, e: Strains, beta_slope: f64) -> Vec<(Pair, f64, f64)> {
        if self.arm.model.flow_surface == FlowSurface::Centreline {
            return vec![(unit(theta, e[0], e[1]), 0.0, 1.0)];
        }
        let sides = [1.0, -1.0].map(|sigma| (self.lateral(place, theta, e, beta_slope, sigma), sigma));
        let [left, right] = sides.map(|(u, sigma)| sigma * dot(self.stream, left_of(u)));
        let fraction = if left < right {
            1.0
        } else if right < left {
            0.0
        } else {
            0.5
        };
        vec![(sides[0].0, 1.0, fraction), (sides[1].0, -1.0, 1.0 - fraction)]
    }

    fn stream_load(&self, place: &Place, theta: f64, e: Strains, beta_slope: f64) -> Pair {
        let (flow, readings) = (&self.arm.flow, &self.arm.model);
        if flow.speed == 0.0 {
            return [0.0; 2];
        }
        let width = beta(readings.volume, e[0])[0] * place.radius;
        let wet = if readings.wetted_length == WettedLength::Deformed { e[0].hypot(e[1]) } else { 1.0 };
        let mut out = [0.0; 2];
        for (u, sigma, fraction) in self.surfaces(place, theta, e, beta_slope) {
            let w = left_of(u);
            let (along, across) = (dot(self.stream, u), dot(self.stream, w));
            // What comes against the side that carries the load.
            let across = if sigma == 0.0 { across } else { sigma * (sigma * across).min(0.0) };
            let (f_t, f_n) = match flow.law {
                FlowLaw::Momentum => {
                    let mean = match readings.layer_mean {
                        LayerMean::Speed => 2.0 / 3.0,
                        LayerMean::Momentum => (8.0_f64 / 15.0).sqrt(),
                    };
                    let v = mean * along;
                    let f_t = match readings.entering_speed {
                        EnteringSpeed::Tangential => (v.abs() + 2.0 * across.abs()) * v,
                        EnteringSpeed::Resultant => (v.abs() + across.abs()).powi(2) * sign(v),
                    };
                    let s = PI * flow.density * width;
                    (s * f_t, s * across.abs() * across)
                }
                FlowLaw::QuadraticDrag { cn, ct } => {
                    let half = 0.5 * flow.density;
                    (
                        half * ct * 2.0 * PI * width * along.abs() * along,
                        half * cn * 2.0 * width * across.abs() * across,
                    )
                }
            };
            for k in 0..2 {
                out[k] += fraction * wet * (f_t * u[k] + f_n * w[k]);
            }
        }
        out
    }

    fn hydrostatics(&self, place: &Place, theta: f64, e: Strains, beta_slope: f64) -> Pair {
        let fraction = displaced(&self.arm, e[0]);
        let whole = [0, 1].map(|k| place.weight[k] - fraction * place.buoyancy[k]);
        if self.arm.model.hydrostatics == Hydrostatics::Archimedes {
            return whole;
        }
        // Along the normals of the surface that the stream acts on.
        let mut out = [0.0; 2];
        for (u, _, fraction) in self.surfaces(place, theta, e, beta_slope) {
            let w = left_of(u);
            let across = fraction * dot(whole, w);
            out = [out[0] + across * w[0], out[1] + across * w[1]];
        }
        out
    }

    /// Where one of these changes its sign, the load of the stream has a kink or a jump: speeds over the stream's.
    pub(crate) fn switches(&self, place: &Place, theta: f64, e: Strains, beta_slope: f64) -> Vec<f64> {
        let speed = self.arm.flow.speed;
        if speed == 0.0 || self.arm.flow.density == 0.0 {
            return Vec::new();
        }
        if self.arm.model.flow_surface == FlowSurface::Centreline {
            let u = unit(theta, e[0], e[1]);
            return vec![dot(self.stream, u) / speed, dot(self.stream, left_of(u)) / speed];
        }
        let hits = [1.0, -1.0]
            .map(|sigma| sigma * dot(self.stream, left_of(self.lateral(place, theta, e, beta_slope, sigma))) / speed);
        let windward = if hits[0] < hits[1] { 1.0 } else { -1.0 };
        let along = dot(self.stream, self.lateral(place, theta, e, beta_slope, windward)) / speed;
        vec![along, hits[0].min(hits[1]), hits[0] - hits[1]]
    }

    /// Slopes along s of a state: section 7.
    pub(crate) fn slopes(&self, place: &Place, z: State, e: Strains, beta_slope: f64) -> State {
        let [f1, f2, couple] = self.load(place, z[0], e, beta_slope);
        let along = advance(z[0], e);
        [e[2], -f1, -f2, -(along[0] * z[2] - along[1] * z[1]) - couple]
    }

    /// n_f and m_f that the tip's loads ask for.
    pub(crate) fn tip_load(&self, theta: f64) -> [f64; 3] {
        let (tip, [a, b]) = (&self.arm.tip, directors(theta));
        let force = [0, 1].map(|k| tip.force[k] + tip.follower[0] * a[k] + tip.follower[1] * b[k]);
        [force[0], force[1], tip.moment]
    }

    /// n_f(0) and m_f(0) of `support = "unstrained-base"`.
    pub(crate) fn unstrained_base(&self, tensions: &[f64]) -> State {
        let place = self.place(0.0, 0.0);
        // nu = beta = 1, eta = mu = 0, beta' = 0.
        self.state(&place, tensions, self.arm.base.angle, [1.0, 0.0, 0.0], 0.0)
    }

    /// The factor on the turn in the exponent of the capstan law.
    pub(crate) fn grip(&self, cable: usize) -> f64 {
        let cable = &self.arm.cables[cable];
        match cable.motion {
            Motion::In => -cable.friction,
            Motion::Out => cable.friction,
        }
    }
}

/// Volume of the water displaced over that of the straight arm.
pub(crate) fn displaced(arm: &Arm, nu: f64) -> f64 {
    match (arm.model.displaced, arm.model.volume) {
        (Displaced::Section, volume) => nu * beta(volume, nu)[0].powi(2),
        (Displaced::Volume, Volume::None) => nu,
        (Displaced::Volume, _) => 1.0,
    }
}

fn unit(theta: f64, along: f64, across: f64) -> Pair {
    let ([a, b], size) = (directors(theta), along.hypot(across));
    [0, 1].map(|k| (along * a[k] + across * b[k]) / size)
}

/// Three equations, by Cramer's rule.
pub(crate) fn solve3(m: [[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
    // Rows of very different units: each over its largest entry.
    let (mut m, mut right) = (m, right);
    for k in 0..3 {
        let largest = m[k].iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        m[k] = m[k].map(|v| v / largest);
        right[k] /= largest;
    }
    let column = |k: usize| [m[0][k], m[1][k], m[2][k]];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let product = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [u, v, w] = [column(0), column(1), column(2)];
    let determinant = product(u, cross(v, w));
    [
        product(right, cross(v, w)) / determinant,
        product(right, cross(w, u)) / determinant,
        product(right, cross(u, v)) / determinant,
    ]
}

/// Derivatives of what strains carry against differences, with every kind of cable.
#[test]
fn derivatives_of_the_section_law_match_differences() {
    use hydrostat::{Cable, Profile};
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        let mut arm = Arm::cone(0.2, 0.01, 0.004, 1e5, 0.4);
        arm.model.volume = volume;
        arm.cables.push(Cable::new("one", Profile::linear(0.006, 0.001)).pulled(0.7));
        arm.cables.push(Cable::new("two", -0.002).pulled(0.2));
        let model = Model::new(&arm);
        let (place, e) = (model.place(0.07, 0.07), [0.9, 0.05, 13.0]);
        let (_, by) = model.carried(&place, &[0.7, 0.2], e, 0.4);
        for k in 0..3 {
            let step = [1e-6, 1e-6, 1e-4][k];
            let (mut high, mut low) = (e, e);
            high[k] += step;
            low[k] -= step;
            let difference = |i: usize| {
                let at = |e| model.carried(&place, &[0.7, 0.2], e, 0.4).0[i];
                (at(high) - at(low)) / (2.0 * step)
            };
            for i in 0..3 {
                assert!((difference(i) - by[i][k]).abs() < 1e-8 * place.stiffness[i].max(by[i][k].abs()), "{i} by {k}");
            }
        }
    }
}
