//! Times motions in process and prints their times, tips and statistics as JSON, for `validation/peers`.
//!
//! `moving ARM LOADS TOL ELEMENTS UNTIL EVERY REPEATS`: a shipped arm or the path of an arm file, loads over time as CSV,
//! error of the tip over L, elements of the mesh (`-`: by the tolerance), end and time between rows in s, and how often
//! the run is timed, after some that are not. Times are in microseconds, lengths in metres.

#[allow(dead_code, reason = "other examples need more of it")]
#[path = "common/arms.rs"]
mod arms;
#[path = "common/clock.rs"]
mod clock;

use std::error::Error;

use arms::named;
use clock::{Times, timed};
use hydrostat::{Inputs, MotionError, MotionOptions, MotionStatistics, Simulation, SpatialSimulation};
use hydrostat_files::read_time_loads;
use serde_json::json;

type Failure = Box<dyn Error>;

/// Tips of a run, with what it took and the error that it states.
type Run = (Vec<Vec<f64>>, MotionStatistics, f64);

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, loads, tol, elements, until, every, repeats] = arguments.as_slice() else {
        return Err("usage: moving ARM LOADS TOL ELEMENTS UNTIL EVERY REPEATS".into());
    };
    let arm = named(name)?;
    let mut inputs = Inputs::default();
    read_time_loads(loads, &mut inputs)?;
    let elements = if elements == "-" { None } else { Some(elements.parse()?) };
    let options = MotionOptions { tol: tol.parse()?, elements, ..MotionOptions::default() };
    let (until, every): (f64, f64) = (until.parse()?, every.parse()?);
    let run = || -> Result<Run, MotionError> {
        let mut tips = Vec::new();
        if arm.space.is_some() {
            let mut simulation = SpatialSimulation::new(&arm, inputs.clone(), options)?;
            simulation.run(until, every, |at, _| {
                tips.push(vec![at.tip.x, at.tip.y, at.tip.z]);
                true
            })?;
            return Ok((tips, simulation.statistics(), simulation.error_estimate()));
        }
        let mut simulation = Simulation::new(&arm, inputs.clone(), options)?;
        simulation.run(until, every, |at, _| {
            tips.push(at.tip.to_vec());
            true
        })?;
        Ok((tips, simulation.statistics(), simulation.error_estimate()))
    };
    let repeats: usize = repeats.parse()?;
    if repeats == 0 {
        return Err("REPEATS: at least one".into());
    }
    let (times, (tips, statistics, estimate)) = timed(repeats, (), |()| Ok(()), |()| run())?;
    let MotionStatistics { steps, rejected, solves, rounds, elements } = statistics;
    let report = json!({
        "arm": arm.name,
        "length": arm.length,
        "tol": options.tol,
        "repeats": repeats,
        "run": quartiles(&times),
        "tips": tips,
        "error_estimate": estimate,
        "steps": steps,
        "rejected": rejected,
        "solves": solves,
        "rounds": rounds,
        "elements": elements,
    });
    println!("{report}");
    Ok(())
}

fn quartiles(times: &Times) -> serde_json::Value {
    let [lower, median, upper] = [1, 2, 3].map(|number| times.quartile(number));
    json!({ "lower_quartile": lower, "median": median, "upper_quartile": upper })
}
