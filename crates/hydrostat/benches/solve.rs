//! Single solves: `cargo bench -p hydrostat`.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use hydrostat::{Arm, Options, Solver};
use hydrostat_files::{ArmFile, shipped};

fn shipped_arm(name: &str, tensions: &[f64], speed: f64) -> Arm {
    let text = shipped::get(name).expect("a shipped arm");
    let mut arm = ArmFile::parse(text, name).and_then(|file| file.arm()).expect("a shipped arm reads");
    arm.set_tensions(tensions).expect("as many tensions as cables");
    arm.flow.speed = speed;
    arm
}

fn solves(c: &mut Criterion) {
    let paper = shipped_arm("paper", &[40.0, 0.0], 0.5);
    c.bench_function("paper 40 N 0.5 m/s cold", |b| {
        b.iter(|| Solver::new(&paper, Options::default()).and_then(|mut s| s.solve()).expect("solves"));
    });
    c.bench_function("paper 40 N 0.5 m/s warm, 1 % more tension", |b| {
        let mut solver = Solver::new(&paper, Options::default()).expect("an arm");
        solver.solve().expect("solves");
        let mut more = false;
        b.iter(|| {
            more = !more;
            solver.set_tensions(&[if more { 40.4 } else { 40.0 }, 0.0]).expect("tensions");
            solver.resolve().expect("solves")
        });
    });
    let silicone = shipped_arm("silicone", &[0.3, 0.0], 0.5);
    c.bench_function("silicone 0.3 N 0.5 m/s (a flag) cold", |b| {
        b.iter(|| Solver::new(&silicone, Options::default()).and_then(|mut s| s.solve()).expect("solves"));
    });
}

criterion_group!(benches, solves);
criterion_main!(benches);
