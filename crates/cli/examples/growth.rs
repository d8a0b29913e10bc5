//! How the cost of solves grows, measured here and drawn: `growth DIRECTORY` writes a PNG and a CSV for each of tolerance,
//! number of cables, speed of the stream and rows of a sweep. `docs/performance.md` shows and reads them.
//!
//! Cold is `Solver::new` and `solve`; warm is `set_tensions` and `resolve` from the answer at 1 % less tension. Times are
//! the least of many, because others may use the machine; evaluations and elements are those of one solve and the same on every machine.

#[path = "../../hydrostat/examples/common/arms.rs"]
mod arms;
#[path = "../../hydrostat/examples/common/clock.rs"]
mod clock;

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use arms::pulled;
use clock::timed;
use hydrostat::{Arm, Options, SolveError, Solver, Statistics};
use hydrostat_figures::{Measure, Page, Panel, Scale, lines_figure};
use hydrostat_files::{ArmFile, shipped, write_whole};
use hydrostat_sweep::{Plan, Sample, Sweep, SweepOptions};

type Failure = Box<dyn Error>;

/// The most and the fewest solves of which the fastest counts, and the time that is for them, us.
const MOST: usize = 301;
const FEWEST: usize = 11;
const PATIENCE: f64 = 2e5;
const TOL: f64 = 1e-8;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [directory] = arguments.as_slice() else { return Err("usage: growth DIRECTORY".into()) };
    let directory = Path::new(directory);
    std::fs::create_dir_all(directory)?;

    let tols: Vec<f64> = (3..=11).map(|digits| 10.0_f64.powi(-digits)).collect();
    let both: [(&str, Make); 2] = [("paper", paper), ("silicone", silicone)];
    let solves = over(&tols, &both, |make, tol| Ok((make(0.5)?, tol)))?;
    let across =
        Measure { title: "tolerance (error of the tip over the length)".to_owned(), scale: Scale::Logarithmic };
    write(directory, "tolerance", "a solve, in 0.5 m/s", &across, &solves.names, &solves.panels())?;

    let speeds: Vec<f64> = (0..=20).map(|k| f64::from(k) / 20.0).collect();
    let solves = over(&speeds, &both, |make, speed| Ok((make(speed)?, TOL)))?;
    let across = Measure { title: "speed of the stream (m/s)".to_owned(), scale: Scale::Even };
    write(directory, "speed", "a solve, to 1e-8 of the length", &across, &solves.names, &solves.panels())?;

    let counts = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0];
    let ways: [(&str, Make); 2] = [("all to the tip", to_the_tip), ("ends spread", ends_spread)];
    let solves = over(&counts, &ways, |make, count| Ok((make(count)?, TOL)))?;
    let across = Measure { title: "cables".to_owned(), scale: Scale::Even };
    write(directory, "cables", "a solve of paper, 40 N shared by cables", &across, &solves.names, &solves.panels())?;

    sweeps(directory)
}

/// An arm for a value of what varies.
type Make = fn(f64) -> Result<Arm, Failure>;

fn paper(speed: f64) -> Result<Arm, Failure> {
    pulled("paper", &[40.0, 0.0], speed)
}

fn silicone(speed: f64) -> Result<Arm, Failure> {
    pulled("silicone", &[0.3, 0.0], speed)
}

/// `paper` with its left cable as many in one place: the shape stays, each station has more to add up.
fn to_the_tip(count: f64) -> Result<Arm, Failure> {
    let mut arm = paper(0.5)?;
    let mut cable = arm.cables[0].clone();
    cable.tension /= count;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = count as usize;
    arm.cables = vec![cable; count];
    Ok(arm)
}

/// The same with cables that end one after the other: each end is a node of the mesh.
fn ends_spread(count: f64) -> Result<Arm, Failure> {
    let mut arm = to_the_tip(count)?;
    for (index, cable) in arm.cables.iter_mut().enumerate() {
        cable.end = (index + 1) as f64 / count;
    }
    Ok(arm)
}

/// What solves took: for each name a point for each value.
struct Solves {
    names: Vec<String>,
    us: Vec<Vec<[f64; 2]>>,
    evaluations: Vec<Vec<[f64; 2]>>,
    elements: Vec<Vec<[f64; 2]>>,
}

impl Solves {
    fn panels(&self) -> [Panel; 3] {
        let panel = |title: &str, scale, lines| Panel { up: Measure { title: title.to_owned(), scale }, lines };
        [
            panel("time (µs)", Scale::Logarithmic, self.us.clone()),
            panel("evaluations", Scale::Logarithmic, self.evaluations.clone()),
            panel("elements", Scale::Even, self.elements.clone()),
        ]
    }
}

/// Cold and warm solves of each arm at each value.
fn over(
    values: &[f64],
    ways: &[(&str, Make)],
    arm: impl Fn(&Make, f64) -> Result<(Arm, f64), Failure>,
) -> Result<Solves, Failure> {
    let mut solves = Solves { names: Vec::new(), us: Vec::new(), evaluations: Vec::new(), elements: Vec::new() };
    for (name, make) in ways {
        let first = solves.names.len();
        for kind in ["cold", "warm"] {
            solves.names.push(format!("{name}, {kind}"));
            solves.us.push(Vec::new());
            solves.evaluations.push(Vec::new());
            solves.elements.push(Vec::new());
        }
        for value in values {
            let (arm, tol) = arm(make, *value)?;
            for (index, solved) in [cold(&arm, tol), warm(&arm, tol)].into_iter().enumerate() {
                let [us, evaluations, elements] = solved.unwrap_or_else(|error| {
                    eprintln!("{}, {value}: {error}", solves.names[first + index]);
                    [f64::NAN; 3]
                });
                solves.us[first + index].push([*value, us]);
                solves.evaluations[first + index].push([*value, evaluations]);
                solves.elements[first + index].push([*value, elements]);
            }
        }
    }
    Ok(solves)
}

/// Microseconds, evaluations and elements of a solve from nothing.
fn cold(arm: &Arm, tol: f64) -> Result<[f64; 3], SolveError> {
    taken((), |()| Ok(()), |()| Ok(Solver::new(arm, Options::with_tol(tol))?.solve()?.statistics))
}

/// The same from 1 % less tension.
fn warm(arm: &Arm, tol: f64) -> Result<[f64; 3], SolveError> {
    let tensions: Vec<f64> = arm.cables.iter().map(|cable| cable.tension).collect();
    let less: Vec<f64> = tensions.iter().map(|tension| 0.99 * tension).collect();
    let back = |solver: &mut Solver| {
        solver.set_tensions(&less)?;
        solver.configuration().map(|_| ())
    };
    let solve = |solver: &mut Solver| {
        solver.set_tensions(&tensions)?;
        Ok(solver.configuration()?.statistics)
    };
    taken(Solver::new(arm, Options::with_tol(tol))?, back, solve)
}

fn taken<S: Clone>(
    state: S,
    back: impl Fn(&mut S) -> Result<(), SolveError>,
    solve: impl Fn(&mut S) -> Result<Statistics, SolveError>,
) -> Result<[f64; 3], SolveError> {
    let (once, _) = timed(1, state.clone(), &back, &solve)?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let repeats = (PATIENCE / once.quartile(2)).clamp(FEWEST as f64, MOST as f64) as usize;
    let (times, statistics) = timed(repeats, state, back, solve)?;
    Ok([times.quartile(0), statistics.evaluations as f64, statistics.elements as f64])
}

/// Sweeps of `paper` over stream and tension, from 100 rows to a million.
fn sweeps(directory: &Path) -> Result<(), Failure> {
    let file = ArmFile::parse(shipped::get("paper").unwrap_or_default(), "paper")?;
    let all = std::thread::available_parallelism()?.get();
    let threads: Vec<usize> = if all == 1 { vec![1] } else { vec![1, all] };
    let names: Vec<String> = threads
        .iter()
        .map(|count| if *count == 1 { "1 thread".to_owned() } else { format!("{count} threads") })
        .collect();
    let mut rates = vec![Vec::new(); threads.len()];
    let mut sizes = vec![Vec::new(); threads.len()];
    for [speeds, tensions] in [[10, 10], [25, 40], [100, 100], [250, 400], [1000, 1000]] {
        let axes = [format!("flow.speed=0:1:{speeds}"), format!("cable[0].tension=0:80:{tensions}")];
        let axes = axes.iter().map(|axis| axis.parse()).collect::<Result<Vec<_>, _>>()?;
        let sweep = Sweep::new(&file, Plan::new(axes, Sample::Grid, 0)?, &SweepOptions::default())?;
        let rows = f64::from(speeds * tensions);
        // A million rows take minutes on one thread, which says no more than the rows before.
        let skipped = usize::from(rows > 5e5 && threads.len() > 1);
        for (index, threads) in threads.iter().enumerate().skip(skipped) {
            let scratch = tempfile::tempdir()?;
            let out = scratch.path().join("out.parquet");
            let clock = Instant::now();
            sweep.run(&out, false, *threads, &|_| {})?;
            rates[index].push([rows, rows / clock.elapsed().as_secs_f64()]);
            sizes[index].push([rows, std::fs::metadata(&out)?.len() as f64 / rows]);
        }
    }
    let across = Measure { title: "rows".to_owned(), scale: Scale::Logarithmic };
    let panel =
        |title: &str, lines| Panel { up: Measure { title: title.to_owned(), scale: Scale::Logarithmic }, lines };
    let panels = [panel("rows a second", rates), panel("bytes a row", sizes)];
    write(
        directory,
        "sweep",
        "a sweep of paper over tension and stream, to 1e-6 of the length",
        &across,
        &names,
        &panels,
    )
}

/// The picture and its numbers.
fn write(
    directory: &Path,
    file: &str,
    title: &str,
    across: &Measure,
    names: &[String],
    panels: &[Panel],
) -> Result<(), Failure> {
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let figure = lines_figure(title, across, &known, panels, &Page::default());
    write_whole(directory.join(format!("{file}.png")), &figure.png()?)?;
    let mut text = format!("{file},what,quantity,value\n");
    for panel in panels {
        for (name, line) in names.iter().zip(&panel.lines) {
            for [x, y] in line {
                writeln!(text, "{x:?},\"{name}\",{},{y:.1}", panel.up.title)?;
            }
        }
    }
    write_whole(directory.join(format!("{file}.csv")), text.as_bytes())?;
    println!("{}", directory.join(format!("{file}.png")).display());
    Ok(())
}
