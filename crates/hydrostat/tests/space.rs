//! Arms in space: closed forms, published shapes, the plane, and invariances.

use std::f64::consts::{PI, TAU};

#[path = "common/space.rs"]
mod common;

use common::{apart, in_space, rotation, silicone, solved, three_cables, tip, turned, turned_arm};
use hydrostat::{
    Arm, Cable, FlowLaw, Gravity, Material, ModelOptions, Options, Profile, Solver, Space, SpatialSolver, Volume,
};

/// Without pins, elements: a rod of one section with given coefficients, no area change.
fn rod(length: f64, [ea, ga, ei, gj]: [f64; 4]) -> Arm {
    let mut arm = Arm::cone(length, 0.1 * length, 0.1 * length, 1.0, 0.0);
    let area = PI * 0.01 * length * length;
    arm.material = Material::Coefficients { c1: (ea / area).into(), c2: (ga / area).into(), c3: (ei / area).into() };
    arm.model = ModelOptions { volume: Volume::None, ..ModelOptions::default() };
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

/// Bathe and Bolourchi's 45-degree bend, 600 out of its plane. Published tips, from several element formulations, lie
/// about (47.2, 15.7, 53.4).
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
    circular.model.volume = Volume::Circular;
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

/// One cable at constant offset that turns uniformly along a uniform arm: the strains are constant in the frame that
/// turns with the cable, and meet six algebraic equations.
#[test]
fn a_uniformly_turning_cable_strains_the_arm_evenly() {
    for volume in Volume::ALL {
        let (length, radius, offset, turns, tension) = (0.3, 0.01, 0.006, 4.0, 1.5);
        let mut arm = Arm::cone(length, radius, radius, 110e3, 0.4);
        arm.model.volume = volume;
        arm.cables.push(Cable::new("helix", offset).pulled(tension).at_angle(Profile::linear(0.2, 0.2 + turns)));
        let shape = solved(&in_space(&arm), 1e-10);
        let rate = turns / length;
        let (young, shear) = (110e3, 110e3 / 2.8);
        for k in 0..=10 {
            let st = shape.at(length * f64::from(k) / 10.0);
            let phi = 0.2 + rate * st.s;
            let (y, z) = (offset * phi.cos(), offset * phi.sin());
            let p = [0.0, st.beta * y, st.beta * z];
            let (v, u) = ([st.nu, st.eta, st.zeta], [st.tau, st.kappa, st.mu]);
            let cross = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] {
                std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
            };
            let up = cross(u, p);
            let path: [f64; 3] = std::array::from_fn(|i| v[i] + up[i] + [0.0, -p[2] * rate, p[1] * rate][i]);
            let size = apart(path, [0.0; 3]);
            let force = path.map(|t| -tension * t / size);
            let moment = cross(p, force);
            let area = PI * radius * radius * st.beta * st.beta;
            let bending = young * radius * radius / 4.0;
            let body = [
                young * (st.nu - 1.0),
                shear * st.eta,
                shear * st.zeta,
                2.0 * bending * (shear / young) * st.tau,
                bending * st.kappa,
                bending * st.mu,
            ];
            for i in 0..3 {
                assert!((area * body[i] - force[i]).abs() < 1e-9, "{volume:?} {i} {st:?}");
                assert!((area * body[3 + i] - moment[i]).abs() < 1e-11, "{volume:?} {i} {st:?}");
            }
            let first = shape.at(0.0);
            assert!((st.nu - first.nu).abs() < 1e-9 && (st.tau - first.tau).abs() < 1e-8);
            assert!((st.kappa.hypot(st.mu) - first.kappa.hypot(first.mu)).abs() < 1e-7);
        }
        assert!(shape.at(0.1).tau.abs() > 0.05, "a cable that turns twists the arm");
    }
}

/// Kirchhoff's rod: a uniform arm without distributed loads keeps n_f in space, m . n, and the complement of its strain
/// energy.
#[test]
fn first_integrals_hold_along_a_uniform_rod() {
    let stiffness = [40.0, 15.0, 0.01, 0.008];
    let mut arm = rod(1.0, stiffness);
    arm.tip.force = [0.02, 0.03];
    arm.tip.moment = 0.01;
    let space = arm.space.as_mut().unwrap();
    space.tip_force = -0.015;
    space.tip_moment = [0.02, -0.005];
    let shape = solved(&arm, 1e-10);
    let [ea, ga, ei, gj] = stiffness;
    let integrals = |s: f64| {
        let st = shape.at(s);
        let to_space =
            |v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| v[0] * st.a[k] + v[1] * st.b[k] + v[2] * st.c[k]) };
        let (n, m) = (to_space([st.n_a, st.n_b, st.n_c]), to_space([st.m_a, st.m_b, st.m_c]));
        let complement = 0.5 * (st.m_a.powi(2) / gj + (st.m_b.powi(2) + st.m_c.powi(2)) / ei)
            + st.n_a
            + 0.5 * (st.n_a.powi(2) / ea + (st.n_b.powi(2) + st.n_c.powi(2)) / ga);
        [n[0], n[1], n[2], n[0] * m[0] + n[1] * m[1] + n[2] * m[2], complement]
    };
    let first = integrals(0.0);
    for k in 1..=20 {
        let here = integrals(f64::from(k) / 20.0);
        for i in 0..5 {
            assert!((here[i] - first[i]).abs() < 1e-9, "{k} {i} {} {}", here[i], first[i]);
        }
    }
    let reaction = shape.base_reaction.force;
    assert!(apart(reaction, [-0.02, -0.03, 0.015]) < 1e-12);
}

/// `map` of every vector of an arm in space; axial ones (moments) take `sign` too.
fn mapped(arm: &Arm, map: impl Fn([f64; 3]) -> [f64; 3], sign: f64) -> Arm {
    let mut out = arm.clone();
    let space = out.space.as_mut().unwrap();
    let base = space.base.as_mut().unwrap();
    base.direction = map(base.direction);
    base.section = base.section.map(&map);
    space.stream = space.stream.map(&map);
    space.gravity = space.gravity.map(&map);
    let force = map([out.tip.force[0], out.tip.force[1], space.tip_force]);
    let moment = map([space.tip_moment[0], space.tip_moment[1], out.tip.moment]).map(|m| sign * m);
    (out.tip.force, space.tip_force) = ([force[0], force[1]], force[2]);
    (space.tip_moment, out.tip.moment) = ([moment[0], moment[1]], moment[2]);
    out
}

#[test]
fn a_turn_of_everything_a_mirror_and_another_b_leave_the_shape() {
    let arm = three_cables();
    let plain = tip(&solved(&arm, 1e-9));
    let bound = 2e-9 * arm.length;
    let m = rotation(0.7, -0.4, 1.9);
    let found = tip(&solved(&mapped(&arm, |v| turned(&m, v), 1.0), 1e-9));
    assert!(apart(found, turned(&m, plain)) < bound, "{found:?} {plain:?}");
    // In the plane x-y as a mirror c goes to the other side: angles of cables change sign, and so do moments.
    let mut mirrored = mapped(&arm, |v| [v[0], v[1], -v[2]], -1.0);
    for cable in &mut mirrored.cables {
        cable.angle = cable.angle.scaled(-1.0, 1.0);
    }
    let found = tip(&solved(&mirrored, 1e-9));
    assert!(apart(found, [plain[0], plain[1], -plain[2]]) < bound, "{found:?} {plain:?}");
    // b turned about a by an angle, and cables against it.
    let by = 0.8_f64;
    let mut other = arm.clone();
    let shape = solved(&arm, 1e-9);
    let st = shape.at(0.0);
    let b: [f64; 3] = std::array::from_fn(|k| by.cos() * st.b[k] + by.sin() * st.c[k]);
    other.space.as_mut().unwrap().base.as_mut().unwrap().section = Some(b);
    for (k, cable) in other.cables.iter_mut().enumerate() {
        cable.angle = (k as f64 * TAU / 3.0 - by).into();
    }
    let found = tip(&solved(&other, 1e-9));
    assert!(apart(found, plain) < bound, "{found:?} {plain:?}");
}

#[test]
fn two_half_tensions_in_one_place_are_one() {
    let arm = three_cables();
    let mut halves = arm.clone();
    for cable in &mut halves.cables {
        cable.tension *= 0.5;
    }
    halves.cables.extend(halves.cables.clone());
    // A negative offset is the other side.
    for cable in &mut halves.cables[3..] {
        cable.offset = cable.offset.scaled(-1.0, 1.0);
        let angle = cable.angle.at(0.0, 1.0).value;
        cable.angle = (angle + PI).into();
    }
    assert!(apart(tip(&solved(&arm, 1e-9)), tip(&solved(&halves, 1e-9))) < 1e-9 * arm.length);
}

/// Euler's column is doubly degenerate in space: the determinant's sign does not change at its load, and two directions
/// are unstable past it.
#[test]
fn a_column_past_eulers_load_is_unstable_in_two_directions() {
    let [ea, ga, ei, gj] = [40.0, 15.0, 0.01, 0.008];
    let critical = {
        // P (1 + P (1/GA - 1/EA)) = pi^2 EI/(4 L^2)
        let (q, c) = (1.0 / ga - 1.0 / ea, PI * PI * ei / 4.0);
        ((1.0 + 4.0 * q * c).sqrt() - 1.0) / (2.0 * q)
    };
    for (fraction, directions) in [(0.98, 0), (1.02, 2)] {
        let mut arm = rod(1.0, [ea, ga, ei, gj]);
        arm.tip.force = [-fraction * critical, 0.0];
        let shape = solved(&arm, 1e-9);
        assert!(shape.tip().y.abs() + shape.tip().z.abs() < 1e-9);
        assert_eq!(shape.stability().and_then(hydrostat::Stability::directions), Some(directions), "{fraction}");
    }
}

/// What is on one side of a cable folds at the same tension in the plane and in space.
#[test]
fn a_fold_is_named_as_in_the_plane() {
    let mut arm = silicone();
    arm.cables[0].tension = 1.5;
    let Err(hydrostat::SolveError::NoEquilibrium(flat)) = arm.solve() else { panic!("1.5 N fold the tip") };
    let found = SpatialSolver::new(&in_space(&arm), Options::default()).unwrap().solve();
    let Err(hydrostat::SpatialError::NoEquilibrium(space)) = found else { panic!("1.5 N fold the tip") };
    assert_eq!((space.verdict.kind, space.verdict.phase), (flat.verdict.kind, flat.verdict.phase));
    let off = (space.verdict.load_fraction - flat.verdict.load_fraction).abs();
    assert!(off < 2e-3, "{:?} {:?}", space.verdict, flat.verdict);
}

#[test]
fn what_arms_in_space_do_not_have_is_refused_by_its_key() {
    let mut arm = in_space(&silicone());
    arm.cables[1].friction = 0.1;
    assert_eq!(arm.check().unwrap_err().key(), "cable[1].friction");
    let mut arm = in_space(&silicone());
    arm.model = ModelOptions::LITERAL;
    assert_eq!(arm.check().unwrap_err().key(), "model.flow_surface");
    let mut arm = silicone();
    arm.cables[0].angle = 0.3.into();
    assert_eq!(arm.check().unwrap_err().key(), "cable[0].angle");
    let refused = in_space(&silicone()).solve().unwrap_err().to_string();
    assert!(refused.contains("spatial"), "{refused}");
}

/// A change of tensions is followed from the shape before, to the shape of a cold solve.
#[test]
fn warm_solves_are_cold_ones() {
    let mut arm = three_cables();
    let mut solver = SpatialSolver::new(&arm, Options::default()).unwrap();
    solver.solve().unwrap();
    solver.set_tensions(&[0.101, 0.05, 0.0]).unwrap();
    let warm = solver.configuration().unwrap();
    arm.cables[0].tension = 0.101;
    let cold = solved(&arm, 1e-8);
    assert!(apart(tip(&warm), tip(&cold)) < 2e-8 * arm.length);
    assert!(warm.statistics.newton_rounds < cold.statistics.newton_rounds);
}

/// A stream from any side is followed along the path to its end, or to a limit that has a name.
#[test]
fn streams_from_all_sides_are_solved_or_have_a_verdict() {
    let mut solved = 0;
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut arm = three_cables();
            (arm.gravity, arm.cables[0].tension, arm.cables[1].tension) = (None, 0.45, 0.135);
            let mut stream = [0.0; 3];
            stream[axis] = sign;
            arm.space = Some(Space { stream: Some(stream), ..Space::default() });
            for speed in [0.05, 0.3] {
                arm.flow.speed = speed;
                match SpatialSolver::new(&arm, Options::with_tol(1e-6)).unwrap().solve() {
                    Ok(_) => solved += 1,
                    Err(hydrostat::SpatialError::NoEquilibrium(no)) => {
                        assert_eq!(no.verdict.kind, hydrostat::VerdictKind::LimitPoint, "{stream:?} {speed}");
                    }
                    Err(error) => panic!("{error}"),
                }
            }
        }
    }
    assert!(solved >= 11, "{solved} of 12");
}

/// Where the tangential part of the stream changes its sign, its load jumps under `resultant`. Nodes stood within
/// 2e-7 L of that place at a tolerance of 1e-8, as they do at kinks: the tip was off by 1.5e-8 L, and the estimate was
/// 6e-10 L.
#[test]
fn nodes_stood_as_near_to_jumps_of_the_load_as_to_kinks() {
    let mut arm = Arm::cone(0.25, 0.002, 0.0011, 2.7e6, 0.5);
    (arm.density, arm.base.angle) = (800.0, -0.2 * PI);
    arm.gravity = Some(Gravity::default());
    (arm.flow.speed, arm.flow.direction) = (0.043, -87_f64.to_radians());
    (arm.tip.force, arm.tip.moment) = ([0.0054, 0.0], 0.00018);
    arm.model.entering_speed = hydrostat::EnteringSpeed::Resultant;
    let plane = |tol: f64| {
        let tip = Solver::new(&arm, Options::with_tol(tol)).unwrap().solve().unwrap().tip();
        [tip.x, tip.y, 0.0]
    };
    let off = apart(plane(1e-8), plane(1e-11)) / arm.length;
    assert!(off < 1e-9, "in the plane {off:e}");
    arm.space = Some(Space { stream: Some([0.1, -1.8, 0.4]), ..Space::default() });
    let off = apart(tip(&solved(&arm, 1e-8)), tip(&solved(&arm, 1e-11))) / arm.length;
    assert!(off < 2e-9, "in space {off:e}");
}
