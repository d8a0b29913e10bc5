//! Arguments of `hydrostat path`.

use std::path::PathBuf;

use clap::Args as ClapArgs;
use hydrostat_figures::Quantity;
use hydrostat_files::Varied;

use super::common::{STABLE, count};
use super::{ArmArgs, Format, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  the path reached an end of the range, or the largest number of points
  2  wrong request: arguments, arm file, or an output that cannot be written
  3  no equilibrium at the start, or a limit of the arm inside the range;
     standard error says which and where, and the points before it are written
  1  any other error";

/// Follows equilibria while one parameter varies: around limit points, where the parameter turns back, and past
/// bifurcations, where other branches cross.
///
/// The path starts at the shape that `solve` finds at the start of the range. It ends at either end of the range, at a
/// limit of the arm, or at the largest number of points.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat path silicone --vary 'cable[0].tension=0:900 mN' --plot path.svg --plot-shapes shapes.svg
  hydrostat path silicone --vary cable.0.tension=0:0.9 --quantity stroke.0 --plot stroke.png
  hydrostat path silicone --flow-speed 0.2 --set flow.direction=180 --vary 'arm.base.angle=90:-90'
  hydrostat path my.toml --vary flow.speed=0:0.5 --branches --format csv -o path.csv
  hydrostat path silicone-spatial --vary 'flow.direction[2]=0:1' --quantity tip.z --plot turned.svg

{STABLE}

{EXIT}"))]
pub(crate) struct PathArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    // A doc comment would take [0] for a link.
    #[arg(
        long,
        value_name = "KEY=FROM:TO",
        allow_hyphen_values = true,
        help = "Parameter and range, such as 'cable[0].tension=0:20' or 'flow.direction=0:180 deg'"
    )]
    pub(crate) vary: Varied,
    /// Tolerance on the tip position along the path, relative to the arm's length, from 1e-7 to 1e-3
    #[arg(long, value_name = "TOL", default_value = "1e-6", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    /// Largest number of points, all branches together
    #[arg(long, value_name = "N", default_value = "1000", value_parser = points)]
    pub(crate) max_points: usize,
    /// Largest step: change of the angle along the arm (rad, root mean square) combined with the change of the parameter relative to its range, from 0.001 to 0.4
    #[arg(long, value_name = "X", default_value = "0.2", allow_hyphen_values = true)]
    pub(crate) max_step: f64,
    /// Also follow the branches that cross at bifurcations
    #[arg(long)]
    pub(crate) branches: bool,
    /// At each limit point of a stable part, follow the motion until the arm rests, and say where and after how long
    #[arg(long)]
    pub(crate) after_snap: bool,
    /// text: ends and events; json: all results except shapes; csv: one row per point
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// Write the result to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Plot a quantity against the parameter; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    /// Draw shapes along the path to scale; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot_shapes: Option<PathBuf>,
    /// Quantity of --plot: tip.x, tip.y, tip.theta (in space tip.z), tip.alpha, or the stroke of a cable, stroke.0
    #[arg(long, value_name = "NAME", default_value = "tip.y")]
    pub(crate) quantity: Quantity,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

/// A number of points.
fn points(text: &str) -> Result<usize, String> {
    count(text, 100_000)
}
