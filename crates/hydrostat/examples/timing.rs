//! Times single solves in process and prints medians and quartiles as JSON, for `validation/peers`.
//!
//! `timing ARM TENSIONS SPEED TOL REPEATS`: a shipped arm or the path of an arm file, tensions in N
//! (`40,0`, or `-` for an arm without cables), speed of the stream in m/s, error of the tip over L, and how
//! often each kind of solve is timed. Times are in microseconds, lengths in metres.
//!
//! - `cold`: `Solver::new` and `solve`.
//! - `warm`: `set_tensions` and `resolve`, from the answer at 1 % less tension.
//! - `update`: `set_tensions` and `update` from there: the tip alone (in the plane).

#[path = "common/arms.rs"]
mod arms;
#[path = "common/clock.rs"]
mod clock;

use std::error::Error;

use arms::pulled;
use clock::{Times, timed};
use hydrostat::{Arm, Options, SolveError, Solver, SpatialError, SpatialSolver, Tip};
use serde_json::{Value, json};

type Failure = Box<dyn Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, tensions, speed, tol, repeats] = arguments.as_slice() else {
        return Err("usage: timing ARM TENSIONS SPEED TOL REPEATS".into());
    };
    let tensions = numbers(tensions)?;
    let arm = pulled(name, &tensions, speed.parse()?)?;
    let options = Options::with_tol(tol.parse()?);
    let repeats: usize = repeats.parse()?;
    if repeats == 0 {
        return Err("REPEATS: at least one".into());
    }

    let solves = if arm.space.is_some() { in_space } else { in_plane };
    let mut report = solves(&arm, &tensions, options, repeats)?;
    report["arm"] = json!(arm.name);
    report["length"] = json!(arm.length);
    report["tol"] = json!(options.tol);
    report["repeats"] = json!(repeats);
    println!("{report}");
    Ok(())
}

/// Tensions 1 % below these, if there are any.
fn less(tensions: &[f64]) -> Option<Vec<f64>> {
    tensions.iter().any(|t| *t > 0.0).then(|| tensions.iter().map(|t| 0.99 * t).collect())
}

fn in_plane(arm: &Arm, tensions: &[f64], options: Options, repeats: usize) -> Result<Value, Failure> {
    let (cold, tip) =
        timed::<_, _, SolveError>(repeats, (), |()| Ok(()), |()| Ok(Solver::new(arm, options)?.solve()?.tip()))?;
    let mut report = json!({ "cold": times(&cold), "tip": position(&tip) });
    if let Some(less) = less(tensions) {
        let back = |solver: &mut Solver| {
            solver.set_tensions(&less)?;
            solver.update().map(|_| ())
        };
        let (warm, warm_tip) = timed::<_, _, SolveError>(repeats, Solver::new(arm, options)?, back, |solver| {
            solver.set_tensions(tensions)?;
            Ok(solver.configuration()?.tip())
        })?;
        let (update, update_tip) = timed::<_, _, SolveError>(repeats, Solver::new(arm, options)?, back, |solver| {
            solver.set_tensions(tensions)?;
            Ok(solver.update()?.tip)
        })?;
        report["warm"] = times(&warm);
        report["update"] = times(&update);
        report["warm_tip"] = position(&warm_tip);
        report["update_tip"] = position(&update_tip);
    }
    Ok(report)
}

fn in_space(arm: &Arm, tensions: &[f64], options: Options, repeats: usize) -> Result<Value, Failure> {
    let (cold, tip) = timed::<_, _, SpatialError>(
        repeats,
        (),
        |()| Ok(()),
        |()| Ok(SpatialSolver::new(arm, options)?.solve()?.tip()),
    )?;
    let mut report = json!({ "cold": times(&cold), "tip": { "x": tip.x, "y": tip.y, "z": tip.z } });
    if let Some(less) = less(tensions) {
        let back = |solver: &mut SpatialSolver| {
            solver.set_tensions(&less)?;
            solver.configuration().map(|_| ())
        };
        let (warm, tip) = timed::<_, _, SpatialError>(repeats, SpatialSolver::new(arm, options)?, back, |solver| {
            solver.set_tensions(tensions)?;
            Ok(solver.configuration()?.tip())
        })?;
        report["warm"] = times(&warm);
        report["warm_tip"] = json!({ "x": tip.x, "y": tip.y, "z": tip.z });
    }
    Ok(report)
}

fn numbers(list: &str) -> Result<Vec<f64>, Failure> {
    if list == "-" {
        return Ok(Vec::new());
    }
    list.split(',').map(|word| word.parse().map_err(|e| format!("TENSIONS: {word}: {e}").into())).collect()
}

fn times(times: &Times) -> Value {
    let [lower, median, upper] = [1, 2, 3].map(|number| times.quartile(number));
    json!({ "lower_quartile": lower, "median": median, "upper_quartile": upper })
}

fn position(tip: &Tip) -> Value {
    json!({ "x": tip.x, "y": tip.y, "theta": tip.theta, "alpha": tip.alpha })
}
