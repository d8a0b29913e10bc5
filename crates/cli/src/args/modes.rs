//! Arguments of `hydrostat modes`.

use std::path::PathBuf;

use clap::Args as ClapArgs;

use super::{ArmArgs, Format, Over, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  the modes were found
  2  wrong request: arguments, arm file, or an output that cannot be written
  3  there is no such equilibrium, or none was found; standard error says why
  1  any other error";

/// Finds the slowest small motions about the equilibrium: rates, frequencies and damping, with the inertia of arm and
/// water, drag's linear part and the material's viscosity. Motions that grow are named: flutter where they swing,
/// divergence where they do not.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat modes silicone
  hydrostat modes silicone --flow-speed 0.1 --tension 0.2,0 --format json
  hydrostat modes silicone --plot-shapes shapes.svg --shapes-output shapes.csv
  hydrostat modes silicone --over flow.speed=0:0.3:31 --plot locus.svg

{EXIT}"))]
pub(crate) struct ModesArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Number of modes, the slowest first
    #[arg(long, value_name = "N", default_value = "8", value_parser = some)]
    pub(crate) count: usize,
    /// Elements of the mesh along the arm, from 1 to 64
    #[arg(long, value_name = "N", default_value = "12")]
    pub(crate) elements: usize,
    /// Find the modes at COUNT equally spaced values of a parameter, such as flow.speed=0:0.5:26 (root locus)
    #[arg(long, value_name = "KEY=FROM:TO:COUNT", allow_hyphen_values = true)]
    pub(crate) over: Option<Over>,
    /// text: a table; json: all results, with shapes; csv: one row per mode
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// Draw the rates in the complex plane; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    /// Draw the shapes of the first six modes; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture, conflicts_with = "over")]
    pub(crate) plot_shapes: Option<PathBuf>,
    /// Write the shapes to FILE as CSV, one row a mode and station
    #[arg(long, value_name = "FILE", conflicts_with = "over")]
    pub(crate) shapes_output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    /// Write the result to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// A number of modes.
fn some(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|count| *count > 0).ok_or_else(|| "expected a whole number from 1".to_owned())
}
