//! x
#[path = "common/arms.rs"]
mod arms;
#[path = "common/sets.rs"]
mod sets;
use arms::pulled;
use hydrostat::{Options, Solver};
fn main() {
    let _ = sets::limit_points;
    let paper = pulled("paper", &[40.0, 0.0], 0.5).unwrap();
    let silicone = pulled("silicone", &[0.3, 0.0], 0.5).unwrap();
    for (n, arm) in [("paper", &paper), ("flag", &silicone)] {
        let found = Solver::new(arm, Options::default()).unwrap().solve().unwrap();
        println!("{n} {:?} {:e} {:?}", found.statistics, found.error_estimate / arm.length, found.tip());
    }
    let mut solver = Solver::new(&paper, Options::default()).unwrap();
    solver.solve().unwrap();
    for t in [40.4, 40.0, 40.4] {
        solver.set_tensions(&[t, 0.0]).unwrap();
        let found = solver.resolve().unwrap();
        println!("warm {:?} {:e}", found.statistics, found.error_estimate);
    }
    for (n, arm) in sets::ramped().unwrap() {
        let found = Solver::new(&arm, Options::default()).unwrap().solve().unwrap();
        println!("{n} {:?}", found.statistics);
    }
}
