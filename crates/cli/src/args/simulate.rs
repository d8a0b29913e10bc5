//! Arguments of `hydrostat simulate`.

use std::path::{Path, PathBuf};

use clap::{Args as ClapArgs, ValueEnum};
use hydrostat_files::Dimension;

use super::common::{count, list};
use super::{ArmArgs, PictureArgs, picture};
use crate::output;

const EXIT: &str = "\
Exit status:
  0  the motion was found up to the end
  2  wrong request: arguments, arm file, loads, or an output that cannot be written
  3  no equilibrium to start from, or the motion ends early;
     standard error says why, when and where, and the rows before are written
  1  any other error
  130  interrupted by Ctrl-C: the rows before are written; resume with --resume";

/// Moves the arm in time: it starts at rest, in equilibrium under the loads at t = 0, and follows what changes.
// A doc comment would take [0] for a link.
#[derive(Debug, ClapArgs)]
#[command(long_about = "\
Moves the arm in time: it starts at rest, in equilibrium under the loads at t = 0, and follows what changes.

The loads file is a CSV table with the column t_s and columns named by keys of the arm file, such as \
cable[0].tension, flow.speed or tip.force[1], in SI units, angles in degrees; a head may have a unit, as in \
cable_0_tension_mN. Straight lines join the rows. Two rows at one time are a jump; such a pair at t = 0 is a \
release. The table [dynamics] of the arm file sets added mass, viscosity of the material and inertia.")]
#[command(after_help = format!("\
Examples:
  hydrostat simulate silicone --input loads.csv --until 2s --every 10ms --tol 1e-4 -o out.csv
  hydrostat simulate silicone --vary 'cable[0].tension=ramp:0:0.2 N:0:0.2 s' --until 1s
  hydrostat simulate silicone --input loads.csv --until 1s --plot strobe.svg --plot-time energies.svg
  hydrostat simulate silicone --vary flow.speed=sine:0.1:0.05:2s --until 10s --every 50ms -o out.parquet
  hydrostat simulate silicone --input loads.csv --until 2s --station 0.5,1 --shapes every:0.1 -o out.json
  hydrostat simulate silicone --from out.csv --until 4s -o later.csv

{EXIT}"))]
pub(crate) struct SimulateArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Loads over time, CSV with the column t_s; - is standard input
    #[arg(long, value_name = "FILE")]
    pub(crate) input: Option<PathBuf>,
    // A doc comment would take [0] for a link.
    #[arg(
        long,
        value_name = "KEY=SHAPE",
        allow_hyphen_values = true,
        help = "A load over time: KEY=ramp:FROM:TO:START:END, KEY=step:FROM:TO:AT or KEY=sine:MEAN:AMPLITUDE:PERIOD. Repeatable"
    )]
    pub(crate) vary: Vec<String>,
    /// End of the motion, s
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub(crate) until: f64,
    /// Time between rows, s [default: a hundredth of --until]
    #[arg(long, value_name = "TIME", value_parser = time)]
    pub(crate) every: Option<f64>,
    /// Tolerance on the tip position, relative to the arm's length, from 1e-9 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-4", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    /// Elements of the mesh along the arm [default: by the tolerance]
    #[arg(long, value_name = "N")]
    pub(crate) elements: Option<usize>,
    /// Also write places, angles and velocities of these stations: shares of the arm's length, or lengths with a unit
    #[arg(long, value_name = "S,S,...", value_delimiter = ',', value_parser = station)]
    pub(crate) station: Vec<StationAt>,
    /// Also write the equilibrium under the loads of each time, and how far the tip is from it over the arm's length
    #[arg(long)]
    pub(crate) quasi_static: bool,
    /// Also write whole shapes at these times: T,T,... or every:T, s. With -o FILE.json they are in the document, else
    /// give --shapes-output
    #[arg(long, value_name = "TIMES", value_parser = shape_times)]
    pub(crate) shapes: Option<ShapeTimes>,
    /// Number of equally spaced stations of a whole shape
    #[arg(long, value_name = "N", default_value = "51", value_parser = shape_stations)]
    pub(crate) shape_stations: usize,
    /// Write whole shapes to FILE as CSV, one row a station and time
    #[arg(long, value_name = "FILE", requires = "shapes")]
    pub(crate) shapes_output: Option<PathBuf>,
    /// Write what happens on the way to FILE as CSV: cables that go slack or taut, a surface that folds, the end
    #[arg(long, value_name = "FILE")]
    pub(crate) events: Option<PathBuf>,
    /// Go on from the end of an earlier run, whose output FILE is, in place of an equilibrium: its time goes on, too
    #[arg(long, value_name = "FILE")]
    pub(crate) from: Option<PathBuf>,
    /// Go on with an interrupted run of the same command, which keeps its rows; the output must be CSV
    #[arg(long, requires = "output")]
    pub(crate) resume: bool,
    /// text: the end of the motion; json: all rows in one document; csv and parquet: one row per time [default: by the
    /// ending of --output, else csv; text without --output]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<MotionFormat>,
    /// Write the rows to FILE; CSV grows as the motion goes on. Beside it FILE.state.json keeps the state of the end
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw shapes at equal times, from pale to dark, and the tip trace, in space from four sides; FILE ends in .svg,
    /// .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    /// Draw the place of the tip and the energies over time; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot_time: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

impl SimulateArgs {
    /// The file that rows are written to; none where they go to standard output.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.output.as_deref().and_then(output::file)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionFormat {
    Text,
    Json,
    Csv,
    Parquet,
}

/// A place along the arm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StationAt {
    /// A share of the length.
    Share(f64),
    /// m.
    Length(f64),
}

/// When whole shapes are wanted, s.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ShapeTimes {
    At(Vec<f64>),
    Every(f64),
}

fn station(text: &str) -> Result<StationAt, String> {
    let expected = || format!("expected a share of the length in [0, 1], or a length with its unit, found \"{text}\"");
    match Dimension::Length.read(text) {
        Ok((share, None)) if (0.0..=1.0).contains(&share) => Ok(StationAt::Share(share)),
        Ok((length, Some(_))) if length >= 0.0 => Ok(StationAt::Length(length)),
        _ => Err(expected()),
    }
}

fn shape_stations(text: &str) -> Result<usize, String> {
    count(text, 10_000)
}

fn shape_times(text: &str) -> Result<ShapeTimes, String> {
    if let Some(every) = text.strip_prefix("every:") {
        return time(every).map(ShapeTimes::Every);
    }
    let mut times = list(Dimension::Time, "T", text)?;
    if times.iter().any(|time| *time < 0.0) {
        return Err(format!("expected times of at least 0, such as 0.1,0.2 or every:50ms, found \"{text}\""));
    }
    times.sort_by(f64::total_cmp);
    Ok(ShapeTimes::At(times))
}

/// A time above zero, with or without a unit.
fn time(text: &str) -> Result<f64, String> {
    match Dimension::Time.read(text) {
        Ok((value, _)) if value > 0.0 => Ok(value),
        Ok(_) => Err(format!("expected a time above 0, found \"{text}\"")),
        Err(error) => Err(format!("expected {}, found \"{text}\": {error}", Dimension::Time.expected())),
    }
}
