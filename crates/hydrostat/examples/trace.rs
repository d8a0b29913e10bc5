//! Solves one case of the grid: arm, side, k of 12, speed, direction, gravity.
#![allow(missing_docs)]
use hydrostat::{Gravity, Options, SolveError, Solver};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut arm =
        hydrostat_files::ArmFile::parse(hydrostat_files::shipped::get(&a[1]).unwrap(), "x").unwrap().arm().unwrap();
    let k: f64 = a[3].parse().unwrap();
    let n = arm.length;
    for c in &mut arm.cables {
        let left = c.offset.at(0.0, n).value > 0.0;
        c.tension = if a[2] == "all" || (a[2] == "left") == left { c.max_tension.unwrap() * k / 12.0 } else { 0.0 };
    }
    arm.flow.speed = a[4].parse().unwrap();
    arm.flow.direction = a[5].parse::<f64>().unwrap().to_radians();
    arm.gravity = (a[6] == "true").then(Gravity::default);
    let t = std::time::Instant::now();
    let r = Solver::new(&arm, Options::default()).unwrap().solve();
    let e = t.elapsed();
    match r {
        Ok(c) => {
            println!("ok {:?} est {:.1e} {:?} {e:?} {:?}", c.tip(), c.error_estimate / n, c.statistics, c.warnings());
        }
        Err(SolveError::NoEquilibrium(n)) => {
            println!("{:?} {} {e:?} last good {}", n.verdict, n.verdict.message(), n.last_good.is_some());
        }
        Err(e) => println!("{e}"),
    }
}
