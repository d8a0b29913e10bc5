//! Tries.
use hydrostat::{Arm, Space};
fn main() {
    let args: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.flow.speed = args[1];
    arm.flow.direction = args[0].to_radians();
    let planar = arm.equilibria(1e-8).unwrap();
    for one in &planar.found { let t = one.configuration.tip(); println!("plane {:.5} {:.5} {:?}", t.x, t.y, one.stability); }
    arm.space = Some(Space::default());
    let start = std::time::Instant::now();
    let all = arm.equilibria_in_space_while(1e-8, |n| { if n % 5 == 1 { eprintln!("{n} {:?}", start.elapsed()); } start.elapsed().as_secs_f64() < args[2] }).unwrap();
    for one in &all.found { let t = one.configuration.tip(); println!("{:.5} {:.5} {:.5} {:?}", t.x, t.y, t.z, one.stability); }
    println!("{} curves, {} points, signs {:?} {:?}", all.curves.len(), all.steps, all.sum_of_signs, all.curves);
}
