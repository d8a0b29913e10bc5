//! Times single solves in process and prints medians and quartiles as JSON, for `validation/peers`.
//!
//! `timing ARM TENSIONS SPEED TOL REPEATS`: a shipped arm or the path of an arm file, tensions in N
//! (`40,0`, or `-` for an arm without cables), speed of the stream in m/s, error of the tip over L, and how
//! often each kind of solve is timed. Times are in microseconds, lengths in metres.
//!
//! - `cold`: `Solver::new` and `solve`.
//! - `warm`: `set_tensions` and `resolve`, from the answer at 1 % less tension.
//! - `update`: `set_tensions` and `update` from there: the tip alone.

use std::error::Error;
use std::time::Instant;

use hydrostat::{Arm, Options, SolveError, Solver, Tip};
use hydrostat_files::{ArmFile, shipped};
use serde_json::{Value, json};

type Failure = Box<dyn Error>;

/// Solves before the first that is timed, which fill caches and let the clock rise.
const WARM_UP: usize = 5;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, tensions, speed, tol, repeats] = arguments.as_slice() else {
        return Err("usage: timing ARM TENSIONS SPEED TOL REPEATS".into());
    };
    let tensions = numbers(tensions)?;
    let mut arm = loaded(name)?;
    arm.set_tensions(&tensions)?;
    arm.flow.speed = speed.parse()?;
    let options = Options { tol: tol.parse()? };
    let repeats: usize = repeats.parse()?;
    if repeats == 0 {
        return Err("REPEATS: at least one".into());
    }

    let (cold, tip) = timed(repeats, (), |()| Ok(()), |()| Ok(Solver::new(&arm, options)?.solve()?.tip()))?;
    let mut report = json!({
        "arm": arm.name,
        "length": arm.length,
        "tol": options.tol,
        "repeats": repeats,
        "cold": cold,
        "tip": position(&tip),
    });
    if tensions.iter().any(|t| *t > 0.0) {
        let less: Vec<f64> = tensions.iter().map(|t| 0.99 * t).collect();
        let back = |solver: &mut Solver| {
            solver.set_tensions(&less)?;
            solver.update().map(|_| ())
        };
        let (warm, warm_tip) = timed(repeats, Solver::new(&arm, options)?, back, |solver| {
            solver.set_tensions(&tensions)?;
            Ok(solver.resolve()?.tip())
        })?;
        let (update, update_tip) = timed(repeats, Solver::new(&arm, options)?, back, |solver| {
            solver.set_tensions(&tensions)?;
            Ok(solver.update()?.tip)
        })?;
        report["warm"] = warm;
        report["update"] = update;
        report["warm_tip"] = position(&warm_tip);
        report["update_tip"] = position(&update_tip);
    }
    println!("{report}");
    Ok(())
}

fn numbers(list: &str) -> Result<Vec<f64>, Failure> {
    if list == "-" {
        return Ok(Vec::new());
    }
    list.split(',').map(|word| word.parse().map_err(|e| format!("TENSIONS: {word}: {e}").into())).collect()
}

/// The shipped arm of that name, else the one in that file.
fn loaded(name: &str) -> Result<Arm, Failure> {
    let file = match shipped::get(name) {
        Some(text) => ArmFile::parse(text, name)?,
        None => ArmFile::read(name)?,
    };
    Ok(file.arm()?)
}

/// Quartiles of the times of `solve`, before each of which `back` brings `state` to its start untimed, and the last tip.
fn timed<S>(
    repeats: usize,
    mut state: S,
    back: impl Fn(&mut S) -> Result<(), SolveError>,
    solve: impl Fn(&mut S) -> Result<Tip, SolveError>,
) -> Result<(Value, Tip), SolveError> {
    let mut samples = Vec::with_capacity(repeats);
    let mut tip = Tip::default();
    for k in 0..WARM_UP + repeats {
        back(&mut state)?;
        let clock = Instant::now();
        tip = solve(&mut state)?;
        if k >= WARM_UP {
            samples.push(clock.elapsed().as_secs_f64() * 1e6);
        }
    }
    samples.sort_by(f64::total_cmp);
    let at = |quarter: usize| samples[(samples.len() - 1) * quarter / 4];
    Ok((json!({ "lower_quartile": at(1), "median": at(2), "upper_quartile": at(3) }), tip))
}

fn position(tip: &Tip) -> Value {
    json!({ "x": tip.x, "y": tip.y, "theta": tip.theta, "alpha": tip.alpha })
}
