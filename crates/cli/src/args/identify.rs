//! Arguments of `hydrostat identify`.

use std::path::PathBuf;

use clap::{Args as ClapArgs, ValueEnum};
use hydrostat_files::{Deviations, FitKey, PriorKey};
use hydrostat_identify::Loss;

use super::{ArmArgs, Format, PictureArgs, picture};

const EXIT: &str = "\
Exit status:
  0  fitted
  2  the request is wrong: arguments, arm file, data, an output path that cannot be written
  3  a load case has no equilibrium where the search starts, or the search did not come to its end
  1  anything else";

/// Finds parameters of an arm from measured positions, angles, strokes, tensions and base forces.
///
/// DATA is a CSV table with a row for each place of each load case; --template writes one to fill in. Reported are
/// estimates with 95 % intervals, which parameters the data cannot tell apart, and how well each load case is predicted by the
/// others. docs/identification.md has the format and an example.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat identify silicone --template > data.csv
  hydrostat identify silicone data.csv --fit young,arm.density
  hydrostat identify my.toml data.csv --fit c1,c2,c3,flow.cn --loss huber --plot fit.png
  hydrostat identify my.toml data.csv --fit \"young=100 kPa:50 kPa:200 kPa\" --prior \"young=110±10 kPa\" --out fitted.toml

{EXIT}"))]
#[allow(clippy::struct_excessive_bools, reason = "each is a switch of the command line")]
pub(crate) struct IdentifyArgs {
    #[command(flatten)]
    pub(crate) arm: ArmArgs,
    /// The measurements, CSV
    #[arg(value_name = "DATA", required_unless_present = "template")]
    pub(crate) data: Option<PathBuf>,
    /// What to fit, with start (else the arm's value) and bounds if wanted: KEY, KEY=START, KEY=START:LOWER:UPPER
    #[arg(
        long,
        value_name = "KEY,KEY,...",
        value_delimiter = ',',
        required_unless_present = "template",
        allow_hyphen_values = true
    )]
    pub(crate) fit: Vec<FitKey>,
    /// What was known before: mean and standard deviation, as in young="110±5 kPa" (or +-)
    #[arg(long, value_name = "KEY=MEAN±SD", allow_hyphen_values = true)]
    pub(crate) prior: Vec<PriorKey>,
    /// Standard deviation of what has none in DATA, with its unit; once for lengths, angles, forces, moments
    #[arg(long, value_name = "SD", value_parser = deviation)]
    pub(crate) sd: Vec<String>,
    /// How numbers far out count: none: by their square; huber: linearly; cauchy: hardly
    #[arg(long, value_name = "LOSS", value_enum, default_value_t)]
    pub(crate) loss: LossArg,
    /// Take standard deviations up to a common factor, which the residuals give
    #[arg(long)]
    pub(crate) rescale: bool,
    /// Do not fit again without each load case
    #[arg(long)]
    pub(crate) no_cross_validation: bool,
    /// Error of the tip position over the length that every solve is asked for, from 1e-12 to 1e-2
    #[arg(long, value_name = "TOL", default_value = "1e-8", allow_hyphen_values = true)]
    pub(crate) tol: f64,
    /// Print a table to fill in, and nothing else
    #[arg(long, conflicts_with_all = ["data", "fit", "prior", "plot", "out", "format", "json"])]
    pub(crate) template: bool,
    /// text: a report; json: everything; csv: a row a measured number
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) format: Format,
    /// The same as --format json
    #[arg(long, conflicts_with = "format")]
    pub(crate) json: bool,
    /// Write the result to FILE in place of standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Write the fitted arm as an arm file
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Draw fitted shapes with the data, residuals and correlations; FILE ends in .svg, .pdf or .png
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
