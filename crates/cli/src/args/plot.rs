//! Arguments of `hydrostat plot`.

use std::path::PathBuf;

use clap::Args as ClapArgs;

use super::sweep::table;
use super::{PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  drawn
  2  wrong request: arguments, a file that is not a sweep, or a picture that cannot be written
  1  any other error";

/// Draws a sweep: a column against one or two of the keys that were varied, and the tip positions coloured by that column.
///
/// Without --map and --workspace, both are written as SVG and PNG next to the sweep, and their names are printed.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat plot out.parquet
  hydrostat plot out.parquet --quantity tip_alpha_rad --map alpha.svg
  hydrostat plot out.csv --over flow.speed,material.young --workspace tips.png

{EXIT}"))]
pub(crate) struct PlotArgs {
    /// Table of a sweep, .parquet or .csv
    #[arg(value_name = "SWEEP", value_parser = table)]
    pub(crate) sweep: PathBuf,
    /// Column that gives the colours [default: tip_alpha_rad if it varies by 10 deg or more, else the tip coordinate that varies most, else another column that varies]
    #[arg(long, value_name = "COLUMN")]
    pub(crate) quantity: Option<String>,
    /// Keys of the map, across and up; required if more than two were varied
    #[arg(long, value_name = "KEY,KEY", value_delimiter = ',')]
    pub(crate) over: Vec<String>,
    /// Draw the column against the keys; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) map: Option<PathBuf>,
    /// Draw the tip positions to scale; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) workspace: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}
