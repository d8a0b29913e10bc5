//! Each option of the model changes what it says it changes, and nothing else.

use std::f64::consts::{FRAC_PI_2, PI};

use hydrostat::cases::{inextensible_arm, uniform_arm};
use hydrostat::{
    Arm, Cable, Cavity, Configuration, Displaced, EnteringSpeed, FlowLaw, FlowSurface, Gravity, Hydrostatics,
    LayerMean, ModelOptions, Options, Profile, Solver, Support, Volume, WettedLength,
};

fn solve(arm: &Arm) -> Configuration {
    let mut solver = Solver::new(arm, Options::with_tol(1e-10)).unwrap();
    solver.solve().unwrap_or_else(|e| panic!("{}: {e}", arm.name))
}

/// An arm so stiff that the stream leaves it straight along e1: its base carries the load of one
/// straight cylinder of radius 50 mm and length 1 m. Speeds are about 1 mm/s.
fn rigid(direction: f64) -> Arm {
    let mut arm = inextensible_arm("rigid");
    arm.flow.speed = 1e-3;
    arm.flow.direction = direction;
    arm
}

/// The load of the stream on a rigid arm over S U^2, along and across it.
fn load(arm: &Arm) -> [f64; 2] {
    let s = PI * arm.flow.density * 0.05 * arm.flow.speed * arm.flow.speed;
    solve(arm).base_reaction.force.map(|f| -f / s)
}

fn close(got: [f64; 2], want: [f64; 2]) {
    // The arm bends by about 1e-5 rad.
    for k in 0..2 {
        assert!((got[k] - want[k]).abs() < 2e-4, "{got:?}, want {want:?}");
    }
}

#[test]
fn the_default_law_on_a_straight_cylinder() {
    for degrees in [-170.0_f64, -100.0, -60.0, 0.0, 30.0, 80.0, 120.0, 180.0] {
        let angle = degrees.to_radians();
        let (v, n) = (2.0 / 3.0 * angle.cos(), angle.sin());
        close(load(&rigid(angle)), [(v.abs() + 2.0 * n.abs()) * v, n.abs() * n]);
    }
}

#[test]
fn quadratic_drag_on_a_straight_cylinder() {
    for degrees in [-170.0_f64, -60.0, 0.0, 30.0, 90.0] {
        let angle = degrees.to_radians();
        let mut arm = rigid(angle);
        let (cn, ct) = (1.2, 0.03);
        arm.flow.law = FlowLaw::QuadraticDrag { cn, ct };
        let (t, n) = (angle.cos(), angle.sin());
        close(load(&arm), [ct * t.abs() * t, cn / PI * n.abs() * n]);
        // Neither the entering speed nor the layer is a part of this law.
        let same = load(&arm);
        arm.model.entering_speed = EnteringSpeed::Resultant;
        arm.model.layer_mean = LayerMean::Momentum;
        assert_eq!(load(&arm), same);
    }
}

/// (2/3)^2 = 4/9 becomes 8/15: 6/5 of the load at zero incidence. Across the arm, nothing.
#[test]
fn layer_mean_momentum_raises_the_tangential_load() {
    for degrees in [0.0_f64, 40.0, 90.0] {
        let angle = degrees.to_radians();
        let mut arm = rigid(angle);
        arm.model.layer_mean = LayerMean::Momentum;
        let (v, n) = ((8.0_f64 / 15.0).sqrt() * angle.cos(), angle.sin());
        close(load(&arm), [(v.abs() + 2.0 * n.abs()) * v, n * n]);
    }
    let mut along = rigid(0.0);
    let speed = load(&along)[0];
    along.model.layer_mean = LayerMean::Momentum;
    assert!((load(&along)[0] / speed - 1.2).abs() < 1e-9);
}

/// (V_t + V_n)^2 leaves a force along the arm at normal incidence, of either sign.
#[test]
fn resultant_adds_a_force_along_the_arm_at_normal_incidence() {
    let off = 0.01;
    for side in [-1.0, 1.0] {
        let mut arm = rigid(FRAC_PI_2 + side * off);
        let (v, n) = (2.0 / 3.0 * off.sin(), off.cos());
        close(load(&arm), [-side * (v + 2.0 * n) * v, n * n]);
        arm.model.entering_speed = EnteringSpeed::Resultant;
        close(load(&arm), [-side * (v + n) * (v + n), n * n]);
    }
    // Along the arm both agree.
    let mut arm = rigid(0.0);
    let tangential = load(&arm);
    arm.model.entering_speed = EnteringSpeed::Resultant;
    close(load(&arm), tangential);
}

/// Cables compress the arm to nu = 0.8; with `none` its girth stays, and the wetted length shrinks.
#[test]
fn deformed_wetted_length_scales_the_load_with_the_stretch() {
    let mut arm = uniform_arm("compressed", 100.0, 1e6);
    arm.cables.push(Cable::new("left", 0.02).pulled(10.0));
    arm.cables.push(Cable::new("right", -0.02).pulled(10.0));
    arm.flow.speed = 1e-3;
    let reference = solve(&arm);
    assert!((reference.at(0.5).nu - 0.8).abs() < 1e-6);
    arm.model.wetted_length = WettedLength::Deformed;
    let deformed = solve(&arm);
    let ratio = deformed.base_reaction.force[0] / reference.base_reaction.force[0];
    assert!((ratio - 0.8).abs() < 1e-6, "{ratio}");
}

/// The swelling of an arm with everything on it.
fn loaded(volume: Volume) -> Configuration {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.4));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)).pulled(0.1));
    arm.flow.speed = 0.05;
    arm.flow.direction = 0.4;
    arm.model.volume = volume;
    solve(&arm)
}

#[test]
fn volume_laws_keep_what_they_say_everywhere() {
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        let kept = |nu: f64, beta: f64| match volume {
            Volume::Planar => nu * beta,
            Volume::Circular => nu * beta * beta,
            Volume::None => beta,
        };
        let solved = loaded(volume);
        for (nu, beta) in solved.stations.nu.iter().zip(&solved.stations.beta) {
            assert!((kept(*nu, *beta) - 1.0).abs() < 1e-14, "{volume:?}: nu {nu}, beta {beta}");
        }
        for k in 0..=50 {
            let station = solved.at(0.245 * f64::from(k) / 50.0);
            assert!((kept(station.nu, station.beta) - 1.0).abs() < 1e-14);
            assert!(station.nu < 0.999, "the cables compress the arm everywhere");
        }
    }
}

/// `silicone` in its water with 0.4 N on both cables, and whether its support holds it up or down (N).
fn weight_in_water(change: impl FnOnce(&mut Arm)) -> f64 {
    let text = hydrostat_files::shipped::get("silicone").unwrap();
    let mut arm = hydrostat_files::ArmFile::parse(text, "silicone").unwrap().arm().unwrap();
    arm.set_tensions(&[0.4, 0.4]).unwrap();
    arm.gravity = Some(Gravity::default());
    change(&mut arm);
    let [along, up] = solve(&arm).base_reaction.force;
    assert!(along.abs() < 1e-12);
    up
}

/// The volume is kept (15), and with it the water displaced, however far the cables compress the arm.
#[test]
fn an_arm_pulled_by_both_cables_floated_under_the_planar_law() {
    // (rho_arm - rho_w) g times the volume of the cone.
    let volume = PI * 0.245 * (0.010 * 0.010 + 0.010 * 0.002 + 0.002 * 0.002) / 3.0;
    let weight = (1080.0 - 1022.0) * 9.81 * volume;
    assert!((weight - 0.0181).abs() < 1e-4);
    for volume_law in [Volume::Planar, Volume::Circular] {
        let held = weight_in_water(|arm| arm.model.volume = volume_law);
        assert!((held / weight - 1.0).abs() < 1e-9, "{volume_law:?}: {held} of {weight}");
    }
    let by_section = weight_in_water(|arm| arm.model.displaced = Displaced::Section);
    assert!(by_section.abs() < 0.1 * weight, "{by_section}");
    println!("{weight} N in water, {by_section} N by the section");
}

/// A sealed cavity displaces its outline, a flooded one its wall; sections that do not swell lose volume with the
/// stretch.
#[test]
fn cavities_displace_what_they_did_in_the_unloaded_arm() {
    let full = |radius: f64| PI * radius * radius;
    // A cylinder compressed to the same stretch all along by equal pulls.
    let mut arm = uniform_arm("hollow", 100.0, 1e6);
    let outer = arm.radius.at(0.0, 1.0).value;
    arm.inner_radius = (0.5 * outer).into();
    arm.density = 1200.0;
    arm.gravity = Some(Gravity { acceleration: 1e-6, direction: 0.0 });
    arm.cables.push(Cable::new("left", 0.5 * outer).pulled(5.0));
    arm.cables.push(Cable::new("right", -0.5 * outer).pulled(5.0));
    let wall = full(outer) - full(0.5 * outer);
    for (cavity, outline) in [(Cavity::Flooded, wall), (Cavity::Sealed, full(outer))] {
        for volume in Volume::ALL {
            for displaced in Displaced::ALL {
                arm.cavity = cavity;
                (arm.model.volume, arm.model.displaced) = (volume, displaced);
                let solved = solve(&arm);
                let middle = solved.at(0.5 * arm.length);
                assert!(middle.nu < 0.99, "the cables compress the arm");
                let d = match (displaced, volume) {
                    (Displaced::Section, _) => middle.nu * middle.beta * middle.beta,
                    (Displaced::Volume, Volume::None) => middle.nu,
                    (Displaced::Volume, _) => 1.0,
                };
                let want = (1200.0 * wall - 1000.0 * outline * d) * 1e-6;
                let held = -solved.base_reaction.force[0] / arm.length;
                assert!((held / want - 1.0).abs() < 1e-6, "{cavity:?} {volume:?} {displaced:?}: {held} {want}");
            }
        }
    }
}

/// A stiff heavy arm in a vacuum at 30 deg: only the weight across it is left.
#[test]
fn normal_only_leaves_no_weight_along_the_tangent() {
    let mut arm = inextensible_arm("heavy");
    arm.base.angle = 30_f64.to_radians();
    arm.flow.density = 0.0;
    arm.density = 1000.0;
    arm.gravity = Some(Gravity { acceleration: 1e-6, direction: -FRAC_PI_2 });
    let weight = PI * 0.05 * 0.05 * 1000.0 * 1e-6;
    let parts = |solved: &Configuration| {
        let [x, y] = solved.base_reaction.force;
        let (sin, cos) = arm.base.angle.sin_cos();
        [(x * cos + y * sin) / weight, (-x * sin + y * cos) / weight]
    };
    close(parts(&solve(&arm)), [0.5, 0.75_f64.sqrt()]);
    let mut normal_only = arm.clone();
    normal_only.model.hydrostatics = Hydrostatics::NormalOnly;
    let solved = solve(&normal_only);
    close(parts(&solved), [0.0, 0.75_f64.sqrt()]);
    // The axial force would be the sum of what is left along the tangent.
    assert!(solved.stations.n_a.iter().all(|n| n.abs() < 1e-4 * weight));
}

/// With cables that are straight in the straight arm, and without flow, nothing bends, but for what small errors grow
/// to: from the base they grow as exp(int sqrt(T/EI) ds) under the tension that is left in the arm.
fn check_unstrained_base(tip_radius: f64, tension: f64) {
    const ROUNDING: f64 = 1e-15;
    let mut arm = Arm::cone(0.245, 0.010, tip_radius, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.5 * tip_radius)).pulled(tension));
    arm.model.support = Support::UnstrainedBase;
    let solved = solve(&arm);
    // EI = E pi R^4/4 with R linear in s: the integral of 1/R^2 is L/(R(0) R(L)).
    let growth = ((4.0 * tension / (PI * 110e3)).sqrt() * arm.length / (0.010 * tip_radius)).exp();
    let off = (ROUNDING * growth).max(1e-9);
    assert!(off < 0.05, "rounding decides nothing here: {off:e}");
    let tip = solved.tip();
    assert!((tip.x - arm.length).abs() < off && tip.y.abs() < off, "{tip:?}, {off:e} allowed");
    let first = solved.at(0.0);
    assert!((first.nu - 1.0).abs() < 1e-12 && first.eta.abs() < 1e-12 && first.mu.abs() < 1e-10);
    // The cable's force at the tip, which the source's (5) would put there, is left unmet.
    let unmet = solved.unmet.expect("this support reports what is unmet");
    let slope = (0.5 * tip_radius - 0.005) / arm.length;
    let along = tension / slope.hypot(1.0);
    let off = off.max(1e-9) * tension;
    assert!((unmet.force[0] - along).abs() < off, "{unmet:?}");
    assert!((unmet.force[1] - along * slope).abs() < 10.0 * off, "{unmet:?}");
    assert!((unmet.moment + along * 0.5 * tip_radius).abs() < 10.0 * off, "{unmet:?}");
}

#[test]
fn an_unstrained_base_does_not_bend_without_flow() {
    for tension in [0.001, 0.01, 0.03, 0.1, 0.5] {
        check_unstrained_base(0.002, tension);
    }
    check_unstrained_base(0.004, 0.5);
    for tension in [0.01, 0.5, 2.0] {
        check_unstrained_base(0.01, tension);
    }
}

/// More flow, more bending: the opposite of a clamped arm.
#[test]
fn an_unstrained_base_bends_more_in_a_faster_stream() {
    let mut arm = Arm::cone(0.245, 0.010, 0.004, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.002)).pulled(0.3));
    arm.flow.direction = 0.6;
    let bend = |support: Support, speed: f64| {
        let mut arm = arm.clone();
        arm.model.support = support;
        arm.flow.speed = speed;
        let solved = solve(&arm);
        assert_eq!(solved.unmet.is_some(), support == Support::UnstrainedBase);
        solved.at(0.5 * arm.length).theta.abs()
    };
    let speeds = [0.005, 0.01, 0.02];
    let bends = speeds.map(|speed| bend(Support::UnstrainedBase, speed));
    assert!(bends[0] < bends[1] && bends[1] < bends[2], "{bends:?}");
    assert!(bend(Support::Clamped, 0.0) > 0.05);
}

/// Without taper, swelling and shear the lateral surfaces run along the centreline, however bent.
#[test]
fn lateral_is_centreline_on_a_cylinder() {
    for direction in [-0.3, 1.2, -0.8] {
        let mut arm = inextensible_arm("bent cylinder");
        arm.tip.moment = 0.8;
        arm.flow.direction = direction;
        arm.flow.speed = 0.1;
        let centreline = solve(&arm).tip();
        arm.model.flow_surface = FlowSurface::Lateral;
        let lateral = solve(&arm).tip();
        assert!((lateral.theta - 0.8).abs() > 0.05, "the stream bends it");
        let off = (centreline.x - lateral.x).hypot(centreline.y - lateral.y);
        assert!(off < 1e-9, "direction {direction}: {off:e}");
    }
}

/// On a stiff cone the windward surface is turned by the taper towards or from the stream.
#[test]
fn lateral_turns_the_load_by_the_taper() {
    let taper: f64 = 0.2;
    let mut arm = inextensible_arm("stiff cone");
    arm.radius = Profile::linear(0.3, 0.3 - taper.tan());
    let mean_radius = 0.3 - 0.5 * taper.tan();
    arm.flow.speed = 1e-3;
    arm.flow.direction = 1.0;
    let s = PI * arm.flow.density * mean_radius * arm.flow.speed * arm.flow.speed;
    arm.model.flow_surface = FlowSurface::Lateral;
    // The stream comes from below: the right side is hit, whose tangent is turned by + taper.
    let (v, n) = (2.0 / 3.0 * (1.0 - taper).cos(), (1.0 - taper).sin());
    let (along, across) = ((v + 2.0 * n) * v, n * n);
    let want = [along * taper.cos() - across * taper.sin(), along * taper.sin() + across * taper.cos()];
    close(solve(&arm).base_reaction.force.map(|f| -f / s), want);
}

#[test]
fn literal_is_the_listed_set() {
    let listed = ModelOptions {
        volume: Volume::Planar,
        flow_surface: FlowSurface::Lateral,
        entering_speed: EnteringSpeed::Resultant,
        layer_mean: LayerMean::Speed,
        wetted_length: WettedLength::Reference,
        displaced: Displaced::Volume,
        hydrostatics: Hydrostatics::NormalOnly,
        support: Support::Clamped,
    };
    assert_eq!(ModelOptions::LITERAL, listed);
    let default = ModelOptions::default();
    assert_eq!(default.volume, Volume::Planar);
    assert_eq!(default.flow_surface, FlowSurface::Centreline);
    assert_eq!(default.entering_speed, EnteringSpeed::Tangential);
    assert_eq!(default.layer_mean, LayerMean::Speed);
    assert_eq!(default.wetted_length, WettedLength::Reference);
    assert_eq!(default.displaced, Displaced::Volume);
    assert_eq!(default.hydrostatics, Hydrostatics::Archimedes);
    assert_eq!(default.support, Support::Clamped);
}

/// Without stream and gravity the readings of both have nothing to act on.
#[test]
fn in_still_water_only_the_volume_law_matters() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.5));
    let default = solve(&arm).tip();
    arm.model = ModelOptions {
        layer_mean: LayerMean::Momentum,
        wetted_length: WettedLength::Deformed,
        ..ModelOptions::LITERAL
    };
    let literal = solve(&arm).tip();
    let off = (default.x - literal.x).hypot(default.y - literal.y) / arm.length;
    assert!(off < 2e-10, "{off:e}");
    arm.model.volume = Volume::Circular;
    assert!((solve(&arm).tip().theta - default.theta).abs() > 1e-2);
}

/// (7) has the tangent of the arm's surface, which is what `lateral` takes.
#[test]
fn the_layer_ran_along_the_centreline_in_every_reading() {
    let taper: f64 = 0.2;
    let mut arm = inextensible_arm("stiff cone");
    arm.radius = Profile::linear(0.3, 0.3 - taper.tan());
    arm.flow.speed = 1e-3;
    for (direction, windward) in [(1.0_f64, taper), (-1.0, -taper)] {
        arm.flow.direction = direction;
        for (surface, angle) in [(FlowSurface::Centreline, 0.0), (FlowSurface::Lateral, windward)] {
            arm.model.flow_surface = surface;
            let outer = solve(&arm).layer_speed(0.5, arm.flow.layer_thickness) / arm.flow.speed;
            let want = (direction - angle).cos();
            assert!((outer - want).abs() < 1e-4, "{surface:?} from {direction}: {outer}, want {want}");
        }
    }
}

/// "nu_o = beta_o = 1, eta_o = mu_o = 0" at the support are strains, also of an arm that has others when nothing acts.
#[test]
fn an_unstrained_base_kept_the_reference_strains() {
    let mut arm = Arm::cone(0.245, 0.010, 0.004, 110e3, 0.5);
    arm.model.support = Support::UnstrainedBase;
    arm.reference.nu = 1.04.into();
    arm.reference.eta = 0.03.into();
    arm.reference.mu = Profile::linear(2.0, -1.0);
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.002)).pulled(0.1));
    let base = solve(&arm).at(0.0);
    assert!((base.nu - 1.0).abs() < 1e-3 && base.eta.abs() < 1e-3, "{base:?}");
    assert!(base.mu.abs() < 0.05, "{base:?}");
}
