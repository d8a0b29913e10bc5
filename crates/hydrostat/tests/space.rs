//! Arms in space: closed forms, published shapes, the plane, and invariances.

use std::f64::consts::{PI, TAU};

use hydrostat::{
    Arm, BaseDirections, Cable, FlowLaw, Gravity, Material, Options, Profile, Readings, Space, SpatialConfiguration,
    SpatialSolver, Volume,
};

fn solved(arm: &Arm, tol: f64) -> SpatialConfiguration {
    SpatialSolver::new(arm, Options::with_tol(tol)).unwrap().solve().unwrap_or_else(|error| panic!("{error}"))
}

fn tip(shape: &SpatialConfiguration) -> [f64; 3] {
    let tip = shape.tip();
    [tip.x, tip.y, tip.z]
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

fn in_space(arm: &Arm) -> Arm {
    Arm { space: Some(Space::default()), ..arm.clone() }
}

/// A rotation matrix from three angles.
fn rotation(a: f64, b: f64, c: f64) -> [[f64; 3]; 3] {
    let about = |axis: usize, angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut m = [[0.0; 3]; 3];
        m[axis][axis] = 1.0;
        (m[i][i], m[j][j], m[i][j], m[j][i]) = (cos, cos, -sin, sin);
        m
    };
    times(&times(&about(2, a), &about(1, b)), &about(0, c))
}

fn times(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn turned(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| m[i][k] * v[k]).sum())
}

/// An arm in the plane with base, loads, stream and gravity turned into another plane.
fn turned_arm(arm: &Arm, m: &[[f64; 3]; 3]) -> Arm {
    let mut out = arm.clone();
    let (sin, cos) = arm.base.angle.sin_cos();
    let in_plane = |angle: f64| [angle.cos(), angle.sin(), 0.0];
    let force = turned(m, [arm.tip.force[0], arm.tip.force[1], 0.0]);
    let moment = turned(m, [0.0, 0.0, arm.tip.moment]);
    out.tip.force = [force[0], force[1]];
    out.tip.moment = moment[2];
    let base = turned(m, [arm.base.x, arm.base.y, 0.0]);
    (out.base.x, out.base.y) = (base[0], base[1]);
    out.space = Some(Space {
        z: base[2],
        base: Some(BaseDirections {
            direction: turned(m, [cos, sin, 0.0]),
            section: Some(turned(m, [-sin, cos, 0.0])),
        }),
        stream: Some(turned(m, in_plane(arm.flow.direction))),
        gravity: arm.gravity.map(|g| turned(m, in_plane(g.direction))),
        tip_force: force[2],
        tip_moment: [moment[0], moment[1]],
        ..Space::default()
    });
    out
}

fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.flow.density = 1022.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm
}

/// Without pins, elements: a rod of one section with given coefficients, no area change.
fn rod(length: f64, [ea, ga, ei, gj]: [f64; 4]) -> Arm {
    let mut arm = Arm::cone(length, 0.1 * length, 0.1 * length, 1.0, 0.0);
    let area = PI * 0.01 * length * length;
    arm.material = Material::Coefficients { c1: (ea / area).into(), c2: (ga / area).into(), c3: (ei / area).into() };
    arm.readings = Readings { volume: Volume::None, ..Readings::default() };
    arm.space = Some(Space { c4: Some((gj / area).into()), ..Space::default() });
    arm
}

#[test]
fn natural_curvature_and_twist_make_a_helix() {
    let (kappa, tau) = (3.0, 2.0);
    let mut arm = rod(1.0, [1.0, 1.0, 1.0, 1.0]);
    let space = arm.space.as_mut().unwrap();
    (space.kappa, space.tau) = (kappa.into(), tau.into());
    let shape = solved(&arm, 1e-10);
    let rate = f64::hypot(kappa, tau);
    let (radius, pitch) = (kappa / (rate * rate), TAU * tau / (rate * rate));
    // About an axis along tau a + kappa b of the base: e1 = a, e2 = b.
    let axis = [tau / rate, kappa / rate, 0.0];
    // The base lies at the radius from the axis, on the side of -k x (a bends towards u x a = -kappa c).
    let centre = [0.0, 0.0, -radius];
    for k in 0..=20 {
        let s = f64::from(k) / 20.0;
        let st = shape.at(s);
        let d = [st.x - centre[0], st.y - centre[1], st.z - centre[2]];
        let along: f64 = (0..3).map(|k| d[k] * axis[k]).sum();
        let off = (0..3).map(|k| (d[k] - along * axis[k]).powi(2)).sum::<f64>().sqrt();
        assert!((off - radius).abs() < 1e-9, "{s}: {off} {radius}");
        assert!((along - pitch * s * rate / TAU).abs() < 1e-9, "{s}: {along}");
    }
}

/// Bathe and Bolourchi's 45-degree bend, 600 out of its plane. Published tips, from several element formulations, lie about
/// (47.2, 15.7, 53.4).
#[test]
fn forty_five_degree_bend() {
    for (load, j, expected) in [
        (600.0, 1.0 / 6.0, [47.150_438_6, 15.684_800_5, 53.474_858_8]),
        (600.0, 0.140_577, [46.891_924_8, 15.557_785_8, 53.607_369_3]),
        (300.0, 1.0 / 6.0, [58.779_122_5, 22.244_780_9, 40.191_891_7]),
    ] {
        let (e, radius) = (1e7, 100.0);
        let length = radius * PI / 4.0;
        let mut arm = rod(length, [e, 0.5 * e, e / 12.0, 0.5 * e * j]);
        arm.reference.mu = (1.0 / radius).into();
        let space = arm.space.as_mut().unwrap();
        space.tip_force = load;
        let found = tip(&solved(&arm, 1e-10));
        // It begins along e1 here, along y there, and bends towards +y here, towards +x there.
        let found = [found[0], found[1], found[2]];
        let error = apart(found, [expected[0], expected[1], expected[2]]);
        assert!(error < 2e-6, "{found:?} {expected:?}");
    }
}

/// Whatever lies in a plane has the planar solution, in any plane.
#[test]
fn arms_in_a_plane_have_the_planar_solution() {
    let mut plain = silicone();
    plain.cables[0].tension = 0.3;
    let mut stream = plain.clone();
    stream.flow.speed = 0.1;
    stream.flow.direction = 1.2;
    let mut drag = stream.clone();
    drag.flow.law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.005 };
    let mut circular = stream.clone();
    circular.readings.volume = Volume::Circular;
    circular.gravity = Some(Gravity::default());
    let mut loaded = drag.clone();
    loaded.tip.force = [0.001, -0.002];
    loaded.tip.follower = [0.0, 0.001];
    loaded.tip.moment = 1e-5;
    loaded.base.angle = 0.4;
    loaded.cables[1] = Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1).ending_at(0.6);
    for (name, arm) in
        [("plain", plain), ("stream", stream), ("drag", drag), ("circular", circular), ("loaded", loaded)]
    {
        let flat = arm.solve().unwrap();
        let there = [flat.tip().x, flat.tip().y, 0.0];
        let here = solved(&in_space(&arm), 1e-8);
        let bound = flat.error_estimate + here.error_estimate;
        assert!(apart(tip(&here), there) < bound.max(1e-12), "{name}: {:?} {there:?} {bound:e}", tip(&here));
        assert!((here.tip().alpha - flat.tip().alpha.abs()).abs() < 1e-6, "{name}");
        assert!((here.cables[0].stroke - flat.cables[0].stroke).abs() < 1e-8, "{name}");
        for (a, b, c) in [(0.3, 0.2, -0.4), (2.0, -1.0, 0.7), (-1.0, 0.5, 3.0)] {
            let m = rotation(a, b, c);
            let here = solved(&turned_arm(&arm, &m), 1e-8);
            let bound = flat.error_estimate + here.error_estimate;
            let error = apart(tip(&here), turned(&m, there));
            println!("{name}: {error:.1e} of {bound:.1e}, {:?}", here.statistics);
            assert!(error < bound.max(1e-12), "{name}: {error:e} {bound:e}");
        }
    }
}
