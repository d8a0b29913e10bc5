//! Balance of the whole arm and of every part of it, with loads written out here again and
//! integrated by an adaptive quadrature of its own over the dense solution.

use hydrostat::{
    Arm, Cable, Cavity, Configuration, EnteringSpeed, FlowLaw, FlowSurface, Gravity, Hydrostatics, Material, Options,
    Profile, Readings, Solver, Station, Volume, WettedLength,
};
use std::f64::consts::PI;

type Pair = [f64; 2];

fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Pair, b: Pair) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn sign(v: f64) -> f64 {
    if v == 0.0 { 0.0 } else { v.signum() }
}

/// The load of the stream per undeformed length, (7)-(10) with the water resisting.
fn stream_load(arm: &Arm, st: &Station) -> Pair {
    let (a, b) = ([st.theta.cos(), st.theta.sin()], [-st.theta.sin(), st.theta.cos()]);
    let stream = [arm.flow.speed * arm.flow.direction.cos(), arm.flow.speed * arm.flow.direction.sin()];
    let radius = arm.radius.at(st.s, arm.length);
    let speed = st.nu.hypot(st.eta);
    let wet = if arm.readings.wetted_length == WettedLength::Deformed { speed } else { 1.0 };
    // Load on a surface with the tangent x a + y b; `faces` of its normal speed counts.
    let on = |x: f64, y: f64, faces: &dyn Fn(f64) -> f64| {
        let size = x.hypot(y);
        let u = [(x * a[0] + y * b[0]) / size, (x * a[1] + y * b[1]) / size];
        let w = [-u[1], u[0]];
        let (u_t, u_n) = (dot(stream, u), faces(dot(stream, w)));
        let (along, across) = match arm.flow.law {
            FlowLaw::Momentum => {
                let v = arm.readings.layer_mean.factor() * u_t;
                let along = match arm.readings.entering_speed {
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
    if arm.readings.flow_surface == FlowSurface::Centreline {
        return on(st.nu, st.eta, &|v| v);
    }
    let tangent = |sigma: f64| {
        let widening = st.beta_slope * radius.value + st.beta * radius.slope;
        (st.nu - sigma * st.beta * radius.value * st.mu, st.eta + sigma * widening)
    };
    let outward = |sigma: f64| {
        let (x, y) = tangent(sigma);
        let u = [x * a[0] + y * b[0], x * a[1] + y * b[1]];
        sigma * dot(stream, [-u[1], u[0]]) / x.hypot(y)
    };
    let sigma = if outward(1.0) < outward(-1.0) { 1.0 } else { -1.0 };
    let (x, y) = tangent(sigma);
    on(x, y, &|v| if sigma * v < 0.0 { v } else { 0.0 })
}

/// Weight less buoyancy per undeformed length.
fn weight(arm: &Arm, st: &Station) -> Pair {
    let Some(gravity) = arm.gravity else { return [0.0; 2] };
    let g = [gravity.acceleration * gravity.direction.cos(), gravity.acceleration * gravity.direction.sin()];
    let (outer, inner) = (arm.radius.at(st.s, arm.length).value, arm.inner_radius.at(st.s, arm.length).value);
    let wall = outer * outer - inner * inner;
    let outline = if arm.cavity == Cavity::Sealed { outer * outer } else { wall };
    let mass = PI * (arm.density * wall - arm.flow.density * outline * st.nu * st.beta * st.beta);
    let whole = [mass * g[0], mass * g[1]];
    if arm.readings.hydrostatics == Hydrostatics::Archimedes {
        return whole;
    }
    let direction = st.theta + st.eta.atan2(st.nu);
    let w = [-direction.sin(), direction.cos()];
    [dot(whole, w) * w[0], dot(whole, w) * w[1]]
}

/// Force and moment about the origin, N/m and N m/m, of everything spread along the arm.
fn spread(arm: &Arm, st: &Station) -> [f64; 3] {
    let (stream, weight) = (stream_load(arm, st), weight(arm, st));
    let dead = [0, 1].map(|k| arm.distributed.force[k].at(st.s, arm.length).value);
    let force = [0, 1].map(|k| stream[k] + weight[k] + dead[k]);
    let couple = arm.distributed.couple.at(st.s, arm.length).value;
    [force[0], force[1], cross([st.x, st.y], force) + couple]
}

/// Places in [0, 1] on either side of the middle, with the weights of Kronrod-15 and of Gauss-7.
const KRONROD: [[f64; 3]; 8] = [
    [0.0, 0.209_482_141_084_727_83, 0.417_959_183_673_469_4],
    [0.207_784_955_007_898_47, 0.204_432_940_075_298_9, 0.0],
    [0.405_845_151_377_397_2, 0.190_350_578_064_785_4, 0.381_830_050_505_118_9],
    [0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0],
    [0.741_531_185_599_394_4, 0.140_653_259_715_525_92, 0.279_705_391_489_276_64],
    [0.864_864_423_359_769_1, 0.104_790_010_322_250_18, 0.0],
    [0.949_107_912_342_758_5, 0.063_092_092_629_978_55, 0.129_484_966_168_869_7],
    [0.991_455_371_120_812_6, 0.022_935_322_010_529_224, 0.0],
];

/// Bisects until Gauss and Kronrod agree to what is `allowed`.
fn integral(f: &dyn Fn(f64) -> [f64; 3], from: f64, to: f64, allowed: [f64; 3], depth: u32) -> [f64; 3] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let (mut fine, mut rough) = ([0.0; 3], [0.0; 3]);
    for (i, [x, kronrod, gauss]) in KRONROD.into_iter().enumerate() {
        for side in [-1.0, 1.0] {
            if i > 0 || side > 0.0 {
                let v = f(middle + side * x * half);
                for k in 0..3 {
                    fine[k] += half * kronrod * v[k];
                    rough[k] += half * gauss * v[k];
                }
            }
        }
    }
    if depth == 0 || (0..3).all(|k| (fine[k] - rough[k]).abs() <= allowed[k]) {
        return fine;
    }
    let [left, right] = [(from, middle), (middle, to)].map(|(a, b)| integral(f, a, b, allowed, depth - 1));
    [0, 1, 2].map(|k| left[k] + right[k])
}

/// What the spread loads and the tip add up to beyond `from`: force and moment about the origin.
fn beyond(solved: &Configuration, from: f64, scale: Pair) -> [f64; 3] {
    let arm = &solved.arm;
    let tip = solved.tip();
    let (a, b) = ([tip.theta.cos(), tip.theta.sin()], [-tip.theta.sin(), tip.theta.cos()]);
    let force = [0, 1].map(|k| arm.tip.force[k] + arm.tip.follower[0] * a[k] + arm.tip.follower[1] * b[k]);
    let mut total = [force[0], force[1], arm.tip.moment + cross([tip.x, tip.y], force)];
    let allowed = [1e-9 * scale[0], 1e-9 * scale[0], 1e-9 * scale[1]];
    let mut places = vec![from];
    places.extend(arm.breaks().into_iter().filter(|s| *s > from));
    places.push(arm.length);
    for piece in places.windows(2) {
        // No point lies on the ends, where `at` gives the tip's side of a step.
        let part = integral(&|s| spread(arm, &solved.at(s)), piece[0], piece[1], allowed, 14);
        for k in 0..3 {
            total[k] += part[k];
        }
    }
    total
}

/// Sizes of the largest force and moment in play.
fn sizes(solved: &Configuration) -> Pair {
    let arm = &solved.arm;
    let reach = (0..=64)
        .map(|k| {
            let st = solved.at(arm.length * f64::from(k) / 64.0);
            arm.length * stream_load(arm, &st)[0].hypot(stream_load(arm, &st)[1]).max(weight(arm, &st)[1].abs())
        })
        .fold(0.0, f64::max);
    let tensions: f64 = arm.cables.iter().map(|c| c.tension).sum();
    let tip = arm.tip.force[0].hypot(arm.tip.force[1]).max(arm.tip.follower[0].hypot(arm.tip.follower[1]));
    let force = reach.max(tip).max(solved.base_reaction.force[0].hypot(solved.base_reaction.force[1]));
    let moment = (force * arm.length).max(arm.tip.moment.abs()).max(solved.base_reaction.moment.abs());
    [force.max(1e-3 * tensions), moment.max(1e-3 * tensions * arm.radius.at(0.0, arm.length).value)]
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

/// Contact force and moment that strains at `st` carry, and what the cables add there:
/// n_f, m_f = n + sum T t_c, m - sum T y beta (t_c . a).
fn carried(arm: &Arm, st: &Station) -> [f64; 3] {
    let [c1, c2, c3] = coefficients(arm, st.s);
    let (outer, inner) = (arm.radius.at(st.s, arm.length).value, arm.inner_radius.at(st.s, arm.length).value);
    let area = PI * st.beta * st.beta * (outer * outer - inner * inner);
    let reference = [&arm.reference.nu, &arm.reference.eta, &arm.reference.mu].map(|p| p.at(st.s, arm.length).value);
    let mut local =
        [c1 * (st.nu - reference[0]) * area, c2 * (st.eta - reference[1]) * area, c3 * (st.mu - reference[2]) * area];
    assert!((local[0] - st.n_a).abs() <= 1e-7 * (st.n_a.abs() + c1 * area * 1e-3));
    assert!((local[1] - st.n_b).abs() <= 1e-7 * (st.n_b.abs() + c2 * area * 1e-3));
    assert!((local[2] - st.m).abs() <= 1e-7 * (st.m.abs() + c3 * area * 1e-3 / arm.length));
    for cable in arm.cables.iter().filter(|c| st.s < c.end * arm.length) {
        let y = cable.offset.at(st.s, arm.length);
        let tau = [st.nu - y.value * st.beta * st.mu, st.eta + y.slope * st.beta + y.value * st.beta_slope];
        let size = tau[0].hypot(tau[1]);
        local[0] += cable.tension * tau[0] / size;
        local[1] += cable.tension * tau[1] / size;
        local[2] -= cable.tension * y.value * st.beta * tau[0] / size;
    }
    let (cos, sin) = (st.theta.cos(), st.theta.sin());
    [local[0] * cos - local[1] * sin, local[0] * sin + local[1] * cos, local[2]]
}

fn check(arm: &Arm) {
    let mut solver = Solver::new(arm, Options { tol: 1e-8 }).unwrap();
    let solved = solver.solve().unwrap_or_else(|e| panic!("{}: {e}", arm.name));
    let scale = sizes(&solved);
    let base = solved.at(0.0);
    let origin = [base.x, base.y];
    let total = beyond(&solved, 0.0, scale);
    let reaction = &solved.base_reaction;
    let off = [
        (total[0] + reaction.force[0]) / scale[0],
        (total[1] + reaction.force[1]) / scale[0],
        (total[2] - cross(origin, [total[0], total[1]]) + reaction.moment) / scale[1],
    ];
    eprintln!("{:32} whole arm off by {:.1e} {:.1e} {:.1e}", arm.name, off[0], off[1], off[2]);
    assert!(off.iter().all(|v| v.abs() < 1e-6), "{}: the whole arm is off by {off:?}", arm.name);
    let mut worst = 0.0_f64;
    for k in 0..12 {
        let s = arm.length * (f64::from(k) + 0.37) / 12.0;
        let st = solved.at(s);
        let want = beyond(&solved, s, scale);
        let got = carried(arm, &st);
        let about = want[2] - cross([st.x, st.y], [want[0], want[1]]);
        let off = [(got[0] - want[0]) / scale[0], (got[1] - want[1]) / scale[0], (got[2] - about) / scale[1]];
        worst = off.iter().fold(worst, |w, v| w.max(v.abs()));
        assert!(off.iter().all(|v| v.abs() < 1e-6), "{}: the part beyond {s} is off by {off:?}", arm.name);
    }
    eprintln!("{:32} parts off by {worst:.1e}", arm.name);
}

fn silicone(name: &str) -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    name.clone_into(&mut arm.name);
    arm.density = 1080.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1));
    arm
}

#[test]
fn cables_alone() {
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        let mut arm = silicone("cables alone");
        arm.readings.volume = volume;
        check(&arm);
    }
}

#[test]
fn streams_from_all_sides() {
    for direction in [0.0, 0.7, 1.5, -1.2] {
        let mut arm = silicone("stream");
        arm.flow.speed = 0.12;
        arm.flow.direction = direction;
        check(&arm);
    }
}

/// The tip curls past the stream: the normal speed changes sign on the way.
#[test]
fn a_curled_arm_with_kinked_loads() {
    for (tension, direction) in [(0.9, 0.2), (0.9, 0.5), (0.8, 0.35)] {
        let mut arm = silicone("kinks");
        arm.cables[0].tension = tension;
        arm.cables[1].tension = 0.0;
        arm.flow.speed = 0.03;
        arm.flow.direction = direction;
        let tip = arm.solve().unwrap().tip();
        assert!(direction > 0.0 && tip.theta + tip.alpha > direction, "{tip:?} does not pass the stream");
        check(&arm);
    }
}

#[test]
fn weight_and_buoyancy() {
    for (density, direction) in [(1080.0, -1.57), (1300.0, -0.4), (900.0, 0.9)] {
        let mut arm = silicone("weight");
        arm.density = density;
        arm.gravity = Some(Gravity { acceleration: 9.81, direction });
        check(&arm);
    }
}

#[test]
fn hollow_arms_flooded_and_sealed() {
    for cavity in [Cavity::Flooded, Cavity::Sealed] {
        let mut arm = silicone("hollow");
        arm.inner_radius = Profile::linear(0.006, 0.001);
        arm.cavity = cavity;
        arm.gravity = Some(Gravity::default());
        arm.flow.speed = 0.05;
        arm.flow.direction = 0.5;
        arm.base.x = 0.3;
        arm.base.y = -0.2;
        arm.base.angle = 0.8;
        check(&arm);
    }
}

#[test]
fn quadratic_drag() {
    let mut arm = silicone("quadratic drag");
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.005 };
    arm.flow.speed = 0.15;
    arm.flow.direction = 1.3;
    check(&arm);
}

#[test]
fn loads_on_the_tip_and_along_the_arm() {
    let mut arm = silicone("tip and distributed loads");
    arm.tip.force = [0.01, -0.004];
    arm.tip.moment = 2e-5;
    arm.tip.follower = [-0.003, 0.002];
    arm.distributed.force = [Profile::linear(0.01, -0.02), Profile::linear(0.0, 0.05)];
    arm.distributed.couple = 1e-4.into();
    arm.base.angle = -0.3;
    // At 0.731 of the full tensions this arm snaps.
    arm.cables[0].tension = 0.3;
    check(&arm);
}

#[test]
fn tables_shorter_cables_and_unloaded_strains() {
    let mut arm = silicone("tables and short cables");
    arm.radius = Profile::table(&[[0.0, 0.012], [0.06, 0.010], [0.15, 0.006], [0.245, 0.003]]).unwrap();
    arm.cables[0].offset = 0.0025.into();
    arm.cables[1].offset = (-0.004).into();
    arm.cables[1].end = 0.45;
    arm.cables[1].tension = 0.4;
    arm.reference.mu = Profile::linear(2.0, -1.0);
    arm.reference.nu = Profile::linear(1.0, 1.02);
    arm.flow.speed = 0.05;
    arm.flow.direction = 0.8;
    check(&arm);
}

#[test]
fn other_readings() {
    let mut arm = silicone("deformed length, mean square");
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.1;
    arm.gravity = Some(Gravity::default());
    arm.readings.wetted_length = WettedLength::Deformed;
    arm.readings.layer_mean = hydrostat::LayerMean::Momentum;
    check(&arm);
    arm.cables[0].tension = 0.2;
    for (name, readings) in [
        ("normal-only", Readings { hydrostatics: Hydrostatics::NormalOnly, ..Readings::default() }),
        ("resultant", Readings { entering_speed: EnteringSpeed::Resultant, ..Readings::default() }),
        ("lateral", Readings { flow_surface: FlowSurface::Lateral, ..Readings::default() }),
        ("literal", Readings::LITERAL),
    ] {
        name.clone_into(&mut arm.name);
        arm.readings = readings;
        check(&arm);
    }
}
