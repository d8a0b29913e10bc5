//! Times of solves beside what they are meant to be: `cargo run --release -p hydrostat --example goals`. The table is that of
//! `docs/performance.md`.
//!
//! Times are medians of single solves with the least in parentheses, and of a set the medians of both over its arms. Where
//! others use the machine, solves of milliseconds are interrupted in the middle, and only the least says what they take.

#[path = "common/arms.rs"]
mod arms;
#[path = "common/clock.rs"]
mod clock;
#[path = "common/rows.rs"]
mod rows;
#[path = "common/sets.rs"]
mod sets;

use std::error::Error;
use std::time::Instant;

use arms::pulled;
use clock::{Times, timed};
use hydrostat::{Arm, ManyOptions, Options, SolveError, Solver, Space, SpatialSolver, VerdictKind, solve_many};

type Failure = Box<dyn Error>;

const REPEATS: usize = 1001;
/// Of solves that take a hundred times as long.
const FEW: usize = 31;

fn main() -> Result<(), Failure> {
    println!("wide vectors: {}\n", hydrostat::has_wide_vectors());
    println!("| what | goal | measured |\n|---|---|---|");
    let paper = pulled("paper", &[40.0, 0.0], 0.5)?;
    let flag = pulled("silicone", &[0.3, 0.0], 0.5)?;
    let tight = Options::default();
    let tight_cold = cold(&paper, tight, REPEATS)?;
    let [tight_warm, tight_update] = warm(&paper, tight)?;
    row("`paper` cold", "40 us", &us(&tight_cold));
    row("`paper` warm", "15 us", &us(&tight_warm));
    row("`paper` warm, `update`", "", &us(&tight_update));
    row("`silicone`, the flag, cold", "100 us", &us(&cold(&flag, tight, REPEATS)?));

    for (name, plane, space) in in_space()? {
        row(
            &format!("{name}, in space over in the plane"),
            "6, aim 3",
            &format!("{:.1} ({plane}, {space})", space.0 / plane.0),
        );
    }

    let mut ramped = Vec::new();
    for (name, arm) in sets::ramped()? {
        if arm.solve()?.statistics.load_steps == 0 {
            return Err(format!("{name}: solved without the path").into());
        }
        ramped.push((name, cold(&arm, tight, FEW)?));
    }
    row(&format!("ramped, {} arms", ramped.len()), "300 us", &middle(&ramped));
    let mut limits = Vec::new();
    for (name, arm) in sets::limit_points()? {
        limits.push((name, limit_point(name, &arm)?));
    }
    row(&format!("limit point, {} arms", limits.len()), "10 ms", &middle(&limits));

    let loose = Options::with_tol(1e-4);
    let [loose_warm, loose_update] = warm(&paper, loose)?;
    for (name, tight, loose) in [
        ("cold", tight_cold, cold(&paper, loose, REPEATS)?),
        ("warm", tight_warm, loose_warm),
        ("`update`", tight_update, loose_update),
    ] {
        let ratio = |number| tight.quartile(number) / loose.quartile(number);
        let ratio = format!("{:.2} ({:.2})", ratio(2), ratio(0));
        row(&format!("`paper` {name}, time to 1e-8 over time to 1e-4"), "2", &ratio);
    }
    for (name, times) in ramped.iter().chain(&limits) {
        eprintln!("{name}: {}", us(times));
    }
    row("`solve_many`, 300 x 300 of T1 and v, 1e-6", "60 000 rows/s on 2 cores", &format!("{:.0}", batch()?));
    Ok(())
}

fn row(what: &str, goal: &str, measured: &str) {
    println!("| {what} | {goal} | {measured} |");
}

fn us(times: &Times) -> String {
    format!("{:.0} us ({:.0})", times.quartile(2), times.quartile(0))
}

fn middle(set: &[(&str, Times)]) -> String {
    let [median, least] = [2, 0].map(|number| {
        let mut all: Vec<f64> = set.iter().map(|(_, times)| times.quartile(number)).collect();
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    });
    format!("{median:.0} us ({least:.0})")
}

fn cold(arm: &Arm, options: Options, repeats: usize) -> Result<Times, SolveError> {
    let (times, _) = timed(repeats, (), |()| Ok(()), |()| Solver::new(arm, options)?.solve())?;
    Ok(times)
}

/// From 1 % less tension: the whole configuration, and the tip alone.
fn warm(arm: &Arm, options: Options) -> Result<[Times; 2], SolveError> {
    let tensions: Vec<f64> = arm.cables.iter().map(|cable| cable.tension).collect();
    let less: Vec<f64> = tensions.iter().map(|tension| 0.99 * tension).collect();
    let back = |solver: &mut Solver| {
        solver.set_tensions(&less)?;
        solver.update()
    };
    let solver = Solver::new(arm, options)?;
    let (whole, _) = timed(
        REPEATS,
        solver.clone(),
        |solver| back(solver).map(drop),
        |solver| {
            solver.set_tensions(&tensions)?;
            solver.configuration()
        },
    )?;
    let (tip, _) = timed(
        REPEATS,
        solver,
        |solver| back(solver).map(drop),
        |solver| {
            solver.set_tensions(&tensions)?;
            solver.update()
        },
    )?;
    Ok([whole, tip])
}

/// Median time, us.
struct Median(f64);

impl std::fmt::Display for Median {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.0} us", self.0)
    }
}

/// `silicone` at 0.1 N in 0.1 m/s by both solvers: cold, and from 1 % less tension.
fn in_space() -> Result<[(&'static str, Median, Median); 2], Failure> {
    let plane = pulled("silicone", &[0.1, 0.0], 0.1)?;
    let space = Arm { space: Some(Space::default()), ..plane.clone() };
    let options = Options::default();
    let flat = cold(&plane, options, REPEATS)?;
    let less = [0.099, 0.0];
    let [flat_warm, _] = warm(&plane, options)?;
    let mut samples = [Vec::new(), Vec::new()];
    for _ in 0..REPEATS {
        let clock = Instant::now();
        let mut solver = SpatialSolver::new(&space, options)?;
        solver.solve()?;
        samples[0].push(clock.elapsed().as_secs_f64() * 1e6);
        solver.set_tensions(&less)?;
        solver.configuration()?;
        solver.set_tensions(&[0.1, 0.0])?;
        let clock = Instant::now();
        solver.configuration()?;
        samples[1].push(clock.elapsed().as_secs_f64() * 1e6);
    }
    let [cold, warm] = samples.map(|mut all| {
        all.sort_by(f64::total_cmp);
        Median(all[all.len() / 2])
    });
    Ok([("cold", Median(flat.quartile(2)), cold), ("warm", Median(flat_warm.quartile(2)), warm)])
}

fn limit_point(name: &str, arm: &Arm) -> Result<Times, Failure> {
    let solve = |(): &mut ()| match Solver::new(arm, Options::default())?.solve() {
        Err(SolveError::NoEquilibrium(no)) => Ok(Some(no.verdict.kind)),
        Err(other) => Err(other),
        Ok(_) => Ok(None),
    };
    let (times, verdict) = timed(FEW, (), |()| Ok(()), solve)?;
    if verdict != Some(VerdictKind::LimitPoint) {
        return Err(format!("{name}: expected a limit point, found {verdict:?}").into());
    }
    Ok(times)
}

/// Rows a second.
fn batch() -> Result<f64, Failure> {
    let (arms, options) = (rows::grid(300)?, ManyOptions::default());
    solve_many(&arms[..1000], &options)?;
    let clock = Instant::now();
    let rows = solve_many(&arms, &options)?;
    Ok(rows.len() as f64 / clock.elapsed().as_secs_f64())
}
