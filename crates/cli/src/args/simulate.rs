//! Arguments of `hydrostat simulate`.

use std::path::PathBuf;

use clap::{Args as ClapArgs, ValueEnum};
use hydrostat_files::Dimension;

use super::{ArmArgs, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  the motion was found up to the end
  2  wrong request: arguments, arm file, loads, or an output that cannot be written
  3  no equilibrium to start from, or the motion ends early;
     standard error says why, when and where, and the rows before are written
  1  any other error";

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
  hydrostat simulate silicone --vary flow.speed=sine:0.1:0.05:2s --until 10s --every 50ms -o out.json

{EXIT}"))]
pub(crate) struct SimulateArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Loads over time, CSV with the column t_s
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
    /// text: the end of the motion; json: all rows in one document; csv: one row per time [default: by the ending of
    /// --output, else csv; text without --output]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(crate) format: Option<MotionFormat>,
    /// Write the rows to FILE; CSV grows as the motion goes on
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw shapes at equal times, from pale to dark, and the tip trace; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    /// Draw the place of the tip and the energies over time; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot_time: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionFormat {
    Text,
    Json,
    Csv,
}

/// A time above zero, with or without a unit.
fn time(text: &str) -> Result<f64, String> {
    match Dimension::Time.read(text) {
        Ok((value, _)) if value > 0.0 => Ok(value),
        Ok(_) => Err(format!("expected a time above 0, found \"{text}\"")),
        Err(error) => Err(format!("expected {}, found \"{text}\": {error}", Dimension::Time.expected())),
    }
}
