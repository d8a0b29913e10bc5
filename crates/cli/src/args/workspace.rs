//! Arguments of `hydrostat workspace`.

use std::path::PathBuf;

use clap::Args as ClapArgs;

use super::{ArmArgs, By, Format, PictureArgs, ReachArgs, picture};

const EXIT: &str = "\
Exit status:
  0  traced
  2  wrong request: arguments, arm file, or an output that cannot be written
  3  there is no equilibrium without tensions
  1  any other error";

/// Traces the boundary of the tip's workspace: tensions at their bounds, singularities, and the last equilibria.
///
/// Each cable has a tension between 0 and its largest. The same as `hydrostat reach ARM --boundary`.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat workspace silicone --plot workspace.svg
  hydrostat workspace silicone --max-tension '0.6 N' --format csv -o workspace.csv

{EXIT}"))]
pub(crate) struct WorkspaceArgs {
    #[command(flatten)]
    arm: ArmArgs,
    /// Largest tension of every cable, N; limits in the arm file also apply
    #[arg(long, value_name = "T", value_parser = super::reach::force, allow_hyphen_values = true)]
    max_tension: Option<f64>,
    /// Tolerance on tip positions, relative to the arm's length, from 1e-9 to 1e-3 [default: 1e-7]
    #[arg(long, value_name = "TOL", allow_hyphen_values = true)]
    tol: Option<f64>,
    /// Distance between points of the boundary, relative to the arm's length, from 0.001 to 0.1 [default: 0.01]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    spacing: Option<f64>,
    /// text: a table; json: all results; csv: one row per point
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    format: Format,
    /// Write the result to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Draw the boundary to scale; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArgs,
}

impl From<WorkspaceArgs> for ReachArgs {
    fn from(args: WorkspaceArgs) -> Self {
        let WorkspaceArgs { arm, max_tension, tol, spacing, format, output, plot, picture } = args;
        Self {
            direction: None,
            arm,
            target: None,
            path: None,
            boundary: true,
            angle: None,
            station: None,
            by: By::default(),
            max_tension,
            max_stroke: None,
            tol,
            spacing,
            format,
            output,
            plot,
            picture,
        }
    }
}
