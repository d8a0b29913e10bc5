//! Arguments of `hydrostat identify`.

use std::path::PathBuf;

use clap::{Args as ClapArgs, ValueEnum};
use hydrostat_files::{Deviations, FitKey, PriorKey};
use hydrostat_identify::Loss;

use super::{ArmArgs, Format, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  fitted
  2  wrong request: arguments, arm file, data, or an output that cannot be written
  3  a load case has no equilibrium at the start values, or the fit did not converge
  1  any other error";

/// Fits parameters of an arm to measured positions, angles, strokes, tensions and base forces.
///
/// DATA is a CSV table with one row per station and load case; --template writes one to fill in. The report has estimates
/// with 95 % confidence intervals, combinations of parameters that the data do not determine, and the prediction of each load
/// case from the others (cross-validation). docs/identification.md has the format and an example.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat identify silicone --template > data.csv
  hydrostat identify silicone data.csv --fit young,arm.density
  hydrostat identify my.toml data.csv --fit c1,c2,c3,flow.cn --loss huber --plot fit.png
  hydrostat identify my.toml data.csv --fit 'young=100:50:200 kPa' --prior 'young=110±10 kPa' --fitted fitted.toml

{EXIT}"))]
#[allow(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub(crate) struct IdentifyArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// Measurements, a CSV file or - for standard input
    #[arg(value_name = "DATA", required_unless_present = "template")]
    pub(crate) data: Option<PathBuf>,
    /// Parameters to fit, with optional start value (default: the arm's) and bounds: KEY, KEY=START, KEY=START:LOWER:UPPER
    #[arg(
        long,
        value_name = "KEY,KEY,...",
        value_delimiter = ',',
        required_unless_present = "template",
        allow_hyphen_values = true
    )]
    pub(crate) fit: Vec<FitKey>,
    /// Prior: mean and standard deviation, such as 'young=110±5 kPa' (or +-). Repeatable
    #[arg(long, value_name = "KEY=MEAN±SD", allow_hyphen_values = true)]
    pub(crate) prior: Vec<PriorKey>,
    /// Standard deviation of the values that have none in DATA, with its unit; once each for lengths, angles, forces and moments
    #[arg(long, value_name = "SD", value_parser = deviation)]
    pub(crate) sd: Vec<String>,
    /// Outlier loss: none (squares), huber (linear tails), cauchy (outliers nearly ignored)
    #[arg(long, value_name = "LOSS", value_enum, default_value_t)]
    pub(crate) loss: LossArg,
    /// Scale all standard deviations by a common factor, estimated from the residuals
    #[arg(long)]
    pub(crate) rescale: bool,
    /// Measurements that are not fitted: the report says how far the fitted arm is from them, in CSV
    /// with a column `predicted`. A CSV file as DATA
    #[arg(long, value_name = "FILE")]
    pub(crate) predict: Option<PathBuf>,
    /// Skip cross-validation, which fits again without each load case
    #[arg(long)]
    pub(crate) no_cross_validation: bool,
    /// Tolerance on the tip position in every solve, relative to the arm's length, from 1e-12 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-8", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    /// Only print an empty table to fill in
    #[arg(long, conflicts_with_all = ["data", "fit", "prior", "predict", "plot", "fitted", "format", "json"])]
    pub(crate) template: bool,
    /// text: a report; json: all results; csv: one row per measured value
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// The same as --format json
    #[arg(long, conflicts_with = "format")]
    pub(crate) json: bool,
    /// Write the report to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Write the fitted arm to FILE, as an arm file
    #[arg(long, alias = "out", value_name = "FILE")]
    pub(crate) fitted: Option<PathBuf>,
    /// Plot the fitted shapes with the data, residuals and correlations; FILE ends in .svg, .pdf or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum LossArg {
    #[default]
    None,
    Huber,
    Cauchy,
}

impl From<LossArg> for Loss {
    fn from(loss: LossArg) -> Self {
        match loss {
            LossArg::None => Self::None,
            LossArg::Huber => Self::Huber,
            LossArg::Cauchy => Self::Cauchy,
        }
    }
}

fn deviation(text: &str) -> Result<String, String> {
    Deviations::default().add(text).map(|()| text.to_owned())
}
