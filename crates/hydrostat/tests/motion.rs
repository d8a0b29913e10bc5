//! The arm in motion against closed forms.

use hydrostat::{Arm, Cable, Course, Inputs, MotionOptions, Profile, Simulation, Volume};

/// A slender uniform rod of length 1 m in a vacuum: R/L = 1e-3, first period 4.25 s.
fn rod() -> Arm {
    let mut arm = Arm::cone(1.0, 1e-3, 1e-3, 0.0, 0.5);
    let (rho, r) = (1000.0, 1e-3_f64);
    // omega_1 = 1.8751^2 sqrt(E r^2/(4 rho))/L^2.
    let omega = 2.0 * std::f64::consts::PI / 4.25;
    let young = (omega / 1.875_104_068_7_f64.powi(2)).powi(2) * 4.0 * rho / (r * r);
    arm.material = hydrostat::Material::Homogeneous { young, poisson: 0.5, shear_factor: 1.0 };
    arm.density = rho;
    arm.flow.density = 0.0;
    arm.readings.volume = Volume::None;
    arm
}

/// Zero crossings of the tip's deflection, s.
fn crossings(simulation: &mut Simulation, until: f64, every: f64) -> Vec<f64> {
    let mut out = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    simulation
        .run(until, every, |at, _| {
            if let Some((t, y)) = before {
                if y * at.tip[1] < 0.0 {
                    out.push(t + (at.time - t) * y / (y - at.tip[1]));
                }
            }
            before = Some((at.time, at.tip[1]));
            true
        })
        .unwrap();
    out
}

#[test]
fn an_arm_at_rest_stays_where_the_statics_have_it() {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)).pulled(0.2));
    arm.flow.speed = 0.1;
    arm.flow.direction = 1.0;
    let still = arm.solve().unwrap().tip();
    let mut simulation = Simulation::new(&arm, Inputs::default(), MotionOptions::default()).unwrap();
    let at = simulation.step(1.0).unwrap();
    let moved = (at.tip[0] - still.x).hypot(at.tip[1] - still.y) / 0.245;
    println!("moved {moved:.2e}, {:?}", simulation.statistics());
    assert!(moved < 1e-5, "{moved}");
}

#[test]
fn small_vibrations_have_the_period_of_the_first_mode() {
    let arm = rod();
    let mut inputs = Inputs::default();
    inputs.set("tip.force[1]", Course::step(1e-9, 0.0, 0.0)).unwrap();
    let mut simulation =
        Simulation::new(&arm, inputs, MotionOptions { tol: 1e-6, ..MotionOptions::default() }).unwrap();
    let at = crossings(&mut simulation, 4.25 * 4.0, 0.01);
    println!("{:?} {:?}", at, simulation.statistics());
    println!("{:?}", simulation.now());
}
