//! Arguments of `hydrostat history`.

use std::path::PathBuf;

use clap::Args as ClapArgs;
use hydrostat_figures::Quantity;

use super::{ArmArgs, Format, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  all rows were reached
  2  wrong request: arguments, arm file, loads, or an output that cannot be written
  3  no equilibrium at the first row, or the way to a row ends at a limit of the arm, or the arm does not
     come to rest after a snap (all rows before it are written); standard error says why
  1  any other error";

/// Follows the arm quasi-statically along loads that rise and fall: each row of the table is the equilibrium reached
/// from the row before.
// A doc comment would take [0] for a link.
#[derive(Debug, ClapArgs)]
#[command(long_about = "\
Follows the arm quasi-statically along loads that rise and fall: each row of the table is the equilibrium reached \
from the row before, along the straight line between their loads. Where that ends in a limit point the arm snaps: its \
motion is followed until it rests, and the way goes on from there. So the answer depends on the way (hysteresis).

The loads file is CSV with columns named by keys of the arm file that can change over time, such as cable[0].tension, \
flow.speed or arm.base.angle, in SI units, angles in degrees; a head may have a unit, as in cable_0_tension_mN. A \
column t_s is ignored. An empty cell keeps the value of the row above. The first row is reached from the unloaded arm \
as by `hydrostat solve --after-snap`.")]
#[command(after_help = format!("\
Examples:
  hydrostat history silicone --input loads.csv --plot loading.svg
  hydrostat history my.toml --input loads.csv --over arm.base.angle --quantity tip.theta --plot loading.pdf
  hydrostat history my.toml --input loads.csv --format csv -o rows.csv

{EXIT}"))]
pub(crate) struct HistoryArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Loads in their order, CSV; - is standard input
    #[arg(long, value_name = "FILE")]
    pub(crate) input: PathBuf,
    /// Tolerance on the tip position, relative to the arm's length, from 1e-12 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-8", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    /// text: the snaps and the end; json: all rows and snaps; csv: one row per row of the loads
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// Write the result to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the loading diagram; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    /// Load that the diagram runs over; the first column that changes if not given
    #[arg(long, value_name = "KEY")]
    pub(crate) over: Option<String>,
    /// Quantity of --plot: tip.x, tip.y, tip.theta, tip.alpha, or the stroke of a cable, stroke.0
    #[arg(long, value_name = "NAME", default_value = "tip.y")]
    pub(crate) quantity: Quantity,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}
