//! Solves, single and many: `cargo bench -p hydrostat`.
#![allow(missing_docs)]

#[path = "../examples/common/arms.rs"]
mod arms;
#[path = "../examples/common/rows.rs"]
mod rows;
#[path = "../examples/common/sets.rs"]
mod sets;

use std::time::Duration;

use arms::pulled;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hydrostat::{Arm, Configuration, ManyOptions, Options, SolveError, Solver, solve_many};

fn paper() -> Arm {
    pulled("paper", &[40.0, 0.0], 0.5).expect("a shipped arm")
}

fn solve(arm: &Arm, tol: f64) -> Result<Configuration, SolveError> {
    Solver::new(arm, Options::with_tol(tol))?.solve()
}

/// What a solve from the answer at 1 % more or less tension does, by turns.
fn warm<R>(b: &mut criterion::Bencher<'_>, tol: f64, mut again: impl FnMut(&mut Solver) -> Result<R, SolveError>) {
    let mut solver = Solver::new(&paper(), Options::with_tol(tol)).expect("an arm");
    solver.solve().expect("solves");
    let mut more = false;
    b.iter(|| {
        more = !more;
        solver.set_tensions(&[if more { 40.4 } else { 40.0 }, 0.0]).expect("tensions");
        again(&mut solver).expect("solves")
    });
}

fn single(c: &mut Criterion) {
    let (paper, silicone) = (paper(), pulled("silicone", &[0.3, 0.0], 0.5).expect("a shipped arm"));
    for tol in [1e-8, 1e-4] {
        let mut group = c.benchmark_group(format!("to {tol:e}"));
        group.bench_function("paper 40 N 0.5 m/s cold", |b| b.iter(|| solve(&paper, tol).expect("solves")));
        group.bench_function("paper 40 N 0.5 m/s warm, 1 % more tension", |b| warm(b, tol, Solver::configuration));
        group.bench_function("paper 40 N 0.5 m/s update, 1 % more tension", |b| warm(b, tol, Solver::update));
        group.bench_function("silicone 0.3 N 0.5 m/s (a flag) cold", |b| {
            b.iter(|| solve(&silicone, tol).expect("solves"));
        });
        group.finish();
    }
}

/// Arms that a direct solve does not answer.
fn along_the_path(c: &mut Criterion) {
    let sets = [("ramped", sets::ramped(), true), ("limit point", sets::limit_points(), false)];
    for (name, arms, answered) in sets {
        let mut group = c.benchmark_group(name);
        group.sample_size(20).measurement_time(Duration::from_secs(1)).warm_up_time(Duration::from_millis(200));
        for (name, arm) in arms.expect("shipped arms") {
            assert_eq!(solve(&arm, 1e-8).is_ok(), answered, "{name}");
            group.bench_with_input(BenchmarkId::from_parameter(name), &arm, |b, arm| b.iter(|| solve(arm, 1e-8)));
        }
        group.finish();
    }
}

fn batch(c: &mut Criterion) {
    let arms = rows::grid(64).expect("a shipped arm");
    let mut group = c.benchmark_group("batch");
    group.sample_size(10).throughput(Throughput::Elements(arms.len() as u64));
    group.bench_function("paper, 64 x 64 of tension and stream, to 1e-6", |b| {
        b.iter(|| solve_many(&arms, &ManyOptions::default()).expect("options"));
    });
    group.finish();
}

criterion_group!(benches, single, along_the_path, batch);
criterion_main!(benches);
