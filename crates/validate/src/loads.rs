//! The loads of the model written out a second time, station by station, by (7)-(14) of the source and `docs/model.md`: nothing here is
//! shared with the solver, so that agreement means something.

use std::f64::consts::PI;

use hydrostat::{
    Arm, Cavity, Displaced, EnteringSpeed, FlowLaw, FlowSurface, Hydrostatics, Material, Station, Volume, WettedLength,
};

/// Along e1 and e2.
pub(crate) type Pair = [f64; 2];

pub(crate) fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(crate) fn cross(a: Pair, b: Pair) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}

/// The load of the stream per undeformed length, (7)-(10) with the water resisting.
pub(crate) fn stream_load(arm: &Arm, st: &Station) -> Pair {
    let (a, b) = axes(st);
    let stream = stream(arm);
    let radius = arm.radius.at(st.s, arm.length);
    let speed = st.nu.hypot(st.eta);
    let wet = if arm.model.wetted_length == WettedLength::Deformed { speed } else { 1.0 };
    // Load on a surface with the tangent x a + y b; `faces` of its normal speed counts.
    let on = |x: f64, y: f64, faces: &dyn Fn(f64) -> f64| {
        let size = x.hypot(y);
        let u = [(x * a[0] + y * b[0]) / size, (x * a[1] + y * b[1]) / size];
        let w = [-u[1], u[0]];
        let (u_t, u_n) = (dot(stream, u), faces(dot(stream, w)));
        let (along, across) = match arm.flow.law {
            FlowLaw::Momentum => {
                let v = arm.model.layer_mean.factor() * u_t;
                let along = match arm.model.entering_speed {
                    EnteringSpeed::Tangential => (v.abs() + 2.0 * u_n.abs()) * v,
                    EnteringSpeed::Resultant => (v.abs() + u_n.abs()).powi(2) * sign(v),
                };
                let s = PI * arm.flow.density * st.beta * radius.value;
                (s * along, s * u_n.abs() * u_n)
            }
            FlowLaw::QuadraticDrag { cn, ct } => {
                let half = 0.5 * arm.flow.density;
                let (width, round) = (2.0 * st.beta * radius.value, 2.0 * PI * st.beta * radius.value);
                (half * ct * round * u_t.abs() * u_t, half * cn * width * u_n.abs() * u_n)
            }
        };
        [wet * (along * u[0] + across * w[0]), wet * (along * u[1] + across * w[1])]
    };
    if arm.model.flow_surface == FlowSurface::Centreline {
        return on(st.nu, st.eta, &|v| v);
    }
    let sigma = if outward(arm, st, 1.0) < outward(arm, st, -1.0) { 1.0 } else { -1.0 };
    let (x, y) = lateral(arm, st, sigma);
    on(x, y, &|v| if sigma * v < 0.0 { v } else { 0.0 })
}

fn axes(st: &Station) -> (Pair, Pair) {
    ([st.theta.cos(), st.theta.sin()], [-st.theta.sin(), st.theta.cos()])
}

fn stream(arm: &Arm) -> Pair {
    [arm.flow.speed * arm.flow.direction.cos(), arm.flow.speed * arm.flow.direction.sin()]
}

/// The tangent of a lateral surface, along a and b.
fn lateral(arm: &Arm, st: &Station, sigma: f64) -> (f64, f64) {
    let radius = arm.radius.at(st.s, arm.length);
    let widening = st.beta_slope * radius.value + st.beta * radius.slope;
    (st.nu - sigma * st.beta * radius.value * st.mu, st.eta + sigma * widening)
}

/// The stream's speed out of a lateral surface.
fn outward(arm: &Arm, st: &Station, sigma: f64) -> f64 {
    let (a, b) = axes(st);
    let (x, y) = lateral(arm, st, sigma);
    let u = [x * a[0] + y * b[0], x * a[1] + y * b[1]];
    sigma * dot(stream(arm), [-u[1], u[0]]) / x.hypot(y)
}

/// Where one of these changes sign the load of the stream kinks or jumps: the stream's speed along the surface and
/// into it, and on lateral surfaces which side is windward.
pub(crate) fn switches(arm: &Arm, st: &Station) -> [f64; 3] {
    let (a, b) = axes(st);
    let stream = stream(arm);
    let on = |(x, y): (f64, f64)| {
        let size = x.hypot(y);
        let u = [(x * a[0] + y * b[0]) / size, (x * a[1] + y * b[1]) / size];
        [dot(stream, u), dot(stream, [-u[1], u[0]])]
    };
    if arm.model.flow_surface == FlowSurface::Centreline {
        let [along, across] = on((st.nu, st.eta));
        return [along, across, 1.0];
    }
    let sides = [1.0, -1.0].map(|sigma| outward(arm, st, sigma));
    let sigma = if sides[0] < sides[1] { 1.0 } else { -1.0 };
    let [along, across] = on(lateral(arm, st, sigma));
    [along, across, sides[0] - sides[1]]
}

/// Weight less buoyancy per undeformed length.
pub(crate) fn weight(arm: &Arm, st: &Station) -> Pair {
    let Some(gravity) = arm.gravity else { return [0.0; 2] };
    let g = [gravity.acceleration * gravity.direction.cos(), gravity.acceleration * gravity.direction.sin()];
    let (outer, inner) = (arm.radius.at(st.s, arm.length).value, arm.inner_radius.at(st.s, arm.length).value);
    let wall = outer * outer - inner * inner;
    let outline = if arm.cavity == Cavity::Sealed { outer * outer } else { wall };
    let displaced = match (arm.model.displaced, arm.model.volume) {
        (Displaced::Volume, Volume::None) => st.nu,
        (Displaced::Volume, _) => 1.0,
        (Displaced::Section, _) => st.nu * st.beta * st.beta,
    };
    let mass = PI * (arm.density * wall - arm.flow.density * outline * displaced);
    let whole = [mass * g[0], mass * g[1]];
    if arm.model.hydrostatics == Hydrostatics::Archimedes {
        return whole;
    }
    // Its part along the normal of the surface with the tangent x a + y b.
    let (a, b) = axes(st);
    let along_normal = |(x, y): (f64, f64)| {
        let w = [-(x * a[1] + y * b[1]) / x.hypot(y), (x * a[0] + y * b[0]) / x.hypot(y)];
        [dot(whole, w) * w[0], dot(whole, w) * w[1]]
    };
    if arm.model.flow_surface == FlowSurface::Centreline {
        return along_normal((st.nu, st.eta));
    }
    let [left, right] = [1.0, -1.0].map(|sigma| along_normal(lateral(arm, st, sigma)));
    let [hit_left, hit_right] = [1.0, -1.0].map(|sigma| outward(arm, st, sigma));
    let fraction = if hit_left < hit_right { 1.0 } else { f64::from(u8::from(hit_left == hit_right)) * 0.5 };
    [0, 1].map(|k| fraction * left[k] + (1.0 - fraction) * right[k])
}

/// Force and moment about the origin, N/m and N m/m, of everything spread along the arm.
pub(crate) fn spread(arm: &Arm, st: &Station) -> [f64; 3] {
    let (stream, weight) = (stream_load(arm, st), weight(arm, st));
    let dead = [0, 1].map(|k| arm.distributed.force[k].at(st.s, arm.length).value);
    let force = [0, 1].map(|k| stream[k] + weight[k] + dead[k]);
    let couple = arm.distributed.couple.at(st.s, arm.length).value;
    [force[0], force[1], cross([st.x, st.y], force) + couple]
}

fn coefficients(arm: &Arm, s: f64) -> [f64; 3] {
    match &arm.material {
        Material::Homogeneous { young, poisson, shear_factor } => {
            let (outer, inner) = (arm.radius.at(s, arm.length).value, arm.inner_radius.at(s, arm.length).value);
            let c2 = shear_factor * young / (2.0 * (1.0 + poisson));
            [*young, c2, young * (outer * outer + inner * inner) / 4.0]
        }
        Material::Coefficients { c1, c2, c3 } => [c1, c2, c3].map(|c| c.at(s, arm.length).value),
    }
}

/// What the section at `st` does, worked out from its strains.
pub(crate) struct Sectional {
    /// n_f along e1, e2 (N) and m_f (N m): n + sum T t_c, m - sum T y beta (t_c . a).
    pub(crate) carried: [f64; 3],
    /// How far n . a, n . b, m and beta are from what the station says, each over its size.
    pub(crate) law: f64,
}

/// The section law, the volume law and the cables, (5), (6), (11)-(16).
pub(crate) fn sectional(arm: &Arm, st: &Station) -> Sectional {
    let [c1, c2, c3] = coefficients(arm, st.s);
    let (outer, inner) = (arm.radius.at(st.s, arm.length).value, arm.inner_radius.at(st.s, arm.length).value);
    let beta = match arm.model.volume {
        Volume::Planar => 1.0 / st.nu,
        Volume::Circular => st.nu.powf(-0.5),
        Volume::None => 1.0,
    };
    let area = PI * beta * beta * (outer * outer - inner * inner);
    let reference = [&arm.reference.nu, &arm.reference.eta, &arm.reference.mu].map(|p| p.at(st.s, arm.length).value);
    let mut local =
        [c1 * (st.nu - reference[0]) * area, c2 * (st.eta - reference[1]) * area, c3 * (st.mu - reference[2]) * area];
    // Sizes below a thousandth of the stiffness are rounding of the strains.
    let sizes = [c1, c2, c3 / arm.length].map(|c| 1e-3 * c * area);
    let said = [st.n_a, st.n_b, st.m];
    let law = (0..3)
        .map(|k| (local[k] - said[k]).abs() / (said[k].abs() + sizes[k]))
        .fold((beta / st.beta - 1.0).abs(), f64::max);
    for cable in arm.cables.iter().filter(|c| st.s < c.end * arm.length) {
        let y = cable.offset.at(st.s, arm.length);
        let tau = [st.nu - y.value * st.beta * st.mu, st.eta + y.slope * st.beta + y.value * st.beta_slope];
        let size = tau[0].hypot(tau[1]);
        local[0] += cable.tension * tau[0] / size;
        local[1] += cable.tension * tau[1] / size;
        local[2] -= cable.tension * y.value * st.beta * tau[0] / size;
    }
    let (cos, sin) = (st.theta.cos(), st.theta.sin());
    Sectional { carried: [local[0] * cos - local[1] * sin, local[0] * sin + local[1] * cos, local[2]], law }
}
