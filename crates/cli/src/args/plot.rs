//! Arguments of `hydrostat plot`.

use std::path::PathBuf;

use clap::Args as ClapArgs;

use super::sweep::table;
use super::{PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  drawn
  2  the request is wrong: arguments, a file that is no result of a sweep, a picture that cannot be written
  1  anything else";

/// Draws the result of a sweep: a column over two of the keys that were varied, and the places of the tip, coloured by that column.
///
/// Without --map and --workspace, writes both, as SVG and PNG, beside the sweep's file, and says their names.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat plot out.parquet
  hydrostat plot out.parquet --quantity tip_alpha_rad --map alpha.svg
  hydrostat plot out.csv --over flow.speed,material.young --workspace tips.png

{EXIT}"))]
pub(crate) struct PlotArgs {
    /// The result of a sweep, .parquet or .csv
    #[arg(value_name = "SWEEP", value_parser = table)]
    pub(crate) sweep: PathBuf,
    /// The column that gives colours [default: tip_alpha_rad where it varies by 10 deg, else the coordinate of the tip that varies most, else another that varies]
    #[arg(long, value_name = "COLUMN")]
    pub(crate) quantity: Option<String>,
    /// The two keys of the map, across and up; needed where more than two were varied
    #[arg(long, value_name = "KEY,KEY", value_delimiter = ',')]
    pub(crate) over: Vec<String>,
    /// Draw the column over two keys; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) map: Option<PathBuf>,
    /// Draw the places of the tip to scale; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) workspace: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}
