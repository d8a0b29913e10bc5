//! Solves one arm cold and warm many times, for profiling.
#![allow(missing_docs)]
fn main() {
    let arm =
        hydrostat_files::ArmFile::parse(hydrostat_files::shipped::get("paper").unwrap(), "x").unwrap().arm().unwrap();
    let which = std::env::args().nth(1).unwrap();
    let n: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let mut s = hydrostat::Solver::new(&arm, hydrostat::Options::default()).unwrap();
    s.solve().unwrap();
    let t = std::time::Instant::now();
    let mut st = None;
    for i in 0..n {
        if which == "cold" {
            st = Some(hydrostat::Solver::new(&arm, hydrostat::Options::default()).unwrap().solve().unwrap().statistics);
        } else {
            s.set_tensions(&[if i % 2 == 0 { 40.4 } else { 40.0 }, 0.0]).unwrap();
            st = Some(s.resolve().unwrap().statistics);
        }
    }
    println!("{:?} a solve, {st:?}", t.elapsed() / n as u32);
}
